//! Where a function of one variable vanishes, and where it is least.
//!
//! Error: a zero is found to the last digit, or to where the values do not tell any more; a least value to the square
//! of nine digits of the way.

/// Where `f` vanishes between `a` and `b`, at which its signs differ: to the last digit, or to where its
/// values do not tell any more.
pub(crate) fn crossing(
    mut f: impl FnMut(f64) -> f64,
    mut a: f64,
    mut b: f64,
    mut fa: f64,
    mut fb: f64,
) -> f64 {
    for i in 0..200 {
        // regula falsi, the end that stays weighed less (Illinois); every fourth time the middle
        let mut x = if i % 4 == 3 { 0.5 * (a + b) } else { b - fb * ((b - a) / (fb - fa)) };
        if !(x > a.min(b) && x < a.max(b)) {
            x = 0.5 * (a + b);
        }
        if x == a || x == b {
            break;
        }
        let y = f(x);
        if y == 0.0 {
            return x;
        }
        if (y < 0.0) == (fb < 0.0) {
            fa *= 0.5;
        } else {
            (a, fa) = (b, fb);
        }
        (b, fb) = (x, y);
    }
    b
}

/// Where `f` is least between `a` and `c`, to nine digits of the distance (golden section), and its value.
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
