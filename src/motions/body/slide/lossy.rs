//! Losses during a slip: the signs of the rotations that dry losses resist, the settling of the contact of a falling
//! face, and the end of rolling.

use super::{Own, Slide};
use crate::laws::body::Shape;
use crate::laws::contact::lossy::DAMPED;
use crate::laws::contact::patch::rubs;
use crate::laws::contact::slip::{FollowsSpeed, SlipResponse, Slipping};
use crate::laws::contact::together::{Resting, Rubs, Together};
use crate::laws::loss::{Couples, Holds, Law, Losses, OwnCouple, Ways, reversed_turns, rolling_growth};
use crate::laws::state::{State, drilling_of, rolling_of, spin_of};
use crate::methods::flow::FlowPlace;
use crate::motions::body::face::FLAT;
use crate::motions::body::roll::lossy::at_rest;
use crate::motions::dry::held::{HARDLY_ROLLS, hold, left_to_rest};
use crate::motions::dry::settled::{Balance, CLOSE, SLOWER, Turned, balance, lag, settles_within};
use crate::motions::walk::numbers::{BodyNumbers, COS, HEAT, Halt, P, SIN, TIME, W1, W2, W3};
use crate::numbers::{Dual, Real, sign_or_zero};

/// The share by which a couple may exceed the limit of dry friction that holds a contact point after it had settled.
const HELD_SURELY: f64 = 1e-6;

impl<L: Own> Slide<L> {
    /// Sets the signs of the rotations that dry losses resist, and which of them friction holds at rest, in a state
    /// whose contact has not settled. `toward` is the direction of a slip from rest. `known` is a rotation that
    /// friction has just ceased to hold (true), or that it holds in any case (false).
    pub fn sets_ways(&mut self, y: &State, slip: [f64; 2], toward: [f64; 2], known: Option<(Resting, bool)>) {
        (self.settled, self.rolls_off) = (false, false);
        // A settled contact stops at the very limit of friction, and the push on it falls from there on.
        self.sure = if known == Some((Resting::Contour, false)) { HELD_SURELY } else { 0.0 };
        let Some(losses) = self.law.losses else { return };
        let (angle, w) = (y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
        let (pull, twist) = self.pulls(angle, w, slip, toward);
        let seen = losses.seen(&self.law.shape.rim, angle, w[0] / angle.0, w);
        let way = (self.law.dry && slip == [0.0; 2]).then_some(toward);
        let losses = losses.linear(&seen, |_| self.slips(angle, w, slip, way).0.force[0]);
        let rests =
            Together::of_body(&self.law.shape, &losses, (angle, w), slip, Rubs::Slips { pull, twist });
        let mut ways = Ways::of(spin_of(angle, w[0], w[2]), self.drills(angle, w[0], w[2]));
        if w[0] == 0.0 && w[2] == 0.0 && pull[1] == 0.0 && twist == 0.0 && self.turning == 0.0 {
            // The body only rocks, since no couple turns it.
            ways = Ways { rocking: sign_or_zero(w[1]), ..Ways::default() };
        }
        if let Some(rests) = rests {
            let (decided, way) = ways.deciding(rests, known);
            ways = decided;
            if rests.has(Resting::Rolling) {
                [ways.rolling, ways.rocking] = way;
                self.rolls_off = ways.rolling != 0.0 || w[0] != 0.0 || w[2] != 0.0 || pull[1] != 0.0;
                self.rolls_off &= way != [0.0; 2];
            }
        }
        self.turn(ways);
    }

    /// The couple that holds the contact point along the rim, and its limit, which is raised by the allowance for a
    /// contact that had settled.
    pub(super) fn surely<T: Real>(&self, [push, limit]: [T; 2]) -> [T; 2] {
        [push, limit * limit.splat(1.0 + self.sure)]
    }

    /// The friction of a slip, or of one that begins in the direction `toward`: the force -N pull and the couple N twist.
    fn pulls(&self, (s, c): (f64, f64), w: [f64; 3], slip: [f64; 2], toward: [f64; 2]) -> ([f64; 2], f64) {
        let mu = self.law.strength_at(slip);
        if !self.law.dry {
            return (slip.map(|u| mu * u), 0.0);
        }
        let (drilling, size) = (self.drills((s, c), w[0], w[2]), slip[0].hypot(slip[1]));
        match self.law.patch() {
            Some(patch) if size > 0.0 || drilling != 0.0 => {
                let [share, twist, _] = rubs(size, drilling, patch);
                (slip.map(|u| mu * share * u), mu * twist)
            }
            _ if size > 0.0 => (slip.map(|u| mu * u / size), 0.0),
            _ => (toward.map(|e| mu * e), 0.0),
        }
    }

    pub fn holds(&self) -> Holds {
        self.law.losses.map_or(Holds::default(), |losses| losses.holds())
    }

    /// Frees the direction of rolling after it has begun from rest.
    pub fn rolls_freely(&mut self) {
        if let Some(ways) = self.law.losses.and_then(|losses| losses.ways).filter(|_| self.rolls_off) {
            self.rolls_off = false;
            self.turn(ways.rolling_freely());
        }
    }

    /// The direction of (w_h, w2) in which rolling begins from rest; None if it does not begin.
    pub fn begins_to_roll(&self) -> Option<[f64; 2]> {
        let ways = self.law.losses.and_then(|losses| losses.ways).filter(|_| self.rolls_off)?;
        Some([ways.rolling, ways.rocking])
    }

    fn turn(&mut self, ways: Ways) {
        if let (Some(losses), Some(sloped)) = (&mut self.law.losses, &mut self.sloped.losses) {
            losses.ways = Some(ways);
            *sloped = losses.map(Dual::constant);
            self.bare.losses = Some(losses.off_the_contour());
        }
    }

    /// Reverses the sign of the rocking where a ball has passed the vertical and leans to the other side, so that the
    /// direction of rocking in space stays the same.
    pub fn leans_over(&mut self) {
        if let Some(ways) = self.law.losses.and_then(|losses| losses.ways) {
            self.turn(Ways { rocking: -ways.rocking, ..ways });
        }
    }

    /// The rotation that friction ceases to hold at this halt (true); None if the halt stops a rotation. A settled
    /// contact stops where dry friction balances the couple on it, so that friction holds it in any case (false).
    pub fn known(&self, halt: Halt) -> Option<(Resting, bool)> {
        if halt == Halt::Contour && self.settled {
            return Some((Resting::Contour, false));
        }
        self.holds().ceasing(halt).map(|part| (part, true))
    }

    /// Whether a couple that grows with psi' has almost stopped the contact along the rim, while
    /// the face falls.
    pub(crate) fn settles<const N: usize>(&self, place: &FlowPlace<N>) -> bool {
        let ([s, c, w1, w2, w3], shape) = (core::array::from_fn(|i| place.y[i]), &self.law.shape);
        // `fall` is the speed at which either face falls.
        let fall = c * w2;
        let Some(losses) =
            self.law.losses.filter(|_| s <= CLOSE && !self.ball && !self.settled && fall > 0.0)
        else {
            return false;
        };
        let spin = spin_of((s, c), w1, w3);
        if s * spin.abs() > SLOWER * fall {
            return false;
        }
        let slope = losses.slope(s, shape.rim.radius((s, c)), spin);
        let rate = slope * self.lightness((s, c));
        let Some(within) = settles_within(&losses.beside(()), (s, fall), rate, s * spin / self.tol) else {
            return false;
        };
        let (fastest, q) = (Self::fastest(&place.y), drilling_of((s, c), w1, w3));
        // Where dry friction exceeds the push, the contact point stops at a finite time and does not settle.
        if self.pushed_on(&self.bare, (s, c), [s * q, w2, c * q], place.y.slip())[0] <= 0.0 {
            return false;
        }
        let balanced = self.balance((s, c), q, w2, place.y.slip()).spin;
        s * (spin - balanced).abs() <= within * self.tol * fastest + 1e-8 * s * balanced.abs()
    }

    /// The longest time step with which the integration damps a psi' that stops fast near the table, as in
    /// [`Lossy::damped`].
    ///
    /// [`Lossy::damped`]: crate::laws::contact::lossy::Lossy::damped
    pub(crate) fn damped<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let ([s, c, w1, _, w3], rim) = (core::array::from_fn(|i| y[i]), &self.law.shape.rim);
        let Some(losses) = self
            .law
            .losses
            .filter(|losses| losses.is_soft() && !losses.holds().contour && !losses.holds().rolling)
        else {
            return f64::INFINITY;
        };
        let slope = losses.slope(s.abs(), rim.radius((s, c)), spin_of((s, c), w1, w3));
        DAMPED / (slope * self.lightness((s, c)))
    }

    /// The psi' at which the couples on a settled contact balance, from w_z, w2 and the slip.
    fn balance(
        &self,
        angle: (f64, f64),
        drilling: f64,
        w2: f64,
        u: [f64; 2],
    ) -> Balance<(SlipResponse<f64>, f64)> {
        let losses = self.law.losses.map_or(Couples::of(&Losses::NONE, |x| x), |losses| losses.beside(()));
        let way = losses.ways.map_or(0.0, |ways| ways.contour);
        let act = |_: f64, w: [f64; 3], rate: f64| {
            let (at, pace, push) = self.bare.settled(angle, w, u, rate);
            Turned { acted: (at, pace), push, normal: at.force[0] }
        };
        balance(&losses, (angle, self.law.shape.rim.radius(angle)), (drilling, w2), way, act)
    }

    /// The excess of the couple on a settled contact over the limit of dry friction, and how far the couple on a held
    /// drilling is from its limit. `w` is that of a contact point at rest, and `bare` is the law without the couples
    /// along the contour.
    pub(crate) fn pushed_on<T: Real>(
        &self,
        bare: &Slipping<T, impl OwnCouple<T>, impl FollowsSpeed<T>>,
        angle: (T, T),
        w: [T; 3],
        u: [T; 2],
    ) -> [T; 2] {
        let one = w[0].splat(1.0);
        let Some(losses) = self.law.losses else { return [one; 2] };
        let (resists, holds) = (losses.has(Law::DryContour), losses.holds().drilling);
        if !resists && !holds {
            return [one; 2];
        }
        let (at, _, push) = bare.settled(angle, w, u, one.splat(0.0));
        let kept = if holds { hold(at.held) } else { one };
        if !resists {
            return [one, kept];
        }
        let dry = one.splat(losses.coefficient(Law::DryContour)) * at.force[0] * bare.shape.rim.radius(angle);
        let way = losses.ways.map_or(0.0, |ways| ways.contour);
        [one.splat(way) * push - dry, kept]
    }

    /// The state vector in the variables of a slip, from the state vector `shown` in the variables that all phases
    /// share: w_z replaces w1 for a settled contact.
    pub fn enter<const N: usize>(&self, shown: &[f64; N]) -> [f64; N] {
        let mut y = *shown;
        if self.settled {
            (y[P], y[W3]) = (drilling_of(y.angle(), y[P], y[W3]), 0.0);
        }
        y
    }

    /// The state vector in the variables that all phases share, from that in the variables of a slip.
    pub(crate) fn common_numbers<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        let mut shown = *y;
        if self.settled {
            let [_, w2, _] = [y[P], y[W2], y[W3]];
            let Balance { spin, .. } = self.balance(y.angle(), y[P], w2, y.slip());
            (shown[W1], shown[W3]) =
                (y[SIN] * (y[P] - y[COS] * spin), y[COS] * y[P] + y[SIN] * y[SIN] * spin);
        }
        shown
    }

    /// Writes the derivative of the state vector for a settled contact. Returns the precession, psi', and the power
    /// of the losses.
    pub(crate) fn settled_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) -> ([f64; 2], f64) {
        let ([s, c, q, w2], u) = (core::array::from_fn(|i| y[i]), y.slip());
        let Balance { precession, w: [w1, _, w3], turned, spin } = self.balance((s, c), q, w2, u);
        let Turned { acted: (at, pace), push, normal } = turned;
        let ([d1, d2, d3], [_, along, across]) = (at.w, at.force);
        let turn = drilling_of((s, c), d1, d3) - w2 * rolling_of((s, c), w1, w3);
        let rates = [-(c * w2), s * w2, turn, d2, 0.0, at.u[0], at.u[1], 1.0];
        for (to, rate) in all.iter_mut().zip(rates) {
            *to = pace * rate;
        }
        all[HEAT] = -(pace * (along * u[1] + across * u[0]));
        let power = self.bare.power((s, c), [w1, w2, w3], normal) + push * spin;
        ([precession, spin], power)
    }

    /// The rate of change of psi' under a unit couple along the contour.
    fn lightness(&self, (s, c): (f64, f64)) -> f64 {
        let Shape { i1, i3, .. } = self.law.shape;
        1.0 / i3 + c / s * (c / s) / i1
    }

    /// Upper bound of the delay with which a settled contact stops after dry friction has balanced the couple on it.
    pub fn settled_lag(&self, y: &State, slip: [f64; 2]) -> f64 {
        let ((s, c), shape) = (y.theta.sin_cos(), &self.law.shape);
        let turned = self.balance((s, c), drilling_of((s, c), y.w1, y.w3), y.w2, slip).turned;
        let (lightness, radius) = (self.lightness((s, c)), shape.rim.radius((s, c)));
        self.law
            .losses
            .map_or(0.0, |losses| lag(&losses.beside(()), (s, c * y.w2), radius, turned.push, lightness))
    }

    /// Error of w1 and w3 while psi' follows the balance of couples: sin(theta) abs(psi'), times its ratio to the
    /// speed of fall if that ratio is below 1.
    pub fn settled_doubt(y: &State) -> f64 {
        let fall = y.theta.cos() * y.w2;
        let slower = y.theta.sin() * y.spin() / fall;
        y.theta.sin() * y.spin().abs() * slower.abs().min(1.0)
    }

    /// The speed of rolling and rocking together, sqrt(w_h^2 + w2^2), and its time derivative, for this w at a place.
    pub(crate) fn rolling_growth<const N: usize>(&self, place: &FlowPlace<N>, w: [f64; 3]) -> [f64; 2] {
        let [s, c, _, _, _, u_h, u_2] = core::array::from_fn(|i| place.y[i]);
        rolling_growth((s, c), w, self.acts((s, c), w, [u_h, u_2]).w)
    }

    /// The end, by linear extrapolation, of rolling and rocking that rolling resistance has almost stopped,
    /// and would also stop in the opposite direction.
    pub(crate) fn comes_to_rest<const N: usize>(&self, place: &FlowPlace<N>) -> Option<[f64; N]> {
        let there = |losses: &Couples<f64, L>| {
            let planar = losses.ways.is_some_and(|ways| ways.rocking != 0.0);
            losses.has(Law::RollingResistance) && !planar && !losses.holds().rolling
        };
        if !self.law.losses.as_ref().is_some_and(there) || place.y[SIN].abs() < FLAT {
            return None;
        }
        let [s, c, w1, w2, w3] = core::array::from_fn(|i| place.y[i]);
        let w = [w1, w2, w3];
        let left = left_to_rest(self.rolling_growth(place, w), HARDLY_ROLLS, place.rate[TIME])?;
        if self.rolling_growth(place, reversed_turns((s, c), w))[1] >= 0.0 {
            return None;
        }
        Some(at_rest(place, left, |[s, c, w1, _, w3]| drilling_of((s, c), w1, w3)))
    }
}
