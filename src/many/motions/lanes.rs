//! Motions in SIMD lanes: the choice of the series for each motion, and the results from the series.

use super::ends::{Marches, can_march};
use super::rows::{StartLanes, first_of_consecutive};
use super::steps::FixedSteps;
use super::swung::SwingsInLanes;
use super::{Answer, MotionBlock, MotionOutput, Summary};
use crate::laws::contact::Contact;
use crate::laws::contact::reduced::Reduced;
use crate::motions::exact::lanes::{Grip, Midpoints, Swings, width};
use crate::numbers::side_by_side::{MOST, SideBySide, apart, zero};
use crate::numbers::{Pair, larger_or_nan};
use core::f64::consts::PI;
use fearless_simd::Level;
use std::sync::LazyLock;

/// The midpoints, of each number of terms, at which the series are evaluated.
struct SeriesMidpoints {
    short: (Midpoints<6>, Midpoints<8>, Midpoints<16>),
    long: [Midpoints<MOST_PARTS>; 3],
}

/// The midpoints are computed once, because they contain thousands of cosines.
static SERIES_MIDPOINTS: LazyLock<SeriesMidpoints> = LazyLock::new(|| SeriesMidpoints {
    short: (Midpoints::new(6), Midpoints::new(8), Midpoints::new(16)),
    long: [28, 40, MOST_PARTS].map(Midpoints::new),
});

/// Numbers of terms of the series. The first three are compiled separately, and the others share one code.
const TERMS: [usize; 6] = [8, 12, 20, 36, 52, 72];
const MOST_PARTS: usize = 56;

/// Number of series that are tried for a motion that may end: a march, panel by panel, to its end is faster than a longer series.
const SHORT_SERIES: usize = 3;

/// The index in `TERMS` of the shortest series that may have an error below `tol` for a swing of this width (the larger
/// |y| of its ends); None for a swing that is too wide for all of them.
fn index_of_series(width: f64, tol: f64) -> Option<usize> {
    TERMS.iter().position(|terms| 1e4 * width.powi(*terms as i32 - 1) < tol)
}

/// Number of output times that are computed between two calls of `go_on`.
const TIMES_PER_BREATH: usize = 64;

impl MotionBlock<'_> {
    /// Computes the motions for which a series or a march is precise enough, on the best SIMD lanes of this
    /// machine; returns the other motions.
    pub fn run(
        &self,
        level: Option<Level>,
        all: Vec<usize>,
        out: &mut MotionOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Vec<usize> {
        match level {
            #[cfg(lanes_of_sixteen)]
            // Two sets of lanes hide the latency of the operations.
            Some(Level::Avx512(simd)) => self.kernels(Pair(zero(simd), zero(simd)), all, out, go_on),
            #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), lanes_of_eight))]
            Some(Level::Avx2(simd)) => self.kernels(zero(simd), all, out, go_on),
            #[cfg(all(target_arch = "aarch64", lanes_of_eight))]
            Some(Level::Neon(simd)) => self.kernels(zero(simd), all, out, go_on),
            // Without lanes every motion is computed alone.
            _ => all,
        }
    }

    fn kernels<T: SideBySide>(
        &self,
        like: T,
        all: Vec<usize>,
        out: &mut MotionOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Vec<usize> {
        let rounded =
            |i: &usize| self.job.contact() == Contact::Rolling && self.starts.is_rounded(self.first + i);
        let (round, sharp): (Vec<usize>, Vec<usize>) = match self.starts.bodies[3] {
            [_] if rounded(&0) => (all, Vec::new()),
            [_] => (Vec::new(), all),
            _ => all.into_iter().partition(rounded),
        };
        let mut left = Vec::new();
        for (some, round) in [(&sharp, false), (&round, true)] {
            let rest = self.roll_by_series(like, some, round, out, go_on);
            left.extend(Marches { work: self, round }.run(like, &rest, out, go_on));
        }
        left.sort_unstable();
        left
    }

    /// Computes motions by one series each, all on sharp rims or all on rounded rims; returns the motions for which the
    /// series is not precise enough.
    pub(super) fn roll_by_series<T: SideBySide>(
        &self,
        like: T,
        all: &[usize],
        round: bool,
        out: &mut MotionOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Vec<usize> {
        let (mut kernels, mut left) = self.sort_by_series(like, all, round);
        let contact = self.job.contact();
        macro_rules! answer {
            ($N:literal, $K:literal, $ROUND:literal, $index:expr, $points:expr) => {{
                let some = core::mem::take(&mut kernels[$index]);
                for some in some.chunks(T::COUNT) {
                    if !go_on() {
                        return left;
                    }
                    let row = self.gather(like, some, round);
                    // The kind of the rim is a constant, so that each kind is compiled separately.
                    let swings = apart(
                        like,
                        #[inline(always)]
                        || {
                            let law = Reduced::of(contact, &row.shape, $ROUND);
                            Swings::<T, $N, $K>::about_start($points, TERMS[$index], law, row.state)
                        },
                    );
                    let next = if $index + 1 < self.series_tried(round) {
                        kernels.get_mut($index + 1)
                    } else {
                        None
                    };
                    self.write_precise_motions(&(swings, $points), &row, some, (next, &mut left), out, go_on);
                }
            }};
        }
        let SeriesMidpoints { short, long } = &*SERIES_MIDPOINTS;
        macro_rules! answer_all {
            ($ROUND:literal) => {
                answer!(8, 6, $ROUND, 0, &short.0);
                answer!(12, 8, $ROUND, 1, &short.1);
                answer!(20, 16, $ROUND, 2, &short.2);
                for (k, points) in long.iter().enumerate() {
                    answer!(72, 56, $ROUND, SHORT_SERIES + k, points);
                }
            };
        }
        if round {
            answer_all!(true);
        } else {
            answer_all!(false);
        }
        left
    }

    /// The number of series in `TERMS` that are tried for the motions of this job.
    fn series_tried(&self, round: bool) -> usize {
        if !self.job.ask.beyond && can_march(self, round) { SHORT_SERIES } else { TERMS.len() }
    }

    /// Sorts the motions by the shortest series that may be precise enough; also returns the motions that are too wide
    /// for any series.
    fn sort_by_series<T: SideBySide>(
        &self,
        like: T,
        all: &[usize],
        round: bool,
    ) -> ([Vec<usize>; TERMS.len()], Vec<usize>) {
        let mut kernels: [Vec<usize>; TERMS.len()] = Default::default();
        let mut refused = Vec::new();
        for some in all.chunks(T::COUNT) {
            let row = self.gather(like, some, round);
            let (widths, fit) = apart(
                like,
                #[inline(always)]
                || {
                    (
                        width(&Reduced::of(self.job.contact(), &row.shape, round), row.state),
                        row.in_range_mask(),
                    )
                },
            );
            for (k, i) in some.iter().enumerate() {
                let fits = fit.lane(k) > 0.0;
                match index_of_series(widths.lane(k), self.job.tol)
                    .filter(|room| fits && *room < self.series_tried(round))
                {
                    Some(room) => kernels[room].push(*i),
                    None => refused.push(*i),
                }
            }
        }
        (kernels, refused)
    }

    /// Writes the results of the motions for which the series is precise enough. A motion with too large an error goes
    /// to `next`, the motions of the next longer series, if there is one. The other motions, which may leave the model,
    /// go to `left`, since a longer series does not decide whether they do.
    fn write_precise_motions<T: SideBySide>(
        &self,
        swings: &dyn SwingsInLanes<T>,
        row: &StartLanes<T>,
        some: &[usize],
        (mut next, left): (Option<&mut Vec<usize>>, &mut Vec<usize>),
        out: &mut MotionOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) {
        let Some(mut worst) = self.write_states(swings, row, some, out, go_on) else { return };
        self.write_periods(swings, some, &mut worst, out);
        let sure = self.write_other_summaries(swings, row, some, &worst[..some.len()], out);
        let answer = if self.job.step().is_some() { Answer::Step } else { Answer::Lanes };
        if let Some(first) =
            first_of_consecutive(some).filter(|_| sure[..some.len()].iter().all(|sure| *sure))
        {
            let here = first..first + some.len();
            out.error[here.clone()].copy_from_slice(&worst[..some.len()]);
            out.method[here.clone()].fill(answer as u8);
            out.status[here].fill(0);
            return;
        }
        for (k, i) in some.iter().enumerate() {
            if sure[k] {
                out.error[*i] = worst[k];
                (out.method[*i], out.status[*i]) = (answer as u8, 0);
            } else {
                let longer = next.as_mut().filter(|_| !worst[k].is_finite());
                longer.map_or(&mut *left, |next| &mut **next).push(*i);
            }
        }
    }

    /// The time from the beginning of each of these motions to `t`, or 0 if `t` is before its beginning.
    #[inline(always)]
    fn times_since_start<T: SideBySide>(&self, like: T, some: &[usize], t: f64) -> T {
        if self.since.is_none() {
            return like.splat(t);
        }
        let mut times = [0.0; MOST];
        times.iter_mut().zip(some).for_each(|(time, i)| *time = (t - self.since(*i)).max(0.0));
        like.load(&times)
    }

    /// Writes the states at all times, by the series or by RK4 steps, and returns the greatest error of each motion,
    /// NaN where the series is not precise enough; None if `go_on` returns false.
    fn write_states<T: SideBySide>(
        &self,
        swings: &dyn SwingsInLanes<T>,
        row: &StartLanes<T>,
        some: &[usize],
        out: &mut MotionOutput<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Option<[f64; MOST]> {
        let (job, like, times) = (self.job, row.theta_end, self.job.times.len());
        let row_at = first_of_consecutive(some);
        let mut walk = job.step().map(|step| {
            apart(
                like,
                #[inline(always)]
                || FixedSteps::new(job, row, step),
            )
        });
        let mut worst = [0f64; MOST];
        for (j, t) in job.times.iter().enumerate() {
            if j % TIMES_PER_BREATH == TIMES_PER_BREATH - 1 && !go_on() {
                return None;
            }
            if self.since.is_some() && some.iter().all(|i| self.since(*i) > *t) {
                continue;
            }
            let (mut y, error, least) = swings.state(self.times_since_start(like, some, *t));
            let mut off = [0f64; MOST];
            if let Some(walk) = &mut walk {
                let stepped = apart(
                    like,
                    #[inline(always)]
                    || walk.advance_to(*t, go_on),
                );
                let stepped = stepped?;
                for (k, off) in off[..some.len()].iter_mut().enumerate() {
                    *off = (0..4).fold(0f64, |most, i| most.max((stepped[i].lane(k) - y[i].lane(k)).abs()));
                }
                y = stepped;
            }
            let (mut errors, mut roundings) = ([0f64; MOST], [0f64; MOST]);
            error.spill(&mut errors);
            least.spill(&mut roundings);
            for k in 0..some.len() {
                worst[k] = larger_or_nan(worst[k], accepted_error(job.tol, errors[k], roundings[k]) + off[k]);
            }
            let last = out.last.as_mut().filter(|_| j + 1 == times);
            for (columns, step, offset) in [(out.states.as_mut(), times, j), (last, 1, 0)] {
                for (column, y) in columns.into_iter().flatten().zip(&y) {
                    let mut lanes = [0.0; MOST];
                    y.spill(&mut lanes);
                    match row_at {
                        Some(first) if step == 1 => {
                            column[first..first + some.len()].copy_from_slice(&lanes[..some.len()]);
                        }
                        _ => some.iter().zip(&lanes).for_each(|(i, y)| column[i * step + offset] = *y),
                    }
                }
            }
        }
        Some(worst)
    }

    /// Writes the periods and the precessions that are requested. Their errors are treated as those of the states:
    /// `worst` keeps the greatest error of each motion, NaN where the series is not precise enough.
    fn write_periods<T: SideBySide>(
        &self,
        swings: &dyn SwingsInLanes<T>,
        some: &[usize],
        worst: &mut [f64; MOST],
        out: &mut MotionOutput<'_>,
    ) {
        let mut put = |kind: Summary, of: &dyn Fn() -> [T; 3]| {
            let Some(column) = &mut out.summary[kind as usize] else { return };
            let [value, error, least] = of();
            for (k, i) in some.iter().enumerate() {
                column[*i] = value.lane(k);
                worst[k] =
                    larger_or_nan(worst[k], accepted_error(self.job.tol, error.lane(k), least.lane(k)));
            }
        };
        put(Summary::Period, &|| swings.period());
        put(Summary::PrecessionPerPeriod, &|| swings.precession_per_period());
    }

    /// Writes the other summaries, and returns for each motion whether it has a finite error and certainly stays in the
    /// model up to the last time.
    fn write_other_summaries<T: SideBySide>(
        &self,
        swings: &dyn SwingsInLanes<T>,
        row: &StartLanes<T>,
        some: &[usize],
        worst: &[f64],
        out: &mut MotionOutput<'_>,
    ) -> [bool; MOST] {
        let (job, span) = (self.job, self.times_since_start(row.theta_end, some, self.job.span()));
        let mut sure = [false; MOST];
        for (sure, worst) in sure.iter_mut().zip(worst) {
            *sure = worst.is_finite();
        }
        if let Some(step) = job.step() {
            let fastest_turn = swings.fastest_turn();
            for (k, sure) in sure[..some.len()].iter_mut().enumerate() {
                *sure &= fastest_turn.lane(k) * step.abs() < UNWARNED_TURN;
            }
        }
        let inclined = !job.ask.beyond || out.wants(Summary::ThetaMin) || out.wants(Summary::ThetaMax);
        let [low, high] = if inclined { swings.inclinations(span) } else { [span; 2] };
        let least = |grip: Grip, roughly: bool| swings.least(grip, span, roughly);
        if !job.ask.beyond {
            let normal = least(Grip::Normal, true);
            let slips = if self.may_slip() { Some(least(Grip::Friction, true)) } else { None };
            for (k, sure) in sure[..some.len()].iter_mut().enumerate() {
                let most = row.theta_end.lane(k);
                let upright = most >= PI || high.lane(k) < most;
                let grips = slips.is_none_or(|needed| -needed.lane(k) < self.grip(some[k]));
                *sure &= upright && normal.lane(k) > 0.0 && grips;
            }
        }
        let mut put = |kind: Summary, value: &dyn Fn() -> T| {
            if let Some(column) = &mut out.summary[kind as usize] {
                let value = value();
                for (k, i) in some.iter().enumerate() {
                    column[*i] = value.lane(k);
                }
            }
        };
        put(Summary::ThetaMin, &|| low);
        put(Summary::ThetaMax, &|| high);
        put(Summary::NormalMin, &|| least(Grip::Normal, false));
        put(Summary::FrictionCoefficientMax, &|| -least(Grip::Friction, false));
        put(Summary::End, &|| span.splat(job.span()));
        sure
    }
}

/// Greatest error of a series that is accepted above the tolerance, if at least half of it is rounding.
const ACCEPTED_ROUNDING: f64 = 1e-9;

/// The error of a series if it is small enough, else NaN. Where rounding, `least`, is most of the error, no
/// other method would be more precise.
fn accepted_error(tol: f64, error: f64, least: f64) -> f64 {
    if error < tol || error < (2.0 * least).min(ACCEPTED_ROUNDING) { error } else { f64::NAN }
}

/// An RK4 step that turns the precession and the nutation by less than this angle, in radians, is so small that it
/// causes neither an error nor a warning.
const UNWARNED_TURN: f64 = 0.25;

#[cfg(test)]
mod tests {
    use super::super::{Job, MotionStarts, SUMMARIES};
    use super::*;
    use crate::laws::contact::Table;
    use crate::motions::{Ask, Method};

    /// All results of some motions, as bits, for a comparison of two computations.
    fn bits(
        run: impl Fn(&MotionBlock<'_>, usize, &mut MotionOutput<'_>) -> Vec<usize>,
        (table, fillet): (Contact, f64),
    ) -> Vec<u64> {
        const COUNT: usize = 90;
        let column =
            |f: &dyn Fn(f64) -> f64| (0..COUNT).map(|i| f(i as f64 / COUNT as f64)).collect::<Vec<_>>();
        let fillet = vec![fillet; COUNT];
        let bodies =
            [column(&|u| 3.0 * u), column(&|u| 0.25 + 3.0 * u * u), vec![0.5], fillet, vec![f64::NAN]];
        let states = [
            column(&|u| 0.3 + 1.2 * (7.0 * u).fract()),
            vec![0.7],
            column(&|u| 0.8 * (3.0 * u).fract()),
            vec![0.6],
        ];
        let starts =
            MotionStarts::of(bodies.each_ref().map(Vec::as_slice), states.each_ref().map(Vec::as_slice));
        let times = [1.0, 30.0];
        let exact = Job::new(&times).with_ask(Ask::on(table));
        let stepped = exact.with_ask(exact.ask.with_method(Method::Step(0.01)));
        let mut all = Vec::new();
        let beyond = exact.with_ask(exact.ask.with_beyond());
        let limited = exact.with_ask(exact.ask.with_table(Table::of(table, 0.3)));
        for job in [stepped, exact, beyond, limited] {
            let mut last: [Vec<f64>; 4] = core::array::from_fn(|_| vec![7.0; COUNT]);
            let mut sums: [Vec<f64>; SUMMARIES] = core::array::from_fn(|_| vec![7.0; COUNT]);
            let (mut error, mut method, mut status) = (vec![7.0; COUNT], vec![7; COUNT], vec![7; COUNT]);
            let mut out = MotionOutput {
                last: Some(last.each_mut().map(Vec::as_mut_slice)),
                summary: sums.each_mut().map(|x| Some(x.as_mut_slice())),
                ..MotionOutput::new(&mut error, &mut method, &mut status)
            };
            let left =
                run(&MotionBlock { starts: &starts, job: &job, first: 0, since: None }, COUNT, &mut out);
            for i in (0..COUNT).filter(|i| !left.contains(i)) {
                let numbers = last.iter().chain(&sums).map(|x| x[i]).chain([error[i]]);
                all.extend(numbers.map(f64::to_bits).chain([i as u64]));
            }
        }
        assert!(all.len() > 30 * 22, "too few motions for the lanes: {}", all.len());
        all
    }

    #[test]
    fn every_width_gives_the_same_bits() {
        let kinds = [(Contact::Rolling, 0.0), (Contact::Smooth, 0.0), (Contact::Rolling, 0.4)];
        let level = crate::numbers::level();
        if level.is_none() {
            return; // A program without lanes has nothing to compare.
        }
        for kind in kinds {
            let best =
                bits(|work, count, out| work.run(level, (0..count).collect(), out, &mut || true), kind);
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            if let Some(simd) = level.and_then(fearless_simd::Level::as_avx2) {
                let all = |count| (0..count).collect();
                let narrow =
                    bits(|work, count, out| work.kernels(zero(simd), all(count), out, &mut || true), kind);
                assert!(narrow == best, "AVX2");
            }
        }
    }
}
