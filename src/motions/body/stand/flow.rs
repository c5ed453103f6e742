//! The equations of a body on its face: its rates, and the conditions that end the phase.
//!
//! ```text
//! |v| = r cos k,  a |w| = r sin k,   d t = (r/mu) d tau       under dry friction, of a body that slides and spins
//! ln(r)' = -(cos k G_x + sin k q),   k' = sin k G_x - cos k q,   alpha' = -G_y/cos k,    q = gg/i3 + losses
//! v' = F + G,   I3 w' = M                                     otherwise, in time;   G   pull of a slope
//! ln(r)' = V.dv + S ds,   V' = dv - ln(r)' V,   S' = ds - ln(r)' S      V = v/r, S = a w/r, in tau, where a slope pulls at a slide
//! ```
//! Slide and spin end together, after infinitely many turns of v in a finite time. In tau all of these rates are
//! bounded and smooth, and depend on k alone. The integration ends where r has fallen to a rounding; the rest is
//! extrapolated linearly. On a slope v may pass through zero while the body spins. There the direction alpha of v is
//! not smooth, but V is. [`contact::face`](crate::laws::contact) has the law of friction.
//!
//! Error: the tolerance of the steps.

use crate::laws::body::rim::Rim;
use crate::laws::body::{Body, Shape};
use crate::laws::contact::Force;
use crate::laws::contact::face::{FaceFriction, viscous};
use crate::laws::contact::slip::Friction;
use crate::laws::loss::{Law, Losses};
use crate::laws::state::State;
use crate::methods::flow::{Flow, FlowPlace};
use crate::methods::rk8;
use crate::motions::ask::row::OutputRow;
use crate::motions::body::write;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, Halt, MARGINS, PHI, TIME, U2, UH, W1, W2, W3, Y, loses, lost, pose_rates, poses,
};
use crate::motions::{Ask, Kind};
use crate::numbers::Dual;
use core::f64::consts::PI;

/// Index of alpha, the direction of v, in the state vector of an integration in tau; the variables of tau replace w1,
/// w2 and w3.
const ALPHA: usize = W1;
const SIZE: usize = W2;
const SHARE: usize = W3;

/// A slide ends where the speeds of slide and spin are both below this share of those at its start.
const SLID_OUT: f64 = 1e-14;
/// The integration ends at this share of the fold, where the centre of pressure ceases to exist.
const SHORT_OF_FOLD: f64 = 1.0 - 1e-9;
/// Where slide and spin of a tall disc become equally fast, the part that presses shrinks to a point, and friction
/// approaches its last value as the square root of the distance. The integration ends at this share of the ratio 1,
/// and the rest follows from the square root.
const SHORT_OF_POINT: f64 = 1.0 - 1e-5;
/// A spin, and a velocity across the slope, below this share of the speed count as rounding errors.
const STRAIGHTENED: f64 = 1e-15;
/// The longest integration step in the variable tau.
const LONGEST: f64 = 4.0;

/// Indices of the margins: functions of the state whose zeros end the phase.
const RESTS: usize = 0;
const SPIN_ENDS: usize = 1;
const TOPPLES: usize = 2;
const STRAIGHTENS: usize = 3;
const ENDS: [Halt; MARGINS] =
    [Halt::Rests, Halt::Turned, Halt::Topples, Halt::Turned, Halt::Time, Halt::Time];

/// How slide and spin of a body on its face change, which decides the variables of integration.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Braking {
    /// Dry friction acts on both slide and spin; integrated in tau.
    Rubs,
    /// Dry friction and the component of gravity along a slope act; integrated in tau.
    Pulled,
    /// Dry friction acts on either a slide along a straight line or a spin; integrated in time.
    Straight,
    /// A viscous film, or no friction; integrated in time.
    Soft,
}

/// The equations of a body on its face: its friction and losses, and the start of the integration.
#[derive(Clone, Copy)]
pub(crate) struct StandingFlow {
    shape: Shape<f64>,
    /// Radius a of the ring of contact; `height` is the height Z of the centre of mass, `up` cos(theta), and the last
    /// one the sign of w_z.
    radius: f64,
    height: f64,
    up: f64,
    way: f64,
    course: Braking,
    face: FaceFriction,
    /// The coefficient mu of dry friction, or c of a viscous film.
    strength: f64,
    dry: bool,
    /// The coefficient of static friction, which holds a face at rest.
    holds: f64,
    /// The component of gravity along a slope, along e_h and e2; 0 on a level table.
    pull: [f64; 2],
    /// The coefficients of the losses against a spin: drilling (a length), linear and quadratic drag of the air.
    losses: [f64; 3],
    /// Cosine and sine of the direction of the centre's velocity v at the start, along e_h and e2.
    towards: [f64; 2],
    least: f64,
    pub tol: f64,
}

impl StandingFlow {
    /// The equations from the state vector `y` on, with the friction `face` of the face, losses, and a component of
    /// gravity along the table.
    pub fn new<const N: usize>(
        (shape, face): (Shape<f64>, FaceFriction),
        friction: &Friction,
        (losses, pull): (&Losses, [f64; 2]),
        y: &[f64; N],
        tol: f64,
    ) -> Self {
        let (rim, angle) = (shape.rim, y.angle());
        let laws = [Law::Drilling, Law::AirLinear, Law::AirQuadratic].map(|law| losses.coefficient(law));
        let mut flow = Self {
            shape,
            radius: rim.radius(angle),
            height: rim.height(angle),
            up: y[COS],
            way: if y[W3] == 0.0 { 0.0 } else { (y[COS] * y[W3]).signum() },
            course: Braking::Soft,
            face,
            strength: friction.strength(),
            dry: matches!(friction, Friction::Coulomb { .. }),
            holds: if let Friction::Coulomb { fixed, .. } = friction { *fixed } else { 0.0 },
            pull,
            losses: laws,
            towards: [1.0, 0.0],
            least: 0.0,
            tol,
        };
        let [v_h, v_2] = flow.velocity(y);
        let (v, s) = (v_h.hypot(v_2), flow.radius * y[W3].abs());
        let slope = pull[0].hypot(pull[1]);
        let turns = slope > 0.0 && (s > 0.0 || flow.is_across([v_h, v_2]));
        flow.course = match friction {
            Friction::Coulomb { mu, .. } if *mu > 0.0 && turns => Braking::Pulled,
            Friction::Coulomb { mu, .. } if *mu > 0.0 && v > 0.0 && s > 0.0 => Braking::Rubs,
            Friction::Coulomb { mu, .. } if *mu > 0.0 => Braking::Straight,
            _ => Braking::Soft,
        };
        if v > 0.0 {
            flow.towards = [v_h / v, v_2 / v];
        } else if slope > 0.0 {
            flow.towards = pull.map(|x| x / slope);
        }
        flow.least = (SLID_OUT * v.hypot(s)).ln();
        flow
    }

    /// The velocity of the centre along e_h and e2.
    pub fn velocity<const N: usize>(&self, y: &[f64; N]) -> [f64; 2] {
        [y[UH], y[U2] + self.radius * y[W3]]
    }

    /// The component of gravity along a slope, along e_h and e2; 0 on a level table.
    pub fn pull(&self) -> [f64; 2] {
        self.pull
    }

    /// Whether a body without spin slides along a straight line.
    pub fn is_straight<const N: usize>(&self, y: &[f64; N]) -> bool {
        let [v_h, v_2] = self.velocity(y);
        y[W3] == 0.0 && !self.is_across([v_h, v_2])
    }

    /// Whether a velocity has a component across the slope.
    fn is_across(&self, [v_h, v_2]: [f64; 2]) -> bool {
        let across = v_h * self.pull[1] - v_2 * self.pull[0];
        across.abs() > 2.0 * STRAIGHTENED * v_h.hypot(v_2) * self.pull[0].hypot(self.pull[1])
    }

    /// Spin and velocity across the slope as shares of the speed, for a slide downhill that is integrated in tau;
    /// None for another motion.
    fn aside<const N: usize>(&self, y: &[f64; N]) -> Option<[f64; 2]> {
        let slope = self.pull[0].hypot(self.pull[1]);
        let [x, z] = self.pull.map(|of| of / slope);
        (y[UH] * x + y[U2] * z > 0.0).then(|| [y[SHARE], y[UH] * z - y[U2] * x])
    }

    /// The state vector of a slide down a slope, with a spin and a velocity across the slope set to zero if they are
    /// rounding errors.
    pub fn straightened<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        let (mut all, [v_h, v_2]) = (*y, self.velocity(y));
        let (v, slope) = (v_h.hypot(v_2), self.pull[0].hypot(self.pull[1]));
        let downhill = v_h * self.pull[0] + v_2 * self.pull[1] > 0.0;
        if downhill && self.radius * y[W3].abs() <= 2.0 * STRAIGHTENED * v && !self.is_across([v_h, v_2]) {
            [all[UH], all[U2]] = self.pull.map(|of| v * of / slope);
            all[W3] = 0.0;
        }
        all
    }

    /// The ratio of the speeds of slide and spin at which the body topples and the integration ends.
    fn topples_at(&self) -> f64 {
        self.face.fold() * if self.ends_at_point() { SHORT_OF_POINT } else { 1.0 }
    }

    fn ends_at_point(&self) -> bool {
        self.dry && self.face.shrinks()
    }

    /// The state vector on the way from `y` to where slide and spin become equally fast, as a function of the share
    /// (0 to 1) of the time until then; None if they do not become equally fast.
    pub fn way_to_point<const N: usize>(&self, y: &[f64; N]) -> Option<impl Fn(f64) -> [f64; N] + use<N>> {
        if !self.ends_at_point() {
            return None;
        }
        let soft = Self { course: Braking::Soft, ..*self };
        let (begin, mut first) = (soft.enter(y), [0.0; N]);
        soft.write_rates(&begin, &mut first);
        let (v, w) = (begin[UH].hypot(begin[U2]), begin[W3]);
        // At the point friction acts across v alone, with the centre of the pressure in the ring.
        let (aside, mut last) = (-self.radius / self.height * (self.up * w).signum(), first);
        last[UH] = self.pull[0] - aside * begin[U2] / v;
        last[U2] = self.pull[1] + aside * begin[UH] / v;
        last[W3] = -self.up * self.lost(self.up * w) / self.shape.i3;
        last[HEAT] = 0.0;
        let mean = |i: usize| (last[i] + 2.0 * first[i]) / 3.0;
        let faster = (begin[UH] * mean(UH) + begin[U2] * mean(U2)) / v;
        let nears = faster - self.radius * w.signum() * mean(W3);
        let left = self.radius * w.abs() - v;
        let lasts = left / nears;
        (left > 0.0 && nears > 0.0).then_some(move |share: f64| {
            // The rates tend to their last values with the root of what is left.
            let passed = 2.0 / 3.0 * (1.0 - (1.0 - share) * (1.0 - share).sqrt());
            let gone = |i: usize| last[i] * share + (first[i] - last[i]) * passed;
            soft.shown(&core::array::from_fn(|i| begin[i] + lasts * gone(i)))
        })
    }

    /// Whether friction or losses change the velocities.
    pub fn changes(&self) -> bool {
        self.strength > 0.0 || self.losses != [0.0; 3]
    }

    /// The state vector, in the variables of integration, from which the integration starts.
    pub fn enter<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        let (mut all, [v_h, v_2]) = (*y, self.velocity(y));
        let (v, s) = (v_h.hypot(v_2), self.radius * y[W3].abs());
        match self.course {
            Braking::Rubs => {
                (all[ALPHA], all[SIZE], all[SHARE]) = (0.0, v.hypot(s).ln(), s.atan2(v));
                (all[UH], all[U2]) = (0.0, 0.0);
            }
            Braking::Pulled => {
                let r = v.hypot(s);
                (all[SIZE], all[SHARE]) = (r.ln(), self.up * self.radius * y[W3] / r);
                (all[UH], all[U2]) = (v_h / r, v_2 / r);
            }
            _ => (all[UH], all[U2]) = (v_h, v_2),
        }
        all
    }

    fn in_tau(&self) -> bool {
        matches!(self.course, Braking::Rubs | Braking::Pulled)
    }

    /// The speeds |v| and a |w| in an integration in tau; negative where the motion has reversed: the spin for k < 0,
    /// the slide for k > pi/2.
    fn speeds<const N: usize>(y: &[f64; N]) -> [f64; 2] {
        let (size, (sin, cos)) = (y[SIZE].exp(), y[SHARE].sin_cos());
        [size * cos, size * sin]
    }

    /// Force and couple at the state vector of an integration in time. Dry friction keeps its direction even after
    /// the velocity has passed zero, so that the zero is found.
    fn along<const N: usize>(&self, y: &[f64; N]) -> [f64; 3] {
        let (v, w) = ([y[UH], y[U2]], self.up * y[W3]);
        if self.course == Braking::Straight {
            let turns = self.way != 0.0;
            return self.pushed(if turns { [0.0; 2] } else { self.towards }, self.way);
        }
        self.pushed(v, w)
    }

    /// The friction -F/(mu N) along v and across it, and its couple, at these speeds of slide and spin, which may be
    /// negative.
    fn rubs(&self, [v, s]: [f64; 2]) -> [f64; 3] {
        // Steps may look a little beyond the fold at which they end.
        if !(v + s).is_finite() {
            return [f64::NAN; 3];
        }
        let short = if self.ends_at_point() { 0.5 * (1.0 + SHORT_OF_POINT) } else { SHORT_OF_FOLD };
        let most = short * self.face.fold() * s.abs();
        let at = self.face.at(if v.abs() > most { most } else { v.abs() }, s.abs(), None);
        at.map_or([f64::NAN; 3], |at| {
            [at.along * v.signum(), at.across * v.signum() * s.signum(), at.couple * s.signum()]
        })
    }

    /// The couple with which the losses oppose the spin w.
    fn lost(&self, w: f64) -> f64 {
        let [drilling, linear, square] = self.losses;
        if w == 0.0 { 0.0 } else { drilling * w.signum() + (linear + square * w.abs()) * w }
    }

    /// The force along e_h and e2 and the couple about the vertical, for this velocity of the centre and this w_z.
    fn pushed(&self, [v_h, v_2]: [f64; 2], w: f64) -> [f64; 3] {
        let (v, s) = (v_h.hypot(v_2), self.radius * w.abs());
        let [x, z] = if v > 0.0 { [v_h / v, v_2 / v] } else { [1.0, 0.0] };
        if !self.dry {
            let at = viscous(self.strength, [self.radius, self.height], v, w);
            return [at.across * z - at.along * x, -(at.along * z + at.across * x), -at.couple];
        }
        if v == 0.0 && s == 0.0 || self.strength == 0.0 {
            return [0.0; 3];
        }
        let [along, across, couple] = self.rubs([v, s]).map(|of| -self.strength * of);
        let (aside, about) = (across * w.signum(), self.radius * couple * w.signum());
        [along * x - aside * z, along * z + aside * x, if s > 0.0 { about } else { 0.0 }]
    }

    /// Whether the component of gravity along a slope is larger than friction, so that the slide speeds up.
    fn speeds_up(&self) -> bool {
        self.towards[0] * self.pull[0] + self.towards[1] * self.pull[1] >= self.strength
    }

    /// How far the centre of pressure is from the ring under this friction force; 0 where the body topples.
    fn stands_under(&self, [f_h, f_2]: [f64; 2]) -> f64 {
        self.radius * self.radius - self.height * self.height * (f_h * f_h + f_2 * f_2)
    }

    /// Whether the body topples at the start.
    pub fn topples<const N: usize>(&self, y: &[f64; N]) -> bool {
        let ([v_h, v_2], w) = (self.velocity(y), self.up * y[W3]);
        if !self.dry {
            let [f_h, f_2, _] = self.pushed([v_h, v_2], w);
            return self.stands_under([f_h, f_2]) <= 0.0;
        }
        let (v, s) = (v_h.hypot(v_2), self.radius * w.abs());
        self.strength > 0.0 && (v > self.topples_at() * s || self.face.at(v, s, None).is_none())
    }

    /// The time in which the remaining slide and spin come to rest.
    pub fn left<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let ([v_h, v_2], w) = (self.velocity(y), self.up * y[W3]);
        let [f_h, f_2, couple] = self.pushed([v_h, v_2], w);
        let slows = (couple - self.lost(w)) / self.shape.i3;
        let (a, size) = (self.radius, v_h * v_h + v_2 * v_2 + (self.radius * w).powi(2));
        let rate = -(v_h * (f_h + self.pull[0]) + v_2 * (f_2 + self.pull[1]) + a * a * w * slows);
        if size > 0.0 && rate > 0.0 { size / rate } else { 0.0 }
    }

    /// The outputs at the state vector `y`.
    pub fn row<const N: usize>(&self, ask: &Ask, y: &[f64; N]) -> OutputRow<State> {
        let (v, pull) = (self.velocity(y), self.pull[0].hypot(self.pull[1]));
        let [across, along, _] = if pull > 0.0 && v == [0.0; 2] && y[W3] == 0.0 {
            // What friction takes of the pull on a body at rest, or that just begins to slide.
            let share = if pull <= self.holds {
                1.0
            } else if self.dry {
                self.strength / pull
            } else {
                0.0
            };
            [-share * self.pull[0], -share * self.pull[1], 0.0]
        } else {
            self.pushed(v, self.up * y[W3])
        };
        let state = State { theta: 0f64.atan2(y[COS]), w1: 0.0, w2: 0.0, w3: y[W3] };
        OutputRow {
            pose: poses(N).then(|| write::pose(y)),
            force: ask.force.then_some((Force { normal: 1.0, along, across }, self.tol)),
            ..OutputRow::on_table(state, y.slip(), [y[HEAT], lost(y)], Kind::OnItsFace)
        }
    }
}

/// Returns a function that computes the couple of friction about the vertical on a body on its face, from a state and
/// its slip.
pub(crate) fn couple_on_face(body: &Body, ask: &Ask) -> impl Fn(&State, [f64; 2]) -> f64 + use<> {
    let friction = ask.table.friction();
    let [first, other] = [(0.0, 1.0), (PI, -1.0)].map(|(theta, up)| {
        let shape = body.told_at(theta).shape();
        let rim = Rim { ell: up * shape.rim.ell, ..shape.rim };
        let lam = match friction {
            Friction::Coulomb { mu, .. } => mu * rim.height((0.0, 1.0)) / rim.radius((0.0, 1.0)),
            Friction::Viscous { .. } => 0.0,
        };
        (Shape { rim, ..shape }, FaceFriction::new(ask.face, lam))
    });
    move |at, slip| {
        // As seen from the face that is down.
        let up = at.theta.cos().signum();
        let mut y = [0.0; Y + 1];
        (y[COS], y[W3], y[UH], y[U2]) = (1.0, up * at.w3, up * slip[0], up * slip[1]);
        let kind = if up > 0.0 { first } else { other };
        let flow = StandingFlow::new(kind, &friction, (&Losses::NONE, [0.0; 2]), &y, 0.0);
        flow.pushed(flow.velocity(&y), y[W3])[2]
    }
}

impl Flow<MARGINS> for StandingFlow {
    type Halt = Halt;
    const TIME: usize = TIME;
    const OVER: Halt = Halt::Time;
    const PAUSE: Halt = Halt::Pause;
    const ENDLESS: Halt = Halt::Endless;
    const CALLS: bool = true;
    const LOOPS: bool = true;

    fn theta<const N: usize>(&self, y: &[f64; N]) -> f64 {
        0f64.atan2(y[COS])
    }

    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        let i3 = self.shape.i3;
        *all = [0.0; N];
        let (mut pace, mut spin) = (1.0, y[W3]);
        let mut velocity = [y[UH], y[U2]];
        if self.course == Braking::Rubs {
            let (r, [v, s]) = (y[SIZE].exp(), Self::speeds(y));
            let (sin, cos) = y[SHARE].sin_cos();
            let [along, across, couple] = self.rubs([cos, sin]);
            let lost = self.lost(s / self.radius);
            pace = r / self.strength;
            let slows = self.radius * (self.strength * self.radius * couple + lost) / (self.strength * i3);
            (all[SIZE], all[SHARE]) = (-(cos * along + sin * slows), sin * along - cos * slows);
            all[ALPHA] = -across / cos;
            all[HEAT] = r * (v * along + s * couple);
            if loses(N) {
                all[N - 1] = pace * lost * s / self.radius;
            }
            let ((sin, cos), [x, z]) = ((self.way * y[ALPHA]).sin_cos(), self.towards);
            velocity = [v * (x * cos - z * sin), v * (z * cos + x * sin)];
            spin = self.up * self.way * s / self.radius;
        } else if self.course == Braking::Pulled {
            let (r, a, [v_h, v_2, s]) = (y[SIZE].exp(), self.radius, [y[UH], y[U2], y[SHARE]]);
            let ([f_h, f_2, couple], lost) = (self.pushed([v_h, v_2], s / a), self.lost(r * s / a));
            pace = r / self.strength;
            let faster = [f_h + self.pull[0], f_2 + self.pull[1], a * (couple - lost) / i3];
            let grows = (v_h * faster[0] + v_2 * faster[1] + s * faster[2]) / (v_h * v_h + v_2 * v_2 + s * s);
            all[SIZE] = grows / self.strength;
            for (i, x, rate) in [(UH, v_h, faster[0]), (U2, v_2, faster[1]), (SHARE, s, faster[2])] {
                all[i] = (rate - grows * x) / self.strength;
            }
            all[HEAT] = -pace * r * (f_h * v_h + f_2 * v_2 + couple * s / a);
            if loses(N) {
                all[N - 1] = pace * lost * r * s / a;
            }
            (velocity, spin) = ([r * v_h, r * v_2], self.up * r * s / a);
        } else {
            let w = self.up * y[W3];
            let ([f_h, f_2, couple], lost) = (self.along(y), self.lost(w));
            (all[UH], all[U2]) = (f_h + self.pull[0], f_2 + self.pull[1]);
            all[W3] = self.up * (couple - lost) / i3;
            all[HEAT] = -(f_h * y[UH] + f_2 * y[U2] + couple * w);
            if loses(N) {
                all[N - 1] = lost * w;
            }
        }
        all[TIME] = pace;
        if poses(N) {
            let pose = pose_rates(y[PHI].sin_cos(), [0.0, spin], velocity);
            all[PHI..PHI + 4].copy_from_slice(&pose.map(|rate| rate * pace));
        }
    }

    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; MARGINS] {
        let mut all = [Dual { value: 1.0, slope: 0.0 }; MARGINS];
        let (y, rate) = (&place.y, &place.rate);
        for (i, margin) in all.iter_mut().enumerate().take(3) {
            margin.value = self.margin(y, i);
        }
        match self.course {
            Braking::Rubs => {
                all[RESTS].slope = rate[SIZE];
                if all[SPIN_ENDS].value != 1.0 {
                    all[SPIN_ENDS].slope = rate[SHARE];
                }
                if all[TOPPLES].value != 1.0 {
                    let (sin, cos) = y[SHARE].sin_cos();
                    all[TOPPLES].slope = (self.topples_at() * cos + sin) * rate[SHARE];
                }
            }
            Braking::Pulled => {
                let [v_h, v_2, s] = [y[UH], y[U2], y[SHARE]];
                all[RESTS].slope = rate[SIZE];
                if all[SPIN_ENDS].value != 1.0 {
                    all[SPIN_ENDS].slope = self.way * rate[SHARE];
                }
                if all[TOPPLES].value != 1.0 {
                    let v = v_h.hypot(v_2);
                    let faster = if v > 0.0 { (v_h * rate[UH] + v_2 * rate[U2]) / v } else { 0.0 };
                    all[TOPPLES].slope = self.topples_at() * s.signum() * rate[SHARE] - faster;
                }
                all[STRAIGHTENS].value = self.margin(y, STRAIGHTENS);
                if let Some([s, across]) = self.aside(y) {
                    let (size, slope) = (s.hypot(across), self.pull[0].hypot(self.pull[1]));
                    let back = (rate[UH] * self.pull[1] - rate[U2] * self.pull[0]) / slope;
                    all[STRAIGHTENS].slope =
                        if size > 0.0 { (s * rate[SHARE] + across * back) / size } else { 0.0 };
                }
            }
            Braking::Straight if all[RESTS].value != 1.0 => {
                all[RESTS].slope = if self.way == 0.0 {
                    self.towards[0] * rate[UH] + self.towards[1] * rate[U2]
                } else {
                    self.way * self.up * rate[W3]
                };
            }
            Braking::Straight => {}
            Braking::Soft => {
                let by = 1e-6 / (1.0 + place.rate.iter().fold(0.0, |most: f64, x| most.max(x.abs())));
                let aside =
                    |by: f64| self.margin(&core::array::from_fn::<f64, N, _>(|i| y[i] + by * rate[i]), 2);
                if self.strength > 0.0 {
                    all[TOPPLES].slope = (aside(by) - aside(-by)) / (2.0 * by);
                }
                if self.losses[0] > 0.0 {
                    all[SPIN_ENDS].slope = self.way * self.up * rate[W3];
                }
            }
        }
        all
    }

    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        let dry = self.losses[0] > 0.0;
        match (self.course, i) {
            (Braking::Rubs | Braking::Pulled, 0) => y[SIZE] - self.least,
            (Braking::Rubs, 1) if self.losses != [0.0; 3] => y[SHARE],
            (Braking::Rubs, 2) if self.face.fold() < f64::INFINITY => {
                let (sin, cos) = y[SHARE].sin_cos();
                self.topples_at() * sin - cos
            }
            (Braking::Pulled, 1) if dry && self.way != 0.0 => self.way * y[SHARE],
            (Braking::Pulled, 2) if self.face.fold() < f64::INFINITY => {
                self.topples_at() * y[SHARE].abs() - y[UH].hypot(y[U2])
            }
            (Braking::Pulled, STRAIGHTENS) => {
                self.aside(y).map_or(1.0, |[s, across]| s.hypot(across) - STRAIGHTENED)
            }
            (Braking::Straight, 0) if self.way == 0.0 && self.speeds_up() => 1.0,
            (Braking::Straight, 0) if self.way == 0.0 => self.towards[0] * y[UH] + self.towards[1] * y[U2],
            (Braking::Straight, 0) => self.way * self.up * y[W3],
            (Braking::Soft, 1) if dry && y[W3] != 0.0 => self.way * self.up * y[W3],
            (Braking::Soft, 2) if self.strength > 0.0 => {
                let [f_h, f_2, _] = self.along(y);
                self.stands_under([f_h, f_2])
            }
            _ => 1.0,
        }
    }

    fn end(&self, i: usize) -> Halt {
        ENDS[i]
    }

    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64 {
        let (per_tol, per_speed) = (1.0 / self.tol, 1.0 / (self.tol * self.fastest(y)));
        let per = |i: usize| match self.course {
            Braking::Rubs if matches!(i, W1 | W2 | W3) => per_tol,
            Braking::Pulled if matches!(i, W2 | W3 | UH | U2) => per_tol,
            _ => per_speed,
        };
        made.error(per, N as f64) * made.strictness(self.tol, TIME, TIME)
    }

    fn fastest<const N: usize>(&self, y: &[f64; N]) -> f64 {
        match self.course {
            Braking::Rubs | Braking::Pulled => y[SIZE].exp().max(1.0),
            _ => y[UH].abs().max(y[U2].abs()).max(y[W3].abs()).max(1.0),
        }
    }

    fn first<const N: usize>(&self, _: &[f64; N]) -> f64 {
        0.05
    }

    fn calm<const N: usize>(&self, y: &[f64; N]) -> f64 {
        if self.in_tau() { y[SIZE].exp() / self.strength * f64::EPSILON } else { f64::EPSILON }
    }

    fn shortest<const N: usize>(&self, _: &[f64; N]) -> f64 {
        1e-15
    }

    fn longest<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        let (y, rate) = (&place.y, &place.rate);
        // Where slide and spin are as fast as each other a point of the ring rests: friction there goes as x log x.
        let [gap, falls] = match self.course {
            Braking::Rubs => {
                let (sin, cos) = y[SHARE].sin_cos();
                [cos - sin, (sin + cos) * rate[SHARE]]
            }
            Braking::Pulled => {
                let (v, s) = (y[UH].hypot(y[U2]), y[SHARE]);
                [v - s.abs(), (y[UH] * rate[UH] + y[U2] * rate[U2]) / v - s.signum() * rate[SHARE]]
            }
            _ => return f64::INFINITY,
        };
        LONGEST.min((0.5 * gap.abs()).max(self.tol.sqrt()) / falls.abs())
    }

    fn stopped<const N: usize>(&self, _: &FlowPlace<N>) -> Option<(Halt, [f64; N])> {
        None
    }

    fn shown<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        let mut all = *y;
        if self.course == Braking::Rubs {
            let [v, s] = Self::speeds(y);
            let ((sin, cos), [x, z]) = ((self.way * y[ALPHA]).sin_cos(), self.towards);
            (all[W1], all[W2], all[W3]) = (0.0, 0.0, self.up * self.way * s / self.radius);
            (all[UH], all[U2]) = (v * (x * cos - z * sin), v * (z * cos + x * sin));
        }
        if self.course == Braking::Pulled {
            let r = y[SIZE].exp();
            (all[W2], all[W3]) = (0.0, self.up * r * y[SHARE] / self.radius);
            (all[UH], all[U2]) = (r * y[UH], r * y[U2]);
        }
        all[U2] -= self.radius * all[W3];
        all
    }
}
