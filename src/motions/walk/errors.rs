//! Estimates the error of an integrated motion, from the exact motion where there is one, else from another run.

use crate::error::{Error, room};
use crate::laws::body::Body;
use crate::laws::contact::{Contact, Force, force};
use crate::laws::pose::{Angle, Pose};
use crate::laws::state::State;
use crate::motions::exact::Swing;
use crate::motions::{Event, Motion, Moving};
use crate::numbers::larger_or_nan;
use core::f64::consts::TAU;

pub(crate) fn pose_distance(a: &Pose, b: &Pose) -> f64 {
    let angle = |a: Angle, b: Angle| ((a.turns - b.turns) * TAU + (a.rest - b.rest)).abs();
    let moved = [(a.contact_point - b.contact_point).norm(), (a.height - b.height).abs()];
    moved.into_iter().fold(larger_or_nan(angle(a.phi, b.phi), angle(a.psi, b.psi)), larger_or_nan)
}

/// The largest difference between two poses of a body with two equal rims, where `a` is given from the rim that did
/// not touch the table at the start. The contact points may differ in the direction of the lean, where the two rims
/// are a body's length apart.
pub(crate) fn pose_distance_over(a: &Pose, b: &Pose) -> f64 {
    let by = |a: Angle, turns: f64, rest: f64| ((a.turns - turns) * TAU + (a.rest - rest)).abs();
    let turned =
        larger_or_nan(by(a.phi, b.phi.turns + 0.5, b.phi.rest), by(a.psi, -b.psi.turns, -b.psi.rest));
    let ((sin, cos), moved) = (b.phi.radians().sin_cos(), a.contact_point - b.contact_point);
    larger_or_nan(turned, (moved.y * cos - moved.x * sin).abs())
}

/// Relative error of a component of a state from a few roundings.
const ROUNDING_ERROR: f64 = 4.0 * f64::EPSILON;

/// The contact force `at` a state whose theta and w have the given errors, and the largest error of a component of
/// that force, from the given errors and from a few roundings.
pub(crate) fn doubted(y: &State, [theta, w]: [f64; 2], at: impl Fn(&State) -> Force) -> (Force, f64) {
    let numbers = |y: &[f64; 4]| {
        let force = at(&State::from(*y));
        [force.normal, force.along, force.across]
    };
    let ([normal, along, across], off) = doubted_of(&(*y).into(), [theta, w, w, w], numbers);
    (Force { normal, along, across }, off)
}

/// The three components of a force, computed by `at` from the components `of` a state with the errors `known`, and
/// the largest error of a component.
pub(crate) fn doubted_of<const K: usize>(
    of: &[f64; K],
    known: [f64; K],
    at: impl Fn(&[f64; K]) -> [f64; 3],
) -> ([f64; 3], f64) {
    let here = at(of);
    let mut off = here.map(|x| ROUNDING_ERROR * (1.0 + x.abs()));
    for (i, known) in known.into_iter().enumerate() {
        let mut other = *of;
        other[i] += known + ROUNDING_ERROR * of[i].abs();
        for (off, (a, b)) in off.iter_mut().zip(here.into_iter().zip(at(&other))) {
            *off += (a - b).abs();
        }
    }
    // An error that cannot be computed counts as infinite.
    let largest = off.into_iter().fold(0.0, larger_or_nan);
    (here, if largest.is_nan() { f64::INFINITY } else { largest })
}

/// The largest difference between the components of two forces.
pub(crate) fn force_distance(a: &Force, b: &Force) -> f64 {
    let [normal, along, across] = [a.normal - b.normal, a.along - b.along, a.across - b.across];
    [normal, along, across].into_iter().fold(0.0, |most, x| larger_or_nan(most, x.abs()))
}

/// Sets the error of an integrated motion by comparison with the exact motion at some of its times, or at all of them
/// if they are fewer than 256.
pub(crate) fn judge(motion: &mut Motion, swing: &Swing, exact: Option<Event>, t0: f64) {
    let count = motion.times.len();
    let every = (count / 128).max(1);
    for i in (0..count).filter(|i| i % every == 0 || i + 1 == count) {
        let t = motion.times[i] - t0;
        if swing.landing(t).is_some_and(|(limit, _)| t.abs() >= limit) {
            continue;
        }
        let off = motion.states[i].distance(&swing.state(t)) + swing.error(t);
        motion.error = larger_or_nan(motion.error, off);
        if let Some(poses) = &motion.poses
            && let Some(pose) = swing.pose(t)
        {
            let off = pose_distance(&poses[i], &pose) + swing.pose_error(t);
            motion.pose_error = larger_or_nan(motion.pose_error, off);
        }
    }
    if let Some(event) = motion.event {
        let t = event.time - t0;
        let off = match exact.filter(|e| e.ending == event.ending) {
            Some(exact) => larger_or_nan(event.state.distance(&exact.state), (event.time - exact.time).abs()),
            None => event.state.distance(&swing.state(t)),
        };
        motion.error = larger_or_nan(motion.error, off + swing.error(t));
    }
    if every > 1 {
        // Errors at the other times may be larger.
        motion.error *= 2.0;
        motion.pose_error *= 2.0;
    }
}

/// Sets the error of an integrated motion to its difference from another run with the same end, or to infinity if the
/// ends differ.
pub(crate) fn compare(motion: &mut Motion, other: &Motion) {
    for (i, (a, b)) in motion.states.iter().zip(&other.states).enumerate() {
        motion.error = larger_or_nan(motion.error, a.distance(b));
        if let (Some(poses), Some(others)) = (&motion.poses, &other.poses) {
            motion.pose_error = larger_or_nan(motion.pose_error, pose_distance(&poses[i], &others[i]));
        }
    }
    match (motion.event, other.event) {
        (None, None) => {}
        (Some(a), Some(b)) if a.ending == b.ending => {
            motion.error = larger_or_nan(
                motion.error,
                larger_or_nan(a.state.distance(&b.state), (a.time - b.time).abs()),
            );
        }
        _ => motion.error = f64::INFINITY,
    }
}

/// Whether two solutions end with the same event at times that differ by at most 1 % of 1 + the time.
pub(crate) fn same_end(a: &Event, b: &Event) -> bool {
    a.ending == b.ending && (a.time - b.time).abs() <= 1e-2 * (1.0 + b.time.abs())
}

/// Adds the contact force at each state to the motion, or cuts the motion off after the last force if `go_on`
/// interrupts.
pub(crate) fn with_contact_forces(
    mut motion: Motion,
    contact: Contact,
    body: &Body,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Motion, Error> {
    let (mut forces, mut doubt) = (room(motion.states.len())?, 0.0);
    for some in motion.states.chunks(1024) {
        if !go_on() {
            motion = motion.cut(forces.len());
            break;
        }
        for y in some {
            let (force, off) = doubted(y, [motion.error; 2], |y| force(contact, body, y));
            forces.push(force);
            doubt = larger_or_nan(doubt, off);
        }
    }
    (motion.forces, motion.force_error) = (Some(forces), doubt);
    Ok(motion)
}
