//! A queue of marches for SIMD lanes: when a march is over, its lane takes the next march.

use super::run::{Run, RunOutcome};
use super::set::{MarchKind, PanelForces, RunLanes, extents, panels};
use crate::motions::exact::lanes::march::Rule;
use crate::numbers::side_by_side::{MOST, SideBySide};

/// Number of panels of all lanes that are computed between two calls of `go_on`.
const PANELS_PER_BREATH: usize = 64;

/// Computes panels of all marches until each march is over, or until `go_on` returns false.
fn advance_all<T: SideBySide, P: Copy>(
    runs: impl IntoIterator<Item = Run>,
    go_on: &mut dyn FnMut() -> bool,
    panels: impl Fn(&RunLanes<Run>, &mut RunLanes<P>),
    mut is_over: impl FnMut(&mut Run, &P) -> bool,
) {
    let mut queue = runs.into_iter();
    let mut lanes: RunLanes<Run> = [None; MOST];
    let mut met: RunLanes<P> = [None; MOST];
    for made in 1.. {
        for lane in &mut lanes[..T::COUNT] {
            if lane.is_none() {
                *lane = queue.next();
            }
        }
        if lanes.iter().all(Option::is_none) || (made % PANELS_PER_BREATH == 0 && !go_on()) {
            return;
        }
        panels(&lanes, &mut met);
        for (lane, met) in lanes.iter_mut().zip(&met) {
            let (Some(run), Some(met)) = (lane.as_mut(), met) else { continue };
            if is_over(run, met) {
                *lane = None;
            }
        }
    }
}

/// Computes all marches up to the time `span` of their clock, or to their targets if `span` is None; `tell` is called
/// with each march that is over and its outcome.
pub(super) fn march<T: SideBySide, const N: usize>(
    like: T,
    kind: MarchKind,
    rule: &Rule,
    span: Option<f64>,
    runs: impl IntoIterator<Item = Run>,
    go_on: &mut dyn FnMut() -> bool,
    mut tell: impl FnMut(&Run, RunOutcome),
) {
    advance_all::<T, _>(
        runs,
        go_on,
        |lanes, met| panels::<T, N>(like, kind, rule, lanes, met),
        |run, met| {
            let turn = run.advance(met, span.map(|span| span - run.task.since));
            let over = !matches!(turn, RunOutcome::On);
            if over {
                tell(run, turn);
            }
            over
        },
    );
}

/// Computes the forces along all marches, panel by panel; `tell` is called with each panel.
pub(super) fn forces_along<T: SideBySide, const N: usize>(
    like: T,
    kind: MarchKind,
    runs: impl IntoIterator<Item = Run>,
    go_on: &mut dyn FnMut() -> bool,
    mut tell: impl FnMut(&Run, &PanelForces),
) {
    advance_all::<T, _>(
        runs,
        go_on,
        |lanes, seen| extents::<T, N>(like, kind, lanes, seen),
        |run, seen| {
            tell(run, seen);
            run.passes(seen.knot) || seen.over
        },
    );
}
