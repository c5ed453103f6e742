//! The least spin with which a tippe top turns over, and with which a lying egg rises.
//!
//! ```text
//! J = I3 n (1 - l)        at the start, upright;  l = |ell|, the centre of mass below the middle of the ball
//! J = I3 n' (1 + l)       upside down; stable for n'^2 > l (1 + l)^2/(I3 (1 + l) - I1)
//! n = (1 + l)^2/(1 - l) sqrt(l/(I3 (1 + l) - I1))      if friction keeps J, Jellett's number
//! n >= (1 - l) sqrt(l/(I1 - I3 (1 - l)))               the upright top is unstable
//!
//! J = w (I1 s^2 + I3 c^2) h                       of an egg that lies, with the height h of its centre of mass
//! J^2 > I3^2 h^4 (h - rho)/(rho (I3 h - I1))      of one on its end, for its end's radius of curvature rho and I1 -> I1 rho
//! (I3 a^2 - I1 b^2) cos + I3 d sqrt(b^2 + (a^2 - b^2) cos^2) > 0    on the whole way to the end at cos = 1; < 0 to the other
//! ```
//! A body can rise only if the least energy at the same J decreases all the way up. For a top that needs 1 - l <
//! I1/I3 < 1 + l. Friction at a point conserves J (Jellett 1872; Ebenfeld and Scheck, Ann. Phys. 243, 195 (1995)), so
//! that this is the least spin for any coefficient of friction. On a patch of contact drilling friction reduces J. In
//! creep both the rise and this loss are proportional to the radius of the patch, so that a top needs more spin even
//! on the smallest patch. The least spin on a patch is computed from motions.
//!
//! Error of the search: 1e-3 of the spin, within the time of the search. A motion decides whether the body turns over
//! only if its estimated error is smaller than the distance of the axis from the limiting angle; else the motion is
//! computed again with a smaller tolerance.
//!
//! ```
//! use spincyl::{Ellipsoid, turning};
//!
//! let least = turning::jellett_rising_spin(&Ellipsoid::egg(1.0, 1.4, 0.0)?)?;
//! assert!((least - 4.146).abs() < 1e-3); // in sqrt(g/a)
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::motion::roll_with;
use super::{Ask, Method, Motion, Moving, Start, stone};
use crate::error::{Error, within};
use crate::laws::body::Body;
use crate::laws::contact::slip::{Friction, centre_velocity};
use crate::laws::state::{Slip, State};
use crate::laws::stone::{Ellipsoid, StoneState};
use crate::numbers::larger_or_nan;
use crate::numbers::vector::Symmetric;
use core::f64::consts::PI;

/// A top has turned over when its axis is this close to the vertical, in radians.
const UPSIDE_DOWN: f64 = 0.14;
/// An egg stands on an end when its axis is this close to the vertical, in radians.
const ON_END: f64 = 0.2;
/// The search for the least spin ends when its interval has this relative width.
const SPIN_KNOWN: f64 = 1e-3;
/// A sum of two terms counts as zero if it is negative by at most this share of them, which may be rounding.
const ROUNDED_OFF: f64 = 1e-14;
/// Each spin that is tried is this factor larger than the one before, up to `MOST_SPIN` times the spin by Jellett's
/// number.
const SPIN_STEP: f64 = 1.15;
const MOST_SPIN: f64 = 10.0;
/// Shortest default time of a motion, in sqrt(R/g). Drilling friction on a patch of radius eps stops a spin of about
/// 1 in the time 1/(mu eps), which is the default if it is longer.
const LEAST_TIME: f64 = 400.0;
/// The search computes the state of each motion at this number of times, or once in each unit of time if these are
/// more, but at most at `MOST_LOOKS` times.
const LEAST_LOOKS: f64 = 400.0;
const MOST_LOOKS: f64 = 40_000.0;
/// The tolerances with which a motion is computed, one after the other, until its error is small enough to decide
/// whether the body turns over.
const DECISION_TOLERANCES: [f64; 3] = [1e-8, 1e-11, 1e-14];

/// The least spin w3, in sqrt(g/R), with which a nearly upright top turns over if friction conserves Jellett's
/// number; infinite unless 1 - l < I1/I3 < 1 + l, with l = |ell|: otherwise the top is unstable upside down or stable
/// upright at every spin.
///
/// Error: a few roundings.
///
/// ```
/// use spincyl::{Body, turning};
///
/// let top = Body::ball(-0.2, 0.40, 0.42)?;
/// assert!((turning::jellett_spin(&top)? - 2.496).abs() < 1e-3);
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// `OutOfRange` unless the body is a ball with its centre of mass below its middle.
pub fn jellett_spin(top: &Body) -> Result<f64, Error> {
    let [over, up] = jellett_spins(top)?;
    Ok(over.max(up))
}

/// The least spin w3 with which a top is stable upside down, and the least with which it is unstable upright, in
/// sqrt(g/R).
fn jellett_spins(top: &Body) -> Result<[f64; 2], Error> {
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
        "less than 0: the centre of mass of a tippe top is below the centre of the ball",
    )?;
    let root = |stiff: f64| if stiff > 0.0 { (low / stiff).sqrt() } else { f64::INFINITY };
    let over = (1.0 + low) * (1.0 + low) / (1.0 - low) * root(top.i3() * (1.0 + low) - top.i1());
    Ok([over, (1.0 - low) * root(top.i1() - top.i3() * (1.0 - low))])
}

/// The least spin w3, in sqrt(g/R), with which a top at the inclination `lean`, with its centre at rest, turns over
/// under this friction within a `time` in sqrt(R/g). `None` is the time 400, or 1/(mu patch) if this is longer: the time
/// in which drilling takes the spin. The result is infinite if the top does not turn over in that time with ten times
/// the spin of [`jellett_spin`]. The weaker the friction, the longer a top needs; with more time the result may be less.
///
/// The top has turned over when its axis comes within 0.14 rad of the vertical. A top that leaves the table lands
/// without a bounce (restitution 0). Error: 1e-3 of the spin. On rough tables a larger spin may fail where a smaller
/// one succeeds; the result is then one of several limits. The result is never less than half of the spin with which
/// the top is stable upside down.
///
/// # Errors
/// Those of [`jellett_spin`]; `OutOfRange` for a `lean` outside [1e-6, 1], a `time` outside (0, 1e6] or coefficients
/// out of range; those of [`roll_with`](super::motion::roll_with); `Undecided` if the computation of a motion stops
/// early, or if its error at the smallest tolerance is too large to decide.
pub fn turning_spin(
    top: &Body,
    friction: Friction,
    lean: f64,
    time: impl Into<Option<f64>>,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<f64>, Error> {
    let times = times_to_look(friction, lean, time.into())?;
    let turns = |spin: f64| turns_over(top, (friction, lean), &times, spin, &mut go_on);
    let [over, up] = jellett_spins(top)?;
    search_least_spin(over, if up.is_finite() { over.max(up) } else { over }, turns)
}

/// The least spin about the vertical, in sqrt(g/a), with which a lying egg rises to an end if friction conserves
/// Jellett's number; infinite if the egg is unstable on its ends at every spin, or stable at an inclination in
/// between.
///
/// An egg is a spheroid whose third semi-axis is the longest, with a mass that is symmetric about that axis. Error: a
/// few roundings.
///
/// # Errors
/// `OutOfRange` for another body, for an egg that stands on an end without spin, and for one that cannot lie.
pub fn jellett_rising_spin(egg: &Ellipsoid) -> Result<f64, Error> {
    let LyingEgg { theta, height, moment } = LyingEgg::of(egg)?;
    let ([b, _, a], [_, _, d], [i1, _, i3, ..]) = (egg.axes(), egg.offset(), egg.inertia.0);
    let (curved, long) = (b * b / a, a * a - b * b);
    // Positive where an egg with cosine c gains height with less energy of the same J, towards c = 1.
    let (tilt, shift) = (i3 * a * a - i1 * b * b, i3 * d);
    let rises = |c: f64| tilt * c + shift * (b * b + long * c * c).sqrt();
    let lying = theta.cos();
    let ratio = tilt / shift;
    let turning = -(ratio * b / (long * (long - ratio * ratio)).sqrt());
    let least = [-1.0, 1.0].map(|end: f64| {
        let h = a + end * d;
        let stiff = curved * (i3 * h - i1 * curved);
        let between = |c: f64| (lying.min(end)..lying.max(end)).contains(&c);
        let falls = |c: f64| end * rises(c) < -ROUNDED_OFF * (tilt.abs() + shift.abs() * a);
        let barred = falls(lying) || between(turning) && falls(turning);
        if stiff > 0.0 && !barred { i3 * h * h * ((h - curved) / stiff).sqrt() } else { f64::INFINITY }
    });
    let [one, other] = least.map(|number| number / (moment * height));
    Ok(one.min(other))
}

/// The least spin about the vertical, in sqrt(g/a), with which an egg rises to an end. The egg lies with its axis
/// raised by `lean` and its centre at rest. The result is infinite if the egg does not rise with ten times the spin of
/// [`jellett_rising_spin`].
///
/// The egg has risen when its axis comes within 0.2 rad of the vertical. `time` and the error are as for
/// [`turning_spin`], in sqrt(a/g).
///
/// # Errors
/// Those of [`jellett_rising_spin`], and those of [`turning_spin`] for the friction, the `lean`, the `time` and the
/// motions.
pub fn rising_spin(
    egg: &Ellipsoid,
    friction: Friction,
    lean: f64,
    time: impl Into<Option<f64>>,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<f64>, Error> {
    let times = times_to_look(friction, lean, time.into())?;
    let rises = |spin: f64| rises(egg, (friction, lean), &times, spin, &mut go_on);
    let least = jellett_rising_spin(egg)?;
    search_least_spin(least, least, rises)
}

/// The times at which the search computes the state of each motion.
fn times_to_look(friction: Friction, lean: f64, time: Option<f64>) -> Result<Vec<f64>, Error> {
    friction.check()?;
    within("lean", lean, (1e-6, 1.0), "1e-6 to 1 rad")?;
    let slows = friction.strength() * friction.patch();
    let until = time.unwrap_or(LEAST_TIME.max(if slows > 0.0 { 1.0 / slows } else { 0.0 }));
    within("t", until, (f64::MIN_POSITIVE, 1e6), "a time above 0, at most 1e6")?;
    // A body that has turned stands for a long time, so that it stands at one of these times.
    let count = until.clamp(LEAST_LOOKS, MOST_LOOKS).ceil();
    Ok((1..=count as u32).map(|k| until / count * f64::from(k)).collect())
}

/// Searches the least spin for which `turns` is true, from half of `least` to ten times `most`; None if the search is
/// interrupted.
fn search_least_spin(
    least: f64,
    most: f64,
    mut turns: impl FnMut(f64) -> Result<Option<bool>, Error>,
) -> Result<Option<f64>, Error> {
    if !least.is_finite() {
        return Ok(Some(f64::INFINITY));
    }
    // On a film, an inclined top may turn over with less spin.
    let [mut low, mut high] = [0.5 * least; 2];
    while high < MOST_SPIN * most {
        let Some(enough) = turns(high)? else { return Ok(None) };
        if enough {
            break;
        }
        (low, high) = (high, high * SPIN_STEP);
    }
    if high >= MOST_SPIN * most {
        return Ok(Some(f64::INFINITY));
    }
    while high - low > SPIN_KNOWN * high {
        let middle = 0.5 * (low + high);
        let Some(enough) = turns(middle)? else { return Ok(None) };
        if enough { high = middle } else { low = middle }
    }
    Ok(Some(high))
}

/// Whether a top with this spin turns over; None if the search is interrupted.
fn turns_over(
    top: &Body,
    (friction, lean): (Friction, f64),
    times: &[f64],
    spin: f64,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<bool>, Error> {
    let state = State { theta: lean, w1: 0.0, w2: 0.0, w3: spin };
    let slip = centre_velocity(top, &state, Slip::default()).map(|v| -v).into();
    let start = Start { slip, ..state.into() };
    decide_whether_positive(
        friction,
        times,
        spin,
        |y: &State| y.theta - (PI - UPSIDE_DOWN),
        |times, ask| roll_with(top, start, times, ask, &mut *go_on),
    )
}

/// Whether an egg with this spin rises; None if the search is interrupted.
fn rises(
    egg: &Ellipsoid,
    (friction, lean): (Friction, f64),
    times: &[f64],
    spin: f64,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<bool>, Error> {
    let (sin, cos) = (LyingEgg::of(egg)?.theta - lean).sin_cos();
    let vertical = [sin, 0.0, cos];
    let state = StoneState { vertical, w: vertical.map(|x| spin * x) };
    let start = Start { slip: egg.slip(&state, [0.0; 2]), ..state.into() };
    let leans = |y: &StoneState| ON_END - y.vertical[2].abs().min(1.0).acos();
    decide_whether_positive(friction, times, spin, leans, |times, ask| {
        stone::roll(egg, start, times, ask, &mut *go_on)
    })
}

/// Whether the function `room` of the state is positive at some time of a motion. The motion is computed with smaller
/// and smaller tolerances until its error is small enough to decide. None if the motion is interrupted.
fn decide_whether_positive<S: Moving>(
    friction: Friction,
    times: &[f64],
    spin: f64,
    room: impl Fn(&S) -> f64,
    mut roll: impl FnMut(&[f64], &Ask) -> Result<Option<Motion<S>>, Error>,
) -> Result<Option<bool>, Error> {
    let mut error = f64::INFINITY;
    for tol in DECISION_TOLERANCES {
        let ask = Ask { method: Method::Tolerance(tol), restitution: Some(0.0), ..Ask::on(friction) };
        let Some(whole) = roll(times, &ask)?.filter(|m| !m.is_interrupted()) else { return Ok(None) };
        let most = whole.states.iter().map(&room).fold(f64::NEG_INFINITY, larger_or_nan);
        error = whole.error;
        if error < most.abs() && (most > 0.0 || whole.limit.is_none()) {
            return Ok(Some(most > 0.0));
        }
        // Up to the first such states the error may be smaller.
        for least in [0.0, 0.5 * most, 0.9 * most].into_iter().filter(|_| most > 0.0) {
            let Some(first) = whole.states.iter().position(|y| room(y) > least) else { continue };
            let Some(part) = roll(&times[..=first], &ask)?.filter(|m| !m.is_interrupted()) else {
                return Ok(None);
            };
            if part.states.last().is_some_and(|y| room(y) > part.error) {
                return Ok(Some(true));
            }
        }
    }
    Err(Error::Undecided { spin, error })
}

/// An egg at rest on its side.
struct LyingEgg {
    theta: f64,
    height: f64,
    /// The moment of inertia about the vertical, in M a^2.
    moment: f64,
}

impl LyingEgg {
    /// The egg at rest on its side. An error if the ellipsoid is no egg: the message names the axis or moment that is
    /// wrong.
    fn of(egg: &Ellipsoid) -> Result<Self, Error> {
        let ([b, c, a], [x, y, d]) = (egg.axes(), egg.offset());
        let Symmetric([i1, i2, i3, one, two, three]) = egg.inertia;
        let expected = "an egg, whose third semi-axis is longer than the two others, which are equal";
        within("axes", if b == c { a / b } else { f64::NAN }, (1.0 + 1e-9, f64::INFINITY), expected)?;
        for (name, value) in [
            ("offset", x.abs().max(y.abs())),
            ("inertia", (i1 - i2).abs().max(one.abs()).max(two.abs()).max(three.abs())),
        ] {
            within(
                name,
                value,
                (0.0, 1e-12),
                "a deviation of at most 1e-12 from a mass that is symmetric about axis 3",
            )?;
        }
        // With a lower centre of mass it stands on that end without any spin.
        let long = a * a - b * b;
        let most = long / a;
        within(
            "offset",
            d,
            (-most, most),
            "a centre of mass so near the middle that the egg at rest lies on its side",
        )?;
        let cos = -d * b / (long * long - d * d * long).sqrt();
        let square = cos * cos;
        let height = (b * b + long * square).sqrt() + d * cos;
        Ok(Self { theta: cos.acos(), height, moment: i1 + (i3 - i1) * square })
    }
}
