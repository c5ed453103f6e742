//! Polynomials and power series as arrays of coefficients, lowest power first.

use super::real::Real;

/// The value at `x` of a series, by Horner's rule; 0 for a series without coefficients.
#[inline(always)]
pub(crate) fn horner<T: Real>(series: &[T], x: T) -> T {
    let Some((last, rest)) = series.split_last() else { return x.splat(0.0) };
    let mut sum = *last;
    for c in rest.iter().rev() {
        sum = sum.mac(x, *c);
    }
    sum
}

/// Divides a series by (x - root) in place and returns the remainder; the last coefficient becomes 0.
#[inline(always)]
pub(crate) fn divide<T: Real>(series: &mut [T], root: T) -> T {
    let mut carry = root.splat(0.0);
    for term in series.iter_mut().rev() {
        (*term, carry) = (carry, carry.mac(root, *term));
    }
    carry
}

/// Step `k` of the product of the series `a` and `b`, whose coefficients become known one by one: adds to `sum` all
/// products of a coefficient `k` with one up to `k`, after which coefficient `k` of `sum` is complete. These additions
/// do not wait for each other, unlike those of a sum over all pairs of one coefficient.
#[inline(always)]
pub(crate) fn multiply_on<T: Real, const N: usize>(sum: &mut [T; N], a: &[T; N], b: &[T; N], k: usize) {
    let (of_a, of_b) = (a[k], b[k]);
    for ((sum, a), b) in sum[k..].iter_mut().zip(&a[..k]).zip(&b[..k]) {
        *sum = of_a.mac(*b, of_b.mac(*a, *sum));
    }
    if 2 * k < N {
        sum[2 * k] = of_a.mac(of_b, sum[2 * k]);
    }
}

/// Step `k` of the square of a series, as [`multiply_on`] does it for a product.
#[inline(always)]
pub(crate) fn square_on<T: Real, const N: usize>(sum: &mut [T; N], a: &[T; N], k: usize) {
    let twice = a[k] + a[k];
    for (sum, a) in sum[k..].iter_mut().zip(&a[..k]) {
        *sum = twice.mac(*a, *sum);
    }
    if 2 * k < N {
        sum[2 * k] = a[k].mac(a[k], sum[2 * k]);
    }
}

/// `sum` plus coefficient `k` of the product of the polynomial `of` and a series.
#[inline(always)]
pub(crate) fn term<T: Real, const A: usize>(of: &[T; A], series: &[T], k: usize, sum: T) -> T {
    (0..A.min(k + 1)).fold(sum, |sum, j| of[j].fma(series[k - j], sum))
}

/// The product of two polynomials.
#[inline(always)]
pub(crate) fn times<T: Real, const A: usize, const B: usize, const N: usize>(
    a: &[T; A],
    b: &[T; B],
) -> [T; N] {
    let mut all = [a[0].splat(0.0); N];
    for i in 0..A {
        for j in 0..B {
            all[i + j] = a[i].mac(b[j], all[i + j]);
        }
    }
    all
}
