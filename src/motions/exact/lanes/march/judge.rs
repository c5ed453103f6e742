//! The state at the end of a panel (a range of one power series), its rate of change, and its uncertainty.
//!
//! ```text
//! F       its rounding errors at this knot and at those before it, and the truncation of its series
//! time    quadrature error of the clock + time * (error of F)/(amp^2 W) + error of the place over the speed there
//! place   (rounding error, truncation of the series that vanishes and F's part in it)/(its slope) + Newton's error
//! ```
//! The head of [`march`](super) has the panels. These are bounds of the terms, not of their sum; in the tests of
//! `many_ends` they are never below half the true error.

use super::clock::PanelClock;
use super::{
    EventInProgress, Knot, March, Met, PanelEvent, PanelSeries, TurningPlaces, here, press, where_event_is,
};
use crate::laws::contact::FLAT;
use crate::motions::exact::lanes::series::{
    angle_at, change_of_theta, normalized, slope_bound, truncation_bound,
};
use crate::numbers::Lane;
use crate::numbers::power::horner;

/// The state at the end of a panel, and its rates of change.
pub(super) struct JudgedState<T> {
    knot: Knot<T>,
    tilt: T,
    /// The moment of inertia J of the tilting theta' at that state.
    inertia: T,
    /// The derivative dtheta/dy at that state; the next fields are bounds of the slopes of w1, w3 and F in y on the
    /// way, and of the state's rate in time.
    per_y: T,
    slopes: [T; 3],
    rate: T,
}

impl<T: Lane> March<T> {
    /// The state that is reached, and its rate of change.
    #[inline(always)]
    pub(super) fn state_reached<const N: usize>(
        &self,
        knot: &Knot<T>,
        way: T,
        of: &PanelSeries<T, N>,
        clock: &PanelClock<'_, T, N>,
        reached: &EventInProgress<T>,
    ) -> JudgedState<T> {
        let number = here(
            #[inline(always)]
            |x: f64| way.splat(x),
        );
        let (zero, one, two) = (number(0.0), number(1.0), number(2.0));
        let (law, s, c) = (&self.law, knot.sin, knot.cos);
        let &EventInProgress { code, out, apart, .. } = reached;
        let y = out * way;
        let q = (y - (c + c)).fma(y, one);
        let (sin, cos) = normalized(angle_at(s, c, y, q));
        let inertia = law.inertia(|| (sin, cos));
        let force = where_event_is(code, PanelEvent::Turn, zero, clock.force(out, apart).max(zero));
        // The fall from here to the face increases w2 when the face lands.
        let left = number(2.0 * FLAT) * law.shape.rim.lever((sin, cos)).abs();
        let lies = law.inertia(|| (zero, cos.select_lt(zero, number(-1.0), one)));
        let tilt = where_event_is(code, PanelEvent::Face, (force + left) / lies, force / inertia).sqrt();
        let per_y = (s + s) / q;
        let slopes = [slope_bound(&of.w1, out), slope_bound(&of.w3, out), slope_bound(&of.force, out)];
        let [w1_slope, w3_slope, force_slope] = slopes;
        let y_rate = tilt / per_y;
        let rate = tilt + y_rate * (w1_slope + w3_slope) + force_slope / (two * inertia * per_y);
        let theta = knot.theta + change_of_theta(s, c, y);
        let doubt = knot.doubt;
        let knot = Knot { theta, sin, cos, w1: horner(&of.w1, y), w3: horner(&of.w3, y), force, doubt };
        JudgedState { knot, tilt, inertia, per_y, slopes, rate }
    }

    /// Adds the uncertainties to an event: rounding and truncation of F, and the error of the series whose zero is
    /// the event.
    #[inline(always)]
    pub(super) fn judged<const N: usize>(
        &self,
        knot: &Knot<T>,
        of: &PanelSeries<T, N>,
        ends: &TurningPlaces<T>,
        reached: &EventInProgress<T>,
        there: &JudgedState<T>,
        turn: [T; 2],
    ) -> Met<T> {
        let number = here(
            #[inline(always)]
            |x: f64| knot.sin.splat(x),
        );
        let (zero, one, two, half, never) = (number(0.0), number(1.0), number(2.0), number(0.5), number(9.0));
        let (law, angle) = (&self.law, (knot.sin, knot.cos));
        let &EventInProgress { code, out, miss, steep, time, late, weakest, .. } = reached;
        let &JudgedState { tilt, inertia, per_y, slopes: [w1_slope, w3_slope, force_slope], rate, .. } =
            there;
        // The larger speeds of both places count, since w1 grows towards small inclinations.
        let (most_w1, most_w3) =
            (knot.w1.abs().max(there.knot.w1.abs()), knot.w3.abs().max(there.knot.w3.abs()));
        // F at this knot has the roundings of the earlier panels as well. They are independent, so that their squares add.
        let noise = number(8.0 * f64::EPSILON) * self.size_of_terms(knot, [most_w1, most_w3]);
        let noise = noise.mac(noise, knot.doubt * knot.doubt).sqrt();
        let cut = truncation_bound(&of.force, out);
        let amp = half * (ends.high - ends.low);
        // If both ends are divided out, only the slope and the curvature of F are uncertain near the start.
        let both = number(1.5).select_lt(ends.is_low + ends.is_high, amp, amp * amp);
        let share = (noise / both + cut / (amp * amp)) / weakest;
        let late = late + time * share + number(4.0 * f64::EPSILON) * time;
        let which = where_event_is(code, PanelEvent::Slip, one, zero);
        let mut size = zero;
        for k in (0..N).rev() {
            size = size.fma(out, zero.select_lt(which, of.grip[k], of.press[k]).abs());
        }
        let left = zero.select_lt(which, truncation_bound(&of.grip, out), truncation_bound(&of.press, out));
        // An error of F at the knot is also an error of the forces.
        let error_of_press = press::error_of_press(law, angle, noise)
            * where_event_is(code, PanelEvent::Slip, two * (one + self.mu_square), one);
        let vanishing = (number(16.0 * f64::EPSILON) * size + left + error_of_press) / steep + miss;
        let on_side = number(4.0 * f64::EPSILON);
        let place = where_event_is(
            code,
            PanelEvent::Side,
            on_side,
            where_event_is(
                code,
                PanelEvent::LiftOff,
                vanishing,
                where_event_is(code, PanelEvent::Slip, vanishing, zero),
            ),
        );
        let late = late + zero.select_lt(place, place * per_y / tilt, zero);
        let blurred = noise + cut + force_slope * place;
        let at_end = (blurred / (two * inertia * tilt)).min((blurred / inertia).sqrt());
        // If a time is sought, the place follows from the phase, as precisely as the turning points are known.
        let timed =
            where_event_is(code, PanelEvent::Time, one, where_event_is(code, PanelEvent::Turn, one, zero));
        let tilt_off = zero.select_lt(timed, tilt * share, at_end);
        let place = zero.select_lt(timed, (noise + cut) / (two * amp * weakest), place);
        let off = place * (per_y + w1_slope + w3_slope)
            + tilt_off
            + truncation_bound(&of.w1, out)
            + truncation_bound(&of.w3, out)
            + number(8.0 * f64::EPSILON) * (one + most_w1 + most_w3);
        // When a spinning body lands, w1 = P/s has the absolute error of P's terms, which almost cancel, divided by s. So has
        // the precession w1/s on the way.
        let turning = knot.w1.abs() * knot.sin + most_w3;
        let least = knot.sin.min(there.knot.sin);
        let slack = number(8.0 * f64::EPSILON) * turning / (least * least);
        let fastest = (knot.w1 / knot.sin).abs().max((there.knot.w1 / there.knot.sin).abs());
        let turn = [turn[0], turn[1] + slack * time + two * fastest * late];
        let left = number(4.0 * f64::EPSILON) * turning / there.knot.sin;
        let off = off + where_event_is(code, PanelEvent::Face, left, zero);
        // A motion that has ended at its start has no error.
        let over =
            where_event_is(code, PanelEvent::LiftOff, one, where_event_is(code, PanelEvent::Slip, one, zero));
        let begun = out.select_lt(number(f64::MIN_POSITIVE), over, zero);
        let known = here(
            #[inline(always)]
            |x: T| zero.select_lt(begun, zero, x),
        );
        let (time, late, off) = (known(time), known(late), known(off));
        // A result that is not a number gets the code of an unknown event.
        let fine = (zero * (late + off + time) + zero).select_lt(one, weakest, number(-1.0));
        let code = zero.select_lt(fine, code, zero.select_lt(begun, code, never));
        let knot = Knot { doubt: noise + cut, ..there.knot };
        Met { code, time, late, off, rate, tilt, turn, knot }
    }
}
