//! Rolling on a patch of contact: the drilling that friction holds, and the return to a slip ([`creep`]).
//!
//! As long as a patch of contact drills, its contact point creeps (slips slowly). Where the drilling vanishes, the
//! slip also vanishes, faster and faster, so that the body rolls through that moment, unless friction holds the
//! drilling.
//!
//! [`creep`]: crate::motions::dry::creep

use super::LossyFlow;
use crate::laws::contact::Force;
use crate::laws::contact::lossy::{Acted, Held};
use crate::laws::contact::slip::Friction;
use crate::laws::state::State;
use crate::motions::body::own::Own;
use crate::motions::dry::creep::RestingPatch;
use crate::motions::walk::numbers::BodyNumbers;

impl<G: Own> LossyFlow<G> {
    /// These equations on a patch of contact; unchanged for a point.
    pub fn on_patch(mut self, friction: &Friction, y: &State) -> Self {
        let (fixed, slides, radius) = (self.mu, friction.strength(), friction.patch());
        if radius > 0.0 {
            self.patch = Some(RestingPatch { fixed, slides, radius });
            self.sets_holds(y);
        }
        self
    }

    /// Whether the contact is a patch.
    #[inline(always)]
    pub(in crate::motions::body) fn is_patch(&self) -> bool {
        self.patch.is_some()
    }

    /// Contact force and accelerations on a patch, whose friction holds the drilling up to a couple that depends on
    /// the force.
    #[inline(never)]
    pub(super) fn held_by(&self, patch: &RestingPatch, acted: Acted<f64>) -> Acted<f64> {
        let [normal, along, across] = acted.force;
        Acted { held: [acted.held[0], patch.grips(along.hypot(across), normal) * normal], ..acted }
    }

    /// The couple per normal force with which friction can hold the drilling at the state vector `y`; None without a
    /// patch, or if the drilling is not held.
    pub(super) fn grips<const N: usize>(&self, y: &[f64; N]) -> Option<f64> {
        let patch = self.patch.filter(|_| matches!(self.held(0.0), Held::Drilling))?;
        let (precession, w) = self.turning(core::array::from_fn(|i| y[i]));
        let [normal, along, across] = self.law.at(y.angle(), precession, w, Held::Drilling).force;
        Some(patch.grips(along.hypot(across), normal))
    }

    /// The slow slip (creep) of the contact point of a drilling patch under the contact force of the state `y`; None
    /// if it does not creep.
    pub fn creeps(&self, y: &State) -> Option<[f64; 2]> {
        let (patch, Force { normal, along, across }) = (self.patch?, self.force(y));
        patch.begins_to_creep([across, along], normal, self.drills(y.theta.sin_cos(), y.w1, y.w3))
    }
}
