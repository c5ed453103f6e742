#![doc = include_str!("../README.md")]
//!
//! # The map
//!
//! Reading order is dependency order; no room imports from a later one.
//!
//! | room | what it knows |
//! | --- | --- |
//! | [`body`] | aspect ratio, moments of inertia, theta0 and thetaInf |
//! | [`state`] | inclination and angular velocity, and what can be read off them; SI scale |
//! | [`steady`] | steady states, their inverse, folds and ridge |
//! | [`rolling`] | equations of motion without slipping, energy |
//! | [`stability`] | two questions, two names: smooth table, rolling |
//! | [`sweep`] | the above over dense grids, on lanes and threads |
//!
//! Below them `real` (numbers, lanes, sine and cosine) and `roots` (real roots of a polynomial).

pub mod body;
mod error;
mod real;
pub mod rolling;
mod roots;
pub mod stability;
pub mod state;
pub mod steady;
pub mod sweep;

#[cfg(feature = "python")]
mod python;

pub use body::Body;
pub use error::Error;
pub use state::{Scale, State};

/// The best SIMD level of this machine, detected once.
fn level() -> fearless_simd::Level {
    fearless_simd::Level::new()
}
