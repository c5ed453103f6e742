//! Series in y about a centre: what they are made of, and what is done with them.
//!
//! [`lanes`](super) has the equations. Knows a motion only by its [`Law`].

use crate::law::Law;
use crate::real::{Real, arctan2};

#[inline(always)]
pub fn horner<T: Real>(series: &[T], x: T) -> T {
    let Some((last, rest)) = series.split_last() else { return x.splat(0.0) };
    let mut sum = *last;
    for c in rest.iter().rev() {
        sum = sum.fma(x, *c);
    }
    sum
}

/// Sine and cosine of theta at y, Q known.
#[inline(always)]
pub fn angle<T: Real>(sin: T, cos: T, y: T, q: T) -> (T, T) {
    let one = y.splat(1.0);
    (sin * (one - y * y) / q, cos.fma(y.fma(y, one), -(y + y)) / q)
}

/// theta - theta0 at y: 2 atan(s0 y/(1 - c0 y)).
#[inline(always)]
pub fn turned<T: Real>(sin: T, cos: T, y: T) -> T {
    let half = arctan2(sin * y.abs(), (-cos).fma(y, y.splat(1.0)));
    let turn = half + half;
    y.select_lt(y.splat(0.0), -turn, turn)
}

/// What the terms left out of a series add up to, within `reach`: all singularities are on the unit circle.
#[inline(always)]
pub fn ending<T: Real, const N: usize>(series: &[T; N], reach: T) -> T {
    let left = reach.splat(1.0) / (reach.splat(1.0) - reach);
    series[N - 1].abs().max(series[N - 2].abs()).max(series[N - 3].abs()) * power(reach, N) * left * left
}

/// The most that a series changes with y within `reach`.
#[inline(always)]
pub fn steepness<T: Real, const N: usize>(series: &[T; N], reach: T) -> T {
    let mut sum = reach.splat(0.0);
    for k in (1..N).rev() {
        sum = sum.fma(reach, series[k].abs() * reach.splat(k as f64));
    }
    sum
}

/// `x` to the power of `n`.
#[inline(always)]
pub fn power<T: Real>(x: T, n: usize) -> T {
    let (mut all, mut square, mut left) = (x.splat(1.0), x, n);
    while left > 0 {
        if left % 2 == 1 {
            all = all * square;
        }
        square = square * square;
        left /= 2;
    }
    all
}

/// The series of w1 and w3 in y, from their first terms.
#[inline(always)]
pub fn lines<T: Real, const N: usize>(law: &Law<T>, sin: T, cos: T, w: &mut [T; N], n: &mut [T; N]) {
    let number = |x: f64| sin.splat(x);
    let zero = number(0.0);
    let double = sin + sin;
    let (drag, feed, grow) = (double * law.drag, double * law.feed, double * law.grow);
    let turn = cos + cos;
    // v and n of the two terms before, and of this one
    let (mut v, mut v_before) = (w[0], zero);
    let mut n_before = zero;
    for k in 0..N - 1 {
        let order = k as f64;
        let step = number(1.0 / (order + 1.0));
        let two_back = if k > 1 { n[k - 2] } else { zero };
        let next_v = v.fma(turn.fma(number(order - 1.0), zero - drag), feed * (n[k] - two_back));
        let next_v = v_before.fma(number(3.0 - order), next_v) * step;
        let next_n = w[k].fma(grow, n[k] * turn.fma(number(order), drag));
        let next_n = n_before.fma(number(1.0 - order), next_n) * step;
        (v_before, n_before) = (v, n[k]);
        v = next_v;
        n[k + 1] = next_n;
        w[k + 1] = if k > 0 { next_v + w[k - 1] } else { next_v };
    }
}

/// The series of F = J theta'^2, 2 E less what turns and what is lifted, from its first term.
#[inline(always)]
pub fn balance<T: Real, const N: usize>(
    law: &Law<T>,
    sin: T,
    cos: T,
    w1: &[T; N],
    w3: &[T; N],
    force: &mut [T; N],
) {
    let number = |x: f64| sin.splat(x);
    let (zero, two) = (number(0.0), number(2.0));
    // a w^2 + b n^2 - 2 k n w = a g^2 + (b - k^2/a) n^2,   g = w - (k/a) n
    let share = law.k / law.a;
    let other = (zero - share).fma(law.k, law.b);
    let (mut g, mut heavy_g, mut heavy_n) = ([zero; N], [zero; N], [zero; N]);
    for i in 0..N {
        g[i] = (zero - share).fma(w3[i], w1[i]);
        heavy_g[i] = law.a * g[i];
        heavy_n[i] = other * w3[i];
    }
    let turn = two * cos;
    let height = law.ell.fma(cos, sin);
    let (mut lift, mut lift_before) = (height, zero);
    for k in 1..N {
        let mut next = turn.fma(lift, zero - lift_before);
        if k == 1 {
            next = next - two * law.ell;
        } else if k == 2 {
            next = next + (law.ell.fma(cos, zero - sin));
        }
        (lift, lift_before) = (next, lift);
        let (mut sum_g, mut sum_n) = (lift, zero);
        for i in 0..k.div_ceil(2) {
            sum_g = g[i].fma(heavy_g[k - i], sum_g);
            sum_n = w3[i].fma(heavy_n[k - i], sum_n);
        }
        let sum = two * (sum_g + sum_n);
        force[k] = zero
            - if k % 2 == 0 { g[k / 2].fma(heavy_g[k / 2], w3[k / 2].fma(heavy_n[k / 2], sum)) } else { sum };
    }
}

/// The zeros of the first three terms of F, ascending; NaN where there are none.
#[inline(always)]
pub fn parabola<T: Real, const N: usize>(force: &[T; N]) -> [T; 2] {
    let number = |x: f64| force[0].splat(x);
    let zero = number(0.0);
    let [f0, f1, f2] = [force[0], force[1], force[2]];
    let root = (f1 * f1 - number(4.0) * f2 * f0).sqrt();
    let q = number(-0.5) * (f1 + f1.select_lt(zero, zero - root, root));
    let first = q / f2;
    let second = q.abs().select_lt(number(f64::MIN_POSITIVE), first, f0 / q);
    [first.min(second), first.max(second)]
}

/// The zeros of F on both sides, from a guess or those of its parabola: Newton's method for F divided by the
/// distance from the other zero (Ehrlich 1967, Aberth 1973), so that the two never run into the same one. A zero that
/// is known, as that of a start at rest, stays.
#[inline(always)]
pub fn turning_points<T: Real, const N: usize>(force: &[T; N], guess: Option<[T; 2]>) -> [T; 2] {
    let zero = force[0].splat(0.0);
    let mut ends = guess.unwrap_or_else(|| parabola(force));
    let steps = if N > 16 { 6 } else { 4 };
    for _ in 0..steps {
        let [low, high] = ends;
        for (y, other) in ends.iter_mut().zip([high, low]) {
            let (mut value, mut slope) = (force[N - 1], zero);
            for c in force[..N - 1].iter().rev() {
                slope = slope.fma(*y, value);
                value = value.fma(*y, *c);
            }
            let step = value / (slope - value / (*y - other));
            *y = *y - value.abs().select_lt(y.splat(f64::MIN_POSITIVE), zero, step);
        }
    }
    let [a, b] = ends;
    [a.min(b) + zero * (a + b), a.max(b)]
}

/// Divides a series by (y - root), in place: the last term is left over. The remainder.
#[inline(always)]
pub fn divide<T: Real>(series: &mut [T], root: T) -> T {
    let mut carry = root.splat(0.0);
    for term in series.iter_mut().rev() {
        (*term, carry) = (carry, carry.fma(root, *term));
    }
    carry
}
