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

mod extent;
mod guard;
mod integrator;
mod judge;
mod leaving;
mod limits;
pub mod path;
pub(crate) mod slide;

use crate::body::Body;
use crate::contact::{Contact, Force, force};
use crate::error::{Error, copied, room, within};
use crate::exact::{self, Swing};
use crate::pose::Pose;
use crate::stability::stiffness;
use crate::state::State;
pub(crate) use extent::{extremes, extremes_of};
use guard::{Guard, guard};
use integrator::{Course, Stepping};
use judge::{compare, judge, same};
use limits::{Limits, first_event};

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

/// Up to this error the exact solution says how far an integrator is off.
const DOUBTFUL: f64 = 1e-3;
/// Where there is no exact solution, an integrator answers within this.
const FALLBACK: f64 = 1e-12;
/// An end that an integrator meets is looked at again within smaller tolerances, down to this.
const TIGHTEST: f64 = 1e-13;

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
    let run = |stepping: Stepping, go_on: &mut dyn FnMut() -> bool| {
        integrator::run(&course, &limits, stepping, scene.beyond, go_on)
    };
    let stepping = match scene.method {
        Method::Step(step) => Some(Stepping::Fixed(way * step.abs())),
        Method::Tolerance(tol) => Some(Stepping::Within(tol)),
        Method::Exact => None,
    };
    let guarded = match scene.method {
        Method::Step(step) => guard(&course, swing, &limits, step.abs())?,
        _ => Guard::default(),
    };
    let mut motion = match (stepping, exact) {
        (None, Some(swing)) => {
            let Some(motion) = follow(swing, &course, &limits, scene.beyond, &mut go_on)? else {
                return Ok(None);
            };
            motion
        }
        _ => {
            let stepping = stepping.unwrap_or(Stepping::Within(FALLBACK));
            let judge_by = swing.filter(|s| s.error(span) <= DOUBTFUL);
            let found = judge_by.and_then(|swing| first_event(swing, &limits, way));
            let found = found.filter(|e| e.time.abs() <= span.abs());
            let doubt =
                found.zip(judge_by).map_or(0.0, |(e, swing)| limits.doubt(&e) + swing.time_error(e.time));
            let event = found.map(|e| Event { time: t0 + e.time, ..e });
            let Some(mut motion) = run(stepping, &mut go_on)? else { return Ok(None) };
            // an end that a tighter tolerance does not meet was made by the steps
            let mut tol = match stepping {
                Stepping::Within(tol)
                    if !motion.event.is_some_and(|e| event.is_some_and(|x| same(&e, &x))) =>
                {
                    tol
                }
                _ => 0.0,
            };
            while tol > TIGHTEST && motion.event.is_some() {
                tol = (0.01 * tol).max(TIGHTEST);
                let Some(tighter) = run(Stepping::Within(tol), &mut go_on)? else { return Ok(None) };
                let stands = motion.event.zip(tighter.event).is_some_and(|(a, b)| same(&a, &b));
                if stands {
                    break;
                }
                motion = Motion { method: motion.method, ..tighter };
            }
            if let Some(swing) = judge_by {
                // a coarse integrator can miss an end that the motion has
                if let Some(event) = event.filter(|_| motion.event.is_none()) {
                    motion.event = Some(event);
                    if !scene.beyond || event.ending == Ending::Face {
                        motion.keep(t0, (event.time - t0).abs());
                    }
                }
                judge(&mut motion, swing, event, t0);
                motion.error = motion.error.max(if motion.event.is_some() { doubt } else { 0.0 });
            } else {
                let rough = match stepping {
                    Stepping::Fixed(step) => Stepping::Fixed(2.0 * step),
                    Stepping::Within(tol) => Stepping::Within(32.0 * tol),
                };
                match run(rough, &mut go_on) {
                    Ok(Some(other)) => compare(&mut motion, &other),
                    Ok(None) => return Ok(None),
                    Err(e @ Error::Memory { .. }) => return Err(e),
                    Err(_) => motion.error = f64::INFINITY,
                }
                // where both err by rounding as well, their difference says too little
                if let Stepping::Within(_) = stepping {
                    motion.error *= 4.0;
                    motion.pose_error *= 4.0;
                }
                // two runs can agree on a state that stays where it is unstable: by their rounding, not by
                // the motion
                let growth = (-stiffness(scene.contact, body, start)).max(0.0).sqrt() * span.abs();
                motion.error = motion.error.max(4.0 * f64::EPSILON * growth.exp());
                if scene.pose {
                    motion.pose_error = motion.pose_error.max(motion.error * (1.0 + span.abs()));
                }
            }
            motion
        }
    };
    (motion.step_loss, motion.advice, motion.coarse) = (guarded.loss, guarded.advice, guarded.coarse);
    if scene.force {
        let Some(found) = forces(scene.contact, body, &motion.states, &mut go_on)? else { return Ok(None) };
        motion.forces = Some(found);
    }
    Ok(Some(motion))
}

/// The contact force at each state.
fn forces(
    contact: Contact,
    body: &Body,
    states: &[State],
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Vec<Force>>, Error> {
    let mut forces = room(states.len())?;
    for some in states.chunks(4096) {
        if !go_on() {
            return Ok(None);
        }
        forces.extend(some.iter().map(|y| force(contact, body, y)));
    }
    Ok(Some(forces))
}

/// What the quick way promises to be taken for: as good as the other.
const QUICK: f64 = 2e-12;
/// More times than that are watched over.
const FEW: usize = 1 << 16;

/// The exact motion where it is neither wide nor ended by anything, and no pose is wanted: a tenth of the
/// work.
fn quickly(body: &Body, start: &State, t0: f64, times: &[f64], scene: &Ask) -> Result<Option<Motion>, Error> {
    if scene.method != Method::Exact || scene.pose || times.len() > FEW {
        return Ok(None);
    }
    let mut motion = Motion::empty(times.len(), false)?;
    let mut since = copied(times)?;
    since.iter_mut().for_each(|t| *t -= t0);
    let asked =
        exact::lanes::Asked { contact: scene.contact, body, start, times: &since, mu: scene.mu, tol: QUICK };
    let found = exact::lanes::quick(&asked, &mut motion.states);
    let Some(error) = found else { return Ok(None) };
    if scene.force {
        motion.forces = forces(scene.contact, body, &motion.states, &mut || true)?;
    }
    Ok(Some(Motion { times: copied(times)?, error, ..motion }))
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

/// The states of an exact motion.
fn follow(
    swing: &Swing,
    course: &Course<'_>,
    limits: &Limits,
    beyond: bool,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    let way = if course.span < 0.0 { -1.0 } else { 1.0 };
    let event = first_event(swing, limits, way).filter(|e| e.time.abs() <= course.span.abs());
    let last = match event {
        Some(e) if !beyond || e.ending == Ending::Face => e.time.abs(),
        _ => swing.landing(way).map_or(f64::INFINITY, |(t, _)| t),
    };
    let count = course.times.partition_point(|t| (t - course.t0).abs() <= last);
    let mut motion = Motion::empty(count, course.pose)?;
    motion.event = event.map(|e| Event { time: course.t0 + e.time, ..e });
    let every = (count / 16).max(1);
    let (mut fastest, mut swiftest) = (0.0, 0.0);
    for (i, t) in course.times[..count].iter().enumerate() {
        if i % 4096 == 4095 && !go_on() {
            return Ok(None);
        }
        let t = t - course.t0;
        let y = swing.state(t);
        motion.states.push(y);
        // errors at some of the times, and where the state changes fastest
        let turning = y.precession().abs();
        let looked_at = i % every == 0 || i + 1 == count;
        if turning > fastest {
            (fastest, swiftest) = (turning, t);
        }
        if looked_at {
            motion.error = motion.error.max(swing.error(t));
        }
        if let Some(poses) = &mut motion.poses {
            let Some(pose) = swing.pose(t) else { return Ok(None) };
            poses.push(pose);
            if looked_at {
                motion.pose_error = motion.pose_error.max(swing.pose_error(t));
            }
        }
    }
    let met = event.map(|e| (e.time, limits.doubt(&e) + swing.time_error(e.time)));
    for (t, doubt) in met.into_iter().chain((count > 0).then_some((swiftest, 0.0))) {
        motion.error = motion.error.max(swing.error(t) + doubt);
        motion.pose_error = motion.pose_error.max(if course.pose { swing.pose_error(t) } else { f64::NAN });
    }
    motion.times = copied(&course.times[..count])?;
    Ok(Some(motion))
}
