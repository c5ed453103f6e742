//! A body that rolls or slides freely and loses energy: the effect of the couple of its losses.
//!
//! ```text
//! al, b, k, J as in `contact::reduced`,   D = al b - k^2,   m = m0 + N mN the couple
//! w1' += (b m1 + k m3)/D,   w2' += m2/J,   w3' += (k m1 + al m3)/D
//! N = (1 + g (w2'_0 + m0_2/J) - g' w2^2)/(1 - g mN_2/J),   w2'_0 without losses
//! F2 = (m3 - I3 w3')/A,   Fh as without losses                         rolling; both vanish on a smooth table
//! contour held:   psi' = 0,   m = lambda h/s,   lambda = psi''_0 D/(al - 2 k ct + b ct^2),   |lambda| <= eps N A
//! drilling held:  w_z = 0,    m = nu z,         nu = -w_z'_0 D/(b s^2 + 2 k s c + al c^2),   |nu| <= length N
//! ```
//! The contact force of rolling does no work, so that E falls by the power of the losses. Where the contact point stops
//! along the rim, or the drilling stops, dry friction exerts the couple that holds it at rest, up to the bound on
//! |lambda| or |nu| above (Filippov 1960).
//!
//! Error: a few roundings of the terms written above; a test of `losses` compares them with [`newton`].
//!
//! ```
//! use spincyl::loss::{Law, Losses};
//! use spincyl::{Body, Contact, contact::lossy, steady};
//!
//! let body = Body::solid(2.5)?;
//! let state = steady::state(&body, 1.3)?;
//! let (_, power) = lossy::derivative(Contact::Rolling, &body, &state, &Losses::of(Law::AirLinear, 1e-3));
//! assert!((power / (1e-3 * state.angular_velocity().norm_squared()) - 1.0).abs() < 1e-12); // b w.w
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::reduced::{Coefficients, Rates, Reduced};
use super::{Contact, rolling};
use crate::laws::body::{Body, Shape};
use crate::laws::loss::{Couple, Couples, Law, Losses, OwnCouple, UnderCouple, rolling_couple_needed};
use crate::laws::newton;
use crate::laws::state::{State, drilling_of, rolling_of};
use crate::numbers::{Dual, Real};

/// Longest time step, in units of 1/rate, the time in which couples along the contour reduce psi' by the factor e. A
/// step of eighth order is stable up to about six of these times.
pub(crate) const DAMPED: f64 = 5.0;

/// The motion that dry friction holds at rest, or whose rate of change is prescribed.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Held<T> {
    Nothing,
    /// The spin psi', which changes at this prescribed rate; the rate is 0 while dry friction holds psi' at 0.
    Contour(T),
    /// The drilling, held at w_z = 0.
    Drilling,
    /// Rolling and rocking, both held at rest: the body only turns about the vertical.
    Rolling,
}

/// A body on a table, with losses.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lossy<T, G = ()> {
    pub rates: Rates<T>,
    pub losses: Couples<T, G>,
}

/// The accelerations, the contact force and the lost power in one state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Acted<T> {
    /// The time derivatives of w1, w2 and w3.
    pub w: [T; 3],
    /// The contact force [N, F2, Fh].
    pub force: [T; 3],
    pub power: T,
    /// The magnitude of the couple lambda or nu that holds a motion, and the largest one that friction can exert.
    pub held: [T; 2],
}

impl<T: Real, G: OwnCouple<T>> Lossy<T, G> {
    /// The factor -s^2 D psi''/lambda, where psi'' is the part that the couple lambda h/s causes.
    #[inline(always)]
    fn spin_response(of: &Coefficients<T>, (s, c): (T, T)) -> T {
        of.al * s * s - (of.k + of.k) * s * c + of.b * c * c
    }

    /// The rate in psi'' = -rate psi' + ..., if the couple along the contour is X h/s and dX/dpsi' is `slope`.
    #[inline(always)]
    pub fn stiffness(&self, angle: (T, T), slope: T) -> T {
        let of = self.rates.reduced().at(angle);
        slope * Self::spin_response(&of, angle) * of.per_d / (angle.0 * angle.0)
    }

    /// The longest time step for which psi' stays damped ([`DAMPED`]). Near theta = 0 the couples along the contour
    /// stop psi' ever faster; after longer steps the errors of psi' would persist, and the couples would turn them into
    /// forces.
    #[inline(always)]
    pub fn damped(&self, angle: (T, T), spin: T) -> T {
        let radius = self.rates.reduced().shape.rim.radius(angle);
        angle.0.splat(DAMPED) / self.stiffness(angle, self.losses.slope(angle.0.abs(), radius, spin))
    }

    /// The ratio dt/dsigma of time to the integration variable sigma if rolling and rocking together have this speed.
    /// Rolling resistance reduces the speed by about delta/J in a unit of time; in sigma the speed vanishes as
    /// exp(-sigma).
    #[inline(always)]
    pub fn pace(&self, angle: (T, T), speed: T) -> T {
        let inertia = self.rates.reduced().inertia(
            #[inline(always)]
            || angle,
        );
        speed / (speed + self.losses.coefficient(Law::RollingResistance) / inertia)
    }

    /// The normal force under a couple, from g, 1/J, w2' without the couple, and g' w2^2.
    #[inline(always)]
    fn normal(couple: &Couple<T>, tilts: bool, [lever, per_inertia, d2, carried]: [T; 4]) -> T {
        let one = d2.splat(1.0);
        if !tilts {
            return one + lever * d2 - carried;
        }
        let normal = one + lever * couple.free[1].mac(per_inertia, d2) - carried;
        let pressed = normal / (one - lever * couple.pressed[1] * per_inertia);
        d2.splat(0.0).select_lt(normal, pressed, normal)
    }

    /// w1' and w3' under the couple with the components m1 and m3, from their values without the couple.
    #[inline(always)]
    fn add_couple(of: &Coefficients<T>, [d1, d3]: [T; 2], m1: T, m3: T) -> [T; 2] {
        [(of.b * m1 + of.k * m3).mac(of.per_d, d1), (of.k * m1 + of.al * m3).mac(of.per_d, d3)]
    }

    /// The response of the body, from sine and cosine of theta, phi' = w1/s, and w.
    #[inline(always)]
    pub fn at(&self, angle: (T, T), precession: T, w: [T; 3], held: Held<T>) -> Acted<T> {
        self.under(self.losses.pull, angle, precession, w, held)
    }

    /// The accelerations and the contact force as in [`at`](Self::at), with `pull` as the component of gravity along the
    /// table, along e_h and e2.
    #[inline(always)]
    pub fn under(
        &self,
        pull: Option<[T; 2]>,
        angle: (T, T),
        precession: T,
        w: [T; 3],
        held: Held<T>,
    ) -> Acted<T> {
        let ((s, c), [w1, w2, w3], reduced) = (angle, w, self.rates.reduced());
        if matches!(held, Held::Rolling) {
            return self.pivoting_response(pull, angle, precession, w);
        }
        let (shape, of) = (&reduced.shape, reduced.at(angle));
        let (lever, slope, one) = (shape.rim.lever(angle), shape.rim.slope(angle), s.splat(1.0));
        let [mut d1, mut d2, mut d3] = self.rates.at(s, c, w);
        let seen = self.losses.seen(&shape.rim, angle, precession, w);
        let tilts = self.losses.tilts();
        let mut per_inertia = one;
        if tilts || pull.is_some() {
            per_inertia = one
                / reduced.inertia(
                    #[inline(always)]
                    || angle,
                );
        }
        let carried = slope * w2 * w2;
        let pulled = self.couple_of_pull(pull, angle);
        if let Some([m1, m2, m3]) = pulled {
            [d1, d3] = Self::add_couple(&of, [d1, d3], m1, m3);
            d2 = m2.mac(per_inertia, d2);
        }
        let couple = self.losses.total_couple(
            &seen,
            #[inline(always)]
            |couple| Self::normal(couple, tilts, [lever, per_inertia, d2, carried]),
        );
        let normal = Self::normal(&couple, tilts, [lever, per_inertia, d2, carried]);
        // After lift-off no force presses the body on the table, and the laws have no normal force.
        let pressing = normal.positive_part();
        let [mut m1, m2, mut m3] = couple.under(pressing);
        let tilting = if tilts { m2.mac(per_inertia, d2) } else { d2 };
        let [mut r1, mut r3] = Self::add_couple(&of, [d1, d3], m1, m3);
        let mut stays = [s.splat(0.0), one];
        let radius = seen.radius;
        match held {
            Held::Nothing | Held::Rolling => {}
            Held::Contour(rate) => {
                // `off` is s^2 (psi'' - rate) without the couple that holds psi'.
                let off = s * (s * r3 - c * r1 - precession * w2 - s * rate);
                let push = off / (Self::spin_response(&of, angle) * of.per_d);
                (m1, m3) = (m1 + c / s * push, m3 - push);
                [r1, r3] = Self::add_couple(&of, [d1, d3], m1, m3);
                stays = [push, self.losses.coefficient(Law::DryContour) * pressing * radius];
            }
            Held::Drilling => {
                let off = drilling_of((s, c), r1, r3) - w2 * rolling_of((s, c), w1, w3);
                let give = of.b * s * s + (of.k + of.k) * s * c + of.al * c * c;
                let push = -(off / (give * of.per_d));
                (m1, m3) = (m1 + s * push, m3 + c * push);
                [r1, r3] = Self::add_couple(&of, [d1, d3], m1, m3);
                stays = [push, self.losses.coefficient(Law::Drilling) * pressing];
            }
        }
        let (along, across) = match reduced.contact {
            Contact::Smooth => (s.splat(0.0), s.splat(0.0)),
            Contact::Rolling => {
                let [_, speed, _] = rolling::centre_velocity(shape, angle, w);
                let across = shape.rim.height(angle) * tilting + lever * w2 * w2 - precession * speed;
                let m3 = pulled.map_or(m3, |[.., pulled]| m3 + pulled);
                (rolling::force_along(shape, angle, w, [r1, tilting, r3], m3), across)
            }
        };
        let (along, across) = self.without_pull(pull, along, across);
        let power = self.losses.power(&seen, pressing);
        Acted { w: [r1, tilting, r3], force: [normal, along, across], power, held: stays }
    }
}

impl<T: Real, G: OwnCouple<T>> Lossy<T, G> {
    /// The couple about a rolling contact point of `pull`, the horizontal part of gravity on a tilted table; None on a
    /// level table.
    #[inline(always)]
    fn couple_of_pull(&self, pull: Option<[T; 2]>, angle: (T, T)) -> Option<[T; 3]> {
        let Reduced { contact, shape: Shape { rim, .. }, .. } = self.rates.reduced();
        let [along_h, along_2] = pull.filter(|_| *contact == Contact::Rolling)?;
        Some([-(rim.depth(angle) * along_2), rim.height(angle) * along_h, rim.radius(angle) * along_2])
    }

    /// The friction: the horizontal force that accelerates the centre, less `pull`, the part due to the slope.
    #[inline(always)]
    fn without_pull(&self, pull: Option<[T; 2]>, along: T, across: T) -> (T, T) {
        match pull {
            Some(pull) if self.rates.reduced().contact == Contact::Rolling => {
                (along - pull[1], across - pull[0])
            }
            _ => (along, across),
        }
    }

    /// The response of a body that only turns about the vertical, with N = 1, with the couple of rolling resistance
    /// that holds the body and the limit of this couple. The contact point is at rest, so that the centre moves on a
    /// circle.
    #[inline(always)]
    fn pivoting_response(&self, pull: Option<[T; 2]>, angle: (T, T), precession: T, w: [T; 3]) -> Acted<T> {
        let ((s, c), [w1, _, w3], reduced) = (angle, w, self.rates.reduced());
        let (rim, i1, i3) = (&reduced.shape.rim, reduced.shape.i1, reduced.shape.i3);
        let (zero, one) = (s.splat(0.0), s.splat(1.0));
        let seen = self.losses.seen(rim, angle, precession, w);
        let mut couple = self
            .losses
            .total_couple(
                &seen,
                #[inline(always)]
                |_| one,
            )
            .under(one);
        if let Some(pulled) = self.couple_of_pull(pull, angle) {
            (0..3).for_each(|i| couple[i] = couple[i] + pulled[i]);
        }
        let [m1, m2, m3] = couple;
        let far = match reduced.contact {
            Contact::Smooth => zero,
            Contact::Rolling => rim.lever(angle),
        };
        let (inertia, drilling) = (i1 * s * s + i3 * c * c, drilling_of((s, c), w1, w3));
        let turn = (s * m1 + c * m3) / (inertia + far * far);
        let (along, across) = (-(far * turn), far * drilling * drilling);
        let gyration = drilling * drilling * s * c * (i3 - i1);
        let more1 = i1 * s * turn - rim.depth(angle) * along - m1;
        let more3 = i3 * c * turn + rim.radius(angle) * along - m3;
        let more2 = rim.lever(angle) + rim.height(angle) * across - gyration - m2;
        let contour = self.losses.coefficient(Law::DryContour) * rim.radius(angle) / s;
        let needs = rolling_couple_needed([c * more1 - s * more3, more2], contour);
        let held = [needs, self.losses.coefficient(Law::RollingResistance)];
        let power = self.losses.power(&seen, one);
        let (along, across) = self.without_pull(pull, along, across);
        Acted { w: [s * turn, zero, c * turn], force: [one, along, across], power, held }
    }
}

impl Lossy<f64> {
    pub fn of(contact: Contact, body: &Body, losses: &Losses) -> Self {
        Self { rates: contact.rates(body), losses: Couples::of(losses, |x| x) }
    }
}

impl<G: OwnCouple<f64>> Lossy<f64, G> {
    /// These equations for dual numbers, which carry a derivative.
    pub fn sloped(&self) -> Lossy<Dual<f64>, G> {
        let Reduced { contact, shape, round, .. } = self.rates.reduced();
        let rates = Rates::of(*contact, &shape.map(Dual::constant), *round);
        Lossy { rates, losses: self.losses.map(Dual::constant) }
    }

    /// The accelerations and forces in a state in which dry friction holds no part of the motion at rest.
    pub fn in_state(&self, y: &State) -> Acted<f64> {
        let angle = y.theta.sin_cos();
        self.at(angle, y.w1 / angle.0, [y.w1, y.w2, y.w3], Held::Nothing)
    }

    /// The time derivatives of theta and w, and the contact force, in a state in which dry friction holds no part of the motion.
    pub fn moves(&self, y: &State) -> (State, newton::Force) {
        let Acted { w: [w1, w2, w3], force: [normal, along, across], .. } = self.in_state(y);
        (State { theta: -y.w2, w1, w2, w3 }, newton::Force { normal, along, across })
    }

    /// The losses with their user-defined couple, as a linear function of the normal force near its value in this state.
    pub fn linear(&self, y: &State) -> UnderCouple {
        let (angle, w) = (y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
        let seen = self.losses.seen(&self.rates.reduced().shape.rim, angle, w[0] / angle.0, w);
        self.losses.linear(&seen, |_| self.in_state(y).force[0])
    }
}

/// The time derivative of (theta, w1, w2, w3), and the lost power in M g sqrt(g R), of a body that rolls, or slides
/// without friction, with losses. A dry loss exerts no couple where the motion that it resists is at rest.
pub fn derivative(contact: Contact, body: &Body, y: &State, losses: &Losses) -> (State, f64) {
    let Acted { w: [w1, w2, w3], power, .. } = Lossy::of(contact, body, losses).in_state(y);
    (State { theta: -y.w2, w1, w2, w3 }, power)
}

/// The time derivative of (theta, w1, w2, w3), and the contact force, of a body that rolls, or slides without friction,
/// under any couple along e1, e2, e3, in M g R.
///
/// ```
/// use spincyl::{Body, Contact, contact::lossy, newton, steady};
///
/// let body = Body::solid(2.5)?;
/// let (state, couple) = (steady::state(&body, 1.3)?, [0.01, -0.02, 0.03]);
/// let (rate, force) = lossy::under_couple(Contact::Rolling, &body, &state, couple);
/// // These are the accelerations of Newton's and Euler's equations under that force and that couple.
/// let same = newton::derivative(&body, &state, &force, couple);
/// assert!((rate.w1 - same.w1).abs().max((rate.w2 - same.w2).abs()).max((rate.w3 - same.w3).abs()) < 1e-12);
/// # Ok::<(), spincyl::Error>(())
/// ```
pub fn under_couple(contact: Contact, body: &Body, y: &State, couple: [f64; 3]) -> (State, newton::Force) {
    let given = Couple { free: couple, pressed: [0.0; 3] };
    let losses = Couples::of(&Losses::NONE, |x| x).beside(Some(given));
    Lossy { rates: contact.rates(body), losses }.moves(y)
}

/// The contact force, in M g, on a body that rolls, or slides without friction, with losses.
pub fn force(contact: Contact, body: &Body, y: &State, losses: &Losses) -> newton::Force {
    Lossy::of(contact, body, losses).moves(y).1
}
