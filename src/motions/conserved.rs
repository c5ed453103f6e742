//! Motions that conserve energy, by the first integrals or by an integrator that is judged by them.

use super::ask::check;
use super::course::Course;
use super::exact::{self, Swing};
use super::exactly::{follow, quickly};
use super::judge::pressed;
use super::limits::Limits;
use super::rk4::stepped;
use super::within::within;
use super::{Ask, Method, Motion, Start};
use crate::error::Error;
use crate::laws::body::Body;

/// Tolerance of the integrator that replaces a missing exact solution.
const FALLBACK: f64 = 1e-12;

/// The motion of a body that conserves energy, by the first integrals or by an integrator that is judged by them.
pub(super) fn conserved(
    body: &Body,
    &Start { state: ref start, time: t0, .. }: &Start,
    times: &[f64],
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    exact::check(body, start)?;
    let span = check(ask, t0, times)?;
    if let Some(motion) = quickly(body, start, t0, times, ask)? {
        return Ok(Some(motion));
    }
    let swing = Swing::new(body, start, ask.table.contact(), ask.pose).ok();
    let (limits, swing) = (Limits::new(body, &ask.table), swing.as_ref());
    let course = Course { body, start, t0, span, times, pose: ask.pose };
    let found = match (ask.method, swing.filter(|swing| swing.error(span).is_finite())) {
        (Method::Exact, Some(swing)) => follow(swing, &course, &limits, ask.beyond, go_on)?,
        (Method::Exact, None) => within(&course, swing, &limits, ask, FALLBACK, go_on)?,
        (Method::Tolerance(tol), _) => within(&course, swing, &limits, ask, tol, go_on)?,
        (Method::Step(step), _) => stepped(&course, swing, &limits, ask, step.abs(), go_on)?,
    };
    let Some(motion) = found else { return Ok(None) };
    if ask.force {
        return pressed(motion, ask.table.contact(), body, go_on);
    }
    Ok(Some(motion))
}
