//! RK4 in SIMD lanes with a fixed step, which is used on request.
//!
//! ```text
//! (s, c, w1, w2, w3):   s' = -c w2,   c' = s w2          sine and cosine of theta are integrated, too
//! ```
//! The steps compute no sine, and theta is an arc tangent at the requested times. The sums are not compensated: the
//! rounding error of n steps is n^0.5 ulp. [`rk4`](crate::methods::rk4) has the method.

use super::Job;
use super::rows::StartLanes;
use crate::laws::contact::reduced::Rates;
use crate::methods::rk4::change;
use crate::numbers::{Real, arctan2, here, sin_cos};

/// Number of RK4 steps between two calls of `go_on`.
const STEPS_PER_BREATH: u64 = 4096;

/// The time derivatives of (s, c, w1, w2, w3), with the sine s and the cosine c of theta.
#[inline(always)]
fn derivative<T: Real>(rates: &Rates<T>, [s, c, w1, w2, w3]: [T; 5]) -> [T; 5] {
    let [d1, d2, d3] = rates.at(s, c, [w1, w2, w3]);
    [-(c * w2), s * w2, d1, d2, d3]
}

/// The variables (s, c, w1, w2, w3) after one RK4 step of length `h`.
#[inline(always)]
fn advance<T: Real>(rates: &Rates<T>, mut y: [T; 5], h: f64) -> [T; 5] {
    let rate = here(
        #[inline(always)]
        |y: &[T; 5]| derivative(rates, *y),
    );
    let change = change(rate, &y, &rate(&y), h);
    for (y, change) in y.iter_mut().zip(change) {
        *y = *y + change;
    }
    y
}

/// The motions in SIMD lanes after `steps_taken` whole steps from the start.
pub(super) struct FixedSteps<T> {
    rates: Rates<T>,
    y: [T; 5],
    step: f64,
    steps_taken: u64,
}

impl<T: Real> FixedSteps<T> {
    #[inline(always)]
    pub fn new(job: &Job<'_>, row: &StartLanes<T>, step: f64) -> Self {
        let [theta, w1, w2, w3] = row.state;
        let (s, c) = sin_cos(theta);
        let step = if job.span() < 0.0 { -step.abs() } else { step };
        Self {
            rates: Rates::of(job.contact(), &row.shape, row.round),
            y: [s, c, w1, w2, w3],
            step,
            steps_taken: 0,
        }
    }

    /// The states at a time that is not before the last requested time; between two whole steps a shortened step
    /// follows the earlier one. None if `go_on` returns false.
    #[inline(always)]
    pub fn advance_to(&mut self, t: f64, go_on: &mut dyn FnMut() -> bool) -> Option<[T; 4]> {
        let whole = (t / self.step).floor() as u64;
        while self.steps_taken < whole {
            if !go_on() {
                return None;
            }
            let some = (whole - self.steps_taken).min(STEPS_PER_BREATH);
            let mut y = self.y;
            for _ in 0..some {
                y = advance(&self.rates, y, self.step);
            }
            (self.y, self.steps_taken) = (y, self.steps_taken + some);
        }
        let rest = t - whole as f64 * self.step;
        let [s, c, w1, w2, w3] = if rest == 0.0 { self.y } else { advance(&self.rates, self.y, rest) };
        let zero = s.splat(0.0);
        let acute = arctan2(s, c.abs());
        let theta = c.select_lt(zero, s.splat(core::f64::consts::PI) - acute, acute);
        Some([theta, w1, w2, w3])
    }
}
