//! Slips side by side: each lane its own steps, until one of them needs attention.
//!
//! ```text
//! quiet = min(N0, 1 - eps, sin(theta_max - theta), s, |u| - over, t_end - t) > 0
//! ```
//! A margin that has been least one step ago, and is small beside what it varies by, needs attention as well: the slip goes back
//! two steps then. [`slips`](super::slips) leads it through.

use super::side_by_side::{MOST, SideBySide, apart};
use crate::body::{Body, Shape};
use crate::contact::slip::Slipping;
use crate::motion::slide::{Slide, longest};
use crate::rk8;
use core::f64::consts::PI;

/// A slip that a lane may take: whose, and how it begins.
pub(super) struct Task {
    pub walk: usize,
    pub y: [f64; 9],
    pub step: f64,
    pub body: Body,
    pub strength: f64,
    pub tol: f64,
    pub over: f64,
}

/// So many slips side by side.
pub(super) struct Set<T> {
    law: Slipping<T>,
    theta_max: [T; 2],
    ends: T,
    tol: T,
    over: T,
    until: T,
    /// The numbers two steps ago, one step ago, now; and how they change.
    pub before: [T; 8],
    pub here: [T; 8],
    y: [T; 8],
    rate: [T; 8],
    h: T,
    /// The last step that was taken.
    pub taken_step: T,
    /// N0 and the distance from theta_max, one step ago and now.
    margins: [[T; 2]; 2],
    /// Positive where nothing needs attention; and where a margin has been least, for which one goes back two steps.
    pub quiet: T,
    pub dipped: T,
    /// 0 where there is a task.
    idle: T,
    rows: [[f64; MOST]; ROWS],
}

/// Where what is in the rows of a set: the numbers now, one step ago, two steps ago; the body; the rest.
const HERE: usize = 8;
const BEFORE: usize = 16;
const SHAPE: usize = 24;
const REST: usize = 28;
const ROWS: usize = REST + 10;

impl<T: SideBySide> Set<T> {
    pub fn new(like: T, dry: bool, until: f64) -> Self {
        let zero = like.splat(0.0);
        let shape = Shape::of([zero, zero.splat(1.0), zero.splat(1.0), zero]);
        Self {
            law: Slipping::of(&shape, zero, dry),
            theta_max: [zero; 2],
            ends: zero,
            tol: zero,
            over: zero,
            until: like.splat(until),
            before: [zero; 8],
            here: [zero; 8],
            y: [zero; 8],
            rate: [zero; 8],
            h: zero,
            taken_step: zero,
            margins: [[zero; 2]; 2],
            quiet: zero,
            dipped: zero,
            idle: zero,
            rows: [[0.0; MOST]; ROWS],
        }
    }

    /// Puts a task into lane `k` of the rows.
    pub fn fill(&mut self, k: usize, task: &Task) {
        let body = &task.body;
        let numbers = [body.ell(), body.i1(), body.i3(), body.fillet()];
        let (sine, cosine) = body.theta_max().sin_cos();
        let ends = f64::from(u8::from(body.theta_max() < PI));
        let h = task.step;
        // a margin that comes from below has not been least
        let rest = [task.strength, sine, cosine, ends, task.tol, task.over, h, h, -1.0, -1.0];
        let y = &task.y[..8];
        let all = y.iter().chain(y).chain(y).copied().chain(numbers).chain(rest);
        for (row, x) in self.rows.iter_mut().zip(all) {
            row[k] = x;
        }
    }

    /// Writes what is on its way into the rows, so that a lane of it can be filled anew.
    pub fn keep(&mut self) {
        let [steps, margins] = [[self.h, self.taken_step], self.margins[0]];
        for k in 0..T::COUNT {
            let numbers = self.y.into_iter().chain(self.here).chain(self.before);
            for (row, x) in self.rows.iter_mut().zip(numbers) {
                row[k] = x.lane(k);
            }
            for (row, x) in self.rows[REST + 6..].iter_mut().zip(steps.into_iter().chain(margins)) {
                row[k] = x.lane(k);
            }
        }
    }

    /// Takes up what the rows say.
    pub fn settle(&mut self, like: T) {
        let row = |i: usize| like.load(&self.rows[i]);
        let eight = |from: usize| core::array::from_fn(|i| row(from + i));
        (self.y, self.here, self.before) = (eight(0), eight(HERE), eight(BEFORE));
        let shape = Shape::of(core::array::from_fn(|i| row(SHAPE + i)));
        let [strength, sine, cosine, ends, tol, over, h, taken_step, free, side] =
            core::array::from_fn(|i| row(REST + i));
        (self.theta_max, self.ends, self.tol, self.over) = ([sine, cosine], ends, tol, over);
        (self.h, self.taken_step, self.margins[0]) = (h, taken_step, [free, side]);
        let dry = self.law.dry;
        (self.law, self.rate, self.margins[1]) = apart(
            like,
            #[inline(always)]
            || {
                let law = Slipping::of(&shape, strength, dry);
                let mut rate = self.y;
                let [free, _] = law.rates(&self.y, &mut rate);
                (law, rate, [free, self.side(&self.y)])
            },
        );
    }

    /// Lanes without a task rest.
    pub fn rests(&mut self, like: T, tasks: &[Option<Task>; MOST]) {
        let mut idle = [0.0; MOST];
        for (idle, task) in idle.iter_mut().zip(tasks) {
            *idle = f64::from(u8::from(task.is_none()));
        }
        self.idle = like.load(&idle);
    }

    /// The distance from theta_max, as the sine of it; 1 where there is none.
    #[inline(always)]
    fn side(&self, y: &[T; 8]) -> T {
        let one = y[0].splat(1.0);
        let [sine, cosine] = self.theta_max;
        one.splat(0.5).select_lt(self.ends, sine * y[1] - cosine * y[0], one)
    }

    /// At most so many steps, until some lane needs attention.
    #[inline(always)]
    pub fn burst(&mut self, steps: usize) {
        let (zero, one) = (self.h.splat(0.0), self.h.splat(1.0));
        for _ in 0..steps {
            let law = self.law;
            let made = rk8::step(
                #[inline(always)]
                |y: &[T; 8], rate: &mut [T; 8]| {
                    law.rates(y, rate);
                },
                &self.y,
                &self.rate,
                self.h,
            );
            let error = Slide::error(self.tol, &self.y, &made, law.dry);
            let mut next = self.y;
            for (next, change) in next.iter_mut().zip(made.change) {
                *next = *next + change;
            }
            let mut rate = next;
            let [free, room] = law.rates(&next, &mut rate);
            let side = self.side(&next);
            // a margin that has been least here, and that is small beside what it varies by
            let mut dipped = zero;
            for (i, after) in [free, side].into_iter().enumerate() {
                let [before, here] = [self.margins[0][i], self.margins[1][i]];
                let spread = before.max(after) - here;
                let low = here.select_lt(spread, one, zero);
                dipped = dipped.max(here.select_lt(before, here.select_lt(after, low, zero), zero));
                self.margins[0][i] = error.select_lt(one, here, before);
                self.margins[1][i] = error.select_lt(one, after, here);
            }
            let dipped = error.select_lt(one, dipped, zero);
            let slip = next[5].mac(next[5], next[6] * next[6]).sqrt();
            let slow = if law.dry { slip - self.over } else { one };
            let quiet = free.min(room).min(side).min(next[0]).min(slow).min(self.until - next[7]);
            let grown = longest(&next, &law.shape).min(self.h * rk8::growth(error));
            let stuck = self.h - self.h.splat(1e-12);
            self.quiet = error.select_lt(one, zero.select_lt(dipped, zero, quiet), stuck).max(self.idle);
            self.dipped = dipped;
            self.taken_step = error.select_lt(one, self.h, self.taken_step);
            for i in 0..8 {
                self.before[i] = error.select_lt(one, self.here[i], self.before[i]);
                self.here[i] = error.select_lt(one, self.y[i], self.here[i]);
                self.y[i] = error.select_lt(one, next[i], self.y[i]);
                self.rate[i] = error.select_lt(one, rate[i], self.rate[i]);
            }
            self.h = grown;
            if (0..T::COUNT).any(|k| self.quiet.lane(k) <= 0.0 || self.quiet.lane(k).is_nan()) {
                return;
            }
        }
    }
}
