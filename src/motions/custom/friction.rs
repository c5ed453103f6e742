//! Friction of the user beside losses of the library that are proportional to the normal force: the library's flows, with a
//! coefficient that follows the speed of the slip.
//!
//! ```text
//! slips   mu(|u|) in place of mu;   rests   mu_s,  and mu(0) where a slip begins
//! ```
//! Where nothing slips, the laws are those of the library. A slip from rest has no series: steps follow it from
//! its first moment, and they are implicit where its direction follows the motion much faster than the body turns.

use crate::error::Error;
use crate::laws::body::Body;
use crate::laws::contact::lying::{Flat, Lying};
use crate::laws::contact::slip::{FollowsSpeed, Friction, SlipResponse};
use crate::laws::contact::standstill::{Standstill, standstill};
use crate::laws::contact::{Contact, lossy};
use crate::laws::custom::{FrictionLaw, SpeedLaw, fault_of_friction};
use crate::laws::loss::Losses;
use crate::laws::state::State;
use crate::motions::body::own::{Own, Stepped, library_answers};
use crate::motions::body::slide::{Slide, Varying};
use crate::motions::dry::creep::ASIDE;
use crate::numbers::Dual;
use core::cell::Cell;

/// A law of friction, and the last wrong value that it had.
#[derive(Clone, Copy)]
pub(crate) struct OwnFriction<'a> {
    pub law: &'a dyn FrictionLaw,
    pub fault: &'a Cell<Option<Error>>,
}

impl OwnFriction<'_> {
    /// The coefficient at a speed; NaN for a wrong value, which is noted.
    fn at(&self, speed: f64) -> f64 {
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
}

impl SpeedLaw for OwnFriction<'_> {
    fn varies(&self) -> bool {
        true
    }
    fn coefficient_at(&self, speed: f64) -> f64 {
        self.at(speed)
    }
}

impl FollowsSpeed<f64> for OwnFriction<'_> {
    fn strength(&self, _: f64, speed: impl FnOnce() -> f64, dry: bool) -> f64 {
        let speed = speed();
        if dry { self.at(speed) } else { self.at(speed) / speed.max(f64::MIN_POSITIVE) }
    }
}

impl FollowsSpeed<Dual<f64>> for OwnFriction<'_> {
    fn strength(&self, _: Dual<f64>, speed: impl FnOnce() -> Dual<f64>, dry: bool) -> Dual<f64> {
        let Dual { value, slope } = speed();
        let by = ASIDE * value;
        let [below, above] = [value - by, value + by].map(|speed| self.at(speed));
        let mu = Dual {
            value: self.at(value),
            slope: if by > 0.0 { slope * (above - below) / (2.0 * by) } else { 0.0 },
        };
        let size = Dual { value: value.max(f64::MIN_POSITIVE), slope };
        if dry { mu } else { mu / size }
    }
}

impl Varying for OwnFriction<'_> {
    const VARIES: bool = true;

    fn finds_fault_at(&self, speed: f64) -> bool {
        self.fault.set(None);
        self.at(speed).is_nan()
    }
}

impl Stepped for OwnFriction<'_> {}

impl Own for OwnFriction<'_> {
    const IS: bool = true;
    type Speeds = Self;
    fn speeds(&self) -> Self {
        *self
    }

    fn takes_fault(&self) -> Option<Error> {
        self.fault.take().filter(|_| !self.law.has_failed())
    }
    fn is_faulty(&self) -> bool {
        self.law.has_failed() || self.fault.get().is_some()
    }
    fn finds_fault(&self, speeds: &[f64], _: &State, _: f64) -> bool {
        self.fault.set(None);
        speeds.iter().any(|speed| self.at(*speed).is_nan())
    }

    fn lying(&self, law: &Lying<f64>, y: Flat<f64>) -> Option<Lying<f64>> {
        let ([other_h, other_2], [_, _, u_h, u_2]) = (law.other_slip(y), y);
        let of = |speed: f64| FollowsSpeed::<f64>::strength(self, 0.0, || speed, law.dry);
        Some(Lying { strength: [of(u_h.hypot(u_2)), of(other_h.hypot(other_2))], ..*law })
    }

    library_answers!();
}
