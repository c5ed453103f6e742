//! Boundary layers of the air that flows between a flat face and the table.
//!
//! ```text
//! P = k |psi'|^(5/2),   m = k |psi'|^(3/2) sgn(psi') h/s          k = C sqrt(density viscosity) R^(9/4)/(M g^(1/4))
//! ```
//! The law is in Bildsten, Phys. Rev. E 66, 056309 (2002); it holds above the angle at which Moffatt's film fills the
//! gap; C is of order 0.1. A thin disk has theta = (3 k tau/(2 I1^(5/4)))^(4/9) at the time tau before its end.

use super::{EndPowers, Kinematics, LossLaw, Resists, Speed, Unit};
use crate::numbers::Real;

#[derive(Debug)]
pub(super) struct BoundaryLayer;

impl LossLaw for BoundaryLayer {
    const PARAMETER: &str = "k";
    const COUPLE: &str = "k*abs(q)**1.5*sign(q)*h/s";
    const UNIT: Unit = Unit::Layer;
    const RESISTS: Resists = Resists::Contour;
    const NEEDS_FACE: bool = true;
    const ROOT: Option<Speed> = Some(Speed::Spin);
    const POWERS: EndPowers = EndPowers { face: [-1.25; 2], balanced: 3.75, critical: 2.5, upright: 0.0 };

    /// The couple along e1, e2, e3 for k = 1.
    #[inline(always)]
    fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
        seen.along(seen.spin * seen.spin.abs().sqrt())
    }

    /// The power that the couple takes for k = 1.
    #[inline(always)]
    fn power<T: Real>(seen: &Kinematics<T>) -> T {
        seen.spin * seen.spin * seen.spin.abs().sqrt()
    }

    #[inline(always)]
    fn slope<T: Real>(coefficient: T, s: T, _: T, spin: T) -> T {
        s.splat(1.5) * coefficient * spin.abs().sqrt()
    }
}
