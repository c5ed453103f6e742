//! RK4, by fixed steps and within tolerances: rows D1 to D7, D11, D13, D14 of docs/hard-cases.md.

use crate::common::rim::sharp;
use crate::common::{BOTH, by, distance, drawn, motions, moved, numbers, rounded_starts, state, wander};
use spincyl::contact::Table;
use spincyl::exact::Swing;
use spincyl::motion::{Ask, Method};
use spincyl::{Body, Contact, Error, State, rk4, rolling, stability, steady};
use std::f64::consts::PI;

fn disk() -> Body {
    Body::from_metres(0.0751, 0.0, 0.0128, 0.0).unwrap()
}

#[test]
fn d1_rk4_is_of_fourth_order() {
    let cylinder = Body::solid(1.0).unwrap();
    let slower = (cylinder, steady::state(&cylinder, 0.5).unwrap().kicked(0.1));
    for ((body, y), contact) in
        rounded_starts().into_iter().chain([slower]).flat_map(|x| BOTH.map(|c| (x, c)))
    {
        let swing = Swing::new(&body, &y, contact).unwrap();
        let end = swing.state(5.0);
        let error = |k: u32| {
            let n = 20u64 << k;
            let found = rk4::integrate(|y| contact.derivative(&body, y), y, 5.0 / n as f64, n);
            distance(&found, &numbers(&end))
        };
        let (floor, finest) = if sharp(&body) { (1e-13, 9) } else { (1e-12, 11) };
        let errors: Vec<f64> = (0..=finest).map(error).collect();
        let orders: Vec<f64> =
            errors.windows(2).filter(|e| e[1] > floor).map(|e| (e[0] / e[1]).log2()).collect();
        let off: Vec<f64> = orders.iter().rev().map(|o| (o - 4.0).abs()).collect();
        // the part of the next power of the step shrinks, until only rounding is left
        let fourth = if sharp(&body) {
            off.iter().filter(|o| **o <= 0.05).count() >= 5
        } else {
            off[0] <= 0.05 && off[0] < 0.8 * off[1].max(0.02) && off[1] < 0.8 * off[2].max(0.02)
        };
        assert!(fourth, "{body:?} {contact:?}: {orders:?}");
    }
}

#[test]
fn d2_a_stable_steady_state_is_held() {
    for (ell, theta) in [(2.5, 1.3), (1.0, 0.5)] {
        let body = Body::solid(ell).unwrap();
        let y = steady::state(&body, theta).unwrap();
        let end = rk4::integrate(|y| rolling::derivative(&body, y), y, 1e-2, 1_000_000);
        assert!((end.theta - theta).abs() <= 1e-12, "{:e}", end.theta - theta);
    }
}

/// Relative energy error of RK4 after n steps of 1e-3 near a steady state.
fn drift(n: u64) -> f64 {
    let body = Body::solid(2.5).unwrap();
    let y = steady::state(&body, 1.3).unwrap().kicked(0.01);
    let end = rk4::integrate(|y| rolling::derivative(&body, y), y, 1e-3, n);
    (rolling::energy(&body, &end) / rolling::energy(&body, &y) - 1.0).abs()
}

#[test]
fn d3_a_million_steps_keep_the_energy_to_the_last_digits() {
    let drift = drift(1_000_000);
    assert!(drift <= 1e-15, "{drift:e}");
}

#[test]
#[ignore = "long: 1e8 steps in ten seconds, 1e9 in two minutes"]
fn d3_long_a_billion_steps() {
    for (n, allowed) in [(1_000_000, 1e-15), (100_000_000, 1e-13), (1_000_000_000, 1e-12)] {
        let drift = drift(n);
        println!("{n} steps: relative energy error {drift:.2e}");
        assert!(drift <= allowed, "{n}: {drift:e}");
    }
}

/// The two linear integrals hold if w1 and w3 are those of the exact motion at the same inclination.
#[test]
fn d14_energy_and_both_linear_integrals_hold_along_rk4() {
    for (ell, theta, kick) in [(1.0, 0.5, 0.3), (2.5, 1.3, 0.05), (0.17, 0.2, 0.05)] {
        let body = Body::solid(ell).unwrap();
        let y = steady::state(&body, theta).unwrap().kicked(kick);
        for contact in BOTH {
            let end = rk4::integrate(|y| contact.derivative(&body, y), y, 2e-4, 100_000);
            let swing = Swing::new(&body, &y, contact).unwrap();
            // Newton's iteration for the time of that inclination
            let mut t = 20.0;
            for _ in 0..30 {
                let here = swing.state(t);
                t += (end.theta - here.theta) / -here.w2;
            }
            let there = swing.state(t);
            assert!(
                (end.w1 - there.w1).abs() < 1e-11 && (end.w3 - there.w3).abs() < 1e-11,
                "{end:?} {there:?}"
            );
            assert!((contact.energy(&body, &end) - contact.energy(&body, &y)).abs() < 1e-11);
        }
    }
}

#[test]
fn the_energy_of_a_rounded_body_holds_along_rk4() {
    for ((body, y), contact) in rounded_starts().into_iter().flat_map(|x| BOTH.map(|c| (x, c))) {
        let end = rk4::integrate(|y| contact.derivative(&body, y), y, 2e-4, 100_000);
        assert!(
            (contact.energy(&body, &end) - contact.energy(&body, &y)).abs() < 1e-12,
            "{body:?} {contact:?}"
        );
    }
}

#[test]
fn d13_forward_and_backward_is_no_way() {
    let body = Body::solid(2.5).unwrap();
    let y = steady::state(&body, 1.3).unwrap().kicked(0.05);
    let there = rk4::integrate(|y| rolling::derivative(&body, y), y, 1e-3, 100_000);
    let back = rk4::integrate(|y| rolling::derivative(&body, y), there, -1e-3, 100_000);
    assert!(distance(&back, &numbers(&y)) < 1e-11, "{back:?}");
    for method in [Method::Exact, Method::Step(1e-3), Method::Tolerance(1e-12)] {
        let there = moved(&body, &y, &[20.0], by(method)).unwrap();
        let method = if let Method::Step(h) = method { Method::Step(-h) } else { method };
        let back = moved(&body, &there.states[0], &[-20.0], by(method)).unwrap();
        assert!(distance(&back.states[0], &numbers(&y)) < 1e-9, "{method:?}");
    }
}

#[test]
fn d4_round_off_grows_as_the_root_of_the_number_of_steps() {
    // steps so small that the error of the method is below rounding, and enough starts for a mean
    let body = Body::solid(1.0).unwrap();
    let mean = |n: u64| {
        let starts = 24;
        let sum: f64 = (0..starts)
            .map(|k| {
                let y = steady::state(&body, 0.45 + 0.01 * f64::from(k)).unwrap().kicked(0.2);
                let end = rk4::integrate(|y| rolling::derivative(&body, y), y, 1e-3, n);
                (rolling::energy(&body, &end) - rolling::energy(&body, &y)).powi(2)
            })
            .sum();
        (sum / f64::from(starts)).sqrt()
    };
    let (few, many) = (mean(1_000), mean(64_000));
    let exponent = (many / few).ln() / 64f64.ln();
    // with compensated sums, growth by a few ulp is hidden by the rounding of the energy itself
    assert!(exponent < 0.65, "{few:e} {many:e}: {exponent}");
}

#[test]
#[ignore = "long: round-off over four decades, a minute"]
fn d4_long_round_off_without_and_with_compensation() {
    let body = Body::solid(1.0).unwrap();
    for compensated in [false, true] {
        let mut before: Option<f64> = None;
        for n in [100_000u64, 1_000_000, 10_000_000, 100_000_000] {
            let starts = if n > 10_000_000 { 2 } else { 12 };
            let mut sum = 0.0;
            for k in 0..starts {
                let y0 = steady::state(&body, 0.45 + 0.01 * f64::from(k)).unwrap().kicked(0.2);
                let f = |y: &State| rolling::derivative(&body, y);
                let end = if compensated {
                    rk4::integrate(f, y0, 5e-4, n)
                } else {
                    let mut y = numbers(&y0);
                    for _ in 0..n {
                        let k1 = numbers(&f(&State::from(y)));
                        let change = rk4::increment(&mut |y: &State| f(y), &y, &k1, 5e-4);
                        y = std::array::from_fn(|i| y[i] + change[i]);
                    }
                    State::from(y)
                };
                sum += (rolling::energy(&body, &end) - rolling::energy(&body, &y0)).powi(2);
            }
            let rms = (sum / f64::from(starts)).sqrt();
            let exponent = before.map_or(f64::NAN, |b| (rms / b).log10());
            println!(
                "compensated {compensated}: {n} steps of 5e-4, energy error {rms:.2e}, exponent {exponent:.2}"
            );
            before = Some(rms);
        }
    }
}

#[test]
fn d5_a_step_too_large_for_the_nutation_is_never_silent() {
    let body = Body::solid(2.5).unwrap();
    let y = steady::state(&body, 1.3).unwrap().kicked(1e-3);
    let w = stability::at_rest(&body, 1.3, Contact::Rolling).sqrt();
    for hw in [0.05, 0.1, 0.5, 1.0, 2.5, 2.82, 2.84, 10.0] {
        let step = hw / w;
        let span = 200.0 * step;
        let found = moved(&body, &y, &[span], by(Method::Step(step)));
        let predicted = 200.0 * f64::powi(hw, 6) / 144.0;
        match found {
            // this body precesses at 1.96, so that a step of more than 0.5 is refused for that already
            Err(Error::Step { advice, .. }) => {
                assert!(hw >= 0.6, "{hw}");
                assert!(moved(&body, &y, &[span], by(Method::Step(advice))).is_ok_and(|m| !m.coarse));
            }
            Ok(m) => {
                assert!(
                    hw <= 0.5 && (m.step_loss / predicted - 1.0).abs() < 0.05,
                    "{hw}: {} {predicted}",
                    m.step_loss
                );
                assert_eq!(m.coarse, predicted > 1e-3 || hw > 0.4, "{hw}");
            }
            Err(e) => panic!("{e}"),
        }
    }
    // a body that hardly precesses: the nutation alone decides
    let coin = Body::solid(0.0).unwrap();
    let rolling_fast = state(1.57, 0.0, 0.0, 20.0);
    let w = Swing::new(&coin, &rolling_fast, Contact::Rolling).unwrap().nutation();
    for hw in [0.05, 0.1, 0.5, 1.0, 2.4, 2.6, 2.82, 2.84, 10.0] {
        match moved(&coin, &rolling_fast, &[200.0 * hw / w], by(Method::Step(hw / w))) {
            Ok(m) => assert!(hw < 2.5 && m.coarse == (hw > 0.3), "{hw}: {}", m.step_loss),
            Err(e) => assert!(hw > 2.5 && matches!(e, Error::Step { .. }), "{hw}: {e}"),
        }
    }
}

#[test]
fn d5_the_predicted_loss_is_what_rk4_takes_from_the_nutation() {
    let body = Body::solid(2.5).unwrap();
    let rest = steady::state(&body, 1.3).unwrap();
    let w = stability::at_rest(&body, 1.3, Contact::Rolling).sqrt();
    for (hw, n) in [(0.2, 4000u64), (0.3, 2000), (0.5, 300)] {
        let (kick, step) = (1e-5, hw / w);
        let y = rest.kicked(kick);
        let end = rk4::integrate(|y| rolling::derivative(&body, y), y, step, n);
        let amplitude = Swing::new(&body, &end, Contact::Rolling).unwrap().turning_points();
        let before = Swing::new(&body, &y, Contact::Rolling).unwrap().turning_points();
        let kept = (amplitude[1] - amplitude[0]) / (before[1] - before[0]);
        let predicted = n as f64 * f64::powi(hw, 6) / 144.0;
        assert!((-kept.ln() / predicted - 1.0).abs() < 0.15, "{hw}: kept {kept}, predicted loss {predicted}");
    }
}

#[test]
fn d6_a_nearly_flat_body_turns_by_the_fixed_angle() {
    for r in motions().iter().filter(|r| r.kind == "period" && r.scene.starts_with("D6")) {
        let (i1, ell) = (r.body.i1(), r.body.ell());
        let limit = PI * ((i1 + ell * ell + 1.0) / (i1 + ell * ell)).sqrt();
        let turn = Swing::with_pose(&r.body, &r.start, Contact::Rolling)
            .unwrap()
            .angles_per_period()
            .unwrap()
            .precession;
        let allowed = if r.start.w1 > 5e-4 {
            4e-3
        } else if r.start.w1 > 5e-5 {
            5e-4
        } else {
            1e-4
        };
        assert!((turn / limit - 1.0).abs() <= allowed, "{}: {turn} {limit}", r.scene);
        // the same angle by integration
        for (tol, allowed) in [(1e-9, 1e-6), (1e-12, 1e-9)] {
            let scene = Ask::default().with_method(Method::Tolerance(tol)).with_pose().with_beyond();
            let motion = moved(&r.body, &r.start, &[r.t], scene).unwrap();
            let phi = motion.poses.unwrap()[0].phi.radians();
            assert!((phi - r.values[2]).abs() < allowed, "{} within {tol}: {phi} {}", r.scene, r.values[2]);
            assert!(motion.states.iter().all(|y| y.theta > 0.0));
        }
    }
    // 402.49 degrees for the thin disk
    let disk = Body::solid(0.0).unwrap();
    let swing = Swing::with_pose(&disk, &state(0.3, 1e-8, 0.0, 0.0), Contact::Rolling).unwrap();
    assert!((swing.angles_per_period().unwrap().precession.to_degrees() - 402.49).abs() < 0.01);
}

#[test]
fn d7_a_fixed_step_that_would_jump_over_the_passage_is_refused_with_one_that_would_do() {
    let body = Body::solid(1.0).unwrap();
    for exponent in [3, 5, 7] {
        let y = state(0.3, 1.3 * 10f64.powi(-exponent), 0.0, 0.0);
        let swing = Swing::with_pose(&body, &y, Contact::Rolling).unwrap();
        let period = swing.period();
        let fastest = swing.state(0.5 * period).precession().abs();
        for turn in [1.1, 3.0, 100.0] {
            let step = turn / fastest;
            match moved(&body, &y, &[period], by(Method::Step(step))) {
                Err(Error::Step { time, theta, advice, .. }) => {
                    assert!(time > 0.0 && time <= 0.5 * period && theta < 0.3, "{time} {theta}");
                    assert!(
                        advice * fastest <= 0.3 + 1e-9 && advice * fastest > 0.05,
                        "{}",
                        advice * fastest
                    );
                }
                other => panic!("{exponent}, {turn}: {other:?}"),
            }
        }
        if exponent == 3 {
            let warned = moved(&body, &y, &[period], by(Method::Step(0.9 / fastest))).unwrap();
            assert!(warned.coarse, "between 0.3 and 1 it is done, with a warning");
            let fine = moved(&body, &y, &[period], by(Method::Step(0.25 / fastest))).unwrap();
            assert!(fine.advice > 0.0 && fine.error < 1e-2);
        }
        // before the passage the same step is no problem
        assert!(moved(&body, &y, &[0.5], by(Method::Step(1e-2))).is_ok_and(|m| !m.coarse));
    }
}

#[test]
fn d11_the_suggested_step_is_within_a_factor_two_of_the_largest_that_keeps_the_nutation() {
    let body = disk();
    for theta in [1e-3, 1e-4, 1e-5, 1e-6] {
        let rest = steady::state(&body, theta).unwrap();
        let w = stability::at_rest(&body, theta, Contact::Rolling).sqrt();
        let y = rest.kicked(1e-3 * theta * w);
        let span = 200.0 / w;
        let before = Swing::new(&body, &y, Contact::Rolling).unwrap().turning_points();
        let advice = moved(&body, &y, &[span], by(Method::Step(0.01 / w))).unwrap().advice;
        let kept = |step: f64| {
            let end = rk4::integrate(|y| rolling::derivative(&body, y), y, step, (span / step) as u64);
            let after = Swing::new(&body, &end, Contact::Rolling).unwrap().turning_points();
            (after[1] - after[0]) / (before[1] - before[0])
        };
        assert!((1.0 - kept(advice)).abs() < 3e-3, "{theta}: {}", kept(advice));
        assert!((1.0 - kept(2.0 * advice)).abs() > 3e-3, "{theta}: {}", kept(2.0 * advice));
    }
}

#[test]
fn tolerances_are_kept_within_a_modest_factor_and_errors_are_said() {
    for r in motions().iter().filter(|r| r.kind == "state" && r.t == 20.0) {
        for tol in [1e-6, 1e-9, 1e-12] {
            let scene = by(Method::Tolerance(tol)).with_table(r.contact).with_beyond();
            let motion = moved(&r.body, &r.start, &[20.0], scene).unwrap();
            let error = distance(&motion.states[0], &r.values);
            assert!(error <= 1e3 * tol, "{} {:?}: {error:e} within {tol:e}", r.scene, r.contact);
            assert!(error <= 1.01 * motion.error + 1e-15, "{}: {error:e}, said {:e}", r.scene, motion.error);
        }
    }
}

#[test]
fn called_without_a_method_the_answer_is_right_to_nine_digits_and_says_how() {
    for r in motions().iter().filter(|r| r.kind == "state") {
        let scene = Ask::default().with_table(r.contact).with_beyond();
        let motion = moved(&r.body, &r.start, &[r.t], scene).unwrap();
        let error = distance(&motion.states[0], &r.values);
        if r.t < 1e9 {
            assert!(
                error <= 1e-9 && motion.method == Method::Exact,
                "{} {:?}: {error:e}",
                r.scene,
                r.contact
            );
        }
        assert!(error <= motion.error, "{}: {error:e}, said {:e}", r.scene, motion.error);
    }
}

#[test]
fn near_the_flat_an_integrator_invents_no_end_and_loses_none() {
    let mut r = wander(19);
    let (mut compared, mut ended) = (0, 0);
    for i in 0..drawn(600) {
        let (i1, fillet) = (0.3 + 1.7 * r(), if r() < 0.6 { 0.0 } else { 0.05 + 0.85 * r() });
        let body = Body::rounded(2.5 * r(), i1, i1 * (0.2 + 1.7 * r()), fillet).unwrap();
        // the body rises from the table, comes back, and passes it as flat as at its start
        let theta = 10f64.powf(-7.0 + 5.5 * r());
        let w1 = theta * (2.0 * r() - 1.0) * 10f64.powf(-3.0 + 3.7 * r());
        let y = state(theta, w1, -0.6 * r(), 4.0 * r() - 2.0);
        let scene = match i % 3 {
            0 => Ask::default().with_table(Contact::Smooth),
            1 => Ask::default().with_table(Table::Rolling { mu: 0.3 }),
            _ => Ask::default(),
        };
        let times = [1.0 + 14.0 * r()];
        let exact = moved(&body, &y, &times, scene).unwrap();
        for method in [Method::Tolerance(10f64.powf(-2.0 - 10.0 * r())), Method::Step(1e-3)] {
            // a step that jumps over the passage is refused
            let Ok(stepped) = moved(&body, &y, &times, scene.with_method(method)) else { continue };
            assert_eq!(stepped.ending(), exact.ending(), "{body:?} {y:?} to {times:?}, {scene:?} {method:?}");
            compared += 1;
            if let Some((a, b)) = stepped.event.zip(exact.event) {
                let allowed = 2.0 * (stepped.error + exact.error);
                assert!((a.time - b.time).abs() <= allowed, "{} {}: {allowed}", a.time, b.time);
                ended += 1;
            }
        }
    }
    assert!(compared > drawn(800) && ended > drawn(300), "{compared} {ended}");
}
