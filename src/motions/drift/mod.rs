//! The slow drift of a body along its steady states until it comes to rest, under two different assumptions.
//!
//! ```text
//! rest      theta' = -P/E'(theta),   t = -int E'/P dtheta            the centre held at rest: one line of states
//! rolling   theta' = -F/(J kappa),   F = S_w1 a1 + S_w3 a3           no slip, no nutation: a surface of states
//! ```
//! *Rest* is the drift of Jackson et al., Am. J. Phys. 87, 85 (2019): the centre is held at rest, as slip does below
//! a ridge of the energy, and the body moves to lower energies; above a ridge theta grows. *Rolling* is the drift of
//! a body that never slips. Its losses move the body away from the steady states whose centre is at rest, and nothing
//! brings it back; a ridge has no effect. The drift ends where rolling becomes unstable, kappa = 0. Both are of first
//! order in the losses.
//!
//! Error: 1e-12 of a time at rest and 1e-10 rolling. Up to 0.99 of the time to the end the same bounds hold for the
//! relative errors of theta, w1 and Omega, and for the error of w3 relative to |w|. Where these quantities vary as a
//! high power of the remaining time, the rounding of the time adds to their errors. Tests of `drift` and
//! `test_late_drifts` check these bounds.

pub(crate) mod branch;
pub(crate) mod circular;
pub(crate) mod clock;
pub(crate) mod course;
pub(crate) mod ends;
pub(crate) mod rest;
pub(crate) mod rolling;
pub(crate) mod tail;

use crate::error::{Error, within};
use crate::laws::body::Body;
use crate::laws::loss::Losses;
use crate::laws::state::State;
use course::DriftCourse;
pub use ends::End;
use rest::Rest;

/// A drift that begins at the time 0. Times are in sqrt(R/g), angles in radians, rates in sqrt(g/R).
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Drift {
    kind: DriftVariant,
}

#[derive(Debug, Clone)]
enum DriftVariant {
    Rest(Box<Rest>),
    Rolling(Box<DriftCourse>),
}

/// A time that exceeds the time of the drift's end by at most this fraction counts as the end.
const SLACK: f64 = 1e-9;

impl Drift {
    /// The drift of a body whose centre is kept at rest, from the inclination `theta`. [`Drift::rolling`] is the drift
    /// of a body that rolls.
    ///
    /// ```
    /// use spincyl::drift::{Drift, End};
    /// use spincyl::loss::{Law, Losses};
    /// use spincyl::Body;
    ///
    /// // A thin disk with viscous contour friction obeys cos theta = exp(-2 c tau/(3 I1)).
    /// let drift = Drift::at_rest(&Body::solid(0.0)?, 0.5, &Losses::of(Law::ViscousContour, 1e-3))?;
    /// let exact = -(0.5f64.cos().ln()) * 3.0 * 0.25 / (2.0 * 1e-3);
    /// assert!((drift.stops_at() / exact - 1.0).abs() < 1e-13);
    /// assert_eq!(drift.ended(), End::Face);
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`steady::state`](crate::states::steady::state) and of [`Losses::check_for`]; `OutOfRange` without
    /// losses, for ell above 1e6 and for moments outside 1e-12 to 1e12; `Lost` if the time to the end overflows.
    pub fn at_rest(body: &Body, theta: f64, losses: &Losses) -> Result<Self, Error> {
        check_drift(body, losses)?;
        Ok(Self { kind: DriftVariant::Rest(Box::new(Rest::new(body, theta, losses)?)) })
    }

    /// The drift of a body that rolls, from a steady state whose centre is at rest or moves along a circle.
    ///
    /// # Errors
    /// Those of [`Losses::check_for`]; `OutOfRange` without losses, for ell above 1e6 and for moments outside 1e-12 to
    /// 1e12, for a state that is not steady to six digits, and for one that is unstable in rolling, kappa <= 0; `Lost`
    /// where the drift cannot be computed up to its end.
    pub fn rolling(body: &Body, y: &State, losses: &Losses) -> Result<Self, Error> {
        check_drift(body, losses)?;
        Ok(Self { kind: DriftVariant::Rolling(Box::new(DriftCourse::new(body, y, losses)?)) })
    }

    fn end(&self) -> (End, f64, f64) {
        match &self.kind {
            DriftVariant::Rest(rest) => rest.end(),
            DriftVariant::Rolling(roll) => roll.end(),
        }
    }

    /// The time of the end, in sqrt(R/g); infinite if the drift never ends.
    pub fn stops_at(&self) -> f64 {
        self.end().2
    }

    /// The kind of end that the drift reaches, or approaches without ever reaching it.
    pub fn ended(&self) -> End {
        self.end().0
    }

    /// The inclination at the end, in radians.
    pub fn ends_at_theta(&self) -> f64 {
        self.end().1
    }

    /// The time in sqrt(R/g) until which rolling is stable: 0 if the first state is unstable, infinite if all states are stable.
    pub fn stable_until(&self) -> f64 {
        match &self.kind {
            DriftVariant::Rest(rest) => rest.stable_until(),
            DriftVariant::Rolling(roll) if roll.end().0 == End::StabilityLost => roll.end().2,
            DriftVariant::Rolling(_) => f64::INFINITY,
        }
    }

    /// The first time, in sqrt(R/g), at which the drift reaches an inclination; NaN if the drift never does.
    pub fn time(&self, theta: f64) -> f64 {
        match &self.kind {
            DriftVariant::Rest(rest) => rest.time(theta),
            DriftVariant::Rolling(roll) => roll.time(theta),
        }
    }

    /// The inclination of the drift, in radians, at a time in sqrt(R/g); NaN before time 0 and after the end.
    pub fn theta(&self, t: f64) -> f64 {
        self.at(t).map_or(f64::NAN, |there| there.state.theta)
    }

    /// The precession Omega = phi', in sqrt(g/R), at a time in sqrt(R/g); NaN before time 0 and after the end.
    pub fn precession(&self, t: f64) -> f64 {
        self.at(t).map_or(f64::NAN, |there| there.precession)
    }

    /// The steady state at a time in sqrt(R/g); None before time 0 and after the end.
    pub fn state(&self, t: f64) -> Option<State> {
        self.at(t).map(|there| there.state)
    }

    /// The coefficient of friction that the steady state at a time needs, |V| Omega: 0 where the centre is at rest.
    pub fn friction_coefficient(&self, t: f64) -> f64 {
        self.at(t).map_or(f64::NAN, |there| there.friction_coefficient)
    }

    /// The state of the drift at a time, with its precession and the coefficient of friction that it needs; None
    /// before time 0 and after the end.
    pub(crate) fn at(&self, t: f64) -> Option<DriftState> {
        match &self.kind {
            DriftVariant::Rest(rest) => rest.at(t),
            DriftVariant::Rolling(roll) => roll.at_time(t),
        }
    }
}

/// The state of a drift at a time, with its precession and the coefficient of friction that it needs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DriftState {
    pub state: State,
    pub precession: f64,
    pub friction_coefficient: f64,
}

/// Returns an error if there are no losses, or for a body out of the range for drifts.
pub(crate) fn check_drift(body: &Body, losses: &Losses) -> Result<(), Error> {
    losses.check_for(body)?;
    if losses.is_none() {
        let expected = "at least one law with a positive coefficient: without losses there is no drift";
        return Err(Error::OutOfRange { name: "losses", value: 0.0, expected });
    }
    within("ell", body.ell(), (-1.0, 1e6), "-1 < ell <= 1e6 for a drift")?;
    within("i1", body.i1(), (1e-12, 1e12), "1e-12 <= i1 <= 1e12 for a drift")?;
    within("i3", body.i3(), (1e-12, 1e12), "1e-12 <= i3 <= 1e12 for a drift")?;
    Ok(())
}
