//! The check of a fixed step against the exact motion, before the first step.
//!
//! ```text
//! loss   = (span/h) mean((h w)^6)/144     share of the nutation's amplitude that RK4 takes away, w^2 = kappa
//! warn   loss > 1e-3, h w > 0.5 or h |phi'| > 0.3          refuse   h w > 2.5 or h |phi'| > 1
//! ```
//! In one step RK4 multiplies the amplitude of an oscillation by |1 - z^2/2 + z^4/24 + i (z - z^3/6)| with z = h w,
//! which is 1 - z^6/144 to leading order, and amplifies it for z > 2.83. The energy hardly shows this, since the
//! nutation's share of the energy is small. In a near-flat passage phi' and w are large only for a moment, which a
//! fixed step may jump over: its result is then wrong by hundreds of degrees, with the energy right to 0.2 %.

use crate::error::Error;
use crate::laws::state::State;
use crate::motions::exact::Swing;
use crate::motions::exact::course::Course;
use crate::motions::exact::event::{Limits, first_event};
use crate::states::stability::stiffness;

/// How much a fixed step damps the nutation, and a step that is short enough.
pub(crate) struct Guard {
    pub loss: f64,
    /// The largest step, rounded down to three digits, that damps the nutation by less than a thousandth and gives no
    /// warning.
    pub advice: f64,
    pub coarse: bool,
}

impl Default for Guard {
    fn default() -> Self {
        Self { loss: 0.0, advice: f64::INFINITY, coarse: false }
    }
}

/// Estimates how much steps of length `step` damp the nutation. Returns an error if the step is too long for the
/// nutation or the precession.
pub(crate) fn guard(
    course: &Course<'_>,
    swing: Option<&Swing>,
    limits: &Limits,
    step: f64,
) -> Result<Guard, Error> {
    let span = course.span.abs();
    let way = course.way();
    let frequency = |y: &State| stiffness(limits.contact, &limits.body, y).max(0.0).sqrt();
    let (mut fastest, mut turning, mut sixth, mut whole) = (0f64, 0f64, 0.0, 0.0);
    let mut too_fast: Option<(f64, f64)> = None;
    let mut consider = |time: f64, y: &State, weight: f64| {
        let (w, turn) = (frequency(y), y.precession().abs());
        fastest = fastest.max(w);
        turning = turning.max(turn);
        sixth += weight * w.powi(6);
        let earlier = too_fast.is_none_or(|(t, _)| time < t);
        if (step * turn > 1.0 || step * w > 2.5) && earlier {
            too_fast = Some((time, y.theta));
        }
    };
    consider(0.0, course.start, 0.0);
    if let Some(swing) = swing {
        // Only nodes that the motion reaches before its end count.
        let end = first_event(swing, limits, way).map_or(span, |e| e.time.abs().min(span));
        for (place, weight) in swing.nodes() {
            if let Some(time) = swing.time_to_place(way, place).filter(|t| *t <= end) {
                consider(time, &swing.rising_state(place), weight);
                whole += weight;
            }
        }
    }
    // The mean over time. Without an exact solution the frequency is that at the start.
    let sixth = if whole > 0.0 { sixth / whole } else { fastest.powi(6) };
    let loss = |h: f64| span * h.powi(5) * sixth / 144.0;
    let patient = (144e-3 / (span * sixth)).powf(0.2);
    let advice = rounded_down(patient.min(0.5 / fastest).min(0.3 / turning));
    if let Some((time, theta)) = too_fast {
        return Err(Error::Step { step, time: course.t0 + way * time, theta, advice });
    }
    let coarse = loss(step) > 1e-3 || step * fastest > 0.5 || step * turning > 0.3;
    Ok(Guard { loss: loss(step).min(1.0), advice, coarse })
}

/// Rounds down to three digits, so that the step that the error message recommends passes the check.
fn rounded_down(x: f64) -> f64 {
    let unit = 10f64.powf(x.log10().floor() - 2.0);
    if unit.is_normal() { (x / unit).floor() * unit } else { x }
}
