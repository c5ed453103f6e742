//! The state of a rolling body: four numbers, and the quantities that follow from them without equations of motion. A
//! body that slips has two more numbers, its slip.
//!
//! ```text
//! w = (w1, w2, w3) = (phi' sin theta, -theta', phi' cos theta + psi')      angular velocity
//! phi' = w1 / sin theta,   psi' = w3 - w1 cot theta                        precession, spin
//! v = (L w2, A w3 - L w1, -A w2)                                           velocity of the centre
//! L = (I1 w1, I1 w2, I3 w3)                                                angular momentum
//! ```
//! The axes (e1, e2, e3) follow the inclination and the precession, not the spin: e3 is the symmetry axis, e2 is
//! horizontal, z = sin theta e1 + cos theta e3. They are those of Jackson et al., Am. J. Phys. 87, 85 (2019), Sec. II.
//! Every number here is computed with a few roundings: the relative error is below 8 ulp of the largest term.
//!
//! ```
//! use spincyl::State;
//!
//! // While its axis goes round once, the body turns twice the other way: from above two still symbols are seen.
//! let state = State::from_rates(1.3, 0.0, 0.7, -1.4);
//! assert!((state.contact_radius() - 2.0).abs() < 1e-14);
//! ```

use super::body::Body;
use crate::numbers::Real;
use nalgebra::Vector3;

/// The slip of a contact point: the velocity over the table of the point of the body that touches it, in sqrt(g R). In
/// files it is the array of both numbers.
///
/// The horizontal e_h = cos(theta) e1 - sin(theta) e3 is the direction of the lean. The slip of a stone is along x and y
/// of the laboratory, which e_h and e2 are at phi = 0. A motion takes components of at most 1e6.
///
/// ```
/// use spincyl::{Slip, State, motion::Start};
///
/// // A wheel on edge that is thrown straight on slips along e2; without a slip it rolls.
/// let state = State { theta: std::f64::consts::FRAC_PI_2, w1: 0.0, w2: 0.0, w3: 0.0 };
/// let thrown = Start::from(state).with_slip(Slip::new(0.0, 2.0));
/// assert_eq!((thrown.slip.u_2, thrown.slip.speed()), (2.0, 2.0));
/// assert_eq!(Start::from(state).slip, Slip::default());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(from = "[f64; 2]", into = "[f64; 2]")
)]
#[non_exhaustive]
pub struct Slip {
    /// The component along e_h; for a stone along x.
    pub u_h: f64,
    /// The component along e2; for a stone along y.
    pub u_2: f64,
}

impl Slip {
    /// The slip with the components `u_h` along e_h and `u_2` along e2, in sqrt(g R).
    pub const fn new(u_h: f64, u_2: f64) -> Self {
        Self { u_h, u_2 }
    }

    /// The speed |u| of the slip.
    pub fn speed(self) -> f64 {
        self.u_h.hypot(self.u_2)
    }

    /// Both components, [u_h, u_2], as the equations of motion use them.
    #[inline(always)]
    pub(crate) const fn pair(self) -> [f64; 2] {
        [self.u_h, self.u_2]
    }

    /// Applies `to` to each of the two components.
    pub(crate) fn map(self, to: impl Fn(f64) -> f64) -> Self {
        Self { u_h: to(self.u_h), u_2: to(self.u_2) }
    }
}

impl From<[f64; 2]> for Slip {
    /// The slip with these components along e_h and e2.
    #[inline(always)]
    fn from([u_h, u_2]: [f64; 2]) -> Self {
        Self { u_h, u_2 }
    }
}

impl From<Slip> for [f64; 2] {
    /// The components of the slip along e_h and e2.
    #[inline(always)]
    fn from(u: Slip) -> Self {
        u.pair()
    }
}

/// The drilling w_z, the angular velocity about the vertical, from sine and cosine of theta, w1 and w3.
#[inline(always)]
pub(crate) fn drilling_of<T: Real>((s, c): (T, T), w1: T, w3: T) -> T {
    s * w1 + c * w3
}

/// The rolling w_h, the angular velocity along e_h, the horizontal direction of the lean.
#[inline(always)]
pub(crate) fn rolling_of<T: Real>((s, c): (T, T), w1: T, w3: T) -> T {
    c * w1 - s * w3
}

/// The spin psi', the rate at which the body turns about its axis relative to e1, e2, e3.
#[inline(always)]
pub(crate) fn spin_of<T: Real>((s, c): (T, T), w1: T, w3: T) -> T {
    w3 - c / s * w1
}

/// Inclination (radians) and angular velocity (in sqrt(g/R)) along axes that follow the inclination and the precession.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct State {
    /// Inclination, the angle from the vertical to the symmetry axis; 0 for a body that stands on its face.
    pub theta: f64,
    /// Angular velocity along e1, `phi' sin(theta)`.
    pub w1: f64,
    /// Angular velocity along the horizontal e2, `-theta'`.
    pub w2: f64,
    /// Angular velocity along the symmetry axis, `phi' cos(theta) + psi'`.
    pub w3: f64,
}

impl From<[f64; 4]> for State {
    #[inline(always)]
    fn from([theta, w1, w2, w3]: [f64; 4]) -> Self {
        Self { theta, w1, w2, w3 }
    }
}

impl From<State> for [f64; 4] {
    #[inline(always)]
    fn from(y: State) -> Self {
        [y.theta, y.w1, y.w2, y.w3]
    }
}

impl State {
    /// The state with this inclination, in radians, and these rates: theta', phi' (precession) and psi' (spin), in
    /// sqrt(g/R).
    ///
    /// ```
    /// use spincyl::State;
    ///
    /// let y = State::from_rates(1.3, 0.1, 0.7, -2.0);
    /// assert_eq!((y.w2, y.precession(), y.spin()), (-0.1, 0.7, -2.0));
    /// ```
    pub fn from_rates(theta: f64, thetadot: f64, precession: f64, spin: f64) -> Self {
        let (s, c) = theta.sin_cos();
        Self { theta, w1: precession * s, w2: -thetadot, w3: precession.mul_add(c, spin) }
    }

    /// Returns this state with its rate of inclination `theta'` increased by `thetadot`, in sqrt(g/R).
    #[must_use]
    pub fn kicked(self, thetadot: f64) -> Self {
        Self { w2: self.w2 - thetadot, ..self }
    }

    /// Precession phi', the rate at which the body turns about the vertical, in sqrt(g/R).
    pub fn precession(&self) -> f64 {
        self.w1 / self.theta.sin()
    }

    /// Spin psi', the rate at which the body turns about its own axis relative to the axes that precess, in sqrt(g/R).
    /// For a sharp rim it is also the speed of the contact point along the table, in sqrt(g R).
    pub fn spin(&self) -> f64 {
        self.w3 - self.w1 * (self.theta.cos() / self.theta.sin())
    }

    /// The cosine of the angle from the vertical to the axis that points from rim 0 into the body, if the state refers to
    /// `rim`: cos theta for rim 0, and -cos theta for rim 1, the other one.
    pub fn axis_up(&self, rim: u8) -> f64 {
        if rim == 0 { self.theta.cos() } else { -self.theta.cos() }
    }

    /// Angular velocity along (e1, e2, e3), in sqrt(g/R).
    pub fn angular_velocity(&self) -> Vector3<f64> {
        Vector3::new(self.w1, self.w2, self.w3)
    }

    /// The angle gamma from the symmetry axis to the angular velocity, in [0, pi]; 0 for a body at rest.
    pub fn gamma(&self) -> f64 {
        // Adding 0 turns -0 into 0, so that the angle is 0 and not pi.
        self.w1.hypot(self.w2).atan2(self.w3 + 0.0)
    }

    /// Angular momentum about the centre of mass along (e1, e2, e3), in M R^2 sqrt(g/R).
    pub fn angular_momentum(&self, body: &Body) -> Vector3<f64> {
        Vector3::new(body.i1() * self.w1, body.i1() * self.w2, body.i3() * self.w3)
    }

    /// The angle beta from the symmetry axis to the angular momentum, in [0, pi].
    pub fn beta(&self, body: &Body) -> f64 {
        let l = self.angular_momentum(body);
        l.x.hypot(l.y).atan2(l.z + 0.0)
    }

    /// Velocity of the centre of mass along (e1, e2, e3), in sqrt(g R), for a rim that rolls without slipping.
    pub fn centre_velocity(&self, body: &Body) -> Vector3<f64> {
        self.point_velocity(body, Vector3::zeros())
    }

    /// Speed of the point O, which lies opposite to the contact point with respect to the centre, in sqrt(g R). For a
    /// sharp tube O is the uppermost point of its upper rim. Where the centre is at rest this speed is zero, and a
    /// symbol painted at O seems to stand still.
    pub fn speed_o(&self, body: &Body) -> f64 {
        self.point_velocity(body, -self.contact_arm(body)).norm()
    }

    /// Speed of the point X, the top of the circle of contact, in sqrt(g R); it is 2 w1 L where the centre is at rest.
    pub fn speed_x(&self, body: &Body) -> f64 {
        let arm = self.contact_arm(body);
        self.point_velocity(body, Vector3::new(-arm.x, 0.0, arm.z)).norm()
    }

    /// Radius |psi'/phi'| of the circle that the contact point follows on the table, in units of the radius of the
    /// circle of contact on the body (R for a sharp rim). Where the centre is at rest, this is also the number of still
    /// symbols, seen from above.
    pub fn contact_radius(&self) -> f64 {
        (self.spin() / self.precession()).abs()
    }

    /// Radius of the circle that the centre of mass follows, in R; 0 where the centre is at rest, and infinite where
    /// the centre moves along a straight line.
    pub fn centre_radius(&self, body: &Body) -> f64 {
        let speed = self.centre_velocity(body).y.abs();
        if speed == 0.0 { 0.0 } else { speed / self.precession().abs() }
    }

    /// The vector from the centre to the contact point, along e1, e2, e3.
    fn contact_arm(&self, body: &Body) -> Vector3<f64> {
        let (rim, angle) = (body.shape().rim, self.theta.sin_cos());
        Vector3::new(-rim.radius(angle), 0.0, -rim.depth(angle))
    }

    /// Velocity of the point of the body at `p` from the centre of mass, while the contact point is at rest.
    fn point_velocity(&self, body: &Body, p: Vector3<f64>) -> Vector3<f64> {
        self.angular_velocity().cross(&(p - self.contact_arm(body)))
    }
}

impl core::fmt::Display for State {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { theta, w1, w2, w3 } = self;
        write!(f, "theta = {theta}, w = ({w1}, {w2}, {w3})")
    }
}
