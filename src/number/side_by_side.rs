//! Numbers whose SIMD lanes belong to motions that are computed side by side; this module contains no physics.

use super::{LANES, Lane, Pair};
use fearless_simd::{ExtractToken, Simd, SimdBase, f64x8};

/// A number with one lane for each of the tasks that are computed side by side.
pub(crate) trait SideBySide: Lane {
    const COUNT: usize;
    /// A number with the first values of `of` in its lanes.
    fn load(self, of: &[f64]) -> Self;
    fn lane(&self, k: usize) -> f64;
    /// Writes the lanes to the first places of `to`.
    fn spill(&self, to: &mut [f64; MOST]);
    /// Calls `f` in a separate function that is compiled for these lanes: in one piece the compiler would take minutes.
    fn apart<R>(self, f: impl FnOnce() -> R) -> R;
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
    fn spill(&self, to: &mut [f64; MOST]) {
        to[..LANES].copy_from_slice(self.as_slice());
    }
    #[inline(always)]
    fn apart<R>(self, f: impl FnOnce() -> R) -> R {
        self.token().vectorize(f)
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
    fn spill(&self, to: &mut [f64; MOST]) {
        let mut second = [0.0; MOST];
        self.0.spill(to);
        self.1.spill(&mut second);
        to[T::COUNT..Self::COUNT].copy_from_slice(&second[..T::COUNT]);
    }
    #[inline(always)]
    fn apart<R>(self, f: impl FnOnce() -> R) -> R {
        self.0.apart(f)
    }
}

/// The greatest number of lanes.
pub(crate) const MOST: usize = 2 * LANES;

/// [`SideBySide::apart`] in a function that is never inlined.
#[inline(never)]
pub(crate) fn apart<T: SideBySide, R>(like: T, f: impl FnOnce() -> R) -> R {
    like.apart(f)
}

pub(crate) fn zero<S: Simd>(simd: S) -> f64x8<S> {
    <f64x8<S> as SimdBase<S>>::splat(simd, 0.0)
}
