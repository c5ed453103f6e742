//! Motions by their first integrals: a quick method for motions without an event, and a method that finds the ends.

use super::Swing;
use super::course::Course;
use super::event::{self, Limits};
use super::lanes::{QuickMotion, QuickTask, roll_narrow_swing};
use crate::error::{Error, copied, room};
use crate::laws::body::Body;
use crate::laws::state::State;
use crate::motions::walk::errors::with_contact_forces;
use crate::motions::{Ask, Event, Method, Motion};
use crate::numbers::larger_or_nan;

/// Largest estimated error of a state at which the result of the quick method is accepted; the next constant is that
/// of a pose.
const QUICK: f64 = 2e-12;
const QUICK_POSE: f64 = 3e-11;
/// Number of times after which the caller may interrupt the quick method: their states take about a millisecond.
const TIMES_PER_BLOCK: usize = 1 << 14;

/// Computes the exact motion by the quick method, if the swing is narrow and has no event, else None; it takes a
/// tenth of the work.
pub(crate) fn quickly(
    body: &Body,
    start: &State,
    t0: f64,
    times: &[f64],
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    if ask.method != Method::Exact || times.is_empty() {
        return Ok(None);
    }
    let mut since = copied(times)?;
    since.iter_mut().for_each(|t| *t -= t0);
    let count = |wanted| if wanted { times.len() } else { 0 };
    let mut found =
        QuickMotion { states: room(times.len())?, poses: room(count(ask.pose))?, ..QuickMotion::default() };
    let enough = |times: &[f64], found: &mut QuickMotion| {
        let pose = ask.pose.then_some(QUICK_POSE);
        let (contact, mu) = (ask.table.contact(), ask.table.mu());
        roll_narrow_swing(&QuickTask { contact, body, start, times, mu, tol: QUICK, pose }, found)
    };
    // Of several blocks the last time comes first, since the error grows with time.
    if times.len() > TIMES_PER_BLOCK {
        if !enough(&since[times.len() - 1..], &mut found) {
            return Ok(None);
        }
        found.states.clear();
        found.poses.clear();
    }
    let mut over = false;
    for block in since.chunks(TIMES_PER_BLOCK) {
        over = !found.states.is_empty() && !go_on();
        if over {
            break;
        }
        if !enough(block, &mut found) {
            return Ok(None);
        }
    }
    let mut motion = Motion { states: found.states, error: found.error, ..Motion::empty(0, false)? };
    if ask.pose {
        (motion.poses, motion.pose_error) = (Some(found.poses), found.pose_error);
    }
    if over {
        motion = motion.interrupted(times, t0, *start);
    } else {
        motion.times = copied(times)?;
    }
    let mut go_on = || over || go_on();
    Ok(Some(if ask.force {
        with_contact_forces(motion, ask.table.contact(), body, &mut go_on)?
    } else {
        motion
    }))
}

/// Computes the exact motion up to its end.
pub(crate) fn follow(
    swing: &Swing,
    course: &Course<'_>,
    limits: &Limits,
    beyond: bool,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Motion, Error> {
    let way = course.way();
    let event = event::first_event(swing, limits, way).filter(|e| e.time.abs() <= course.span.abs());
    let last = match event {
        Some(e) if e.ends(beyond) => e.time.abs(),
        _ => swing.landing(way).map_or(f64::INFINITY, |(t, _)| t),
    };
    let count = course.count(last);
    let mut motion = Motion::empty(count, course.pose)?;
    motion.event = event.map(|e| Event { time: course.t0 + e.time, ..e });
    let every = (count / 16).max(1);
    let (mut fastest, mut swiftest) = (0.0, 0.0);
    for (i, t) in course.times[..count].iter().enumerate() {
        if i % 4096 == 4095 && !go_on() {
            return Ok(motion.interrupted(course.times, course.t0, *course.start));
        }
        let t = t - course.t0;
        let y = swing.state(t);
        motion.states.push(y);
        // Errors are estimated at some of the times, and where the state changes fastest.
        let turning = y.precession().abs();
        let looked_at = i % every == 0 || i + 1 == count;
        if turning > fastest {
            (fastest, swiftest) = (turning, t);
        }
        if looked_at {
            motion.error = larger_or_nan(motion.error, swing.error(t));
        }
        if let Some(poses) = &mut motion.poses {
            poses.extend(swing.pose(t));
            if looked_at {
                motion.pose_error = larger_or_nan(motion.pose_error, swing.pose_error(t));
            }
        }
    }
    let met = event.map(|e| (e.time, limits.doubt(&e) + swing.time_error(e.time)));
    for (t, doubt) in met.into_iter().chain((count > 0).then_some((swiftest, 0.0))) {
        motion.error = larger_or_nan(motion.error, swing.error(t) + doubt);
        if course.pose {
            motion.pose_error = larger_or_nan(motion.pose_error, swing.pose_error(t));
        }
    }
    motion.times = copied(&course.times[..count])?;
    Ok(motion)
}
