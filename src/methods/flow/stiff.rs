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
pub(crate) const STABLE: f64 = 2.0;
/// Explicit steps from a failure of an implicit step to the next one, at first and at most.
const WAITS: [u64; 2] = [8, 128];

/// The way in which a stiff flow takes its steps.
pub(super) struct Ways<const N: usize> {
    /// The number of explicit steps before the next implicit one, and after the next failure.
    left: u64,
    wait: u64,
    /// The changes of the numbers at the stages of the last step, if it was implicit, and its length.
    pub last: Option<([[f64; N]; RADAU_STAGES], f64)>,
}

impl<const N: usize> Default for Ways<N> {
    fn default() -> Self {
        Self { left: 0, wait: WAITS[0], last: None }
    }
}

impl<const N: usize> Ways<N> {
    /// Whether the next step is implicit, and its length.
    #[inline(always)]
    pub fn leads_to(&mut self, h: &mut f64, stable: f64, longest: impl FnOnce() -> f64) -> bool {
        if stable == f64::INFINITY {
            return false;
        }
        let pays = pays(stable);
        if self.left == 0 && *h > 0.5 * stable && longest() >= pays {
            *h = h.max(pays);
            return true;
        }
        self.left = self.left.saturating_sub(1);
        *h = h.min(stable);
        false
    }

    /// An implicit step has failed; the next one would have the length `h`.
    pub fn fails(&mut self, h: &mut f64, stable: f64) {
        if h.is_nan() || *h < pays(stable) {
            (self.left, self.wait) = (self.wait, WAITS[1].min(2 * self.wait));
            *h = stable;
        }
    }

    /// An implicit step has succeeded.
    pub fn succeeds(&mut self, last: ([[f64; N]; RADAU_STAGES], f64)) {
        (self.wait, self.last) = (WAITS[0], Some(last));
    }
}

/// The length from which on an implicit step costs less than explicit steps.
fn pays(stable: f64) -> f64 {
    (COST / 12) as f64 * stable
}
