//! Numerical methods, without any physics.

/// Whether the code has to be short rather than fast, as in web pages: then only one copy of each function is compiled.
pub(crate) const SHORT_CODE: bool = cfg!(short_code);

pub(crate) mod antiderivative;
pub(crate) mod beat;
pub(crate) mod falling;
pub(crate) mod flow;
pub(crate) mod gauss;
pub(crate) mod radau;
pub mod rk4;
pub(crate) mod rk8;
pub(crate) mod roots;
pub(crate) mod search;
