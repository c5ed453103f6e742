//! The phases in which a body loses energy while it rolls, or slides on a smooth table.

use super::BRIEF_ROLLING_STEPS;
use super::lossy::LossyFlow;
use crate::error::Error;
use crate::laws::body::border_at;
use crate::laws::contact::Table;
use crate::laws::loss::Holds;
use crate::methods::flow::{Flow, Spent, Steps};
use crate::motions::Ending;
use crate::motions::body::body_walk::{BodyWalk, LossyPhase};
use crate::motions::body::own::Own;
use crate::motions::body::write::state;
use crate::motions::dry::creep::LOST_DRILLING;
use crate::motions::walk::numbers::{Halt, SIN, TIME, U2, UH};
use crate::motions::walk::{Next, Pause, Phases, after_rest, ending};

/// Tolerance of integration steps that replace an exact solution, as a share of that of the motion.
const EXACT_TOLERANCE_SHARE: f64 = 0.1;

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// Begins a phase that loses energy and rolls with friction up to `mu` N, or slides freely. Returns the state
    /// vector at which its integration starts; None if the phase is over at once.
    pub(super) fn begins_to_lose(&mut self, mu: f64) -> Result<Option<[f64; N]>, Error> {
        let (losses, friction) = (self.ask.losses, self.friction());
        if friction.patch() > 0.0 {
            // The patch hardly drills.
            self.claims(LOST_DRILLING * self.drills_here().abs());
            self.stops_exactly(Holds { drilling: true, ..Holds::default() });
        }
        let (on, y) = ((&self.of.body, self.contact()), self.of.state);
        // Such steps add little to the error.
        let tol =
            if self.of.by_steps { EXACT_TOLERANCE_SHARE * self.of.slide.tol } else { self.of.slide.tol };
        let flow = LossyFlow::new(on, mu, (&losses, self.of.own), tol, &y).on_patch(&friction, &y).on_table(
            [self.of.tilt, self.of.turning],
            &self.at,
            &y,
        );
        let halt = flow.at_start(&self.of.state);
        // The friction that would hold a moving contact point is not that of a body at rest.
        let level = self.ask.is_level();
        let rests = halt.is_none_or(|halt| level && halt == Halt::Slips) && flow.has_stopped(&self.of.state);
        self.of.lossy = Some(LossyPhase { flow });
        match halt {
            _ if rests => {
                (self.of.lossy, self.next) = (None, Some(Next::Ends(Ending::Stops)));
                Ok(None)
            }
            Some(halt) => self.meets_halt(halt),
            None if self.is_slowing_known() => {
                self.of.lossy = None;
                self.rolls_to_rest(&flow);
                Ok(None)
            }
            None => Ok(Some(flow.enter(&self.at))),
        }
    }

    /// Integrates a phase that loses energy without a slip from the state vector `y`, within the limits `steps`.
    pub(crate) fn loses(
        &mut self,
        flow: &LossyFlow<G>,
        y: [f64; N],
        steps: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        let first = self.made.motion.states.len();
        let (body, ask, kind, start) = (self.of.body, self.ask, self.kind(), self.of.start);
        let place = flow.place(y);
        self.begins_lawfully(flow, &place)?;
        let made = &mut self.made;
        let mut write = |y: &[f64; N]| made.lossy(&ask, (&body, &start, flow), y, kind);
        let times = &self.since[first..];
        let by_steps = self.of.by_steps;
        let steps =
            if by_steps { Steps { most: steps.most.min(BRIEF_ROLLING_STEPS), ..steps } } else { steps };
        let flown = flow.run(place, steps, times, &mut write, go_on);
        let erred = if by_steps { EXACT_TOLERANCE_SHARE * flown.spent.erred } else { flown.spent.erred };
        self.has_spent(Spent { erred, ..flown.spent });
        self.of.lately[1] = flown.step;
        self.heeds_laws(flow, &flown, || flow.on_the_way().enter(&flown.y))?;
        self.claims_time_error(flown.halt, flown.steep, &flown.y);
        if flown.halt == Halt::Pause && by_steps {
            // The first integrals continue the phase.
            self.arrives(flown.y);
            (self.of.lossy, self.of.rolls_briefly) = (None, false);
            self.resumes_phase();
            self.next = Some(Next::Rolls { at_limit: false });
            return Ok(Pause::No);
        }
        if flown.halt == Halt::Pause {
            return Ok(Pause::Here(flow.on_the_way().enter(&flown.y), Some(flown.step)));
        }
        self.halts(flown.y, flown.halt)
    }

    /// Continues the phase after a halt of its integration, or ends it; `shown` is the state vector in the variables
    /// that all phases share.
    fn halts(&mut self, shown: [f64; N], halt: Halt) -> Result<Pause<N>, Error> {
        self.arrives(shown);
        Ok(self.meets_halt(halt)?.map_or(Pause::No, |y| Pause::Here(y, None)))
    }

    /// Applies a halt of the integration to the motion. Returns the state vector from which the phase continues; None
    /// if the phase is over.
    fn meets_halt(&mut self, found: Halt) -> Result<Option<[f64; N]>, Error> {
        let Some(mut phase) = self.of.lossy.take() else { return Ok(None) };
        let (body, ask) = (self.of.body, self.ask);
        let goes_on = ask.beyond && !matches!(ask.table, Table::Rubs(_));
        if phase.flow.holds_drilling() && !matches!(found, Halt::Time | Halt::Pause | Halt::Pole) {
            self.stops_exactly(Holds { drilling: true, ..Holds::default() });
        }
        let flow = &mut phase.flow;
        flow.stands_at(&self.at);
        let next = match found {
            Halt::Time | Halt::Pause => return Ok(None),
            Halt::Pole => {
                self.claims_passage();
                let y = flow.on_the_way().enter(&self.at);
                self.of.lossy = Some(phase);
                return Ok(Some(y));
            }
            Halt::Contour | Halt::Drilling | Halt::Rocking | Halt::Settles | Halt::Rests => {
                if self.turns_too_often() {
                    return Ok(None);
                }
                Phases::perturbs(self);
                self.allows_crawling();
                let doubt = match found {
                    Halt::Contour => flow.doubt(&self.of.state, self.spent.erred * self.of.slide.tol),
                    Halt::Settles => flow.settled_doubt(&self.of.state),
                    _ => 0.0,
                };
                self.claims(doubt);
                let stops = flow.after(found, &self.of.state);
                if !stops {
                    let y = flow.enter(&self.at);
                    self.of.lossy = Some(phase);
                    return Ok(Some(y));
                }
                Next::Ends(Ending::Stops)
            }
            Halt::Face => {
                let (left, doubt) = flow.rest_of(&self.at);
                self.claims(doubt + self.rocks_on());
                self.falls_the_rest(left, true);
                self.at[SIN] = 0.0;
                self.of.state = state(&self.at);
                Next::Ends(Ending::Face)
            }
            _ if goes_on && !matches!(found, Halt::Rests | Halt::Endless) => {
                self.records_event(ending(found));
                flow.go_beyond();
                let y = flow.enter(&self.at);
                self.of.lossy = Some(phase);
                return Ok(Some(y));
            }
            Halt::Side => {
                self.of.state.theta = border_at(body.carries(), self.of.state.theta);
                Next::Ends(Ending::Side)
            }
            Halt::Slips if let Some(slip) = flow.creeps(&self.of.state) => {
                (self.at[UH], self.at[U2]) = (slip[0], slip[1]);
                self.claims(LOST_DRILLING * self.drills_here().abs());
                self.forgets_a_moment(self.at[TIME]);
                Next::Slips
            }
            Halt::Slips if matches!(ask.table, Table::Rubs(_)) && flow.jumps(&self.of.state) => {
                let stops = flow.hardly_moves(&self.of.state);
                self.stops_exactly(stops);
                after_rest(Phases::rests(self))
            }
            Halt::Slips if ask.table.rubs() => after_rest(Phases::lets_go(self)),
            found => Next::Ends(ending(found)),
        };
        self.continues_with(next);
        Ok(None)
    }
}
