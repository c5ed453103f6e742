//! Error estimates of a body that loses energy, for a contact point that stops or has settled.

use super::LossyFlow;
use crate::laws::contact::lossy::Held;
use crate::laws::loss::SLACK;
use crate::laws::state::{State, spin_of};
use crate::motions::body::own::Own;
use crate::motions::dry::settled::lag;

impl<G: Own> LossyFlow<G> {
    /// Error of the time at which the contact point stops, from the sum `erred` of the errors of all steps. The more
    /// slowly psi' changes, the larger is the effect of an error of psi' on that time.
    pub fn doubt(&self, y: &State, erred: f64) -> f64 {
        let (angle, w) = (y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
        let (s, c) = angle;
        let [d1, _, d3] = self.response(angle, w[0] / s, w, Held::Nothing).w;
        let rate = spin_of((s, c), d1, d3) - w[0] * w[1] / (s * s);
        // Since psi' = w3 - w1 c/s, an error of w1 counts for more where s is small.
        let rounded = (4.0 * SLACK + erred.max(100.0 * self.tol)) * (1.0 + y.precession().abs());
        let late = if self.settled {
            let push = self.response(angle, w[0] / s, w, Held::Contour(0.0)).held[0];
            let radius = self.law.rates.reduced().shape.rim.radius(angle);
            lag(&self.law.losses.beside(()), (s, c * y.w2), radius, push, self.law.stiffness(angle, 1.0))
        } else {
            0.0
        };
        late + (rounded + erred * (c / s).abs()) / rate.abs()
    }

    /// Error of w1 and w3 while psi' follows its balance: at most sin(theta) abs(psi').
    pub fn settled_doubt(&self, y: &State) -> f64 {
        y.theta.sin() * y.spin().abs()
    }
}
