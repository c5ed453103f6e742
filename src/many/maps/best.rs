//! The minimum and the maximum of many numbers, with their places.

use crate::numbers::side_by_side::SideBySide;

/// A quantity of a map whose extrema [`extrema`](super::extrema) finds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum MapQuantity {
    /// The square of the reduced rotation rate.
    SquaredRate,
    /// Squared nutation frequency in rolling, in g/R.
    KappaRolling,
    /// Squared nutation frequency on a smooth table, in g/R.
    KappaSmooth,
    /// Energy of the steady state, in M g R.
    Energy,
}

/// A value of a map and its place.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MapPoint {
    /// The value of the quantity at the point.
    pub value: f64,
    /// Index of the inclination of the point.
    pub theta: usize,
    /// Index of the body of the point.
    pub body: usize,
}

/// Minimum and maximum of a quantity of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Extrema {
    /// The least value of the quantity, with its place.
    pub least: MapPoint,
    /// The greatest value of the quantity, with its place.
    pub greatest: MapPoint,
}

/// The extrema of the quantities of a map, from [`extrema`](super::extrema).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapExtrema(pub(super) [Ends; 4]);

impl MapExtrema {
    /// The extrema of a quantity; None if it was not requested, or if the map has no steady state.
    pub fn of(&self, quantity: MapQuantity) -> Option<Extrema> {
        let at = |(value, theta, body)| MapPoint { value, theta, body };
        self.0[quantity as usize]
            .map(|[least, greatest]| Extrema { least: at(least), greatest: at(greatest) })
    }
}

/// Minimum and maximum of a quantity of a map, each as (value, index of the inclination, index of the body); None if
/// the map has no steady state.
pub(crate) type Ends = Option<[(f64, usize, usize); 2]>;

/// The minimum of x and of -x in each SIMD lane, each with its place: the index of the group of lanes, counted row by
/// row.
#[derive(Clone, Copy)]
pub(super) struct ExtremaInLanes<T>([(T, T); 2]);

impl<T: SideBySide> ExtremaInLanes<T> {
    #[inline(always)]
    pub fn nothing(like: T) -> Self {
        Self([(like.splat(f64::INFINITY), like.splat(0.0)); 2])
    }

    /// Compares the number in each SIMD lane with the extrema so far; a NaN is ignored.
    #[inline(always)]
    pub fn include(&mut self, x: T, place: f64) {
        let place = x.splat(place);
        let [least, greatest] = &mut self.0;
        *least = (x.select_lt(least.0, x, least.0), x.select_lt(least.0, place, least.1));
        let x = -x;
        *greatest = (x.select_lt(greatest.0, x, greatest.0), x.select_lt(greatest.0, place, greatest.1));
    }

    /// The minimum and the maximum over all SIMD lanes.
    #[inline(always)]
    pub fn ends(&self) -> [f64; 2] {
        let [least, greatest] = &self.0;
        let (mut low, mut high) = (f64::INFINITY, f64::INFINITY);
        for k in 0..T::COUNT {
            (low, high) = (low.min(least.0.lane(k)), high.min(greatest.0.lane(k)));
        }
        [low, -high]
    }

    /// Minimum and maximum with their places, for a map with `width` bodies in `chunks` groups of lanes in a row.
    #[inline(always)]
    pub fn places(&self, chunks: usize, width: usize) -> Ends {
        let mut ends = [(f64::INFINITY, 0, 0); 2];
        for (end, (value, place)) in ends.iter_mut().zip(&self.0) {
            let mut order = usize::MAX;
            for k in 0..T::COUNT {
                let (value, place) = (value.lane(k), place.lane(k) as usize);
                let (row, chunk) = (place / chunks.max(1), place % chunks.max(1));
                let body = chunk * T::COUNT + k;
                if value < end.0 || (value == end.0 && row * width + body < order) {
                    (*end, order) = ((value, row, body), row * width + body);
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
