//! Bodies in SIMD lanes that roll, or slide without friction, and lose energy; all lanes have the same loss laws.

use crate::laws::body::Shape;
use crate::laws::contact::Contact;
use crate::laws::contact::lossy::Acted;
use crate::laws::contact::reduced::Rates;
use crate::laws::loss::COUNT;
use crate::methods::flow::lanes::{Flows, NUMBERS};
use crate::methods::rk8;
use crate::motions::body::roll::lossy::{LOSSY_NUMBERS, LossyUnheld};
use crate::numbers::side_by_side::SideBySide;

const _: () = assert!(4 + LOSSY_NUMBERS < NUMBERS);

/// The properties that all bodies in a set of SIMD lanes share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LossyKind {
    pub contact: Contact,
    pub round: bool,
    pub present: [bool; COUNT],
}

/// Bodies in SIMD lanes that lose energy while they roll, or slide without friction.
#[derive(Clone, Copy)]
pub(super) struct LossyLanes<T> {
    kind: LossyKind,
    free: LossyUnheld<T>,
}

impl<T: SideBySide> LossyLanes<T> {
    /// Placeholder bodies for SIMD lanes without a motion.
    pub fn new(zero: T, kind: LossyKind) -> Self {
        let one = zero.splat(1.0);
        let rates = Rates::of(kind.contact, &Shape::of([zero, one, one, zero]), kind.round);
        Self { kind, free: LossyUnheld::of(rates, [zero; LOSSY_NUMBERS], kind.present, zero) }
    }
}

/// The number K of variables is 9 on a tilted table, else 6.
impl<T: SideBySide, const K: usize> Flows<T, K, 7> for LossyLanes<T> {
    type Seen = Acted<T>;
    /// Whether the stages of a step form a loop: on a tilted table the rates are slow enough for a loop, which is a
    /// third of the code.
    const LOOPS: bool = K > 6 || rk8::LOOPS;

    #[inline(always)]
    fn of(numbers: &[T; NUMBERS], like: &Self) -> Self {
        let [ell, i1, i3, fillet, rest @ ..] = *numbers;
        let kind = like.kind;
        let mut falls = [ell; LOSSY_NUMBERS];
        falls.copy_from_slice(&rest[..LOSSY_NUMBERS]);
        let rates = Rates::of(kind.contact, &Shape::of([ell, i1, i3, fillet]), kind.round);
        Self { kind, free: LossyUnheld::of(rates, falls, kind.present, numbers[NUMBERS - 1]) }
    }

    #[inline(always)]
    fn rates(&self, y: &[T; K], rate: &mut [T; K]) -> Acted<T> {
        self.free.rates(y, rate)
    }

    #[inline(always)]
    fn margins(&self, y: &[T; K], seen: &Acted<T>) -> [T; 7] {
        self.free.margins(y, seen)
    }

    #[inline(always)]
    fn error(&self, tol: T, y: &[T; K], made: &rk8::Step<T, K>) -> T {
        self.free.error(tol, y, made)
    }

    #[inline(always)]
    fn fastest(&self, y: &[T; K]) -> T {
        self.free.fastest(y)
    }

    #[inline(always)]
    fn calm(&self, y: &[T; K]) -> T {
        self.free.calm(y)
    }

    #[inline(always)]
    fn longest(&self, y: &[T; K], rate: &[T; K]) -> T {
        self.free.longest(y, rate)
    }
}
