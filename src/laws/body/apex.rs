//! Rolling round the apex: a body that lies on two circles and neither slips nor turns about the vertical.
//!
//! ```text
//! w = w_h h,   phi' = Om = w_h cot theta_k,   apex at Z tan(theta_k) from under the centre of mass
//! J = I1 c^2 + I3 s^2 + Z^2,   F_h = Z tan(theta_k) Om^2 towards the apex
//! N_k = (-g_o - ct J w_h^2)/D,   N_o = (g_k + ct J w_h^2)/D,   ct = cot theta_k
//! ```
//! The circle at the narrow end, which is the lower one for theta_k < pi/2, carries nothing at Om^2 = |g|/(J tan
//! theta_k), with g of the wide circle. At this rate the friction is Z |g|/J per weight; with less friction the body
//! slides away from the apex before the narrow end rises.

use super::{Body, Border, Circle, CircleBorder, landing_angle};

/// The rolling of a body on two neighbouring circles round its apex, the point where its axis meets the table.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Apex {
    /// Radius of the circle of the centre of mass about the apex, in R; infinite for two equal circles, on which the body
    /// rolls straight on.
    pub radius: f64,
    /// Distances of both points of contact from the apex, in R.
    pub contacts: [f64; 2],
    /// The rate of precession at which the narrow end rises, in sqrt(g/R); infinite for two equal circles, neither of which
    /// rises, and NaN if the body does not lie on both circles at rest.
    pub rate: f64,
    /// The ratio of friction to normal force at that rate; NaN if there is no such rate.
    pub friction: f64,
}

impl Body {
    /// The rolling of the body round its apex on the circles `k` and `k + 1`; None if the body passes from one to the other
    /// without an impact, or if there is no circle `k + 1`.
    pub fn apex(&self, k: usize) -> Option<Apex> {
        let CircleBorder { theta, span } = *self.borders().get(k)?;
        let circles = self.circles();
        let angle = landing_angle(theta);
        let border = Border::between([circles[k], circles[k + 1]].map(Circle::rim), angle);
        if span == 0.0 {
            return None;
        }
        let ((s, c), height, [low, high]) = (angle, border.height, border.circles);
        let inertia = self.i1 * c * c + self.i3 * s * s + height * height;
        // The wide circle is the upper one below a right angle; its lever has the sign that keeps the narrow one down.
        let lever = if c >= 0.0 { -high.lever } else { low.lever };
        let (rate, friction) = match (self.rests_on(k), c == 0.0) {
            (false, _) => (f64::NAN, f64::NAN),
            (true, true) => (f64::INFINITY, f64::NAN),
            _ => ((lever * c.abs() / (inertia * s)).sqrt(), height * lever / inertia),
        };
        Some(Apex {
            radius: (height * s / c).abs(),
            contacts: [low.radius, high.radius].map(|radius| (radius / c).abs()),
            rate,
            friction,
        })
    }

    /// The indices k for which the body lies at rest on the circles k and k + 1: its centre of mass is between both
    /// contact points.
    pub fn rests(&self) -> Vec<usize> {
        (0..self.borders().len()).filter(|k| self.rests_on(*k)).collect()
    }

    fn rests_on(&self, k: usize) -> bool {
        let (circles, angle) = (self.circles(), landing_angle(self.borders()[k].theta));
        let [low, high] = [k, k + 1].map(|k| circles[k].rim().lever(angle));
        low > 0.0 && high < 0.0
    }
}
