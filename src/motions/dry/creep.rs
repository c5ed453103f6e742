//! A patch of contact during a motion: when it counts as at rest, how fast it creeps, the steps that it needs, and
//! the drilling that static friction holds at rest. Bodies and stones share this module: their equations give the
//! slip, the drilling rate, and the derivatives of their rates ([`Creeps`]).
//!
//! ```text
//! S = |u|,   R = eps |w_z|                        the patch rests if S + R <= eps DRILLS, and no longer grows
//! S = R k,   f(k) = F/(mu N)                      the slip of a creep under the force F
//! dt/dsigma < STIFF/3 (3 radians of the turning)  u follows the motion much faster than the body turns
//! |M| <= mu_s N eps g(k),   f(k) = F/(mu_s N)     holds the drilling while the contact point is at rest
//! |w_z| = 2 DRILLS, or F = mu_s N                 begins to slip, with the slip of the creep
//! a uniform ball:   k stays,   F = mu f(k) = (delta + mu eps^2 k g(k))/(1 + I)
//!                   |w_h|' = -(delta - F)/I,   |w_z|' = -mu eps g(k)/I              under rolling resistance delta
//! ```
//! With a constant k the slip of a ball falls in proportion to its drilling, and u' = -F (1 + 1/I) + delta/I agrees
//! with this. Where u follows the motion fast, [`radau`](crate::methods::radau) takes implicit steps, unless they are
//! too short to save work; near k = 1 the steps are short.
//!
//! Where the drilling rate passes zero and friction does not hold it, the contact point is at rest, and the couple
//! acts so briefly that it is left out.
//!
//! Error: `LOST_DRILLING` times the drilling rate whose friction is left out.

use crate::laws::contact::patch::{self, Rubbing};
use crate::methods::flow::{Flow, FlowPlace};
use crate::methods::{radau, rk8};
use crate::motions::walk::numbers::{Halt, TIME};
use crate::numbers::{Dual, Real};
use nalgebra::{Const, DimMin, SMatrix, ToTypenum};

/// Share of the longest step, or of a component, over which a slope is computed by differences.
pub(crate) const ASIDE: f64 = 1e-5;
/// A patch of contact creeps if it drills faster than this, in sqrt(g/R).
pub(crate) const DRILLS: f64 = 1e-10;
/// A contact point that friction has released begins to creep with at most this share of the friction of a slip.
const MOST_CREEP: f64 = 0.999;
/// Steps may be implicit where the body turns by less than this angle in the longest stable explicit step.
const STIFF: f64 = 0.4;
/// The longest stable explicit step, in units of the time in which friction proportional to the slip would stop it.
const STABLE_STEP: f64 = 5.5;
/// An implicit step may be this many times longer than an explicit one, since it amplifies no rounding.
pub(crate) const IMPLICIT_TURNS: f64 = 8.0;
/// Relative error of the drilling rate due to rounding of w. An implicit step need not compute the slip more
/// precisely.
const ROUNDED_DRILLING: f64 = 4e-15;
/// The last part of a motion to rest is extrapolated linearly if it takes less than this time, in sqrt(R/g).
const REST_IS_NEAR: f64 = 1e-6;
/// A patch whose drilling begins or stops has no friction while the drilling rate changes from or to zero; the
/// estimated error includes this many times that rate.
pub(crate) const LOST_DRILLING: f64 = 4.0;
/// Largest coefficient of static friction in a couple; an infinite one times zero would be NaN.
const STICKY: f64 = 1e9;
/// Largest number of approximations to the k of a ball, whose error falls by about eps^2 in each of them.
const APPROXIMATIONS: usize = 60;
/// Two successive approximations to k count as equal if they differ by less than this share.
const SAME_K: f64 = 1e-14;

/// The speed below which a patch of this radius counts as at rest.
pub(crate) fn rests_below(radius: f64) -> f64 {
    radius * DRILLS
}

/// A patch of contact at rest: its coefficients of static friction, which may be infinite, and of sliding friction,
/// and its radius.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RestingPatch {
    pub fixed: f64,
    pub slides: f64,
    pub radius: f64,
}

impl RestingPatch {
    /// The couple per normal force that can hold the drilling together with this friction force.
    pub fn grips(&self, friction: f64, normal: f64) -> f64 {
        let mu = self.fixed.min(STICKY);
        let share = friction / (mu * normal.max(f64::MIN_POSITIVE));
        mu * self.radius * patch::of(patch::slip_for(share.min(1.0))).couple
    }

    /// The slip with which a drilling patch begins to creep under this horizontal force; None if it would count as at
    /// rest.
    pub fn begins_to_creep(&self, force: [f64; 2], normal: f64, drilling: f64) -> Option<[f64; 2]> {
        let (friction, turn) = (force[0].hypot(force[1]), self.radius * drilling.abs());
        let slip = turn * patch::slip_for((friction / (self.slides * normal)).min(MOST_CREEP));
        (friction > 0.0 && slip + turn > rests_below(self.radius))
            .then(|| force.map(|f| -(slip / friction * f)))
    }
}

/// A quantity that is positive as long as the patch does not drill, so that the contact point is at rest.
#[inline(always)]
pub(crate) fn hardly_drills<T: Real>(drilling: T) -> T {
    let drilling = drilling.abs();
    drilling.splat(2.0 * DRILLS) - drilling
}

impl Rubbing<Dual<f64>> {
    /// Whether a patch of this radius comes to rest: it is slow, and its speed does not grow as that of a slip that
    /// begins.
    pub fn comes_to_rest(&self, radius: f64) -> bool {
        let speed = self.speed();
        speed.value <= rests_below(radius) && (speed.slope <= 0.0 || speed.value == 0.0)
    }

    /// Distance from rest in the variable sigma of the slopes, by the last slope; 0 if it takes longer than
    /// `REST_IS_NEAR` at the pace dt/dsigma, so that linear extrapolation is not accurate.
    pub fn left(&self, pace: f64) -> f64 {
        let left = self.speed().value / -self.speed().slope;
        if left * pace <= REST_IS_NEAR { left.max(0.0) } else { 0.0 }
    }
}

/// A phase on a patch of contact, whose slip creeps as long as the patch drills. The equations of a body or of a
/// stone, with M margins, give the R components of the state vector that depend on each other; the rest of the
/// computation is the same for both.
pub(crate) trait Creeps<const M: usize, const R: usize>: Flow<M, Halt = Halt>
where
    Const<R>: ToTypenum + DimMin<Const<R>, Output = Const<R>>,
{
    /// Index of the slip's first component in the state vector; `HEAT` is that of the heat.
    const SLIP: usize;
    const HEATED: usize;

    /// The radius of the patch; None for a point.
    fn radius(&self) -> Option<f64>;
    /// The tolerance of an integration step.
    fn allowed(&self) -> f64;
    /// The slip u in the state vector.
    fn sliding<T: Real, const N: usize>(y: &[T; N]) -> [T; 2];
    /// The drilling rate: w_z relative to the table.
    fn drilling<T: Real, const N: usize>(&self, y: &[T; N]) -> T;
    /// The largest acceleration of the slip by a unit of force.
    fn eased<const N: usize>(&self, y: &[f64; N]) -> f64;
    /// The sizes of the components that depend on each other: `fast` for speeds, `slip` for the slip, and those of
    /// angles.
    fn sizes<const N: usize>(y: &[f64; N], fast: f64, slip: f64) -> [f64; R];
    /// The derivatives (Jacobian) of the rates of the components that depend on each other.
    fn reacting<const N: usize>(&self, y: &[f64; N], sizes: &[f64; R]) -> SMatrix<f64, R, R>;
    /// The longest time step that components other than the slip allow where they decay fast towards a slow motion.
    fn damps_within<const N: usize>(&self, _: &[f64; N]) -> f64 {
        f64::INFINITY
    }

    /// The speed of the slip; for a patch of contact combined with that of its rim by the drilling.
    #[inline(never)]
    fn rubs<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let [u, v] = Self::sliding(y);
        let on = |radius| Rubbing::of([u, v], self.drilling(y), radius).speed();
        self.radius().map_or(u.hypot(v), on)
    }

    /// The speeds of slip and rim of the patch, with slopes in sigma; None for a point.
    fn rubbing<const N: usize>(&self, place: &FlowPlace<N>) -> Option<Rubbing<Dual<f64>>> {
        let radius = Dual { value: self.radius()?, slope: 0.0 };
        let y: [Dual<f64>; N] = core::array::from_fn(|i| Dual { value: place.y[i], slope: place.rate[i] });
        Some(Rubbing::of(Self::sliding(&y), self.drilling(&y), radius))
    }

    /// The halt of a patch that has stopped slipping and drilling; else None.
    #[inline(never)]
    fn hardly_rubs<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(Halt, [f64; N])> {
        let (radius, rubbing) = (self.radius()?, self.rubbing(place)?);
        let left = rubbing.left(place.rate[TIME]);
        let mut rests: [f64; N] = core::array::from_fn(|i| place.y[i] + left * place.rate[i]);
        (rests[Self::SLIP], rests[Self::SLIP + 1]) = (0.0, 0.0);
        rubbing.comes_to_rest(radius).then(|| (Halt::Standstill, self.kept(rests)))
    }

    /// The longest step in sigma towards and past k = S/R = 1, where the law of friction is not smooth.
    #[inline(never)]
    fn kinked<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        self.rubbing(place).map_or(f64::INFINITY, |rubbing| rubbing.longest(self.allowed()))
    }

    /// Whether the slip grows. Under a user-defined law a slip has no power series: the smaller it begins, the faster
    /// it approaches its direction.
    #[inline(always)]
    fn slip_grows<const N: usize>(place: &FlowPlace<N>) -> bool {
        let ([u, v], [du, dv]) = (Self::sliding(&place.y), Self::sliding(&place.rate));
        u * du + v * dv > 0.0
    }

    /// Whether the slip u follows the motion much faster than the body turns.
    #[inline(never)]
    fn creeps_fast<const N: usize>(&self, place: &FlowPlace<N>) -> bool {
        self.follows_within(place) < STIFF / 3.0 * self.calm(&place.y)
    }

    /// The longest time step that is stable although friction stops the slip u of a patch, whose rim moves with the
    /// speed R, at the rate `eased` F/|u|. The rate follows, to within a fifth, from the power of friction: F/|u| is
    /// at most 3 pi mu N/(8 R) with the power 3 pi mu N R/16 where k is small, and mu N/|u| with the power mu N |u|
    /// where k is large.
    fn follows_within<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        let (y, rate) = (&place.y, &place.rate);
        let ([u, v], turn) = (Self::sliding(y), self.radius().unwrap_or(0.0) * self.drilling(y));
        let heat = rate[Self::HEATED] / rate[TIME];
        let stable = STABLE_STEP * (u * u + v * v + 0.5 * turn * turn) / (heat * self.eased(y));
        self.damps_within(y).min(stable)
    }

    /// Makes an implicit step with its stages. The error of the slip is relative to the speed of slip and rim.
    fn creeps_on<const N: usize>(
        &self,
        from: &FlowPlace<N>,
        h: f64,
        guess: radau::Guess<N>,
    ) -> (rk8::Step<f64, N>, radau::Collocated<N>) {
        let y = &from.y;
        let (fast, converged) = (self.fastest(y), 0.01 * self.allowed());
        let slip = self.rubs(y) + ROUNDED_DRILLING / converged * self.radius().unwrap_or(0.0) * fast;
        let sizes = Self::sizes(y, fast, slip);
        let slopes = self.reacting(&radau::middle(y, &guess), &sizes);
        radau::step(|y, all| self.write_rates(y, all), y, &slopes, &sizes, (h, converged), guess)
    }
}

/// A uniform ball that creeps on a patch: the ratio k of slip to rim speed, and the rates at which its rolling and
/// drilling slow down.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Creeping {
    pub k: f64,
    pub rates: [f64; 2],
}

impl Creeping {
    /// The creep of a ball under friction with the coefficient `mu` on a patch of this radius, and under rolling
    /// resistance with the arm `arm`; None if friction is too weak to slow the ball down together with its rolling.
    pub fn under(inertia: f64, [mu, radius, arm]: [f64; 3]) -> Option<Self> {
        let mut k = 0.0;
        for _ in 0..APPROXIMATIONS {
            let couple = mu * radius * patch::of(k).couple;
            let force = (arm + radius * couple * k) / (1.0 + inertia);
            if force >= mu {
                return None;
            }
            let next = patch::slip_for(force / mu);
            if (next - k).abs() <= SAME_K * k {
                return Some(Self { k, rates: [(arm - force) / inertia, couple / inertia] });
            }
            k = next;
        }
        None
    }
}

/// The derivatives (Jacobian) of R rates with respect to the first R components, by dual numbers.
pub(crate) fn derivatives<const R: usize, const N: usize>(
    y: &[f64; N],
    rates: impl Fn([Dual<f64>; R]) -> [Dual<f64>; R],
) -> SMatrix<f64, R, R> {
    let mut all = SMatrix::zeros();
    for j in 0..R {
        let rates = rates(core::array::from_fn(|i| Dual { value: y[i], slope: f64::from(u8::from(i == j)) }));
        (0..R).for_each(|i| all[(i, j)] = rates[i].slope);
    }
    all
}

/// The derivatives (Jacobian) of the first M rates with respect to the first M components, of these sizes, by
/// differences.
pub(crate) fn slopes<const N: usize, const M: usize>(
    y: &[f64; N],
    sizes: &[f64; M],
    rates: impl Fn(&[f64; N]) -> [f64; N],
) -> SMatrix<f64, M, M> {
    let mut slopes = SMatrix::zeros();
    for j in 0..M {
        let (mut more, mut less) = (*y, *y);
        (more[j], less[j]) = (y[j] + ASIDE * sizes[j], y[j] - ASIDE * sizes[j]);
        let [above, below] = [rates(&more), rates(&less)];
        (0..M).for_each(|i| slopes[(i, j)] = (above[i] - below[i]) / (more[j] - less[j]));
    }
    slopes
}
