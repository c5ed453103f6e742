//! The phases of motion of a stone: their beginnings, their equations and their ends.

use super::flow::{
    HOLD, SLID_X, SLID_Y, STONE_X, STONE_Y, Seen, StoneFlow, StoneNumbers, Touch, WITHOUT_POSE, output_slip,
    slip_of, spot, state,
};
use super::known::Recorded;
use super::loses::REST;
use super::slow::StoneSlips;
use super::turns::Spot;
use super::write::write;
use crate::error::Error;
use crate::laws::contact::slip::Friction;
use crate::laws::contact::standstill::{HeldContact, Onset, Standstill, towards};
use crate::laws::contact::together::{Resting, Together};
use crate::laws::loss::{Couples, GRACE, Law, rounded};
use crate::laws::stone::law::{across, laboratory};
use crate::laws::stone::{Ellipsoid, StoneState, headed};
use crate::methods::SHORT_CODE;
use crate::methods::flow::{Exhausted, Flow, Flown, Steps};
use crate::motions::body::roll::lossy::JUMP;
use crate::motions::dry::creep::{Creeps, LOST_DRILLING};
use crate::motions::dry::friction::{OwnFriction, slipped};
use crate::motions::dry::held::HARDLY_ROLLS;
use crate::motions::walk::hops::Takeoff;
use crate::motions::walk::numbers::{Halt, TIME, loses};
use crate::motions::walk::slow::clear_until;
use crate::motions::walk::{Next, Pause, Phases, SlowSeries, Walk, WalkStep, after_rest, ending};
use crate::motions::{AboveTable, Ask, Ending, Kind, Phase, Start};
use crate::numbers::vector::{dot, plus};
use crate::numbers::{Dual, Sum};
use core::cell::RefCell;

/// The computation, phase by phase, of a motion of a stone.
pub(super) type StoneWalk<'a, 'n, const N: usize> = Walk<'a, StonePhases<'n>, N>;

/// The longest step of the run with the larger tolerance, as a share of the longest allowed step. Without this factor
/// both runs would take the same steps where the longest step limits them, and their difference would not show the
/// errors.
pub(super) const ROUGH_STRIDE: f64 = 0.7;
/// The end of a phase is certain, in all motions that count as known, if only a change of the state by more than this
/// can undo it ([`known`](super::known)); a larger change is not computed exactly.
const DEEP: f64 = 1e-2;
/// If the coefficient of friction is above this share of the least one with the paradox of Painleve, more than one
/// contact force may be consistent, and all are counted.
const DOUBTFUL: f64 = 0.9;

/// The data of a stone's motion: the equations of the current phase.
pub(super) struct StonePhases<'n> {
    pub flow: StoneFlow<'n>,
    /// Whether friction of the patch has just ceased to hold the drilling.
    freed: bool,
    /// The rotation that a dry loss has just ceased to hold.
    known: Option<(Resting, bool)>,
    /// The horizontal position of the centre of mass at the start, which is constant on a smooth table.
    still_centre: [f64; 2],
    /// The smallest moment of inertia, in M a^2.
    pub least: f64,
}

impl<'a, 'n, const N: usize> StoneWalk<'a, 'n, N> {
    /// Begins the computation of a stone's motion; `fine` is the requested tolerance.
    pub fn of_stone(
        (stone, start): (&Ellipsoid, &Start<StoneState>),
        times: &'a [f64],
        ask: &Ask,
        (tol, fine): (f64, f64),
        (recorded, own): (Option<&'n RefCell<Recorded>>, Option<OwnFriction<'n>>),
    ) -> Result<Self, Error> {
        let &Start { state: y, slip, time, .. } = start;
        let friction = ask.table.friction();
        let dry = matches!(friction, Friction::Coulomb { mu, .. } if mu > 0.0 || friction.sticks());
        let patch = friction.patch();
        let law = stone.law(friction.strength(), dry && ask.table.rubs());
        let law = law.with_patch((patch > 0.0).then_some(patch)).with_losses(Couples::some(&ask.losses));
        let law = law.with_tilt((ask.slope != 0.0).then(|| ask.slope.tan()));
        let edge = if stone.theta_end < core::f64::consts::PI { stone.theta_end.cos() } else { -2.0 };
        let flow = StoneFlow {
            sloped: law.map(Dual::constant),
            law,
            touch: Touch::Rolls,
            mu: ask.table.mu(),
            edge,
            tol,
            stride: if tol > fine { ROUGH_STRIDE } else { 1.0 },
            watch: true,
            hops: ask.restitution.is_some(),
            push: [0.0; 2],
            resisted: law.resisted(),
            recorded,
            own,
        };
        let mut at = [0.0; N];
        at[..4].copy_from_slice(&headed(y.orientation(), start.heading));
        at[4..7].copy_from_slice(&y.w);
        // The slip is told in the laboratory in which the stone is not turned about the vertical.
        let (sin, cos) = start.heading.sin_cos();
        at[SLID_X] = cos * slip.u_h - sin * slip.u_2;
        at[SLID_Y] = cos * slip.u_2 + sin * slip.u_h;
        at[STONE_X..=STONE_Y].copy_from_slice(&start.place);
        let [x, y, _] = flow.pose(&at, [0.0; 2]).centre;
        let least = stone.moments()[0];
        let of = StonePhases { flow, freed: false, known: None, still_centre: [x, y], least };
        let mut walk = Self::new(of, at, ask, fine, (time, times))?;
        walk.next = Some(match start.aloft {
            Some(aloft) => walk.starts_in_air(aloft.into()),
            None => walk.first_phase()?,
        });
        StonePhases::perturbs(&mut walk);
        Ok(walk)
    }

    /// The kind of contact in a phase without friction of a slip: rolling, held or smooth.
    fn resting(&self) -> Touch {
        if self.kind() == Kind::Slipping { Touch::Smooth } else { self.of.flow.resting(&self.at).touch }
    }

    /// Whether the edge lies on the table and does not rise.
    fn is_down(&self) -> bool {
        let flow = &self.of.flow;
        let place = flow.place(self.at);
        let here = flow.margins(&place)[0];
        let later = || flow.margin(&flow.part(&place, 1e-6), 0);
        here.value < 0.0 || here.value == 0.0 && !(here.slope > 0.0 || here.slope == 0.0 && later() > 0.0)
    }

    /// The forces at a contact point at rest, which decide whether it sticks.
    fn rest(&self) -> HeldContact<impl Fn(f64) -> Option<f64>> {
        let law = self.of.flow.law;
        let (lab, w) = (laboratory(core::array::from_fn(|i| self.at[i])), self.at.omega());
        let at = law.losing(law.meeting(&lab, w), &lab, w);
        let free = law.pulled(&at, w, [0.0; 3]);
        let held = law.rolling(&at, w).force;
        let [along, aside, normal] = lab.map(|axis| dot(axis, held));
        // The derivative of the slip per force along the axes of the laboratory.
        let element = law.light(&at, &lab);
        let [mu, fixed] = match self.friction() {
            Friction::Coulomb { mu, fixed, .. } => [mu, fixed],
            Friction::Viscous { .. } => [0.0; 2],
        };
        let element = |i: usize, j: usize| element[i][j];
        // The derivative of the slip per normal force, from the arm of that force and from the losses.
        let swings = at.lost.map_or([0.0; 3], |lost| law.swings(&at, lost.pressed));
        let pressed = |i: usize| element(i, 2) + dot(lab[i], swings);
        let upright = pressed(2);
        let eps = [0, 1].map(|i| mu * element(2, i) / upright);
        let rate = law.slip_rate(&at, w, &free);
        let normal_free = free.free / upright;
        let bare = [0, 1].map(|i| dot(lab[i], rate) - normal_free * pressed(i));
        HeldContact {
            mu: [mu, fixed],
            free: normal_free,
            held: [normal, along.hypot(aside)],
            against: f64::atan2(-aside, -along),
            doubtful: eps[0].hypot(eps[1]) >= DOUBTFUL,
            onset: Onset {
                mu,
                free: normal_free,
                eps,
                bare,
                pressed: [Sum::from(pressed(0)), Sum::from(pressed(1))],
                pulled: [element(0, 0), element(1, 1), element(0, 1)],
            },
            growth: move |alpha| {
                let way = towards(alpha);
                let to = law.pulled(&at, w, across(&lab, way));
                let rate = law.slip_rate(&at, w, &to);
                let along = |i: usize| way[i] * dot(lab[i], rate);
                (to.free > 0.0 && to.room > 0.0).then_some(along(0) + along(1))
            },
        }
    }

    /// Ends a phase at the state vector `y`, and chooses the next phase.
    fn phase_ends(&mut self, y: [f64; N], halt: Halt) {
        if self.of.flow.touch == Touch::Slips {
            self.made.path.slipping += y[TIME] - self.began;
        }
        self.at = y;
        let mut holds = self.of.flow.holds();
        if halt == Halt::Drilling {
            self.of.known = self.of.flow.known(&self.at);
            holds.drilling |= self.of.known.is_none();
        }
        if holds.drilling && !matches!(halt, Halt::Time | Halt::Pause) {
            let left = self.of.flow.removes_drilling(&mut self.at);
            self.claims(left);
        }
        if holds.rolling && !matches!(halt, Halt::Time | Halt::Pause) {
            self.claims(self.of.flow.rolls_at(&self.at));
            self.at = self.of.flow.rolling_along(&self.at, [0.0; 2]);
        }
        let rubs = self.ask.table.rubs();
        match halt {
            Halt::Face => self.ends_by(0),
            // With a restitution a stone that leaves the table goes on.
            Halt::LiftOff if !self.of.flow.hops => self.ends_by(1),
            Halt::Slips if !rubs => self.ends_by(HOLD),
            _ => (),
        }
        let next = match halt {
            Halt::Time | Halt::Pause => return,
            Halt::Standstill => {
                self.stop_slip();
                after_rest(self.rests_here())
            }
            Halt::Drilling if self.of.flow.seen_at(&self.at).to.room <= 0.0 => Next::Ends(Ending::Painleve),
            Halt::Drilling | Halt::Rests if self.of.flow.touch != Touch::Slips => {
                self.resumes_phase();
                Next::Rolls { at_limit: false }
            }
            Halt::Drilling | Halt::Rests => Next::SlipsOn,
            Halt::Slips if let Some(slip) = self.of.flow.creeps(&self.at).filter(|_| rubs) => {
                (self.at[SLID_X], self.at[SLID_Y]) = (slip[0], slip[1]);
                self.claims(LOST_DRILLING * self.of.flow.drilling(&self.at).abs());
                self.forgets_a_moment(self.at[TIME]);
                Next::Slips
            }
            Halt::Slips if self.of.flow.touch == Touch::Held && self.of.flow.grips(&self.at) > 0.0 => {
                self.of.freed = true;
                Next::Rolls { at_limit: false }
            }
            Halt::Slips if rubs && loses(N) && self.jumps() => {
                self.stops_exactly();
                after_rest(self.rests_here())
            }
            Halt::Slips if rubs => after_rest(Phases::lets_go(self)),
            Halt::LiftOff if self.of.flow.hops => Next::Ends(Ending::LiftOff),
            halt if !matches!(halt, Halt::Face | Halt::Endless) && self.ask.beyond && !rubs => {
                self.records_event(ending(halt));
                self.of.flow.watch = false;
                self.made.path.phases.pop();
                Next::Rolls { at_limit: false }
            }
            halt => Next::Ends(ending(halt)),
        };
        self.continues_with(next);
    }

    /// Whether the friction that rolling needs has just jumped past its limit, as when a dry couple changes its
    /// direction.
    fn jumps(&self) -> bool {
        let Seen { at, to, .. } = self.of.flow.seen_at(&self.at);
        let along = plus(to.force, -to.free, at.n);
        dot(along, along).sqrt() > self.of.flow.mu * to.free * (1.0 + JUMP)
    }

    /// Sets rotations to exactly zero that dry losses resist and that have hardly begun.
    fn stops_exactly(&mut self) {
        let (flow, losses) = (&self.of.flow, self.ask.losses);
        let (rolls, drills) = (flow.rolls_at(&self.at), flow.drilling(&self.at).abs());
        if losses.coefficient(Law::RollingResistance) > 0.0 && rolls < 4.0 * REST {
            self.at = flow.rolling_along(&self.at, [0.0; 2]);
        }
        if losses.coefficient(Law::Drilling) > 0.0 && drills < 4.0 * REST {
            self.of.flow.removes_drilling(&mut self.at);
        }
        self.claims(8.0 * REST);
    }

    /// The rotations at rest that dry losses resist, with the coefficients of sliding and of static friction, and
    /// whether more than one behaviour may be consistent; None if there are no such rotations.
    fn together(&self) -> Option<(Together, [f64; 2], bool)> {
        let rests = StoneFlow { touch: Touch::Rolls, ..self.of.flow }.together(&self.at, None)?;
        let HeldContact { mu, doubtful, .. } = self.rest();
        Some((rests, mu, doubtful))
    }

    /// The behaviour of a contact point at rest.
    fn rests_here(&self) -> Standstill {
        match self.together() {
            Some((rests, mu, doubtful)) => rests.standstill(mu, doubtful),
            None => self.rest().decides(),
        }
    }

    /// Sets which rotations dry losses resist or hold at rest. Returns the next phase if the stone stays at rest.
    fn begins_to_lose(&mut self, toward: [f64; 2]) -> Option<Next> {
        let known = core::mem::take(&mut self.of.known);
        let left = self.of.flow.sets_ways(&mut self.at, toward, known);
        self.claims(left);
        let (flow, drilling) = (&self.of.flow, self.of.flow.drilling(&self.at));
        let turns = drilling.abs() > rounded(1.0, [drilling, 0.0, 0.0]);
        let stops = flow.touch != Touch::Slips && flow.holds().rolling && !turns;
        (stops && flow.stays_at_rest(&self.at)).then_some(Next::Ends(Ending::Stops))
    }

    /// Lets rolling begin from rest during a slip.
    fn rolls_off(&mut self) -> [f64; N] {
        if self.of.flow.push == [0.0; 2] { self.at } else { self.begins_at_once([0.0; 2], 0.0) }
    }

    /// Records how certain the end of a phase by the zero of margin `i` is: how far this margin falls below zero
    /// after the end. A margin that only touches zero may stay positive in the exact motion.
    fn ends_by(&self, i: usize) {
        let Some(recorded) = self.of.flow.recorded else { return };
        let (leans, calm) = (self.of.flow.leans(&self.at, i), self.of.flow.calm(&self.at));
        let place = self.of.flow.place(self.at);
        let mut room = 0f64;
        for tenths in 3..18 {
            let later = self.of.flow.part(&place, calm * 0.1f64.powf(0.5 * f64::from(tenths)));
            room = room.max(-self.of.flow.margin(&later, i) / leans);
            if room > DEEP {
                break;
            }
        }
        recorded.borrow_mut().grazes.push([self.at[TIME], room]);
    }
}

impl<'n, const N: usize> Phases<N> for StonePhases<'n> {
    type State = StoneState;
    type Slow = StoneSlips;
    const SLIP: usize = 8;
    const HEAT: usize = 10;

    fn tol(&self) -> f64 {
        self.flow.tol
    }
    fn is_dry(&self) -> bool {
        self.flow.law.dry
    }
    fn over(&self) -> f64 {
        self.flow.over()
    }
    fn seen(walk: &StoneWalk<'_, 'n, N>, kind: Kind) -> Phase<StoneState> {
        let (time, at) = (walk.t0 + walk.at[TIME], &walk.at);
        let Takeoff { height, lift, .. } = walk.hops.takeoff;
        let aloft = if kind == Kind::Flying { AboveTable { height, lift } } else { AboveTable::default() };
        Phase { time, kind, state: state(at), slip: output_slip(at).into(), aloft, rim: 0 }
    }

    fn perturbs_by(walk: &mut StoneWalk<'_, 'n, N>, share: f64) {
        if share == 0.0 {
            return;
        }
        let (up, down) = (1.0 + share, 1.0 - share);
        let y = walk.at;
        for (x, by) in walk.at.iter_mut().zip([up, down, down, up, up, down, up]) {
            *x *= by;
        }
        walk.at = walk.of.flow.kept(walk.at);
        if loses(N) {
            // Rolling, rocking or drilling that is zero stays zero.
            let (before, after) = (walk.of.flow.seen_at(&y).lab, walk.of.flow.seen_at(&walk.at).lab);
            let [a, b, c] = before.map(|axis| dot(axis, y.omega()));
            let w = plus(across(&after, [a * up, b * down]), c * up, after[2]);
            walk.at[4..7].copy_from_slice(&w);
        }
    }

    fn write(walk: &mut StoneWalk<'_, 'n, N>, y: &[f64; N]) {
        write(&mut walk.made, (&walk.of.flow, &walk.ask, walk.of.still_centre), y);
    }
    fn write_here(walk: &mut StoneWalk<'_, 'n, N>) {
        Self::write(walk, &{ walk.at });
    }

    fn ends_slip(walk: &mut StoneWalk<'_, 'n, N>) -> Option<Halt> {
        walk.of.flow.touch = Touch::Slips;
        let [_, lift, hold, _] = walk.of.flow.margins_at(&walk.at);
        let jams = (hold <= 0.0).then_some(Halt::Jam);
        let lifts = (lift <= 0.0).then_some(Halt::LiftOff);
        if walk.is_down() { Some(Halt::Face) } else { jams.or(lifts) }
    }

    fn lies(walk: &mut StoneWalk<'_, 'n, N>, _: Standstill) -> Option<Ending> {
        walk.of.flow.touch = walk.resting();
        walk.is_down().then_some(Ending::Face)
    }

    fn begins_without_slip(walk: &mut StoneWalk<'_, 'n, N>) -> Next {
        walk.of.flow.touch = walk.resting();
        let [_, lift, hold, _] = walk.of.flow.margins_at(&walk.at);
        let ending = if walk.is_down() {
            return Next::Ends(Ending::Face);
        } else if lift <= 0.0 {
            Ending::LiftOff
        } else if hold < 0.0 {
            Ending::Slip
        } else {
            return Next::Rolls { at_limit: false };
        };
        if !walk.ask.beyond || ending == Ending::LiftOff && walk.of.flow.hops {
            return Next::Ends(ending);
        }
        walk.records_event(ending);
        walk.of.flow.watch = false;
        Next::Rolls { at_limit: false }
    }

    fn rests(walk: &StoneWalk<'_, 'n, N>) -> Standstill {
        walk.rests_here()
    }
    fn lets_go(walk: &StoneWalk<'_, 'n, N>) -> Standstill {
        match walk.together() {
            Some((rests, mu, doubtful)) => rests.lets_go(mu, doubtful),
            None => walk.rest().lets_go(),
        }
    }

    fn no_unique_force(walk: &StoneWalk<'_, 'n, N>) -> Error {
        let (mu, theta) = (walk.of.flow.law.strength, state(&walk.at).theta());
        let Onset { eps, .. } = walk.rest().onset;
        Error::Painleve { mu, theta, limit: mu / eps[0].hypot(eps[1]) }
    }

    fn audits(walk: &mut StoneWalk<'_, 'n, N>) {
        walk.compares_energy();
    }
    fn goes_on(walk: &mut StoneWalk<'_, 'n, N>, ending: Ending) -> Next {
        walk.continues_after(ending)
    }
    fn goes(
        walk: &mut StoneWalk<'_, 'n, N>,
        _: Kind,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<WalkStep<N>>, Error> {
        walk.flies(go_on);
        Ok(None)
    }

    fn slips(walk: &mut StoneWalk<'_, 'n, N>) -> [f64; N] {
        walk.of.flow.touch = Touch::Slips;
        walk.begins_to_lose([0.0; 2]);
        walk.rolls_off()
    }
    fn slips_on(walk: &mut StoneWalk<'_, 'n, N>) -> [f64; N] {
        walk.begins_to_lose([0.0; 2]);
        walk.rolls_off()
    }

    fn rubbing(walk: &StoneWalk<'_, 'n, N>) -> f64 {
        walk.of.flow.rubs(&walk.at)
    }
    fn begins_slowly(walk: &StoneWalk<'_, 'n, N>) -> bool {
        let flow = &walk.of.flow;
        flow.law.patch().is_none() && flow.own.is_none() && flow.push == [0.0; 2]
    }

    fn has_series(walk: &StoneWalk<'_, 'n, N>) -> bool {
        walk.of.flow.touch == Touch::Slips
            && <Self as Phases<N>>::is_dry(&walk.of)
            && Self::begins_slowly(walk)
    }

    fn lets_slip(walk: &mut StoneWalk<'_, 'n, N>, way: [f64; 2]) {
        walk.of.flow.touch = Touch::Slips;
        walk.begins_to_lose(way);
    }
    fn slow(walk: &StoneWalk<'_, 'n, N>) -> StoneSlips {
        StoneSlips::of(&walk.of.flow.law, walk.of.flow.tol)
    }

    fn clear_until(walk: &StoneWalk<'_, 'n, N>, series: &SlowSeries<N>) -> f64 {
        clear_until(series.until, |_, moment| walk.of.flow.margins_at(&series.at(moment)))
    }

    fn nudged(walk: &mut StoneWalk<'_, 'n, N>, way: [f64; 2], growth: f64) -> [f64; N] {
        let (flow, at) = (walk.of.flow, walk.at);
        let begins = slip_of(&at) == [0.0; 2] && way != [0.0; 2] && flow.push == [0.0; 2];
        if flow.own.is_some() && begins {
            return walk.keeps_its_way(growth, (flow.calm(&at) / 3.0).min(1.0), |lasts| {
                flow.kept(slipped(&at, SLID_X, (way, lasts), |y| flow.rates_along(y, way)))
            });
        }
        let y = flow.nudged(&at, way, growth);
        walk.of.flow.rolls_freely();
        y
    }

    fn passed(walk: &StoneWalk<'_, 'n, N>, series: &SlowSeries<N>, until: f64) {
        let Some(recorded) = walk.of.flow.recorded else { return };
        if let Some(turns) = &mut recorded.borrow_mut().turns {
            let at = |t: f64| {
                let since = t - series.from;
                let rate = core::array::from_fn(|i| series.numbers[i].slope().value(since));
                Spot { t, ..spot(&series.at(since), &rate) }
            };
            turns.follow(&at, at(series.from), at(series.from + until));
        }
    }

    fn rolls(
        walk: &mut StoneWalk<'_, 'n, N>,
        at_limit: bool,
        _: &mut dyn FnMut() -> bool,
    ) -> Result<Option<WalkStep<N>>, Error> {
        walk.of.flow.touch = if core::mem::take(&mut walk.of.freed) && walk.kind() == Kind::Rolling {
            Touch::Rolls
        } else {
            walk.resting()
        };
        if walk.of.flow.touch == Touch::Held {
            walk.claims(LOST_DRILLING * walk.of.flow.drilling(&walk.at).abs());
        }
        if let Some(next) = walk.begins_to_lose([0.0; 2]) {
            walk.next = Some(next);
            return Ok(None);
        }
        walk.of.flow.mu = walk.ask.table.mu() * if at_limit { 1.0 + GRACE } else { 1.0 };
        Ok(Some(WalkStep::Flows(walk.at)))
    }

    fn first(walk: &StoneWalk<'_, 'n, N>, y: &[f64; N]) -> f64 {
        walk.of.flow.first(y)
    }

    fn flows(
        walk: &mut StoneWalk<'_, 'n, N>,
        y: [f64; N],
        steps: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        let (flow, ask, still) = (walk.of.flow, walk.ask, walk.of.still_centre);
        let from = walk.made.motion.states.len();
        let (made, times) = (&mut walk.made, &walk.since[from..]);
        let whole =
            |y: &[f64; WITHOUT_POSE]| core::array::from_fn(|i| if i < WITHOUT_POSE { y[i] } else { 0.0 });
        // A stone that rolls without a pose has fewer numbers.
        let flown = if SHORT_CODE || loses(N) || flow.touch == Touch::Slips || ask.pose || ask.table.rubs() {
            let (mut write, place) = (|y: &[f64; N]| write(made, (&flow, &ask, still), y), flow.place(y));
            let wrong =
                flow.own.filter(|_| flow.stopped(&place).is_some_and(|(halt, _)| halt == Halt::Endless));
            wrong.and_then(|own| own.takes_fault()).map_or(Ok(()), Err)?;
            flow.run(place, steps, times, &mut write, go_on)
        } else {
            let mut write = |y: &[f64; WITHOUT_POSE]| write(made, (&flow, &ask, still), &whole(y));
            let here = flow.place(core::array::from_fn(|i| y[i]));
            let Flown { halt, y, step, steep, spent } = flow.run(here, steps, times, &mut write, go_on);
            Flown { halt, y: whole(&y), step, steep, spent }
        };
        walk.has_spent(flown.spent);
        // Beyond the last step that was taken a wrong value of a law does not count.
        let fault = flow.own.and_then(|own| own.takes_fault());
        if flown.halt == Halt::Endless && flown.spent.exhausted != Some(Exhausted::Interrupted) {
            fault.map_or(Ok(()), Err)?;
        }
        if flown.halt == Halt::Pause {
            return Ok(Pause::Here(flown.y, Some(flown.step)));
        }
        walk.claims_time_error(flown.halt, flown.steep, &flown.y);
        if flown.halt == Halt::Rests && flow.touch == Touch::Slips {
            // The last steps of a rolling that ends in a slip do not resolve the turning of its couple.
            walk.claims(HARDLY_ROLLS / flown.steep.min(1.0));
        }
        walk.phase_ends(flown.y, flown.halt);
        Ok(Pause::No)
    }

    fn slip_halts(walk: &mut StoneWalk<'_, 'n, N>, y: [f64; N], halt: Halt) {
        walk.phase_ends(y, halt);
    }

    fn grows(&self, halt: Halt, y: &[f64; N]) -> Option<f64> {
        let ends = matches!(halt, Halt::Face | Halt::LiftOff | Halt::Slips | Halt::Jam);
        if halt == Halt::Rests { Some(1.0) } else { ends.then(|| self.flow.fastest(y)) }
    }
}
