//! Motions of stones that roll, slip and hop.

mod creeps;
mod flow;
mod fly;
pub(crate) mod known;
mod loses;
mod moving;
mod phases;
mod roll;
mod rolling;
mod slow;
mod strike;
pub(crate) mod turns;
mod write;

use super::ask::{check_flow, check_patch, check_times_after};
use super::{AboveTable, Ask, Start};
use crate::error::{Error, within};
use crate::laws::loss::{Law, Resistance};
use crate::laws::stone::StoneState;
use crate::numbers::vector::dot;
pub(crate) use roll::followed;
pub use roll::roll;
pub use rolling::{RollingStone, rolling};

/// Largest deviation from 1 of the length of the vertical in an initial state. A larger deviation is an error, a
/// smaller one is corrected.
const UNIT: f64 = 1e-9;

/// Checks the initial state and the options of a stone's motion. Returns the start with a vertical of length 1, and
/// the tolerance.
pub(crate) fn check_stone(
    start: &Start<StoneState>,
    times: &[f64],
    ask: &Ask,
) -> Result<(Start<StoneState>, f64), Error> {
    let Start { mut state, slip, time, .. } = *start;
    let long = dot(state.vertical, state.vertical).sqrt();
    within("vertical", long, (1.0 - UNIT, 1.0 + UNIT), "a vertical of length 1")?;
    state.vertical = state.vertical.map(|x| x / long);
    for (name, w) in ["w1", "w2", "w3"].into_iter().zip(state.w) {
        within(name, w, (-1e6, 1e6), "|w| <= 1e6 sqrt(g/a) for a motion")?;
    }
    for (name, u) in ["slip along x", "slip along y"].into_iter().zip(slip.pair()) {
        within(name, u, (-1e6, 1e6), "-1e6 to 1e6 sqrt(g a) for a motion")?;
        if !ask.table.rubs() && start.aloft.is_none() {
            within("slip", u, (0.0, 0.0), "0, or a law of friction as the contact")?;
        }
    }
    within("turning", ask.turning, (0.0, 0.0), "0 for a stone, whose table does not turn")?;
    start.check_place()?;
    ask.table.check()?;
    ask.losses.check_for_stone()?;
    if ask.resistance == Resistance::WhileRolling && ask.losses.coefficient(Law::RollingResistance) != 0.0 {
        let value = ask.losses.coefficient(Law::RollingResistance);
        let expected = "0 for a stone, or rolling resistance that also acts while the body slips";
        return Err(Error::OutOfRange { name: "delta", value, expected });
    }
    check_patch(ask)?;
    if let Some(AboveTable { height, lift }) = start.aloft {
        within("height", height, (0.0, 1e6), "0 to 1e6 a")?;
        within("lift", lift, (-1e6, 1e6), "-1e6 to 1e6 sqrt(g a)")?;
        if ask.restitution.is_none() {
            let expected = "None without a restitution: a motion that starts in the air needs one";
            return Err(Error::OutOfRange { name: "height", value: height, expected });
        }
    }
    ask.impact_law.check(false, &ask.table)?;
    let fine = check_flow(ask)?;
    if let Some(&value) = times.last().filter(|t| **t < time) {
        let expected =
            "times after the start; for the past of a rolling stone compute its future with the opposite w";
        return Err(Error::OutOfRange { name: "t", value, expected });
    }
    check_times_after(time, times)?;
    Ok((Start { state, slip, time, ..*start }, fine))
}
