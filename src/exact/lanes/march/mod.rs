//! One panel of a march along a motion, in lanes: what comes first within its reach, where, and after which time.
//!
//! ```text
//! eta = d y,  d = +-1 points the way the motion goes        F(eta) = J theta'^2,   X(eta) > 0 while the body presses
//! turn   F = 0          lift-off   X = 0          slip   Z = 0          side   eta = d y_side          edge   eta = 0.32
//! F = (eta - low)(high - eta) W,   eta = mid - amp cos phi,   dt = (2 s0/Q) sqrt(J/W) dphi
//! ```
//! y and its series are those of [`lanes`](super). [`press`] has X and Z, which are power series as F is: no square root, no
//! angular velocity is needed to find where they vanish. [`signs`] finds the first zero of a series and says whether one may
//! have been overlooked; [`clock`] has the time. A motion that ends is marched to its end, panel after panel, and nothing
//! behind that is looked at; a motion that does not is marched to both its turning points, and is known for ever.
//!
//! Error: the sum of what the rule of the clock leaves, what the series leave out, and what rounding does to F and to what
//! vanished. What cannot be answered surely is not answered.

mod clock;
mod extent;
mod press;
mod rule;
mod signs;

use super::series::{angle, balance, ending, horner, lines, steepness, turned, unit};
use crate::contact::FLAT;
use crate::contact::reduced::Reduced;
use crate::number::{Lane, Real};
use clock::Clock;
pub(crate) use extent::Extent;
pub(crate) use rule::Rule;
use signs::Series;

/// Parts that a panel is looked at in, and those in which turning points are sought, to be divided out.
const PARTS: usize = 8;
const MORE: usize = 10;
/// Their width.
const WIDTH: f64 = 0.04;
const REACH: f64 = WIDTH * PARTS as f64;

/// A closure that is inlined where it is called: one that is bound to a name is not.
#[inline(always)]
pub(crate) fn here<F>(f: F) -> F {
    f
}

/// Where a panel begins: the inclination, its sine and cosine, w1, w3 and F there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Knot<T> {
    pub theta: T,
    pub sin: T,
    pub cos: T,
    pub w1: T,
    pub w3: T,
    pub force: T,
}

/// What a march asks of its panels, the same in all lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sought {
    /// Whether ends are looked for; if not, a time is.
    pub ends: bool,
    /// Whether slip is among them.
    pub slips: bool,
    /// Whether the precession on the way is wanted.
    pub turns: bool,
}

/// What comes first. As a number in a lane: see [`Met::code`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Comes {
    /// The edge of the panel.
    Edge,
    Turn,
    Side,
    LiftOff,
    Slip,
    /// The time that was sought.
    Time,
    /// The face: a body that does not spin falls flat.
    Face,
    /// It is not known.
    Unknown,
}

impl Comes {
    const ALL: [Self; 7] =
        [Self::Edge, Self::Turn, Self::Side, Self::LiftOff, Self::Slip, Self::Time, Self::Face];

    /// Its number: the place in `ALL`.
    #[inline(always)]
    const fn code(self) -> f64 {
        self as u8 as f64
    }

    /// From its number.
    pub fn of(code: f64) -> Self {
        Self::ALL.get(code as usize).copied().unwrap_or(Self::Unknown)
    }
}

/// What a panel has met.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Met<T> {
    /// The number of what [`Comes`]; 9 where it is not known.
    pub code: T,
    /// How long that took.
    pub time: T,
    /// What is not known of that; and of the state there, the time being known.
    pub late: T,
    pub off: T,
    /// The most that the state changes with time there.
    pub rate: T,
    /// |theta'| there.
    pub tilt: T,
    /// By how much phi has turned, if that is wanted.
    pub turn: T,
    pub knot: Knot<T>,
}

/// A march in lanes.
pub(crate) struct March<T> {
    pub law: Reduced<T>,
    /// Sine and cosine of the inclination at which something else than the rim lands.
    pub side: [T; 2],
    /// Square of the coefficient of friction.
    pub mu_square: T,
}

impl<T: Lane> March<T> {
    /// The panel that begins at a knot, N terms long; `way` is d, `target` the time that is sought.
    #[inline(always)]
    pub fn panel<const N: usize>(
        &self,
        rule: &Rule,
        knot: &Knot<T>,
        way: T,
        target: T,
        sought: Sought,
    ) -> Met<T> {
        let number = here(
            #[inline(always)]
            |x: f64| way.splat(x),
        );
        let (zero, one, two, half) = (number(0.0), number(1.0), number(2.0), number(0.5));
        let (law, s, c) = (&self.law, knot.sin, knot.cos);
        let (mut w1, mut w3, mut force) = ([knot.w1; N], [knot.w3; N], [knot.force; N]);
        lines(law, s, c, &mut w1, &mut w3);
        balance(law, s, c, &w1, &w3, &mut force);
        let mut press = [zero; N];
        let mut grip = [zero; N];
        if sought.ends {
            press::normal(law, (s, c), &force, &mut press);
            if sought.slips {
                let (parts, limit, grip) = ([&w1, &w3, &force, &press], self.mu_square, &mut grip);
                zero.aside(
                    #[inline(always)]
                    move || press::grip(law, (s, c), parts, limit, grip),
                );
            }
        }
        for k in (1..N).step_by(2) {
            force[k] = force[k] * way;
            press[k] = press[k] * way;
            grip[k] = grip[k] * way;
        }

        // turning points ahead and behind: within reach of the series, else its edges stand for them
        let of_force = Series::of(&force);
        let turns = of_force.turns();
        let edge = number(MORE as f64 * WIDTH);
        let rests = force[0].abs().select_lt(number(f64::MIN_POSITIVE), one, zero);
        let ahead = turns[0].found.select_lt(half, edge, turns[0].at);
        let behind = turns[1].found.select_lt(half, number(-1.0) * edge, turns[1].at.min(zero));
        let (high, low) = (ahead, zero.select_lt(rests, zero, behind));
        // a zero that Newton's method has not reached, as another is near, is not divided out
        let sure = number(1e-13);
        let is_high = turns[0].found;
        let is_low = zero.select_lt(rests, one, turns[1].miss.select_lt(sure, turns[1].found, zero));

        // what comes first
        let never = number(9.0);
        let [sin_side, cos_side] = self.side;
        let side = way * (sin_side * c - cos_side * s) / (sin_side + s);
        let mut next = Next { code: number(Comes::Edge.code()), at: number(REACH) };
        next.meets(zero.select_lt(way, side, never), number(Comes::Side.code()));
        // where the body lies flat, on this face or on the other: tan(theta/2), or its inverse, is that small
        let flat = number(0.5 * FLAT);
        let (slope, steep) = (s / (one + c), s / (one - c));
        let (below, above) = ((slope - flat) / (slope + flat), (steep - flat) / (steep + flat));
        next.meets(zero.select_lt(way, above, below), number(Comes::Face.code()));
        let turns_back = number(Comes::Turn.code());
        next.meets(half.select_lt(is_high, high, never), turns[0].miss.select_lt(sure, turns_back, never));
        // where F might have a pair of zeros
        next.meets(turns[0].doubt, never);
        let (mut miss, mut steep) = (zero, one);
        if sought.ends {
            let all = [(&press, Comes::LiftOff), (&grip, Comes::Slip)];
            for (series, what) in all.into_iter().take(1 + usize::from(sought.slips)) {
                let found = Series::of(series).first(next.at);
                let lifted = series[0].select_lt(zero, one, zero);
                let at = zero.select_lt(lifted, zero, half.select_lt(found.found, found.at, never));
                let hit = at.select_lt(next.at, one, zero);
                miss = zero.select_lt(hit, found.miss, miss);
                steep = zero.select_lt(hit, found.steep, steep);
                // where nothing presses nothing grips: a slip comes before, or one that has not been seen
                let code = if sought.slips && what == Comes::LiftOff { never } else { number(what.code()) };
                next.meets(at, code);
                next.meets(zero.select_lt(lifted, never, found.doubt), never);
            }
        }
        let Next { mut code, at: mut out } = next;

        // how long it takes
        let clock = Clock::of(law, (s, c), way, &force, [low, high], [is_low, is_high]);
        let start = clock.phase(zero);
        let stop = is(code, Comes::Turn, number(core::f64::consts::PI), clock.phase(out));
        let (mut time, mut tail, mut weakest) = clock.between(rule, start, stop);
        let mut late = zero;
        if !sought.ends {
            let hit = target.select_lt(time, one, zero);
            if hit.any() {
                let clock = &clock;
                let found = zero.aside(
                    #[inline(always)]
                    move || clock.sought(rule, [start, stop], (target, time)),
                );
                time = zero.select_lt(hit, found.time, time);
                tail = zero.select_lt(hit, found.tail, tail);
                late = zero.select_lt(hit, (target - found.time).abs(), zero);
                weakest = zero.select_lt(hit, found.weakest, weakest);
                out = zero.select_lt(hit, found.at, out);
                code = zero.select_lt(hit, number(Comes::Time.code()), code);
            }
        }

        let turn = if sought.turns {
            let (clock, w1) = (&clock, &w1);
            zero.aside(
                #[inline(always)]
                move || clock.precession(rule, [start, stop], w1),
            )
        } else {
            zero
        };

        // the state there
        let y = out * way;
        let q = (y - (c + c)).fma(y, one);
        let (sin, cos) = unit(angle(s, c, y, q));
        let jay = law.inertia(|| (sin, cos));
        let there = is(code, Comes::Turn, zero, clock.force(out).max(zero));
        // what is left to the face adds to the tilting there
        let left = number(2.0 * FLAT) * law.shape.rim.lever((sin, cos)).abs();
        let lies = law.inertia(|| (zero, cos.select_lt(zero, number(-1.0), one)));
        let tilt = is(code, Comes::Face, (there + left) / lies, there / jay).sqrt();
        let per_y = (s + s) / q;
        let (w1_slope, w3_slope) = (steepness(&w1, out), steepness(&w3, out));
        let force_slope = steepness(&force, out);
        let y_rate = tilt / per_y;
        let rate = tilt + y_rate * (w1_slope + w3_slope) + force_slope / (two * jay * per_y);

        // what is not known: F, by rounding and by what its series leaves out
        let of = law.at((s, c));
        // at whichever end of the way its terms are the larger: towards small inclinations w1 grows
        let (last_w1, last_w3) = (horner(&w1, y), horner(&w3, y));
        let (most_w1, most_w3) = (knot.w1.abs().max(last_w1.abs()), knot.w3.abs().max(last_w3.abs()));
        let terms = of.al * most_w1 * most_w1
            + of.b * most_w3 * most_w3
            + two * of.k.abs() * most_w1 * most_w3
            + two * (law.shape.rim.ell.abs() + one)
            + force[0];
        let noise = number(12.0 * f64::EPSILON) * terms;
        let cut = ending(&force, out);
        let amp = half * (high - low);
        // with both ends divided out, about the start itself, only the slope and the curvature of F are uncertain
        let both = number(1.5).select_lt(is_low + is_high, amp, amp * amp);
        let share = (noise / both + cut / (amp * amp)) / weakest;
        late = late + tail + time * share + number(4.0 * f64::EPSILON) * time;
        let which = is(code, Comes::Slip, one, zero);
        let (mut size, mut left) = (zero, zero);
        for k in (0..N).rev() {
            size = size.fma(out, zero.select_lt(which, grip[k], press[k]).abs());
        }
        left = left + zero.select_lt(which, ending(&grip, out), ending(&press, out));
        // what is not known of F at the knot is not known of the forces either
        let blur = press::blur(law, (s, c), noise) * is(code, Comes::Slip, two * (one + self.mu_square), one);
        let vanishing = (number(16.0 * f64::EPSILON) * size + left + blur) / steep + miss;
        let on_side = number(4.0 * f64::EPSILON);
        let place = is(
            code,
            Comes::Side,
            on_side,
            is(code, Comes::LiftOff, vanishing, is(code, Comes::Slip, vanishing, zero)),
        );
        late = late + zero.select_lt(place, place * per_y / tilt, zero);
        let blurred = noise + cut + force_slope * place;
        let at_end = (blurred / (two * jay * tilt)).min((blurred / jay).sqrt());
        // at a time the place is known with its phase: as well as the turning points are
        let timed = is(code, Comes::Time, one, is(code, Comes::Turn, one, zero));
        let tilt_off = zero.select_lt(timed, tilt * share, at_end);
        let place = zero.select_lt(timed, (noise + cut) / (two * amp * weakest), place);
        let off = place * (per_y + w1_slope + w3_slope)
            + tilt_off
            + ending(&w1, out)
            + ending(&w3, out)
            + number(8.0 * f64::EPSILON) * (one + most_w1 + most_w3);
        // what has ended at its start is known
        let over = is(code, Comes::LiftOff, one, is(code, Comes::Slip, one, zero));
        let begun = out.select_lt(number(f64::MIN_POSITIVE), over, zero);
        let known = here(
            #[inline(always)]
            |x: T| zero.select_lt(begun, zero, x),
        );
        let (time, late, off) = (known(time), known(late), known(off));
        // no number, no answer
        let fine = (zero * (late + off + time) + zero).select_lt(one, weakest, number(-1.0));
        let code = zero.select_lt(fine, code, zero.select_lt(begun, code, never));
        let knot =
            Knot { theta: knot.theta + turned(s, c, y), sin, cos, w1: last_w1, w3: last_w3, force: there };
        Met { code, time, late, off, rate, tilt, turn, knot }
    }
}

/// The first where a code is this one, else the second.
#[inline(always)]
fn is<T: Real>(code: T, what: Comes, yes: T, no: T) -> T {
    equals(code, what.code(), yes, no)
}

/// The first where a whole number is this one, else the second.
#[inline(always)]
fn equals<T: Real>(number: T, other: f64, yes: T, no: T) -> T {
    (number - number.splat(other)).abs().select_lt(number.splat(0.5), yes, no)
}

/// What comes first of all that has been looked for.
struct Next<T> {
    code: T,
    at: T,
}

impl<T: Real> Next<T> {
    /// This comes at a place, if nothing comes before.
    #[inline(always)]
    fn meets(&mut self, at: T, code: T) {
        self.code = at.select_lt(self.at, code, self.code);
        self.at = at.select_lt(self.at, at, self.at);
    }
}
