//! The equations of a body that loses energy while it rolls or slides freely, up to its last turn.
//!
//! ```text
//! y = (s, c, p, w2, w3, 0, 0, t, 0; phi, psi, x, y; lost)       p = w1 s = phi' s^2, in time
//! held   y = (s, c, q, w2, -, ...),   w1 = s (q - c psi'),   w3 = c q + s^2 psi',   q = w_z
//! margins   s,  theta_end - theta,  N,  (mu N)^2 - F^2,  |psi'| or its hold,  |w_z| or its hold or |w2|
//! ```
//! Near the table p is almost conserved, while w1 = p/s is not; so a whirr is computed to its end in variables that
//! stay bounded. Dry friction can hold a motion that it has stopped ([`lossy`](crate::laws::contact::lossy)). A
//! couple that grows with a power of psi' stops the contact of a falling face faster and faster. Where this stop is
//! thousands of times faster than the fall, psi' follows from the balance of that couple with the couple that turns
//! the contact, the term of psi'' included (Tikhonov 1952).
//!
//! Error: the tolerance of the steps; `test_losses_reference` has motions to 25 digits from another model.

mod doubts;
mod free;
mod patched;
mod steps;

use crate::laws::body::{Body, Shape, leaves};
use crate::laws::contact::lossy::{Acted, Held, Lossy};
use crate::laws::contact::together::{Resting, Rubs, Together};
use crate::laws::contact::{Contact, Force};
use crate::laws::loss::{COUNT, Couples, GRACE, Holds, Law, Losses, Ways, rounded};
use crate::laws::state::{State, drilling_of};
use crate::motions::body::face::{FLAT, turning_share};
use crate::motions::body::own::Own;
use crate::motions::dry::creep::RestingPatch;
use crate::motions::dry::held::holds;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, Halt, P, PHI, SIN, U2, UH, W2, W3, carried, contact_velocity, driven, poses,
    pull_along, sum,
};
use crate::numbers::{Dual, Real, sign_or_zero};
use free::pace_of;
pub(crate) use free::{LossyUnheld, from_side};
pub(crate) use steps::at_rest;

/// If the required friction exceeds mu N by more than this share, it has jumped beyond mu N, as at a reversal of a dry
/// couple, and has not crossed mu N continuously.
pub(crate) const JUMP: f64 = 1e-6;
/// A body whose speed of rolling and rocking together is below this counts as at rest for the law of rolling
/// resistance.
pub(crate) const REST: f64 = 1e-13;

/// Number of parameters that [`LossyFlow::numbers`] returns.
pub(crate) const LOSSY_NUMBERS: usize = 4 + COUNT + 2;

/// A body with its contact and its losses, and which of its rotations friction holds at rest.
#[derive(Clone, Copy)]
pub(crate) struct LossyFlow<G = ()> {
    law: Lossy<f64, G>,
    /// The law for dual numbers (a value and a slope); `bare` is the law without the couples along the contour.
    sloped: Lossy<Dual<f64>, G>,
    bare: Lossy<f64, G>,
    /// Whether the contact point moves along the rim: not if friction holds it, if it has settled, or if the body
    /// only rocks, since no couple turns it.
    moves: bool,
    /// Whether the variable of integration, sigma, differs from time: under rolling resistance, except for a body
    /// that only rocks, or is held at rest.
    paced: bool,
    /// Whether a couple that grows with psi' has almost stopped the contact point (see `settled`).
    settled: bool,
    /// Whether the phase starts from a state in which w_z vanishes exactly.
    starts_still: bool,
    /// The direction of (w_h, w2) in which rolling and rocking begin from rest.
    push: [f64; 2],
    /// The sign of psi' of a settled contact, whose psi' almost vanishes.
    settled_way: f64,
    mu: f64,
    /// The inclinations between which the circle of contact carries the body.
    range: [f64; 2],
    ball: bool,
    pub tol: f64,
    /// Whether events other than a landing of the face end the phase.
    watch: bool,
    /// The patch of contact; None for a point.
    patch: Option<RestingPatch>,
    /// The tangent of the slope; `om` is the rate at which the table turns.
    tilt: f64,
    om: f64,
}

impl<G: Own> LossyFlow<G> {
    /// The equations of a body from the state `y` on. It rolls with friction up to mu N, or slides on a smooth table.
    pub fn new(
        (body, contact): (&Body, Contact),
        mu: f64,
        (losses, own): (&Losses, G),
        tol: f64,
        y: &State,
    ) -> Self {
        let law = Lossy { losses: Couples::of(losses, |x| x).beside(own), rates: contact.rates(body) };
        let (range, ball) = (body.carries(), body.is_ball());
        let mu = if contact == Contact::Smooth { f64::INFINITY } else { mu };
        let mut lossy = Self {
            law,
            sloped: law.sloped(),
            bare: law,
            moves: true,
            paced: false,
            settled: false,
            starts_still: false,
            push: [0.0; 2],
            settled_way: 0.0,
            mu,
            range,
            ball,
            tol,
            watch: true,
            patch: None,
            tilt: 0.0,
            om: 0.0,
        };
        lossy.sets_holds(y);
        lossy
    }

    /// These equations on a slope with the tangent `tilt`, or on a table that turns at the rate `om`, from the state
    /// vector `at` on.
    pub fn on_table<const N: usize>(mut self, [tilt, om]: [f64; 2], at: &[f64; N], y: &State) -> Self {
        (self.tilt, self.om) = (tilt, om);
        if self.is_pulled() {
            self.stands_at(at);
            self.sets_holds(y);
        }
        self
    }

    /// Whether the table is tilted or turns, or the body is driven.
    #[inline(always)]
    fn is_pulled(&self) -> bool {
        self.tilt != 0.0 || self.om != 0.0 || self.is_driven()
    }

    /// Whether a user-defined drive acts on the body.
    #[inline(always)]
    fn is_driven(&self) -> bool {
        G::IS && self.law.losses.given.drives()
    }

    /// Calls the user-defined drive at the state vector `y` and this w.
    #[inline(always)]
    fn asks_drive<const N: usize>(&self, y: &[f64; N], w: [f64; 3]) {
        if self.is_driven() {
            self.law.losses.given.asks_drive(y, w, [0.0; 2], self.centre(y.angle(), w), 0.0);
        }
    }

    /// The velocity of the centre along e_h and e2 of a body that rolls.
    fn centre(&self, angle: (f64, f64), [w1, w2, w3]: [f64; 3]) -> [f64; 2] {
        let rim = &self.law.rates.reduced().shape.rim;
        [rim.height(angle) * w2, rim.radius(angle) * w3 - rim.depth(angle) * w1]
    }

    /// Sets the force of the slope, the turntable and the drive to that at the state vector `at`, for functions that
    /// depend on a state alone.
    pub fn stands_at<const N: usize>(&mut self, at: &[f64; N]) {
        if self.is_pulled() {
            let [s, c] = [at[SIN], at[COS]];
            self.asks_drive(at, at.w());
            let pull = self.pull_at(at, (s, c), at[W2], at[W3] - c * at[P] / s);
            self.law.losses = self.law.losses.pulled(pull).over(self.om, self.om != 0.0);
            self.turn(self.ways());
        }
    }

    /// The drilling rate, w_z relative to the table, from w1 and w3.
    #[inline(always)]
    pub fn drills(&self, angle: (f64, f64), w1: f64, w3: f64) -> f64 {
        drilling_of(angle, w1, w3) - self.om
    }

    /// The force of the slope, the turntable and the drive on the centre, along e_h and e2, for this w2 and psi'.
    fn pull_at<const N: usize>(&self, y: &[f64; N], angle: (f64, f64), w2: f64, spin: f64) -> [f64; 2] {
        if !poses(N) {
            return [0.0; 2];
        }
        let heading = y[PHI].sin_cos();
        let tilted = sum(pull_along(self.tilt, heading), self.law.losses.given.pushes(y));
        if self.om == 0.0 {
            return tilted;
        }
        let (with, rim) = (carried(self.om, y, heading), &self.law.rates.reduced().shape.rim);
        driven(self.om, tilted, contact_velocity(rim, angle, w2, spin, with))
    }

    /// The force of the slope, the turntable and the drive at the state vector `y` of this phase; None if there is
    /// none of them.
    #[inline(always)]
    fn tilted<const N: usize>(&self, y: &[f64; N]) -> Option<[f64; 2]> {
        if !(poses(N) && self.is_pulled()) {
            return None;
        }
        Some(self.pull_along(y, y[PHI].sin_cos()))
    }

    /// The force of the slope, the turntable and the drive at the state vector `y`, from the sine and cosine of phi.
    #[inline(always)]
    fn pull_along<const N: usize>(&self, y: &[f64; N], heading: (f64, f64)) -> [f64; 2] {
        if self.om == 0.0 {
            return sum(pull_along(self.tilt, heading), self.law.losses.given.pushes(y));
        }
        let (precession, w) = self.turning([y[SIN], y[COS], y[P], y[W2], y[W3]]);
        let spin = if self.moves { w[2] - y[COS] * precession } else { 0.0 };
        self.pull_at(y, (y[SIN], y[COS]), y[W2], spin)
    }

    /// These equations with the force of the slope at the state vector `y`.
    pub fn here<const N: usize>(&self, y: &[f64; N]) -> Self {
        let mut here = *self;
        here.stands_at(y);
        here
    }

    /// Whether the force of a slope, a turntable or a drive turns a body that only rocks out of its plane, or will do
    /// so.
    fn is_pulled_aside(&self) -> bool {
        self.om != 0.0 || self.is_driven() || self.law.losses.pull.is_some_and(|[_, aside]| aside != 0.0)
    }

    pub fn holds_drilling(&self) -> bool {
        self.law.losses.holds().drilling
    }

    fn ways(&self) -> Ways {
        self.law.losses.ways.unwrap_or_default()
    }

    /// Makes a landing of the face the only event that ends the phase.
    pub fn go_beyond(&mut self) {
        self.watch = false;
    }

    fn has(&self, law: Law) -> bool {
        self.law.losses.has(law)
    }

    /// Whether dry friction can hold the drilling.
    fn can_hold_drilling(&self) -> bool {
        self.is_patch() || self.has(Law::Drilling)
    }

    /// Sets which rotations friction holds at rest in the state `y`, and the signs of the others.
    fn sets_holds(&mut self, y: &State) {
        let (angle, w) = (y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
        let (spin, drilling) = (y.spin(), self.drills(angle, y.w1, y.w3));
        self.settled = false;
        self.turn(Ways::of(spin, drilling));
        // What a slip has held is at rest up to rounding.
        let still = rounded(angle.0, w);
        let along = spin.abs() <= still && self.has(Law::DryContour);
        let about = drilling.abs() <= still && self.can_hold_drilling();
        if (y.w1 == 0.0 && y.w3 == 0.0 || along && about) && !self.is_pulled_aside() {
            self.rocks_only(angle, y.w2);
        } else {
            if along {
                self.stop(Resting::Contour, angle, w);
            }
            if about {
                self.stop(Resting::Drilling, angle, w);
            }
            if self.has(Law::RollingResistance) && pace_of(angle, y.precession(), w) < REST {
                self.stop_rolling(angle, drilling + self.om);
            }
        }
    }

    #[inline(never)]
    fn turn(&mut self, ways: Ways) {
        self.law.losses.ways = Some(ways);
        self.sloped.losses = self.law.losses.map(Dual::constant);
        self.bare.losses = self.law.losses.off_the_contour();
        let Ways { rocking, holds, .. } = ways;
        let stops = holds.rolling || rocking != 0.0;
        self.moves = !(holds.contour || stops || self.settled);
        self.paced = self.has(Law::RollingResistance) && !stops;
    }

    /// Whether the body only rocks, since no couple turns it.
    fn only_rocks(&self) -> bool {
        self.ways().rocking != 0.0
    }

    fn response(&self, angle: (f64, f64), precession: f64, w: [f64; 3], held: Held<f64>) -> Acted<f64> {
        self.response_under(self.law.losses.pull, angle, precession, w, held)
    }

    #[inline(always)]
    fn response_under(
        &self,
        pull: Option<[f64; 2]>,
        angle: (f64, f64),
        precession: f64,
        w: [f64; 3],
        held: Held<f64>,
    ) -> Acted<f64> {
        let drills = matches!(held, Held::Drilling);
        let acted = self.law.under(pull, angle, precession, w, held);
        self.patch.filter(|_| drills).map_or(acted, |patch| self.held_by(&patch, acted))
    }

    /// Contact force and accelerations, with the rotations that friction holds at rest.
    fn responds(&self, angle: (f64, f64), w: [f64; 3]) -> Acted<f64> {
        self.response(angle, w[0] / angle.0, w, self.held(0.0))
    }

    /// Makes dry friction hold a rotation that has stopped, or makes the rotation begin anew if friction cannot hold
    /// it.
    fn stop(&mut self, part: Resting, angle: (f64, f64), w: [f64; 3]) {
        self.turn(self.ways().holding(part));
        self.turn(self.ways().stopping(part, self.responds(angle, w).held));
        // A body that neither turns along its rim nor drills does not turn at all.
        let Holds { contour, drilling, .. } = self.ways().holds;
        if contour && drilling {
            self.rocks_only(angle, w[1]);
        }
    }

    /// Lets a rotation begin that dry friction has held at rest.
    fn let_go_of(&mut self, part: Resting, angle: (f64, f64), w: [f64; 3]) {
        if part == Resting::Rolling {
            return self.leave(angle, drilling_of(angle, w[0], w[2]));
        }
        self.turn(self.ways().beginning(part, self.responds(angle, w).held[0]));
    }

    /// Makes the body only rock: no couple turns it out of its plane.
    fn rocks_only(&mut self, angle: (f64, f64), w2: f64) {
        self.settled = false;
        self.turn(Ways::default());
        let falls = self.response(angle, 0.0, [0.0, w2, 0.0], Held::Nothing).w[1];
        let rocking = if w2 != 0.0 { w2.signum() } else { falls.signum() };
        self.turn(Ways { rocking, ..Ways::default() });
    }

    /// Whether the required friction has jumped beyond mu N, as where a dry couple has just reversed.
    pub fn jumps(&self, y: &State) -> bool {
        self.force(y).friction_coefficient() > self.mu * (1.0 + JUMP)
    }

    /// The rotations that are at rest in the state `y`, or have just begun.
    pub fn hardly_moves(&self, y: &State) -> Holds {
        let little = 4.0 * REST * (1.0 + y.precession().abs());
        let angle = y.theta.sin_cos();
        let slow = |x: f64| x.abs() < little;
        Holds {
            contour: slow(y.spin()) && self.has(Law::DryContour),
            drilling: slow(self.drills(angle, y.w1, y.w3)) && self.can_hold_drilling(),
            rolling: slow(pace_of(angle, y.precession(), [y.w1, y.w2, y.w3]))
                && self.has(Law::RollingResistance),
        }
    }

    /// Makes rolling resistance hold a body that neither rolls nor rocks, if its limit suffices; else rolling and
    /// rocking begin, in the direction of the couple on them. Dry friction along the contour holds the contact point,
    /// or lets it go.
    fn stop_rolling(&mut self, angle: (f64, f64), drilling: f64) {
        if self.keeps_still(angle, drilling) {
            self.turn(self.ways().holding_rolling());
            if self.om != 0.0 && (drilling - self.om).abs() <= rounded(angle.0, [drilling; 3]) {
                self.drills_away(angle);
            }
        } else {
            self.leave(angle, drilling);
        }
    }

    /// Lets rolling and rocking begin from rest.
    fn leave(&mut self, angle: (f64, f64), drilling: f64) {
        let (reduced, w) = (self.law.rates.reduced(), [angle.0 * drilling, 0.0, angle.1 * drilling]);
        let rubs = match reduced.contact {
            Contact::Rolling => Rubs::Rests,
            Contact::Smooth => Rubs::Slips { pull: [0.0; 2], twist: 0.0 },
        };
        let seen = self.law.losses.seen(&reduced.shape.rim, angle, drilling, w);
        let mut losses = self.law.losses.linear(&seen, |_| 1.0);
        if let Some(patch) = self.patch {
            losses = losses.resisting(Law::Drilling, patch.grips(0.0, 1.0));
        }
        let Some(rests) = Together::of_body(&reduced.shape, &losses, (angle, w), [0.0; 2], rubs) else {
            return;
        };
        let (ways, push) = self.ways().deciding(rests, Some((Resting::Rolling, true)));
        self.push = push;
        self.turn(ways);
    }

    /// Whether a body that only turns about the vertical, with this w_z, neither rolls nor rocks.
    fn keeps_still(&self, angle: (f64, f64), drilling: f64) -> bool {
        let mut still = *self;
        still.turn(self.ways().holding_rolling());
        holds(still.responds(angle, [angle.0 * drilling, 0.0, angle.1 * drilling]).held)
    }

    /// Whether the body is at rest, and rolling resistance keeps it there.
    pub fn has_stopped(&self, y: &State) -> bool {
        let (s, c) = y.theta.sin_cos();
        let w = [y.w1, y.w2, y.w3];
        let turns = self.drills((s, c), y.w1, y.w3).abs() > rounded(s, w);
        if self.om != 0.0 {
            // A slope pulls a body that turns with the table in all directions.
            let [couple, limit] = self.carries((s, c));
            return self.ways().holds.rolling && self.tilt == 0.0 && !turns && couple.abs() <= limit;
        }
        if self.only_rocks() {
            return self.has(Law::RollingResistance) && y.w2.abs() < REST && self.keeps_still((s, c), 0.0);
        }
        // On a slope a couple may turn a body that only stands on its rim.
        let begins = || self.responds((s, c), [0.0; 3]).w.into_iter().any(|rate| rate.abs() > REST);
        self.ways().holds.rolling && !turns && !(self.is_pulled() && begins())
    }

    /// Lets the drilling begin of a body that turns with the table without rolling or rocking, if friction cannot
    /// hold it.
    fn drills_away(&mut self, angle: (f64, f64)) {
        let [couple, limit] = self.carries(angle);
        let begins = if couple.abs() > limit { -sign_or_zero(couple) } else { 0.0 };
        self.turn(Ways { drilling: begins, ..self.ways() });
    }

    /// The couple about the vertical that a body needs to turn with the table without rolling or rocking, and the
    /// largest couple that friction can exert.
    fn carries(&self, (s, c): (f64, f64)) -> [f64; 2] {
        let Shape { rim, i1, i3 } = &self.law.rates.reduced().shape;
        let (far, mut still) = (rim.lever((s, c)), *self);
        still.turn(Ways { drilling: 0.0, ..self.ways() });
        let acted = still.responds((s, c), [s * self.om, 0.0, c * self.om]);
        let turn = drilling_of((s, c), acted.w[0], acted.w[2]);
        let [normal, along, across] = acted.force;
        let drags = self.law.losses.coefficient(Law::Drilling);
        let limit = self.patch.map_or(drags, |patch| patch.grips(along.hypot(across), normal));
        [-turn * (i1 * s * s + i3 * c * c + far * far), limit]
    }

    /// Returns w, with a small speed in the direction in which rolling and rocking begin from rest.
    fn pushed(&self, y: &State) -> [f64; 3] {
        let mut numbers = [y.theta.sin(), y.theta.cos(), y.w1, y.w2, y.w3];
        self.pushed_off(&mut numbers);
        [numbers[P], numbers[W2], numbers[W3]]
    }

    /// Changes which rotations are held after a halt of the integration. Returns whether the body is at rest.
    pub fn after(&mut self, halt: Halt, y: &State) -> bool {
        let (angle, w) = (y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
        self.starts_still = halt == Halt::Drilling;
        let holds = self.ways().holds;
        let drilling = drilling_of(angle, y.w1, y.w3);
        match halt {
            _ if let Some(part) = holds.ceasing(halt) => self.let_go_of(part, angle, w),
            Halt::Contour if self.settled => {
                // A settled contact stops where dry friction balances the push, so that friction holds
                // it in any case.
                self.settled = false;
                self.turn(self.ways().holding(Resting::Contour));
            }
            Halt::Contour => self.stop(Resting::Contour, angle, w),
            // Without the drilling the body may begin to rock.
            Halt::Drilling if holds.rolling && self.om != 0.0 => {
                self.drills_away(angle);
                return self.has_stopped(y);
            }
            Halt::Drilling if holds.rolling => return !self.rocks_back(angle),
            Halt::Drilling if !self.moves => self.rocks_only(angle, w[1]),
            Halt::Drilling => self.stop(Resting::Drilling, angle, w),
            Halt::Rocking => return !self.rocks_back(angle),
            Halt::Rests => {
                self.stop_rolling(angle, drilling);
                return self.has_stopped(y);
            }
            Halt::Settles if holds.drilling => self.rocks_only(angle, w[1]),
            Halt::Settles => {
                (self.settled, self.settled_way) = (true, self.ways().contour);
                self.turn(Ways { contour: 0.0, ..self.ways() });
            }
            _ => {}
        }
        false
    }

    /// Whether a body that only rocks, and has come to rest, rocks back; if not, rolling resistance holds it.
    fn rocks_back(&mut self, angle: (f64, f64)) -> bool {
        self.rocks_only(angle, 0.0);
        !self.keeps_still(angle, 0.0)
    }

    /// The same equations after the start, where w_z does not vanish exactly.
    pub fn on_the_way(&self) -> Self {
        Self { starts_still: false, ..*self }
    }

    /// Gives a body at rest that friction does not hold a small speed in the direction in which rolling and rocking
    /// begin.
    fn pushed_off<const N: usize>(&self, y: &mut [f64; N]) {
        let [s, c, w1, w2, w3] = core::array::from_fn(|i| y[i]);
        if !self.paced || pace_of((s, c), w1 / s, [w1, w2, w3]) >= REST {
            return;
        }
        let drilling = drilling_of((s, c), w1, w3);
        let [rolling, rocking] = self.push.map(|n| 2.0 * REST * n);
        (y[P], y[W2], y[W3]) = (s * drilling + c * rolling, rocking, c * drilling - s * rolling);
    }

    /// The state vector in the variables of this phase, from the state vector `shown` in the variables that all
    /// phases share.
    pub fn enter<const N: usize>(&self, shown: &[f64; N]) -> [f64; N] {
        let mut y = *shown;
        self.pushed_off(&mut y);
        let [s, c, mut w1, mut w3] = [y[SIN], y[COS], y[P], y[W3]];
        if self.starts_still && self.moves {
            // Here w_z vanishes exactly, and its rounding error is removed.
            let off = self.drills((s, c), w1, w3);
            if c.abs() > 0.5 {
                w3 -= off / c
            } else {
                w1 -= off / s
            }
            y[W3] = w3;
        }
        y[P] = if self.moves {
            w1 * s
        } else if self.only_rocks() {
            0.0
        } else {
            drilling_of((s, c), w1, w3)
        };
        (y[UH], y[U2]) = (0.0, 0.0);
        y
    }

    fn held<T: Real>(&self, like: T) -> Held<T> {
        let holds = self.law.losses.holds();
        match self.moves {
            true if holds.drilling => Held::Drilling,
            true => Held::Nothing,
            false if holds.rolling => Held::Rolling,
            false => Held::Contour(like.splat(0.0)),
        }
    }

    /// The precession phi' and w from a state vector; psi' of a held or settled contact point counts as zero.
    #[inline(always)]
    fn turning<T: Real>(&self, y: [T; 5]) -> (T, [T; 3]) {
        let [s, c, p, w2, _] = y;
        if self.moves { free::turning(y) } else { (p, [s * p, w2, c * p]) }
    }

    /// The halt by the first condition of the phase that fails at its start; None if all conditions hold.
    pub fn at_start(&self, y: &State) -> Option<Halt> {
        let (angle, w) = (y.theta.sin_cos(), self.pushed(y));
        let acted = self.responds(angle, w);
        let [normal, along, across] = acted.force;
        if leaves(self.range, y.theta, [y.w2, acted.w[1]]) {
            Some(Halt::Side)
        } else if normal <= 0.0 {
            Some(Halt::LiftOff)
        } else if self.mu.is_finite() && along.hypot(across) > self.mu * normal * (1.0 + GRACE) + 1e-15 {
            Some(Halt::Slips)
        } else {
            None
        }
    }

    /// The contact force in the state `y` of this phase.
    pub fn force(&self, y: &State) -> Force {
        let (angle, w) = (y.theta.sin_cos(), self.pushed(y));
        let [normal, along, across] = self.responds(angle, w).force;
        Force { normal, along, across }
    }

    /// The time that a face which is almost on the table needs to land, and the error of that time.
    pub fn rest_of<const N: usize>(&self, shown: &[f64; N]) -> (f64, f64) {
        let [s, c, w1, w2, w3] = core::array::from_fn(|i| shown[i]);
        let (falls, i1) = (if c * w2 > 0.0 { s / (c * w2) } else { 0.0 }, self.law.rates.reduced().shape.i1);
        let acted = self.here(shown).responds((s, c), [w1, w2, w3]);
        if !self.moves || falls > 0.0 && turning_share(i1, s, w1, w2) < 0.25 {
            if w2 * w2 > s || falls == 0.0 {
                return (falls, falls * falls.max(s));
            }
            // The face falls more and more slowly, with w2 ~ s^a. For a = 1 it never lands: s falls by a
            // factor e in each time `falls`, and the landing is set to ten such times after `FLAT`.
            let slower = -(c * acted.w[1] * s) / (w2 * w2);
            let nearer = (s / FLAT).max(1.0).ln() + 10.0;
            let times = if slower < 0.9 { 1.0 / (1.0 - slower.max(0.0)) } else { nearer };
            return (falls * times, falls);
        }
        // If a body lands after infinitely many turns, its energy E = (3/2) a s falls as the square of
        // the time left.
        let resisted = self.law.losses.coefficient(Law::RollingResistance) * acted.force[0];
        // Only the power of rolling resistance counts, since drilling friction takes energy of the
        // drilling alone.
        let power =
            if resisted > 0.0 { resisted * pace_of((s, c), w1 / s, [w1, w2, w3]) } else { acted.power };
        let left = if power > 0.0 { 3.0 * s * self.law.rates.reduced().shape.rim.a / power } else { 0.0 };
        (left, if s > 2.0 * FLAT { left } else { left * left })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::state::spin_of;

    #[test]
    fn where_a_body_at_rest_begins_to_roll_dry_friction_along_the_rim_resists_the_way_it_begins() {
        // Without a drag on the drilling nothing pushes the body along its rim, by symmetry.
        let losses =
            Losses::of(Law::RollingResistance, 1e-3).with(Law::DryContour, 1e-4).with(Law::Drilling, 0.1);
        let mut begun = 0;
        for k in 0..200 {
            let part = |i: u32| (0.618_033_988_75 * f64::from(7 * k + i)).fract();
            let body = Body::solid(0.05 + part(1)).unwrap();
            let (theta, drilling) = (0.3 + part(2), 6.0 * part(3) - 3.0);
            let (s, c) = theta.sin_cos();
            let y = State { theta, w1: s * drilling, w2: 0.0, w3: c * drilling };
            let flow = LossyFlow::new((&body, Contact::Rolling), 1.0, (&losses, ()), 1e-10, &y);
            let [w1, _, w3] = flow.pushed(&y);
            let spin = spin_of((s, c), w1, w3);
            if flow.moves && flow.ways().contour != 0.0 {
                assert!(spin * flow.ways().contour > 0.0, "{body:?} {y:?}: {spin} {:?}", flow.ways());
                begun += 1;
            }
        }
        assert!(begun > 50, "{begun}");
    }
}
