//! A part of a map with its arrays of doubles or of single numbers. The kind is decided where numbers are stored, so
//! that the computation is compiled once for both kinds, apart from the rate of a sharp rim.

use super::Portrait;
use crate::number::{LANES, Narrow};
use crate::stability::{SteadyPoint, Wanted};
use fearless_simd::{Simd, f64x8};

/// An array of doubles or of single numbers.
#[derive(Debug)]
pub enum Slot<'a> {
    Double(&'a mut [f64]),
    Single(&'a mut [f32]),
}

impl<'a> Slot<'a> {
    fn len(&self) -> usize {
        match self {
            Self::Double(x) => x.len(),
            Self::Single(x) => x.len(),
        }
    }

    fn split_at(self, at: usize) -> (Self, Self) {
        match self {
            Self::Double(x) => {
                let (first, rest) = x.split_at_mut(at);
                (Self::Double(first), Self::Double(rest))
            }
            Self::Single(x) => {
                let (first, rest) = x.split_at_mut(at);
                (Self::Single(first), Self::Single(rest))
            }
        }
    }

    /// Stores the first `count` lanes at `start`; with `gaps` only the lanes that are not NaN.
    #[inline(always)]
    pub(super) fn store<S: Simd>(&mut self, start: usize, count: usize, x: f64x8<S>, gaps: bool) {
        match self {
            Self::Double(out) => {
                let out = &mut out[start..start + count];
                match out.first_chunk_mut::<LANES>() {
                    Some(out) if !gaps => *out = *x,
                    _ => put(out, *x, gaps, |x| x),
                }
            }
            Self::Single(out) => {
                let out = &mut out[start..start + count];
                match out.first_chunk_mut::<LANES>() {
                    Some(out) if !gaps => *out = *x.single(),
                    _ => put(out, *x, gaps, |x| x as f32),
                }
            }
        }
    }
}

impl Slot<'_> {
    /// Stores one number; with `gaps` only if it is not NaN.
    pub(super) fn put_one(&mut self, at: usize, x: f64, gaps: bool) {
        if gaps && x.is_nan() {
            return;
        }
        match self {
            Self::Double(out) => out[at] = x,
            Self::Single(out) => out[at] = x as f32,
        }
    }
}

/// An optional slot, of which a part can be borrowed.
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

/// Stores the lanes that fit; with `gaps` only the lanes that are not NaN.
#[inline(always)]
fn put<F>(out: &mut [F], x: [f64; LANES], gaps: bool, rounded: impl Fn(f64) -> F) {
    for (slot, x) in out.iter_mut().zip(x) {
        if !gaps || !x.is_nan() {
            *slot = rounded(x);
        }
    }
}

/// Some points of a [`Portrait`]: `numbers` holds rate, rolling kappa, smooth kappa and energy.
#[derive(Debug)]
pub(crate) struct Block<'a> {
    pub(super) numbers: [Option<Slot<'a>>; 4],
    region: Option<&'a mut [u8]>,
}

impl<'a> Block<'a> {
    pub(super) fn of<F: super::Cell>(out: Portrait<'a, F>) -> Self {
        let numbers = [out.rate, out.kappa_rolling, out.kappa_smooth, out.energy].map(|x| x.map(F::slot));
        Self { numbers, region: out.region }
    }

    /// The first `points` of each array, and the rest.
    pub(super) fn split(self, points: usize) -> (Self, Self) {
        let (mut first, mut rest) = ([const { None }; 4], [const { None }; 4]);
        for ((first, rest), x) in first.iter_mut().zip(&mut rest).zip(self.numbers) {
            (*first, *rest) = x.map(|x| x.split_at(points)).unzip();
        }
        let (region, later) = self.region.map(|x| x.split_at_mut(points)).unzip();
        (Self { numbers: first, region }, Self { numbers: rest, region: later })
    }

    pub(super) fn fits(&self, points: usize) -> bool {
        self.numbers.iter().flatten().all(|x| x.len() == points)
            && self.region.iter().all(|x| x.len() == points)
    }

    /// The part with `count` points from `from` on.
    #[inline(always)]
    pub(super) fn part(&mut self, from: usize, count: usize) -> Block<'_> {
        let [a, b, c, d] = &mut self.numbers;
        let numbers = [a.part(from, count), b.part(from, count), c.part(from, count), d.part(from, count)];
        let region = self.region.as_mut().map(|x| &mut x[from..from + count]);
        Block { numbers, region }
    }

    /// Whether only the rate is wanted.
    pub(super) fn is_rate(&self) -> bool {
        matches!(&self.numbers, [Some(_), None, None, None]) && self.region.is_none()
    }

    /// The quantities that are wanted at each point.
    #[inline(always)]
    pub(super) fn wanted(&self) -> Wanted {
        let [rate, rolling, smooth, energy] = self.numbers.each_ref().map(Option::is_some);
        let single = matches!(self.numbers[0], Some(Slot::Single(_)));
        Wanted { rate, squared: false, single, rolling, smooth, energy, region: self.region.is_some() }
    }

    /// Stores the first `count` of eight points at `start`; with `gaps` only the quantities that are known.
    #[inline(always)]
    pub(super) fn put<S: Simd>(
        &mut self,
        start: usize,
        count: usize,
        found: &SteadyPoint<f64x8<S>>,
        gaps: bool,
    ) {
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
            if gaps {
                // A body of the other kind of rim has the code 0, `Region::Invalid`.
                let known = out[start..].iter_mut().zip(*found.region).filter(|(_, code)| *code > 0.0);
                known.for_each(|(slot, code)| *slot = code as u8);
            } else {
                for (slot, code) in out[start..].iter_mut().zip(*found.region) {
                    *slot = code as u8;
                }
            }
        }
    }
    /// Stores one point; with `gaps` only the quantities that are known.
    pub(super) fn put_one(&mut self, at: usize, found: &SteadyPoint<f64>, gaps: bool) {
        let known = [found.rate, found.rolling, found.smooth, found.energy];
        for (slot, x) in self.numbers.iter_mut().zip(known) {
            if let Some(out) = slot {
                out.put_one(at, x, gaps);
            }
        }
        if let Some(out) = &mut self.region
            && (!gaps || found.region > 0.0)
        {
            out[at] = found.region as u8;
        }
    }
}
