//! A contact that has settled: what resists in proportion to a power of psi' stops it ever faster while the face falls.
//!
//! ```text
//! psi'   where the couple along the contour balances what turns the contact, the rate of psi' among it
//! k psi'^(3/2) + slope psi' = push,   slope = c A^2 + (pi/4) mu/s        rate = -(c w2/s) (push + film psi')/slope
//! ```
//! Where the contact stops thousands of times faster than the face falls, psi' follows that balance (Tikhonov 1952), and the
//! motion is no longer stiff. A body that rolls and one that slips share it.
//!
//! Error: the square of how much slower the face falls, after three sweeps.

use crate::loss::{Couples, Law};
use core::f64::consts::FRAC_PI_4;

/// Sweeps towards the balance; each brings it so much nearer.
const SWEEPS: u32 = 3;
/// A face that falls lies so close before its contact can settle; which runs so much slower along the rim.
pub(super) const CLOSE: f64 = 0.01;
pub(super) const SLOWER: f64 = 0.01;
/// The contact has settled where it stops so many times faster than the face falls.
const FASTER: f64 = 4e3;
const NEARBY: f64 = 1e-4;

/// How many of its delays a stop may come later.
const LATER: f64 = 1.5;

/// A step of it takes as long as so many others.
pub(super) const EFFORT: u64 = 30;

/// Whether a contact that stops at this rate does so fast enough beside the fall of its face.
pub(super) fn is_fast(s: f64, fall: f64, rate: f64) -> bool {
    // where that is far from the table the balance has to be the better
    rate * s > FASTER * (1.0 + s / NEARBY).sqrt() * fall
}

/// By how much the stop of a settled contact may come later than where dry friction balances its push. The contact runs behind
/// its balance, which falls as the face falls, by 1/rate. The rate of what grows with a power of psi' vanishes at the stop; the
/// contact then takes as long as such a couple needs for the last of its speed.
pub(super) fn lag(
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

/// What turns a contact, and what comes of it, at some psi' and its rate.
pub(super) struct Turned<A> {
    pub acted: A,
    pub push: f64,
    pub normal: f64,
}

/// A contact that has settled.
pub(super) struct Balance<A> {
    pub precession: f64,
    pub w: [f64; 3],
    pub turned: Turned<A>,
    pub spin: f64,
}

/// The balance of a body that drills at w_z, of these losses, on a circle of contact of this radius; the contact runs one way.
pub(super) fn balance<A>(
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
        // the push falls as s, and psi' with it
        let slope = losses.slope(s, radius, spin);
        rate = if slope > 0.0 { -(c * w2 / s * (push + film * spin) / slope) } else { 0.0 };
    }
    unreachable!("the sweeps end")
}

/// psi' at which a contact balances `push`.
fn balanced(losses: &Couples<f64>, s: f64, radius: f64, push: f64) -> f64 {
    let slope = losses.slope(s, radius, 0.0);
    let (k, push, way) = (losses.coefficient(Law::BoundaryLayer), push.abs(), push.signum());
    if k == 0.0 {
        return if slope > 0.0 { way * push / slope } else { 0.0 };
    }
    // k z^3 + slope z^2 = push,   psi' = z^2
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
