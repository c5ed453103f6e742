//! Flows in SIMD lanes: each lane takes its own steps, as long as no event can lie within them.
//!
//! ```text
//! sure   every margin m_i is positive at the start, at three stages and at the end of a step; between two of
//!        these, where m_i may have a minimum, the extended chords of the intervals on both sides meet above
//!        zero; and the step ends before the next requested time
//! ```
//! A lane does not take a step in which an event is possible; it reports this and keeps its state. Then a single
//! [`Flow`](super::Flow) repeats the step and locates the event within it, so that single flows and lanes share one
//! search for events. The equations are a [`Flows`], and [`schedule`](super::schedule) fills the lanes. The steps of a
//! lane do not depend on the other lanes.

use super::{CRAWLING_TIME_SHARE, SHORTEST, SLOW, SOON, Spent};
use crate::methods::rk8::{self, LOOKS};
use crate::numbers::side_by_side::{MOST, SideBySide, apart};
use crate::numbers::{Real, here};

/// Greatest number of parameters of a system, such as the shape of a body and the forces on it. A system with more
/// parameters does not compile.
pub(crate) const NUMBERS: usize = 32;

/// Equations of motion in SIMD lanes, with N variables, the last of which is the time, and M margins.
pub(crate) trait Flows<T: SideBySide, const N: usize, const M: usize>: Copy {
    /// Intermediate results of the rates, from which the margins follow.
    type Seen;
    /// Whether the stages of a step form a loop: for rates so slow that the loop costs little in comparison.
    const LOOPS: bool = rk8::LOOPS;
    fn of(numbers: &[T; NUMBERS], like: &Self) -> Self;
    fn rates(&self, y: &[T; N], rate: &mut [T; N]) -> Self::Seen;
    /// The margins, functions of the variables; while all are positive no event happens.
    fn margins(&self, y: &[T; N], seen: &Self::Seen) -> [T; M];
    /// The error of a step divided by the allowed error.
    fn error(&self, tol: T, y: &[T; N], made: &rk8::Step<T, N>) -> T;
    /// Moves the variables after a step back to the surface on which a conserved quantity has its value; rounding and
    /// step errors lead away from it.
    #[inline(always)]
    fn kept(&self, y: [T; N]) -> [T; N] {
        y
    }
    /// The speed to which the error of a step is relative: the largest speed, at least 1.
    fn fastest(&self, y: &[T; N]) -> T;
    /// The longest time step that rotation and nutation allow at a place.
    fn calm(&self, y: &[T; N]) -> T;
    /// The shortest step from a place: a SIMD lane whose next step would be shorter is stuck.
    #[inline(always)]
    fn shortest(&self, y: &[T; N]) -> T {
        (y[0].splat(SOON) + y[N - 1]) * y[0].splat(SHORTEST)
    }
    /// The longest time step that is allowed from a place.
    fn longest(&self, y: &[T; N], rate: &[T; N]) -> T;
}

/// The initial data of a flow in a SIMD lane.
pub(crate) struct Entry<const N: usize, const M: usize> {
    pub y: [f64; N],
    pub step: f64,
    pub numbers: [f64; NUMBERS],
    pub tol: f64,
    pub until: f64,
    /// Number of crawling steps, which hardly advance the time, that the flow may take.
    pub patience: u64,
    /// Number of evaluations from which the lane counts, in addition to those that it makes ([`evaluations_before_limit`]).
    pub made: u64,
}

/// The status of a SIMD lane after a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum LaneStatus {
    /// The lane can take its next step.
    Runs,
    /// The next step may cross a margin, or the lane is stuck: a single [`Flow`](super::Flow) must take some steps.
    NeedsSingle,
    /// The next step reaches the requested time and crosses no margin: a single [`Flow`](super::Flow) must take this step.
    TimeReached,
}

// The status as a number in a lane, 0 in a running lane.
const NEEDS_SINGLE: f64 = 1.0;
const TIME_REACHED: f64 = 2.0;

/// A SIMD lane stops after this number of evaluations of its rates, so that the limit of the whole motion can be checked.
const TOIL_IN_LANES: f64 = 1e6;

/// The number from which a lane counts evaluations, so that it stops after `toil` evaluations.
pub(crate) fn evaluations_before_limit(toil: u64) -> u64 {
    (TOIL_IN_LANES as u64).saturating_sub(toil)
}

/// The progress of the motions in their SIMD lanes.
#[derive(Clone, Copy)]
struct LaneProgress<T, const N: usize, const M: usize> {
    y: [T; N],
    /// The rounding errors of the variables, which are added in the next step.
    carry: [T; N],
    h: T,
    /// The margins at a place before the current one, and the distance back to that place.
    before: [T; M],
    back: T,
    /// Number of crawling steps, which hardly advance the time, that are left.
    patience: T,
    /// Number of evaluations of the rates so far.
    made: T,
    /// The sum of the estimated errors of all steps, in units of the tolerance.
    erred: T,
}

impl<T: Copy, const N: usize, const M: usize> LaneProgress<T, N, M> {
    /// Calls `f` for all data of the lanes, one vector after the other.
    fn each(&mut self, mut f: impl FnMut(&mut T)) {
        let Self { y, carry, h, before, back, patience, made, erred } = self;
        y.iter_mut().chain(carry).chain(before).chain([h, back, patience, made, erred]).for_each(&mut f);
    }
}

/// Selects `yes` where the number `mask` is positive, elsewhere `no`.
#[inline(always)]
fn select_positive<T: SideBySide>(mask: T, yes: T, no: T) -> T {
    mask.splat(0.0).select_lt(mask, yes, no)
}

/// In a new lane, margins are extrapolated to an earlier place, at this share of the first step before the start.
const EARLIER_PLACE_SHARE: f64 = 0.03;
/// Each of two chords is made steeper by this share of the difference of their slopes, as a reserve. Without this
/// reserve a margin that bends unevenly could dip below zero unseen; a larger share stops more lanes than necessary.
const CHORD_RESERVE: f64 = 0.25;

/// 1 where all margins stay positive in a step, else 0, also where one is NaN. `places` are the margins
/// `back` steps before the start, at the start, at the stages [`LOOKS`] and at the end. Between two places a
/// convex margin lies above the extended chords of the intervals on both sides. These are made steeper
/// (`CHORD_RESERVE`), since a margin is not convex everywhere. In the last interval only the chord on the left is
/// known.
#[inline(always)]
fn margins_stay_positive<T: Real, const M: usize>(places: [&[T; M]; LOOKS.len() + 3], back: T) -> T {
    let (zero, one) = (back.splat(0.0), back.splat(1.0));
    let mut ends = [0.0; LOOKS.len() + 2];
    for (end, (_, share)) in ends[1..].iter_mut().zip(LOOKS) {
        *end = share;
    }
    ends[LOOKS.len() + 1] = 1.0;
    let mut sure = one;
    let short = one / back;
    for i in 0..M {
        let mut margin = [one; LOOKS.len() + 3];
        for (margin, place) in margin.iter_mut().zip(places) {
            *margin = place[i];
        }
        for margin in &margin[1..] {
            sure = zero.select_lt(*margin, sure, zero);
        }
        let mut slopes = [short * (margin[1] - margin[0]); LOOKS.len() + 2];
        for k in 1..slopes.len() {
            slopes[k] = (margin[k + 1] - margin[k]) * one.splat(1.0 / (ends[k] - ends[k - 1]));
        }
        for k in 1..slopes.len() {
            let (long, here) = (one.splat(ends[k] - ends[k - 1]), slopes[k]);
            let fall = zero - here.min(slopes[k - 1]);
            let above = match slopes.get(k + 1) {
                Some(next) => {
                    let rise = here.max(*next);
                    let more = one.splat(CHORD_RESERVE) * (fall + rise);
                    let (down, up) = (fall + more, rise + more);
                    let above = up * margin[k] + down * margin[k + 1] - down * up * long;
                    zero.select_lt(rise, above, one)
                }
                None => margin[k] - fall * long,
            };
            let above = zero.select_lt(fall, above, one);
            sure = zero.select_lt(above, sure, zero);
        }
    }
    sure
}

/// A set of motions, one in each SIMD lane, and the steps that they take.
pub(crate) struct Set<T, L, const N: usize, const M: usize> {
    law: L,
    tol: T,
    until: T,
    way: LaneProgress<T, N, M>,
    rate: [T; N],
    /// The margins at the current place of each motion.
    margins: [T; M],
    status: T,
    /// 0 in a SIMD lane that has a motion, else 1.
    idle: T,
    rows: Vec<[f64; MOST]>,
}

impl<T: SideBySide, L: Flows<T, N, M>, const N: usize, const M: usize> Set<T, L, N, M> {
    /// A set with the initial data `entry` in all SIMD lanes.
    pub fn new(zero: T, law: L, entry: &Entry<N, M>) -> Self {
        let (y, before) = ([zero; N], [zero; M]);
        let way = LaneProgress {
            y,
            carry: y,
            h: zero,
            before,
            back: zero,
            patience: zero,
            made: zero,
            erred: zero,
        };
        let rows = vec![[0.0; MOST]; 2 * N + M + 5 + NUMBERS + 2];
        let (tol, until, status, idle) = (zero, zero, zero, zero);
        let (rate, margins) = ([zero; N], [zero; M]);
        let mut set = Self { law, tol, until, way, rate, margins, status, idle, rows };
        (0..T::COUNT).for_each(|k| set.fill(k, entry));
        set.load_rows(zero);
        set
    }

    /// Puts a motion with its initial data into SIMD lane `k` of the rows.
    pub fn fill(&mut self, k: usize, entry: &Entry<N, M>) {
        let mut way = LaneProgress {
            y: entry.y,
            carry: [0.0; N],
            h: entry.step,
            // `settle` computes a place before the start.
            before: [0.0; M],
            back: 0.0,
            patience: entry.patience as f64,
            made: 1.0 + entry.made as f64,
            erred: 0.0,
        };
        let mut row = 0;
        let mut put = |x: f64| {
            self.rows[row][k] = x;
            row += 1;
        };
        way.each(|x| put(*x));
        entry.numbers.into_iter().chain([entry.tol, entry.until]).for_each(put);
    }

    /// Writes the progress of all SIMD lanes into the rows, so that single lanes can be filled anew.
    pub fn store_rows(&mut self) {
        let (mut row, rows) = (0, &mut self.rows);
        self.way.each(|x| {
            (0..T::COUNT).for_each(|k| rows[row][k] = x.lane(k));
            row += 1;
        });
    }

    /// Loads the data of all SIMD lanes from the rows, after some lanes were filled.
    pub fn load_rows(&mut self, zero: T) {
        let (mut row, rows) = (0, &self.rows);
        let mut next = || {
            row += 1;
            zero.load(&rows[row - 1])
        };
        self.way.each(|x| *x = next());
        let mut numbers = [zero; NUMBERS];
        numbers.iter_mut().for_each(|x| *x = next());
        (self.tol, self.until) = (next(), next());
        let (law, mut way) = (self.law, self.way);
        (self.law, self.way, self.rate, self.margins) = apart(
            zero,
            #[inline(always)]
            || {
                let law = L::of(&numbers, &law);
                let mut rate = way.y;
                let seen = law.rates(&way.y, &mut rate);
                let margins = law.margins(&way.y, &seen);
                // A lane that starts gets an earlier place on a straight line along its rates.
                let fresh = way.h * zero.splat(EARLIER_PLACE_SHARE);
                let mut y = way.y;
                for i in 0..N {
                    y[i] = way.y[i] - fresh * rate[i];
                }
                let mut unused = y;
                let seen = law.rates(&y, &mut unused);
                let earlier = law.margins(&y, &seen);
                for (before, earlier) in way.before.iter_mut().zip(earlier) {
                    *before = select_positive(way.back, *before, earlier);
                }
                way.back = select_positive(way.back, way.back, fresh);
                (law, way, rate, margins)
            },
        );
        self.status = zero;
    }

    /// Marks the SIMD lanes without a motion as idle.
    pub fn mark_idle_lanes(&mut self, zero: T, idle: &[f64; MOST]) {
        self.idle = zero.load(idle);
        self.status = zero.splat(0.5).select_lt(self.idle, zero, self.status);
    }

    /// The status of SIMD lane `k` after its last step.
    pub fn status(&self, k: usize) -> LaneStatus {
        let status = self.status.lane(k);
        if status == NEEDS_SINGLE {
            LaneStatus::NeedsSingle
        } else if status == TIME_REACHED {
            LaneStatus::TimeReached
        } else {
            LaneStatus::Runs
        }
    }

    /// The variables of SIMD lane `k`, and the length of its next step.
    pub fn place(&self, k: usize) -> ([f64; N], f64) {
        (self.way.y.map(|x| x.lane(k)), self.way.h.lane(k))
    }

    /// The cost of lane `k` so far: the number of evaluations, the sum of the step errors, and the number of
    /// crawling steps that are still allowed.
    pub fn spent(&self, k: usize) -> Spent {
        let LaneProgress { made, patience, erred, .. } = &self.way;
        let patience = patience.lane(k).max(0.0) as u64;
        Spent { evaluations: made.lane(k) as u64, erred: erred.lane(k), patience, exhausted: None }
    }

    /// Takes at most `steps` steps in all SIMD lanes, until a lane cannot take its next step.
    pub fn take_steps(&mut self, zero: T, steps: usize) {
        apart(
            zero,
            #[inline(always)]
            || self.goes_on(steps),
        );
    }

    #[inline(always)]
    fn goes_on(&mut self, steps: usize) {
        let (zero, one) = (self.tol.splat(0.0), self.tol.splat(1.0));
        let mut stages = [self.rate; rk8::STAGES];
        // The margins at three stages, which each step writes anew.
        let mut within = [self.margins; LOOKS.len()];
        for _ in 0..steps {
            if (0..T::COUNT).any(|k| self.status.lane(k) > 0.0) {
                return;
            }
            let (law, way) = (&self.law, &self.way);
            let mut stage = 0;
            let rates = here(
                #[inline(always)]
                |y: &[T; N], rate: &mut [T; N]| {
                    let seen = law.rates(y, rate);
                    stage += 1;
                    if let Some(look) = LOOKS.into_iter().position(|(look, _)| look == stage) {
                        within[look] = law.margins(y, &seen);
                    }
                },
            );
            let made = if L::LOOPS {
                rk8::step::<true, _, _>(rates, &way.y, &self.rate, way.h, &mut stages)
            } else {
                rk8::step::<false, _, _>(rates, &way.y, &self.rate, way.h, &mut stages)
            };
            let error = law.error(self.tol, &way.y, &made);
            let (next, carry) = rk8::plus(&way.y, &way.carry, &made.change);
            let next = law.kept(next);
            let mut rate = next;
            let seen = law.rates(&next, &mut rate);
            let margins = law.margins(&next, &seen);
            let [first, second, last] = &within;
            let places = [&way.before, &self.margins, first, second, last, &margins];
            let sure = margins_stay_positive(places, way.back / way.h);
            let good = error.select_lt(one, one, zero);
            let early = next[N - 1].select_lt(self.until, one, zero);
            let takes = good * sure * early;

            // A step that is not taken is repeated, so that the longest step at its end does not matter.
            let grown = way.h * rk8::growth(error);
            let grown = select_positive(takes, law.longest(&next, &rate).min(grown), grown);
            let calm = law.calm(&next);
            let frozen =
                (next[N - 1] - way.y[N - 1]).select_lt(calm * zero.splat(CRAWLING_TIME_SHARE), one, zero);
            let crawls = way.h.select_lt(calm * zero.splat(SLOW), one, frozen);
            let patience = way.patience - crawls;
            let stuck = way.h.select_lt(law.shortest(&way.y), zero.splat(NEEDS_SINGLE), zero);
            let stuck = patience.select_lt(zero, zero.splat(NEEDS_SINGLE), stuck);
            let stuck = zero.splat(TOIL_IN_LANES).select_lt(way.made, zero.splat(NEEDS_SINGLE), stuck);
            let unsure = zero.select_lt(sure, zero.splat(TIME_REACHED), zero.splat(NEEDS_SINGLE));
            let status = zero.select_lt(takes, stuck, zero.select_lt(good, unsure, stuck));
            self.status = zero.splat(0.5).select_lt(self.idle, zero, status);

            let erred = error.mac(law.fastest(&way.y), way.erred);
            let way = &mut self.way;
            way.erred = select_positive(takes, erred, way.erred);
            // `h` is still the length of this step.
            let since = way.h * zero.splat(1.0 - LOOKS[LOOKS.len() - 1].1);
            way.back = select_positive(takes, since, way.back);
            for i in 0..M {
                way.before[i] = select_positive(takes, last[i], way.before[i]);
                self.margins[i] = select_positive(takes, margins[i], self.margins[i]);
            }
            for i in 0..N {
                way.y[i] = select_positive(takes, next[i], way.y[i]);
                way.carry[i] = select_positive(takes, carry[i], way.carry[i]);
                self.rate[i] = select_positive(takes, rate[i], self.rate[i]);
            }
            // A step in which an event is possible keeps its length for the single flow.
            way.h = zero.select_lt(good - takes, way.h, grown);
            (way.patience, way.made) = (patience, way.made + zero.splat(12.0));
        }
    }
}
