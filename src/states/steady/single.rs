//! The rate of a sharp rim in single precision: sums and quotient are in double precision, the root in single.
//!
//! ```text
//! rate = sqrt(n / (m s)),   n = cos theta - ell s,   m = n + d cos theta,   s = sin theta
//! ```
//! The square root of a double takes longer than all other operations. The rate of doubles, rounded once, is used where
//! |n| or |m| is below 2^-18 of the terms that were subtracted, where the square might leave the range of single
//! numbers, and where theta is tiny or outside (0, pi/2].
//!
//! Error: 1.51 ulp of 2^-24. The rounding of the root contributes 1 ulp, that of the quotient a half, and the doubles
//! less than 0.01. Tests of this file and of `sweep` check it.

use crate::numbers::{Narrow, Short};

/// n or m has too few digits below this bound, relative to the terms whose difference they are.
const NEAR: f64 = 1.0 / (1_u64 << 18) as f64;

/// Where theta or n/m is below this bound, the rate may leave the range of single numbers.
const SMALL: f64 = f64::from_bits(0x3A50_0000_0000_0000); // 2^-90

/// Reduced rotation rate at an inclination in single precision, NaN where no steady state exists. The rounded result of
/// `double` replaces the quick rate only where the quick rate has too few digits.
#[inline(always)]
pub(crate) fn single_rate<T: Narrow>(
    angle: &Short<T>,
    ell: T,
    excess: T,
    double: impl FnOnce() -> T,
) -> T::Single {
    let (s, c) = (angle.sin.hi, angle.cos.hi);
    let number = |x: f64| c.splat(x);
    // The expressions are those of `quick_terms`, so that the compiler shares them if a caller needs both.
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
    use crate::numbers::{LANES, Pair, Sum, in_lanes, level};
    use fearless_simd::{Simd, SimdFrom, f64x8};

    /// The rate in single precision of sixteen tubes and inclinations in SIMD lanes.
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
            let Some(lanes) = in_lanes!(level(), simd => Some(sixteen(simd, some)), else None::<[f32; 16]>)
            else {
                return;
            };
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
                    // The rate is zero, subnormal or infinite here, or no steady state exists.
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
