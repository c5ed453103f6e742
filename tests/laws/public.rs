//! What a program that depends on the crate may do with its types.

use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{AboveTable, Ask, Ending, Start};
use spincyl::nalgebra::Vector3;
use spincyl::{Body, Contact, Error, Slip, State, rolling};
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

#[test]
fn losses_are_read_and_set_law_by_law() {
    let both = Losses::of(Law::AirFilm, 1e-7).with(Law::DryContour, 5e-3);
    assert_eq!(both.iter().collect::<Vec<_>>(), [(Law::DryContour, 5e-3), (Law::AirFilm, 1e-7)]);
    assert_eq!((both.coefficient(Law::AirFilm), both.coefficient(Law::Drilling)), (1e-7, 0.0));
    assert!(both.with(Law::AirFilm, 0.0).with(Law::DryContour, 0.0).is_none());
    assert_eq!(Losses::of(Law::DryContour, 5e-3) + Losses::of(Law::AirFilm, 1e-7), both);
    assert!(both.with(Law::Drilling, -1.0).check().unwrap_err().to_string().starts_with("length = -1.0"));
}

#[test]
fn options_and_starts_have_what_they_were_given() {
    let losses = Losses::of(Law::AirLinear, 1e-3);
    let ask = Ask::on(Contact::Smooth).with_losses(losses).with_restitution(0.5).with_pose().with_force();
    assert_eq!((ask.table, ask.losses, ask.restitution), (Contact::Smooth.into(), losses, Some(0.5)));
    assert!(ask.pose && ask.force && !ask.beyond && !ask.stop_at_rolling);
    let mut less = ask.with_restitution(None).with_losses(Losses::NONE);
    (less.pose, less.force) = (false, false);
    assert_eq!(less, Ask::on(Contact::Smooth));
    assert!(ask.with_beyond().beyond && ask.with_stop_at_rolling().stop_at_rolling);
    let y = State { theta: 1.0, w1: 0.1, w2: 0.2, w3: 0.3 };
    let start =
        Start::from(y).with_slip(Slip::new(1.0, 2.0)).with_time(3.0).with_aloft(AboveTable::new(0.5, -1.0));
    assert_eq!(
        (start.state, start.slip, start.time, start.aloft),
        (y, Slip::new(1.0, 2.0), 3.0, Some(AboveTable::new(0.5, -1.0)))
    );
    assert_eq!(start.with_aloft(None).with_slip(Slip::default()).with_time(0.0), y.into());
}
