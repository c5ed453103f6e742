//! Flights and impacts of any body: how a flight begins, the bounces that are summed, and the errors that impacts multiply.
//!
//! ```text
//! bounces             last 2 u_n/(G (1 - q)) in all,  G = a_n N0,  q the ratio of the next bounce to this one
//! contact             where 2 u_n^2 < TAIL G (1 - q): the last impact is taken with e = 0
//! ```
//! The impulses of the bounces that are summed agree with the contact force to first order, and to second order where
//! they slip. Where they stick, the contact point has moved in each flight before: the error of their sum is of second
//! order, about TAIL, and part of the estimated error. The friction of all bounces is lost in impacts.

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

/// Share of the state that the summed bounces may change: this part of the tolerance of a sweep, within these two
/// limits.
const TAIL_SHARE: f64 = 0.1;
const TAIL: f64 = 1e-13;
const LONGEST_TAIL: f64 = 1e-10;
/// The same share for a body with losses, which act at a contact, but not on a body that bounces.
const LOSSY_TAIL: f64 = 1e-8;
/// Relative error of the numbers by the sum of the bounces, in units of their time and their first velocity.
const SUM_ERROR: f64 = 1.0;
/// The same error of bounces that slip, in units of their velocity over that of the slip.
const TURNS: f64 = 10.0;
/// The tolerance of a step along an impact: this share of that of a motion, within these two limits.
const IMPACT_SHARE: f64 = 1e-4;
const IMPACT_TOL: [f64; 2] = [3e-14, 1e-12];
/// The same tolerance under a coefficient that depends on the speed, in units of the tolerance of the motion.
const OWN_IMPACT_TOL: f64 = 1e-3;
/// The first step of a rougher run is this many times as long as that of the finer run, so that their steps differ.
pub(crate) const LONGER: f64 = 3.0;
/// Share of its terms below which N0 is a rounding error.
pub(crate) const ROUNDED: f64 = 1e-12;
/// A term of the second order of a height that is smaller than this, in units of the fall, may be an error of the numbers.
pub(crate) const HARDLY: f64 = 1e-8;
/// A bounce in which the body turns by less than this angle is short; its landing is that of a power series.
pub(crate) const SHORT_BOUNCE: f64 = 0.1;
/// Within its radius the terms of a series fall by this factor; a landing before this share of it is sought with fewer
/// terms, of which the last is below exp(-DIGITS).
const NARROWS: f64 = 3.0;
const EARLY: f64 = 0.5;
const DIGITS: f64 = 36.0;
/// A jam needs a larger impulse than this share of the slip.
pub(crate) const JAM_TAKES: f64 = 1e-9;

/// The beginning of a point's flight: above the table, or on the table with a height that grows as t^k.
pub(crate) type Leaves = Option<usize>;

/// The beginning of a flight.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Takeoff {
    /// The height of the lowest point, and its vertical velocity.
    pub height: f64,
    pub lift: f64,
    /// The power of time with which the point leaves the table; None for a start above the table.
    pub leaves: Leaves,
}

/// What a walk knows of its flights and impacts.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Hops {
    /// The beginning of the next flight, or the height and the vertical velocity of a body in the air.
    pub takeoff: Takeoff,
    /// The energy that the impacts before the last one have taken, and the sum of energy, heat and all that was lost
    /// at the start.
    pub struck: f64,
    energy: Option<f64>,
    /// The step errors by which a rougher run has been perturbed.
    shown: f64,
}

/// The number of terms that a series needs up to a landing as early as this share of its radius, where the height leaves the
/// table as a power of time of this order; None if it needs all of them.
pub(crate) fn terms_until(early: f64, order: usize) -> Option<usize> {
    (early > 0.0 && early < EARLY).then(|| order + 2 + (DIGITS / (NARROWS / early).ln()) as usize)
}

/// A bounce, and what acts on the body after it.
pub(crate) struct Bounce<'a> {
    pub struck: &'a Struck,
    pub light: &'a Delassus,
    /// The patch of contact after it.
    pub patch: Option<PatchedPoint>,
    /// N0, the normal force without friction.
    pub force: f64,
    /// Whether losses act at the contact.
    pub loses: bool,
}

impl<P: Phases<N>, const N: usize> Walk<'_, P, N> {
    /// The impact of a point of the body. A rougher run begins it with a longer step, so that the two runs take different
    /// steps.
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

    /// The time of all bounces after an impact, if they are over so soon that they are summed. `rates` are those of the
    /// slip without a contact force.
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

    /// Counts the friction of the bounces that are summed as lost in impacts, as that of all other bounces, and not as
    /// the heat of a slip. Includes the error of the sum in the estimated error. The bounces take the time `left`, and
    /// begin with the velocity `bounce`; `power` is that of friction, which takes energy from the slip after them. Returns
    /// the relative error.
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

    /// The time of a landing at `t`, which is as uncertain as `late`. A rougher run lands sooner or later by more than
    /// this error.
    pub fn claims_landing(&mut self, t: f64, late: f64) -> f64 {
        self.claims(late);
        let shown = self.shows() * self.sign_of_rounding();
        // This part of the difference of the runs is not a step error that has grown.
        self.made.path.erred += late * shown.abs();
        (t + late * shown).max(0.0)
    }

    /// The share by which a rougher run perturbs the state at the end of a phase. A motion that has hopped is also
    /// perturbed by a share of the step errors since the last time: impacts multiply them, and where both runs take the
    /// same steps only this shows by how much.
    pub fn share_of_errors(&mut self) -> f64 {
        let mut share = self.perturbation;
        if share > 0.0 && !self.made.path.impacts.is_empty() {
            let erred = self.spent.erred - core::mem::replace(&mut self.hops.shown, self.spent.erred);
            share += CHANCE * erred * self.of.tol() * self.sign_of_rounding();
        }
        share
    }

    /// Includes a relative error of the numbers in the estimated error, although both runs make the same error: the
    /// rougher run is perturbed by as much as the difference of the runs has to show. The growth of the error is then
    /// that of the difference.
    pub fn doubts(&mut self, share: f64) {
        P::perturbs_by(self, share * self.shows() * self.sign_of_rounding());
    }

    /// The sign of a perturbation after this impact, as irregular as that of a rounding error: thousands of errors of one sign
    /// would add up to more than roundings do.
    pub fn sign_of_rounding(&self) -> f64 {
        let mixed = (self.made.path.impacts.len() as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        if mixed >> 63 == 0 { 1.0 } else { -1.0 }
    }

    /// Compares the energy of the body, with all that has been taken from it, with that at the start. Their difference,
    /// over the largest speed, is an error of the numbers.
    pub fn compares_energy_with_start(&mut self, energy: f64, fastest: f64) {
        let last = self.made.path.impacts.last().map_or(0.0, |hit| hit.lost);
        let whole = energy + self.at[P::HEAT] + self.hops.struck + last + lost(&self.at);
        let first = *self.hops.energy.get_or_insert(whole);
        self.claims((whole - first).abs() / fastest);
    }

    /// The flight of a body that leaves the table, where N0 and the size of its terms are these.
    pub fn lifts_off(&mut self, [free, size]: [f64; 2]) -> Next {
        if matches!(self.ask.table, Table::Rolling { .. }) && free > ROUNDED * size {
            // Friction lifts the body, and on a real table the contact point would slip first.
            return Next::Ends(Ending::Slip);
        }
        let leaves = if free < -ROUNDED * size { 2 } else { 3 };
        self.hops.takeoff = Takeoff { leaves: Some(leaves), ..Takeoff::default() };
        Next::Own(Kind::Flying)
    }

    /// Claims the energy that an impact has gained by its rounding errors, unless the law of restitution may give some.
    pub fn claims_no_gain(&mut self, lost: f64) {
        if self.ask.impact_law == ImpactLaw::Stronge {
            self.claims(-lost);
        }
    }

    /// The contact that begins where the normal velocity is zero.
    pub fn touches_down(&mut self) -> Next {
        self.hops.takeoff = Takeoff::default();
        self.first_phase().unwrap_or(Next::Ends(Ending::Painleve))
    }
}
