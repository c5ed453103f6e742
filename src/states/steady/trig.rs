//! The quantities of a rounded rim as polynomials in sine and cosine, from which folds, ridges and boundaries follow.
//!
//! ```text
//! a > 0:     n = a c - ell s,   m = n + d A c,   A = a + rho s,   sigma = s/A
//! ell = 0:   n = a,             m = a + d A                        the cosine that they share divided out
//! a = 0:     n = -ell,          m = d rho c - ell,   A = rho, and 1 for s in sigma: the sine divided out
//! ```

use crate::laws::body::Body;
use crate::methods::roots::Trig;
use crate::numbers::Sum;

/// The quantities of a body as polynomials in sine and cosine of theta; see the top of this file.
pub(crate) struct BodyPolynomials {
    pub s: Trig,
    pub c: Trig,
    pub radius: Trig,
    pub depth: Trig,
    pub height: Trig,
    pub slope: Trig,
    pub lever: Trig,
    pub n: Trig,
    pub m: Trig,
    /// Numerator and denominator of sigma = s/A.
    pub sigma: [Trig; 2],
}

impl BodyPolynomials {
    pub fn of(body: &Body) -> Self {
        let number = |x: f64| Trig::of(Sum::from(x));
        let (s, c) = (Trig::sin(), Trig::cos());
        let (a, rho, ell) = (Trig::of(body.rim_sum()), number(body.fillet()), number(body.ell()));
        let d = Trig::of(body.excess_sum());
        let radius = &a + &(&rho * &s);
        let depth = &ell + &(&rho * &c);
        let lever = &(&ell * &s) - &(&a * &c);
        let slope = &(&ell * &c) + &(&a * &s);
        let (n, m) = if body.is_ball() {
            (number(-body.ell()), &(&(&d * &rho) * &c) - &ell)
        } else if body.ell() == 0.0 {
            (a.clone(), &a + &(&d * &radius))
        } else {
            let n = &number(0.0) - &lever;
            let m = &n + &(&(&d * &radius) * &c);
            (n, m)
        };
        let sigma = if body.is_ball() { [number(1.0), rho.clone()] } else { [s.clone(), radius.clone()] };
        Self { height: &slope + &rho, s, c, radius, depth, slope, lever, n, m, sigma }
    }
}
