//! The patch of contact of a stone: the slip that creeps while the stone drills, and the drilling that friction holds.
//!
//! ```text
//! |M| <= mu_s N eps g(k),   f(k) = F/(mu_s N)                            holds the drilling
//! |w.n| = 2 DRILLS, or F = mu N                                          begins to slip, with the slip of the creep
//! ```
//! [`creep`](crate::motions::dry::creep) computes the creep. When the drilling passes zero, the stone rolls through it, as a
//! body of revolution does ([`lossy`](crate::motions::body::roll::lossy)); the couple acts only briefly and is left out.
//!
//! Error: the slip that is left out, at most DRILLS eps, and the couple times the time in which w.n passes DRILLS.

use super::flow::{
    HOLD, SLID_X, SLID_Y, STONE_HEAT, STONE_MARGINS, Seen, StoneFlow, StoneNumbers, Touch, slip_of,
};
use crate::laws::contact::patch;
use crate::laws::stone::law::{laboratory, turning};
use crate::methods::flow::{Flow, FlowPlace};
use crate::methods::{SHORT_CODE, radau, rk8};
use crate::motions::dry::creep::{DRILLS, Rubbing, is_fast, known_slip, slip_under, stable_time};
use crate::motions::walk::numbers::{Halt, TIME};
use crate::numbers::vector::{dot, plus};
use crate::numbers::{Dual, Real};
use nalgebra::SMatrix;

/// The number of numbers that react to each other: the quaternion, w, the time and u.
const STONE_REACTING: usize = 10;
/// Largest coefficient of static friction in a couple; an infinite one times zero would be NaN.
const STICKY: f64 = 1e9;

impl StoneFlow<'_> {
    /// The speed of the slip, and the speed of the rim of the patch from the drilling.
    pub(super) fn rubs<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let [u, v] = slip_of(y);
        u.hypot(v) + self.law.patch().map_or(0.0, |patch| patch * self.drilling(y).abs())
    }

    pub(super) fn drilling<const N: usize>(&self, y: &[f64; N]) -> f64 {
        dot(self.seen_at(y).at.n, y.omega())
    }

    /// The speeds of the patch, with slopes in sigma; None for a point, and if the contact point is at rest.
    fn rubbing<const N: usize>(&self, place: &FlowPlace<N>) -> Option<Rubbing<Dual<f64>>> {
        let radius = self.sloped.patch().filter(|_| self.touch == Touch::Slips)?;
        let [a, b, c, d, e, f, g, _, u, v] =
            core::array::from_fn(|i| Dual { value: place.y[i], slope: place.rate[i] });
        Some(Rubbing::of([u, v], dot(laboratory([a, b, c, d])[2], [e, f, g]), radius))
    }

    /// The end of the phase when the patch neither slips nor drills any more.
    #[inline(never)]
    pub(super) fn hardly_rubs<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(Halt, [f64; N])> {
        let (radius, rubbing) = (self.law.patch()?, self.rubbing(place)?);
        let left = rubbing.left(place.rate[TIME]);
        let mut rests: [f64; N] = core::array::from_fn(|i| place.y[i] + left * place.rate[i]);
        (rests[SLID_X], rests[SLID_Y]) = (0.0, 0.0);
        rubbing.comes_to_rest(radius).then(|| (Halt::Standstill, self.kept(rests)))
    }

    /// The margins of a stone on a patch. The contact point is at rest only as long as the patch does not drill. `grips` is
    /// the couple per normal force that can hold the drilling; its derivative is left out.
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
            let drilling = dot(seen.at.n, w).abs();
            margins[HOLD] = margins[HOLD].min(drilling.splat(2.0 * DRILLS) - drilling);
        }
        margins
    }

    /// True if the contact point is at rest on a patch that is not held.
    fn may_drill(&self) -> bool {
        self.law.patch().is_some() && self.touch == Touch::Rolls && self.watch
    }

    /// The couple per normal force that can hold the drilling together with the contact force; 0 if nothing is held.
    pub(super) fn grips<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let Some(radius) = self.law.patch().filter(|_| self.touch == Touch::Held) else { return 0.0 };
        let Seen { at, to, .. } = self.seen_at(y);
        let (mu, along) = (self.mu.min(STICKY), plus(to.force, -to.free, at.n));
        let share = dot(along, along).sqrt() / (mu * to.free.max(f64::MIN_POSITIVE));
        mu * radius * patch::of(patch::slip_for(share.min(1.0)))[1]
    }

    /// Returns the flow of the stone with its contact point at rest: held, if friction holds the drilling.
    pub(super) fn resting<const N: usize>(&self, y: &[f64; N]) -> Self {
        let held = Self { touch: Touch::Held, ..*self };
        let holds =
            self.law.patch().is_some() && self.drilling(y).abs() <= DRILLS && held.margins_at(y)[HOLD] >= 0.0;
        if holds { held } else { Self { touch: Touch::Rolls, ..*self } }
    }

    /// The slip, in the laboratory, of the creep of a rolling stone; None if the stone hardly drills.
    pub(super) fn creeps<const N: usize>(&self, y: &[f64; N]) -> Option<[f64; 2]> {
        let radius = self.law.patch()?;
        let Seen { lab, to, .. } = Self { touch: Touch::Rolls, ..*self }.seen_at(y);
        let pushed = [0, 1].map(|i| dot(lab[i], to.force));
        slip_under(pushed, self.law.strength * to.free, radius * self.drilling(y).abs(), radius)
    }

    /// The longest step in sigma towards and past k = 1.
    #[inline(never)]
    pub(super) fn kinked<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        self.rubbing(place).map_or(f64::INFINITY, |rubbing| rubbing.longest(self.tol))
    }

    /// True if u follows the forces of rolling much faster than the stone turns.
    #[inline(never)]
    pub(super) fn creeps_fast<const N: usize>(&self, place: &FlowPlace<N>) -> bool {
        self.touch == Touch::Slips && is_fast(self.follows_within(place), self.calm(&place.y))
    }

    /// The longest time step in which u follows the motion by explicit steps. The unit of sigma tells how much a force
    /// changes the slip at most.
    pub(super) fn follows_within<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        let ([u, v], turn) = (slip_of(&place.y), self.law.patch().unwrap_or(0.0) * self.drilling(&place.y));
        let eased = 4.0 * self.law.soft / self.law.strength;
        stable_time([u, v, turn], place.rate[STONE_HEAT] / place.rate[TIME], eased)
    }

    /// An implicit step and its stages.
    pub(super) fn creeps_on<const N: usize>(
        &self,
        from: &FlowPlace<N>,
        h: f64,
        guess: radau::Guess<N>,
    ) -> (rk8::Step<f64, N>, radau::Collocated<N>) {
        let y = &from.y;
        let (fast, converged) = (self.fastest(y), 0.01 * self.tol);
        let slip = known_slip(self.rubs(y), self.law.patch().unwrap_or(0.0), fast, converged);
        let sizes = [1.0, 1.0, 1.0, 1.0, fast, fast, fast, 1.0, slip, slip];
        let slopes = self.slopes(&radau::middle(y, &guess));
        radau::step(|y, all| self.write_rates(y, all), y, &slopes, &sizes, (h, converged), guess)
    }

    /// The derivatives of the rates of the quaternion, of w and of u with respect to these numbers and the time.
    fn slopes<const N: usize>(&self, y: &[f64; N]) -> SMatrix<f64, STONE_REACTING, STONE_REACTING> {
        let mut all = SMatrix::zeros();
        for j in 0..STONE_REACTING {
            let dual = |i: usize| Dual { value: y[i], slope: f64::from(u8::from(i == j)) };
            let (q, w) = ([dual(0), dual(1), dual(2), dual(3)], [dual(4), dual(5), dual(6)]);
            let Seen { lab, at, to, pace } = self.seen::<_, N>(&self.sloped, q, w, Some([dual(8), dual(9)]));
            let rate = self.sloped.slip_rate(&at, w, &to);
            let ([a, b, c, d], [e, f, g]) = (turning(q, w), to.w);
            let one = pace.splat(1.0);
            let rates = [a, b, c, d, e, f, g, one, dot(lab[0], rate), dot(lab[1], rate)];
            (0..STONE_REACTING).for_each(|i| all[(i, j)] = (pace * rates[i]).slope);
        }
        all
    }
}
