//! One panel of a march along a motion, in lanes: what comes first within its reach, where, and after which time.
//!
//! ```text
//! eta = d y,  d = +-1 points the way the motion goes        F(eta) = J theta'^2,   X(eta) > 0 while the body presses
//! turn   F = 0          lift-off   X = 0          slip   Z = 0          side   eta = d y_side          edge   eta = 0.32 or less
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
mod judge;
mod press;
mod rule;
mod signs;

use super::series::{balance, ending, lines};
use crate::contact::FLAT;
use crate::contact::reduced::Reduced;
use crate::number::{Lane, Real};
use clock::PanelClock;
pub(crate) use extent::Extent;
pub(crate) use rule::Rule;
use signs::{EtaSeries, FirstZero};

/// Parts that a panel is looked at in, and those in which turning points are sought, to be divided out.
const PARTS: usize = 8;
const MORE: usize = 10;
/// Their width.
const WIDTH: f64 = 0.04;
const REACH: f64 = WIDTH * PARTS as f64;
/// What Newton's method may miss of a turning point that is divided out.
const SURE: f64 = 1e-13;

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

/// The series of a panel, in eta: w1 and w3 in y.
struct PanelSeries<T, const N: usize> {
    w1: [T; N],
    w3: [T; N],
    force: [T; N],
    press: [T; N],
    grip: [T; N],
    /// How far they are exact to rounding.
    edge: T,
}

/// The turning points of a panel, or what stands for them: the place, 1 where it is one, and the zeros as they were seen.
struct Between<T> {
    low: T,
    high: T,
    is_low: T,
    is_high: T,
    seen: [FirstZero<T>; 2],
}

/// What a panel comes to, where, and after which time.
struct Reached<T> {
    code: T,
    out: T,
    /// By what the zero has been missed, and how steep it is.
    miss: T,
    steep: T,
    time: T,
    late: T,
    weakest: T,
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
        let zero = way.splat(0.0);
        let angle = (knot.sin, knot.cos);
        let of = self.terms::<N>(knot, way, sought);
        let ends = turning(&of.force);
        let FirstEvent { code, at, miss, steep } = self.first(knot, way, sought, &of, &ends);
        let clock = PanelClock::of(
            &self.law,
            angle,
            way,
            &of.force,
            [ends.low, ends.high],
            [ends.is_low, ends.is_high],
        );
        let start = clock.phase(zero);
        let stop = is(code, Comes::Turn, way.splat(core::f64::consts::PI), clock.phase(at));
        let (time, late, weakest) = clock.between(rule, start, stop);
        let mut reached = Reached { code, out: at, miss, steep, time, late, weakest };
        if !sought.ends {
            reached.at_time(rule, &clock, [start, stop], target);
        }
        let turn = if sought.turns {
            let (clock, w1) = (&clock, &of.w1);
            zero.aside(
                #[inline(always)]
                move || clock.precession(rule, [start, stop], w1),
            )
        } else {
            zero
        };
        let there = self.there(knot, way, &of, &clock, &reached);
        self.judged(knot, &of, &ends, &reached, &there, turn)
    }

    /// The series about a knot; those of the forces where ends are sought.
    #[inline(always)]
    fn terms<const N: usize>(&self, knot: &Knot<T>, way: T, sought: Sought) -> PanelSeries<T, N> {
        let zero = way.splat(0.0);
        let (law, s, c) = (&self.law, knot.sin, knot.cos);
        let (mut w1, mut w3, mut force) = ([knot.w1; N], [knot.w3; N], [knot.force; N]);
        lines(law, s, c, &mut w1, &mut w3);
        balance(law, s, c, &w1, &w3, &mut force);
        let (mut press, mut grip) = ([zero; N], [zero; N]);
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
        let edge = self.edge(knot, [&w1, &w3, &force]);
        for k in (1..N).step_by(2) {
            force[k] = force[k] * way;
            press[k] = press[k] * way;
            grip[k] = grip[k] * way;
        }
        PanelSeries { w1, w3, force, press, grip, edge }
    }

    /// How far a panel reaches: what it hands on is exact to rounding.
    ///
    /// About a rounded rim a zero of D may lie within the unit circle, and then the series fall more slowly than by the reach.
    #[inline(always)]
    fn edge<const N: usize>(&self, knot: &Knot<T>, [w1, w3, force]: [&[T; N]; 3]) -> T {
        let number = here(
            #[inline(always)]
            |x: f64| knot.sin.splat(x),
        );
        let mut edge = number(REACH);
        if !self.law.round {
            return edge;
        }
        let turning = number(8.0) * (number(1.0) + knot.w1.abs() + knot.w3.abs());
        let balanced = number(12.0) * self.sizes(knot, [knot.w1.abs(), knot.w3.abs()]);
        for part in [0.75, 0.5, 0.25] {
            let left = |series: &[T; N]| ending(series, edge);
            let fits = left(w1).max(left(w3)) / turning;
            let fits = fits.max(left(force) / balanced);
            edge = number(f64::EPSILON).select_lt(fits, number(part * REACH), edge);
        }
        edge
    }

    /// The size of the terms of which F is the sum, for such w1 and w3.
    #[inline(always)]
    fn sizes(&self, knot: &Knot<T>, [w1, w3]: [T; 2]) -> T {
        let of = self.law.at((knot.sin, knot.cos));
        let two = w1.splat(2.0);
        of.al * w1 * w1
            + of.b * w3 * w3
            + two * of.k.abs() * w1 * w3
            + two * (self.law.shape.rim.ell.abs() + w1.splat(1.0))
            + knot.force
    }

    /// What comes first, and where.
    #[inline(always)]
    fn first<const N: usize>(
        &self,
        knot: &Knot<T>,
        way: T,
        sought: Sought,
        of: &PanelSeries<T, N>,
        ends: &Between<T>,
    ) -> FirstEvent<T> {
        let number = here(
            #[inline(always)]
            |x: f64| way.splat(x),
        );
        let (zero, one, half, never) = (number(0.0), number(1.0), number(0.5), number(9.0));
        let (s, c) = (knot.sin, knot.cos);
        let [sin_side, cos_side] = self.side;
        let side = way * (sin_side * c - cos_side * s) / (sin_side + s);
        let mut next = FirstEvent { code: number(Comes::Edge.code()), at: of.edge, miss: zero, steep: one };
        next.meets(zero.select_lt(way, side, never), number(Comes::Side.code()));
        // where the body lies flat, on this face or on the other: tan(theta/2), or its inverse, is that small
        let flat = number(0.5 * FLAT);
        let (slope, steep) = (s / (one + c), s / (one - c));
        let (below, above) = ((slope - flat) / (slope + flat), (steep - flat) / (steep + flat));
        next.meets(zero.select_lt(way, above, below), number(Comes::Face.code()));
        let turns_back = number(Comes::Turn.code());
        let ahead = &ends.seen[0];
        let code = ahead.miss.select_lt(number(SURE), turns_back, never);
        next.meets(half.select_lt(ends.is_high, ends.high, never), code);
        // where F might have a pair of zeros
        next.meets(ahead.doubt, never);
        if sought.ends {
            let all = [(&of.press, Comes::LiftOff), (&of.grip, Comes::Slip)];
            for (series, what) in all.into_iter().take(1 + usize::from(sought.slips)) {
                let found = EtaSeries::of(series).first(next.at);
                let lifted = series[0].select_lt(zero, one, zero);
                let at = zero.select_lt(lifted, zero, half.select_lt(found.found, found.at, never));
                let hit = at.select_lt(next.at, one, zero);
                next.miss = zero.select_lt(hit, found.miss, next.miss);
                next.steep = zero.select_lt(hit, found.steep, next.steep);
                // where nothing presses nothing grips: a slip comes before, or one that has not been seen
                let code = if sought.slips && what == Comes::LiftOff { never } else { number(what.code()) };
                next.meets(at, code);
                next.meets(zero.select_lt(lifted, never, found.doubt), never);
            }
        }
        next
    }
}

/// The turning points ahead and behind: within reach of the series, else its edges stand for them.
#[inline(always)]
fn turning<T: Lane, const N: usize>(force: &[T; N]) -> Between<T> {
    let number = here(
        #[inline(always)]
        |x: f64| force[0].splat(x),
    );
    let (zero, one, half) = (number(0.0), number(1.0), number(0.5));
    let seen = EtaSeries::of(force).turns();
    let edge = number(MORE as f64 * WIDTH);
    let rests = force[0].abs().select_lt(number(f64::MIN_POSITIVE), one, zero);
    let high = seen[0].found.select_lt(half, edge, seen[0].at);
    let behind = seen[1].found.select_lt(half, number(-1.0) * edge, seen[1].at.min(zero));
    let low = zero.select_lt(rests, zero, behind);
    // a zero that Newton's method has not reached, as another is near, is not divided out
    let is_low = zero.select_lt(rests, one, seen[1].miss.select_lt(number(SURE), seen[1].found, zero));
    Between { low, high, is_low, is_high: seen[0].found, seen }
}

impl<T: Lane> Reached<T> {
    /// The time that is sought, where it comes before.
    #[inline(always)]
    fn at_time<const N: usize>(
        &mut self,
        rule: &Rule,
        clock: &PanelClock<'_, T, N>,
        ways: [T; 2],
        target: T,
    ) {
        let (zero, one, time) = (target.splat(0.0), target.splat(1.0), self.time);
        let hit = target.select_lt(time, one, zero);
        if !hit.any() {
            return;
        }
        let found = zero.aside(
            #[inline(always)]
            move || clock.sought(rule, ways, (target, time)),
        );
        let missed = (target - found.time).abs();
        self.time = zero.select_lt(hit, found.time, self.time);
        self.late = zero.select_lt(hit, missed + found.tail, self.late);
        self.weakest = zero.select_lt(hit, found.weakest, self.weakest);
        self.out = zero.select_lt(hit, found.at, self.out);
        self.code = zero.select_lt(hit, target.splat(Comes::Time.code()), self.code);
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

/// What comes first of all that has been looked for, and if that is a zero by what it has been missed, and how steep it is.
struct FirstEvent<T> {
    code: T,
    at: T,
    miss: T,
    steep: T,
}

impl<T: Real> FirstEvent<T> {
    /// This comes at a place, if nothing comes before.
    #[inline(always)]
    fn meets(&mut self, at: T, code: T) {
        self.code = at.select_lt(self.at, code, self.code);
        self.at = at.select_lt(self.at, at, self.at);
    }
}
