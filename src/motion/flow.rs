//! A flow on its way: steps of eighth order that keep an error, outputs at any time, and what ends it.
//!
//! ```text
//! y = (..., t, heat, ...)   in a variable sigma of the flow's own, dt/dsigma > 0; t is number 7
//! margins that turn negative, within a step too, are found on parts of the step; so is the state at a time that is asked for
//! ```
//! [`rk8`] takes the steps. What flows (a body that slips, one that loses energy) is a [`Flow`]. Error: that of the steps.

use crate::error::Error;
use crate::number::Dual;
use crate::rk8::{self, growth, plus};
use crate::search::{crossing, least};

/// What ends a flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Halt {
    /// The last time is reached.
    Time,
    /// So many steps as were allowed have been made.
    Pause,
    /// The contact point comes to rest on the table.
    Standstill,
    Face,
    Side,
    LiftOff,
    /// There is no unique force.
    Jam,
    /// What rolls needs more friction than there is.
    Slips,
    /// The contact point stops along the rim, or what was held begins to move.
    Contour,
    /// The drilling stops, or begins.
    Drilling,
    /// The rocking of a body that only rocks turns round.
    Rocking,
    /// What resists the contact point in proportion to its speed has all but stopped it.
    Settles,
    /// Nothing moves any more but what drills.
    Rests,
}

/// How many margins a flow has.
pub(crate) const MARGINS: usize = 6;
/// Steps between two looks at whether to go on.
const BREATH: u64 = 256;
/// A step this short, beside the time that has passed, leads nowhere.
pub(crate) const SHORTEST: f64 = 1e-14;
/// What happens sooner than this after the start may be as fast.
pub(crate) const SOON: f64 = 1e-9;
/// What falls faster than this beside its inclination needs no shorter first step.
pub(crate) const FASTEST: f64 = 1e15;
/// A step shorter than this share of the longest that the turning and the nodding allow crawls.
pub(crate) const SLOW: f64 = 0.01;
/// One in which time advances by less than this share of it does so, too.
pub(crate) const FROZEN: f64 = 1e-6;
/// A part of a step may err by so many times what a step may: near the table that is rounding.
const ROUNDED: f64 = 100.0;
/// So many steps of one motion may crawl.
pub(crate) const PATIENCE: u64 = 600_000;
/// So many evaluations may one motion take, and so many for each unit of time that is asked for.
pub(crate) const TOIL: u64 = 8_000_000;
const TOIL_PER_TIME: f64 = 160_000.0;
/// Each time that so many steps have crawled, the flow is asked what that means.
const TIRING: u64 = 20_000;
/// Places within a step at which a margin is looked at that may fail there.
const PARTS: usize = 4;

/// How many evaluations a motion up to a time may take.
pub(crate) fn toil_of(span: f64) -> u64 {
    TOIL.max((TOIL_PER_TIME * span) as u64)
}

/// How many more steps may crawl before the flow is asked again, where so many may crawl at all.
pub(crate) fn until_tired(patience: u64) -> u64 {
    (TIRING - PATIENCE.saturating_sub(patience) % TIRING).min(patience)
}

/// A place on the way: numbers, what rounding took of them, how they change.
#[derive(Clone, Copy)]
pub(crate) struct FlowPlace<const N: usize> {
    pub y: [f64; N],
    pub carry: [f64; N],
    pub rate: [f64; N],
}

/// How it went.
pub(crate) struct Flown<const N: usize> {
    pub halt: Halt,
    /// The numbers where it ended.
    pub y: [f64; N],
    /// The next step.
    pub step: f64,
    /// How fast the margin fell that ended it; infinite where none did.
    pub steep: f64,
    pub spent: Spent,
}

/// What a flow has taken.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spent {
    pub evaluations: u64,
    /// What all steps together may have erred by, by their own estimates.
    pub erred: f64,
    /// How many more steps may crawl.
    pub patience: u64,
}

/// The steps that a flow may make.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Steps {
    /// The first of them, if that is known.
    pub first: Option<f64>,
    /// How many.
    pub most: u64,
    /// And how many that crawl.
    pub patience: u64,
    /// How many evaluations they may take.
    pub toil: u64,
    /// Whether the steps before have crawled.
    pub tired: bool,
}

/// Whether the energy that is lost is among the numbers: the last of them.
pub(crate) const fn loses(count: usize) -> bool {
    count == 10 || count == 14
}

/// Whether the pose is, from number 9 on.
pub(crate) const fn poses(count: usize) -> bool {
    count >= 13
}

/// What flows.
pub(crate) trait Flow: Copy {
    /// How all numbers change with sigma.
    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]);
    /// What must stay positive, and how it changes with sigma.
    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; MARGINS];
    /// The margin `i` of some numbers.
    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64;
    /// What it means that the margin `i` fails.
    fn end(&self, i: usize) -> Halt;
    /// What a step errs by, where 1 is allowed.
    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64;
    /// The speed that this is relative to: the largest of them, at least 1.
    fn fastest<const N: usize>(&self, y: &[f64; N]) -> f64;
    /// As long as how many others a step takes.
    fn effort(&self) -> u64 {
        1
    }
    /// A first step that is short enough, since the next ones grow fast.
    fn first<const N: usize>(&self, y: &[f64; N]) -> f64;
    /// The longest step that the turning and the nodding allow.
    fn calm<const N: usize>(&self, y: &[f64; N]) -> f64;
    /// The longest step from a place.
    fn longest<const N: usize>(&self, place: &FlowPlace<N>) -> f64;
    /// What ends the flow here, and the numbers then, a little further on.
    fn stopped<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(Halt, [f64; N])>;
    /// What it means that steps become too short; None where nobody knows.
    fn stuck<const N: usize>(&self, place: &FlowPlace<N>, margins: &[Dual<f64>; MARGINS]) -> Option<Halt>;
    /// The numbers as others know them: theta's sine and cosine, w, u, t, heat, the pose, what is lost.
    fn shown<const N: usize>(&self, y: &[f64; N]) -> [f64; N];

    #[inline(always)]
    fn rates<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        let mut all = *y;
        self.write_rates(y, &mut all);
        all
    }

    // a page would rather have it once than fast
    #[cfg_attr(target_arch = "wasm32", inline(never))]
    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    fn step<const N: usize>(
        &self,
        from: &FlowPlace<N>,
        h: f64,
        stages: &mut rk8::Stages<f64, N>,
    ) -> rk8::Step<f64, N> {
        rk8::step::<{ rk8::LOOPS }, _, _>(
            #[inline(always)]
            |y: &[f64; N], rate: &mut [f64; N]| self.write_rates(y, rate),
            &from.y,
            &from.rate,
            h,
            stages,
        )
    }

    /// A place to start from.
    fn place<const N: usize>(&self, y: [f64; N]) -> FlowPlace<N> {
        FlowPlace { y, carry: [0.0; N], rate: self.rates(&y) }
    }

    /// After a part of a step of `h` from a place.
    fn part<const N: usize>(&self, from: &FlowPlace<N>, h: f64) -> [f64; N] {
        let made = self.step(from, h, &mut [from.rate; rk8::STAGES]);
        plus(&from.y, &from.carry, &made.change).0
    }

    /// The first margin that fails within a step of `h`, as a share of it; its end's margins are known.
    fn failure<const N: usize>(
        &self,
        from: &FlowPlace<N>,
        h: f64,
        (before, after): (&[Dual<f64>; MARGINS], &[Dual<f64>; MARGINS]),
    ) -> Option<(f64, usize)> {
        let mut first: Option<(f64, usize)> = None;
        for i in 0..MARGINS {
            let (a, b) = (before[i], after[i]);
            let dips = a.slope < 0.0 && b.slope > 0.0 && {
                // as low as a cubic through both ends, or a line along either slope, can be
                let low = (0.5 * (a.value + b.value) + 0.125 * h * (a.slope - b.slope))
                    .min(a.value.min(b.value) - 0.15 * h * (b.slope - a.slope));
                low <= 0.0
            };
            if b.value > 0.0 && !dips {
                continue;
            }
            let on = |x: f64| self.margin(&self.part(from, x * h), i);
            let found = if b.value < 0.0 && b.slope < 0.0 && a.value > 0.0 {
                Some(only_zero(on, [a.value, h * a.slope, b.value, h * b.slope]))
            } else {
                first_zero(on, a.value, b.value)
            };
            if let Some(x) = found
                && first.is_none_or(|(earlier, _)| x < earlier)
            {
                first = Some((x, i));
            }
        }
        first
    }

    /// The numbers at time `t` within a step of `h` that ends at `after`: Newton's iteration on parts of the step.
    fn at_time<const N: usize>(&self, from: &FlowPlace<N>, after: &FlowPlace<N>, h: f64, t: f64) -> [f64; N] {
        let span = after.y[7] - from.y[7];
        let mut x = ((t - from.y[7]) / span).clamp(0.0, 1.0);
        for _ in 0..8 {
            let y = self.part(from, x * h);
            let rate = self.rates(&y);
            let left = t - y[7];
            if left.abs() <= 1e-9 * span || left == 0.0 {
                return core::array::from_fn(|i| y[i] + left / rate[7] * rate[i]);
            }
            x = (x + left / (rate[7] * h)).clamp(0.0, 1.0);
        }
        self.part(from, x * h)
    }

    /// On from a place: `write` is given the numbers at each of the `times` that is reached; then what ends the flow, at the
    /// latest the last of them; or a pause after so many steps. None if it is told to stop.
    fn run<const N: usize>(
        &self,
        here: FlowPlace<N>,
        steps: Steps,
        times: &[f64],
        write: &mut dyn FnMut(&[f64; N]),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Flown<N>>, Error> {
        // the widest registers take several numbers at a time; the bits are the same
        crate::number::in_lanes!(
            crate::number::level(),
            _ => self.run_here(here, steps, times, write, go_on),
            else self.run_here(here, steps, times, write, go_on)
        )
    }

    #[inline(always)]
    fn run_here<const N: usize>(
        &self,
        mut here: FlowPlace<N>,
        Steps { first, most, mut patience, toil, mut tired }: Steps,
        times: &[f64],
        write: &mut dyn FnMut(&[f64; N]),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Flown<N>>, Error> {
        let end = times.last().copied().unwrap_or(here.y[7]);
        let mut next = times.partition_point(|t| *t < here.y[7]);
        let mut margins = self.margins(&here);
        let mut h = first.unwrap_or_else(|| self.first(&here.y));
        let (mut calm, mut frozen) = (self.calm(&here.y), false);
        let (mut evaluations, mut erred, mut last) = (1, 0.0, here.y);
        let (mut stages, mut steep) = ([here.rate; rk8::STAGES], f64::INFINITY);
        for steps in 1u64.. {
            if steps.is_multiple_of(BREATH) && !go_on() {
                return Ok(None);
            }
            let over = if next == times.len() {
                Some((Halt::Time, last))
            } else if steps > most {
                Some((Halt::Pause, here.y))
            } else {
                None
            };
            if let Some((halt, y)) = over {
                let spent = Spent { evaluations, erred, patience };
                return Ok(Some(Flown { halt, y: self.shown(&y), step: h, steep, spent }));
            }
            let endless = Error::Endless { theta: here.y[0].atan2(here.y[1]), time: here.y[7] };
            if evaluations > toil {
                return Err(endless);
            }
            if h < SLOW * calm || frozen {
                let Some(left) = patience.checked_sub(self.effort()) else { return Err(endless) };
                let crawled = |left: u64| PATIENCE.saturating_sub(left) / TIRING;
                tired = tired || crawled(left) != crawled(patience);
                patience = left;
            }
            if tired && let Some(halt) = self.stuck(&here, &margins) {
                let spent = Spent { evaluations, erred, patience };
                return Ok(Some(Flown { halt, y: self.shown(&here.y), step: h, steep, spent }));
            }
            tired = false;
            let made = self.step(&here, h, &mut stages);
            evaluations += 12;
            let error = self.error(&here.y, &made);
            let (y, carry) = plus(&here.y, &here.carry, &made.change);
            let after = FlowPlace { y, carry, rate: self.rates(&y) };
            if error.is_nan() || error > 1.0 || after.rate.iter().any(|x| x.is_nan()) {
                h *= growth(error).min(0.7);
                // what is no number is not long enough either
                if h.is_nan() || here.y.iter().any(|x| x.is_nan()) || h < SHORTEST * (SOON + here.y[7]) {
                    let Some(halt) = self.stuck(&here, &margins) else {
                        return Err(Error::Lost { theta: here.y[0].atan2(here.y[1]) });
                    };
                    let spent = Spent { evaluations, erred, patience };
                    return Ok(Some(Flown { halt, y: self.shown(&here.y), step: h, steep, spent }));
                }
                continue;
            }
            let ahead = self.margins(&after);
            let failure = self.failure(&here, h, (&margins, &ahead));
            let stop = match failure {
                Some((x, i)) => {
                    // a step over what grows without bound is none to where it fails
                    let part = self.step(&here, x * h, &mut stages);
                    let off = self.error(&here.y, &part);
                    if (off.is_nan() || off > ROUNDED) && x * h > SHORTEST * (SOON + here.y[7]) {
                        h *= 0.5 * x;
                        continue;
                    }
                    let there = self.place(plus(&here.y, &here.carry, &part.change).0);
                    steep = (self.margins(&there)[i].slope / there.rate[7]).abs();
                    Some((self.end(i), there.y))
                }
                None => self.stopped(&after),
            };
            erred += error * self.fastest(&here.y);
            let until = stop.as_ref().map_or(after.y[7], |(_, y)| y[7]);
            while next < times.len() && times[next] <= until {
                let t = times[next];
                let stopped =
                    stop.filter(|(halt, y)| *halt == Halt::Standstill && t > after.y[7] && t <= y[7]);
                last = stopped.map_or_else(|| self.at_time(&here, &after, h, t), |(_, y)| y);
                last[7] = t;
                write(&self.shown(&last));
                next += 1;
            }
            if let Some((halt, y)) = stop.filter(|(_, y)| y[7] <= end) {
                let spent = Spent { evaluations, erred, patience };
                return Ok(Some(Flown { halt, y: self.shown(&y), step: h, steep, spent }));
            }
            frozen = after.y[7] - here.y[7] <= FROZEN * calm;
            (here, margins) = (after, ahead);
            calm = self.calm(&here.y);
            h = (h * growth(error)).min(self.longest(&here));
        }
        unreachable!("steps go on until something ends them")
    }
}

/// The zero within [0, 1] of a margin that falls through it once, as far as the cubic tells that has its values and slopes at
/// both ends: that cubic is all but right, and a few looks beside its zero are enough.
fn only_zero(on: impl Fn(f64) -> f64, [begin, rise, end, last]: [f64; 4]) -> f64 {
    let (square, cube) = (3.0 * (end - begin) - 2.0 * rise - last, 2.0 * (begin - end) + rise + last);
    let cubic = |x: f64| begin + x * (rise + x * (square + x * cube));
    let x = crossing(cubic, 0.0, 1.0, begin, end);
    let (value, slope) = (on(x), rise + x * (2.0 * square + x * 3.0 * cube));
    if value == 0.0 {
        return x;
    }
    // twice as far as the slope tells
    let other = (x - 2.0 * value / slope).clamp(0.0, 1.0);
    let (low, high) = (x.min(other), x.max(other));
    let beside = if other == 0.0 {
        begin
    } else if other == 1.0 {
        end
    } else {
        on(other)
    };
    let (at_low, at_high) = if x < other { (value, beside) } else { (beside, value) };
    match (at_low > 0.0, at_high > 0.0) {
        (true, false) => crossing(on, low, high, at_low, at_high),
        (true, true) => crossing(on, high, 1.0, at_high, end),
        _ => crossing(on, 0.0, low, begin, at_low),
    }
}

/// The first zero within [0, 1] of a margin that may fail there, from its values at both ends.
fn first_zero(on: impl Fn(f64) -> f64, begin: f64, end: f64) -> Option<f64> {
    let mut values = [begin; PARTS + 1];
    for k in 1..=PARTS {
        let x = k as f64 / PARTS as f64;
        values[k] = if k == PARTS { end } else { on(x) };
        if values[k] <= 0.0 {
            let from = (k - 1) as f64 / PARTS as f64;
            return Some(crossing(on, from, x, values[k - 1].max(f64::MIN_POSITIVE), values[k]));
        }
    }
    // it is least around the lowest of these places
    let low = (0..=PARTS).min_by(|i, j| values[*i].total_cmp(&values[*j])).unwrap_or(0);
    let [from, to] = [low.saturating_sub(1), (low + 1).min(PARTS)];
    let (x, value) = least(&on, from as f64 / PARTS as f64, to as f64 / PARTS as f64);
    (value < 0.0).then(|| crossing(on, from as f64 / PARTS as f64, x, values[from], value))
}

#[cfg(test)]
mod tests;
