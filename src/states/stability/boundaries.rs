//! Inclinations where the stability of the steady state with the centre at rest changes: the boundaries on the map.
//!
//! ```text
//! smooth:   n Y = I1 I3 s m A g',   Y = I1^2 A^2 + (2 c I1 A - I3 L s)(c I1 A - I3 L s)
//! rolling:  n X = I3 s m D A g',    X = D A (A I1 - 2 I1 c U/D) + I3 (U L s + V A^2 s) + h A Z
//!           U = D A u,   V = D v,   Z = D A z      u, v, z of `at_rest`
//! ```
//! The formulas are the numerators of kappa as polynomials in sine and cosine of theta, with sigma = s/A (1/rho of a
//! ball) multiplied out.

use crate::laws::body::Body;
use crate::laws::contact::Contact;
use crate::methods::roots::{Cubic, Trig};
use crate::states::steady::{self, MOST, Shares};

/// Inclinations in (0, pi/2) where the stability of the state with the centre at rest changes,
/// ascending, NaN after the last: the boundary curves of the map.
///
/// All are NaN for `ell` above 1e30 or I1/I3 above 1e60. The error is 16 ulp times the conditioning.
pub fn boundaries(body: &Body, contact: Contact) -> [f64; MOST] {
    if !body.is_sharp() {
        return rounded(body, contact);
    }
    let d_sharp = body.i1() * body.i3() + body.i1() + body.i3() * body.ell() * body.ell();
    // kappa times its denominators is divided by cos^3 and written in T = tan theta, where 1/cos^2 = 1 + T^2.
    let (one, t, ell, i3) = (Cubic::of(1.0), Cubic::T, Cubic::of(body.ell()), Cubic::of(body.i3()));
    let (n, d) = (steady::shared(body), Cubic::of(body.excess_sum()));
    let (m, a, weight) = (n + d, one + d, t * (ell + t));
    let critical = body.excess() == 0.0;
    let cubic = match contact {
        // For a critical body m = n: both cubics have this factor, which cancels in kappa and is divided out.
        Contact::Smooth if critical => n * (n + Cubic::of(2.0)),
        Contact::Smooth => n * (m * m + a * m + a * a * (one + t * t)) - a * m * weight,
        Contact::Rolling => {
            let (i1, drag) = (Cubic::of(body.i1()), Cubic::of(body.i3() * body.i3() * body.ell() / d_sharp));
            let lift = (body.i1() + body.i3() * body.ell() * body.ell()) / d_sharp;
            let turn = (i1 * Cubic::of(2.0) + ell * ell + ell * (one - i3) * t) * (one - drag * t);
            let x = i1 * (one + t * t) + turn + Cubic::of(lift) * t * (ell + (i3 + one) * t);
            if critical { x - i3 * weight } else { n * x - i3 * m * weight }
        }
    };
    steady::inclinations_of(body, cubic)
}

/// The boundaries of a rounded rim, up to the end of the body's range.
fn rounded(body: &Body, contact: Contact) -> [f64; MOST] {
    let Shares { s, c, radius, depth, height, slope, n, m, sigma: [sigma, over], .. } = &Shares::of(body);
    let (i1, i3, rho) = (&Trig::of(body.i1()), &Trig::of(body.i3()), &Trig::of(body.fillet()));
    let one = Trig::of(1.0);
    // For a critical body n = m, so that both are divided out.
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
