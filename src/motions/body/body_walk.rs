//! The computation of a motion of a body of revolution: its equations, the data of the current phase, and its first
//! state vector.
//!
//! ```text
//! body, laws of the user, slip      what does not change but for what friction and losses hold
//! lossy, lying                      the current phase, if it is one of these
//! ```
//! [`phases`](super::phases) begins and ends the phases. A motion is computed twice; the run with the larger
//! tolerance is perturbed by a share of the state (`perturbs_by`), so that the difference of the two runs shows how
//! errors grow.

use super::lie::flow::LyingPhase;
use super::own::Own;
use super::roll::lossy::LossyFlow;
use super::slide::Slide;
use super::spun::{Roundings, knows};
use super::stand::flow::StandingFlow;
use super::tail::{LastTurns, Nods};
use super::write::state;
use super::{check_walk, on_face, without_friction};
use crate::error::{Error, room};
use crate::laws::body::Body;
use crate::laws::contact::face::FaceFriction;
use crate::laws::contact::{Contact, Table};
use crate::laws::loss::{Couples, Losses};
use crate::laws::state::{State, rolling_of};
use crate::methods::flow::Flow;
use crate::motions::walk::numbers::{COS, HEAT, PHI, SIN, TIME, U2, W3, X, Y, leans_over, loses, poses};
use crate::motions::walk::{Phases, Walk};
use crate::motions::{Ask, Start};
use core::cell::Cell;
use core::f64::consts::PI;

/// The computation, phase by phase, of a motion of a body of revolution.
pub(crate) type BodyWalk<'a, const N: usize, G = ()> = Walk<'a, BodyPhases<G>, N>;

/// The equations of a body's motion, and the data of the current phase.
pub(crate) struct BodyPhases<G: Own = ()> {
    pub body: Body,
    /// The user-defined laws.
    pub own: G,
    pub slide: Slide<G>,
    /// The state at which the current phase begins or has ended; `start` is the initial state of the motion.
    pub state: State,
    pub start: Start,
    /// Whether a phase without a slip is integrated; otherwise the first integrals solve it, as long as no energy is
    /// lost.
    pub(super) integrates: bool,
    /// Whether the last phase of rolling by the first integrals was brief. `by_steps` is whether the current phase of
    /// rolling without losses is integrated instead.
    pub(crate) rolls_briefly: bool,
    pub(crate) by_steps: bool,
    /// Whether the body is a uniform ball, whose phases have closed forms; `roundings` has their errors.
    pub(super) uniform: bool,
    pub(super) roundings: Roundings,
    /// Whether the caller computes the phases of rolling that the first integrals solve, together with those of other
    /// motions.
    #[cfg(feature = "many")]
    pub(crate) rolls_among: bool,
    /// The tangent of the slope: the component of gravity along the table over the component normal to it.
    pub(super) tilt: f64,
    /// The angular velocity of the turntable, in sqrt(g/R); 0 if the table does not turn.
    pub(super) turning: f64,
    /// The current phase, if it loses energy without a slip.
    pub(super) lossy: Option<LossyPhase<G>>,
    /// The state vectors after the last landings of a body that rocks about an inclination, other than pi/2, at which
    /// two rims touch.
    pub(super) rocked: Vec<Vec<f64>>,
    /// The current phase, if the body lies on both rims.
    pub(crate) lying: Option<Box<LyingPhase<G>>>,
    /// The current phase, if the body is on its face.
    pub(crate) standing: Option<Box<StandingFlow>>,
    /// The friction of the face on which the body has stood last, after the number lam = mu z/a on which it depends
    /// (z: height of the centre, a: radius of the face).
    pub(super) face: Cell<Option<(f64, FaceFriction)>>,
    /// Whether the body moves in a vertical plane and only theta changes, so that rounding must not make it turn.
    pub(super) planar: bool,
    /// The last integration step of the last slip, and of the last phase with losses without a slip, in their
    /// variables of integration.
    pub(super) lately: [f64; 2],
    /// Estimates of the end of a whirr with slip; None if the losses do not let a whirr last for infinitely many
    /// turns.
    pub(super) tail: Option<LastTurns>,
    /// The slips in the nods of a whirr; None if a loss stops the contact point along the rim.
    pub(super) nods: Option<Box<Nods>>,
}

/// A phase in which a body loses energy without a slip.
#[derive(Clone, Copy)]
pub(super) struct LossyPhase<G = ()> {
    pub(super) flow: LossyFlow<G>,
}

impl<'a, const N: usize> BodyWalk<'a, N> {
    /// The computation of a motion at its initial state, with steps of the tolerance `tol`, which is the requested
    /// tolerance or a larger one.
    pub fn of_body(body: &Body, ask: &Ask, tol: f64, times: &'a [f64], start: &Start) -> Result<Self, Error> {
        let fine = check_walk(body, start, ask)?;
        let (ask, start) = without_friction(body, ask, start);
        Self::of_laws(body, &ask, (tol, fine), times, &start, ())
    }
}

impl<'a, G: Own, const N: usize> BodyWalk<'a, N, G> {
    /// The computation of a motion under user-defined laws, with steps of the tolerance `tol`; `fine` is the
    /// requested tolerance.
    pub fn of_laws(
        body: &Body,
        ask: &Ask,
        (tol, fine): (f64, f64),
        times: &'a [f64],
        start: &Start,
        own: G,
    ) -> Result<Self, Error> {
        let &Start { time, aloft, .. } = start;
        let at = numbers_at(start);
        let mut of = BodyPhases::of(body, ask, tol, start, own);
        of.uniform = !G::IS && !poses(N) && knows(body, ask);
        let mut walk = Self::new(of, at, ask, fine, (time, times))?;
        walk.made.path.view = body.view();
        if poses(N) && walk.made.path.view.over {
            // The heading is that from the lower end, from which a pose is told.
            walk.at[PHI] += PI;
        }
        if body.has_row() {
            walk.made.path.rims = room(times.len())?;
        }
        walk.next = Some(match aloft {
            Some(aloft) => walk.starts_in_air(aloft.into()),
            None if on_face(&walk.of.body, &start.state) => walk.starts_on_face()?,
            None => walk.first_phase()?,
        });
        if start.state.theta < body.theta_end() {
            Phases::perturbs(&mut walk);
        }
        Ok(walk)
    }
}

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// The equations of the current phase if the body loses energy without a slip.
    pub fn lossy(&self) -> Option<&LossyFlow<G>> {
        self.of.lossy.as_ref().map(|phase| &phase.flow)
    }

    pub fn contact(&self) -> Contact {
        self.ask.table.contact()
    }

    /// Completes a state vector that SIMD code has computed without energies: the mechanical energy that is missing
    /// since `from` has become heat of friction, or is taken by the losses.
    pub fn followed(&self, from: &[f64; N], mut y: [f64; N]) -> [f64; N] {
        match self.lossy() {
            Some(flow) if loses(N) => {
                let (rolls, slide) = (self.contact() == Contact::Rolling, &self.of.slide);
                let energy = |y: &[f64; N]| {
                    let level = self.contact().energy(&self.of.body, &state(&flow.shown(y)));
                    if rolls { level + slide.energy_on_table(y) } else { level }
                };
                y[N - 1] += energy(from) - energy(&y);
            }
            Some(_) => {}
            None => y[HEAT] += self.of.slide.energy(from) - self.of.slide.energy(&y),
        }
        y
    }

    /// The couples on a body that does not slip: losses, a user-defined couple, and the forces of a slope and of a
    /// drive; None if there are none.
    pub(super) fn couples(&self) -> Option<Couples<f64, G>> {
        self.couples_of(&self.ask.losses)
    }

    /// The couples on a body that does not slip, as [`couples`](Self::couples), with these losses instead of those of
    /// the options.
    pub(super) fn couples_of(&self, losses: &Losses) -> Option<Couples<f64, G>> {
        self.of.slide.asks_drive(&self.at);
        let lost = Couples::with_own(losses, self.of.own);
        if self.ask.is_level() && !self.of.own.drives() {
            return lost;
        }
        let all = lost.unwrap_or(Couples::of(&Losses::NONE, |x| x).beside(self.of.own));
        let om = self.of.turning;
        Some(all.pulled(self.of.slide.pull(&self.at)).over(om, om != 0.0))
    }

    /// Sets the current state to the state vector at which an integration has halted.
    pub(super) fn arrives(&mut self, at: [f64; N]) {
        self.at = at;
        if leans_over(&mut self.at) {
            self.of.slide.leans_over();
        }
        self.of.state = state(&self.at);
    }
}

/// The state vector of this start.
pub(crate) fn numbers_at<const N: usize>(start: &Start) -> [f64; N] {
    let (State { theta, w1, w2, w3 }, [along, across]) = (start.state, start.slip.pair());
    let ((s, c), mut at) = (theta.sin_cos(), [0.0; N]);
    at[..TIME].copy_from_slice(&[s, c, w1, w2, w3, along, across]);
    if poses(N) {
        at[PHI] = start.heading;
        at[X..=Y].copy_from_slice(&start.place);
    }
    at
}

impl<G: Own> BodyPhases<G> {
    /// Whether a loss law or a user-defined couple takes energy.
    pub(super) fn loses(&self, ask: &Ask) -> bool {
        !ask.losses.is_none() || self.own.has_couple()
    }

    /// The data of a motion under the user-defined laws `own`, with steps of the tolerance `tol`.
    pub(crate) fn of(body: &Body, ask: &Ask, tol: f64, start: &Start, own: G) -> Self {
        let &Start { state, slip, .. } = start;
        let friction = ask.table.friction();
        let slide = Slide::new(body, &friction, &ask.losses_in_slip(), tol, own);
        let slide = slide.on_table([ask.slope.tan(), ask.turning]);
        let loses = !ask.losses.is_none() || friction.patch() > 0.0 || own.has_couple();
        let known_ends = !G::IS && !body.is_ball() && ask.is_level();
        Self {
            body: *body,
            own,
            slide,
            state,
            start: *start,
            integrates: ask.table == Table::Smooth || loses || !ask.is_level(),
            rolls_briefly: false,
            by_steps: false,
            uniform: false,
            roundings: Roundings::default(),
            #[cfg(feature = "many")]
            rolls_among: false,
            tilt: ask.slope.tan(),
            turning: ask.turning,
            lossy: None,
            rocked: Vec::new(),
            lying: None,
            standing: None,
            face: Cell::default(),
            planar: state.w1 == 0.0
                && state.w3 == 0.0
                && slip.u_2 == 0.0
                && !own.has_couple()
                && (ask.slope == 0.0 || start.heading == PI * (start.heading / PI).round())
                && ask.turning == 0.0,
            lately: [0.0; 2],
            tail: (known_ends && ask.losses_in_slip().turn_endlessly()).then(LastTurns::default),
            nods: (known_ends && !ask.losses.stop_the_contour()).then(Box::default),
        }
    }

    /// Changes the circle of contact, from which the state is counted, to that of `body`.
    pub(super) fn stands_on(&mut self, body: Body, ask: &Ask) {
        if body != self.body {
            if body.has_row() {
                // The turns of a face before do not tell how another one falls.
                self.tail = self.tail.map(|_| LastTurns::default());
                self.nods = self.nods.take().map(|_| Box::default());
            }
            let slide =
                Slide::new(&body, &ask.table.friction(), &ask.losses_in_slip(), self.slide.tol, self.own);
            self.slide = slide.on_table([self.tilt, self.turning]);
            self.body = body;
        }
    }
}
