//! Many bodies at once, in SIMD lanes and on threads. This folder is the cargo feature `many`.

pub(crate) mod columns;
pub mod drifts;
pub mod maps;
pub mod motions;
pub(crate) mod stones;
pub(crate) mod threads;
