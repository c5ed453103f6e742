//! The motion of a stone, through phases of rolling, of slipping, and in the air.
//!
//! The phases are those of [`walk`](crate::motions::walk): a contact point at rest begins to slip when rolling needs
//! more friction than mu_s N. When a slip ends, the contact point sticks if rolling needs at most the friction mu_s
//! N. The equations of each phase are those of `StoneFlow`.
//!
//! Error: from a second run with a larger tolerance, as for a body with friction; `tests/laws/stone.rs`
//! compares it with references of 25 digits.

use super::check_stone;
use super::flow::{ALL, LOSING};
use super::known::{Recorded, Runs, settle};
use super::phases::StoneWalk;
use crate::error::Error;
use crate::laws::contact::Table;
use crate::laws::contact::slip::Friction;
use crate::laws::stone::{Ellipsoid, StoneState};
use crate::motions::dry::friction::OwnFriction;
use crate::motions::slope::{AtPace, on_slope};
use crate::motions::walk::two_runs::{Followed, judged, rougher};
use crate::motions::{Ask, Motion, Start};
use core::cell::RefCell;

/// Computes the motion of a stone at `times`, in ascending order and not before the time of the initial state.
///
/// `start` is a [`StoneState`], or a [`Start`] with a slip and a time; the vertical of a state is scaled to length 1.
/// The components of a slip, initially and in all outputs, are along the horizontal axes x and y of the laboratory
/// frame in which the stone is turned from upright by the smallest angle. `ask` has the contact, the losses, the
/// restitution, the tolerance, `beyond` and the outputs; a stone has no fixed step and no second rim that could land.
/// With a restitution a stone may start in the air, and its motion continues where it leaves the table; the motion of
/// a half ellipsoid ends where its edge lands. The `heading` of a start turns these axes x and y about the vertical,
/// and its `place` is that of the first contact point; on a slope x points downhill. `go_on` and the limits of the
/// work are as for a body ([`roll_with`](crate::motion::roll_with)).
///
/// ```
/// use spincyl::{Ellipsoid, motion::Ask, stone};
///
/// // A rattleback that is spun the wrong way begins to rock, and turns back.
/// let inertia = [[0.02, -0.012, 0.0], [-0.012, 0.2, 0.0], [0.0, 0.0, 0.21]];
/// let stone = Ellipsoid::new([1.0, 0.3, 0.2], inertia, [0.0, 0.0, -0.07])?;
/// let times: Vec<f64> = (0..=60).map(f64::from).collect();
/// let start = stone.spinning(-0.6, 0.02, 0.0);
/// let motion = stone::roll(&stone, start, &times, &Ask::default(), || true)?.unwrap();
/// assert!(motion.states[0].spin() < -0.5 && motion.states.iter().any(|y| y.spin() > 0.1));
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// `OutOfRange`, which names the argument, for a state, slip, time, tolerance or coefficient out of range; `Painleve`
/// for an initial state without a unique contact force; `Memory` if the memory does not suffice for the outputs.
pub fn roll(
    stone: &Ellipsoid,
    start: impl Into<Start<StoneState>>,
    times: &[f64],
    ask: &Ask,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<Motion<StoneState>>, Error> {
    rolled(stone, &start.into(), times, ask, &mut go_on)
}

/// Does the work of [`roll`], without generic parameters, so that this code is compiled only once.
fn rolled(
    stone: &Ellipsoid,
    start: &Start<StoneState>,
    times: &[f64],
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion<StoneState>>, Error> {
    let found = followed(stone, start, times, (ask, None), &RefCell::default(), go_on)?;
    Ok(Motion::from(found).advanced(start.time))
}

/// Computes the motion and its path under the options and perhaps a user-defined law of friction, with the error from
/// a second run with a larger tolerance. The first run records reversals of the spin and ends of phases in
/// `recorded`; reversals after the time up to which the motion is known are removed.
pub(crate) fn followed(
    stone: &Ellipsoid,
    start: &Start<StoneState>,
    times: &[f64],
    (ask, own): (&Ask, Option<OwnFriction<'_>>),
    recorded: &RefCell<Recorded>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Followed<StoneState>, Error> {
    let (start, fine) = check_stone(start, times, ask)?;
    on_slope(ask, &start, times, |start, times, ask, pace| {
        let law = own.map(|own| AtPace { law: own.law, pace });
        let own = own.zip(law.as_ref()).map(|(own, law)| OwnFriction { law, ..own });
        settled((stone, start), times, (ask, own), fine, recorded, go_on)
    })
}

/// The motion of [`followed`] from a checked start, in the units in which the component of gravity normal to the
/// table is 1.
fn settled(
    (stone, start): (&Ellipsoid, &Start<StoneState>),
    times: &[f64],
    (ask, own): (&Ask, Option<OwnFriction<'_>>),
    fine: f64,
    recorded: &RefCell<Recorded>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Followed<StoneState>, Error> {
    let (ask, start) = &on_ice(stone, ask, start);
    let mut run = |tol: f64, times: &[f64], recorded| {
        let of = (stone, start);
        if ask.losses.is_none() {
            walk::<ALL>(of, times, (ask, own), (tol, fine), recorded)?.run(go_on)
        } else {
            walk::<LOSING>(of, times, (ask, own), (tol, fine), recorded)?.run(go_on)
        }
    };
    let runs = |tol: f64, times: &[f64]| run(tol, times, (tol == fine).then_some(recorded));
    let mut found = judged(fine, times, runs)?;
    if found.motion.is_interrupted() {
        return Ok(found);
    }
    let span = (start.time, times[times.len() - 1], fine);
    let mut again = |times: &[f64]| -> Runs {
        let both = [run(fine, times, None)?, run(rougher(fine), times, None)?];
        Ok(if both.iter().any(|of| of.motion.is_interrupted()) { None } else { Some(both) })
    };
    if !settle(&mut found, &mut recorded.borrow_mut(), span, &mut again)? {
        found.stays_unjudged();
    }
    Ok(found)
}

/// For a motion on a smooth table with impacts: options and start with friction of coefficient 0, and a slip with
/// which the centre has no horizontal velocity. Other motions keep their own.
fn on_ice(stone: &Ellipsoid, ask: &Ask, start: &Start<StoneState>) -> (Ask, Start<StoneState>) {
    let (mut ask, mut start) = (*ask, *start);
    if ask.table == Table::Smooth && ask.restitution.is_some() {
        ask.table = Friction::coulomb(0.0).into();
        if start.aloft.is_none() {
            start.slip = stone.slip(&start.state, [0.0; 2]);
        }
    }
    (ask, start)
}

/// Prepares the computation of a stone's motion, on the heap, since threads may have only a small stack.
#[inline(never)]
fn walk<'a, 'n, const N: usize>(
    of: (&Ellipsoid, &Start<StoneState>),
    times: &'a [f64],
    (ask, own): (&Ask, Option<OwnFriction<'n>>),
    tols: (f64, f64),
    recorded: Option<&'n RefCell<Recorded>>,
) -> Result<Box<StoneWalk<'a, 'n, N>>, Error> {
    Ok(Box::new(StoneWalk::of_stone(of, times, ask, tols, (recorded, own))?))
}
