//! Where a panel comes to, how fast the state changes there, and what is not known of it.
//!
//! ```text
//! F       known to its rounding at the knot, and to what its series leaves out
//! time    what the rule of the clock leaves + time * (what is not known of F, over amp^2 W) + what the place adds
//! place   of what vanished: its rounding, what its series leaves out, F's share of it, over its slope; + Newton's miss
//! ```
//! [`march`](super) has the panels. Error: these are bounds of the terms, not of their sum; in the tests of `ends` they are never
//! below half the true one.

use super::super::series::{angle, ending, horner, steepness, turned, unit};
use super::clock::PanelClock;
use super::{Between, Comes, Knot, March, Met, PanelSeries, Reached, here, is, press};
use crate::contact::FLAT;
use crate::number::Lane;

/// Where that is.
pub(super) struct JudgedState<T> {
    knot: Knot<T>,
    tilt: T,
    /// J there.
    jay: T,
    /// The most that theta, w1, w3 and F change with y on the way; that the state changes with time.
    per_y: T,
    slopes: [T; 3],
    rate: T,
}

impl<T: Lane> March<T> {
    /// The state that is reached, and how fast it changes.
    #[inline(always)]
    pub(super) fn there<const N: usize>(
        &self,
        knot: &Knot<T>,
        way: T,
        of: &PanelSeries<T, N>,
        clock: &PanelClock<'_, T, N>,
        reached: &Reached<T>,
    ) -> JudgedState<T> {
        let number = here(
            #[inline(always)]
            |x: f64| way.splat(x),
        );
        let (zero, one, two) = (number(0.0), number(1.0), number(2.0));
        let (law, s, c) = (&self.law, knot.sin, knot.cos);
        let &Reached { code, out, .. } = reached;
        let y = out * way;
        let q = (y - (c + c)).fma(y, one);
        let (sin, cos) = unit(angle(s, c, y, q));
        let jay = law.inertia(|| (sin, cos));
        let force = is(code, Comes::Turn, zero, clock.force(out).max(zero));
        // what is left to the face adds to the tilting there
        let left = number(2.0 * FLAT) * law.shape.rim.lever((sin, cos)).abs();
        let lies = law.inertia(|| (zero, cos.select_lt(zero, number(-1.0), one)));
        let tilt = is(code, Comes::Face, (force + left) / lies, force / jay).sqrt();
        let per_y = (s + s) / q;
        let slopes = [steepness(&of.w1, out), steepness(&of.w3, out), steepness(&of.force, out)];
        let [w1_slope, w3_slope, force_slope] = slopes;
        let y_rate = tilt / per_y;
        let rate = tilt + y_rate * (w1_slope + w3_slope) + force_slope / (two * jay * per_y);
        let theta = knot.theta + turned(s, c, y);
        let knot = Knot { theta, sin, cos, w1: horner(&of.w1, y), w3: horner(&of.w3, y), force };
        JudgedState { knot, tilt, jay, per_y, slopes, rate }
    }

    /// What is not known of that: F, by rounding and by what its series leaves out; and what vanished.
    #[inline(always)]
    pub(super) fn judged<const N: usize>(
        &self,
        knot: &Knot<T>,
        of: &PanelSeries<T, N>,
        ends: &Between<T>,
        reached: &Reached<T>,
        there: &JudgedState<T>,
        turn: T,
    ) -> Met<T> {
        let number = here(
            #[inline(always)]
            |x: f64| knot.sin.splat(x),
        );
        let (zero, one, two, half, never) = (number(0.0), number(1.0), number(2.0), number(0.5), number(9.0));
        let (law, angle) = (&self.law, (knot.sin, knot.cos));
        let &Reached { code, out, miss, steep, time, late, weakest } = reached;
        let &JudgedState { tilt, jay, per_y, slopes: [w1_slope, w3_slope, force_slope], rate, .. } = there;
        // at whichever end of the way its terms are the larger: towards small inclinations w1 grows
        let (most_w1, most_w3) =
            (knot.w1.abs().max(there.knot.w1.abs()), knot.w3.abs().max(there.knot.w3.abs()));
        let noise = number(12.0 * f64::EPSILON) * self.sizes(knot, [most_w1, most_w3]);
        let cut = ending(&of.force, out);
        let amp = half * (ends.high - ends.low);
        // with both ends divided out, about the start itself, only the slope and the curvature of F are uncertain
        let both = number(1.5).select_lt(ends.is_low + ends.is_high, amp, amp * amp);
        let share = (noise / both + cut / (amp * amp)) / weakest;
        let late = late + time * share + number(4.0 * f64::EPSILON) * time;
        let which = is(code, Comes::Slip, one, zero);
        let mut size = zero;
        for k in (0..N).rev() {
            size = size.fma(out, zero.select_lt(which, of.grip[k], of.press[k]).abs());
        }
        let left = zero.select_lt(which, ending(&of.grip, out), ending(&of.press, out));
        // what is not known of F at the knot is not known of the forces either
        let blur = press::blur(law, angle, noise) * is(code, Comes::Slip, two * (one + self.mu_square), one);
        let vanishing = (number(16.0 * f64::EPSILON) * size + left + blur) / steep + miss;
        let on_side = number(4.0 * f64::EPSILON);
        let place = is(
            code,
            Comes::Side,
            on_side,
            is(code, Comes::LiftOff, vanishing, is(code, Comes::Slip, vanishing, zero)),
        );
        let late = late + zero.select_lt(place, place * per_y / tilt, zero);
        let blurred = noise + cut + force_slope * place;
        let at_end = (blurred / (two * jay * tilt)).min((blurred / jay).sqrt());
        // at a time the place is known with its phase: as well as the turning points are
        let timed = is(code, Comes::Time, one, is(code, Comes::Turn, one, zero));
        let tilt_off = zero.select_lt(timed, tilt * share, at_end);
        let place = zero.select_lt(timed, (noise + cut) / (two * amp * weakest), place);
        let off = place * (per_y + w1_slope + w3_slope)
            + tilt_off
            + ending(&of.w1, out)
            + ending(&of.w3, out)
            + number(8.0 * f64::EPSILON) * (one + most_w1 + most_w3);
        // a body that lands although it spins: of w1 = P/s as much is known there as of P, which its terms almost cancel
        let turning = knot.w1.abs() * knot.sin + most_w3;
        let left = number(4.0 * f64::EPSILON) * turning / there.knot.sin;
        let off = off + is(code, Comes::Face, left, zero);
        // what has ended at its start is known
        let over = is(code, Comes::LiftOff, one, is(code, Comes::Slip, one, zero));
        let begun = out.select_lt(number(f64::MIN_POSITIVE), over, zero);
        let known = here(
            #[inline(always)]
            |x: T| zero.select_lt(begun, zero, x),
        );
        let (time, late, off) = (known(time), known(late), known(off));
        // no number, no answer
        let fine = (zero * (late + off + time) + zero).select_lt(one, weakest, number(-1.0));
        let code = zero.select_lt(fine, code, zero.select_lt(begun, code, never));
        Met { code, time, late, off, rate, tilt, turn, knot: there.knot }
    }
}
