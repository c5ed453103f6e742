//! The slipping phases of a walk, from rest or from a slip to their end.

use super::write::state;
use super::{Next, Pause, Walk, ending};
use crate::error::Error;
use crate::laws::contact::standstill::{standstill, towards};
use crate::methods::flow::{Flow, FlowPlace, Flown, Spent, Steps};
use crate::motions::Ending;
use crate::motions::Kind;
use crate::motions::halt::{Halt, loses};
use crate::motions::path::face::turning_share;
use crate::motions::path::leaving::Leaves;
use crate::motions::path::slide::Slide;

/// Number of steps between two looks at a whirr that slips.
const LOOKS: u64 = 64;

/// A slip whose speed begins to grow faster than this does not stay slow.
const SLOWLY: f64 = 0.02;

impl<const N: usize> Walk<'_, N> {
    /// Follows a slip from rest by its series. Returns the numbers at which an integrator takes over, if one does.
    pub(super) fn slips_off(&mut self, way: (f64, f64)) -> Option<[f64; N]> {
        self.slide.face(&self.state, [0.0; 2], towards(way.0));
        let mut leaves = Leaves::of(&self.slide.law, self.slide.tol, N);
        let Some(series) = leaves.off(&self.state, way) else {
            self.next = Some(Next::Ends(Ending::Painleve));
            return None;
        };
        if series.ends && series.until == 0.0 {
            // Rolling needs all of the friction that can hold the contact point, and no more.
            self.next = Some(Next::Rolls { grace: true });
            return None;
        }
        self.opens(Kind::Slipping, [0.0; 2]);
        self.made.path.way = towards(way.0);
        if !series.is_sound() {
            let first = self.made.motion.states.len();
            let y = self.slide.nudged(&self.at, towards(way.0), way.1);
            let here = self.since[first..].partition_point(|t| *t <= y[7]);
            (0..here).for_each(|_| self.made.slid(&self.ask, &self.slide, &self.at));
            return Some(y);
        }
        let (slide, ask) = (self.slide, self.ask);
        let (mut series, mut at) = (series, self.at);
        loop {
            let first = self.made.motion.states.len();
            let made = &mut self.made;
            let until = slide.safe(&series);
            let whole = until == series.until;
            let mut write = |y: &[f64; N]| made.slid(&ask, &slide, y);
            at = slide.leave(&series, until, &at, &self.since[first..], &mut write);
            let over = self.made.motion.states.len() == self.since.len();
            if over || (series.ends && whole) {
                (at[5], at[6]) = if over { (at[5], at[6]) } else { (0.0, 0.0) };
                let halt = if over { Halt::Time } else { Halt::Standstill };
                let spent = Spent { evaluations: 0, erred: 0.0, patience: self.spent.patience };
                self.halted(Flown { halt, y: at, step: 0.0, steep: f64::INFINITY, spent });
                return None;
            }
            // A slip that stays slow has a settled direction, which an integrator would follow in tiny steps.
            let speed = at[5].hypot(at[6]);
            let next = if whole && way.1 < SLOWLY {
                leaves.slowly(&state(&at), series.angle.about(until), speed)
            } else {
                None
            };
            match next.filter(|next| next.pays) {
                Some(next) => series = next,
                None => return Some(at),
            }
        }
    }

    /// Follows a slip from `place`, within the limits `steps`.
    pub(super) fn slides(
        &mut self,
        place: FlowPlace<N>,
        steps: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        let (slide, first) = (self.slide, self.made.motion.states.len());
        // A whirr that slips is looked at from time to time, so that its end is known before its last turns.
        let most = if self.tail.is_some() { steps.most.min(LOOKS) } else { steps.most };
        let steps = Steps { most, ..steps };
        let (ask, made) = (self.ask, &mut self.made);
        let mut write = |y: &[f64; N]| made.slid(&ask, &slide, y);
        let Some(slid) = slide.run(place, steps, &self.since[first..], &mut write, go_on)? else {
            return Ok(Pause::Interrupted);
        };
        if slid.halt == Halt::Pause {
            self.has_spent(slid.spent);
            if let Some(end) = self.whirr_ends(&slid.y) {
                self.arrives(slid.y);
                self.made.path.slipping += end[0] - self.began;
                self.made.path.leaves_turns = true;
                self.lies_flat(end);
                return Ok(Pause::No);
            }
            return Ok(Pause::Here(slide.enter(&slid.y), Some(slid.step)));
        }
        self.halted(slid);
        Ok(Pause::No)
    }

    /// Ends a slip and chooses the next phase.
    pub(super) fn halted(&mut self, slid: Flown<Halt, N>) {
        if self.slide.settled && loses(N) {
            // The energy that a settled contact seems to win or lose is an error of its numbers.
            let sum = |y: &[f64; N]| self.slide.energy(y) + y[8] + y[N - 1];
            let won = sum(&slid.y) - sum(&self.at);
            self.made.motion.error = self.made.motion.error.max(won.abs());
        }
        self.arrives(slid.y);
        self.has_spent(slid.spent);
        self.doubts(slid.halt, slid.steep, &slid.y);
        if slid.halt == Halt::Face {
            let [s, c, w1, w2] = core::array::from_fn(|i| self.at[i]);
            let turns = turning_share(self.body.i1(), s, w1, w2) >= 0.25;
            let end = self.tail.and_then(|tail| tail.end()).filter(|[end, _]| turns && *end >= self.at[7]);
            let fall = (c * w2).max(0.0);
            let [end, doubt] = end.unwrap_or([self.at[7] + if fall > 0.0 { s / fall } else { 0.0 }, 0.0]);
            (self.at[0], self.at[7]) = (0.0, end);
            self.made.motion.error = self.made.motion.error.max(doubt);
        }
        self.made.path.slipping += self.at[7] - self.began;
        if self.slide.drill_held() && !matches!(slid.halt, Halt::Time | Halt::Pause) {
            self.stills();
        }
        let (body, mut y) = (self.body, state(&self.at));
        let next = match slid.halt {
            Halt::Time | Halt::Pause => return,
            Halt::Standstill => self.after_rest(standstill(&body, &y, &self.friction(), &self.ask.losses)),
            Halt::Settles => {
                self.slide.settled = true;
                self.made.motion.error = self.made.motion.error.max(Slide::settled_doubt(&y));
                Next::SlipsOn
            }
            Halt::Contour | Halt::Drilling | Halt::Rocking => {
                let slip = [self.at[5], self.at[6]];
                if slid.halt == Halt::Contour && self.slide.settled {
                    self.made.motion.error = self.made.motion.error.max(self.slide.settled_lag(&y, slip));
                }
                if self.slide.turns(slid.halt, &y, slip) { Next::SlipsOn } else { Next::Ends(Ending::Stops) }
            }
            halt => Next::Ends(ending(halt)),
        };
        if slid.halt == Halt::Side {
            y.theta = body.theta_end();
        }
        self.state = y;
        if slid.halt == Halt::Standstill {
            self.shake();
        }
        self.next =
            Some(if slid.halt == Halt::Side && self.ask.restitution.is_some() { self.lands() } else { next });
    }
}
