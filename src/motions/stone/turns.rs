//! The reversals of the spin of a stone, and their times.
//!
//! ```text
//! reversal   the spin s = n.w has passed zero and reached a tenth of its initial value, in the other direction
//! step       bounds of s from cubics through the ends and three stages of the step; if zero or that tenth lies
//!            within twice their range, the step is halved until the cubic through both ends has an error
//!            of at most 1e-4 of that tenth
//! ```
//! In this way no reversal within a step is missed. Error of the time of a reversal: the error of the cubic over the
//! derivative of the spin.

use crate::methods::search::crossing;
use crate::numbers::Dual;

/// The spin of a stone at a time, and its time derivative.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spot {
    pub t: f64,
    pub spin: Dual<f64>,
}

/// The reversals of the spin of a stone so far.
#[derive(Debug, Clone)]
pub(crate) struct Reversals {
    /// The spin in the other direction that completes a reversal; infinite if the initial spin is zero.
    pub enough: f64,
    /// The sign of the initial spin, or of the spin after the last reversal.
    side: f64,
    /// The time of the last zero of the spin.
    crossed: f64,
    /// For each reversal, the time at which the spin is zero, and that at which it reaches `enough`.
    pub times: Vec<[f64; 2]>,
}

/// A spin in the other direction completes a reversal when it reaches this share of the initial spin. A
/// smaller share would count oscillations of the spin around zero.
const COUNTS: f64 = 0.1;
/// An initial spin below this share of the largest angular velocity, or of 1, counts as zero: it has no
/// direction, and no reversals are counted.
const NONE: f64 = 1e-12;
/// Allowed error of the cubic that approximates the spin, as a share of the spin `enough`. A larger error would shift
/// the times of reversals.
const CUBIC: f64 = 1e-4;
/// Largest number of halvings of a step in the search for a reversal.
const STEP_HALVINGS: u32 = 12;

impl Reversals {
    /// Begins to count reversals, from the initial spin and the largest angular velocity.
    pub fn of(spin: f64, fastest: f64) -> Self {
        let none = spin.abs() <= NONE * fastest.max(1.0);
        let enough = if none { f64::INFINITY } else { COUNTS * spin.abs() };
        Self { enough, side: spin.signum(), crossed: f64::NAN, times: Vec::new() }
    }

    /// Whether the spin may reach zero or complete a reversal between these points, whose spins have the error
    /// `known`.
    pub fn near(&self, spots: &[Spot], known: f64) -> bool {
        if self.enough == f64::INFINITY {
            return false;
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for pair in spots.windows(2) {
            let [Spot { t, spin: a }, Spot { t: later, spin: b }] = [pair[0], pair[1]];
            let bulge = 0.3 * (later - t) * (a.slope.abs() + b.slope.abs());
            low = low.min(a.value.min(b.value) - bulge);
            high = high.max(a.value.max(b.value) + bulge);
        }
        let slack = 0.5 * (high - low) + known;
        let within = |x: f64| low - slack <= x && x <= high + slack;
        within(0.0) || within(-self.side * self.enough)
    }

    /// Counts the reversals between two points of the motion; `at` returns the spin at a time.
    pub fn follow(&mut self, at: &dyn Fn(f64) -> Spot, from: Spot, to: Spot) {
        self.halved(at, from, to, STEP_HALVINGS);
    }

    fn halved(&mut self, at: &dyn Fn(f64) -> Spot, from: Spot, to: Spot, halvings: u32) {
        let middle = at(0.5 * (from.t + to.t));
        let off = (cubic(from, to, 0.5) - middle.spin.value).abs();
        let more = off > CUBIC * self.enough && halvings > 0 && from.t < middle.t && middle.t < to.t;
        for (a, b) in [(from, middle), (middle, to)] {
            if more {
                self.halved(at, a, b, halvings - 1);
            } else {
                self.along(a, b);
            }
        }
    }

    /// Counts the reversals of the cubic between two points of the motion, which is monotonic between its extrema.
    pub fn along(&mut self, from: Spot, to: Spot) {
        if self.enough == f64::INFINITY {
            return;
        }
        let h = to.t - from.t;
        let (a, b) = (from.spin, to.spin);
        let (rise, last, change) = (h * a.slope, h * b.slope, b.value - a.value);
        // The slope of the cubic is rise + 2 x p + 3 x^2 q.
        let (p, q) = (3.0 * change - 2.0 * rise - last, rise + last - 2.0 * change);
        let mut ends = [0.0, 0.0, 0.0, 1.0];
        let root = p * p - 3.0 * q * rise;
        if root > 0.0 {
            let far = -(p + root.sqrt().copysign(p));
            let mut extrema = [far / (3.0 * q), rise / far];
            extrema.sort_by(f64::total_cmp);
            for (to, x) in ends[1..3].iter_mut().zip(extrema) {
                *to = if 0.0 < x && x < 1.0 { x } else { 0.0 };
            }
            ends[1..3].sort_by(f64::total_cmp);
        }
        let value = |x: f64| if x == 1.0 { b.value } else { cubic(from, to, x) };
        for pair in ends.windows(2).filter(|pair| pair[0] < pair[1]) {
            let [begin, end] = [pair[0], pair[1]];
            let [first, then] = [value(begin), value(end)];
            if (first < 0.0) != (then < 0.0) {
                self.crossed = from.t + h * crossing(value, begin, end, first, then);
            }
            if then * self.side < -self.enough {
                let level = -self.side * self.enough;
                let counts = crossing(|x| value(x) - level, begin, end, first - level, then - level);
                self.side = -self.side;
                self.times.push([self.crossed, from.t + h * counts]);
            }
        }
    }
}

/// The cubic with the spins and derivatives of two points of the motion, at the share `x` of the time between them.
fn cubic(Spot { t, spin: a }: Spot, Spot { t: later, spin: b }: Spot, x: f64) -> f64 {
    let (y, whole) = (1.0 - x, x * (1.0 - x) * (later - t));
    let (low, high) = (y * y * (1.0 + 2.0 * x), x * x * (1.0 + 2.0 * y));
    low * a.value + high * b.value + whole * (y * a.slope - x * b.slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the times of the reversals of a spin over one step.
    fn over(spin: impl Fn(f64) -> f64, last: f64) -> Vec<f64> {
        let at = |t: f64| {
            let slope = (spin(t + 1e-6) - spin(t - 1e-6)) / 2e-6;
            Spot { t, spin: Dual { value: spin(t), slope } }
        };
        let mut turns = Reversals::of(spin(0.0), 0.0);
        turns.follow(&at, at(0.0), at(last));
        turns.times.into_iter().map(|[crossed, _]| crossed).collect()
    }

    #[test]
    fn reversals_within_one_step_are_found() {
        let zeros = over(f64::cos, 12.0);
        assert_eq!(zeros.len(), 4);
        for (k, zero) in zeros.into_iter().enumerate() {
            assert!((zero - core::f64::consts::PI * (0.5 + k as f64)).abs() < 1e-4, "{zero}");
        }
        // The spin passes zero three times before the reversal is complete: the last of these
        // zeros is its time.
        let thrice = over(|t| 0.05 * (1.0 - t) * (2.0 - t) * (3.0 - t), 4.5);
        assert!(thrice.len() == 1 && (thrice[0] - 3.0).abs() < 1e-4, "{thrice:?}");
        // A spin that reaches less than a tenth in the other direction is no reversal; a little more is one.
        assert!(over(|t| (t - 1.0) * (t - 1.0) - 0.0909, 1.2).is_empty());
        assert_eq!(over(|t| (t - 1.0) * (t - 1.0) - 0.091, 1.2).len(), 1);
    }
}
