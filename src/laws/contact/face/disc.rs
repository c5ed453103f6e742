//! The friction of a disc.
use super::part::{Part, Pressed};use super::ring::WholeMeans;

pub(super) fn whole(v: f64, s: f64) -> WholeMeans {
    WholeMeans::of_ring(v, s)
}

pub(super) fn pressed(arc: &Part, lam: f64, v: f64, s: f64) -> Pressed {
    super::ring::pressed(arc, lam, v, s)
}
