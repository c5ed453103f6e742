//! Losses in a file: the coefficients of the laws that are present, by the names of the laws.

use super::{Law, Losses};
use crate::error::Error;
use std::collections::BTreeMap;

impl From<Losses> for BTreeMap<Law, f64> {
    fn from(losses: Losses) -> Self {
        losses.iter().collect()
    }
}

impl TryFrom<BTreeMap<Law, f64>> for Losses {
    type Error = Error;

    /// The losses with these coefficients, or the error of [`check`](Self::check).
    fn try_from(all: BTreeMap<Law, f64>) -> Result<Self, Error> {
        let losses =
            all.into_iter().fold(Self::NONE, |losses, (law, coefficient)| losses.with(law, coefficient));
        losses.check().map(|()| losses)
    }
}
