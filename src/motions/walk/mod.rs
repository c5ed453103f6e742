//! The walk of a body or of a stone through the phases of its motion: how each phase begins, and which one follows.
//!
//! ```text
//! start    slips, sticks, or ends at once
//! slips    to u = 0: sticks, or slips off in another direction
//! rolls    to |F_roll| = mu_s N: slips off
//! both     to N = 0, or until a face, an edge or the other rim lands
//! ```
//! A phase stands here once, for bodies and for stones. [`Phases`] has what differs: the numbers, the equations along a
//! phase, and what they say about its beginning and its end.

mod phases;
mod slips;
pub(crate) mod slow;

use super::ask::Ask;
use super::followed::Followed;
use super::halt::{Halt, TIME};
use super::result::{Ending, Event, Kind, Motion, Path, Phase};
use super::{Method, Moving};
use crate::error::{Error, copied, room};
use crate::laws::contact::Table;
use crate::laws::contact::slip::Friction;
use crate::laws::contact::standstill::Standstill;
use crate::methods::flow::{PATIENCE, Spent, Steps, toil_of};
pub(crate) use phases::Phases;
pub(crate) use slips::{SlowLaw, SlowSeries};

/// Largest number of phases, of a short motion and of a long one, and for each unit of time between; some motions slip for
/// a moment in each nutation for ever.
const FEWEST_PHASES: usize = 5_000;
const MOST_PHASES: usize = 10_000;
const PHASES_PER_TIME: f64 = 20.0;
/// Largest number of phases that follow each other within no time.
pub(crate) const STILL: u32 = 6;
/// Length of a short phase of a body that loses energy, and largest number of them in turn (two dry laws alternate).
const SHORT: f64 = 1e-9;
const CHATTER: u32 = 200;
/// Number of crawling steps that each change of the motion adds to the patience.
const RENEWED: u64 = 1000;

/// A time so short that its square is below rounding.
pub(crate) const MOMENT: f64 = 1e-8;

/// A dry slip is over where its speed has fallen below this share of mu.
const OVER: f64 = 1e-13;

/// The speed below which a slip under friction of this strength counts as zero.
pub(crate) fn slip_over(dry: bool, strength: f64) -> f64 {
    if dry { OVER * strength.min(1.0) } else { 0.0 }
}

/// The largest number of phases, and of changes of the ways that dry losses resist, up to the last of the times.
pub(crate) fn most_phases(times: &[f64]) -> usize {
    times.last().map_or(FEWEST_PHASES, |t| ((PHASES_PER_TIME * t) as usize).clamp(FEWEST_PHASES, MOST_PHASES))
}

/// The next phase of a walk.
pub(crate) enum Next {
    /// A slip, with the slip among the numbers.
    Slips,
    /// The same slip, after a dry loss has changed its direction or the contact has settled.
    SlipsOn,
    /// A slip from rest along `alpha`, with a speed that grows at the rate `growth`.
    SlipsOff {
        alpha: f64,
        growth: f64,
    },
    /// Rolling, or free sliding on a smooth table. With `grace` static friction holds a little more than its limit.
    Rolls {
        grace: bool,
    },
    Ends(Ending),
}

/// The next task of the caller of a walk, or its end.
pub(crate) enum WalkStep<const N: usize> {
    /// The caller follows the flow from these numbers.
    Flows([f64; N]),
    /// The walk is complete.
    Done,
    /// The caller has interrupted the walk.
    Interrupted,
}

/// Whether a flow was left before its end.
#[derive(PartialEq)]
pub(crate) enum Pause<const N: usize> {
    No,
    /// The flow was left at these numbers, with this next step if it is known.
    Here([f64; N], Option<f64>),
    /// The caller has interrupted the flow.
    Interrupted,
}

/// The computation of a motion, phase by phase.
pub(crate) struct Walk<'a, P: Phases<N>, const N: usize> {
    /// The laws of the body or of the stone, and what is known of the present phase.
    pub of: P,
    pub ask: Ask,
    pub t0: f64,
    /// The requested times, counted from the start.
    pub since: Vec<f64>,
    times: &'a [f64],
    pub made: Followed<P::State>,
    /// The numbers where the present phase begins or has ended.
    pub at: [f64; N],
    pub next: Option<Next>,
    /// The time at which the present phase began.
    pub began: f64,
    /// Number of phases that have begun at the same time as the previous phase, and hardly later than it.
    pub still: u32,
    short: u32,
    /// The share by which a rougher run moves the state at each end of a phase. Where the motion is unstable, the
    /// difference of the two runs then shows the instability.
    pub shake: f64,
    pub spent: Spent,
    /// Whether the last steps have crawled.
    tired: bool,
}

impl<'a, P: Phases<N>, const N: usize> Walk<'a, P, N> {
    /// A walk at its start, without a first phase yet, with steps of the tolerance of `of`; `fine` is the requested one.
    pub fn new(
        of: P,
        at: [f64; N],
        ask: &Ask,
        fine: f64,
        (t0, times): (f64, &'a [f64]),
    ) -> Result<Self, Error> {
        let mut since = copied(times)?;
        // The sum turns -0 into 0.
        since.iter_mut().for_each(|t| *t = *t - t0 + 0.0);
        let (count, tol) = (times.len(), of.tol());
        let mut motion = Motion::empty(count, ask.pose)?;
        if ask.force {
            (motion.forces, motion.force_error) = (Some(room(count)?), 0.0);
        }
        motion.method = Method::Tolerance(tol);
        let path = Path::empty(count, if ask.losses.is_none() { 0 } else { count })?;
        Ok(Self {
            // The scaling of the claimed error reduces this share to a few roundings.
            shake: if tol > fine { f64::EPSILON * tol / (fine * P::State::SAFETY) } else { 0.0 },
            of,
            ask: *ask,
            t0,
            since,
            times,
            made: Followed { motion, path },
            at,
            next: None,
            began: f64::NEG_INFINITY,
            still: 0,
            short: 0,
            spent: Spent { evaluations: 0, erred: 0.0, patience: PATIENCE },
            tired: false,
        })
    }

    /// The whole motion; None if it was interrupted.
    pub fn run(mut self, go_on: &mut dyn FnMut() -> bool) -> Result<Option<Followed<P::State>>, Error> {
        loop {
            match self.advance(go_on)? {
                WalkStep::Flows(mut y) => {
                    let mut step = None;
                    loop {
                        match self.flows(y, step, u64::MAX, go_on)? {
                            Pause::Here(there, next) => (y, step) = (there, next),
                            Pause::No => break,
                            Pause::Interrupted => return Ok(None),
                        }
                    }
                }
                WalkStep::Done => return Ok(Some(self.done()?)),
                WalkStep::Interrupted => return Ok(None),
            }
        }
    }

    /// Goes through the phases up to one that is integrated, or to the end.
    pub fn advance(&mut self, go_on: &mut dyn FnMut() -> bool) -> Result<WalkStep<N>, Error> {
        while let Some(next) = self.next.take() {
            let now = self.at[TIME];
            self.still = if now > self.began { 0 } else { self.still + 1 };
            self.short = if now > self.began + SHORT { 0 } else { self.short + 1 };
            if P::is_over(self, &next) {
                break;
            }
            let count = self.made.path.phases.len();
            let chatters = self.still > STILL || !self.ask.losses.is_none() && self.short > CHATTER;
            let too_many = chatters || count > most_phases(&self.since);
            let next = match next {
                Next::Ends(_) => next,
                _ if too_many => P::gives_up(self, count)?,
                _ => next,
            };
            match next {
                Next::Ends(ending) => {
                    self.meets(ending);
                    self.made.path.last_slip = P::slip(self);
                    self.stays_there();
                }
                Next::Rolls { grace } => {
                    self.opens(self.kind());
                    if self.ask.stop_at_rolling {
                        self.made.path.rolls_on = true;
                    } else if let Some(step) = P::rolls(self, grace, go_on)? {
                        return Ok(step);
                    }
                }
                Next::Slips => {
                    self.opens(Kind::Slipping);
                    return Ok(WalkStep::Flows(P::slips(self)));
                }
                Next::SlipsOn => {
                    self.began = now;
                    return Ok(WalkStep::Flows(P::slips_on(self)));
                }
                Next::SlipsOff { alpha, growth } => {
                    if let Some(y) = self.slips_off((alpha, growth)) {
                        return Ok(WalkStep::Flows(y));
                    }
                }
            }
        }
        Ok(WalkStep::Done)
    }

    /// Follows the flow of a phase from the numbers `y`, for at most `most` steps.
    pub fn flows(
        &mut self,
        y: [f64; N],
        first: Option<f64>,
        most: u64,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        let toil = toil_of(self.since.last().copied().unwrap_or(0.0)).saturating_sub(self.spent.evaluations);
        let first = Some(first.unwrap_or_else(|| P::first(self, &y)));
        let steps = Steps { first, most, patience: self.spent.patience, toil, tired: self.tired };
        self.tired = false;
        P::flows(self, y, steps, go_on)
    }

    /// The phase that begins at the present numbers, as at the start. The error is that of a start without a unique force.
    pub fn first_phase(&mut self) -> Result<Next, Error> {
        if !self.ask.table.rubs() {
            return Ok(P::begins_without_slip(self));
        }
        let [u, v] = [self.at[P::SLIP], self.at[P::SLIP + 1]];
        if u.hypot(v) > self.of.over() || !self.of.is_dry() {
            return match P::ends_slip(self) {
                Some(Halt::Jam) => Err(P::jam(self)),
                Some(halt) => Ok(Next::Ends(ending(halt))),
                None => Ok(Next::Slips),
            };
        }
        self.stop_slip();
        let found = P::rests(self);
        if let Some(ending) = P::lies(self, found) {
            return Ok(Next::Ends(ending));
        }
        match after_rest(found) {
            Next::Ends(Ending::Painleve) => Err(P::jam(self)),
            next => Ok(next),
        }
    }

    /// The slip has come to its end.
    pub fn stop_slip(&mut self) {
        (self.at[P::SLIP], self.at[P::SLIP + 1]) = (0.0, 0.0);
    }

    /// Sets the next phase. A rolling phase of no length, which needed all of the friction that could hold the contact
    /// point, is left out.
    pub fn goes_on(&mut self, next: Next) {
        if !matches!(next, Next::Ends(_)) {
            let now = self.t0 + self.at[TIME];
            self.made.path.phases.pop_if(|phase| phase.kind == Kind::Rolling && phase.time == now);
            P::shake(self);
        }
        self.next = Some(next);
    }

    /// Records the beginning of a phase. Every change of the motion may need a few crawling steps.
    pub fn opens(&mut self, kind: Kind) {
        self.began = self.at[TIME];
        self.renews();
        let (time, state, slip) = (self.t0 + self.at[TIME], P::state(self), P::slip(self));
        self.made.path.phases.push(Phase { time, kind, state, slip });
    }

    /// Renews the patience with steps that crawl.
    pub fn renews(&mut self) {
        self.spent.patience = (self.spent.patience + RENEWED).min(PATIENCE);
    }

    /// Records an event that the model does not cover, at the present numbers.
    pub fn meets(&mut self, ending: Ending) {
        let event = Event { ending, time: self.t0 + self.at[TIME], state: P::state(self) };
        self.made.motion.event.get_or_insert(event);
    }

    /// Writes the outputs up to an end at which no flow has written them, as at the start.
    pub fn stays_there(&mut self) {
        while self.until().is_some_and(|t| t <= self.at[TIME]) {
            P::write_here(self);
        }
    }

    /// The finished motion and its path.
    pub fn done(mut self) -> Result<Followed<P::State>, Error> {
        let count = self.made.motion.states.len();
        self.made.motion.times = copied(&self.times[..count])?;
        self.made.motion.evaluations = self.spent.evaluations;
        self.made.path.erred = self.spent.erred * self.of.tol();
        self.made.path.heat = self.at[P::HEAT];
        self.made.path.lost = if self.ask.losses.is_none() { 0.0 } else { self.at[N - 1] };
        Ok(self.made)
    }

    /// The next requested time, counted from the start.
    pub fn until(&self) -> Option<f64> {
        self.since.get(self.made.motion.states.len()).copied()
    }

    /// The kind of a phase without a slip under friction: `Slipping` on a smooth table, else `Rolling`.
    pub fn kind(&self) -> Kind {
        if self.ask.table == Table::Smooth { Kind::Slipping } else { Kind::Rolling }
    }

    pub fn friction(&self) -> Friction {
        self.ask.table.friction()
    }

    /// Claims at least this error.
    pub fn claims(&mut self, error: f64) {
        self.made.motion.error = self.made.motion.error.max(error);
    }

    /// Claims the error of the time of an end at `y`: the errors of the steps, divided by the rate at which the margin, or
    /// the speed of a body that comes to rest, fell.
    pub fn doubts(&mut self, halt: Halt, steep: f64, y: &[f64; N]) {
        if let Some(grows) = self.of.grows(halt, y) {
            let erred = grows * (self.spent.erred * self.of.tol() + 8.0 * f64::EPSILON);
            // A margin that only touches zero bends away from zero.
            self.claims((erred / steep).min(erred.sqrt()));
        }
    }

    /// Adds the cost of a flow.
    pub fn has_spent(&mut self, Spent { evaluations, erred, patience }: Spent) {
        self.spent.evaluations += evaluations;
        self.spent.erred += erred;
        self.spent.patience = patience;
    }

    /// Adds the cost of a flow that a lane has followed with a part of the patience.
    pub fn has_spent_elsewhere(&mut self, spent: Spent, given: u64) {
        let crawled = given - spent.patience.min(given);
        self.tired = spent.patience == 0;
        self.has_spent(Spent { patience: self.spent.patience.saturating_sub(crawled), ..spent });
    }
}

/// The phase after a contact point has come to rest, or has been let go.
pub(crate) fn after_rest(found: Standstill) -> Next {
    match found {
        Standstill::Sticks => Next::Rolls { grace: false },
        Standstill::Slips { alpha, growth } => Next::SlipsOff { alpha, growth },
        Standstill::LiftsOff => Next::Ends(Ending::LiftOff),
        Standstill::Undefined => Next::Ends(Ending::Painleve),
    }
}

/// The ending that a halt means for the motion.
pub(crate) fn ending(halt: Halt) -> Ending {
    match halt {
        Halt::Time | Halt::Pause | Halt::Standstill => Ending::Done,
        Halt::Face => Ending::Face,
        Halt::Side => Ending::Side,
        Halt::LiftOff => Ending::LiftOff,
        Halt::Jam => Ending::Painleve,
        Halt::Slips => Ending::Slip,
        Halt::Contour | Halt::Drilling | Halt::Rocking | Halt::Settles | Halt::Rests => Ending::Stops,
        Halt::Endless => Ending::Bounded,
    }
}
