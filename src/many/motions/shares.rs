//! Counts of the motions that are computed by one series, by marches and alone. These counts are the same on
//! every machine; they show whether a change moves motions to a slower method.

use super::{Job, MotionBlock, MotionOutput, MotionStarts};
use crate::laws::body::Body;
use crate::laws::contact::slip::Friction;
use crate::motions::Ask;
use crate::numbers::side_by_side::zero;
use crate::states::steady;
use core::f64::consts::FRAC_PI_2;

const COUNT: usize = 2048;

/// Bodies and states as columns of numbers.
type Starts = ([Vec<f64>; 5], [Vec<f64>; 4]);

/// Solid cylinders of ell 0.5 to 3 with a nutation, as in `docs/benchmarks.md`; for a `kick` of 0 random states.
fn starts(kick: f64) -> Starts {
    let (mut bodies, mut states): Starts = Default::default();
    for i in 0..COUNT {
        let spread = |by: usize| ((i * by % 65_536) as f64 + 0.5) / 65_536.0;
        let body = Body::solid(0.5 + 2.5 * (i as f64 + 0.5) / COUNT as f64).unwrap();
        let low = body.theta_balance().max(body.theta_limit());
        let theta = low + (FRAC_PI_2 - low) * (0.1 + 0.8 * spread(40_503));
        let random = || {
            let speed = |by: usize| 4.0 * spread(by) - 2.0;
            [0.1 + 1.4 * spread(25_717), speed(49_473), speed(37_345), speed(12_345)]
        };
        let kicked = || steady::state(&body, theta).unwrap().kicked(kick).into();
        let state: [f64; 4] = if kick > 0.0 { kicked() } else { random() };
        let shape = [body.ell(), body.i1(), body.i3(), body.fillet(), body.theta_end()];
        bodies.iter_mut().zip(shape).for_each(|(column, x)| column.push(x));
        states.iter_mut().zip(state).for_each(|(column, x)| column.push(x));
    }
    (bodies, states)
}

/// The number of motions of 2,048 that one series does not compute, and the number that SIMD lanes do not compute; None
/// without lanes.
fn left((bodies, states): &Starts, tol: f64, beyond: bool) -> Option<[usize; 2]> {
    let starts = MotionStarts::of(bodies.each_ref().map(Vec::as_slice), states.each_ref().map(Vec::as_slice));
    let times = [20.0];
    let job = Job { tol, ..Job::new(&times).with_ask(Ask { beyond, ..Ask::default() }) };
    let work = MotionBlock { starts: &starts, job: &job, first: 0, since: None };
    let (mut error, mut method, mut status) = (vec![0.0; COUNT], vec![0; COUNT], vec![0; COUNT]);
    let mut out = MotionOutput::new(&mut error, &mut method, &mut status);
    let (level, all) = (crate::numbers::level(), (0..COUNT).collect::<Vec<_>>());
    let marched = work.roll_by_series(zero(level?.as_avx2()?), &all, false, &mut out, &mut || true);
    Some([marched.len(), work.run(level, all, &mut out, &mut || true).len()])
}

/// Asserts, for each tolerance, upper bounds of the numbers of motions that need more than one series, and
/// that need to be computed alone.
fn holds(kick: f64, beyond: bool, most: [(f64, [usize; 2]); 4]) {
    let starts = starts(kick);
    for (tol, most) in most {
        let Some(found) = left(&starts, tol, beyond) else { return };
        assert!(
            found[0] <= most[0] && found[1] <= most[1],
            "{kick} {beyond} {tol:e}: {found:?} for {most:?}"
        );
    }
}

#[test]
fn one_series_answers_swings_of_any_width_that_go_on_beyond_their_ends() {
    holds(0.05, true, [(1e-6, [8, 1]), (1e-10, [8, 4]), (1e-12, [8, 8]), (1e-13, [8, 8])]);
    holds(0.4, true, [(1e-6, [8, 1]), (1e-10, [12, 1]), (1e-12, [12, 1]), (1e-13, [12, 1])]);
    holds(0.8, true, [(1e-6, [25, 1]), (1e-10, [30, 1]), (1e-12, [40, 1]), (1e-13, [40, 1])]);
}

#[test]
fn series_and_marches_leave_few_motions_that_end_to_be_computed_alone() {
    holds(0.05, false, [(1e-6, [35, 1]), (1e-10, [35, 1]), (1e-12, [40, 8]), (1e-13, [40, 8])]);
    holds(0.4, false, [(1e-6, [1900, 1]), (1e-10, [1950, 1]), (1e-12, [COUNT, 6]), (1e-13, [COUNT, 6])]);
    let all = |alone: usize| [COUNT, alone];
    holds(0.8, false, [(1e-6, all(1)), (1e-10, all(1)), (1e-12, all(1)), (1e-13, all(1))]);
    holds(0.0, false, [(1e-6, all(1)), (1e-10, all(3)), (1e-12, all(25)), (1e-13, all(25))]);
    holds(0.0, true, [(1e-6, all(5)), (1e-10, all(15)), (1e-12, all(380)), (1e-13, all(380))]);
}

/// The states at the end, the errors and the indices of the motions that are not computed in SIMD lanes, as bits, of
/// random states under static friction.
fn rubbing(since: Option<&[f64]>, times: &[f64]) -> Option<(Vec<u64>, Vec<usize>)> {
    let (bodies, states) = starts(0.0);
    let states =
        states.map(|x| x.iter().map(|x| if *x < 0.0 { 0.4 * x } else { 0.6 * x }).collect::<Vec<_>>());
    let mut starts =
        MotionStarts::of(bodies.each_ref().map(Vec::as_slice), states.each_ref().map(Vec::as_slice));
    starts.coefficients = Some([&[0.3], &[0.4], &[0.0]]);
    let job = Job { tol: 1e-12, ..Job::new(times).with_ask(Ask::on(Friction::coulomb(0.3))) };
    let work = MotionBlock { starts: &starts, job: &job, first: 0, since };
    let (mut error, mut method, mut status) = (vec![0.0; COUNT], vec![0; COUNT], vec![0; COUNT]);
    let mut last: [Vec<f64>; 4] = core::array::from_fn(|_| vec![0.0; COUNT]);
    let mut out = MotionOutput::new(&mut error, &mut method, &mut status);
    out.last = Some(last.each_mut().map(Vec::as_mut_slice));
    let level = crate::numbers::level();
    level?.as_avx2()?;
    let left = work.run(level, (0..COUNT).collect(), &mut out, &mut || true);
    for i in &left {
        (error[*i], status[*i]) = (0.0, 0);
        last.iter_mut().for_each(|x| x[*i] = 0.0);
    }
    let bits = last.iter().flatten().chain(&error).map(|x| x.to_bits());
    Some((bits.chain(status.iter().map(|x| u64::from(*x))).collect(), left))
}

#[test]
fn lanes_compute_almost_all_phases_of_rolling_that_end_by_slip_wherever_they_begin() {
    let Some((at_once, left)) = rubbing(None, &[8.0]) else { return };
    assert!(left.len() <= 120, "{}", left.len());
    // All later times are exact sums of the time at which a phase begins and a time after that.
    let since: Vec<f64> = (0..COUNT).map(|_| 4.0).collect();
    let Some((later, others)) = rubbing(Some(&since), &[12.0]) else { return };
    assert!(later == at_once && others == left);
}
