//! The path of a body on a table with friction, through phases of slipping and of rolling.
//!
//! ```text
//! slip    u = 0 and |F_roll| <= mu_s N      roll          u = 0, more is needed     slip in another direction
//! roll    |F_roll| = mu_s N                 slip          both   N = 0, a face or the other rim lands: the end
//! ```
//! A slipping phase is integrated (`motion::slide`). A rolling phase without losses is the exact solution, so that its
//! cost does not depend on its length. Where no force, or more than one, obeys the law of friction (Painleve), a start
//! is refused and a motion ends.
//!
//! Error: the path is computed twice, the second time with a tolerance up to ten thousand times as large, which costs a
//! third. The claimed error is thirty times the difference of the two paths, scaled by the ratio of the tolerances.

mod walk;

pub use super::ask::FINE;
use super::ask::{check_flow, check_times_after};
use super::{Ask, Ending, Motion, Moving, Start};
use crate::body::Body;
use crate::codes::coded;
use crate::error::{Error, room, within};
use crate::exact;
use crate::number::larger;
use crate::state::State;
pub(crate) use walk::{Pause, RENEWED, STILL, Walk, WalkStep, most_phases};

coded! {
    /// The kind of a phase: the contact point rests or slips.
    pub enum Kind {
        /// The contact point rests.
        Rolling = 0,
        /// The contact point slips.
        Slipping = 1,
    }
}

/// A part of a motion in which the contact point rests all the time or slips all the time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phase<S = State> {
    /// The time at which the phase begins.
    pub time: f64,
    /// The kind of the phase.
    pub kind: Kind,
    /// The state at the beginning of the phase.
    pub state: S,
    /// The slip at the beginning of the phase, along the lean and across it.
    pub slip: [f64; 2],
}

/// The slip, the phases and the losses of a motion. The motion's estimated error also covers the slips, and the times
/// and states of the phases and of the end; the error of the heat is that error times the largest speed.
#[derive(Debug, Clone, PartialEq)]
pub struct Path<S = State> {
    /// The slip at each time, along the lean and across it.
    pub slip: Vec<[f64; 2]>,
    /// The heat of friction up to each time, in M g R.
    pub dissipated: Vec<f64>,
    /// The energy that the losses have taken up to each time, in M g R; empty if there are none.
    pub work_lost: Vec<f64>,
    /// Whether the contact point rests or slips at each time.
    pub kinds: Vec<Kind>,
    /// The phases, beginning with that of the start.
    pub phases: Vec<Phase<S>>,
    /// The total heat of friction up to the last time or the end.
    pub heat: f64,
    /// The total energy that the losses have taken.
    pub lost: f64,
    /// The total time of slipping.
    pub slipping: f64,
    /// The slip at the event that ended the motion.
    pub last_slip: [f64; 2],
    /// Of a stone, the time up to which the claimed error stays at most 1 % of the largest speed, or 0.01 of slow motions;
    /// infinite if it does so up to the end.
    pub known_until: f64,
    /// Whether the body has rocked over onto its other rim, now and, if poses were asked for, at each time.
    upside_down: bool,
    pub(super) turned: Vec<bool>,
    /// Whether the motion was left where the body began to roll.
    pub(crate) rolls_on: bool,
    /// Whether the last turns of a whirr were left out, since its end was known before them.
    pub(crate) leaves_turns: bool,
    /// The sum of the estimated errors of all steps.
    pub(crate) erred: f64,
    /// The direction in which the present slip began from rest.
    way: [f64; 2],
}

/// A motion and its path, before the path becomes a part of the motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Followed<S: Moving = State> {
    pub motion: Motion<S>,
    pub path: Path<S>,
}

impl<S> Path<S> {
    /// A path with room for `count` outputs, and for as many numbers of lost energy.
    pub(crate) fn empty(count: usize, losing: usize) -> Result<Self, Error> {
        Ok(Self {
            slip: room(count)?,
            dissipated: room(count)?,
            work_lost: room(losing)?,
            kinds: room(count)?,
            phases: Vec::new(),
            heat: 0.0,
            lost: 0.0,
            slipping: 0.0,
            last_slip: [0.0; 2],
            known_until: f64::INFINITY,
            upside_down: false,
            turned: Vec::new(),
            rolls_on: false,
            leaves_turns: false,
            erred: 0.0,
            way: [0.0; 2],
        })
    }
}

/// The second run has `ROUGHER` times the tolerance of the first, at most `ROUGH`, but at least `BARELY` times as much.
const ROUGHER: f64 = 1e4;
const BARELY: f64 = 32.0;
const ROUGH: f64 = 1e-7;
/// An end this near to the last time may be met by only one of the two runs.
const LATE: f64 = 1e-6;
/// Phases of two runs belong together if their times differ by less than this share of the time to the next one.
const TOGETHER: f64 = 0.3;
/// A second run with more than this share of the evaluations has made much the same steps, with the same errors.
const ALIKE: f64 = 0.7;
/// Share of the sum of all step errors that is claimed in any case.
const CHANCE: f64 = 0.1;
/// Runs that differ by this share of the largest speed have parted, and their whole difference is claimed.
const PARTED: f64 = 0.3;

/// The motion of a body that slips or loses energy, for [`roll_with`](super::roll_with). A page that follows no other
/// motion calls this function directly and carries no other code. A motion that hardly advances, or in which slipping and
/// rolling alternate more than 20 times in each unit of time (at least 5,000 and at most 10,000 times), ends there with
/// [`Ending::Bounded`]. Error at any time: `Lost` where the equations lose their digits.
pub fn follow(
    body: &Body,
    start: &Start,
    times: &[f64],
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    let fine = check(body, start, ask)?;
    check_times_after(start.time, times)?;
    // A page prefers a single code, with the pose and the lost energy of each motion, to the fastest one.
    const PAGE: bool = cfg!(target_arch = "wasm32");
    let mut run = |tol: f64, times: &[f64]| match (PAGE || ask.pose, !PAGE && ask.losses.is_none()) {
        (true, true) => Walk::<13>::new(body, ask, tol, times, start)?.run(go_on),
        (true, false) => Walk::<14>::new(body, ask, tol, times, start)?.run(go_on),
        (false, true) => Walk::<9>::new(body, ask, tol, times, start)?.run(go_on),
        (false, false) => Walk::<10>::new(body, ask, tol, times, start)?.run(go_on),
    };
    let Some(mut found) = run(fine, times)? else { return Ok(None) };
    // Of a motion that is given up, only the states before are judged.
    let judged = if found.is_given_up() { found.motion.states.len() } else { times.len() };
    let Some(rough) = run(rougher(fine), &times[..judged])? else { return Ok(None) };
    found.judge(&rough, fine);
    Ok(Some(Motion { path: Some(Box::new(found.path)), ..found.motion }))
}

/// The tolerance of the second run, by which a path with the tolerance `tol` is judged.
pub(crate) fn rougher(tol: f64) -> f64 {
    (ROUGHER * tol).min(ROUGH).max(BARELY * tol)
}

/// Refuses a body, a start or options out of range. Returns the tolerance of the steps.
fn check(body: &Body, start: &Start, ask: &Ask) -> Result<f64, Error> {
    exact::check(body, &start.state)?;
    ask.table.check()?;
    ask.losses.check_for(body)?;
    let fine = check_flow(ask)?;
    for (name, u) in ["slip along the lean", "slip across"].into_iter().zip(start.slip) {
        within(name, u, (-1e6, 1e6), "at most 1e6 sqrt(g R) for a motion")?;
    }
    if ask.table.rubs() { Ok(fine) } else { without_slip(start.slip).map(|()| fine) }
}

/// Refuses a slip on a table without a law of friction.
pub(super) fn without_slip([along, across]: [f64; 2]) -> Result<(), Error> {
    let value = if along == 0.0 { across } else { along };
    if value == 0.0 {
        return Ok(());
    }
    Err(Error::OutOfRange { name: "slip", value, expected: "no slip on this table" })
}

/// The phases of two runs up to the time `end` that belong together, and the length of the longest phase that only one of
/// the runs has. Slipping and rolling alternate, so that a slip of one run only would set all later phases against wrong
/// ones. Of two `whirrs` whose last turns are left out, one may have followed more turns than the other.
fn together<S>(runs: [&[Phase<S>]; 2], end: f64, whirrs: bool) -> (Vec<[&Phase<S>; 2]>, f64) {
    let (mut pairs, mut alone, mut at) = (Vec::new(), 0f64, [0; 2]);
    let lasts = |k: usize, i: usize| {
        let next = runs[k].get(i + 1).map_or(end, |next| next.time);
        (next - runs[k][i].time).max(0.0)
    };
    while let (Some(a), Some(b)) = (runs[0].get(at[0]), runs[1].get(at[1])) {
        let long = [lasts(0, at[0]), lasts(1, at[1])];
        let last = at[0] + 1 == runs[0].len() && at[1] + 1 == runs[1].len();
        let near = (a.time - b.time).abs() <= TOGETHER * long[0].min(long[1]);
        if a.kind == b.kind && (near || last) {
            pairs.push([a, b]);
            at = at.map(|i| i + 1);
            continue;
        }
        // The earlier phase stands alone, with the one after it where both runs are in phases of one kind. A slip that
        // only goes on in another direction is no phase by itself.
        let k = usize::from(b.time < a.time || b.time == a.time && long[1] < long[0]);
        let goes_on = at[k] > 0 && runs[k][at[k] - 1].kind == runs[k][at[k]].kind;
        alone = alone.max(if goes_on { 0.0 } else { long[k] });
        at[k] += if a.kind == b.kind && !goes_on { 2 } else { 1 };
    }
    for k in if whirrs { 0..0 } else { 0..2 } {
        alone = runs[k].get(at[k]).map_or(alone, |phase| alone.max(end - phase.time));
    }
    (pairs, alone)
}

impl Followed {
    /// The state and the slip at the last time, or at the end of the motion.
    pub(crate) fn last(&self) -> Option<(State, [f64; 2])> {
        match self.motion.event {
            Some(event) => Some((event.state, self.path.last_slip)),
            None if self.path.rolls_on => self.path.phases.last().map(|phase| (phase.state, phase.slip)),
            None => self.motion.states.last().copied().zip(self.path.slip.last().copied()),
        }
    }

    /// The time at which the motion ended, if it ended before the last time.
    pub(crate) fn ended(&self) -> Option<f64> {
        let rolling = self.path.phases.last().filter(|_| self.path.rolls_on).map(|phase| phase.time);
        self.motion.event.map(|e| e.time).or(rolling)
    }
}

impl<S: Moving> Followed<S> {
    /// Whether the motion was given up before its last time.
    fn is_given_up(&self) -> bool {
        self.motion.event.is_some_and(|event| event.ending == Ending::Bounded)
    }

    /// Adds a point to the outputs.
    pub(crate) fn put(
        &mut self,
        y: S,
        slip: [f64; 2],
        heat: f64,
        kind: Kind,
        pose: Option<S::Pose>,
        force: Option<(S::Force, f64)>,
    ) {
        self.motion.states.push(y);
        self.path.slip.push(slip);
        self.path.dissipated.push(heat);
        self.path.kinds.push(kind);
        if let Some((poses, pose)) = self.motion.poses.as_mut().zip(pose) {
            poses.push(pose);
            self.path.turned.push(self.path.upside_down);
        }
        if let Some((forces, (force, doubt))) = self.motion.forces.as_mut().zip(force) {
            forces.push(force);
            self.motion.force_error = larger(self.motion.force_error, doubt);
        }
    }

    /// Estimates the errors of this motion by a rougher one.
    pub(crate) fn judge(&mut self, rough: &Self, tol: f64) {
        let claimed = (S::SAFETY * tol / rougher(tol)).min(1.0);
        let given_up = self.is_given_up();
        let motion = &mut self.motion;
        let (mut off, mut turned, mut pressed) = (0f64, 0f64, 0f64);
        let mut apart = |by: f64| off = off.max(by);
        for (a, b) in motion.states.iter().zip(&rough.motion.states) {
            apart(a.distance(b));
        }
        for (a, b) in self.path.slip.iter().flatten().zip(rough.path.slip.iter().flatten()) {
            apart((a - b).abs());
        }
        let whirrs = self.path.leaves_turns || rough.path.leaves_turns || given_up;
        let end = [&*motion, &rough.motion].map(|m| m.event.map(|e| e.time).or(m.times.last().copied()));
        let end = end.into_iter().flatten().fold(0.0, f64::max);
        let (pairs, alone) = together([&self.path.phases, &rough.path.phases], end, whirrs);
        for [a, b] in pairs {
            apart((a.time - b.time).abs());
            apart(a.state.distance(&b.state));
        }
        if let (Some(a), Some(b)) = (motion.event, rough.motion.event) {
            apart((a.time - b.time).abs());
            apart(a.state.distance(&b.state));
        }
        if let (Some(poses), Some(others)) = (&motion.poses, &rough.motion.poses) {
            for (a, b) in poses.iter().zip(others) {
                turned = turned.max(S::pose_distance(a, b));
            }
        }
        if let (Some(forces), Some(others)) = (&motion.forces, &rough.motion.forces) {
            for (a, b) in forces.iter().zip(others) {
                pressed = pressed.max(S::force_distance(a, b));
            }
        }
        let mut ends = motion.event.map(|e| e.ending) == rough.motion.event.map(|e| e.ending)
            || given_up && rough.motion.states.len() == motion.states.len();
        // One of the two runs may meet an end at the last time, and the other may just miss that end.
        let last = motion.times.last().or(rough.motion.times.last()).copied();
        if let (Some(event), None) | (None, Some(event)) = (motion.event, rough.motion.event)
            && let Some(late) = last.map(|t| (event.time - t).abs()).filter(|late| *late <= LATE)
        {
            (ends, off) = (true, off.max(late));
        }
        let fastest =
            self.path.phases.iter().fold(1.0, |most: f64, p| {
                most.max(p.state.fastest()).max(p.slip[0].abs()).max(p.slip[1].abs())
            });
        let rounding = 8.0 * f64::EPSILON * fastest;
        let motion = &mut self.motion;
        // Two runs with the same steps do not show the error that each step is allowed.
        let mut least =
            if self.path.slipping > 0.0 || motion.evaluations > 0 { rounding.max(tol) } else { rounding };
        // The error goes as the eighth power of the step: steps that are hardly longer have hardly larger errors.
        let ratio = rough.motion.evaluations as f64 / motion.evaluations.max(1) as f64;
        let alike = ratio > ALIKE.min(1.5 * (tol / rougher(tol)).powf(0.125));
        // The errors of the steps grow along the motion like those of the other run, which have grown to the difference
        // of both runs. Where that difference is small by chance, a part of the sum of the errors still remains.
        let grows = if rough.path.erred > 0.0 { (off / rough.path.erred).max(1.0) } else { 1.0 };
        least += self.path.erred * if alike { grows } else { CHANCE };
        least += alone;
        // Errors that have grown until the two runs part are no longer proportional to the tolerances.
        let parted = PARTED * fastest;
        let grown = |off: f64| off * (claimed * parted / (parted - off).max(0.0)).min(1.0);
        let settled = |claim: f64, off: f64| if ends { claim + grown(off) + least } else { f64::INFINITY };
        motion.error = settled(motion.error, off);
        // The forces were judged for state errors of one tolerance; the actual state errors are larger.
        let larger = (grown(off) + least) / tol;
        motion.force_error = settled(motion.force_error * larger.max(1.0), pressed);
        // The angles of a pose are known to a few roundings of their total turning.
        let turning = motion.poses.iter().flatten().last().map_or(0.0, S::turning);
        motion.pose_error = settled(motion.pose_error, turned) + 32.0 * f64::EPSILON * turning;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Phases that roll and slip by turns, beginning to roll.
    fn phases(times: &[f64]) -> Vec<Phase> {
        let state = State { theta: 1.0, w1: 0.0, w2: 0.0, w3: 0.0 };
        let kind = |i: usize| if i.is_multiple_of(2) { Kind::Rolling } else { Kind::Slipping };
        times
            .iter()
            .enumerate()
            .map(|(i, &time)| Phase { time, kind: kind(i), state, slip: [0.0; 2] })
            .collect()
    }

    #[test]
    fn a_brief_slip_of_one_run_sets_no_other_phase_against_a_wrong_one() {
        let ours = phases(&[0.0, 1.0, 2.0, 5.0, 5.001, 8.0, 9.0]);
        let theirs = phases(&[0.0, 1.01, 2.01, 8.01, 9.01]);
        for runs in [[&ours[..], &theirs[..]], [&theirs[..], &ours[..]]] {
            let (pairs, alone) = together(runs, 10.0, false);
            assert_eq!(pairs.len(), 5);
            assert!(pairs.iter().all(|[a, b]| a.kind == b.kind && (a.time - b.time).abs() < 0.02));
            assert!((alone - 0.001).abs() < 1e-12, "{alone}");
        }
        // What one run has at its end, and the other has not, is as long as it lasts; of whirrs that is left out.
        let (pairs, alone) = together([&ours[..5], &ours], 10.0, false);
        assert!(pairs.len() == 5 && alone == 2.0, "{} {alone}", pairs.len());
        assert_eq!(together([&ours[..5], &ours], 10.0, true).1, 0.0);
    }
}
