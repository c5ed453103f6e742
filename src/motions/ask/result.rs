//! The result of a motion: times and states, the event that ended it, its phases, and the path of the
//! contact point.

use super::{AboveTable, Method, Start};
use crate::error::{Error, room};
use crate::laws::body::View;
use crate::laws::contact::Force;
pub use crate::laws::contact::impact::Hit;
use crate::laws::pose::Angle;
use crate::laws::state::{Slip, State};
use crate::methods::flow::Exhausted;
use crate::motions::Moving;
use crate::numbers::codes::coded;
use nalgebra::Point2;

coded! {
    /// The way in which a motion ended. Its number is the `status` of a result.
    pub enum Ending {
        /// The motion reached the last requested time.
        Done = 0,
        /// The face landed on the table (theta = 0 or pi) in a motion without a restitution or with user-defined
        /// laws, or while it moved on a table that only allows rolling. The body may still spin on its face, with the
        /// last w3; that spin is not computed.
        Face = 1,
        /// The other rim landed: the body lies on its side (theta = pi/2, ell > 0).
        Side = 2,
        /// The normal force vanished.
        LiftOff = 3,
        /// Rolling needed more friction than mu N.
        Slip = 4,
        /// The body, state or contact is invalid, or the step is too long. Only one of many motions in a call has
        /// this status, with NaN in its results; a single motion returns an error.
        Invalid = 5,
        /// No contact force, or more than one, obeys the law of friction (the paradox of Painleve).
        Painleve = 6,
        /// The body is at rest, and dry friction holds it.
        Stops = 7,
        /// The computation stopped at this time, for the reason [`Motion::limit`].
        Bounded = 8,
        /// A landing on both rims, or of a face, has no outcome, or more than one, under the law of friction.
        Landing = 9,
    }
}

coded! {
    /// The reason for which the computation of a motion stopped early.
    pub enum Limit {
        /// The number of evaluations has reached the largest allowed
        /// ([`Ask::max_evaluations`](crate::motions::Ask::max_evaluations)).
        Evaluations = 1,
        /// The time has hardly advanced in 600,000 steps, or in as many steps as evaluations are allowed if these are
        /// more.
        Crawling = 2,
        /// Too many changes: between phases such as slipping and rolling, or of rotations that dry friction stops and
        /// lets go. The limit is 20 changes per unit of time, but at least 5,000 and at most 10,000.
        Changes = 3,
        /// Changes of either kind follow each other without an advance of time.
        Chatter = 4,
        /// There are more than 30,000 impacts, or impacts follow each other without end.
        Impacts = 5,
        /// Rounding errors outweigh the terms of the equations.
        Rounding = 6,
        /// The caller has interrupted the computation.
        Interrupted = 7,
        /// A user-defined law acts in a time far shorter than the motion, so that no step may be longer.
        Stiff = 8,
    }
}

impl Limit {
    /// The reason for which the computation stopped, as a clause.
    pub fn reason(self) -> &'static str {
        match self {
            Self::Evaluations => "the number of evaluations is the largest allowed",
            Self::Crawling => "time hardly advances: forces change ever faster",
            Self::Changes => "slipping, rolling and sticking alternate too often",
            Self::Chatter => "slipping, rolling and sticking alternate without an advance of time",
            Self::Impacts => "there are too many impacts",
            Self::Rounding => "rounding errors outweigh the motion",
            Self::Interrupted => "the computation was interrupted",
            Self::Stiff => "the law is stiff: it acts in a time far shorter than the motion",
        }
    }
}

impl From<Exhausted> for Limit {
    fn from(why: Exhausted) -> Self {
        match why {
            Exhausted::Evaluations => Self::Evaluations,
            Exhausted::Crawling => Self::Crawling,
            Exhausted::Rounding => Self::Rounding,
            Exhausted::Interrupted => Self::Interrupted,
        }
    }
}

/// An event at which the model ceases to describe the motion, such as a landing or a slip.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Event<S = State> {
    /// The kind of the event, such as `Side` or `LiftOff`.
    pub ending: Ending,
    /// The time of the event.
    pub time: f64,
    /// The state at the event.
    pub state: S,
    /// The rim to which the state refers, as in [`Path::rims`].
    pub rim: u8,
}

impl<S> Event<S> {
    /// Whether the event ends the motion. A motion that continues `beyond` events ends only where the face lands.
    pub(crate) fn ends(&self, beyond: bool) -> bool {
        !beyond || self.ending == Ending::Face
    }
}

/// Times and states of a body, and the event that ended its motion.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields),
    serde(bound(
        serialize = "S: serde::Serialize, S::Pose: serde::Serialize, S::Force: serde::Serialize",
        deserialize = "S: serde::Deserialize<'de>, S::Pose: serde::Deserialize<'de>, S::Force: serde::Deserialize<'de>"
    ))
)]
#[non_exhaustive]
pub struct Motion<S: Moving = State> {
    /// The requested times, up to the event.
    pub times: Vec<f64>,
    /// The state at each time.
    pub states: Vec<S>,
    /// The pose at each time, if poses were requested.
    pub poses: Option<Vec<S::Pose>>,
    /// The contact force at each time, if forces were requested.
    pub forces: Option<Vec<S::Force>>,
    /// The event that ended the motion, or with `beyond` the first event past which it continues; None if there is
    /// none up to the last time.
    pub event: Option<Event<S>>,
    /// The method that computed the motion: `Exact`, `Step` or `Tolerance`.
    pub method: Method,
    /// Estimated error: the largest over all components of all states, and over the time and the state of the event.
    #[cfg_attr(feature = "serde", serde(with = "crate::numbers::file"))]
    pub error: f64,
    /// Estimated error of the poses: the largest over all of their components; NaN without poses.
    #[cfg_attr(feature = "serde", serde(with = "crate::numbers::file"))]
    pub pose_error: f64,
    /// Estimated error of the contact forces, in weights: the largest over all of their components; NaN without
    /// forces.
    #[cfg_attr(feature = "serde", serde(with = "crate::numbers::file"))]
    pub force_error: f64,
    /// Predicted share of the amplitude of the nutation that a fixed step takes away; 0 with the other methods.
    pub step_loss: f64,
    /// A fixed step that takes away less than a thousandth of the amplitude of the nutation; infinite with the other
    /// methods.
    #[cfg_attr(feature = "serde", serde(with = "crate::numbers::file"))]
    pub advice: f64,
    /// Whether the fixed step is too long for a reliable result: for the amplitude of the nutation, its frequency, or
    /// the precession.
    pub coarse: bool,
    /// Number of evaluations of the equations of motion.
    pub evaluations: u64,
    /// The reason for which the computation stopped early, if it did; the motion then ends with [`Ending::Bounded`].
    /// If it was interrupted only while the error was estimated, the motion has its true ending, the limit
    /// `Interrupted`, and an infinite error.
    #[cfg_attr(feature = "serde", serde(default))]
    pub limit: Option<Limit>,
    /// Slip, phases and lost energy of a motion with a law of friction, with a restitution or with losses.
    pub path: Option<Box<Path<S>>>,
    /// Whether the table is smooth, so that the centre of mass moves only vertically.
    pub(crate) smooth: bool,
    /// The number of the circle on which a body of several circles moves, in a motion without a path.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(crate) circle: Option<u8>,
}

impl<S: Moving> Motion<S> {
    /// An empty motion with space for `count` outputs.
    pub(crate) fn empty(count: usize, pose: bool) -> Result<Self, Error> {
        Ok(Self {
            times: Vec::new(),
            states: room(count)?,
            poses: pose.then(|| room(count)).transpose()?,
            forces: None,
            event: None,
            method: Method::Exact,
            error: 0.0,
            pose_error: if pose { 0.0 } else { f64::NAN },
            force_error: f64::NAN,
            step_loss: 0.0,
            advice: f64::INFINITY,
            coarse: false,
            evaluations: 0,
            limit: None,
            path: None,
            smooth: false,
            circle: None,
        })
    }

    /// Removes the outputs at times farther than `limit` from the initial time.
    pub(crate) fn keep(&mut self, t0: f64, limit: f64) {
        let kept = self.times.partition_point(|t| (t - t0).abs() <= limit);
        self.times.truncate(kept);
        self.states.truncate(kept);
        if let Some(poses) = &mut self.poses {
            poses.truncate(kept);
        }
    }

    /// Ends the motion at the limit `Interrupted`, after the outputs that are written; without outputs it ends at
    /// `t0` in the state `start`.
    pub(crate) fn interrupted(mut self, times: &[f64], t0: f64, start: S) -> Self {
        self.times = times[..self.states.len()].to_vec();
        let (time, state) = (self.times.last().copied().unwrap_or(t0), self.states.last().copied());
        self.event = Some(Event { ending: Ending::Bounded, time, state: state.unwrap_or(start), rim: 0 });
        self.limit = Some(Limit::Interrupted);
        self
    }

    /// Ends the motion at the limit `Interrupted`, after its first `count` outputs.
    pub(crate) fn cut(mut self, count: usize) -> Self {
        let at =
            self.times.get(count.saturating_sub(1)).copied().zip(self.states.get(count.saturating_sub(1)));
        self.event = at.map(|(time, &state)| Event { ending: Ending::Bounded, time, state, rim: 0 });
        self.limit = Some(Limit::Interrupted);
        self.times.truncate(count);
        self.states.truncate(count);
        self.poses.iter_mut().for_each(|poses| poses.truncate(count));
        self
    }

    /// Whether the computation was interrupted.
    pub fn is_interrupted(&self) -> bool {
        self.limit == Some(Limit::Interrupted)
    }

    /// Makes the estimated errors infinite, since the second run that would show them is missing.
    pub(crate) fn make_error_infinite(&mut self) {
        self.error = f64::INFINITY;
        for (error, some) in
            [(&mut self.pose_error, self.poses.is_some()), (&mut self.force_error, self.forces.is_some())]
        {
            *error = if some { f64::INFINITY } else { *error };
        }
    }

    /// Converts a motion whose states are counted from either end of the body to states counted from the lower end.
    pub(crate) fn told(mut self, view: &View) -> Self {
        self.circle = view.circles.map(|[here, _]| here);
        let rim = self.circle.unwrap_or_default();
        self.event.iter_mut().for_each(|event| event.rim = rim);
        if view.over {
            let states = self.states.iter_mut();
            states
                .chain(self.event.iter_mut().map(|event| &mut event.state))
                .for_each(|y| *y = y.told(view.tells(y.theta())));
            self.poses.iter_mut().flatten().for_each(|pose| *pose = S::pose_told_from_start(pose));
            self.forces.iter_mut().flatten().for_each(|force| *force = S::force_told(force));
        }
        self
    }

    /// Whether the states of a body of several circles are counted from its lower end, whichever circle carries it.
    pub(crate) fn is_told(&self) -> bool {
        self.circle.is_some() || self.path.as_ref().is_some_and(|path| path.view.circles.is_some())
    }

    /// Returns the motion, or None if it was interrupted before it advanced from the initial time `t0`.
    pub(crate) fn advanced(self, t0: f64) -> Option<Self> {
        let stays = self.is_interrupted() && self.event.is_some_and(|event| event.time == t0);
        (!stays).then_some(self)
    }

    /// The ending of the motion; `Done` without an event.
    pub fn ending(&self) -> Ending {
        self.event.map_or(Ending::Done, |e| e.ending)
    }
}

impl Motion {
    /// Moves a motion on a level table to the place and the direction of this start.
    pub(crate) fn placed(mut self, start: &Start) -> Self {
        let ((sin, cos), [x, y]) = (start.heading.sin_cos(), start.place);
        if start.heading != 0.0 || start.place != [0.0; 2] {
            for pose in self.poses.iter_mut().flatten() {
                let at = pose.contact_point;
                pose.phi = Angle { rest: pose.phi.rest + start.heading, ..pose.phi }.settled();
                pose.contact_point = Point2::new(x + at.x * cos - at.y * sin, y + at.x * sin + at.y * cos);
            }
        }
        self
    }
}

coded! {
    /// The kind of a phase of a motion.
    pub enum Kind {
        /// The body rolls: its contact point is at rest.
        Rolling = 0,
        /// The body slips: its contact point has a velocity over the table.
        Slipping = 1,
        /// The body is in the air.
        Flying = 2,
        /// The body lies on both rims, and both slip.
        Lying = 3,
        /// The body lies on both rims, and one of them sticks.
        Pivoting = 4,
        /// The body lies on both rims and rolls straight on.
        RollingOnItsSide = 5,
        /// The body lies on two circles of unequal radii and rolls round the point where its axis meets the table.
        RollingRoundItsApex = 6,
        /// The body stands, slides or spins on its face.
        OnItsFace = 7,
    }
}

/// A part of a motion of one kind, such as rolling or slipping.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Phase<S = State> {
    /// The time at which the phase begins.
    pub time: f64,
    /// The kind of the phase.
    pub kind: Kind,
    /// The state at the beginning of the phase.
    pub state: S,
    /// The slip at the beginning of the phase.
    pub slip: Slip,
    /// The height of the lowest point of the rim and its vertical velocity, which are 0 on the table.
    pub aloft: AboveTable,
    /// The rim to which the state refers, as in [`Path::rims`].
    pub rim: u8,
}

/// Which rim lands in an impact: the first one or another. In files it is true if this is not the first rim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(from = "bool", into = "bool")
)]
#[non_exhaustive]
pub enum Lands {
    /// The rim to which the initial state refers; for a body of several circles, the lowest circle; for a stone, its
    /// surface.
    First,
    /// Another rim or circle.
    Other,
}

impl From<bool> for Lands {
    fn from(other: bool) -> Self {
        if other { Self::Other } else { Self::First }
    }
}

impl From<Lands> for bool {
    fn from(lands: Lands) -> Self {
        lands == Lands::Other
    }
}

/// Whether a body leaves the table after an impact or stays on it. In files it is true if the body stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(from = "bool", into = "bool")
)]
#[non_exhaustive]
pub enum AfterImpact {
    /// The contact point leaves the table again, or another point takes its place.
    Leaves,
    /// The body stays on the table: the impact is the last of a sequence of bounces.
    Stays,
}

impl From<bool> for AfterImpact {
    fn from(stays: bool) -> Self {
        if stays { Self::Stays } else { Self::Leaves }
    }
}

impl From<AfterImpact> for bool {
    fn from(after: AfterImpact) -> Self {
        after == AfterImpact::Stays
    }
}

/// An impact of a rim or of a stone on the table. The components of a stone are along x and y of the laboratory, and
/// upwards; those of its velocities as in [`EllipsoidState`](crate::stone::roll).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Strike<S = State> {
    /// The time of the impact.
    pub time: f64,
    /// Whether the first rim lands, or another one.
    #[cfg_attr(feature = "serde", serde(rename = "other"))]
    pub lands: Lands,
    /// The rim that lands, as in [`Path::rims`].
    pub rim: u8,
    /// The motion of the contact point in the impact, such as sticking or slipping.
    pub hit: Hit,
    /// The state before and after the impact; both refer to the rim that lands.
    pub states: [S; 2],
    /// The velocity of the lowest point of the rim that lands, before and after the impact: along e_h, along e2, and
    /// upwards, in sqrt(g R).
    pub velocities: [[f64; 3]; 2],
    /// The impulses along e_h, along e2, and upwards, in M sqrt(g R), summed over both rims if both receive an
    /// impulse.
    pub impulse: [f64; 3],
    /// The impulse of the couple of a patch of contact about the vertical, in M R sqrt(g R); 0 for a point.
    #[cfg_attr(feature = "serde", serde(default))]
    pub couple: f64,
    /// The energy lost in the impact, in M g R; if the body stays, also the work of friction in the last bounces,
    /// which are summed.
    pub lost: f64,
    /// Whether the body leaves the table or stays on it after the impact.
    #[cfg_attr(feature = "serde", serde(rename = "stays"))]
    pub after: AfterImpact,
}

/// Slip and force of the other rim of a body that lies on both. In files it is the array of their five components.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(from = "[f64; 5]", into = "[f64; 5]")
)]
#[non_exhaustive]
pub struct OtherRim {
    /// The slip of the other rim, in sqrt(g R).
    pub slip: Slip,
    /// The force of the table on the other rim, in M g.
    pub force: Force,
}

impl OtherRim {
    /// The value for a body that does not lie on two rims: NaN.
    pub(crate) const NONE: Self = Self::of(
        Slip::new(f64::NAN, f64::NAN),
        Force { normal: f64::NAN, along: f64::NAN, across: f64::NAN },
    );

    /// The other rim with this slip and this force.
    pub(crate) const fn of(slip: Slip, force: Force) -> Self {
        Self { slip, force }
    }
}

impl From<[f64; 5]> for OtherRim {
    /// Converts the array of the slip along e_h and e2, and of the components of the force: normal, along and across.
    fn from([u, v, normal, along, across]: [f64; 5]) -> Self {
        Self::of(Slip::new(u, v), Force { normal, along, across })
    }
}

impl From<OtherRim> for [f64; 5] {
    fn from(OtherRim { slip: Slip { u_h, u_2 }, force }: OtherRim) -> Self {
        [u_h, u_2, force.normal, force.along, force.across]
    }
}

/// The slip, the phases and the losses of a motion. The estimated error of the motion also covers the slips, and the
/// times and states of the phases and of the end; the error of the heat is that error times the largest speed.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Path<S = State> {
    /// The slip at each time.
    pub slip: Vec<Slip>,
    /// The heat of friction up to each time, in M g R, without the friction of impacts.
    pub dissipated: Vec<f64>,
    /// The energy that the loss laws have taken up to each time, in M g R; empty without losses.
    pub work_lost: Vec<f64>,
    /// The kind of phase at each time, such as rolling or slipping.
    pub kinds: Vec<Kind>,
    /// The phases, from the initial one on.
    pub phases: Vec<Phase<S>>,
    /// The total heat of friction up to the last time or the end, in M g R.
    pub heat: f64,
    /// The total energy that the loss laws have taken, in M g R.
    pub lost: f64,
    /// The total time of slipping, in sqrt(R/g).
    pub slipping: f64,
    /// The height of the lowest point of the rim and its vertical velocity at each time; empty if the motion ends where
    /// the body leaves the table.
    pub aloft: Vec<AboveTable>,
    /// The impacts on the table, in the order of time; empty without a restitution.
    pub impacts: Vec<Strike<S>>,
    /// Slip and force of the other rim at each time, NaN unless the body lies on both; empty if the motion ends where the
    /// body comes to lie on its side.
    #[cfg_attr(feature = "serde", serde(with = "crate::numbers::file::rows"))]
    pub other_rim: Vec<OtherRim>,
    /// The rim to which state, slip, pose and force at each time refer: 0 is the rim to which the initial state
    /// refers, and 1 the other rim. Empty in a motion without a restitution, which stays on rim 0. For a body of
    /// several circles, the number of the circle on which it stands, from the lower end up; its states always refer
    /// to its lower end.
    pub rims: Vec<u8>,
    /// The slip at the event that ended the motion.
    pub last_slip: Slip,
    /// For a stone, the time up to which the estimated error is at most 1 % of the largest speed (at most 0.01 for
    /// slow motions); infinite if this is so up to the end.
    #[cfg_attr(feature = "serde", serde(with = "crate::numbers::file"))]
    pub known_until: f64,
    /// Whether the outputs include the lost energy; `goes_on` is whether the motion continues in the air and on both
    /// rims.
    pub(crate) loses: bool,
    pub(crate) goes_on: bool,
    /// The end of the body and the circle from which the current state is counted.
    pub(crate) view: View,
    /// Whether the computation stopped where the body began to roll.
    pub(crate) rolls_on: bool,
    /// Whether the last turns of a whirr were left out, because its end is known without them.
    pub(crate) leaves_turns: bool,
    /// The sum of the estimated errors of all steps.
    pub(crate) erred: f64,
    /// The direction in which the current slip began from rest.
    pub(crate) way: [f64; 2],
}

impl<S> Path<S> {
    /// The rim to which the outputs of a body refer; `lies` if the body lies on two rims.
    pub(crate) fn rim(&self, lies: bool) -> u8 {
        match self.view.circles {
            Some([here, next]) => {
                if lies {
                    here.min(next)
                } else {
                    here
                }
            }
            None => u8::from(self.view.over && !lies),
        }
    }

    /// Whether the current state is counted from the upper end of a body whose outputs are counted from the lower
    /// end.
    pub(crate) fn is_told_over(&self, lies: bool) -> bool {
        self.view.over && !lies && self.view.circles.is_some()
    }

    /// An empty path with space for `count` outputs; `loses` if they include the lost energy, and `goes_on` if they
    /// include heights and a second rim.
    pub(crate) fn empty(count: usize, loses: bool, goes_on: bool) -> Result<Self, Error> {
        let (losing, going) = (if loses { count } else { 0 }, if goes_on { count } else { 0 });
        Ok(Self {
            slip: room(count)?,
            dissipated: room(count)?,
            work_lost: room(losing)?,
            kinds: room(count)?,
            phases: Vec::new(),
            heat: 0.0,
            lost: 0.0,
            slipping: 0.0,
            aloft: room(going)?,
            impacts: Vec::new(),
            other_rim: room(going)?,
            rims: room(going)?,
            loses,
            goes_on,
            last_slip: Slip::default(),
            known_until: f64::INFINITY,
            view: View::default(),
            rolls_on: false,
            leaves_turns: false,
            erred: 0.0,
            way: [0.0; 2],
        })
    }
}
