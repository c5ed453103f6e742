//! A body that falls on its face in a plane: it stays, or rocks over the opposite point of its ring, infinitely often in a
//! finite time.
//!
//! ```text
//! stays if a^2 >= I1 - Z Q/W,  else W -> r W;     a hop lasts 2 w/gamma,  gamma = -theta'' at theta = 0
//! the rest = the change in one cycle of two hops and two landings, over 1 - r r'
//! ```
//! This is a landing of two circles ([`landing`](crate::laws::contact::landing)) whose other one is the opposite point of the same
//! ring. The model is the block of Housner, Bull. Seismol. Soc. Am. 53, 403 (1963).
//!
//! Error of the sum of the last hops: the square of their total time.

use super::UNMOVED;
use crate::laws::contact::Table;
use crate::laws::contact::impact::Hit;
use crate::laws::contact::landing::{FallingFace, falls_flat};
use crate::laws::contact::slip::Friction;
use crate::laws::loss::{Law, Losses};
use crate::laws::state::State;
use crate::methods::flow::{Flow, Steps};
use crate::motions::body::body_walk::BodyWalk;
use crate::motions::body::fly::Aloft;
use crate::motions::body::own::Own;
use crate::motions::body::strike::{LASTS, MOST_IN_TURN, PERFECTLY_ROUGH, RATTLE_OVER, ROCKED_OUT, gained};
use crate::motions::walk::Next;
use crate::motions::walk::hops::Takeoff;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, Halt, PHI, PSI, SIN, TIME, U2, UH, W1, W2, W3, X, Y, poses,
};
use crate::motions::{Ending, Kind, Limit};
use core::f64::consts::TAU;

/// The hops of a body that rocks and slips are summed if the slip lasts this many times as long as a hop.
const SLIDES_ON: f64 = 10.0;
/// Repeated impacts of a face in a vertical plane end where all velocities are below this: the next hops are as low
/// as roundings of theta.
const LAST_RATTLE: f64 = 3e-6;
/// The end of a rocking whose slips stop in its hops is computed if abs(theta') is below this.
const SLIPS_SHRINK: f64 = 0.1;
/// A hop with a smaller abs(theta') is as low as the inclination from which the motion of a rising body on its rim is
/// computed.
const HARDLY_ROCKS: f64 = 5e-6;
/// Bounces of a face parallel to the table that last less than this time in all are summed.
const LAST_BOUNCES: f64 = 1e-7;

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// The friction law in the landing of a face that falls in a vertical plane.
    pub(super) fn friction_in_fall(&self) -> Friction {
        match self.ask.table {
            Table::Rubs(friction) => friction,
            Table::Rolling { mu } => Friction::coulomb(mu.min(PERFECTLY_ROUGH)),
            Table::Smooth => Friction::coulomb(0.0),
        }
    }

    /// The phase of a body whose face lands in a vertical plane with this theta' (taken positive).
    pub(super) fn falls_on_face(&mut self, falls: f64) -> Next {
        if falls <= ROCKED_OUT {
            self.claims(falls);
            self.lies_on_face();
            return self.stands_on_face();
        }
        if self.has_one_contact() {
            return Next::Ends(Ending::Face);
        }
        let e = self.ask.restitution.unwrap_or(0.0);
        let planar = self.at[W1] == 0.0 && self.at[W3] == 0.0 && self.at[U2] == 0.0;
        if e > 0.0 && planar && falls * self.of.body.rim() > LAST_RATTLE {
            return self.rattles_on_face(e);
        }
        let Some(rocks) = self.lands_flat(0.0, true) else { return Next::Ends(Ending::Landing) };
        if !rocks {
            self.lies_on_face();
            return self.stands_on_face();
        }
        if self.at[W2].abs() < SLIPS_SHRINK
            && self.at[W3] == 0.0
            && let Some((end, error)) = self.shrinks_out()
        {
            return self.rests_after_rocking(end, error);
        }
        self.rises_from_face()
    }

    /// Sets the current state to that after the landing of a face in a vertical plane; both end points of the face
    /// bounce if both come down. Returns whether the body leaves its face; None if there is no unique outcome.
    fn lands_flat(&mut self, e: f64, records: bool) -> Option<bool> {
        let (up, friction) = (self.up(), self.friction_in_fall());
        let (body, rim, angle) = (self.of.body, self.of.slide.law.shape.rim, self.at.angle());
        let arms = [rim.radius(angle), rim.height(angle)];
        let [w1, w2, w3] = self.at.w();
        let falling = FallingFace {
            leans: up * w2,
            turns: w1,
            spins: up * w3,
            slip: self.at.slip().map(|u| up * u),
            lift: self.hops.takeoff.lift,
        };
        let (after, mut lost) = falls_flat(&body, arms, falling, (&friction, e), &self.of.own)?;
        let begin = self.at;
        self.flips();
        let from = self.aloft();
        let stays = after.leans <= 0.0 && e == 0.0;
        (self.at[W1], self.at[W2], self.at[W3]) = (-after.turns, -up * after.leans, up * after.spins);
        [self.at[UH], self.at[U2]] = after.slip.map(|u| -up * u);
        self.hops.takeoff.lift = if e > 0.0 { after.lift } else { 0.0 };
        if e == 0.0 {
            lost += self.keeps_upright();
        }
        self.claims(-lost);
        if records {
            let there = self.aloft();
            let impulse = gained(&rim, [&from, &there]);
            self.records([&from, &there], self.made.path.view.over, Hit::BothRims, (impulse, lost), e == 0.0);
        }
        if stays && after.leans == 0.0 {
            // A body that stays is told from the same point as before.
            (self.at[UH], self.at[U2]) = (-self.at[UH], -2.0 * arms[0] * self.at[W3] - self.at[U2]);
            if poses(N) {
                self.at[PHI..PHI + 4].copy_from_slice(&begin[PHI..PHI + 4]);
            }
        } else if stays {
            self.flips();
        }
        self.sees_face();
        Some(after.leans != 0.0)
    }

    /// The phase after the bounces of a face that falls in a vertical plane: its two end points bounce in turn, or
    /// both at once.
    fn rattles_on_face(&mut self, e: f64) -> Next {
        let (begin, mut turns) = (self.points_come_down(), 0);
        let over = RATTLE_OVER * begin[0].min(begin[1]).abs().min(1.0);
        loop {
            let [here, there] = self.points_come_down();
            if here.min(there) > -over {
                break;
            }
            turns += 1;
            if turns > MOST_IN_TURN {
                return self.gives_up(Limit::Impacts);
            }
            if here.max(there) < -over {
                if self.up() * self.at[W2] < 0.0 {
                    self.flips();
                }
                if self.lands_flat(e, true).is_none() {
                    return Next::Ends(Ending::Landing);
                }
                continue;
            }
            if there < here {
                self.flips();
            }
            let at = self.aloft();
            let Some(struck) = self.impact(&at, e) else { return Next::Ends(Ending::Slip) };
            let after = self.struck(&at, &struck, (self.made.path.view.over, false));
            self.sets(&after);
            self.sees_face();
        }
        let [here, there] = self.points_come_down();
        if there < here {
            self.flips();
        }
        let [here, there] = self.points_come_down();
        if there.max(here) < LAST_RATTLE {
            return self.ends_rattle_on_face();
        }
        if here < over {
            self.claims(here.abs());
            return self.leaves_face();
        }
        (self.hops.takeoff.height, self.hops.takeoff.leaves) = (0.0, Some(1));
        Next::Own(Kind::Flying)
    }

    /// The phase of a body after a landing of its face: it rises on the point that has landed, or stays on the face.
    pub(crate) fn leaves_face(&mut self) -> Next {
        self.hops.takeoff = Takeoff::default();
        self.sees_face();
        if self.up() * self.at[W2] < 0.0 { self.rises_from_face() } else { self.comes_to_lie() }
    }

    /// Whether the rest of a sequence of impacts in a vertical plane, of a face almost on the table, is as small as
    /// rounding errors.
    pub(crate) fn hardly_rattles(&self, at: &Aloft) -> bool {
        let [w1, w2, w3] = at.w;
        let flat = at.angle.0.abs().max(at.lift).max(w2.abs()) < LAST_RATTLE && self.of.body.rim() > 0.0;
        flat && w1 == 0.0 && w3 == 0.0 && at.slip[1] == 0.0
    }

    /// The phase of a body on its face after a sequence of impacts, whose small rest is left out.
    pub(crate) fn ends_rattle_on_face(&mut self) -> Next {
        let (up, shape) = (self.up(), self.of.slide.law.shape);
        let [a, z] = [shape.rim.radius((0.0, up)), shape.rim.height((0.0, up))];
        let inertia = shape.i1 + z * z + a * a;
        // A body that stays after its next landing does not rock.
        let share = (inertia - 2.0 * a * a).max(0.0) / inertia;
        let [here, there] = self.points_come_down();
        let size =
            [self.at[SIN], self.at[W2], here, there].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        self.claims(LASTS * size * inertia / (a * (1.0 - share)));
        (self.at[SIN], self.at[COS]) = (0.0, up);
        self.comes_to_lie()
    }

    /// The vertical velocities of the contact point of the state, and of the opposite point of the ring.
    fn points_come_down(&self) -> [f64; 2] {
        let at = self.aloft();
        [at.lift, at.opposite(&self.of.slide.law.shape).lift]
    }

    /// The phase at the end of a rocking whose last hops are summed; `end` is the state vector there.
    fn rests_after_rocking(&mut self, end: [f64; N], error: f64) -> Next {
        self.claims(error);
        let energy = |y: &[f64; N]| self.of.slide.energy(y) + y[HEAT];
        let taken = energy(&self.at) - energy(&end);
        // The landings that are summed take what is missing.
        self.made.path.impacts.iter_mut().last().into_iter().for_each(|last| last.lost += taken);
        self.claims(-taken);
        self.at = end;
        self.lies_on_face();
        self.stands_on_face()
    }

    /// The phase of a body that lies down on its face: the centre keeps its horizontal velocity, and the energy of
    /// the remaining tilt becomes heat.
    fn comes_to_lie(&mut self) -> Next {
        let [v_h, v_2] = self.of.slide.law.centre(self.at.angle(), self.at.w(), self.at.slip());
        let before = self.of.slide.energy(&self.at);
        (self.at[UH], self.at[U2]) = (v_h, v_2 - self.of.body.rim() * self.at[W3]);
        self.lies_on_face();
        self.at[HEAT] += before - self.of.slide.energy(&self.at);
        self.stands_on_face()
    }

    /// The phase after the impact of a face that lands with all of its points at once, or in a vertical plane almost
    /// so. None if only the contact point of the state comes down.
    pub(crate) fn strikes_flat(&mut self, e: f64) -> Option<Next> {
        let (up, w) = (self.up(), self.at.w());
        self.claims(self.at[SIN]);
        (self.at[SIN], self.at[COS]) = (0.0, up);
        self.sees_face();
        if w[0] == 0.0 && w[1] == 0.0 {
            return Some(self.bounces_flat(e));
        }
        if self.up() * w[1] > 0.0 {
            self.flips();
        }
        let [here, there] = self.points_come_down();
        if here < 0.0 && there > 0.0 {
            return None;
        }
        Some(self.strikes_twice(e))
    }

    /// The phase after an impact of a face whose two end points in the plane of the motion both come down.
    fn strikes_twice(&mut self, e: f64) -> Next {
        let planar = self.at[W1] == 0.0 && self.at[W3] == 0.0 && self.at[U2] == 0.0;
        if self.up() * self.at[W2] < 0.0 {
            self.flips();
        }
        if e > 0.0 && planar {
            return self.rattles_on_face(e);
        }
        match self.lands_flat(0.0, true) {
            None => Next::Ends(Ending::Landing),
            Some(false) => self.comes_to_lie(),
            Some(true) => self.rises_from_face(),
        }
    }

    /// The phase after the impact of a face parallel to the table. Slide and spin change as on the table, with the
    /// normal impulse in place of time.
    fn bounces_flat(&mut self, e: f64) -> Next {
        let (comes, from) = (-self.hops.takeoff.lift, self.aloft());
        if comes <= 0.0 {
            return self.comes_to_lie();
        }
        let left = if e < 1.0 { 2.0 * e * comes / (1.0 - e) } else { f64::INFINITY };
        let last = left < LAST_BOUNCES;
        let Some(friction) = self.friction_of_face() else { return Next::Ends(Ending::Face) };
        let all = (1.0 + e) * comes / if last { 1.0 - e } else { 1.0 };
        let (begin, mut given) = (self.at, 0.0);
        let losses = Losses::of(Law::Drilling, self.ask.losses.coefficient(Law::Drilling));
        while given < all {
            // A slope does not pull within an impact.
            let flow = self.standing_with(&friction, (&losses, [0.0; 2]));
            let [v_h, v_2] = flow.velocity(&self.at);
            if !flow.changes() || v_h.hypot(v_2) + self.at[W3].abs() <= UNMOVED {
                break;
            }
            if flow.topples(&self.at) {
                return self.topples_in_impact(comes - given, e);
            }
            let (mut y, most) = (self.at, all - given);
            y[TIME] = 0.0;
            let steps = Steps {
                first: None,
                most: u64::MAX,
                patience: self.spent.patience,
                toil: self.toil(),
                tired: false,
            };
            let flown = flow.run(flow.place(flow.enter(&y)), steps, &[most], &mut |_| (), &mut || true);
            self.has_spent(flown.spent);
            given = if flown.halt == Halt::Time { all } else { given + flown.y[TIME] };
            let [v_h, v_2] = flow.velocity(&flown.y);
            (self.at[UH], self.at[U2], self.at[W3]) = (flown.y[UH], flown.y[U2], flown.y[W3]);
            match flown.halt {
                Halt::Time => {}
                Halt::Topples => return self.topples_in_impact(comes - given, e),
                Halt::Turned => (self.at[UH], self.at[U2], self.at[W3]) = (v_h, v_2, 0.0),
                Halt::Rests => {
                    self.rests_on_face();
                    break;
                }
                _ => return self.gives_up(Limit::Rounding),
            }
        }
        self.sees_face();
        self.hops.takeoff.lift = if last { 0.0 } else { e * comes };
        let after = self.aloft();
        let moving = |at: &Aloft| {
            self.of.slide.energy(&{
                let mut y = begin;
                (y[UH], y[U2], y[W3]) = (at.slip[0], at.slip[1], at.w[2]);
                y
            })
        };
        let lost = moving(&from) - moving(&after) + 0.5 * (comes * comes - after.lift * after.lift);
        let hit = match () {
            () if self.at[W3] == 0.0 && self.at.slip() == [0.0; 2] => Hit::Sticks,
            () if friction.strength() == 0.0 => Hit::Smooth,
            () => Hit::Slips,
        };
        let impulse = gained(&self.of.slide.law.shape.rim, [&from, &after]);
        self.claims(-lost);
        self.records([&from, &after], self.made.path.view.over, hit, (impulse, lost), last);
        if last {
            // What is left of the bounces is summed.
            self.claims(LAST_BOUNCES * left);
            return self.stands_after(left);
        }
        (self.hops.takeoff.height, self.hops.takeoff.leaves) = (0.0, Some(1));
        Next::Own(Kind::Flying)
    }

    /// The phase of a body on its face after its last bounces, which take the time `left`.
    fn stands_after(&mut self, left: f64) -> Next {
        let (begin, flow) = (self.at, self.standing(&self.friction()));
        let ([v_h, v_2], [pull_h, pull_2]) = (flow.velocity(&begin), flow.pull());
        let moved = |t: f64| {
            let mut y = begin;
            y[TIME] += t;
            (y[UH], y[U2]) = (y[UH] + t * pull_h, y[U2] + t * pull_2);
            if poses(N) {
                let (sin, cos) = begin[PHI].sin_cos();
                y[PSI] += t * begin[W3];
                (y[X], y[Y]) = (y[X] + t * (v_h * cos - v_2 * sin), y[Y] + t * (v_h * sin + v_2 * cos));
            }
            y
        };
        while let Some(t) = self.until().filter(|t| *t <= begin[TIME] + left) {
            self.writes_standing(&flow, &moved(t - begin[TIME]));
        }
        self.at = moved(left);
        self.stands_on_face()
    }

    /// The phase after an impact in which a body on its face begins to topple while its centre comes down with the
    /// velocity `comes`.
    fn topples_in_impact(&mut self, comes: f64, e: f64) -> Next {
        if comes <= 0.0 {
            return Next::Ends(Ending::Landing);
        }
        let (up, a) = (self.up(), self.of.body.rim());
        let [v_h, v_2] = [self.at[UH], self.at[U2] + a * self.at[W3]];
        let v = v_h.hypot(v_2);
        self.tells_from(v_2.atan2(v_h) + (a * up * self.at[W3] / v).asin());
        let slip = ((v - a * self.at[W3].abs()) * (v + a * self.at[W3].abs())).sqrt();
        (self.at[UH], self.at[U2]) = (-up * slip, 0.0);
        self.hops.takeoff.lift = -comes;
        let at = self.aloft();
        let Some(struck) = self.impact(&at, e) else { return Next::Ends(Ending::Landing) };
        let after = self.struck(&at, &struck, (self.made.path.view.over, false));
        self.sets(&after);
        self.leaves_impact(&after)
    }

    /// Sets w1 of a body on its face to zero, as the other points of the ring do. The centre keeps its velocity.
    /// Returns the energy lost.
    pub(crate) fn keeps_upright(&mut self) -> f64 {
        let energy = |y: &[f64; N]| self.of.slide.energy(y);
        let (before, [v_h, v_2]) =
            (energy(&self.at), self.of.slide.law.centre(self.at.angle(), self.at.w(), self.at.slip()));
        let shape = self.of.slide.law.shape;
        self.at[W1] = 0.0;
        self.at[UH] = v_h - shape.rim.height(self.at.angle()) * self.at[W2];
        self.at[U2] = v_2 - shape.rim.radius(self.at.angle()) * self.at[W3];
        self.sees_face();
        before - self.of.slide.energy(&self.at)
    }

    /// Takes the opposite point of the ring as the contact point of a body on its face.
    pub(crate) fn flips(&mut self) {
        let over = self.aloft().opposite(&self.of.slide.law.shape);
        self.sets(&over);
        if poses(N) && over.pose[0] > TAU {
            (self.at[PHI], self.at[PSI]) = (self.at[PHI] - TAU, self.at[PSI] + self.up() * TAU);
        }
        self.sees_face();
    }

    /// The phase at the end of a rocking in a vertical plane that is almost over; None if the motion continues, as
    /// that of a body that topples.
    pub(super) fn rocks_to_rest(&mut self) -> Option<Next> {
        let (rises, began) = (self.at[W2].abs(), self.at[TIME]);
        let bounces = self.ask.restitution.is_some_and(|e| e > 0.0);
        if let Some((end, error)) = self.rocks_out_flat() {
            // Hops between bounces are as short.
            let error = if bounces { end[TIME] - began } else { error };
            return Some(self.rests_after_rocking(end, error));
        }
        let up = self.up();
        let theta = if up > 0.0 { crate::motions::body::face::ALMOST_FLAT } else { core::f64::consts::PI };
        let sticks = self.at.slip() == [0.0; 2];
        let falls = up * self.rates_on_rim((theta.sin(), up), theta, &self.at, sticks)[W2];
        if falls <= 0.0 || rises > HARDLY_ROCKS {
            return None;
        }
        // The slip turns round within the next hops.
        self.claims(LASTS * rises / falls);
        Some(self.comes_to_lie())
    }

    /// The state vector at the end of a rocking that has just begun another hop, and its error; None if the rocking
    /// does not end.
    #[inline(never)]
    fn rocks_out_flat(&mut self) -> Option<([f64; N], f64)> {
        let (begin, state, takeoff) = (self.at, self.of.state, self.hops.takeoff);
        let found = self.cycle_flat(&begin);
        (self.at, self.of.state, self.hops.takeoff) = (begin, state, takeoff);
        found
    }

    fn cycle_flat(&mut self, begin: &[f64; N]) -> Option<([f64; N], f64)> {
        let up = self.up();
        for _ in 0..2 {
            let (rises, slip) = (self.at[W2].abs(), self.at[UH]);
            let sticks = self.of.slide.law.dry && slip.abs() <= self.of.slide.over()
                || matches!(self.ask.table, Table::Rolling { .. });
            let theta =
                if up > 0.0 { crate::motions::body::face::ALMOST_FLAT } else { core::f64::consts::PI };
            self.at[W2] = 0.0;
            if self.of.tilt != 0.0 && sticks && !self.sticks_on_slope(theta) {
                return None;
            }
            let rates = self.rates_on_rim((theta.sin(), up), theta, &self.at, sticks);
            let falls = up * rates[W2];
            if falls <= 0.0 {
                return None;
            }
            let lasts = 2.0 * rises / falls;
            if !sticks && self.of.slide.law.dry && slip.abs() < SLIDES_ON * self.of.slide.law.strength * lasts
            {
                return None;
            }
            self.at.iter_mut().zip(rates).for_each(|(number, rate)| *number += lasts * rate);
            self.at[TIME] += lasts;
            self.at[W2] = up * rises;
            self.of.state = State { w2: self.at[W2], ..self.of.state };
            if !self.lands_flat(0.0, false)? {
                let mut end = self.at;
                (end[SIN], end[COS], end[W1], end[W2], end[W3]) = (0.0, up, 0.0, 0.0, 0.0);
                return Some((end, lasts * lasts));
            }
        }
        let share = 1.0 - self.at[W2] / begin[W2];
        let mut end: [f64; N] = core::array::from_fn(|i| begin[i] + (self.at[i] - begin[i]) / share);
        (end[SIN], end[COS], end[W1], end[W2], end[W3]) = (0.0, up, 0.0, 0.0, 0.0);
        if poses(N) {
            (end[PHI], end[PSI]) = (begin[PHI], begin[PSI]);
        }
        let left = end[TIME] - begin[TIME];
        (share > 0.0).then_some((end, left * begin[W2].abs()))
    }
}
