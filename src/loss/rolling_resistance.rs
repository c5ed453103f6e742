//! Rolling resistance: the contact's reaction runs ahead of the contact by delta, in the direction of the rolling.
//!
//! ```text
//! P = delta N sqrt(w_h^2 + w2^2),   m = -delta N (c w_h, w2, -s w_h)/sqrt(w_h^2 + w2^2)          delta in R
//! ```
//! Coulomb 1785, any textbook. It resists rolling along the rim and rocking over it together. A thin disk:
//! theta = (delta tau)^2/(9 I1), in infinitely many turns.

use super::Kinematics;
use crate::number::Real;

pub(super) const PARAMETER: &str = "delta";
pub(super) const EXPONENT: Option<f64> = Some(2.0);

/// Of delta = N = 1; none of a body that does neither.
#[inline(always)]
pub(super) fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
    let (s, c) = seen.angle;
    if let Some(way) = seen.rocks {
        return [s.splat(0.0), -way, s.splat(0.0)];
    }
    let (rolling, rocking) = (seen.rolling(), seen.w[1]);
    let speed = power(seen).max(s.splat(f64::MIN_POSITIVE));
    let across = -(rolling / speed);
    [c * across, -(rocking / speed), -(s * across)]
}

/// Of delta = N = 1.
#[inline(always)]
pub(super) fn power<T: Real>(seen: &Kinematics<T>) -> T {
    let (rolling, rocking) = (seen.rolling(), seen.w[1]);
    if let Some(way) = seen.rocks {
        return way * rocking;
    }
    rolling.mac(rolling, rocking * rocking).sqrt()
}
