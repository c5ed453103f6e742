//! Comparison of an engine's trajectory with the known motion, at the times of the engine.
//!
//! ```text
//! position   |x - x_known|
//! angle      4 asin(|q -+ q_known|/2), the angle of the rotation from the known orientation to that of the engine
//! theta      the inclination of axis 3 in the engine minus the known one
//! ```
//! Error: that of the known motion, which the result of the comparison contains.

use super::natural::KnownMotion;
use super::{Natural, Scene, SceneError, inclination};
use nalgebra::{Point3, UnitQuaternion};

/// A quaternion whose length differs from 1 by more than this is not that of an orientation.
const UNIT: f64 = 1e-3;
/// Largest angle, in radians, from the initial orientation to that at time 0; a larger angle suggests quaternions in
/// another order.
const DOUBTED: f64 = 0.1;
/// Largest ratio of the last time to the end of the scene, and of the first deviation to the distance of the centre
/// from the origin; a larger ratio suggests other units.
const LONG: f64 = 10.0;
const FARTHEST: f64 = 30.0;

/// A row of a trajectory: the body of the engine at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct TrajectoryRow {
    /// The time since the initial state, in seconds.
    pub time: f64,
    /// The position of the centre of mass in metres.
    pub position: Point3<f64>,
    /// The rotation from the axes of the body to those of the table.
    pub orientation: UnitQuaternion<f64>,
}

impl TrajectoryRow {
    /// A row from its time in seconds, its centre of mass in metres, and its orientation.
    #[must_use]
    pub fn new(time: f64, position: Point3<f64>, orientation: UnitQuaternion<f64>) -> Self {
        Self { time, position, orientation }
    }
}

/// The deviation of an engine from the known motion at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Deviation {
    /// The time since the initial state, in seconds.
    pub time: f64,
    /// The distance from the known centre of mass, in metres.
    pub position: f64,
    /// The angle from the known orientation, in radians, 0 to pi.
    pub angle: f64,
    /// The inclination of axis 3 minus the known one, in radians.
    pub theta: f64,
}

/// A probable mistake in the units or in the order of an engine's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Doubt {
    /// The orientation at time 0 is not the initial one: the numbers of the quaternions may be in another order.
    Orientation,
    /// The times go far beyond the end of the scene: they may be in milliseconds.
    Times,
    /// The first position is far from the known one: the positions may be in millimetres.
    Positions,
}

/// The deviations of an engine from the known motion, up to the end of that motion.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Comparison {
    /// The deviation of the engine at each time.
    pub rows: Vec<Deviation>,
    /// A bound for the error of the known positions in metres. A smaller deviation is no error of the engine.
    pub position_error: f64,
    /// A bound for the error of the known orientations, in radians.
    pub angle_error: f64,
    /// Probable mistakes in the units or the order of the numbers.
    pub doubts: Vec<Doubt>,
}

impl Comparison {
    /// The largest distance, the largest angle, and the largest absolute difference of the inclinations of all compared
    /// times; the time of the result is the last one that was compared.
    #[must_use]
    pub fn largest(&self) -> Deviation {
        let most =
            |of: fn(&Deviation) -> f64| self.rows.iter().map(of).fold(0.0, crate::numbers::larger_or_nan);
        Deviation {
            time: self.rows.last().map_or(f64::NAN, |row| row.time),
            position: most(|row| row.position),
            angle: most(|row| row.angle),
            theta: most(|row| row.theta.abs()),
        }
    }
}

impl Scene {
    /// The known motion at these times since the initial state, in seconds and in ascending order, up to its end. The
    /// motion is computed at these times, also after the last time of the scene.
    ///
    /// # Errors
    /// Those of the motion; [`SceneError::Row`] for times that do not ascend; and [`SceneError::Motion`] for a file
    /// without the body, the start and the options from which its answer is computed.
    pub fn at(&self, seconds: &[f64]) -> Result<Vec<TrajectoryRow>, SceneError> {
        let (answer, scale) = (self.answer(seconds)?, self.scale()?);
        let rows = answer.rows.iter().zip(seconds);
        Ok(rows
            .map(|(now, time)| {
                TrajectoryRow::new(*time, now.position.map(|x| scale.metres(x)), now.orientation)
            })
            .collect())
    }

    /// Compares the trajectory of an engine with the known motion at the times of the engine. Rows after an event that ends
    /// the motion, such as the landing of a face, are left out.
    ///
    /// # Errors
    /// Those of [`at`](Self::at), and [`SceneError::Row`] for numbers that are not finite or a quaternion that is not of
    /// length 1; [`SceneError::Motion`] if the motion ends before the first row.
    pub fn compare(&self, rows: &[TrajectoryRow]) -> Result<Comparison, SceneError> {
        for (index, row) in rows.iter().enumerate() {
            let (finite, q) = (row.position.iter().all(|x| x.is_finite()), row.orientation.coords);
            if !finite || !q.iter().all(|x| x.is_finite()) {
                return Err(SceneError::Row { index, expected: "finite numbers" });
            }
            if (q.norm() - 1.0).abs() > UNIT {
                return Err(SceneError::Row { index, expected: "a unit quaternion" });
            }
        }
        let seconds: Vec<f64> = rows.iter().map(|row| row.time).collect();
        let (answer, scale) = (self.answer(&seconds)?, self.scale()?);
        let Some(first) = answer.rows.first() else {
            return Err(SceneError::Motion("rows: expected a first row before the end of the known motion"));
        };
        let deviations = rows.iter().zip(&answer.rows).map(|(row, known)| {
            let (p, q) = (row.orientation.coords.normalize(), known.orientation.coords);
            let apart = (p - q).norm().min((p + q).norm());
            Deviation {
                time: row.time,
                position: (row.position - known.position.map(|x| scale.metres(x))).norm(),
                angle: 4.0 * (0.5 * apart).min(1.0).asin(),
                theta: inclination(&row.orientation) - inclination(&known.orientation),
            }
        });
        let found: Vec<Deviation> = deviations.collect();
        let end = self.contents().expected.time.last().copied().unwrap_or_default();
        let reach = scale.metres(first.position.coords.norm());
        let doubts = [
            (Doubt::Orientation, seconds[0] == 0.0 && found[0].angle > DOUBTED),
            (Doubt::Times, seconds.last().is_some_and(|last| *last > LONG * end)),
            (Doubt::Positions, found[0].position > FARTHEST * reach),
        ];
        Ok(Comparison {
            rows: found,
            position_error: scale.metres(answer.bounds.position),
            angle_error: answer.bounds.orientation,
            doubts: doubts.into_iter().filter(|(_, so)| *so).map(|(doubt, _)| doubt).collect(),
        })
    }

    fn answer(&self, seconds: &[f64]) -> Result<KnownMotion, SceneError> {
        let expected = "times since the initial state, in ascending order";
        let mut before = 0.0;
        for (index, time) in seconds.iter().enumerate() {
            if !(*time >= before && time.is_finite()) {
                return Err(SceneError::Row { index, expected });
            }
            before = *time;
        }
        if seconds.is_empty() {
            return Err(SceneError::Row { index: 0, expected: "at least one row" });
        }
        let (scale, natural): (_, &Natural) = (self.scale()?, self.natural()?);
        let times: Vec<f64> = seconds.iter().map(|t| scale.time(*t)).collect();
        natural.answer(&times)
    }
}
