//! A queue of marches on so many lanes: a lane whose march is over takes up the next.

use super::super::side_by_side::{MOST, SideBySide};
use super::run::{Run, RunOutcome};
use super::set::{MarchKind, PanelForces, RunLanes, extents, panels};
use crate::exact::lanes::march::Rule;

/// Panels of a set of lanes between two looks at whether to go on.
const PATIENCE: usize = 64;

/// Takes a panel of all runs again and again, until each of them is over. Stops if it is told to.
fn queue<T: SideBySide, P: Copy>(
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
        if lanes.iter().all(Option::is_none) || (made % PATIENCE == 0 && !go_on()) {
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

/// Marches all runs, up to `span` but to their targets where these are sought; each that is over is told, with what became
/// of it.
pub(super) fn march<T: SideBySide, const N: usize>(
    like: T,
    kind: MarchKind,
    rule: &Rule,
    span: Option<f64>,
    runs: impl IntoIterator<Item = Run>,
    go_on: &mut dyn FnMut() -> bool,
    mut tell: impl FnMut(&Run, RunOutcome),
) {
    queue::<T, _>(
        runs,
        go_on,
        |lanes, met| panels::<T, N>(like, kind, rule, lanes, met),
        |run, met| {
            let turn = run.advance(met, span);
            let over = !matches!(turn, RunOutcome::On);
            if over {
                tell(run, turn);
            }
            over
        },
    );
}

/// Looks at the forces on all ways, panel by panel; each panel is told.
pub(super) fn look<T: SideBySide, const N: usize>(
    like: T,
    kind: MarchKind,
    runs: impl IntoIterator<Item = Run>,
    go_on: &mut dyn FnMut() -> bool,
    mut tell: impl FnMut(&Run, &PanelForces),
) {
    queue::<T, _>(
        runs,
        go_on,
        |lanes, seen| extents::<T, N>(like, kind, lanes, seen),
        |run, seen| {
            tell(run, seen);
            run.passes(seen.knot) || seen.over
        },
    );
}
