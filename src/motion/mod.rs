//! Motions: times, states, and the event that ends a motion.
//!
//! [`roll`] uses the first integrals ([`exact`]) unless the caller asks for an integrator; an integrator also replaces
//! the first integrals where these lose all their digits. Either way the assumptions of the model are watched:
//!
//! ```text
//! theta > 0                 the face lands         theta < pi/2    the other rim lands (ell > 0)
//! N > 0                     contact is kept        F <= mu N       rolling is kept, if a mu is given
//! ```
//! The first assumption that fails is the [`Event`] that ends the motion; states after the event are given only if the
//! caller asks for them.

mod ask;
mod exactly;
mod extent;
mod guard;
pub(crate) mod halt;
mod integrator;
pub(crate) mod judge;
pub(crate) mod leaving;
mod limits;
pub(crate) mod lossy;
mod moving;
pub mod path;
mod settled;
pub(crate) mod slide;
mod stepped;

use crate::body::Body;
use crate::codes::coded;
use crate::contact::{Contact, Table, force};
use crate::error::{Error, room};
use crate::exact::{self, Swing};
use crate::number::larger;
use crate::state::State;
pub use ask::{Ask, Method, Start};
pub(crate) use ask::{check, check_flow, check_times_after};
use core::f64::consts::PI;
#[cfg(target_arch = "wasm32")]
pub(crate) use exactly::exactly;
use exactly::{follow, quickly};
pub(crate) use extent::{extremes, extremes_of};
use guard::{Guard, guard};
use integrator::{Course, Stepping};
use judge::doubted;
use limits::Limits;
pub use moving::Moving;
use nalgebra::{UnitQuaternion, Vector3};
use path::Path;
use stepped::stepped;

coded! {
    /// The end of a motion. Its number is the status of a result.
    pub enum Ending {
        /// The motion reached the last time asked for.
        Done = 0,
        /// The face landed on the table (theta = 0 or pi). The body may still spin on its face, with the last w3; that spin is
        /// not followed.
        Face = 1,
        /// The other rim landed: the body lies on its side (theta = pi/2, ell > 0).
        Side = 2,
        /// The normal force vanished.
        LiftOff = 3,
        /// Rolling needed more friction than mu N.
        Slip = 4,
        /// No contact force, or more than one, obeys the law of friction.
        Painleve = 6,
        /// The contact point stops, held by dry friction along the rim or by rolling resistance.
        Stops = 7,
        /// The motion was given up at this time: slipping and rolling alternate too often, or it hardly advances.
        Bounded = 8,
    }
}

/// The point at which a motion leaves the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event<S = State> {
    /// The kind of the event.
    pub ending: Ending,
    /// The time of the event.
    pub time: f64,
    /// The state at the event.
    pub state: S,
}

/// Times and states of a body, and the event that ended its motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion<S: Moving = State> {
    /// The times asked for, up to the event.
    pub times: Vec<f64>,
    /// The state at each time.
    pub states: Vec<S>,
    /// The pose at each time, if poses were asked for.
    pub poses: Option<Vec<S::Pose>>,
    /// The contact force at each time, if forces were asked for.
    pub forces: Option<Vec<S::Force>>,
    /// The first event that the model does not cover, if one happened before the last time.
    pub event: Option<Event<S>>,
    /// The method that found the motion: `Exact`, `Step` or `Tolerance`.
    pub method: Method,
    /// Estimated error: the largest over all numbers of all states, and over the time and the state of the event.
    pub error: f64,
    /// Estimated error of the poses: the largest over all of their numbers; NaN without poses.
    pub pose_error: f64,
    /// Estimated error of the contact forces per weight: the largest over all of their numbers; NaN without forces.
    pub force_error: f64,
    /// Predicted share of the nutation's amplitude that a fixed step takes away; 0 with the other methods.
    pub step_loss: f64,
    /// A fixed step that takes away less than a thousandth of the amplitude; infinite with the other methods.
    pub advice: f64,
    /// Whether the loss of amplitude, the nutation or the precession makes the fixed step questionable.
    pub coarse: bool,
    /// Number of evaluations of the equations of motion.
    pub evaluations: u64,
    /// Slip, phases and lost energy, on a table with a law of friction or for a body with losses.
    pub path: Option<Box<Path<S>>>,
}

impl<S: Moving> Motion<S> {
    /// An empty motion with room for `count` outputs.
    pub(crate) fn empty(count: usize, pose: bool) -> Result<Self, Error> {
        Ok(Self {
            times: Vec::new(),
            states: room(count)?,
            poses: pose.then(|| room(count)).transpose()?,
            forces: None,
            event: None,
            method: Method::Exact,
            error: 0.0,
            pose_error: if pose { 0.0 } else { f64::NAN },
            force_error: f64::NAN,
            step_loss: 0.0,
            advice: f64::INFINITY,
            coarse: false,
            evaluations: 0,
            path: None,
        })
    }

    /// Drops the outputs at times farther than `limit` from the start.
    fn keep(&mut self, t0: f64, limit: f64) {
        let kept = self.times.partition_point(|t| (t - t0).abs() <= limit);
        self.times.truncate(kept);
        self.states.truncate(kept);
        if let Some(poses) = &mut self.poses {
            poses.truncate(kept);
        }
    }

    /// The ending of the motion; `Done` without an event.
    pub fn ending(&self) -> Ending {
        self.event.map_or(Ending::Done, |e| e.ending)
    }
}

impl Motion {
    /// The orientation at each time, if poses were asked for. It refers to the body's axes at the start, on either rim.
    pub fn orientations(&self) -> impl Iterator<Item = UnitQuaternion<f64>> {
        // A pose on the other rim describes the body after a half turn about its own first axis.
        let over = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI);
        let turned = |i: usize| self.path.as_ref().is_some_and(|path| path.turned[i]);
        let poses = self.poses.iter().flatten().zip(&self.states).enumerate();
        poses.map(move |(i, (pose, y))| {
            let found = pose.orientation(y);
            if turned(i) { found * over } else { found }
        })
    }
}

/// Tolerance of the integrator that replaces a missing exact solution.
const FALLBACK: f64 = 1e-12;

/// The motion of `body`, which rolls from `start` at the first of the `times`, up to the event that ends it.
///
/// The method is exact, without poses or forces; [`roll_with`] offers the other choices and has the same errors.
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
pub fn roll(body: &Body, start: &State, times: &[f64]) -> Result<Motion, Error> {
    let time = times.first().copied().filter(|t| t.is_finite()).unwrap_or(0.0); // The check then names `t`, not `t0`.
    let start = Start { time, ..Start::from(start) };
    roll_with(body, start, times, &Ask::default(), || true).map(|m| m.expect("nobody interrupts"))
}

/// The motion of `body` from a start at the `times`, which are in order and on one side of the start; with a law of
/// friction or losses no time lies before the start. A [`State`] is a start at time 0 without a slip. `ask` chooses the
/// table, the losses, the method and the outputs.
///
/// `go_on` is called about fifty times a second; if it returns false, the result is `Ok(None)`. Errors before any work:
/// `OutOfRange` for a body, state, slip, time, step, tolerance or coefficient that makes no sense; `Step` for a fixed
/// step with which fast precession or nutation would come out wrong unnoticed; `Painleve` for a start without a unique
/// contact force. Errors at any time: `Memory` if there is too little memory for the outputs; for a body that slips or
/// loses energy also the errors of [`path`].
///
/// ```
/// use spincyl::{Body, State, contact::Friction, motion::{Ask, Start, roll_with}};
///
/// // A hoop is thrown with backspin: it slips for a time (v + w)/(2 mu), and comes back if w > v.
/// let hoop = Body::tube(0.0, 1.0)?;
/// let state = State { theta: std::f64::consts::FRAC_PI_2, w1: 0.0, w2: 0.0, w3: -3.0 };
/// let start = Start { slip: [0.0, 2.0 + 3.0], ..state.into() };
/// let motion = roll_with(&hoop, start, &[0.0, 20.0], &Ask::on(Friction::coulomb(0.25)), || true)?.expect("not interrupted");
/// assert!((motion.states[1].w3 - -0.5).abs() < 1e-12); // the hoop rolls back
/// let path = motion.path.expect("there is friction");
/// assert!((path.phases[1].time - 5.0 / 0.5).abs() < 1e-12);
/// # Ok::<(), spincyl::Error>(())
/// ```
pub fn roll_with(
    body: &Body,
    start: impl Into<Start>,
    times: &[f64],
    ask: &Ask,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    rolled(body, &start.into(), times, ask, &mut go_on)
}

/// Does the work of [`roll_with`] without generic parameters, so that this code is compiled only once.
fn rolled(
    body: &Body,
    start: &Start,
    times: &[f64],
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    if !ask.conserves() {
        return path::follow(body, start, times, ask, go_on);
    }
    path::without_slip(start.slip)?;
    conserved(body, start, times, ask, go_on)
}

/// The motion of a body that conserves energy, by the first integrals or by an integrator that is judged by them.
fn conserved(
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

/// The first event of an exact motion that the model does not cover, from time 0 on; `mu` is the coefficient of
/// friction of a body that rolls.
///
/// ```
/// use spincyl::{Body, Contact, exact::Swing, motion, steady};
///
/// let body = Body::solid(2.5)?;
/// let swing = Swing::new(&body, &steady::state(&body, 1.3)?.kicked(0.05), Contact::Rolling, false)?;
/// assert_eq!(motion::first_event(&swing, f64::INFINITY), None);
/// assert_eq!(motion::first_event(&swing, 0.0).unwrap().time, 0.0); // the body does not roll on ice
/// # Ok::<(), spincyl::Error>(())
/// ```
pub fn first_event(swing: &Swing, mu: f64) -> Option<Event> {
    limits::first_event(swing, &Limits::new(swing.body(), &Table::of(swing.contact(), mu)), 1.0)
}

/// Adds the contact force at each state to the motion.
fn pressed(
    mut motion: Motion,
    contact: Contact,
    body: &Body,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    let (mut forces, mut doubt) = (room(motion.states.len())?, 0.0);
    for some in motion.states.chunks(1024) {
        if !go_on() {
            return Ok(None);
        }
        for y in some {
            let (force, off) = doubted(y, [motion.error; 2], |y| force(contact, body, y));
            forces.push(force);
            doubt = larger(doubt, off);
        }
    }
    (motion.forces, motion.force_error) = (Some(forces), doubt);
    Ok(Some(motion))
}

/// The start of a motion: sine and cosine of theta, the rate of the state, and the ending if the motion ends there.
pub(crate) struct Begun {
    pub angle: (f64, f64),
    pub rate: State,
    pub over: Option<Ending>,
}

/// The start of a body's motion, where `way` is the direction of time.
pub(crate) fn begun(body: &Body, contact: Contact, mu: f64, y: &State, way: f64) -> Begun {
    let (limits, angle) = (Limits::new(body, &Table::of(contact, mu)), y.theta.sin_cos());
    let rate = limits.rates.derivative(y, angle);
    Begun { angle, rate, over: limits.at_start_of(y, &rate, angle, way) }
}
