//! Losses of a stone: the end of its rolling, and its drilling, which dry friction resists and may hold.
//!
//! ```text
//! w = w_z n + w_h        w_z the drilling, w_h the rolling and the rocking, along x and y of the laboratory
//! dt = v/(v + delta l) dsigma,   v = |w_h|          with rolling resistance and without slip; l is an inverse inertia
//! w_h = 0    stays if |m_h| <= delta N, with the horizontal couple m_h that keeps it; else the stone rolls along a root
//!            of f, as a contact point at rest begins to slip along a root (`standstill`)
//! w_z = 0    is held while |m_z| <= length N
//! ```
//! The laws are those of bodies of revolution, in the same variables: for these laws a stone is an upright disk.
//! A stone that no longer rolls or rocks has stopped, as a body has, but may go on drilling.
//!
//! Error: a stone that begins to roll gets the speed 2 `REST`.

use super::flow::{Seen, StoneFlow, Touch, slip_of};
use crate::laws::contact::standstill::{HeldContact, Onset, Standstill, towards};
use crate::laws::loss::{Couple, Law, NEAR, Ways, rounded};
use crate::laws::stone::law::{StoneLaw, Touching, across, laboratory};
use crate::methods::flow::{Flow, FlowPlace};
use crate::motions::halt::TIME;
pub(super) use crate::motions::path::lossy::REST;
use crate::motions::path::slide::ways;
use crate::numbers::vector::{dot, plus};
use crate::numbers::{Dual, Real, Sum};

/// In a slip, rolling that is slower than this, and that a step may change by `NEAR`, ends if rolling resistance would also
/// stop it in the opposite direction.
pub(super) const HARDLY_ROLLS: f64 = 4.0 * NEAR;

/// w without the drilling.
#[inline(always)]
fn rolling_of<T: Real>(n: [T; 3], w: [T; 3]) -> [T; 3] {
    plus(w, -dot(n, w), n)
}

impl<T: Real> StoneLaw<T> {
    /// The largest derivative of w that rolling resistance and the weight cause.
    pub(super) fn resisted(&self) -> T {
        let [a, b, c, ..] = self.inertia.0;
        let (least, [x, y, z]) = (a.min(b).min(c), self.squares);
        self.losses.as_ref().map_or(a.splat(0.0), |losses| {
            losses.coefficient(Law::RollingResistance) / (least + x.min(y).min(z))
        })
    }
}

impl StoneFlow<'_> {
    /// True if rolling resistance limits the steps.
    pub(super) fn is_paced(&self) -> bool {
        self.resisted > 0.0 && self.touch != Touch::Slips
    }

    /// dt/dsigma under rolling resistance.
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

    /// The joint speed of rolling and rocking.
    pub(super) fn rolls_at<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let [a, b, c, d, e, f, g] = core::array::from_fn(|i| y[i]);
        let rolling = rolling_of(laboratory([a, b, c, d])[2], [e, f, g]);
        dot(rolling, rolling).sqrt()
    }

    /// The derivative of that speed with respect to time.
    pub(super) fn rolling_growth<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let (Seen { at, to, .. }, w) = (self.seen_at(y), [y[4], y[5], y[6]]);
        let rolling = rolling_of(at.n, w);
        dot(rolling, to.w) / dot(rolling, rolling).sqrt()
    }

    /// The longest step that the square roots in the laws allow.
    #[inline(never)]
    pub(super) fn longest_of_roots<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        let [a, b, c, d, e, f, g] =
            core::array::from_fn(|i| Dual { value: place.y[i], slope: place.rate[i] });
        let seen = |losses| StoneLaw::kinematics(losses, &laboratory([a, b, c, d]), [e, f, g]);
        let losses = self.sloped.losses.as_ref();
        losses.map_or(f64::INFINITY, |losses| losses.longest(&seen(losses), self.is_paced()))
    }

    /// The margins of the drilling, or of the couple that holds it, and of a unique normal force with rolling resistance.
    #[inline(always)]
    pub(super) fn drilling_margin<T: Real>(law: &StoneLaw<T>, seen: &Seen<T>, w: [T; 3]) -> T {
        let one = w[0].splat(1.0);
        let Some(losses) = &law.losses else { return one };
        let most = losses.coefficient(Law::Drilling) * dot(seen.to.force, seen.at.n);
        let [_, drilling] = ways(losses, &StoneLaw::kinematics(losses, &seen.lab, w), [seen.to.couple, most]);
        drilling.min(seen.to.room)
    }

    pub(super) fn holds_drilling(&self) -> bool {
        self.law.losses.as_ref().is_some_and(|losses| losses.holds_drilling())
    }

    fn turn(&mut self, ways: Ways) {
        if let Some(losses) = &mut self.law.losses {
            losses.ways = Some(ways);
            self.sloped.losses = Some(losses.map(|value| Dual { value, slope: 0.0 }));
        }
    }

    /// Lets dry friction hold the drilling, or sets the sign of the drilling that it resists. `toward` is the direction
    /// of a slip from rest; `freed` is true if friction has just let the drilling go. Returns the drilling that is left out.
    pub(super) fn sets_ways<const N: usize>(
        &mut self,
        y: &mut [f64; N],
        toward: [f64; 2],
        freed: bool,
    ) -> f64 {
        if !self.law.losses.as_ref().is_some_and(|losses| losses.has(Law::Drilling)) {
            return 0.0;
        }
        let drilling = self.drilling(y);
        if drilling.abs() > rounded(1.0, [drilling, 0.0, 0.0]) {
            self.turn(Ways { drilling: drilling.signum(), ..Ways::default() });
            return 0.0;
        }
        self.turn(Ways::default().holding_drilling());
        let Seen { at, to, .. } = self.seen_towards(y, toward);
        let most = self.law.losses.map_or(0.0, |losses| losses.coefficient(Law::Drilling));
        let stopped = if freed {
            Ways::default().drilling_from(to.couple)
        } else {
            Ways::default().drilling_stopped([to.couple, most * dot(to.force, at.n)])
        };
        self.turn(stopped);
        if stopped.holds_drilling { self.removes_drilling(y) } else { 0.0 }
    }

    /// Sets the drilling to zero, and returns its size.
    pub(super) fn removes_drilling<const N: usize>(&self, y: &mut [f64; N]) -> f64 {
        let (n, drilling) = (self.seen_at(y).at.n, self.drilling(y));
        (0..3).for_each(|i| y[4 + i] -= drilling * n[i]);
        drilling.abs()
    }

    /// The response at these numbers. If a dry slip is just beginning, friction acts against its direction `way`.
    pub(super) fn seen_towards<const N: usize>(&self, y: &[f64; N], way: [f64; 2]) -> Seen<f64> {
        let mut seen = self.seen_at(y);
        if self.touch == Touch::Slips && self.law.dry && slip_of(y) == [0.0; 2] {
            seen.to = self.law.pulled(&seen.at, [y[4], y[5], y[6]], across(&seen.lab, way));
        }
        seen
    }

    /// The numbers at the end of rolling and rocking, by linear extrapolation; None if they do not end here.
    #[inline(never)]
    pub(super) fn rolls_no_more<const N: usize>(&self, place: &FlowPlace<N>) -> Option<[f64; N]> {
        let (y, speed) = (&place.y, self.rolls_at(&place.y));
        let slow = if self.is_paced() { REST } else { HARDLY_ROLLS };
        if self.resisted == 0.0 || speed > slow || speed == 0.0 {
            return None;
        }
        let growth = self.rolling_growth(y);
        let back = || {
            let (mut back, n) = (*y, self.seen_at(y).at.n);
            let rolling = rolling_of(n, [y[4], y[5], y[6]]);
            (0..3).for_each(|i| back[4 + i] -= 2.0 * rolling[i]);
            self.rolling_growth(&back)
        };
        if growth >= 0.0 || !self.is_paced() && back() >= 0.0 {
            return None;
        }
        let left = -speed / (growth * place.rate[TIME]);
        let rests = core::array::from_fn(|i| y[i] + left * place.rate[i]);
        Some(self.rolling_along(&self.kept(rests), [0.0; 2]))
    }

    /// Returns these numbers with another w_h, along x and y of the laboratory.
    pub(super) fn rolling_along<const N: usize>(&self, y: &[f64; N], by: [f64; 2]) -> [f64; N] {
        let (Seen { lab, .. }, mut to) = (self.seen_at(y), *y);
        let w = plus(across(&lab, by), self.drilling(y), lab[2]);
        to[4..7].copy_from_slice(&w);
        to
    }

    /// The next motion of a stone that only drills: rolling resistance holds it, or the stone begins to roll, with w_h at
    /// the angle alpha from axis x of the laboratory.
    #[inline(never)]
    pub(super) fn leaves<const N: usize>(&self, y: &[f64; N]) -> Standstill {
        let (mut law, mut delta, y) = (self.law, 0.0, self.rolling_along(y, [0.0; 2]));
        if let Some(losses) = &mut law.losses {
            delta = losses.coefficient(Law::RollingResistance);
            losses.sets(Law::RollingResistance, 0.0);
        }
        let (Seen { lab, at, .. }, w) = (Self { law, ..*self }.seen_at(&y), [y[4], y[5], y[6]]);
        // The normal force and the rate of w_h with additional couples, one of which is proportional to that force.
        let acts = |free: [f64; 3], pressed: [f64; 3]| {
            let more = |lost: Couple<f64>| Couple {
                free: plus(lost.free, 1.0, free),
                pressed: plus(lost.pressed, 1.0, pressed),
            };
            let at = Touching { lost: at.lost.map(more), ..at };
            let held = at.holds || self.touch == Touch::Held;
            let to = if self.rests() { law.resting(&at, w, held) } else { law.pulled(&at, w, [0.0; 3]) };
            (dot(to.force, at.n), [dot(lab[0], to.w), dot(lab[1], to.w)])
        };
        let (free, bare) = acts([0.0; 3], [0.0; 3]);
        let [(m, [a, c]), (k, [d, b])] = [0, 1].map(|i| {
            let (normal, rate) = acts(lab[i], [0.0; 3]);
            (normal - free, [rate[0] - bare[0], rate[1] - bare[1]])
        });
        let per = -1.0 / (a * b - c * d);
        let keeps = [per * (b * bare[0] - d * bare[1]), per * (a * bare[1] - c * bare[0])];
        let onset = Onset {
            mu: delta,
            free,
            eps: [-delta * m, -delta * k],
            bare,
            pressed: [Sum::from(0.0); 2],
            pulled: [a, b, 0.5 * (c + d)],
        };
        let held = [free + m * keeps[0] + k * keeps[1], keeps[0].hypot(keeps[1])];
        let growth = |alpha: f64| {
            let way = towards(alpha);
            let (normal, rate) = acts([0.0; 3], across(&lab, way).map(|x| -delta * x));
            (normal > 0.0).then_some(way[0] * rate[0] + way[1] * rate[1])
        };
        HeldContact { mu: [delta; 2], free, held, against: 0.0, doubtful: false, onset, growth }.decides()
    }
}
