//! The first moment of a slip from rest that has no power series: a straight line.

use super::{Own, Slide};
use crate::motions::body::roll::lossy::REST;
use crate::motions::dry::friction::LEAST_GROWTH;
use crate::motions::walk::MOMENT;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, PHI, SIN, U2, UH, loses, pose_rates, poses, sum,
};
impl<L: Own> Slide<L> {
    /// The time derivative of the state vector, for a slip that begins along `way` under a user-defined law.
    pub(crate) fn rates_along<const N: usize>(&self, y: &[f64; N], way: [f64; 2]) -> [f64; N] {
        self.asks_drive(y);
        let ((s, c), w, mut all) = (y.angle(), y.w(), [0.0; N]);
        let at = self.law.towards((s, c), w, [0.0; 2], way);
        self.law.writes(y, &mut all, (&at, 1.0));
        let [pull_h, pull_2] = self.pull(y);
        (all[UH], all[U2]) = (all[UH] + pull_h, all[U2] + pull_2);
        let turning = [w[0] / s, w[2] - c * w[0] / s];
        if poses(N) {
            let heading = y[PHI].sin_cos();
            let over = self.runs(y, turning[1], heading);
            all[PHI..PHI + 4].copy_from_slice(&pose_rates(heading, turning, over));
        }
        if loses(N) {
            all[N - 1] = self.law.power((s, c), w, at.force[0]) - self.power_of_drive(y);
        }
        all
    }

    /// The state vector at the time `MOMENT` after the beginning of a slip along `way`, whose speed grows at the rate
    /// `growth`. Used where no power series exists.
    pub(crate) fn nudged<const N: usize>(&self, start: &[f64; N], way: [f64; 2], growth: f64) -> [f64; N] {
        self.asks_drive(start);
        let (angle, w) = (start.angle(), start.w());
        let u = start.slip();
        let rests = u == [0.0; 2] && self.law.dry && !self.creeps(start);
        let (at, _, heat) = if rests {
            (self.law.towards(angle, w, [0.0; 2], way), 1.0, 0.0)
        } else {
            self.law.answers(angle, w, u)
        };
        let ([s, c], mut y, [u_h, u_2]) = ([start[SIN], start[COS]], *start, sum(at.u, self.pull(start)));
        let mut rates = [0.0; N];
        rates[..8].copy_from_slice(&[-(c * w[1]), s * w[1], at.w[0], at.w[1], at.w[2], u_h, u_2, 1.0]);
        if rests {
            let growth = if L::IS { growth.max(LEAST_GROWTH) } else { growth };
            (rates[UH], rates[U2]) = (growth * way[0], growth * way[1]);
        }
        rates[HEAT] = heat - (at.force[1] * u[1] + at.force[2] * u[0]);
        let precession = w[0] / s;
        if poses(N) {
            let turning = [precession, w[2] - c * precession];
            let heading = start[PHI].sin_cos();
            let over = self.runs(start, turning[1], heading);
            rates[PHI..PHI + 4].copy_from_slice(&pose_rates(heading, turning, over));
        }
        if loses(N) {
            rates[N - 1] = self.law.power(angle, w, at.force[0]) - self.power_of_drive(start);
        }
        (0..N).for_each(|i| y[i] += MOMENT * rates[i]);
        if let Some([across, rocks]) = self.begins_to_roll() {
            // A least speed, so that a rolling whose speed grows from zero has its direction.
            for (i, way) in [(2, c * across), (3, rocks), (4, -(s * across))] {
                y[i] += 2.0 * REST * way;
            }
        }
        y
    }
}
