//! The squared rate of a sharp rim by few operations, where the signs of numerator and denominator are certain.
//!
//! ```text
//! rate^2 = n / (m s),   n = cos theta - ell s,   m = n + d cos theta,   s = sin theta
//! ```
//! Each term is a double and its rounding error: the low parts of sine and cosine are the rounding errors of their last
//! addition, and a fused product replaces an exact sum. One division serves quotient and remainder. A lane is uncertain
//! where |n| or |m| is below 2^-50 of the terms that were subtracted, and where theta is tiny or outside (0, pi/2]; the
//! caller then uses `terms` for that lane.
//!
//! Error of the rate: at most 2 (1 + kappa_c) ulp of 2^-53; the largest error found in 2e7 points, against 113 bits,
//! was 1.84 (1 + kappa_c) ulp. Tests of `hard_cases` and of this file check it.

use crate::numbers::{Lane, Real, Short, Sum, short_sincos};

/// n or m is uncertain below this bound, relative to the terms whose difference they are.
const DOUBT: f64 = 1.0 / (1_u64 << 50) as f64;

/// A theta below this bound is uncertain, because products with its sine would lose digits.
pub(crate) const TINY: f64 = f64::from_bits(0x20B0_0000_0000_0000); // 2^-500

/// Sine and cosine of an inclination, for [`quick_terms`].
#[inline(always)]
pub(crate) fn quick_angle<T: Real>(theta: T) -> Short<T> {
    short_sincos(theta, TINY)
}

/// Numerator and denominator of the squared rate as sums, and the size below which their signs are uncertain. The low
/// part of the denominator does not contain the rounding error of its own last addition.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuickTerms<T> {
    n: Sum<T>,
    m: Sum<T>,
    limit: T,
}

#[inline(always)]
pub(crate) fn quick_terms<T: Real>(angle: &Short<T>, ell: T, excess: Sum<T>) -> QuickTerms<T> {
    let (s, c) = (angle.sin, angle.cos);
    let lever = ell * s.hi;
    let n = c.hi - lever;
    let back = c.hi - n;
    let n_lo = (-ell).fma(s.lo, c.lo) + (-ell).fma(s.hi, back);
    let m = excess.hi.fma(c.hi, n);
    let m_lo = excess.hi.fma(c.lo, excess.lo.fma(c.hi, n_lo));
    let (zero, everything) = (c.hi.splat(0.0), c.hi.splat(f64::INFINITY));
    let least = angle.least.select_lt(c.hi.splat(TINY), everything, zero);
    let limit = (c.hi + back).fma(c.hi.splat(DOUBT), least);
    QuickTerms { n: Sum { hi: n, lo: n_lo }, m: Sum { hi: m, lo: m_lo }, limit }
}

impl<T: Lane> QuickTerms<T> {
    /// Whether n or m is uncertain in any SIMD lane.
    #[inline(always)]
    pub fn in_doubt(&self) -> bool {
        self.n.hi.abs().any_lt(self.limit) | self.m.hi.abs().any_lt(self.limit)
    }
}

impl<T: Real> QuickTerms<T> {
    /// Returns `careful` in the SIMD lanes that are uncertain, `quick` elsewhere.
    #[inline(always)]
    pub fn where_certain(&self, careful: T, quick: T) -> T {
        let first = self.m.hi.abs().select_lt(self.limit, careful, quick);
        self.n.hi.abs().select_lt(self.limit, careful, first)
    }

    /// The terms n and m of the squared rate, each rounded to one number.
    #[inline(always)]
    pub fn rounded(&self) -> [T; 2] {
        [self.n.hi + self.n.lo, self.m.hi + self.m.lo]
    }

    /// The squared rate n/(m s); it is negative where no steady state exists.
    #[inline(always)]
    pub fn square(&self, sin: Sum<T>) -> T {
        let (n, m) = (self.n, self.m);
        let p = m.hi * sin.hi;
        let p_lo = m.hi.fma(sin.lo, m.lo.fma(sin.hi, m.hi.fma(sin.hi, -p)));
        // The remainder corrects the one division, so that only the square root rounds the result a second time.
        let inverse = p.splat(1.0) / p;
        let q = n.hi * inverse;
        let rest = (-q).fma(p, n.hi) + (-q).fma(p_lo, n.lo);
        rest.fma(inverse, q)
    }
}

/// Whether the squared rate may be below `low` or above `high` in any SIMD lane, to forty bits and without a division.
/// The result is true wherever the squared rate is outside of the bounds, and also where cancellation leaves too few
/// digits to exclude it.
#[inline(always)]
pub(crate) fn may_exceed<T: Lane>(angle: &Short<T>, ell: T, excess: T, [low, high]: [T; 2]) -> bool {
    let (s, c) = (angle.sin.hi, angle.cos.hi);
    let zero = c.splat(0.0);
    let n = c - ell * s;
    let m = excess.fma(c, n);
    let least = angle.least.select_lt(c.splat(TINY), c.splat(f64::INFINITY), zero);
    let near = (c + (c - n)).fma(c.splat(FORTY_BIT_SHARE), least);
    // n and m of a steady state have the same sign.
    let over = m.select_lt(zero, -n, n);
    let under = m.abs() * s;
    let less = zero.select_lt(over, over, under.splat(f64::INFINITY));
    less.any_lt(low * under) | (high * under).any_lt(over) | m.abs().any_lt(near) | n.abs().any_lt(near)
}

/// Whether the squared rate may pass the bounds at any inclination from the smaller `from` to the larger
/// `to`; n and m decrease with the inclination. The result is false where none of these inclinations has a
/// steady state.
#[inline(always)]
pub(crate) fn may_exceed_between<T: Lane>(
    [from, to]: [&Short<T>; 2],
    ell: T,
    excess: T,
    [low, high]: [T; 2],
) -> bool {
    let (one, zero) = (ell.splat(1.0), ell.splat(0.0));
    let lever = ell * to.sin.hi;
    let (n_most, n_least) = (from.cos.hi - ell * from.sin.hi, to.cos.hi - lever);
    let (m_most, m_least) = (excess.fma(from.cos.hi, n_most), excess.fma(to.cos.hi, n_least));
    let (n, m) = (sizes(n_least, n_most), sizes(m_least, m_most));
    let near = (from.cos.hi + lever) * one.splat(FORTY_BIT_SHARE);
    if n[0].any_lt(near) | m[0].any_lt(near) {
        return true;
    }
    // n and m keep their signs in between, and no steady state exists where these signs differ.
    let differ = zero.select_lt(n_most, one, -one) * zero.select_lt(m_most, one, -one);
    let none = one.splat(f64::INFINITY);
    let (least, most) = (zero.select_lt(differ, n[0], none), zero.select_lt(differ, n[1], zero));
    least.any_lt(low * m[1] * to.sin.hi) | (high * m[0] * from.sin.hi).any_lt(most)
}

/// Least and greatest size of a number that falls from `most` to `least`; the least is negative if its sign changes.
#[inline(always)]
fn sizes<T: Real>(least: T, most: T) -> [T; 2] {
    let zero = most.splat(0.0);
    [zero.select_lt(most, least, -most), zero.select_lt(most, most, -least)]
}

/// n and m above this bound, relative to the terms whose difference they are, have at least forty bits.
const FORTY_BIT_SHARE: f64 = 1.0 / 4096.0;

/// The bounds for `may_exceed`: the least and the greatest squared rate so far, moved closer together by more than its error.
pub(crate) fn bounds_beyond_error([least, greatest]: [f64; 2]) -> [f64; 2] {
    const BOUNDS_MARGIN: f64 = 1.0 / (1_u64 << 36) as f64;
    [least * (1.0 + BOUNDS_MARGIN), greatest * (1.0 - BOUNDS_MARGIN)]
}

#[cfg(test)]
mod tests {
    use super::super::drawn::drawn;
    use super::super::rate;
    use super::*;
    use crate::numbers::long_sin_cos;

    #[test]
    fn the_rate_of_few_operations_is_right_to_two_ulp_and_its_conditioning() {
        let (mut worst, mut counted): (f64, usize) = (0.0, 0);
        for (body, theta) in (1..300_000).map(drawn) {
            let found = rate(&body, theta);
            let [s, c] = long_sin_cos(theta);
            let (ell, d) = (Sum::from(body.ell()), body.excess_sum());
            let n = c - ell * s;
            let m = n + d * c;
            let square = n / (m * s);
            if found.is_nan() || square.hi <= 0.0 || !square.hi.is_finite() {
                continue;
            }
            let slope = -(s + ell * c).hi;
            let kappa = (theta * 0.5 * (slope / n.hi - (slope - (d * s).hi) / m.hi - c.hi / s.hi)).abs();
            let off = (Sum::from(found) - square.sqrt()).hi / found;
            worst = worst.max(off.abs() * 2f64.powi(53) / (1.0 + kappa));
            counted += 1;
        }
        assert!(worst < 2.0 && counted > 200_000, "{worst} ulp in {counted}");
    }
}
