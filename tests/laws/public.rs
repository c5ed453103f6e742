//! What a program that depends on the crate may do with its types.

use spincyl::loss::Law;
use spincyl::motion::Ending;
use spincyl::motion::path::Kind;
use spincyl::nalgebra::Vector3;
use spincyl::{Body, Contact, Error, State, rolling};
use std::collections::{BTreeSet, HashMap};

#[test]
fn codes_are_numbers_and_numbers_are_codes() {
    for &ending in Ending::ALL {
        assert_eq!(Ending::try_from(ending as u8), Ok(ending));
    }
    for &law in Law::ALL {
        assert_eq!(Law::try_from(law as u8), Ok(law));
    }
    let wrong = Law::try_from(200).unwrap_err();
    assert_eq!(wrong.to_string(), "code = 200.0: expected the code of a value of Law");
    assert!(matches!(wrong, Error::OutOfRange { name: "code", .. }));
}

#[test]
fn endings_and_laws_are_keys_and_words() {
    let mut counts: HashMap<Ending, usize> = HashMap::new();
    *counts.entry(Ending::LiftOff).or_default() += 1;
    assert_eq!(counts[&Ending::LiftOff], 1);
    let sorted: BTreeSet<Law> = Law::ALL.iter().copied().rev().collect();
    assert!(sorted.iter().eq(Law::ALL));
    assert_eq!(
        (Ending::LiftOff.to_string(), Law::AirFilm.to_string()),
        ("lift off".into(), "air film".into())
    );
    assert_eq!(format!("{:>10}|", Kind::Rolling), "   rolling|");
}

#[test]
fn bodies_and_states_say_their_numbers() {
    let pipe = Body::solid(2.5).unwrap();
    assert_eq!(pipe.to_string(), format!("ell = 2.5, I1 = {}, I3 = 0.5", pipe.i1()));
    let coin = Body::rounded(0.1, 0.3, 0.5, 0.05).unwrap().with_theta_end(1.2).unwrap();
    assert_eq!(coin.to_string(), "ell = 0.1, I1 = 0.3, I3 = 0.5, fillet = 0.05, theta_end = 1.2");
    let y = State { theta: 1.3, w1: 0.5, w2: 0.0, w3: -2.0 };
    assert_eq!(y.to_string(), "theta = 1.3, w = (0.5, 0, -2)");
}

#[test]
fn vectors_are_those_of_the_nalgebra_that_comes_with_the_crate() {
    let (body, y) = (Body::solid(2.5).unwrap(), State { theta: 1.0, w1: 0.1, w2: 0.2, w3: 0.3 });
    let centre: Vector3<f64> = y.centre_velocity(&body);
    assert!(centre.norm() > 0.0 && rolling::derivative(&body, &y).w2.is_finite());
    assert_ne!(Contact::Rolling, Contact::Smooth);
}
