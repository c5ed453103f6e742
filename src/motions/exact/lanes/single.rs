//! One motion at eight times at once in SIMD lanes: the fast method for narrow swings without an event.

use super::turns::{PeriodAngleSeries, PeriodPoint};
use super::{Grip, Midpoints, Swings};
use crate::laws::body::Body;
use crate::laws::contact::Contact;
use crate::laws::contact::reduced::Reduced;
use crate::laws::pose::Pose;
use crate::laws::state::State;
use crate::numbers::{LANES, in_lanes, larger_or_nan, level};
use core::f64::consts::PI;
use fearless_simd::{Simd, SimdBase, f64x8};
use std::sync::LazyLock;

/// Number of terms of the power series in y; `MIDPOINTS_OF_ONE` is that of the series in u. They suffice for swings a
/// quarter as wide as the reach of the series.
const TERMS: usize = 20;
const MIDPOINTS_OF_ONE: usize = 16;

static POINTS: LazyLock<Midpoints<MIDPOINTS_OF_ONE>> = LazyLock::new(|| Midpoints::new(MIDPOINTS_OF_ONE));

/// A motion and the requested outputs.
pub(crate) struct QuickTask<'a> {
    pub contact: Contact,
    pub body: &'a Body,
    pub start: &'a State,
    /// Times since the start, ascending.
    pub times: &'a [f64],
    pub mu: f64,
    /// Greatest accepted error of a state; the next field is that of a pose, if poses are requested.
    pub tol: f64,
    pub pose: Option<f64>,
}

/// The states and poses, with the largest estimated errors among them.
#[derive(Default)]
pub(crate) struct QuickMotion {
    pub states: Vec<State>,
    pub poses: Vec<Pose>,
    pub error: f64,
    pub pose_error: f64,
}

/// Computes states and poses at the times, after those already found. Returns false unless their estimated errors are accepted and the motion
/// surely stays in the model up to the last time: no other rim lands, N > 0, and rolling needs no more friction than
/// `mu`.
pub(crate) fn roll_narrow_swing(asked: &QuickTask<'_>, found: &mut QuickMotion) -> bool {
    // The kind of the rim is a constant, so that each kind is compiled separately.
    if asked.body.is_sharp() || asked.contact == Contact::Smooth {
        on_rim::<false>(asked, found)
    } else {
        on_rim::<true>(asked, found)
    }
}

fn on_rim<const ROUND: bool>(asked: &QuickTask<'_>, found: &mut QuickMotion) -> bool {
    in_lanes!(level(), simd => compute_in_lanes::<_, ROUND>(simd, asked, found).is_some(), else false)
}

#[inline(always)]
fn compute_in_lanes<S: Simd, const ROUND: bool>(
    simd: S,
    asked: &QuickTask<'_>,
    found: &mut QuickMotion,
) -> Option<()> {
    let &QuickTask { contact, body, start, times, mu, tol, pose } = asked;
    let number = |x: f64| <f64x8<S> as SimdBase<S>>::splat(simd, x);
    let shape = body.shape().map(number);
    let law = Reduced::of(contact, &shape, ROUND);
    let y = [number(start.theta), number(start.w1), number(start.w2), number(start.w3)];
    let swing = Swings::<f64x8<S>, TERMS, MIDPOINTS_OF_ONE>::about_start(&POINTS, TERMS, law, y);
    let (last, span) = (*times.last()?, number(*times.last()?));
    // The last times come first, since the error grows with time.
    let (mut k, mut turns, before) = (times.len(), None, found.states.len());
    found.states.resize(before + k, *start);
    found.poses.resize(if pose.is_some() { before + k } else { 0 }, Pose::start());
    while k > 0 {
        let first = k.saturating_sub(LANES);
        let some = &times[first..k];
        let mut t = [last; LANES];
        t[..some.len()].copy_from_slice(some);
        let at = swing.phase_at(f64x8::from_slice(simd, &t));
        let ([theta, w1, w2, w3], error, _) = swing.state_at(f64x8::from_slice(simd, &t), &at);
        for (i, to) in found.states[before + first..before + k].iter_mut().enumerate() {
            // The state at time 0 is the given start.
            if t[i] != 0.0 {
                *to = State { theta: theta[i], w1: w1[i], w2: w2[i], w3: w3[i] };
            }
            found.error = larger_or_nan(found.error, error[i]);
        }
        if found.error > tol || found.error.is_nan() {
            return None;
        }
        if let Some(enough) = pose {
            let turns = turns.get_or_insert_with(
                #[inline(always)]
                || {
                    PeriodAngleSeries::of(
                        &swing,
                        &POINTS,
                        PeriodPoint::start(swing.start[0], swing.phase[0] >= 0.0),
                    )
                },
            );
            let late = swing.time_error_at(f64x8::from_slice(simd, &t), &at);
            for i in (0..some.len()).rev().filter(|i| t[*i] != 0.0) {
                let way = if at.since[i] < 0.0 { -1.0 } else { 1.0 };
                let spot = PeriodPoint {
                    periods: at.periods[i],
                    u: way * at.u[i],
                    cos: at.cos[i],
                    sin: way * at.sin[i],
                };
                let mut pose = turns.pose(&spot);
                if contact == Contact::Smooth {
                    pose.contact_point = Pose::contact_point_below_centre(
                        body,
                        start,
                        &found.states[before + first + i],
                        pose.phi.rest,
                    );
                }
                found.poses[before + first + i] = pose;
                found.pose_error =
                    larger_or_nan(found.pose_error, turns.error(&spot, t[i], late[i]) + found.error);
                if found.pose_error > enough || found.pose_error.is_nan() {
                    return None;
                }
            }
        }
        k = first;
    }
    let ([least, most], [low, high]) = (swing.inclinations(span), body.carries());
    if (high < PI && most[0] >= high)
        || (low > 0.0 && least[0] <= low)
        || swing.bound::<ROUND>(Grip::Normal, span) <= 0.0
        || (mu.is_finite() && -swing.bound::<ROUND>(Grip::Friction, span) >= mu)
    {
        return None;
    }
    Some(())
}
