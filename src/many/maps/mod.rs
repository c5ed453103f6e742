//! Dense maps of the steady states of every body at every inclination, computed in SIMD lanes and on threads.
//!
//! The module has no formulas: each point is computed by [`steady`](crate::states::steady) and
//! [`stability`](crate::states::stability) in eight SIMD lanes, with the same bits as the single call, for any thread
//! count, position and SIMD width. Only requested quantities are computed. In single precision the root of the rate of
//! a sharp rim is taken in that precision, and every other quantity is rounded once.
//!
//! ```
//! use spincyl::sweep::{Portrait, portrait};
//! use spincyl::{Body, steady};
//!
//! let (theta, body) = ([1.2, 1.3], Body::solid(2.5)?);
//! let mut rate = [0.0; 2];
//! let wanted = Portrait::default().with_rate(&mut rate[..]);
//! assert!(portrait(&theta, &[Some(body)], wanted, 1, |_| true)?);
//! assert_eq!(rate, theta.map(|theta| steady::rate(&body, theta)));
//! # Ok::<(), spincyl::Error>(())
//! ```

mod areas;
mod best;
mod block;
mod rates;
mod survey;

use super::columns::{RowBlock, Split, blocks, fit, rows};
use super::threads::share;
use crate::error::{Error, room, spare};
use crate::laws::body::Body;
use crate::numbers::side_by_side::{SideBySide, apart, load, zero};
use crate::numbers::{LANES, Narrow, in_lanes, level};
use crate::states::stability::{AtRest, Column, Moments, Rounded, Stored};
use block::Block;
use fearless_simd::{Level, Simd, f64x8};
use rates::RateNumbers;

pub use areas::areas;
pub(crate) use best::Ends;
pub use best::{Extrema, MapExtrema, MapPoint, MapQuantity};
pub use survey::extrema;
pub(crate) use survey::extrema_compiled_once;

/// Number of points in a block: a thread takes one block at a time, and the caller can stop the work between blocks.
const POINTS_PER_BLOCK: usize = 1 << 16;

/// A type of number in which a map can be stored: double precision, or single precision, where the relative error of a
/// rate is at most 1.51 times 2^-24.
pub trait Cell: sealed::Slotted {}

impl Cell for f64 {}
impl Cell for f32 {}

mod sealed {
    use super::block::Slot;

    pub trait Slotted: Copy + Send {
        fn slot(of: &mut [Self]) -> Slot<'_>;
    }

    impl Slotted for f64 {
        fn slot(of: &mut [f64]) -> Slot<'_> {
            Slot::Double(of)
        }
    }

    impl Slotted for f32 {
        fn slot(of: &mut [f32]) -> Slot<'_> {
            Slot::Single(of)
        }
    }
}

/// The quantities of a map, each as a row-major array (inclination, body), or, for points, as an array with one number
/// for each point; a quantity that is `None` is not computed.
#[derive(Debug)]
#[non_exhaustive]
pub struct Portrait<'a, F = f64> {
    /// Reduced rotation rate; NaN where no steady state exists.
    pub rate: Option<&'a mut [F]>,
    /// Squared nutation frequency in rolling, in g/R, negative where unstable.
    pub kappa_rolling: Option<&'a mut [F]>,
    /// Squared nutation frequency on a smooth table, in g/R, negative where unstable.
    pub kappa_smooth: Option<&'a mut [F]>,
    /// Energy of the steady state, in M g R.
    pub energy: Option<&'a mut [F]>,
    /// Code of the [`Region`](crate::states::stability::Region) of each point.
    pub region: Option<&'a mut [u8]>,
}

impl<F> Default for Portrait<'_, F> {
    fn default() -> Self {
        Self { rate: None, kappa_rolling: None, kappa_smooth: None, energy: None, region: None }
    }
}

impl<'a, F> Portrait<'a, F> {
    /// Returns these arrays together with one for the reduced rotation rate.
    #[must_use]
    pub fn with_rate(self, rate: &'a mut [F]) -> Self {
        Self { rate: Some(rate), ..self }
    }

    /// Returns these arrays together with one for the squared nutation frequency in rolling.
    #[must_use]
    pub fn with_kappa_rolling(self, kappa_rolling: &'a mut [F]) -> Self {
        Self { kappa_rolling: Some(kappa_rolling), ..self }
    }

    /// Returns these arrays together with one for the squared nutation frequency on a smooth table.
    #[must_use]
    pub fn with_kappa_smooth(self, kappa_smooth: &'a mut [F]) -> Self {
        Self { kappa_smooth: Some(kappa_smooth), ..self }
    }

    /// Returns these arrays together with one for the energy.
    #[must_use]
    pub fn with_energy(self, energy: &'a mut [F]) -> Self {
        Self { energy: Some(energy), ..self }
    }

    /// Returns these arrays together with one for the codes of the regions.
    #[must_use]
    pub fn with_region(self, region: &'a mut [u8]) -> Self {
        Self { region: Some(region), ..self }
    }
}

/// Scattered points of a map, each with an inclination and a tube, as columns: each has the length n, or is a single
/// number for all points.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct TubePoints<'a> {
    /// Inclinations of the points, in radians.
    pub theta: &'a [f64],
    /// Half lengths of the tubes, in R.
    pub half_length: &'a [f64],
    /// Inner radii of the tubes, in R.
    pub bore: &'a [f64],
    /// Radius of the fillets of the outer edges of the tube, in R.
    pub fillet: &'a [f64],
}

impl<'a> TubePoints<'a> {
    /// Points with solid cylinders with sharp edges.
    pub const fn new(theta: &'a [f64], half_length: &'a [f64]) -> Self {
        Self { theta, half_length, bore: &[0.0], fillet: &[0.0] }
    }

    /// Returns these points with this column of the inner radii of the tubes, in R.
    #[must_use]
    pub const fn with_bore(self, bore: &'a [f64]) -> Self {
        Self { bore, ..self }
    }

    /// Returns these points with this column of the radii of the fillets, in R.
    #[must_use]
    pub const fn with_fillet(self, fillet: &'a [f64]) -> Self {
        Self { fillet, ..self }
    }
}

/// Fills the map of the steady states with the centre at rest: `theta.len()` rows of
/// `bodies.len()` points. A body that is `None` gives NaN and `Region::Invalid`.
///
/// The caller is one of `threads` threads. It calls `go_on` with the finished share of the work about fifty times a
/// second, and stops if `go_on` returns false. Returns whether the map is finished; if not, the contents of `out` are
/// unspecified.
///
/// # Errors
/// `Memory` if the memory does not suffice.
///
/// # Panics
/// Panics if an array of `out` does not hold `theta.len() * bodies.len()` numbers.
pub fn portrait<F: Cell>(
    theta: &[f64],
    bodies: &[Option<Body>],
    out: Portrait<'_, F>,
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<bool, Error> {
    let out = Block::of(out);
    assert!(
        out.fits(theta.len() * bodies.len()),
        "an output array does not have theta.len() * bodies.len() numbers"
    );
    if theta.is_empty() || bodies.is_empty() {
        return Ok(true);
    }
    portrait_of(theta, bodies, out, threads, &mut go_on)
}

/// Computes a map as [`portrait`] does; compiled once for all callers.
fn portrait_of(
    theta: &[f64],
    bodies: &[Option<Body>],
    out: Block<'_>,
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    let only_rate = out.is_rate();
    let Some(columns) = body_columns(bodies, only_rate, go_on)? else { return Ok(false) };
    let (count, level) = (bodies.len(), level());
    let mixed = columns.sharp.is_some() || columns.rate_numbers.is_some();
    let (mut rest, mut blocks) = (out, room(blocks_of_map(theta, count).count())?);
    for (_, theta, first, width) in blocks_of_map(theta, count) {
        let (block, after) = rest.split(theta.len() * width);
        blocks.push((theta, first / LANES, width, block));
        rest = after;
    }
    Ok(share(blocks, threads, go_on, |(theta, first, width, mut block), _| {
        if let (Some(columns), [Some(out), ..]) = (&columns.rate_numbers, &mut block.numbers) {
            let here = &columns[first..][..width.div_ceil(LANES)];
            rates::rows_at(level, theta, here, width, out);
        }
        if let Some(columns) = &columns.sharp {
            fill_at(level, theta, &columns[first..], width, &mut block, false);
        }
        if let Some(columns) = &columns.rounded {
            // Where the map also has sharp rims, only the points of rounded rims are written.
            fill_at(level, theta, &columns[first..], width, &mut block, mixed);
        }
    }))
}

/// Many bodies in columns of eight SIMD lanes: those on sharp rims (with all their numbers, or only those of the rate)
/// and those on rounded rims. A body is NaN in the columns of the other kind.
pub(super) struct Columns {
    pub rate_numbers: Option<Vec<RateNumbers>>,
    pub sharp: Option<Vec<Moments<[f64; LANES]>>>,
    pub rounded: Option<Vec<Rounded<[f64; LANES]>>>,
}

/// The bodies in columns of eight SIMD lanes; None if `go_on` returns false.
fn body_columns(
    bodies: &[Option<Body>],
    only_rate: bool,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<Columns>, Error> {
    spare()?;
    let rounded = bodies.iter().flatten().any(|body| !body.is_plain());
    let sharp = !rounded || bodies.iter().flatten().any(Body::is_plain);
    let mut columns = Columns { rate_numbers: None, sharp: None, rounded: None };
    if sharp && only_rate && level().is_some() {
        let Some(found) = gather_with(bodies, go_on, RateNumbers::gather)? else { return Ok(None) };
        columns.rate_numbers = Some(found);
    } else if sharp {
        let Some(found) = gather_with(bodies, go_on, Column::sharp)? else { return Ok(None) };
        columns.sharp = Some(found);
    }
    if rounded {
        let Some(found) = gather_with(bodies, go_on, Column::rounded)? else { return Ok(None) };
        columns.rounded = Some(found);
    }
    Ok(Some(columns))
}

fn gather_with<C>(
    bodies: &[Option<Body>],
    go_on: &mut dyn FnMut(f64) -> bool,
    gather: impl Fn(&[Option<Body>]) -> C,
) -> Result<Option<Vec<C>>, Error> {
    let mut columns = room(bodies.len().div_ceil(LANES))?;
    for (i, some) in bodies.chunks(POINTS_PER_BLOCK).enumerate() {
        if i > 0 && !go_on(0.0) {
            return Ok(None);
        }
        columns.extend(some.chunks(LANES).map(&gather));
    }
    Ok(Some(columns))
}

/// The blocks of a map, each with its first row, its inclinations, its first body and its number of bodies. A block has
/// several whole rows or, on a wide map, a part of one row.
fn blocks_of_map(theta: &[f64], width: usize) -> impl Iterator<Item = (usize, &[f64], usize, usize)> {
    let (rows, part) = ((POINTS_PER_BLOCK / width.max(1)).max(1), width.clamp(1, POINTS_PER_BLOCK));
    theta.chunks(rows).enumerate().flat_map(move |(i, theta)| {
        (0..width).step_by(part).map(move |first| (i * rows, theta, first, part.min(width - first)))
    })
}

/// Bytes of body numbers that stay in the nearest cache while row after row is filled.
const CACHE_BYTES: usize = 1 << 14;

/// The columns in groups that fit into the nearest cache of the processor, each with the index of its first body.
fn groups_in_cache<C>(columns: &[C]) -> impl Iterator<Item = (usize, &[C])> {
    let group = CACHE_BYTES / size_of::<C>();
    columns.chunks(group).enumerate().map(move |(i, some)| (i * group * LANES, some))
}

/// Fills one block of a map; with `gaps` only the points that are not NaN for the bodies in these columns.
fn fill_at(
    level: Option<Level>,
    theta: &[f64],
    columns: &[impl Stored],
    width: usize,
    block: &mut Block<'_>,
    gaps: bool,
) {
    in_lanes!(
        level,
        simd => fill(zero(simd), theta, columns, width, block, gaps),
        else fill(0.0, theta, columns, width, block, gaps)
    );
}

#[inline(always)]
fn fill<T: Narrow, C: Stored>(
    like: T,
    theta: &[f64],
    columns: &[C],
    width: usize,
    block: &mut Block<'_>,
    gaps: bool,
) {
    let wanted = block.wanted();
    for (from, columns) in groups_in_cache(&columns[..width.div_ceil(LANES)]) {
        let count = (columns.len() * LANES).min(width - from);
        for (row, &theta) in theta.iter().enumerate() {
            let theta = like.splat(theta);
            let angle = C::Of::<T>::angle(theta);
            let mut here = block.part(row * width + from, count);
            for (column, first) in columns.iter().zip((0..count).step_by(LANES)) {
                for start in (first..count.min(first + LANES)).step_by(T::COUNT) {
                    let found = column.load(like, start - first).found(theta, &angle, wanted);
                    here.put(start, (count - start).min(T::COUNT), &found, gaps);
                }
            }
        }
    }
}

/// Fills the quantities of scattered points. NaN and `Region::Invalid` mark points where theta or the tube is out of range.
///
/// ```
/// use spincyl::sweep::{Portrait, TubePoints, points};
///
/// // One inclination of three cylinders.
/// let mut kappa = [0.0; 3];
/// let out = Portrait::default().with_kappa_rolling(&mut kappa[..]);
/// assert!(points(TubePoints::new(&[1.3], &[1.0, 2.0, 3.0]), out, 1, |_| true)?);
/// assert!(kappa.iter().all(|kappa| *kappa > 0.0), "{kappa:?}");
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// The values are those of [`portrait`], bit by bit; `threads` and `go_on` are as for `portrait`.
///
/// # Errors
/// `Memory` if the memory does not suffice.
///
/// # Panics
/// Panics if columns differ in length (apart from single numbers), or an array of `out` does not fit them.
pub fn points<F: Cell>(
    TubePoints { theta, half_length: ell, bore, fillet }: TubePoints<'_>,
    out: Portrait<'_, F>,
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<bool, Error> {
    let columns = [theta, ell, bore, fillet];
    let count = rows(columns.into_iter());
    assert!(fit(columns.into_iter(), count), "expected columns of one length, or single numbers");
    let out = Block::of(out);
    assert!(out.fits(count), "an output array does not have the length of the results");
    points_of(columns, count, out, threads, &mut go_on)
}

/// Computes scattered points as [`points`] does; compiled once for all callers.
fn points_of(
    columns: [&[f64]; 4],
    count: usize,
    out: Block<'_>,
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    spare()?;
    let blocks = blocks(out, count, POINTS_PER_BLOCK)?;
    let level = level();
    Ok(share(blocks, threads, go_on, |RowBlock { first, count, out: block }, _| {
        let columns = columns.map(|x| if x.len() == 1 { x } else { &x[first..first + count] });
        in_lanes!(
            level,
            simd => scatter_lanes(zero(simd), columns, count, block),
            else scatter(0.0, columns, count, block)
        );
    }))
}

#[inline(always)]
fn scatter_lanes<S: Simd>(like: f64x8<S>, columns: [&[f64]; 4], count: usize, mut block: Block<'_>) {
    let [theta, ell, bore, fillet] = columns;
    // The rate alone needs fewer numbers of a body.
    if block.is_rate()
        && fillet == [0.0]
        && let [Some(rate), ..] = &mut block.numbers
    {
        return rates::scatter(like, [theta, ell, bore], count, rate);
    }
    scatter(like, columns, count, block);
}

#[inline(always)]
fn scatter<T: Narrow>(like: T, columns: [&[f64]; 4], count: usize, mut block: Block<'_>) {
    let [theta, ell, bore, fillet] = columns;
    let fixed = [ell, bore, fillet].iter().all(|x| x.len() == 1);
    let mut of = load_tubes(like, [ell, bore, fillet], 0);
    for start in (0..count).step_by(T::COUNT) {
        if !fixed {
            of = load_tubes(like, [ell, bore, fillet], start);
        }
        let found = of.found(load(like, theta, start), block.wanted());
        block.put(start, T::COUNT.min(count - start), &found, false);
    }
}

/// The tubes from the index `start` on, in SIMD lanes. Those with rounded edges have their own function, because
/// moments with twice the digits are much code.
#[inline(always)]
fn load_tubes<T: SideBySide>(like: T, of: [&[f64]; 3], start: usize) -> Column<T> {
    if of[2] == [0.0] {
        return Column::tube(load(like, of[0], start), load(like, of[1], start));
    }
    apart(
        like,
        #[inline(always)]
        || {
            let [half, bore, fillet] = of.map(|x| load(like, x, start));
            Column::rounded_tube(half, bore, fillet, of[2].len() > 1)
        },
    )
}
