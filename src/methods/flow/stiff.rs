//! The choice between explicit and implicit steps where a flow is stiff.
//!
//! ```text
//! explicit   h <= stable                              COST/12 such steps cost as much as an implicit one
//! implicit   h > pays,   pays = stable COST/12        tried after 8, 16, ... 128 explicit steps, from a failure on
//! ```
//! Numbers that follow the others thousands of times faster ask for implicit steps, but the others may turn so fast, or
//! Newton's iteration may converge so badly, that these are no longer than the explicit steps of the same cost. So an
//! implicit step is tried, and the failures say how long the next trial has to wait. Error: none.

use crate::methods::radau::{COST, RADAU_STAGES};

/// About the longest stable explicit step in the variable of a slip, where friction acts within a unit of sigma.
pub(super) const STABLE: f64 = 2.0;
/// Explicit steps from a failure of an implicit step to the next one, at first and at most.
const RETRY_WAITS: [u64; 2] = [8, 128];

/// A step that does not converge is repeated with this share of its length, and each further step may be longer by
/// this factor.
const SHORTENED_STEP: f64 = 0.5;
const LENGTHENED_STEP: f64 = 1.1;

/// The way in which a stiff flow takes its steps.
pub(super) struct StiffSteps<const N: usize> {
    /// The number of explicit steps before the next implicit one, and after the next failure.
    explicit_steps_left: u64,
    wait_after_failure: u64,
    /// The longest implicit step: shorter after a step in which Newton's iteration did not converge.
    longest_implicit: f64,
    /// The changes of the numbers at the stages of the last step, if it was implicit, and its length.
    pub last: Option<([[f64; N]; RADAU_STAGES], f64)>,
}

impl<const N: usize> Default for StiffSteps<N> {
    fn default() -> Self {
        Self {
            explicit_steps_left: 0,
            wait_after_failure: RETRY_WAITS[0],
            longest_implicit: f64::INFINITY,
            last: None,
        }
    }
}

impl<const N: usize> StiffSteps<N> {
    /// Whether the next step is implicit, and its length.
    #[inline(always)]
    pub fn next_is_implicit(&mut self, h: &mut f64, stable: f64, longest: impl FnOnce() -> f64) -> bool {
        if stable == f64::INFINITY {
            return false;
        }
        let pays = worthwhile_length(stable);
        if self.explicit_steps_left == 0 && *h > 0.5 * stable && longest() >= pays {
            *h = h.min(self.longest_implicit).max(pays);
            return true;
        }
        self.explicit_steps_left = self.explicit_steps_left.saturating_sub(1);
        *h = h.min(stable);
        false
    }

    /// An implicit step of the length `tried` has failed, because of its error or because it does not converge; the next
    /// one would have the length `h`.
    pub fn note_failure(&mut self, tried: f64, converges: bool, h: &mut f64, stable: f64) {
        if !converges {
            self.longest_implicit = SHORTENED_STEP * tried;
            *h = self.longest_implicit;
        }
        if h.is_nan() || *h < worthwhile_length(stable) {
            (self.explicit_steps_left, self.wait_after_failure) =
                (self.wait_after_failure, RETRY_WAITS[1].min(2 * self.wait_after_failure));
            *h = stable;
        }
    }

    /// An implicit step has succeeded.
    pub fn note_success(&mut self, last: ([[f64; N]; RADAU_STAGES], f64)) {
        (self.wait_after_failure, self.last, self.longest_implicit) =
            (RETRY_WAITS[0], Some(last), LENGTHENED_STEP * self.longest_implicit);
    }
}

/// The length from which on an implicit step costs less than explicit steps.
fn worthwhile_length(stable: f64) -> f64 {
    (COST / 12) as f64 * stable
}
