//! The last part of a slip, which is extrapolated to the time at which the contact point comes to rest.

use super::{Own, Slide};
use crate::methods::flow::{Flow, FlowPlace};
use crate::motions::dry::creep::rests_below;
use crate::motions::walk::numbers::{BodyNumbers, SIN, TIME, U2, UH, W2, sum};
use crate::motions::walk::slip_over;
/// Bound of the error by the extrapolated end of a slip, in tolerances. The true error is far smaller: with a bound
/// of 1 it was at most 0.1, and none of the error estimates of 432 random motions was too small; with a bound of 100
/// it was up to 7, and two estimates were too small.
const AT_ONCE: f64 = 0.01;
/// SIMD code leaves the end of a slip to a single integration at this share of the speed that friction takes from the
/// slip in the longest extrapolated time, unless the slip starts in SIMD code with less than `MUCH_FASTER` times that
/// speed.
#[cfg(feature = "many")]
const SHARE_OF_LAST: f64 = 0.5;
#[cfg(feature = "many")]
const MUCH_FASTER: f64 = 10.0;
/// Largest angle, in radians, between the direction of a slip whose end is extrapolated and its mean direction.
const STRAIGHT: f64 = 1e-2;
/// Angle, in radians, between the direction of a slip and the neighbouring ones that give the derivative of its
/// turning rate.
const BESIDE: f64 = 1e-3;

impl<L: Own> Slide<L> {
    /// The speed below which a slip counts as zero.
    pub fn over(&self) -> f64 {
        self.law.patch().map_or(slip_over(self.law.dry, self.law.strength), rests_below)
    }

    /// The speed at which a slip that SIMD code has followed is left to a single integration, since about there
    /// [`Slide::ends_at_once`] can end it. A slip that begins hardly faster stays in SIMD code to its end.
    #[cfg(feature = "many")]
    pub fn over_in_lanes<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let time = (AT_ONCE * self.tol).cbrt() * self.calm(y) / 3.0;
        // Friction slows a slip along the lean by mu N or more.
        let near = SHARE_OF_LAST * self.law.strength * time;
        let [u_h, u_2] = y.slip();
        if self.law.dry && u_h.hypot(u_2) > MUCH_FASTER * near { near.max(self.over()) } else { self.over() }
    }

    /// The state vector at the end of a slip, by a single step if its error is below `AT_ONCE` tolerances; else None.
    /// The error is the cube of the angle by which the body turns meanwhile, or this angle times the square of that
    /// by which the slip turns.
    ///
    /// ```text
    /// r alpha' = -k (alpha - a),   r = r0 (1 - t/T),   p = k T/r0:   the mean of alpha is alpha0 + (a - alpha0) p/(1 + p)
    /// ```
    /// The direction alpha of the slip approaches the direction a, which changes with the motion and is taken in the
    /// middle of the remaining time T. The step uses the rates in the middle of T, in the mean direction.
    #[inline(never)]
    pub(super) fn ends_at_once<const N: usize>(&self, place: &FlowPlace<N>) -> Option<[f64; N]> {
        let ([u, v], [du, dv]) = (place.y.slip(), place.rate.slip());
        let (square, pace) = (u * u + v * v, place.rate[TIME]);
        let left = square / -(u * du + v * dv);
        let (time, allowed) = (left * pace, AT_ONCE * self.tol);
        let third = |turns: f64| turns * turns * turns < allowed;
        // The angle `turns` is at least the time that is left.
        if self.settled || !(left > 0.0 && third(time)) {
            return None;
        }
        let falls = (place.y[W2] / place.y[SIN]).abs();
        let turns = (time * (3.0 / self.calm(&place.y)).max(falls)).max(left / self.rooted(place));
        if !third(turns) {
            return None;
        }
        // The torque of the direction by an angle `by` beside that of the slip, which has the size `share` at the
        // numbers `y`.
        let beside = |by: f64, share: f64| [share * (u - by * v), share * (v + by * u)];
        let bends = |y: &[f64; N], by: f64, share: f64| {
            self.asks_drive(y);
            let [u, v] = beside(by, share);
            let [along, aside] = sum(self.acts(y.angle(), y.w(), [u, v]).u, self.pull(y));
            (u * aside - v * along) / (share * square)
        };
        // A slip that leaves its direction the faster, the slower it is, may pass by zero, however near.
        let returns = (bends(&place.y, -BESIDE, 1.0) - bends(&place.y, BESIDE, 1.0)) / (2.0 * BESIDE);
        let share = time / (1.0 + time * returns);
        let first = share * bends(&place.y, 0.0, 1.0);
        let middle = |rates: &[f64; N], by: f64| {
            let mut y: [f64; N] = core::array::from_fn(|i| place.y[i] + 0.5 * time * rates[i]);
            [y[UH], y[U2]] = beside(by, 0.5);
            y
        };
        let in_time = |y: &[f64; N]| {
            let all = self.rates(y);
            all.map(|rate| rate / all[TIME])
        };
        let mut begin = place.y;
        [begin[UH], begin[U2]] = beside(first, 1.0);
        let half = middle(&in_time(&begin), first);
        let mean = share * (returns * first + bends(&half, first, 0.5));
        if !(returns > 0.0 && mean.abs().max(first.abs()) < STRAIGHT && turns * mean * mean < allowed) {
            return None;
        }
        let half = middle(&in_time(&half), mean);
        let rates = in_time(&half);
        let ([u, v], [du, dv]) = (half.slip(), rates.slip());
        let lasts = 2.0 * (u * u + v * v) / -(u * du + v * dv);
        if !(lasts > 0.5 * time && lasts < 2.0 * time) {
            return None;
        }
        let mut end: [f64; N] = core::array::from_fn(|i| place.y[i] + lasts * rates[i]);
        (end[UH], end[U2]) = (0.0, 0.0);
        Some(end)
    }
}

/// The state vector at the end of a slip that is slower than `over`, extrapolated linearly; None for a faster slip.
pub(super) fn vanished<const N: usize>(place: &FlowPlace<N>, over: f64) -> Option<[f64; N]> {
    let [u_h, u_2] = place.y.slip();
    let speed = u_h.hypot(u_2);
    // `slowing` is the rate in sigma at which the speed of the slip falls.
    let slowing = -(u_h * place.rate[UH] + u_2 * place.rate[U2]) / speed;
    if speed > over || slowing <= 0.0 && speed > 0.0 {
        return None;
    }
    let left = if speed > 0.0 { speed / slowing } else { 0.0 };
    let mut y: [f64; N] = core::array::from_fn(|i| place.y[i] + left * place.rate[i]);
    (y[UH], y[U2]) = (0.0, 0.0);
    Some(y)
}
