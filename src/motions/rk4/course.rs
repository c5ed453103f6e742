//! Integration by RK4 with fixed steps or within a tolerance, with outputs at any times, and events.
//!
//! ```text
//! fixed      t_i = t0 + i h; an output between two of them is a shortened step from the one before
//! tolerance  two steps of h/2 against one of h: error (y2 - y1)/15, taken off (Richardson 1911)
//! ```
//! The error of the inclination is measured relative to sin theta, that is in ln tan(theta/2), so that the passage of a
//! nearly flat body is resolved for every least inclination. An event is a margin that turns negative at the end of a
//! step, or between two steps where the margin has a minimum; its time is the zero of the margin over shortened steps.

use crate::error::{Error, copied};
use crate::laws::contact::{Contact, FLAT};
use crate::laws::pose::{Angle, Pose};
use crate::laws::state::State;
use crate::methods::beat::Beat;
use crate::methods::rk4::{Compensated, increment};
use crate::methods::search;
use crate::motions::limits::Limits;
use crate::motions::{Ending, Event, Method, Motion};
use core::f64::consts::PI;
use nalgebra::Point2;

/// The start, the times and the outputs of an integration.
pub(crate) struct Course<'a> {
    pub start: &'a State,
    /// The time from the start to the last output, signed.
    pub span: f64,
    pub times: &'a [f64],
    pub t0: f64,
    pub pose: bool,
    /// Whether nothing has judged a fixed step before, so that every step judges itself.
    pub unguarded: bool,
}

/// The choice of the steps.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Stepping {
    /// A fixed step, with the sign of the direction of time.
    Fixed(f64),
    /// Steps whose errors are below this tolerance.
    Within(f64),
}

/// Integrates theta, w1, w2 and w3, and with a pose also phi, psi, x and y.
pub(crate) fn run(
    course: &Course<'_>,
    limits: &Limits,
    stepping: Stepping,
    beyond: bool,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    if course.pose {
        let y = course.start;
        let numbers = [y.theta, y.w1, y.w2, y.w3, 0.0, 0.0, 0.0, 0.0];
        if limits.rates.reduced().round {
            Runner::<8, true>::new(course, limits, numbers)?.run(stepping, beyond, go_on)
        } else {
            Runner::<8, false>::new(course, limits, numbers)?.run(stepping, beyond, go_on)
        }
    } else if limits.rates.reduced().round {
        Runner::<4, true>::new(course, limits, (*course.start).into())?.run(stepping, beyond, go_on)
    } else {
        Runner::<4, false>::new(course, limits, (*course.start).into())?.run(stepping, beyond, go_on)
    }
}

/// A point of a motion: time since the start, numbers, their derivative, margins, and whole turns of phi and psi.
#[derive(Clone, Copy)]
struct Stage<const N: usize> {
    t: f64,
    at: Compensated<N>,
    derivative: [f64; N],
    margins: [f64; 4],
    turns: [f64; 2],
}

/// An integration; `ROUND` says whether the rim is rounded and rolls.
struct Runner<'a, const N: usize, const ROUND: bool> {
    course: &'a Course<'a>,
    limits: Limits,
    /// The last two points, the earlier one first.
    before: Stage<N>,
    here: Stage<N>,
    evaluations: u64,
    /// A landing of the face, the only event beyond which no motion goes on.
    landed: Option<Event>,
    motion: Motion,
}

fn state<const N: usize>(y: &[f64; N]) -> State {
    State { theta: y[0], w1: y[1], w2: y[2], w3: y[3] }
}

#[inline(always)]
fn derivative<const N: usize, const ROUND: bool>(
    limits: &Limits,
    y: &[f64; N],
    angle: (f64, f64),
) -> [f64; N] {
    let now = state(y);
    let [w1, w2, w3] = limits.rates.at_on::<ROUND>(angle.0, angle.1, [now.w1, now.w2, now.w3]);
    let dy = State { theta: -now.w2, w1, w2, w3 };
    let mut changes = [0.0; N];
    changes[..4].copy_from_slice(&[dy.theta, dy.w1, dy.w2, dy.w3]);
    if N == 8 {
        let (sin, cos) = y[4].sin_cos();
        let precession = now.w1 / angle.0;
        let spin = now.w3 - precession * angle.1;
        let path = match limits.contact {
            Contact::Rolling => {
                let rim = &limits.rates.reduced().shape.rim;
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
    fn new(course: &'a Course<'a>, limits: &Limits, y: [f64; N]) -> Result<Self, Error> {
        let nowhere = Stage {
            t: 0.0,
            at: Compensated::new(y),
            derivative: [0.0; N],
            margins: [f64::INFINITY; 4],
            turns: [0.0; 2],
        };
        let motion = Motion::empty(course.times.len(), course.pose)?;
        let mut runner = Self {
            course,
            limits: *limits,
            before: nowhere,
            here: nowhere,
            evaluations: 0,
            landed: None,
            motion,
        };
        runner.here = Self::place(limits, 0.0, nowhere.at, nowhere.turns);
        runner.before = runner.here;
        Ok(runner)
    }

    /// The point with these numbers. An angle that leaves [-pi, pi] moves its whole turns to `turns`.
    #[inline(always)]
    fn place(limits: &Limits, t: f64, mut at: Compensated<N>, mut turns: [f64; 2]) -> Stage<N> {
        for i in 4..N.min(6) {
            if at.y[i].abs() > PI {
                let angle = Angle { turns: 0.0, rest: at.y[i] }.settled();
                at.y[i] = angle.rest;
                turns[i - 4] += angle.turns;
            }
        }
        let angle = at.y[0].sin_cos();
        let derivative = derivative::<N, ROUND>(limits, &at.y, angle);
        let now = state(&at.y);
        let [lift, slip] = limits.grip(&now, &state(&derivative), angle);
        let margins = [now.theta.min(PI - now.theta) - FLAT, limits.side(&now), lift, slip];
        Stage { t, at, derivative, margins, turns }
    }

    /// The change of the numbers over a step `h`; infinite if theta leaves (0, pi) at a stage of the step.
    #[inline(always)]
    fn change(limits: &Limits, from: &Stage<N>, h: f64) -> [f64; N] {
        let mut inside = true;
        let mut f = |y: &[f64; N]| {
            inside &= y[0] > 0.0 && y[0] < PI;
            derivative::<N, ROUND>(limits, y, y[0].sin_cos())
        };
        let change = increment(&mut f, &from.at.y, &from.derivative, h);
        if inside { change } else { [f64::INFINITY; N] }
    }

    fn run(
        mut self,
        stepping: Stepping,
        beyond: bool,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Motion>, Error> {
        let (t0, times, span) = (self.course.t0, self.course.times, self.course.span);
        let way = if span < 0.0 { -1.0 } else { 1.0 };
        // With a local copy the compiler computes terms that depend on the body alone only once.
        let limits = self.limits;
        let mut beat = Beat::new();
        let mut h = match stepping {
            Stepping::Fixed(h) => h.abs(),
            Stepping::Within(tol) => (0.1 * tol.powf(0.2)).min(span.abs()).max(1e-12),
        };
        if let Some(ending) = self.limits.at_start(self.course.start, way) {
            self.motion.event = Some(Event { ending, time: 0.0, state: *self.course.start });
        }
        let mut written = times.partition_point(|t| *t == t0);
        for _ in 0..written {
            self.write(&self.here.clone());
        }
        let mut steps = 0u64;
        while self.end(beyond).is_none() && written < times.len() {
            steps += 1;
            if steps.is_multiple_of(512) && beat.is_due() && !go_on() {
                return Ok(None);
            }
            let ahead = match stepping {
                Stepping::Fixed(step) => self.plain(&limits, steps as f64 * step, step)?,
                Stepping::Within(tol) => self.careful(tol, way, &mut h)?,
            };
            let pole = self.pole(&ahead, way);
            let ahead = pole.map_or(ahead, |(edge, _)| edge);
            self.watch(&ahead);
            let limit =
                self.end(beyond).unwrap_or(f64::INFINITY).min(ahead.t.abs() * (1.0 + 4.0 * f64::EPSILON));
            while let Some(t) = times.get(written).map(|t| t - t0).filter(|t| t.abs() <= limit) {
                let place = if (t - ahead.t).abs() <= 8.0 * f64::EPSILON * t.abs() {
                    ahead
                } else {
                    self.between(&self.here, t)
                };
                self.write(&place);
                written += 1;
            }
            core::mem::swap(&mut self.before, &mut self.here);
            self.here = ahead;
            if let Some((_, past)) = pole {
                (self.before, self.here) = (past, past);
            }
        }
        // An event at a minimum of a margin can lie one step back.
        let limit = self.end(beyond).unwrap_or(f64::INFINITY);
        self.motion.times = copied(&times[..written])?;
        self.motion.keep(t0, limit);
        self.motion.event = self.motion.event.filter(|e| e.time.abs() <= span.abs());
        if let Some(event) = &mut self.motion.event {
            event.time += t0;
        }
        self.motion.method = match stepping {
            Stepping::Fixed(h) => Method::Step(h.abs()),
            Stepping::Within(tol) => Method::Tolerance(tol),
        };
        self.motion.evaluations = self.evaluations;
        Ok(Some(self.motion))
    }

    /// The points at which a ball reaches and leaves the edge of its pole on the way to `ahead`. Between them the axis
    /// passes through the vertical, so that phi and psi each change by half a turn.
    fn pole(&self, ahead: &Stage<N>, way: f64) -> Option<(Stage<N>, Stage<N>)> {
        if !self.limits.body.is_ball() || ahead.margins[0] >= 0.0 {
            return None;
        }
        let margin = |t: f64| self.between(&self.here, t).margins[0];
        let t = search::crossing(margin, self.here.t, ahead.t, self.here.margins[0], ahead.margins[0]);
        let mut edge = self.between(&self.here, t);
        edge.margins[0] = 0.0;
        let mut y = edge.at.y;
        let (low, off) = (y[0] < 1.0, y[0].min(PI - y[0]));
        y[2] = -y[2];
        if N == 8 {
            let (sin, cos) = y[4].sin_cos();
            // Across the pole the ball rolls on in one direction.
            let path = if self.limits.contact == Contact::Rolling { 2.0 * off } else { 0.0 };
            let path = if low { path } else { -path };
            (y[6], y[7]) = (y[6] + path * cos, y[7] + path * sin);
            y[4] += way * PI;
            y[5] += if low { -way * PI } else { way * PI };
        }
        let t = edge.t + way * 2.0 * off / y[2].abs();
        let mut past = Self::place(&self.limits, t, Compensated::new(y), edge.turns);
        past.margins[0] = past.margins[0].max(0.0);
        Some((edge, past))
    }

    /// The time from the start to the event that ends the motion, if an event does.
    fn end(&self, beyond: bool) -> Option<f64> {
        let event = if beyond { self.landed } else { self.motion.event };
        event.map(|e| e.time.abs())
    }

    /// One fixed step, to the time `t`.
    #[inline(always)]
    fn plain(&mut self, limits: &Limits, t: f64, step: f64) -> Result<Stage<N>, Error> {
        let here = &self.here;
        if self.course.unguarded && step.abs() * state(&here.at.y).precession().abs() > 1.0 {
            let advice = 0.3 / state(&here.at.y).precession().abs();
            let (time, theta) = (self.course.t0 + here.t, here.at.y[0]);
            return Err(Error::Step { step: step.abs(), time, theta, advice });
        }
        let change = Self::change(limits, here, t - here.t);
        self.evaluations += 4;
        if change[0].is_finite() {
            return Ok(Self::place(limits, t, here.at.plus(&change), here.turns));
        }
        let (time, theta) = (self.course.t0 + here.t, here.at.y[0]);
        // The rim comes down within this step: the face lands, or the step passed over a near-flat turn.
        let (way, mut h) = (step.signum(), step.abs());
        while self.here.margins[0] >= 0.0 {
            let next = self.careful(1e-13, way, &mut h)?;
            if next.t.abs() > t.abs() {
                return Err(Error::Step { step: step.abs(), time, theta, advice: 0.1 * step.abs() });
            }
            if next.margins[0] < 0.0 {
                return Ok(next);
            }
            (self.before, self.here) = (self.here, next);
        }
        Ok(self.here)
    }

    /// A step whose error, found from two halves and a whole, is below `tol`; `h` becomes the next step to try.
    fn careful(&mut self, tol: f64, way: f64, h: &mut f64) -> Result<Stage<N>, Error> {
        let (here, limits) = (self.here, self.limits);
        for _ in 0..200 {
            let step = way * *h;
            let whole = Self::change(&limits, &here, step);
            let first = Self::change(&limits, &here, 0.5 * step);
            self.evaluations += 11;
            if whole[0].is_finite() && first[0].is_finite() {
                let half = Self::place(&limits, here.t + 0.5 * step, here.at.plus(&first), here.turns);
                let second = Self::change(&limits, &half, 0.5 * step);
                let halves: [f64; N] = core::array::from_fn(|i| first[i] + second[i]);
                let error: [f64; N] = core::array::from_fn(|i| (halves[i] - whole[i]) / 15.0);
                let y = here.at.y;
                let least = (y[0] + halves[0]).sin().min(y[0].sin());
                let size = error.iter().enumerate().fold(0f64, |largest, (i, e)| {
                    let scale = if i == 0 { least } else { 1.0 + if i < 4 { y[i].abs() } else { 0.0 } };
                    largest.max(e.abs() / scale)
                });
                let ratio = size / tol;
                if ratio <= 1.0 {
                    *h *= (0.9 * ratio.powf(-0.2)).clamp(0.3, 3.0);
                    let change = core::array::from_fn(|i| halves[i] + error[i]);
                    return Ok(Self::place(&limits, here.t + step, here.at.plus(&change), here.turns));
                }
                *h *= if ratio.is_finite() { (0.9 * ratio.powf(-0.2)).clamp(0.1, 0.9) } else { 0.25 };
            } else {
                *h *= 0.5;
            }
            if here.t + way * *h == here.t {
                break;
            }
        }
        Err(Error::Lost { theta: here.at.y[0] })
    }

    /// The point at time `t`, reached from an earlier point by one shortened step, or by a few near the table.
    fn between(&self, from: &Stage<N>, t: f64) -> Stage<N> {
        let mut place = *from;
        let mut h = t - place.t;
        for _ in 0..80 {
            let change = Self::change(&self.limits, &place, h);
            if change[0].is_finite() {
                place = Self::place(&self.limits, place.t + h, place.at.plus(&change), place.turns);
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

    /// Looks for an event if a margin turns negative on the way to `ahead`, or may have done so near the last point.
    #[inline(always)]
    fn watch(&mut self, ahead: &Stage<N>) {
        let (before, here) = (&self.before, &self.here);
        let suspicious = |i: usize| {
            let (m0, m1, m2) = (before.margins[i], here.margins[i], ahead.margins[i]);
            // A parabola estimates how low a margin goes around its minimum; four times that depth is a safe bound.
            m2 < 0.0
                || m2.is_nan()
                || (m1 <= m0 && m1 <= m2 && {
                    let bend = m0 - 2.0 * m1 + m2;
                    bend > 0.0 && 2.0 * m1 * bend < (m2 - m0) * (m2 - m0)
                })
        };
        // Beyond the first event only a landing of the face is watched.
        let watched = if self.motion.event.is_none() { 4 } else { 1 };
        if (0..watched).any(suspicious) {
            self.look(ahead, watched);
        }
    }

    #[cold]
    fn look(&mut self, ahead: &Stage<N>, watched: usize) {
        let (before, here) = (self.before, self.here);
        let mut first: Option<(usize, Stage<N>)> = None;
        for i in 0..watched {
            let at = |t: f64| self.between(if t.abs() < here.t.abs() { &before } else { &here }, t);
            let margin = |t: f64| at(t).margins[i];
            let (m0, m1, m2) = (before.margins[i], here.margins[i], ahead.margins[i]);
            let time = if m2 < 0.0 && m1 >= 0.0 {
                Some(search::crossing(margin, here.t, ahead.t, m1, m2))
            } else if m1 <= m0 && m1 <= m2 && m0 >= 0.0 {
                let (t, least) = search::least(margin, before.t, ahead.t);
                (least < 0.0).then(|| search::crossing(margin, before.t, t, m0, least))
            } else {
                None
            };
            if let Some(t) = time
                && first.as_ref().is_none_or(|(_, place)| t.abs() < place.t.abs())
            {
                first = Some((i, at(t)));
            }
        }
        if let Some((i, place)) = first {
            let endings = [Ending::Face, Ending::Side, Ending::LiftOff, Ending::Slip];
            let (mut state, mut time) = (state(&place.at.y), place.t);
            match endings[i] {
                Ending::Face => {
                    let rest = self.course.span.signum() * FLAT / state.w2.abs();
                    time += rest;
                    let w2 = state.w2 + rest * place.derivative[2];
                    state = State { theta: if state.theta < 1.0 { 0.0 } else { PI }, w2, ..state };
                }
                Ending::Side => state.theta = self.limits.body.theta_end(),
                _ => {}
            }
            let event = Event { ending: endings[i], time, state };
            self.motion.event = self.motion.event.or(Some(event));
            if event.ending == Ending::Face {
                self.landed = Some(event);
            }
        }
    }

    /// Adds a point to the outputs of the motion.
    fn write(&mut self, place: &Stage<N>) {
        let y = &place.at.y;
        let now = state(y);
        self.motion.states.push(now);
        if let Some(poses) = &mut self.motion.poses
            && N == 8
        {
            let angle = |i: usize| Angle { turns: place.turns[i], rest: y[4 + i] }.settled();
            let (phi, psi) = (angle(0), angle(1));
            let contact = match self.limits.contact {
                Contact::Rolling => Point2::new(y[6], y[7]),
                Contact::Smooth => Pose::below_centre(&self.limits.body, self.course.start, &now, phi.rest),
            };
            poses.push(Pose { phi, psi, contact_point: contact });
        }
    }
}
