//! The flows of a walk, followed alone or in lanes.

use super::loses::LossyPhase;
use super::write::state;
use super::{Pause, Walk};
use crate::error::Error;
use crate::methods::flow::{Flow, Spent, Steps, toil_of};
use crate::motions::halt::Halt;
use crate::motions::path::lossy::LossyFlow;
use crate::motions::path::slide::Slide;

/// The first step of a rougher run is this many times as long.
const LONGER: f64 = 3.0;

impl<const N: usize> Walk<'_, N> {
    /// Follows a phase that slips or loses energy from the numbers `y`, for at most `most` steps.
    pub fn flows(
        &mut self,
        y: [f64; N],
        first: Option<f64>,
        most: u64,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        let toil = toil_of(self.since.last().copied().unwrap_or(0.0)).saturating_sub(self.spent.evaluations);
        let first = Some(first.unwrap_or_else(|| self.first(&y)));
        let steps = Steps { first, most, patience: self.spent.patience, toil, tired: self.tired };
        self.tired = false;
        match self.lossy {
            Some(LossyPhase { flow, .. }) => self.loses(&flow, y, steps, go_on),
            None => self.slides(self.slide.place(y), steps, go_on),
        }
    }

    /// The first step of a flow. That of a rougher run is longer, since two runs with the same steps have the same errors,
    /// which an unstable start makes grow unseen.
    pub fn first(&self, y: &[f64; N]) -> f64 {
        let first = self.lossy().map_or_else(|| self.slide.first(y), |flow| flow.first(y));
        if self.shake > 0.0 { LONGER * first } else { first }
    }

    /// The flow of the present phase, if the body loses energy without a slip.
    pub fn lossy(&self) -> Option<&LossyFlow> {
        self.lossy.as_ref().map(|phase| &phase.flow)
    }

    /// The next requested time, counted from the start.
    pub fn until(&self) -> Option<f64> {
        self.since.get(self.made.motion.states.len()).copied()
    }

    /// All numbers of a flow whose first numbers a lane has followed; the missing energy has become heat or is lost.
    pub fn followed(&self, from: &[f64; N], y: [f64; N]) -> [f64; N] {
        let mut all = y;
        match self.lossy() {
            Some(flow) => {
                let contact = self.ask.table.contact();
                let energy = |y: &[f64; N]| contact.energy(&self.body, &state(&flow.shown(y)));
                all[8..].copy_from_slice(&from[8..]);
                all[N - 1] += energy(from) - energy(&y);
            }
            None => {
                all[8..].copy_from_slice(&from[8..]);
                all[8] += self.slide.energy(from) - self.slide.energy(&y);
            }
        }
        all
    }

    /// Adds the cost of a flow that a lane has followed with a part of the patience.
    pub fn has_spent_elsewhere(&mut self, spent: Spent, given: u64) {
        let crawled = given - spent.patience.min(given);
        self.tired = spent.patience == 0;
        self.has_spent(Spent { patience: self.spent.patience.saturating_sub(crawled), ..spent });
    }

    /// Claims the error of the time of an end at `y`: the errors of the steps, divided by the rate at which the margin, or
    /// the speed of a body that comes to rest, fell. A margin that depends on a force changes with the speeds, so that its errors grow with the largest speed.
    pub fn doubts(&mut self, halt: Halt, steep: f64, y: &[f64; N]) {
        let grows = match halt {
            Halt::Side | Halt::Rests => 1.0,
            Halt::LiftOff | Halt::Slips | Halt::Jam => Slide::fastest(y),
            _ => return,
        };
        let erred = grows * (self.spent.erred * self.slide.tol + 8.0 * f64::EPSILON);
        // A margin that only touches zero bends away from zero.
        self.made.motion.error = self.made.motion.error.max((erred / steep).min(erred.sqrt()));
    }

    /// Adds the cost of a flow.
    pub fn has_spent(&mut self, Spent { evaluations, erred, patience }: Spent) {
        self.spent.evaluations += evaluations;
        self.spent.erred += erred;
        self.spent.patience = patience;
    }
}
