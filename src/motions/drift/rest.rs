//! The slow drift along the steady states with the centre at rest.
//!
//! ```text
//! theta' = -P/E'(theta),   t = -int E'/P dtheta        E and P along the branch of `branch`
//! ```
//! The energy along the branch is that of Jackson et al., Am. J. Phys. 87, 85 (2019), and a drift decreases it; above a
//! ridge of the energy the inclination grows. Slip is assumed to hold the centre at rest. The inclinations of the
//! possible ends are roots of polynomials (`ends`), and the time is a quadrature (`clock`).
//!
//! Error: 1e-13 of the time, also for an initial state next to thetaInf and for an end next to a ridge. A test of
//! `drift` checks this bound.

use super::DriftState;
use super::branch::{BranchPoint, Exact};
use super::clock::{DriftClock, WayPoint};
use super::ends::{End, Goal, goal};
use crate::error::Error;
use crate::laws::body::Body;
use crate::laws::contact::Contact;
use crate::laws::loss::{Couples, Losses};
use crate::laws::state::State;
use crate::states::stability;
use crate::states::steady;
use core::f64::consts::PI;

/// A drift along the steady states whose centre is at rest.
#[derive(Debug, Clone)]
pub(crate) struct Rest {
    path: BranchPath,
    /// The largest coefficient of the losses. Times are computed as multiples of its inverse, so that none overflows.
    largest_coefficient: f64,
    clock: DriftClock,
    stable_until: f64,
}

/// The branch of steady states up to the end of a drift.
#[derive(Debug, Clone, Copy)]
struct BranchPath {
    of: Exact,
    goal: Goal,
    /// 1 if the inclination grows, -1 if it falls.
    way: f64,
}

impl BranchPath {
    #[inline(never)]
    fn at(&self, spot: &WayPoint) -> BranchPoint<f64> {
        // Close to theta0 the terms keep their digits if they follow from the distance to theta0.
        self.of.at(match spot.left {
            Some(left) if self.goal.end == End::Balanced => {
                self.of.angle_below_balance(spot.theta, self.way * left)
            }
            _ => self.of.angle_at(spot.theta),
        })
    }

    /// Returns a function that computes |dt/dtheta| and the size of the terms of which it is the sum.
    fn slowness(&self) -> impl Fn(&WayPoint) -> [f64; 2] {
        |spot| {
            let local = self.at(spot);
            [(local.slope / local.power).abs(), (local.size / local.power).abs()]
        }
    }
}

impl Rest {
    pub fn new(body: &Body, theta: f64, losses: &Losses) -> Result<Self, Error> {
        let mut rest = Self::unwatched(body, theta, losses)?;
        if stability::at_rest(body, theta, Contact::Rolling) > 0.0 {
            let times = stability::boundaries(body, Contact::Rolling).map(|x| rest.time(x));
            rest.stable_until = times.into_iter().filter(|t| !t.is_nan()).fold(f64::INFINITY, f64::min);
        }
        Ok(rest)
    }

    /// The drift without the time `stable_until`, which needs a search for the limits of stability.
    pub fn unwatched(body: &Body, theta: f64, losses: &Losses) -> Result<Self, Error> {
        steady::state(body, theta)?;
        let largest_coefficient =
            losses.coefficients.iter().fold(0f64, |largest_coefficient, x| largest_coefficient.max(*x));
        let of = Exact::new(body, Couples::of(losses, |x| x / largest_coefficient));
        let down = of.at(of.angle_at(theta.into())).slope >= 0.0;
        let goal = goal(&of, losses, theta, down);
        let several = losses.coefficients.iter().filter(|x| **x > 0.0).count() > 1;
        let edges = [0.0, PI, body.theta_balance(), body.theta_limit()];
        let behind = edges.into_iter().map(|x| if down { x - theta } else { theta - x });
        let behind = behind.filter(|x| *x > 0.0).fold(1.0, f64::min);
        let path = BranchPath { of, goal, way: if down { -1.0 } else { 1.0 } };
        if let Some(clock) = DriftClock::new(theta, goal, behind, several, &path.slowness()) {
            return Ok(Self { path, largest_coefficient, clock, stable_until: 0.0 });
        }
        if !several {
            return Err(Error::Lost { theta });
        }
        // A second, very small loss can make the time overflow next to the end, and has no effect elsewhere;
        // so the smallest loss is left out.
        let least = losses
            .coefficients
            .iter()
            .filter(|x| **x > 0.0)
            .fold(largest_coefficient, |least, x| least.min(*x));
        let coefficients = losses.coefficients.map(|x| if x == least { 0.0 } else { x });
        Self::unwatched(body, theta, &Losses { coefficients })
    }

    /// The end of the drift, its inclination and its time.
    pub fn end(&self) -> (End, f64, f64) {
        (self.path.goal.end, self.path.goal.theta.hi, self.clock.time_to_goal() / self.largest_coefficient)
    }

    /// The first time at which kappa of rolling vanishes: 0 for an unstable start, infinite if kappa stays positive.
    pub fn stable_until(&self) -> f64 {
        self.stable_until
    }

    pub fn time(&self, theta: f64) -> f64 {
        self.clock.time(theta, &self.path.slowness()) / self.largest_coefficient
    }

    pub fn at(&self, t: f64) -> Option<DriftState> {
        let spot = self.clock.point_at_time(t * self.largest_coefficient)?;
        let theta = spot.theta.hi;
        if self.path.goal.end == End::Face && spot.left == Some(0.0) {
            // At the face w1 = Omega sin theta vanishes as the square root of theta.
            return Some(drift_state(State { theta, w1: 0.0, w2: 0.0, w3: 0.0 }, f64::INFINITY));
        }
        let BranchPoint { turning: [w1, w3], rate, .. } = self.path.at(&spot);
        Some(drift_state(State { theta, w1, w2: 0.0, w3 }, rate))
    }
}

fn drift_state(state: State, precession: f64) -> DriftState {
    DriftState { state, precession, friction_coefficient: 0.0 }
}
