//! Resistance of the air to all rotation at low speed.
//!
//! ```text
//! P = b w.w,   m = -b w          b in M R sqrt(g R)
//! ```
//! The law is Stokes's law for a rotating body. A thin disk never stops under this law: sin theta falls as exp(-2 b t/(3 I1)).

use super::{EndPowers, Kinematics, LossLaw, Resists, Unit};
use crate::numbers::Real;

#[derive(Debug)]
pub(super) struct AirLinear;

impl LossLaw for AirLinear {
    const PARAMETER: &str = "b";
    const COUPLE: &str = "-b*w";
    const UNIT: Unit = Unit::Damping;
    const RESISTS: Resists = Resists::All;
    const POWERS: EndPowers = EndPowers { face: [1.0; 2], balanced: 1.0, critical: 0.0, upright: 0.0 };

    /// The couple along e1, e2, e3 for b = 1.
    #[inline(always)]
    fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
        let [w1, w2, w3] = seen.w;
        [-w1, -w2, -w3]
    }

    /// The power that the couple takes for b = 1.
    #[inline(always)]
    fn power<T: Real>(seen: &Kinematics<T>) -> T {
        seen.square()
    }
}
