//! What friction and losses do to a body between its phases on one rim: by the library's laws, or by laws of the user.
//!
//! ```text
//! ()       the laws of `Ask`, which cost no code
//! other    the same functions with a coefficient mu(|u|) and a couple m(theta, w, N) of the user
//! ```

use super::slide::{Slide, Varying};
use crate::error::Error;
use crate::laws::body::Body;
use crate::laws::contact::lying::{Flat, Lying};
use crate::laws::contact::slip::{Friction, SlipResponse};
use crate::laws::contact::standstill::{Standstill, standstill};
use crate::laws::contact::{Contact, lossy};
use crate::laws::custom::SpeedLaw;
use crate::laws::loss::{Couples, Losses};
use crate::laws::state::State;
use crate::methods::flow::FlowPlace;
use crate::motions::dry::creep::ASIDE;
use crate::numbers::Dual;

/// The laws of a body's walk.
pub(crate) trait Own: SpeedLaw {
    /// Whether these are laws of the user.
    const IS: bool;
    /// How the friction of a slip varies on one rim, if the library's flows follow that slip.
    type Speeds: Varying;
    fn speeds(&self) -> Self::Speeds;

    /// Whether there is a couple of the user.
    fn has_couple(&self) -> bool {
        false
    }
    /// That couple in a state under a normal force. A body with two rims is seen from the lower one.
    fn couple(&self, _: &State, _normal: f64) -> [f64; 3] {
        [0.0; 3]
    }
    /// Takes the error of a wrong value of a law, unless a law has failed.
    fn takes_fault(&self) -> Option<Error> {
        None
    }
    /// Whether a law has failed, or had a wrong value.
    fn is_faulty(&self) -> bool {
        false
    }
    /// Looks for a wrong value at the numbers of a step that is taken, from the speeds of the slips, and the state with
    /// its normal force. Returns whether there is one.
    fn finds_fault(&self, _speeds: &[f64], _: &State, _normal: f64) -> bool {
        false
    }

    /// The laws that act on a body in the air; None if no law does.
    fn in_air(&self, losses: &Losses) -> Option<Couples<f64>> {
        Couples::in_air(losses)
    }
    /// The response of a body on one rim that slips with u, or that begins to slip along `way`, and the power of its
    /// losses.
    fn slides(
        &self,
        slide: &Slide<Self::Speeds>,
        angle: (f64, f64),
        w: [f64; 3],
        u: [f64; 2],
        way: Option<[f64; 2]>,
    ) -> (SlipResponse<f64>, f64);
    /// w' of a body that rolls on one rim, and the power of its losses.
    fn rolls(&self, body: &Body, y: &State, losses: &Losses) -> ([f64; 3], f64);
    /// The behaviour of a contact point at rest.
    fn standstill(&self, body: &Body, y: &State, friction: &Friction, losses: &Losses) -> Standstill;
    /// The law of both rims in the state with these numbers; None if it does not depend on them.
    fn lying(&self, _: &Lying<f64>, _: Flat<f64>) -> Option<Lying<f64>> {
        None
    }
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

/// The laws of a walk whose slips and whose rolling the library's flows follow.
pub(crate) trait Stepped: Own {}

impl Stepped for () {}

/// The answers of [`Own`] by the laws of the library.
macro_rules! library_answers {
    () => {
        #[inline(always)]
        fn slides(
            &self,
            slide: &Slide<Self::Speeds>,
            angle: (f64, f64),
            w: [f64; 3],
            u: [f64; 2],
            way: Option<[f64; 2]>,
        ) -> (SlipResponse<f64>, f64) {
            let law = &slide.law;
            let at = match way {
                Some(way) => law.towards(angle, w, u, way),
                None => law.at(angle, w, u).0,
            };
            (at, law.power(angle, w, at.force[0]))
        }

        fn rolls(&self, body: &Body, y: &State, losses: &Losses) -> ([f64; 3], f64) {
            let (dy, power) = lossy::derivative(Contact::Rolling, body, y, losses);
            ([dy.w1, dy.w2, dy.w3], power)
        }

        fn standstill(&self, body: &Body, y: &State, friction: &Friction, losses: &Losses) -> Standstill {
            standstill(body, y, friction, losses)
        }
    };
}
pub(crate) use library_answers;

impl Own for () {
    const IS: bool = false;
    type Speeds = ();
    fn speeds(&self) {}
    library_answers!();
}
