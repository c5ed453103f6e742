//! RK4 over lanes, at a fixed step: for those who ask for RK4.
//!
//! ```text
//! (s, c, w1, w2, w3):   s' = -c w2,   c' = s w2          sine and cosine of theta carried along
//! ```
//! No sine is computed on the way, and theta is their arc tangent where it is wanted. The sums are not
//! compensated: round-off is that of n steps, n^0.5 ulp. [`rk4`](crate::rk4) has the method.

use super::Job;
use super::lanes::Row;
use crate::law::Rates;
use crate::real::{Real, arctan2, sin_cos};

/// Steps between two looks at whether to go on.
const PATIENCE: u64 = 4096;

/// The change of (s, c, w1, w2, w3) with time.
#[inline(always)]
fn rate<T: Real>(rates: &Rates<T>, [s, c, w1, w2, w3]: [T; 5]) -> [T; 5] {
    let [d1, d2, d3] = rates.at(s, c, [w1, w2, w3]);
    [-(c * w2), s * w2, d1, d2, d3]
}

/// `from + by k`.
#[inline(always)]
fn ahead<T: Real>(k: &[T; 5], by: f64, from: &[T; 5]) -> [T; 5] {
    let by = k[0].splat(by);
    let mut sum = *from;
    for (sum, k) in sum.iter_mut().zip(k) {
        *sum = k.mac(by, *sum);
    }
    sum
}

/// One step.
#[inline(always)]
fn advance<T: Real>(rates: &Rates<T>, y: [T; 5], h: f64) -> [T; 5] {
    let k = rate(rates, y);
    let sum = ahead(&k, h / 6.0, &y);
    let k = rate(rates, ahead(&k, h / 2.0, &y));
    let sum = ahead(&k, h / 3.0, &sum);
    let k = rate(rates, ahead(&k, h / 2.0, &y));
    let sum = ahead(&k, h / 3.0, &sum);
    let k = rate(rates, ahead(&k, h, &y));
    ahead(&k, h / 6.0, &sum)
}

/// The states at the times of a job; one between two steps is a shortened step from the one before. Fewer, if
/// it is told to stop.
#[inline(always)]
pub(super) fn integrate<T: Real>(
    job: &Job<'_>,
    row: &Row<T>,
    step: f64,
    still: &mut dyn FnMut() -> bool,
) -> Vec<[T; 4]> {
    let [ell, i1, i3] = row.body;
    let rates = Rates::of(job.contact, ell, i1, i3);
    let [theta, w1, w2, w3] = row.state;
    let (s, c) = sin_cos(theta);
    let mut y = [s, c, w1, w2, w3];
    let mut made = 0;
    let mut states = Vec::with_capacity(job.times.len());
    let step = if job.span() < 0.0 { -step.abs() } else { step };
    for t in job.times {
        let whole = (t / step).floor() as u64;
        while made < whole {
            if !still() {
                return states;
            }
            let some = (whole - made).min(PATIENCE);
            for _ in 0..some {
                y = advance(&rates, y, step);
            }
            made += some;
        }
        let rest = t - whole as f64 * step;
        let [s, c, w1, w2, w3] = if rest == 0.0 { y } else { advance(&rates, y, rest) };
        let zero = s.splat(0.0);
        let acute = arctan2(s, c.abs());
        let theta = c.select_lt(zero, s.splat(core::f64::consts::PI) - acute, acute);
        states.push([theta, w1, w2, w3]);
    }
    states
}
