//! What flows of a walk: alone, or as others have followed it.

use super::damps::LosingPhase;
use super::write::state;
use super::{Pause, Walk};
use crate::error::Error;
use crate::motion::damped::Damped;
use crate::motion::flow::{Flow, Flown, Halt};

impl<const N: usize> Walk<'_, N> {
    /// A phase that slips, or loses energy, from some numbers and with a first step if that is known, for so many steps at most.
    pub fn flows(
        &mut self,
        y: [f64; N],
        steps: (Option<f64>, u64),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        match self.losing {
            Some(LosingPhase { damped, .. }) => self.loses(&damped, y, steps, go_on),
            None => self.slides(self.slide.place(y), steps, go_on),
        }
    }

    /// What flows, if it loses energy without a slip.
    pub fn damped(&self) -> Option<&Damped> {
        self.losing.as_ref().map(|phase| &phase.damped)
    }

    /// The next time that is asked for.
    pub fn until(&self) -> Option<f64> {
        self.since.get(self.path.motion.states.len()).copied()
    }

    /// All numbers of a flow of which others have followed those that matter: what is missing of the energy is heat, or lost.
    pub fn followed(&self, from: &[f64; N], y: [f64; N]) -> [f64; N] {
        let mut all = y;
        match self.damped() {
            Some(damped) => {
                let contact = self.asked.table.contact();
                let energy = |y: &[f64; N]| contact.energy(&self.body, &state(&damped.shown(y)));
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

    /// The end of a flow that has been found elsewhere, after so many evaluations; a time that is reached is written.
    pub fn met(&mut self, y: [f64; N], halt: Halt, evaluations: u64) -> Result<Pause<N>, Error> {
        if let Some(LosingPhase { damped, .. }) = self.losing {
            return self.has_lost(&damped, y, halt, evaluations);
        }
        if halt == Halt::Time {
            self.path.slid(&self.asked, &self.slide, &y);
            if self.path.motion.states.len() < self.since.len() {
                self.evaluations += evaluations;
                return Ok(Pause::Here(y, None));
            }
        }
        let mut ended = Some((halt, y));
        if halt == Halt::Standstill {
            ended = self.slide.stopped(&self.slide.place(y));
        }
        match ended {
            Some((halt, y)) => {
                self.halted(Flown { halt, y, step: 0.0, evaluations });
                Ok(Pause::No)
            }
            None => Ok(Pause::Here(y, None)),
        }
    }
}
