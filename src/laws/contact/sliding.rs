//! The slip of a contact point along an impact, followed by steps of a flow.
//!
//! ```text
//! y = (u_1, u_2, P_1, P_2, p, u_n, work)        dp = |u|/(|u| + k) dx, in which nothing is singular
//! u' = b |u| - mu A u,   P' = -mu u,   p' = |u|,   u_n' = a_n |u| - mu b.u,   work' = u_n |u|       all over |u| + k
//! compression ends where u_n = 0, the impact where the work since then is e^2 times that of compression
//! ```
//! [`Delassus`] has A, b and a_n. All velocities are in units of the first normal velocity, or of the slip where that is zero.
//! The time of this flow is p. The coefficient mu is constant, with k = 1, or a function of the speed, with k = mu, since mu
//! may vanish with the speed.
//!
//! Error: the tolerance of the steps.

use super::delassus::{Delassus, speed};
use crate::methods::flow::{Flow, FlowPlace};
use crate::methods::rk8;
use crate::numbers::Dual;

/// A slip slower than this share of the speed, or of the normal velocity, counts as zero.
pub(super) const STOPPED: f64 = 1e-15;
/// Below this angle from it, a slip along the lean keeps its direction up to the square of the angle; and the angle below
/// which any slip keeps one, also where the angle grows as the slip dies out.
const STRAIGHT: f64 = 1e-8;
const STRAIGHT_ON: f64 = 1e-14;
/// The error of a slip across the lean is at most this share of the slip, so that a slip that lasts long can die out; and
/// the share where that is less than the tolerance, below which no error counts.
const DIES: f64 = 1e-6;
const DYING: f64 = 1e-3;
/// A normal velocity that counts as falling again: restitution begins with zero.
const BARELY_DOWN: f64 = 1e-9;
/// The first step along an impact.
pub(super) const FIRST: f64 = 0.3;

/// The places of the numbers of the slip after u: the impulse so far, the normal velocity, and the work of the normal force.
const P_1: usize = 2;
const P_2: usize = 3;
const PUSHED: usize = 4;
pub(super) const LIFT: usize = 5;
pub(super) const WORK: usize = 6;

/// The reason for which a slip along an impact is followed no further.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum SlipEnd {
    /// Compression ends, or restitution.
    Over,
    /// Friction presses the point down again before restitution ends.
    Falls,
    /// It stops, or keeps its direction from here on.
    Straight,
    /// It takes too many steps.
    GivenUp,
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

/// The slip of a contact point along an impact.
#[derive(Clone, Copy)]
pub(super) struct ImpactSlip<'a> {
    pub light: Delassus,
    pub rubs: Roughness<'a>,
    /// The work that is restored from the end of compression on; None in compression.
    pub restores: Option<f64>,
    pub tol: f64,
}

/// A direction that a slip keeps.
pub(super) struct Straight {
    pub way: [f64; 2],
    /// The slip across that direction, which dies out, and its speed per impulse across.
    pub across: f64,
    pub light: f64,
}

impl ImpactSlip<'_> {
    /// The direction that this slip keeps; None if it turns, or has stopped.
    pub fn keeps(&self, slip: [f64; 2]) -> Option<Straight> {
        let sigma = speed(slip);
        if self.rubs.law.is_some() || sigma < STOPPED {
            return None;
        }
        let way @ [x, y] = slip.map(|u| u / sigma);
        let [turn, bends, light] = self.light.turning(way, self.rubs.mu);
        if turn.abs() < STOPPED {
            return Some(Straight { way, across: 0.0, light });
        }
        // Only beside the lean a slip across changes nothing else in the first order.
        let beside = self.light.is_lean() && bends < 0.0 && y.abs() < STRAIGHT;
        let off = turn / bends;
        let way = [x + off * y, y - off * x];
        (off.abs() < if beside { STRAIGHT } else { STRAIGHT_ON }).then_some(Straight {
            way,
            across: off * sigma,
            light,
        })
    }

    /// Whether the steps end at this slip.
    pub fn is_over(&self, slip: [f64; 2]) -> bool {
        speed(slip) < STOPPED || self.keeps(slip).is_some()
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
        let (mu, light) = (self.rubs.at(sigma), &self.light);
        let per = 1.0 / (sigma + if self.rubs.law.is_some() { mu } else { 1.0 });
        let pull = [mu * y[0], mu * y[1]];
        let ([slows, slows_aside], [b_1, b_2]) = (light.level(pull), light.couples);
        all[0] = per * (b_1 * sigma - slows);
        all[1] = per * (b_2 * sigma - slows_aside);
        all[P_1] = -(per * pull[0]);
        all[P_2] = -(per * pull[1]);
        all[PUSHED] = per * sigma;
        all[LIFT] = per * (light.normal * sigma - light.lifts(pull));
        all[WORK] = per * (y[LIFT] * sigma);
    }

    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; 2] {
        let [falls, rises] = if self.restores.is_none() {
            [place.rate[LIFT], 0.0]
        } else {
            [place.rate[WORK], place.rate[LIFT]]
        };
        let [over, up] = [0, 1].map(|i| self.margin(&place.y, i));
        [Dual { value: over, slope: -falls }, Dual { value: up, slope: rises }]
    }

    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        match (self.restores, i) {
            (None, 0) => -y[LIFT],
            (Some(work), 0) => work - y[WORK],
            (Some(_), _) => y[LIFT] + BARELY_DOWN,
            _ => 1.0,
        }
    }

    fn end(&self, i: usize) -> SlipEnd {
        [SlipEnd::Over, SlipEnd::Falls][i]
    }

    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64 {
        let (sigma, aside) = (speed([y[0], y[1]]), y[1].abs());
        // The error is relative to a fast slip, and so small for a slow slip that its direction stays.
        let per_slip = if sigma > 1.0 { 1.0 / (self.tol * sigma) } else { (1.0 / self.tol).max(1e3 / sigma) };
        let per = |i: usize| match i {
            1 if self.light.is_lean() && aside > STRAIGHT_ON * sigma => {
                per_slip.max(1.0 / (DIES * aside).max(self.tol.min(DYING * aside)))
            }
            0 | 1 => per_slip,
            // A jam makes impulses that are large compared with the fall.
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

    /// Nothing turns or nods along an impact, so that only the number of steps is limited.
    fn calm<const N: usize>(&self, _: &[f64; N]) -> f64 {
        f64::INFINITY
    }

    fn longest<const N: usize>(&self, _: &FlowPlace<N>) -> f64 {
        f64::INFINITY
    }

    fn stopped<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(SlipEnd, [f64; N])> {
        self.is_over([place.y[0], place.y[1]]).then_some((SlipEnd::Straight, place.y))
    }

    fn theta<const N: usize>(&self, _: &[f64; N]) -> f64 {
        f64::NAN
    }
}
