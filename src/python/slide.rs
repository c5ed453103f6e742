//! Motions on a table with friction: plain numbers in, a dictionary of plain arrays out.

use super::motion::{NamedArray, dictionary, given_up, tables};
use super::watch::Watch;
use super::{BODY, body_of};
use crate::contact::Friction;
use crate::error::room;
use crate::loss::{COUNT, Losses};
use crate::motion::path::{self, Asked, Table as Contact};
use crate::{Error, State};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The friction of a code, Coulomb 0 (mu and the static coefficient) or viscous 1 (c and nothing).
pub(super) fn friction_of(code: u8, [a, b]: [f64; 2]) -> PyResult<Friction> {
    match code {
        0 => Ok(Friction::Coulomb { mu: a, fixed: b }),
        1 => Ok(Friction::Viscous { c: a }),
        _ => Err(PyValueError::new_err("no such friction")),
    }
}

/// The table of a code: that of a friction, or rolling 2 (mu), or smooth 3.
fn table_of(code: u8, numbers: [f64; 2]) -> PyResult<Contact> {
    match code {
        2 => Ok(Contact::Rolling { mu: numbers[0] }),
        3 => Ok(Contact::Smooth),
        _ => friction_of(code, numbers).map(Contact::from),
    }
}

/// The motion of a body that may slip, and lose energy; None for `tol` means as accurately as doubles allow.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one argument a number; private to the Python package")]
pub fn slide<'py>(
    py: Python<'py>,
    body: [f64; BODY],
    state: [f64; 4],
    slip: [f64; 2],
    t0: f64,
    times: PyReadonlyArray1<'py, f64>,
    friction: u8,
    coefficients: [f64; 2],
    losses: [f64; COUNT],
    tol: Option<f64>,
    pose: bool,
    force: bool,
    restitution: Option<f64>,
    beyond: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let body = body_of(&body)?;
    let times = times.as_slice()?;
    let (losses, tol) = (Losses { coefficients: losses }, tol.unwrap_or(path::FINE));
    let on = Asked::on(table_of(friction, coefficients)?);
    let asked = Asked { losses, tol, pose, force, restitution, beyond, ..on };
    let mut watch = Watch::new(None);
    let found = py.detach(|| {
        let start = State::from(state);
        let path = path::follow(&body, &start, slip, t0, times, &asked, || watch.still())?;
        let Some(path) = path else { return Ok(None) };
        let Some(mut tables) = tables(&path.motion, &body, &mut || watch.still())? else { return Ok(None) };
        if let Some(table) = tables.iter_mut().find(|table| table.name == "orientation") {
            table.numbers = path.orientations().flat_map(|q| [q.i, q.j, q.k, q.w]).collect();
        }
        let mut numbers = room(2 * path.slip.len())?;
        numbers.extend(path.slip.iter().flatten());
        tables.push(NamedArray { name: "slip", numbers, width: 2 });
        tables.push(NamedArray { name: "dissipated", numbers: path.dissipated.clone(), width: 0 });
        if !losses.is_none() {
            tables.push(NamedArray { name: "work_lost", numbers: path.work_lost.clone(), width: 0 });
        }
        Ok::<_, Error>(Some((path, tables)))
    })?;
    watch.done(py)?;
    let Some((path, tables)) = found else { return Err(given_up()) };
    let out = dictionary(py, &path.motion, tables)?;
    let codes = path.kinds.iter().map(|kind| *kind as u8).collect();
    out.set_item("phase", PyArray1::<u8>::from_vec(py, codes))?;
    let phases: Vec<(f64, u8, [f64; 6])> = path
        .phases
        .iter()
        .map(|phase| {
            let State { theta, w1, w2, w3 } = phase.state;
            (phase.time, phase.kind as u8, [theta, w1, w2, w3, phase.slip[0], phase.slip[1]])
        })
        .collect();
    out.set_item("phases", phases)?;
    if let Some(event) = path.motion.event {
        let State { theta, w1, w2, w3 } = event.state;
        let [along, across] = path.last_slip;
        out.set_item("event", (event.time, [theta, w1, w2, w3, along, across]))?;
    }
    out.set_item("method", "dop853")?;
    Ok(out)
}
