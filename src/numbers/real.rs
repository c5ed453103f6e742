//! Real numbers: every equation of this library is written over the trait of this file.
//!
//! An equation is written once over [`Real`] and serves a single state, eight states in SIMD lanes, a state with twice
//! the digits, and a state with a derivative. Every operation of single numbers and of lanes is correctly rounded, also
//! the fused one on machines without it. Therefore the bits of a lane do not depend on its neighbours, the SIMD width
//! or the machine. Only [`Real::mac`] differs between a single number and a lane.

use core::ops::{Add, Div, Mul, Neg, Sub};

/// Implements the operators of a type of numbers, each from an expression in its operands.
macro_rules! operators {
    ([$($generic:tt)*] $kind:ty, ($a:ident, $b:ident), $add:expr, $sub:expr, $mul:expr, $div:expr, $neg:expr) => {
        operators!(@one [$($generic)*] $kind, Add, add, $a, ($b: Self), $add);
        operators!(@one [$($generic)*] $kind, Sub, sub, $a, ($b: Self), $sub);
        operators!(@one [$($generic)*] $kind, Mul, mul, $a, ($b: Self), $mul);
        operators!(@one [$($generic)*] $kind, Div, div, $a, ($b: Self), $div);
        operators!(@one [$($generic)*] $kind, Neg, neg, $a, (), $neg);
    };
    (@one [$($generic:tt)*] $kind:ty, $operator:ident, $name:ident, $a:ident, ($($other:tt)*), $work:expr) => {
        impl<$($generic)*> core::ops::$operator for $kind {
            type Output = Self;
            #[inline(always)]
            fn $name(self, $($other)*) -> Self {
                let $a = self;
                $work
            }
        }
    };
}
pub(super) use operators;

/// A real number, or eight real numbers in SIMD lanes.
pub(crate) trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The constant `x` in as many SIMD lanes as `self` has.
    fn splat(self, x: f64) -> Self;
    /// The square root; NaN below zero.
    fn sqrt(self) -> Self;
    /// The nearest whole number; of two that are equally near, the even one.
    fn round(self) -> Self;
    /// Returns `yes` where `self < other`, `no` elsewhere (also for NaN).
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self;

    /// Whether `self < other` is known for all values that this number stands for, so that the other case need not be computed.
    #[inline(always)]
    fn is_lt(self, _: Self) -> bool {
        false
    }

    /// `self * b + c`, rounded once for single numbers and SIMD lanes; for other kinds of numbers a product and a sum.
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        self * b + c
    }

    /// `self * b + c`, rounded once in SIMD lanes and twice in a single number, because a processor may lack the
    /// instruction.
    #[inline(always)]
    fn mac(self, b: Self, c: Self) -> Self {
        self.fma(b, c)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.select_lt(self.splat(0.0), -self, self)
    }

    /// This number where it is positive or NaN, else zero.
    #[inline(always)]
    fn positive_part(self) -> Self {
        let zero = self.splat(0.0);
        self.select_lt(zero, zero, self)
    }

    /// The smaller of the two numbers; `other` if `self` is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.select_lt(other, self, other)
    }

    /// The larger of the two numbers; `other` if `self` is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        other.select_lt(self, self, other)
    }
}

/// Numbers with comparisons over all SIMD lanes: a single number, or eight numbers in lanes.
pub(crate) trait Lane: Real {
    /// Whether `self < other` in any SIMD lane.
    fn any_lt(self, other: Self) -> bool;

    /// Whether any SIMD lane is positive.
    #[inline(always)]
    fn any(self) -> bool {
        self.splat(0.0).any_lt(self)
    }

    /// Calls `work`, which is rarely needed, in a function that is compiled separately for the same SIMD lanes, so that
    /// frequent work stays compact.
    fn aside<R>(self, work: impl FnOnce() -> R) -> R;
}

impl Lane for f64 {
    #[inline(always)]
    fn any_lt(self, other: Self) -> bool {
        self < other
    }
    #[cold]
    #[inline(never)]
    fn aside<R>(self, work: impl FnOnce() -> R) -> R {
        work()
    }
}

impl Real for f64 {
    #[inline(always)]
    fn splat(self, x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        self.mul_add(b, c)
    }
    #[inline(always)]
    fn mac(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    #[inline(always)]
    fn round(self) -> Self {
        self.round_ties_even()
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self {
        if self < other { yes } else { no }
    }
    #[inline(always)]
    fn is_lt(self, other: Self) -> bool {
        self < other
    }
}
