//! Sliding on a frictionless table: the force is vertical.
//!
//! ```text
//! F2 = Fh = 0,   N = 1 + g w2' - g' w2^2,   v = g w2 z
//! w1' = w2 (ct w1 - (I3/I1) w3),   w3' = 0
//! w2' = (-I1 ct w1^2 + I3 w1 w3 - g + g g' w2^2)/(I1 + g^2)
//! Lz  = I1 w1 sin theta + I3 w3 cos theta,   L3 = I3 w3
//! ```
//! The force of the table is vertical, so the angular momenta about the vertical and about the symmetry axis are
//! conserved. The horizontal velocity of the centre is constant and taken as zero, so that the centre only moves up and
//! down. The stability criterion of Jackson et al., Am. J. Phys. 87, 85 (2019), Appendix, is for this table; its Eq.
//! (A3) has I1 instead of I1 + g^2. For a given a, a fillet changes only the height h.
//!
//! Error: a few roundings of the terms above. Energy and both momenta change by less than 64 ulp of the largest power
//! or torque at any state, and a test of `laws` checks this.
//!
//! ```
//! use spincyl::{Body, State, smooth};
//!
//! // A vertical force has no moment about the axis of the body.
//! let rate = smooth::derivative(&Body::solid(2.5)?, &State { theta: 1.3, w1: 0.3, w2: -0.2, w3: 2.0 });
//! assert!(rate.theta == 0.2 && rate.w3.abs() < 1e-15);
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
    Contact::Smooth.derivative(body, y)
}

/// Kinetic and potential energy, in M g R, with heights measured from the table; the centre has no horizontal velocity.
pub fn energy(body: &Body, y: &State) -> f64 {
    let (shape, angle, w) = (body.shape(), y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
    newton::energy(&shape, angle, w, centre_velocity(&shape, angle, w))
}

/// The velocity of the centre, which is vertical; it stands in the first component, since only its magnitude is used.
#[inline(always)]
pub(crate) fn centre_velocity<T: Real>(shape: &Shape<T>, angle: (T, T), [_, w2, _]: [T; 3]) -> [T; 3] {
    let zero = w2.splat(0.0);
    [shape.rim.lever(angle) * w2, zero, zero]
}

/// The contact force [N, F2, Fh] on a smooth table, from w and w'; F2 and Fh are zero.
#[inline(always)]
pub(crate) fn force<T: Real>(shape: &Shape<T>, angle: (T, T), w: [T; 3], dw: [T; 3]) -> [T; 3] {
    let zero = w[1].splat(0.0);
    [newton::normal(shape, angle, w[1], dw[1]), zero, zero]
}
