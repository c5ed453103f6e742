//! Computes the outputs of a stone's motion: states, poses and forces from its state vector.

use super::flow::{SLID_X, SLID_Y, STONE_HEAT, StoneFlow, Touch, output_slip, state};
use crate::laws::stone::StoneState;
use crate::methods::flow::Flow;
use crate::motions::Ask;
use crate::motions::Kind;
use crate::motions::ask::row::OutputRow;
use crate::motions::walk::errors::doubted_of;
use crate::motions::walk::numbers::lost;
use crate::motions::walk::two_runs::Followed;
use nalgebra::Vector3;

/// Adds the state vector `y` of a stone to the outputs.
pub(super) fn write<const N: usize>(
    made: &mut Followed<StoneState>,
    (flow, ask, still): (&StoneFlow<'_>, &Ask, [f64; 2]),
    y: &[f64; N],
) {
    let pose = ask.pose.then(|| flow.pose(y, still));
    let way = made.path.way;
    let force = ask.force.then(|| {
        let by_speed = flow.tol * flow.fastest(y);
        let known = core::array::from_fn(|i| match i {
            0..=3 => flow.tol,
            4..=6 => by_speed,
            // An almost vanishing slip keeps its direction, so that its error does not change the friction.
            8 | 9 if flow.touch == Touch::Slips && y[SLID_X].hypot(y[SLID_Y]) > flow.over() => {
                by_speed * 1e-3
            }
            _ => 0.0,
        });
        let (force, off) = doubted_of(y, known, |y| flow.force(y, way).into());
        (Vector3::from(force), off)
    });
    let kind = if flow.rests() { Kind::Rolling } else { Kind::Slipping };
    let row = OutputRow::on_table(state(y), output_slip(y), [y[STONE_HEAT], lost(y)], kind);
    made.push(OutputRow { pose, force, ..row });
}
