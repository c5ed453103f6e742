//! The estimated error of an exact motion.
//!
//! ```text
//! error = |state'| doubt of the time + |dstate/dx| uncertainty of the ends + rounding
//! doubt of the time = uncertainty summed along the way from the start to now
//! ```
//! The rounding error of G is propagated into the time by the same quadrature as the time itself. Where the motion
//! lingers, most of this error cancels between time 0 and a time close to it; the rest grows by the same factor as
//! the motion departs. Where this rest is so large that the motion may have passed the unstable state instead of
//! turning, or the reverse, the error is the greatest possible difference of states.

use super::{LegPoint, Swing, SwingPhase};
use crate::numbers::larger_or_nan;

/// Parts of a motion with a smaller sin(theta) do not count in the growth of errors if the motion reaches a pole or a
/// face.
const NEAR_POLE: f64 = 1e-6;

impl Swing {
    /// Estimated error of the state at time `t`: the largest error of its four components.
    pub fn error(&self, t: f64) -> f64 {
        let ulp = 8.0 * f64::EPSILON;
        if self.is_steady() {
            return self.steady_error(t);
        }
        if t == 0.0 {
            return 0.0;
        }
        // The uncertainty of a landing is that of the motion just before.
        let t = self.landing(t).map_or(t, |(limit, _)| t.signum() * t.abs().min(limit * (1.0 - 1e-6)));
        let phase = self.phase_at(t);
        let at = self.point_on_stretch(phase.spot);
        let y = self.state_at(phase.spot, phase.time >= 0.0);
        let dy = self.contact.derivative(&self.body, &y);
        let doubt = self.time_doubt(&phase, t);
        let rate = [dy.theta, dy.w1, dy.w2, dy.w3].iter().fold(0f64, |a, x| larger_or_nan(a, x.abs()));
        let rate = larger_or_nan(rate, self.largest_difference(phase.spot, doubt));
        // The uncertainty of the ends moves the state along x.
        let [low, high] = self.lines.range();
        let part = ((at.x - low) / (high - low)).clamp(0.0, 1.0);
        let [at_low, at_high] = self.uncertainties_of_ends();
        let shift = (1.0 - part) * at_low + part * at_high;
        let [p, n] = self.lines.slope(&at);
        let along = (p / at.s).abs() + (at.p / at.s * at.c).abs() + n.abs() + at.s;
        let size = 1.0 + y.w1.abs().max(y.w2.abs()).max(y.w3.abs());
        let tilt = y.w2.abs() * (at.noise + (at_low + at_high) / (high - low));
        rate * doubt + along * shift + tilt + ulp * size
    }

    /// Estimated error of the time at which the motion reaches its state of time `t`.
    pub(crate) fn time_error(&self, t: f64) -> f64 {
        if self.is_steady() || t == 0.0 { 0.0 } else { self.time_doubt(&self.phase_at(t), t) }
    }

    /// Estimated error of the nutation's period, in sqrt(R/g); NaN without a period.
    pub fn period_error(&self) -> f64 {
        let period = self.period();
        if period.is_infinite() {
            return f64::NAN;
        }
        let doubt = if self.is_steady() {
            // The period of a steady state goes as the root of the curvature of G.
            let start = &self.lines.panels[0];
            let curvature = f64::EPSILON * self.lines.terms_at(0, 0.0) / (start.reach * start.reach);
            0.5 * period * (curvature / start.g[2]).abs()
        } else {
            2.0 * self.half_nutation.doubt
        };
        doubt + 64.0 * f64::EPSILON * period
    }

    /// Estimated error of the precession in a period, in radians; NaN without a period or without prepared angles.
    pub(crate) fn precession_error(&self) -> f64 {
        let Some([turn, _]) = self.turns_per_period() else { return f64::NAN };
        let doubt = if self.is_steady() {
            self.start.precession().abs() * self.period_error()
        } else {
            2.0 * self.half_nutation.turns_doubt[0]
        };
        doubt + 64.0 * f64::EPSILON * turn.abs()
    }

    /// Error of a steady state at time `t`: a rounding error, which grows exponentially if the state is unstable.
    fn steady_error(&self, t: f64) -> f64 {
        let [low, high] = self.lines.range();
        let size = 1.0 + self.start.w1.abs().max(self.start.w3.abs());
        let growth = if self.kappa < 0.0 { ((-self.kappa).sqrt() * t.abs()).exp() } else { 1.0 };
        size * (2.0 * f64::EPSILON + (high - low)) * growth
    }

    pub(super) fn time_doubt(&self, phase: &SwingPhase, t: f64) -> f64 {
        let unfolded = |periods: f64, time: f64, spot: LegPoint| {
            let doubt = self.legs[spot.leg].doubt(spot.v);
            2.0 * periods * self.half_nutation.doubt + if time < 0.0 { -doubt } else { doubt }
        };
        let now = unfolded(phase.periods, phase.time, phase.spot);
        let start = self.at_start;
        let gone = (now - unfolded(0.0, self.phase, start)).abs();
        // The place of the start is uncertain too.
        let leg = &self.legs[start.leg];
        let at = self.point_on_stretch(start);
        let [low, high] = self.lines.range();
        let [at_low, at_high] = self.uncertainties_of_ends();
        let nearer = |shift: f64, distance: f64| {
            if shift < at.noise * distance.abs() { shift / distance.abs() } else { at.noise }
        };
        let relative =
            if leg.stretch.is_whole() { nearer(at_low, -low) + nearer(at_high, high) } else { at.noise };
        let slow = at.s * at.s * self.inertia(&at).sqrt() * at.x_per_root;
        let placed = (relative + f64::EPSILON) * leg.stretch.stiffness(start.v) * slow;
        gone + placed + f64::EPSILON * (t.abs() + self.half_nutation.time)
    }

    /// Uncertainties of both ends of the swing, in x = ln tan(theta/2).
    fn uncertainties_of_ends(&self) -> [f64; 2] {
        [false, true].map(|upper| {
            if self.lines.reaches_pole()[usize::from(upper)] {
                return 0.0;
            }
            let end = self.end(upper);
            let stretch = &self.legs[end.leg].stretch;
            if stretch.is_whole() { self.point_on_stretch(end).noise } else { stretch.shift() + f64::EPSILON }
        })
    }

    /// Greatest difference between states within `doubt`, the uncertainty of the time, per unit of it; 0 where
    /// `doubt` is so small that the time derivative of the state suffices.
    fn largest_difference(&self, now: LegPoint, doubt: f64) -> f64 {
        let growth = self.lines.panels.iter().fold(0f64, |most, panel| {
            let (s, c) = self.lines.angle(panel.centre);
            // Landing on the face and passing the pole happen at full speed, without any growth of errors.
            if s < NEAR_POLE && self.lines.reaches_pole() != [false; 2] {
                return most;
            }
            larger_or_nan(most, panel.g[2] / (s.powi(4) * self.lines.law.inertia(|| (s, c))))
        });
        let growth = growth.sqrt() + 1.0 / self.half_nutation.time;
        if doubt * growth <= 0.05 {
            return 0.0;
        }
        let here = self.state_at(now, true);
        let mut most = 0f64;
        for (place, _) in self.nodes() {
            let there = self.rising_state(place);
            let tilts = there.w2.abs() + here.w2.abs();
            let off = [there.theta - here.theta, there.w1 - here.w1, tilts, there.w3 - here.w3];
            most = off.iter().fold(most, |a, x| larger_or_nan(a, x.abs()));
        }
        most * (20.0 * growth).min(1.0 / doubt)
    }
}
