//! A motion that is marched to its end, or to a time: where it is on its way, and what its next panel is.
//!
//! ```text
//! start -> first turning point (t1) -> back at the start (2 t1) -> second turning point (2 t1 + t2) -> period 2 (t1 + t2)
//! ```
//! Whatever depends on the inclination alone is met at the same places on the way there and on the way back. So the way back
//! need not be looked at: a motion that has met nothing before its first turning point goes on from its start in the other
//! direction, at the time 2 t1; one that has met nothing before its second turning point never ends.

use crate::contact::FLAT;
use crate::exact::lanes::march::{Comes, Knot};
use crate::state::State;
use core::f64::consts::PI;

/// Panels that a motion may take one way.
const MOST: u32 = 48;

/// A motion to be marched: by which body, from where, and in which direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct MarchTask {
    /// Its number in the block.
    pub index: usize,
    /// ell, I1, I3, fillet.
    pub shape: [f64; 4],
    /// Sine and cosine of the inclination at which something else than the rim lands.
    pub side: [f64; 2],
    /// That inclination.
    pub theta_end: f64,
    pub start: Knot<f64>,
    /// 1 if the inclination grows, -1 if it falls.
    pub way: f64,
    /// Square of the coefficient of friction.
    pub mu_square: f64,
}

/// A time that is sought of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    /// The number of the time.
    pub slot: usize,
    /// How long after the start of the march it is, and whether the motion comes back there.
    pub time: f64,
    pub back: bool,
    /// How often what is not known of half a swing is in it.
    pub share: f64,
}

/// A motion on its march.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    pub task: MarchTask,
    pub knot: Knot<f64>,
    pub way: f64,
    pub target: Target,
    /// Since the start, in this direction.
    pub time: f64,
    /// What is not known of that, and of the way to the first turning point.
    late: f64,
    /// The time to the first turning point, once it has been there.
    turned: Option<f64>,
    panels: u32,
    /// Inclinations of the first and of the second turning point, and the precession on the way.
    turns: [f64; 2],
    turn: f64,
}

/// What a panel says of the motion in its lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct PanelOutcome {
    pub comes: Comes,
    pub time: f64,
    pub late: f64,
    pub off: f64,
    pub rate: f64,
    pub tilt: f64,
    pub turn: f64,
    pub knot: Knot<f64>,
}

/// What becomes of it.
#[derive(Debug, Clone, Copy)]
pub(super) enum RunOutcome {
    /// It goes on.
    On,
    /// It ended, or is where it was sought.
    There(EventState),
    /// It does not end before the times that are asked for.
    Free(FreeMotion),
    /// This march does not say.
    Unknown,
}

/// Where a motion is: what it met, when, in which state, and the error of that.
#[derive(Debug, Clone, Copy)]
pub(super) struct EventState {
    pub comes: Comes,
    pub time: f64,
    pub state: State,
    pub error: f64,
    /// How it came there.
    pub before: FreeMotion,
}

/// A motion that goes on: how long it takes to its turning points, as far as they are known, and what is not known of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct FreeMotion {
    pub first: Option<f64>,
    pub second: Option<f64>,
    /// What is not known of the time.
    pub late: f64,
    /// Inclinations of the first and of the second turning point, NaN if it has not been there.
    pub turns: [f64; 2],
    /// The precession on the way, from the one to the other.
    pub turn: f64,
}

impl EventState {
    /// A motion that is over at its start.
    pub fn at_once(comes: Comes, state: State) -> Self {
        let before = FreeMotion { first: None, second: None, late: 0.0, turns: [f64::NAN; 2], turn: 0.0 };
        Self { comes, time: 0.0, state, error: 0.0, before }
    }
}

impl FreeMotion {
    /// Time of a whole nutation; infinite where it has none.
    pub fn period(&self) -> f64 {
        self.first.zip(self.second).map_or(f64::INFINITY, |(first, second)| 2.0 * (first + second))
    }

    /// What is not known of a time that is so long.
    pub fn doubt(&self, time: f64) -> f64 {
        self.late * self.share(time)
    }

    /// How often what is not known of half a swing is in a time.
    fn share(&self, time: f64) -> f64 {
        2.0 + 2.0 * time / self.period()
    }

    /// Least and greatest inclination up to a time, at which it is `last`.
    pub fn inclinations(&self, start: f64, last: f64, time: f64) -> [f64; 2] {
        let first = self.first.unwrap_or(f64::INFINITY);
        let second = self.second.map_or(f64::INFINITY, |second| 2.0 * first + second);
        let passed = [(first, self.turns[0]), (second, self.turns[1])];
        let all = passed.into_iter().filter(|(at, _)| *at <= time).map(|(_, theta)| theta);
        all.chain([last]).fold([start; 2], |[low, high], theta| [low.min(theta), high.max(theta)])
    }
}

impl Run {
    pub fn new(task: &MarchTask) -> Self {
        let target = Target { slot: 0, time: f64::INFINITY, back: false, share: 1.0 };
        Self {
            task: *task,
            knot: task.start,
            way: task.way,
            target,
            time: 0.0,
            late: 0.0,
            turned: None,
            panels: 0,
            turns: [f64::NAN; 2],
            turn: 0.0,
        }
    }

    /// The march to where a free motion is at `time`.
    pub fn to(task: &MarchTask, free: &FreeMotion, slot: usize, time: f64) -> Self {
        let mut run = Self::new(task);
        let (mut left, mut back) = (time, false);
        let period = free.period();
        if let Some(first) = free.first {
            if period.is_finite() {
                left -= (time / period).floor() * period;
            }
            if left > 2.0 * first {
                (left, run.way) = (left - 2.0 * first, -run.way);
                if let Some(second) = free.second.filter(|second| left > *second) {
                    (left, back) = (2.0 * second - left, true);
                }
            } else if left > first {
                (left, back) = (2.0 * first - left, true);
            }
        }
        run.late = free.late;
        run.target = Target { slot, time: left.max(0.0), back, share: free.share(time) };
        run
    }

    /// Goes on to the next panel; tells whether there have been too many.
    pub fn passes(&mut self, knot: Knot<f64>) -> bool {
        self.panels += 1;
        self.knot = knot;
        self.panels > MOST
    }

    /// Goes on after a panel, up to `span`; to the target if there is none.
    pub fn advance(&mut self, met: &PanelOutcome, span: Option<f64>) -> RunOutcome {
        self.panels += 1;
        if self.panels > MOST || met.comes == Comes::Unknown {
            return RunOutcome::Unknown;
        }
        self.late += met.late;
        self.turn += met.turn;
        let time = self.time + met.time;
        let Some(span) = span else { return self.seeks(met, time) };
        let gone = self.turned.map_or(0.0, |first| 2.0 * first);
        match met.comes {
            Comes::Edge => {
                (self.time, self.knot) = (time, met.knot);
                if gone + time > span { self.free(None) } else { RunOutcome::On }
            }
            Comes::Turn => {
                self.turns[usize::from(self.turned.is_some())] = met.knot.theta;
                let Some(_) = self.turned else {
                    self.turned = Some(time);
                    if 2.0 * time > span {
                        return self.free(None);
                    }
                    if self.task.start.force == 0.0 {
                        self.turns[1] = self.task.start.theta;
                        return self.free(Some(0.0));
                    }
                    (self.way, self.knot, self.time, self.panels) = (-self.way, self.task.start, 0.0, 0);
                    return RunOutcome::On;
                };
                self.free(Some(time))
            }
            _ if gone + time > span => self.free(None),
            _ => self.there(met, gone + time, 1.0 + f64::from(u8::from(self.turned.is_some())), 1.0),
        }
    }

    fn free(&self, second: Option<f64>) -> RunOutcome {
        RunOutcome::Free(self.way_so_far(second))
    }

    fn way_so_far(&self, second: Option<f64>) -> FreeMotion {
        FreeMotion { first: self.turned, second, late: self.late, turns: self.turns, turn: self.turn }
    }

    fn seeks(&mut self, met: &PanelOutcome, time: f64) -> RunOutcome {
        let left = self.target.time - time;
        match met.comes {
            Comes::Edge => {
                (self.time, self.knot) = (time, met.knot);
                RunOutcome::On
            }
            // a time that rounding has put behind an end is there
            Comes::Turn | Comes::Side | Comes::Face if left > 1e-12 * (1.0 + time) => RunOutcome::Unknown,
            _ => self.there(
                met,
                self.target.time,
                self.target.share,
                if self.target.back { -1.0 } else { 1.0 },
            ),
        }
    }

    /// The state there; `share` says how often what is not known of the march is in the time, `sign` whether the way goes on.
    fn there(&self, met: &PanelOutcome, time: f64, share: f64, sign: f64) -> RunOutcome {
        let Knot { theta, w1, w3, .. } = met.knot;
        let (theta, time) = match met.comes {
            Comes::Side => (self.task.theta_end, time),
            // from there it only falls
            Comes::Face => (if self.way > 0.0 { PI } else { 0.0 }, time + FLAT / met.tilt),
            _ => (theta, time),
        };
        let late = share * self.late;
        let state = State { theta, w1, w2: -sign * self.way * met.tilt, w3 };
        let sought = met.comes == Comes::Time || met.comes == Comes::Turn;
        let error = met.off + late * if sought { met.rate } else { 1.0 };
        RunOutcome::There(EventState { comes: met.comes, time, state, error, before: self.way_so_far(None) })
    }
}
