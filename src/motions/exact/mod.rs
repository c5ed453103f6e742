//! The exact solution by first integrals, which is the reference for the integrators.
//!
//! ```text
//! G(x) = J s^2 theta'^2,   dt/dx = s^2 sqrt(J/G)
//! dphi/dx = P sqrt(J/G),   dpsi/dx = (n s^2 - P c) sqrt(J/G)
//! d(x + i y)/dx = e^(i phi) (i A dpsi/dx - rho s)      contact point: round the rim and its fillet
//! ```
//! The module `lines` gives P = w1 s, n = w3 and G as functions of x = ln tan(theta/2), and the turning points. The
//! module `stretch` gives a variable v in which these are smooth: one for the whole swing, or several where the motion
//! lingers. `antiderivative` gives the integrals over half a swing, and one inversion of t(v) gives the state at any
//! time. After one period theta, w1, w2 and w3 are the same, phi and psi have grown by constants, and the contact path
//! is rotated by the constant of phi, so that whole periods are summed in closed form.
//!
//! Error: the rounding error of G is propagated through the integrals, so that [`Swing::error`] is an estimate for
//! this motion at that time, conditioning included. In the tests of `exact` the estimate is never below a tenth of
//! the true error against the three-dimensional model at 40 digits. The inputs are taken as exact: a change of the
//! inputs by half a rounding (ulp) changes a motion that lingers by more than the estimate.
//!
//! ```
//! use spincyl::{Body, Contact, exact::Swing, steady};
//!
//! let body = Body::solid(2.5)?;
//! let start = steady::state(&body, 1.3)?.kicked(0.05);
//! let swing = Swing::new(&body, &start, Contact::Rolling)?;
//! let again = swing.state(swing.period());
//! assert!((again.theta - start.theta).abs() < 1e-12 && (again.w2 - start.w2).abs() < 1e-12);
//! # Ok::<(), spincyl::Error>(())
//! ```

mod carry;
mod claim;
pub(crate) mod course;
pub(crate) mod event;
pub(crate) mod extrema;
pub(crate) mod lanes;
mod lines;
pub(crate) mod method;
pub(crate) mod motion;
mod panel;
mod passage;
mod place;
mod stretch;
pub(crate) mod tolerance;

use crate::error::{Error, within};
use crate::laws::body::Body;
use crate::laws::contact::Contact;
use crate::laws::state::State;
use crate::methods::antiderivative::{Antiderivative, Sampled};
use core::f64::consts::{FRAC_PI_2, PI, TAU};
use lines::Lines;
pub use place::{AnglesPerPeriod, ContactDrift};
use stretch::{Stretch, StretchPoint};

/// The whole motion between its turning points, which can be evaluated at any time.
#[derive(Debug, Clone)]
pub struct Swing {
    body: Body,
    contact: Contact,
    start: State,
    lines: Lines,
    /// The parts (legs) of the swing from its lower end to its upper end; empty for a steady state.
    legs: Vec<Leg>,
    /// Time, angles and contact path from the lower to the upper end of the swing: half a nutation.
    half_nutation: LegSums,
    /// Time of the initial state since the lower turning point, negative before it; `at_start` is the place of the
    /// initial state.
    phase: f64,
    at_start: LegPoint,
    /// Square of the nutation frequency of a steady state.
    kappa: f64,
}

/// A part (leg) of the swing and the integrals over it.
#[derive(Debug, Clone)]
struct Leg {
    stretch: Stretch,
    clock: Antiderivative<1>,
    /// Integrals of phi and psi over the leg, if poses are requested; the next field is that of the contact path.
    turns: Option<Antiderivative<2>>,
    path: Option<Antiderivative<2>>,
    /// The integrals from the lower end of the swing to the lower end of this leg.
    before: LegSums,
}

/// Time, angles and contact point since the lower end of the swing, with their absolute uncertainties.
#[derive(Debug, Clone, Copy, Default)]
struct LegSums {
    time: f64,
    doubt: f64,
    turns: [f64; 2],
    turns_doubt: [f64; 2],
    path: [f64; 2],
    path_doubt: [f64; 2],
}

/// A place on a swing: the index of its leg, and the variable v of that leg.
#[derive(Debug, Clone, Copy, Default)]
struct LegPoint {
    leg: usize,
    v: f64,
}

/// A time as whole periods and the time since the lower turning point, negative before that point.
#[derive(Debug, Clone, Copy)]
struct SwingPhase {
    periods: f64,
    time: f64,
    spot: LegPoint,
}

impl Leg {
    /// An integral from the lower end of the swing to the variable `v` of this leg; `before` is its part below the
    /// leg.
    fn since<const M: usize>(&self, of: &Antiderivative<M>, before: [f64; M], v: f64) -> [f64; M] {
        let here = of.at(v);
        core::array::from_fn(|i| {
            before[i] + if self.stretch.way > 0.0 { here[i] } else { of.total[i] - here[i] }
        })
    }

    fn time(&self, v: f64) -> f64 {
        self.since(&self.clock, [self.before.time], v)[0]
    }

    fn doubt(&self, v: f64) -> f64 {
        let (here, all) = (self.clock.uncertainty_at(v), self.clock.doubt[0]);
        self.before.doubt + if self.stretch.way > 0.0 { here } else { all - here }
    }

    fn turns(&self, v: f64) -> Option<[f64; 2]> {
        self.turns.as_ref().map(|of| self.since(of, self.before.turns, v))
    }

    fn path(&self, v: f64) -> Option<[f64; 2]> {
        self.path.as_ref().map(|of| self.since(of, self.before.path, v))
    }

    /// The integrals from the lower end of the swing to the upper end of this leg.
    fn sums_at_end(&self) -> LegSums {
        let mut sums = self.before;
        sums.time += self.clock.total[0];
        sums.doubt += self.clock.doubt[0];
        let add = |sum: &mut [f64; 2], more: [f64; 2]| {
            for (sum, more) in sum.iter_mut().zip(more) {
                *sum += more;
            }
        };
        if let Some(turns) = &self.turns {
            add(&mut sums.turns, turns.total);
            add(&mut sums.turns_doubt, turns.doubt);
        }
        if let Some(path) = &self.path {
            add(&mut sums.path, path.total);
            add(&mut sums.path_doubt, path.doubt);
        }
        sums
    }
}

/// Relative uncertainty that the error estimate assumes for P = w1 sin(theta) at a pole, and therefore for the angle
/// by which the turn of phi there differs from pi/2.
const POLE_UNCERTAINTY: f64 = 1e-9;

/// Returns an error for a body or a state outside the range in which motions are computed.
pub(crate) fn check(body: &Body, y: &State) -> Result<(), Error> {
    check_body(body)?;
    let angle = if body.is_ball() {
        "1e-8 <= theta <= pi - 1e-8 (radians) for a motion on the table: on its pole a ball stands or begins to fall; start it at theta = 1e-6"
    } else {
        "1e-8 <= theta <= pi - 1e-8 (radians) for a motion on the table: at 0 or pi the body stands on its face; start it at theta = 1e-6, or in the air (height > 0)"
    };
    within("theta", y.theta, (1e-8, PI - 1e-8), angle)?;
    check_speeds(y)
}

/// Returns an error for a body on its face with an angular velocity other than a spin, or a w2 that lets it rise.
pub(crate) fn check_on_face(body: &Body, y: &State) -> Result<(), Error> {
    check_body(body)?;
    check_speeds(y)?;
    within("w1", y.w1, (0.0, 0.0), "0 at theta = 0 or pi: to let the body rise from its face, give w2")?;
    let expected =
        "w2 <= 0 at theta = 0, and w2 >= 0 at pi: with the other sign the body would tilt into the table";
    within("w2", y.theta.cos() * y.w2, (f64::MIN, 0.0), expected).map(drop)
}

/// Returns an error for a body or a state outside the range in which flights are computed, which may begin at a pole.
pub(crate) fn check_in_air(body: &Body, y: &State) -> Result<(), Error> {
    within("theta", y.theta, (0.0, PI), "0 <= theta <= pi (radians)")?;
    if y.theta == 0.0 || y.theta == PI {
        // Here only the sum or the difference of phi and psi is determined, and phi is chosen so that w1 vanishes.
        let expected = "0 at theta = 0 or pi: give the horizontal part of the angular velocity as w2";
        within("w1", y.w1, (0.0, 0.0), expected)?;
        if body.is_ball() && y.w2 == 0.0 {
            let expected = "an inclination of at least 1e-8, or w2 other than 0: a ball that lands on its pole stands there or begins to fall; start it at theta = 1e-6";
            return Err(Error::OutOfRange { name: "theta", value: y.theta, expected });
        }
    }
    check_body(body)?;
    check_speeds(y)
}

fn check_body(body: &Body) -> Result<(), Error> {
    let least = if body.has_row() { -1e6 } else { -body.rim() - body.fillet() };
    within("ell", body.ell(), (least, 1e6), "-1 < ell <= 1e6 for a motion")?;
    within("i1", body.i1(), (1e-6, 1e12), "1e-6 <= i1 <= 1e12 for a motion")?;
    within("i3", body.i3(), (1e-6, 1e12), "1e-6 <= i3 <= 1e12 for a motion").map(drop)
}

fn check_speeds(y: &State) -> Result<(), Error> {
    const SPEED: (f64, f64) = (-1e6, 1e6);
    within("w1", y.w1, SPEED, "-1e6 to 1e6 sqrt(g/R) for a motion")?;
    within("w2", y.w2, SPEED, "-1e6 to 1e6 sqrt(g/R) for a motion")?;
    within("w3", y.w3, SPEED, "-1e6 to 1e6 sqrt(g/R) for a motion")?;
    Ok(())
}

impl Swing {
    /// The motion that passes through a state at time 0, without angles and contact path.
    ///
    /// # Errors
    /// `OutOfRange` for theta outside [1e-8, pi - 1e-8], for speeds above 1e6, and for bodies with ell above 1e6 or
    /// moments outside [1e-6, 1e12]; `Lost` where the integrals lose all their digits.
    pub fn new(body: &Body, start: &State, contact: Contact) -> Result<Self, Error> {
        Self::of(body, start, contact, false)
    }

    /// The motion that passes through a state at time 0, with angles and contact path ([`pose`](Self::pose)).
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub fn with_pose(body: &Body, start: &State, contact: Contact) -> Result<Self, Error> {
        Self::of(body, start, contact, true)
    }

    /// The motion that passes through a state at time 0; if `pose`, with angles and contact path.
    pub(crate) fn of(body: &Body, start: &State, contact: Contact, pose: bool) -> Result<Self, Error> {
        check(body, start)?;
        let lost = Error::Lost { theta: start.theta };
        let lines = Lines::new(body, contact, start).ok_or(lost)?;
        let [low, high] = lines.range();
        let mut swing = Self {
            body: *body,
            contact,
            start: *start,
            legs: Vec::new(),
            half_nutation: LegSums::default(),
            phase: 0.0,
            at_start: LegPoint::default(),
            kappa: 0.0,
            lines,
        };
        if 0.5 * (high - low) <= f64::EPSILON {
            let (s, c) = start.theta.sin_cos();
            swing.kappa = -swing.lines.panels[0].g[2] / (s.powi(4) * swing.lines.law.inertia(|| (s, c)));
            return if swing.kappa.is_finite() { Ok(swing) } else { Err(lost) };
        }
        // A ball passes through its pole in a negligible time, and phi turns there by pi: one half belongs to each side
        // of the pole.
        let [through_low, through_high] = swing.through_pole();
        if through_low {
            swing.half_nutation.time = swing.pole_time(false);
            let turn = swing.pole_turn(false);
            swing.half_nutation.turns = [turn, -turn];
            swing.half_nutation.turns_doubt = [POLE_UNCERTAINTY * (FRAC_PI_2 - turn).abs(); 2];
            if contact == Contact::Rolling {
                swing.half_nutation.path[1] = -swing.lines.flat_inclination();
            }
        }
        for stretch in swing.lines.stretches() {
            let leg = swing.leg(stretch, pose).ok_or(lost)?;
            swing.half_nutation = leg.sums_at_end();
            swing.legs.push(leg);
        }
        if through_high {
            swing.half_nutation.time += swing.pole_time(true);
            if contact == Contact::Rolling {
                let (sin, cos) = swing.half_nutation.turns[0].sin_cos();
                swing.half_nutation.path[0] -= swing.lines.flat_inclination() * cos;
                swing.half_nutation.path[1] -= swing.lines.flat_inclination() * sin;
            }
            let more = swing.pole_turn(true);
            swing.half_nutation.turns = swing.half_nutation.turns.map(|turn| turn + more);
            let doubt = POLE_UNCERTAINTY * (FRAC_PI_2 - more).abs();
            swing.half_nutation.turns_doubt = swing.half_nutation.turns_doubt.map(|so_far| so_far + doubt);
        }
        let start_v =
            |(i, leg): (usize, &Leg)| swing.lines.start_on(&leg.stretch).map(|v| LegPoint { leg: i, v });
        swing.at_start = swing.legs.iter().enumerate().find_map(start_v).ok_or(lost)?;
        let since = swing.time_at(swing.at_start);
        swing.phase = if start.w2 > 0.0 { -since } else { since };
        Ok(swing)
    }

    /// The integrals over a part of the swing, which continue those over the legs below it.
    fn leg(&self, stretch: Stretch, pose: bool) -> Option<Leg> {
        let (lines, cuts, narrowest) = (&self.lines, stretch.cuts(), 1e-15 * stretch.greatest_v);
        // The weight is sqrt(J) dx/dv/sqrt(G).
        let weight = |at: &StretchPoint| self.inertia(at).sqrt() * at.x_per_root;
        let clock = Antiderivative::new(&cuts, narrowest, |v| {
            let at = lines.at(&stretch, v);
            let value = [at.s * at.s * weight(&at)];
            Sampled { value, scale: value, noise: at.noise }
        })?;
        let mut leg = Leg { stretch, clock, turns: None, path: None, before: self.half_nutation };
        if !pose {
            return Some(leg);
        }
        // The scale of an angle's rounding error is that of its terms, and a thousandth of the time, in case
        // they are small.
        let terms = |at: &StretchPoint| {
            ((at.n * at.s * at.s).abs() + (at.p * at.c).abs() + 1e-3 * at.s * at.s) * weight(at)
        };
        let spin = |at: &StretchPoint| (at.n * at.s * at.s - at.p * at.c) * weight(at);
        leg.turns = Some(Antiderivative::new(&cuts, narrowest, |v| {
            let at = lines.at(&leg.stretch, v);
            let turn = at.p * weight(&at);
            let scale = [turn.abs() + 1e-3 * at.s * at.s * weight(&at), terms(&at)];
            Sampled { value: [turn, spin(&at)], scale, noise: at.noise }
        })?);
        if self.contact == Contact::Rolling {
            leg.path = Some(Antiderivative::new(&cuts, narrowest, |v| {
                let at = lines.at(&leg.stretch, v);
                let (sin, cos) = leg.turns(v).map_or(f64::NAN, |[phi, _]| phi).sin_cos();
                let rim = &lines.law.shape.rim;
                let along = rim.radius((at.s, at.c)) * spin(&at);
                let round = rim.rho * at.s * at.x_per_root * at.root;
                let value = [-along * sin - round * cos, along * cos - round * sin];
                Sampled { value, scale: [terms(&at) + round; 2], noise: at.noise }
            })?);
        }
        Some(leg)
    }

    fn inertia(&self, at: &StretchPoint) -> f64 {
        self.lines.law.inertia(|| (at.s, at.c))
    }

    fn point_on_stretch(&self, spot: LegPoint) -> StretchPoint {
        self.lines.at(&self.legs[spot.leg].stretch, spot.v)
    }

    /// Time from the lower turning point to a place, while the inclination rises.
    fn time_at(&self, spot: LegPoint) -> f64 {
        self.legs[spot.leg].time(spot.v)
    }

    /// The place of the lower or of the upper end of the swing.
    fn end(&self, upper: bool) -> LegPoint {
        let leg = if upper { self.legs.len() - 1 } else { 0 };
        let stretch = &self.legs[leg].stretch;
        // A stretch that is the whole swing has v = 0 at one end and v = top at the other.
        LegPoint { leg, v: if upper == (stretch.way > 0.0) { stretch.greatest_v } else { 0.0 } }
    }

    /// A place as a number that grows with the inclination: the index of the leg plus the part of the leg below the
    /// place.
    fn place_of(&self, spot: LegPoint) -> f64 {
        let stretch = &self.legs[spot.leg].stretch;
        let part = spot.v / stretch.greatest_v;
        spot.leg as f64 + if stretch.way > 0.0 { part } else { 1.0 - part }
    }

    fn leg_point_at(&self, along: f64) -> LegPoint {
        let leg = (along.max(0.0) as usize).min(self.legs.len() - 1);
        let stretch = &self.legs[leg].stretch;
        let part = (along - leg as f64).clamp(0.0, 1.0);
        LegPoint { leg, v: stretch.greatest_v * if stretch.way > 0.0 { part } else { 1.0 - part } }
    }

    /// Whether the motion is a steady state, since its nutation is smaller than rounding. An unstable steady state is
    /// assumed to last; its [`error`](Self::error) grows with time.
    pub fn is_steady(&self) -> bool {
        self.legs.is_empty()
    }

    /// Period of the nutation, in sqrt(R/g); infinite where the face lands or an unstable state lasts.
    pub fn period(&self) -> f64 {
        if self.lines.lands() != [false; 2] {
            f64::INFINITY
        } else if !self.is_steady() {
            2.0 * self.half_nutation.time
        } else if self.kappa > 0.0 {
            TAU / self.kappa.sqrt()
        } else {
            f64::INFINITY
        }
    }

    /// Angular frequency of the nutation, 2 pi over the period, in sqrt(g/R).
    pub fn nutation(&self) -> f64 {
        TAU / self.period()
    }

    /// Least and greatest inclination, in radians; 0 or pi where the face lands.
    pub fn turning_points(&self) -> [f64; 2] {
        if self.is_steady() {
            return [self.start.theta; 2];
        }
        let [low, high] = self.lines.reaches_pole();
        let theta = |upper: bool| self.lines.theta(self.point_on_stretch(self.end(upper)).x);
        [if low { 0.0 } else { theta(false) }, if high { PI } else { theta(true) }]
    }

    /// Whole periods, time since the lower turning point, and place of the motion at time `t`.
    fn phase_at(&self, t: f64) -> SwingPhase {
        let half = self.half_nutation.time;
        let period = 2.0 * half;
        let mut periods = ((t + self.phase) / period).round();
        if self.lines.lands()[1] {
            periods = 0.0;
        }
        let time = (-periods).mul_add(period, t) + self.phase;
        let since = time.abs().min(half);
        let leg = self.legs.partition_point(|leg| leg.before.time <= since).max(1) - 1;
        let Leg { clock, before, stretch, .. } = &self.legs[leg];
        let within = (since - before.time).max(0.0).min(clock.total[0]);
        let v = clock.inverse(if stretch.way > 0.0 { within } else { clock.total[0] - within });
        SwingPhase { periods, time, spot: LegPoint { leg, v } }
    }

    /// The state at time `t`, which may be negative; after a [`landing`](Self::landing) the state of the landing.
    pub fn state(&self, t: f64) -> State {
        if t == 0.0 || self.is_steady() {
            return self.start;
        }
        if let Some((limit, landed)) = self.landing(t)
            && t.abs() >= limit
        {
            return landed;
        }
        let phase = self.phase_at(t);
        let rising = phase.time >= 0.0;
        self.at_pole(&phase).unwrap_or_else(|| self.state_at(phase.spot, rising))
    }

    /// Whether a ball passes through its lower pole, and through its upper one.
    pub(super) fn through_pole(&self) -> [bool; 2] {
        let lands = self.lines.lands();
        core::array::from_fn(|i| self.lines.reaches_pole()[i] && !lands[i])
    }

    /// The time that a ball takes from the outermost computed x to its pole.
    fn pole_time(&self, upper: bool) -> f64 {
        let at = self.lines.at_face(upper);
        self.lines.flat_inclination() * at.s * self.inertia(&at).sqrt() / at.root
    }

    /// The angle by which phi turns between the outermost computed x and the point nearest to the pole: pi/2 minus
    /// the arcsine of the ratio of the least inclination to that at x. This angle has few correct digits, but its
    /// error cancels against that of the turn on the rest of the way.
    fn pole_turn(&self, upper: bool) -> f64 {
        let at = self.lines.at_face(upper);
        at.root.atan2(at.p * self.inertia(&at).sqrt())
    }

    /// The state of a ball between the outermost x and its pole, where theta and w1 fall to zero together.
    fn at_pole(&self, phase: &SwingPhase) -> Option<State> {
        let since = phase.time.abs();
        let left = [since, self.half_nutation.time - since];
        let upper = (0..2).find(|i| self.through_pole()[*i] && left[*i] < self.pole_time(*i == 1))?;
        let share = left[upper].max(0.0) / self.pole_time(upper == 1);
        let edge = self.state_at(phase.spot, phase.time >= 0.0);
        let off = self.lines.flat_inclination() * share;
        let theta = if upper == 1 { PI - off } else { off };
        Some(State { theta, w1: edge.w1 * share, ..edge })
    }

    /// The state at a place, with the inclination rising or falling.
    fn state_at(&self, spot: LegPoint, rising: bool) -> State {
        let at = self.point_on_stretch(spot);
        let tilt = at.root / self.inertia(&at).sqrt() / at.s;
        State {
            theta: self.lines.theta(at.x),
            w1: at.p / at.s,
            w2: if rising { -tilt } else { tilt },
            w3: at.n,
        }
    }

    /// Time until the face lands, and the state then; None if it does not land. With `way` = -1 the motion goes
    /// backward in time, and the time is also positive.
    pub fn landing(&self, way: f64) -> Option<(f64, State)> {
        let lands = self.lines.lands();
        if self.is_steady() || lands == [false; 2] {
            return None;
        }
        let half = self.half_nutation.time;
        // In reversed time the motion is the same with theta' reversed.
        let phase = if way < 0.0 { -self.phase } else { self.phase };
        let (upper, time) = match lands {
            [true, _] if phase < 0.0 => (false, -phase),
            [true, false] => (false, 2.0 * half - phase),
            [_, true] => (true, half - phase),
            [false, false] => return None,
        };
        let at = self.lines.at_face(upper);
        // Between this x and the face the body only falls, so that its remaining potential energy becomes
        // energy of the tilting.
        let inertia = self.lines.law.inertia(|| (0.0, at.c.signum()));
        let flat = self.lines.flat_inclination();
        let lever = self.lines.law.shape.rim.a;
        let speed = (((at.root / at.s).powi(2) + 2.0 * lever * at.s) / inertia).sqrt();
        let tilt = if upper == (way >= 0.0) { -speed } else { speed };
        let theta = if upper { PI } else { 0.0 };
        Some((time + flat / speed, State { theta, w1: at.p / at.s, w2: tilt, w3: at.n }))
    }
}
