//! The classical Runge-Kutta method of fourth order, with a fixed step.
//!
//! ```text
//! y(t + h) = y + h (k1 + 2 k2 + 2 k3 + k4)/6
//! k1 = f(y),   k2 = f(y + h k1/2),   k3 = f(y + h k2/2),   k4 = f(y + h k3)
//! ```
//! The method is that of Kutta 1901. `f` gives the derivatives of N variables and does not depend on time. The error of
//! a smooth motion at a fixed time goes as h^4, and a test of `integrators` measures the exponent 4.00 +- 0.05. The
//! updates are compensated (Kahan 1965): the rounding error of one sum is added to the next, so that the round-off of n
//! steps grows as the square root of n from a few ulp of one step's change, not of the sum.
//!
//! ```
//! use spincyl::rk4::integrate;
//!
//! // A weight on a spring is back after one period.
//! let step = std::f64::consts::TAU / 200.0;
//! let [x, v] = integrate(|y: &[f64; 2]| [y[1], -y[0]], [1.0, 0.0], step, 200);
//! assert!((x - 1.0).abs() < 1e-6 && v.abs() < 1e-6);
//! ```

use super::rk8::plus;
use crate::numbers::Real;

/// The change of `y` over one step `h`, where `k1 = f(y)` is known.
#[inline(always)]
pub fn increment<Y, const N: usize>(
    f: &mut impl FnMut(&Y) -> Y,
    y: &[f64; N],
    k1: &[f64; N],
    h: f64,
) -> [f64; N]
where
    Y: From<[f64; N]> + Into<[f64; N]>,
{
    change(|y: &[f64; N]| f(&Y::from(*y)).into(), y, k1, h)
}

/// The change of the array `y` over one step `h`, as [`increment`] gives it for other types; for single numbers or SIMD lanes.
#[inline(always)]
pub(crate) fn change<T: Real, const N: usize>(
    mut f: impl FnMut(&[T; N]) -> [T; N],
    y: &[T; N],
    k1: &[T; N],
    h: f64,
) -> [T; N] {
    let number = |x: f64| y[0].splat(x);
    let (mut k, mut sum, mut there) = (*k1, *k1, *y);
    for (ahead, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
        for i in 0..N {
            there[i] = k[i].mac(number(ahead * h), y[i]);
        }
        k = f(&there);
        for i in 0..N {
            sum[i] = k[i].mac(number(weight), sum[i]);
        }
    }
    for sum in &mut sum {
        *sum = number(h / 6.0) * *sum;
    }
    sum
}

/// The variables of an integration, with the rounding errors of the sums that led to them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compensated<const N: usize> {
    /// The variables, as rounded sums.
    pub y: [f64; N],
    /// The part, less than an ulp, that is still to be added to `y`.
    pub carry: [f64; N],
}

impl<const N: usize> Compensated<N> {
    /// The variables at the start of an integration, without rounding errors.
    pub fn new(y: [f64; N]) -> Self {
        Self { y, carry: [0.0; N] }
    }

    /// The sum of these variables and a change, which also keeps the rounding error of the sum.
    #[inline(always)]
    #[must_use]
    pub fn plus(&self, change: &[f64; N]) -> Self {
        let (y, carry) = plus(&self.y, &self.carry, change);
        Self { y, carry }
    }
}

/// The state after `steps` RK4 steps of length `h`; a negative `h` goes backward in time.
///
/// The type of `y` holds N variables, for example [`State`](crate::State) or an array.
pub fn integrate<Y, const N: usize>(mut f: impl FnMut(&Y) -> Y, y: Y, h: f64, steps: u64) -> Y
where
    Y: From<[f64; N]> + Into<[f64; N]>,
{
    let mut at = Compensated::new(y.into());
    for _ in 0..steps {
        let k1 = f(&Y::from(at.y)).into();
        at = at.plus(&increment(&mut f, &at.y, &k1, h));
    }
    Y::from(at.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pendulum_comes_back_with_an_error_of_fourth_order() {
        let swing = |n: u64| {
            let h = core::f64::consts::TAU / n as f64;
            let [x, v] = integrate(|y: &[f64; 2]| [y[1], -y[0]], [1.0, 0.0], h, n);
            (x - 1.0).hypot(v)
        };
        for n in [20, 40, 80, 160] {
            let order = (swing(n) / swing(2 * n)).log2();
            assert!((order - 4.0).abs() < 0.05, "{n}: {order}");
        }
    }

    #[test]
    fn a_sum_of_a_million_thirds_keeps_its_last_digit() {
        let [x] = integrate(|_: &[f64; 1]| [1.0 / 3.0], [0.0], 1.0, 1_000_000);
        assert!((x - 1e6 / 3.0).abs() <= 6e-11, "{x}");
    }

    #[test]
    fn no_step_is_no_change() {
        assert_eq!(integrate(|_: &[f64; 1]| [1.0], [7.0], 0.5, 0), [7.0]);
    }
}
