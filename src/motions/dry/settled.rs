//! A settled contact: psi' follows a balance of couples, since a couple that grows with a power of psi' stops the
//! contact point faster and faster while the face falls.
//!
//! ```text
//! psi'   balances the couple along the contour with the couple that turns the contact, psi'' included
//! k psi'^(3/2) + slope psi' = push,   slope = c A^2 + film,   film = (pi/4) viscosity/s
//! psi'' = -(c w2/s) (push + film psi')/(slope + (3/2) k psi'^(1/2))
//! ```
//! Where the contact stops thousands of times faster than the face falls, psi' follows that balance (Tikhonov
//! 1952), and the motion is no longer stiff. Rolling and slipping bodies share this code.
//!
//! Error: after three sweeps the square of the ratio of the two rates, that of the fall over
//! that of the stop.

use crate::laws::loss::{Couples, Law};
use core::f64::consts::FRAC_PI_4;

/// Number of sweeps: times that psi'' is corrected from the balance before.
const SWEEPS: u32 = 3;
/// The contact of a falling face settles only where sin(theta) is below this, and sin(theta) psi' below `SLOWER`
/// times the speed of fall.
pub(crate) const CLOSE: f64 = 0.01;
pub(crate) const SLOWER: f64 = 0.01;
/// A contact near the table settles only if its contact point stops at least this many times faster than the face
/// falls; above another sine of theta the ratio has to be larger. With a smaller ratio the balance would be less
/// accurate.
const FASTER: f64 = 4e3;
const NEARBY: f64 = 1e-4;

/// Safety factor in the upper bound of the delay with which a contact point stops.
const LATER: f64 = 1.5;

/// Cost of an integration step with a settled contact, in ordinary steps.
pub(crate) const EFFORT: u64 = 30;

/// Least ratio of the rates of stop and fall for a contact whose balance has an error below the share `SMALL` of the
/// tolerance. This error is sin(theta) psi', which is a part of w1, divided by the square of the ratio.
const FAST: f64 = 40.0;
const SMALL: f64 = 0.01;

/// The largest distance of sin(theta) psi' from its balance at which a contact settles, in units of the tolerance.
/// None if the contact point, which stops at the rate `rate`, does not stop fast enough in comparison with the fall
/// of the face. `turns` is sin(theta) psi' in units of the tolerance.
pub(crate) fn settles_within(
    losses: &Couples<f64>,
    (s, fall): (f64, f64),
    rate: f64,
    turns: f64,
) -> Option<f64> {
    let ratio = rate * s / fall;
    // Farther from the table the balance must be more accurate, so that a larger ratio is required.
    if ratio > FASTER * (1.0 + s / NEARBY).sqrt() {
        return Some(100.0);
    }
    // With dry friction the smaller ratio is not enough, since the time of the stop depends on psi' itself.
    let small = turns.abs() < SMALL * ratio * ratio && !losses.has(Law::DryContour);
    (ratio > FAST && small).then_some(1.0)
}

/// Upper bound of the delay with which a settled contact stops after dry friction has balanced the couple on it. As
/// the balance falls with the face, psi' lags behind it by the time 1/rate. If the couple grows with a power of psi',
/// the rate vanishes at the stop, and the lag is the time in which this couple takes the last of psi'.
pub(crate) fn lag(
    losses: &Couples<f64>,
    (s, fall): (f64, f64),
    radius: f64,
    push: f64,
    lightness: f64,
) -> f64 {
    let rate = losses.slope(s, radius, 0.0) * lightness;
    let falls = (push * fall / s).abs();
    let (layer, inertia) = (losses.coefficient(Law::BoundaryLayer), 1.0 / lightness);
    let takes = inertia.powf(0.75) / (layer.sqrt() * falls.sqrt().sqrt());
    LATER / (rate + 1.0 / takes)
}

/// Contact force and accelerations of the body at some w and psi''; `push` is the couple that turns the contact point
/// along the rim.
pub(crate) struct Turned<A> {
    pub acted: A,
    pub push: f64,
    pub normal: f64,
}

/// The motion of a settled contact, whose couples balance.
pub(crate) struct Balance<A> {
    pub precession: f64,
    pub w: [f64; 3],
    pub turned: Turned<A>,
    pub spin: f64,
}

/// Solves the balance of couples on a settled contact, from w_z, w2 and the radius of the circle of contact; `way` is
/// the sign of psi'.
pub(crate) fn balance<A>(
    losses: &Couples<f64>,
    ((s, c), radius): ((f64, f64), f64),
    (drilling, w2): (f64, f64),
    way: f64,
    act: impl Fn(f64, [f64; 3], f64) -> Turned<A>,
) -> Balance<A> {
    let film = losses.coefficient(Law::AirFilm) * FRAC_PI_4 / s;
    let (mut spin, mut rate) = (0.0, 0.0);
    for sweep in 0.. {
        let precession = drilling - c * spin;
        let w = [s * precession, w2, c * drilling + s * s * spin];
        let turned = act(precession, w, rate);
        let push = turned.push;
        let dry = losses.coefficient(Law::DryContour) * turned.normal * radius;
        let moving = if dry == 0.0 { push } else { way * (way * push - dry).max(0.0) };
        spin = balanced(losses, s, radius, moving);
        if sweep == SWEEPS {
            return Balance { precession, w, turned, spin };
        }
        // The push falls in proportion to s, and psi' falls with it.
        let slope = losses.slope(s, radius, spin);
        rate = if slope > 0.0 { -(c * w2 / s * (push + film * spin) / slope) } else { 0.0 };
    }
    unreachable!("the sweeps end")
}

/// The psi' at which the couple along the contour equals `push`.
fn balanced(losses: &Couples<f64>, s: f64, radius: f64, push: f64) -> f64 {
    let slope = losses.slope(s, radius, 0.0);
    let (k, push, way) = (losses.coefficient(Law::BoundaryLayer), push.abs(), push.signum());
    if k == 0.0 {
        return if slope > 0.0 { way * push / slope } else { 0.0 };
    }
    // The equation is k z^3 + slope z^2 = push with psi' = z^2.
    let mut z = (push / k).cbrt();
    if slope > 0.0 {
        z = z.min((push / slope).sqrt());
        for _ in 0..60 {
            let rate = 3.0 * k * z * z + 2.0 * slope * z;
            let step = ((k * z + slope) * z * z - push) / rate.max(f64::MIN_POSITIVE);
            z -= step;
            if step.abs() <= 1e-15 * z {
                break;
            }
        }
    }
    way * z * z
}

#[cfg(test)]
mod tests {
    use crate::laws::loss::{Couples, Law, Losses};

    #[test]
    fn the_balance_knows_every_law_along_the_contour() {
        for &law in Law::ALL {
            let losses = Couples::of(&Losses::of(law, 0.3), |x| x);
            let slope = |s: f64, spin: f64| losses.slope(s, 0.9, spin);
            let known = law == Law::BoundaryLayer || slope(0.1, 1.0) == slope(0.1, 2.0);
            assert!(
                known,
                "{law:?}: `balanced` and `lag` in path/settled.rs know one power of psi' but the first"
            );
            let known = law == Law::AirFilm || slope(0.1, 1.0) == slope(0.2, 1.0);
            assert!(known, "{law:?}: `balance` in path/settled.rs knows one slope that depends on theta");
        }
    }
}
