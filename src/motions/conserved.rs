//! Motions that conserve energy, by the first integrals or by an integrator that is judged by them.

use super::ask::check;
use super::exact::{self, Swing};
use super::exactly::{follow, quickly};
use super::judge::pressed;
use super::limits::Limits;
use super::rk4::course::{Course, Stepping};
use super::rk4::guard::{Guard, guard};
use super::rk4::stepped;
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
    let way = if span < 0.0 { -1.0 } else { 1.0 };
    let swing = Swing::new(body, start, ask.table.contact(), ask.pose).ok();
    let limits = Limits::new(body, &ask.table);
    let swing = swing.as_ref();
    let exact = swing.filter(|s| s.error(span).is_finite());
    let course = Course { start, span, times, t0, pose: ask.pose, unguarded: swing.is_none() };
    let stepping = match ask.method {
        Method::Step(step) => Some(Stepping::Fixed(way * step.abs())),
        Method::Tolerance(tol) => Some(Stepping::Within(tol)),
        Method::Exact => None,
    };
    let guarded = match ask.method {
        Method::Step(step) => guard(&course, swing, &limits, step.abs())?,
        _ => Guard::default(),
    };
    let found = match (stepping, exact) {
        (None, Some(swing)) => follow(swing, &course, &limits, ask.beyond, go_on)?,
        _ => {
            let stepping = stepping.unwrap_or(Stepping::Within(FALLBACK));
            stepped(body, &course, swing, &limits, stepping, ask, go_on)?
        }
    };
    let Some(mut motion) = found else { return Ok(None) };
    (motion.step_loss, motion.advice, motion.coarse) = (guarded.loss, guarded.advice, guarded.coarse);
    if ask.force {
        return pressed(motion, ask.table.contact(), body, go_on);
    }
    Ok(Some(motion))
}
