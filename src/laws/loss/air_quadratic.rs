//! Resistance of the air to all rotation at high speed.
//!
//! ```text
//! P = b2 |w|^3,   m = -b2 |w| w          b2 in M R^2; of a long rod about (Cd/2)(rho R^3/M) ell^4
//! ```
//! The law is Newton's law of drag, integrated along the body. A thin disk never stops under this law.

use super::{EndPowers, Kinematics, LossLaw, Resists, Speed, Unit};
use crate::numbers::Real;

#[derive(Debug)]
pub(super) struct AirQuadratic;

impl LossLaw for AirQuadratic {
    const PARAMETER: &str = "b2";
    const COUPLE: &str = "-b2*norm(w)*w";
    const UNIT: Unit = Unit::Drag;
    const RESISTS: Resists = Resists::All;
    const ROOT: Option<Speed> = Some(Speed::Whole);
    const POWERS: EndPowers = EndPowers { face: [1.5; 2], balanced: 1.5, critical: 0.0, upright: 0.0 };

    /// The couple along e1, e2, e3 for b2 = 1.
    #[inline(always)]
    fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
        let (size, [w1, w2, w3]) = (seen.square().sqrt(), seen.w);
        [-(size * w1), -(size * w2), -(size * w3)]
    }

    /// The power that the couple takes for b2 = 1.
    #[inline(always)]
    fn power<T: Real>(seen: &Kinematics<T>) -> T {
        let square = seen.square();
        square * square.sqrt()
    }
}
