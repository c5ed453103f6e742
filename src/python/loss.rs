//! Elementwise functions of losses; the inputs are the coefficients of all laws, the normal force, a state and a body.

use super::{of_state, or_nan};
use crate::laws::loss::{COUNT, Law, Losses};
use pyo3::prelude::*;

/// Number of inputs of `power`: coefficients, normal force, state and body.
pub const INPUTS: usize = COUNT + 1 + 4 + super::BODY;

/// The power that the losses take, in M g sqrt(g R); NaN if a coefficient is invalid.
pub fn power(x: &[f64]) -> f64 {
    let (losses, normal) = losses_of(x);
    or_nan(losses.check().map(|()| of_state(&x[COUNT + 1..], |y, body| losses.power(body, y, normal))))
}

/// The couple of the losses along the axis 0, 1 or 2, which is the last input; NaN for any other axis.
pub fn couple(x: &[f64]) -> f64 {
    let (losses, normal) = losses_of(x);
    let Some(axis) = (0..3).find(|axis| *axis as f64 == x[INPUTS]) else { return f64::NAN };
    let of = |x: &[f64]| of_state(x, |y, body| losses.couple(body, y, normal)[axis]);
    or_nan(losses.check().map(|()| of(&x[COUNT + 1..INPUTS])))
}

fn losses_of(x: &[f64]) -> (Losses, f64) {
    (Losses { coefficients: core::array::from_fn(|i| x[i]) }, x[COUNT])
}

/// The properties of a loss law for Python, apart from the documentation of its class.
#[derive(IntoPyObject)]
pub struct LossRow {
    /// The name of the coefficient.
    parameter: &'static str,
    /// The exponent q in theta ~ tau^q of a thin disk, with tau the time before its end; None if it never stops.
    exponent: Option<f64>,
    /// The quantity that the unit of the coefficient measures.
    measures: &'static str,
    /// The unit of the coefficient: in natural units, in SI, and as it is printed and read.
    natural: &'static str,
    si: &'static str,
    printed: &'static str,
    /// The exponents of metre, second and joule in the unit of the coefficient.
    exponents: [f64; 3],
    /// Whether the law also acts on a body in the air.
    in_air: bool,
    /// The formula of the couple in a scene file.
    couple: &'static str,
}

/// The rows of the table of loss laws, in its order.
#[pyfunction]
pub fn loss_laws() -> Vec<LossRow> {
    let row = |law: &Law| {
        let ([measures, natural, si, printed], exponents) = (law.unit().texts(), law.unit().exponents());
        let (parameter, exponent, in_air) = (law.parameter(), law.exponent(), law.acts_in_air());
        let couple = law.couple_in_si();
        LossRow { parameter, exponent, measures, natural, si, printed, exponents, in_air, couple }
    };
    Law::ALL.iter().map(row).collect()
}

/// The names of the coefficients of all laws.
pub fn parameters() -> [&'static str; COUNT] {
    core::array::from_fn(|i| Law::ALL[i].parameter())
}
