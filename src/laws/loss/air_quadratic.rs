//! Resistance of the air to all rotation at high speed.
//!
//! ```text
//! P = b2 |w|^3,   m = -b2 |w| w          b2 in M R^2; of a long rod about (Cd/2)(rho R^3/M) ell^4
//! ```
//! The law is Newton's law of drag, integrated along the body. A thin disk never stops.

use super::Kinematics;
use crate::numbers::Real;

pub(super) const PARAMETER: &str = "b2";
pub(super) const EXPONENT: Option<f64> = None;

/// The couple for b2 = 1.
#[inline(always)]
pub(super) fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
    let (size, [w1, w2, w3]) = (seen.square().sqrt(), seen.w);
    [-(size * w1), -(size * w2), -(size * w3)]
}

/// The power for b2 = 1.
#[inline(always)]
pub(super) fn power<T: Real>(seen: &Kinematics<T>) -> T {
    let square = seen.square();
    square * square.sqrt()
}
