//! Rocking from rim to rim without a bounce: infinitely many hops in a finite time, of which the last ones are summed.
//!
//! ```text
//! a hop lasts 2 w/gamma, gamma = -w2' on one rim at theta = pi/2;   a landing turns w into r w
//! a short hop at an inclination that is no right angle, with the rates at its middle:
//!   lasts (2 w/gamma) (1 - bend), and ends with w (1 + bend),   bend = (2/3) (gamma at the middle/gamma - 1)
//! the rest = the change in one cycle of two hops and two landings, over 1 - r r'
//! ```
//! The model is the block of Housner, Bull. Seismol. Soc. Am. 53, 403 (1963). Error: the square of the time that is
//! summed, and that time, times the angle by which a slow slip turns.

use crate::laws::contact::landing::{Outcome, land_at};
use crate::laws::contact::standstill::Standstill;
use crate::laws::state::{State, spin_of};
use crate::motions::Kind;
use crate::motions::body::body_walk::BodyWalk;
use crate::motions::body::own::Own;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, PHI, SIN, TIME, U2, UH, W1, W2, W3, loses, pose_rates, poses,
};

/// The longest time that is summed, over the time in which the body turns by a radian.
const SOON_OVER: f64 = 1e-6;
/// A rocking beside a slow slip is summed only if the slip turns by less than this angle in that time. Dry friction turns
/// it at a rate of up to this many times mu over its speed.
const TURNED: f64 = 1e-2;
const TURNS_SLIP: f64 = 3.0;
/// The longest hop that two terms of its series give, over the time in which the body or its slip turns by a radian.
const SHORT_HOP: f64 = 1e-4;

/// At a border that is no right angle a hop with a smaller w2 is as low as the roundings of theta.
const LOST_HOP: f64 = 1e-8;
/// Landings in three cycles of a rocking; the largest ratio of their velocities from cycle to cycle of which the rest is the
/// sum; and the share by which that ratio may change.
const LANDINGS: usize = 5;
const MOST_RATIO: f64 = 0.99;
const UNLIKE: f64 = 1e-3;

/// The rates of a body that hops on a border.
struct HopRates {
    w: [f64; 3],
    drift: [f64; 2],
    warms: f64,
    taken: f64,
    /// The rates of phi, psi, x and y.
    pose: [f64; 4],
    /// The speed of a dry slip, by which friction turns it; else infinite.
    speed: f64,
}

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// The numbers at the end of a rocking that has just begun another hop at theta = pi/2; None if the end is not
    /// near.
    pub(crate) fn rocks_out(&mut self) -> Option<([f64; N], f64)> {
        let (begin, state, takeoff) = (self.at, self.of.state, self.of.takeoff);
        let (body, slide, view) = (self.of.body, self.of.slide, self.made.path.view);
        let found = self.cycle(&begin);
        (self.at, self.of.state, self.of.takeoff) = (begin, state, takeoff);
        (self.of.body, self.of.slide, self.made.path.view) = (body, slide, view);
        found
    }

    #[inline(never)]
    fn cycle(&mut self, begin: &[f64; N]) -> Option<([f64; N], f64)> {
        let mut slowest = f64::INFINITY;
        for _ in 0..2 {
            let (rates, rises) = (self.rates_at_border(), self.at[W2]);
            slowest = slowest.min(rates.speed);
            if rates.w[1] >= 0.0 {
                return None;
            }
            self.moves_by(&rates, 2.0 * rises / -rates.w[1]);
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
        let fastest = [2, 4, 5, 6].into_iter().fold(1.0, |most: f64, i| most.max(begin[i].abs()));
        let left = end[TIME] - begin[TIME];
        let turns = left * (fastest + self.of.slide.law.strength * TURNS_SLIP / slowest);
        // A hop that is lost in the roundings of theta has no later one.
        let lost = self.of.body.has_row() && begin[W2] < LOST_HOP && left < TURNED;
        let sums = left * fastest < SOON_OVER && turns < TURNED;
        (share > 0.0 && (sums || lost)).then_some((end, left * if sums { turns } else { 1.0 }))
    }

    /// Whether the slip counts as zero.
    fn sticks_at_border(&self) -> bool {
        let [along, across] = self.at.slip();
        self.of.slide.law.dry && along.hypot(across) <= self.of.slide.over()
    }

    /// The rates at the border at which another circle lands, without those that a hop takes back.
    fn rates_at_border(&self) -> HopRates {
        let [w1, w3, theta] = [self.at[W1], self.at[W3], self.of.body.theta_end()];
        let (slip @ [along, across], law) = (self.at.slip(), &self.of.slide.law);
        let (angle, speed) = (self.of.body.border_angle(), along.hypot(across));
        let mut pose = [0.0; 4];
        if poses(N) {
            let spin = spin_of(angle, w1, w3);
            let over = [along, across + law.shape.rim.radius(angle) * spin];
            pose = pose_rates(self.at[PHI], [w1 / angle.0, spin], over);
        }
        if self.sticks_at_border() {
            let (w, taken) = self.rolling_of(&State { theta, w1, w2: 0.0, w3 });
            return HopRates { w, drift: [0.0; 2], warms: 0.0, taken, pose, speed: f64::INFINITY };
        }
        let (at, taken) = self.of.slide.slips(angle, [w1, 0.0, w3], slip, None);
        let warms = -(at.force[1] * across + at.force[2] * along);
        let speed = if law.dry { speed } else { f64::INFINITY };
        HopRates { w: at.w, drift: at.u, warms, taken, pose, speed }
    }

    /// Moves the walk on by this time at these rates, but for w2.
    fn moves_by(&mut self, rates: &HopRates, lasts: f64) {
        let HopRates { w, drift, warms, taken, pose, .. } = *rates;
        for (i, rate) in [(W1, w[0]), (W3, w[2]), (UH, drift[0]), (U2, drift[1]), (TIME, 1.0), (HEAT, warms)]
        {
            self.at[i] += lasts * rate;
        }
        if loses(N) {
            self.at[N - 1] += lasts * taken;
        }
        if poses(N) {
            self.at[PHI..].iter_mut().zip(pose).for_each(|(number, rate)| *number += lasts * rate);
        }
    }

    /// Computes a short hop that begins at the border at which another circle lands, up to its landing there. Returns
    /// whether there was one.
    ///
    /// An inclination is known to a rounding, in which such a hop is lost; at a right angle its cosine shows the hop.
    #[inline(never)]
    pub(crate) fn hops_shortly(&mut self) -> bool {
        if !self.of.body.has_row() {
            return false;
        }
        let (begin, rises) = (self.at, self.at[W2]);
        let first = self.rates_at_border();
        let lasts = 2.0 * rises / -first.w[1];
        let fastest = [W1, W3, UH, U2].into_iter().fold(1.0, |most: f64, i| most.max(begin[i].abs()));
        let turns = lasts * (fastest + self.of.slide.law.strength * TURNS_SLIP / first.speed);
        let ends = self.until().is_some_and(|t| t <= begin[TIME] + lasts);
        let slips = !self.sticks_at_border();
        let holds = if slips {
            self.of.slide.at_start(&State { w2: 0.0, ..self.of.state }, begin.slip()).is_none()
        } else {
            self.rests_here() == Standstill::Sticks
        };
        if ends || !holds || !(0.0..SHORT_HOP).contains(&turns) {
            return false;
        }
        if !slips {
            self.stop_slip();
        }
        self.begins_phase(if slips { Kind::Slipping } else { self.kind() });
        self.moves_by(&first, 0.5 * lasts);
        let middle = self.rates_at_border();
        // The body falls back faster or more slowly than it has risen.
        let bends = 2.0 / 3.0 * (middle.w[1] / first.w[1] - 1.0);
        self.at = begin;
        if !slips {
            self.stop_slip();
        }
        let lasts = lasts * (1.0 - bends);
        self.moves_by(&middle, lasts);
        self.at[W2] = -(rises * (1.0 + bends));
        self.of.state = State { w1: self.at[W1], w2: self.at[W2], w3: self.at[W3], ..self.of.state };
        self.made.path.slipping += if slips { lasts } else { 0.0 };
        self.claims(turns * turns * turns);
        true
    }
    /// The numbers at the end of a rocking whose slips stop in its hops, so that all of them shrink by one ratio: the changes
    /// from cycle to cycle are a geometric series. Also returns an error. None until three cycles have shown the ratio.
    #[inline(never)]
    pub(crate) fn shrinks_out(&mut self) -> Option<([f64; N], f64)> {
        if !self.of.body.has_row() {
            return None;
        }
        let all = &mut self.of.rocked;
        all.push(self.at.to_vec());
        if all.len() > LANDINGS {
            all.remove(0);
        }
        let [first, _, before, other, now] = &all[..] else { return None };
        // Landings on the other circle are seen from the other end.
        let ratio = now[W2] / before[W2];
        let steady = |ratio: f64, known: f64| (ratio / known - 1.0).abs();
        let lasted = (now[TIME] - before[TIME]) / (before[TIME] - first[TIME]);
        let unlike = steady(before[W2] / first[W2], ratio).max(steady(lasted, ratio));
        let turned = other[COS].signum() != now[COS].signum();
        if !(turned && ratio < MOST_RATIO && unlike < UNLIKE) {
            return None;
        }
        let share = ratio / (1.0 - ratio);
        let mut end: [f64; N] = core::array::from_fn(|i| now[i] + (now[i] - before[i]) * share);
        (end[SIN], end[COS]) = self.of.body.border_angle();
        end[W2] = 0.0;
        let left = end[TIME] - now[TIME];
        let error = left * (unlike / (1.0 - ratio) + left);
        let seen = left < SOON_OVER || self.until().is_none_or(|t| t > end[TIME]);
        seen.then_some((end, error))
    }
}
