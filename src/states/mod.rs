//! Steady states, and their stability.

pub(crate) mod rocking;
pub mod sideways;
pub mod stability;
pub mod steady;
