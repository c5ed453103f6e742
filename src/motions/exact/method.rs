//! Motions that conserve energy: by the first integrals, or by an integrator, whose error is estimated from the first
//! integrals.

use super::course::Course;
use super::event::Limits;
use super::motion::{follow, quickly};
use super::tolerance::within;
use crate::error::Error;
use crate::laws::body::Body;
use crate::methods::SHORT_CODE;
use crate::motions::ask::check_conserving;
use crate::motions::exact::{self, Swing};
use crate::motions::rk4::stepped;
use crate::motions::walk::errors::with_contact_forces;
use crate::motions::{Ask, Method, Motion, Start};

/// Tolerance of the integrator that replaces the first integrals where these lose all their digits.
const FALLBACK: f64 = 1e-12;

/// Computes the motion of a body that conserves energy, by the method of `ask`.
#[inline(never)] // its frame is not on the stack of the walks
pub(crate) fn conserved(
    body: &Body,
    start: &Start,
    times: &[f64],
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Motion, Error> {
    exact::check(body, &start.state)?;
    let course = Course::of(body, start, times, ask.pose, check_conserving(ask, start.time, times)?);
    let swing = Swing::of(body, course.start, ask.table.contact(), ask.pose).ok();
    let (limits, swing) = (Limits::new(body, &ask.table), swing.as_ref());
    let found = match ask.method {
        Method::Exact => return by_first_integrals(body, start, times, ask, go_on),
        Method::Step(step) => stepped(&course, swing, &limits, ask, step.abs(), go_on)?,
        Method::Tolerance(tol) => within(&course, swing, &limits, ask, tol, go_on)?,
    };
    with_forces(found, body, ask, go_on)
}

/// Computes the motion by the first integrals, or by an integrator where these lose their digits.
pub(crate) fn by_first_integrals(
    body: &Body,
    start: &Start,
    times: &[f64],
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Motion, Error> {
    exact::check(body, &start.state)?;
    let course = Course::of(body, start, times, ask.pose, check_conserving(ask, start.time, times)?);
    if !SHORT_CODE && let Some(motion) = quickly(body, course.start, course.t0, times, ask, go_on)? {
        return Ok(motion);
    }
    let swing = Swing::of(body, course.start, ask.table.contact(), ask.pose).ok();
    let (limits, swing) = (Limits::new(body, &ask.table), swing.as_ref());
    let found = match swing.filter(|swing| swing.error(course.span).is_finite()) {
        Some(swing) => follow(swing, &course, &limits, ask.beyond, go_on)?,
        None if SHORT_CODE => return Err(Error::Lost { theta: start.state.theta }),
        None => within(&course, swing, &limits, ask, FALLBACK, go_on)?,
    };
    with_forces(found, body, ask, go_on)
}

fn with_forces(
    found: Motion,
    body: &Body,
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Motion, Error> {
    // An interrupted motion has all its forces, too.
    let over = found.is_interrupted();
    let mut go_on = || over || go_on();
    if ask.force { with_contact_forces(found, ask.table.contact(), body, &mut go_on) } else { Ok(found) }
}
