//! The options of a motion, and their checks.

pub(crate) mod bounds;
pub(crate) mod moving;
pub(crate) mod rests_on;
pub(crate) mod result;
pub(crate) mod row;
pub(crate) mod sample;

use crate::error::{Error, within};
use crate::laws::body::Body;
use crate::laws::contact::slip::Friction;
use crate::laws::contact::slip::{centre_rise, centre_velocity};
use crate::laws::contact::{Face, ImpactLaw, Table};
use crate::laws::loss::{Law, Losses, Resistance};
use crate::laws::pose::{axes, euler_angles};
use crate::laws::state::{Slip, State};
use crate::methods::SHORT_CODE;
use core::f64::consts::PI;
use nalgebra::{UnitQuaternion, Vector3};

/// The default tolerance of a step of a motion with friction or losses.
pub const FINE: f64 = 1e-14;

/// A vertical velocity of the lowest point counts as a rounding error of the input below this share of the
/// velocities.
pub(crate) const NO_RISE: f64 = 1e-9;
/// A slip counts as zero below this share of the velocities: 16 roundings (ulp).
const NO_SLIP: f64 = 16.0 * f64::EPSILON;

/// The numerical method that computes a motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Method {
    /// The first integrals, or an integrator within a tolerance where these lose all their digits. A motion that slips
    /// or loses energy is integrated to the accuracy of double precision.
    #[default]
    Exact,
    /// RK4 with this fixed step; an error for a motion that slips or loses energy.
    Step(f64),
    /// Steps of eighth order whose errors are below this tolerance.
    Tolerance(f64),
}

/// The options of a motion, with any contact and any losses. Each option has a method whose name is `with_` and the
/// name of the option. For an option that is on or off the method turns it on. All options are also fields.
///
/// ```
/// use spincyl::{contact::Friction, loss::{Law, Losses}, motion::Ask};
///
/// let ask = Ask::on(Friction::coulomb(0.3)).with_losses(Losses::of(Law::Drilling, 1e-3)).with_pose();
/// assert!(ask.pose && !ask.force);
/// let mut watched = ask;
/// watched.force = std::env::args().any(|word| word == "--force");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[non_exhaustive]
pub struct Ask {
    /// The law of the contact with the table.
    pub table: Table,
    /// The loss laws that act in addition to the friction of a slip.
    pub losses: Losses,
    /// Whether rolling resistance acts always, or only while the body rolls. The second choice needs a table on which
    /// a body can roll: not a smooth one, no viscous friction, and no patch of contact, which creeps. With it a
    /// motion ends where the body lies on two rims, and where it can neither roll under the resistance nor slip
    /// without it. For stones rolling resistance always acts.
    #[cfg_attr(feature = "serde", serde(default))]
    pub resistance: Resistance,
    /// The method that computes the motion.
    pub method: Method,
    /// Whether the motion continues past events other than a landing of the face; with a law of friction it never does.
    pub beyond: bool,
    /// The coefficient of restitution of impacts, from 0 to 1, or `None`. With `None` the motion ends where the body
    /// leaves the table or its other rim lands. With a number the motion continues in the air, on the other rim and on
    /// both rims, but the motion of a stone ends where its edge lands, and the motion of a body on a patch of contact
    /// ends where a face or its other rim lands.
    pub restitution: Option<f64>,
    /// The law of restitution, to which the coefficient `restitution` belongs.
    #[cfg_attr(feature = "serde", serde(default))]
    pub impact_law: ImpactLaw,
    /// The model of the pressure of the table on a face on which the body stands.
    pub face: Face,
    /// The slope of the table, in radians, between -pi/2 and pi/2; x points downhill.
    #[cfg_attr(feature = "serde", serde(default))]
    pub slope: f64,
    /// The rate at which the table turns about its normal through x = y = 0, in sqrt(g/R). Slips are relative to the
    /// table, and all other results are relative to the laboratory. A motion ends where a face or a second rim lands,
    /// or where the body comes to rest on a level table that carries it.
    #[cfg_attr(feature = "serde", serde(default))]
    pub turning: f64,
    /// Whether the motion ends where the body begins to roll; only with a law of friction.
    pub stop_at_rolling: bool,
    /// The largest number of evaluations of the equations of motion ([`Motion::evaluations`](super::Motion)); a
    /// motion that needs more ends there with [`Ending::Bounded`](super::Ending::Bounded). With `None` the limit for
    /// a motion that slips, loses energy or hops, and for steps within a tolerance, is 8 million, or 40,000 per unit
    /// of time if this is more. Steps of fixed length then have no limit, and first integrals need no evaluations.
    pub max_evaluations: Option<u64>,
    /// Whether poses are computed.
    pub pose: bool,
    /// Whether contact forces are computed.
    pub force: bool,
}

impl Ask {
    /// Options of an exact motion with this contact up to its first event, without losses, poses and forces.
    pub fn on(table: impl Into<Table>) -> Self {
        Self::default().with_table(table)
    }

    /// Returns these options with another contact.
    #[must_use]
    pub fn with_table(self, table: impl Into<Table>) -> Self {
        Self { table: table.into(), ..self }
    }

    /// Returns these options with these losses.
    #[must_use]
    pub fn with_losses(self, losses: Losses) -> Self {
        Self { losses, ..self }
    }

    /// Returns these options with rolling resistance always or only while the body rolls.
    ///
    /// ```
    /// use spincyl::contact::Friction;
    /// use spincyl::loss::{Law, Losses, Resistance};
    /// use spincyl::motion::{Ask, Start, roll_with};
    /// use spincyl::{Body, Slip, State};
    ///
    /// // A ball that is struck through its centre, with mu = 0.2, rolls after 2 v/(7 mu), whatever resists its rolling.
    /// let (ball, still) = (Body::ball(0.0, 0.4, 0.4)?, State { theta: 1.0, w1: 0.0, w2: 0.0, w3: 0.0 });
    /// let losses = Losses::of(Law::RollingResistance, 0.01);
    /// let ask = Ask::on(Friction::coulomb(0.2)).with_losses(losses).with_resistance(Resistance::WhileRolling);
    /// let motion = roll_with(&ball, Start::from(still).with_slip(Slip::new(0.0, 3.0)), &[10.0], &ask, || true)?.unwrap();
    /// assert!((motion.path.unwrap().phases[1].time - 2.0 * 3.0 / (7.0 * 0.2)).abs() < 1e-12);
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    #[must_use]
    pub fn with_resistance(self, resistance: Resistance) -> Self {
        Self { resistance, ..self }
    }

    /// Returns these options with this method.
    #[must_use]
    pub fn with_method(self, method: Method) -> Self {
        Self { method, ..self }
    }

    /// Returns these options, so that the motion continues past events (`beyond`).
    #[must_use]
    pub fn with_beyond(self) -> Self {
        Self { beyond: true, ..self }
    }

    /// Returns these options with this coefficient of restitution, or with `None`.
    #[must_use]
    pub fn with_restitution(self, restitution: impl Into<Option<f64>>) -> Self {
        Self { restitution: restitution.into(), ..self }
    }

    /// Returns these options with this law of restitution.
    #[must_use]
    pub fn with_impact_law(self, impact_law: ImpactLaw) -> Self {
        Self { impact_law, ..self }
    }

    /// Returns these options with this model of the pressure on a face.
    #[must_use]
    pub fn with_face(self, face: Face) -> Self {
        Self { face, ..self }
    }

    /// Returns these options on a table that turns at this rate, in sqrt(g/R).
    #[must_use]
    pub fn with_turning(self, turning: f64) -> Self {
        Self { turning, ..self }
    }

    /// Returns these options on a table with this slope, in radians.
    #[must_use]
    pub fn with_slope(self, slope: f64) -> Self {
        Self { slope, ..self }
    }

    /// Returns these options, so that the motion ends where the body begins to roll.
    #[must_use]
    pub fn with_stop_at_rolling(self) -> Self {
        Self { stop_at_rolling: true, ..self }
    }

    /// Returns these options with this largest number of evaluations; `None` stands for the default limit.
    #[must_use]
    pub fn with_max_evaluations(self, most: impl Into<Option<u64>>) -> Self {
        Self { max_evaluations: most.into(), ..self }
    }

    /// Returns these options, with poses.
    #[must_use]
    pub fn with_pose(self) -> Self {
        Self { pose: true, ..self }
    }

    /// Returns these options, with contact forces.
    #[must_use]
    pub fn with_force(self) -> Self {
        Self { force: true, ..self }
    }

    /// Whether there is rolling resistance that acts only while the contact point does not slip.
    pub(crate) fn resists_only_rolling(&self) -> bool {
        self.resistance == Resistance::WhileRolling
            && self.losses.coefficient(Law::RollingResistance) != 0.0
            && self.table.rubs()
    }

    /// The losses that act while the contact point slips.
    pub(crate) fn losses_in_slip(&self) -> Losses {
        if self.resists_only_rolling() { self.losses.with(Law::RollingResistance, 0.0) } else { self.losses }
    }

    /// Whether the table is level and at rest.
    pub fn is_level(&self) -> bool {
        self.slope == 0.0 && self.turning == 0.0
    }

    /// Whether the motion conserves energy, without a law of friction and on a level table, so that three first
    /// integrals determine it.
    pub fn conserves(&self) -> bool {
        self.is_level() && !self.table.rubs() && self.losses.is_none() && self.restitution.is_none()
    }
}

/// Height of the lowest point of a body above the table, and its vertical velocity. In files: the array of both numbers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(from = "[f64; 2]", into = "[f64; 2]")
)]
#[non_exhaustive]
pub struct AboveTable {
    /// The height above the table, in R.
    pub height: f64,
    /// The upward velocity of the lowest point, in sqrt(g R).
    pub lift: f64,
}

impl AboveTable {
    /// A body whose lowest point is at this height, in R, with this vertical velocity, in sqrt(g R).
    pub const fn new(height: f64, lift: f64) -> Self {
        Self { height, lift }
    }
}

impl From<[f64; 2]> for AboveTable {
    /// Converts the array of height and vertical velocity.
    fn from([height, lift]: [f64; 2]) -> Self {
        Self { height, lift }
    }
}

impl From<AboveTable> for [f64; 2] {
    fn from(of: AboveTable) -> Self {
        [of.height, of.lift]
    }
}

/// The initial conditions of a motion: `Start::from` a state, then optionally slip, time and height.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Start<S = State> {
    /// The initial state.
    pub state: S,
    /// The initial slip of the contact point, in sqrt(g R); [`stone::roll`](super::stone::roll) says which components
    /// a stone has.
    #[cfg_attr(feature = "serde", serde(default))]
    pub slip: Slip,
    /// The initial time, in sqrt(R/g).
    #[cfg_attr(feature = "serde", serde(default))]
    pub time: f64,
    /// The height of the lowest point of the rim above the table and its vertical velocity, for a body that starts in
    /// the air; this needs a restitution.
    pub aloft: Option<AboveTable>,
    /// The direction phi to which the axis leans at first, in radians from the x axis.
    #[cfg_attr(feature = "serde", serde(default))]
    pub heading: f64,
    /// The initial contact point (x, y), in R.
    #[cfg_attr(feature = "serde", serde(default))]
    pub place: [f64; 2],
}

impl<S> From<S> for Start<S> {
    /// Starts from this state at time 0 on the table, without a slip.
    fn from(state: S) -> Self {
        Self { state, slip: Slip::default(), time: 0.0, aloft: None, heading: 0.0, place: [0.0; 2] }
    }
}

impl<S> Start<S> {
    /// Returns this start with this slip.
    #[must_use]
    pub fn with_slip(self, slip: Slip) -> Self {
        Self { slip, ..self }
    }

    /// Returns this start at this time.
    #[must_use]
    pub fn with_time(self, time: f64) -> Self {
        Self { time, ..self }
    }

    /// Returns this start in the air, with this height of the lowest point and its vertical velocity, or with `None`.
    #[must_use]
    pub fn with_aloft(self, aloft: impl Into<Option<AboveTable>>) -> Self {
        Self { aloft: aloft.into(), ..self }
    }
}

impl<S> Start<S> {
    /// Returns an error for a place or a direction out of range.
    pub(crate) fn check_place(&self) -> Result<(), Error> {
        within("phi0", self.heading, (-1e6, 1e6), "at most 1e6 radians")?;
        for x in self.place {
            within("place", x, (-1e15, 1e15), "at most 1e15 R from x = y = 0")?;
        }
        Ok(())
    }

    /// Returns this start with the axis leaning to this direction phi, from the x axis.
    #[must_use]
    pub fn with_heading(self, heading: f64) -> Self {
        Self { heading, ..self }
    }

    /// Returns this start with the contact point at this place (x, y), in R.
    #[must_use]
    pub fn with_place(self, place: [f64; 2]) -> Self {
        Self { place, ..self }
    }
}

impl Start {
    /// Returns this start with the slip at which the centre is at rest, if the body stands on its face and does not tip.
    #[must_use]
    pub fn at_rest_on_face(self, body: &Body) -> Self {
        let State { theta, w2, .. } = self.state;
        if w2 != 0.0 || self.aloft.is_some() || ![0.0, PI].contains(&theta) {
            return self;
        }
        let told = self.seen_on(body);
        let slip = centre_velocity(&told.0, &told.1.state, Slip::default()).map(|v| 0.0 - v);
        let slip = Slip::from(slip);
        self.with_slip(if told.0.view().over { slip.map(|u| 0.0 - u) } else { slip })
    }

    /// The body with the circle of contact that carries it at the start, and the start counted from the end of the
    /// body at which that circle is. The given body and start are counted from the body's lower end.
    pub(crate) fn seen_on(&self, body: &Body) -> (Body, Self) {
        let body = body.at(self.state.theta);
        let view = body.view();
        if !view.over {
            return (body, *self);
        }
        let State { theta, w1, w2, w3 } = self.state;
        let border = view.borders.iter().find(|[_, told]| *told == theta);
        let theta = border.map_or(PI - theta, |[seen, _]| *seen);
        let state = State { theta, w1, w2: 0.0 - w2, w3: 0.0 - w3 };
        (body, Self { state, slip: self.slip.map(|u| 0.0 - u), ..*self })
    }

    /// The initial conditions of a body from its orientation, its angular velocity and the velocity of its centre of
    /// mass. The orientation is the rotation from the axes of the body to those of the laboratory, of which the third
    /// is the vertical; the vectors are along the axes of the laboratory, in sqrt(g/R) and sqrt(g R). `height` is
    /// that of the centre above the table, in R, for a body in the air; with `None` the body is on the table. The
    /// motion counts phi and psi from this orientation, whose angles are
    /// [`euler_angles`](crate::laws::pose::euler_angles);
    /// [`readings_from`](crate::measured::MeasuredMotion::readings_from) returns the motion from the given
    /// orientation and place.
    ///
    /// Error of the slip: 16 ulp of the velocities, divided by sin theta; a slip below 16 ulp counts as zero.
    ///
    /// ```
    /// use spincyl::nalgebra::{UnitQuaternion, Vector3};
    /// use spincyl::{Body, Slip, motion::Start};
    ///
    /// let (ball, w) = (Body::ball(0.0, 0.4, 0.4)?, Vector3::new(0.0, 2.0, 0.3));
    /// let turned = UnitQuaternion::from_euler_angles(0.1, 0.2, 0.3);
    /// let rolls = Start::from_twist(&ball, &turned, w, w.cross(&Vector3::z()), None)?;
    /// assert_eq!(rolls.slip, Slip::default());
    /// assert!(Start::from_twist(&ball, &turned, w, Vector3::z(), None).is_err());
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    ///
    /// # Errors
    /// `OutOfRange` for a velocity that is not finite or that, on the table, would move the lowest point up or down.
    pub fn from_twist(
        body: &Body,
        orientation: &UnitQuaternion<f64>,
        angular_velocity: Vector3<f64>,
        velocity: Vector3<f64>,
        height: Option<f64>,
    ) -> Result<Self, Error> {
        let state = State::from_twist(orientation, angular_velocity);
        let body = &body.told_at(state.theta);
        let v = axes(-euler_angles(orientation).phi, 0.0) * velocity;
        let (rim, angle) = (body.shape().rim, state.theta.sin_cos());
        let fastest = velocity.amax() + angular_velocity.amax() * (1.0 + rim.ell.abs());
        let most = if height.is_some() { f64::MAX } else { NO_RISE * fastest };
        let expected =
            "an upward velocity with which the lowest point stays on the table; for a flight give a height";
        let rise = within("velocity", v.z - centre_rise(body, &state), (-most, most), expected)?;
        let [along, across] = centre_velocity(body, &state, Slip::default());
        let slip = [v.x - along, v.y - across].map(|u| if u.abs() <= NO_SLIP * fastest { 0.0 } else { u });
        let aloft = height.map(|height| AboveTable::new(height - rim.height(angle), rise));
        Ok(Self::from(state).with_slip(slip.into()).with_aloft(aloft))
    }
}

impl From<&State> for Start {
    fn from(state: &State) -> Self {
        Self::from(*state)
    }
}

/// Checks the options of a motion that conserves energy. Returns the signed span from the initial to the last time.
pub(crate) fn check_conserving(ask: &Ask, t0: f64, times: &[f64]) -> Result<f64, Error> {
    ask.table.check()?;
    check_stop_at_rolling(ask)?;
    let span = check_times(t0, times)?;
    check_method(ask.method, span)?;
    Ok(span)
}

/// Returns an error for `stop_at_rolling` without a law of friction.
fn check_stop_at_rolling(ask: &Ask) -> Result<(), Error> {
    if ask.stop_at_rolling && !ask.table.rubs() {
        let expected = "false without a law of friction, since slip ends in rolling only by friction";
        return Err(Error::OutOfRange { name: "stop_at_rolling", value: 1.0, expected });
    }
    Ok(())
}

/// Checks the times. Returns the signed span from the initial to the last time.
fn check_times(t0: f64, times: &[f64]) -> Result<f64, Error> {
    within("t0", t0, (-1e15, 1e15), "|t0| <= 1e15")?;
    let expected = "one or more times, ascending from t0 on or descending from t0 on, |t| <= 1e15";
    let &last = times.last().ok_or(Error::OutOfRange { name: "t", value: f64::NAN, expected })?;
    let way = if last < t0 { -1.0 } else { 1.0 };
    let mut before = 0.0;
    for &t in times {
        let since = way * (t - t0);
        if !(since >= before && t.abs() <= 1e15) {
            return Err(Error::OutOfRange { name: "t", value: t, expected });
        }
        before = since;
    }
    Ok(last - t0)
}

/// Returns an error for times before the initial time of a motion with friction or losses.
pub(crate) fn check_times_after(t0: f64, times: &[f64]) -> Result<(), Error> {
    if check_times(t0, times)? < 0.0 {
        let expected = "times after t0: with friction or losses the past is not determined";
        return Err(Error::OutOfRange { name: "t", value: times[times.len() - 1], expected });
    }
    Ok(())
}

/// Checks the options of a motion with friction or losses. Returns the tolerance of its steps.
pub(crate) fn check_flow(ask: &Ask) -> Result<f64, Error> {
    within("restitution", ask.restitution.unwrap_or(0.0), (0.0, 1.0), "None, or 0 <= restitution <= 1")?;
    check_stop_at_rolling(ask)?;
    match ask.method {
        Method::Exact => Ok(FINE),
        Method::Tolerance(tol) => within("tol", tol, (FINE, 1e-1), "1e-14 <= tol <= 0.1"),
        Method::Step(value) => {
            let expected = "no fixed step for a motion with friction or losses: give a tolerance instead";
            Err(Error::OutOfRange { name: "step", value, expected })
        }
    }
}

/// Returns an error for options that a patch of contact does not allow.
pub(crate) fn check_patch(ask: &Ask) -> Result<(), Error> {
    let patch = ask.table.friction().patch();
    if patch > 0.0 && ask.losses.coefficients[Law::Drilling as usize] > 0.0 {
        let expected = "0 together with drilling friction, which gives the same couple";
        return Err(Error::OutOfRange { name: "patch", value: patch, expected });
    }
    if SHORT_CODE && patch > 0.0 && ask.restitution.is_some() {
        let expected = "0 for a motion with a restitution on a web page";
        return Err(Error::OutOfRange { name: "patch", value: patch, expected });
    }
    Ok(())
}

/// Returns an error for rolling resistance only while a body rolls, on a table on which it never does.
pub(crate) fn check_resistance(ask: &Ask) -> Result<(), Error> {
    let value = ask.losses.coefficient(Law::RollingResistance);
    let never = match ask.table {
        Table::Rolling { .. } => false,
        Table::Rubs(Friction::Coulomb { patch, .. }) => patch > 0.0,
        _ => true,
    };
    if ask.resistance == Resistance::WhileRolling && value != 0.0 && never {
        let expected = "0 on a smooth table, on a viscous film and on a patch, for rolling resistance only while the body rolls";
        return Err(Error::OutOfRange { name: "delta", value, expected });
    }
    Ok(())
}

fn check_method(method: Method, span: f64) -> Result<(), Error> {
    match method {
        Method::Step(step) => {
            let expected = "a step with the sign of time (negative if the times descend), of at least 1e-12 and 1e-15 of their span";
            let named = |ok: bool| {
                if ok { Ok(()) } else { Err(Error::OutOfRange { name: "step", value: step, expected }) }
            };
            named(step.abs() >= 1e-12 && step.is_finite() && span.abs() / step.abs() <= 1e15)?;
            named(step > 0.0 || span <= 0.0)
        }
        Method::Tolerance(tol) => within("tol", tol, (1e-14, 1e-1), "1e-14 <= tol <= 0.1").map(|_| ()),
        Method::Exact => Ok(()),
    }
}
