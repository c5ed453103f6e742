//! A phase of a walk that rolls, or slides freely, and loses energy.

use super::write::state;
use super::{MOST, Next, Pause, STILL, Walk, ending};
use crate::contact::Table;
use crate::contact::standstill::{let_go, standstill};
use crate::error::Error;
use crate::motion::Ending;
use crate::motion::flow::{Flow, Halt, Steps};
use crate::motion::lossy::LossyFlow;
use crate::motion::path::Kind;

/// Such a phase on its way.
#[derive(Clone, Copy)]
pub(super) struct LossyPhase {
    pub flow: LossyFlow,
    /// When something last turned round or was held; how often that was within no time, and how often in all.
    since: f64,
    still: u32,
    count: usize,
}

impl<const N: usize> Walk<'_, N> {
    /// What a body does that does not slip: on a smooth table it slides.
    pub(super) fn kind(&self) -> Kind {
        if self.ask.table == Table::Smooth { Kind::Slipping } else { Kind::Rolling }
    }

    /// A phase that rolls, or slides freely, and loses energy, where friction up to `mu` N holds it: the numbers that flow, None if
    /// it is over at once.
    pub(super) fn begins_to_lose(&mut self, mu: f64) -> Result<Option<[f64; N]>, Error> {
        let on = (&self.body, self.ask.table.contact());
        let mut flow = LossyFlow::new(on, mu, &self.ask.losses, self.slide.tol, &self.state);
        let halt = flow.at_start(&self.state);
        let rests = halt.is_none() && flow.rests(&self.state);
        self.lossy = Some(LossyPhase { flow, since: self.at[7], still: 0, count: 0 });
        match halt {
            _ if rests => {
                (self.lossy, self.next) = (None, Some(Next::Ends(Ending::Stops)));
                Ok(None)
            }
            Some(halt) => self.meets_halt(halt),
            None => Ok(Some(flow.enter(&self.at))),
        }
    }

    /// Such a phase from some of its numbers, with a first step if that is known, for so many steps at most.
    pub(super) fn loses(
        &mut self,
        flow: &LossyFlow,
        y: [f64; N],
        steps: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        let first = self.made.motion.states.len();
        let (body, ask, kind, start) = (self.body, self.ask, self.kind(), self.start);
        let made = &mut self.made;
        let mut write = |y: &[f64; N]| made.lossy(&ask, (&body, &start, flow), y, kind);
        let times = &self.since[first..];
        let Some(flown) = flow.run(flow.place(y), steps, times, &mut write, go_on)? else {
            return Ok(Pause::Interrupted);
        };
        self.has_spent(flown.spent);
        self.doubts(flown.halt, flown.steep, &flown.y);
        if flown.halt == Halt::Pause {
            return Ok(Pause::Here(flow.on_the_way().enter(&flown.y), Some(flown.step)));
        }
        self.halts(flown.y, flown.halt)
    }

    /// The end of such a phase, at numbers as others know them, or what goes on from there.
    fn halts(&mut self, shown: [f64; N], halt: Halt) -> Result<Pause<N>, Error> {
        self.at = shown;
        self.state = state(&self.at);
        Ok(self.meets_halt(halt)?.map_or(Pause::No, |y| Pause::Here(y, None)))
    }

    /// What a halt changes where the walk is: the numbers from which the phase goes on, None if it is over.
    fn meets_halt(&mut self, found: Halt) -> Result<Option<[f64; N]>, Error> {
        let Some(mut phase) = self.lossy.take() else { return Ok(None) };
        let (body, ask) = (self.body, self.ask);
        let goes_on = ask.beyond && !matches!(ask.table, Table::Rubs(_));
        let flow = &mut phase.flow;
        let next = match found {
            Halt::Time | Halt::Pause => return Ok(None),
            Halt::Contour | Halt::Drilling | Halt::Rocking | Halt::Settles | Halt::Rests => {
                phase.still = if self.at[7] > phase.since { 0 } else { phase.still + 1 };
                (phase.since, phase.count) = (self.at[7], phase.count + 1);
                let count = phase.count;
                if phase.still > STILL || count > MOST {
                    return Err(Error::Restless { count, time: self.t0 + self.at[7] });
                }
                self.shake();
                self.renews();
                let doubt = match found {
                    Halt::Contour => flow.doubt(&self.state, self.spent.erred * self.slide.tol),
                    Halt::Settles => flow.settled_doubt(&self.state),
                    _ => 0.0,
                };
                self.made.motion.error = self.made.motion.error.max(doubt);
                let stops = flow.after(found, &self.state);
                if stops && goes_on && found == Halt::Contour {
                    self.meets(Ending::Stops);
                }
                if !stops || goes_on && found == Halt::Contour {
                    let y = flow.enter(&self.at);
                    self.lossy = Some(phase);
                    return Ok(Some(y));
                }
                Next::Ends(Ending::Stops)
            }
            Halt::Face => {
                let (left, doubt) = flow.rest_of(&self.at);
                self.at[7] += left;
                self.made.motion.error = self.made.motion.error.max(doubt);
                self.at[0] = 0.0;
                self.state = state(&self.at);
                Next::Ends(Ending::Face)
            }
            _ if goes_on && found != Halt::Rests => {
                self.meets(ending(found));
                flow.go_beyond();
                let y = flow.enter(&self.at);
                self.lossy = Some(phase);
                return Ok(Some(y));
            }
            Halt::Side => {
                self.state.theta = body.theta_end();
                if ask.restitution.is_some() { self.lands() } else { Next::Ends(Ending::Side) }
            }
            Halt::Slips if matches!(ask.table, Table::Rubs(_)) && flow.jumps(&self.state) => {
                let (state, by) = flow.on_its_way(&self.state);
                (self.at[2], self.at[4], self.state) = (state.w1, state.w3, state);
                self.made.motion.error = self.made.motion.error.max(by);
                self.after_rest(standstill(&body, &state, &self.friction(), &ask.losses))
            }
            Halt::Slips if ask.table.rubs() => {
                self.after_rest(let_go(&body, &self.state, &self.friction(), &ask.losses))
            }
            found => Next::Ends(ending(found)),
        };
        if !matches!(next, Next::Ends(_)) {
            self.leaves_out_a_moment();
            self.shake();
        }
        self.next = Some(next);
        Ok(None)
    }
}
