//! Many motions at once: every body has its own initial state, and lanes and threads share the work.
//!
//! ```text
//! near     one series about the start, of 8 to 72 terms, as the width of the swing requires
//! marched  panels of 32 or 56 terms, up to the end of the motion or to both its turning points
//! alone    `motion::roll`, one motion at a time
//! flows    motions with friction or losses, or on slopes, each with its own steps (`flows`), and phases of rolling (`rolls`)
//! ```
//! Motions without friction and losses are solved by first integrals, eight at a time, where the estimated error stays
//! below the tolerance. A swing without an end takes one series; all other motions take a march (`ends`), which goes no
//! farther than the end. A motion for which neither is precise enough is computed alone: one random initial state in a
//! thousand. The method is chosen for each motion separately, so that the result has the same bits for any number of
//! threads, any SIMD width and any other motions in the call. RK4 with a fixed step is used on request (`steps`).
//!
//! ```
//! use spincyl::ensemble::{Job, MotionColumns, MotionOutput, roll};
//! use spincyl::{Body, motion::Ending, steady};
//!
//! let body = Body::solid(2.5)?;
//! let state = steady::state(&body, 1.3)?;
//! let columns: MotionColumns = [0.0, 0.01, 0.02].into_iter().map(|kick| (body, state.kicked(kick))).collect();
//! let (mut error, mut method, mut status) = ([0.0; 3], [0; 3], [0; 3]);
//! let out = MotionOutput::new(&mut error, &mut method, &mut status);
//! assert!(roll(&columns.starts(), &Job::new(&[10.0]), out, 1, |_| true)?);
//! assert!(error.iter().all(|error| *error < 1e-10));
//! assert!(status.iter().all(|code| Ending::from_code(*code) == Some(Ending::Done)));
//! # Ok::<(), spincyl::Error>(())
//! ```

mod columns;
mod customs;
mod ends;
mod flows;
mod lanes;
mod lossy_lanes;
mod rolls;
mod rows;
#[cfg(all(test, any(target_arch = "x86", target_arch = "x86_64"), lanes_of_eight))]
mod shares;
mod single;
mod slip_lanes;
mod steps;
mod swung;
mod walks;

pub use super::columns::{BodyColumns, LossColumns, StateColumns};
use super::columns::{RowBlock, blocks};
use super::threads::share_with_large_stacks;
use crate::error::{Error, spare, spare_for, within};
use crate::laws::contact::{Contact, Table};
use crate::laws::loss::Losses;
use crate::motions::ask::{check_conserving, check_flow, check_times_after};
use crate::motions::{Ask, Method};
use crate::numbers::codes::coded;
pub(crate) use columns::CirclesOfRow;
use columns::TimedOutput;
pub use columns::{MotionColumns, MotionOutput, MotionStarts, SUMMARIES, Summary};
pub(crate) use customs::{CustomLaws, roll_custom};
use fearless_simd::Level;
use std::sync::OnceLock;

/// The options, the times and the tolerance that all motions of a call share.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Job<'a> {
    /// The options of every motion. Coefficients of friction that the motions have themselves replace those of
    /// [`Ask::table`], which is then only the kind of contact. [`Ask::method`] is exact, or a fixed step. Losses are
    /// columns of [`MotionStarts`], and poses and forces belong to single motions.
    pub ask: Ask,
    /// Times of the states, in sqrt(R/g), ascending from 0 on or descending from 0 on; with friction or losses ascending.
    pub times: &'a [f64],
    /// The allowed error of a motion; with friction or losses, the tolerance of a step.
    pub tol: f64,
    /// Whether errors are estimated of motions that are integrated because of friction, losses or impacts. Each of them is
    /// then computed a second time, with a larger tolerance; otherwise its error is NaN.
    pub errors: bool,
}

impl<'a> Job<'a> {
    /// A job of rolling, computed by first integrals with the tolerance 1e-10, in which the first event ends a motion.
    pub fn new(times: &'a [f64]) -> Self {
        Self { ask: Ask::default(), times, tol: 1e-10, errors: true }
    }

    /// Returns this job with these options.
    #[must_use]
    pub fn with_ask(self, ask: Ask) -> Self {
        Self { ask, ..self }
    }

    /// Returns this job with the tolerance `tol`.
    #[must_use]
    pub fn with_tol(self, tol: f64) -> Self {
        Self { tol, ..self }
    }

    /// Returns this job without estimates of the errors.
    #[must_use]
    pub fn without_errors(self) -> Self {
        Self { errors: false, ..self }
    }

    fn span(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    fn contact(&self) -> Contact {
        self.ask.table.contact()
    }

    /// The fixed step of RK4; None if the job has none.
    fn step(&self) -> Option<f64> {
        if let Method::Step(step) = self.ask.method { Some(step) } else { None }
    }

    /// The table of one motion, with its own coefficients of friction if it has any.
    fn table(&self, own: Option<[f64; 3]>) -> Table {
        own.map_or(self.ask.table, |own| self.ask.table.with_coefficients(own))
    }

    /// The options of one motion that is integrated, with its losses and with its own coefficients of friction if it has any.
    fn ask_of(&self, own: Option<[f64; 3]>, losses: Losses) -> Ask {
        Ask { table: self.table(own), losses, method: Method::Tolerance(self.tol), ..self.ask }
    }

    /// This job for phases of rolling within other motions: under a law of friction no motion continues past an event.
    fn of_rolling(&self) -> Self {
        self.with_ask(Ask { beyond: self.ask.beyond && !self.ask.table.rubs(), ..self.ask })
    }

    /// Returns an error for options that are invalid for every motion of the job.
    fn check(&self, flows: bool, own_tables: bool) -> Result<(), Error> {
        let ask = self.ask;
        let unknown = |name, value, expected| Err(Error::OutOfRange { name, value, expected });
        if let Some((law, coefficient)) = ask.losses.iter().next() {
            return unknown(
                law.parameter(),
                coefficient,
                "0: give the losses of many motions by `MotionStarts::with_losses`",
            );
        }
        for (name, value) in [("slope", ask.slope), ("turning", ask.turning)] {
            if value != 0.0 {
                return unknown(
                    name,
                    value,
                    "0: give the slopes of many motions by `MotionStarts::with_slopes`",
                );
            }
        }
        if let Method::Tolerance(tol) = ask.method {
            return unknown("method", tol, "exact or a fixed step: give a tolerance by `Job::with_tol`");
        }
        if ask.pose || ask.force {
            return unknown("pose, force", 1.0, "false: poses and forces are only for single motions");
        }
        if !flows {
            within("tol", self.tol, (1e-15, 1e-1), "1e-15 <= tol <= 0.1")?;
            return check_conserving(&ask, 0.0, self.times).map(|_| ());
        }
        let method = self.step().map_or(Method::Tolerance(self.tol), Method::Step);
        if !(self.ask.table.rubs() && own_tables) {
            ask.table.check()?;
        }
        check_flow(&Ask { method, ..ask })?;
        check_times_after(0.0, self.times)
    }
}

coded! {
    /// The method that computed a motion: the code in `MotionOutput::method`.
    pub enum Answer {
        /// The motion was not computed, because the body or the state is invalid, or the step is too long.
        None = 0,
        /// The first integrals, in SIMD lanes; with a law of friction or a restitution, where the body rolls from the
        /// start to the end.
        Lanes = 1,
        /// The first integrals, for one motion at a time.
        Single = 2,
        /// Steps of eighth order with a tolerance, where the first integrals lose their digits.
        Tolerance = 3,
        /// RK4 with a fixed step.
        Step = 4,
        /// Steps of eighth order with a tolerance, for a motion with friction or losses.
        Flow = 5,
    }
}

/// Number of motions in a block: small enough for frequent calls of `go_on` and for little memory.
const MOTIONS_PER_BLOCK: usize = 2048;
/// Number of motions with friction or losses in a block: each needs more memory, but a block should be large enough to
/// keep all SIMD lanes filled.
const FLOWS_PER_BLOCK: usize = 1024;

/// Computes all motions and fills `out`, on `threads` threads with stacks that are large enough. The calling thread
/// calls `go_on` about fifty times a second with the finished share of the work, and stops if `go_on` returns false.
/// Returns whether all motions are done; if not, the contents of `out` are unspecified.
///
/// A motion gets NaN and the status of [`Ending::Invalid`](crate::motion::Ending::Invalid) if its body, state, contact
/// or loss is out of the range of [`roll_with`](crate::motion::roll_with), and the status of
/// [`Ending::Painleve`](crate::motion::Ending::Painleve) if its initial state has no unique contact force.
///
/// # Errors
/// `OutOfRange`, before any work, for invalid times, tolerance, step, mu or other options of the job; `Memory` at any
/// time.
///
/// # Panics
/// The function panics if columns differ in length (apart from single numbers), or if an array of `out` does not fit
/// them.
pub fn roll(
    starts: &MotionStarts<'_>,
    job: &Job<'_>,
    out: MotionOutput<'_>,
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<bool, Error> {
    roll_among(starts, job, out, (threads, false), &mut go_on)
}

/// Computes all motions as [`roll`] does; the calling thread also computes, if its stack is large enough (`roomy`: some MiB).
pub(crate) fn roll_among(
    starts: &MotionStarts<'_>,
    job: &Job<'_>,
    out: MotionOutput<'_>,
    (threads, roomy): (usize, bool),
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    let (count, times) = (starts.len(), job.times.len());
    assert!(starts.fit(), "expected columns of one length, or single numbers");
    assert!(out.fits(count, times), "an output array does not have the length of the results");
    let level_flows = job.ask.table.rubs() || starts.losses.is_some() || job.ask.restitution.is_some();
    let flows = level_flows || starts.slopes.is_some();
    job.check(flows, starts.coefficients.is_some())?;
    let size = if flows {
        let workers = threads.min(count.div_ceil(FLOWS_PER_BLOCK));
        spare_for(workers.saturating_mul(flows::size_of_block(FLOWS_PER_BLOCK.min(count), times)))?;
        FLOWS_PER_BLOCK
    } else {
        spare()?;
        (MOTIONS_PER_BLOCK * 8 / times.max(1)).clamp(16, MOTIONS_PER_BLOCK)
    };
    let blocks = blocks(TimedOutput { out, times }, count, size)?;
    let level = crate::numbers::level();
    let failed = OnceLock::new();
    let mut go_on = |share| failed.get().is_none() && go_on(share);
    let all = share_with_large_stacks(
        blocks,
        (threads, roomy),
        &mut go_on,
        |RowBlock { first, count, out }, still| {
            let (work, mut out) = (MotionBlock { starts, job, first, since: None }, out.out);
            let loses = starts.losses.is_some() || starts.has_patch();
            let (flat, tilted): (Vec<_>, Vec<_>) = (0..count).partition(|k| starts.is_level(first + k));
            let done = if level_flows {
                let left = work.roll_throughout(level, flat, &mut out, still);
                if loses {
                    work.flow::<10>(level, &left, &mut out, still)
                } else {
                    work.flow::<9>(level, &left, &mut out, still)
                }
            } else {
                conserved(&work, level, (flat, &mut out), still)
            };
            let done = done.and_then(|()| {
                if tilted.is_empty() { Ok(()) } else { work.flow::<14>(level, &tilted, &mut out, still) }
            });
            if let Err(e) = done {
                // The first error is reported, and later errors are dropped.
                let _ = failed.set(e);
            }
        },
    );
    failed.into_inner().map_or(Ok(all), Err)
}

/// Computes motions of a block by first integrals: in SIMD lanes, and one at a time where the lanes have no result.
fn conserved(
    work: &MotionBlock<'_>,
    level: Option<Level>,
    (rows, out): (Vec<usize>, &mut MotionOutput<'_>),
    go_on: &mut dyn FnMut() -> bool,
) -> Result<(), Error> {
    let (alone, in_lanes): (Vec<_>, _) = rows.into_iter().partition(|i| work.starts.has_row(work.first + i));
    for i in work.run(level, in_lanes, out, go_on).into_iter().chain(alone) {
        if !go_on() {
            return Ok(());
        }
        single::roll(work, i, out, go_on)?;
    }
    Ok(())
}

struct MotionBlock<'a> {
    starts: &'a MotionStarts<'a>,
    job: &'a Job<'a>,
    /// The index of the first motion of the block.
    first: usize,
    /// The time at which each motion begins, if they do not all begin at time 0; the job has no time before 0.
    since: Option<&'a [f64]>,
}

impl MotionBlock<'_> {
    /// The time at which motion `i` of the block begins.
    fn since(&self, i: usize) -> f64 {
        self.since.map_or(0.0, |all| all[i])
    }

    /// Whether motions that roll may begin to slip.
    fn may_slip(&self) -> bool {
        let table = self.job.ask.table;
        let limited = table.rubs() || table.mu().is_finite();
        limited && self.job.contact() == Contact::Rolling && !self.job.ask.beyond
    }

    /// The largest ratio of friction to normal force with which motion `i` of the block can roll.
    fn grip(&self, i: usize) -> f64 {
        let own = self.starts.coefficients(self.first + i).filter(|_| self.job.ask.table.rubs());
        own.map_or(self.job.ask.table.mu(), |[_, fixed, _]| fixed)
    }
}
