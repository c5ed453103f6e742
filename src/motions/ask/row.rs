//! The outputs of a motion, one row per time. Rows are written only here, into memory that was reserved before the
//! first step.

use crate::error::{Error, room};
use crate::laws::body::View;
use crate::laws::state::Slip;
use crate::motions::walk::two_runs::Followed;
use crate::motions::{AboveTable, Ask, Kind, Motion, Moving, OtherRim, Path};
use crate::numbers::larger_or_nan;

/// The outputs of a motion at one time.
pub(crate) struct OutputRow<S: Moving> {
    pub state: S,
    pub slip: Slip,
    /// The heat of friction, and the energy that the loss laws have taken, since the start.
    pub spent: [f64; 2],
    pub kind: Kind,
    /// The pose, if poses were requested.
    pub pose: Option<S::Pose>,
    /// The force and its error, if forces were requested.
    pub force: Option<(S::Force, f64)>,
    /// The height of the lowest point of the rim and its vertical velocity.
    pub aloft: AboveTable,
    /// Slip and force of the other rim of a body that lies on both; the state refers to the first rim.
    pub other_rim: Option<OtherRim>,
}

impl<S: Moving> OutputRow<S> {
    /// The outputs of a body on the table, without pose and force.
    pub fn on_table(state: S, slip: [f64; 2], spent: [f64; 2], kind: Kind) -> Self {
        Self {
            state,
            slip: slip.into(),
            spent,
            kind,
            pose: None,
            force: None,
            aloft: AboveTable::default(),
            other_rim: None,
        }
    }

    /// Converts outputs that are counted from the upper end of the body to the lower end.
    fn told(self, view: &View) -> Self {
        let force = self.force.map(|(force, doubt)| (S::force_told(&force), doubt));
        let (pose, state) =
            (self.pose.map(|pose| S::pose_told(&pose)), self.state.told(view.tells(self.state.theta())));
        Self { state, slip: self.slip.map(|u| 0.0 - u), pose, force, ..self }
    }
}

impl<S: Moving> Followed<S> {
    /// A motion without rows, with memory for `count` rows of the outputs that `ask` wants; `loses` if they include
    /// lost energy.
    pub fn empty(count: usize, ask: &Ask, loses: bool) -> Result<Self, Error> {
        let mut motion = Motion::empty(count, ask.pose)?;
        if ask.force {
            (motion.forces, motion.force_error) = (Some(room(count)?), 0.0);
        }
        Ok(Self { motion, path: Path::empty(count, loses, ask.restitution.is_some())? })
    }

    /// Adds a row to the outputs.
    pub fn push(&mut self, row: OutputRow<S>) {
        let Self { motion, path } = self;
        let lies = row.other_rim.is_some();
        let row = if path.is_told_over(lies) { row.told(&path.view) } else { row };
        motion.states.push(row.state);
        path.slip.push(row.slip);
        path.dissipated.push(row.spent[0]);
        path.kinds.push(row.kind);
        if path.loses {
            path.work_lost.push(row.spent[1]);
        }
        if path.goes_on {
            path.aloft.push(row.aloft);
            path.other_rim.push(row.other_rim.unwrap_or(OtherRim::NONE));
        }
        if path.goes_on || path.view.circles.is_some() {
            path.rims.push(path.rim(lies));
        }
        if let Some((poses, pose)) = motion.poses.as_mut().zip(row.pose) {
            poses.push(pose);
        }
        if let Some((forces, (force, doubt))) = motion.forces.as_mut().zip(row.force) {
            forces.push(force);
            motion.force_error = larger_or_nan(motion.force_error, doubt);
        }
    }
}
