//! A body that lies on two circles, both of which are at rest: which of them begin to slip, and which rises.
//!
//! ```text
//! a_i' = u_i' of circle i under F and N of both;   N, N' >= 0 from F_h of both: both press, or one of them rises
//! F -> proj(F - step u'),   |F| <= mu N              a circle whose F is limited begins to slip along its u'
//! ```
//! [`landing`](super::landing) uses the same search for impulses, with velocities in place of accelerations: a slip
//! that begins from rest has the direction of its acceleration. On a level table the only answer is that both circles
//! stick.
//!
//! Error: 1e-14 of the largest acceleration, where friction does not depend on N alone.

use super::lying::{Lain, Lying};
use crate::laws::body::{Border, Shape};
use crate::numbers::larger_or_nan;

/// The largest number of steps of the search for the friction at both circles.
const SEARCH_STEPS: usize = 100_000;

/// The beginning of the motion of a body whose two circles were at rest: forces, accelerations, and the circles that slip.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Begun {
    /// Forces and accelerations of the body; the normal force of a circle that rises is 0.
    pub lain: Lain<f64>,
    /// The accelerations of the slips of both circles, each along e_h and e2.
    pub slips: [[f64; 2]; 2],
    /// Whether each of the two circles begins to slip.
    pub moves: [bool; 2],
}

impl Lying<f64> {
    /// Computes how a body begins to move whose circles are at rest and which does not turn about the vertical. The
    /// coefficient of friction of each circle is that of `fixed` while it sticks, and that of sliding if it cannot. The
    /// result is None if the search finds no answer, or if a circle that slips could also stick. The search for
    /// friction, along e_h and e2 at each circle, begins at `near`: it is slow in directions in which friction changes
    /// the slips little.
    pub fn begins(&self, w: [f64; 2], fixed: [f64; 2], near: [[f64; 2]; 2]) -> Option<Begun> {
        let (mut most, mut lets_go) = (fixed, [false; 2]);
        loop {
            let begun = self.begins_under(w, most, near)?;
            let more = [0, 1].map(|k| begun.moves[k] || lets_go[k]);
            if more == lets_go || fixed == self.strength {
                let sound = fixed == self.strength || begun.moves == lets_go;
                return sound.then_some(begun);
            }
            lets_go = more;
            most = [0, 1].map(|k| if more[k] { self.strength[k] } else { fixed[k] });
        }
    }

    /// How the body begins to move, with `most` as the largest coefficients of friction of both circles.
    fn begins_under(&self, w: [f64; 2], most: [f64; 2], near: [[f64; 2]; 2]) -> Option<Begun> {
        let mut q = near;
        let mut velocity = 0.0;
        let step = self.step();
        for _ in 0..SEARCH_STEPS {
            let (lain, slips) = self.accelerates(w, &q);
            if velocity == 0.0 {
                velocity = step * slips.iter().flatten().fold(f64::MIN_POSITIVE, |most, x| x.abs().max(most));
            }
            let (mut moved, mut moves) = (0f64, [false; 2]);
            for k in 0..2 {
                let limit = most[k] * lain.force[k][0];
                let tried = [0, 1].map(|i| q[k][i] - step * slips[k][i]);
                let size = tried[0].hypot(tried[1]);
                moves[k] = size > limit;
                let next = tried.map(|x| if moves[k] { x * (limit / size) } else { x });
                moved = (0..2).fold(moved, |moved, i| larger_or_nan(moved, (next[i] - q[k][i]).abs()));
                q[k] = next;
            }
            let size = q.iter().flatten().fold(velocity, |most: f64, x| most.max(x.abs()));
            if moved <= 2.0 * f64::EPSILON * size {
                return Some(Begun { lain, slips, moves });
            }
        }
        None
    }

    /// The step of the search: the reciprocal of the largest factor by which both forces of friction change the accelerations.
    fn step(&self) -> f64 {
        let (Border { height, circles, .. }, i1) = (self.border, self.shape.i1);
        let [here, there, mixed] = [(0, 0), (1, 1), (0, 1)].map(|(at, by)| self.yields(at, by));
        let across = 0.5 * (here + there) + (0.5 * (here - there)).hypot(mixed);
        let alone = circles.map(|on| 1.0 + height * height / (i1 + on.lever * on.lever));
        1.0 / across.max(alone[0]).max(alone[1]).max(2.0)
    }

    /// Forces and accelerations of the body, and the accelerations of both slips, for the friction `q` along e_h and e2
    /// at each circle.
    fn accelerates(&self, [w1, w3]: [f64; 2], q: &[[f64; 2]; 2]) -> (Lain<f64>, [[f64; 2]; 2]) {
        let (Border { height, circles: [here, there], .. }, Shape { i1, .. }) = (self.border, self.shape);
        let push = self.lift(w1, w3) - height * (q[0][0] + q[1][0]);
        let span = self.border.span();
        let mut loads = [(push - there.lever) / span, (here.lever - push) / span];
        // w2' where one circle rises while the other one carries the body alone.
        let mut tips = 0.0;
        for (k, on) in [(0, there), (1, here)] {
            if loads[k] < 0.0 {
                let alone = (i1 + on.lever * push) / (i1 + on.lever * on.lever);
                loads[k] = 0.0;
                loads[1 - k] = alone.max(0.0);
                tips = (push - on.lever * loads[1 - k]) / i1;
            }
        }
        let force = [0, 1].map(|k| [loads[k], q[k][1], q[k][0]]);
        let lain = self.under([w1, w3, 0.0, 0.0], force, self.couple([w1, w3], loads));
        let u = [lain.u[0] - height * tips, lain.u[1]];
        (lain, [u, [u[0], self.other_slip([lain.w[0], lain.w[1], u[0], u[1]])[1]]])
    }
}
