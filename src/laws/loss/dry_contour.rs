//! Dry friction along the contour of the rim.
//!
//! ```text
//! P = eps N A |psi'|,   m = eps N A sgn(psi') h/s          eps in R
//! ```
//! The normal force acts ahead of the contact point by eps A/s. The law is in Le Saux, Leine and Glocker, J. Nonlinear
//! Sci. 15, 27 (2005); Leine, Arch. Appl. Mech. 79, 1063 (2009). Where the contact point stops, the couple has any
//! value up to eps N A h/s. A thin disk has theta = (eps tau/sqrt I1)^(2/3) at the time tau before its end.

use super::{EndPowers, Kinematics, LossLaw, Resists, Unit};
use crate::numbers::Real;

#[derive(Debug)]
pub(super) struct DryContour;

impl LossLaw for DryContour {
    const PARAMETER: &str = "eps";
    const COUPLE: &str = "eps*N*A*sign(q)*h/s";
    const UNIT: Unit = Unit::Length;
    const RESISTS: Resists = Resists::Contour;
    const PRESSES: bool = true;
    const POWERS: EndPowers = EndPowers { face: [-0.5; 2], balanced: 1.5, critical: 1.0, upright: 1.0 };

    /// The couple along e1, e2, e3 for eps = N = 1. Where a step has passed the pole of a ball, its sine and its radius
    /// A are negative.
    #[inline(always)]
    fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
        seen.along(seen.radius.abs() * seen.signs[0])
    }

    /// The power that the couple takes for eps = N = 1.
    #[inline(always)]
    fn power<T: Real>(seen: &Kinematics<T>) -> T {
        seen.radius.abs() * seen.signs[0] * seen.spin
    }
}
