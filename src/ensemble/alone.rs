//! One motion at a time, with its ends: those that the lanes leave over.

use super::{Answer, Harvest, INVALID, Job, Summary};
use crate::body::Body;
use crate::exact::Swing;
use crate::motion::{self, Ending, Method};
use crate::state::State;

/// Times at which the extremes of a motion without an exact solution are looked for.
const LOOKS: usize = 4000;

/// Motion `i` of a block.
pub(super) fn roll(
    ([ell, i1, i3], state): ([f64; 3], [f64; 4]),
    job: &Job<'_>,
    i: usize,
    out: &mut Harvest<'_>,
    still: &mut dyn FnMut() -> bool,
) {
    let start = State::from(state);
    blank(job, i, out);
    let Ok(body) = Body::new(ell, i1, i3) else { return };
    let scene = job.scene();
    let Ok(Some(motion)) = motion::roll(&body, &start, 0.0, job.times, &scene, &mut *still) else { return };
    out.error[i] = motion.error;
    out.status[i] = motion.ending() as u8;
    out.method[i] = match motion.method {
        Method::Exact => Answer::Alone,
        Method::Tolerance(_) => Answer::Tolerance,
        Method::Step(_) => Answer::Step,
    } as u8;
    let columns = |y: &State| <[f64; 4]>::from(*y);
    if let Some(states) = &mut out.states {
        for (j, y) in motion.states.iter().enumerate() {
            for (column, value) in states.iter_mut().zip(columns(y)) {
                column[i * job.times.len() + j] = value;
            }
        }
    }
    let stays = job.beyond && motion.ending() != Ending::Face;
    let (end, last) = match motion.event.filter(|_| !stays) {
        Some(event) => (event.time, event.state),
        None => (job.span(), motion.states.last().copied().unwrap_or(start)),
    };
    if let Some(column) = &mut out.last {
        for (column, value) in column.iter_mut().zip(columns(&last)) {
            column[i] = value;
        }
    }
    out.put(Summary::End, i, motion.event.map_or(end, |e| e.time));
    let turning = out.wants(Summary::Precession);
    if turning || out.wants(Summary::Period) {
        if let Ok(swing) = Swing::new(&body, &start, job.contact, turning) {
            out.put(Summary::Period, i, swing.period());
            out.put(Summary::Precession, i, swing.angles_per_period().map_or(f64::NAN, |[phi, _]| phi));
        }
    }
    let extremes = [Summary::ThetaMin, Summary::ThetaMax, Summary::NormalMin, Summary::FrictionMax];
    if extremes.iter().any(|x| out.wants(*x)) {
        let found = match Swing::new(&body, &start, job.contact, false) {
            Ok(swing) if motion.method == Method::Exact => Some(motion::extremes(&swing, &body, end)),
            _ => {
                let times: Vec<f64> = (1..=LOOKS).map(|k| end * k as f64 / LOOKS as f64).collect();
                let all = motion::roll(&body, &start, 0.0, &times, &scene, &mut *still).ok().flatten();
                all.map(|all| motion::extremes_of(all.states.iter().chain([&start, &last]), &body, job.contact))
            }
        };
        for (kind, value) in extremes.into_iter().zip(found.unwrap_or([f64::NAN; 4])) {
            out.put(kind, i, value);
        }
    }
}

/// No answer.
fn blank(job: &Job<'_>, i: usize, out: &mut Harvest<'_>) {
    let times = job.times.len();
    for column in out.states.iter_mut().flatten() {
        column[i * times..(i + 1) * times].fill(f64::NAN);
    }
    for column in out.last.iter_mut().flatten() {
        column[i] = f64::NAN;
    }
    for column in out.summary.iter_mut().flatten() {
        column[i] = f64::NAN;
    }
    out.error[i] = f64::NAN;
    (out.method[i], out.status[i]) = (Answer::None as u8, INVALID);
}
