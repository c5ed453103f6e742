//! States that last: steady states, and whether they are stable.

pub mod stability;
pub mod steady;
