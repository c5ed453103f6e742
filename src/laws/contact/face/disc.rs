//! The friction of a disc.
use super::ring::{Arc, Pressed, WholeMeans};

pub(super) fn whole(v: f64, s: f64) -> WholeMeans {
    WholeMeans::of_ring(v, s)
}

pub(super) fn pressed(arc: &Arc, lam: f64, v: f64, s: f64) -> Pressed {
    arc.pressed(lam, v, s)
}
