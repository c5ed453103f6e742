//! The rolling phases of a body: by the first integrals, or integrated where energy is lost.

mod loses;
pub(crate) mod lossy;

use super::body_walk::BodyWalk;
use super::own::Own;
use crate::error::Error;
use crate::laws::contact::slip::Friction;
use crate::laws::contact::{Contact, Table, force};
use crate::laws::loss::GRACE;
use crate::laws::pose::{Angle, Pose};
use crate::laws::state::State;
use crate::methods::flow::Flow;
use crate::motions::Kind;
use crate::motions::ask::row::OutputRow;
use crate::motions::exact::method::by_first_integrals;
use crate::motions::walk::errors::doubted;
use crate::motions::walk::numbers::{BodyNumbers, HEAT, PHI, TIME, W2, lost, poses};
use crate::motions::walk::{Next, Phases, WalkStep, after_rest};
use crate::motions::{Ask, Ending, Motion, Start};
use crate::numbers::larger_or_nan;
use core::f64::consts::{PI, TAU};
use nalgebra::Point2;

/// The first integrals lose their digits where the axis is nearer to the vertical than this angle, in radians. Below
/// it a face counts as landed, and the motion of a ball is integrated.
const LEAST_ANGLE_FROM_VERTICAL: f64 = 1e-8;

/// A phase of rolling is brief if it ends with a slip within this angle, in radians, of rotation or nutation. The
/// phase after a brief one is integrated, with a tolerance of at least `BRIEF_ROLLING_TOLERANCE`, which takes less
/// work than the first integrals; after `BRIEF_ROLLING_STEPS` steps these continue it, since it may last for ever.
const BRIEF_ROLLING_ANGLE: f64 = 20.0;
const BRIEF_ROLLING_TOLERANCE: f64 = 3e-10;
pub(crate) const BRIEF_ROLLING_STEPS: u64 = 64;

/// A hop counts as low, and is integrated, if both its height and its speed are below this.
const LOW_HOP: f64 = 0.1;
/// A body within this angle of an inclination, other than pi/2, at which two rims touch counts as at it.
const ON_BORDER: f64 = 1e-15;
const SLOW_RISE: f64 = 1e-4;

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// Computes a rolling phase by the first integrals to its end, or begins its integration if the body loses
    /// energy.
    pub(super) fn rolls_on(
        &mut self,
        at_limit: bool,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<WalkStep<N>>, Error> {
        let Friction::Coulomb { fixed, .. } = self.friction() else { return Ok(None) };
        let times = &self.since[self.made.motion.states.len()..];
        if times.is_empty() || self.hops_shortly() {
            return Ok(None);
        }
        if !poses(N) && (self.of.uniform || self.of.slide.no_longer_drills(&self.at)) {
            self.rolls_uniformly();
            return Ok(None);
        }
        let mu = if at_limit { fixed * (1.0 + GRACE) } else { fixed };
        let (body, y) = (self.of.body, self.of.state);
        let upright = y.theta.min(PI - y.theta) < LEAST_ANGLE_FROM_VERTICAL;
        // A ball may pass nearer to its pole than the first integrals can follow.
        self.of.by_steps = self.of.rolls_briefly
            && self.of.slide.tol > BRIEF_ROLLING_TOLERANCE
            && !upright
            && !self.of.planar;
        // A body that rises from its face is followed by steps at first.
        self.of.by_steps |= upright && y.theta.cos() * y.w2 < 0.0 && !body.is_ball();
        if self.of.integrates || self.hops_low() || upright && body.is_ball() || self.of.by_steps {
            return Ok(self.begins_to_lose(mu)?.map(WalkStep::Flows));
        }
        if upright {
            // A face this close to the table lands before any other event.
            self.next = Some(Next::Ends(Ending::Face));
            return Ok(None);
        }
        #[cfg(feature = "many")]
        if self.of.rolls_among && !self.of.body.has_row() {
            return Ok(Some(WalkStep::Rolls(mu)));
        }
        self.roll_by_first_integrals(mu, go_on)?;
        Ok(None)
    }

    /// The state from which a phase of rolling begins.
    #[cfg(feature = "many")]
    pub fn rolling_state(&self) -> State {
        self.of.state
    }

    /// The same computation, but if `others` the caller computes the phases of rolling that the first integrals
    /// solve.
    #[cfg(feature = "many")]
    pub fn leaving_rolling_to_caller(mut self, others: bool) -> Self {
        self.of.rolls_among = others;
        self
    }

    /// Computes a phase of rolling with the coefficient `mu` of static friction by the first integrals.
    pub(crate) fn roll_by_first_integrals(
        &mut self,
        mu: f64,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), Error> {
        let (from, ask) = self.rolling(mu);
        let times = &self.since[self.made.motion.states.len()..];
        let rolled = by_first_integrals(&self.of.body, &from, times, &ask, &mut *go_on)?;
        self.continue_after_rolling(rolled, mu, go_on)
    }

    /// The start of a phase of rolling with the coefficient `mu` of static friction, and its options.
    fn rolling(&self, mu: f64) -> (Start, Ask) {
        let beyond = self.ask.beyond && !self.ask.table.rubs();
        let ask = Ask { pose: self.ask.pose, beyond, ..Ask::on(Table::Rolling { mu }) };
        (Start { time: self.at[TIME], ..self.of.state.into() }, ask)
    }

    /// Continues after a phase of rolling, whose states at the next times, and whose event if any, have been
    /// computed.
    pub(crate) fn continue_after_rolling(
        &mut self,
        mut rolled: Motion,
        mu: f64,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), Error> {
        let (body, rubs) = (self.of.body, self.ask.table.rubs());
        self.claims(rolled.error);
        self.made.motion.pose_error = larger_or_nan(self.made.motion.pose_error, rolled.pose_error);
        let spent = [self.at[HEAT], lost(&self.at)];
        if self.of.planar {
            rolled.states.iter_mut().chain(rolled.event.iter_mut().map(|e| &mut e.state)).for_each(|y| {
                (y.w1, y.w3) = (0.0, 0.0);
            });
        }
        for (i, y) in rolled.states.iter().enumerate() {
            let pose = rolled.poses.as_ref().map(|poses| self.moved(&poses[i]));
            let at = |y: &State| force(Contact::Rolling, &body, y);
            let force = self.ask.force.then(|| doubted(y, [rolled.error; 2], at));
            let row = OutputRow::on_table(*y, [0.0; 2], spent, Kind::Rolling);
            self.made.push(OutputRow { pose, force, ..row });
        }
        let Some(event) = rolled.event else { return Ok(()) };
        self.made.motion.limit = rolled.limit;
        // The pose at the event is computed separately, since `rolled` has poses at the requested times only.
        if self.ask.pose && (event.ending == Ending::Slip || event.ending == Ending::Side) {
            let (from, ask) = self.rolling(mu);
            let ask = Ask { beyond: true, ..ask };
            let then = by_first_integrals(&body, &from, &[event.time], &ask, go_on)?;
            if let Some(pose) = then.poses.and_then(|poses| poses.last().copied()) {
                let pose = self.moved(&pose);
                let numbers =
                    [pose.phi.radians(), pose.psi.radians(), pose.contact_point.x, pose.contact_point.y];
                self.at[PHI..PHI + 4].copy_from_slice(&numbers);
            }
        }
        let began = self.made.path.phases.last().map_or(f64::NEG_INFINITY, |phase| phase.time - self.t0);
        let (s, c) = event.state.theta.sin_cos();
        let State { w1, w2, w3, .. } = event.state;
        self.at[..8].copy_from_slice(&[s, c, w1, w2, w3, 0.0, 0.0, event.time]);
        self.of.state = event.state;
        self.of.rolls_briefly =
            3.0 * (event.time - began) < BRIEF_ROLLING_ANGLE * self.of.slide.calm(&self.at);
        let next = match event.ending {
            Ending::Slip if rubs => after_rest(Phases::lets_go(self)),
            ending => Next::Ends(ending),
        };
        self.continues_with(next);
        Ok(())
    }

    /// Whether the body returns to its other rim so soon, or leaves it so slowly, that the first integrals would lose
    /// the digits of the height, since theta has a rounding error of 1e-16.
    fn hops_low(&self) -> bool {
        let (c, rises) = (self.tilt(self.at.angle()), self.at[W2]);
        if self.ask.restitution.is_none() || c > LOW_HOP || rises > LOW_HOP || !self.has_two_rims() {
            return false;
        }
        let falls = -Contact::Rolling.derivative(&self.of.body, &self.of.state).w2;
        if self.of.body.has_row() && c.abs() < ON_BORDER && rises.abs() < SLOW_RISE {
            return true;
        }
        if rises > 0.0 { rises * rises < LOW_HOP * falls } else { rises * rises + falls * c > 0.0 }
    }

    /// Converts a pose relative to the beginning of a rolling phase to one relative to the beginning of the motion.
    fn moved(&self, pose: &Pose) -> Pose {
        let [phi, psi, x, y] = core::array::from_fn(|i| self.at[9 + i]);
        let turned = |by: f64, angle: Angle| {
            let turns = (by / TAU).round();
            let rest = Angle { turns, rest: by - turns * TAU };
            Angle { turns: angle.turns + turns, rest: angle.rest + rest.rest }.settled()
        };
        let (sin, cos) = phi.sin_cos();
        let at = pose.contact_point;
        Pose {
            phi: turned(phi, pose.phi),
            psi: turned(psi, pose.psi),
            height: 0.0,
            contact_point: Point2::new(x + at.x * cos - at.y * sin, y + at.x * sin + at.y * cos),
        }
    }
}
