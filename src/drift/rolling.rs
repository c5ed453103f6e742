//! The slow drift of a body that rolls without slipping and without nutation.
//!
//! ```text
//! (theta, Omega, t) over the way x in ln theta and ln Omega, by `circular`, with steps of eighth order
//! tail   t left = theta |dt/dtheta|/q,   dt/dtheta ~ theta^(q - 1),   from where theta is 1e-11 of what it was
//! ```
//! The end of a stretch is found by steps that end there: each is a step of its own from where the last one ended.
//!
//! Error: 1e-10 of the time; `benches/drifts.py` has it against DOP853 on (theta, w1, w3).

use super::circular::{Circular, Known};
use super::ends::End;
use crate::body::Body;
use crate::error::Error;
use crate::loss::{Couples, Losses};
use crate::rk8;
use crate::search;
use crate::stability;
use crate::state::State;
use core::f64::consts::PI;

/// Error of a step, relative to the numbers.
pub(super) const TOLERANCE: f64 = 1e-12;

/// Of the first inclination, from which on the way to the face goes as a power.
pub(super) const FLAT: f64 = 1e-11;

/// The sine of an inclination at which a few digits of what is left will do.
const NEARLY_FLAT: f64 = 1e-6;

/// Steps of one drift.
const MOST: usize = 5000;

/// The first step, and the longest.
pub(super) const STEPS: [f64; 2] = [0.02, 1.5];

/// The error of a step over what it may be: of theta and Omega relative to themselves and to how far they are from the
/// start, so that the time of a short way is as good; of the time relative to the time.
#[inline(always)]
pub(super) fn error<T: crate::number::Real>(start: &[T; 3], y: &[T; 3], made: &rk8::Step<T, 3>) -> T {
    let number = |x: f64| y[0].splat(x);
    // of a disk without height w3 is what is left of terms that grow as theta^(-1/2)
    let tolerance = number(TOLERANCE) * (number(1.0) + number(1e-3) / y[0].sqrt());
    let mut sums = [number(1e-300), number(0.0)];
    for i in 0..3 {
        let next = y[i] + made.change[i];
        let own = next.abs().max(y[i].abs());
        let moved = (next - start[i]).abs().max((y[i] - start[i]).abs());
        let size = own.min(moved.max(own * number(1e-6))) * tolerance;
        for (sum, part) in sums.iter_mut().zip([made.fifth[i], made.third[i]]) {
            let part = part / size;
            *sum = part.mac(part, *sum);
        }
    }
    let [fifth, third] = sums;
    fifth / third.mac(fifth.splat(0.01), fifth).sqrt()
}

/// One stretch of a drift.
#[derive(Debug, Clone, Copy)]
struct Step {
    y: [f64; 3],
    h: f64,
    /// The time at its end.
    t: f64,
}

/// A drift that rolls.
#[derive(Debug, Clone)]
pub(super) struct Roll {
    of: Circular<f64>,
    steps: Vec<Step>,
    end: End,
    last: [f64; 3],
    /// The time after the last step, and the power it goes with: a face that lands.
    tail: [f64; 2],
    ball: bool,
    /// -1 of a body that turns the other way round: the mirror image of what is computed.
    turns: f64,
}

impl Roll {
    pub fn new(body: &Body, y: &State, losses: &Losses) -> Result<Self, Error> {
        let (of, start) = begin(body, y, losses)?;
        let (ball, turns) = (body.is_ball(), y.w1.signum());
        let (steps, end, tail) = (Vec::new(), End::Face, [0.0; 2]);
        let mut roll = Self { of, steps, end, last: start, tail, ball, turns };
        roll.run(body, losses)?;
        Ok(roll)
    }

    fn run(&mut self, body: &Body, losses: &Losses) -> Result<(), Error> {
        let (start, mut y, mut h) = (self.last, self.last, STEPS[0]);
        let least = y[0].sin() * FLAT;
        let margins = Margins::of(body, losses);
        while self.steps.len() < MOST {
            let made = self.step(&y, h);
            let off = error(&start, &y, &made);
            if off.is_nan() || off >= 1.0 {
                h *= rk8::growth(off);
                // rounding is all that a step has left: nearly flat it does not matter
                if h < 1e-2 && y[0].sin() < NEARLY_FLAT {
                    return self.land(y);
                }
                if h < 1e-14 {
                    break;
                }
                continue;
            }
            let next = core::array::from_fn(|i| y[i] + made.change[i]);
            let here = margins.least(&self.at(next[0], next[1]), next[0]);
            if here < 0.0 {
                return self.finish(y, h, &margins);
            }
            self.steps.push(Step { y, h, t: next[2] });
            y = next;
            h = (h * rk8::growth(off)).min(STEPS[1]);
            if y[0].sin() < least {
                return self.land(y);
            }
        }
        Err(Error::Lost { theta: y[0] })
    }

    /// In a function of its own: a step has a dozen of it.
    #[inline(never)]
    fn at(&self, theta: f64, rate: f64) -> Known<f64> {
        self.of.at(theta, rate)
    }

    fn step(&self, y: &[f64; 3], h: f64) -> rk8::Step<f64, 3> {
        let rate = |y: &[f64; 3], rate: &mut [f64; 3]| *rate = self.at(y[0], y[1]).rates;
        let mut first = [0.0; 3];
        rate(y, &mut first);
        rk8::step(rate, y, &first, h)
    }

    fn ahead(&self, y: &[f64; 3], h: f64) -> [f64; 3] {
        let made = self.step(y, h);
        core::array::from_fn(|i| y[i] + made.change[i])
    }

    /// The end within a step: the first of what vanishes there.
    fn finish(&mut self, y: [f64; 3], h: f64, margins: &Margins) -> Result<(), Error> {
        let all = |h: f64| {
            let y = self.ahead(&y, h);
            margins.all(&self.at(y[0], y[1]), y[0])
        };
        let (before, after) = (margins.all(&self.at(y[0], y[1]), y[0]), all(h));
        let mut first = (h, End::StabilityLost);
        for i in 0..4 {
            if after[i] < 0.0 {
                let at = if before[i] <= 0.0 {
                    0.0
                } else {
                    search::crossing(|h| all(h)[i], 0.0, h, before[i], after[i])
                };
                if at <= first.0 {
                    first = (at, Margins::ENDS[i]);
                }
            }
        }
        let last = self.ahead(&y, first.0);
        self.steps.push(Step { y, h: first.0, t: last[2] });
        (self.last, self.end) = (last, first.1);
        if self.end == End::Side {
            self.last[0] = margins.side;
        }
        Ok(())
    }

    /// The rest of the way to the face, as a power of the inclination.
    fn land(&mut self, y: [f64; 3]) -> Result<(), Error> {
        self.tail = tail(y[0], &self.at(y[0], y[1]), || {
            let later = self.ahead(&y, 0.05);
            (later[0], self.at(later[0], later[1]))
        });
        self.end = if self.ball { End::Upright } else { End::Face };
        self.last = y;
        Ok(())
    }

    /// What ends it, where, and when.
    pub fn end(&self) -> (End, f64, f64) {
        let lands = self.tail[1] != 0.0;
        let theta = if lands { if self.last[0] < 1.0 { 0.0 } else { PI } } else { self.last[0] };
        (self.end, theta, self.last[2] + self.tail[0])
    }

    /// The time at which it is first at an inclination; NaN where it never is.
    pub fn time(&self, theta: f64) -> f64 {
        if theta.is_nan() {
            return f64::NAN;
        }
        let lands = self.tail[1] != 0.0;
        let ends = self.steps.iter().skip(1).map(|s| s.y).chain([self.last]);
        for (step, next) in self.steps.iter().zip(ends) {
            let (before, after) = (step.y[0] - theta, next[0] - theta);
            if before == 0.0 {
                return step.y[2];
            }
            if after == 0.0 {
                return next[2];
            }
            if before.signum() != after.signum() {
                let h = search::crossing(|h| self.ahead(&step.y, h)[0] - theta, 0.0, step.h, before, after);
                return self.ahead(&step.y, h)[2];
            }
        }
        let goal = self.end().1;
        let (left, last) = ((theta - goal).abs(), (self.last[0] - goal).abs());
        if lands && left <= last && (theta - goal) * (self.last[0] - goal) >= 0.0 {
            let [time, power] = self.tail;
            let part =
                if time.is_finite() { time * (1.0 - (left / last).powf(power)) } else { f64::INFINITY };
            return self.last[2] + part;
        }
        f64::NAN
    }

    /// The state at a time, its Omega and |V|.
    pub fn state(&self, t: f64) -> Option<(State, f64, f64)> {
        let whole = self.end().2;
        if t.is_nan() || t < 0.0 || t > whole * (1.0 + super::SLACK) {
            return None;
        }
        let i = self.steps.partition_point(|s| s.t <= t);
        let y = match self.steps.get(i) {
            Some(step) => {
                let miss = |h: f64| self.ahead(&step.y, h)[2] - t;
                let h = search::crossing(miss, 0.0, step.h, step.y[2] - t, step.t - t);
                self.ahead(&step.y, h)
            }
            None if self.tail[1] != 0.0 => return self.flat(t),
            None => self.last,
        };
        Some(self.turned(self.told(y[0], y[1])))
    }

    fn turned(&self, (y, rate, speed): (State, f64, f64)) -> (State, f64, f64) {
        (State { w1: self.turns * y.w1, w3: self.turns * y.w3, ..y }, self.turns * rate, speed)
    }

    fn told(&self, theta: f64, rate: f64) -> (State, f64, f64) {
        let Known { turning: [w1, w3], speed, .. } = self.at(theta, rate);
        (State { theta, w1, w2: 0.0, w3 }, rate, speed)
    }

    /// The state in the tail: Omega goes with the root of what is left, of a ball it stays.
    fn flat(&self, t: f64) -> Option<(State, f64, f64)> {
        let ([time, power], goal) = (self.tail, self.end().1);
        let left =
            if time.is_finite() { (1.0 - (t - self.last[2]) / time).max(0.0).powf(1.0 / power) } else { 1.0 };
        let theta = goal + (self.last[0] - goal) * left;
        if self.ball {
            let (mut y, rate, speed) = self.told(self.last[0], self.last[1]);
            (y.theta, y.w1) = (theta, y.w1 * left);
            return Some(self.turned((y, rate, speed * left)));
        }
        let (near, _, speed) = self.told(self.last[0], self.last[1]);
        let root = left.sqrt();
        let y = State { theta, w1: near.w1 * root, w2: 0.0, w3: near.w3 };
        Some(self.turned((y, self.last[1] / root, speed)))
    }
}

/// The body as the drift takes it, and its first numbers.
pub(super) fn begin(body: &Body, y: &State, losses: &Losses) -> Result<(Circular<f64>, [f64; 3]), Error> {
    let kappa = stability::rolling(body, y);
    let refused = |name, value, expected| Err(Error::OutOfRange { name, value, expected });
    let rate = y.precession();
    if kappa.is_nan() && y.w2 != 0.0 {
        return refused("w2", y.w2, "0: a steady state does not tilt, and a drift does not nod");
    }
    if kappa.is_nan() || rate == 0.0 {
        let tilting = crate::rolling::derivative(body, y).w2;
        return refused("theta''", -tilting, "a steady state of rolling: no tilting, and a precession");
    }
    if kappa <= 0.0 {
        return refused("kappa", kappa, "kappa > 0: a state that is stable by rolling");
    }
    let mut of = Circular::new(&body.shape(), !body.is_sharp(), Couples::of(losses, |x| x));
    // turned the other way it is the same
    let rate = rate.abs();
    of.signs = of.at(y.theta, rate).going.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
    Ok((of, [y.theta, rate, 0.0]))
}

/// The time that is left on the way to a face, and its power.
pub(super) fn tail(theta: f64, here: &Known<f64>, later: impl FnOnce() -> (f64, Known<f64>)) -> [f64; 2] {
    let slowness = |known: &Known<f64>| (known.rates[2] / known.rates[0]).abs();
    let left = |theta: f64| if theta < 1.0 { theta } else { PI - theta };
    let (next, then) = later();
    let power = 1.0 + (slowness(&then) / slowness(here)).ln() / (left(next) / left(theta)).ln();
    let time = if power > 0.02 { left(theta) * slowness(here) / power } else { f64::INFINITY };
    [time, power.max(f64::MIN_POSITIVE)]
}

/// What must stay positive on the way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Margins {
    pub side: f64,
    /// Whether what is dry ends where the contact stops running, or drilling.
    pub dry: [bool; 2],
}

impl Margins {
    pub const ENDS: [End; 4] = [End::StabilityLost, End::Side, End::ContactStops, End::DrillingStops];

    pub fn of(body: &Body, losses: &Losses) -> Self {
        let range = body.theta_max();
        let [dry, _, rolling, drilling, ..] = losses.coefficients.map(|x| x > 0.0);
        Self { side: if range < PI { range } else { 4.0 }, dry: [dry || rolling, drilling] }
    }

    pub fn all(&self, known: &Known<f64>, theta: f64) -> [f64; 4] {
        let [runs, drills] = known.going;
        let [dry_run, dry_drill] = self.dry;
        [
            known.stiffness,
            self.side - theta,
            if dry_run { runs } else { 1.0 },
            if dry_drill { drills } else { 1.0 },
        ]
    }

    fn least(&self, known: &Known<f64>, theta: f64) -> f64 {
        self.all(known, theta).into_iter().fold(1.0, f64::min)
    }
}
