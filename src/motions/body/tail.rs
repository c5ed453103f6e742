//! The end of a whirr that slips: a face that comes down by infinitely many turns, of which only the first are
//! computed.
//!
//! ```text
//! p = w1 s ~ tau^3    p^(1/3) falls in a straight line to the end, tau = 0
//! t_end = t_2 + (t_2 - t_1)/((p_1/p_2)^(1/3) - 1)
//! ```
//! Under rolling resistance or drilling an almost flat face has theta ~ tau^2 and w1 ~ tau, so that every
//! turn and every slip is a smaller copy of the one before. The vertical momentum p hardly nods with the
//! body, which is why its values and not those of theta give the end. Two values far apart give one estimate.
//!
//! Error: twice the sum of all further changes of the estimate, extrapolated from the last three estimates.

/// Sine of theta below which the turns of a whirr are nearly smaller copies of each other. Estimates begin here; at
/// larger inclinations they would be wrong.
const ALIKE_BELOW: f64 = 1e-4;
/// The two values of p^(1/3) in an estimate differ at least by this factor. Closer ones would give a
/// less accurate end.
const APART: f64 = 1.25;
/// The end is accepted, and the last turns are left out, if its error is below this.
const END_KNOWN: f64 = 1e-9;
/// Sine of theta below which any estimate of the end is accepted, and slips are no longer computed.
const GONE: f64 = 1e-13;
/// Assumed number of further changes of the estimate where these do not become smaller.
const LEFT: f64 = 64.0;

/// The estimates of the end of a whirr.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LastTurns {
    /// Time and p^(1/3) of the last value.
    last: Option<[f64; 2]>,
    /// The time of the end, its distance from the estimate before, and its error.
    end: Option<[f64; 3]>,
}

impl LastTurns {
    /// Updates the estimates with a point: its time, sine of theta and w1.
    pub fn adds_point(&mut self, t: f64, s: f64, w1: f64) {
        let root = (w1 * s).abs().cbrt();
        if s > ALIKE_BELOW || root == 0.0 {
            *self = Self::default();
            return;
        }
        match self.last {
            Some([before, far]) if far >= APART * root => {
                let end = t + (t - before) / (far / root - 1.0);
                let moved = self.end.map_or(f64::INFINITY, |[other, ..]| (end - other).abs());
                // If each change is the same share of the previous one, all further changes are a geometric series.
                let share = self.end.map_or(1.0, |[_, other, _]| moved / other);
                let doubt = 2.0 * moved * if share < 1.0 - 1.0 / LEFT { 1.0 / (1.0 - share) } else { LEFT };
                (self.last, self.end) = (Some([t, root]), Some([end, moved, doubt]));
            }
            Some([_, far]) if far >= root => {}
            // A face that rises again begins another whirr.
            _ => *self = Self { last: Some([t, root]), end: None },
        }
    }

    /// The time of the end and its error, after two estimates.
    pub fn end(&self) -> Option<[f64; 2]> {
        // The error cannot exceed the remaining time until the estimated end.
        let left = |end: f64| self.last.map_or(f64::INFINITY, |[t, _]| end - t);
        self.end.map(|[end, _, doubt]| [end, doubt.min(left(end))]).filter(|[_, doubt]| doubt.is_finite())
    }

    /// The time of the end and its error, if the error is small and the end is before `until`, or if `s`
    /// is below `GONE`.
    pub fn known(&self, s: f64, until: f64) -> Option<[f64; 2]> {
        self.end().filter(|[end, doubt]| s < GONE || *doubt < END_KNOWN && end + doubt < until)
    }
}
