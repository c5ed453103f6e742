//! The motion of a uniform ball, whose phases have closed forms: rolling, slips, flights and the bounces between
//! them.
//!
//! ```text
//! lands     t = v + sqrt(v^2 + 2 z)          with the velocity -sqrt(v^2 + 2 z)
//! error     e1 roundings of w in all phases,  e2 = sum e1 (1 + |w| t) of the axis,  e3 = sum e1 t of the time
//! ```
//! [`spun`](super::spun) has the equations. These errors need no second run, since they do not grow in other ways.

use super::body_walk::BodyWalk;
use super::fly::Aloft;
use super::own::Own;
use super::roll::lossy::LossyFlow;
use super::slide::{Slide, is_still};
use super::spun::{ROUNDINGS_PER_PHASE, Spun};
use crate::laws::contact::impact::{Hit, Struck};
use crate::laws::contact::{Contact, Table, force, patch};
use crate::laws::loss::{Holds, Law};
use crate::laws::state::{State, drilling_of, rolling_of};
use crate::motions::ask::row::OutputRow;
use crate::motions::dry::creep::Creeping;
use crate::motions::walk::Next;
use crate::motions::walk::errors::doubted;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, Halt, SIN, TIME, U2, UH, W1, W3, loses, lost, poses,
};
use crate::motions::walk::two_runs::Followed;
use crate::motions::{Ending, Kind, Limit};
use crate::numbers::larger_or_nan;

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// The ball after the time `t` of a phase, whose error is included in the estimated error.
    fn spun(&mut self, spun: &mut Spun, t: f64) -> (Aloft, f64) {
        let (mut at, angle) = spun.at(t);
        if self.of.planar {
            (at.w[0], at.w[2], at.slip[1]) = (0.0, 0.0, 0.0);
        }
        let (of, fastest) = (&self.of.roundings, spun.fastest);
        let share = (of.count + ROUNDINGS_PER_PHASE) * f64::EPSILON;
        let turned = of.turned + share * (1.0 + angle) + 2.0 * fastest * of.late;
        let sine = if at.angle.0 > 0.0 { at.angle.0 } else { 1.0 };
        self.claims(fastest * (turned / sine + share));
        (at, angle)
    }

    /// Adds the errors of a phase that lasts for the time `t`, in which the ball turns by `angle`. The error of the
    /// time grows in proportion to `t` + `late`.
    fn rounds(&mut self, t: f64, angle: f64, late: f64) {
        let of = &mut self.of.roundings;
        of.count += ROUNDINGS_PER_PHASE;
        let share = of.count * f64::EPSILON;
        of.turned += share * (1.0 + angle);
        of.late += share * (t + late);
        let late = of.late;
        self.claims(late);
    }

    /// The impact of a ball whose contact point does not slip, so that friction has no effect.
    pub(super) fn rebounds(&self, lift: f64, e: f64) -> Struck {
        let hit = match self.ask.table {
            Table::Rolling { .. } => Hit::Sticks,
            Table::Rubs(friction) if friction.strength() > 0.0 || friction.sticks() => Hit::Sticks,
            _ => Hit::Smooth,
        };
        let impulse = [0.0, 0.0, -((1.0 + e) * lift)];
        let lost = 0.5 * (1.0 - e) * (1.0 + e) * lift * lift;
        Struck { impulse, couple: 0.0, slip: [0.0; 2], lift: 0.0 - e * lift, hit, lost }
    }

    /// Computes a flight of the ball to its landing, or to the last time.
    pub(super) fn flies_uniformly(&mut self) {
        let (from, now) = (self.aloft(), self.at[TIME]);
        let (mut spun, up) = (Spun::new(&from, [0.0; 3], 0.0), from.lift);
        let fall = (up * up + 2.0 * from.height).sqrt();
        let end = if up < 0.0 { 2.0 * from.height / (fall - up) } else { up + fall };
        while let Some(t) = self.until().map(|t| t - now).filter(|t| *t <= end) {
            let at = self.spun(&mut spun, t).0;
            // A product that vanishes exactly at the landing.
            let height = if t == 0.0 { from.height } else { 0.5 * (end - t) * (t + (fall - up)) };
            self.writes_with(&Aloft { height, lift: up - t, ..at }, Kind::Flying, 0.0);
        }
        if self.since.last().is_none_or(|last| end > last - now) {
            return;
        }
        let (at, angle) = self.spun(&mut spun, end);
        self.rounds(end, angle, 0.0);
        self.at[TIME] = now + end;
        self.sets(&Aloft { height: 0.0, lift: -fall, ..at });
        let next = self.strikes();
        self.continues_with(next);
    }
}

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    fn numbers(&self, at: &Aloft, time: f64, [heat, lost]: [f64; 2]) -> [f64; N] {
        let ((s, c), [w1, w2, w3], [u, v]) = (at.angle, at.w, at.slip);
        let mut y = self.at;
        y[..8].copy_from_slice(&[s, c, w1, w2, w3, u, v, time]);
        y[HEAT] += heat;
        if loses(N) {
            y[N - 1] += lost;
        }
        y
    }

    /// Computes the rolling of the ball up to the last time, since no event ends it.
    pub(super) fn rolls_uniformly(&mut self) {
        let (now, spent, body) = (self.at[TIME], [self.at[HEAT], lost(&self.at)], self.of.body);
        let mut spun = Spun::new(&Aloft { slip: [0.0; 2], ..self.aloft() }, [0.0; 3], 0.0);
        while let Some(t) = self.until() {
            let y = self.spun(&mut spun, t - now).0.state();
            let error = self.made.motion.error;
            let force =
                self.ask.force.then(|| doubted(&y, [error; 2], |y| force(Contact::Rolling, &body, y)));
            let row = OutputRow::on_table(y, [0.0; 2], spent, Kind::Rolling);
            self.made.push(OutputRow { force, ..row });
        }
    }

    /// Computes a phase in which friction slows the ball. It ends after the time `end`, when a velocity of the size
    /// `stops` has become zero. `spent` returns the heat and the energy lost at a time, and `resists` has the
    /// equations of a ball that does not slip. Returns the state vector at the end of the phase or at the last time,
    /// and whether the last time comes first; None if the phase is too much work.
    fn rubs_uniformly(
        &mut self,
        mut spun: Spun,
        [end, stops]: [f64; 2],
        spent: impl Fn(f64) -> [f64; 2],
        resists: Option<&LossyFlow<G>>,
    ) -> Option<([f64; N], bool)> {
        let (now, ask, slide) = (self.at[TIME], self.ask, self.of.slide);
        let (body, start) = (self.of.body, self.of.start);
        let left = self.since.last().map_or(0.0, |t| t - now);
        if spun.needs_too_many_parts(end.min(left)) {
            self.next = Some(self.gives_up(Limit::Evaluations));
            return None;
        }
        while let Some(t) = self.until().filter(|t| t - now <= end) {
            let at = self.spun(&mut spun, t - now).0;
            let y = self.numbers(&at, t, spent(t - now));
            match resists {
                Some(flow) => self.made.lossy(&ask, (&body, &start, flow), &y, Kind::Rolling),
                None => self.made.slid(&ask, &slide, &y),
            }
        }
        let over = self.until().is_none();
        let length = if over { left } else { end };
        let (at, angle) = self.spun(&mut spun, length);
        self.rounds(length, angle, if over { 0.0 } else { spun.fastest * end / stops });
        Some((self.numbers(&at, now + length, spent(length)), over))
    }

    /// Computes a slip of the ball until it vanishes, or to the last time.
    pub(super) fn slips_uniformly(&mut self) {
        let (mu, from) = (self.of.slide.law.strength, self.aloft());
        let spun = Spun::rubbing(&from, self.of.body.i3(), mu);
        let (speed, slows) = (from.slip[0].hypot(from.slip[1]), spun.slows);
        let spent = |t: f64| [mu * speed * t * (1.0 - 0.5 * slows * t), 0.0];
        let Some((mut y, over)) = self.rubs_uniformly(spun, [1.0 / slows, speed], spent, None) else {
            return;
        };
        if !over {
            (y[UH], y[U2]) = (0.0, 0.0);
        }
        self.slip_ends(y, if over { Halt::Time } else { Halt::Standstill });
    }

    /// Computes the drilling and creep of the ball on a patch of contact, until the drilling or the rolling ends, or
    /// to the last time.
    pub(crate) fn creeps_uniformly(&mut self, creeping: Creeping) {
        let (inertia, law, still) = (self.of.body.i3(), &self.of.slide.law, is_still(&self.at));
        let k = if still { 0.0 } else { creeping.k };
        let of = patch::of(k);
        let [force, couple] =
            [of.force, of.couple].map(|share| law.strength * law.patch().unwrap_or(0.0) * share);
        let rates = if still { [0.0, couple / inertia] } else { creeping.rates };
        let arm = if still { 0.0 } else { self.ask.losses.coefficient(Law::RollingResistance) };
        let spun = Spun::slowing(&self.aloft(), rates);
        let speeds = [spun.rolling(), spun.drills().abs()];
        let ends = [0, 1].map(|i| if rates[i] > 0.0 { speeds[i] / rates[i] } else { f64::INFINITY });
        let first = usize::from(ends[1] <= ends[0]);
        let spent = |t: f64| {
            [(1, k * force + couple), (0, arm)].map(|(i, by)| by * t * (speeds[i] - 0.5 * rates[i] * t))
        };
        let stops = [ends[first], speeds[first]];
        let Some((mut y, over)) = self.rubs_uniformly(spun, stops, spent, None) else { return };
        let halt = match first {
            _ if over => Halt::Time,
            0 => {
                self.of.slide.died = false;
                Halt::Rests
            }
            _ => {
                let drilling = drilling_of(y.angle(), y[W1], y[W3]);
                (y[W1], y[W3]) = (y[W1] - y[SIN] * drilling, y[W3] - y[COS] * drilling);
                (y[UH], y[U2]) = (0.0, 0.0);
                Halt::Standstill
            }
        };
        self.slip_ends(y, halt);
    }

    /// Whether the phase of rolling that begins has a closed form: only dry friction slows the ball, by couples that
    /// are constant in the laboratory.
    pub(super) fn is_slowing_known(&self) -> bool {
        let mut losses = self.ask.losses.iter();
        let dry = !self.of.own.has_couple()
            && losses.all(|(law, _)| matches!(law, Law::RollingResistance | Law::Drilling));
        !poses(N) && dry && self.of.body.is_uniform_ball() && self.contact() == Contact::Rolling
    }

    /// Computes the ball's rolling under rolling resistance, and its drilling, each until it stops, up to rest or to
    /// the last time.
    pub(super) fn rolls_to_rest(&mut self, flow: &LossyFlow<G>) {
        let (losses, inertia) = (self.ask.losses, self.of.body.i3());
        let couples = [Law::RollingResistance, Law::Drilling].map(|law| losses.coefficient(law));
        let rates = [couples[0] / (1.0 + inertia), couples[1] / inertia];
        self.inherits_errors();
        loop {
            let from = self.aloft();
            let ([w1, w2, w3], angle) = (from.w, from.angle);
            let (rolling, drilling) = (rolling_of(angle, w1, w3), drilling_of(angle, w1, w3));
            // What has stopped moves on by roundings.
            let rests = 4.0 * f64::EPSILON * <Slide>::fastest(&self.at);
            let speeds = [rolling.hypot(w2), drilling.abs()].map(|x| if x <= rests { 0.0 } else { x });
            if speeds == [0.0; 2] {
                self.stops_exactly(Holds { rolling: true, drilling: true, contour: false });
                self.next = Some(Next::Ends(Ending::Stops));
                return;
            }
            let slows = [0, 1].map(|i| if speeds[i] > 0.0 { rates[i] } else { 0.0 });
            let ends = [0, 1].map(|i| if slows[i] > 0.0 { speeds[i] / slows[i] } else { f64::INFINITY });
            let (end, stops) = if ends[0] <= ends[1] { (ends[0], speeds[0]) } else { (ends[1], speeds[1]) };
            let lost = |t: f64, i: usize| couples[i] * t * (speeds[i] - 0.5 * slows[i] * t);
            let spent = |t: f64| [0.0, lost(t, 0) + lost(t, 1)];
            let spun = Spun::slowing(&from, slows);
            let Some((y, over)) = self.rubs_uniformly(spun, [end, stops], spent, Some(flow)) else { return };
            self.arrives(y);
            if over {
                return;
            }
            self.stops_exactly(Holds { rolling: end == ends[0], drilling: end == ends[1], contour: false });
        }
    }
}

impl Followed {
    /// Completes the estimated errors of a motion whose phases all have closed forms, so that no second run is
    /// needed.
    pub(crate) fn complete_known_errors(&mut self, tol: f64) {
        let phases = self.path.phases.iter();
        let fastest = |y: &State| y.w1.abs().max(y.w2.abs()).max(y.w3.abs());
        let fastest = phases.fold(1.0, |most: f64, phase| most.max(fastest(&phase.state)));
        self.motion.error += 8.0 * f64::EPSILON * fastest;
        self.motion.force_error *= larger_or_nan(1.0, self.motion.error / tol);
    }
}
