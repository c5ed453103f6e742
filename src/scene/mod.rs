//! Scenes for contact engines: a body, a table, an initial state, and the known answer with its errors, in SI.
//!
//! ```text
//! write     Scene::of(&body, start, &seconds, &ask)?.json()      the file that docs/engines.md describes; Python reads it
//! read      Scene::read(&text)?                                  a file of Python or of this crate
//! compare   scene.compare(&rows)?                                the answer at the engine's own times: nothing is interpolated
//! ```
//! An author of an engine needs this crate only for tests, as a `dev-dependency` with the feature `scene`. The engine takes
//! the body, the table and the start from [`Scene::contents`], computes its own motion, and is compared with the answer.
//!
//! ```
//! use spincyl::measured::{Measured, Tube};
//! use spincyl::motion::Ask;
//! use spincyl::scene::{TrajectoryRow, Scene};
//! use spincyl::steady;
//!
//! let coin = Measured::tube(&Tube::solid(25.75e-3, 2.2e-3, 8.5e-3))?;
//! let start = steady::state(coin.body(), 0.7)?.kicked(0.05);
//! let scene = Scene::of(&coin, start, &[0.0, 0.25, 0.5], &Ask::default())?;
//! let again = Scene::read(&scene.json())?;
//! // An engine that is 1 mm too high after 0.1 s.
//! let known = again.at(&[0.1])?.remove(0);
//! let row = TrajectoryRow::new(0.1, known.position + nalgebra::Vector3::z() * 1e-3, known.orientation);
//! let compared = again.compare(&[row])?;
//! assert!((compared.rows[0].position - 1e-3).abs() < 1e-12 && compared.rows[0].angle < 1e-12);
//! assert!(compared.position_error < 1e-12);
//! # use spincyl::nalgebra;
//! # Ok::<(), spincyl::scene::SceneError>(())
//! ```

mod compared;
mod contents;
mod filled;
mod mjcf;
mod natural;
mod outline;
mod urdf;
mod words;

use crate::error::Error;
use crate::laws::loss::Losses;
use crate::laws::pose::axes;
use crate::laws::scale::Scale;
use crate::laws::state::State;
use crate::laws::stone::{Ellipsoid, StoneState};
use crate::measured::Measured;
use crate::motions::{Ask, Start};
use crate::pose::euler_angles;
pub use compared::{Comparison, Deviation, Doubt, TrajectoryRow};
pub use contents::{
    CirclesShape, Contents, EllipsoidShape, Expected, NaturalUnits, SceneBody, SceneCircle, SceneEnding,
    SceneErrors, SceneFriction, SceneImpact, SceneLoss, ScenePhase, SceneShape, SceneStart, SceneTable,
    ShapeKind,
};
use nalgebra::{UnitQuaternion, Vector3};
pub use natural::Natural;

/// Smallest allowed difference of an answer from the motion that is computed anew, in R or radians, where its error is smaller.
const ROUNDING: f64 = 1e-13;
/// The version of the format of scene files.
const VERSION: u32 = 1;

/// The reason why there is no scene, or no comparison.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The motion cannot be computed.
    #[error(transparent)]
    Model(#[from] Error),
    /// The text is not the content of a scene's file, for the reason given.
    #[error("text: {0}")]
    File(String),
    /// A scene cannot have this motion, for the reason given.
    #[error("{0}")]
    Motion(&'static str),
    /// A row of the trajectory of an engine is not valid.
    #[error("rows[{index}]: expected {expected}")]
    Row {
        /// The index of the row.
        index: usize,
        /// The condition that the row does not meet.
        expected: &'static str,
    },
}

/// A body on a table, its initial state and its known motion.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Scene {
    contents: Contents,
}

/// The inclination of axis 3, in radians, at an orientation.
fn inclination(of: &UnitQuaternion<f64>) -> f64 {
    let axis = of * Vector3::z();
    axis.x.hypot(axis.y).atan2(axis.z)
}

/// The times of a scene since its start, with 0 put before them if it is missing; an error if they do not ascend.
fn from_start(seconds: &[f64]) -> Result<Vec<f64>, SceneError> {
    let mut all = Vec::with_capacity(seconds.len() + 1);
    if seconds.first() != Some(&0.0) {
        all.push(0.0);
    }
    all.extend(seconds);
    if !all.windows(2).all(|both| both[0] < both[1]) {
        return Err(SceneError::Motion(
            "seconds: expected times of 0 or more in ascending order, in seconds since the start",
        ));
    }
    Ok(all)
}

impl Scene {
    /// The scene of a measured body: its motion from a start, at these times in seconds since it. Start and options are in
    /// natural units, as for [`Measured::roll`]; the time of the start counts as 0.
    ///
    /// # Errors
    /// Those of the motion; and [`SceneError::Motion`] for times that do not ascend, for a motion without a time after its
    /// start, beyond an event or without a known error, and for a table that turns.
    pub fn of(
        of: &Measured,
        start: impl Into<Start>,
        seconds: &[f64],
        ask: &Ask,
    ) -> Result<Self, SceneError> {
        let natural = Natural::of_body(*of.body(), start.into(), *ask);
        let contents = filled::contents(natural, of.scale(), &from_start(seconds)?)?;
        Ok(Self { contents })
    }

    /// The scene of a stone, whose natural units are those of `scale`; else as [`of`](Self::of).
    ///
    /// ```
    /// use spincyl::{Ellipsoid, Scale, motion::Ask, scene::Scene};
    ///
    /// let stone = Ellipsoid::rattleback([1.0, 0.2, 0.175], None, 0.05, None)?;
    /// let scale = Scale::new(0.08, 0.05, 9.81)?; // the largest semi-axis, in metres
    /// let start = stone.spinning(-0.5, 0.02, 0.0);
    /// let scene = Scene::of_stone(&stone, &scale, start, &[0.0, 0.1], &Ask::default())?;
    /// assert!(scene.mjcf().contains("ellipsoid"));
    /// # Ok::<(), spincyl::scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`of`](Self::of), and [`SceneError::Motion`] for a motion that is not known up to its last time.
    pub fn of_stone(
        stone: &Ellipsoid,
        scale: &Scale,
        start: impl Into<Start<StoneState>>,
        seconds: &[f64],
        ask: &Ask,
    ) -> Result<Self, SceneError> {
        let natural = Natural::of_stone(*stone, start.into(), *ask);
        Ok(Self { contents: filled::contents(natural, scale, &from_start(seconds)?)? })
    }

    /// Reads the file of a scene.
    ///
    /// # Errors
    /// [`SceneError::File`] for a text that is not such a file, or of a later version, or whose answer differs by more than its
    /// errors from the motion that it is computed from; it says where.
    pub fn read(text: &str) -> Result<Self, SceneError> {
        let contents: Contents =
            serde_json::from_str(text).map_err(|error| SceneError::File(error.to_string()))?;
        if contents.version != VERSION {
            let found = contents.version;
            return Err(SceneError::File(format!("spincyl-scene = {found}: expected the version {VERSION}")));
        }
        if contents.expected.time.is_empty() {
            return Err(SceneError::File("expected.time: expected at least one time".into()));
        }
        let scene = Self { contents };
        if scene.contents.natural.is_some() {
            scene.check_answer()?;
        }
        Ok(scene)
    }

    /// Returns an error for a file whose answer is not that of its body, start and options.
    fn check_answer(&self) -> Result<(), SceneError> {
        let (known, error, metre) =
            (&self.contents.expected, &self.contents.error, self.contents.scale.radius);
        let poses = known.time.iter().zip(&known.position).zip(&known.orientation);
        let rows: Vec<TrajectoryRow> =
            poses.map(|((time, x), q)| TrajectoryRow::new(*time, *x, *q)).collect();
        let found = self.compare(&rows)?;
        let most = found.largest();
        let same = found.rows.len() == known.time.len()
            && most.position <= error.position + found.position_error + ROUNDING * metre
            && most.angle <= error.angle + found.angle_error + ROUNDING;
        if same {
            return Ok(());
        }
        let why = format!(
            "expected: the known motion of this file is {:e} m and {:e} rad from that of its body, start and options",
            most.position, most.angle
        );
        Err(SceneError::File(why))
    }

    /// The file of the scene, as JSON.
    ///
    /// # Panics
    /// Never: every number of a scene that is not finite is null in the file.
    #[must_use]
    pub fn json(&self) -> String {
        serde_json::to_string(&self.contents).expect("every part of a scene is written")
    }

    /// The contents of the scene file: body, table, start and answer.
    #[must_use]
    pub fn contents(&self) -> &Contents {
        &self.contents
    }

    /// Returns this scene with another name of its body, which appears in files and models.
    #[must_use]
    pub fn with_name(mut self, name: impl Into<String>) -> Self {
        self.contents.body.name = name.into();
        self
    }

    /// The scene in the format of MuJoCo, with the initial state as the keyframe "start". A comment at the top names the laws
    /// that MuJoCo does not have.
    #[must_use]
    pub fn mjcf(&self) -> String {
        mjcf::mjcf(&self.contents)
    }

    /// The body in the format URDF: its mass, its inertia, and the shape with which it touches the table. URDF has no
    /// friction, no initial state and no table; the engine takes these from the scene file.
    ///
    /// # Errors
    /// [`SceneError::Motion`] for a body whose shape URDF does not have: one with a fillet, an ellipsoid, or several circles
    /// with fillets.
    pub fn urdf(&self) -> Result<String, SceneError> {
        urdf::urdf(&self.contents)
    }

    /// The natural units of the scene.
    ///
    /// # Errors
    /// Those of [`Scale::new`], if the file has impossible units.
    pub fn scale(&self) -> Result<Scale, SceneError> {
        let NaturalUnits { radius, mass, gravity, .. } = self.contents.scale;
        Ok(Scale::new(radius, mass, gravity)?)
    }

    /// The couple with which the losses of the scene act on a body of revolution, along the axes of the table in N m, for an
    /// engine without these losses: at an orientation, an angular velocity in rad/s along the axes of the table, and a normal
    /// force in newtons. In the air the force is 0, and only the resistance of the air acts.
    ///
    /// # Errors
    /// [`SceneError::Motion`] for a stone, and for a file without the natural units of its motion.
    pub fn couple(
        &self,
        orientation: &UnitQuaternion<f64>,
        angular_velocity: Vector3<f64>,
        normal_force: f64,
    ) -> Result<Vector3<f64>, SceneError> {
        self.couple_of(|ask| ask.losses, orientation, angular_velocity, normal_force)
    }

    /// The couple of [`couple`](Self::couple) while the contact point slips: without a rolling resistance that acts
    /// only while the contact point does not slip
    /// ([`Resistance::WhileRolling`](crate::loss::Resistance::WhileRolling)).
    ///
    /// # Errors
    /// Those of [`couple`](Self::couple).
    pub fn couple_while_slipping(
        &self,
        orientation: &UnitQuaternion<f64>,
        angular_velocity: Vector3<f64>,
        normal_force: f64,
    ) -> Result<Vector3<f64>, SceneError> {
        self.couple_of(Ask::losses_in_slip, orientation, angular_velocity, normal_force)
    }

    fn couple_of(
        &self,
        losses: impl Fn(&Ask) -> Losses,
        orientation: &UnitQuaternion<f64>,
        angular_velocity: Vector3<f64>,
        normal_force: f64,
    ) -> Result<Vector3<f64>, SceneError> {
        let scale = self.scale()?;
        let Natural::Body { body, ask, .. } = self.natural()? else {
            return Err(SceneError::Motion("couple: expected a body of revolution, not a stone"));
        };
        let w = angular_velocity.map(|w| scale.angular_velocity(w));
        let y = State::from_twist(orientation, w);
        let acting = losses(ask);
        let mut losses = acting;
        if normal_force <= 0.0 {
            for (law, _) in acting.iter().filter(|(law, _)| !law.acts_in_air()) {
                losses = losses.with(law, 0.0);
            }
        }
        let m = losses.couple(&body.told_at(y.theta), &y, scale.force(normal_force));
        let phi = euler_angles(orientation).phi;
        Ok((axes(phi, y.theta) * Vector3::from(m)).map(|m| scale.newton_metres(m)))
    }

    fn natural(&self) -> Result<&Natural, SceneError> {
        let why = "natural: expected a file with this key, which has the body, the start and the options of the motion";
        self.contents.natural.as_ref().ok_or(SceneError::Motion(why))
    }
}
