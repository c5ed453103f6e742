//! Gauss's rule, and an estimate of its error.
//!
//! ```text
//! int_-1^1 f dx = sum w_i f(x_i),   error about |a_(n-2)| + |a_(n-1)|,   a_k = (k + 1/2) sum w_i P_k(x_i) f(x_i)
//! ```
//! The nodes are symmetric, so that the even part of f gives the even coefficient and the odd part the odd one. Where f
//! is analytic its Legendre coefficients fall geometrically, and the rule is twice as good as the series it stands for:
//! its error is about the square of the last coefficients over the first.

use crate::number::gauss::zero;

/// The positive nodes of a rule on [-1, 1].
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
    /// The rule of `count` nodes, a multiple of four.
    pub fn new(count: usize) -> Self {
        let half = |k: usize| k as f64 + 0.5;
        let node = |i: usize| {
            let zero = zero(count, i);
            let [before, earlier] = zero.before;
            Node {
                x: -zero.place,
                weight: zero.weight,
                even: half(count - 2) * zero.weight * earlier,
                odd: -half(count - 1) * zero.weight * before,
            }
        };
        Self { nodes: (0..count / 2).map(node).collect() }
    }
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
            // x^k has no Legendre coefficient beyond k, and P_(n-2) is its own coefficient.
            let even = sum(&|node| 2.0 * node.even * node.x.powi(4));
            let odd = sum(&|node| 2.0 * node.odd * node.x.powi(5));
            assert!(even.abs() < 1e-12 && odd.abs() < 1e-12, "{count}: {even} {odd}");
            let own = sum(&|node| 2.0 * node.even * node.even / ((count as f64 - 1.5) * node.weight));
            assert!((own - 1.0).abs() < 1e-10, "{count}: {own}");
        }
    }
}
