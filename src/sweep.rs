//! Dense maps: every inclination against every body, on lanes and threads.
//!
//! No formula of its own: each point is [`steady`](crate::steady) and
//! [`stability`](crate::stability) in eight lanes, with the same bits as the single call, for any
//! thread count, position and SIMD width. What is not asked for is not computed.

use crate::body::Body;
use crate::real::{LANES, SinCos, Sum, sincos};
use crate::stability::{Moments, region_of, rolling_at_rest, smooth_at_rest};
use crate::steady::{rate_of, terms};
use fearless_simd::{Simd, SimdBase, SimdFrom, f64x8};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Points in a block: a thread takes one at a time, and asks in between whether to go on.
const BLOCK: usize = 1 << 16;

/// The quantities of a map, each a row-major array (inclination, body); `None` costs nothing.
#[derive(Debug, Default)]
pub struct Portrait<'a> {
    /// Reduced rotation rate, NaN where there is no steady state.
    pub rate: Option<&'a mut [f64]>,
    /// Squared nutation frequency when rolling, negative where unstable.
    pub kappa_rolling: Option<&'a mut [f64]>,
    /// Squared nutation frequency on a smooth table.
    pub kappa_smooth: Option<&'a mut [f64]>,
    /// Code of the [`Region`](crate::stability::Region).
    pub region: Option<&'a mut [u8]>,
}

impl<'a> Portrait<'a> {
    /// The first `points` of each, and the rest.
    fn split(self, points: usize) -> (Self, Self) {
        fn cut<T>(x: Option<&mut [T]>, at: usize) -> (Option<&mut [T]>, Option<&mut [T]>) {
            x.map(|x| x.split_at_mut(at)).unzip()
        }
        let (rate, rate_rest) = cut(self.rate, points);
        let (kappa_rolling, rolling_rest) = cut(self.kappa_rolling, points);
        let (kappa_smooth, smooth_rest) = cut(self.kappa_smooth, points);
        let (region, region_rest) = cut(self.region, points);
        let rest = Self {
            rate: rate_rest,
            kappa_rolling: rolling_rest,
            kappa_smooth: smooth_rest,
            region: region_rest,
        };
        (Self { rate, kappa_rolling, kappa_smooth, region }, rest)
    }

    fn fits(&self, points: usize) -> bool {
        let floats = [&self.rate, &self.kappa_rolling, &self.kappa_smooth];
        floats.into_iter().flatten().all(|x| x.len() == points)
            && self.region.iter().all(|x| x.len() == points)
    }
}

/// Fills the map of the steady states with the centre at rest: `theta.len()` rows of
/// `bodies.len()` points. A body that is `None` gives NaN and `Region::Invalid`.
///
/// `threads` workers, the caller among them, which asks `go_on` about fifty times a second.
/// Returns whether it finished; if not, the contents are unspecified.
///
/// # Panics
/// If an array of `out` does not hold `theta.len() * bodies.len()` numbers.
pub fn portrait(
    theta: &[f64],
    bodies: &[Option<Body>],
    out: Portrait<'_>,
    threads: usize,
    mut go_on: impl FnMut() -> bool,
) -> bool {
    assert!(
        out.fits(theta.len() * bodies.len()),
        "an array does not have theta.len() * bodies.len() numbers"
    );
    if theta.is_empty() || bodies.is_empty() {
        return true;
    }
    let columns: Vec<_> = bodies.chunks(LANES).map(Moments::gather).collect();
    let rows = (BLOCK / bodies.len()).max(1);
    let mut rest = out;
    let mut blocks = Vec::with_capacity(theta.len().div_ceil(rows));
    for theta in theta.chunks(rows) {
        let (block, after) = rest.split(theta.len() * bodies.len());
        blocks.push((theta, block));
        rest = after;
    }
    let queue = Mutex::new(blocks.into_iter());
    let stop = AtomicBool::new(false);
    let level = crate::level();
    let work = |go_on: &mut dyn FnMut() -> bool| {
        loop {
            let next = queue.lock().ok().and_then(|mut blocks| blocks.next());
            let Some((theta, block)) = next else { return };
            if stop.load(Ordering::Relaxed) || !go_on() {
                stop.store(true, Ordering::Relaxed);
                return;
            }
            fearless_simd::dispatch!(level, simd => fill(simd, theta, &columns, bodies.len(), block));
        }
    };
    let mut asked = Instant::now();
    let mut ask = || {
        if asked.elapsed() < Duration::from_millis(20) {
            return true;
        }
        asked = Instant::now();
        go_on()
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.max(1) {
            scope.spawn(|| work(&mut || true));
        }
        work(&mut ask);
    });
    !stop.into_inner()
}

/// One block: some rows of the map.
#[inline(always)]
fn fill<S: Simd>(
    simd: S,
    theta: &[f64],
    columns: &[Moments<[f64; LANES]>],
    width: usize,
    block: Portrait<'_>,
) {
    let mut rest = block;
    for &theta in theta {
        let (row, after) = rest.split(width);
        rest = after;
        let Portrait { mut rate, mut kappa_rolling, mut kappa_smooth, mut region } = row;
        let splat = |x: f64| f64x8::splat(simd, x);
        let one = sincos(theta);
        let wide = |x: Sum<f64>| Sum { hi: splat(x.hi), lo: splat(x.lo) };
        let angle = SinCos { sin: wide(one.sin), cos: wide(one.cos) };
        let theta = splat(theta);
        for (column, start) in columns.iter().zip((0..width).step_by(LANES)) {
            let of = column.map(|x| f64x8::simd_from(simd, x));
            let terms = terms(&angle, of.ell, of.excess);
            if let Some(out) = &mut rate {
                store(rate_of(theta, angle.sin, &terms), &mut out[start..]);
            }
            if kappa_rolling.is_none() && kappa_smooth.is_none() && region.is_none() {
                continue;
            }
            let rolling = rolling_at_rest(theta, &angle, &terms, &of);
            let smooth = smooth_at_rest(theta, &angle, &terms, &of);
            if let Some(out) = &mut kappa_rolling {
                store(rolling, &mut out[start..]);
            }
            if let Some(out) = &mut kappa_smooth {
                store(smooth, &mut out[start..]);
            }
            if let Some(out) = &mut region {
                let codes = region_of(theta, of.ell, &terms, smooth, rolling);
                for (slot, code) in out[start..].iter_mut().zip(*codes) {
                    *slot = code as u8;
                }
            }
        }
    }
}

/// The lanes that fit.
#[inline(always)]
fn store<S: Simd>(x: f64x8<S>, out: &mut [f64]) {
    match out.first_chunk_mut::<LANES>() {
        Some(out) => *out = *x,
        None => out.iter_mut().zip(*x).for_each(|(slot, x)| *slot = x),
    }
}
