//! A motion by RK4 with a fixed step, and its error from the exact motion or a more accurate run.

use super::guard::guard;
use super::steps;
use crate::error::Error;
use crate::motions::exact::Swing;
use crate::motions::exact::course::Course;
use crate::motions::exact::event::Limits;
use crate::motions::exact::tolerance::{ExactEnd, within};
use crate::motions::walk::errors::{compare, judge};
use crate::motions::{Ask, Motion};
use crate::numbers::larger_or_nan;

/// Tolerance of the run with which a fixed step is compared where no exact solution is accurate enough. The error of
/// that run is added to the estimated error.
const COMPARISON_TOLERANCE: f64 = 1e-12;

/// Computes a motion by RK4 steps of length `step`, up to the end of a more accurate solution: `swing`, the exact
/// one, or if there is none a run with a small tolerance. Returns an error if the step is too long to reach that end.
pub(crate) fn stepped(
    course: &Course<'_>,
    swing: Option<&Swing>,
    limits: &Limits,
    ask: &Ask,
    step: f64,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Motion, Error> {
    let guarded = guard(course, swing, limits, step)?;
    let known = ExactEnd::of(course, swing, limits, ask.beyond);
    let reference = match known.swing {
        Some(_) => None,
        None => Some(within(
            course,
            swing,
            limits,
            &Ask { max_evaluations: None, ..*ask },
            COMPARISON_TOLERANCE,
            go_on,
        )?),
    };
    if let Some(reference) = reference.as_ref().filter(|reference| reference.is_interrupted()) {
        return Ok(Motion::empty(0, ask.pose)?.interrupted(&reference.times[..0], course.t0, *course.start));
    }
    let event = reference.as_ref().map_or(known.event, |reference| reference.event);
    let count = reference.as_ref().map_or(known.count, |reference| reference.times.len());
    let by_itself = (step, swing.is_none());
    let most = ask.max_evaluations.unwrap_or(u64::MAX);
    let mut motion = steps::run(course, limits, by_itself, (count, most), go_on)?;
    let event = if motion.limit.is_none() { event } else { motion.event };
    motion.event = event;
    if let Some(swing) = known.swing {
        judge(&mut motion, swing, event, course.t0);
        motion.error = larger_or_nan(motion.error, known.doubt);
    }
    if let Some(reference) = reference {
        compare(&mut motion, &reference);
        motion.error += reference.error;
        motion.pose_error += reference.pose_error;
    }
    (motion.step_loss, motion.advice, motion.coarse) = (guarded.loss, guarded.advice, guarded.coarse);
    Ok(motion)
}
