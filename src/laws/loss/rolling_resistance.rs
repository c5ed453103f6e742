//! Rolling resistance: the normal force acts ahead of the contact point by delta, in the direction of the rolling.
//!
//! ```text
//! P = delta N sqrt(w_h^2 + w2^2),   m = -delta N (c w_h, w2, -s w_h)/sqrt(w_h^2 + w2^2)          delta in R
//! ```
//! The law is in Coulomb 1785 and any textbook. The law resists rolling along the rim and rocking over the rim together. A thin
//! disk has theta = (delta tau)^2/(9 I1) at the time tau before its end, and makes infinitely many turns until then.

use super::{EndPowers, Kinematics, LossLaw, Resists, Speed, Unit};
use crate::numbers::Real;

/// The angular speed below which the couple falls to zero with the speed; squares of smaller speeds are rounded to zero.
const SLOWEST: f64 = 1e-154;

#[derive(Debug)]
pub(super) struct RollingResistance;

impl LossLaw for RollingResistance {
    const PARAMETER: &str = "delta";
    const COUPLE: &str = "-delta*N*t/norm(t)";
    const UNIT: Unit = Unit::Length;
    const RESISTS: Resists = Resists::Rolling;
    const PRESSES: bool = true;
    const ROOT: Option<Speed> = Some(Speed::Rolling);
    const POWERS: EndPowers = EndPowers { face: [0.5; 2], balanced: 1.5, critical: 1.0, upright: 1.0 };

    /// The couple along e1, e2, e3 for delta = N = 1; zero for a body that neither rolls nor rocks.
    #[inline(always)]
    fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
        let (s, c) = seen.angle;
        if let Some([rolls, rocks]) = seen.only {
            return [-(c * rolls), -rocks, s * rolls];
        }
        let (rolling, rocking) = (seen.rolling(), seen.w[1]);
        let speed = Self::power(seen).max(s.splat(SLOWEST));
        let across = -(rolling / speed);
        [c * across, -(rocking / speed), -(s * across)]
    }

    /// The power that the couple takes for delta = N = 1.
    #[inline(always)]
    fn power<T: Real>(seen: &Kinematics<T>) -> T {
        let (rolling, rocking) = (seen.rolling(), seen.w[1]);
        if let Some([rolls, rocks]) = seen.only {
            return rolls.mac(rolling, rocks * rocking);
        }
        rolling.mac(rolling, rocking * rocking).sqrt()
    }
}
