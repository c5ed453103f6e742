//! States and poses of a stone.

use crate::numbers::vector::dot;
use nalgebra::{Point2, Quaternion, UnitQuaternion};

/// The direction of the vertical and the angular velocity of a stone, along the axes of the ellipsoid.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct StoneState {
    /// The vertical: the unit vector that points upward, along the axes of the ellipsoid.
    pub vertical: [f64; 3],
    /// The angular velocity along the axes of the ellipsoid, in sqrt(g/a).
    pub w: [f64; 3],
}

impl StoneState {
    /// The state of a nearly upright stone that spins about the vertical with `spin`. The stone is turned from
    /// upright about axis 2 by `pitch` and about axis 1 by `roll` (radians).
    pub fn spinning(spin: f64, pitch: f64, roll: f64) -> Self {
        let ((sp, cp), (sr, cr)) = (pitch.sin_cos(), roll.sin_cos());
        let vertical = [-sp, cp * sr, cp * cr];
        Self { vertical, w: vertical.map(|x| spin * x) }
    }

    /// The spin: the angular velocity about the vertical, in sqrt(g/a).
    pub fn spin(&self) -> f64 {
        dot(self.vertical, self.w)
    }

    /// The inclination of axis 3, the angle from the vertical, in radians.
    pub fn theta(&self) -> f64 {
        let [x, y, z] = self.vertical;
        x.hypot(y).atan2(z)
    }

    /// The angles from the vertical to the three axes of the ellipsoid, in radians.
    pub fn inclinations(&self) -> [f64; 3] {
        let [x, y, z] = self.vertical;
        [y.hypot(z).atan2(x), z.hypot(x).atan2(y), x.hypot(y).atan2(z)]
    }

    /// The initial orientation: the smallest rotation from upright that gives this vertical, as a quaternion (w,
    /// x, y, z). For a stone upside down this is a half turn about axis 1.
    pub(crate) fn orientation(&self) -> [f64; 4] {
        let [x, y, z] = self.vertical;
        let across = x.hypot(y);
        if across == 0.0 {
            return if z > 0.0 { [1.0, 0.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0, 0.0] };
        }
        // The rotation takes the vertical, by the shortest way, to axis 3 of the laboratory.
        let (sin, cos) = (0.5 * across.atan2(z)).sin_cos();
        [cos, sin * y / across, -sin * x / across, 0.0]
    }
}

/// The orientation with the quaternion `from`, turned about the vertical by the angle `heading`, in radians.
pub(crate) fn headed(from: [f64; 4], heading: f64) -> [f64; 4] {
    if heading == 0.0 {
        return from;
    }
    let ([w, x, y, z], (sin, cos)) = (from, (0.5 * heading).sin_cos());
    [cos * w - sin * z, cos * x - sin * y, cos * y + sin * x, cos * z + sin * w]
}

/// The orientation of a stone, and its contact point.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct StonePose {
    /// The rotation from the axes of the ellipsoid to those of the laboratory.
    pub orientation: UnitQuaternion<f64>,
    /// The contact point on the table, along x and y of the laboratory, in units of the largest semi-axis.
    pub contact_point: Point2<f64>,
    /// The centre of mass, along x, y, z of the laboratory, in units of the largest semi-axis.
    pub centre: [f64; 3],
}

impl StonePose {
    pub(crate) fn new([w, x, y, z]: [f64; 4], contact_point: [f64; 2], centre: [f64; 3]) -> Self {
        let orientation = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
        Self { orientation, contact_point: contact_point.into(), centre }
    }
}
