//! Motions under a law of friction that roll from the start to the end: by the first integrals, in SIMD lanes.
//!
//! ```text
//! static friction is never exceeded, and no other part of the body lands:   the rolling motion
//! the body slips, or leaves the table:                                      integration by steps (`flows`)
//! ```
//! Whether a motion reaches the limit of static friction is decided along the first integrals, as for rolling with a
//! largest coefficient of friction. The result has the same estimated error as that motion.

use super::Summary::{
    AirTime, AxisUp, Dissipated, FrictionCoefficientMax, Impacts, Landings, LastPhase, LostInImpacts,
    NormalMin, Period, Phases, PrecessionPerPeriod, RestsOn, RollingTheta, RollingTime, RollingW1, RollingW2,
    RollingW3, SlipTime, ThetaMax, ThetaMin, WorkLost,
};
use super::walks::Walks;
use super::{Job, MotionBlock, MotionOutput, MotionStarts, Summary};
use crate::error::Error;
use crate::laws::body::{Body, Shape};
use crate::laws::contact::slip::Friction;
use crate::laws::contact::standstill::is_certain;
use crate::laws::contact::{Contact, Table};
use crate::laws::state::State;
use crate::many::columns::at;
use crate::motions::ask::rests_on::rolled_rests_on;
use crate::motions::body::BodyWalk;
use crate::motions::walk::Pause;
use crate::motions::walk::numbers::TIME;
use crate::motions::{Ending, Event, Kind, Motion};
use fearless_simd::Level;

/// A phase of rolling among other phases may have this share of the tolerance, and at most `ROLLING_ERROR`, as its
/// error, since later phases may make it grow.
const ROLLING_ERROR_SHARE: f64 = 0.01;
const ROLLING_ERROR: f64 = 2e-12;
/// The ends of a phase of rolling at which the state is precise enough for the phase that follows.
const ENDINGS: [Ending; 3] = [Ending::Done, Ending::Slip, Ending::Side];

/// Whether phases of rolling on this table may be computed in SIMD lanes, where the coefficient of static friction is squared.
pub(super) fn can_roll_in_lanes(table: &Table) -> bool {
    table.contact() == Contact::Rolling && (!table.rubs() || (table.mu() * table.mu()).is_finite())
}

impl MotionBlock<'_> {
    /// Computes those of the motions `some` of a block that roll from the start to the end; returns the others.
    pub(super) fn roll_throughout(
        &self,
        level: Option<Level>,
        rows: Vec<usize>,
        out: &mut MotionOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Vec<usize> {
        let job = self.job.of_rolling();
        let work = MotionBlock { job: &job, ..*self };
        if level.is_none() || job.ask.stop_at_rolling || job.ask.beyond {
            return rows;
        }
        let (rolling, mut others): (Vec<usize>, Vec<usize>) =
            rows.into_iter().partition(|i| work.may_roll(*i));
        let count = out.status.len();
        let mut ends = [(); 4].map(|()| vec![f64::NAN; if out.last.is_none() { count } else { 0 }]);
        let mut out = out.reborrowed();
        out.last = out.last.or(Some(ends.each_mut().map(Vec::as_mut_slice)));
        let mut unsolved = work.run(level, rolling.clone(), &mut out, go_on).into_iter().peekable();
        for i in rolling {
            if unsolved.next_if_eq(&i).is_some() || !work.add_single_phase(i, &mut out) {
                others.push(i);
            }
        }
        others.sort_unstable();
        others
    }

    /// Whether motion `i` begins to roll if static friction suffices, and whether the first integrals describe its
    /// rolling. Motions in a vertical plane, and those of balls, are computed phase by phase.
    fn may_roll(&self, i: usize) -> bool {
        let (starts, row) = (self.starts, self.first + i);
        let [ell, i1, i3, fillet] = core::array::from_fn(|k| at(starts.bodies[k], row));
        let y = starts.state(row);
        let glides = starts.slips.is_some_and(|all| all.iter().any(|x| at(x, row) != 0.0));
        let other = starts.aloft.is_some() || !starts.losses(row).is_none();
        if glides
            || other
            || y.theta == 0.0
            || y.w1 == 0.0 && y.w3 == 0.0
            || fillet == 1.0
            || starts.has_row(row)
            || starts.is_down(row)
        {
            return false;
        }
        match self.job.table(starts.coefficients(row)) {
            Table::Rolling { .. } => true,
            Table::Rubs(friction @ Friction::Coulomb { mu, fixed, patch }) => {
                let point = friction.check().is_ok() && patch == 0.0 && (fixed * fixed).is_finite();
                point && is_certain(&Shape::of([ell, i1, i3, fillet]), &y, mu)
            }
            _ => false,
        }
    }

    /// Adds the results that a motion with phases has to those of a solved motion of one phase; returns false if it has
    /// more phases.
    fn add_single_phase(&self, i: usize, out: &mut MotionOutput<'_>) -> bool {
        let ending = if out.status[i] == Ending::Side as u8 { Ending::Side } else { Ending::Done };
        if out.status[i] != ending as u8 || ending == Ending::Side && self.job.ask.restitution.is_some() {
            return false;
        }
        let start = self.starts.state(self.first + i);
        let last = out.last.as_ref().map_or([f64::NAN; 4], |all| all.each_ref().map(|x| x[i]));
        let last = State::from(last);
        out.put_rolling(i, self.job.times.len());
        for absent in [ThetaMin, ThetaMax, NormalMin, FrictionCoefficientMax, Period, PrecessionPerPeriod] {
            out.put(absent, i, f64::NAN);
        }
        for none in [SlipTime, Dissipated, WorkLost, Impacts, Landings, AirTime, LostInImpacts, RollingTime] {
            out.put(none, i, 0.0);
        }
        out.put(Phases, i, 1.0);
        out.put(LastPhase, i, f64::from(Kind::Rolling as u8));
        let begins = [RollingTheta, RollingW1, RollingW2, RollingW3];
        begins.into_iter().zip(<[f64; 4]>::from(start)).for_each(|(column, x)| out.put(column, i, x));
        out.put(AxisUp, i, last.axis_up(0));
        if out.wants(RestsOn)
            && let Ok(body) = self.starts.body(self.first + i)
        {
            out.put(RestsOn, i, f64::from(rolled_rests_on(&body, last, ending) as u8));
        }
        true
    }

    /// Computes the phases of rolling for which motions wait, side by side, and continues these motions.
    pub(super) fn roll_phases_in_lanes<const N: usize>(
        &self,
        level: Option<Level>,
        all: &mut Walks<'_, N>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), Error> {
        let waiting = core::mem::take(&mut all.rolls);
        let walks: Vec<_> = waiting.iter().filter_map(|(i, _)| all.walks[*i].as_ref().ok()).collect();
        let (count, times) = (walks.len(), self.job.times.len());
        let column =
            |f: &dyn Fn(&BodyWalk<'_, N>) -> f64| -> Vec<f64> { walks.iter().map(|x| f(x)).collect() };
        let numbers = [Body::ell, Body::i1, Body::i3, Body::fillet, Body::theta_end];
        let bodies = numbers.map(|number| column(&|walk| number(&walk.of.body)));
        let states = [0, 1, 2, 3].map(|k| column(&|walk| <[f64; 4]>::from(walk.rolling_state())[k]));
        let grip: Vec<f64> = waiting.iter().map(|(_, mu)| *mu).collect();
        let since = column(&|walk| walk.at[TIME]);
        let starts = MotionStarts {
            coefficients: Some([&grip, &grip, &[0.0]]),
            ..MotionStarts::of(bodies.each_ref().map(Vec::as_slice), states.each_ref().map(Vec::as_slice))
        };
        let tol = (ROLLING_ERROR_SHARE * self.job.tol).clamp(1e-15, ROLLING_ERROR);
        let job = Job { tol, ..self.job.of_rolling() };
        let work = MotionBlock { starts: &starts, job: &job, first: 0, since: Some(&since) };

        let columns = |rows: usize| [(); 4].map(|()| vec![f64::NAN; rows]);
        let (mut states, mut last) = (columns(if times > 1 { count * times } else { 0 }), columns(count));
        let (mut error, mut end) = (vec![f64::NAN; count], vec![f64::NAN; count]);
        let (mut method, mut status) = (vec![0; count], vec![0; count]);
        let mut out = MotionOutput::new(&mut error, &mut method, &mut status);
        out.states = (times > 1).then(|| states.each_mut().map(Vec::as_mut_slice));
        out.last = Some(last.each_mut().map(Vec::as_mut_slice));
        out.summary[Summary::End as usize] = Some(&mut end);
        let mut alone = work.run(level, (0..count).collect(), &mut out, go_on).into_iter().peekable();
        for (k, (i, mu)) in waiting.into_iter().enumerate() {
            if !go_on() {
                return Ok(());
            }
            let solved = alone.next_if_eq(&k).is_none();
            let ending = ENDINGS.into_iter().find(|ending| solved && *ending as u8 == status[k]);
            let Ok(walk) = &mut all.walks[i] else { continue };
            let found = match ending {
                None => walk.roll_by_first_integrals(mu, go_on),
                Some(ending) => {
                    let row = |of: &[Vec<f64>; 4], row: usize| State::from(of.each_ref().map(|x| x[row]));
                    let (mut rolled, over) = (Motion::empty(times, false)?, ending != Ending::Done);
                    for j in walk.made.motion.states.len()..times {
                        let y = if times > 1 { row(&states, k * times + j) } else { row(&last, k) };
                        if y.theta.is_nan() || times == 1 && over {
                            break;
                        }
                        rolled.states.push(y);
                    }
                    let event = Event { ending, time: end[k], state: row(&last, k), rim: 0 };
                    (rolled.event, rolled.error) = (over.then_some(event), error[k]);
                    walk.continue_after_rolling(rolled, mu, go_on)
                }
            };
            if let Err(e) = found {
                all.walks[i] = Err(e);
            }
            all.continue_walk(i, Ok(Pause::No), go_on);
        }
        Ok(())
    }
}
