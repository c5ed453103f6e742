//! Motions: plain arrays in, a dictionary of plain arrays out.

use super::watch::Watch;
use super::{BODY, body_of};
use crate::error::room;
use crate::exact::Swing;
use crate::motion::{self, Ask, Method, Motion};
use crate::{Body, Contact, Error, State};
use numpy::ndarray::ArrayView2;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Numbers for an array of Python's, row by row.
pub(super) struct NamedArray {
    pub name: &'static str,
    pub numbers: Vec<f64>,
    /// Numbers in a row; 0 of plain numbers.
    pub width: usize,
}

/// So many rows between two looks at whether to go on.
const ROWS: usize = 1 << 12;

/// What Python is given of a motion; None if it is told to stop.
pub(super) fn tables(
    m: &Motion,
    body: &Body,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Vec<NamedArray>>, Error> {
    let mut tables = Vec::new();
    let mut all = true;
    let mut add = |name: &'static str, width: usize, row: &dyn Fn(usize, &mut Vec<f64>)| {
        let mut numbers = room(m.times.len() * width.max(1))?;
        for i in 0..m.times.len() {
            all = all && (i % ROWS != 0 || go_on());
            if !all {
                break;
            }
            row(i, &mut numbers);
        }
        tables.push(NamedArray { name, numbers, width });
        Ok::<_, Error>(())
    };
    add("t", 0, &|i, to| to.push(m.times[i]))?;
    add("theta", 0, &|i, to| to.push(m.states[i].theta))?;
    add("w", 3, &|i, to| to.extend([m.states[i].w1, m.states[i].w2, m.states[i].w3]))?;
    if let Some(poses) = &m.poses {
        add("phi", 2, &|i, to| to.extend([poses[i].phi.turns, poses[i].phi.rest]))?;
        add("psi", 2, &|i, to| to.extend([poses[i].psi.turns, poses[i].psi.rest]))?;
        add("contact_point", 2, &|i, to| to.extend([poses[i].contact_point.x, poses[i].contact_point.y]))?;
        add("orientation", 4, &|i, to| {
            let q = poses[i].orientation(&m.states[i]);
            to.extend([q.i, q.j, q.k, q.w]);
        })?;
        add("centre", 3, &|i, to| to.extend(<[f64; 3]>::from(poses[i].centre(body, &m.states[i]).coords)))?;
    }
    if let Some(forces) = &m.forces {
        add("normal", 0, &|i, to| to.push(forces[i].normal))?;
        add("friction", 0, &|i, to| to.push(forces[i].friction()))?;
        add("friction_coefficient", 0, &|i, to| to.push(forces[i].friction_coefficient()))?;
    }
    Ok(all.then_some(tables))
}

/// The contact of a code.
pub(super) fn contact_of(code: u8) -> PyResult<Contact> {
    [Contact::Rolling, Contact::Smooth]
        .into_iter()
        .find(|contact| *contact as u8 == code)
        .ok_or_else(|| PyValueError::new_err("no such contact"))
}

/// The motion of a body; None for `step` and `tol` means by the first integrals.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one argument a number; private to the Python package")]
pub fn roll<'py>(
    py: Python<'py>,
    body: (f64, f64, f64, f64, f64, f64),
    state: (f64, f64, f64, f64),
    t0: f64,
    times: PyReadonlyArray1<'py, f64>,
    step: Option<f64>,
    tol: Option<f64>,
    contact: u8,
    mu: f64,
    beyond: bool,
    pose: bool,
    force: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let body = body_of(&<[f64; BODY]>::from(body))?;
    let start = State::from(<[f64; 4]>::from(state));
    let times = times.as_slice()?;
    let method = match (step, tol) {
        (Some(step), _) => Method::Step(step),
        (_, Some(tol)) => Method::Tolerance(tol),
        _ => Method::Exact,
    };
    let scene = Ask { contact: contact_of(contact)?, method, mu, beyond, pose, force };
    let mut watch = Watch::new(None);
    let found = py.detach(|| {
        let motion = motion::roll_with(&body, &start, t0, times, &scene, || watch.still())?;
        let Some(motion) = motion else { return Ok(None) };
        Ok::<_, Error>(tables(&motion, &body, &mut || watch.still())?.map(|tables| (motion, tables)))
    })?;
    watch.done(py)?;
    let Some((m, tables)) = found else { return Err(given_up()) };
    dictionary(py, &m, tables)
}

pub(super) fn given_up() -> PyErr {
    PyRuntimeError::new_err("the motion was given up")
}

/// What Python is given: arrays, how it ended, how it was found and how far it may be off.
pub(super) fn dictionary<'py>(
    py: Python<'py>,
    m: &Motion,
    tables: Vec<NamedArray>,
) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    for NamedArray { name, numbers, width } in tables {
        let rows = m.times.len();
        match width {
            // a few numbers are copied sooner than handed over
            0 if rows <= FEW => out.set_item(name, PyArray1::from_slice(py, &numbers))?,
            0 => out.set_item(name, PyArray1::from_vec(py, numbers))?,
            _ if rows <= FEW => {
                let rows = ArrayView2::from_shape((rows, width), &numbers).expect("rows of this width");
                out.set_item(name, PyArray2::from_array(py, &rows))?;
            }
            _ => out.set_item(name, PyArray1::from_vec(py, numbers).reshape([rows, width])?)?,
        }
    }
    out.set_item(intern!(py, "status"), m.ending() as u8)?;
    if let Some(event) = m.event {
        out.set_item(intern!(py, "event"), (event.time, <[f64; 4]>::from(event.state)))?;
    }
    let (method, setting) = match m.method {
        Method::Step(h) => (intern!(py, "rk4"), h),
        Method::Tolerance(tol) => (intern!(py, "rk4 within tol"), tol),
        Method::Exact => (intern!(py, "exact"), f64::NAN),
    };
    out.set_item(intern!(py, "method"), method)?;
    out.set_item(intern!(py, "_setting"), setting)?;
    out.set_item(intern!(py, "error"), m.error)?;
    out.set_item(intern!(py, "pose_error"), m.pose_error)?;
    out.set_item(intern!(py, "force_error"), m.force_error)?;
    out.set_item(intern!(py, "step_loss"), m.step_loss)?;
    out.set_item(intern!(py, "advice"), m.advice)?;
    out.set_item(intern!(py, "coarse"), m.coarse)?;
    out.set_item(intern!(py, "nfev"), m.evaluations)?;
    Ok(out)
}

/// Up to so many rows.
const FEW: usize = 64;

/// Period, least and greatest theta, phi and psi per period, drift per period and its circle's radius, error of the
/// period; the last five NaN where there is no period.
#[pyfunction]
pub fn swing(body: [f64; BODY], state: [f64; 4], contact: u8) -> PyResult<[f64; 8]> {
    let swing = Swing::new(&body_of(&body)?, &State::from(state), contact_of(contact)?, true)?;
    let [low, high] = swing.turning_points();
    let [phi, psi] = swing.angles_per_period().unwrap_or([f64::NAN; 2]);
    let [drift, radius] = swing.drift().unwrap_or([f64::NAN; 2]);
    Ok([swing.period(), low, high, phi, psi, drift, radius, swing.period_error()])
}
