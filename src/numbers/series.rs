//! Truncated power series in one variable; a [`Tape`](super::tape::Tape) computes those of the solution of an
//! equation.
//!
//! ```text
//! x(t) = a_0 + a_1 t + a_2 t^2 + ...
//! ```
//! Error: a few roundings of the largest term.

/// Largest number of coefficients of a truncated series.
pub(crate) const TERMS: usize = 18;

/// A truncated power series, by its coefficients of 1, t, t^2, ...
#[derive(Clone, Copy, Debug)]
pub(crate) struct Series {
    pub at: [f64; TERMS],
}

impl Series {
    /// The series of a constant.
    pub fn of(x: f64) -> Self {
        let mut at = [0.0; TERMS];
        at[0] = x;
        Self { at }
    }

    /// A series whose first `known` coefficients are those of `of`; the others are 0.
    pub fn first(of: &[f64; TERMS], known: usize) -> Self {
        let mut at = *of;
        at[known..].fill(0.0);
        Self { at }
    }

    /// The integral of the series from 0 on, plus the constant `x`.
    pub fn integral(&self, x: f64) -> Self {
        let over = |n: usize| self.at[n - 1] / n as f64;
        Self { at: core::array::from_fn(|n| if n == 0 { x } else { over(n) }) }
    }

    /// The value of the series at `t`.
    pub fn value(&self, t: f64) -> f64 {
        self.at.iter().rev().fold(0.0, |sum, a| sum * t + a)
    }

    /// The series of this function in powers of the distance from `t`.
    pub fn about(&self, t: f64) -> Self {
        let mut at = self.at;
        for k in 0..TERMS {
            for n in (k..TERMS - 1).rev() {
                at[n] += t * at[n + 1];
            }
        }
        Self { at }
    }

    /// The derivative of the series.
    pub fn slope(&self) -> Self {
        let at = |n: usize| if n + 1 < TERMS { (n + 1) as f64 * self.at[n + 1] } else { 0.0 };
        Self { at: core::array::from_fn(at) }
    }

    /// The first `known` coefficients of the product of two series.
    pub fn times(&self, b: &Self, known: usize) -> Self {
        let mut at = [0.0; TERMS];
        for (n, to) in at[..known].iter_mut().enumerate() {
            *to = (0..=n).fold(0.0, |sum, j| sum + self.at[j] * b.at[n - j]);
        }
        Self { at }
    }

    /// The sum `self + k b`.
    pub fn plus(&self, k: f64, b: &Self) -> Self {
        Self { at: core::array::from_fn(|n| self.at[n] + k * b.at[n]) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shifts_and_integrals_change_no_value() {
        let mut a = Series::of(0.7);
        a.at[1..6].copy_from_slice(&[-1.3, 0.4, 2.0, -0.1, 0.9]);
        for t in [-1.5, 0.3] {
            assert!((a.about(t).value(0.4 - t) - a.value(0.4)).abs() < 1e-13, "{t}");
        }
        assert!((a.integral(2.0).slope().value(0.3) - a.value(0.3)).abs() < 1e-15);
        let square = a.times(&a, TERMS).plus(0.0, &a).value(0.3) - a.value(0.3).powi(2);
        assert!(square.abs() < 1e-15, "{square}");
        let grown = Series { at: [1.0; TERMS] }.integral(0.0);
        assert!((grown.value(0.1) + (1.0f64 - 0.1).ln()).abs() < 1e-15);
    }
}
