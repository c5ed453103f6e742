//! Maps of the rate alone, which needs three numbers of a body on a sharp rim.

use super::best::{Best, Ends, Extrema};
use super::block::Slot;
use super::{load, near, wide_of};
use crate::body::{Body, Wall, tube_or_nan};
use crate::number::{LANES, Pair, Short, Sum, in_lanes};
use crate::steady::{
    TINY, may_pass, may_pass_between, quick_angle, rare_rate, rate_lanes, single_rate, square_lanes, widened,
};
use core::f64::consts::FRAC_PI_2;
use fearless_simd::{Level, Simd, SimdBase, f32x16, f64x8};

/// The numbers of eight bodies that enter the rate: ell, and the inertia excess as a sum.
pub(crate) struct Lean {
    ell: [f64; LANES],
    excess: Sum<[f64; LANES]>,
}

impl Lean {
    /// The numbers of at most eight bodies; a lane without a body, or with one that is not plain, is NaN.
    pub fn gather(bodies: &[Option<Body>]) -> Self {
        let none = [f64::NAN; LANES];
        let mut all = Self { ell: none, excess: Sum { hi: none, lo: none } };
        for (i, body) in bodies.iter().take(LANES).enumerate() {
            if let Some(body) = body.as_ref().filter(|body| body.is_plain()) {
                let excess = body.excess_sum();
                (all.ell[i], all.excess.hi[i], all.excess.lo[i]) = (body.ell(), excess.hi, excess.lo);
            }
        }
        all
    }

    fn lane(&self, k: usize) -> (f64, Sum<f64>) {
        (self.ell[k], Sum { hi: self.excess.hi[k], lo: self.excess.lo[k] })
    }

    #[inline(always)]
    fn load<S: Simd>(&self, simd: S) -> (f64x8<S>, Sum<f64x8<S>>) {
        let (hi, lo) = (f64x8::from_slice(simd, &self.excess.hi), f64x8::from_slice(simd, &self.excess.lo));
        (f64x8::from_slice(simd, &self.ell), Sum { hi, lo })
    }

    #[inline(always)]
    fn rate<S: Simd>(&self, simd: S, theta: f64x8<S>, angle: &Short<f64x8<S>>) -> f64x8<S> {
        let (ell, excess) = self.load(simd);
        rate_lanes(theta, angle, ell, excess)
    }
}

/// The rate of sixteen bodies in single precision.
#[inline(always)]
fn single_of<S: Simd>(
    simd: S,
    theta: Pair<f64x8<S>>,
    angle: &Short<Pair<f64x8<S>>>,
    of: [&Lean; 2],
) -> f32x16<S> {
    let [one, other] = of;
    let (ell, excess) = (both(simd, [&one.ell, &other.ell]), both(simd, [&one.excess.hi, &other.excess.hi]));
    single_rate(
        angle,
        ell,
        excess,
        // The low part of the excess is loaded here, because only this closure needs it.
        #[inline(always)]
        || {
            let lo = both(simd, [&one.excess.lo, &other.excess.lo]);
            rare_rate(theta, ell, Sum { hi: excess, lo })
        },
    )
}

#[inline(always)]
fn both<S: Simd>(simd: S, [one, other]: [&[f64; LANES]; 2]) -> Pair<f64x8<S>> {
    Pair(f64x8::from_slice(simd, one), f64x8::from_slice(simd, other))
}

/// Fills some rows of a map with the rate.
pub(super) fn rows_at(
    level: Option<Level>,
    theta: &[f64],
    columns: &[Lean],
    width: usize,
    out: &mut Slot<'_>,
) {
    in_lanes!(level, simd => rows(simd, theta, columns, width, out), else rows_alone(theta, columns, width, out));
}

/// Fills some rows of a map point by point, without SIMD lanes.
fn rows_alone(theta: &[f64], columns: &[Lean], width: usize, out: &mut Slot<'_>) {
    for (row, &theta) in theta.iter().enumerate() {
        let angle = quick_angle(theta);
        for i in 0..width {
            let (ell, excess) = columns[i / LANES].lane(i % LANES);
            let at = row * width + i;
            match out {
                Slot::Double(out) => out[at] = rate_lanes(theta, &angle, ell, excess),
                Slot::Single(out) => {
                    out[at] = single_rate(&angle, ell, excess.hi, || rare_rate(theta, ell, excess));
                }
            }
        }
    }
}

#[inline(always)]
fn rows<S: Simd>(simd: S, theta: &[f64], columns: &[Lean], width: usize, out: &mut Slot<'_>) {
    for (from, columns) in near(columns) {
        let part = from..(from + columns.len() * LANES).min(width);
        for (row, &theta) in theta.iter().enumerate() {
            let theta = wide_of(simd, theta);
            let angle = quick_angle(theta);
            let part = row * width + part.start..row * width + part.end;
            match out {
                Slot::Double(out) => {
                    let (whole, rest) = out[part].as_chunks_mut::<LANES>();
                    let (full, last) = columns.split_at(whole.len());
                    for (column, out) in full.iter().zip(whole) {
                        *out = *column.rate(simd, theta, &angle);
                    }
                    if !rest.is_empty() {
                        rest.copy_from_slice(&last[0].rate(simd, theta, &angle).as_slice()[..rest.len()]);
                    }
                }
                Slot::Single(out) => {
                    // Two columns of doubles fill one vector of single numbers.
                    let (theta, angle) = (Pair(theta, theta), quick_angle(Pair(theta, theta)));
                    let (whole, rest) = out[part].as_chunks_mut::<{ 2 * LANES }>();
                    let (full, last) = columns.split_at(2 * whole.len());
                    for ([one, other], out) in full.as_chunks().0.iter().zip(whole) {
                        *out = *single_of(simd, theta, &angle, [one, other]);
                    }
                    if let [one, ..] = last {
                        let found = single_of(simd, theta, &angle, [one, &last[last.len() - 1]]);
                        rest.copy_from_slice(&found.as_slice()[..rest.len()]);
                    }
                }
            }
        }
    }
}

/// The minimum and the maximum of the squared rate in some rows of a map. Points that can be neither are excluded
/// without a division, and many rows at once.
pub(super) fn extremes_at(level: Option<Level>, theta: &[f64], columns: &[Lean], width: usize) -> Extrema {
    in_lanes!(
        level,
        simd => extremes(simd, theta, columns, width),
        else {
            let mut ends = Ends::default();
            for (row, &theta) in theta.iter().enumerate() {
                let angle = quick_angle(theta);
                for i in 0..width {
                    let (ell, excess) = columns[i / LANES].lane(i % LANES);
                    ends.keep(square_lanes(theta, &angle, ell, excess), row, i);
                }
            }
            ends.found()
        }
    )
}

/// Number of rows that are examined together; all are skipped if no inclination between their ends can be extreme.
const RUN: usize = 16;

#[inline(always)]
fn extremes<S: Simd>(simd: S, theta: &[f64], columns: &[Lean], width: usize) -> Extrema {
    let mut best = Best::nothing(simd);
    let mut bounds = [wide_of(simd, f64::INFINITY), wide_of(simd, f64::NEG_INFINITY)];
    let mut passing = Vec::with_capacity(columns.len());
    // The first row has no bounds yet; its extrema are the first bounds for the other rows.
    let (first, rest) = theta.split_at(theta.len().min(1));
    let runs = rest.chunks(RUN).scan(1, |row, run| Some((core::mem::replace(row, *row + run.len()), run)));
    for (before, run) in core::iter::once((0, first)).chain(runs) {
        let (low, high) =
            run.iter().fold((f64::INFINITY, 0f64), |(low, high), x| (low.min(*x), high.max(*x)));
        let inside = run.len() > 1 && TINY < low && high <= FRAC_PI_2;
        let ends = [quick_angle(wide_of(simd, low)), quick_angle(wide_of(simd, high))];
        passing.clear();
        for (chunk, column) in columns.iter().enumerate() {
            let (ell, excess) = column.load(simd);
            if !inside || may_pass_between([&ends[0], &ends[1]], ell, excess.hi, bounds) {
                passing.push(chunk);
            }
        }
        for (row, &theta) in (before..).zip(run) {
            let theta = wide_of(simd, theta);
            let angle = quick_angle(theta);
            for &chunk in &passing {
                let (ell, excess) = columns[chunk].load(simd);
                if may_pass(&angle, ell, excess.hi, bounds) {
                    let square = square_lanes(theta, &angle, ell, excess);
                    best.keep(square, (row * columns.len() + chunk) as f64);
                    let [least, greatest] = widened(best.ends());
                    bounds = [wide_of(simd, least), wide_of(simd, greatest)];
                }
            }
        }
    }
    best.places(columns.len(), width)
}

/// Fills scattered points with theta, ell and bore, each of which may be a single number.
#[inline(always)]
pub(super) fn scatter<S: Simd>(simd: S, columns: [&[f64]; 3], count: usize, out: &mut Slot<'_>) {
    let [theta, ell, bore] = columns;
    if let Slot::Single(out) = out {
        return scatter_single(simd, columns, out);
    }
    // Whole groups of bodies with one bore share its division; groups of one body share the whole excess.
    let begun = match out {
        Slot::Double(out) if bore.len() == 1 && theta.len() == count => {
            let (out, bore) = (out.as_chunks_mut::<LANES>().0, wide_of(simd, bore[0]));
            let wall = Wall::of(bore);
            let both = groups(theta).iter().zip(&mut *out);
            if ell.len() == 1 {
                let ell = wide_of(simd, ell[0]);
                let (ell, excess) = (tube_or_nan(ell, bore), wall.excess(ell));
                for (theta, out) in both {
                    let theta = f64x8::from_slice(simd, theta);
                    *out = *rate_lanes(theta, &quick_angle(theta), ell, excess);
                }
            } else {
                for ((theta, out), ell) in both.zip(groups(ell)) {
                    let (theta, ell) = (f64x8::from_slice(simd, theta), f64x8::from_slice(simd, ell));
                    *out = *rate_lanes(theta, &quick_angle(theta), tube_or_nan(ell, bore), wall.excess(ell));
                }
            }
            LANES * out.len()
        }
        _ => 0,
    };
    for start in (begun..count).step_by(LANES) {
        let [theta, ell, bore] = columns.map(|x| load(simd, x, start));
        let excess = Wall::of(bore).excess(ell);
        let rate = rate_lanes(theta, &quick_angle(theta), tube_or_nan(ell, bore), excess);
        out.store(start, LANES.min(count - start), rate, false);
    }
}

/// Fills scattered points in single precision, sixteen at a time.
#[inline(always)]
fn scatter_single<S: Simd>(simd: S, [theta, ell, bore]: [&[f64]; 3], out: &mut [f32]) {
    let wall = Wall::of(load_pair(simd, bore, 0));
    for (start, out) in (0..).step_by(2 * LANES).zip(out.chunks_mut(2 * LANES)) {
        let theta = load_pair(simd, theta, start);
        let (ell, here) = (load_pair(simd, ell, start), load_pair(simd, bore, start));
        let excess = if bore.len() == 1 { wall.excess(ell) } else { Wall::of(here).excess(ell) };
        let ell = tube_or_nan(ell, here);
        let rate = single_rate(&quick_angle(theta), ell, excess.hi, || rare_rate(theta, ell, excess));
        match out.first_chunk_mut() {
            Some(out) => *out = *rate,
            None => out.copy_from_slice(&rate.as_slice()[..out.len()]),
        }
    }
}

/// Sixteen numbers of `x` from `start` on, NaN beyond its end; if `x` has one number, that number in all lanes.
#[inline(always)]
fn load_pair<S: Simd>(simd: S, x: &[f64], start: usize) -> Pair<f64x8<S>> {
    Pair(load(simd, x, start), load(simd, x, x.len().min(start + LANES)))
}

/// The numbers in groups of eight, without an incomplete last group.
fn groups(x: &[f64]) -> &[[f64; LANES]] {
    x.as_chunks().0
}
