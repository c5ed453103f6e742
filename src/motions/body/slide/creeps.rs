//! The slip on a patch of contact, which creeps as long as the body drills ([`patch`](crate::laws::contact::patch)).
//!
//! ```text
//! S = |u|,   R = eps |w_z|,   dt = (S + R)/(S + R + soft) dsigma
//! u -> its slow value at the rate (mu N/R) b     of which a time step of dsigma ~ 1 follows a part
//! ```
//! Where the patch drills slowly, u approaches its slow value thousands of times faster than the body moves, and the
//! integration steps are implicit ([`Creeps`]).

use super::{Own, Slide};
use crate::laws::body::Shape;
use crate::laws::contact::slip::SlipResponse;
use crate::laws::state::{drilling_of, rolling_of};
use crate::methods::flow::{Flow, FlowPlace};
use crate::motions::body::roll::lossy::REST;
use crate::motions::dry::creep::{Creeps, derivatives, slopes};
use crate::motions::walk::numbers::{
    BodyNumbers, HEAT, Halt, MARGINS, SIN, U2, UH, W1, W2, W3, loses, poses, pull,
};
use crate::numbers::{Dual, Real};
use nalgebra::SMatrix;

/// Number of components of the state vector that depend on each other: sine and cosine of theta, w and the slip u.
const REACTING: usize = 7;
/// A slip of a uniform ball on a patch has died out where it is below this share of the tolerance, if its steady creep
/// is zero; else where it differs by less than `STEADY` tolerances from that creep, which integration steps do not
/// follow more closely.
const DEAD: f64 = 0.03;
const STEADY: f64 = 0.3;

/// Whether a body neither rolls nor rocks: w_h and w2 are zero.
pub(in crate::motions::body) fn is_still<const N: usize>(y: &[f64; N]) -> bool {
    rolling_of(y.angle(), y[W1], y[W3]).hypot(y[W2]) < REST
}

impl<L: Own> Slide<L> {
    /// Writes the derivative of the state vector on a patch of contact, whose couple also produces heat.
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

    /// Whether a patch of contact drills, so that its contact point creeps (slips slowly).
    pub(in crate::motions::body) fn creeps<const N: usize>(&self, y: &[f64; N]) -> bool {
        self.law.patch().is_some() && self.rubs(y) > self.over()
    }

    /// The slip of a uniform ball that creeps steadily on a patch; zero while the ball does not roll. None for
    /// another body, and with poses if the slip is not zero, since its components turn with e_h.
    fn creep_of<const N: usize>(&self, y: &[f64; N]) -> Option<[f64; 2]> {
        let level = self.tilt == 0.0 && self.turning == 0.0;
        let (creeping, angle) = (self.creeping.filter(|_| level)?, y.angle());
        if creeping.k == 0.0 || is_still(y) {
            return Some([0.0; 2]);
        }
        let way = [y[W2], -rolling_of(angle, y[W1], y[W3])];
        let turn = self.law.patch()? * drilling_of(angle, y[W1], y[W3]).abs();
        (!poses(N)).then(|| way.map(|v| creeping.k * turn * v / way[0].hypot(way[1])))
    }

    /// The difference of the slip of a uniform ball from that of steady creep, once it has died out; None before.
    /// Nothing makes it grow while the ball drills.
    #[inline(never)]
    pub(in crate::motions::body) fn has_died<const N: usize>(&self, y: &[f64; N]) -> Option<[f64; 2]> {
        let creep = self.creep_of(y)?;
        let left = [y[UH] - creep[0], y[U2] - creep[1]];
        let share = if creep == [0.0; 2] { DEAD } else { STEADY };
        let dead = left[0].hypot(left[1]) <= share * self.tol * Self::fastest(y);
        (dead && self.creeps(y)).then_some(left)
    }

    /// Whether the drilling rate of a uniform ball on a patch is only rounding, so that without losses the ball rolls
    /// for ever.
    pub(in crate::motions::body) fn no_longer_drills<const N: usize>(&self, y: &[f64; N]) -> bool {
        let drilling = drilling_of(y.angle(), y[W1], y[W3]);
        self.law.losses.is_none()
            && self.creeping.is_some()
            && drilling.abs() <= f64::EPSILON * Self::fastest(y)
    }

    /// The halt of a patch that has stopped slipping or drilling, or of a slip that has died out; else None.
    pub(super) fn rubs_no_more<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(Halt, [f64; N])> {
        if !self.died && self.has_died(&place.y).is_some() {
            return Some((Halt::Standstill, place.y));
        }
        self.hardly_rubs(place)
    }

    /// Contact force and accelerations on a patch, with their slopes, compiled as one copy.
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
}

impl<L: Own> Creeps<MARGINS, REACTING> for Slide<L> {
    const SLIP: usize = UH;
    const HEATED: usize = HEAT;

    #[inline(always)]
    fn radius(&self) -> Option<f64> {
        self.law.patch()
    }

    fn allowed(&self) -> f64 {
        self.tol
    }

    #[inline(always)]
    fn sliding<T: Real, const N: usize>(y: &[T; N]) -> [T; 2] {
        y.slip()
    }

    #[inline(always)]
    fn drilling<T: Real, const N: usize>(&self, y: &[T; N]) -> T {
        drilling_of(y.angle(), y[W1], y[W3]) - y[W1].splat(self.turning)
    }

    /// The change of the slip by a unit force, from the shape and inertia of the body.
    fn eased<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let (angle, Shape { rim, i1, i3 }) = (y.angle(), &self.law.shape);
        let (lever, height, depth, radius) =
            (rim.lever(angle), rim.height(angle), rim.depth(angle), rim.radius(angle));
        1.0 + (height * height / (i1 + lever * lever)).max(depth * depth / i1 + radius * radius / i3)
    }

    fn sizes<const N: usize>(y: &[f64; N], fast: f64, slip: f64) -> [f64; REACTING] {
        [y[SIN], 1.0, fast, fast, fast, slip, slip]
    }

    fn reacting<const N: usize>(
        &self,
        y: &[f64; N],
        sizes: &[f64; REACTING],
    ) -> SMatrix<f64, REACTING, REACTING> {
        let Some(patch) = self.sloped.patch() else {
            return if L::IS { slopes(y, sizes, |y| self.rates(y)) } else { SMatrix::zeros() };
        };
        let [pull_h, pull_2] = pull(self.tilt, y).map(Dual::constant);
        // Differences would not resolve a patch that hardly drills.
        derivatives(y, |[s, c, w1, w2, w3, u_h, u_2]: [Dual<f64>; REACTING]| {
            let (at, pace, _) = self.sloped_on((s, c), [w1, w2, w3], [u_h, u_2], patch);
            let mut all = [s, c, w1, w2, w3, u_h, u_2, pace];
            self.sloped.writes(&{ all }, &mut all, (&at, pace));
            (all[UH], all[U2]) = (all[UH] + pace * pull_h, all[U2] + pace * pull_2);
            core::array::from_fn(|i| all[i])
        })
    }

    /// The time within which the fast parts of the motion decay, including a psi' under a couple that grows with it.
    fn damps_within<const N: usize>(&self, y: &[f64; N]) -> f64 {
        if loses(N) { self.damped(y) } else { f64::INFINITY }
    }
}
