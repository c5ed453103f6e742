//! A motion through phases, and its error from a second run with a larger tolerance.
//!
//! The second run has a tolerance up to ten thousand times as large, and takes about a third of the time of the first.
//! The estimated error is the difference of the two runs, scaled by the ratio of the tolerances, times
//! [`Moving::SAFETY`].

use super::{Ending, Motion, Moving, Path, Phase};
use crate::error::Error;
use crate::laws::state::State;

/// A motion and its path, before the path becomes a part of the motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Followed<S: Moving = State> {
    pub motion: Motion<S>,
    pub path: Path<S>,
}

/// The second run has `ROUGHER` times the tolerance of the first, at most `ROUGH`, but at least `BARELY`
/// times as much.
const ROUGHER: f64 = 1e4;
const BARELY: f64 = 32.0;
const ROUGH: f64 = 1e-7;
/// Where only one of the two runs has an end, this end may be this far from the last time, and the estimated error is
/// the difference. If the end is farther away the runs disagree, and the error is infinite.
const LATE: f64 = 1e-6;
/// Two phases of the two runs correspond to each other if the times of their beginnings differ by less than
/// this share of the length of the shorter one.
const TOGETHER: f64 = 0.3;
/// A second run with more than this share of the evaluations of the first has made almost the same steps, so
/// that the difference of the runs hides the errors of these steps.
const ALIKE: f64 = 0.7;
/// The estimated error is at least this share of the sum of all step errors, since two runs may agree by chance.
const CHANCE: f64 = 0.1;
/// Runs that differ by this share of the largest speed have parted, and the error is their whole difference.
const PARTED: f64 = 0.3;

/// The tolerance of the second run, which shows the error of a path with the tolerance `tol`.
pub(crate) fn rougher(tol: f64) -> f64 {
    (ROUGHER * tol).min(ROUGH).max(BARELY * tol)
}

/// The motion of a `run` with the tolerance `fine`, with its error from a rougher run; None if a run
/// is interrupted.
pub(crate) fn judged<S: Moving>(
    fine: f64,
    times: &[f64],
    mut run: impl FnMut(f64, &[f64]) -> Result<Option<Followed<S>>, Error>,
) -> Result<Option<Followed<S>>, Error> {
    let Some(mut found) = run(fine, times)? else { return Ok(None) };
    // If the computation stopped early, only its outputs up to that time are compared.
    let judged = if found.is_given_up() { found.motion.states.len() } else { times.len() };
    let Some(rough) = run(rougher(fine), &times[..judged])? else { return Ok(None) };
    found.judge(&rough, fine);
    Ok(Some(found))
}

impl<S: Moving> From<Followed<S>> for Motion<S> {
    fn from(found: Followed<S>) -> Self {
        Self { path: Some(Box::new(found.path)), ..found.motion }
    }
}

/// The pairs of phases of two runs that correspond to each other, up to the time `end`, and the length of the
/// longest phase that only one of the runs has. Pairs by number would all be wrong after a slip that only one
/// run has. `whirrs`: the last turns of a whirr are left out, one run may have computed more turns than the
/// other, and its additional phases at the end do not count.
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
        // Of two kinds the phase that ends first has no partner. Of the same kind it is the earlier phase, and the one
        // after it, unless it is the last, has none either. A slip that only continues in another direction belongs to the slip before it.
        let k = usize::from(if a.kind == b.kind {
            b.time < a.time || b.time == a.time && long[1] < long[0]
        } else {
            b.time + long[1] < a.time + long[0]
        });
        let goes_on = at[k] > 0 && runs[k][at[k] - 1].kind == runs[k][at[k]].kind;
        alone = alone.max(if goes_on { 0.0 } else { long[k] });
        let more = a.kind == b.kind && !goes_on && at[k] + 2 < runs[k].len();
        at[k] += if more { 2 } else { 1 };
    }
    for k in if whirrs { 0..0 } else { 0..2 } {
        alone = runs[k].get(at[k]).map_or(alone, |phase| alone.max(end - phase.time));
    }
    (pairs, alone)
}

impl Followed {
    /// State, slip and rim at the last time, or at the end of the motion.
    pub(crate) fn last(&self) -> Option<(State, [f64; 2], u8)> {
        match self.motion.event {
            Some(event) => Some((event.state, self.path.last_slip, event.rim)),
            None if self.path.rolls_on => {
                self.path.phases.last().map(|phase| (phase.state, phase.slip, phase.rim))
            }
            None => {
                let rim = self.path.rims.last().copied().unwrap_or_default();
                Some((*self.motion.states.last()?, *self.path.slip.last()?, rim))
            }
        }
    }

    /// The time at which the motion ended, if it ended before the last time.
    pub(crate) fn ended(&self) -> Option<f64> {
        let rolling = self.path.phases.last().filter(|_| self.path.rolls_on).map(|phase| phase.time);
        self.motion.event.map(|e| e.time).or(rolling)
    }
}

impl<S: Moving> Followed<S> {
    /// Whether the computation stopped before the last time of the motion.
    pub(super) fn is_given_up(&self) -> bool {
        self.motion.event.is_some_and(|event| event.ending == Ending::Bounded)
    }

    /// Estimates the errors of this motion from its difference from a rougher run.
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
        // Two runs with the same steps do not show the error of these steps, so that the estimated error is at least
        // one tolerance.
        let mut least =
            if self.path.slipping > 0.0 || motion.evaluations > 0 { rounding.max(tol) } else { rounding };
        // The error of a step grows as the eighth power of its length: hardly longer steps have hardly
        // larger errors.
        let ratio = rough.motion.evaluations as f64 / motion.evaluations.max(1) as f64;
        let alike = ratio > ALIKE.min(1.5 * (tol / rougher(tol)).powf(0.125));
        // Step errors grow along the motion, by the same factor in both runs: in the rougher run from their sum to the
        // difference of the runs. Steps that are not alike show their errors in that difference; as it may be small by
        // chance, the estimated error also includes a share of their sum.
        let grows = if rough.path.erred > 0.0 { (off / rough.path.erred).max(1.0) } else { 1.0 };
        least += self.path.erred * if alike { grows } else { CHANCE };
        least += alone;
        // Errors that have grown until the two runs part are no longer proportional to the tolerances.
        let parted = PARTED * fastest;
        let grown = |off: f64| off * (claimed * parted / (parted - off).max(0.0)).min(1.0);
        let settled = |claim: f64, off: f64| if ends { claim + grown(off) + least } else { f64::INFINITY };
        motion.error = settled(motion.error, off);
        // The errors of the forces were computed for states with errors of one tolerance; the states have
        // larger errors.
        let larger = (grown(off) + least) / tol;
        motion.force_error = settled(motion.force_error * larger.max(1.0), pressed);
        // Rounding errors of the angles of a pose are proportional to these angles.
        let turning = motion.poses.iter().flatten().last().map_or(0.0, S::turning);
        motion.pose_error = settled(motion.pose_error, turned) + 32.0 * f64::EPSILON * turning;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motions::Kind;

    /// Phases that alternately roll and slip; the first one rolls.
    fn phases(times: &[f64]) -> Vec<Phase> {
        let state = State { theta: 1.0, w1: 0.0, w2: 0.0, w3: 0.0 };
        let kind = |i: usize| if i.is_multiple_of(2) { Kind::Rolling } else { Kind::Slipping };
        times
            .iter()
            .enumerate()
            .map(|(i, &time)| Phase { time, kind: kind(i), state, slip: [0.0; 2], aloft: [0.0; 2], rim: 0 })
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
        // Phases at the end that only one run has count with their length; for whirrs they do not count.
        let (pairs, alone) = together([&ours[..5], &ours], 10.0, false);
        assert!(pairs.len() == 5 && alone == 2.0, "{} {alone}", pairs.len());
        assert_eq!(together([&ours[..5], &ours], 10.0, true).1, 0.0);
    }
}
