//! What a motion in lanes meets on its way: inclinations, contact force, precession.

use super::series::turned;
use super::{Midpoints, Phase, Swings};
use crate::contact::force_of;
use crate::contact::reduced::Rates;
use crate::number::{Real, sin_cos};
use core::f64::consts::PI;

impl<T: Real, const N: usize, const K: usize> Swings<T, N, K> {
    /// Precession of a whole nutation, radians: the midpoint rule, which converges as fast as the period
    /// does.
    #[inline(always)]
    pub fn precession(&self, points: &Midpoints<K>) -> T {
        let mut sum = self.theta.splat(0.0);
        for j in 0..K {
            let (_, [s, _, w1, _, _]) =
                self.motion(self.theta.splat(0.0), self.theta.splat(points.cosines[1][j]));
            sum = (self.slope[j] / s).fma(w1, sum);
        }
        sum * self.theta.splat(2.0 * PI / K as f64)
    }

    /// The most that anything turns by in a unit of time: precession, and the phase of the nutation.
    #[inline(always)]
    pub fn fastest_turn(&self, points: &Midpoints<K>) -> T {
        let zero = self.theta.splat(0.0);
        let mut most = zero;
        for j in 0..K {
            let (_, [s, _, w1, _, _]) = self.motion(zero, self.theta.splat(points.cosines[1][j]));
            most = most.max((w1 / s).abs()).max(self.theta.splat(1.0) / self.slope[j]);
        }
        most
    }

    /// The part of [0, pi] in which u is between time 0 and `t`.
    #[inline(always)]
    fn passed(&self, t: T) -> [T; 2] {
        let number = |x: f64| self.theta.splat(x);
        let (zero, one) = (number(0.0), number(1.0));
        let Phase { u, .. } = self.place(t);
        let u = u.max(zero).min(number(PI));
        let turns = one / self.period();
        let (from, to) = (self.phase.min(self.phase + t) * turns, self.phase.max(self.phase + t) * turns);
        let floor = |x: T| {
            let near = x.round();
            x.select_lt(near, near - one, near)
        };
        // a whole number, or a half of an odd one, of periods since the lower turning point
        let meets = |offset: f64, yes: T, no: T| {
            let first = zero - floor(number(offset) - from);
            floor(to - number(offset)).select_lt(first, no, yes)
        };
        [meets(0.0, zero, self.start.min(u)), meets(0.5, number(PI), self.start.max(u))]
    }

    /// A grip at u.
    #[inline(always)]
    fn margin<const ROUND: bool>(&self, grip: Grip, rates: &Rates<T>, u: T) -> T {
        let (sin, cos) = sin_cos(u);
        let (_, [s, c, w1, w2, w3]) = self.motion(sin, cos);
        let w = [w1, w2, w3];
        let [normal, along, across] = force_of(rates.reduced(), (s, c), w, rates.at_on::<ROUND>(s, c, w));
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
        self.passed(t).map(|u| {
            let (_, cos) = sin_cos(u);
            self.theta + turned(self.sin, self.cos, self.mid - self.amp * cos)
        })
    }

    /// The least of a [`Grip`] from time 0 to `t`; or, if `roughly`, a bound below it: for a decision, at a
    /// fraction of the cost.
    #[inline(always)]
    pub fn least(&self, grip: Grip, t: T, roughly: bool) -> T {
        // the kind of the rim is a constant: each is compiled by itself
        if self.law.round {
            self.least_on::<true>(grip, t, roughly)
        } else {
            self.least_on::<false>(grip, t, roughly)
        }
    }

    #[inline(always)]
    fn least_on<const ROUND: bool>(&self, grip: Grip, t: T, roughly: bool) -> T {
        let rates = Rates::of(self.law.contact, &self.law.shape, ROUND);
        let number = |x: f64| self.theta.splat(x);
        let [first, last] = self.passed(t);
        let (mut from, mut to) = (first, last);
        let (mut least, mut most, mut place) = (number(f64::INFINITY), number(f64::NEG_INFINITY), from);
        let rounds = if roughly { 1 } else { 1 + (6.0 / (K as f64 / 2.0).log10()).ceil() as u32 };
        for _ in 0..rounds {
            let width = (to - from) * number(1.0 / K as f64);
            for j in 0..=K {
                let u = width.mac(number(j as f64), from);
                let value = self.margin::<ROUND>(grip, &rates, u);
                place = value.select_lt(least, u, place);
                least = value.min(least);
                most = value.max(most);
            }
            (from, to) = ((place - width).max(first), (place + width).min(last));
        }
        // what can hide between two looks at a function that the series resolves
        if roughly { least - number(0.25) * (most - least) } else { least }
    }
}

/// What keeps a body on its way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Grip {
    /// The normal force, per weight.
    Normal,
    /// Minus the coefficient of friction that rolling needs; minus infinity where nothing presses.
    Friction,
}
