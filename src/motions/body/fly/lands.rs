//! Finds the first landing of a rim in a flight, with bounds by which no landing is missed.
//!
//! ```text
//! height of a rim   h = z - (l c + a s + rho)           k = 0 for the rim that was down last, then for the others
//! h'' <= K = Lam^2 (|l| sin a sin b + a sin b) - 1     at all times, also where theta passes a pole
//! no landing in [t1, t2]    if the least value of chord - K (t - t1)(t2 - t)/2 is positive
//! one landing               if h(t1) > 0 >= h(t2) and h'(t1) + K (t2 - t1) < 0
//! no landing after          z falls below the least height of a landing: 0 with several rims, else min(0, rho - |l|)
//! ```
//! Circles that smooth joints connect are one rim, whose height at an inclination is that of the lowest of these
//! circles. At a joint the heights of both circles agree, and so do their slopes. The bound is one-sided: s is the
//! length of the horizontal part x of e3, so that s s'' >= x.x'' and s'' >= -Lam^2 sin b, while s'' has no upper
//! bound. A time interval for which neither "no landing" nor "one landing" is proved is halved. The height of a rim
//! that touches at the start grows as t^k: k = 1 after a bounce, 2 where a contact at rest loses its normal force, 3
//! where the normal force of a slip vanishes. For a rim that touches at the start a power series, divided by t^k,
//! gives the height.
//!
//! Error: that of h divided by the normal velocity; a rim that only grazes the table lands where h is a rounding error.

use super::{Aloft, FirstLanding, Flies, Flight};
use crate::laws::body::{MOST_CIRCLES, Rim};
use crate::methods::falling::{Falling, first_zero_of_powers};
use crate::methods::flow::{Exhausted, Steps};
use crate::motions::walk::hops::{HARDLY, Leaves, terms_until};

/// Number of terms of the power series of a rim's height at the start of a flight.
pub(super) const RIM_TERMS: usize = 30;
/// An inclination this close to a smooth joint of two circles, in radians, counts as at the joint: the heights of
/// both circles agree to the square of this angle.
const JOINED: f64 = 1e-6;
pub(crate) const TOUCH: f64 = 1e-15;

/// Sine and cosine of theta as power series in the time since the start.
pub(super) type AngleSeries = [[f64; RIM_TERMS]; 2];

impl Flight {
    /// Height and vertical velocity of the lowest point of a rim. The height is the sum of the initial height and its
    /// change, which keeps the digits of a small change.
    fn rim(&self, k: usize, t: f64) -> [f64; 2] {
        let ([cosine, cosine_rate], (s0, c0)) = (self.cosine(t), self.from.angle);
        let (s, c) = self.angle_of(t, cosine);
        let (rim, began) = (self.rim_at(k, c), self.rim_at(k, c0));
        let sine_rate = if s > 0.0 { -(c * cosine_rate / s) } else { 0.0 };
        // A body that stays upright, as one that is dropped flat, has no sine at all.
        let sine = if s + s0 > 0.0 { -(cosine * (c + c0) / (s + s0)) } else { 0.0 };
        let first = self.height_at_start(k) + began.less(&rim).height(self.from.angle);
        let [.., up] = self.velocity;
        [first + t * (up - 0.5 * t) - rim.slope((sine, cosine)), up - t - rim.slope((sine_rate, cosine_rate))]
    }

    /// The lowest circle of the rim `k` at an inclination with this cosine.
    pub(super) fn rim_at(&self, k: usize, cosine: f64) -> Rim<f64> {
        self.landings.rims[self.landings.lowest(k, cosine)]
    }

    /// The height of the rim `k` over that from which the state is counted, at an inclination.
    pub(super) fn higher_by(&self, k: usize, angle: (f64, f64)) -> f64 {
        self.shape.rim.less(&self.rim_at(k, angle.1)).height(angle)
    }

    /// The height of the rim `k` at the start of the flight.
    pub(super) fn height_at_start(&self, k: usize) -> f64 {
        self.from.height + self.higher_by(k, self.from.angle)
    }

    fn lands_on(&self, k: usize, leaves: Leaves, until: f64) -> Result<Option<f64>, Exhausted> {
        let most =
            |of: &dyn Fn(&Rim<f64>) -> f64| self.landings.group(k).iter().map(of).fold(f64::MIN, f64::max);
        let [.., up] = self.velocity;
        let reach = most(&|rim| rim.ell.hypot(rim.a) + rim.rho);
        // The centre is low enough for a landing before `rises` and after `comes`. At `end` it is so low that a rim is
        // below the table, whatever the inclination: the centre of one rim may itself be below the table.
        let lowest =
            if self.landings.count > 1 { 0.0 } else { -most(&|rim| rim.ell.abs() - rim.rho).max(0.0) };
        let passes = |height: f64| {
            let square = up * up + 2.0 * (self.height - height);
            (square >= 0.0).then(|| (up - square.sqrt(), up + square.sqrt()))
        };
        let end = (passes(lowest).map_or(up, |(_, end)| end) + 1e-6).min(until);
        let (rises, comes) = passes(reach).unwrap_or((end, end));
        let swings = most(&|rim| rim.ell.abs() * self.wide + rim.a * self.b.sin());
        let bend = (self.rate * self.rate * swings - 1.0).max(1e-9);
        let touch = TOUCH * (1.0 + reach + self.height);
        let mut from = 0.0;
        if let Some(order) = leaves {
            let near = self.near(k);
            let found = self.leaves(k, order, near, &|near, terms| self.swung(near, terms))?;
            if found.is_some() {
                return Ok(found.filter(|t| *t <= until));
            }
            from = near;
        }
        let noise = touch + 4.0 * self.doubt_of_height(from);
        let mut falling = Falling { of: |t: f64| self.rim(k, t), bend, touch, noise };
        // While the centre is too high no rim lands.
        let parts = if rises > 0.0 {
            [(from, rises.min(end)), (comes.max(from), end)]
        } else {
            [(from, from), (comes.max(from), end)]
        };
        for (from, to) in parts {
            if to > from
                && let Some(t) = falling.first_zero(from, to)?
            {
                return Ok(Some(t));
            }
        }
        Ok(None)
    }

    /// The time up to which the power series of the height is used, for a rim that touches at the start.
    pub(super) fn near(&self, k: usize) -> f64 {
        let (s, sine) = (self.from.angle.0, self.b.sin());
        let near = if s > 0.0 && sine * self.rate > 0.0 && self.rim_at(k, self.from.angle.1).a > 0.0 {
            (0.4 * s / sine).ln_1p() / (3.0 * self.rate)
        } else {
            1.0 / (1.0 + self.rate)
        };
        // The series is that of one circle, which counts up to its joint.
        let joined =
            if k == 0 { self.landings.away_from_joint(self.from.angle).max(JOINED) } else { f64::INFINITY };
        near.min(joined / self.rate)
    }

    /// The landing up to the time `near` of a rim that touches at the start; time 0 if it does not leave the table,
    /// None if it does not land. `swung` gives the power series of the inclination.
    pub(super) fn leaves(
        &self,
        k: usize,
        order: usize,
        near: f64,
        swung: &dyn Fn(f64, usize) -> AngleSeries,
    ) -> Result<Option<f64>, Exhausted> {
        // A bounce that is over much earlier needs few terms, up to twice the time that the first two give.
        let first = self.heights(k, near, &swung(near, order + 2));
        let early = -(2.0 * first[order] / first[order + 1]);
        if let Some(terms) = terms_until(early, order) {
            let found = self.lands_near(k, order, early * near, (terms, swung))?;
            if found.is_some() {
                return Ok(found);
            }
        }
        self.lands_near(k, order, near, (RIM_TERMS, swung))
    }

    /// The landing of the rim `k` up to the time `near`, from the power series of its height divided by t to the
    /// power `order`.
    fn lands_near(
        &self,
        k: usize,
        order: usize,
        near: f64,
        (terms, swung): (usize, &dyn Fn(f64, usize) -> AngleSeries),
    ) -> Result<Option<f64>, Exhausted> {
        let heights = self.heights(k, near, &swung(near, terms));
        // A normal force that has just become negative is hardly larger than the errors of the numbers, as this term.
        let vanishes = k == 0 && order == 2 && heights[2] <= 0.0 && heights[2] > -HARDLY * near * near;
        let series = &heights[if vanishes { 3 } else { order }..terms];
        if series[0] <= 0.0 {
            return Ok(Some(0.0));
        }
        Ok(first_zero_of_powers(series, 1.0, f64::INFINITY)?.map(|x| x * near))
    }

    /// The power series of sine and cosine of theta, for a time in units of `near`.
    fn swung(&self, near: f64, terms: usize) -> AngleSeries {
        let ((s, c), [p, q]) = (self.from.angle, self.swing);
        let (mut cosines, mut sines) = ([0.0; RIM_TERMS], [0.0; RIM_TERMS]);
        let mut scale = 1.0;
        for k in 0..terms {
            cosines[k] = [p, -q, -p, q][k % 4] * scale;
            scale *= self.rate * near / (k + 1) as f64;
        }
        (cosines[0], sines[0]) = (c, s);
        // The height of a ball does not depend on s, which may be zero.
        let terms = if self.landings.rims.iter().any(|rim| rim.a > 0.0) { terms } else { 0 };
        if s == 0.0 {
            // At a pole s^2 begins with its second power.
            let squares: [f64; RIM_TERMS] =
                core::array::from_fn(|k| -(0..=k).map(|i| cosines[i] * cosines[k - i]).sum::<f64>());
            sines[1] = squares[2].max(0.0).sqrt();
            for k in 2..if sines[1] > 0.0 { terms - 1 } else { 0 } {
                let known: f64 = (2..k).map(|i| sines[i] * sines[k + 1 - i]).sum();
                sines[k] = (squares[k + 1] - known) / (2.0 * sines[1]);
            }
            return [sines, cosines];
        }
        // The coefficients of s from s^2 = 1 - c^2.
        for k in 1..terms {
            let square: f64 = (0..=k).map(|i| cosines[i] * cosines[k - i]).sum();
            let known: f64 = (1..k).map(|i| sines[i] * sines[k - i]).sum();
            sines[k] = -(square + known) / (2.0 * s);
        }
        [sines, cosines]
    }

    /// The power series of the height of a rim that touches at the start, for a time in units of `near`.
    fn heights(&self, k: usize, near: f64, [sines, cosines]: &AngleSeries) -> [f64; RIM_TERMS] {
        let rim = &self.rim_at(k, self.from.angle.1);
        let mut all = core::array::from_fn(|k| -rim.slope((sines[k], cosines[k])));
        // The first coefficient is the normal velocity, which is known without a difference.
        all[1] =
            near * if k == 0 { self.from.lift } else { self.from.on_other_rim(&[self.shape.rim, *rim]).lift };
        all[2] -= 0.5 * near * near;
        all
    }
}

impl Flies for Flight {
    fn lands(
        &mut self,
        leaves: [Leaves; MOST_CIRCLES],
        until: f64,
        _: Steps,
        _: &mut dyn FnMut() -> bool,
    ) -> Result<FirstLanding, Exhausted> {
        let mut first = None;
        for (i, leaves) in leaves.into_iter().enumerate().take(self.landings.count) {
            // Of two rims that land at the same time the first one counts; an impact looks at both.
            let until = first.map_or(until, |(t, _)| t);
            if let Some(t) = self.lands_on(i, leaves, until)?
                && first.is_none_or(|(before, _)| t < before)
            {
                first = Some((t, i));
            }
        }
        Ok(first)
    }

    fn at(&self, t: f64) -> (Aloft, f64) {
        (self.flown(t), 0.0)
    }

    fn free(&self) -> &Flight {
        self
    }
}
