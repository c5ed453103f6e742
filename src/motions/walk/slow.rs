//! A slow slip as a power series in time, from the start of the slip and while the slip stays slow.
//!
//! ```text
//! u = r (cos alpha, sin alpha),   r = r0 + r1 t + r2 t^2 + ...,   alpha = a0 + a1 t + ...
//! r' = lambda(alpha),   r alpha' = f(alpha)
//! order n:   (n r1 - f_alpha) a_n = [f - r alpha']_n of known terms
//! ```
//! In time these equations are singular: alpha follows the zero of f at the rate f_alpha/r, and an integrator would
//! need tiny steps. The law of friction, recorded on a [`Tape`], gives the coefficients one after the other. If r0
//! is positive, the coefficients are computed several times, in sweeps: the term r0 (n + 1) a_(n+1) is taken from the previous
//! sweep, in the first sweep from the series before this one. The sweeps converge to the slow manifold of singular
//! perturbation theory (Fenichel 1979), on which the direction has settled, as in every slip that began from rest.
//! With r0 or r1 = 0 (static friction that was just enough) the series is only asymptotic; its last terms show how
//! far it may be used.
//!
//! Error: the tolerance `tol` of the series; the last two terms of each component are below `tol` where the series
//! ends.

use crate::laws::contact::standstill::towards;
use crate::methods::search::crossing;
use crate::numbers::tape::{Player, Tape, Taped};
use crate::numbers::{Series, TERMS};

/// Number of coefficients of the power series for each digit of the tolerance.
const TERMS_PER_DIGIT: f64 = 1.2;
/// A series is used only while the last two terms of alpha(t) are below this, in radians.
const LAST_TERMS: f64 = 1e-7;
/// A slip faster than this, in sqrt(g R), is computed by the integrator, not by a power series.
pub(super) const SLOW_SLIP: f64 = 0.02;
/// Longest time over which two sweeps (computations of the power series of a slow slip, each from the one before)
/// must agree. If they do not after `SWEEPS` sweeps, the integrator computes the slip.
const LONGEST_SWEEP: f64 = 0.05;
const MOST_SWEEPS: i32 = 16;

/// Number of coefficients of the power series that a tolerance needs.
fn terms(tol: f64) -> usize {
    ((1.0 - tol.log10()) * TERMS_PER_DIGIT).ceil().clamp(5.0, TERMS as f64) as usize
}

/// The time at which the larger of the last two terms of a series reaches `allowed`.
fn time_within_terms(x: &Series, terms: usize, allowed: f64) -> f64 {
    let until = |k: usize| (allowed / x.at[k].abs()).powf(1.0 / k as f64);
    until(terms - 2).min(until(terms - 1))
}

/// A power series that lasts longer than this many settling times takes less work than an integrator, each of whose
/// steps spans about six settling times. In a settling time a deviation of the slip's direction falls by a factor e.
const WORTHWHILE_SETTLING_TIMES: f64 = 30.0;

/// Whether the power series of a slip up to the time `until` takes less work than an integrator.
pub(crate) fn pays(until: f64, settling: f64) -> bool {
    until > WORTHWHILE_SETTLING_TIMES * settling
}

/// Number of times at which the slip's speed along a series is tested for a zero.
const SPEED_SAMPLES: usize = 64;

/// Number of parts of a series at whose ends the conditions of the slip are checked.
const MARGIN_CHECKS: usize = 8;
/// Largest number of halvings of the duration of a series within which a condition of the slip fails.
const HALVINGS: u32 = 60;

/// The time up to which the conditions of a slip hold, at most `until`. `margins` returns functions at a time that
/// are positive where the conditions hold. The slip may vanish at both ends and then has no direction; the second
/// argument of `margins` is a time close by at which it has one.
pub(crate) fn clear_until<const M: usize>(mut until: f64, margins: impl Fn(f64, f64) -> [f64; M]) -> f64 {
    for _ in 0..HALVINGS {
        let part = |k: usize| until * k as f64 / MARGIN_CHECKS as f64;
        let moment = 1e-3 * part(1);
        let at = |k: usize| match k {
            0 => margins(0.0, moment),
            MARGIN_CHECKS => margins(until, until - moment),
            _ => margins(part(k), part(k)),
        };
        let all: Vec<[f64; M]> = (0..=MARGIN_CHECKS).map(at).collect();
        if are_clear(&all) {
            break;
        }
        until *= 0.5;
    }
    until
}

/// Whether the conditions of a slip hold at all of some times close together: no margin is negative. At the first
/// time, the beginning, a margin may be zero.
fn are_clear<const M: usize>(margins: &[[f64; M]]) -> bool {
    let fails = |i: usize| {
        let falls = margins[1..].iter().any(|m| m[i] <= 0.0 || m[i].is_nan());
        // A minimum that is small in comparison with the margin's variation may be below zero
        // between two places.
        let dips = margins.windows(3).any(|m| {
            let (a, b, c) = (m[0][i], m[1][i], m[2][i]);
            b < a && b < c && b < 4.0 * (a.max(c) - b)
        });
        falls || dips
    };
    !(0..M).any(fails)
}

/// The time derivatives of the K components of the state without the slip, of the slip, and (`more`) of components on
/// which no derivative depends.
pub(crate) struct SlowRates<T, const K: usize> {
    pub numbers: [T; K],
    pub slip: [T; 2],
    pub more: Vec<T>,
}

/// The power series of slow slips under one law of dry friction.
pub(crate) struct SlowSlips<const K: usize> {
    player: Player,
    tol: f64,
    terms: usize,
}

/// The power series of a slow slip: the K components of the state, the slip, its speed, and the angle of its
/// direction.
pub(crate) struct SlowSlip<const K: usize> {
    pub known: [Series; K],
    pub slip: [Series; 2],
    pub angle: Series,
    speed: Series,
    /// The time in which a deviation of the slip's direction falls by a factor e at the start, divided by the speed.
    pub settling: f64,
    pub terms: usize,
    tol: f64,
}

impl<const K: usize> SlowSlips<K> {
    /// Index of the speed of the slip, after the K components of the state; the cosine and the sine of its direction
    /// follow.
    const SPEED: usize = K;
    const COSINE: usize = K + 1;
    const SINE: usize = K + 2;
    /// Index, after the K rates, of f, the rate at which the slip turns times its speed; `lambda`, the growth of its
    /// speed, follows.
    const TURNS: usize = K;
    const GROWS: usize = K + 1;

    /// Records a law of friction for its power series: a function of the K components of the state, the slip and its
    /// direction.
    pub fn of(
        tol: f64,
        law: impl for<'a> FnOnce(
            &'a Tape,
            [Taped<'a>; K],
            [Taped<'a>; 2],
            [Taped<'a>; 2],
        ) -> SlowRates<Taped<'a>, K>,
    ) -> Self {
        let tape = Tape::default();
        let given: Vec<Taped> = (0..K + 3).map(|_| tape.given()).collect();
        let (speed, way) = (given[Self::SPEED], [given[Self::COSINE], given[Self::SINE]]);
        let numbers = core::array::from_fn(|i| given[i]);
        let SlowRates { numbers, slip: u, more } = law(&tape, numbers, way.map(|x| speed * x), way);
        let [cos, sin] = way;
        let mut first = numbers.to_vec();
        first.extend([cos * u[1] - sin * u[0], cos * u[0] + sin * u[1]]);
        Self { player: tape.player(&given, &first, &more), tol, terms: terms(tol) }
    }

    /// The power series from the state `start` on, in a direction near `angle`, with the speed `begin` that grows at
    /// the rate `growth`; for a speed above 0 the law gives the growth. None where the slip would leave that
    /// direction, or is faster than `SLOW_SLIP`.
    pub fn follow(
        &mut self,
        start: [f64; K],
        (mut angle, growth): (Series, f64),
        begin: f64,
    ) -> Option<SlowSlip<K>> {
        if begin > SLOW_SLIP {
            return None;
        }
        let (terms, player) = (self.terms, &mut self.player);
        let (mut sweep, mut moved) = (0, f64::INFINITY);
        // The coefficients of the rate of the angle; those not computed yet are from the previous sweep.
        let mut turns = angle.slope().at;
        let settling = loop {
            let [cos, sin] = towards(angle.at[0]);
            for (i, x) in start.iter().enumerate() {
                player.set(i, 0, *x);
            }
            player.set(Self::SPEED, 0, begin);
            // The slopes are derivatives with respect to alpha.
            for (i, value, slope) in [(Self::COSINE, cos, -sin), (Self::SINE, sin, cos)] {
                player.set(i, 0, value);
                player.lean(i, slope);
            }
            player.begin();
            let (f, lambda) = (*player.result(Self::TURNS), *player.result(Self::GROWS));
            let f_alpha = f.slope;
            if f_alpha.is_nan() || f_alpha >= 0.0 {
                return None;
            }
            let grows = if begin > 0.0 { lambda.at[0] } else { growth };
            if f_alpha >= (terms - 1) as f64 * grows {
                // The speed falls so fast, compared with the return of the direction, that a term of the series is infinite.
                return None;
            }
            let before = angle;
            for n in 0..terms - 1 {
                if n > 0 {
                    turns[n - 1] = 0.0;
                    Self::set_direction(player, &turns, n);
                    player.go_on(n);
                    // The terms of r alpha' without a_n.
                    let speed = player.given(Self::SPEED);
                    let known = (0..=n).fold(0.0, |sum, j| sum + speed[j] * turns[n - j]);
                    let left = player.result(Self::TURNS).at[n] - known;
                    let turn = left / (n as f64 * grows - f_alpha);
                    (angle.at[n], turns[n - 1]) = (turn, n as f64 * turn);
                    player.turn(n, turn);
                }
                let over = (n + 1) as f64;
                for i in 0..K {
                    player.set(i, n + 1, player.result(i).at[n] / over);
                }
                let faster = if n == 0 { grows } else { player.result(Self::GROWS).at[n] / over };
                player.set(Self::SPEED, n + 1, faster);
            }
            Self::set_direction(player, &turns, terms - 1);
            let settling = 1.0 / -f_alpha;
            if begin == 0.0 {
                break settling;
            }
            let soon = LONGEST_SWEEP.min(time_within_terms(&angle, terms, LAST_TERMS));
            let off: f64 = (0..terms).map(|n| (angle.at[n] - before.at[n]).abs() * soon.powi(n as i32)).sum();
            // The change of the angle is expected to decrease in the next sweep by the same factor as in this one.
            if sweep > 0 && off * (off / moved).min(1.0) <= 0.1 * self.tol.max(1e-13) {
                break settling;
            }
            // At this rate the changes would not become small enough in the sweeps that are left.
            let least = if sweep > 1 { off * (off / moved).powi(MOST_SWEEPS - sweep) } else { 0.0 };
            moved = off;
            sweep += 1;
            if off.is_nan() || sweep > MOST_SWEEPS || least > self.tol.max(1e-13) {
                return None;
            }
            // A Newton step moves the direction towards the solution of f = r alpha'.
            angle.at[0] -= (f.at[0] - begin * angle.at[1]) / f_alpha;
        };
        player.finish(terms - 1);
        let series = |i: usize| Series::first(player.given(i), terms);
        let speed = series(Self::SPEED);
        let slip = [Self::COSINE, Self::SINE].map(|i| speed.times(&series(i), terms));
        Some(SlowSlip {
            known: core::array::from_fn(series),
            slip,
            angle,
            speed,
            settling,
            terms,
            tol: self.tol,
        })
    }

    /// Sets the coefficient of order `n` > 0 of the power series of the cosine and of the sine of an angle whose time
    /// derivative is `rate`.
    fn set_direction(player: &mut Player, rate: &[f64; TERMS], n: usize) {
        let [cosine, sine] = [Self::COSINE, Self::SINE].map(|i| turned(player.given(i), rate, n));
        player.set(Self::COSINE, n, -sine);
        player.set(Self::SINE, n, cosine);
    }

    /// The power series of the rate `i` of [`SlowRates::more`], for the slip that was computed last.
    pub fn more(&self, i: usize) -> Series {
        self.player.later(i, self.terms - 1)
    }
}

impl<const K: usize> SlowSlip<K> {
    /// Whether this series takes less work than the steps of an integrator would up to the time `until`. The end of a
    /// slip takes many steps, since its speed falls by a few factors e in each.
    pub fn pays(&self, until: f64, ends: bool) -> bool {
        ends || pays(until, self.settling * self.speed.at[0])
    }

    /// The time up to which the power series `numbers` of the components may be used, and whether the slip ends then.
    pub fn until(&self, numbers: &[Series]) -> (f64, bool) {
        let (speed, mut until) = (&self.speed, f64::INFINITY);
        let mut within =
            |x: &Series, allowed: f64| until = until.min(time_within_terms(x, self.terms, allowed));
        for x in numbers {
            within(x, 0.1 * self.tol * x.at[0].abs().max(1.0));
        }
        within(&self.angle, LAST_TERMS);
        until *= 0.8;
        let line = speed.at[1] * until;
        let rest: f64 = (2..self.terms).map(|n| speed.at[n].abs() * until.powi(n as i32)).sum();
        if line > rest || speed.at[0] + line.min(0.0) > rest {
            return (until, false);
        }
        // The speed is not certain to stay positive: the slip may end before its series does.
        let part = |k: f64| until * k / SPEED_SAMPLES as f64;
        let looks: [f64; SPEED_SAMPLES + 1] = core::array::from_fn(|k| speed.value(part(k as f64)));
        let over = (1..=SPEED_SAMPLES).find_map(|k| {
            let (before, here, after) = (looks[k - 1], looks[k], looks[SPEED_SAMPLES.min(k + 1)]);
            // A minimum of the speed may lie between two of these times.
            let dips = k < SPEED_SAMPLES && here < before && here < after;
            let lowest = if dips { 0.5 * (before - after) / (before + after - 2.0 * here) } else { 0.0 };
            Some(part(k as f64 + lowest)).filter(|t| speed.value(*t) <= 0.0)
        });
        if let Some(t) = over {
            let first = part(1.0).min(t) * 1e-3;
            until = if speed.value(first) > 0.0 {
                crossing(|t| speed.value(t), first, t, speed.value(first), speed.value(t))
            } else {
                0.0
            };
        }
        (until, over.is_some())
    }
}

/// The coefficient of order `n` > 0 of the integral of the power series `x` times the power series `rate`.
pub(crate) fn turned(x: &[f64; TERMS], rate: &[f64; TERMS], n: usize) -> f64 {
    (0..n).fold(0.0, |sum, j| sum + x[j] * rate[n - 1 - j]) / n as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For a slip whose speed has a minimum of `lowest` at the time 0.503: the time up to which its series may be
    /// used, and whether the slip ends then. Without the minimum it may be used up to the time 1.
    fn dipping(lowest: f64) -> (f64, bool) {
        let mut speed = Series::of(0.503f64.powi(2) + lowest);
        (speed.at[1], speed.at[2]) = (-2.0 * 0.503, 1.0);
        let mut number = Series::of(1.0);
        number.at[TERMS - 1] = 1e-9 * 0.8f64.powi(TERMS as i32 - 1);
        let (angle, slip) = (Series::of(0.0), [speed, Series::of(0.0)]);
        SlowSlip { known: [number], slip, angle, speed, settling: 0.0, terms: TERMS, tol: 1e-8 }
            .until(&[number])
    }

    #[test]
    fn a_slip_ends_at_a_minimum_of_its_speed_below_zero_however_short() {
        for lowest in [-1e-6, -1e-9, -1e-12] {
            let (until, ends) = dipping(lowest);
            assert!(ends && (until - 0.503 + (-lowest).sqrt()).abs() < 1e-9, "{lowest:e}: {until}");
        }
        for lowest in [1e-12, 1e-6] {
            let (until, ends) = dipping(lowest);
            assert!(!ends && (until - 1.0).abs() < 1e-14, "{lowest:e}: {until}");
        }
    }
}
