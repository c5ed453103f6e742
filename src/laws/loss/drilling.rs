//! Drilling friction: the patch of contact turns on the table.
//!
//! ```text
//! P = length N |w_z|,   m = -length N sgn(w_z) z          length in R
//! ```
//! For even pressure the length is two thirds of the coefficient of friction times the radius of the patch. The law is
//! in Contensou 1963, Leine, Arch. Appl. Mech. 79, 1063 (2009). It never stops a thin disk: sin^(-1/2) theta grows by
//! length t/(3 sqrt I1). It stops a body of finite height as rolling resistance does.

use super::Kinematics;
use crate::numbers::Real;

pub(super) const PARAMETER: &str = "length";
pub(super) const EXPONENT: Option<f64> = None;

/// The couple for length = N = 1.
#[inline(always)]
pub(super) fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
    let ((s, c), sign) = (seen.angle, seen.signs[1]);
    [-(s * sign), s.splat(0.0), -(c * sign)]
}

/// The power for length = N = 1.
#[inline(always)]
pub(super) fn power<T: Real>(seen: &Kinematics<T>) -> T {
    seen.signs[1] * seen.drilling()
}
