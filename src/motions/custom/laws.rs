//! Calls user-defined laws from the library's equations of motion.
//!
//! ```text
//! mu     follows the speed of a slip
//! m(N)   secants of the couple, until N no longer changes:   m = m0 + N mN there
//! F, m   of a drive, which a flow asks once at each place, before it evaluates its equations
//! ```
//! A user-defined law has no derivative; its slopes are computed from differences.

use crate::error::Error;
use crate::laws::body::Body;
use crate::laws::contact::lying::{Flat, Lying};
use crate::laws::contact::slip::FollowsSpeed;
use crate::laws::custom::{
    CoupleLaw, Custom, DriveLaw, FrictionLaw, Moment, Push, SpeedLaw, fault_of_couple, fault_of_drive,
    fault_of_friction,
};
use crate::laws::loss::{Couple, Kinematics, OwnCouple};
use crate::laws::state::{Slip, State};
use crate::motions::body::own::Own;
use crate::motions::dry::creep::ASIDE;
use crate::motions::dry::friction::OwnFriction;
use crate::motions::walk::numbers::{COS, PHI, PSI, SIN, TIME, X, Y};
use crate::numbers::{Dual, Real};
use core::cell::Cell;
use core::f64::consts::{FRAC_PI_2, PI};
use nalgebra::{Point2, Vector2, Vector3};

/// Largest number of secant steps in the search for a normal force that agrees with a user-defined couple.
const SECANTS: usize = 40;
/// The normal force, in M g, at which a user-defined couple is first evaluated. It differs from 1, that of a body at
/// rest, since two values give the dependence on the normal force.
const FIRST_NORMAL: f64 = 0.75;

/// The user-defined laws of a motion, with their last values and errors.
#[derive(Clone, Copy)]
pub(crate) struct OwnLaws<'a> {
    /// The body, counted from its lower end; `over` is whether the current state is counted from the upper end.
    pub body: &'a Body,
    pub over: &'a Cell<bool>,
    pub custom: Custom<'a>,
    /// The error of the last wrong value of a law since the last step that was taken.
    pub fault: &'a Cell<Option<Error>>,
    /// The sine and cosine of theta and w for which the couple was last computed, and this couple.
    pub last: &'a Cell<([f64; 5], Option<Couple<f64>>)>,
    /// The time at the start; `driven` is the last value of the drive.
    pub since: f64,
    pub driven: &'a Cell<Option<Driven>>,
}

/// The force and couple of a user-defined drive at one moment.
#[derive(Clone, Copy)]
pub(crate) struct Driven {
    now: Moment,
    push: Push,
    /// The couple along the e1, e2, e3 of the current state, which may be counted from the other end of the body.
    couple: [f64; 3],
}

/// The state from sine and cosine of theta and w, after the sign of its e1 and e2: -1 if a ball has passed the
/// vertical and leans to the other side.
fn upright_state([s, c, w1, w2, w3]: [f64; 5]) -> (f64, State) {
    let side = if s < 0.0 { -1.0 } else { 1.0 };
    (side, State { theta: (side * s).atan2(c), w1: side * w1, w2: side * w2, w3 })
}

impl<'a> OwnLaws<'a> {
    /// The law of friction, if there is one.
    fn friction(&self) -> Option<OwnFriction<'a>> {
        self.custom.friction.map(|law| OwnFriction { law, fault: self.fault })
    }

    /// The state counted from the lower end of a body with several rims, and -1 if the given state is counted from
    /// the other end, else 1.
    fn seen_from_lower_rim(&self, y: &State) -> (State, f64) {
        let two = self.body.ell() > 0.0 && self.body.theta_end() == FRAC_PI_2;
        let over = if self.body.has_row() { self.over.get() } else { two && y.theta > FRAC_PI_2 };
        if !over {
            return (*y, 1.0);
        }
        (State { theta: PI - y.theta, w2: -y.w2, w3: -y.w3, ..*y }, -1.0)
    }

    /// Calls the drive at this state, slip, velocity of the centre and height.
    fn driven_at<const N: usize>(
        &self,
        law: &dyn DriveLaw,
        y: &[f64; N],
        [w1, w2, w3]: [f64; 3],
        [u_h, u_2]: [f64; 2],
        [v_h, v_2]: [f64; 2],
        height: f64,
    ) -> Driven {
        let (side, state) = upright_state([y[SIN], y[COS], w1, w2, w3]);
        let (state, over) = self.seen_from_lower_rim(&state);
        // The lean is told the other way round, past a pole and from the other rim.
        let turned = |turns: f64| if turns < 0.0 { PI } else { 0.0 };
        let (phi, psi) = (y[PHI] + turned(side) - turned(over), y[PSI] - turned(side));
        let (sin, cos) = y[PHI].sin_cos();
        let now = Moment {
            time: self.since + y[TIME],
            state,
            slip: Slip { u_h, u_2 }.map(|u| side * over * u),
            phi,
            psi: over * psi,
            contact_point: Point2::new(y[X], y[Y]),
            height,
            velocity: Vector2::new(v_h * cos - v_2 * sin, v_h * sin + v_2 * cos),
        };
        if law.has_failed() {
            let push = Push { force: Vector2::repeat(f64::NAN), couple: Vector3::repeat(f64::NAN) };
            return Driven { now, push, couple: [f64::NAN; 3] };
        }
        let push = law.push(self.body, &now);
        if y.iter().all(|x| x.is_finite())
            && let Some(fault) = fault_of_drive(&push, &now)
        {
            self.fault.set(Some(fault));
        }
        let [m1, m2, m3]: [f64; 3] = push.couple.into();
        Driven { now, push, couple: [side * m1, side * over * m2, over * m3] }
    }

    /// The couple of a user-defined law for this sine and cosine of theta, w and normal force.
    fn value(&self, law: &dyn CoupleLaw, y: [f64; 5], normal: f64) -> [f64; 3] {
        let (side, y) = upright_state(y);
        let [m1, m2, m3] = self.couple_or_nan(law, &y, normal);
        [side * m1, side * m2, m3]
    }

    /// The couple of a user-defined law; NaN if the law has failed, or if its value is wrong, which is recorded.
    fn couple_or_nan(&self, law: &dyn CoupleLaw, y: &State, normal: f64) -> [f64; 3] {
        if law.has_failed() {
            return [f64::NAN; 3];
        }
        let ((seen, side), normal) = (self.seen_from_lower_rim(y), normal.positive_part());
        let [m1, m2, m3] = law.couple(self.body, &seen, normal);
        if (m1 + m2 + m3).is_nan() && [y.theta, y.w1, y.w2, y.w3].iter().all(|x| x.is_finite()) {
            self.fault.set(fault_of_couple([m1, m2, m3], &seen, normal));
        }
        [m1, side * m2, side * m3]
    }

    /// Finds the couple of a law that agrees with the normal force that `normal` computes from it.
    fn couple_by_secants(
        &self,
        law: &'a dyn CoupleLaw,
        at: [f64; 5],
        normal: impl Fn(&Couple<f64>) -> f64,
    ) -> Couple<f64> {
        let mut before = (FIRST_NORMAL, self.value(law, at, FIRST_NORMAL));
        let mut found = Couple { free: before.1, pressed: [0.0; 3] };
        for i in 0..=SECANTS {
            let next = normal(&found);
            if i == SECANTS {
                found.free = [f64::NAN; 3];
            }
            if next.is_nan() || (next - before.0).abs() <= 4.0 * f64::EPSILON * (1.0 + next.abs()) {
                break;
            }
            let m = self.value(law, at, next);
            if m == before.1 {
                break;
            }
            let pressed: [f64; 3] = core::array::from_fn(|i| (m[i] - before.1[i]) / (next - before.0));
            found = Couple { free: core::array::from_fn(|i| m[i] - pressed[i] * next), pressed };
            before = (next, m);
        }
        self.last.set((at, Some(found)));
        found
    }
}

impl SpeedLaw for OwnLaws<'_> {
    fn varies(&self) -> bool {
        self.custom.friction.is_some()
    }
    fn coefficient_at(&self, speed: f64) -> f64 {
        self.friction().coefficient_at(speed)
    }
}

impl FollowsSpeed<f64> for OwnLaws<'_> {
    fn strength(&self, constant: f64, speed: impl FnOnce() -> f64, dry: bool) -> f64 {
        self.friction().map_or(constant, |own| own.strength(constant, speed, dry))
    }
}

impl FollowsSpeed<Dual<f64>> for OwnLaws<'_> {
    fn strength(&self, constant: Dual<f64>, speed: impl FnOnce() -> Dual<f64>, dry: bool) -> Dual<f64> {
        self.friction().map_or(constant, |own| own.strength(constant, speed, dry))
    }
}

/// The sum of a law's couple and a couple that does not depend on the normal force.
fn beside<T: Real>(found: Option<Couple<T>>, [m1, m2, m3]: [T; 3]) -> Couple<T> {
    let zero = m1.splat(0.0);
    let Couple { free: [a, b, c], pressed } = found.unwrap_or(Couple { free: [zero; 3], pressed: [zero; 3] });
    Couple { free: [a + m1, b + m2, c + m3], pressed }
}

impl OwnCouple<f64> for OwnLaws<'_> {
    fn is_there(&self) -> bool {
        self.custom.couple.is_some() || self.drives()
    }

    #[inline(never)]
    fn solved_couple(
        &self,
        seen: &Kinematics<f64>,
        normal: impl Fn(&Couple<f64>) -> f64,
    ) -> Option<Couple<f64>> {
        let ((s, c), [w1, w2, w3]) = (seen.angle, seen.w);
        let driven = self.driven().1;
        let under = |found: &Couple<f64>| normal(&beside(Some(*found), driven));
        let found = self.custom.couple.map(|law| self.couple_by_secants(law, [s, c, w1, w2, w3], under));
        if self.drives() { Some(beside(found, driven)) } else { found }
    }

    fn power_taken(&self, seen: &Kinematics<f64>, normal: f64) -> Option<f64> {
        let ((s, c), [w1, w2, w3]) = (seen.angle, seen.w);
        let at = [s, c, w1, w2, w3];
        let power = |m: [f64; 3]| m[0] * w1 + m[1] * w2 + m[2] * w3;
        let own = self.custom.couple.map(|law| match self.last.get() {
            (there, Some(found)) if there == at => found.under(normal),
            _ => self.value(law, at, normal),
        });
        OwnCouple::<f64>::is_there(self).then(|| -own.map_or(0.0, power) - power(self.driven().1))
    }
}

impl OwnCouple<Dual<f64>> for OwnLaws<'_> {
    fn is_there(&self) -> bool {
        OwnCouple::<f64>::is_there(self)
    }

    /// The couple of the law and its slope, which for the part that does not depend on the normal force is taken at a
    /// constant normal force. A drive has no slope.
    #[inline(never)]
    fn solved_couple(
        &self,
        seen: &Kinematics<Dual<f64>>,
        normal: impl Fn(&Couple<Dual<f64>>) -> Dual<f64>,
    ) -> Option<Couple<Dual<f64>>> {
        let ((s, c), [w1, w2, w3]) = (seen.angle, seen.w);
        let (y, still) = ([s, c, w1, w2, w3], Dual::constant);
        let driven = self.driven().1.map(still);
        let Some(law) = self.custom.couple else {
            return self.drives().then(|| beside(None, driven));
        };
        let normal = |found: &Couple<Dual<f64>>| normal(&beside(Some(*found), driven));
        let dual =
            |found: &Couple<f64>| Couple { free: found.free.map(still), pressed: found.pressed.map(still) };
        let at = |found: &Couple<f64>| normal(&dual(found)).value;
        let found = self.couple_by_secants(law, y.map(|x| x.value), at);
        let normal = at(&found);
        let fastest = y.iter().fold(1.0, |most: f64, x| most.max(x.value.abs()));
        let changes = y.iter().fold(0.0, |most: f64, x| most.max(x.slope.abs()));
        let mut all = dual(&found);
        if changes > 0.0 {
            let by = ASIDE * fastest / changes;
            let aside = |by: f64| self.value(law, y.map(|x| by.mul_add(x.slope, x.value)), normal);
            let [before, after] = [aside(-by), aside(by)];
            (0..3).for_each(|i| all.free[i].slope = (after[i] - before[i]) / (2.0 * by));
        }
        Some(beside(Some(all), driven))
    }
}

impl Own for OwnLaws<'_> {
    const IS: bool = true;

    fn couple_at(&self, y: &State, normal: f64) -> [f64; 3] {
        self.custom.couple.map_or([0.0; 3], |law| self.couple_or_nan(law, y, normal))
    }

    fn drives(&self) -> bool {
        self.custom.drive.is_some()
    }
    fn asks_drive<const N: usize>(
        &self,
        y: &[f64; N],
        w: [f64; 3],
        slip: [f64; 2],
        velocity: [f64; 2],
        height: f64,
    ) {
        self.driven.set(self.custom.drive.map(|law| self.driven_at(law, y, w, slip, velocity, height)));
    }
    fn driven(&self) -> ([f64; 2], [f64; 3]) {
        self.driven
            .get()
            .map_or(([0.0; 2], [0.0; 3]), |Driven { push, couple, .. }| (push.force.into(), couple))
    }

    fn sees(&self, over: bool) {
        self.over.set(over);
    }
    fn has_failed(&self) -> bool {
        self.custom.has_failed()
    }

    fn takes_fault(&self) -> Option<Error> {
        self.fault.take().filter(|_| !self.custom.has_failed())
    }

    fn is_faulty(&self) -> bool {
        self.custom.has_failed() || self.fault.get().is_some()
    }

    fn finds_fault(&self, speeds: &[f64], at: Option<([f64; 5], f64)>) -> bool {
        if !self.custom.has_failed() {
            let slow = |law: &dyn FrictionLaw| {
                speeds.iter().find_map(|&speed| fault_of_friction(law.coefficient(speed), speed))
            };
            let turns = |(law, (y, normal)): (&dyn CoupleLaw, ([f64; 5], f64))| {
                let (seen, normal) =
                    (self.seen_from_lower_rim(&upright_state(y).1).0, normal.positive_part());
                fault_of_couple(law.couple(self.body, &seen, normal), &seen, normal)
            };
            let drives = self.driven.get().and_then(|driven| fault_of_drive(&driven.push, &driven.now));
            let fault = drives.or_else(|| self.custom.couple.zip(at).and_then(turns));
            self.fault.set(fault.or_else(|| self.custom.friction.and_then(slow)));
        }
        self.is_faulty()
    }

    fn lying(&self, law: &Lying<f64>, y: Flat<f64>) -> Lying<f64> {
        let ([w1, w3, u_h, u_2], [other_h, other_2]) = (y, law.other_slip(y));
        let of = |constant: f64, speed: f64| FollowsSpeed::<f64>::strength(self, constant, || speed, law.dry);
        let [low, up] = law.strength;
        let strength = [of(low, u_h.hypot(u_2)), of(up, other_h.hypot(other_2))];
        let (s, c) = law.border.angle;
        let state = State { theta: s.atan2(c), w1, w2: 0.0, w3 };
        let own = self.has_couple().then(|| self.couple_at(&state, 1.0));
        Lying { strength, own, ..*law }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A couple that depends on the whole state, and linearly on the normal force.
    fn couple(_: &Body, y: &State, normal: f64) -> [f64; 3] {
        let size = (0.1 + 0.2 * normal) * (1.0 + y.theta + y.w1 * y.w1 + y.w2 * y.w3);
        [y.w1, y.w2, y.w3].map(|w| -size * w)
    }

    const Y: [f64; 5] = [0.6, 0.8, 0.7, -0.4, 1.3];

    fn laws<T>(of: impl FnOnce(&OwnLaws<'_>) -> T) -> T {
        let (body, fault, last) =
            (Body::ball(0.1, 0.4, 0.42).unwrap(), Cell::new(None), Cell::new(([0.0; 5], None)));
        let custom = Custom::default().with_couple(&couple);
        let over = Cell::new(false);
        let (since, driven) = (0.0, &Cell::new(None));
        of(&OwnLaws { body: &body, over: &over, custom, fault: &fault, last: &last, since, driven })
    }

    #[test]
    fn past_the_pole_of_a_ball_a_couple_is_that_of_the_same_motion_seen_from_the_other_side() {
        let ([s, c, w1, w2, w3], normal) = (Y, 0.9);
        let [here, there] =
            [[s, c, w1, w2, w3], [-s, c, -w1, -w2, w3]].map(|y| laws(|of| of.value(&couple, y, normal)));
        assert_eq!(there, [-here[0], -here[1], here[2]]);
    }

    #[test]
    fn the_slope_of_a_couple_is_that_of_its_values_along_a_motion_on_which_the_normal_force_changes() {
        let (rate, normal) = ([0.3, -0.2, 1.1, 0.6, -0.5], Dual { value: 0.9, slope: 0.7 });
        let y: [_; 5] = core::array::from_fn(|i| Dual { value: Y[i], slope: rate[i] });
        let [s, c, w1, w2, w3] = y;
        let found = laws(|of| {
            let rim = of.body.shape().map(|value| Dual { value, slope: 0.0 }).rim;
            let seen = Kinematics::of(&rim, (s, c), w1 / s, [w1, w2, w3]);
            of.solved_couple(&seen, |_: &Couple<Dual<f64>>| normal).unwrap().under(normal)
        });
        let by = 1e-5;
        let along = |by: f64| {
            let there = core::array::from_fn(|i| Y[i] + by * rate[i]);
            laws(|of| of.value(&couple, there, normal.value + by * normal.slope))
        };
        let [before, here, after] = [-by, 0.0, by].map(along);
        for (i, m) in found.into_iter().enumerate() {
            let slope = (after[i] - before[i]) / (2.0 * by);
            assert!((m.value - here[i]).abs() < 1e-15 && (m.slope - slope).abs() < 1e-7, "{m:?}, {slope}");
        }
    }
}
