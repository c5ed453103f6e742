//! Polynomials and power series as arrays of their terms, lowest power first.

use super::real::Real;

/// The value at `x`.
#[inline(always)]
pub(crate) fn horner<T: Real>(series: &[T], x: T) -> T {
    let Some((last, rest)) = series.split_last() else { return x.splat(0.0) };
    let mut sum = *last;
    for c in rest.iter().rev() {
        sum = sum.mac(x, *c);
    }
    sum
}

/// Divides a series by (x - root) in place, which leaves the last term unused, and returns the remainder.
#[inline(always)]
pub(crate) fn divide<T: Real>(series: &mut [T], root: T) -> T {
    let mut carry = root.splat(0.0);
    for term in series.iter_mut().rev() {
        (*term, carry) = (carry, carry.mac(root, *term));
    }
    carry
}

/// The term `k` of the product of two series.
#[inline(always)]
pub(crate) fn product<T: Real>(a: &[T], b: &[T], k: usize) -> T {
    let mut sum = a[0].splat(0.0);
    for i in 0..=k {
        sum = a[i].mac(b[k - i], sum);
    }
    sum
}

/// The term `k` of the product of a polynomial and a series, added to `sum`.
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
