//! Bounds of the errors of results that are computed from states, poses and forces.
//!
//! ```text
//! e, p, f             estimated errors of the states, of the poses and of the forces
//! position            p + reach (e + p)         the contact point, and the centre as seen from it
//! orientation         e + 2 p                   theta, phi and psi
//! velocity            u + |v| p,   u = e (sqrt(3) (1 + reach) + |w| reach)
//! angular velocity    sqrt(3) e + |w| (e + p)
//! force               sqrt(3) f + |F| p
//! energy              |v| u + I |w| sqrt(3) e + reach e
//! ```
//! |w|, |v| and |F| are the largest along the motion, I is the largest moment of inertia, and reach the largest distance of
//! the surface from the centre. Error: to first order in e, p and f.

use crate::laws::body::Body;
use crate::motions::Motion;
use crate::numbers::larger_or_nan;

/// Upper bounds of the estimated errors at any time of a motion, in natural units, or in SI for a measured body.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Bounds {
    /// Error of every component of the states and slips, and of the times of phases and of the end.
    pub state: f64,
    /// Error of the position of the centre of mass, in R; NaN without poses, as are all errors below.
    pub position: f64,
    /// Angle between the computed and the true orientation, in radians.
    pub orientation: f64,
    /// Error of the velocity of the centre of mass, in sqrt(g R).
    pub velocity: f64,
    /// Error of the angular velocity along the axes of the laboratory, in sqrt(g/R).
    pub angular_velocity: f64,
    /// Error of the force of the table along the axes of the laboratory, in M g; NaN without poses or without forces.
    pub force: f64,
    /// Error of the energy, in M g R.
    pub energy: f64,
}

impl Bounds {
    /// Computes the bounds from the errors of states, poses and forces, the largest distance of the surface from the
    /// centre, the largest moment of inertia, and the largest angular velocity, velocity and force.
    pub(crate) fn of([e, p, f]: [f64; 3], [reach, inertia]: [f64; 2], [w, v, press]: [f64; 3]) -> Self {
        let root = 3f64.sqrt();
        let moved = e * (root * (1.0 + reach) + w * reach);
        Self {
            state: e,
            position: p + reach * (e + p),
            orientation: e + 2.0 * p,
            velocity: moved + v * p,
            angular_velocity: root * e + w * (e + p),
            force: root * f + press * p,
            energy: v * moved + inertia * w * root * e + reach * e,
        }
    }
}

impl Motion {
    /// Bounds of the errors at any time of the motion of this body.
    pub fn bounds(&self, body: &Body) -> Bounds {
        let mut most = [0f64; 3];
        for now in self.samples() {
            let force = now.force_in_laboratory().map_or(0.0, |force| force.norm());
            let speed = now.velocity(body).map_or(0.0, |v| v.norm());
            for (most, x) in most.iter_mut().zip([now.state.angular_velocity().norm(), speed, force]) {
                *most = larger_or_nan(*most, x);
            }
        }
        let size = [body.reach(), body.i1().max(body.i3())];
        Bounds::of([self.error, self.pose_error, self.force_error], size, most)
    }
}
