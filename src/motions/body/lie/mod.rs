//! A body that lies on both rims: the choice of its phases, and the end of each.
//!
//! ```text
//! both slip     to u = 0 of a rim: it sticks, or slips on in another direction;  both together: rolls straight
//! one sticks    to w1 = 0: rolls straight;   to |F| = mu_s N: both slip
//! both of these to N = 0 of a rim: the other one carries the body alone, with w2 = w2' = 0, and theta leaves as t^3
//! a body that turns fast, whose centre is not between the two, leaves the table with both
//! rolls straight at constant speed, or until dry losses stop it
//! on a slope, at rest on both: rolls straight if c + c' >= |F_h|, c = sqrt((mu_s N)^2 - F_2^2);  else see `two_at_rest`
//!   one sticks, to w1 = 0: the same test;   rolls straight, to w3 = 0: turns round, or rests if dry losses hold it
//! ```
//! The rim from which the state is counted changes only where the other rim carries the body alone, or slips off
//! first.
//!
//! Error: the tolerance of the steps; rolling straight without losses is exact.

pub(crate) mod flow;
mod hop;
mod rocks;

use super::body_walk::BodyWalk;
use super::fly::Aloft;
use super::fly::flies::pose_from;
use super::own::Own;
use super::write;
use crate::error::Error;
use crate::laws::body::Body;
use crate::laws::contact::landing::mirrored;
use crate::laws::contact::lying::{Lain, Lying};
use crate::laws::contact::slip::Friction;
use crate::laws::contact::standstill::{Standstill, standstill, towards};
use crate::laws::contact::{Force, Table};
use crate::laws::loss::{GRACE, Ways};
use crate::laws::state::{Slip, State, spin_of};
use crate::methods::flow::{Flow, Steps};
use crate::methods::search::crossing;
use crate::motions::ask::row::OutputRow;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, Halt, PHI, PSI, SIN, TIME, U2, UH, W1, W2, W3, X, Y, lost, poses,
};
use crate::motions::walk::{Next, Pause, Phases, WalkStep, after_rest, ending};
use crate::motions::{AboveTable, Ask, Ending, Kind, Moving, OtherRim, Phase};
use core::f64::consts::PI;
use flow::{LyingFlow, LyingPhase, Stance, flat};

/// A slip slower than this, in units of the largest speed, counts as zero where a phase begins.
const STILL_SLIP: f64 = 1e-12;
/// A body that rocks may end by pivoting about one rim if this rim slips more slowly than the other one by this
/// factor.
const ROCKS_BESIDE: f64 = 1e-3;
/// An upper bound of the time in which a rocking ends in a pivot, in units of v (1/mu + 1/ell)/(N (1 - f)), with the
/// velocity v of the rocking, the smaller normal force N of the pivot, and the share f of friction that the pivot
/// needs; the largest in 3,100 random rockings was 1.55. A rocking longer than `ROCKS_ON` is computed hop by hop.
const ROCKS_LONG: f64 = 3.0;
const ROCKS_ON: f64 = 1e-9;
/// Largest number of consecutive phases of zero duration whose order is trusted.
const REPEATED: u32 = 3;
/// A slip slower than this stops at once where friction does not let it go on.
const STOPS_AT_ONCE: f64 = 1e-6;
/// The slip speed that both rims get when they begin to slip together.
const NUDGED: f64 = 1e-12;
/// Number of directions in which the growth of a slip from rest is evaluated.
const DIRECTIONS: usize = 240;
/// Shares by which friction is taken to be smaller than what both rims need, where it has just ceased to hold them.
/// Each is tried if the search for the slips fails with the one before.
const RELEASED: [f64; 3] = [1e-9, 1e-7, 1e-5];
/// A slip from rest whose speed grows at a smaller rate is too slow to begin.
const BEGINS: f64 = 1e-4;
/// Times for which a body keeps rolling after friction has just ceased to hold both rims, so that slips that hardly
/// begin have a rate. Each is tried if the search for the slips fails with the one before.
const ROLLS_ON: [f64; 2] = [1e-3, 1e-4];
/// A growth rate of the speed below this counts as zero.
const SLIPS_FASTER: f64 = 1e-11;

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// The equations of the body on both rims. None for a contact that only rolls if the body turns or slips, and for
    /// a rolling resistance that acts only while the body rolls, since one rim may roll while the other slips.
    fn flat(&self) -> Option<LyingFlow<G>> {
        if self.ask.resists_only_rolling() {
            return None;
        }
        let (friction, rolls) = match self.ask.table {
            Table::Rubs(friction) => (friction, false),
            Table::Rolling { mu } => (Friction::coulomb(mu.min(1e100)), true),
            Table::Smooth => return None,
        };
        let law = Lying::on(&self.of.body, &friction, &self.ask.losses);
        let moves = [law.turning(self.at[W1], self.at[W3])[0], self.at[UH], self.at[U2]];
        if rolls && moves != [0.0; 3] {
            return None;
        }
        let fixed = match friction {
            Friction::Coulomb { fixed, .. } => fixed,
            Friction::Viscous { .. } => 0.0,
        };
        let flow = LyingFlow::new(law, self.of.own, fixed, (self.of.slide.over(), self.of.slide.tol));
        Some(flow.on_slope(self.of.tilt, &self.at))
    }

    /// The phase of a body at theta = pi/2 with w2 = 0: on both rims, or on one of them that rises.
    ///
    /// The state of a body on both rims is always counted from the first rim.
    #[inline(never)]
    pub(super) fn settles_on_side(&mut self) -> Next {
        if self.made.path.view.over {
            self.turns_over();
        }
        self.lays_down();
        let [w1, w3] = [self.at[W1], self.at[W3]];
        self.of.state = State { theta: self.of.body.theta_end(), w1, w2: 0.0, w3 };
        let Some(mut flow) = self.flat() else { return Next::Ends(Ending::Side) };
        let flat @ [.., u_h, u_2] = [w1, w3, self.at[UH], self.at[U2]];
        let [_, other] = flow.law.other_slip(flat);
        if flow.law_at(flat).takes_off(w1, w3) {
            return Next::Ends(Ending::LiftOff);
        }
        let [drilling, rolling] = flow.law.turning(w1, w3);
        let turns = 0.5 * flow.law.border.span() * drilling;
        let size =
            STILL_SLIP * [turns, rolling, u_h, u_2].into_iter().fold(1.0, |most: f64, x| most.max(x.abs()));
        // The time of slower slips is lost in the rounding of theta.
        let over = if self.does_not_advance() { STOPS_AT_ONCE } else { size };
        let mut still = [u_2, other].map(|across| flow.law.dry && u_h.hypot(across) <= over);
        let slow = [u_2, other].iter().all(|across| flow.law.dry && u_h.hypot(*across) <= STOPS_AT_ONCE);
        if slow && still == [false; 2] && !self.slips_soundly(&mut flow) {
            still = [true; 2];
        }
        for (sticks, across) in still.into_iter().zip([u_2, other]) {
            if sticks {
                self.claims(u_h.hypot(across));
            }
        }
        match still {
            [true, true] => self.rolls_or_slips(flow),
            [false, false] => {
                let [here, there] = self.normals(&mut flow);
                let law = flow.law_at(flat);
                let [low, up] = law.strength;
                let room = if law.dry {
                    let [p, q] = law.leans([low * u_h / u_h.hypot(u_2), up * u_h / u_h.hypot(other)]);
                    p + q
                } else {
                    1.0
                };
                match (here >= 0.0, there >= 0.0) {
                    (true, true) if room > 0.0 => self.begins_stance(flow, Stance::Slips),
                    (true, true) => Next::Ends(Ending::Painleve),
                    (carries, _) => self.rises_on(carries == (room > 0.0), false),
                }
            }
            [here, _] => {
                [self.at[UH], self.at[U2]] = flow.law.stuck(flat, !here);
                self.sets_state();
                self.rests_on_one(flow, !here)
            }
        }
    }

    /// Whether several phases have begun and ended at the same time.
    pub(super) fn does_not_advance(&self) -> bool {
        self.of.body.has_row() && self.still > REPEATED
    }

    /// Whether a body can slip on both rims, or on one while the other rises, under friction. Where it cannot
    /// (Painleve), a slow slip stops at once, by an impact along the table that takes hardly any energy.
    fn slips_soundly(&mut self, flow: &mut LyingFlow<G>) -> bool {
        let y @ [.., u_h, u_2] = flat(&self.at);
        let [_, other] = flow.law.other_slip(y);
        let [here, there] = self.normals(flow);
        let [low, up] = flow.law_at(y).strength;
        let [p, q] = flow.law.leans([low * u_h / u_h.hypot(u_2), up * u_h / u_h.hypot(other)]);
        match (here >= 0.0, there >= 0.0) {
            (true, true) => p + q > 0.0,
            (carries, _) => self.seen_from(carries != (p + q > 0.0), |walk| {
                let State { w1, w3, .. } = walk.of.state;
                let one = walk.of.slide.slips(walk.at.angle(), [w1, 0.0, w3], walk.at.slip(), None).0;
                one.room > 0.0 && one.force[0] > 0.0 && one.w[1] > 0.0
            }),
        }
    }

    /// Whether no finite contact force exists for this slip, since friction presses the rim into the table
    /// (Painleve).
    fn jams_here(&self, slip: [f64; 2]) -> bool {
        self.of.slide.at_start(&self.of.state, slip) == Some(Halt::Jam)
    }

    /// Sets sine and cosine of theta, and w2, to those of a body with both rims on the table.
    fn lays_down(&mut self) {
        (self.at[SIN], self.at[COS]) = self.of.body.border_angle();
        self.at[W2] = 0.0;
    }

    /// Sets the rotation about the vertical and the slip of a body that rolls straight to zero.
    fn rolls_along(&mut self, law: &Lying<f64>) {
        let [_, rolling] = law.turning(self.at[W1], self.at[W3]);
        [self.at[W1], self.at[W3]] = law.turned_by([0.0, rolling]);
        (self.at[UH], self.at[U2]) = (0.0, 0.0);
        self.sets_state();
    }

    fn sets_state(&mut self) {
        self.of.state = State { w1: self.at[W1], w3: self.at[W3], ..self.of.state };
    }

    /// The normal forces of both rims while both slip. Sets the signs of the dry losses.
    fn normals(&self, flow: &mut LyingFlow<G>) -> [f64; 2] {
        flow.sets_ways(&self.at);
        let [here, there] = flow.lain(&self.at).force;
        [here[0], there[0]]
    }

    /// Begins a phase of a body on both rims.
    fn begins_stance(&mut self, flow: LyingFlow<G>, stance: Stance) -> Next {
        let flow = flow.in_stance(stance, &self.at);
        let law = &flow.law;
        if stance == Stance::Rolls && self.of.tilt == 0.0 {
            let Lain { w: [_, slows], force, .. } = flow.lain(&self.at);
            // Only a couple of the user presses the rims differently, or turns the body about the vertical.
            let slips = |[n, across, _]: [f64; 3]| across.abs() > flow.fixed * n * (1.0 + GRACE);
            if let Some(lower) = (0..2).find(|k| force[*k][0] < 0.0) {
                // The other end carries the body, and this one rises.
                return self.rises_on(lower == 1, true);
            }
            let pull = law.pulls_to_apex(flat(&self.at));
            if pull.abs() > flow.holds_together(&force) {
                self.at[UH] = -pull.signum() * NUDGED;
                return self.begins_stance(flow, Stance::Slips);
            }
            if slows.abs() > flow.fixed * (1.0 + GRACE) || force.into_iter().any(slips) {
                // Both rims slip across, since friction cannot slow the body as much as the losses do.
                self.at[U2] = -slows.signum() * NUDGED;
                return self.begins_stance(flow, Stance::Slips);
            }
        }
        let [_, rolling] = law.turning(self.at[W1], self.at[W3]);
        if stance == Stance::Rolls && rolling == 0.0 && law.held()[1] {
            while self.until().is_some_and(|t| t <= self.at[TIME]) {
                self.writes_lying(&flow, &{ self.at });
            }
            return Next::Ends(Ending::Stops);
        }
        let kind = flow.kind();
        self.of.lying = Some(Box::new(LyingPhase { flow }));
        Next::Own(kind)
    }

    /// The phase of a body on both rims whose contact points are at rest: it rolls straight, slips, or rises on one
    /// rim.
    fn rolls_or_slips(&mut self, flow: LyingFlow<G>) -> Next {
        self.rolls_along(&flow.law);
        if self.of.tilt == 0.0 {
            return self.begins_stance(flow, Stance::Rolls);
        }
        let flow = flow.in_stance(Stance::Rolls, &self.at);
        if flow.holds_both(&self.at) {
            return self.begins_stance(flow, Stance::Rolls);
        }
        if !matches!(self.ask.table, Table::Rubs(_)) {
            let lower = flow.lain(&self.at).force.iter().position(|force| force[0] < 0.0);
            return lower.map_or(Next::Ends(Ending::Slip), |lower| self.rises_on(lower == 1, true));
        }
        self.slips_from_rest(flow, None).unwrap_or(Next::Ends(Ending::Landing))
    }

    /// The phase of a body on a slope whose rims are at rest, where friction cannot hold both. If it has just ceased
    /// to, `released` is the share by which it is too weak, and the time for which the body keeps rolling. None if no
    /// phase is found.
    #[inline(never)]
    fn slips_from_rest(&mut self, mut flow: LyingFlow<G>, released: Option<(f64, f64)>) -> Option<Next> {
        // Friction that has just held both rims is at its limit.
        let (held, along) =
            (flow.lain(&self.at).force, flow.law_here(&self.at).pulls_to_apex(flat(&self.at)));
        let [c, d] = flow.holds_along(&held);
        let near = [0, 1].map(|k| [along * [c, d][k] / (c + d).max(f64::MIN_POSITIVE), held[k][1]]);
        flow.stance = Stance::Slips;
        flow.holds_all(&self.at);
        let w = [self.at[W1], self.at[W3]];
        let begins = |flow: &LyingFlow<G>| {
            let law = flow.law_here(&self.at);
            let Some((share, _)) = released else { return law.begins(w, [flow.fixed; 2], [[0.0; 2]; 2]) };
            let mu = law.strength.map(|mu| mu * (1.0 - share));
            Lying { strength: mu, ..law }.begins(w, mu, near)
        };
        let mut found = begins(&flow);
        if found.is_some_and(|begun| flow.lets_roll(&begun.lain)) {
            found = begins(&flow);
        }
        let begun = found?;
        let fastest = begun.slips.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        if released.is_some_and(|(_, lasts)| lasts == 0.0 && fastest < BEGINS || begun.moves == [false; 2]) {
            return None;
        }
        let [here, there] = begun.lain.force.map(|force| force[0] > 0.0);
        if !(here && there) {
            let rises = here || there;
            return Some(if rises { self.rises_on(here, true) } else { Next::Ends(Ending::LiftOff) });
        }
        // The rate of a slip that hardly begins has grown from zero for this time.
        let moment = match released {
            Some((_, lasts)) if lasts > 0.0 => 0.5 * lasts,
            _ if fastest > 0.0 => NUDGED / fastest,
            _ => 0.0,
        };
        // The drilling belongs to the slips, but not what the rolling gains until then.
        let [drilling, rolling] = flow.law.turning(w[0], w[1]);
        let [turns, _] = flow.law.turning(begun.lain.w[0], begun.lain.w[1]);
        [self.at[W1], self.at[W3]] = flow.law.turned_by([drilling + moment * turns, rolling]);
        self.sets_state();
        self.claims(NUDGED.max(fastest * moment * moment));
        let stance = match begun.moves {
            [false, false] => {
                self.rolls_along(&flow.law);
                return Some(self.begins_stance(flow, Stance::Rolls));
            }
            [true, true] => {
                [self.at[UH], self.at[U2]] = begun.slips[0].map(|rate| moment * rate);
                let drags = begun.slips.map(|u| flow.law.drag(flow.law.strength[0], u)[0]);
                let [p, q] = flow.law.leans(drags);
                if p + q <= 0.0 {
                    return Some(Next::Ends(Ending::Painleve));
                }
                Stance::Slips
            }
            [other, _] => {
                [self.at[UH], self.at[U2]] = flow.law.stuck(flat(&self.at), other);
                Stance::Pivots { other }
            }
        };
        Some(self.begins_stance(flow, stance))
    }

    /// The phase of a body that rolls straight down a slope, where friction just ceases to hold both rims.
    fn slips_past_limit(&mut self, flow: &LyingFlow<G>) -> Next {
        let (begin, mut rates) = (self.at, [0.0; N]);
        flow.write_rates(&begin, &mut rates);
        let later = |t: f64| core::array::from_fn(|i| begin[i] + t * rates[i]);
        if let Some(next) =
            RELEASED.into_iter().find_map(|share| self.slips_from_rest(*flow, Some((share, 0.0))))
        {
            return next;
        }
        for lasts in ROLLS_ON {
            while let Some(t) = self.until().filter(|t| *t <= begin[TIME] + lasts) {
                self.writes_lying(flow, &later(t - begin[TIME]));
            }
            self.at = later(lasts);
            self.sets_state();
            if let Some(next) = self.slips_from_rest(*flow, Some((0.0, lasts))) {
                return next;
            }
        }
        Next::Ends(Ending::Landing)
    }

    /// The phase in which one rim alone carries the body: if `here`, the rim from which the state is counted. `still`
    /// means that this rim does not slip.
    fn rises_on(&mut self, here: bool, still: bool) -> Next {
        self.turns_to(!here, still);
        self.lays_down();
        self.of.state.w2 = 0.0;
        let slip = self.at.slip();
        if slip == [0.0; 2] && self.of.slide.law.dry {
            return after_rest(Phases::rests(self));
        }
        // The friction of one rim alone may press it into the table: an impact stops the slip or raises the other rim.
        if self.jams_here(slip) { Next::Ends(Ending::Painleve) } else { Next::Slips }
    }

    /// If `other`, counts the state from the other rim from this moment on. If `still`, sets the slip of the chosen
    /// rim to exactly zero, without its rounding error.
    fn turns_to(&mut self, other: bool, still: bool) {
        if other {
            self.turns_over();
        }
        if still {
            (self.at[UH], self.at[U2]) = (0.0, 0.0);
        }
    }

    /// The phase in which the body pivots about one rim at rest, if a rocking that has begun at theta = pi/2 ends in
    /// it so soon that its hops are summed; else None.
    #[inline(never)]
    pub(crate) fn rocks_to_pivot(&mut self) -> Option<Next> {
        let mut flow = self.flat()?;
        let ([here, there], w2) = (flow.law.border.circles, self.at[W2]);
        let lever = here.lever.min(-there.lever);
        let y @ [.., u_h, u_2] = flat(&self.at);
        let speeds = [u_2, flow.law.other_slip(y)[1]].map(|across| u_h.hypot(across));
        let other = speeds[1] < speeds[0];
        let [slow, fast] = if other { [speeds[1], speeds[0]] } else { speeds };
        let mu = if self.of.own.varies() { self.of.own.coefficient_at(fast) } else { flow.law.strength[0] };
        let slow = slow + w2.abs();
        if !(flow.law.dry && slow < ROCKS_BESIDE * fast && slow < ROCKS_ON) {
            return None;
        }
        let begin = self.at;
        self.at[W2] = 0.0;
        [self.at[UH], self.at[U2]] = flow.law.stuck(y, other);
        flow = flow.in_stance(Stance::Pivots { other }, &self.at);
        let Lain { force, .. } = flow.lain(&self.at);
        let [n, across, along] = force[usize::from(other)];
        let least = force[0][0].min(force[1][0]);
        // A rim that is only just held, or presses little, takes longer to come to rest.
        let lasts =
            ROCKS_LONG * slow * (1.0 / mu + 1.0 / lever) / (least * (1.0 - across.hypot(along) / (mu * n)));
        let held = flow.law.held() != [false; 2];
        if held || least <= 0.0 || !(0.0..ROCKS_ON).contains(&lasts) {
            self.at = begin;
            return None;
        }
        // The impulses that take the speed `slow` would change w1 and w3 by as much as friction does in this time.
        let (far, wide) = (here.depth.abs().max(there.depth.abs()), here.radius.max(there.radius));
        let pushes = mu * (far / self.of.body.i1()).max(wide / self.of.body.i3());
        self.claims(slow + lasts * (1.0 + pushes));
        self.sets_state();
        let energy = |y: &[f64; N]| self.of.slide.energy(y);
        let lost = energy(&begin) - energy(&self.at);
        self.claims(-lost);
        self.at[HEAT] += lost;
        Some(self.settles_on_side())
    }

    /// The phase of a body with one rim at rest while the other slips; the other rim is at rest if `other`.
    #[inline(never)]
    fn rests_on_one(&mut self, flow: LyingFlow<G>, other: bool) -> Next {
        let flow = flow.in_stance(Stance::Pivots { other }, &self.at);
        let at = flow.lain(&self.at);
        let [n, across, along] = at.force[usize::from(other)];
        let presses = at.force.iter().all(|force| force[0] >= 0.0);
        if presses && across.hypot(along) <= flow.fixed * n * (1.0 + GRACE) {
            return self.begins_stance(flow, Stance::Pivots { other });
        }
        // The rim at rest, or the other one, carries the body alone.
        let found = self.seen_from(other, |walk| {
            let found = walk.rests_here();
            let alone = matches!(found, Standstill::Sticks | Standstill::Slips { .. });
            (alone && walk.lifts(found)).then_some(found)
        });
        if let Some(found) = found {
            self.turns_to(other, true);
            self.at[W2] = 0.0;
            return after_rest(found);
        }
        let slides = self.seen_from(!other, |walk| {
            let State { w1, w3, .. } = walk.of.state;
            let one = walk.of.slide.slips(walk.at.angle(), [w1, 0.0, w3], walk.at.slip(), None).0;
            one.room > 0.0 && one.force[0] > 0.0 && one.w[1] > 0.0
        });
        if slides {
            return self.rises_on(other, false);
        }
        let (at, state) = (self.at, self.of.state);
        let slips = flow.law.other_slip(flat(&at))[1].abs().max(at[U2].abs());
        let next = self.slips_off_two(flow, other, None);
        if !matches!(next, Next::Ends(Ending::Painleve)) || slips > STOPS_AT_ONCE {
            return next;
        }
        if other {
            self.turns_over();
        }
        (self.at, self.of.state) = (at, state);
        self.claims(slips);
        self.rolls_or_slips(flow)
    }

    /// The result of `find`, which is evaluated with the state counted from the other rim if `other`.
    fn seen_from<T>(&mut self, other: bool, find: impl FnOnce(&Self) -> T) -> T {
        if !other {
            return find(self);
        }
        let (at, state, takeoff) = (self.at, self.of.state, self.hops.takeoff);
        let (body, slide, view) = (self.of.body, self.of.slide, self.made.path.view);
        self.turns_over();
        let found = find(self);
        (self.at, self.of.state, self.hops.takeoff) = (at, state, takeoff);
        (self.of.body, self.of.slide, self.made.path.view) = (body, slide, view);
        self.of.own.sees(view.over);
        found
    }

    fn rests_here(&self) -> Standstill {
        let state = State { w2: 0.0, ..self.of.state };
        standstill(&self.of.body, &state, &self.friction(), self.couples())
    }

    /// Whether the other rim rises while the rim from which the state is counted, at rest, carries the body alone.
    fn lifts(&self, found: Standstill) -> bool {
        let state = State { w2: 0.0, ..self.of.state };
        match found {
            Standstill::Slips { alpha, .. } => {
                let way = Some(towards(alpha));
                self.of.slide.slips(self.at.angle(), [state.w1, 0.0, state.w3], [0.0; 2], way).0.w[1] > 0.0
            }
            _ => self.rolling_of(&state).0[1] > 0.0,
        }
    }

    /// The phase in which the rim at rest slips off while the other rim slips as well. The state is then counted from
    /// the rim that was at rest. `against` is the direction of a slip that begins continuously.
    #[inline(never)]
    fn slips_off_two(&mut self, flow: LyingFlow<G>, other: bool, against: Option<f64>) -> Next {
        self.turns_to(other, true);
        // The circles of the other view are those of this one in the other order.
        let Some(mut flow) = (if other { self.flat() } else { Some(flow) }) else {
            return Next::Ends(Ending::Side);
        };
        flow.stance = Stance::Slips;
        let mut free = flow;
        let [drilling, rolling] = flow.law.turning(self.at[W1], self.at[W3]);
        free.turn_to(Ways::of(rolling, drilling));
        flow.holds_all(&self.at);
        let held = self.way_off(&flow, against);
        // A motion that dry losses cannot hold in this slip, or without which there is none, begins with it.
        let along = held.or_else(|| self.way_off(&free, against));
        let begins = along.is_some_and(|(alpha, _)| flow.lets_begin(&self.at, towards(alpha)));
        let found = if begins { self.way_off(&flow, against) } else { held };
        let Some((alpha, growth)) = found else { return Next::Ends(Ending::Painleve) };
        self.of.lying = Some(Box::new(LyingPhase { flow }));
        Next::SlipsOff { alpha, growth }
    }

    /// The direction in which the rim at rest slips off while the other one slips, and the rate at which this slip grows.
    fn way_off(&self, flow: &LyingFlow<G>, against: Option<f64>) -> Option<(f64, f64)> {
        let y = [self.at[W1], self.at[W3], 0.0, 0.0];
        let law = flow.law_at(y);
        let [mu, up] = law.strength;
        let up = law.drag(up, law.other_slip(y));
        // f and lambda; f is multiplied by the factor of the normal forces, so that it has no poles.
        let turns = |alpha: f64| {
            let [cos, sin] = towards(alpha);
            let at = law.slipping_along(y, [[mu * cos, mu * sin], up]);
            let [p, q] = law.leans([mu * cos, up[0]]);
            let room = p + q;
            let sound = at.force.iter().all(|force| force[0] >= 0.0);
            (room * (cos * at.u[1] - sin * at.u[0]), cos * at.u[0] + sin * at.u[1], sound)
        };
        against.map(|alpha| (alpha, 0.0)).or_else(|| {
            let place = |k: usize| -PI + 1e-3 + core::f64::consts::TAU * k as f64 / DIRECTIONS as f64;
            let all = (0..DIRECTIONS).filter_map(|k| {
                let (low, high) = (place(k), place(k + 1));
                let (a, b) = (turns(low).0, turns(high).0);
                (a.signum() != b.signum()).then(|| crossing(|alpha| turns(alpha).0, low, high, a, b))
            });
            let grows = all
                .map(|alpha| (alpha, turns(alpha)))
                .filter(|(_, (_, growth, sound))| *sound && *growth > SLIPS_FASTER);
            grows.map(|(alpha, (_, growth, _))| (alpha, growth)).max_by(|a, b| a.1.total_cmp(&b.1))
        })
    }

    /// Computes a phase of a body on both rims, or begins its integration.
    #[inline(never)]
    pub(crate) fn lies(&mut self) -> Option<WalkStep<N>> {
        let flow = self.of.lying.as_ref()?.flow;
        let known = self.of.tilt == 0.0 || flow.law.border.even;
        if flow.stance == Stance::Rolls && known && !self.of.loses(&self.ask) {
            let (begin, began) = (self.at, self.at[TIME]);
            // On a slope two equal rims roll straight, and uniformly accelerated.
            let faster = if self.of.tilt == 0.0 { 0.0 } else { flow.lain(&begin).w[1] };
            while let Some(t) = self.until() {
                let mut y = begin;
                y[TIME] = t;
                if faster != 0.0 {
                    y[W3] += faster * (t - began);
                }
                if poses(N) {
                    // The contact moves along a circle about the apex, or straight on.
                    let ((s, c), [here, _]) = (flow.law.border.angle, flow.law.border.circles);
                    let mut spun = spin_of((s, c), begin[W1], begin[W3]) * (t - began);
                    if faster != 0.0 {
                        spun += 0.5 * faster * (t - began) * (t - began);
                    }
                    let half = 0.5 * begin[W1] / s * (t - began);
                    let (sin, cos) = (begin[PHI] + half).sin_cos();
                    let chord = here.radius * spun * if half == 0.0 { 1.0 } else { half.sin() / half };
                    (y[PHI], y[PSI]) = (begin[PHI] + 2.0 * half, begin[PSI] + spun);
                    (y[X], y[Y]) = (begin[X] - chord * sin, begin[Y] + chord * cos);
                }
                self.writes_lying(&flow, &y);
            }
            self.of.lying = None;
            return None;
        }
        Some(WalkStep::Flows(self.at))
    }

    /// Integrates a phase of a body on both rims.
    #[inline(never)]
    pub(crate) fn lies_on(
        &mut self,
        y: [f64; N],
        steps: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        let Some(flow) = self.of.lying.as_ref().map(|phase| phase.flow) else { return Ok(Pause::No) };
        let first = self.made.motion.states.len();
        let place = flow.place(y);
        self.begins_lawfully(&flow, &place)?;
        let (ask, over, made) = (self.ask, self.over(), &mut self.made);
        let (over, way, body) = (over.as_ref(), made.path.way, self.of.body);
        let mut write =
            |y: &[f64; N]| made.push(row_of(&ask, &flow, LyingView { over, way, body: &body }, y));
        let flown = flow.run(place, steps, &self.since[first..], &mut write, go_on);
        self.has_spent(flown.spent);
        self.heeds_laws(&flow, &flown, || flown.y)?;
        // Where a dry loss stops w1 or w3, the acceleration changes at a time as uncertain as that of an end.
        let stops = matches!(flown.halt, Halt::Drilling | Halt::Contour);
        let halt = if stops { Halt::Turned } else { flown.halt };
        self.claims_time_error(halt, flown.steep, &flown.y);
        if flown.halt == Halt::Pause {
            return Ok(Pause::Here(flown.y, Some(flown.step)));
        }
        Ok(self.stops_lying(flown.y, flown.halt).map_or(Pause::No, |y| Pause::Here(y, None)))
    }

    /// Ends a phase of a body on both rims at the state vector `y`, and chooses the next phase. If the same phase
    /// continues, returns the state vector from which it does.
    #[inline(never)]
    pub(crate) fn stops_lying(&mut self, y: [f64; N], halt: Halt) -> Option<[f64; N]> {
        let mut phase = self.of.lying.take()?;
        self.at = y;
        self.lays_down();
        self.sets_state();
        phase.flow.stands_at(&self.at);
        self.made.path.slipping +=
            if phase.flow.stance == Stance::Slips { y[TIME] - self.began } else { 0.0 };
        let next = match halt {
            Halt::Time | Halt::Pause => return None,
            Halt::Rises | Halt::Changes => {
                let here = halt == Halt::Rises;
                let still = phase.flow.stance == Stance::Pivots { other: !here }
                    || phase.flow.stance == Stance::Rolls;
                self.rocks_to_pivot().unwrap_or_else(|| self.rises_on(here, still))
            }
            Halt::Slips => {
                let other = phase.flow.stance == Stance::Pivots { other: true };
                if phase.flow.stance == Stance::Rolls && self.of.tilt != 0.0 {
                    self.slips_past_limit(&phase.flow)
                } else if phase.flow.stance == Stance::Rolls {
                    self.begins_stance(phase.flow, Stance::Rolls)
                } else {
                    let [_, across, along] = phase.flow.lain(&self.at).force[usize::from(other)];
                    let way = if other { 1.0 } else { -1.0 };
                    let against = f64::atan2(way * across, way * along);
                    let equal = matches!(self.friction(), Friction::Coulomb { mu, fixed, .. } if mu == fixed);
                    self.slips_off_two(phase.flow, other, equal.then_some(against))
                }
            }
            Halt::Drilling | Halt::Contour => {
                if self.turns_too_often() {
                    return None;
                }
                let flow = &mut phase.flow;
                if let Some(part) = flow.ways().holds.ceasing(halt) {
                    flow.lets_go_of(part, &self.at);
                } else {
                    let law = &flow.law;
                    let mut turning = law.turning(self.at[W1], self.at[W3]);
                    turning[usize::from(halt == Halt::Contour)] = 0.0;
                    if flow.stance == Stance::Rolls {
                        turning[0] = 0.0;
                    }
                    [self.at[W1], self.at[W3]] = law.turned_by(turning);
                    self.sets_state();
                    flow.sets_ways(&self.at);
                }
                let rests = flow.stance == Stance::Rolls && flow.law.held()[1];
                if flow.stance == Stance::Rolls && self.of.tilt != 0.0 {
                    // It turns round, with the other way of its losses.
                    self.settles_on_side()
                } else if rests {
                    Next::Ends(Ending::Stops)
                } else {
                    self.of.lying = Some(phase);
                    return Some(self.at);
                }
            }
            Halt::Turned => {
                self.rolls_along(&phase.flow.law);
                self.settles_on_side()
            }
            Halt::Standstill | Halt::OtherStandstill => self.settles_on_side(),
            halt => Next::Ends(ending(halt)),
        };
        self.continues_with(next);
        None
    }

    /// The record of a phase of this kind that begins at the current state; the state of a body on both rims is
    /// counted from the first rim.
    pub(crate) fn told(&self, kind: Kind) -> Phase {
        let (y, slip, over) = (self.of.state, Slip::from(self.at.slip()), self.made.path.view.over);
        let lies = self.of.lying.is_some();
        let path = &self.made.path;
        let (state, slip) = match () {
            () if over && lies => {
                let (state, slip) = mirrored(&self.of.body, &y, slip);
                let theta = if self.of.body.has_row() { path.view.tells(y.theta) } else { state.theta };
                (State { theta, ..state }, slip)
            }
            () if path.is_told_over(lies) => (y.told(path.view.tells(y.theta)), slip.map(|u| 0.0 - u)),
            () => (y, slip),
        };
        let flies = kind == Kind::Flying;
        let aloft = if flies {
            AboveTable::new(self.hops.takeoff.height, self.hops.takeoff.lift)
        } else {
            AboveTable::default()
        };
        let (time, rim) = (self.t0 + self.at[TIME], path.rim(lies));
        Phase { time, kind, state, slip, aloft, rim }
    }

    /// Writes the state vector `y` of a body on both rims to the outputs.
    pub(crate) fn writes_lying(&mut self, flow: &LyingFlow<G>, y: &[f64; N]) {
        let over = self.over();
        let seen = LyingView { over: over.as_ref(), way: self.made.path.way, body: &self.of.body };
        self.made.push(row_of(&self.ask, flow, seen, y));
    }

    /// The current body, if its state is counted from the other rim; else None.
    fn over(&self) -> Option<Aloft> {
        self.made.path.view.over.then(|| self.aloft())
    }

    /// The kind of phase of a slip from rest: `Lying` for a body on both rims, else `Slipping`.
    pub(crate) fn kind_of_slip(&self) -> Kind {
        if self.of.lying.is_some() { Kind::Lying } else { Kind::Slipping }
    }
}

/// How the state of a body on both rims is counted: the body, if from the other rim; the direction `way` in which the
/// slip of a rim just begins; and the shape as counted from this rim.
struct LyingView<'a> {
    over: Option<&'a Aloft>,
    way: [f64; 2],
    body: &'a Body,
}

/// The outputs of a body on both rims, counted from the first rim.
fn row_of<G: Own, const N: usize>(
    ask: &Ask,
    flow: &LyingFlow<G>,
    LyingView { over, way, body }: LyingView<'_>,
    y: &[f64; N],
) -> OutputRow<State> {
    let mut slips = [y.slip(), flow.law.other_slip([y[W1], y[W3], y[UH], y[U2]])];
    let (mut forces, mut w3, mut seen) = (flow.lain_along(y, way).force, y[W3], *y);
    if flow.stance == Stance::Rolls {
        // The force that keeps the body on its circle round the apex is known, but not its shares: those of the loads.
        let pull = flow.law_here(y).pulls_to_apex(flat(y));
        if flow.law.pull.is_some() {
            // The shares in which both rims hold as much as they can.
            let most = flow.holds_along(&forces);
            forces
                .iter_mut()
                .zip(most)
                .for_each(|(force, share)| force[2] += pull * share / (most[0] + most[1]));
        } else {
            forces.iter_mut().for_each(|[normal, _, along]| *along += *normal * pull);
        }
    }
    if let Some(over) = over {
        let back = |x: f64| 0.0 - x;
        slips = [slips[1].map(back), slips[0].map(back)];
        let turned = |[n, across, along]: [f64; 3]| [n, back(across), back(along)];
        (forces, w3) = ([turned(forces[1]), turned(forces[0])], back(w3));
        if poses(N) {
            let pose = core::array::from_fn(|i| y[9 + i]);
            seen[PHI..PHI + 4].copy_from_slice(&pose_from(over, &body.rims(), true, pose));
        }
    }
    let force = |[normal, along, across]: [f64; 3]| Force { normal, along, across };
    let doubt = flow.tol * (1.0 + y[W1].abs().max(y[W3].abs()));
    let theta = body.theta_end();
    let theta = if over.is_some() && body.has_row() { body.view().tells(theta) } else { theta };
    let state = State { theta, w1: y[W1], w2: 0.0, w3 };
    OutputRow {
        pose: poses(N).then(|| write::pose(&seen)),
        force: ask.force.then(|| (force(forces[0]), doubt)),
        other_rim: Some(OtherRim::of(slips[1].into(), force(forces[1]))),
        ..OutputRow::on_table(state, slips[0], [y[HEAT], lost(y)], flow.kind())
    }
}
