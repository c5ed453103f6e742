//! Motions by an integrator: within smaller tolerances where an end is in doubt, and judged by the exact
//! solution, or by a rougher run where there is none.

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
/// An end that an integrator meets is looked at again within smaller tolerances, down to this.
const TIGHTEST: f64 = 1e-13;

/// The states by an integrator, with their errors; `swing` is the exact solution as far as there is one.
pub(super) fn stepped(
    body: &Body,
    course: &Course<'_>,
    swing: Option<&Swing>,
    limits: &Limits,
    stepping: Stepping,
    scene: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    let &Course { start, span, t0, .. } = course;
    let way = if span < 0.0 { -1.0 } else { 1.0 };
    let run = |stepping: Stepping, go_on: &mut dyn FnMut() -> bool| {
        integrator::run(course, limits, stepping, scene.beyond, go_on)
    };
    let judge_by = swing.filter(|s| s.error(span) <= DOUBTFUL);
    let found = judge_by.and_then(|swing| limits::first_event(swing, limits, way));
    let found = found.filter(|e| e.time.abs() <= span.abs());
    let doubt = found.zip(judge_by).map_or(0.0, |(e, swing)| limits.doubt(&e) + swing.time_error(e.time));
    let event = found.map(|e| Event { time: t0 + e.time, ..e });
    let Some(mut motion) = run(stepping, go_on)? else { return Ok(None) };
    // an end that a tighter tolerance does not meet was made by the steps
    let mut tol = match stepping {
        Stepping::Within(tol) if !motion.event.is_some_and(|e| event.is_some_and(|x| same(&e, &x))) => tol,
        _ => 0.0,
    };
    while tol > TIGHTEST && motion.event.is_some() {
        tol = (0.01 * tol).max(TIGHTEST);
        let Some(tighter) = run(Stepping::Within(tol), go_on)? else { return Ok(None) };
        let stands = motion.event.zip(tighter.event).is_some_and(|(a, b)| same(&a, &b));
        if stands {
            break;
        }
        motion = Motion { method: motion.method, ..tighter };
    }
    if let Some(swing) = judge_by {
        // a coarse integrator can miss an end that the motion has
        if let Some(event) = event.filter(|_| motion.event.is_none()) {
            motion.event = Some(event);
            if !scene.beyond || event.ending == Ending::Face {
                motion.keep(t0, (event.time - t0).abs());
            }
        }
        judge(&mut motion, swing, event, t0);
        motion.error = motion.error.max(if motion.event.is_some() { doubt } else { 0.0 });
    } else {
        let rough = match stepping {
            Stepping::Fixed(step) => Stepping::Fixed(2.0 * step),
            Stepping::Within(tol) => Stepping::Within(32.0 * tol),
        };
        match run(rough, go_on) {
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
        let growth = (-stiffness(scene.contact, body, start)).max(0.0).sqrt() * span.abs();
        motion.error = motion.error.max(4.0 * f64::EPSILON * growth.exp());
        if scene.pose {
            motion.pose_error = motion.pose_error.max(motion.error * (1.0 + span.abs()));
        }
    }
    Ok(Some(motion))
}
