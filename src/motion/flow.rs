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
use fearless_simd::Simd;

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
const PATIENCE: u64 = 256;
/// A step this short, beside the time that has passed, leads nowhere.
const SHORTEST: f64 = 1e-14;

/// A place on the way: numbers, what rounding took of them, how they change.
#[derive(Clone, Copy)]
pub(crate) struct Place<const N: usize> {
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
    pub evaluations: u64,
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
    fn margins<const N: usize>(&self, place: &Place<N>) -> [Dual<f64>; MARGINS];
    /// The margin `i` of some numbers.
    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64;
    /// What it means that the margin `i` fails.
    fn end(&self, i: usize) -> Halt;
    /// What a step errs by, where 1 is allowed.
    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64;
    /// A first step that is short enough, since the next ones grow fast.
    fn first<const N: usize>(&self, y: &[f64; N]) -> f64;
    /// The longest step from a place.
    fn longest<const N: usize>(&self, place: &Place<N>) -> f64;
    /// What ends the flow here, and the numbers then, a little further on.
    fn stopped<const N: usize>(&self, place: &Place<N>) -> Option<(Halt, [f64; N])>;
    /// What it means that steps become too short; None where nobody knows.
    fn stuck<const N: usize>(&self, place: &Place<N>, margins: &[Dual<f64>; MARGINS]) -> Option<Halt>;
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
    fn step<const N: usize>(&self, from: &Place<N>, h: f64) -> rk8::Step<f64, N> {
        rk8::step(
            #[inline(always)]
            |y: &[f64; N], rate: &mut [f64; N]| self.write_rates(y, rate),
            &from.y,
            &from.rate,
            h,
        )
    }

    /// A place to start from.
    fn place<const N: usize>(&self, y: [f64; N]) -> Place<N> {
        Place { y, carry: [0.0; N], rate: self.rates(&y) }
    }

    /// After a part of a step of `h` from a place.
    fn part<const N: usize>(&self, from: &Place<N>, h: f64) -> [f64; N] {
        let made = self.step(from, h);
        plus(&from.y, &from.carry, &made.change).0
    }

    /// The first margin that fails within a step of `h`, as a share of it; its end's margins are known.
    fn failure<const N: usize>(
        &self,
        from: &Place<N>,
        h: f64,
        (before, after): (&[Dual<f64>; MARGINS], &[Dual<f64>; MARGINS]),
    ) -> Option<(f64, Halt)> {
        let mut first: Option<(f64, Halt)> = None;
        for i in 0..MARGINS {
            let (a, b) = (before[i], after[i]);
            let on = |x: f64| self.margin(&self.part(from, x * h), i);
            let fails = if b.value <= 0.0 {
                Some((1.0, b.value))
            } else if a.slope < 0.0 && b.slope > 0.0 {
                // as low as a cubic through both ends, or a line along either slope, can be
                let low = (0.5 * (a.value + b.value) + 0.125 * h * (a.slope - b.slope))
                    .min(a.value.min(b.value) - 0.15 * h * (b.slope - a.slope));
                if low > 0.0 { None } else { Some(least(on, 0.0, 1.0)).filter(|(_, m)| *m < 0.0) }
            } else {
                None
            };
            if let Some((x, value)) = fails {
                let x = crossing(on, 0.0, x, a.value.max(f64::MIN_POSITIVE), value);
                if first.is_none_or(|(earlier, _)| x < earlier) {
                    first = Some((x, self.end(i)));
                }
            }
        }
        first
    }

    /// The numbers at time `t` within a step of `h` that ends at `after`: Newton's iteration on parts of the step.
    fn at_time<const N: usize>(&self, from: &Place<N>, after: &Place<N>, h: f64, t: f64) -> [f64; N] {
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
        here: Place<N>,
        (first_step, most): (Option<f64>, u64),
        times: &[f64],
        write: &mut dyn FnMut(&[f64; N]),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Flown<N>>, Error> {
        // the widest registers take several numbers at a time; the bits are the same
        fearless_simd::dispatch!(crate::number::level(), simd => simd.vectorize(
            #[inline(always)]
            || self.run_here(here, (first_step, most), times, write, go_on),
        ))
    }

    #[inline(always)]
    fn run_here<const N: usize>(
        &self,
        mut here: Place<N>,
        (first_step, most): (Option<f64>, u64),
        times: &[f64],
        write: &mut dyn FnMut(&[f64; N]),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Flown<N>>, Error> {
        let end = times.last().copied().unwrap_or(here.y[7]);
        let mut next = times.partition_point(|t| *t < here.y[7]);
        let mut margins = self.margins(&here);
        let mut h = first_step.unwrap_or_else(|| self.first(&here.y));
        let (mut evaluations, mut last) = (1, here.y);
        for steps in 1u64.. {
            if steps.is_multiple_of(PATIENCE) && !go_on() {
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
                return Ok(Some(Flown { halt, y: self.shown(&y), step: h, evaluations }));
            }
            let made = self.step(&here, h);
            evaluations += 12;
            let error = self.error(&here.y, &made);
            let (y, carry) = plus(&here.y, &here.carry, &made.change);
            let after = Place { y, carry, rate: self.rates(&y) };
            if error.is_nan() || error > 1.0 || after.rate.iter().any(|x| x.is_nan()) {
                h *= growth(error).min(0.7);
                if h < SHORTEST * (1.0 + here.y[7]) {
                    let Some(halt) = self.stuck(&here, &margins) else {
                        return Err(Error::Lost { theta: here.y[0].atan2(here.y[1]) });
                    };
                    return Ok(Some(Flown { halt, y: self.shown(&here.y), step: h, evaluations }));
                }
                continue;
            }
            let ahead = self.margins(&after);
            let failure = self.failure(&here, h, (&margins, &ahead));
            let stop = match failure {
                Some((x, halt)) => Some((halt, self.part(&here, x * h))),
                None => self.stopped(&after),
            };
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
                return Ok(Some(Flown { halt, y: self.shown(&y), step: h, evaluations }));
            }
            (here, margins) = (after, ahead);
            h = (h * growth(error)).min(self.longest(&here));
        }
        unreachable!("steps go on until something ends them")
    }
}
