//! Motions side by side: each lane its own steps, up to what ends it or needs attention.
//!
//! ```text
//! margins  m_i > 0        the first that fails is found on steps that become shorter (Illinois), while the others go on
//! quiet    q > 0          where it is not, somebody else has to look: from one step before
//! ```
//! A margin that has been least one step ago, and is small beside what it varies by, needs attention as well: from two steps
//! before. What flows is a [`Flows`]; [`slips`](super::slips) leads it through. Which steps a lane makes does not depend on its
//! neighbours.

use super::side_by_side::{MOST, SideBySide, apart};
use crate::rk8;

/// How many numbers a law may need: of the body and of what acts on it.
pub(super) const NUMBERS: usize = 18;

/// What flows in lanes: N numbers, and M margins; the last margin is the time that is left.
pub(super) trait Flows<T: SideBySide, const N: usize, const M: usize>: Copy {
    /// What the rates come from, which the margins see.
    type Seen;
    fn of(numbers: &[T; NUMBERS], like: &Self) -> Self;
    fn rates(&self, y: &[T; N], rate: &mut [T; N]) -> Self::Seen;
    /// What must stay positive, but for the time that is left.
    fn margins(&self, y: &[T; N], seen: &Self::Seen) -> [T; M];
    /// Positive where nothing needs attention.
    fn quiet(&self, y: &[T; N], seen: &Self::Seen) -> T;
    /// Positive as long as it moves.
    fn moves(&self, y: &[T; N]) -> T;
    /// The time after a step from `t`.
    fn time(&self, y: &[T; N], t: T, h: T) -> T;
    /// What a step errs by, where 1 is allowed.
    fn error(&self, tol: T, y: &[T; N], made: &rk8::Step<T, N>) -> T;
    /// The longest step from a place.
    fn longest(&self, y: &[T; N], rate: &[T; N]) -> T;
}

/// What a lane starts with.
pub(super) struct Entry<const N: usize> {
    pub y: [f64; N],
    pub t: f64,
    pub step: f64,
    pub numbers: [f64; NUMBERS],
    pub tol: f64,
    pub until: f64,
}

/// What a lane says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Told {
    /// It goes on.
    Nothing,
    /// This margin has failed, here.
    Met(usize),
    /// It has come to rest, here.
    Rests,
    /// It needs attention, from one step before.
    Look,
    /// From two steps before.
    LookBack,
    /// Steps become too short.
    Stuck,
}

const MET: f64 = 1.0;
const RESTS: f64 = 2.0;
const LOOK: f64 = 3.0;
const BACK: f64 = 4.0;
const STUCK: f64 = 5.0;

/// A margin that is so small has failed.
const FAILED: f64 = 2e-15;
/// A step this short, beside the time that has passed, leads nowhere.
const SHORTEST: f64 = 1e-13;
/// The way to a failure is known to this share of it.
const NARROW: f64 = 4e-16;

/// Where lanes are: now, one step ago, two steps ago; and what they look for.
#[derive(Clone, Copy)]
struct Way<T, const N: usize, const M: usize> {
    y: [T; N],
    here: [T; N],
    before: [T; N],
    /// The times then.
    t: [T; 3],
    h: T,
    /// The last step that was taken.
    taken: T,
    /// The margins one step ago.
    margins: [T; M],
    /// Steps that are too short and too long, and the least margin there; too long is 0 where nothing is looked for.
    short: [T; 2],
    long: [T; 2],
    /// Which of them was moved last, and how many there have been.
    side: T,
    tries: T,
    /// Evaluations.
    made: T,
}

impl<T: Copy, const N: usize, const M: usize> Way<T, N, M> {
    /// All of its numbers, one after the other.
    fn each(&mut self, mut f: impl FnMut(&mut T)) {
        let Self { y, here, before, t, h, taken, margins, short, long, side, tries, made } = self;
        y.iter_mut().chain(here).chain(before).chain(t).chain(margins).for_each(&mut f);
        short.iter_mut().chain(long).chain([h, taken, side, tries, made]).for_each(f);
    }
}

/// The first where a mask is positive, elsewhere the second.
#[inline(always)]
fn at<T: SideBySide>(mask: T, yes: T, no: T) -> T {
    mask.splat(0.0).select_lt(mask, yes, no)
}

/// So many motions side by side.
pub(super) struct Set<T, L, const N: usize, const M: usize> {
    law: L,
    tol: T,
    until: T,
    /// 8 over the time that is waited for.
    per_until: T,
    way: Way<T, N, M>,
    rate: [T; N],
    /// The margins now.
    margins: [T; M],
    told: T,
    /// 0 where there is a task.
    idle: T,
    rows: Vec<[f64; MOST]>,
}

impl<T: SideBySide, L: Flows<T, N, M>, const N: usize, const M: usize> Set<T, L, N, M> {
    /// All lanes alike.
    pub fn new(zero: T, law: L, entry: &Entry<N>) -> Self {
        let way = Way {
            y: [zero; N],
            here: [zero; N],
            before: [zero; N],
            t: [zero; 3],
            h: zero,
            taken: zero,
            margins: [zero; M],
            short: [zero; 2],
            long: [zero; 2],
            side: zero,
            tries: zero,
            made: zero,
        };
        let rows = vec![[0.0; MOST]; 3 * N + M + 12 + NUMBERS + 2];
        let (tol, until, per_until, told, idle) = (zero, zero, zero, zero, zero);
        let (rate, margins) = ([zero; N], [zero; M]);
        let mut set = Self { law, tol, until, per_until, way, rate, margins, told, idle, rows };
        (0..T::COUNT).for_each(|k| set.fill(k, entry));
        set.settle(zero);
        set
    }

    /// Puts a task into lane `k` of the rows.
    pub fn fill(&mut self, k: usize, entry: &Entry<N>) {
        let Entry { y, t, step, .. } = *entry;
        let mut way = Way {
            y,
            here: y,
            before: y,
            t: [t; 3],
            h: step,
            taken: step,
            // a margin that comes from below has not been least
            margins: [-1.0; M],
            short: [0.0; 2],
            long: [0.0; 2],
            side: 0.0,
            tries: 0.0,
            made: 1.0,
        };
        let mut row = 0;
        let mut put = |x: f64| {
            self.rows[row][k] = x;
            row += 1;
        };
        way.each(|x| put(*x));
        entry.numbers.into_iter().chain([entry.tol, entry.until]).for_each(put);
    }

    /// Writes what is on its way into the rows, so that a lane of it can be filled anew.
    pub fn keep(&mut self) {
        let (mut row, rows) = (0, &mut self.rows);
        self.way.each(|x| {
            (0..T::COUNT).for_each(|k| rows[row][k] = x.lane(k));
            row += 1;
        });
    }

    /// Takes up what the rows say.
    pub fn settle(&mut self, zero: T) {
        let (mut row, rows) = (0, &self.rows);
        let mut next = || {
            row += 1;
            zero.load(&rows[row - 1])
        };
        self.way.each(|x| *x = next());
        let mut numbers = [zero; NUMBERS];
        numbers.iter_mut().for_each(|x| *x = next());
        (self.tol, self.until) = (next(), next());
        let (law, y) = (self.law, self.way.y);
        let (until, t) = (self.until, self.way.t[0]);
        (self.law, self.rate, self.margins, self.per_until, self.told) = apart(
            zero,
            #[inline(always)]
            || {
                let law = L::of(&numbers, &law);
                let mut rate = y;
                let seen = law.rates(&y, &mut rate);
                let per_until = zero.splat(8.0) / until;
                let mut margins = law.margins(&y, &seen);
                margins[M - 1] = (until - t) * per_until;
                let low = margins.into_iter().fold(law.quiet(&y, &seen), |low, x| x.min(low));
                let told = zero.select_lt(low, zero, zero.splat(LOOK));
                (law, rate, margins, per_until, told)
            },
        );
        self.told = zero.splat(0.5).select_lt(self.idle, zero, self.told);
    }

    /// Lanes without a task rest.
    pub fn rests(&mut self, zero: T, idle: &[f64; MOST]) {
        self.idle = zero.load(idle);
        self.told = zero.splat(0.5).select_lt(self.idle, zero, self.told);
    }

    /// What lane `k` says.
    pub fn told(&self, k: usize) -> Told {
        let told = self.told.lane(k);
        if told == MET {
            let least = |i: &usize, j: &usize| self.margins[*i].lane(k).total_cmp(&self.margins[*j].lane(k));
            Told::Met((0..M).min_by(least).unwrap_or(0))
        } else if told == RESTS {
            Told::Rests
        } else if told == LOOK {
            Told::Look
        } else if told == BACK {
            Told::LookBack
        } else if told == STUCK {
            Told::Stuck
        } else {
            Told::Nothing
        }
    }

    /// The numbers of lane `k`, its time, and the step that led to them: so many steps ago.
    pub fn place(&self, k: usize, ago: usize) -> ([f64; N], f64, f64) {
        let Way { y, here, before, t, taken, .. } = &self.way;
        let numbers = [y, here, before][ago];
        (core::array::from_fn(|i| numbers[i].lane(k)), t[ago].lane(k), taken.lane(k))
    }

    /// How many evaluations lane `k` has taken.
    pub fn evaluations(&self, k: usize) -> u64 {
        self.way.made.lane(k) as u64
    }

    /// At most so many steps, until some lane says something.
    #[inline(always)]
    pub fn burst(&mut self, steps: usize) {
        let (zero, one) = (self.tol.splat(0.0), self.tol.splat(1.0));
        for _ in 0..steps {
            if (0..T::COUNT).any(|k| self.told.lane(k) > 0.0) {
                return;
            }
            let (law, way) = (&self.law, &self.way);
            let made = rk8::step(
                #[inline(always)]
                |y: &[T; N], rate: &mut [T; N]| {
                    law.rates(y, rate);
                },
                &way.y,
                &self.rate,
                way.h,
            );
            let error = law.error(self.tol, &way.y, &made);
            let mut next = way.y;
            for (next, change) in next.iter_mut().zip(made.change) {
                *next = *next + change;
            }
            let mut rate = next;
            let seen = law.rates(&next, &mut rate);
            let time = law.time(&next, way.t[0], way.h);
            let mut margins = law.margins(&next, &seen);
            margins[M - 1] = (self.until - time) * self.per_until;
            let mut low = margins[0];
            let mut base = self.margins[0];
            for (margin, before) in margins.iter().zip(&self.margins).skip(1) {
                (low, base) = (margin.min(low), before.min(base));
            }
            // a margin that has been least here, and that is small beside what it varies by
            let mut dipped = zero;
            let steps = way.margins.iter().zip(&self.margins).zip(&margins).take(M - 1);
            for ((before, here), after) in steps {
                let (before, here, after) = (*before, *here, *after);
                let spread = before.max(after) - here;
                let small = here.select_lt(spread, one, zero);
                dipped = dipped.max(here.select_lt(before, here.select_lt(after, small, zero), zero));
            }
            // a failure is looked for between a step that is too short and one that is too long
            let good = error.select_lt(one, one, zero);
            let looks = zero.select_lt(way.long[0], one, zero);
            let fails = good * zero.select_lt(low, zero, one);
            let seeks = looks.max(fails);
            let half = zero.splat(0.5);
            let first = zero.select_lt(looks, zero, one);
            let [short_h, short_v] = [way.short[0], zero.select_lt(first, base, way.short[1])];
            let beyond = zero.select_lt(low, zero, one);
            let again = half.select_lt(way.side * at(beyond, -one, one), one, zero);
            let lighter = zero.select_lt(again, half, one);
            let short = [at(beyond, short_h, way.h), at(beyond, short_v * lighter, low)];
            let long = [at(beyond, way.h, way.long[0]), at(beyond, low, way.long[1] * lighter)];
            let gap = long[0] - short[0];
            let middle = half.mac(gap, short[0]);
            let secant = long[0] - long[1] * (gap / (long[1] - short[1]));
            let inside = short[0].select_lt(secant, secant.select_lt(long[0], secant, middle), middle);
            let tries = at(seeks, way.tries + one, zero);
            // every fourth time the middle
            let quarter = tries * zero.splat(0.25);
            let inside = (quarter - quarter.round()).abs().select_lt(zero.splat(0.1), middle, inside);
            let narrow = gap.select_lt(long[0] * zero.splat(NARROW), one, zero);
            let found = low.abs().select_lt(zero.splat(FAILED), one, narrow) * seeks;
            let takes = good * at(seeks, found, one);

            let grown = law.longest(&next, &rate).min(way.h * rk8::growth(error));
            let stuck = way.h.select_lt((one + time) * zero.splat(SHORTEST), zero.splat(STUCK), zero);
            let quiet = zero.select_lt(law.quiet(&next, &seen), zero, zero.splat(LOOK));
            let told = zero.select_lt(law.moves(&next), quiet, zero.splat(RESTS));
            let told = zero.select_lt(dipped, zero.splat(BACK), told);
            let told = zero.select_lt(found, zero.splat(MET), told);
            // what is looked for in vain
            let lost = zero.splat(60.0).select_lt(tries, zero.splat(LOOK), zero);
            let told = at(takes, told, at(seeks, lost, stuck));
            self.told = half.select_lt(self.idle, zero, told);

            let (h, side) = (at(seeks, inside, grown), at(seeks, at(beyond, -one, one), zero));
            let (short, long) = (
                [at(seeks, short[0], zero), at(seeks, short[1], zero)],
                [at(seeks, long[0], zero), at(seeks, long[1], zero)],
            );
            let way = &mut self.way;
            for ((before, here), after) in way.margins.iter_mut().zip(&mut self.margins).zip(&margins) {
                *before = at(takes, *here, *before);
                *here = at(takes, *after, *here);
            }
            for i in 0..N {
                way.before[i] = at(takes, way.here[i], way.before[i]);
                way.here[i] = at(takes, way.y[i], way.here[i]);
                way.y[i] = at(takes, next[i], way.y[i]);
                self.rate[i] = at(takes, rate[i], self.rate[i]);
            }
            way.t = [at(takes, time, way.t[0]), at(takes, way.t[0], way.t[1]), at(takes, way.t[1], way.t[2])];
            way.taken = at(takes, way.h, way.taken);
            way.h = h;
            (way.short, way.long, way.side, way.tries) = (short, long, side, tries);
            way.made = way.made + zero.splat(12.0);
        }
    }
}
