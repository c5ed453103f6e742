//! The time up to which the motion of a stone is known, and whether its ends are certain.
//!
//! ```text
//! known     while the estimated error is at most 1 % of the largest speed, or 0.01 for slow motions; if
//!           reversals of the spin are counted, also at most the spin that completes a reversal
//! room      |margin|/sum |d margin/dy_i|: change of each number of the state that can bring a margin to zero
//! certain   an end, or a minimum of a margin close to zero, whose room is at least four estimated errors
//! ```
//! The energy is the only first integral of a stone, and errors grow like any disturbance: a rattleback
//! forgets its initial state within a minute. If the estimated error of the whole motion is too large, the motion
//! is computed again with the same steps and more outputs, and the error is estimated up to each output.

use super::turns::Reversals;
use crate::error::Error;
use crate::laws::stone::StoneState;
use crate::motions::Moving;
use crate::motions::walk::two_runs::Followed;

/// Largest error with which the state of a stone counts as known, as a share of the largest speed.
const KNOWN: f64 = 0.01;
/// The end of a phase, or a minimum of a margin, is certain if no change of the state by this many estimated errors
/// can undo it; more than one, because the error is only an estimate.
const SURELY: f64 = 4.0;
/// Number of additional outputs in the search for the time up to which a motion is known; fewer would give a coarser
/// time.
const MARKS: usize = 128;

/// Reversals of the spin and ends of phases that the run with the smaller tolerance records.
#[derive(Debug, Clone, Default)]
pub(crate) struct Recorded {
    /// The reversals of the spin, if they are counted.
    pub turns: Option<Reversals>,
    /// The time of each end and of each minimum of a margin near zero, and the distance of the margin from zero there.
    pub grazes: Vec<[f64; 2]>,
}

/// The two runs of a motion, with the requested and with a larger tolerance, and the same outputs.
type TwoRuns = [Followed<StoneState>; 2];
/// The two runs of a motion; None if they are interrupted.
pub(crate) type Runs = Result<Option<TwoRuns>, Error>;

/// Computes the time up to which a motion with an estimated error is known. `again` computes the motion with
/// other outputs. Returns false if `again` is interrupted.
pub(crate) fn settle(
    found: &mut Followed<StoneState>,
    recorded: &mut Recorded,
    (t0, last, tol): (f64, f64, f64),
    again: &mut dyn FnMut(&[f64]) -> Runs,
) -> Result<bool, Error> {
    let error = found.motion.error;
    let phases = found.path.phases.iter();
    let level = KNOWN * phases.fold(1.0, |most: f64, phase| most.max(phase.state.fastest()));
    let level = recorded.turns.as_ref().map_or(level, |turns| level.min(turns.enough));
    let narrow = recorded.grazes.iter().any(|[_, room]| *room < SURELY * error);
    if !narrow && error <= level {
        return Ok(true);
    }
    let end = found.motion.event.map_or(last, |event| event.time);
    let mut marks: Vec<f64> = (1..=MARKS).map(|k| t0 + (end - t0) * (k as f64 / MARKS as f64)).collect();
    marks.extend(recorded.grazes.iter().map(|[t, _]| t0 + t).filter(|t| *t < last));
    marks.push(last);
    marks.sort_by(f64::total_cmp);
    marks.dedup();
    let Some(runs) = again(&marks)? else { return Ok(false) };
    let reached = runs[0].motion.times.len().min(runs[1].motion.times.len());
    let claim = |count: usize| claimed(&runs, count, tol);
    // The time up to which the error stays below the level.
    let until = || {
        let (mut known, mut beyond) = (0, reached + 1);
        while known + 1 < beyond {
            let middle = usize::midpoint(known, beyond);
            if claim(middle)? <= level {
                known = middle;
            } else {
                beyond = middle;
            }
        }
        Ok::<_, Error>(if known == 0 { t0 } else { marks[known - 1] })
    };
    // The output at the end itself is left out, since the rougher run may have ended a little earlier.
    let mut sure = f64::INFINITY;
    for [t, room] in &recorded.grazes {
        let count = marks.partition_point(|mark| *mark < t0 + t);
        if *room < SURELY * error && (count > reached || SURELY * claim(count)? > *room) {
            (found.motion.error, sure) = (f64::INFINITY, t0 + t);
            break;
        }
    }
    let known = if error <= level { f64::INFINITY } else { until()? }.min(sure);
    found.path.known_until = known;
    if let Some(turns) = &mut recorded.turns {
        turns.times.retain(|[_, t]| t0 + t <= known);
    }
    Ok(true)
}

/// The estimated error of a motion up to the last of its first `count` times.
fn claimed(runs: &TwoRuns, count: usize, tol: f64) -> Result<f64, Error> {
    if count == 0 {
        return Ok(0.0);
    }
    let cut = |of: &Followed<StoneState>| {
        let Followed { mut motion, mut path } = of.clone();
        motion.times.truncate(count);
        motion.states.truncate(count);
        (motion.poses, motion.forces, motion.event, motion.error) = (None, None, None, 0.0);
        path.slip.truncate(count);
        path.phases.retain(|phase| motion.times.last().is_some_and(|until| phase.time <= *until));
        Followed { motion, path }
    };
    let mut fine = cut(&runs[0]);
    fine.judge(&cut(&runs[1]), tol)?;
    Ok(fine.motion.error)
}
