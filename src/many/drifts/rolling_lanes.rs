//! Drifts of rolling bodies in SIMD lanes; a lane whose drift has ended takes the next drift.
//!
//! A lane computes its drift up to the step in which the drift may end. That step is taken outside the lanes, as for a
//! single drift, and locates the end. A drift that does not end in that step enters a lane once more.

use super::columns::{DriftOutput, DriftRow, DriftStarts};
use crate::error::Error;
use crate::laws::body::Shape;
use crate::laws::loss::{COUNT, Couples};
use crate::laws::state::State;
use crate::methods::flow::Spent;
use crate::methods::flow::lanes::{Entry, Flows, LaneStatus, NUMBERS};
use crate::methods::flow::schedule::{STEPS_ALONE, Waiting, follow};
use crate::methods::rk8;
use crate::motions::drift::circular::{CirclePoint, Circular, Numbers};
use crate::motions::drift::rolling::{
    self, COUNTED_FROM_PI_ABOVE, DRIFT_NUMBERS, MOST_DRIFT_STEPS, Margins, Rolling, STEPS, counted, error,
    until_tail,
};
use crate::numbers::in_lanes;
use crate::numbers::side_by_side::{MOST as LANES, SideBySide, zero};
use fearless_simd::Level;

/// Number of margins in a SIMD lane: those of a single drift; the margin for the beginning of the tail or the end of
/// the precession; and the inclination at which theta is counted from the other end of [0, pi].
const DRIFT_MARGINS: usize = rolling::DRIFT_MARGINS + 2;

const _: () = assert!(4 + COUNT + DRIFT_NUMBERS <= NUMBERS);

/// The properties that all drifts in a set of SIMD lanes share.
#[derive(Clone, Copy, PartialEq)]
struct DriftKind {
    round: bool,
    present: [bool; COUNT],
}

#[derive(Clone, Copy)]
struct DriftLanes<T> {
    of: Circular<T>,
    margins: Margins<T>,
    start: Numbers<T>,
    far: T,
    kind: DriftKind,
}

impl<T: SideBySide> DriftLanes<T> {
    /// Placeholder bodies for SIMD lanes without a drift.
    #[inline(always)]
    fn new(zero: T, kind: DriftKind) -> Self {
        let one = zero.splat(1.0);
        let couples = Couples::among([zero; COUNT], kind.present, None);
        let of = Circular::new(&Shape::of([zero, one, one, zero]), kind.round, couples);
        let margins = Margins::of(&[zero; COUNT], one, one);
        Self { of, margins, start: [one; 4], far: one, kind }
    }
}

impl<T: SideBySide> Flows<T, 4, DRIFT_MARGINS> for DriftLanes<T> {
    type Seen = CirclePoint<T>;
    const LOOPS: bool = true;

    #[inline(always)]
    fn of(numbers: &[T; NUMBERS], like: &Self) -> Self {
        let [ell, i1, i3, fillet, rest @ ..] = *numbers;
        let kind = like.kind;
        let (mut coefficients, mut others) = ([ell; COUNT], [ell; DRIFT_NUMBERS]);
        coefficients.copy_from_slice(&rest[..COUNT]);
        others.copy_from_slice(&rest[COUNT..COUNT + DRIFT_NUMBERS]);
        let [runs, drills, theta, rate, w3, far, side] = others;
        let couples = Couples::among(coefficients, kind.present, None);
        let mut of = Circular::new(&Shape::of([ell, i1, i3, fillet]), kind.round, couples);
        of.signs = [runs, drills];
        let margins = Margins::of(&coefficients, side, theta);
        let start = [theta, rate, w3, ell.splat(0.0)];
        Self { of, margins, start, far, kind }
    }

    #[inline(always)]
    fn rates(&self, y: &Numbers<T>, rate: &mut Numbers<T>) -> CirclePoint<T> {
        let known = self.of.at(y, self.far);
        *rate = known.rates;
        known
    }

    #[inline(always)]
    fn margins(&self, y: &Numbers<T>, seen: &CirclePoint<T>) -> [T; DRIFT_MARGINS] {
        let [kappa, side, runs, drills] = self.margins.all(seen, counted(y[0], self.far));
        let goes_on = until_tail(y, &seen.rates, self.margins.last)
            .min(self.margins.until_turning_stops(y, &seen.rates));
        [kappa, side, runs, drills, goes_on, y[0].splat(COUNTED_FROM_PI_ABOVE) - y[0]]
    }

    #[inline(always)]
    fn error(&self, _: T, y: &Numbers<T>, made: &rk8::Step<T, 4>) -> T {
        error(&self.start, y, made)
    }

    #[inline(always)]
    fn kept(&self, y: Numbers<T>) -> Numbers<T> {
        self.of.kept(&y, self.far)
    }

    #[inline(always)]
    fn fastest(&self, y: &Numbers<T>) -> T {
        y[0].splat(1.0)
    }

    #[inline(always)]
    fn calm(&self, y: &Numbers<T>) -> T {
        y[0].splat(f64::INFINITY)
    }

    #[inline(always)]
    fn shortest(&self, y: &Numbers<T>) -> T {
        rolling::shortest(y[0])
    }

    #[inline(always)]
    fn longest(&self, y: &Numbers<T>, _: &Numbers<T>) -> T {
        y[0].splat(STEPS[1])
    }
}

/// A drift that waits for a SIMD lane or is in one: its index, and the number of steps that it may still take.
struct DriftTask {
    i: usize,
    of: Rolling<'static>,
    y: Numbers<f64>,
    step: f64,
    left: u64,
}

/// The drifts of a block that are of one kind, with their results.
struct Drifts<'a, 'b, 'c> {
    starts: &'a DriftStarts<'b>,
    rows: core::slice::Iter<'a, usize>,
    /// The index of the first drift of the block.
    first: usize,
    out: &'a mut DriftOutput<'c>,
    unfinished: Vec<DriftTask>,
    in_lanes_now: [Option<DriftTask>; LANES],
    go_on: &'a mut dyn FnMut() -> bool,
}

impl Drifts<'_, '_, '_> {
    fn next(&mut self) -> Option<DriftTask> {
        loop {
            let i = *self.rows.next()?;
            match begin(&self.starts.row(i)) {
                Ok((of, y)) => return Some(DriftTask { i, of, y, step: STEPS[0], left: MOST_DRIFT_STEPS }),
                Err(_) => self.out.refuse(i - self.first),
            }
        }
    }

    /// Computes a drift for some steps without SIMD lanes; a drift that does not end in these steps waits for another lane.
    fn compute_without_lanes(&mut self, mut task: DriftTask, most: u64) {
        let i = task.i - self.first;
        match task.of.follow(task.y, Some(task.step), most.min(task.left)) {
            Ok(flown) => match task.of.ended(&flown) {
                Some((end, _)) => self.out.put(i, end),
                None if task.left > most => {
                    (task.y, task.step, task.left) = (flown.y, flown.step, task.left - most);
                    self.unfinished.push(task);
                }
                None => self.out.refuse(i),
            },
            Err(_) => self.out.refuse(i),
        }
    }
}

impl Waiting<4, DRIFT_MARGINS> for Drifts<'_, '_, '_> {
    fn enter(&mut self, k: usize) -> Option<Entry<4, DRIFT_MARGINS>> {
        let task = self.unfinished.pop().or_else(|| self.next())?;
        let row = self.starts.row(task.i);
        let [ell, i1, i3, _, fillet, _] = row.body;
        let mut numbers = [0.0; NUMBERS];
        numbers[..4].copy_from_slice(&[ell, i1, i3, fillet]);
        numbers[4..4 + COUNT].copy_from_slice(&row.losses.coefficients);
        numbers[4 + COUNT..][..DRIFT_NUMBERS].copy_from_slice(&task.of.numbers());
        let (y, step, patience) = (task.y, task.step, task.left);
        self.in_lanes_now[k] = Some(task);
        Some(Entry { y, step, numbers, tol: 1.0, until: f64::INFINITY, patience, made: 0 })
    }

    fn leave(&mut self, k: usize, _: LaneStatus, (y, step): (Numbers<f64>, f64), spent: Spent) {
        if let Some(task) = self.in_lanes_now[k].take() {
            self.compute_without_lanes(DriftTask { y, step, left: spent.patience, ..task }, STEPS_ALONE);
        }
    }

    fn go_on(&mut self) -> bool {
        (self.go_on)()
    }
}

fn begin(row: &DriftRow) -> Result<(Rolling<'static>, Numbers<f64>), Error> {
    let body = row.body()?;
    crate::motions::drift::check_drift(&body, &row.losses)?;
    Rolling::begin(&body, &State::from(row.state), &row.losses)
}

/// Computes the ends of the drifts from `first` on, for all rows of `out`. Only drifts under the same laws share a set
/// of SIMD lanes: a law with the coefficient 0 would not change a drift, but its rates may overflow.
pub(crate) fn rolling_stops(
    level: Option<Level>,
    starts: &DriftStarts<'_>,
    first: usize,
    out: &mut DriftOutput<'_>,
    go_on: &mut dyn FnMut() -> bool,
) {
    let mut kinds: Vec<(DriftKind, Vec<usize>)> = Vec::new();
    for i in first..first + out.ended.len() {
        let present = starts.row(i).losses.coefficients.map(|x| x != 0.0);
        let kind = DriftKind { round: starts.is_rounded(i), present };
        match kinds.iter_mut().find(|(of, _)| *of == kind) {
            Some((_, rows)) => rows.push(i),
            None => kinds.push((kind, vec![i])),
        }
    }
    for (kind, rows) in kinds {
        let (in_lanes_now, unfinished) = ([const { None }; LANES], Vec::new());
        let mut all = Drifts { starts, rows: rows.iter(), first, out, unfinished, in_lanes_now, go_on };
        in_lanes!(
            level,
            simd => {
                let like = zero(simd);
                follow(like, DriftLanes::new(like, kind), &mut all);
            },
            else while let Some(task) = all.next() {
                if !all.go_on() {
                    return;
                }
                all.compute_without_lanes(task, MOST_DRIFT_STEPS);
            }
        );
    }
}
