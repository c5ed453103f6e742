//! Slips in SIMD lanes: the equations of motion, and the margins that must stay positive in a lane.
//!
//! ```text
//! margins   s,  sin(theta_end - theta),  N0,  1 - eps,  |u| - over
//! ```

use crate::laws::body::Shape;
use crate::laws::contact::slip::{SlipResponse, Slipping};
use crate::laws::loss::Couples;
use crate::methods::flow::lanes::{Flows, NUMBERS};
use crate::methods::rk8;
use crate::motions::body::face::FLAT;
use crate::motions::body::roll::lossy::from_side;
use crate::motions::body::slide::{Slide, longest};
use crate::numbers::side_by_side::SideBySide;

/// Bodies in lanes that slip.
#[derive(Clone, Copy)]
pub(super) struct Slips<T> {
    law: Slipping<T>,
    side: [T; 3],
    over: T,
}

impl<T: SideBySide> Slips<T> {
    /// Placeholder bodies for lanes without a task.
    pub fn new(zero: T, dry: bool) -> Self {
        let one = zero.splat(1.0);
        let shape = Shape::of([zero, one, one, zero]);
        Self { law: Slipping::of(&shape, zero, dry), side: [zero; 3], over: zero }
    }
}

impl<T: SideBySide> Flows<T, 8, 5> for Slips<T> {
    type Seen = SlipResponse<T>;
    const LOOPS: bool = true;

    #[inline(always)]
    fn of(numbers: &[T; NUMBERS], like: &Self) -> Self {
        let [ell, i1, i3, fillet, strength, over, sine, cosine, there, ..] = *numbers;
        let shape = Shape::of([ell, i1, i3, fillet]);
        Self { law: Slipping::of(&shape, strength, like.law.dry), side: [sine, cosine, there], over }
    }

    #[inline(always)]
    fn rates(&self, y: &[T; 8], rate: &mut [T; 8]) -> SlipResponse<T> {
        // What the compiler knows to be absent it does not compile.
        self.law.with_losses(None::<Couples<T>>).with_patch(None).rates(y, rate)
    }

    #[inline(always)]
    fn margins(&self, y: &[T; 8], seen: &SlipResponse<T>) -> [T; 5] {
        let (mut speed, mut room) = (y[0].splat(1.0), seen.room);
        if self.law.dry {
            // Under dry friction `seen.room` has a factor |u|, the speed of the slip.
            let whole = y[5].mac(y[5], y[6] * y[6]).sqrt();
            (speed, room) = (whole - self.over, room / whole);
        }
        [y[0] - y[0].splat(2.0 * FLAT), from_side(self.side, (y[0], y[1])), seen.free, room, speed]
    }

    #[inline(always)]
    fn error(&self, tol: T, y: &[T; 8], made: &rk8::Step<T, 8>) -> T {
        <Slide>::error(tol, y, made, self.law.dry)
    }

    #[inline(always)]
    fn fastest(&self, y: &[T; 8]) -> T {
        <Slide>::fastest(y)
    }

    #[inline(always)]
    fn calm(&self, y: &[T; 8]) -> T {
        longest(y, &self.law.shape)
    }

    #[inline(always)]
    fn longest(&self, y: &[T; 8], rate: &[T; 8]) -> T {
        longest(y, &self.law.shape) / rate[7].min(y[0].splat(1.0))
    }
}
