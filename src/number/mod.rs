//! Numbers: single, in lanes, of twice the digits, with a slope, power series; and the angles among them.

mod angle;
mod dual;
pub(crate) mod gauss;
mod real;
mod series;
mod sum;
mod wide;

pub(crate) use angle::{Short, SinCos, arctan2, short_sincos, sin_cos, sincos, sincos_to_pi};
pub(crate) use dual::Dual;
pub(crate) use real::{Lane, Narrow, Real};
pub(crate) use series::Series;
pub(crate) use sum::{Sum, sin_cos as long_sin_cos, sin_cos_falls as long_sin_cos_falls};
pub(crate) use wide::{LANES, Pair};

/// The best SIMD level of this machine, detected once.
pub(crate) fn level() -> fearless_simd::Level {
    fearless_simd::Level::new()
}
