//! Many motions at once: every body from its own state, on lanes and threads.
//!
//! ```text
//! near     one series about the start, of 8, 12, 20 or 36 terms: as many as the width of the swing takes
//! marched  panel by panel of 32 or 56 terms, to what ends the motion or to both its turning points
//! far      48 terms about the start, 64 about the middle of a wider swing, where ends are not asked for
//! alone    `motion::roll`, one at a time
//! flows    with friction or losses: each with its own steps (`flows`)
//! ```
//! The solution by first integrals, eight at a time, where its own error estimate stays below what was asked
//! for: of a narrow swing that nothing ends by one series, of everything else by a march (`ends`), which looks at no more
//! than what lies before the end. What neither answers within the error goes one at a time: one start in a thousand of
//! those drawn at random. Which of these answers is decided for each motion by itself, so the same bits come out for any
//! number of threads, neighbours and SIMD width. RK4 at a fixed step is there for those who ask for it (`steps`).

mod columns;
mod ends;
mod flow_lanes;
mod flows;
mod lanes;
mod lossy_lanes;
mod rows;
mod side_by_side;
mod single;
mod slip_lanes;
mod steps;
mod swung;
mod walks;

use crate::contact::{Contact, TableKind};
use crate::error::{Error, spare, spare_for, within};
use crate::loss::Losses;
use crate::motion::{self, Ask, Method};
use crate::threads::share;
use columns::BlockColumns;
pub use columns::{MotionOutput, MotionStarts, SUMMARIES, Summary};
use fearless_simd::Level;
use std::sync::OnceLock;

/// What is asked of all of them.
#[derive(Debug, Clone, Copy)]
pub struct Job<'a> {
    /// What their tables have in common.
    pub table: TableKind,
    /// Coefficient of friction of tables on which bodies roll; infinite: rolling is never given up.
    pub mu: f64,
    /// Times, in order, on one side of 0, where the states are given; with friction or losses from 0 on.
    pub times: &'a [f64],
    /// The error that is good enough; with friction or losses what a step may err by.
    pub tol: f64,
    /// RK4 with this fixed step, instead of the first integrals.
    pub step: Option<f64>,
    /// Whether to go on beyond an event (never beyond a landing of the face).
    pub beyond: bool,
    /// As in [`Ask`].
    pub restitution: Option<f64>,
    /// As in [`Ask`].
    pub stop_at_rolling: bool,
}

impl<'a> Job<'a> {
    /// Rolling, by first integrals to 1e-10, ended by the first event.
    pub fn new(times: &'a [f64]) -> Self {
        Self {
            table: TableKind::Rolling,
            mu: f64::INFINITY,
            times,
            tol: 1e-10,
            step: None,
            beyond: false,
            restitution: None,
            stop_at_rolling: false,
        }
    }

    fn span(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    fn contact(&self) -> Contact {
        self.table.contact()
    }

    /// What is asked of one of them; with its own coefficients of the table, if it has any.
    fn ask(&self, coefficients: Option<[f64; 2]>, losses: Losses) -> Ask {
        Ask {
            table: self.table.with(coefficients.unwrap_or([self.mu; 2])),
            losses,
            method: self.step.map_or(Method::Exact, Method::Step),
            beyond: self.beyond,
            restitution: self.restitution,
            stop_at_rolling: self.stop_at_rolling,
            ..Ask::default()
        }
    }

    /// Refuses what makes no sense for any of them.
    fn check(&self, flows: bool) -> Result<(), Error> {
        let ask = self.ask(None, Losses::NONE);
        if !flows {
            within("tol", self.tol, (1e-15, 1e-1), "1e-15 <= tol <= 0.1")?;
            return motion::check(&ask, 0.0, self.times).map(|_| ());
        }
        let method = self.step.map_or(Method::Tolerance(self.tol), Method::Step);
        if !self.table.rubs() {
            ask.table.check()?;
        }
        motion::check_flow(&Ask { method, ..ask })?;
        motion::check_times_after(0.0, self.times)
    }
}

/// Who answered: the code in [`MotionOutput::method`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Answer {
    /// Nobody: no body or state of which a motion can be had, or a step too large for it.
    None = 0,
    /// The first integrals, in lanes.
    Lanes = 1,
    /// The first integrals, alone.
    Single = 2,
    /// RK4 whose steps keep an error, where the first integrals lose their digits.
    Tolerance = 3,
    /// RK4 with the fixed step.
    Step = 4,
    /// An integrator of eighth order, with friction or losses.
    Flow = 5,
}

/// Status of a motion that was none: see [`Answer::None`]. Below it the codes of [`Ending`](motion::Ending).
pub const INVALID: u8 = 5;

/// Status of a motion that was given up, because it hardly advances or changes too often between slipping and rolling.
pub const BOUNDED: u8 = 8;

/// Motions in a block: few enough that the caller is asked often, and that what is known of them is small.
const BLOCK: usize = 2048;
/// The same of motions with friction or losses, of which more is known: still enough that lanes are seldom empty.
const FLOWS: usize = 1024;

/// Fills the harvest of all motions, on `threads` workers, the caller among them, which asks `go_on` about
/// fifty times a second with the share that is done. Returns whether it finished; if not, the contents are
/// unspecified.
///
/// A body, state, table or loss out of the range of [`motion::roll_with`] has NaN and the status [`INVALID`], a start without a
/// unique contact force the status of [`Ending::Painleve`](motion::Ending::Painleve). Errors, before any work: `OutOfRange` for
/// times, tolerance, step or mu that make no sense; at any time `Memory`.
///
/// # Panics
/// If columns differ in length (but for single numbers), or an array of `out` does not fit them.
pub fn roll(
    starts: &MotionStarts<'_>,
    job: &Job<'_>,
    out: MotionOutput<'_>,
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<bool, Error> {
    all(starts, job, out, threads, &mut go_on)
}

/// The same, compiled once: here.
fn all(
    starts: &MotionStarts<'_>,
    job: &Job<'_>,
    out: MotionOutput<'_>,
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    let (count, times) = (starts.len(), job.times.len());
    assert!(starts.fit(), "columns of different lengths");
    assert!(out.fits(count, times), "an array does not fit");
    let flows = job.table.rubs() || starts.losses.is_some();
    job.check(flows)?;
    let size = if flows {
        let workers = threads.min(count.div_ceil(FLOWS));
        spare_for(workers.saturating_mul(flows::size_of_block(FLOWS.min(count), times)))?;
        FLOWS
    } else {
        spare()?;
        (BLOCK * 8 / times.max(1)).clamp(16, BLOCK)
    };
    let blocks = out.blocks((count, times), size)?;
    let level = crate::number::level();
    let failed = OnceLock::new();
    let mut go_on = |share| failed.get().is_none() && go_on(share);
    let all = share(blocks, threads, &mut go_on, |mut block, still| {
        let work = MotionBlock { starts, job, first: block.first };
        let done = match (flows, starts.losses.is_some()) {
            (true, true) => work.flow::<10>(level, block.count, &mut block.out, still),
            (true, false) => work.flow::<9>(level, block.count, &mut block.out, still),
            _ => conserved(&work, level, &mut block, still),
        };
        if let Err(e) = done {
            // the first error is as good as any other
            let _ = failed.set(e);
        }
    });
    failed.into_inner().map_or(Ok(all), Err)
}

/// A block of motions by first integrals: in lanes, and what these leave over alone.
fn conserved(
    work: &MotionBlock<'_>,
    level: Option<Level>,
    block: &mut BlockColumns<'_>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<(), Error> {
    for i in work.run(level, block.count, &mut block.out, go_on) {
        if !go_on() {
            return Ok(());
        }
        single::roll(work, i, &mut block.out, go_on)?;
    }
    Ok(())
}

/// A block of motions.
struct MotionBlock<'a> {
    starts: &'a MotionStarts<'a>,
    job: &'a Job<'a>,
    /// The first motion of the block.
    first: usize,
}
