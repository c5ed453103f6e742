//! The drift of a body that spins steadily on a slope, which is across the slope, not down.
//!
//! ```text
//! theta - theta0 = -sin(beta) C cos phi                                 it leans a little more on one side of its circle
//! v_y = sin(beta)/2 ((I1 A^2 + I3 L^2)/(D Om) - (V_t + Z Om) C - (V/Om) W)
//! C = (Z + (S3 I1 A - S1 I3 L)/(D Om))/(J (kappa - Om^2)),   W = -(I3 L/(D Om) + (w1_t - ct w1) C)/s
//! S1 = -2 I1 ct w1 + I3 w3 + (Z/s)(V - L w1),   S3 = I3 w1 + (Z/s) A w1        d(J w2')/d(w1, w3)
//! ```
//! These formulas hold for steady rolling to first order in the slope beta. Om is the precession, V the velocity of the
//! centre along e2; w1_t, w3_t, V_t are derivatives with respect to theta along the lines of `contact::reduced`, which
//! also explains A, L, J, D and ct; Z is the height of the centre. At kappa = Om^2 the nutation is in resonance with
//! the precession, and the body runs downhill. With kappa < 0 the body leaves the steady state.
//!
//! Error: 64 ulp of the largest term; the formulas themselves are exact to first order in the slope.
//!
//! ```
//! use spincyl::{Body, State, sideways::slope_drift, steady};
//!
//! // A body that turns the other way drifts to the other side.
//! let tube = Body::tube(6.0, 0.8)?;
//! let State { theta, w1, w3, .. } = steady::state(&tube, 1.45)?;
//! let [one, other] = [1.0, -1.0].map(|way| State { theta, w1: way * w1, w2: 0.0, w3: way * w3 });
//! let [one, other] = [one, other].map(|y| slope_drift(&tube, &y).across);
//! assert!((one + other).abs() < 1e-12);
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::stability;
use crate::laws::body::Body;
use crate::laws::contact::Contact;
use crate::laws::contact::rolling::centre_velocity;
use crate::laws::state::{State, drilling_of};

/// The drift of a body that spins steadily on a small slope.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SlopeDrift {
    /// The velocity across the slope, along y, in sqrt(g R), over the sine of the slope.
    pub across: f64,
    /// kappa/Om^2: the squared frequency of the nutation over that of the precession, in resonance at 1.
    pub resonance: f64,
}

/// The drift of a body in a steady state of rolling; both numbers are NaN for a state that is not steady in rolling or
/// does not precess.
///
/// ```
/// use spincyl::{Body, sideways::slope_drift, steady};
///
/// let tube = Body::tube(6.0, 0.8)?;
/// let drift = slope_drift(&tube, &steady::state(&tube, 1.45)?);
/// assert!((drift.across - 0.397_597_235_3).abs() < 1e-10 && drift.resonance < 0.3);
/// # Ok::<(), spincyl::Error>(())
/// ```
pub fn slope_drift(body: &Body, y: &State) -> SlopeDrift {
    let (law, angle, &State { w1, w3, .. }) = (Contact::Rolling.reduced(body), y.theta.sin_cos(), y);
    let (of, rim, (i1, i3), (s, c)) = (law.at(angle), law.shape.rim, (law.shape.i1, law.shape.i3), angle);
    let [radius, depth, height] = [rim.radius(angle), rim.depth(angle), rim.height(angle)];
    let (turns, ct, kappa) = (w1 / s, c / s, stability::rolling(body, y));
    let [_, speed, _] = centre_velocity(&law.shape, angle, [w1, 0.0, w3]);
    let [w1_t, w3_t] = law.lines(&of, angle, w1, w3);
    let speed_t = rim.rho * drilling_of(angle, w1, w3) + radius * w3_t - depth * w1_t;
    let s1 = -2.0 * i1 * ct * w1 + i3 * w3 + height / s * (speed - depth * w1);
    let s3 = i3 * w1 + height / s * radius * w1;
    let shares = [i1 * radius, i3 * depth].map(|x| x * of.per_d / turns);
    let swings =
        (height + s3 * shares[0] - s1 * shares[1]) / (law.inertia(|| angle) * (kappa - turns * turns));
    let aside = -(shares[1] + (w1_t - ct * w1) * swings) / s;
    let across = shares[0] * radius + shares[1] * depth - (speed_t + height * turns) * swings;
    let across = 0.5 * (across - speed / turns * aside);
    SlopeDrift { across, resonance: kappa / (turns * turns) }
}
