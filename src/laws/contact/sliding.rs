//! The slip of a contact point during an impact, or of a patch that also drills, by steps of a numerical integration.
//!
//! ```text
//! y = (u_1, u_2, w_n, u_n, P_1, P_2, C, p, work)        dp = S/(S + k) dx, in which nothing is singular
//! F = -mu u/|u|,   S = |u|;   on a patch F = -mu f u/|u| and C' = -mu eps g sgn w_n,   S = |u| + eps |w_n|
//! u' = b + A F + m_t C',   w_n' = m.(F, 1) + i C',   u_n' = a_n + b.F + m_n C',   work' = u_n          per dp
//! compression ends where u_n = 0, the impact where the work since then is e^2 times that of compression
//! ```
//! [`Delassus`] has A, b and a_n, [`PatchedPoint`] m, i and the radius eps. All velocities are in units of the first normal
//! velocity, or of the slip where that is zero. The time of this flow is p. The coefficient mu is constant, with k = 1, or
//! a function of the speed, with k = mu, since mu may vanish with the speed; k = mu tr A on a patch. Where slip and
//! drilling keep their ratio, as in a creep, both change linearly in p. (F, C') is minus the gradient of a convex function of (u, w_n), so that
//! they are unique for every mu and every body (Moreau 1988).
//!
//! Error: the tolerance of the steps.

use super::delassus::{Delassus, speed};
use super::patch::{self, PatchShares, Rubbing, rubs};
use crate::methods::flow::{Flow, FlowPlace};
use crate::methods::search::crossing;
use crate::methods::{SHORT_CODE, rk8};
use crate::numbers::Dual;
use core::f64::consts::FRAC_PI_2;
use nalgebra::{Matrix3, Vector3};

/// A slip slower than this share of the rubbing speed, or of the normal velocity, counts as zero.
pub(super) const STOPPED: f64 = 1e-15;
/// Two angles. At less than the first from e_h, a slip keeps its direction up to the square of the angle. At less than
/// the second from a constant direction any slip keeps it, also where the angle grows as the slip dies out.
const STRAIGHT: f64 = 1e-8;
const STRAIGHT_ON: f64 = 1e-14;
/// Tolerances of a slip across e_h. The first is a share of the slip, so that a long slip can die out. Where that share
/// is less than the tolerance of the steps, no error below the second share counts.
const DIES: f64 = 1e-6;
const DYING: f64 = 1e-3;
/// A normal velocity down to minus this does not count as a new fall: restitution begins with the velocity zero.
const BARELY_DOWN: f64 = 1e-9;
/// Step of an angle over which a derivative is computed.
const ANGLE_STEP: f64 = 1e-5;
/// Slip and drilling keep their ratio if it would change the slip by less than this.
const STAYS: f64 = 1e-14;
/// Largest number of Newton's steps in the search for the motion in which a patch at rest begins to move, and the
/// largest angle by which one step may turn this motion.
const MOST_NEWTON: usize = 2000;
const FARTHEST_TURN: f64 = 0.7;
/// The first step of the integration along an impact.
pub(super) const FIRST: f64 = 0.3;

/// The longest step, in units of that in which a direction of slip would reach the direction that attracts it.
const DECAYING_STEP: f64 = 3.0;

/// The indices of the numbers that follow the slip u: the drilling, the normal velocity, the impulses, their couple,
/// the normal impulse so far, and the work of the normal force.
pub(super) const DRILLING: usize = 2;
pub(super) const LIFT: usize = 3;
const P_1: usize = 4;
const P_2: usize = 5;
const COUPLE: usize = 6;
pub(super) const PUSHED: usize = 7;
pub(super) const WORK: usize = 8;
/// The number of the variables that the steps integrate.
pub(super) const SLIDING: usize = 9;

/// A patch of contact that drills: its radius, its drilling, the changes of the drilling per impulse along the two
/// horizontal axes and along the normal, and per impulse of a couple about the normal. By symmetry these are also the
/// changes of the velocities per such couple.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PatchedPoint {
    pub radius: f64,
    pub drilling: f64,
    pub row: [f64; 3],
    pub about: f64,
}

impl PatchedPoint {
    /// Whether the patch may turn about the normal during an impact that begins with this slip; else it acts as a point.
    pub fn turns(&self, slip: [f64; 2], light: &Delassus) -> bool {
        let [m_1, m_2, m_n] = self.row;
        let planar = light.is_lean() && slip[1] == 0.0;
        self.drilling != 0.0 || m_1 != 0.0 || m_n != 0.0 || m_2 != 0.0 && !planar
    }
}

/// The reason for which the integration of a slip along an impact ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum SlipEnd {
    /// The compression or the restitution ends.
    Over,
    /// Friction presses the contact point down once more before restitution ends.
    Falls,
    /// The slip stops, or keeps its direction from here on.
    Straight,
    /// The integration takes too many steps.
    GivenUp,
}

/// The end of an impact: the place where the variable with the index `number` has this value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Restored {
    pub number: usize,
    pub value: f64,
}

impl Restored {
    pub fn at(number: usize, value: f64) -> Self {
        Self { number, value }
    }

    /// The difference of this value and the present one; zero at the end of the impact.
    pub fn left<const N: usize>(&self, y: &[f64; N]) -> f64 {
        self.value - y[self.number]
    }
}

/// The coefficient of friction: constant, or a function of the speed.
#[derive(Clone, Copy)]
pub(super) struct Roughness<'a> {
    pub mu: f64,
    pub law: Option<&'a dyn Fn(f64) -> f64>,
}

impl Roughness<'_> {
    pub fn at(&self, speed: f64) -> f64 {
        self.law.map_or(self.mu, |law| law(speed))
    }
}

/// The equations of the slip of a contact point during an impact.
#[derive(Clone, Copy)]
pub(super) struct ImpactSlip<'a> {
    pub light: Delassus,
    pub rubs: Roughness<'a>,
    pub patch: Option<PatchedPoint>,
    /// The end of restitution; None while compression lasts.
    pub restores: Option<Restored>,
    pub tol: f64,
}

/// A direction that a slip keeps until it stops.
pub(super) struct Straight {
    pub way: [f64; 2],
    /// The slip across that direction, which dies out, and the velocity across per impulse across.
    pub across: f64,
    pub light: f64,
}

impl ImpactSlip<'_> {
    /// The patch of contact; None for a point. The code for web pages has no patches.
    #[inline(always)]
    pub fn patch(&self) -> Option<PatchedPoint> {
        if SHORT_CODE { None } else { self.patch }
    }

    /// The direction that this slip keeps; None if it turns, or has stopped.
    pub fn keeps(&self, slip: [f64; 2]) -> Option<Straight> {
        let sigma = speed(slip);
        if self.rubs.law.is_some() || self.patch().is_some() || sigma < STOPPED {
            return None;
        }
        let way @ [x, y] = slip.map(|u| u / sigma);
        let [turn, bends, light] = self.light.turning(way, self.rubs.mu);
        if turn.abs() < STOPPED {
            return Some(Straight { way, across: 0.0, light });
        }
        // Only for a slip along the lean does a small slip across change nothing else in the first order.
        let beside = self.light.is_lean() && bends < 0.0 && y.abs() < STRAIGHT;
        let off = turn / bends;
        let way = [x + off * y, y - off * x];
        (off.abs() < if beside { STRAIGHT } else { STRAIGHT_ON }).then_some(Straight {
            way,
            across: off * sigma,
            light,
        })
    }

    /// The rubbing speed: that of the slip, and on a patch also the speed of its edge by the drilling.
    pub fn rubbing<const N: usize>(&self, y: &[f64; N]) -> f64 {
        speed([y[0], y[1]]) + self.patch().map_or(0.0, |patch| patch.radius * y[DRILLING].abs())
    }

    /// Whether the integration ends at these values of its variables.
    pub fn is_over<const N: usize>(&self, y: &[f64; N]) -> bool {
        self.rubbing(y) < STOPPED || self.keeps([y[0], y[1]]).is_some() || self.stays(y).is_some()
    }

    /// Friction and couple per normal impulse of a patch whose slip and drilling keep their ratio, and the normal
    /// impulse in which both stop. This is so in every creep, since along an impact nothing else changes. None if the
    /// ratio changes.
    pub fn stays<const N: usize>(&self, y: &[f64; N]) -> Option<([f64; 3], f64)> {
        let PatchedPoint { radius, row: [m_1, m_2, m_n], about, .. } = self.patch()?;
        let ([x, z], couple) = self.pulls([y[0], y[1]], y[DRILLING], radius);
        let ([faster, aside], [b_1, b_2]) = (self.light.level([x, z]), self.light.couples);
        let drills = radius * (m_1 * x + m_2 * z + m_n + about * couple);
        let rate = Vector3::new(b_1 + faster + m_1 * couple, b_2 + aside + m_2 * couple, drills);
        let way = Vector3::new(y[0], y[1], radius * y[DRILLING]);
        let grows = way.dot(&rate) / way.norm_squared();
        let most = if grows < 0.0 { -1.0 / grows } else { f64::INFINITY };
        // The change across this direction turns the impulse until the slip stops.
        let off = (rate - way * grows).norm() * most.min(1.0);
        (off < STAYS).then_some(([x, z, couple], most))
    }

    /// Whether the slip of a patch is so small that it is the creep which follows from its drilling.
    pub fn creeps<const N: usize>(&self, y: &[f64; N]) -> bool {
        let Some(PatchedPoint { radius, .. }) = self.patch() else { return false };
        let k = patch::slip_for((speed(self.light.pushes(self.light.couples)) / self.rubs.mu).min(1.0));
        k.is_finite() && speed([y[0], y[1]]) <= (1.01 * k + 1e-6) * radius * y[DRILLING].abs()
    }

    /// A bound on the change of the slip by friction, per normal impulse.
    fn eased(&self) -> f64 {
        let [[a, _], [_, b]] = self.light.level;
        self.rubs.mu * (a + b)
    }

    /// Friction over u and its couple, per normal force, on a patch; a user-defined law has no patch.
    fn pulls(&self, [u, v]: [f64; 2], drilling: f64, radius: f64) -> ([f64; 2], f64) {
        let (mu, [share, couple, _]) = (self.rubs.mu, rubs(speed([u, v]), drilling, radius));
        ([-mu * share * u, -mu * share * v], mu * couple)
    }

    /// The impulses per normal impulse that hold the patch at rest: the friction and its couple.
    fn holding(&self, patch: &PatchedPoint) -> [f64; 3] {
        let ([b_1, b_2], [.., m_n]) = (self.light.couples, patch.row);
        let rest = self.inertia(patch).lu().solve(&Vector3::new(-b_1, -b_2, -m_n));
        rest.map_or([f64::NAN; 3], Into::into)
    }

    /// The matrix of the changes of slip and drilling per impulse of friction and of its couple.
    fn inertia(&self, PatchedPoint { row: [m_1, m_2, _], about, .. }: &PatchedPoint) -> Matrix3<f64> {
        let [[a, ab], [_, b]] = self.light.level;
        Matrix3::new(a, ab, *m_1, ab, b, *m_2, *m_1, *m_2, *about)
    }

    /// The friction impulses and their couple, per normal impulse, after slip and drilling of a patch have stopped.
    /// They hold both at rest if static friction of at most `fixed` can do so (true); otherwise they are those of the
    /// one motion that begins (false).
    pub fn after_rest(&self, patch: &PatchedPoint, fixed: f64) -> Option<([f64; 3], bool)> {
        let holds @ [x, y, couple] = self.holding(patch);
        let friction = x.hypot(y);
        if friction <= fixed {
            let PatchShares { couple: grip, .. } = patch::of(patch::slip_for(friction / fixed));
            if couple.abs() <= fixed * patch.radius * grip || fixed == f64::INFINITY {
                return Some((holds, true));
            }
        }
        self.leaves(patch).map(|way| (way, false))
    }

    /// The friction and the couple under which a patch at rest begins to move: those of the motion y = B + G (F, C),
    /// which is unique. F and C depend only on the direction of (u, eps w). The search is for the two angles of this
    /// direction, across the table and from it, and for the speed.
    fn leaves(&self, patch: &PatchedPoint) -> Option<[f64; 3]> {
        let ([b_1, b_2], radius, mu) = (self.light.couples, patch.radius, self.rubs.mu);
        let ways = Vector3::new(1.0, 1.0, 1.0 / radius);
        let heavy = self.inertia(patch).try_inverse()?;
        let driven = heavy * Vector3::new(b_1, b_2, patch.row[2]);
        let way = |alpha: f64, beta: f64| {
            let ((sin, cos), (up, across)) = (alpha.sin_cos(), beta.sin_cos());
            Vector3::new(across * cos, across * sin, up).component_mul(&ways)
        };
        let pulls = |y: &Vector3<f64>| {
            let ([x, z], couple) = self.pulls([y[0], y[1]], y[2], radius);
            Vector3::new(x, z, couple)
        };
        let off = |[alpha, beta, speed]: [f64; 3], more: f64| {
            let y = way(alpha, beta);
            (heavy * y * speed - driven - pulls(&y) * more).component_mul(&ways)
        };
        // Friction that is larger by `more` just holds; there the direction is that in which this friction would be reached.
        // From there on it is followed while friction falls to its own value.
        let ratio = [driven[0].hypot(driven[1]), driven[2].abs() / radius];
        let leans = |beta: f64| {
            let PatchShares { force, couple } = patch::of(1.0 / beta.tan());
            force * ratio[1] - couple * ratio[0]
        };
        let beta = crossing(leans, 0.0, FRAC_PI_2, leans(0.0), leans(FRAC_PI_2));
        let PatchShares { force, couple } = patch::of(1.0 / beta.tan());
        let mut x = [driven[1].atan2(driven[0]), beta.copysign(driven[2]), 0.0];
        let (mut more, mut fall) = (ratio[0].hypot(ratio[1]) / (mu * force.hypot(couple)), 0.5);
        let mut left = MOST_NEWTON;
        loop {
            let next = (more * (1.0 - fall)).max(1.0);
            let mut tried = x;
            let known = loop {
                left = left.checked_sub(1)?;
                let columns = [0, 1, 2].map(|i| {
                    if i == 2 {
                        return (heavy * way(tried[0], tried[1])).component_mul(&ways);
                    }
                    let moved = |by: f64| {
                        off(core::array::from_fn(|k| tried[k] + if k == i { by } else { 0.0 }), next)
                    };
                    (moved(ANGLE_STEP) - moved(-ANGLE_STEP)) / (2.0 * ANGLE_STEP)
                });
                let step = Matrix3::from_columns(&columns).lu().solve(&off(tried, next))?;
                let turns = step[0].abs().max(step[1].abs());
                // A step that turns far, or is no number, is too long.
                if turns.is_nan() || turns >= FARTHEST_TURN {
                    break false;
                }
                tried = core::array::from_fn(|i| tried[i] - step[i]);
                if turns <= if next > 1.0 { ANGLE_STEP } else { f64::EPSILON.sqrt() * ANGLE_STEP } {
                    break tried[2] > 0.0;
                }
            };
            match known {
                true if next == 1.0 => return Some(pulls(&way(tried[0], tried[1])).into()),
                true => (x, more, fall) = (tried, next, 0.9f64.min(1.5 * fall)),
                false => fall *= 0.5,
            }
        }
    }
}

impl Flow<2> for ImpactSlip<'_> {
    type Halt = SlipEnd;
    const TIME: usize = PUSHED;
    const OVER: SlipEnd = SlipEnd::GivenUp;
    const PAUSE: SlipEnd = SlipEnd::GivenUp;
    const ONLY_ENDS: bool = true;

    #[inline(always)]
    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        let sigma = (y[0] * y[0] + y[1] * y[1]).sqrt().max(f64::MIN_POSITIVE);
        let (light, [b_1, b_2]) = (&self.light, self.light.couples);
        if let Some(PatchedPoint { radius, row: [m_1, m_2, m_n], about, .. }) = self.patch() {
            let ([x, z], couple) = self.pulls([y[0], y[1]], y[DRILLING], radius);
            let rubbing = self.rubbing(y).max(f64::MIN_POSITIVE);
            let per = rubbing / (rubbing + self.eased());
            let [faster, aside] = light.level([x, z]);
            all[0] = per * (b_1 + faster + m_1 * couple);
            all[1] = per * (b_2 + aside + m_2 * couple);
            all[DRILLING] = per * (m_1 * x + m_2 * z + m_n + about * couple);
            all[LIFT] = per * (light.normal + light.lifts([x, z]) + m_n * couple);
            (all[P_1], all[P_2], all[COUPLE]) = (per * x, per * z, per * couple);
            (all[PUSHED], all[WORK]) = (per, per * y[LIFT]);
            return;
        }
        let mu = self.rubs.at(sigma);
        let per = 1.0 / (sigma + if self.rubs.law.is_some() { mu } else { 1.0 });
        let pull = [mu * y[0], mu * y[1]];
        let [slows, slows_aside] = light.level(pull);
        all[0] = per * (b_1 * sigma - slows);
        all[1] = per * (b_2 * sigma - slows_aside);
        all[P_1] = -(per * pull[0]);
        all[P_2] = -(per * pull[1]);
        (all[DRILLING], all[COUPLE]) = (0.0, 0.0);
        all[PUSHED] = per * sigma;
        all[LIFT] = per * (light.normal * sigma - light.lifts(pull));
        all[WORK] = per * (y[LIFT] * sigma);
    }

    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; 2] {
        let [falls, rises] = match self.restores {
            None => [place.rate[LIFT], 0.0],
            Some(restored) => [place.rate[restored.number], place.rate[LIFT]],
        };
        let [over, up] = [0, 1].map(|i| self.margin(&place.y, i));
        [Dual { value: over, slope: -falls }, Dual { value: up, slope: rises }]
    }

    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        match (self.restores, i) {
            (None, 0) => -y[LIFT],
            (Some(restored), 0) => restored.left(y),
            (Some(_), _) => y[LIFT] + BARELY_DOWN,
            _ => 1.0,
        }
    }

    fn end(&self, i: usize) -> SlipEnd {
        [SlipEnd::Over, SlipEnd::Falls][i]
    }

    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64 {
        let (sigma, aside) = (self.rubbing(y), y[1].abs());
        // The allowed error is relative to a fast slip, and so small for a slow slip that its direction stays.
        let per_slip = if sigma > 1.0 { 1.0 / (self.tol * sigma) } else { (1.0 / self.tol).max(1e3 / sigma) };
        let per = |i: usize| match i {
            1 if self.patch().is_none() && self.light.is_lean() && aside > STRAIGHT_ON * sigma => {
                per_slip.max(1.0 / (DIES * aside).max(self.tol.min(DYING * aside)))
            }
            0 | 1 => per_slip,
            // A drilling that dies out keeps its direction, too.
            DRILLING => {
                let radius = self.patch().map_or(0.0, |patch| patch.radius);
                (1.0 / (self.tol * y[i].abs().max(1.0))).max(1e3 * radius / sigma)
            }
            // Where a slip jams, impulses are large compared with the normal velocity.
            _ => 1.0 / (self.tol * y[i].abs().max(1.0)),
        };
        made.error(per, N as f64)
    }

    fn fastest<const N: usize>(&self, _: &[f64; N]) -> f64 {
        1.0
    }

    fn first<const N: usize>(&self, _: &[f64; N]) -> f64 {
        FIRST
    }

    /// Along an impact no angle limits the step, so that only the number of steps is limited.
    fn calm<const N: usize>(&self, _: &[f64; N]) -> f64 {
        f64::INFINITY
    }

    fn longest<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        let Some(PatchedPoint { radius, .. }) = self.patch() else {
            if self.rubs.law.is_some() {
                return f64::INFINITY;
            }
            // A direction that attracts is found to rounding by steps in which what is off it decays.
            let (sigma, slip) = (self.rubbing(&place.y), [place.y[0], place.y[1]]);
            let [_, bends, _] = self.light.turning(slip.map(|u| u / sigma), self.rubs.mu);
            return if bends < 0.0 { DECAYING_STEP * (1.0 + sigma) / -bends } else { f64::INFINITY };
        };
        let number = |i: usize| Dual { value: place.y[i], slope: place.rate[i] };
        let [share, ..] = rubs(speed([place.y[0], place.y[1]]), place.y[DRILLING], radius);
        let decays = DECAYING_STEP / (self.eased() * share * place.rate[PUSHED]);
        let radius = Dual { value: radius, slope: 0.0 };
        Rubbing::of([number(0), number(1)], number(DRILLING), radius).longest(self.tol).min(decays)
    }

    fn stopped<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(SlipEnd, [f64; N])> {
        self.is_over(&place.y).then_some((SlipEnd::Straight, place.y))
    }

    fn theta<const N: usize>(&self, _: &[f64; N]) -> f64 {
        f64::NAN
    }
}
