//! Many bodies at once, on lanes and threads. This folder is the feature `many`.

pub(crate) mod columns;
pub mod drifts;
pub mod maps;
pub mod motions;
pub(crate) mod stones;
pub(crate) mod threads;
