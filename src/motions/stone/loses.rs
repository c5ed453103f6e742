//! Losses of a stone: the end of its rolling, and its drilling, which dry friction resists and may hold.
//!
//! ```text
//! w = w_z n + w_h        w_z the drilling, w_h the rolling and the rocking, along x and y of the laboratory
//! dt = v/(v + delta l) dsigma,   v = |w_h|          with rolling resistance and without slip; l is an inverse inertia
//! w_h = 0    is held while |m_h| <= delta N, with the horizontal couple m_h that keeps it
//! w_z = 0    is held while |m_z| <= length N
//! ```
//! The laws are those of bodies of revolution, in the same variables: for these laws a stone is an upright disk.
//! [`together`](crate::laws::contact::together) finds which of the motions at rest are held, and how the others begin. A
//! stone that no longer rolls or rocks goes on turning about the vertical until its drilling stops.
//!
//! Error: a stone that begins to roll gets the speed 2 `REST`.

use super::flow::{HOLD, Seen, StoneFlow, StoneNumbers, Touch, slip_of};
use crate::laws::contact::patch::rubs;
use crate::laws::contact::together::{Resting, Together};
use crate::laws::loss::{Couple, Holds, Law, Ways, rounded};
use crate::laws::stone::law::{StoneLaw, Touching, across, laboratory};
use crate::methods::flow::{Flow, FlowPlace};
pub(super) use crate::motions::body::roll::lossy::REST;
use crate::motions::dry::creep::Creeps;
use crate::motions::dry::held::{HARDLY_ROLLS, left_to_rest, margins_of_ways};
use crate::motions::walk::numbers::TIME;
use crate::numbers::vector::{dot, plus};
use crate::numbers::{Dual, Real};

/// Returns w without its component along the vertical `n` (the drilling).
#[inline(always)]
fn rolling_of<T: Real>(n: [T; 3], w: [T; 3]) -> [T; 3] {
    plus(w, -dot(n, w), n)
}

impl<T: Real> StoneLaw<T> {
    /// The largest angular acceleration that rolling resistance and the weight cause.
    pub(super) fn resisted(&self) -> T {
        let [a, b, c, ..] = self.inertia.0;
        let (least, [x, y, z]) = (a.min(b).min(c), self.squares);
        self.losses.as_ref().map_or(a.splat(0.0), |losses| {
            losses.coefficient(Law::RollingResistance) / (least + x.min(y).min(z))
        })
    }
}

impl StoneFlow<'_> {
    /// Whether rolling resistance limits the steps.
    pub(super) fn is_paced(&self) -> bool {
        self.resisted > 0.0 && self.touch != Touch::Slips && !self.holds().rolling
    }

    /// The time step per step of the variable of integration, dt/dsigma, under rolling resistance.
    #[inline(always)]
    pub(super) fn pace<T: Real>(&self, at: &Touching<T>, w: [T; 3]) -> T {
        let one = w[0].splat(1.0);
        if !self.is_paced() {
            return one;
        }
        let rolling = rolling_of(at.n, w);
        let speed = dot(rolling, rolling).sqrt();
        speed / (speed + one.splat(self.resisted))
    }

    /// The speed of rolling and rocking together: the size of the horizontal part of w.
    pub(super) fn rolls_at<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let [a, b, c, d, e, f, g] = core::array::from_fn(|i| y[i]);
        let rolling = rolling_of(laboratory([a, b, c, d])[2], [e, f, g]);
        dot(rolling, rolling).sqrt()
    }

    /// The time derivative of the speed of rolling and rocking together.
    pub(super) fn rolling_growth<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let (Seen { at, to, .. }, w) = (self.seen_at(y), y.omega());
        let rolling = rolling_of(at.n, w);
        dot(rolling, to.w) / dot(rolling, rolling).sqrt()
    }

    /// The longest step that the loss laws allow, since their square roots are not smooth where they vanish.
    #[inline(never)]
    pub(super) fn longest_of_roots<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        let [a, b, c, d, e, f, g] =
            core::array::from_fn(|i| Dual { value: place.y[i], slope: place.rate[i] });
        let seen = |losses| StoneLaw::kinematics(losses, &laboratory([a, b, c, d]), [e, f, g]);
        let losses = self.sloped.losses.as_ref();
        losses.map_or(f64::INFINITY, |losses| losses.longest(&seen(losses), self.is_paced()))
    }

    /// The least of the margins by losses: of the drilling rate, or of the couple that holds the drilling; of the
    /// couple that holds rolling and rocking; and of a unique normal force with rolling resistance.
    #[inline(always)]
    pub(super) fn drilling_margin<T: Real>(law: &StoneLaw<T>, seen: &Seen<T>, w: [T; 3]) -> T {
        let [drilling, rolling] = Self::held_margins(law, seen, w);
        drilling.min(rolling).min(seen.to.room)
    }

    #[inline(always)]
    fn held_margins<T: Real>(law: &StoneLaw<T>, seen: &Seen<T>, w: [T; 3]) -> [T; 2] {
        let one = w[0].splat(1.0);
        let Some(losses) = &law.losses else { return [one; 2] };
        let normal = dot(seen.to.force, seen.at.n);
        let most = |law: Law| losses.coefficient(law) * normal;
        let kept = [seen.to.kept, most(Law::RollingResistance)];
        let kinematics = StoneLaw::kinematics(losses, &seen.lab, w);
        let [rolling, drilling] = margins_of_ways(
            losses,
            &kinematics,
            kinematics.w[0],
            [[seen.to.couple, most(Law::Drilling)], kept],
        );
        [drilling, rolling]
    }

    pub(super) fn holds(&self) -> Holds {
        self.law.losses.as_ref().map_or(Holds::default(), |losses| losses.holds())
    }

    /// Whether a stone that is at rest, and whose rolling and rocking are held, does not begin to move: on a slope the
    /// contact point may slip off, or the stone may turn about the vertical through it.
    pub(super) fn stays_at_rest<const N: usize>(&self, y: &[f64; N]) -> bool {
        if self.law.tilt.is_none() {
            return true;
        }
        let turns = dot(self.seen_at(y).to.w, self.seen_at(y).at.n);
        self.rests() && self.margins_at(y)[HOLD] >= 0.0 && turns.abs() <= REST
    }

    fn turn(&mut self, ways: Ways) {
        if let Some(losses) = &mut self.law.losses {
            losses.ways = Some(ways);
            self.sloped.losses = Some(losses.map(Dual::constant));
        }
    }

    /// The rotation that friction ceases to hold where the margin of the losses is zero; None if the drilling stops
    /// there.
    pub(super) fn known<const N: usize>(&self, y: &[f64; N]) -> Option<(Resting, bool)> {
        let Holds { drilling, rolling, .. } = self.holds();
        let margins = Self::held_margins(&self.law, &self.seen_at(y), y.omega());
        if rolling && margins[1] <= margins[0] {
            Some((Resting::Rolling, true))
        } else {
            drilling.then_some((Resting::Drilling, true))
        }
    }

    /// The rotations of a stone that are at rest and that dry losses resist; None without any, or if no normal force
    /// acts. `slips` is the slip, or the direction of one that begins; None if the contact point is at rest.
    #[inline(never)]
    pub(super) fn together<const N: usize>(&self, y: &[f64; N], slips: Option<[f64; 2]>) -> Option<Together> {
        let losses = self.law.losses?;
        let drilling = self.drilling(y);
        let rests = |law: Law, there: bool| (losses.has(law) && there).then(|| losses.coefficient(law));
        let turns = rounded(1.0, [drilling, 0.0, 0.0]);
        let held = self.touch == Touch::Held;
        let limits = [
            slips.is_none().then_some(f64::INFINITY),
            rests(Law::RollingResistance, self.rolls_at(y) < REST),
            None,
            rests(Law::Drilling, drilling.abs() <= turns).or(held.then_some(f64::INFINITY)),
        ];
        if limits[1].is_none() && (limits[3].is_none() || held) {
            return None;
        }
        let mut law = self.law;
        law.strength = 1.0;
        let y = if limits[1].is_some() { self.rolling_along(y, [0.0; 2]) } else { *y };
        let drills = if limits[3].is_some() { 0.0 } else { drilling.signum() };
        if let Some(losses) = &mut law.losses {
            losses.ways = Some(Ways { drilling: drills, ..Ways::default() });
            if limits[1].is_some() {
                losses.sets(Law::RollingResistance, 0.0);
            }
        }
        let (lab, w) = (laboratory(core::array::from_fn(|i| y[i])), y.omega());
        let at = law.losing(law.meeting(&lab, w), &lab, w);
        let (mu, u) = (self.law.strength, slips.unwrap_or([0.0; 2]));
        let size = u[0].hypot(u[1]);
        let (pull, twist) = match self.law.patch() {
            _ if !self.law.dry || size == 0.0 && drilling == 0.0 => (u.map(|u| mu * u), 0.0),
            Some(patch) if self.rubs(&y) > self.over() => {
                let u = slip_of(&y);
                let [share, twist, _] = rubs(u[0].hypot(u[1]), drilling, patch);
                (u.map(|u| mu * share * u), mu * twist)
            }
            _ => (u.map(|u| mu * u / size.max(f64::MIN_POSITIVE)), 0.0),
        };
        Together::of(limits, |r| {
            let couple = plus(across(&lab, [r[2], r[3]]), r[5] + twist, at.n);
            let more = |lost: Couple<f64>| Couple { pressed: plus(lost.pressed, 1.0, couple), ..lost };
            let at = Touching { lost: at.lost.map(more), ..at };
            let to = law.pulled(&at, w, across(&lab, [pull[0] - r[0], pull[1] - r[1]]));
            let (slip, turn) = (law.slip_rate(&at, w, &to), lab.map(|axis| dot(axis, to.w)));
            (dot(to.force, at.n), [dot(lab[0], slip), dot(lab[1], slip), turn[0], turn[1], 0.0, turn[2]])
        })
    }

    /// Sets which rotations dry friction holds at rest, and the signs of the others. `toward` is the direction of a
    /// slip from rest, and `known` a rotation that friction has just ceased to hold. Returns the small drilling rate
    /// that is set to zero.
    pub(super) fn sets_ways<const N: usize>(
        &mut self,
        y: &mut [f64; N],
        toward: [f64; 2],
        known: Option<(Resting, bool)>,
    ) -> f64 {
        self.push = [0.0; 2];
        if self.law.losses.is_none() {
            return 0.0;
        }
        let drilling = self.drilling(y);
        let ways = Ways::of(0.0, drilling);
        self.turn(ways);
        let slip = slip_of(y);
        let slips = (!self.rests()).then_some(match self.touch {
            Touch::Slips if slip == [0.0; 2] && self.law.dry => toward,
            Touch::Slips => slip,
            _ => [0.0; 2],
        });
        let Some(rests) = self.together(y, slips) else { return 0.0 };
        let (mut decided, push) = ways.deciding(rests, known);
        if self.touch == Touch::Held {
            // Friction of the patch, and no loss, holds the drilling.
            (decided.drilling, decided.holds.drilling) = (ways.drilling, false);
        }
        if rests.has(Resting::Rolling) {
            self.push = push;
            // In the variables of the laws, e2 and e3 are the axes x and y of the laboratory.
            if self.touch == Touch::Slips {
                [decided.rocking, decided.rolling] = [push[0], -push[1]];
            }
            *y = self.rolling_along(y, push.map(|x| 2.0 * REST * x));
        }
        self.turn(decided);
        if decided.holds.drilling { self.removes_drilling(y) } else { 0.0 }
    }

    /// Frees the direction of rolling after it has begun from rest in a slip.
    pub(super) fn rolls_freely(&mut self) {
        self.push = [0.0; 2];
        if let Some(ways) = self.law.losses.as_ref().and_then(|losses| losses.ways) {
            self.turn(ways.rolling_freely());
        }
    }

    /// Sets the drilling to zero, and returns its size.
    pub(super) fn removes_drilling<const N: usize>(&self, y: &mut [f64; N]) -> f64 {
        let (n, drilling) = (self.seen_at(y).at.n, self.drilling(y));
        (0..3).for_each(|i| y[4 + i] -= drilling * n[i]);
        drilling.abs()
    }

    /// Contact force and accelerations at the state vector `y`. If a slip just begins, dry friction acts against its
    /// direction `way`.
    pub(super) fn seen_towards<const N: usize>(&self, y: &[f64; N], way: [f64; 2]) -> Seen<f64> {
        let mut seen = self.seen_at(y);
        if self.touch == Touch::Slips && self.law.dry && slip_of(y) == [0.0; 2] {
            seen.to = self.law.pulled(&seen.at, y.omega(), across(&seen.lab, way));
        }
        seen
    }

    /// The state vector at the end of rolling and rocking, by linear extrapolation; None if they do not end here.
    #[inline(never)]
    pub(super) fn rolls_no_more<const N: usize>(&self, place: &FlowPlace<N>) -> Option<[f64; N]> {
        let (y, speed) = (&place.y, self.rolls_at(&place.y));
        let slow = if self.is_paced() { REST } else { HARDLY_ROLLS };
        if self.resisted == 0.0 || self.holds().rolling || speed > slow {
            return None;
        }
        let left = left_to_rest([speed, self.rolling_growth(y)], slow, place.rate[TIME])?;
        let back = || {
            let (mut back, n) = (*y, self.seen_at(y).at.n);
            let rolling = rolling_of(n, y.omega());
            (0..3).for_each(|i| back[4 + i] -= 2.0 * rolling[i]);
            self.rolling_growth(&back)
        };
        if !self.is_paced() && back() >= 0.0 {
            return None;
        }
        let rests = core::array::from_fn(|i| y[i] + left * place.rate[i]);
        Some(self.rolling_along(&self.kept(rests), [0.0; 2]))
    }

    /// Returns the state vector with the horizontal part `by` of w, along x and y of the laboratory.
    pub(super) fn rolling_along<const N: usize>(&self, y: &[f64; N], by: [f64; 2]) -> [f64; N] {
        let (Seen { lab, .. }, mut to) = (self.seen_at(y), *y);
        let w = plus(across(&lab, by), self.drilling(y), lab[2]);
        to[4..7].copy_from_slice(&w);
        to
    }
}
