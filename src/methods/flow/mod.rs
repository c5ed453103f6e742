//! The integration of a flow, that is, of a system of differential equations: steps of eighth order within a tolerance,
//! outputs at any time, and ends.
//!
//! ```text
//! y' = f(y)   in a variable sigma of the flow's own, dt/dsigma > 0; the time t is one of the numbers
//! zeros of margins, also within a step, and states at requested times are computed on parts of a step
//! ```
//! [`rk8`] takes the steps. A [`Flow`] is a system of equations with margins that must stay positive, and
//! [`ends`] locates the first zero of a margin. [`lanes`] takes the steps of many flows at a time, and
//! [`schedule`] fills those lanes. Error: that of the steps.

mod ends;
#[cfg(feature = "many")]
pub(crate) mod lanes;
mod place;
#[cfg(feature = "many")]
pub(crate) mod schedule;
mod stiff;

pub(crate) use ends::looks;
pub(crate) use place::{Exhausted, FlowPlace, Flown, Spent, Steps, TakenStep};
use stiff::{STABLE, StiffSteps};

use super::radau;
use super::rk8::{self, growth, plus};
use crate::error::Error;
use crate::numbers::{COMPILES_AVX2, Dual, here, in_registers};

/// The shortest step relative to the elapsed time: rounding would swallow the advance by a shorter one.
pub(crate) const SHORTEST: f64 = 1e-14;
/// Time that is added to the elapsed time for the comparison with `SHORTEST`, since changes right after the start may be fast.
pub(crate) const SOON: f64 = 1e-9;
/// Rate of the fall of a face, relative to its inclination, beyond which the first step is not shortened further.
pub(crate) const FASTEST: f64 = 1e15;
/// A step crawls, that is, hardly advances, if it is shorter than this share of the longest step that rotation and
/// nutation allow.
pub(crate) const SLOW: f64 = 0.01;
/// A step also crawls if time advances by less than this share of the longest step that rotation and nutation allow.
pub(crate) const CRAWLING_TIME_SHARE: f64 = 1e-6;
/// Largest error of the part of a step up to an event, in units of the allowed error. The error is large
/// beyond a singularity, where the event is not real and the step is repeated; rounding errors near the table
/// are smaller.
const ROUNDED: f64 = 100.0;
/// Largest number of crawling steps of one motion, unless its caller allows more evaluations.
pub(crate) const PATIENCE: u64 = 600_000;
/// Largest number of evaluations of the rates in one motion; a long motion may take `TOIL_PER_TIME` for each unit of time.
pub(crate) const TOIL: u64 = 8_000_000;
const TOIL_PER_TIME: f64 = 40_000.0;
/// Whether the stages form a loop in parts of steps, and on processors without AVX2; this shortens the compilation.
const PARTS_IN_LOOPS: bool = rk8::LOOPS || COMPILES_AVX2;
/// Ratio of the error of the variables right after an implicit step to the error that remains: the error of the fast
/// variables decays in the next step.
const ERROR_AFTER_IMPLICIT_STEP: f64 = 20.0;
/// A part of an implicit step is divided into at most 2 to this power smaller parts.
const MOST_HALVINGS: i32 = 8;
/// The longest part of a step in which an output is sought, and the largest number of parts that are tried for it.
const LONGEST_PART: f64 = 1.1;
const MOST_PARTS_TRIED: u32 = 100;
/// Largest share of the time up to a halt at which an output is written, if the halt is extrapolated: the slip is not
/// zero before its end.
const LATEST_OUTPUT_SHARE: f64 = 1.0 - f64::EPSILON;
/// Number of crawling steps between two calls of [`Flow::stuck`].
const STEPS_BETWEEN_STUCK_TESTS: u64 = 20_000;

/// Largest number of evaluations of the rates in a motion over the time `span`.
pub(crate) fn toil_of(span: f64) -> u64 {
    TOIL.max((TOIL_PER_TIME * span) as u64)
}

/// Number of crawling steps before the next call of [`Flow::stuck`]; `patience` is the number that is left.
pub(crate) fn steps_to_stuck_test(patience: u64) -> u64 {
    patience - patience.saturating_sub(1) / STEPS_BETWEEN_STUCK_TESTS * STEPS_BETWEEN_STUCK_TESTS
}

/// A system of differential equations with M margins, and the ends of its flow.
pub(crate) trait Flow<const M: usize>: Copy {
    /// The reasons for which this flow halts.
    type Halt: Copy + PartialEq;
    /// The index of the time among the variables of the flow.
    const TIME: usize;
    /// The halt at the last of the requested times.
    const OVER: Self::Halt;
    /// The halt after the allowed number of steps, from which the flow can continue.
    const PAUSE: Self::Halt;
    /// Number of steps between two calls of `go_on`, with which a caller can stop the flow.
    const BREATH: u64 = 256;
    /// The halt of a flow that is [`Exhausted`].
    const ENDLESS: Self::Halt = Self::PAUSE;
    /// Whether the stages of all steps form a loop: for rates so slow that the loop costs little in comparison.
    const LOOPS: bool = rk8::LOOPS;
    /// Whether the rates take so long that the call of a function costs little in comparison. They are then compiled
    /// once, and not at each place where they are needed.
    const CALLS: bool = false;
    /// Writes the rates of change of all variables, in the variable sigma of the flow.
    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]);
    /// The margins, each with its rate of change in sigma; the flow ends where one of them falls to zero.
    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; M];
    /// The margin with the index `i`, from the variables `y`.
    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64;
    /// The halt of a flow whose margin `i` falls to zero.
    fn end(&self, i: usize) -> Self::Halt;
    /// The error of a step from the variables `y`, in units of the allowed error.
    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64;
    /// The speed to which the error of a step is relative: the largest speed, at least 1.
    fn fastest<const N: usize>(&self, y: &[f64; N]) -> f64;
    /// The number of ordinary steps that one step costs, if it crawls.
    fn effort(&self) -> u64 {
        1
    }
    /// The length of a first step that is short enough; the next steps grow fast.
    fn first<const N: usize>(&self, y: &[f64; N]) -> f64;
    /// The longest time step that rotation and nutation allow at the variables `y`.
    fn calm<const N: usize>(&self, y: &[f64; N]) -> f64;
    /// The shortest step in sigma from a point: a flow with a shorter step is stuck.
    fn shortest<const N: usize>(&self, y: &[f64; N]) -> f64 {
        SHORTEST * (SOON + y[Self::TIME])
    }
    /// The longest step in sigma that is allowed from a point.
    fn longest<const N: usize>(&self, place: &FlowPlace<N>) -> f64;
    /// The halt of a flow that ends at this point for a reason other than a margin, and the variables at the halt,
    /// which may lie a little later; else None.
    fn stopped<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(Self::Halt, [f64; N])>;
    /// The halt of a flow whose steps become too short or crawl; None where the reason is unknown.
    fn stuck<const N: usize>(&self, _: &FlowPlace<N>, _: &[Dual<f64>; M]) -> Option<Self::Halt> {
        None
    }
    /// The rate, in time, at which a speed falls that vanishes at this halt; infinite for other halts.
    fn slows<const N: usize>(&self, _: Self::Halt, _: &FlowPlace<N>) -> f64 {
        f64::INFINITY
    }
    /// Whether the variables at a halt are extrapolated linearly, since a slip vanishes there. An output at exactly the
    /// time of such a halt belongs to the phase of the motion that follows, as the force of a slip that has vanished
    /// has no direction.
    fn is_extrapolated(_: Self::Halt) -> bool {
        false
    }
    /// Whether the path to an extrapolated halt is a parabola that begins at the rates of the last point.
    fn is_curved(_: Self::Halt) -> bool {
        false
    }
    /// The variables of the output, from those of this flow.
    fn shown<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        *y
    }
    /// Moves the variables after a step back to the surface on which a conserved quantity has its value; rounding and
    /// step errors lead away from it.
    #[inline(always)]
    fn kept<const N: usize>(&self, y: [f64; N]) -> [f64; N] {
        y
    }
    /// Whether [`Flow::passed`] is called after each step.
    const LOOKS_ON: bool = false;
    /// Whether [`Flow::is_stiff`] is called before each step.
    const MAY_BE_STIFF: bool = false;
    /// Whether some variables follow the others so fast from this point on that explicit steps longer than
    /// [`Flow::stable`] are not stable. Longer steps are implicit, as long as they cost less.
    fn is_stiff<const N: usize>(&self, _: &FlowPlace<N>) -> bool {
        false
    }
    /// The longest stable explicit step in sigma from a point where the flow is stiff.
    fn stable<const N: usize>(&self, _: &FlowPlace<N>) -> f64 {
        STABLE
    }
    /// A step of [`radau`] and its stages, by an iteration that begins with the changes `guess` of the variables.
    fn implicit_step<const N: usize>(
        &self,
        _: &FlowPlace<N>,
        _: f64,
        _: radau::Guess<N>,
    ) -> (rk8::Step<f64, N>, radau::Collocated<N>) {
        unreachable!("only a stiff flow takes implicit steps")
    }
    /// Whether a part of a step is implicit, also if it is short: the error of a part is not tested, and an explicit
    /// step that is hardly stable has a large error.
    #[inline(always)]
    fn is_implicit<const N: usize>(&self, from: &FlowPlace<N>) -> bool {
        Self::MAY_BE_STIFF && self.is_stiff(from)
    }
    /// Called for each step that is taken, with the step, the length in sigma of the part that is used, and the point
    /// at the end of this part. The part ends where the flow ends; if that is at the last requested time, the length is
    /// that of the whole step.
    #[inline(always)]
    fn passed<const N: usize>(&self, _: TakenStep<'_, N>, _: f64, _: &FlowPlace<N>) {}
    /// Whether only the end of the flow is requested and none of its steps is long: then the flow needs less code.
    const ONLY_ENDS: bool = false;
    /// Whether short steps are also searched for margins that are negative only for a moment.
    const CLOSELY: bool = false;
    /// Called with a point within a step near which margin `i` has a minimum, and with that minimum, which is
    /// positive and less than the variation of the margin in the step.
    fn grazed<const N: usize>(&self, _: &[f64; N], _: usize, _: f64) {}
    /// For a step so long that an event within it may be missed, the share of the step with which it is repeated; else None.
    #[inline(always)]
    fn passes_unseen<const N: usize>(&self, _: &[f64; N], _: &[f64; N]) -> Option<f64> {
        None
    }
    /// The inclination for the error message of an exhausted flow.
    fn theta<const N: usize>(&self, y: &[f64; N]) -> f64;

    /// Writes the rates of change in a function that is compiled once.
    #[inline(never)]
    fn call_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        in_registers!(self.write_rates(y, all));
    }

    #[inline(always)]
    fn rates<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        let mut all = *y;
        self.call_rates(y, &mut all);
        all
    }

    /// The margins; in WebAssembly a single copy of this function, since small code is more important for pages than
    /// fast code.
    #[cfg_attr(short_code, inline(never))]
    fn margins_at<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; M] {
        self.margins(place)
    }

    /// One step of the flow, explicit or implicit; LOOP says whether the stages of an explicit step form a loop.
    #[inline(always)]
    fn step<const LOOP: bool, const N: usize>(
        &self,
        from: &FlowPlace<N>,
        h: f64,
        stages: &mut rk8::Stages<f64, N>,
    ) -> rk8::Step<f64, N> {
        if self.is_implicit(from) {
            let (made, at) = self.implicit_step(from, h, None);
            stages[..radau::RADAU_STAGES].copy_from_slice(&at.moved);
            stages[radau::RADAU_STAGES..2 * radau::RADAU_STAGES].copy_from_slice(&at.rates);
            return made;
        }
        self.explicit_step::<LOOP, N>(from, h, stages)
    }

    /// A step of [`rk8`]; in WebAssembly there is a single copy of this function.
    #[cfg_attr(short_code, inline(never))]
    #[cfg_attr(not(short_code), inline(always))]
    fn explicit_step<const LOOP: bool, const N: usize>(
        &self,
        from: &FlowPlace<N>,
        h: f64,
        stages: &mut rk8::Stages<f64, N>,
    ) -> rk8::Step<f64, N> {
        let rates = here(
            #[inline(always)]
            |y: &[f64; N], rate: &mut [f64; N]| {
                if LOOP || Self::CALLS { self.call_rates(y, rate) } else { self.write_rates(y, rate) }
            },
        );
        if LOOP || Self::LOOPS {
            rk8::step::<true, _, _>(rates, &from.y, &from.rate, h, stages)
        } else {
            rk8::step::<false, _, _>(rates, &from.y, &from.rate, h, stages)
        }
    }

    /// The point of the flow with the variables `y`, from which it can start.
    fn place<const N: usize>(&self, y: [f64; N]) -> FlowPlace<N> {
        FlowPlace { y, carry: [0.0; N], rate: self.rates(&y) }
    }

    /// A part of length `h` of a step from a point, and the variables after it.
    #[inline(always)]
    fn parted<const LOOP: bool, const N: usize>(
        &self,
        from: &FlowPlace<N>,
        h: f64,
    ) -> (rk8::Step<f64, N>, [f64; N]) {
        let made = self.step::<LOOP, N>(from, h, &mut [from.rate; rk8::STAGES]);
        let y = plus(&from.y, &from.carry, &made.change).0;
        (made, y)
    }

    /// The variables after a part of length `h` of a step from a point.
    fn part<const N: usize>(&self, from: &FlowPlace<N>, h: f64) -> [f64; N] {
        let y = self.part_at_once(from, h);
        if Self::MAY_BE_STIFF && y[0].is_nan() {
            // Newton's iteration has not converged, as it may in shorter parts.
            return self.part_in_parts(from, h);
        }
        y
    }

    #[inline(never)]
    fn part_at_once<const N: usize>(&self, from: &FlowPlace<N>, h: f64) -> [f64; N] {
        in_registers!(
            self.parted::<{ rk8::LOOPS }, N>(from, h).1,
            else self.parted::<PARTS_IN_LOOPS, N>(from, h).1
        )
    }

    #[inline(never)]
    fn part_in_parts<const N: usize>(&self, from: &FlowPlace<N>, h: f64) -> [f64; N] {
        let mut y = [f64::NAN; N];
        for count in (1..=MOST_HALVINGS).map(|k| 1 << k) {
            let mut place = *from;
            for _ in 0..count {
                y = self.part_at_once(&place, h / f64::from(count));
                if y[0].is_nan() {
                    break;
                }
                place = self.place(y);
            }
            if !y[0].is_nan() {
                break;
            }
        }
        y
    }

    /// The variables at time `t` within a step of `h` that ends at `after`. Newton's iteration on parts of the step
    /// finds them, or bisection where Newton's iteration leaves the parts between which the time lies; NaN if no part
    /// comes near enough to the time. An implicit part may be a little late at the end of the step.
    fn at_time<const N: usize>(&self, from: &FlowPlace<N>, after: &FlowPlace<N>, h: f64, t: f64) -> [f64; N] {
        let span = after.y[Self::TIME] - from.y[Self::TIME];
        let near = (1e-9 * span).max(f64::EPSILON * t.abs());
        let (mut low, mut high, mut before) = (0.0, LONGEST_PART, f64::INFINITY);
        let mut x = ((t - from.y[Self::TIME]) / span).clamp(0.0, 1.0);
        for _ in 0..MOST_PARTS_TRIED {
            let y = self.part(from, x * h);
            let rate = self.rates(&y);
            let left = t - y[Self::TIME];
            if left.abs() <= near {
                // Where a motion comes to rest its time may stand still.
                let late = if left == 0.0 || rate[Self::TIME] == 0.0 { 0.0 } else { left / rate[Self::TIME] };
                return core::array::from_fn(|i| y[i] + late * rate[i]);
            }
            // A part that is NaN is too long.
            if left > 0.0 {
                low = x;
            } else {
                high = x;
            }
            let newton = x + left / (rate[Self::TIME] * h);
            let pays = low < newton && newton < high && left.abs() < 0.5 * before;
            x = if pays { newton } else { 0.5 * (low + high) };
            before = left.abs();
        }
        [f64::NAN; N]
    }

    /// Writes the variables at those of the `times` that are not after `until`, within a step of `h` between two
    /// points, and returns the number of those times; `last` gets the variables at the last of them. Between the end of
    /// the step and a halt after it the variables are linear in time, or a parabola.
    #[inline(always)]
    fn write_times<const N: usize>(
        &self,
        (from, after, h): (&FlowPlace<N>, &FlowPlace<N>, f64),
        stop: Option<&(Self::Halt, [f64; N])>,
        (times, until): (&[f64], f64),
        last: &mut [f64; N],
        write: &mut dyn FnMut(&[f64; N]),
    ) -> usize {
        let mut count = 0;
        while let Some(t) = times.get(count).copied().filter(|t| *t <= until) {
            if stop.is_some_and(|(halt, y)| Self::is_extrapolated(*halt) && t == y[Self::TIME]) {
                break;
            }
            *last = match stop.filter(|_| t > after.y[Self::TIME]) {
                Some((halt, y)) => {
                    let (begin, end) = (after.y[Self::TIME], y[Self::TIME]);
                    // Rounding must not make a slip vanish before its end.
                    let share = ((t - begin) / (end - begin)).min(LATEST_OUTPUT_SHARE);
                    let left = if Self::is_curved(*halt) { share * (1.0 - share) } else { 0.0 };
                    let lasts = (end - begin) / after.rate[Self::TIME];
                    core::array::from_fn(|i| {
                        let moves = y[i] - after.y[i];
                        after.y[i] + share * moves + left * (lasts * after.rate[i] - moves)
                    })
                }
                None => self.at_time(from, after, h, t),
            };
            last[Self::TIME] = t;
            write(&self.shown(last));
            count += 1;
        }
        count
    }

    /// Computes the flow from a point, up to its halt, to the last of the `times`, or to a pause after the allowed
    /// number of steps. `write` receives the variables at each of the `times` that is reached. A flow that exceeds its
    /// limits of work or of precision, or that `go_on` interrupts, ends at the present point ([`Spent::exhausted`]).
    fn run<const N: usize>(
        &self,
        here: FlowPlace<N>,
        steps: Steps,
        times: &[f64],
        write: &mut dyn FnMut(&[f64; N]),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Flown<Self::Halt, N> {
        // Compiled for AVX2 where the processor has it: several numbers in a register, and the same bits.
        in_registers!(
            self.run_here::<{ rk8::LOOPS }, N>(here, steps, times, write, go_on),
            else self.run_here::<PARTS_IN_LOOPS, N>(here, steps, times, write, go_on)
        )
    }

    /// Computes the flow as [`Flow::run`] does. An exhausted flow gives an error, and an interrupted one None.
    fn run_whole<const N: usize>(
        &self,
        here: FlowPlace<N>,
        steps: Steps,
        times: &[f64],
        write: &mut dyn FnMut(&[f64; N]),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Flown<Self::Halt, N>>, Error> {
        let flown = self.run(here, steps, times, write, go_on);
        let (theta, time) = (self.theta(&flown.y), flown.y[Self::TIME]);
        match flown.spent.exhausted {
            None => Ok(Some(flown)),
            Some(Exhausted::Interrupted) => Ok(None),
            Some(Exhausted::Rounding) => Err(Error::Lost { theta }),
            Some(_) => Err(Error::Endless { theta, time }),
        }
    }

    #[inline(always)]
    fn run_here<const LOOP: bool, const N: usize>(
        &self,
        mut here: FlowPlace<N>,
        Steps { first, most, patience, toil, mut tired }: Steps,
        times: &[f64],
        write: &mut dyn FnMut(&[f64; N]),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Flown<Self::Halt, N> {
        let end = times.last().copied().unwrap_or(here.y[Self::TIME]);
        let mut next = times.partition_point(|t| *t < here.y[Self::TIME]);
        let mut margins = self.margins_at(&here);
        let mut h = first.unwrap_or_else(|| self.first(&here.y));
        let (mut calm, mut frozen) = (self.calm(&here.y), false);
        let (mut spent, mut last) = (Spent { evaluations: 1, erred: 0.0, patience, exhausted: None }, here.y);
        let (mut stages, mut steep) = ([here.rate; rk8::STAGES], f64::INFINITY);
        let mut ways = StiffSteps::default();
        for steps in 1u64.. {
            let over = if next == times.len() {
                Some((Self::OVER, last))
            } else if steps > most {
                Some((Self::PAUSE, here.y))
            } else {
                None
            };
            if let Some((halt, y)) = over {
                return Flown { halt, y: self.shown(&y), step: h, steep, spent };
            }
            let crawls = h < SLOW * calm || frozen;
            spent.exhausted = if steps.is_multiple_of(Self::BREATH) && !go_on() {
                Some(Exhausted::Interrupted)
            } else if spent.evaluations > toil {
                Some(Exhausted::Evaluations)
            } else if crawls && spent.patience < self.effort() {
                Some(Exhausted::Crawling)
            } else {
                None
            };
            if spent.exhausted.is_some() {
                return Flown { halt: Self::ENDLESS, y: self.shown(&here.y), step: h, steep, spent };
            }
            if crawls {
                let left = spent.patience - self.effort();
                tired = tired
                    || left.div_ceil(STEPS_BETWEEN_STUCK_TESTS)
                        != spent.patience.div_ceil(STEPS_BETWEEN_STUCK_TESTS);
                spent.patience = left;
            }
            if tired && let Some(halt) = self.stuck(&here, &margins) {
                return Flown { halt, y: self.shown(&here.y), step: h, steep, spent };
            }
            tired = false;
            let stable =
                if Self::MAY_BE_STIFF && self.is_stiff(&here) { self.stable(&here) } else { f64::INFINITY };
            let implicit = ways.next_is_implicit(&mut h, stable, || self.longest(&here));
            let made = if implicit {
                let (made, at) = self.implicit_step(&here, h, radau::goes_on(&ways.last, h));
                stages[..radau::RADAU_STAGES].copy_from_slice(&at.moved);
                stages[radau::RADAU_STAGES..2 * radau::RADAU_STAGES].copy_from_slice(&at.rates);
                spent.evaluations += at.evaluations;
                made
            } else {
                spent.evaluations += rk8::STAGES as u64;
                self.explicit_step::<LOOP, N>(&here, h, &mut stages)
            };
            let error = self.error(&here.y, &made);
            let (y, carry) = plus(&here.y, &here.carry, &made.change);
            let y = self.kept(y);
            let after = FlowPlace { y, carry, rate: self.rates(&y) };
            let unseen = self.passes_unseen(&here.y, &y);
            if error.is_nan() || error > 1.0 || unseen.is_some() || after.rate.iter().any(|x| x.is_nan()) {
                let tried = h;
                h *= growth(error).min(unseen.unwrap_or(0.7));
                if implicit {
                    ways.note_failure(tried, !error.is_nan(), &mut h, stable);
                }
                // A step that is NaN counts as too short.
                if h.is_nan() || here.y.iter().any(|x| x.is_nan()) || h < self.shortest(&here.y) {
                    let halt = self.stuck(&here, &margins).unwrap_or_else(|| {
                        spent.exhausted = Some(Exhausted::Rounding);
                        Self::ENDLESS
                    });
                    return Flown { halt, y: self.shown(&here.y), step: h, steep, spent };
                }
                continue;
            }
            let ahead = self.margins_at(&after);
            let calms = calm / (after.y[Self::TIME] - here.y[Self::TIME]);
            let failure = ends::first_failing_margin(self, (&here, h), &stages, calms, (&margins, &ahead));
            let mut length = h;
            let stop = match failure {
                Some((x, i)) => {
                    length = x * h;
                    // Beyond a singularity the failure is not real, as a large error of this part shows.
                    let (part, y) = self.parted::<PARTS_IN_LOOPS, N>(&here, length);
                    let off = self.error(&here.y, &part);
                    if (off.is_nan() || off > ROUNDED) && length > self.shortest(&here.y) {
                        h *= 0.5 * x;
                        continue;
                    }
                    let there = self.place(y);
                    steep = (self.margins_at(&there)[i].slope / there.rate[Self::TIME]).abs();
                    Some((self.end(i), there.y))
                }
                None => self.stopped(&after).inspect(|(halt, _)| steep = self.slows(*halt, &after)),
            };
            spent.erred +=
                if implicit { ERROR_AFTER_IMPLICIT_STEP } else { 1.0 } * error * self.fastest(&here.y);
            let until = stop.as_ref().map_or(after.y[Self::TIME], |(_, y)| y[Self::TIME]);
            let step = (&here, &after, h);
            if !Self::ONLY_ENDS {
                next += self.write_times(step, stop.as_ref(), (&times[next..], until), &mut last, write);
            }
            if Self::LOOKS_ON {
                let taken = (&here, h, &stages);
                match stop {
                    Some((_, y)) if y[Self::TIME] <= end => self.passed(taken, length, &self.place(y)),
                    _ if after.y[Self::TIME] > end => self.passed(taken, h, &self.place(last)),
                    _ => self.passed(taken, h, &after),
                }
            }
            if let Some((halt, y)) = stop.filter(|(_, y)| y[Self::TIME] <= end) {
                return Flown { halt, y: self.shown(&y), step: h, steep, spent };
            }
            if Self::MAY_BE_STIFF {
                ways.last = None;
                if implicit {
                    ways.note_success((core::array::from_fn(|i| stages[i]), h));
                }
            }
            frozen = after.y[Self::TIME] - here.y[Self::TIME] <= CRAWLING_TIME_SHARE * calm;
            (here, margins) = (after, ahead);
            calm = self.calm(&here.y);
            h = (h * growth(error)).min(self.longest(&here));
        }
        unreachable!("steps go on until something ends them")
    }
}

#[cfg(test)]
mod tests;
