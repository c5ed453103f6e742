//! A uniform ball, l = 0 and I1 = I3 = I, whose phases are known: none of them is integrated.
//!
//! ```text
//! rolls, flies    w stays in space, and the axis n turns about it
//! slips           u = u0 (1 - t/T),   T = |u0|/(mu (1 + 1/I)),   w = w0 + a t,   a = mu z x u0/(I |u0|)
//! n' = w x n      n = sum n_k t^k,   (k + 1) n_{k+1} = w0 x n_k + a x n_{k-1}        in parts of a radian
//! lands           t = v + sqrt(v^2 + 2 z)
//! ```
//! The normal force on the table is the weight, rolling needs no friction, and a slip keeps its direction (Coriolis,
//! Theorie mathematique des effets du jeu de billard (1835)). All vectors are along e_h, e2 and z of the phase's
//! beginning, where n = (-s, 0, c). With poses the walk computes a uniform ball as any other body.
//!
//! Error: a few roundings of each phase, of which every later angle, speed and time has its share; of w1, w2 and the slip
//! over sin(theta).

use super::flight::Aloft;
use super::phases::BodyWalk;
use crate::laws::body::Body;
use crate::laws::contact::impact::{Hit, Struck};
use crate::laws::contact::slip::Friction;
use crate::laws::contact::{Contact, Table, force};
use crate::laws::state::State;
use crate::motions::followed::Followed;
use crate::motions::halt::{Halt, TIME, lost};
use crate::motions::judge::doubted;
use crate::motions::row::OutputRow;
use crate::motions::{Ask, Kind};
use core::f64::consts::PI;

/// Roundings of the numbers of one phase.
const ROUNDINGS: f64 = 8.0;
/// Two terms of the series in succession that are smaller than this end a part of it; in a part w h and a h^2 are at most
/// 1, so that there are thirty terms at most.
const SMALL: f64 = 1e-18;

/// Whether every phase of this motion is known.
pub(crate) fn knows(body: &Body, ask: &Ask) -> bool {
    let dry = match ask.table {
        Table::Rolling { .. } | Table::Smooth => true,
        Table::Rubs(Friction::Coulomb { patch, .. }) => patch == 0.0,
        Table::Rubs(Friction::Viscous { .. }) => false,
    };
    let uniform = body.is_ball() && body.ell() == 0.0 && body.i1() == body.i3() && body.theta_end() >= PI;
    uniform && dry && !ask.pose && ask.losses.is_none()
}

/// The errors of a motion whose phases are known: roundings of the speeds so far, the error of the axis, and that of the
/// time.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Roundings {
    count: f64,
    pub turned: f64,
    late: f64,
}

fn cross([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// A phase from its start.
struct Spun {
    from: Aloft,
    axis: [f64; 3],
    w: [f64; 3],
    /// The change of w in a unit of time, and the share of its slip that the ball loses in it.
    push: [f64; 3],
    slows: f64,
    fastest: f64,
}

impl Spun {
    fn new(from: &Aloft, push: [f64; 3], slows: f64) -> Self {
        let ((s, c), [w1, w2, w3]) = (from.angle, from.w);
        let w = [c * w1 - s * w3, w2, s * w1 + c * w3];
        let fastest = w.into_iter().chain(from.slip).fold(1.0, |most: f64, x| most.max(x.abs()));
        Self { from: *from, axis: [-s, 0.0, c], w, push, slows, fastest }
    }

    /// A slip under friction of this strength; without friction it does not slow down.
    fn rubbing(from: &Aloft, inertia: f64, mu: f64) -> Self {
        let speed = from.slip[0].hypot(from.slip[1]);
        if mu == 0.0 || speed == 0.0 {
            return Self::new(from, [0.0; 3], 0.0);
        }
        let [along, across] = from.slip.map(|u| mu * u / (inertia * speed));
        Self::new(from, [-across, along, 0.0], mu * (1.0 + 1.0 / inertia) / speed)
    }

    fn speeds(&self, t: f64) -> [f64; 3] {
        core::array::from_fn(|i| self.w[i] + self.push[i] * t)
    }

    /// The axis after a time, and the angle by which the ball has turned at most.
    fn turned(&self, t: f64) -> ([f64; 3], f64) {
        let size = |w: [f64; 3]| (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]).sqrt();
        let rate = size(self.w);
        if self.slows == 0.0 {
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
        let angle = rate.max(size(self.speeds(t))) * t;
        let parts = angle.max(size(self.push).sqrt() * t).ceil().max(1.0);
        let (h, mut axis) = (t / parts, self.axis);
        for part in 0..parts as u64 {
            let (w, push) = (self.speeds(part as f64 * h).map(|w| w * h), self.push.map(|a| a * h * h));
            let (mut before, mut term) = ([0.0; 3], axis);
            let mut k = 0.0;
            while size(term) + size(before) > SMALL {
                k += 1.0;
                let (turns, pushed) = (cross(w, term), cross(push, before));
                before = term;
                term = core::array::from_fn(|i| (turns[i] + pushed[i]) / k);
                (0..3).for_each(|i| axis[i] += term[i]);
            }
        }
        (axis, angle)
    }

    /// The ball after a time on the table, and the angle by which it has turned.
    fn at(&self, t: f64) -> (Aloft, f64) {
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
        let left = (1.0 - self.slows * t).max(0.0);
        let slip = [u * cos + v * sin, v * cos - u * sin].map(|u| left * u);
        // The sum turns -0 into 0.
        let w = [c * w_h + s * w_z, w_2, c * w_z - s * w_h].map(|w| w + 0.0);
        (Aloft { angle: (s, c), w, slip, ..self.from }, angle)
    }
}

impl<const N: usize> BodyWalk<'_, N> {
    /// The ball after a time of a phase, with its error among the claims.
    fn spun(&mut self, spun: &Spun, t: f64) -> (Aloft, f64) {
        let (mut at, angle) = spun.at(t);
        if self.of.planar {
            (at.w[0], at.w[2], at.slip[1]) = (0.0, 0.0, 0.0);
        }
        let (of, fastest) = (&self.of.roundings, spun.fastest);
        let share = (of.count + ROUNDINGS) * f64::EPSILON;
        let turned = of.turned + share * (1.0 + angle) + 2.0 * fastest * of.late;
        let sine = if at.angle.0 > 0.0 { at.angle.0 } else { 1.0 };
        self.claims(fastest * (turned / sine + share));
        (at, angle)
    }

    /// Ends a phase of the length `t` in which the ball has turned by `angle`, and whose end is as late as `late`.
    fn rounds(&mut self, t: f64, angle: f64, late: f64) {
        let of = &mut self.of.roundings;
        of.count += ROUNDINGS;
        let share = of.count * f64::EPSILON;
        of.turned += share * (1.0 + angle);
        of.late += share * (t + late);
        let late = of.late;
        self.claims(late);
    }

    fn numbers(&self, at: &Aloft, time: f64, heat: f64) -> [f64; N] {
        let ((s, c), [w1, w2, w3], [u, v]) = (at.angle, at.w, at.slip);
        let mut y = self.at;
        y[..9].copy_from_slice(&[s, c, w1, w2, w3, u, v, time, heat]);
        y
    }

    /// Rolls to the last time: nothing ends it.
    pub(super) fn rolls_uniformly(&mut self) {
        let (now, spent, body) = (self.at[TIME], [self.at[8], lost(&self.at)], self.of.body);
        let spun = Spun::new(&Aloft { slip: [0.0; 2], ..self.aloft() }, [0.0; 3], 0.0);
        while let Some(t) = self.until() {
            let y = self.spun(&spun, t - now).0.state();
            let error = self.made.motion.error;
            let force =
                self.ask.force.then(|| doubted(&y, [error; 2], |y| force(Contact::Rolling, &body, y)));
            let row = OutputRow::on_table(y, [0.0; 2], spent, Kind::Rolling);
            self.made.push(OutputRow { force, ..row });
        }
    }

    /// Slips until the slip vanishes, or to the last time.
    pub(super) fn slips_uniformly(&mut self) {
        let (now, heat, mu) = (self.at[TIME], self.at[8], self.of.slide.law.strength);
        let (from, ask, slide) = (self.aloft(), self.ask, self.of.slide);
        let spun = Spun::rubbing(&from, self.of.body.i3(), mu);
        let speed = from.slip[0].hypot(from.slip[1]);
        let heat = |t: f64| heat + mu * speed * t * (1.0 - 0.5 * spun.slows * t);
        let end = 1.0 / spun.slows;
        while let Some(t) = self.until().filter(|t| *t <= now + end) {
            let at = self.spun(&spun, t - now).0;
            let y = self.numbers(&at, t, heat(t - now));
            self.made.slid(&ask, &slide, &y);
        }
        let over = self.until().is_none();
        let length = if over { self.since.last().map_or(0.0, |t| t - now) } else { end };
        let (mut at, angle) = self.spun(&spun, length);
        self.rounds(length, angle, if over { 0.0 } else { spun.fastest * end / speed });
        if !over {
            at.slip = [0.0; 2];
        }
        let y = self.numbers(&at, now + length, heat(length));
        self.slip_ends(y, if over { Halt::Time } else { Halt::Standstill });
    }

    /// The impact of a ball whose contact point does not slip: friction has nothing to stop.
    pub(super) fn rebounds(&self, lift: f64, e: f64) -> Struck {
        let hit = match self.ask.table {
            Table::Rolling { .. } => Hit::Sticks,
            Table::Rubs(friction) if friction.strength() > 0.0 || friction.sticks() => Hit::Sticks,
            _ => Hit::Smooth,
        };
        let impulse = [0.0, 0.0, -((1.0 + e) * lift)];
        let lost = 0.5 * (1.0 - e) * (1.0 + e) * lift * lift;
        Struck { impulse, slip: [0.0; 2], lift: 0.0 - e * lift, hit, lost }
    }

    /// Flies to its landing, or to the last time.
    pub(super) fn flies_uniformly(&mut self) {
        let (from, now) = (self.aloft(), self.at[TIME]);
        let (spun, up) = (Spun::new(&from, [0.0; 3], 0.0), from.lift);
        let fall = (up * up + 2.0 * from.height).sqrt();
        let end = if up < 0.0 { 2.0 * from.height / (fall - up) } else { up + fall };
        while let Some(t) = self.until().filter(|t| *t <= now + end) {
            let (t, at) = (t - now, self.spun(&spun, t - now).0);
            let height = (from.height + t * (up - 0.5 * t)).max(0.0);
            self.writes_with(&Aloft { height, lift: up - t, ..at }, Kind::Flying, 0.0);
        }
        if self.since.last().is_none_or(|last| now + end > *last) {
            return;
        }
        let (at, angle) = self.spun(&spun, end);
        self.rounds(end, angle, 0.0);
        self.at[TIME] = now + end;
        self.sets(&Aloft { height: 0.0, lift: -fall, ..at });
        let next = self.strikes();
        self.continues_with(next);
    }
}

impl Followed {
    /// Completes the estimated errors of a motion whose phases are all known, which no rougher run has to show.
    pub(crate) fn knows_itself(&mut self, tol: f64) {
        let phases = self.path.phases.iter();
        let fastest = |y: &State| y.w1.abs().max(y.w2.abs()).max(y.w3.abs());
        let fastest = phases.fold(1.0, |most: f64, phase| most.max(fastest(&phase.state)));
        self.motion.error += 8.0 * f64::EPSILON * fastest;
        self.motion.force_error *= (self.motion.error / tol).max(1.0);
    }
}
