//! Many drifts at once: every body from its own start under its own losses, on lanes and threads.
//!
//! When they stop and what ends them; a drift that the lanes leave open is answered alone, as `Drift` does. Which of
//! the two it is, each drift decides by itself, so that the same bits come out for any number of threads and neighbours.
//!
//! Error: that of a drift alone; a property of `drift` holds the two together.

use super::columns::{Centre, DriftOutput, DriftStarts, INVALID};
use super::rest_lanes;
use super::rolling_lanes;
use super::{Drift, DriftState};
use crate::error::{Error, room, spare};
use crate::number::{LANES, level};
use crate::threads::share;

/// Drifts in a block.
const BLOCK: usize = 4096;

/// Fills the harvest, on `threads` workers, the caller among them, which asks `go_on` about fifty times a second with
/// the share that is done. Returns whether it finished; if not, the contents are unspecified. The error is `Memory`.
///
/// # Panics
/// If columns differ in length (but for single numbers), or an array of `out` does not fit them.
pub fn stops(
    starts: &DriftStarts<'_>,
    out: DriftOutput<'_>,
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<bool, Error> {
    all(starts, out, threads, &mut go_on)
}

/// The same, compiled once: here.
fn all(
    starts: &DriftStarts<'_>,
    out: DriftOutput<'_>,
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    let count = starts.len();
    assert!(starts.fit(count), "columns of different lengths");
    assert!(
        [out.stops_at.len(), out.ends_at_theta.len(), out.ended.len()] == [count; 3],
        "an array does not fit"
    );
    spare()?;
    let (mut rest, mut blocks) = (out, room(count.div_ceil(BLOCK))?);
    for first in (0..count).step_by(BLOCK) {
        let here = BLOCK.min(count - first);
        let (cut, after) = rest.split(here);
        blocks.push((first, here, cut));
        rest = after;
    }
    Ok(share(blocks, threads, go_on, |(first, here, mut out), still| {
        let (round, sharp): (Vec<usize>, Vec<usize>) =
            (first..first + here).partition(|i| starts.is_rounded(*i));
        for (rows, round) in [(sharp, false), (round, true)] {
            for (k, eight) in rows.chunks(LANES).enumerate() {
                if k % 16 == 15 && !still() {
                    return;
                }
                block(starts, eight, round, first, &mut out);
            }
        }
    }))
}

/// At most eight drifts on rims of one kind.
fn block(starts: &DriftStarts<'_>, eight: &[usize], round: bool, first: usize, out: &mut DriftOutput<'_>) {
    let mut rows = [starts.row(eight[0]); LANES];
    for (row, i) in rows.iter_mut().zip(eight) {
        *row = starts.row(*i);
    }
    let found = match (starts.centre, round) {
        (Centre::Rest, false) => rest_lanes::stops::<false>(level(), &rows),
        (Centre::Rest, true) => rest_lanes::stops::<true>(level(), &rows),
        (Centre::Rolling, _) => rolling_lanes::stops(level(), &rows, round, |row| row.body()),
    };
    for ((i, row), found) in eight.iter().zip(&rows).zip(found) {
        if let Some(end) = found.or_else(|| row.end(starts.centre).ok()) {
            out.put(i - first, end);
        } else {
            let k = i - first;
            (out.stops_at[k], out.ends_at_theta[k], out.ended[k]) = (f64::NAN, f64::NAN, INVALID);
        }
    }
}

/// The drift of one start.
pub fn single(starts: &DriftStarts<'_>, i: usize) -> Result<Drift, Error> {
    starts.row(i).drift(starts.centre)
}

/// What is asked of drifts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Question {
    /// The time at an inclination: one number.
    Time,
    /// What there is at a time: theta, w1, w3, Omega, the friction needed.
    At,
    /// The time until which rolling is stable: one number.
    Stable,
}

/// How many numbers an answer has.
pub const WIDTH: usize = 5;

/// Answers questions `x` to the drifts `of` (each an index), [`WIDTH`] numbers for each, NaN where there is no answer.
/// Those of one drift are best asked one after the other: it is followed once.
///
/// # Panics
/// If the arrays do not fit.
pub fn ask(
    starts: &DriftStarts<'_>,
    question: Question,
    (of, x): (&[usize], &[f64]),
    out: &mut [f64],
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<bool, Error> {
    answers(starts, question, (of, x), out, threads, &mut go_on)
}

/// The same, compiled once: here.
fn answers(
    starts: &DriftStarts<'_>,
    question: Question,
    (of, x): (&[usize], &[f64]),
    out: &mut [f64],
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    assert!(starts.fit(starts.len()), "columns of different lengths");
    assert!(of.len() == x.len() && out.len() == WIDTH * x.len(), "an array does not fit");
    spare()?;
    let mut blocks = room(x.len().div_ceil(64))?;
    for ((of, x), out) in of.chunks(64).zip(x.chunks(64)).zip(out.chunks_mut(64 * WIDTH)) {
        blocks.push((of, x, out));
    }
    Ok(share(blocks, threads, go_on, |(of, x, out), still| {
        let mut known: Option<(usize, Option<Drift>)> = None;
        for ((i, x), out) in of.iter().zip(x).zip(out.chunks_mut(WIDTH)) {
            if known.as_ref().is_none_or(|(k, _)| k != i) {
                if !still() {
                    return;
                }
                known = Some((*i, single(starts, *i).ok()));
            }
            out.fill(f64::NAN);
            let Some((_, Some(drift))) = &known else { continue };
            match question {
                Question::Time => out[0] = drift.time(*x),
                Question::Stable => out[0] = drift.stable_until(),
                Question::At => {
                    if let Some(DriftState { state, precession, friction_coefficient }) = drift.at(*x) {
                        out.copy_from_slice(&[
                            state.theta,
                            state.w1,
                            state.w3,
                            precession,
                            friction_coefficient,
                        ]);
                    }
                }
            }
        }
    }))
}
