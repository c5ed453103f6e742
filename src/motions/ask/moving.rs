//! The states of a moving body or stone, with the types of its poses and contact forces.

use crate::laws::contact::Force;
use crate::laws::pose::{Angle, Pose};
use crate::laws::state::State;
use crate::motions::walk::errors::{force_distance, pose_distance, pose_distance_over};
use crate::numbers::larger_or_nan;
use core::f64::consts::PI;
use core::fmt::Debug;

/// A private trait that only the states of this crate have, so that [`Moving`] can get more methods later.
pub(crate) mod sealed {
    /// A state that this crate defines.
    pub trait OwnState {}
}

/// A state of a moving body: [`State`] or the state of a stone, with the types of its components, its pose and its
/// contact force.
pub trait Moving: Copy + Debug + PartialEq + sealed::OwnState {
    /// Safety factor of the estimated error, which multiplies the scaled difference of two runs.
    const SAFETY: f64 = 30.0;
    /// The array type of the components of the state.
    type Numbers: AsRef<[f64]>;
    /// The position and the orientation of the body.
    type Pose: Copy + Debug + PartialEq;
    /// The contact force.
    type Force: Copy + Debug + PartialEq;

    /// The components of the state, as an array.
    fn numbers(&self) -> Self::Numbers;
    /// The inclination, in radians.
    fn theta(&self) -> f64;
    /// The largest component of the angular velocity by size.
    fn fastest(&self) -> f64;
    /// The largest difference between the components of two poses.
    fn pose_distance(a: &Self::Pose, b: &Self::Pose) -> f64;
    /// The sum of the sizes of a pose's angles, in radians, to which their rounding errors are proportional.
    fn turning(pose: &Self::Pose) -> f64;
    /// The largest difference between the components of two forces.
    fn force_distance(a: &Self::Force, b: &Self::Force) -> f64;
    /// The state with all speeds multiplied by `pace`, as in other units of time.
    fn at_pace(&self, pace: f64) -> Self;
    /// A force multiplied by `weight`.
    fn force_at(force: &Self::Force, weight: f64) -> Self::Force;
    /// The same state counted from the other one of two equal rims; None for a stone.
    fn seen_from_other_rim(&self) -> Option<Self> {
        None
    }
    /// Converts a state that is counted from the upper end of a body to one counted from the lower end, with the
    /// inclination `theta`.
    fn told(&self, _theta: f64) -> Self {
        *self
    }
    /// Converts a pose that refers to the upper end of a body to its lower end.
    fn pose_told(pose: &Self::Pose) -> Self::Pose {
        *pose
    }
    /// Converts a pose as [`pose_told`](Self::pose_told), for a motion all of whose poses refer to the upper end, and
    /// turns the laboratory by half a turn about the vertical, so that phi begins with 0.
    fn pose_told_from_start(pose: &Self::Pose) -> Self::Pose {
        *pose
    }
    /// Converts a force that refers to the upper end of a body to its lower end.
    fn force_told(force: &Self::Force) -> Self::Force {
        *force
    }
    /// The largest difference between two poses that refer to different circles of contact, without the contact
    /// points, which differ.
    fn pose_distance_apart(a: &Self::Pose, b: &Self::Pose) -> f64 {
        Self::pose_distance(a, b)
    }
    /// The largest difference between two poses that refer to different rims, `a` to the one that did not touch the table at
    /// the start.
    fn pose_distance_over(a: &Self::Pose, b: &Self::Pose) -> f64 {
        Self::pose_distance(a, b)
    }
    /// The largest difference between the components of two states.
    fn distance(&self, other: &Self) -> f64 {
        let (a, b) = (self.numbers(), other.numbers());
        a.as_ref().iter().zip(b.as_ref()).fold(0.0, |most, (a, b)| larger_or_nan(most, (a - b).abs()))
    }
}

impl sealed::OwnState for State {}

impl Moving for State {
    type Numbers = [f64; 4];
    type Pose = Pose;
    type Force = Force;

    fn numbers(&self) -> [f64; 4] {
        (*self).into()
    }
    fn theta(&self) -> f64 {
        self.theta
    }
    fn fastest(&self) -> f64 {
        self.w1.abs().max(self.w3.abs())
    }
    fn pose_distance(a: &Pose, b: &Pose) -> f64 {
        pose_distance(a, b)
    }
    fn at_pace(&self, pace: f64) -> Self {
        Self { theta: self.theta, w1: pace * self.w1, w2: pace * self.w2, w3: pace * self.w3 }
    }
    fn force_at(force: &Force, weight: f64) -> Force {
        Force { normal: weight * force.normal, along: weight * force.along, across: weight * force.across }
    }
    fn seen_from_other_rim(&self) -> Option<Self> {
        Some(Self { theta: PI - self.theta, w1: self.w1, w2: -self.w2, w3: -self.w3 })
    }
    fn told(&self, theta: f64) -> Self {
        Self { theta, w1: self.w1, w2: 0.0 - self.w2, w3: 0.0 - self.w3 }
    }
    fn pose_told(pose: &Pose) -> Pose {
        let phi = Angle { rest: pose.phi.rest - PI, ..pose.phi }.settled();
        Pose { phi, psi: Angle { turns: 0.0 - pose.psi.turns, rest: 0.0 - pose.psi.rest }, ..*pose }
    }
    fn pose_told_from_start(pose: &Pose) -> Pose {
        Pose { phi: pose.phi, contact_point: -pose.contact_point, ..Self::pose_told(pose) }
    }
    fn force_told(force: &Force) -> Force {
        Force { normal: force.normal, along: 0.0 - force.along, across: 0.0 - force.across }
    }
    fn pose_distance_apart(a: &Pose, b: &Pose) -> f64 {
        pose_distance(a, &Pose { contact_point: a.contact_point, height: a.height, ..*b })
    }
    fn pose_distance_over(a: &Pose, b: &Pose) -> f64 {
        pose_distance_over(a, b)
    }
    fn turning(pose: &Pose) -> f64 {
        pose.phi.radians().abs() + pose.psi.radians().abs()
    }
    fn force_distance(a: &Force, b: &Force) -> f64 {
        force_distance(a, b)
    }
}
