//! The flights of a stone, and the impacts of its lowest point.

use super::flow::{
    SLID_X, SLID_Y, STONE_HEAT, STONE_X, STONE_Y, StoneFlow, StoneNumbers, Touch, output_slip, slip_of, state,
};
use super::fly::{StoneAloft, StoneFlight};
use super::phases::StoneWalk;
use crate::laws::contact::delassus::Delassus;
use crate::laws::contact::impact::Struck;
use crate::laws::contact::sliding::PatchedPoint;
use crate::laws::loss::Holds;
use crate::laws::stone::StonePose;
use crate::laws::stone::law::{Touching, across, laboratory};
use crate::methods::flow::Exhausted;
use crate::motions::ask::row::OutputRow;
use crate::motions::walk::Next;
use crate::motions::walk::hops::{Bounce, JAM_TAKES, ROUNDED, SHORT_BOUNCE, Takeoff};
use crate::motions::walk::numbers::{TIME, lost};
use crate::motions::{AboveTable, Ending, Kind, Lands, Strike};
use crate::numbers::vector::{cross, dot, plus};

/// Cost of a piece of a flight's power series, in evaluations of the equations of motion.
const PIECE_COSTS: u64 = 30;
/// Number of pieces of a flight's power series between two calls of `go_on`.
const PIECES_PER_CALL: u64 = 64;

/// A contact of a stone: the axes of the laboratory, the contact point, and the change of velocity by an impulse
/// there.
struct StoneContact {
    lab: [[f64; 3]; 3],
    at: Touching<f64>,
    light: Delassus,
    patch: Option<PatchedPoint>,
}

impl<'n, const N: usize> StoneWalk<'_, 'n, N> {
    /// The stone at the current state, with its height and vertical velocity.
    fn aloft(&self) -> StoneAloft<N> {
        let Takeoff { height, lift, .. } = self.hops.takeoff;
        StoneAloft { y: self.at, height, lift }
    }

    /// Sets the current state of the motion to this stone.
    fn sets(&mut self, to: &StoneAloft<N>) {
        self.at = to.y;
        (self.hops.takeoff.height, self.hops.takeoff.lift) = (to.height, to.lift);
    }

    /// The contact of the stone at the state vector `y`, where friction holds no rotation at rest, since the stone
    /// comes from the air.
    fn contact_at(&self, y: &[f64; N]) -> StoneContact {
        let (law, w) = (&self.of.flow.law, y.omega());
        let lab = laboratory(y.quaternion());
        let at = law.losing(law.meeting(&lab, w), &lab, w);
        let at = Touching { holds: Holds::default(), ..at };
        let [[a, ab, b_1], [_, b, b_2], [.., normal]] = law.light(&at, &lab);
        let light = Delassus { level: [[a, ab], [ab, b]], couples: [b_1, b_2], normal };
        let patch = law.patch().map(|radius| {
            let row = cross(law.inverse.times(lab[2]), at.r);
            PatchedPoint {
                radius,
                drilling: dot(lab[2], w),
                row: lab.map(|axis| dot(axis, row)),
                about: dot(lab[2], law.inverse.times(lab[2])),
            }
        });
        StoneContact { lab, at, light, patch }
    }

    /// The normal force without friction, N0, and the size of its terms.
    fn pressed(&self, y: &[f64; N]) -> [f64; 2] {
        let (StoneContact { at, light, .. }, w) = (self.contact_at(y), y.omega());
        let to = self.of.flow.law.pulled(&at, w, [0.0; 3]);
        let size = 1.0 + 2.0 * dot(w, w) * dot(at.r, at.r).sqrt();
        [dot(to.force, at.n), size / light.normal]
    }

    /// The first phase of a stone that starts in the air: its flight, or its landing if it starts on the table and
    /// moves down.
    pub(super) fn starts_in_air(&mut self, [height, lift]: [f64; 2]) -> Next {
        self.hops.takeoff = Takeoff { height, lift, leaves: (height == 0.0).then_some(1) };
        Next::Own(Kind::Flying)
    }

    /// The phase after an ending past which a motion with restitution continues.
    pub(super) fn continues_after(&mut self, ending: Ending) -> Next {
        let Some(e) = self.ask.restitution else { return Next::Ends(ending) };
        match ending {
            Ending::LiftOff => {
                let pressed = self.pressed(&self.at);
                self.lifts_off(pressed)
            }
            Ending::Painleve => self.jams(e).unwrap_or(Next::Ends(ending)),
            ending => Next::Ends(ending),
        }
    }

    /// The phase after the impact that stops a slip whose friction presses the stone into the table (Painleve). None
    /// where the stone could leave the table as well.
    fn jams(&mut self, e: f64) -> Option<Next> {
        self.hops.takeoff = Takeoff::default();
        let from = self.aloft();
        let ([free, size], [u, v]) = (self.pressed(&from.y), slip_of(&from.y));
        if [u, v] == [0.0; 2] || free < ROUNDED * size {
            return None;
        }
        let struck = self.impact(&from, e).filter(|struck| struck.impulse[2] > JAM_TAKES * u.hypot(v))?;
        // An output at this time shows the slip, for which there is no force.
        while self.until().is_some_and(|t| t <= self.at[TIME]) {
            self.writes_aloft(&from, Kind::Slipping, f64::NAN);
        }
        let after = self.struck(&from, &struck, false);
        self.sets(&after);
        Some(self.leaves_impact())
    }

    /// Computes a flight to its end, and sets the next phase.
    #[inline(never)]
    pub(super) fn flies(&mut self, go_on: &mut dyn FnMut() -> bool) {
        let (start, law) = (self.aloft(), self.of.flow.law);
        let flight = StoneFlight::new(&law, &start, &self.ask.losses, self.of.least);
        let (now, last) = (self.at[TIME], self.since.last().copied().unwrap_or(0.0));
        let (left, mut toil) = (last - now, self.toil());
        let (mut from, mut since, mut leaves) = (start, 0.0, self.hops.takeoff.leaves);
        let (mut turned, mut roundings) = (0.0, 4.0);
        for pieces in 0u64.. {
            self.spent.evaluations += PIECE_COSTS;
            toil = toil.saturating_sub(PIECE_COSTS);
            if toil == 0 || pieces % PIECES_PER_CALL == PIECES_PER_CALL - 1 && !go_on() {
                let why = if toil == 0 { Exhausted::Evaluations } else { Exhausted::Interrupted };
                self.sets(&from);
                self.next = Some(self.gives_up(why.into()));
                return;
            }
            let piece = flight.piece(since, &from, leaves);
            let whole = since + piece.length < left;
            let length = if whole { piece.length } else { left - since };
            let lands = if leaves.is_none() && piece.is_high(&flight, length) {
                Ok(None)
            } else {
                piece.lands(leaves, length)
            };
            let landing = match lands {
                Ok(landing) => landing,
                Err(why) => {
                    self.sets(&from);
                    self.next = Some(self.gives_up(why.into()));
                    return;
                }
            };
            let end = landing.unwrap_or(length);
            let at = |t: f64| piece.at(&flight, &start.y, t);
            while let Some(t) = self.until().filter(|t| *t - now - since <= end) {
                let shown = at(t - now - since);
                self.claims(-shown.height);
                self.writes_aloft(&shown, Kind::Flying, 0.0);
            }
            let fastest = flight.fastest(from.y.omega());
            turned += fastest * end;
            roundings = 4.0 * (1.0 + turned);
            self.claims(roundings * f64::EPSILON * fastest.max(1.0));
            if let Some(recorded) = self.of.flow.recorded
                && let Some(turns) = &mut recorded.borrow_mut().turns
            {
                let spot = |t: f64| piece.spot(now, t - now - since);
                turns.follow(&spot, spot(now + since), spot(now + since + end));
            }
            if landing.is_some() {
                let lowest = at(end);
                let high = flight.doubt_of_height(since + end, fastest);
                let mut late = (high / lowest.lift.abs()).min(high.sqrt());
                if leaves == Some(1) && turned < SHORT_BOUNCE {
                    late = late.min(roundings * f64::EPSILON * (since + end));
                }
                let t = self.claims_landing(since + end, late) - since;
                self.sets(&StoneAloft { height: 0.0, ..at(t.max(0.0)) });
                break;
            }
            if !whole {
                self.sets(&at(end));
                return;
            }
            (from, since, leaves) = (at(end), since + end, None);
        }
        self.doubts(roundings * f64::EPSILON);
        let next = self.strikes();
        self.continues_with(next);
    }

    /// The impact of the lowest point on the table; None for a contact that only rolls if there is no solution.
    fn impact(&self, from: &StoneAloft<N>, e: f64) -> Option<Struck> {
        let (StoneContact { light, patch, .. }, own) = (self.contact_at(&from.y), self.of.flow.own);
        self.point_impact((slip_of(&from.y), from.lift), (light, patch), &own).on(&self.ask.table, e, &own)
    }

    /// The next phase after a landing.
    fn strikes(&mut self) -> Next {
        let (e, from) = (self.ask.restitution.unwrap_or(0.0), self.aloft());
        if state(&from.y).vertical[2] <= self.of.flow.edge {
            // The edge is lower than the ellipsoid, and has no law of contact.
            return Next::Ends(Ending::Face);
        }
        if from.lift >= 0.0 {
            self.claims(from.lift);
            return self.touches_down();
        }
        let Some(mut struck) = self.impact(&from, e) else { return Next::Ends(Ending::Slip) };
        let bounced = self.after(&from, &struck);
        let left = self.bounces(&bounced, &struck, e);
        let bounce = struck.lift;
        if left.is_some()
            && let Some(last) = self.impact(&from, 0.0)
        {
            struck = last;
        }
        let after = self.struck(&from, &struck, left.is_some());
        self.sets(&after);
        if let Some(left) = left {
            let y = after.y;
            let ([u, v], seen) = (slip_of(&y), StoneFlow { touch: Touch::Slips, ..self.of.flow }.seen_at(&y));
            let [f, g] = [0, 1].map(|i| dot(seen.lab[i], seen.to.force));
            let drills = if self.of.flow.law.patch().is_some() {
                seen.to.couple * dot(y.omega(), seen.at.n)
            } else {
                0.0
            };
            let power = if [u, v] == [0.0; 2] { 0.0 } else { -(u * f + v * g) - drills };
            self.sums_bounces((left, bounce), [u.hypot(v), power], y.omega());
        }
        self.leaves_impact()
    }

    /// The total time of all bounces after an impact; None unless it is so short that the bounces are summed.
    fn bounces(&mut self, after: &StoneAloft<N>, struck: &Struck, e: f64) -> Option<f64> {
        let (StoneContact { lab, at, light, patch }, w, law) =
            (self.contact_at(&after.y), after.y.omega(), self.of.flow.law);
        let [force, _] = self.pressed(&after.y);
        let bounce = Bounce { struck, light: &light, patch, force, loses: !self.ask.losses.is_none() };
        let left = self.bounces_for(&bounce, e, &self.of.flow.own, || {
            let rate = law.slip_rate(&at, w, &law.pulled(&at, w, [0.0; 3]));
            [0, 1].map(|i| dot(lab[i], rate) - light.couples[i] * force)
        })?;
        let couple = at.lost.map_or(0.0, |lost| {
            let [free, pressed] = [lost.free, lost.pressed].map(|m| dot(m, m).sqrt());
            free + pressed * force
        });
        self.claims(left * couple / self.of.least);
        Some(left)
    }

    /// The stone after an impact.
    fn after(&self, from: &StoneAloft<N>, struck: &Struck) -> StoneAloft<N> {
        let StoneContact { lab, at, .. } = self.contact_at(&from.y);
        let [x, y, z] = struck.impulse;
        let push = plus(across(&lab, [x, y]), z, lab[2]);
        let turn = plus(cross(at.r, push), struck.couple, lab[2]);
        let w = plus(from.y.omega(), 1.0, self.of.flow.law.inverse.times(turn));
        let mut y = from.y;
        y[4..7].copy_from_slice(&w);
        [y[SLID_X], y[SLID_Y]] = struck.slip;
        StoneAloft { y, lift: struck.lift, ..*from }
    }

    /// The stone after an impact, which is also recorded in the results.
    fn struck(&mut self, from: &StoneAloft<N>, struck: &Struck, stays: bool) -> StoneAloft<N> {
        let &Struck { hit, impulse, couple, lost, .. } = struck;
        let after = self.after(from, struck);
        self.claims_no_gain(lost);
        let time = self.t0 + self.at[TIME];
        let velocities = [from, &after].map(|at| {
            let [u, v] = output_slip(&at.y);
            [u, v, at.lift]
        });
        let states = [state(&from.y), state(&after.y)];
        self.records_impact(Strike {
            time,
            lands: Lands::First,
            rim: 0,
            hit,
            states,
            velocities,
            impulse,
            couple,
            lost,
            after: stays.into(),
        });
        after
    }

    /// The phase after an impact of a stone: contact or flight.
    fn leaves_impact(&mut self) -> Next {
        if self.hops.takeoff.lift > 0.0 {
            self.hops.takeoff.leaves = Some(1);
            return Next::Own(Kind::Flying);
        }
        self.touches_down()
    }

    /// Includes the error of the energy balance since the start in the estimated error.
    pub(super) fn compares_energy(&mut self) {
        if self.ask.restitution.is_none() || self.perturbation > 0.0 {
            return;
        }
        let (StoneAloft { y, height, lift }, law) = (self.aloft(), self.of.flow.law);
        let w = y.omega();
        let lab = laboratory(y.quaternion());
        let at = law.touching(lab[2], w);
        let u = plus(across(&lab, slip_of(&y)), lift, lab[2]);
        let fallen = law.tilt.unwrap_or(0.0) * (y[STONE_X] - dot(lab[0], at.r));
        let fastest = w.into_iter().chain(u).fold(1.0, |most: f64, x| most.max(x.abs()));
        self.compares_energy_with_start(law.energy(&at, w, u) + height - fallen, fastest);
    }

    /// Writes a point to the outputs, with all force components set to `force`.
    fn writes_aloft(&mut self, at: &StoneAloft<N>, kind: Kind, force: f64) {
        let StoneAloft { y, height, lift } = at;
        let force = self.ask.force.then(|| ([force; 3].into(), 0.0));
        let pose = self.ask.pose.then(|| {
            let lab = laboratory(y.quaternion());
            let r = self.of.flow.law.touching(lab[2], y.omega()).r;
            let [a, b, c] = lab.map(|axis| dot(axis, r));
            let point = [y[STONE_X], y[STONE_Y]];
            StonePose::new(y.quaternion(), point, [point[0] - a, point[1] - b, height - c])
        });
        let row = OutputRow::on_table(state(y), output_slip(y), [y[STONE_HEAT], lost(y)], kind);
        self.made.push(OutputRow { pose, force, aloft: AboveTable::new(*height, *lift), ..row });
    }
}
