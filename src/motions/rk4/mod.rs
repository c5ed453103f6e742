//! Motions by RK4 (the classical Runge-Kutta method) with a fixed step: the check of the step, and the integration.

mod guard;
mod stepped;
mod steps;

pub(crate) use stepped::stepped;
