//! Stability of a steady state, by two criteria: on a smooth table, and in rolling.
//!
//! ```text
//! kappa = -d/dtheta [tilting(theta, w1(theta), w3(theta))]/J        tilting, J and the lines w1, w3: `contact::reduced`
//! smooth table:  kappa (I1 + g^2) = U'',   U(theta) = (Lz - L3 cos)^2/(2 I1 sin^2) + L3^2/(2 I3) + h
//! upright ball:  standing from w3^2 = 4 ell (I1 + H^2)/(I3 + rho H)^2 rolling, 4 ell I1/I3^2 smooth,   H = ell + rho
//! ```
//! `kappa` is the squared angular frequency of the nutation (in g/R), negative where a disturbance
//! grows at the rate sqrt(-kappa).
//!
//! The criterion *smooth* is whether the energy U(theta) at fixed angular momenta Lz and L3 has a minimum (Jackson et
//! al., Am. J. Phys. 87, 85 (2019), Appendix). It is exact on a frictionless table, where Lz and L3 are conserved. The
//! nutation then has the inertia I1 + g^2, because the centre moves up and down; Eq. (A3) of the paper leaves out g^2,
//! which changes frequencies but no sign. The criterion *rolling* linearises the motion without slipping, where other
//! integrals are conserved. Two of its four eigenvalues are zero, since steady states are a two-parameter family; the
//! others are +-sqrt(-kappa). Where the two criteria differ for a tube or a disk, friction stabilises a state that is
//! unstable on a smooth table. For a body much wider than its rim (I3 above about 1.4) the opposite can happen.
//!
//! Dual numbers, which carry a derivative, give kappa from the law of motion; for maps, `at_rest` has a closed form of
//! kappa with the centre at rest. Error of `kappa` of a state: 64 ulp of the largest term; a test of `laws` runs it.
//!
//! ```
//! use spincyl::stability::{Region, at_rest, nutation, region};
//! use spincyl::{Body, Contact};
//!
//! let body = Body::solid(2.5)?;
//! assert_eq!(region(&body, 1.3), Region::Stable);
//! let kappa = at_rest(&body, 1.3, Contact::Rolling);
//! assert!((nutation(kappa).powi(2) - kappa).abs() < 1e-12 * kappa);
//! # Ok::<(), spincyl::Error>(())
//! ```

mod at_rest;
mod boundaries;
mod codes;
mod column;
mod region;
mod regions;
mod runs;

pub(crate) use at_rest::{AtRest, Moments, Rounded, SteadyPoint, Wanted};
pub use boundaries::boundaries;
pub use codes::codes;
pub(crate) use column::{Column, Stored};
pub use region::Region;
pub use regions::region;
pub(crate) use regions::regions;
pub(crate) use runs::runs;

use crate::laws::body::Body;
use crate::laws::contact::Contact;
use crate::laws::state::State;
use crate::numbers::in_registers;

/// Squared nutation frequency of the steady state with the centre at rest at inclination `theta`
/// in (0, pi/2], in g/R; negative where unstable, NaN where no such state exists.
pub fn at_rest(body: &Body, theta: f64, contact: Contact) -> f64 {
    let wanted = match contact {
        Contact::Smooth => Wanted { smooth: true, ..Wanted::default() },
        Contact::Rolling => Wanted { rolling: true, ..Wanted::default() },
    };
    let of = Column::of(body);
    let found = in_registers!(of.found(theta, wanted));
    match contact {
        Contact::Smooth => found.smooth,
        Contact::Rolling => found.rolling,
    }
}

/// Tolerances for a steady state: of the sum of the terms of theta'' over the largest term, and of |w2| in sqrt(g/R).
const STEADY: f64 = 1e-6;

/// Squared nutation frequency, in g/R, of any steady state on a frictionless table: the energy at fixed Lz and L3 is
/// stationary in such a state, as with the centre at rest.
///
/// The result is NaN for a state that is not steady on a smooth table to six digits; a centre that moves along a circle
/// needs friction. The error is 64 ulp of the largest term, for theta above 1e-100.
pub fn smooth(body: &Body, y: &State) -> f64 {
    of_state(Contact::Smooth, body, y)
}

/// Squared nutation frequency, in g/R, of a rolling steady state, whose centre is at rest or moves along a circle.
///
/// The result is NaN for a state that is not steady to six digits. The error is 64 ulp of the largest term, for theta
/// above 1e-100.
pub fn rolling(body: &Body, y: &State) -> f64 {
    of_state(Contact::Rolling, body, y)
}

/// Returns kappa if the state is steady: theta lies within the body's range, w2 vanishes, and the terms of theta''
/// cancel. Otherwise it returns NaN.
fn of_state(contact: Contact, body: &Body, y: &State) -> f64 {
    let (law, angle) = (contact.reduced(body), y.theta.sin_cos());
    let (of, rim, ct) = (law.at(angle), law.shape.rim, angle.1 / angle.0);
    let &State { w1, w3, .. } = y;
    let terms = [
        of.al * w1 * ct * w1,
        of.k * w1 * w1,
        of.b * w1 * w3,
        of.k * ct * w1 * w3,
        rim.a * angle.1,
        rim.ell * angle.0,
    ];
    let largest = terms.iter().fold(0f64, |a, t| a.max(t.abs()));
    // For an upright coin all terms are rounding errors of pi/2, which the bound EPSILON admits.
    let rest = law.tilting(&of, angle, w1, w3);
    let balanced = rest.abs() <= (STEADY * largest).max(f64::EPSILON);
    let inside = y.theta > 0.0 && y.theta <= body.range();
    if !(inside && balanced && y.w2.abs() < STEADY) {
        return f64::NAN;
    }
    // An overflow gives NaN.
    Some(stiffness(contact, body, y)).filter(|kappa| kappa.is_finite()).unwrap_or(f64::NAN)
}

/// The squared frequency, in g/R, of the nutation about any state, steady or not: minus the derivative of J theta''
/// with respect to theta along the lines w1(theta) and w3(theta), over J. The change of J is left out.
pub(crate) fn stiffness(contact: Contact, body: &Body, y: &State) -> f64 {
    let (law, angle) = (contact.reduced(body), y.theta.sin_cos());
    let tilting = law.tilting_along(angle, y.w1, y.w3);
    -tilting.slope / law.inertia(|| angle)
}

/// The least spin w3, in sqrt(g/R), with which a ball is stable upright on its pole (theta = 0), like a sleeping top.
///
/// ```text
/// rolling   n^2 = 4 ell (I1 + H^2)/(I3 + rho H)^2,   H = ell + rho         smooth   n^2 = 4 ell I1/I3^2
/// ```
/// The result is 0 for a ball that is stable without spin (`ell <= 0`), and NaN for other bodies, which stand on a
/// face. Error: 4 ulp. The horizontal part zeta of the axis obeys zeta'' = 2 i k n zeta' + (ell/J0) zeta with J0 = I1 +
/// H^2 and k = (I3 + rho H)/(2 J0); on a smooth table H is replaced by 0. See Routh, Advanced Rigid Dynamics.
pub fn standing_spin(body: &Body, contact: Contact) -> f64 {
    if !body.is_ball() {
        return f64::NAN;
    }
    let (ell, i1, i3, rho) = (body.ell(), body.i1(), body.i3(), body.fillet());
    let height = ell + rho;
    let (inertia, axial) = match contact {
        Contact::Rolling => (i1 + height * height, i3 + rho * height),
        Contact::Smooth => (i1, i3),
    };
    2.0 * (ell.max(0.0) * inertia).sqrt() / axial
}

/// Angular frequency of the nutation, in sqrt(g/R): sqrt(kappa), or 0 for an unstable state.
pub fn nutation(kappa: f64) -> f64 {
    if kappa.is_nan() { kappa } else { kappa.max(0.0).sqrt() }
}

/// Rate at which a small disturbance grows, in sqrt(g/R): sqrt(-kappa), or 0 for a stable state.
pub fn growth_rate(kappa: f64) -> f64 {
    nutation(-kappa)
}
