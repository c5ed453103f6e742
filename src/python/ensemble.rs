//! Functions for Python that compute many motions; they read and fill columns by name.

use super::columns::{FilledColumns, GivenColumns, STATE, circles_of, code_column};
use super::custom::with_laws;
use super::loss::parameters;
use super::options::{MotionAsked, table_of};
use super::watch::Watch;
use crate::laws::loss::Losses;
use crate::many::columns::LossColumns;
use crate::many::motions::{
    CustomLaws, Job, MotionOutput, MotionStarts, SUMMARIES, Summary, roll_among, roll_custom,
};
use crate::motions::{Ask, Method};
use numpy::{PyReadonlyArray1, PyReadwriteArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

const MOTION_BODY: [&str; 5] = ["ell", "i1", "i3", "fillet", "theta_end"];
const SLIP: [&str; 2] = ["slip_along", "slip_across"];
/// The names of the columns of the coefficients of friction: mu or c, the static coefficient, and the radius of the patch.
const TABLE: [&str; 3] = ["coefficient", "static", "patch"];

/// Name, unit and description of the output columns that are not summaries.
const LABELS: [[&str; 3]; 10] = [
    ["theta", "rad", "inclination"],
    ["w1", "sqrt(g/R)", "angular velocity along e1, phi' sin theta"],
    ["w2", "sqrt(g/R)", "angular velocity along e2, -theta'"],
    ["w3", "sqrt(g/R)", "angular velocity along the axis of the body"],
    ["slip_along", "sqrt(g R)", "slip along the lean"],
    ["slip_across", "sqrt(g R)", "slip across the lean"],
    ["rim", "1", "rim from which the state is seen: 0 the first, 1 the other"],
    ["error", "1", "estimated error of the states"],
    ["method", "1", "code of spincyl.sweep.Answer"],
    ["status", "1", "code of spincyl.sweep.Status"],
];

/// Name, unit and description of every output column.
#[pyfunction]
pub fn columns() -> Vec<[&'static str; 3]> {
    Summary::ALL.iter().copied().map(Summary::label).chain(LABELS).collect()
}

/// The names of the summaries of motions with a contact of this kind, with or without losses and restitution.
#[pyfunction]
pub fn summaries(table: u8, loses: bool, flies: bool) -> PyResult<Vec<&'static str>> {
    let rubs = table_of(table)?.rubs();
    let of = Summary::ALL.iter().copied().filter(|summary| summary.is_of(rubs, loses, flies));
    Ok(of.map(|summary| summary.label()[0]).collect())
}

/// Fills the columns of `out` from those of `given`, by name; a given column has n numbers or one. The given columns
/// are those of bodies and states and, if present, of slips, contacts and losses (by their parameters). With `spread` a
/// column of states has n times as many numbers as there are times. `threads` has the number of threads, and whether
/// the calling thread is one of them, which then needs a large stack.
#[pyfunction]
pub fn ensemble<'py>(
    py: Python<'py>,
    given: Bound<'py, PyDict>,
    times: PyReadonlyArray1<'py, f64>,
    asked: MotionAsked,
    out: Bound<'py, PyDict>,
    threads: (usize, bool),
    progress: Option<Py<PyAny>>,
) -> PyResult<()> {
    let given = GivenColumns::of(&given)?;
    let circles = circles_of(&given)?;
    let starts = MotionStarts {
        circles: &circles,
        bodies: given.all(MOTION_BODY)?,
        states: given.all(STATE)?,
        slips: given.some(SLIP)?,
        slopes: given.some(["slope", "phi0"])?,
        coefficients: given.some(TABLE)?,
        losses: given.some(parameters())?.map(LossColumns),
        aloft: given.some(["height", "lift"])?,
    };
    let tol =
        asked.tol.ok_or_else(|| PyValueError::new_err("tol: expected this option, which is missing"))?;
    let method = asked.step.map_or(Method::Exact, Method::Step);
    let ask = Ask { method, losses: Losses::NONE, ..asked.ask()? };
    let job = Job { ask, times: times.as_slice()?, tol, errors: asked.errors };
    let (mut method, mut status) = (code_column(&out, "method")?, code_column(&out, "status")?);
    let mut numbers: Vec<(String, PyReadwriteArray1<'py, f64>)> = Vec::new();
    for (name, x) in out.iter() {
        let name: String = name.extract()?;
        if name != "method" && name != "status" {
            numbers.push((name, x.extract()?));
        }
    }
    let mut wanted = Vec::new();
    for (name, array) in &mut numbers {
        wanted.push((name.as_str(), Some(array.as_slice_mut()?)));
    }
    let mut wanted = FilledColumns(wanted);
    let shown = (wanted.some(STATE), wanted.some(SLIP), wanted.take("rim"));
    let none = (None, None, None);
    let ((states, slips, rims), (last, last_slip, last_rim)) =
        if asked.spread { (shown, none) } else { (none, shown) };
    let mut summary = [const { None }; SUMMARIES];
    for &kind in Summary::ALL {
        summary[kind as usize] = wanted.take(kind.label()[0]);
    }
    let error =
        wanted.take("error").ok_or_else(|| PyValueError::new_err("out: expected a column named error"))?;
    let (method, status) = (method.as_slice_mut()?, status.as_slice_mut()?);
    let out = MotionOutput { states, slips, rims, last, last_slip, last_rim, summary, error, method, status };
    let mut watch = Watch::new(progress);
    let mut go_on = |share: f64| watch.go_on(share);
    if asked.calls_python() {
        with_laws(py, &asked, |laws| {
            roll_custom(&starts, &job, out, (&CustomLaws::ThisThread(laws), threads), &mut go_on)
        })??;
    } else if asked.is_custom() {
        let pointed = asked.pointed();
        let of = || pointed.custom();
        py.detach(|| roll_custom(&starts, &job, out, (&CustomLaws::AnyThread(&of), threads), &mut go_on))?;
    } else {
        py.detach(|| roll_among(&starts, &job, out, threads, &mut go_on))?;
    }
    watch.done(py)
}
