//! Stones: ellipsoids with any inertia, such as a rattleback or an egg, which roll and slip without an axis of symmetry.
//!
//! ```text
//! D = diag(a1^2, a2^2, a3^2),   I = (i11, i22, i33, i23, i13, i12),   d = centre of mass - centre of the ellipsoid
//! uniform    I = diag(a2^2 + a3^2, a3^2 + a1^2, a1^2 + a2^2)/5
//! half       the lower half of an ellipsoid: d = (0, 0, -3 a3/8), moments about d, and an edge that lands at pi/2
//! theta      the inclination of axis 3, cos theta = n3
//! ```
//! Natural units: the mass, the largest semi-axis and gravity are 1. An ellipsoid is not a
//! [`Body`](crate::Body), which is a body of revolution with three first integrals; a stone has one, its
//! energy, so that its motion is always integrated.
//!
//! Sources: Walker, Sci. Am. 241(4), 172 (1979); Kane and Levinson, Int. J. Non-Linear Mech. 17, 175 (1982); Moffatt and
//! Shimomura, Nature 416, 385 (2002), for the rising egg.

#[cfg(feature = "serde")]
mod file;
pub(crate) mod law;
mod state;

use super::contact::Contact;
use super::state::Slip;
use crate::error::{Error, within};
use crate::numbers::vector::{Symmetric, cross, dot};
use core::f64::consts::{FRAC_PI_2, PI};
use law::StoneLaw;
pub(crate) use state::headed;
pub use state::{StonePose, StoneState};

/// A stone: an ellipsoid with any inertia. If the stone has an edge, the edge lands at the inclination `theta_end` of
/// axis 3.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "file::EllipsoidFile", into = "file::EllipsoidFile")
)]
pub struct Ellipsoid {
    pub(crate) axes: [f64; 3],
    pub(crate) inertia: Symmetric<f64>,
    pub(crate) offset: [f64; 3],
    pub(crate) theta_end: f64,
    unit: f64,
}

/// Least and largest length of a semi-axis that is accepted.
const AXES: (f64, f64) = (1e-30, 1e30);
/// Allowed excess of a principal moment over the sum of the two others, from rounding.
const MOMENT_ROUNDING: f64 = 1e-12;

impl Ellipsoid {
    /// Makes an ellipsoid from its semi-axes, its tensor of inertia about the centre of mass, per mass, and the offset of
    /// the centre of mass from the centre of the ellipsoid, all in one unit of length. The largest semi-axis becomes the
    /// unit of the body.
    ///
    /// # Errors
    /// `OutOfRange` for semi-axes outside `[1e-30, 1e30]` or in a ratio above 1e6, for a tensor that is not symmetric,
    /// and for a centre of mass outside the ellipsoid; `Inertia` for impossible principal moments (each has to be
    /// positive and at most the sum of the two others).
    pub fn new(axes: [f64; 3], inertia: [[f64; 3]; 3], offset: [f64; 3]) -> Result<Self, Error> {
        let stone = Self::shaped(axes, inertia, offset)?;
        stone.checked(stone.moments())
    }

    /// The ellipsoid of [`new`](Self::new), made without a check of its principal moments.
    fn shaped(axes: [f64; 3], inertia: [[f64; 3]; 3], offset: [f64; 3]) -> Result<Self, Error> {
        for axis in axes {
            within("axes", axis, AXES, "three semi-axes, 1e-30 <= a <= 1e30")?;
        }
        let unit = axes.into_iter().fold(0.0, f64::max);
        let axes = axes.map(|a| a / unit);
        for axis in axes {
            within("axes", axis, (1e-6, 1.0), "semi-axes of at least a millionth of the largest one")?;
        }
        let offset = offset.map(|x| x / unit);
        for (x, a) in offset.into_iter().zip(axes) {
            within("offset", x / a, (-1.0, 1.0), "a centre of mass inside the ellipsoid")?;
        }
        let far: f64 = offset.into_iter().zip(axes).map(|(x, a)| (x / a) * (x / a)).sum();
        within("offset", far.sqrt(), (0.0, 1f64.next_down()), "a centre of mass inside the ellipsoid")?;
        let square = unit * unit;
        let i = inertia.map(|row| row.map(|x| x / square));
        let largest = i[0][0].max(i[1][1]).max(i[2][2]);
        for (a, b) in [(i[1][2], i[2][1]), (i[0][2], i[2][0]), (i[0][1], i[1][0])] {
            let most = MOMENT_ROUNDING * largest.abs();
            within(
                "inertia",
                (a - b).abs(),
                (0.0, most),
                "a symmetric tensor; two of its elements differ by this value",
            )?;
        }
        let inertia = Symmetric([i[0][0], i[1][1], i[2][2], i[1][2], i[0][2], i[0][1]]);
        Ok(Self { axes, inertia, offset, theta_end: PI, unit })
    }

    /// Returns an error for impossible principal moments.
    fn checked(self, moments: [f64; 3]) -> Result<Self, Error> {
        let [a, b, c] = moments;
        let (least, most, square) = (a.min(b).min(c), a.max(b).max(c), self.unit * self.unit);
        let real = least >= 1e-15 && most <= 1e15 && 2.0 * most <= (a + b + c) * (1.0 + MOMENT_ROUNDING);
        if real { Ok(self) } else { Err(Error::Inertia { moments: moments.map(|x| x * square) }) }
    }

    /// A uniform ellipsoid with these semi-axes.
    ///
    /// # Errors
    /// Those of [`new`](Self::new) for the semi-axes.
    pub fn uniform(axes: [f64; 3]) -> Result<Self, Error> {
        Self::turned(axes, uniform(axes), 0.0, [0.0; 3])
    }

    /// A rattleback with these semi-axes and these principal moments per mass about the centre of mass. The principal axes
    /// are turned by `twist` (radians) about axis 3 from the axes of the ellipsoid, counterclockwise as seen from above.
    /// Without moments the stone is the lower half of a uniform ellipsoid, with its edge at the height of its centre.
    ///
    /// # Errors
    /// `OutOfRange` for a twist beyond 1e6 rad; and those of [`new`](Self::new).
    pub fn rattleback(
        axes: [f64; 3],
        moments: Option<[f64; 3]>,
        twist: f64,
        offset: Option<[f64; 3]>,
    ) -> Result<Self, Error> {
        let low = 0.375 * axes[2];
        let half = {
            let [a, b, c] = uniform(axes);
            [a - low * low, b - low * low, c]
        };
        let offset = offset.unwrap_or([0.0, 0.0, if moments.is_none() { -low } else { 0.0 }]);
        let stone = Self::turned(axes, moments.unwrap_or(half), twist, offset)?;
        if moments.is_none() { stone.with_theta_end(FRAC_PI_2) } else { Ok(stone) }
    }

    /// An egg: a uniform spheroid with the semi-axes `radius`, `radius` and `half_length`, whose centre of mass lies
    /// `offset` above its centre along axis 3; the moments about the centre of mass are those of the uniform spheroid.
    ///
    /// # Errors
    /// `OutOfRange` for a radius or a half length outside [1e-30, 1e30]; and those of [`new`](Self::new).
    pub fn egg(radius: f64, half_length: f64, offset: f64) -> Result<Self, Error> {
        let axes = [radius, radius, half_length];
        within("radius", radius, AXES, "1e-30 <= radius <= 1e30")?;
        within("half_length", half_length, AXES, "1e-30 <= half_length <= 1e30")?;
        Self::turned(axes, uniform(axes), 0.0, [0.0, 0.0, offset])
    }

    fn turned(axes: [f64; 3], [a, b, c]: [f64; 3], twist: f64, offset: [f64; 3]) -> Result<Self, Error> {
        within("twist", twist, (-1e6, 1e6), "an angle of -1e6 to 1e6 radians")?;
        let (s, co) = twist.sin_cos();
        let mut across = (a - b) * s * co;
        // A twist by a quarter or half of a turn leaves only rounding errors here.
        if across.abs() <= 4.0 * f64::EPSILON * (a - b).abs() {
            across = 0.0;
        }
        let (along, wide) = (a * co * co + b * s * s, a * s * s + b * co * co);
        let stone = Self::shaped(axes, [[along, across, 0.0], [across, wide, 0.0], [0.0, 0.0, c]], offset)?;
        stone.checked([a, b, c].map(|x| x / (stone.unit * stone.unit)))
    }

    /// Mean of `sum (x_i/a_i)^2` over the mass of the stone, which tells how far out the mass lies; x is counted from the
    /// centre of the ellipsoid. The mean is 3/5 for a uniform ellipsoid, 1 for a thin shell, and at most 1 if all mass is
    /// within the ellipsoid; moments with a larger mean need mass outside.
    pub fn reach(&self) -> f64 {
        let [a, b, c, ..] = self.inertia.0;
        let spread = [b + c - a, a + c - b, a + b - c].map(|x| 0.5 * x);
        let squares = spread.into_iter().zip(self.offset).zip(self.axes);
        squares.map(|((spread, d), a)| (spread + d * d) / (a * a)).sum()
    }

    /// Returns this stone with an edge that lands at the inclination `theta_end` of axis 3, in (0, pi], radians.
    ///
    /// # Errors
    /// `OutOfRange` for an inclination outside [1e-6, pi].
    pub fn with_theta_end(self, theta_end: f64) -> Result<Self, Error> {
        within("theta_end", theta_end, (1e-6, PI), "1e-6 <= theta_end <= pi (radians)")?;
        Ok(Self { theta_end, ..self })
    }

    /// The names of the 13 numbers of [`numbers`](Self::numbers), in their order.
    pub const NAMES: [&str; 13] =
        ["a1", "a2", "a3", "i11", "i22", "i33", "i23", "i13", "i12", "d1", "d2", "d3", "theta_end"];

    /// Makes a stone from its numbers: semi-axes, moments 11, 22, 33, 23, 13 and 12, offset, and theta_end, which is
    /// NaN without an edge.
    ///
    /// # Errors
    /// Those of [`new`](Self::new) and of [`with_theta_end`](Self::with_theta_end).
    pub fn of_numbers([a, b, c, i, j, k, l, m, n, x, y, z, end]: [f64; 13]) -> Result<Self, Error> {
        Self::new([a, b, c], [[i, n, m], [n, j, l], [m, l, k]], [x, y, z])?.with_edge(end)
    }

    /// Returns this stone with an edge that lands at `theta_end`, or without an edge if `theta_end` is NaN.
    pub(crate) fn with_edge(self, theta_end: f64) -> Result<Self, Error> {
        if theta_end.is_nan() { Ok(self) } else { self.with_theta_end(theta_end) }
    }

    /// The numbers of the stone in its natural units, in the order of [`NAMES`](Self::NAMES).
    pub fn numbers(&self) -> [f64; 13] {
        let ([a, b, c], [i, j, k, l, m, n], [x, y, z]) = (self.axes, self.inertia.0, self.offset);
        [a, b, c, i, j, k, l, m, n, x, y, z, if self.theta_end < PI { self.theta_end } else { f64::NAN }]
    }

    /// The semi-axes, in units of the largest one.
    pub fn axes(&self) -> [f64; 3] {
        self.axes
    }

    /// The tensor of inertia about the centre of mass, per mass, in units of the square of the largest semi-axis.
    pub fn inertia(&self) -> [[f64; 3]; 3] {
        let [a, b, c, d, e, f] = self.inertia.0;
        [[a, f, e], [f, b, d], [e, d, c]]
    }

    /// The centre of mass relative to the centre of the ellipsoid, in units of the largest semi-axis.
    pub fn offset(&self) -> [f64; 3] {
        self.offset
    }

    /// The inclination of axis 3 at which the edge of a cut stone lands, in radians; pi for a whole ellipsoid.
    pub fn theta_end(&self) -> f64 {
        self.theta_end
    }

    /// The largest semi-axis in the unit of length in which the stone was given.
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// The principal moments of inertia about the centre of mass, in ascending order, per mass, in units of the square
    /// of the largest semi-axis.
    pub fn moments(&self) -> [f64; 3] {
        let matrix = nalgebra::Matrix3::from(self.inertia());
        let mut moments: [f64; 3] = matrix.symmetric_eigenvalues().into();
        moments.sort_by(f64::total_cmp);
        moments
    }

    /// The state of a nearly upright stone that spins about the vertical: [`StoneState::spinning`], the same for every stone.
    pub fn spinning(&self, spin: f64, pitch: f64, roll: f64) -> StoneState {
        StoneState::spinning(spin, pitch, roll)
    }

    /// The lowest point of the stone relative to the centre of mass, along its axes, if the unit vector `vertical` points upward.
    pub fn lowest_point(&self, vertical: [f64; 3]) -> [f64; 3] {
        self.law(0.0, false).touching(vertical, [0.0; 3]).r
    }

    /// The slip of the contact point if the centre of mass has the horizontal velocity `centre`. Both are along the axes x
    /// and y of the laboratory in which the stone is turned from upright by the smallest angle.
    pub fn slip(&self, y: &StoneState, centre: [f64; 2]) -> Slip {
        let lab = law::laboratory(y.orientation());
        let turned = cross(y.w, self.lowest_point(y.vertical));
        let [x, y] = core::array::from_fn(|i| centre[i] + dot(lab[i], turned));
        Slip::new(x, y)
    }

    /// Kinetic and potential energy in M g a of a stone that rolls without slip, or on a smooth table of a stone whose
    /// centre of mass has no horizontal velocity. Heights are above the table.
    ///
    /// ```
    /// use spincyl::{Contact, Ellipsoid};
    ///
    /// // A rattleback that spins upright rolls about its centre of mass, which is at rest with either contact.
    /// let stone = Ellipsoid::rattleback([1.0, 0.2, 0.17], None, 0.03, None)?;
    /// let state = stone.spinning(-0.4, 0.0, 0.0);
    /// let [rolling, smooth] = [Contact::Rolling, Contact::Smooth].map(|contact| stone.energy(&state, contact));
    /// assert!((rolling - smooth).abs() < 1e-15);
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    pub fn energy(&self, y: &StoneState, contact: Contact) -> f64 {
        self.energy_slipping(y, [0.0; 2], contact == Contact::Smooth)
    }

    /// The energy of a stone whose contact point slips with `slip`, along x and y of the laboratory; on a smooth table
    /// that of a centre without horizontal velocity.
    pub(crate) fn energy_slipping(&self, y: &StoneState, slip: [f64; 2], smooth: bool) -> f64 {
        let law = self.law(0.0, false);
        let at = law.touching(y.vertical, y.w);
        if !smooth {
            let lab = law::laboratory(y.orientation());
            return law.energy(&at, y.w, law::across(&lab, slip));
        }
        let v = cross(y.w, at.r);
        let up = dot(v, at.n);
        law.energy(&at, y.w, core::array::from_fn(|i| v[i] - up * at.n[i]))
    }

    pub(crate) fn law(&self, strength: f64, dry: bool) -> StoneLaw<f64> {
        StoneLaw::new(self.axes.map(|a| a * a), self.inertia, self.offset, strength, dry)
    }
}

/// Principal moments of inertia of a uniform ellipsoid about its centre, per mass.
fn uniform([a, b, c]: [f64; 3]) -> [f64; 3] {
    [0.2 * (b * b + c * c), 0.2 * (a * a + c * c), 0.2 * (a * a + b * b)]
}
