//! The slow drift of a body that rolls without slipping and without nutation.
//!
//! ```text
//! (theta, Omega, w3, t) over the way x of `circular`, with steps of eighth order
//! tail   unit = theta |dt/dtheta|,   dt/dtheta ~ theta^(q - 1),   theta ~ (1 - q t/unit)^(1/q)
//!        w1 ~ theta^p1,   w3 ~ theta^p3
//! ```
//! Near a face or a pole all numbers go as powers of theta, and under rolling resistance theta itself goes as a high
//! power of the time that is left. The steps go on until this time is below rounding, or theta below 1e-140; the tail
//! describes the rest. The end of a drift within a step is found by trial steps of different lengths from the start of
//! that step.
//!
//! Error: 1e-10 of the time; up to 0.99 of the time also of theta, w1 and Omega, and of w3 over |w|. `test_late_drifts`
//! compares the drift with 20 digits, and `benches/drifts.py` with DOP853 on (theta, w1, w3).

use super::DriftState;
use super::circular::{CirclePoint, Circular, Numbers};
use super::ends::End;
use crate::body::Body;
use crate::error::Error;
use crate::loss::{Couples, Losses};
use crate::number::{Real, here};
use crate::rk8;
use crate::search;
use crate::stability;
use crate::state::State;
use core::f64::consts::PI;

/// Allowed error of a step, relative to the numbers.
pub(super) const TOLERANCE: f64 = 1e-13;

/// The tail begins where the time per e-fold of the inclination falls below the fraction `LITTLE` of the time so far,
/// and at the latest at the inclination `LAST`. In air alone, which lets the face come near for ever, it begins at the
/// fraction `FLAT` of the first inclination. The condition on the time counts only below the inclination `LOW`.
pub(super) const LITTLE: f64 = 1e-16;
const LAST: f64 = 1e-140;
const FLAT: f64 = 1e-11;
pub(super) const LOW: f64 = 1e-3;

/// Exponent of the tail up to which, in air alone, the face never lands.
const SLOW: f64 = 0.02;

/// Sine of the inclination below which a few correct digits of the remaining time are enough.
const NEARLY_FLAT: f64 = 1e-6;

/// Inclination, in radians, above which the inclination is counted from the other end of [0, pi].
pub(super) const TURN: f64 = 1.8;

/// Greatest number of steps of one drift.
const MOST: usize = 5000;

/// Lengths in x of the first step and of the longest step.
pub(super) const STEPS: [f64; 2] = [0.02, 1.5];

/// The error of a step over its allowed error. For theta, Omega and w3 the latter is relative to the smaller of the
/// number and its distance from the start, so that the time of a short drift is as precise; for the time it is relative
/// to the time.
#[inline(always)]
pub(super) fn error<T: Real>(start: &Numbers<T>, y: &Numbers<T>, made: &rk8::Step<T, 4>) -> T {
    let number = here(
        #[inline(always)]
        |x: f64| y[0].splat(x),
    );
    let tolerance = number(TOLERANCE);
    // Since w3 may vanish, its error is taken relative to a hundredth of w1 at least.
    let least = [number(0.0), number(0.0), y[0] * y[1] * number(1e-2), number(0.0)];
    made.error(
        #[inline(always)]
        |i| {
            let next = y[i] + made.change[i];
            let own = next.abs().max(y[i].abs()).max(least[i]);
            let moved = (next - start[i]).abs().max((y[i] - start[i]).abs());
            number(1.0) / (own.min(moved.max(own * number(1e-6))) * tolerance)
        },
        1.0,
    )
}

/// A place of a drift: its numbers, and `far`, which is -1 where the inclination is counted from pi, else 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct DriftPlace<T> {
    pub y: Numbers<T>,
    pub far: T,
}

impl<T: Real> DriftPlace<T> {
    /// Converts an inclination to the counting of this place, or back.
    #[inline(always)]
    fn counted(&self, theta: T) -> T {
        theta.splat(0.0).select_lt(self.far, theta, theta.splat(PI) - theta)
    }

    #[inline(always)]
    pub fn theta(&self) -> T {
        self.counted(self.y[0])
    }
}

impl DriftPlace<f64> {
    /// The same place with the inclination counted from the other end if it is above `TURN`.
    fn turned(self) -> Self {
        let [theta, rate, w3, t] = self.y;
        if theta < TURN { self } else { Self { y: [PI - theta, rate, w3, t], far: -self.far } }
    }
}

/// A step of a drift: its start, its length in x, and the numbers at its end.
#[derive(Debug, Clone, Copy)]
struct DriftStep {
    from: DriftPlace<f64>,
    h: f64,
    to: Numbers<f64>,
}

/// The rest of a drift after its last step, up to a face that lands or a ball that stands on its pole.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tail {
    /// theta |dt/dtheta|, and the exponent of the remaining time as a power of theta; with an exponent of 0 or less the
    /// face never lands.
    pub unit: f64,
    pub power: f64,
    /// Whether the face lands in a finite time.
    lands: bool,
    /// The exponents of w1 and w3 as powers of theta.
    turning: [f64; 2],
}

impl Tail {
    pub fn new(
        here: &DriftPlace<f64>,
        known: &CirclePoint<f64>,
        margins: &Margins<f64>,
        later: impl FnOnce() -> (Numbers<f64>, CirclePoint<f64>),
    ) -> Self {
        let unit =
            |y: &Numbers<f64>, known: &CirclePoint<f64>| (y[0] * known.rates[3] / known.rates[0]).abs();
        let (y, [theta, rate, w3, _]) = (here.y, known.rates);
        let fold = theta / y[0];
        let axial = if y[2] == 0.0 { 0.0 } else { w3 / y[2] / fold };
        let (first, (next, then)) = (unit(&y, known), later());
        let power = (unit(&next, &then) / first).ln() / (next[0] / y[0]).ln();
        // An exponent that is only a rounding error counts as 0.
        let power = if power.abs() < 1e-9 { 0.0 } else { power };
        let lands = power > margins.slow;
        Self { unit: first, power, lands, turning: [1.0 + rate / y[1] / fold, axial] }
    }

    /// The time that the tail takes; infinite if the face never lands.
    pub fn time(&self) -> f64 {
        if self.lands { self.unit / self.power } else { f64::INFINITY }
    }

    /// The time after which the fraction `left` of the inclination remains.
    fn until(&self, left: f64) -> f64 {
        if self.power == 0.0 {
            -self.unit * left.ln()
        } else {
            self.unit * (1.0 - left.powf(self.power)) / self.power
        }
    }

    /// The fraction of the inclination that remains after a time.
    fn left(&self, t: f64) -> f64 {
        let part = t / self.unit;
        if self.power == 0.0 {
            (-part).exp()
        } else {
            (1.0 - self.power * part).max(0.0).powf(1.0 / self.power)
        }
    }
}

/// The drift of a body that rolls.
#[derive(Debug, Clone)]
pub(super) struct Roll {
    of: Circular<f64>,
    steps: Vec<DriftStep>,
    end: End,
    last: DriftPlace<f64>,
    tail: Option<Tail>,
    /// The inclination of the end, if the drift ends at the side.
    side: Option<f64>,
    ball: bool,
    /// -1 for a body with w1 < 0, whose drift is the mirror image of the computed one; else 1.
    turns: f64,
}

impl Roll {
    pub fn new(body: &Body, y: &State, losses: &Losses) -> Result<Self, Error> {
        let (of, start) = begin(body, y, losses)?;
        let (ball, turns) = (body.is_ball(), y.w1.signum());
        let (steps, end) = (Vec::new(), End::Face);
        let mut roll = Self { of, steps, end, last: start, tail: None, side: None, ball, turns };
        roll.run(body, losses)?;
        Ok(roll)
    }

    fn run(&mut self, body: &Body, losses: &Losses) -> Result<(), Error> {
        let (mut start, mut here, mut h) = (self.last.y, self.last, STEPS[0]);
        let margins = Margins::of(body, losses, start[0]);
        while self.steps.len() < MOST {
            let made = self.step(&here, h);
            let off = error(&start, &here.y, &made);
            if off.is_nan() || off >= 1.0 {
                h *= rk8::growth(off);
                // A step as short as this is limited by rounding alone, and nearly flat the tail is precise enough.
                if h < 1e-4 && here.y[0].sin() < NEARLY_FLAT {
                    return self.land(here, &margins);
                }
                if h < 1e-14 {
                    break;
                }
                continue;
            }
            let to = self.of.kept(&core::array::from_fn(|i| here.y[i] + made.change[i]), here.far);
            let next = DriftPlace { y: to, far: here.far };
            let known = self.at(&next);
            if margins.least(&known, next.theta()) < 0.0 {
                return self.finish(here, h, &margins);
            }
            self.steps.push(DriftStep { from: here, h, to });
            here = next.turned();
            if here.far != next.far {
                start[0] = PI - start[0];
            }
            h = (h * rk8::growth(off)).min(STEPS[1]);
            let unit = (to[0] * known.rates[3] / known.rates[0]).abs();
            if to[0] < margins.last || to[0] < LOW && unit < LITTLE * to[3] {
                return self.land(here, &margins);
            }
        }
        if here.y[0] < NEARLY_FLAT {
            return self.land(here, &margins);
        }
        Err(Error::Lost { theta: here.theta() })
    }

    /// The rates at a place; this is a separate function, because a step contains a dozen calls.
    #[inline(never)]
    fn at(&self, here: &DriftPlace<f64>) -> CirclePoint<f64> {
        self.of.at(&here.y, here.far)
    }

    fn step(&self, here: &DriftPlace<f64>, h: f64) -> rk8::Step<f64, 4> {
        let far = here.far;
        let rate =
            |y: &Numbers<f64>, rate: &mut Numbers<f64>| *rate = self.at(&DriftPlace { y: *y, far }).rates;
        let mut first = [0.0; 4];
        rate(&here.y, &mut first);
        rk8::step::<{ rk8::LOOPS }, _, _>(rate, &here.y, &first, h, &mut [first; rk8::STAGES])
    }

    fn ahead(&self, here: &DriftPlace<f64>, h: f64) -> DriftPlace<f64> {
        let made = self.step(here, h);
        DriftPlace { y: core::array::from_fn(|i| here.y[i] + made.change[i]), far: here.far }
    }

    /// Ends the drift within a step, at the first margin that vanishes there.
    fn finish(&mut self, here: DriftPlace<f64>, h: f64, margins: &Margins<f64>) -> Result<(), Error> {
        let margins_at = |place: &DriftPlace<f64>| margins.all(&self.at(place), place.theta());
        let all = |h: f64| margins_at(&self.ahead(&here, h));
        let (before, after) = (margins_at(&here), all(h));
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
        self.last = self.ahead(&here, first.0);
        self.steps.push(DriftStep { from: here, h: first.0, to: self.last.y });
        self.end = first.1;
        self.side = (self.end == End::Side).then_some(margins.side);
        Ok(())
    }

    /// Ends the drift with a tail, the rest of the way to the face as powers of the inclination.
    fn land(&mut self, here: DriftPlace<f64>, margins: &Margins<f64>) -> Result<(), Error> {
        let tail = Tail::new(&here, &self.at(&here), margins, || {
            let later = self.ahead(&here, 0.5);
            (later.y, self.at(&later))
        });
        self.end = if self.ball { End::Upright } else { End::Face };
        (self.last, self.tail) = (here, Some(tail));
        Ok(())
    }

    /// The end of the drift, its inclination and its time.
    pub fn end(&self) -> (End, f64, f64) {
        let time = self.last.y[3];
        match self.tail {
            Some(tail) => (self.end, self.last.counted(0.0), time + tail.time()),
            None => (self.end, self.side.unwrap_or(self.last.theta()), time),
        }
    }

    /// The first time at which the drift reaches an inclination; NaN if the drift never does.
    pub fn time(&self, theta: f64) -> f64 {
        if theta.is_nan() {
            return f64::NAN;
        }
        for step in &self.steps {
            let goal = step.from.counted(theta);
            let (before, after) = (step.from.y[0] - goal, step.to[0] - goal);
            if before == 0.0 {
                return step.from.y[3];
            }
            if after == 0.0 {
                return step.to[3];
            }
            if before.signum() != after.signum() {
                let miss = |h: f64| self.ahead(&step.from, h).y[0] - goal;
                let h = search::crossing(miss, 0.0, step.h, before, after);
                return self.ahead(&step.from, h).y[3];
            }
        }
        if self.side == Some(theta) {
            return self.last.y[3];
        }
        let goal = self.last.counted(theta);
        match self.tail {
            Some(tail) if (0.0..=self.last.y[0]).contains(&goal) => {
                self.last.y[3] + tail.until(goal / self.last.y[0])
            }
            _ => f64::NAN,
        }
    }

    /// The state at a time.
    pub fn at_time(&self, t: f64) -> Option<DriftState> {
        let whole = self.end().2;
        if t.is_nan() || t < 0.0 || t > whole * (1.0 + super::SLACK) {
            return None;
        }
        let i = self.steps.partition_point(|s| s.to[3] <= t);
        let place = match (self.steps.get(i), self.tail) {
            (Some(step), _) => {
                let miss = |h: f64| self.ahead(&step.from, h).y[3] - t;
                let h = search::crossing(miss, 0.0, step.h, step.from.y[3] - t, step.to[3] - t);
                self.ahead(&step.from, h)
            }
            (None, Some(tail)) => return Some(self.landing(&tail, t)),
            (None, None) => self.last,
        };
        let CirclePoint { w1, speed, .. } = self.at(&place);
        let theta = if i < self.steps.len() { place.theta() } else { self.end().1 };
        Some(self.turned(State { theta, w1, w2: 0.0, w3: place.y[2] }, place.y[1], speed))
    }

    /// The state with Omega and |V|, for the body itself where its mirror image drifts.
    fn turned(&self, y: State, rate: f64, speed: f64) -> DriftState {
        let state = State { w1: self.turns * y.w1, w3: self.turns * y.w3, ..y };
        DriftState { state, precession: self.turns * rate, friction_coefficient: speed * rate.abs() }
    }

    /// The state at a time in the tail.
    fn landing(&self, tail: &Tail, t: f64) -> DriftState {
        let [last, rate, w3, from] = self.last.y;
        let left = tail.left(t - from);
        let [along, axial] = tail.turning.map(|power| if power == 0.0 { 1.0 } else { left.powf(power) });
        let (w1, w3) = (self.at(&self.last).w1 * along, w3 * axial);
        let (s, c) = (last * left).sin_cos();
        let speed = self.of.speed((s, self.last.far * c), w1, w3).abs();
        let y = State { theta: self.last.counted(last * left), w1, w2: 0.0, w3 };
        let power = tail.turning[0] - 1.0;
        let rate = if power.abs() < 1e-9 { rate } else { rate * left.powf(power) };
        self.turned(y, rate, speed)
    }
}

/// The equations of the drift of a body, and its first place.
pub(super) fn begin(
    body: &Body,
    y: &State,
    losses: &Losses,
) -> Result<(Circular<f64>, DriftPlace<f64>), Error> {
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
    // A body that precesses backwards drifts as its mirror image does.
    let mut here = DriftPlace { y: [y.theta, rate.abs(), y.w3 * rate.signum(), 0.0], far: 1.0 }.turned();
    // Steps of Newton's method take the state from at least six correct digits to all digits.
    for _ in 0..4 {
        here.y = of.settled(&here.y, here.far);
    }
    of.signs = of.at(&here.y, here.far).going.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
    Ok((of, here))
}

/// The conditions under which a drift goes on; each has a margin that must stay positive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Margins<T> {
    pub side: T,
    /// 1 if a dry law ends the drift where the contact stops running, and where the drilling stops, else 0.
    pub dry: [T; 2],
    /// The exponent of the tail up to which the face never lands, and the inclination below which the tail begins.
    pub slow: T,
    pub last: T,
}

impl Margins<f64> {
    pub const ENDS: [End; 4] = [End::StabilityLost, End::Side, End::ContactStops, End::DrillingStops];

    pub fn of(body: &Body, losses: &Losses, start: f64) -> Self {
        let range = body.theta_end();
        let [dry, viscous, rolling, drilling, _, _, film, layer] = losses.coefficients.map(|x| x > 0.0);
        let airy = !(dry || viscous || rolling || drilling || film || layer);
        let [slow, last] = if airy { [SLOW, start * FLAT] } else { [0.0, LAST] };
        let dry = [dry || rolling, drilling].map(|ends| f64::from(u8::from(ends)));
        Self { side: if range < PI { range } else { 4.0 }, dry, slow, last }
    }

    fn least(&self, known: &CirclePoint<f64>, theta: f64) -> f64 {
        self.all(known, theta).into_iter().fold(1.0, f64::min)
    }
}

impl<T: Real> Margins<T> {
    #[inline(always)]
    pub fn all(&self, known: &CirclePoint<T>, theta: T) -> [T; 4] {
        let [runs, drills] = known.going;
        let if_dry = here(
            #[inline(always)]
            |dry: T, going: T| dry.splat(0.5).select_lt(dry, going, dry.splat(1.0)),
        );
        [known.stiffness, self.side - theta, if_dry(self.dry[0], runs), if_dry(self.dry[1], drills)]
    }
}
