//! The extremes of a motion: of the inclination, the normal force and the coefficient of friction that rolling needs.

use super::Swing;
use crate::laws::body::Body;
use crate::laws::contact::{Contact, force};
use crate::laws::state::State;
use crate::methods::search;

/// Least and greatest theta, least N, and greatest coefficient of friction that rolling needs, from time 0 to `end`.
pub(crate) fn extremes(swing: &Swing, body: &Body, end: f64) -> [f64; 4] {
    let [from, to] = swing.range_of_places(end);
    let mut nodes: Vec<f64> =
        swing.nodes().into_iter().map(|(u, _)| u).filter(|u| from < *u && *u < to).collect();
    nodes.insert(0, from);
    nodes.push(to);
    let at = |u: f64| swing.rising_state(u);
    let [low, high, mut normal, mut friction] =
        extremes_of(nodes.iter().map(|u| at(*u)).collect::<Vec<_>>().iter(), body, swing.contact());
    for w in nodes.windows(3) {
        normal = normal.min(search::least(|u| force(swing.contact(), body, &at(u)).normal, w[0], w[2]).1);
        let needed = |u: f64| -force(swing.contact(), body, &at(u)).friction_coefficient();
        if needed(w[1]) <= needed(w[0]).min(needed(w[2])) {
            friction = friction.max(-search::least(needed, w[0], w[2]).1);
        }
    }
    [low, high, normal, friction]
}

/// Least and greatest theta, least N, and greatest coefficient of friction that rolling needs, among the states.
pub(crate) fn extremes_of<'a>(
    states: impl Iterator<Item = &'a State>,
    body: &Body,
    contact: Contact,
) -> [f64; 4] {
    states.fold([f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, 0.0], |[low, high, normal, friction], y| {
        let f = force(contact, body, y);
        [low.min(y.theta), high.max(y.theta), normal.min(f.normal), friction.max(f.friction_coefficient())]
    })
}
