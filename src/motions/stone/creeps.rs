//! The patch of contact of a stone: its equations for [`Creeps`], and the drilling that friction holds at rest.
//!
//! Error: that of [`creep`](crate::motions::dry::creep).

use super::flow::{HOLD, SLID_X, STONE_HEAT, STONE_MARGINS, Seen, StoneFlow, StoneNumbers, Touch, slip_of};
use crate::laws::stone::law::turning;
use crate::methods::SHORT_CODE;
use crate::motions::dry::creep::{Creeps, DRILLS, RestingPatch, derivatives, hardly_drills};
use crate::numbers::vector::{dot, plus};
use crate::numbers::{Dual, Real};
use nalgebra::SMatrix;

/// Number of components of the state vector that depend on each other: the quaternion, w, the time and the slip u.
const STONE_REACTING: usize = 10;
impl StoneFlow<'_> {
    /// The margins (functions whose zeros end the phase) of a stone on a patch, whose contact point is at rest only
    /// while the patch does not drill. `grips` is the couple per normal force that can hold the drilling; its
    /// derivative is left out.
    #[inline(always)]
    pub(super) fn on_patch<T: Real>(
        &self,
        mut margins: [T; STONE_MARGINS],
        (seen, w): (&Seen<T>, [T; 3]),
        grips: f64,
    ) -> [T; STONE_MARGINS] {
        if SHORT_CODE {
            return margins;
        }
        if self.touch == Touch::Held {
            margins[HOLD] =
                margins[HOLD].min(seen.to.free * seen.to.free.splat(grips) - seen.to.couple.abs());
        } else if self.may_drill() {
            margins[HOLD] = margins[HOLD].min(hardly_drills(dot(seen.at.n, w)));
        }
        margins
    }

    /// The patch of contact with its coefficients at rest; None for a point.
    fn patch(&self) -> Option<RestingPatch> {
        self.law.patch().map(|radius| RestingPatch { fixed: self.mu, slides: self.law.strength, radius })
    }

    /// Whether the contact point is at rest on a patch whose drilling friction does not hold.
    fn may_drill(&self) -> bool {
        self.law.patch().is_some() && self.touch == Touch::Rolls && self.watch
    }

    /// The couple per normal force that can hold the drilling together with the contact force; 0 if the drilling is
    /// not held.
    pub(super) fn grips<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let Some(patch) = self.patch().filter(|_| self.touch == Touch::Held) else { return 0.0 };
        let Seen { at, to, .. } = self.seen_at(y);
        let along = plus(to.force, -to.free, at.n);
        patch.grips(dot(along, along).sqrt(), to.free)
    }

    /// Returns the equations of the stone with its contact point at rest: `Held` if friction holds the drilling, else
    /// rolling.
    pub(super) fn resting<const N: usize>(&self, y: &[f64; N]) -> Self {
        let held = Self { touch: Touch::Held, ..*self };
        let holds =
            self.law.patch().is_some() && self.drilling(y).abs() <= DRILLS && held.margins_at(y)[HOLD] >= 0.0;
        if holds { held } else { Self { touch: Touch::Rolls, ..*self } }
    }

    /// The slow slip (creep), along x and y of the laboratory, of a drilling stone that rolls; None if the stone
    /// hardly drills.
    pub(super) fn creeps<const N: usize>(&self, y: &[f64; N]) -> Option<[f64; 2]> {
        let patch = self.patch()?;
        let Seen { lab, to, .. } = Self { touch: Touch::Rolls, ..*self }.seen_at(y);
        let pushed = [0, 1].map(|i| dot(lab[i], to.force));
        patch.begins_to_creep(pushed, to.free, self.drilling(y))
    }
}

impl Creeps<STONE_MARGINS, STONE_REACTING> for StoneFlow<'_> {
    const SLIP: usize = SLID_X;
    const HEATED: usize = STONE_HEAT;

    #[inline(always)]
    fn radius(&self) -> Option<f64> {
        self.law.patch()
    }

    fn allowed(&self) -> f64 {
        self.tol
    }

    #[inline(always)]
    fn sliding<T: Real, const N: usize>(y: &[T; N]) -> [T; 2] {
        slip_of(y)
    }

    #[inline(always)]
    fn drilling<T: Real, const N: usize>(&self, y: &[T; N]) -> T {
        dot(self.axes(y.quaternion())[2], y.omega())
    }

    /// The change of the slip by a unit force, from the shape and inertia of the stone.
    fn eased<const N: usize>(&self, _: &[f64; N]) -> f64 {
        4.0 * self.law.soft / self.law.strength
    }

    fn sizes<const N: usize>(_: &[f64; N], fast: f64, slip: f64) -> [f64; STONE_REACTING] {
        [1.0, 1.0, 1.0, 1.0, fast, fast, fast, 1.0, slip, slip]
    }

    fn reacting<const N: usize>(
        &self,
        y: &[f64; N],
        _: &[f64; STONE_REACTING],
    ) -> SMatrix<f64, STONE_REACTING, STONE_REACTING> {
        derivatives(y, |y: [Dual<f64>; STONE_REACTING]| {
            let (q, w) = (y.quaternion(), y.omega());
            let Seen { lab, at, to, pace } = self.seen::<_, N>(&self.sloped, q, w, Some(y.slid()));
            let rate = self.sloped.slip_rate(&at, w, &to);
            let ([a, b, c, d], [e, f, g]) = (turning(q, w), to.w);
            let one = pace.splat(1.0);
            [a, b, c, d, e, f, g, one, dot(lab[0], rate), dot(lab[1], rate)].map(|rate| pace * rate)
        })
    }
}
