//! Dual numbers: a value and its derivative. A law that is evaluated with dual numbers gives its own derivative.
//!
//! ```text
//! (f, f')   sum (f + g, f' + g'),   product (f g, f' g + f g'),   quotient (f/g, (f' - (f/g) g')/g)
//! ```
//! The method is forward differentiation (Wengert 1964). Error: a few roundings of the terms that a derivative written
//! by hand has; a test of `laws` compares the two.

use super::real::{Real, operators};

/// A value and its derivative with respect to a single independent variable.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dual<T> {
    pub value: T,
    pub slope: T,
}

impl<T: Real> Dual<T> {
    /// A number that does not depend on the variable.
    #[inline(always)]
    pub fn constant(value: T) -> Self {
        Self { value, slope: value.splat(0.0) }
    }
}

operators!(
    [T: Real] Dual<T>,
    (a, b),
    Self { value: a.value + b.value, slope: a.slope + b.slope },
    Self { value: a.value - b.value, slope: a.slope - b.slope },
    Self { value: a.value * b.value, slope: a.slope * b.value + a.value * b.slope },
    {
        let value = a.value / b.value;
        Self { value, slope: (a.slope - value * b.slope) / b.value }
    },
    Self { value: -a.value, slope: -a.slope }
);

impl<T: Real> Real for Dual<T> {
    #[inline(always)]
    fn splat(self, x: f64) -> Self {
        Self { value: self.value.splat(x), slope: self.value.splat(0.0) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        // A constant zero has the slope 0, and so has its root; 0/0 would be NaN.
        Self { value: root, slope: self.slope / (root + root).max(root.splat(f64::MIN_POSITIVE)) }
    }
    #[inline(always)]
    fn round(self) -> Self {
        Self { value: self.value.round(), slope: self.value.splat(0.0) }
    }
    #[inline(always)]
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self {
        let pick = |yes: T, no: T| self.value.select_lt(other.value, yes, no);
        Self { value: pick(yes.value, no.value), slope: pick(yes.slope, no.slope) }
    }
    #[inline(always)]
    fn is_lt(self, other: Self) -> bool {
        self.value.is_lt(other.value)
    }
}
