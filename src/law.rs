//! What a contact makes of a body: the coefficients of its motion and of its first integrals.
//!
//! ```text
//! ct = cot theta,   s = sin theta,   c = cos theta,   g = ell s - c,   g' = ell c + s
//! theta' = -w2,   w1' = w2 ((ct + A) w1 - B w3),   w3' = -w2 (C w1 + A w3)
//! J w2'  = w1 (ct (k w3 - a w1) + b w3 - k w1) - g   [+ g g' w2^2 on a smooth table]
//! J w2^2 = 2 E - a w1^2 - b w3^2 + 2 k w3 w1 - 2 (ell c + s)
//! rolling:  A = I3 ell/D, B = I3 (I3 + 1)/D, C = I1/D, a = I1 + ell^2, b = I3 + 1, k = ell, J = I1 + 1 + ell^2
//! smooth:   A = C = 0,    B = I3/I1,                   a = I1,         b = I3,     k = 0,   J = I1 + g^2
//! ```
//! Written once over [`Real`], for one body and for eight in lanes; `rolling` and `smooth` say where they
//! come from.

use crate::real::Real;

/// What the contact can do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Contact {
    /// A frictionless table: the paper's criterion.
    Smooth,
    /// Rolling without slipping.
    #[default]
    Rolling,
}

/// The coefficients of the head of this module.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Law<T> {
    pub contact: Contact,
    pub ell: T,
    pub a: T,
    pub b: T,
    pub k: T,
    pub drag: T,
    pub feed: T,
    pub grow: T,
    inertia: T,
}

impl<T: Real> Law<T> {
    #[inline(always)]
    pub fn of(contact: Contact, ell: T, i1: T, i3: T) -> Self {
        let (zero, one) = (ell.splat(0.0), ell.splat(1.0));
        let square = ell * ell;
        match contact {
            Contact::Rolling => {
                let per_d = one / (i1 * i3 + i1 + i3 * square);
                Self {
                    contact,
                    ell,
                    a: i1 + square,
                    b: i3 + one,
                    k: ell,
                    drag: i3 * ell * per_d,
                    feed: i3 * (i3 + one) * per_d,
                    grow: i1 * per_d,
                    inertia: i1 + one + square,
                }
            }
            Contact::Smooth => Self {
                contact,
                ell,
                a: i1,
                b: i3,
                k: zero,
                drag: zero,
                feed: i3 / i1,
                grow: zero,
                inertia: i1,
            },
        }
    }

    /// What tilts a body, J theta'' but for what theta'^2 does on a smooth table.
    #[inline(always)]
    pub fn push(&self, (s, c): (T, T), w1: T, w3: T) -> T {
        let radial = self.a * w1 - self.k * w3;
        let along = self.k * w1 - self.b * w3;
        (c / s * radial + along) * w1 + self.ell * s - c
    }

    /// Twice the energy but for that of the tilting: what turns, and the height of the centre.
    #[inline(always)]
    pub fn still(&self, (s, c): (T, T), w1: T, w3: T) -> T {
        let height = self.ell * c + s;
        let turning = self.a * w1 * w1 + self.b * w3 * w3 - (self.k * w1 * w3 + self.k * w1 * w3);
        turning + (height + height)
    }

    /// J, the inertia of the tilting; of sine and cosine of theta, if it takes them.
    #[inline(always)]
    pub fn inertia(&self, angle: impl FnOnce() -> (T, T)) -> T {
        match self.contact {
            Contact::Rolling => self.inertia,
            Contact::Smooth => {
                let (s, c) = angle();
                let depth = self.ell * s - c;
                depth.mac(depth, self.inertia)
            }
        }
    }
}

/// The same as the equations of motion take it: what rolls has been divided by J.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rates<T> {
    law: Law<T>,
    weight: T,
    lever: T,
}

impl<T: Real> Rates<T> {
    #[inline(always)]
    pub fn of(contact: Contact, ell: T, i1: T, i3: T) -> Self {
        let mut law = Law::of(contact, ell, i1, i3);
        let mut weight = ell.splat(1.0);
        if contact == Contact::Rolling {
            weight = weight / law.inertia;
            (law.a, law.b, law.k) = (law.a * weight, law.b * weight, law.k * weight);
        }
        Self { law, weight, lever: ell * weight }
    }

    /// w1', w2', w3'.
    #[inline(always)]
    pub fn at(&self, s: T, c: T, [w1, w2, w3]: [T; 3]) -> [T; 3] {
        let of = &self.law;
        let ct = c / s;
        let turning = ct.mac(of.k.mac(w3, -(of.a * w1)), of.b.mac(w3, -(of.k * w1)));
        let falling = self.weight.mac(c, -(self.lever * s));
        let push = w1.mac(turning, falling);
        let tilting = match of.contact {
            Contact::Rolling => push,
            Contact::Smooth => {
                let (g, slope) = (of.ell * s - c, of.ell * c + s);
                (g * slope).mac(w2 * w2, push) / g.mac(g, of.inertia)
            }
        };
        [w2 * ct.mac(w1, of.drag.mac(w1, -(of.feed * w3))), tilting, -(w2 * of.grow.mac(w1, of.drag * w3))]
    }
}
