//! The results of a series for motions in SIMD lanes, as a trait object: the code that uses them is then compiled only
//! once, not for each number of terms.

use crate::motions::exact::lanes::{Grip, Midpoints, Swings};
use crate::numbers::side_by_side::{SideBySide, apart};

/// Motions between their turning points, in SIMD lanes; [`Swings`] documents each method.
pub(super) trait SwingsInLanes<T> {
    fn state(&self, t: T) -> ([T; 4], T, T);
    fn fastest_turn(&self) -> T;
    fn inclinations(&self, t: T) -> [T; 2];
    fn least(&self, grip: Grip, t: T, roughly: bool) -> T;
    /// The period, its error, and the rounding part of that error.
    fn period(&self) -> [T; 3];
    fn precession_per_period(&self) -> [T; 3];
}

impl<T: SideBySide, const N: usize, const K: usize> SwingsInLanes<T> for (Swings<T, N, K>, &Midpoints<K>) {
    fn state(&self, t: T) -> ([T; 4], T, T) {
        apart(
            t,
            #[inline(always)]
            || self.0.state(t),
        )
    }

    fn fastest_turn(&self) -> T {
        apart(
            self.0.like(),
            #[inline(always)]
            || self.0.fastest_turn(self.1),
        )
    }

    fn inclinations(&self, t: T) -> [T; 2] {
        apart(
            t,
            #[inline(always)]
            || self.0.inclinations(t),
        )
    }

    fn least(&self, grip: Grip, t: T, roughly: bool) -> T {
        apart(
            t,
            #[inline(always)]
            || self.0.least(grip, t, roughly),
        )
    }

    fn period(&self) -> [T; 3] {
        apart(
            self.0.like(),
            #[inline(always)]
            || {
                let [error, least] = self.0.period_error();
                [self.0.period(), error, least]
            },
        )
    }

    fn precession_per_period(&self) -> [T; 3] {
        apart(
            self.0.like(),
            #[inline(always)]
            || self.0.precession_per_period(self.1),
        )
    }
}
