//! Zeros of the Legendre polynomials: the nodes of Gauss's quadrature.
//!
//! ```text
//! P_n(z_i) = 0,   w_i = 2/((1 - z_i^2) P_n'(z_i)^2),   int_-1^1 f dz = sum w_i f(z_i)
//! ```
//! The quadrature is exact for polynomials up to the power 2 n - 1 (Abramowitz and Stegun 25.4.29). Error: 4 ulp of the
//! largest term; the tests of `gauss` in `drift` and of `rule` in `exact::lanes::march` check it.

use core::f64::consts::PI;

/// A zero of a Legendre polynomial.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Zero {
    /// Position of the zero in (-1, 1); the zeros ascend with their index.
    pub place: f64,
    pub weight: f64,
    /// P_(n-1) and P_(n-2) at the zero.
    pub before: [f64; 2],
}

/// P_(k+1) at z from P_k (`here`) and P_(k-1) (`before`).
pub(crate) fn legendre(k: f64, z: f64, here: f64, before: f64) -> f64 {
    ((2.0 * k + 1.0) * z * here - k * before) / (k + 1.0)
}

/// The zero `i` of the Legendre polynomial of degree `n`, by Newton's method from an approximate place.
pub(crate) fn zero(n: usize, i: usize) -> Zero {
    let degree = n as f64;
    let mut z = -(PI * (i as f64 + 0.75) / (degree + 0.5)).cos();
    let (mut slope, mut before) = (1.0, [1.0, 0.0]);
    for _ in 0..8 {
        let mut here = z;
        before = [1.0, 0.0];
        for k in 1..n {
            let k = k as f64;
            (before, here) = ([here, before[0]], legendre(k, z, here, before[0]));
        }
        slope = degree * (z * here - before[0]) / (z * z - 1.0);
        z -= here / slope;
    }
    Zero { place: z, weight: 2.0 / ((1.0 - z * z) * slope * slope), before }
}
