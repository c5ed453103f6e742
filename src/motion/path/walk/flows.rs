//! What flows of a walk: alone, or as others have followed it.

use super::loses::LossyPhase;
use super::write::state;
use super::{Pause, Walk};
use crate::error::Error;
use crate::motion::flow::{Flow, Halt, MARGINS, Spent, Steps, toil_of};
use crate::motion::lossy::LossyFlow;
use crate::motion::slide::Slide;

impl<const N: usize> Walk<'_, N> {
    /// A phase that slips, or loses energy, from some numbers and with a first step if that is known, for so many steps at most.
    pub fn flows(
        &mut self,
        y: [f64; N],
        first: Option<f64>,
        most: u64,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        let toil = toil_of(self.since.last().copied().unwrap_or(0.0)).saturating_sub(self.spent.evaluations);
        let steps = Steps { first, most, patience: self.spent.patience, toil, tired: self.tired };
        self.tired = false;
        let found = match self.lossy {
            Some(LossyPhase { flow, .. }) => self.loses(&flow, y, steps, go_on),
            None => self.slides(self.slide.place(y), steps, go_on),
        };
        match found {
            // times of a flow begin with the start
            Err(Error::Endless { theta, time }) => Err(Error::Endless { theta, time: self.t0 + time }),
            found => found,
        }
    }

    /// Which margins fall where it flows from some numbers.
    pub fn falls(&self, y: &[f64; N]) -> [bool; MARGINS] {
        let margins = match self.lossy {
            Some(LossyPhase { flow, .. }) => flow.margins(&flow.place(*y)),
            None => self.slide.margins(&self.slide.place(*y)),
        };
        margins.map(|margin| margin.slope < 0.0)
    }

    /// What flows, if it loses energy without a slip.
    pub fn lossy(&self) -> Option<&LossyFlow> {
        self.lossy.as_ref().map(|phase| &phase.flow)
    }

    /// The next time that is asked for.
    pub fn until(&self) -> Option<f64> {
        self.since.get(self.made.motion.states.len()).copied()
    }

    /// All numbers of a flow of which others have followed those that matter: what is missing of the energy is heat, or lost.
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

    /// Adds what a flow has taken that was followed elsewhere with a part of the patience.
    pub fn has_spent_elsewhere(&mut self, spent: Spent, given: u64) {
        let crawled = given - spent.patience.min(given);
        self.tired = spent.patience == 0;
        self.has_spent(Spent { patience: self.spent.patience.saturating_sub(crawled), ..spent });
    }

    /// By how much the time of an end is off at `y`, where the margin that ended the flow fell so slowly: what the steps have
    /// erred by moves it. A force changes with a speed as that is fast.
    pub fn doubts(&mut self, halt: Halt, steep: f64, y: &[f64; N]) {
        let grows = match halt {
            Halt::Side => 1.0,
            Halt::LiftOff | Halt::Slips | Halt::Jam => Slide::fastest(y),
            _ => return,
        };
        let erred = grows * (self.spent.erred * self.slide.tol + 8.0 * f64::EPSILON);
        // a margin that only touches its zero bends away from it
        self.made.motion.error = self.made.motion.error.max((erred / steep).min(erred.sqrt()));
    }

    /// Adds what a flow has taken.
    pub fn has_spent(&mut self, Spent { evaluations, erred, patience }: Spent) {
        self.spent.evaluations += evaluations;
        self.spent.erred += erred;
        self.spent.patience = patience;
    }
}
