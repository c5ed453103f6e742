//! Slow drifts: columns in, columns filled.

use super::body_of;
use super::watch::Watch;
use crate::drift::{self, Centre, Drift, DriftOutput, DriftStarts, Question};
use crate::loss::{COUNT, Losses};
use crate::state::State;
use numpy::{PyReadonlyArray1, PyReadwriteArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Body (6), state (4), losses.
const COLUMNS: usize = 10 + COUNT;

fn centre_of(code: u8) -> PyResult<Centre> {
    match code {
        0 => Ok(Centre::Rest),
        1 => Ok(Centre::Rolling),
        _ => Err(PyValueError::new_err("no such drift")),
    }
}

fn starts<'a>(columns: &'a [PyReadonlyArray1<'_, f64>; COLUMNS], centre: u8) -> PyResult<DriftStarts<'a>> {
    let slices: Vec<&[f64]> = columns.iter().map(|x| x.as_slice()).collect::<Result<_, _>>()?;
    Ok(DriftStarts {
        centre: centre_of(centre)?,
        bodies: core::array::from_fn(|i| slices[i]),
        states: core::array::from_fn(|i| slices[6 + i]),
        losses: core::array::from_fn(|i| slices[10 + i]),
    })
}

/// Says by name why there is no drift.
#[pyfunction]
pub fn drift_check(body: [f64; 6], state: [f64; 4], losses: [f64; COUNT], centre: u8) -> PyResult<()> {
    let (body, y, losses) = (body_of(&body)?, State::from(state), Losses { coefficients: losses });
    match centre_of(centre)? {
        Centre::Rest => Drift::at_rest(&body, y.theta, &losses)?,
        Centre::Rolling => Drift::rolling(&body, &y, &losses)?,
    };
    Ok(())
}

/// Fills when drifts stop, at which inclination, and the codes of what ends them.
#[pyfunction]
pub fn drift_stops<'py>(
    py: Python<'py>,
    columns: [PyReadonlyArray1<'py, f64>; COLUMNS],
    centre: u8,
    mut stops_at: PyReadwriteArray1<'py, f64>,
    mut ends_at_theta: PyReadwriteArray1<'py, f64>,
    mut ended: PyReadwriteArray1<'py, u8>,
    threads: usize,
) -> PyResult<()> {
    let starts = starts(&columns, centre)?;
    let out = DriftOutput {
        stops_at: stops_at.as_slice_mut()?,
        ends_at_theta: ends_at_theta.as_slice_mut()?,
        ended: ended.as_slice_mut()?,
    };
    let mut watch = Watch::new(None);
    py.detach(|| drift::stops(&starts, out, threads, |share| watch.go_on(share)))?;
    watch.done(py)
}

/// Fills the answers to questions, five numbers each: 0 the time at an inclination, 1 what there is at a time, 2 the
/// time until which rolling is stable.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one argument a number; private to the Python package")]
pub fn drift_ask<'py>(
    py: Python<'py>,
    columns: [PyReadonlyArray1<'py, f64>; COLUMNS],
    centre: u8,
    question: u8,
    of: PyReadonlyArray1<'py, u64>,
    x: PyReadonlyArray1<'py, f64>,
    mut out: PyReadwriteArray1<'py, f64>,
    threads: usize,
) -> PyResult<()> {
    let starts = starts(&columns, centre)?;
    let question = match question {
        0 => Question::Time,
        1 => Question::At,
        2 => Question::Stable,
        _ => return Err(PyValueError::new_err("no such question")),
    };
    let of: Vec<usize> = of.as_slice()?.iter().map(|i| *i as usize).collect();
    let (x, out) = (x.as_slice()?, out.as_slice_mut()?);
    let mut watch = Watch::new(None);
    py.detach(|| drift::ask(&starts, question, (&of, x), out, threads, |share| watch.go_on(share)))?;
    watch.done(py)
}

/// The names of what ends a drift, by their codes.
#[pyfunction]
pub fn drift_ends() -> Vec<&'static str> {
    drift::End::ALL.iter().map(|end| end.name()).collect()
}
