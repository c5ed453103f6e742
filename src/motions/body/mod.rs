//! Motions of a body with friction, losses or impacts, through phases such as slipping and rolling.
//!
//! ```text
//! slip    until u = 0: then it rolls if |F_roll| <= mu_s N, else it slips in another direction
//! roll    until |F_roll| = mu_s N: then it slips
//! both    until N = 0, or a face or the other rim lands: the end
//! ```
//! A slipping phase is integrated (`body::slide`). A rolling phase without losses is the exact solution, so that its
//! cost does not depend on its length. Where no contact force, or more than one, obeys the law of friction (Painleve),
//! an initial state is an error and a motion ends.
//!
//! Error: the path is computed twice, the second time with a tolerance up to ten thousand times as large, in about a
//! third of the time. The estimated error is thirty times the difference of the two paths, scaled by the ratio of the
//! tolerances.
//!
//! ```
//! use spincyl::contact::Friction;
//! use spincyl::motion::{Ask, Start, path::Kind, roll_with};
//! use spincyl::{Body, Slip, State};
//!
//! // A hoop that slides without turning begins to roll.
//! let hoop = Body::tube(0.0, 1.0)?;
//! let state = State { theta: std::f64::consts::FRAC_PI_2, w1: 0.0, w2: 0.0, w3: 0.0 };
//! let (start, ask) = (Start::from(state).with_slip(Slip::new(0.0, 1.0)), Ask::on(Friction::coulomb(0.25)));
//! let motion = roll_with(&hoop, start, &[0.0, 10.0], &ask, || true)?.expect("not interrupted");
//! let kinds: Vec<Kind> = motion.path.expect("there is friction").phases.iter().map(|phase| phase.kind).collect();
//! assert_eq!(kinds, [Kind::Slipping, Kind::Rolling]);
//! # Ok::<(), spincyl::Error>(())
//! ```

pub(crate) mod body_walk;
pub(crate) mod face;
mod faults;
pub(crate) mod fly;
pub(crate) mod lie;
pub(crate) mod own;
pub(crate) mod phases;
pub(crate) mod pole;
pub(crate) mod roll;
pub(crate) mod slide;
pub(crate) mod spun;
pub(crate) mod stand;
mod strike;
mod tail;
mod uniform;
pub(crate) mod write;

use super::{AboveTable, Ask, Motion, Start};
pub use super::{AfterImpact, Hit, Kind, Lands, OtherRim, Path, Phase, Strike};
use crate::error::{Error, within};
use crate::laws::body::Body;
use crate::laws::contact::Table;
use crate::laws::contact::slip::{Friction, centre_velocity};
use crate::laws::loss::Law;
use crate::laws::state::{Slip, State};
use crate::methods::SHORT_CODE;
pub use crate::motions::ask::FINE;
use crate::motions::ask::{check_flow, check_patch, check_resistance, check_times_after};
use crate::motions::exact;
use crate::motions::slope::on_slope;
use crate::motions::walk::two_runs::{Followed, judged};
pub(crate) use body_walk::BodyWalk;
use core::f64::consts::PI;

/// The error of the direction of a ball's axis, as a share of the estimated error of the states.
const AXIS_ERROR_SHARE: f64 = 0.25;

/// The motion of a body that slips or loses energy, for [`roll_with`](crate::motions::motion::roll_with). A web page
/// that needs no other motion calls this function directly, so that its program contains no other code. A motion that
/// needs too many evaluations, or whose equations lose all digits on the way, ends there with
/// [`Ending::Bounded`](crate::motions::Ending::Bounded) and the [`Limit`](crate::motions::Limit) that it has reached;
/// so does a motion that `go_on` interrupts.
///
/// # Errors
/// `OutOfRange`, `Painleve` and `Memory` as for [`roll_with`](crate::motions::motion::roll_with); `Lost` where the
/// equations have lost their digits at the start.
pub fn follow(
    body: &Body,
    start: &Start,
    times: &[f64],
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Motion, Error> {
    followed(body, start, times, (ask, true), go_on).map(Into::into)
}

/// The motion of [`follow`], before its path becomes a part of it. Its error is NaN unless `is_judged`: then a second
/// run shows it.
pub(crate) fn followed(
    body: &Body,
    start: &Start,
    times: &[f64],
    (ask, is_judged): (&Ask, bool),
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Followed, Error> {
    let (body, start) = start.seen_on(body);
    let fine = check_walk(&body, &start, ask)?;
    check_times_after(start.time, times)?;
    on_slope(ask, &start, times, |start, times, ask, _| {
        judged_walk((&body, start), times, (ask, fine), is_judged, go_on)
    })
}

/// Computes a motion and, if `is_judged`, its estimated error.
fn judged_walk(
    (body, start): (&Body, &Start),
    times: &[f64],
    (ask, fine): (&Ask, f64),
    is_judged: bool,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Followed, Error> {
    let mut run = |tol: f64, times: &[f64]| walked((body, start), ask, (tol, false), times, go_on);
    if !SHORT_CODE && spun::knows(body, ask) {
        let mut found = run(fine, times)?;
        found.complete_known_errors(fine);
        return Ok(found);
    }
    if !is_judged {
        let mut found = run(fine, times)?;
        found.motion.error = f64::NAN;
        return Ok(found);
    }
    let mut found = judged(fine, times, run)?;
    if body.is_ball() {
        // Beside a pole the lean has no direction: phi has the error of the axis over sin(theta).
        let (error, sines) = (found.motion.error, found.motion.states.iter().map(|y| y.theta.sin()));
        found.motion.pose_error += AXIS_ERROR_SHARE * (error / (error + sines.fold(1.0, f64::min))).min(1.0);
    }
    Ok(found)
}

/// Computes a body's motion once, with the tolerance `tol` of its steps. The state vector includes a pose and the
/// lost energy only if `ask` needs them. With `integrates` a phase without a slip is integrated although no energy is
/// lost.
pub(super) fn walked(
    (body, start): (&Body, &Start),
    ask: &Ask,
    (tol, integrates): (f64, bool),
    times: &[f64],
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Followed, Error> {
    // `SHORT_CODE` compiles one kind of walk only, with the pose and the lost energy.
    let loses = !ask.losses.is_none() || ask.table.friction().patch() > 0.0;
    match (SHORT_CODE || ask.pose || !ask.is_level(), !SHORT_CODE && !loses) {
        (true, true) => walk::<13>((body, start), ask, (tol, integrates), times)?.run(go_on),
        (true, false) => walk::<14>((body, start), ask, (tol, integrates), times)?.run(go_on),
        (false, true) => walk::<9>((body, start), ask, (tol, integrates), times)?.run(go_on),
        (false, false) => walk::<10>((body, start), ask, (tol, integrates), times)?.run(go_on),
    }
}

/// Prepares the computation of a motion from its initial state, on the heap, since it runs on threads with a small
/// stack.
#[inline(never)]
fn walk<'a, const N: usize>(
    (body, start): (&Body, &Start),
    ask: &Ask,
    (tol, integrates): (f64, bool),
    times: &'a [f64],
) -> Result<Box<BodyWalk<'a, N>>, Error> {
    let mut walk = Box::new(BodyWalk::of_body(body, ask, tol, times, start)?);
    walk.of.integrates |= integrates;
    walk.of.uniform &= !integrates;
    Ok(walk)
}

/// For a motion on a smooth table with impacts: options and start with friction of coefficient 0, and a slip with
/// which the centre has no horizontal velocity. Other motions keep their own.
pub(super) fn without_friction(body: &Body, ask: &Ask, start: &Start) -> (Ask, Start) {
    let (mut ask, mut start) = (*ask, *start);
    if ask.table == Table::Smooth && (ask.restitution.is_some() || on_face(body, &start.state)) {
        ask.table = Friction::coulomb(0.0).into();
        if start.aloft.is_none() && start.slip == Slip::default() {
            let [v_h, v_2] = centre_velocity(body, &start.state, Slip::default());
            start.slip = Slip::new(0.0 - v_h, 0.0 - v_2);
        }
    }
    (ask, start)
}

/// Returns the tolerance of the steps, or an error for a body, an initial state or options out of range.
pub(crate) fn check_walk(body: &Body, start: &Start, ask: &Ask) -> Result<f64, Error> {
    match start.aloft {
        Some(AboveTable { height, .. }) if height > 0.0 => exact::check_in_air(body, &start.state)?,
        None if on_face(body, &start.state) => exact::check_on_face(body, &start.state)?,
        _ => exact::check(body, &start.state)?,
    }
    start.check_place()?;
    ask.table.check()?;
    ask.losses.check_for(body)?;
    check_patch(ask)?;
    check_resistance(ask)?;
    ask.impact_law.check(body.is_uniform_ball(), &ask.table)?;
    let fine = check_flow(ask)?;
    let drills = ask.losses.coefficient(Law::Drilling) != 0.0 && ask.restitution.is_some();
    if ask.slope != 0.0 && drills && body.theta_end() < PI {
        // On two circles it would share in what holds the body along its axis.
        let expected = "0, since the body can lie on two circles and has drilling friction and a restitution";
        return Err(Error::OutOfRange { name: "slope", value: ask.slope, expected });
    }
    for (name, u) in ["slip along the lean", "slip across"].into_iter().zip(start.slip.pair()) {
        within(name, u, (-1e6, 1e6), "-1e6 to 1e6 sqrt(g R) for a motion")?;
    }
    if let Some(AboveTable { height, lift }) = start.aloft {
        within("height", height, (0.0, 1e6), "0 to 1e6 R")?;
        within("lift", lift, (-1e6, 1e6), "-1e6 to 1e6 sqrt(g R)")?;
        if ask.restitution.is_none() {
            let expected = "None, or a restitution, which a motion that starts in the air needs";
            return Err(Error::OutOfRange { name: "height", value: height, expected });
        }
        if !body.lands_on_rims() {
            let expected = "a body that lands on its rims, for a start in the air: another part of this one lands, and its shape is unknown";
            return Err(Error::OutOfRange { name: "theta_end", value: body.theta_end(), expected });
        }
        let (angle, landings) = (start.state.theta.sin_cos(), body.landings());
        for k in 1..landings.count {
            let rim = landings.rims[landings.lowest(k, angle.1)];
            let other = height + body.shape().rim.less(&rim).height(angle);
            let value = if other < -1e-15 { -height } else { height };
            within("height", value, (0.0, 1e6), "all rims above the table, or on it")?;
        }
    }
    if ask.table.rubs() || start.aloft.is_some() || on_face(body, &start.state) {
        Ok(fine)
    } else {
        refuse_slip(start.slip).map(|()| fine)
    }
}

/// Whether a body starts on its face: its rim has a radius, and theta is 0, or pi where no other rim lands before.
pub(crate) fn on_face(body: &Body, y: &State) -> bool {
    (y.theta == 0.0 || y.theta == PI && body.theta_end() == PI) && body.rim() > 0.0
}

/// Returns an error if the initial slip is not zero, for a contact without a law of friction.
pub(super) fn refuse_slip(Slip { u_h, u_2 }: Slip) -> Result<(), Error> {
    let value = if u_h == 0.0 { u_2 } else { u_h };
    if value == 0.0 {
        return Ok(());
    }
    Err(Error::OutOfRange { name: "slip", value, expected: "0, or a law of friction as the contact" })
}
