//! The least spin with which a tippe top turns over, and with which a lying egg rises.
//!
//! ```text
//! J = I3 n (1 - l)        at the start, upright;  l = |ell|, the centre of mass below the middle of the ball
//! J = I3 n' (1 + l)       upside down; stable for n'^2 > l (1 + l)^2/(I3 (1 + l) - I1)
//! n = (1 + l)^2/(1 - l) sqrt(l/(I3 (1 + l) - I1))      if friction keeps J, Jellett's number
//!
//! J = w (I1 s^2 + I3 c^2) h                       of an egg that lies, with the height h of its centre of mass
//! J^2 > I3^2 h^4 (h - rho)/(rho (I3 h - I1))      of one on its end, for its end's radius of curvature rho and I1 -> I1 rho
//! ```
//! Friction at a point conserves J (Jellett 1872; Ebenfeld and Scheck, Ann. Phys. 243, 195 (1995)), so that this is the
//! least spin for any coefficient of friction. On a patch the couple of drilling reduces J. In creep both the rise and
//! that loss are proportional to the radius of the patch, so that a top needs more spin on the smallest patch, too.
//! That spin is computed from motions.
//!
//! Error of the search: 1e-3 of the spin.

use super::motion::roll_with;
use super::{Ask, Method, Motion, Start, stone};
use crate::error::{Error, within};
use crate::laws::body::Body;
use crate::laws::contact::slip::{Friction, centre_velocity};
use crate::laws::state::State;
use crate::laws::stone::{Ellipsoid, StoneState};
use crate::numbers::vector::Symmetric;
use core::f64::consts::PI;

/// A top has turned over when its axis is this close to the vertical, in radians.
const UPSIDE_DOWN: f64 = 0.14;
/// An egg stands on an end when its axis is this close to the vertical, in radians.
const ON_END: f64 = 0.2;
/// The search ends at this relative width.
const SPIN_KNOWN: f64 = 1e-3;
/// The spins of the first search grow by this factor, up to `MOST_SPIN` times that of Jellett's number.
const SPIN_STEP: f64 = 1.15;
const MOST_SPIN: f64 = 10.0;
/// A top that drills slows down within 1/(mu eps) units of time at a spin of about 1, and its motion is computed for
/// that time; at a point, and on a film, for the shorter time `LEAST_TIME`.
const LEAST_TIME: f64 = 400.0;

/// The least spin w3, in sqrt(g/R), with which a nearly upright top turns over if friction conserves Jellett's number;
/// infinite if the top is unstable upside down with any spin.
///
/// Error: a few roundings. Errors: `OutOfRange` unless the body is a ball with its centre of mass below its middle.
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
            expected: "1, since a tippe top is a ball",
        });
    }
    within(
        "ell",
        top.ell(),
        (-1.0, -f64::MIN_POSITIVE),
        "below 0: the centre of mass of a tippe top is below its middle",
    )?;
    let stiff = top.i3() * (1.0 + low) - top.i1();
    Ok(if stiff > 0.0 {
        (1.0 + low) * (1.0 + low) / (1.0 - low) * (low / stiff).sqrt()
    } else {
        f64::INFINITY
    })
}

/// The least spin w3, in sqrt(g/R), with which a top at the inclination `lean`, with its centre at rest, turns over
/// under this friction. The result is infinite if the top does not turn over with ten times the spin of
/// [`jellett_spin`].
///
/// The top has turned over when its axis comes within 0.14 rad of the vertical. A motion that ends earlier, for example
/// by a hop, counts as one without turning over. Error: 1e-3 of the spin. On rough tables a larger spin may fail where
/// a smaller one does not, and the result is one limit of several. The result is never less than half of the estimate.
/// Errors: those of [`jellett_spin`]; `OutOfRange` for a `lean` outside [1e-6, 1] or coefficients out of range; those
/// of [`roll_with`](super::motion::roll_with).
pub fn turning_spin(
    top: &Body,
    friction: Friction,
    lean: f64,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<f64>, Error> {
    let turns = |spin: f64| turns_over(top, friction, lean, spin, &mut go_on);
    searched(jellett_spin(top)?, (friction, lean), turns)
}

/// The least spin about the vertical, in sqrt(g/a), with which a lying egg rises to an end if friction conserves
/// Jellett's number; infinite if the egg is unstable on both ends with any spin.
///
/// An egg is a spheroid whose third semi-axis is the longest, with a mass that is symmetric about that axis. Error: a
/// few roundings. Errors: `OutOfRange` for another body, for an egg that stands on an end without spin, and for one
/// that cannot lie.
pub fn jellett_rising_spin(egg: &Ellipsoid) -> Result<f64, Error> {
    let LyingEgg { height, moment, .. } = LyingEgg::of(egg)?;
    let ([b, _, a], [_, _, d], [i1, _, i3, ..]) = (egg.axes(), egg.offset(), egg.inertia.0);
    let curved = b * b / a;
    let least = [a - d, a + d].map(|h| {
        let stiff = curved * (i3 * h - i1 * curved);
        if stiff > 0.0 { i3 * h * h * ((h - curved) / stiff).sqrt() } else { f64::INFINITY }
    });
    let [one, other] = least.map(|number| number / (moment * height));
    Ok(one.min(other))
}

/// The least spin about the vertical, in sqrt(g/a), with which an egg rises to an end. The egg lies with its axis
/// raised by `lean` and its centre at rest. The result is infinite if the egg does not rise with ten times the spin of
/// [`jellett_rising_spin`].
///
/// The egg has risen when its axis comes within 0.2 rad of the vertical. Error and errors are as for [`turning_spin`].
pub fn rising_spin(
    egg: &Ellipsoid,
    friction: Friction,
    lean: f64,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<f64>, Error> {
    let rises = |spin: f64| rises(egg, friction, lean, spin, &mut go_on);
    searched(jellett_rising_spin(egg)?, (friction, lean), rises)
}

/// The least spin for which `turns` is true, from half to ten times an estimate; None if the search is interrupted.
fn searched(
    least: f64,
    (friction, lean): (Friction, f64),
    mut turns: impl FnMut(f64) -> Result<Option<bool>, Error>,
) -> Result<Option<f64>, Error> {
    friction.check()?;
    within("lean", lean, (1e-6, 1.0), "1e-6 to 1 rad")?;
    if !least.is_finite() {
        return Ok(Some(f64::INFINITY));
    }
    // On a film, an inclined top may turn over with less spin.
    let [mut low, mut high] = [0.5 * least, 0.5 * least];
    while high < MOST_SPIN * least {
        let Some(enough) = turns(high)? else { return Ok(None) };
        if enough {
            break;
        }
        (low, high) = (high, high * SPIN_STEP);
    }
    if high >= MOST_SPIN * least {
        return Ok(Some(f64::INFINITY));
    }
    while high - low > SPIN_KNOWN * high {
        let middle = 0.5 * (low + high);
        let Some(enough) = turns(middle)? else { return Ok(None) };
        if enough { high = middle } else { low = middle }
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
    let (times, ask) = watched(friction);
    let motion = roll_with(top, Start { slip, ..state.into() }, &times, &ask, go_on)?;
    Ok(motion.map(|m| m.states.iter().any(|y| y.theta > PI - UPSIDE_DOWN)))
}

/// Whether an egg with this spin rises.
fn rises(
    egg: &Ellipsoid,
    friction: Friction,
    lean: f64,
    spin: f64,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<bool>, Error> {
    let (sin, cos) = (LyingEgg::of(egg)?.theta - lean).sin_cos();
    let vertical = [sin, 0.0, cos];
    let state = StoneState { vertical, w: vertical.map(|x| spin * x) };
    let (times, ask) = watched(friction);
    let start = Start { slip: egg.slip(&state, [0.0; 2]), ..state.into() };
    let motion: Option<Motion<StoneState>> = stone::roll(egg, start, &times, &ask, go_on)?;
    Ok(motion.map(|m| m.states.iter().any(|y| y.vertical[2].abs() > ON_END.cos())))
}

/// The times at which the state is computed, and the options of the motion.
fn watched(friction: Friction) -> (Vec<f64>, Ask) {
    let slows = friction.strength() * friction.patch();
    let until = LEAST_TIME.max(if slows > 0.0 { 1.0 / slows } else { 0.0 });
    // A body that has turned stands for a long time, so that it stands at one of these times.
    let times = (1..=400).map(|k| until / 400.0 * f64::from(k)).collect();
    (times, Ask { method: Method::Tolerance(1e-8), ..Ask::on(friction) })
}

/// An egg at rest on its side.
struct LyingEgg {
    theta: f64,
    height: f64,
    /// The moment of inertia about the vertical.
    moment: f64,
}

impl LyingEgg {
    /// The egg on its side, or an error that names the property that no egg has.
    fn of(egg: &Ellipsoid) -> Result<Self, Error> {
        let ([b, c, a], [x, y, d]) = (egg.axes(), egg.offset());
        let Symmetric([i1, i2, i3, one, two, three]) = egg.inertia;
        let expected = "two equal semi-axes and a longer third one";
        within("axes", if b == c { a / b } else { f64::NAN }, (1.0 + 1e-9, f64::INFINITY), expected)?;
        for (name, value) in [
            ("offset", x.abs().max(y.abs())),
            ("inertia", (i1 - i2).abs().max(one.abs()).max(two.abs()).max(three.abs())),
        ] {
            within(name, value, (0.0, 1e-12), "a mass that is symmetric about axis 3")?;
        }
        // With a lower centre of mass it stands on that end without any spin.
        let long = a * a - b * b;
        let most = long / a;
        within("offset", d, (-most, most), "a centre of mass so low that the egg lies")?;
        let cos = -d * b / (long * long - d * d * long).sqrt();
        let square = cos * cos;
        let height = (b * b + long * square).sqrt() + d * cos;
        Ok(Self { theta: cos.acos(), height, moment: i1 + (i3 - i1) * square })
    }
}
