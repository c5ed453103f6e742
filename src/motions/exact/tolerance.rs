//! Motions that conserve energy, computed by an integrator within a tolerance. Their estimated error is the
//! difference from the exact solution or, without an accurate one, from a run with a larger tolerance.
//!
//! Where a body passes close to its face, steps with errors of 1e-6 may lead to a lift-off that the true motion does
//! not have, and so may steps a hundred times as accurate. Therefore an end is accepted only if the exact solution
//! has it or, where that solution is not accurate enough, if a run with a smaller tolerance also has it.
//!
//! A motion backward in time is computed forward in time from the reversed angular velocity; the angular velocities
//! of the result are then reversed.

use super::Swing;
use super::course::Course;
use super::event::{self, Limits};
use crate::error::{Error, copied};
use crate::laws::loss::Losses;
use crate::laws::state::State;
use crate::motions::ask::FINE;
use crate::motions::body::walked;
use crate::motions::walk::errors::{judge, same_end};
use crate::motions::walk::two_runs::{Followed, judged};
use crate::motions::{Ask, Event, Method, Motion, Start};
use crate::numbers::{Real, larger_or_nan};
use crate::states::stability::stiffness;

/// Largest error of an exact solution from which the error of another solution is computed.
const REFERENCE_ERROR: f64 = 1e-3;
/// Largest error of an exact solution that decides how the motion ends.
const DECISIVE_ERROR: f64 = 1e-6;
/// The tolerance of a step as a share of the tolerance of the motion, since errors of many steps add.
const STEP_TOLERANCE_SHARE: f64 = 0.1;
/// Smallest tolerance of the runs that test an end which the exact solution cannot judge.
const TIGHTEST: f64 = 1e-13;

/// The exact solution and its end, if the error of the solution is at most `REFERENCE_ERROR`.
pub(crate) struct ExactEnd<'a> {
    pub swing: Option<&'a Swing>,
    pub event: Option<Event>,
    /// The error of the time and the state of the exact solution's end.
    pub doubt: f64,
    /// Number of requested times that the motion reaches.
    pub count: usize,
}

impl<'a> ExactEnd<'a> {
    pub fn of(course: &Course<'_>, swing: Option<&'a Swing>, limits: &Limits, beyond: bool) -> Self {
        let found = swing.and_then(|swing| event::first_event(swing, limits, course.way()));
        let found = found.filter(|e| e.time.abs() <= course.span.abs());
        // The error of the exact solution counts only up to an end.
        let last = found.filter(|e| e.ends(beyond)).map_or(course.span, |e| e.time);
        let swing = swing.filter(|s| s.error(last) <= REFERENCE_ERROR);
        let found = found.filter(|_| swing.is_some());
        let last = found.filter(|e| e.ends(beyond)).map(|e| e.time);
        let lands = || swing.and_then(|swing| swing.landing(course.way())).map(|(time, _)| time);
        let count = course.count(last.or_else(lands).unwrap_or(f64::INFINITY));
        let doubt = found.zip(swing).map_or(0.0, |(e, swing)| limits.doubt(&e) + swing.time_error(e.time));
        Self { swing, event: found.map(|e| Event { time: course.t0 + e.time, ..e }), doubt, count }
    }

    /// Whether another solution and the exact one have the same end, or both have none.
    fn agrees(&self, event: Option<Event>) -> bool {
        match (event, self.event) {
            (Some(a), Some(b)) => same_end(&a, &b),
            (a, b) => a.is_none() && b.is_none(),
        }
    }

    /// Whether the error of the exact solution is at most `DECISIVE_ERROR` up to the end `made`, or up to an earlier
    /// end of the exact solution.
    fn is_sure(&self, made: &Event, t0: f64) -> bool {
        let since = |event: &Event| event.time - t0;
        let own = self.event.as_ref().map(since).filter(|own| own.abs() < since(made).abs());
        self.swing.is_some_and(|swing| swing.error(own.unwrap_or(since(made))) <= DECISIVE_ERROR)
    }
}

/// Integrates the motion with the tolerance `tol`; `fine` is the smaller tolerance of the two runs.
fn run_with_steps(
    course: &Course<'_>,
    ask: &Ask,
    (tol, fine): (f64, f64),
    times: &[f64],
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Followed, Error> {
    let (way, t0) = (course.way(), course.t0);
    let turned = |y: &State| State { w1: way * y.w1, w2: way * y.w2, w3: way * y.w3, ..*y };
    let start = Start::from(turned(course.start));
    let mut since = copied(times)?;
    since.iter_mut().for_each(|t| *t = way * (*t - t0));
    let (tol, fine) = ((STEP_TOLERANCE_SHARE * tol).max(FINE), (STEP_TOLERANCE_SHARE * fine).max(FINE));
    let ask = Ask { method: Method::Tolerance(fine), losses: Losses::NONE, force: false, ..*ask };
    let mut found = walked((course.body, &start), &ask, (tol, true), &since, go_on)?;
    let motion = &mut found.motion;
    motion.times = copied(&times[..motion.states.len()])?;
    motion.states.iter_mut().for_each(|y| *y = turned(y));
    if let Some(event) = &mut motion.event {
        *event = Event { time: t0 + way * event.time, state: turned(&event.state), ..*event };
    }
    Ok(found)
}

/// Integrates the motion with the tolerance `tol`, and estimates its errors; `swing` is the exact solution, if there
/// is one.
pub(crate) fn within(
    course: &Course<'_>,
    swing: Option<&Swing>,
    limits: &Limits,
    ask: &Ask,
    tol: f64,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Motion, Error> {
    let known = ExactEnd::of(course, swing, limits, ask.beyond);
    let Some(swing) = known.swing else { return judged_by_rougher_run(course, ask, tol, go_on) };
    let mut run = |tol: f64, beyond: bool| -> Result<Motion, Error> {
        Ok(run_with_steps(course, &Ask { beyond, ..*ask }, (tol, tol), course.times, go_on)?.motion)
    };
    let mut motion = run(tol, ask.beyond)?;
    if let Some(made) = motion.event.filter(|made| motion.limit.is_none() && !known.agrees(Some(*made))) {
        motion = decide_about_end(course, &known, ask, (motion, made), tol, &mut run)?;
    }
    // Steps can miss an end of the exact solution.
    if motion.event.is_none() {
        take_exact_end(&mut motion, &known, course, ask);
    }
    motion.error = 0.0;
    judge(&mut motion, swing, known.event, course.t0);
    if motion.event.is_some() {
        motion.error = larger_or_nan(motion.error, known.doubt);
    }
    motion.method = Method::Tolerance(tol);
    Ok(motion)
}

/// Sets the event of a motion to that of the exact solution, and removes the outputs after an end.
fn take_exact_end(motion: &mut Motion, known: &ExactEnd<'_>, course: &Course<'_>, ask: &Ask) {
    motion.event = known.event;
    if let Some(event) = known.event.filter(|e| e.ends(ask.beyond)) {
        motion.keep(course.t0, (event.time - course.t0).abs());
    }
}

/// Decides whether an end of the integrated motion (`made`) is real that the exact solution does not have. If the
/// exact solution is accurate enough to decide, the integration continues past its end. If this is impossible, since
/// the face has landed, or if the exact solution is not accurate enough, the integration is repeated with smaller
/// tolerances until these confirm an end.
fn decide_about_end(
    course: &Course<'_>,
    known: &ExactEnd<'_>,
    ask: &Ask,
    (mut motion, made): (Motion, Event),
    mut tol: f64,
    run: &mut dyn FnMut(f64, bool) -> Result<Motion, Error>,
) -> Result<Motion, Error> {
    let sure = known.is_sure(&made, course.t0);
    if sure {
        let mut on = run(tol, true)?;
        let reached = on.times.len();
        if on.limit.is_none() {
            take_exact_end(&mut on, known, course, ask);
        }
        if on.limit.is_some() || reached >= known.count {
            return Ok(on);
        }
    }
    while tol > TIGHTEST && motion.event.is_some() && motion.limit.is_none() {
        tol = (0.01 * tol).max(TIGHTEST);
        let tighter = run(tol, ask.beyond)?;
        let stands = if sure {
            known.agrees(tighter.event)
        } else {
            motion.event.zip(tighter.event).is_some_and(|(a, b)| same_end(&a, &b))
        };
        if stands && !sure {
            break;
        }
        motion = tighter;
        if stands {
            break;
        }
    }
    Ok(motion)
}

/// Integrates the motion with the tolerance `tol`, and estimates its error from a run with a larger tolerance. If the
/// two runs end differently, they are repeated with smaller tolerances.
fn judged_by_rougher_run(
    course: &Course<'_>,
    ask: &Ask,
    tol: f64,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Motion, Error> {
    let mut fine = tol;
    let mut motion = loop {
        let run = |tol: f64, times: &[f64]| run_with_steps(course, ask, (tol, fine), times, go_on);
        let found = judged(fine, course.times, run)?;
        if found.motion.error.is_finite() || fine <= TIGHTEST || found.motion.limit.is_some() {
            break found.motion;
        }
        fine = (0.01 * fine).max(TIGHTEST);
    };
    motion.method = Method::Tolerance(tol);
    // In an unstable steady state rounding may keep both runs at the initial state, so that they agree, although any
    // disturbance would grow.
    let growth = (-stiffness(ask.table.contact(), course.body, course.start)).positive_part().sqrt()
        * course.span.abs();
    motion.error = larger_or_nan(motion.error, 4.0 * f64::EPSILON * growth.exp());
    if ask.pose {
        motion.pose_error = larger_or_nan(motion.pose_error, motion.error * (1.0 + course.span.abs()));
    }
    Ok(motion)
}
