//! Functions for Python that make bodies from parts or circles.

use crate::laws::body::parts::{Amount, Assembled, BodyPart, Form, assembled};
use crate::laws::body::{Body, CircleBorder, circles_of_rows};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A part: the code of its form, the numbers of the form, and its mass, or its density if the last value is true.
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

/// The six numbers of a body, and its circles as rows of radius, height above the centre of mass, and fillet, if it has
/// several. The six numbers are then those of its lowest circle, whose bore is minus the radius.
pub type NumbersOfBody = ([f64; 6], ToldCircles<3>);
type ToldCircles<const N: usize> = Vec<[f64; N]>;

fn numbers_of(body: &Body) -> NumbersOfBody {
    let (bore, rows) =
        if body.has_row() { (0.0 - body.rim(), body.rows().collect()) } else { (f64::NAN, Vec::new()) };
    ([body.ell(), body.i1(), body.i3(), bore, body.fillet(), body.theta_end()], rows)
}

/// The body of these circles, and whether a circle was left out because it lies in line with two others; or ValueError.
#[pyfunction]
pub fn check_profile(rows: Vec<[f64; 3]>, i1: f64, i3: f64) -> PyResult<(NumbersOfBody, bool)> {
    let circles = circles_of_rows(&rows);
    let body = Body::profile(&circles, i1, i3)?;
    Ok((numbers_of(&body), body.passes_over(&circles)))
}

/// The circles of a body; and for each two neighbours the inclination at which both touch the table, the distance of
/// the two contact points, three numbers of `Apex`, and whether the body can rest on both circles.
#[pyfunction]
pub fn body_circles(body: [f64; 6], rows: ToldCircles<3>) -> PyResult<(ToldCircles<3>, ToldCircles<6>)> {
    let body = Body::of_rows(body, &rows)?;
    let borders = body.borders().into_iter().enumerate().map(|(k, CircleBorder { theta, span })| {
        let [radius, rate, friction] =
            body.apex(k).map_or([f64::NAN; 3], |apex| [apex.radius, apex.rate, apex.friction]);
        [theta, span, radius, rate, friction, f64::from(u8::from(body.rests().contains(&k)))]
    });
    Ok((body.rows().collect(), borders.collect()))
}

/// The numbers of a uniform frustum, or ValueError.
#[pyfunction]
pub fn frustum(bottom: f64, top: f64, height: f64, wall: Option<f64>) -> PyResult<NumbersOfBody> {
    Ok(numbers_of(&Body::frustum(bottom, top, height, wall)?))
}

/// The numbers of a uniform solid with this outline, or ValueError.
#[pyfunction]
pub fn lathe(points: Vec<[f64; 2]>) -> PyResult<NumbersOfBody> {
    Ok(numbers_of(&Body::lathe(&points)?))
}

/// The numbers of two balls with these radii, or ValueError.
#[pyfunction]
pub fn unequal_balls(radii: [f64; 2], separation: f64) -> PyResult<NumbersOfBody> {
    Ok(numbers_of(&Body::unequal_balls(radii, separation)?))
}

/// The numbers of the body of these parts, its mass, its unit of length R, and the height of its centre of mass, or ValueError.
#[pyfunction]
#[pyo3(name = "assembled")]
pub fn of_parts(given: Vec<Given>) -> PyResult<(NumbersOfBody, [f64; 3])> {
    let part = |(kind, numbers, amount, dense): &Given| {
        let amount = if *dense { Amount::Density(*amount) } else { Amount::Mass(*amount) };
        let form = form(*kind, numbers)
            .ok_or_else(|| PyValueError::new_err("parts: expected the code of a form"))?;
        Ok(BodyPart { form, amount })
    };
    let parts: Vec<BodyPart> = given.iter().map(part).collect::<PyResult<_>>()?;
    let Assembled { body, mass, radius, centre } = assembled(&parts)?;
    Ok((numbers_of(&body), [mass, radius, centre]))
}
