//! Many motions at once: every body from its own state, on lanes and threads.
//!
//! ```text
//! near     one series about the start, of 8, 12, 20 or 36 terms: as many as the width of the swing takes
//! marched  panel by panel of 32 or 56 terms, to what ends the motion or to both its turning points
//! far      48 terms about the start, 64 about the middle of a wider swing, where ends are not asked for
//! alone    `motion::roll`, one at a time
//! ```
//! The solution by first integrals, eight at a time, where its own error estimate stays below what was asked
//! for: of a narrow swing that nothing ends by one series, of everything else by a march (`ends`), which looks at no more
//! than what lies before the end. What neither answers within the error goes one at a time: one start in a thousand of
//! those drawn at random. Which of these answers is decided for each motion by itself, so the same bits come out for any
//! number of threads, neighbours and SIMD width. RK4 at a fixed step is there for those who ask for it (`steps`).

mod ends;
mod flow_lanes;
mod lanes;
mod lossy_lanes;
mod rows;
mod side_by_side;
mod single;
mod slip_lanes;
pub mod slips;
mod steps;
mod swung;
mod walks;

use crate::contact::{Contact, Table};
use crate::error::{Error, room, spare, within};
use crate::motion::{self, Ask};
use crate::threads::share;
use std::sync::OnceLock;

/// Bodies and states, as columns of numbers: each of one length n, or a single number for all.
#[derive(Debug, Clone, Copy)]
pub struct MotionStarts<'a> {
    /// ell, i1, i3, fillet, theta_end (that of the body where it is NaN).
    pub bodies: [&'a [f64]; 5],
    /// theta, w1, w2, w3.
    pub states: [&'a [f64]; 4],
}

impl MotionStarts<'_> {
    /// How many there are.
    pub fn len(&self) -> usize {
        let columns = self.bodies.iter().chain(&self.states);
        columns.map(|x| x.len()).find(|n| *n != 1).unwrap_or(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the rim of the body has a fillet.
    fn is_rounded(&self, i: usize) -> bool {
        let fillet = self.bodies[3];
        fillet[if fillet.len() == 1 { 0 } else { i }] != 0.0
    }

    fn row(&self, i: usize) -> ([f64; 5], [f64; 4]) {
        let at = |x: &[f64]| if x.len() == 1 { x[0] } else { x[i] };
        (self.bodies.map(at), self.states.map(at))
    }
}

/// What is asked of all of them.
#[derive(Debug, Clone, Copy)]
pub struct Job<'a> {
    /// Rolling, or a smooth table.
    pub contact: Contact,
    /// Times, in order, on one side of 0, where the states are given.
    pub times: &'a [f64],
    /// The error that is good enough.
    pub tol: f64,
    /// RK4 with this fixed step, instead of the first integrals.
    pub step: Option<f64>,
    /// Coefficient of friction; infinite: rolling is never given up.
    pub mu: f64,
    /// Whether to go on beyond an event (never beyond a landing of the face).
    pub beyond: bool,
}

impl<'a> Job<'a> {
    /// Rolling, by first integrals to 1e-10, ended by the first event.
    pub fn new(times: &'a [f64]) -> Self {
        Self { contact: Contact::Rolling, times, tol: 1e-10, step: None, mu: f64::INFINITY, beyond: false }
    }

    fn span(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    fn scene(&self) -> Ask {
        let method = self.step.map_or(motion::Method::Exact, motion::Method::Step);
        Ask { method, beyond: self.beyond, ..Ask::on(Table::of(self.contact, self.mu)) }
    }
}

/// A number that sums up a motion, from its start to its end or the last time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
pub enum Summary {
    /// Least inclination.
    ThetaMin,
    /// Greatest inclination.
    ThetaMax,
    /// Least normal force, per weight.
    NormalMin,
    /// Greatest coefficient of friction that rolling needs; infinite where nothing presses.
    FrictionCoefficientMax,
    /// Time of a nutation, infinite where there is none.
    Period,
    /// Precession of a nutation, in radians; NaN where there is none.
    PrecessionPerPeriod,
    /// When it ended: the last time, or the event's.
    End,
}

/// How many kinds of [`Summary`] there are.
pub const SUMMARIES: usize = 7;

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
}

/// Status of a motion that was none: see [`Answer::None`]. Below it the codes of [`Ending`](motion::Ending).
pub const INVALID: u8 = 5;

/// Status of a motion that was given up, because it hardly advances or changes too often between slipping and rolling.
pub const BOUNDED: u8 = 8;

/// Where the answers go; what is `None` is not computed.
#[derive(Debug)]
pub struct MotionOutput<'a> {
    /// theta, w1, w2, w3, row-major (motion, time); NaN after an end.
    pub states: Option<[&'a mut [f64]; 4]>,
    /// theta, w1, w2, w3 at the last time, or at the end.
    pub last: Option<[&'a mut [f64]; 4]>,
    /// By [`Summary`].
    pub summary: [Option<&'a mut [f64]>; SUMMARIES],
    /// Estimated error of a motion's states, the largest of any number at any time.
    pub error: &'a mut [f64],
    /// Code of the [`Answer`].
    pub method: &'a mut [u8],
    /// Code of the [`Ending`](motion::Ending), or [`INVALID`].
    pub status: &'a mut [u8],
}

impl<'a> MotionOutput<'a> {
    /// The first `count` motions of each, and the rest.
    fn split(self, count: usize, times: usize) -> (Self, Self) {
        let pair = |x: [&'a mut [f64]; 4], at: usize| {
            let [a, b, c, d] = x.map(|x| x.split_at_mut(at));
            ([a.0, b.0, c.0, d.0], [a.1, b.1, c.1, d.1])
        };
        let (states, later_states) = self.states.map(|x| pair(x, count * times)).unzip();
        let (last, later_last) = self.last.map(|x| pair(x, count)).unzip();
        let mut later_summary = [const { None }; SUMMARIES];
        let mut summary = [const { None }; SUMMARIES];
        for (i, x) in self.summary.into_iter().enumerate() {
            (summary[i], later_summary[i]) = x.map(|x| x.split_at_mut(count)).unzip();
        }
        let (error, later_error) = self.error.split_at_mut(count);
        let (method, later_method) = self.method.split_at_mut(count);
        let (status, later_status) = self.status.split_at_mut(count);
        (
            Self { states, last, summary, error, method, status },
            Self {
                states: later_states,
                last: later_last,
                summary: later_summary,
                error: later_error,
                method: later_method,
                status: later_status,
            },
        )
    }

    fn fits(&self, count: usize, times: usize) -> bool {
        let all = |x: &Option<[&'a mut [f64]; 4]>, n: usize| x.iter().flatten().all(|x| x.len() == n);
        all(&self.states, count * times)
            && all(&self.last, count)
            && self.summary.iter().flatten().all(|x| x.len() == count)
            && [self.error.len(), self.method.len(), self.status.len()] == [count; 3]
    }

    fn wants(&self, summary: Summary) -> bool {
        self.summary[summary as usize].is_some()
    }

    fn put(&mut self, summary: Summary, i: usize, value: f64) {
        if let Some(x) = &mut self.summary[summary as usize] {
            x[i] = value;
        }
    }
}

/// Motions in a block: few enough that the caller is asked often, and that what is known of them is small.
const BLOCK: usize = 2048;

/// Fills the harvest of all motions, on `threads` workers, the caller among them, which asks `go_on` about
/// fifty times a second with the share that is done. Returns whether it finished; if not, the contents are
/// unspecified.
///
/// A body or state out of the range of [`motion::roll`] has NaN and the status [`INVALID`]. Errors, before
/// any work: `OutOfRange` for times, tolerance, step or mu that make no sense; at any time `Memory`.
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
    let count = starts.len();
    let columns = starts.bodies.iter().chain(&starts.states);
    assert!(columns.into_iter().all(|x| x.len() == 1 || x.len() == count), "columns of different lengths");
    assert!(out.fits(count, job.times.len()), "an array does not fit");
    within("tol", job.tol, (1e-15, 1e-1), "1e-15 <= tol <= 0.1")?;
    motion::check(&job.scene(), 0.0, job.times)?;
    spare()?;
    let block = (BLOCK * 8 / job.times.len().max(1)).clamp(16, BLOCK);
    let (mut rest, mut blocks) = (out, room(count.div_ceil(block))?);
    for first in (0..count).step_by(block) {
        let here = block.min(count - first);
        let (cut, after) = rest.split(here, job.times.len());
        blocks.push((first, here, cut));
        rest = after;
    }
    let level = crate::number::level();
    let failed = OnceLock::new();
    let mut go_on = |share| failed.get().is_none() && go_on(share);
    let all = share(blocks, threads, &mut go_on, |(first, count, mut out), still| {
        let work = lanes::MotionBlock { starts, job, first };
        for i in work.run(level, count, &mut out, still) {
            if !still() {
                return;
            }
            if let Err(e) = single::roll(starts.row(first + i), job, i, &mut out, still) {
                // the first error is as good as any other
                let _ = failed.set(e);
                return;
            }
        }
    });
    failed.into_inner().map_or(Ok(all), Err)
}
