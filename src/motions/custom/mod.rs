//! A body under user-defined laws of loss and friction ([`custom`](crate::custom)).
//!
//! ```text
//! slips   until u = 0: then it rolls if |F_roll| <= mu_s N, else it slips in another direction
//! rolls   until |F_roll| = mu_s N: then it slips                  both are integrated
//! N       from m(N): secants of the couple until N no longer changes
//! ```
//! The equations of motion are those of the library's own laws, with the same numbers of a slip and the same ends of a
//! phase. Error: as for any motion that is integrated, from a second run with a larger tolerance.

mod flow;

use super::ask::{check_flow, check_times_after};
use super::walk::{MOMENT, STILL, ending, most_phases, slip_over};
use super::{Ask, Ending, Event, Limit, Method, Motion, Phase, Start, exact};
use crate::error::{Error, copied, grow, room};
use crate::laws::body::Body;
use crate::laws::contact::Table;
use crate::laws::contact::slip::Friction;
use crate::laws::contact::standstill::{Standstill, towards};
use crate::laws::custom::Custom;
use crate::laws::pose::Pose;
use crate::laws::state::State;
use crate::methods::flow::{Exhausted, Flow, PATIENCE, Steps, toil_of};
use crate::motions::ask::row::OutputRow;
use crate::motions::body::slide::Slide;
use crate::motions::body::without_slip;
use crate::motions::body::write::{pose, state, state_errors};
use crate::motions::walk::errors::doubted;
use crate::motions::walk::numbers::{BodyNumbers, COS, HEAT, Halt, SIN, TIME, U2, UH, W2, lost};
use crate::motions::walk::two_runs::{Followed, judged};
use core::cell::Cell;
use flow::CustomFlow;

/// The default tolerance of a step, since a user-defined law may be slow.
const FAIR: f64 = 1e-10;
/// Count of numbers of such a motion: those of a slip, the pose and the energy lost.
const CUSTOM_NUMBERS: usize = 14;
/// For this time a slip keeps its direction after static friction has ceased to hold. The error is the cube of this
/// time.
const KEEPS_ITS_WAY: f64 = 1e-5;

/// Computes the motion of a body with user-defined laws at `times`, up to the event that ends it.
///
/// `ask` gives the contact, smooth losses, poses and forces. A motion in the air, beyond events or on a patch of
/// contact is an error, and so are dry losses. The default tolerance of a step is 1e-10. With `custom.friction` the
/// contact has to be Coulomb's friction, of which only the static coefficient is used. Errors: those of
/// [`motion::roll_with`](super::motion::roll_with) and of [`Custom::check`], and at any time `Couple` or `Coefficient` if
/// a law is not finite or supplies energy. A motion whose law is so stiff that it would need too many steps ends there
/// with [`Limit::Stiff`]. `go_on` is called at every step, and a law that [fails](crate::custom::CoupleLaw::has_failed)
/// interrupts the motion, too.
///
/// ```
/// use spincyl::{Body, State, contact::Friction, custom::{self, Custom}, motion::{Ask, Start}};
///
/// // Stribeck's friction falls from 0.4 at rest to 0.2 at high speed.
/// let stribeck = |speed: f64| 0.2 + 0.2 * (-(speed / 0.1).powi(2)).exp();
/// let hoop = Body::tube(0.0, 1.0)?;
/// let state = State { theta: std::f64::consts::FRAC_PI_2, w1: 0.0, w2: 0.0, w3: -3.0 };
/// let start = Start::from(state).with_slip([0.0, 5.0]);
/// let (ask, laws) = (Ask::on(Friction::coulomb(0.4)), Custom::default().with_friction(&stribeck));
/// let motion = custom::roll_with(&hoop, start, &[0.0, 20.0], &ask, laws, || true)?.expect("not interrupted");
/// assert!((motion.states[1].w3 - -0.5).abs() < 1e-8); // the hoop rolls back as under any friction
/// # Ok::<(), spincyl::Error>(())
/// ```
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

/// The motion of [`roll_with`] under laws that are checked. Its error is NaN unless it `is_judged`, by a second run.
pub(crate) fn followed(
    body: &Body,
    start: &Start,
    times: &[f64],
    (ask, is_judged): (&Ask, bool),
    custom: Custom<'_>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Followed, Error> {
    let tol = check(body, start, ask, &custom)?;
    check_times_after(start.time, times)?;
    let fault = Cell::new(None);
    let mut go_on = || !custom.has_failed() && go_on();
    let mut run = |tol: f64, times: &[f64]| {
        let flow = CustomFlow { body, ask, custom, fault: &fault, slips: false, tol };
        CustomRun::new(flow, start, times)?.run(&mut go_on)
    };
    if is_judged {
        return judged(tol, times, run);
    }
    let mut found = run(tol, times)?;
    found.motion.error = f64::NAN;
    Ok(found)
}

/// Checks a motion under such laws. Returns the tolerance of its steps.
fn check(body: &Body, start: &Start, ask: &Ask, custom: &Custom<'_>) -> Result<f64, Error> {
    exact::check(body, &start.state)?;
    ask.table.check()?;
    ask.losses.check_for(body)?;
    let tol = check_flow(ask)?;
    check_options(ask, start, custom)?;
    if !ask.table.rubs() {
        without_slip(start.slip)?;
    }
    Ok(if ask.method == Method::Exact { FAIR } else { tol })
}

/// Returns an error for options that such laws exclude.
pub(crate) fn check_options(ask: &Ask, start: &Start, custom: &Custom<'_>) -> Result<(), Error> {
    let refuse = |name: &'static str, value: f64| {
        Err(Error::OutOfRange { name, value, expected: "none together with a user-defined law" })
    };
    if ask.restitution.is_some() || start.aloft.is_some() {
        return refuse("restitution", ask.restitution.unwrap_or(f64::NAN));
    }
    if ask.table.friction().patch() > 0.0 {
        return refuse("patch", ask.table.friction().patch());
    }
    if ask.beyond || ask.stop_at_rolling {
        return refuse(if ask.beyond { "beyond" } else { "stop_at_rolling" }, 1.0);
    }
    if let Some((law, value)) = ask.losses.iter().find(|(law, value)| law.presses() && *value > 0.0) {
        let expected =
            "only laws without the normal force together with a user-defined law; add this one to it";
        return Err(Error::OutOfRange { name: law.parameter(), value, expected });
    }
    if custom.friction.is_some() && !matches!(ask.table, Table::Rubs(Friction::Coulomb { .. })) {
        let expected = "Coulomb friction as the contact of a user-defined law of friction";
        return Err(Error::OutOfRange { name: "contact", value: f64::NAN, expected });
    }
    Ok(())
}

/// The least growth of a slip that begins, so that it has a direction.
const LEAST_GROWTH: f64 = 1e-30;

/// The numbers after a time with these constant rates.
fn moved(y: &[f64; CUSTOM_NUMBERS], rate: &[f64; CUSTOM_NUMBERS], by: f64) -> [f64; CUSTOM_NUMBERS] {
    core::array::from_fn(|i| by.mul_add(rate[i], y[i]))
}

/// The beginning of a phase, or the end of the motion.
enum Beginning {
    Rolls,
    Slips,
    /// A slip from rest along a direction, which it keeps for this time.
    SlipsOff([f64; 2], f64),
    Ends(Ending),
}

/// One run of a motion: its current phase, its numbers, and its results so far.
struct CustomRun<'a> {
    flow: CustomFlow<'a>,
    start: &'a Start,
    times: &'a [f64],
    since: Vec<f64>,
    at: [f64; CUSTOM_NUMBERS],
    /// The direction in which the current slip began from rest.
    way: [f64; 2],
    made: Followed,
    patience: u64,
}

impl<'a> CustomRun<'a> {
    fn new(flow: CustomFlow<'a>, start: &'a Start, times: &'a [f64]) -> Result<Self, Error> {
        let (count, ask) = (times.len(), flow.ask);
        let mut made = Followed::empty(count, ask, true)?;
        made.motion.method = Method::Tolerance(flow.tol);
        let (State { theta, w1, w2, w3 }, [along, across]) = (start.state, start.slip);
        let ((s, c), mut at) = (theta.sin_cos(), [0.0; CUSTOM_NUMBERS]);
        let patience = ask.max_evaluations.map_or(PATIENCE, |most| PATIENCE.max(most));
        at[..7].copy_from_slice(&[s, c, w1, w2, w3, along, across]);
        let mut since = room(count)?;
        since.extend(times.iter().map(|t| t - start.time + 0.0));
        Ok(Self { flow, start, times, since, at, way: [0.0; 2], made, patience })
    }

    /// The first phase.
    fn first(&mut self) -> Beginning {
        let Table::Rubs(friction) = self.flow.ask.table else { return Beginning::Rolls };
        let over = slip_over(true, self.flow.friction(0.0).strength());
        let rests = self.at[UH].hypot(self.at[U2]) <= over;
        if rests && matches!(friction, Friction::Coulomb { .. }) {
            self.rests(false)
        } else {
            Beginning::Slips
        }
    }

    /// The next phase where the contact point is at rest; `let_go` means that friction has just ceased to hold it.
    fn rests(&mut self, let_go: bool) -> Beginning {
        (self.at[UH], self.at[U2]) = (0.0, 0.0);
        // At the limit itself a slip does not grow; later it does.
        let (lasts, mut from) = (if let_go { KEEPS_ITS_WAY } else { MOMENT }, self.at);
        if let_go {
            self.flow.slips = false;
            from = moved(&self.at, &self.flow.rates(&self.at), 0.5 * lasts);
        }
        match self.flow.standstill(&state(&from)) {
            Standstill::Sticks => Beginning::Rolls,
            Standstill::LiftsOff => Beginning::Ends(Ending::LiftOff),
            Standstill::Undefined => Beginning::Ends(Ending::Painleve),
            Standstill::Slips { alpha, .. } => Beginning::SlipsOff(towards(alpha), lasts),
        }
    }

    /// Begins a phase; returns the ending of the motion if the motion is over at once.
    fn begins(&mut self, next: Beginning) -> Result<Option<Ending>, Error> {
        let (angle, w) = (self.at.angle(), self.at.w());
        self.flow.slips = !matches!(next, Beginning::Rolls);
        let at = match next {
            Beginning::Ends(ending) => return Ok(Some(ending)),
            Beginning::SlipsOff(way, _) => self.flow.slides(angle, w, [0.0; 2], Some(way)),
            _ => self.flow.answer(&self.at),
        };
        if let Some(ending) = self.flow.at_start(&self.at, &at) {
            return Ok(Some(ending));
        }
        let phases = &mut self.made.path.phases;
        let (time, slip) = (self.start.time + self.at[TIME], self.at.slip());
        let (kind, state) = (self.flow.kind(), state(&self.at));
        grow(phases, Phase { time, kind, state, slip, aloft: [0.0; 2], rim: 0 })?;
        let still = phases.iter().rev().take_while(|phase| phase.time >= time).count();
        let limit = match () {
            () if still > STILL as usize => Some(Limit::Chatter),
            () if phases.len() > most_phases(&self.since) => Some(Limit::Changes),
            () => None,
        };
        if limit.is_some() {
            self.made.motion.limit = limit;
            return Ok(Some(Ending::Bounded));
        }
        if let Beginning::SlipsOff(way, lasts) = next {
            self.way = way;
            let from = self.at;
            while let Some(since) = self.due(from[TIME] + lasts) {
                self.at = self.slipped(&from, since - from[TIME]);
                self.writes();
            }
            self.at = self.slipped(&from, lasts);
        }
        Ok(None)
    }

    /// The numbers at the time `lasts` after a slip has begun, by the rates at the middle of that time.
    fn slipped(&self, from: &[f64; CUSTOM_NUMBERS], lasts: f64) -> [f64; CUSTOM_NUMBERS] {
        let half = moved(from, &self.flow.rates_along(from, self.way), 0.5 * lasts);
        let mut all = moved(from, &self.flow.rates_along(&half, self.way), lasts);
        let speed = (all[UH] * self.way[0] + all[U2] * self.way[1]).max(LEAST_GROWTH * lasts);
        (all[UH], all[U2]) = (speed * self.way[0], speed * self.way[1]);
        all
    }

    /// The next of the times, if it is not after `until`.
    fn due(&self, until: f64) -> Option<f64> {
        self.since.get(self.made.motion.states.len()).copied().filter(|t| *t <= until)
    }

    /// Writes the current numbers.
    fn writes(&mut self) {
        self.made.written(&self.flow, (&self.start.state, &self.at), self.way);
    }

    /// Computes the run to its end, or up to the limit at which the computation stops.
    fn run(mut self, go_on: &mut dyn FnMut() -> bool) -> Result<Followed, Error> {
        let mut next = self.first();
        loop {
            let over = self.begins(next)?;
            let goes_on = over.is_none().then_some(());
            let supplies = |()| self.flow.supplies(&self.at, &self.flow.rates(&self.at));
            let fault = self.flow.fault.take().or_else(|| goes_on.and_then(supplies));
            if let Some(fault) = fault.filter(|_| !self.flow.custom.has_failed()) {
                return Err(fault);
            }
            if let Some(ending) = over {
                let (now, state) = (self.at[TIME], state(&self.at));
                while self.due(now).is_some() {
                    self.writes();
                }
                self.made.motion.event = Some(Event { ending, time: self.start.time + now, state, rim: 0 });
                self.made.path.last_slip = self.at.slip();
                break;
            }
            next = match self.flows(go_on)? {
                Halt::Time => break,
                Halt::Standstill => self.rests(false),
                Halt::Slips if self.flow.ask.table.rubs() => self.rests(true),
                Halt::Face => {
                    let falls = self.at[COS] * self.at[W2];
                    self.at[TIME] += if falls > 0.0 { self.at[SIN] / falls } else { 0.0 };
                    self.at[SIN] = 0.0;
                    Beginning::Ends(Ending::Face)
                }
                halt => Beginning::Ends(ending(halt)),
            };
        }
        self.made.motion.times = copied(&self.times[..self.made.motion.states.len()])?;
        (self.made.path.heat, self.made.path.lost) = (self.at[HEAT], self.at[CUSTOM_NUMBERS - 1]);
        Ok(self.made)
    }

    /// Computes the current phase up to its end.
    fn flows(&mut self, go_on: &mut dyn FnMut() -> bool) -> Result<Halt, Error> {
        let (flow, start, began) = (self.flow, &self.start.state, self.at[TIME]);
        let most = flow.ask.max_evaluations;
        let most = most.unwrap_or_else(|| toil_of(self.since.last().copied().unwrap_or(0.0)));
        let toil = most.saturating_sub(self.made.motion.evaluations);
        let steps = Steps { first: None, most: u64::MAX, patience: self.patience, toil, tired: false };
        let first = self.made.motion.states.len();
        let (made, way) = (&mut self.made, self.way);
        let mut write = |y: &[f64; CUSTOM_NUMBERS]| made.written(&flow, (start, y), way);
        let flown = flow.run(flow.place(self.at), steps, &self.since[first..], &mut write, go_on);
        self.made.motion.evaluations += flown.spent.evaluations;
        self.made.path.erred += flown.spent.erred * flow.tol;
        (self.at, self.patience) = (flown.y, flown.spent.patience);
        if flow.slips {
            self.made.path.slipping += self.at[TIME] - began;
        }
        let fault = flow.fault.take().filter(|_| flown.halt == Halt::Endless);
        let limit = match flown.spent.exhausted {
            Some(Exhausted::Interrupted) => Some(Limit::Interrupted),
            _ if let Some(fault) = fault => return Err(fault),
            Some(Exhausted::Rounding) if self.at[TIME] == 0.0 => {
                return Err(Error::Lost { theta: flow.theta(&self.at) });
            }
            Some(Exhausted::Crawling | Exhausted::Evaluations)
                if flow.is_kept_short(&self.at, flown.step) =>
            {
                Some(Limit::Stiff)
            }
            why => why.map(Limit::from),
        };
        self.made.motion.limit = limit;
        Ok(flown.halt)
    }
}

impl Followed {
    /// Adds the numbers `y` to the outputs of a motion.
    fn written(
        &mut self,
        flow: &CustomFlow<'_>,
        (start, y): (&State, &[f64; CUSTOM_NUMBERS]),
        way: [f64; 2],
    ) {
        let (now, ask) = (state(y), flow.ask);
        let side = if y[SIN] < 0.0 { -1.0 } else { 1.0 };
        let slip = [side * y[UH], side * y[U2]];
        let pose = ask.pose.then(|| {
            let pose = pose(y);
            if ask.table != Table::Smooth {
                return pose;
            }
            Pose { contact_point: Pose::below_centre(flow.body, start, &now, pose.phi.rest), ..pose }
        });
        let force = ask.force.then(|| {
            let (force, doubt) = doubted(&now, state_errors(&now, flow.tol), |y| flow.force(y, slip, way));
            // Friction turns with the slip, whose direction is as uncertain as the slip is slow.
            let speed = slip[0].hypot(slip[1]);
            let turns = if flow.slips && speed > 0.0 { flow.tol * Slide::fastest(y) / speed } else { 0.0 };
            (force, doubt + turns.min(1.0) * force.along.hypot(force.across))
        });
        self.push(OutputRow {
            pose,
            force,
            ..OutputRow::on_table(now, slip, [y[HEAT], lost(y)], flow.kind())
        });
    }
}
