//! Motions: states at given times, and the event that ends a motion.
//!
//! [`roll`] uses the first integrals ([`exact`](super::exact)) unless [`Ask`] chooses an integrator; an integrator also
//! replaces the first integrals where these lose all their digits. In both cases the assumptions of the model are
//! checked along the motion:
//!
//! ```text
//! theta > 0                 the face lands         theta < pi/2    the other rim lands (ell > 0)
//! N > 0                     contact is kept        F <= mu N       rolling is kept, if a mu is given
//! ```
//! The first assumption that fails is the [`Event`] that ends the motion; states after the event are computed only with
//! [`Ask::beyond`].
//!
//! ```
//! use spincyl::motion::{Ask, roll_with};
//! use spincyl::{Body, steady};
//!
//! // In a steady state the axis goes round at a constant rate.
//! let body = Body::solid(2.5)?;
//! let (start, ask) = (steady::state(&body, 1.3)?, Ask::default().with_pose());
//! let motion = roll_with(&body, start, &[0.0, 10.0], &ask, || true)?.expect("not interrupted");
//! let poses = motion.poses.expect("they are wanted");
//! assert!((poses[1].phi.radians() - 10.0 * start.precession()).abs() < 1e-10);
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::exact::Swing;
pub use super::{
    AboveTable, Ask, Bounds, Ending, Event, Limit, Method, Motion, Moving, RestsOn, Sample, Start,
    body as path,
};
use crate::error::Error;
use crate::laws::body::Body;
use crate::laws::contact::{Contact, Table};
use crate::laws::state::State;
use crate::motions::exact::event::{self, Limits};
use crate::motions::exact::method::conserved;
use crate::motions::slope::check_slope;

/// Computes the rolling motion of `body` from the state `start` at the first of the `times`, up to the event that
/// ends the motion.
///
/// The times are in sqrt(R/g). The method is that of the first integrals, exact up to rounding. Poses and forces are
/// not computed; [`roll_with`] has these and all other options.
///
/// ```
/// use spincyl::{Body, roll, steady};
///
/// let body = Body::solid(2.5)?;
/// let start = steady::state(&body, 1.3)?.kicked(0.05); // theta' = 0.05: the body nutates
/// let motion = roll(&body, &start, &[0.0, 10.0, 20.0])?;
/// assert_eq!((motion.states[0], motion.event), (start, None));
/// assert!(motion.error < 1e-12); // the motion estimates its own error
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// Those of [`roll_with`].
pub fn roll(body: &Body, start: &State, times: &[f64]) -> Result<Motion, Error> {
    // For a first time that is not finite the error has to name `t`, not `t0`.
    let time = times.first().copied().filter(|t| t.is_finite()).unwrap_or(0.0);
    let start = Start::from(start).with_time(time);
    roll_with(body, start, times, &Ask::default(), || true).map(|m| m.expect("nobody interrupts"))
}

/// Computes the motion of `body` from a [`Start`] at the `times`, in sqrt(R/g). A [`State`] is a start at time 0 without
/// a slip. The times are in order and all after or all before the initial time; with a law of friction or losses they
/// are not before it. `ask` chooses the contact, the losses, the method and the outputs.
///
/// `go_on` is called about fifty times per second of computing. If it returns false, the motion ends there with
/// [`Ending::Bounded`] and [`Limit::Interrupted`], and its error is infinite unless the first integrals show it; the
/// result is `Ok(None)` if the motion has not advanced.
///
/// ```
/// use spincyl::{Body, Slip, State, contact::Friction, motion::{Ask, Start, roll_with}};
///
/// // A hoop is thrown with backspin: it slips for a time (v + w)/(2 mu), and comes back if w > v.
/// let hoop = Body::tube(0.0, 1.0)?;
/// let state = State { theta: std::f64::consts::FRAC_PI_2, w1: 0.0, w2: 0.0, w3: -3.0 };
/// let start = Start::from(state).with_slip(Slip::new(0.0, 2.0 + 3.0));
/// let ask = Ask::on(Friction::coulomb(0.25));
/// let motion = roll_with(&hoop, start, &[0.0, 20.0], &ask, || true)?.expect("not interrupted");
/// assert!((motion.states[1].w3 - -0.5).abs() < 1e-12); // the hoop rolls back
/// let path = motion.path.expect("there is friction");
/// assert!((path.phases[1].time - 5.0 / 0.5).abs() < 1e-12);
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// Before the motion is computed: `OutOfRange` for a body, state, slip, time, step, tolerance or coefficient out of
/// range; `Step` for a fixed step that is too long for fast precession or nutation; `Painleve` for an initial state
/// without a unique contact force. At any time: `Memory` if the memory does not suffice for the outputs; for a body
/// that slips or loses energy also the errors of [`path::follow`].
pub fn roll_with(
    body: &Body,
    start: impl Into<Start>,
    times: &[f64],
    ask: &Ask,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    rolled(body, &start.into(), times, ask, &mut go_on)
}

/// The work of [`roll_with`] without generic parameters, so that this code is compiled only once.
fn rolled(
    body: &Body,
    start: &Start,
    times: &[f64],
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    check_slope(ask)?;
    start.check_place()?;
    let found = if ask.conserves() && !body.has_joints() && !path::on_face(body, &start.state) {
        path::refuse_slip(start.slip)?;
        let (body, start) = start.seen_on(body);
        conserved(&body, &start, times, ask, go_on)?.told(&body.view()).placed(&start)
    } else {
        path::follow(body, start, times, ask, go_on)?
    };
    let smooth = ask.table == Table::Smooth && ask.restitution.is_none();
    Ok(Motion { smooth, ..found }.advanced(start.time))
}

/// The first event after which an exact motion is not that of the real body, from time 0 on; None if there is none.
/// `mu` is the coefficient of friction of a body that rolls.
///
/// ```
/// use spincyl::{Body, Contact, exact::Swing, motion, steady};
///
/// let body = Body::solid(2.5)?;
/// let swing = Swing::new(&body, &steady::state(&body, 1.3)?.kicked(0.05), Contact::Rolling)?;
/// assert_eq!(motion::first_event(&swing, f64::INFINITY), None);
/// assert_eq!(motion::first_event(&swing, 0.0).unwrap().time, 0.0); // the body does not roll on ice
/// # Ok::<(), spincyl::Error>(())
/// ```
pub fn first_event(swing: &Swing, mu: f64) -> Option<Event> {
    event::first_event(swing, &Limits::new(swing.body(), &Table::of(swing.contact(), mu)), 1.0)
}

/// The initial data of a motion: sine and cosine of theta, the time derivative of the state, and the reason for
/// ending if the motion is over at time 0.
pub(crate) struct InitialData {
    pub angle: (f64, f64),
    pub rate: State,
    pub over: Option<Ending>,
}

/// The initial data of a body's motion, where `way` is the direction of time.
pub(crate) fn begun(body: &Body, contact: Contact, mu: f64, y: &State, way: f64) -> InitialData {
    let (limits, angle) = (Limits::new(body, &Table::of(contact, mu)), y.theta.sin_cos());
    let rate = limits.rates.derivative(y, angle);
    InitialData { angle, rate, over: limits.at_start_of(y, &rate, angle, way) }
}
