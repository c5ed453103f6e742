//! Motions by RK4: the steps up to an event, and the judgement of a fixed step.

pub(crate) mod course;
pub(crate) mod guard;
pub(crate) mod stepped;

pub(crate) use stepped::stepped;
