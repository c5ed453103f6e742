//! The phases of motion of a body of revolution: their beginnings, their equations and their ends.
use super::body_walk::{BodyPhases, BodyWalk, LossyPhase};
use super::own::Own;
use super::slide::Slide;
use super::slide::slow::{BodySlips, Slippery};
use super::write::{self, state};
use crate::error::Error;
use crate::laws::contact::lossy::{Acted, Lossy};
use crate::laws::contact::slip::{Friction, painleve};
use crate::laws::contact::standstill::{Standstill, let_go, standstill, towards};
use crate::laws::contact::{Contact, Force, force};
use crate::laws::loss::{Couples, Holds, Law, Losses};
use crate::laws::state::{State, rolling_of};
use crate::methods::flow::{Flow, FlowPlace, Steps};
use crate::motions::ask::row::OutputRow;
use crate::motions::dry::creep::Creeps;
use crate::motions::dry::friction::slipped;
use crate::motions::walk::errors::doubted;
use crate::motions::walk::hops::LONGER;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, Halt, SIN, TIME, U2, UH, W1, W2, W3, loses, lost, poses,
};
use crate::motions::walk::slow::clear_until;
use crate::motions::walk::{Next, Pause, Phases, STILL, SlowSeries, WalkStep};
use crate::motions::{Ask, Ending, Kind, Limit, Phase};
use core::f64::consts::PI;

/// A falling face counts as landed below this sine of theta if slipping and sticking alternate without an advance of
/// time.
const ALL_BUT_FLAT: f64 = 1e-6;
/// The first integration step of a phase, over the last step of the previous phase of its kind.
const LATELY: f64 = 0.5;
/// A patch of contact that drills more slowly than this, as by rounding, counts as not drilling.
const HARDLY_DRILLS: f64 = 1e-13;
/// If abs(cos(theta)) is below this, the run with the larger tolerance perturbs cos(theta) instead of theta.
const LEVEL: f64 = 1e-3;
/// The first integration step of a body on its face.
const STANDING: f64 = 0.05;

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// The force of the table on one rim in the state `y`, with the current slip.
    pub(crate) fn force_on_rim(&self, y: &State) -> Force {
        if self.slips_here() {
            self.of.slide.asks_drive(&self.at);
            return self.of.slide.law.force(y, self.at.slip());
        }
        let (body, contact) = (&self.of.body, self.contact());
        match self.couples() {
            Some(losses) => Lossy { rates: contact.rates(body), losses }.moves(y).1,
            None => force(contact, body, y),
        }
    }

    /// w' = dw/dt of a body that rolls in the state `y`, and the power of its losses.
    pub(super) fn rolling_of(&self, y: &State) -> ([f64; 3], f64) {
        self.rolling_at(&self.at, y)
    }

    /// w' = dw/dt of a body that rolls in the state `y`, and the power of its losses, at the place and the heading
    /// phi of the state vector `at`.
    pub(super) fn rolling_at(&self, at: &[f64; N], y: &State) -> ([f64; 3], f64) {
        let mut losses = self.couples().unwrap_or(Couples::of(&Losses::NONE, |x| x).beside(self.of.own));
        if self.of.turning == 0.0 && (self.of.tilt != 0.0 || self.of.own.drives()) {
            self.of.slide.asks_drive(at);
            losses = losses.pulled(self.of.slide.pull(at));
        }
        let Acted { w, power, .. } =
            Lossy { rates: Contact::Rolling.rates(&self.of.body), losses }.in_state(y);
        (w, power)
    }

    /// Whether a user-defined drive does work, or a turntable does work that [`Slide::energy`] does not include,
    /// since a slope or the air also acts on the angular momentum about the vertical.
    pub(super) fn is_driven(&self) -> bool {
        self.of.own.drives()
            || self.of.turning != 0.0 && (self.of.tilt != 0.0 || Couples::in_air(&self.ask.losses).is_some())
    }

    /// The drilling rate: w_z relative to the table.
    pub(super) fn drills_here(&self) -> f64 {
        let y = &self.of.state;
        self.of.slide.drills(y.theta.sin_cos(), y.w1, y.w3)
    }

    /// Whether the contact point slips.
    pub(super) fn slips_here(&self) -> bool {
        let (slip, slide) = (self.at.slip(), &self.of.slide);
        self.ask.table.rubs() && (slip != [0.0; 2] || !slide.law.dry || slide.creeps(&self.at))
    }

    /// Sets rotations to exactly zero that have stopped, or that dry friction has held at zero up to the errors of
    /// the steps.
    pub(super) fn stops_exactly(&mut self, stops: Holds) {
        if stops == Holds::default() {
            return;
        }
        let (s, c) = state(&self.at).theta.sin_cos();
        let [w1, w2, w3] = self.at.w();
        let (drilling, rolling) = (self.of.slide.drills((s, c), w1, w3), rolling_of((s, c), w1, w3));
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
            (self.at[W1], self.at[W3]) = (s * self.of.turning, c * self.of.turning);
        }
        self.claims(left);
        self.of.state = state(&self.at);
    }

    /// The behaviour of a contact point at rest that friction cannot hold under a rolling resistance that acts only
    /// while the body rolls: it slips without the resistance. If friction can hold the point without the resistance,
    /// the result is `Undefined`.
    fn slips_unresisted(&self) -> Standstill {
        let (of, losses) = (&self.of, self.ask.losses_in_slip());
        let friction = match self.friction() {
            Friction::Coulomb { mu, patch, .. } => Friction::Coulomb { mu, fixed: mu, patch },
            viscous => viscous,
        };
        match standstill(&of.body, &of.state, &friction, self.couples_of(&losses)) {
            Standstill::Sticks => Standstill::Undefined,
            found => found,
        }
    }

    /// Whether a body at theta_end, whose contact point rests, rises under the contact force.
    fn rises(&self, found: Standstill) -> bool {
        let y = &self.of.state;
        let rate = match found {
            Standstill::Slips { alpha, .. } => {
                let w = [y.w1, y.w2, y.w3];
                self.of.slide.law.towards(y.theta.sin_cos(), w, [0.0; 2], towards(alpha)).w[1]
            }
            _ if !self.of.loses(&self.ask) && self.ask.is_level() => {
                Contact::Rolling.derivative(&self.of.body, y).w2
            }
            _ => self.rolling_of(y).0[1],
        };
        y.w2 > 0.0 || (y.w2 == 0.0 && rate > 0.0)
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

    fn perturbs_by(walk: &mut BodyWalk<'_, N, G>, share: f64) {
        if share == 0.0 || walk.of.lying.is_some() {
            return;
        }
        let (down, up) = (1.0 - share, 1.0 + share);
        if walk.is_on_face() {
            let more = share * walk.at[W3];
            walk.at[W3] += more;
            walk.at[U2] -= walk.of.body.rim() * more;
            walk.of.state.w3 = walk.at[W3];
            return;
        }
        let State { theta, w1, w2, w3 } = walk.of.state;
        // Drilling over the table, rolling w_h and rocking w2 are each changed by a share of themselves: a motion that
        // is zero stays zero.
        let (s, c) = theta.sin_cos();
        let drilling = walk.of.slide.drills((s, c), w1, w3) * up + walk.of.turning;
        let rolling = rolling_of((s, c), w1, w3) * up;
        // Near its other rim the height of the body is known from cos theta, not from theta.
        let near = walk.ask.restitution.is_some() && walk.at[COS].abs() < LEVEL && !walk.of.body.has_row();
        let end = walk.of.body.theta_end();
        let theta = match () {
            () if near => theta,
            () if walk.of.body.has_row() && end - theta < theta => end - (end - theta) * up,
            () => theta * down,
        };
        let (s, c) = if near { (walk.at[SIN], walk.at[COS] * down) } else { theta.sin_cos() };
        let (w1, w3) = (s * drilling + c * rolling, c * drilling - s * rolling);
        walk.of.state = State { theta, w1, w2: w2 * down, w3 };
        walk.at[..5].copy_from_slice(&[s, c, w1, w2 * down, w3]);
    }

    fn write(walk: &mut BodyWalk<'_, N, G>, y: &[f64; N]) {
        if let Some(phase) = &walk.of.lying {
            let flow = phase.flow;
            return walk.writes_lying(&flow, y);
        }
        walk.made.slid(&walk.ask, &walk.of.slide, y);
    }

    fn write_here(walk: &mut BodyWalk<'_, N, G>) {
        if walk.is_on_face() && walk.at[W2] == 0.0 {
            return walk.writes_on_face();
        }
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
        walk.of.slide.asks_drive(&walk.at);
        walk.of.slide.at_start(&walk.of.state, walk.at.slip())
    }

    fn lies(walk: &mut BodyWalk<'_, N, G>, found: Standstill) -> Option<Ending> {
        let (end, theta) = (walk.of.body.theta_end(), walk.of.state.theta);
        let lies = end < PI && (theta > end || theta == end && (walk.is_level() || !walk.rises(found)));
        lies.then_some(Ending::Side)
    }

    /// The phase without a slip that begins. It checks its conditions itself when it begins.
    fn begins_without_slip(_: &mut BodyWalk<'_, N, G>) -> Next {
        Next::Rolls { at_limit: false }
    }

    fn rests(walk: &BodyWalk<'_, N, G>) -> Standstill {
        let of = &walk.of;
        let found = standstill(&of.body, &of.state, &walk.friction(), walk.couples());
        if found != Standstill::Sticks && walk.ask.resists_only_rolling() {
            return walk.slips_unresisted();
        }
        found
    }
    fn lets_go(walk: &BodyWalk<'_, N, G>) -> Standstill {
        let of = &walk.of;
        if walk.ask.resists_only_rolling() {
            return walk.slips_unresisted();
        }
        let_go(&of.body, &of.state, &walk.friction(), walk.couples())
    }

    fn no_unique_force(walk: &BodyWalk<'_, N, G>) -> Error {
        if walk.ask.resists_only_rolling() && walk.at.slip() == [0.0; 2] {
            let value = walk.ask.losses.coefficient(Law::RollingResistance);
            let expected = "a smaller arm, or a resistance that acts while the body slips, too: friction cannot hold the \
                            contact point of this body as it rolls under the resistance, and could without it";
            return walk.of.own.takes_fault().unwrap_or(Error::OutOfRange { name: "delta", value, expected });
        }
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
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<WalkStep<N>>, Error> {
        match kind {
            Kind::Flying => walk.flies(go_on),
            Kind::OnItsFace => return Ok(walk.stands()),
            _ => return Ok(walk.lies()),
        }
        Ok(None)
    }
    fn slip_kind(walk: &BodyWalk<'_, N, G>) -> Kind {
        walk.kind_of_slip()
    }

    fn slips_known(walk: &mut BodyWalk<'_, N, G>) -> bool {
        if walk.hops_shortly() {
            return true;
        }
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
        walk.of.slide.asks_drive(&walk.at);
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
        let slide = &walk.of.slide;
        // A patch on which friction has held the drilling begins to slip as a point does.
        let as_point = slide.law.patch().is_none() || slide.drilling(&walk.at).abs() < HARDLY_DRILLS;
        !G::IS && as_point && slide.begins_to_roll().is_none()
    }

    fn has_series(walk: &BodyWalk<'_, N, G>) -> bool {
        let (of, slide) = (&walk.of, &walk.of.slide);
        let alone = of.lossy.is_none() && of.lying.is_none() && of.standing.is_none();
        alone && slide.law.dry && !slide.settled && Self::begins_slowly(walk)
    }

    fn lets_slip(walk: &mut BodyWalk<'_, N, G>, way: [f64; 2]) {
        if walk.of.lying.is_none() {
            walk.of.slide.asks_drive(&walk.at);
            walk.of.slide.sets_ways(&walk.of.state, [0.0; 2], way, None);
        }
    }
    fn slow(walk: &BodyWalk<'_, N, G>) -> BodySlips {
        let tol = walk.of.slide.tol;
        match &walk.of.lying {
            Some(phase) => BodySlips::of(&Slippery::Two(phase.flow.law, walk.of.tilt), tol, N),
            None => BodySlips::of(
                &Slippery::One(walk.of.slide.of_the_library(), [walk.of.tilt, walk.of.turning]),
                tol,
                N,
            ),
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

    /// The first step is a share of the last step of the previous phase of its kind, since a body that slips in each
    /// nod does so with much the same steps. In the run with the larger tolerance the first step is longer. Two runs
    /// with the same steps would have the same errors, and their difference would not show the growth of these errors
    /// from an unstable initial state.
    fn first(walk: &BodyWalk<'_, N, G>, y: &[f64; N]) -> f64 {
        let first = match (&walk.of.lying, walk.lossy()) {
            (Some(phase), _) => phase.flow.first(y),
            _ if walk.of.standing.is_some() => {
                return STANDING * if walk.perturbation > 0.0 { LONGER } else { 1.0 };
            }
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
        if walk.of.standing.is_some() {
            return walk.stands_on(y, steps, go_on);
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
        if walk.of.standing.is_some() {
            return walk.stops_standing(y, halt);
        }
        walk.slip_ends(y, halt);
    }

    fn leaves_margin(walk: &BodyWalk<'_, N, G>, halt: Halt) -> bool {
        halt == Halt::Side
            && walk.has_two_rims()
            && walk.made.path.phases.last().is_some_and(|phase| phase.state.theta == walk.of.body.theta_end())
    }

    /// The factor by which the error of the function whose zero causes this halt exceeds that of the state; for a
    /// function that depends on a force, the largest speed.
    fn grows(&self, halt: Halt, y: &[f64; N]) -> Option<f64> {
        match halt {
            Halt::Side | Halt::Rests | Halt::Rises | Halt::Changes | Halt::Turned => Some(1.0),
            Halt::LiftOff | Halt::Slips | Halt::Jam => Some(<Slide>::fastest(y)),
            _ => None,
        }
    }
}
