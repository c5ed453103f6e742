//! Turning points along the branch of steady states: folds of the rate and ridges of the energy.
//!
//! ```text
//! folds, d rate/d theta = 0:    ell d T^3 + ell^2 T^2 - 2 ell T + a = 0,       T = tan theta,  a = I1/I3,  d = a - 1
//! ridge, d energy/d theta = 0:  (a + ell^2)/2 (a - 2 a ell T + ell^2 T^2 - ell d T^3) + (1 - ell T)(a - ell T)^2 = 0
//! ```
//! Both follow from Eq. 15 of Jackson et al., Am. J. Phys. 87, 85 (2019) and from the energy
//! E = (I1 + I3 ell^2) w1^2/2 + ell cos theta + sin theta of a body whose centre rests. The axial
//! moment drops out. The ridge separates the states that a little dissipation lets fall to one
//! side from those that fall to the other.
//!
//! Error: 16 ulp times the conditioning of the root; at a double root, half the digits.

use super::{HALF_PI, rate};
use crate::body::Body;
use crate::real::Sum;
use crate::roots;

/// Beyond this aspect ratio (and its square for I1/I3) the coefficients would overflow.
const TALLEST: f64 = 1e30;

/// A polynomial in T = tan theta, lowest power first.
pub(crate) type Cubic = [f64; 4];

/// Inclinations in (0, pi/2) where the rate turns along the branch, ascending, NaN after the last:
/// there two steady states of one rate meet and vanish. All NaN for `ell` above 1e30.
pub fn folds(body: &Body) -> [f64; 3] {
    let (ell, d) = (body.ell(), body.excess());
    ascending_inclinations(body, &[1.0 + d, -2.0 * ell, ell * ell, ell * d])
}

/// Inclinations in (0, pi/2) where the energy of the steady state with the centre at rest is
/// stationary along the branch, ascending, NaN after the last. All NaN for `ell` above 1e30.
pub fn ridge(body: &Body) -> [f64; 3] {
    let (ell, d) = (body.ell(), body.excess());
    let a = 1.0 + d;
    let half = 0.5 * (a + ell * ell);
    let square = product(&[a, -ell], &[a, -ell]);
    let fall = product(&[1.0, -ell], &square[..3]);
    let rise = [a, -2.0 * a * ell, ell * ell, -ell * d];
    ascending_inclinations(body, &core::array::from_fn(|k| half.mul_add(rise[k], fall[k])))
}

/// The product of two polynomials whose degrees add up to three at most.
pub(crate) fn product(p: &[f64], q: &[f64]) -> Cubic {
    let mut out = [0.0; 4];
    for (i, a) in p.iter().enumerate() {
        for (j, b) in q.iter().enumerate() {
            out[i + j] = a.mul_add(*b, out[i + j]);
        }
    }
    out
}

/// The inclinations in (0, pi/2) where a cubic in tan theta vanishes and a steady state with the
/// centre at rest exists, ascending, NaN after the last.
pub(crate) fn ascending_inclinations(body: &Body, cubic: &Cubic) -> [f64; 3] {
    let mut theta = [f64::NAN; 3];
    if body.ell() > TALLEST || body.ratio() > TALLEST * TALLEST {
        return theta;
    }
    let lift = |c: &f64| Sum { hi: *c, lo: 0.0 };
    let mut flat = cubic.map(|c| lift(&c));
    let low = roots::in_unit_interval(&flat);
    let at_one: f64 = cubic.iter().sum();
    flat.reverse();
    let high = roots::in_unit_interval(&flat);
    let found = low.as_slice().iter().map(|t| t.hi.atan());
    let found = found.chain((at_one == 0.0).then_some(core::f64::consts::FRAC_PI_4));
    let found = found.chain(high.as_slice().iter().rev().map(|t| 1f64.atan2(t.hi)));
    let found = found.filter_map(|x| allowed(body, x));
    for (slot, x) in theta.iter_mut().zip(found) {
        *slot = x;
    }
    theta
}

/// `theta`, or the nearest of its neighbours among the doubles where a steady state exists: at the
/// very edge of the forbidden band the nearest double to a root may lie on the wrong side.
pub(crate) fn allowed(body: &Body, theta: f64) -> Option<f64> {
    let (below, above) = (theta.next_down(), theta.next_up());
    let near = [theta, below, above, below.next_down(), above.next_up()];
    near.into_iter().find(|x| *x <= HALF_PI && !rate(body, *x).is_nan())
}
