//! The summary numbers of solved motions: extreme inclinations and forces, the period and the precession.
//!
//! The extreme inclinations follow from the turning points and the end of a motion. Along one motion the
//! forces depend on the inclination alone: they are computed between the start and the least, and between the
//! start and the greatest inclination. The period and the precession are those of the whole swing, even if
//! the motion ends before: a separate march goes to both turning points.

use super::march::forces_along;
use super::run::{MarchTask, Run, RunOutcome};
use super::set::{FEW, MarchKind};
use super::{Marches, RULES, SolvedRun, UNREACHABLE_SIDE};
use crate::many::motions::{MotionOutput, Summary};
use crate::motions::exact::lanes::march::{PanelEvent, Sought};
use crate::numbers::larger_or_nan;
use crate::numbers::side_by_side::SideBySide;

/// The motions of a block that marches have solved, with the arrays for their summaries.
pub(super) struct SolvedBlock<'a, 'b, 'c> {
    pub marches: &'a Marches<'b, 'c>,
    pub known: &'a [SolvedRun],
    pub kind: MarchKind,
}

impl SolvedBlock<'_, '_, '_> {
    /// Writes the requested summaries; returns the motions for which they do not reach the tolerance.
    pub fn run<T: SideBySide>(
        &self,
        like: T,
        out: &mut MotionOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Vec<usize> {
        use Summary::{FrictionCoefficientMax, NormalMin, Period, PrecessionPerPeriod, ThetaMax, ThetaMin};
        let wanted = |all: &[Summary]| all.iter().any(|x| out.wants(*x));
        let (inclinations, forces, whole) = (
            wanted(&[ThetaMin, ThetaMax]),
            wanted(&[NormalMin, FrictionCoefficientMax]),
            wanted(&[Period, PrecessionPerPeriod]),
        );
        if inclinations || forces {
            for of in self.known {
                let [low, high] = of.theta_range.get();
                out.put(ThetaMin, of.task.index, low);
                out.put(ThetaMax, of.task.index, high);
            }
            if forces {
                self.write_force_summary(like, out, go_on);
            }
        }
        if whole { self.write_period_summary(like, out, go_on) } else { Vec::new() }
    }

    fn write_force_summary<T: SideBySide>(
        &self,
        like: T,
        out: &mut MotionOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) {
        let ways = |(k, of): (usize, &SolvedRun)| {
            let ([low, high], task) = (of.theta_range.get(), of.task);
            [(1.0, high), (-1.0, low)]
                .into_iter()
                .filter(move |(way, _)| *way > 0.0 || low < task.start.theta)
                .map(move |(way, limit)| {
                    let mut run = Run::new(&MarchTask { side: limit.sin_cos().into(), way, ..task });
                    run.target.slot = k;
                    run
                })
        };
        let runs = self.known.iter().enumerate().flat_map(ways);
        let mut found = vec![[f64::INFINITY, f64::NEG_INFINITY]; self.known.len()];
        forces_along::<T, FEW>(like, self.kind, runs, go_on, |run, seen| {
            let [normal, friction] = &mut found[run.target.slot];
            (*normal, *friction) = (normal.min(seen.normal), friction.max(seen.friction));
        });
        for (of, [normal, mut friction]) in self.known.iter().zip(found) {
            // At lift-off the normal force vanishes, so that rolling would need infinite friction.
            if of.end.is_some_and(|end| end.comes == PanelEvent::LiftOff) {
                friction = f64::INFINITY;
            }
            out.put(Summary::NormalMin, of.task.index, normal);
            out.put(Summary::FrictionCoefficientMax, of.task.index, friction);
        }
    }

    /// Writes the period and the precession of each motion; returns the motions for which they do not reach
    /// the tolerance.
    fn write_period_summary<T: SideBySide>(
        &self,
        like: T,
        out: &mut MotionOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Vec<usize> {
        // The error of a motion includes those of period and precession.
        let (timed, turned) = (out.wants(Summary::Period), out.wants(Summary::PrecessionPerPeriod));
        let sought = Sought { ends: false, slips: false, turns: turned };
        let kind = MarchKind { sought, ..self.kind };
        let mut again: Vec<MarchTask> =
            self.known.iter().map(|of| MarchTask { side: UNREACHABLE_SIDE, ..of.task }).collect();
        for rule_index in 0..RULES.len() {
            let runs = core::mem::take(&mut again).into_iter().map(|task| Run::new(&task));
            self.marches.march_on(like, kind, (rule_index, Some(f64::INFINITY)), runs, go_on, |run, turn| {
                match turn {
                    RunOutcome::Free(free)
                        if free.errors(timed, turned) < self.marches.allowed(rule_index) =>
                    {
                        let i = run.task.index;
                        out.put(Summary::Period, i, free.period());
                        out.put(Summary::PrecessionPerPeriod, i, 2.0 * free.turn[0]);
                        out.error[i] = larger_or_nan(out.error[i], free.errors(timed, turned));
                    }
                    // A motion whose face lands has no period.
                    RunOutcome::There(_) => {
                        out.put(Summary::Period, run.task.index, f64::INFINITY);
                        out.put(Summary::PrecessionPerPeriod, run.task.index, f64::NAN);
                    }
                    _ => again.push(run.task),
                }
            });
        }
        again.iter().map(|task| task.index).collect()
    }
}
