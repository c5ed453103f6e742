//! The tables of tests/reference/rounded.py: moments and steady states of the three-dimensional model.

use crate::common::number;
use crate::{ULP, place};
use spincyl::stability::at_rest;
use spincyl::{Body, Contact, steady};

/// The rows of a reference table: the words with which each begins, and its numbers.
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
        // half an ulp more, since the reference is read as a double
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
                _ => i1 + at.lever[0].powi(2),
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
