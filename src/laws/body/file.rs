//! A body in a file, by its numbers, which are checked when the file is read.

use super::{Body, Circle};
use crate::error::{Error, within};
use crate::numbers::Sum;
use serde::{Deserialize, Serialize};

/// The numbers of a body in a file. `excess` and `circles` may be missing and then follow from the others.
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
    /// The circles of a body that are neither one circle nor two equal rims, from the lower end up; ell, fillet and
    /// theta_end are then those of the first one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    circles: Option<Vec<Circle>>,
}

impl From<Body> for BodyFile {
    fn from(body: Body) -> Self {
        let Body { ell, i1, i3, fillet, theta_end, excess, .. } = body;
        let circles = body.has_row().then(|| body.circles());
        Self {
            ell,
            i1,
            i3,
            fillet,
            theta_end: Some(theta_end),
            excess: Some([excess.hi, excess.lo]),
            circles,
        }
    }
}

impl TryFrom<BodyFile> for Body {
    type Error = Error;

    fn try_from(of: BodyFile) -> Result<Self, Error> {
        let body = if let Some(circles) = of.circles {
            let body = Self::profile(&circles, of.i1, of.i3)?;
            let ends = of.theta_end.unwrap_or(body.theta_end);
            for (name, given, own) in [
                ("ell", of.ell, body.ell),
                ("fillet", of.fillet, body.fillet),
                ("theta_end", ends, body.theta_end),
            ] {
                within(name, given, (own, own), "the number of the first circle in `circles`")?;
            }
            body
        } else {
            let body = Self::rounded(of.ell, of.i1, of.i3, of.fillet)?;
            of.theta_end.map_or(Ok(body), |theta_end| body.with_theta_end(theta_end))?
        };
        let Some([hi, lo]) = of.excess else { return Ok(body) };
        let (excess, few) = (Sum::of(hi, lo), 8.0 * f64::EPSILON * body.ratio());
        within("excess", excess.hi, (body.excess() - few, body.excess() + few), "i1 / i3 - 1")?;
        Ok(Self { excess, ..body })
    }
}
