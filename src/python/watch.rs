//! Long work asks Python about fifty times a second whether to go on.

use pyo3::prelude::*;
use std::cell::Cell;
use std::time::{Duration, Instant};

/// How often.
const ASK: Duration = Duration::from_millis(20);

/// Hears Ctrl-C, and tells who wants to know how far the work is.
pub struct Watch {
    progress: Option<Py<PyAny>>,
    asked: Instant,
    interrupt: Option<PyErr>,
}

impl Watch {
    pub fn new(progress: Option<Py<PyAny>>) -> Self {
        Self { progress, asked: Instant::now(), interrupt: None }
    }

    /// Whether to go on, asked as often as one likes.
    pub fn still(&mut self) -> bool {
        self.asked.elapsed() < ASK || self.go_on(f64::NAN)
    }

    /// Whether to go on, with the share that is done.
    pub fn go_on(&mut self, share: f64) -> bool {
        self.asked = Instant::now();
        let answer = Python::attach(|py| {
            py.check_signals()?;
            self.progress.as_ref().map_or(Ok(()), |f| f.call1(py, (share,)).map(|_| ()))
        });
        answer.map_err(|e| self.interrupt = Some(e)).is_ok()
    }

    /// The end: all done, unless it was interrupted.
    pub fn done(self, py: Python<'_>) -> PyResult<()> {
        match self.interrupt {
            Some(e) => Err(e),
            None => self.progress.map_or(Ok(()), |f| f.call1(py, (1.0,)).map(|_| ())),
        }
    }
}

/// Work, in nanoseconds or so, between two looks at the clock.
const UNASKED: u64 = 1_000_000;

thread_local! {
    static DONE: Cell<u64> = const { Cell::new(0) };
    static ASKED: Cell<Option<Instant>> = const { Cell::new(None) };
}

/// Whether a ufunc's loop, which keeps nothing from one call to the next, is to go on with work of about so
/// many nanoseconds. If not, Python's error is set.
pub fn still(work: u64) -> bool {
    let done = DONE.get() + work;
    DONE.set(done);
    done < UNASKED || ask()
}

#[cold]
fn ask() -> bool {
    DONE.set(0);
    let now = Instant::now();
    if ASKED.get().is_some_and(|asked| now - asked < ASK) {
        return true;
    }
    ASKED.set(Some(now));
    // None: the interpreter is going away, and nobody will see the result
    Python::try_attach(|py| py.check_signals().map_err(|e| e.restore(py)).is_ok()).unwrap_or(true)
}
