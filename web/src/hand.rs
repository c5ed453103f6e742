//! The calls for states in which a body leaves the hand of a person who throws it.

use crate::{Answer, Desk};
use spincyl::{Slip, State, throw};

impl Desk {
    /// Writes the start of a flicked tube, from the impulse of the finger, its angle, and the coefficients of
    /// friction of finger and table.
    pub fn flick(&mut self, [impulse, angle, finger, table]: [f64; 4]) -> Answer {
        let body = self.set_body()?;
        let (y, slip) = throw::pressed(&body, impulse, angle, finger, table)?;
        self.tell_start(&y, slip);
        self.out.push(throw::launch_number(&body, &y));
        Ok(())
    }

    /// Writes the start of a hoop that is thrown upright, from its velocity and backspin.
    pub fn thrown(&mut self, [velocity, backspin]: [f64; 2]) -> Answer {
        let (y, slip) = throw::thrown(&self.set_body()?, velocity, backspin)?;
        self.tell_start(&y, slip);
        Ok(())
    }

    fn tell_start(&mut self, y: &State, slip: Slip) {
        self.out.extend([y.theta, y.w1, y.w2, y.w3, slip.u_h, slip.u_2]);
    }
}
