//! Motions by RK4 with a fixed step: the check of the step, and the steps up to the end of the motion.

mod guard;
mod stepped;
mod steps;

pub(crate) use stepped::stepped;
