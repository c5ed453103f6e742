//! Slips in lanes: the law, and what ends them or needs attention.
//!
//! ```text
//! margins   N0,  sin(theta_max - theta)          quiet   s,  1 - eps          moves   |u| - over
//! ```

use super::flow_lanes::{Flows, NUMBERS};
use super::side_by_side::SideBySide;
use crate::body::Shape;
use crate::contact::slip::{Contact, Slipping};
use crate::motion::damped::from_side;
use crate::motion::flow::Halt;
use crate::motion::slide::{Slide, longest};
use crate::rk8;

/// What the margins mean.
pub(super) const ENDS: [Halt; 3] = [Halt::LiftOff, Halt::Side, Halt::Time];

/// Bodies that slip.
#[derive(Clone, Copy)]
pub(super) struct Slips<T> {
    law: Slipping<T>,
    side: [T; 3],
    over: T,
}

impl<T: SideBySide> Slips<T> {
    /// Of nothing yet.
    pub fn new(zero: T, dry: bool) -> Self {
        let one = zero.splat(1.0);
        let shape = Shape::of([zero, one, one, zero]);
        Self { law: Slipping::of(&shape, zero, dry), side: [zero; 3], over: zero }
    }
}

impl<T: SideBySide> Flows<T, 8, 3> for Slips<T> {
    type Seen = Contact<T>;

    #[inline(always)]
    fn of(numbers: &[T; NUMBERS], like: &Self) -> Self {
        let [ell, i1, i3, fillet, strength, over, sine, cosine, there, ..] = *numbers;
        let shape = Shape::of([ell, i1, i3, fillet]);
        Self { law: Slipping::of(&shape, strength, like.law.dry), side: [sine, cosine, there], over }
    }

    #[inline(always)]
    fn rates(&self, y: &[T; 8], rate: &mut [T; 8]) -> Contact<T> {
        self.law.rates(y, rate)
    }

    #[inline(always)]
    fn margins(&self, y: &[T; 8], seen: &Contact<T>) -> [T; 3] {
        [seen.free, from_side(self.side, (y[0], y[1])), seen.free]
    }

    #[inline(always)]
    fn quiet(&self, y: &[T; 8], seen: &Contact<T>) -> T {
        y[0].min(seen.room)
    }

    #[inline(always)]
    fn moves(&self, y: &[T; 8]) -> T {
        if !self.law.dry {
            return y[0].splat(1.0);
        }
        y[5].mac(y[5], y[6] * y[6]).sqrt() - self.over
    }

    #[inline(always)]
    fn time(&self, y: &[T; 8], _: T, _: T) -> T {
        y[7]
    }

    #[inline(always)]
    fn error(&self, tol: T, y: &[T; 8], made: &rk8::Step<T, 8>) -> T {
        Slide::error(tol, y, made, self.law.dry)
    }

    #[inline(always)]
    fn longest(&self, y: &[T; 8], _: &[T; 8]) -> T {
        longest(y, &self.law.shape)
    }
}
