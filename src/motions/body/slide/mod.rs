//! A body that slips, from an initial slip or from rest, to the end of its slip.
//!
//! ```text
//! y = (s, c, w1, w2, w3, u_h, u_2, t, heat; phi, psi, x, y)        in sigma, dt = |u|/(|u| + soft) dsigma
//! u = 0   reached as exp(-sigma); the last part is one step, where its error is below a hundredth of a tolerance
//! N0 = 0,   eps = 1,   theta = 0,   theta = theta_end                margins that turn negative
//! ```
//! [`rk8`] takes the steps. A margin that becomes negative within a step, even if it is positive again at the
//! end, is located on parts of the step; states at requested times are computed on such parts, too.
//! [`contact::slip`](crate::laws::contact::slip) has the equations.
//!
//! Error: 1e-11 in states and 1e-12 in times; a test of `test_slip_reference` has 25 motions to 25 digits.

mod creeps;
mod flow;
mod lossy;
mod onset;
mod slips;
pub(crate) mod slow;
mod standstill;

use super::face::FLAT;
use super::own::Own;
use crate::laws::body::{Body, Shape, leaves};
use crate::laws::contact::Force;
use crate::laws::contact::slip::{Friction, SlipResponse, Slipping};
use crate::laws::loss::{Couples, Law, Losses};
use crate::laws::state::{State, drilling_of};
use crate::motions::dry::creep::Creeping;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, Halt, PHI, SIN, W1, W2, W3, X, Y, carried, contact_velocity, driven, poses, pull, sum,
};
use crate::numbers::Dual;
pub(super) use creeps::is_still;
pub(crate) use flow::longest;

/// Sine of theta at which a slipping face counts as landed if it comes down by infinitely many turns. It is smaller
/// than `FLAT`, since the time of the landing is extrapolated from the last turns.
const FLATTER: f64 = 1e-14;

/// The equations of a body that slips, and the ends of its slip.
#[derive(Clone, Copy)]
pub(crate) struct Slide<L = ()> {
    pub law: Slipping<f64, L, L>,
    /// The law for dual numbers (a value and its slope).
    sloped: Slipping<Dual<f64>, L, L>,
    /// The law without the couples along the contour.
    bare: Slipping<f64, L, L>,
    /// The inclinations between which the circle of contact carries the body.
    range: [f64; 2],
    ball: bool,
    sticks: bool,
    /// Sine of theta at which a face counts as landed.
    flat: f64,
    /// Whether a couple that grows with psi' has almost stopped the contact point along the rim.
    pub settled: bool,
    /// The steady creep (slow slip) of a uniform ball on a patch, without losses other than rolling resistance, in
    /// which every slip ends. `died` is whether the slip has become this creep.
    pub(super) creeping: Option<Creeping>,
    pub died: bool,
    /// Whether rolling and rocking begin from rest, in the direction that the signs in the loss laws give.
    rolls_off: bool,
    /// Whether there are loss laws of the library, not only user-defined ones.
    has_laws: bool,
    /// The share by which the couple that holds the contact point along the rim may exceed its limit after the
    /// contact has settled.
    sure: f64,
    pub tol: f64,
    /// The tangent of the slope; `turning` is the rate at which the table turns.
    pub tilt: f64,
    pub turning: f64,
}

impl<L: Own> Slide<L> {
    pub fn new(body: &Body, friction: &Friction, losses: &Losses, tol: f64, own: L) -> Self {
        let law = Slipping::on(body, friction).varying(own).with_losses(Couples::with_own(losses, own));
        let dual = Dual::constant;
        let sloped = Slipping::of(&law.shape.map(dual), dual(law.strength), law.dry).varying(own);
        let sloped =
            sloped.with_losses(law.losses.map(|losses| losses.map(dual))).with_patch(law.patch().map(dual));
        let (range, ball) = (body.carries(), body.is_ball());
        let bare = law.with_losses(law.losses.map(Couples::off_the_contour));
        let flat = if losses.turn_endlessly() { FLATTER } else { FLAT };
        Self {
            law,
            sloped,
            bare,
            range,
            ball,
            sticks: law.dry,
            flat,
            settled: false,
            creeping: law.patch().filter(|_| body.is_uniform_ball() && !own.has_couple()).and_then(
                |radius| {
                    let arm = losses.is_only(Law::RollingResistance)?;
                    Creeping::under(body.i3(), [law.strength, radius, arm])
                },
            ),
            died: false,
            rolls_off: false,
            has_laws: !losses.is_none(),
            sure: 0.0,
            tol,
            tilt: 0.0,
            turning: 0.0,
        }
    }

    /// These equations on a slope with the tangent `tilt`, or on a table that turns at the rate `turning`.
    pub fn on_table(mut self, [tilt, turning]: [f64; 2]) -> Self {
        let turns = turning != 0.0;
        (self.tilt, self.turning) = (tilt, turning);
        (self.law, self.bare) = (self.law.over(turning, turns), self.bare.over(turning, turns));
        self.sloped = self.sloped.over(Dual::constant(turning), turns);
        self
    }

    /// The drilling rate, w_z relative to the table, from w1 and w3.
    #[inline(always)]
    pub fn drills(&self, angle: (f64, f64), w1: f64, w3: f64) -> f64 {
        drilling_of(angle, w1, w3) - self.turning
    }

    /// Calls a user-defined drive (a force and a couple on the body) at the state vector `y`; its answer stays in `self` for
    /// the equations.
    #[inline(always)]
    pub fn asks_drive<const N: usize>(&self, y: &[f64; N]) {
        if L::IS && self.law.varies().drives() {
            let (angle, w, u) = (y.angle(), y.w(), y.slip());
            self.law.varies().asks_drive(y, w, u, self.law.centre(angle, w, u), 0.0);
        }
    }

    /// The power of the force that a user-defined drive returned at its last call, at the state vector `y`.
    pub fn power_of_drive<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let [push_h, push_2] = self.law.varies().pushes(y);
        let [v_h, v_2] = self.law.centre(y.angle(), y.w(), y.slip());
        push_h * v_h + push_2 * v_2
    }

    /// The acceleration along e_h and e2 by the slope, the turntable and the drive (at its last call), which is added
    /// to that of the slip.
    pub fn pull<const N: usize>(&self, y: &[f64; N]) -> [f64; 2] {
        let tilted = sum(pull(self.tilt, y), self.law.varies().pushes(y));
        if self.turning == 0.0 {
            return tilted;
        }
        let ((s, c), [w1, _, w3]) = (y.angle(), y.w());
        driven(self.turning, tilted, self.runs(y, w3 - c * w1 / s, y[PHI].sin_cos()))
    }

    /// The velocity at which the point of contact moves in the laboratory, along e_h and e2.
    #[inline(always)]
    fn runs<const N: usize>(&self, y: &[f64; N], spin: f64, heading: (f64, f64)) -> [f64; 2] {
        let over = contact_velocity(&self.law.shape.rim, y.angle(), y[W2], spin, y.slip());
        if self.turning == 0.0 { over } else { sum(over, carried(self.turning, y, heading)) }
    }

    /// The law of a slip without user-defined laws.
    pub fn of_the_library(&self) -> Slipping<f64> {
        self.law.varying(()).with_losses(self.law.losses.map(|losses| losses.beside(())))
    }

    /// Contact force and accelerations of a body that slips with the velocity `u`, or that begins to slip along
    /// `way`, and the power of its losses.
    pub fn slips(
        &self,
        angle: (f64, f64),
        w: [f64; 3],
        u: [f64; 2],
        way: Option<[f64; 2]>,
    ) -> (SlipResponse<f64>, f64) {
        let at = match way {
            Some(way) => self.law.towards(angle, w, u, way),
            None => self.law.at(angle, w, u).0,
        };
        (at, self.law.power(angle, w, at.force[0]))
    }

    /// The energy of the body at the state vector `y`; on a turntable minus its rate times the angular momentum about
    /// the vertical.
    pub fn energy<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let state = State { theta: y[SIN].atan2(y[COS]), w1: y[W1], w2: y[W2], w3: y[W3] };
        self.law.energy(&state, y.slip()) + self.energy_on_table(y)
    }

    /// The difference of [`energy`](Self::energy) from that of a body that slips as fast on a level table at rest.
    pub fn energy_on_table<const N: usize>(&self, y: &[f64; N]) -> f64 {
        if self.tilt == 0.0 && self.turning == 0.0 || !poses(N) {
            return 0.0;
        }
        let (Shape { rim, i1, i3 }, (s, c), (sin, cos)) = (&self.law.shape, y.angle(), y[PHI].sin_cos());
        // The centre falls along x. It is at (x, z), and g om faster over the table there than at the contact point.
        let (x, z) = (y[X] - rim.lever((s, c)) * cos, y[Y] - rim.lever((s, c)) * sin);
        let [_, v_2] = self.law.centre((s, c), y.w(), y.slip());
        let ahead = self.turning * rim.lever((s, c));
        let spins = i1 * s * y[W1] + i3 * c * y[W3];
        let carried = self.turning * spins + 0.5 * self.turning * self.turning * (x * x + z * z);
        ahead * (v_2 + 0.5 * ahead) - carried - self.tilt * x
    }

    /// Contact force and accelerations of the body; one compiled copy of the law for callers that need it only once
    /// in a step.
    #[inline(never)]
    pub(super) fn acts(&self, angle: (f64, f64), w: [f64; 3], u: [f64; 2]) -> SlipResponse<f64> {
        self.law.answers(angle, w, u).0
    }

    /// The contact force in the state `y`; a slip that begins from rest has the direction `way`.
    pub fn force(&self, y: &State, slip: [f64; 2], way: [f64; 2]) -> Force {
        if L::IS && slip == [0.0; 2] {
            let [normal, along, across] =
                self.law.towards(y.theta.sin_cos(), [y.w1, y.w2, y.w3], slip, way).force;
            return Force { normal, along, across };
        }
        self.law.force(y, if slip == [0.0; 2] { way } else { slip })
    }

    /// The halt by the first condition that fails at the start of a slip; None if all conditions hold.
    pub fn at_start(&self, y: &State, u: [f64; 2]) -> Option<Halt> {
        let (s, c) = y.theta.sin_cos();
        let at = self.acts((s, c), [y.w1, y.w2, y.w3], u);
        if at.room <= 0.0 {
            Some(Halt::Jam)
        } else if leaves(self.range, y.theta, [y.w2, at.w[1]]) {
            Some(Halt::Side)
        } else if at.free <= 0.0 {
            Some(Halt::LiftOff)
        } else {
            None
        }
    }
}
