//! Angles and contact path of one motion: Fourier series in the phase u of the nutation, which grows from period to
//! period.
//!
//! ```text
//! dphi/du = (w1/s) dt/du          = sum p_k cos(k u)        phi = p_0 u + omega,  omega = sum p_k sin(k u)/k
//! dpsi/du = (w3 - w1 c/s) dt/du   = sum q_k cos(k u)
//! d(x + i y)/du = i e^(i p_0 u) h,   h = e^(i omega) (A dpsi/du + i rho dtheta/du) = sum c_k e^(i k u)
//! x + i y = sum c_k (e^(i (p_0 + k) u) - 1)/(p_0 + k),   k of both signs, c_k real
//! ```
//! The module [`pose`](crate::laws::pose) has the rates. About the turning points phi is odd and theta even in u, so that
//! h(-u) is the conjugate of h(u). The path drifts by the term whose p_0 + k is nearest to 0, which is integrated as an
//! arc. On a smooth table there is no path to sum.
//!
//! Error: the error of the rates times the time; the error of the time times the rates; the truncation of the series,
//! from their last terms; and the error of the angles times the extent of the path. In the tests of `poses` the sum is
//! never below the true error.

use super::{Midpoints, Swings};
use crate::laws::contact::Contact;
use crate::laws::pose::{Angle, Pose};
use crate::numbers::{LANES, Real, Sum, sin_cos};
use core::f64::consts::TAU;
use fearless_simd::{ExtractToken, Simd, SimdBase, f64x8};
use nalgebra::{Complex, Point2};

/// The series of the angles and of the path of a motion.
pub(super) struct PeriodAngleSeries<const K: usize> {
    /// The cosine series of dphi/du; the next field is that of dpsi/du.
    p: [f64; K],
    q: [f64; K],
    /// The coefficients c_k/(p_0 + k) of the contact path for k from 0 on; the next field has those for -k. The
    /// coefficient of the term that drifts is 0.
    up: [f64; K],
    down: [f64; K],
    /// The index k of the term of the contact path that drifts, and its coefficient c_k.
    drift: (f64, f64),
    /// The place at which the motion starts.
    start: PeriodPoint,
    doubt: AngleErrors,
}

/// A place on a swing: whole periods; the phase u since the lower turning point, negative before it; and e^(i u).
#[derive(Debug, Clone, Copy)]
pub(super) struct PeriodPoint {
    pub periods: f64,
    pub u: f64,
    pub cos: f64,
    pub sin: f64,
}

/// The uncertainties of the series of angles and contact path.
struct AngleErrors {
    /// Error of an angle per unit of time; the next fields are the error per error of the time, and a constant error.
    per_time: f64,
    fastest: f64,
    angle: f64,
    /// Error of the contact path per unit of u; the next fields are a constant error, and the greatest distance by
    /// which a radian moves the path.
    per_u: f64,
    place: f64,
    reach: f64,
}

/// The cosine coefficients of an even function from its values at the midpoints.
fn cosines<const K: usize>(points: &Midpoints<K>, values: &[f64; K]) -> [f64; K] {
    let mut found = [0.0; K];
    for (k, (found, cosines)) in found.iter_mut().zip(&points.cosines).enumerate() {
        let sum: f64 = values.iter().zip(cosines).map(|(value, cosine)| value * cosine).sum();
        *found = sum * if k == 0 { 1.0 } else { 2.0 } / K as f64;
    }
    found
}

/// The value sin(k u_j) at the midpoint `j`, for k from 1 on.
fn sine<const K: usize>(points: &Midpoints<K>, k: usize, j: usize) -> f64 {
    let sine = points.cosines[K - k][j];
    if j.is_multiple_of(2) { sine } else { -sine }
}

/// The truncation error of a series, extrapolated from its last terms, and the size of the first two terms that are
/// left out.
fn truncation_error<const K: usize>(size: impl Fn(usize) -> f64) -> [f64; 2] {
    let pair = |k: usize| (size(K - k) + size(K - k - 1)).max(f64::MIN_POSITIVE);
    let (last, before, earlier) = (pair(1), pair(3), pair(5));
    let ratio = (last / before).max(before / earlier).clamp(0.1, 0.9);
    [last * ratio / (1.0 - ratio), last * ratio * ratio]
}

impl<const K: usize> PeriodAngleSeries<K> {
    /// Computes the series for a motion that is the same in all SIMD lanes; `start` is its place at time 0.
    #[inline(always)]
    pub fn of<S: Simd, const N: usize>(
        swing: &Swings<f64x8<S>, N, K>,
        points: &Midpoints<K>,
        start: PeriodPoint,
    ) -> Self {
        let (like, one) = (swing.theta, swing.theta.splat(1.0));
        let (mut phi, mut psi, mut lean, mut round) = ([0.0; K], [0.0; K], [0.0; K], [0.0; K]);
        let (mut fastest, mut steepest, mut swiftest, mut slowest) = (0f64, 1f64, 0f64, 0f64);
        for first in (0..K).step_by(LANES) {
            let (mut cos, mut slope) = ([1.0; LANES], [1.0; LANES]);
            for k in 0..LANES.min(K - first) {
                (cos[k], slope[k]) = (points.cosines[1][first + k], swing.slope[first + k][0]);
            }
            let (cos, slope) =
                (f64x8::from_slice(like.token(), &cos), f64x8::from_slice(like.token(), &slope));
            let (_, [s, c, w1, tilt, w3]) = swing.motion(((one - cos) * (one + cos)).sqrt(), cos);
            let (turning, spinning) = (w1 / s, w3 - w1 * c / s);
            let (turn, spin, up) = (turning * slope, spinning * slope, tilt * slope);
            let radius = swing.law.shape.rim.radius((s, c));
            for k in 0..LANES.min(K - first) {
                (phi[first + k], psi[first + k]) = (turn[k], spin[k]);
                (round[first + k], lean[first + k]) =
                    (radius[k] * spin[k], swing.law.shape.rim.rho[k] * up[k]);
                fastest = fastest.max(turning[k].abs()).max(spinning[k].abs());
                steepest = steepest.max(1.0 / s[k]);
                swiftest = swiftest.max(1.0 + w1[k].abs() + w3[k].abs());
                slowest = slowest.max(slope[k]);
            }
        }
        let (p, q) = (cosines(points, &phi), cosines(points, &psi));
        let of = &swing.doubt;
        let unsure = of.state_per_y[0] * of.place[0] + 2.0 * f64::EPSILON * swiftest;
        let per_time = unsure * steepest * (2.0 + fastest);
        let [p_tail, q_tail] = [truncation_error::<K>(|k| p[k].abs()), truncation_error::<K>(|k| q[k].abs())];
        let mut doubt = AngleErrors {
            per_time: per_time + p_tail[1].max(q_tail[1]) / swing.rate[0][0],
            fastest,
            angle: 4.0 / K as f64 * p_tail[0].max(q_tail[0]) + 4.0 * f64::EPSILON,
            per_u: slowest * per_time,
            place: 0.0,
            reach: 1.0,
        };
        let (mut up, mut down, mut drift) = ([0.0; K], [0.0; K], (0.0, 0.0));
        if swing.law.contact == Contact::Rolling {
            for j in 0..K {
                let omega: f64 = (1..K).map(|k| p[k] * sine(points, k, j) / k as f64).sum();
                let (sin, cos) = omega.sin_cos();
                // The real part of h is even in u, the imaginary part odd.
                let (even, odd) = (round[j] * cos - lean[j] * sin, round[j] * sin + lean[j] * cos);
                up[0] += even / K as f64;
                for k in 1..K {
                    let (even, odd) = (even * points.cosines[k][j], odd * sine(points, k, j));
                    up[k] += (even + odd) / K as f64;
                    down[k] += (even - odd) / K as f64;
                }
            }
            let [left, next] = truncation_error::<K>(|k| up[k].abs() + down[k].abs());
            let nearest = (-p[0]).round_ties_even();
            let size: f64 = up.iter().chain(&down).map(|c| c.abs()).sum();
            // The error of a term that drifts grows with u if the term is among the last or is left out.
            doubt.per_u +=
                4.0 * f64::EPSILON * size + if nearest.abs() < (K / 2) as f64 { next } else { left };
            doubt.place = 4.0 / K as f64 * left;
            for (sign, terms) in [(1.0, &mut up), (-1.0, &mut down)] {
                for (k, c) in terms.iter_mut().enumerate().skip(usize::from(sign < 0.0)) {
                    let k = sign * k as f64;
                    if k == nearest {
                        (drift, *c) = ((k, *c), 0.0);
                    } else {
                        *c /= p[0] + k;
                    }
                }
            }
            doubt.reach += 2.0 * up.iter().chain(&down).map(|d| d.abs()).sum::<f64>();
        } else {
            doubt.reach += swing.law.shape.rim.ell[0].abs();
        }
        Self { p, q, up, down, drift, start, doubt }
    }

    /// phi and psi since the lower turning point, without whole periods.
    fn angles(&self, at: &PeriodPoint) -> [f64; 2] {
        // The terms sin(k u)/k are summed with e^(i k u) from a recurrence.
        let mut sums = [self.p[0] * at.u, self.q[0] * at.u];
        let (mut sin, mut cos) = (at.sin, at.cos);
        for k in 1..K {
            sums[0] += self.p[k] * sin / k as f64;
            sums[1] += self.q[k] * sin / k as f64;
            (sin, cos) = (sin * at.cos + cos * at.sin, cos * at.cos - sin * at.sin);
        }
        sums
    }

    /// The sum of the terms of the contact path at a place, as x + i y; the term that drifts is counted from u = 0
    /// on.
    fn path(&self, at: &PeriodPoint) -> Complex<f64> {
        let step = Complex::new(at.cos, at.sin);
        let sum = |terms: &[f64; K], step: Complex<f64>| {
            terms.iter().rev().fold(Complex::new(0.0, 0.0), |sum, c| sum * step + c)
        };
        let terms = sum(&self.up, step) + sum(&self.down, step.conj());
        let turn = Angle::of(Sum::product(at.periods, TAU * self.p[0])).rest + self.p[0] * at.u;
        let (k, c) = self.drift;
        let (alpha, all) = (self.p[0] + k, TAU.mul_add(at.periods, at.u));
        let half = 0.5 * alpha * all;
        let chord = if half == 0.0 { all } else { all * (half.sin() / half) };
        Complex::from_polar(1.0, turn) * terms + Complex::from_polar(c * chord, half) * Complex::i()
    }

    /// The pose at a place: angles and, for a rolling body, contact point, relative to the start.
    pub fn pose(&self, at: &PeriodPoint) -> Pose {
        let (here, start) = (self.angles(at), self.angles(&self.start));
        let angle = |i: usize, per_u: f64| {
            let whole = Sum::product(at.periods - self.start.periods, TAU * per_u);
            Angle::of(whole.plus(Sum::of(here[i], -start[i])))
        };
        let moved = (self.path(at) - self.path(&self.start)) * Complex::from_polar(1.0, -start[0]);
        let contact_point = Point2::new(moved.re + 0.0, moved.im + 0.0);
        Pose { phi: angle(0, self.p[0]), psi: angle(1, self.q[0]), contact_point, height: 0.0 }
    }

    /// Estimated error of the pose at a place that is reached at time `t`, whose error is `late`: of angles in
    /// radians, of the contact point in R.
    pub fn error(&self, at: &PeriodPoint, t: f64, late: f64) -> f64 {
        let of = &self.doubt;
        let gone = TAU.mul_add(at.periods, at.u).abs() + self.start.u.abs();
        let turned = (self.p[0].abs() + self.q[0].abs()) * gone;
        let angle = of.per_time * t.abs() + of.fastest * late + of.angle + 2.0 * f64::EPSILON * turned;
        let (k, c) = self.drift;
        let alpha = (self.p[0] + k).abs();
        let drifted = if alpha * gone < 2.0 { c.abs() * gone } else { 2.0 * c.abs() / alpha };
        angle * (of.reach + drifted) + of.per_u * gone + of.place
    }
}

impl PeriodPoint {
    /// The place of a motion that starts at u on its way up or down.
    pub fn start(u: f64, rising: bool) -> Self {
        let (sin, cos) = sin_cos(u);
        let way = if rising { 1.0 } else { -1.0 };
        Self { periods: 0.0, u: way * u, cos, sin: way * sin }
    }
}
