//! Zeros and minima of a function of one variable.
//!
//! Error: a zero is found to the last digit, or as far as the values of the function allow; a minimum is found to nine
//! digits of the interval, and its value to the square of that.

use crate::number::{Lane, here};

/// The zero of `f` between `a` and `b`, at which the signs of `f` differ: to the last digit, or as far as the values of
/// `f` allow. The zero is `b` if `fb` is 0.
pub(crate) fn crossing(f: impl FnMut(f64) -> f64, a: f64, b: f64, fa: f64, fb: f64) -> f64 {
    crossings(f, [a, b], [fa, fb], 1.0, 0.0, 200)
}

/// The zeros of [`crossing`] in those lanes in which `looks` is positive, `b` in the others. The search of a lane ends
/// where its interval is not wider than `near`, and the search of all lanes after `most` steps.
#[inline(always)]
pub(crate) fn crossings<T: Lane>(
    mut f: impl FnMut(T) -> T,
    [mut a, mut b]: [T; 2],
    [mut fa, mut fb]: [T; 2],
    mut looks: T,
    near: T,
    most: usize,
) -> T {
    let (zero, one, half) = (a.splat(0.0), a.splat(1.0), a.splat(0.5));
    for i in 0..most {
        // Regula falsi halves the weight of an end that stays (Illinois); every fourth step takes the middle.
        let middle = half * (a + b);
        let x = if i % 4 == 3 { middle } else { b - fb * ((b - a) / (fb - fa)) };
        let (low, high) = (a.min(b), a.max(b));
        let inside = here(
            #[inline(always)]
            |x: T, yes: T, no: T| low.select_lt(x, x.select_lt(high, yes, no), no),
        );
        let x = inside(x, x, middle);
        // A zero at the end `b` has no sign, and its neighbours would be taken for an end with the sign of `fa`.
        let wide = near.select_lt(high - low, inside(x, looks, zero), zero);
        looks = zero.select_lt(fb.abs(), wide, zero);
        if !looks.any() {
            break;
        }
        let y = f(x);
        let [before, after] = [fb.select_lt(zero, one, zero), y.select_lt(zero, one, zero)];
        let stays = half.select_lt((after - before).abs(), zero, looks);
        let moves = looks - stays;
        (a, fa) = (zero.select_lt(moves, b, a), zero.select_lt(moves, fb, fa));
        fa = zero.select_lt(stays, half * fa, fa);
        (b, fb) = (zero.select_lt(looks, x, b), zero.select_lt(looks, y, fb));
    }
    b
}

/// The place of the minimum of `f` between `a` and `c`, to nine digits of the distance (golden section), and its value.
pub(crate) fn least(mut f: impl FnMut(f64) -> f64, mut a: f64, mut c: f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.381_966_011_250_105_1;
    let (mut x, mut y) = (a + GOLDEN * (c - a), c - GOLDEN * (c - a));
    let (mut fx, mut fy) = (f(x), f(y));
    for _ in 0..44 {
        if fx < fy {
            (c, y, fy) = (y, x, fx);
            x = a + GOLDEN * (c - a);
            fx = f(x);
        } else {
            (a, x, fx) = (x, y, fy);
            y = c - GOLDEN * (c - a);
            fy = f(y);
        }
    }
    if fx < fy { (x, fx) } else { (y, fy) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zero_between_two_signs_or_at_the_second_end_is_found() {
        for zero in [0.25, 1e-9, 0.999, 1.0] {
            let f = |x: f64| zero - x;
            let found = crossing(f, 0.0, 1.0, f(0.0), f(1.0));
            assert!((found - zero).abs() <= f64::EPSILON, "{found} for {zero}");
        }
    }
}
