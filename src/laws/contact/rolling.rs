//! Rolling without slipping: the force that keeps the contact point at rest.
//!
//! ```text
//! v   = (L w2, V, -A w2),   V = A w3 - L w1      of the centre: the contact point rests
//! F2  = -I3 w3'/A = V' + w1 w2 (L cot theta + A)
//! Fh  = h w2' + g w2^2 - (w1/s) V
//! N   = 1 + g w2' - g' w2^2
//! ```
//! The force is F = v' + Wf x v + z, where the axes turn with Wf = (w1, w2, w1 cot theta). For a ball at its pole the
//! quotient by A is 0/0, but no state lies there. The equations are those of Chaplygin 1897, Appell and Korteweg 1900;
//! tests of `laws` compare them with a model that solves the three-dimensional Newton-Euler equations and the
//! constraint numerically.
//!
//! Error: a few roundings of the terms written above. The contact force does no work: dE/dt = 0 to 16 ulp of the
//! largest power at any state, and a test of `laws` checks this.
//!
//! ```
//! use spincyl::{Body, rolling, steady};
//!
//! let body = Body::solid(2.5)?;
//! let rate = rolling::derivative(&body, &steady::state(&body, 1.3)?);
//! assert!(rate.w1.abs().max(rate.w2.abs()).max(rate.w3.abs()) < 1e-12); // a steady state does not change
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::Contact;
use crate::laws::body::{Body, Shape};
use crate::laws::newton;
use crate::laws::state::State;
use crate::numbers::Real;

/// The time derivative of (theta, w1, w2, w3), as a `State`, in natural units.
#[inline(always)]
pub fn derivative(body: &Body, y: &State) -> State {
    Contact::Rolling.derivative(body, y)
}

/// Kinetic and potential energy of a body that rolls, in M g R, with heights measured from the table.
pub fn energy(body: &Body, y: &State) -> f64 {
    let (shape, angle, w) = (body.shape(), y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
    newton::energy(&shape, angle, w, centre_velocity(&shape, angle, w))
}

/// Velocity of the centre of mass along e1, e2, e3, for a contact point at rest.
#[inline(always)]
pub(crate) fn centre_velocity<T: Real>(shape: &Shape<T>, angle: (T, T), [w1, w2, w3]: [T; 3]) -> [T; 3] {
    let (radius, depth) = (shape.rim.radius(angle), shape.rim.depth(angle));
    [depth * w2, radius * w3 - depth * w1, -(radius * w2)]
}

/// The force F2 from w, w' and the couple m3. On a tip, where A = 0, F2 follows from the motion of the centre:
/// F2 = V' + cot theta L w1 w2.
#[inline(always)]
pub(crate) fn force_along<T: Real>(
    shape: &Shape<T>,
    angle: (T, T),
    [w1, w2, _]: [T; 3],
    [d1, _, d3]: [T; 3],
    m3: T,
) -> T {
    let (radius, depth) = (shape.rim.radius(angle), shape.rim.depth(angle));
    if radius.abs().is_lt(radius.splat(f64::MIN_POSITIVE)) {
        return depth * (angle.1 / angle.0 * w1 * w2 - d1);
    }
    (m3 - shape.i3 * d3) / radius
}

/// The contact force [N, F2, Fh] of a rolling body, from w and w'.
#[inline(always)]
pub(crate) fn force<T: Real>(shape: &Shape<T>, angle: (T, T), w: [T; 3], dw: [T; 3]) -> [T; 3] {
    let [w1, w2, _] = w;
    let along = force_along(shape, angle, w, dw, w1.splat(0.0));
    let [_, speed, _] = centre_velocity(shape, angle, w);
    let across = shape.rim.height(angle) * dw[1] + shape.rim.lever(angle) * w2 * w2 - w1 / angle.0 * speed;
    [newton::normal(shape, angle, w2, dw[1]), along, across]
}
