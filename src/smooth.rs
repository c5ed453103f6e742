//! Sliding on a frictionless table: the equations of motion and what they conserve.
//!
//! ```text
//! g = ell sin theta - cos theta,   g' = ell cos theta + sin theta,   ct = cot theta
//! theta' = -w2
//! w1' = w2 (ct w1 - (I3/I1) w3),   w3' = 0
//! w2' = (-I1 ct w1^2 + I3 w1 w3 - g + g g' w2^2)/(I1 + g^2)
//! E   = ((I1 + g^2) w2^2 + I1 w1^2 + I3 w3^2)/2 + ell cos theta + sin theta
//! Lz  = I1 w1 sin theta + I3 w3 cos theta,   L3 = I3 w3
//! ```
//! The table only pushes upwards, so the angular momenta about the vertical and about the symmetry axis
//! are conserved, and the centre keeps its velocity in plan view: it is taken at rest, moving up
//! and down only. This is the table of the stability criterion of Jackson et al., Am. J. Phys. 87,
//! 85 (2019), Appendix, whose (A3) leaves out g^2 beside I1.
//!
//! Error: a few roundings of the terms above. Energy and both momenta change by less than 64 ulp of the
//! largest power or torque at any state, and a test runs it.

use crate::body::Body;
use crate::law::Contact;
use crate::state::State;

/// Time derivative of (theta, w1, w2, w3), in the same places; natural units.
#[inline(always)]
pub fn derivative(body: &Body, y: &State) -> State {
    Contact::Smooth.derivative(body, y)
}

/// Kinetic and potential energy, in M g R, from the table up; the centre at rest in plan view.
pub fn energy(body: &Body, y: &State) -> f64 {
    let &State { theta, w1, w2, w3 } = y;
    let (s, c) = theta.sin_cos();
    let g = body.ell() * s - c;
    let kinetic = (body.i1() + g * g) * w2 * w2 + body.i1() * w1 * w1 + body.i3() * w3 * w3;
    0.5 * kinetic + body.ell() * c + s
}
