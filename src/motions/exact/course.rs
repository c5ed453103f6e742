//! The input of a motion that conserves energy, for any method: its initial state, its times and its direction in time.

use crate::laws::body::Body;
use crate::laws::state::State;
use crate::motions::Start;

/// The initial state and the times of a motion that conserves energy.
#[derive(Clone, Copy)]
pub(crate) struct Course<'a> {
    pub body: &'a Body,
    pub start: &'a State,
    /// The initial time; the next field is the time from it to the last output, negative for a motion backward in
    /// time.
    pub t0: f64,
    pub span: f64,
    pub times: &'a [f64],
    pub pose: bool,
}

impl<'a> Course<'a> {
    pub fn of(body: &'a Body, start: &'a Start, times: &'a [f64], pose: bool, span: f64) -> Self {
        Self { body, start: &start.state, t0: start.time, span, times, pose }
    }

    /// The direction of time: 1, or -1 for a motion backward in time.
    pub fn way(&self) -> f64 {
        if self.span < 0.0 { -1.0 } else { 1.0 }
    }

    /// Number of requested times up to the time `until` since the start.
    pub fn count(&self, until: f64) -> usize {
        self.times.partition_point(|t| (t - self.t0).abs() <= until.abs())
    }
}
