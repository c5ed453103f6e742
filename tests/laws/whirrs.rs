//! Many motions with losses at once, against motions one at a time.

use crate::common::many::{LAWS, body_columns, loss_columns, with_summaries};
use core::f64::consts::FRAC_PI_2;
use spincyl::contact::{Table, TableKind};
use spincyl::ensemble::{Job, MotionOutput, MotionStarts, SUMMARIES, Summary, roll};
use spincyl::loss::{Law, Losses};
use spincyl::motion::{Ask, Ending, Method, roll_with};
use spincyl::{Body, State};

/// Bodies, states and losses as columns of numbers.
struct Scene {
    bodies: [Vec<f64>; 5],
    states: [Vec<f64>; 4],
    losses: [Vec<f64>; LAWS],
}

impl Scene {
    /// Random disks and tubes, sharp and rounded, from rest and turning, under each loss law alone, under all and
    /// under none.
    fn of(count: usize) -> Self {
        let (mut bodies, mut states, mut losses) =
            <([Vec<f64>; 5], [Vec<f64>; 4], [Vec<f64>; LAWS])>::default();
        let share = |i: usize, step: usize| ((i * step) % 1009) as f64 / 1009.0;
        for i in 0..count {
            let fillet = if i % 3 == 0 { 0.3 * share(i, 71) } else { 0.0 };
            let body = Body::rounded(2.0 * share(i, 31), 0.4 + share(i, 17), 0.5, fillet).unwrap();
            for (x, to) in [body.ell(), body.i1(), body.i3(), fillet, f64::NAN].into_iter().zip(&mut bodies) {
                to.push(x);
            }
            let theta = 0.05 + (FRAC_PI_2 - 0.1) * share(i, 457);
            let moves = f64::from(u8::from(i % 7 != 0));
            let w = [3.0 * share(i, 211) - 1.5, share(i, 83) - 0.5, 3.0 * share(i, 149) - 1.5];
            for (x, to) in [theta, moves * w[0], moves * w[1], moves * w[2]].into_iter().zip(&mut states) {
                to.push(x);
            }
            for (law, to) in losses.iter_mut().enumerate() {
                let there = i % 10 == law || i % 10 == 8;
                to.push(if there { 10f64.powf(-1.5 - 2.0 * share(i, 59 + law)) } else { 0.0 });
            }
        }
        Self { bodies, states, losses }
    }

    fn losses(&self, i: usize) -> Losses {
        Law::ALL.iter().fold(Losses::NONE, |all, law| all.with(*law, self.losses[*law as usize][i]))
    }

    /// Computes the motions. Returns the ends, sums, estimated errors and status.
    fn run(&self, on: TableKind, times: &[f64], threads: usize) -> (Vec<Vec<f64>>, Vec<u8>) {
        let count = self.states[0].len();
        let bodies = body_columns(core::array::from_fn(|k| &self.bodies[k][..]));
        let starts = MotionStarts::new(bodies, core::array::from_fn(|k| &self.states[k][..]))
            .with_losses(loss_columns(&self.losses));
        let mut found = vec![vec![7.0; count]; 6 + SUMMARIES + 1];
        let (mut method, mut status) = (vec![9; count], vec![9; count]);
        let (ends, others) = found.split_at_mut(6);
        let (sums, claims) = others.split_at_mut(SUMMARIES);
        let mut columns = ends.iter_mut().map(Vec::as_mut_slice);
        let mut next = || columns.next().unwrap();
        let out = MotionOutput::new(&mut claims[0], &mut method, &mut status)
            .with_last(core::array::from_fn(|_| next()))
            .with_last_slip(next(), next());
        let out = with_summaries(out, sums);
        let job = Job::new(times).with_ask(Ask::on(on)).with_tol(1e-11);
        assert!(roll(&starts, &job, out, threads, |_| true).unwrap());
        (found, status)
    }
}

const END: usize = 6 + Summary::End as usize;
const LOST: usize = 6 + Summary::WorkLost as usize;
const CLAIM: usize = 6 + SUMMARIES;
const SCENES: [(TableKind, Table); 2] =
    [(TableKind::Rolling, Table::Rolling { mu: f64::INFINITY }), (TableKind::Smooth, Table::Smooth)];

#[test]
fn side_by_side_a_body_loses_what_it_loses_alone_and_ends_as_it_does() {
    let scene = Scene::of(200);
    for (on, table) in SCENES {
        let (found, status) = scene.run(on, &[20.0], 2);
        let mut ended = 0;
        for i in 0..200 {
            let [ell, i1, i3, fillet, _] = core::array::from_fn(|k| scene.bodies[k][i]);
            let body = Body::rounded(ell, i1, i3, fillet).unwrap();
            let start = State::from(core::array::from_fn(|k| scene.states[k][i]));
            let ask = Ask::on(table).with_losses(scene.losses(i)).with_method(Method::Tolerance(1e-11));
            let Ok(path) = roll_with(&body, start, &[20.0], &ask, || true) else {
                assert_eq!(status[i], Ending::Invalid as u8, "{i}");
                continue;
            };
            let path = path.unwrap();
            // each claim holds within a factor of ten, as `benches/kinds/losses.py` has it
            let claim = 10.0 * (found[CLAIM][i] + path.error);
            if claim.is_infinite() {
                continue;
            }
            assert_eq!(path.ending() as u8, status[i], "{i} {on:?}");
            let (y, time) = path.event.map_or_else(|| (path.states[0], 20.0), |e| (e.state, e.time));
            ended += usize::from(path.event.is_some());
            for (k, x) in <[f64; 4]>::from(y).into_iter().enumerate() {
                assert!((found[k][i] - x).abs() <= claim, "{i} {on:?} {k}: {} {x} {claim}", found[k][i]);
            }
            assert!((found[END][i] - time).abs() <= claim, "{i} {on:?}");
            let fastest = 1.0 + start.w1.abs() + start.w3.abs();
            assert!(
                (found[LOST][i] - path.path.as_ref().map_or(0.0, |path| path.lost)).abs() <= claim * fastest,
                "{i} {on:?}"
            );
        }
        assert!(ended > 50, "{ended}");
    }
}

#[test]
fn side_by_side_a_whirr_has_the_same_bits_whatever_its_neighbours() {
    let scene = Scene::of(300);
    let bits = |x: &[Vec<f64>]| x.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
    for (on, _) in SCENES {
        let (found, status) = scene.run(on, &[3.0, 12.0], 1);
        for threads in [2, 3] {
            let (again, codes) = scene.run(on, &[3.0, 12.0], threads);
            assert!(bits(&again) == bits(&found) && codes == status);
        }
        let order: Vec<usize> = (0..300).map(|i| (i * 77) % 300).step_by(11).collect();
        let pick = |x: &Vec<f64>| order.iter().map(|i| x[*i]).collect::<Vec<_>>();
        let some = Scene {
            bodies: scene.bodies.each_ref().map(pick),
            states: scene.states.each_ref().map(pick),
            losses: scene.losses.each_ref().map(pick),
        };
        let (again, _) = some.run(on, &[3.0, 12.0], 1);
        assert!(bits(&again) == bits(&found.iter().map(pick).collect::<Vec<_>>()));
    }
}

#[test]
fn what_loses_nothing_rolls_by_the_first_integrals() {
    let mut scene = Scene::of(40);
    scene.losses = scene.losses.map(|column| vec![0.0; column.len()]);
    scene.losses[Law::DryContour as usize][3] = f64::NAN;
    scene.losses[Law::AirLinear as usize][4] = -1.0;
    let (found, status) = scene.run(TableKind::Rolling, &[7.0], 1);
    assert!(status[3] == Ending::Invalid as u8 && status[4] == Ending::Invalid as u8 && found[0][3].is_nan());
    for i in (0..40).filter(|i| ![3, 4].contains(i)) {
        let [ell, i1, i3, fillet, _] = core::array::from_fn(|k| scene.bodies[k][i]);
        let body = Body::rounded(ell, i1, i3, fillet).unwrap();
        let start = State::from(core::array::from_fn(|k| scene.states[k][i]));
        let exact = roll_with(&body, start, &[7.0], &Ask::default(), || true).unwrap().unwrap();
        assert_eq!(exact.ending() as u8, status[i], "{i}");
        let y = exact.event.map_or_else(|| exact.states[0], |e| e.state);
        for (k, x) in <[f64; 4]>::from(y).into_iter().enumerate() {
            assert!((found[k][i] - x).abs() <= found[CLAIM][i] + exact.error, "{i}: {k}");
        }
        assert_eq!(found[LOST][i], 0.0);
    }
}
