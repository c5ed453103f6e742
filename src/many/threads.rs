//! Work in blocks that is shared among threads; this module contains no physics.
//!
//! The threads end with the call (a pool would hang in a forked child). It is random which thread takes which block, so
//! the result of a block must not depend on its thread.

use crate::error::spare_for;
use crate::methods::beat::{BEAT_PERIOD, Beat};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// The bytes that a thread may reserve at its first small allocation, including its stack. With less memory no
/// thread is started, since it could fail in code that cannot return an error.
const THREAD_BYTES: usize = 80 << 20;

/// The size of the stack of a thread of this module, in bytes. The stack of the caller may be as small as 80 KiB, which
/// does not hold the frames of many motions in SIMD lanes.
const STACK: usize = 2 << 20;

/// Calls `work` with every block, on `threads` threads, one of which is the calling thread. The calling thread calls
/// `go_on`, with the finished share of the blocks, about fifty times a second; `work` may call its second argument in
/// between, which returns false if the work should stop. Returns true if all blocks are done. Fewer threads are used if
/// the system does not provide so many. If one thread panics, all stop, and the panic is passed on to the caller.
pub(crate) fn share<B: Send>(
    blocks: Vec<B>,
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
    work: impl Fn(B, &mut dyn FnMut() -> bool) + Sync,
) -> bool {
    run_on_threads(blocks, (threads, true), go_on, work)
}

/// [`share`] for work that needs a large stack: the calling thread only calls `go_on`, unless its stack is large as
/// well (`roomy`), or no other thread can be started. Starting threads takes longer than a few hundred motions.
pub(crate) fn share_with_large_stacks<B: Send>(
    blocks: Vec<B>,
    (threads, roomy): (usize, bool),
    go_on: &mut dyn FnMut(f64) -> bool,
    work: impl Fn(B, &mut dyn FnMut() -> bool) + Sync,
) -> bool {
    run_on_threads(blocks, (threads, roomy), go_on, work)
}

fn run_on_threads<B: Send>(
    blocks: Vec<B>,
    (threads, joins): (usize, bool),
    go_on: &mut dyn FnMut(f64) -> bool,
    work: impl Fn(B, &mut dyn FnMut() -> bool) + Sync,
) -> bool {
    let count = blocks.len();
    let threads = threads.clamp(1, count.max(1));
    let queue = Mutex::new(blocks.into_iter());
    let (stop, done) = (AtomicBool::new(false), AtomicUsize::new(0));
    let caller = std::thread::current();
    let run = |ask: &mut dyn FnMut() -> bool| {
        let _alarm = WakeAtEnd(&stop, &caller);
        loop {
            let next = queue.lock().ok().and_then(|mut blocks| blocks.next());
            let Some(block) = next else { return };
            let mut still = || {
                if !stop.load(Ordering::Relaxed) && !ask() {
                    stop.store(true, Ordering::Relaxed);
                }
                !stop.load(Ordering::Relaxed)
            };
            if !still() {
                return;
            }
            work(block, &mut still);
            done.fetch_add(1, Ordering::Relaxed);
        }
    };
    let mut beat = Beat::new();
    let mut ask = || !beat.is_due() || go_on(done.load(Ordering::Relaxed) as f64 / count as f64);
    std::thread::scope(|scope| {
        let spawn =
            || std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, || run(&mut || true));
        let fits = |k: usize| spare_for(k * THREAD_BYTES).ok();
        let first = usize::from(joins);
        let others: Vec<_> = (first..threads).map_while(|k| fits(k).and_then(|()| spawn().ok())).collect();
        if joins || others.is_empty() {
            run(&mut ask);
        }
        // The other threads may have blocks to finish, during which the caller may still stop the work.
        while done.load(Ordering::Relaxed) < count && !stop.load(Ordering::Relaxed) {
            if !ask() {
                stop.store(true, Ordering::Relaxed);
            }
            std::thread::park_timeout(BEAT_PERIOD);
        }
        for other in others {
            if let Err(panic) = other.join() {
                std::panic::resume_unwind(panic);
            }
        }
    });
    !stop.into_inner()
}

/// When dropped at the end of its thread, wakes the calling thread. If that thread panics, all threads stop, since no
/// other thread would compute the lost block.
struct WakeAtEnd<'a>(&'a AtomicBool, &'a std::thread::Thread);

impl Drop for WakeAtEnd<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.store(true, Ordering::Relaxed);
        }
        self.1.unpark();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn every_block_is_done_once_by_any_number_of_threads() {
        for threads in [1, 2, 7] {
            let mut cells = vec![0; 1000];
            let blocks: Vec<_> = cells.chunks_mut(3).collect();
            assert!(share(blocks, threads, &mut |_| true, |block, _| block.iter_mut().for_each(|x| *x += 1)));
            assert!(cells.iter().all(|x| *x == 1));
        }
        assert!(share(Vec::<u8>::new(), 4, &mut |_| true, |_, _| ()));
    }

    #[test]
    fn work_that_needs_a_large_stack_is_never_that_of_the_caller() {
        let caller = std::thread::current().id();
        for threads in [1, 3] {
            let all =
                share_with_large_stacks((0..50).collect(), (threads, false), &mut |_| true, |_: usize, _| {
                    assert_ne!(std::thread::current().id(), caller);
                    // Three quarters of the stack can be used.
                    let frame = std::hint::black_box([1u8; STACK / 4 * 3]);
                    assert_eq!(frame[frame.len() - 1], 1);
                });
            assert!(all);
        }
        let here = |(), _: &mut dyn FnMut() -> bool| assert_eq!(std::thread::current().id(), caller);
        assert!(share_with_large_stacks(vec![(); 50], (1, true), &mut |_| true, here));
        assert!(!share_with_large_stacks(vec![(); 1000], (1, false), &mut |_| false, |(), still| {
            while still() {
                std::thread::sleep(Duration::from_millis(1));
            }
        }));
    }

    #[test]
    fn who_says_no_is_heard_by_all() {
        let seen = AtomicUsize::new(0);
        let finished = share(vec![(); 1000], 3, &mut |_| false, |(), still| {
            while still() {
                std::thread::sleep(Duration::from_millis(1));
            }
            seen.fetch_add(1, Ordering::Relaxed);
        });
        assert!(!finished && seen.into_inner() < 10);
    }

    #[test]
    fn a_panic_in_any_thread_stops_all_and_reaches_the_caller() {
        let caller = std::thread::current().id();
        for within in [true, false] {
            let made = AtomicUsize::new(0);
            let fall = || {
                share((0..100_000).collect(), 3, &mut |_| true, |_: usize, _| {
                    made.fetch_add(1, Ordering::Relaxed);
                    assert_ne!(std::thread::current().id() == caller, within, "the one that falls");
                    std::thread::sleep(Duration::from_millis(1));
                })
            };
            let panic = std::panic::catch_unwind(std::panic::AssertUnwindSafe(fall)).unwrap_err();
            assert!(panic.downcast_ref::<String>().is_some_and(|said| said.contains("the one that falls")));
            assert!(made.into_inner() < 50_000);
        }
    }
}
