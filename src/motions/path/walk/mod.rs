//! The phases of a path, one after the other: the beginning of each phase, and the choice of the next one.

mod flows;
mod lands;
mod loses;
mod rolls;
mod slips;
mod tail;
mod write;

use super::check;
use super::slide::Slide;
use crate::error::{Error, copied, room};
use crate::laws::body::Body;
use crate::laws::contact::slip::{Friction, painleve};
use crate::laws::contact::standstill::{Standstill, standstill, towards};
use crate::laws::contact::{Contact, force, lossy};
use crate::laws::state::State;
use crate::methods::flow::{PATIENCE, Spent};
use crate::motions::followed::Followed;
use crate::motions::halt::{Halt, loses, poses};
use crate::motions::judge::doubted;
use crate::motions::{Ask, Ending, Event, Method, Motion, Moving, Start};
use crate::motions::{Kind, Path, Phase};
use core::f64::consts::PI;
use loses::LossyPhase;
use tail::LastTurns;
use write::state;

/// Largest number of phases, of a short motion and of a long one, and for each unit of time between; some motions slip for
/// a moment in each nutation for ever.
const MOST: [usize; 2] = [5_000, 10_000];
const MOST_PER_TIME: f64 = 20.0;
/// Sine of theta below which a falling face has landed if slipping and sticking alternate within no time.
const ALL_BUT_FLAT: f64 = 1e-6;
/// Largest number of phases that follow each other within no time.
pub(crate) const STILL: u32 = 6;
/// Length of a short phase of a body that loses energy, and largest number of them in turn (two dry laws alternate).
const SHORT: f64 = 1e-9;
const CHATTER: u32 = 200;
/// Number of crawling steps that each change of the motion adds to the patience.
pub(crate) const RENEWED: u64 = 1000;
/// The least inclination of a motion by first integrals.
const LEAST: f64 = 1e-8;

/// The computation of a path, phase by phase.
pub(crate) struct Walk<'a, const N: usize> {
    body: Body,
    ask: Ask,
    pub slide: Slide,
    t0: f64,
    /// The requested times, counted from the start.
    since: Vec<f64>,
    times: &'a [f64],
    made: Followed,
    /// The numbers of `path::slide`, the state, and the next phase, where the present phase begins or has ended.
    at: [f64; N],
    state: State,
    start: State,
    next: Option<Next>,
    /// The present phase, if it loses energy without a slip.
    lossy: Option<LossyPhase>,
    began: f64,
    /// Number of phases that have begun at the same time as the previous phase.
    still: u32,
    /// Number of phases that have begun hardly later than the previous phase.
    short: u32,
    /// Whether the body only tilts, so that rounding must not make the body turn.
    planar: bool,
    /// The share by which a rougher run moves the state at each end of a phase.
    shake: f64,
    pub spent: Spent,
    /// Whether the last steps have crawled.
    tired: bool,
    /// The end of a whirr that slips, where one comes down by infinitely many turns.
    tail: Option<LastTurns>,
}

/// Largest number of phases, and of changes of the ways that dry losses resist, up to the last of the times.
pub(crate) fn most_phases(times: &[f64]) -> usize {
    let [least, most] = MOST;
    times.last().map_or(least, |t| ((MOST_PER_TIME * t) as usize).clamp(least, most))
}

/// The next phase of a walk.
enum Next {
    Slips([f64; 2]),
    /// The slip goes on after a dry loss has changed its direction, or after the contact has settled.
    SlipsOn,
    SlipsOff {
        alpha: f64,
        growth: f64,
    },
    Rolls {
        grace: bool,
    },
    Ends(Ending),
}

/// The next task of the caller of a path, or the end of the path.
pub(crate) enum WalkStep<const N: usize> {
    /// The caller follows the flow from these numbers.
    Flows([f64; N]),
    /// The path is complete.
    Done,
    /// The caller has interrupted the path.
    Interrupted,
}

/// Whether a flow has been left before its end.
#[derive(PartialEq)]
pub(crate) enum Pause<const N: usize> {
    No,
    /// The flow was left at these numbers, with this next step if the step is known.
    Here([f64; N], Option<f64>),
    /// The caller has interrupted the flow.
    Interrupted,
}

impl<'a, const N: usize> Walk<'a, N> {
    /// A walk at the start, with steps of the tolerance `tol`, which is the requested one or a larger one.
    pub fn new(body: &Body, ask: &Ask, tol: f64, times: &'a [f64], start: &Start) -> Result<Self, Error> {
        let fine = check(body, start, ask)?;
        let &Start { state: start, slip, time: t0 } = start;
        let mut since = copied(times)?;
        // The sum turns -0 into 0.
        since.iter_mut().for_each(|t| *t = *t - t0 + 0.0);
        let count = times.len();
        let mut motion = Motion::empty(count, ask.pose)?;
        if ask.force {
            (motion.forces, motion.force_error) = (Some(room(count)?), 0.0);
        }
        motion.method = Method::Tolerance(tol);
        let path = Path::empty(count, if loses(N) { count } else { 0 })?;
        let slide = Slide::new(body, &ask.table.friction(), &ask.losses, tol);
        let (s, c) = start.theta.sin_cos();
        let mut at = [0.0; N];
        at[..7].copy_from_slice(&[s, c, start.w1, start.w2, start.w3, slip[0], slip[1]]);
        let mut walk = Self {
            body: *body,
            ask: *ask,
            slide,
            t0,
            since,
            times,
            made: Followed { motion, path },
            at,
            state: start,
            start,
            next: None,
            lossy: None,
            began: f64::NEG_INFINITY,
            still: 0,
            short: 0,
            // The scaling of the claimed error reduces this share to a few roundings.
            shake: if tol > fine { f64::EPSILON * tol / (fine * State::SAFETY) } else { 0.0 },
            planar: start.w1 == 0.0 && start.w3 == 0.0 && slip[1] == 0.0,
            spent: Spent { evaluations: 0, erred: 0.0, patience: PATIENCE },
            tired: false,
            tail: (!body.is_ball() && ask.losses.turn_endlessly()).then(LastTurns::default),
        };
        walk.next = Some(walk.begins(&start, slip)?);
        if start.theta < body.theta_end() {
            walk.shake();
        }
        Ok(walk)
    }

    pub fn run(mut self, go_on: &mut dyn FnMut() -> bool) -> Result<Option<Followed>, Error> {
        let mut step = None;
        loop {
            match self.advance(go_on)? {
                WalkStep::Flows(mut y) => loop {
                    match self.flows(y, step.take(), u64::MAX, go_on)? {
                        Pause::Here(there, next) => (y, step) = (there, next),
                        Pause::No => break,
                        Pause::Interrupted => return Ok(None),
                    }
                },
                WalkStep::Done => return Ok(Some(self.done()?)),
                WalkStep::Interrupted => return Ok(None),
            }
        }
    }

    /// Goes through the phases up to one that slips or loses energy, or to the end.
    pub fn advance(&mut self, go_on: &mut dyn FnMut() -> bool) -> Result<WalkStep<N>, Error> {
        while let Some(next) = self.next.take() {
            self.still = if self.at[7] > self.began { 0 } else { self.still + 1 };
            self.short = if self.at[7] > self.began + SHORT { 0 } else { self.short + 1 };
            let count = self.made.path.phases.len();
            let fall = self.at[1] * self.at[3];
            if loses(N) && self.still > STILL && self.at[0] < ALL_BUT_FLAT && fall > 0.0 {
                // Slipping and sticking no longer matter, since the face is on the table.
                let left = self.at[0] / fall;
                self.lies_flat([self.at[7] + left, left]);
                return Ok(WalkStep::Done);
            }
            if matches!(next, Next::Slips(_) | Next::SlipsOff { .. })
                && let Some(end) = self.whirr_ends(&{ self.at })
            {
                self.made.path.leaves_turns = true;
                self.lies_flat(end);
                return Ok(WalkStep::Done);
            }
            let chatters = self.still > STILL || loses(N) && self.short > CHATTER;
            let gives_up = count > most_phases(&self.since) || chatters;
            let next = match next {
                Next::Ends(_) => next,
                _ if gives_up => Next::Ends(Ending::Bounded),
                _ => next,
            };
            match next {
                Next::Ends(ending) => {
                    self.meets(ending);
                    self.made.path.last_slip = self.slip();
                    self.stays_there();
                }
                Next::Rolls { grace } => {
                    if let Some(turn) = self.rolls(grace, go_on)? {
                        return Ok(turn);
                    }
                }
                Next::Slips(slip) => {
                    self.opens(Kind::Slipping, slip);
                    self.slide.face(&self.state, slip, [0.0; 2]);
                    return Ok(WalkStep::Flows(self.at));
                }
                Next::SlipsOn => {
                    self.began = self.at[7];
                    return Ok(WalkStep::Flows(self.slide.enter(&self.at)));
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

    /// Moves the state of a rougher run at the end of a phase by more than rounding does. Where the motion is unstable,
    /// the difference of the two runs then shows the instability.
    fn shake(&mut self) {
        if self.shake == 0.0 {
            return;
        }
        let (down, up) = (1.0 - self.shake, 1.0 + self.shake);
        let State { theta, w1, w2, w3 } = self.state;
        // What is at rest stays at rest: the drilling w_z, the rolling w_h and the rocking w2 change by shares of themselves.
        let (s, c) = theta.sin_cos();
        let (drilling, rolling) = ((s * w1 + c * w3) * up, (c * w1 - s * w3) * up);
        let theta = theta * down;
        let (s, c) = theta.sin_cos();
        let (w1, w3) = (s * drilling + c * rolling, c * drilling - s * rolling);
        let state = State { theta, w1, w2: w2 * down, w3 };
        self.state = state;
        self.at[..5].copy_from_slice(&[s, c, state.w1, state.w2, state.w3]);
    }

    /// Takes away the drilling that the error of the steps has made, since dry friction has held the drilling at rest.
    fn stills(&mut self) {
        let (s, c) = state(&self.at).theta.sin_cos();
        let drilling = s * self.at[2] + c * self.at[4];
        (self.at[2], self.at[4]) = (self.at[2] - s * drilling, self.at[4] - c * drilling);
        self.made.motion.error = self.made.motion.error.max(drilling.abs());
        self.state = state(&self.at);
    }

    /// The time at which a whirr that slips ends, and its error, if they are known and no time is asked for before.
    fn whirr_ends(&mut self, at: &[f64; N]) -> Option<[f64; 2]> {
        let until = self.until().unwrap_or(f64::INFINITY);
        let tail = self.tail.as_mut()?;
        tail.notes(at[7], at[0], at[2]);
        tail.known(at[0], until)
    }

    /// Ends the walk where the face lands, at a time with an error.
    fn lies_flat(&mut self, [time, doubt]: [f64; 2]) {
        (self.at[0], self.at[7]) = (0.0, time);
        self.state = state(&self.at);
        self.made.motion.error = self.made.motion.error.max(doubt);
        self.meets(Ending::Face);
    }

    /// Records an event that the model does not cover, at the present point of the walk.
    fn meets(&mut self, ending: Ending) {
        let event = Event { ending, time: self.t0 + self.at[7], state: self.state };
        self.made.motion.event.get_or_insert(event);
    }

    /// Writes the outputs up to an end at which no flow has written them, as at the start.
    fn stays_there(&mut self) {
        while self.since.get(self.made.motion.states.len()).is_some_and(|t| *t <= self.at[7]) {
            let (body, y, slip, at) = (&self.body, &self.state, self.slip(), &self.at);
            let (rubs, losses) = (self.ask.table.rubs(), &self.ask.losses);
            let slips = rubs && (slip != [0.0; 2] || !self.slide.law.dry);
            let kind = if slips { Kind::Slipping } else { self.kind() };
            let press = |y: &State| match slips {
                true => self.slide.law.force(y, slip),
                false if losses.is_none() => force(self.contact(), body, y),
                false => lossy::force(self.contact(), body, y, losses),
            };
            let force = self.ask.force.then(|| doubted(y, [0.0; 2], press));
            let pose = poses(N).then(|| write::pose(at));
            self.made.put(*y, slip, at[8], kind, pose, force);
            if loses(N) {
                self.made.path.work_lost.push(at[N - 1]);
            }
        }
    }

    /// The finished motion and its path.
    pub fn done(mut self) -> Result<Followed, Error> {
        let count = self.made.motion.states.len();
        self.made.motion.times = copied(&self.times[..count])?;
        self.made.motion.evaluations = self.spent.evaluations;
        self.made.path.erred = self.spent.erred * self.slide.tol;
        self.made.path.heat = self.at[8];
        self.made.path.lost = if loses(N) { self.at[N - 1] } else { 0.0 };
        Ok(self.made)
    }

    /// The slip where a phase ended, along the lean and across it.
    fn slip(&self) -> [f64; 2] {
        [self.at[5], self.at[6]]
    }

    /// Moves the walk to the numbers at which a flow has halted. The axis of a ball may have passed the vertical, where s
    /// is negative: then the ball leans to the other side, so that its lean, w1, w2 and the slip change their signs.
    fn arrives(&mut self, at: [f64; N]) {
        self.at = at;
        if self.at[0] < 0.0 {
            [0, 2, 3, 5, 6].into_iter().for_each(|i| self.at[i] = -self.at[i]);
            if poses(N) {
                (self.at[9], self.at[10]) = (self.at[9] + PI, self.at[10] - PI);
            }
            self.slide.leans_over();
        }
        self.state = state(&self.at);
    }

    fn friction(&self) -> Friction {
        self.ask.table.friction()
    }

    pub fn contact(&self) -> Contact {
        self.ask.table.contact()
    }

    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The phase that begins with a state and a slip.
    fn begins(&self, start: &State, slip: [f64; 2]) -> Result<Next, Error> {
        if !self.ask.table.rubs() {
            return Ok(Next::Rolls { grace: false });
        }
        let speed = slip[0].hypot(slip[1]);
        if speed > self.slide.over() || !self.slide.law.dry {
            return Ok(match self.slide.at_start(start, slip) {
                Some(Halt::Jam) => return Err(self.jam(start)),
                Some(halt) => Next::Ends(ending(halt)),
                None => Next::Slips(slip),
            });
        }
        let found = standstill(&self.body, start, &self.friction(), &self.ask.losses);
        let side = self.body.theta_end() - start.theta;
        if self.body.theta_end() < PI && (side < 0.0 || (side == 0.0 && !self.rises(start, found))) {
            return Ok(Next::Ends(Ending::Side));
        }
        match self.after_rest(found) {
            Next::Ends(Ending::Painleve) => Err(self.jam(start)),
            next => Ok(next),
        }
    }

    /// Whether a body at theta_end, whose contact point rests, rises under the contact force.
    fn rises(&self, y: &State, found: Standstill) -> bool {
        let rate = match found {
            Standstill::Slips { alpha, .. } => {
                let w = [y.w1, y.w2, y.w3];
                self.slide.law.towards(y.theta.sin_cos(), w, [0.0; 2], towards(alpha)).w[1]
            }
            _ if self.ask.losses.is_none() => Contact::Rolling.derivative(&self.body, y).w2,
            _ => lossy::derivative(Contact::Rolling, &self.body, y, &self.ask.losses).0.w2,
        };
        y.w2 > 0.0 || (y.w2 == 0.0 && rate > 0.0)
    }

    fn jam(&self, y: &State) -> Error {
        let mu = self.friction().strength();
        Error::Painleve { mu, theta: y.theta, limit: painleve(&self.body, y.theta) }
    }

    fn after_rest(&self, found: Standstill) -> Next {
        match found {
            Standstill::Sticks => Next::Rolls { grace: false },
            Standstill::Slips { alpha, growth } => Next::SlipsOff { alpha, growth },
            Standstill::LiftsOff => Next::Ends(Ending::LiftOff),
            Standstill::Undefined => Next::Ends(Ending::Painleve),
        }
    }

    /// Renews the patience: every change of the motion may need a few crawling steps.
    pub(super) fn renews(&mut self) {
        self.spent.patience = (self.spent.patience + RENEWED).min(PATIENCE);
    }

    fn opens(&mut self, kind: Kind, slip: [f64; 2]) {
        let time = self.t0 + self.at[7];
        self.began = self.at[7];
        self.renews();
        self.made.path.phases.push(Phase { time, kind, state: self.state, slip });
    }
}

/// The ending that a halt means for the motion.
fn ending(halt: Halt) -> Ending {
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
