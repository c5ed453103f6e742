//! Components of a stone's state, and the distances between two of its states, poses and forces.

use crate::laws::stone::{StonePose, StoneState};
use crate::motions::Moving;
use crate::motions::ask::moving::sealed;
use nalgebra::Vector3;

impl sealed::OwnState for StoneState {}

impl Moving for StoneState {
    /// Safety factor of the estimated error, larger than for a body of revolution: a stone may pass over a sharp edge
    /// or linger near an unstable state, so that its errors are less proportional to the tolerance.
    const SAFETY: f64 = 100.0;
    type Numbers = [f64; 6];
    type Pose = StonePose;
    /// The contact force along the axes of the laboratory, of which the third is the vertical.
    type Force = Vector3<f64>;

    fn numbers(&self) -> [f64; 6] {
        let [a, b, c] = self.vertical;
        let [d, e, f] = self.w;
        [a, b, c, d, e, f]
    }
    fn theta(&self) -> f64 {
        self.theta()
    }
    fn fastest(&self) -> f64 {
        self.w.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
    }
    fn at_pace(&self, pace: f64) -> Self {
        Self { vertical: self.vertical, w: self.w.map(|w| pace * w) }
    }
    fn force_at(force: &Vector3<f64>, weight: f64) -> Vector3<f64> {
        weight * force
    }
    fn pose_distance(a: &StonePose, b: &StonePose) -> f64 {
        let (p, q) = (a.orientation.coords, b.orientation.coords);
        // A quaternion and its opposite are one orientation; the angle between two is twice their distance.
        let turned = (p - q).amax().min((p + q).amax());
        turned.max((a.contact_point - b.contact_point).amax())
    }
    fn turning(_: &StonePose) -> f64 {
        0.0
    }
    fn force_distance(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
        (a - b).amax()
    }
}
