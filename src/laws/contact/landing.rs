//! The landing of another circle of a body, and the motion of a body that lies on two.
//!
//! ```text
//! here the circle that carries, there the one that lands; Z, g, A, L, D, w_z as in contact::lying
//!   u_2,there = u_2 - D w_z,   lift_there = lift + D w2        lift: the vertical velocity of a circle
//! lying, w2 = 0      there rises where  (K - Z Fh)/g > 1,   Fh = -mu u_h/|u|, or of a circle at rest -Om v_2 within +-mu
//! landing            impulses P >= 0 and Q with |Q| <= mu P at each;   Q_h, Q_2 the sums over both
//!   both stay        P + P' = -(lift + g w2),   D P' = g (P + P') - I1 w2 + Z Q_h,               w2 -> 0
//!   it hands over    P = 0,   P' = -(I1 lift_there + g' Z Q_h)/(I1 + g'^2),   w2 -> w2 - (g' P' + Z Q_h)/I1
//!   u_h -> u_h + Q_h - Z (change of w2),   w1 -> w1 + sum L Q_2/I1,   w3 -> w3 - sum A Q_2/I3
//! bounce of both rims        then P grows by e P, and Q again opposes the slip that remains, with |Q| <= mu e P
//! two equal rims, seen from the other one   (w1, w2, w3, u_h, u_2) -> (w1, -w2, -w3, -u_h, 2 ell w1 - u_2), phi + pi, -psi
//! ```
//! The impulses are those of Newton's and Euler's equations about the centre of mass. Friction is Coulomb's in the form
//! of Moreau (Unilateral contact and dry friction in finite freedom dynamics, 1988): the impulse at a rim opposes the
//! slip after the impact, Q = -mu P u/|u|, or it is just large enough to stop the slip. Therefore no landing gains
//! energy. The law is exact where the slip keeps its direction during the impact or stops and sticks; where the slip
//! turns it is a model. If both rims come down at once and bounce, the table gives back the share e of the normal
//! impulse of compression at each rim (Poisson). For these normal impulses Moreau's friction leaves the least energy,
//! not more than if e Q were given back, which would leave at most e^2 of the energy taken: no bounce of both rims
//! gains energy. One rim bounces as in `contact::impact`. Without friction both stay if -g g' >= I1; with friction if
//! -g g' - g Z Q'_h/P' >= I1. With g g' > 0 the body always continues on the circle that lands.
//!
//! Under a coefficient that depends on the speed, mu is that of the slip after the impact: this too takes energy, since
//! the impulse opposes that slip.
//!
//! Error: 1e-12 of the largest velocity; a test of `throw` compares with the three-dimensional model.
//!
//! ```
//! use spincyl::contact::landing::{Outcome, land};
//! use spincyl::{Body, Slip, State};
//!
//! // A can that falls on its side, on a table without friction, stays there.
//! let can = Body::solid(2.0)?;
//! let falls = State { theta: std::f64::consts::FRAC_PI_2, w1: 0.0, w2: -0.1, w3: 0.0 };
//! let landed = land(&can, &falls, Slip::default(), 0.0)?;
//! assert_eq!(landed.outcome, Outcome::Lies);
//! assert!(landed.state.w2.abs() < 1e-15 && landed.lost > 0.0);
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::lying::Lying;
use super::slip::Friction;
use crate::error::{Error, within};
use crate::laws::body::{Body, Border, CircleDown};
use crate::laws::custom::SpeedLaw;
use crate::laws::loss::Losses;
use crate::laws::state::{Slip, State, drilling_of};
use crate::numbers::larger_or_nan;
use core::f64::consts::{FRAC_PI_2, PI};

/// The motion of a body after its other rim has landed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// The body lies on both rims, each of which slips or is at rest.
    Lies,
    /// The body rises at once on the rim on which it moved before.
    Rises,
    /// The body continues on the other rim, to which state and slip refer.
    Changes,
}

/// The result of a landing.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Landed {
    /// The kind of motion that follows.
    pub outcome: Outcome,
    /// The state, which refers to the rim on which the body continues; if the body lies on both, to the previous rim.
    pub state: State,
    /// The slip of the rim to which `state` refers, in sqrt(g R).
    pub slip: Slip,
    /// Energy lost in the landing, in M g R.
    pub lost: f64,
}

/// Returns an error unless the body has two equal rims to lie on: ell > 0 and theta_end = pi/2.
pub(crate) fn two_rims(body: &Body) -> Result<(), Error> {
    within("ell", body.ell(), (f64::MIN_POSITIVE, f64::MAX), "ell > 0, for a body that can lie on two rims")?;
    equal_rims(body)?;
    within(
        "theta_end",
        body.theta_end(),
        (FRAC_PI_2, FRAC_PI_2),
        "pi/2, for a body that can lie on two rims",
    )?;
    Ok(())
}

/// Returns an error for a body of several circles that are not two equal rims.
pub(crate) fn equal_rims(body: &Body) -> Result<(), Error> {
    let (count, expected) = (body.circles().len() as f64, "one circle, or two equal rims");
    if body.has_row() { Err(Error::OutOfRange { name: "circles", value: count, expected }) } else { Ok(()) }
}

/// The launch number with friction, (I3 w1 w3 - Fh)/ell, of a body that lies on its side, at theta = pi/2 and w2 = 0;
/// above 1 the body rises on its lower rim.
///
/// Fh is the component of the friction along e_h, at the lower rim, if this rim alone carries the body. At a rim at
/// rest Fh is the friction that rolling needs, at most `mu`, which then is the static coefficient.
pub fn launch(body: &Body, y: &State, slip: Slip, mu: f64) -> f64 {
    launch_on(body, 0, y, slip.pair(), mu)
}

/// The launch number (K - Z Fh)/g of a body that lies on two circles, if `circle` alone carries the body; above 1 the
/// other circle rises. `slip` is the slip of `circle`.
fn launch_on(body: &Body, circle: usize, y: &State, slip: [f64; 2], mu: f64) -> f64 {
    let Border { angle: (s, c), height, circles, .. } = body.border();
    let (on, turns, speed) = (circles[circle], y.w1 / s, slip[0].hypot(slip[1]));
    let along = if speed > 0.0 {
        -mu * (slip[0] / speed)
    } else {
        let demand = turns * (on.depth * y.w1 - on.radius * y.w3);
        demand.max(-mu).min(mu)
    };
    (body.i3() * y.w1 * y.w3 - body.i1() * c * turns * y.w1 - height * along) / on.lever
}

/// Whether a body at theta = pi/2 and w2 = 0 rises on its lower rim; otherwise the body stays on its side.
///
/// The criterion holds for every mu below (I1 + ell^2)/ell, where the contact force is unique.
pub fn rises(body: &Body, y: &State, slip: Slip, mu: f64) -> bool {
    launch(body, y, slip, mu) > 1.0
}

/// The normal forces N_low and N_up on a body that lies on its side while both rims slip; a force is negative where
/// that end rises.
///
/// With friction, the forces are NaN where a rim does not slip, since its friction is not known from the state alone.
pub fn normals(body: &Body, y: &State, slip: Slip, mu: f64) -> [f64; 2] {
    let lying = Lying::on(body, &Friction::coulomb(mu), &Losses::NONE);
    lying.slipping([y.w1, y.w3, slip.u_h, slip.u_2]).force.map(|[normal, ..]| normal)
}

/// The plastic landing of the other rim at theta = pi/2, with w2 <= 0, on a table with the friction `mu`.
///
/// With w2 = 0 there is no impact, and only the motion that follows is determined. Friction may allow two consistent
/// outcomes or none, and in 1e-5 of all cases the search finds none.
///
/// # Errors
/// `OutOfRange` for a body without two equal rims, an inclination other than theta_end, a w2 outside [-1e100, 0],
/// another speed beyond 1e100, and a `mu` outside [0, 1e100]; `Landing` for two consistent outcomes, or none.
pub fn land(body: &Body, y: &State, slip: Slip, mu: f64) -> Result<Landed, Error> {
    two_rims(body)?;
    within("mu", mu, (0.0, 1e100), "0 <= mu <= 1e100")?;
    land_at(body, y, (slip.pair(), 0.0), &Friction::coulomb(mu), &())
}

/// The plastic landing with any law of friction, also for a body whose lower rim comes down at the same time, at the
/// velocity `lift` <= 0. The impulse of a viscous film is c P u, with the slip u after the impact, as for dry friction.
/// If `own` makes the coefficient depend on the speed, it is that of the slip after the impact.
pub(crate) fn land_at(
    body: &Body,
    y: &State,
    (slip, lift): ([f64; 2], f64),
    friction: &Friction,
    own: &impl SpeedLaw,
) -> Result<Landed, Error> {
    let most = 1e100;
    within(
        "theta",
        y.theta,
        (body.theta_end(), body.theta_end()),
        "theta_end of the body, where the other rim lands",
    )?;
    within("w2", y.w2, (-most, 0.0), "-1e100 <= w2 <= 0, since the other rim has to come down")?;
    for (name, x) in [("w1", y.w1), ("w3", y.w3), ("u_h", slip[0]), ("u_2", slip[1])] {
        within(name, x, (-most, most), "-1e100 to 1e100")?;
    }
    let landing = Landing { body, border: body.border(), y: *y, slip, lift, friction, own };
    let before = energy(&landing.border, body, y, slip, lift);
    let end = |outcome, Pushed { y, slips: [slip, there], lift, .. }: Pushed| {
        let lost = before - energy(&landing.border, body, &y, slip, lift);
        let (state, slip) = if outcome == Outcome::Changes { seen_from_next(&y, there) } else { (y, slip) };
        Landed { outcome, state, slip: slip.into(), lost }
    };
    let mu = |[u, v]: [f64; 2]| coefficient(own, friction.strength(), || u.hypot(v));
    Ok(match landing.compressed()? {
        Compressed { here: true, there: true, end: pushed } => {
            let [slip, other] = pushed.slips;
            if launch_on(body, 0, &pushed.y, slip, mu(slip)) > 1.0 {
                end(Outcome::Rises, pushed)
            } else if launch_on(body, 1, &pushed.y, other, mu(other)) > 1.0 {
                end(Outcome::Changes, pushed)
            } else {
                end(Outcome::Lies, pushed)
            }
        }
        Compressed { here: true, end: pushed, .. } => end(Outcome::Rises, pushed),
        Compressed { end: pushed, .. } => end(Outcome::Changes, pushed),
    })
}

/// A landing of both rims at once, which bounce with the restitution `e`: the state, the slip and the vertical velocity
/// of the lower rim, which comes down at `lift` < 0, and the energy lost. The other arguments and the errors are those
/// of [`land_at`].
pub(crate) fn bounced(
    body: &Body,
    y: &State,
    (slip, lift): ([f64; 2], f64),
    friction: &Friction,
    own: &impl SpeedLaw,
    e: f64,
) -> Result<(State, [f64; 2], f64, f64), Error> {
    let landing = Landing { body, border: body.border(), y: *y, slip, lift, friction, own };
    let Compressed { end, .. } = landing.compressed()?;
    let given = Carries::Given(end.push.map(|p| e * p));
    let again = Landing { y: end.y, slip: end.slips[0], lift: end.lift, ..landing }.solved(given);
    let Some(after) = again else { return Err(Error::Landing { mu: friction.strength(), outcomes: 0 }) };
    let energy = |y: &State, slip, lift| energy(&landing.border, body, y, slip, lift);
    let lost = energy(y, slip, lift) - energy(&after.y, after.slips[0], after.lift);
    Ok((after.y, after.slips[0], after.lift, lost))
}

/// The motion of a face just before or after the point of its rim opposite to the contact point lands. Directions are
/// seen from above: `along` to the point that lands, and `across` to the left of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FallingFace {
    /// The rate at which the face leans towards the landing point, and the rates about the direction to this point and
    /// about the vertical.
    pub leans: f64,
    pub turns: f64,
    pub spins: f64,
    /// The slip and the vertical velocity: before the landing of the point on which the face turns, after it of the
    /// point that has landed.
    pub slip: [f64; 2],
    pub lift: f64,
}

/// The landing of a face of radius a with the centre of mass Z above it: the motion after it and the energy lost. The
/// face then leans on beyond the point that has landed, or back, or not at all. Both points bounce with the restitution
/// `e` if both come down. None where there is no unique outcome.
pub(crate) fn falls_flat(
    body: &Body,
    [radius, height]: [f64; 2],
    FallingFace { leans, turns, spins, slip: [along, across], lift }: FallingFace,
    (friction, e): (&Friction, f64),
    own: &impl SpeedLaw,
) -> Option<(FallingFace, f64)> {
    let circle = |lever: f64| CircleDown { radius: -lever, depth: height, lever };
    let border =
        Border { angle: (0.0, 1.0), height, circles: [circle(radius), circle(-radius)], even: false };
    // The face is treated like another circle that lands, with smaller levers.
    let (y, slip) = (State { theta: 0.0, w1: -turns, w2: -leans, w3: spins }, [-along, -across]);
    let landing = Landing { body, border, y, slip, lift, friction, own };
    let Compressed { here, there, mut end } = landing.compressed().ok()?;
    if e > 0.0 && lift < 0.0 {
        let given = Carries::Given(end.push.map(|p| e * p));
        end = Landing { y: end.y, slip: end.slips[0], lift: end.lift, ..landing }.solved(given)?;
    } else if here && there {
        end.y.w2 = 0.0;
    }
    let lost = energy(&border, body, &y, slip, lift) - energy(&border, body, &end.y, end.slips[0], end.lift);
    let State { w1, w2, w3, .. } = end.y;
    let lift = end.lift + border.span() * w2;
    Some((FallingFace { leans: -w2, turns: -w1, spins: w3, slip: end.slips[1].map(|u| -u), lift }, lost))
}

/// The end of a compression, and whether each circle remains on the table: the previous one, and the one that landed.
struct Compressed {
    here: bool,
    there: bool,
    end: Pushed,
}

/// The coefficient of sliding friction, `mu` unless it varies with the speed.
fn coefficient(own: &impl SpeedLaw, mu: f64, speed: impl Fn() -> f64) -> f64 {
    if own.varies() { own.coefficient_at(speed()) } else { mu }
}

/// The state and the slip after the last of many ever smaller impacts of both rims, of which the lower one has the
/// vertical velocity `lift`. Impulses of either sign, each with the friction of its slip, remove the rest of w2 and of
/// the vertical velocity. A slip that is hardly faster than these velocities has no direction: friction is then left
/// out, so that no energy is gained.
///
/// Error: the square of those velocities; the velocities themselves at a rim that sticks, or slips as slowly as that.
pub(crate) fn settled(
    body: &Body,
    y: &State,
    (slip, lift): ([f64; 2], f64),
    friction: &Friction,
    own: &impl SpeedLaw,
) -> (State, [f64; 2]) {
    let landing = Landing { body, border: body.border(), y: *y, slip, lift, friction, own };
    let (Border { height, circles: [here, there], .. }, dry) = (landing.border, landing.is_dry());
    let least = REVERSES * (lift.abs() + here.lever * y.w2.abs());
    let drag = |[u, v]: [f64; 2]| {
        let size = u.hypot(v);
        let (per, mu) = (if dry { size } else { 1.0 }, landing.mu(size));
        [u, v].map(|u| if !dry || size > least { mu * u / per } else { 0.0 })
    };
    let [low, up] = landing.slips([[0.0; 2]; 2], y.w2).map(drag);
    let (down, turn) = (-(lift + here.lever * y.w2), -body.i1() * y.w2);
    let [p, q] = [here.lever - height * low[0], height * up[0] - there.lever];
    let push = (turn + down * p) / (p + q);
    let impulses = [low.map(|d| -(down - push) * d), up.map(|d| -push * d)];
    let after = State { w2: 0.0, ..landing.turned(&impulses, 0.0) };
    (after, if slip == [0.0; 2] { slip } else { landing.slips(impulses, 0.0)[0] })
}

/// The state and the slip of the circle that lands at theta_end, seen from the other end of the body, where its face is
/// at theta = 0: phi becomes phi + pi, and psi becomes -psi.
fn seen_from_next(y: &State, [along, across]: [f64; 2]) -> (State, [f64; 2]) {
    let theta = if y.theta == FRAC_PI_2 { y.theta } else { PI - y.theta };
    (State { theta, w1: y.w1, w2: 0.0 - y.w2, w3: 0.0 - y.w3 }, [0.0 - along, 0.0 - across])
}

/// The state and the slip of a body on its side, referred to its other rim, which then is the lower one.
///
/// phi becomes phi + pi, psi becomes -psi, and the contact point moves by 2 ell against e_h.
pub fn mirrored(body: &Body, y: &State, slip: Slip) -> (State, Slip) {
    let border = body.border();
    let there = [slip.u_h, slip.u_2 - border.span() * drilling_of(border.angle, y.w1, y.w3)];
    let (state, slip) = seen_from_next(y, there);
    (state, slip.into())
}

/// Kinetic energy at theta_end, from the state and from the slip and the vertical velocity of the circle to which it refers.
fn energy(border: &Border<f64>, body: &Body, y: &State, [along, across]: [f64; 2], lift: f64) -> f64 {
    let here = border.circles[0];
    let forth = along + border.height * y.w2;
    let aside = across - here.depth * y.w1 + here.radius * y.w3;
    let up = lift + here.lever * y.w2;
    let turning = body.i1() * (y.w1 * y.w1 + y.w2 * y.w2) + body.i3() * y.w3 * y.w3;
    0.5 * (forth * forth + aside * aside + up * up + turning)
}

/// The condition that gives the normal impulses of an impact.
#[derive(Clone, Copy, PartialEq)]
enum Carries {
    /// Both circles remain on the table.
    Both,
    /// This circle remains on the table, while the other one leaves it.
    One(usize),
    /// The normal impulses of both circles are given.
    Given([f64; 2]),
}

/// A landing: the state before it, with the slip and the vertical velocity of the circle to which the state refers.
#[derive(Clone, Copy)]
struct Landing<'a, L> {
    body: &'a Body,
    border: Border<f64>,
    y: State,
    slip: [f64; 2],
    lift: f64,
    friction: &'a Friction,
    own: &'a L,
}

/// The state and the slips of both circles after an impact, the vertical velocity of the first one, and the normal
/// impulses of both.
struct Pushed {
    y: State,
    slips: [[f64; 2]; 2],
    lift: f64,
    push: [f64; 2],
}

/// Friction impulses of both circles, each along e_h and e2.
type Impulses = [[f64; 2]; 2];

impl<L: SpeedLaw> Landing<'_, L> {
    fn is_dry(&self) -> bool {
        matches!(self.friction, Friction::Coulomb { .. })
    }

    /// The coefficient mu of dry friction at this speed, or c of a viscous film.
    fn mu(&self, speed: f64) -> f64 {
        coefficient(self.own, self.friction.strength(), || speed)
    }

    /// The compression with the outcome that is consistent; an error if there is none, or more than one.
    fn compressed(&self) -> Result<Compressed, Error> {
        let comes = self.y.w2 < 0.0 || self.lift < 0.0;
        let lies = self.solved(Carries::Both);
        let rocks = if comes { self.solved(Carries::One(1)) } else { None };
        // Where the previous circle barely stays, both solutions are the same motion up to rounding, and one is
        // dropped.
        let rocks = rocks.filter(|after| lies.is_none() || after.y.w2 < SAME * self.y.w2);
        // If both circles come down, the one that landed may also leave the table.
        let alone = self.lift < 0.0 && lies.is_none() && rocks.is_none();
        let stands = if alone { self.solved(Carries::One(0)) } else { None };
        match (lies, rocks, stands) {
            (Some(end), None, _) => Ok(Compressed { here: true, there: true, end }),
            (None, Some(end), _) => Ok(Compressed { here: false, there: true, end }),
            (None, None, Some(end)) => Ok(Compressed { here: true, there: false, end }),
            (lies, ..) => {
                let outcomes = if lies.is_some() { 2 } else { 0 };
                Err(Error::Landing { mu: self.friction.strength(), outcomes })
            }
        }
    }

    /// The normal impulses P of both circles, and w2 after the impact.
    fn pushed(&self, carries: Carries, q: &Impulses) -> ([f64; 2], f64) {
        let (Border { height, circles, .. }, i1, w) = (self.border, self.body.i1(), self.y.w2);
        let ([here, there], along) = (circles.map(|circle| circle.lever), height * (q[0][0] + q[1][0]));
        match carries {
            Carries::Both => {
                let all = -(self.lift + here * w);
                let push = (here * all - i1 * w + along) / self.border.span();
                ([all - push, push], 0.0)
            }
            Carries::One(k) => {
                let (lever, comes) = ([here, there][k], self.lift + k as f64 * self.border.span() * w);
                let push = -(i1 * comes + lever * along) / (i1 + lever * lever);
                let after = w - (lever * push + along) / i1;
                (if k == 0 { [push, 0.0] } else { [0.0, push] }, after)
            }
            Carries::Given(push) => (push, w - (here * push[0] + there * push[1] + along) / i1),
        }
    }

    /// The state after an impact with the friction impulses `q` and the angular velocity `w2`.
    fn turned(&self, q: &Impulses, w2: f64) -> State {
        let ([low, up], [here, there]) = (*q, self.border.circles);
        let w1 = self.y.w1 + (here.depth * low[1] + there.depth * up[1]) / self.body.i1();
        let w3 = self.y.w3 - (here.radius * low[1] + there.radius * up[1]) / self.body.i3();
        State { w1, w2, w3, ..self.y }
    }

    /// The change of the slip along e2 at circle `at` per impulse along e2 at circle `by`.
    fn yields(&self, at: usize, by: usize) -> f64 {
        let [at, by] = [self.border.circles[at], self.border.circles[by]];
        1.0 + at.depth * by.depth / self.body.i1() + at.radius * by.radius / self.body.i3()
    }

    /// The slips of both circles after the impact, each along e_h and e2.
    fn slips(&self, [low, up]: Impulses, w2: f64) -> [[f64; 2]; 2] {
        let along = self.slip[0] + low[0] + up[0] - self.border.height * (w2 - self.y.w2);
        let turning = self.border.span() * drilling_of(self.border.angle, self.y.w1, self.y.w3);
        let across = |k: usize| self.yields(k, 0) * low[1] + self.yields(k, 1) * up[1];
        [[along, self.slip[1] + across(0)], [along, self.slip[1] - turning + across(1)]]
    }

    /// The end of the impact under the condition `carries`; None if its normal impulses are not consistent.
    ///
    /// Each friction impulse is moved against the remaining slip and limited to mu P, until nothing changes.
    fn solved(&self, carries: Carries) -> Option<Pushed> {
        if self.excluded(carries) {
            return None;
        }
        let (Border { height, circles, .. }, i1) = (self.border, self.body.i1());
        let [here, there, mixed] = [self.yields(0, 0), self.yields(1, 1), self.yields(0, 1)];
        // The largest factor by which two impulses across change the slips.
        let both = 0.5 * (here + there) + (0.5 * (here - there)).hypot(mixed);
        let square = height * height;
        let (along, across, given) = match carries {
            Carries::Both => (2.0, both, 0.0),
            Carries::One(k) => {
                (1.0 + square / (i1 + circles[k].lever * circles[k].lever), [here, there][k], 0.0)
            }
            Carries::Given([here, there]) => (2.0 + 2.0 * square / i1, both, here.max(there)),
        };
        let step = 1.0 / across.max(along);
        // This velocity, as an impulse, is the scale of the rounding errors of the slips.
        let other = (self.border.span() * drilling_of(self.border.angle, self.y.w1, self.y.w3)).abs();
        let speeds = [self.slip[0].abs(), self.slip[1].abs(), other, -self.y.w2, -self.lift, given];
        let velocity = step * speeds.into_iter().fold(0.0, f64::max);
        let (dry, varies) = (self.is_dry(), self.own.varies());
        let mut q: Impulses = [[0.0; 2]; 2];
        let mut mu = [self.friction.strength(); 2];
        for i in 0..if varies { OWN_STEPS } else { STEPS } {
            let (p, w2) = self.pushed(carries, &q);
            let slips = self.slips(q, w2);
            let mut moved = 0f64;
            for k in 0..2 {
                if varies {
                    // Under a coefficient that is steep this search would circle, unless each coefficient follows slowly.
                    let at = self.own.coefficient_at(slips[k][0].hypot(slips[k][1]));
                    mu[k] += (at - mu[k]) / (1 + i / FOLLOWS) as f64;
                }
                let most = mu[k] * p[k].max(0.0);
                let tried = [q[k][0] - step * slips[k][0], q[k][1] - step * slips[k][1]];
                let size = tried[0].hypot(tried[1]);
                let share = match dry {
                    true if size <= most => 1.0,
                    true => most / size,
                    false => most / (most + step),
                };
                let next = tried.map(|x| x * share);
                moved = (0..2).fold(moved, |moved, i| larger_or_nan(moved, (next[i] - q[k][i]).abs()));
                q[k] = next;
            }
            let size = q.iter().flatten().fold(velocity, |m, x| m.max(x.abs()));
            if moved <= 4.0 * f64::EPSILON * size {
                return self.consistent(carries, &q);
            }
        }
        None
    }

    /// Whether no friction up to mu can make the condition `carries` consistent, by the criterion at the top of this
    /// file.
    ///
    /// For mu Z |g| >= I1 + g^2 at a circle the criterion excludes nothing.
    fn excluded(&self, carries: Carries) -> bool {
        let (Border { height, circles, .. }, i1, mu) =
            (self.border, self.body.i1(), self.friction.strength());
        let [here, there] = circles.map(|circle| circle.lever);
        let reach = mu * height * here.abs();
        let room = -here * there - i1;
        let safe = |lever: f64| mu * height * lever.abs() < i1 + lever * lever;
        let rounding = SAME * (i1 + here * here.max(-there));
        self.is_dry()
            && !self.own.varies()
            && self.lift == 0.0
            && safe(here)
            && safe(there)
            && match carries {
                Carries::Both => room + reach < -rounding,
                Carries::One(k) => k == 1 && room - reach > rounding,
                Carries::Given(_) => false,
            }
    }

    /// The result, if no normal impulse is negative and a circle that leaves the table moves upwards; else None.
    fn consistent(&self, carries: Carries, q: &Impulses) -> Option<Pushed> {
        let (push @ [here, there], w2) = self.pushed(carries, q);
        let good = match carries {
            Carries::Both => here >= -SAME * there && there >= 0.0,
            Carries::One(k) => push[k] >= 0.0 && if k == 0 { w2 > 0.0 } else { w2 < 0.0 },
            Carries::Given(_) => true,
        };
        let lift = match carries {
            Carries::Both => 0.0,
            _ => self.lift + here + there - self.border.circles[0].lever * (w2 - self.y.w2),
        };
        good.then(|| Pushed { y: self.turned(q, w2), slips: self.slips(*q, w2), lift, push })
    }
}

/// A slip of less than this times the velocities of a bounce may change its sign in the next impacts.
pub(crate) const REVERSES: f64 = 10.0;

/// An impulse or a speed that is smaller than this fraction of another one counts as zero.
const SAME: f64 = 1e-12;

/// The largest number of steps of the search for the impulses: some tens are usual, I3 = 0.001 takes
/// thousands.
const STEPS: usize = 100_000;
/// The largest number of steps under a coefficient that depends on the speed, and the number of steps after which the
/// coefficient follows the speed by a smaller share.
const OWN_STEPS: usize = 20_000;
const FOLLOWS: usize = 100;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::body::Circle;

    /// Numbers between 0 and 1 without a pattern.
    fn draws() -> impl FnMut(f64, f64) -> f64 {
        let mut x: f64 = 0.1;
        move |low, high| {
            x = (x + 0.618_033_988_749_894_9).fract();
            low + (high - low) * (x * 7919.0).fract()
        }
    }

    #[test]
    fn the_next_circle_of_a_cup_lands_by_the_impulses_of_newton_and_euler_with_the_friction_of_moreau() {
        let (mut draw, mut ends) = (draws(), [0; 3]);
        for _ in 0..2000 {
            let far = draw(0.2, 3.0);
            let tip = draw(0.0, 1.0) < 0.2;
            let circle = |radius, depth| Circle { radius, depth, fillet: 0.05 };
            let low = circle(if tip { 0.0 } else { draw(0.2, 1.0) }, draw(0.2, 0.8) * far);
            let up = circle(draw(0.5, 1.0), low.depth - far);
            let i3 = draw(0.1, 0.9);
            let body = Body::profile(&[low, up], draw(0.51, 2.0) * i3, i3).unwrap();
            let border @ Border { height, circles: [here, there], .. } = body.border();
            // Where friction may press a circle into the table, no landing or several may be consistent.
            let most = [here, there].map(|on| (body.i1() + on.lever * on.lever) / (on.lever.abs() * height));
            let mu = draw(0.05, 0.9) * most[0].min(most[1]).min(border.span() / height).min(1.0);
            let y = State {
                theta: body.theta_end(),
                w1: draw(-1.0, 1.0),
                w2: draw(-1.0, -0.1),
                w3: draw(-1.0, 1.0),
            };
            let slip = if draw(0.0, 1.0) < 0.3 { [0.0; 2] } else { [draw(-1.0, 1.0), draw(-1.0, 1.0)] };
            let landing = Landing {
                body: &body,
                border,
                y,
                slip,
                lift: 0.0,
                friction: &Friction::coulomb(mu),
                own: &(),
            };
            let Compressed { here: stays, end, .. } = landing.compressed().unwrap();
            ends[usize::from(stays)] += 1;
            let centre = |y: &State, [u, v]: [f64; 2], lift: f64| {
                [u + height * y.w2, v - here.depth * y.w1 + here.radius * y.w3, lift + here.lever * y.w2]
            };
            let [before, after] = [centre(&y, slip, 0.0), centre(&end.y, end.slips[0], end.lift)];
            let gained: [f64; 3] = core::array::from_fn(|i| after[i] - before[i]);
            // Both normal impulses follow from the vertical velocity and from w2.
            let turn = body.i1() * (end.y.w2 - y.w2) + height * gained[0];
            let push = [(-there.lever * gained[2] - turn), (here.lever * gained[2] + turn)]
                .map(|x| x / border.span());
            assert!(push[0] > -1e-12 && push[1] > -1e-12, "{push:?}");
            assert!(if stays {
                end.lift == 0.0 && end.y.w2 == 0.0
            } else {
                push[0].abs() < 1e-12 && end.lift > 0.0
            });
            assert!((end.lift + border.span() * end.y.w2).abs() < 1e-12);
            // Both impulses across follow from w1 and w3.
            let [tilt, spin] = [body.i1() * (end.y.w1 - y.w1), body.i3() * (y.w3 - end.y.w3)];
            let span = here.depth * there.radius - there.depth * here.radius;
            let across = [tilt * there.radius - there.depth * spin, here.depth * spin - tilt * here.radius];
            let across = across.map(|x| x / span);
            assert!((across[0] + across[1] - gained[1]).abs() < 1e-11);
            let turning = border.span() * drilling_of(border.angle, end.y.w1, end.y.w3);
            assert!((end.slips[1][1] - end.slips[0][1] + turning).abs() < 1e-12);
            let (mut along, mut sticks) = (0.0, false);
            for k in 0..2 {
                let (size, most) = (end.slips[k][0].hypot(end.slips[k][1]), mu * push[k]);
                if size < 1e-11 {
                    sticks = true;
                    assert!(across[k].abs() <= most + 1e-12);
                } else {
                    assert!((across[k] + most * end.slips[k][1] / size).abs() < 1e-10);
                    along -= most * end.slips[k][0] / size;
                }
            }
            assert!(sticks || (along - gained[0]).abs() < 1e-10);
            let lost = energy(&border, &body, &y, slip, 0.0)
                - energy(&border, &body, &end.y, end.slips[0], end.lift);
            assert!(lost > -1e-13);
            ends[2] += usize::from(sticks);
        }
        assert!(ends.iter().all(|count| *count > 200), "{ends:?}");
    }
}
