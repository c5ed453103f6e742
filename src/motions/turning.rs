//! The spin from which a tippe top turns over.
//!
//! ```text
//! J = I3 n (1 - l)        at the start, upright;  l = |ell|, the centre of mass below the middle of the ball
//! J = I3 n' (1 + l)       upside down, where it is stable for n'^2 > l (1 + l)^2/(I3 (1 + l) - I1)
//! n = (1 + l)^2/(1 - l) sqrt(l/(I3 (1 + l) - I1))      if friction keeps J, Jellett's number
//! ```
//! Friction at a point keeps J (Jellett 1872; Ebenfeld and Scheck, Ann. Phys. 243, 195 (1995)), so that this is the least spin
//! on any table. On a patch the couple of drilling takes some of J: in creep both the rise and that loss are in proportion to
//! the radius of the patch, so that a top needs more spin on the smallest patch, too. That spin comes from motions.
//!
//! Error: of the search, 1e-3 of the spin.

use super::motion::roll_with;
use super::{Ask, Method, Start};
use crate::error::{Error, within};
use crate::laws::body::Body;
use crate::laws::contact::slip::{Friction, centre_velocity};
use crate::laws::state::State;
use core::f64::consts::PI;

/// A top has turned over where its axis is this close to the vertical, in radians.
const UPSIDE_DOWN: f64 = 0.14;
/// The search ends at this relative width.
const SPIN_KNOWN: f64 = 1e-3;
/// The spins of the first search grow by this factor, up to `MOST_SPIN` times that of Jellett's number.
const SPIN_STEP: f64 = 1.15;
const MOST_SPIN: f64 = 10.0;
/// A top that drills slows down within 1/(mu eps) units of time at a spin of about 1, and is followed for as many; on a
/// point, and on a film, for the shorter time `LEAST_TIME`.
const LEAST_TIME: f64 = 400.0;

/// The spin w3 of a top that stands nearly upright, from which it turns over if friction keeps Jellett's number; infinite
/// if it is unstable upside down with any spin.
///
/// Error: a few roundings. Errors: `OutOfRange` for a body that is no ball with its centre of mass below its middle.
///
/// ```
/// use spincyl::{Body, turning};
///
/// let top = Body::ball(-0.2, 0.40, 0.42)?;
/// assert!((turning::jellett_spin(&top)? - 2.496).abs() < 1e-3);
/// # Ok::<(), spincyl::Error>(())
/// ```
pub fn jellett_spin(top: &Body) -> Result<f64, Error> {
    let low = -top.ell();
    if !top.is_ball() {
        return Err(Error::OutOfRange {
            name: "fillet",
            value: top.fillet(),
            expected: "1: a tippe top is a ball",
        });
    }
    within(
        "ell",
        top.ell(),
        (-1.0, -f64::MIN_POSITIVE),
        "below 0: a tippe top has its centre of mass below its middle",
    )?;
    let stiff = top.i3() * (1.0 + low) - top.i1();
    Ok(if stiff > 0.0 {
        (1.0 + low) * (1.0 + low) / (1.0 - low) * (low / stiff).sqrt()
    } else {
        f64::INFINITY
    })
}

/// The spin w3 from which a top that leans by `lean`, with its centre at rest, turns over on a table; infinite if it does
/// not with ten times the spin of [`jellett_spin`].
///
/// It has turned over where its axis comes within 0.14 of the vertical. A motion that ends before, as by a hop, counts as
/// one that does not. Error: 1e-3 of the spin; on rough tables a little more spin may fail where less does not, and the
/// result is one point of such a border. Never less than half of the estimate. Errors: those of [`jellett_spin`], and `OutOfRange` for a lean outside
/// (0, 1) or coefficients out of range; those of [`roll_with`](super::motion::roll_with).
pub fn turning_spin(
    top: &Body,
    friction: Friction,
    lean: f64,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<f64>, Error> {
    friction.check()?;
    within("lean", lean, (1e-6, 1.0), "1e-6 to 1 rad")?;
    let least = jellett_spin(top)?;
    if !least.is_finite() {
        return Ok(Some(f64::INFINITY));
    }
    // A film may turn a top over that leans from the start, with less.
    let [mut low, mut high] = [0.5 * least, 0.5 * least];
    while high < MOST_SPIN * least {
        let Some(turns) = turns_over(top, friction, lean, high, &mut go_on)? else { return Ok(None) };
        if turns {
            break;
        }
        (low, high) = (high, high * SPIN_STEP);
    }
    if high >= MOST_SPIN * least {
        return Ok(Some(f64::INFINITY));
    }
    while high - low > SPIN_KNOWN * high {
        let middle = 0.5 * (low + high);
        let Some(turns) = turns_over(top, friction, lean, middle, &mut go_on)? else { return Ok(None) };
        if turns { high = middle } else { low = middle }
    }
    Ok(Some(high))
}

/// Whether a top with this spin turns over.
fn turns_over(
    top: &Body,
    friction: Friction,
    lean: f64,
    spin: f64,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<bool>, Error> {
    let state = State { theta: lean, w1: 0.0, w2: 0.0, w3: spin };
    let slip = centre_velocity(top, &state, [0.0; 2]).map(|v| -v);
    let slows = friction.strength() * friction.patch();
    let until = LEAST_TIME.max(if slows > 0.0 { 1.0 / slows } else { 0.0 });
    // A top that has turned over stands for long, so that one of the times sees it.
    let times: Vec<f64> = (1..=400).map(|k| until / 400.0 * f64::from(k)).collect();
    let ask = Ask { method: Method::Tolerance(1e-8), ..Ask::on(friction) };
    let motion = roll_with(top, Start { slip, ..state.into() }, &times, &ask, go_on)?;
    Ok(motion.map(|m| m.states.iter().any(|y| y.theta > PI - UPSIDE_DOWN)))
}
