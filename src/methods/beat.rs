//! A timer for the calls by which long computations let their caller stop them.

use std::time::Duration;
#[cfg(not(all(target_arch = "wasm32", target_os = "unknown")))]
use std::time::Instant;

/// The time between two calls of the caller.
pub(crate) const BEAT_PERIOD: Duration = Duration::from_millis(20);

/// A timer that is due about fifty times a second, or at every query where the platform has no clock, as in a
/// browser's WebAssembly.
pub(crate) struct Beat {
    #[cfg(not(all(target_arch = "wasm32", target_os = "unknown")))]
    asked: Instant,
}

#[cfg(not(all(target_arch = "wasm32", target_os = "unknown")))]
impl Beat {
    /// A beat whose first interval begins now.
    pub fn new() -> Self {
        Self { asked: Instant::now() }
    }

    /// Whether the interval is over; if so, the next interval begins now.
    pub fn is_due(&mut self) -> bool {
        let due = self.asked.elapsed() >= BEAT_PERIOD;
        if due {
            self.asked = Instant::now();
        }
        due
    }
}

#[cfg(all(target_arch = "wasm32", target_os = "unknown"))]
impl Beat {
    pub fn new() -> Self {
        Self {}
    }

    pub fn is_due(&mut self) -> bool {
        true
    }
}
