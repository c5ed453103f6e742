//! Many motions with friction or losses at once: from the flick to rolling, and to the last turn, for every body and every table.
//!
//! ```text
//! slip, rolling with losses   eight at a time, each with its own steps (Dormand and Prince, eighth order), twice: tol and 1e4 tol
//! what lies between           one at a time: what comes after a slip, what is held, rolling by the first integrals
//! ```
//! A slip that loses energy besides is followed alone.
//! A lane that ends is filled with the next slip at once. Which steps a motion takes does not depend on its neighbours, so the
//! same bits come out for any number of threads and any SIMD width. [`motion::path`](crate::motion::path) has the law and the
//! claim of an error.

use super::lossy_lanes::LossyLanes;
use super::side_by_side::{SideBySide, zero};
use super::slip_lanes::Slips;
use super::walks::{Among, Walks, lanes};
use crate::body::Body;
use crate::contact::{Table, TableKind};
use crate::error::{Error, room, spare_for, within};
use crate::loss::{COUNT, Losses};
use crate::motion::path::{self, Followed, Kind, Pause, Walk};
use crate::motion::{Ask, Ending, Method, Start, check, check_plastic};
use crate::number::in_lanes;
use crate::state::State;
use crate::threads::share;
use fearless_simd::Level;
use std::sync::OnceLock;

/// Bodies, states, slips and tables, as columns of numbers: each of one length n, or a single number for all.
#[derive(Debug, Clone, Copy)]
pub struct SlipStarts<'a> {
    /// ell, i1, i3, fillet, theta_end (that of the body where it is NaN).
    pub bodies: [&'a [f64]; 5],
    /// theta, w1, w2, w3.
    pub states: [&'a [f64]; 4],
    /// Along the lean, across it.
    pub slips: [&'a [f64]; 2],
    /// What all tables have in common.
    pub table: TableKind,
    /// mu and the static coefficient, or c or mu and whatever.
    pub coefficients: [&'a [f64]; 2],
    /// What takes energy besides, in the order of [`Law::ALL`](crate::loss::Law::ALL).
    pub losses: Option<[&'a [f64]; COUNT]>,
}

impl<'a> SlipStarts<'a> {
    fn columns(&self) -> impl Iterator<Item = &'a [f64]> {
        let losses = self.losses.into_iter().flatten();
        self.bodies.into_iter().chain(self.states).chain(self.slips).chain(self.coefficients).chain(losses)
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.columns().map(|x| x.len()).find(|n| *n != 1).unwrap_or(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Motion `i`, if its body can be.
    fn row(&self, i: usize) -> Result<(Body, State, [f64; 2], Table, Losses), Error> {
        let at = |x: &[f64]| if x.len() == 1 { x[0] } else { x[i] };
        let [ell, i1, i3, fillet, theta_end] = self.bodies.map(at);
        let body = Body::of_numbers([ell, i1, i3, f64::NAN, fillet, theta_end])?;
        let table = self.table.with(self.coefficients.map(at));
        let losses = self.losses.map_or(Losses::NONE, |all| Losses { coefficients: all.map(at) });
        Ok((body, State::from(self.states.map(at)), self.slips.map(at), table, losses))
    }
}

/// What is asked of all of them.
#[derive(Debug, Clone, Copy)]
pub struct SlipJob<'a> {
    /// Times, in order, from 0 on, where the states are given.
    pub times: &'a [f64],
    /// What a step may err by.
    pub tol: f64,
    /// The coefficient of restitution of a landing of the other rim, 0: the rim does not bounce, and the motion goes on. With
    /// `None` the motion ends there.
    pub restitution: Option<f64>,
    /// Whether they end where they begin to roll.
    pub stop_at_rolling: bool,
}

/// A number that sums up a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
pub enum SlipSummary {
    /// When it ended: the last time, or the event's.
    End,
    /// How long it slipped.
    SlipTime,
    /// The heat made by friction, in M g R.
    Dissipated,
    /// What the losses have taken, in M g R.
    WorkLost,
    /// How many phases it had.
    Phases,
    /// When the last phase that rolls began; NaN if none does, as are the next four.
    RollingTime,
    /// The state then.
    RollingTheta,
    /// The same.
    RollingW1,
    /// The same.
    RollingW2,
    /// The same.
    RollingW3,
}

/// How many kinds of [`SlipSummary`] there are.
pub const SUMMARIES: usize = 10;

/// Where the answers go; what is `None` is not computed.
#[derive(Debug)]
pub struct SlipOutput<'a> {
    /// theta, w1, w2, w3 and the slip, row-major (motion, time); NaN after an end.
    pub states: Option<[&'a mut [f64]; 6]>,
    /// The same at the last time, or at the end.
    pub last: Option<[&'a mut [f64]; 6]>,
    /// By [`SlipSummary`].
    pub summary: [Option<&'a mut [f64]>; SUMMARIES],
    /// Estimated error of a motion's states, slips, phases and end.
    pub error: &'a mut [f64],
    /// Code of the [`Ending`], or [`INVALID`](super::INVALID).
    pub status: &'a mut [u8],
}

impl<'a> SlipOutput<'a> {
    /// The first `count` motions of each, and the rest.
    fn split(self, count: usize, times: usize) -> (Self, Self) {
        let cut = |x: Option<[&'a mut [f64]; 6]>, at: usize| {
            x.map(|x| {
                let [a, b, c, d, e, f] = x.map(|x| x.split_at_mut(at));
                ([a.0, b.0, c.0, d.0, e.0, f.0], [a.1, b.1, c.1, d.1, e.1, f.1])
            })
            .unzip()
        };
        let (states, later_states) = cut(self.states, count * times);
        let (last, later_last) = cut(self.last, count);
        let mut later_summary = [const { None }; SUMMARIES];
        let mut summary = [const { None }; SUMMARIES];
        for (i, x) in self.summary.into_iter().enumerate() {
            (summary[i], later_summary[i]) = x.map(|x| x.split_at_mut(count)).unzip();
        }
        let (error, later_error) = self.error.split_at_mut(count);
        let (status, later_status) = self.status.split_at_mut(count);
        (
            Self { states, last, summary, error, status },
            Self {
                states: later_states,
                last: later_last,
                summary: later_summary,
                error: later_error,
                status: later_status,
            },
        )
    }

    fn fits(&self, count: usize, times: usize) -> bool {
        let all = |x: &Option<[&'a mut [f64]; 6]>, n: usize| x.iter().flatten().all(|x| x.len() == n);
        all(&self.states, count * times)
            && all(&self.last, count)
            && self.summary.iter().flatten().all(|x| x.len() == count)
            && [self.error.len(), self.status.len()] == [count; 2]
    }

    /// No answer.
    fn blank(&mut self, i: usize, times: usize, status: u8) {
        for column in self.states.iter_mut().flatten() {
            column[i * times..(i + 1) * times].fill(f64::NAN);
        }
        for column in self.last.iter_mut().flatten().chain(self.summary.iter_mut().flatten()) {
            column[i] = f64::NAN;
        }
        (self.error[i], self.status[i]) = (f64::NAN, status);
    }

    fn put(&mut self, i: usize, found: &Followed, times: &[f64]) {
        self.blank(i, times.len(), found.motion.ending() as u8);
        self.error[i] = found.motion.error;
        let row = |y: &State, u: [f64; 2]| [y.theta, y.w1, y.w2, y.w3, u[0], u[1]];
        for (j, (y, u)) in found.motion.states.iter().zip(&found.path.slip).enumerate() {
            for (column, x) in self.states.iter_mut().flatten().zip(row(y, *u)) {
                column[i * times.len() + j] = x;
            }
        }
        if let Some((y, u)) = found.last() {
            for (column, x) in self.last.iter_mut().flatten().zip(row(&y, u)) {
                column[i] = x;
            }
        }
        let end = found.ended().unwrap_or(times[times.len() - 1]);
        let rolling = found.path.phases.iter().rev().find(|phase| phase.kind == Kind::Rolling);
        let [time, theta, w1, w2, w3] = rolling.map_or([f64::NAN; 5], |phase| {
            let State { theta, w1, w2, w3 } = phase.state;
            [phase.time, theta, w1, w2, w3]
        });
        let phases = found.path.phases.len() as f64;
        let sums =
            [end, found.path.slipping, found.path.heat, found.path.lost, phases, time, theta, w1, w2, w3];
        for (column, x) in self.summary.iter_mut().zip(sums) {
            if let Some(column) = column {
                column[i] = x;
            }
        }
    }
}

/// Motions in a block: enough that lanes are seldom empty, few enough that the caller is asked often.
const BLOCK: usize = 1024;

/// Fills the harvest of all motions, on `threads` workers, the caller among them, which asks `go_on` about fifty times a second
/// with the share that is done. Returns whether it finished; if not, the contents are unspecified.
///
/// A body, state or table out of the range of [`path::follow`] has NaN and the status [`INVALID`](super::INVALID), a start
/// without a unique contact force the status of [`Ending::Painleve`]. Errors, before any work: `OutOfRange` for times and
/// tolerances that make no sense; at any time `Memory`.
///
/// # Panics
/// If columns differ in length (but for single numbers), or an array of `out` does not fit them.
pub fn follow(
    starts: &SlipStarts<'_>,
    job: &SlipJob<'_>,
    out: SlipOutput<'_>,
    threads: usize,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<bool, Error> {
    all(starts, job, out, threads, &mut go_on)
}

/// The same, compiled once: here.
fn all(
    starts: &SlipStarts<'_>,
    job: &SlipJob<'_>,
    out: SlipOutput<'_>,
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<bool, Error> {
    let count = starts.len();
    assert!(starts.columns().all(|x| x.len() == 1 || x.len() == count), "columns of different lengths");
    assert!(out.fits(count, job.times.len()), "an array does not fit");
    within("tol", job.tol, (1e-14, 1e-1), "1e-14 <= tol <= 0.1")?;
    check_plastic(job.restitution)?;
    let span = check(&Ask::default(), 0.0, job.times)?;
    within("t", span, (0.0, f64::INFINITY), "times from 0 on: friction does not say where a body came from")?;
    let (some, workers) = (BLOCK.min(count), threads.min(count.div_ceil(BLOCK)));
    spare_for(workers.saturating_mul(size_of_block(some, job.times.len())))?;
    let (mut rest, mut blocks) = (out, room(count.div_ceil(BLOCK))?);
    for first in (0..count).step_by(BLOCK) {
        let here = BLOCK.min(count - first);
        let (cut, after) = rest.split(here, job.times.len());
        blocks.push((first, here, cut));
        rest = after;
    }
    let level = crate::number::level();
    let failed = OnceLock::new();
    let mut go_on = |share| failed.get().is_none() && go_on(share);
    let all = share(blocks, threads, &mut go_on, |(first, count, mut out), still| {
        let work = SlipBlock { starts, job, first };
        let done = match starts.losses {
            Some(_) => work.run::<10>(level, count, &mut out, still),
            None => work.run::<9>(level, count, &mut out, still),
        };
        if let Err(e) = done {
            let _ = failed.set(e);
        }
    });
    failed.into_inner().map_or(Ok(all), Err)
}

/// The most that a block of so many motions, each followed twice, takes in pieces that are too small to be asked for: its
/// walks, the numbers at their times, their phases and what waits for a lane.
fn size_of_block(count: usize, times: usize) -> usize {
    const PHASES: usize = 2048;
    let at_a_time = size_of::<(State, [f64; 2], Kind, [f64; 3])>();
    let one = size_of::<Walk<'_, 10>>() + PHASES + times.saturating_mul(at_a_time);
    one.saturating_mul(2 * count)
}

/// A block of motions.
struct SlipBlock<'a> {
    starts: &'a SlipStarts<'a>,
    job: &'a SlipJob<'a>,
    first: usize,
}

impl<'a> SlipBlock<'a> {
    fn run<const N: usize>(
        &self,
        level: Option<Level>,
        count: usize,
        out: &mut SlipOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), Error> {
        let times = self.job.times;
        spare_for(size_of_block(count, times.len()))?;
        let wide = in_lanes!(level, _ => true, else false);
        let mut all = Walks::<N> { walks: room(2 * count)?, queues: Vec::new(), lanes: wide };
        for i in 0..count {
            let row = self.starts.row(self.first + i);
            for tol in [self.job.tol, path::rougher(self.job.tol)] {
                all.walks.push(row.and_then(|(body, start, slip, table, losses)| {
                    let SlipJob { restitution, stop_at_rolling, .. } = *self.job;
                    let method = Method::Tolerance(self.job.tol);
                    let ask = Ask { method, restitution, stop_at_rolling, losses, ..Ask::on(table) };
                    Walk::new(&body, &ask, tol, times, &Start { slip, ..start.into() })
                }));
            }
        }
        for i in 0..all.walks.len() {
            if !go_on() {
                return Ok(());
            }
            all.lead(i, Ok(Pause::No), go_on);
        }
        while let Some(i) = all.queues.iter().position(|(_, queue)| !queue.is_empty()) {
            if !go_on() {
                return Ok(());
            }
            match level {
                #[cfg(lanes_of_sixteen)]
                Some(Level::Avx512(simd)) => self.flow(zero(simd), i, &mut all, go_on),
                #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), lanes_of_eight))]
                Some(Level::Avx2(simd)) => self.flow(zero(simd), i, &mut all, go_on),
                #[cfg(all(target_arch = "aarch64", lanes_of_eight))]
                Some(Level::Neon(simd)) => self.flow(zero(simd), i, &mut all, go_on),
                _ => return Ok(()),
            }
        }
        let mut walks = all.walks.into_iter();
        for i in 0..count {
            let (Some(fine), Some(rough)) = (walks.next(), walks.next()) else { return Ok(()) };
            // without a second run there is no claim, and no answer of a single motion either
            match fine.and_then(Walk::done).and_then(|found| Ok((found, rough.and_then(Walk::done)?))) {
                Ok((mut found, rough)) => {
                    found.judge(&rough, self.job.tol);
                    out.put(i, &found, times);
                }
                Err(e @ Error::Memory { .. }) => return Err(e),
                Err(Error::Painleve { .. }) => out.blank(i, times.len(), Ending::Painleve as u8),
                Err(Error::Endless { .. } | Error::Restless { .. }) => {
                    out.blank(i, times.len(), super::BOUNDED);
                }
                Err(_) => out.blank(i, times.len(), super::INVALID),
            }
        }
        Ok(())
    }

    /// All that waits in a queue, side by side.
    fn flow<T: SideBySide, const N: usize>(
        &self,
        like: T,
        queue: usize,
        all: &mut Walks<'a, N>,
        go_on: &mut dyn FnMut() -> bool,
    ) {
        match all.queues[queue].0 {
            Among::Slips { dry } => lanes(like, queue, Slips::new(like, dry), all, go_on),
            Among::Lossy(kind) => lanes(like, queue, LossyLanes::new(like, kind), all, go_on),
        }
    }
}
