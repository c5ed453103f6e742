//! Rolling on a patch of contact: drilling friction whose length depends on the force, and the return to a slip.
//!
//! ```text
//! length = mu eps g(k),   f(k) = |F|/(mu N)        a fixed point, since the force depends little on the length
//! w_z -> 0      rolls through it, or is held while |nu| <= length N
//! |w_z| = 2 DRILLS, or |F| = mu N                  slips, with u = -eps |w_z| k F/|F|
//! ```
//! As long as a patch drills, its contact point creeps, and the slip has this size ([`patch`]). Where the drilling
//! vanishes, the slip also vanishes, faster and faster, so that the body rolls through that moment.
//!
//! Error: the slip that is left out, which is DRILLS eps at most.

use super::LossyFlow;
use crate::laws::contact::lossy::{Acted, Held, Lossy};
use crate::laws::contact::slip::Friction;
use crate::laws::contact::{Force, patch};
use crate::laws::loss::{Law, Losses};
use crate::laws::state::{State, drilling_of};
use crate::motions::body::own::Own;
use crate::motions::dry::creep::{DRILLS, slip_under};
use crate::motions::walk::numbers::{BodyNumbers, HEAT, MARGINS, TIME};
use crate::numbers::{Dual, Real};

/// Largest number of evaluations for the length of drilling friction.
const FITS: usize = 20;

/// These losses, with the drilling friction of a patch that carries no horizontal force.
pub(crate) fn with_patch(losses: &Losses, friction: &Friction) -> Losses {
    let mut all = *losses;
    if friction.patch() > 0.0 {
        let length = friction.strength() * friction.patch() * patch::of(0.0)[1];
        all.coefficients[Law::Drilling as usize] = length;
    }
    all
}

impl<G: Own> LossyFlow<G> {
    /// The same flow on a patch of contact, whose drilling friction is among the losses.
    pub fn on_patch(mut self, friction: &Friction, y: &State) -> Self {
        if friction.patch() > 0.0 {
            self.slides = friction.strength();
            self.sets_holds(y);
        }
        self
    }

    /// Whether the contact is a patch.
    #[inline(always)]
    pub(in crate::motions::body) fn is_patch(&self) -> bool {
        self.slides > 0.0
    }

    /// The radius of the patch, from the longest length of its drilling friction.
    fn radius(&self) -> f64 {
        self.law.losses.coefficient(Law::Drilling) / (self.slides * patch::of(0.0)[1])
    }

    /// The response on a patch, and the law with the length that belongs to its force.
    #[inline(never)]
    pub(super) fn acts_on_patch(
        &self,
        law: &Lossy<f64, G>,
        angle: (f64, f64),
        precession: f64,
        (w, held): ([f64; 3], Held<f64>),
    ) -> (Acted<f64>, Lossy<f64, G>) {
        let (mu, eps) = (self.slides, self.radius());
        let (mut law, mut fits) = (*law, 0);
        loop {
            let acted = law.at(angle, precession, w, held);
            let length = mu * eps * patch::of(creep(mu, acted.force))[1];
            let change = length - law.losses.coefficient(Law::Drilling);
            fits += 1;
            if change.abs() <= f64::EPSILON * mu * eps || fits == FITS {
                return (acted, law);
            }
            law.losses.sets(Law::Drilling, length);
        }
    }

    /// The law with the length that belongs to the force at these numbers.
    fn fitted(&self, y: [f64; 5]) -> Lossy<f64, G> {
        let (precession, w) = self.turning(y);
        self.acts_on_patch(&self.law, y.angle(), precession, (w, self.held(0.0))).1
    }

    #[inline(never)]
    pub(super) fn margin_on_patch(&self, y: [f64; 5], i: usize) -> f64 {
        ends_where_it_drills(self, self.margins_of(&self.fitted(y), y), y)[i]
    }

    /// The margins with their slopes, which neglect the change of the length.
    #[inline(never)]
    pub(super) fn margins_on_patch(&self, y: [Dual<f64>; 5]) -> [Dual<f64>; MARGINS] {
        let length = self.fitted(y.map(|x| x.value)).losses.coefficient(Law::Drilling);
        let mut law = self.sloped;
        law.losses.sets(Law::Drilling, Dual { value: length, slope: 0.0 });
        ends_where_it_drills(self, self.margins_of(&law, y), y)
    }

    /// Writes the rates of the numbers; the couple of the patch is friction, which makes heat.
    #[inline(never)]
    pub(super) fn rates_on_patch<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        let ([w1, _, w3], force) = self.rates(y, all);
        let (mu, eps) = (self.slides, self.radius());
        let drilling = drilling_of(y.angle(), w1, w3).abs();
        let heat = all[TIME] * mu * force[0] * eps * patch::of(creep(mu, force))[1] * drilling;
        (all[HEAT], all[N - 1]) = (heat, all[N - 1] - heat);
    }

    /// The slip of a contact point on a patch that creeps under the contact force of this state.
    pub fn creeps(&self, y: &State) -> Option<[f64; 2]> {
        if !self.is_patch() {
            return None;
        }
        let (mu, eps) = (self.slides, self.radius());
        let Force { normal, along, across } = self.force(y);
        let (s, c) = y.theta.sin_cos();
        let turn = eps * drilling_of((s, c), y.w1, y.w3).abs();
        slip_under([across, along], mu * normal, turn, eps)
    }
}

/// The margins; that of a slip also fails where the patch drills.
fn ends_where_it_drills<T: Real, G: Own>(
    flow: &LossyFlow<G>,
    mut margins: [T; MARGINS],
    y: [T; 5],
) -> [T; MARGINS] {
    let (_, w) = flow.turning(y);
    let drilling = drilling_of(y.angle(), w[0], w[2]).abs();
    margins[3] = margins[3].min(drilling.splat(2.0 * DRILLS) - drilling);
    margins
}

/// The k at which the friction of a patch is this force.
fn creep(mu: f64, [normal, along, across]: [f64; 3]) -> f64 {
    patch::slip_for((along.hypot(across) / (mu * normal.max(f64::MIN_POSITIVE))).min(1.0))
}
