//! The slip on a patch of contact, which creeps as long as the body drills ([`patch`](crate::laws::contact::patch)).
//!
//! ```text
//! S = |u|,   R = eps |w_z|,   dt = (S + R)/(S + R + soft) dsigma
//! u -> its slow value at the rate (mu N/R) b     of which a time step of dsigma ~ 1 follows a part
//! ```
//! Where the patch drills slowly, u follows the forces of rolling thousands of times faster than the body moves, and
//! [`radau`] takes the steps.

use super::{Own, Slide};
use crate::laws::body::Shape;
use crate::laws::contact::slip::SlipResponse;
use crate::laws::state::{drilling_of, rolling_of};
use crate::methods::flow::{Flow, FlowPlace};
use crate::methods::{radau, rk8};
use crate::motions::body::roll::lossy::REST;
use crate::motions::dry::creep::{Rubbing, is_fast, known_slip, slopes, stable_time};
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, Halt, SIN, TIME, U2, UH, W1, W2, W3, loses, poses,
};
use crate::numbers::Dual;
use nalgebra::SMatrix;

/// The number of numbers that react to each other: sine, cosine, w and u.
const REACTING: usize = 7;
/// The slip of a uniform ball has died where it is below this share of the tolerance, and where it differs by less than
/// `STEADY` tolerances from that of a creep, which steps do not follow more closely.
const DEAD: f64 = 0.03;
const STEADY: f64 = 0.3;

/// Whether a body neither rolls nor rocks.
pub(in crate::motions::body) fn is_still<const N: usize>(y: &[f64; N]) -> bool {
    rolling_of(y.angle(), y[W1], y[W3]).hypot(y[W2]) < REST
}

impl<L: Own> Slide<L> {
    /// Writes the rates of the numbers on a patch of contact, whose couple also produces heat.
    #[inline(never)]
    pub(super) fn patched<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) -> SlipResponse<f64> {
        let (at, pace, heat) = self.law.answers(y.angle(), y.w(), y.slip());
        self.law.writes(y, all, (&at, pace));
        all[HEAT] += pace * heat;
        if self.died {
            (all[UH], all[U2]) = (0.0, 0.0);
        }
        at
    }

    /// The speed of the slip, and under a patch also that of its rim by the drilling.
    #[inline(never)]
    pub(in crate::motions::body) fn rubs<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let drilling = drilling_of(y.angle(), y[W1], y[W3]);
        let patched = |patch| Rubbing::of(y.slip(), drilling, patch).speed();
        self.law.patch().map_or(y[UH].hypot(y[U2]), patched)
    }

    /// Whether a patch of contact drills, so that its contact point creeps.
    pub(in crate::motions::body) fn creeps<const N: usize>(&self, y: &[f64; N]) -> bool {
        self.law.patch().is_some() && self.rubs(y) > self.over()
    }

    /// The rubbing speeds of the patch, with slopes in sigma; None for a point.
    fn rubbing<const N: usize>(&self, place: &FlowPlace<N>) -> Option<Rubbing<Dual<f64>>> {
        let [s, c, w1, _, w3, u_h, u_2] =
            core::array::from_fn(|i| Dual { value: place.y[i], slope: place.rate[i] });
        self.sloped.patch().map(|patch| Rubbing::of([u_h, u_2], drilling_of((s, c), w1, w3), patch))
    }

    /// The slip of the creep of a uniform ball on a patch; it is zero while the ball does not roll. None for another body,
    /// and with poses where the slip does not vanish, since it would turn with e_h.
    fn creep_of<const N: usize>(&self, y: &[f64; N]) -> Option<[f64; 2]> {
        let (creeping, angle) = (self.creeping?, y.angle());
        if creeping.k == 0.0 || is_still(y) {
            return Some([0.0; 2]);
        }
        let way = [y[W2], -rolling_of(angle, y[W1], y[W3])];
        let turn = self.law.patch()? * drilling_of(angle, y[W1], y[W3]).abs();
        (!poses(N)).then(|| way.map(|v| creeping.k * turn * v / way[0].hypot(way[1])))
    }

    /// The difference of the slip of a uniform ball from its creep, if it has died: nothing feeds it while the ball
    /// drills.
    #[inline(never)]
    pub(in crate::motions::body) fn has_died<const N: usize>(&self, y: &[f64; N]) -> Option<[f64; 2]> {
        let creep = self.creep_of(y)?;
        let left = [y[UH] - creep[0], y[U2] - creep[1]];
        let share = if creep == [0.0; 2] { DEAD } else { STEADY };
        let dead = left[0].hypot(left[1]) <= share * self.tol * Self::fastest(y);
        (dead && self.creeps(y)).then_some(left)
    }

    /// Whether a uniform ball on a patch does not drill but for rounding, so that it rolls on for ever without losses.
    pub(in crate::motions::body) fn no_longer_drills<const N: usize>(&self, y: &[f64; N]) -> bool {
        let drilling = drilling_of(y.angle(), y[W1], y[W3]);
        self.law.losses.is_none()
            && self.creeping.is_some()
            && drilling.abs() <= f64::EPSILON * Self::fastest(y)
    }

    /// The halt of a patch that no longer slips or drills, or of a slip that has died.
    #[inline(never)]
    pub(super) fn hardly_rubs<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(Halt, [f64; N])> {
        let (radius, rubbing) = (self.law.patch()?, self.rubbing(place)?);
        if !self.died && self.has_died(&place.y).is_some() {
            return Some((Halt::Standstill, place.y));
        }
        let left = rubbing.left(place.rate[TIME]);
        let mut rests: [f64; N] = core::array::from_fn(|i| place.y[i] + left * place.rate[i]);
        (rests[UH], rests[U2]) = (0.0, 0.0);
        rubbing.comes_to_rest(radius).then(|| (Halt::Standstill, self.kept(rests)))
    }

    /// The response for margins with their slopes, of which there is one copy for a patch.
    #[inline(never)]
    pub(super) fn sloped_on(
        &self,
        (s, c): (Dual<f64>, Dual<f64>),
        w: [Dual<f64>; 3],
        u: [Dual<f64>; 2],
        patch: Dual<f64>,
    ) -> (SlipResponse<Dual<f64>>, Dual<f64>, Dual<f64>) {
        self.sloped.on_patch((s, c), w, u, patch)
    }

    /// The longest step in sigma towards and past k = 1.
    #[inline(never)]
    pub(super) fn kinked<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        self.rubbing(place).map_or(f64::INFINITY, |rubbing| rubbing.longest(self.tol))
    }

    /// Whether u, or psi' under a couple that grows with it, follows the motion much faster than the body turns.
    #[inline(never)]
    pub(super) fn creeps_fast<const N: usize>(&self, place: &FlowPlace<N>) -> bool {
        is_fast(self.follows_within(place), self.calm(&place.y))
    }

    /// The longest time step in which u, and a psi' under a couple that grows with it, follow the motion by explicit
    /// steps. The heat of the friction tells the normal force, and the rims how much a force changes the slip.
    pub(crate) fn follows_within<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        let (y, rate, Shape { rim, i1, i3 }) = (&place.y, &place.rate, &self.law.shape);
        let angle = y.angle();
        let (lever, height, depth, radius) =
            (rim.lever(angle), rim.height(angle), rim.depth(angle), rim.radius(angle));
        let eased = (height * height / (i1 + lever * lever)).max(depth * depth / i1 + radius * radius / i3);
        let turn = self.law.patch().unwrap_or(0.0) * drilling_of(y.angle(), y[W1], y[W3]);
        let damped = if loses(N) { self.damped(y) } else { f64::INFINITY };
        damped.min(stable_time([y[UH], y[U2], turn], rate[HEAT] / rate[TIME], 1.0 + eased))
    }

    /// An implicit step and its stages.
    pub(super) fn creeps_on<const N: usize>(
        &self,
        from: &FlowPlace<N>,
        h: f64,
        guess: radau::Guess<N>,
    ) -> (rk8::Step<f64, N>, radau::Collocated<N>) {
        let y = &from.y;
        let (fast, converged) = (Self::fastest(y), 0.01 * self.tol);
        let slip = known_slip(self.rubs(y), self.law.patch().unwrap_or(0.0), fast, converged);
        let sizes = [y[SIN], 1.0, fast, fast, fast, slip, slip];
        let middle = radau::middle(y, &guess);
        let sizes_at = [y[SIN], 1.0, fast, fast, fast, slip, slip];
        // Differences would not resolve a patch that hardly drills.
        let points = L::IS && self.law.patch().is_none();
        let slopes =
            if points { slopes(&middle, &sizes_at, |y| self.rates(y)) } else { self.slopes(&middle) };
        radau::step(|y, all| self.write_rates(y, all), y, &slopes, &sizes, (h, converged), guess)
    }

    /// The derivatives of the rates of sine, cosine, w and u by these numbers.
    fn slopes<const N: usize>(&self, y: &[f64; N]) -> SMatrix<f64, REACTING, REACTING> {
        let Some(patch) = self.sloped.patch() else { return SMatrix::zeros() };
        let mut all = SMatrix::zeros();
        for j in 0..REACTING {
            let y: [Dual<f64>; REACTING + 1] =
                core::array::from_fn(|i| Dual { value: y[i], slope: f64::from(u8::from(i == j)) });
            let ([s, c], w, u) = ([y[SIN], y[COS]], y.w(), y.slip());
            let (at, pace, _) = self.sloped_on((s, c), w, u, patch);
            let mut rates = y;
            self.sloped.writes(&y, &mut rates, (&at, pace));
            (0..REACTING).for_each(|i| all[(i, j)] = rates[i].slope);
        }
        all
    }
}
