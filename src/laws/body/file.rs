//! A body in a file, by its numbers, which are checked when the file is read.

use super::Body;
use crate::error::{Error, within};
use crate::numbers::Sum;
use serde::{Deserialize, Serialize};

/// The numbers of a body. The last two may be missing and then follow from the others.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyFile {
    ell: f64,
    i1: f64,
    i3: f64,
    #[serde(default)]
    fillet: f64,
    theta_end: Option<f64>,
    /// The inertia excess of a tube is known to more digits than its moments.
    excess: Option<[f64; 2]>,
}

impl From<Body> for BodyFile {
    fn from(body: Body) -> Self {
        let Body { ell, i1, i3, fillet, theta_end, excess, .. } = body;
        Self { ell, i1, i3, fillet, theta_end: Some(theta_end), excess: Some([excess.hi, excess.lo]) }
    }
}

impl TryFrom<BodyFile> for Body {
    type Error = Error;

    fn try_from(of: BodyFile) -> Result<Self, Error> {
        let body = Self::rounded(of.ell, of.i1, of.i3, of.fillet)?;
        let body = of.theta_end.map_or(Ok(body), |theta_end| body.with_theta_end(theta_end))?;
        let Some([hi, lo]) = of.excess else { return Ok(body) };
        let (excess, few) = (Sum::of(hi, lo), 8.0 * f64::EPSILON * body.ratio());
        within("excess", excess.hi, (body.excess() - few, body.excess() + few), "i1 / i3 - 1")?;
        Ok(Self { excess, ..body })
    }
}
