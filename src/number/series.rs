//! A power series in one variable, cut off after some terms: a law sent through it gives the motion's own series.
//!
//! ```text
//! (a b)_n = sum a_j b_(n-j),   (a/b)_n = (a_n - sum_(j<n) (a/b)_j b_(n-j))/b_0
//! ```
//! Recurrences of automatic differentiation (Griewank and Walther 2008, ch. 13). Error: a few roundings of the largest
//! product in each coefficient.

use super::real::Real;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Coefficients of 1, t, t^2, ...
#[derive(Clone, Copy, Debug)]
pub(crate) struct Series<const K: usize>(pub [f64; K]);

impl<const K: usize> Series<K> {
    /// A constant.
    pub fn of(x: f64) -> Self {
        let mut all = [0.0; K];
        all[0] = x;
        Self(all)
    }

    /// The integral from 0, with the value `x` there.
    pub fn integral(&self, x: f64) -> Self {
        Self(core::array::from_fn(|n| if n == 0 { x } else { self.0[n - 1] / n as f64 }))
    }

    /// The value at `t`.
    pub fn at(&self, t: f64) -> f64 {
        self.0.iter().rev().fold(0.0, |sum, a| sum * t + a)
    }
}

impl<const K: usize> Add for Series<K> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self(core::array::from_fn(|n| self.0[n] + b.0[n]))
    }
}
impl<const K: usize> Sub for Series<K> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self(core::array::from_fn(|n| self.0[n] - b.0[n]))
    }
}
impl<const K: usize> Mul for Series<K> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self(core::array::from_fn(|n| (0..=n).map(|j| self.0[j] * b.0[n - j]).sum()))
    }
}
impl<const K: usize> Div for Series<K> {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let mut q = [0.0; K];
        for n in 0..K {
            let rest: f64 = (0..n).map(|j| q[j] * b.0[n - j]).sum();
            q[n] = (self.0[n] - rest) / b.0[0];
        }
        Self(q)
    }
}
impl<const K: usize> Neg for Series<K> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|a| -a))
    }
}

impl<const K: usize> Real for Series<K> {
    fn splat(self, x: f64) -> Self {
        Self::of(x)
    }
    fn fma(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    fn mac(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    fn sqrt(self) -> Self {
        let mut root = [0.0; K];
        root[0] = self.0[0].sqrt();
        for n in 1..K {
            let rest: f64 = (1..n).map(|j| root[j] * root[n - j]).sum();
            root[n] = (self.0[n] - rest) / (2.0 * root[0]);
        }
        Self(root)
    }
    fn round(self) -> Self {
        Self::of(self.0[0].round())
    }
    /// By the values at 0.
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self {
        if self.0[0] < other.0[0] { yes } else { no }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_quotients_and_roots_undo_each_other() {
        let a = Series([0.7, -1.3, 0.4, 2.0, -0.1, 0.9]);
        let b = Series([1.9, 0.3, -2.2, 0.6, 1.1, -0.5]);
        for (n, x) in [(a * b) / b, (a * a).sqrt()].into_iter().enumerate() {
            assert!(x.0.iter().zip(a.0).all(|(x, a)| (x - a).abs() < 1e-14), "{n}: {x:?}");
        }
        let grown = Series::<20>([1.0; 20]).integral(0.0);
        assert!((grown.at(0.1) + (1.0f64 - 0.1).ln()).abs() < 1e-15);
    }
}
