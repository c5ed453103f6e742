//! Truncated power series in one variable. A law that is evaluated with series gives the series of the motion.
//!
//! ```text
//! (a b)_n = sum a_j b_(n-j),   (a/b)_n = (a_n - sum_(j<n) (a/b)_j b_(n-j))/b_0
//! ```
//! The formulas are recurrences of automatic differentiation (Griewank and Walther 2008, ch. 13). Error: a few
//! roundings of the largest product in each coefficient.

use super::real::{Real, operators};

/// Coefficients of 1, t, t^2, ...; the first `known` coefficients are computed, the others are 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Series<const K: usize> {
    pub at: [f64; K],
    pub known: usize,
}

impl<const K: usize> Series<K> {
    /// The series of a constant.
    pub fn of(x: f64) -> Self {
        let mut at = [0.0; K];
        at[0] = x;
        Self { at, known: K }
    }

    /// The same series, with only the first `known` coefficients to be used in computations.
    pub fn first(&self, known: usize) -> Self {
        Self { known, ..*self }
    }

    /// The integral of the series, with the value `x` at 0.
    pub fn integral(&self, x: f64) -> Self {
        let known = (self.known + 1).min(K);
        let mut at = [0.0; K];
        at[0] = x;
        for (n, (to, from)) in (1..known).zip(at[1..].iter_mut().zip(self.at)) {
            *to = from / n as f64;
        }
        Self { at, known }
    }

    /// The value at `t`.
    pub fn value(&self, t: f64) -> f64 {
        self.at.iter().rev().fold(0.0, |sum, a| sum * t + a)
    }

    /// The same function as a series about `t`.
    pub fn about(&self, t: f64) -> Self {
        let mut at = self.at;
        for k in 0..K {
            for n in (k..K - 1).rev() {
                at[n] += t * at[n + 1];
            }
        }
        Self { at, ..*self }
    }

    /// The derivative of the series.
    pub fn slope(&self) -> Self {
        let at = core::array::from_fn(|n| if n + 1 < K { (n + 1) as f64 * self.at[n + 1] } else { 0.0 });
        Self { at, known: self.known }
    }

    /// The value of the series, if all other coefficients are 0.
    fn constant(&self) -> Option<f64> {
        self.at[1..].iter().all(|a| *a == 0.0).then_some(self.at[0])
    }

    fn each(&self, b: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let known = self.known.min(b.known);
        let mut at = [0.0; K];
        for (to, (a, b)) in at[..known].iter_mut().zip(self.at.into_iter().zip(b.at)) {
            *to = f(a, b);
        }
        Self { at, known }
    }

    fn times(&self, b: &Self) -> Self {
        // A law contains many constants.
        if let Some(a) = self.constant() {
            return self.each(b, |_, b| a * b);
        }
        if let Some(b_0) = b.constant() {
            return self.each(b, |a, _| a * b_0);
        }
        let known = self.known.min(b.known);
        let mut at = [0.0; K];
        for (n, to) in at[..known].iter_mut().enumerate() {
            *to = (0..=n).fold(0.0, |sum, j| sum + self.at[j] * b.at[n - j]);
        }
        Self { at, known }
    }

    fn over(&self, b: &Self) -> Self {
        let known = self.known.min(b.known);
        let mut at = [0.0; K];
        for n in 0..known {
            at[n] = (0..n).fold(self.at[n], |rest, j| rest - at[j] * b.at[n - j]) / b.at[0];
        }
        Self { at, known }
    }
}

operators!(
    [const K: usize] Series<K>,
    (a, b),
    a.each(&b, |a, b| a + b),
    a.each(&b, |a, b| a - b),
    a.times(&b),
    a.over(&b),
    Self { at: a.at.map(|a| -a), ..a }
);

impl<const K: usize> Real for Series<K> {
    fn splat(self, x: f64) -> Self {
        Self { known: self.known, ..Self::of(x) }
    }
    fn sqrt(self) -> Self {
        let mut root = Self { at: [0.0; K], ..self };
        if self.at == [0.0; K] {
            return root;
        }
        root.at[0] = self.at[0].sqrt();
        for n in 1..self.known {
            let rest: f64 = (1..n).map(|j| root.at[j] * root.at[n - j]).sum();
            root.at[n] = (self.at[n] - rest) / (2.0 * root.at[0]);
        }
        root
    }
    fn round(self) -> Self {
        self.splat(self.at[0].round())
    }
    /// Compares the values at 0.
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self {
        if self.at[0] < other.at[0] { yes } else { no }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_quotients_and_roots_undo_each_other_and_shifts_change_no_value() {
        let a = Series { at: [0.7, -1.3, 0.4, 2.0, -0.1, 0.9], known: 6 };
        let b = Series { at: [1.9, 0.3, -2.2, 0.6, 1.1, -0.5], known: 6 };
        for (n, x) in [(a * b) / b, (a * a).sqrt()].into_iter().enumerate() {
            assert!(x.at.iter().zip(a.at).all(|(x, a)| (x - a).abs() < 1e-14), "{n}: {x:?}");
        }
        for t in [-1.5, 0.3] {
            assert!((a.about(t).value(0.4 - t) - a.value(0.4)).abs() < 1e-13, "{t}");
        }
        let grown = Series { at: [1.0; 20], known: 20 }.integral(0.0);
        assert!((grown.value(0.1) + (1.0f64 - 0.1).ln()).abs() < 1e-15);
    }
}
