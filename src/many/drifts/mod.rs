//! Many drifts at once: every body has its own initial state and losses, and SIMD lanes and threads share the work.
//!
//! The results are the times and the kinds of the ends. A drift that cannot be computed in SIMD lanes is computed
//! alone, as by `Drift`. This choice depends on the drift alone, so that the result has the same bits for any number of
//! threads and for any other drifts in the call.
//!
//! Error: that of a single drift; a property of `drift` compares the two.

mod columns;
mod rest_lanes;
mod rolling_lanes;

pub use columns::{Centre, DriftOutput, DriftStarts, NO_DRIFT as INVALID};

use super::columns::{RowBlock, blocks};
use super::threads::share;
use crate::error::{Error, room, spare};
use crate::laws::state::State;
use crate::motions::drift::{Drift, DriftState};
use crate::numbers::{LANES, level};

/// Number of drifts in a block, the work that a thread takes at a time.
const DRIFTS_PER_BLOCK: usize = 4096;

/// Computes the ends of all drifts and fills `out`, on `threads` threads, of which the calling thread is one. The
/// calling thread calls `go_on` about fifty times a second with the finished share of the work, and stops if `go_on`
/// returns false. Returns whether all drifts are done; if not, the contents of `out` are unspecified.
///
/// # Errors
/// `Memory` if the memory does not suffice.
///
/// # Panics
/// The function panics if columns differ in length (apart from single numbers), or if an array of `out` does not fit
/// them.
pub fn stops(
    starts: &DriftStarts<'_>,
    out: DriftOutput<'_>,
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<bool, Error> {
    stops_compiled_once(starts, out, threads, &mut go_on)
}

/// The function [`stops`] without a generic parameter, so that it is compiled only once.
fn stops_compiled_once(
    starts: &DriftStarts<'_>,
    out: DriftOutput<'_>,
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    let count = starts.len();
    assert!(starts.fit(count), "expected columns of one length, or single numbers");
    assert!(
        [out.stops_at.len(), out.ends_at_theta.len(), out.ended.len()] == [count; 3],
        "an output array does not have the length of the results"
    );
    spare()?;
    let blocks = blocks(out, count, DRIFTS_PER_BLOCK)?;
    Ok(share(blocks, threads, go_on, |RowBlock { first, count, mut out }, still| {
        if starts.centre == Centre::Rolling {
            return rolling_lanes::rolling_stops(level(), starts, first, &mut out, still);
        }
        let (round, sharp): (Vec<usize>, Vec<usize>) =
            (first..first + count).partition(|i| starts.is_rounded(*i));
        for (rows, round) in [(sharp, false), (round, true)] {
            for (k, eight) in rows.chunks(LANES).enumerate() {
                if k % 16 == 15 && !still() {
                    return;
                }
                at_rest(starts, eight, round, first, &mut out);
            }
        }
    }))
}

/// Computes the ends of at most eight drifts with the centre at rest, all on sharp rims or all on rounded rims.
fn at_rest(starts: &DriftStarts<'_>, eight: &[usize], round: bool, first: usize, out: &mut DriftOutput<'_>) {
    let mut rows = [starts.row(eight[0]); LANES];
    for (row, i) in rows.iter_mut().zip(eight) {
        *row = starts.row(*i);
    }
    let found = match round {
        false => rest_lanes::stops::<false>(level(), &rows),
        true => rest_lanes::stops::<true>(level(), &rows),
    };
    for ((i, row), found) in eight.iter().zip(&rows).zip(found) {
        match found.or_else(|| row.end_at_rest().ok()) {
            Some(end) => out.put(i - first, end),
            None => out.refuse(i - first),
        }
    }
}

/// The drift of the row with the index `i`.
///
/// # Errors
/// `OutOfRange` or `Moments` for a body that does not exist; and those of [`Drift::at_rest`] or, if the centre is not
/// held at rest, of [`Drift::rolling`].
pub fn single(starts: &DriftStarts<'_>, i: usize) -> Result<Drift, Error> {
    starts.row(i).drift(starts.centre)
}

/// A quantity of a drift that [`ask`] computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Question {
    /// The time at which the drift reaches an inclination; the result is [`DriftAnswer::time`].
    Time,
    /// The state at a time; the result is all of [`DriftAnswer`] but its `time`.
    At,
    /// The time until which rolling is stable; the result is [`DriftAnswer::time`].
    Stable,
}

/// The result of [`ask`] for a drift. Numbers that the [`Question`] does not concern, and those that do not exist, are NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct DriftAnswer {
    /// The time in question, in sqrt(R/g).
    pub time: f64,
    /// The inclination, in radians.
    pub theta: f64,
    /// The angular velocity along e1, in sqrt(g/R).
    pub w1: f64,
    /// The angular velocity along the symmetry axis, in sqrt(g/R).
    pub w3: f64,
    /// The precession Omega, in sqrt(g/R).
    pub precession: f64,
    /// The coefficient of friction that the drift needs.
    pub friction_coefficient: f64,
}

impl DriftAnswer {
    /// An answer in which all numbers are NaN, for arrays that are still to be filled.
    pub const NONE: Self = Self {
        time: f64::NAN,
        theta: f64::NAN,
        w1: f64::NAN,
        w3: f64::NAN,
        precession: f64::NAN,
        friction_coefficient: f64::NAN,
    };
}

/// Computes one quantity of many drifts: for each index k the quantity of drift `of[k]`, at the inclination or time
/// `x[k]`, in radians or sqrt(R/g), into `out[k]`. Elements with the same drift should follow
/// one another, so that the drift is computed only once.
///
/// # Errors
/// `Memory` if the memory does not suffice.
///
/// # Panics
/// The function panics if `of`, `x` and `out` differ in length, or if columns differ in length.
pub fn ask(
    starts: &DriftStarts<'_>,
    question: Question,
    (of, x): (&[usize], &[f64]),
    out: &mut [DriftAnswer],
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<bool, Error> {
    ask_compiled_once(starts, question, (of, x), out, threads, &mut go_on)
}

/// The function [`ask`] without a generic parameter, so that it is compiled only once.
fn ask_compiled_once(
    starts: &DriftStarts<'_>,
    question: Question,
    (of, x): (&[usize], &[f64]),
    out: &mut [DriftAnswer],
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    assert!(starts.fit(starts.len()), "expected columns of one length, or single numbers");
    assert!(of.len() == x.len() && out.len() == x.len(), "of, x and out have different lengths");
    spare()?;
    let mut blocks = room(x.len().div_ceil(64))?;
    for ((of, x), out) in of.chunks(64).zip(x.chunks(64)).zip(out.chunks_mut(64)) {
        blocks.push((of, x, out));
    }
    Ok(share(blocks, threads, go_on, |(of, x, out), still| {
        let mut known: Option<(usize, Option<Drift>)> = None;
        for ((i, x), out) in of.iter().zip(x).zip(out) {
            if known.as_ref().is_none_or(|(k, _)| k != i) {
                if !still() {
                    return;
                }
                known = Some((*i, single(starts, *i).ok()));
            }
            *out = DriftAnswer::NONE;
            let Some((_, Some(drift))) = &known else { continue };
            match question {
                Question::Time => out.time = drift.time(*x),
                Question::Stable => out.time = drift.stable_until(),
                Question::At => {
                    if let Some(DriftState { state, precession, friction_coefficient }) = drift.at(*x) {
                        let State { theta, w1, w3, .. } = state;
                        *out = DriftAnswer { theta, w1, w3, precession, friction_coefficient, ..*out };
                    }
                }
            }
        }
    }))
}
