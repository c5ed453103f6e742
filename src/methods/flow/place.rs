//! The points of a flow, its result, its cost, and the limits of its steps.

use crate::methods::rk8;

/// A point of a flow: its variables, the rounding errors carried along, and the rates of the variables.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FlowPlace<const N: usize> {
    pub y: [f64; N],
    pub carry: [f64; N],
    pub rate: [f64; N],
}

/// A step that is taken from a point: its length in sigma, and the rates at its stages.
pub(crate) type TakenStep<'a, const N: usize> = (&'a FlowPlace<N>, f64, &'a rk8::Stages<f64, N>);

/// The result of a flow: its halt, and the variables and steps at its end.
pub(crate) struct Flown<H, const N: usize> {
    pub halt: H,
    /// The variables at the end of the flow.
    pub y: [f64; N],
    /// The length of the step that would follow, in sigma.
    pub step: f64,
    /// The rate, in time, at which the margin or speed fell whose zero ended the flow; infinite for other ends.
    pub steep: f64,
    pub spent: Spent,
}

/// The reason for which a flow stops before any of its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Exhausted {
    /// The flow has taken the largest number of evaluations.
    Evaluations,
    /// Too many steps have crawled, that is, hardly advanced the time.
    Crawling,
    /// The next step would be so short that rounding swallows it, or is NaN.
    Rounding,
    /// The caller has interrupted the flow.
    Interrupted,
}

/// The cost of a flow.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spent {
    pub evaluations: u64,
    /// The sum of the estimated errors of all steps, in units of the tolerance.
    pub erred: f64,
    /// Number of crawling steps that the motion may still take.
    pub patience: u64,
    /// The reason for which the flow stopped before any of its ends; None if it did not.
    pub exhausted: Option<Exhausted>,
}

/// The limits of the steps of a flow.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Steps {
    /// The length of the first step, if it is known.
    pub first: Option<f64>,
    /// Largest number of steps before the flow pauses.
    pub most: u64,
    /// Largest number of crawling steps, which hardly advance the time.
    pub patience: u64,
    /// Largest number of evaluations of the rates.
    pub toil: u64,
    /// Whether [`Flow::stuck`](super::Flow::stuck) is called before the first step, since the steps before this flow crawled.
    pub tired: bool,
}
