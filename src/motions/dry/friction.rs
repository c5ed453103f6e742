//! A user-defined law of friction during a slip ([`custom`](crate::custom)), of bodies and of stones.
//!
//! ```text
//! mu(|u|)   in place of mu,   mu(|u|)/|u|   in place of c
//! ```
//! A user-defined law has no derivative; its slopes are computed from differences. A slip from rest has no power
//! series: it keeps its direction for a moment, and its steps are implicit where its direction follows the motion
//! much faster than the body turns.

use super::creep::ASIDE;
use crate::error::Error;
use crate::laws::contact::slip::FollowsSpeed;
use crate::laws::custom::{FrictionLaw, SpeedLaw, fault_of_friction};
use crate::numbers::Dual;
use core::cell::Cell;

/// The least growth rate of the speed of a slip that begins, so that it has a direction.
pub(crate) const LEAST_GROWTH: f64 = 1e-30;

/// A user-defined law of friction, with the error of its last wrong value since the last step that was taken.
#[derive(Clone, Copy)]
pub(crate) struct OwnFriction<'a> {
    pub law: &'a dyn FrictionLaw,
    pub fault: &'a Cell<Option<Error>>,
}

impl OwnFriction<'_> {
    /// The coefficient of friction at a speed; NaN if the law has failed, or if its value is wrong, which is
    /// recorded.
    pub fn mu(&self, speed: f64) -> f64 {
        if self.law.has_failed() || !speed.is_finite() {
            return f64::NAN;
        }
        let mu = self.law.coefficient(speed);
        match fault_of_friction(mu, speed) {
            Some(fault) => {
                self.fault.set(Some(fault));
                f64::NAN
            }
            None => mu,
        }
    }

    /// Whether the law has failed, or has a wrong value at the speed of a slip at the end of a step.
    pub fn is_wrong_at(&self, speed: f64) -> bool {
        if !self.law.has_failed() {
            self.fault.set(fault_of_friction(self.law.coefficient(speed), speed));
        }
        self.law.has_failed() || self.fault.get().is_some()
    }

    /// Returns the error for a wrong value, once; None if there is none or the law has failed.
    pub fn takes_fault(&self) -> Option<Error> {
        self.fault.take().filter(|_| !self.law.has_failed())
    }
}

impl SpeedLaw for Option<OwnFriction<'_>> {
    fn varies(&self) -> bool {
        self.is_some()
    }
    fn coefficient_at(&self, speed: f64) -> f64 {
        self.map_or(f64::NAN, |own| own.mu(speed))
    }
}

impl FollowsSpeed<f64> for OwnFriction<'_> {
    fn strength(&self, _: f64, speed: impl FnOnce() -> f64, dry: bool) -> f64 {
        let speed = speed();
        if dry { self.mu(speed) } else { self.mu(speed) / speed.max(f64::MIN_POSITIVE) }
    }
}

impl FollowsSpeed<Dual<f64>> for OwnFriction<'_> {
    fn strength(&self, _: Dual<f64>, speed: impl FnOnce() -> Dual<f64>, dry: bool) -> Dual<f64> {
        let Dual { value, slope } = speed();
        let by = ASIDE * value;
        let [below, above] = [value - by, value + by].map(|speed| self.mu(speed));
        let mu = Dual {
            value: self.mu(value),
            slope: if by > 0.0 { slope * (above - below) / (2.0 * by) } else { 0.0 },
        };
        let size = Dual { value: value.max(f64::MIN_POSITIVE), slope };
        if dry { mu } else { mu / size }
    }
}

/// The state vector at the time `lasts` after a slip has begun along `way`, by the rates in the middle of that time;
/// `slip` is the index of the slip's first component.
pub(crate) fn slipped<const N: usize>(
    from: &[f64; N],
    slip: usize,
    (way, lasts): ([f64; 2], f64),
    rates: impl Fn(&[f64; N]) -> [f64; N],
) -> [f64; N] {
    let moved = |rate: &[f64; N], by: f64| core::array::from_fn(|i| by.mul_add(rate[i], from[i]));
    let half: [f64; N] = moved(&rates(from), 0.5 * lasts);
    let mut all: [f64; N] = moved(&rates(&half), lasts);
    let speed = (all[slip] * way[0] + all[slip + 1] * way[1]).max(LEAST_GROWTH * lasts);
    (all[slip], all[slip + 1]) = (speed * way[0], speed * way[1]);
    all
}
