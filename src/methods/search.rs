//! Zeros and minima of a function of one variable.
//!
//! Error: a zero is accurate to the last digit, or as far as the values of the function allow. The place of a minimum
//! is accurate to nine digits of the interval, and its value to the square of that.

use super::SHORT_CODE;

/// The zero of `f` between `a` and `b`, at which `f` has the values `fa` and `fb` of different signs: to the last
/// digit, or as far as the values of `f` allow. The zero is `b` if `fb` is 0.
pub(crate) fn crossing(mut f: impl FnMut(f64) -> f64, a: f64, b: f64, fa: f64, fb: f64) -> f64 {
    if SHORT_CODE {
        return bracketed(&mut f as &mut dyn FnMut(f64) -> f64, [a, b], [fa, fb]);
    }
    bracketed(&mut f, [a, b], [fa, fb])
}

/// The search of [`crossing`]; code for web pages has only one compiled copy of it.
fn bracketed<F: FnMut(f64) -> f64 + ?Sized>(
    f: &mut F,
    [mut a, mut b]: [f64; 2],
    [mut fa, mut fb]: [f64; 2],
) -> f64 {
    for i in 0..200 {
        // Regula falsi: the value at an end that is kept is halved (Illinois), and every fourth step bisects.
        let middle = 0.5 * (a + b);
        let x = if i % 4 == 3 { middle } else { b - fb * ((b - a) / (fb - fa)) };
        let (low, high) = (a.min(b), a.max(b));
        let inside = |x: f64| low < x && x < high;
        let x = if inside(x) { x } else { middle };
        // At an exact zero the search stops: a zero has no sign, so the next comparison of signs would be
        // wrong.
        if !inside(x) || fb == 0.0 || fb.is_nan() {
            break;
        }
        let y = f(x);
        if (fb < 0.0) == (y < 0.0) {
            fa *= 0.5;
        } else {
            (a, fa) = (b, fb);
        }
        (b, fb) = (x, y);
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
