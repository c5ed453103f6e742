//! Drilling friction: the couple about the vertical on a patch of contact that turns on the table.
//!
//! ```text
//! P = length N |w_z|,   m = -length N sgn(w_z) z          length in R
//! ```
//! Under even pressure, `length` is two thirds of the coefficient of friction times the radius of the patch. The law is
//! in Contensou 1963, Leine, Arch. Appl. Mech. 79, 1063 (2009). The law never stops a thin disk: sin^(-1/2) theta grows by
//! length t/(3 sqrt I1). The law stops a body of finite height as rolling resistance does.

use super::{EndPowers, Kinematics, LossLaw, Resists, Unit};
use crate::numbers::Real;

#[derive(Debug)]
pub(super) struct Drilling;

impl LossLaw for Drilling {
    const PARAMETER: &str = "length";
    const COUPLE: &str = "-length*N*sign(w_n)*n";
    const UNIT: Unit = Unit::Length;
    const RESISTS: Resists = Resists::Drilling;
    const PRESSES: bool = true;
    const POWERS: EndPowers = EndPowers { face: [1.5, 0.5], balanced: 0.5, critical: 0.0, upright: 0.0 };

    /// The couple along e1, e2, e3 for length = N = 1.
    #[inline(always)]
    fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
        let ((s, c), sign) = (seen.angle, seen.signs[1]);
        [-(s * sign), s.splat(0.0), -(c * sign)]
    }

    /// The power that the couple takes for length = N = 1.
    #[inline(always)]
    fn power<T: Real>(seen: &Kinematics<T>) -> T {
        seen.signs[1] * seen.drilling()
    }
}
