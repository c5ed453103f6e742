//! The sine of theta at which a face has landed.

use crate::numbers::Real;

/// A face counts as landed where sin(theta) is at most `FLAT`, or `WHIRR_END_SINE` if it lands after infinitely many
/// turns.
pub(crate) const FLAT: f64 = 1e-12;
const WHIRR_END_SINE: f64 = 1e-22;
/// A face that approaches the table exponentially (w2 proportional to sin theta) is computed down to this sine of
/// theta. The time from there to `FLAT` follows from the exponential law.
const SLOW_LANDING_SINE: f64 = 1e-10;

/// The inclination at which laws of one rim are evaluated for a body on its face: not 0, so that w1/sin(theta) is
/// finite.
pub(crate) const ALMOST_FLAT: f64 = 1e-100;

/// The share I1 w1^2/(I1 w1^2 + w2^2 + s) of the rotation w1 in the energy of a body almost on its face, s =
/// sin(theta); 1/2 in a whirr.
#[inline(always)]
pub(crate) fn turning_share<T: Real>(i1: T, s: T, w1: T, w2: T) -> T {
    let turning = i1 * w1 * w1;
    turning / (w2.mac(w2, turning) + s.abs())
}

/// The sine of theta at which a face lands; `faster` is w2'. Where a law lets a whirr last for infinitely many turns
/// (`endless`), the motion is computed down to `WHIRR_END_SINE`, and so is that of a face that falls more and more slowly but
/// lands. A face that drops lands at `FLAT`, and one that approaches exponentially, with w2 ~ s, is computed down to
/// `SLOW_LANDING_SINE`.
#[inline(always)]
pub(crate) fn lands_at<T: Real>(i1: T, (s, c): (T, T), [w1, w2]: [T; 2], faster: T, endless: bool) -> T {
    let number = |x: f64| s.splat(x);
    if !endless {
        return number(FLAT);
    }
    let (zero, square) = (number(0.0), w2 * w2);
    let nears = (square * number(0.9)).select_lt(-(c * faster * s), number(SLOW_LANDING_SINE), zero);
    let comes = zero.select_lt(c * w2, s.select_lt(square, number(FLAT), nears), zero);
    let turns = number(0.05).select_lt(turning_share(i1, s, w1, w2), zero, comes);
    turns.max(number(WHIRR_END_SINE))
}
