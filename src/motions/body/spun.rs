//! A uniform ball (l = 0, I1 = I3 = I), all of whose phases have closed forms or series: none is integrated.
//!
//! ```text
//! rolls, flies    w stays in space, and the axis n turns about it
//! slips           u = u0 (1 - t/T),   T = |u0|/(mu (1 + 1/I)),   w = w0 + a t,   a = mu z x u0/(I |u0|)
//! creeps          w = w0 + a t,   u = u0 w_z/w_z0                on a patch (`creep`), until w_h = 0, or w_z = 0
//! resisted        w = w0 + a t,   a = -f w_h/(|w_h| (1 + I)) - d sgn(w_z) z/I             until w_h = 0, or w_z = 0
//! n' = w x n      n = sum n_k t^k,   (k + 1) n_{k+1} = w0 x n_k + a x n_{k-1}        in parts of a radian
//! ```
//! The normal force on the table is the weight, rolling needs no friction, and a slip keeps its direction (Coriolis,
//! Theorie mathematique des effets du jeu de billard (1835)). In these formulas w_h is the whole horizontal part of
//! w. All vectors are along the e_h, e2 and z of the phase's beginning, where n = (-s, 0, c). If poses are requested,
//! the motion of a uniform ball is integrated like that of any other body.
//!
//! Error: a few roundings in each phase, which enter every later angle, speed and time; for w1, w2 and the slip
//! divided by sin(theta).

use super::fly::Aloft;
use crate::laws::body::Body;
use crate::laws::contact::Table;
use crate::laws::contact::slip::Friction;
use crate::laws::state::{drilling_of, rolling_of};
use crate::motions::Ask;

/// Error of the state by one phase of a uniform ball, in units of rounding.
pub(super) const ROUNDINGS_PER_PHASE: f64 = 8.0;
/// The power series of the axis is cut off after two successive terms whose sum is smaller than this. A part of time
/// h has w h and a h^2 of at most 1, so that there are thirty terms at most.
const NEGLIGIBLE_TERM: f64 = 1e-18;

/// The largest number of parts of the power series of a slip, or `PARTS_PER_TIME` per unit of time if these are more;
/// as many steps of an integrator would need all its evaluations.
const MOST_PARTS: f64 = 4e5;
const PARTS_PER_TIME: f64 = 2e3;

/// Whether every phase of this motion has a closed form or series: a uniform ball on a level table, without poses,
/// without losses, without viscous friction, and without a patch of contact.
pub(crate) fn knows(body: &Body, ask: &Ask) -> bool {
    let dry = match ask.table {
        Table::Rolling { .. } | Table::Smooth => true,
        Table::Rubs(Friction::Coulomb { patch, .. }) => patch == 0.0,
        Table::Rubs(Friction::Viscous { .. }) => false,
    };
    body.is_uniform_ball() && ask.is_level() && dry && !ask.pose && ask.losses.is_none()
}

/// The errors of a motion of a uniform ball in closed form: roundings of the speeds so far (`count`), the error of
/// the axis (`turned`), and that of the time (`late`).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Roundings {
    pub count: f64,
    pub turned: f64,
    pub late: f64,
    /// The sum of the integration step errors that `count` includes.
    pub inherited: f64,
}

fn cross([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

fn size([a, b, c]: [f64; 3]) -> f64 {
    (a * a + b * b + c * c).sqrt()
}

/// A phase of a uniform ball in closed form, from its start.
pub(super) struct Spun {
    from: Aloft,
    /// The direction of the ball's axis at the time `since` of the phase.
    axis: [f64; 3],
    since: f64,
    w: [f64; 3],
    /// The constant angular acceleration of the ball; `slows` is the share of its initial slip that the ball loses in
    /// a unit of time.
    push: [f64; 3],
    pub slows: f64,
    pub fastest: f64,
}

impl Spun {
    pub fn new(from: &Aloft, push: [f64; 3], slows: f64) -> Self {
        let ((s, c), [w1, w2, w3]) = (from.angle, from.w);
        let w = [rolling_of((s, c), w1, w3), w2, drilling_of((s, c), w1, w3)];
        let fastest = w.into_iter().chain(from.slip).fold(1.0, |most: f64, x| most.max(x.abs()));
        Self { from: *from, axis: [-s, 0.0, c], since: 0.0, w, push, slows, fastest }
    }

    /// A slip under friction with the coefficient `mu`; without friction it does not slow down.
    pub fn rubbing(from: &Aloft, inertia: f64, mu: f64) -> Self {
        let speed = from.slip[0].hypot(from.slip[1]);
        if mu == 0.0 || speed == 0.0 {
            return Self::new(from, [0.0; 3], 0.0);
        }
        let [along, across] = from.slip.map(|u| mu * u / (inertia * speed));
        Self::new(from, [-across, along, 0.0], mu * (1.0 + 1.0 / inertia) / speed)
    }

    /// A ball whose rolling and drilling slow down at these rates. If it creeps, its slip vanishes together with its
    /// drilling.
    pub fn slowing(from: &Aloft, [rolls, drills]: [f64; 2]) -> Self {
        let free = Self::new(from, [0.0; 3], 0.0);
        let ([x, y, z], speed) = (free.w, free.rolling());
        let [x, y] = if speed > 0.0 { [x, y].map(|w| -(rolls * w / speed)) } else { [0.0; 2] };
        let slows = if drills > 0.0 { drills / z.abs() } else { 0.0 };
        Self::new(from, [x, y, -(drills * z.signum())], slows)
    }

    /// The speed of rolling at the start: the horizontal part of w.
    pub fn rolling(&self) -> f64 {
        self.w[0].hypot(self.w[1])
    }

    /// The drilling rate at the start: w_z.
    pub fn drills(&self) -> f64 {
        self.w[2]
    }

    fn speeds(&self, t: f64) -> [f64; 3] {
        core::array::from_fn(|i| self.w[i] + self.push[i] * t)
    }

    /// A bound of the angle by which the ball turns in the time `t`, and the number of parts of the power series over
    /// this time.
    fn angle(&self, t: f64) -> [f64; 2] {
        let angle = size(self.w).max(size(self.speeds(t))) * t;
        [angle, angle.max(size(self.push).sqrt() * t).ceil()]
    }

    /// Whether the power series over this time would have too many parts.
    pub fn needs_too_many_parts(&self, t: f64) -> bool {
        self.push != [0.0; 3] && self.angle(t)[1] > MOST_PARTS.max(PARTS_PER_TIME * t)
    }

    /// The direction of the axis after the time `t`, and a bound of the angle by which the ball has turned. In a slip
    /// each call has a later time.
    fn turned(&mut self, t: f64) -> ([f64; 3], f64) {
        let rate = size(self.w);
        if self.push == [0.0; 3] {
            if rate == 0.0 {
                return (self.axis, 0.0);
            }
            let (sin, cos) = (0.5 * rate * t).sin_cos();
            let across = cross(self.w, self.axis);
            let inward = cross(self.w, across);
            let (along, towards) = (2.0 * sin * cos / rate, 2.0 * sin * sin / (rate * rate));
            let turn = |i: usize| self.axis[i] + (along * across[i] + towards * inward[i]);
            return (core::array::from_fn(turn), rate * t);
        }
        let ([angle, parts], more) = (self.angle(t), t - self.since);
        let parts = (parts * (more / t)).ceil().max(1.0);
        let h = more / parts;
        for part in 0..parts as u64 {
            let w = self.speeds(self.since + part as f64 * h).map(|w| w * h);
            let push = self.push.map(|a| a * h * h);
            let (mut before, mut term, axis) = ([0.0; 3], self.axis, &mut self.axis);
            let mut k = 0.0;
            while size(term) + size(before) > NEGLIGIBLE_TERM {
                k += 1.0;
                let (turns, pushed) = (cross(w, term), cross(push, before));
                before = term;
                term = core::array::from_fn(|i| (turns[i] + pushed[i]) / k);
                (0..3).for_each(|i| axis[i] += term[i]);
            }
        }
        self.since = t;
        (self.axis, angle)
    }

    /// The ball after the time `t` on the table, and a bound of the angle by which it has turned.
    pub fn at(&mut self, t: f64) -> (Aloft, f64) {
        if t == 0.0 {
            return (self.from, 0.0);
        }
        let ([x, y, z], angle) = self.turned(t);
        let ([w_x, w_y, w_z], [u, v]) = (self.speeds(t), self.from.slip);
        let square = x * x + y * y;
        let (flat, size) = (square.sqrt(), (square + z * z).sqrt());
        let (s, c) = (flat / size, z / size);
        // On its pole the axis keeps the direction in which it leans.
        let (cos, sin) = if flat > 0.0 { (-x / flat, -y / flat) } else { (1.0, 0.0) };
        let (w_h, w_2) = (w_x * cos + w_y * sin, w_y * cos - w_x * sin);
        // Exactly zero at the time at which the slip ends.
        let left = if self.slows > 0.0 { (1.0 / self.slows - t) * self.slows } else { 1.0 };
        let slip = [u * cos + v * sin, v * cos - u * sin].map(|u| left * u);
        // The sum turns -0 into 0.
        let w = [c * w_h + s * w_z, w_2, c * w_z - s * w_h].map(|w| w + 0.0);
        (Aloft { angle: (s, c), w, slip, ..self.from }, angle)
    }
}
