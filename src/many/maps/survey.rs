//! The extrema of the quantities of a map, kept block by block, so that no array as large as a map is ever
//! stored.

use super::best::{Ends, ExtremaInLanes, MapExtrema, MapQuantity};
use super::rates::{RateNumbers, extremes_at};
use super::{blocks_of_map, body_columns};
use crate::error::{Error, room};
use crate::laws::body::Body;
use crate::many::threads::share;
use crate::numbers::side_by_side::zero;
use crate::numbers::{LANES, Narrow, in_lanes};
use crate::states::stability::{AtRest, Stored, Wanted};
use fearless_simd::Level;

/// Computes the extrema of the requested quantities over a map that is not stored.
///
/// ```
/// use spincyl::sweep::{MapQuantity, extrema};
/// use spincyl::{Body, steady};
///
/// let (theta, body) = ([1.1, 1.2, 1.3], Body::solid(2.5)?);
/// let found = extrema(&theta, &[Some(body)], &[MapQuantity::SquaredRate], 1, |_| true)?.expect("not stopped");
/// let least = found.of(MapQuantity::SquaredRate).expect("there are steady states").least;
/// assert!((least.value.sqrt() - steady::rate(&body, theta[least.theta])).abs() < 1e-15);
/// assert_eq!(found.of(MapQuantity::Energy), None); // it was not wanted
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// `threads` and `go_on` are as for [`portrait`](super::portrait); the result is None if the work is not finished. If
/// several points have an extreme value, the result has the first of them in row-major order.
///
/// # Errors
/// `Memory` if the memory does not suffice.
pub fn extrema(
    theta: &[f64],
    bodies: &[Option<Body>],
    wanted: &[MapQuantity],
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<Option<MapExtrema>, Error> {
    let mut asked = [false; 4];
    wanted.iter().for_each(|quantity| asked[*quantity as usize] = true);
    Ok(extrema_compiled_once(theta, bodies, asked, threads, &mut go_on)?.map(MapExtrema))
}

/// Computes extrema as [`extrema`] does; compiled once for all callers.
pub(crate) fn extrema_compiled_once(
    theta: &[f64],
    bodies: &[Option<Body>],
    wanted: [bool; 4],
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<[Ends; 4]>, Error> {
    let only_rate = wanted == [true, false, false, false];
    let Some(columns) = body_columns(bodies, only_rate, go_on)? else { return Ok(None) };
    let mut whole = [None; 4];
    let level = crate::numbers::level();
    if let Some(columns) = &columns.rate_numbers {
        let block = |theta: &[f64], columns: &[RateNumbers], width: usize| {
            [extremes_at(level, theta, columns, width), None, None, None]
        };
        let Some(found) = extrema_of(theta, bodies.len(), columns, threads, go_on, block)? else {
            return Ok(None);
        };
        whole = found;
    }
    if let Some(columns) = &columns.sharp {
        let Some(found) = all_extrema_of(level, theta, bodies.len(), columns, wanted, threads, go_on)? else {
            return Ok(None);
        };
        whole = found;
    }
    if let Some(columns) = &columns.rounded {
        let Some(found) = all_extrema_of(level, theta, bodies.len(), columns, wanted, threads, go_on)? else {
            return Ok(None);
        };
        for (whole, part) in whole.iter_mut().zip(found) {
            *whole = outer_extrema(*whole, part);
        }
    }
    Ok(Some(whole))
}

/// The smaller minimum and the larger maximum of two results; of equal values the first in row-major order.
fn outer_extrema(a: Ends, b: Ends) -> Ends {
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

/// The extrema of a map over the bodies with one kind of rim, sharp or rounded.
fn all_extrema_of(
    level: Option<Level>,
    theta: &[f64],
    bodies: usize,
    columns: &[impl Stored],
    wanted: [bool; 4],
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<[Ends; 4]>, Error> {
    extrema_of(theta, bodies, columns, threads, go_on, |theta, columns, width| {
        in_lanes!(
            level,
            simd => extrema_of_block(zero(simd), theta, columns, width, wanted),
            else extrema_of_block(0.0, theta, columns, width, wanted)
        )
    })
}

/// The extrema over all blocks, each of which `block` evaluates.
fn extrema_of<C: Sync>(
    theta: &[f64],
    bodies: usize,
    columns: &[C],
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
    block: impl Fn(&[f64], &[C], usize) -> [Ends; 4] + Sync,
) -> Result<Option<[Ends; 4]>, Error> {
    let count = blocks_of_map(theta, bodies).count();
    let (mut found, mut blocks) = (room(count)?, room(count)?);
    found.resize(count, [None; 4]);
    blocks.extend(blocks_of_map(theta, bodies).zip(&mut found));
    let all = share(blocks, threads, go_on, |((row, theta, first, width), found), _| {
        let columns = &columns[first / LANES..(first + width).div_ceil(LANES)];
        *found = block(theta, columns, width);
        for place in found.iter_mut().flatten().flatten() {
            (place.1, place.2) = (place.1 + row, place.2 + first);
        }
    });
    Ok(all.then(|| {
        let mut whole = [None; 4];
        for block in found {
            for (sum, part) in whole.iter_mut().zip(block) {
                *sum = outer_extrema(*sum, part);
            }
        }
        whole
    }))
}

#[inline(always)]
fn extrema_of_block<T: Narrow, C: Stored>(
    like: T,
    theta: &[f64],
    columns: &[C],
    width: usize,
    wanted: [bool; 4],
) -> [Ends; 4] {
    let mut best = [ExtremaInLanes::nothing(like); 4];
    // The extrema of the rate are found from its square, without a root at every point.
    let [squared, rolling, smooth, energy] = wanted;
    let asked = Wanted { squared, rolling, smooth, energy, ..Wanted::default() };
    let chunks = columns.len() * (LANES / T::COUNT);
    for (row, &theta) in theta.iter().enumerate() {
        let theta = like.splat(theta);
        let angle = C::Of::<T>::angle(theta);
        for chunk in 0..chunks {
            let first = chunk * T::COUNT;
            let found = columns[first / LANES].load(like, first % LANES).found(theta, &angle, asked);
            for (i, x) in [found.rate, found.rolling, found.smooth, found.energy].into_iter().enumerate() {
                if wanted[i] {
                    best[i].include(x, (row * chunks + chunk) as f64);
                }
            }
        }
    }
    let [a, b, c, d] = &best;
    [a, b, c, d].map(|best| best.places(chunks, width))
}
