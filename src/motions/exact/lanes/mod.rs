//! The exact motion of eight bodies at a time in SIMD lanes, if one power series about the start reaches both turning
//! points.
//!
//! ```text
//! tan(theta/2) = tan(theta0/2) (1 + y)/(1 - y),   Q = 1 - 2 c0 y + y^2,   dtheta = 2 s0 dy/Q
//! v = (1 - y^2) w1:    Q v' = -2 (c0 - y) v + 2 s0 (q (1 - y^2) n - p v)
//! n = w3:              Q n' = 2 s0 (r w1 + t n)      p, q, r, t: `contact::reduced`, constant here
//! rounded, with A^, L^, C, S the polynomials A Q, L Q, c Q, s Q and D^ = D Q^2,
//!   N^ = I3 Q^2 + A^^2 + rho C L^:
//!   Q D^ v' = -2 (c0 - y) D^ v + 2 s0 (I3 N^ (1 - y^2) n - I3 a Q L^ v)
//!   Q D^ n' = 2 s0 A^ (I1 a Q w1 + (I3 L^ - I1 rho C) n)
//! F(y) = J theta'^2 = (y - low)(high - y) H(y)
//! y = mid - amp cos u,   dt/du = (2 s0/Q) sqrt(J/H)
//! ```
//! The map from x to y takes the strip |Im x| < pi/2 of `lines`, where the motion is analytic, onto the unit disk. The
//! series of a swing a third as wide as the disk converges like 3^-k, and each term follows from the three before it.
//! dt/du is even, periodic and analytic in u: a cosine series on `K` midpoints gives the time, and the period converges
//! twice as fast.
//!
//! The code has no branches, so that the result in a lane does not depend on the other lanes. Where one panel is too
//! short, a face lands, or no turning point is found, the error becomes too large to be accepted, or NaN;
//! [`exact::Swing`](super::Swing) computes those motions. The error is the sum of the truncation of the two series
//! (from their last terms), the misfit of the turning points and of the time, and the rounding error of F; in the tests
//! of `ensemble` it is never below the true error.

mod extent;
pub(crate) mod march;
mod series;
mod single;
mod turns;

use crate::laws::contact::reduced::Reduced;
use crate::numbers::power::{divide, horner};
use crate::numbers::{Real, arctan2, sin_cos};
use core::f64::consts::{PI, TAU};
pub(crate) use extent::Grip;
use series::{
    angle_at, change_of_theta, lane_lines, parabola, slope_bound, square_of_rate, truncation_bound,
    turning_points,
};
pub(crate) use single::{QuickMotion, QuickTask, roll_narrow_swing};

/// Capacity from which on the number of terms is chosen at run time, so that one code serves series of
/// several lengths. A series with less capacity always uses all of it, and the compiler unrolls its loops.
const RUNTIME_TERMS: usize = 32;

/// Cosines at the midpoints of equal parts of a half turn, with a capacity of K.
#[derive(Debug, Clone)]
pub(crate) struct Midpoints<const K: usize> {
    parts: usize,
    /// cos(k u_j), with k as the first index and j as the second.
    cosines: [[f64; K]; K],
}

impl<const K: usize> Midpoints<K> {
    /// The midpoints of this number of parts: K, or fewer where K is at least `RUNTIME_TERMS`.
    pub fn new(parts: usize) -> Self {
        debug_assert!(parts == K || (parts < K && K >= RUNTIME_TERMS));
        let cosine = |k: usize, j: usize| (PI * (k * (2 * j + 1)) as f64 / (2 * parts) as f64).cos();
        Self { parts, cosines: core::array::from_fn(|k| core::array::from_fn(|j| cosine(k, j))) }
    }

    #[inline(always)]
    fn parts(&self) -> usize {
        if K < RUNTIME_TERMS { K } else { self.parts.min(K) }
    }
}

/// Motions between their turning points, one in each SIMD lane of T, with a capacity of N terms in y and K in u.
pub(crate) struct Swings<T, const N: usize, const K: usize> {
    /// Numbers of terms in y and in u.
    terms: [usize; 2],
    law: Reduced<T>,
    theta: T,
    sin: T,
    cos: T,
    w1: [T; N],
    w3: [T; N],
    /// The function -H = -F/((y - low)(high - y)) as a series in y; its last two terms are not used.
    rest: [T; N],
    mid: T,
    amp: T,
    /// The derivative dt/du as a cosine series; the next field has its values at the midpoints.
    rate: [T; K],
    slope: [T; K],
    /// Time of the start since the lower turning point, negative before it.
    phase: T,
    /// The phase u of the nutation at the start.
    start: T,
    doubt: Uncertainty<T>,
}

/// A time as whole periods and the time since the lower turning point, negative before that point; the phase u with
/// its sine and cosine; and the error of u as a time (`miss`).
struct LanePhase<T> {
    periods: T,
    u: T,
    sin: T,
    cos: T,
    since: T,
    miss: T,
}

struct Uncertainty<T> {
    /// Error of the variable y caused by rounding of F = J theta'^2; also the relative error of a long time.
    noise: T,
    /// Error of the variable y, including the truncation of the series.
    place: T,
    /// Error of a time within the swing; the next field is its growth per unit of a later time.
    time: T,
    per_time: T,
    /// Bound of the derivative of dt/du with respect to u.
    clock_slope: T,
    /// Bound of the change of the state with y; the next fields are bounds of the rates of y and of theta'.
    state_per_y: T,
    y_rate: T,
    tilt_rate: T,
}

/// The derivative dt/du of a swing: its values at the midpoints, its cosine series, and its extremes.
struct Clock<T, const K: usize> {
    slope: [T; K],
    rate: [T; K],
    /// The least H = F/((y - low)(high - y)); the next fields are the least and the greatest dt/du.
    weakest: T,
    fastest: T,
    slowest: T,
}

impl<T: Real, const K: usize> Clock<T, K> {
    /// Computes dt/du from the series `rest` of -H about a start with this sine and cosine, for a swing about `mid`.
    #[inline(always)]
    fn of(
        points: &Midpoints<K>,
        law: &Reduced<T>,
        (sin, cos): (T, T),
        rest: &[T],
        [mid, amp]: [T; 2],
    ) -> Self {
        let parts = points.parts();
        let number = |x: f64| sin.splat(x);
        let (zero, one, two) = (number(0.0), number(1.0), number(2.0));
        let mut slope = [zero; K];
        let (mut weakest, mut fastest, mut slowest) = (number(f64::INFINITY), number(f64::INFINITY), zero);
        for (slope, cosine) in slope[..parts].iter_mut().zip(&points.cosines[1]) {
            let y = mid - amp * number(*cosine);
            let q = (y - two * cos).fma(y, one);
            let h = zero - horner(rest, y);
            *slope = two * sin * (law.inertia(|| angle_at(sin, cos, y, q)) / (h * q * q)).sqrt();
            weakest = h.select_lt(weakest, h, weakest);
            fastest = fastest.min(*slope);
            slowest = slowest.max(*slope);
        }
        let mut rate = [zero; K];
        for (k, rate) in rate[..parts].iter_mut().enumerate() {
            let mut sum = zero;
            for j in 0..parts / 2 {
                let other = slope[parts - 1 - j];
                let mirrored = if k % 2 == 0 { slope[j] + other } else { slope[j] - other };
                sum = mirrored.fma(number(points.cosines[k][j]), sum);
            }
            *rate = sum * number(if k == 0 { 1.0 } else { 2.0 } / parts as f64);
        }
        Self { slope, rate, weakest, fastest, slowest }
    }
}

impl<T: Real, const N: usize, const K: usize> Swings<T, N, K> {
    /// The motions through (theta, w1, w2, w3) at time 0, from one series of `terms` terms about the start;
    /// of N terms where N is below `RUNTIME_TERMS`.
    #[inline(always)]
    pub fn about_start(points: &Midpoints<K>, terms: usize, law: Reduced<T>, start: [T; 4]) -> Self {
        let (n, parts) = (if N < RUNTIME_TERMS { N } else { terms.min(N) }, points.parts());
        let [theta, w1_0, w2, w3_0] = start;
        let (sin, cos) = sin_cos(theta);
        let number = |x: f64| theta.splat(x);
        let (zero, one, two) = (number(0.0), number(1.0), number(2.0));
        let tilting = law.inertia(|| (sin, cos)) * w2 * w2;
        let (mut w1, mut w3, mut force) = ([w1_0; N], [w3_0; N], [tilting; N]);
        lane_lines::<_, N>(&law, sin, cos, &mut w1[..n], &mut w3[..n]);
        square_of_rate::<_, N>(&law, sin, cos, &w1[..n], &w3[..n], &mut force[..n]);

        // The zeros of the parabola are the first estimates of the turning points for Newton's method.
        let [low, high] = turning_points(&force[..n]);
        let mut rest = force;
        let misfit_low = divide(&mut rest[..n], low);
        let misfit_high = divide(&mut rest[..n - 1], high);
        let (mid, amp) = (number(0.5) * (low + high), number(0.5) * (high - low));

        let Clock { slope, rate, weakest, fastest, slowest } =
            Clock::of(points, &law, (sin, cos), &rest[..n - 2], [mid, amp]);

        // F at the start is known to all digits and gives the distance of the start from the nearer end.
        let (above, below) = (zero - low, high);
        let h = zero - rest[0];
        let near = tilting / (h * above.max(below));
        let near_low = |low: T, high: T| above.select_lt(below, low, high);
        let (to_low, to_high) = (near_low(near, above), near_low(below, near));
        let u = two * arctan2(to_low.max(zero).sqrt(), to_high.max(zero).sqrt());
        let (sin_u, cos_u) = sin_cos(u);
        let (since, _) = time(&rate[..parts], u, sin_u, cos_u);
        let phase = zero.select_lt(w2, zero - since, since);

        // The rest of the function estimates the uncertainties.
        let reach = high.max(zero - low);
        let left = one / (one - reach);
        let (of, rim) = (law.at((sin, cos)), &law.shape.rim);
        let terms = of.al * w1_0 * w1_0
            + of.b * w3_0 * w3_0
            + two * (of.k * w1_0 * w3_0).abs()
            + two * (rim.ell.abs() + one)
            + force[0];
        let noise = number(f64::EPSILON) * terms;
        let depth = amp * amp * weakest;
        let cut = truncation_bound(&force[..n], reach) / depth.max(number(f64::MIN_POSITIVE));
        let misfit = (misfit_low.abs() + misfit_high.abs() * amp) / depth.max(number(f64::MIN_POSITIVE));
        let misfit = zero.select_lt(amp, misfit, zero);
        let cut = zero.select_lt(amp, cut, zero);
        // F and its slope are known at the start, so that the rounding error of F grows with the distance from there.
        let off = noise / weakest;
        let per_time = off + cut + misfit;
        let half = rate[0] * number(PI);
        // The tail of the cosine series is extrapolated from pairs of last terms, for even and odd terms may
        // decrease at different rates.
        let pair =
            |k: usize| (rate[parts - k].abs() + rate[parts - k - 1].abs()).max(number(f64::MIN_POSITIVE));
        let (last, before, earlier) = (pair(1), pair(3), pair(5));
        let ratio = (last / before).max(before / earlier).max(number(0.1)).min(number(0.9));
        let series = number(4.0 / parts as f64) * last * ratio / (one - ratio);
        // A swing needs turning points on both sides within reach, and F positive between them.
        let nan = number(f64::NAN);
        let per_time = weakest.select_lt(zero, nan, reach.select_lt(number(0.9), per_time, nan));
        // A start that is outside the turning points by rounding counts as one of them; two that coincide are
        // valid only in a steady state, where F has no slope.
        let outside = zero - number(64.0) * off - number(4.0 * f64::EPSILON) * reach;
        let per_time = above.select_lt(outside, nan, below.select_lt(outside, nan, per_time));
        let apart = number(4.0 * f64::EPSILON) * reach;
        let still = force[1].abs().select_lt(number(8.0 * f64::EPSILON) * terms, per_time, nan);
        let per_time = apart.select_lt(amp, per_time, still);
        let state_per_y =
            two * sin * left * left + slope_bound(&w1[..n], reach) + slope_bound(&w3[..n], reach);
        let y_rate = amp / fastest;
        let mut clock_slope = zero;
        for (k, rate) in rate[..parts].iter().enumerate() {
            clock_slope = rate.abs().fma(number(k as f64), clock_slope);
        }
        Self {
            terms: [n, parts],
            law,
            theta,
            sin,
            cos,
            w1,
            w3,
            rest,
            mid,
            amp,
            rate,
            slope,
            phase,
            start: u,
            doubt: Uncertainty {
                noise: off + number(4.0 * f64::EPSILON),
                place: off
                    + amp * (cut + misfit)
                    + (truncation_bound(&w1[..n], reach) + truncation_bound(&w3[..n], reach)) / state_per_y,
                time: series + half * per_time + slowest * off,
                per_time: per_time + last / half * ratio * ratio + number(4.0 * f64::EPSILON),
                clock_slope,
                state_per_y,
                y_rate,
                tilt_rate: two * sin * left * left * y_rate / fastest,
            },
        }
    }

    /// The number of terms of the power series in y.
    #[inline(always)]
    fn terms(&self) -> usize {
        if N < RUNTIME_TERMS { N } else { self.terms[0].min(N) }
    }

    /// The number of terms of the cosine series in u.
    #[inline(always)]
    fn parts(&self) -> usize {
        if K < RUNTIME_TERMS { K } else { self.terms[1].min(K) }
    }

    /// A number with the same SIMD lanes, from which others can be splatted.
    pub fn like(&self) -> T {
        self.theta
    }

    #[inline(always)]
    pub fn period(&self) -> T {
        self.rate[0] * self.theta.splat(TAU)
    }

    /// Estimated error of the period, and the rounding part of it.
    #[inline(always)]
    pub fn period_error(&self) -> [T; 2] {
        [self.doubt.per_time, self.doubt.noise].map(|x| self.period() * x)
    }

    /// The phase of the motion at time `t`.
    #[inline(always)]
    fn phase_at(&self, t: T) -> LanePhase<T> {
        let number = |x: f64| self.theta.splat(x);
        let (zero, one) = (number(0.0), number(1.0));
        let period = self.period();
        let periods = ((t + self.phase) / period).round();
        let since = (zero - periods).fma(period, t) + self.phase;
        let target = since.abs();
        let mut u = target / self.rate[0];
        let steps = 3 + usize::from(N > 16) + usize::from(N > 32);
        let (mut sin, mut cos, mut step) = (zero, one, zero);
        for _ in 0..steps {
            u = u.max(zero).min(number(PI));
            (sin, cos) = sin_cos(u);
            let (time, slope) = time(&self.rate[..self.parts()], u, sin, cos);
            step = (target - time) / slope;
            u = u + step;
        }
        // The last step is short: the sine and cosine are turned by it, and the error of Newton's method is quadratic
        // in it.
        let half_square = number(0.5) * step * step;
        let turn = step * (one - half_square * number(1.0 / 3.0));
        LanePhase {
            periods,
            u,
            sin: sin + turn.fma(cos, zero - half_square * sin),
            cos: cos - turn.fma(sin, half_square * cos),
            since,
            miss: half_square * (self.doubt.clock_slope + half_square * self.rate[0]),
        }
    }

    /// The variable y at a phase u, and sin theta, cos theta, w1, |w2| and w3 there.
    #[inline(always)]
    fn motion(&self, sin_u: T, cos_u: T) -> (T, [T; 5]) {
        let one = self.theta.splat(1.0);
        let y = self.mid - self.amp * cos_u;
        let q = (y - (self.cos + self.cos)).fma(y, one);
        let (s, c) = angle_at(self.sin, self.cos, y, q);
        let inertia = self.law.inertia(|| (s, c));
        let n = self.terms();
        let tilt = self.amp * sin_u * (-horner(&self.rest[..n - 2], y) / inertia).sqrt();
        (y, [s, c, horner(&self.w1[..n], y), tilt, horner(&self.w3[..n], y)])
    }

    /// The state (theta, w1, w2, w3) at time `t`, the largest of its estimated errors, and the rounding part of this
    /// error, which more terms would not reduce.
    #[inline(always)]
    pub fn state(&self, t: T) -> ([T; 4], T, T) {
        self.state_at(t, &self.phase_at(t))
    }

    /// The state and its errors at time `t`, from the place at that time.
    #[inline(always)]
    fn state_at(&self, t: T, at: &LanePhase<T>) -> ([T; 4], T, T) {
        let number = |x: f64| self.theta.splat(x);
        let zero = number(0.0);
        let (y, [_, _, w1, tilt, w3]) = self.motion(at.sin, at.cos);
        let w2 = at.since.select_lt(zero, tilt, zero - tilt);
        let doubt = &self.doubt;
        let rounded = number(f64::EPSILON) * (t.abs() + self.period());
        let size = number(8.0 * f64::EPSILON) * (number(1.0) + w1.abs() + w3.abs());
        let of = |place: T, late: T| {
            doubt.state_per_y * (place + doubt.y_rate * late)
                + doubt.tilt_rate * late
                + place * doubt.y_rate
                + size
        };
        let error = of(doubt.place, self.time_error_at(t, at));
        let least = of(doubt.noise, doubt.noise * (t.abs() + self.period()) + rounded);
        ([self.theta + change_of_theta(self.sin, self.cos, y), w1, w2, w3], error, least)
    }

    /// Error of the time at which the motion reaches the phase `at`.
    #[inline(always)]
    fn time_error_at(&self, t: T, at: &LanePhase<T>) -> T {
        let rounded = self.theta.splat(f64::EPSILON) * (t.abs() + self.period());
        self.doubt.time + at.miss + self.doubt.per_time * t.abs() + rounded
    }
}

/// Approximate width of a swing: the larger |y| at the zeros of the parabola that approximates F = J theta'^2; NaN
/// without zeros.
#[inline(always)]
pub(crate) fn width<T: Real>(law: &Reduced<T>, [theta, w1, w2, w3]: [T; 4]) -> T {
    let (sin, cos) = sin_cos(theta);
    let zero = theta.splat(0.0);
    let tilting = law.inertia(|| (sin, cos)) * w2 * w2;
    if law.round {
        // dF/dtheta is twice the tilting torque, dtheta/dy = 2 s0 and d2theta/dy2 = 4 s0 c0.
        let along = law.tilting_along((sin, cos), w1, w3);
        let steep = (sin + sin) * (along.value + along.value);
        let bent = (sin + sin) * (sin + sin) * along.slope + steep * cos;
        let [low, high] = parabola(&[tilting, steep, bent]);
        return high.max(zero - low) + (low + high) * zero;
    }
    let (mut w1, mut w3, mut force) = ([w1; 3], [w3; 3], [zero; 3]);
    force[0] = tilting;
    lane_lines::<_, 3>(law, sin, cos, &mut w1, &mut w3);
    square_of_rate::<_, 3>(law, sin, cos, &w1, &w3, &mut force);
    let [low, high] = parabola(&force);
    high.max(zero - low) + (low + high) * zero
}

/// Time since the lower turning point at the phase u, and dt/du (Clenshaw's sums).
#[inline(always)]
fn time<T: Real>(rate: &[T], u: T, sin: T, cos: T) -> (T, T) {
    let zero = u.splat(0.0);
    let double = cos + cos;
    let (mut s1, mut s2, mut c1, mut c2) = (zero, zero, zero, zero);
    for k in (1..rate.len()).rev() {
        let term = rate[k] * u.splat(1.0 / k as f64);
        (s1, s2) = (double.fma(s1, term - s2), s1);
        (c1, c2) = (double.fma(c1, rate[k] - c2), c1);
    }
    (rate[0].fma(u, s1 * sin), c1.fma(cos, rate[0] - c2))
}
