//! The options of a motion, as Python gives them.

use crate::laws::contact::{Contact, TableKind};
use crate::laws::loss::{COUNT, Losses};
use crate::motions::{Ask, Method};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

/// The contact with this code.
pub(super) fn contact_of(code: u8) -> PyResult<Contact> {
    match table_of(code)? {
        TableKind::Rolling => Ok(Contact::Rolling),
        TableKind::Smooth => Ok(Contact::Smooth),
        _ => Err(PyValueError::new_err("no such contact")),
    }
}

/// The kind of table with this code.
pub(super) fn table_of(code: u8) -> PyResult<TableKind> {
    TableKind::from_code(code).ok_or_else(|| PyValueError::new_err("no such table"))
}

/// The options of a motion, which Python gives by name; what it does not give is as it is by default.
pub struct MotionAsked {
    pub t0: f64,
    pub slip: [f64; 2],
    table: u8,
    coefficients: [f64; 2],
    losses: Option<[f64; COUNT]>,
    step: Option<f64>,
    tol: Option<f64>,
    beyond: bool,
    restitution: Option<f64>,
    pose: bool,
    force: bool,
}

impl FromPyObject<'_, '_> for MotionAsked {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let mut asked = Self {
            t0: 0.0,
            slip: [0.0; 2],
            table: TableKind::Rolling as u8,
            coefficients: [f64::INFINITY, 0.0],
            losses: None,
            step: None,
            tol: None,
            beyond: false,
            restitution: None,
            pose: false,
            force: false,
        };
        for (name, value) in given.cast::<PyDict>()?.iter() {
            match name.cast::<PyString>()?.to_str()? {
                "t0" => asked.t0 = value.extract()?,
                "slip" => asked.slip = value.extract()?,
                "table" => asked.table = value.extract()?,
                "coefficients" => asked.coefficients = value.extract()?,
                "losses" => asked.losses = value.extract()?,
                "step" => asked.step = value.extract()?,
                "tol" => asked.tol = value.extract()?,
                "beyond" => asked.beyond = value.extract()?,
                "restitution" => asked.restitution = value.extract()?,
                "pose" => asked.pose = value.extract()?,
                "force" => asked.force = value.extract()?,
                other => return Err(PyValueError::new_err(format!("no option of a motion: {other}"))),
            }
        }
        Ok(asked)
    }
}

impl MotionAsked {
    pub fn ask(&self) -> PyResult<Ask> {
        Ok(Ask {
            table: table_of(self.table)?.with(self.coefficients),
            losses: self.losses.map_or(Losses::NONE, |coefficients| Losses { coefficients }),
            method: match (self.step, self.tol) {
                (Some(step), _) => Method::Step(step),
                (_, Some(tol)) => Method::Tolerance(tol),
                _ => Method::Exact,
            },
            beyond: self.beyond,
            restitution: self.restitution,
            stop_at_rolling: false,
            pose: self.pose,
            force: self.force,
        })
    }
}
