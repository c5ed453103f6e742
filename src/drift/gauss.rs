//! Nodes and weights of Gauss's quadrature, and the polynomial through given values at the nodes.
//!
//! ```text
//! int_0^1 f dx = sum w_i f(x_i),   x_i = (1 + z_i)/2 with P_N(z_i) = 0,   w_i = 1/((1 - z_i^2) P_N'(z_i)^2)
//! f = sum c_k P_k(z),   c_k = (2 k + 1) sum w_i f(x_i) P_k(z_i),   int_0^x P_k dx = (P_(k+1) - P_(k-1))/(4 k + 2)
//! ```
//! The quadrature is exact for polynomials up to the power 2 N - 1 (Abramowitz and Stegun 25.4.29), and the series up
//! to N - 1. Error: 4 ulp of the largest term; the tests at the end check this bound.

use crate::number::gauss::{legendre, zero};

/// N nodes in (0, 1), ascending, and their weights.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gauss<const N: usize> {
    pub nodes: [f64; N],
    pub weights: [f64; N],
}

impl<const N: usize> Gauss<N> {
    /// The rule from the zeros of the Legendre polynomial.
    pub fn new() -> Self {
        let (mut nodes, mut weights) = ([0.0; N], [0.0; N]);
        for (i, (node, weight)) in nodes.iter_mut().zip(&mut weights).enumerate() {
            let zero = zero(N, i);
            (*node, *weight) = (0.5 * (1.0 + zero.place), 0.5 * zero.weight);
        }
        Self { nodes, weights }
    }

    /// The coefficients c of the polynomial that has these values at the nodes.
    pub fn series(&self, values: &[f64; N]) -> [f64; N] {
        let mut series = [0.0; N];
        for ((x, weight), value) in self.nodes.iter().zip(self.weights).zip(values) {
            let z = 2.0 * x - 1.0;
            let [mut before, mut here] = [0.0, 1.0];
            for (k, sum) in series.iter_mut().enumerate() {
                let k = k as f64;
                *sum += (2.0 * k + 1.0) * weight * value * here;
                [before, here] = [here, legendre(k, z, here, before)];
            }
        }
        series
    }
}

/// The integral of a Legendre series from 0 to x, and the value of the series at x.
pub(super) fn integral<const N: usize>(series: &[f64; N], x: f64) -> [f64; 2] {
    let z = 2.0 * x - 1.0;
    // With P_(-1) = -1 the formula holds for k = 0, too: its integral vanishes at x = 0.
    let (mut before, mut here, mut all) = (-1.0, 1.0, [0.0; 2]);
    for (k, c) in series.iter().enumerate() {
        let k = k as f64;
        let next = legendre(k, z, here, before);
        all = [all[0] + c * (next - before) / (4.0 * k + 2.0), all[1] + c * here];
        (before, here) = (here, next);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_is_found_from_its_values_at_the_nodes_and_integrated() {
        let rule = Gauss::<16>::new();
        let value = |x: f64| 1.0 + x - 3.0 * x.powi(7) + 5.0 * x.powi(15);
        let exact = |x: f64| x + 0.5 * x * x - 0.375 * x.powi(8) + 0.3125 * x.powi(16);
        let series = rule.series(&rule.nodes.map(value));
        for x in [0.0, 0.1, 0.37, 0.5, 0.99, 1.0] {
            let [sum, here] = integral(&series, x);
            assert!((sum - exact(x)).abs() < 1e-14 && (here - value(x)).abs() < 1e-13, "{x}: {sum} {here}");
        }
    }

    #[test]
    fn powers_up_to_twice_the_number_of_nodes_are_integrated_to_the_last_digits() {
        let (twelve, sixteen) = (Gauss::<12>::new(), Gauss::<16>::new());
        let sum = |nodes: &[f64], weights: &[f64], k: i32| -> f64 {
            nodes.iter().zip(weights).map(|(x, w)| w * x.powi(k)).sum()
        };
        for k in 0..32 {
            let exact = 1.0 / f64::from(k + 1);
            assert!((sum(&sixteen.nodes, &sixteen.weights, k) / exact - 1.0).abs() < 4e-15, "{k}");
            if k < 24 {
                assert!((sum(&twelve.nodes, &twelve.weights, k) / exact - 1.0).abs() < 4e-15, "{k}");
            }
        }
        assert!((sum(&twelve.nodes, &twelve.weights, 24) * 25.0 - 1.0).abs() > 1e-14);
    }
}
