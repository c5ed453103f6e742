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

mod ask;
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
use crate::contact::{Contact, Force, Table, force};
use crate::error::{Error, room};
use crate::exact::{self, Swing};
use crate::number::larger;
use crate::pose::Pose;
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
use nalgebra::{UnitQuaternion, Vector3};
use path::Path;
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
    /// Slip, phases and what has been lost, on a table with a law of friction or with losses.
    pub path: Option<Box<Path>>,
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
            path: None,
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

    /// The orientation at each time, if poses were wanted: of the body as it was at the start, whichever rim it is on.
    pub fn orientations(&self) -> impl Iterator<Item = UnitQuaternion<f64>> {
        // seen from its other rim a body is turned about its own first axis
        let over = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI);
        let turned = |i: usize| self.path.as_ref().is_some_and(|path| path.turned[i]);
        let poses = self.poses.iter().flatten().zip(&self.states).enumerate();
        poses.map(move |(i, (pose, y))| {
            let found = pose.orientation(y);
            if turned(i) { found * over } else { found }
        })
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
    let time = times.first().copied().filter(|t| t.is_finite()).unwrap_or(0.0); // so that it is `t` that is refused
    let start = Start { time, ..Start::from(start) };
    roll_with(body, start, times, &Ask::default(), || true).map(|m| m.expect("nobody interrupts"))
}

/// The motion of `body` from a start at the `times`, in order and on one side of it (with a law of friction or losses: not before
/// it); a [`State`] is a start at time 0 without a slip. `ask` chooses the table, the losses, the method and what is wanted.
///
/// `go_on` is asked about fifty times a second; if it says no, the answer is `Ok(None)`. Errors, all before
/// any work: `OutOfRange` for a body, state, slip, time, step, tolerance or coefficient that makes no sense; `Step` for
/// a fixed step under which fast precession or nutation would come out wrong unnoticed; `Painleve` for a start without a unique
/// contact force. At any time `Memory`, if there is too little for so many times; of what slips or loses energy also those of
/// [`path`].
///
/// ```
/// use spincyl::{Body, State, contact::Friction, motion::{Ask, Start, roll_with}};
///
/// // a hoop thrown with backspin: it slips for (v + w)/(2 mu), and comes back if w > v
/// let hoop = Body::tube(0.0, 1.0)?;
/// let state = State { theta: std::f64::consts::FRAC_PI_2, w1: 0.0, w2: 0.0, w3: -3.0 };
/// let start = Start { slip: [0.0, 2.0 + 3.0], ..state.into() };
/// let motion = roll_with(&hoop, start, &[0.0, 20.0], &Ask::on(Friction::coulomb(0.25)), || true)?.expect("not interrupted");
/// assert!((motion.states[1].w3 - -0.5).abs() < 1e-12); // it rolls back
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

/// The same, compiled once: here.
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

/// A motion by the first integrals, or by an integrator that is judged by them.
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
    limits::first_event(swing, &Limits::new(swing.body(), &Table::of(swing.contact(), mu)), 1.0)
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
    let (limits, angle) = (Limits::new(body, &Table::of(contact, mu)), y.theta.sin_cos());
    let rate = limits.rates.derivative(y, angle);
    Begun { angle, rate, over: limits.at_start_of(y, &rate, angle, way) }
}
