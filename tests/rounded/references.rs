//! The tables of tests/reference/rounded.py: moments, steady states and motions of the three-dimensional model.

use crate::common::{distance, number, rounded_motions};
use crate::{ULP, place};
use spincyl::exact::Swing;
use spincyl::stability::at_rest;
use spincyl::{Body, Contact, contact, steady};
use std::f64::consts::TAU;

/// The numbers of a row, without the words that it begins with.
fn rows(table: &str, words: usize) -> Vec<(String, Vec<f64>)> {
    let row = |line: &str| {
        let all: Vec<&str> = line.split(',').collect();
        (all[..words].join(","), all[words..].iter().map(|x| number(x)).collect())
    };
    table.lines().skip(1).map(row).collect()
}

#[test]
fn the_moments_of_rounded_tubes_are_those_of_integrals_over_their_height() {
    let table = rows(include_str!("../reference/rounded_moments.csv"), 0);
    for (_, x) in &table {
        let [half, bore, fillet, i1, i3, excess] = x[..] else { panic!("six numbers") };
        let body = Body::rounded_tube(half, bore, fillet).unwrap();
        assert_eq!((body.ell(), body.fillet(), body.rim()), (half - fillet, fillet, 1.0 - fillet));
        // half an ulp more: the reference is read as a double
        assert!((body.i1() / i1 - 1.0).abs() <= 5.0 * ULP, "{half} {bore} {fillet}: {} {i1}", body.i1());
        assert!((body.i3() / i3 - 1.0).abs() <= 5.0 * ULP, "{half} {bore} {fillet}: {} {i3}", body.i3());
        assert!((body.excess() - excess).abs() <= 9.0 * ULP * (1.0 + excess.abs()), "{half} {bore} {fillet}");
        let metres = Body::from_metres(2.0, 2.0 * bore, 2.0 * half, fillet).unwrap();
        assert_eq!(metres, body);
    }
    assert!(table.len() > 50);
}

#[test]
fn rates_and_kappas_are_those_of_the_three_dimensional_model() {
    let (mut checked, mut none) = (0, 0);
    for (kind, x) in rows(include_str!("../reference/rounded_steady.csv"), 1) {
        let [ell, i1, i3, fillet, theta, rate, condition, rolling, smooth] = x[..] else {
            panic!("nine numbers")
        };
        let body = Body::rounded(ell, i1, i3, fillet).unwrap();
        let found = steady::rate(&body, theta);
        assert_eq!(found.is_nan(), rate.is_nan(), "{kind} {body:?} {theta}: {found} {rate}");
        if rate.is_nan() {
            none += 1;
            continue;
        }
        let error = (found / rate - 1.0).abs() / ULP;
        assert!(error <= 2.0 * (1.0 + condition) + 1.0, "{kind} {body:?} {theta}: {error}");
        let at = place(&body, theta);
        for (contact, known) in [(Contact::Rolling, rolling), (Contact::Smooth, smooth)] {
            let inertia = match contact {
                Contact::Rolling => i1 + at.radius.powi(2) + at.depth[0].powi(2),
                Contact::Smooth => i1 + at.lever[0].powi(2),
            };
            let largest = known.abs().max(at.slope[0].abs().max(i1 * rate * rate / i3) / inertia);
            let error = (at_rest(&body, theta, contact) - known).abs() / largest;
            assert!(
                error <= 1e-13 + 16.0 * ULP * condition,
                "{kind} {contact:?} {body:?} {theta}: {error:e}"
            );
        }
        checked += 1;
    }
    assert!(checked > 300 && none > 50, "{checked} {none}");
}

#[test]
fn exact_motions_of_rounded_bodies_are_those_of_newton_and_euler_within_their_claim() {
    let (mut checked, mut poles) = (0, 0);
    for r in rounded_motions() {
        if r.kind == "period" {
            continue;
        }
        let swing = Swing::new(&r.body, &r.start, r.contact, true).unwrap();
        let (y, name) = (swing.state(r.t), format!("{} {:?} at t = {}", r.scene, r.contact, r.t));
        let growth = (r.t / 20.0).max(1.0);
        let (error, claimed) = (distance(&y, &r.values), swing.error(r.t));
        assert!(error <= claimed.min(1e-12 * growth), "{name}: {error:e}, claimed {claimed:e}");
        let pose = swing.pose(r.t).unwrap();
        let claimed = swing.pose_error(r.t);
        let whole = |x: f64| x - TAU * (x / TAU).round();
        let (phi, psi) = (pose.phi.radians() - r.values[4], pose.psi.radians() - r.values[5]);
        // by which half turn phi and psi jump at a pole is nothing that the body could tell
        let angles = if r.kind == "pole" { [whole(phi), whole(phi + psi)] } else { [phi, psi] };
        let path = [pose.contact_point.x - r.values[6], pose.contact_point.y - r.values[7]];
        let size = 1.0 + r.values[4].abs() + r.values[5].abs();
        for off in angles.into_iter().chain(path).filter(|x| !x.is_nan()) {
            assert!(
                off.abs() <= claimed && off.abs() <= 1e-12 * growth * size,
                "{name}, pose: {off:e}, claimed {claimed:e}"
            );
        }
        let f = contact::force(r.contact, &r.body, &y);
        let off = (f.normal - r.values[8]).abs().max((f.friction() - r.values[9]).abs());
        assert!(off <= 1e-11 * growth * (1.0 + r.values[8].abs()), "{name}, force: {off:e}");
        (checked, poles) = (checked + 1, poles + usize::from(r.kind == "pole"));
    }
    assert!(checked > 40 && poles >= 6, "{checked} {poles}");
}

#[test]
fn periods_and_turning_points_of_rounded_bodies_are_right_to_thirteen_digits() {
    let mut checked = 0;
    for r in rounded_motions().iter().filter(|r| r.kind == "period") {
        let swing = Swing::new(&r.body, &r.start, r.contact, true).unwrap();
        let name = format!("{} {:?}", r.scene, r.contact);
        assert!((swing.period() / r.t - 1.0).abs() <= 1e-14, "{name}: {} {}", swing.period(), r.t);
        for (found, known) in swing.turning_points().iter().zip(&r.values) {
            assert!((found / known - 1.0).abs() < 1e-13, "{name}: {found} {known}");
        }
        let angles = swing.angles_per_period().unwrap();
        for (angle, known) in angles.iter().zip(&r.values[2..]) {
            let size = 1.0 + angles[0].abs() + angles[1].abs();
            assert!((angle - known).abs() <= 1e-13 * size, "{name}: {angle} {known}");
        }
        checked += 1;
    }
    assert!(checked >= 20, "{checked}");
}
