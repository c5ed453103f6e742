//! The kinds of numbers: single numbers, SIMD lanes, sums with twice the digits, dual numbers and power series; sines,
//! cosines, arc tangents.

mod angle;
pub(crate) mod codes;
mod dual;
#[cfg(feature = "serde")]
pub(crate) mod file;
pub(crate) mod power;
mod real;
mod series;
pub(crate) mod side_by_side;
mod sum;
pub(crate) mod tape;
pub(crate) mod vector;
mod wide;

pub(crate) use angle::{Short, SinCos, arctan2, short_sincos, sin_cos, sincos};
pub(crate) use dual::Dual;
pub(crate) use real::{Lane, Real};
pub(crate) use series::{Series, TERMS};
pub(crate) use side_by_side::Narrow;
pub(crate) use sum::{Sum, sin_cos as long_sin_cos, sin_cos_falls as long_sin_cos_falls};
pub(crate) use wide::{LANES, Pair};

use fearless_simd::Level;
use std::sync::LazyLock;

/// The best SIMD level of this machine for which the code is compiled; None if `SPINCYL_LANES=off` is set in the
/// environment.
static LEVEL: LazyLock<Option<Level>> = LazyLock::new(|| {
    let off = std::env::var_os("SPINCYL_LANES").is_some_and(|set| set == "off");
    if off || !cfg!(lanes_of_eight) { None } else { best() }
});

#[cfg(any(lanes_of_sixteen, not(any(target_arch = "x86", target_arch = "x86_64"))))]
fn best() -> Option<Level> {
    Some(Level::new())
}

/// The best SIMD level in a build without AVX-512: processors with AVX-512 then use their AVX2.
#[cfg(not(any(lanes_of_sixteen, not(any(target_arch = "x86", target_arch = "x86_64")))))]
fn best() -> Option<Level> {
    Level::new().as_avx2().map(Level::Avx2)
}

pub(crate) fn level() -> Option<Level> {
    *LEVEL
}

/// AVX2, if this machine has it. AVX-512 would not speed up computations with a few numbers.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
pub(crate) fn avx2() -> Option<fearless_simd::x86::Avx2> {
    level().and_then(Level::as_avx2)
}

/// None: processors that are not x86 have no AVX2.
#[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
pub(crate) fn avx2() -> Option<()> {
    None
}

/// Whether `in_registers` also compiles its work for AVX2, so that the plain version serves only old processors.
pub(crate) const COMPILES_AVX2: bool =
    cfg!(all(any(target_arch = "x86", target_arch = "x86_64"), lanes_of_eight));

/// The sign of a number: 1, -1, or 0 for zero.
pub(crate) fn sign_or_zero(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// Evaluates `$lanes`, compiled for AVX-512, AVX2 or NEON, on a processor that has it, with the token `$simd`, which
/// makes SIMD lanes; evaluates `$alone` on any other processor. There are no more levels, since each level compiles all
/// of this code once more.
macro_rules! in_lanes {
    ($level:expr, $simd:pat => $lanes:expr, else $alone:expr) => {
        match $level {
            #[cfg(lanes_of_sixteen)]
            Some(fearless_simd::Level::Avx512(simd)) => $crate::numbers::in_lanes!(@on simd, $simd => $lanes),
            #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), lanes_of_eight))]
            Some(fearless_simd::Level::Avx2(simd)) => $crate::numbers::in_lanes!(@on simd, $simd => $lanes),
            #[cfg(all(target_arch = "aarch64", lanes_of_eight))]
            Some(fearless_simd::Level::Neon(simd)) => $crate::numbers::in_lanes!(@on simd, $simd => $lanes),
            _ => $alone,
        }
    };
    (@on $found:ident, $simd:pat => $lanes:expr) => {
        fearless_simd::Simd::vectorize(
            $found,
            #[inline(always)]
            || {
                let $simd = $found;
                $lanes
            },
        )
    };
}
pub(crate) use in_lanes;

/// Evaluates `$work` on single numbers, compiled for AVX2 where the processor has it: a register then holds several
/// numbers, and a fused product is one instruction. `$plain` gives the same results on any other processor.
macro_rules! in_registers {
    ($work:expr) => {
        $crate::numbers::in_registers!($work, else $work)
    };
    ($work:expr, else $plain:expr) => {
        match $crate::numbers::avx2() {
            #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), lanes_of_eight))]
            Some(simd) => $crate::numbers::in_lanes!(@on simd, _ => $work),
            _ => $plain,
        }
    };
}
pub(crate) use in_registers;

/// The larger of two errors; NaN if one of them is NaN.
pub(crate) fn larger_or_nan(error: f64, other: f64) -> f64 {
    if error.is_nan() || other <= error { error } else { other }
}

/// Returns the closure. Rust accepts `#[inline(always)]` on a closure that is an argument, not on one bound
/// by `let`.
#[inline(always)]
pub(crate) fn here<F>(f: F) -> F {
    f
}
