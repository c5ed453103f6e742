//! Measured bodies under user-defined laws.

use super::roll_with;
use crate::error::Error;
use crate::laws::custom::Custom;
use crate::motions::measured::{Measured, MeasuredMotion};
use crate::motions::{Ask, Start};

impl Measured {
    /// Computes the motion of the body under user-defined laws, at these times in seconds, with results in SI. Start
    /// and options are in natural units; a law that is written in SI is wrapped in [`InSi`](crate::custom::InSi).
    ///
    /// # Errors
    /// Those of [`custom::roll_with`](crate::custom::roll_with).
    pub fn roll_under(
        &self,
        start: impl Into<Start>,
        seconds: &[f64],
        ask: &Ask,
        laws: Custom<'_>,
        go_on: impl FnMut() -> bool,
    ) -> Result<Option<MeasuredMotion>, Error> {
        let times: Vec<f64> = seconds.iter().map(|t| self.scale().time(*t)).collect();
        let ask = ask.with_pose().with_force();
        let found = roll_with(self.body(), start, &times, &ask, laws, go_on)?;
        Ok(found.map(|natural| MeasuredMotion { natural, of: *self, seconds: seconds.to_vec(), turn: 0.0 }))
    }
}
