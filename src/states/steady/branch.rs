//! Turning points along the branch of steady states: folds of the rate and ridges of the energy.
//!
//! ```text
//! sharp, with T = tan theta,  n = 1 - ell T,  m = n + d,  d = I1/I3 - 1,  r = 1 + d
//! folds, d rate/d theta = 0:     n^2 + d (1 + ell T^3) = 0
//! ridge, d energy/d theta = 0:   (r + ell^2)/2 (n^2 + d (1 - 2 ell T - ell T^3)) + n m^2 = 0
//! rounded, with n, m and A of `rounded`:
//! folds:   n^2 a c + d A^2 (a c^3 + ell s^3) = 0;  for ell = 0  a^2 + d A^2 = 0;  a ball has none
//! ridge:   d/dtheta [n (I1 s^2 + I3 (L sigma)^2)/(2 I3 sigma m) + h] = 0,   sigma = s/A
//! ```
//! The equations of the folds and of the ridge follow from Eq. 15 of Jackson et al., Am. J. Phys. 87, 85 (2019) and
//! from the energy E = (I1 + I3 ell^2) w1^2/2 + ell cos theta + sin theta of a body whose centre rests. They depend on
//! the moments only through the ratio I1/I3. A critical body (d = 0 exactly) has rate^2 = 1/sin theta; it has no fold,
//! and its ridge is at n = -(1 + ell^2)/2.
//!
//! Error: 16 ulp times the condition number of the root in (ell, d), also where d is small.

use super::BodyPolynomials;
use super::{MOST, rate};
use crate::laws::body::Body;
use crate::methods::roots::{Coefficient, Cubic, Trig};

/// Largest aspect ratio, whose square is the largest I1/I3: for larger ones the coefficients would overflow.
const LARGEST_ASPECT: f64 = 1e30;

/// The polynomial n = 1 - ell T of T = tan theta, which numerator and denominator of the squared rate share.
pub(crate) fn shared_factor<C: Coefficient>(body: &Body) -> Cubic<C> {
    Cubic::of(1.0) - Cubic::of(body.ell()) * Cubic::tangent()
}

/// Inclinations in (0, pi/2) of the folds, in ascending order, NaN after the last one. At a fold the rate is stationary
/// along the branch, and two steady states with the same rate merge.
///
/// All are NaN for `ell` above 1e30 or I1/I3 above 1e60. The error is 16 ulp times the conditioning.
pub fn folds(body: &Body) -> [f64; MOST] {
    if !body.is_sharp() {
        return rounded_folds(body);
    }
    if body.excess() == 0.0 {
        return [f64::NAN; MOST];
    }
    let (n, d, t) = (shared_factor(body), Cubic::of(body.excess_sum()), Cubic::tangent());
    let ell = Cubic::of(body.ell());
    inclinations_of(body, n * n + d * (Cubic::of(1.0) + ell * t * t * t))
}

/// Inclinations in (0, pi/2), in ascending order, where the energy of the steady state with the centre at rest is
/// stationary along the branch; NaN after the last one.
///
/// All are NaN for `ell` above 1e30 or I1/I3 above 1e60. The error is 16 ulp times the conditioning.
pub fn ridge(body: &Body) -> [f64; MOST] {
    if !body.is_sharp() {
        return rounded_ridge(body);
    }
    let (n, d, t) = (shared_factor(body), Cubic::of(body.excess_sum()), Cubic::tangent());
    let (one, ell) = (Cubic::of(1.0), Cubic::of(body.ell()));
    let half = (one + d + ell * ell) * Cubic::of(0.5);
    let cubic = if body.excess() == 0.0 {
        half + n
    } else {
        half * (n * n + d * (one - ell * t * (Cubic::of(2.0) + t * t))) + n * (n + d) * (n + d)
    };
    inclinations_of(body, cubic)
}

/// The folds of a rounded rim: n^2 a c + d A^2 (a c^3 + ell s^3) = 0. For ell = 0, where the cosine is a factor of n
/// and of m, the equation is c (a^2 + d A^2) = 0. A ball has no fold.
fn rounded_folds(body: &Body) -> [f64; MOST] {
    if body.is_ball() {
        return [f64::NAN; MOST];
    }
    if body.excess() == 0.0 {
        // For d = 0 the squared rate is rate^2 = a/s + rho.
        return with_side(body, Vec::new());
    }
    let BodyPolynomials { s, c, radius, n, .. } = &BodyPolynomials::of(body);
    let (a, ell, d) = (Trig::of(body.rim_sum()), Trig::of(body.ell()), Trig::of(body.excess_sum()));
    let wide = &d * &(radius * radius);
    if body.ell() == 0.0 {
        return with_side(body, (&(&a * &a) + &wide).angles());
    }
    let cubes = &(&a * &(c * &(c * c))) + &(&ell * &(s * &(s * s)));
    in_range(body, &(&(&(n * n) * &(&a * c)) + &(&wide * &cubes)))
}

/// The ridge of a rounded rim: E = p/q + h with p = n (I1 s^2 + I3 (L sigma)^2) and q = 2 I3 sigma m.
fn rounded_ridge(body: &Body) -> [f64; MOST] {
    let BodyPolynomials { s, radius, depth, lever, n, m, sigma: [sigma, over], .. } =
        &BodyPolynomials::of(body);
    let (i1, i3) = (Trig::of(body.i1()), Trig::of(body.i3()));
    let (mut p, q) = if body.is_ball() {
        let turning = &(&i1 * &(&(s * s) * &(over * over))) + &(&i3 * &(&(depth * depth) * &(sigma * sigma)));
        (n * &turning, &(&Trig::of(2.0) * &i3) * &(m * over))
    } else {
        let turning = &(&i1 * &(radius * radius)) + &(&i3 * &(depth * depth));
        (&(n * s) * &turning, &(&Trig::of(2.0) * &i3) * &(m * radius))
    };
    p = &(&p.slope() * &q) - &(&p * &q.slope());
    let found = (&p - &(lever * &(&q * &q))).angles();
    if body.ell() == 0.0 { with_side(body, found) } else { keep_steady(body, found) }
}

/// Adds pi/2 to the inclinations `found` if the body can be inclined beyond pi/2 and has a steady state at pi/2: where
/// ell = 0 or d = 0 the rate is an even function about pi/2, and so is stationary there.
fn with_side(body: &Body, mut found: Vec<f64>) -> [f64; MOST] {
    const SIDE: f64 = core::f64::consts::FRAC_PI_2;
    if body.range() > SIDE {
        // `Trig` does not return a zero at pi/2; zeros that rounding has moved off pi/2 are replaced by pi/2.
        found.retain(|x| (x - SIDE).abs() > 1e-12);
        found.push(SIDE);
        found.sort_by(f64::total_cmp);
    }
    keep_steady(body, found)
}

/// The inclinations at which steady states with the centre at rest begin or cease to exist.
pub(crate) fn edges(body: &Body) -> Vec<f64> {
    let mut edges =
        vec![0.0, body.range(), core::f64::consts::FRAC_PI_2, body.theta_balance(), body.theta_limit()];
    if !body.is_sharp() {
        let BodyPolynomials { n, m, .. } = BodyPolynomials::of(body);
        edges.extend(n.angles().into_iter().chain(m.angles()));
    }
    edges.retain(|x| !x.is_nan());
    edges
}

/// The inclinations within the range of a body where a polynomial vanishes and a steady state with the centre at rest
/// exists, in ascending order, NaN after the last one.
pub(crate) fn in_range(body: &Body, of: &Trig) -> [f64; MOST] {
    keep_steady(body, of.angles())
}

/// The inclinations of `found` that lie within the range of a body and have a steady state, NaN after the last one.
fn keep_steady(body: &Body, found: Vec<f64>) -> [f64; MOST] {
    let mut theta = [f64::NAN; MOST];
    let inside = found.into_iter().filter(|x| *x < body.range()).filter_map(|x| allowed(body, x));
    for (slot, x) in theta.iter_mut().zip(inside) {
        *slot = x;
    }
    theta
}

/// The inclinations in (0, pi/2) where a cubic in tan theta vanishes and a steady state with the centre at rest exists,
/// in ascending order, NaN after the last one.
pub(crate) fn inclinations_of(body: &Body, cubic: Cubic) -> [f64; MOST] {
    let mut theta = [f64::NAN; MOST];
    if body.ell() > LARGEST_ASPECT || body.ratio() > LARGEST_ASPECT * LARGEST_ASPECT {
        return theta;
    }
    for (slot, x) in theta.iter_mut().zip(cubic.angles().filter_map(|x| allowed(body, x))) {
        *slot = x;
    }
    theta
}

/// Returns `theta`, or the nearest of its neighbours among the doubles at which a steady state exists, or None: at the
/// limit of the forbidden band the double nearest to a root may lie on the wrong side.
pub(crate) fn allowed(body: &Body, theta: f64) -> Option<f64> {
    let (below, above) = (theta.next_down(), theta.next_up());
    let near = [theta, below, above, below.next_down(), above.next_up()];
    near.into_iter().find(|x| *x <= body.range() && !rate(body, *x).is_nan())
}
