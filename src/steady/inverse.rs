//! Every inclination of a given rate.
//!
//! ```text
//! t^4 + 2 (ell - a W) t^3 - 4 ell W t^2 + 2 (ell + a W) t - 1 = 0,   t = tan(theta/2),   W = rate^2,   a = I1/I3
//! ```
//! Eq. 15 of Jackson et al., Am. J. Phys. 87, 85 (2019), without its denominators. Up to three
//! roots in (0, 1). Coefficients are formed and evaluated in 104 bits, so two roots that part at a
//! fold are told from none down to 1e-30 of the rate.
//!
//! Residual: |rate(theta) - rate| <= 8 (1 + kappa_c) ulp of the rate; where kappa_c exceeds 2^45, so
//! that no double theta has the rate to a digit, theta is within 3 ulp of the exact root and on the
//! side where steady states exist. A test runs it.

use super::branch::allowed;
use crate::body::Body;
use crate::roots;
use crate::state::State;
use crate::sum::Sum;

/// Largest a rate^2 and ell rate^2, so that no coefficient overflows.
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
/// `(I1/I3) rate^2` or `ell rate^2` exceeds 1e300.
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
    if !(speed >= 0.0 && body.ratio().max(body.ell()) * speed * speed <= LARGEST) {
        return None;
    }
    let (quartic, below_one) = quartic(body, speed);
    let mut theta = [f64::NAN; 3];
    for (theta, t) in theta.iter_mut().zip(roots::in_unit_interval_with_end(&quartic, below_one).as_slice()) {
        let nearest = 2.0 * t.atan();
        *theta = allowed(body, nearest).unwrap_or(nearest);
    }
    Some(theta)
}

/// The coefficients, lowest power first, and the sign just below t = 1, where the sum of the
/// coefficients is 4 ell (1 - W) and the slope, if that vanishes, 4 (1 - a W) - 8 ell (W - 1).
fn quartic(body: &Body, speed: f64) -> ([Sum<f64>; 5], f64) {
    let number = Sum::from;
    let ell = body.ell();
    let w = Sum::product(speed, speed);
    let d = body.excess_sum();
    let aw = w.plus(d.times(w.hi).plus(d.times(w.lo)));
    let coefficients = [
        number(-1.0),
        number(ell).plus(aw).times(2.0),
        w.times(ell).times(-4.0),
        number(ell).plus(aw.times(-1.0)).times(2.0),
        number(1.0),
    ];
    let below_one = if ell > 0.0 && speed != 1.0 {
        1.0 - speed
    } else if ell > 0.0 {
        // a W = 1 + d; for d = 0 the curvature 4 ell decides
        if d.hi == 0.0 { 1.0 } else { d.hi }
    } else {
        // for a W = 1, (t + 1) (t - 1)^3
        let slope = number(1.0).plus(aw.times(-1.0)).hi;
        if slope == 0.0 { -1.0 } else { -slope }
    };
    (coefficients, below_one.signum())
}
