//! A body in the air: its flight, its landings and impacts, and the contact that follows.
//!
//! ```text
//! leaves the table    a slip as t^3 where N0 = 0 falls;  a contact at rest with N0 < 0 as t^2;  a bounce as t
//! bounces             last 2 u_n/(G (1 - q)) in all,  G = a_n N0,  q the ratio of the next bounce to this one
//! contact             where 2 u_n^2 < TAIL G (1 - q): the last impact is taken with e = 0
//! both rims           land in turn, the faster one first, until none comes down
//! ```
//! N0 is the normal force without friction, whose sign decides, since friction scales the normal force by a positive
//! factor. The impulses of the bounces that are summed agree with the contact force to first order, so that the error of
//! their sum is about TAIL.

use super::flight::air::{AirFlight, in_air};
use super::flight::{Aloft, Flies, Flight, Takeoff};
use super::phases::{BodyPhases, BodyWalk, LONGER};
use crate::laws::contact::impact::{Hit, RimImpact, Struck, lightness, turned};
use crate::laws::contact::landing::{Landed, Outcome, land_at, settled};
use crate::laws::contact::slip::Friction;
use crate::laws::contact::{FLAT, Force, Table};
use crate::laws::newton;
use crate::laws::state::State;
use crate::motions::halt::{TIME, loses, poses};
use crate::motions::walk::{Next, Phases};
use crate::motions::{Ending, Kind, Method, Moving, Strike};
use core::f64::consts::{FRAC_PI_2, TAU};

/// Share of the state that the bounces which are summed may change: this part of the tolerance of a sweep, but at least
/// and at most these.
const TAIL_SHARE: f64 = 0.1;
const TAIL: f64 = 1e-13;
const LONGEST_TAIL: f64 = 1e-10;
/// The same of a body with losses, as a share: they act on a contact, and not on a body that bounces.
const LOSSY_TAIL: f64 = 1e-8;
/// The tolerance of a step along an impact.
const IMPACT_TOL: f64 = 3e-14;
/// Both rims rattle until |cos theta| and the normal velocities of both are below this.
const RATTLED: f64 = 1e-7;
/// Error of the rest of a rattle, in units of the square of its velocities.
const SUMMED: f64 = 1e2;
/// Time of the rest of a rattle, in units of its velocities.
const LASTS: f64 = 10.0;
/// A rocking with a larger w2 is followed hop by hop.
const ROCKED: f64 = 1e-5;
/// A smaller w2 after a landing is a rounding error.
const ROCKED_OUT: f64 = 1e-15;
/// Both rims land together if |cos theta| is below this.
const BOTH_AT_ONCE: f64 = 1e-14;
/// Impacts of both rims are over where no rim comes down faster than this share of the first velocity.
const RATTLE_OVER: f64 = 1e-9;
/// Share of its terms below which N0 is a rounding error.
const ROUNDED: f64 = 1e-12;
/// A jam needs a larger impulse than this share of the slip.
const JAM_TAKES: f64 = 1e-9;
/// Largest number of impacts of both rims in turn.
const MOST_IN_TURN: u32 = 10_000;

impl<const N: usize> BodyWalk<'_, N> {
    pub(super) fn has_two_rims(&self) -> bool {
        self.of.body.ell() > 0.0 && self.of.body.theta_end() == FRAC_PI_2
    }

    /// Whether both rims touch, of which both or one may carry the body.
    pub(super) fn is_level(&self) -> bool {
        let State { theta, w2, .. } = self.of.state;
        self.ask.restitution.is_some() && self.has_two_rims() && theta == FRAC_PI_2 && w2 == 0.0
    }

    /// The present numbers, with those of a flight.
    pub(super) fn aloft(&self) -> Aloft {
        let [s, c, w1, w2, w3, u, v] = core::array::from_fn(|i| self.at[i]);
        let pose = if poses(N) { core::array::from_fn(|i| self.at[9 + i]) } else { [0.0; 4] };
        let Takeoff { height, lift, .. } = self.of.takeoff;
        Aloft { angle: (s, c), w: [w1, w2, w3], slip: [u, v], lift, height, pose }
    }

    /// Moves the walk to these numbers.
    pub(super) fn sets(&mut self, to: &Aloft) {
        let ((s, c), [mut w1, w2, mut w3], [u, mut v]) = (to.angle, to.w, to.slip);
        if self.of.planar {
            (w1, w3, v) = (0.0, 0.0, 0.0);
        }
        self.at[..7].copy_from_slice(&[s, c, w1, w2, w3, u, v]);
        if poses(N) {
            self.at[9..13].copy_from_slice(&to.pose);
        }
        self.of.state = State { theta: if c == 0.0 { FRAC_PI_2 } else { to.state().theta }, w1, w2, w3 };
        (self.of.takeoff.height, self.of.takeoff.lift) = (to.height, to.lift);
    }

    /// Passes to the view from the other rim.
    pub(super) fn turns_over(&mut self) {
        let from = self.aloft();
        let pose = self.pose_on_other_rim(from.pose);
        self.made.path.upside_down = !self.made.path.upside_down;
        self.sets(&Aloft { pose, ..from.on_other_rim(&self.of.slide.law.shape) });
    }

    /// The pose as told from the other rim; told twice it is the same again.
    pub(super) fn pose_on_other_rim(&self, pose: [f64; 4]) -> [f64; 4] {
        let mut other = Aloft { pose, ..self.aloft() }.on_other_rim(&self.of.slide.law.shape).pose;
        if self.made.path.upside_down {
            other[0] -= TAU;
        }
        other
    }

    /// The flight of a body that starts in the air, or its landing if it starts on the table and comes down.
    pub(super) fn starts_in_air(&mut self, [height, lift]: [f64; 2]) -> Next {
        if self.of.state.theta == FRAC_PI_2 {
            (self.at[0], self.at[1]) = (1.0, 0.0);
        }
        self.of.takeoff = Takeoff { height, lift, leaves: (height == 0.0).then_some(1) };
        Next::Own(Kind::Flying)
    }

    /// N0, the normal force without friction, and the size of its terms.
    fn pressed(&self, from: &Aloft) -> [f64; 2] {
        let law = &self.of.slide.law;
        let (shape, angle) = (&law.shape, from.angle);
        let at = law.towards(angle, from.w, [0.0; 2], [0.0; 2]);
        let (lever, [w1, w2, w3]) = (shape.rim.lever(angle), from.w);
        let square = (shape.rim.slope(angle) * w2 * w2).abs();
        let turning = shape.i3 * w1 * w3 - shape.i1 * angle.1 / angle.0 * w1 * w1;
        let size = (shape.i1 * (1.0 + square) + (lever * turning).abs()) / (shape.i1 + lever * lever);
        [at.force[0], size]
    }

    /// The phase after an ending, from which a motion with restitution goes on.
    #[inline(never)]
    pub(super) fn continues_after(&mut self, ending: Ending) -> Next {
        let Some(e) = self.ask.restitution else { return Next::Ends(ending) };
        match ending {
            // Another part of a body, which may land first, has no known shape.
            Ending::LiftOff if self.of.body.lands_on_rims() => {
                let [free, size] = self.pressed(&self.aloft());
                let rolls = matches!(self.ask.table, Table::Rolling { .. });
                if rolls && free > ROUNDED * size {
                    // Friction lifts the body, and on a real table the contact point would slip first.
                    return Next::Ends(Ending::Slip);
                }
                let leaves = if free < -ROUNDED * size { 2 } else { 3 };
                self.of.takeoff = Takeoff { leaves: Some(leaves), ..Takeoff::default() };
                Next::Own(Kind::Flying)
            }
            Ending::Side if self.has_two_rims() && self.of.state.theta == FRAC_PI_2 => {
                (self.at[0], self.at[1]) = (1.0, 0.0);
                self.of.takeoff = Takeoff::default();
                let down = -self.at[3];
                if down == 0.0 {
                    return self.settles_on_side();
                }
                // An output at the time of the start shows the body before it lands, as those at other landings do.
                while self.until().is_some_and(|t| t <= self.at[TIME]) {
                    BodyPhases::write_here(self);
                }
                if e == 0.0 || down * self.of.body.ell() <= RATTLED {
                    self.lands_on_both()
                } else {
                    self.rattles(e)
                }
            }
            Ending::Painleve if self.of.lying.is_none() && self.of.body.lands_on_rims() => {
                self.jams(e).unwrap_or(Next::Ends(ending))
            }
            ending => Next::Ends(ending),
        }
    }

    /// The phase after the impact by which a slip that presses the rim into the table stops. None where the rim could
    /// leave the table as well.
    fn jams(&mut self, e: f64) -> Option<Next> {
        self.of.takeoff = Takeoff::default();
        let from = self.aloft();
        let [free, size] = self.pressed(&from);
        if from.slip == [0.0; 2] || free < ROUNDED * size {
            return None;
        }
        let speed = from.slip[0].hypot(from.slip[1]);
        let struck = self.impact(&from, e).filter(|struck| struck.impulse[2] > JAM_TAKES * speed)?;
        // An output at this time shows the slip, for which there is no force.
        while self.until().is_some_and(|t| t <= self.at[TIME]) {
            self.writes_with(&from, Kind::Slipping, f64::NAN);
        }
        let after = self.struck(&from, &struck, (self.made.path.upside_down, false));
        self.sets(&after);
        Some(self.leaves_impact(&after))
    }

    /// The phase after an impact.
    fn leaves_impact(&mut self, after: &Aloft) -> Next {
        if after.lift > 0.0 {
            self.of.takeoff.leaves = Some(1);
            return Next::Own(Kind::Flying);
        }
        self.touches_down()
    }

    /// Follows a flight to its end, which sets the next phase.
    #[inline(never)]
    pub(super) fn flies(&mut self) {
        let shape = self.of.slide.law.shape;
        let (from, now) = (self.aloft(), self.at[TIME]);
        let Takeoff { leaves, .. } = self.of.takeoff;
        let mut course: Box<dyn Flies> = match in_air(&self.ask.losses) {
            Some(losses) => Box::new(AirFlight::new(&shape, &from, losses, self.of.slide.tol)),
            None => Box::new(Flight::new(&shape, &from)),
        };
        let other = from.on_other_rim(&shape);
        let touches = other.height == 0.0;
        let leaves = [leaves, touches.then_some(if other.lift == 0.0 { 2 } else { 1 })];
        let left = self.since.last().map_or(0.0, |t| t - now);
        let Ok(landing) = course.lands(leaves, self.has_two_rims(), left) else {
            self.next = Some(Next::Ends(Ending::Bounded));
            return;
        };
        let before = if loses(N) { self.at[N - 1] } else { 0.0 };
        let end = landing.map_or(f64::INFINITY, |(t, _)| t);
        while let Some(t) = self.until().filter(|t| *t <= now + end) {
            let at = self.flown(&*course, t - now, before);
            self.writes_with(&at, Kind::Flying, 0.0);
        }
        let Some((t, upper)) = landing else { return };
        let at = self.flown(&*course, t, before);
        self.at[TIME] = now + t;
        self.sets(&Aloft { height: if upper { at.height } else { 0.0 }, ..at });
        if upper {
            self.turns_over();
        }
        // The time of a landing is as uncertain as the height, over the normal velocity.
        let high = course.free().doubt_of_height(t);
        self.claims((high / self.of.takeoff.lift.abs()).min(high.sqrt()));
        self.of.takeoff.height = 0.0;
        let next = self.strikes();
        self.continues_with(next);
    }

    /// The body at a time of its flight. The energy that the air has taken until then is added to the energy lost `before`.
    fn flown(&mut self, course: &dyn Flies, t: f64, before: f64) -> Aloft {
        let (at, lost) = course.at(t);
        if loses(N) {
            self.at[N - 1] = before + lost;
        }
        self.claims(course.free().doubt(t, &at));
        at
    }

    /// The next phase after a landing.
    #[inline(never)]
    fn strikes(&mut self) -> Next {
        let (e, from) = (self.ask.restitution.unwrap_or(0.0), self.aloft());
        if from.angle.0 < FLAT && self.of.body.rim() > 0.0 {
            return Next::Ends(Ending::Face);
        }
        if from.lift >= 0.0 {
            self.of.takeoff = Takeoff::default();
            return self.touches_down();
        }
        let shape = self.of.slide.law.shape;
        let there = from.on_other_rim(&shape);
        let both = self.has_two_rims() && from.angle.1.abs() < BOTH_AT_ONCE;
        // After two flights of no length the rims land in turn at the same time.
        if both && (there.lift < 0.0 || e > 0.0 && self.still > 2) {
            self.claims(from.angle.1.abs());
            return if e == 0.0 { self.lands_on_both() } else { self.rattles(e) };
        }
        let Some(mut struck) = self.impact(&from, e) else { return Next::Ends(Ending::Slip) };
        let [force, _] =
            self.pressed(&Aloft { w: turned(&shape, from.angle, from.w, struck.impulse), ..from });
        let left =
            if struck.lift > 0.0 && force > 0.0 { self.bounces_for(&from, &struck, force, e) } else { None };
        self.claims(left.unwrap_or(0.0) * force * self.couples(&from));
        let stays = left.is_some();
        if stays && let Some(last) = self.impact(&from, 0.0) {
            struck = last;
        }
        let after = self.struck(&from, &struck, (self.made.path.upside_down, stays));
        self.sets(&after);
        let level = from.angle.1.abs().max(after.lift).max(after.on_other_rim(&shape).lift.abs());
        if self.has_two_rims() && e > 0.0 && level < RATTLED {
            return self.ends_rattle();
        }
        self.leaves_impact(&after)
    }

    /// The impact at these numbers; None where a rolling table has no answer.
    fn impact(&self, from: &Aloft, e: f64) -> Option<Struck> {
        let light = lightness(&self.of.slide.law.shape, from.angle);
        self.rim_impact(from.slip, from.lift, light).on(&self.ask.table, e)
    }

    /// The impact of a rim. A rougher run begins it with a longer step, lest both runs take the same steps.
    fn rim_impact(&self, slip: [f64; 2], lift: f64, light: [f64; 4]) -> RimImpact {
        let (longer, rougher) = if self.perturbation > 0.0 {
            (LONGER, self.perturbation * State::SAFETY / f64::EPSILON)
        } else {
            (1.0, 1.0)
        };
        RimImpact { slip, lift, light, tol: IMPACT_TOL * rougher, longer }
    }

    /// A bound of what the losses change in a unit of time, for each unit of the normal force.
    fn couples(&self, at: &Aloft) -> f64 {
        let (body, sum) = (&self.of.body, self.ask.losses.coefficients.iter().sum::<f64>());
        sum * at.w.into_iter().fold(1.0, |most: f64, w| most.max(w.abs())) / body.i1().min(body.i3())
    }

    /// The time of all bounces after an impact, if they are over so soon that they are summed.
    fn bounces_for(&self, from: &Aloft, struck: &Struck, force: f64, e: f64) -> Option<f64> {
        let law = &self.of.slide.law;
        let light @ [.., a_n, b] = lightness(&law.shape, from.angle);
        let (fall, w) = (a_n * force, turned(&law.shape, from.angle, from.w, struck.impulse));
        // The tolerance of a sweep is that of both of its runs, which so end their bounces together.
        let tail = match self.ask.method {
            Method::Tolerance(tol) => (TAIL_SHARE * tol).clamp(TAIL, LONGEST_TAIL),
            _ => TAIL,
        };
        let tail = if self.ask.losses.is_none() { tail } else { LOSSY_TAIL * tail };
        if 2.0 * struck.lift * struck.lift >= tail * fall {
            return None;
        }
        let mut ratio = e;
        if struck.hit == Hit::Sticks {
            // Each bounce meets the slip that the flight before has made.
            let [along, across] = law.towards(from.angle, w, [0.0; 2], [0.0; 2]).u;
            let slip = [along - b * force, across].map(|rate| 2.0 * rate / fall);
            ratio = self.rim_impact(slip, -1.0, light).on(&self.ask.table, e).map_or(1.0, |next| next.lift);
        }
        let left = 2.0 * struck.lift / (fall * (1.0 - ratio));
        (ratio < 1.0 && left * struck.lift < tail).then_some(left)
    }

    /// The numbers after an impact, which is recorded.
    fn struck(&mut self, from: &Aloft, struck: &Struck, (other, stays): (bool, bool)) -> Aloft {
        let w = turned(&self.of.slide.law.shape, from.angle, from.w, struck.impulse);
        let after = Aloft { w, slip: struck.slip, lift: struck.lift, ..*from };
        self.records([from, &after], other, struck.hit, (struck.impulse, struck.lost), stays);
        after
    }

    /// Adds an impact to the results, from the numbers before and after it as seen from the rim that lands.
    fn records(
        &mut self,
        both: [&Aloft; 2],
        other: bool,
        hit: Hit,
        (impulse, lost): ([f64; 3], f64),
        stays: bool,
    ) {
        let velocities = both.map(|at| [at.slip[0], at.slip[1], at.lift]);
        let (time, states) = (self.t0 + self.at[TIME], both.map(Aloft::state));
        self.made.path.impacts.push(Strike { time, other, hit, states, velocities, impulse, lost, stays });
    }

    /// The contact that begins where the normal velocity is zero.
    pub(super) fn touches_down(&mut self) -> Next {
        self.of.takeoff = Takeoff::default();
        self.first_phase().unwrap_or(Next::Ends(Ending::Painleve))
    }

    /// Both rims land in turn, the faster one first, until none comes down.
    #[inline(never)]
    fn rattles(&mut self, e: f64) -> Next {
        (self.at[0], self.at[1]) = (1.0, 0.0);
        let shape = self.of.slide.law.shape;
        let mut at = Aloft { angle: (1.0, 0.0), ..self.aloft() };
        let fast = at.lift.min(at.on_other_rim(&shape).lift).abs();
        let mut other = false;
        for turn in 0.. {
            let there = at.on_other_rim(&shape);
            if at.lift.min(there.lift) > -RATTLE_OVER * fast.min(1.0) {
                break;
            }
            if turn > MOST_IN_TURN {
                return Next::Ends(Ending::Bounded);
            }
            if there.lift < at.lift {
                (at, other) = (there, !other);
            }
            let Some(struck) = self.impact(&at, e) else { return Next::Ends(Ending::Slip) };
            at = self.struck(&at, &struck, (other != self.made.path.upside_down, false));
        }
        let there = at.on_other_rim(&shape);
        if there.lift < at.lift {
            (at, other) = (there, !other);
        }
        if other {
            self.turns_over();
        }
        self.sets(&Aloft { height: 0.0, pose: self.aloft().pose, ..at });
        if at.on_other_rim(&shape).lift < RATTLED {
            return self.ends_rattle();
        }
        if at.lift < RATTLE_OVER * fast.min(1.0) {
            return self.touches_down();
        }
        self.of.takeoff.leaves = Some(1);
        Next::Own(Kind::Flying)
    }

    /// The phase on both rims after a rattle, whose last impacts are summed.
    fn ends_rattle(&mut self) -> Next {
        let Table::Rubs(friction) = self.ask.table else { return self.lands_on_both() };
        let from = self.aloft();
        let left = from.angle.1.abs().max(from.w[1].abs()).max(from.lift.abs());
        self.claims(if from.slip == [0.0; 2] { left } else { left * left * SUMMED });
        self.claims(left * LASTS * self.couples(&from));
        let (law, flat) = (self.of.slide.law, (1.0, 0.0));
        let state = State { theta: FRAC_PI_2, ..self.of.state };
        let (v, still) = (law.centre(from.angle, from.w, from.slip), law.centre(flat, from.w, [0.0; 2]));
        // Where the rims slip, the centre keeps its velocity while the axis comes to lie level.
        let slip = if from.slip == [0.0; 2] { from.slip } else { [v[0] - still[0], v[1] - still[1]] };
        let (y, slip) = settled(&self.of.body, &state, (slip, from.lift), &friction);
        let lift = from.lift + law.shape.rim.lever(from.angle) * from.w[1];
        let before = newton::energy(&law.shape, from.angle, from.w, [v[0], v[1], lift]) + from.height;
        self.at[8] += before - law.energy(&y, slip);
        let after = Aloft { angle: (1.0, 0.0), w: [y.w1, 0.0, y.w3], slip, lift: 0.0, height: 0.0, ..from };
        self.sets(&after);
        self.settles_on_side()
    }

    /// The next phase after a landing on both rims without a bounce.
    fn lands_on_both(&mut self) -> Next {
        let friction = match self.ask.table {
            Table::Rubs(friction) => friction,
            _ if self.at[2] == 0.0 && self.at[4] == 0.0 => Friction::coulomb(1e100),
            _ => return Next::Ends(Ending::Side),
        };
        let before = State { theta: FRAC_PI_2, ..self.of.state };
        let lift = self.of.takeoff.lift.min(0.0);
        let Ok(landed) = land_at(&self.of.body, &before, ([self.at[5], self.at[6]], lift), &friction) else {
            return Next::Ends(Ending::Landing);
        };
        let (shape, other) = (self.of.slide.law.shape, !self.made.path.upside_down);
        let from = Aloft { angle: (1.0, 0.0), ..self.aloft() }.on_other_rim(&shape);
        self.lands_as(&landed);
        let here = self.aloft();
        let there = if other == self.made.path.upside_down { here } else { here.on_other_rim(&shape) };
        // The impulses of both rims together are what the centre of mass has gained.
        let [old, new] = [&from, &there].map(|at| {
            let ([w1, w2, w3], [along, across]) = (at.w, at.slip);
            [along + w2, across - shape.rim.ell * w1 + w3, at.lift + shape.rim.ell * w2]
        });
        let impulse = core::array::from_fn(|i| new[i] - old[i]);
        self.records([&from, &there], other, Hit::BothRims, (impulse, landed.lost), true);
        let rises = self.at[3];
        if rises < ROCKED_OUT {
            self.claims(rises * LASTS);
            return self.settles_on_side();
        }
        if rises < ROCKED
            && let Some(end) = self.rocks_out()
        {
            self.claims((end[TIME] - self.at[TIME]).powi(2));
            self.at = end;
            return self.settles_on_side();
        }
        self.touches_down()
    }

    /// Moves the walk to the numbers after a landing on both rims.
    pub(super) fn lands_as(&mut self, landed: &Landed) {
        if landed.outcome == Outcome::Changes {
            self.turns_over();
        }
        let State { w1, w2, w3, .. } = landed.state;
        let after =
            Aloft { angle: (1.0, 0.0), w: [w1, w2, w3], slip: landed.slip, lift: 0.0, ..self.aloft() };
        self.sets(&Aloft { height: 0.0, ..after });
    }

    /// Writes a point to the outputs whose forces all have the value `force`.
    fn writes_with(&mut self, at: &Aloft, kind: Kind, force: f64) {
        let force = self.ask.force.then_some((Force { normal: force, along: force, across: force }, 0.0));
        let pose = poses(N).then(|| at.pose());
        self.made.put(at.state(), at.slip, self.at[8], kind, pose, force);
        if let Some(last) = self.made.path.aloft.last_mut() {
            *last = [at.height.max(0.0), at.lift];
        }
        if loses(N) {
            self.made.path.work_lost.push(self.at[N - 1]);
        }
    }
}
