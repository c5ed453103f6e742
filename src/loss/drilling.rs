//! Drilling friction: the patch of contact turns on the table.
//!
//! ```text
//! P = length N |w_z|,   m = -length N sgn(w_z) z          length in R
//! ```
//! The length is, of even pressure, two thirds of the coefficient of friction times the radius of the patch.
//! Contensou 1963, Leine, Arch. Appl. Mech. 79, 1063 (2009). A thin disk never stops by it: sin^(-1/2) theta grows by
//! length t/(3 sqrt I1); a body of finite height does, as by rolling resistance.

use super::Kinematics;
use crate::number::Real;

pub(super) const PARAMETER: &str = "length";
pub(super) const EXPONENT: Option<f64> = None;

/// Of length = N = 1.
#[inline(always)]
pub(super) fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
    let ((s, c), sign) = (seen.angle, seen.signs[1]);
    [-(s * sign), s.splat(0.0), -(c * sign)]
}

/// Of length = N = 1.
#[inline(always)]
pub(super) fn power<T: Real>(seen: &Kinematics<T>) -> T {
    seen.signs[1] * seen.drilling()
}
