//! The march of one motion to its end, or to a time: its progress, and its next panel.
//!
//! ```text
//! start -> first turning point (t1) -> back at the start (2 t1)
//!       -> second turning point (2 t1 + t2) -> period 2 (t1 + t2)
//! ```
//! An event depends on the inclination alone, so that it has the same place on the way to a turning point and on the
//! way back, and the way back need not be computed. A motion without an event before its first turning point continues
//! from its initial state in the other direction, at the time 2 t1; a motion without an event before its second turning
//! point never ends.

use crate::laws::contact::FLAT;
use crate::laws::state::State;
use crate::motions::exact::lanes::march::{Knot, PanelEvent};
use crate::numbers::larger_or_nan;
use core::f64::consts::PI;

/// Greatest number of panels in one direction; a march that needs more panels gives no result.
const MOST_PANELS: u32 = 48;

/// A motion to be computed by a march: its body, its start and its direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct MarchTask {
    /// The index of the motion in the block.
    pub index: usize,
    /// The numbers of the body: ell, I1, I3 and fillet.
    pub shape: [f64; 4],
    /// Sine and cosine of the inclination at which a part other than the rim lands, or of a limit of the march.
    pub side: [f64; 2],
    /// The inclination at which a part other than the rim lands, in radians.
    pub theta_end: f64,
    pub start: Knot<f64>,
    /// The direction of the march: 1 if the inclination grows, -1 if it falls.
    pub way: f64,
    /// Square of the coefficient of friction.
    pub mu_square: f64,
    /// The time at which the motion begins, on the clock of the times up to which the march goes.
    pub since: f64,
}

/// A time at which the state of a motion is computed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    /// An index by which the caller identifies the target.
    pub slot: usize,
    /// The time of a march from the start to the place of the motion at that time, and whether the motion
    /// returns through this place from a turning point.
    pub time: f64,
    pub returning: bool,
    /// Factor by which the uncertainty of half a swing enters the time of the target.
    pub uncertainty_factor: f64,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    pub task: MarchTask,
    pub knot: Knot<f64>,
    pub way: f64,
    pub target: Target,
    /// The time since the start of the march, in the current direction.
    pub time: f64,
    /// The uncertainty of `time` and of the time to the first turning point.
    late: f64,
    /// The time to the first turning point; None before the march has reached it.
    turned: Option<f64>,
    panels: u32,
    /// Inclinations of the first and of the second turning point; the precession along the march and its uncertainty.
    turning_inclinations: [f64; 2],
    turn: [f64; 2],
}

/// The outcome of a panel for one SIMD lane; `exact::lanes::march::Met` has the meaning of the numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct PanelOutcome {
    pub comes: PanelEvent,
    pub time: f64,
    pub late: f64,
    pub off: f64,
    pub rate: f64,
    pub tilt: f64,
    pub turn: [f64; 2],
    pub knot: Knot<f64>,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum RunOutcome {
    On,
    /// The motion has ended, or the march has reached the time of its target.
    There(EventState),
    /// The motion does not end before the time up to which the march goes.
    Free(FreeMotion),
    /// The march gives no result: it is not precise enough, or takes too many panels.
    Unknown,
}

/// The end of a march: its event, its time, the state at that time, and the error of these.
#[derive(Debug, Clone, Copy)]
pub(super) struct EventState {
    pub comes: PanelEvent,
    pub time: f64,
    pub state: State,
    pub error: f64,
    /// The march up to this event.
    pub before: FreeMotion,
}

/// A motion without an end: the times from time 0 to its turning points, as far as the march has reached them.
#[derive(Debug, Clone, Copy)]
pub(super) struct FreeMotion {
    pub first: Option<f64>,
    pub second: Option<f64>,
    /// The uncertainty of the times `first` and `second` together.
    pub late: f64,
    /// Inclinations of the first and of the second turning point; NaN for a turning point that has not been reached.
    pub turning_inclinations: [f64; 2],
    /// The precession between the turning points, and its uncertainty.
    pub turn: [f64; 2],
}

impl EventState {
    /// The end of a motion that is over at its start.
    pub fn at_once(comes: PanelEvent, state: State) -> Self {
        let before = FreeMotion {
            first: None,
            second: None,
            late: 0.0,
            turning_inclinations: [f64::NAN; 2],
            turn: [0.0; 2],
        };
        Self { comes, time: 0.0, state, error: 0.0, before }
    }
}

impl FreeMotion {
    /// Period of the nutation; infinite unless both turning points are known.
    pub fn period(&self) -> f64 {
        self.first.zip(self.second).map_or(f64::INFINITY, |(first, second)| 2.0 * (first + second))
    }

    /// The uncertainty of the period (if `timed`) and of the precession in a period (if `turned`).
    pub fn errors(&self, timed: bool, turned: bool) -> f64 {
        let rounded = 4.0 * f64::EPSILON;
        let time = if timed { 2.0 * self.late + rounded * self.period() } else { 0.0 };
        let turn = if turned { 2.0 * (self.turn[1] + rounded * self.turn[0].abs()) } else { 0.0 };
        larger_or_nan(time, turn)
    }

    /// The uncertainty of the motion at the time `time`, as a time.
    pub fn time_uncertainty(&self, time: f64) -> f64 {
        self.late * self.uncertainty_factor(time)
    }

    /// Factor by which the uncertainty of half a swing enters a time.
    fn uncertainty_factor(&self, time: f64) -> f64 {
        2.0 + 2.0 * time / self.period()
    }

    /// Least and greatest inclination from the inclination `start` up to a time at which it is `last`.
    pub fn inclinations(&self, start: f64, last: f64, time: f64) -> [f64; 2] {
        let first = self.first.unwrap_or(f64::INFINITY);
        let second = self.second.map_or(f64::INFINITY, |second| 2.0 * first + second);
        let passed = [(first, self.turning_inclinations[0]), (second, self.turning_inclinations[1])];
        let all = passed.into_iter().filter(|(at, _)| *at <= time).map(|(_, theta)| theta);
        all.chain([last]).fold([start; 2], |[low, high], theta| [low.min(theta), high.max(theta)])
    }
}

impl Run {
    pub fn new(task: &MarchTask) -> Self {
        let target = Target { slot: 0, time: f64::INFINITY, returning: false, uncertainty_factor: 1.0 };
        Self {
            task: *task,
            knot: task.start,
            way: task.way,
            target,
            time: 0.0,
            late: 0.0,
            turned: None,
            panels: 0,
            turning_inclinations: [f64::NAN; 2],
            turn: [0.0; 2],
        }
    }

    /// The march to the place of a motion without an end at the time `time`.
    pub fn to(task: &MarchTask, free: &FreeMotion, slot: usize, time: f64) -> Self {
        let mut run = Self::new(task);
        let (mut left, mut returning) = (time, false);
        let period = free.period();
        if let Some(first) = free.first {
            if period.is_finite() {
                left -= (time / period).floor() * period;
            }
            if left > 2.0 * first {
                (left, run.way) = (left - 2.0 * first, -run.way);
                if let Some(second) = free.second.filter(|second| left > *second) {
                    (left, returning) = (2.0 * second - left, true);
                }
            } else if left > first {
                (left, returning) = (2.0 * first - left, true);
            }
        }
        run.late = free.late;
        run.target = Target {
            slot,
            time: left.max(0.0),
            returning,
            uncertainty_factor: free.uncertainty_factor(time),
        };
        run
    }

    /// Continues with the next panel; returns whether the march has taken too many panels.
    pub fn passes(&mut self, knot: Knot<f64>) -> bool {
        self.panels += 1;
        self.knot = knot;
        self.panels > MOST_PANELS
    }

    /// Continues after a panel, up to the time `span`, or to the target if `span` is None.
    pub fn advance(&mut self, met: &PanelOutcome, span: Option<f64>) -> RunOutcome {
        self.panels += 1;
        // A ball has no face: so close to its pole its variables need the time of the passage (`exact`).
        let pole = met.comes == PanelEvent::Face && self.task.shape[3] == 1.0;
        if self.panels > MOST_PANELS || met.comes == PanelEvent::Unknown || pole {
            return RunOutcome::Unknown;
        }
        self.late += met.late;
        (self.turn[0], self.turn[1]) = (self.turn[0] + met.turn[0], self.turn[1] + met.turn[1]);
        let time = self.time + met.time;
        let Some(span) = span else { return self.seek_target(met, time) };
        let gone = self.turned.map_or(0.0, |first| 2.0 * first);
        match met.comes {
            PanelEvent::Edge => {
                (self.time, self.knot) = (time, met.knot);
                if gone + time > span { self.free(None) } else { RunOutcome::On }
            }
            PanelEvent::Turn => {
                self.turning_inclinations[usize::from(self.turned.is_some())] = met.knot.theta;
                let Some(_) = self.turned else {
                    self.turned = Some(time);
                    if 2.0 * time > span {
                        return self.free(None);
                    }
                    if self.task.start.force == 0.0 {
                        self.turning_inclinations[1] = self.task.start.theta;
                        return self.free(Some(0.0));
                    }
                    (self.way, self.knot, self.time, self.panels) = (-self.way, self.task.start, 0.0, 0);
                    return RunOutcome::On;
                };
                self.free(Some(time))
            }
            _ if gone + time > span => self.free(None),
            _ => self.outcome_at(met, gone + time, 1.0 + f64::from(u8::from(self.turned.is_some())), 1.0),
        }
    }

    fn free(&self, second: Option<f64>) -> RunOutcome {
        RunOutcome::Free(self.free_motion_so_far(second))
    }

    fn free_motion_so_far(&self, second: Option<f64>) -> FreeMotion {
        FreeMotion {
            first: self.turned,
            second,
            late: self.late,
            turning_inclinations: self.turning_inclinations,
            turn: self.turn,
        }
    }

    fn seek_target(&mut self, met: &PanelOutcome, time: f64) -> RunOutcome {
        let left = self.target.time - time;
        match met.comes {
            PanelEvent::Edge => {
                (self.time, self.knot) = (time, met.knot);
                RunOutcome::On
            }
            // A time that lies behind the end of the motion by rounding alone counts as the time of the end.
            PanelEvent::Turn | PanelEvent::Side | PanelEvent::Face if left > 1e-12 * (1.0 + time) => {
                RunOutcome::Unknown
            }
            _ => self.outcome_at(
                met,
                self.target.time,
                self.target.uncertainty_factor,
                if self.target.returning { -1.0 } else { 1.0 },
            ),
        }
    }

    /// The outcome at an event or at the time of the target; `uncertainty_factor` is the factor of the march's uncertainty
    /// in that time, and `sign` is -1 where the motion returns from a turning point, else 1.
    fn outcome_at(&self, met: &PanelOutcome, time: f64, uncertainty_factor: f64, sign: f64) -> RunOutcome {
        let Knot { theta, w1, w3, .. } = met.knot;
        let (theta, time) = match met.comes {
            PanelEvent::Side => (self.task.theta_end, time),
            // From this inclination to the face the body falls at the speed `met.tilt`.
            PanelEvent::Face => (if self.way > 0.0 { PI } else { 0.0 }, time + FLAT / met.tilt),
            _ => (theta, time),
        };
        let late = uncertainty_factor * self.late;
        let state = State { theta, w1, w2: -sign * self.way * met.tilt, w3 };
        let sought = met.comes == PanelEvent::Time || met.comes == PanelEvent::Turn;
        let error = met.off + late * if sought { met.rate } else { 1.0 };
        RunOutcome::There(EventState {
            comes: met.comes,
            time,
            state,
            error,
            before: self.free_motion_so_far(None),
        })
    }
}
