//! A timer that says when a long computation should call its caller, which may then stop it.

use std::time::Duration;
#[cfg(not(all(target_arch = "wasm32", target_os = "unknown")))]
use std::time::Instant;

/// The time between two calls of the caller of a long computation.
pub(crate) const BEAT_PERIOD: Duration = Duration::from_millis(20);

/// A timer that is due about fifty times a second, or at every query where the platform has no clock, as in a
/// browser's WebAssembly.
pub(crate) struct Beat {
    #[cfg(not(all(target_arch = "wasm32", target_os = "unknown")))]
    asked: Instant,
}

#[cfg(not(all(target_arch = "wasm32", target_os = "unknown")))]
impl Beat {
    /// A timer whose first interval begins at this call.
    pub fn new() -> Self {
        Self { asked: Instant::now() }
    }

    /// Whether the interval is over; if it is, the next interval begins.
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
