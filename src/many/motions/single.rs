//! Single motions with their ends, for the initial states for which SIMD lanes have no result.

use super::{Answer, Job, MotionBlock, MotionOutput, Summary};
use crate::error::{Error, room};
use crate::laws::body::Body;
use crate::laws::state::State;
use crate::motions::exact::Swing;
use crate::motions::exact::extrema;
use crate::motions::motion;
use crate::motions::{Ending, Method};
use crate::numbers::larger_or_nan;

/// Number of times at which the extremes of a motion without an exact solution are sampled.
const EXTREME_SAMPLES: usize = 4000;

/// The result of a single motion up to its end or to the last time.
struct SingleMotion {
    states: Vec<State>,
    last: State,
    end: f64,
    ending: Ending,
    error: f64,
    answer: Answer,
}

/// The motion by the first integrals for a job that continues past events, so that only a landing of the face ends it.
/// None if the error is not finite, or if `go_on` returns false.
fn exact_without_events(
    swing: &Swing,
    start: &State,
    job: &Job<'_>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<SingleMotion>, Error> {
    let (span, way) = (job.span(), job.span().signum());
    let landing = swing.landing(way).filter(|(time, _)| *time <= span.abs());
    let end = landing.map_or(span, |(time, _)| way * time);
    // The error of an end includes that of its time.
    let error = swing.error(end) + landing.map_or(0.0, |_| swing.time_error(end));
    if !error.is_finite() {
        return Ok(None);
    }
    let times = &job.times[..job.times.partition_point(|t| t.abs() <= end.abs())];
    let mut states = room(times.len())?;
    for (j, t) in times.iter().enumerate() {
        if j % 64 == 63 && !go_on() {
            return Ok(None);
        }
        states.push(swing.state(*t));
    }
    Ok(Some(SingleMotion {
        last: landing.map_or(states.last().copied().unwrap_or(*start), |(_, y)| y),
        states,
        end,
        ending: if landing.is_some() { Ending::Face } else { Ending::Done },
        error,
        answer: Answer::Single,
    }))
}

/// The motion by the first integrals, with a search for all events that can end it.
fn exact_with_events(
    body: &Body,
    start: &State,
    job: &Job<'_>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<SingleMotion>, Error> {
    let Some(motion) = roll_or_none(body, start, job.times, job, go_on)? else { return Ok(None) };
    // A job that continues past events ends a motion only where the face lands.
    let event = motion.event.filter(|e| !job.ask.beyond || e.ending == Ending::Face);
    Ok(Some(SingleMotion {
        last: event.map_or(motion.states.last().copied().unwrap_or(*start), |e| e.state),
        end: event.map_or(job.span(), |e| e.time),
        ending: event.map_or(Ending::Done, |e| e.ending),
        error: motion.error,
        answer: match motion.method {
            Method::Exact => Answer::Single,
            Method::Tolerance(_) => Answer::Tolerance,
            Method::Step(_) => Answer::Step,
        },
        states: motion.states,
    }))
}

/// The motion at these times; None if the initial state has no motion. The only error is `Memory`.
fn roll_or_none(
    body: &Body,
    start: &State,
    times: &[f64],
    job: &Job<'_>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<motion::Motion>, Error> {
    match motion::roll_with(body, start, times, &job.ask, go_on) {
        Err(e @ Error::Memory { .. }) => Err(e),
        found => Ok(found.ok().flatten()),
    }
}

/// Computes motion `i` of a block alone and writes its results.
pub(super) fn roll(
    work: &MotionBlock<'_>,
    i: usize,
    out: &mut MotionOutput<'_>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<(), Error> {
    let (job, times) = (work.job, work.job.times.len());
    let start = work.starts.state(work.first + i);
    out.refuse(i, times);
    let Ok(body) = work.starts.body(work.first + i) else { return Ok(()) };
    let extremes =
        [Summary::ThetaMin, Summary::ThetaMax, Summary::NormalMin, Summary::FrictionCoefficientMax];
    let extremes_wanted = extremes.iter().any(|x| out.wants(*x));
    // These summaries are of one circle.
    let extremes_wanted = extremes_wanted && !body.has_row();
    let easily = job.ask.beyond && job.step().is_none();
    let turning = out.wants(Summary::PrecessionPerPeriod);
    let swing = if body.has_row() {
        None
    } else if easily || extremes_wanted || turning || out.wants(Summary::Period) {
        Swing::of(&body, &start, job.contact(), turning).ok()
    } else {
        None
    };
    let easy = swing.as_ref().filter(|_| easily);
    let found = easy.map_or(Ok(None), |swing| exact_without_events(swing, &start, job, go_on))?;
    let found =
        found.map_or_else(|| exact_with_events(&body, &start, job, go_on), |found| Ok(Some(found)))?;
    let Some(found) = found else { return Ok(()) };
    let SingleMotion { states, last, end, ending, error, answer } = found;
    out.tell(i, answer, ending as u8, error);
    for (j, y) in states.iter().enumerate() {
        out.put_state(i * times + j, y, [0.0; 2]);
    }
    out.put_last(i, &last, [0.0; 2]);
    out.put(Summary::End, i, end);
    if let Some(swing) = &swing {
        out.put(Summary::Period, i, swing.period());
        out.put(
            Summary::PrecessionPerPeriod,
            i,
            swing.angles_per_period().map_or(f64::NAN, |angles| angles.precession),
        );
        // The error of a motion includes those of period and precession.
        if swing.period().is_finite() {
            let timed = if out.wants(Summary::Period) { swing.period_error() } else { 0.0 };
            let turned = if turning { swing.precession_error() } else { 0.0 };
            out.error[i] = larger_or_nan(out.error[i], larger_or_nan(timed, turned));
        }
    }
    if extremes_wanted {
        let found = match &swing {
            Some(swing) if answer == Answer::Single => Some(extrema::extremes(swing, &body, end)),
            _ => {
                let times: Vec<f64> =
                    (1..=EXTREME_SAMPLES).map(|k| end * k as f64 / EXTREME_SAMPLES as f64).collect();
                roll_or_none(&body, &start, &times, job, go_on)?.map(|all| {
                    extrema::extremes_of(all.states.iter().chain([&start, &last]), &body, job.contact())
                })
            }
        };
        for (kind, value) in extremes.into_iter().zip(found.unwrap_or([f64::NAN; 4])) {
            out.put(kind, i, value);
        }
        // At lift-off the normal force vanishes, so that rolling would need infinite friction.
        if ending == Ending::LiftOff {
            out.put(Summary::FrictionCoefficientMax, i, f64::INFINITY);
        }
    }
    Ok(())
}
