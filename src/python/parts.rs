//! Bodies put together from parts, for Python.

use crate::laws::body::parts::{Amount, Assembled, BodyPart, Form, assembled};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The code of a form, its numbers, and its mass, or its density if the last value is true.
type Given = (u8, Vec<f64>, f64, bool);

fn form(kind: u8, numbers: &[f64]) -> Option<Form> {
    Some(match (kind, numbers) {
        (0, &[a, b, c, d, low, high, fillet]) => {
            Form::Solid { radii: [a, b], bores: [c, d], ends: [low, high], fillet }
        }
        (1, &[radius, hollow, centre, low, high]) => Form::Ball { radius, hollow, centre, ends: [low, high] },
        (2, &[a, b, low, high]) => Form::Wall { radii: [a, b], ends: [low, high] },
        (3, &[radius, centre, low, high]) => Form::Shell { radius, centre, ends: [low, high] },
        (4, &[radius, height]) => Form::Ring { radius, height },
        _ => return None,
    })
}

/// Numbers of the body of these parts (ell, I1, I3, fillet and theta_end), its mass, its R, and the height of its
/// centre of mass, or ValueError.
#[pyfunction]
#[pyo3(name = "assembled")]
pub fn of_parts(given: Vec<Given>) -> PyResult<([f64; 5], f64, f64, f64)> {
    let part = |(kind, numbers, amount, dense): &Given| {
        let amount = if *dense { Amount::Density(*amount) } else { Amount::Mass(*amount) };
        let form = form(*kind, numbers).ok_or_else(|| PyValueError::new_err("parts: an unknown form"))?;
        Ok(BodyPart { form, amount })
    };
    let parts: Vec<BodyPart> = given.iter().map(part).collect::<PyResult<_>>()?;
    let Assembled { body, mass, radius, centre } = assembled(&parts)?;
    Ok(([body.ell(), body.i1(), body.i3(), body.fillet(), body.theta_end()], mass, radius, centre))
}
