//! A body under user-defined laws of loss and friction ([`custom`](crate::custom)).
//!
//! ```text
//! slips   until u = 0: then it rolls if |F_roll| <= mu_s N, else it slips in another direction
//! rolls   until |F_roll| = mu_s N: then it slips                  both are integrated
//! N       from m(N): secants of the couple until N no longer changes
//! ```
//! The equations of motion are those of the library's own laws, with the same numbers of a slip and the same ends of a
//! phase. Impacts, flight and the motion on both rims are those of [`body`](super::body) with these laws. Error: as for any motion that is integrated, from a second run with a larger tolerance.

mod flow;
mod friction;

use super::ask::check_times_after;
use super::walk::{
    MOMENT, Next, Pause, Phases, SlowLaw, SlowSeries, Walk, WalkStep, after_rest, ending, slip_over,
};
use super::{Ask, Ending, Kind, Limit, Method, Motion, Phase, Start};
use crate::error::Error;
use crate::laws::body::Body;
use crate::laws::contact::Table;
use crate::laws::contact::slip::{Friction, painleve};
use crate::laws::contact::standstill::{Standstill, towards};
use crate::laws::custom::Custom;
use crate::laws::pose::Pose;
use crate::laws::state::State;
use crate::methods::flow::{Exhausted, Flow, Steps};
use crate::motions::ask::row::OutputRow;
use crate::motions::body::own::Own;
use crate::motions::body::phases::{KEEPS_ITS_WAY, LONGER, numbers_at};
use crate::motions::body::slide::{LEAST_GROWTH, Slide};
use crate::motions::body::write::{pose, state, state_errors};
use crate::motions::body::{self, BodyPhases, BodyWalk, without_friction};
use crate::motions::walk::errors::doubted;
use crate::motions::walk::numbers::{BodyNumbers, COS, HEAT, Halt, SIN, TIME, U2, UH, W2, leans_over, lost};
use crate::motions::walk::two_runs::{Followed, judged};
use crate::numbers::Series;
use core::cell::Cell;
use flow::CustomFlow;
use friction::OwnFriction;

/// The default tolerance of a step, since a user-defined law may be slow.
const FAIR: f64 = 1e-10;
/// Count of numbers of such a motion: those of a slip, the pose and the energy lost.
const CUSTOM_NUMBERS: usize = 14;

/// Computes the motion of a body with user-defined laws at `times`, up to the event that ends it.
///
/// `ask` gives the contact, smooth losses, restitution, poses and forces. In the air the couple is called with a normal
/// force of 0; a body with two rims is seen from the lower one. Along the impact of one rim the coefficient of friction is
/// that of the current speed; where both rims land at once it is that of the slip after the impact. A motion beyond
/// events or on a patch of contact is an error, and so are losses that are proportional to the normal force beside a couple. The default tolerance of a step is 1e-10. With `custom.friction` the
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
    let (mut ask, start) = without_friction(body, ask, start);
    if let (Some(law), Table::Rubs(Friction::Coulomb { mu, .. })) = (custom.friction, &mut ask.table) {
        *mu = law.coefficient(0.0);
    }
    let (ask, start) = (&ask, &start);
    let fault = Cell::new(None);
    let mut go_on = || !custom.has_failed() && go_on();
    let presses = ask.losses.iter().any(|(law, value)| law.presses() && value > 0.0);
    let stepped = custom.friction.filter(|_| presses);
    let mut run = |run_tol: f64, times: &[f64]| {
        let way = [0.0; 2];
        let flow =
            CustomFlow { body, ask, custom, fault: &fault, slips: false, tol: run_tol, way, keeps: MOMENT };
        let made = match stepped {
            Some(law) => {
                let own = OwnFriction { law, fault: &fault };
                let walk =
                    BodyWalk::<CUSTOM_NUMBERS, _>::of_laws(body, ask, (run_tol, tol), times, start, own)?;
                Box::new(walk).run(&mut go_on)?
            }
            None => CustomWalk::of_custom(flow, start, tol, times)?.run(&mut go_on)?,
        };
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
}

/// Checks a motion under such laws. Returns the tolerance of its steps.
fn check(body: &Body, start: &Start, ask: &Ask, custom: &Custom<'_>) -> Result<f64, Error> {
    check_options(ask, custom)?;
    let tol = body::check_walk(body, start, ask)?;
    Ok(if ask.method == Method::Exact { FAIR } else { tol })
}

/// Returns an error for options that such laws exclude.
pub(crate) fn check_options(ask: &Ask, custom: &Custom<'_>) -> Result<(), Error> {
    let refuse = |name: &'static str, value: f64| {
        Err(Error::OutOfRange { name, value, expected: "none together with a user-defined law" })
    };
    if ask.table.friction().patch() > 0.0 {
        return refuse("patch", ask.table.friction().patch());
    }
    if ask.beyond {
        return refuse("beyond", 1.0);
    }
    if let Some((law, value)) = ask.losses.iter().find(|(law, value)| law.presses() && *value > 0.0)
        && (custom.couple.is_some() || custom.friction.is_none())
    {
        let expected = "only laws without the normal force together with a user-defined couple; write this one into the couple";
        return Err(Error::OutOfRange { name: law.parameter(), value, expected });
    }
    if custom.friction.is_some() && !matches!(ask.table, Table::Rubs(Friction::Coulomb { .. })) {
        let expected = "Coulomb friction as the contact of a user-defined law of friction";
        return Err(Error::OutOfRange { name: "contact", value: f64::NAN, expected });
    }
    Ok(())
}

/// The numbers after a time with these constant rates.
fn moved(y: &[f64; CUSTOM_NUMBERS], rate: &[f64; CUSTOM_NUMBERS], by: f64) -> [f64; CUSTOM_NUMBERS] {
    core::array::from_fn(|i| by.mul_add(rate[i], y[i]))
}

/// The walk of a body under user-defined laws.
type CustomWalk<'a, 'l> = BodyWalk<'a, CUSTOM_NUMBERS, CustomFlow<'l>>;

impl<'a, 'l> CustomWalk<'a, 'l> {
    /// A walk from its initial state, with steps of the tolerance of `flow`, which exceeds the requested tolerance `fine`
    /// in a rougher run.
    fn of_custom(
        flow: CustomFlow<'l>,
        start: &Start,
        fine: f64,
        times: &'a [f64],
    ) -> Result<Box<Self>, Error> {
        let of = BodyPhases::of(flow.body, flow.ask, flow.tol, start, flow);
        let mut walk = Box::new(Self::new(of, numbers_at(start), flow.ask, fine, (start.time, times))?);
        walk.next = Some(match start.aloft {
            Some(aloft) => walk.starts_in_air(aloft),
            None => walk.first_phase()?,
        });
        if start.state.theta < flow.body.theta_end() {
            Phases::perturbs(&mut *walk);
        }
        Ok(walk)
    }

    /// The numbers at the time `lasts` after a slip has begun, by the rates at the middle of that time.
    fn slipped(&self, lasts: f64) -> [f64; CUSTOM_NUMBERS] {
        let (flow, from, way) = (&self.of.own, &self.at, self.of.own.way);
        let half = moved(from, &flow.rates_along(from, way), 0.5 * lasts);
        let mut all = moved(from, &flow.rates_along(&half, way), lasts);
        let speed = (all[UH] * way[0] + all[U2] * way[1]).max(LEAST_GROWTH * lasts);
        (all[UH], all[U2]) = (speed * way[0], speed * way[1]);
        all
    }

    /// Ends the motion if the current phase is over at once. Returns whether it is.
    fn ends_at_once(&mut self) -> bool {
        let ending = self.of.own.at_start(&self.at, &self.of.own.answer(&self.at));
        self.next = ending.map(Next::Ends);
        ending.is_some()
    }
}

/// The slow slips of user-defined laws, which have no series.
pub(crate) struct NoSeries;

impl SlowLaw<CUSTOM_NUMBERS> for NoSeries {
    fn follow(
        &mut self,
        _: &[f64; CUSTOM_NUMBERS],
        _: Series,
        _: f64,
        _: f64,
    ) -> Option<Box<SlowSeries<CUSTOM_NUMBERS>>> {
        None
    }
}

impl<'l> Phases<CUSTOM_NUMBERS> for BodyPhases<CustomFlow<'l>> {
    type State = State;
    type Slow = NoSeries;
    const SLIP: usize = UH;
    const HEAT: usize = HEAT;

    fn tol(&self) -> f64 {
        self.own.tol
    }
    fn is_dry(&self) -> bool {
        self.own.friction(0.0).sticks()
    }
    fn over(&self) -> f64 {
        slip_over(true, self.own.friction(0.0).strength())
    }

    fn loses(_: &Ask) -> bool {
        true
    }

    fn seen(walk: &CustomWalk<'_, 'l>, kind: Kind) -> Phase {
        walk.told(kind)
    }
    fn perturbs(walk: &mut CustomWalk<'_, 'l>) {
        if walk.ask.restitution.is_some() {
            let share = Self::share_of_errors(walk);
            Self::perturbs_by(walk, share);
        }
    }
    fn write(walk: &mut CustomWalk<'_, 'l>, y: &[f64; CUSTOM_NUMBERS]) {
        if let Some(phase) = &walk.of.lying {
            let flow = phase.flow;
            return walk.writes_lying(&flow, y);
        }
        walk.made.written(&walk.of.own, (&walk.of.start, y), walk.of.own.way);
    }
    fn write_here(walk: &mut CustomWalk<'_, 'l>) {
        Self::write(walk, &{ walk.at });
    }

    fn ends_slip(walk: &mut CustomWalk<'_, 'l>) -> Option<Halt> {
        walk.of.own.slips = true;
        if walk.is_level() {
            return Some(Halt::Side);
        }
        let ending = walk.of.own.at_start(&walk.at, &walk.of.own.answer(&walk.at))?;
        Some(match ending {
            Ending::Side => Halt::Side,
            Ending::LiftOff => Halt::LiftOff,
            _ => Halt::Jam,
        })
    }
    fn lies(walk: &mut CustomWalk<'_, 'l>, found: Standstill) -> Option<Ending> {
        if walk.is_level() {
            return Some(Ending::Side);
        }
        let flow = &walk.of.own;
        let at = match found {
            Standstill::Slips { alpha, .. } => {
                flow.slides(walk.at.angle(), walk.at.w(), [0.0; 2], Some(towards(alpha)))
            }
            _ => flow.rolls(walk.at.angle(), walk.at.w()),
        };
        flow.at_start(&walk.at, &at).filter(|ending| *ending == Ending::Side)
    }
    fn begins_without_slip(_: &mut CustomWalk<'_, 'l>) -> Next {
        Next::Rolls { at_limit: false }
    }
    fn rests(walk: &CustomWalk<'_, 'l>) -> Standstill {
        walk.of.own.standstill(&state(&walk.at))
    }
    /// At the limit itself a slip does not grow; later it does.
    fn lets_go(walk: &CustomWalk<'_, 'l>) -> Standstill {
        let flow = CustomFlow { slips: false, ..walk.of.own };
        let half = 0.5 * KEEPS_ITS_WAY * flow.moment(&walk.at);
        flow.standstill(&state(&moved(&walk.at, &flow.rates(&walk.at), half)))
    }
    fn no_unique_force(walk: &CustomWalk<'_, 'l>) -> Error {
        let flow = &walk.of.own;
        flow.fault.take().unwrap_or_else(|| {
            let theta = state(&walk.at).theta;
            let (mu, limit) = (flow.friction(0.0).strength(), painleve(flow.body, theta));
            Error::Painleve { mu, theta, limit }
        })
    }

    fn normal_here(walk: &CustomWalk<'_, 'l>) -> f64 {
        walk.of.own.force(&walk.of.state, walk.at.slip(), walk.of.own.way).normal
    }
    fn audits(walk: &mut CustomWalk<'_, 'l>) {
        walk.compares_energy();
    }
    /// A law that fails in an impact or in the air interrupts the motion there.
    fn is_over(walk: &mut CustomWalk<'_, 'l>, _: &Next, _: bool) -> bool {
        let fails = walk.of.own.custom.has_failed();
        if fails {
            walk.made.motion.limit = Some(Limit::Interrupted);
            walk.records_event(Ending::Bounded);
        }
        fails
    }
    fn goes_on(walk: &mut CustomWalk<'_, 'l>, ending: Ending) -> Next {
        walk.continues_after(ending)
    }
    fn goes(
        walk: &mut CustomWalk<'_, 'l>,
        kind: Kind,
        _: &mut dyn FnMut() -> bool,
    ) -> Result<Option<WalkStep<CUSTOM_NUMBERS>>, Error> {
        if kind != Kind::Flying {
            return Ok(walk.lies());
        }
        walk.flies();
        Ok(None)
    }
    fn slip_kind(walk: &CustomWalk<'_, 'l>) -> Kind {
        walk.kind_of_slip()
    }

    fn slips(walk: &mut CustomWalk<'_, 'l>) -> [f64; CUSTOM_NUMBERS] {
        walk.of.own.slips = true;
        walk.at
    }
    fn slips_on(walk: &mut CustomWalk<'_, 'l>) -> [f64; CUSTOM_NUMBERS] {
        walk.at
    }
    fn begins_slowly(_: &CustomWalk<'_, 'l>) -> bool {
        false
    }
    fn has_series(_: &CustomWalk<'_, 'l>) -> bool {
        false
    }
    fn lets_slip(walk: &mut CustomWalk<'_, 'l>, way: [f64; 2]) {
        (walk.of.own.slips, walk.of.own.way) = (true, way);
    }
    fn slow(_: &CustomWalk<'_, 'l>) -> NoSeries {
        NoSeries
    }
    fn clear_until(_: &CustomWalk<'_, 'l>, series: &SlowSeries<CUSTOM_NUMBERS>) -> f64 {
        series.until
    }
    fn nudged(walk: &mut CustomWalk<'_, 'l>, way: [f64; 2], growth: f64) -> [f64; CUSTOM_NUMBERS] {
        if let Some(phase) = &walk.of.lying {
            return phase.flow.nudged(&walk.at, way, growth);
        }
        let (from, keeps) = (walk.at[TIME], walk.of.own.keeps);
        while let Some(t) = walk.until().filter(|t| *t <= from + keeps) {
            let y = walk.slipped(t - from);
            Self::write(walk, &y);
        }
        walk.slipped(keeps)
    }
    fn rolls(
        walk: &mut CustomWalk<'_, 'l>,
        _: bool,
        _: &mut dyn FnMut() -> bool,
    ) -> Result<Option<WalkStep<CUSTOM_NUMBERS>>, Error> {
        walk.of.own.slips = false;
        Ok((!walk.ends_at_once()).then_some(WalkStep::Flows(walk.at)))
    }
    fn first(walk: &CustomWalk<'_, 'l>, y: &[f64; CUSTOM_NUMBERS]) -> f64 {
        let first = walk.of.lying.as_ref().map_or_else(|| walk.of.own.first(y), |phase| phase.flow.first(y));
        // As for the laws of the library, so that two runs that hop do not take the same steps.
        if walk.perturbation > 0.0 && walk.ask.restitution.is_some() { LONGER * first } else { first }
    }

    fn flows(
        walk: &mut CustomWalk<'_, 'l>,
        y: [f64; CUSTOM_NUMBERS],
        steps: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<CUSTOM_NUMBERS>, Error> {
        if walk.of.lying.is_some() {
            return walk.lies_on(y, steps, go_on);
        }
        let (flow, start, way) = (walk.of.own, walk.of.start, walk.of.own.way);
        let fault = flow.fault.take().or_else(|| flow.supplies(&y, &flow.rates(&y)));
        if let Some(fault) = fault.filter(|_| !flow.custom.has_failed()) {
            return Err(fault);
        }
        let (first, made) = (walk.made.motion.states.len(), &mut walk.made);
        let mut write = |y: &[f64; CUSTOM_NUMBERS]| made.written(&flow, (&start, y), way);
        let flown = flow.run(flow.place(y), steps, &walk.since[first..], &mut write, go_on);
        let exhausted = flown.spent.exhausted;
        walk.has_spent(flown.spent);
        if let Some(fault) = flow.fault.take().filter(|_| flown.halt == Halt::Endless)
            && exhausted != Some(Exhausted::Interrupted)
        {
            return Err(fault);
        }
        let short = matches!(exhausted, Some(Exhausted::Crawling | Exhausted::Evaluations));
        if short && flow.is_kept_short(&flown.y, flown.step) {
            walk.made.motion.limit = Some(Limit::Stiff);
        }
        walk.claims_time_error(flown.halt, flown.steep, &flown.y);
        Self::slip_halts(walk, flown.y, flown.halt);
        Ok(Pause::No)
    }

    /// Ends a phase, with or without a slip.
    fn slip_halts(walk: &mut CustomWalk<'_, 'l>, y: [f64; CUSTOM_NUMBERS], halt: Halt) {
        if walk.of.lying.is_some() {
            walk.stops_lying(y, halt);
            return;
        }
        walk.at = y;
        if leans_over(&mut walk.at) {
            walk.of.own.way = walk.of.own.way.map(|u| -u);
        }
        walk.of.state = state(&walk.at);
        if halt == Halt::Side {
            walk.of.state.theta = walk.of.body.theta_end();
        }
        if walk.of.own.slips {
            walk.made.path.slipping += y[TIME] - walk.began;
        }
        let share = if halt == Halt::Slips { KEEPS_ITS_WAY } else { MOMENT };
        walk.of.own.keeps = share * walk.of.own.moment(&walk.at);
        match halt {
            Halt::Time | Halt::Pause => {}
            Halt::Standstill => {
                walk.stop_slip();
                walk.continues_with(after_rest(Self::rests(walk)));
            }
            Halt::Slips if walk.ask.table.rubs() => {
                walk.continues_with(after_rest(Self::lets_go(walk)));
            }
            Halt::Face => {
                let falls = y[COS] * y[W2];
                walk.at[TIME] += if falls > 0.0 { y[SIN] / falls } else { 0.0 };
                walk.at[SIN] = 0.0;
                walk.of.state = state(&walk.at);
                walk.next = Some(Next::Ends(Ending::Face));
            }
            halt => walk.next = Some(Next::Ends(ending(halt))),
        }
    }

    fn grows(&self, halt: Halt, y: &[f64; CUSTOM_NUMBERS]) -> Option<f64> {
        match halt {
            Halt::Side | Halt::Rises | Halt::Changes | Halt::Turned => Some(1.0),
            Halt::LiftOff | Halt::Slips | Halt::Jam => Some(<Slide>::fastest(y)),
            _ => None,
        }
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
            let turns = if flow.slips && speed > 0.0 { flow.tol * <Slide>::fastest(y) / speed } else { 0.0 };
            (force, doubt + turns.min(1.0) * force.along.hypot(force.across))
        });
        self.push(OutputRow {
            pose,
            force,
            ..OutputRow::on_table(now, slip, [y[HEAT], lost(y)], flow.kind())
        });
    }
}
