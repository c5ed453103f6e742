//! Extrapolates the end of a whirr with slip: a face lands after infinitely many turns, of which only the first are
//! computed.
//!
//! ```text
//! p = w1 s ~ tau^3    p^(1/3) falls in a straight line to the end, tau = 0
//! t_end = t_2 + (t_2 - t_1)/((p_1/p_2)^(1/3) - 1)
//! ```
//! Under rolling resistance or drilling an almost flat face has theta ~ tau^2 and w1 ~ tau, so that every turn and
//! every slip is a smaller copy of the one before. The same holds under any law that does not stop the contact point
//! along the rim, if the coin slips in each nod: friction then takes a growing share of the remaining energy. The
//! angular momentum p hardly oscillates with the nods, so that the end is computed from p and not from theta.
//!
//! Two slips from rest that begin a whole number of nods apart give an estimate that is exact as soon as the turns
//! are copies of each other. Within a slip that does not end, two values of p far apart give one estimate.
//!
//! Error, for slips from rest: twice the spread of the last estimates, divided by the share of the remaining motion
//! that they cover; else twice the sum of all further changes of the estimate, extrapolated from the last three.

use crate::numbers::larger_or_nan;

/// Sine of theta below which the turns of a whirr are nearly smaller copies of each other. Estimates of its end begin
/// here; at larger inclinations they would be wrong.
const SELF_SIMILAR_SINE: f64 = 1e-4;
/// The two values of p^(1/3), with p = w1 sin(theta), in an estimate of the end of a whirr differ at least by this
/// factor. Closer values would give a less accurate end.
const LEAST_ROOT_RATIO: f64 = 1.25;
/// The estimated end of a whirr is accepted, and its last turns are left out, if its error is below this, or below
/// `OF_STEP_ERRORS` times the sum of all step errors: along so many slips these grow by more, and the end moves with
/// them.
const END_KNOWN: f64 = 1e-9;
const OF_STEP_ERRORS: f64 = 3.0;
/// Sine of theta below which any estimate of the end of a whirr is accepted, and no more slips are computed.
const ANY_END_SINE: f64 = 1e-13;
/// Assumed number of further changes of the estimated end of a whirr if the changes do not become smaller.
const FURTHER_CHANGES: f64 = 64.0;
/// If the computation of a whirr would stop early, its estimated end is accepted if the error is below this share of
/// the remaining time.
const BETTER_THAN_NONE: f64 = 0.1;
/// Largest number of slips from rest in a nod of a whirr. `AGREE` estimates of the end in a row must agree.
const SLIPS: usize = 4;
const AGREE: usize = 9;
const STARTS: usize = SLIPS + AGREE;

/// The beginning of a slip from rest near the end of a whirr.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SlipStart {
    pub time: f64,
    /// The cube root of p = w1 sin(theta), which is proportional to the remaining time.
    pub root: f64,
    pub w3: f64,
    pub heat: f64,
    pub lost: f64,
}

/// The end of a whirr in which each nod has slips from rest.
#[derive(Debug, Clone, Copy)]
pub(super) struct NodsEnd {
    pub time: f64,
    pub doubt: f64,
    /// The share of the remaining energy that becomes heat.
    pub heats: f64,
}

impl NodsEnd {
    /// Whether this estimate of the end is better than none, at the time `now`: its error is a small share of the
    /// remaining time.
    pub fn is_better_than_none(&self, now: f64) -> bool {
        self.doubt < BETTER_THAN_NONE * (self.time - now)
    }
}

/// The last slips from rest in a whirr, the latest first.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Nods {
    starts: [SlipStart; STARTS],
    count: usize,
}

impl Nods {
    /// Adds the beginning of a slip from rest at the sine `s` of theta.
    pub fn adds(&mut self, s: f64, start: SlipStart) {
        if s > SELF_SIMILAR_SINE || start.root == 0.0 {
            self.count = 0;
            return;
        }
        self.starts.rotate_right(1);
        self.starts[0] = start;
        self.count = (self.count + 1).min(STARTS);
    }

    /// The estimated end of the whirr, for the number of slips per nod with which the estimates agree best; None
    /// until some agree.
    pub fn end(&self) -> Option<NodsEnd> {
        if self.count < STARTS {
            return None;
        }
        let all = &self.starts;
        let falls = 1.0 - all[0].root / all[AGREE - 1].root;
        let by = |slips: usize| {
            let estimate = |i: usize| {
                let (now, before) = (&all[i], &all[i + slips]);
                now.time + (now.time - before.time) / (before.root / now.root - 1.0)
            };
            let [low, high] = (0..AGREE)
                .map(estimate)
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], end| [low.min(end), high.max(end)]);
            let (now, before) = (&all[0], &all[slips]);
            let [heat, lost] = [now.heat - before.heat, now.lost - before.lost];
            // A body that goes on to spin about the vertical does not come to rest.
            let spins = now.w3 - (before.w3 - now.w3) / (before.root / now.root - 1.0);
            let doubt = larger_or_nan(2.0 * (high - low) / falls, spins.abs());
            NodsEnd { time: estimate(0), doubt, heats: heat / (heat + lost) }
        };
        let ends = (1..=SLIPS).map(by).filter(|end| {
            // The error cannot exceed the time that is left.
            end.doubt >= 0.0 && end.doubt < end.time - all[0].time && (0.0..=1.0).contains(&end.heats)
        });
        ends.filter(|_| falls > 0.0).min_by(|a, b| a.doubt.total_cmp(&b.doubt))
    }
}

/// Whether the end of a whirr is known accurately enough, given the sum `erred` of the step errors, and is before the
/// next output at the time `until`.
pub(super) fn is_known([end, doubt]: [f64; 2], until: f64, erred: f64) -> bool {
    doubt < END_KNOWN.max(OF_STEP_ERRORS * erred) && end + doubt < until
}

/// The estimates of the end of a whirr that comes down by infinitely many turns.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LastTurns {
    /// The time and the cube root of p = w1 sin(theta) at the last point.
    last: Option<[f64; 2]>,
    /// The estimated time of the end, its difference from the estimate before, and its error.
    end: Option<[f64; 3]>,
}

impl LastTurns {
    /// Updates the estimates with a point of the motion: the time `t`, the sine `s` of theta, and w1.
    pub fn adds_point(&mut self, t: f64, s: f64, w1: f64) {
        let root = (w1 * s).abs().cbrt();
        if s > SELF_SIMILAR_SINE || root == 0.0 {
            *self = Self::default();
            return;
        }
        match self.last {
            Some([before, far]) if far >= LEAST_ROOT_RATIO * root => {
                let end = t + (t - before) / (far / root - 1.0);
                let moved = self.end.map_or(f64::INFINITY, |[other, ..]| (end - other).abs());
                // If each change is the same share of the previous one, all further changes are a geometric series.
                let share = self.end.map_or(1.0, |[_, other, _]| moved / other);
                let doubt = 2.0
                    * moved
                    * if share < 1.0 - 1.0 / FURTHER_CHANGES { 1.0 / (1.0 - share) } else { FURTHER_CHANGES };
                (self.last, self.end) = (Some([t, root]), Some([end, moved, doubt]));
            }
            Some([_, far]) if far >= root => {}
            // A face that rises again begins another whirr.
            _ => *self = Self { last: Some([t, root]), end: None },
        }
    }

    /// The estimated time of the end and its error; None before the second estimate.
    pub fn end(&self) -> Option<[f64; 2]> {
        // The error cannot exceed the remaining time until the estimated end.
        let left = |end: f64| self.last.map_or(f64::INFINITY, |[t, _]| end - t);
        self.end.map(|[end, _, doubt]| [end, doubt.min(left(end))]).filter(|[_, doubt]| doubt.is_finite())
    }

    /// The estimated time of the end and its error, if the error is small and the end is before `until`, or if the
    /// sine `s` of theta is below `ANY_END_SINE`; else None.
    pub fn known(&self, s: f64, until: f64) -> Option<[f64; 2]> {
        self.end().filter(|end| s < ANY_END_SINE || is_known(*end, until, 0.0))
    }
}
