//! Resistance of the air to all rotation at low speed.
//!
//! ```text
//! P = b w.w,   m = -b w          b in M R sqrt(g R)
//! ```
//! The law is Stokes's law of a body that turns. A thin disk never stops: sin theta falls as exp(-2 b t/(3 I1)).

use super::Kinematics;
use crate::numbers::Real;

pub(super) const PARAMETER: &str = "b";
pub(super) const EXPONENT: Option<f64> = None;

/// The couple for b = 1.
#[inline(always)]
pub(super) fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
    let [w1, w2, w3] = seen.w;
    [-w1, -w2, -w3]
}

/// The power for b = 1.
#[inline(always)]
pub(super) fn power<T: Real>(seen: &Kinematics<T>) -> T {
    seen.square()
}
