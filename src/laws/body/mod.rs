//! The body: its moments of inertia, its rim, and the limits of its inclination.
//!
//! ```text
//! two balls:           rho = 1, I3 = 2/5,  I1 = 2/5 + ell^2,   their centres 2 ell apart
//! inertia excess       d = I1/I3 - 1;  d = 0 is critical
//! balance              tan theta0 = a/ell;     limit:  I1 a/sin - I3 ell/cos + (I1 - I3) rho = 0 at thetaInf
//! ```
//! Lengths are in units of the outer radius R, moments of inertia in M R^2. `ell` is the height of the centre of mass
//! above the circle of the rim. `body::rim` gives the contact of the rim with the table, `body::tube` the moments of
//! uniform tubes. Sources: Jackson et al., Am. J. Phys. 87, 85 (2019), Sec. II, for the sharp rim; Jackson, Mertens,
//! Pearson, Am. J. Phys. 83, 959 (2015), for two balls.
//!
//! The constructors return an error for numbers that no body can have; no later code checks them again. The inertia
//! excess is kept as an unevaluated sum of two doubles, because the steady states of a body near the critical shape
//! depend on the last digits of the excess; `body::tube` gives its error.
//!
//! ```
//! use spincyl::Body;
//!
//! // At the critical length both moments of inertia are equal, and so are theta0 and thetaInf.
//! let can = Body::solid(Body::critical_aspect(0.0, 0.0)?)?;
//! assert!(can.excess().abs() < 1e-15 && (can.theta_balance() - can.theta_limit()).abs() < 1e-14);
//! # Ok::<(), spincyl::Error>(())
//! ```

mod apex;
mod circles;
#[cfg(feature = "serde")]
mod file;
mod hull;
mod makers;
pub mod parts;
mod profile;
pub(crate) mod rim;
mod tube;

use crate::error::{Error, within};
use crate::methods::search;
use crate::numbers::{Real, SinCos, Sum, sincos};
pub use apex::Apex;
pub use circles::CircleBorder;
pub(crate) use circles::View;
use core::f64::consts::{FRAC_PI_2, PI};
pub use profile::Circle;
use profile::CircleRow;
pub(crate) use profile::{Landings, MOST_CIRCLES};
pub(crate) use rim::{Border, CircleDown, Rim, Shape};
pub(crate) use tube::{Wall, rounded_tube, tube, tube_or_nan};

const ELL: (f64, f64) = (0.0, 1e150);
/// Least and largest I1. A smaller moment would need a mass within 3 % of R of the centre; it usually is a moment in kg m^2.
const I1: (f64, f64) = (1e-3, 1e300);
const I3: (f64, f64) = (1e-150, 1e150);
const FILLET: (f64, f64) = (0.0, 1.0);

/// A rigid body of revolution that touches the table with its lower rim.
///
/// In natural units the mass M, the outer radius R and gravity g are 1.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "file::BodyFile", into = "file::BodyFile")
)]
pub struct Body {
    ell: f64,
    i1: f64,
    i3: f64,
    fillet: f64,
    /// Radius a = 1 - fillet of the circle of the rim.
    rim: Sum<f64>,
    excess: Sum<f64>,
    theta_end: f64,
    /// The least inclination at which the body stands on its present circle, where the circle before it lands; 0 without one.
    low: f64,
    /// The circles of the body, if they are neither one circle nor two equal rims.
    row: Option<CircleRow>,
}

impl Body {
    /// Uniform solid cylinder of aspect ratio `ell` (length over diameter) in [0, 1e150]; `ell = 0` is the thin disk.
    ///
    /// # Errors
    /// `OutOfRange` for an `ell` outside [0, 1e150].
    pub fn solid(ell: f64) -> Result<Self, Error> {
        Self::tube(ell, 0.0)
    }

    /// Uniform tube of aspect ratio `ell` (length over diameter) in [0, 1e150]. Its `bore` in [0, 1] is the ratio of
    /// inner to outer radius: 0 is a solid cylinder, 1 a thin wall (a hoop for `ell = 0`).
    ///
    /// # Errors
    /// `OutOfRange` for an `ell` outside [0, 1e150] or a `bore` outside [0, 1].
    pub fn tube(ell: f64, bore: f64) -> Result<Self, Error> {
        within("ell", ell, ELL, "0 <= ell <= 1e150")?;
        within("bore", bore, (0.0, 1.0), "0 <= bore <= 1")?;
        let ([i1, i3], excess) = tube(ell, bore);
        Ok(Self { i1, i3, excess, ..Self::bare(ell, 0.0) })
    }

    /// Uniform tube of half length `half_length` over the outer radius, whose outer edges are rounded with the radius
    /// `fillet` in [0, 1]. The fillet is at most half the length, and at most the wall that the bore leaves. The tube
    /// is a coin or a can for `bore = 0`, and a capsule or a ball for `fillet = 1`.
    ///
    /// # Errors
    /// `OutOfRange` for a half length outside [0, 1e150] (its name is "ell"), a bore outside [0, 1], and a fillet
    /// outside [0, 1] or larger than the half length or the wall 1 - bore.
    pub fn rounded_tube(half_length: f64, bore: f64, fillet: f64) -> Result<Self, Error> {
        within("ell", half_length, ELL, "0 <= ell <= 1e150")?;
        let expected = "0 <= fillet <= 1, at most half the length";
        within("fillet", fillet, (0.0, half_length.min(1.0)), expected)?;
        let body = Self::tube_on(half_length - fillet, bore, fillet)?;
        // A capsule lands on its other end at pi/2; a ball has no other end.
        if body.is_ball() && body.ell > 0.0 { body.with_theta_end(FRAC_PI_2) } else { Ok(body) }
    }

    /// Uniform tube whose centre of mass is at the height `ell` above the circle of the rim: half the length minus the fillet.
    pub(crate) fn tube_on(ell: f64, bore: f64, fillet: f64) -> Result<Self, Error> {
        if fillet == 0.0 {
            return Self::tube(ell, bore);
        }
        within("ell", ell, ELL, "0 <= ell <= 1e150")?;
        within("bore", bore, (0.0, 1.0), "0 <= bore <= 1")?;
        // The sum decides, because 1 - bore is rounded: with a bore of 0.8 it is below a fillet of 0.2.
        let most = if fillet + bore <= 1.0 { 1.0 } else { 1.0 - bore };
        within("fillet", fillet, (0.0, most), "0 <= fillet <= 1, at most the wall 1 - bore")?;
        let ([i1, i3], excess) = rounded_tube(ell, bore, fillet);
        Self { i1, i3, excess, ..Self::bare(ell, fillet) }.of_this_world()
    }

    /// Any axisymmetric body on a sharp rim, such as a bottle or a can, given by the height `ell` of its centre of mass
    /// above the plane of the rim (in R) and by its moments about the centre of mass (in M R^2).
    ///
    /// A real body has `0 < i3 <= 2 i1`; equality holds for a flat body. An `i1` below 1e-3 is an error: such a body
    /// would have its mass within 3 % of R of its centre, and the moments of most hand-held bodies in kg m^2 are as
    /// small. Use [`Measured::with_moments`](crate::Measured::with_moments) for moments in SI.
    ///
    /// # Errors
    /// Those of [`rounded`](Self::rounded), for a fillet of 0.
    pub fn new(ell: f64, i1: f64, i3: f64) -> Result<Self, Error> {
        Self::rounded(ell, i1, i3, 0.0)
    }

    /// Any axisymmetric body on a rounded rim: `ell` is the height of the centre of mass above the circle of the rim,
    /// whose radius is `1 - fillet`. With `fillet = 1` the body is a ball, and `ell`, above -1, is the height of the
    /// centre of mass above the centre of the ball.
    ///
    /// A body with `ell > 0` is assumed to be equally long on both sides of its centre and to land on its other rim at
    /// pi/2, except for a ball, which has no other rim; [`with_theta_end`](Self::with_theta_end) sets another
    /// inclination.
    ///
    /// # Errors
    /// `OutOfRange` for a fillet outside [0, 1], an `ell` outside [0, 1e150] (of a ball, outside (-1, 1e150]), an `i1`
    /// outside [1e-3, 1e300], an `i3` outside [1e-150, 1e150], an `i1/i3` above 1e300, and an `i1 i3 + i1 + i3 ell^2`
    /// above 1e301; `Moments` for `i3 > 2 i1`.
    pub fn rounded(ell: f64, i1: f64, i3: f64, fillet: f64) -> Result<Self, Error> {
        within("fillet", fillet, FILLET, "0 <= fillet <= 1")?;
        let (low, expected) = if fillet == 1.0 {
            ((-1f64).next_up(), "-1 < ell <= 1e150 (fillet = 1: a ball)")
        } else {
            (ELL.0, "0 <= ell <= 1e150")
        };
        within("ell", ell, (low, ELL.1), expected)?;
        Self::bare(ell, fillet).with_moments(i1, i3)?.of_this_world()
    }

    /// The body with the numbers ell, i1, i3, bore, fillet and theta_end. A bore of NaN means a general body, a
    /// theta_end of NaN the inclination that follows from the shape. A bore with the sign minus, which may be -0, is that of
    /// one circle of a body that has several: its radius is minus the bore, and theta_end is where the next one lands.
    pub(crate) fn of_numbers([ell, i1, i3, bore, fillet, theta_end]: [f64; 6]) -> Result<Self, Error> {
        let body = if bore.is_nan() {
            Self::rounded(ell, i1, i3, fillet)
        } else if bore.is_sign_negative() {
            let row = CircleRow::of(&[Circle { radius: -bore, depth: ell, fillet }])?;
            return Ok(Self { theta_end, row: None, ..Self::bare(0.0, 0.0).with_moments(i1, i3)?.on(row) });
        } else {
            Self::tube_on(ell, bore, fillet)
        }?;
        if theta_end.is_nan() { Ok(body) } else { body.with_theta_end(theta_end) }
    }

    /// The body with these rows of radius, height above the centre of mass, and fillet, from the lower end up; rows
    /// with a radius of NaN do not count. Of `numbers`, as in `of_numbers`, only i1 and i3 are then used. Without a row
    /// it is the body of `numbers`.
    pub(crate) fn of_rows(numbers: [f64; 6], rows: &[[f64; 3]]) -> Result<Self, Error> {
        let circles = circles_of_rows(rows);
        if circles.is_empty() {
            return Self::of_numbers(numbers);
        }
        Self::profile(&circles, numbers[1], numbers[2])
    }

    /// Two equal solid balls (Hurricane balls), which touch (`separation = 1`) or have their centres `separation`
    /// diameters apart on a light rod. The second ball lands at pi/2.
    ///
    /// # Errors
    /// `OutOfRange` for a separation outside [1, 1e75].
    pub fn balls(separation: f64) -> Result<Self, Error> {
        within("separation", separation, (1.0, 1e75), "1 <= separation <= 1e75")?;
        let body = Self::rounded(separation, 0.4 + separation * separation, 0.4, 1.0)?;
        body.with_theta_end(FRAC_PI_2)
    }

    /// A ball whose centre of mass lies `offset` above its centre, with `offset` > -1; the offset of a tippe top at
    /// rest is negative. The moments are about the centre of mass. The motion of the ball can pass through both poles.
    ///
    /// # Errors
    /// `OutOfRange` for an offset outside (-1, 1e150]; and those of [`rounded`](Self::rounded) for the moments.
    pub fn ball(offset: f64, i1: f64, i3: f64) -> Result<Self, Error> {
        within("offset", offset, ((-1f64).next_up(), ELL.1), "-1 < offset <= 1e150")?;
        Self::rounded(offset, i1, i3, 1.0)
    }

    /// Returns this body with a motion that ends at the inclination `theta_end` in (0, pi], in radians, at which a
    /// stem, a cap or the shoulder of a bottle lands.
    ///
    /// # Errors
    /// `OutOfRange` for an inclination outside [1e-6, pi].
    pub fn with_theta_end(self, theta_end: f64) -> Result<Self, Error> {
        within("theta_end", theta_end, (1e-6, PI), "1e-6 <= theta_end <= pi (radians)")?;
        Ok(Self { theta_end, low: 0.0, row: None, ..self })
    }

    /// Any body of revolution that touches the table with these circles, from the lower end up, with its moments of inertia
    /// about the centre of mass (the depth of a circle is its distance below this centre, negative above): a cup, a cone
    /// (whose tip is a circle of radius 0), a bottle, unequal balls. A circle that never touches the table, since it lies
    /// inside the convex hull of the others, is left out.
    ///
    /// All lengths are in one unit R, and the moments in M R^2. The body is seen from its lower end, and stands on its first
    /// circle. Two circles that mirror each other are the two equal rims of a tube.
    ///
    /// ```
    /// use spincyl::{Body, body::Circle};
    ///
    /// let circle = |radius, depth| Circle { radius, depth, fillet: 0.0 };
    /// let cup = Body::profile(&[circle(0.7, 1.1), circle(1.0, -0.9)], 0.5, 0.4)?;
    /// assert!((cup.theta_end() - (2.0f64).atan2(0.3)).abs() < 1e-15);
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    ///
    /// # Errors
    /// `OutOfRange`, with the name "circles", without a circle, for more than 8 that touch the table, for circles that
    /// are not in order from the lower end up, for one that lies inside another, for radii or fillets outside [0,
    /// 1e100], and for depths outside [-1e100, 1e100]; and those of [`rounded`](Self::rounded) for the moments.
    pub fn profile(circles: &[Circle], i1: f64, i3: f64) -> Result<Self, Error> {
        let row = CircleRow::of(circles)?;
        Self::bare(0.0, 0.0).with_moments(i1, i3)?.on(row).of_this_world()
    }

    fn with_moments(self, i1: f64, i3: f64) -> Result<Self, Error> {
        within("i1", i1, I1, "1e-3 <= i1 <= 1e300 (in units of M R^2, not in kg m^2)")?;
        within("i3", i3, I3, "1e-150 <= i3 <= 1e150")?;
        Ok(Self { i1, i3, excess: Sum::of(i1, -i3) / i3.into(), ..self })
    }

    /// Uniform tube with these dimensions in metres (or in any other common unit); `fillet` is the radius of its outer
    /// edges.
    ///
    /// # Errors
    /// `OutOfRange` for an outer diameter that is not positive, an inner diameter that is negative or larger than the
    /// outer one, a negative length, and a fillet that is negative or larger than half the outer diameter; and those of
    /// [`rounded_tube`](Self::rounded_tube).
    pub fn from_metres(
        outer_diameter: f64,
        inner_diameter: f64,
        length: f64,
        fillet: f64,
    ) -> Result<Self, Error> {
        const LENGTH: (f64, f64) = (0.0, f64::MAX);
        within("outer_diameter", outer_diameter, (f64::MIN_POSITIVE, f64::MAX), "outer_diameter > 0")?;
        within(
            "inner_diameter",
            inner_diameter,
            (0.0, outer_diameter),
            "0 <= inner_diameter <= outer_diameter",
        )?;
        within("length", length, LENGTH, "length >= 0")?;
        within("fillet", fillet, (0.0, 0.5 * outer_diameter), "0 <= fillet <= outer_diameter/2")?;
        Self::rounded_tube(
            length / outer_diameter,
            inner_diameter / outer_diameter,
            2.0 * fillet / outer_diameter,
        )
    }

    /// A body whose moments are not yet set: all are NaN.
    fn bare(ell: f64, fillet: f64) -> Self {
        Self {
            ell,
            i1: f64::NAN,
            i3: f64::NAN,
            fillet,
            rim: Sum::of(1.0, -fillet),
            excess: f64::NAN.into(),
            theta_end: beyond(ell, fillet),
            low: 0.0,
            row: None,
        }
    }

    /// Returns the body, or an error if no real body has its moments of inertia.
    fn of_this_world(self) -> Result<Self, Error> {
        let Self { i1, i3, .. } = self;
        if i3 > 2.0 * i1 {
            return Err(Error::Moments { i3, i1 });
        }
        within("i1 / i3", i1 / i3, (0.5, 1e300), "1/2 <= i1 / i3 <= 1e300")?;
        let d = i1 * i3 + i1 + i3 * self.ell * self.ell;
        within("i1 i3 + i1 + i3 ell^2", d, (0.0, 1e301), "at most 1e301")?;
        Ok(self)
    }

    /// The half length over the outer radius at which a tube of this `bore` and `fillet` has I1 = I3 and
    /// theta0 = thetaInf; for a sharp rim it is (sqrt(3)/2) sqrt(1 + bore^2). The relative error is below 4 ulp.
    ///
    /// # Errors
    /// `OutOfRange` for a bore or a fillet outside [0, 1], and for a fillet larger than the wall 1 - bore.
    pub fn critical_aspect(bore: f64, fillet: f64) -> Result<f64, Error> {
        within("bore", bore, (0.0, 1.0), "0 <= bore <= 1")?;
        within("fillet", fillet, FILLET, "0 <= fillet <= 1")?;
        if fillet == 0.0 {
            return Ok((0.75 * (1.0 + bore * bore)).sqrt());
        }
        let excess = |half: f64| Self::rounded_tube(half, bore, fillet).map_or(f64::NAN, |b| b.excess.hi);
        let (low, high) = (fillet, 4.0);
        let (at_low, at_high) = (
            Self::rounded_tube(low, bore, fillet)?.excess.hi,
            Self::rounded_tube(high, bore, fillet)?.excess.hi,
        );
        Ok(if at_low >= 0.0 { low } else { search::crossing(excess, low, high, at_low, at_high) })
    }

    /// Height of the centre of mass above the circle of the lower rim, in R; for a sharp tube this is the aspect ratio.
    pub fn ell(&self) -> f64 {
        self.ell
    }

    /// Transverse moment of inertia I1 = I2, in M R^2.
    pub fn i1(&self) -> f64 {
        self.i1
    }

    /// Axial moment of inertia I3, in M R^2.
    pub fn i3(&self) -> f64 {
        self.i3
    }

    /// Radius rho of the fillet of the rim, in R: 0 for a sharp rim, 1 for a ball.
    pub fn fillet(&self) -> f64 {
        self.fillet
    }

    /// Radius a = 1 - fillet of the circle of the rim, in R.
    pub fn rim(&self) -> f64 {
        self.rim.hi
    }

    /// The inclination, in radians, at which a part of the body other than its rim lands; pi if no other part lands.
    pub fn theta_end(&self) -> f64 {
        self.theta_end
    }

    /// Inertia excess I1/I3 - 1: positive for a cylinder, negative for a disk.
    pub fn excess(&self) -> f64 {
        self.excess.hi
    }

    /// The inclination theta0, in radians, at which the body balances on a point of its rim; NaN for a ball. The error
    /// is below 2 ulp.
    pub fn theta_balance(&self) -> f64 {
        if self.is_ball() { f64::NAN } else { self.rim.hi.atan2(self.ell) }
    }

    /// The inclination thetaInf, in radians, at which the steady rate grows without bound; NaN for a ball without such
    /// an inclination. The error is below 4 ulp.
    pub fn theta_limit(&self) -> f64 {
        let (a, ell, rho, d) = (self.rim.hi, self.ell, self.fillet, self.excess.hi);
        if self.is_sharp() {
            return self.ratio().atan2(ell);
        }
        if self.is_ball() {
            // For a ball cos thetaInf = ell/(d rho).
            let square = (d * rho - ell) * (d * rho + ell);
            return if square >= 0.0 && d != 0.0 { square.sqrt().atan2(ell * d.signum()) } else { f64::NAN };
        }
        if ell == 0.0 {
            // The equation has the factor cos theta; its other factor vanishes where the sine of theta is `sine`.
            let sine = a / rho * (-1.0 / d - 1.0);
            return if d < 0.0 && sine < 1.0 { sine.asin() } else { FRAC_PI_2 };
        }
        // The function (1 + d) a cos - ell sin + d rho sin cos falls from a positive value at 0 to -ell at pi/2.
        let pull = (Sum::from(1.0) + self.excess) * self.rim;
        let bend = self.excess * rho.into();
        let left = |theta: f64| {
            let SinCos { sin, cos } = sincos(theta);
            (cos * (pull + bend * sin) - sin * ell.into()).hi
        };
        search::crossing(left, 0.0, FRAC_PI_2, pull.hi, -ell)
    }

    /// Sine and cosine of theta_end, the inclination at which another circle lands.
    pub(crate) fn border_angle(&self) -> (f64, f64) {
        landing_angle(self.theta_end)
    }

    /// The circle on which the body stands and the circle that lands at theta_end, both at the inclination theta_end.
    pub(crate) fn border(&self) -> Border<f64> {
        Border::between([self.shape().rim, self.next_rim()], landing_angle(self.theta_end))
    }

    /// Whether the body can land only on its rim, or on the other of two equal rims.
    pub(crate) fn lands_on_rims(&self) -> bool {
        // Two equal balls are a body with the fillet 1 that ends at a right angle.
        self.row.is_some()
            || self.theta_end == beyond(self.ell, self.fillet)
            || self.ell > 0.0 && self.theta_end == FRAC_PI_2
    }

    pub(crate) fn excess_sum(&self) -> Sum<f64> {
        self.excess
    }

    pub(crate) fn rim_sum(&self) -> Sum<f64> {
        self.rim
    }

    /// The ratio I1/I3 of the moments.
    pub(crate) fn ratio(&self) -> f64 {
        1.0 + self.excess.hi
    }

    /// Whether the formulas of a sharp rim of radius 1 hold.
    pub(crate) fn is_sharp(&self) -> bool {
        self.fillet == 0.0 && self.rim.hi == 1.0
    }

    /// Whether the formulas of a sharp rim give all steady states: the rim is sharp and the range ends at pi/2.
    pub(crate) fn is_plain(&self) -> bool {
        self.is_sharp() && self.range() == FRAC_PI_2
    }

    /// Whether the body is a ball, for which the poles are ordinary points of the motion.
    pub(crate) fn is_ball(&self) -> bool {
        self.rim.hi == 0.0
    }

    /// Whether the body is a ball with equal moments and its centre of mass in its centre, on any part of which it rolls.
    pub(crate) fn is_uniform_ball(&self) -> bool {
        self.is_ball() && self.ell() == 0.0 && self.i1() == self.i3() && self.theta_end() >= PI
    }

    /// The largest inclination for which steady states are computed; for a sharp rim at most pi/2, as in the paper.
    pub(crate) fn range(&self) -> f64 {
        if self.is_sharp() { self.theta_end.min(FRAC_PI_2) } else { self.theta_end }
    }

    /// The largest inclination at which the body can be steady with its centre at rest: 0 for a tip, which cannot roll.
    pub(crate) fn rests_up_to(&self) -> f64 {
        if self.rim.hi == 0.0 && self.fillet == 0.0 { 0.0 } else { self.range() }
    }

    /// The numbers of the body that enter the equations of motion: its rim and its moments of inertia.
    #[inline(always)]
    pub(crate) fn shape(&self) -> Shape<f64> {
        let rim = Rim { ell: self.ell, a: self.rim.hi, rho: self.fillet };
        Shape { rim, i1: self.i1, i3: self.i3 }
    }
}

/// The circles with these rows of radius, height above the centre of mass, and fillet, without those whose radius is NaN.
pub(crate) fn circles_of_rows(rows: &[[f64; 3]]) -> Vec<Circle> {
    let circle = |row: &[f64; 3]| Circle { radius: row[0], depth: 0.0 - row[1], fillet: row[2] };
    rows.iter().filter(|row| !row[0].is_nan()).map(circle).collect()
}

/// The inclination at which a body is assumed to land on its other rim: pi/2 for ell > 0 unless it is a ball, else pi.
#[inline(always)]
pub(crate) fn beyond<T: Real>(ell: T, fillet: T) -> T {
    let (zero, one, level, round) = (ell.splat(0.0), ell.splat(1.0), ell.splat(FRAC_PI_2), ell.splat(PI));
    zero.select_lt(ell, fillet.select_lt(one, level, round), round)
}

/// Whether an inclination is outside `range`, within which the body stands on its present circle, or at an end of the
/// range without moving back into it. It moves with w2, or with w2' if w2 vanishes.
///
/// Where a circle rises because its normal force has vanished, w2' vanishes too, but for a rounding error. At an end of
/// the range that is no right angle, theta does not show the difference.
pub(crate) fn leaves([low, high]: [f64; 2], theta: f64, [w2, rate]: [f64; 2]) -> bool {
    const STANDS: f64 = 1e-14;
    let beyond = |by: f64, border: f64, way: f64| {
        let stays = if border == FRAC_PI_2 { way * rate > 0.0 } else { way * rate > -STANDS };
        by < 0.0 || by == 0.0 && !(way * w2 > 0.0 || w2 == 0.0 && stays)
    };
    high < PI && beyond(high - theta, high, 1.0) || low > 0.0 && beyond(theta - low, low, -1.0)
}

/// The end of the `range` that is nearest to an inclination.
pub(crate) fn border_at([low, high]: [f64; 2], theta: f64) -> f64 {
    if low > 0.0 && theta - low < high - theta { low } else { high }
}

/// The sine of the angle from `angle` to (s, c), both given by sine and cosine.
pub(crate) fn tilt((s, c): (f64, f64), angle: (f64, f64)) -> f64 {
    s * angle.1 - c * angle.0
}

/// Largest rate of the inclination, in sqrt(g/R), at which a body counts as just leaving an end of the range of its circle.
const LEAVES: f64 = 1e-9;

/// How far beyond `border`, an inclination at which a circle lands, an inclination may be by rounding its sine and
/// cosine, if it leaves at the rate `away` and no circle has landed since. At a right angle the cosine has all its
/// digits.
pub(crate) fn rounding_at<T: Real>(border: f64, away: T) -> T {
    let leaves = border != FRAC_PI_2 && away.splat(-LEAVES).is_lt(away);
    away.splat(if leaves { 4.0 * f64::EPSILON } else { 0.0 })
}

/// Sine and cosine of an inclination at which a circle lands; those of a right angle are exact.
pub(crate) fn landing_angle(theta: f64) -> (f64, f64) {
    if theta == FRAC_PI_2 { (1.0, 0.0) } else { theta.sin_cos() }
}

impl core::fmt::Display for Body {
    /// Writes the numbers of the body in natural units; for a body of several circles, those of the circle on which it
    /// stands. The fillet of a sharp rim is left out, and so is a theta_end of pi/2 or pi.
    ///
    /// ```
    /// use spincyl::Body;
    ///
    /// assert_eq!(Body::solid(0.0)?.to_string(), "ell = 0, I1 = 0.25, I3 = 0.5");
    /// assert_eq!(Body::ball(-0.2, 0.4, 0.42)?.to_string(), "ell = -0.2, I1 = 0.4, I3 = 0.42, fillet = 1");
    /// let bottle = Body::new(2.0, 1.5, 0.5)?.with_theta_end(1.2)?;
    /// assert_eq!(bottle.to_string(), "ell = 2, I1 = 1.5, I3 = 0.5, theta_end = 1.2");
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { ell, i1, i3, fillet, theta_end, .. } = self;
        write!(f, "ell = {ell}, I1 = {i1}, I3 = {i3}")?;
        if *fillet > 0.0 {
            write!(f, ", fillet = {fillet}")?;
        }
        if *theta_end < PI && *theta_end != FRAC_PI_2 {
            write!(f, ", theta_end = {theta_end}")
        } else {
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tube_and_the_general_body_of_its_moments_are_one() {
        for (ell, bore) in [(0.0, 0.0), (0.3, 0.5), (2.5, 0.0), (6.0, 0.8), (0.0, 1.0), (1e6, 0.1)] {
            let tube = Body::tube(ell, bore).unwrap();
            let same = Body::new(ell, tube.i1(), tube.i3()).unwrap();
            assert!((tube.excess() - same.excess()).abs() <= 4.0 * f64::EPSILON * tube.ratio());
            assert!((tube.theta_limit() - same.theta_limit()).abs() < 1e-15);
        }
    }

    #[test]
    fn moments_are_those_of_the_textbook() {
        let disk = Body::solid(0.0).unwrap();
        assert_eq!((disk.i1(), disk.i3(), disk.excess()), (0.25, 0.5, -0.5));
        let hoop = Body::tube(0.0, 1.0).unwrap();
        assert_eq!((hoop.i1(), hoop.i3(), hoop.excess()), (0.5, 1.0, -0.5));
        let can = Body::tube(3.0, 0.5).unwrap();
        assert_eq!((can.i3(), can.i1()), (0.625, 0.3125 + 3.0));
        let pvc = Body::from_metres(15.875e-3, 12.7e-3, 95.25e-3, 0.0).unwrap();
        assert_eq!((pvc.ell(), pvc.i3()), (6.0, 0.82));
    }

    #[test]
    fn balance_and_limit_meet_at_the_critical_aspect_only() {
        for bore in [0.0, 0.3, 0.8, 1.0] {
            let critical = Body::critical_aspect(bore, 0.0).unwrap();
            let gap = |ell: f64| {
                let body = Body::tube(ell, bore).unwrap();
                body.theta_limit() - body.theta_balance()
            };
            assert!(gap(critical).abs() < 1e-15);
            assert!(gap(critical * 1.001) > 1e-4 && gap(critical * 0.999) < -1e-4);
        }
    }

    #[test]
    fn what_cannot_be_a_body_is_refused_by_name() {
        let text = |r: Result<Body, Error>| r.unwrap_err().to_string();
        assert_eq!(text(Body::solid(-1.0)), "ell = -1.0: expected 0 <= ell <= 1e150");
        assert_eq!(text(Body::solid(f64::NAN)), "ell = NaN: expected 0 <= ell <= 1e150");
        assert_eq!(text(Body::solid(1e160)), "ell = 1e160: expected 0 <= ell <= 1e150");
        assert_eq!(text(Body::tube(1.0, 1.1)), "bore = 1.1: expected 0 <= bore <= 1");
        assert_eq!(
            text(Body::new(1.0, 0.2, 0.5)),
            "i3 = 0.5, i1 = 0.2: expected i3 <= 2 i1, as for every real body"
        );
        assert!(Body::new(1.0, 0.25, 0.5).is_ok(), "a flat body is the limit, and allowed");
        assert!(Body::new(1.0, 0.0, 0.0).is_err() && Body::new(1.0, 0.5, 0.0).is_err());
        assert!(Body::new(1.0, 1e300, 1e-150).is_err(), "the ratio of the moments is bounded too");
        assert!(text(Body::new(1e150, 1e10, 1e10)).starts_with("i1 i3 + i1 + i3 ell^2 = "));
        assert!(Body::new(1e100, 1e150, 1e100).is_ok() && Body::new(1e60, 1e152, 1e149).is_ok());
        assert!(
            Body::from_metres(1.0, 1.1, 1.0, 0.0).is_err() && Body::from_metres(0.0, 0.0, 1.0, 0.0).is_err()
        );
        assert!(Body::from_metres(1.0, 1.0, -1.0, 0.0).is_err() && Body::critical_aspect(2.0, 0.0).is_err());
    }
}
