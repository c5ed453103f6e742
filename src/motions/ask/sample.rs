//! The outputs of a motion as samples, one for each time.
//!
//! ```text
//! v = (u_h + h w2) e_h + (u_2 - L w1 + A w3) e2 + (g w2 + lift) z      u the slip, lift the rise of the lowest point
//! ```
//! On a smooth table the centre moves only up and down. Error: that of the motion, and a few roundings.

use crate::laws::body::Body;
use crate::laws::contact::slip::{centre_rise, centre_velocity};
use crate::laws::pose::{Pose, axes};
use crate::laws::state::{Slip, State};
use crate::motions::{AboveTable, Kind, Motion, Moving, OtherRim};
use core::f64::consts::PI;
use nalgebra::{UnitQuaternion, Vector3};

/// The outputs of a motion at one of its times.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields),
    serde(bound(
        serialize = "S: serde::Serialize, S::Pose: serde::Serialize, S::Force: serde::Serialize",
        deserialize = "S: serde::Deserialize<'de>, S::Pose: serde::Deserialize<'de>, S::Force: serde::Deserialize<'de>"
    ))
)]
#[non_exhaustive]
pub struct Sample<S: Moving = State> {
    /// The time of the sample, in sqrt(R/g).
    pub time: f64,
    /// The state of the body at this time.
    pub state: S,
    /// The pose, if poses were requested.
    pub pose: Option<S::Pose>,
    /// The contact force, if forces were requested.
    pub force: Option<S::Force>,
    /// The slip of the contact point; None if there is no law of friction, no loss and no restitution.
    pub slip: Option<Slip>,
    /// The kind of phase, such as rolling or slipping; None if there is no law of friction, no loss and no restitution.
    pub kind: Option<Kind>,
    /// The height of the lowest point above the table and its vertical velocity; both are 0 on the table.
    pub aloft: AboveTable,
    /// Slip and force of the other rim of a body that lies on both; else None.
    pub other_rim: Option<OtherRim>,
    /// The rim to which state, slip, pose and force refer: 0 is that of the initial state, and 1 the other one. For a body
    /// of several circles, the number of the circle on which it stands; its state always refers to its lower end.
    pub rim: u8,
    smooth: bool,
    /// Whether the state is counted from the lower end of the body, whichever circle carries it.
    #[cfg_attr(feature = "serde", serde(default))]
    told: bool,
}

impl<S: Moving> Motion<S> {
    /// Returns the outputs at each time of the motion.
    ///
    /// ```
    /// use spincyl::{Body, motion::{Ask, roll_with}, steady};
    ///
    /// let body = Body::solid(2.5)?;
    /// let start = steady::state(&body, 1.3)?.kicked(0.05);
    /// let ask = Ask::default().with_pose().with_force();
    /// let motion = roll_with(&body, start, &[0.0, 1.0, 2.0], &ask, || true)?.expect("not interrupted");
    /// for now in motion.samples() {
    ///     let (centre, force) = (now.centre(&body).unwrap(), now.force.unwrap());
    ///     assert!(centre.z > 0.0 && force.normal > 0.0, "at {}", now.time);
    /// }
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    pub fn samples(&self) -> impl ExactSizeIterator<Item = Sample<S>> {
        (0..self.states.len()).map(|i| self.sample(i))
    }

    /// The outputs at the time with the index `i`.
    pub(crate) fn sample(&self, i: usize) -> Sample<S> {
        let path = self.path.as_deref();
        Sample {
            time: self.times.get(i).copied().unwrap_or(f64::NAN),
            state: self.states[i],
            pose: self.poses.as_ref().and_then(|all| all.get(i).copied()),
            force: self.forces.as_ref().and_then(|all| all.get(i).copied()),
            slip: path.and_then(|path| path.slip.get(i).copied()),
            kind: path.and_then(|path| path.kinds.get(i).copied()),
            aloft: path.and_then(|path| path.aloft.get(i).copied()).unwrap_or_default(),
            other_rim: path
                .and_then(|path| path.other_rim.get(i).copied().filter(|other| !other.force.normal.is_nan())),
            rim: path.and_then(|path| path.rims.get(i).copied()).or(self.circle).unwrap_or_default(),
            smooth: self.smooth,
            told: self.is_told(),
        }
    }
}

impl Motion {
    /// The orientation at each time, if poses were requested. It refers to the axes of the body at the start, whichever
    /// rim touches the table.
    pub fn orientations(&self) -> impl Iterator<Item = UnitQuaternion<f64>> {
        self.samples().filter_map(|now| now.orientation())
    }
}

impl Sample {
    /// Whether the state is counted from the other end of the body than the initial state.
    fn is_over(&self) -> bool {
        self.rim == 1 && !self.told
    }

    /// The cosine of the angle from the vertical to the axis of the body at the start: 1 where the body lies on its
    /// first face, and -1 where it lies on the other one.
    pub fn axis_up(&self) -> f64 {
        self.state.axis_up(self.is_over().into())
    }

    /// The rotation from the axes of the body to those of the laboratory, if poses were requested; see
    /// [`Motion::orientations`].
    pub fn orientation(&self) -> Option<UnitQuaternion<f64>> {
        // A pose on the other rim describes the body after a half turn about its own first axis.
        let over = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), if self.is_over() { PI } else { 0.0 });
        self.pose.map(|pose| pose.orientation(&self.state) * over)
    }

    /// The centre of mass, in R, if poses were requested.
    pub fn centre(&self, body: &Body) -> Option<nalgebra::Point3<f64>> {
        self.pose.map(|pose| pose.centre(&body.standing_on(self.rim), &self.state))
    }

    /// The angular velocity along the axes of the laboratory, in sqrt(g/R), if poses were requested.
    pub fn angular_velocity(&self) -> Option<Vector3<f64>> {
        self.pose.map(|Pose { phi, .. }| axes(phi.rest, self.state.theta) * self.state.angular_velocity())
    }

    /// The force of the table along the axes of the laboratory, in weights, if poses and forces were requested: for a body
    /// that lies on both rims the sum of both forces, and zero in the air.
    pub fn force_in_laboratory(&self) -> Option<Vector3<f64>> {
        let own = self.pose.zip(self.force).map(|(pose, force)| force.in_laboratory(pose.phi.rest));
        own.map(|own| own + self.force_on_other_rim().unwrap_or_default())
    }

    /// The force of the table on the other rim, along the axes of the laboratory, in weights; None unless the body
    /// lies on both rims.
    pub fn force_on_other_rim(&self) -> Option<Vector3<f64>> {
        let other = self.force.and(self.other_rim)?;
        self.pose.map(|pose| other.force.in_laboratory(pose.phi.rest))
    }

    /// The velocity of the centre of mass along the axes of the laboratory, in sqrt(g R), if poses were requested. On
    /// a smooth slope it does not include the velocity of the centre downhill, nor on a turntable the velocity of the
    /// table under the contact point.
    pub fn velocity(&self, body: &Body) -> Option<Vector3<f64>> {
        let body = &body.standing_on(self.rim);
        let [along, across] = if self.smooth {
            [0.0; 2]
        } else {
            centre_velocity(body, &self.state, self.slip.unwrap_or_default())
        };
        let rise = centre_rise(body, &self.state) + self.aloft.lift;
        self.pose.map(|pose| axes(pose.phi.rest, 0.0) * Vector3::new(along, across, rise))
    }

    /// Kinetic and potential energy in M g R, with heights above a level table at rest, if poses were requested.
    pub fn energy(&self, body: &Body) -> Option<f64> {
        let turning = self.state.angular_velocity().dot(&self.state.angular_momentum(body));
        self.velocity(body).zip(self.centre(body)).map(|(v, at)| 0.5 * (turning + v.norm_squared()) + at.z)
    }
}
