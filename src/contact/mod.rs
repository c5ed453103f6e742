//! The contact: what a table can do, and the force that it exerts.
//!
//! ```text
//! rolling   the contact point rests            smooth   the force is vertical
//! friction demand   |F_horizontal| = hypot(F2, Fh),   coefficient needed   |F_horizontal|/N
//! ```
//! [`rolling`] and [`smooth`] have each table's force, from its own condition; `reduced` has what is left of the motion
//! once two numbers are conserved, and [`newton`](crate::newton) moves a body under any force. Rolling holds while N > 0
//! and |F_horizontal| <= mu N: the friction demand is compared, never enforced.
//!
//! Error: 64 ulp of the largest term, against the three-dimensional model (a test of `laws` runs it).

pub mod landing;
pub mod lossy;
pub(crate) mod reduced;
pub mod rolling;
pub mod slip;
pub mod smooth;
pub(crate) mod standstill;
mod table;

use crate::body::Body;
pub use crate::newton::Force;
use crate::number::Real;
use crate::state::State;
use reduced::{Rates, Reduced};
pub use slip::Friction;
pub use table::{Table, TableKind};

/// What the contact can do. The number is its code in arrays and files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(u8)]
pub enum Contact {
    /// Rolling without slipping.
    #[default]
    Rolling = 0,
    /// A frictionless table: the paper's criterion.
    Smooth = 1,
}

/// A face closer to the table than this, in radians, has landed: on any table it is less than an atom away.
pub(crate) const FLAT: f64 = 1e-10;

impl Contact {
    /// Time derivative of (theta, w1, w2, w3): [`rolling::derivative`] or [`smooth::derivative`].
    #[inline(always)]
    pub fn derivative(self, body: &Body, y: &State) -> State {
        self.derivative_at(body, y, y.theta.sin_cos())
    }

    /// The same where sine and cosine of theta are known already.
    #[inline(always)]
    pub(crate) fn derivative_at(self, body: &Body, y: &State, (s, c): (f64, f64)) -> State {
        self.rates(body).derivative(y, (s, c))
    }

    /// The equations of motion of a body on this table, with all that does not change computed.
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

    /// What a body does on this table.
    #[inline(always)]
    pub(crate) fn reduced(self, body: &Body) -> Reduced<f64> {
        Reduced::of(self, &body.shape(), !body.is_sharp())
    }
}

/// The contact force in a state that obeys the equations of motion; theta in (0, pi).
#[inline(always)]
pub fn force(contact: Contact, body: &Body, y: &State) -> Force {
    let angle = y.theta.sin_cos();
    let rates = contact.rates(body);
    force_at(rates.reduced(), y, &rates.derivative(y, angle), angle)
}

/// The same where the state's derivative, and sine and cosine of theta, are known already.
#[inline(always)]
pub(crate) fn force_at(of: &Reduced<f64>, y: &State, dy: &State, angle: (f64, f64)) -> Force {
    let (w, dw) = ([y.w1, y.w2, y.w3], [dy.w1, dy.w2, dy.w3]);
    let [normal, along, across] = force_of(of, angle, w, dw);
    Force { normal, along, across }
}

/// The same over any number: N, F2 and Fh, of sine and cosine, w and w'.
#[inline(always)]
pub(crate) fn force_of<T: Real>(of: &Reduced<T>, angle: (T, T), w: [T; 3], dw: [T; 3]) -> [T; 3] {
    match of.contact {
        Contact::Rolling => rolling::force(&of.shape, angle, w, dw),
        Contact::Smooth => smooth::force(&of.shape, angle, w, dw),
    }
}
