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
use crate::law::Rates;
use crate::real::Real;
use crate::state::State;
use crate::{rolling, smooth};

pub use crate::law::Contact;

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
        let &State { w1, w2, w3, .. } = y;
        let [d1, d2, d3] = Rates::of(self, body.ell(), body.i1(), body.i3()).at(s, c, [w1, w2, w3]);
        State { theta: -w2, w1: d1, w2: d2, w3: d3 }
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
    pub fn friction_coefficient(&self) -> f64 {
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
    let w = [y.w1, y.w2, y.w3];
    let [normal, along, across] =
        force_of(contact, [body.ell(), body.i3()], (s, c), w, [dy.w1, dy.w2, dy.w3]);
    Force { normal, along, across }
}

/// The same over any number: vertical, along, across; of a body's ell and I3, sine and cosine, w and w'.
#[inline(always)]
pub(crate) fn force_of<T: Real>(
    contact: Contact,
    [ell, i3]: [T; 2],
    (s, c): (T, T),
    [w1, w2, w3]: [T; 3],
    [_, dw2, dw3]: [T; 3],
) -> [T; 3] {
    let (g, slope) = (ell * s - c, ell * c + s);
    let normal = s.splat(1.0) + g * dw2 - slope * w2 * w2;
    match contact {
        Contact::Smooth => [normal, s.splat(0.0), s.splat(0.0)],
        Contact::Rolling => [normal, -(i3 * dw3), slope * dw2 + g * w2 * w2 - w1 / s * (w3 - ell * w1)],
    }
}

/// N alone.
#[inline(always)]
pub(crate) fn normal_at(body: &Body, y: &State, dy: &State, (s, c): (f64, f64)) -> f64 {
    1.0 + (body.ell() * s - c) * dy.w2 - (body.ell() * c + s) * y.w2 * y.w2
}
