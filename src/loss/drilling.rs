//! Drilling friction: the patch of contact turns on the table.
//!
//! ```text
//! P = mu N |w_z|,   m = -mu N sgn(w_z) z          mu in R: of even pressure two thirds of the coefficient times the radius of the patch
//! ```
//! Contensou 1963, Leine, Arch. Appl. Mech. 79, 1063 (2009). A thin disk never stops by it: sin^(-1/2) theta grows by
//! mu t/(3 sqrt I1); a body of finite height does, as by rolling resistance.

use super::Seen;
use crate::number::Real;

pub(super) const PARAMETER: &str = "mu";
pub(super) const EXPONENT: Option<f64> = None;

/// Of mu = N = 1.
#[inline(always)]
pub(super) fn couple<T: Real>(seen: &Seen<T>) -> [T; 3] {
    let ((s, c), sign) = (seen.angle, seen.signs[1]);
    [-(s * sign), s.splat(0.0), -(c * sign)]
}

/// Of mu = N = 1.
#[inline(always)]
pub(super) fn power<T: Real>(seen: &Seen<T>) -> T {
    seen.signs[1] * seen.drilling()
}
