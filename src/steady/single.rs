//! The rate of a sharp rim in single precision: sums and quotient in double precision, the root in single.
//!
//! ```text
//! rate = sqrt(n / (m s)),   n = cos theta - ell s,   m = n + d cos theta,   s = sin theta
//! ```
//! The root of a double takes longer than all the rest. Where |n| or |m| is below 2^-18 of what was subtracted, where
//! the square might leave the range of single numbers, and where theta is tiny or outside (0, pi/2], the rate of doubles
//! is rounded once.
//!
//! Error: 1.51 ulp of 2^-24. One is the rounding of the root, a half that of the quotient, and the doubles leave less
//! than 0.01. Tests of this file and of `sweep` run it.

use crate::number::{Narrow, Short};

/// Nearer than this to zero, relative to what was subtracted, n or m has too few digits left.
const NEAR: f64 = 1.0 / (1_u64 << 18) as f64;

/// A smaller theta, or n over m, leads out of the range of single numbers.
const SMALL: f64 = f64::from_bits(0x3A50_0000_0000_0000); // 2^-90

/// Reduced rotation rate at an inclination in single precision, NaN where there is no steady state: by few operations,
/// and what `double` says, rounded, only where that has too few digits.
#[inline(always)]
pub(crate) fn single_rate<T: Narrow>(
    angle: &Short<T>,
    ell: T,
    excess: T,
    double: impl FnOnce() -> T,
) -> T::Single {
    let (s, c) = (angle.sin.hi, angle.cos.hi);
    let number = |x: f64| c.splat(x);
    // as in `quick_terms`: who wants both has them once
    let n = c - ell * s;
    let m = excess.fma(c, n);
    let rate = (n / (m * s)).single_root();
    let (top, under) = (n.abs(), m.abs());
    let outside = angle.least.select_lt(number(SMALL), number(f64::INFINITY), number(0.0));
    let limit = under.fma(number(SMALL), ell.fma(s * number(NEAR), c.fma(number(NEAR), outside)));
    if !(top.any_lt(limit) | under.any_lt(limit)) {
        return rate;
    }
    let double = double();
    let first = under.select_lt(limit, double, T::wide(rate));
    top.select_lt(limit, double, first).single()
}

#[cfg(test)]
mod tests {
    use super::super::drawn::drawn;
    use super::super::{quick_angle, rare_rate, rate};
    use super::*;
    use crate::Body;
    use crate::number::{LANES, Pair, Sum, in_lanes, level};
    use fearless_simd::{Simd, SimdFrom, f64x8};

    /// Sixteen tubes and inclinations in lanes.
    #[inline(always)]
    fn sixteen<S: Simd>(simd: S, of: &[(Body, f64)]) -> [f32; 2 * LANES] {
        let lanes = |f: fn(&(Body, f64)) -> f64| {
            let half = |part: &[(Body, f64)]| f64x8::simd_from(simd, core::array::from_fn(|i| f(&part[i])));
            Pair(half(&of[..LANES]), half(&of[LANES..]))
        };
        let (theta, ell) = (lanes(|x| x.1), lanes(|x| x.0.ell()));
        let excess = Sum { hi: lanes(|x| x.0.excess_sum().hi), lo: lanes(|x| x.0.excess_sum().lo) };
        *single_rate(&quick_angle(theta), ell, excess.hi, || rare_rate(theta, ell, excess))
    }

    #[test]
    fn the_single_rate_is_the_rate_to_one_and_a_half_ulp_of_a_single_number_alone_and_in_lanes() {
        let (mut worst, mut counted): (f64, usize) = (0.0, 0);
        let drawn: Vec<_> = (1..=3_200_000).map(drawn).collect();
        for some in drawn.chunks(2 * LANES) {
            let lanes = in_lanes!(level(), simd => sixteen(simd, some), else return);
            for (&(body, theta), lane) in some.iter().zip(lanes) {
                let (ell, excess) = (body.ell(), body.excess_sum());
                let double = || rare_rate(theta, ell, excess);
                let found = single_rate(&quick_angle(theta), ell, excess.hi, double);
                assert!(
                    found.to_bits() == lane.to_bits() || found.is_nan() && lane.is_nan(),
                    "{found} {lane}"
                );
                let expected = rate(&body, theta);
                let rounded = expected as f32;
                if !rounded.is_normal() {
                    // infinite, or no steady state
                    assert!(found == rounded || found.is_nan() && rounded.is_nan(), "{found} {rounded}");
                    continue;
                }
                worst = worst.max((f64::from(found) / expected - 1.0).abs() * 2f64.powi(24));
                counted += 1;
            }
        }
        assert!(worst < 1.51 && counted > 2_000_000, "{worst} ulp in {counted}");
    }
}
