//! Many motions at a time under dry friction, some of which never slip, slip for a while, or hop.

use crate::common::many::{body_columns, with_summaries};
use crate::common::{larger, numbers, path_of, wander};
use core::f64::consts::FRAC_PI_2;
use spincyl::contact::{Friction, Table, TableKind};
use spincyl::ensemble::{Answer, Job, MotionOutput, MotionStarts, SUMMARIES, Summary, roll};
use spincyl::motion::path::Kind;
use spincyl::motion::{Ask, Ending, Method, Motion, Start, roll_with};
use spincyl::{Body, Error, State, steady};

/// A body, its initial state, and the coefficients of sliding and of static friction.
type Scene = (Body, State, [f64; 2]);
type Scenes = Vec<Scene>;

/// The columns of a sweep: at all times, at the end, and its summaries.
#[derive(Default)]
struct Swept {
    states: [Vec<f64>; 4],
    last: [Vec<f64>; 4],
    sums: [Vec<f64>; SUMMARIES],
    error: Vec<f64>,
    method: Vec<u8>,
    status: Vec<u8>,
}

impl Swept {
    fn of(all: &Scenes, job: &Job<'_>) -> Self {
        let column = |f: &dyn Fn(&Scene) -> f64| all.iter().map(f).collect::<Vec<f64>>();
        let bodies =
            [Body::ell, Body::i1, Body::i3, Body::fillet, Body::theta_end].map(|x| column(&|a| x(&a.0)));
        let states = [0, 1, 2, 3].map(|k| column(&|a| numbers(&a.1)[k]));
        let [mu, fixed] = [0, 1].map(|k| column(&|a| a.2[k]));
        let columns = body_columns(bodies.each_ref().map(Vec::as_slice));
        let mut starts = MotionStarts::new(columns, states.each_ref().map(Vec::as_slice));
        if job.ask.table.rubs() {
            starts = starts.with_friction(&mu, &fixed, &[0.0]);
        }
        let (count, times) = (all.len(), job.times.len());
        let mut to = Self {
            states: [(); 4].map(|()| vec![7.0; count * times]),
            last: [(); 4].map(|()| vec![7.0; count]),
            sums: core::array::from_fn(|_| vec![7.0; count]),
            error: vec![7.0; count],
            method: vec![7; count],
            status: vec![7; count],
        };
        let out = MotionOutput::new(&mut to.error, &mut to.method, &mut to.status)
            .with_states(to.states.each_mut().map(Vec::as_mut_slice))
            .with_last(to.last.each_mut().map(Vec::as_mut_slice));
        assert!(roll(&starts, job, with_summaries(out, &mut to.sums), 1, |_| true).unwrap());
        to
    }

    /// All results except the errors, as bits.
    fn bits(&self) -> Vec<u64> {
        let columns = self.states.iter().chain(&self.last).chain(&self.sums);
        let numbers = columns.flatten().map(|x| if x.is_nan() { f64::NAN } else { *x }.to_bits());
        numbers.chain(self.method.iter().chain(&self.status).map(|x| u64::from(*x))).collect()
    }
}

/// Cylinders, tubes, rounded cylinders and disks, as they go round on a rim, at a coefficient near what rolling needs.
fn scenes(count: usize, seed: u64) -> Scenes {
    let mut r = wander(seed);
    (0..count)
        .map(|i| {
            let body = match i % 4 {
                0 => Body::solid(0.05 + 2.9 * r()),
                1 => Body::tube(0.3 + 3.0 * r(), r()),
                2 => Body::rounded_tube(0.8 + r(), 0.0, 0.05 + 0.4 * r()),
                _ => Body::solid(0.0),
            };
            let body = body.unwrap();
            let mut speed = || 1.4 * (r() + r() - 1.0);
            let still = State { theta: 0.9, w1: speed(), w2: speed(), w3: speed() };
            let theta = body.theta_limit().max(body.theta_balance()).max(0.3);
            let theta = theta + (FRAC_PI_2 - theta) * (0.1 + 0.8 * r());
            let y = match steady::state(&body, theta) {
                Ok(y) if i % 3 > 0 => y.kicked(0.4 * r()),
                _ => State { theta, ..still },
            };
            // A large coefficient may be above that of Painleve.
            let mu = (0.05 + 1.5 * r() * r()) * if i % 5 == 0 { 8.0 } else { 1.0 };
            (body, y, [mu, if r() < 0.5 { mu } else { mu * (1.0 + r()) }])
        })
        .collect()
}

fn alone((body, y, [mu, fixed]): &(Body, State, [f64; 2]), job: &Job<'_>) -> Result<Motion, Error> {
    let table = Friction::Coulomb { mu: *mu, fixed: *fixed, patch: 0.0 };
    let mut ask = Ask::on(table).with_method(Method::Tolerance(job.tol));
    ask.restitution = job.ask.restitution;
    let found = roll_with(body, Start::from(*y), job.times, &ask, || true);
    found.map(|motion| motion.expect("nobody interrupts"))
}

#[test]
fn a_body_that_static_friction_holds_moves_as_with_a_largest_coefficient_and_by_the_same_method() {
    let all: Scenes = (0..600)
        .map(|i| {
            let body = Body::solid(0.9 + 2.1 * f64::from(i) / 600.0).unwrap();
            (body, steady::state(&body, 1.3).unwrap().kicked(0.05), [5.0; 2])
        })
        .collect();
    let limited = Job::new(&[20.0]).with_ask(Ask::on(Table::Rolling { mu: 5.0 })).with_tol(1e-8);
    let rolling = Swept::of(&all, &limited);
    let rubbing = Swept::of(&all, &limited.with_ask(limited.ask.with_table(TableKind::Coulomb)));
    assert!(rubbing.status.iter().all(|status| *status == Ending::Done as u8));
    if rolling.method[0] == Answer::Lanes as u8 {
        assert!(rubbing.method == rolling.method && rubbing.error == rolling.error);
        assert!(rubbing.last == rolling.last);
    }
    // The friction that holds such a body may have a limit above that of Painleve.
    assert!(rubbing.sums[Summary::Phases as usize].iter().all(|count| *count == 1.0));
    for (name, right) in [(Summary::SlipTime, 0.0), (Summary::Dissipated, 0.0), (Summary::RollingTime, 0.0)] {
        assert!(rubbing.sums[name as usize].iter().all(|x| *x == right), "{name:?}");
    }
}

#[test]
fn side_by_side_under_dry_friction_a_motion_is_what_it_is_alone() {
    let (mut known, mut refused, mut kinds) = (0, 0, [0; 16]);
    for (k, restitution) in [None, Some(0.0), Some(0.5)].into_iter().enumerate() {
        for times in [&[12.0][..], &[0.0, 1.5, 6.0, 12.0]] {
            let all = scenes(if restitution.is_none() { 160 } else { 30 }, 40 + k as u64);
            let job = Job::new(times)
                .with_ask(Ask::on(TableKind::Coulomb).with_restitution(restitution))
                .with_tol([1e-6, 1e-9, 1e-12][k]);
            let found = Swept::of(&all, &job);
            for (i, scene) in all.iter().enumerate() {
                let motion = match alone(scene, &job) {
                    Ok(motion) => motion,
                    Err(e) => {
                        assert!(matches!(e, Error::Painleve { .. }), "{e} {scene:?}");
                        assert_eq!(found.status[i], Ending::Painleve as u8, "{i}: {scene:?}");
                        refused += 1;
                        continue;
                    }
                };
                let claim = motion.error + found.error[i];
                kinds[usize::from(found.status[i])] += 1;
                if claim.is_nan() || claim > 1e-3 {
                    continue;
                }
                known += 1;
                assert_eq!(motion.ending() as u8, found.status[i], "{i}: {scene:?}");
                if restitution.is_none() {
                    let phases = path_of(&motion).phases.len() as f64;
                    assert_eq!(found.sums[Summary::Phases as usize][i], phases, "{i}: {scene:?}");
                }
                let mut there: Vec<([f64; 4], [f64; 4])> = Vec::new();
                for (j, y) in motion.states.iter().enumerate() {
                    let row = i * times.len() + j;
                    there.push((numbers(y), found.states.each_ref().map(|x| x[row])));
                }
                if let Some(event) = motion.event {
                    there.push((numbers(&event.state), found.last.each_ref().map(|x| x[i])));
                }
                for (right, seen) in there {
                    let off = right.iter().zip(seen).map(|(a, b)| (a - b).abs()).fold(0.0, larger);
                    assert!(off <= 2.0 * claim, "{i}: {off:e} of {claim:e}, {scene:?}");
                }
            }
        }
    }
    assert!(known > 150 && kinds[0] > 50, "{known} {refused} {kinds:?}");
}

#[test]
fn a_slip_that_passes_by_zero_goes_on_although_static_friction_would_hold_it() {
    // The speed falls to 4e-8, in a direction from which the slip turns away the faster, the slower it is.
    let body = Body::new(2.808382141997093, 2.901021546484324, 0.5440362559765276).unwrap();
    let y = State {
        theta: 1.3575242077105927,
        w1: 1.678034898772723,
        w2: -0.19962088694986957,
        w3: 4.712563243361215,
    };
    let scene = (body, y, [0.09500249511438211, 0.13338357427089176]);
    for tol in [1e-5, 1e-6, 1e-7, 1e-8] {
        let m = alone(&scene, &Job::new(&[12.0]).with_tol(tol)).unwrap();
        assert!(path_of(&m).phases.len() == 1 && m.error < 1e3 * tol, "{tol:e}: {:e}", m.error);
    }
}

#[test]
fn rolling_between_slips_takes_steps_and_rolling_for_ever_none() {
    let (mut count, mut stepped) = (0, 0);
    for scene in scenes(240, 44) {
        let run = |tol: f64, until: f64| alone(&scene, &Job::new(&[until]).with_tol(tol));
        let Ok(m) = run(1e-8, 300.0) else { continue };
        let phases = &path_of(&m).phases;
        let Some(last) = phases.last() else { continue };
        if phases.len() < 3 || m.event.is_some() || last.kind != Kind::Rolling || last.time > 60.0 {
            continue;
        }
        let [fine, later] = [run(1e-12, 300.0), run(1e-8, 3e4)].map(Result::unwrap);
        assert_eq!(later.evaluations, m.evaluations, "{scene:?}");
        // At finer tolerances the first integrals solve all of the rolling, and only slips take steps.
        let [looser, finer] = [3.1e-10, 2.9e-10].map(|tol| run(tol, 300.0).unwrap().evaluations);
        stepped += usize::from(looser > finer);
        let off = numbers(&m.states[0]).into_iter().zip(numbers(&fine.states[0])).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, larger);
        assert!(off <= m.error + fine.error, "{off:e} of {:e}, {scene:?}", m.error);
        count += 1;
    }
    assert!(count > 5 && stepped > 2, "{stepped} of {count}");
}

#[test]
fn without_estimated_errors_a_motion_has_the_same_bits() {
    for restitution in [None, Some(0.5)] {
        let job = Job::new(&[2.0, 9.0])
            .with_ask(Ask::on(TableKind::Coulomb).with_restitution(restitution))
            .with_tol(1e-8);
        let all = scenes(60, 50);
        let [with, without] = [job, job.without_errors()].map(|job| Swept::of(&all, &job));
        assert!(with.bits() == without.bits());
        for i in 0..all.len() {
            let integrated = without.method[i] == Answer::Flow as u8;
            assert!(if integrated {
                without.error[i].is_nan()
            } else {
                without.error[i] == with.error[i] || with.error[i].is_nan()
            });
        }
        assert!(with.error.iter().filter(|x| x.is_finite()).count() > 40);
    }
}
