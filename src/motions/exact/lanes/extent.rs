//! Extreme inclinations, extreme contact forces and the precession of motions in SIMD lanes.

use super::series::change_of_theta;
use super::{LanePhase, Midpoints, Swings};
use crate::laws::contact::force_of;
use crate::laws::contact::reduced::Rates;
use crate::numbers::{LANES, Real, sin_cos};
use core::f64::consts::PI;
use fearless_simd::{ExtractToken, Simd, SimdBase, f64x8};

impl<T: Real, const N: usize, const K: usize> Swings<T, N, K> {
    /// Precession in a whole nutation, in radians, by the midpoint rule; its estimated error; and the rounding part
    /// of this error.
    #[inline(always)]
    pub fn precession_per_period(&self, points: &Midpoints<K>) -> [T; 3] {
        let number = |x: f64| self.theta.splat(x);
        let (zero, one, two) = (number(0.0), number(1.0), number(2.0));
        let (mut sum, mut fastest, mut steepest, mut swiftest) = (zero, zero, one, one);
        for j in 0..self.parts() {
            let (_, [s, _, w1, _, w3]) = self.motion(zero, number(points.cosines[1][j]));
            sum = (self.slope[j] / s).fma(w1, sum);
            fastest = fastest.max((w1 / s).abs());
            steepest = steepest.max(one / s);
            swiftest = swiftest.max(one + w1.abs() + w3.abs());
        }
        let of = &self.doubt;
        let error = |place: T, per_time: T| {
            let state = of.state_per_y * place + number(2.0 * f64::EPSILON) * swiftest;
            self.period() * (state * steepest * (two + fastest) + two * fastest * per_time)
        };
        let turn = sum * number(2.0 * PI / self.parts() as f64);
        [turn, error(of.place, of.per_time), error(of.noise, of.noise)]
    }

    /// Bound of the rates of precession and of the phase of the nutation.
    #[inline(always)]
    pub fn fastest_turn(&self, points: &Midpoints<K>) -> T {
        let zero = self.theta.splat(0.0);
        let mut most = zero;
        for j in 0..self.parts() {
            let (_, [s, _, w1, _, _]) = self.motion(zero, self.theta.splat(points.cosines[1][j]));
            most = most.max((w1 / s).abs()).max(self.theta.splat(1.0) / self.slope[j]);
        }
        most
    }

    /// The interval of the nutation's phase u within [0, pi] that the motion covers between time 0 and `t`.
    #[inline(always)]
    fn passed(&self, t: T) -> [T; 2] {
        let number = |x: f64| self.theta.splat(x);
        let (zero, one) = (number(0.0), number(1.0));
        let LanePhase { u, .. } = self.phase_at(t);
        let u = u.max(zero).min(number(PI));
        let turns = one / self.period();
        let (from, to) = (self.phase.min(self.phase + t) * turns, self.phase.max(self.phase + t) * turns);
        let (half, top) = (number(0.5), number(PI));
        [
            passes_between(from, to, zero, zero, self.start.min(u)),
            passes_between(from, to, half, top, self.start.max(u)),
        ]
    }

    /// The value of a [`Grip`] quantity at the nutation's phase u.
    #[inline(always)]
    fn margin<const ROUND: bool>(&self, grip: Grip, rates: &Rates<T>, u: T) -> T {
        let (sin, cos) = sin_cos(u);
        let (_, [s, c, w1, w2, w3]) = self.motion(sin, cos);
        let w = [w1, w2, w3];
        let [normal, along, across] =
            force_of(rates.reduced(), (s, c), w, rates.at_rim_kind::<ROUND>(s, c, w));
        let zero = self.theta.splat(0.0);
        match grip {
            Grip::Normal => normal,
            Grip::Friction => {
                let needed = along.mac(along, across * across).sqrt() / normal;
                zero.select_lt(normal, -needed, self.theta.splat(f64::NEG_INFINITY))
            }
        }
    }

    /// Least and greatest inclination from time 0 to `t`.
    #[inline(always)]
    pub fn inclinations(&self, t: T) -> [T; 2] {
        let [from, to] = self.passed(t);
        [self.inclination(from), self.inclination(to)]
    }

    #[inline(always)]
    fn inclination(&self, u: T) -> T {
        let (_, cos) = sin_cos(u);
        self.theta + change_of_theta(self.sin, self.cos, self.mid - self.amp * cos)
    }

    /// The least value of a [`Grip`] quantity from time 0 to `t`; or, if `roughly`, a lower bound, which is enough
    /// for a decision and takes much less time.
    #[inline(always)]
    pub fn least(&self, grip: Grip, t: T, roughly: bool) -> T {
        // The kind of the rim is a constant, so that each kind is compiled separately.
        if self.law.round {
            self.least_on_rim::<true>(grip, t, roughly)
        } else {
            self.least_on_rim::<false>(grip, t, roughly)
        }
    }

    #[inline(always)]
    fn least_on_rim<const ROUND: bool>(&self, grip: Grip, t: T, roughly: bool) -> T {
        let rates = Rates::of(self.law.contact, &self.law.shape, ROUND);
        let number = |x: f64| self.theta.splat(x);
        let [first, last] = self.passed(t);
        let (mut from, mut to) = (first, last);
        let (mut least, mut most, mut place) = (number(f64::INFINITY), number(f64::NEG_INFINITY), from);
        let rounds = if roughly { 1 } else { 1 + (6.0 / (self.parts() as f64 / 2.0).log10()).ceil() as u32 };
        for _ in 0..rounds {
            let width = (to - from) * number(1.0 / self.parts() as f64);
            for j in 0..=self.parts() {
                let u = width.mac(number(j as f64), from);
                let value = self.margin::<ROUND>(grip, &rates, u);
                place = value.select_lt(least, u, place);
                least = value.min(least);
                most = value.max(most);
            }
            (from, to) = ((place - width).max(first), (place + width).min(last));
        }
        // Between two samples the function may dip by a small part of its range, since the series resolves
        // it.
        if roughly { least - number(LARGEST_HIDDEN_DIP) * (most - least) } else { least }
    }
}

/// Returns `yes` where a whole number plus `offset` lies between two times, in periods since the lower turning point,
/// else `no`.
#[inline(always)]
fn passes_between<T: Real>(from: T, to: T, offset: T, yes: T, no: T) -> T {
    floor(to - offset).select_lt(-floor(offset - from), no, yes)
}

/// The greatest whole number that is not larger than x.
#[inline(always)]
fn floor<T: Real>(x: T) -> T {
    let near = x.round();
    x.select_lt(near, near - x.splat(1.0), near)
}

impl<S: Simd, const N: usize, const K: usize> Swings<f64x8<S>, N, K> {
    /// A lower bound of a [`Grip`] quantity from time 0 to `t`, for one motion that is the same in all SIMD lanes;
    /// each lane takes other samples.
    #[inline(always)]
    pub fn bound<const ROUND: bool>(&self, grip: Grip, t: f64x8<S>) -> f64 {
        let rates = Rates::of(self.law.contact, &self.law.shape, ROUND);
        let number = |x: f64| self.theta.splat(x);
        let [first, last] = self.passed(t);
        let width = (last - first) * number(1.0 / K as f64);
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for looks in (0..=K).step_by(LANES) {
            let mut at = [K as f64; LANES];
            for (j, at) in at.iter_mut().enumerate() {
                *at = at.min((looks + j) as f64);
            }
            let u = width.mac(f64x8::from_slice(t.token(), &at), first);
            let value = self.margin::<ROUND>(grip, &rates, u);
            for k in 0..LANES {
                least = if value[k] < least { value[k] } else { least };
                most = if value[k] > most { value[k] } else { most };
            }
        }
        // As in `least_on`, the function may dip between two samples by a part of its range.
        least - LARGEST_HIDDEN_DIP * (most - least)
    }
}

/// Assumed greatest dip of a [`Grip`] quantity between two samples, as a fraction of its range; assuming less might
/// miss an event.
const LARGEST_HIDDEN_DIP: f64 = 0.25;

/// A quantity that must stay large enough for a body to keep rolling.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Grip {
    /// The normal force in units of the weight.
    Normal,
    /// Minus the coefficient of friction that rolling needs; minus infinity where the normal force is not positive.
    Friction,
}
