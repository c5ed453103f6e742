//! The pose of a body: orientation, contact path and centre. A pose is computed only on request.
//!
//! ```text
//! phi' = w1/sin theta,   psi' = w3 - w1 cot theta
//! contact point, rolling:  x' = -A psi' sin phi - rho theta' cos phi
//!                          y' =  A psi' cos phi - rho theta' sin phi
//! smooth: below the centre at rest,   (x, y) - g (cos phi, sin phi) = const
//! axes of the body = Rz(phi) Ry(-theta) Rz(psi)
//! ```
//! Motions start at phi = psi = 0 with the contact point at the origin: e2 = y, and e1 leans toward +x.
//! Angles are kept as whole turns and a remainder, so that a long motion loses no digits of the direction:
//! `rest` adds 1e-16 to the error of the angle.
//!
//! ```
//! use spincyl::{Body, State, pose::Pose};
//!
//! let coin = Body::solid(0.0)?;
//! let centre = Pose::start().centre(&coin, &State { theta: 0.5, w1: 0.0, w2: 0.0, w3: 0.0 });
//! assert!((centre.z - 0.5f64.sin()).abs() < 1e-15); // half as high as the top of the coin
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::body::Body;
use super::state::State;
use crate::numbers::Sum;
use core::f64::consts::{PI, TAU};
use nalgebra::{Point2, Point3, UnitQuaternion, Vector3};

/// The difference of 2 pi and the double TAU.
const TAU_LO: f64 = 2.449_293_598_294_706_4e-16;

/// An angle as whole turns and a remainder.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Angle {
    /// The number of whole turns, an integer.
    pub turns: f64,
    /// The remainder, in [-pi, pi], in radians.
    pub rest: f64,
}

impl Angle {
    /// The whole turns and the remainder of an angle that is given as an unevaluated sum.
    pub(crate) fn of(angle: Sum<f64>) -> Self {
        let turns = (angle.hi / TAU).round();
        let whole = Sum::product(turns, TAU);
        let rest = (angle.hi - whole.hi) + (angle.lo - whole.lo - turns * TAU_LO);
        Self { turns, rest }.settled()
    }

    /// Returns this angle with the remainder in [-pi, pi].
    pub(crate) fn settled(self) -> Self {
        if self.rest.abs() <= PI {
            return self;
        }
        let turns = (self.rest / TAU).round();
        Self { turns: self.turns + turns, rest: (self.rest - turns * TAU) - turns * TAU_LO }
    }

    /// The angle with its whole turns, in radians, rounded to a double.
    pub fn radians(&self) -> f64 {
        self.turns.mul_add(TAU, self.rest + self.turns * TAU_LO)
    }
}

/// The rotation from e1, e2, e3, which follow the precession phi and the inclination, to the axes of the laboratory.
pub fn axes(phi: f64, theta: f64) -> UnitQuaternion<f64> {
    let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
    about(Vector3::z_axis(), phi) * about(Vector3::y_axis(), -theta)
}

/// The Euler angles of an orientation, in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct EulerAngles {
    /// The precession angle, in [-pi, pi]; 0 where the third axis is vertical.
    pub phi: f64,
    /// The inclination, in [0, pi].
    pub theta: f64,
    /// The spin angle, in [-pi, pi].
    pub psi: f64,
}

/// The angles phi, theta and psi of an orientation, which is `axes(phi, theta)` after a turn by psi about the third
/// axis. Error: a few roundings, divided by sin theta for phi and psi, but not for their sum, or their difference where
/// theta is near pi.
///
/// ```
/// use spincyl::pose::{axes, euler_angles};
///
/// let of = euler_angles(&axes(2.0, 1.3));
/// assert!((of.phi - 2.0).abs() < 1e-15 && (of.theta - 1.3).abs() < 1e-15 && of.psi.abs() < 1e-15);
/// ```
pub fn euler_angles(orientation: &UnitQuaternion<f64>) -> EulerAngles {
    let [x, y, z, w] = <[f64; 4]>::from(orientation.coords);
    let (lean, upright) = (x.hypot(y), z.hypot(w));
    let (sum, difference) = (2.0 * z.atan2(w), 2.0 * x.atan2(-y));
    let [phi, psi] = match (lean == 0.0, upright == 0.0) {
        (true, _) => [0.0, sum],
        (_, true) => [0.0, -difference],
        _ => [0.5 * (sum + difference), 0.5 * (sum - difference)],
    };
    let near = |angle: f64| angle - TAU * (angle / TAU).round();
    EulerAngles { phi: near(phi), theta: 2.0 * lean.atan2(upright), psi: near(psi) }
}

/// Orientation and position of a body at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Pose {
    /// Precession angle since time 0.
    pub phi: Angle,
    /// Spin angle since time 0.
    pub psi: Angle,
    /// Contact point on the table, in R; for a body in the air, the point below the lowest point of the rim.
    pub contact_point: Point2<f64>,
    /// Height of the lowest point of the rim above the table, in R; 0 on the table.
    pub height: f64,
}

impl Pose {
    /// The pose with the angles `phi` and `psi`, this contact point, and this height of the lowest point of the rim.
    pub fn new(phi: Angle, psi: Angle, contact_point: Point2<f64>, height: f64) -> Self {
        Self { phi, psi, contact_point, height }
    }
}

impl State {
    /// The state of a body from its orientation and its angular velocity, in sqrt(g/R), along the axes of the
    /// laboratory. The orientation is the rotation from the axes of the body to those of the laboratory, of which the
    /// third is the vertical. Error: a few roundings of the angular velocity, divided by sin theta for w1 and w2.
    pub fn from_twist(orientation: &UnitQuaternion<f64>, angular_velocity: Vector3<f64>) -> Self {
        let EulerAngles { phi, theta, .. } = euler_angles(orientation);
        let w = axes(phi, theta).inverse() * angular_velocity;
        Self { theta, w1: w.x, w2: w.y, w3: w.z }
    }
}

impl Pose {
    /// The pose at the beginning of every motion: phi = psi = 0, with the contact point at the origin of the table.
    pub fn start() -> Self {
        Self { phi: Angle::default(), psi: Angle::default(), contact_point: Point2::origin(), height: 0.0 }
    }

    /// The rotation from the body's own axes, of which e3 is the third, to the axes of the laboratory.
    pub fn orientation(&self, y: &State) -> UnitQuaternion<f64> {
        axes(self.phi.rest, y.theta) * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.psi.rest)
    }

    /// The position of the centre of mass, in R.
    pub fn centre(&self, body: &Body, y: &State) -> Point3<f64> {
        let (s, c) = y.theta.sin_cos();
        let (sin, cos) = self.phi.rest.sin_cos();
        let rim = body.shape().rim;
        let out = -rim.lever((s, c));
        Point3::new(
            self.contact_point.x + out * cos,
            self.contact_point.y + out * sin,
            rim.height((s, c)) + self.height,
        )
    }

    /// The contact point on a smooth table, where the centre stays above one point of the table.
    pub(crate) fn contact_point_below_centre(body: &Body, start: &State, y: &State, phi: f64) -> Point2<f64> {
        let rim = body.shape().rim;
        let lever = |y: &State| rim.lever(y.theta.sin_cos());
        let (sin, cos) = phi.sin_cos();
        Point2::new(lever(y) * cos - lever(start), lever(y) * sin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_billion_turns_and_a_bit_are_a_billion_turns_and_a_bit() {
        for (turns, rest) in [(1e9, 0.5), (-3e11, -3.0), (0.0, 3.1), (7.0, 1e-12)] {
            let angle = Sum::product(turns, TAU).plus(Sum::of(rest, turns * TAU_LO));
            let found = Angle::of(angle);
            assert_eq!(found.turns, turns);
            assert!((found.rest - rest).abs() < 1e-15, "{found:?}");
        }
        assert_eq!(Angle { turns: 2.0, rest: 7.0 }.settled().turns, 3.0);
        assert!((Angle { turns: 2.0, rest: 1.0 }.radians() - (4.0 * PI + 1.0)).abs() < 1e-15);
    }

    #[test]
    fn the_axes_at_the_start_are_those_of_the_vocabulary() {
        let y = State { theta: 0.3, w1: 0.0, w2: 0.0, w3: 0.0 };
        let turn = Pose::start().orientation(&y);
        assert!((turn * Vector3::z() - Vector3::new(-0.3f64.sin(), 0.0, 0.3f64.cos())).norm() < 1e-15);
        assert!((turn * Vector3::x() - Vector3::new(0.3f64.cos(), 0.0, 0.3f64.sin())).norm() < 1e-15);
        // The contact point is the lowest point of the rim.
        let body = Body::solid(0.7).unwrap();
        let down = Pose::start().centre(&body, &y) + turn * Vector3::new(-1.0, 0.0, -0.7);
        assert!(down.coords.norm() < 1e-15);
    }
}
