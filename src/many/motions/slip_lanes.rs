//! Slips in SIMD lanes: the equations of motion, and the margins that must stay positive in a lane.
//!
//! ```text
//! y         s, c, w1, w2, w3, u_h, u_2; on a tilted table cos phi, sin phi and x; t
//! margins   s,  sin(theta_end - theta),  N0,  1 - eps,  |u| - over
//! ```
//! On a tilted table the acceleration tan(beta) (cos phi, -sin phi) adds to the rates of the slip.

use crate::laws::body::Shape;
use crate::laws::contact::slip::{SlipResponse, Slipping};
use crate::laws::loss::Couples;
use crate::methods::flow::lanes::{Flows, NUMBERS};
use crate::methods::rk8;
use crate::motions::body::face::FLAT;
use crate::motions::body::roll::lossy::from_side;
use crate::motions::body::slide::{Slide, longest};
use crate::motions::walk::numbers::{BodyNumbers, contact_velocity, heading_rates};
use crate::numbers::side_by_side::SideBySide;

/// Bodies in SIMD lanes whose contact points slip.
#[derive(Clone, Copy)]
pub(super) struct Slips<T> {
    law: Slipping<T>,
    side: [T; 3],
    over: T,
    /// The tangent of the slope of the table.
    tilt: T,
}

impl<T: SideBySide> Slips<T> {
    /// Placeholder bodies for SIMD lanes without a motion.
    pub fn new(zero: T, dry: bool) -> Self {
        let one = zero.splat(1.0);
        let shape = Shape::of([zero, one, one, zero]);
        Self { law: Slipping::of(&shape, zero, dry), side: [zero; 3], over: zero, tilt: zero }
    }
}

/// The number K of variables is 11 on a tilted table, else 8.
impl<T: SideBySide, const K: usize> Flows<T, K, 5> for Slips<T> {
    type Seen = SlipResponse<T>;
    const LOOPS: bool = true;

    #[inline(always)]
    fn of(numbers: &[T; NUMBERS], like: &Self) -> Self {
        let [ell, i1, i3, fillet, strength, over, sine, cosine, there, ..] = *numbers;
        let shape = Shape::of([ell, i1, i3, fillet]);
        let law = Slipping::of(&shape, strength, like.law.dry);
        Self { law, side: [sine, cosine, there], over, tilt: numbers[NUMBERS - 1] }
    }

    #[inline(always)]
    fn rates(&self, y: &[T; K], rate: &mut [T; K]) -> SlipResponse<T> {
        // The compiler leaves out the terms that are known to be absent.
        let law = self.law.with_losses(None::<Couples<T>>).with_patch(None);
        if K == 8 {
            return law.rates(y, rate);
        }
        let (angle, w, u) = (y.angle(), y.w(), y.slip());
        let (mut at, pace) = law.at(angle, w, u);
        let ([cos, sin], precession) = ([y[7], y[8]], w[0] / angle.0);
        at.u = [at.u[0] + self.tilt * cos, at.u[1] - self.tilt * sin];
        law.writes(y, rate, (&at, pace));
        let runs = contact_velocity(&law.shape.rim, angle, w[1], w[2] - angle.1 * precession, u);
        let [cos, sin, x] = heading_rates([cos, sin], precession, runs);
        rate[7..].copy_from_slice(&[pace * cos, pace * sin, pace * x, pace]);
        at
    }

    #[inline(always)]
    fn margins(&self, y: &[T; K], seen: &SlipResponse<T>) -> [T; 5] {
        let (mut speed, mut room) = (y[0].splat(1.0), seen.room);
        if self.law.dry {
            // Under dry friction `seen.room` has a factor |u|, the speed of the slip.
            let whole = y[5].mac(y[5], y[6] * y[6]).sqrt();
            (speed, room) = (whole - self.over, room / whole);
        }
        [y[0] - y[0].splat(2.0 * FLAT), from_side(self.side, (y[0], y[1])), seen.free, room, speed]
    }

    #[inline(always)]
    fn error(&self, tol: T, y: &[T; K], made: &rk8::Step<T, K>) -> T {
        <Slide>::error(tol, y, made, self.law.dry, K - 1)
    }

    #[inline(always)]
    fn fastest(&self, y: &[T; K]) -> T {
        <Slide>::fastest(y)
    }

    #[inline(always)]
    fn calm(&self, y: &[T; K]) -> T {
        longest(y, &self.law.shape)
    }

    #[inline(always)]
    fn longest(&self, y: &[T; K], rate: &[T; K]) -> T {
        longest(y, &self.law.shape) / rate[K - 1].min(y[0].splat(1.0))
    }
}
