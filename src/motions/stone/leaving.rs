//! A stone whose contact point rests, and a slip that begins from rest.

use super::flow::{ALL, MARGINS, Touch, spot};
use super::motion::{NextPhase, StoneWalk};
use super::turns::Spot;
use super::write::write;
use crate::laws::contact::slip::Friction;
use crate::laws::contact::standstill::{HeldContact, Onset, towards};
use crate::laws::stone::law::{across, laboratory, turning};
use crate::methods::flow::{Flown, Spent};
use crate::motions::Ending;
use crate::motions::Kind;
use crate::motions::halt::Halt;
use crate::motions::path::leaving::{SlowRates, SlowSlip, SlowSlips, are_clear};
use crate::numbers::vector::dot;
use crate::numbers::{Series, Sum};

/// From this share of the coefficient without a unique force on, all answers are searched for.
const DOUBTFUL: f64 = 0.9;
/// Number of parts of the series of a slip between which its margins are checked.
const CLOSELY: usize = 16;
/// A slip whose speed begins to grow faster than this does not stay slow; a slower one may be followed by another series.
const SLOWLY: f64 = 0.02;

impl StoneWalk<'_> {
    /// A contact point at rest, and the forces on it.
    pub(super) fn rest(&self) -> HeldContact<impl Fn(f64) -> Option<f64>> {
        let law = self.flow.law;
        let (lab, w) =
            (laboratory(core::array::from_fn(|i| self.at[i])), [self.at[4], self.at[5], self.at[6]]);
        let at = law.touching(lab[2], w);
        let free = law.pulled(&at, w, [0.0; 3]);
        let held = law.rolling(&at, w).force;
        let [along, aside, normal] = lab.map(|axis| dot(axis, held));
        // The rate of the slip per force along the axes of the laboratory.
        let per = lab.map(|axis| law.yields(&at, axis));
        let [mu, fixed] = match self.friction {
            Friction::Coulomb { mu, fixed } => [mu, fixed],
            Friction::Viscous { .. } => [0.0; 2],
        };
        let element = |i: usize, j: usize| dot(lab[i], per[j]);
        let upright = element(2, 2);
        let eps = [0, 1].map(|i| mu * element(2, i) / upright);
        let rate = law.slip_rate(&at, w, &free);
        let normal_free = free.free / upright;
        let bare = [0, 1].map(|i| dot(lab[i], rate) - normal_free * element(i, 2));
        HeldContact {
            mu: [mu, fixed],
            free: normal_free,
            held: [normal, along.hypot(aside)],
            against: f64::atan2(-aside, -along),
            doubtful: eps[0].hypot(eps[1]) >= DOUBTFUL,
            onset: Onset {
                mu,
                free: normal_free,
                eps,
                bare,
                pressed: [Sum::from(element(0, 2)), Sum::from(element(1, 2))],
                pulled: [element(0, 0), element(1, 1), element(0, 1)],
            },
            growth: move |alpha| {
                let way = towards(alpha);
                let to = law.pulled(&at, w, across(&lab, way));
                let rate = law.slip_rate(&at, w, &to);
                let along = |i: usize| way[i] * dot(lab[i], rate);
                (to.free > 0.0 && to.room > 0.0).then_some(along(0) + along(1))
            },
        }
    }

    /// Follows a slip from rest by its series. Returns the numbers at which a flow takes over, if one does.
    pub(super) fn slips_off(&mut self, way: (f64, f64)) -> Option<[f64; ALL]> {
        self.flow.touch = Touch::Slips;
        let mut slips = self.slow_slips();
        let (mut angle, mut speed) = ((Series::of(way.0), way.1), 0.0);
        loop {
            let start: [f64; 7] = core::array::from_fn(|i| self.at[i]);
            let Some(slow) = slips.follow(start, angle, speed) else {
                if speed > 0.0 {
                    return Some(self.at);
                }
                self.next = Some(NextPhase::Ends(Ending::Painleve));
                return None;
            };
            let numbers = self.series(&slips, &slow);
            let (until, ends) = slow.until(&numbers[..11]);
            if speed > 0.0 && !slow.pays(until) {
                return Some(self.at);
            }
            if ends && until == 0.0 {
                // Rolling needs all of the friction that can hold the contact point, and no more.
                self.next = Some(NextPhase::Rolls { grace: true });
                return None;
            }
            if speed == 0.0 {
                self.opens(Kind::Slipping);
                self.flow.way = towards(way.0);
            }
            let value = |t: f64| -> [f64; ALL] { core::array::from_fn(|i| numbers[i].value(t)) };
            let part = self.safe(until, &value);
            let whole = part == until;
            let last = self.since.last().map_or(0.0, |t| t - self.at[7]);
            let until = part.min(last);
            let first = self.made.motion.states.len();
            let t0 = self.at[7];
            for t in self.since[first..].iter().take_while(|t| **t <= t0 + until) {
                let mut y = value(t - t0);
                y[7] = *t;
                write(&mut self.made, (&self.flow, self.ask, self.still_centre), &y);
            }
            self.at = value(until);
            let mut noted = self.flow.noted.map(|noted| noted.borrow_mut());
            if let Some(turns) = noted.as_mut().and_then(|noted| noted.turns.as_mut()) {
                let at = |t: f64| {
                    let rate = core::array::from_fn(|i| numbers[i].slope().value(t - t0));
                    Spot { t, ..spot(&value(t - t0), &rate) }
                };
                turns.follow(&at, at(t0), at(t0 + until));
            }
            drop(noted);
            let over = self.made.motion.states.len() == self.since.len();
            if over || (ends && whole) {
                if !over {
                    (self.at[8], self.at[9]) = (0.0, 0.0);
                }
                let halt = if over { Halt::Time } else { Halt::Standstill };
                let spent = Spent { evaluations: 0, erred: 0.0, patience: self.spent.patience };
                self.halted(&Flown { halt, y: self.at, step: 0.0, steep: f64::INFINITY, spent });
                return None;
            }
            // A slip that stays slow has a settled direction, which a flow would follow in tiny steps.
            if !whole || way.1 >= SLOWLY {
                return Some(self.at);
            }
            speed = self.at[8].hypot(self.at[9]);
            angle = (slow.angle.about(until), 0.0);
        }
    }

    /// The slow slips of this stone. The rates beside those of its numbers are those of the heat and of the contact point.
    fn slow_slips(&self) -> SlowSlips<7> {
        SlowSlips::of(self.flow.tol, |tape, [a, b, c, d, e, f, g], slip, way| {
            let law = self.flow.law.map(|x| tape.number(x));
            let (q, w) = ([a, b, c, d], [e, f, g]);
            let lab = laboratory(q);
            let at = law.touching(lab[2], w);
            let to = law.pulled(&at, w, across(&lab, way));
            let rate = law.slip_rate(&at, w, &to);
            let heat = -(slip[0] * dot(lab[0], to.force) + slip[1] * dot(lab[1], to.force));
            let [x, y] = [0, 1].map(|i| slip[i] + dot(lab[i], at.r_rate));
            let ([a, b, c, d], [e, f, g]) = (turning(q, w), to.w);
            let slip = [dot(lab[0], rate), dot(lab[1], rate)];
            SlowRates { numbers: [a, b, c, d, e, f, g], slip, more: vec![heat, x, y] }
        })
    }

    /// The series of all numbers from that of a slow slip.
    fn series(&self, slips: &SlowSlips<7>, slow: &SlowSlip<7>) -> [Series; ALL] {
        let mut all = [Series::of(1.0).integral(self.at[7]); ALL];
        all[..7].copy_from_slice(&slow.known);
        all[8..10].copy_from_slice(&slow.slip);
        (0..3).for_each(|i| all[10 + i] = slips.more(i).integral(self.at[10 + i]));
        all
    }

    /// The time up to which a series may be used, before any end of the slip.
    fn safe(&self, mut until: f64, value: &dyn Fn(f64) -> [f64; ALL]) -> f64 {
        for _ in 0..60 {
            let part = |k: usize| value(until * k.max(1) as f64 / CLOSELY as f64);
            let margins: Vec<[f64; MARGINS]> =
                (0..=CLOSELY).map(|k| self.flow.margins_at(&part(k))).collect();
            if are_clear(&margins) {
                break;
            }
            until *= 0.5;
        }
        until
    }
}
