//! The time along a path with a known slowness |dt/dtheta|, by quadrature in panels, and the place at a given time.
//!
//! ```text
//! t(theta) = int |dt/dtheta| dtheta                                         sixteen nodes of Gauss on each panel
//! begin    theta = start +- d (exp(x) - 1)       d is the distance to the nearest singularity behind the start
//! end      theta = goal -+ b (-x)^p              -1 <= x <= 0; p = 2 or 4 where the slowness is a root of the distance
//! fade     theta = goal -+ b exp(-x)             x >= 0; for a goal that is never reached
//! ```
//! A panel is halved until the sum of its two halves agrees with the whole; the halves are kept. A place is given by
//! its distance from the start or from the goal, so that no digits are lost near either. A time is inverted by Newton's
//! method between bounds, with the slowness as the derivative; the first estimate comes from the integral of the
//! polynomial through the nodes.
//!
//! Error: 1e-13 of the time.

use super::ends::Goal;
use super::gauss::{self, Gauss};
use crate::number::Sum;
use std::sync::LazyLock;

pub(super) static SIXTEEN: LazyLock<Gauss<16>> = LazyLock::new(Gauss::new);

/// A part of the path with its own variable x.
#[derive(Debug, Clone, Copy)]
enum ClockLeg {
    Begin { behind: f64 },
    End { length: f64, power: i32 },
    Fade { length: f64 },
}

/// A point of the path: its inclination, and its distance from the goal where that is known more precisely.
#[derive(Debug, Clone, Copy)]
pub(super) struct WayPoint {
    pub theta: Sum<f64>,
    pub left: Option<f64>,
}

/// A panel from x to x + width: the time `t` at its start, the time that it takes, and dt/dx as a series (`slow`).
#[derive(Debug, Clone, Copy)]
struct TimePanel {
    leg: ClockLeg,
    x: f64,
    width: f64,
    t: f64,
    time: f64,
    slow: [f64; 16],
}

/// The time along a path from `start` to its goal.
#[derive(Debug, Clone)]
pub(super) struct DriftClock {
    start: f64,
    goal: Goal,
    /// 1 if the inclination grows, -1 if it falls.
    way: f64,
    panels: Vec<TimePanel>,
    /// The tail behind the last panel, if the goal is never reached: the time and the distance from the goal at its
    /// start, the slowness times that distance, and the power.
    tail: Option<[f64; 4]>,
}

/// Number of panels of a path above which no panel is halved any more.
const MOST: usize = 1000;

/// Relative difference of a panel and its halves below which the difference may be a rounding error.
const ROUNDING: f64 = 1e-10;

/// Width in x below which a panel is not halved further if its time overflows.
const NARROW: f64 = 1.0;

/// Relative difference up to which a panel and its halves agree.
const AGREE: f64 = 3e-14;

impl DriftClock {
    /// The clock of a path: `slowness` is |dt/dtheta| at a point, `behind` the distance from the start back to the
    /// nearest singularity, and `several` says whether several laws take energy.
    pub fn new(
        start: f64,
        goal: Goal,
        behind: f64,
        several: bool,
        slowness: &impl Fn(&WayPoint) -> f64,
    ) -> Self {
        let way = if goal.theta.hi > start { 1.0 } else { -1.0 };
        let mut clock = Self { start, goal, way, panels: Vec::new(), tail: None };
        let whole = ((goal.theta - start.into()).hi * way).max(0.0);
        if whole == 0.0 {
            return clock;
        }
        // The length from the rounded middle to the goal is exact, so that both legs meet.
        let middle = start + way * 0.5 * whole;
        let length = ((goal.theta - middle.into()).hi * way).max(0.0);
        let begin = ClockLeg::Begin { behind };
        clock.integrate(begin, 0.0, ((middle - start) * way / behind).ln_1p(), slowness);
        if goal.finite {
            // A half-integer power of the distance needs p = 2; quarter powers and several laws need p = 4.
            let whole_power = (2.0 * goal.power).fract() == 0.0;
            let power = if goal.power.fract() == 0.0 && !several {
                1
            } else if whole_power && !several {
                2
            } else {
                4
            };
            let power = if matches!(goal.end, super::End::Side | super::End::Lowest) { 1 } else { power };
            clock.integrate(ClockLeg::End { length, power }, -1.0, 1.0, slowness);
        } else {
            let least = if several { 1e-150 } else { 1e-34 };
            let deep = (length / least).ln().max(0.0);
            let leg = ClockLeg::Fade { length };
            clock.integrate(leg, 0.0, deep, slowness);
            let (spot, rate) = clock.spot(leg, deep);
            let last = clock.stops();
            clock.tail = Some([last, length * (-deep).exp(), slowness(&spot) * rate, -goal.power]);
        }
        clock
    }

    /// Adds the panels of a leg.
    fn integrate(&mut self, leg: ClockLeg, x: f64, width: f64, slowness: &impl Fn(&WayPoint) -> f64) {
        // The stack holds the panels to be computed, the next one on top, each with the misfit of its parent.
        let mut todo = vec![(x, width, self.gauss(leg, x, width, slowness), f64::INFINITY)];
        while let Some((x, width, whole, parent)) = todo.pop() {
            let half = 0.5 * width;
            let slow = [self.slow(leg, x, half, slowness), self.slow(leg, x + half, half, slowness)];
            let parts = slow.map(|slow| half * mean(&slow));
            let sum = parts[0] + parts[1];
            let t = self.stops();
            let miss = (sum - whole).abs() / sum;
            // A misfit that halving does not reduce is rounding, as where E' is small beside its terms.
            let rounding = miss < ROUNDING && miss > 0.3 * parent;
            let little = sum < 1e-17 * t;
            // A panel whose time overflows is halved down to `NARROW`, so that the times before it keep all their
            // digits.
            let last = self.panels.len() > MOST || !sum.is_finite() && width < NARROW;
            if miss <= AGREE || rounding || little || last || sum == 0.0 {
                for (i, slow) in slow.iter().enumerate() {
                    let (x, t) = if i == 0 { (x, t) } else { (x + half, t + parts[0]) };
                    self.panels.push(TimePanel {
                        leg,
                        x,
                        width: half,
                        t,
                        time: parts[i],
                        slow: SIXTEEN.series(slow),
                    });
                }
            } else {
                todo.push((x + half, half, parts[1], miss));
                todo.push((x, half, parts[0], miss));
            }
        }
    }

    /// The time from x to x + width.
    fn gauss(&self, leg: ClockLeg, x: f64, width: f64, slowness: &impl Fn(&WayPoint) -> f64) -> f64 {
        mean(&self.slow(leg, x, width, slowness)) * width
    }

    /// dt/dx at the nodes between x and x + width.
    fn slow(&self, leg: ClockLeg, x: f64, width: f64, slowness: &impl Fn(&WayPoint) -> f64) -> [f64; 16] {
        SIXTEEN.nodes.map(|node| {
            let (spot, rate) = self.spot(leg, x + width * node);
            slowness(&spot) * rate
        })
    }

    /// The point at x, and |dtheta/dx|.
    fn spot(&self, leg: ClockLeg, x: f64) -> (WayPoint, f64) {
        let from_goal =
            |left: f64| WayPoint { theta: self.goal.theta - (self.way * left).into(), left: Some(left) };
        match leg {
            ClockLeg::Begin { behind } => {
                let gone = behind * x.exp_m1();
                (WayPoint { theta: Sum::of(self.start, self.way * gone), left: None }, behind + gone)
            }
            ClockLeg::End { length, power } => {
                let left = length * (-x).powi(power);
                (from_goal(left), length * f64::from(power) * (-x).powi(power - 1))
            }
            ClockLeg::Fade { length } => {
                let left = length * (-x).exp();
                (from_goal(left), left)
            }
        }
    }

    /// The time to the end of the last panel.
    fn stops(&self) -> f64 {
        self.panels.last().map_or(0.0, |p| p.t + p.time)
    }

    /// The time to the goal; infinite if the goal is never reached.
    pub fn whole(&self) -> f64 {
        if self.tail.is_some() { f64::INFINITY } else { self.stops() }
    }

    /// The time at which the path reaches an inclination; NaN for an inclination that is not on the path.
    pub fn time(&self, theta: f64, slowness: &impl Fn(&WayPoint) -> f64) -> f64 {
        let gone = self.way * (theta - self.start);
        let left = ((self.goal.theta - theta.into()).hi * self.way).max(0.0);
        let beyond = self.way * (theta - self.goal.theta.hi) > 0.0;
        if gone.is_nan() || gone < 0.0 || beyond {
            return f64::NAN;
        }
        if gone == 0.0 {
            return 0.0;
        }
        if let Some([t, last, slow, power]) = self.tail
            && left <= last
        {
            return tail_time(t, last, slow, power, left);
        }
        let at = |leg: ClockLeg| match leg {
            ClockLeg::Begin { behind } => (gone / behind).ln_1p(),
            ClockLeg::End { length, power } => -(left / length).powf(1.0 / f64::from(power)),
            ClockLeg::Fade { length } => (length / left).ln(),
        };
        let inside = |p: &&TimePanel| at(p.leg) <= p.x + p.width;
        let Some(panel) = self.panels.iter().find(inside).or(self.panels.last()) else { return 0.0 };
        let x = at(panel.leg).clamp(panel.x, panel.x + panel.width);
        panel.t + self.gauss(panel.leg, panel.x, x - panel.x, slowness)
    }

    /// The point of the path at a time; None before the start and after the end.
    pub fn spot_at(&self, t: f64, slowness: &impl Fn(&WayPoint) -> f64) -> Option<WayPoint> {
        if t.is_nan() || t < 0.0 || t > self.whole() * (1.0 + super::SLACK) {
            return None;
        }
        let start = WayPoint { theta: self.start.into(), left: None };
        let Some(last) = self.panels.last() else { return Some(start) };
        if let Some([t0, last, slow, power]) = self.tail
            && t >= t0
        {
            let left = tail_left(t0, last, slow, power, t);
            return Some(WayPoint { theta: self.goal.theta - (self.way * left).into(), left: Some(left) });
        }
        if t >= last.t + last.time {
            return Some(WayPoint { theta: self.goal.theta, left: Some(0.0) });
        }
        let i = self.panels.partition_point(|p| p.t + p.time <= t);
        let TimePanel { leg, x, width, t: from, time, ref slow } = self.panels[i];
        let wanted = t - from;
        let (mut low, mut high) = (0.0, width);
        let mut here = width * nearly(slow, wanted / width, wanted / time);
        for _ in 0..60 {
            let miss = self.gauss(leg, x, here, slowness) - wanted;
            let (spot, rate) = self.spot(leg, x + here);
            let speed = slowness(&spot) * rate;
            if miss < 0.0 {
                low = here;
            } else {
                high = here;
            }
            let mut next = here - miss / speed;
            let newton = next > low && next < high;
            if !newton {
                next = 0.5 * (low + high);
            }
            let step = (next - here).abs();
            here = next;
            // The next step would be about the square of this step over `far`, the distance to the place where dt/dx
            // vanishes or is unbounded.
            let far = if let ClockLeg::End { .. } = leg { -(x + here) } else { 1.0 };
            let done = newton && step * step <= f64::EPSILON * width * width.min(far);
            if done || step <= 4.0 * f64::EPSILON * (x.abs() + here) || high - low <= f64::EPSILON * width {
                break;
            }
        }
        Some(self.spot(leg, x + here).0)
    }
}

/// The weighted mean of the values at the nodes.
fn mean(values: &[f64; 16]) -> f64 {
    values.iter().zip(SIXTEEN.weights).map(|(value, weight)| weight * value).sum()
}

/// The fraction of a panel at which the integral of its series is `wanted`, by Newton's method from a guess.
fn nearly(series: &[f64; 16], wanted: f64, guess: f64) -> f64 {
    let mut x = guess.clamp(0.0, 1.0);
    for _ in 0..8 {
        let [sum, value] = gauss::integral(series, x);
        let next = (x - (sum - wanted) / value).clamp(0.0, 1.0);
        if next.is_nan() {
            return guess.clamp(0.0, 1.0);
        }
        let step = (next - x).abs();
        x = next;
        if step < 1e-9 {
            break;
        }
    }
    x
}

/// The time at which the distance `left` remains in the tail, where the slowness goes as left^(-1 - power).
fn tail_time(t: f64, last: f64, slow: f64, power: f64, left: f64) -> f64 {
    if left == 0.0 {
        f64::INFINITY
    } else if power == 0.0 {
        t + slow * (last / left).ln()
    } else {
        t + slow * ((last / left).powf(power) - 1.0) / power
    }
}

/// The distance that remains in the tail at a time.
fn tail_left(t0: f64, last: f64, slow: f64, power: f64, t: f64) -> f64 {
    let ratio = (t - t0) / slow;
    if power == 0.0 { last * (-ratio).exp() } else { last * (1.0 + power * ratio).powf(-1.0 / power) }
}
