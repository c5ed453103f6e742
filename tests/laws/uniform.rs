//! Uniform balls, whose phases have closed forms, compared with almost uniform balls, whose motions are integrated.

use crate::common::many::Many;
use crate::common::{drawn, path_of, wander};
use crate::flight::{coulomb, dropped};
use spincyl::contact::{Contact, Friction, Table};
use spincyl::ensemble::{Answer, Job};
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{Ask, Ending, Method, Motion, Start, roll_with};
use spincyl::{Body, Slip, State};

fn moved(body: &Body, start: &Start, ask: &Ask, times: &[f64]) -> Motion {
    roll_with(body, *start, times, ask, || true).unwrap().unwrap()
}

fn any_speed(fast: f64, r: &mut impl FnMut() -> f64) -> f64 {
    if r() < 0.1 { 0.0 } else { fast * (2.0 * r() - 1.0) }
}

/// A random start of a ball on the table or, if `aloft`, in the air.
fn any_start(aloft: bool, r: &mut impl FnMut() -> f64) -> Start {
    let fast = 10f64.powf(2.0 * r() - 1.0);
    let [w1, w2, w3, u, v] = core::array::from_fn(|_| any_speed(fast, r));
    let state = State { theta: 0.05 + 3.04 * r(), w1, w2, w3 };
    if !aloft {
        return Start::from(state).with_slip(Slip::new(u, v));
    }
    dropped(state, [u, v], if r() < 0.2 { 0.0 } else { 2.0 * r() }, any_speed(1.0, r))
}

/// The kinds of the phases of a motion, in the order of time.
fn kinds(m: &Motion) -> Vec<Kind> {
    path_of(m).phases.iter().map(|phase| phase.kind).collect()
}

#[test]
fn a_uniform_ball_moves_as_one_whose_moments_differ_in_the_last_digits() {
    let (mut r, times) = (wander(331), [0.0, 0.2, 0.9, 2.5, 6.0]);
    let (mut slips, mut hops, mut claims) = (0, 0, Vec::new());
    for case in 0..drawn(300) {
        let inertia = 0.3 + 0.36 * r();
        let [known, other] = [1.0, 1.0 + 2e-13].map(|more| Body::ball(0.0, inertia * more, inertia).unwrap());
        let (mu, e) = (10f64.powf(2.5 * r() - 2.0), [0.0, 0.4, 0.7, 1.0][case % 4]);
        let table: Table = match case % 5 {
            0 => Contact::Rolling.into(),
            1 => Contact::Smooth.into(),
            2 => coulomb(0.0),
            _ => coulomb(mu),
        };
        let flies = case % 3 > 0 || !table.rubs();
        let start = any_start(flies, &mut r);
        let ask = Ask::on(table).with_restitution(flies.then_some(e)).with_force();
        let [a, b] = [known, other].map(|body| moved(&body, &start, &ask, &times));
        let told = format!("{case} {table:?} {e} {start:?}");
        assert_eq!(a.evaluations, 0, "{told}");
        assert_eq!((a.ending(), kinds(&a)), (b.ending(), kinds(&b)), "{told}");
        slips += usize::from(kinds(&a).contains(&Kind::Slipping));
        hops += path_of(&a).impacts.len();
        claims.push(a.error);
        let (path, others) = (path_of(&a), path_of(&b));
        for (i, (y, z)) in a.states.iter().zip(&b.states).enumerate() {
            // The moments differ by 2e-13, which turns the axis by as much in a radian.
            let from = start.state;
            let speeds = [y.w1, y.w2, y.w3, from.w1, from.w2, from.w3, start.slip.u_h, start.slip.u_2];
            let fastest = speeds.into_iter().fold(1.0, |most: f64, w| most.max(w.abs()));
            let allowed = a.error + b.error + 1e-11 * fastest * fastest / y.theta.sin();
            let off = [y.theta - z.theta, y.w1 - z.w1, y.w2 - z.w2, y.w3 - z.w3];
            let slip = [path.slip[i].u_h - others.slip[i].u_h, path.slip[i].u_2 - others.slip[i].u_2];
            let heat = path.dissipated[i] - others.dissipated[i];
            for x in off.into_iter().chain(slip).chain([heat / fastest.max(4.0)]) {
                assert!(x.abs() < allowed, "{x:e} {allowed:e} at {} of {told}", times[i]);
            }
        }
        for (phase, other) in path.phases.iter().zip(&others.phases) {
            let allowed = a.error + b.error + 1e-10;
            assert!((phase.time - other.time).abs() < allowed, "{phase:?} {other:?} {told}");
        }
    }
    assert!(slips > claims.len() / 4 && hops > 2 * claims.len(), "{slips} {hops}");
    claims.sort_by(f64::total_cmp);
    assert!(claims[claims.len() / 2] < 1e-11, "{:e}", claims[claims.len() / 2]);
}

#[test]
fn a_ball_under_rolling_resistance_moves_as_one_whose_moments_differ_in_the_last_digits() {
    let mut r = wander(653);
    let (mut costs, mut stops) = ([0; 2], 0);
    for case in 0..drawn(240) {
        let inertia = 0.3 + 0.36 * r();
        let [known, other] = [1.0, 1.0 + 2e-13].map(|more| Body::ball(0.0, inertia * more, inertia).unwrap());
        let [mu, arm, patch] = [
            0.05 + 0.4 * r(),
            10f64.powf(-1.0 - 2.5 * r()),
            [0.0, 10f64.powf(-0.7 - 2.5 * r())][usize::from(case % 4 > 0)],
        ];
        let start = any_start(false, &mut r);
        let fast = [start.state.w1, start.state.w2, start.state.w3]
            .into_iter()
            .fold(0.3, |x: f64, w| x.max(w.abs()));
        let until = 60.0 * 10f64.powf(0.7 * r()) / fast;
        let times = [0.1, 0.4, 0.8, 1.0].map(|share| share * until);
        let ask = Ask::on(Friction::Coulomb { mu, fixed: mu, patch })
            .with_losses(Losses::of(Law::RollingResistance, arm))
            .with_force()
            .with_method(Method::Tolerance(1e-9));
        let [a, b] = [known, other].map(|body| moved(&body, &start, &ask, &times));
        let told = format!("{case} {mu} {arm} {patch} {start:?}");
        assert_eq!((a.ending(), a.states.len()), (b.ending(), b.states.len()), "{told}");
        for (cost, m) in costs.iter_mut().zip([&a, &b]) {
            *cost += m.evaluations;
        }
        stops += usize::from(a.ending() == Ending::Stops);
        let (path, others) = (path_of(&a), path_of(&b));
        let doubt = a.error + b.error + 1e-9;
        for (i, (y, z)) in a.states.iter().zip(&b.states).enumerate() {
            let off = [y.theta - z.theta, y.w1 - z.w1, y.w2 - z.w2, y.w3 - z.w3];
            let slip = [path.slip[i].u_h - others.slip[i].u_h, path.slip[i].u_2 - others.slip[i].u_2];
            let heats = [&path.dissipated, &path.work_lost].map(|all| all[i]);
            let theirs = [&others.dissipated, &others.work_lost].map(|all| all[i]);
            let heat = [0, 1].map(|k| (heats[k] - theirs[k]) / fast.max(4.0));
            for x in off.into_iter().chain(slip).chain(heat) {
                assert!(x.abs() < doubt, "{x:e} {doubt:e} at {} of {told}", times[i]);
            }
        }
        if let (Some(one), Some(two)) = (a.event, b.event) {
            assert!((one.time - two.time).abs() < doubt, "{one:?} {two:?} {told}");
        }
    }
    assert!(costs[0] < costs[1] / 4 && stops > 10, "{costs:?} {stops}");
}

#[test]
fn a_ball_in_a_sweep_is_the_ball_alone() {
    let (mut r, times) = (wander(337), [0.5, 3.0]);
    let all: Vec<_> =
        (0..40).map(|_| (Body::ball(0.0, 0.4, 0.4).unwrap(), any_start(false, &mut r).state)).collect();
    for e in [None, Some(0.5)] {
        let table = if e.is_some() { Table::Rolling { mu: 0.3 } } else { coulomb(0.3) };
        let job = Job::new(&times).with_ask(Ask::on(table).with_restitution(e)).with_tol(1e-8);
        let many = Many::of(&all).run(&job, 1);
        for (i, (body, y)) in all.iter().enumerate() {
            let ask = Ask::on(table).with_restitution(e);
            let ask = ask.with_method(Method::Tolerance(1e-8));
            let alone = moved(body, &Start::from(*y), &ask, &times);
            assert_eq!((many.at(i, 0), many.at(i, 1)), (alone.states[0], alone.states[1]));
            assert_eq!((many.error[i], many.status[i]), (alone.error, Ending::Done as u8));
        }
    }
}

#[test]
fn balls_march_in_lanes_to_the_ends_and_states_that_they_have_alone() {
    let (mut r, times) = (wander(347), [0.4, 2.0, 9.0]);
    let all: Vec<_> = (0..drawn(1500))
        .map(|k| {
            let i3 = 0.3 + 0.2 * r();
            let i1 = if k % 4 == 0 { i3 } else { i3 * (0.6 + r()) };
            let offset = if k % 3 == 0 { 0.0 } else { 1.8 * r() - 0.8 };
            (Body::ball(offset, i1, i3).unwrap(), any_start(false, &mut r).state)
        })
        .collect();
    for contact in [Contact::Rolling, Contact::Smooth] {
        let job = Job::new(&times).with_ask(Ask::on(contact)).with_tol(1e-8);
        let many = Many::of(&all).run(&job, 1);
        let lanes = many.method.iter().filter(|m| **m == Answer::Lanes as u8).count();
        // Without lanes every motion is computed alone.
        assert!(lanes == 0 || lanes > all.len() * 9 / 10, "{lanes} of {}", all.len());
        for (i, (body, y)) in all.iter().enumerate() {
            let alone = moved(body, &Start::from(*y), &Ask::on(contact), &times);
            assert_eq!(many.status[i], alone.ending() as u8, "{body:?} {y:?}");
            for (j, z) in alone.states.iter().enumerate() {
                let y = many.at(i, j);
                let off = [y.theta - z.theta, y.w1 - z.w1, y.w2 - z.w2, y.w3 - z.w3];
                let off = off.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                assert!(
                    off <= 2.0 * (many.error[i] + alone.error),
                    "{off:e} {:e} {i} {body:?}",
                    many.error[i]
                );
            }
        }
    }
}
