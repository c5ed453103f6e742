//! The motions of many stones, computed one by one on threads, and the reversals of their spin.

use super::motions::CustomLaws;
use super::threads::share;
use crate::error::{Error, room, within};
use crate::laws::contact::Friction;
use crate::laws::custom::Custom;
use crate::laws::loss::Losses;
use crate::laws::stone::{Ellipsoid, StoneState};
use crate::methods::beat::Beat;
use crate::motions::Path;
use crate::motions::custom::stone_followed;
use crate::motions::stone::check_stone;
use crate::motions::stone::known::Recorded;
use crate::motions::stone::turns::Reversals;
use crate::motions::walk::two_runs::Followed;
use crate::motions::{Ask, Ending, Kind, Motion, Moving, Phase, Start};
use core::cell::RefCell;
use std::sync::OnceLock;

/// The description of one motion of many: its stone, initial state and slip, and its own coefficients of friction and
/// losses, if it has any.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct StoneRow {
    /// The 13 numbers of the stone, as [`Ellipsoid::of_numbers`] takes them.
    pub(crate) stone: [f64; 13],
    /// The initial direction of the vertical and the initial angular velocity, both along the axes of the stone.
    pub(crate) state: [f64; 6],
    /// The initial slip along x and y, in sqrt(g a).
    pub(crate) slip: [f64; 2],
    /// The coefficients of sliding and of static friction and the radius of the patch, or c of a viscous film and two
    /// numbers that are not used; None for those of [`StoneJob::ask`].
    pub(crate) coefficients: Option<[f64; 3]>,
    /// The losses of this motion; None for those of [`StoneJob::ask`].
    pub(crate) losses: Option<Losses>,
    /// The slope of the table and the angle phi at the start, in radians; None for a level table.
    pub(crate) slope: Option<[f64; 2]>,
    /// The height of the lowest point and its vertical velocity at the start, for a stone in the air; None on the table.
    pub(crate) aloft: Option<[f64; 2]>,
}

impl StoneRow {
    /// A stone on a level table without a slip, with the friction and the losses of the job.
    pub fn new(stone: &Ellipsoid, state: StoneState) -> Self {
        let StoneState { vertical: [a, b, c], w: [d, e, f] } = state;
        Self {
            stone: stone.numbers(),
            state: [a, b, c, d, e, f],
            slip: [0.0; 2],
            coefficients: None,
            losses: None,
            slope: None,
            aloft: None,
        }
    }

    /// Returns this row with this slip along x and y, in sqrt(g a).
    #[must_use]
    pub fn with_slip(self, x: f64, y: f64) -> Self {
        Self { slip: [x, y], ..self }
    }

    /// Returns this row with its own coefficients of friction; the law of friction is that of the job.
    #[must_use]
    pub fn with_friction(self, friction: Friction) -> Self {
        let coefficients = match friction {
            Friction::Coulomb { mu, fixed, patch } => [mu, fixed, patch],
            Friction::Viscous { c } => [c, 0.0, 0.0],
        };
        Self { coefficients: Some(coefficients), ..self }
    }

    /// Returns this row with its own losses, in place of those of the job.
    #[must_use]
    pub fn with_losses(self, losses: Losses) -> Self {
        Self { losses: Some(losses), ..self }
    }

    /// Returns this initial state on a table with this slope, where the stone has turned by phi about the vertical at the
    /// start; both in radians.
    #[must_use]
    pub fn with_slope(self, slope: f64, phi: f64) -> Self {
        Self { slope: Some([slope, phi]), ..self }
    }

    /// Returns this row in the air, with the height of the lowest point, in a, and its vertical velocity, in sqrt(g a).
    #[must_use]
    pub fn with_aloft(self, height: f64, lift: f64) -> Self {
        Self { aloft: Some([height, lift]), ..self }
    }
}

/// Whether reversals of the spin are counted; counting needs the estimated error at all times of each motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Turns {
    /// Reversals of the spin are not counted.
    #[default]
    Uncounted,
    /// Reversals of the spin are counted.
    Counted,
}

/// The options and the times that all motions of a call of [`many`] share.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct StoneJob<'a> {
    /// The options of every motion; the coefficients of a [`StoneRow`] replace those of the options.
    pub ask: Ask,
    /// Times of the motions, in sqrt(a/g); the results are those at the last time.
    pub times: &'a [f64],
    /// Whether reversals of the spin are counted.
    pub turns: Turns,
}

impl<'a> StoneJob<'a> {
    /// A job of stones that roll until the last of these times, in sqrt(a/g), in which reversals are not counted.
    pub fn new(times: &'a [f64]) -> Self {
        Self { ask: Ask::default(), times, turns: Turns::Uncounted }
    }

    /// Returns this job with these options.
    #[must_use]
    pub fn with_ask(self, ask: Ask) -> Self {
        Self { ask, ..self }
    }

    /// Returns this job with or without counts of reversals.
    #[must_use]
    pub fn with_turns(self, turns: Turns) -> Self {
        Self { turns, ..self }
    }
}

/// The result of the motion of one stone of many.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct StoneSummary {
    /// The status: the code of an [`Ending`].
    pub(crate) status: u8,
    /// The numbers, in the order of [`NAMES`](Self::NAMES).
    pub(crate) numbers: [f64; 19],
}

impl StoneSummary {
    /// The names of the numbers of a summary. They are the last vertical and angular velocity, the time of the end, the
    /// last spin, the number of reversals of the spin, the time of the first reversal, the heat, the energy lost, the
    /// numbers of impacts and of landings after which the stone stays, the time in the air, the energy lost in impacts,
    /// the kind of the last phase, the estimated error, and the time up to which the motion is known.
    pub(crate) const NAMES: [&str; 19] = [
        "n1",
        "n2",
        "n3",
        "w1",
        "w2",
        "w3",
        "end",
        "spin",
        "reversals",
        "first_reversal",
        "dissipated",
        "work_lost",
        "impacts",
        "landings",
        "air_time",
        "lost_in_impacts",
        "last_phase",
        "error",
        "known_until",
    ];

    /// The ending of the motion; if it is invalid, all numbers of the summary are NaN.
    pub fn ending(&self) -> Ending {
        Ending::from_code(self.status).unwrap_or(Ending::Invalid)
    }

    /// The state at the end of the motion.
    pub fn state(&self) -> StoneState {
        let [a, b, c, d, e, f, ..] = self.numbers;
        StoneState { vertical: [a, b, c], w: [d, e, f] }
    }

    /// The time of the end of the motion, in sqrt(a/g).
    pub fn end(&self) -> f64 {
        self.numbers[6]
    }

    /// The angular velocity about the vertical at the end, in sqrt(g/a).
    pub fn spin(&self) -> f64 {
        self.numbers[7]
    }

    /// The number of reversals of the spin; None unless they are counted.
    pub fn reversals(&self) -> Option<usize> {
        Some(self.numbers[8]).filter(|count| !count.is_nan()).map(|count| count as usize)
    }

    /// The time of the first reversal of the spin, in sqrt(a/g); None without a reversal, or if reversals are not counted.
    pub fn first_reversal(&self) -> Option<f64> {
        Some(self.numbers[9]).filter(|time| !time.is_nan())
    }

    /// The heat made by friction, in M g a.
    pub fn dissipated(&self) -> f64 {
        self.numbers[10]
    }

    /// The energy taken by the loss laws, in M g a.
    pub fn work_lost(&self) -> f64 {
        self.numbers[11]
    }

    /// The number of impacts; NaN for an invalid motion.
    pub fn impacts(&self) -> f64 {
        self.numbers[12]
    }

    /// The number of landings after which the stone stays on the table; NaN for an invalid motion.
    pub fn landings(&self) -> f64 {
        self.numbers[13]
    }

    /// The total time in the air, in sqrt(a/g).
    pub fn air_time(&self) -> f64 {
        self.numbers[14]
    }

    /// The energy lost in impacts, in M g a.
    pub fn lost_in_impacts(&self) -> f64 {
        self.numbers[15]
    }

    /// The kind of the last phase; None for a motion without phases.
    pub fn last_phase(&self) -> Option<Kind> {
        Some(self.numbers[16]).filter(|code| !code.is_nan()).and_then(|code| Kind::from_code(code as u8))
    }

    /// The estimated error of the state at the end.
    pub fn error(&self) -> f64 {
        self.numbers[17]
    }

    /// The time, in sqrt(a/g), up to which the estimated error of the motion is small.
    pub fn known_until(&self) -> f64 {
        self.numbers[18]
    }

    const fn none(status: Ending) -> Self {
        Self { status: status as u8, numbers: [f64::NAN; 19] }
    }

    /// The summary of a motion whose computation was given up at this time.
    fn given_up(time: f64) -> Self {
        let mut row = Self::none(Ending::Bounded);
        for (to, name) in row.numbers.iter_mut().zip(Self::NAMES) {
            *to = if name == "end" { time } else { *to };
        }
        row
    }
}

/// Computes the motions of `count` stones, each given by `row`, up to the last of the times. `go_on` is called with
/// the finished share of the work; if it returns false, the result is None.
///
/// A reversal is complete when the spin has passed zero and reached at least a tenth of the initial spin in the other
/// direction; the time of the reversal is that of the last zero before, to about 1e-4 of a period of the rocking.
/// With [`Turns::Counted`] reversals are counted as long as the motion is known; the motion then also counts as
/// unknown when its estimated error exceeds that tenth. An initial spin of less than 1e-12 has no direction.
///
/// ```
/// use spincyl::Ellipsoid;
/// use spincyl::stone::{StoneJob, StoneRow, Turns, many};
///
/// // A rattleback that is spun the wrong way turns back, and the other way it does not.
/// let stone = Ellipsoid::rattleback([1.0, 0.2, 0.15], None, 0.1, None)?;
/// let row = |i: usize| StoneRow::new(&stone, stone.spinning([-0.4, 0.4][i], 1e-2, 1e-2));
/// let job = StoneJob::new(&[60.0]).with_turns(Turns::Counted);
/// let found = many(2, &row, &job, 1, &mut |_| true)?;
/// let count: Vec<_> = found.expect("not stopped").iter().map(|one| one.reversals()).collect();
/// assert!(count[0] != count[1], "{count:?}");
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// Those of [`roll`](crate::motions::stone::roll) for invalid times or options, and too little memory.
pub fn many(
    count: usize,
    row: &(dyn Fn(usize) -> StoneRow + Sync),
    job: &StoneJob<'_>,
    threads: usize,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<Vec<StoneSummary>>, Error> {
    let laws = CustomLaws::AnyThread(&Custom::default);
    many_custom(count, row, job.times, (&job.ask, job.turns == Turns::Counted), (&laws, threads), go_on)
}

/// Computes the motions of [`many`] under a user-defined law of friction; a wrong value of the law is an error.
pub(crate) fn many_custom(
    count: usize,
    row: &(dyn Fn(usize) -> StoneRow + Sync),
    times: &[f64],
    how: (&Ask, bool),
    (laws, threads): (&CustomLaws<'_>, usize),
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<Vec<StoneSummary>>, Error> {
    check_stone(&StoneState { vertical: [0.0, 0.0, 1.0], w: [0.0; 3] }.into(), times, how.0)?;
    within("slope", how.0.slope, (0.0, 0.0), "0: give the slopes of many stones by `StoneRow::with_slope`")?;
    let mut all = room(count)?;
    all.resize(count, StoneSummary::none(Ending::Invalid));
    let done = match laws {
        CustomLaws::ThisThread(custom) => {
            let (mut beat, mut goes_on) = (Beat::new(), true);
            for (k, to) in all.iter_mut().enumerate() {
                let mut still = || {
                    goes_on = goes_on && (!beat.is_due() || go_on(k as f64 / count as f64));
                    goes_on
                };
                *to = one(&row(k), times, how, *custom, &mut still)?;
                if custom.has_failed() || !goes_on {
                    break;
                }
            }
            goes_on
        }
        CustomLaws::AnyThread(of) => {
            let failed = OnceLock::new();
            let mut go_on = |share| failed.get().is_none() && go_on(share);
            let blocks = all.chunks_mut(16).enumerate().collect();
            let done =
                share(blocks, threads, &mut go_on, |(block, to): (usize, &mut [StoneSummary]), still| {
                    for (k, to) in to.iter_mut().enumerate() {
                        match one(&row(16 * block + k), times, how, of(), still) {
                            Ok(found) => *to = found,
                            Err(e) => _ = failed.set(e),
                        }
                    }
                });
            failed.into_inner().map_or(Ok(done), Err)?
        }
    };
    Ok(done.then_some(all))
}

/// Computes the motion of one row; returns an error only for a wrong value of a user-defined law.
fn one(
    row: &StoneRow,
    times: &[f64],
    (ask, turns): (&Ask, bool),
    custom: Custom<'_>,
    still: &mut dyn FnMut() -> bool,
) -> Result<StoneSummary, Error> {
    let invalid = Ok(StoneSummary::none(Ending::Invalid));
    let Ok(stone) = Ellipsoid::of_numbers(row.stone) else { return invalid };
    let [a, b, c, d, e, f] = row.state;
    let state = StoneState { vertical: [a, b, c], w: [d, e, f] };
    let [slope, heading] = row.slope.unwrap_or_default();
    let start =
        Start { slip: row.slip.into(), heading, aloft: row.aloft.map(Into::into), ..Start::from(state) };
    let mut ask = ask.with_slope(slope);
    // A motion on a slope is computed in units of the slope; reversals are counted in these units, too.
    let pace = slope.cos().sqrt();
    ask.losses = row.losses.unwrap_or(ask.losses);
    if let Some(own) = row.coefficients {
        ask.table = ask.table.with_coefficients(own);
    }
    let recorded = RefCell::new(Recorded {
        turns: turns.then(|| Reversals::of(state.spin() / pace, state.fastest() / pace)),
        ..Recorded::default()
    });
    custom.check_friction(ask.table.mu())?;
    let last = &times[times.len() - 1..];
    let found = match stone_followed(&stone, &start, last, (&ask, custom), &recorded, still) {
        Ok(found) => found,
        Err(Error::Painleve { .. }) => return Ok(StoneSummary::none(Ending::Painleve)),
        Err(Error::OutOfRange { .. } | Error::Inertia { .. }) => return invalid,
        Err(e @ Error::Coefficient { .. }) => return Err(e),
        Err(_) => return Ok(StoneSummary::none(Ending::Bounded)),
    };
    if let Some(event) = found.motion.event.filter(|event| event.ending == Ending::Bounded) {
        return Ok(StoneSummary::given_up(event.time));
    }
    let Some(last) = found.motion.event.map(|e| e.state).or(found.motion.states.last().copied()) else {
        return Ok(StoneSummary::none(Ending::Bounded));
    };
    let end = found.motion.event.map_or(times[times.len() - 1], |e| e.time);
    let turns = recorded.into_inner().turns.map(|turns| turns.times);
    let count = turns.as_ref().map_or(f64::NAN, |turns| turns.len() as f64);
    let first = turns.iter().flatten().next().map_or(f64::NAN, |[t, _]| *t / pace);
    let ([a, b, c], [d, e, f]) = (last.vertical, last.w);
    let Followed { motion: Motion { error, .. }, path } = &found;
    let [impacts, landings, air_time, lost_in_impacts, last_phase] = flights(path, end);
    let known = path.known_until.min(end);
    #[rustfmt::skip]
    let numbers = [
        a, b, c, d, e, f, end, last.spin(), count, first, path.heat, path.lost, impacts, landings, air_time,
        lost_in_impacts, last_phase, *error, known,
    ];
    Ok(StoneSummary { status: found.motion.ending() as u8, numbers })
}

/// The numbers of impacts and of landings after which the stone stays, the time in the air up to `end`, the energy lost
/// in impacts, and the code of the last phase.
fn flights(path: &Path<StoneState>, end: f64) -> [f64; 5] {
    let next = path.phases.iter().skip(1).map(|phase| phase.time).chain([end]);
    let flights = path.phases.iter().zip(next).filter(|(phase, _)| phase.kind == Kind::Flying);
    let lands = |pair: &&[Phase<StoneState>]| pair[0].kind == Kind::Flying && pair[1].kind != Kind::Flying;
    [
        path.impacts.len() as f64,
        path.phases.windows(2).filter(lands).count() as f64,
        flights.map(|(phase, next)| next - phase.time).sum(),
        path.impacts.iter().map(|impact| impact.lost).sum(),
        path.phases.last().map_or(f64::NAN, |phase| f64::from(phase.kind as u8)),
    ]
}
