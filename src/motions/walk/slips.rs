//! A slip from rest: by series in time, until an integrator continues the slip, or the slip ends.

use super::numbers::{Halt, TIME};
use super::slow::{SLOW_SLIP, pays};
use super::{MOMENT, Next, Pause, Phases, Walk};
use crate::laws::contact::standstill::towards;
use crate::motions::ask::result::Ending;
use crate::numbers::Series;

/// A slip from rest whose speed grows faster than this does not stay slow: an integrator continues it after its first
/// series.
const SLOW_GROWTH: f64 = 0.02;

/// The series of all numbers along a slow slip. Functions return it in a `Box`, since the stack of the
/// caller may be small.
pub(crate) struct SlowSeries<const N: usize> {
    pub numbers: [Series; N],
    /// The time at which the series starts.
    pub from: f64,
    /// The largest time since the start of the series at which the series may be used.
    pub until: f64,
    /// Whether the slip ends at the time `until`.
    pub ends: bool,
    /// Whether this series takes less work than the steps of an integrator would.
    pub pays: bool,
    /// The time in which a deviation of the direction of the slip falls by a factor e, divided by the speed.
    pub settling: f64,
    /// The angle alpha of the direction of the slip.
    pub angle: Series,
}

impl<const N: usize> SlowSeries<N> {
    /// The state vector at a time `t` since the start of the series.
    pub fn at(&self, t: f64) -> [f64; N] {
        core::array::from_fn(|i| self.numbers[i].value(t))
    }

    /// Whether the series exists. Its coefficients are infinite or NaN where a law takes a root of a quantity
    /// that vanishes at the start.
    fn is_sound(&self) -> bool {
        self.numbers.iter().all(|x| x.at.iter().all(|a| a.is_finite())) && self.until > 0.0
    }
}

/// Number of steps after which the change of a slip's speed is measured: for a slow slip, and for any other slip.
const STEPS_TO_LOOK: [u64; 2] = [24, 240];
/// A power series replaces the integration of a slow slip whose speed changes by a smaller factor than
/// exp(CREEP_CHANGE) in a step: such steps are short only because the direction of the slip follows the motion so
/// fast that longer steps would be unstable.
const CREEP_CHANGE: f64 = 0.15;
/// The change of the slip's speed is measured over fewer than this many steps: the SIMD code tests it after 96.
const RECENT_STEPS: f64 = 110.0;
/// The direction of a slip has settled where its angle from that of the power series, times the speed, is below this
/// share of the tolerance.
const SETTLED_DIRECTION: f64 = 0.5;
/// Cost of the power series of a slip, in evaluations of the rates.
const SERIES_COST: u64 = 100;

/// The last test whether a power series may replace the integration of a slip: the speed, the number of evaluations
/// until then, and how many tests to skip after a failed attempt and before the next one.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Looked {
    speed: f64,
    evaluations: u64,
    skips: [u32; 2],
}

/// After static friction has ceased to hold, a slip under a user-defined law keeps its direction for this share of
/// the time in which the body turns by a radian, or of a unit of time if that is shorter. The error is the cube of
/// this share.
const KEEPS_ITS_WAY: f64 = 1e-5;

/// A power series of a slip is used for at most about this many times as long as the series before it.
const SERIES_DURATION_RATIO: f64 = 2.0;

/// Phases of a motion shorter than this, in sqrt(R/g), may be left out.
const NEGLIGIBLE_PHASE: f64 = 1e-6;

/// The power series of slow slips under the laws of a phase.
pub(crate) trait SlowLaw<const N: usize> {
    /// The power series from the state vector `y`, in a direction near `angle`, with a `speed` that grows at the rate
    /// `growth`. None for a slip that would leave this direction, or is too fast.
    fn follow(&mut self, y: &[f64; N], angle: Series, growth: f64, speed: f64) -> Option<Box<SlowSeries<N>>>;
}

impl<P: Phases<N>, const N: usize> Walk<'_, P, N> {
    /// Computes a slip from rest in the direction `alpha`, whose speed grows at the rate `growth`. Returns the state
    /// vector at which an integrator continues; None if the slip ends before that.
    pub(super) fn slips_off(&mut self, (alpha, growth): (f64, f64)) -> Option<[f64; N]> {
        let way = towards(alpha);
        P::lets_slip(self, way);
        if !P::begins_slowly(self) {
            self.begins_phase(P::slip_kind(self));
            self.made.path.way = way;
            return Some(self.begins_at_once(way, growth));
        }
        let mut slow = self.recorded();
        let Some(series) = slow.follow(&self.at, Series::of(alpha), growth, 0.0) else {
            self.next = Some(Next::Ends(Ending::Painleve));
            return None;
        };
        if series.ends && series.until == 0.0 {
            // The slip ends at once: rolling needs exactly the limit of static friction, which holds the
            // contact point.
            self.next = Some(Next::Rolls { at_limit: true });
            return None;
        }
        self.begins_phase(P::slip_kind(self));
        self.made.path.way = way;
        if !series.is_sound() {
            return Some(self.begins_at_once(way, growth));
        }
        self.follow_series(slow, series, growth < SLOW_GROWTH)
    }

    /// The series of slow slips under the current law.
    fn recorded(&mut self) -> Box<P::Slow> {
        let known = self.slow.take().filter(|slow| P::is_slow(self, slow));
        known.unwrap_or_else(|| Box::new(P::slow(self)))
    }

    /// Records the speed of a slip that begins at the state vector `y`.
    pub(super) fn note_slip(&mut self, y: &[f64; N]) {
        let speed = y[P::SLIP].hypot(y[P::SLIP + 1]);
        self.looked = Looked { speed, evaluations: self.spent.evaluations, skips: [0; 2] };
    }

    /// Number of integration steps from the state vector `y` on up to the next test whether a power series replaces
    /// the integration.
    pub fn steps_to_look(&self, y: &[f64; N]) -> u64 {
        if !P::has_series(self) {
            return u64::MAX;
        }
        STEPS_TO_LOOK[usize::from(y[P::SLIP].hypot(y[P::SLIP + 1]) > SLOW_SLIP)]
    }

    /// Continues a slow slip at the state vector `y` by its power series if the integration steps would remain short
    /// up to its end.
    pub(super) fn continue_by_series(&mut self, y: [f64; N], step: Option<f64>) -> Pause<N> {
        let (speed, spent) = (y[P::SLIP].hypot(y[P::SLIP + 1]), self.spent.evaluations);
        let Looked { speed: before, evaluations, skips: [skips, last] } = self.looked;
        let steps = spent.saturating_sub(evaluations) as f64 / 12.0;
        // Over many steps a slip changes by a small factor a step even if it ends soon.
        let creeps = steps < RECENT_STEPS && (before / speed).ln().abs() < CREEP_CHANGE * steps;
        self.looked = Looked { speed, evaluations: spent, skips: [skips.saturating_sub(1), last] };
        if speed > SLOW_SLIP || !creeps || skips > 0 {
            return Pause::Here(y, step);
        }
        let (mut slow, angle) = (self.recorded(), y[P::SLIP + 1].atan2(y[P::SLIP]));
        let found = slow.follow(&y, Series::of(angle), 0.0, speed);
        self.spent.evaluations += SERIES_COST;
        let fastest = self.of.grows(Halt::LiftOff, &y).unwrap_or(1.0);
        let off =
            |series: &SlowSeries<N>| (series.angle.at[0] - angle).abs() * speed / (fastest * self.of.tol());
        match found.filter(|series| series.is_sound() && series.pays && off(series) < SETTLED_DIRECTION) {
            Some(series) => {
                self.spent.erred += off(&series) * fastest;
                self.at = y;
                match self.follow_series(slow, series, true) {
                    Some(y) => {
                        self.note_slip(&y);
                        Pause::Here(y, None)
                    }
                    None => Pause::No,
                }
            }
            None => {
                self.slow = Some(slow);
                let next = (2 * last).clamp(1, 64);
                self.looked.skips = [next, next];
                Pause::Here(y, step)
            }
        }
    }

    /// Follows a slow slip by its power series, and if `on` is true by further series. Returns the state vector at
    /// which an integrator continues; None if the slip ends before that.
    fn follow_series(
        &mut self,
        mut slow: Box<P::Slow>,
        mut series: Box<SlowSeries<N>>,
        on: bool,
    ) -> Option<[f64; N]> {
        let left = loop {
            self.spent.evaluations += SERIES_COST;
            let clear = P::clear_until(self, &series);
            let whole = clear == series.until;
            let until = clear.min(self.since.last().map_or(0.0, |t| t - series.from));
            while let Some(t) = self.until().filter(|t| *t <= series.from + until) {
                let mut y = series.at(t - series.from);
                y[TIME] = t;
                P::write(self, &y);
            }
            P::passed(self, &series, until);
            let mut y = series.at(until);
            let over = self.until().is_none();
            if over || series.ends && whole {
                if !over {
                    (y[P::SLIP], y[P::SLIP + 1]) = (0.0, 0.0);
                }
                P::slip_halts(self, y, if over { Halt::Time } else { Halt::Standstill });
                break None;
            }
            // The direction of a slow slip returns to its zero of f in a time proportional to the speed, so
            // that an integrator would need tiny steps.
            let speed = y[P::SLIP].hypot(y[P::SLIP + 1]);
            let may_pay = pays(SERIES_DURATION_RATIO * series.until, series.settling * speed);
            let stays_slow = whole && on && may_pay && self.toil() > 0;
            let next = if stays_slow { slow.follow(&y, series.angle.about(until), 0.0, speed) } else { None };
            match next.filter(|next| next.pays) {
                Some(next) => series = next,
                None => break Some(y),
            }
            self.at = y;
        };
        self.slow = Some(slow);
        left
    }

    /// Begins a motion that has no power series, a slip from rest along `way` or rolling from rest, with a straight
    /// line over the time `MOMENT`, and writes the outputs in that time.
    pub fn begins_at_once(&mut self, way: [f64; 2], growth: f64) -> [f64; N] {
        let y = P::nudged(self, way, growth);
        while self.until().is_some_and(|t| t <= y[TIME]) {
            P::write(self, &{ self.at });
        }
        y
    }

    /// Begins a slip from rest under a user-defined law: it keeps its direction for a share of the time `moment`, a
    /// larger share if its speed begins with the rate of growth 0. `slips` returns the state vector after a time.
    pub fn keeps_its_way(&mut self, growth: f64, moment: f64, slips: impl Fn(f64) -> [f64; N]) -> [f64; N] {
        let (from, lasts) = (self.at[TIME], moment * if growth == 0.0 { KEEPS_ITS_WAY } else { MOMENT });
        while let Some(t) = self.until().filter(|t| *t <= from + lasts) {
            P::write(self, &slips(t - from));
        }
        slips(lasts)
    }

    /// Removes a phase that has lasted only for a moment, such as one in which the drilling rate of a patch passes
    /// zero.
    pub fn forgets_a_moment(&mut self, now: f64) {
        if now - self.began < NEGLIGIBLE_PHASE && self.made.path.phases.len() > 1 {
            self.made.path.phases.pop();
            self.resumes = true;
        }
    }
}
