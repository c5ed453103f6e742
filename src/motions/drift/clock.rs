//! The time along a path of inclinations, by quadrature of the slowness |dt/dtheta|, and the inclination at a given
//! time.
//!
//! ```text
//! t(theta) = int |dt/dtheta| dtheta                                         series of [`Antiderivative`] in x
//! begin    theta = start +- d (exp(x) - 1)       d is the distance to the nearest singularity behind the start
//! end      theta = goal -+ b x^p                 1 >= x >= 0; p = 2 or 4 where the slowness is a root of the distance
//! fade     theta = goal -+ b exp(-x)             x >= 0; for a goal that is never reached
//! ```
//! A place is given by its distance from the start or from the goal, so that no digits are lost near either.
//!
//! Error: 1e-13 of the time.

use super::ends::Goal;
use crate::methods::antiderivative::{Antiderivative, Sampled};
use crate::numbers::Sum;

/// A part (leg) of the path, with its own variable of integration x.
#[derive(Debug, Clone, Copy)]
enum ClockLeg {
    Begin { behind: f64 },
    End { length: f64, power: i32 },
    Fade { length: f64 },
}

/// A point of the path: its inclination, and its distance from the goal where that is known more precisely.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WayPoint {
    pub theta: Sum<f64>,
    pub left: Option<f64>,
}

/// A path of inclinations from its start to its goal.
#[derive(Debug, Clone, Copy)]
struct ClockPath {
    start: f64,
    goal: Goal,
    /// 1 if the inclination grows, -1 if it falls.
    way: f64,
}

/// A leg of the path with the time along it, from x = 0 on, and the time at which it begins.
#[derive(Debug, Clone)]
struct TimedLeg {
    leg: ClockLeg,
    time: Antiderivative<1>,
    begins: f64,
}

/// The time along a path of inclinations, leg by leg.
#[derive(Debug, Clone)]
pub(crate) struct DriftClock {
    path: ClockPath,
    legs: Vec<TimedLeg>,
    /// The tail after the last leg, if the goal is never reached: the time and the distance from the goal at the
    /// start of the tail, the slowness times this distance, and the power of the distance.
    tail: Option<[f64; 4]>,
}

impl ClockPath {
    /// The point of the path at x on a leg, and |dtheta/dx|.
    fn point_on_leg(&self, leg: ClockLeg, x: f64) -> (WayPoint, f64) {
        match leg {
            ClockLeg::Begin { behind } => {
                let gone = behind * x.exp_m1();
                (WayPoint { theta: Sum::of(self.start, self.way * gone), left: None }, behind + gone)
            }
            ClockLeg::End { length, power } => {
                let rate = length * f64::from(power) * x.powi(power - 1);
                (self.point_before_goal(length * x.powi(power)), rate)
            }
            ClockLeg::Fade { length } => {
                let left = length * (-x).exp();
                (self.point_before_goal(left), left)
            }
        }
    }

    fn point_before_goal(&self, left: f64) -> WayPoint {
        WayPoint { theta: self.goal.theta - (self.way * left).into(), left: Some(left) }
    }

    /// The integral of the slowness over a part of a leg; None if the slowness is not finite there.
    fn time(
        &self,
        leg: ClockLeg,
        part: [f64; 2],
        slowness: &impl Fn(&WayPoint) -> [f64; 2],
    ) -> Option<Antiderivative<1>> {
        Antiderivative::new(&part, 0.0, |x| {
            let (spot, rate) = self.point_on_leg(leg, x);
            let [slow, size] = slowness(&spot);
            let noise = SLOWNESS_ROUNDINGS * f64::EPSILON * (size / slow).min(1.0 / f64::EPSILON);
            Sampled { value: [slow * rate], scale: [slow * rate], noise }
        })
    }
}

/// The rounding error of the slowness, in units of epsilon times the size of its terms.
const SLOWNESS_ROUNDINGS: f64 = 8.0;

impl TimedLeg {
    /// The time from the beginning of the leg to its variable x.
    fn time_in_leg(&self, x: f64) -> f64 {
        let [time] = self.time.at(x);
        if let ClockLeg::End { .. } = self.leg { self.time.total[0] - time } else { time }
    }

    /// The variable x of the leg at a time since its beginning.
    fn place(&self, since: f64) -> f64 {
        self.time.inverse(if let ClockLeg::End { .. } = self.leg {
            self.time.total[0] - since
        } else {
            since
        })
    }

    fn stops(&self) -> f64 {
        self.begins + self.time.total[0]
    }
}

impl DriftClock {
    /// Computes the time along a path: `slowness` is |dt/dtheta| at a point and the size of its terms, `behind` the
    /// distance from the start back to the nearest singularity, and `several` says whether several laws take energy.
    /// None if the time cannot be resolved.
    pub fn new(
        start: f64,
        goal: Goal,
        behind: f64,
        several: bool,
        slowness: &impl Fn(&WayPoint) -> [f64; 2],
    ) -> Option<Self> {
        let way = if goal.theta.hi > start { 1.0 } else { -1.0 };
        let path = ClockPath { start, goal, way };
        let mut clock = Self { path, legs: Vec::new(), tail: None };
        let whole = ((goal.theta - start.into()).hi * way).max(0.0);
        if whole == 0.0 {
            return Some(clock);
        }
        // The length to the goal is computed in twice the digits, so that both legs meet.
        let middle = start + way * 0.5 * whole;
        let length = ((goal.theta - middle.into()).hi * way).max(0.0);
        let begin = ClockLeg::Begin { behind };
        let time = path.time(begin, [0.0, ((middle - start) * way / behind).ln_1p()], slowness)?;
        let begins = time.total[0];
        clock.legs.push(TimedLeg { leg: begin, time, begins: 0.0 });
        if goal.finite {
            // A half-integer power of the distance needs p = 2; quarter powers and several laws need p = 4.
            let power = if matches!(goal.end, super::End::Side | super::End::Lowest) {
                1
            } else if several || (2.0 * goal.power).fract() != 0.0 {
                4
            } else if goal.power.fract() != 0.0 {
                2
            } else {
                1
            };
            let leg = ClockLeg::End { length, power };
            clock.legs.push(TimedLeg { leg, time: path.time(leg, [0.0, 1.0], slowness)?, begins });
        } else {
            let leg = ClockLeg::Fade { length };
            let least = if several { 1e-150 } else { 1e-34 };
            let mut deep = (length / least).ln().max(0.0);
            // Where the time overflows, the tail begins earlier.
            let time = loop {
                match path.time(leg, [0.0, deep], slowness) {
                    Some(time) => break time,
                    None if deep < SHORTEST_HALVED_LEG => return None,
                    None => deep *= 0.8,
                }
            };
            clock.legs.push(TimedLeg { leg, time, begins });
            let (spot, rate) = path.point_on_leg(leg, deep);
            clock.tail =
                Some([clock.stops(), length * (-deep).exp(), slowness(&spot)[0] * rate, -goal.power]);
        }
        Some(clock)
    }

    /// The time from the start of the path to the end of its last leg.
    fn stops(&self) -> f64 {
        self.legs.last().map_or(0.0, TimedLeg::stops)
    }

    /// The time from the start of the path to its goal; infinite if the goal is never reached.
    pub fn time_to_goal(&self) -> f64 {
        if self.tail.is_some() { f64::INFINITY } else { self.stops() }
    }

    /// The time at which the path reaches an inclination; NaN for an inclination that is not on the path.
    pub fn time(&self, theta: f64, slowness: &impl Fn(&WayPoint) -> [f64; 2]) -> f64 {
        let ClockPath { start, goal, way } = self.path;
        let gone = way * (theta - start);
        let left = ((goal.theta - theta.into()).hi * way).max(0.0);
        let beyond = way * (theta - goal.theta.hi) > 0.0;
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
        let [first, second] = &self.legs[..] else { return 0.0 };
        match (first.leg, second.leg) {
            (ClockLeg::Begin { behind }, _) if left >= gone => {
                // Near the start the time keeps its digits if the last piece is integrated anew.
                let x = (gone / behind).ln_1p();
                let (from, [before]) = first.time.start_of_piece(x);
                let rest = if from < x { self.path.time(first.leg, [from, x], slowness) } else { None };
                rest.map_or_else(|| first.time_in_leg(x), |rest| before + rest.total[0])
            }
            (_, ClockLeg::End { length, power }) => {
                second.begins + second.time_in_leg((left / length).powf(1.0 / f64::from(power)).min(1.0))
            }
            (_, ClockLeg::Fade { length }) => {
                second.begins + second.time_in_leg((length / left).ln().max(0.0))
            }
            (_, ClockLeg::Begin { .. }) => f64::NAN,
        }
    }

    /// The point of the path at a time; None before the start and after the end.
    pub fn point_at_time(&self, t: f64) -> Option<WayPoint> {
        if t.is_nan() || t < 0.0 || t > self.time_to_goal() * (1.0 + super::SLACK) {
            return None;
        }
        if let Some([t0, last, slow, power]) = self.tail
            && t >= t0
        {
            return Some(self.path.point_before_goal(tail_distance(t0, last, slow, power, t)));
        }
        let Some(leg) = self.legs.iter().find(|leg| t < leg.stops()) else {
            return Some(self.path.point_before_goal(0.0));
        };
        Some(self.path.point_on_leg(leg.leg, leg.place(t - leg.begins)).0)
    }
}

/// Length in x below which a leg is not halved if its quadrature fails, since the failure is then not an overflow of
/// the time.
const SHORTEST_HALVED_LEG: f64 = 1.0;

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
fn tail_distance(t0: f64, last: f64, slow: f64, power: f64, t: f64) -> f64 {
    let ratio = (t - t0) / slow;
    if power == 0.0 { last * (-ratio).exp() } else { last * (1.0 + power * ratio).powf(-1.0 / power) }
}
