//! The impacts of a body, one by one and in sequences, and the phases that follow.
//!
//! ```text
//! both rims           land at once while both come down, else in turn, until none comes down
//! ```

use super::body_walk::BodyWalk;
use super::face::ALMOST_FLAT;
use super::fly::Aloft;
use super::own::Own;
use crate::laws::body::Rim;
use crate::laws::contact::impact::{Hit, PointImpact, Struck, lightness, patched, turned};
use crate::laws::contact::landing::{Landed, Outcome, bounced, land_at, settled};
use crate::laws::contact::sliding::PatchedPoint;
use crate::laws::contact::slip::Friction;
use crate::laws::contact::{FLAT, ImpactLaw, Table};
use crate::laws::loss::{Couples, Kinematics};
use crate::laws::newton;
use crate::laws::state::State;
use crate::motions::walk::Next;
use crate::motions::walk::hops::{Bounce, JAM_TAKES, ROUNDED, Takeoff};
use crate::motions::walk::numbers::{BodyNumbers, COS, HEAT, SIN, TIME, U2, W1, W2, W3, lost, pull};
use crate::motions::{Ending, Kind, Limit, Moving, Strike};
use core::f64::consts::PI;

/// Two rims that land in turn bounce until abs(cos(theta)) and the normal velocities of both are below this.
pub(super) const RATTLED: f64 = 1e-7;
/// Error by the rest of a sequence of impacts of two rims, in units of the square of its velocities.
const SUMMED: f64 = 1e2;
/// Duration of the rest of a sequence of impacts of two rims, in units of its velocities.
pub(super) const LASTS: f64 = 10.0;
/// A body that rocks with a larger w2 is computed hop by hop.
pub(super) const ROCKED: f64 = 1e-5;
/// A w2 after a landing below this counts as a rounding error.
pub(super) const ROCKED_OUT: f64 = 1e-15;
/// Both rims land together if abs(cos(theta)) is below this.
const BOTH_AT_ONCE: f64 = 1e-14;
/// Impacts of both rims end when no rim comes down faster than this share of the first velocity.
pub(super) const RATTLE_OVER: f64 = 1e-9;
/// Largest number of impacts of both rims in turn.
pub(super) const MOST_IN_TURN: u32 = 10_000;

/// The coefficient of friction in an impact of both rims on a table on which a body only rolls.
pub(super) const PERFECTLY_ROUGH: f64 = 1e100;

/// The momentum that the centre of mass has gained from `old` to `new`: the impulse of both rims together, along e_h,
/// e2 and z.
pub(super) fn gained(rim: &Rim<f64>, [old, new]: [&Aloft; 2]) -> [f64; 3] {
    let velocity = |at: &Aloft| {
        let ([w1, w2, w3], [along, across], angle) = (at.w, at.slip, at.angle);
        let aside = across - rim.depth(angle) * w1 + rim.radius(angle) * w3;
        [along + rim.height(angle) * w2, aside, at.lift + rim.lever(angle) * w2]
    };
    let [old, new] = [velocity(old), velocity(new)];
    core::array::from_fn(|i| new[i] - old[i])
}

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// The phase after the impact that stops a slip whose friction presses the rim into the table (Painleve). None
    /// where the rim could leave the table as well.
    pub(super) fn jams(&mut self, e: f64) -> Option<Next> {
        self.hops.takeoff = Takeoff::default();
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
        let after = self.struck(&from, &struck, (self.made.path.view.over, false));
        self.sets(&after);
        Some(self.leaves_impact(&after))
    }

    /// The phase after an impact of one rim: contact or flight.
    pub(super) fn leaves_impact(&mut self, after: &Aloft) -> Next {
        if self.is_on_face() {
            let lost = self.keeps_upright();
            self.made.path.impacts.iter_mut().last().into_iter().for_each(|last| last.lost += lost);
        }
        if after.lift > 0.0 {
            if self.is_on_face() {
                self.at[SIN] = 0.0;
            }
            self.hops.takeoff.leaves = Some(1);
            return Next::Own(Kind::Flying);
        }
        if self.is_on_face() { self.leaves_face() } else { self.touches_down() }
    }

    /// The next phase after a landing.
    #[inline(never)]
    pub(super) fn strikes(&mut self) -> Next {
        let (e, shape) = (self.ask.restitution.unwrap_or(0.0), self.of.slide.law.shape);
        let mut from = self.aloft();
        let one = self.has_one_contact();
        if from.angle.0 < FLAT && self.of.body.rim() > 0.0 {
            if one {
                return Next::Ends(Ending::Face);
            }
            if let Some(next) = self.strikes_flat(e) {
                return next;
            }
            // Laws of one rim know no face that lies.
            from = Aloft { angle: (ALMOST_FLAT, from.angle.1), ..self.aloft() };
        }
        let theta = from.angle.0.atan2(from.angle.1);
        if self.of.body.carries()[0] > 0.0 {
            self.looks_at_border(theta);
            from = self.aloft();
        }
        let both = self.has_two_rims() && self.tilt(from.angle).abs() < BOTH_AT_ONCE;
        if both {
            // Rounding must not decide which rim is lower.
            self.claims(self.tilt(from.angle).abs());
            from = Aloft { angle: self.of.body.border_angle(), height: 0.0, ..from };
            self.sets(&from);
        }
        let rims = self.of.body.rims();
        let there = if both { from.on_other_rim(&rims) } else { from };
        if both && one {
            return Next::Ends(Ending::Side);
        }
        if both && from.lift >= 0.0 && there.lift < 0.0 {
            self.turns_over();
            return self.strikes();
        }
        if from.lift >= 0.0 {
            self.claims(from.lift);
            return self.touches_down();
        }
        // After two flights of zero length the rims land in turn at the same time.
        if both && (there.lift < 0.0 || e > 0.0 && self.still > 2) {
            return if e == 0.0 { self.lands_on_both() } else { self.rattles(e) };
        }
        let Some(mut struck) = self.impact(&from, e) else { return Next::Ends(Ending::Slip) };
        let [force, _] = self.pressed(&Aloft { w: turned(&shape, from.angle, from.w, &struck), ..from });
        let left = self.bounces(&from, &struck, force, e);
        self.claims(left.map_or(0.0, |left| left * self.couple_bound(&from, force)));
        let (stays, bounce) = (left.is_some(), struck.lift);
        // A slip that turns back more and more slowly has stopped after all of them.
        if stays && let Some(last) = self.impact_under(ImpactLaw::Stronge, &from, 0.0) {
            if self.ask.impact_law.tangential() == 1.0 {
                self.claims(from.slip[0].hypot(from.slip[1]));
            }
            struck = last;
        }
        let after = self.struck(&from, &struck, (self.made.path.view.over, stays));
        self.sets(&after);
        if let Some(left) = left {
            let u @ [along, across] = after.slip;
            let State { theta, w1, w2, w3 } = after.state();
            let (angle, w, law) = (theta.sin_cos(), [w1, w2, w3], &self.of.slide.law);
            let ([_, f_2, f_h], drills) = match law.patch() {
                Some(patch) => {
                    let (at, _, drills) = law.on_patch(angle, w, u, patch);
                    (at.force, drills)
                }
                None if u == [0.0; 2] => ([0.0; 3], 0.0),
                None => (self.of.slide.slips(angle, w, u, None).0.force, 0.0),
            };
            let power = drills - (f_2 * across + f_h * along);
            let share = self.sums_bounces((left, bounce), [along.hypot(across), power], after.w);
            self.of.roundings.turned += share;
        }
        let level = || self.tilt(from.angle).abs().max(after.lift).max(after.on_other_rim(&rims).lift.abs());
        if self.has_two_rims() && e > 0.0 && level() < RATTLED {
            return if !one { self.ends_rattle() } else { Next::Ends(Ending::Side) };
        }
        if e > 0.0 && self.hardly_rattles(&after) {
            return if !one { self.ends_rattle_on_face() } else { Next::Ends(Ending::Face) };
        }
        self.leaves_impact(&after)
    }

    /// The patch of contact at this inclination; None for a point.
    fn patched(&self, angle: (f64, f64), w: [f64; 3]) -> Option<PatchedPoint> {
        let law = &self.of.slide.law;
        law.patch().map(|radius| patched(&law.shape, angle, radius, self.of.slide.drills(angle, w[0], w[2])))
    }

    /// Whether the motion ends where a second circle or a face lands, since its impact has no model here: on a
    /// turntable, with a patch, with a drive, or under a law of restitution other than Stronge's.
    pub(super) fn has_one_contact(&self) -> bool {
        let other =
            self.ask.impact_law != ImpactLaw::Stronge && self.ask.restitution.is_some_and(|e| e > 0.0);
        self.of.turning != 0.0 || self.of.slide.law.patch().is_some() || self.of.own.drives() || other
    }

    /// The impact of the body `from` on the table; None for a contact that only rolls if there is no solution.
    pub(super) fn impact(&self, from: &Aloft, e: f64) -> Option<Struck> {
        self.impact_under(self.ask.impact_law, from, e)
    }

    fn impact_under(&self, impact_law: ImpactLaw, from: &Aloft, e: f64) -> Option<Struck> {
        if self.of.uniform && from.slip == [0.0; 2] {
            return Some(self.rebounds(from.lift, e));
        }
        let mut light = lightness(&self.of.slide.law.shape, from.angle);
        if self.of.uniform {
            // Rounding must not make the slip turn.
            (light.level[1][1], light.normal, light.couples[0]) = (light.level[0][0], 1.0, 0.0);
        }
        let patch = self.patched(from.angle, from.w);
        let point = self.point_impact((from.slip, from.lift), (light, patch), &self.of.own);
        PointImpact { law: impact_law, ..point }.on(&self.ask.table, e, &self.of.own)
    }

    /// A bound of the change of w by the losses and user-defined couples in a unit of time, under a normal force. The
    /// couple of the air below a face does not depend on that force.
    fn couple_bound(&self, at: &Aloft, force: f64) -> f64 {
        let (body, sum) = (&self.of.body, self.ask.losses.coefficients.iter().sum::<f64>());
        if self.of.own.has_couple() {
            let (own, driven) = (self.of.own.couple_at(&at.state(), force), self.of.own.driven().1);
            let losses = Couples::of(&self.ask.losses, |x| x);
            return own
                .into_iter()
                .chain(driven)
                .fold(self.most_couple(at, losses, sum * force), |most: f64, m| most.max(m.abs()))
                / body.i1().min(body.i3());
        }
        let Some(losses) = Couples::some(&self.ask.losses) else { return 0.0 };
        self.most_couple(at, losses, sum * force) / body.i1().min(body.i3())
    }

    fn most_couple(&self, at: &Aloft, losses: Couples<f64>, pressed: f64) -> f64 {
        let fastest = at.w.into_iter().fold(1.0, |most: f64, w| most.max(w.abs()));
        let seen = Kinematics::of(&self.of.slide.law.shape.rim, at.angle, at.w[0] / at.angle.0, at.w);
        losses.at(&seen).free.into_iter().fold(pressed * fastest, |most: f64, m| most.max(m.abs()))
    }

    /// The total time of all bounces after an impact; None unless it is so short that the bounces are summed.
    fn bounces(&self, from: &Aloft, struck: &Struck, force: f64, e: f64) -> Option<f64> {
        let shape = &self.of.slide.law.shape;
        let (light, w) = (lightness(shape, from.angle), turned(shape, from.angle, from.w, struck));
        let patch = self.patched(from.angle, w);
        let bounce = Bounce { struck, light: &light, patch, force, loses: self.of.loses(&self.ask) };
        self.bounces_for(&bounce, e, &self.of.own, || {
            let [along, across] = self.of.slide.slips(from.angle, w, [0.0; 2], Some([0.0; 2])).0.u;
            let mut at = self.at;
            at[W1..=U2].copy_from_slice(&[w[0], w[1], w[2], struck.slip[0], struck.slip[1]]);
            self.of.slide.asks_drive(&at);
            let [pull_h, pull_2] = self.of.slide.pull(&at);
            [along - light.couples[0] * force + pull_h, across + pull_2]
        })
    }

    /// The body after an impact, which is also recorded in the results.
    pub(super) fn struck(&mut self, from: &Aloft, struck: &Struck, (other, stays): (bool, bool)) -> Aloft {
        let w = turned(&self.of.slide.law.shape, from.angle, from.w, struck);
        let after = Aloft { w, slip: struck.slip, lift: struck.lift, ..*from };
        self.claims_no_gain(struck.lost);
        self.records([from, &after], other, struck.hit, (struck.impulse, struck.lost), stays);
        self.made.path.impacts.iter_mut().last().into_iter().for_each(|last| last.couple = struck.couple);
        after
    }

    /// Adds an impact to the results, from the body before and after it, counted from the rim that lands.
    pub(super) fn records(
        &mut self,
        both: [&Aloft; 2],
        other: bool,
        hit: Hit,
        (impulse, lost): ([f64; 3], f64),
        stays: bool,
    ) {
        let mut velocities = both.map(|at| [at.slip[0], at.slip[1], at.lift]);
        let (time, mut states) = (self.t0 + self.at[TIME], both.map(|at| self.state_of(at)));
        let view = self.made.path.view;
        let (mut impulse, mut rim) = (impulse, u8::from(other));
        if let Some([here, next]) = view.circles {
            rim = if other == view.over { here } else { next };
            if other {
                states = states.map(|y| y.told(PI - y.theta));
                let told = |[along, across, up]: [f64; 3]| [0.0 - along, 0.0 - across, up];
                (velocities, impulse) = (velocities.map(told), told(impulse));
            }
        }
        self.records_impact(Strike {
            time,
            lands: (rim > 0).into(),
            rim,
            hit,
            states,
            velocities,
            impulse,
            couple: 0.0,
            lost,
            after: stays.into(),
        });
    }

    /// The vertical velocities of both rims; first that of the rim from which the state is counted.
    fn lifts_of_both(&self) -> [f64; 2] {
        let at = self.aloft();
        [at.lift, at.on_other_rim(&self.of.body.rims()).lift]
    }

    /// Computes the impacts of two rims, at once while both come down and else in turn, until no rim comes down.
    /// Returns the next phase.
    #[inline(never)]
    pub(super) fn rattles(&mut self, e: f64) -> Next {
        (self.at[SIN], self.at[COS]) = self.of.body.border_angle();
        let [here, there] = self.lifts_of_both();
        let over = RATTLE_OVER * here.min(there).abs().min(1.0);
        for turn in 0.. {
            let [here, there] = self.lifts_of_both();
            if here.min(there) > -over {
                break;
            }
            if turn > MOST_IN_TURN {
                return self.gives_up(Limit::Impacts);
            }
            if here.max(there) < -over {
                if let Err(ending) = self.bounces_on_both(e) {
                    return Next::Ends(ending);
                }
                continue;
            }
            if there < here {
                self.turns_over();
            }
            let at = self.aloft();
            let Some(struck) = self.impact(&at, e) else { return Next::Ends(Ending::Slip) };
            let after = self.struck(&at, &struck, (self.made.path.view.over, false));
            self.sets(&after);
        }
        let [here, there] = self.lifts_of_both();
        if there < here {
            self.turns_over();
        }
        self.hops.takeoff.height = 0.0;
        let [here, there] = self.lifts_of_both();
        if there < RATTLED {
            return self.ends_rattle();
        }
        if here < over {
            self.claims(here.abs());
            return self.touches_down();
        }
        self.hops.takeoff.leaves = Some(1);
        Next::Own(Kind::Flying)
    }

    /// Sets the current state to that after both rims have struck at once, counted from the rim that came down more
    /// slowly.
    fn bounces_on_both(&mut self, e: f64) -> Result<(), Ending> {
        if self.at[W2] > 0.0 {
            self.turns_over();
        }
        let (at, rims) = (self.aloft(), self.of.body.rims());
        let (friction, rolls) = match self.ask.table {
            Table::Rubs(friction) => (friction, false),
            Table::Rolling { mu } => (Friction::coulomb(mu.min(PERFECTLY_ROUGH)), true),
            Table::Smooth => (Friction::coulomb(0.0), false),
        };
        let (y, slip, lift, lost) =
            bounced(&self.of.body, &self.of.state, (at.slip, at.lift), &friction, &self.of.own, e)
                .map_err(|_| Ending::Landing)?;
        let mut after = Aloft { w: [y.w1, y.w2, y.w3], slip, lift, ..at };
        if rolls {
            let slips = [slip, after.on_other_rim(&rims).slip].into_iter().flatten();
            // What is left is rounding, or a slip that friction cannot stop.
            if slips.fold(0.0, |most: f64, u| most.max(u.abs())) > RATTLE_OVER * at.lift.abs() {
                return Err(Ending::Slip);
            }
            after.slip = [0.0; 2];
        }
        let impulse = gained(&rims[0], [&at, &after]);
        self.claims(-lost);
        self.records([&at, &after], self.made.path.view.over, Hit::BothRims, (impulse, lost), false);
        self.sets(&after);
        Ok(())
    }

    /// The phase of a body on both rims after a sequence of their impacts, the last of which are summed.
    fn ends_rattle(&mut self) -> Next {
        let from = self.aloft();
        let left = self.tilt(from.angle).abs().max(from.w[1].abs()).max(from.lift.abs());
        let Table::Rubs(friction) = self.ask.table else {
            self.claims(left);
            if from.w[1] > 0.0 {
                self.turns_over();
            }
            self.hops.takeoff.lift = 0.0;
            return self.lands_on_both();
        };
        // The last impacts turn a slip that is slower than they are.
        let slips = [from.slip, from.on_other_rim(&self.of.body.rims()).slip].map(|[u, v]| u.hypot(v));
        let turns = if left > 0.0 { (left / slips[0].min(slips[1])).min(1.0) } else { 0.0 };
        let doubt = (left * turns).max(left * left * SUMMED);
        self.claims(doubt);
        self.doubts(doubt);
        let from = self.aloft();
        self.claims(left * LASTS * self.couple_bound(&from, 1.0));
        let (law, flat) = (self.of.slide.law, self.of.body.border_angle());
        let state = State { theta: self.of.body.theta_end(), ..self.of.state };
        let (v, still) = (law.centre(from.angle, from.w, from.slip), law.centre(flat, from.w, [0.0; 2]));
        // Where the rims slip, the centre keeps its velocity while the axis comes to lie level.
        let slip = if from.slip == [0.0; 2] { from.slip } else { [v[0] - still[0], v[1] - still[1]] };
        let (y, slip) = settled(&self.of.body, &state, (slip, from.lift), &friction, &self.of.own);
        let lift = from.lift + law.shape.rim.lever(from.angle) * from.w[1];
        let mut before = newton::energy(&law.shape, from.angle, from.w, [v[0], v[1], lift]) + from.height;
        if self.of.tilt != 0.0 {
            // The centre moves as the axis comes to lie level on this contact point.
            let rim = &law.shape.rim;
            before += pull(self.of.tilt, &self.at)[0] * (rim.lever(from.angle) - rim.lever(flat));
        }
        self.at[HEAT] += before - law.energy(&y, slip);
        let after = Aloft { angle: flat, w: [y.w1, 0.0, y.w3], slip, lift: 0.0, height: 0.0, ..from };
        self.sets(&after);
        self.settles_on_side()
    }

    /// The phase after a landing on both rims without a bounce.
    pub(super) fn lands_on_both(&mut self) -> Next {
        let friction = match self.ask.table {
            Table::Rubs(friction) => friction,
            _ if self.at[W1] == 0.0 && self.at[W3] == 0.0 => Friction::coulomb(PERFECTLY_ROUGH),
            _ => return Next::Ends(Ending::Side),
        };
        (self.at[SIN], self.at[COS]) = self.of.body.border_angle();
        if self.at[W2] > 0.0 {
            self.turns_over();
        }
        let before = State { theta: self.of.body.theta_end(), ..self.of.state };
        let lift = self.hops.takeoff.lift;
        let Ok(landed) = land_at(&self.of.body, &before, (self.at.slip(), lift), &friction, &self.of.own)
        else {
            let left = self.at[W2].abs();
            if left > RATTLED {
                return Next::Ends(Ending::Landing);
            }
            // What so slow a landing changes is an error.
            self.claims(left * LASTS);
            return self.settles_on_side();
        };
        // The impact is told from the rim that lands.
        let (rims, carried) = (self.of.body.rims(), self.made.path.view.over);
        let from = self.aloft().on_other_rim(&rims);
        let landing = self.of.body.beyond().rims()[0];
        self.lands_as(&landed);
        let here = self.aloft();
        let there = if carried == self.made.path.view.over { here.on_other_rim(&rims) } else { here };
        let impulse = gained(&landing, [&from, &there]);
        self.claims(-landed.lost);
        self.records([&from, &there], !carried, Hit::BothRims, (impulse, landed.lost), true);
        let rises = self.at[W2];
        if rises < ROCKED_OUT {
            self.claims(rises * LASTS);
            return self.settles_on_side();
        }
        if rises < ROCKED
            && let Some((end, error)) = self.rocks_out()
        {
            self.claims(error);
            self.at = end;
            return self.settles_on_side();
        }
        if self.at[W2] < ROCKED
            && let Some(next) = self.rocks_to_pivot()
        {
            return next;
        }
        if rises < ROCKED
            && let Some((end, error)) = self.shrinks_out()
        {
            self.claims(error);
            let energy = |y: &[f64; N]| self.of.slide.energy(y) + y[HEAT] + lost(y);
            let taken = energy(&self.at) - energy(&end);
            // The landings that are summed take what is missing.
            self.made.path.impacts.iter_mut().last().into_iter().for_each(|last| last.lost += taken);
            self.claims(-taken);
            self.at = end;
            return self.settles_on_side();
        }
        self.touches_down()
    }

    /// Sets the current state to that after a landing on both rims.
    pub(super) fn lands_as(&mut self, landed: &Landed) {
        if landed.outcome == Outcome::Changes {
            self.turns_over();
        }
        let State { w1, w2, w3, .. } = landed.state;
        let after = Aloft { w: [w1, w2, w3], slip: landed.slip.pair(), lift: 0.0, ..self.aloft() };
        self.sets(&Aloft { height: 0.0, ..after });
    }
}
