//! Many motions with friction or losses: columns in, columns filled.

use super::motion::table_of;
use super::watch::Watch;
use crate::ensemble::slips::{self, SUMMARIES, SlipJob, SlipOutput, SlipStarts};
use crate::loss::COUNT;
use numpy::{PyReadonlyArray1, PyReadwriteArray1};
use pyo3::prelude::*;

/// Fills the columns of an ensemble with friction or losses: bodies (5), states (4), slips (2), tables (2) and losses (8) or none,
/// each of length n or 1; then six of states (n times the times) or None, six of the last, and the summaries.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one argument a number; private to the Python package")]
pub fn slides<'py>(
    py: Python<'py>,
    columns: [PyReadonlyArray1<'py, f64>; 13],
    losses: Option<[PyReadonlyArray1<'py, f64>; COUNT]>,
    table: u8,
    times: PyReadonlyArray1<'py, f64>,
    tol: f64,
    restitution: Option<f64>,
    stop_at_rolling: bool,
    states: Option<[PyReadwriteArray1<'py, f64>; 6]>,
    last: Option<[PyReadwriteArray1<'py, f64>; 6]>,
    mut summary: [Option<PyReadwriteArray1<'py, f64>>; SUMMARIES],
    mut error: PyReadwriteArray1<'py, f64>,
    mut status: PyReadwriteArray1<'py, u8>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<()> {
    let on = table_of(table)?;
    let (mut states, mut last) = (states, last);
    let slices: Vec<&[f64]> = columns.iter().map(|x| x.as_slice()).collect::<Result<_, _>>()?;
    let pick = |i: usize| slices[i];
    let coefficients = match &losses {
        Some(all) => {
            let all: Vec<&[f64]> = all.iter().map(|x| x.as_slice()).collect::<Result<_, _>>()?;
            Some(core::array::from_fn(|i| all[i]))
        }
        None => None,
    };
    let starts = SlipStarts {
        bodies: core::array::from_fn(pick),
        states: core::array::from_fn(|i| pick(5 + i)),
        slips: core::array::from_fn(|i| pick(9 + i)),
        coefficients: core::array::from_fn(|i| pick(11 + i)),
        table: on,
        losses: coefficients,
    };
    let job = SlipJob { times: times.as_slice()?, tol, restitution, stop_at_rolling };
    fn six<'a>(x: &'a mut Option<[PyReadwriteArray1<'_, f64>; 6]>) -> Option<[&'a mut [f64]; 6]> {
        x.as_mut().map(|x| x.each_mut().map(|x| x.as_slice_mut().expect("contiguous")))
    }
    let out = SlipOutput {
        states: six(&mut states),
        last: six(&mut last),
        summary: summary.each_mut().map(|x| x.as_mut().map(|x| x.as_slice_mut().expect("contiguous"))),
        error: error.as_slice_mut()?,
        status: status.as_slice_mut()?,
    };
    let mut watch = Watch::new(progress);
    py.detach(|| slips::follow(&starts, &job, out, threads, |share| watch.go_on(share)))?;
    watch.done(py)
}
