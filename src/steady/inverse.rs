//! Every inclination of a given rate.
//!
//! ```text
//! t^4 + 2 (ell - a W) t^3 - 4 ell W t^2 + 2 (ell + a W) t - 1 = 0,   t = tan(theta/2),   W = rate^2,   a = I1/I3
//! ```
//! Eq. 15 of Jackson et al., Am. J. Phys. 87, 85 (2019), without its denominators. Up to three
//! roots in (0, 1). Coefficients are formed and evaluated in 104 bits, so two roots that part at a
//! fold are told from none down to 1e-30 of the rate.
//!
//! Residual: |rate(theta) - rate| <= 8 (1 + kappa_c) ulp of the rate. A test runs it.

use super::{branch::allowed, rate};
use crate::body::Body;
use crate::real::Sum;
use crate::roots;
use crate::state::State;

/// Largest a rate^2, so that no coefficient overflows.
const LARGEST: f64 = 1e300;

/// Every steady inclination in (0, pi/2) of the reduced rotation rate `rate` >= 0, with the centre
/// at rest: ascending, NaN after the last. Lying on the side (pi/2) is no answer, although every
/// body does so at `rate = 1`.
///
/// All NaN where the question makes no sense (see [`count`]).
pub fn inclinations(body: &Body, rate: f64) -> [f64; 3] {
    solve(body, rate).unwrap_or([f64::NAN; 3])
}

/// How many inclinations have this rate, 0 to 3; `None` if `rate` is negative or not finite, or
/// `(I1/I3) rate^2` exceeds 1e300.
pub fn count(body: &Body, rate: f64) -> Option<usize> {
    Some(solve(body, rate)?.iter().filter(|theta| !theta.is_nan()).count())
}

/// The steady states with the centre at rest that turn at the reduced rate `rate`, in the order of
/// [`inclinations`]; NaN after the last.
///
/// Near thetaInf, and at the critical shape, a rate says more about the state than a double theta
/// can: w1 and w3 come from the rate, with a relative error below 8 ulp.
pub fn states(body: &Body, rate: f64) -> [State; 3] {
    inclinations(body, rate).map(|theta| {
        let w1 = rate / body.i3().sqrt() * theta.sin();
        State { theta, w1, w2: 0.0 * theta, w3: body.ell() * w1 }
    })
}

fn solve(body: &Body, speed: f64) -> Option<[f64; 3]> {
    if !(speed >= 0.0 && body.ratio() * speed * speed <= LARGEST) {
        return None;
    }
    let quartic = quartic(body, speed);
    let mut theta = [f64::NAN; 3];
    for (theta, t) in theta.iter_mut().zip(roots::in_unit_interval(&quartic).as_slice()) {
        let nearest = 2.0 * t.hi.atan() + 2.0 * t.lo / (1.0 + t.hi * t.hi);
        *theta = allowed(body, nearest, |theta| rate(body, theta)).unwrap_or(nearest);
    }
    Some(theta)
}

fn quartic(body: &Body, speed: f64) -> [Sum<f64>; 5] {
    let one = Sum { hi: 1.0, lo: 0.0 };
    let minus_one = Sum { hi: -1.0, lo: 0.0 };
    let ell = Sum { hi: body.ell(), lo: 0.0 };
    let w = Sum::product(speed, speed);
    let d = body.excess_sum();
    let dw = d.times(w.hi).plus(d.times(w.lo));
    let aw = w.plus(dw);
    [
        minus_one,
        ell.plus(aw).times(2.0),
        w.times(body.ell()).times(-4.0),
        ell.plus(aw.times(-1.0)).times(2.0),
        one,
    ]
}
