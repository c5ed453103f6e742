//! Conversion between natural units and metres, kilograms and seconds.
//!
//! ```text
//! length R,   time sqrt(R/g),   energy M g R,   angular velocity sqrt(g/R),   moment of inertia M R^2
//! ```
//! R is the outer radius of the body, or the largest semi-axis of a stone ([`unit`](super::stone::Ellipsoid::unit)).
//! Every conversion is one multiplication or division by a unit, which has a few rounding errors. A number that is
//! converted to SI and back changes by at most 2 ulp, as a test of `units` checks.
//!
//! ```
//! let coin = spincyl::Scale::new(12e-3, 8e-3, 9.81)?;
//! assert!((coin.seconds(1.0) - 0.034_975).abs() < 1e-6); // sqrt(R/g)
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::loss::Law;
use crate::error::{Error, within};

/// Converts between natural units and metres, kilograms and seconds.
///
/// ```
/// use spincyl::{Scale, loss::Law};
///
/// let coin = Scale::new(12e-3, 8e-3, 9.81)?;
/// assert_eq!(coin.metres(coin.length(0.3)), 0.3);
/// let arm = coin.coefficient(Law::RollingResistance, 0.02e-3); // of 0.02 mm
/// assert!((arm - 0.02 / 12.0).abs() < 1e-18);
/// # Ok::<(), spincyl::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(try_from = "ScaleFile"))]
pub struct Scale {
    radius: f64,
    mass: f64,
    gravity: f64,
}

/// The three numbers of a scale in a file.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct ScaleFile {
    radius: f64,
    mass: f64,
    gravity: f64,
}

#[cfg(feature = "serde")]
impl TryFrom<ScaleFile> for Scale {
    type Error = Error;

    fn try_from(ScaleFile { radius, mass, gravity }: ScaleFile) -> Result<Self, Error> {
        Self::new(radius, mass, gravity)
    }
}

/// The two conversions of each quantity, from the table below.
macro_rules! quantities {
    ($($name:literal $natural:ident <-> $si:ident $spelled:literal = |$scale:ident| $unit:expr,)+) => {
        impl Scale {
            $(#[doc = concat!("Converts ", $name, " from natural units to ", $spelled, ".")]
            pub fn $si(&self, $natural: f64) -> f64 {
                let $scale = self;
                $natural * $unit
            }

            #[doc = concat!("Converts ", $name, " from ", $spelled, " to natural units.")]
            pub fn $natural(&self, $si: f64) -> f64 {
                let $scale = self;
                $si / $unit
            })+
        }
    };
}

quantities! {
    "a length" length <-> metres "metres" = |s| s.radius,
    "a time" time <-> seconds "seconds" = |s| s.second(),
    "a speed" speed <-> metres_per_second "metres per second" = |s| s.radius / s.second(),
    "an angular velocity" angular_velocity <-> radians_per_second "radians per second" = |s| 1.0 / s.second(),
    "an angular velocity" turning <-> turns "turns per second" = |s| 1.0 / (core::f64::consts::TAU * s.second()),
    "a force" force <-> newtons "newtons" = |s| s.mass * s.gravity,
    "an impulse" impulse <-> newton_seconds "newton seconds" = |s| s.mass * s.gravity * s.second(),
    "an energy" energy <-> joules "joules" = |s| s.joule(),
    "a couple" couple <-> newton_metres "newton metres" = |s| s.joule(),
    "a power" power <-> watts "watts" = |s| s.joule() / s.second(),
    "a moment of inertia" moment <-> kilogram_square_metres "kg m^2" = |s| s.mass * s.radius * s.radius,
}

impl core::fmt::Display for Scale {
    /// The radius, the mass and gravity in SI.
    ///
    /// ```
    /// let coin = spincyl::Scale::new(12e-3, 8e-3, 9.81)?;
    /// assert_eq!(coin.to_string(), "R = 0.012 m, M = 0.008 kg, g = 9.81 m/s^2");
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { radius, mass, gravity } = self;
        write!(f, "R = {radius:?} m, M = {mass:?} kg, g = {gravity:?} m/s^2")
    }
}

impl Scale {
    /// The scale of a rim radius in metres, a mass in kilograms and gravity in m/s^2; all are positive and finite.
    ///
    /// # Errors
    /// `OutOfRange` for a number outside [1e-100, 1e100].
    pub fn new(radius: f64, mass: f64, gravity: f64) -> Result<Self, Error> {
        const POSITIVE: (f64, f64) = (1e-100, 1e100);
        within("radius", radius, POSITIVE, "1e-100 <= radius <= 1e100 (metres)")?;
        within("mass", mass, POSITIVE, "1e-100 <= mass <= 1e100 (kilograms)")?;
        within("gravity", gravity, POSITIVE, "1e-100 <= gravity <= 1e100 (m/s^2)")?;
        Ok(Self { radius, mass, gravity })
    }

    /// The coefficient of a loss law in natural units, from its value in SI, in the unit of that law ([`Law`]).
    pub fn coefficient(&self, law: Law, in_si: f64) -> f64 {
        in_si / self.unit_of(law)
    }

    /// The coefficient of a loss law in SI, from its value in natural units.
    pub fn coefficient_in_si(&self, law: Law, coefficient: f64) -> f64 {
        coefficient * self.unit_of(law)
    }

    fn unit_of(&self, law: Law) -> f64 {
        let [metres, seconds, joules] = law.unit().exponents();
        self.radius.powf(metres) * self.second().powf(seconds) * self.joule().powf(joules)
    }

    fn second(&self) -> f64 {
        (self.radius / self.gravity).sqrt()
    }

    fn joule(&self) -> f64 {
        self.mass * self.gravity * self.radius
    }

    /// The unit of length R, the outer radius of the rim, in metres.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The unit of mass M, the mass of the body, in kilograms.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// The acceleration of gravity, in m/s^2.
    pub fn gravity(&self) -> f64 {
        self.gravity
    }

    /// The rim radius in metres, the mass in kilograms and gravity in m/s^2.
    pub(crate) fn numbers(&self) -> [f64; 3] {
        [self.radius, self.mass, self.gravity]
    }
}
