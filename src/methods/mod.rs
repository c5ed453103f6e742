//! Numerical methods, without any physics.

pub(crate) mod antiderivative;
pub(crate) mod beat;
pub(crate) mod flow;
pub(crate) mod gauss;
pub mod rk4;
pub(crate) mod rk8;
pub(crate) mod roots;
pub(crate) mod search;
