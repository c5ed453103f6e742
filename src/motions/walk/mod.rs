//! The computation of a motion through its phases, such as rolling, slipping and flying, for a body or a stone: how
//! each phase begins, and which comes next.
//!
//! ```text
//! start    slips, sticks, or ends at once
//! slips    to u = 0: sticks, or slips off in another direction
//! rolls    to |F_roll| = mu_s N: slips off
//! both     to N = 0, or until a face, an edge or the other rim lands
//! with restitution: in the air to a landing, an impact, and on; on both rims until one rises
//! ```
//! Bodies of revolution and stones share this code. The trait [`Phases`] has the differences: the components of the
//! state vector, the equations of motion in each phase, and the conditions for its beginning and its end.

pub(crate) mod errors;
pub(crate) mod hops;
pub(crate) mod numbers;
mod phases;
mod slips;
pub(crate) mod slow;
pub(crate) mod two_runs;

use super::ask::Ask;
use super::{Method, Moving};
use crate::error::{Error, copied, grow};
use crate::laws::contact::Table;
use crate::laws::contact::slip::Friction;
use crate::laws::contact::standstill::Standstill;
use crate::methods::flow::{PATIENCE, Spent, Steps, toil_of};
use crate::motions::ask::result::{Ending, Event, Kind, Limit, Phase, Strike};
use crate::motions::walk::numbers::{Halt, TIME};
use crate::motions::walk::two_runs::{BRIEF_PHASE, Followed};
use crate::numbers::larger_or_nan;
use hops::Hops;
pub(crate) use phases::Phases;
pub(crate) use slips::{SlowLaw, SlowSeries};

/// Least value of the largest number of phases of a motion, which is `PHASES_PER_TIME` per unit of time, but at most
/// `MOST_PHASES`. The computation stops after this number: some motions slip for a moment in each nutation for ever.
const FEWEST_PHASES: usize = 5_000;
const MOST_PHASES: usize = 10_000;
const PHASES_PER_TIME: f64 = 20.0;
/// Largest number of impacts of a motion, after which its computation stops; the flight after each is fast to
/// compute.
const MOST_IMPACTS: usize = 30_000;
/// Largest number of consecutive phases of zero duration, after which the computation of a motion stops.
pub(crate) const STILL: u32 = 6;
/// Largest duration of a phase that counts as short. The computation of a body with losses stops after more than
/// `MOST_SHORT_PHASES` short phases in a row without a flight, in which two laws of dry friction alternate without
/// end.
const SHORT_PHASE: f64 = 1e-9;
const MOST_SHORT_PHASES: u32 = 200;
/// Number of additional very short steps that are allowed after each change of the phase, since short steps after a
/// change do not mean that time hardly advances.
const CRAWLING_STEPS_PER_CHANGE: u64 = 1000;

/// Duration of the first step of a slip from rest that has no power series. The step is a straight line, since its
/// square is below rounding.
pub(crate) const MOMENT: f64 = 1e-8;

/// A slip under dry friction ends where its speed has fallen below this share of mu; the time to zero is extrapolated
/// linearly.
const OVER: f64 = 1e-13;
/// Number of steps between two calls of `go_on`, at which a power series may also replace the integration of a slow
/// slip.
const BREATH: u64 = 256;

/// The speed below which a slip under friction of this strength counts as zero.
pub(crate) fn slip_over(dry: bool, strength: f64) -> f64 {
    if dry { OVER * strength.min(1.0) } else { 0.0 }
}

/// The largest number of phases up to the last of the times. It also limits how often a rotation against dry friction
/// may stop or begin within phases.
pub(crate) fn most_phases(times: &[f64]) -> usize {
    times.last().map_or(FEWEST_PHASES, |t| ((PHASES_PER_TIME * t) as usize).clamp(FEWEST_PHASES, MOST_PHASES))
}

/// The next phase of a motion.
pub(crate) enum Next {
    /// A slip with the current velocity.
    Slips,
    /// The same slip continues, after a motion that dry losses resist has stopped or begun, or after the
    /// contact has settled.
    SlipsOn,
    /// A slip from rest along `alpha`, with a speed that grows at the rate `growth`.
    SlipsOff {
        alpha: f64,
        growth: f64,
    },
    /// Rolling, or free sliding on a smooth table. If `at_limit` is true, static friction may exceed its limit by the
    /// share `GRACE`, for rolling that needs exactly the limiting friction.
    Rolls {
        at_limit: bool,
    },
    /// A phase other than rolling and slipping: in the air, or on both rims.
    Own(Kind),
    Ends(Ending),
}

/// The next task for the caller that computes a motion phase by phase, or the end of the motion.
pub(crate) enum WalkStep<const N: usize> {
    /// The caller integrates the equations of the current phase from this state vector on.
    Flows([f64; N]),
    /// The caller computes a phase of rolling with this coefficient of static friction by the first integrals,
    /// together with those of other motions.
    #[cfg(feature = "many")]
    Rolls(f64),
    /// The motion is complete.
    Done,
}

/// Whether the integration of a phase has paused before its end.
#[derive(PartialEq)]
pub(crate) enum Pause<const N: usize> {
    No,
    /// The integration has paused at this state vector, with this next step if it is known.
    Here([f64; N], Option<f64>),
}

/// The computation of a motion, phase by phase.
pub(crate) struct Walk<'a, P: Phases<N>, const N: usize> {
    /// The equations of motion of the body or of the stone, and the data of the current phase.
    pub of: P,
    pub ask: Ask,
    pub t0: f64,
    /// The requested times, relative to the initial time.
    pub since: Vec<f64>,
    times: &'a [f64],
    pub made: Followed<P::State>,
    /// An error if the memory did not suffice for all phases and impacts; it ends the computation before the next
    /// phase.
    memory_result: Result<(), Error>,
    /// The state vector at the beginning of the current phase, or at its end once it has ended.
    pub at: [f64; N],
    pub next: Option<Next>,
    /// The time at which the current phase began.
    pub began: f64,
    /// Whether the phase that begins is a continuation of the one before.
    resumes: bool,
    /// The time at which the phase last changed, or a dry rotation last stopped or began.
    last_change: f64,
    /// The beginning of the next flight, and the energy lost in impacts so far.
    pub hops: Hops,
    /// Number of consecutive changes of the motion that happened at the same time as the change before.
    pub still: u32,
    /// Number of consecutive changes of the motion that happened at most `SHORT_PHASE` later than the change before.
    short: u32,
    /// How often a rotation against dry friction has stopped or begun within a phase.
    turns: usize,
    /// Largest number of steps so short that time hardly advances.
    crawling: u64,
    /// The share by which the run with the larger tolerance perturbs the state at each end of a phase; 0 in the other
    /// run. Where the motion is unstable, the difference of the two runs then shows the instability.
    pub perturbation: f64,
    pub spent: Spent,
    looked: slips::Looked,
    /// Number of steps since the last call of `go_on`, if the phases are shorter than the interval between calls.
    steps_since_call: u64,
    /// The power series of the last slow slip.
    slow: Option<Box<P::Slow>>,
    /// Whether the SIMD code has used up the very short steps that are allowed, so that the next integration is
    /// tested at once for not advancing.
    tired: bool,
}

impl<'a, P: Phases<N>, const N: usize> Walk<'a, P, N> {
    /// The computation of a motion at its initial state, before the first phase is chosen. The tolerance of its steps
    /// is that of `of`; in the second run, which shows the error, it exceeds the requested tolerance `fine`.
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
        let tol = of.tol();
        let mut made = Followed::empty(times.len(), ask, P::loses(ask))?;
        made.motion.method = Method::Tolerance(tol);
        let crawling = ask.max_evaluations.map_or(PATIENCE, |most| PATIENCE.max(most));
        Ok(Self {
            // The estimated error is SAFETY fine/tol times the difference of the runs, to which this share adds one
            // rounding.
            perturbation: if tol > fine { f64::EPSILON * tol / (fine * P::State::SAFETY) } else { 0.0 },
            of,
            ask: *ask,
            t0,
            since,
            times,
            made,
            memory_result: Ok(()),
            at,
            next: None,
            began: f64::NEG_INFINITY,
            resumes: false,
            last_change: f64::NEG_INFINITY,
            hops: Hops::default(),
            still: 0,
            short: 0,
            turns: 0,
            crawling,
            spent: Spent { evaluations: 0, erred: 0.0, patience: crawling, exhausted: None },
            looked: slips::Looked::default(),
            steps_since_call: 0,
            slow: None,
            tired: false,
        })
    }

    /// Computes the whole motion, or the motion up to the limit at which the computation stops.
    #[allow(clippy::boxed_local)] // On the heap it leaves the stack to the flows.
    pub fn run(mut self: Box<Self>, go_on: &mut dyn FnMut() -> bool) -> Result<Followed<P::State>, Error> {
        loop {
            match self.advance(go_on)? {
                WalkStep::Flows(mut y) => {
                    let mut step = None;
                    while let Pause::Here(there, next) = self.flows(y, step, u64::MAX, go_on)? {
                        (y, step) = (there, next);
                    }
                }
                WalkStep::Done => return self.done(),
                #[cfg(feature = "many")]
                WalkStep::Rolls(_) => unreachable!("a walk that runs alone rolls alone"),
            }
        }
    }

    /// Computes phases up to the first that the caller has to integrate, or to the end of the motion.
    #[inline(never)] // its frame is not on the stack of the flows
    pub fn advance(&mut self, go_on: &mut dyn FnMut() -> bool) -> Result<WalkStep<N>, Error> {
        while let Some(next) = self.next.take() {
            self.memory_result?;
            let next = self.goes_on(next);
            P::audits(self);
            if matches!(next, Next::Own(Kind::Flying)) {
                // Bounces have a limit of their own.
                self.short = 0;
            }
            let limit = self.changes();
            if P::is_over(self, &next, limit.is_some()) {
                continue;
            }
            let next = match limit {
                Some(limit) if !matches!(next, Next::Ends(_)) => self.gives_up(limit),
                _ => next,
            };
            match next {
                Next::Ends(ending) => {
                    self.records_event(ending);
                    self.made.path.last_slip = P::seen(self, self.kind()).slip;
                    self.writes_up_to_now();
                }
                Next::Rolls { at_limit } => {
                    self.begins_phase(self.kind());
                    if self.ask.stop_at_rolling {
                        self.made.path.rolls_on = true;
                        self.writes_up_to_now();
                    } else if let Some(step) = P::rolls(self, at_limit, go_on)? {
                        return Ok(step);
                    }
                }
                Next::Own(kind) => {
                    self.begins_phase(kind);
                    if let Some(step) = P::goes(self, kind, go_on)? {
                        return Ok(step);
                    }
                }
                Next::Slips => {
                    self.begins_phase(Kind::Slipping);
                    if !P::slips_known(self) {
                        let y = P::slips(self);
                        self.note_slip(&y);
                        return Ok(WalkStep::Flows(y));
                    }
                }
                Next::SlipsOn => {
                    self.began = self.at[TIME];
                    let y = P::slips_on(self);
                    self.note_slip(&y);
                    return Ok(WalkStep::Flows(y));
                }
                Next::SlipsOff { alpha, growth } => {
                    if let Some(y) = self.slips_off((alpha, growth)) {
                        self.note_slip(&y);
                        return Ok(WalkStep::Flows(y));
                    }
                }
            }
        }
        Ok(WalkStep::Done)
    }

    /// Counts a change of the motion at the current time: a phase begins, or dry friction stops, holds or lets go a
    /// rotation. Returns a limit if there have been too many changes.
    fn changes(&mut self) -> Option<Limit> {
        let now = self.at[TIME];
        self.still = if now > self.last_change { 0 } else { self.still + 1 };
        self.short = if now > self.last_change + SHORT_PHASE { 0 } else { self.short + 1 };
        self.last_change = now;
        let (count, hops) = (self.made.path.phases.len() + self.turns, self.made.path.impacts.len());
        match () {
            () if hops > MOST_IMPACTS => Some(Limit::Impacts),
            () if count.saturating_sub(hops) > most_phases(&self.since) => Some(Limit::Changes),
            () if self.still > STILL => Some(Limit::Chatter),
            () if !self.ask.losses.is_none() && self.short > MOST_SHORT_PHASES => Some(Limit::Chatter),
            () => None,
        }
    }

    /// Counts a change within a phase: dry friction stops, holds or lets go a rotation. Returns true if there are too
    /// many changes, and then ends the computation of the motion.
    pub fn turns_too_often(&mut self) -> bool {
        self.turns += 1;
        let limit = self.changes();
        if let Some(limit) = limit {
            self.next = Some(self.gives_up(limit));
        }
        limit.is_some()
    }

    /// Ends a motion whose computation stops at this limit.
    pub fn gives_up(&mut self, limit: Limit) -> Next {
        self.made.motion.limit = Some(limit);
        Next::Ends(Ending::Bounded)
    }

    /// The phase after an ending past which a motion with restitution continues. Several endings may follow each
    /// other at the same time.
    fn goes_on(&mut self, mut next: Next) -> Next {
        for _ in 0..STILL {
            let Next::Ends(ending) = next else { break };
            next = P::goes_on(self, ending);
            if matches!(next, Next::Ends(same) if same == ending) {
                break;
            }
        }
        next
    }

    /// Integrates a phase from the state vector `y`, for at most `most` steps; `first` is the first step if it is
    /// known.
    pub fn flows(
        &mut self,
        y: [f64; N],
        first: Option<f64>,
        most: u64,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        let first = Some(first.unwrap_or_else(|| P::first(self, &y)));
        let looks = self.steps_to_look(&y);
        let most = most.min(looks);
        let steps =
            Steps { first, most, patience: self.spent.patience, toil: self.toil(), tired: self.tired };
        self.tired = false;
        let paused = P::flows(self, y, steps, go_on)?;
        if self.made.motion.limit == Some(Limit::Rounding) && self.at[TIME] == 0.0 {
            return Err(Error::Lost { theta: P::seen(self, self.kind()).state.theta() });
        }
        match paused {
            Pause::Here(y, step) if looks < u64::MAX => {
                // A flow this short does not ask `go_on` itself.
                self.steps_since_call += looks;
                if self.steps_since_call >= BREATH {
                    self.steps_since_call = 0;
                    if !go_on() {
                        self.made.motion.limit = Some(Limit::Interrupted);
                        P::slip_halts(self, y, Halt::Endless);
                        return Ok(Pause::No);
                    }
                }
                Ok(self.continue_by_series(y, step))
            }
            paused => Ok(paused),
        }
    }

    /// The number of evaluations of the rates that remain of the allowed number.
    pub fn toil(&self) -> u64 {
        let most = self.ask.max_evaluations;
        let most = most.unwrap_or_else(|| toil_of(self.since.last().copied().unwrap_or(0.0)));
        most.saturating_sub(self.spent.evaluations)
    }

    /// The phase that begins at the current state, initially or after a landing. An error if no unique contact force
    /// exists.
    pub fn first_phase(&mut self) -> Result<Next, Error> {
        if !self.ask.table.rubs() {
            return Ok(P::begins_without_slip(self));
        }
        if P::rubbing(self) > self.of.over() || !self.of.is_dry() {
            return match P::ends_slip(self) {
                Some(Halt::Jam) => match P::goes_on(self, Ending::Painleve) {
                    Next::Ends(Ending::Painleve) => Err(P::no_unique_force(self)),
                    next => Ok(next),
                },
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
            Next::Ends(Ending::Painleve) => Err(P::no_unique_force(self)),
            next => Ok(next),
        }
    }

    pub fn stop_slip(&mut self) {
        (self.at[P::SLIP], self.at[P::SLIP + 1]) = (0.0, 0.0);
    }

    /// Sets the next phase, and removes a rolling phase of zero length from the list: its contact point began to slip
    /// at once, since rolling needed all of the static friction.
    pub fn continues_with(&mut self, next: Next) {
        if !matches!(next, Next::Ends(_)) {
            let now = self.t0 + self.at[TIME];
            self.made.path.phases.pop_if(|phase| phase.kind == Kind::Rolling && phase.time == now);
            P::perturbs(self);
        }
        self.next = Some(next);
    }

    /// Continues the current phase if the next phase is of the same kind.
    pub fn resumes_phase(&mut self) {
        self.resumes = true;
    }

    /// Records the beginning of a phase, whose first steps may be very short.
    pub fn begins_phase(&mut self, kind: Kind) {
        self.began = self.at[TIME];
        self.allows_crawling();
        let resumes = core::mem::take(&mut self.resumes);
        if resumes && self.made.path.phases.last().is_some_and(|p| p.kind == kind) {
            return;
        }
        let phase = P::seen(self, kind);
        self.memory_result = self.memory_result.and(grow(&mut self.made.path.phases, phase));
    }

    /// Records an impact.
    pub fn records_impact(&mut self, impact: Strike<P::State>) {
        let before = self.made.path.impacts.last();
        self.hops.struck += before.map_or(0.0, |before| before.lost);
        self.memory_result = self.memory_result.and(grow(&mut self.made.path.impacts, impact));
    }

    /// Allows more very short steps after a change of the motion.
    pub fn allows_crawling(&mut self) {
        self.spent.patience = (self.spent.patience + CRAWLING_STEPS_PER_CHANGE).min(self.crawling);
    }

    /// Records an event after which the model does not hold, at the current state, unless an earlier event is
    /// recorded.
    pub fn records_event(&mut self, ending: Ending) {
        let Phase { time, state, rim, .. } = P::seen(self, self.kind());
        let event = Event { ending, time, state, rim };
        self.made.motion.event.get_or_insert(event);
    }

    /// Writes the outputs up to the current time that no integration has written, as for a motion that ends at its
    /// start.
    pub fn writes_up_to_now(&mut self) {
        while self.until().is_some_and(|t| t <= self.at[TIME]) {
            P::write_here(self);
        }
    }

    /// Returns the finished motion and its path.
    pub fn done(mut self) -> Result<Followed<P::State>, Error> {
        self.memory_result?;
        let count = self.made.motion.states.len();
        self.made.motion.times = copied(&self.times[..count])?;
        self.made.motion.evaluations = self.spent.evaluations;
        self.made.path.erred += self.spent.erred * self.of.tol();
        self.made.path.heat = self.at[P::HEAT];
        self.made.path.lost = if P::loses(&self.ask) { self.at[N - 1] } else { 0.0 };
        Ok(self.made)
    }

    /// The next requested time, relative to the initial time.
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

    /// Raises the estimated error of the motion to at least this `error`. A NaN makes it NaN for good.
    pub fn claims(&mut self, error: f64) {
        self.made.motion.error = larger_or_nan(self.made.motion.error, error);
    }

    /// The factor by which the run with the larger tolerance exaggerates an error that both runs make alike, so that
    /// the scaled difference of the runs shows this error; 0 in the other run.
    pub fn shows(&self) -> f64 {
        self.perturbation / f64::EPSILON
    }

    /// Includes the error of the time at which a phase ends, at the state vector `y`, in the estimated error. It is
    /// the error of the steps divided by `steep`, the rate at which the condition of the phase fell to zero.
    pub fn claims_time_error(&mut self, halt: Halt, steep: f64, y: &[f64; N]) {
        // In the midst of bounces the time of an end has no meaning, and its effect is in the difference of the runs.
        if self.ask.restitution.is_some() && y[TIME] - self.began <= BRIEF_PHASE {
            return;
        }
        if let Some(grows) = self.of.grows(halt, y) {
            let erred = grows * (self.spent.erred * self.of.tol() + 8.0 * f64::EPSILON);
            // A margin that only touches zero does so with zero slope: the error of the time is a square root. The
            // length of a hop from a margin of exactly zero is proportional to its speed.
            let hop = if P::leaves_margin(self, halt) { y[TIME] - self.began } else { f64::INFINITY };
            self.claims((erred / steep).min(erred.sqrt()).min(erred * hop));
        }
    }

    /// Adds the evaluations and step errors of an integration to those of the motion.
    pub fn has_spent(&mut self, Spent { evaluations, erred, patience, exhausted }: Spent) {
        self.made.motion.limit = exhausted.map(Limit::from).or(self.made.motion.limit);
        self.spent.evaluations += evaluations;
        self.spent.erred += erred;
        self.spent.patience = patience;
    }

    /// Adds the evaluations and step errors of an integration by the SIMD code, in which `given` very short steps
    /// were allowed.
    pub fn has_spent_elsewhere(&mut self, spent: Spent, given: u64) {
        let crawled = given - spent.patience.min(given);
        self.tired = spent.patience == 0;
        self.has_spent(Spent { patience: self.spent.patience.saturating_sub(crawled), ..spent });
    }
}

/// The phase that follows from the behaviour of a contact point with zero slip: it sticks or slips off.
pub(crate) fn after_rest(found: Standstill) -> Next {
    match found {
        Standstill::Sticks => Next::Rolls { at_limit: false },
        Standstill::Slips { alpha, growth } => Next::SlipsOff { alpha, growth },
        Standstill::LiftsOff => Next::Ends(Ending::LiftOff),
        Standstill::Undefined => Next::Ends(Ending::Painleve),
    }
}

/// The reason for which a motion ends where the integration of its phase halts for this reason.
pub(crate) fn ending(halt: Halt) -> Ending {
    match halt {
        Halt::Time | Halt::Pause | Halt::Standstill | Halt::Pole => Ending::Done,
        Halt::Face | Halt::Topples => Ending::Face,
        Halt::Side => Ending::Side,
        Halt::LiftOff => Ending::LiftOff,
        Halt::Jam => Ending::Painleve,
        Halt::Slips => Ending::Slip,
        Halt::Contour | Halt::Drilling | Halt::Rocking | Halt::Settles | Halt::Rests => Ending::Stops,
        Halt::Rises | Halt::Changes | Halt::OtherStandstill | Halt::Turned => Ending::Side,
        Halt::Endless => Ending::Bounded,
    }
}
