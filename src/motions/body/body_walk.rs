//! The walk of a body of revolution: its equations, the data of the current phase, and its first numbers.
//!
//! ```text
//! body, laws of the user, slip      what does not change but for what friction and losses hold
//! lossy, lying                      the current phase, if it is one of these
//! ```
//! [`phases`](super::phases) begins and ends the phases. A rougher run is perturbed by a share of the state (`perturbs_by`), so
//! that its difference from the finer run shows how errors grow.

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

/// The walk of a body of revolution.
pub(crate) type BodyWalk<'a, const N: usize, G = ()> = Walk<'a, BodyPhases<G>, N>;

/// The data of a body's walk: its equations, and the current phase.
pub(crate) struct BodyPhases<G: Own = ()> {
    pub body: Body,
    /// The laws of the user.
    pub own: G,
    pub slide: Slide<G>,
    /// The state where the current phase begins or has ended, and the initial state.
    pub state: State,
    pub start: Start,
    /// Whether a phase without a slip is integrated; otherwise the first integrals solve it, as long as no energy is
    /// lost.
    pub(super) integrates: bool,
    /// Whether the last phase of rolling by the first integrals was brief, and whether the current one, without losses, is
    /// integrated.
    pub(crate) rolls_briefly: bool,
    pub(crate) by_steps: bool,
    /// Whether the body is a uniform ball, whose phases are known; and their errors.
    pub(super) uniform: bool,
    pub(super) roundings: Roundings,
    /// Whether the caller computes the phases of rolling that the first integrals solve, among those of other walks.
    #[cfg(feature = "many")]
    pub(crate) rolls_among: bool,
    /// The tangent of the slope: the horizontal pull on the centre per weight.
    pub(super) tilt: f64,
    /// The rate at which the table turns.
    pub(super) turning: f64,
    /// The current phase, if it loses energy without a slip.
    pub(super) lossy: Option<LossyPhase<G>>,
    /// The numbers after the last landings of a rocking at a border that is no right angle.
    pub(super) rocked: Vec<Vec<f64>>,
    /// The current phase, if the body lies on both rims.
    pub(crate) lying: Option<Box<LyingPhase<G>>>,
    /// The current phase, if the body is on its face.
    pub(crate) standing: Option<Box<StandingFlow>>,
    /// The friction of the face on which it has stood last, and the number lam on which it depends.
    pub(super) face: Cell<Option<(f64, FaceFriction)>>,
    /// Whether only theta changes, so that rounding must not make the body turn.
    pub(super) planar: bool,
    /// The steps at the ends of the last slip and of the last phase that loses energy without one, in their variables.
    pub(super) lately: [f64; 2],
    /// Estimates of the end of a slipping whirr; None if the losses do not let a whirr last for infinitely many turns.
    pub(super) tail: Option<LastTurns>,
    /// The slips in its nods; None if a loss stops the contact along the rim.
    pub(super) nods: Option<Box<Nods>>,
}

/// A phase that loses energy without a slip.
#[derive(Clone, Copy)]
pub(super) struct LossyPhase<G = ()> {
    pub(super) flow: LossyFlow<G>,
}

impl<'a, const N: usize> BodyWalk<'a, N> {
    /// A walk from its initial state, with steps of the tolerance `tol`, which is the requested tolerance or a larger
    /// one.
    pub fn of_body(body: &Body, ask: &Ask, tol: f64, times: &'a [f64], start: &Start) -> Result<Self, Error> {
        let fine = check_walk(body, start, ask)?;
        let (ask, start) = without_friction(body, ask, start);
        Self::of_laws(body, &ask, (tol, fine), times, &start, ())
    }
}

impl<'a, G: Own, const N: usize> BodyWalk<'a, N, G> {
    /// A walk under these laws, with steps of the tolerance `tol`, where `fine` is the requested one.
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
    /// The flow of the current phase, if the body loses energy without a slip.
    pub fn lossy(&self) -> Option<&LossyFlow<G>> {
        self.of.lossy.as_ref().map(|phase| &phase.flow)
    }

    pub fn contact(&self) -> Contact {
        self.ask.table.contact()
    }

    /// All numbers of a flow of which a lane has not computed the energies. What is missing since `from` has become heat,
    /// or is lost to the losses.
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

    /// The losses, the couple of the user beside them, and the pull of a slope and of a drive; None if there is none of these.
    pub(super) fn couples(&self) -> Option<Couples<f64, G>> {
        self.couples_of(&self.ask.losses)
    }

    /// The same with other losses.
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

    /// Moves the walk to the numbers at which a flow has halted.
    pub(super) fn arrives(&mut self, at: [f64; N]) {
        self.at = at;
        if leans_over(&mut self.at) {
            self.of.slide.leans_over();
        }
        self.of.state = state(&self.at);
    }
}

/// The first numbers of a motion from this start.
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
    /// Whether a loss or a couple of the user takes energy.
    pub(super) fn loses(&self, ask: &Ask) -> bool {
        !ask.losses.is_none() || self.own.has_couple()
    }

    /// The data of a walk under these laws, with steps of the tolerance `tol`.
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

    /// Changes to the view from another circle of the body.
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
