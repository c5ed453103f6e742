//! Integration by RK4 with a fixed step, with outputs at any times.
//!
//! ```text
//! t_i = t0 + i h;   an output between two of these times takes a shortened step from the earlier one
//! ```
//! The motion ends where a more accurate solution of the same motion ends. Where the axis of a ball passes through
//! the vertical (its pole), a step ends at the edge of the pole, and the next one begins at the opposite edge.

use crate::error::{Error, copied};
use crate::laws::contact::reduced::Rates;
use crate::laws::contact::{Contact, FLAT};
use crate::laws::pose::{Angle, Pose};
use crate::laws::state::State;
use crate::methods::beat::Beat;
use crate::methods::rk4::{Compensated, increment};
use crate::methods::search;
use crate::motions::exact::course::Course;
use crate::motions::exact::event::Limits;
use crate::motions::{Ending, Event, Limit, Method, Motion};
use core::f64::consts::PI;
use nalgebra::Point2;

/// Integrates theta, w1, w2 and w3, and with a pose also phi, psi, x and y, by steps of length `h`. Returns the
/// states at the first `count` times, with at most `most` evaluations of the rates. `unguarded` means that no exact
/// motion has checked the step, so that each step is checked against the precession at its beginning.
pub(crate) fn run(
    course: &Course<'_>,
    limits: &Limits,
    (h, unguarded): (f64, bool),
    count: (usize, u64),
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Motion, Error> {
    let h = course.way() * h;
    if course.pose {
        let y = course.start;
        let numbers = [y.theta, y.w1, y.w2, y.w3, 0.0, 0.0, 0.0, 0.0];
        if limits.rates.reduced().round {
            Runner::<8, true>::new(course, limits, numbers, unguarded)?.run(h, count, go_on)
        } else {
            Runner::<8, false>::new(course, limits, numbers, unguarded)?.run(h, count, go_on)
        }
    } else if limits.rates.reduced().round {
        Runner::<4, true>::new(course, limits, (*course.start).into(), unguarded)?.run(h, count, go_on)
    } else {
        Runner::<4, false>::new(course, limits, (*course.start).into(), unguarded)?.run(h, count, go_on)
    }
}

/// A point of a motion: the time, the state vector, its time derivative, and the whole turns of phi and psi.
#[derive(Clone, Copy)]
struct Stage<const N: usize> {
    t: f64,
    at: Compensated<N>,
    derivative: [f64; N],
    turns: [f64; 2],
}

impl<const N: usize> Stage<N> {
    /// The angle between the axis and the vertical, minus the small angle `FLAT`: negative where a face has landed,
    /// or where the axis of a ball is vertical.
    fn height(&self) -> f64 {
        self.at.y[0].min(PI - self.at.y[0]) - FLAT
    }
}

/// An integration by fixed steps, with its outputs. `ROUND` means that the rim is rounded and the body rolls.
struct Runner<'a, const N: usize, const ROUND: bool> {
    course: &'a Course<'a>,
    rates: Rates<f64>,
    contact: Contact,
    unguarded: bool,
    here: Stage<N>,
    evaluations: u64,
    motion: Motion,
}

fn stepped_state<const N: usize>(y: &[f64; N]) -> State {
    State { theta: y[0], w1: y[1], w2: y[2], w3: y[3] }
}

#[inline(always)]
fn derivative<const N: usize, const ROUND: bool>(
    (rates, contact): (&Rates<f64>, Contact),
    y: &[f64; N],
    angle: (f64, f64),
) -> [f64; N] {
    let now = stepped_state(y);
    let [w1, w2, w3] = rates.at_rim_kind::<ROUND>(angle.0, angle.1, [now.w1, now.w2, now.w3]);
    let dy = State { theta: -now.w2, w1, w2, w3 };
    let mut changes = [0.0; N];
    changes[..4].copy_from_slice(&[dy.theta, dy.w1, dy.w2, dy.w3]);
    if N == 8 {
        let (sin, cos) = y[4].sin_cos();
        let precession = now.w1 / angle.0;
        let spin = now.w3 - precession * angle.1;
        let path = match contact {
            Contact::Rolling => {
                let rim = &rates.reduced().shape.rim;
                if ROUND {
                    let (along, round) = (rim.radius(angle) * spin, rim.rho * dy.theta);
                    [-along * sin - round * cos, along * cos - round * sin]
                } else {
                    [-spin * sin, spin * cos]
                }
            }
            Contact::Smooth => [0.0; 2],
        };
        changes[4..].copy_from_slice(&[precession, spin, path[0], path[1]]);
    }
    changes
}

impl<'a, const N: usize, const ROUND: bool> Runner<'a, N, ROUND> {
    fn new(course: &'a Course<'a>, limits: &Limits, y: [f64; N], unguarded: bool) -> Result<Self, Error> {
        let motion = Motion::empty(course.times.len(), course.pose)?;
        let (rates, contact) = (limits.rates, limits.contact);
        let here = Self::place((&rates, contact), 0.0, Compensated::new(y), [0.0; 2]);
        Ok(Self { course, rates, contact, unguarded, here, evaluations: 0, motion })
    }

    /// The point with the time `t` and the state vector `at`. The whole turns of an angle phi or psi beyond [-pi, pi]
    /// are moved to `turns`.
    #[inline(always)]
    fn place(law: (&Rates<f64>, Contact), t: f64, mut at: Compensated<N>, mut turns: [f64; 2]) -> Stage<N> {
        for i in 4..N.min(6) {
            if at.y[i].abs() > PI {
                let angle = Angle { turns: 0.0, rest: at.y[i] }.settled();
                at.y[i] = angle.rest;
                turns[i - 4] += angle.turns;
            }
        }
        let derivative = derivative::<N, ROUND>(law, &at.y, at.y[0].sin_cos());
        Stage { t, at, derivative, turns }
    }

    /// The change of the state vector over a step `h`; infinite if theta leaves (0, pi) at a stage of the step.
    #[inline(always)]
    fn change(law: (&Rates<f64>, Contact), from: &Stage<N>, h: f64) -> [f64; N] {
        let mut inside = true;
        let mut f = |y: &[f64; N]| {
            inside &= y[0] > 0.0 && y[0] < PI;
            derivative::<N, ROUND>(law, y, y[0].sin_cos())
        };
        let change = increment(&mut f, &from.at.y, &from.derivative, h);
        if inside { change } else { [f64::INFINITY; N] }
    }

    fn run(
        mut self,
        step: f64,
        (count, most): (usize, u64),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Motion, Error> {
        let (t0, way) = (self.course.t0, self.course.way());
        // With a local copy the compiler computes terms that depend on the body alone only once.
        let rates = self.rates;
        let mut beat = Beat::new();
        let times = &self.course.times[..count];
        let mut written = times.partition_point(|t| *t == t0);
        for _ in 0..written {
            self.write(&self.here.clone());
        }
        let (mut steps, mut pause) = (0u64, 512.min(most / 4 + 1));
        while written < times.len() {
            steps += 1;
            if steps == pause {
                pause = (pause + 512).min(most / 4 + 1);
                let spent = steps > most / 4;
                if spent || beat.is_due() && !go_on() {
                    let limit = if spent { Limit::Evaluations } else { Limit::Interrupted };
                    let (time, state) = (t0 + self.here.t, stepped_state(&self.here.at.y));
                    self.motion.event = Some(Event { ending: Ending::Bounded, time, state, rim: 0 });
                    self.motion.limit = Some(limit);
                    break;
                }
            }
            let then = steps as f64 * step;
            let ahead = match self.step_to(&rates, then)? {
                Some(ahead) => ahead,
                // The pole of a ball lies within this step.
                None if self.course.body.is_ball() => Stage { t: then, ..self.stage_at(then) },
                None => {
                    // Theta leaves (0, pi) within this step. If outputs remain after the step, it has jumped
                    // over a near-flat turn; else the face lands after the last output.
                    if times.last().is_some_and(|t| (t - t0).abs() > then.abs()) {
                        let (time, theta, step) = (t0 + self.here.t, self.here.at.y[0], step.abs());
                        return Err(Error::Step { step, time, theta, advice: 0.1 * step });
                    }
                    for t in &times[written..] {
                        self.write(&self.stage_at(t - t0));
                    }
                    break;
                }
            };
            let pole = self.pole(&ahead, way);
            let ahead = pole.map_or(ahead, |(edge, _)| edge);
            let limit = ahead.t.abs() * (1.0 + 4.0 * f64::EPSILON);
            while let Some(t) = times.get(written).map(|t| t - t0).filter(|t| t.abs() <= limit) {
                let near = (t - ahead.t).abs() <= 8.0 * f64::EPSILON * t.abs();
                let place = if near { ahead } else { self.stage_at(t) };
                self.write(&place);
                written += 1;
            }
            self.here = pole.map_or(ahead, |(_, past)| past);
        }
        self.motion.times = copied(&times[..self.motion.states.len()])?;
        self.motion.method = Method::Step(step.abs());
        self.motion.evaluations = self.evaluations;
        Ok(self.motion)
    }

    /// Makes one RK4 step, to the time `t`; None if theta leaves (0, pi) within the step.
    #[inline(always)]
    fn step_to(&mut self, rates: &Rates<f64>, t: f64) -> Result<Option<Stage<N>>, Error> {
        let (here, law) = (&self.here, (rates, self.contact));
        let fast = stepped_state(&here.at.y).precession().abs();
        if self.unguarded && (t - here.t).abs() * fast > 1.0 {
            let (time, theta) = (self.course.t0 + here.t, here.at.y[0]);
            return Err(Error::Step { step: (t - here.t).abs(), time, theta, advice: 0.3 / fast });
        }
        let change = Self::change(law, here, t - here.t);
        self.evaluations += 4;
        Ok(change[0].is_finite().then(|| Self::place(law, t, here.at.plus(&change), here.turns)))
    }

    /// The points at which a ball reaches and leaves the edge of its pole on the way to `ahead`. Between them
    /// the axis passes through the vertical, so that phi and psi each change by half a turn.
    fn pole(&self, ahead: &Stage<N>, way: f64) -> Option<(Stage<N>, Stage<N>)> {
        if !self.course.body.is_ball() || ahead.height() >= 0.0 {
            return None;
        }
        let height = |t: f64| self.stage_at(t).height();
        let t = search::crossing(height, self.here.t, ahead.t, self.here.height().max(0.0), ahead.height());
        let edge = self.stage_at(t);
        let mut y = edge.at.y;
        let (low, off) = (y[0] < 1.0, y[0].min(PI - y[0]));
        y[2] = -y[2];
        if N == 8 {
            let (sin, cos) = y[4].sin_cos();
            // Across the pole the contact point moves straight on.
            let path = if self.contact == Contact::Rolling { 2.0 * off } else { 0.0 };
            let path = if low { path } else { -path };
            (y[6], y[7]) = (y[6] + path * cos, y[7] + path * sin);
            y[4] += way * PI;
            y[5] += if low { -way * PI } else { way * PI };
        }
        let t = edge.t + way * 2.0 * off / y[2].abs();
        Some((edge, Self::place((&self.rates, self.contact), t, Compensated::new(y), edge.turns)))
    }

    /// The point at time `t`, reached from the last point by one shortened step, or by several where theta would
    /// leave (0, pi) in one.
    fn stage_at(&self, t: f64) -> Stage<N> {
        let law = (&self.rates, self.contact);
        let mut place = self.here;
        let mut h = t - place.t;
        for _ in 0..80 {
            let change = Self::change(law, &place, h);
            if change[0].is_finite() {
                place = Self::place(law, place.t + h, place.at.plus(&change), place.turns);
                if (t - place.t).abs() <= f64::EPSILON * t.abs() {
                    return Stage { t, ..place };
                }
                h = t - place.t;
            } else {
                h *= 0.5;
            }
        }
        place
    }

    /// Adds a point to the outputs of the motion.
    fn write(&mut self, place: &Stage<N>) {
        let y = &place.at.y;
        let now = stepped_state(y);
        self.motion.states.push(now);
        if let Some(poses) = &mut self.motion.poses
            && N == 8
        {
            let angle = |i: usize| Angle { turns: place.turns[i], rest: y[4 + i] }.settled();
            let (phi, psi) = (angle(0), angle(1));
            let contact = match self.contact {
                Contact::Rolling => Point2::new(y[6], y[7]),
                Contact::Smooth => {
                    Pose::contact_point_below_centre(self.course.body, self.course.start, &now, phi.rest)
                }
            };
            poses.push(Pose { phi, psi, contact_point: contact, height: 0.0 });
        }
    }
}
