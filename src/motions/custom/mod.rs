//! Motions of a body under user-defined laws of loss and friction, or of a stone under a user-defined law of friction
//! ([`custom`](crate::custom)).
//!
//! ```text
//! mu(|u|)        in place of mu where the contact point slips; static friction holds it up to mu_s N, and a slip begins with mu(0)
//! m(theta, w, N) beside the couple of the losses
//! F, m(moment)   a force on the centre, and a couple, that drive the body
//! ```
//! The motion is computed as in [`body`](super::body), which calls the laws at each evaluation of its equations. A
//! slip from rest has no power series: it is integrated from its first moment, with implicit steps where its
//! direction follows the motion much faster than the body turns. Error: as for any motion that is integrated, from a
//! second run with a larger tolerance.

mod laws;
mod measured;

use super::ask::check_times_after;
use super::walk::two_runs::{Followed, judged};
use super::{Ask, Method, Motion, Start};
use crate::error::{Error, within};
use crate::laws::body::Body;
use crate::laws::contact::Table;
use crate::laws::contact::slip::Friction;
use crate::laws::custom::{CoupleLaw, Custom, DriveLaw, FrictionLaw};
use crate::laws::loss::Law;
use crate::laws::stone::{Ellipsoid, StoneState};
use crate::motions::body::{self, BodyWalk, without_friction};
use crate::motions::dry::friction::OwnFriction;
use crate::motions::slope::{AtPace, on_slope};
use crate::motions::stone;
use crate::motions::stone::known::Recorded;
use core::cell::{Cell, RefCell};
use laws::OwnLaws;

/// The default tolerance of a step with user-defined laws, larger than otherwise, since a law may be slow.
const CUSTOM_TOLERANCE: f64 = 1e-10;
/// Number of components of the state vector of a motion with user-defined laws: those of a slip, the pose and the
/// energy lost.
const CUSTOM_NUMBERS: usize = 14;

/// Computes the motion of a body with user-defined laws at `times`, up to the event that ends it.
///
/// `ask` gives the contact, losses, restitution, poses and forces. In the air the couple is called with a normal
/// force of 0; the state of a body with two rims is counted from the lower one. During the impact of one rim the
/// coefficient of friction is that of the current speed; where both rims land at once it is that of the slip after
/// the impact. A motion beyond events is an error, and so is user-defined friction on a patch of contact. The default
/// tolerance of a step is 1e-10. A body with `custom.drive` rolls, slips or flies, and the motion ends where a face
/// or a second rim lands; the work of the drive is subtracted from the lost energy. With `custom.friction` the
/// contact has to be Coulomb's friction, of which only the static coefficient is used. A motion with a law so stiff
/// that it needs too many steps ends early with [`Limit::Stiff`](crate::motion::Limit::Stiff). `go_on` is called at
/// every step, and a law that [fails](crate::custom::CoupleLaw::has_failed) interrupts the motion, too.
///
/// ```
/// use spincyl::{Body, Slip, State, contact::Friction, custom::{self, Custom}, motion::{Ask, Start}};
///
/// // Stribeck's friction falls from 0.4 at rest to 0.2 at high speed.
/// let stribeck = |speed: f64| 0.2 + 0.2 * (-(speed / 0.1).powi(2)).exp();
/// let hoop = Body::tube(0.0, 1.0)?;
/// let state = State { theta: std::f64::consts::FRAC_PI_2, w1: 0.0, w2: 0.0, w3: -3.0 };
/// let start = Start::from(state).with_slip(Slip::new(0.0, 5.0));
/// let (ask, laws) = (Ask::on(Friction::coulomb(0.4)), Custom::default().with_friction(&stribeck));
/// let motion = custom::roll_with(&hoop, start, &[0.0, 20.0], &ask, laws, || true)?.expect("not interrupted");
/// assert!((motion.states[1].w3 - -0.5).abs() < 1e-8); // the hoop rolls back as under any friction
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// Those of [`motion::roll_with`](super::motion::roll_with) and of [`Custom::check`]; `OutOfRange` for a motion
/// beyond events, on a table that turns, with user-defined friction on a patch of contact, together with a tangential
/// restitution, or with a contact other than Coulomb's friction, and for a drive on a smooth table, on a patch of
/// contact, on a face, or together with a loss that holds a body at rest; at any time `Couple` or `Coefficient` if a
/// law is not finite or supplies energy.
pub fn roll_with(
    body: &Body,
    start: impl Into<Start>,
    times: &[f64],
    ask: &Ask,
    custom: Custom<'_>,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    let start = start.into();
    check(body, &start, ask, &custom)?;
    custom.check(body, ask.table.mu())?;
    Ok(Motion::from(followed(body, &start, times, (ask, true), custom, &mut go_on)?).advanced(start.time))
}

/// Computes the motion of a stone with a user-defined law of friction at `times`, as [`stone::roll`] does under the
/// laws of the library, with the options of [`roll_with`]. A user-defined couple is an error, since it is a function
/// of the inclination of an axis, which a stone has not.
///
/// ```
/// use spincyl::{Ellipsoid, contact::Friction, custom::{self, Custom}, motion::Ask};
///
/// let egg = Ellipsoid::egg(1.0, 1.4, 0.0)?;
/// let (start, ask) = (egg.spinning(5.0, 0.3, 0.0), Ask::on(Friction::coulomb(0.4)));
/// let stribeck = |speed: f64| 0.2 + 0.2 * (-(speed / 0.1).powi(2)).exp();
/// let laws = Custom::default().with_friction(&stribeck);
/// let motion = custom::roll_stone(&egg, start, &[0.0, 5.0], &ask, laws, || true)?.expect("not interrupted");
/// assert!(motion.path.unwrap().heat > 0.0);
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// Those of [`stone::roll`]; with a law of friction also those of [`roll_with`] for this law; `OutOfRange` for a
/// user-defined couple.
///
/// [`stone::roll`]: crate::stone::roll
pub fn roll_stone(
    stone: &Ellipsoid,
    start: impl Into<Start<StoneState>>,
    times: &[f64],
    ask: &Ask,
    custom: Custom<'_>,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<Motion<StoneState>>, Error> {
    let start = start.into();
    custom.check_friction(ask.table.mu())?;
    let found = stone_followed(stone, &start, times, (ask, custom), &RefCell::default(), &mut go_on)?;
    Ok(Motion::from(found).advanced(start.time))
}

/// The motion of [`roll_stone`], whose law has been checked; `recorded` is as in [`followed`](stone::followed).
pub(crate) fn stone_followed(
    stone: &Ellipsoid,
    start: &Start<StoneState>,
    times: &[f64],
    (ask, custom): (&Ask, Custom<'_>),
    recorded: &RefCell<Recorded>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Followed<StoneState>, Error> {
    if custom.friction.is_some() {
        check_options(ask, &custom)?;
    }
    for (name, is_there) in [("couple", custom.couple.is_some()), ("drive", custom.drive.is_some())] {
        if is_there {
            let expected = "no user-defined couple or drive for a stone, which has no axis of symmetry";
            return Err(Error::OutOfRange { name, value: f64::NAN, expected });
        }
    }
    let (mut ask, fault) = (on_own_table(ask, &custom), Cell::new(None));
    if ask.method == Method::Exact && custom.friction.is_some() {
        ask.method = Method::Tolerance(CUSTOM_TOLERANCE);
    }
    let own = custom.friction.map(|law| OwnFriction { law, fault: &fault });
    let mut go_on = || !custom.has_failed() && go_on();
    stone::followed(stone, start, times, (&ask, own), recorded, &mut go_on)
}

/// These options with the coefficient of sliding friction that the user-defined law has at speed 0.
fn on_own_table(ask: &Ask, custom: &Custom<'_>) -> Ask {
    let mut ask = *ask;
    if let (Some(law), Table::Rubs(Friction::Coulomb { mu, fixed, .. })) = (custom.friction, &mut ask.table) {
        *mu = law.coefficient(0.0);
        // The static coefficient may be smaller by rounding.
        *fixed = fixed.max(*mu);
    }
    ask
}

/// The motion of [`roll_with`], whose laws have been checked. Its error is NaN unless `is_judged`: then a second run
/// shows it.
pub(crate) fn followed(
    body: &Body,
    start: &Start,
    times: &[f64],
    (ask, is_judged): (&Ask, bool),
    custom: Custom<'_>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Followed, Error> {
    let told = body;
    let (seen, start) = start.seen_on(body);
    let (body, start) = (&seen, &start);
    let origin = start.time;
    let tol = check(body, start, ask, &custom)?;
    check_times_after(start.time, times)?;
    let (ask, start) = without_friction(body, ask, start);
    let ask = on_own_table(&ask, &custom);
    on_slope(&ask, &start, times, |start, times, ask, pace| {
        let couple = custom.couple.map(|law| AtPace { law, pace });
        let friction = custom.friction.map(|law| AtPace { law, pace });
        let drive = custom.drive.map(|law| AtPace { law, pace });
        let custom = Custom {
            couple: couple.as_ref().map(|law| law as &dyn CoupleLaw),
            friction: friction.as_ref().map(|law| law as &dyn FrictionLaw),
            drive: drive.as_ref().map(|law| law as &dyn DriveLaw),
        };
        let fault = Cell::new(None);
        let mut go_on = || !custom.has_failed() && go_on();
        let (last, driven, since) = (Cell::new(([f64::NAN; 5], None)), Cell::new(None), pace * origin);
        let mut run = |run_tol: f64, times: &[f64]| {
            let over = Cell::new(body.view().over);
            driven.set(None);
            let own = OwnLaws {
                body: told,
                over: &over,
                custom,
                fault: &fault,
                last: &last,
                since,
                driven: &driven,
            };
            let walk = BodyWalk::<CUSTOM_NUMBERS, _>::of_laws(body, ask, (run_tol, tol), times, start, own)?;
            let made = Box::new(walk).run(&mut go_on)?;
            match fault.take().filter(|_| !custom.has_failed()) {
                Some(fault) => Err(fault),
                None => Ok(made),
            }
        };
        if is_judged {
            return judged(tol, times, run);
        }
        let mut found = run(tol, times)?;
        found.motion.error = f64::NAN;
        Ok(found)
    })
}

/// Checks the body, the start and the options of a motion under user-defined laws. Returns the tolerance of its
/// steps.
fn check(body: &Body, start: &Start, ask: &Ask, custom: &Custom<'_>) -> Result<f64, Error> {
    check_options(ask, custom)?;
    if custom.drive.is_some() {
        check_drive(body, start, ask)?;
    }
    let tol = body::check_walk(body, start, ask)?;
    Ok(if ask.method == Method::Exact { CUSTOM_TOLERANCE } else { tol })
}

/// Whether a loss law can hold a body at rest, which excludes a drive.
fn is_held_by(law: Law) -> bool {
    matches!(law, Law::DryContour | Law::Drilling | Law::RollingResistance)
}

/// Returns an error for a start or options that a user-defined drive excludes.
fn check_drive(body: &Body, start: &Start, ask: &Ask) -> Result<(), Error> {
    let refuse = |name: &'static str, value: f64, expected: &'static str| {
        Err(Error::OutOfRange { name, value, expected })
    };
    let held = ask.losses.iter().find(|(law, coefficient)| is_held_by(*law) && *coefficient != 0.0);
    match () {
        () if ask.table == Table::Smooth => refuse(
            "contact",
            f64::NAN,
            "rolling or a law of friction, not a smooth table, for a motion with a drive",
        ),
        () if let Some((_, coefficient)) = held => refuse(
            "losses",
            coefficient,
            "no dry friction along the contour, drilling friction or rolling resistance, with a drive",
        ),
        () if ask.table.friction().patch() > 0.0 => {
            refuse("patch", ask.table.friction().patch(), "0 for a motion with a drive")
        }
        () if body::on_face(body, &start.state) => refuse(
            "theta",
            start.state.theta,
            "a body that stands on a rim, not on its face, for a motion with a drive",
        ),
        () => Ok(()),
    }
}

/// Returns an error for options that user-defined laws exclude.
pub(crate) fn check_options(ask: &Ask, custom: &Custom<'_>) -> Result<(), Error> {
    let refuse = |name: &'static str, value: f64| {
        Err(Error::OutOfRange { name, value, expected: "0 or false together with a user-defined law" })
    };
    let patch = ask.table.friction().patch();
    if patch > 0.0 && custom.friction.is_some() {
        let expected = "0 together with a user-defined law of friction";
        return Err(Error::OutOfRange { name: "patch", value: patch, expected });
    }
    if ask.impact_law.turns_back() && custom.friction.is_some() {
        return refuse("tangential", ask.impact_law.tangential());
    }
    if ask.beyond {
        return refuse("beyond", 1.0);
    }
    within("turning", ask.turning, (0.0, 0.0), "0 together with a user-defined law")?;
    if custom.friction.is_some() && !matches!(ask.table, Table::Rubs(Friction::Coulomb { .. })) {
        let expected =
            "Coulomb friction, whose coefficient of sliding friction the user-defined law replaces";
        return Err(Error::OutOfRange { name: "contact", value: f64::NAN, expected });
    }
    Ok(())
}
