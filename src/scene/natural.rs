//! The body, start and options from which the known answer of a scene is computed, and the answer itself, in natural units.
//!
//! ```text
//! v = u + w x (centre - contact point)        of a stone; u is the slip and the lift of the lowest point
//! v_x = sin(slope) t                          of a centre that falls along a smooth slope
//! ```
//! Error: that of the motion, and a few roundings.

use super::SceneError;
use crate::laws::body::Body;
use crate::laws::contact::Table;
use crate::laws::state::{Slip, State};
use crate::laws::stone::{Ellipsoid, StoneState};
use crate::motions::ask::sample::Sample;
use crate::motions::slope::{energy_beside, energy_of_fall};
use crate::motions::{AboveTable, Ask, Bounds, Ending, Kind, Motion, Moving, Start, motion, stone};
use crate::numbers::larger_or_nan;
use nalgebra::{Matrix3, Point3, Quaternion, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

const UNTOLD: SceneError = SceneError::Motion("motion: its poses or forces are unknown at one of its times");

/// The rounding error of a height, in ulp of the numbers from which it is computed.
const HEIGHT_ROUNDINGS: f64 = 16.0;

/// The body or stone of a scene with its start and options, all in natural units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum Natural {
    /// A body of revolution with its start and options.
    #[non_exhaustive]
    Body {
        /// The body, in natural units.
        body: Body,
        /// The initial state, at time 0.
        start: Start,
        /// The options of the motion of the body.
        ask: Ask,
    },
    /// A stone with its start and options.
    #[non_exhaustive]
    Stone {
        /// The stone, in natural units.
        stone: Ellipsoid,
        /// The initial state, at time 0.
        start: Start<StoneState>,
        /// The options of the motion of the stone.
        ask: Ask,
    },
}

/// A known motion at one time.
pub(super) struct Known {
    pub time: f64,
    pub position: Point3<f64>,
    pub orientation: UnitQuaternion<f64>,
    pub velocity: Vector3<f64>,
    pub w: Vector3<f64>,
    pub energy: f64,
    /// The largest ratio of friction to normal force so far.
    pub needed: f64,
    /// The normal force of all points of contact together.
    pub normal: f64,
    /// The contact force; NaN on both rims.
    pub force: Vector3<f64>,
    /// The contact point; NaN where there is none or more than one.
    pub point: Vector3<f64>,
    /// The height of the lowest point of the body.
    pub height: f64,
}

/// An impact: its time, its kind in words, its normal impulse, and the energy that it takes.
pub(super) struct KnownImpact {
    pub time: f64,
    pub kind: String,
    pub impulse: f64,
    pub lost: f64,
}

/// A known motion: its rows, impacts, phases and errors, in natural units.
pub(super) struct KnownMotion {
    pub rows: Vec<Known>,
    pub bounds: Bounds,
    pub error: f64,
    pub pose_error: f64,
    pub force_error: f64,
    pub ending: Ending,
    /// The time of the event that ended the motion; None without such an event.
    pub end: Option<f64>,
    pub phases: Vec<(f64, Kind)>,
    pub impacts: Vec<KnownImpact>,
    pub heat: Option<Vec<f64>>,
    pub lost: Option<Vec<f64>>,
}

impl Natural {
    /// A body of revolution with its initial state at time 0 and its options.
    pub(super) fn of_body(body: Body, start: Start, ask: Ask) -> Self {
        Self::Body { body, start: start.with_time(0.0), ask: ask.with_pose().with_force() }
    }

    /// A stone with its initial state at time 0 and its options.
    pub(super) fn of_stone(stone: Ellipsoid, start: Start<StoneState>, ask: Ask) -> Self {
        Self::Stone { stone, start: start.with_time(0.0), ask: ask.with_pose().with_force() }
    }

    /// The options of the motion.
    pub fn ask(&self) -> &Ask {
        match self {
            Self::Body { ask, .. } | Self::Stone { ask, .. } => ask,
        }
    }

    /// The tensor of inertia about the centre of mass along the axes of the body.
    pub(super) fn inertia(&self) -> Matrix3<f64> {
        match self {
            Self::Body { body, .. } => Matrix3::from_diagonal(&Vector3::new(body.i1(), body.i1(), body.i3())),
            Self::Stone { stone, .. } => Matrix3::from(stone.inertia()),
        }
    }

    /// Computes the motion at these times, of which the first is 0.
    pub(super) fn answer(&self, times: &[f64]) -> Result<KnownMotion, SceneError> {
        if self.ask().turning != 0.0 {
            return Err(SceneError::Motion("turning: expected 0, a table that does not turn"));
        }
        match self {
            Self::Body { body, start, ask } => {
                let ask = ask.with_pose().with_force();
                let m = motion::roll_with(body, *start, times, &ask, || true)?;
                let m =
                    m.ok_or(SceneError::Motion("motion: expected a motion that advances from its start"))?;
                let rows: Option<_> = (0..m.states.len()).map(|i| body_at(&m, body, &ask, i)).collect();
                let bounds = m.bounds(body);
                told(m, rows.ok_or(UNTOLD)?, bounds, &ask)
            }
            Self::Stone { stone: of, start, ask } => {
                let ask = ask.with_pose().with_force();
                let m = stone::roll(of, *start, times, &ask, || true)?;
                let m =
                    m.ok_or(SceneError::Motion("motion: expected a motion that advances from its start"))?;
                let rows: Option<Vec<Known>> =
                    (0..m.states.len()).map(|i| stone_at(&m, of, &ask, i)).collect();
                let rows = rows.ok_or(UNTOLD)?;
                let most = |of: &dyn Fn(&Known) -> f64| rows.iter().map(of).fold(0.0, larger_or_nan);
                let most = [
                    most(&|now| now.w.norm()),
                    most(&|now| now.velocity.norm()),
                    most(&|now| now.force.norm()),
                ];
                let [x, y, z] = of.offset();
                let size = [1.0 + Vector3::new(x, y, z).norm(), of.moments()[2]];
                let bounds = Bounds::of([m.error, m.pose_error, m.force_error], size, most);
                if m.path.as_ref().is_some_and(|path| path.known_until.is_finite()) {
                    return Err(SceneError::Motion(
                        "motion: expected a motion that is known up to its last time; give earlier times",
                    ));
                }
                told(m, rows, bounds, &ask)
            }
        }
    }
}

/// The answer of a scene from a computed motion, with one row for each time.
fn told<S: Moving>(
    m: Motion<S>,
    rows: Vec<Known>,
    bounds: Bounds,
    ask: &Ask,
) -> Result<KnownMotion, SceneError> {
    if m.event.is_some() && ask.beyond {
        return Err(SceneError::Motion("beyond: expected a motion that ends at its event"));
    }
    if !m.error.is_finite() {
        return Err(SceneError::Motion(
            "motion: expected a motion whose error can be estimated; this error is not finite",
        ));
    }
    let path = m.path.as_deref();
    let first = if ask.table == Table::Smooth { Kind::Slipping } else { Kind::Rolling };
    let phases = path.map_or_else(
        || vec![(0.0, first)],
        |path| path.phases.iter().map(|phase| (phase.time, phase.kind)).collect(),
    );
    let impacts = path.into_iter().flat_map(|path| &path.impacts).map(|hit| KnownImpact {
        time: hit.time,
        kind: hit.hit.to_string(),
        impulse: hit.impulse[2],
        lost: hit.lost,
    });
    Ok(KnownMotion {
        bounds,
        error: m.error,
        pose_error: m.pose_error,
        force_error: m.force_error,
        ending: m.ending(),
        end: m.event.map(|event| event.time),
        phases,
        impacts: impacts.collect(),
        heat: path
            .filter(|_| ask.table.rubs() || ask.restitution.is_some())
            .map(|path| path.dissipated.clone()),
        lost: path.filter(|_| !ask.losses.is_none()).map(|path| path.work_lost.clone()),
        rows,
    })
}

/// The contact at one time: whether the body is on the table, on both rims, on a face, or in the air.
struct TouchNow {
    both: bool,
    point: bool,
    flies: bool,
}

impl TouchNow {
    fn of<S: Moving>(now: &Sample<S>) -> Self {
        let kind = now.kind.unwrap_or(Kind::Rolling);
        let (stands, flies) = (kind == Kind::OnItsFace, kind == Kind::Flying);
        let both = kind >= Kind::Lying && !stands;
        Self { both, point: !(both || stands || flies), flies }
    }

    /// The force of the table; zero where N would be negative, since the body then leaves the table at once.
    fn force(&self, normal: f64, force: Vector3<f64>) -> Vector3<f64> {
        match () {
            () if self.both => Vector3::repeat(f64::NAN),
            () if normal < 0.0 => Vector3::zeros(),
            () => force,
        }
    }

    fn point(&self, [x, y]: [f64; 2]) -> Vector3<f64> {
        if self.point { Vector3::new(x, y, 0.0) } else { Vector3::repeat(f64::NAN) }
    }
}

/// The velocity that the centre of mass has gained on a smooth slope; `None` where the slip is known.
fn fall(ask: &Ask, time: f64) -> Option<f64> {
    (ask.table == Table::Smooth && ask.restitution.is_none()).then(|| ask.slope.sin() * time)
}

/// The height of the lowest point of the body, from that of its rim, or from the centre and the distance `extent` of
/// the lowest point below it. A height that is negative by rounding is 0; any other negative height, or NaN, is
/// returned unchanged.
fn lowest(rim: f64, centre: f64, extent: f64) -> f64 {
    let other = centre - extent;
    let found = if rim < other { rim } else { other };
    let rounded = HEIGHT_ROUNDINGS * f64::EPSILON * (1.0 + centre.abs() + extent.abs());
    if found < 0.0 && found >= -rounded { 0.0 } else { found }
}

fn body_at(m: &Motion<State>, body: &Body, ask: &Ask, i: usize) -> Option<Known> {
    let now = m.sample(i);
    let (pose, touch, force) = (now.pose?, TouchNow::of(&now), now.force?);
    let (position, orientation, velocity) = (now.centre(body)?, now.orientation()?, now.velocity(body)?);
    let other = now.other_rim.filter(|_| touch.both).map_or(0.0, |other| other.force.normal);
    let normal = force.normal + other;
    let axis = orientation * Vector3::z();
    let theta = axis.x.hypot(axis.y).atan2(axis.z);
    let circles = body.standing_on(0).circles();
    let extent = circles.iter().map(|circle| circle.height(theta)).fold(f64::NEG_INFINITY, f64::max);
    let height = if touch.flies { lowest(now.aloft.height, position.z, extent) } else { now.aloft.height };
    let beside = if ask.is_level() { 0.0 } else { energy_beside(body, ask, m, i)? };
    Some(Known {
        time: now.time,
        position,
        orientation,
        velocity: fall(ask, now.time).map_or(velocity, |x| Vector3::new(x, 0.0, velocity.z)),
        w: now.angular_velocity()?,
        energy: now.energy(body)? + beside,
        needed: force.friction_coefficient(),
        normal: if normal < 0.0 { 0.0 } else { normal },
        force: touch.force(normal, now.force_in_laboratory()?),
        point: touch.point([pose.contact_point.x, pose.contact_point.y]),
        height,
    })
}

fn stone_at(m: &Motion<StoneState>, of: &Ellipsoid, ask: &Ask, i: usize) -> Option<Known> {
    let now = m.sample(i);
    let (pose, touch, force) = (now.pose?, TouchNow::of(&now), now.force?);
    let position = Point3::from(pose.centre);
    let [a, b, c, d] = now.state.orientation();
    let least = UnitQuaternion::new_unchecked(Quaternion::new(a, b, c, d));
    let (Slip { u_h: along, u_2: across }, AboveTable { height, lift, .. }) =
        (now.slip.unwrap_or_default(), now.aloft);
    let slip = pose.orientation * (least.inverse() * Vector3::new(along, across, lift));
    let own = Vector3::from(now.state.w);
    let w = pose.orientation * own;
    let lowest = Point3::new(pose.contact_point.x, pose.contact_point.y, height);
    let mut velocity = slip + w.cross(&(position - lowest));
    let free = fall(ask, now.time);
    if free.is_some() {
        (velocity.x, velocity.y) = (0.0, 0.0);
    }
    let turning = own.dot(&(Matrix3::from(of.inertia()) * own));
    let beside = if ask.is_level() { 0.0 } else { energy_of_fall(ask, m, i, [position.x, position.z]) };
    let energy = 0.5 * (turning + velocity.norm_squared()) + position.z + beside;
    velocity.x = free.unwrap_or(velocity.x);
    Some(Known {
        time: now.time,
        position,
        orientation: pose.orientation,
        velocity,
        w,
        energy,
        needed: if force.z > 0.0 { force.x.hypot(force.y) / force.z } else { f64::INFINITY },
        normal: if force.z < 0.0 { 0.0 } else { force.z },
        force: touch.force(force.z, force),
        point: touch.point([pose.contact_point.x, pose.contact_point.y]),
        height,
    })
}
