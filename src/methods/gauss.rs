//! Gauss's quadrature, and an estimate of its error.
//!
//! ```text
//! P_n(z_i) = 0,   w_i = 2/((1 - z_i^2) P_n'(z_i)^2),   int_-1^1 f dz = sum w_i f(z_i)
//! error about |a_(n-2)| + |a_(n-1)|,   a_k = (k + 1/2) sum w_i P_k(z_i) f(z_i)
//! ```
//! The quadrature is exact for polynomials up to the power 2 n - 1 (Abramowitz and Stegun 25.4.29). The nodes
//! are symmetric, so that one of the last two coefficients follows from the even part of f and the other from
//! its odd part. Where f is analytic its Legendre coefficients fall geometrically, and the quadrature has
//! about twice the digits of the truncated series: its error is about the square of the last coefficients
//! over the first. Error of the nodes: 4 ulp; the tests at the end check it.

use core::f64::consts::PI;

/// The positive nodes of Gauss's rule of quadrature on [-1, 1]; the rule is symmetric.
#[derive(Debug, Clone)]
pub(crate) struct Rule {
    pub nodes: Vec<Node>,
}

/// A node and its weight; `even` weighs f(x) + f(-x) and `odd` weighs f(x) - f(-x) in the last two Legendre
/// coefficients.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub x: f64,
    pub weight: f64,
    pub even: f64,
    pub odd: f64,
}

impl Rule {
    /// Gauss's rule with `count` nodes, a multiple of four.
    pub fn new(count: usize) -> Self {
        let half = |k: usize| k as f64 + 0.5;
        let node = |i: usize| {
            let (z, weight, [before, earlier]) = zero(count, i);
            let [even, odd] = [half(count - 2) * weight * earlier, -half(count - 1) * weight * before];
            Node { x: -z, weight, even, odd }
        };
        Self { nodes: (0..count / 2).map(node).collect() }
    }
}

/// The zero with the index `i` of the Legendre polynomial of degree `n`, by Newton's method from an approximate place;
/// its weight, and the values of P_(n-1) and P_(n-2) at this zero. The zeros ascend with their index.
fn zero(n: usize, i: usize) -> (f64, f64, [f64; 2]) {
    let degree = n as f64;
    let mut z = -(PI * (i as f64 + 0.75) / (degree + 0.5)).cos();
    let (mut slope, mut before) = (1.0, [1.0, 0.0]);
    for _ in 0..8 {
        let mut here = z;
        before = [1.0, 0.0];
        for k in 1..n {
            let k = k as f64;
            (before, here) = ([here, before[0]], ((2.0 * k + 1.0) * z * here - k * before[0]) / (k + 1.0));
        }
        slope = degree * (z * here - before[0]) / (z * z - 1.0);
        z -= here / slope;
    }
    (z, 2.0 / ((1.0 - z * z) * slope * slope), before)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rule_integrates_powers_and_tells_the_last_legendre_coefficients() {
        for count in [16, 64, 320] {
            let rule = Rule::new(count);
            let sum = |f: &dyn Fn(&Node) -> f64| rule.nodes.iter().map(f).sum::<f64>();
            for k in [0, 2, 8, 30] {
                let found = sum(&|node| 2.0 * node.weight * node.x.powi(k));
                assert!((found * f64::from(k + 1) / 2.0 - 1.0).abs() < 1e-13, "{count} {k}: {found}");
            }
            // x^k has no Legendre coefficient beyond k, and that of P_(n-2) itself is 1.
            let even = sum(&|node| 2.0 * node.even * node.x.powi(4));
            let odd = sum(&|node| 2.0 * node.odd * node.x.powi(5));
            assert!(even.abs() < 1e-12 && odd.abs() < 1e-12, "{count}: {even} {odd}");
            let own = sum(&|node| 2.0 * node.even * node.even / ((count as f64 - 1.5) * node.weight));
            assert!((own - 1.0).abs() < 1e-10, "{count}: {own}");
        }
    }
}
