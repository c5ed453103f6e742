//! The first margin that fails within a step.
//!
//! ```text
//! long step   halved until its parts are short, unless cubics through both ends and three stages show that
//!             all margins stay positive
//! CLOSELY     a short step is halved, too, where a margin varies by as much as its value, until each margin
//!             is a cubic that falls once or has one minimum
//! zero        by Newton's iteration if the margin only falls, else from its values at quarters of the step
//! ```
//! A part of a step is computed as a separate step, so that a zero has the accuracy of the step. With
//! `CLOSELY`, a margin that fails only for a moment within a step is found at any tolerance. A minimum that
//! is positive but small is reported to the flow ([`Flow::grazed`]). Error: that of the steps.

use super::{Flow, FlowPlace};
use crate::methods::radau;
use crate::methods::rk8::{self, Stages};
use crate::methods::search::{crossing, least};
use crate::numbers::Dual;
use core::cell::RefCell;

/// A step that is longer than this share of the longest one that rotation and nutation allow is searched for a margin
/// that falls and rises once more within it.
const LONG_STEP_SHARE: f64 = 0.1;
/// Number of parts of a step at whose ends a margin that may fail within the step is evaluated.
const PARTS_OF_STEP: usize = 4;
/// Largest number of halvings of a part of a step that is short already.
const HALVINGS: u32 = 10;
/// A margin counts as the cubic through both ends of a part of a step if it differs from that cubic in the middle by
/// less than this share of its variation. A larger share would miss zeros, a smaller one would halve more steps.
const CUBIC_DEVIATION: f64 = 0.02;
const MARGIN_ROUNDING: f64 = 1e-15;

/// A margin that rises from zero at the start of a step and falls within this share of the step has not risen.
const LEAST_RISE: f64 = 1e-15;

/// The behaviour of the margins within a step.
enum Outlook {
    /// All margins stay positive within the step.
    Clear,
    /// Each margin stays positive or falls through zero once.
    Falls,
    /// A margin may become negative and then positive within the step.
    Unsure,
}

/// The functions that a search for an end within a step uses: at a share of the step they give all margins with their
/// rates in sigma, or one margin alone, or they call [`Flow::grazed`]. After `goes_on_from` a share of the step for
/// which `middle` has given the margins, further parts of the step begin at this share. Few steps are searched, so that
/// the search is compiled once for all flows.
struct StepParts<'a, const M: usize> {
    margins: &'a dyn Fn(f64) -> [Dual<f64>; M],
    margin: &'a dyn Fn(f64, usize) -> f64,
    grazed: &'a dyn Fn(f64, usize, f64),
    middle: &'a dyn Fn(f64) -> [Dual<f64>; M],
    goes_on_from: &'a dyn Fn(f64),
    closely: bool,
    /// The length of the step in sigma.
    h: f64,
}

/// The margins at both ends of a step, and their rates in sigma.
type Sides<'a, const M: usize> = (&'a [Dual<f64>; M], &'a [Dual<f64>; M]);

/// The first margin that falls to zero within a step of `h` from a place, and its zero as a share of the step. `calms`
/// is the longest time step that rotation and nutation allow, divided by the time of this step.
pub(super) fn first_failing_margin<F: Flow<M>, const M: usize, const N: usize>(
    flow: &F,
    (from, h): (&FlowPlace<N>, f64),
    stages: &Stages<f64, N>,
    calms: f64,
    both: Sides<'_, M>,
) -> Option<(f64, usize)> {
    let long = LONG_STEP_SHARE * calms;
    // A margin that rises from zero, as after an event that a flow passes, may still be negative in the
    // middle.
    let closely = F::CLOSELY && both.0.iter().all(|margin| margin.value > 0.0);
    let inside = !F::ONLY_ENDS && (long < 1.0 || closely);
    if M == 0 || inside && long >= 1.0 && !(0..M).any(|i| is_near(both.0[i], both.1[i], h)) {
        return None;
    }
    let outlook = match () {
        () if inside => outlook(flow, (from, h), stages, both),
        () if (0..M).any(|i| may_fail(both.0[i], both.1[i], h)) => Outlook::Falls,
        () => Outlook::Clear,
    };
    if let Outlook::Clear = outlook {
        return None;
    }
    let (begin, middles) = (RefCell::new((0.0, *from)), RefCell::new(Vec::new()));
    let at = |x: f64| {
        let (past, from) = &*begin.borrow();
        flow.part(from, (x - past) * h)
    };
    let parts = StepParts {
        margins: &|x| flow.margins_at(&flow.place(at(x))),
        margin: &|x, i| flow.margin(&at(x), i),
        grazed: &|x, i, least| flow.grazed(&at(x), i, least),
        middle: &|x| {
            let place = flow.place(at(x));
            let margins = flow.margins_at(&place);
            middles.borrow_mut().push((x, place));
            margins
        },
        goes_on_from: &|x| {
            if let Some(middle) = middles.borrow().iter().rev().find(|(share, _)| *share == x) {
                *begin.borrow_mut() = *middle;
            }
        },
        closely: F::CLOSELY,
        h,
    };
    match outlook {
        Outlook::Unsure => {
            parts.failure_by_halving([0.0, 1.0], (h * long.max(LONG_STEP_SHARE), HALVINGS), both)
        }
        _ => parts.failure_by_cubics([0.0, 1.0], both),
    }
}

/// An estimate of the variation of a margin within a step of `h`, from its values and slopes at both ends.
fn variation(a: Dual<f64>, b: Dual<f64>, h: f64) -> f64 {
    (b.value - a.value).abs() + h * (a.slope.abs() + b.slope.abs())
}

/// Whether a margin has a minimum between two places, by its slopes there.
fn is_least(a: Dual<f64>, b: Dual<f64>) -> bool {
    a.slope < 0.0 && b.slope >= 0.0
}

/// Whether a margin falls to zero, or dips below it, in a part of length `h`, by the cubic through both ends.
fn may_fail(a: Dual<f64>, b: Dual<f64>, h: f64) -> bool {
    let dips = || is_least(a, b) && lower_bound(a, b, h) <= 0.0;
    b.value.is_nan() || b.value <= 0.0 || dips()
}

/// Whether the variation of a margin is as large as the smaller of its values at the ends, or NaN.
fn is_near(a: Dual<f64>, b: Dual<f64>, h: f64) -> bool {
    let left = a.value.min(b.value) - variation(a, b, h);
    left.is_nan() || left <= 0.0
}

/// The points of a step at three of its stages, each with its time as a share of the step.
#[inline(always)]
pub(crate) fn looks<F: Flow<M>, const M: usize, const N: usize>(
    (from, h): (&FlowPlace<N>, f64),
    stages: &Stages<f64, N>,
) -> [(f64, FlowPlace<N>); 3] {
    let at = |y: [f64; N], rate: [f64; N]| FlowPlace { y, carry: [0.0; N], rate };
    // An explicit step begins with the rates at its start, an implicit one with changes.
    if F::MAY_BE_STIFF && stages[0] != from.rate {
        return [1, 2, 3].map(|i| {
            let y = core::array::from_fn(|n| from.y[n] + stages[i][n]);
            (radau::PLACES[i], at(y, stages[radau::RADAU_STAGES + i]))
        });
    }
    rk8::LOOKS.map(|(stage, share)| (share, at(rk8::place(stage, &from.y, h, stages), stages[stage])))
}

/// The behaviour of the margins within a step, by the cubics through both ends and three of its stages. A margin counts
/// as positive only if it would be positive even with a dip twice as deep as that of the cubics.
#[cfg_attr(short_code, inline(never))]
fn outlook<F: Flow<M>, const M: usize, const N: usize>(
    flow: &F,
    (from, h): (&FlowPlace<N>, f64),
    stages: &Stages<f64, N>,
    (before, after): Sides<'_, M>,
) -> Outlook {
    let (mut left, mut share, mut fallen, mut place) = (*before, 0.0, [false; M], from.y);
    let looks = looks::<F, M, N>((from, h), stages).map(|(at, place)| (at, Some(place)));
    for (at, look) in looks.into_iter().chain([(1.0, None)]) {
        let last = place;
        let here = look.map_or(*after, |look| {
            place = look.y;
            flow.margins_at(&look)
        });
        for i in 0..M {
            let (a, b) = (left[i], here[i]);
            if !fallen[i] && lower_bound(a, b, 2.0 * (at - share) * h) > 0.0 {
                if is_least(a, b) {
                    flow.grazed(&last, i, lower_bound(a, b, (at - share) * h));
                }
                continue;
            }
            let falls = a.value > 0.0 && a.slope < 0.0 && b.slope < 0.0;
            if !(b.value < 0.0 && (fallen[i] || falls)) {
                return Outlook::Unsure;
            }
            fallen[i] = true;
        }
        (left, share) = (here, at);
    }
    if fallen.contains(&true) { Outlook::Falls } else { Outlook::Clear }
}

impl<const M: usize> StepParts<'_, M> {
    /// The first margin that falls to zero within a part of the step. The part is halved until its parts are at most
    /// `long`; these are halved up to `halvings` times, until no margin is `Unresolved`.
    fn failure_by_halving(
        &self,
        [from, to]: [f64; 2],
        (long, halvings): (f64, u32),
        (before, after): Sides<'_, M>,
    ) -> Option<(f64, usize)> {
        let h = (to - from) * self.h;
        if h <= long {
            if !self.closely {
                return self.failure_by_cubics([from, to], (before, after));
            }
            if !(0..M).any(|i| is_near(before[i], after[i], h)) {
                return None;
            }
        }
        let middle = 0.5 * (from + to);
        let between = (self.middle)(middle);
        let bends = || (0..M).map(|i| shape_of_part(before[i], between[i], after[i], h).0);
        if h <= long {
            if bends().all(|bend| bend == MarginShape::Clear) {
                for i in (0..M).filter(|i| is_least(before[*i], after[*i])) {
                    (self.grazed)(middle, i, shape_of_part(before[i], between[i], after[i], h).1);
                }
                return None;
            }
            if halvings == 0 || bends().all(|bend| bend != MarginShape::Unresolved) {
                return self.failure_by_cubics([from, to], (before, after));
            }
        }
        let left = (long, if h <= long { halvings - 1 } else { halvings });
        let early = self.failure_by_halving([from, middle], left, (before, &between));
        early.or_else(|| {
            (self.goes_on_from)(middle);
            self.failure_by_halving([middle, to], left, (&between, after))
        })
    }

    /// The first margin that falls to zero within a part of the step, by the cubics through both ends.
    fn failure_by_cubics(&self, [from, to]: [f64; 2], (before, after): Sides<'_, M>) -> Option<(f64, usize)> {
        let (mut first, h): (Option<(f64, usize)>, f64) = (None, (to - from) * self.h);
        let share = |x: f64| from + x * (to - from);
        for i in 0..M {
            let (a, b) = (before[i], after[i]);
            if !may_fail(a, b, h) {
                continue;
            }
            let steadily = || {
                let on = |x: f64| {
                    let margin = (self.margins)(share(x))[i];
                    Dual { slope: h * margin.slope, ..margin }
                };
                only_zero(&mut { on }, [a.value, h * a.slope, b.value, h * b.slope])
            };
            let found = if b.value < 0.0 && b.slope < 0.0 && a.value > 0.0 { steadily() } else { None };
            let found =
                found.map_or_else(|| first_zero(&|x| (self.margin)(share(x), i), a.value, b.value), Ok);
            match found {
                Err((x, least)) => (self.grazed)(share(x), i, least),
                Ok(x) if first.is_none_or(|(earlier, _)| share(x) < earlier) => first = Some((share(x), i)),
                Ok(_) => {}
            }
        }
        first
    }
}

/// The shape of a margin within a part of a step.
#[derive(Clone, Copy, PartialEq)]
enum MarginShape {
    /// The margin stays positive.
    Clear,
    /// The margin falls through zero once, or has one minimum, as its cubic does.
    LikeCubic,
    Unresolved,
}

/// The shape of a margin in a part of length `h`, from its values and slopes at the ends and in the middle; and a lower
/// bound of the margin, which is used where the margin is clear.
fn shape_of_part(a: Dual<f64>, middle: Dual<f64>, b: Dual<f64>, h: f64) -> (MarginShape, f64) {
    let (rise, last, change) = (h * a.slope, h * b.slope, b.value - a.value);
    let (p, q) = (3.0 * change - 2.0 * rise - last, rise + last - 2.0 * change);
    let cubic = |x: f64| a.value + x * (rise + x * (p + x * q));
    let off = (cubic(0.5) - middle.value).abs();
    // The slope of the cubic is rise + 2 p x + 3 q x^2.
    let root = p * p - 3.0 * q * rise;
    let far = -(p + root.max(0.0).sqrt().copysign(p));
    let extrema =
        [far / (3.0 * q), rise / far].map(|x| if root > 0.0 && 0.0 < x && x < 1.0 { x } else { 0.0 });
    let lowest = extrema.map(cubic).into_iter().fold(a.value.min(b.value), f64::min);
    let low = lowest - 4.0 * off;
    if low > 0.0 {
        return (MarginShape::Clear, low);
    }
    let count = extrema.into_iter().filter(|x| *x > 0.0).count();
    let once = count == 0 || count == 1 && !(a.slope < 0.0 && b.slope < 0.0);
    // Halving the part does not help if the difference is NaN or a rounding error.
    let cubic = off.is_nan() || off <= CUBIC_DEVIATION * variation(a, b, h) + MARGIN_ROUNDING;
    (if cubic && (once || off.is_nan()) { MarginShape::LikeCubic } else { MarginShape::Unresolved }, low)
}

/// A lower bound of a margin between the ends of a step of `h`, as far as the margin is the cubic through
/// both ends: each slope lowers that cubic by at most 4/27 of `h` times the slope.
fn lower_bound(a: Dual<f64>, b: Dual<f64>, h: f64) -> f64 {
    let least = a.value.min(b.value);
    if !is_least(a, b) {
        return least;
    }
    let cubic = 0.5 * (a.value + b.value) + 0.125 * h * (a.slope - b.slope);
    cubic.min(least - 0.15 * h * (b.slope - a.slope))
}

/// The zero within [0, 1] of a margin that falls through zero once, by Newton's iteration from the zero of
/// the cubic with the values and slopes of the margin at both ends. That cubic is almost exact, and an
/// iteration that moves by less than `NEAR` leaves an error of the square of that. None if the iteration
/// leaves [0, 1] or does not converge.
pub(super) fn only_zero(
    on: &mut dyn FnMut(f64) -> Dual<f64>,
    [begin, rise, end, last]: [f64; 4],
) -> Option<f64> {
    const NEAR: f64 = 1e-8;
    let (square, cube) = (3.0 * (end - begin) - 2.0 * rise - last, 2.0 * (begin - end) + rise + last);
    let cubic = |x: f64| begin + x * (rise + x * (square + x * cube));
    let mut x = crossing(cubic, 0.0, 1.0, begin, end);
    for _ in 0..8 {
        let margin = on(x);
        let next = x - margin.value / margin.slope;
        if !(0.0..=1.0).contains(&next) {
            return None;
        }
        if (next - x).abs() < NEAR {
            return Some(next);
        }
        x = next;
    }
    None
}

/// The zero of a margin that rises from zero at the start and has fallen to `value` at `x`; the start if the margin
/// does not rise.
fn zero_before(on: &dyn Fn(f64) -> f64, mut x: f64, mut value: f64) -> f64 {
    while x > LEAST_RISE {
        let before = on(0.5 * x);
        if before > 0.0 {
            return crossing(on, 0.5 * x, x, before, value);
        }
        (x, value) = (0.5 * x, before);
    }
    0.0
}

/// The first zero within [0, 1] of a margin that may fail in this interval, from its values at both ends;
/// without a zero, the place of its minimum and the minimum.
fn first_zero(on: &dyn Fn(f64) -> f64, begin: f64, end: f64) -> Result<f64, (f64, f64)> {
    let mut values = [begin; PARTS_OF_STEP + 1];
    for k in 1..=PARTS_OF_STEP {
        let x = k as f64 / PARTS_OF_STEP as f64;
        values[k] = if k == PARTS_OF_STEP { end } else { on(x) };
        if values[k] <= 0.0 {
            let from = (k - 1) as f64 / PARTS_OF_STEP as f64;
            if k == 1 && begin <= 0.0 {
                return Ok(zero_before(on, x, values[1]));
            }
            return Ok(crossing(on, from, x, values[k - 1].max(f64::MIN_POSITIVE), values[k]));
        }
    }
    // The margin has its minimum around the lowest of these places.
    let low = (0..=PARTS_OF_STEP).min_by(|i, j| values[*i].total_cmp(&values[*j])).unwrap_or(0);
    let [from, to] = [low.saturating_sub(1), (low + 1).min(PARTS_OF_STEP)];
    let (x, value) = least(on, from as f64 / PARTS_OF_STEP as f64, to as f64 / PARTS_OF_STEP as f64);
    let fails = value < 0.0;
    if fails {
        Ok(crossing(on, from as f64 / PARTS_OF_STEP as f64, x, values[from], value))
    } else {
        Err((x, value))
    }
}
