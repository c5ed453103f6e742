//! The phases of a body of revolution: their beginnings, their flows and their ends.

use super::fly::Takeoff;
use super::lie::flow::LyingPhase;
use super::own::Own;
use super::roll::lossy::LossyFlow;
use super::slide::Slide;
use super::slide::slow::{BodySlips, Slippery};
use super::spun::{Roundings, knows};
use super::tail::{LastTurns, Nods};
use super::write::{self, state};
use super::{check_walk, without_friction};
use crate::error::Error;
use crate::laws::body::Body;
use crate::laws::contact::lossy::{Acted, Lossy};
use crate::laws::contact::slip::{Friction, centre_velocity, painleve};
use crate::laws::contact::standstill::{Standstill, let_go, standstill, towards};
use crate::laws::contact::{Contact, Force, Table, force};
use crate::laws::loss::{Couples, Holds, Losses};
use crate::laws::state::{State, drilling_of, rolling_of};
use crate::methods::flow::{Flow, FlowPlace, Steps};
use crate::motions::ask::row::OutputRow;
use crate::motions::dry::creep::Creeps;
use crate::motions::dry::friction::slipped;
use crate::motions::walk::errors::doubted;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, Halt, SIN, TIME, U2, UH, W1, W2, W3, leans_over, loses, lost, poses,
};
use crate::motions::walk::slow::clear_until;
use crate::motions::walk::two_runs::CHANCE;
use crate::motions::walk::{Next, Pause, Phases, STILL, SlowSeries, Walk, WalkStep};
use crate::motions::{Ask, Ending, Kind, Limit, Phase, Start};
use core::f64::consts::{FRAC_PI_2, PI};

/// The walk of a body of revolution.
pub(crate) type BodyWalk<'a, const N: usize, G = ()> = Walk<'a, BodyPhases<G>, N>;

/// Sine of theta below which a falling face counts as landed if slipping and sticking alternate without an advance of
/// time.
const ALL_BUT_FLAT: f64 = 1e-6;
/// The first step of a rougher run is this many times as long as that of the finer run, so that
/// their steps differ.
pub(crate) const LONGER: f64 = 3.0;
/// The first step of a phase, as a share of the last step of the phase of its kind before.
const LATELY: f64 = 0.5;

/// Size of cos theta below which a rougher run perturbs this number and not theta.
const LEVEL: f64 = 1e-3;

/// The data of a body's walk: its equations, and the current phase.
pub(crate) struct BodyPhases<G: Own = ()> {
    pub body: Body,
    /// The laws of the user.
    pub own: G,
    pub slide: Slide<G>,
    /// The state where the current phase begins or has ended, and the initial state.
    pub state: State,
    pub start: State,
    /// Whether a phase without a slip is integrated; otherwise the first integrals solve it, as long as no energy is
    /// lost.
    pub(super) integrates: bool,
    /// Whether the last phase of rolling by the first integrals was brief, and whether the current one, without losses, is
    /// integrated.
    pub(crate) rolls_briefly: bool,
    pub(crate) by_steps: bool,
    /// Whether the body is a uniform ball, whose phases are known; and their errors.
    pub(super) uniform: bool,
    pub(super) roundings: Roundings,
    /// Whether the caller computes the phases of rolling that the first integrals solve, among those of other walks.
    #[cfg(feature = "many")]
    pub(crate) rolls_among: bool,
    /// The current phase, if it loses energy without a slip.
    pub(super) lossy: Option<LossyPhase<G>>,
    /// The current phase, if the body lies on both rims.
    pub(crate) lying: Option<Box<LyingPhase<G>>>,
    /// The beginning of the next flight, or the height and the vertical velocity of a body in the air.
    pub(super) takeoff: Takeoff,
    /// The energy that the impacts before the last one have taken, and the sum of energy, heat and all that was lost
    /// at the start.
    pub(super) struck: f64,
    pub(super) energy: Option<f64>,
    /// The step errors by which a rougher run has been perturbed.
    pub(super) shown: f64,
    /// Whether only theta changes, so that rounding must not make the body turn.
    pub(super) planar: bool,
    /// The steps at the ends of the last slip and of the last phase that loses energy without one, in their variables.
    pub(super) lately: [f64; 2],
    /// Estimates of the end of a slipping whirr; None if the losses do not let a whirr last for infinitely many turns.
    pub(super) tail: Option<LastTurns>,
    /// The slips in its nods; None if a loss stops the contact along the rim.
    pub(super) nods: Option<Box<Nods>>,
}

/// A phase that loses energy without a slip.
#[derive(Clone, Copy)]
pub(super) struct LossyPhase<G = ()> {
    pub(super) flow: LossyFlow<G>,
}

impl<'a, const N: usize> BodyWalk<'a, N> {
    /// A walk from its initial state, with steps of the tolerance `tol`, which is the requested tolerance or a larger
    /// one.
    pub fn of_body(body: &Body, ask: &Ask, tol: f64, times: &'a [f64], start: &Start) -> Result<Self, Error> {
        let fine = check_walk(body, start, ask)?;
        let (ask, start) = without_friction(body, ask, start);
        Self::of_laws(body, &ask, (tol, fine), times, &start, ())
    }
}

impl<'a, G: Own, const N: usize> BodyWalk<'a, N, G> {
    /// A walk under these laws, with steps of the tolerance `tol`, where `fine` is the requested one.
    pub fn of_laws(
        body: &Body,
        ask: &Ask,
        (tol, fine): (f64, f64),
        times: &'a [f64],
        start: &Start,
        own: G,
    ) -> Result<Self, Error> {
        let &Start { time, aloft, .. } = start;
        let at = numbers_at(start);
        let mut of = BodyPhases::of(body, ask, tol, start, own);
        of.uniform = !G::IS && !poses(N) && knows(body, ask);
        let mut walk = Self::new(of, at, ask, fine, (time, times))?;
        walk.next = Some(match aloft {
            Some(aloft) => walk.starts_in_air(aloft),
            None => walk.first_phase()?,
        });
        if start.state.theta < body.theta_end() {
            Phases::perturbs(&mut walk);
        }
        Ok(walk)
    }
}

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// The flow of the current phase, if the body loses energy without a slip.
    pub fn lossy(&self) -> Option<&LossyFlow<G>> {
        self.of.lossy.as_ref().map(|phase| &phase.flow)
    }

    pub fn contact(&self) -> Contact {
        self.ask.table.contact()
    }

    /// All numbers of a flow of which a lane has computed only the first ones. The missing energy has become heat, or
    /// is lost to the losses.
    pub fn followed(&self, from: &[f64; N], y: [f64; N]) -> [f64; N] {
        let mut all = y;
        all[8..].copy_from_slice(&from[8..]);
        match self.lossy() {
            Some(flow) => {
                let energy = |y: &[f64; N]| self.contact().energy(&self.of.body, &state(&flow.shown(y)));
                all[N - 1] += energy(from) - energy(&y);
            }
            None => all[HEAT] += self.of.slide.energy(from) - self.of.slide.energy(&y),
        }
        all
    }

    /// Moves the walk to the numbers at which a flow has halted.
    pub(super) fn arrives(&mut self, at: [f64; N]) {
        self.at = at;
        if leans_over(&mut self.at) {
            self.of.slide.leans_over();
        }
        self.of.state = state(&self.at);
    }

    /// The force of the table on one rim in the state `y`, with the current slip.
    pub(crate) fn force_on_rim(&self, y: &State) -> Force {
        if self.slips_here() {
            return self.of.slide.law.force(y, self.at.slip());
        }
        let (body, contact) = (&self.of.body, self.contact());
        match self.of.couples(&self.ask) {
            Some(losses) => Lossy { rates: contact.rates(body), losses }.moves(y).1,
            None => force(contact, body, y),
        }
    }

    /// w' of a body that rolls, and the power of its losses.
    pub(super) fn rolling_of(&self, y: &State) -> ([f64; 3], f64) {
        let losses =
            self.of.couples(&self.ask).unwrap_or(Couples::of(&Losses::NONE, |x| x).beside(self.of.own));
        let Acted { w, power, .. } =
            Lossy { rates: Contact::Rolling.rates(&self.of.body), losses }.in_state(y);
        (w, power)
    }

    /// Whether the contact point slips.
    pub(super) fn slips_here(&self) -> bool {
        let (slip, slide) = (self.at.slip(), &self.of.slide);
        self.ask.table.rubs() && (slip != [0.0; 2] || !slide.law.dry || slide.creeps(&self.at))
    }

    /// Makes motions vanish exactly that have stopped, or that dry friction has held at zero but for the errors of the
    /// steps.
    pub(super) fn stops_exactly(&mut self, stops: Holds) {
        if stops == Holds::default() {
            return;
        }
        let (s, c) = state(&self.at).theta.sin_cos();
        let [w1, w2, w3] = self.at.w();
        let (drilling, rolling) = (drilling_of((s, c), w1, w3), rolling_of((s, c), w1, w3));
        let mut left = 0f64;
        if stops.drilling {
            (self.at[W1], self.at[W3]) = (w1 - s * drilling, w3 - c * drilling);
            left = drilling.abs();
        }
        if stops.contour || stops.rolling {
            (self.at[W1], self.at[W3]) = (self.at[W1] - c * rolling, self.at[W3] + s * rolling);
            left = left.max(rolling.abs());
        }
        if stops.rolling {
            (self.at[W2], left) = (0.0, left.max(w2.abs()));
        }
        if stops.drilling && (stops.contour || stops.rolling) {
            (self.at[W1], self.at[W3]) = (0.0, 0.0);
        }
        self.claims(left);
        self.of.state = state(&self.at);
    }

    /// Whether a body at theta_end, whose contact point rests, rises under the contact force.
    fn rises(&self, found: Standstill) -> bool {
        let y = &self.of.state;
        let rate = match found {
            Standstill::Slips { alpha, .. } => {
                let w = [y.w1, y.w2, y.w3];
                self.of.slide.law.towards(y.theta.sin_cos(), w, [0.0; 2], towards(alpha)).w[1]
            }
            _ if !self.of.loses(&self.ask) => Contact::Rolling.derivative(&self.of.body, y).w2,
            _ => self.rolling_of(y).0[1],
        };
        y.w2 > 0.0 || (y.w2 == 0.0 && rate > 0.0)
    }
}

/// The first numbers of a motion from this start.
pub(crate) fn numbers_at<const N: usize>(start: &Start) -> [f64; N] {
    let (State { theta, w1, w2, w3 }, [along, across]) = (start.state, start.slip);
    let ((s, c), mut at) = (theta.sin_cos(), [0.0; N]);
    at[..TIME].copy_from_slice(&[s, c, w1, w2, w3, along, across]);
    at
}

impl<G: Own> BodyPhases<G> {
    /// Whether a loss or a couple of the user takes energy.
    pub(super) fn loses(&self, ask: &Ask) -> bool {
        !ask.losses.is_none() || self.own.has_couple()
    }

    /// The losses, and the couple of the user beside them; None if nothing is lost.
    pub(super) fn couples(&self, ask: &Ask) -> Option<Couples<f64, G>> {
        Couples::with_own(&ask.losses, self.own)
    }

    /// The data of a walk under these laws, with steps of the tolerance `tol`.
    pub(crate) fn of(body: &Body, ask: &Ask, tol: f64, start: &Start, own: G) -> Self {
        let &Start { state, slip, .. } = start;
        let friction = ask.table.friction();
        let slide = Slide::new(body, &friction, &ask.losses, tol, own);
        let loses = !ask.losses.is_none() || friction.patch() > 0.0 || own.has_couple();
        Self {
            body: *body,
            own,
            slide,
            state,
            start: state,
            integrates: ask.table == Table::Smooth || loses,
            rolls_briefly: false,
            by_steps: false,
            uniform: false,
            roundings: Roundings::default(),
            #[cfg(feature = "many")]
            rolls_among: false,
            lossy: None,
            lying: None,
            takeoff: Takeoff::default(),
            struck: 0.0,
            energy: None,
            shown: 0.0,
            planar: state.w1 == 0.0 && state.w3 == 0.0 && slip[1] == 0.0 && !own.has_couple(),
            lately: [0.0; 2],
            tail: (!G::IS && !body.is_ball() && ask.losses.turn_endlessly()).then(LastTurns::default),
            nods: (!G::IS && !body.is_ball() && !ask.losses.stop_the_contour()).then(Box::default),
        }
    }

    /// Perturbs the state by this share.
    pub(crate) fn perturbs_by<const N: usize>(walk: &mut BodyWalk<'_, N, G>, share: f64)
    where
        Self: Phases<N>,
    {
        if share == 0.0 || walk.of.lying.is_some() {
            return;
        }
        let (down, up) = (1.0 - share, 1.0 + share);
        let State { theta, w1, w2, w3 } = walk.of.state;
        // Drilling w_z, rolling w_h and rocking w2 are each changed by a share of themselves: a motion that is zero
        // stays zero.
        let (s, c) = theta.sin_cos();
        let (drilling, rolling) = (drilling_of((s, c), w1, w3) * up, rolling_of((s, c), w1, w3) * up);
        // Near its other rim the height of the body is known from cos theta, not from theta.
        let near = walk.ask.restitution.is_some() && walk.at[COS].abs() < LEVEL;
        let theta = if near { theta } else { theta * down };
        let (s, c) = if near { (walk.at[SIN], walk.at[COS] * down) } else { theta.sin_cos() };
        let (w1, w3) = (s * drilling + c * rolling, c * drilling - s * rolling);
        walk.of.state = State { theta, w1, w2: w2 * down, w3 };
        walk.at[..5].copy_from_slice(&[s, c, w1, w2 * down, w3]);
    }

    /// The share by which a rougher run perturbs the state at the end of a phase. A motion that has hopped is also
    /// perturbed by a share of the step errors since the last time: impacts multiply them, and where both runs take the
    /// same steps only this shows by how much.
    pub(crate) fn share_of_errors<const N: usize>(walk: &mut BodyWalk<'_, N, G>) -> f64
    where
        Self: Phases<N, State = State>,
    {
        let mut share = walk.perturbation;
        if share > 0.0 && !walk.made.path.impacts.is_empty() {
            let erred = walk.spent.erred - core::mem::replace(&mut walk.of.shown, walk.spent.erred);
            share += CHANCE * erred * walk.of.slide.tol * walk.sign_of_rounding();
        }
        share
    }
}

impl<G: Own, const N: usize> Phases<N> for BodyPhases<G> {
    type State = State;
    type Slow = BodySlips;
    const SLIP: usize = 5;
    const HEAT: usize = 8;

    fn tol(&self) -> f64 {
        self.slide.tol
    }
    fn is_dry(&self) -> bool {
        self.slide.law.dry
    }
    fn over(&self) -> f64 {
        self.slide.over()
    }
    fn loses(ask: &Ask) -> bool {
        G::IS || !ask.losses.is_none()
    }
    fn seen(walk: &BodyWalk<'_, N, G>, kind: Kind) -> Phase {
        walk.told(kind)
    }

    fn perturbs(walk: &mut BodyWalk<'_, N, G>) {
        let share = Self::share_of_errors(walk);
        BodyPhases::perturbs_by(walk, share);
    }

    fn write(walk: &mut BodyWalk<'_, N, G>, y: &[f64; N]) {
        if let Some(phase) = &walk.of.lying {
            let flow = phase.flow;
            return walk.writes_lying(&flow, y);
        }
        walk.made.slid(&walk.ask, &walk.of.slide, y);
    }

    fn write_here(walk: &mut BodyWalk<'_, N, G>) {
        let (y, slip, at) = (&walk.of.state, walk.at.slip(), &walk.at);
        let kind = if walk.slips_here() { Kind::Slipping } else { walk.kind() };
        let force = walk.ask.force.then(|| doubted(y, [0.0; 2], |y| walk.force_on_rim(y)));
        let pose = poses(N).then(|| write::pose(at));
        let row = OutputRow::on_table(*y, slip, [at[HEAT], lost(at)], kind);
        walk.made.push(OutputRow { pose, force, ..row });
    }

    fn ends_slip(walk: &mut BodyWalk<'_, N, G>) -> Option<Halt> {
        if walk.is_level() {
            return Some(Halt::Side);
        }
        walk.of.slide.at_start(&walk.of.state, walk.at.slip())
    }

    fn lies(walk: &mut BodyWalk<'_, N, G>, found: Standstill) -> Option<Ending> {
        let (end, theta) = (walk.of.body.theta_end(), walk.of.state.theta);
        let lies = end < PI && (theta > end || theta == end && (walk.is_level() || !walk.rises(found)));
        lies.then_some(Ending::Side)
    }

    /// A phase without a slip checks its own margins when it begins.
    fn begins_without_slip(_: &mut BodyWalk<'_, N, G>) -> Next {
        Next::Rolls { at_limit: false }
    }

    fn rests(walk: &BodyWalk<'_, N, G>) -> Standstill {
        let of = &walk.of;
        standstill(&of.body, &of.state, &walk.friction(), of.couples(&walk.ask))
    }
    fn lets_go(walk: &BodyWalk<'_, N, G>) -> Standstill {
        let of = &walk.of;
        let_go(&of.body, &of.state, &walk.friction(), of.couples(&walk.ask))
    }

    fn no_unique_force(walk: &BodyWalk<'_, N, G>) -> Error {
        let (mu, theta) = (walk.friction().strength(), walk.of.state.theta);
        let limit = painleve(&walk.of.body, theta);
        walk.of.own.takes_fault().unwrap_or(Error::Painleve { mu, theta, limit })
    }

    fn normal_here(walk: &BodyWalk<'_, N, G>) -> f64 {
        walk.force_on_rim(&walk.of.state).normal
    }
    fn audits(walk: &mut BodyWalk<'_, N, G>) {
        walk.compares_energy();
    }
    fn is_over(walk: &mut BodyWalk<'_, N, G>, next: &Next, given_up: bool) -> bool {
        // A law of the user that fails in an impact or in the air interrupts the motion there.
        if walk.of.own.has_failed() {
            walk.made.motion.limit = Some(Limit::Interrupted);
            walk.records_event(Ending::Bounded);
            return true;
        }
        let fall = walk.at[COS] * walk.at[W2];
        if loses(N) && walk.still > STILL && walk.at[SIN] < ALL_BUT_FLAT && fall > 0.0 {
            // Whether the face slips or sticks no longer matters, since it is almost on the table.
            let left = walk.at[SIN] / fall;
            walk.lies_flat([walk.at[TIME] + left, left]);
            return true;
        }
        if matches!(next, Next::SlipsOff { .. }) {
            walk.nods();
        }
        if (given_up || matches!(next, Next::SlipsOff { .. })) && walk.nods_end(given_up) {
            return true;
        }
        if matches!(next, Next::Slips | Next::SlipsOff { .. })
            && let Some(end) = walk.whirr_ends(&{ walk.at })
        {
            walk.made.path.leaves_turns = true;
            walk.lies_flat(end);
            return true;
        }
        false
    }

    fn goes_on(walk: &mut BodyWalk<'_, N, G>, ending: Ending) -> Next {
        walk.continues_after(ending)
    }
    fn goes(
        walk: &mut BodyWalk<'_, N, G>,
        kind: Kind,
        _: &mut dyn FnMut() -> bool,
    ) -> Result<Option<WalkStep<N>>, Error> {
        if kind != Kind::Flying {
            return Ok(walk.lies());
        }
        walk.flies();
        Ok(None)
    }
    fn slip_kind(walk: &BodyWalk<'_, N, G>) -> Kind {
        walk.kind_of_slip()
    }

    fn slips_known(walk: &mut BodyWalk<'_, N, G>) -> bool {
        let left = walk.of.slide.has_died(&walk.at);
        walk.of.slide.died = left.is_some();
        if let Some(left) = left {
            walk.drops_slip(left);
        }
        match walk.of.slide.creeping.filter(|_| left.is_some()) {
            _ if poses(N) => return false,
            Some(creeping) => walk.creeps_uniformly(creeping),
            None if walk.of.uniform => walk.slips_uniformly(),
            None => return false,
        }
        true
    }
    fn slips(walk: &mut BodyWalk<'_, N, G>) -> [f64; N] {
        walk.of.slide.sets_ways(&walk.of.state, walk.at.slip(), [0.0; 2], None);
        Self::slips_on(walk)
    }
    fn slips_on(walk: &mut BodyWalk<'_, N, G>) -> [f64; N] {
        if walk.of.slide.begins_to_roll().is_some() {
            return walk.begins_at_once([0.0; 2], 0.0);
        }
        walk.of.slide.enter(&walk.at)
    }

    fn rubbing(walk: &BodyWalk<'_, N, G>) -> f64 {
        walk.of.slide.rubs(&walk.at)
    }
    fn begins_slowly(walk: &BodyWalk<'_, N, G>) -> bool {
        !G::IS && walk.of.slide.law.patch().is_none() && walk.of.slide.begins_to_roll().is_none()
    }

    fn has_series(walk: &BodyWalk<'_, N, G>) -> bool {
        let (of, slide) = (&walk.of, &walk.of.slide);
        let alone = of.lossy.is_none() && of.lying.is_none();
        alone && slide.law.dry && !slide.settled && Self::begins_slowly(walk)
    }

    fn lets_slip(walk: &mut BodyWalk<'_, N, G>, way: [f64; 2]) {
        if walk.of.lying.is_none() {
            walk.of.slide.sets_ways(&walk.of.state, [0.0; 2], way, None);
        }
    }
    fn slow(walk: &BodyWalk<'_, N, G>) -> BodySlips {
        let tol = walk.of.slide.tol;
        match &walk.of.lying {
            Some(phase) => BodySlips::of(&Slippery::Two(phase.flow.law, phase.flow.ways), tol, N),
            None => BodySlips::of(&Slippery::One(walk.of.slide.of_the_library()), tol, N),
        }
    }

    fn is_slow(walk: &BodyWalk<'_, N, G>, known: &BodySlips) -> bool {
        walk.of.lying.is_none() && known.are_under(&walk.of.slide.of_the_library())
    }

    fn clear_until(walk: &BodyWalk<'_, N, G>, series: &SlowSeries<N>) -> f64 {
        if let Some(phase) = &walk.of.lying {
            return clear_until(series.until, |_, moment| {
                let place = FlowPlace { y: series.at(moment), carry: [0.0; N], rate: [0.0; N] };
                phase.flow.margins(&place).map(|margin| margin.value)
            });
        }
        let slide = &walk.of.slide;
        clear_until(series.until, |t, moment| {
            let moved = series.at(moment);
            let place = FlowPlace { y: moved, carry: [0.0; N], rate: [0.0; N] };
            let mut all = slide.margins(&place).map(|margin| margin.value);
            // The margins of a face and of the other rim do not depend on the slip, and are those at the time itself.
            let y = series.at(t);
            (0..2).filter(|i| slide.watches(*i)).for_each(|i| all[i] = slide.margin(&y, i));
            // The margin of a jam is proportional to the speed of a dry slip, and that speed may dip.
            all[W2] /= if slide.law.dry { moved[UH].hypot(moved[U2]) } else { 1.0 };
            all
        })
    }

    fn nudged(walk: &mut BodyWalk<'_, N, G>, way: [f64; 2], growth: f64) -> [f64; N] {
        if let Some(phase) = &walk.of.lying {
            return phase.flow.nudged(&walk.at, way, growth);
        }
        let slide = walk.of.slide;
        let begins = walk.at.slip() == [0.0; 2] && way != [0.0; 2] && slide.begins_to_roll().is_none();
        if G::IS && begins {
            let (at, moment) = (walk.at, slide.moment(&walk.at));
            return walk.keeps_its_way(growth, moment, |lasts| {
                slipped(&at, UH, (way, lasts), |y| slide.rates_along(y, way))
            });
        }
        let y = slide.nudged(&walk.at, way, growth);
        walk.of.slide.rolls_freely();
        y
    }

    fn rolls(
        walk: &mut BodyWalk<'_, N, G>,
        at_limit: bool,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<WalkStep<N>>, Error> {
        walk.rolls_on(at_limit, go_on)
    }

    /// The first step is a share of the last one of the phase of its kind before, since a body that slips in each nod
    /// does so with much the same steps.
    /// The first step of a rougher run is longer. Two runs with the same steps would have the same errors, and their
    /// difference would not show the growth of these errors from an unstable initial state.
    fn first(walk: &BodyWalk<'_, N, G>, y: &[f64; N]) -> f64 {
        let first = match (&walk.of.lying, walk.lossy()) {
            (Some(phase), _) => phase.flow.first(y),
            (_, Some(flow)) => flow.first(y).max((LATELY * walk.of.lately[1]).min(flow.calm(y))),
            _ => {
                let slide = &walk.of.slide;
                let pace = if slide.law.dry { slide.rubs(y) / (slide.rubs(y) + slide.law.soft) } else { 1.0 };
                slide.first(y).max((LATELY * walk.of.lately[0]).min(slide.calm(y) / pace))
            }
        };
        if walk.perturbation > 0.0 { LONGER * first } else { first }
    }

    fn flows(
        walk: &mut BodyWalk<'_, N, G>,
        y: [f64; N],
        steps: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        if walk.of.lying.is_some() {
            return walk.lies_on(y, steps, go_on);
        }
        match walk.of.lossy {
            Some(LossyPhase { flow, .. }) => walk.loses(&flow, y, steps, go_on),
            None => walk.slides(walk.of.slide.place(y), steps, go_on),
        }
    }

    fn slip_halts(walk: &mut BodyWalk<'_, N, G>, y: [f64; N], halt: Halt) {
        if walk.of.lying.is_some() {
            walk.stops_lying(y, halt);
            return;
        }
        walk.slip_ends(y, halt);
    }

    fn leaves_margin(walk: &BodyWalk<'_, N, G>, halt: Halt) -> bool {
        halt == Halt::Side
            && walk.of.body.theta_end() == FRAC_PI_2
            && walk.made.path.phases.last().is_some_and(|phase| phase.state.theta == FRAC_PI_2)
    }

    /// The error of a margin that depends on a force is proportional to the largest speed.
    fn grows(&self, halt: Halt, y: &[f64; N]) -> Option<f64> {
        match halt {
            Halt::Side | Halt::Rests | Halt::Rises | Halt::Changes | Halt::Turned => Some(1.0),
            Halt::LiftOff | Halt::Slips | Halt::Jam => Some(<Slide>::fastest(y)),
            _ => None,
        }
    }
}
