//! What a map would tell, without the map: the areas of its regions, and where a quantity is least and largest.
//!
//! Areas come from the curves that bound the regions; extrema are kept block by block, so that nothing as large as a map is
//! ever held.

use super::{gathered, tiles, wide_of};
use crate::body::Body;
use crate::contact::Contact;
use crate::error::{Error, room, spare};
use crate::number::{LANES, Real, SinCos, Sum, sincos_to_pi};
use crate::stability::{AtRest, Region, Stored, Wanted, boundaries, region};
use crate::steady::edges;
use crate::threads::share;
use fearless_simd::{Simd, f64x8};

/// For how much of a set of inclinations each body is in each [`Region`], by its
/// code: the sum of their weights (1 each: a count). Row-major (body, code), eight codes a body.
///
/// `theta` ascending. No map is made: between the places where a body's region can change
/// it is asked for once, and one by one only around them. The same as counting the map, and a test of `sweep` says so.
/// Threads, `go_on` and the error as in [`portrait`](super::portrait); None if it did not finish.
///
/// # Panics
/// If theta and weights differ in length, or theta does not ascend.
pub fn areas(
    theta: &[f64],
    weights: &[f64],
    bodies: &[Option<Body>],
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<Option<Vec<[f64; 8]>>, Error> {
    assert!(theta.len() == weights.len() && theta.is_sorted(), "theta ascending, and a weight for each");
    spare()?;
    let mut sums = room(theta.len() + 1)?;
    sums.push(0.0);
    sums.extend(weights.iter().scan(0.0, |sum, w| {
        *sum += w;
        Some(*sum)
    }));
    let mut areas = room(bodies.len())?;
    areas.resize(bodies.len(), [0.0; 8]);
    let parts = bodies.chunks(SURVEYED).zip(areas.chunks_mut(SURVEYED));
    let mut blocks = room(parts.len())?;
    blocks.extend(parts);
    let all = share(blocks, threads, &mut go_on, |(bodies, areas), _| {
        for (area, body) in areas.iter_mut().zip(bodies) {
            *area = areas_of(theta, &sums, body.as_ref());
        }
    });
    Ok(all.then_some(areas))
}

/// Bodies in a block of `areas`: each asks for some dozens of regions and zeros.
const SURVEYED: usize = 256;

/// Inclinations on both sides of a change that are asked for one by one.
const AROUND: usize = 2;

fn areas_of(theta: &[f64], sums: &[f64], body: Option<&Body>) -> [f64; 8] {
    let mut area = [0.0; 8];
    let Some(body) = body else {
        area[Region::Invalid as usize] = sums[theta.len()];
        return area;
    };
    let mut changes: Vec<usize> = [boundaries(body, Contact::Rolling), boundaries(body, Contact::Smooth)]
        .into_iter()
        .flatten()
        .chain(edges(body))
        .filter(|x| !x.is_nan())
        .map(|x| theta.partition_point(|theta| *theta < x))
        .collect();
    changes.sort_unstable();
    let mut from = 0;
    let mut add = |from: usize, to: usize| {
        if from < to {
            area[region(body, theta[from + (to - from) / 2]) as usize] += sums[to] - sums[from];
        }
    };
    for change in changes {
        let near = change.saturating_sub(AROUND).max(from)..(change + AROUND).min(theta.len()).max(from);
        add(from, near.start);
        near.clone().for_each(|i| add(i, i + 1));
        from = near.end;
    }
    add(from, theta.len());
    area
}

/// Least and greatest of a quantity of a map, and where: (value, inclination's index, body's index); None if
/// there is no steady state at all.
pub type Extrema = Option<[(f64, usize, usize); 2]>;

/// The extrema of the rate, of both kappas and of the energy over a map that is not made.
///
/// Threads, `go_on` and the error as in [`portrait`](super::portrait); None if it did not finish. Equal values: the first in
/// row-major order.
pub fn extrema(
    theta: &[f64],
    bodies: &[Option<Body>],
    wanted: [bool; 4],
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<Option<[Extrema; 4]>, Error> {
    found(theta, bodies, wanted, threads, &mut go_on)
}

/// Compiled here, once.
fn found(
    theta: &[f64],
    bodies: &[Option<Body>],
    wanted: [bool; 4],
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<[Extrema; 4]>, Error> {
    let Some(columns) = gathered(bodies, go_on)? else { return Ok(None) };
    let mut whole = [None; 4];
    if let Some(columns) = &columns.sharp {
        let Some(found) = extrema_of(theta, bodies.len(), columns, wanted, threads, go_on)? else {
            return Ok(None);
        };
        whole = found;
    }
    if let Some(columns) = &columns.rounded {
        let Some(found) = extrema_of(theta, bodies.len(), columns, wanted, threads, go_on)? else {
            return Ok(None);
        };
        for (whole, part) in whole.iter_mut().zip(found) {
            *whole = better(*whole, part);
        }
    }
    Ok(Some(whole))
}

/// The lower of the least and the higher of the greatest; of equal ones that which comes first.
fn better(a: Extrema, b: Extrema) -> Extrema {
    let place = |end: &(f64, usize, usize)| (end.1, end.2);
    match (a, b) {
        (Some([low, high]), Some([lower, higher])) => {
            let less = lower.0 < low.0 || (lower.0 == low.0 && place(&lower) < place(&low));
            let more = higher.0 > high.0 || (higher.0 == high.0 && place(&higher) < place(&high));
            Some([if less { lower } else { low }, if more { higher } else { high }])
        }
        (a, b) => a.or(b),
    }
}

/// The same of columns of one kind.
fn extrema_of(
    theta: &[f64],
    bodies: usize,
    columns: &[impl Stored],
    wanted: [bool; 4],
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<[Extrema; 4]>, Error> {
    let count = tiles(theta, bodies).count();
    let (mut found, mut blocks) = (room(count)?, room(count)?);
    found.resize(count, [None; 4]);
    blocks.extend(tiles(theta, bodies).zip(&mut found));
    let level = crate::number::level();
    let all = share(blocks, threads, go_on, |((row, theta, first, width), found), _| {
        let columns = &columns[first / LANES..(first + width).div_ceil(LANES)];
        *found = fearless_simd::dispatch!(level, simd => extremes(simd, theta, columns, width, wanted));
        for place in found.iter_mut().flatten().flatten() {
            (place.1, place.2) = (place.1 + row, place.2 + first);
        }
    });
    Ok(all.then(|| {
        let mut whole = [None; 4];
        for block in found {
            for (sum, part) in whole.iter_mut().zip(block) {
                *sum = better(*sum, part);
            }
        }
        whole
    }))
}

/// One block of `extrema`.
#[inline(always)]
fn extremes<S: Simd>(
    simd: S,
    theta: &[f64],
    columns: &[impl Stored],
    width: usize,
    wanted: [bool; 4],
) -> [Extrema; 4] {
    let splat = |x: f64| wide_of(simd, x);
    let (none, zero) = (splat(f64::INFINITY), splat(0.0));
    // per lane: the least of x and of -x, and where, as row * chunks + chunk
    let mut best = [[(none, zero); 2]; 4];
    for (row, &theta) in theta.iter().enumerate() {
        let one = sincos_to_pi(theta);
        let wide = |x: Sum<f64>| Sum { hi: splat(x.hi), lo: splat(x.lo) };
        let angle = SinCos { sin: wide(one.sin), cos: wide(one.cos) };
        let theta = splat(theta);
        for (chunk, column) in columns.iter().enumerate() {
            let of = column.load(simd);
            let place = splat((row * columns.len() + chunk) as f64);
            let mut keep = |i: usize, x: f64x8<S>| {
                for (x, best) in [x, -x].into_iter().zip(&mut best[i]) {
                    best.1 = x.select_lt(best.0, place, best.1);
                    best.0 = x.select_lt(best.0, x, best.0);
                }
            };
            // of the rate the square: its root, where it matters
            let [squared, rolling, smooth, energy] = wanted;
            let found =
                of.found(theta, &angle, Wanted { squared, rolling, smooth, energy, ..Wanted::default() });
            for (i, x) in [found.rate, found.rolling, found.smooth, found.energy].into_iter().enumerate() {
                if wanted[i] {
                    keep(i, x);
                }
            }
        }
    }
    let mut found = [None; 4];
    for (found, best) in found.iter_mut().zip(best) {
        let mut ends = [(f64::INFINITY, 0, 0); 2];
        for (end, (value, place)) in ends.iter_mut().zip(best) {
            let mut order = usize::MAX;
            for k in 0..LANES {
                let (row, chunk) =
                    (place[k] as usize / columns.len().max(1), place[k] as usize % columns.len().max(1));
                let body = chunk * LANES + k;
                if value[k] < end.0 || (value[k] == end.0 && row * width + body < order) {
                    (*end, order) = ((value[k], row, body), row * width + body);
                }
            }
        }
        if ends[0].0 < f64::INFINITY {
            ends[1].0 = -ends[1].0;
            *found = Some(ends);
        }
    }
    found
}
