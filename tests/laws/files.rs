//! Bodies, states, options and motions that are written to a file and read back.

use crate::common::{any_rim, any_state, drawn, starts, state, wander};
use proptest::prelude::*;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Value, from_str, json, to_string};
use spincyl::body::parts::BodyPart;
use spincyl::contact::{Friction, Table};
use spincyl::loss::{Law, Losses};
use spincyl::measured::{Measured, Tube};
use spincyl::motion::path::{AfterImpact, Lands, Strike};
use spincyl::motion::{AboveTable, Ask, Ending, Method, Motion, Start, roll_with};
use spincyl::stone::{self, Ellipsoid, StoneState};
use spincyl::{Body, Scale, Slip, State, steady};
use std::fmt::Debug;

fn again<T: Serialize + DeserializeOwned>(x: &T) -> T {
    from_str(&to_string(x).unwrap()).unwrap()
}

fn comes_back<T: Serialize + DeserializeOwned + PartialEq + Debug>(x: T) {
    assert_eq!(again(&x), x);
}

/// The error message for a file with these contents, which cannot be read.
fn refused<T: DeserializeOwned + Debug>(file: Value) -> String {
    from_str::<T>(&file.to_string()).unwrap_err().to_string()
}

proptest! {
    #![proptest_config(crate::common::cases(128))]

    #[test]
    fn a_body_comes_back_to_the_last_bit(body in any_rim(), y in any_state(), theta_end in 0.1..3.0f64) {
        let body = if theta_end < 1.5 { body.with_theta_end(theta_end).unwrap() } else { body };
        prop_assert_eq!(again(&body), body);
        prop_assert_eq!(again(&y), y);
    }
}

#[test]
fn a_body_from_a_file_has_passed_its_checks() {
    let body = |file: Value| from_str::<Body>(&file.to_string()).unwrap();
    assert_eq!(body(json!({"ell": 2.5, "i1": 2.0, "i3": 0.5})), Body::new(2.5, 2.0, 0.5).unwrap());
    let coin = body(json!({"ell": 0.1, "i1": 0.3, "i3": 0.5, "fillet": 0.05, "theta_end": 1.2}));
    assert_eq!(coin, Body::rounded(0.1, 0.3, 0.5, 0.05).unwrap().with_theta_end(1.2).unwrap());
    for (file, why) in [
        (json!({"ell": -1.0, "i1": 2.0, "i3": 0.5}), "ell = -1.0"),
        (json!({"ell": 1.0, "i1": 0.2, "i3": 0.5}), "i3 = 0.5, i1 = 0.2"),
        (json!({"ell": 1.0, "i1": 2e-7, "i3": 4e-7}), "kg m^2"),
        (json!({"ell": 1.0, "i1": 2.0, "i3": 0.5, "theta_end": 4.0}), "theta_end = 4.0"),
        (json!({"ell": 1.0, "i1": 2.0, "i3": 0.5, "excess": [0.1, 0.0]}), "excess = 0.1"),
        (json!({"ell": 1.0, "i1": 2.0, "i3": 0.5, "excess": [3.0, 1.0]}), "excess = 4.0"),
        (json!({"ell": 1.0, "i1": 2.0, "i3": 0.5, "filet": 0.1}), "unknown field `filet`"),
        (json!({"ell": 1.0, "i1": 2.0}), "missing field `i3`"),
    ] {
        let said = refused::<Body>(file);
        assert!(said.contains(why), "{said}");
    }
    assert!(refused::<Scale>(json!({"radius": 0.0, "mass": 1.0, "gravity": 9.8})).contains("radius = 0.0"));
    let tube = to_string(&Measured::tube(&Tube::solid(1.0, 1.0, 1.0)).unwrap());
    let without = tube.unwrap().replace("\"mass\":1.0", "\"mass\":-1.0");
    assert!(from_str::<Measured>(&without).unwrap_err().to_string().contains("mass = -1.0"));
}

#[test]
fn a_stone_from_a_file_has_passed_its_checks() {
    let stones = [
        Ellipsoid::rattleback([0.2, 0.03, 0.02], None, 0.05, None).unwrap(),
        Ellipsoid::egg(0.02, 0.03, 0.001).unwrap(),
        Ellipsoid::uniform([3.0, 7.0, 5.0]).unwrap(),
    ];
    for stone in stones {
        comes_back(stone);
    }
    let file = serde_json::to_value(stones[2]).unwrap();
    let with = |name: &str, x: Value| {
        let mut other = file.clone();
        other[name] = x;
        refused::<Ellipsoid>(other)
    };
    assert!(with("axes", json!([1.0, 0.0, 1.0])).contains("axes = 0.0"));
    assert!(
        with("inertia", json!([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 3.0]]))
            .contains("principal moments")
    );
    assert!(with("unit", json!(0.0)).contains("unit = 0.0"));
    assert!(with("theta_end", json!(9.0)).contains("theta_end = 9.0"));
}

#[test]
fn options_and_starts_come_back_and_may_be_short() {
    for table in
        [Table::default(), Table::Rolling { mu: 0.3 }, Table::Smooth, Friction::Viscous { c: 2.0 }.into()]
    {
        comes_back(Ask::on(table).with_pose());
    }
    let sticky = Friction::Coulomb { mu: 0.2, fixed: f64::INFINITY, patch: 0.01 };
    comes_back(Ask::on(sticky).with_method(Method::Tolerance(1e-9)).with_restitution(0.5));
    comes_back(
        Start::from(state(1.0, 0.1, 0.2, 0.3))
            .with_slip(Slip::new(1.0, 2.0))
            .with_aloft(AboveTable::new(0.5, 0.0)),
    );
    let short: Ask =
        from_str(r#"{"losses": {"AirFilm": 1e-7, "DryContour": 0.01}, "table": "Smooth"}"#).unwrap();
    assert_eq!(
        short,
        Ask::on(Table::Smooth).with_losses(Losses::of(Law::AirFilm, 1e-7).with(Law::DryContour, 0.01))
    );
    let mu = |word: &str| from_str::<Table>(&format!(r#"{{"Rolling": {{"mu": {word}}}}}"#));
    assert_eq!((mu("\"inf\"").unwrap(), mu("1").unwrap()), (Table::default(), Table::Rolling { mu: 1.0 }));
    assert!(mu("\"much\"").is_err() && mu("null").is_err());
    let y: Start = from_str(r#"{"state": {"theta": 1.0, "w1": 0.1, "w2": 0.2, "w3": 0.3}}"#).unwrap();
    assert_eq!(y, state(1.0, 0.1, 0.2, 0.3).into());
    assert!(refused::<Ask>(json!({"restituton": 0.5})).contains("unknown field"));
    assert!(refused::<Losses>(json!({"AirFilm": -1.0})).contains("viscosity = -1.0"));
    assert!(refused::<Losses>(json!({"Glue": 1.0})).contains("unknown variant `Glue`"));
    assert!(
        refused::<State>(json!({"theta": 1.0, "w1": 0.0, "w2": 0.0, "w3": 0.0, "w4": 0.0})).contains("w4")
    );
    comes_back(Losses::NONE);
    comes_back(Scale::new(0.1, 0.2, 9.81).unwrap());
    let part: BodyPart =
        from_str(r#"{"form": {"Ring": {"radius": 1.0, "height": 0.2}}, "amount": {"Mass": 2.0}}"#).unwrap();
    comes_back(part);
    for &ending in Ending::ALL {
        comes_back(ending);
    }
}

/// For each object of a file, at any depth, a copy of the file with an unknown name added to this object; losses are
/// objects whose names are laws.
fn misspelt(file: &Value) -> Vec<Value> {
    let mut all = Vec::new();
    match file {
        Value::Object(fields) => {
            let mut more = fields.clone();
            more.insert("msipelt".into(), json!(0.5));
            all.push(Value::Object(more));
            for (name, inner) in fields {
                for other in misspelt(inner) {
                    let mut with = fields.clone();
                    with[name] = other;
                    all.push(Value::Object(with));
                }
            }
        }
        Value::Array(items) => {
            for (i, inner) in items.iter().enumerate() {
                for other in misspelt(inner) {
                    let mut with = items.clone();
                    with[i] = other;
                    all.push(Value::Array(with));
                }
            }
        }
        _ => (),
    }
    all
}

/// Asserts that an unknown name raises an error in every object of the file of `x`; returns the number of objects.
fn every_name_counts<T: Serialize + DeserializeOwned + Debug>(x: &T) -> usize {
    let wrong = misspelt(&serde_json::to_value(x).unwrap());
    for file in &wrong {
        assert!(from_str::<T>(&file.to_string()).is_err(), "{file}");
    }
    wrong.len()
}

#[test]
fn a_misspelt_name_is_an_error_in_every_object_of_every_file() {
    let mut objects = 0;
    for table in [
        Table::default(),
        Friction::Coulomb { mu: 0.3, fixed: 0.4, patch: 0.05 }.into(),
        Friction::Viscous { c: 2.0 }.into(),
    ] {
        let losses = Losses::of(Law::AirLinear, 0.1);
        objects += every_name_counts(&Ask::on(table).with_losses(losses).with_method(Method::Step(0.1)));
        objects += every_name_counts(&table);
    }
    let file = r#"{"table": {"Rubs": {"Coulomb": {"mu": 0.3, "fixed": 0.3, "patch": 0.0, "pathc": 0.05}}}}"#;
    assert!(from_str::<Ask>(file).unwrap_err().to_string().contains("unknown field `pathc`"));
    let tube = Tube::solid(24e-3, 2e-3, 8e-3);
    let coin = Measured::tube(&tube).unwrap();
    objects += every_name_counts(&tube) + every_name_counts(&coin);
    objects +=
        every_name_counts(&Start::from(state(1.0, 0.1, 0.2, 0.3)).with_aloft(AboveTable::new(0.5, 0.0)));
    for form in [
        r#""Solid": {"radii": [1, 1], "bores": [0, 0], "ends": [0, 1], "fillet": 0}"#,
        r#""Ball": {"radius": 1, "hollow": 0, "centre": 0, "ends": [-1, 1]}"#,
        r#""Ring": {"radius": 1, "height": 0.2}"#,
    ] {
        let part =
            from_str::<BodyPart>(&format!(r#"{{"form": {{{form}}}, "amount": {{"Mass": 2}}}}"#)).unwrap();
        objects += every_name_counts(&part);
    }
    let ask = Ask::on(Friction::coulomb(0.2)).with_pose().with_force().with_restitution(0.5);
    let falls = Start::from(state(0.4, 0.3, 0.2, 0.5)).with_aloft(AboveTable::new(0.3, 0.0));
    let motion = roll_with(coin.body(), falls, &[1.0, 40.0], &ask, || true).unwrap().unwrap();
    assert!(motion.path.as_ref().is_some_and(|path| !path.impacts.is_empty()));
    objects += every_name_counts(&motion.samples().next().unwrap()) + every_name_counts(&motion);
    let slow = coin.roll(steady::state(coin.body(), 1.2).unwrap(), &[0.1], &Ask::default(), || true);
    let slow = slow.unwrap().unwrap();
    objects += every_name_counts(&slow) + every_name_counts(&slow.readings().next().unwrap());
    let egg = Ellipsoid::egg(0.02, 0.03, 0.001).unwrap();
    let turns = stone::roll(&egg, egg.spinning(1.0, 0.1, 0.0), &[1.0], &Ask::default().with_pose(), || true);
    objects += every_name_counts(&egg) + every_name_counts(&turns.unwrap().unwrap());
    assert!(objects > 60, "{objects}");
}

/// Asserts that a motion is the same after it is written and read. Texts are compared, since NaN does not equal
/// itself.
fn same<T: Serialize + DeserializeOwned>(motion: &T) {
    assert_eq!(to_string(&again(motion)).unwrap(), to_string(motion).unwrap());
}

#[test]
fn motions_come_back_whole() {
    let times = [0.0, 0.5, 3.0, 40.0];
    let mut r = wander(5);
    for (body, y) in starts() {
        for ask in [
            Ask::default(),
            Ask::on(Friction::coulomb(0.2)).with_pose().with_force(),
            Ask::on(Friction::coulomb(0.2)).with_losses(Losses::of(Law::AirLinear, 1e-2)),
        ] {
            same(&roll_with(&body, y, &times, &ask, || true).unwrap().unwrap());
        }
    }
    let tube = Body::tube(1.5, 0.6).unwrap();
    let mut turned = 0;
    for _ in 0..drawn(9) {
        let start = Start::from(state(0.4 + r(), 2.0 * r() - 1.0, r(), 3.0 * r() - 1.5))
            .with_aloft(AboveTable::new(0.3, 0.0));
        let ask = Ask::on(Friction::coulomb(0.3)).with_restitution(0.4).with_pose();
        let motion = roll_with(&tube, start, &times, &ask, || true).unwrap().unwrap();
        same(&motion);
        let back: Motion = again(&motion);
        assert!(back.orientations().eq(motion.orientations()));
        assert!(back.samples().zip(motion.samples()).all(|(a, b)| a.pose == b.pose && a.rim == b.rim));
        turned += motion.samples().filter(|now| now.rim == 1).count();
    }
    assert!(turned > 0);
    let half = Ellipsoid::rattleback([1.0, 0.2, 0.17], None, 0.035, None).unwrap();
    let ask = Ask::default().with_pose().with_force();
    same(&stone::roll(&half, half.spinning(-0.5, 1e-3, 1e-3), &times, &ask, || true).unwrap().unwrap());
    comes_back(StoneState::spinning(1.0, 0.1, 0.2));
    let coin = Measured::tube(&Tube::solid(24e-3, 2e-3, 8e-3)).unwrap();
    let motion = coin.roll(steady::state(coin.body(), 1.2).unwrap(), &[0.0, 0.1], &Ask::default(), || true);
    let motion = motion.unwrap().unwrap();
    same(&motion);
    same(&motion.readings().collect::<Vec<_>>());
}

#[test]
fn numbers_that_have_names_are_arrays_and_bools_in_files() {
    let y = json!(state(1.2, 0.1, 0.2, 0.3));
    let strike = json!({
        "time": 1.5, "other": true, "rim": 1, "hit": "Slips", "states": [y, y],
        "velocities": [[0.5, 0.25, -1.0], [0.5, 0.0, 0.5]], "impulse": [0.125, 0.0, 1.0], "couple": 0.0,
        "lost": 0.5, "stays": false,
    });
    let read = Strike::<State>::deserialize(&strike).unwrap();
    assert_eq!((read.lands, read.after), (Lands::Other, AfterImpact::Leaves));
    assert_eq!(serde_json::to_value(read).unwrap(), strike);
    let start = json!({
        "state": y, "slip": [0.5, 0.25], "time": 0.0, "aloft": [0.5, -1.0], "heading": 0.0, "place": [0.0, 0.0],
    });
    let read = Start::<State>::deserialize(&start).unwrap();
    assert_eq!((read.slip, read.aloft), (Slip::new(0.5, 0.25), Some(AboveTable::new(0.5, -1.0))));
    assert_eq!(serde_json::to_value(read).unwrap(), start);
    // The slip of the other rim, and then the force on it: its normal component, and those across and along the lean.
    let ask = Ask::on(Friction::coulomb(0.3)).with_restitution(0.0).with_force();
    let lies = Start::from(state(std::f64::consts::FRAC_PI_2, 0.2, 0.0, 0.0));
    let motion = roll_with(&Body::solid(2.0).unwrap(), lies, &[0.01], &ask, || true).unwrap().unwrap();
    let other = motion.samples().next().unwrap().other_rim.unwrap();
    let file = serde_json::to_value(&motion).unwrap();
    let numbers = [other.slip.u_h, other.slip.u_2, other.force.normal, other.force.along, other.force.across];
    assert_eq!(file["path"]["other_rim"], json!([numbers]));
    assert!(numbers[2] > 0.1 && file["path"]["aloft"] == json!([[0.0, 0.0]]), "{numbers:?}");
}

#[test]
fn a_motion_from_a_file_that_lost_a_part_is_shorter_and_never_panics() {
    let (body, y) = starts().next().unwrap();
    let ask = Ask::on(Friction::coulomb(0.2)).with_pose().with_force();
    let motion = roll_with(&body, y, &[0.0, 1.0], &ask, || true).unwrap().unwrap();
    let mut file = serde_json::to_value(&motion).unwrap();
    for name in ["times", "poses", "forces"] {
        file[name] = json!([]);
    }
    for name in ["slip", "kinds", "rims"] {
        file["path"][name] = json!([]);
    }
    let less = Motion::<State>::deserialize(&file).unwrap();
    assert!(less.samples().all(|now| now.pose.is_none() && now.slip.is_none() && now.time.is_nan()));
}
