//! What the phases of a body of revolution and those of a stone have of their own.

use super::{Next, Pause, SlowLaw, SlowSeries, Walk, WalkStep};
use crate::error::Error;
use crate::laws::contact::standstill::Standstill;
use crate::methods::flow::Steps;
use crate::motions::halt::Halt;
use crate::motions::{Ending, Moving};

/// The phases of a body of revolution or of a stone, whose motion has N numbers.
pub(crate) trait Phases<const N: usize>: Sized {
    type State: Moving;
    type Slow: SlowLaw<N>;
    /// The places of the slip and of the heat among the numbers.
    const SLIP: usize;
    const HEAT: usize;

    /// The tolerance of the steps.
    fn tol(&self) -> f64;
    /// Whether the friction of a slip is dry.
    fn is_dry(&self) -> bool;
    /// The speed below which a slip counts as zero.
    fn over(&self) -> f64;

    /// The state at the present numbers.
    fn state(walk: &Walk<'_, Self, N>) -> Self::State;
    /// The slip at the present numbers, as a user sees it.
    fn slip(walk: &Walk<'_, Self, N>) -> [f64; 2];
    /// Moves the state of a rougher run at the end of a phase by more than rounding does.
    fn shake(walk: &mut Walk<'_, Self, N>);
    /// Writes a point of a slip.
    fn write(walk: &mut Walk<'_, Self, N>, y: &[f64; N]);
    /// Writes the present point, at which no flow has written.
    fn write_here(walk: &mut Walk<'_, Self, N>);

    /// What ends a slip at its start.
    fn ends_slip(walk: &mut Walk<'_, Self, N>) -> Option<Halt>;
    /// The ending of a body whose contact point rests, by an edge or the other rim that lies on the table at the start.
    fn lies(walk: &mut Walk<'_, Self, N>, found: Standstill) -> Option<Ending>;
    /// The first phase on a table without friction of a slip.
    fn begins_without_slip(walk: &mut Walk<'_, Self, N>) -> Next;
    /// The behaviour of a contact point at rest, and of one that static friction has just ceased to hold.
    fn rests(walk: &Walk<'_, Self, N>) -> Standstill;
    fn lets_go(walk: &Walk<'_, Self, N>) -> Standstill;
    /// The error of a start without a unique contact force.
    fn jam(walk: &Walk<'_, Self, N>) -> Error;

    /// Ends a motion that no further phase would change. Returns whether it has ended.
    fn is_over(_: &mut Walk<'_, Self, N>, _: &Next) -> bool {
        false
    }
    /// The end of a motion with too many phases, of which `count` are counted.
    fn gives_up(walk: &Walk<'_, Self, N>, count: usize) -> Result<Next, Error>;
    /// Begins a slip, or goes on with one. Returns the numbers of its flow.
    fn slips(walk: &mut Walk<'_, Self, N>) -> [f64; N];
    fn slips_on(walk: &mut Walk<'_, Self, N>) -> [f64; N];
    /// The law of slow slips, by which a slip from rest along `way` begins.
    fn slow(walk: &mut Walk<'_, Self, N>, way: [f64; 2]) -> Self::Slow;
    /// The time up to which a series of the numbers may be used, at most `until`: before any end of the slip.
    fn clear_until(walk: &Walk<'_, Self, N>, series: &SlowSeries<N>) -> f64;
    /// The numbers a moment after a slip along `way` began whose speed grows at the rate `growth`, where no series exists.
    fn nudged(walk: &Walk<'_, Self, N>, way: [f64; 2], growth: f64) -> [f64; N];
    /// Looks at a part of a slow slip, up to a time since its start.
    fn passed(_: &Walk<'_, Self, N>, _: &SlowSeries<N>, _: f64) {}
    /// Rolls to an event, or begins the flow of a rolling phase.
    fn rolls(
        walk: &mut Walk<'_, Self, N>,
        grace: bool,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<WalkStep<N>>, Error>;
    /// The first step of a flow.
    fn first(walk: &Walk<'_, Self, N>, y: &[f64; N]) -> f64;
    /// Follows the flow of the present phase.
    fn flows(
        walk: &mut Walk<'_, Self, N>,
        y: [f64; N],
        steps: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error>;
    /// Ends a slip at the numbers `y`, and chooses the next phase.
    fn slip_halts(walk: &mut Walk<'_, Self, N>, y: [f64; N], halt: Halt);
    /// The factor by which the error of the margin of a halt exceeds that of the numbers; None of a halt without a margin.
    fn grows(&self, halt: Halt, y: &[f64; N]) -> Option<f64>;
}
