//! Rolling resistance that acts only while the contact point does not slip.
//!
//! ```text
//! ball, I = 2/5    slips until t = 2 v/(7 mu), over 12 v^2/(49 mu);   rolls with 5 v/7, slowed by 5 delta/7
//! ```

use crate::common::many::{body_columns, loss_columns};
use crate::common::{distance, drawn, numbers, path_of, tube_or_rounded, wander};
use crate::losses::total;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use spincyl::contact::{Friction, Table, TableKind};
use spincyl::ensemble::{Job, MotionOutput, MotionStarts, Summary, roll};
use spincyl::loss::{Law, Losses, Resistance};
use spincyl::motion::path::Kind;
use spincyl::motion::{AboveTable, Ask, Ending, Method, Motion, Start, roll_with};
use spincyl::{Body, Error, Slip, State, steady};
use std::f64::consts::FRAC_PI_2;

const STILL: State = State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3: 0.0 };

fn ball() -> Body {
    Body::ball(0.0, 0.4, 0.4).unwrap()
}

fn only_rolling(table: impl Into<Table>, losses: Losses) -> Ask {
    Ask::on(table).with_losses(losses).with_resistance(Resistance::WhileRolling)
}

fn arm(delta: f64) -> Losses {
    Losses::of(Law::RollingResistance, delta)
}

fn moved(body: &Body, start: impl Into<Start>, ask: &Ask, times: &[f64]) -> Motion {
    roll_with(body, start, times, ask, || true).unwrap().unwrap()
}

#[test]
fn a_struck_ball_slips_as_without_resistance_and_then_stops_as_a_ball_that_rolls() {
    for (v, mu, delta) in [(3.0, 0.2, 0.01), (0.4, 0.05, 0.002), (20.0, 0.6, 0.1), (1.0, 0.2, 0.27)] {
        let (rolls, brakes) = (2.0 * v / (7.0 * mu), 5.0 / 7.0 * delta);
        let stops = rolls + v / delta;
        let start = Start::from(STILL).with_slip(Slip::new(0.0, v));
        let ask = only_rolling(Friction::coulomb(mu), arm(delta)).with_pose();
        let times = [0.0, 0.4 * rolls, 0.9 * rolls, rolls + 0.3 * v / delta, 1.1 * stops];
        let m = moved(&ball(), start, &ask, &times);
        let path = path_of(&m);
        let kinds: Vec<Kind> = path.phases.iter().map(|phase| phase.kind).collect();
        assert_eq!(kinds, [Kind::Slipping, Kind::Rolling]);
        assert!((path.phases[1].time / rolls - 1.0).abs() < 1e-12, "{} {rolls}", path.phases[1].time);
        let [_, early, late] = [0, 1, 2].map(|i| path.work_lost[i]);
        assert_eq!((early, late), (0.0, 0.0), "a resistance acts in the slip");
        let event = m.event.unwrap();
        assert_eq!(event.ending, Ending::Stops);
        assert!((event.time / stops - 1.0).abs() < 1e-12, "{} {stops}", event.time);
        // The velocity of the centre is A w3 and the slip, where theta remains pi/2.
        for (i, t) in times.iter().copied().enumerate().take(m.states.len()) {
            let since = t - rolls;
            let (speed, way) = if since < 0.0 {
                (v - mu * t, v * t - 0.5 * mu * t * t)
            } else {
                let begun = 5.0 / 7.0 * v;
                (begun - brakes * since, 12.0 * v * v / (49.0 * mu) + (begun - 0.5 * brakes * since) * since)
            };
            let at = m.poses.as_ref().unwrap()[i].contact_point;
            let found = path.slip[i].u_2 + m.states[i].w3;
            assert!((found - speed).abs() < 2e-12 * v, "{t}: {found} {speed}");
            assert!((at.x.hypot(at.y) - way).abs() < 2e-12 * (1.0 + way), "{t}: {at:?} {way}");
        }
        let whole = 12.0 * v * v / (49.0 * mu) + 5.0 * v * v / (14.0 * delta);
        let lost = 0.5 * 1.4 * (5.0 / 7.0 * v).powi(2);
        assert!((whole * mu).is_finite() && (path.lost - lost).abs() < 1e-11 * lost, "{} {lost}", path.lost);
        if delta > mu {
            continue; // A resistance at all times would not let the ball begin to turn.
        }
        let always = moved(&ball(), start, &ask.with_resistance(Resistance::Always), &times);
        let later = path_of(&always).phases[1].time;
        assert!((later / (v / (3.5 * mu - 2.5 * delta)) - 1.0).abs() < 1e-12, "{later}");
    }
}

/// A random body and start, the coefficient of friction, and some losses in addition to a rolling resistance.
struct Drawn {
    body: Body,
    start: Start,
    mu: f64,
    losses: Losses,
}

/// Random bodies and starts, most of which slip at first.
fn drawn_starts(count: usize) -> Vec<Drawn> {
    let (mut r, mut runner) = (wander(71), TestRunner::deterministic());
    let mut all = Vec::new();
    while all.len() < count {
        let body = tube_or_rounded().new_tree(&mut runner).unwrap().current();
        let theta = body.theta_end() * (0.1 + 0.8 * r());
        let Ok(y) = steady::state(&body, theta) else { continue };
        if ![y.w1, y.w3].iter().all(|w| w.abs() < 8.0) {
            continue;
        }
        let slip = if r() < 0.3 { [0.0; 2] } else { [(); 2].map(|()| 2.0 * r() - 1.0) };
        let mut losses = arm(10f64.powf(-3.0 + 2.0 * r()));
        if all.len() % 3 == 1 {
            losses = losses.with(Law::AirLinear, 0.01 * r()).with(Law::ViscousContour, 0.01 * r());
        }
        if all.len() % 3 == 2 {
            losses = losses.with(Law::Drilling, 0.01 * r());
        }
        let mu = 10f64.powf(-1.5 + 1.3 * r());
        let start = Start::from(y.kicked(0.1 * r())).with_slip(slip.into());
        all.push(Drawn { body, start, mu, losses });
    }
    all
}

#[test]
fn each_phase_is_that_of_a_table_on_which_it_never_ends() {
    let (times, mut compared, mut undefined) = ([0.0, 1.0, 3.0, 8.0], [0usize; 2], 0);
    for Drawn { body, start, mu, losses } in drawn_starts(drawn(120)) {
        let ask = only_rolling(Friction::coulomb(mu), losses);
        let m = match roll_with(&body, start, &times, &ask, || true) {
            Ok(m) => m.unwrap(),
            Err(Error::OutOfRange { name: "delta", .. }) => {
                undefined += 1;
                continue;
            }
            Err(e) => panic!("{e}"),
        };
        undefined += usize::from(m.ending() == Ending::Painleve);
        let path = path_of(&m);
        for i in 0..m.states.len() {
            let change = total(&body, &m, i) - total(&body, &m, 0);
            assert!(change.abs() < 1e-9, "{body:?} {start:?} {mu} {losses:?}: {change}");
        }
        let ends = path.phases.iter().skip(1).map(|phase| phase.time);
        let over = m.event.map_or(8.0, |event| event.time);
        let spans: Vec<_> = path.phases.iter().zip(ends.chain([over])).collect();
        for (phase, end) in spans.into_iter().filter(|(phase, end)| end - phase.time > 1e-2).take(6) {
            let span = end - phase.time;
            let parts = [0.25, 0.5, 0.9].map(|share| phase.time + share * span);
            let at = moved(&body, start, &ask, &parts);
            let begins = Start::from(at.states[0]).with_time(parts[0]).with_slip(path_of(&at).slip[0]);
            let (other, k) = match phase.kind {
                Kind::Slipping => {
                    (Ask::on(Friction::coulomb(mu)).with_losses(losses.with(Law::RollingResistance, 0.0)), 0)
                }
                Kind::Rolling => (Ask::on(Table::Rolling { mu: f64::INFINITY }).with_losses(losses), 1),
                _ => continue,
            };
            let begins = if k == 1 { begins.with_slip(Slip::default()) } else { begins };
            let alone = moved(&body, begins, &other, &parts);
            for i in 1..parts.len().min(alone.states.len()) {
                let allowed = 1e-9 + 100.0 * (m.error + at.error + alone.error);
                let far = distance(&at.states[i], &numbers(&alone.states[i]));
                assert!(
                    far < allowed,
                    "{:?} {body:?} {start:?} {mu} {losses:?}: {far} {allowed}",
                    phase.kind
                );
            }
            compared[k] += 1;
        }
    }
    assert!(compared[0] > 20 && compared[1] > 10, "{compared:?}");
    assert!(undefined < 10, "{undefined}");
}

#[test]
fn many_motions_are_the_single_ones() {
    let all: Vec<_> = drawn_starts(drawn(240));
    let times = [0.0, 2.0, 6.0];
    let ask = Ask::on(TableKind::Coulomb).with_resistance(Resistance::WhileRolling);
    let job = Job::new(&times).with_ask(ask);
    let column = |of: &dyn Fn(&Drawn) -> f64| all.iter().map(of).collect::<Vec<f64>>();
    let bodies = [
        column(&|x| x.body.ell()),
        column(&|x| x.body.i1()),
        column(&|x| x.body.i3()),
        column(&|x| x.body.fillet()),
        column(&|x| x.body.theta_end()),
    ];
    let states = [
        column(&|x| x.start.state.theta),
        column(&|x| x.start.state.w1),
        column(&|x| x.start.state.w2),
        column(&|x| x.start.state.w3),
    ];
    let slips = [0, 1].map(|k| column(&|x: &Drawn| <[f64; 2]>::from(x.start.slip)[k]));
    let mu = column(&|x| x.mu);
    let columns = core::array::from_fn(|k| column(&|x: &Drawn| x.losses.coefficient(Law::ALL[k])));
    let bodies = body_columns(bodies.each_ref().map(Vec::as_slice));
    let starts = MotionStarts::new(bodies, states.each_ref().map(Vec::as_slice))
        .with_slips(&slips[0], &slips[1])
        .with_friction(&mu, &mu, &[0.0])
        .with_losses(loss_columns(&columns));
    let n = all.len();
    let (mut error, mut method, mut status) = (vec![0.0; n], vec![0; n], vec![0; n]);
    let mut last: [Vec<f64>; 4] = core::array::from_fn(|_| vec![0.0; n]);
    let mut lost = vec![0.0; n];
    let out = MotionOutput::new(&mut error, &mut method, &mut status)
        .with_last(last.each_mut().map(Vec::as_mut_slice))
        .with_summary(Summary::WorkLost, &mut lost);
    assert!(roll(&starts, &job, out, 2, |_| true).unwrap());
    let mut compared = 0;
    for (i, Drawn { body, start, mu, losses }) in all.iter().enumerate() {
        let ask = only_rolling(Friction::coulomb(*mu), *losses).with_method(Method::Tolerance(job.tol));
        let Ok(Some(one)) = roll_with(body, *start, &times, &ask, || true) else {
            assert!(last[0][i].is_nan(), "{i}");
            continue;
        };
        let end = one.event.map_or(one.states[one.states.len() - 1], |event| event.state);
        let many = State::from(last.each_ref().map(|x| x[i]));
        if one.ending() == Ending::Bounded || !one.error.is_finite() {
            continue;
        }
        let allowed = 1e-12 + 10.0 * (one.error + error[i]);
        let far = distance(&end, &numbers(&many));
        assert_eq!(one.ending() as u8, status[i], "{i}");
        assert!(far <= allowed && (lost[i] - path_of(&one).lost).abs() <= allowed, "{i}: {far} {allowed}");
        compared += usize::from(allowed < 1e-6);
    }
    assert!(compared > 2 * n / 3, "{compared} of {n}");
}

#[test]
fn a_body_that_never_slips_does_not_know_when_its_resistance_acts() {
    let coin = Body::solid(0.3).unwrap();
    let y = steady::state(&coin, 0.7).unwrap().kicked(0.05);
    let losses = arm(2e-3).with(Law::AirLinear, 1e-3);
    for table in [Table::Rolling { mu: f64::INFINITY }, Friction::coulomb(50.0).into()] {
        let ask = Ask::on(table).with_losses(losses).with_pose().with_force();
        let [always, only] = [Resistance::Always, Resistance::WhileRolling]
            .map(|when| moved(&coin, y, &ask.with_resistance(when), &[0.0, 1.0, 5.0, 20.0]));
        assert_eq!(always, only);
        assert!(path_of(&only).lost > 0.0 && path_of(&only).phases.iter().all(|x| x.kind == Kind::Rolling));
    }
}

#[test]
fn a_body_that_lands_hops_and_rolls_keeps_its_energy_account() {
    let start = Start::from(State { theta: 1.0, w1: 0.5, w2: 0.2, w3: -0.4 })
        .with_slip(Slip::new(0.3, 1.0))
        .with_aloft(AboveTable::new(0.3, 0.0));
    let (losses, times) = (arm(0.02), [0.0, 1.0, 3.0, 6.0, 12.0]);
    let ask = only_rolling(Friction::coulomb(0.3), losses).with_restitution(0.5);
    let m = moved(&ball(), start, &ask, &times);
    let none = moved(&ball(), start, &ask.with_losses(Losses::NONE), &times);
    let (path, free) = (path_of(&m), path_of(&none));
    let rolls = |m: &Motion| path_of(m).phases.iter().find(|x| x.kind == Kind::Rolling).unwrap().time;
    assert!((rolls(&m) - rolls(&none)).abs() < 1e-6, "{} {}", rolls(&m), rolls(&none));
    assert!(path.lost > 0.0 && free.lost == 0.0);
}

#[test]
fn a_resistance_beyond_what_friction_can_hold_is_refused() {
    // Friction has to give 5/7 delta N to a ball that rolls.
    let (table, losses) = (Friction::coulomb(0.05), arm(0.1));
    let ask = only_rolling(table, losses);
    let rolls = State { w3: 1.0, ..STILL };
    let error = roll_with(&ball(), rolls, &[1.0], &ask, || true).unwrap_err();
    assert!(matches!(error, Error::OutOfRange { name: "delta", value: 0.1, .. }), "{error}");
    let struck = moved(&ball(), Start::from(STILL).with_slip(Slip::new(0.0, 1.0)), &ask, &[0.0, 50.0]);
    let event = struck.event.unwrap();
    assert_eq!(event.ending, Ending::Painleve);
    assert!((event.time - 2.0 / (7.0 * 0.05)).abs() < 1e-10, "{}", event.time);
    let holds = only_rolling(table, arm(0.0699));
    assert!(roll_with(&ball(), rolls, &[1.0], &holds, || true).is_ok());
}

#[test]
fn a_resistance_only_in_rolling_is_refused_where_no_body_rolls() {
    let viscous: Table = Friction::Viscous { c: 0.1 }.into();
    for table in [Table::Smooth, viscous, Friction::Coulomb { mu: 0.2, fixed: 0.2, patch: 0.05 }.into()] {
        let ask = only_rolling(table, arm(0.01));
        let error = roll_with(&ball(), State { w3: 1.0, ..STILL }, &[1.0], &ask, || true).unwrap_err();
        assert!(matches!(error, Error::OutOfRange { name: "delta", .. }), "{table:?}: {error}");
        let none = ask.with_losses(Losses::NONE);
        assert!(roll_with(&ball(), State { w3: 1.0, ..STILL }, &[1.0], &none, || true).is_ok());
    }
}
