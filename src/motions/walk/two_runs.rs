//! Estimates the error of an integrated motion from a second run with a larger tolerance.
//!
//! The second run has a tolerance up to ten thousand times as large, and takes about a third of the time of the first.
//! The estimated error is the difference of the two runs, scaled by the ratio of the tolerances, times
//! [`Moving::SAFETY`].

use crate::error::{Error, copied, grow, room};
use crate::laws::state::{Slip, State};
use crate::motions::{AboveTable, Ending, Kind, Limit, Motion, Moving, Path, Phase};
use crate::numbers::larger_or_nan;

/// A motion and its path (phases, slips, heat and impacts), before the path becomes a part of the motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Followed<S: Moving = State> {
    pub motion: Motion<S>,
    pub path: Path<S>,
}

/// The second run, which shows the error, has this many times the tolerance of the first, at most the tolerance
/// `ROUGH`, but at least `BARELY` times that of the first.
const ROUGHER: f64 = 1e4;
const BARELY: f64 = 32.0;
const ROUGH: f64 = 1e-7;
/// If only one of the two runs ends before the last time, at most by this time, the estimated error is the difference
/// of the runs. If it ends earlier the runs disagree, and the error is infinite.
const END_DISTANCE: f64 = 1e-6;
/// Two phases of the two runs correspond to each other if their beginnings differ by less than this share of the
/// duration of the shorter phase.
const SAME_PHASE_SHARE: f64 = 0.3;
/// A second run that needs more than this share of the evaluations of the first has made almost the same steps, so
/// that the difference of the runs does not show the errors of these steps.
const ALIKE_EVALUATIONS: f64 = 0.66;
/// The estimated error is at least this share of the sum of all step errors, since two runs may agree by chance.
const LEAST_SHARE: f64 = 0.25;
/// The share of the step errors by which the second run of a motion with impacts is perturbed.
pub(crate) const CHANCE: f64 = 0.1;
/// A phase of a motion with impacts that is shorter than this is not compared between runs: it belongs to bounces, of
/// which another run with the same motion before and after may have one more or one less.
pub(crate) const BRIEF_PHASE: f64 = 1e-4;
/// The estimated error of a motion with impacts is multiplied by this factor: a flight in air has few steps, whose
/// errors are less proportional to the tolerance, and impacts multiply them.
const HOPPING_ERROR_FACTOR: f64 = 2.0;
/// The estimated error, in units of the difference of the two runs, if these do not have the same impacts.
const UNLIKE_ERROR_FACTOR: f64 = 3.0;
/// If the two runs differ by more than this share of the largest speed, the estimated error is their whole
/// difference.
const PARTED_SHARE: f64 = 0.3;

/// The tolerance of the second run, which shows the error of a path with the tolerance `tol`.
pub(crate) fn rougher(tol: f64) -> f64 {
    (ROUGHER * tol).min(ROUGH).max(BARELY * tol)
}

/// Computes a motion by `run` with the tolerance `fine`, and its error from a second run with a larger tolerance; the
/// error is infinite if a run is interrupted.
pub(crate) fn judged<S: Moving>(
    fine: f64,
    times: &[f64],
    mut run: impl FnMut(f64, &[f64]) -> Result<Followed<S>, Error>,
) -> Result<Followed<S>, Error> {
    let mut found = run(fine, times)?;
    if !found.motion.is_interrupted() {
        // If the computation stopped early, only its outputs and its state up to that time are compared.
        let early = found.motion.event.filter(|_| found.is_given_up()).map(|event| event.time);
        let until = early.map_or(times.len(), |_| found.motion.states.len());
        let mut times = copied(&times[..until])?;
        if let Some(time) = early {
            grow(&mut times, time)?;
        }
        let rough = run(rougher(fine), &times)?;
        if !rough.motion.is_interrupted() {
            found.judge(&rough, fine)?;
            return Ok(found);
        }
    }
    found.stays_unjudged();
    Ok(found)
}

impl<S: Moving> From<Followed<S>> for Motion<S> {
    fn from(found: Followed<S>) -> Self {
        Self { path: Some(Box::new(found.path)), ..found.motion }
    }
}

/// Pairs of phases of two runs of a motion that correspond to each other.
type PhasePairs<'a, S> = Vec<[&'a Phase<S>; 2]>;

/// The pairs of phases of two runs that correspond to each other, up to the time `end`, and the duration of the
/// longest phase that only one of the runs has. Phases are not paired by number, which would fail after a slip that
/// only one run has. With `whirrs` the last turns of a whirr are not computed, and one run may have computed more
/// turns than the other: its additional phases at the end do not count.
fn pairs_of_phases<S>(
    runs: [&[Phase<S>]; 2],
    end: f64,
    whirrs: bool,
) -> Result<(PhasePairs<'_, S>, f64), Error> {
    let (mut pairs, mut alone, mut at) = (room(runs[0].len().min(runs[1].len()))?, 0f64, [0; 2]);
    let lasts = |k: usize, i: usize| {
        let begin = runs[k][i].time;
        let next = runs[k].get(i + 1).map_or(if whirrs { begin } else { end }, |next| next.time);
        (next - begin).max(0.0)
    };
    while let (Some(a), Some(b)) = (runs[0].get(at[0]), runs[1].get(at[1])) {
        let long = [lasts(0, at[0]), lasts(1, at[1])];
        let last = !whirrs && at[0] + 1 == runs[0].len() && at[1] + 1 == runs[1].len();
        let near = (a.time - b.time).abs() <= SAME_PHASE_SHARE * long[0].min(long[1]);
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
        let kind = runs[k][at[k]].kind;
        let goes_on = kind != Kind::Flying && at[k] > 0 && runs[k][at[k] - 1].kind == kind;
        alone = alone.max(if goes_on { 0.0 } else { long[k] });
        let more = a.kind == b.kind && !goes_on && at[k] + 2 < runs[k].len();
        at[k] += if more { 2 } else { 1 };
    }
    for k in if whirrs { 0..0 } else { 0..2 } {
        alone = runs[k].get(at[k]).map_or(alone, |phase| alone.max(end - phase.time));
    }
    Ok((pairs, alone))
}

/// The phases of a motion with impacts, up to the time `end`, that last longer than `BRIEF_PHASE`.
fn phases_that_last<S: Copy>(phases: &[Phase<S>], end: f64) -> Result<Vec<Phase<S>>, Error> {
    let mut found = room(phases.len())?;
    let next = phases.iter().skip(1).map(|phase| phase.time).chain([end]);
    let long = phases.iter().zip(next).filter(|(phase, next)| next - phase.time > BRIEF_PHASE);
    found.extend(long.map(|(phase, _)| *phase));
    Ok(found)
}

/// Whether a phase follows one shorter than `BRIEF_PHASE`, so that the number of bounces decides when it begins.
fn follows_bounces<S>(phases: &[Phase<S>], phase: &Phase<S>) -> bool {
    let before = phases.partition_point(|other| other.time < phase.time).checked_sub(1);
    before.is_some_and(|i| phase.time - phases[i].time <= BRIEF_PHASE)
}

impl Followed {
    /// The state, the slip and the index of the rim that touches the table, at the last time or at the end of the
    /// motion.
    pub(crate) fn last(&self) -> Option<(State, Slip, u8)> {
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

    /// Marks a motion that no second run checks, because the computation was interrupted: its error is infinite.
    pub(crate) fn stays_unjudged(&mut self) {
        self.motion.limit = Some(Limit::Interrupted);
        self.motion.make_error_infinite();
    }

    /// Estimates the errors of this motion from its difference from the run `rough` with a larger tolerance. Returns
    /// an error if the memory does not suffice to compare their phases.
    pub(crate) fn judge(&mut self, rough: &Self, tol: f64) -> Result<(), Error> {
        let claimed = (S::SAFETY * tol / rougher(tol)).min(1.0);
        let given_up = self.is_given_up();
        let motion = &mut self.motion;
        let (mut off, mut turned, mut pressed) = (0f64, 0f64, 0f64);
        let mut apart = |by: f64| off = larger_or_nan(off, by);
        // After impacts of both rims one run may see the body from one rim, and the other run from the other rim.
        let hops = !self.path.impacts.is_empty();
        let told = self.path.view.circles.is_some();
        let distance = |a: &S, b: &S, u: &Slip, v: &Slip| {
            let slips = [u.u_h - v.u_h, u.u_2 - v.u_2].map(f64::abs);
            let direct = slips.into_iter().fold(a.distance(b), larger_or_nan);
            let there = if told { Some(*b) } else { b.seen_from_other_rim() };
            there.filter(|_| hops).map_or(direct, |b| {
                let along = if told { u.u_h - v.u_h } else { u.u_h + v.u_h };
                let over = larger_or_nan(a.distance(&b), along.abs());
                if over < direct { over } else { direct }
            })
        };
        let runs =
            [(motion.states.iter().zip(&self.path.slip)), rough.motion.states.iter().zip(&rough.path.slip)];
        let [ours, theirs] = runs;
        for ((a, u), (b, v)) in ours.zip(theirs) {
            apart(distance(a, b, u, v));
        }
        let whirrs = self.path.leaves_turns || rough.path.leaves_turns || given_up;
        let end = [&*motion, &rough.motion].map(|m| m.event.map(|e| e.time).or(m.times.last().copied()));
        let end = end.into_iter().flatten().fold(0.0, f64::max);
        let all = [&self.path.phases[..], &rough.path.phases];
        let lasts =
            if hops { Some([phases_that_last(all[0], end)?, phases_that_last(all[1], end)?]) } else { None };
        let phases = lasts.as_ref().map_or(all, |[a, b]| [a, b]);
        let (pairs, alone) = pairs_of_phases(phases, end, whirrs)?;
        // Once two runs do not hop alike, their difference is no longer proportional to the tolerances.
        let unlike = hops && alone > 0.0;
        let alone = if hops { 0.0 } else { alone };
        for [a, b] in pairs {
            if unlike
                || hops && follows_bounces(&self.path.phases, a)
                || hops && follows_bounces(&rough.path.phases, b)
            {
                continue;
            }
            apart((a.time - b.time).abs());
            apart(distance(&a.state, &b.state, &a.slip, &b.slip));
        }
        let reached = rough.motion.states.get(motion.states.len());
        if let Some(((state, event), _)) = reached.zip(motion.event).zip(given_up.then_some(())) {
            apart(event.state.distance(state));
        }
        if let (Some(a), Some(b)) = (motion.event, rough.motion.event)
            && !given_up
        {
            apart((a.time - b.time).abs());
            apart(distance(&a.state, &b.state, &Slip::default(), &Slip::default()));
        }
        if let (Some(poses), Some(others)) = (&motion.poses, &rough.motion.poses) {
            for (i, (a, b)) in poses.iter().zip(others).enumerate() {
                let rims = [&self.path.rims, &rough.path.rims].map(|of| of.get(i).copied());
                let [over, there] = rims.map(|rim| rim == Some(1));
                let apart = match (over, there) {
                    _ if told && rims[0] != rims[1] => S::pose_distance_apart(a, b),
                    _ if told => S::pose_distance(a, b),
                    (true, false) => S::pose_distance_over(a, b),
                    (false, true) => S::pose_distance_over(b, a),
                    _ => S::pose_distance(a, b),
                };
                turned = larger_or_nan(turned, apart);
            }
        }
        if let (Some(forces), Some(others)) = (&motion.forces, &rough.motion.forces) {
            for (a, b) in forces.iter().zip(others) {
                pressed = larger_or_nan(pressed, S::force_distance(a, b));
            }
        }
        let mut ends = motion.event.map(|e| e.ending) == rough.motion.event.map(|e| e.ending)
            || given_up && rough.motion.states.len() >= motion.states.len();
        // One of the two runs may meet an end at the last time, and the other may just miss that end.
        let last = motion.times.last().or(rough.motion.times.last()).copied();
        if let (Some(event), None) | (None, Some(event)) = (motion.event, rough.motion.event)
            && let Some(late) = last.map(|t| (event.time - t).abs()).filter(|late| *late <= END_DISTANCE)
        {
            (ends, off) = (true, larger_or_nan(off, late));
        }
        let fastest = self.path.phases.iter().fold(1.0, |most: f64, p| {
            most.max(p.state.fastest()).max(p.slip.u_h.abs()).max(p.slip.u_2.abs())
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
        let alike = ratio > ALIKE_EVALUATIONS.min(1.5 * (tol / rougher(tol)).powf(0.125));
        // Step errors grow along the motion, by the same factor in both runs: in the rougher run from their sum to the
        // difference of the runs. Steps that are not alike show their errors in that difference; as it may be small by
        // chance, the estimated error also includes a share of their sum. Where impacts multiply the errors of both runs, it
        // includes that share as grown as it is in the rougher run, which is perturbed by it.
        let grows = if rough.path.erred > 0.0 { (off / rough.path.erred).max(1.0) } else { 1.0 };
        least += self.path.erred * if alike || hops { grows } else { LEAST_SHARE };
        least += alone;
        // Errors that have grown until the two runs part are no longer proportional to the tolerances.
        let parted = PARTED_SHARE * fastest;
        let claimed = if unlike {
            UNLIKE_ERROR_FACTOR
        } else if hops {
            HOPPING_ERROR_FACTOR * claimed
        } else {
            claimed
        };
        let grown_to =
            |off: f64, parted: f64| off * (claimed * parted / (parted - off).max(0.0)).min(claimed.max(1.0));
        let grown = |off: f64| grown_to(off, parted);
        let settled = |claim: f64, off: f64| if ends { claim + off + least } else { f64::INFINITY };
        let state_claim = motion.error;
        motion.error = settled(state_claim, grown(off));
        // An error that cannot be computed counts as infinite.
        motion.error = if motion.error.is_nan() { f64::INFINITY } else { motion.error };
        // The errors of the forces were computed for states with errors of one tolerance; the states have
        // larger errors.
        let larger = (grown(off) + least) / tol;
        motion.force_error = settled(motion.force_error * larger_or_nan(1.0, larger), grown(pressed));
        // Rounding errors of the angles of a pose are proportional to these angles.
        let turning = motion.poses.iter().flatten().last().map_or(0.0, S::turning);
        // After an impact the errors of its time and of its sum are also those of the pose.
        let state_claim = if hops { state_claim } else { 0.0 };
        // Angles have parted where they differ by a share of a radian, as where two balls pass on two sides of their poles.
        let turned = grown_to(turned, PARTED_SHARE);
        motion.pose_error = settled(motion.pose_error + state_claim, turned) + 32.0 * f64::EPSILON * turning;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Phases that begin at these times and alternately roll and slip; the first one rolls.
    fn phases(times: &[f64]) -> Vec<Phase> {
        let state = State { theta: 1.0, w1: 0.0, w2: 0.0, w3: 0.0 };
        let kind = |i: usize| if i.is_multiple_of(2) { Kind::Rolling } else { Kind::Slipping };
        times
            .iter()
            .enumerate()
            .map(|(i, &time)| Phase {
                time,
                kind: kind(i),
                state,
                slip: Slip::default(),
                aloft: AboveTable::default(),
                rim: 0,
            })
            .collect()
    }

    #[test]
    fn a_brief_slip_of_one_run_sets_no_other_phase_against_a_wrong_one() {
        let ours = phases(&[0.0, 1.0, 2.0, 5.0, 5.001, 8.0, 9.0]);
        let theirs = phases(&[0.0, 1.01, 2.01, 8.01, 9.01]);
        for runs in [[&ours[..], &theirs[..]], [&theirs[..], &ours[..]]] {
            let (pairs, alone) = pairs_of_phases(runs, 10.0, false).unwrap();
            assert_eq!(pairs.len(), 5);
            assert!(pairs.iter().all(|[a, b]| a.kind == b.kind && (a.time - b.time).abs() < 0.02));
            assert!((alone - 0.001).abs() < 1e-12, "{alone}");
        }
        // Phases at the end that only one run has count with their length; for whirrs they do not count.
        let (pairs, alone) = pairs_of_phases([&ours[..5], &ours], 10.0, false).unwrap();
        assert!(pairs.len() == 5 && alone == 2.0, "{} {alone}", pairs.len());
        assert_eq!(pairs_of_phases([&ours[..5], &ours], 10.0, true).unwrap().1, 0.0);
    }

    #[test]
    fn the_number_of_brief_bounces_has_no_meaning_and_a_long_flight_of_one_run_has() {
        let flights = |times: &[f64]| -> Vec<Phase> {
            phases(times).into_iter().map(|phase| Phase { kind: Kind::Flying, ..phase }).collect()
        };
        let ours = phases_that_last(&flights(&[0.0, 1.0, 1.00001, 1.00002, 1.00003]), 2.0).unwrap();
        let theirs = phases_that_last(&flights(&[0.0, 1.0, 1.00001, 1.00002]), 2.0).unwrap();
        assert_eq!([ours.len(), theirs.len()], [2, 2]);
        assert_eq!(pairs_of_phases([&ours, &theirs], 2.0, false).unwrap().1, 0.0);
        assert!(!follows_bounces(&flights(&[0.0, 1.0, 1.5]), &ours[0]));
        assert!(follows_bounces(&flights(&[0.0, 1.0, 1.00001, 1.00002, 1.00003]), &ours[1]));
        let parted = phases_that_last(&flights(&[0.0, 0.4, 1.2, 1.6]), 2.0).unwrap();
        assert!(pairs_of_phases([&ours, &parted], 2.0, false).unwrap().1 > 0.1);
    }
}
