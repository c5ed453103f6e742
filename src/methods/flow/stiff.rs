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
const WAITS: [u64; 2] = [8, 128];

/// A step that does not converge is repeated with this share of its length, and each further step may be longer by
/// this factor.
const LESS: f64 = 0.5;
const MORE: f64 = 1.1;

/// The way in which a stiff flow takes its steps.
pub(super) struct StiffSteps<const N: usize> {
    /// The number of explicit steps before the next implicit one, and after the next failure.
    left: u64,
    wait: u64,
    /// The longest implicit step: shorter after a step in which Newton's iteration did not converge.
    most: f64,
    /// The changes of the numbers at the stages of the last step, if it was implicit, and its length.
    pub last: Option<([[f64; N]; RADAU_STAGES], f64)>,
}

impl<const N: usize> Default for StiffSteps<N> {
    fn default() -> Self {
        Self { left: 0, wait: WAITS[0], most: f64::INFINITY, last: None }
    }
}

impl<const N: usize> StiffSteps<N> {
    /// Whether the next step is implicit, and its length.
    #[inline(always)]
    pub fn leads_to(&mut self, h: &mut f64, stable: f64, longest: impl FnOnce() -> f64) -> bool {
        if stable == f64::INFINITY {
            return false;
        }
        let pays = pays(stable);
        if self.left == 0 && *h > 0.5 * stable && longest() >= pays {
            *h = h.min(self.most).max(pays);
            return true;
        }
        self.left = self.left.saturating_sub(1);
        *h = h.min(stable);
        false
    }

    /// An implicit step of the length `tried` has failed, because of its error or because it does not converge; the next
    /// one would have the length `h`.
    pub fn fails(&mut self, tried: f64, converges: bool, h: &mut f64, stable: f64) {
        if !converges {
            self.most = LESS * tried;
            *h = self.most;
        }
        if h.is_nan() || *h < pays(stable) {
            (self.left, self.wait) = (self.wait, WAITS[1].min(2 * self.wait));
            *h = stable;
        }
    }

    /// An implicit step has succeeded.
    pub fn succeeds(&mut self, last: ([[f64; N]; RADAU_STAGES], f64)) {
        (self.wait, self.last, self.most) = (WAITS[0], Some(last), MORE * self.most);
    }
}

/// The length from which on an implicit step costs less than explicit steps.
fn pays(stable: f64) -> f64 {
    (COST / 12) as f64 * stable
}
