//! A stone in a file: its numbers in natural units, which are checked when the file is read.

use super::Ellipsoid;
use crate::error::{Error, within};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EllipsoidFile {
    axes: [f64; 3],
    inertia: [[f64; 3]; 3],
    offset: [f64; 3],
    theta_end: f64,
    /// The largest semi-axis in the unit in which the stone was given.
    unit: f64,
}

impl From<Ellipsoid> for EllipsoidFile {
    fn from(of: Ellipsoid) -> Self {
        let (axes, inertia, offset) = (of.axes(), of.inertia(), of.offset());
        Self { axes, inertia, offset, theta_end: of.theta_end, unit: of.unit }
    }
}

impl TryFrom<EllipsoidFile> for Ellipsoid {
    type Error = Error;

    fn try_from(of: EllipsoidFile) -> Result<Self, Error> {
        within("unit", of.unit, (1e-30, 1e30), "1e-30 <= unit <= 1e30")?;
        let stone = Self::new(of.axes, of.inertia, of.offset)?.with_theta_end(of.theta_end)?;
        Ok(Self { unit: stone.unit * of.unit, ..stone })
    }
}
