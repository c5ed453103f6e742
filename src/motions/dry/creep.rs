//! A patch of contact along a motion: when it counts as at rest, how fast it creeps, and the steps that it needs.
//! Bodies and stones share this module.
//!
//! ```text
//! S = |u|,   R = eps |w_z|                        the patch rests if S + R <= eps DRILLS, and no longer grows
//! S = R k,   f(k) = F/(mu N)                      the slip of a creep under the force F
//! dt/dsigma < STIFF/3 (3 radians of the turning)  u follows the motion much faster than the body turns
//! a uniform ball:   k stays,   F = mu f(k) = (delta + mu eps^2 k g(k))/(1 + I)
//!                   |w_h|' = -(delta - F)/I,   |w_z|' = -mu eps g(k)/I              under rolling resistance delta
//! ```
//! With a constant k the slip of a ball falls with its drilling, and u' = -F (1 + 1/I) + delta/I has this rate.
//! [`radau`](crate::methods::radau) takes the steps where u is that fast, unless they are too short to pay; at k = 1 the
//! steps are short.
//!
//! Error: `LOST_DRILLING` times the drilling that is left out.

use crate::laws::contact::patch;
use crate::numbers::{Dual, Real};
use nalgebra::SMatrix;

/// Share of the longest step, or of a number, over which a slope is computed.
pub(crate) const ASIDE: f64 = 1e-5;
/// A patch that drills faster than this, in sqrt(g/R), creeps.
pub(crate) const DRILLS: f64 = 1e-10;
/// A contact point that friction has released begins to creep with at most this share of the friction of a slip.
const MOST_CREEP: f64 = 0.999;
/// Steps may be implicit where the body turns by less than this angle in the longest stable explicit step.
const STIFF: f64 = 0.4;
/// The longest stable explicit step, in units of the time in which a friction that is proportional to the slip would stop
/// it.
const STABLE_STEP: f64 = 5.5;
/// An implicit step may be this many times longer than an explicit one, since it amplifies no rounding.
pub(crate) const IMPLICIT_TURNS: f64 = 8.0;
/// Relative error of the drilling due to rounding of w. The slip need not be known more precisely.
const ROUNDED_DRILLING: f64 = 4e-15;
/// The remaining way to rest is a straight line if it takes less than this time, in sqrt(R/g).
const REST_IS_NEAR: f64 = 1e-6;
/// The drilling at which a patch begins to be held, or at which a creep begins, has no friction while it changes from
/// or to zero; the estimated error includes this many times that drilling.
pub(crate) const LOST_DRILLING: f64 = 4.0;
/// Largest number of approximations to the k of a ball, whose error falls by about eps^2 in each of them.
const APPROXIMATIONS: usize = 60;
/// Two of them that differ by less than this share are the same k.
const SAME_K: f64 = 1e-14;
/// A step takes at most this share of the distance to k = 1.
const NEARER_K: f64 = 0.5;

/// The speed below which a patch of this radius counts as at rest.
pub(crate) fn rests_below(radius: f64) -> f64 {
    radius * DRILLS
}

/// The rubbing speeds of a patch: its slip S, and the speed R of its rim by the drilling.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rubbing<T> {
    pub slip: T,
    pub turn: T,
}

impl<T: Real> Rubbing<T> {
    #[inline(always)]
    pub fn of([u, v]: [T; 2], drilling: T, radius: T) -> Self {
        Self { slip: u.mac(u, v * v).sqrt(), turn: radius * drilling.abs() }
    }

    #[inline(always)]
    pub fn speed(&self) -> T {
        self.slip + self.turn
    }
}

impl Rubbing<Dual<f64>> {
    /// Whether a patch of this radius comes to rest. A slip that begins is as slow, but it grows.
    pub fn comes_to_rest(&self, radius: f64) -> bool {
        let speed = self.speed();
        speed.value <= rests_below(radius) && (speed.slope <= 0.0 || speed.value == 0.0)
    }

    /// Distance from rest in the variable of the slopes, by the last slope; 0 if that takes longer than `REST_IS_NEAR`
    /// at the pace dt/dsigma, so that a straight line is no longer exact.
    pub fn left(&self, pace: f64) -> f64 {
        let left = self.speed().value / -self.speed().slope;
        if left * pace <= REST_IS_NEAR { left.max(0.0) } else { 0.0 }
    }

    /// The longest step, in the variable of the slopes. At k = 1 the friction has a term (2 |k - 1|)^(5/2)/5 on one
    /// side only, so that steps become shorter towards k = 1, and a step across k = 1 is so short that this term is
    /// below the tolerance.
    pub fn longest(&self, tol: f64) -> f64 {
        let left = (self.slip.value - self.turn.value).abs();
        let past = (self.slip.slope - self.turn.slope).abs();
        ((NEARER_K * left).max(tol.powf(0.4) * self.speed().value) / past).min(f64::INFINITY)
    }
}

/// Whether u follows the motion much faster than the body turns, from the longest stable time step and the time `calm` of
/// three radians of the turning.
pub(crate) fn is_fast(stable: f64, calm: f64) -> bool {
    stable < STIFF / 3.0 * calm
}

/// The longest time step that is stable although friction stops the slip u of a patch, whose rim moves with the speed R,
/// at the rate `eased` F/|u|. Friction makes `heat` in a unit of time: with mu N f/|u| at most 3 pi mu N/(8 R) and heat
/// 3 pi mu N R/16 where k is small, and mu N/|u| and mu N |u| where it is large, their ratio is known within a fifth.
pub(crate) fn stable_time([u, v, turn]: [f64; 3], heat: f64, eased: f64) -> f64 {
    STABLE_STEP * (u * u + v * v + 0.5 * turn * turn) / (heat * eased)
}

/// The speed of the slip of a patch that rubs with this speed, to which errors of an implicit step are relative; `fast`
/// is the largest speed, and the iteration goes down to the share `converged`.
pub(crate) fn known_slip(rubs: f64, radius: f64, fast: f64, converged: f64) -> f64 {
    rubs + ROUNDED_DRILLING / converged * radius * fast
}

/// The slip of a patch that creeps under this horizontal force, if its rim moves with the speed `turn` and friction is at
/// most `limit`. None if it would count as at rest.
pub(crate) fn slip_under(force: [f64; 2], limit: f64, turn: f64, radius: f64) -> Option<[f64; 2]> {
    let friction = force[0].hypot(force[1]);
    let slip = turn * patch::slip_for((friction / limit).min(MOST_CREEP));
    (friction > 0.0 && slip + turn > rests_below(radius)).then(|| force.map(|f| -(slip / friction * f)))
}

/// A uniform ball that creeps on a patch: its k, and the rates at which the speed of its rolling and its drilling fall.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Creeping {
    pub k: f64,
    pub rates: [f64; 2],
}

impl Creeping {
    /// The creep under friction of this strength on a patch of this radius, and under rolling resistance with the arm
    /// `arm`; None if friction is too weak to slow the ball down with its rolling.
    pub fn under(inertia: f64, [mu, radius, arm]: [f64; 3]) -> Option<Self> {
        let mut k = 0.0;
        for _ in 0..APPROXIMATIONS {
            let couple = mu * radius * patch::of(k)[1];
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

/// The derivatives of the first M rates by the first M numbers, of these sizes, as differences.
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
