//! What laws of the user add to a body's walk: its flows ask them for the coefficient of friction and for a couple.
//!
//! ```text
//! ()       no such laws, which costs no code
//! other    a coefficient mu(|u|) and a couple m(theta, w, N) of the user
//! ```

use crate::error::Error;
use crate::laws::contact::lying::{Flat, Lying};
use crate::laws::contact::slip::FollowsSpeed;
use crate::laws::custom::SpeedLaw;
use crate::laws::loss::{Couples, Losses, OwnCouple};
use crate::laws::state::State;
use crate::methods::flow::FlowPlace;
use crate::motions::dry::creep::ASIDE;
use crate::motions::walk::numbers::PHI;
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
    /// Whether a law of the user drives the body.
    fn drives(&self) -> bool {
        false
    }
    /// Asks the drive for its force and couple at these numbers, with w, the slip, the velocity of the centre along e_h and
    /// e2, and the height there.
    fn asks_drive<const N: usize>(
        &self,
        _: &[f64; N],
        _w: [f64; 3],
        _slip: [f64; 2],
        _velocity: [f64; 2],
        _height: f64,
    ) {
    }
    /// The force along x and y, and the couple along e1, e2, e3, that the drive had where it was asked last.
    fn driven(&self) -> ([f64; 2], [f64; 3]) {
        ([0.0; 2], [0.0; 3])
    }
    /// That force along e_h and e2.
    #[inline(always)]
    fn pushes<const N: usize>(&self, y: &[f64; N]) -> [f64; 2] {
        if !(Self::IS && self.drives()) {
            return [0.0; 2];
        }
        let ([x, along], (sin, cos)) = (self.driven().0, y[PHI].sin_cos());
        [x * cos + along * sin, along * cos - x * sin]
    }
    /// Notes whether the body is seen from its upper end from now on, while a law is told of it from its lower end.
    fn sees(&self, _over: bool) {}
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
    /// Looks for a wrong value at the numbers of a step that is taken, from the speeds of the slips, and the sine and
    /// cosine of theta and w with the normal force if the couple may supply energy there. Returns whether there is one.
    fn finds_fault(&self, _speeds: &[f64], _: Option<([f64; 5], f64)>) -> bool {
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
