//! Losses, elementwise: eight coefficients, the normal force, a state, a body.

use super::{of_state, or_nan};
use crate::loss::{COUNT, Law, Losses};
use pyo3::prelude::*;

/// How many numbers `power` takes: coefficients, normal force, state, body.
pub const INPUTS: usize = COUNT + 1 + 4 + super::BODY;

/// The power that is lost; NaN where a coefficient is none.
pub fn power(x: &[f64]) -> f64 {
    let (losses, normal) = losses_of(x);
    or_nan(losses.check().map(|()| of_state(&x[COUNT + 1..], |y, body| losses.power(body, y, normal))))
}

/// The couple along the axis 0, 1 or 2, which is the last input; NaN along another.
pub fn couple(x: &[f64]) -> f64 {
    let (losses, normal) = losses_of(x);
    let Some(axis) = (0..3).find(|axis| *axis as f64 == x[INPUTS]) else { return f64::NAN };
    let of = |x: &[f64]| of_state(x, |y, body| losses.couple(body, y, normal)[axis]);
    or_nan(losses.check().map(|()| of(&x[COUNT + 1..INPUTS])))
}

fn losses_of(x: &[f64]) -> (Losses, f64) {
    (Losses { coefficients: core::array::from_fn(|i| x[i]) }, x[COUNT])
}

/// The laws in the order of their coefficients: the name of each one's, and the exponent of a thin disk's end.
#[pyfunction]
pub fn loss_laws() -> [(&'static str, Option<f64>); COUNT] {
    Law::ALL.map(|law| (law.parameter(), law.exponent()))
}
