//! Power series in y about a centre: their recurrences, their zeros and their truncation errors.
//!
//! The head of [`lanes`](super) has the equations. This module uses only the [`Reduced`] law of a motion.

use crate::laws::contact::reduced::Reduced;
use crate::numbers::power::{term, times};
use crate::numbers::{Real, arctan2};

/// Sine and cosine of theta at y; `q` is Q = 1 - 2 c0 y + y^2.
#[inline(always)]
pub fn angle_at<T: Real>(sin: T, cos: T, y: T, q: T) -> (T, T) {
    let one = y.splat(1.0);
    (sin * (one - y * y) / q, cos.fma(y.fma(y, one), -(y + y)) / q)
}

/// Normalizes sine and cosine at the centre of a further series: the smaller one is kept, and the other is computed
/// from it. Without this an error of 1e-16 in s^2 + c^2 would stay in 1 -+ c, which may be as small as 1e-16 itself.
#[inline(always)]
pub fn normalized<T: Real>((s, c): (T, T)) -> (T, T) {
    let (zero, one) = (s.splat(0.0), s.splat(1.0));
    let left = |x: T| ((one - x) * (one + x)).max(zero).sqrt();
    let large = left(s);
    let cos = c.select_lt(zero, -large, large);
    let level = c.abs().select_lt(s, one, zero);
    (zero.select_lt(level, left(c), s), zero.select_lt(level, c, cos))
}

/// The change theta - theta0 at y, computed as 2 atan(s0 y/(1 - c0 y)).
#[inline(always)]
pub fn change_of_theta<T: Real>(sin: T, cos: T, y: T) -> T {
    let half = arctan2(sin * y.abs(), (-cos).fma(y, y.splat(1.0)));
    let turn = half + half;
    y.select_lt(y.splat(0.0), -turn, turn)
}

/// Bound of the sum of the terms that are left out of a series, within `reach`, for a function whose singularities
/// are on the unit circle.
#[inline(always)]
pub fn truncation_bound<T: Real>(series: &[T], reach: T) -> T {
    let n = series.len();
    let left = reach.splat(1.0) / (reach.splat(1.0) - reach);
    series[n - 1].abs().max(series[n - 2].abs()).max(series[n - 3].abs()) * power(reach, n) * left * left
}

/// Bound of the derivative of a series with respect to y within `reach`.
#[inline(always)]
pub fn slope_bound<T: Real>(series: &[T], reach: T) -> T {
    let mut sum = reach.splat(0.0);
    for k in (1..series.len()).rev() {
        sum = sum.fma(reach, series[k].abs() * reach.splat(k as f64));
    }
    sum
}

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

/// Computes the series of w1 and w3 in y from their first terms; N is the capacity.
#[inline(always)]
pub fn lane_lines<T: Real, const N: usize>(law: &Reduced<T>, sin: T, cos: T, w: &mut [T], n: &mut [T]) {
    if law.round {
        return rounded_lane_lines::<_, N>(law, sin, cos, w, n);
    }
    let count = w.len().min(n.len());
    let number = |x: f64| sin.splat(x);
    let of = law.at((sin, cos));
    let zero = number(0.0);
    let double = sin + sin;
    let (drag, feed, grow) = (double * of.p, double * of.q, double * of.r);
    let turn = cos + cos;
    // These are the terms k of v, k - 1 of v and k - 1 of n.
    let (mut v, mut v_before) = (w[0], zero);
    let mut n_before = zero;
    for k in 0..count - 1 {
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

/// Terms of the series of the height of the centre, (ell C + a S)/Q. The first is -2 s g and the second contains -2 a
/// s; the general recurrence would compute both as differences of ell and 2 ell, and a long pipe would lose digits.
struct HeightTerms<T> {
    turn: T,
    first: T,
    second: T,
    now: T,
    before: T,
}

impl<T: Real> HeightTerms<T> {
    #[inline(always)]
    fn of(law: &Reduced<T>, sin: T, cos: T) -> Self {
        let (zero, rim) = (sin.splat(0.0), &law.shape.rim);
        let (first, second) = ((sin + sin) * rim.lever((sin, cos)), (sin + sin) * rim.a);
        Self {
            turn: cos + cos,
            first: zero - first,
            second: zero - second,
            now: rim.fused_slope((sin, cos)),
            before: zero,
        }
    }

    /// Returns the term `k`; calls are in ascending order from 1 on.
    #[inline(always)]
    fn next(&mut self, k: usize) -> T {
        let next = match k {
            1 => self.first,
            2 => self.turn.fma(self.now, self.second),
            _ => self.turn.fma(self.now, -self.before),
        };
        (self.now, self.before) = (next, self.now);
        next
    }
}

/// Q, C, S, A Q and L Q of a rounded rim as polynomials of the second degree in y, lowest power first.
struct Quadratics<T> {
    q: [T; 3],
    cos: [T; 3],
    sin: [T; 3],
    radius: [T; 3],
    depth: [T; 3],
}

impl<T: Real> Quadratics<T> {
    #[inline(always)]
    fn of(law: &Reduced<T>, sin: T, cos: T) -> Self {
        let number = |x: f64| sin.splat(x);
        let (zero, one, rim) = (number(0.0), number(1.0), &law.shape.rim);
        let (q, c, s) = ([one, -(cos + cos), one], [cos, number(-2.0), cos], [sin, zero, -sin]);
        let blend = |a: T, of: &[T; 3]| core::array::from_fn(|i| a * q[i] + rim.rho * of[i]);
        Self { radius: blend(rim.a, &s), depth: blend(rim.ell, &c), q, cos: c, sin: s }
    }
}

/// Computes the series of w1 and w3 in y for a rounded rim.
#[inline(always)]
fn rounded_lane_lines<T: Real, const N: usize>(law: &Reduced<T>, sin: T, cos: T, w: &mut [T], n: &mut [T]) {
    let number = |x: f64| sin.splat(x);
    let (zero, two) = (number(0.0), number(2.0));
    let (i1, i3, rim) = (law.shape.i1, law.shape.i3, &law.shape.rim);
    let of = Quadratics::of(law, sin, cos);
    let (squares, wide, deep): ([T; 5], [T; 5], [T; 5]) =
        (times(&of.q, &of.q), times(&of.radius, &of.radius), times(&of.depth, &of.depth));
    let hub: [T; 5] = times(&of.cos, &of.depth);
    let d: [T; 5] = core::array::from_fn(|i| i1 * i3 * squares[i] + i1 * wide[i] + i3 * deep[i]);
    let feed: [T; 5] = core::array::from_fn(|i| i3 * (i3 * squares[i] + wide[i] + rim.rho * hub[i]));
    let all: [T; 7] = times(&of.q, &d);
    // These polynomials are the right sides of Q D v' and of Q D n'.
    let lean: [T; 6] = times(&[cos, number(-1.0)], &d);
    let lever: [T; 5] = times(&of.q, &of.depth);
    let pull = two * sin * i3 * rim.a;
    let from_v: [T; 6] =
        core::array::from_fn(|i| -(two * lean[i]) - if i < 5 { pull * lever[i] } else { zero });
    // The factor 2 s0 (1 - y^2) is 2 S.
    let from_n: [T; 7] = times(&[two * of.sin[0], zero, two * of.sin[2]], &feed);
    let spin: [T; 3] = core::array::from_fn(|i| i3 * of.depth[i] - i1 * rim.rho * of.cos[i]);
    let (grow, turn): ([T; 5], [T; 5]) = (times(&of.q, &of.radius), times(&spin, &of.radius));
    let (grow, turn) = (grow.map(|x| two * sin * i1 * rim.a * x), turn.map(|x| two * sin * x));
    let inverse = number(1.0) / all[0];
    // v is a series; `v_rate` and `n_rate` are the terms k v_k and k n_k.
    let (mut v, mut v_rate, mut n_rate) = ([zero; N], [zero; N], [zero; N]);
    v[0] = w[0];
    for k in 0..w.len().min(n.len()).min(N) - 1 {
        let mut next_v = term(&from_n, n, k, term(&from_v, &v, k, zero));
        let mut next_n = term(&turn, n, k, term(&grow, w, k, zero));
        for j in 1..7.min(k + 1) {
            next_v = (-all[j]).fma(v_rate[k + 1 - j], next_v);
            next_n = (-all[j]).fma(n_rate[k + 1 - j], next_n);
        }
        (v_rate[k + 1], n_rate[k + 1]) = (next_v * inverse, next_n * inverse);
        let step = number(1.0 / (k + 1) as f64);
        v[k + 1] = v_rate[k + 1] * step;
        n[k + 1] = n_rate[k + 1] * step;
        w[k + 1] = if k > 0 { v[k + 1] + w[k - 1] } else { v[k + 1] };
    }
}

/// Computes the series of F = J theta'^2 in y for a rounded rim, as a sum of three squares without cancellation.
#[inline(always)]
fn rounded_balance<T: Real, const N: usize>(
    law: &Reduced<T>,
    sin: T,
    cos: T,
    (w1, w3): (&[T], &[T]),
    force: &mut [T],
) {
    let number = |x: f64| sin.splat(x);
    let zero = number(0.0);
    let of = Quadratics::of(law, sin, cos);
    let depth = of.depth.map(|x| -x);
    let mut lift = HeightTerms::of(law, sin, cos);
    let (mut slide, mut heavy) = ([zero; N], [[zero; N]; 2]);
    for k in 0..force.len().min(N) {
        let mut next = term(&depth, w1, k, term(&of.radius, w3, k, zero));
        for j in 1..3.min(k + 1) {
            next = (-of.q[j]).fma(slide[k - j], next);
        }
        slide[k] = next;
        heavy[0][k] = law.shape.i1 * w1[k];
        heavy[1][k] = law.shape.i3 * w3[k];
        if k == 0 {
            continue;
        }
        let mut sums = [lift.next(k), zero, zero];
        for i in 0..k.div_ceil(2) {
            sums[0] = w1[i].fma(heavy[0][k - i], sums[0]);
            sums[1] = w3[i].fma(heavy[1][k - i], sums[1]);
            sums[2] = slide[i].fma(slide[k - i], sums[2]);
        }
        let mut sum = number(2.0) * (sums[0] + sums[1] + sums[2]);
        if k % 2 == 0 {
            let h = k / 2;
            sum = slide[h].fma(slide[h], w1[h].fma(heavy[0][h], w3[h].fma(heavy[1][h], sum)));
        }
        force[k] = zero - sum;
    }
}

/// Computes the series of F = J theta'^2 from its first term: twice the energy minus that of w1, w3 and the height.
#[inline(always)]
pub fn square_of_rate<T: Real, const N: usize>(
    law: &Reduced<T>,
    sin: T,
    cos: T,
    w1: &[T],
    w3: &[T],
    force: &mut [T],
) {
    let number = |x: f64| sin.splat(x);
    let (zero, two) = (number(0.0), number(2.0));
    if law.round {
        return rounded_balance::<_, N>(law, sin, cos, (w1, w3), force);
    }
    let mut lift = HeightTerms::of(law, sin, cos);
    let of = law.at((sin, cos));
    // The quadratic form is al w^2 + b n^2 - 2 k n w = al g^2 + (b - k^2/al) n^2 with g = w - (k/al) n.
    let share = of.k / of.al;
    let other = (zero - share).fma(of.k, of.b);
    let count = force.len().min(N);
    let (mut g, mut heavy_g, mut heavy_n) = ([zero; N], [zero; N], [zero; N]);
    for i in 0..count {
        g[i] = (zero - share).fma(w3[i], w1[i]);
        heavy_g[i] = of.al * g[i];
        heavy_n[i] = other * w3[i];
    }
    for k in 1..count {
        let (mut sum_g, mut sum_n) = (lift.next(k), zero);
        for i in 0..k.div_ceil(2) {
            sum_g = g[i].fma(heavy_g[k - i], sum_g);
            sum_n = w3[i].fma(heavy_n[k - i], sum_n);
        }
        let sum = two * (sum_g + sum_n);
        force[k] = zero
            - if k % 2 == 0 { g[k / 2].fma(heavy_g[k / 2], w3[k / 2].fma(heavy_n[k / 2], sum)) } else { sum };
    }
}

/// The zeros of the first three terms of the series of F, ascending; NaN without real zeros.
#[inline(always)]
pub fn parabola<T: Real>(force: &[T]) -> [T; 2] {
    let number = |x: f64| force[0].splat(x);
    let zero = number(0.0);
    let [f0, f1, f2] = [force[0], force[1], force[2]];
    let root = (f1 * f1 - number(4.0) * f2 * f0).sqrt();
    let q = number(-0.5) * (f1 + f1.select_lt(zero, zero - root, root));
    let first = q / f2;
    let second = q.abs().select_lt(number(f64::MIN_POSITIVE), first, f0 / q);
    [first.min(second), first.max(second)]
}

/// The zeros of F (turning points) on both sides of the start: Newton's method, from the zeros of its parabola, for F
/// divided by the distance from the other zero (Ehrlich 1967, Aberth 1973), so that both never converge to the same
/// zero. A zero at y = 0, as for a start at rest, stays.
#[inline(always)]
pub fn turning_points<T: Real>(force: &[T]) -> [T; 2] {
    let mut ends = parabola(force);
    if force.len() > 16 {
        for _ in 0..6 {
            ends = newton(force, ends);
        }
    } else {
        // Each step roughly trebles the number of digits, so that the first step needs few terms.
        ends = newton(&force[..6], ends);
        for _ in 0..2 {
            ends = newton(force, ends);
        }
    }
    let [a, b] = ends;
    [a.min(b) + (a + b) * a.splat(0.0), a.max(b)]
}

/// Makes one step of Newton's method for both zeros of F.
#[inline(always)]
fn newton<T: Real>(force: &[T], ends: [T; 2]) -> [T; 2] {
    let (last, before) = (force[force.len() - 1], &force[..force.len() - 1]);
    let zero = force[0].splat(0.0);
    let [low, high] = ends;
    let mut next = ends;
    for (y, other) in next.iter_mut().zip([high, low]) {
        let (mut value, mut slope) = (last, zero);
        for c in before.iter().rev() {
            slope = slope.fma(*y, value);
            value = value.fma(*y, *c);
        }
        let apart = *y - other;
        let step = value * apart / (slope * apart - value);
        *y = *y - value.abs().select_lt(y.splat(f64::MIN_POSITIVE), zero, step);
    }
    next
}
