//! Sine, cosine and arc tangent for the angles of an inclination.
//!
//! ```text
//! sin theta, cos theta   as unevaluated sums hi + lo,   0 <= theta <= pi
//! ```
//! For [`sincos`] the sum `hi + lo` is within 1/8 ulp (2^-53 relative) of the sine or cosine, and `hi` within 1.125
//! ulp: the tests at the end check it. The method is a Taylor series on [0, pi/4] (Abramowitz and Stegun 4.3.65-66),
//! with the leading terms as exact sums and products (Dekker 1971, Knuth TAOCP 4.2.2). [`Short`] sums, which maps need
//! by the million, take half as many operations: their low parts are the rounding errors of the last addition, and the
//! sum is within 0.4 ulp.

use super::real::Real;
use super::sum::Sum;

/// Sine and cosine of an inclination, each as an unevaluated sum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SinCos<T> {
    pub sin: Sum<T>,
    pub cos: Sum<T>,
}

/// Taylor coefficients of the sine from x^17 down to x^5, and of the cosine from x^18 down to x^4.
const SINE: [f64; 7] = [
    1.0 / 355_687_428_096_000.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 39_916_800.0,
    1.0 / 362_880.0,
    -1.0 / 5_040.0,
    1.0 / 120.0,
];
const COSINE: [f64; 8] = [
    -1.0 / 6_402_373_705_728_000.0,
    1.0 / 20_922_789_888_000.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 479_001_600.0,
    -1.0 / 3_628_800.0,
    1.0 / 40_320.0,
    -1.0 / 720.0,
    1.0 / 24.0,
];

/// Polynomials of least error on [0, pi/4] (Remez), highest power of x^2 first: (sin x - x)/x^3 and
/// (cos x - 1 + x^2/2)/x^4. Sine and cosine computed from them are within 2^-57.
const SHORT_SINE: [f64; 6] = [
    1.589_682_797_188_778e-10,
    -2.505_075_865_405_546e-8,
    2.755_731_369_523_181e-6,
    -0.000_198_412_698_298_169_66,
    0.008_333_333_333_322_425,
    -0.166_666_666_666_666_32,
];
const SHORT_COSINE: [f64; 6] = [
    -1.135_966_991_920_068_6e-11,
    2.087_572_368_536_268e-9,
    -2.755_731_435_524_802_5e-7,
    2.480_158_728_949_184_7e-5,
    -0.001_388_888_888_887_413_8,
    0.041_666_666_666_666_6,
];

const HALF_PI_LO: f64 = 6.123_233_995_736_766e-17;

/// Sine and cosine of `theta` in [0, pi]; outside, the results are NaN or meaningless, and callers exclude such angles.
#[inline(always)]
pub(crate) fn sincos<T: Real>(theta: T) -> SinCos<T> {
    let number = |x: f64| theta.splat(x);
    let (zero, quarter) = (number(0.0), number(core::f64::consts::FRAC_PI_4));
    let most = number(3.0 * core::f64::consts::FRAC_PI_4);
    // pi/2 - theta and pi - theta are exact to 106 bits, so that the cosine and the sine keep their digits.
    let level = Sum::of(number(core::f64::consts::FRAC_PI_2) - theta, number(HALF_PI_LO));
    let beyond = Sum::of(number(core::f64::consts::PI) - theta, number(2.0 * HALF_PI_LO));
    let pick = |near: T, level: T, far: T| quarter.select_lt(theta, most.select_lt(theta, far, level), near);
    let [s, c] = sin_cos_below_quarter(pick(theta, level.hi, beyond.hi), pick(zero, level.lo, beyond.lo));
    SinCos {
        sin: Sum { hi: pick(s.hi, c.hi, s.hi), lo: pick(s.lo, c.lo, s.lo) },
        cos: Sum { hi: pick(c.hi, s.hi, -c.hi), lo: pick(c.lo, s.lo, -c.lo) },
    }
}

/// Sine and cosine, computed in few operations, and the distance of theta from the nearer of 0 and pi/2.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Short<T> {
    pub sin: Sum<T>,
    pub cos: Sum<T>,
    /// The smaller of theta and pi/2 - theta; negative outside [0, pi/2].
    pub least: T,
}

/// Sine and cosine as from [`sincos`], in half the operations; each sum is within 0.4 ulp. Outside [0, pi/2], and where
/// theta or its complement is below `floor`, the results are 0 and 1 or 1 and 0.
#[inline(always)]
pub(crate) fn short_sincos<T: Real>(theta: T, floor: f64) -> Short<T> {
    let (zero, one) = (theta.splat(0.0), theta.splat(1.0));
    let quarter = theta.splat(core::f64::consts::FRAC_PI_4);
    let complement = Sum::ordered(theta.splat(core::f64::consts::FRAC_PI_2) - theta, theta.splat(HALF_PI_LO));
    let least = quarter.select_lt(theta, complement.hi, theta);
    let x = least.select_lt(theta.splat(floor), zero, least);
    let x_lo = quarter.select_lt(theta, complement.lo, zero);
    // `rest` is the rounding error of 1 - x^2/2, and `z_lo` that of x^2.
    let (z, half) = (x * x, theta.splat(-0.5));
    let head = half.fma(z, one);
    let rest = half.fma(z, one - head);
    let z_lo = x.fma(x, -z);
    let s = Sum::ordered(x, (x * z).fma(polynomial(z, &SHORT_SINE), x_lo * head));
    let tail = (z * z).fma(polynomial(z, &SHORT_COSINE), half.fma(z_lo, -(x * x_lo)));
    let c = Sum::ordered(head, rest + tail);
    let swap = |yes: T, no: T| quarter.select_lt(theta, yes, no);
    Short {
        sin: Sum { hi: swap(c.hi, s.hi), lo: swap(c.lo, s.lo) },
        cos: Sum { hi: swap(s.hi, c.hi), lo: swap(s.lo, c.lo) },
        least,
    }
}

/// Sine and cosine of x + x_lo, |x| <= pi/4.
#[inline(always)]
fn sin_cos_below_quarter<T: Real>(x: T, x_lo: T) -> [Sum<T>; 2] {
    let one = x.splat(1.0);
    let z = Sum::product(x, x);

    // sin x = x - x^3/6 + x^5 (1/120 - ...)
    let series = polynomial(z.hi, &SINE);
    let sixth = x.splat(1.0 / 6.0);
    let cube = Sum::product(x, z.hi);
    let third = Sum::product(cube.hi, sixth);
    // The low parts are those of the product, of the constant, 1/6 = fl(1/6) (1 + 2^-54 ...), and of the cube.
    let third_lo = third.lo + cube.hi * x.splat(9.251_858_538_542_97e-18) + (cube.lo + x * z.lo) * sixth;
    let s = Sum::ordered(x, -third.hi);
    let s = Sum::ordered(
        s.hi,
        s.lo + ((cube.hi * z.hi) * series - third_lo + x_lo * (one - z.hi * x.splat(0.5))),
    );

    // cos x = 1 - x^2/2 + x^4 (1/24 - ...)
    let series = polynomial(z.hi, &COSINE);
    let half = x.splat(0.5);
    let c = Sum::ordered(one, -(z.hi * half));
    let c = Sum::ordered(c.hi, c.lo + ((z.hi * z.hi) * series - z.lo * half - x * x_lo));
    [s, c]
}

/// Sine and cosine of an angle in [0, pi] as single numbers, each within 2 ulp (2^-53 relative).
#[inline(always)]
pub(crate) fn sin_cos<T: Real>(theta: T) -> (T, T) {
    let [zero, one] = [0.0, 1.0].map(|x| theta.splat(x));
    let quarter = theta.splat(core::f64::consts::FRAC_PI_4);
    let most = theta.splat(3.0 * core::f64::consts::FRAC_PI_4);
    // x is theta, pi/2 - theta or pi - theta, whichever is smallest in size.
    let level = (theta.splat(core::f64::consts::FRAC_PI_2) - theta) + theta.splat(HALF_PI_LO);
    let beyond = (theta.splat(core::f64::consts::PI) - theta) + theta.splat(2.0 * HALF_PI_LO);
    let x = theta.select_lt(quarter, theta, theta.select_lt(most, level, beyond));
    let z = x * x;
    let sin = polynomial(z, &SINE).fma(z, theta.splat(-1.0 / 6.0));
    let cos = polynomial(z, &COSINE);
    let sin = (x * z).fma(sin, x);
    let half = z * theta.splat(0.5);
    // `head` is 1 - z/2; the last term adds its rounding error.
    let head = one - half;
    let cos = head + (z * z).fma(cos, (one - head) - half);
    let side = |near: T, middle: T| theta.select_lt(quarter, near, theta.select_lt(most, middle, near));
    (side(sin, cos), side(cos, sin) * theta.select_lt(most, one, zero - one))
}

/// The angle in [0, pi/2] whose tangent is y/x, for y and x that are not negative; 0 if both vanish. The error is at
/// most 3 ulp.
#[inline(always)]
pub(crate) fn arctan2<T: Real>(y: T, x: T) -> T {
    let (zero, quarter) = (y.splat(0.0), y.splat(core::f64::consts::FRAC_PI_4));
    let (small, large) = (y.min(x), y.max(x));
    // The angle a has tan a = small/large; above pi/8, tan(a - pi/4) = (small - large)/(small + large) is used.
    let upper = large * y.splat(0.414_213_562_373_095_03);
    let turned = upper.select_lt(small, quarter, zero);
    let above = upper.select_lt(small, small - large, small);
    let below = upper.select_lt(small, small + large, large);
    let r = above / below.max(y.splat(f64::MIN_POSITIVE));
    // The coefficients come from Chebyshev interpolation of atan(r)/r in r^2; their error is 4e-18.
    let series = polynomial(
        r * r,
        &[
            -0.017805397205419446,
            0.03796525745386593,
            -0.05035102456601552,
            0.05846878297330872,
            -0.06662951813629191,
            0.07692045330902225,
            -0.09090896809064027,
            0.11111110744919658,
            -0.14285714279250245,
            0.19999999999940893,
            -0.3333333333333312,
        ],
    );
    let angle = turned + (r * (r * r)).fma(series, r);
    let half = y.splat(core::f64::consts::FRAC_PI_2);
    x.select_lt(y, (half - angle) + y.splat(HALF_PI_LO), angle)
}

/// The value of the polynomial with these coefficients, highest power first.
#[inline(always)]
fn polynomial<T: Real>(x: T, coefficients: &[f64]) -> T {
    let mut sum = x.splat(coefficients[0]);
    for &c in &coefficients[1..] {
        sum = sum.fma(x, x.splat(c));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::{SimdBase, f64x8};

    /// sin x and cos x as double-double Taylor sums (32 digits), with every term and product exact.
    fn reference(theta: f64) -> (Sum<f64>, Sum<f64>) {
        let z = Sum::product(theta, theta);
        let mut term = [Sum { hi: theta, lo: 0.0 }, Sum { hi: 1.0, lo: 0.0 }];
        let mut sum = term;
        for k in 1..30 {
            let even = 2.0 * f64::from(k);
            for (i, divisor) in [even * (even + 1.0), even * (even - 1.0)].into_iter().enumerate() {
                let up = term[i].times(-z.hi).plus(term[i].times(-z.lo));
                let hi = up.hi / divisor;
                let lo = ((-hi).mul_add(divisor, up.hi) + up.lo) / divisor;
                term[i] = Sum::ordered(hi, lo);
                sum[i] = sum[i].plus(term[i]);
            }
        }
        (sum[0], sum[1])
    }

    #[test]
    fn the_sums_hold_sine_and_cosine_to_an_eighth_of_an_ulp() {
        let ulp = f64::EPSILON / 2.0;
        let mut worst: f64 = 0.0;
        for i in 0..8_000 {
            let u = (f64::from(i) * 0.618_033_988_749_894_9).fract();
            let theta = if i % 2 == 0 { u * core::f64::consts::FRAC_PI_2 } else { 10f64.powf(-9.0 * u) };
            let (s, c) = reference(theta);
            let got = sincos(theta);
            for (a, b) in [(got.sin, s), (got.cos, c)] {
                worst = worst.max((((a.hi - b.hi) + (a.lo - b.lo)) / b.hi).abs() / ulp);
                assert!(a.lo.abs() <= a.hi.abs() * ulp, "low part too large at {theta}");
            }
        }
        assert!(worst < 0.125, "{worst} ulp");
    }

    #[test]
    fn the_short_sums_hold_sine_and_cosine_to_two_fifths_of_an_ulp() {
        let ulp = f64::EPSILON / 2.0;
        let mut worst: f64 = 0.0;
        for i in 0..200_000 {
            let u = (f64::from(i) * 0.618_033_988_749_894_9).fract();
            let theta = if i % 2 == 0 { u * core::f64::consts::FRAC_PI_2 } else { 10f64.powf(-9.0 * u) };
            let (s, c) = reference(theta);
            let got = short_sincos(theta, 0.0);
            for (a, b) in [(got.sin, s), (got.cos, c)] {
                worst = worst.max((((a.hi - b.hi) + (a.lo - b.lo)) / b.hi).abs() / ulp);
            }
        }
        assert!(worst < 0.4, "{worst} ulp");
        let at = short_sincos(core::f64::consts::FRAC_PI_2, 0.0);
        assert_eq!((at.sin.hi, at.cos.hi, at.least), (1.0, HALF_PI_LO, HALF_PI_LO));
        for outside in [-1e9, -1e-9, core::f64::consts::FRAC_PI_2.next_up(), 3.0, 1e300] {
            assert!(short_sincos(outside, 0.0).least < 0.0);
        }
    }

    #[test]
    fn the_cosine_keeps_its_digits_at_a_right_angle() {
        let c = sincos(core::f64::consts::FRAC_PI_2).cos;
        assert_eq!(c.hi, HALF_PI_LO);
        assert_eq!(sincos(0.0_f64).sin.hi, 0.0);
        assert_eq!(sincos(5e-324_f64).sin.hi, 5e-324);
    }

    #[test]
    fn sines_and_arc_tangents_keep_their_bounds_over_their_range() {
        let ulp = f64::EPSILON / 2.0;
        let mut worst = [0f64; 2];
        for i in 0..20_000 {
            let u = (f64::from(i) * 0.618_033_988_749_894_9).fract();
            let theta = if i % 2 == 0 { u * core::f64::consts::FRAC_PI_2 } else { 10f64.powf(-9.0 * u) };
            let (s, c) = reference(theta);
            let got = sin_cos(theta);
            for (a, b) in [(got.0, s), (got.1, c)] {
                worst[0] = worst[0].max((((a - b.hi) - b.lo) / b.hi).abs() / ulp);
            }
            // pi - theta is the mirror image of theta, up to the rounding of pi and of pi - theta.
            let back = sin_cos(core::f64::consts::PI - theta);
            let mirrored = sincos(core::f64::consts::PI - theta);
            for (a, b) in [(mirrored.sin.hi, back.0), (mirrored.cos.hi, back.1)] {
                assert!((a - b).abs() <= 4.0 * ulp * b.abs(), "{theta}: {a} {b}");
            }
            assert!((back.0 - s.hi).abs() < 5.0 * ulp && (back.1 + c.hi).abs() < 5.0 * ulp, "{theta}");
            // The tangent is known to 1e-32; its error moves the angle by at most as much.
            let angle = arctan2(s.hi, c.hi);
            let rest = (s.lo * c.hi - c.lo * s.hi) / (s.hi * s.hi + c.hi * c.hi);
            worst[1] = worst[1].max(((angle + rest - theta) / theta).abs() / ulp);
        }
        assert!(worst[0] < 2.0 && worst[1] < 3.0, "{worst:?} ulp");
        assert_eq!((arctan2(0.0, 0.0), arctan2(0.0, 3.0)), (0.0, 0.0));
        assert_eq!(arctan2(1e300, 0.0), core::f64::consts::FRAC_PI_2);
    }

    #[test]
    fn up_to_a_straight_angle_the_sums_are_sine_and_cosine() {
        for i in 0..20_000 {
            let theta = core::f64::consts::PI * f64::from(i) / 20_001.0;
            let got = sincos(theta);
            // The identity sin^2 + cos^2 = 1 does not depend on how the angle was reduced.
            let unit = got.sin * got.sin + got.cos * got.cos - 1.0.into();
            assert!(unit.hi.abs() < 2f64.powi(-54), "{theta}: {unit:?}");
            let s = super::super::long_sin_cos(theta);
            let off = |a: Sum<f64>, b: Sum<f64>| ((a - b).hi / b.hi).abs();
            assert!(off(got.sin, s[0]).max(off(got.cos, s[1])) < 0.125 * f64::EPSILON / 2.0, "{theta}");
        }
    }

    #[test]
    fn eight_lanes_give_the_bits_of_one() {
        let theta: [f64; 8] = core::array::from_fn(|i| 0.2 * i as f64 + 1e-3);
        let lanes: Option<[f64; 8]> = super::super::in_lanes!(
            super::super::level(),
            simd => Some(*sincos::<f64x8<_>>(f64x8::from_slice(simd, &theta)).cos.lo),
            else None
        );
        let Some(lanes) = lanes else { return };
        for (x, lane) in theta.iter().zip(lanes) {
            assert_eq!(sincos(*x).cos.lo.to_bits(), lane.to_bits());
        }
    }
}
