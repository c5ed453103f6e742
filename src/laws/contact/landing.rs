//! A body on its side: the motion on both rims, and the impact when the other rim lands.
//!
//! ```text
//! theta = pi/2, ell > 0; the lower rim touches at +ell e_h, the upper one at -ell e_h, and both slip by u_h,
//!   u_2,low = u_2,   u_2,up = u_2 - 2 ell w1
//! lying, w2 = 0      N_low, N_up = (1 +- (I3 w1 w3 - Fh)/ell)/2,   Fh = the friction of both along e_h
//!   it rises where   I3 w1 w3 - Fh > ell,   Fh = -mu u_h/|u|, or of a rim that sticks w1 (ell w1 - w3) within +-mu
//! landing, w2 = -W   plastic: impulses P_low, P_up >= 0 and Q with |Q| <= mu P
//!   both stay        P_low + P_up = ell W,   P_up - P_low = (I1 W + Qh)/ell,            w2 -> 0
//!   it rocks over    P_low = 0,   P_up = ell (2 I1 W + Qh)/(I1 + ell^2),                 w2 -> -W + (ell P_up - Qh)/I1
//!   u_h  -> u_h + Qh - (change of w2),   u_2 -> u_2 + a Q2 + b (Q2 of the other rim),   a, b = 1 + 1/I3 +- ell^2/I1
//!   w1   -> w1 + ell (Q2,low - Q2,up)/I1,   w3 -> w3 - (Q2,low + Q2,up)/I3
//! bounce of both rims        then P grows by e P, and Q again opposes the slip that remains, with |Q| <= mu e P
//! seen from the other rim   (w1, w2, w3, u_h, u_2) -> (w1, -w2, -w3, -u_h, 2 ell w1 - u_2),   phi + pi, -psi
//! ```
//! The impulses are those of Newton's and Euler's equations about the centre of mass. Friction is Coulomb's in the form
//! of Moreau (Unilateral contact and dry friction in finite freedom dynamics, 1988): the impulse at a rim opposes the
//! slip after the impact, Q = -mu P u/|u|, or it is just large enough to stop the slip. Therefore no landing gains
//! energy. The law is exact where the slip keeps its direction during the impact or stops and sticks; where the slip
//! turns it is a model. If both rims come down at once and bounce, the table gives back the share e of the normal
//! impulse of compression at each rim (Poisson). For these normal impulses Moreau's friction leaves the least energy,
//! not more than if e Q were given back, which would leave at most e^2 of the energy taken: no bounce of both rims
//! gains energy. One rim bounces as in `contact::impact`. Without friction both rims stay if ell^2 >= I1; with
//! friction if ell^2 - ell Q_up,h/P_up >= I1.
//!
//! Under a coefficient that depends on the speed, mu is that of the slip after the impact: this too takes energy, since
//! the impulse opposes that slip.
//!
//! Error: 1e-12 of the largest velocity; a test of `throw` compares with the three-dimensional model.

use super::lying::{Lying, from_other};
use super::slip::Friction;
use crate::error::{Error, within};
use crate::laws::body::{Body, LEVEL_ON_UNEQUAL_RIMS};
use crate::laws::custom::SpeedLaw;
use crate::laws::loss::Losses;
use crate::laws::state::State;
use core::f64::consts::FRAC_PI_2;

/// The motion of a body after its other rim has landed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The body lies on both rims, which slip or roll.
    Lies,
    /// The body rises at once on the rim on which it moved before.
    Rises,
    /// The body continues on the other rim; state and slip are given as seen from there.
    Changes,
}

/// The result of a landing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landed {
    /// The kind of motion that follows.
    pub outcome: Outcome,
    /// The state as seen from the rim that carries the body; from the old rim if the body lies on both.
    pub state: State,
    /// The slip of the rim from which `state` is seen, along e_h and along e2.
    pub slip: [f64; 2],
    /// Energy lost to the impact, in M g R.
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

/// Returns an error for a body that lies level on two rims that are not equal, since its motion ends where it lies.
pub(crate) fn equal_rims(body: &Body) -> Result<(), Error> {
    if body.theta_end() != LEVEL_ON_UNEQUAL_RIMS {
        return Ok(());
    }
    let expected = "a centre of mass midway between two equal rims: on its side this body lies on two unequal ones, where its motion ends";
    Err(Error::OutOfRange { name: "ell", value: body.ell(), expected })
}

/// The launch number with friction, (I3 w1 w3 - Fh)/ell, of a body at theta = pi/2 and w2 = 0; above 1 the body rises.
///
/// Fh is the friction at the lower rim if this rim alone carries the body. At a rim at rest Fh is the friction that
/// rolling needs, at most `mu`, which then is the static coefficient.
pub fn launch(body: &Body, y: &State, slip: [f64; 2], mu: f64) -> f64 {
    let speed = slip[0].hypot(slip[1]);
    let along = if speed > 0.0 {
        -mu * (slip[0] / speed)
    } else {
        let demand = y.w1 * (body.ell() * y.w1 - y.w3);
        demand.max(-mu).min(mu)
    };
    (body.i3() * y.w1 * y.w3 - along) / body.ell()
}

/// Whether a body at theta = pi/2 and w2 = 0 rises on its lower rim; otherwise the body stays on its side.
///
/// The criterion holds for every mu below (I1 + ell^2)/ell, where the contact force is unique.
pub fn rises(body: &Body, y: &State, slip: [f64; 2], mu: f64) -> bool {
    launch(body, y, slip, mu) > 1.0
}

/// The normal forces N_low and N_up on a body that lies on its side while both rims slip; a force is negative where
/// that end rises.
///
/// With friction, the forces are NaN where a rim does not slip, since its friction is not known from the state alone.
pub fn normals(body: &Body, y: &State, slip: [f64; 2], mu: f64) -> [f64; 2] {
    let lying = Lying::on(body, &Friction::coulomb(mu), &Losses::NONE);
    lying.slipping([y.w1, y.w3, slip[0], slip[1]]).force.map(|[normal, ..]| normal)
}

/// The plastic landing of the other rim at theta = pi/2, with w2 <= 0, on a table with the friction `mu`.
///
/// With w2 = 0 there is no impact, and only the motion that follows is determined. Friction may allow two
/// consistent outcomes or none, which is an error; in 1e-5 of all cases the search finds no outcome, which is
/// an error, too.
pub fn land(body: &Body, y: &State, slip: [f64; 2], mu: f64) -> Result<Landed, Error> {
    two_rims(body)?;
    within("mu", mu, (0.0, 1e100), "0 <= mu <= 1e100")?;
    land_at(body, y, (slip, 0.0), &Friction::coulomb(mu), &())
}

/// The plastic landing with any law of friction, also for a body whose lower rim comes down at the same time, at the
/// velocity `lift` <= 0. A viscous film takes the impulse c P u, with the slip u after the impact, as dry friction
/// does. A coefficient that depends on the speed, of `own`, is that of the slip after the impact.
pub(crate) fn land_at(
    body: &Body,
    y: &State,
    (slip, lift): ([f64; 2], f64),
    friction: &Friction,
    own: &impl SpeedLaw,
) -> Result<Landed, Error> {
    let most = 1e100;
    within("theta", y.theta, (FRAC_PI_2, FRAC_PI_2), "pi/2, where the other rim lands")?;
    within("w2", y.w2, (-most, 0.0), "-1e100 <= w2 <= 0, for a rim that comes down")?;
    for (name, x) in [("w1", y.w1), ("w3", y.w3), ("u_h", slip[0]), ("u_2", slip[1])] {
        within(name, x, (-most, most), "-1e100 to 1e100")?;
    }
    let before = energy(body, y, slip, lift);
    let end = |outcome, y: State, slip: [f64; 2]| {
        let lost = before - energy(body, &y, slip, 0.0);
        Landed { outcome, state: y, slip, lost }
    };
    let mu = |[u, v]: [f64; 2]| coefficient(own, friction.strength(), || u.hypot(v));
    Ok(match compressed(body, y, (slip, lift), friction, own)? {
        Compressed { here: true, there: true, end: Pushed { y, slip, .. } } => {
            let (there, other) = mirrored(body, &y, slip);
            if rises(body, &y, slip, mu(slip)) {
                end(Outcome::Rises, y, slip)
            } else if rises(body, &there, other, mu(other)) {
                end(Outcome::Changes, there, other)
            } else {
                end(Outcome::Lies, y, slip)
            }
        }
        Compressed { here: true, end: Pushed { y, slip, .. }, .. } => end(Outcome::Rises, y, slip),
        Compressed { end: Pushed { y, slip, .. }, .. } => {
            let (there, other) = mirrored(body, &y, slip);
            end(Outcome::Changes, there, other)
        }
    })
}

/// A landing of both rims at once that bounce with the restitution `e`: the state, the slip and the vertical velocity
/// of the lower rim, which comes down at `lift` < 0, and the energy lost. Arguments and errors as for [`land_at`].
pub(crate) fn bounced(
    body: &Body,
    y: &State,
    (slip, lift): ([f64; 2], f64),
    friction: &Friction,
    own: &impl SpeedLaw,
    e: f64,
) -> Result<(State, [f64; 2], f64, f64), Error> {
    let Compressed { end, .. } = compressed(body, y, (slip, lift), friction, own)?;
    let (mu, dry) = strength(friction);
    let given = Rims::Given(end.push.map(|p| e * p));
    let again = Impact { body, y: end.y, slip: end.slip, lift: end.lift, mu, dry, own, rims: given }.solved();
    let Some(after) = again else { return Err(Error::Landing { mu, outcomes: 0 }) };
    let lost = energy(body, y, slip, lift) - energy(body, &after.y, after.slip, after.lift);
    Ok((after.y, after.slip, after.lift, lost))
}

/// The end of a compression, and which rims remain on the table: the lower one, and the other one.
struct Compressed {
    here: bool,
    there: bool,
    end: Pushed,
}

/// The coefficient of sliding friction, `mu` unless it varies with the speed.
fn coefficient(own: &impl SpeedLaw, mu: f64, speed: impl Fn() -> f64) -> f64 {
    if own.varies() { own.coefficient_at(speed()) } else { mu }
}

/// The coefficient of a law of friction, and whether it is dry.
fn strength(friction: &Friction) -> (f64, bool) {
    (friction.strength(), matches!(friction, Friction::Coulomb { .. }))
}

/// The compression of a landing, by the one of its outcomes that is consistent.
fn compressed(
    body: &Body,
    y: &State,
    (slip, lift): ([f64; 2], f64),
    friction: &Friction,
    own: &impl SpeedLaw,
) -> Result<Compressed, Error> {
    let (mu, dry) = strength(friction);
    let comes = y.w2 < 0.0 || lift < 0.0;
    let on = |y: &State, slip: [f64; 2], lift: f64, rims| {
        Impact { body, y: *y, slip, lift, mu, dry, own, rims }.solved()
    };
    let lies = on(y, slip, lift, Rims::Both);
    let rocks = if comes { on(y, slip, lift, Rims::Other) } else { None };
    // Where the lower rim barely stays, both solutions are the same motion up to rounding, and one is
    // dropped.
    let rocks = rocks.filter(|after| lies.is_none() || after.y.w2 < SAME * y.w2);
    // If both rims come down, it may also be the other one that leaves the table.
    let stands = if lift < 0.0 && lies.is_none() && rocks.is_none() {
        let (there, other) = mirrored(body, y, slip);
        on(&there, other, lift + 2.0 * body.ell() * y.w2, Rims::Other)
    } else {
        None
    };
    match (lies, rocks, stands) {
        (Some(end), None, _) => Ok(Compressed { here: true, there: true, end }),
        (None, Some(end), _) => Ok(Compressed { here: false, there: true, end }),
        (None, None, Some(end)) => {
            let (seen, slip) = mirrored(body, &end.y, end.slip);
            let lift = end.lift + 2.0 * body.ell() * end.y.w2;
            let push = [end.push[1], end.push[0]];
            Ok(Compressed { here: true, there: false, end: Pushed { y: seen, slip, lift, push } })
        }
        (lies, ..) => Err(Error::Landing { mu, outcomes: if lies.is_some() { 2 } else { 0 } }),
    }
}

/// The state and the slip after the last impact of a rattle on both rims, whose rim comes down or rises at `lift`.
/// Impulses of either sign, each with the friction of its slip, take the rest of w2 and of the vertical velocity. A slip
/// that is hardly faster than they are has no direction: without friction the body then gains no energy.
///
/// Error: the square of those velocities, or the velocities themselves at a rim that slips so slowly, or sticks.
pub(crate) fn settled(
    body: &Body,
    y: &State,
    (slip, lift): ([f64; 2], f64),
    friction: &Friction,
    own: &impl SpeedLaw,
) -> (State, [f64; 2]) {
    let (ell, (mu, dry)) = (body.ell(), strength(friction));
    let least = REVERSES * (lift.abs() + ell * y.w2.abs());
    let drag = |[u, v]: [f64; 2]| {
        let size = u.hypot(v);
        let (per, mu) = (if dry { size } else { 1.0 }, coefficient(own, mu, || size));
        [u, v].map(|u| if !dry || size > least { mu * u / per } else { 0.0 })
    };
    let (low, up) = (drag(slip), drag([slip[0], slip[1] - 2.0 * ell * y.w1]));
    let (down, turn) = (-(lift + ell * y.w2), -body.i1() * y.w2);
    let there = (turn + down * (ell - low[0])) / (2.0 * ell + up[0] - low[0]);
    let q = [low.map(|d| -(down - there) * d), up.map(|d| -there * d)];
    let (after, slips) = Impact { body, y: *y, slip, lift, mu, dry, own, rims: Rims::Both }.after(&q, 0.0);
    (State { w2: 0.0, ..after }, if slip == [0.0; 2] { slip } else { slips[0] })
}

/// The state and the slip of a body on its side as seen from its other rim, which then is the lower one.
///
/// phi becomes phi + pi, psi becomes -psi, and the contact point moves by 2 ell against e_h.
pub fn mirrored(body: &Body, y: &State, slip: [f64; 2]) -> (State, [f64; 2]) {
    let theta = if y.theta == FRAC_PI_2 { y.theta } else { core::f64::consts::PI - y.theta };
    let [w1, w3, u_h, u_2] = from_other(body.ell(), [y.w1, y.w3, slip[0], slip[1]]);
    (State { theta, w1, w2: 0.0 - y.w2, w3 }, [u_h, u_2])
}

/// Kinetic energy at theta = pi/2, from the state, and the slip and the vertical velocity of the lower rim.
fn energy(body: &Body, y: &State, [along, across]: [f64; 2], lift: f64) -> f64 {
    let ell = body.ell();
    let [forth, aside, up] = [along + y.w2, across - ell * y.w1 + y.w3, lift + ell * y.w2];
    let turning = body.i1() * (y.w1 * y.w1 + y.w2 * y.w2) + body.i3() * y.w3 * y.w3;
    0.5 * (forth * forth + aside * aside + up * up + turning)
}

/// The normal impulses of an impact.
#[derive(Clone, Copy, PartialEq)]
enum Rims {
    /// Those that keep both rims on the table.
    Both,
    /// That which keeps the other rim on the table, while the lower rim leaves it.
    Other,
    /// These, of the lower and of the other rim.
    Given([f64; 2]),
}

/// An impact with the normal impulses of `rims`.
struct Impact<'a, L> {
    body: &'a Body,
    y: State,
    slip: [f64; 2],
    /// The vertical velocity of the lower rim.
    lift: f64,
    /// The coefficient mu of dry friction, or c of a viscous film.
    mu: f64,
    dry: bool,
    own: &'a L,
    rims: Rims,
}

/// The state, the slip and the vertical velocity of the lower rim after an impact, and the normal impulses of both
/// rims.
struct Pushed {
    y: State,
    slip: [f64; 2],
    lift: f64,
    push: [f64; 2],
}

/// Friction impulses of the lower and the upper rim, each along e_h and e2.
type Impulses = [[f64; 2]; 2];

impl<L: SpeedLaw> Impact<'_, L> {
    /// The normal impulses P of both rims, and w2 after the impact.
    fn pushed(&self, q: &Impulses) -> ([f64; 2], f64) {
        let (ell, i1, w, along) = (self.body.ell(), self.body.i1(), -self.y.w2, q[0][0] + q[1][0]);
        match self.rims {
            Rims::Both => {
                let (all, apart) = (ell * w - self.lift, (i1 * w + along) / ell);
                ([0.5 * (all - apart), 0.5 * (all + apart)], 0.0)
            }
            Rims::Other => {
                let push = (i1 * (2.0 * ell * w - self.lift) + ell * along) / (i1 + ell * ell);
                ([0.0, push], (ell * push - along) / i1 - w)
            }
            Rims::Given(push) => (push, (ell * (push[1] - push[0]) - along) / i1 - w),
        }
    }

    /// The state after the impact and the slips of both rims.
    fn after(&self, q: &Impulses, w2: f64) -> (State, [[f64; 2]; 2]) {
        let (body, y, [low, up]) = (self.body, self.y, *q);
        let w1 = y.w1 + body.ell() * (low[1] - up[1]) / body.i1();
        let w3 = y.w3 - (low[1] + up[1]) / body.i3();
        let along = self.slip[0] + low[0] + up[0] - (w2 - y.w2);
        let straight = (low[1] + up[1]) * (1.0 + 1.0 / body.i3());
        let turning = (low[1] - up[1]) * body.ell() * body.ell() / body.i1();
        let across = [turning, -turning].map(|turning| straight + turning);
        let slips = [self.slip[1] + across[0], self.slip[1] - 2.0 * body.ell() * y.w1 + across[1]];
        (State { w1, w2, w3, ..y }, slips.map(|across| [along, across]))
    }

    /// The end of the impact, if its normal impulses are consistent.
    ///
    /// Each friction impulse is moved against the remaining slip and limited to mu P, until nothing changes.
    fn solved(&self) -> Option<Pushed> {
        if self.excluded() {
            return None;
        }
        let (ell, i1, i3) = (self.body.ell(), self.body.i1(), self.body.i3());
        let (straight, turning) = (1.0 + 1.0 / i3, ell * ell / i1);
        let both = 2.0 * straight.max(turning);
        let (along, across, given) = match self.rims {
            Rims::Both => (2.0, both, 0.0),
            Rims::Other => (1.0 + 1.0 / (i1 + ell * ell), straight + turning, 0.0),
            Rims::Given([here, there]) => (2.0 + 2.0 / i1, both, here.max(there)),
        };
        let step = 1.0 / across.max(along);
        // This velocity, as an impulse, is the scale of the rounding errors of the slips.
        let other = (2.0 * ell * self.y.w1).abs();
        let speeds = [self.slip[0].abs(), self.slip[1].abs(), other, -self.y.w2, -self.lift, given];
        let velocity = step * speeds.into_iter().fold(0.0, f64::max);
        let mut q: Impulses = [[0.0; 2]; 2];
        let mut mu = [self.mu; 2];
        for i in 0..if self.own.varies() { OWN_STEPS } else { STEPS } {
            let (p, w2) = self.pushed(&q);
            let (_, slips) = self.after(&q, w2);
            let mut moved = 0f64;
            for k in 0..2 {
                if self.own.varies() {
                    // Under a coefficient that is steep this search would circle, unless each coefficient follows slowly.
                    let at = self.own.coefficient_at(slips[k][0].hypot(slips[k][1]));
                    mu[k] += (at - mu[k]) / (1 + i / FOLLOWS) as f64;
                }
                let most = mu[k] * p[k].max(0.0);
                let tried = [q[k][0] - step * slips[k][0], q[k][1] - step * slips[k][1]];
                let size = tried[0].hypot(tried[1]);
                let share = match self.dry {
                    true if size <= most => 1.0,
                    true => most / size,
                    false => most / (most + step),
                };
                let next = tried.map(|x| x * share);
                moved = moved.max((next[0] - q[k][0]).abs()).max((next[1] - q[k][1]).abs());
                q[k] = next;
            }
            let size = q.iter().flatten().fold(velocity, |m, x| m.max(x.abs()));
            if moved <= 4.0 * f64::EPSILON * size {
                return self.consistent(&q);
            }
        }
        None
    }

    /// Whether no friction up to mu can make the assumption consistent, by the criterion at the head of this
    /// module.
    ///
    /// For mu >= (I1 + ell^2)/ell the criterion excludes nothing.
    fn excluded(&self) -> bool {
        let (ell, i1) = (self.body.ell(), self.body.i1());
        let (square, reach) = (ell * ell, self.mu * ell);
        let [least, most] = [square - reach - i1, square + reach - i1];
        let rounding = SAME * (i1 + square);
        self.dry
            && !self.own.varies()
            && self.lift == 0.0
            && reach < i1 + square
            && match self.rims {
                Rims::Both => most < -rounding,
                Rims::Other => least > rounding,
                Rims::Given(_) => false,
            }
    }

    /// The result, if no rim pulls and a rim that leaves the table moves upwards.
    fn consistent(&self, q: &Impulses) -> Option<Pushed> {
        let (push @ [here, there], w2) = self.pushed(q);
        let good = match self.rims {
            Rims::Both => here >= -SAME * there && there >= 0.0,
            Rims::Other => there >= 0.0 && w2 < 0.0,
            Rims::Given(_) => true,
        };
        let (y, slips) = self.after(q, w2);
        let lift = match self.rims {
            Rims::Both => 0.0,
            _ => self.lift + here + there - self.body.ell() * (w2 - self.y.w2),
        };
        good.then_some(Pushed { y, slip: slips[0], lift, push })
    }
}

/// A slip of less than this many velocities of a bounce may turn around in the next impacts.
pub(crate) const REVERSES: f64 = 10.0;

/// An impulse or a speed that is smaller than this fraction of another one counts as zero.
const SAME: f64 = 1e-12;

/// The largest number of steps of the search for the impulses: some tens are usual, I3 = 0.001 takes
/// thousands.
const STEPS: usize = 100_000;
/// The same number under a coefficient that depends on the speed, and the number of steps after which the coefficient
/// follows the speed by a smaller share.
const OWN_STEPS: usize = 20_000;
const FOLLOWS: usize = 100;
