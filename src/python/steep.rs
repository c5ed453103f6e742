//! Functions for Python: the friction, the losses and the width that hold a body on a slope.

use super::options::table_of;
use super::parts::NumbersOfBody;
use crate::Body;
use crate::laws::loss::{COUNT, Losses};
use crate::laws::steep::{Incline, Posture, shares, slip_slope, tip_slope};
use pyo3::prelude::*;

/// The slopes, in radians, beyond which a body of several circles slips and tips, or ValueError.
#[pyfunction]
pub fn slopes_of_circles(
    body: NumbersOfBody,
    theta: f64,
    mu: f64,
    posture: u8,
    phi: f64,
) -> PyResult<[f64; 2]> {
    let (body, on) = (Body::of_rows(body.0, &body.1)?, Posture::try_from(posture)?);
    Ok([slip_slope(&body, theta, mu, on, phi)?, tip_slope(&body, theta, on, phi)?])
}

/// The shares of friction, losses and width that a body needs to stay at rest against slipping, rolling and tipping, or
/// ValueError.
#[pyfunction]
pub fn shares_on_slope(
    body: NumbersOfBody,
    theta: f64,
    contact: (u8, [f64; 3]),
    losses: Option<[f64; COUNT]>,
    posture: u8,
    slope_and_phi: [f64; 2],
) -> PyResult<[f64; 3]> {
    let mu = table_of(contact.0)?.with(contact.1).mu();
    let losses = losses.map_or(Losses::NONE, |coefficients| Losses { coefficients });
    let (on, [slope, phi]) = (Posture::try_from(posture)?, slope_and_phi);
    let found = shares(&Body::of_rows(body.0, &body.1)?, theta, mu, &losses, on, Incline::new(slope, phi))?;
    Ok([found.slipping, found.rolling, found.tipping])
}
