#![doc = include_str!("../docs/rust.md")]
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
//! | [`smooth`] | the same on a frictionless table |
//! | [`contact`] | which of the two; contact force, friction demand |
//! | [`stability`] | two questions, two names: smooth table, rolling |
//! | [`pose`] | where the body is: orientation, contact path, centre |
//! | [`rk4`] | one step of Runge and Kutta; knows no physics |
//! | [`exact`] | the solution by first integrals, at any time |
//! | [`motion`] | a body on its way: times, states, how it ended |
//! | [`sweep`] | steady states over dense grids, on lanes and threads |
//! | [`ensemble`] | many motions at once, on lanes and threads |
//!
//! Below them `real` (numbers, lanes, sine and cosine), `sum` (twice the digits), `roots` (real roots of a polynomial), `threads` and `law` (the
//! coefficients that equations of motion and first integrals share).

pub mod body;
pub mod contact;
pub mod ensemble;
mod error;
pub mod exact;
pub mod motion;
pub mod newton;
mod number;
pub mod pose;
pub mod rk4;
mod roots;
pub mod scale;
mod search;
pub mod stability;
pub mod state;
pub mod steady;
pub mod sweep;
mod threads;

#[cfg(feature = "python")]
mod python;

/// The example of the README runs, too.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}

pub use body::Body;
pub use contact::{Contact, rolling, smooth};
pub use error::Error;
pub use motion::{Motion, roll};
pub use scale::Scale;
pub use state::State;
