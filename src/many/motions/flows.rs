//! Many motions with friction or losses, or on slopes, at once: phases of slipping and of rolling, up to the last time or
//! to the end.
//!
//! ```text
//! slip, rolling with losses   eight at a time, each with its own steps (Dormand and Prince, eighth order),
//!                             twice: with tol and with 1e4 tol, or once if no errors are wanted
//! all other phases            one at a time: changes of phase, contacts that are held, rolling by the first integrals
//! ```
//! On a slope the variables in SIMD lanes include cos phi, sin phi and x, and each motion has the units of its own
//! slope. A slip with additional losses is computed alone. A lane whose phase ends takes the next phase at once. The
//! steps of a motion do not depend on the other lanes, so that the result has the same bits for any number of threads
//! and any SIMD width. [`motion::path`](crate::motions::body) has the law and the estimate of the error.

use super::lossy_lanes::LossyLanes;
use super::rolls::can_roll_in_lanes;
use super::slip_lanes::Slips;
use super::walks::{FlowKind, Walks, lanes};
use super::{Answer, MotionBlock, MotionOutput, Summary};
use crate::error::{Error, room, spare_for};
use crate::laws::body::Body;
use crate::laws::state::State;
use crate::motions::ask::rests_on::axis_up;
use crate::motions::body::BodyWalk;
use crate::motions::body::check_walk;
use crate::motions::body::spun::knows;
use crate::motions::slope::Slope;
use crate::motions::walk::Pause;
use crate::motions::walk::numbers::poses;
use crate::motions::walk::two_runs::{Followed, rougher};
use crate::motions::{Ask, Ending, Kind, Phase, Start};
use crate::numbers::in_lanes;
use crate::numbers::side_by_side::{SideBySide, zero};
use fearless_simd::Level;

/// Writes the results of motion `i`, of the given body, into `out`.
fn put(out: &mut MotionOutput<'_>, i: usize, (body, found): (&Body, &Followed), times: &[f64]) {
    if let Some(event) = found.motion.event.filter(|event| event.ending == Ending::Bounded) {
        out.blank(i, times.len(), Ending::Bounded);
        out.put(Summary::End, i, event.time);
        return;
    }
    out.refuse(i, times.len());
    out.tell(i, Answer::Flow, found.motion.ending() as u8, found.motion.error);
    for (j, (y, slip)) in found.motion.states.iter().zip(&found.path.slip).enumerate() {
        out.put_state(i * times.len() + j, y, slip.pair());
    }
    let path = &found.path;
    if let Some((y, slip, rim)) = found.last() {
        out.put_last(i, &y, slip.pair());
        out.put_rims(i * times.len(), &path.rims, (i, rim));
        out.put(Summary::AxisUp, i, axis_up(body, &y, rim));
    }
    if out.wants(Summary::RestsOn) {
        out.put(Summary::RestsOn, i, f64::from(found.rests_on(body) as u8));
    }
    out.put(Summary::End, i, found.ended().unwrap_or(times[times.len() - 1]));
    out.put(Summary::SlipTime, i, path.slipping);
    out.put(Summary::Dissipated, i, path.heat);
    out.put(Summary::WorkLost, i, path.lost);
    out.put(Summary::Phases, i, path.phases.len() as f64);
    let ends = found.ended().unwrap_or(times[times.len() - 1]);
    let next = path.phases.iter().skip(1).map(|phase| phase.time).chain([ends]);
    let flights = path.phases.iter().zip(next).filter(|(phase, _)| phase.kind == Kind::Flying);
    let lands = |pair: &&[Phase]| pair[0].kind == Kind::Flying && pair[1].kind != Kind::Flying;
    out.put(Summary::Impacts, i, path.impacts.len() as f64);
    out.put(Summary::Landings, i, path.phases.windows(2).filter(lands).count() as f64);
    out.put(Summary::AirTime, i, flights.map(|(phase, next)| next - phase.time).sum());
    out.put(Summary::LostInImpacts, i, path.impacts.iter().map(|impact| impact.lost).sum());
    out.put(Summary::LastPhase, i, path.phases.last().map_or(f64::NAN, |phase| f64::from(phase.kind as u8)));
    let Some(rolling) = path.phases.iter().rev().find(|phase| phase.kind == Kind::Rolling) else { return };
    let State { theta, w1, w2, w3 } = rolling.state;
    out.put(Summary::RollingTime, i, rolling.time);
    out.put(Summary::RollingTheta, i, theta);
    out.put(Summary::RollingW1, i, w1);
    out.put(Summary::RollingW2, i, w2);
    out.put(Summary::RollingW3, i, w3);
}

/// Bound in bytes of the small allocations for a block of `count` motions, each computed twice. They are too small to
/// be checked one by one: the states of the computations, the numbers at their times, also in a phase of rolling, their
/// phases and the tasks that wait for a SIMD lane.
pub(super) fn size_of_block(count: usize, times: usize) -> usize {
    const PHASES: usize = 2048;
    let at_a_time = size_of::<(State, [f64; 2], Kind, [f64; 3], State)>();
    let one = size_of::<BodyWalk<'_, 14>>() + size_of::<Asked>() + PHASES + times.saturating_mul(at_a_time);
    one.saturating_mul(2 * count)
}

/// The start and the options of a motion of a block, seen from the circle on which it starts. On a slope they are in
/// the units of that slope, with the numbers for the conversion back: the slope, the start as it was given, and the
/// times in these units.
struct Asked {
    body: Body,
    seen: Body,
    start: Start,
    ask: Ask,
    tilted: Option<(Slope, Start, Vec<f64>)>,
}

impl MotionBlock<'_> {
    /// The start and the options of motion `k` of the block, in the form in which it is computed.
    fn asked(&self, k: usize) -> Result<Asked, Error> {
        let (starts, job, i) = (self.starts, self.job, self.first + k);
        let body = starts.body(i)?;
        let ask = job.ask_of(starts.coefficients(i), starts.losses(i)).with_slope(starts.slope(i)[0]);
        let (seen, start) = starts.start(i, &body, &ask.table).seen_on(&body);
        let Some(slope) = Slope::of(&ask)? else { return Ok(Asked { body, seen, start, ask, tilted: None }) };
        check_walk(&seen, &start, &ask)?;
        let since = slope.times(job.times, start.time)?;
        let (own, ask) = (slope.start(&start), slope.ask(&ask));
        Ok(Asked { body, seen, start: own, ask, tilted: Some((slope, start, since)) })
    }

    /// Computes these motions of the block: motions on slopes if their N variables include a pose, else motions on level tables.
    pub(super) fn flow<const N: usize>(
        &self,
        level: Option<Level>,
        left: &[usize],
        out: &mut MotionOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), Error> {
        let times = self.job.times;
        let wide = in_lanes!(level, _ => true, else false);
        let tols = [self.job.tol, rougher(self.job.tol)];
        let tols = if self.job.errors { &tols[..] } else { &tols[..1] };
        spare_for(size_of_block(left.len(), times.len()))?;
        let mut motions = room(left.len())?;
        motions.extend(left.iter().map(|k| self.asked(*k)));
        let walks = room(tols.len() * left.len())?;
        let mut all = Walks::<N> { walks, queues: Vec::new(), rolls: Vec::new(), lanes: wide };
        let mut walked = room(left.len())?;
        for (&k, motion) in left.iter().zip(&motions) {
            if let Ok(Asked { body, seen, start, ask, .. }) = motion
                && knows(body, ask)
            {
                if !go_on() {
                    return Ok(());
                }
                let walk = BodyWalk::<N>::of_body(seen, ask, self.job.tol, times, start);
                let found = walk.and_then(|walk| Box::new(walk).run(go_on)).map(|mut found| {
                    found.complete_known_errors(self.job.tol);
                    if !self.job.errors {
                        found.motion.error = f64::NAN;
                    }
                    (*body, found)
                });
                self.put_result(out, k, found)?;
                continue;
            }
            walked.push((k, motion));
            for &tol in tols {
                let walk = motion.as_ref().map_err(|e| *e).and_then(|motion| {
                    let Asked { seen, start, ask, tilted, .. } = motion;
                    let times = tilted.as_ref().map_or(times, |(.., since)| since);
                    let in_lanes = wide
                        && !poses(N)
                        && !self.starts.has_row(self.first + k)
                        && can_roll_in_lanes(&ask.table);
                    let walk = BodyWalk::of_body(seen, ask, tol, times, start)?;
                    Ok(walk.leaving_rolling_to_caller(in_lanes))
                });
                all.walks.push(walk);
            }
        }
        for i in 0..all.walks.len() {
            if !go_on() {
                return Ok(());
            }
            all.continue_walk(i, Ok(Pause::No), go_on);
        }
        loop {
            if !go_on() {
                return Ok(());
            }
            let Some(i) = all.queues.iter().position(|(_, queue)| !queue.is_empty()) else {
                // On a slope no walk waits for the first integrals, which know none.
                if const { poses(N) } || all.rolls.is_empty() {
                    break;
                }
                self.roll_phases_in_lanes(level, &mut all, go_on)?;
                continue;
            };
            match level {
                #[cfg(lanes_of_sixteen)]
                Some(Level::Avx512(simd)) => self.side_by_side(zero(simd), i, &mut all, go_on),
                #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), lanes_of_eight))]
                Some(Level::Avx2(simd)) => self.side_by_side(zero(simd), i, &mut all, go_on),
                #[cfg(all(target_arch = "aarch64", lanes_of_eight))]
                Some(Level::Neon(simd)) => self.side_by_side(zero(simd), i, &mut all, go_on),
                _ => return Ok(()),
            }
        }
        let mut walks = all.walks.into_iter();
        for (k, motion) in walked {
            let Some(fine) = walks.next() else { return Ok(()) };
            let rough = if self.job.errors { walks.next() } else { None };
            // The error estimate needs both runs; if the second run fails, a single motion has no result
            // either.
            let both = fine.and_then(BodyWalk::done).and_then(|mut found| {
                match rough {
                    Some(rough) => found.judge(&rough.and_then(BodyWalk::done)?, self.job.tol)?,
                    None => found.motion.error = f64::NAN,
                }
                let Asked { body, tilted, .. } = motion.as_ref().map_err(|e| *e)?;
                Ok((
                    *body,
                    match tilted {
                        Some((slope, start, _)) => slope.motion(found, start, times),
                        None => found,
                    },
                ))
            });
            self.put_result(out, k, both)?;
        }
        Ok(())
    }

    /// Writes the results of motion `i` of the block, or the ending that says why it has none; an error if the memory
    /// does not suffice.
    pub(super) fn put_result(
        &self,
        out: &mut MotionOutput<'_>,
        i: usize,
        found: Result<(Body, Followed), Error>,
    ) -> Result<(), Error> {
        let times = self.job.times;
        match found {
            Ok((body, found)) => put(out, i, (&body, &found), times),
            Err(e @ Error::Memory { .. }) => return Err(e),
            Err(Error::Painleve { .. }) => out.blank(i, times.len(), Ending::Painleve),
            Err(_) => out.refuse(i, times.len()),
        }
        Ok(())
    }

    /// Computes all tasks of a queue side by side in SIMD lanes.
    fn side_by_side<T: SideBySide, const N: usize>(
        &self,
        like: T,
        queue: usize,
        all: &mut Walks<'_, N>,
        go_on: &mut dyn FnMut() -> bool,
    ) {
        // Motions whose variables include a pose are those on slopes.
        match all.queues[queue].0 {
            FlowKind::Slips { dry } => {
                let law = Slips::new(like, dry);
                if const { poses(N) } {
                    lanes::<_, _, 11, _, N>(like, queue, law, all, go_on);
                } else {
                    lanes::<_, _, 8, _, N>(like, queue, law, all, go_on);
                }
            }
            FlowKind::Lossy(kind) => {
                let law = LossyLanes::new(like, kind);
                if const { poses(N) } {
                    lanes::<_, _, 9, _, N>(like, queue, law, all, go_on);
                } else {
                    lanes::<_, _, 6, _, N>(like, queue, law, all, go_on);
                }
            }
        }
    }
}
