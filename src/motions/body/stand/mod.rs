//! A body on its face: the choice of its phases, and the end of each.
//!
//! ```text
//! stands        slides and spins, until it rests or topples
//! topples       over the point of the ring where the slip points outwards: one rim, theta = c t^2/2
//! rises         by a kick, w2 < 0, on the point from which the state is told: theta = |w2| t
//! rests         while friction and the ring hold it; on a slope it slides down, or tips over the lowest point of its ring
//! falls         in a plane: it stays, or rocks over the opposite point; else what turns is lost, and it stays
//! ```
//! A face lands (theta = 0) only in a motion in a vertical plane, or by losses: any rotation about the vertical keeps
//! theta from 0. `up` is cos(theta): 1, or -1 on the other face of a disk.
//!
//! Error: the tolerance of the steps, and for a body that rises the square of the short time after which its motion
//! on the rim is computed.

pub(crate) mod flow;
mod rocks;

use super::body_walk::BodyWalk;
use super::face::ALMOST_FLAT;
use super::own::Own;
use super::strike::ROCKED;
use super::write;
use crate::error::Error;
use crate::laws::contact::Table;
use crate::laws::contact::face::FaceFriction;
use crate::laws::contact::slip::Friction;
use crate::laws::contact::standstill::Standstill;
use crate::laws::loss::{Law, Losses};
use crate::laws::state::State;
use crate::methods::flow::{Flow, Steps};
use crate::motions::walk::hops::Takeoff;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, Halt, PHI, PSI, SIN, TIME, U2, UH, W1, W2, W3, X, Y, lost, poses, pull,
};
use crate::motions::walk::{Next, Pause, Phases, WalkStep, ending};
use crate::motions::{Ending, Kind};
use crate::numbers::larger_or_nan;
use core::f64::consts::{PI, TAU};
use flow::StandingFlow;

/// A point of the ring of contact counts as at rest if its slip is below this share of the velocity of the centre.
const SLIPS_OFF: f64 = 1e-4;
/// A body on its face that moves more slowly than this counts as at rest.
const UNMOVED: f64 = 1e-13;
/// The inclination from which the motion of a body that rises from its face is computed as that on its rim. It is
/// larger than that at which a face counts as landed.
const RISEN: f64 = 4e-12;
/// A spinning body whose theta grows more slowly than this does not rise from its face; one that falls more slowly
/// than this does not rock.
const HARDLY_RISES: f64 = 1e-6;
/// Relative accuracy with which the beginning of toppling on a viscous film is found: the body topples from lam = mu
/// z/a = 1 on.
const ONSET: f64 = 1e-10;
/// Where friction just holds a body on a slope and the body just does not topple, both to this accuracy, a slow slide
/// lasts for ever.
const JUST_HOLDS: f64 = 1e-9;
/// A face that lands within this time is computed with constant rates.
const SOON_DOWN: f64 = 1e-5;

/// What a body at rest on its face does next.
enum FromRest {
    Stays,
    Slides,
    Tips,
    /// No motion is consistent: the centre of pressure would leave the ring, and rolling resistance or friction does
    /// not let the body rise.
    Jams,
}

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// Whether the current state is that of a body on its face.
    pub(crate) fn is_on_face(&self) -> bool {
        self.at[SIN].abs() <= ALMOST_FLAT && self.of.body.rim() > 0.0
    }

    /// cos(theta) of a body on its face: 1, or -1 on the other face.
    pub(crate) fn up(&self) -> f64 {
        self.at[COS].signum()
    }

    /// Sets the current state to that of a body on its face, which keeps only slide and spin.
    fn lies_on_face(&mut self) {
        let up = self.up();
        (self.at[SIN], self.at[COS], self.at[W1], self.at[W2]) = (0.0, up, 0.0, 0.0);
        self.hops.takeoff = Takeoff::default();
        self.sees_face();
    }

    /// Sets the state with theta = 0 or pi for a body on its face.
    fn sees_face(&mut self) {
        let theta = if self.at[COS] > 0.0 { 0.0 } else { PI };
        self.of.state = State { theta, w1: self.at[W1], w2: self.at[W2], w3: self.at[W3] };
    }

    /// The friction law of a body on its face; None for a table on which the body only rolls, and under user-defined
    /// laws.
    fn friction_of_face(&self) -> Option<Friction> {
        match self.ask.table {
            _ if self.of.own.varies() || self.of.own.has_couple() => None,
            Table::Rubs(friction) => Some(friction),
            Table::Smooth => Some(Friction::coulomb(0.0)),
            Table::Rolling { .. } => None,
        }
    }

    /// The equations of a body on its face, from the current state on.
    fn standing(&self, friction: &Friction) -> StandingFlow {
        self.standing_with(friction, (&self.ask.losses, pull(self.of.tilt, &self.at)))
    }

    /// The equations of a body on its face, from the current state on, under these losses and this component of
    /// gravity along the table.
    fn standing_with(&self, friction: &Friction, beside: (&Losses, [f64; 2])) -> StandingFlow {
        let (shape, angle) = (self.of.slide.law.shape, self.at.angle());
        let lam = match friction {
            Friction::Coulomb { mu, .. } => mu * shape.rim.height(angle) / shape.rim.radius(angle),
            Friction::Viscous { .. } => 0.0,
        };
        // The fold of a tall face takes some work.
        let known = self.of.face.get().filter(|(of, _)| *of == lam);
        let face = known.map_or_else(|| FaceFriction::new(self.ask.face, lam), |(_, face)| face);
        self.of.face.set(Some((lam, face)));
        StandingFlow::new((shape, face), friction, beside, &self.at, self.of.slide.tol)
    }

    /// The first phase of a motion that begins on a face: the body stays on it, or rises if the start has w2 for it.
    pub(super) fn starts_on_face(&mut self) -> Result<Next, Error> {
        let (up, at) = (self.up(), self.of.state);
        (self.at[SIN], self.at[COS]) = (0.0, up);
        self.sees_face();
        if self.of.turning != 0.0 {
            let expected = "0 for a body on its face, since its table must not turn";
            return Err(Error::OutOfRange { name: "turning", value: self.ask.turning, expected });
        }
        let next = if up * at.w2 < 0.0 { self.rises_from_face() } else { self.stands_on_face() };
        match next {
            Next::Ends(Ending::Painleve) => Err(Phases::no_unique_force(self)),
            Next::Ends(Ending::Face) => {
                let expected = "a law of friction, and no user-defined law, for a body that moves on its face: it cannot roll";
                Err(Error::OutOfRange { name: "theta", value: at.theta, expected })
            }
            next => Ok(next),
        }
    }

    /// Advances the motion by the time `left` in which the face, which is almost on the table, lands.
    pub(super) fn falls_the_rest(&mut self, left: f64, sticks: bool) {
        if self.of.body.rim() > 0.0 && self.at[W1] == 0.0 && left < SOON_DOWN {
            let up = self.up();
            let theta = if up > 0.0 { ALMOST_FLAT } else { PI };
            let rates = self.rates_on_rim((theta.sin(), up), theta, &self.at, sticks);
            self.at.iter_mut().zip(rates).for_each(|(number, rate)| *number += left * rate);
        }
        self.at[TIME] += left;
    }

    /// The phase of a body whose face has just landed.
    #[inline(never)]
    pub(super) fn settles_on_face(&mut self) -> Next {
        let (up, w) = (self.up(), self.at.w());
        (self.at[SIN], self.at[COS]) = (0.0, up);
        self.sees_face();
        let falls = up * w[1];
        if falls > 0.0 && (self.of.planar || w[0] == 0.0 && w[2] == 0.0 && self.at[U2] == 0.0) {
            (self.at[W1], self.at[W3], self.at[U2]) = (0.0, 0.0, 0.0);
            return self.falls_on_face(falls);
        }
        let shape = self.of.slide.law.shape;
        if falls > HARDLY_RISES && self.at[W1].abs() < falls {
            return self.falls_on_face(falls);
        }
        let before = self.of.slide.energy(&self.at);
        // The centre keeps its velocity, and the body its spin about the vertical.
        let [v_h, v_2] = self.of.slide.law.centre(self.at.angle(), w, self.at.slip());
        (self.at[UH], self.at[U2]) = (v_h, v_2 - shape.rim.radius(self.at.angle()) * w[2]);
        self.lies_on_face();
        self.at[HEAT] += before - self.of.slide.energy(&self.at);
        self.stands_on_face()
    }

    /// The phase of a body on its face.
    pub(super) fn stands_on_face(&mut self) -> Next {
        self.sees_face();
        let friction = self.friction_of_face();
        let spins = self.of.slide.law.shape.rim.radius(self.at.angle()) * self.at[W3];
        let moves = self.at[UH].hypot(self.at[U2] + spins) + spins.abs();
        if moves <= UNMOVED || friction.is_none() || moves <= HARDLY_RISES && self.creeps() {
            self.claims(moves);
            // A face cannot roll.
            if moves > HARDLY_RISES {
                return Next::Ends(Ending::Face);
            }
            self.rests_on_face();
            match self.tips() {
                FromRest::Stays => return Next::Ends(Ending::Stops),
                FromRest::Tips => return self.tips_over(),
                FromRest::Jams => return Next::Ends(Ending::Painleve),
                FromRest::Slides => {}
            }
        }
        let Some(friction) = friction else { return Next::Ends(Ending::Face) };
        self.at = self.standing(&friction).straightened(&self.at);
        let flow = self.standing(&friction);
        if flow.topples(&self.at) {
            return self.topples(&flow, &friction);
        }
        self.of.standing = Some(Box::new(flow));
        Next::Own(Kind::OnItsFace)
    }

    /// What a body at rest on its face does next: it stays or slides if the centre of pressure is within the ring,
    /// else it tips over the lowest point of the ring. It turns about this point if static friction suffices, else it
    /// slips there.
    fn tips(&self) -> FromRest {
        let (slope, shape) = (self.of.tilt.abs(), self.of.slide.law.shape);
        let [a, z] = [shape.rim.radius(self.at.angle()), shape.rim.height(self.at.angle())];
        let [rubs, holds] = match self.ask.table {
            _ if slope == 0.0 => return FromRest::Stays,
            Table::Rolling { mu } => [mu; 2],
            Table::Rubs(Friction::Coulomb { mu, fixed, .. }) => [mu, fixed],
            Table::Rubs(Friction::Viscous { .. }) | Table::Smooth => [0.0; 2],
        };
        let arm = a + self.resists_tipping();
        if slope <= holds {
            return if slope * z <= arm { FromRest::Stays } else { FromRest::Tips };
        }
        if rubs * z <= a {
            return FromRest::Slides;
        }
        let turns = (slope * z - arm) / (shape.i1 + z * z + a * arm);
        let sticks = turns > 0.0 && slope - z * turns <= holds * (1.0 + a * turns);
        // Friction may press a point that slips ever harder into the table.
        let slips = rubs * z > arm && (rubs * z - arm) * a < shape.i1;
        if sticks || slips { FromRest::Tips } else { FromRest::Jams }
    }

    /// Whether friction just holds the body on a slope, and the body just does not topple. A small spin then lets it
    /// slide for ever, more slowly than its rim turns; this speed is the error if the body is taken to rest.
    fn creeps(&self) -> bool {
        let Table::Rubs(Friction::Coulomb { mu, fixed, .. }) = self.ask.table else { return false };
        let (slope, rim) = (self.of.tilt.abs(), self.of.slide.law.shape.rim);
        let needs = mu * rim.height(self.at.angle()) - rim.radius(self.at.angle());
        mu > 0.0 && slope <= fixed && (slope - mu).abs() <= JUST_HOLDS * mu && needs.abs() <= JUST_HOLDS
    }

    /// The arm of rolling resistance (a length), which acts at the point of the ring over which a body tips.
    fn resists_tipping(&self) -> f64 {
        self.ask.losses.coefficient(Law::RollingResistance)
    }

    /// The phase of a body that a slope tips over the lowest point of its ring from rest.
    fn tips_over(&mut self) -> Next {
        let [pull_h, pull_2] = pull(self.of.tilt, &self.at);
        self.tells_from(pull_2.atan2(pull_h));
        self.of.planar = true;
        self.rises_from_face()
    }

    fn rests_on_face(&mut self) {
        (self.at[W3], self.at[UH], self.at[U2]) = (0.0, 0.0, 0.0);
        self.sees_face();
    }

    /// Computes a phase of a body on its face, or begins its integration.
    #[inline(never)]
    pub(crate) fn stands(&mut self) -> Option<WalkStep<N>> {
        let flow = self.of.standing.as_deref()?;
        if flow.changes() {
            return Some(WalkStep::Flows(flow.enter(&self.at)));
        }
        let (flow, begin) = (*flow, self.at);
        let [v_h, v_2] = flow.velocity(&begin);
        while let Some(t) = self.until() {
            let (mut y, lasts) = (begin, t - begin[TIME]);
            y[TIME] = t;
            if poses(N) {
                let (sin, cos) = begin[PHI].sin_cos();
                y[PSI] += lasts * begin[W3];
                let [[pull_h, pull_2], half] = [flow.pull(), [0.5 * lasts * lasts; 2]];
                let moved = [lasts * v_h + half[0] * pull_h, lasts * v_2 + half[1] * pull_2];
                y[X] += moved[0] * cos - moved[1] * sin;
                y[Y] += moved[0] * sin + moved[1] * cos;
                (y[UH], y[U2]) = (y[UH] + lasts * pull_h, y[U2] + lasts * pull_2);
            }
            self.writes_standing(&flow, &y);
        }
        self.of.standing = None;
        None
    }

    /// Integrates a phase of a body on its face.
    #[inline(never)]
    pub(crate) fn stands_on(
        &mut self,
        y: [f64; N],
        steps: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        let Some(flow) = self.of.standing.as_deref().copied() else { return Ok(Pause::No) };
        let (ask, first, made) = (self.ask, self.made.motion.states.len(), &mut self.made);
        let mut write = |y: &[f64; N]| made.push(flow.row(&ask, y));
        let flown = flow.run(flow.place(y), steps, &self.since[first..], &mut write, go_on);
        self.has_spent(flown.spent);
        self.claims_time_error(flown.halt, flown.steep, &flown.y);
        if flown.halt == Halt::Pause {
            self.at = flown.y;
            let Some(friction) = self.friction_of_face() else { return Ok(Pause::No) };
            let flow = self.standing(&friction);
            self.of.standing = Some(Box::new(flow));
            return Ok(Pause::Here(flow.enter(&flown.y), Some(flown.step)));
        }
        self.stops_standing(flown.y, flown.halt);
        Ok(Pause::No)
    }

    /// Ends a phase of a body on its face at the state vector `y`, and chooses the next phase.
    #[inline(never)]
    pub(crate) fn stops_standing(&mut self, y: [f64; N], halt: Halt) {
        let Some(flow) = self.of.standing.take() else { return };
        self.at = y;
        self.sees_face();
        self.made.path.slipping += y[TIME] - self.began;
        let next = match halt {
            Halt::Time | Halt::Pause => return,
            Halt::Rests => {
                self.at[TIME] += flow.left(&y);
                self.rests_on_face();
                self.stands_on_face()
            }
            Halt::Turned => {
                let [v_h, v_2] = flow.velocity(&y);
                (self.at[W3], self.at[UH], self.at[U2]) = (0.0, v_h, v_2);
                self.stands_on_face()
            }
            Halt::Topples => match self.friction_of_face() {
                Some(friction) => self.topples(&flow, &friction),
                None => Next::Ends(Ending::Face),
            },
            halt => Next::Ends(ending(halt)),
        };
        self.continues_with(next);
    }

    /// The phase of a body that topples over the point of its ring at which the slip points outwards.
    fn topples(&mut self, flow: &StandingFlow, friction: &Friction) -> Next {
        let (shape, up) = (self.of.slide.law.shape, self.up());
        let (a, z) = (shape.rim.radius(self.at.angle()), shape.rim.height(self.at.angle()));
        if let Some(there) = flow.way_to_point(&self.at) {
            let (begin, end) = (self.at, there(1.0));
            let whole = |y: &[f64; N]| self.of.slide.energy(y) + y[HEAT] + lost(y);
            let [v_h, v_2] = flow.velocity(&end);
            let off = (v_h.hypot(v_2) - a * end[W3].abs()).abs() + (whole(&end) - whole(&begin)).abs();
            self.claims(off);
            while let Some(t) = self.until().filter(|t| *t < end[TIME]) {
                self.writes_standing(flow, &there((t - begin[TIME]) / (end[TIME] - begin[TIME])));
            }
            self.arrives(end);
            return Next::Ends(Ending::Painleve);
        }
        let ([v_h, v_2], w) = (flow.velocity(&self.at), up * self.at[W3]);
        let v = v_h.hypot(v_2);
        let square = (v - a * w.abs()) * (v + a * w.abs());
        // A spin as fast as the slide leaves no slip at this point, which stays.
        if square <= (SLIPS_OFF * v).powi(2) {
            self.claims((v - a * w.abs()).abs());
            return Next::Ends(Ending::Painleve);
        }
        let slip = square.sqrt();
        let (mu, thick) = match friction {
            Friction::Coulomb { mu, .. } => (*mu, 0.0),
            Friction::Viscous { c } => (c * slip, *c),
        };
        let lam = mu * z / a;
        // In a film that a slope makes drag more and more, the body topples from lam = 1 on.
        let lam = if thick > 0.0 && (lam - 1.0).abs() <= ONSET { 1.0 } else { lam };
        // Rolling resistance may keep the body from rising.
        let rises = (lam - 1.0) * a >= self.resists_tipping() && mu * a * z < shape.i1 + a * a;
        if !rises {
            return Next::Ends(Ending::Painleve);
        }
        let normal = 1.0 / (1.0 - (lam - 1.0) * a * a / shape.i1);
        let grows = (lam - 1.0) * a * normal / shape.i1;
        self.of.planar |= flow.is_straight(&self.at);
        self.tells_from(v_2.atan2(v_h) + (a * w / v).asin());
        (self.at[UH], self.at[U2]) = (-up * slip, 0.0);
        // A slope turns the slip.
        let [pull_h, pull_2] = pull(self.of.tilt, &self.at);
        let turns = -up * pull_2 / slip;
        let free = (w * (shape.i3 / shape.i1) * (lam - 1.0) + lam * turns) / (3.0 * lam - 2.0);
        let nu = if self.holds_contour() { w } else { free };
        self.sees_face();
        self.begins_phase(Kind::Slipping);
        self.resumes_phase();
        // The slip falls as friction and the lean slow it, and as e_h turns away from the velocity of the centre.
        let falls = mu * normal + z * grows + nu * a * w + up * pull_h;
        // theta'' grows with the drag of a film, and that drag with the slip: a third power of the time.
        let film = if falls < 0.0 { thick } else { 0.0 };
        let faster = if film > 0.0 { -(z * film * falls / shape.i1) } else { 0.0 };
        let bends = film * (falls - a * faster * slip) - if film > 0.0 { z * faster } else { 0.0 };
        // A face that just rests has no direction in which it turns.
        let risen = 1.0 / larger_or_nan((0.5 * grows / RISEN).sqrt(), (faster / (6.0 * RISEN)).cbrt());
        if !risen.is_finite() {
            return Next::Ends(Ending::Painleve);
        }
        // A slow slip ends before the body has risen, which comes down again.
        let stops = slip <= falls * risen;
        if stops && v <= HARDLY_RISES {
            self.claims(v);
            self.comes_to_nothing();
            return self.stands_on_face();
        }
        let lasts = if stops { slip / falls } else { risen };
        // What turns does so at constant rates here, as the slip does without a film.
        let third = if film > 0.0 && self.of.planar { lasts } else { 1.0 };
        let turned = lasts * (turns.abs() + nu.abs());
        let size = if stops { slip } else { slip.max(1.0) };
        self.claims((lasts * lasts + size * turned * turned) * third);
        let begin = self.at;
        let [forth, aside] = flow.velocity(&begin);
        self.rises_as(lasts, |t| {
            let mut y = begin;
            y[SIN] = (0.5 * grows + faster * t / 6.0) * t * t;
            (y[W1], y[W2]) = (nu * y[SIN], -up * (grows + 0.5 * faster * t) * t);
            let slows = (falls - 0.5 * bends * t) * t;
            (y[UH], y[U2]) = (up * (slows - slip), up * slip * (nu - turns) * t);
            y[HEAT] += mu * normal * t * (slip - 0.5 * falls * t);
            y[HEAT] += 0.5 * film * slip * (a * faster * slip - falls) * t * t;
            if poses(N) {
                let moved = [
                    forth * t + 0.5 * (up * mu * normal + pull_h) * t * t,
                    (aside - up * a * nu) * t + 0.5 * pull_2 * t * t,
                ];
                let (sin, cos) = begin[PHI].sin_cos();
                (y[PHI], y[PSI]) = (y[PHI] + nu * t, y[PSI] + (begin[W3] - up * nu) * t);
                (y[X], y[Y]) =
                    (y[X] + moved[0] * cos - moved[1] * sin, y[Y] + moved[0] * sin + moved[1] * cos);
            }
            y
        });
        if !stops {
            return Next::Slips;
        }
        (self.at[UH], self.at[U2]) = (0.0, 0.0);
        self.settles_on_face()
    }

    /// Ends a slow motion close to a face: the body lies on the face at rest, and the remaining energy becomes heat.
    fn comes_to_nothing(&mut self) {
        let before = self.of.slide.energy(&self.at);
        self.lies_on_face();
        self.rests_on_face();
        self.at[HEAT] += before - self.of.slide.energy(&self.at);
    }

    /// The phase of a body that an initial w2, or a slope, lets rise on the contact point of its state.
    fn rises_from_face(&mut self) -> Next {
        let (up, rises) = (self.up(), self.at[W2].abs());
        let planar = self.at[W3] == 0.0 && self.at[U2] == 0.0;
        if rises < HARDLY_RISES && !planar {
            self.claims(rises);
            return self.settles_on_face();
        }
        if rises < ROCKED
            && planar
            && let Some(next) = self.rocks_to_rest()
        {
            return next;
        }
        self.of.state.theta = if up > 0.0 { ALMOST_FLAT } else { PI };
        let [u, v] = self.at.slip();
        // Dry losses act against a rise from rest as soon as it begins.
        let rising = if rises > 0.0 { rises } else { ALMOST_FLAT };
        let mut sticks = matches!(self.ask.table, Table::Rolling { .. });
        if self.ask.table.rubs() && self.of.slide.law.dry && u.hypot(v) <= self.of.slide.over() {
            self.stop_slip();
            self.of.state.w2 = -up * rising;
            match Phases::rests(self) {
                Standstill::Sticks => sticks = true,
                Standstill::Slips { alpha, growth } => {
                    // The slip that begins is that after a moment.
                    let (sin, cos) = alpha.sin_cos();
                    let speed = growth * if rises > 0.0 { RISEN / rises } else { ALMOST_FLAT };
                    (self.at[UH], self.at[U2]) = (speed * cos, speed * sin);
                }
                Standstill::LiftsOff => return Next::Ends(Ending::LiftOff),
                Standstill::Undefined => return Next::Ends(Ending::Painleve),
            }
        }
        let begin = self.at;
        // w1 = nu sin theta, with the nu with which w1 follows.
        let follows = |nu: f64| {
            let (mut y, theta) = (begin, self.of.state.theta);
            (y[W1], y[W2]) = (nu * theta.sin(), -up * rising);
            let rates = self.rates_on_rim((theta.sin(), up), theta, &y, sticks);
            (rates[W1] - nu * rises, rates)
        };
        let (here, there) = (follows(0.0).0, follows(1.0).0);
        let nu = match () {
            () if self.holds_contour() => up * begin[W3],
            () if rises == 0.0 => 0.0,
            () => here / (here - there),
        };
        let rates = follows(nu).1;
        let lifts = -up * rates[W2];
        if rises == 0.0 && lifts <= 0.0 {
            return Next::Ends(Ending::Painleve);
        }
        let lasts = if rises > 0.0 { RISEN / rises } else { (2.0 * RISEN / lifts).sqrt() };
        self.claims(if rises > 0.0 { 0.0 } else { lasts * lasts });
        self.sees_face();
        self.begins_phase(if sticks { Kind::Rolling } else { Kind::Slipping });
        self.resumes_phase();
        let rho = self.of.slide.law.shape.rim.rho;
        self.rises_as(lasts, |t| {
            let mut y: [f64; N] = core::array::from_fn(|i| begin[i] + t * rates[i]);
            y[SIN] = rises * t + 0.5 * up * -rates[W2] * t * t;
            (y[COS], y[W1], y[TIME]) = (up, nu * y[SIN], begin[TIME]);
            if rises == 0.0 && poses(N) {
                let out = 0.5 * t * t * (rates[UH] + rho * rates[W2]);
                let (sin, cos) = begin[PHI].sin_cos();
                (y[X], y[Y]) = (y[X] + out * cos, y[Y] + out * sin);
                y[HEAT] = begin[HEAT] + 0.5 * t * t * rates[HEAT] / ALMOST_FLAT;
            }
            y
        });
        self.touches_down()
    }

    /// Whether a loss along the contour acts: its couple grows without bound as a face approaches the table, and
    /// stops the contact point along the rim at once.
    fn holds_contour(&self) -> bool {
        self.ask.losses.iter().any(|(law, _)| law.is_along_contour())
    }

    /// Advances a body that rises from its face by the short time `lasts`, after which its motion on the rim is
    /// computed; `risen` returns the state vector after a time.
    fn rises_as(&mut self, lasts: f64, risen: impl Fn(f64) -> [f64; N]) {
        let began = self.at[TIME];
        let at = |t: f64| {
            let mut y = risen(t);
            // Laws of one rim know no face that lies.
            y[SIN] = y[SIN].max(ALMOST_FLAT);
            (y[COS], y[TIME]) = (y[COS].signum() * ((1.0 - y[SIN]) * (1.0 + y[SIN])).sqrt(), began + t);
            y
        };
        while let Some(t) = self.until().filter(|t| *t < began + lasts) {
            self.at = at(t - began);
            self.of.state = write::state(&self.at);
            Phases::write_here(self);
        }
        self.at = at(lasts);
        self.of.state = write::state(&self.at);
    }

    /// Takes the point of the ring in this direction, an angle from e_h, as the contact point of a body on its face.
    /// Slide and spin remain.
    fn tells_from(&mut self, direction: f64) {
        self.turns_by(direction + if self.up() > 0.0 { PI } else { 0.0 });
    }

    /// Adds an angle to phi, and subtracts it from psi, so that the body does not move.
    fn turns_by(&mut self, turn: f64) {
        let up = self.up();
        let turn = turn - (turn / TAU).round() * TAU;
        if !poses(N) {
            return;
        }
        let lever = self.of.slide.law.shape.rim.lever(self.at.angle());
        let [from, to] = [self.at[PHI], self.at[PHI] + turn];
        self.at[X] += lever * (to.cos() - from.cos());
        self.at[Y] += lever * (to.sin() - from.sin());
        (self.at[PHI], self.at[PSI]) = (to, self.at[PSI] - up * turn);
    }

    /// Writes the current state of a body on its face to the outputs.
    pub(super) fn writes_on_face(&mut self) {
        let flow = self.standing(&self.friction());
        self.writes_standing(&flow, &{ self.at });
    }

    /// Writes the state vector `y` of a body on its face to the outputs.
    fn writes_standing(&mut self, flow: &StandingFlow, y: &[f64; N]) {
        self.made.push(flow.row(&self.ask, y));
    }
}
