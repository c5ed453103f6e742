//! A body on a table with friction: slipping, rolling, slipping again.
//!
//! ```text
//! slip    u = 0 and |F_roll| <= mu_s N      roll          u = 0, more is needed     slip in another direction
//! roll    |F_roll| = mu_s N                 slip          both   N = 0, a face or the other rim lands: the end
//! ```
//! A phase that slips is integrated (`motion::slide`); one that rolls is the exact solution, so that it costs the same
//! however long it lasts. Where no force, or more than one, obeys the law of friction (Painleve), a start is refused and a
//! motion ends.
//!
//! Error: the whole path is found twice, the second time within a tolerance up to ten thousand times as large, which costs a
//! third; thirty times what the ratio of the tolerances makes of the difference is claimed.

use super::leaving::Leaving;
use super::slide::{Halt, Place, Slid, Slide};
use super::{Ask, Ending, Event, Method, Motion, check_times, roll_with};
use crate::body::Body;
use crate::contact::landing::{self, Outcome};
use crate::contact::slip::{Friction, painleve};
use crate::contact::standstill::{Standstill, let_go, standstill, towards};
use crate::contact::{Contact, Force, force};
use crate::error::{Error, copied, room, within};
use crate::exact;
use crate::pose::{Angle, Pose};
use crate::state::State;
use core::f64::consts::{FRAC_PI_2, PI};
use nalgebra::{Point2, UnitQuaternion, Vector3};

/// What a contact point does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Kind {
    /// It rests.
    Rolling = 0,
    /// It slips.
    Slipping = 1,
}

/// A part of a motion in which the contact point does the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phase {
    /// When it begins.
    pub time: f64,
    /// What it is.
    pub kind: Kind,
    /// The state then.
    pub state: State,
    /// The slip then, along the lean and across it.
    pub slip: [f64; 2],
}

/// What is asked of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked {
    /// The table.
    pub friction: Friction,
    /// What a step of the integrator may err by.
    pub tol: f64,
    /// Whether poses are wanted.
    pub pose: bool,
    /// Whether contact forces are wanted.
    pub force: bool,
    /// Whether the motion goes on beyond a landing of the other rim that does not bounce.
    pub landing: bool,
    /// Whether it ends where it begins to roll.
    pub until_rolling: bool,
}

impl Asked {
    /// On this table, as accurately as doubles allow, without poses and forces, up to the first landing.
    pub fn on(friction: Friction) -> Self {
        Self { friction, tol: FINE, pose: false, force: false, landing: false, until_rolling: false }
    }
}

/// A motion with its slip.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// Times, states, how it ended; estimated errors of states, slips, and of times and states of phases and the end. The heat
    /// is off by that times the largest speed.
    pub motion: Motion,
    /// The slip at each time, along the lean and across it.
    pub slip: Vec<[f64; 2]>,
    /// The heat made by friction up to each time, in M g R.
    pub dissipated: Vec<f64>,
    /// What the contact point does at each time.
    pub kinds: Vec<Kind>,
    /// The phases, from the start on.
    pub phases: Vec<Phase>,
    /// All the heat, up to the last time or the end.
    pub heat: f64,
    /// All the time of slipping.
    pub slipping: f64,
    /// The slip where an event ended it.
    pub last_slip: [f64; 2],
    /// Whether it has rocked over onto its other rim, now and, where poses are wanted, at each time.
    upside_down: bool,
    turned: Vec<bool>,
    /// Whether it was left where it began to roll.
    rolls_on: bool,
    /// The direction in which the present slip began from rest.
    way: [f64; 2],
}

/// The default tolerance of a step.
pub const FINE: f64 = 1e-14;
/// By how much the second run is rougher where that is accurate enough, and at least; and the least tolerance that is not.
const ROUGHER: f64 = 1e4;
const BARELY: f64 = 32.0;
const ROUGH: f64 = 1e-7;
/// The difference is claimed, over the ratio of the tolerances, so many times.
const SAFETY: f64 = 30.0;
/// Phases that are followed: some flicks slip for a moment in each nod, for ever.
const MOST: usize = 10_000;
/// And those that follow each other within no time.
const STILL: u32 = 6;
/// By this much friction is stretched where it is needed to the last, and not more than that.
const GRACE: f64 = 1e-11;
/// A rim that is left more slowly than this has not been left: landings would follow each other faster and faster.
const CLATTER: f64 = 1e-9;
/// The series of a slow slip is worth its while if it holds for so many times its speed: an integrator takes a step in six.
const WORTHWHILE: f64 = 100.0;
/// Slip whose speed begins to grow faster than this does not stay slow.
const SLOWLY: f64 = 0.02;
/// The least inclination of a motion by first integrals.
const LEAST: f64 = 1e-8;

/// The motion of `body` from `start` with the slip `slip` (along the lean, across) at time `t0`, at the `times`, in order and not
/// before `t0`.
///
/// `go_on` is asked about fifty times a second; if it says no, the answer is `Ok(None)`. Errors, before any work: `OutOfRange`
/// for a body, state, slip, time, tolerance or coefficient that makes no sense; `Painleve` for a start without a unique
/// contact force. At any time `Memory`, `Lost` where the equations lose their digits, and `Restless` where slipping and rolling
/// follow each other more than 10,000 times.
///
/// ```
/// use spincyl::{Body, State, contact::Friction, motion::path};
///
/// // a hoop thrown with backspin: it slips for (v + w)/(2 mu), and comes back if w > v
/// let hoop = Body::tube(0.0, 1.0)?;
/// let start = State { theta: std::f64::consts::FRAC_PI_2, w1: 0.0, w2: 0.0, w3: -3.0 };
/// let asked = path::Asked::on(Friction::coulomb(0.25));
/// let path = path::follow(&hoop, &start, [0.0, 2.0 + 3.0], 0.0, &[0.0, 20.0], &asked, || true)?.expect("not interrupted");
/// assert!((path.phases[1].time - 5.0 / 0.5).abs() < 1e-12);
/// assert!((path.motion.states[1].w3 - -0.5).abs() < 1e-12); // it rolls back
/// # Ok::<(), spincyl::Error>(())
/// ```
pub fn follow(
    body: &Body,
    start: &State,
    slip: [f64; 2],
    t0: f64,
    times: &[f64],
    asked: &Asked,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<Path>, Error> {
    check(body, start, slip, asked)?;
    let span = check_times(t0, times)?;
    if span < 0.0 {
        let expected = "times after the start: friction does not say where a body came from";
        return Err(Error::OutOfRange { name: "t", value: times[times.len() - 1], expected });
    }
    let mut run = |tol: f64| {
        if asked.pose {
            Walk::<13>::new(body, asked, tol, t0, times, start, slip)?.run(&mut go_on)
        } else {
            Walk::<9>::new(body, asked, tol, t0, times, start, slip)?.run(&mut go_on)
        }
    };
    let Some(mut path) = run(asked.tol)? else { return Ok(None) };
    let Some(rough) = run(rougher(asked.tol))? else { return Ok(None) };
    path.judge(&rough, asked.tol);
    Ok(Some(path))
}

/// The tolerance by which the one of a path is judged.
pub(crate) fn rougher(tol: f64) -> f64 {
    (ROUGHER * tol).min(ROUGH).max(BARELY * tol)
}

/// Refuses what is out of range, and a start that has no unique force.
pub(crate) fn check(body: &Body, start: &State, slip: [f64; 2], asked: &Asked) -> Result<(), Error> {
    exact::check(body, start)?;
    asked.friction.check()?;
    within("tol", asked.tol, (FINE, 1e-1), "1e-14 <= tol <= 0.1")?;
    for (name, u) in ["slip along the lean", "slip across"].into_iter().zip(slip) {
        within(name, u, (-1e6, 1e6), "at most 1e6 sqrt(g R) for a motion")?;
    }
    Ok(())
}

/// A path while it is made.
pub(crate) struct Walk<'a, const N: usize> {
    body: Body,
    asked: Asked,
    pub slide: Slide,
    t0: f64,
    /// The times asked for, since the start.
    since: Vec<f64>,
    times: &'a [f64],
    path: Path,
    /// Where the present phase begins or has ended: the numbers of `motion::slide`, the state, and what comes then.
    at: [f64; N],
    state: State,
    next: Option<Next>,
    began: f64,
    /// Phases that have begun at the same time as the one before.
    still: u32,
    /// Whether the body only ever tilts: then rounding must not make it turn.
    planar: bool,
    /// By what share it moves each end of a phase.
    shake: f64,
    evaluations: u64,
}

/// What comes next.
enum Next {
    Slips([f64; 2]),
    SlipsOff { alpha: f64, growth: f64 },
    Rolls { grace: bool },
    Ends(Ending),
}

/// What a path needs to go on.
pub(crate) enum Turn<const N: usize> {
    /// A slip from here.
    Slide(Place<N>),
    /// Nothing.
    Done,
    /// The caller wants no more.
    Interrupted,
}

/// Whether a slip has been left before its end.
#[derive(PartialEq)]
pub(crate) enum Pause<const N: usize> {
    No,
    /// At these numbers, with this step to come.
    Here([f64; N], f64),
    /// The caller wants no more.
    Interrupted,
}

impl<'a, const N: usize> Walk<'a, N> {
    /// At the start.
    pub fn new(
        body: &Body,
        asked: &Asked,
        tol: f64,
        t0: f64,
        times: &'a [f64],
        start: &State,
        slip: [f64; 2],
    ) -> Result<Self, Error> {
        check(body, start, slip, asked)?;
        let mut since = copied(times)?;
        since.iter_mut().for_each(|t| *t -= t0);
        let count = times.len();
        let mut motion = Motion::empty(count, asked.pose)?;
        if asked.force {
            motion.forces = Some(room(count)?);
        }
        motion.method = Method::Tolerance(tol);
        let path = Path {
            motion,
            slip: room(count)?,
            dissipated: room(count)?,
            kinds: room(count)?,
            phases: Vec::new(),
            heat: 0.0,
            slipping: 0.0,
            last_slip: [0.0; 2],
            upside_down: false,
            turned: Vec::new(),
            rolls_on: false,
            way: [0.0; 2],
        };
        let slide = Slide::new(body, &asked.friction, tol);
        let (s, c) = start.theta.sin_cos();
        let mut at = [0.0; N];
        at[..7].copy_from_slice(&[s, c, start.w1, start.w2, start.w3, slip[0], slip[1]]);
        let mut walk = Self {
            body: *body,
            asked: *asked,
            slide,
            t0,
            since,
            times,
            path,
            at,
            state: *start,
            next: None,
            began: f64::NEG_INFINITY,
            still: 0,
            // thirty times less of it are a few roundings
            shake: if tol > asked.tol { f64::EPSILON * tol / (asked.tol * SAFETY) } else { 0.0 },
            planar: start.w1 == 0.0 && start.w3 == 0.0 && slip[1] == 0.0,
            evaluations: 0,
        };
        walk.next = Some(walk.begins(start, slip)?);
        if start.theta < body.theta_max() {
            walk.shake();
        }
        Ok(walk)
    }

    fn run(mut self, go_on: &mut dyn FnMut() -> bool) -> Result<Option<Path>, Error> {
        loop {
            match self.advance(go_on)? {
                Turn::Slide(place) => {
                    if self.slides(place, (None, u64::MAX), go_on)? == Pause::Interrupted {
                        return Ok(None);
                    }
                }
                Turn::Done => return Ok(Some(self.done()?)),
                Turn::Interrupted => return Ok(None),
            }
        }
    }

    /// Through the phases, up to one that slips or to the end.
    pub fn advance(&mut self, go_on: &mut dyn FnMut() -> bool) -> Result<Turn<N>, Error> {
        while let Some(next) = self.next.take() {
            self.still = if self.at[7] > self.began { 0 } else { self.still + 1 };
            let count = self.path.phases.len();
            if !matches!(next, Next::Ends(_)) && (self.still > STILL || count > MOST) {
                return Err(Error::Restless { count, time: self.t0 + self.at[7] });
            }
            match next {
                Next::Ends(ending) => {
                    let event = Event { ending, time: self.t0 + self.at[7], state: self.state };
                    self.path.motion.event = Some(event);
                    self.path.last_slip = self.folded_slip();
                }
                Next::Rolls { grace } => {
                    if !self.rolls(grace, go_on)? {
                        return Ok(Turn::Interrupted);
                    }
                }
                Next::Slips(slip) => {
                    self.opens(Kind::Slipping, slip);
                    return Ok(Turn::Slide(self.slide.place(self.at)));
                }
                Next::SlipsOff { alpha, growth } => {
                    if let Some(place) = self.slips_off((alpha, growth)) {
                        return Ok(Turn::Slide(place));
                    }
                }
            }
        }
        Ok(Turn::Done)
    }

    /// Moves what a rougher run finds at the end of a phase by more than rounding does: where the motion is unstable, the
    /// difference of the two runs tells it.
    fn shake(&mut self) {
        if self.shake == 0.0 {
            return;
        }
        let (down, up) = (1.0 - self.shake, 1.0 + self.shake);
        let State { theta, w1, w2, w3 } = self.state;
        self.state = State { theta: theta * down, w1: w1 * up, w2: w2 * down, w3: w3 * up };
        let (s, c) = self.state.theta.sin_cos();
        self.at[..5].copy_from_slice(&[s, c, w1 * up, w2 * down, w3 * up]);
    }

    /// What has been found.
    pub fn done(mut self) -> Result<Path, Error> {
        let count = self.path.motion.states.len();
        self.path.motion.times = copied(&self.times[..count])?;
        self.path.motion.evaluations = self.evaluations;
        self.path.heat = self.at[8];
        Ok(self.path)
    }

    /// The slip where a phase ended, along the lean and across it.
    fn folded_slip(&self) -> [f64; 2] {
        let side = if self.at[0] < 0.0 { -1.0 } else { 1.0 };
        [side * self.at[5], side * self.at[6]]
    }

    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The first phase.
    fn begins(&self, start: &State, slip: [f64; 2]) -> Result<Next, Error> {
        let speed = slip[0].hypot(slip[1]);
        if speed > self.slide.over() || !self.slide.law.dry {
            return Ok(match self.slide.at_start(start, slip) {
                Some(Halt::Jam) => return Err(self.jam(start)),
                Some(halt) => Next::Ends(ending(halt)),
                None => Next::Slips(slip),
            });
        }
        let found = standstill(&self.body, start, &self.asked.friction);
        let side = self.body.theta_max() - start.theta;
        if self.body.theta_max() < PI && (side < 0.0 || (side == 0.0 && !self.rises(start, found))) {
            return Ok(Next::Ends(Ending::Side));
        }
        match self.after_rest(found) {
            Next::Ends(Ending::Painleve) => Err(self.jam(start)),
            next => Ok(next),
        }
    }

    /// Whether a body at theta_max, whose contact point rests, rises under the force that there is.
    fn rises(&self, y: &State, found: Standstill) -> bool {
        let rate = match found {
            Standstill::Slips { alpha, .. } => {
                let w = [y.w1, y.w2, y.w3];
                self.slide.law.towards(y.theta.sin_cos(), w, [0.0; 2], towards(alpha)).w[1]
            }
            _ => Contact::Rolling.derivative(&self.body, y).w2,
        };
        y.w2 > 0.0 || (y.w2 == 0.0 && rate > 0.0)
    }

    fn jam(&self, y: &State) -> Error {
        let mu = self.asked.friction.strength();
        Error::Painleve { mu, theta: y.theta, limit: painleve(&self.body, y.theta) }
    }

    fn after_rest(&self, found: Standstill) -> Next {
        match found {
            Standstill::Sticks => Next::Rolls { grace: false },
            Standstill::Slips { alpha, growth } => Next::SlipsOff { alpha, growth },
            Standstill::LiftsOff => Next::Ends(Ending::LiftOff),
            Standstill::Undefined => Next::Ends(Ending::Painleve),
        }
    }

    fn opens(&mut self, kind: Kind, slip: [f64; 2]) {
        let time = self.t0 + self.at[7];
        self.began = self.at[7];
        self.path.phases.push(Phase { time, kind, state: self.state, slip });
    }

    /// A phase that rolls; false if it is told to stop.
    fn rolls(&mut self, grace: bool, go_on: &mut dyn FnMut() -> bool) -> Result<bool, Error> {
        let Friction::Coulomb { fixed, .. } = self.asked.friction else { return Ok(true) };
        self.opens(Kind::Rolling, [0.0; 2]);
        if self.asked.until_rolling {
            self.path.rolls_on = true;
            return Ok(true);
        }
        let first = self.path.motion.states.len();
        let times = &self.since[first..];
        if times.is_empty() {
            return Ok(true);
        }
        let mu = if grace { fixed * (1.0 + GRACE) } else { fixed };
        let ask = Ask { mu, pose: self.asked.pose, ..Ask::default() };
        let (body, y) = (self.body, self.state);
        if y.theta.min(PI - y.theta) < LEAST {
            // a face so near to the table is on it before anything else
            let lost = Error::Lost { theta: y.theta };
            self.next = Some(if body.is_ball() { return Err(lost) } else { Next::Ends(Ending::Face) });
            return Ok(true);
        }
        let Some(mut rolled) = roll_with(&body, &y, self.at[7], times, &ask, &mut *go_on)? else {
            return Ok(false);
        };
        self.path.motion.error = self.path.motion.error.max(rolled.error);
        self.path.motion.pose_error = self.path.motion.pose_error.max(rolled.pose_error);
        let heat = self.at[8];
        if self.planar {
            rolled.states.iter_mut().chain(rolled.event.iter_mut().map(|e| &mut e.state)).for_each(|y| {
                (y.w1, y.w3) = (0.0, 0.0);
            });
        }
        for (i, y) in rolled.states.iter().enumerate() {
            let pose = rolled.poses.as_ref().map(|poses| self.moved(&poses[i]));
            let force = self.asked.force.then(|| force(Contact::Rolling, &body, y));
            self.path.put(*y, [0.0; 2], heat, Kind::Rolling, pose, force);
        }
        let Some(event) = rolled.event else { return Ok(true) };
        // where the body is then
        if self.asked.pose && (event.ending == Ending::Slip || event.ending == Ending::Side) {
            let ask = Ask { beyond: true, ..ask };
            let then = roll_with(&body, &y, self.at[7], &[event.time], &ask, go_on)?;
            if let Some(pose) = then.and_then(|m| m.poses).and_then(|poses| poses.last().copied()) {
                let pose = self.moved(&pose);
                let numbers =
                    [pose.phi.radians(), pose.psi.radians(), pose.contact_point.x, pose.contact_point.y];
                self.at[9..].copy_from_slice(&numbers);
            }
        }
        let (s, c) = event.state.theta.sin_cos();
        let State { w1, w2, w3, .. } = event.state;
        self.at[..8].copy_from_slice(&[s, c, w1, w2, w3, 0.0, 0.0, event.time]);
        self.state = event.state;
        let next = match event.ending {
            Ending::Slip => self.after_rest(let_go(&body, &event.state, &self.asked.friction)),
            Ending::Side if self.asked.landing => self.lands(),
            ending => Next::Ends(ending),
        };
        if !matches!(next, Next::Ends(_)) {
            self.shake();
        }
        self.next = Some(next);
        Ok(true)
    }

    /// A pose of a phase that rolls, from the start of the motion on.
    fn moved(&self, pose: &Pose) -> Pose {
        let [phi, psi, x, y] = core::array::from_fn(|i| self.at[9 + i]);
        let turned = |by: f64, angle: Angle| {
            let turns = (by / core::f64::consts::TAU).round();
            let rest = Angle { turns, rest: by - turns * core::f64::consts::TAU };
            Angle { turns: angle.turns + turns, rest: angle.rest + rest.rest }.settled()
        };
        let (sin, cos) = phi.sin_cos();
        let at = pose.contact_point;
        Pose {
            phi: turned(phi, pose.phi),
            psi: turned(psi, pose.psi),
            contact_point: Point2::new(x + at.x * cos - at.y * sin, y + at.x * sin + at.y * cos),
        }
    }

    /// A phase that slips from rest: where an integrator takes over, if it lasts that long.
    fn slips_off(&mut self, way: (f64, f64)) -> Option<Place<N>> {
        let Some(series) = Leaving::new(&self.body, &self.state, &self.asked.friction, way, self.slide.tol)
        else {
            self.next = Some(Next::Ends(Ending::Painleve));
            return None;
        };
        if series.ends && series.until == 0.0 {
            // friction is needed to the last, and not more than that
            self.next = Some(Next::Rolls { grace: true });
            return None;
        }
        self.opens(Kind::Slipping, [0.0; 2]);
        self.path.way = towards(way.0);
        let (slide, asked) = (self.slide, self.asked);
        let (mut series, mut at) = (series, self.at);
        loop {
            let first = self.path.motion.states.len();
            let path = &mut self.path;
            let until = slide.safe(&series);
            let whole = until == series.until;
            let mut write = |y: &[f64; N]| path.slid(&asked, &slide, y);
            at = slide.leave(&series, until, &at, &self.since[first..], &mut write);
            let over = self.path.motion.states.len() == self.since.len();
            if over || (series.ends && whole) {
                (at[5], at[6]) = if over { (at[5], at[6]) } else { (0.0, 0.0) };
                let halt = if over { Halt::Time } else { Halt::Standstill };
                self.halted(Slid { halt, y: at, step: 0.0, evaluations: 0 });
                return None;
            }
            // slip that stays slow has settled on its direction, which an integrator would follow in tiny steps
            let (speed, alpha) = (at[5].hypot(at[6]), at[6].atan2(at[5]));
            let next = if whole && way.1 < SLOWLY {
                Leaving::slowly(&self.body, &state(&at), &asked.friction, alpha, speed, slide.tol)
            } else {
                None
            };
            match next.filter(|next| next.until > WORTHWHILE * speed) {
                Some(next) => series = next,
                None => return Some(slide.place(at)),
            }
        }
    }

    /// A phase that slips, from a place and with a first step if that is known, for so many steps at most.
    pub fn slides(
        &mut self,
        place: Place<N>,
        steps: (Option<f64>, u64),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        let (slide, first) = (self.slide, self.path.motion.states.len());
        let (asked, path) = (self.asked, &mut self.path);
        let mut write = |y: &[f64; N]| path.slid(&asked, &slide, y);
        let Some(slid) = slide.run(place, steps, &self.since[first..], &mut write, go_on)? else {
            return Ok(Pause::Interrupted);
        };
        if slid.halt == Halt::Pause {
            self.evaluations += slid.evaluations;
            return Ok(Pause::Here(slid.y, slid.step));
        }
        self.halted(slid);
        Ok(Pause::No)
    }

    /// What comes after a slip.
    fn halted(&mut self, slid: Slid<N>) {
        self.at = slid.y;
        self.evaluations += slid.evaluations;
        self.path.slipping += self.at[7] - self.began;
        if slid.halt == Halt::Face {
            // rounding leaves it on either side
            self.at[0] = 0.0;
        }
        let (body, mut y) = (&self.body, state(&self.at));
        let next = match slid.halt {
            Halt::Time | Halt::Pause => return,
            Halt::Standstill => self.after_rest(standstill(body, &y, &self.asked.friction)),
            halt => Next::Ends(ending(halt)),
        };
        if slid.halt == Halt::Side {
            y.theta = body.theta_max();
        }
        self.state = y;
        if slid.halt == Halt::Standstill {
            self.shake();
        }
        self.next = Some(if slid.halt == Halt::Side && self.asked.landing { self.lands() } else { next });
    }

    /// The other rim lands and does not bounce: what then.
    fn lands(&mut self) -> Next {
        let Friction::Coulomb { mu, .. } = self.asked.friction else { return Next::Ends(Ending::Side) };
        let before = State { theta: FRAC_PI_2, ..self.state };
        let Ok(landed) = landing::land(&self.body, &before, self.folded_slip(), mu) else {
            return Next::Ends(Ending::Side);
        };
        let (mut state, slip) = (landed.state, landed.slip);
        if landed.outcome == Outcome::Changes {
            self.path.upside_down = !self.path.upside_down;
        }
        if landed.outcome == Outcome::Changes && N == 13 {
            // the other rim is two half lengths further, and leans to the other side
            let (direction, length) = (self.at[9], 2.0 * self.body.ell());
            self.at[11] -= length * direction.cos();
            self.at[12] -= length * direction.sin();
            (self.at[9], self.at[10]) = (direction + PI, -self.at[10]);
        }
        if state.w2 < CLATTER {
            state.w2 = 0.0;
        }
        let (s, c) = state.theta.sin_cos();
        self.at[..7].copy_from_slice(&[s, c, state.w1, state.w2, state.w3, slip[0], slip[1]]);
        self.at[8] += landed.lost;
        self.state = state;
        if landed.outcome == Outcome::Lies {
            return Next::Ends(Ending::Side);
        }
        let found = self.begins(&state, slip);
        found.unwrap_or(Next::Ends(Ending::Painleve))
    }
}

/// What a halt is the end of.
fn ending(halt: Halt) -> Ending {
    match halt {
        Halt::Time | Halt::Pause | Halt::Standstill => Ending::Done,
        Halt::Face => Ending::Face,
        Halt::Side => Ending::Side,
        Halt::LiftOff => Ending::LiftOff,
        Halt::Jam => Ending::Painleve,
    }
}

/// The state of the numbers of a slide. A ball whose axis has passed the vertical leans to the other side.
fn state<const N: usize>(y: &[f64; N]) -> State {
    let side = if y[0] < 0.0 { -1.0 } else { 1.0 };
    State { theta: (side * y[0]).atan2(y[1]), w1: side * y[2], w2: side * y[3], w3: y[4] }
}

impl Path {
    /// Adds a place of a slide.
    fn slid<const N: usize>(&mut self, asked: &Asked, slide: &Slide, y: &[f64; N]) {
        let now = state(y);
        let side = if y[0] < 0.0 { -1.0 } else { 1.0 };
        let slip = [side * y[5], side * y[6]];
        let pose = (N == 13).then(|| {
            let turn = if side < 0.0 { PI } else { 0.0 };
            let angle = |angle: f64| {
                let turns = (angle / core::f64::consts::TAU).round();
                Angle { turns, rest: angle - turns * core::f64::consts::TAU }.settled()
            };
            Pose {
                phi: angle(y[9] + turn),
                psi: angle(y[10] - turn),
                contact_point: Point2::new(y[11], y[12]),
            }
        });
        // what does not slip yet is held against the direction in which it begins to
        let force = asked.force.then(|| match slip {
            [0.0, 0.0] if slide.law.dry => slide.law.force(&now, self.way),
            _ => slide.law.force(&now, slip),
        });
        self.put(now, slip, y[8], Kind::Slipping, pose, force);
    }

    fn put(
        &mut self,
        y: State,
        slip: [f64; 2],
        heat: f64,
        kind: Kind,
        pose: Option<Pose>,
        force: Option<Force>,
    ) {
        self.motion.states.push(y);
        self.slip.push(slip);
        self.dissipated.push(heat);
        self.kinds.push(kind);
        if let Some((poses, pose)) = self.motion.poses.as_mut().zip(pose) {
            poses.push(pose);
            self.turned.push(self.upside_down);
        }
        if let Some((forces, force)) = self.motion.forces.as_mut().zip(force) {
            forces.push(force);
        }
    }

    /// The state and the slip at the last time, or where it ended.
    pub(crate) fn last(&self) -> Option<(State, [f64; 2])> {
        match self.motion.event {
            Some(event) => Some((event.state, self.last_slip)),
            None if self.rolls_on => self.phases.last().map(|phase| (phase.state, phase.slip)),
            None => self.motion.states.last().copied().zip(self.slip.last().copied()),
        }
    }

    /// The orientation at each time, if poses were wanted: of the body as it was at the start, whichever rim it is on.
    pub fn orientations(&self) -> impl Iterator<Item = UnitQuaternion<f64>> {
        // seen from its other rim a body is turned about its own first axis
        let over = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI);
        let poses = self.motion.poses.iter().flatten().zip(&self.motion.states);
        poses.zip(&self.turned).map(move |((pose, y), turned)| {
            let found = pose.orientation(y);
            if *turned { found * over } else { found }
        })
    }

    /// When it ended, if not at the last time.
    pub(crate) fn ended(&self) -> Option<f64> {
        let rolling = self.phases.last().filter(|_| self.rolls_on).map(|phase| phase.time);
        self.motion.event.map(|e| e.time).or(rolling)
    }

    /// Says how far it may be off, by a rougher one.
    pub(crate) fn judge(&mut self, rough: &Self, tol: f64) {
        let claimed = (SAFETY * tol / rougher(tol)).min(1.0);
        let motion = &mut self.motion;
        let (mut off, mut turned) = (0f64, 0f64);
        let mut apart = |a: f64, b: f64| off = off.max((a - b).abs());
        for (i, (a, b)) in motion.states.iter().zip(&rough.motion.states).enumerate() {
            let (a, b): ([f64; 4], [f64; 4]) = ((*a).into(), (*b).into());
            a.into_iter()
                .zip(b)
                .chain(self.slip[i].into_iter().zip(rough.slip[i]))
                .for_each(|(a, b)| apart(a, b));
        }
        for (a, b) in self.phases.iter().zip(&rough.phases) {
            apart(a.time, b.time);
            let (a, b): ([f64; 4], [f64; 4]) = (a.state.into(), b.state.into());
            a.into_iter().zip(b).for_each(|(a, b)| apart(a, b));
        }
        if let (Some(a), Some(b)) = (motion.event, rough.motion.event) {
            apart(a.time, b.time);
            let (a, b): ([f64; 4], [f64; 4]) = (a.state.into(), b.state.into());
            a.into_iter().zip(b).for_each(|(a, b)| apart(a, b));
        }
        if let (Some(poses), Some(others)) = (&motion.poses, &rough.motion.poses) {
            for (a, b) in poses.iter().zip(others) {
                turned = turned.max(super::judge::pose_distance(a, b));
            }
        }
        let kinds = |path: &Self| path.phases.iter().map(|phase| phase.kind).collect::<Vec<_>>();
        let ends = motion.event.map(|e| e.ending) == rough.motion.event.map(|e| e.ending);
        let rounding = 8.0
            * f64::EPSILON
            * self.phases.iter().fold(1.0, |most: f64, p| {
                most.max(p.state.w1.abs()).max(p.state.w3.abs()).max(p.slip[0].abs()).max(p.slip[1].abs())
            });
        let same = kinds(self) == kinds(rough) && ends;
        let motion = &mut self.motion;
        // two runs that make the same steps agree on an error that a step is allowed
        let least = if self.slipping > 0.0 { rounding.max(tol) } else { rounding };
        let settled = |claim: f64, off: f64| if same { claim + claimed * off + least } else { f64::INFINITY };
        motion.error = settled(motion.error, off);
        motion.pose_error = settled(motion.pose_error, turned);
    }
}
