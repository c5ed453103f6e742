//! User-defined laws in the equations of a body's motion, which call them for the coefficient of friction and for a
//! couple.
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

/// User-defined laws of a body's motion.
pub(crate) trait Own:
    SpeedLaw + FollowsSpeed<f64> + FollowsSpeed<Dual<f64>> + OwnCouple<f64> + OwnCouple<Dual<f64>>
{
    /// Whether there are user-defined laws.
    const IS: bool = false;

    /// Whether there is a user-defined couple.
    fn has_couple(&self) -> bool {
        OwnCouple::<f64>::is_there(self)
    }
    /// The user-defined couple, along e1, e2, e3, in a state under a normal force. The state of a body with two rims
    /// is counted from the lower one.
    fn couple_at(&self, _: &State, _normal: f64) -> [f64; 3] {
        [0.0; 3]
    }
    /// Whether there is a user-defined drive.
    fn drives(&self) -> bool {
        false
    }
    /// Calls the user-defined drive at this state vector, with w, the slip, the velocity of the centre along e_h and
    /// e2, and the height. `driven` then returns its force and couple.
    fn asks_drive<const N: usize>(
        &self,
        _: &[f64; N],
        _w: [f64; 3],
        _slip: [f64; 2],
        _velocity: [f64; 2],
        _height: f64,
    ) {
    }
    /// The force along x and y, and the couple along e1, e2, e3, that the user-defined drive returned at its last
    /// call.
    fn driven(&self) -> ([f64; 2], [f64; 3]) {
        ([0.0; 2], [0.0; 3])
    }
    /// The force of the user-defined drive at its last call, along e_h and e2.
    #[inline(always)]
    fn pushes<const N: usize>(&self, y: &[f64; N]) -> [f64; 2] {
        if !(Self::IS && self.drives()) {
            return [0.0; 2];
        }
        let ([x, along], (sin, cos)) = (self.driven().0, y[PHI].sin_cos());
        [x * cos + along * sin, along * cos - x * sin]
    }
    /// Records whether the state is counted from the upper end of the body from this moment on; user-defined laws get
    /// it counted from the lower end.
    fn sees(&self, _over: bool) {}
    /// Whether a user-defined law has failed, after which it is not called any more.
    fn has_failed(&self) -> bool {
        false
    }
    /// Returns the error for a wrong value of a user-defined law, once; None if there is none or a law has failed.
    fn takes_fault(&self) -> Option<Error> {
        None
    }
    /// Whether a user-defined law has failed, or returned a wrong value.
    fn is_faulty(&self) -> bool {
        false
    }
    /// Whether a user-defined law returns a wrong value at the end of a step: the coefficient at these slip speeds,
    /// or the couple, if it may supply energy, for this sine and cosine of theta, w and normal force.
    fn finds_fault(&self, _speeds: &[f64], _: Option<([f64; 5], f64)>) -> bool {
        false
    }

    /// The laws that act on a body in the air; None if no law does.
    fn in_air(&self, losses: &Losses) -> Option<Couples<f64>> {
        let air = Couples::in_air(losses);
        if self.has_couple() { air.or(Some(Couples::of(&Losses::NONE, |x| x))) } else { air }
    }
    /// The law of a body on both rims, with the user-defined coefficients and couple at these velocities.
    fn lying(&self, law: &Lying<f64>, _: Flat<f64>) -> Lying<f64> {
        *law
    }
}

impl Own for () {}

/// The margins (functions whose zeros end a phase) at a place, with slopes from differences over a share of the time
/// `calm`, since a user-defined law has no derivative.
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
