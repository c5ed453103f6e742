//! The first zero of a falling function whose second derivative has an upper bound; none is missed.
//!
//! ```text
//! no zero in [a, b]     if the least value of chord - K (t - a)(b - t)/2 is positive,   f'' <= K
//! one zero              if f(a) > 0 >= f(b) and f'(a) + K (b - a) < 0
//! ```
//! An interval in which neither condition holds is halved. Error of the zero: that of the function over its slope.

use super::flow::Exhausted;

/// An interval in which the function is below `touch` counts as a zero if it is shorter than this, in units of the time
/// since the start.
const SHORT_CELL: f64 = 1e-9;
/// Largest number of evaluations of the function.
const HEIGHTS: u32 = 1_000_000;

/// A function of time and its derivative, with an upper bound `bend` of the second derivative and with its rounding error.
pub(crate) struct Falling<F: FnMut(f64) -> [f64; 2]> {
    pub of: F,
    pub bend: f64,
    pub touch: f64,
    pub noise: f64,
}

impl<F: FnMut(f64) -> [f64; 2]> Falling<F> {
    /// The first zero in [from, to]; None if there is none. The function is known to be positive up to `from`. Returns
    /// an error if it is negative at `from`, and after too many evaluations.
    pub fn first_zero(&mut self, from: f64, to: f64) -> Result<Option<f64>, Exhausted> {
        let (mut t, [mut here, mut rate]) = (from, (self.of)(from));
        if here <= 0.0 {
            return if here >= -self.noise { Ok(Some(from)) } else { Err(Exhausted::Evaluations) };
        }
        let (mut ends, mut count) = (vec![to], 0);
        while let Some(&end) = ends.last() {
            count += 1;
            if count > HEIGHTS {
                return Err(Exhausted::Evaluations);
            }
            let [there, fall] = (self.of)(end);
            let wide = end - t;
            let tiny = wide < SHORT_CELL * end;
            if there > 0.0 {
                let tilt = (here - there) / (self.bend * wide);
                let low = if tilt.abs() >= 0.5 * wide {
                    here.min(there)
                } else {
                    0.5 * (here + there) - 0.5 * self.bend * (0.25 * wide * wide + tilt * tilt)
                };
                if low > 0.0 || tiny {
                    if low <= 0.0 && here.min(there) < self.touch {
                        return Ok(Some(end));
                    }
                    (t, here, rate) = (end, there, fall);
                    ends.pop();
                    continue;
                }
            } else if rate + self.bend * wide < 0.0 || tiny {
                return Ok(Some(self.root(t, end)));
            }
            ends.push(t + 0.5 * wide);
        }
        Ok(None)
    }

    /// The zero between two times, between which the function falls from positive to negative values.
    fn root(&mut self, mut low: f64, mut high: f64) -> f64 {
        let mut x = 0.5 * (low + high);
        for _ in 0..100 {
            let [value, slope] = (self.of)(x);
            if value > 0.0 {
                low = x;
            } else {
                high = x;
            }
            let newton = x - value / slope;
            let next = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
            if (next - x).abs() <= 0.5 * f64::EPSILON * x {
                break;
            }
            x = next;
        }
        x
    }
}

/// The first zero in [0, `to`] of a polynomial that is positive at 0, whose second derivative is at most `bend`.
pub(crate) fn first_zero_of_powers(series: &[f64], to: f64, bend: f64) -> Result<Option<f64>, Exhausted> {
    if to <= 0.0 {
        return Ok(None);
    }
    let power = |x: f64| {
        let value = series.iter().rev().fold(0.0, |sum, c| sum * x + c);
        let rate = (1..series.len()).rev().fold(0.0, |sum, k| sum * x + k as f64 * series[k]);
        [value, rate]
    };
    let bends = (2..series.len()).rev().fold(0.0, |sum, k| sum * to + (k * (k - 1)) as f64 * series[k].abs());
    let bend = bend.min(bends).max(1e-9 * series[0] / (to * to));
    Falling { of: power, bend, touch: 0.0, noise: 0.0 }.first_zero(0.0, to)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_that_begins_below_the_table_by_more_than_rounding_finds_no_landing() {
        let from = |height: f64| {
            let of = move |t: f64| [height - t, -1.0];
            Falling { of, bend: 1e-9, touch: 1e-15, noise: 1e-12 }.first_zero(0.0, 1.0)
        };
        assert!(from(-0.1).is_err() && from(-2e-12).is_err());
        assert_eq!(from(-1e-13).unwrap(), Some(0.0));
        assert!((from(0.1).unwrap().unwrap() - 0.1).abs() < 1e-15);
    }
}
