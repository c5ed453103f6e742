//! The sine of theta at which a face has landed.

use crate::numbers::Real;

/// Sine of theta at which a face has landed, and its value for a face that lands after infinitely many turns.
pub(crate) const FLAT: f64 = 1e-12;
const ENDLESS: f64 = 1e-22;
/// Sine of theta down to which a face is followed that only comes ever nearer. The time from there to `FLAT` follows
/// from w2 ~ s.
const NEARS: f64 = 1e-10;

/// The share of the turning in the energy of an almost flat face, which is half in a whirr.
#[inline(always)]
pub(crate) fn turning_share<T: Real>(i1: T, s: T, w1: T, w2: T) -> T {
    let turning = i1 * w1 * w1;
    turning / (w2.mac(w2, turning) + s.abs())
}

/// The sine of theta at which a face lands. An `endless` whirr is followed through its turns, down to `ENDLESS`, and so is
/// a face that falls ever more slowly but lands. A face that drops lands at `FLAT`; one that only comes ever nearer, with
/// w2 ~ s, is followed to `NEARS`.
#[inline(always)]
pub(crate) fn lands_at<T: Real>(i1: T, (s, c): (T, T), [w1, w2]: [T; 2], faster: T, endless: bool) -> T {
    let number = |x: f64| s.splat(x);
    if !endless {
        return number(FLAT);
    }
    let (zero, square) = (number(0.0), w2 * w2);
    let nears = (square * number(0.9)).select_lt(-(c * faster * s), number(NEARS), zero);
    let comes = zero.select_lt(c * w2, s.select_lt(square, number(FLAT), nears), zero);
    let turns = number(0.05).select_lt(turning_share(i1, s, w1, w2), zero, comes);
    turns.max(number(ENDLESS))
}
