//! Measured bodies: a body with its size and mass, whose motions are in metres, kilograms and seconds.
//!
//! ```text
//! ell = height/R,   I1 = i1/(M R^2),   I3 = i3/(M R^2),   R = outer_diameter/2 of a tube
//! ```
//! A motion is computed in natural units like any other motion. Its times are given in seconds, and each [`Reading`]
//! is in SI, along the axes of the laboratory: z is up, the table is z = 0, and the body is inclined from +x at time
//! 0. States, slips and coefficients stay in natural units; [`Scale`] converts them. Error: that of the motion, and a
//! few roundings of double precision.
//!
//! ```
//! use spincyl::measured::{Measured, Tube};
//!
//! let coin = Measured::tube(&Tube::solid(24e-3, 2e-3, 8e-3))?; // metres, kilograms
//! assert_eq!(coin.scale().newtons(1.0), 8e-3 * 9.80665); // its weight
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::{Ask, Bounds, Ending, Kind, Motion, Start, motion};
use crate::error::{Error, within};
use crate::laws::body::Body;
use crate::laws::pose::{EulerAngles, Pose, euler_angles};
use crate::laws::scale::Scale;
use crate::laws::state::State;
use core::f64::consts::FRAC_PI_4;
use nalgebra::{Point3, UnitQuaternion, Vector3};

/// The dimensions of a uniform tube. A solid cylinder has `inner_diameter` 0, and a sharp rim `fillet` 0.
///
/// ```
/// use spincyl::measured::{Measured, Tube};
///
/// let coin = Tube::solid(24e-3, 2e-3, 8e-3);
/// assert_eq!(Measured::tube(&coin)?.body().ell(), 2.0 / 24.0);
/// # Ok::<(), spincyl::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[non_exhaustive]
pub struct Tube {
    /// Outer diameter, in metres.
    pub outer_diameter: f64,
    /// Inner diameter, in metres.
    pub inner_diameter: f64,
    /// Length, in metres.
    pub length: f64,
    /// Radius of the outer edges, in metres.
    pub fillet: f64,
    /// Mass, in kilograms.
    pub mass: f64,
    /// Acceleration of gravity, in m/s^2.
    pub gravity: f64,
}

impl Default for Tube {
    /// All dimensions are 0, and gravity is the standard 9.80665 m/s^2.
    fn default() -> Self {
        Self {
            outer_diameter: 0.0,
            inner_diameter: 0.0,
            length: 0.0,
            fillet: 0.0,
            mass: 0.0,
            gravity: 9.80665,
        }
    }
}

impl Tube {
    /// A solid cylinder of this outer diameter, length and mass, in metres and kilograms, on the Earth.
    pub fn solid(outer_diameter: f64, length: f64, mass: f64) -> Self {
        Self { outer_diameter, length, mass, ..Self::default() }
    }

    /// Returns this tube with this outer diameter, in metres.
    #[must_use]
    pub fn with_outer_diameter(self, outer_diameter: f64) -> Self {
        Self { outer_diameter, ..self }
    }

    /// Returns this tube with this inner diameter, in metres.
    #[must_use]
    pub fn with_inner_diameter(self, inner_diameter: f64) -> Self {
        Self { inner_diameter, ..self }
    }

    /// Returns this tube with this length, in metres.
    #[must_use]
    pub fn with_length(self, length: f64) -> Self {
        Self { length, ..self }
    }

    /// Returns this tube with this radius of the outer edges, in metres.
    #[must_use]
    pub fn with_fillet(self, fillet: f64) -> Self {
        Self { fillet, ..self }
    }

    /// Returns this tube with this mass, in kilograms.
    #[must_use]
    pub fn with_mass(self, mass: f64) -> Self {
        Self { mass, ..self }
    }

    /// Returns this tube with this acceleration of gravity, in m/s^2.
    #[must_use]
    pub fn with_gravity(self, gravity: f64) -> Self {
        Self { gravity, ..self }
    }
}

/// Height, edge radius and moments of inertia of a body, in SI, for [`Measured::with_moments`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MeasuredMoments {
    /// Height of the centre of mass above the circle of the rim, in metres.
    pub height: f64,
    /// Radius of the rounded edge, in metres.
    pub fillet: f64,
    /// Moment of inertia about a diameter through the centre of mass, in kg m^2.
    pub i1: f64,
    /// Moment of inertia about the axis, in kg m^2.
    pub i3: f64,
}

impl MeasuredMoments {
    /// A body with a sharp edge: the height of its centre of mass in metres, and its moments in kg m^2.
    pub fn new(height: f64, i1: f64, i3: f64) -> Self {
        Self { height, fillet: 0.0, i1, i3 }
    }

    /// Returns a copy with this radius of the rounded edge, in metres.
    #[must_use]
    pub fn with_fillet(self, fillet: f64) -> Self {
        Self { fillet, ..self }
    }
}

/// A body in natural units, with its size and mass in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Measured {
    body: Body,
    scale: Scale,
}

/// The state of a body at one time, in SI along the axes of the laboratory.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Reading {
    /// The time in seconds.
    pub time: f64,
    /// The inclination in radians.
    pub theta: f64,
    /// The centre of mass in metres.
    pub position: Point3<f64>,
    /// The rotation from the axes of the body, of which the third is the symmetry axis, to those of the laboratory.
    pub orientation: UnitQuaternion<f64>,
    /// The velocity of the centre of mass in m/s.
    pub velocity: Vector3<f64>,
    /// The angular velocity in rad/s.
    pub angular_velocity: Vector3<f64>,
    /// The contact point in metres; in the air, the lowest point of the rim; for a body on both rims, one of the two
    /// points.
    pub contact_point: Point3<f64>,
    /// The force of the table on the body in newtons, summed over both rims if both touch; zero in the air.
    pub force: Vector3<f64>,
    /// Kinetic and potential energy in joules.
    pub energy: f64,
    /// What the body is doing, such as rolling or slipping; None if there is no law of friction, no loss and no
    /// restitution.
    pub kind: Option<Kind>,
}

/// A motion of a measured body; [`readings`](Self::readings) are its states in SI.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct MeasuredMotion {
    /// The motion in natural units.
    pub natural: Motion,
    /// The measured body that moves.
    pub of: Measured,
    /// The requested times in seconds.
    pub seconds: Vec<f64>,
    /// The angle psi of the body about its axis at the start, in radians: 0 unless the start was given as a pose
    /// ([`world`](super::world)).
    #[cfg_attr(feature = "serde", serde(default))]
    pub turn: f64,
}

impl core::fmt::Display for Measured {
    /// Writes the body in natural units (ell, I1, I3), then R, M and g in SI.
    ///
    /// ```
    /// use spincyl::measured::{Measured, Tube};
    ///
    /// let coin = Measured::tube(&Tube::solid(24e-3, 3e-3, 8e-3).with_gravity(9.81))?;
    /// let told = coin.to_string();
    /// assert!(told.starts_with("ell = 0.125, I1 = 0.255") && told.contains(", I3 = 0.5; R = 0.012 m"));
    /// assert!(told.ends_with(", M = 0.008 kg, g = 9.81 m/s^2"));
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{}; {}", self.body, self.scale)
    }
}

impl Measured {
    /// Makes a measured body from a body in natural units and the sizes of these units in SI.
    pub fn new(body: Body, scale: Scale) -> Self {
        Self { body, scale }
    }

    /// Makes a measured body from the dimensions of a uniform tube.
    ///
    /// # Errors
    /// Those of [`Body::from_metres`] and of [`Scale::new`], and `OutOfRange` for a tube with a density below 0.01
    /// kg/m^3, a hundredth of that of air, which it has if its lengths are in millimetres.
    pub fn tube(of: &Tube) -> Result<Self, Error> {
        let body = Body::from_metres(of.outer_diameter, of.inner_diameter, of.length, of.fillet)?;
        let wall = (of.outer_diameter - of.inner_diameter) * (of.outer_diameter + of.inner_diameter);
        let least = 0.01 * FRAC_PI_4 * wall * of.length;
        within(
            "mass",
            of.mass,
            (least, f64::MAX),
            "a mass in kg with which, for lengths in metres, the density is 0.01 kg/m^3 or more",
        )?;
        Ok(Self::new(body, Scale::new(0.5 * of.outer_diameter, of.mass, of.gravity)?))
    }

    /// Makes a body of revolution with the radius and mass of `scale` and these moments of inertia.
    ///
    /// ```
    /// use spincyl::measured::{Measured, MeasuredMoments};
    /// use spincyl::{Body, Scale};
    ///
    /// let coin = Scale::new(12e-3, 8e-3, 9.81)?;
    /// let measured = Measured::with_moments(coin, &MeasuredMoments::new(1e-3, 2.9e-7, 5.76e-7))?;
    /// assert!((measured.body().i3() - 0.5).abs() < 1e-15);
    /// assert!(Measured::with_moments(coin, &MeasuredMoments::new(1e-3, 0.25, 0.5)).is_err()); // in M R^2
    /// assert!(Body::new(1.0 / 12.0, 2.9e-7, 5.76e-7).is_err()); // in kg m^2
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Body::rounded`], and `OutOfRange` for moments that are so small or large for this mass and radius
    /// that they must be in another unit.
    pub fn with_moments(scale: Scale, of: &MeasuredMoments) -> Result<Self, Error> {
        let &MeasuredMoments { height, fillet, i1, i3 } = of;
        let [low, high] = [1e-3, 1e4].map(|natural| scale.kilogram_square_metres(natural));
        within("i1", i1, (low, high), "a moment of inertia in kg m^2, from 1e-3 to 1e4 M R^2")?;
        within("i3", i3, (0.0, high), "a moment of inertia in kg m^2, at most 1e4 M R^2")?;
        let (ell, rho) = (scale.length(height), scale.length(fillet));
        Ok(Self::new(Body::rounded(ell, scale.moment(i1), scale.moment(i3), rho)?, scale))
    }

    /// The body in natural units.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The natural units of the body.
    pub fn scale(&self) -> &Scale {
        &self.scale
    }

    /// Computes the motion from a start, at these times in seconds, always with poses and forces. The start and the
    /// options are in natural units. `go_on` is as for [`roll_with`](motion::roll_with), whose times are in natural
    /// units.
    ///
    /// ```
    /// use spincyl::{measured::{Measured, Tube}, motion::Ask, steady};
    ///
    /// let tube = Tube::solid(15.875e-3, 95.25e-3, 20e-3).with_inner_diameter(12.7e-3);
    /// let pipe = Measured::tube(&tube)?;
    /// let start = steady::state(pipe.body(), 1.4)?.kicked(0.05);
    /// let motion = pipe.roll(start, &[0.0, 1.0, 2.0], &Ask::default(), || true)?.expect("not interrupted");
    /// let last = motion.readings().last().unwrap();
    /// assert_eq!((last.time, (1e3 * last.force.z).round()), (2.0, 178.0)); // seconds, millinewtons
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`roll_with`](motion::roll_with).
    pub fn roll(
        &self,
        start: impl Into<Start>,
        seconds: &[f64],
        ask: &Ask,
        go_on: impl FnMut() -> bool,
    ) -> Result<Option<MeasuredMotion>, Error> {
        let times: Vec<f64> = seconds.iter().map(|t| self.scale.time(*t)).collect();
        let ask = ask.with_pose().with_force();
        let found = motion::roll_with(&self.body, start, &times, &ask, go_on)?;
        Ok(found.map(|natural| MeasuredMotion { natural, of: *self, seconds: seconds.to_vec(), turn: 0.0 }))
    }
}

impl MeasuredMotion {
    /// Returns the state of the body at each requested time, in SI.
    pub fn readings(&self) -> impl Iterator<Item = Reading> {
        let Measured { body, scale } = &self.of;
        let length = |x: f64| scale.metres(x);
        let own = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.turn);
        self.natural.samples().zip(&self.seconds).filter_map(move |(now, seconds)| {
            let pose = now.pose?;
            let lowest = Point3::new(pose.contact_point.x, pose.contact_point.y, pose.height);
            Some(Reading {
                time: *seconds,
                theta: now.state.theta,
                position: now.centre(body)?.map(length),
                orientation: now.orientation()? * own,
                velocity: now.velocity(body)?.map(|v| scale.metres_per_second(v)),
                angular_velocity: now.angular_velocity()?.map(|w| scale.radians_per_second(w)),
                contact_point: lowest.map(length),
                force: now.force_in_laboratory()?.map(|f| scale.newtons(f)),
                energy: scale.joules(now.energy(body)?),
                kind: now.kind,
            })
        })
    }

    /// Returns the states in SI of a motion whose start [`Start::from_twist`] made from this orientation, with the
    /// centre of mass above the point `(x, y)` of the table, in metres, at the start.
    ///
    /// ```
    /// use spincyl::{measured::{Measured, Tube}, motion::{Ask, Start}};
    /// use spincyl::nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let can = Measured::tube(&Tube::solid(0.05, 0.02, 0.1))?;
    /// let (q, w) = (UnitQuaternion::from_euler_angles(0.7, 0.3, 1.2), Vector3::new(1.0, -2.0, 5.0));
    /// let (turning, up) = (w.map(|w| can.scale().angular_velocity(w)), can.scale().length(0.2));
    /// let start = Start::from_twist(can.body(), &q, turning, Vector3::zeros(), Some(up))?;
    /// let motion = can.roll(start, &[0.0, 0.1], &Ask::default().with_restitution(0.5), || true)?.unwrap();
    /// let first = motion.readings_from(&q, [0.3, 0.4]).next().unwrap();
    /// assert!(first.orientation.angle_to(&q) < 1e-7 && (first.angular_velocity - w).norm() < 1e-13);
    /// assert!((first.position.coords - Vector3::new(0.3, 0.4, 0.2)).norm() < 1e-15);
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    pub fn readings_from(
        &self,
        orientation: &UnitQuaternion<f64>,
        [x, y]: [f64; 2],
    ) -> impl Iterator<Item = Reading> {
        let EulerAngles { phi, theta, psi } = euler_angles(orientation);
        let [world, own] = [phi, psi].map(|by| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), by));
        let state = State { theta, w1: 0.0, w2: 0.0, w3: 0.0 };
        let Point3 { coords: began } = Pose::start().centre(&self.of.body().told_at(theta), &state);
        let [ahead, aside] = [began.x, began.y].map(|x| self.of.scale.metres(x));
        let placed =
            move |p: Point3<f64>| world * (p - Vector3::new(ahead, aside, 0.0)) + Vector3::new(x, y, 0.0);
        self.readings().map(move |now| Reading {
            position: placed(now.position),
            orientation: world * now.orientation * own,
            velocity: world * now.velocity,
            angular_velocity: world * now.angular_velocity,
            contact_point: placed(now.contact_point),
            force: world * now.force,
            ..now
        })
    }

    /// Bounds of the errors at any time, in SI. The bound for the states is one number, for angles in radians, rates
    /// in rad/s and times in seconds.
    pub fn bounds(&self) -> Bounds {
        let (found, scale) = (self.natural.bounds(self.of.body()), &self.of.scale);
        Bounds {
            state: found.state * scale.radians_per_second(1.0).max(scale.seconds(1.0)).max(1.0),
            position: scale.metres(found.position),
            velocity: scale.metres_per_second(found.velocity),
            angular_velocity: scale.radians_per_second(found.angular_velocity),
            force: scale.newtons(found.force),
            energy: scale.joules(found.energy),
            ..found
        }
    }

    /// Why the motion ended, and when, in seconds; no time if it reached the last requested time.
    pub fn end(&self) -> (Ending, Option<f64>) {
        let scale = &self.of.scale;
        (self.natural.ending(), self.natural.event.map(|event| scale.seconds(event.time)))
    }
}
