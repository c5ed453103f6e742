//! Maps of the rate alone, for which a body on a sharp rim is given by three numbers.

use super::best::{Ends, ExtremaInLanes};
use super::block::Slot;
use super::groups_in_cache;
use crate::laws::body::{Body, Wall, tube_or_nan};
use crate::numbers::side_by_side::{SideBySide, load, zero};
use crate::numbers::{LANES, Pair, Real, Short, Sum, in_lanes};
use crate::states::steady::{
    TINY, bounds_beyond_error, may_exceed, may_exceed_between, quick_angle, rare_rate, rate_lanes,
    single_rate, square_lanes,
};
use core::f64::consts::FRAC_PI_2;
use fearless_simd::{Level, Simd, SimdBase, f32x16, f64x8};

/// The message of an unreachable branch: without SIMD lanes there are no columns for the rate alone.
const LANES_ARE_NEEDED: &str = "columns of the rate need lanes";

/// The numbers of eight bodies that enter the rate: ell, and the inertia excess as a sum.
pub(crate) struct RateNumbers {
    ell: [f64; LANES],
    excess: Sum<[f64; LANES]>,
}

impl RateNumbers {
    /// The numbers of at most eight bodies; NaN in a SIMD lane without a body, or with one that is not a plain body on
    /// a sharp rim.
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

    #[inline(always)]
    fn load<S: Simd>(&self, like: f64x8<S>) -> (f64x8<S>, Sum<f64x8<S>>) {
        let (hi, lo) = (like.load(&self.excess.hi), like.load(&self.excess.lo));
        (like.load(&self.ell), Sum { hi, lo })
    }

    #[inline(always)]
    fn rate<S: Simd>(&self, like: f64x8<S>, theta: f64x8<S>, angle: &Short<f64x8<S>>) -> f64x8<S> {
        let (ell, excess) = self.load(like);
        rate_lanes(theta, angle, ell, excess)
    }
}

/// The rate of sixteen bodies in single precision.
#[inline(always)]
fn single_of<S: Simd>(
    like: f64x8<S>,
    theta: Pair<f64x8<S>>,
    angle: &Short<Pair<f64x8<S>>>,
    of: [&RateNumbers; 2],
) -> f32x16<S> {
    let [one, other] = of;
    let (ell, excess) =
        (pair_of(like, [&one.ell, &other.ell]), pair_of(like, [&one.excess.hi, &other.excess.hi]));
    single_rate(
        angle,
        ell,
        excess,
        // The low part of the excess is loaded here, because only this closure needs it.
        #[inline(always)]
        || {
            let lo = pair_of(like, [&one.excess.lo, &other.excess.lo]);
            rare_rate(theta, ell, Sum { hi: excess, lo })
        },
    )
}

#[inline(always)]
fn pair_of<S: Simd>(like: f64x8<S>, [one, other]: [&[f64; LANES]; 2]) -> Pair<f64x8<S>> {
    Pair(like.load(one), like.load(other))
}

pub(super) fn rows_at(
    level: Option<Level>,
    theta: &[f64],
    columns: &[RateNumbers],
    width: usize,
    out: &mut Slot<'_>,
) {
    in_lanes!(level, simd => rate_rows(zero(simd), theta, columns, width, out), else unreachable!("{LANES_ARE_NEEDED}"));
}

#[inline(always)]
fn rate_rows<S: Simd>(
    like: f64x8<S>,
    theta: &[f64],
    columns: &[RateNumbers],
    width: usize,
    out: &mut Slot<'_>,
) {
    for (from, columns) in groups_in_cache(columns) {
        let part = from..(from + columns.len() * LANES).min(width);
        for (row, &theta) in theta.iter().enumerate() {
            let theta = like.splat(theta);
            let angle = quick_angle(theta);
            let part = row * width + part.start..row * width + part.end;
            match out {
                Slot::Double(out) => {
                    let (whole, rest) = out[part].as_chunks_mut::<LANES>();
                    let (full, last) = columns.split_at(whole.len());
                    for (column, out) in full.iter().zip(whole) {
                        *out = *column.rate(like, theta, &angle);
                    }
                    if !rest.is_empty() {
                        rest.copy_from_slice(&last[0].rate(like, theta, &angle).as_slice()[..rest.len()]);
                    }
                }
                Slot::Single(out) => {
                    // Two columns of doubles fill one vector of single-precision numbers.
                    let (theta, angle) = (Pair(theta, theta), quick_angle(Pair(theta, theta)));
                    let (whole, rest) = out[part].as_chunks_mut::<{ 2 * LANES }>();
                    let (full, last) = columns.split_at(2 * whole.len());
                    for ([one, other], out) in full.as_chunks().0.iter().zip(whole) {
                        *out = *single_of(like, theta, &angle, [one, other]);
                    }
                    if let [one, ..] = last {
                        let found = single_of(like, theta, &angle, [one, &last[last.len() - 1]]);
                        rest.copy_from_slice(&found.as_slice()[..rest.len()]);
                    }
                }
            }
        }
    }
}

/// The minimum and the maximum of the squared rate in some rows of a map. Points that can be neither are excluded for
/// many rows at once, without a division.
pub(super) fn extremes_at(
    level: Option<Level>,
    theta: &[f64],
    columns: &[RateNumbers],
    width: usize,
) -> Ends {
    in_lanes!(level, simd => rate_extremes(zero(simd), theta, columns, width), else unreachable!("{LANES_ARE_NEEDED}"))
}

/// Number of rows whose columns are examined together: a column is skipped if no inclination between the
/// first and the last row can be extreme.
const ROWS_PER_RUN: usize = 16;

#[inline(always)]
fn rate_extremes<S: Simd>(like: f64x8<S>, theta: &[f64], columns: &[RateNumbers], width: usize) -> Ends {
    let mut best = ExtremaInLanes::nothing(like);
    let mut bounds = [like.splat(f64::INFINITY), like.splat(f64::NEG_INFINITY)];
    let mut passing = Vec::with_capacity(columns.len());
    // The first row has no bounds yet; its extrema are the first bounds for the other rows.
    let (first, rest) = theta.split_at(theta.len().min(1));
    let runs =
        rest.chunks(ROWS_PER_RUN).scan(1, |row, run| Some((core::mem::replace(row, *row + run.len()), run)));
    for (before, run) in core::iter::once((0, first)).chain(runs) {
        let (low, high) =
            run.iter().fold((f64::INFINITY, 0f64), |(low, high), x| (low.min(*x), high.max(*x)));
        let inside = run.len() > 1 && TINY < low && high <= FRAC_PI_2;
        let ends = [quick_angle(like.splat(low)), quick_angle(like.splat(high))];
        passing.clear();
        for (chunk, column) in columns.iter().enumerate() {
            let (ell, excess) = column.load(like);
            if !inside || may_exceed_between([&ends[0], &ends[1]], ell, excess.hi, bounds) {
                passing.push(chunk);
            }
        }
        for (row, &theta) in (before..).zip(run) {
            let theta = like.splat(theta);
            let angle = quick_angle(theta);
            for &chunk in &passing {
                let (ell, excess) = columns[chunk].load(like);
                if may_exceed(&angle, ell, excess.hi, bounds) {
                    let square = square_lanes(theta, &angle, ell, excess);
                    best.include(square, (row * columns.len() + chunk) as f64);
                    let [least, greatest] = bounds_beyond_error(best.ends());
                    bounds = [like.splat(least), like.splat(greatest)];
                }
            }
        }
    }
    best.places(columns.len(), width)
}

/// Fills the rates of scattered points from columns of theta, ell and bore, each of which may be a single number.
#[inline(always)]
pub(super) fn scatter<S: Simd>(like: f64x8<S>, columns: [&[f64]; 3], count: usize, out: &mut Slot<'_>) {
    let [theta, ell, bore] = columns;
    if let Slot::Single(out) = out {
        return scatter_single(Pair(like, like), columns, out);
    }
    // Groups of eight points with one bore share the division in their moments; with one body they share the
    // whole excess.
    let begun = match out {
        Slot::Double(out) if bore.len() == 1 && theta.len() == count => {
            let (out, bore) = (out.as_chunks_mut::<LANES>().0, like.splat(bore[0]));
            let wall = Wall::of(bore);
            let both = groups_of_eight(theta).iter().zip(&mut *out);
            if ell.len() == 1 {
                let ell = like.splat(ell[0]);
                let (ell, excess) = (tube_or_nan(ell, bore), wall.excess(ell));
                for (theta, out) in both {
                    let theta = like.load(theta);
                    *out = *rate_lanes(theta, &quick_angle(theta), ell, excess);
                }
            } else {
                for ((theta, out), ell) in both.zip(groups_of_eight(ell)) {
                    let (theta, ell) = (like.load(theta), like.load(ell));
                    *out = *rate_lanes(theta, &quick_angle(theta), tube_or_nan(ell, bore), wall.excess(ell));
                }
            }
            LANES * out.len()
        }
        _ => 0,
    };
    for start in (begun..count).step_by(LANES) {
        let [theta, ell, bore] = columns.map(|x| load(like, x, start));
        let excess = Wall::of(bore).excess(ell);
        let rate = rate_lanes(theta, &quick_angle(theta), tube_or_nan(ell, bore), excess);
        out.store(start, LANES.min(count - start), rate, false);
    }
}

/// Fills the rates of scattered points in single precision, sixteen at a time.
#[inline(always)]
fn scatter_single<S: Simd>(pair: Pair<f64x8<S>>, [theta, ell, bore]: [&[f64]; 3], out: &mut [f32]) {
    let wall = Wall::of(load(pair, bore, 0));
    for (start, out) in (0..).step_by(2 * LANES).zip(out.chunks_mut(2 * LANES)) {
        let theta = load(pair, theta, start);
        let (ell, here) = (load(pair, ell, start), load(pair, bore, start));
        let excess = if bore.len() == 1 { wall.excess(ell) } else { Wall::of(here).excess(ell) };
        let ell = tube_or_nan(ell, here);
        let rate = single_rate(&quick_angle(theta), ell, excess.hi, || rare_rate(theta, ell, excess));
        match out.first_chunk_mut() {
            Some(out) => *out = *rate,
            None => out.copy_from_slice(&rate.as_slice()[..out.len()]),
        }
    }
}

/// The numbers in groups of eight; an incomplete last group is left out.
fn groups_of_eight(x: &[f64]) -> &[[f64; LANES]] {
    x.as_chunks().0
}
