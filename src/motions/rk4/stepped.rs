//! Motions by an integrator, judged by the exact solution, or by a rougher run where no exact solution exists.
//!
//! In a nearly flat passage, steps with errors of 1e-6 may find a lift-off that the motion does not have, and steps a
//! hundred times as good may find the same lift-off again. So an end is accepted if the exact solution has it, where
//! that solution is accurate enough; elsewhere an end is accepted if a run within a smaller tolerance has it too.

use super::course::{self, Course, Stepping};
use crate::error::Error;
use crate::laws::body::Body;
use crate::motions::exact::Swing;
use crate::motions::judge::{compare, judge, same};
use crate::motions::limits::{self, Limits};
use crate::motions::{Ask, Ending, Event, Motion};
use crate::states::stability::stiffness;

/// Largest error of an exact solution that may judge the error of an integrator.
const JUDGES: f64 = 1e-3;
/// Largest error of an exact solution that may decide how the motion ends.
const DECIDES: f64 = 1e-6;
/// Smallest tolerance of the runs that test an end which the exact solution cannot judge.
const TIGHTEST: f64 = 1e-13;

/// A motion by steps: its options, and its exact solution as a judge.
struct Stepped<'a> {
    course: &'a Course<'a>,
    limits: &'a Limits,
    ask: &'a Ask,
    /// The exact solution and its end, if the solution is accurate enough to judge.
    exact: Option<&'a Swing>,
    event: Option<Event>,
}

impl Stepped<'_> {
    fn run(
        &self,
        stepping: Stepping,
        beyond: bool,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Motion>, Error> {
        course::run(self.course, self.limits, stepping, beyond, go_on)
    }

    /// Whether a run and the exact solution have the same end, or both have none.
    fn agrees(&self, event: Option<Event>) -> bool {
        match (event, self.event) {
            (Some(a), Some(b)) => same(&a, &b),
            (a, b) => a.is_none() && b.is_none(),
        }
    }

    /// Whether the exact solution is accurate enough up to this end, or to its own earlier end, to decide.
    fn is_sure(&self, made: &Event) -> bool {
        let since = |event: &Event| event.time - self.course.t0;
        let own = self.event.as_ref().map(since).filter(|own| own.abs() < since(made).abs());
        self.exact.is_some_and(|swing| swing.error(own.unwrap_or(since(made))) <= DECIDES)
    }

    /// Gives the motion the end of the exact solution, in place of the end that the steps have found.
    fn ended(&self, motion: &mut Motion) {
        motion.event = self.event;
        if let Some(event) = self.event.filter(|e| !self.ask.beyond || e.ending == Ending::Face) {
            motion.keep(self.course.t0, (event.time - self.course.t0).abs());
        }
    }

    /// The motion by these steps. An end that the exact solution does not have is an error of the steps, which then go
    /// on beyond that end. Where the steps cannot go on, as the face has landed, or where no exact solution is accurate
    /// enough, an end counts only if a smaller tolerance confirms it; a fixed step that makes the face land is refused.
    fn motion(&self, stepping: Stepping, go_on: &mut dyn FnMut() -> bool) -> Result<Option<Motion>, Error> {
        let Some(mut motion) = self.run(stepping, self.ask.beyond, go_on)? else { return Ok(None) };
        let Some(made) = motion.event.filter(|made| !self.agrees(Some(*made))) else {
            return Ok(Some(motion));
        };
        let sure = self.is_sure(&made);
        if sure {
            let Some(mut on) = self.run(stepping, true, go_on)? else { return Ok(None) };
            let reached = on.times.len();
            self.ended(&mut on);
            let Course { times, t0, .. } = *self.course;
            let end = self.event.map_or(f64::INFINITY, |e| (e.time - t0).abs());
            if reached >= times.partition_point(|t| (t - t0).abs() <= end) {
                return Ok(Some(on));
            }
            if let (Stepping::Fixed(step), Some(swing)) = (stepping, self.exact)
                && self.event.is_none_or(|e| e.ending != Ending::Face)
            {
                let (theta, step) = (swing.state(made.time - t0).theta, step.abs());
                return Err(Error::Step { step, time: made.time, theta, advice: 0.1 * step });
            }
        }
        let Stepping::Within(mut tol) = stepping else { return Ok(Some(motion)) };
        while tol > TIGHTEST && motion.event.is_some() {
            tol = (0.01 * tol).max(TIGHTEST);
            let Some(tighter) = self.run(Stepping::Within(tol), self.ask.beyond, go_on)? else {
                return Ok(None);
            };
            let stands = if sure {
                self.agrees(tighter.event)
            } else {
                motion.event.zip(tighter.event).is_some_and(|(a, b)| same(&a, &b))
            };
            if stands && !sure {
                break;
            }
            motion = Motion { method: motion.method, ..tighter };
            if stands {
                break;
            }
        }
        Ok(Some(motion))
    }
}

/// The motion by an integrator, with its errors; `swing` is the exact solution, if it exists.
pub(crate) fn stepped(
    body: &Body,
    course: &Course<'_>,
    swing: Option<&Swing>,
    limits: &Limits,
    stepping: Stepping,
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    let &Course { start, span, t0, .. } = course;
    let way = if span < 0.0 { -1.0 } else { 1.0 };
    let found = swing.and_then(|swing| limits::first_event(swing, limits, way));
    let found = found.filter(|e| e.time.abs() <= span.abs());
    // Nothing is judged beyond an end.
    let ended = found.filter(|e| !ask.beyond || e.ending == Ending::Face);
    let last = ended.map_or(span, |e| e.time);
    let judge_by = swing.filter(|s| s.error(last) <= JUDGES);
    let found = found.filter(|_| judge_by.is_some());
    let doubt = found.zip(judge_by).map_or(0.0, |(e, swing)| limits.doubt(&e) + swing.time_error(e.time));
    let event = found.map(|e| Event { time: t0 + e.time, ..e });
    let by_steps = Stepped { course, limits, ask, exact: judge_by, event };
    let Some(mut motion) = by_steps.motion(stepping, go_on)? else { return Ok(None) };
    if let Some(swing) = judge_by {
        // A coarse integrator can miss an end that the motion has.
        if motion.event.is_none() {
            by_steps.ended(&mut motion);
        }
        judge(&mut motion, swing, event, t0);
        motion.error = motion.error.max(if motion.event.is_some() { doubt } else { 0.0 });
    } else {
        let rough = match stepping {
            Stepping::Fixed(step) => Stepping::Fixed(2.0 * step),
            Stepping::Within(tol) => Stepping::Within(32.0 * tol),
        };
        match by_steps.run(rough, ask.beyond, go_on) {
            Ok(Some(other)) => compare(&mut motion, &other),
            Ok(None) => return Ok(None),
            Err(e @ Error::Memory { .. }) => return Err(e),
            Err(_) => motion.error = f64::INFINITY,
        }
        // The difference of two runs that both have rounding errors is too small an estimate.
        if let Stepping::Within(_) = stepping {
            motion.error *= 4.0;
            motion.pose_error *= 4.0;
        }
        // Two runs can agree on a steady state that is unstable: they stay there by rounding alone, unlike the motion.
        let growth = (-stiffness(ask.table.contact(), body, start)).max(0.0).sqrt() * span.abs();
        motion.error = motion.error.max(4.0 * f64::EPSILON * growth.exp());
        if ask.pose {
            motion.pose_error = motion.pose_error.max(motion.error * (1.0 + span.abs()));
        }
    }
    Ok(Some(motion))
}
