//! Toppling: whether a body that slides on its face stays upright, and the state after a kerb has stopped it.
//!
//! ```text
//! X         -Z F/(a N)                            centre of the pressure, from the axis, in units of a
//! topples   mu Z > a                              sliding straight, without spin
//! tripped   w2 = -v Z/J,   J = I1 + Z^2 + a^2     theta = 0, w1 = w3 = 0, without slip
//! ```
//! a is the radius of the circle on which the face touches the table, and Z the height of the centre of mass. While the
//! axis stays vertical, the force of the table has no horizontal moment about the centre of mass: the centre of its pressure
//! is at a X, ahead in the direction of the motion. Beyond the rim, |X| > 1, it cannot be. A kerb that stops the leading edge takes no angular momentum about this edge,
//! v Z before and J |w2| after; the body then turns about that point of its rim. It turns over the point if
//! v^2 > 2 J (sqrt(a^2 + Z^2) - Z)/Z^2.
//! Error: 4 ulp; a test of `topple` compares with angular momentum in three dimensions.
//!
//! ```
//! use spincyl::{Body, newton::Force, topple::pressure_centre};
//!
//! // A can twice as high as wide slides against a friction of 0.3: the pressure is 0.6 of the radius ahead.
//! let [ahead, _] = pressure_centre(&Body::solid(2.0)?, 0.0, &Force::new(1.0, 0.0, -0.3));
//! assert!((ahead - 0.6).abs() < 1e-15);
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::body::Body;
use super::newton::Force;
use super::state::State;
use crate::error::{Error, within};

/// A and Z of the face of a body, or an error for a body that has none, such as a ball.
fn face(body: &Body) -> Result<[f64; 2], Error> {
    let (flat, rim) = ((0.0, 1.0), body.shape().rim);
    let a = within(
        "a",
        rim.radius(flat),
        (f64::MIN_POSITIVE, f64::MAX),
        "a > 0, the radius of the face of the body: a ball has no face",
    )?;
    Ok([a, rim.height(flat)])
}

/// The centre of the pressure on the face of a body that stands or slides on it, at theta = 0 or pi: its distance from the
/// axis along e_h and e2, in units of the radius of the face. NaN without a force.
pub fn pressure_centre(body: &Body, theta: f64, force: &Force) -> [f64; 2] {
    let (rim, angle) = (body.shape().rim, (0.0, theta.cos()));
    let lever = rim.height(angle) / (rim.radius(angle) * force.normal);
    [force.across, force.along].map(|friction| 0.0 - lever * friction)
}

/// Whether a body that slides straight on its face, with this coefficient of friction, topples over its leading edge.
///
/// ```
/// use spincyl::{Body, topple::topples};
///
/// let can = Body::solid(2.0)?; // its centre of mass is 2 above the table
/// assert!(!topples(&can, 0.49)? && topples(&can, 0.51)?);
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// `OutOfRange` for a `mu` that is negative or not finite, and for a body without a face, such as a ball.
pub fn topples(body: &Body, mu: f64) -> Result<bool, Error> {
    within("mu", mu, (0.0, f64::MAX), "0 <= mu, finite")?;
    let [a, z] = face(body)?;
    Ok(mu * z > a)
}

/// The state of a body that slides on its face with the velocity `velocity`, after a kerb has stopped its leading edge. The
/// state is without slip, and that edge is its point of contact.
///
/// ```
/// use spincyl::{Body, topple::tripped};
///
/// let can = Body::solid(2.0)?;
/// assert!(tripped(&can, 1.0)?.w2 < 0.0); // it rises on its leading edge
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// `OutOfRange` for a velocity that is negative or not finite, and for a body without a face, such as a ball.
pub fn tripped(body: &Body, velocity: f64) -> Result<State, Error> {
    within("velocity", velocity, (0.0, f64::MAX), "0 <= velocity, finite")?;
    let [a, z] = face(body)?;
    Ok(State { theta: 0.0, w1: 0.0, w2: 0.0 - velocity * z / (body.i1() + z * z + a * a), w3: 0.0 })
}
