//! Numbers whose SIMD lanes belong to bodies or motions that are computed side by side; this module contains no physics.
//!
//! A single number is the case of one lane, so that code for SIMD lanes also serves machines without SIMD.

use super::{LANES, Lane, Pair};
use fearless_simd::{ExtractToken, Simd, SimdBase, SimdFloat, f32x8, f32x16, f64x8};

/// A number with one SIMD lane for each of the bodies or motions that are computed side by side.
pub(crate) trait SideBySide: Lane {
    const COUNT: usize;
    /// A number whose SIMD lanes are the first values of `of`.
    fn load(self, of: &[f64]) -> Self;
    fn lane(&self, k: usize) -> f64;
    /// Writes the SIMD lanes to the first places of `to`.
    fn spill(&self, to: &mut [f64]);
    /// Calls `f` in a function that is compiled separately for these SIMD lanes: in one piece the compiler would take minutes.
    fn apart<R>(self, f: impl FnOnce() -> R) -> R;
}

/// Numbers that can be rounded to single precision.
pub(crate) trait Narrow: SideBySide {
    /// The vector of as many numbers in single precision.
    type Single: Copy;

    /// This number rounded to single precision.
    fn single(self) -> Self::Single;
    /// Square root, in single precision, of this number rounded to single precision; NaN below zero.
    fn single_root(self) -> Self::Single;
    /// Converts a number in single precision to double precision.
    fn wide(of: Self::Single) -> Self;
    /// Writes the SIMD lanes in single precision to the first places of `to`.
    fn spill_single(of: Self::Single, to: &mut [f32]);
}

impl SideBySide for f64 {
    const COUNT: usize = 1;
    #[inline(always)]
    fn load(self, of: &[f64]) -> Self {
        of[0]
    }
    #[inline(always)]
    fn lane(&self, _: usize) -> f64 {
        *self
    }
    #[inline(always)]
    fn spill(&self, to: &mut [f64]) {
        to[0] = *self;
    }
    #[inline(always)]
    fn apart<R>(self, f: impl FnOnce() -> R) -> R {
        f()
    }
}

impl Narrow for f64 {
    type Single = f32;

    #[inline(always)]
    fn single(self) -> f32 {
        self as f32
    }
    #[inline(always)]
    fn single_root(self) -> f32 {
        (self as f32).sqrt()
    }
    #[inline(always)]
    fn wide(of: f32) -> Self {
        of.into()
    }
    #[inline(always)]
    fn spill_single(of: f32, to: &mut [f32]) {
        to[0] = of;
    }
}

impl<S: Simd> SideBySide for f64x8<S> {
    const COUNT: usize = LANES;
    #[inline(always)]
    fn load(self, of: &[f64]) -> Self {
        f64x8::from_slice(self.token(), &of[..LANES])
    }
    #[inline(always)]
    fn lane(&self, k: usize) -> f64 {
        self[k]
    }
    #[inline(always)]
    fn spill(&self, to: &mut [f64]) {
        to[..LANES].copy_from_slice(self.as_slice());
    }
    #[inline(always)]
    fn apart<R>(self, f: impl FnOnce() -> R) -> R {
        self.token().vectorize(f)
    }
}

impl<S: Simd> Narrow for f64x8<S> {
    type Single = f32x8<S>;

    #[inline(always)]
    fn single(self) -> f32x8<S> {
        // `narrow_f64x8` takes two vectors; the second half of its result is not used.
        let simd = self.token();
        simd.split_f32x16(simd.narrow_f64x8(self, self)).0
    }
    #[inline(always)]
    fn single_root(self) -> f32x8<S> {
        SimdFloat::sqrt(self.single())
    }
    #[inline(always)]
    fn wide(of: f32x8<S>) -> Self {
        let (first, last) = of.token().widen_f32x8(of);
        of.token().combine_f64x4(first, last)
    }
    #[inline(always)]
    fn spill_single(of: f32x8<S>, to: &mut [f32]) {
        to[..LANES].copy_from_slice(of.as_slice());
    }
}

impl<T: SideBySide> SideBySide for Pair<T> {
    const COUNT: usize = 2 * T::COUNT;
    #[inline(always)]
    fn load(self, of: &[f64]) -> Self {
        Self(self.0.load(of), self.1.load(&of[T::COUNT..]))
    }
    #[inline(always)]
    fn lane(&self, k: usize) -> f64 {
        if k < T::COUNT { self.0.lane(k) } else { self.1.lane(k - T::COUNT) }
    }
    #[inline(always)]
    fn spill(&self, to: &mut [f64]) {
        let (first, second) = to.split_at_mut(T::COUNT);
        self.0.spill(first);
        self.1.spill(second);
    }
    #[inline(always)]
    fn apart<R>(self, f: impl FnOnce() -> R) -> R {
        self.0.apart(f)
    }
}

/// Two vectors in double precision become one vector in single precision.
impl<S: Simd> Narrow for Pair<f64x8<S>> {
    type Single = f32x16<S>;

    #[inline(always)]
    fn single(self) -> f32x16<S> {
        self.0.token().narrow_f64x8(self.0, self.1)
    }
    #[inline(always)]
    fn single_root(self) -> f32x16<S> {
        SimdFloat::sqrt(self.single())
    }
    #[inline(always)]
    fn wide(of: f32x16<S>) -> Self {
        let (first, last) = of.token().widen_f32x16(of);
        Self(first, last)
    }
    #[inline(always)]
    fn spill_single(of: f32x16<S>, to: &mut [f32]) {
        to[..2 * LANES].copy_from_slice(of.as_slice());
    }
}

/// The greatest number of SIMD lanes that are computed side by side.
pub(crate) const MOST: usize = 2 * LANES;

/// [`SideBySide::apart`] in a function that is never inlined.
#[inline(never)]
pub(crate) fn apart<T: SideBySide, R>(like: T, f: impl FnOnce() -> R) -> R {
    like.apart(f)
}

pub(crate) fn zero<S: Simd>(simd: S) -> f64x8<S> {
    <f64x8<S> as SimdBase<S>>::splat(simd, 0.0)
}

/// SIMD lanes with the numbers of `x` from the index `start` on, and NaN after the last number; if `x` has only one
/// number, this number in all lanes.
#[inline(always)]
pub(crate) fn load<T: SideBySide>(like: T, x: &[f64], start: usize) -> T {
    if x.len() == 1 {
        return like.splat(x[0]);
    }
    let left = &x[start.min(x.len())..];
    if left.len() >= T::COUNT {
        return like.load(left);
    }
    let mut lanes = [f64::NAN; MOST];
    lanes[..left.len()].copy_from_slice(left);
    like.load(&lanes)
}
