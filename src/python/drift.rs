//! Functions for Python that compute slow drifts; they read and fill columns by name.

use super::body_of;
use super::columns::{GivenColumns, STATE, code_column, numbers};
use super::loss::parameters;
use super::watch::Watch;
use crate::error::room;
use crate::laws::loss::{COUNT, Losses};
use crate::laws::state::State;
use crate::many::columns::LossColumns;
use crate::many::drifts::{self as drift, Centre, DriftAnswer, DriftOutput, DriftStarts, Question};
use crate::motions::drift::Drift;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

const DRIFT_BODY: [&str; 6] = ["ell", "i1", "i3", "bore", "fillet", "theta_end"];

fn centre_of(word: &str) -> PyResult<Centre> {
    match word {
        "rest" => Ok(Centre::Rest),
        "rolling" => Ok(Centre::Rolling),
        _ => Err(PyValueError::new_err(r#"centre: expected "rest" or "rolling""#)),
    }
}

fn starts<'a>(given: &'a GivenColumns<'_>, centre: &str) -> PyResult<DriftStarts<'a>> {
    Ok(DriftStarts {
        centre: centre_of(centre)?,
        bodies: given.all(DRIFT_BODY)?,
        states: given.all(STATE)?,
        losses: LossColumns(given.all(parameters())?),
    })
}

/// Checks the initial state of a drift: raises ValueError with the reason if there is no drift.
#[pyfunction]
pub fn drift_check(body: [f64; 6], state: [f64; 4], losses: [f64; COUNT], centre: &str) -> PyResult<()> {
    let (body, y, losses) = (body_of(&body)?, State::from(state), Losses { coefficients: losses });
    match centre_of(centre)? {
        Centre::Rest => Drift::at_rest(&body, y.theta, &losses)?,
        Centre::Rolling => Drift::rolling(&body, &y, &losses)?,
    };
    Ok(())
}

/// Fills the columns `stops_at`, `ends_at_theta` and `ended` (codes of the ends) of `out`, for the drifts of `given`.
#[pyfunction]
pub fn drift_stops<'py>(
    py: Python<'py>,
    given: Bound<'py, PyDict>,
    centre: &str,
    out: Bound<'py, PyDict>,
    threads: usize,
) -> PyResult<()> {
    let given = GivenColumns::of(&given)?;
    let starts = starts(&given, centre)?;
    let (mut stops_at, mut ends_at_theta) = (numbers(&out, "stops_at")?, numbers(&out, "ends_at_theta")?);
    let mut ended = code_column(&out, "ended")?;
    let out = DriftOutput {
        stops_at: stops_at.as_slice_mut()?,
        ends_at_theta: ends_at_theta.as_slice_mut()?,
        ended: ended.as_slice_mut()?,
    };
    let mut watch = Watch::new(None);
    py.detach(|| drift::stops(&starts, out, threads, |share| watch.go_on(share)))?;
    watch.done(py)
}

/// Evaluates drifts, with five numbers per result. Question 0 is the time at an inclination, 1 the state at a time, 2
/// the time until which rolling is stable. `of` has the index of each drift, and `x` the inclination or time.
#[pyfunction]
pub fn drift_ask<'py>(
    py: Python<'py>,
    given: Bound<'py, PyDict>,
    centre: &str,
    question: u8,
    of: PyReadonlyArray1<'py, u64>,
    x: PyReadonlyArray1<'py, f64>,
    threads: usize,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let given = GivenColumns::of(&given)?;
    let starts = starts(&given, centre)?;
    let question = match question {
        0 => Question::Time,
        1 => Question::At,
        2 => Question::Stable,
        _ => return Err(PyValueError::new_err("question: expected 0 (time), 1 (state) or 2 (stability)")),
    };
    let of: Vec<usize> = of.as_slice()?.iter().map(|i| *i as usize).collect();
    let x = x.as_slice()?;
    let mut found = room(x.len())?;
    found.resize(x.len(), DriftAnswer::NONE);
    let mut watch = Watch::new(None);
    py.detach(|| drift::ask(&starts, question, (&of, x), &mut found, threads, |share| watch.go_on(share)))?;
    watch.done(py)?;
    let mut out = room(x.len() * 5)?;
    out.extend(found.iter().flat_map(|of| {
        // Only the state at a time has more than one number.
        let first = if question == Question::At { of.theta } else { of.time };
        [first, of.w1, of.w3, of.precession, of.friction_coefficient]
    }));
    Ok(PyArray1::from_vec(py, out))
}
