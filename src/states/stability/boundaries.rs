//! Inclinations where the stability of the steady state with the centre at rest changes: the boundaries on the map.
//!
//! ```text
//! smooth:   n Y = I1 I3 s m A g',   Y = I1^2 A^2 + (2 c I1 A - I3 L s)(c I1 A - I3 L s)
//! rolling:  n X = I3 s m D A g',    X = D A (A I1 - 2 I1 c U/D) + I3 (U L s + V A^2 s) + h A Z
//!           U = D A u,   V = D v,   Z = D A z      u, v, z of `at_rest`
//! ```
//! The formulas are the numerators of kappa as polynomials in sine and cosine of theta, with sigma = s/A
//! (1/rho of a ball) multiplied out.

use crate::laws::body::Body;
use crate::laws::contact::Contact;
use crate::methods::roots::{Coefficient, Cubic, Trig};
use crate::states::steady::{self, BodyPolynomials, MOST};

/// Inclinations in (0, pi/2) where the stability of the state with the centre at rest changes,
/// ascending, NaN after the last: the boundary curves of the map.
///
/// All are NaN for `ell` above 1e30 or I1/I3 above 1e60. The error is 16 ulp times the conditioning.
pub fn boundaries(body: &Body, contact: Contact) -> [f64; MOST] {
    if !body.is_sharp() {
        return rounded_boundaries(body, contact);
    }
    // For a critical body m = n: both cubics contain the factor n, which cancels in kappa.
    let divided = body.excess() == 0.0;
    steady::inclinations_of(body, cubic(body, contact, divided))
}

/// A cubic in T = tan theta that has the sign of kappa m, for a sharp rim: kappa times its denominators over cos^3,
/// where 1/cos^2 = 1 + T^2. With `divided` the factor n of a critical body is left out.
pub(super) fn cubic<C: Coefficient>(body: &Body, contact: Contact, divided: bool) -> Cubic<C> {
    let (i1, i3, ell) = (body.i1(), body.i3(), body.ell());
    let d_sharp = i1 * i3 + i1 + i3 * ell * ell;
    let (drag, lift) = (Cubic::of(i3 * i3 * ell / d_sharp), Cubic::of((i1 + i3 * ell * ell) / d_sharp));
    let (one, two, t) = (Cubic::of(1.0), Cubic::of(2.0), Cubic::tangent());
    let (i1, i3, ell) = (Cubic::of(i1), Cubic::of(i3), Cubic::of(ell));
    let (n, d) = (steady::shared_factor(body), Cubic::of(body.excess_sum()));
    let (m, a, weight) = (n + d, one + d, t * (ell + t));
    match contact {
        Contact::Smooth if divided => n * (n + two),
        Contact::Smooth => n * (m * m + a * m + a * a * (one + t * t)) - a * m * weight,
        Contact::Rolling => {
            let turn = (i1 * two + ell * ell + ell * (one - i3) * t) * (one - drag * t);
            let x = i1 * (one + t * t) + turn + lift * t * (ell + (i3 + one) * t);
            if divided { x - i3 * weight } else { n * x - i3 * m * weight }
        }
    }
}

/// The boundaries of a body with a rounded rim, at inclinations below theta_end.
fn rounded_boundaries(body: &Body, contact: Contact) -> [f64; MOST] {
    let BodyPolynomials { s, c, radius, depth, height, slope, n, m, sigma: [sigma, over], .. } =
        &BodyPolynomials::of(body);
    let (i1, i3, rho) = (&Trig::of(body.i1()), &Trig::of(body.i3()), &Trig::of(body.fillet()));
    let one = Trig::of(1.0);
    // For a critical body n = m, and both factors cancel in kappa.
    let (n, m) = if body.excess() == 0.0 { (&one, &one) } else { (n, m) };
    let two = &Trig::of(2.0);
    // `spin` is I3 w3 and `lean` is I1 w1 cot theta, over Omega and times the denominator of sigma.
    let (spin, lean) = (&(&(i3 * depth) * sigma), &(&(i1 * c) * over));
    let weight = &(&(&(i3 * sigma) * over) * m) * slope;
    let kappa = match contact {
        Contact::Smooth => {
            let both = &(&(two * lean) - spin) * &(lean - spin);
            &(n * &(&(&(i1 * over) * &(i1 * over)) + &both)) - &(i1 * &weight)
        }
        Contact::Rolling => {
            let hub = &(rho * c);
            let d = &(&(i1 * i3) + &(&(i1 * &(radius * radius)) + &(i3 * &(depth * depth))));
            let a = &Trig::of(body.rim_sum());
            let spread = i3 + &(rho * &(&(s * radius) + &(c * depth)));
            let u = &(&(spin * &spread) - &(&(c * over) * d));
            let turn = &(depth * &(&(i3 * depth) - &(i1 * hub)));
            let v = &(s * &(&(&(i1 * a) * radius) + turn));
            let z = &(rho * &(&(&(c * depth) * sigma) + &(&(s * s) * over))) * d;
            let z = &(&z + &(&(radius * v) * over)) - &(depth * u);
            let squares = &(over * over);
            let first = &(&(i1 * d) * squares) - &(&(two * lean) * u);
            let second = &(spin * u) + &(&(&(i3 * s) * v) * squares);
            let x = &(&first + &second) + &(&(height * &z) * over);
            &(n * &x) - &(&weight * d)
        }
    };
    steady::in_range(body, &kappa)
}
