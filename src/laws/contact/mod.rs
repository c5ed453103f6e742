//! The contact of a body with the table: the kinds of contact, and the force that the table exerts.
//!
//! ```text
//! rolling   the contact point rests            smooth   the force is vertical
//! friction demand   |F_horizontal| = hypot(F2, Fh),   coefficient needed   |F_horizontal|/N
//! ```
//! [`rolling`] and [`smooth`] give the contact force from the condition of each contact; `reduced` has the equations of
//! motion without the contact force, and [`newton`](super::newton) those under any force. Rolling holds while N > 0 and
//! |F_horizontal| <= mu N: the friction that rolling needs is only compared with mu N, never limited to it.
//!
//! Error: 64 ulp of the largest term, by comparison with a three-dimensional model in a test of `laws`.
//!
//! ```
//! use spincyl::{Body, Contact, contact, steady};
//!
//! // A body whose centre is at rest needs no friction, and the table carries its weight.
//! let body = Body::solid(2.5)?;
//! let force = contact::force(Contact::Rolling, &body, &steady::state(&body, 1.3)?);
//! assert!((force.normal - 1.0).abs() < 1e-12 && force.friction() < 1e-12);
//! # Ok::<(), spincyl::Error>(())
//! ```

pub(crate) mod delassus;
pub(crate) mod face;
mod film;
pub(crate) mod impact;
pub mod landing;
pub mod lossy;
pub(crate) mod lying;
pub mod patch;
pub(crate) mod reduced;
pub(crate) mod restitution;
pub mod rolling;
pub(crate) mod sliding;
pub mod slip;
pub mod smooth;
pub(crate) mod standstill;
mod table;
pub(crate) mod together;
pub(crate) mod two_at_rest;

use super::body::Body;
pub use super::newton::Force;
use super::state::State;
use crate::numbers::Real;
pub use face::{Face, end_ratio};
use reduced::{Rates, Reduced};
pub use restitution::ImpactLaw;
pub use slip::Friction;
pub use table::{Table, TableKind};

/// The kind of contact with the table. The number is the code of the kind in arrays and files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(u8)]
#[non_exhaustive]
pub enum Contact {
    /// Rolling without slipping, with any friction that this needs.
    #[default]
    Rolling = 0,
    /// Sliding on a frictionless table, which is the contact in the criterion of Jackson et al.
    Smooth = 1,
}

/// A slip is an error, since the normal force counts as infinite, if the factor 1 - eps in the denominator of N is below this.
pub(crate) const JAMMED: f64 = 1e-6;
/// A face has landed if its angle to the table is below this, in radians: the gap is then smaller than an atom.
pub(crate) const FLAT: f64 = 1e-10;

impl Contact {
    /// Time derivative of (theta, w1, w2, w3): [`rolling::derivative`] or [`smooth::derivative`].
    #[inline(always)]
    pub fn derivative(self, body: &Body, y: &State) -> State {
        self.derivative_at(body, y, y.theta.sin_cos())
    }

    /// The time derivative of (theta, w1, w2, w3), for given sine and cosine of theta.
    #[inline(always)]
    pub(crate) fn derivative_at(self, body: &Body, y: &State, (s, c): (f64, f64)) -> State {
        self.rates(body).derivative(y, (s, c))
    }

    /// The equations of motion of a body with this contact, with all constant terms computed in advance.
    #[inline(always)]
    pub(crate) fn rates(self, body: &Body) -> Rates<f64> {
        Rates::of(self, &body.shape(), !body.is_sharp())
    }

    /// Energy in M g R: [`rolling::energy`] or [`smooth::energy`].
    pub fn energy(self, body: &Body, y: &State) -> f64 {
        match self {
            Contact::Smooth => smooth::energy(body, y),
            Contact::Rolling => rolling::energy(body, y),
        }
    }

    /// The equations of motion of a body with this contact, without the contact force.
    #[inline(always)]
    pub(crate) fn reduced(self, body: &Body) -> Reduced<f64> {
        Reduced::of(self, &body.shape(), !body.is_sharp())
    }
}

/// The contact force, in M g, that this contact needs in a state, for theta in (0, pi).
#[inline(always)]
pub fn force(contact: Contact, body: &Body, y: &State) -> Force {
    let angle = y.theta.sin_cos();
    let rates = contact.rates(body);
    force_at(rates.reduced(), y, &rates.derivative(y, angle), angle)
}

/// The contact force, from the time derivative `dy` of the state `y`, and sine and cosine of theta.
#[inline(always)]
pub(crate) fn force_at(of: &Reduced<f64>, y: &State, dy: &State, angle: (f64, f64)) -> Force {
    let (w, dw) = ([y.w1, y.w2, y.w3], [dy.w1, dy.w2, dy.w3]);
    let [normal, along, across] = force_of(of, angle, w, dw);
    Force { normal, along, across }
}

/// The margin of static friction, mu N |mu N| - F^2, from N and F^2; sticking needs a positive margin. The margin keeps
/// falling where N turns negative, so that a step across the lift-off does not find a contact that holds. The last term
/// keeps the margin positive where mu and F both vanish.
#[inline(always)]
pub(crate) fn grip<T: Real>(mu: T, normal: T, square: T) -> T {
    let most = mu * normal;
    most * most.abs() - square + mu.splat(1e-30)
}

/// The contact force [N, F2, Fh] for any type of number, from sine and cosine of theta, w and w'.
#[inline(always)]
pub(crate) fn force_of<T: Real>(of: &Reduced<T>, angle: (T, T), w: [T; 3], dw: [T; 3]) -> [T; 3] {
    match of.contact {
        Contact::Rolling => rolling::force(&of.shape, angle, w, dw),
        Contact::Smooth => smooth::force(&of.shape, angle, w, dw),
    }
}
