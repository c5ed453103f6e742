//! Rocking from rim to rim without a bounce: infinitely many hops in a finite time, the last of which are summed.
//!
//! ```text
//! a hop lasts 2 w/gamma, gamma = -w2' on one rim at theta = pi/2;   a landing turns w into r w
//! the rest = the change in one cycle of two hops and two landings, over 1 - r r'
//! on a slope gamma of both hops differ, by -+ G_h; a rim at rest may slip off in each hop: then three cycles show the ratio
//! ```
//! The model is the block of Housner, Bull. Seismol. Soc. Am. 53, 403 (1963). Error: the square of the summed time;
//! beside a slow slip also the summed time, times the angle by which the slip turns.

use crate::laws::contact::landing::{Outcome, land_at};
use crate::laws::contact::standstill::Standstill;
use crate::laws::state::State;
use crate::motions::body::body_walk::BodyWalk;
use crate::motions::body::own::Own;
use crate::motions::walk::Phases;
use crate::motions::walk::numbers::{BodyNumbers, COS, HEAT, PHI, PSI, SIN, TIME, U2, UH, W1, W2, W3, poses};

/// The longest time over which hops are summed, over the time in which the body turns by a radian.
const SOON_OVER: f64 = 1e-6;
/// The hops of a body with a slow slip are summed only if the direction of the slip turns by less than this angle, in
/// radians, meanwhile. Dry friction turns it at a rate of up to `TURNS_SLIP` mu over its speed.
const TURNED: f64 = 1e-2;
const TURNS_SLIP: f64 = 3.0;

/// If two rims touch at an inclination other than pi/2, a hop with a smaller w2 is as low as the rounding of theta.
const LOST_HOP: f64 = 1e-8;
/// Number of landings of a rocking after which its ratio is tested. The rest is summed if the velocities shrink from
/// cycle to cycle by a ratio of at most `MOST_RATIO`, which changes by at most the share `UNLIKE`.
const LANDINGS: usize = 5;
const MOST_RATIO: f64 = 0.99;
const UNLIKE: f64 = 1e-3;

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// The state vector at the end of a rocking that has just begun another hop at theta = pi/2, and its error; None
    /// if the end is not near.
    pub(crate) fn rocks_out(&mut self) -> Option<([f64; N], f64)> {
        let (begin, state, takeoff) = (self.at, self.of.state, self.hops.takeoff);
        let (body, slide, view) = (self.of.body, self.of.slide, self.made.path.view);
        let found = self.cycle(&begin);
        (self.at, self.of.state, self.hops.takeoff) = (begin, state, takeoff);
        (self.of.body, self.of.slide, self.made.path.view) = (body, slide, view);
        self.of.own.sees(view.over);
        found
    }

    /// Whether the rim from which the state is counted, at rest, sticks in the hop that begins from this inclination.
    pub(crate) fn sticks_on_slope(&mut self, theta: f64) -> bool {
        let State { w1, w3, .. } = self.of.state;
        self.of.state = State { theta, w1, w2: 0.0, w3 };
        !self.of.slide.law.dry || Phases::rests(self) == Standstill::Sticks
    }

    #[inline(never)]
    fn cycle(&mut self, begin: &[f64; N]) -> Option<([f64; N], f64)> {
        let mut slowest = f64::INFINITY;
        for _ in 0..2 {
            let (slip, rises) = (self.at.slip(), self.at[W2]);
            if self.of.tilt != 0.0 && slip == [0.0; 2] && !self.sticks_on_slope(self.of.body.theta_end()) {
                return None;
            }
            let law = &self.of.slide.law;
            let sticks = law.dry && slip[0].hypot(slip[1]) <= self.of.slide.over();
            if law.dry && !sticks {
                slowest = slowest.min(slip[0].hypot(slip[1]));
            }
            self.at[W2] = 0.0;
            let rates = self.hop_rates(&self.at, 0.0, sticks);
            if rates[W2] >= 0.0 {
                return None;
            }
            let lasts = 2.0 * rises / -rates[W2];
            self.at.iter_mut().zip(rates).for_each(|(number, rate)| *number += lasts * rate);
            self.at[TIME] += lasts;
            self.at[W2] = -rises;
            let before =
                State { theta: self.of.body.theta_end(), w1: self.at[W1], w2: -rises, w3: self.at[W3] };
            let slip = self.at.slip();
            let landed = land_at(&self.of.body, &before, (slip, 0.0), &self.friction(), &self.of.own).ok()?;
            if landed.outcome != Outcome::Changes {
                return None;
            }
            self.lands_as(&landed);
            self.at[HEAT] += landed.lost;
        }
        let share = 1.0 - self.at[W2] / begin[W2];
        let mut end: [f64; N] = core::array::from_fn(|i| begin[i] + (self.at[i] - begin[i]) / share);
        (end[SIN], end[COS]) = self.of.body.border_angle();
        end[W2] = 0.0;
        let fastest = [W1, W3, UH, U2].into_iter().fold(1.0, |most: f64, i| most.max(begin[i].abs()));
        let left = end[TIME] - begin[TIME];
        // A slope turns a slip as well.
        let turns =
            left * (fastest + (self.of.slide.law.strength * TURNS_SLIP + self.of.tilt.abs()) / slowest);
        // A hop that is lost in the roundings of theta has no later one.
        let lost = self.of.body.has_row() && begin[W2] < LOST_HOP && left < TURNED;
        let sums = left * fastest < SOON_OVER && turns < TURNED;
        (share > 0.0 && (sums || lost)).then_some((end, left * if sums { turns } else { 1.0 }))
    }

    /// The state vector at the end of a rocking whose slips stop in its hops, and its error. All hops shrink by one
    /// ratio, so that the changes from cycle to cycle are a geometric series. None until three cycles have shown the
    /// ratio.
    #[inline(never)]
    pub(crate) fn shrinks_out(&mut self) -> Option<([f64; N], f64)> {
        let (on_face, up) = (self.is_on_face(), self.up());
        // A rim at rest may slip off in each hop down a slope.
        let sloped = self.of.tilt != 0.0 && !self.of.body.has_row();
        if !self.of.body.has_row() && !on_face && !sloped {
            return None;
        }
        let all = &mut self.of.rocked;
        all.push(self.at.to_vec());
        if all.len() > LANDINGS {
            all.remove(0);
        }
        let [first, _, before, other, now] = &all[..] else { return None };
        if all.iter().all(|y| y[W2].abs() < LOST_HOP) {
            let mut end = self.at;
            end[W2] = 0.0;
            self.of.rocked.clear();
            return Some((end, LOST_HOP));
        }
        // Landings on the other circle are seen from the other end.
        let ratio = now[W2] / before[W2];
        let steady = |ratio: f64, known: f64| (ratio / known - 1.0).abs();
        let lasted = (now[TIME] - before[TIME]) / (before[TIME] - first[TIME]);
        let unlike = steady(before[W2] / first[W2], ratio).max(steady(lasted, ratio));
        let turned = on_face || sloped || other[COS].signum() != now[COS].signum();
        let slips = sloped || [other, now].iter().any(|y| y[UH].hypot(y[U2]) > self.of.slide.over());
        if !(turned && slips && ratio < MOST_RATIO && unlike < UNLIKE) {
            return None;
        }
        let share = ratio / (1.0 - ratio);
        let mut end: [f64; N] = core::array::from_fn(|i| now[i] + (now[i] - before[i]) * share);
        (end[SIN], end[COS]) = if on_face { (0.0, up) } else { self.of.body.border_angle() };
        end[W2] = 0.0;
        if on_face && poses(N) {
            // Each landing turns e_h round.
            (end[PHI], end[PSI]) = (now[PHI], now[PSI]);
        }
        let left = end[TIME] - now[TIME];
        let error = left * (unlike / (1.0 - ratio) + left);
        let seen = left < SOON_OVER || self.until().is_none_or(|t| t > end[TIME]);
        seen.then_some((end, error))
    }
}
