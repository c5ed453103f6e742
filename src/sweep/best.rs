//! The minimum and the maximum of many numbers, with their places.

use super::wide_of;
use crate::number::{LANES, Real};
use fearless_simd::{Simd, f64x8};

/// Minimum and maximum of a quantity of a map, each as (value, inclination's index, body's index); None if there is no
/// steady state at all.
pub type Extrema = Option<[(f64, usize, usize); 2]>;

/// The minimum of x and of -x in each lane, with its place: the number of the column of eight bodies, row by row.
#[derive(Clone, Copy)]
pub(super) struct Best<S: Simd>([(f64x8<S>, f64x8<S>); 2]);

impl<S: Simd> Best<S> {
    #[inline(always)]
    pub fn nothing(simd: S) -> Self {
        Self([(wide_of(simd, f64::INFINITY), wide_of(simd, 0.0)); 2])
    }

    /// Compares eight numbers with the extrema so far; a NaN is ignored.
    #[inline(always)]
    pub fn keep(&mut self, x: f64x8<S>, place: f64) {
        let place = x.splat(place);
        let [least, greatest] = &mut self.0;
        *least = (x.select_lt(least.0, x, least.0), x.select_lt(least.0, place, least.1));
        let x = -x;
        *greatest = (x.select_lt(greatest.0, x, greatest.0), x.select_lt(greatest.0, place, greatest.1));
    }

    /// The minimum and the maximum over all lanes.
    #[inline(always)]
    pub fn ends(&self) -> [f64; 2] {
        let [least, greatest] = &self.0;
        let (mut low, mut high) = (f64::INFINITY, f64::INFINITY);
        for k in 0..LANES {
            (low, high) = (low.min(least.0[k]), high.min(greatest.0[k]));
        }
        [low, -high]
    }

    /// Minimum and maximum with their places, for a map of this `width` with `chunks` columns in a row.
    #[inline(always)]
    pub fn places(&self, chunks: usize, width: usize) -> Extrema {
        let mut ends = [(f64::INFINITY, 0, 0); 2];
        for (end, (value, place)) in ends.iter_mut().zip(&self.0) {
            let mut order = usize::MAX;
            for k in 0..LANES {
                let (row, chunk) = (place[k] as usize / chunks.max(1), place[k] as usize % chunks.max(1));
                let body = chunk * LANES + k;
                if value[k] < end.0 || (value[k] == end.0 && row * width + body < order) {
                    (*end, order) = ((value[k], row, body), row * width + body);
                }
            }
        }
        if ends[0].0 == f64::INFINITY {
            return None;
        }
        ends[1].0 = -ends[1].0;
        Some(ends)
    }
}

/// The minimum and the maximum of numbers given one after the other; the first of equal ones counts, a NaN is ignored.
#[derive(Debug, Default)]
pub(super) struct Ends(Extrema);

impl Ends {
    pub fn keep(&mut self, x: f64, row: usize, body: usize) {
        let nowhere = [(f64::INFINITY, 0, 0), (f64::NEG_INFINITY, 0, 0)];
        let [low, high] = self.0.get_or_insert(nowhere);
        if x < low.0 {
            *low = (x, row, body);
        }
        if x > high.0 {
            *high = (x, row, body);
        }
    }

    /// Minimum and maximum, if any number was given.
    pub fn found(self) -> Extrema {
        self.0.filter(|[low, _]| low.0 < f64::INFINITY)
    }
}
