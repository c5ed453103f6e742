//! Steady states, and their stability.

pub mod stability;
pub mod steady;
