//! Rolling without slipping: the equations of motion and the energy they conserve.
//!
//! ```text
//! J = I1 + 1 + ell^2,   D = I1 I3 + I1 + I3 ell^2,   ct = cot theta
//! theta' = -w2
//! w1' =  w2 (ct w1 + (I3 ell/D) w1 - (I3 (I3 + 1)/D) w3)
//! w3' = -w2 (I1 w1 + I3 ell w3)/D
//! w2' = (-(I1 + ell^2) ct w1^2 - ell w1^2 + (I3 + 1) w1 w3 + ell ct w1 w3 + cos theta - ell sin theta)/J
//! E   = (J w2^2 + I1 w1^2 + I3 w3^2 + (w3 - ell w1)^2)/2 + ell cos theta + sin theta
//! ```
//! From M v' = F - M g z and L' = r x F with v = r x w, the contact force F eliminated. Chaplygin
//! 1897, Appell and Korteweg 1900; the coefficients are checked in the tests against a model
//! that solves the three-dimensional Newton-Euler equations with the constraint numerically.
//!
//! Error: a few roundings of the terms written above. No force does work: dE/dt = 0 to 16 ulp of
//! the largest power at any state, and a test runs it.

use crate::body::Body;
use crate::law::Contact;
use crate::state::State;

/// Time derivative of (theta, w1, w2, w3), in the same places; natural units.
#[inline(always)]
pub fn derivative(body: &Body, y: &State) -> State {
    Contact::Rolling.derivative(body, y)
}

/// Kinetic and potential energy of a body that rolls, in M g R, from the table up.
pub fn energy(body: &Body, y: &State) -> f64 {
    let &State { theta, w1, w2, w3 } = y;
    let ell = body.ell();
    let slide = w3 - ell * w1;
    let kinetic = body.j() * w2 * w2 + body.i1() * w1 * w1 + body.i3() * w3 * w3 + slide * slide;
    0.5 * kinetic + ell * theta.cos() + theta.sin()
}
