//! The course of a drift of a rolling body: its steps, the time at an inclination, and the state at a time.
//!
//! A state within a step is computed by a shorter step from the same start; a state after the last step by the powers
//! of `tail`.
//!
//! Error: that of `rolling`.

use super::circular::{CirclePoint, Numbers};
use super::rolling::{DriftStep, MOST_DRIFT_STEPS, Rolling};
use super::tail::Tail;
use super::{DriftState, End, SLACK};
use crate::error::Error;
use crate::laws::body::Body;
use crate::laws::loss::Losses;
use crate::laws::state::State;
use crate::methods::flow::Flow;
use crate::methods::search;
use std::cell::RefCell;

/// The course of a drift of a body that rolls.
#[derive(Debug, Clone)]
pub(crate) struct DriftCourse {
    of: Rolling<'static>,
    steps: Vec<DriftStep>,
    /// The kind of the drift's end, its inclination and its time.
    end: (End, f64, f64),
    last: Numbers<f64>,
    tail: Option<Tail>,
    /// -1 for a body with w1 < 0, whose drift is the mirror image of the computed one; else 1.
    turns: f64,
}

impl DriftCourse {
    pub fn new(body: &Body, y: &State, losses: &Losses) -> Result<Self, Error> {
        let (of, start) = Rolling::begin(body, y, losses)?;
        let steps = RefCell::default();
        let mut watched = of.recording_steps(&steps);
        let flown = watched.follow(start, None, MOST_DRIFT_STEPS)?;
        let Some((end, tail)) = watched.ended(&flown) else {
            return Err(Error::Lost { theta: watched.counted(flown.y[0]) });
        };
        let of = of.with_inclination_from(watched.far);
        Ok(Self { of, steps: steps.into_inner(), end, last: flown.y, tail, turns: y.w1.signum() })
    }

    /// The end of the drift, its inclination and its time.
    pub fn end(&self) -> (End, f64, f64) {
        self.end
    }

    /// The equations of the drift, with the inclination counted from 0 or from pi as in this step.
    fn of(&self, step: &DriftStep) -> Rolling<'static> {
        self.of.with_inclination_from(step.far)
    }

    /// The first time at which the drift reaches an inclination; NaN if the drift never does.
    pub fn time(&self, theta: f64) -> f64 {
        if theta.is_nan() {
            return f64::NAN;
        }
        for step in &self.steps {
            let of = self.of(step);
            let goal = of.counted(theta);
            let (before, after) = (step.from.y[0] - goal, step.to[0] - goal);
            if before == 0.0 {
                return step.from.y[3];
            }
            if after == 0.0 {
                return step.to[3];
            }
            if before.signum() != after.signum() {
                let miss = |h: f64| of.part(&step.from, h)[0] - goal;
                let h = search::crossing(miss, 0.0, step.h, before, after);
                return of.part(&step.from, h)[3];
            }
        }
        if self.end.0 == End::Side && self.end.1 == theta {
            return self.last[3];
        }
        let goal = self.of.counted(theta);
        match &self.tail {
            Some(tail) if (0.0..=self.last[0]).contains(&goal) => {
                self.last[3] + tail.time_until(goal / self.last[0])
            }
            _ => f64::NAN,
        }
    }

    pub fn at_time(&self, t: f64) -> Option<DriftState> {
        let whole = self.end.2;
        if t.is_nan() || t < 0.0 || t > whole * (1.0 + SLACK) {
            return None;
        }
        let step = self.steps.get(self.steps.partition_point(|s| s.to[3] <= t));
        let (of, y) = match (step, &self.tail) {
            (Some(step), _) => {
                let of = self.of(step);
                let miss = |h: f64| of.part(&step.from, h)[3] - t;
                let h = search::crossing(miss, 0.0, step.h, step.from.y[3] - t, step.to[3] - t);
                (of, of.part(&step.from, h))
            }
            (None, Some(tail)) => return Some(self.state_in_tail(tail, t)),
            (None, None) => (self.of, self.last),
        };
        let CirclePoint { w1, speed, .. } = of.of.at(&y, of.far);
        let theta = if step.is_some() { of.counted(y[0]) } else { self.end.1 };
        Some(self.with_mirror_image(State { theta, w1, w2: 0.0, w3: y[2] }, y[1], speed))
    }

    /// The state of the drift with its precession Omega and speed |V|, mirrored back if the mirror image was
    /// computed.
    fn with_mirror_image(&self, y: State, rate: f64, speed: f64) -> DriftState {
        let state = State { w1: self.turns * y.w1, w3: self.turns * y.w3, ..y };
        DriftState { state, precession: self.turns * rate, friction_coefficient: speed * rate.abs() }
    }

    /// The state at a time after the last step, in the tail.
    fn state_in_tail(&self, tail: &Tail, t: f64) -> DriftState {
        let [last, rate, w3, from] = self.last;
        let left = tail.at(t - from);
        let (w1, w3) = (self.of.of.at(&self.last, self.of.far).w1 * left.w1, w3 * left.w3);
        let theta = last * left.theta;
        let (s, c) = theta.sin_cos();
        let speed = self.of.of.speed((s, self.of.far * c), w1, w3).abs();
        self.with_mirror_image(
            State { theta: self.of.counted(theta), w1, w2: 0.0, w3 },
            rate * left.rate,
            speed,
        )
    }
}
