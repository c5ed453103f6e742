//! Eight numbers in SIMD lanes, and two vectors of such lanes side by side.
//!
//! Each lane is computed like a single number, except that `mac` is fused in lanes: the tests of `angle` and of the
//! ensembles compare the bits of lanes and of single numbers.

use super::real::{Lane, Real, operators};
use fearless_simd::{ExtractToken, Select, Simd, SimdBase, SimdFloat, SimdMask, f64x8};

/// Number of SIMD lanes in one vector.
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
    fn round(self) -> Self {
        self.round_ties_even()
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        SimdFloat::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.token().abs_f64x8(self)
    }
    #[inline(always)]
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self {
        self.simd_lt(other).select(yes, no)
    }
}

impl<S: Simd> Lane for f64x8<S> {
    #[inline(always)]
    fn any_lt(self, other: Self) -> bool {
        self.simd_lt(other).any_true()
    }
    #[inline(always)]
    fn aside<R>(self, work: impl FnOnce() -> R) -> R {
        apart_of(self.token(), work)
    }
}

#[cold]
#[inline(never)]
fn apart_of<S: Simd, R>(simd: S, work: impl FnOnce() -> R) -> R {
    simd.vectorize(work)
}

/// Two numbers side by side: while the processor waits for a result of one, it works on the other.
#[derive(Clone, Copy)]
pub(crate) struct Pair<T>(pub T, pub T);

impl<T: Lane> Lane for Pair<T> {
    #[inline(always)]
    fn any_lt(self, other: Self) -> bool {
        self.0.any_lt(other.0) || self.1.any_lt(other.1)
    }
    #[inline(always)]
    fn aside<R>(self, work: impl FnOnce() -> R) -> R {
        self.0.aside(work)
    }
}

operators!(
    [T: Real] Pair<T>,
    (a, b),
    Self(a.0 + b.0, a.1 + b.1),
    Self(a.0 - b.0, a.1 - b.1),
    Self(a.0 * b.0, a.1 * b.1),
    Self(a.0 / b.0, a.1 / b.1),
    Self(-a.0, -a.1)
);

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
    fn round(self) -> Self {
        Self(self.0.round(), self.1.round())
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
    }
    #[inline(always)]
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self {
        Self(self.0.select_lt(other.0, yes.0, no.0), self.1.select_lt(other.1, yes.1, no.1))
    }
}
