//! Angles and contact point of an exact motion at any time, and their change over a whole nutation.
//!
//! ```text
//! phi(m T + t)  = m phi_T + phi(t),   the same for psi
//! zeta(m T + t) = W (e^(i m phi_T) - 1)/(e^(i phi_T) - 1) + e^(i m phi_T) zeta(t)      contact point, zeta = x + i y
//! W = zeta(T/2) - e^(i phi_T) conj(zeta(T/2))
//! ```
//! Time counts from the lower turning point, where phi = 0 and zeta = 0; phi(-t) = -phi(t) and zeta(-t) = conj zeta(t).
//! The head of [`exact`](super) has the integrals over half a swing.

use super::{LegPoint, Swing};
use crate::laws::contact::Contact;
use crate::laws::pose::{Angle, Pose};
use crate::numbers::{Sum, larger_or_nan};
use nalgebra::{Complex, Point2};

/// The angles by which a body turns in a whole nutation, in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct AnglesPerPeriod {
    /// The angle phi of precession.
    pub precession: f64,
    /// The angle psi of spin.
    pub spin: f64,
}

/// The drift of the contact point from one nutation to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactDrift {
    /// Displacement of the contact point over a whole nutation from the start, in R.
    pub step: f64,
    /// Radius, in R, of the circle on which the contact point lies after each whole nutation; infinite for a straight line.
    pub radius: f64,
}

impl Swing {
    /// The angles by which the body turns in a whole nutation; None without a period or a pose.
    pub fn angles_per_period(&self) -> Option<AnglesPerPeriod> {
        self.turns_per_period().map(|[precession, spin]| AnglesPerPeriod { precession, spin })
    }

    /// The changes of phi and psi in a whole nutation, in radians.
    pub(super) fn turns_per_period(&self) -> Option<[f64; 2]> {
        if self.period().is_infinite() {
            return None;
        }
        if self.is_steady() {
            return Some([self.start.precession() * self.period(), self.start.spin() * self.period()]);
        }
        self.has_pose().then(|| self.half_nutation.turns.map(|half| 2.0 * half))
    }

    /// The drift of the contact point in a whole nutation; None without a period or a pose.
    pub fn drift(&self) -> Option<ContactDrift> {
        let [turn, _] = self.turns_per_period()?;
        let step = self.pose(self.period())?.contact_point.coords.norm();
        Some(ContactDrift { step, radius: step / (2.0 * (0.5 * turn).sin().abs()) })
    }

    /// Whether the integrals of the angles have been prepared.
    fn has_pose(&self) -> bool {
        self.legs.iter().all(|leg| leg.turns.is_some())
    }

    /// Angles and contact point at time `t`; None without prepared angles or after the face has landed.
    pub fn pose(&self, t: f64) -> Option<Pose> {
        if self.is_steady() {
            let angle = |rate: f64| Angle::of(Sum::product(rate, t));
            let (phi, psi) = (angle(self.start.precession()), angle(self.start.spin()));
            return Some(Pose { phi, psi, contact_point: self.position(t)?, height: 0.0 });
        }
        if self.landing(t).is_some_and(|(limit, _)| t.abs() > limit) {
            return None;
        }
        let now = self.phase_at(t);
        let turned =
            |spot: LegPoint, time: f64| Some(self.legs[spot.leg].turns(spot.v)?.map(|x| x * sign(time)));
        let (start, here) = (turned(self.at_start, self.phase)?, turned(now.spot, now.time)?);
        let angle = |i: usize| {
            let half_nutation = Sum::product(now.periods, 2.0 * self.half_nutation.turns[i]);
            Angle::of(half_nutation.plus(Sum::of(here[i], -start[i])))
        };
        let (phi, psi) = (angle(0), angle(1));
        let place = |spot: LegPoint, time: f64| {
            let [x, y] = self.legs[spot.leg].path(spot.v)?;
            Some(Complex::new(x, y * sign(time)))
        };
        let contact = match (place(self.at_start, self.phase), place(now.spot, now.time)) {
            (Some(from), Some(to)) => {
                // After m periods the path is the first one rotated by m times the angle of a period. Whole turns of
                // this angle are removed first, which keeps its digits.
                let turn = Angle::of(Sum::from(2.0 * self.half_nutation.turns[0])).rest;
                let half_nutation = Angle::of(Sum::product(now.periods, turn)).rest;
                let half = (0.5 * turn).sin();
                let sum = if half == 0.0 {
                    Complex::new(now.periods, 0.0)
                } else {
                    let middle = Angle::of(Sum::product(now.periods - 1.0, 0.5 * turn)).rest;
                    let ends = Angle::of(Sum::product(now.periods, 0.5 * turn)).rest;
                    Complex::from_polar(ends.sin() / half, middle)
                };
                let there =
                    self.displacement_per_period(turn) * sum + Complex::from_polar(1.0, half_nutation) * to;
                // Displacements are measured along the axes of the start.
                let moved = (there - from) * Complex::from_polar(1.0, -start[0]);
                Point2::new(moved.re + 0.0, moved.im + 0.0)
            }
            _ => Pose::contact_point_below_centre(&self.body, &self.start, &self.state(t), phi.rest),
        };
        Some(Pose { phi, psi, contact_point: contact, height: 0.0 })
    }

    /// The contact point's displacement over one period from the lower turning point, where phi = 0.
    fn displacement_per_period(&self, turn: f64) -> Complex<f64> {
        let [x, y] = self.half_nutation.path;
        let half = Complex::new(x, y);
        half - Complex::from_polar(1.0, turn) * half.conj()
    }

    /// The contact point of a steady state at time `t`.
    fn position(&self, t: f64) -> Option<Point2<f64>> {
        let y = &self.start;
        let phi = Angle::of(Sum::product(y.precession(), t)).rest;
        if self.contact == Contact::Smooth {
            return Some(Pose::contact_point_below_centre(&self.body, y, y, phi));
        }
        let chord = if y.w1 == 0.0 { t } else { 2.0 * (0.5 * phi).sin() / y.precession() };
        let radius = self.lines.law.shape.rim.radius(y.theta.sin_cos());
        let moved = Complex::from_polar(radius * y.spin() * chord, 0.5 * phi) * Complex::i();
        Some(Point2::new(moved.re, moved.im))
    }

    /// Estimated error of the pose at time `t`: angles in radians, contact point in R.
    pub fn pose_error(&self, t: f64) -> f64 {
        if self.is_steady() {
            let rate = self.start.precession().abs() + self.start.spin().abs();
            let turned = rate * t.abs() * f64::EPSILON + self.error(t) * (1.0 + t.abs());
            return turned * self.lever();
        }
        let phase = self.phase_at(t);
        let y = self.state_at(phase.spot, phase.time >= 0.0);
        let rate = y.precession().abs().max(y.spin().abs());
        let [phi_doubt, psi_doubt] =
            if self.has_pose() { self.half_nutation.turns_doubt } else { [f64::NAN; 2] };
        let angles = self.turns_per_period().map_or(0.0, |[phi, psi]| phi.abs().max(psi.abs()));
        let halves = 2.0 * (2.0 + phase.periods.abs());
        let turned = halves * (larger_or_nan(phi_doubt, psi_doubt) + 0.5 * f64::EPSILON * angles);
        let [x_doubt, y_doubt] = self.half_nutation.path_doubt;
        // An error of the angle moves the contact point in proportion to its distance from the centre of its path.
        let there = self.pose(t).map_or(0.0, |pose| pose.contact_point.coords.norm());
        let path = self.lever()
            + there
            + self
                .drift()
                .map_or(0.0, |ContactDrift { step, radius }| radius.min(step * phase.periods.abs()));
        (rate * self.time_doubt(&phase, t) + turned + 4.0 * f64::EPSILON) * path
            + halves * x_doubt.hypot(y_doubt)
            + self.error(t) * self.lever()
    }

    /// Bound of the distance, in R, by which a radian of phi moves the contact point. On a smooth table the contact
    /// point circles below the centre of mass, at a distance that grows with ell.
    fn lever(&self) -> f64 {
        if self.contact == Contact::Smooth { 1.0 + self.body.ell().abs() } else { 1.0 }
    }
}

fn sign(x: f64) -> f64 {
    if x < 0.0 { -1.0 } else { 1.0 }
}
