//! Marches in SIMD lanes: one panel of each march at a time.

use super::run::{PanelOutcome, Run};
use crate::laws::body::Shape;
use crate::laws::contact::Contact;
use crate::laws::contact::reduced::Reduced;
use crate::motions::exact::lanes::march::{Extent, Knot, March, Met, PanelEvent, Rule, Sought};
use crate::numbers::side_by_side::{MOST, SideBySide, apart};

/// The properties that all marches of a set share.
#[derive(Clone, Copy)]
pub(super) struct MarchKind {
    pub contact: Contact,
    /// Whether the rims are rounded, which is the same for all of the bodies.
    pub round: bool,
    pub sought: Sought,
}

/// Marches in SIMD lanes, or one result for each lane; a lane may be empty.
pub(super) type RunLanes<R> = [Option<R>; MOST];

/// The extremes of the forces in a panel, whether the march ends in it, and the state at the end of the panel.
#[derive(Debug, Clone, Copy)]
pub(super) struct PanelForces {
    pub normal: f64,
    pub friction: f64,
    pub over: bool,
    pub knot: Knot<f64>,
}

/// Numbers of terms of the series in the first march (`FEW`) and in its repetitions (`MANY`).
pub(super) const FEW: usize = 32;
pub(super) const MANY: usize = 56;

/// Number of inputs of a march, and greatest number of its outputs.
const MARCH_INPUTS: usize = 16;
const MARCH_OUTPUTS: usize = 15;
type Rows<const N: usize> = [[f64; MOST]; N];

/// The inputs of the marches in rows; a SIMD lane without a march repeats another march. None if no lane has a march.
fn gather_inputs(runs: &RunLanes<Run>, count: usize) -> Option<Rows<MARCH_INPUTS>> {
    let mut rows = [[0.0; MOST]; MARCH_INPUTS];
    let spare = runs.iter().flatten().next()?;
    for k in 0..count {
        let run = runs[k].as_ref().unwrap_or(spare);
        let Knot { theta, sin, cos, w1, w3, force, doubt } = run.knot;
        let [ell, i1, i3, fillet] = run.task.shape;
        let [sin_side, cos_side] = run.task.side;
        let (left, mu_square) = (run.target.time - run.time, run.task.mu_square);
        let body = [ell, i1, i3, fillet, sin_side, cos_side, mu_square];
        let place = [theta, sin, cos, w1, w3, force, doubt, run.way, left];
        for (row, x) in rows.iter_mut().zip(body.into_iter().chain(place)) {
            row[k] = x;
        }
    }
    Some(rows)
}

/// The inputs in SIMD lanes: the march, the state at the start of its panel, its direction and the time that is left to
/// the target.
#[inline(always)]
fn load_inputs<T: SideBySide>(
    like: T,
    kind: MarchKind,
    rows: &Rows<MARCH_INPUTS>,
) -> (March<T>, Knot<T>, T, T) {
    let shape =
        Shape::of([like.load(&rows[0]), like.load(&rows[1]), like.load(&rows[2]), like.load(&rows[3])]);
    let march = March {
        law: Reduced::of(kind.contact, &shape, kind.round),
        side: [like.load(&rows[4]), like.load(&rows[5])],
        mu_square: like.load(&rows[6]),
    };
    let knot = Knot {
        theta: like.load(&rows[7]),
        sin: like.load(&rows[8]),
        cos: like.load(&rows[9]),
        w1: like.load(&rows[10]),
        w3: like.load(&rows[11]),
        force: like.load(&rows[12]),
        doubt: like.load(&rows[13]),
    };
    (march, knot, like.load(&rows[14]), like.load(&rows[15]))
}

/// Writes outputs in SIMD lanes into rows.
#[inline(always)]
fn unload_outputs<T: SideBySide, const N: usize>(all: [T; N], rows: &mut Rows<MARCH_OUTPUTS>) {
    for (row, x) in rows.iter_mut().zip(&all) {
        for (k, cell) in row.iter_mut().enumerate().take(T::COUNT) {
            *cell = x.lane(k);
        }
    }
}

/// The state in SIMD lane `k` at the end of a panel, from seven rows of numbers.
fn knot(rows: &[[f64; MOST]], k: usize) -> Knot<f64> {
    let at = |i: usize| rows[i][k];
    Knot { theta: at(0), sin: at(1), cos: at(2), w1: at(3), w3: at(4), force: at(5), doubt: at(6) }
}

/// The outputs of the computation `kernel` for all SIMD lanes; None if no lane has a march.
#[inline(always)]
fn run_kernel<T: SideBySide, const M: usize>(
    like: T,
    kind: MarchKind,
    runs: &RunLanes<Run>,
    kernel: impl FnOnce(&March<T>, &Knot<T>, T, T) -> [T; M],
) -> Option<Rows<MARCH_OUTPUTS>> {
    let rows = gather_inputs(runs, T::COUNT)?;
    let mut found = [[0.0; MOST]; MARCH_OUTPUTS];
    apart(
        like,
        #[inline(always)]
        || {
            let (march, knot, way, left) = load_inputs(like, kind, &rows);
            unload_outputs(kernel(&march, &knot, way, left), &mut found);
        },
    );
    Some(found)
}

/// Computes one panel of each march, with series of `N` terms.
#[inline(never)]
pub(super) fn panels<T: SideBySide, const N: usize>(
    like: T,
    kind: MarchKind,
    rule: &Rule,
    runs: &RunLanes<Run>,
    out: &mut RunLanes<PanelOutcome>,
) {
    let found = run_kernel(
        like,
        kind,
        runs,
        #[inline(always)]
        |march, knot, way, left| {
            let Met { code, time, late, off, rate, tilt, turn: [turn, turn_off], knot } =
                march.panel::<N>(rule, knot, way, left, kind.sought);
            let Knot { theta, sin, cos, w1, w3, force, doubt } = knot;
            [code, time, late, off, rate, tilt, turn, turn_off, theta, sin, cos, w1, w3, force, doubt]
        },
    );
    let Some(found) = found else { return };
    for (k, out) in out.iter_mut().enumerate().take(T::COUNT) {
        let at = |i: usize| found[i][k];
        *out = runs[k].as_ref().map(|_| PanelOutcome {
            comes: PanelEvent::of(at(0)),
            time: at(1),
            late: at(2),
            off: at(3),
            rate: at(4),
            tilt: at(5),
            turn: [at(6), at(7)],
            knot: knot(&found[8..], k),
        });
    }
}

/// Computes the extremes of the forces in one panel of each march, with series of `N` terms.
#[inline(never)]
pub(super) fn extents<T: SideBySide, const N: usize>(
    like: T,
    kind: MarchKind,
    runs: &RunLanes<Run>,
    out: &mut RunLanes<PanelForces>,
) {
    let found = run_kernel(
        like,
        kind,
        runs,
        #[inline(always)]
        |march, knot, way, _| {
            let Extent { normal, friction, over, knot } = march.extent::<N>(knot, way);
            let Knot { theta, sin, cos, w1, w3, force, doubt } = knot;
            [normal, friction, over, theta, sin, cos, w1, w3, force, doubt]
        },
    );
    let Some(found) = found else { return };
    for (k, out) in out.iter_mut().enumerate().take(T::COUNT) {
        let at = |i: usize| found[i][k];
        *out = runs[k].as_ref().map(|_| PanelForces {
            normal: at(0),
            friction: at(1),
            over: at(2) > 0.0,
            knot: knot(&found[3..], k),
        });
    }
}
