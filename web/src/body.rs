//! The calls of a page that set the body.

use crate::{Answer, Desk};
use spincyl::{Body, Contact, Error, stability, steady};

/// A uniform tube with this half length, bore and fillet, in units of its outer radius; a fillet of 0 means sharp
/// edges.
pub(crate) fn tube(half: f64, bore: f64, fillet: f64) -> Result<Body, Error> {
    if fillet == 0.0 { Body::tube(half, bore) } else { Body::rounded_tube(half, bore, fillet) }
}

impl Desk {
    /// Sets a uniform tube by its half length, bore (inner radius) and fillet, in units of its outer radius, and
    /// writes its numbers.
    pub fn tube(&mut self, [half, bore, fillet]: [f64; 3]) -> Answer {
        self.take(tube(half, bore, fillet)?)
    }

    /// Sets any body of revolution by ell, I1, I3, fillet and theta_end; a theta_end of NaN stands for the
    /// default.
    pub fn body(&mut self, [ell, i1, i3, fillet, theta_end]: [f64; 5]) -> Answer {
        let body = Body::rounded(ell, i1, i3, fillet)?;
        self.take(if theta_end.is_nan() { body } else { body.with_theta_end(theta_end)? })
    }

    /// Sets a uniform frustum by the radii of both ends, the larger of which is 1, and its height. After the numbers
    /// that are written for any body it writes the radius, the depth below the centre of mass, and the fillet of each
    /// circle.
    pub fn frustum(&mut self, [bottom, top, height]: [f64; 3]) -> Answer {
        let body = Body::frustum(bottom, top, height, None)?;
        self.take(body)?;
        self.out.extend(body.circles().iter().flat_map(|it| [it.radius, it.depth, it.fillet]));
        Ok(())
    }

    /// Writes the half length, in outer radii, of the critical tube with this bore and fillet.
    pub fn critical(&mut self, [bore, fillet]: [f64; 2]) -> Answer {
        self.out.push(Body::critical_aspect(bore, fillet)?);
        Ok(())
    }

    fn take(&mut self, body: Body) -> Answer {
        (self.body, self.motion) = (Some(body), None);
        let folds = steady::folds(&body).iter().filter(|theta| !theta.is_nan()).count();
        self.out.extend([
            body.ell(),
            body.i1(),
            body.i3(),
            body.fillet(),
            body.theta_balance(),
            body.theta_limit(),
            body.theta_end(),
            stability::standing_spin(&body, Contact::Rolling),
            folds as f64,
            body.excess(),
        ]);
        Ok(())
    }
}
