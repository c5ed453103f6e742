//! Eight numbers in SIMD lanes, and two such sets side by side.
//!
//! Each lane is computed as a single number is, but that `mac` is fused here: the tests of `angle` and of the
//! ensembles compare the bits of lanes and of single numbers.

use super::real::Real;
use core::ops::{Add, Div, Mul, Neg, Sub};
use fearless_simd::{ExtractToken, Select, Simd, SimdBase, SimdFloat, f64x8};

/// Numbers in one set of lanes.
pub(crate) const LANES: usize = 8;

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
