//! The choice between explicit and implicit steps where a flow is stiff.
//!
//! ```text
//! explicit   h <= stable                              COST/12 such steps cost as much as an implicit one
//! implicit   h > pays,   pays = stable COST/12        tried after 8, 16, ... 128 explicit steps, from a failure on
//! ```
//! If some variables follow the others thousands of times faster, implicit steps may be longer. But the other variables
//! may turn so fast, or Newton's iteration may converge so badly, that implicit steps are no longer than the explicit
//! steps of the same cost. So an implicit step is tried, and the number of failures determines how long the next trial
//! has to wait. Error: none.

use crate::methods::radau::{COST, RADAU_STAGES};

/// The approximate length in sigma of the longest stable explicit step of a slip, where friction acts within a unit of sigma.
pub(super) const STABLE: f64 = 2.0;
/// Numbers of explicit steps from a failed implicit step to the next trial: at first, and at most.
const RETRY_WAITS: [u64; 2] = [8, 128];

/// Ratio of the length of an implicit step to that of the one before: of a step that is repeated because it did not
/// converge, and the largest ratio of each further step.
const SHORTENED_STEP: f64 = 0.5;
const LENGTHENED_STEP: f64 = 1.1;

/// The choice between explicit and implicit steps of a stiff flow, from the success of earlier steps.
pub(super) struct StiffSteps<const N: usize> {
    /// The number of explicit steps before the next implicit one, and the number of them after the next failure.
    explicit_steps_left: u64,
    wait_after_failure: u64,
    /// The longest implicit step: shorter after a step in which Newton's iteration did not converge.
    longest_implicit: f64,
    /// If the last step was implicit, the changes of the variables at its stages, and its length.
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
    /// Whether the next step is implicit; sets `h` to its length.
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

    /// Notes that an implicit step of the length `tried` has failed, because of its error or because it does not
    /// converge; `h` is the length of the next step.
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

    /// Notes that an implicit step has succeeded.
    pub fn note_success(&mut self, last: ([[f64; N]; RADAU_STAGES], f64)) {
        (self.wait_after_failure, self.last, self.longest_implicit) =
            (RETRY_WAITS[0], Some(last), LENGTHENED_STEP * self.longest_implicit);
    }
}

/// The least length for which an implicit step costs less than explicit steps.
fn worthwhile_length(stable: f64) -> f64 {
    (COST / 12) as f64 * stable
}
