//! The computation of many motions side by side, phase by phase, and the queues for SIMD lanes.
//!
//! A walk computes one motion through its phases; a flow is a phase that is integrated by steps. Each kind of flow has
//! its own queue. Steps that a lane cannot take, a few or all to the end, are taken outside the lanes.

use super::lossy_lanes::LossyKind;
use crate::error::Error;
use crate::laws::body::landing_angle;
use crate::methods::flow::lanes::{Entry, Flows, LaneStatus, NUMBERS, evaluations_before_limit};
use crate::methods::flow::schedule::{STEPS_ALONE, Waiting, follow};
use crate::methods::flow::{Spent, steps_to_stuck_test};
use crate::motions::body::BodyWalk;
use crate::motions::body::roll::lossy::LOSSY_NUMBERS;
use crate::motions::walk::numbers::{PHI, TIME, X, poses, pull};
use crate::motions::walk::{Pause, Phases, WalkStep};
use crate::numbers::side_by_side::{MOST, SideBySide};
use core::f64::consts::PI;
use std::collections::VecDeque;

/// While a single flow takes one step, a flow in a SIMD lane makes this many evaluations; then the flow looks at its
/// slip, for which it leaves its lane for some steps.
const EVALUATIONS_PER_LOOK: u64 = 48;

/// A flow for a SIMD lane: the index of its walk (the motion of which it is a phase), and its start.
pub(super) struct FlowTask<const N: usize> {
    walk: usize,
    y: [f64; N],
    step: f64,
    numbers: [f64; NUMBERS],
    tol: f64,
    until: f64,
    patience: u64,
    made: u64,
}

/// The kind of a flow; the flows that are in SIMD lanes at one time are all of one kind.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum FlowKind {
    /// Slips; `dry` means Coulomb's friction, which has a direction also where the slip vanishes, unlike viscous
    /// friction or ice.
    Slips { dry: bool },
    /// Motions without slip that lose energy by the same laws, or whose table is tilted.
    Lossy(LossyKind),
}

/// The flows of one kind that wait for SIMD lanes.
pub(super) type Queue<const N: usize> = (FlowKind, VecDeque<FlowTask<N>>);

/// The walks of a block, two for each motion, of which the second one has a larger tolerance. A walk computes one
/// motion through its phases.
pub(super) struct Walks<'a, const N: usize> {
    pub walks: Vec<Result<BodyWalk<'a, N>, Error>>,
    pub queues: Vec<Queue<N>>,
    /// The indices of the walks (motions) that wait for a phase of rolling, each with its coefficient of static friction.
    pub rolls: Vec<(usize, f64)>,
    /// Whether this processor has SIMD lanes; without lanes every motion is computed alone.
    pub lanes: bool,
}

/// The kind of the present phase of a motion, and the parameters that a SIMD lane needs; None for a motion that is
/// computed alone.
fn kind_and_lane_numbers<const N: usize>(
    walk: &BodyWalk<'_, N>,
    y: &[f64; N],
) -> Option<(FlowKind, [f64; NUMBERS])> {
    let (body, mut numbers) = (&walk.of.body, [0.0; NUMBERS]);
    numbers[..4].copy_from_slice(&[body.ell(), body.i1(), body.i3(), body.fillet()]);
    // A hop that rolls and loses nothing on a level table is short. In lanes a body has one circle of radius 1 or two equal rims.
    let apart = walk.of.lying.is_some() || walk.of.standing.is_some();
    if body.has_row() || apart || walk.lossy().is_some() && walk.ask.losses.is_none() && !poses(N) {
        return None;
    }
    numbers[NUMBERS - 1] = walk.of.slide.tilt;
    if let Some(lossy) = walk.lossy() {
        let law = LossyKind { contact: walk.contact(), round: !body.is_sharp(), present: lossy.present() };
        numbers[4..4 + LOSSY_NUMBERS].copy_from_slice(&lossy.numbers());
        return lossy.is_free().then_some((FlowKind::Lossy(law), numbers));
    }
    let slide = &walk.of.slide;
    let (sine, cosine) = landing_angle(body.theta_end());
    let there = f64::from(u8::from(body.theta_end() < PI));
    numbers[4..9].copy_from_slice(&[slide.law.strength, slide.over_in_lanes(y), sine, cosine, there]);
    (slide.law.losses.is_none() && slide.law.patch().is_none())
        .then_some((FlowKind::Slips { dry: slide.law.dry }, numbers))
}

/// The variables of a motion for a SIMD lane, the last of which is the time. They have a pose only on tilted tables,
/// where the lane also has cos phi, sin phi and x; a cos phi that is only a rounding error, straight up or down, is 0.
fn lane_numbers<const N: usize, const K: usize>(y: &[f64; N]) -> [f64; K] {
    let mut all = core::array::from_fn(|i| y[i]);
    if poses(N) {
        let [cos, against] = pull(1.0, y);
        all[K - 4..K - 1].copy_from_slice(&[cos, -against, y[X]]);
    }
    all[K - 1] = y[TIME];
    all
}

/// The variables of a motion whose phase began with `from` and has reached the variables `y` in a SIMD lane.
fn walk_numbers<const N: usize, const K: usize>(from: &[f64; N], y: &[f64; K]) -> [f64; N] {
    let mut all = *from;
    let own = if poses(N) { K - 4 } else { K - 1 };
    all[..own].copy_from_slice(&y[..own]);
    all[TIME] = y[K - 1];
    if poses(N) {
        (all[PHI], all[X]) = (y[K - 3].atan2(y[K - 4]), y[K - 2]);
    }
    all
}

impl<const N: usize> Walks<'_, N> {
    /// Continues a motion up to its next phase that a SIMD lane can compute, or to its end.
    pub fn continue_walk(
        &mut self,
        i: usize,
        mut found: Result<Pause<N>, Error>,
        go_on: &mut dyn FnMut() -> bool,
    ) {
        loop {
            let Ok(walk) = &mut self.walks[i] else { return };
            let (y, step) = match found {
                Ok(Pause::Here(y, step)) => (y, step),
                Ok(Pause::No) => match walk.advance(go_on) {
                    Ok(WalkStep::Flows(y)) => (y, None),
                    Ok(WalkStep::Rolls(mu)) => {
                        self.rolls.push((i, mu));
                        return;
                    }
                    Ok(WalkStep::Done) => return,
                    Err(e) => {
                        self.walks[i] = Err(e);
                        return;
                    }
                },
                Err(e) => {
                    self.walks[i] = Err(e);
                    return;
                }
            };
            let place = if self.lanes { kind_and_lane_numbers(walk, &y) } else { None };
            let Some(((among, numbers), until)) = place.zip(walk.until()) else {
                found = walk.flows(y, step, u64::MAX, go_on);
                continue;
            };
            let (tol, patience) = (walk.of.slide.tol, steps_to_stuck_test(walk.spent.patience));
            let step = step.unwrap_or_else(|| Phases::first(walk, &y));
            let looks = walk.steps_to_look(&y).saturating_mul(EVALUATIONS_PER_LOOK);
            let made = evaluations_before_limit(walk.toil().min(looks));
            let task = FlowTask { walk: i, y, step, numbers, tol, until, patience, made };
            match self.queues.iter_mut().find(|(of, _)| *of == among) {
                Some((_, queue)) => queue.push_back(task),
                None => self.queues.push((among, VecDeque::from([task]))),
            }
            return;
        }
    }

    /// Continues a motion outside the SIMD lanes after its lane has stopped: from the state of the lane, with the step
    /// that the lane would have taken.
    fn handle(
        &mut self,
        task: &FlowTask<N>,
        status: LaneStatus,
        (y, step): ([f64; N], f64),
        spent: Spent,
        go_on: &mut dyn FnMut() -> bool,
    ) {
        let Ok(walk) = &mut self.walks[task.walk] else { return };
        let y = walk.followed(&task.y, y);
        walk.has_spent_elsewhere(spent, task.patience);
        let found =
            walk.flows(y, Some(step), if status == LaneStatus::TimeReached { 1 } else { STEPS_ALONE }, go_on);
        self.continue_walk(task.walk, found, go_on);
    }
}

/// The flows of one queue, including those that are in SIMD lanes.
struct Queued<'a, 'b, const N: usize> {
    all: &'a mut Walks<'b, N>,
    queue: usize,
    tasks: [Option<FlowTask<N>>; MOST],
    go_on: &'a mut dyn FnMut() -> bool,
}

impl<const N: usize, const K: usize, const M: usize> Waiting<K, M> for Queued<'_, '_, N> {
    fn enter(&mut self, k: usize) -> Option<Entry<K, M>> {
        let next = self.all.queues[self.queue].1.pop_front()?;
        let FlowTask { step, numbers, tol, until, patience, made, .. } = next;
        let y = lane_numbers(&next.y);
        self.tasks[k] = Some(next);
        Some(Entry { y, step, numbers, tol, until, patience, made })
    }

    fn leave(&mut self, k: usize, status: LaneStatus, (y, step): ([f64; K], f64), spent: Spent) {
        let Some(ended) = self.tasks[k].take() else { return };
        let y = walk_numbers(&ended.y, &y);
        let spent = Spent { evaluations: spent.evaluations - ended.made, ..spent };
        self.all.handle(&ended, status, (y, step), spent, self.go_on);
    }

    fn go_on(&mut self) -> bool {
        (self.go_on)()
    }
}

/// Computes all flows of a queue in SIMD lanes, each until its lane stops.
pub(super) fn lanes<T: SideBySide, L: Flows<T, K, M>, const K: usize, const M: usize, const N: usize>(
    like: T,
    queue: usize,
    law: L,
    all: &mut Walks<'_, N>,
    go_on: &mut dyn FnMut() -> bool,
) {
    follow(like, law, &mut Queued { all, queue, tasks: [const { None }; MOST], go_on });
}
