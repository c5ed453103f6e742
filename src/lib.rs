#![doc = include_str!("../docs/rust.md")]
//!
//! # The map
//!
//! Reading order is dependency order; no module imports from a later one. The last column has the equations.
//!
//! | module | contents | an equation |
//! | --- | --- | --- |
//! | [`body`] | moments of inertia, theta0, thetaInf, circle of contact | g = ell s - a c, h = a s + ell c + rho |
//! | [`state`] | inclination and angular velocity, and numbers derived from them | phi' = w1/s, psi' = w3 - ct w1 |
//! | [`scale`] | metres, kilograms and seconds | time in sqrt(R/g) |
//! | [`newton`] | the motion under a given force | I1 w2' = I3 w1 w3 - I1 ct w1^2 - g N - h Fh |
//! | [`loss`] | laws of the energy that contact and air take | P = -m.w |
//! | [`contact`] | the force of a table: [`rolling`], [`smooth`], slip; the landing of a rim | F = v' + Wf x v + z |
//! | [`throw`] | the state in which a body leaves the hand | v_2 = J (f cos beta - sin beta) + Q |
//! | [`steady`] | steady states, their inverse, folds and ridge | rate^2 = n A/(s (n + d A c)), n = -g |
//! | [`stability`] | stability of steady states: smooth table, rolling | kappa = -dtheta''/dtheta along the lines |
//! | [`drift`] | slow drift along steady states, to rest | theta' = -P/E'(theta) |
//! | [`pose`] | the orientation, the contact path and the centre of the body | P' = A psi' e2 - rho theta' e_h |
//! | [`rk4`] | one step of the method of Runge and Kutta, without physics | y + h (k1 + 2 k2 + 2 k3 + k4)/6 |
//! | [`exact`] | the solution by first integrals, at any time | dt = s^2 sqrt(J/G) dx |
//! | [`motion`] | a motion: times, states, and the event that ends it | N > 0, F <= mu N, theta < theta_end |
//! | [`stone`] | ellipsoids with any inertia: rattlebacks, eggs | (I + r^2 - r r^T) w' = ... + r x n |
//! | [`sweep`] | steady states over dense grids, on lanes and threads | |
//! | [`ensemble`] | many motions at once, on lanes and threads | |
//!
//! Below these are `number` (single, eight in lanes, twice the digits, with a slope; sine and cosine), `roots` (real
//! roots of a polynomial), `rk8` (a step of eighth order), `flow` (its steps up to an end, alone and in lanes), `search`
//! (zeros, minima), `antiderivative` (quadrature), `threads`, `columns`, `codes` and `error`.
//! Rolling and smooth share `contact::reduced`: J w2' = w1 (ct (k w3 - al w1) + b w3 - k w1) - g + (J'/2) w2^2.

// Without the modules for many bodies, without lanes, or with only one width of lanes, some items are not used.
#![cfg_attr(
    any(not(feature = "many"), not(lanes_of_eight), all(target_arch = "x86_64", not(lanes_of_sixteen))),
    allow(dead_code, unused_imports, unused_variables)
)]

mod antiderivative;
pub mod body;
mod codes;
#[cfg(feature = "many")]
mod columns;
pub mod contact;
#[cfg(feature = "many")]
pub mod drift;
#[cfg(feature = "many")]
pub mod ensemble;
mod error;
pub mod exact;
mod flow;
pub mod loss;
pub mod motion;
pub mod newton;
mod number;
pub mod pose;
pub mod rk4;
mod rk8;
mod roots;
pub mod scale;
mod search;
pub mod stability;
pub mod state;
pub mod steady;
pub mod stone;
#[cfg(feature = "many")]
pub mod sweep;
mod threads;
pub mod throw;

#[cfg(feature = "python")]
mod python;

/// The example of the README runs as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}

pub use body::Body;
pub use contact::{Contact, rolling, smooth};
pub use error::Error;
pub use motion::{Motion, roll};
pub use scale::Scale;
pub use state::State;
pub use stone::Ellipsoid;
