//! A short hop: a body that has just risen from a landing of two unequal rims, and falls back soon.
//!
//! ```text
//! chi' = w2,   chi = theta_end - theta;   w', u' at the inclination;   T > 0 with chi(T) = 0
//! ```
//! The largest chi is w2^2/(2 gamma). If this is as small as the rounding of theta, theta cannot describe the hop.
//! Therefore chi itself is the variable, and the hop is one step of the Runge-Kutta method.
//!
//! Error: the fifth power of the duration of the hop.

use super::super::body_walk::BodyWalk;
use super::super::own::Own;
use crate::laws::contact::standstill::Standstill;
use crate::laws::loss::Law;
use crate::laws::state::{State, spin_of};
use crate::motions::Ending;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, PHI, SIN, TIME, U2, UH, W1, W2, W3, contact_velocity, loses, pose_rates, poses,
    pull,
};
use crate::motions::walk::{Next, Phases};

/// A hop is short if its first w2 is below this, and its duration below `SOON`.
const SHORT_HOP: f64 = 1e-4;
const SOON: f64 = 3e-3;
/// If hops follow each other without an advance of time, a hop with a w2 below this is skipped as an error, which is
/// `HOPS_ON` times its w2.
const LOST_RISE: f64 = 1e-6;
const HOPS_ON: f64 = 10.0;
/// A slip lasts throughout a hop if it is at least this many times the change of velocity by friction in the hop.
const OUTLASTS: f64 = 30.0;
/// Number of corrections in the search for the duration of a hop.
const CORRECTIONS: usize = 4;

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// Computes the current phase if it is a short hop of a body that has lain on two rims. Returns whether it is.
    #[inline(never)]
    pub(crate) fn hops_shortly(&mut self) -> bool {
        let (state, rises) = (self.of.state, self.at[W2]);
        let at_border = state.theta == self.of.body.theta_end() && self.has_two_rims();
        if !self.of.body.has_row() || !at_border || !(0.0..SHORT_HOP).contains(&rises) || rises == 0.0 {
            return false;
        }
        if rises < LOST_RISE && self.does_not_advance() {
            let [u, v] = self.at.slip();
            self.claims(HOPS_ON * rises + if u.hypot(v) < LOST_RISE { u.hypot(v) } else { 0.0 });
            let next = self.settles_on_side();
            self.continues_with(next);
            return true;
        }
        let pressed = self.ask.losses.coefficient(Law::RollingResistance) > 0.0;
        if self.ask.restitution.is_none() || pressed {
            return false;
        }
        let sticks = self.of.slide.law.dry && self.at.slip() == [0.0; 2];
        if sticks && Phases::rests(self) != Standstill::Sticks {
            return false;
        }
        (self.at[SIN], self.at[COS]) = self.of.body.border_angle();
        let begin = self.at;
        let falls = -self.hop_rates(&begin, 0.0, sticks)[W2];
        let mut lasts = 2.0 * rises / falls;
        let [u, v] = self.at.slip();
        let friction = (self.of.slide.law.strength + self.of.tilt.abs()) * lasts * OUTLASTS;
        if !(0.0..SOON).contains(&lasts) || !sticks && self.of.slide.law.dry && u.hypot(v) < friction {
            return false;
        }
        for _ in 0..CORRECTIONS {
            // chi/t falls through 0 at the end.
            let (y, chi) = self.hopped(&begin, lasts, sticks);
            let slope = (y[W2] - chi / lasts) / lasts;
            lasts -= chi / lasts / slope;
        }
        if !(0.0..SOON).contains(&lasts) {
            return false;
        }
        let now = begin[TIME];
        while let Some(t) = self.until().filter(|t| *t < now + lasts) {
            let (y, chi) = self.hopped(&begin, t - now, sticks);
            self.hops_to(y, chi);
            Phases::write_here(self);
        }
        let (y, _) = self.hopped(&begin, lasts, sticks);
        self.hops_to(y, 0.0);
        self.of.state.theta = self.of.body.theta_end();
        if !sticks {
            self.made.path.slipping += lasts;
        }
        self.continues_with(Next::Ends(Ending::Side));
        true
    }

    /// Sets the current state to the state vector `y` and theta to theta_end - `chi`.
    fn hops_to(&mut self, y: [f64; N], chi: f64) {
        self.at = y;
        self.of.state = State { theta: self.of.body.theta_end() - chi, w1: y[W1], w2: y[W2], w3: y[W3] };
    }

    /// The state vector at the time `t` of a hop, and chi = theta_end - theta.
    fn hopped(&self, begin: &[f64; N], t: f64, sticks: bool) -> ([f64; N], f64) {
        let moved =
            |by: f64, rates: &[f64; N]| -> [f64; N] { core::array::from_fn(|i| begin[i] + by * rates[i]) };
        // The rate of chi is w2.
        let first = self.hop_rates(begin, 0.0, sticks);
        let a = moved(0.5 * t, &first);
        let second = self.hop_rates(&a, 0.5 * t * begin[W2], sticks);
        let b = moved(0.5 * t, &second);
        let third = self.hop_rates(&b, 0.5 * t * a[W2], sticks);
        let d = moved(t, &third);
        let fourth = self.hop_rates(&d, t * b[W2], sticks);
        let mean: [f64; N] =
            core::array::from_fn(|i| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0);
        let chi = t * (begin[W2] + 2.0 * (a[W2] + b[W2]) + d[W2]) / 6.0;
        let mut y = moved(t, &mean);
        (y[SIN], y[COS]) = self.hop_angle(chi);
        y[TIME] = begin[TIME] + t;
        (y, chi)
    }

    fn hop_angle(&self, chi: f64) -> (f64, f64) {
        let ((s, c), (sin, cos)) = (self.of.body.border_angle(), chi.sin_cos());
        (s * cos - c * sin, c * cos + s * sin)
    }

    /// The time derivative of the state vector at the inclination theta_end - `chi`, except that of the inclination.
    pub(super) fn hop_rates(&self, y: &[f64; N], chi: f64, sticks: bool) -> [f64; N] {
        self.rates_on_rim(self.hop_angle(chi), self.of.body.theta_end() - chi, y, sticks)
    }

    /// The time derivative of the state vector on one rim at this inclination, except that of the inclination.
    pub(crate) fn rates_on_rim(&self, angle: (f64, f64), theta: f64, y: &[f64; N], sticks: bool) -> [f64; N] {
        let (w, slip) = (y.w(), y.slip());
        let mut all = [0.0; N];
        let (rate, drift, warms, taken) = if sticks {
            let (rate, taken) = self.rolling_at(y, &State { theta, w1: w[0], w2: w[1], w3: w[2] });
            (rate, [0.0; 2], 0.0, taken)
        } else {
            let (at, taken) = self.of.slide.slips(angle, w, slip, None);
            let ([u_h, u_2], [pull_h, pull_2]) = (at.u, pull(self.of.tilt, y));
            let drift = if self.of.tilt == 0.0 { at.u } else { [u_h + pull_h, u_2 + pull_2] };
            (at.w, drift, -(at.force[1] * slip[1] + at.force[2] * slip[0]), taken)
        };
        (all[W1], all[W2], all[W3]) = (rate[0], rate[1], rate[2]);
        (all[UH], all[U2], all[HEAT]) = (drift[0], drift[1], warms);
        if loses(N) {
            all[N - 1] = taken;
        }
        if poses(N) {
            let spin = spin_of(angle, w[0], w[2]);
            let over = contact_velocity(&self.of.slide.law.shape.rim, angle, w[1], spin, slip);
            all[PHI..PHI + 4].copy_from_slice(&pose_rates(y[PHI].sin_cos(), [w[0] / angle.0, spin], over));
        }
        all
    }
}
