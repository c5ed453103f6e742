//! Until when the motion of a stone is known, and which of its ends are sure.
//!
//! ```text
//! known    as long as the claimed error is at most 1 % of the largest speed, or 0.01 of slow motions
//! sure     an end, or a passage beside one, whose margin is further from zero than four errors of the state can move it:
//!          |margin|/sum |d margin/dy_i| is its room, in numbers of the state
//! counts   where reversals of the spin are counted, also at most the spin that counts as turned back, so that the
//!          direction of such a spin is known
//! ```
//! A stone has no first integrals but its energy, and errors grow like any disturbance of it: a rattleback forgets its start
//! within a minute. Where the claim of the whole motion does not answer these questions, the motion is followed again to
//! times in between, by the same steps, and judged up to each of them.

use super::turns::Reversals;
use crate::error::Error;
use crate::laws::stone::StoneState;
use crate::motions::Moving;
use crate::motions::followed::Followed;

/// Largest error of a state that is known, as a share of the largest speed.
const KNOWN: f64 = 0.01;
/// A passage is sure if its room is this many times the claimed error, which is an estimate.
const SURELY: f64 = 4.0;
/// Number of times in between.
const MARKS: usize = 128;

/// What is noted of a motion along its way.
#[derive(Debug, Clone, Default)]
pub(crate) struct Noted {
    /// The reversals of the spin, if they are counted.
    pub turns: Option<Reversals>,
    /// The times of the ends, and of passages beside an end, and the room of each.
    pub grazes: Vec<[f64; 2]>,
}

/// Two runs of a motion to some times, the fine one and the rough one.
type TwoRuns = [Followed<StoneState>; 2];
/// Two runs; none if they are interrupted.
pub(crate) type Runs = Result<Option<TwoRuns>, Error>;

/// Finds until when a motion is known, whose error is already claimed. `again` follows it to other times; if it is
/// interrupted, the result is false.
pub(crate) fn settle(
    found: &mut Followed<StoneState>,
    noted: &mut Noted,
    (t0, last, tol): (f64, f64, f64),
    again: &mut dyn FnMut(&[f64]) -> Runs,
) -> Result<bool, Error> {
    let error = found.motion.error;
    let phases = found.path.phases.iter();
    let level = KNOWN * phases.fold(1.0, |most: f64, phase| most.max(phase.state.fastest()));
    let level = noted.turns.as_ref().map_or(level, |turns| level.min(turns.enough));
    let narrow = noted.grazes.iter().any(|[_, room]| *room < SURELY * error);
    if !narrow && error <= level {
        return Ok(true);
    }
    let end = found.motion.event.map_or(last, |event| event.time);
    let mut marks: Vec<f64> = (1..=MARKS).map(|k| t0 + (end - t0) * (k as f64 / MARKS as f64)).collect();
    marks.extend(noted.grazes.iter().map(|[t, _]| t0 + t).filter(|t| *t < last));
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
            if claim(middle) <= level {
                known = middle;
            } else {
                beyond = middle;
            }
        }
        if known == 0 { t0 } else { marks[known - 1] }
    };
    // The rougher run may have ended at the same passage, a little earlier.
    let unsure = noted.grazes.iter().find(|[t, room]| {
        let count = marks.partition_point(|mark| *mark < t0 + t);
        *room < SURELY * error && (count > reached || SURELY * claim(count) > *room)
    });
    if unsure.is_some() {
        found.motion.error = f64::INFINITY;
    }
    let sure = unsure.map_or(f64::INFINITY, |[t, _]| t0 + t);
    let known = if error <= level { f64::INFINITY } else { until() }.min(sure);
    found.path.known_until = known;
    if let Some(turns) = &mut noted.turns {
        turns.times.retain(|[_, t]| t0 + t <= known);
    }
    Ok(true)
}

/// The error that is claimed of a motion up to its first `count` times.
fn claimed(runs: &TwoRuns, count: usize, tol: f64) -> f64 {
    if count == 0 {
        return 0.0;
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
    fine.judge(&cut(&runs[1]), tol);
    fine.motion.error
}
