//! Motions by an integrator, judged by the exact solution, or by a rougher run where there is none.
//!
//! In a passage that is nearly flat, steps that err by 1e-6 may find a lift-off that the motion does not have, and steps a
//! hundred times as good may find it again. So an end is one if the exact solution has it, where that is sure; elsewhere, if
//! it stands within a smaller tolerance.

use super::integrator::{self, Course, Stepping};
use super::judge::{compare, judge, same};
use super::limits::{self, Limits};
use super::{Ask, Ending, Event, Motion};
use crate::body::Body;
use crate::error::Error;
use crate::exact::Swing;
use crate::stability::stiffness;

/// Up to this error the exact solution says how far an integrator is off.
const DOUBTFUL: f64 = 1e-3;
/// Up to this one it says what ends the motion.
const SURE: f64 = 1e-6;
/// An end that nothing else can judge is looked at again within smaller tolerances, down to this.
const TIGHTEST: f64 = 1e-13;

/// A motion by steps: what is asked for, and what the exact solution knows of it.
struct Stepped<'a> {
    course: &'a Course<'a>,
    limits: &'a Limits,
    ask: &'a Ask,
    /// The exact solution, as far as it can judge, and the end that it has.
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
        integrator::run(self.course, self.limits, stepping, beyond, go_on)
    }

    /// Whether a run has the end that the exact solution has, or none as that.
    fn agrees(&self, event: Option<Event>) -> bool {
        match (event, self.event) {
            (Some(a), Some(b)) => same(&a, &b),
            (a, b) => a.is_none() && b.is_none(),
        }
    }

    /// Whether the exact solution says whether this is an end: it is good enough up to that, or to its own if that is earlier.
    fn is_sure(&self, made: &Event) -> bool {
        let since = |event: &Event| event.time - self.course.t0;
        let own = self.event.as_ref().map(since).filter(|own| own.abs() < since(made).abs());
        self.exact.is_some_and(|swing| swing.error(own.unwrap_or(since(made))) <= SURE)
    }

    /// A motion whose end is the one of the exact solution, whatever the steps made of it.
    fn ended(&self, motion: &mut Motion) {
        motion.event = self.event;
        if let Some(event) = self.event.filter(|e| !self.ask.beyond || e.ending == Ending::Face) {
            motion.keep(self.course.t0, (event.time - self.course.t0).abs());
        }
    }

    /// The motion by these steps. An end that the exact solution does not have was made by them: they go on beyond it. Where
    /// they cannot, as the face has landed, or where no exact solution is sure, only an end that stands within a smaller
    /// tolerance is told; a fixed step that makes the face land is refused.
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

/// The states by an integrator, with their errors; `swing` is the exact solution as far as there is one.
pub(super) fn stepped(
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
    // behind an end there is nothing to judge
    let ended = found.filter(|e| !ask.beyond || e.ending == Ending::Face);
    let last = ended.map_or(span, |e| e.time);
    let judge_by = swing.filter(|s| s.error(last) <= DOUBTFUL);
    let found = found.filter(|_| judge_by.is_some());
    let doubt = found.zip(judge_by).map_or(0.0, |(e, swing)| limits.doubt(&e) + swing.time_error(e.time));
    let event = found.map(|e| Event { time: t0 + e.time, ..e });
    let by_steps = Stepped { course, limits, ask, exact: judge_by, event };
    let Some(mut motion) = by_steps.motion(stepping, go_on)? else { return Ok(None) };
    if let Some(swing) = judge_by {
        // a coarse integrator can miss an end that the motion has
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
        // where both err by rounding as well, their difference says too little
        if let Stepping::Within(_) = stepping {
            motion.error *= 4.0;
            motion.pose_error *= 4.0;
        }
        // two runs can agree on a state that stays where it is unstable: by their rounding, not by
        // the motion
        let growth = (-stiffness(ask.table.contact(), body, start)).max(0.0).sqrt() * span.abs();
        motion.error = motion.error.max(4.0 * f64::EPSILON * growth.exp());
        if ask.pose {
            motion.pose_error = motion.pose_error.max(motion.error * (1.0 + span.abs()));
        }
    }
    Ok(Some(motion))
}
