//! Natural units in metres, kilograms and seconds.
//!
//! ```text
//! length R,   time sqrt(R/g),   energy M g R,   angular velocity sqrt(g/R)
//! ```
//! R is the outer radius of the body. Error: a few roundings.

use crate::error::{Error, within};

/// Turns natural units into metres, kilograms and seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    radius: f64,
    mass: f64,
    gravity: f64,
}

impl Scale {
    /// The scale of a rim radius in metres, a mass in kilograms and gravity in m/s^2; all are positive and finite.
    pub fn new(radius: f64, mass: f64, gravity: f64) -> Result<Self, Error> {
        const POSITIVE: (f64, f64) = (1e-100, 1e100);
        within("radius", radius, POSITIVE, "1e-100 <= radius <= 1e100 (metres)")?;
        within("mass", mass, POSITIVE, "1e-100 <= mass <= 1e100 (kilograms)")?;
        within("gravity", gravity, POSITIVE, "1e-100 <= gravity <= 1e100 (m/s^2)")?;
        Ok(Self { radius, mass, gravity })
    }

    /// A length in metres.
    pub fn metres(&self, length: f64) -> f64 {
        length * self.radius
    }

    /// A time in seconds.
    pub fn seconds(&self, time: f64) -> f64 {
        time * (self.radius / self.gravity).sqrt()
    }

    /// An energy in joules.
    pub fn joules(&self, energy: f64) -> f64 {
        energy * self.mass * self.gravity * self.radius
    }

    /// An angular velocity in turns per second.
    pub fn turns(&self, angular_velocity: f64) -> f64 {
        angular_velocity / (core::f64::consts::TAU * self.seconds(1.0))
    }
}
