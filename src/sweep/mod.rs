//! Dense maps: every inclination against every body, on lanes and threads.
//!
//! No formula of its own: each point is [`steady`](crate::steady) and
//! [`stability`](crate::stability) in eight lanes, with the same bits as the single call, for any
//! thread count, position and SIMD width. What is not asked for is not computed.

mod survey;

use crate::body::{Body, tube, tube_or_nan};
use crate::error::{Error, room, spare};
use crate::number::{LANES, SinCos, Sum, sincos, sincos_to_pi};
use crate::stability::{AtRest, Column, Columns, Stored, Wanted};
use crate::steady::rate_lanes;
use crate::threads::share;
use fearless_simd::{Level, Simd, SimdBase, f64x8};

pub use survey::{Extrema, areas, extrema};

/// Points in a block: a thread takes one at a time, and asks in between whether to go on.
const BLOCK: usize = 1 << 16;

/// A number that a map can be stored in: a double, or a single one.
pub trait Cell: kernel::Kernel {}

impl Cell for f64 {}
impl Cell for f32 {}

/// What is compiled for each kind of number, here: a crate that makes maps would otherwise compile all of it anew, for every SIMD
/// level, which takes minutes.
mod kernel {
    use super::{Body, Error, Portrait, points_of, portrait_of};

    pub trait Kernel: Copy + Send {
        /// `x`, rounded to it.
        fn of(x: f64) -> Self;

        fn map(
            theta: &[f64],
            bodies: &[Option<Body>],
            out: Portrait<'_, Self>,
            threads: usize,
            go_on: &mut dyn FnMut(f64) -> bool,
        ) -> Result<bool, Error>;

        fn scatter(
            columns: [&[f64]; 4],
            count: usize,
            out: Portrait<'_, Self>,
            threads: usize,
            go_on: &mut dyn FnMut(f64) -> bool,
        ) -> Result<bool, Error>;
    }

    macro_rules! kernel {
        ($number:ty) => {
            impl Kernel for $number {
                #[inline(always)]
                fn of(x: f64) -> Self {
                    x as $number
                }

                fn map(
                    theta: &[f64],
                    bodies: &[Option<Body>],
                    out: Portrait<'_, Self>,
                    threads: usize,
                    go_on: &mut dyn FnMut(f64) -> bool,
                ) -> Result<bool, Error> {
                    portrait_of(theta, bodies, out, threads, go_on)
                }

                fn scatter(
                    columns: [&[f64]; 4],
                    count: usize,
                    out: Portrait<'_, Self>,
                    threads: usize,
                    go_on: &mut dyn FnMut(f64) -> bool,
                ) -> Result<bool, Error> {
                    points_of(columns, count, out, threads, go_on)
                }
            }
        };
    }
    kernel!(f64);
    kernel!(f32);
}

/// The quantities of a map, each a row-major array (inclination, body) or, of points, one after the other;
/// `None` costs nothing.
#[derive(Debug)]
pub struct Portrait<'a, F = f64> {
    /// Reduced rotation rate, NaN where there is no steady state.
    pub rate: Option<&'a mut [F]>,
    /// Squared nutation frequency when rolling, negative where unstable.
    pub kappa_rolling: Option<&'a mut [F]>,
    /// Squared nutation frequency on a smooth table.
    pub kappa_smooth: Option<&'a mut [F]>,
    /// Energy, in M g R.
    pub energy: Option<&'a mut [F]>,
    /// Code of the [`Region`](crate::stability::Region).
    pub region: Option<&'a mut [u8]>,
}

impl<F> Default for Portrait<'_, F> {
    fn default() -> Self {
        Self { rate: None, kappa_rolling: None, kappa_smooth: None, energy: None, region: None }
    }
}

impl<'a, F: Cell> Portrait<'a, F> {
    /// The first `points` of each, and the rest.
    fn split(self, points: usize) -> (Self, Self) {
        fn cut<T>(x: Option<&mut [T]>, at: usize) -> (Option<&mut [T]>, Option<&mut [T]>) {
            x.map(|x| x.split_at_mut(at)).unzip()
        }
        let (rate, rate_rest) = cut(self.rate, points);
        let (kappa_rolling, rolling_rest) = cut(self.kappa_rolling, points);
        let (kappa_smooth, smooth_rest) = cut(self.kappa_smooth, points);
        let (energy, energy_rest) = cut(self.energy, points);
        let (region, region_rest) = cut(self.region, points);
        let rest = Self {
            rate: rate_rest,
            kappa_rolling: rolling_rest,
            kappa_smooth: smooth_rest,
            energy: energy_rest,
            region: region_rest,
        };
        (Self { rate, kappa_rolling, kappa_smooth, energy, region }, rest)
    }

    fn fits(&self, points: usize) -> bool {
        let floats = [&self.rate, &self.kappa_rolling, &self.kappa_smooth, &self.energy];
        floats.into_iter().flatten().all(|x| x.len() == points)
            && self.region.iter().all(|x| x.len() == points)
    }

    /// Puts eight points, of which some may be left over, at `start`.
    #[inline(always)]
    fn put<S: Simd>(
        &mut self,
        start: usize,
        theta: f64x8<S>,
        angle: &SinCos<f64x8<S>>,
        of: &impl AtRest<f64x8<S>>,
    ) {
        let wanted = Wanted {
            rate: self.rate.is_some(),
            squared: false,
            rolling: self.kappa_rolling.is_some(),
            smooth: self.kappa_smooth.is_some(),
            energy: self.energy.is_some(),
            region: self.region.is_some(),
        };
        let found = of.found(theta, angle, wanted);
        if let Some(out) = &mut self.rate {
            store(found.rate, &mut out[start..]);
        }
        if let Some(out) = &mut self.energy {
            store(found.energy, &mut out[start..]);
        }
        if let Some(out) = &mut self.kappa_rolling {
            store(found.rolling, &mut out[start..]);
        }
        if let Some(out) = &mut self.kappa_smooth {
            store(found.smooth, &mut out[start..]);
        }
        if let Some(out) = &mut self.region {
            for (slot, code) in out[start..].iter_mut().zip(*found.region) {
                *slot = code as u8;
            }
        }
    }
}

/// Fills the map of the steady states with the centre at rest: `theta.len()` rows of
/// `bodies.len()` points. A body that is `None` gives NaN and `Region::Invalid`.
///
/// `threads` workers, the caller among them, which asks `go_on`, with the share that is done, about fifty
/// times a second. Returns whether it finished; if not, the contents are unspecified. The error is `Memory`.
///
/// # Panics
/// If an array of `out` does not hold `theta.len() * bodies.len()` numbers.
pub fn portrait<F: Cell>(
    theta: &[f64],
    bodies: &[Option<Body>],
    out: Portrait<'_, F>,
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<bool, Error> {
    assert!(
        out.fits(theta.len() * bodies.len()),
        "an array does not have theta.len() * bodies.len() numbers"
    );
    if theta.is_empty() || bodies.is_empty() {
        return Ok(true);
    }
    F::map(theta, bodies, out, threads, &mut go_on)
}

fn portrait_of<F: Cell>(
    theta: &[f64],
    bodies: &[Option<Body>],
    out: Portrait<'_, F>,
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    let count = bodies.len();
    match gathered(bodies, go_on)? {
        Some(Columns::Sharp(columns)) => map_of(theta, count, &columns, out, threads, go_on),
        Some(Columns::Rounded(columns)) => map_of(theta, count, &columns, out, threads, go_on),
        Some(Columns::Any(columns)) => map_of(theta, count, &columns, out, threads, go_on),
        None => Ok(false),
    }
}

/// The map of columns of one kind.
fn map_of<F: Cell>(
    theta: &[f64],
    count: usize,
    columns: &[impl Stored],
    out: Portrait<'_, F>,
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    let (mut rest, mut blocks) = (out, room(tiles(theta, count).count())?);
    for (_, theta, first, width) in tiles(theta, count) {
        let (block, after) = rest.split(theta.len() * width);
        blocks.push((theta, &columns[first / LANES..], width, block));
        rest = after;
    }
    let level = crate::number::level();
    Ok(share(blocks, threads, go_on, |(theta, columns, width, block), _| {
        fill_at(level, theta, columns, width, block);
    }))
}

/// The bodies, eight in a column; None if it is told to stop.
fn gathered(bodies: &[Option<Body>], go_on: &mut dyn FnMut(f64) -> bool) -> Result<Option<Columns>, Error> {
    spare()?;
    let all = bodies.iter().flatten();
    let rounded = all.clone().filter(|body| Column::of(body).is_rounded()).count();
    Ok(if rounded == 0 {
        gathered_by(bodies, go_on, Column::sharp)?.map(Columns::Sharp)
    } else if rounded == all.count() {
        gathered_by(bodies, go_on, Column::rounded)?.map(Columns::Rounded)
    } else {
        gathered_by(bodies, go_on, Column::gather)?.map(Columns::Any)
    })
}

fn gathered_by<C>(
    bodies: &[Option<Body>],
    go_on: &mut dyn FnMut(f64) -> bool,
    gather: impl Fn(&[Option<Body>]) -> C,
) -> Result<Option<Vec<C>>, Error> {
    let mut columns = room(bodies.len().div_ceil(LANES))?;
    for (i, some) in bodies.chunks(BLOCK).enumerate() {
        if i > 0 && !go_on(0.0) {
            return Ok(None);
        }
        columns.extend(some.chunks(LANES).map(&gather));
    }
    Ok(Some(columns))
}

/// A map in blocks: the first row, the rows, the first body, how many bodies. Some whole rows, or, of a wide
/// map, a part of one.
fn tiles(theta: &[f64], width: usize) -> impl Iterator<Item = (usize, &[f64], usize, usize)> {
    let (rows, part) = ((BLOCK / width.max(1)).max(1), width.clamp(1, BLOCK));
    theta.chunks(rows).enumerate().flat_map(move |(i, theta)| {
        (0..width).step_by(part).map(move |first| (i * rows, theta, first, part.min(width - first)))
    })
}

/// One block: some rows of the map, compiled for every SIMD level.
fn fill_at<F: Cell>(
    level: Level,
    theta: &[f64],
    columns: &[impl Stored],
    width: usize,
    block: Portrait<'_, F>,
) {
    fearless_simd::dispatch!(level, simd => fill(simd, theta, columns, width, block));
}

#[inline(always)]
fn fill<S: Simd, F: Cell>(
    simd: S,
    theta: &[f64],
    columns: &[impl Stored],
    width: usize,
    block: Portrait<'_, F>,
) {
    let mut rest = block;
    for &theta in theta {
        let (mut row, after) = rest.split(width);
        rest = after;
        let splat = |x: f64| wide_of(simd, x);
        let one = sincos_to_pi(theta);
        let wide = |x: Sum<f64>| Sum { hi: splat(x.hi), lo: splat(x.lo) };
        let angle = SinCos { sin: wide(one.sin), cos: wide(one.cos) };
        let theta = splat(theta);
        for (column, start) in columns.iter().zip((0..width).step_by(LANES)) {
            let of = column.load(simd);
            row.put(start, theta, &angle, &of);
        }
    }
}

/// Fills the same of scattered points: an inclination and a tube (half length, bore and fillet) each; any of them
/// may be a single number. NaN and `Region::Invalid` where theta or the tube is out of range.
///
/// The values are those of [`portrait`], bit by bit. Threads and `go_on` as there.
///
/// # Panics
/// If columns differ in length (but for single numbers), or an array of `out` does not fit them.
pub fn points<F: Cell>(
    [theta, ell, bore, fillet]: [&[f64]; 4],
    out: Portrait<'_, F>,
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<bool, Error> {
    let columns = [theta, ell, bore, fillet];
    let count = columns.iter().map(|x| x.len()).find(|n| *n != 1).unwrap_or(1);
    assert!(columns.iter().all(|x| x.len() == 1 || x.len() == count), "columns of different lengths");
    assert!(out.fits(count), "an array does not fit");
    F::scatter(columns, count, out, threads, &mut go_on)
}

fn points_of<F: Cell>(
    columns: [&[f64]; 4],
    count: usize,
    out: Portrait<'_, F>,
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    spare()?;
    let (mut rest, mut blocks) = (out, room(count.div_ceil(BLOCK))?);
    for first in (0..count).step_by(BLOCK) {
        let here = BLOCK.min(count - first);
        let (block, after) = rest.split(here);
        blocks.push((columns.map(|x| if x.len() == 1 { x } else { &x[first..first + here] }), here, block));
        rest = after;
    }
    let level = crate::number::level();
    Ok(share(blocks, threads, go_on, |(columns, count, block), _| {
        fearless_simd::dispatch!(level, simd => scatter(simd, columns, count, block));
    }))
}

#[inline(always)]
fn scatter<S: Simd, F: Cell>(simd: S, columns: [&[f64]; 4], count: usize, mut block: Portrait<'_, F>) {
    let [_, ell, bore, fillet] = columns;
    let fixed = [ell, bore, fillet].iter().all(|x| x.len() == 1);
    let rounded = fillet != [0.0];
    // the rate alone needs less of a body
    if let Portrait { rate: Some(rate), kappa_rolling: None, kappa_smooth: None, energy: None, region: None } =
        &mut block
        && !rounded
    {
        let (one_ell, one_bore) = (load(simd, ell, 0), load(simd, bore, 0));
        let one = (tube_or_nan(one_ell, one_bore), tube(one_ell, one_bore).1);
        for start in (0..count).step_by(LANES) {
            let (ell, excess) = if fixed {
                one
            } else {
                let (ell, bore) = (load(simd, ell, start), load(simd, bore, start));
                (tube_or_nan(ell, bore), tube(ell, bore).1)
            };
            store(rate_lanes(load(simd, columns[0], start), ell, excess), &mut rate[start..]);
        }
        return;
    }
    let mut of = if rounded {
        rounded_tubes(simd, [ell, bore, fillet], 0)
    } else {
        Column::tube(load(simd, ell, 0), load(simd, bore, 0))
    };
    for start in (0..count).step_by(LANES) {
        if !fixed {
            of = if rounded {
                rounded_tubes(simd, [ell, bore, fillet], start)
            } else {
                Column::tube(load(simd, ell, start), load(simd, bore, start))
            };
        }
        let theta = load(simd, columns[0], start);
        let angle = if of.is_rounded() { sincos_to_pi(theta) } else { sincos(theta) };
        block.put(start, theta, &angle, &of);
    }
}

/// Eight tubes with rounded edges from `start` on. In a function of its own: their moments are many lines, in twice the
/// digits.
#[inline(never)]
fn rounded_tubes<S: Simd>(simd: S, of: [&[f64]; 3], start: usize) -> Column<f64x8<S>> {
    simd.vectorize(
        #[inline(always)]
        || {
            let [half, bore, fillet] = of.map(|x| load(simd, x, start));
            Column::rounded_tube(half, bore, fillet, of[2].len() > 1)
        },
    )
}

/// Eight numbers from `start` on, NaN beyond the end; or the only one there is, in all lanes.
#[inline(always)]
fn load<S: Simd>(simd: S, x: &[f64], start: usize) -> f64x8<S> {
    if x.len() == 1 {
        return wide_of(simd, x[0]);
    }
    match x[start..].first_chunk::<LANES>() {
        Some(lanes) => f64x8::from_slice(simd, lanes),
        None => {
            let mut lanes = [f64::NAN; LANES];
            lanes[..x.len() - start].copy_from_slice(&x[start..]);
            f64x8::from_slice(simd, &lanes)
        }
    }
}

/// The lanes that fit.
#[inline(always)]
fn store<S: Simd, F: Cell>(x: f64x8<S>, out: &mut [F]) {
    match out.first_chunk_mut::<LANES>() {
        Some(out) => {
            for k in 0..LANES {
                out[k] = F::of(x[k]);
            }
        }
        None => out.iter_mut().zip(*x).for_each(|(slot, x)| *slot = F::of(x)),
    }
}

/// The same number in all lanes.
#[inline(always)]
fn wide_of<S: Simd>(simd: S, x: f64) -> f64x8<S> {
    <f64x8<S> as SimdBase<S>>::splat(simd, x)
}
