//! Wrong values of user-defined laws during an integration, and laws that are so stiff that they keep its steps
//! short.

use super::body_walk::BodyWalk;
use super::own::Own;
use crate::error::Error;
use crate::methods::flow::{Exhausted, Flow, FlowPlace, Flown};
use crate::motions::Limit;
use crate::motions::dry::creep::ASIDE;
use crate::motions::walk::numbers::{Halt, W1, W2, W3};

/// An integration step is near its limit of stability if its length times the slope of the rates is more than this.
const STABILITY_LIMIT: f64 = 0.3;
/// A user-defined law is stiff if it acts on w at more than this many times the rate at which w changes.
const STIFF_RATIO: f64 = 100.0;

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// Returns the error if a user-defined law has a wrong value where a phase begins.
    pub(super) fn begins_lawfully<const M: usize>(
        &self,
        flow: &impl Flow<M, Halt = Halt>,
        place: &FlowPlace<N>,
    ) -> Result<(), Error> {
        let ends = G::IS && flow.stopped(place).is_some_and(|(halt, _)| halt == Halt::Endless);
        self.of.own.takes_fault().filter(|_| ends).map_or(Ok(()), Err)
    }

    /// Returns the error if a wrong value of a user-defined law has ended an integration; wrong values beyond the
    /// last step that was taken do not count. If a stiff law has kept the steps short, the motion ends with
    /// `Limit::Stiff`; `end` returns the state vector at the end.
    pub(super) fn heeds_laws<const M: usize>(
        &mut self,
        flow: &impl Flow<M>,
        flown: &Flown<Halt, N>,
        end: impl FnOnce() -> [f64; N],
    ) -> Result<(), Error> {
        if !G::IS {
            return Ok(());
        }
        let (fault, exhausted) = (self.of.own.takes_fault(), flown.spent.exhausted);
        if flown.halt != Halt::Endless || exhausted == Some(Exhausted::Interrupted) {
            return Ok(());
        }
        fault.map_or(Ok(()), Err)?;
        let short = matches!(exhausted, Some(Exhausted::Crawling | Exhausted::Evaluations));
        if short && is_shortened_by_law(flow, &end(), flown.step) {
            self.made.motion.limit = Some(Limit::Stiff);
        }
        Ok(())
    }
}

/// Whether steps of the length `h` from the state vector `y` are short only because a user-defined law is stiff: its
/// couple drives w towards a slow motion much faster than w changes, and than rotation and nutation do.
fn is_shortened_by_law<const M: usize, const N: usize>(flow: &impl Flow<M>, y: &[f64; N], h: f64) -> bool {
    let (fast, rate) = (flow.fastest(y), flow.rates(y));
    let mut slope = 0f64;
    for j in 2..5 {
        let mut more = *y;
        more[j] += ASIDE * fast;
        let above = flow.rates(&more);
        slope += (2..5).map(|i| ((above[i] - rate[i]) / (more[j] - y[j])).powi(2)).sum::<f64>();
    }
    let (slope, change) = (slope.sqrt(), rate[W1].hypot(rate[W2]).hypot(rate[W3]));
    h * slope > STABILITY_LIMIT && slope > STIFF_RATIO * change.max(fast / flow.calm(y)) / fast
}
