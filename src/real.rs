//! Numbers to compute with: one `f64`, or eight of them in SIMD lanes.
//!
//! ```text
//! sin theta, cos theta   as unevaluated sums hi + lo,   0 <= theta <= pi/2
//! ```
//! An equation is written once over [`Real`] and serves a single state and a dense sweep alike.
//! Every operation is correctly rounded (the fused one too, on machines without it), so a lane
//! gives the same bits whatever its neighbours, the SIMD width or the machine.
//!
//! `hi + lo` is within 1/8 ulp (2^-53 relative) of the sine and of the cosine, `hi` within 1.125:
//! the test at the end runs it. Taylor series on [0, pi/4] (Abramowitz and Stegun 4.3.65-66),
//! with the leading terms carried as exact sums and products (Dekker 1971, Knuth TAOCP 4.2.2).

use crate::sum::Sum;
use core::ops::{Add, Div, Mul, Neg, Sub};
use fearless_simd::{ExtractToken, Select, Simd, SimdBase, SimdFloat, f64x8};

/// Numbers in one set of lanes.
pub(crate) const LANES: usize = 8;

/// A real number, or eight in lanes.
pub(crate) trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The constant `x` in as many lanes as `self` has.
    fn splat(self, x: f64) -> Self;
    /// `self * b + c`, rounded once.
    fn fma(self, b: Self, c: Self) -> Self;
    /// Square root; NaN below zero.
    fn sqrt(self) -> Self;
    /// `self * b + c`, rounded once in lanes, twice in a single number, where a processor may lack the
    /// instruction.
    fn mac(self, b: Self, c: Self) -> Self;
    /// The nearest whole number, ties to even.
    fn round(self) -> Self;
    /// Where `self < other` the first, elsewhere (also for NaN) the second.
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self;

    /// Absolute value.
    #[inline(always)]
    fn abs(self) -> Self {
        self.select_lt(self.splat(0.0), -self, self)
    }

    /// The smaller; the other if this is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.select_lt(other, self, other)
    }

    /// The larger; the other if this is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        other.select_lt(self, self, other)
    }
}

impl Real for f64 {
    #[inline(always)]
    fn splat(self, x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        self.mul_add(b, c)
    }
    #[inline(always)]
    fn mac(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    #[inline(always)]
    fn round(self) -> Self {
        self.round_ties_even()
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self {
        if self < other { yes } else { no }
    }
}

impl<S: Simd> Real for f64x8<S> {
    #[inline(always)]
    fn splat(self, x: f64) -> Self {
        SimdBase::splat(self.token(), x)
    }
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        self.mul_add_precise(b, c)
    }
    #[inline(always)]
    fn mac(self, b: Self, c: Self) -> Self {
        self.mul_add_precise(b, c)
    }
    #[inline(always)]
    fn round(self) -> Self {
        self.round_ties_even()
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        SimdFloat::sqrt(self)
    }
    #[inline(always)]
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self {
        self.simd_lt(other).select(yes, no)
    }
}

/// Two reals side by side: one's operations fill the time in which the other's are under way.
#[derive(Clone, Copy)]
pub(crate) struct Pair<T>(pub T, pub T);

impl<T: Real> Add for Pair<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self(self.0 + b.0, self.1 + b.1)
    }
}
impl<T: Real> Sub for Pair<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self(self.0 - b.0, self.1 - b.1)
    }
}
impl<T: Real> Mul for Pair<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self(self.0 * b.0, self.1 * b.1)
    }
}
impl<T: Real> Div for Pair<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        Self(self.0 / b.0, self.1 / b.1)
    }
}
impl<T: Real> Neg for Pair<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}
impl<T: Real> Real for Pair<T> {
    #[inline(always)]
    fn splat(self, x: f64) -> Self {
        Self(self.0.splat(x), self.1.splat(x))
    }
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        Self(self.0.fma(b.0, c.0), self.1.fma(b.1, c.1))
    }
    #[inline(always)]
    fn mac(self, b: Self, c: Self) -> Self {
        Self(self.0.mac(b.0, c.0), self.1.mac(b.1, c.1))
    }
    #[inline(always)]
    fn round(self) -> Self {
        Self(self.0.round(), self.1.round())
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self {
        Self(self.0.select_lt(other.0, yes.0, no.0), self.1.select_lt(other.1, yes.1, no.1))
    }
}

/// Sine and cosine of an inclination, each as an unevaluated sum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SinCos<T> {
    pub sin: Sum<T>,
    pub cos: Sum<T>,
}

/// Taylor coefficients of the sine from x^17 down to x^5, of the cosine from x^18 to x^4.
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

const HALF_PI_LO: f64 = 6.123_233_995_736_766e-17;

/// Sine and cosine of `theta` in [0, pi/2]; NaN or nonsense outside, which callers exclude.
#[inline(always)]
pub(crate) fn sincos<T: Real>(theta: T) -> SinCos<T> {
    let one = theta.splat(1.0);
    let quarter = theta.splat(core::f64::consts::FRAC_PI_4);
    // Above pi/4 the complement pi/2 - theta is exact to 106 bits, so the cosine keeps its digits.
    let complement = Sum::of(theta.splat(core::f64::consts::FRAC_PI_2) - theta, theta.splat(HALF_PI_LO));
    let x = quarter.select_lt(theta, complement.hi, theta);
    let x_lo = quarter.select_lt(theta, complement.lo, theta.splat(0.0));
    let z = Sum::product(x, x);

    // sin x = x - x^3/6 + x^5 (1/120 - ...)
    let series = horner(z.hi, &SINE);
    let sixth = theta.splat(1.0 / 6.0);
    let cube = Sum::product(x, z.hi);
    let third = Sum::product(cube.hi, sixth);
    // 1/6 = fl(1/6) (1 + 2^-54 ...): the low part of the constant, of the cube, and of the argument
    let third_lo = third.lo + cube.hi * theta.splat(9.251_858_538_542_97e-18) + (cube.lo + x * z.lo) * sixth;
    let s = Sum::ordered(x, -third.hi);
    let s = Sum::ordered(
        s.hi,
        s.lo + ((cube.hi * z.hi) * series - third_lo + x_lo * (one - z.hi * theta.splat(0.5))),
    );

    // cos x = 1 - x^2/2 + x^4 (1/24 - ...)
    let series = horner(z.hi, &COSINE);
    let half = theta.splat(0.5);
    let c = Sum::ordered(one, -(z.hi * half));
    let c = Sum::ordered(c.hi, c.lo + ((z.hi * z.hi) * series - z.lo * half - x * x_lo));

    let swap = |yes: T, no: T| quarter.select_lt(theta, yes, no);
    SinCos {
        sin: Sum { hi: swap(c.hi, s.hi), lo: swap(c.lo, s.lo) },
        cos: Sum { hi: swap(s.hi, c.hi), lo: swap(s.lo, c.lo) },
    }
}

/// Sine and cosine of an angle in [0, pi], each within 2 ulp (2^-53 relative).
#[inline(always)]
pub(crate) fn sin_cos<T: Real>(theta: T) -> (T, T) {
    let [zero, one] = [0.0, 1.0].map(|x| theta.splat(x));
    let quarter = theta.splat(core::f64::consts::FRAC_PI_4);
    let most = theta.splat(3.0 * core::f64::consts::FRAC_PI_4);
    // x = theta, pi/2 - theta or pi - theta, whichever is smallest
    let level = (theta.splat(core::f64::consts::FRAC_PI_2) - theta) + theta.splat(HALF_PI_LO);
    let beyond = (theta.splat(core::f64::consts::PI) - theta) + theta.splat(2.0 * HALF_PI_LO);
    let x = theta.select_lt(quarter, theta, theta.select_lt(most, level, beyond));
    let z = x * x;
    let sin = horner(z, &SINE).fma(z, theta.splat(-1.0 / 6.0));
    let cos = horner(z, &COSINE);
    let sin = (x * z).fma(sin, x);
    let half = z * theta.splat(0.5);
    // 1 - z/2 with what rounding takes from it
    let head = one - half;
    let cos = head + (z * z).fma(cos, (one - head) - half);
    let side = |near: T, middle: T| theta.select_lt(quarter, near, theta.select_lt(most, middle, near));
    (side(sin, cos), side(cos, sin) * theta.select_lt(most, one, zero - one))
}

/// The angle in [0, pi/2] whose sine and cosine are as `y` to `x`, both not negative; 0 if both vanish.
/// Within 3 ulp.
#[inline(always)]
pub(crate) fn arctan2<T: Real>(y: T, x: T) -> T {
    let (zero, quarter) = (y.splat(0.0), y.splat(core::f64::consts::FRAC_PI_4));
    let (small, large) = (y.min(x), y.max(x));
    // tan a = small/large; above pi/8 by tan(a - pi/4) = (small - large)/(small + large)
    let upper = large * y.splat(0.414_213_562_373_095_03);
    let turned = upper.select_lt(small, quarter, zero);
    let above = upper.select_lt(small, small - large, small);
    let below = upper.select_lt(small, small + large, large);
    let r = above / below.max(y.splat(f64::MIN_POSITIVE));
    // by Chebyshev interpolation of atan(r)/r in r^2, within 4e-18
    let series = horner(
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

/// The polynomial with these coefficients, highest power first.
#[inline(always)]
fn horner<T: Real>(x: T, coefficients: &[f64]) -> T {
    let mut sum = x.splat(coefficients[0]);
    for &c in &coefficients[1..] {
        sum = sum.fma(x, x.splat(c));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// sin x and cos x as double-double Taylor sums (32 digits), every term and product exact.
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
        for i in 0..20_000 {
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
            // pi - theta is theta's mirror image, up to the rounding of pi and of pi - theta
            let back = sin_cos(core::f64::consts::PI - theta);
            assert!((back.0 - s.hi).abs() < 5.0 * ulp && (back.1 + c.hi).abs() < 5.0 * ulp, "{theta}");
            // the tangent is known to 1e-32, and moves the angle by at most as much
            let angle = arctan2(s.hi, c.hi);
            let rest = (s.lo * c.hi - c.lo * s.hi) / (s.hi * s.hi + c.hi * c.hi);
            worst[1] = worst[1].max(((angle + rest - theta) / theta).abs() / ulp);
        }
        assert!(worst[0] < 2.0 && worst[1] < 3.0, "{worst:?} ulp");
        assert_eq!((arctan2(0.0, 0.0), arctan2(0.0, 3.0)), (0.0, 0.0));
        assert_eq!(arctan2(1e300, 0.0), core::f64::consts::FRAC_PI_2);
    }

    #[test]
    fn eight_lanes_give_the_bits_of_one() {
        let theta: [f64; 8] = core::array::from_fn(|i| 0.2 * i as f64 + 1e-3);
        let lanes = fearless_simd::dispatch!(fearless_simd::Level::new(), simd => {
            *sincos::<f64x8<_>>(f64x8::from_slice(simd, &theta)).cos.lo
        });
        for (x, lane) in theta.iter().zip(lanes) {
            assert_eq!(sincos(*x).cos.lo.to_bits(), lane.to_bits());
        }
    }
}
