//! Motions: plain arrays in, a dictionary of plain arrays out.

use super::body_of;
use crate::exact::Swing;
use crate::motion::{self, Method, Scene};
use crate::pose::{Angle, Pose};
use crate::{Contact, State};
use nalgebra::UnitQuaternion;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::time::{Duration, Instant};

/// An array of numbers, row by row.
fn table<'py, const N: usize>(
    py: Python<'py>,
    rows: impl ExactSizeIterator<Item = [f64; N]>,
) -> PyResult<Bound<'py, PyAny>> {
    let count = rows.len();
    let numbers: Vec<f64> = rows.flatten().collect();
    Ok(PyArray1::from_vec(py, numbers).reshape([count, N])?.into_any())
}

fn column<'py>(py: Python<'py>, x: impl Iterator<Item = f64>) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_vec(py, x.collect())
}

pub(super) fn contact_of(smooth: bool) -> Contact {
    if smooth { Contact::Smooth } else { Contact::Rolling }
}

/// The motion of a body; None for `step` and `tol` means by the first integrals.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one argument a number; private to the Python package")]
pub fn roll<'py>(
    py: Python<'py>,
    body: [f64; 4],
    state: [f64; 4],
    t0: f64,
    times: PyReadonlyArray1<'py, f64>,
    step: Option<f64>,
    tol: Option<f64>,
    smooth: bool,
    mu: f64,
    beyond: bool,
    pose: bool,
    force: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let body = body_of(&body)?;
    let times = times.as_slice()?;
    let method = match (step, tol) {
        (Some(step), _) => Method::Step(step),
        (_, Some(tol)) => Method::Tolerance(tol),
        _ => Method::Exact,
    };
    let scene = Scene { contact: contact_of(smooth), method, mu, beyond, pose, force };
    let mut interrupt = None;
    // a short motion is over before anybody could interrupt it, and is not worth letting go for
    let mut asked = Instant::now();
    let found = py.detach(|| {
        motion::roll_with(&body, &State::from(state), t0, times, &scene, || {
            if asked.elapsed() < Duration::from_millis(20) {
                return true;
            }
            asked = Instant::now();
            Python::attach(|py| py.check_signals()).map_err(|e| interrupt = Some(e)).is_ok()
        })
    })?;
    let Some(m) = found else { return Err(interrupt.unwrap_or_else(|| PyErr::fetch(py))) };
    let out = PyDict::new(py);
    out.set_item("t", PyArray1::from_slice(py, &m.times))?;
    out.set_item("y", table(py, m.states.iter().map(|y| <[f64; 4]>::from(*y)))?)?;
    if let Some(poses) = &m.poses {
        let angle = |f: fn(&Pose) -> Angle| table(py, poses.iter().map(|p| [f(p).turns, f(p).rest]));
        out.set_item("phi", angle(|p| p.phi)?)?;
        out.set_item("psi", angle(|p| p.psi)?)?;
        out.set_item(
            "contact_point",
            table(py, poses.iter().map(|p| [p.contact_point.x, p.contact_point.y]))?,
        )?;
        let both = || poses.iter().zip(&m.states);
        let turned = |q: UnitQuaternion<f64>| [q.i, q.j, q.k, q.w];
        out.set_item("orientation", table(py, both().map(|(p, y)| turned(p.orientation(y))))?)?;
        out.set_item("centre", table(py, both().map(|(p, y)| p.centre(&body, y).coords.into()))?)?;
    }
    if let Some(forces) = &m.forces {
        out.set_item("normal", column(py, forces.iter().map(|f| f.normal)))?;
        out.set_item("friction", column(py, forces.iter().map(|f| f.friction())))?;
        out.set_item("friction_coefficient", column(py, forces.iter().map(|f| f.friction_coefficient())))?;
    }
    out.set_item("status", m.ending() as u8)?;
    if let Some(event) = m.event {
        out.set_item("event", (event.time, <[f64; 4]>::from(event.state)))?;
    }
    let (method, setting) = match m.method {
        Method::Step(h) => ("rk4", h),
        Method::Tolerance(tol) => ("rk4 within tol", tol),
        Method::Exact => ("exact", f64::NAN),
    };
    out.set_item("method", method)?;
    out.set_item("setting", setting)?;
    out.set_item("error", m.error)?;
    out.set_item("pose_error", m.pose_error)?;
    out.set_item("loss", m.loss)?;
    out.set_item("advice", m.advice)?;
    out.set_item("coarse", m.coarse)?;
    out.set_item("nfev", m.evaluations)?;
    Ok(out)
}

/// Period, least and greatest theta, phi and psi per period, drift per period and its circle's radius; the
/// last four NaN where there is no period.
#[pyfunction]
pub fn swing(body: [f64; 4], state: [f64; 4], smooth: bool) -> PyResult<[f64; 7]> {
    let swing = Swing::new(&body_of(&body)?, &State::from(state), contact_of(smooth), true)?;
    let [low, high] = swing.turning_points();
    let [phi, psi] = swing.angles_per_period().unwrap_or([f64::NAN; 2]);
    let [drift, radius] = swing.drift().unwrap_or([f64::NAN; 2]);
    Ok([swing.period(), low, high, phi, psi, drift, radius])
}
