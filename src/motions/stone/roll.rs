//! The motion of a stone, through phases of rolling and of slipping.
//!
//! The phases are those of [`walk`](crate::motions::walk): a contact point at rest begins to slip when
//! rolling needs more friction than mu_s N. When a slip ends, the contact point sticks if rolling needs no more
//! friction than that. Each phase is integrated as a `StoneFlow`.
//!
//! Error: from a second run with a larger tolerance, as for a body with friction; `tests/laws/stone.rs`
//! compares it with references of 25 digits.

use super::check;
use super::flow::{ALL, LOSING};
use super::known::{Recorded, Runs, settle};
use super::phases::StoneWalk;
use crate::error::Error;
use crate::laws::stone::{Ellipsoid, StoneState};
use crate::motions::followed::{Followed, rougher};
use crate::motions::{Ask, Motion, Start};
use core::cell::RefCell;

/// Computes the motion of a stone at `times`, in ascending order and not before the time of the initial state.
///
/// `start` is a [`StoneState`], or a [`Start`] with a slip and a time; the vertical of a state is scaled to
/// length 1. The components of a slip, initially and in all outputs, are along the horizontal axes x and y of the
/// laboratory frame in which the stone is turned from upright by the smallest angle. `ask` has
/// the contact, the losses, the tolerance, `beyond` and the outputs; a stone has no fixed step and no second rim
/// that could land. `go_on` is called often; if it returns false, the result is `Ok(None)`. Errors: `OutOfRange`,
/// which names the argument; `Painleve` for an initial state without a unique contact force; `Restless` if slipping
/// and rolling alternate too often; `Endless` if the motion hardly advances.
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
    Ok(followed(stone, start, times, ask, &RefCell::default(), go_on)?.map(Motion::from))
}

/// The motion and its path, with the error from a rougher run. The finer run records reversals and ends in
/// `recorded`; reversals after the time up to which the motion is known are removed.
pub(crate) fn followed(
    stone: &Ellipsoid,
    start: &Start<StoneState>,
    times: &[f64],
    ask: &Ask,
    recorded: &RefCell<Recorded>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Followed<StoneState>>, Error> {
    let (start, fine) = check(start, times, ask)?;
    let mut runs = |times: &[f64], recorded: Option<&RefCell<Recorded>>| -> Runs {
        let mut run = |tol: f64, recorded| {
            let of = (stone, &start);
            if ask.losses.is_none() {
                walk::<ALL>(of, times, ask, (tol, fine), recorded)?.run(go_on)
            } else {
                walk::<LOSING>(of, times, ask, (tol, fine), recorded)?.run(go_on)
            }
        };
        let Some(found) = run(fine, recorded)? else { return Ok(None) };
        Ok(run(rougher(fine), None)?.map(|rough| [found, rough]))
    };
    let Some([mut found, rough]) = runs(times, Some(recorded))? else { return Ok(None) };
    found.judge(&rough, fine);
    let span = (start.time, times[times.len() - 1], fine);
    let settled = settle(&mut found, &mut recorded.borrow_mut(), span, &mut |times| runs(times, None))?;
    Ok(settled.then_some(found))
}

/// Begins a walk, on the heap, since threads may have only a small stack.
#[inline(never)]
fn walk<'a, 'n, const N: usize>(
    of: (&Ellipsoid, &Start<StoneState>),
    times: &'a [f64],
    ask: &Ask,
    tols: (f64, f64),
    recorded: Option<&'n RefCell<Recorded>>,
) -> Result<Box<StoneWalk<'a, 'n, N>>, Error> {
    Ok(Box::new(StoneWalk::of_stone(of, times, ask, tols, recorded)?))
}
