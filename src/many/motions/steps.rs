//! RK4 in SIMD lanes at a fixed step, which is used on request.
//!
//! ```text
//! (s, c, w1, w2, w3):   s' = -c w2,   c' = s w2          sine and cosine of theta are integrated, too
//! ```
//! The steps compute no sine, and theta is computed as an arc tangent at the wanted times. The sums are not
//! compensated: the rounding error of n steps is n^0.5 ulp. [`rk4`](crate::methods::rk4) has the method.

use super::Job;
use super::rows::StartLanes;
use crate::laws::contact::reduced::Rates;
use crate::numbers::{Real, arctan2, sin_cos};

/// Number of steps between two calls of `go_on`.
const STEPS_PER_BREATH: u64 = 4096;

/// The time derivative of (s, c, w1, w2, w3).
#[inline(always)]
fn derivative<T: Real>(rates: &Rates<T>, [s, c, w1, w2, w3]: [T; 5]) -> [T; 5] {
    let [d1, d2, d3] = rates.at(s, c, [w1, w2, w3]);
    [-(c * w2), s * w2, d1, d2, d3]
}

/// The sum `from + by k`.
#[inline(always)]
fn ahead<T: Real>(k: &[T; 5], by: f64, from: &[T; 5]) -> [T; 5] {
    let by = k[0].splat(by);
    let mut sum = *from;
    for (sum, k) in sum.iter_mut().zip(k) {
        *sum = k.mac(by, *sum);
    }
    sum
}

#[inline(always)]
fn advance<T: Real>(rates: &Rates<T>, y: [T; 5], h: f64) -> [T; 5] {
    let k = derivative(rates, y);
    let sum = ahead(&k, h / 6.0, &y);
    let k = derivative(rates, ahead(&k, h / 2.0, &y));
    let sum = ahead(&k, h / 3.0, &sum);
    let k = derivative(rates, ahead(&k, h / 2.0, &y));
    let sum = ahead(&k, h / 3.0, &sum);
    let k = derivative(rates, ahead(&k, h, &y));
    ahead(&k, h / 6.0, &sum)
}

/// Motions after `made` whole steps from the start.
pub(super) struct FixedSteps<T> {
    rates: Rates<T>,
    y: [T; 5],
    step: f64,
    made: u64,
}

impl<T: Real> FixedSteps<T> {
    #[inline(always)]
    pub fn new(job: &Job<'_>, row: &StartLanes<T>, step: f64) -> Self {
        let [theta, w1, w2, w3] = row.state;
        let (s, c) = sin_cos(theta);
        let step = if job.span() < 0.0 { -step.abs() } else { step };
        Self { rates: Rates::of(job.contact(), &row.shape, row.round), y: [s, c, w1, w2, w3], step, made: 0 }
    }

    /// The states at a time that is not before that of the last call; between two whole steps a shortened
    /// step follows the earlier one. None if `go_on` returns false.
    #[inline(always)]
    pub fn to(&mut self, t: f64, go_on: &mut dyn FnMut() -> bool) -> Option<[T; 4]> {
        let whole = (t / self.step).floor() as u64;
        while self.made < whole {
            if !go_on() {
                return None;
            }
            let some = (whole - self.made).min(STEPS_PER_BREATH);
            let mut y = self.y;
            for _ in 0..some {
                y = advance(&self.rates, y, self.step);
            }
            (self.y, self.made) = (y, self.made + some);
        }
        let rest = t - whole as f64 * self.step;
        let [s, c, w1, w2, w3] = if rest == 0.0 { self.y } else { advance(&self.rates, self.y, rest) };
        let zero = s.splat(0.0);
        let acute = arctan2(s, c.abs());
        let theta = c.select_lt(zero, s.splat(core::f64::consts::PI) - acute, acute);
        Some([theta, w1, w2, w3])
    }
}
