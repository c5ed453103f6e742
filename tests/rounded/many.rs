//! Many motions at once: rounded and sharp bodies in lanes, side by side.

use crate::common::{any_rounded, any_state, by, distance, moved, numbers, wander};
use proptest::prelude::*;
use spincyl::contact::Table;
use spincyl::ensemble::{Answer, INVALID, Job, MotionOutput, MotionStarts, SUMMARIES, Summary, roll};
use spincyl::exact::Swing;
use spincyl::motion::{Ask, Ending, Method};
use spincyl::{Body, Contact, State, steady};

/// What was found of motion i: [theta, w1, w2, w3] at each time, summaries, error, method, status.
struct Found {
    states: Vec<State>,
    sums: [f64; SUMMARIES],
    error: f64,
    method: u8,
    status: u8,
}

impl Found {
    fn bits(&self) -> Vec<u64> {
        let mut all: Vec<f64> = self.states.iter().flat_map(numbers).collect();
        all.extend(self.sums);
        all.extend([self.error, self.method.into(), self.status.into()]);
        all.into_iter().map(f64::to_bits).collect()
    }
}

fn run(all: &[(Body, State)], job: &Job<'_>, threads: usize) -> Vec<Found> {
    let numbers_of = |b: &Body| [b.ell(), b.i1(), b.i3(), b.fillet(), b.theta_end()];
    let body: [Vec<f64>; 5] = core::array::from_fn(|k| all.iter().map(|(b, _)| numbers_of(b)[k]).collect());
    let state: [Vec<f64>; 4] = core::array::from_fn(|k| all.iter().map(|(_, y)| numbers(y)[k]).collect());
    run_columns(&body, &state, job, threads)
}

fn run_columns(body: &[Vec<f64>; 5], state: &[Vec<f64>; 4], job: &Job<'_>, threads: usize) -> Vec<Found> {
    let starts = MotionStarts::new(body.each_ref().map(Vec::as_slice), state.each_ref().map(Vec::as_slice));
    let (count, times) = (starts.len(), job.times.len());
    let mut states: [Vec<f64>; 4] = core::array::from_fn(|_| vec![7.0; count * times]);
    let mut sums: [Vec<f64>; SUMMARIES] = core::array::from_fn(|_| vec![7.0; count]);
    let (mut error, mut method, mut status) = (vec![7.0; count], vec![77; count], vec![77; count]);
    let out = MotionOutput {
        states: Some(states.each_mut().map(Vec::as_mut_slice)),
        summary: sums.each_mut().map(|x| Some(x.as_mut_slice())),
        ..MotionOutput::new(&mut error, &mut method, &mut status)
    };
    assert!(roll(&starts, job, out, threads, |_| true).unwrap());
    (0..count)
        .map(|i| Found {
            states: (0..times).map(|j| State::from(states.each_ref().map(|x| x[i * times + j]))).collect(),
            sums: sums.each_ref().map(|x| x[i]),
            error: error[i],
            method: method[i],
            status: status[i],
        })
        .collect()
}

/// Kicks out of steady states of rounded bodies: coins, cans, tubes, fat disks, balls.
fn kicked(count: usize) -> Vec<(Body, State)> {
    let mut r = wander(29);
    let mut all = Vec::new();
    while all.len() < count {
        let fillet = [0.01, 0.1, 0.5, 1.0, 1e-9][all.len() % 5] * (0.5 + 0.5 * r());
        let body = match all.len() % 4 {
            0 => Body::balls(1.0 + r()).unwrap(),
            1 => Body::ball(0.8 * (2.0 * r() - 1.0), 0.3 + 0.2 * r(), 0.4).unwrap(),
            2 => Body::rounded_tube(fillet + 2.0 * r(), 0.0, fillet).unwrap(),
            _ => Body::rounded_tube(fillet + 2.0 * r(), (1.0 - fillet) * r(), fillet).unwrap(),
        };
        let kick = [0.0, 1e-6, 0.05, 0.1, 0.4, 0.8][all.len() % 6] * (0.5 + r());
        let theta = (0.05 + 0.9 * r()) * body.theta_end();
        if let Ok(y) = steady::state(&body, theta)
            && numbers(&y).iter().all(|x| x.abs() < 30.0)
        {
            all.push((body, y.kicked(kick)));
        }
    }
    all
}

/// The same of sharp ones.
fn sharp(count: usize) -> Vec<(Body, State)> {
    let mut r = wander(31);
    let mut all = Vec::new();
    while all.len() < count {
        let body = Body::tube(0.3 + 2.0 * r(), r()).unwrap();
        if let Ok(y) = steady::state(&body, 0.1 + 1.4 * r())
            && y.w1 < 10.0
        {
            all.push((body, y.kicked(0.1 * r())));
        }
    }
    all
}

#[test]
fn rounded_bodies_in_lanes_and_alone_agree_within_what_both_claim() {
    let all = kicked(2000);
    let times = [0.3, 5.0, 40.0];
    for contact in [Contact::Rolling, Contact::Smooth] {
        for tol in [1e-6, 1e-11] {
            let many = run(&all, &Job { table: contact.into(), tol, beyond: true, ..Job::new(&times) }, 2);
            let mut lanes = 0;
            for (found, (body, start)) in many.iter().zip(&all) {
                let in_lanes = found.method == Answer::Lanes as u8;
                lanes += usize::from(in_lanes);
                let Ok(swing) = Swing::new(body, start, contact, true) else { continue };
                for (y, t) in found.states.iter().zip(&times) {
                    if y.theta.is_nan() {
                        assert!(swing.landing(1.0).is_some() && !in_lanes);
                        continue;
                    }
                    let off = distance(y, &numbers(&swing.state(*t)));
                    let claimed = found.error + swing.error(*t);
                    assert!(
                        off <= claimed,
                        "{body:?} {start:?} {contact:?} at {t}: {off:e} > {claimed:e}, {}",
                        found.method
                    );
                }
                if in_lanes && swing.error(40.0) < 1e-9 {
                    let near = |a: f64, b: f64| (a - b).abs() <= 1e3 * tol * (1.0 + b.abs());
                    assert!(
                        near(found.sums[Summary::Period as usize], swing.period()),
                        "{body:?} {start:?}: period"
                    );
                    let [phi, _] = swing.angles_per_period().unwrap();
                    assert!(
                        near(found.sums[Summary::PrecessionPerPeriod as usize], phi),
                        "{body:?} {start:?}: precession"
                    );
                }
            }
            assert!(lanes > 1000, "{contact:?} {tol:e}: {lanes} of {}", all.len());
        }
    }
}

#[test]
fn rounded_motions_in_lanes_end_as_they_do_alone() {
    let mut all = kicked(800);
    all.extend(sharp(200));
    let times = [2.0, 8.0];
    for mu in [f64::INFINITY, 0.3] {
        let many = run(&all, &Job { mu, ..Job::new(&times) }, 2);
        let mut ended = 0;
        for (found, (body, y)) in many.iter().zip(&all) {
            let alone =
                moved(body, y, &times, Ask { table: Table::Rolling { mu }, ..Ask::default() }).unwrap();
            assert_eq!(found.status, alone.ending() as u8, "{body:?} {y:?}: {}", found.method);
            ended += usize::from(alone.ending() != Ending::Done);
            let end = alone.event.map_or(8.0, |e| e.time);
            assert!((found.sums[Summary::End as usize] - end).abs() <= alone.error + 1e-9);
            if end < 8.0 {
                assert!(found.states[1].theta.is_nan(), "nothing after an end");
            }
        }
        assert!(ended > 50, "{ended}");
    }
}

#[test]
fn no_bit_of_rounded_and_sharp_motions_depends_on_their_neighbours_or_on_threads() {
    // a sharp body between two rounded ones, in the same eight lanes
    let (round, flat) = (kicked(1200), sharp(1200));
    let mixed: Vec<_> = round.iter().zip(&flat).flat_map(|(a, b)| [*a, *b]).collect();
    let times = [3.0, 20.0];
    for step in [None, Some(0.02)] {
        let count = if step.is_some() { 200 } else { 1200 };
        let job = Job { step, ..Job::new(&times) };
        let (of_round, of_flat) = (run(&round[..count], &job, 1), run(&flat[..count], &job, 1));
        for threads in [1, 2, 5] {
            let whole = run(&mixed[..2 * count], &job, threads);
            for i in 0..count {
                assert_eq!(whole[2 * i].bits(), of_round[i].bits(), "{:?}", round[i]);
                assert_eq!(whole[2 * i + 1].bits(), of_flat[i].bits(), "{:?}", flat[i]);
            }
        }
        for i in (0..count).step_by(41) {
            assert_eq!(run(&round[i..i + 1], &job, 1)[0].bits(), of_round[i].bits(), "alone: {:?}", round[i]);
        }
    }
}

#[test]
fn a_fillet_of_nothing_and_an_end_of_its_own_are_what_a_body_has_by_itself() {
    let all = sharp(100);
    let times = [6.0];
    let job = Job::new(&times);
    let column = |f: fn(&Body) -> f64| all.iter().map(|(b, _)| f(b)).collect::<Vec<_>>();
    let state: [Vec<f64>; 4] = core::array::from_fn(|k| all.iter().map(|(_, y)| numbers(y)[k]).collect());
    let three = [column(Body::ell), column(Body::i1), column(Body::i3)];
    let [ell, i1, i3] = three;
    let plain =
        run_columns(&[ell.clone(), i1.clone(), i3.clone(), vec![0.0], vec![f64::NAN]], &state, &job, 1);
    let same = run(&all, &job, 2);
    assert!(plain.iter().zip(&same).all(|(a, b)| a.bits() == b.bits()));
    // a cap that lands at 1.2 ends every motion that gets there
    let capped = run_columns(&[ell, i1, i3, vec![0.0], vec![1.2]], &state, &job, 1);
    let mut ended = 0;
    for (found, (body, y)) in capped.iter().zip(&all) {
        let alone = moved(&body.with_theta_end(1.2).unwrap(), y, &times, Ask::default()).unwrap();
        assert_eq!(found.status, alone.ending() as u8, "{body:?} {y:?}");
        ended += usize::from(alone.ending() == Ending::Side);
    }
    assert!(ended > 20, "{ended}");
}

#[test]
fn what_is_no_rounded_body_is_marked() {
    let balls = Body::balls(1.0).unwrap();
    let good = (balls, steady::state(&balls, 1.4).unwrap().kicked(0.01));
    let times = [1.0];
    let all = [good; 12];
    let mut body: [Vec<f64>; 5] =
        core::array::from_fn(|k| vec![[1.0, 1.4, 0.4, 1.0, f64::NAN][k]; all.len()]);
    let state: [Vec<f64>; 4] = core::array::from_fn(|k| vec![numbers(&good.1)[k]; all.len()]);
    (body[3][0], body[3][1], body[3][2]) = (-0.1, 1.5, f64::NAN);
    // a rim is not below the centre of mass, a ball is not outside of itself
    (body[0][3], body[3][3]) = (-0.5, 0.5);
    body[0][4] = -1.0;
    (body[4][5], body[4][6]) = (-1.0, 4.0);
    let many = run_columns(&body, &state, &Job::new(&times), 1);
    for (i, found) in many.iter().enumerate() {
        assert_eq!(found.status == INVALID, i < 7, "{i}");
        assert_eq!(found.states[0].theta.is_nan() && found.error.is_nan(), i < 7, "{i}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn no_state_of_a_rounded_body_gives_a_wrong_number_unmarked(
        body in any_rounded(), y in any_state(), t in 0.0..30.0f64, smooth in any::<bool>(),
    ) {
        let contact = if smooth { Contact::Smooth } else { Contact::Rolling };
        let times = [t];
        let found = &run(&[(body, y)], &Job { table: contact.into(), beyond: true, ..Job::new(&times) }, 1)[0];
        if found.method == Answer::Lanes as u8 {
            let scene = Ask { table: contact.into(), beyond: true, ..by(Method::Tolerance(1e-12)) };
            let alone = moved(&body, &y, &times, scene).unwrap();
            // a face that lands at the time that is asked for has landed for one of them
            if let Some(there) = alone.states.first() {
                let off = distance(&found.states[0], &numbers(there));
                // RK4's error is an estimate, of the right size
                prop_assert!(off <= found.error + 2.0 * alone.error, "{} > {} + {}", off, found.error, alone.error);
            }
        }
    }
}
