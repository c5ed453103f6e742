//! All real roots of a polynomial between 0 and 1, each of them once.
//!
//! ```text
//! between two neighbouring roots of p' the polynomial p is monotonic: one root or none
//! ```
//! The derivatives are formed down to the constant; on the way up again each root is bracketed by the extrema, which
//! are the roots of the derivative. Signs at the extrema decide whether a pair of roots exists, so coefficients and
//! values are unevaluated sums (104 bits): an extremum may be off by 2^-53, which changes the value there by the square
//! of that.
//!
//! Root error: 1 ulp of the exact root of the given coefficients, also next to a double root.

use crate::numbers::Sum;
use core::ops::{Add, Mul, Sub};

/// The highest degree, which the polynomial of the boundary of stability of a rounded rim has.
const HIGHEST_DEGREE: usize = 16;

/// The roots of a polynomial in ascending order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SortedRoots {
    items: [f64; HIGHEST_DEGREE],
    len: usize,
}

impl SortedRoots {
    fn push(&mut self, x: f64) {
        self.items[self.len] = x;
        self.len += 1;
    }

    pub fn as_slice(&self) -> &[f64] {
        &self.items[..self.len]
    }
}

/// The roots in the open interval (0, 1) of `sum of p[k] t^k`, in ascending order; a double root appears once.
pub(crate) fn in_unit_interval(p: &[Sum<f64>]) -> SortedRoots {
    in_unit_interval_with_end(p, sign_below_one(p))
}

/// The roots in the open interval (0, 1) of a polynomial whose sign just below 1 the caller knows better than the sum
/// of its rounded coefficients shows.
pub(crate) fn in_unit_interval_with_end(p: &[Sum<f64>], sign_below_one: f64) -> SortedRoots {
    let mut found = SortedRoots { items: [0.0; HIGHEST_DEGREE], len: 0 };
    if p.len() < 2 {
        return found;
    }
    let derivative = derivative(p);
    let slope = &derivative[..p.len() - 1];
    let extrema = in_unit_interval(slope);
    let inside = extrema.as_slice().iter().map(|e| (*e, sign(value(p, *e).hi)));
    let (mut low, mut sign_low) = (0.0, sign_above_zero(p));
    for (high, sign_high) in inside.chain([(1.0, sign_below_one)]) {
        if sign_low * sign_high < 0.0 {
            found.push(bracketed_root(p, slope, low, high, sign_low));
        } else if sign_high == 0.0 && high < 1.0 {
            found.push(high);
        }
        (low, sign_low) = (high, sign_high);
    }
    found
}

const ZERO: Sum<f64> = Sum { hi: 0.0, lo: 0.0 };

/// The sign of x: -1, 0 or 1.
fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

fn derivative(p: &[Sum<f64>]) -> [Sum<f64>; HIGHEST_DEGREE] {
    let mut d = [ZERO; HIGHEST_DEGREE];
    for (k, c) in p.iter().enumerate().skip(1) {
        d[k - 1] = c.times(k as f64);
    }
    d
}

fn value(p: &[Sum<f64>], t: f64) -> Sum<f64> {
    p.iter().rev().copied().reduce(|sum, c| sum.times(t).plus(c)).unwrap_or(ZERO)
}

/// The sign of a polynomial just above 0, which is that of its lowest coefficient that is not zero.
fn sign_above_zero(p: &[Sum<f64>]) -> f64 {
    p.iter().map(|c| sign(c.hi)).find(|s| *s != 0.0).unwrap_or(0.0)
}

/// The sign of a polynomial p just below 1: that of p(1) or, where p(1) is zero, the opposite of that of the slope.
fn sign_below_one(p: &[Sum<f64>]) -> f64 {
    let at_one = sign(value(p, 1.0).hi);
    if at_one != 0.0 || p.len() < 2 {
        return at_one;
    }
    -sign_below_one(&derivative(p)[..p.len() - 1])
}

/// The root bracketed by `low` and `high`, where `p` changes from the sign `sign_low`. Newton's steps are taken while
/// they shrink fast; otherwise the bracket is halved.
fn bracketed_root(p: &[Sum<f64>], slope: &[Sum<f64>], mut low: f64, mut high: f64, sign_low: f64) -> f64 {
    let mut t = middle_of(low, high);
    let mut step = high - low;
    loop {
        let v = value(p, t).hi;
        let newton = -v / slope.iter().rev().fold(0.0, |sum: f64, c| sum.mul_add(t, c.hi));
        if v == 0.0 || newton.abs() <= 0.25 * f64::EPSILON * t {
            return t;
        }
        if v.signum() == sign_low {
            low = t;
        } else {
            high = t;
        }
        let next = t + newton;
        let shrinks = newton.abs() <= 0.5 * step;
        let next = if low < next && next < high && shrinks { next } else { middle_of(low, high) };
        if next <= low || next >= high {
            return t;
        }
        step = (next - t).abs();
        t = next;
    }
}

/// The middle of two numbers, or of their exponents where the numbers differ by more than a factor of 2.
fn middle_of(low: f64, high: f64) -> f64 {
    if high > 2.0 * low {
        f64::from_bits((low.to_bits() + high.to_bits()) / 2)
    } else {
        low + 0.5 * (high - low)
    }
}

/// A type of number for the coefficients of a [`Cubic`].
pub(crate) trait Coefficient: Copy + From<Sum<f64>> {
    fn plus(self, other: Self) -> Self;
    /// The sum `self + a b`, with the product.
    fn plus_product(self, a: Self, b: Self) -> Self;
}

impl Coefficient for Sum<f64> {
    fn plus(self, other: Self) -> Self {
        Sum::plus(self, other)
    }
    fn plus_product(self, a: Self, b: Self) -> Self {
        Sum::plus(Sum::plus(self, a.times(b.hi)), a.times(b.lo))
    }
}

/// A polynomial in T = tan theta of degree three at most, by default with coefficients of 104 bits.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cubic<C = Sum<f64>>(pub [C; 4]);

impl<C: Coefficient> Cubic<C> {
    /// The polynomial T itself.
    pub fn tangent() -> Self {
        Self([ZERO, Sum { hi: 1.0, lo: 0.0 }, ZERO, ZERO].map(C::from))
    }

    /// A constant polynomial.
    pub fn of(x: impl Into<Sum<f64>>) -> Self {
        Self([x.into(), ZERO, ZERO, ZERO].map(C::from))
    }
}

impl Cubic {
    /// The angles theta in (0, pi/2) where the polynomial vanishes, in ascending order.
    pub fn angles(&self) -> impl Iterator<Item = f64> {
        let up = self.0;
        let mut down = up;
        down.reverse();
        // T = 1 is the end of the unit interval both of T and of 1/T, so that one sign serves for both.
        let at_one = sign(value(&up, 1.0).hi);
        let low = if at_one == 0.0 { in_unit_interval(&up) } else { in_unit_interval_with_end(&up, at_one) };
        let high =
            if at_one == 0.0 { in_unit_interval(&down) } else { in_unit_interval_with_end(&down, at_one) };
        let steep = (0..high.len).rev().map(move |k| 1f64.atan2(high.items[k]));
        let one = (at_one == 0.0).then_some(core::f64::consts::FRAC_PI_4);
        (0..low.len).map(move |k| low.items[k].atan()).chain(one).chain(steep)
    }
}

/// A polynomial in sine and cosine of theta, of degree `degree`, as p(t)/(1 + t^2)^degree with t = tan(theta/2); the
/// coefficients have 104 bits.
#[derive(Debug, Clone)]
pub(crate) struct Trig {
    p: Vec<Sum<f64>>,
    degree: usize,
}

impl Trig {
    /// A constant polynomial of degree 0 in sine and cosine.
    pub fn of(x: impl Into<Sum<f64>>) -> Self {
        Self { p: vec![x.into()], degree: 0 }
    }

    pub fn sin() -> Self {
        Self { p: [0.0, 2.0, 0.0].map(Sum::from).to_vec(), degree: 1 }
    }

    pub fn cos() -> Self {
        Self { p: [1.0, 0.0, -1.0].map(Sum::from).to_vec(), degree: 1 }
    }

    /// The same polynomial, written over a higher power of 1 + t^2.
    fn over_higher_power(&self, degree: usize) -> Self {
        let one = Self { p: [1.0, 0.0, 1.0].map(Sum::from).to_vec(), degree: 1 };
        let product = (self.degree..degree).fold(self.clone(), |all, _| &all * &one);
        Self { degree, ..product }
    }

    /// The derivative of the polynomial with respect to theta.
    pub fn slope(&self) -> Self {
        let k = self.degree as f64;
        let mut p = vec![ZERO; self.p.len() + 1];
        for (i, c) in self.p.iter().enumerate() {
            // The term c t^i gives c ((1 + t^2) i t^(i - 1)/2 - k t^(i + 1)).
            let half = 0.5 * i as f64;
            if i > 0 {
                p[i - 1] = p[i - 1].plus(c.times(half));
            }
            p[i + 1] = p[i + 1].plus(c.times(half - k));
        }
        p.truncate(self.p.len());
        Self { p, degree: self.degree }
    }

    /// The angles in (0, pi/2) and in (pi/2, pi) where the polynomial vanishes, in ascending order.
    pub fn angles(&self) -> Vec<f64> {
        let scale = self.p.iter().fold(f64::MIN_POSITIVE, |most, c| most.max(c.hi.abs()));
        // The scale is a power of two, which rounds nothing.
        let down = 2f64.powi(-(scale.log2().floor() as i32).clamp(-1000, 1000));
        let mut p: Vec<_> = self.p.iter().map(|c| c.times(down)).collect();
        let low = in_unit_interval(&p);
        p.reverse();
        let high = in_unit_interval(&p);
        let level = core::f64::consts::PI;
        let near = low.as_slice().iter().map(|t| 2.0 * t.atan());
        near.chain(high.as_slice().iter().rev().map(|t| level - 2.0 * t.atan())).collect()
    }
}

impl Add for &Trig {
    type Output = Trig;
    fn add(self, other: &Trig) -> Trig {
        let degree = self.degree.max(other.degree);
        let (a, b) = (self.over_higher_power(degree), other.over_higher_power(degree));
        Trig { p: a.p.iter().zip(&b.p).map(|(a, b)| a.plus(*b)).collect(), degree }
    }
}

impl Sub for &Trig {
    type Output = Trig;
    fn sub(self, other: &Trig) -> Trig {
        self + &(other * &Trig::of(-1.0))
    }
}

impl Mul for &Trig {
    type Output = Trig;
    fn mul(self, other: &Trig) -> Trig {
        let degree = self.degree + other.degree;
        let mut p = vec![ZERO; 2 * degree + 1];
        for (i, a) in self.p.iter().enumerate() {
            for (j, b) in other.p.iter().enumerate() {
                p[i + j] = p[i + j].plus(*a * *b);
            }
        }
        Trig { p, degree }
    }
}

impl<C: Coefficient> Add for Cubic<C> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(core::array::from_fn(|k| self.0[k].plus(other.0[k])))
    }
}

impl<C: Coefficient> Sub for Cubic<C> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + other * Self::of(-1.0)
    }
}

/// The product of two polynomials whose degrees add up to three at most.
impl<C: Coefficient> Mul for Cubic<C> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let mut out = [C::from(ZERO); 4];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate().take(4 - i) {
                out[i + j] = out[i + j].plus_product(*a, *b);
            }
        }
        Self(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The product (t - r1)(t - r2)..., multiplied out in 104 bits.
    fn planted(roots: &[f64]) -> Vec<Sum<f64>> {
        let mut p = vec![Sum { hi: 1.0, lo: 0.0 }];
        for &r in roots {
            let mut q = vec![ZERO; p.len() + 1];
            for (k, c) in p.iter().enumerate() {
                q[k + 1] = q[k + 1].plus(*c);
                q[k] = q[k].plus(c.times(-r));
            }
            p = q;
        }
        p
    }

    proptest! {
        #[test]
        fn planted_roots_are_found_once_each(
            mut roots in prop::collection::vec(prop_oneof![0.001..0.999f64, -3.0..-0.01f64, 1.01..50.0f64], 1..=4),
        ) {
            roots.sort_by(f64::total_cmp);
            prop_assume!(roots.windows(2).all(|w| w[1] - w[0] > 1e-9));
            let expected: Vec<f64> = roots.iter().copied().filter(|r| (0.0..1.0).contains(r)).collect();
            let found = in_unit_interval(&planted(&roots));
            prop_assert_eq!(found.as_slice().len(), expected.len());
            for (f, e) in found.as_slice().iter().zip(&expected) {
                prop_assert!((f - e).abs() <= f64::EPSILON * e, "{f} is not {e}");
            }
        }
    }

    #[test]
    fn a_pair_is_found_down_to_the_last_bit_of_its_gap_and_a_double_root_once() {
        let found = in_unit_interval(&planted(&[0.5, 0.5 + f64::EPSILON]));
        assert_eq!(found.as_slice().len(), 2);
        assert_eq!(in_unit_interval(&planted(&[0.25, 0.25, -1.0])).as_slice().len(), 1);
        assert_eq!(in_unit_interval(&planted(&[0.75, 0.75, 0.75])).as_slice().len(), 1);
        let mut apart = planted(&[0.5, 0.5]);
        apart[0].lo += 1e-30;
        assert_eq!(in_unit_interval(&apart).as_slice().len(), 0, "lifted off by 1e-30");
    }

    #[test]
    fn a_cubic_has_its_planted_angles_also_at_a_slope_of_one() {
        let line = |root: f64| Cubic::<Sum<f64>>::tangent() - Cubic::of(root);
        for roots in
            [[0.5, 1.0, 3.0], [1.0 - f64::EPSILON, 1.0 + f64::EPSILON, 1e9], [1e-9, 1.0 - 1e-16, 2.0]]
        {
            let angles: Vec<f64> = (line(roots[0]) * line(roots[1]) * line(roots[2])).angles().collect();
            assert_eq!(angles.len(), 3, "{roots:?}: {angles:?}");
            assert!(angles.iter().zip(roots).all(|(a, r)| (a - r.atan()).abs() <= f64::EPSILON * a));
        }
        let none = Cubic::<Sum<f64>>::tangent() * Cubic::<Sum<f64>>::tangent() + Cubic::of(1.0);
        assert_eq!((none * line(-2.0)).angles().count(), 0);
    }

    #[test]
    fn the_ends_do_not_count() {
        assert_eq!(in_unit_interval(&planted(&[0.0, 1.0])).as_slice().len(), 0);
        assert_eq!(in_unit_interval(&planted(&[1.0, 1.0, 0.5])).as_slice().len(), 1);
        assert_eq!(in_unit_interval(&planted(&[1.0, 1.0, 1.0, 0.5])).as_slice().len(), 1);
        assert_eq!(in_unit_interval(&planted(&[1.0, 0.0, 1e-100, 0.5])).as_slice().len(), 2);
        assert_eq!(in_unit_interval(&[ZERO, ZERO, ZERO]).as_slice().len(), 0);
    }
}
