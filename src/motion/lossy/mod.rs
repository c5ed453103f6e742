//! A body that loses energy while it rolls, or slides freely, to the last turn.
//!
//! ```text
//! y = (s, c, p, w2, w3, 0, 0, t, 0; phi, psi, x, y; lost)       p = w1 s = phi' s^2, in time
//! held   y = (s, c, q, w2, -, ...),   w1 = s (q - c psi'),   w3 = c q + s^2 psi',   q = w_z
//! margins   s,  theta_end - theta,  N,  (mu N)^2 - F^2,  the way of psi' (or what still holds it),  that of w_z or w2
//! ```
//! Near the table p is all but conserved, where w1 = p/s is not: so a whirr is followed to its end in numbers that stay bounded.
//! What dry friction has stopped is held ([`lossy`](crate::contact::lossy)). What resists in proportion to a power of psi'
//! stops the contact of a falling face ever faster: where it does so thousands of times faster than the face falls, psi'
//! is the one at which it balances what turns the contact, with its own decay (Tikhonov 1952).
//!
//! Error: the tolerance of its steps; `test_losses_reference` has motions of 25 digits from another model.

mod doubts;
mod free;
mod steps;

use super::flow::Halt;
use crate::body::Body;
use crate::contact::lossy::{Acted, Held, Lossy};
use crate::contact::{Contact, Force};
use crate::loss::{COUNT, Law, Losses, SLACK, Ways};
use crate::number::{Dual, Real};
use crate::search::crossing;
use crate::state::State;
use core::f64::consts::PI;
use free::pace_of;
pub(crate) use free::{LossyUnheld, from_side};

/// Why the contact point does not move along the rim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Hold {
    /// It moves.
    No,
    /// The body only rocks: nothing turns it.
    Planar,
    /// Dry friction holds it.
    Dry,
    /// Friction that grows with its speed has all but stopped it.
    Settled,
}

/// What holds does so a little beyond its limit, so that what it lets go moves away from it.
const GRACE: f64 = 1e-11;
/// Friction that is needed beyond what there is by more than this share has jumped there.
const JUMP: f64 = 1e-6;
/// What has turned round, and slips at once, is put so far on its way.
const NUDGE: f64 = 1e-13;
/// Rolling and rocking that are slower than this together are at rest, as far as rolling resistance is concerned.
pub(crate) const REST: f64 = 1e-13;

/// What pushes a body that only drills, and what resists.
struct Resisted {
    /// The couples that would make it roll, and rock.
    rolling: f64,
    rocking: f64,
    /// How fast it would, under a couple of 1.
    lightness: [f64; 2],
    /// The largest couple that resists.
    most: f64,
}

/// How many numbers lanes need of it.
pub(crate) const FALLS: usize = 4 + COUNT + 2;

/// A body, its table and its losses.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LossyFlow {
    law: Lossy<f64>,
    sloped: Lossy<Dual<f64>>,
    /// Without what acts along the contour.
    bare: Lossy<f64>,
    hold: Hold,
    /// Whether dry friction holds the drilling.
    drill_held: bool,
    /// Whether w_z vanishes exactly where it goes on.
    starts_still: bool,
    /// What rounding may have left of psi' and of w_z, or of w2, where these begin at rest.
    slack: [f64; 2],
    ways: Ways,
    /// The way of a contact that has settled.
    settled_way: f64,
    mu: f64,
    theta_end: f64,
    ball: bool,
    pub tol: f64,
    /// Whether anything but a landing of the face ends it.
    watch: bool,
}

impl LossyFlow {
    /// A body that rolls where mu N is enough, or slides freely, from a state on.
    pub fn new((body, contact): (&Body, Contact), mu: f64, losses: &Losses, tol: f64, y: &State) -> Self {
        let law = Lossy::of(contact, body, losses);
        let dual = |value: f64| Dual { value, slope: 0.0 };
        let rates = crate::contact::reduced::Rates::of(contact, &body.shape().map(dual), !body.is_sharp());
        let sloped = Lossy { rates, losses: law.losses.map(dual) };
        let (theta_end, ball) = (body.theta_end(), body.is_ball());
        let mu = if contact == Contact::Smooth { f64::INFINITY } else { mu };
        let (hold, ways) = (Hold::No, Ways::default());
        let bare = Lossy { losses: law.losses.off_the_contour(), ..law };
        let (drill_held, watch) = (false, true);
        let (settled_way, starts_still, slack) = (0.0, false, [0.0; 2]);
        let mut lossy = Self {
            law,
            sloped,
            bare,
            hold,
            drill_held,
            starts_still,
            slack,
            ways,
            settled_way,
            mu,
            theta_end,
            ball,
            tol,
            watch,
        };
        lossy.face(y);
        lossy
    }

    /// From now on nothing but a landing of the face ends it.
    pub fn go_beyond(&mut self) {
        self.watch = false;
    }

    fn has(&self, law: Law) -> bool {
        self.law.losses.has(law)
    }

    /// What is at rest at a state, and the ways of the rest.
    fn face(&mut self, y: &State) {
        let (angle, w) = (y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
        let (s, c) = angle;
        let (spin, drilling) = (y.w3 - c / s * y.w1, s * y.w1 + c * y.w3);
        let way = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
        self.ways = Ways { contour: way(spin), drilling: way(drilling), rocking: 0.0 };
        self.drill_held = false;
        self.hold = Hold::No;
        if y.w1 == 0.0 && y.w3 == 0.0 {
            self.only_rocks(angle, y.w2);
        } else {
            if spin == 0.0 && self.has(Law::DryContour) {
                self.stop_contour(angle, w, false);
            }
            if drilling == 0.0 && self.has(Law::Drilling) {
                self.stop_drilling(angle, w);
            }
        }
        self.turn(self.ways);
        self.allows(y);
    }

    /// Where what a dry loss resists begins at rest, rounding may have left it on either side.
    fn allows(&mut self, y: &State) {
        let size = SLACK * (1.0 + y.precession().abs());
        let (s, c) = y.theta.sin_cos();
        let slow = |x: f64| if x.abs() < 16.0 * size { SLACK } else { 0.0 };
        let other = if self.hold == Hold::Planar { y.w2 } else { s * y.w1 + c * y.w3 };
        self.slack = [slow(y.spin()), slow(other)];
    }

    fn turn(&mut self, ways: Ways) {
        self.ways = ways;
        (self.law.losses.ways, self.bare.losses.ways) = (Some(ways), Some(ways));
        self.sloped.losses = self.law.losses.map(|value| Dual { value, slope: 0.0 });
    }

    fn act(&self, angle: (f64, f64), precession: f64, w: [f64; 3], held: Held<f64>) -> Acted<f64> {
        self.law.at(angle, precession, w, held)
    }

    /// Dry friction holds the contact point if it can, or in any case (`surely`); else the point goes where it is pushed.
    fn stop_contour(&mut self, angle: (f64, f64), w: [f64; 3], surely: bool) {
        self.turn(Ways { contour: 0.0, ..self.ways });
        let [push, limit] = self.act(angle, w[0] / angle.0, w, Held::Contour(0.0)).held;
        let held = surely || push.abs() <= limit * (1.0 + GRACE);
        self.hold = if held { Hold::Dry } else { Hold::No };
        self.turn(Ways { contour: if held { 0.0 } else { push.signum() }, ..self.ways });
        if held && self.drill_held {
            self.only_rocks(angle, w[1]);
        }
    }

    /// Nothing turns the body any more.
    fn only_rocks(&mut self, angle: (f64, f64), w2: f64) {
        (self.hold, self.drill_held) = (Hold::Planar, false);
        self.turn(Ways::default());
        let falls = self.act(angle, 0.0, [0.0, w2, 0.0], Held::Nothing).w[1];
        let rocking = if w2 != 0.0 { w2.signum() } else { falls.signum() };
        self.turn(Ways { rocking, ..Ways::default() });
    }

    /// The same of the drilling.
    fn stop_drilling(&mut self, angle: (f64, f64), w: [f64; 3]) {
        self.turn(Ways { drilling: 0.0, ..self.ways });
        let [push, limit] = self.act(angle, w[0] / angle.0, w, Held::Drilling).held;
        self.drill_held = push.abs() <= limit * (1.0 + GRACE);
        self.turn(Ways { drilling: if self.drill_held { 0.0 } else { -push.signum() }, ..self.ways });
    }

    /// Whether rolling needs much more friction at once than there is: where a dry loss has just turned round.
    pub fn jumps(&self, y: &State) -> bool {
        self.force(y).friction_coefficient() > self.mu * (1.0 + JUMP)
    }

    /// The same state, a little on the way that what has just turned round takes; and by how much.
    pub fn on_its_way(&self, y: &State) -> (State, f64) {
        let (s, c) = y.theta.sin_cos();
        let little = NUDGE * (1.0 + y.precession().abs());
        let (mut w1, mut w3) = (y.w1, y.w3);
        if y.spin().abs() < little {
            // psi' alone
            let by = self.ways.contour * little;
            (w1, w3) = (w1 - s * c * by, w3 + s * s * by);
        }
        if (s * y.w1 + c * y.w3).abs() < little {
            // w_z alone
            let by = self.ways.drilling * little;
            (w1, w3) = (w1 + s * by, w3 + c * by);
        }
        (State { w1, w3, ..*y }, little)
    }

    /// What a halt changes; whether the contact point has stopped for good, or rests.
    pub fn after(&mut self, halt: Halt, y: &State) -> bool {
        let stops = self.turned_by(halt, y);
        self.allows(y);
        stops
    }

    fn turned_by(&mut self, halt: Halt, y: &State) -> bool {
        let (angle, w) = (y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
        self.starts_still = halt == Halt::Drilling;
        match halt {
            Halt::Contour if self.hold == Hold::Dry => {
                let push = self.act(angle, w[0] / angle.0, w, Held::Contour(0.0)).held[0];
                self.hold = Hold::No;
                self.turn(Ways { contour: push.signum(), ..self.ways });
            }
            Halt::Contour => {
                // a contact that has settled stops where dry friction balances its push, and that is here
                let settled = self.hold == Hold::Settled;
                self.stop_contour(angle, w, settled);
                return self.hold == Hold::Dry;
            }
            Halt::Drilling if self.drill_held => {
                let push = self.act(angle, w[0] / angle.0, w, Held::Drilling).held[0];
                self.drill_held = false;
                self.turn(Ways { drilling: -push.signum(), ..self.ways });
            }
            // what neither runs along the rim nor drills does not turn at all
            Halt::Drilling if self.hold != Hold::No => self.only_rocks(angle, w[1]),
            Halt::Drilling => self.stop_drilling(angle, w),
            Halt::Rocking => return !self.rocks_back(angle),
            Halt::Rests => return self.rests(y),
            Halt::Settles if self.drill_held => self.only_rocks(angle, w[1]),
            Halt::Settles => {
                (self.hold, self.settled_way) = (Hold::Settled, self.ways.contour);
                self.turn(Ways { contour: 0.0, ..self.ways });
            }
            _ => {}
        }
        false
    }

    /// Whether a body that only rocks, and has come to rest, rocks back: else rolling resistance holds it.
    fn rocks_back(&mut self, angle: (f64, f64)) -> bool {
        self.turn(Ways::default());
        let acted = self.act(angle, 0.0, [0.0; 3], Held::Nothing);
        let inertia = self.law.rates.reduced().inertia(|| angle);
        let limit = self.law.losses.coefficient(Law::RollingResistance) * acted.force[0];
        let moves = acted.w[1].abs() * inertia > limit;
        self.turn(Ways { rocking: acted.w[1].signum(), ..Ways::default() });
        moves
    }

    /// Whether the body is held where it is: it neither rolls nor rocks, and rolling resistance keeps it so.
    pub fn rests(&mut self, y: &State) -> bool {
        let angle = y.theta.sin_cos();
        let speed = pace_of(angle, y.precession(), [y.w1, y.w2, y.w3]);
        if !self.has(Law::RollingResistance) || speed >= REST {
            return false;
        }
        if self.hold == Hold::Planar {
            return !self.rocks_back(angle);
        }
        let Resisted { rolling, rocking, most, .. } = self.resisted(angle, angle.0 * y.w1 + angle.1 * y.w3);
        rolling.hypot(rocking) <= most
    }

    /// What rolling resistance has to hold of a body that only drills.
    fn resisted(&self, angle: (f64, f64), drilling: f64) -> Resisted {
        let ((s, c), mut still) = (angle, *self);
        still.turn(Ways { contour: 0.0, ..self.ways });
        let w = [s * drilling, 0.0, c * drilling];
        let acted = still.act(angle, drilling, w, Held::Contour(0.0));
        let [push, limit] = acted.held;
        let [d1, _, d3] = still.act(angle, drilling, w, Held::Nothing).w;
        // dry friction along the contour takes its share of what is held
        let rolling = -push.signum() * (push.abs() - limit).max(0.0) / s;
        let lightness = ((c * d1 - s * d3) * s / push).abs();
        let lightness = if lightness > 0.0 { lightness } else { 1.0 };
        let inertia = self.law.rates.reduced().inertia(|| angle);
        let most = self.law.losses.coefficient(Law::RollingResistance) * acted.force[0].max(0.0);
        Resisted { rolling, rocking: acted.w[1] * inertia, lightness: [lightness, 1.0 / inertia], most }
    }

    /// The same on its way: what it began with is over.
    pub fn on_the_way(&self) -> Self {
        Self { starts_still: false, ..*self }
    }

    /// Whether time is not the variable: under rolling resistance, but for a body that only rocks.
    fn is_paced(&self) -> bool {
        self.has(Law::RollingResistance) && self.hold != Hold::Planar
    }

    /// What neither rolls nor rocks, but is not held so, a little on the way on which it is pushed.
    fn pushed_off<const N: usize>(&self, y: &mut [f64; N]) {
        let ([s, c, w1, w2, w3], held) = (core::array::from_fn(|i| y[i]), self.hold != Hold::No);
        if !self.is_paced() || pace_of((s, c), w1 / s, [w1, w2, w3]) >= REST {
            return;
        }
        let drilling = s * w1 + c * w3;
        let Resisted { rolling, rocking, lightness, most } = self.resisted((s, c), drilling);
        let pushes = [if held { 0.0 } else { rolling }, rocking];
        // it leaves along n, so that growth n = lightness (pushes - most n), where n has a length of 1
        let way = |growth: f64| -> [f64; 2] {
            core::array::from_fn(|i| pushes[i] / (most + growth / lightness[i]))
        };
        let long = |growth: f64| way(growth)[0].hypot(way(growth)[1]) - 1.0;
        let far = pushes[0].abs() * lightness[0] + pushes[1].abs() * lightness[1];
        let growth = if long(0.0) > 0.0 { crossing(long, 0.0, far, long(0.0), long(far)) } else { 0.0 };
        let [rolling, rocking] = way(growth).map(|n| 2.0 * REST * n);
        (y[2], y[3], y[4]) = (s * drilling + c * rolling, rocking, c * drilling - s * rolling);
    }

    /// The numbers of a state: of what others know.
    pub fn enter<const N: usize>(&self, shown: &[f64; N]) -> [f64; N] {
        let mut y = *shown;
        self.pushed_off(&mut y);
        let [s, c, mut w1, mut w3] = [y[0], y[1], y[2], y[4]];
        if self.starts_still && self.hold == Hold::No {
            // what rounding has left
            let off = s * w1 + c * w3;
            if c.abs() > 0.5 {
                w3 -= off / c
            } else {
                w1 -= off / s
            }
            y[4] = w3;
        }
        y[2] = match self.hold {
            Hold::No => w1 * s,
            Hold::Planar => 0.0,
            Hold::Dry | Hold::Settled => s * w1 + c * w3,
        };
        (y[5], y[6]) = (0.0, 0.0);
        y
    }

    fn held<T: Real>(&self, like: T) -> Held<T> {
        match self.hold {
            Hold::No if self.drill_held => Held::Drilling,
            Hold::No => Held::Nothing,
            _ => Held::Contour(like.splat(0.0)),
        }
    }

    /// phi' and w of some numbers; what is held is taken to be at rest.
    #[inline(always)]
    fn turning<T: Real>(&self, y: [T; 5]) -> (T, [T; 3]) {
        let [s, c, p, w2, _] = y;
        if self.hold == Hold::No { free::turning(y) } else { (p, [s * p, w2, c * p]) }
    }

    /// The first margin that fails at a start.
    pub fn at_start(&self, y: &State) -> Option<Halt> {
        let (angle, w) = (y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
        let acted = self.act(angle, w[0] / angle.0, w, self.held(0.0));
        let rises = y.w2 > 0.0 || (y.w2 == 0.0 && acted.w[1] > 0.0);
        let side = self.theta_end - y.theta;
        let [normal, along, across] = acted.force;
        if self.theta_end < PI && (side < 0.0 || (side == 0.0 && !rises)) {
            Some(Halt::Side)
        } else if normal <= 0.0 {
            Some(Halt::LiftOff)
        } else if self.mu.is_finite() && along.hypot(across) > self.mu * normal * (1.0 + GRACE) + 1e-15 {
            Some(Halt::Slips)
        } else {
            None
        }
    }

    /// The contact force at a state on the way.
    pub fn force(&self, y: &State) -> Force {
        let (angle, w) = (y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
        let [normal, along, across] = self.act(angle, w[0] / angle.0, w, self.held(0.0)).force;
        Force { normal, along, across }
    }

    /// The time left of a face that is all but flat; and by how much that may be off.
    pub fn rest_of<const N: usize>(&self, shown: &[f64; N]) -> (f64, f64) {
        let [s, c, w1, w2, w3] = core::array::from_fn(|i| shown[i]);
        let (falls, i1) = (if c * w2 > 0.0 { s / (c * w2) } else { 0.0 }, self.law.rates.reduced().shape.i1);
        let acted = self.act((s, c), w1 / s, [w1, w2, w3], self.held(0.0));
        if self.hold != Hold::No || falls > 0.0 && steps::turning_share(i1, s, w1, w2) < 0.25 {
            if w2 * w2 > s || falls == 0.0 {
                return (falls, falls * falls.max(s));
            }
            // what falls ever more slowly: w2 ~ s^a
            let slower = -(c * acted.w[1] * s) / (w2 * w2);
            return (falls / (1.0 - slower.clamp(0.0, 0.9)), falls);
        }
        // of a body that comes down by infinitely many turns: E = (3/2) s falls as the square of the time left
        let resisted = self.law.losses.coefficient(Law::RollingResistance) * acted.force[0];
        // what drills meanwhile loses another energy
        let power =
            if resisted > 0.0 { resisted * pace_of((s, c), w1 / s, [w1, w2, w3]) } else { acted.power };
        let left = if power > 0.0 { 3.0 * s * self.law.rates.reduced().shape.rim.a / power } else { 0.0 };
        (left, if s > 2.0 * steps::FLAT { left } else { left * left })
    }
}
