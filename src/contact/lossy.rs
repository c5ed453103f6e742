//! A body that rolls, or slides freely, and loses energy: the couple of its losses, and what it does.
//!
//! ```text
//! al, b, k, J as in `contact::reduced`,   D = al b - k^2,   m = m0 + N mN the couple
//! w1' += (b m1 + k m3)/D,   w2' += m2/J,   w3' += (k m1 + al m3)/D
//! N = (1 + g (w2'_0 + m0_2/J) - g' w2^2)/(1 - g mN_2/J),   w2'_0 without losses
//! F2 = (m3 - I3 w3')/A,   Fh as without losses                         rolling; both vanish on a smooth table
//! contour held:   psi' = 0,   m = lambda h/s,   lambda = psi''_0 D/(al - 2 k ct + b ct^2),   |lambda| <= eps N A
//! drilling held:  w_z = 0,    m = nu z,         nu = -w_z'_0 D/(b s^2 + 2 k s c + al c^2),   |nu| <= length N
//! ```
//! The force of rolling does no work, so that E falls by the power of the losses. Where the contact point stops, or the
//! drilling, dry friction holds it with any couple up to its largest: the one that keeps it at rest (Filippov 1960).
//!
//! Error: a few roundings of the terms written above; a test of `losses` compares them with [`newton`].

use super::reduced::{Coefficients, Rates};
use super::{Contact, rolling};
use crate::body::Body;
use crate::loss::{Couples, Law, Losses};
use crate::newton;
use crate::number::Real;
use crate::state::State;

/// What dry friction holds.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Held<T> {
    Nothing,
    /// psi', so that it changes at this rate; of what stays at rest 0.
    Contour(T),
    /// w_z = 0.
    Drilling,
}

/// A body on a table, with losses.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lossy<T> {
    pub rates: Rates<T>,
    pub losses: Couples<T>,
}

/// What happens to it in one state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Acted<T> {
    /// w'.
    pub w: [T; 3],
    /// N, F2, Fh.
    pub force: [T; 3],
    /// The power that is lost.
    pub power: T,
    /// lambda or nu of what is held, and the largest that can be.
    pub held: [T; 2],
}

impl<T: Real> Lossy<T> {
    /// psi'' times s^2 over lambda, the sign turned, times D.
    #[inline(always)]
    fn yielding(of: &Coefficients<T>, (s, c): (T, T)) -> T {
        of.al * s * s - (of.k + of.k) * s * c + of.b * c * c
    }

    /// How fast psi'' follows psi' where the couple along the contour grows with it: psi'' = -rate psi' + ...
    #[inline(always)]
    pub fn stiffness(&self, angle: (T, T), slope: T) -> T {
        let of = self.rates.reduced().at(angle);
        slope * Self::yielding(&of, angle) * of.per_d / (angle.0 * angle.0)
    }

    /// dt/dsigma where the rolling and the rocking are so fast: rolling resistance takes as much of that speed in a while as
    /// delta/J, and in sigma it vanishes as exp(-sigma).
    #[inline(always)]
    pub fn pace(&self, angle: (T, T), speed: T) -> T {
        let inertia = self.rates.reduced().inertia(
            #[inline(always)]
            || angle,
        );
        speed / (speed + self.losses.coefficient(Law::RollingResistance) / inertia)
    }

    /// w1' and w3' under m1 and m3, from those without.
    #[inline(always)]
    fn turned(of: &Coefficients<T>, [d1, d3]: [T; 2], m1: T, m3: T) -> [T; 2] {
        [(of.b * m1 + of.k * m3).mac(of.per_d, d1), (of.k * m1 + of.al * m3).mac(of.per_d, d3)]
    }

    /// What happens at sine and cosine of theta, phi' = w1/s, and w.
    #[inline(always)]
    pub fn at(&self, angle: (T, T), precession: T, w: [T; 3], held: Held<T>) -> Acted<T> {
        let ((s, c), [w1, w2, w3], reduced) = (angle, w, self.rates.reduced());
        let (shape, of) = (&reduced.shape, reduced.at(angle));
        let (lever, slope, one) = (shape.rim.lever(angle), shape.rim.slope(angle), s.splat(1.0));
        let [d1, d2, d3] = self.rates.at(s, c, w);
        let seen = self.losses.seen(&shape.rim, angle, precession, w);
        let couple = self.losses.at(&seen);
        let tilts = self.losses.tilts();
        let (mut tilted, mut per_inertia) = (d2, one);
        if tilts {
            per_inertia = one
                / reduced.inertia(
                    #[inline(always)]
                    || angle,
                );
            tilted = couple.free[1].mac(per_inertia, d2);
        }
        let mut normal = one + lever * tilted - slope * w2 * w2;
        if tilts {
            let pressed = normal / (one - lever * couple.pressed[1] * per_inertia);
            normal = s.splat(0.0).select_lt(normal, pressed, normal);
        }
        // what has lifted off is not pressed
        let pressing = normal.max(s.splat(0.0));
        let [mut m1, m2, mut m3] = couple.under(pressing);
        let tilting = if tilts { m2.mac(per_inertia, d2) } else { d2 };
        let [mut r1, mut r3] = Self::turned(&of, [d1, d3], m1, m3);
        let mut stays = [s.splat(0.0), one];
        let radius = seen.radius;
        match held {
            Held::Nothing => {}
            Held::Contour(rate) => {
                // s^2 psi''
                let off = s * (s * r3 - c * r1 - precession * w2 - s * rate);
                let push = off / (Self::yielding(&of, angle) * of.per_d);
                (m1, m3) = (m1 + c / s * push, m3 - push);
                [r1, r3] = Self::turned(&of, [d1, d3], m1, m3);
                stays = [push, self.losses.coefficient(Law::DryContour) * pressing * radius];
            }
            Held::Drilling => {
                let off = s * r1 + c * r3 - w2 * (c * w1 - s * w3);
                let give = of.b * s * s + (of.k + of.k) * s * c + of.al * c * c;
                let push = -(off / (give * of.per_d));
                (m1, m3) = (m1 + s * push, m3 + c * push);
                [r1, r3] = Self::turned(&of, [d1, d3], m1, m3);
                stays = [push, self.losses.coefficient(Law::Drilling) * pressing];
            }
        }
        let (along, across) = match reduced.contact {
            Contact::Smooth => (s.splat(0.0), s.splat(0.0)),
            Contact::Rolling => {
                let [_, speed, _] = rolling::centre_velocity(shape, angle, w);
                let across = shape.rim.height(angle) * tilting + lever * w2 * w2 - precession * speed;
                ((m3 - shape.i3 * r3) / radius, across)
            }
        };
        let power = self.losses.power(&seen, pressing);
        Acted { w: [r1, tilting, r3], force: [normal, along, across], power, held: stays }
    }
}

impl Lossy<f64> {
    pub fn of(contact: Contact, body: &Body, losses: &Losses) -> Self {
        Self { rates: contact.rates(body), losses: Couples::of(losses, |x| x) }
    }

    /// What happens in a state in which nothing is held.
    pub fn in_state(&self, y: &State) -> Acted<f64> {
        let angle = y.theta.sin_cos();
        self.at(angle, y.w1 / angle.0, [y.w1, y.w2, y.w3], Held::Nothing)
    }
}

/// Time derivative of (theta, w1, w2, w3) of a body that rolls, or slides freely, with losses, in the same places; and the
/// power that is lost. What is at rest is taken to stay so without a couple.
pub fn derivative(contact: Contact, body: &Body, y: &State, losses: &Losses) -> (State, f64) {
    let Acted { w: [w1, w2, w3], power, .. } = Lossy::of(contact, body, losses).in_state(y);
    (State { theta: -y.w2, w1, w2, w3 }, power)
}

/// The contact force then.
pub fn force(contact: Contact, body: &Body, y: &State, losses: &Losses) -> newton::Force {
    let [normal, along, across] = Lossy::of(contact, body, losses).in_state(y).force;
    newton::Force { normal, along, across }
}
