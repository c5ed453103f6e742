//! Motions that end, and swings too wide for one series: marches in SIMD lanes, panel by panel, to the first event.
//!
//! ```text
//! N = 32 terms, 16 nodes   ->   56 terms, 64 nodes   ->   56 terms, 320 nodes   ->   one at a time
//! ```
//! [`exact::lanes::march`](crate::motions::exact::lanes) has the panels. A march whose estimated error exceeds the
//! tolerance is repeated with more terms and more nodes; one motion in a few hundred is still not precise enough after
//! that and is computed alone. A motion that is over at once needs no march.

mod march;
mod run;
mod set;
mod summed;

use super::{Answer, MotionBlock, MotionOutput, Summary};
use crate::laws::state::State;
use crate::motions::Ending;
use crate::motions::exact;
use crate::motions::exact::lanes::march::{Knot, PanelEvent, Rule, Sought};
use crate::motions::motion::{InitialData, begun};
use crate::numbers::larger_or_nan;
use crate::numbers::side_by_side::SideBySide;
use core::cell::Cell;
use core::f64::consts::FRAC_PI_2;
use march::march;
use run::{EventState, FreeMotion, MarchTask, Run, RunOutcome};
use set::{FEW, MANY, MarchKind};
use std::sync::LazyLock;
use summed::SolvedBlock;

/// The finest rule may have this error whatever the tolerance, because it is a rounding error, as large as for a motion
/// that is computed alone.
const FINEST_RULE_ERROR: f64 = 4e-12;

/// The quadrature rules of the three marches.
static RULES: LazyLock<[Rule; 3]> = LazyLock::new(|| [16, 64, 320].map(Rule::new));

/// The cosine of the double that is nearest to pi/2.
const RIGHT_ANGLE_COSINE: f64 = 6.123_233_995_736_766e-17;

/// Least coefficient of friction for which motions that may slip are computed in SIMD lanes; for a smaller one the
/// margin of slip is a rounding error.
const LEAST_FRICTION_COEFFICIENT: f64 = 1e-9;

/// Square of w2 below which a start counts as a turning point, which is then at most about 1e-18 away in
/// time.
const TURNING_START_SQUARE: f64 = 1e-36;

/// Sine and cosine of pi, an inclination that no body reaches.
const UNREACHABLE_SIDE: [f64; 2] = [0.0, -1.0];

/// Sine and cosine of theta_end, the inclination at which a part other than the rim lands; for most bodies it is a
/// right angle.
fn sin_cos_of_theta_end(theta_end: f64) -> [f64; 2] {
    if theta_end == FRAC_PI_2 { [1.0, RIGHT_ANGLE_COSINE] } else { theta_end.sin_cos().into() }
}

/// A motion of a block after its march, with the event that ends it, if any.
struct SolvedRun {
    task: MarchTask,
    free: FreeMotion,
    end: Option<EventState>,
    /// The index of the march that solved the motion; the earlier marches were not precise enough.
    rule_index: usize,
    /// Least and greatest inclination of the motion.
    theta_range: Cell<[f64; 2]>,
}

impl SolvedRun {
    fn new(task: &MarchTask, free: FreeMotion, end: Option<EventState>, rule_index: usize) -> Self {
        let known =
            Self { task: *task, free, end, rule_index, theta_range: Cell::new([task.start.theta; 2]) };
        if let Some(end) = end {
            known.note_inclination(end.state.theta, end.time);
        }
        known
    }

    /// Sets `theta_range` from the last inclination and the last time of the motion.
    fn note_inclination(&self, theta: f64, time: f64) {
        self.theta_range.set(self.free.inclinations(self.task.start.theta, theta, time));
    }
}

/// The marches of motions in a block, all on sharp rims or all on rounded rims.
pub(super) struct Marches<'a, 'b> {
    pub work: &'a MotionBlock<'b>,
    /// Whether the rims are rounded, which is the same for all of the bodies.
    pub round: bool,
}

impl Marches<'_, '_> {
    /// The error that the result of a march with the rule `rule_index` may have.
    fn allowed(&self, rule_index: usize) -> f64 {
        let tol = self.work.job.tol;
        if rule_index + 1 == RULES.len() { tol.max(FINEST_RULE_ERROR) } else { tol }
    }

    /// Computes the motions of the block for which marches are precise enough; returns the other motions.
    pub fn run<T: SideBySide>(
        &self,
        like: T,
        todo: &[usize],
        out: &mut MotionOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Vec<usize> {
        let job = self.work.job;
        if !can_march(self.work, self.round) {
            return todo.to_vec();
        }
        let (mut left, mut tasks, mut known) = (Vec::new(), Vec::new(), Vec::new());
        for i in todo {
            match self.begin(*i) {
                MarchStart::March(task) => tasks.push(task),
                MarchStart::Over(task, there) => {
                    known.push(SolvedRun::new(&task, there.before, Some(there), 0))
                }
                MarchStart::Unknown => left.push(*i),
            }
        }
        let sought = Sought { ends: !job.ask.beyond, slips: self.work.may_slip(), turns: false };
        let kind = MarchKind { contact: job.contact(), round: self.round, sought };
        let span = job.span().abs();
        let mut again = tasks;
        known.reserve(again.len());
        for rule_index in 0..RULES.len() {
            let runs = core::mem::take(&mut again).into_iter().map(|task| Run::new(&task));
            self.march_on(like, kind, (rule_index, Some(span)), runs, go_on, |run, turn| match turn {
                RunOutcome::There(there) if there.error < self.allowed(rule_index) => {
                    known.push(SolvedRun::new(&run.task, there.before, Some(there), rule_index));
                }
                RunOutcome::Free(free)
                    if free.time_uncertainty(span - run.task.since) < 0.5 * self.allowed(rule_index) =>
                {
                    known.push(SolvedRun::new(&run.task, free, None, rule_index))
                }
                _ => again.push(run.task),
            });
        }
        left.extend(again.iter().map(|task| task.index));
        left.extend(self.write_results(like, kind, &known, out, go_on));
        left.extend(SolvedBlock { marches: self, known: &known, kind }.run(like, out, go_on));
        left.sort_unstable();
        left.dedup();
        left
    }

    /// Computes marches with the rule and the terms of `rule_index`, up to the time `span`, or to the targets if `span` is None.
    fn march_on<T: SideBySide>(
        &self,
        like: T,
        kind: MarchKind,
        (rule_index, span): (usize, Option<f64>),
        runs: impl IntoIterator<Item = Run>,
        go_on: &mut dyn FnMut() -> bool,
        tell: impl FnMut(&Run, RunOutcome),
    ) {
        let rule = &RULES[rule_index];
        if rule_index == 0 {
            march::<T, FEW>(like, kind, rule, span, runs, go_on, tell);
        } else {
            march::<T, MANY>(like, kind, rule, span, runs, go_on, tell);
        }
    }

    /// The first march of a motion, or its end if the motion is over at its start.
    fn begin(&self, i: usize) -> MarchStart {
        let (job, row) = (self.work.job, self.work.first + i);
        let (body, start) = (self.work.starts.body(row), self.work.starts.state(row));
        let Ok(body) = body else { return MarchStart::Unknown };
        if exact::check(&body, &start).is_err() {
            return MarchStart::Unknown;
        }
        let time_way = if job.span() < 0.0 { -1.0 } else { 1.0 };
        let grip = self.work.grip(i);
        let InitialData { angle: (sin, cos), rate, over } =
            begun(&body, job.contact(), grip, &start, time_way);
        let over = over.filter(|_| !job.ask.beyond);
        if over.is_none() && self.work.may_slip() && grip < LEAST_FRICTION_COEFFICIENT {
            return MarchStart::Unknown;
        }
        let law = job.contact().reduced(&body);
        let inertia = law.inertia(|| (sin, cos));
        let mut force = inertia * start.w2 * start.w2;
        // The inclination changes at the rate -w2, and at the rate w2 if time runs backwards.
        let mut way = -time_way * start.w2.signum();
        if force < TURNING_START_SQUARE * inertia {
            (force, way) = (0.0, -rate.w2.signum());
            if rate.w2 == 0.0 && over.is_none() {
                return MarchStart::Unknown;
            }
        }
        let side = if job.ask.beyond { UNREACHABLE_SIDE } else { sin_cos_of_theta_end(body.theta_end()) };
        let task = MarchTask {
            index: i,
            shape: [body.ell(), body.i1(), body.i3(), body.fillet()],
            side,
            theta_end: body.theta_end(),
            start: Knot { theta: start.theta, sin, cos, w1: start.w1, w3: start.w3, force, doubt: 0.0 },
            way,
            mu_square: grip * grip,
            since: self.work.since(i),
        };
        match over {
            Some(ending) => {
                MarchStart::Over(task, EventState::at_once(event_of(ending), in_march_time(start, time_way)))
            }
            None => MarchStart::March(task),
        }
    }

    /// Writes the results of the solved motions, with their states at the times of the job; returns the motions whose
    /// states do not reach the tolerance.
    fn write_results<T: SideBySide>(
        &self,
        like: T,
        kind: MarchKind,
        known: &[SolvedRun],
        out: &mut MotionOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Vec<usize> {
        let job = self.work.job;
        let times = job.times;
        let way = if job.span() < 0.0 { -1.0 } else { 1.0 };
        for of in known {
            self.tell(of, out);
        }
        // For a motion that ends, only the states before its end are computed.
        let all = out.states.is_some();
        let sought = |k: usize| {
            let (end, since) = (known[k].end, known[k].task.since);
            let begins = times.partition_point(|t| t.abs() < since);
            let first = if all { begins } else { times.len() - usize::from(end.is_none()) };
            let count = end.map_or(times.len(), |end| times.partition_point(|t| t.abs() - since <= end.time));
            (first..count).map(move |j| k * times.len() + j)
        };
        let kind = MarchKind { sought: Sought { ends: false, slips: false, turns: false }, ..kind };
        let mut again: Vec<usize> = Vec::new();
        for rule_index in 0..RULES.len() {
            let fresh = (0..known.len()).filter(|k| known[*k].rule_index == rule_index).flat_map(sought);
            let runs = core::mem::take(&mut again).into_iter().chain(fresh).map(|slot| {
                let of = &known[slot / times.len()];
                Run::to(&of.task, &of.free, slot, times[slot % times.len()].abs() - of.task.since)
            });
            self.march_on(like, kind, (rule_index, None), runs, go_on, |run, turn| {
                let slot = run.target.slot;
                let (of, j) = (&known[slot / times.len()], slot % times.len());
                let (i, time) = (of.task.index, times[j].abs() - of.task.since);
                let RunOutcome::There(there) = turn else { return again.push(slot) };
                if there.error.is_nan() || there.error >= self.allowed(rule_index) {
                    return again.push(slot);
                }
                let start = self.work.starts.state(self.work.first + i);
                let y = if time == 0.0 { start } else { in_march_time(there.state, way) };
                out.error[i] = larger_or_nan(out.error[i], there.error);
                out.put_state(i * times.len() + j, &y, [0.0; 2]);
                if j + 1 == times.len() && of.end.is_none() {
                    of.note_inclination(y.theta, time);
                    out.put_last(i, &y, [0.0; 2]);
                }
            });
        }
        again.iter().map(|slot| known[slot / times.len()].task.index).collect()
    }

    /// Writes the results of a solved motion that need no state at a time.
    fn tell(&self, of: &SolvedRun, out: &mut MotionOutput<'_>) {
        let (job, i, since) = (self.work.job, of.task.index, of.task.since);
        let way = if job.span() < 0.0 { -1.0 } else { 1.0 };
        let status = of.end.map_or(Ending::Done, |end| ending(end.comes)) as u8;
        out.tell(i, Answer::Lanes, status, of.end.map_or(0.0, |end| end.error));
        out.put(Summary::End, i, of.end.map_or(job.span(), |end| way * (since + end.time)));
        let Some(end) = of.end else { return };
        out.put_last(i, &in_march_time(end.state, way), [0.0; 2]);
        let (times, after) = (job.times.len(), job.times.partition_point(|t| t.abs() - since <= end.time));
        for column in out.states.iter_mut().flatten() {
            column[i * times + after..(i + 1) * times].fill(f64::NAN);
        }
    }
}

/// The start of a motion: a task for a march, a motion that is over at once, or a start for which no march is
/// possible.
enum MarchStart {
    March(MarchTask),
    Over(MarchTask, EventState),
    Unknown,
}

/// Whether marches can compute a block: the margin of slip has no series for a rounded rim.
pub(super) fn can_march(work: &MotionBlock<'_>, round: bool) -> bool {
    work.job.step().is_none() && !(round && work.may_slip())
}

/// The ending of a motion at an event.
fn ending(comes: PanelEvent) -> Ending {
    match comes {
        PanelEvent::Side => Ending::Side,
        PanelEvent::LiftOff => Ending::LiftOff,
        PanelEvent::Slip => Ending::Slip,
        PanelEvent::Face => Ending::Face,
        _ => Ending::Done,
    }
}

/// The event in a panel for an ending at time 0.
fn event_of(ending: Ending) -> PanelEvent {
    match ending {
        Ending::Side => PanelEvent::Side,
        Ending::LiftOff => PanelEvent::LiftOff,
        _ => PanelEvent::Slip,
    }
}

/// A state with w2 reversed if time runs backwards, `way` = -1.
fn in_march_time(y: State, way: f64) -> State {
    State { w2: way * y.w2, ..y }
}
