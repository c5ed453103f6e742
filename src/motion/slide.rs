//! A body while it slips: from a start, or from rest, to what ends the slip.
//!
//! ```text
//! y = (s, c, w1, w2, w3, u_h, u_2, t, heat; phi, psi, x, y)        in sigma, dt = |u|/(|u| + soft) dsigma
//! u = 0   reached as exp(-sigma); the last 1e-13 of it in a straight line
//! N0 = 0,   eps = 1,   theta = 0,   theta = theta_max                margins that turn negative
//! ```
//! [`rk8`] takes the steps; a margin that turns negative within a step, even if it is positive again at its end, is found on parts
//! of the step, as is the state at a time that is asked for. [`contact::slip`](crate::contact::slip) has the equations.
//!
//! Error: 1e-11 in states and 1e-12 in times; a test of `test_slip_reference` has 25 motions of 25 digits.

use super::leaving::Leaving;
use crate::body::{Body, Shape};
use crate::contact::slip::{Friction, Slipping};
use crate::error::Error;
use crate::number::{Dual, Real};
use crate::rk8::{self, growth, plus};
use crate::search::{crossing, least};
use crate::state::State;
use core::f64::consts::PI;
use fearless_simd::Simd;

/// What ends a slip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Halt {
    /// The last time is reached.
    Time,
    /// So many steps as were allowed have been made.
    Pause,
    /// The contact point comes to rest.
    Standstill,
    Face,
    Side,
    LiftOff,
    /// There is no unique force.
    Jam,
}

/// The margins, in their order.
const ENDS: [Halt; 4] = [Halt::Face, Halt::Side, Halt::LiftOff, Halt::Jam];

/// Slip is over where its speed has fallen below this share of mu.
const OVER: f64 = 1e-13;
/// Steps between two looks at whether to go on.
const PATIENCE: u64 = 256;
/// A step this short, beside the time that has passed, leads nowhere.
const SHORTEST: f64 = 1e-14;
/// Parts of the series by which a slip begins at which its margins are looked at.
const CLOSELY: usize = 16;

/// How a body slips, and what ends it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slide {
    pub law: Slipping<f64>,
    /// The same for numbers with a slope.
    sloped: Slipping<Dual<f64>>,
    theta_max: f64,
    ball: bool,
    sticks: bool,
    pub tol: f64,
}

/// A place on the way: numbers, what rounding took of them, how they change.
#[derive(Clone, Copy)]
pub(crate) struct Place<const N: usize> {
    pub y: [f64; N],
    carry: [f64; N],
    rate: [f64; N],
}

/// How a slip went.
pub(crate) struct Slid<const N: usize> {
    pub halt: Halt,
    /// The numbers where it ended; at a standstill with u = 0.
    pub y: [f64; N],
    /// The next step.
    pub step: f64,
    pub evaluations: u64,
}

impl Slide {
    pub fn new(body: &Body, friction: &Friction, tol: f64) -> Self {
        let law = Slipping::on(body, friction);
        let dual = |value: f64| Dual { value, slope: 0.0 };
        let sloped = Slipping::of(&law.shape.map(dual), dual(law.strength), law.dry);
        let (theta_max, ball) = (body.theta_max(), body.is_ball());
        Self { law, sloped, theta_max, ball, sticks: law.dry, tol }
    }

    /// The speed below which a slip is none.
    pub fn over(&self) -> f64 {
        if self.law.dry { OVER * self.law.strength.min(1.0) } else { 0.0 }
    }

    /// How all numbers change with sigma.
    #[inline(always)]
    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        self.law.rates(y, all);
        if N == 13 {
            let ([s, c, w1, w2, w3, u_h, u_2], pace) = (core::array::from_fn(|i| y[i]), all[7]);
            let rim = &self.law.shape.rim;
            let precession = w1 / s;
            let spin = w3 - c * precession;
            let (sin, cos) = y[9].sin_cos();
            let (out, on) = (u_h + rim.rho * w2, u_2 + rim.radius((s, c)) * spin);
            let pose = [precession, spin, out * cos - on * sin, out * sin + on * cos];
            all[9..].copy_from_slice(&pose.map(|x| pace * x));
        }
    }

    #[inline(always)]
    fn rates<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        let mut all = *y;
        self.write_rates(y, &mut all);
        all
    }

    #[inline(always)]
    fn step<const N: usize>(&self, from: &Place<N>, h: f64) -> rk8::Step<f64, N> {
        rk8::step(
            #[inline(always)]
            |y: &[f64; N], rate: &mut [f64; N]| self.write_rates(y, rate),
            &from.y,
            &from.rate,
            h,
        )
    }

    /// The energy of some numbers.
    pub fn energy<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let state = State { theta: y[0].atan2(y[1]), w1: y[2], w2: y[3], w3: y[4] };
        self.law.energy(&state, [y[5], y[6]])
    }

    pub fn place<const N: usize>(&self, y: [f64; N]) -> Place<N> {
        Place { y, carry: [0.0; N], rate: self.rates(&y) }
    }

    /// After a part of a step of `h` from a place.
    fn part<const N: usize>(&self, from: &Place<N>, h: f64) -> [f64; N] {
        let made = self.step(from, h);
        plus(&from.y, &from.carry, &made.change).0
    }

    /// What must stay positive, and how it changes with sigma.
    fn margins<const N: usize>(&self, place: &Place<N>) -> [Dual<f64>; 4] {
        let dual = |i: usize| Dual { value: place.y[i], slope: place.rate[i] };
        let [s, c, w1, w2, w3, u_h, u_2] = core::array::from_fn(dual);
        let (at, _) = self.sloped.at((s, c), [w1, w2, w3], [u_h, u_2]);
        let one = s.splat(1.0);
        let (high, far) = self.theta_max.sin_cos();
        let side = if self.theta_max < PI { s.splat(high) * c - s.splat(far) * s } else { one };
        [if self.ball { one } else { s }, side, at.free, at.room]
    }

    /// The margin `i` of some numbers.
    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        let [s, c, w1, w2, w3, u_h, u_2, ..] = core::array::from_fn::<_, 9, _>(|i| y[i]);
        match ENDS[i] {
            Halt::Face => s,
            Halt::Side => self.theta_max.sin() * c - self.theta_max.cos() * s,
            end => {
                let (at, _) = self.law.at((s, c), [w1, w2, w3], [u_h, u_2]);
                if end == Halt::LiftOff { at.free } else { at.room }
            }
        }
    }

    /// The end of a slip that has none yet: what margin fails at its start.
    pub fn at_start(&self, y: &State, u: [f64; 2]) -> Option<Halt> {
        let (s, c) = y.theta.sin_cos();
        let (at, _) = self.law.at((s, c), [y.w1, y.w2, y.w3], u);
        let rises = y.w2 > 0.0 || (y.w2 == 0.0 && at.w[1] > 0.0);
        let side = self.theta_max - y.theta;
        if at.room <= 0.0 {
            Some(Halt::Jam)
        } else if self.theta_max < PI && (side < 0.0 || (side == 0.0 && !rises)) {
            Some(Halt::Side)
        } else if at.free <= 0.0 {
            Some(Halt::LiftOff)
        } else {
            None
        }
    }

    /// The first margin that fails within a step of `h`, as a share of it; its end's margins are known.
    fn failure<const N: usize>(
        &self,
        from: &Place<N>,
        h: f64,
        (before, after): (&[Dual<f64>; 4], &[Dual<f64>; 4]),
    ) -> Option<(f64, Halt)> {
        let mut first: Option<(f64, Halt)> = None;
        for i in 0..4 {
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
                    first = Some((x, ENDS[i]));
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

    /// The rest of a slip that is nearly none, in a straight line: at its end u = 0. None where it does not end.
    pub fn stopped<const N: usize>(&self, place: &Place<N>) -> Option<[f64; N]> {
        let [u_h, u_2] = [place.y[5], place.y[6]];
        let speed = u_h.hypot(u_2);
        // of the rate of the speed with sigma and of that of time
        let slowing = -(u_h * place.rate[5] + u_2 * place.rate[6]) / speed;
        if speed > self.over() || !self.sticks {
            return None;
        }
        if slowing <= 0.0 && speed > 0.0 {
            return None;
        }
        let left = if speed > 0.0 { speed / slowing } else { 0.0 };
        let mut y: [f64; N] = core::array::from_fn(|i| place.y[i] + left * place.rate[i]);
        (y[5], y[6]) = (0.0, 0.0);
        Some(y)
    }

    /// What a step errs by, where 1 is allowed: in units of `tol`, of the largest speed where that is more than 1.
    #[inline(always)]
    pub fn error<T: Real, const N: usize>(tol: T, y: &[T; N], made: &rk8::Step<T, N>, dry: bool) -> T {
        let one = tol.splat(1.0);
        let slip = y[5].mac(y[5], y[6] * y[6]).sqrt();
        let fastest = (2..5).fold(one, |most: T, i| most.max(y[i].abs())).max(slip);
        let (per_tol, per_speed) = (one / tol, one / (tol * fastest));
        // a slip that vanishes keeps its direction
        let per_slip = if dry { per_speed.max(one.splat(1e3) / slip) } else { per_speed };
        let (mut fifth, mut third) = (tol.splat(0.0), tol.splat(1e-60));
        for i in 0..N {
            let per = match i {
                0 | 1 | 7 => per_tol,
                5 | 6 => per_slip,
                _ => per_speed,
            };
            let (a, b) = (made.fifth[i] * per, made.third[i] * per);
            (fifth, third) = (a.mac(a, fifth), b.mac(b, third));
        }
        fifth / ((fifth + one.splat(0.01) * third) * one.splat(N as f64)).sqrt()
    }

    /// On from a place: `write` is given the numbers at each of the `times` that is reached; then what ends the slip, at the
    /// latest the last of them; or a pause after so many steps. None if it is told to stop.
    pub fn run<const N: usize>(
        &self,
        here: Place<N>,
        (first_step, most): (Option<f64>, u64),
        times: &[f64],
        write: &mut dyn FnMut(&[f64; N]),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Slid<N>>, Error> {
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
    ) -> Result<Option<Slid<N>>, Error> {
        let end = times.last().copied().unwrap_or(here.y[7]);
        let mut next = times.partition_point(|t| *t < here.y[7]);
        let mut margins = self.margins(&here);
        let mut h = first_step.unwrap_or_else(|| first(&here.y));
        let (mut evaluations, mut last) = (1, here.y);
        for steps in 1u64.. {
            if steps.is_multiple_of(PATIENCE) && !go_on() {
                return Ok(None);
            }
            if next == times.len() {
                return Ok(Some(Slid { halt: Halt::Time, y: last, step: h, evaluations }));
            }
            if steps > most {
                return Ok(Some(Slid { halt: Halt::Pause, y: here.y, step: h, evaluations }));
            }
            let made = self.step(&here, h);
            evaluations += 12;
            let error = Self::error(self.tol, &here.y, &made, self.law.dry);
            let (y, carry) = plus(&here.y, &here.carry, &made.change);
            let after = Place { y, carry, rate: self.rates(&y) };
            if error.is_nan() || error > 1.0 || after.rate.iter().any(|x| x.is_nan()) {
                h *= growth(error).min(0.7);
                if h < SHORTEST * (1.0 + here.y[7]) {
                    // towards a force that grows without bound
                    let inertia = self.law.shape.i1;
                    let halt = if margins[3].value < 0.1 * inertia {
                        Halt::Jam
                    } else {
                        return Err(Error::Lost { theta: here.y[0].atan2(here.y[1]) });
                    };
                    return Ok(Some(Slid { halt, y: here.y, step: h, evaluations }));
                }
                continue;
            }
            let ahead = self.margins(&after);
            let failure = self.failure(&here, h, (&margins, &ahead));
            let stop = match failure {
                Some((x, halt)) => Some((halt, self.part(&here, x * h))),
                None => self.stopped(&after).map(|y| (Halt::Standstill, y)),
            };
            let until = stop.as_ref().map_or(after.y[7], |(_, y)| y[7]);
            while next < times.len() && times[next] <= until {
                let t = times[next];
                let stopped =
                    stop.filter(|(halt, y)| *halt == Halt::Standstill && t > after.y[7] && t <= y[7]);
                last = stopped.map_or_else(|| self.at_time(&here, &after, h, t), |(_, y)| y);
                last[7] = t;
                write(&last);
                next += 1;
            }
            if let Some((halt, y)) = stop.filter(|(_, y)| y[7] <= end) {
                return Ok(Some(Slid { halt, y, step: h, evaluations }));
            }
            (here, margins) = (after, ahead);
            h = (h * growth(error)).min(longest(&here.y, &self.law.shape));
        }
        unreachable!("steps go on until something ends them")
    }

    /// How long the series by which a slip begins may be used: not beyond anything that ends the slip.
    pub(super) fn safe(&self, series: &Leaving) -> f64 {
        let mut until = series.until;
        for _ in 0..60 {
            let part = |k: usize| until * k as f64 / CLOSELY as f64;
            let margins: Vec<[f64; 4]> = (0..=CLOSELY)
                .map(|k| {
                    let y: [f64; 9] = series.at(part(k));
                    // at rest the direction is that of a moment later
                    let y = if k == 0 { [y, series.at(1e-3 * part(1))] } else { [y, y] };
                    core::array::from_fn(|i| {
                        if self.watches(i) { self.margin(&y[usize::from(i > 1)], i) } else { 1.0 }
                    })
                })
                .collect();
            let fails = |i: usize| {
                let falls = (1..=CLOSELY).any(|k| margins[k][i] <= 0.0);
                // a margin that is least within, and small beside what it varies by
                let dips = margins.windows(3).any(|m| {
                    let (a, b, c) = (m[0][i], m[1][i], m[2][i]);
                    b < a && b < c && b < 4.0 * (a.max(c) - b)
                });
                falls || dips
            };
            if !(0..4).any(fails) {
                break;
            }
            until *= 0.5;
        }
        until
    }

    /// Whether a margin can end a slip of this body at all.
    fn watches(&self, i: usize) -> bool {
        match ENDS[i] {
            Halt::Face => !self.ball,
            Halt::Side => self.theta_max < PI,
            _ => true,
        }
    }

    /// The times within the series by which a slip begins, written; and the numbers where the series ends.
    pub(super) fn leave<const N: usize>(
        &self,
        series: &Leaving,
        until: f64,
        start: &[f64; N],
        times: &[f64],
        write: &mut dyn FnMut(&[f64; N]),
    ) -> [f64; N] {
        let at = |t: f64| {
            let mut y: [f64; N] = series.at(t);
            y[7] += start[7];
            y[8] += start[8];
            if N == 13 {
                // the series has its own angles and its own place
                let (sin, cos) = start[9].sin_cos();
                let (px, py) = (y[11], y[12]);
                y[9] += start[9];
                y[10] += start[10];
                y[11] = start[11] + px * cos - py * sin;
                y[12] = start[12] + px * sin + py * cos;
            }
            y
        };
        let last = times.last().map_or(0.0, |t| t - start[7]);
        let until = until.min(last);
        let count = times.partition_point(|t| *t <= start[7] + until);
        for t in &times[..count] {
            let mut y = at(t - start[7]);
            y[7] = *t;
            write(&y);
        }
        at(until)
    }
}

/// A first step that is short enough, since the next ones grow fast.
pub(crate) fn first<const N: usize>(y: &[f64; N]) -> f64 {
    0.02 / (1.0 + y[2].abs().max(y[3].abs()).max(y[4].abs()))
}

/// The longest step that lets rounding alone: not three radians of precession, nor of the nutation I3 w3/I1 of a free body.
#[inline(always)]
pub(crate) fn longest<T: Real, const N: usize>(y: &[T; N], shape: &Shape<T>) -> T {
    let one = y[0].splat(1.0);
    let nutation = (y[4] * shape.i3 / shape.i1).abs();
    one.splat(3.0) / y[2].abs().max(y[3].abs()).max(nutation).max(one)
}
