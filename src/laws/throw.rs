//! Throwing: the state in which a body leaves the hand, on edge or on its side.
//!
//! ```text
//! thrown    theta = pi/2, w1 = w2 = 0, w3 = -w0,   u_h = 0,  u_2 = v + w0            backspin w0
//! pressed   v_2 = J (f cos beta - sin beta) + Q,   I1 w1 = -ell v_2,   I3 w3 = f J - Q,   w2 = 0
//!           u_h = 0,  u_2 = v_2 + ell w1 - w3;   of the end under the finger  u = v_2 - ell w1 - w3
//!           Q = -u0/(1 + ell^2/I1 + 1/I3) within +-mu J (cos beta + f sin beta),   u0 = u where Q = 0
//! launch number   x = I3 w1 w3/ell,   it rises where x > 1
//! ```
//! The axis of the body is horizontal. A finger presses on the upper rim, at the angle beta from its top,
//! with the impulse J, and drags the surface downwards with the coefficient of friction f. The table supports
//! that end. Its horizontal impulse Q makes that end roll or, if this needs too much friction, is mu of the
//! table times the vertical impulse, against the slip. The other end carries no load during the push, so that
//! every horizontal impulse acts at the end under the finger: v_2 = -(I1/ell) w1 for any push. The impulses
//! are those of Newton's and Euler's equations; the launch is that of Jackson et al., Am. J. Phys. 87, 85
//! (2019), Sec. I.
//! Error: 8 ulp of the largest term; a test of `throw` compares with a three-dimensional model.
//!
//! ```
//! use spincyl::throw::{launch_number, launch_spin};
//! use spincyl::{Body, State};
//!
//! // A tube on its side that turns at the rate 2 rises if it spins faster than this.
//! let tube = Body::tube(6.0, 0.8)?;
//! let w3 = launch_spin(&tube, 2.0, 1.0);
//! let state = State { theta: std::f64::consts::FRAC_PI_2, w1: 2.0, w2: 0.0, w3 };
//! assert!((launch_number(&tube, &state) - 1.0).abs() < 1e-14);
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::body::Body;
use super::contact::landing;
use super::state::{Slip, State};
use crate::error::{Error, within};
use core::f64::consts::{FRAC_PI_2, PI};

/// The largest impulse, velocity or coefficient of friction that is accepted.
const LARGEST_INPUT: f64 = 1e100;
/// Largest deviation from theta = pi/2 and from w2 = 0 that counts as a rounding error; beyond it a body has no launch
/// number.
const LEVEL_ROUNDING: f64 = 1e-9;

/// The state of a body thrown on edge (a hoop, a coin, or a can on its side), and the slip of its rim.
///
/// `velocity` is the velocity of the centre across the axis, in sqrt(g R). `backspin`, in sqrt(g/R), is positive where
/// the bottom of the rim runs ahead of the centre.
///
/// ```
/// use spincyl::{Body, throw::thrown};
///
/// let hoop = Body::tube(0.0, 1.0)?;
/// let (state, slip) = thrown(&hoop, 1.0, 2.0)?;
/// // Friction keeps v + I3 w3; `last`, the velocity of the rolling hoop, is negative: the hoop comes back.
/// let last = (slip.u_2 + (1.0 + hoop.i3()) * state.w3) / (1.0 + hoop.i3());
/// assert_eq!(last, -0.5);
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// `OutOfRange` for a velocity or a backspin beyond 1e100, for a body of several circles that are not two equal rims,
/// and for one whose theta_end is below pi/2.
pub fn thrown(body: &Body, velocity: f64, backspin: f64) -> Result<(State, Slip), Error> {
    within("velocity", velocity, (-LARGEST_INPUT, LARGEST_INPUT), "-1e100 <= velocity <= 1e100")?;
    within("backspin", backspin, (-LARGEST_INPUT, LARGEST_INPUT), "-1e100 <= backspin <= 1e100")?;
    landing::equal_rims(body)?;
    within(
        "theta_end",
        body.theta_end(),
        (FRAC_PI_2, PI),
        "at least pi/2, for a body that can stand on edge",
    )?;
    let state = State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3: 0.0 - backspin };
    Ok((state, Slip::new(0.0, velocity + backspin)))
}

/// The state of a body on its side that a finger presses at one end until it is launched, and the slip of the other
/// end.
///
/// `impulse` is that of the finger, in M sqrt(g R), at `angle` in (0, pi/2] from the top of the rim; `finger` and
/// `table` are the coefficients of friction of the finger on the body and of the table under the pressed end. With
/// `table = 0` that end slips freely. The body must have two equal rims, sharp or rounded, and ell > 0.
///
/// ```
/// use spincyl::{Body, throw::{launch_number, pressed}};
///
/// let tube = Body::tube(6.0, 0.8)?;
/// let (state, slip) = pressed(&tube, 9.0, 0.8, 0.6, 0.0)?;
/// assert!(launch_number(&tube, &state) > 1.0 && slip.u_2 != 0.0);
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// `OutOfRange` for a body without two equal rims, an impulse or a coefficient of friction outside [0, 1e100], an
/// angle outside (0, pi/2], and an impulse so large that a speed is not finite.
pub fn pressed(
    body: &Body,
    impulse: f64,
    angle: f64,
    finger: f64,
    table: f64,
) -> Result<(State, Slip), Error> {
    landing::two_rims(body)?;
    within("impulse", impulse, (0.0, LARGEST_INPUT), "0 <= impulse <= 1e100")?;
    within("angle", angle, (f64::MIN_POSITIVE, FRAC_PI_2), "0 < angle <= pi/2 (radians)")?;
    within("finger", finger, (0.0, LARGEST_INPUT), "0 <= finger <= 1e100")?;
    within("table", table, (0.0, LARGEST_INPUT), "0 <= table <= 1e100")?;
    let (s, c) = angle.sin_cos();
    let (ell, i1, i3) = (body.ell(), body.i1(), body.i3());
    let (push, borne) = (impulse * (finger * c - s), impulse * (c + finger * s));
    let lever = 1.0 + ell * ell / i1;
    let free = push * lever - finger * impulse / i3;
    let most = table * borne;
    let drag = (-free / (lever + 1.0 / i3)).max(-most).min(most);
    let v = push + drag;
    let (w1, w3) = (-ell * v / i1, (finger * impulse - drag) / i3);
    let slip = v + ell * w1 - w3;
    for (name, x) in [("w1", w1), ("w3", w3), ("u_2", slip)] {
        within(name, x, (-f64::MAX, f64::MAX), "a finite number: use a smaller impulse")?;
    }
    Ok((State { theta: FRAC_PI_2, w1: w1 + 0.0, w2: 0.0, w3 }, Slip::new(0.0, slip)))
}

/// The spin w3 of a body on its side that turns at the rate w1, for the launch number `x`; not finite for w1 = 0.
pub fn launch_spin(body: &Body, w1: f64, x: f64) -> f64 {
    x * body.ell() / (body.i3() * w1)
}

/// The velocity v_2 = -(I1/ell) w1 of the centre of a body on its side that a finger launches with the rate w1.
pub fn recoil(body: &Body, w1: f64) -> f64 {
    -body.i1() * w1 / body.ell()
}

/// The launch number x = I3 w1 w3/ell of a body on its side: it rises on its lower rim if x > 1, on the other if x <
/// -1.
///
/// NaN for a body that is not on its side (theta = pi/2 and w2 = 0, up to rounding). The number x neglects friction
/// along the axis; [`landing::launch`] includes it.
pub fn launch_number(body: &Body, y: &State) -> f64 {
    let lies = (y.theta - FRAC_PI_2).abs() <= LEVEL_ROUNDING && y.w2.abs() <= LEVEL_ROUNDING;
    if lies { body.i3() * y.w1 * y.w3 / body.ell() } else { f64::NAN }
}
