//! A body on a table with friction: slipping, rolling, slipping again.
//!
//! ```text
//! slip    u = 0 and |F_roll| <= mu_s N      roll          u = 0, more is needed     slip in another direction
//! roll    |F_roll| = mu_s N                 slip          both   N = 0, a face or the other rim lands: the end
//! ```
//! A phase that slips is integrated (`motion::slide`); one that rolls is the exact solution, so that it costs the same
//! however long it lasts. Where no force, or more than one, obeys the law of friction (Painleve), a start is refused and a
//! motion ends.
//!
//! Error: the whole path is found twice, the second time within a tolerance up to ten thousand times as large, which costs a
//! third; thirty times what the ratio of the tolerances makes of the difference is claimed.

mod walk;

pub use super::ask::FINE;
use super::ask::{check_flow, check_times_after};
use super::{Ask, Motion, Start};
use crate::body::Body;
use crate::error::{Error, within};
use crate::exact;
use crate::state::State;
pub(crate) use walk::{Pause, Walk, WalkStep};

/// What a contact point does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Kind {
    /// It rests.
    Rolling = 0,
    /// It slips.
    Slipping = 1,
}

/// A part of a motion in which the contact point does the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phase {
    /// When it begins.
    pub time: f64,
    /// What it is.
    pub kind: Kind,
    /// The state then.
    pub state: State,
    /// The slip then, along the lean and across it.
    pub slip: [f64; 2],
}

/// The slip, the phases and the losses of a motion. Its estimated error is that of the slips, too, and of times and states of
/// phases and the end; the heat is off by that times the largest speed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Path {
    /// The slip at each time, along the lean and across it.
    pub slip: Vec<[f64; 2]>,
    /// The heat made by friction up to each time, in M g R.
    pub dissipated: Vec<f64>,
    /// The energy that the losses have taken up to each time, in M g R; empty if there are none.
    pub work_lost: Vec<f64>,
    /// What the contact point does at each time.
    pub kinds: Vec<Kind>,
    /// The phases, from the start on.
    pub phases: Vec<Phase>,
    /// All the heat, up to the last time or the end.
    pub heat: f64,
    /// All that the losses have taken.
    pub lost: f64,
    /// All the time of slipping.
    pub slipping: f64,
    /// The slip where an event ended it.
    pub last_slip: [f64; 2],
    /// Whether it has rocked over onto its other rim, now and, where poses are wanted, at each time.
    upside_down: bool,
    pub(super) turned: Vec<bool>,
    /// Whether it was left where it began to roll.
    rolls_on: bool,
    /// What all steps together may have erred by, by their own estimates.
    erred: f64,
    /// The direction in which the present slip began from rest.
    way: [f64; 2],
}

/// A motion while its path is still beside it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Followed {
    pub motion: Motion,
    pub path: Path,
}

/// By how much the second run is rougher where that is accurate enough, and at least; and the least tolerance that is not.
const ROUGHER: f64 = 1e4;
const BARELY: f64 = 32.0;
const ROUGH: f64 = 1e-7;
/// An end so near to the last time may be met by one of the runs only.
const LATE: f64 = 1e-6;
/// How brief a phase may be that only one of the two runs tells; its length is an error then. At first no phase is so brief.
const BRIEF: [f64; 4] = [0.0, 1e-10, 1e-8, 1e-6];
/// The difference is claimed, over the ratio of the tolerances, so many times.
const SAFETY: f64 = 30.0;
/// A second run that takes more than this share of the evaluations has made much the same steps, and errs with the first.
const ALIKE: f64 = 0.7;
/// So much of the sum of what all steps may have erred by is claimed in any case.
const CHANCE: f64 = 0.1;
/// Where the runs differ by so much of the fastest rate they have parted: then all of it is claimed.
const PARTED: f64 = 0.3;

/// The motion of a body that slips, or loses energy: [`roll_with`](super::roll_with) asks here. A page that follows nothing else
/// asks here itself, and has no code of the rest. Errors at any time: `Lost` where the equations lose their digits, and
/// `Restless` where slipping and rolling follow each other more than 10,000 times.
pub fn follow(
    body: &Body,
    start: &Start,
    times: &[f64],
    ask: &Ask,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Motion>, Error> {
    let fine = check(body, start, ask)?;
    check_times_after(start.time, times)?;
    // a page would rather have one code than the fastest
    const POSE: bool = cfg!(target_arch = "wasm32");
    let mut run = |tol: f64| match (POSE || ask.pose, ask.losses.is_none()) {
        (true, true) => Walk::<13>::new(body, ask, tol, times, start)?.run(go_on),
        (true, false) => Walk::<14>::new(body, ask, tol, times, start)?.run(go_on),
        (false, true) => Walk::<9>::new(body, ask, tol, times, start)?.run(go_on),
        (false, false) => Walk::<10>::new(body, ask, tol, times, start)?.run(go_on),
    };
    let Some(mut found) = run(fine)? else { return Ok(None) };
    let Some(rough) = run(rougher(fine))? else { return Ok(None) };
    found.judge(&rough, fine);
    Ok(Some(Motion { path: Some(Box::new(found.path)), ..found.motion }))
}

/// The tolerance by which the one of a path is judged.
pub(crate) fn rougher(tol: f64) -> f64 {
    (ROUGHER * tol).min(ROUGH).max(BARELY * tol)
}

/// Refuses what is out of range, and a start that has no unique force; what a step may err by.
fn check(body: &Body, start: &Start, ask: &Ask) -> Result<f64, Error> {
    exact::check(body, &start.state)?;
    ask.table.check()?;
    ask.losses.check_for(body)?;
    let fine = check_flow(ask)?;
    for (name, u) in ["slip along the lean", "slip across"].into_iter().zip(start.slip) {
        within(name, u, (-1e6, 1e6), "at most 1e6 sqrt(g R) for a motion")?;
    }
    if ask.table.rubs() { Ok(fine) } else { without_slip(start.slip).map(|()| fine) }
}

/// Refuses a slip where there is no friction to end it.
pub(super) fn without_slip([along, across]: [f64; 2]) -> Result<(), Error> {
    let value = if along == 0.0 { across } else { along };
    if value == 0.0 {
        return Ok(());
    }
    Err(Error::OutOfRange { name: "slip", value, expected: "no slip on this table" })
}

/// The phases that last for `brief` or longer. Two of one kind on both sides of a shorter phase are one.
fn lasting(phases: &[Phase], brief: f64) -> Vec<&Phase> {
    let ends = phases.iter().skip(1).map(|next| next.time).chain([f64::INFINITY]);
    let mut lasting: Vec<&Phase> = phases
        .iter()
        .zip(ends)
        .filter(|(phase, end)| end - phase.time >= brief)
        .map(|(phase, _)| phase)
        .collect();
    if brief > 0.0 {
        lasting.dedup_by_key(|phase| phase.kind);
    }
    lasting
}

impl Followed {
    /// The state and the slip at the last time, or where it ended.
    pub(crate) fn last(&self) -> Option<(State, [f64; 2])> {
        match self.motion.event {
            Some(event) => Some((event.state, self.path.last_slip)),
            None if self.path.rolls_on => self.path.phases.last().map(|phase| (phase.state, phase.slip)),
            None => self.motion.states.last().copied().zip(self.path.slip.last().copied()),
        }
    }

    /// When it ended, if not at the last time.
    pub(crate) fn ended(&self) -> Option<f64> {
        let rolling = self.path.phases.last().filter(|_| self.path.rolls_on).map(|phase| phase.time);
        self.motion.event.map(|e| e.time).or(rolling)
    }

    /// Says how far it may be off, by a rougher one.
    pub(crate) fn judge(&mut self, rough: &Self, tol: f64) {
        let claimed = (SAFETY * tol / rougher(tol)).min(1.0);
        let motion = &mut self.motion;
        let (mut off, mut turned, mut pressed) = (0f64, 0f64, 0f64);
        let mut apart = |a: f64, b: f64| off = off.max((a - b).abs());
        for (i, (a, b)) in motion.states.iter().zip(&rough.motion.states).enumerate() {
            let (a, b): ([f64; 4], [f64; 4]) = ((*a).into(), (*b).into());
            a.into_iter()
                .zip(b)
                .chain(self.path.slip[i].into_iter().zip(rough.path.slip[i]))
                .for_each(|(a, b)| apart(a, b));
        }
        // the phases of both runs are compared without those that are too brief for both to tell
        let both = |brief: f64| [lasting(&self.path.phases, brief), lasting(&rough.path.phases, brief)];
        let alike = |[a, b]: &[Vec<&Phase>; 2]| a.iter().map(|a| a.kind).eq(b.iter().map(|b| b.kind));
        let brief = BRIEF.into_iter().find(|brief| alike(&both(*brief)));
        let [ours, theirs] = both(brief.unwrap_or(0.0));
        for (a, b) in ours.into_iter().zip(theirs) {
            apart(a.time, b.time);
            let (a, b): ([f64; 4], [f64; 4]) = (a.state.into(), b.state.into());
            a.into_iter().zip(b).for_each(|(a, b)| apart(a, b));
        }
        if let (Some(a), Some(b)) = (motion.event, rough.motion.event) {
            apart(a.time, b.time);
            let (a, b): ([f64; 4], [f64; 4]) = (a.state.into(), b.state.into());
            a.into_iter().zip(b).for_each(|(a, b)| apart(a, b));
        }
        if let (Some(poses), Some(others)) = (&motion.poses, &rough.motion.poses) {
            for (a, b) in poses.iter().zip(others) {
                turned = turned.max(super::judge::pose_distance(a, b));
            }
        }
        if let (Some(forces), Some(others)) = (&motion.forces, &rough.motion.forces) {
            for (a, b) in forces.iter().zip(others) {
                pressed = pressed.max(super::judge::force_distance(a, b));
            }
        }
        let mut ends = motion.event.map(|e| e.ending) == rough.motion.event.map(|e| e.ending);
        // an end at the last time is met by one of the two, and all but met by the other
        let last = motion.times.last().or(rough.motion.times.last()).copied();
        if let (Some(event), None) | (None, Some(event)) = (motion.event, rough.motion.event)
            && let Some(late) = last.map(|t| (event.time - t).abs()).filter(|late| *late <= LATE)
        {
            (ends, off) = (true, off.max(late));
        }
        let fastest = self.path.phases.iter().fold(1.0, |most: f64, p| {
            most.max(p.state.w1.abs()).max(p.state.w3.abs()).max(p.slip[0].abs()).max(p.slip[1].abs())
        });
        let rounding = 8.0 * f64::EPSILON * fastest;
        let same = brief.is_some() && ends;
        let motion = &mut self.motion;
        // two runs that make the same steps agree on an error that a step is allowed
        let mut least =
            if self.path.slipping > 0.0 || motion.evaluations > 0 { rounding.max(tol) } else { rounding };
        // an error goes as the eighth power of a step: where steps are longer by less than that tells, so is the error
        let ratio = rough.motion.evaluations as f64 / motion.evaluations.max(1) as f64;
        let alike = ratio > ALIKE.min(1.5 * (tol / rougher(tol)).powf(0.125));
        // the errors of the steps grow on the way as those of the other run have grown to the difference of both; where that
        // difference is small by chance, errors of either sign still leave some of their sum
        let grows = if rough.path.erred > 0.0 { (off / rough.path.erred).max(1.0) } else { 1.0 };
        least += self.path.erred * if alike { grows } else { CHANCE };
        least += brief.unwrap_or(0.0);
        // errors that have grown until the two runs part are no longer in proportion to the tolerances
        let parted = PARTED * fastest;
        let grown = |off: f64| off * (claimed * parted / (parted - off).max(0.0)).min(1.0);
        let settled = |claim: f64, off: f64| if same { claim + grown(off) + least } else { f64::INFINITY };
        motion.error = settled(motion.error, off);
        // forces have been judged for errors of one tolerance: those of the state are so many times larger
        motion.force_error = settled(motion.force_error * (least / tol).max(1.0), pressed);
        // what turns so often is known to a few roundings of all its turning
        let angles = motion.poses.iter().flatten().last();
        let turning = angles.map_or(0.0, |pose| pose.phi.radians().abs() + pose.psi.radians().abs());
        motion.pose_error = settled(motion.pose_error, turned) + 32.0 * f64::EPSILON * turning;
    }
}
