//! One motion in lanes: its times side by side. The quick way, for what is neither wide nor ended by
//! anything.

use super::{Grip, Midpoints, Swings};
use crate::body::{Body, Shape};
use crate::contact::Contact;
use crate::contact::reduced::Reduced;
use crate::number::LANES;
use crate::state::State;
use core::f64::consts::PI;
use fearless_simd::{Level, Simd, SimdBase, f64x8};
use std::sync::LazyLock;

/// Terms in y and in u: enough for swings a quarter as wide as the series reach.
const TERMS: usize = 20;
const PARTS: usize = 16;

static POINTS: LazyLock<Midpoints<PARTS>> = LazyLock::new(Midpoints::new);

/// A motion, and what is asked of it.
pub(crate) struct Asked<'a> {
    pub contact: Contact,
    pub body: &'a Body,
    pub start: &'a State,
    /// Since the start.
    pub times: &'a [f64],
    pub mu: f64,
    pub tol: f64,
}

/// Adds the states at the times, and tells their estimated error, if that is at most `tol` and the motion
/// surely stays in the model up to the last of them: no other rim lands, N > 0, no more friction than `mu` is
/// needed.
pub(crate) fn quick(asked: &Asked<'_>, states: &mut Vec<State>) -> Option<f64> {
    // the kind of the rim is a constant: each is compiled by itself
    if asked.body.is_sharp() || asked.contact == Contact::Smooth {
        on_rim::<false>(asked, states)
    } else {
        on_rim::<true>(asked, states)
    }
}

fn on_rim<const ROUND: bool>(asked: &Asked<'_>, states: &mut Vec<State>) -> Option<f64> {
    match crate::number::level() {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx512(simd) => simd.vectorize(
            #[inline(always)]
            || answer::<_, ROUND>(simd, asked, states),
        ),
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx2(simd) => simd.vectorize(
            #[inline(always)]
            || answer::<_, ROUND>(simd, asked, states),
        ),
        #[cfg(target_arch = "aarch64")]
        Level::Neon(simd) => simd.vectorize(
            #[inline(always)]
            || answer::<_, ROUND>(simd, asked, states),
        ),
        _ => None,
    }
}

#[inline(always)]
fn answer<S: Simd, const ROUND: bool>(simd: S, asked: &Asked<'_>, states: &mut Vec<State>) -> Option<f64> {
    let &Asked { contact, body, start, times, mu, tol } = asked;
    let number = |x: f64| <f64x8<S> as SimdBase<S>>::splat(simd, x);
    let shape = Shape::of([number(body.ell()), number(body.i1()), number(body.i3()), number(body.fillet())]);
    let law = Reduced::of(contact, &shape, ROUND);
    let y = [number(start.theta), number(start.w1), number(start.w2), number(start.w3)];
    let swing = Swings::<f64x8<S>, TERMS, PARTS>::near(&POINTS, law, y);
    let last = number(*times.last()?);
    let (_, error, _) = swing.state(last);
    // the error grows with time
    if error[0] > tol || error[0].is_nan() {
        return None;
    }
    let [_, high] = swing.inclinations(last);
    let grip = |grip: Grip| swing.least(grip, last, true)[0];
    if (body.theta_max() < PI && high[0] >= body.theta_max())
        || grip(Grip::Normal) <= 0.0
        || (mu.is_finite() && -grip(Grip::Friction) >= mu)
    {
        return None;
    }
    let mut worst = error[0];
    for some in times.chunks(LANES) {
        let mut t = [some[0]; LANES];
        t[..some.len()].copy_from_slice(some);
        let ([theta, w1, w2, w3], error, _) = swing.state(f64x8::from_slice(simd, &t));
        for k in 0..some.len() {
            // the start is known
            let y = State { theta: theta[k], w1: w1[k], w2: w2[k], w3: w3[k] };
            states.push(if t[k] == 0.0 { *start } else { y });
            worst = if error[k] <= worst { worst } else { error[k] };
        }
    }
    (worst <= tol).then_some(worst)
}
