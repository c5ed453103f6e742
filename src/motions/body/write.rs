//! Computes the outputs of a body's motion: states, poses and forces from its state vector.

use super::own::Own;
use super::roll::lossy::LossyFlow;
use super::slide::Slide;
use crate::laws::body::Body;
use crate::laws::contact::Table;
use crate::laws::pose::{Angle, Pose};
use crate::laws::state::State;
use crate::motions::ask::row::OutputRow;
use crate::motions::walk::errors::doubted;
use crate::motions::walk::numbers::{COS, HEAT, PHI, PSI, SIN, TIME, U2, UH, W1, W2, W3, X, Y, lost, poses};
use crate::motions::walk::two_runs::Followed;
use crate::motions::{Ask, Kind, Start};
use crate::numbers::larger_or_nan;
use core::f64::consts::{PI, TAU};
use nalgebra::Point2;

/// The state from a state vector. A ball whose axis has passed the vertical (sin(theta) < 0) leans to the other side.
pub(crate) fn state<const N: usize>(y: &[f64; N]) -> State {
    let side = if y[SIN] < 0.0 { -1.0 } else { 1.0 };
    State { theta: (side * y[SIN]).atan2(y[COS]), w1: side * y[W1], w2: side * y[W2], w3: y[W3] }
}

/// The pose from a state vector.
pub(crate) fn pose<const N: usize>(y: &[f64; N]) -> Pose {
    let turn = if y[SIN] < 0.0 { PI } else { 0.0 };
    posed([y[PHI] + turn, y[PSI] - turn, y[X], y[Y]], 0.0)
}

/// The pose with the angles phi and psi, the contact point at (x, y), and the lowest point of the body at this
/// height.
pub(super) fn posed([phi, psi, x, y]: [f64; 4], height: f64) -> Pose {
    let angle = |angle: f64| {
        let turns = (angle / TAU).round();
        Angle { turns, rest: angle - turns * TAU }.settled()
    };
    Pose { phi: angle(phi), psi: angle(psi), contact_point: Point2::new(x, y), height }
}

/// The errors of theta and of w after steps of the tolerance `tol`: relative to theta, and relative to the largest
/// speed.
pub(crate) fn state_errors(y: &State, tol: f64) -> [f64; 2] {
    let fastest = y.w1.abs().max(y.w2.abs()).max(y.w3.abs()).max(1.0);
    [tol * y.theta.min(1.0), tol * fastest]
}

impl Followed {
    /// Adds the state vector `y` of a slip to the outputs.
    pub(super) fn slid<L: Own, const N: usize>(&mut self, ask: &Ask, slide: &Slide<L>, y: &[f64; N]) {
        let now = state(y);
        let side = if y[SIN] < 0.0 { -1.0 } else { 1.0 };
        let slip = [side * y[UH], side * y[U2]];
        let pose = poses(N).then(|| pose(y));
        // Where a dry slip just begins, with u = 0, friction acts against the direction in which it begins.
        let towards = if slip == [0.0, 0.0] && slide.law.dry { self.path.way } else { slip };
        let force = ask.force.then(|| {
            slide.asks_drive(y);
            let (force, doubt) =
                doubted(&now, state_errors(&now, slide.tol), |y| slide.force(y, slip, towards));
            // Without a series friction turns with a slip whose direction is as uncertain as the slip is slow.
            let speed = slip[0].hypot(slip[1]);
            let turns = if L::IS && speed > 0.0 { slide.tol * <Slide>::fastest(y) / speed } else { 0.0 };
            let doubt = doubt + turns.min(1.0) * force.along.hypot(force.across);
            // No table pulls: such a force is an error.
            (force, larger_or_nan(doubt, -force.normal))
        });
        self.push(OutputRow {
            pose,
            force,
            ..OutputRow::on_table(now, slip, [y[HEAT], lost(y)], Kind::Slipping)
        });
    }

    /// Adds the state vector `y` of a phase that loses energy without a slip to the outputs.
    pub(super) fn lossy<G: Own, const N: usize>(
        &mut self,
        ask: &Ask,
        (body, from, flow): (&Body, &Start, &LossyFlow<G>),
        y: &[f64; N],
        kind: Kind,
    ) {
        let (now, time) = (state(y), y[TIME]);
        let pose = poses(N).then(|| {
            let pose = pose(y);
            match ask.table {
                Table::Smooth => {
                    let (phi, [x, y]) = (pose.phi.rest - from.heading, from.place);
                    let under = Pose::contact_point_below_centre(body, &from.state, &now, phi);
                    let (sin, cos) = from.heading.sin_cos();
                    let fallen = 0.5 * ask.slope.tan() * time * time;
                    let (x, y) = (x + under.x * cos - under.y * sin, y + under.x * sin + under.y * cos);
                    Pose { contact_point: Point2::new(x + fallen, y), ..pose }
                }
                _ => pose,
            }
        });
        let force = ask.force.then(|| {
            let flow = flow.here(y);
            doubted(&now, state_errors(&now, flow.tol), |y| flow.force(y))
        });
        self.push(OutputRow { pose, force, ..OutputRow::on_table(now, [0.0; 2], [y[HEAT], lost(y)], kind) });
    }
}
