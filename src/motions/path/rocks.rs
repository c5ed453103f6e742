//! Rocking from rim to rim, with or without bounces: infinitely many hops in a finite time, of which the last ones are
//! summed.
//!
//! ```text
//! a hop lasts 2 w/gamma, gamma = -w2' on one rim at theta = pi/2;   a landing turns w into r w
//! the rest = the change in one cycle of two hops and two landings, over 1 - r r'
//! many hops    y = y_end + y_1 A + y_2 A^2 + ...,   A^2 = w2^2 + 2 ell cos theta where a rim takes over
//! ```
//! The model is the block of Housner, Bull. Seismol. Soc. Am. 53, 403 (1963). A thin coin rocks thousands of times, and a
//! coin that bounces has a sequence of bounces in each rocking. A rocking is then an analytic map that contracts A, so
//! that all numbers are power series of A, and the polynomial through those of past rockings leads to the end at A = 0.
//!
//! Error: the square of the time that is summed; of a polynomial, its difference from that of the next lower degree.

use super::phases::BodyWalk;
use crate::laws::contact::landing::{Outcome, land_at};
use crate::laws::contact::{Contact, lossy};
use crate::laws::state::State;
use crate::methods::SHORT_CODE;
use crate::motions::Method;
use crate::motions::halt::{TIME, loses, poses};
use crate::motions::walk::{MOST_IMPACTS, Next};
use crate::numbers::larger;
use core::f64::consts::{FRAC_PI_2, PI};

/// The longest time that is summed, over the time in which the body turns by a radian.
const SOON_OVER: f64 = 1e-6;
/// A polynomial leads through the rockings since A was this many times as large. The shorter range may lie behind a
/// change of the motion that the longer one includes.
const WIDER: [f64; 2] = [3.0, 1.5];
/// The fewest rockings that tell the end, and how many of them a polynomial needs.
const FEWEST_ROCKINGS: usize = 24;
const FEWEST_IN_RANGE: usize = 12;
/// Largest degree of a polynomial.
const DEGREE: usize = 8;
/// A degree is not better than the one before by more than this.
const BY_CHANCE: f64 = 1e-2;
/// Error of the end of a rocking by a polynomial: this part of the tolerance of a sweep, within these two limits.
const END_SHARE: f64 = 0.1;
const END: f64 = 1e-11;
const ROUGHEST_END: f64 = 1e-9;
/// The claimed error of the end, in units of the difference of two degrees.
const OF_DEGREES: f64 = 10.0;
/// Larger errors are accepted after these numbers of impacts, since the motion would be given up after
/// [`MOST_IMPACTS`].
const TIRED_OF_ROCKING: [(usize, f64); 2] = [(MOST_IMPACTS / 2, 1e-6), (MOST_IMPACTS / 10 * 9, 1e-3)];
/// Most numbers of a body.
const MOST_NUMBERS: usize = 14;

/// The size of a rocking, and the numbers where a rim takes over.
type Rocking = (f64, [f64; MOST_NUMBERS]);

/// The rockings in which the same rim takes over, in a row in which they become smaller.
#[derive(Debug, Clone, Default)]
pub(super) struct Rockings {
    over: bool,
    rows: Vec<Rocking>,
}

/// The weights, at zero, of the polynomial through these places.
fn weights_at_zero(places: &[f64]) -> Vec<f64> {
    let weight = |(j, at): (usize, &f64)| {
        let others = places.iter().enumerate().filter(|(k, _)| *k != j);
        others.map(|(_, other)| other / (other - at)).product()
    };
    places.iter().enumerate().map(weight).collect()
}

/// The numbers at the end of these rockings, by the polynomial whose degree seems best, and their error.
fn end_of(rows: &[Rocking]) -> ([f64; MOST_NUMBERS], f64) {
    let last = rows.len() - 1;
    let mut best = ([f64::NAN; MOST_NUMBERS], f64::INFINITY);
    let (mut before, mut last_apart) = (None::<[f64; MOST_NUMBERS]>, 0.0);
    for degree in 1..=DEGREE {
        // The places of Chebyshev keep the weights small.
        let at = |j: usize| {
            let share = 0.5 - 0.5 * (PI * j as f64 / degree as f64).cos();
            (share * last as f64).round() as usize
        };
        let chosen: Vec<&Rocking> = (0..=degree).map(|j| &rows[at(j)]).collect();
        let weights = weights_at_zero(&chosen.iter().map(|row| row.0).collect::<Vec<_>>());
        let end: [f64; MOST_NUMBERS] = core::array::from_fn(|i| {
            let from = rows[last].1[i];
            from + weights.iter().zip(&chosen).map(|(weight, row)| weight * (row.1[i] - from)).sum::<f64>()
        });
        if let Some(before) = before {
            let apart = (0..MOST_NUMBERS).fold(0.0, |most, i| larger(most, (end[i] - before[i]).abs()));
            // At the end the body lies level and does not rise. Two degrees may agree by chance.
            let error = [end[1].abs(), end[3].abs(), BY_CHANCE * last_apart].into_iter().fold(apart, larger);
            last_apart = apart;
            if error < best.1 {
                best = (end, error);
            }
        }
        before = Some(end);
    }
    best
}

impl<const N: usize> BodyWalk<'_, N> {
    /// The phase on both rims with which a long rocking ends, if the rockings up to now tell its end, and no output is
    /// requested before. Called where a rim takes over.
    #[inline(never)]
    pub(super) fn rocks_to_rest(&mut self) -> Option<Next> {
        if SHORT_CODE {
            return None;
        }
        let over = self.made.path.upside_down;
        let [c, w2] = [self.at[1], self.at[3]];
        let size = (w2 * w2 + 2.0 * self.of.body.ell() * c).sqrt();
        let rockings = &mut self.of.rockings;
        if rockings.rows.is_empty() || rockings.over == over {
            if rockings.rows.last().is_some_and(|last| !(size < last.0)) {
                rockings.rows.clear();
            }
            rockings.over = over;
            rockings.rows.push((size, core::array::from_fn(|i| if i < N { self.at[i] } else { 0.0 })));
        }
        let range = |rows: &[Rocking], wider: f64| rows.partition_point(|row| row.0 > wider * size);
        let old = range(&rockings.rows, WIDER[0]);
        rockings.rows.drain(..old);
        let rows = &rockings.rows;
        if rockings.over != over || rows.len() < FEWEST_ROCKINGS || !rows.len().is_multiple_of(4) {
            return None;
        }
        let ranges = WIDER.map(|wider| &rows[range(rows, wider).min(rows.len() - FEWEST_IN_RANGE)..]);
        let (found, error) = ranges.map(end_of).into_iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let most = match self.ask.method {
            Method::Tolerance(tol) => (END_SHARE * tol).clamp(END, ROUGHEST_END),
            _ => END,
        };
        let end: [f64; N] = core::array::from_fn(|i| found[i]);
        // A motion that dry friction stops on the way does not reverse.
        let reverses = |i: usize| end[i] * self.at[i] < 0.0 && end[i].abs() > error;
        let asked = self.until().is_none_or(|t| t <= end[TIME]);
        let later = end[TIME] > self.at[TIME];
        let count = self.made.path.impacts.len();
        let most = TIRED_OF_ROCKING.into_iter().filter(|(after, _)| count > *after).fold(most, |_, (_, most)| most);
        let told = error < most;
        if !told || asked || !later || [2, 4, 5, 6].into_iter().any(reverses) {
            return None;
        }
        let fastest = [2, 4, 5, 6].into_iter().fold(1.0, |most: f64, i| most.max(end[i].abs()));
        self.claims(OF_DEGREES * error * fastest);
        let has = |y: &[f64; N]| self.of.slide.energy(y) + y[8] + if loses(N) { y[N - 1] } else { 0.0 };
        let begin = self.at;
        self.at = end;
        (self.at[0], self.at[1], self.at[3]) = (1.0, 0.0, 0.0);
        let lost = has(&begin) - has(&self.at);
        self.claims(-lost);
        if let Some(last) = self.made.path.impacts.last_mut() {
            last.lost += lost;
        }
        self.of.rockings.rows.clear();
        Some(self.settles_on_side())
    }

    /// The numbers at the end of a rocking that has just begun another hop at theta = pi/2; None if the end is not
    /// near.
    pub(super) fn rocks_out(&mut self) -> Option<[f64; N]> {
        let (begin, state, takeoff) = (self.at, self.of.state, self.of.takeoff);
        let upside_down = self.made.path.upside_down;
        let found = self.cycle(&begin);
        (self.at, self.of.state, self.of.takeoff) = (begin, state, takeoff);
        self.made.path.upside_down = upside_down;
        found
    }

    #[inline(never)]
    fn cycle(&mut self, begin: &[f64; N]) -> Option<[f64; N]> {
        for _ in 0..2 {
            let y = State { theta: FRAC_PI_2, w2: 0.0, ..self.of.state };
            let (slip, rises) = ([self.at[5], self.at[6]], self.at[3]);
            let law = &self.of.slide.law;
            let sticks = law.dry && slip[0].hypot(slip[1]) <= self.of.slide.over();
            let w = [y.w1, 0.0, y.w3];
            let (rate, drift, warms, taken) = if sticks {
                let (dy, taken) = lossy::derivative(Contact::Rolling, &self.of.body, &y, &self.ask.losses);
                ([dy.w1, dy.w2, dy.w3], [0.0; 2], 0.0, taken)
            } else {
                let at = law.at((1.0, 0.0), w, slip).0;
                (
                    at.w,
                    at.u,
                    -(at.force[1] * slip[1] + at.force[2] * slip[0]),
                    law.power((1.0, 0.0), w, at.force[0]),
                )
            };
            if rate[1] >= 0.0 {
                return None;
            }
            let lasts = 2.0 * rises / -rate[1];
            for (i, rate) in
                [(2, rate[0]), (4, rate[2]), (5, drift[0]), (6, drift[1]), (TIME, 1.0), (8, warms)]
            {
                self.at[i] += lasts * rate;
            }
            if loses(N) {
                self.at[N - 1] += lasts * taken;
            }
            if poses(N) {
                let (sin, cos) = self.at[9].sin_cos();
                let (out, on) = (slip[0], slip[1] + y.w3);
                for (i, rate) in
                    [(9, y.w1), (10, y.w3), (11, out * cos - on * sin), (12, out * sin + on * cos)]
                {
                    self.at[i] += lasts * rate;
                }
            }
            self.at[3] = -rises;
            let before = State { theta: FRAC_PI_2, w1: self.at[2], w2: -rises, w3: self.at[4] };
            let slip = [self.at[5], self.at[6]];
            let landed = land_at(&self.of.body, &before, (slip, 0.0), &self.friction()).ok()?;
            if landed.outcome != Outcome::Changes {
                return None;
            }
            self.lands_as(&landed);
            self.at[8] += landed.lost;
        }
        let share = 1.0 - self.at[3] / begin[3];
        let mut end: [f64; N] = core::array::from_fn(|i| begin[i] + (self.at[i] - begin[i]) / share);
        (end[0], end[1], end[3]) = (1.0, 0.0, 0.0);
        let fastest = [2, 4, 5, 6].into_iter().fold(1.0, |most: f64, i| most.max(begin[i].abs()));
        let left = (end[TIME] - begin[TIME]) * fastest;
        (share > 0.0 && left < SOON_OVER).then_some(end)
    }
}
