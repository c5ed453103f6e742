//! Loss laws: each law gives a couple on the body and the power that the couple takes.
//!
//! ```text
//! s, c = sine, cosine of theta,   h = c e1 - s e3 horizontal in the leaning plane,   A as in `body::rim`
//! psi' = w3 - ct w1 along the rim,   w_h = w.h = -s psi' rolling,   w2 rocking,   w_z = s w1 + c w3 drilling
//! couple m on the body, about any point;   power P = -m.w >= 0;   dE/dt = -P
//! P = Lam |psi'|:   m = Lam sgn(psi') h/s, the one couple that gives this power for every w
//! ```
//! The couple of a law that acts through the speed A |psi'| of the contact is that of a normal force which acts ahead
//! of the contact point along its path, by Lam/(N s). A distance beyond A has no meaning, so that dry contour friction
//! is valid down to theta ~ eps.
//! Every law is linear in its one coefficient, and laws add: a set of laws is one coefficient for each law, with 0 for
//! an absent law. Which law takes a coin's energy is debated (Moffatt 2000, van den Engh 2000, Bildsten 2002, Leine
//! 2009), and no law is preferred here.
//!
//! Where the motion that dry friction resists comes to rest, a dry law only gives the largest couple. The couple here
//! is then zero, and the module `motion` computes the couple that acts.
//!
//! Error: a few roundings of the terms written in each law; a property of `losses` says P = -m.w.
//!
//! ```
//! use spincyl::loss::{Law, Losses};
//! use spincyl::{Body, steady};
//!
//! let coin = Body::solid(0.0)?;
//! let state = steady::state(&coin, 0.5)?;
//! let power = Losses::of(Law::ViscousContour, 1e-3).power(&coin, &state, 1.0);
//! assert!((power / (1e-3 * state.spin().powi(2)) - 1.0).abs() < 1e-12); // c (A psi')^2
//! # Ok::<(), spincyl::Error>(())
//! ```

mod air_film;
mod air_linear;
mod air_quadratic;
mod boundary_layer;
mod couples;
mod drilling;
mod dry_contour;
#[cfg(feature = "serde")]
mod file;
mod law;
mod rolling_resistance;
mod viscous_contour;

use super::body::Body;
use super::state::State;
use crate::error::{Error, within};
use crate::numbers::Real;
use crate::numbers::codes::coded;
use core::ops::Add;
pub(crate) use couples::{
    Couple, Couples, GRACE, Holds, Kinematics, NEAR, OwnCouple, SLACK, UnderCouple, Ways, going,
    reversed_turns, rolling_couple_needed, rolling_growth, rounded,
};
pub(crate) use law::{EndPowers, LossLaw, Resists, Speed, Unit};

/// Defines the enumeration of the laws from the table below, and the calls of the types that implement them. The laws
/// are called by `match`, so that they are inlined in SIMD lanes.
macro_rules! laws {
    ($(#[$about:meta])* pub enum $Laws:ident {
        $($(#[$doc:meta])* $Law:ident = $code:literal in $file:ident,)+
    }) => {
        coded! {
            $(#[$about])*
            pub enum $Laws { $($(#[$doc])* $Law = $code,)+ }
        }

        impl $Laws {
            /// Calls `f` for each law in turn. The calls are written out, without a loop that the compiler may keep, so
            /// that each law is known at compile time.
            #[inline(always)]
            fn each(mut f: impl FnMut(Self)) {
                $(f(Self::$Law);)+
            }

            /// The name of the coefficient of this law.
            pub fn parameter(self) -> &'static str {
                match self { $(Self::$Law => $file::$Law::PARAMETER,)+ }
            }

            /// The formula of the couple of this law in the symbols of a scene file, with the coefficient in SI.
            #[cfg(any(feature = "python", feature = "scene"))]
            pub(crate) fn couple_in_si(self) -> &'static str {
                match self { $(Self::$Law => $file::$Law::COUPLE,)+ }
            }

            /// The unit of the coefficient of this law.
            pub(crate) const fn unit(self) -> Unit {
                match self { $(Self::$Law => $file::$Law::UNIT,)+ }
            }

            /// The motion that this law resists.
            #[inline(always)]
            pub(crate) const fn resists(self) -> Resists {
                match self { $(Self::$Law => $file::$Law::RESISTS,)+ }
            }

            /// Whether this law is dry: proportional to the normal force and to the sign of a motion.
            #[inline(always)]
            pub(crate) const fn presses(self) -> bool {
                match self { $(Self::$Law => $file::$Law::PRESSES,)+ }
            }

            /// Whether this law needs a flat face of the body above the table.
            const fn needs_face(self) -> bool {
                match self { $(Self::$Law => $file::$Law::NEEDS_FACE,)+ }
            }

            /// The speed at whose zero this law is not smooth; None if it is smooth.
            #[inline(always)]
            const fn root(self) -> Option<Speed> {
                match self { $(Self::$Law => $file::$Law::ROOT,)+ }
            }

            /// The exponents of the power of this law near the ends of a drift.
            pub(crate) const fn powers(self) -> EndPowers {
                match self { $(Self::$Law => $file::$Law::POWERS,)+ }
            }

            /// The couple along e1, e2, e3 for a coefficient of 1, and for N = 1 if the law is dry.
            #[cfg(test)]
            fn couple<T: Real>(self, seen: &Kinematics<T>) -> [T; 3] {
                match self { $(Self::$Law => $file::$Law::couple(seen),)+ }
            }

            /// The power that the couple takes for a coefficient of 1, and for N = 1 if the law is dry.
            #[cfg(test)]
            fn power<T: Real>(self, seen: &Kinematics<T>) -> T {
                match self { $(Self::$Law => $file::$Law::power(seen),)+ }
            }

            /// For the couple X h/s of a law along the contour, the derivative of X with respect to psi'.
            #[cfg(test)]
            fn slope<T: Real>(self, coefficient: T, s: T, radius: T, spin: T) -> T {
                match self { $(Self::$Law => $file::$Law::slope(coefficient, s, radius, spin),)+ }
            }
        }

        /// The sums over all laws are written out, law by law: a loop with a `match` costs motions in SIMD lanes and
        /// single motions up to a tenth of their time.
        impl<T: Real, G: OwnCouple<T>> Couples<T, G> {
            /// The couple of all laws that are present.
            #[inline(always)]
            pub fn at(&self, seen: &Kinematics<T>) -> Couple<T> {
                let zero = seen.spin.splat(0.0);
                let (mut free, mut pressed) = ([zero; 3], [zero; 3]);
                if let Some(given) = self.given.couple() {
                    (free, pressed) = (given.free, given.pressed);
                }
                $(if self.present[$code] {
                    let unit = $file::$Law::couple(seen);
                    let to = if $file::$Law::PRESSES { &mut pressed } else { &mut free };
                    for i in 0..3 {
                        to[i] = self.coefficients[$code].mac(unit[i], to[i]);
                    }
                })+
                Couple { free, pressed }
            }

            /// The power that the couples of all laws take under this normal force.
            #[inline(always)]
            pub fn power(&self, seen: &Kinematics<T>, normal: T) -> T {
                let mut power = normal.splat(0.0);
                $(if self.present[$code] {
                    let unit = $file::$Law::power(seen);
                    let unit = if $file::$Law::PRESSES { unit * normal } else { unit };
                    power = self.coefficients[$code].mac(unit, power);
                })+
                if let Some(given) = self.given.couple() {
                    for (m, w) in given.under(normal).into_iter().zip(seen.w) {
                        power = power - m * w;
                    }
                }
                if let Some(own) = self.given.power_taken(seen, normal) {
                    power = power + own;
                }
                power
            }

            /// For the total couple X h/s of the laws along the contour, the derivative of X with respect to psi'.
            #[inline(always)]
            pub fn slope(&self, s: T, radius: T, spin: T) -> T {
                let mut slope = s.splat(0.0);
                $(if Law::$Law.is_soft() && self.present[$code] {
                    slope = slope + $file::$Law::slope(self.coefficients[$code], s, radius, spin);
                })+
                slope
            }
        }
    };
}

// The table: a law, its number, and the file in which the type of the same name implements it. CONTRIBUTING.md explains
// how to add a law.
laws! {
    /// A loss law. The number of a law is its index among the coefficients, which are in natural units;
    /// [`Scale::coefficient`](crate::Scale::coefficient) converts them from SI.
    pub enum Law {
        /// Dry friction along the contour of the rim, with the power eps N A |psi'|. Unit of eps: R, in SI metres.
        DryContour = 0 in dry_contour,
        /// Viscous friction along the contour of the rim, with the power c (A psi')^2. Unit of c: M R sqrt(g R), in SI N m s.
        ViscousContour = 1 in viscous_contour,
        /// Rolling resistance, with the power delta N sqrt(w_h^2 + w2^2). Unit of delta: R, in SI metres.
        RollingResistance = 2 in rolling_resistance,
        /// Drilling friction, with the power length N |w_z|. Unit of length: R, in SI metres.
        Drilling = 3 in drilling,
        /// Resistance of the air linear in w, with the power b w.w. Unit of b: M R sqrt(g R), in SI N m s.
        AirLinear = 4 in air_linear,
        /// Resistance of the air quadratic in w, with the power b2 |w|^3. Unit of b2: M R^2, in SI N m s^2.
        AirQuadratic = 5 in air_quadratic,
        /// A viscous film of air under the face, with the power (pi/4) viscosity psi'^2/s. Unit: M g^(1/2)/R^(3/2), in
        /// SI Pa s.
        AirFilm = 6 in air_film,
        /// Boundary layers of the air under the face, with the power k |psi'|^(5/2). Unit of k: M g^(1/4) R^(7/4),
        /// in SI N m s^(3/2).
        BoundaryLayer = 7 in boundary_layer,
    }
}

/// The number of loss laws.
pub(crate) const COUNT: usize = Law::ALL.len();

// The number of a law is its index.
const _: () = {
    let mut i = 0;
    while i < COUNT {
        assert!(Law::ALL[i] as usize == i, "the table has the laws in the order of their numbers");
        i += 1;
    }
};

impl Law {
    /// The exponent q in theta ~ tau^q of a thin disk, with tau the remaining time; None if the disk never stops.
    pub fn exponent(self) -> Option<f64> {
        // The energy of a thin disk falls as theta, so that tau ~ theta^(1 - p) with P ~ theta^p.
        let [thin, _] = self.powers().face;
        (thin < 1.0).then(|| 1.0 / (1.0 - thin))
    }

    /// Whether the law acts through the rolling of the contact along the contour of the rim.
    #[inline(always)]
    pub(crate) const fn is_along_contour(self) -> bool {
        matches!(self.resists(), Resists::Contour)
    }

    /// Whether the law acts on a body in the air, which has neither a contact nor a gap under its face.
    pub(crate) const fn acts_in_air(self) -> bool {
        matches!(self.resists(), Resists::All)
    }

    /// Whether the law acts along the contour and its couple grows with the speed of the contact along the rim.
    #[inline(always)]
    pub(crate) const fn is_soft(self) -> bool {
        self.is_along_contour() && !self.presses()
    }

    /// Whether the law has a couple about e2, the axis about which the body rocks.
    #[inline(always)]
    pub(crate) const fn tilts(self) -> bool {
        matches!(self.resists(), Resists::Rolling | Resists::All)
    }

    /// Whether a face lands only after infinitely many turns under this law, unless a law along the contour stops the contact.
    #[inline(always)]
    pub(crate) const fn turns_endlessly(self) -> bool {
        self.presses() && !self.is_along_contour()
    }
}

/// The coefficients of all loss laws; the coefficient of an absent law is 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "std::collections::BTreeMap<Law, f64>", into = "std::collections::BTreeMap<Law, f64>")
)]
pub struct Losses {
    /// The coefficients in natural units, in the order of [`Law::ALL`].
    pub(crate) coefficients: [f64; COUNT],
}

/// The times at which rolling resistance acts on a body whose contact point may slip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Resistance {
    /// Rolling resistance acts whether the contact point slips or not.
    #[default]
    Always,
    /// Rolling resistance acts only while the contact point does not slip, as in most programs for billiards.
    WhileRolling,
}

impl Losses {
    /// Losses whose coefficients are all 0: no energy is lost.
    pub const NONE: Self = Self { coefficients: [0.0; COUNT] };

    /// The losses of a single law with this coefficient, in natural units.
    ///
    /// ```
    /// use spincyl::loss::{Law, Losses};
    ///
    /// let both = Losses::of(Law::DryContour, 5e-3) + Losses::of(Law::AirFilm, 1e-7);
    /// assert_eq!((both.coefficient(Law::AirFilm), both.iter().count()), (1e-7, 2));
    /// ```
    pub fn of(law: Law, coefficient: f64) -> Self {
        Self::NONE.with(law, coefficient)
    }

    /// Returns these losses with this coefficient of a law.
    #[must_use]
    pub fn with(mut self, law: Law, coefficient: f64) -> Self {
        self.coefficients[law as usize] = coefficient;
        self
    }

    /// The coefficient of a law; 0 if it is absent.
    pub fn coefficient(&self, law: Law) -> f64 {
        self.coefficients[law as usize]
    }

    /// The laws that are present, with their coefficients, in the order of [`Law::ALL`].
    pub fn iter(&self) -> impl Iterator<Item = (Law, f64)> {
        Law::ALL.iter().copied().zip(self.coefficients).filter(|(_, coefficient)| *coefficient != 0.0)
    }

    /// Checks that each coefficient is in its range.
    ///
    /// # Errors
    /// `OutOfRange`, with the name of the coefficient, for one outside [0, 1e6].
    pub fn check(&self) -> Result<(), Error> {
        for &law in Law::ALL {
            let value = self.coefficient(law);
            within(
                law.parameter(),
                value,
                (0.0, 1e6),
                "a positive number of at most 1e6: a loss takes energy",
            )?;
        }
        Ok(())
    }

    /// Checks the coefficients, and that the body has the flat face that a law may need.
    ///
    /// # Errors
    /// Those of [`check`](Self::check), and `OutOfRange` with the name "fillet" for a ball under a law that needs a
    /// flat face.
    pub fn check_for(&self, body: &Body) -> Result<(), Error> {
        self.check()?;
        let face = Law::ALL.iter().any(|law| law.needs_face() && self.coefficients[*law as usize] != 0.0);
        if face && body.is_ball() {
            let expected = "a body with a flat face above the table, which a law of these losses needs";
            return Err(Error::OutOfRange { name: "fillet", value: body.fillet(), expected });
        }
        Ok(())
    }

    /// Checks the coefficients, and that no law acts along a rim, which a stone does not have.
    ///
    /// # Errors
    /// Those of [`check`](Self::check), and `OutOfRange` with the name of the coefficient of a law that acts along a
    /// rim.
    pub fn check_for_stone(&self) -> Result<(), Error> {
        self.check()?;
        let Some((law, value)) = self.iter().find(|(law, _)| law.is_along_contour()) else { return Ok(()) };
        let name = law.parameter();
        Err(Error::OutOfRange {
            name,
            value,
            expected: "0: this law acts along a rim, which a stone does not have",
        })
    }

    /// Whether all coefficients are 0.
    pub fn is_none(&self) -> bool {
        self.coefficients == [0.0; COUNT]
    }

    /// The coefficient of this law if no other law is present, 0 if no law is; None if another law is present.
    pub(crate) fn is_only(&self, law: Law) -> Option<f64> {
        let coefficient = self.coefficient(law);
        (*self == Self::of(law, coefficient)).then_some(coefficient)
    }

    /// Whether a face lands only after infinitely many turns: some law causes this, and no law along the contour stops
    /// the contact.
    pub(crate) fn turn_endlessly(&self) -> bool {
        self.any(Law::turns_endlessly) && !self.stop_the_contour()
    }

    /// Whether some law along the contour stops the rolling of the contact along the rim.
    pub(crate) fn stop_the_contour(&self) -> bool {
        self.any(Law::is_along_contour)
    }

    fn any(&self, of: fn(Law) -> bool) -> bool {
        Law::ALL.iter().any(|law| of(*law) && self.coefficients[*law as usize] > 0.0)
    }

    /// The power that is lost in a state under a normal force N, in M g R sqrt(g/R). N is in units of the weight, 1 in
    /// a steady state; a negative N counts as 0, and a power under an N that is NaN is NaN if a law is dry.
    pub fn power(&self, body: &Body, y: &State, normal: f64) -> f64 {
        let (of, seen) = (Couples::of(self, |x| x), Kinematics::of_state(body, y));
        of.power(&seen, normal.positive_part())
    }

    /// The couple on the body along e1, e2, e3, in M g R, under a normal force N in units of the weight.
    pub fn couple(&self, body: &Body, y: &State, normal: f64) -> [f64; 3] {
        let (of, seen) = (Couples::of(self, |x| x), Kinematics::of_state(body, y));
        let pressed = if self.any(Law::presses) { normal.positive_part() } else { 0.0 };
        of.at(&seen).under(pressed)
    }
}

impl core::fmt::Display for Losses {
    /// Writes the laws that are present, each with the name and the value of its coefficient.
    ///
    /// ```
    /// use spincyl::loss::{Law, Losses};
    ///
    /// let both = Losses::of(Law::DryContour, 5e-3) + Losses::of(Law::AirFilm, 1e-7);
    /// assert_eq!(both.to_string(), "dry contour: eps = 0.005, air film: viscosity = 1e-7");
    /// assert_eq!(Losses::NONE.to_string(), "no losses");
    /// ```
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        if self.iter().next().is_none() {
            return f.write_str("no losses");
        }
        for (k, (law, coefficient)) in self.iter().enumerate() {
            let before = if k > 0 { ", " } else { "" };
            write!(f, "{before}{law}: {} = {coefficient:?}", law.parameter())?;
        }
        Ok(())
    }
}

impl Add for Losses {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { coefficients: core::array::from_fn(|i| self.coefficients[i] + other.coefficients[i]) }
    }
}
