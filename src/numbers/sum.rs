//! Numbers with twice the digits: unevaluated sums of two numbers.
//!
//! ```text
//! hi + lo,   |lo| <= ulp(hi)/2                          Dekker 1971, Knuth TAOCP 4.2.2
//! sin x, cos x   Taylor series (Abramowitz and Stegun 4.3.65-66) on |x| <= pi/4, pi/2 and pi taken off first
//! ```
//! Such sums serve where a difference of nearly equal numbers decides a whole motion. Error: sums and products 2^-102
//! of the larger operand, quotients 2^-100; sine and cosine 2^-101, absolute: the tests at the end check it.

use super::real::{Real, operators};
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// An unevaluated sum: `hi` is the rounded number, `lo` its rounding error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sum<T> {
    pub hi: T,
    pub lo: T,
}

impl<T: Real> Sum<T> {
    /// The exact sum `a + b`.
    #[inline(always)]
    pub fn of(a: T, b: T) -> Self {
        let hi = a + b;
        let part = hi - a;
        Self { hi, lo: (a - (hi - part)) + (b - part) }
    }

    /// The exact sum `a + b` where |a| >= |b| or a = 0.
    #[inline(always)]
    pub fn ordered(a: T, b: T) -> Self {
        let hi = a + b;
        Self { hi, lo: b - (hi - a) }
    }

    /// The exact product `a * b`, unless the low part underflows.
    #[inline(always)]
    pub fn product(a: T, b: T) -> Self {
        let hi = a * b;
        Self { hi, lo: a.fma(b, -hi) }
    }

    /// The sum of two unevaluated sums; relative error 2^-104 of the larger.
    #[cfg_attr(short_code, inline(never))]
    #[cfg_attr(not(short_code), inline(always))]
    pub fn plus(self, other: Self) -> Self {
        let high = Self::of(self.hi, other.hi);
        let low = Self::of(self.lo, other.lo);
        let step = Self::ordered(high.hi, high.lo + low.hi);
        Self::ordered(step.hi, step.lo + low.lo)
    }

    /// The product of this sum and a number; relative error 2^-104.
    #[cfg_attr(short_code, inline(never))]
    #[cfg_attr(not(short_code), inline(always))]
    pub fn times(self, x: T) -> Self {
        let high = Self::product(self.hi, x);
        Self::ordered(high.hi, self.lo.fma(x, high.lo))
    }

    #[cfg_attr(short_code, inline(never))]
    #[cfg_attr(not(short_code), inline(always))]
    fn by(self, b: Self) -> Self {
        let high = Self::product(self.hi, b.hi);
        Self::ordered(high.hi, self.hi.fma(b.lo, self.lo.fma(b.hi, high.lo)))
    }

    /// The quotient of this sum and `b`; relative error 2^-100.
    #[cfg_attr(short_code, inline(never))]
    #[cfg_attr(not(short_code), inline(always))]
    fn over(self, b: Self) -> Self {
        let hi = self.hi / b.hi;
        let rest = self.plus(b.times(-hi));
        Self::ordered(hi, rest.hi / b.hi)
    }
}

impl From<f64> for Sum<f64> {
    fn from(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }
}

operators!(
    [T: Real] Sum<T>,
    (a, b),
    a.plus(b),
    a.plus(-b),
    a.by(b),
    a.over(b),
    Self { hi: -a.hi, lo: -a.lo }
);

/// With this implementation every equation over [`Real`] can be evaluated with twice the digits.
impl<T: Real> Real for Sum<T> {
    #[inline(always)]
    fn splat(self, x: f64) -> Self {
        Self { hi: self.hi.splat(x), lo: self.hi.splat(0.0) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.hi.sqrt();
        let rest = self - Self::product(root, root);
        let better = Self::ordered(root, rest.hi / (root + root));
        let zero = root.splat(0.0);
        // The root of 0 is 0, and the root of a negative number is NaN.
        Self { hi: zero.select_lt(root, better.hi, root), lo: zero.select_lt(root, better.lo, zero) }
    }
    #[inline(always)]
    fn round(self) -> Self {
        let whole = self.hi.round();
        let part = Self::ordered(whole, self.lo.round());
        let zero = whole.splat(0.0);
        // The low part decides only where the high part is a whole number.
        let split = (self.hi - whole).abs();
        Self { hi: zero.select_lt(split, whole, part.hi), lo: zero.select_lt(split, zero, part.lo) }
    }
    #[inline(always)]
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self {
        let pick = |yes: T, no: T| {
            let level = self.lo.select_lt(other.lo, yes, no);
            self.hi.select_lt(other.hi, yes, other.hi.select_lt(self.hi, no, level))
        };
        Self { hi: pick(yes.hi, no.hi), lo: pick(yes.lo, no.lo) }
    }
}

/// pi/2 minus the double nearest to it, in two parts.
const HALF_PI: [f64; 2] = [6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33];

/// [sine, cosine, 1 - sine, 1 - |cosine|] of an angle in [0, pi]; the last two have a relative error of
/// 2^-100.
#[inline(always)]
pub(crate) fn sin_cos_falls<T: Real>(theta: T) -> [Sum<T>; 4] {
    let near = Sum { hi: theta, lo: theta.splat(0.0) };
    let [middle, far] = [angle_below(FRAC_PI_2, 1.0, theta), angle_below(PI, 2.0, theta)];
    let [sin, cos, fall] = series(select_by_third(theta, near, middle, far));
    let other = sin.splat(1.0) - sin;
    [
        select_by_third(theta, sin, cos, sin),
        select_by_third(theta, cos, sin, -cos),
        select_by_third(theta, other, fall, other),
        select_by_third(theta, fall, other, fall),
    ]
}

/// The angle `parts` pi/2 - theta with twice the digits, where `from` is the double nearest to `parts` pi/2.
#[inline(always)]
fn angle_below<T: Real>(from: f64, parts: f64, theta: T) -> Sum<T> {
    let zero = theta.splat(0.0);
    let rest = Sum::of(theta.splat(from) - theta, theta.splat(parts * HALF_PI[0]));
    rest.plus(Sum { hi: theta.splat(parts * HALF_PI[1]), lo: zero })
}

/// Returns `near` for theta up to pi/4, `middle` up to 3 pi/4, and `far` beyond.
#[inline(always)]
fn select_by_third<T: Real>(theta: T, near: Sum<T>, middle: Sum<T>, far: Sum<T>) -> Sum<T> {
    let [low, high] = [theta.splat(FRAC_PI_4), theta.splat(3.0 * FRAC_PI_4)];
    Sum {
        hi: low.select_lt(theta, high.select_lt(theta, far.hi, middle.hi), near.hi),
        lo: low.select_lt(theta, high.select_lt(theta, far.lo, middle.lo), near.lo),
    }
}

/// Sine and cosine of an angle in [0, pi], each with twice the digits.
#[inline(always)]
pub(crate) fn sin_cos(theta: f64) -> [Sum<f64>; 2] {
    let [sin, cos, ..] = sin_cos_falls(theta);
    [sin, cos]
}

/// [sine, cosine, 1 - cosine] of a small angle.
#[inline(always)]
fn series<T: Real>(x: Sum<T>) -> [Sum<T>; 3] {
    let square = -(x * x);
    let one = x.splat(1.0);
    // The last term of each series, x^n/n!, is below 2^-104.
    let (mut sin, mut cos, mut fall) = (one, one, one);
    for n in (1..15).rev() {
        let even = f64::from(2 * n);
        sin = one + square * sin / x.splat(even * (even + 1.0));
        fall = square * cos / x.splat(even * (even - 1.0));
        cos = one + fall;
    }
    [sin * x, cos, -fall]
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: f64 = 1.0 / (1u128 << 101) as f64;

    #[test]
    fn sine_and_cosine_hold_a_hundred_bits() {
        // These identities do not follow from the series, so that its rounding errors cannot satisfy them by accident.
        for i in 1..2000 {
            let theta = PI * f64::from(i) / 2000.0;
            let [s, c] = sin_cos(theta);
            let unit = s * s + c * c - 1.0.into();
            assert!(unit.hi.abs() < 8.0 * UNIT, "{theta}: {:e}", unit.hi);
            // The identity sin(2 x) = 2 sin x cos x is checked across the seams at pi/4 and 3 pi/4; doubling is exact.
            if theta < FRAC_PI_2 {
                let [double, _] = sin_cos(2.0 * theta);
                let miss = double - (s * c).times(2.0);
                assert!(miss.hi.abs() < 8.0 * UNIT, "{theta}: {:e}", miss.hi);
            }
        }
        // 1 - sin and 1 - |cos| keep their digits where they are small, as (1 - cos) (1 + cos) = sin^2 shows.
        for theta in [1e-9, 0.7, 0.9, FRAC_PI_2 - 1e-9, 2.3, 2.4, PI - 1e-9] {
            let [s, c, sin_fall, cos_fall] = sin_cos_falls(theta);
            assert_eq!([s, c], sin_cos(theta));
            for (fall, other) in [(sin_fall, c), (cos_fall, s)] {
                let miss = fall * (Sum::from(2.0) - fall) - other * other;
                assert!(miss.hi.abs() < 16.0 * UNIT * fall.hi, "{theta}: {:e}", miss.hi);
            }
        }
        // To 40 digits, sin 1 is 0.8414709848078965066525023216302989996226.
        let [s, _] = sin_cos(1.0);
        assert_eq!(s.hi, 0.841_470_984_807_896_5);
        assert!((s.lo - 1.776_845_092_935_536e-18).abs() < 1e-32, "{:e}", s.lo);
    }

    #[test]
    fn quotients_products_and_roots_are_inverse_to_a_hundred_bits() {
        let mut x = 0.37f64;
        for _ in 0..1000 {
            x = (x * 997.0 + 0.1).fract() + 0.01;
            let (a, b) = (Sum::of(x, 1e-17 * x), Sum::of(1.0 + x * x, -3e-17 * x));
            let back = a / b * b - a;
            assert!(back.hi.abs() < 8.0 * UNIT * x, "{:e}", back.hi);
            let root = a.sqrt();
            assert!((root * root - a).hi.abs() < 8.0 * UNIT * x);
        }
    }
}
