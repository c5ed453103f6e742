//! The motion of a stone, through phases of rolling and of slipping.
//!
//! The phases are those of [`motion::path`](crate::motions::path): a contact point that rests slips where rolling needs
//! more friction than mu_s N, and a slip that comes to an end sticks where rolling needs no more than that. Each phase is a
//! [`StoneFlow`]; a slip from rest begins with the series of `path::leaving`.
//!
//! Error: the motion is computed twice, as on any path; `tests/laws/stone.rs` compares it with references of 25 digits.

use super::check;
use super::flow::{ALL, FEW, HOLD, StoneFlow, Touch, state, told_slip};
use super::known::{Noted, Runs, settle};
use super::write::write;
use crate::error::{Error, copied, room};
use crate::laws::contact::Table;
use crate::laws::contact::slip::Friction;
use crate::laws::contact::standstill::{Onset, Standstill};
use crate::laws::loss::GRACE;
use crate::laws::stone::Ellipsoid;
use crate::laws::stone::StoneState;
use crate::methods::flow::{Flow, Flown, PATIENCE, Spent, Steps, toil_of};
use crate::motions::followed::{Followed, rougher};
use crate::motions::halt::Halt;
use crate::motions::path::{RENEWED, STILL, most_phases};
use crate::motions::{Ask, Ending, Event, Method, Motion, Moving, Start};
use crate::motions::{Kind, Path, Phase};
use crate::numbers::Dual;
use core::cell::RefCell;

/// The share of the longest steps that a rougher run takes.
pub(crate) const ROUGH_STRIDE: f64 = 0.7;

/// An end whose margin falls this far below zero, in numbers of the state, is sure for all errors that are known.
const DEEP: f64 = 1e-2;

/// The motion of a stone from a start at the `times`, which are in order and not before the start.
///
/// The start is a [`StoneState`], or a [`Start`] with a slip and a time; the vertical of
/// a state is scaled to length 1. A slip stands along the horizontal axes x and y of the laboratory in which the stone has
/// the orientation of the smallest turn from upright, at a start as in all outputs. `ask` has the table, the tolerance, `beyond` and the outputs; a stone has no losses, no
/// fixed step and no landing of another rim. `go_on` is called often; if it returns false, the result is `Ok(None)`.
/// Errors: `OutOfRange`, which names the argument; `Painleve` for a start without a unique contact force; `Restless` where
/// slipping and rolling alternate too often, as for any body; `Endless` where the motion hardly advances.
///
/// ```
/// use spincyl::{Ellipsoid, motion::Ask, stone};
///
/// // A rattleback that is spun the wrong way begins to rock, and turns back.
/// let inertia = [[0.02, -0.012, 0.0], [-0.012, 0.2, 0.0], [0.0, 0.0, 0.21]];
/// let stone = Ellipsoid::new([1.0, 0.3, 0.2], inertia, [0.0, 0.0, -0.07])?;
/// let times: Vec<f64> = (0..=60).map(f64::from).collect();
/// let motion = stone::roll(&stone, stone.spinning(-0.6, 0.02, 0.0), &times, &Ask::default(), || true)?.unwrap();
/// assert!(motion.states[0].spin() < -0.5 && motion.states.iter().any(|y| y.spin() > 0.1));
/// # Ok::<(), spincyl::Error>(())
/// ```
pub fn roll(
    stone: &Ellipsoid,
    start: impl Into<Start<StoneState>>,
    times: &[f64],
    ask: &Ask,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<Motion<StoneState>>, Error> {
    rolled(stone, &start.into(), times, ask, &mut go_on)
}

/// Does the work of [`roll`] without generic parameters, so that this code is compiled only once.
fn rolled(
    stone: &Ellipsoid,
    start: &Start<StoneState>,
    times: &[f64],
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion<StoneState>>, Error> {
    let found = followed(stone, start, times, ask, &RefCell::default(), go_on)?;
    Ok(found.map(|found| Motion { path: Some(Box::new(found.path)), ..found.motion }))
}

/// The motion and its path, judged by a rougher one, with what was `noted` of it as far as it is known.
pub(crate) fn followed(
    stone: &Ellipsoid,
    start: &Start<StoneState>,
    times: &[f64],
    ask: &Ask,
    noted: &RefCell<Noted>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Followed<StoneState>>, Error> {
    let (start, fine) = check(start, times, ask)?;
    let mut runs = |times: &[f64], noted: Option<&RefCell<Noted>>| -> Runs {
        let mut run =
            |tol: f64, noted| StoneWalk::new((stone, &start), times, ask, (tol, fine), noted)?.run(go_on);
        let Some(found) = run(fine, noted)? else { return Ok(None) };
        Ok(run(rougher(fine), None)?.map(|rough| [found, rough]))
    };
    let Some([mut found, rough]) = runs(times, Some(noted))? else { return Ok(None) };
    found.judge(&rough, fine);
    let span = (start.time, times[times.len() - 1], fine);
    let settled = settle(&mut found, &mut noted.borrow_mut(), span, &mut |times| runs(times, None))?;
    Ok(settled.then_some(found))
}

/// The next phase of a stone.
pub(crate) enum NextPhase {
    Slips,
    SlipsOff { alpha: f64, growth: f64 },
    Rolls { grace: bool },
    Ends(Ending),
}

/// The computation of a motion, phase by phase.
pub(crate) struct StoneWalk<'a> {
    pub(crate) ask: &'a Ask,
    times: &'a [f64],
    pub(super) flow: StoneFlow<'a>,
    pub(crate) friction: Friction,
    t0: f64,
    /// The requested times, counted from the start.
    pub(crate) since: Vec<f64>,
    pub(crate) made: Followed<StoneState>,
    /// The numbers of a flow where the present phase begins or has ended.
    pub(crate) at: [f64; ALL],
    /// The centre of mass at the start, which stays there on a smooth table.
    pub(crate) still_centre: [f64; 2],
    pub(crate) next: Option<NextPhase>,
    began: f64,
    still: u32,
    /// The share by which a rougher run moves the state at each end of a phase.
    shake: f64,
    pub(crate) spent: Spent,
}

impl<'a> StoneWalk<'a> {
    fn new(
        (stone, start): (&Ellipsoid, &Start<StoneState>),
        times: &'a [f64],
        ask: &'a Ask,
        (tol, fine): (f64, f64),
        noted: Option<&'a RefCell<Noted>>,
    ) -> Result<Self, Error> {
        let &Start { state: y, slip, time: t0 } = start;
        let friction = ask.table.friction();
        let dry = matches!(friction, Friction::Coulomb { mu, .. } if mu > 0.0 || friction.sticks());
        let law = stone.law(friction.strength(), dry && ask.table.rubs());
        let edge = if stone.theta_end < core::f64::consts::PI { stone.theta_end.cos() } else { -2.0 };
        let flow = StoneFlow {
            sloped: law.map(|x| Dual { value: x, slope: 0.0 }),
            law,
            touch: Touch::Rolls,
            mu: ask.table.mu(),
            edge,
            tol,
            stride: if tol > fine { ROUGH_STRIDE } else { 1.0 },
            watch: true,
            way: [0.0; 2],
            noted,
        };
        let mut at = [0.0; ALL];
        at[..4].copy_from_slice(&y.orientation());
        at[4..7].copy_from_slice(&y.w);
        at[8..10].copy_from_slice(&slip);
        let mut since = copied(times)?;
        // The sum turns -0 into 0.
        since.iter_mut().for_each(|t| *t = *t - t0 + 0.0);
        let mut motion = Motion::empty(times.len(), ask.pose)?;
        if ask.force {
            (motion.forces, motion.force_error) = (Some(room(times.len())?), 0.0);
        }
        motion.method = Method::Tolerance(tol);
        let mut walk = Self {
            ask,
            times,
            flow,
            friction,
            t0,
            since,
            made: Followed { motion, path: Path::empty(times.len(), 0)? },
            at,
            still_centre: [0.0; 2],
            next: None,
            began: f64::NEG_INFINITY,
            still: 0,
            shake: if tol > fine { f64::EPSILON * tol / (fine * StoneState::SAFETY) } else { 0.0 },
            spent: Spent { evaluations: 0, erred: 0.0, patience: PATIENCE },
        };
        let pose = flow.pose(&at, [0.0; 2]);
        walk.still_centre = [pose.centre[0], pose.centre[1]];
        walk.next = Some(walk.begins()?);
        walk.shakes();
        Ok(walk)
    }

    /// The touch of a contact point that does not slip under a law of friction.
    fn resting(&self) -> Touch {
        if self.ask.table == Table::Smooth { Touch::Smooth } else { Touch::Rolls }
    }

    /// The phase that begins at the start.
    fn begins(&mut self) -> Result<NextPhase, Error> {
        let rubs = self.ask.table.rubs();
        let slips = rubs && (self.at[8].hypot(self.at[9]) > self.flow.over() || !self.flow.law.dry);
        self.flow.touch = if slips { Touch::Slips } else { self.resting() };
        let [edge, lift, hold] = self.flow.margins_at(&self.at);
        if edge < 0.0 || edge == 0.0 && !self.rises() {
            return Ok(NextPhase::Ends(Ending::Face));
        }
        if slips {
            return Ok(match (hold <= 0.0, lift <= 0.0) {
                (true, _) => return Err(self.jam()),
                (_, true) => NextPhase::Ends(Ending::LiftOff),
                _ => NextPhase::Slips,
            });
        }
        if rubs {
            return match self.after_rest(self.rest().decides()) {
                NextPhase::Ends(Ending::Painleve) => Err(self.jam()),
                next => Ok(next),
            };
        }
        let ending = if lift <= 0.0 {
            Ending::LiftOff
        } else if hold < 0.0 {
            Ending::Slip
        } else {
            return Ok(NextPhase::Rolls { grace: false });
        };
        if !self.ask.beyond {
            return Ok(NextPhase::Ends(ending));
        }
        self.meets(ending);
        self.flow.watch = false;
        Ok(NextPhase::Rolls { grace: false })
    }

    /// Whether an edge that touches the table at the start leaves it.
    fn rises(&self) -> bool {
        let y: [f64; FEW] = core::array::from_fn(|i| self.at[i]);
        let here = self.flow.margins(&self.flow.place(y))[0].slope;
        let later = self.flow.part(&self.flow.place(y), 1e-6);
        here > 0.0 || here == 0.0 && self.flow.margin(&later, 0) > 0.0
    }

    fn jam(&self) -> Error {
        let (mu, theta) = (self.flow.law.strength, state(&self.at).theta());
        let Onset { eps, .. } = self.rest().onset;
        Error::Painleve { mu, theta, limit: mu / eps[0].hypot(eps[1]) }
    }

    fn run(mut self, go_on: &mut dyn FnMut() -> bool) -> Result<Option<Followed<StoneState>>, Error> {
        while let Some(next) = self.next.take() {
            self.still = if self.at[7] > self.began { 0 } else { self.still + 1 };
            let count = self.made.path.phases.len();
            if !matches!(next, NextPhase::Ends(_)) && (self.still > STILL || count > most_phases(&self.since))
            {
                return Err(Error::Restless { count, time: self.t0 + self.at[7] });
            }
            let (y, first) = match next {
                NextPhase::Ends(ending) => {
                    self.meets(ending);
                    self.made.path.last_slip = told_slip(&self.at);
                    self.stays_there();
                    break;
                }
                NextPhase::Rolls { grace } => {
                    self.flow.touch = self.resting();
                    self.flow.mu = self.ask.table.mu() * if grace { 1.0 + GRACE } else { 1.0 };
                    let kind = if self.flow.touch == Touch::Smooth { Kind::Slipping } else { Kind::Rolling };
                    self.opens(kind);
                    if self.ask.stop_at_rolling {
                        self.made.path.rolls_on = true;
                        break;
                    }
                    (self.at, None)
                }
                NextPhase::Slips => {
                    self.flow.touch = Touch::Slips;
                    self.opens(Kind::Slipping);
                    (self.at, None)
                }
                NextPhase::SlipsOff { alpha, growth } => {
                    let Some(y) = self.slips_off((alpha, growth)) else { continue };
                    (y, Some(1e-3 * growth.max(1e-3)))
                }
            };
            if !self.follows(y, first, go_on)? {
                return Ok(None);
            }
        }
        self.done().map(Some)
    }

    /// Follows the flow of a phase. Returns whether it has not been interrupted.
    fn follows(
        &mut self,
        y: [f64; ALL],
        first: Option<f64>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<bool, Error> {
        let toil = toil_of(self.since.last().copied().unwrap_or(0.0)).saturating_sub(self.spent.evaluations);
        let steps = Steps { first, most: u64::MAX, patience: self.spent.patience, toil, tired: false };
        let (flow, ask, still) = (self.flow, self.ask, self.still_centre);
        let from = self.made.motion.states.len();
        let (made, times) = (&mut self.made, &self.since[from..]);
        let whole = |y: &[f64; FEW]| core::array::from_fn(|i| if i < FEW { y[i] } else { 0.0 });
        // A stone that rolls without a pose has fewer numbers.
        let flown = if flow.touch == Touch::Slips || ask.pose || ask.table.rubs() {
            let mut write = |y: &[f64; ALL]| write(made, (&flow, ask, still), y);
            flow.run(flow.place(y), steps, times, &mut write, go_on)
        } else {
            let mut write = |y: &[f64; FEW]| write(made, (&flow, ask, still), &whole(y));
            let here = flow.place(core::array::from_fn(|i| y[i]));
            flow.run(here, steps, times, &mut write, go_on).map(|flown| {
                flown.map(|Flown { halt, y, step, steep, spent }| Flown {
                    halt,
                    y: whole(&y),
                    step,
                    steep,
                    spent,
                })
            })
        };
        let flown = match flown {
            Err(Error::Endless { theta, time }) => {
                return Err(Error::Endless { theta, time: self.t0 + time });
            }
            flown => flown?,
        };
        let Some(flown) = flown else { return Ok(false) };
        self.halted(&flown);
        Ok(true)
    }

    /// Chooses the next phase after a flow.
    pub(crate) fn halted(&mut self, flown: &Flown<Halt, ALL>) {
        let &Flown { halt, y, steep, spent: Spent { evaluations, erred, patience }, .. } = flown;
        if self.flow.touch == Touch::Slips {
            self.made.path.slipping += y[7] - self.began;
        }
        self.at = y;
        self.spent.evaluations += evaluations;
        self.spent.erred += erred;
        self.spent.patience = patience;
        if matches!(halt, Halt::Face | Halt::LiftOff | Halt::Slips | Halt::Jam) {
            let grows = self.flow.fastest(&y);
            let erred = grows * (self.spent.erred * self.flow.tol + 8.0 * f64::EPSILON);
            // A margin that only touches zero bends away from zero.
            self.made.motion.error = self.made.motion.error.max((erred / steep).min(erred.sqrt()));
        }
        let rubs = self.ask.table.rubs();
        match halt {
            Halt::Face => self.ends_by(0),
            Halt::LiftOff => self.ends_by(1),
            Halt::Slips if !rubs => self.ends_by(HOLD),
            _ => (),
        }
        let next = match halt {
            Halt::Time | Halt::Pause => return,
            Halt::Standstill => {
                (self.at[8], self.at[9]) = (0.0, 0.0);
                self.after_rest(self.rest().decides())
            }
            Halt::Slips if rubs => self.after_rest(self.rest().lets_go()),
            Halt::Face => NextPhase::Ends(Ending::Face),
            halt => {
                let ending = match halt {
                    Halt::LiftOff => Ending::LiftOff,
                    Halt::Slips => Ending::Slip,
                    _ => Ending::Painleve,
                };
                if self.ask.beyond && !rubs {
                    self.meets(ending);
                    self.flow.watch = false;
                    self.made.path.phases.pop();
                    NextPhase::Rolls { grace: false }
                } else {
                    NextPhase::Ends(ending)
                }
            }
        };
        if !matches!(next, NextPhase::Ends(_)) {
            let now = self.t0 + self.at[7];
            self.made.path.phases.pop_if(|phase| phase.kind == Kind::Rolling && phase.time == now);
            self.shakes();
        }
        self.next = Some(next);
    }

    /// Notes how far margin `i` falls below zero after it has ended a flow: one that only touches zero may miss it.
    fn ends_by(&self, i: usize) {
        let Some(noted) = self.flow.noted else { return };
        let (leans, calm) = (self.flow.leans(&self.at, i), self.flow.calm(&self.at));
        let place = self.flow.place(self.at);
        let mut room = 0f64;
        for tenths in 3..18 {
            let later = self.flow.part(&place, calm * 0.1f64.powf(0.5 * f64::from(tenths)));
            room = room.max(-self.flow.margin(&later, i) / leans);
            if room > DEEP {
                break;
            }
        }
        noted.borrow_mut().grazes.push([self.at[7], room]);
    }

    fn after_rest(&self, found: Standstill) -> NextPhase {
        match found {
            Standstill::Sticks => NextPhase::Rolls { grace: false },
            Standstill::Slips { alpha, growth } => NextPhase::SlipsOff { alpha, growth },
            Standstill::LiftsOff => NextPhase::Ends(Ending::LiftOff),
            Standstill::Undefined => NextPhase::Ends(Ending::Painleve),
        }
    }

    /// Moves the state of a rougher run at the end of a phase by more than rounding does.
    fn shakes(&mut self) {
        if self.shake > 0.0 {
            let (up, down) = (1.0 + self.shake, 1.0 - self.shake);
            for (x, by) in self.at.iter_mut().zip([up, down, down, up, up, down, up]) {
                *x *= by;
            }
            self.at = self.flow.kept(self.at);
        }
    }

    /// Records an event that the model does not cover.
    fn meets(&mut self, ending: Ending) {
        let event = Event { ending, time: self.t0 + self.at[7], state: state(&self.at) };
        self.made.motion.event.get_or_insert(event);
    }

    /// Writes the outputs up to an end at which no flow has written them, as at the start.
    fn stays_there(&mut self) {
        while self.since.get(self.made.motion.states.len()).is_some_and(|t| *t <= self.at[7]) {
            write(&mut self.made, (&self.flow, self.ask, self.still_centre), &self.at);
        }
    }

    pub(crate) fn opens(&mut self, kind: Kind) {
        self.began = self.at[7];
        self.spent.patience = (self.spent.patience + RENEWED).min(PATIENCE);
        let (time, slip) = (self.t0 + self.at[7], told_slip(&self.at));
        self.made.path.phases.push(Phase { time, kind, state: state(&self.at), slip });
    }

    fn done(mut self) -> Result<Followed<StoneState>, Error> {
        let count = self.made.motion.states.len();
        self.made.motion.times = copied(&self.times[..count])?;
        self.made.motion.evaluations = self.spent.evaluations;
        self.made.path.erred = self.spent.erred * self.flow.tol;
        self.made.path.heat = self.at[10];
        Ok(self.made)
    }
}
