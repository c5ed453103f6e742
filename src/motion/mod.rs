//! A body on its way: times, states, and how it ended.
//!
//! [`roll`] answers by the first integrals ([`exact`]) unless an integrator is asked for,
//! and by an integrator where these lose all their digits. Either way it watches what the model assumes:
//!
//! ```text
//! theta > 0                 the face lands         theta < pi/2    the other rim lands (ell > 0)
//! N > 0                     contact is kept        F <= mu N       rolling is kept, if a mu is given
//! ```
//! The first of these to fail is the [`Event`] that ends the motion; what would come after is given only if
//! asked for.

mod exactly;
mod extent;
pub(crate) mod flow;
mod guard;
mod integrator;
mod judge;
mod leaving;
mod limits;
pub(crate) mod lossy;
pub mod path;
mod settled;
pub(crate) mod slide;
mod stepped;

use crate::body::Body;
use crate::contact::{Contact, Force, force};
use crate::error::{Error, room, within};
use crate::exact::{self, Swing};
use crate::number::larger;
use crate::pose::Pose;
use crate::state::State;
#[cfg(target_arch = "wasm32")]
pub(crate) use exactly::exactly;
use exactly::{follow, quickly};
pub(crate) use extent::{extremes, extremes_of};
use guard::{Guard, guard};
use integrator::{Course, Stepping};
use judge::doubted;
use limits::Limits;
use stepped::stepped;

/// How a motion ended. The number is the status of a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Ending {
    /// It reached the last time asked for.
    Done = 0,
    /// The face landed on the table (theta = 0 or pi).
    Face = 1,
    /// The other rim landed: the body lies on its side (theta = pi/2, ell > 0).
    Side = 2,
    /// The normal force vanished.
    LiftOff = 3,
    /// Rolling needed more friction than mu N.
    Slip = 4,
    /// No contact force, or more than one, obeys the law of friction.
    Painleve = 6,
    /// The contact point stops: dry friction along the rim, or rolling resistance, holds it.
    Stops = 7,
}

/// Where a motion left the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// What happened.
    pub ending: Ending,
    /// When.
    pub time: f64,
    /// The state then.
    pub state: State,
}

/// How a motion is found.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Method {
    /// By the first integrals; where these lose all their digits, within a tolerance.
    #[default]
    Exact,
    /// RK4 with this fixed step.
    Step(f64),
    /// RK4 whose steps are chosen so that each errs by less than this.
    Tolerance(f64),
}

/// What is asked of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ask {
    /// Rolling, or a smooth table.
    pub contact: Contact,
    /// How it is found.
    pub method: Method,
    /// Coefficient of friction; infinite: rolling is never given up.
    pub mu: f64,
    /// Whether to go on beyond an event (never beyond a landing of the face).
    pub beyond: bool,
    /// Whether poses are wanted.
    pub pose: bool,
    /// Whether contact forces are wanted.
    pub force: bool,
}

impl Default for Ask {
    fn default() -> Self {
        Self {
            contact: Contact::Rolling,
            method: Method::Exact,
            mu: f64::INFINITY,
            beyond: false,
            pose: false,
            force: false,
        }
    }
}

/// Times and states of a body, and how its motion ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The times asked for, up to the event.
    pub times: Vec<f64>,
    /// The state at each.
    pub states: Vec<State>,
    /// The pose at each, if wanted.
    pub poses: Option<Vec<Pose>>,
    /// The contact force at each, if wanted.
    pub forces: Option<Vec<Force>>,
    /// The first thing that the model does not cover, if it happened before the last time.
    pub event: Option<Event>,
    /// What found it: `Exact`, `Step` or `Tolerance`.
    pub method: Method,
    /// Estimated error: the largest of any number of any state, and of the event's time and state.
    pub error: f64,
    /// The same of the poses, NaN if none.
    pub pose_error: f64,
    /// The same of the numbers of every contact force, per weight; NaN if none.
    pub force_error: f64,
    /// Share of the nutation's amplitude that a fixed step takes from it, as predicted; 0 of the others.
    pub step_loss: f64,
    /// A fixed step that loses less than a thousandth; infinite if none was looked for.
    pub advice: f64,
    /// Whether that or the precession makes the step questionable.
    pub coarse: bool,
    /// Evaluations of the equations of motion.
    pub evaluations: u64,
}

impl Motion {
    /// Nothing yet, with room for so many times.
    fn empty(count: usize, pose: bool) -> Result<Self, Error> {
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
        })
    }

    /// What lies within `limit` of the start.
    fn keep(&mut self, t0: f64, limit: f64) {
        let kept = self.times.partition_point(|t| (t - t0).abs() <= limit);
        self.times.truncate(kept);
        self.states.truncate(kept);
        if let Some(poses) = &mut self.poses {
            poses.truncate(kept);
        }
    }

    /// How it ended.
    pub fn ending(&self) -> Ending {
        self.event.map_or(Ending::Done, |e| e.ending)
    }
}

/// Where there is no exact solution, an integrator answers within this.
const FALLBACK: f64 = 1e-12;

/// The motion of `body`, rolling from `start` at the first of the `times`, up to whatever ends it.
///
/// Exact, without poses or forces; [`roll_with`] has the choices. Errors: as there.
///
/// ```
/// use spincyl::{Body, roll, steady};
///
/// let body = Body::solid(2.5)?;
/// let start = steady::state(&body, 1.3)?.kicked(0.05); // theta' = 0.05: it nutates
/// let motion = roll(&body, &start, &[0.0, 10.0, 20.0])?;
/// assert_eq!((motion.states[0], motion.event), (start, None));
/// assert!(motion.error < 1e-12); // by its own estimate
/// # Ok::<(), spincyl::Error>(())
/// ```
pub fn roll(body: &Body, start: &State, times: &[f64]) -> Result<Motion, Error> {
    let t0 = times.first().copied().filter(|t| t.is_finite()).unwrap_or(0.0); // so that it is `t` that is refused
    roll_with(body, start, t0, times, &Ask::default(), || true).map(|m| m.expect("nobody interrupts"))
}

/// The motion of `body` from `start` at time `t0`, at the `times`, in order and on one side of `t0`; `scene`
/// chooses the contact, the method and what is wanted.
///
/// `go_on` is asked about fifty times a second; if it says no, the answer is `Ok(None)`. Errors, all before
/// any work: `OutOfRange` for a body, state, time, step, tolerance or mu that makes no sense; `Step` for
/// a fixed step under which fast precession or nutation would come out wrong unnoticed. At any time `Memory`,
/// if there is too little for so many times.
pub fn roll_with(
    body: &Body,
    start: &State,
    t0: f64,
    times: &[f64],
    scene: &Ask,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    rolled(body, start, t0, times, scene, &mut go_on)
}

/// The same, compiled once: here.
fn rolled(
    body: &Body,
    start: &State,
    t0: f64,
    times: &[f64],
    scene: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    exact::check(body, start)?;
    let span = check(scene, t0, times)?;
    if let Some(motion) = quickly(body, start, t0, times, scene)? {
        return Ok(Some(motion));
    }
    let way = if span < 0.0 { -1.0 } else { 1.0 };
    let swing = Swing::new(body, start, scene.contact, scene.pose).ok();
    let limits = Limits::new(body, scene.contact, scene.mu);
    let swing = swing.as_ref();
    let exact = swing.filter(|s| s.error(span).is_finite());
    let course = Course { start, span, times, t0, pose: scene.pose, unguarded: swing.is_none() };
    let stepping = match scene.method {
        Method::Step(step) => Some(Stepping::Fixed(way * step.abs())),
        Method::Tolerance(tol) => Some(Stepping::Within(tol)),
        Method::Exact => None,
    };
    let guarded = match scene.method {
        Method::Step(step) => guard(&course, swing, &limits, step.abs())?,
        _ => Guard::default(),
    };
    let found = match (stepping, exact) {
        (None, Some(swing)) => follow(swing, &course, &limits, scene.beyond, go_on)?,
        _ => {
            let stepping = stepping.unwrap_or(Stepping::Within(FALLBACK));
            stepped(body, &course, swing, &limits, stepping, scene, go_on)?
        }
    };
    let Some(mut motion) = found else { return Ok(None) };
    (motion.step_loss, motion.advice, motion.coarse) = (guarded.loss, guarded.advice, guarded.coarse);
    if scene.force {
        return pressed(motion, scene.contact, body, go_on);
    }
    Ok(Some(motion))
}

/// The first thing on the way of an exact motion that the model does not cover, from time 0 on; rolling with the coefficient of
/// friction `mu`.
///
/// ```
/// use spincyl::{Body, Contact, exact::Swing, motion, steady};
///
/// let body = Body::solid(2.5)?;
/// let swing = Swing::new(&body, &steady::state(&body, 1.3)?.kicked(0.05), Contact::Rolling, false)?;
/// assert_eq!(motion::first_event(&swing, f64::INFINITY), None);
/// assert_eq!(motion::first_event(&swing, 0.0).unwrap().time, 0.0); // it does not roll on ice
/// # Ok::<(), spincyl::Error>(())
/// ```
pub fn first_event(swing: &Swing, mu: f64) -> Option<Event> {
    limits::first_event(swing, &Limits::new(swing.body(), swing.contact(), mu), 1.0)
}

/// The motion with the contact force at each state.
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

/// What a motion is at its start: sine and cosine of theta, how the state changes, and the end if it is over there.
pub(crate) struct Begun {
    pub angle: (f64, f64),
    pub rate: State,
    pub over: Option<Ending>,
}

/// The same of a body, `way` being the direction of time.
pub(crate) fn begun(body: &Body, contact: Contact, mu: f64, y: &State, way: f64) -> Begun {
    let (limits, angle) = (Limits::new(body, contact, mu), y.theta.sin_cos());
    let rate = limits.rates.derivative(y, angle);
    Begun { angle, rate, over: limits.at_start_of(y, &rate, angle, way) }
}

/// Refuses what makes no sense for any body; the span from the start to the last time, signed.
pub(crate) fn check(scene: &Ask, t0: f64, times: &[f64]) -> Result<f64, Error> {
    within("mu", scene.mu, (0.0, f64::INFINITY), "0 <= mu")?;
    let span = check_times(t0, times)?;
    check_method(scene.method, span)?;
    Ok(span)
}

/// From the start to the last time, signed.
fn check_times(t0: f64, times: &[f64]) -> Result<f64, Error> {
    within("t0", t0, (-1e15, 1e15), "|t0| <= 1e15")?;
    let expected = "at least one time, in order, on one side of the start, |t| <= 1e15";
    let &last = times.last().ok_or(Error::OutOfRange { name: "t", value: f64::NAN, expected })?;
    let way = if last < t0 { -1.0 } else { 1.0 };
    let mut before = 0.0;
    for &t in times {
        let since = way * (t - t0);
        if !(since >= before && t.abs() <= 1e15) {
            return Err(Error::OutOfRange { name: "t", value: t, expected });
        }
        before = since;
    }
    Ok(last - t0)
}

fn check_method(method: Method, span: f64) -> Result<(), Error> {
    match method {
        Method::Step(step) => {
            let expected = "a step of the sign of time, |step| >= 1e-15 of the span and 1e-12 or more";
            let named = |ok: bool| {
                if ok { Ok(()) } else { Err(Error::OutOfRange { name: "step", value: step, expected }) }
            };
            named(step.abs() >= 1e-12 && step.is_finite() && span.abs() / step.abs() <= 1e15)?;
            named(step > 0.0 || span <= 0.0)
        }
        Method::Tolerance(tol) => within("tol", tol, (1e-14, 1e-1), "1e-14 <= tol <= 0.1").map(|_| ()),
        Method::Exact => Ok(()),
    }
}
