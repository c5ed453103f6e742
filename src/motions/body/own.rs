//! What laws of the user add to a body's walk: its flows ask them for the coefficient of friction and for a couple.
//!
//! ```text
//! ()       no such laws, which costs no code
//! other    a coefficient mu(|u|) and a couple m(theta, w, N) of the user
//! ```

use super::phases::BodyWalk;
use crate::error::Error;
use crate::laws::contact::lying::{Flat, Lying};
use crate::laws::contact::slip::FollowsSpeed;
use crate::laws::custom::SpeedLaw;
use crate::laws::loss::{Couples, Losses, OwnCouple};
use crate::laws::state::State;
use crate::methods::flow::{Exhausted, Flow, FlowPlace, Flown};
use crate::motions::Limit;
use crate::motions::dry::creep::ASIDE;
use crate::motions::walk::numbers::Halt;
use crate::numbers::Dual;

/// The laws of the user in a body's walk.
pub(crate) trait Own:
    SpeedLaw + FollowsSpeed<f64> + FollowsSpeed<Dual<f64>> + OwnCouple<f64> + OwnCouple<Dual<f64>>
{
    /// Whether there are such laws.
    const IS: bool = false;

    /// Whether there is a couple of the user.
    fn has_couple(&self) -> bool {
        OwnCouple::<f64>::is_there(self)
    }
    /// That couple in a state under a normal force. A body with two rims is seen from the lower one.
    fn couple_at(&self, _: &State, _normal: f64) -> [f64; 3] {
        [0.0; 3]
    }
    /// Whether a law has failed, and is not called again.
    fn has_failed(&self) -> bool {
        false
    }
    /// Takes the error of a wrong value of a law, unless a law has failed.
    fn takes_fault(&self) -> Option<Error> {
        None
    }
    /// Whether a law has failed, or had a wrong value.
    fn is_faulty(&self) -> bool {
        false
    }
    /// Looks for a wrong value at the numbers of a step that is taken, from the speeds of the slips, and a state with its
    /// normal force if the couple may supply energy there. Returns whether there is one.
    fn finds_fault(&self, _speeds: &[f64], _: Option<(State, f64)>) -> bool {
        false
    }

    /// The laws that act on a body in the air; None if no law does.
    fn in_air(&self, losses: &Losses) -> Option<Couples<f64>> {
        let air = Couples::in_air(losses);
        if self.has_couple() { air.or(Some(Couples::of(&Losses::NONE, |x| x))) } else { air }
    }
    /// The law of both rims in the state with these numbers.
    fn lying(&self, law: &Lying<f64>, _: Flat<f64>) -> Lying<f64> {
        *law
    }
}

impl Own for () {}

/// A step is near its limit of stability if its length times the slope of the rates is more than this.
const STABLE: f64 = 0.3;
/// A law is stiff if it pulls w at this many times the rate at which w changes.
const FAR_FASTER: f64 = 100.0;

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// Returns the error of a wrong value of a law where a flow begins.
    pub(super) fn begins_lawfully<const M: usize>(
        &self,
        flow: &impl Flow<M, Halt = Halt>,
        place: &FlowPlace<N>,
    ) -> Result<(), Error> {
        let ends = G::IS && flow.stopped(place).is_some_and(|(halt, _)| halt == Halt::Endless);
        self.of.own.takes_fault().filter(|_| ends).map_or(Ok(()), Err)
    }

    /// Returns the error of a wrong value of a law that ends a flow; beyond the last step that was taken a wrong value does
    /// not count. A law that has kept the steps short is the limit of the motion; `end` has the numbers of the flow at its
    /// end.
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
        if short && is_kept_short(flow, &end(), flown.step) {
            self.made.motion.limit = Some(Limit::Stiff);
        }
        Ok(())
    }
}

/// Whether steps of the length `h` from the numbers `y` are short only because a law is stiff: its couple pulls w
/// towards a slow motion much faster than w changes, and than rotation and nutation allow.
fn is_kept_short<const M: usize, const N: usize>(flow: &impl Flow<M>, y: &[f64; N], h: f64) -> bool {
    let (fast, rate) = (flow.fastest(y), flow.rates(y));
    let mut slope = 0f64;
    for j in 2..5 {
        let mut more = *y;
        more[j] += ASIDE * fast;
        let above = flow.rates(&more);
        slope += (2..5).map(|i| ((above[i] - rate[i]) / (more[j] - y[j])).powi(2)).sum::<f64>();
    }
    let (slope, change) = (slope.sqrt(), rate[2].hypot(rate[3]).hypot(rate[4]));
    h * slope > STABLE && slope > FAR_FASTER * change.max(fast / flow.calm(y)) / fast
}

/// Margins at a place, with slopes that are differences over a share of the time `calm`, since a user-defined law has no
/// derivative.
pub(crate) fn differences<const N: usize, const M: usize>(
    place: &FlowPlace<N>,
    calm: f64,
    margins: impl Fn(&[f64; N]) -> [f64; M],
) -> [Dual<f64>; M] {
    let by = ASIDE * calm.min(1.0);
    let aside =
        |by: f64| margins(&core::array::from_fn::<f64, N, _>(|i| by.mul_add(place.rate[i], place.y[i])));
    let [before, here, after] = [aside(-by), margins(&place.y), aside(by)];
    core::array::from_fn(|i| Dual { value: here[i], slope: (after[i] - before[i]) / (2.0 * by) })
}
