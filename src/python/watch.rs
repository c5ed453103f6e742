//! Long work asks Python about fifty times a second whether to go on.

use pyo3::prelude::*;
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
        let told = Python::attach(|py| {
            py.check_signals()?;
            self.progress.as_ref().map_or(Ok(()), |f| f.call1(py, (share,)).map(|_| ()))
        });
        told.map_err(|e| self.interrupt = Some(e)).is_ok()
    }

    /// The end: all done, unless it was interrupted.
    pub fn done(self, py: Python<'_>) -> PyResult<()> {
        match self.interrupt {
            Some(e) => Err(e),
            None => self.progress.map_or(Ok(()), |f| f.call1(py, (1.0,)).map(|_| ())),
        }
    }
}
