//! The calls for steady states: at an inclination, with a rate, or with the centre on a circle.

use crate::{Answer, Desk};
use spincyl::{Body, Contact, State, contact, rolling, stability, steady};

impl Desk {
    /// Writes the steady state at an inclination, with the centre at rest.
    pub fn at_rest(&mut self, [theta]: [f64; 1]) -> Answer {
        let body = self.set_body()?;
        let y = steady::state(&body, theta)?;
        let kappa = [Contact::Rolling, Contact::Smooth].map(|of| stability::at_rest(&body, theta, of));
        self.tell_state(&body, &y, steady::rate(&body, theta), kappa);
        Ok(())
    }

    /// Writes the inclinations of the steady states with this reduced rate, in ascending order.
    pub fn by_rate(&mut self, [rate]: [f64; 1]) -> Answer {
        let body = self.set_body()?;
        self.out.extend(steady::inclinations(&body, rate).into_iter().filter(|theta| !theta.is_nan()));
        Ok(())
    }

    /// Writes the steady state that precesses at this rate while its centre moves on a circle.
    pub fn circular(&mut self, [theta, precession]: [f64; 2]) -> Answer {
        let body = self.set_body()?;
        let y = steady::circular(&body, theta, precession)?;
        self.tell_state(&body, &y, f64::NAN, [stability::rolling(&body, &y), stability::smooth(&body, &y)]);
        Ok(())
    }

    fn tell_state(&mut self, body: &Body, y: &State, rate: f64, [rolls, glides]: [f64; 2]) {
        let force = contact::force(Contact::Rolling, body, y);
        self.out.extend([
            f64::from(stability::region(body, y.theta) as u8),
            rate,
            rolls,
            glides,
            rolling::energy(body, y),
            y.w1,
            y.w2,
            y.w3,
            y.precession(),
            y.spin(),
            y.contact_radius(),
            force.friction_coefficient(),
            force.normal,
            y.centre_radius(body),
        ]);
    }
}
