//! The contents of a scene file, with the names of its keys.
//!
//! All numbers are in SI, along the axes of the table. A number that does not exist is null in the file, and here NaN, or
//! `None` where it may be infinite.

use super::natural::Natural;
use nalgebra::{Matrix3, Point3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// The contents of a scene file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Contents {
    /// The version of the format of the file.
    #[serde(rename = "spincyl-scene")]
    pub version: u32,
    pub(super) units: String,
    pub(super) axes: String,
    /// The natural units of the scene, in SI.
    pub scale: NaturalUnits,
    /// The acceleration of gravity as a vector along the axes of the table, in m/s^2.
    pub gravity: Vector3<f64>,
    /// The body: mass, inertia and shape.
    pub body: SceneBody,
    /// The table: plane, friction, restitution and losses.
    pub table: SceneTable,
    /// The initial state of the body.
    pub start: SceneStart,
    /// The known answer: the motion at given times.
    pub expected: Expected,
    /// Bounds of the errors of the known answer at any time.
    pub error: SceneErrors,
    /// The body, the start and the options of the motion in natural units, from which the answer can be computed, also
    /// at other times.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub natural: Option<Natural>,
}

/// The natural units of a scene in SI.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct NaturalUnits {
    /// The radius R in metres; for a stone the largest semi-axis.
    #[serde(rename = "R")]
    pub radius: f64,
    /// The mass M in kilograms.
    #[serde(rename = "M")]
    pub mass: f64,
    /// The acceleration of gravity g in m/s^2.
    #[serde(rename = "g")]
    pub gravity: f64,
    /// The unit of time, sqrt(R/g), in seconds.
    pub second: f64,
}

/// The body of a scene. The origin of its axes is the centre of mass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SceneBody {
    /// The name of the body in words.
    pub name: String,
    /// The mass in kilograms.
    pub mass: f64,
    /// The rows of the tensor of inertia about the centre of mass along the axes of the body, in kg m^2.
    #[serde(with = "rows")]
    pub inertia: Matrix3<f64>,
    pub(super) inertia_is: String,
    /// The principal moments in ascending order, in kg m^2.
    pub principal_moments: [f64; 3],
    /// The principal axes, a unit vector for each moment.
    pub principal_axes: [Vector3<f64>; 3],
    /// The part of the surface that can touch the table.
    pub shape: SceneShape,
}

/// The part of the surface of a body that can touch the table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum SceneShape {
    /// The shape of an ellipsoid.
    Ellipsoid(EllipsoidShape),
    /// The shape is the hull of circles about axis 3, swollen by a distance.
    Circles(CirclesShape),
}

/// An ellipsoid along the axes of the body, in metres.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct EllipsoidShape {
    #[serde(rename = "type")]
    pub(super) kind: String,
    /// The largest semi-axis, in metres.
    pub radius: f64,
    /// The semi-axes of the ellipsoid, in metres.
    pub semi_axes: Vector3<f64>,
    /// The vector from the centre of mass to the centre of the ellipsoid, in metres.
    pub centre: Vector3<f64>,
    /// The inclination of axis 3, in radians, at which an edge lands; `None` without an edge.
    pub lands_at: Option<f64>,
}

/// All points within a distance of the convex hull of circles about axis 3, in metres.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct CirclesShape {
    /// The kind of the body.
    #[serde(rename = "type")]
    pub kind: ShapeKind,
    /// The unit of length R, in metres.
    pub radius: f64,
    /// The radius of the bore of a tube in metres; `None` for a body of another kind, whose inside is not known.
    pub inner_radius: Option<f64>,
    /// The circles, from the lower end up.
    pub circles: Vec<SceneCircle>,
    /// The distance of the surface from the hull of all circles, in metres; `None` if each circle has its own distance.
    pub swollen_by: Option<f64>,
    /// Half the length of a body with two equal rims, in metres; `None` for other bodies.
    pub half_length: Option<f64>,
    /// The inclination, in radians, at which a part other than the lowest circle lands.
    pub lands_at: f64,
    #[serde(rename = "is")]
    pub(super) explained: String,
    /// Points (radius, height) in metres of a profile for drawing the body; empty where engines have a shape for this body.
    #[serde(default)]
    pub outline: Vec<[f64; 2]>,
}

/// The kind of a body of revolution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum ShapeKind {
    /// A cylinder or tube, sharp or rounded.
    Cylinder,
    /// A body with a single circle, such as a thin disk or a hoop.
    Rim,
    /// A cylinder with hemispheres at its ends.
    Capsule,
    /// Two equal balls on a common axis.
    Balls,
    /// A ball, with its centre of mass at any point of axis 3.
    Ball,
    /// Circles of any other arrangement.
    Circles,
}

/// A circle about axis 3 with which a body touches the table, in metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SceneCircle {
    /// The height of the circle above the centre of mass, along axis 3.
    pub height: f64,
    /// The radius of the circle; 0 for a ball or a tip.
    pub radius: f64,
    /// The radius of the fillet of this circle; `None` if all circles have the same fillet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub swollen_by: Option<f64>,
}

/// The table of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SceneTable {
    /// A point of the plane of the table, in metres.
    pub point: Point3<f64>,
    /// The unit normal of the table, which points up.
    pub normal: Vector3<f64>,
    /// The law of friction.
    pub friction: SceneFriction,
    /// The coefficient of restitution; `None` if nothing strikes the table.
    pub restitution: Option<f64>,
    pub(super) restitution_is: String,
    /// The loss laws, each with its coefficient.
    pub losses: Vec<SceneLoss>,
    pub(super) symbols: String,
}

/// The law of friction of a scene, with its formula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "law", rename_all = "lowercase")]
#[non_exhaustive]
pub enum SceneFriction {
    /// Rolling: the contact point is at rest.
    #[non_exhaustive]
    Rolling {
        /// A coefficient of friction with which the body rolls during the whole motion.
        mu: f64,
        /// The least coefficient of friction that rolling needs; `None` if impacts would need an infinite one.
        needed: Option<f64>,
        /// The formula of the friction, as text.
        force: String,
    },
    /// A smooth table, without friction.
    #[non_exhaustive]
    Smooth {
        /// The coefficient of friction, which is 0.
        mu: f64,
        /// The formula of the friction, as text.
        force: String,
    },
    /// Coulomb's law of dry friction.
    #[non_exhaustive]
    Coulomb {
        /// The coefficient of sliding friction.
        mu: f64,
        /// The coefficient of static friction; `None` if it is infinite.
        #[serde(rename = "static")]
        fixed: Option<f64>,
        /// The radius of the patch of contact in metres; 0 for a point.
        patch: f64,
        /// The formula of the friction, as text.
        force: String,
    },
    /// A viscous film, whose friction grows with the velocity of the slip.
    #[non_exhaustive]
    Viscous {
        /// The coefficient: the force over normal force and velocity, in s/m.
        c: f64,
        /// The unit of the coefficient, s/m.
        unit: String,
        /// The formula of the friction, as text.
        force: String,
    },
}

/// A loss law of a scene, with its couple on the body in the symbols of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SceneLoss {
    /// The name of the law.
    pub law: String,
    /// The name of the coefficient of the law.
    pub coefficient: String,
    /// The value of the coefficient of the law, in SI.
    pub value: f64,
    /// The SI unit of the coefficient of the law.
    pub unit: String,
    /// The formula of the couple on the body, as text.
    pub couple: String,
}

/// The initial state of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SceneStart {
    /// The position of the centre of mass in metres.
    pub position: Point3<f64>,
    /// The rotation from the axes of the body to those of the table; x, y, z, w in the file.
    pub orientation: UnitQuaternion<f64>,
    /// The velocity of the centre of mass in m/s.
    pub velocity: Vector3<f64>,
    /// The angular velocity along the axes of the table, in rad/s.
    pub angular_velocity: Vector3<f64>,
    /// The angular velocity along the axes of the body, in rad/s.
    pub angular_velocity_in_body_axes: Vector3<f64>,
}

/// The known answer, a number or a vector for each time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Expected {
    /// The times since the initial state in seconds; the first is 0.
    pub time: Vec<f64>,
    /// The position of the centre of mass in metres.
    pub position: Vec<Point3<f64>>,
    /// The rotation from the axes of the body to those of the table.
    pub orientation: Vec<UnitQuaternion<f64>>,
    /// The velocity of the centre of mass in m/s.
    pub velocity: Vec<Vector3<f64>>,
    /// The angular velocity along the axes of the table, in rad/s.
    pub angular_velocity: Vec<Vector3<f64>>,
    /// The angle from the vertical to axis 3 in radians.
    pub theta: Vec<f64>,
    /// Kinetic and potential energy in joules.
    pub energy: Vec<f64>,
    /// The normal force in newtons, of all points of contact together; NaN where it is not determined.
    #[serde(with = "null_numbers")]
    pub normal_force: Vec<f64>,
    /// The force of the table in newtons; NaN where the body touches it with both rims.
    #[serde(with = "nulls")]
    pub contact_force: Vec<Vector3<f64>>,
    /// The position of the contact point in metres; NaN where there is no contact point or more than one.
    #[serde(with = "nulls")]
    pub contact_point: Vec<Vector3<f64>>,
    /// The heat of friction up to each time in joules, under a law of friction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heat_of_slip: Option<Vec<f64>>,
    /// The energy lost to the losses up to each time in joules, with losses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lost_by_losses: Option<Vec<f64>>,
    pub(super) theta_is: String,
    pub(super) contact_is: String,
    /// The height of the lowest point of the body in metres; only with a coefficient of restitution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<Vec<f64>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) height_is: Option<String>,
    /// The energy lost in impacts before each time in joules; only with a coefficient of restitution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lost_in_impacts: Option<Vec<f64>>,
    /// The impacts, in order; only with a coefficient of restitution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub impacts: Option<Vec<SceneImpact>>,
    /// The phases of the motion, each with the time at which it begins.
    pub phases: Vec<ScenePhase>,
    /// The ending of the known motion, with its time and its reason.
    pub ending: SceneEnding,
}

/// An impact on the table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SceneImpact {
    /// The time of the impact in seconds.
    pub time: f64,
    /// The motion of the contact point in the impact, in words.
    pub kind: String,
    /// The normal impulse in N s.
    pub normal_impulse: f64,
    /// The energy lost in the impact, in joules.
    pub energy_lost: f64,
}

/// A phase of the known motion, such as rolling or slipping.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ScenePhase {
    /// The time at which the phase begins, in seconds.
    pub time: f64,
    /// The kind of the phase in words, such as "rolling".
    pub kind: String,
}

/// The ending of the known motion, with its time and its reason.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SceneEnding {
    /// The name of the ending, such as `DONE` or `FACE`.
    pub kind: String,
    /// The time of the ending in seconds.
    pub time: f64,
    /// The reason why the motion ends, in words.
    pub why: String,
}

/// Bounds of the errors of the known answer at any time, in SI.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SceneErrors {
    /// Error of the position of the centre of mass, in metres.
    pub position: f64,
    /// Angle between the known and the true orientation, in radians.
    pub angle: f64,
    /// Error of the inclination, in radians.
    pub theta: f64,
    /// Error of the angular velocity, in rad/s.
    pub angular_velocity: f64,
    /// Error of the velocity of the centre of mass, in m/s.
    pub velocity: f64,
    /// Error of the energy, in joules.
    pub energy: f64,
    /// Error of the normal force, in newtons; NaN if the force is unknown.
    #[serde(with = "null_number")]
    pub normal_force: f64,
    /// Error of the force of the table, in newtons; NaN if the force is unknown.
    #[serde(with = "null_number")]
    pub contact_force: f64,
    /// Error of the position of the contact point, in metres.
    pub contact_point: f64,
    /// Error of the times of phases and impacts, in seconds.
    pub times_of_phases_and_impacts: f64,
    /// Error of the heat of slip and of the lost energies, in joules.
    pub heat_and_losses: f64,
    #[serde(rename = "is")]
    pub(super) explained: String,
}

/// Conversion of a matrix to and from its rows in a file.
mod rows {
    use nalgebra::Matrix3;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(of: &Matrix3<f64>, to: S) -> Result<S::Ok, S::Error> {
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| of[(i, j)])).serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Matrix3<f64>, D::Error> {
        let rows = <[[f64; 3]; 3]>::deserialize(from)?;
        Ok(Matrix3::from_fn(|i, j| rows[i][j]))
    }
}

/// Conversion of vectors whose missing numbers are null in a file and NaN in memory.
mod nulls {
    use nalgebra::Vector3;
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(of: &[Vector3<f64>], to: S) -> Result<S::Ok, S::Error> {
        let known = |x: f64| (!x.is_nan()).then_some(x);
        to.collect_seq(of.iter().map(|v| [known(v.x), known(v.y), known(v.z)]))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Vector3<f64>>, D::Error> {
        let all = Vec::<[Option<f64>; 3]>::deserialize(from)?;
        Ok(all.into_iter().map(|v| Vector3::from(v.map(|x| x.unwrap_or(f64::NAN)))).collect())
    }
}

/// Conversion of a number that may be null in a file and is then NaN in memory.
mod null_number {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(of: &f64, to: S) -> Result<S::Ok, S::Error> {
        (!of.is_nan()).then_some(*of).serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
        Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
    }
}

/// Conversion of numbers some of which are null in a file and NaN in memory.
mod null_numbers {
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(of: &[f64], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(of.iter().map(|x| (!x.is_nan()).then_some(*x)))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f64>, D::Error> {
        let all = Vec::<Option<f64>>::deserialize(from)?;
        Ok(all.into_iter().map(|x| x.unwrap_or(f64::NAN)).collect())
    }
}
