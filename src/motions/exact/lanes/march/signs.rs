//! Finds the first zero of a power series, and whether a zero may have been missed.
//!
//! ```text
//! between two nodes a series differs from the cubic of its values and slopes there by at most |X''''| h^4/384
//! |X''''| <= sum |x_k| k (k-1) (k-2) (k-3) reach^(k-4)
//! ```
//! A part of the panel is flagged where the value at its end is not positive, or where the cubic has a least value
//! anywhere in the part that does not exceed the bound; the first flagged part is examined. A zero is computed by
//! Newton's method from that of a parabola; the series has to fall through zero inside the part. The bottom of a dip
//! is computed: if it is below zero, a zero lies before it; if above, the search continues after it. The zero remains
//! unknown if Newton's method does not reach the bottom, or if the bottom is above zero in a part whose end is below.
//!
//! SIMD lanes are independent: a computation for one lane changes no other lane.

use super::{MORE, PARTS, REACH, WIDTH, here, where_equal};
use crate::numbers::{Lane, Real};

/// Number of dips after which the search for a zero continues; after more dips the zero is unknown.
const MOST_DIPS: usize = 3;
/// Greatest last step of Newton's method to the bottom of a dip; the error of the value is the square of the step.
const REACHED: f64 = 1e-6;
/// A place beyond every panel, which stands for a zero that does not exist.
const NO_ZERO: f64 = 9.0;

/// The first zero of a power series, as far as it is known.
#[derive(Debug, Clone, Copy)]
pub(super) struct FirstZero<T> {
    /// 1 where a zero has been found, else 0.
    pub is_found: T,
    pub at: T,
    /// The error of the zero from Newton's method, and the slope of the series there.
    pub miss: T,
    pub steep: T,
    /// The place from which on a zero may have been missed; 9 if there is no such place.
    pub doubt: T,
}

/// The value and the slope of a power series.
type ValueSlope<T> = (T, T);

pub(super) struct EtaSeries<'a, T, const N: usize> {
    terms: &'a [T; N],
    /// Bound of the error of the cubics between two nodes of the series.
    bound: T,
}

/// The first flagged part: its kind (1 for a zero, 2 for a dip, 0 for none), its start, the value and slope there, the
/// value at its end, and the place of the dip as a fraction of the part.
struct Flag<T> {
    kind: T,
    from: T,
    begin: ValueSlope<T>,
    end: T,
    share: T,
}

impl<'a, T: Lane, const N: usize> EtaSeries<'a, T, N> {
    #[inline(always)]
    pub fn of(terms: &'a [T; N]) -> Self {
        let number = here(
            #[inline(always)]
            |x: f64| terms[0].splat(x),
        );
        let mut fourth = number(0.0);
        let reach = number(REACH);
        for k in (4..N).rev() {
            let weight = number((k * (k - 1) * (k - 2) * (k - 3)) as f64);
            fourth = fourth.fma(reach, weight * terms[k].abs());
        }
        Self { terms, bound: fourth * number(WIDTH * WIDTH * WIDTH * WIDTH / 384.0) }
    }

    /// Values and slopes of the series at M places at once; independent sums hide the latency of the arithmetic.
    #[inline(always)]
    fn at<const M: usize>(&self, x: [T; M]) -> [ValueSlope<T>; M] {
        let zero = x[0].splat(0.0);
        let mut both = [(self.terms[N - 1], zero); M];
        for c in self.terms[..N - 1].iter().rev() {
            for i in 0..M {
                both[i] = (both[i].0.fma(x[i], *c), both[i].1.fma(x[i], both[i].0));
            }
        }
        both
    }

    /// The zeros of F (turning points) ahead and behind, from its even and odd parts.
    #[inline(always)]
    pub fn turns(&self) -> [FirstZero<T>; 2] {
        let terms = self.terms;
        let number = here(
            #[inline(always)]
            |x: f64| terms[0].splat(x),
        );
        let zero = number(0.0);
        let mut ahead = [(terms[0], terms[1]); MORE + 1];
        let mut behind = [(terms[0], zero - terms[1]); MORE + 1];
        for j in 1..=MORE {
            let x = j as f64 * WIDTH;
            let (square, eta) = (number(x * x), number(x));
            let (mut even, mut even_slope, mut odd, mut odd_slope) = (terms[N - 2], zero, terms[N - 1], zero);
            for k in (0..N - 2).step_by(2).rev() {
                even_slope = even_slope.fma(square, even);
                even = even.fma(square, terms[k]);
                odd_slope = odd_slope.fma(square, odd);
                odd = odd.fma(square, terms[k + 1]);
            }
            // With the even and odd parts F = even + eta odd and F' = 2 eta even' + odd + 2 eta^2 odd'.
            let (of_odd, of_even) = ((square + square).fma(odd_slope, odd), (eta + eta) * even_slope);
            ahead[j] = (eta.fma(odd, even), of_even + of_odd);
            behind[j] = ((zero - eta).fma(odd, even), of_odd - of_even);
        }
        let fore = flagged(&ahead, self.bound, zero);
        let back = flagged(&behind, self.bound, zero);
        let width = number(WIDTH);
        let mut x = where_equal(
            fore.kind,
            1.0,
            fore.from + zero_of_parabola(fore.begin, fore.end, width),
            number(0.1),
        );
        let mut x_back = where_equal(
            back.kind,
            1.0,
            zero - (back.from + zero_of_parabola(back.begin, back.end, width)),
            number(-0.1),
        );
        let (mut steps, mut before) = ([zero; 2], [number(1.0); 2]);
        for _ in 0..5 {
            let [(value, slope), (value_back, slope_back)] = self.at([x, x_back]);
            before = steps;
            steps = [
                where_equal(fore.kind, 1.0, value / slope, zero),
                where_equal(back.kind, 1.0, value_back / slope_back, zero),
            ];
            (x, x_back) = (x - steps[0], x_back - steps[1]);
        }
        let seen = here(
            #[inline(always)]
            |of: &Flag<T>, at: T, distance: T, step: T, before: T| {
                let inside = of.lies_within(distance);
                let found = where_equal(of.kind, 1.0, inside, zero);
                // A zero in a flagged part that is not found there is unknown.
                let doubt =
                    zero.select_lt(of.kind, zero.select_lt(found, number(NO_ZERO), of.from), number(NO_ZERO));
                FirstZero { is_found: found, at, miss: newton_error(step, before), steep: number(1.0), doubt }
            },
        );
        [seen(&fore, x, x, steps[0], before[0]), seen(&back, x_back, zero - x_back, steps[1], before[1])]
    }

    /// The first zero of the series ahead, before `limit`.
    #[inline(always)]
    pub fn first(&self, limit: T) -> FirstZero<T> {
        let number = here(
            #[inline(always)]
            |x: f64| limit.splat(x),
        );
        let (zero, one, width) = (number(0.0), number(1.0), number(WIDTH));
        let mut values = [(self.terms[0], self.terms[1]); PARTS + 1];
        for j in (1..=PARTS).step_by(4) {
            let four = self.at([0, 1, 2, 3].map(|i| number((j + i) as f64 * WIDTH)));
            values[j..j + 4].copy_from_slice(&four);
        }
        let mut seen =
            FirstZero { is_found: zero, at: number(NO_ZERO), miss: zero, steep: one, doubt: number(NO_ZERO) };
        let (mut from, mut open) = (zero, one);
        for _ in 0..MOST_DIPS {
            let mut flag = flagged(&values, self.bound, from);
            flag.kind = flag.from.select_lt(limit, zero.select_lt(open, flag.kind, zero), zero);
            let dips = where_equal(flag.kind, 2.0, one, zero);
            let again = dips.any();
            // 1 in `open` marks the lanes in which the search continues.
            open = zero;
            let (mut reach, mut crossing) = (width, zero);
            if again {
                let (bottom, value, step) = zero.aside(
                    #[inline(always)]
                    move || self.minimum_of_dip(dips, flag.from + flag.share * width),
                );
                // The bottom must lie in its part, and the series must not fall below zero behind it.
                let reached = step.abs().select_lt(number(REACHED), flag.lies_within(bottom), zero);
                let alone = value.select_lt(zero, one, zero.select_lt(flag.end, one, zero));
                let sure = zero.select_lt(dips, zero.select_lt(alone, reached, zero), zero);
                seen.doubt = zero.select_lt(dips - sure, flag.from, seen.doubt);
                let dips = sure;
                crossing = zero.select_lt(dips, value.select_lt(zero, one, zero), zero);
                (flag.end, reach) = (
                    zero.select_lt(crossing, value, flag.end),
                    zero.select_lt(crossing, bottom - flag.from, reach),
                );
                flag.kind = zero.select_lt(crossing, one, flag.kind);
                open = zero.select_lt(crossing, zero, dips);
            }
            // Near a double zero the first estimate is that of a parabola about the bottom.
            let near = reach - reach * (flag.end / (flag.end - flag.begin.0)).max(zero).sqrt();
            let first = zero.select_lt(crossing, near, zero_of_parabola(flag.begin, flag.end, reach));
            let met = where_equal(flag.kind, 1.0, one, zero);
            if met.any() {
                let (at, miss, slope) = self.newton(met, zero.select_lt(met, flag.from + first, number(0.1)));
                let inside = flag.lies_within(at);
                // A slope that is tiny compared with the earlier values belongs to an almost double zero, whose place
                // is uncertain.
                let scale = number(1e-3) * (flag.begin.0.abs() + self.bound) / width;
                let falls = slope.select_lt(zero - scale, inside, zero);
                let (hit, lost) = (zero.select_lt(met, falls, zero), zero.select_lt(met, one - falls, zero));
                seen.is_found = zero.select_lt(hit, one, seen.is_found);
                seen.at = zero.select_lt(hit, at, seen.at);
                seen.miss = zero.select_lt(hit, miss, seen.miss);
                seen.steep = zero.select_lt(hit, slope.abs(), seen.steep);
                seen.doubt = zero.select_lt(lost, flag.from, seen.doubt);
            }
            from = flag.from + width;
            if !open.any() {
                break;
            }
        }
        // The zero is unknown in lanes whose search has not ended.
        seen.doubt = zero.select_lt(open, from, seen.doubt);
        seen
    }

    /// The bottom of a dip by Newton's method for the slope, the value there, and the last step.
    #[inline(always)]
    fn minimum_of_dip(&self, dips: T, guess: T) -> (T, T, T) {
        let zero = guess.splat(0.0);
        let (mut x, mut step) = (zero.select_lt(dips, guess, zero), zero);
        for _ in 0..4 {
            let (mut slope, mut bend) = (zero, zero);
            for k in (1..N).rev() {
                bend = bend.fma(x, slope);
                slope = slope.fma(x, self.terms[k] * x.splat(k as f64));
            }
            step = slope / bend;
            x = x - zero.select_lt(dips, step, zero);
        }
        let [(value, _)] = self.at([x]);
        (x, value, step)
    }

    /// A zero by Newton's method, its error, and the slope there. Near a double zero the method converges slowly at
    /// first.
    #[inline(always)]
    fn newton(&self, met: T, guess: T) -> (T, T, T) {
        let (zero, one) = (guess.splat(0.0), guess.splat(1.0));
        let (mut x, mut step, mut before, mut slope) = (guess, zero, one, zero);
        // `far` is 1 in lanes that have not converged; the others stay where they are.
        let mut far = met;
        for _ in 0..2 {
            for _ in 0..3 {
                let [(value, rise)] = self.at([x]);
                let next = value / rise;
                before = zero.select_lt(far, step, before);
                slope = zero.select_lt(far, rise, slope);
                step = zero.select_lt(far, next, step);
                x = x - zero.select_lt(far, next, zero);
            }
            far = zero.select_lt(far, x.splat(1e-7).select_lt(step.abs(), one, zero), zero);
            if !far.any() {
                break;
            }
        }
        (x, newton_error(step, before), slope)
    }
}

impl<T: Real> Flag<T> {
    /// Returns 1 where a place lies within the flagged part, else 0.
    #[inline(always)]
    fn lies_within(&self, at: T) -> T {
        let (zero, one, tiny) = (at.splat(0.0), at.splat(1.0), at.splat(1e-9));
        let end = self.from + at.splat(WIDTH) + tiny;
        (self.from - tiny).select_lt(at, at.select_lt(end, one, zero), zero)
    }
}

/// The error of Newton's method after its last two steps: C step^2, with C estimated from the two.
#[inline(always)]
fn newton_error<T: Real>(step: T, before: T) -> T {
    let one = step.splat(1.0);
    let ratio = (step / before.abs().max(step.splat(1e-300))).abs().min(one);
    step.abs() * ratio * ratio + step * step
}

/// The first part from `from` on that may contain a zero or a dip below zero.
#[inline(always)]
fn flagged<T: Real>(values: &[ValueSlope<T>], bound: T, from: T) -> Flag<T> {
    let number = here(
        #[inline(always)]
        |x: f64| bound.splat(x),
    );
    let (zero, one, width) = (number(0.0), number(1.0), number(WIDTH));
    let mut first =
        Flag { kind: zero, from: number(f64::INFINITY), begin: (zero, one), end: zero, share: zero };
    for j in (0..values.len() - 1).rev() {
        let (begin, end) = (values[j], values[j + 1]);
        let (p, p_end, rise) = (begin.1 * width, end.1 * width, end.0 - begin.0);
        let (cubic, square) = (p + p_end - rise - rise, number(3.0) * rise - p - p - p_end);
        // A cubic without real zeros of its slope is monotonic; `bent` is then below zero.
        let bent = square * square - number(3.0) * cubic * p;
        let root = bent.max(zero).sqrt();
        let share = zero - p / (square + root);
        let least = share.fma(share.fma(share.fma(cubic, square), p), begin.0);
        let low = least.select_lt(bound, zero.select_lt(bent, number(2.0), zero), zero);
        // A cubic has one least value, which counts if it lies within the part.
        let dip = zero.select_lt(share, share.select_lt(one, low, zero), zero);
        // A part that ends below zero can have a dip before the zero only if the series falls at its end.
        let falls = zero.select_lt(dip, p_end.select_lt(zero, dip, one), one);
        let kind = zero.select_lt(end.0, dip, falls);
        let kind = number(j as f64 * WIDTH + 1e-9).select_lt(from, zero, kind);
        let set = here(
            #[inline(always)]
            |yes: T, no: T| zero.select_lt(kind, yes, no),
        );
        first = Flag {
            kind: set(kind, first.kind),
            from: set(number(j as f64 * WIDTH), first.from),
            begin: (set(begin.0, first.begin.0), set(begin.1, first.begin.1)),
            end: set(end.0, first.end),
            share: set(share, first.share),
        };
    }
    first
}

/// The zero, at most `h` ahead, of the parabola through a value, its slope and a value at `h` that is not positive.
#[inline(always)]
fn zero_of_parabola<T: Real>((value, slope): ValueSlope<T>, end: T, h: T) -> T {
    let zero = value.splat(0.0);
    let bend = ((end - value) / h - slope) / h;
    let root = (slope * slope - value.splat(4.0) * bend * value).max(zero).sqrt();
    // A parabola that falls at the start has the sought zero at its nearer root, any other at its farther root; each root
    // is written in the form without cancellation.
    slope.select_lt(zero, (value + value) / (root - slope), (zero - slope - root) / (bend + bend))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The coefficients of the cubic (eta - a)(eta - b)(c - eta).
    fn cubic([a, b, c]: [f64; 3]) -> [f64; 8] {
        [a * b * c, -(a * b + (a + b) * c), a + b + c, -1.0, 0.0, 0.0, 0.0, 0.0]
    }

    #[test]
    fn a_dip_is_seen_wherever_in_its_part_it_lies() {
        // The first dip falls again at the end of its part, the second falls below zero there, and the third rises at
        // both ends.
        for zeros in [[0.005, 0.01, 0.045], [0.005, 0.01, 0.035], [0.0501, 0.0503, 0.1]] {
            let terms = cubic(zeros);
            let seen = EtaSeries::of(&terms).first(1.0);
            assert!(seen.is_found > 0.5 && (seen.at - zeros[0]).abs() < 1e-12, "{zeros:?}: {}", seen.at);
        }
        // The same dips are lifted above zero: the fall behind them is found, or the search reports a doubt.
        for (zeros, lift) in
            [([0.005, 0.01, 0.045], 1e-6), ([0.005, 0.01, 0.035], 1e-6), ([0.05, 0.06, 0.1], 3e-6)]
        {
            let mut terms = cubic(zeros);
            terms[0] += lift;
            let seen = EtaSeries::of(&terms).first(1.0);
            let late = seen.is_found > 0.5 && seen.at > zeros[2];
            assert!(late || seen.doubt <= zeros[0], "{zeros:?}: {} {}", seen.at, seen.doubt);
        }
    }
}
