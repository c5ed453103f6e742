//! The contact: what it can do, and the force it takes.
//!
//! ```text
//! g = ell sin theta - cos theta,   g' = ell cos theta + sin theta
//! N   = 1 + d^2/dt^2 (ell cos theta + sin theta) = 1 + g w2' - g' w2^2
//! rolling:  F_e2 = -I3 w3',   F_h = g' w2' + g w2^2 - (w1/sin theta)(w3 - ell w1)
//! smooth:   F_e2 = F_h = 0
//! ```
//! F = v' + Wf x v + z is the contact force in units of the weight: N its vertical part, F_e2 along
//! the path of the contact point, F_h across it, h = cos theta e1 - sin theta e3. The torque about the
//! symmetry axis is -F_e2, which is how it is computed. Rolling holds while N > 0 and
//! |F_horizontal| <= mu N: the friction demand is compared, never enforced.
//!
//! Error: 64 ulp of the largest term, against the three-dimensional model (a test runs it).

use crate::body::Body;
use crate::state::State;
use crate::{rolling, smooth};

/// A face closer to the table than this, in radians, has landed: on any table it is less than an atom away.
pub(crate) const FLAT: f64 = 1e-10;

/// What the contact can do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Contact {
    /// A frictionless table: the paper's criterion.
    Smooth,
    /// Rolling without slipping.
    #[default]
    Rolling,
}

impl Contact {
    /// Time derivative of (theta, w1, w2, w3): [`rolling::derivative`] or [`smooth::derivative`].
    #[inline(always)]
    pub fn derivative(self, body: &Body, y: &State) -> State {
        match self {
            Contact::Smooth => smooth::derivative(body, y),
            Contact::Rolling => rolling::derivative(body, y),
        }
    }

    /// The same where sine and cosine of theta are known already.
    #[inline(always)]
    pub(crate) fn derivative_at(self, body: &Body, y: &State, angle: (f64, f64)) -> State {
        match self {
            Contact::Smooth => smooth::derivative_at(body, y, angle),
            Contact::Rolling => rolling::derivative_at(body, y, angle),
        }
    }

    /// Energy in M g R: [`rolling::energy`] or [`smooth::energy`].
    pub fn energy(self, body: &Body, y: &State) -> f64 {
        match self {
            Contact::Smooth => smooth::energy(body, y),
            Contact::Rolling => rolling::energy(body, y),
        }
    }
}

/// The contact force, in units of the weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Force {
    /// Vertical: N.
    pub normal: f64,
    /// Horizontal, along e2, the direction in which the contact point runs.
    pub along: f64,
    /// Horizontal, across that, towards the side to which e1 leans.
    pub across: f64,
}

impl Force {
    /// Friction demand: the size of the horizontal force.
    pub fn friction(&self) -> f64 {
        self.along.hypot(self.across)
    }

    /// The coefficient of friction that rolling needs; infinite where nothing presses.
    pub fn coefficient(&self) -> f64 {
        if self.normal > 0.0 { self.friction() / self.normal } else { f64::INFINITY }
    }
}

/// The contact force in a state that obeys the equations of motion; theta in (0, pi).
#[inline(always)]
pub fn force(contact: Contact, body: &Body, y: &State) -> Force {
    let angle = y.theta.sin_cos();
    force_at(contact, body, y, &contact.derivative_at(body, y, angle), angle)
}

/// The same where the state's derivative, and sine and cosine of theta, are known already.
#[inline(always)]
pub(crate) fn force_at(contact: Contact, body: &Body, y: &State, dy: &State, (s, c): (f64, f64)) -> Force {
    let ell = body.ell();
    let (g, slope) = (ell * s - c, ell * c + s);
    let normal = normal_at(body, y, dy, (s, c));
    match contact {
        Contact::Smooth => Force { normal, along: 0.0, across: 0.0 },
        Contact::Rolling => Force {
            normal,
            along: -body.i3() * dy.w3,
            across: slope * dy.w2 + g * y.w2 * y.w2 - y.w1 / s * (y.w3 - ell * y.w1),
        },
    }
}

/// N alone.
#[inline(always)]
pub(crate) fn normal_at(body: &Body, y: &State, dy: &State, (s, c): (f64, f64)) -> f64 {
    1.0 + (body.ell() * s - c) * dy.w2 - (body.ell() * c + s) * y.w2 * y.w2
}
