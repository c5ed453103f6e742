//! The solution by first integrals: the ruler that integrators are measured with.
//!
//! ```text
//! x = mid - amp cos u,   G = (x - xa)(xb - x) H(x)               xa, xb: the turning points
//! dt/du = s^2 sqrt(J/H),   dphi/du = P sqrt(J/H),   dpsi/du = (n s^2 - P c) sqrt(J/H)
//! d(x + i y)/du = i e^(i phi) dpsi/du                            contact point, rolling
//! ```
//! `lines` gives P, n, H along x, `antiderivative` the integrals over a half swing; the state at any
//! time is one inversion of t(u), whatever the time. A period later (theta, w1, w2, w3) is the same, phi and psi have gone on by
//! a constant, and the contact path is turned by it: whole periods sum in closed form.
//!
//! Error: what rounding can do to H is followed into the integrals, so that [`Swing::error`] is an
//! estimate for this motion at that time, conditioning included. In the tests it is never below a tenth of the true
//! error against the three-dimensional model at 40 digits.

mod antiderivative;
pub(crate) mod lanes;
mod lines;
mod place;

use crate::body::Body;
use crate::contact::{Contact, FLAT};
use crate::error::{Error, within};
use crate::state::State;
use antiderivative::Antiderivative;
use core::f64::consts::{PI, TAU};
use lines::{Lines, Local};

/// A motion between its turning points, known at all times.
#[derive(Debug, Clone)]
pub struct Swing {
    body: Body,
    contact: Contact,
    start: State,
    lines: Lines,
    /// Half the distance between the ends in x.
    amplitude: f64,
    /// Time over a half swing; none for a steady state.
    clock: Option<Antiderivative<1>>,
    /// phi and psi over a half swing, and the contact path, where asked for.
    turns: Option<Antiderivative<2>>,
    path: Option<Antiderivative<2>>,
    /// Time since the lower turning point, negative on the way to it; and the u of that.
    phase: f64,
    u: f64,
    /// Squared nutation frequency of a steady state.
    kappa: f64,
}

/// Where a swing is: whole periods, and time since the lower turning point, negative on the way to it.
#[derive(Debug, Clone, Copy)]
struct Phase {
    periods: f64,
    time: f64,
    u: f64,
}

/// The body and the state if their numbers are in the range in which motions are followed.
pub(crate) fn check(body: &Body, y: &State) -> Result<(), Error> {
    const SPEED: (f64, f64) = (-1e6, 1e6);
    within("ell", body.ell(), (0.0, 1e6), "0 <= ell <= 1e6 for a motion")?;
    within("i1", body.i1(), (1e-6, 1e12), "1e-6 <= i1 <= 1e12 for a motion")?;
    within("i3", body.i3(), (1e-6, 1e12), "1e-6 <= i3 <= 1e12 for a motion")?;
    let angle = "1e-8 <= theta <= pi - 1e-8 (radians) for a motion";
    within("theta", y.theta, (1e-8, PI - 1e-8), angle)?;
    within("w1", y.w1, SPEED, "at most 1e6 sqrt(g/R) for a motion")?;
    within("w2", y.w2, SPEED, "at most 1e6 sqrt(g/R) for a motion")?;
    within("w3", y.w3, SPEED, "at most 1e6 sqrt(g/R) for a motion")?;
    Ok(())
}

impl Swing {
    /// The motion that passes through a state at time 0. `pose` also prepares angles and contact path.
    ///
    /// Errors: `OutOfRange` for theta outside [1e-8, pi - 1e-8], speeds above 1e6, bodies with
    /// ell above 1e6 or moments outside [1e-6, 1e12]; `Lost` where the integrals lose all their digits.
    pub fn new(body: &Body, start: &State, contact: Contact, pose: bool) -> Result<Self, Error> {
        check(body, start)?;
        let lost = Error::Lost { theta: start.theta };
        let lines = Lines::new(body, contact, start).ok_or(lost)?;
        let [low, high] = lines.range();
        let mut swing = Self {
            body: *body,
            contact,
            start: *start,
            amplitude: 0.5 * (high - low),
            clock: None,
            turns: None,
            path: None,
            phase: 0.0,
            u: 2.0 * (-low).sqrt().atan2(high.sqrt()),
            kappa: 0.0,
            lines,
        };
        if swing.amplitude <= f64::EPSILON {
            let at = swing.lines.at(0.0, 0.0);
            swing.kappa = at.h / (at.s.powi(4) * swing.inertia(&at));
            return if swing.kappa.is_finite() { Ok(swing) } else { Err(lost) };
        }
        let root = |at: &Local| (swing.inertia(at) / at.h).sqrt();
        let clock = Antiderivative::new(PI, |u| {
            let at = swing.local(u);
            ([at.s * at.s * root(&at)], at.noise)
        })
        .ok_or(lost)?;
        let (turns, path) = if pose {
            let spin = |at: &Local| at.n * at.s * at.s - at.p * at.c;
            let turns = Antiderivative::new(PI, |u| {
                let at = swing.local(u);
                ([at.p * root(&at), spin(&at) * root(&at)], at.noise)
            })
            .ok_or(lost)?;
            let path = Antiderivative::new(PI, |u| {
                let at = swing.local(u);
                let (sin, cos) = turns.at(u)[0].sin_cos();
                let speed = spin(&at) * root(&at);
                ([-speed * sin, speed * cos], at.noise)
            });
            (Some(turns), if contact == Contact::Rolling { Some(path.ok_or(lost)?) } else { None })
        } else {
            (None, None)
        };
        let since = clock.at(swing.u)[0];
        swing.phase = if start.w2 > 0.0 { -since } else { since };
        (swing.clock, swing.turns, swing.path) = (Some(clock), turns, path);
        Ok(swing)
    }

    fn local(&self, u: f64) -> Local {
        let (sin, cos) = (0.5 * u).sin_cos();
        self.lines.at(2.0 * self.amplitude * sin * sin, 2.0 * self.amplitude * cos * cos)
    }

    fn inertia(&self, at: &Local) -> f64 {
        self.lines.law().inertia(|| (at.s, at.c))
    }

    /// Whether nothing changes but the angles: a swing narrower than rounding. If unstable it is taken to stay, which
    /// its [`error`](Self::error) doubts more the later.
    pub fn is_steady(&self) -> bool {
        self.clock.is_none()
    }

    /// Time of a whole nutation, in sqrt(R/g); infinite where the face lands or an unstable state stays.
    pub fn period(&self) -> f64 {
        match &self.clock {
            _ if self.lines.lands() != [false; 2] => f64::INFINITY,
            Some(clock) => 2.0 * clock.total[0],
            None if self.kappa > 0.0 => TAU / self.kappa.sqrt(),
            None => f64::INFINITY,
        }
    }

    /// Angular frequency of the nutation, 2 pi over the period.
    pub fn nutation(&self) -> f64 {
        TAU / self.period()
    }

    /// Least and greatest inclination, in radians; 0 or pi where the face lands.
    pub fn turning_points(&self) -> [f64; 2] {
        let [low, high] = self.lines.lands();
        let theta = |u| 2.0 * self.local(u).x.exp().atan();
        [if low { 0.0 } else { theta(0.0) }, if high { PI } else { theta(PI) }]
    }

    /// Phase of the time `t`.
    fn phase_at(&self, clock: &Antiderivative<1>, t: f64) -> Phase {
        let half = clock.total[0];
        let period = 2.0 * half;
        let mut periods = ((t + self.phase) / period).round();
        if self.lines.lands()[1] {
            periods = 0.0;
        }
        let time = (-periods).mul_add(period, t) + self.phase;
        Phase { periods, time, u: clock.inverse(time.abs().min(half)) }
    }

    /// The state at time `t`, of either sign; beyond a [`landing`](Self::landing) that of the landing.
    pub fn state(&self, t: f64) -> State {
        let Some(clock) = &self.clock else { return self.start };
        if t == 0.0 {
            return self.start;
        }
        if let Some((limit, landed)) = self.landing(t)
            && t.abs() >= limit
        {
            return landed;
        }
        let phase = self.phase_at(clock, t);
        self.state_at(phase.u, phase.time >= 0.0)
    }

    /// The state at `u`, inclination rising or falling.
    fn state_at(&self, u: f64, rising: bool) -> State {
        let at = self.local(u);
        let tilt = self.amplitude * u.sin() * (at.h / self.inertia(&at)).max(0.0).sqrt() / at.s;
        State {
            theta: 2.0 * at.x.exp().atan(),
            w1: at.p / at.s,
            w2: if rising { -tilt } else { tilt },
            w3: at.n,
        }
    }

    /// When the face lands, as a distance in time in the direction of `way`, and the state then.
    pub fn landing(&self, way: f64) -> Option<(f64, State)> {
        let clock = self.clock.as_ref()?;
        let half = clock.total[0];
        // time's direction mirrored: the way back is the way forth with the tilting reversed
        let phase = if way < 0.0 { -self.phase } else { self.phase };
        let (upper, time) = match self.lines.lands() {
            [false, false] => return None,
            [true, _] if phase < 0.0 => (false, -phase),
            [true, false] => (false, 2.0 * half - phase),
            [_, true] => (true, half - phase),
        };
        let n = self.local(if upper { PI } else { 0.0 }).n;
        let speed = self.lines.landing_speed(n, upper);
        let tilt = if upper == (way >= 0.0) { -speed } else { speed };
        let theta = if upper { PI } else { 0.0 };
        let rest = FLAT / speed;
        Some((time + rest, State { theta, w1: 0.0, w2: tilt, w3: n }))
    }

    /// Estimated error of the state at time `t`: the largest of its four numbers.
    pub fn error(&self, t: f64) -> f64 {
        let ulp = 4.0 * f64::EPSILON;
        let Some(clock) = &self.clock else {
            let noise = self.lines.at(0.0, 0.0).noise + self.amplitude;
            let size = 1.0 + self.start.w1.abs().max(self.start.w3.abs());
            return size
                * noise
                * (if self.kappa < 0.0 { ((-self.kappa).sqrt() * t.abs()).exp() } else { 1.0 });
        };
        if t == 0.0 {
            return 0.0;
        }
        // a landing is as uncertain as the motion is just before
        let t = self.landing(t).map_or(t, |(limit, _)| t.signum() * t.abs().min(limit * (1.0 - 1e-6)));
        let phase = self.phase_at(clock, t);
        let at = self.local(phase.u);
        let y = self.state_at(phase.u, phase.time >= 0.0);
        let dy = self.contact.derivative(&self.body, &y);
        let doubt = self.time_doubt(clock, &phase, t);
        let rate = [dy.theta, dy.w1, dy.w2, dy.w3].iter().fold(0f64, |a, x| a.max(x.abs()));
        // what the ends are uncertain by, and how the state changes along x
        let (sin, cos) = (0.5 * phase.u).sin_cos();
        let lands = self.lines.lands();
        let end = |i: usize, u: f64| if lands[i] { 0.0 } else { self.local(u).noise };
        let shift = cos * cos * end(0, 0.0) + sin * sin * end(1, PI);
        let [p, n] = self.lines.slope(&at);
        let along = (p / at.s).abs() + (at.p / at.s * at.c).abs() + n.abs() + at.s;
        let swing = (at.h / self.inertia(&at)).abs().sqrt() / at.s;
        let size = 1.0 + y.w1.abs().max(y.w2.abs()).max(y.w3.abs());
        rate * doubt + (along + swing) * shift + ulp * size
    }

    /// How uncertain the time of a phase is.
    fn time_doubt(&self, clock: &Antiderivative<1>, phase: &Phase, t: f64) -> f64 {
        2.0 * phase.periods.abs() * clock.doubt[0]
            + clock.doubt_at(phase.u)
            + clock.doubt_at(self.u)
            + f64::EPSILON * t.abs()
    }

    /// What happens along half a swing, at places dense enough to see it all, ascending in inclination.
    pub(crate) fn extremes(&self) -> impl Iterator<Item = Extreme> + '_ {
        let nodes: Vec<(f64, f64)> = match &self.clock {
            None => vec![(self.u, 1.0)],
            Some(clock) => {
                let lands = self.lines.lands();
                let ends = [(0.0, lands[0]), (PI, lands[1])].map(|(u, lands)| (!lands).then_some((u, 0.0)));
                ends[0].into_iter().chain(clock.nodes()).chain(ends[1]).collect()
            }
        };
        nodes.into_iter().map(|(u, weight)| Extreme { u, y: self.rising(u), weight })
    }

    /// Time to the first passage of `u`, as a distance in the direction of `way`.
    pub(crate) fn reached(&self, way: f64, u: f64) -> Option<f64> {
        if self.is_steady() {
            return Some(0.0);
        }
        let (below, above) = if u < self.u { (Some(u), None) } else { (None, Some(u)) };
        self.first(way, below, above).map(|(t, _)| t)
    }

    /// The part of [0, pi] in which u is between time 0 and `t`.
    pub(crate) fn passed(&self, t: f64) -> [f64; 2] {
        let Some(clock) = &self.clock else { return [self.u; 2] };
        let end = self.landing(t).map_or(t.abs(), |(limit, _)| t.abs().min(limit));
        let u = self.phase_at(clock, t.signum() * end).u;
        let meets = |u: f64| self.reached(t.signum(), u).is_some_and(|time| time <= end);
        [if meets(0.0) { 0.0 } else { self.u.min(u) }, if meets(PI) { PI } else { self.u.max(u) }]
    }

    /// What it moves on.
    pub(crate) fn contact(&self) -> Contact {
        self.contact
    }

    /// The state at time 0.
    pub(crate) fn start(&self) -> &State {
        &self.start
    }

    /// u of the start.
    pub(crate) fn start_u(&self) -> f64 {
        self.u
    }

    /// The state at `u`, rising.
    pub(crate) fn rising(&self, u: f64) -> State {
        if self.is_steady() { self.start } else { self.state_at(u, true) }
    }

    /// u at which the symmetry axis is level (theta = pi/2), if the swing gets there.
    pub(crate) fn level(&self) -> Option<f64> {
        let [low, high] = self.lines.range();
        let level = -self.lines.origin;
        (level < high && !self.is_steady())
            .then(|| 2.0 * (level - low).max(0.0).sqrt().atan2((high - level).sqrt()))
    }

    /// First time, as a distance in the direction of `way`, at which the swing is at one of the two
    /// places `below` and `above` its start; and the state then.
    pub(crate) fn first(&self, way: f64, below: Option<f64>, above: Option<f64>) -> Option<(f64, State)> {
        let clock = self.clock.as_ref()?;
        let half = clock.total[0];
        let lands = self.lines.lands();
        let phase = if way < 0.0 { -self.phase } else { self.phase };
        let rising = phase > 0.0 || (phase == 0.0 && self.u < 0.5 * PI);
        let time = |u: f64| clock.at(u)[0];
        let here = phase.abs();
        let (direct, later) = if rising { (above, below) } else { (below, above) };
        let (u, t, still) = if let Some(u) = direct {
            (u, (time(u) - here).abs(), true)
        } else if rising && !lands[1] {
            let u = later?;
            (u, (half - here) + (half - time(u)), false)
        } else if !rising && !lands[0] {
            let u = later?;
            (u, here + time(u), false)
        } else {
            return None;
        };
        Some((t, self.state_at(u, (rising == still) == (way >= 0.0))))
    }
}

/// A place on a swing.
pub(crate) struct Extreme {
    pub u: f64,
    pub y: State,
    /// Time spent around it.
    pub weight: f64,
}
