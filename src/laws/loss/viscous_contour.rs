//! Friction along the contour of the rim that grows with the speed of the contact.
//!
//! ```text
//! P = c (A psi')^2,   m = c A^2 psi' h/s          c in M R sqrt(g R)
//! ```
//! The law is in Leine, Arch. Appl. Mech. 79, 1063 (2009); a loss as Omega^2 up to the last cycle is in McDonald and
//! McDonald, arXiv physics/0008227 (2001). A thin disk has cos theta = exp(-2 c tau/(3 I1)) at the time tau before its
//! end, and theta = (4 c tau/(3 I1))^(1/2) near the end.

use super::{EndPowers, Kinematics, LossLaw, Resists, Unit};
use crate::numbers::Real;

#[derive(Debug)]
pub(super) struct ViscousContour;

impl LossLaw for ViscousContour {
    const PARAMETER: &str = "c";
    const COUPLE: &str = "c*A**2*q*h/s";
    const UNIT: Unit = Unit::Damping;
    const RESISTS: Resists = Resists::Contour;
    const POWERS: EndPowers = EndPowers { face: [-1.0; 2], balanced: 3.0, critical: 2.0, upright: 2.0 };

    /// The couple along e1, e2, e3 for c = 1.
    #[inline(always)]
    fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
        seen.along(seen.radius * seen.radius * seen.spin)
    }

    /// The power that the couple takes for c = 1.
    #[inline(always)]
    fn power<T: Real>(seen: &Kinematics<T>) -> T {
        let speed = seen.radius * seen.spin;
        speed * speed
    }

    #[inline(always)]
    fn slope<T: Real>(coefficient: T, _: T, radius: T, _: T) -> T {
        coefficient * radius * radius
    }
}
