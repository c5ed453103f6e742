//! A part of a map with its arrays in double or in single precision. The precision matters only where numbers
//! are stored, so that the computation is compiled once for both, apart from the rate of a sharp rim.

use super::Portrait;
use crate::many::columns::Split;
use crate::numbers::Narrow;
use crate::numbers::side_by_side::MOST;
use crate::states::stability::{SteadyPoint, Wanted};

/// An output array in double or in single precision.
#[derive(Debug)]
#[non_exhaustive]
pub enum Slot<'a> {
    Double(&'a mut [f64]),
    Single(&'a mut [f32]),
}

impl Split for Slot<'_> {
    fn split(self, count: usize) -> (Self, Self) {
        match self {
            Self::Double(x) => {
                let (first, rest) = x.split(count);
                (Self::Double(first), Self::Double(rest))
            }
            Self::Single(x) => {
                let (first, rest) = x.split(count);
                (Self::Single(first), Self::Single(rest))
            }
        }
    }
}

impl Slot<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Double(x) => x.len(),
            Self::Single(x) => x.len(),
        }
    }

    /// Stores the first `count` SIMD lanes at `start`; with `gaps` only the lanes that are not NaN.
    #[inline(always)]
    pub(super) fn store<T: Narrow>(&mut self, start: usize, count: usize, x: T, gaps: bool) {
        match self {
            Self::Double(out) => {
                let out = &mut out[start..start + count];
                if !gaps && count == T::COUNT {
                    x.spill(out)
                } else {
                    put_lanes(out, x, gaps, |x| !x.is_nan(), |x| x)
                }
            }
            Self::Single(out) => {
                let out = &mut out[start..start + count];
                if !gaps && count == T::COUNT {
                    T::spill_single(x.single(), out);
                } else {
                    put_lanes(out, x, gaps, |x| !x.is_nan(), |x| x as f32);
                }
            }
        }
    }
}

/// An optional array, of which a part can be borrowed.
trait Part {
    fn part(&mut self, from: usize, count: usize) -> Option<Slot<'_>>;
}

impl Part for Option<Slot<'_>> {
    #[inline(always)]
    fn part(&mut self, from: usize, count: usize) -> Option<Slot<'_>> {
        match self {
            Some(Slot::Double(x)) => Some(Slot::Double(&mut x[from..from + count])),
            Some(Slot::Single(x)) => Some(Slot::Single(&mut x[from..from + count])),
            None => None,
        }
    }
}

/// Stores the SIMD lanes that fit; with `gaps` only those for which `known` is true.
#[inline(always)]
fn put_lanes<T: Narrow, F>(
    out: &mut [F],
    x: T,
    gaps: bool,
    known: impl Fn(f64) -> bool,
    rounded: impl Fn(f64) -> F,
) {
    let mut lanes = [0.0; MOST];
    x.spill(&mut lanes);
    let pairs = out.iter_mut().zip(&lanes[..T::COUNT]);
    if gaps {
        pairs.filter(|(_, x)| known(**x)).for_each(|(slot, x)| *slot = rounded(*x));
    } else {
        pairs.for_each(|(slot, x)| *slot = rounded(*x));
    }
}

/// The arrays for some points of a [`Portrait`]: `numbers` holds rate, kappa in rolling, kappa on a smooth table, and energy.
#[derive(Debug)]
pub(crate) struct Block<'a> {
    pub(super) numbers: [Option<Slot<'a>>; 4],
    region: Option<&'a mut [u8]>,
}

impl Split for Block<'_> {
    fn split(self, points: usize) -> (Self, Self) {
        let (numbers, later) = self.numbers.split(points);
        let (region, later_region) = self.region.split(points);
        (Self { numbers, region }, Self { numbers: later, region: later_region })
    }
}

impl<'a> Block<'a> {
    pub(super) fn of<F: super::Cell>(out: Portrait<'a, F>) -> Self {
        let numbers = [out.rate, out.kappa_rolling, out.kappa_smooth, out.energy].map(|x| x.map(F::slot));
        Self { numbers, region: out.region }
    }

    pub(super) fn fits(&self, points: usize) -> bool {
        self.numbers.iter().flatten().all(|x| x.len() == points)
            && self.region.iter().all(|x| x.len() == points)
    }

    /// The arrays of the `count` points from the index `from` on.
    #[inline(always)]
    pub(super) fn part(&mut self, from: usize, count: usize) -> Block<'_> {
        let [a, b, c, d] = &mut self.numbers;
        let numbers = [a.part(from, count), b.part(from, count), c.part(from, count), d.part(from, count)];
        let region = self.region.as_mut().map(|x| &mut x[from..from + count]);
        Block { numbers, region }
    }

    /// Whether only the rate is requested.
    pub(super) fn is_rate(&self) -> bool {
        matches!(&self.numbers, [Some(_), None, None, None]) && self.region.is_none()
    }

    #[inline(always)]
    pub(super) fn wanted(&self) -> Wanted {
        let [rate, rolling, smooth, energy] = self.numbers.each_ref().map(Option::is_some);
        let single = matches!(self.numbers[0], Some(Slot::Single(_)));
        Wanted { rate, squared: false, single, rolling, smooth, energy, region: self.region.is_some() }
    }

    /// Stores the first `count` points at `start`; with `gaps` only the quantities that are not NaN.
    #[inline(always)]
    pub(super) fn put<T: Narrow>(&mut self, start: usize, count: usize, found: &SteadyPoint<T>, gaps: bool) {
        let [rate, rolling, smooth, energy] = &mut self.numbers;
        if let Some(out) = rate {
            out.store(start, count, found.rate, gaps);
        }
        if let Some(out) = energy {
            out.store(start, count, found.energy, gaps);
        }
        if let Some(out) = rolling {
            out.store(start, count, found.rolling, gaps);
        }
        if let Some(out) = smooth {
            out.store(start, count, found.smooth, gaps);
        }
        if let Some(out) = &mut self.region {
            // In the lane of a body with the other kind of rim the code is 0, `Region::Invalid`.
            put_lanes(
                &mut out[start..start + count],
                found.region,
                gaps,
                |code| code > 0.0,
                |code| code as u8,
            );
        }
    }
}
