//! Nodes and weights of Gauss's quadrature.
//!
//! ```text
//! int_0^1 f dx = sum w_i f(x_i),   x_i = (1 + z_i)/2 with P_N(z_i) = 0,   w_i = 1/((1 - z_i^2) P_N'(z_i)^2)
//! ```
//! Exact for polynomials up to the power 2 N - 1 (Abramowitz and Stegun 25.4.29). Error: 4 ulp of the largest term; the
//! tests at the end run it.

use crate::number::gauss::zero;

/// N nodes in (0, 1), ascending, and their weights.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gauss<const N: usize> {
    pub nodes: [f64; N],
    pub weights: [f64; N],
}

impl<const N: usize> Gauss<N> {
    /// From the zeros of the Legendre polynomial.
    pub fn new() -> Self {
        let (mut nodes, mut weights) = ([0.0; N], [0.0; N]);
        for (i, (node, weight)) in nodes.iter_mut().zip(&mut weights).enumerate() {
            let zero = zero(N, i);
            (*node, *weight) = (0.5 * (1.0 + zero.place), 0.5 * zero.weight);
        }
        Self { nodes, weights }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
