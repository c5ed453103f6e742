//! The exact motion: rows D15 to D17 of docs/hard-cases.md and the laws behind them. References in motion.csv and
//! rounded_motion.csv come from tests/reference/motion.py and rounded.py: the three-dimensional model at 40 digits, which
//! integrates vectors and solves for the contact numerically.

use crate::common::rim::sharp;
use crate::common::{
    BOTH, all_motions, any_rounded, any_state, distance, hex, motions, numbers, rounded_disk, rounded_starts,
    state, wander, wild,
};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use spincyl::exact::Swing;
use spincyl::motion::{Ask, Method, roll_with};
use spincyl::{Body, Contact, State, contact, stability, steady};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

#[test]
fn d15_the_exact_solution_is_that_of_newton_and_euler_within_its_claim() {
    let (mut checked, mut poles) = ([0, 0], 0);
    for r in all_motions().filter(|r| if sharp(&r.body) { r.kind == "state" } else { r.kind != "period" }) {
        let sharp = sharp(&r.body);
        let swing = Swing::with_pose(&r.body, &r.start, r.contact).unwrap();
        let (y, name) = (swing.state(r.t), format!("{} {:?} at t = {}", r.scene, r.contact, r.t));
        let (error, claimed) = (distance(&y, &r.values), swing.error(r.t));
        // conditioning: the last digit of the period, times the number of periods, is lost in the phase
        let growth = if sharp { 1.0 + r.t } else { (r.t / 20.0).max(1.0) };
        let (share, allowed) = if sharp { (10.0, 2e-14) } else { (1.0, 1e-12) };
        assert!(
            error <= share * claimed && error <= allowed * growth,
            "{name}: {error:e}, claimed {claimed:e}"
        );
        let (pose, claimed) = (swing.pose(r.t).unwrap(), swing.pose_error(r.t));
        let whole = |x: f64| x - TAU * (x / TAU).round();
        let (phi, psi) = (pose.phi.radians() - r.values[4], pose.psi.radians() - r.values[5]);
        // phi and psi jump by half a turn at a pole; its sign has no meaning, so that whole turns are ignored
        let angles = if r.kind == "pole" { [whole(phi), whole(phi + psi)] } else { [phi, psi] };
        let path = [pose.contact_point.x - r.values[6], pose.contact_point.y - r.values[7]];
        let turns = [r.values[4].abs(), r.values[5].abs()];
        let allowed =
            if sharp { 1e-13 * (1.0 + turns[0] / r.t) } else { 1e-12 * (1.0 + turns[0] + turns[1]) };
        for off in angles.into_iter().chain(path).filter(|x| !x.is_nan()).map(f64::abs) {
            let held = off <= share * claimed && off <= allowed * growth;
            assert!(held, "{name}, pose: {off:e}, claimed {claimed:e}");
        }
        let f = contact::force(r.contact, &r.body, &y);
        let off = (f.normal - r.values[8]).abs().max((f.friction() - r.values[9]).abs());
        let allowed = if sharp { 1e-13 * (1.0 + r.values[8]) } else { 1e-11 * (1.0 + r.values[8].abs()) };
        assert!(off <= allowed * growth, "{name}, force: {off:e}");
        checked[usize::from(sharp)] += 1;
        poles += usize::from(r.kind == "pole");
    }
    assert!(checked[1] > 30 && checked[0] > 40 && poles >= 6, "{checked:?} {poles}");
}

#[test]
fn periods_and_turning_points_are_right_to_fourteen_digits_of_rounded_bodies_to_thirteen() {
    let mut checked = [0, 0];
    for r in all_motions().filter(|r| r.kind == "period") {
        let swing = Swing::with_pose(&r.body, &r.start, r.contact).unwrap();
        let name = format!("{} {:?}", r.scene, r.contact);
        let [period, allowed] = if sharp(&r.body) { [2e-15, 4e-15] } else { [1e-14, 1e-13] };
        assert!((swing.period() / r.t - 1.0).abs() <= period, "{name}: {} {}", swing.period(), r.t);
        for (found, known) in swing.turning_points().iter().zip(&r.values) {
            assert!((found / known - 1.0).abs() < allowed, "{name}: {found} {known}");
        }
        let angles = swing.angles_per_period().map(|angles| [angles.precession, angles.spin]).unwrap();
        for (angle, known) in angles.iter().zip(&r.values[2..]) {
            let size = 1.0 + angles[0].abs() + angles[1].abs();
            assert!((angle - known).abs() <= allowed * size, "{name}: {angle} {known}");
        }
        checked[usize::from(sharp(&r.body))] += 1;
    }
    assert!(checked[1] > 30 && checked[0] >= 20, "{checked:?}");
}

#[test]
fn a_motion_entered_elsewhere_and_followed_back_is_where_it_was_within_both_claims() {
    let (mut r, mut runner) = (wander(1), TestRunner::new(ProptestConfig::default()));
    let mut rounded = || (any_rounded(), any_state(), 0.1..20.0f64).new_tree(&mut runner).unwrap().current();
    let (mut followed, mut lost) = ([0, 0], [0, 0]);
    for i in 0..3512 {
        let given = i < 3000;
        let (body, y, contact, t) = if given {
            let (body, y, contact) = wild(&mut r);
            (body, y, contact, f64::NAN)
        } else {
            let (body, y, t) = rounded();
            (body, y, Contact::Rolling, t)
        };
        let Ok(swing) = Swing::new(&body, &y, contact) else {
            lost[usize::from(given)] += 1;
            continue;
        };
        let t = if given { 1.0 + 20.0 * r() } else { t };
        if swing.landing(t).is_some() {
            continue;
        }
        let there = swing.state(t);
        let Ok(again) = Swing::new(&body, &there, contact) else { continue };
        let back = again.state(-t);
        // the effect of the errors of the state `there` on the way back, which is large near a saddle
        let handed: f64 = (0..4)
            .map(|i| {
                let mut moved = numbers(&there);
                moved[i] += swing.error(t) + moved[i].abs() * f64::EPSILON;
                let moved = Swing::new(&body, &State::from(moved), contact);
                moved.map_or(f64::INFINITY, |moved| distance(&moved.state(-t), &numbers(&back)))
            })
            .sum();
        let claim = swing.error(t) + again.error(-t);
        let error = distance(&back, &numbers(&y));
        // beyond this no digits are left to compare
        assert!(
            error <= claim + 2.0 * handed || claim + handed > 1e-5,
            "{body:?} {y:?} {contact:?} t = {t}: {error:e}, claimed {claim:e}, handed over {handed:e}"
        );
        followed[usize::from(given)] += usize::from(claim + handed < 1e-8);
    }
    assert!(followed[1] > 2700 && lost[1] < 5 && followed[0] > 250, "{followed:?} followed, {lost:?} lost");
}

#[test]
fn a_nutation_of_no_width_has_the_frequency_of_the_linearised_motion() {
    let solid = |ell| Body::solid(ell).unwrap();
    let rounded = Body::rounded_tube(1.0, 0.0, 0.1).unwrap();
    for (body, theta) in [
        (solid(2.5), 1.3),
        (solid(1.0), 0.5),
        (solid(0.17), 0.2),
        (solid(6.0), 1.48),
        (solid(0.0), 1.2),
        (rounded_disk(), 0.3),
        (rounded, 0.5),
        (Body::balls(1.0).unwrap(), 1.3),
    ] {
        let y = steady::state(&body, theta).unwrap();
        let slope = if sharp(&body) { 40.0 } else { 100.0 };
        for contact in BOTH {
            let kappa = stability::at_rest(&body, theta, contact);
            if sharp(&body) && kappa < 0.0 {
                continue;
            }
            for kick in [1e-4, 1e-7, 1e-10, 0.0] {
                let swing = Swing::new(&body, &y.kicked(kick), contact).unwrap();
                let miss = (swing.nutation() / kappa.sqrt() - 1.0).abs();
                assert!(miss < 1e-12 + slope * kick, "{body:?}, {contact:?}, kick {kick}: {miss:e}");
            }
        }
    }
}

#[test]
fn an_unstable_state_is_left_at_the_rate_of_growth() {
    let body = Body::solid(0.5).unwrap();
    let kappa = |theta: f64| stability::at_rest(&body, theta, Contact::Rolling);
    let theta = (1..150).map(|i| 0.01 * f64::from(i)).find(|theta| kappa(*theta) < -0.05).unwrap();
    let (y, kappa) = (steady::state(&body, theta).unwrap(), kappa(theta));
    let swing = Swing::new(&body, &y.kicked(1e-9), Contact::Rolling).unwrap();
    let gone = |t: f64| (swing.state(t).theta - theta).abs();
    let growth = (gone(5.0 / (-kappa).sqrt()) / gone(4.0 / (-kappa).sqrt())).ln();
    assert!((growth - 1.0).abs() < 1e-3, "{growth}");
    // the start is exact, so that the claim stays small however long the body lingers
    let (long, nothing) = (swing.error(30.0 / (-kappa).sqrt()), swing.error(1.0));
    assert!(nothing < 1e-14 && (nothing..1e-12).contains(&long), "{nothing:e} {long:e}");
}

#[test]
fn the_first_integrals_hold_along_the_exact_motion() {
    let given = motions().into_iter().filter(|r| r.kind == "period").map(|r| (r.body, r.start, r.contact));
    let rounded = rounded_starts().into_iter().flat_map(|(body, y)| BOTH.map(|contact| (body, y, contact)));
    for (body, start, contact) in given.chain(rounded) {
        let swing = Swing::new(&body, &start, contact).unwrap();
        let energy = |y: &State| contact.energy(&body, y);
        for k in 1..40 {
            let y = swing.state(0.37 * f64::from(k));
            let size = 1.0 + energy(&y).abs();
            assert!((energy(&y) - energy(&start)).abs() < 1e-14 * size, "{body:?} {contact:?}");
            if contact == Contact::Smooth {
                let lz = |y: &State| body.i1() * y.w1 * y.theta.sin() + body.i3() * y.w3 * y.theta.cos();
                assert!((lz(&y) - lz(&start)).abs() < 1e-14 * (1.0 + lz(&y).abs()) && y.w3 == start.w3);
            }
        }
    }
}

#[test]
fn d17_a_motion_at_a_billion_costs_what_it_costs_at_twenty() {
    let rows: Vec<_> =
        motions().into_iter().filter(|r| r.kind == "state" && r.scene == "nutating cylinder").collect();
    for r in rows.iter().filter(|r| r.t >= 1e6) {
        let swing = Swing::new(&r.body, &r.start, r.contact).unwrap();
        let error = distance(&swing.state(r.t), &r.values);
        assert!(error < 2e-16 * r.t, "phase error {error:e} at t = {}", r.t);
        assert!(error <= swing.error(r.t), "claimed {:e}", swing.error(r.t));
    }
    assert!(rows.iter().filter(|r| r.t == 1e9).count() == 2);
    // at no time does it make steps: a motion to a billion costs no evaluation of the equations
    for t in [20.0, 1e9] {
        let m = roll_with(&rows[0].body, rows[0].start, &[t], &Ask::default(), || true).unwrap().unwrap();
        assert_eq!((m.evaluations, m.method), (0, Method::Exact));
    }
}

#[test]
fn d16_angles_keep_their_digits_over_a_billion_radians() {
    // an upright hoop spinning on its rim: phi' = w1 exactly
    let hoop = Body::tube(0.0, 1.0).unwrap();
    let y = state(FRAC_PI_2, 1.5, 0.0, 0.0);
    let swing = Swing::with_pose(&hoop, &y, Contact::Rolling).unwrap();
    let t = 1e9 / 1.5;
    let pose = swing.pose(t).unwrap();
    // 1.5 t as a sum, in turns of 2 pi to 106 bits
    let (hi, lo) = (1.5 * t, 1.5f64.mul_add(t, -(1.5 * t)));
    let turns = (hi / TAU).round();
    let rest = turns.mul_add(-TAU, hi) + lo - turns * 2.4492935982947064e-16;
    assert_eq!(pose.phi.turns, turns);
    assert!((pose.phi.rest - rest).abs() < 1e-9, "{} {rest}", pose.phi.rest);
    // with a nutation the angle is only as good as the period, and the claim includes that
    let body = Body::solid(1.0).unwrap();
    let y = steady::state(&body, 0.5).unwrap().kicked(0.3);
    let swing = Swing::with_pose(&body, &y, Contact::Rolling).unwrap();
    let phi = swing.angles_per_period().unwrap().precession;
    let (m, period) = ((1e9 / phi).floor(), swing.period());
    let pose = swing.pose(m * period).unwrap();
    let whole = Swing::with_pose(&body, &y, Contact::Rolling).unwrap().pose(0.0).unwrap();
    let miss = (pose.phi.rest - whole.phi.rest - (m * phi).rem_euclid(TAU) + PI).rem_euclid(TAU) - PI;
    assert!(miss.abs() < 1e-6 && swing.pose_error(m * period) > 1e-9, "{miss:e}");
}

#[test]
fn a_motion_that_lingers_at_a_saddle_is_right_to_the_digits_that_its_inputs_leave() {
    // lingering.csv has motions on, near and towards unstable steady states, to 240 bits, and their change by
    // half an ulp of the inputs, which may be as large as the motion after a long stay
    let (mut checked, mut spoilt) = (0, 0);
    for line in include_str!("../reference/lingering.csv").lines().skip(1) {
        let mut words = line.split(',');
        let kind = words.next().unwrap();
        let x: Vec<f64> = words.map(hex).collect();
        let body = Body::new(x[0], x[1], x[2]).unwrap();
        let swing = Swing::with_pose(&body, &state(x[3], x[4], x[5], x[6]), Contact::Rolling).unwrap();
        let (t, noise) = (x[7], x[12]);
        let (error, claimed) = (distance(&swing.state(t), &x[8..12]), swing.error(t));
        let name = format!("{kind} {body:?} at t = {t}: {error:e}, claimed {claimed:e}, noise {noise:e}");
        assert!(error <= (0.1 * noise).max(1e-13) && error <= claimed, "{name}");
        checked += 1;
        spoilt += usize::from(noise > 1e-9);
    }
    assert!(checked > 50 && spoilt > 15, "{checked}, {spoilt} of them half lost to the inputs");
}
