//! Motions of a measured body whose start is a pose and velocities along the axes of the world, in SI; so are the
//! results.
//!
//! ```text
//! q = axes(phi, theta) Rz(psi)                      phi the heading of the start, psi the turn of the body about its axis
//! contact point = centre + (lever) (cos phi, sin phi) below the lowest point of the body
//! ```
//! A motion in natural units counts psi from 0, since no rate depends on psi. In this module the orientation of each
//! reading includes the psi of the start, so that the first reading is the pose that was given. The world has its z
//! along the normal of the table, which is z = 0; on a slope x points downhill.
//!
//! Error: a few roundings. Near an upright axis phi and psi separately have an error of a few roundings over sin
//! theta, but the orientation does not.
//!
//! ```
//! use spincyl::measured::{Measured, Tube};
//! use spincyl::nalgebra::{Isometry3, Vector3};
//! use spincyl::world::WorldStart;
//!
//! // A can, 2 cm high, whose centre of mass is 20 cm above the table.
//! let can = Measured::tube(&Tube::solid(0.05, 0.02, 0.1))?;
//! let dropped = WorldStart::new(Isometry3::translation(0.3, 0.4, 0.2), Vector3::zeros(), Vector3::z());
//! let gap = can.start_in_world(&dropped)?.aloft.expect("it is in the air");
//! assert!((can.scale().metres(gap.height) - 0.19).abs() < 1e-15 && gap.lift == 0.0);
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::ask::NO_RISE;
use super::{Ask, Start};
use crate::error::{Error, within};
use crate::laws::contact::slip::centre_rise;
use crate::laws::pose::euler_angles;
use crate::laws::state::State;
use crate::motions::measured::{Measured, MeasuredMotion};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};

/// A body whose lowest point is at most this far above the table, in units of R, touches the table.
const NEAR_THE_TABLE: f64 = 1e-9;

/// The pose and the velocities with which a motion begins, along the axes of the world, in SI.
///
/// ```
/// use spincyl::measured::{Measured, Tube};
/// use spincyl::motion::Ask;
/// use spincyl::nalgebra::{Isometry3, UnitQuaternion, Vector3};
/// use spincyl::world::WorldStart;
///
/// let can = Measured::tube(&Tube::solid(0.05, 0.02, 0.1))?;
/// let turned = UnitQuaternion::from_euler_angles(0.7, 0.3, 1.2);
/// let pose = Isometry3::from_parts(Vector3::new(0.3, 0.4, 0.2).into(), turned); // the centre of mass, 20 cm high
/// let thrown = WorldStart::new(pose, Vector3::new(0.3, 0.1, 0.2), Vector3::new(1.0, -2.0, 5.0));
/// let motion = can.roll_in_world(&thrown, &[0.0, 0.1], &Ask::default().with_restitution(0.5), || true)?.unwrap();
/// let first = motion.readings().next().unwrap();
/// assert!((first.position.coords - Vector3::new(0.3, 0.4, 0.2)).norm() < 1e-15);
/// assert!(first.orientation.angle_to(&turned) < 1e-7 && (first.velocity - thrown.velocity).norm() < 1e-15);
/// # Ok::<(), spincyl::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct WorldStart {
    /// The centre of mass in metres.
    pub position: Point3<f64>,
    /// The rotation from the axes of the body, of which the third is the symmetry axis, to those of the world.
    pub orientation: UnitQuaternion<f64>,
    /// The velocity of the centre of mass in m/s.
    pub velocity: Vector3<f64>,
    /// The angular velocity in rad/s, along the axes of the world.
    pub angular_velocity: Vector3<f64>,
}

impl WorldStart {
    /// A start from the pose of the body, whose translation is the centre of mass in metres, the velocity of the
    /// centre in m/s, and the angular velocity in rad/s, all along the axes of the world.
    #[must_use]
    pub fn new(pose: Isometry3<f64>, velocity: Vector3<f64>, angular_velocity: Vector3<f64>) -> Self {
        let position = pose.translation.vector.into();
        Self { position, orientation: pose.rotation, velocity, angular_velocity }
    }
}

impl Measured {
    /// Converts a start in the world to a start in natural units: state, slip, direction and place. A body whose lowest point
    /// is more than 1e-9 R above the table, or rises, starts in the air.
    ///
    /// # Errors
    /// `OutOfRange` for a body below the table, for one on the table that moves into it, and for numbers that are not finite.
    pub fn start_in_world(&self, start: &WorldStart) -> Result<Start, Error> {
        let (scale, q) = (self.scale(), &start.orientation);
        let unit = q.coords.norm();
        within("orientation", unit, (1.0 - 1e-9, 1.0 + 1e-9), "a unit quaternion")?;
        for x in start.position.iter().chain(&start.velocity).chain(&start.angular_velocity) {
            within(
                "start",
                *x,
                (-f64::MAX, f64::MAX),
                "finite components of position, velocity and angular velocity",
            )?;
        }
        let w = start.angular_velocity.map(|w| scale.angular_velocity(w));
        let v = start.velocity.map(|v| scale.speed(v));
        let [x, y, z] = [0, 1, 2].map(|i| scale.length(start.position[i]));
        let state = State::from_twist(q, w);
        let body = self.body().told_at(state.theta);
        let (rim, angle) = (body.shape().rim, state.theta.sin_cos());
        let gap = z - rim.height(angle);
        within(
            "position",
            gap,
            (-NEAR_THE_TABLE, f64::MAX),
            "a position in which the lowest point of the body is on or above the table",
        )?;
        let rise = v.z - centre_rise(&body, &state);
        let few = NO_RISE * (v.amax() + w.amax() * (1.0 + rim.ell.abs()));
        let aloft = (gap > NEAR_THE_TABLE || rise > few).then_some(z.max(rim.height(angle)));
        let phi = euler_angles(q).phi;
        let (sin, cos) = phi.sin_cos();
        let lever = rim.lever(angle);
        let found = Start::from_twist(self.body(), q, w, v, aloft)?;
        Ok(found.with_heading(phi).with_place([x + lever * cos, y + lever * sin]))
    }

    /// Computes the motion of the body from a start in the world, at these times in seconds; its results are along
    /// the axes of the world, in SI. Options are in natural units, and `go_on` is as for [`roll`](Self::roll).
    ///
    /// # Errors
    /// Those of [`start_in_world`](Self::start_in_world) and of [`roll`](Self::roll).
    pub fn roll_in_world(
        &self,
        start: &WorldStart,
        seconds: &[f64],
        ask: &Ask,
        go_on: impl FnMut() -> bool,
    ) -> Result<Option<MeasuredMotion>, Error> {
        let turn = euler_angles(&start.orientation).psi;
        let found = self.roll(self.start_in_world(start)?, seconds, ask, go_on)?;
        Ok(found.map(|motion| MeasuredMotion { turn, ..motion }))
    }
}
