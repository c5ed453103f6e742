//! SIMD lanes that are refilled: as soon as one flow leaves its lane, the next waiting flow takes that lane.

use super::Spent;
use super::lanes::{Entry, Flows, LaneStatus, Set};
use crate::numbers::side_by_side::{MOST, SideBySide};

/// Largest number of steps in a set of SIMD lanes between two calls of [`Waiting::go_on`].
const BURST: usize = 64;
/// Number of steps that a flow takes outside the SIMD lanes before it gets another lane.
pub(crate) const STEPS_ALONE: u64 = 3;

/// Flows of one kind that wait for SIMD lanes, each with K variables and M margins.
pub(crate) trait Waiting<const K: usize, const M: usize> {
    /// The initial data of the next flow, which gets SIMD lane `k`; None if no flow waits.
    fn enter(&mut self, k: usize) -> Option<Entry<K, M>>;
    /// Receives the flow of SIMD lane `k`, which has left its lane with the variables and the next step `at`.
    fn leave(&mut self, k: usize, status: LaneStatus, at: ([f64; K], f64), spent: Spent);
    /// Whether the flows continue; false if the caller interrupts them.
    fn go_on(&mut self) -> bool;
}

/// Runs all waiting flows in SIMD lanes, each until its lane stops.
pub(crate) fn follow<T: SideBySide, L: Flows<T, K, M>, const K: usize, const M: usize>(
    like: T,
    law: L,
    waiting: &mut dyn Waiting<K, M>,
) {
    let (mut busy, mut set) = ([false; MOST], None::<Set<T, L, K, M>>);
    loop {
        let mut fresh = false;
        for (k, busy) in busy.iter_mut().enumerate().take(T::COUNT).filter(|(_, busy)| !**busy) {
            let Some(entry) = waiting.enter(k) else { break };
            // A lane without a flow computes as well; its results are ignored.
            let set = set.get_or_insert_with(|| Set::new(like, law, &entry));
            if !fresh {
                set.store_rows();
            }
            set.fill(k, &entry);
            (*busy, fresh) = (true, true);
        }
        let Some(set) = &mut set else { return };
        set.mark_idle_lanes(like, &busy.map(|busy| f64::from(u8::from(!busy))));
        if fresh {
            set.load_rows(like);
        }
        if busy == [false; MOST] || !waiting.go_on() {
            return;
        }
        set.take_steps(like, BURST);
        for (k, busy) in busy.iter_mut().enumerate().take(T::COUNT).filter(|(_, busy)| **busy) {
            let status = set.status(k);
            if status != LaneStatus::Runs {
                *busy = false;
                waiting.leave(k, status, set.place(k), set.spent(k));
            }
        }
    }
}
