//! Newton's and Euler's equations: the motion of a body under a given contact force and a given couple.
//!
//! ```text
//! s, c = sine, cosine of theta,   ct = c/s,   A, L, h, g, g' as in `body::rim`
//! theta' = -w2
//! I1 w1' = w2 (I1 ct w1 - I3 w3) + L F2 + m1
//! I1 w2' = -I1 ct w1^2 + I3 w1 w3 - g N - h Fh + m2
//! I3 w3' = -A F2 + m3
//! N      = 1 + g w2' - g' w2^2                            a body that stays on the table
//! E      = (I1 (w1^2 + w2^2) + I3 w3^2 + v^2)/2 + h
//! ```
//! The contact force, in units of the weight, has the components N (vertical), F2 (along e2) and Fh (along e_h = c e1 -
//! s e3, which is horizontal, on the side to which e1 leans); m is the couple along e1, e2, e3, and v is the velocity
//! of the centre. The equations are L' = r x F + m about the centre of mass along axes that follow the inclination, as
//! in any textbook. The module [`contact`](super::contact) gives the contact force.
//!
//! Error: 4 ulp of the largest term.
//!
//! ```
//! use spincyl::newton::{Force, derivative};
//! use spincyl::{Body, State};
//!
//! // On a table that carries its weight, a body at theta0 stays balanced on a point of its rim.
//! let body = Body::solid(2.0)?;
//! let balanced = State { theta: body.theta_balance(), w1: 0.0, w2: 0.0, w3: 0.0 };
//! let rate = derivative(&body, &balanced, &Force::new(1.0, 0.0, 0.0), [0.0; 3]);
//! assert!(rate.w2.abs() < 1e-15);
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::body::{Body, Shape};
use super::state::State;
use crate::numbers::Real;
use nalgebra::Vector3;

/// The contact force, in units of the weight.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Force {
    /// The vertical component N, positive where the table presses on the body.
    pub normal: f64,
    /// The horizontal component F2 along e2, the direction in which the contact point runs.
    pub along: f64,
    /// The horizontal component Fh, across e2 and towards the side to which e1 leans.
    pub across: f64,
}

impl Force {
    /// The contact force with the components N, F2 and Fh, in units of the weight.
    pub fn new(normal: f64, along: f64, across: f64) -> Self {
        Self { normal, along, across }
    }

    /// The friction that acts, as the magnitude of the horizontal force.
    pub fn friction(&self) -> f64 {
        self.along.hypot(self.across)
    }

    /// The components along the axes of the laboratory, in which e2 is y at phi = 0, and e1 leans toward x. The result
    /// does not depend on whole turns of phi.
    pub fn in_laboratory(&self, phi: f64) -> Vector3<f64> {
        let (s, c) = phi.sin_cos();
        Vector3::new(c * self.across - s * self.along, s * self.across + c * self.along, self.normal)
    }

    /// The coefficient of friction that rolling needs; infinite where the normal force is not positive, and NaN in the
    /// air, where no force acts.
    pub fn friction_coefficient(&self) -> f64 {
        let friction = self.friction();
        if self.normal > 0.0 || friction == 0.0 && self.normal == 0.0 {
            friction / self.normal
        } else {
            f64::INFINITY
        }
    }
}

/// The time derivative of (theta, w1, w2, w3), as a `State`, under any contact force and couple (along e1, e2, e3).
///
/// Theta lies in (0, pi). The force may be one that no table can exert.
pub fn derivative(body: &Body, y: &State, force: &Force, couple: [f64; 3]) -> State {
    let angle = y.theta.sin_cos();
    let given = [force.normal, force.along, force.across];
    let [w1, w2, w3] = acceleration(&body.shape(), angle, [y.w1, y.w2, y.w3], given, couple);
    State { theta: -y.w2, w1, w2, w3 }
}

/// The accelerations w1', w2', w3' under the contact force (N, F2, Fh) and a couple.
#[inline(always)]
pub(crate) fn acceleration<T: Real>(
    shape: &Shape<T>,
    (s, c): (T, T),
    w: [T; 3],
    force: [T; 3],
    [m1, m2, m3]: [T; 3],
) -> [T; 3] {
    let [t1, t2, t3] = torque(shape, (s, c), c / s * w[0], w, force);
    [(t1 + m1) / shape.i1, (t2 + m2) / shape.i1, (t3 + m3) / shape.i3]
}

/// The products I1 w1', I1 w2', I3 w3' under the contact force (N, F2, Fh); `turn` is w1 cot theta.
#[inline(always)]
pub(crate) fn torque<T: Real>(
    Shape { rim, i1, i3 }: &Shape<T>,
    angle: (T, T),
    turn: T,
    [w1, w2, w3]: [T; 3],
    [normal, along, across]: [T; 3],
) -> [T; 3] {
    let (i1, i3) = (*i1, *i3);
    [
        w2 * (i1 * turn - i3 * w3) + rim.depth(angle) * along,
        w1 * (i3 * w3 - i1 * turn) - rim.lever(angle) * normal - rim.height(angle) * across,
        -(rim.radius(angle) * along),
    ]
}

/// The normal force N on a body that stays on the table, from w2 and w2'.
#[inline(always)]
pub(crate) fn normal<T: Real>(shape: &Shape<T>, angle: (T, T), w2: T, w2_rate: T) -> T {
    w2.splat(1.0) + shape.rim.lever(angle) * w2_rate - shape.rim.slope(angle) * w2 * w2
}

/// Kinetic and potential energy in M g R, of a body whose centre has the velocity v; heights are above the table.
#[inline(always)]
pub(crate) fn energy<T: Real>(shape: &Shape<T>, angle: (T, T), [w1, w2, w3]: [T; 3], v: [T; 3]) -> T {
    let turning = shape.i1 * (w1 * w1 + w2 * w2) + shape.i3 * w3 * w3;
    let moving = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    w1.splat(0.5) * (turning + moving) + shape.rim.height(angle)
}
