//! The inclinations that have a given rate.
//!
//! ```text
//! sharp:    t^4 + 2 (ell - r W) t^3 - 4 ell W t^2 + 2 (ell + r W) t - 1 = 0,   t = tan(theta/2),   W = rate^2,   r = I1/I3
//! rounded:  a^2 t^6 + (2 a ell - 2 k) t^5 + (a^2 + q - p) t^4 + 4 a ell t^3 + (q + p - a^2) t^2 + (2 a ell + 2 k) t - a^2 = 0
//!           k = a (r W - rho),   p = 4 rho W d,   q = 4 ell (rho - W)
//! ell = 0:  d rho W s^2 + a (r W - rho) s - a^2 = 0,   s = sin theta, or in 1 - s, which has more digits near the side
//! d = 0:    theta0, and sin theta = a/(W - rho)
//! ball:     cos theta = ell (W - rho)/(d rho W)
//! ```
//! The equations are Eq. 15 of Jackson et al., Am. J. Phys. 87, 85 (2019), without its denominators. A sharp
//! rim has up to three roots in (0, 1), a rounded rim up to five in (0, infinity). The coefficients are
//! formed and evaluated in 104 bits, so that even rates that differ from that of a fold by 1e-30 have the
//! right number of roots.
//!
//! Residual: |rate(theta) - rate| <= 8 (1 + kappa_c) ulp of the rate. The rate itself has an error of
//! 2 (1 + kappa_c) ulp; theta, within 3 ulp of the exact root, adds 3 kappa_c. Where kappa_c exceeds 2^45, no double
//! theta has the rate to a digit, and theta is on the side where steady states exist. Tests of `laws` check it.

use super::branch::allowed;
use super::{MOST, turning};
use crate::laws::body::Body;
use crate::laws::state::State;
use crate::methods::roots;
use crate::numbers::{Real, Sum};
use core::f64::consts::{FRAC_PI_2, PI};

/// Largest (I1/I3) rate^2 and ell rate^2 for which no coefficient overflows.
const LARGEST: f64 = 1e300;

/// The inclinations in (0, pi/2) of all steady states with the centre at rest that have the reduced rate `rate` >= 0:
/// ascending, NaN after the last. The state on the side (pi/2) is not counted, although every body has it at `rate =
/// 1`. Where [`theta_end`](Body::theta_end) of a rounded rim is beyond pi/2, all inclinations up to `theta_end` are
/// counted, pi/2 included.
///
/// All are NaN where [`count`] is `None`. The rate at each inclination is within 8 (1 + kappa_c) ulp (2^-53) of `rate`,
/// and within 8 ulp at a fold, where kappa_c = |dlog rate/dlog theta| vanishes. Where kappa_c exceeds 2^45, theta
/// itself is within 3 ulp.
pub fn inclinations(body: &Body, rate: f64) -> [f64; MOST] {
    solve(body, rate).unwrap_or([f64::NAN; MOST])
}

/// Number of inclinations with this rate, 0 to 5; `None` if `rate` is negative or not finite, if `(I1/I3) rate^2` or
/// `ell rate^2` exceeds 1e300, or if every inclination has this rate, as for a ball with I1 = I3 at rate 1.
pub fn count(body: &Body, rate: f64) -> Option<usize> {
    Some(solve(body, rate)?.iter().filter(|theta| !theta.is_nan()).count())
}

/// The steady states with the centre at rest that have the reduced rate `rate`, in the order of [`inclinations`]; NaN
/// after the last.
///
/// Near thetaInf, and at the critical shape, the rate determines the state better than a double theta does: w1 and w3
/// are computed from the rate, with a relative error below 8 ulp.
pub fn states(body: &Body, rate: f64) -> [State; MOST] {
    inclinations(body, rate).map(|theta| turning(body, theta, rate))
}

fn solve(body: &Body, speed: f64) -> Option<[f64; MOST]> {
    if !(speed >= 0.0 && body.ratio().max(body.ell().abs()) * speed * speed <= LARGEST) {
        return None;
    }
    if !body.is_sharp() {
        return rounded_inclinations(body, speed);
    }
    let (quartic, below_one) = quartic(body, speed);
    let mut theta = [f64::NAN; MOST];
    let found = roots::in_unit_interval_with_end(&quartic, below_one);
    let inside = found.as_slice().iter().map(|t| 2.0 * t.atan()).filter(|x| *x <= body.range());
    for (theta, nearest) in theta.iter_mut().zip(inside) {
        *theta = allowed(body, nearest).unwrap_or(nearest);
    }
    Some(theta)
}

/// The inclinations of a body with a rounded rim that have a rate with the square `speed`; None where [`count`] is None.
fn rounded_inclinations(body: &Body, speed: f64) -> Option<[f64; MOST]> {
    let (a, rho, ell, d) =
        (body.rim_sum(), Sum::from(body.fillet()), Sum::from(body.ell()), body.excess_sum());
    let w = Sum::product(speed, speed);
    let bend = d * rho * w;
    let k = a * (w + d * w - rho);
    let square = a * a;
    // `far` says whether theta can exceed pi/2; only then the state at pi/2 is counted.
    let (far, unit) = (body.range() > FRAC_PI_2, a + rho);
    let found = if body.is_ball() {
        if d.hi == 0.0 {
            // Every inclination has this rate, or none has.
            let every = (w - rho).hi == 0.0 || body.ell() == 0.0;
            return if every { None } else { Some([f64::NAN; MOST]) };
        }
        let cosine = ell * (w - rho) / bend;
        if !far && cosine.hi <= 0.0 {
            return Some([f64::NAN; MOST]);
        }
        let sine = ((Sum::from(1.0) - cosine) * (Sum::from(1.0) + cosine)).sqrt();
        vec![sine.hi.atan2(cosine.hi)]
    } else if d.hi == 0.0 && body.ell() > 0.0 {
        // The equation has the factor n: it holds at theta0 for every rate, and at sin theta = a/(W - rho).
        let over = w - unit;
        let mut found = vec![body.theta_balance()];
        if over.hi >= 0.0 {
            let cosine = (over * (over + a.times(2.0))).sqrt().hi;
            let near = a.hi.atan2(cosine);
            if over.hi > 0.0 || far {
                found.push(near);
            }
            if over.hi > 0.0 && far {
                found.push(PI - near);
            }
            found.sort_by(f64::total_cmp);
        }
        found
    } else if body.ell() == 0.0 {
        let at_side = bend + k - square;
        let falls = roots::in_unit_interval(&[at_side, -(bend.times(2.0) + k), bend]);
        let (high, low): (Vec<f64>, Vec<f64>) = falls.as_slice().iter().partition(|fall| **fall < 0.5);
        let sines = roots::in_unit_interval(&[-square, k, bend]);
        let mut near: Vec<f64> = sines.as_slice().iter().take(low.len()).map(|s| s.asin()).collect();
        near.extend(high.iter().rev().map(|v| (1.0 - v).atan2((v * (2.0 - v)).sqrt())));
        if at_side.hi == 0.0 && far {
            near.push(FRAC_PI_2);
        }
        let steep = near.iter().rev().filter(|theta| **theta < FRAC_PI_2);
        near.iter().copied().chain(steep.map(|theta| PI - theta)).collect()
    } else {
        let (reach, p, q) = (a * ell, bend.times(4.0), (ell * (rho - w)).times(4.0));
        let mut sextic = [
            -square,
            (reach + k).times(2.0),
            q + p - square,
            reach.times(4.0),
            square + q - p,
            (reach - k).times(2.0),
            square,
        ];
        // At t = 1 the sum is 8 ell (a + rho - W); where it is 0, the slope is -8 d (a + rho)^2; where d is 0, the curvature
        // has the sign of ell.
        let sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
        let way_up = body.ell().signum();
        let at_one = way_up * sign((unit - w).hi);
        let side = |way: f64| {
            if at_one != 0.0 {
                at_one
            } else if d.hi != 0.0 {
                way * d.hi.signum()
            } else {
                way_up
            }
        };
        let low = roots::in_unit_interval_with_end(&sextic, side(1.0));
        sextic.reverse();
        let high = roots::in_unit_interval_with_end(&sextic, side(-1.0));
        let near = low.as_slice().iter().map(|t| 2.0 * t.atan());
        let side = (at_one == 0.0).then_some(FRAC_PI_2);
        let beyond = side.into_iter().chain(high.as_slice().iter().rev().map(|t| PI - 2.0 * t.atan()));
        near.chain(beyond.filter(|_| far)).collect()
    };
    let mut theta = [f64::NAN; MOST];
    // A root next to pi/2 may be rounded to pi/2.
    let inside = found.into_iter().filter(|x| *x > 0.0 && *x <= body.range());
    for (theta, nearest) in theta.iter_mut().zip(inside) {
        *theta = allowed(body, nearest).unwrap_or(nearest);
    }
    Some(theta)
}

/// The coefficients of the quartic, lowest power first, and its sign just below t = 1. At t = 1 the sum of the
/// coefficients is 4 ell (1 - W); where that vanishes, the slope is 4 (1 - r W) - 8 ell (W - 1).
fn quartic(body: &Body, speed: f64) -> ([Sum<f64>; 5], f64) {
    let number = Sum::from;
    let ell = body.ell();
    let w = Sum::product(speed, speed);
    let d = body.excess_sum();
    let rw = w.plus(d.times(w.hi).plus(d.times(w.lo)));
    let coefficients = [
        number(-1.0),
        number(ell).plus(rw).times(2.0),
        w.times(ell).times(-4.0),
        number(ell).plus(rw.times(-1.0)).times(2.0),
        number(1.0),
    ];
    let below_one = if ell != 0.0 && speed != 1.0 {
        ell.signum() * (1.0 - speed)
    } else if ell != 0.0 {
        // For W = 1, r W = 1 + d; for d = 0 the curvature 4 ell decides.
        if d.hi == 0.0 { ell } else { d.hi }
    } else {
        // For r W = 1 the quartic is (t + 1) (t - 1)^3.
        let slope = number(1.0).plus(rw.times(-1.0)).hi;
        if slope == 0.0 { -1.0 } else { -slope }
    };
    (coefficients, below_one.signum())
}
