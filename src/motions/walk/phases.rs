//! The differences between the computation of a motion of a body of revolution and of a stone.

use super::numbers::Halt;
use super::{Next, Pause, SlowLaw, SlowSeries, Walk, WalkStep};
use crate::error::Error;
use crate::laws::contact::standstill::Standstill;
use crate::methods::flow::Steps;
use crate::motions::{Ask, Ending, Kind, Moving, Phase};

/// The phases of motion of a body of revolution or of a stone, whose state vector has N components.
pub(crate) trait Phases<const N: usize>: Sized {
    type State: Moving;
    type Slow: SlowLaw<N>;
    /// Index of the slip's first component in the state vector; `HEAT` is that of the heat of friction.
    const SLIP: usize;
    const HEAT: usize;

    /// The tolerance of an integration step.
    fn tol(&self) -> f64;
    /// Whether the friction of a slip is dry.
    fn is_dry(&self) -> bool;
    /// The speed below which a slip counts as zero.
    fn over(&self) -> f64;
    /// Whether the energy that the loss laws take is among the outputs.
    fn loses(ask: &Ask) -> bool {
        !ask.losses.is_none()
    }

    /// The record of a phase of this kind that begins at the current state, in the components of the outputs.
    fn seen(walk: &Walk<'_, Self, N>, kind: Kind) -> Phase<Self::State>;
    /// Perturbs the current state by this share of its components.
    fn perturbs_by(walk: &mut Walk<'_, Self, N>, share: f64);
    /// Perturbs the current state, by more than rounding, in the run with the larger tolerance.
    fn perturbs(walk: &mut Walk<'_, Self, N>) {
        let share = walk.share_of_errors();
        Self::perturbs_by(walk, share);
    }
    /// Writes a point of a slip to the outputs.
    fn write(walk: &mut Walk<'_, Self, N>, y: &[f64; N]);
    /// Writes the current state, which is not on an integrated phase, to the outputs.
    fn write_here(walk: &mut Walk<'_, Self, N>);

    /// The reason for which a slip ends at its beginning; None if it does not.
    fn ends_slip(walk: &mut Walk<'_, Self, N>) -> Option<Halt>;
    /// The ending of a motion that is over at its start because an edge or the other rim lies on the table and does
    /// not rise; else None. `found` is the behaviour of the contact point, which is at rest.
    fn lies(walk: &mut Walk<'_, Self, N>, found: Standstill) -> Option<Ending>;
    /// The first phase without a law of friction.
    fn begins_without_slip(walk: &mut Walk<'_, Self, N>) -> Next;
    /// The behaviour of a contact point at rest, or of one that static friction has just ceased to hold.
    fn rests(walk: &Walk<'_, Self, N>) -> Standstill;
    fn lets_go(walk: &Walk<'_, Self, N>) -> Standstill;
    /// The error for an initial state without a unique contact force.
    fn no_unique_force(walk: &Walk<'_, Self, N>) -> Error;

    /// The normal force at the current state; negative where a table would have to pull the body down.
    fn normal_here(_: &Walk<'_, Self, N>) -> f64 {
        0.0
    }
    /// Tests the state between two phases; a physically impossible value is included in the estimated error.
    fn audits(_: &mut Walk<'_, Self, N>) {}
    /// Ends the motion before the next phase if its end is certain or, with `given_up` (the computation would stop
    /// here), if its end can be derived at all. Returns whether it has ended.
    fn is_over(_: &mut Walk<'_, Self, N>, _: &Next, _given_up: bool) -> bool {
        false
    }
    /// The phase after an ending past which a motion with restitution continues; otherwise the ending.
    fn goes_on(_: &mut Walk<'_, Self, N>, ending: Ending) -> Next {
        Next::Ends(ending)
    }
    /// Computes a phase that only this kind of body has, or begins its integration.
    fn goes(
        _: &mut Walk<'_, Self, N>,
        _: Kind,
        _: &mut dyn FnMut() -> bool,
    ) -> Result<Option<WalkStep<N>>, Error> {
        Ok(None)
    }
    /// The kind of phase in which a contact point slips from rest.
    fn slip_kind(_: &Walk<'_, Self, N>) -> Kind {
        Kind::Slipping
    }
    /// Computes a slip that has a closed form; returns false for any other slip.
    fn slips_known(_: &mut Walk<'_, Self, N>) -> bool {
        false
    }
    /// Begins a slip, or continues one. Returns the state vector at which its integration starts.
    fn slips(walk: &mut Walk<'_, Self, N>) -> [f64; N];
    fn slips_on(walk: &mut Walk<'_, Self, N>) -> [f64; N];
    /// The slip speed of the contact point or, if larger, that of the rim of its patch by drilling.
    fn rubbing(walk: &Walk<'_, Self, N>) -> f64 {
        walk.at[Self::SLIP].hypot(walk.at[Self::SLIP + 1])
    }
    /// Whether a slip from rest has a power series.
    fn begins_slowly(_: &Walk<'_, Self, N>) -> bool {
        true
    }
    /// Whether the current phase is a slip whose integration a power series may replace where it is slow.
    fn has_series(walk: &Walk<'_, Self, N>) -> bool;
    /// Makes a contact point at rest slip along `way`.
    fn lets_slip(walk: &mut Walk<'_, Self, N>, way: [f64; 2]);
    /// The power series of slow slips, with which a slip from rest begins.
    fn slow(walk: &Walk<'_, Self, N>) -> Self::Slow;
    /// Whether the known series are those of slow slips under the current law, so that the law need not be recorded
    /// again.
    fn is_slow(_: &Walk<'_, Self, N>, _: &Self::Slow) -> bool {
        false
    }
    /// The time since the start of a series up to which the conditions of the slip hold, at most the duration of the
    /// series.
    fn clear_until(walk: &Walk<'_, Self, N>, series: &SlowSeries<N>) -> f64;
    /// The state vector at the time `MOMENT` after the beginning of a slip along `way`, whose speed grows at the rate
    /// `growth`. Used where no series exists.
    fn nudged(walk: &mut Walk<'_, Self, N>, way: [f64; 2], growth: f64) -> [f64; N];
    /// Evaluates a slow slip along its series up to a time since the beginning of the series, to count reversals of the
    /// spin.
    fn passed(_: &Walk<'_, Self, N>, _: &SlowSeries<N>, _: f64) {}
    /// Computes a rolling phase up to its event, or begins its integration.
    fn rolls(
        walk: &mut Walk<'_, Self, N>,
        at_limit: bool,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<WalkStep<N>>, Error>;
    /// The length of the first integration step from the state vector `y`.
    fn first(walk: &Walk<'_, Self, N>, y: &[f64; N]) -> f64;
    /// Integrates the current phase.
    fn flows(
        walk: &mut Walk<'_, Self, N>,
        y: [f64; N],
        steps: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error>;
    /// Ends a slip at the state vector `y`, and chooses the next phase.
    fn slip_halts(walk: &mut Walk<'_, Self, N>, y: [f64; N], halt: Halt);
    /// Whether the condition whose zero caused this halt was already zero where the current phase began.
    fn leaves_margin(_: &Walk<'_, Self, N>, _: Halt) -> bool {
        false
    }
    /// The factor by which the error of the function whose zero causes this halt exceeds that of the state; None for
    /// a halt without such a function.
    fn grows(&self, halt: Halt, y: &[f64; N]) -> Option<f64>;
}
