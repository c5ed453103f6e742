//! The areas of the regions of a map, from the curves that bound the regions, without computing the whole map.

use crate::error::{Error, room, spare};
use crate::laws::body::Body;
use crate::laws::contact::Contact;
use crate::many::threads::share;
use crate::states::stability::{Region, boundaries, regions, runs};
use crate::states::steady::edges;
use core::f64::consts::FRAC_PI_2;

/// The sums of the weights of the inclinations at which each body is in each [`Region`], for each set of weights
/// (weights of 1 give a count). The result is row-major (body, set, code), with eight codes.
///
/// `theta` ascends. The map itself is not computed. For a sharp rim bisection finds the changes of sign, and every
/// inclination is evaluated if a sign is uncertain; for a rounded rim the curves between the regions are computed, and
/// single inclinations are evaluated only around them. The sums equal those of the map; two tests of `sweep` check it.
/// `threads` and `go_on` are as for [`portrait`](super::portrait); None if the work is not finished.
///
/// # Errors
/// `Memory` if the memory does not suffice.
///
/// # Panics
/// Panics if theta and weights differ in length, or theta does not ascend.
pub fn areas<const SETS: usize>(
    theta: &[f64],
    weights: [&[f64]; SETS],
    bodies: &[Option<Body>],
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<Option<Vec<[[f64; 8]; SETS]>>, Error> {
    let fit = weights.iter().all(|w| w.len() == theta.len());
    assert!(fit && theta.is_sorted(), "expected theta to ascend, and a weight for each inclination");
    spare()?;
    let mut sums = room(theta.len() + 1)?;
    let mut sum = [0.0; SETS];
    sums.push(sum);
    for i in 0..theta.len() {
        sum.iter_mut().zip(weights).for_each(|(sum, w)| *sum += w[i]);
        sums.push(sum);
    }
    // Inclinations outside (0, pi/2] are `Region::Invalid`.
    let asked = theta.partition_point(|x| *x <= 0.0)..theta.partition_point(|x| *x <= FRAC_PI_2);
    let mut tangents = room(asked.len())?;
    tangents.extend(theta[asked.clone()].iter().map(|x| x.tan()));
    let grid = Grid { theta, sums: &sums, first: asked.start, tangents: &tangents };
    let mut areas = room(bodies.len())?;
    areas.resize(bodies.len(), [[0.0; 8]; SETS]);
    let parts = bodies.chunks(BODIES_PER_AREA_BLOCK).zip(areas.chunks_mut(BODIES_PER_AREA_BLOCK));
    let mut blocks = room(parts.len())?;
    blocks.extend(parts);
    let all = share(blocks, threads, &mut go_on, |(bodies, areas), _| {
        let mut asked = Vec::new();
        for (area, body) in areas.iter_mut().zip(bodies) {
            *area = areas_of(&grid, body.as_ref(), &mut asked);
        }
    });
    Ok(all.then_some(areas))
}

/// The inclinations, the sums of their weights up to each, and the first index and the tangents of those in
/// (0, pi/2].
struct Grid<'a, const SETS: usize> {
    theta: &'a [f64],
    sums: &'a [[f64; SETS]],
    first: usize,
    tangents: &'a [f64],
}

/// Number of bodies in a block of `areas`: most bodies take half a microsecond, some as long as their part of a whole
/// map.
const BODIES_PER_AREA_BLOCK: usize = 256;

/// Number of inclinations that are evaluated one by one on each side of a computed change of region.
const POINTS_AROUND_CHANGE: usize = 2;

/// The areas of the regions of one body; `asked` is a buffer for the ranges of evaluated inclinations.
fn areas_of<const SETS: usize>(
    &Grid { theta, sums, first, tangents }: &Grid<'_, SETS>,
    body: Option<&Body>,
    asked: &mut Vec<(usize, usize)>,
) -> [[f64; 8]; SETS] {
    let mut area = [[0.0; 8]; SETS];
    let mut add = |code: usize, from: usize, to: usize| {
        for (area, (end, start)) in area.iter_mut().zip(sums[to].iter().zip(sums[from])) {
            area[code] += end - start;
        }
    };
    let Some(body) = body else {
        add(Region::Invalid as usize, 0, theta.len());
        return area;
    };
    if body.is_plain() {
        let known = runs(body, tangents, |code, from, to| add(code as usize, first + from, first + to));
        if known {
            add(Region::Invalid as usize, 0, first);
            add(Region::Invalid as usize, first + tangents.len(), theta.len());
        } else {
            let codes = regions(body, theta.iter().copied());
            codes.iter().enumerate().for_each(|(i, code)| add((*code).into(), i, i + 1));
        }
        return area;
    }
    let mut changes: Vec<usize> = [boundaries(body, Contact::Rolling), boundaries(body, Contact::Smooth)]
        .into_iter()
        .flatten()
        .chain(edges(body))
        .filter(|x| !x.is_nan())
        .map(|x| theta.partition_point(|theta| *theta < x))
        .collect();
    changes.sort_unstable();
    let mut from = 0;
    asked.clear();
    for change in changes.into_iter().chain([theta.len() + POINTS_AROUND_CHANGE]) {
        let near = change.saturating_sub(POINTS_AROUND_CHANGE).max(from)
            ..(change + POINTS_AROUND_CHANGE).min(theta.len()).max(from);
        if from < near.start {
            asked.push((from, near.start));
        }
        asked.extend(near.clone().map(|i| (i, i + 1)));
        from = near.end;
    }
    let codes = regions(body, asked.iter().map(|(from, to)| theta[from + (to - from) / 2]));
    for ((from, to), code) in asked.iter().zip(codes) {
        add(code as usize, *from, *to);
    }
    area
}
