//! Flights and impacts of bodies and stones: how a flight begins, the sum of endless small bounces, and how impacts
//! multiply errors.
//!
//! ```text
//! bounces             last 2 u_n/(G (1 - q)) in all,  G = a_n N0,  q the ratio of the next bounce to this one
//! contact             where 2 u_n^2 < TAIL G (1 - q): the last impact is taken with e = 0
//! ```
//! The summed impulses of the last bounces agree with the contact force to first order, and to second order where the
//! contact point slips. Where it sticks, it has moved in each flight before: the error of the sum is of second order,
//! about TAIL, and part of the estimated error. The work of friction in all bounces counts as lost in impacts.

use super::numbers::lost;
use super::two_runs::CHANCE;
use super::{Next, Phases, Walk};
use crate::laws::contact::delassus::Delassus;
use crate::laws::contact::impact::{Hit, PointImpact, Struck};
use crate::laws::contact::landing::REVERSES;
use crate::laws::contact::sliding::PatchedPoint;
use crate::laws::contact::{ImpactLaw, Table};
use crate::laws::custom::SpeedLaw;
use crate::motions::{Ending, Kind, Method, Moving};

/// Largest share by which the summed bounces may change the state, over the tolerance of many motions at once; the
/// product stays between `TAIL` and `LONGEST_TAIL`.
const TAIL_SHARE: f64 = 0.1;
const TAIL: f64 = 1e-13;
const LONGEST_TAIL: f64 = 1e-10;
/// Further factor of the share by which summed bounces may change the state, for a body with losses, which act at a
/// contact, but not on a body that bounces.
const LOSSY_TAIL: f64 = 1e-8;
/// Relative error of the state by the sum of the bounces, in units of their total time and of their first vertical
/// velocity.
const SUM_ERROR: f64 = 1.0;
/// Relative error of the state by the sum of bounces that slip, in units of their vertical velocity over the slip.
const TURNS: f64 = 10.0;
/// The tolerance of a step in the integration of an impact, over that of the motion; the product stays within
/// `IMPACT_TOL`.
const IMPACT_SHARE: f64 = 1e-4;
const IMPACT_TOL: [f64; 2] = [3e-14, 1e-12];
/// The tolerance of a step in the integration of an impact whose coefficient of friction depends on the speed, over
/// that of the motion.
const OWN_IMPACT_TOL: f64 = 1e-3;
/// The first step of the run with the larger tolerance is this many times as long as in the other run, so that the
/// steps of the two runs differ.
pub(crate) const LONGER: f64 = 3.0;
/// The normal force without friction, N0, counts as a rounding error if it is below this share of its terms.
pub(crate) const ROUNDED: f64 = 1e-12;
/// A second-order term of the height in a flight may be an error of the state if it is smaller than this, in units of
/// that of free fall.
pub(crate) const HARDLY: f64 = 1e-8;
/// A bounce in which the body turns by less than this angle is short; its landing is that of a power series.
pub(crate) const SHORT_BOUNCE: f64 = 0.1;
/// At its radius of use each term of a flight's power series is this many times smaller than the one before. A
/// landing before the share `EARLY` of that radius is sought with fewer terms, of which the last is below
/// exp(-DIGITS).
const NARROWS: f64 = 3.0;
const EARLY: f64 = 0.5;
const DIGITS: f64 = 36.0;
/// An impact without a unique impulse counts as a jam (Painleve) only if its impulse is larger than this share of the
/// slip.
pub(crate) const JAM_TAKES: f64 = 1e-9;

/// How a point begins its flight: `None` above the table, or `Some(k)` on the table with a height that grows as t^k.
pub(crate) type Leaves = Option<usize>;

/// The height and velocity with which a flight begins.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Takeoff {
    /// The height of the lowest point of the body; `lift` is its vertical velocity.
    pub height: f64,
    pub lift: f64,
    /// The power of time with which the point leaves the table; None for a start above the table.
    pub leaves: Leaves,
}

/// What the computation of a motion records about flights and impacts.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Hops {
    /// The beginning of the next flight, or the height and the vertical velocity of a body in the air.
    pub takeoff: Takeoff,
    /// The energy lost in the impacts before the last one. `energy` is the sum of the energy, the heat of friction
    /// and all losses at the start.
    pub struck: f64,
    energy: Option<f64>,
    /// The sum of step errors up to the last perturbation of the run with the larger tolerance.
    shown: f64,
}

/// The number of terms that the power series of a flight needs up to a landing at the share `early` of its radius, if
/// the height begins as the power `order` of time; None if it needs all terms.
pub(crate) fn terms_until(early: f64, order: usize) -> Option<usize> {
    (early > 0.0 && early < EARLY).then(|| order + 2 + (DIGITS / (NARROWS / early).ln()) as usize)
}

/// An impact after which the body bounces, and the forces that would act on it in contact.
pub(crate) struct Bounce<'a> {
    pub struck: &'a Struck,
    pub light: &'a Delassus,
    /// The patch of contact after the impact.
    pub patch: Option<PatchedPoint>,
    /// N0, the normal force without friction.
    pub force: f64,
    /// Whether losses act at the contact.
    pub loses: bool,
}

impl<P: Phases<N>, const N: usize> Walk<'_, P, N> {
    /// The impact of a point of the body. The run with the larger tolerance begins its integration with a longer
    /// step, so that the two runs take different steps.
    pub fn point_impact(
        &self,
        (slip, lift): ([f64; 2], f64),
        (light, patch): (Delassus, Option<PatchedPoint>),
        own: &impl SpeedLaw,
    ) -> PointImpact {
        let (longer, rougher) = if self.perturbation > 0.0 {
            (LONGER, self.perturbation * P::State::SAFETY / f64::EPSILON)
        } else {
            (1.0, 1.0)
        };
        let fine = self.of.tol() / rougher;
        let tol = (IMPACT_SHARE * fine).clamp(IMPACT_TOL[0], IMPACT_TOL[1]);
        // A law of the user need not be smooth.
        let tol = if own.varies() { OWN_IMPACT_TOL * fine } else { tol };
        PointImpact { slip, lift, light, patch, law: self.ask.impact_law, tol: tol * rougher, longer }
    }

    /// The total time of all bounces after an impact; None unless it is so short that the bounces are summed. `rates`
    /// is the acceleration of the slip without a contact force.
    pub fn bounces_for(
        &self,
        Bounce { struck, light, patch, force, loses }: &Bounce<'_>,
        e: f64,
        own: &impl SpeedLaw,
        rates: impl FnOnce() -> [f64; 2],
    ) -> Option<f64> {
        let fall = light.normal * force;
        // Both runs of a sweep have its tolerance, so that they end their bounces together.
        let tail = match self.ask.method {
            Method::Tolerance(tol) => (TAIL_SHARE * tol).clamp(TAIL, LONGEST_TAIL),
            _ => TAIL,
        };
        let tail = if *loses { LOSSY_TAIL * tail } else { tail };
        if !(struck.lift > 0.0 && *force > 0.0) || 2.0 * struck.lift * struck.lift >= tail * fall {
            return None;
        }
        let mut ratio = e;
        // A slip as slow as the bounce reverses in each impact, and the flight after it brings it back.
        let [u, v] = struck.slip.map(|u| u / struck.lift);
        if struck.hit == Hit::Sticks || u.hypot(v) < REVERSES {
            // Each bounce has the slip that the previous flight has caused.
            let [faster, aside] = rates().map(|rate| 2.0 * rate / fall);
            // In units of the bounce, unless a law of the user has a speed of its own.
            let unit = if own.varies() { struck.lift } else { 1.0 };
            let slip = [u + faster, v + aside].map(|u| u * unit);
            let drills = |patch: PatchedPoint| patch.drilling / struck.lift * unit;
            let patch = patch.map(|patch| PatchedPoint { drilling: drills(patch), ..patch });
            let next = self.point_impact((slip, -unit), (**light, patch), own);
            ratio = next.on(&self.ask.table, e, own).map_or(1.0, |next| next.lift / unit);
        }
        let left = 2.0 * struck.lift / (fall * (1.0 - ratio));
        (ratio < 1.0 && left * struck.lift < tail).then_some(left)
    }

    /// Counts the work of friction in summed bounces as lost in impacts, and not as the heat of a slip. Includes the
    /// error of the sum in the estimated error. The bounces take the time `left`, and begin with the velocity
    /// `bounce`; `power` is that of friction, which takes energy from the slip after them. Returns the relative
    /// error.
    pub fn sums_bounces(&mut self, (left, bounce): (f64, f64), [slip, power]: [f64; 2], w: [f64; 3]) -> f64 {
        let mut share = SUM_ERROR * left * bounce;
        if slip > 0.0 {
            let heat = left * power;
            if let Some(last) = self.made.path.impacts.last_mut() {
                last.lost += heat;
                self.at[P::HEAT] -= heat;
            }
            // A slip whose direction hardly turns between the bounces has the same impulses, at the same mean time.
            share *= (TURNS * bounce / slip).min(1.0);
        }
        self.claims(share * w.into_iter().fold(1.0, |most: f64, w| most.max(w.abs())));
        self.doubts(share);
        share
    }

    /// Returns the time of a landing at `t`, whose error `late` is included in the estimated error. The run with the
    /// larger tolerance lands sooner or later by more than `late`, to show what this error does to the motion.
    pub fn claims_landing(&mut self, t: f64, late: f64) -> f64 {
        self.claims(late);
        let shown = self.shows() * self.sign_of_rounding();
        // This part of the difference of the runs is not a step error that has grown.
        self.made.path.erred += late * shown.abs();
        (t + late * shown).max(0.0)
    }

    /// The share by which the run with the larger tolerance perturbs the state at the end of each phase of the
    /// motion. After impacts it includes a share of the step errors since the last perturbation: impacts multiply
    /// step errors, and where both runs take the same steps only the perturbation shows by how much.
    pub fn share_of_errors(&mut self) -> f64 {
        let mut share = self.perturbation;
        if share > 0.0 && !self.made.path.impacts.is_empty() {
            let erred = self.spent.erred - core::mem::replace(&mut self.hops.shown, self.spent.erred);
            share += CHANCE * erred * self.of.tol() * self.sign_of_rounding();
        }
        share
    }

    /// Includes a relative error of the state, which both runs make alike, in the estimated error. It perturbs the
    /// run with the larger tolerance, so that the difference of the runs includes this error and its growth.
    pub fn doubts(&mut self, share: f64) {
        P::perturbs_by(self, share * self.shows() * self.sign_of_rounding());
    }

    /// The sign of a perturbation after the last impact, irregular like that of a rounding error: thousands of errors
    /// of one sign would add up to more than roundings do.
    pub fn sign_of_rounding(&self) -> f64 {
        let mixed = (self.made.path.impacts.len() as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        if mixed >> 63 == 0 { 1.0 } else { -1.0 }
    }

    /// Includes the error of the energy balance in the estimated error: the energy plus heat and all losses, minus
    /// their sum at the start, over the largest speed.
    pub fn compares_energy_with_start(&mut self, energy: f64, fastest: f64) {
        let last = self.made.path.impacts.last().map_or(0.0, |hit| hit.lost);
        let whole = energy + self.at[P::HEAT] + self.hops.struck + last + lost(&self.at);
        let first = *self.hops.energy.get_or_insert(whole);
        self.claims((whole - first).abs() / fastest);
    }

    /// The phase after lift-off: a flight, or the end of the motion if only rolling friction lifts the body. `free`
    /// is N0, the normal force without friction, and `size` that of its terms.
    pub fn lifts_off(&mut self, [free, size]: [f64; 2]) -> Next {
        if matches!(self.ask.table, Table::Rolling { .. }) && free > ROUNDED * size {
            // Friction lifts the body, and on a real table the contact point would slip first.
            return Next::Ends(Ending::Slip);
        }
        let leaves = if free < -ROUNDED * size { 2 } else { 3 };
        self.hops.takeoff = Takeoff { leaves: Some(leaves), ..Takeoff::default() };
        Next::Own(Kind::Flying)
    }

    /// Includes energy that an impact has gained by rounding in the estimated error, under the law of restitution
    /// (Stronge's) that never gains energy.
    pub fn claims_no_gain(&mut self, lost: f64) {
        if self.ask.impact_law == ImpactLaw::Stronge {
            self.claims(-lost);
        }
    }

    /// The phase of contact that begins where the normal velocity is zero.
    pub fn touches_down(&mut self) -> Next {
        self.hops.takeoff = Takeoff::default();
        self.first_phase().unwrap_or(Next::Ends(Ending::Painleve))
    }
}
