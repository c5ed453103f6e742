//! Checks for Ctrl-C during long work, and reports the progress, about fifty times a second.

use pyo3::prelude::*;
use std::cell::Cell;
use std::time::{Duration, Instant};

/// The time between two checks for Ctrl-C.
pub(super) const CHECK_PERIOD: Duration = Duration::from_millis(20);

/// Checks for Ctrl-C, and reports the finished share of the work to `progress`.
pub struct Watch {
    progress: Option<Py<PyAny>>,
    asked: Instant,
    interrupt: Option<PyErr>,
}

impl Watch {
    pub fn new(progress: Option<Py<PyAny>>) -> Self {
        Self { progress, asked: Instant::now(), interrupt: None }
    }

    /// Whether the work should continue. Frequent calls are cheap, because Python is called at most once in `CHECK_PERIOD`.
    pub fn still(&mut self) -> bool {
        self.asked.elapsed() < CHECK_PERIOD || self.go_on(f64::NAN)
    }

    /// Whether the work should continue; also reports the finished share of the work.
    pub fn go_on(&mut self, share: f64) -> bool {
        self.asked = Instant::now();
        let answer = Python::attach(|py| {
            py.check_signals()?;
            self.progress.as_ref().map_or(Ok(()), |f| f.call1(py, (share,)).map(|_| ()))
        });
        answer.map_err(|e| self.interrupt = Some(e)).is_ok()
    }

    /// Ends the work: reports it as all done, or returns the error of an interruption.
    pub fn done(self, py: Python<'_>) -> PyResult<()> {
        match self.interrupt {
            Some(e) => Err(e),
            None => self.progress.map_or(Ok(()), |f| f.call1(py, (1.0,)).map(|_| ())),
        }
    }
}

/// Approximate work, in nanoseconds, between two readings of the clock.
const WORK_BETWEEN_CHECKS: u64 = 1_000_000;

thread_local! {
    static WORK_SINCE_CHECK: Cell<u64> = const { Cell::new(0) };
    static LAST_CHECK: Cell<Option<Instant>> = const { Cell::new(None) };
}

/// Whether the loop of a ufunc should continue with work of about `work` nanoseconds; if not, Python's error is set.
/// The time of the last check is kept in this function, because the loop keeps no data between its calls.
pub fn still(work: u64) -> bool {
    let done = WORK_SINCE_CHECK.get() + work;
    WORK_SINCE_CHECK.set(done);
    done < WORK_BETWEEN_CHECKS || ask()
}

#[cold]
fn ask() -> bool {
    WORK_SINCE_CHECK.set(0);
    let now = Instant::now();
    if LAST_CHECK.get().is_some_and(|asked| now - asked < CHECK_PERIOD) {
        return true;
    }
    LAST_CHECK.set(Some(now));
    // The interpreter is shutting down if this is None, and the result will not be used.
    Python::try_attach(|py| py.check_signals().map_err(|e| e.restore(py)).is_ok()).unwrap_or(true)
}
