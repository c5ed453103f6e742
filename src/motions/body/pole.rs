//! A ball whose axis passes the vertical (its pole) more closely than steps resolve.
//!
//! ```text
//! L = -s e_h   horizontal part of the axis:   L' = (w x e3)_h,   in the laboratory
//! past the pole   2 s c w2/(w1^2 + c^2 w2^2) later: L, w and the slip at constant accelerations, seen from the new e_h
//! ```
//! In the short time of the passage e_h turns around, so that components along e_h and e2 change although the vectors
//! do not. The differences that give the accelerations in the laboratory lose no digits: e_h turns by an angle of
//! order 1.
//!
//! Error: the square of the time of the passage. A couple along the rim turns with e_h, but is taken as constant; the
//! error is then proportional to the time of the passage, and `claims_passage` includes it in the estimated error.

use crate::laws::state::{drilling_of, rolling_of};
use crate::motions::walk::numbers::{PHI, PSI, SIN, TIME, W1, poses};

/// A ball whose axis approaches the vertical passes it in one step from this sine of theta on.
const BESIDE_POLE: f64 = 1e-9;
/// The axis of a ball passes the vertical in one step only if this takes less than this time: an axis that comes to
/// rest on the vertical, or winds about it, does not pass it.
const LONGEST_PASSAGE: f64 = 1e-7;

/// A step in which the axis of a ball passes the vertical is tried again up to this share of the way to the vertical.
const APPROACH_SHARE: f64 = 0.8;

/// If a step takes the axis of a ball past the vertical without resolving on which side, the share of the step that
/// is tried instead; else None. If `counts`, the side matters for a couple of dry friction along the rim, which turns
/// with e_h. It also matters for phi, but not for a body that only rocks.
#[inline(always)]
pub(crate) fn passes_unseen<const N: usize>(from: &[f64; N], y: &[f64; N], counts: bool) -> Option<f64> {
    let passes = from[SIN] * y[SIN] < 0.0 && from[W1] != 0.0 && (poses(N) || counts);
    passes.then(|| APPROACH_SHARE * from[SIN] / (from[SIN] - y[SIN]))
}

/// The components of a horizontal vector in the basis that is turned by the angle with this cosine and sine.
fn in_turned_basis([cos, sin]: [f64; 2], [h, two]: [f64; 2]) -> [f64; 2] {
    [cos * h + sin * two, cos * two - sin * h]
}

/// The time that the axis of a ball takes to pass the vertical; None if it is not close to it, moves away from it, or
/// is slow.
pub(crate) fn passage(s: f64, c: f64, [w1, w2]: [f64; 2]) -> Option<f64> {
    let nears = s * c * w2;
    let lasts = 2.0 * nears / (w1 * w1 + c * c * w2 * w2);
    (s.abs() < BESIDE_POLE && nears > 0.0 && lasts < LONGEST_PASSAGE).then_some(lasts)
}

/// The state vector ([`numbers`](crate::motions::walk::numbers)) at the same inclination on the other side of the
/// vertical, from the state vector `y` and its time derivative; None if the axis of the ball does not pass it.
pub(crate) fn passed<const N: usize>(y: &[f64; N], rates: &[f64; N]) -> Option<[f64; N]> {
    let [s, c, w1, w2, w3, u_h, u_2] = core::array::from_fn(|i| y[i]);
    let lasts = passage(s, c, [w1, w2])?;
    let [ds, dc, d1, d2, d3, du_h, du_2] = core::array::from_fn(|i| rates[i]);
    let precession = w1 / s;
    let later = |x: [f64; 2], rate: [f64; 2]| {
        let rate = [rate[0] - precession * x[1], rate[1] + precession * x[0]];
        [x[0] + lasts * rate[0], x[1] + lasts * rate[1]]
    };
    let rolling = dc * w1 + c * d1 - ds * w3 - s * d3;
    let (level, upright) = ([rolling_of((s, c), w1, w3), w2], drilling_of((s, c), w1, w3));
    let (level_then, slip) = (later(level, [rolling, d2]), later([u_h, u_2], [du_h, du_2]));
    let upright_then = upright + lasts * (ds * w1 + s * d1 + dc * w3 + c * d3);
    let moves =
        |[h, two]: [f64; 2], about: f64, lean: [f64; 2]| [two * c - about * lean[1], about * lean[0] - h * c];
    let (lean, early) = ([-s, 0.0], moves(level, upright, [-s, 0.0]));
    let then = [0, 1].map(|i| lean[i] + lasts * early[i]);
    let late = moves(level_then, upright_then, then);
    let lean: [f64; 2] = core::array::from_fn(|i| lean[i] + 0.5 * lasts * (early[i] + late[i]));
    let s = lean[0].hypot(lean[1]).copysign(s);
    let way = lean.map(|x| -x / s);
    let ([h, w2], [u_h, u_2]) = (in_turned_basis(way, level_then), in_turned_basis(way, slip));
    let c = (1.0 - s * s).sqrt().copysign(c);
    let mut there: [f64; N] = core::array::from_fn(|i| y[i] + lasts * rates[i]);
    let w = [c * h + s * upright_then, w2, c * upright_then - s * h];
    there[..TIME].copy_from_slice(&[s, c, w[0], w[1], w[2], u_h, u_2]);
    if poses(N) {
        let turn = way[1].atan2(way[0]);
        (there[PHI], there[PSI]) = (y[PHI] + turn, y[PSI] + lasts * w3 - c * turn);
    }
    Some(there)
}
