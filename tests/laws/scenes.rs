//! Scenes for contact engines: the files of Python and of this crate agree, and engines are compared with the known
//! answer.

use crate::common::larger;
use nalgebra::{UnitQuaternion, Vector3};
use serde::Deserialize;
use serde_json::{Value, from_str, to_value};
use spincyl::contact::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::measured::{Measured, Tube};
use spincyl::motion::Ask;
use spincyl::scene::{Contents, Doubt, Natural, Scene, SceneError, SceneFriction, TrajectoryRow};
use spincyl::{Body, Scale, State, roll, steady};
use std::collections::BTreeMap;

#[path = "../../examples/scene.rs"]
mod example;

/// A scene as Python writes it, and the hashes of its models.
#[derive(Deserialize)]
struct Record {
    file: Value,
    mjcf: String,
    urdf: Option<String>,
}

/// The records of `python tests/scene_records.py`.
fn records() -> BTreeMap<String, Record> {
    from_str(include_str!("scenes.json")).unwrap()
}

/// The hash FNV-1a of a text.
fn hashed(text: &str) -> String {
    let start = 0xcbf2_9ce4_8422_2325u64;
    let found =
        text.bytes().fold(start, |found, byte| (found ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    format!("{found:016x}")
}

fn read(record: &Record) -> Scene {
    Scene::read(&record.file.to_string()).unwrap()
}

/// The scene of the same body, start and options, computed by this crate.
fn again(scene: &Scene) -> Scene {
    let (scale, known) = (scene.scale().unwrap(), &scene.contents().expected);
    let mut time = known.time.clone();
    if known.ending.kind != "DONE" {
        time.push(known.ending.time.max(time[time.len() - 1]) * 1.001); // after the end: no row
    }
    let time = &time[..];
    let again = match scene.contents().natural.as_ref().unwrap() {
        Natural::Body { body, start, ask, .. } => Scene::of(&Measured::new(*body, scale), *start, time, ask),
        Natural::Stone { stone, start, ask, .. } => Scene::of_stone(stone, &scale, *start, time, ask),
        _ => unreachable!(),
    };
    again.unwrap()
}

/// The largest difference of two lists of numbers; a number that one of them lacks is infinitely far.
fn apart(a: &Value, b: &Value) -> f64 {
    match (a, b) {
        (Value::Null, Value::Null) => 0.0,
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).map(|(a, b)| apart(a, b)).fold(0.0, larger)
        }
        _ => a.as_f64().zip(b.as_f64()).map_or(f64::INFINITY, |(a, b)| (a - b).abs()),
    }
}

/// Asserts that two files say the same, and their numbers within an allowance that depends on the path of keys.
fn assert_alike(name: &str, path: &str, a: &Value, b: &Value, allowed: &dyn Fn(&str) -> f64) {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            let keys = |of: &serde_json::Map<String, Value>| of.keys().cloned().collect::<Vec<_>>();
            assert_eq!(keys(a), keys(b), "{name}: {path}");
            for (key, x) in a {
                assert_alike(name, &format!("{path}.{key}"), x, &b[key], allowed);
            }
        }
        (Value::Array(all), Value::Array(others)) if all.first().is_some_and(Value::is_object) => {
            assert_eq!(all.len(), others.len(), "{name}: {path}");
            for (a, b) in all.iter().zip(others) {
                assert_alike(name, path, a, b, allowed);
            }
        }
        (Value::String(a), Value::String(b)) => {
            assert!(a == b || path.ends_with("name") || path.ends_with("why"), "{name}: {path}: {a} {b}");
        }
        _ => {
            let off = apart(a, b);
            assert!(
                off <= allowed(path),
                "{name}: {path} differs by {off:e}, allowed {:e}: {a} {b}",
                allowed(path)
            );
        }
    }
}

#[test]
fn python_and_this_crate_write_the_same_file() {
    let all = records();
    assert!(all.len() > 40, "{}", all.len());
    for (name, record) in all {
        let scene = read(&record);
        let (told, own) = (&record.file, to_value(again(&scene).contents()).unwrap());
        let error = |key: &str| told["error"][key].as_f64().unwrap_or(0.0);
        let [radius, mass, gravity] = ["R", "M", "g"].map(|key| told["scale"][key].as_f64().unwrap());
        let second = told["scale"]["second"].as_f64().unwrap();
        let joule = mass * gravity * radius;
        let fast = scene.contents().expected.angular_velocity.iter().map(|w| w.norm()).fold(0.0, larger);
        let quick = (1.0 + fast * second) * 1e-13;
        let allowed = |path: &str| {
            let key = path.rsplit('.').next().unwrap();
            2.0 * match path.split('.').nth(1).unwrap() {
                // Estimates, by another way through the same motion.
                "error" => 1e3 * told["error"][key].as_f64().unwrap_or(1.0) + 1e-10 * (1.0 + mass * gravity),
                "body" => 1e-12 * (mass * radius * radius + mass + radius + 1.0),
                "table" => 1e-9 * told["table"]["friction"][key].as_f64().unwrap_or(1.0) + 1e-14,
                "natural" => 1e-13,
                "expected" | "start" => match key {
                    "position" | "contact_point" => {
                        error("position").max(error("contact_point")) + quick * radius
                    }
                    "height" => error("position") + quick * radius,
                    "orientation" | "theta" => error("angle") + quick,
                    "velocity" => error("velocity") + quick * radius / second,
                    "energy" | "energy_lost" | "heat_of_slip" | "lost_by_losses" | "lost_in_impacts" => {
                        error("energy") + error("heat_and_losses") + quick * joule
                    }
                    "normal_force" | "contact_force" => {
                        error("contact_force").max(error("normal_force")) + quick * mass * gravity
                    }
                    "normal_impulse" => error("velocity") * mass + 1e-11 * mass * radius / second,
                    "time" => error("times_of_phases_and_impacts") + 1e-12 * second,
                    _ => error("angular_velocity") + quick / second,
                },
                _ => 1e-15 * radius.max(1.0).max(mass).max(gravity),
            }
        };
        // An axis of inertia has no sign, and any axis across that of a body of revolution is one.
        let plain = |of: &Value| {
            let mut of = of.clone();
            for (at, key) in [
                ("/body", "principal_axes"),
                ("/body/shape", "inner_radius"),
                ("/natural/body", "excess"),
                ("/natural/body", "theta_end"),
            ] {
                of.pointer_mut(at).and_then(Value::as_object_mut).map(|of| of.remove(key));
            }
            of["natural"]["ask"] = Value::Null;
            of["natural"]["start"] = Value::Null;
            of
        };
        assert_alike(&name, "", &plain(told), &plain(&own), &allowed);
        // What both are computed from, with the defaults that Python leaves out.
        assert_eq!(
            again(&scene).contents().natural.as_ref().unwrap().ask().losses,
            scene.contents().natural.as_ref().unwrap().ask().losses
        );
        let body = &scene.contents().body;
        for (moment, axis) in body.principal_moments.iter().zip(again(&scene).contents().body.principal_axes)
        {
            let off = (body.inertia * axis - *moment * axis).norm();
            assert!(off < 1e-10 * body.principal_moments[2], "{name}: {off}");
        }
    }
}

#[test]
fn the_models_of_a_file_are_the_same_text_in_both_languages() {
    let mut with_urdf = 0;
    for (name, record) in records() {
        let scene = read(&record);
        assert_eq!(hashed(&scene.mjcf()), record.mjcf, "{name}");
        assert_eq!(scene.urdf().ok().map(|text| hashed(&text)), record.urdf, "{name}");
        with_urdf += usize::from(record.urdf.is_some());
    }
    assert!(with_urdf > 15, "{with_urdf}");
}

#[test]
fn a_file_comes_back_and_says_what_is_wrong_with_it() {
    let file = records().remove("hops in air").unwrap().file;
    let scene = Scene::read(&file.to_string()).unwrap();
    assert_eq!(Scene::read(&scene.json()).unwrap(), scene);
    assert_eq!(from_str::<Contents>(&scene.json()).unwrap(), *scene.contents());
    let refused = |at: &str, x: Value| {
        let mut other = file.clone();
        *other.pointer_mut(at).unwrap() = x;
        Scene::read(&other.to_string()).unwrap_err().to_string()
    };
    assert!(refused("/spincyl-scene", 2.into()).contains("spincyl-scene = 2"));
    assert!(refused("/body/mass", "much".into()).contains("much"));
    assert!(refused("/expected/position/0/2", 7.0.into()).contains("the known motion of this file"));
    assert!(refused("/natural/ask/restitution", 0.4.into()).contains("the known motion of this file"));
    assert!(Scene::read("{}").unwrap_err().to_string().starts_with("text: missing field"));
    let mut bare = file.clone();
    bare.as_object_mut().unwrap().remove("natural");
    let bare = Scene::read(&bare.to_string()).unwrap();
    assert!(matches!(bare.at(&[0.0]), Err(SceneError::Motion(why)) if why.starts_with("natural")));
}

fn coin() -> (Measured, Scene) {
    let coin = Tube::solid(25.75e-3, 2.2e-3, 8.5e-3);
    let coin = Measured::tube(&coin).unwrap();
    let start = steady::state(coin.body(), 0.7).unwrap().kicked(0.05);
    (coin, Scene::of(&coin, start, &[0.0, 0.25, 0.5], &Ask::default()).unwrap())
}

/// The inclination of the answer is that of the motion in natural units, and a place and an orientation that are off by known
/// amounts are told as off by these.
#[test]
fn an_engine_is_compared_at_its_own_times() {
    let (coin, scene) = coin();
    let times: Vec<f64> = (0..=97).map(|i| 5e-3 * f64::from(i)).collect();
    let known = scene.at(&times).unwrap();
    let compared = scene.compare(&known).unwrap();
    let most = compared.largest();
    assert!(most.position == 0.0 && most.angle < 1e-15 && most.theta == 0.0 && compared.doubts.is_empty());
    assert!(0.0 < compared.position_error && compared.position_error < 1e-12);
    // Another way to the same answer: the exact motion of the crate in natural units.
    let natural: Vec<f64> = times.iter().map(|t| coin.scale().time(*t)).collect();
    let start = steady::state(coin.body(), 0.7).unwrap().kicked(0.05);
    let motion = roll(coin.body(), &start, &natural).unwrap();
    let turned = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 0.01);
    let wrong: Vec<TrajectoryRow> = known
        .iter()
        .map(|row| TrajectoryRow::new(row.time, row.position + Vector3::x() * 3e-3, turned * row.orientation))
        .collect();
    let off = scene.compare(&wrong).unwrap();
    for ((row, y), right) in off.rows.iter().zip(&motion.states).zip(&known) {
        assert!((row.position - 3e-3).abs() < 1e-15 && (row.angle - 0.01).abs() < 1e-12, "{row:?}");
        let axis = right.orientation * Vector3::z();
        assert!((axis.z - y.theta.cos()).abs() < 1e-13);
        assert!((row.theta - ((turned * axis).z.acos() - axis.z.acos())).abs() < 1e-12);
    }
    // Numbers in other units, and quaternions in another order, are doubted.
    let [x, y, z, w] = <[f64; 4]>::from(known[0].orientation.coords);
    let swapped = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(x, y, z, w));
    let first = TrajectoryRow::new(0.0, known[0].position * 1e3, swapped);
    let last = TrajectoryRow::new(500.0, known[97].position * 1e3, known[97].orientation);
    let doubted = scene.compare(&[first, last]).unwrap();
    assert_eq!(doubted.doubts, [Doubt::Orientation, Doubt::Times, Doubt::Positions]);
    let late = TrajectoryRow::new(-1.0, known[0].position, known[0].orientation);
    assert!(scene.compare(&[late]).unwrap_err().to_string().contains("ascending"));
    let long = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(2.0, 0.0, 0.0, 0.0));
    let long = TrajectoryRow::new(0.0, known[0].position, long);
    assert!(scene.compare(&[long]).unwrap_err().to_string().contains("unit quaternion"));
}

#[test]
fn rows_after_the_end_of_a_motion_are_left_out() {
    let can = Measured::new(Body::solid(1.0).unwrap(), Scale::new(0.05, 0.2, 9.81).unwrap());
    let scene =
        Scene::of(&can, State::from_rates(0.3, 0.0, 0.0, 0.0), &[0.05, 0.1, 2.0], &Ask::default()).unwrap();
    let end = &scene.contents().expected.ending;
    assert_eq!((end.kind.as_str(), scene.contents().expected.time.len()), ("FACE", 3));
    let place = scene.contents().expected.position[0];
    let row = |time| TrajectoryRow::new(time, place, scene.contents().start.orientation);
    assert_eq!(scene.compare(&[row(0.0), row(0.5 * end.time), row(1.5 * end.time)]).unwrap().rows.len(), 2);
    assert!(scene.compare(&[row(1.5 * end.time)]).is_err());
}

#[test]
fn a_scene_is_refused_for_a_motion_that_no_engine_can_have() {
    let (coin, _) = coin();
    let start = steady::state(coin.body(), 0.7).unwrap();
    let of = |seconds: &[f64], ask: Ask| Scene::of(&coin, start, seconds, &ask).unwrap_err().to_string();
    assert!(of(&[0.0, 0.2, 0.1], Ask::default()).starts_with("seconds"));
    assert!(of(&[0.0], Ask::default()).contains("a time after"));
    assert!(of(&[0.1], Ask::default().with_turning(0.1)).starts_with("turning"));
    assert!(of(&[0.1], Ask::default().with_restitution(2.0)).starts_with("restitution"));
}

/// The couple takes the power of its laws, and in the air only that of the air.
#[test]
fn the_couple_of_a_scene_is_that_of_its_laws() {
    let (coin, _) = coin();
    let scale = coin.scale();
    let [arm, air] =
        [(Law::DryContour, 1e-4), (Law::AirLinear, 2e-9)].map(|(law, x)| scale.coefficient(law, x));
    let ask = Ask::default().with_losses(Losses::of(Law::DryContour, arm).with(Law::AirLinear, air));
    let start = steady::state(coin.body(), 0.7).unwrap();
    let scene = Scene::of(&coin, start, &[0.0, 0.1], &ask).unwrap();
    let (q, w) = (UnitQuaternion::from_euler_angles(0.4, -0.3, 1.0), Vector3::new(3.0, -8.0, 20.0));
    let flying = scene.couple(&q, w, 0.0).unwrap();
    assert!((flying + w * 2e-9).norm() < 1e-22);
    let pressed = scene.couple(&q, w, 0.08).unwrap() - flying;
    // eps N A sign(q) h/s, as the file says.
    let (n, a) = (Vector3::z(), q * Vector3::z());
    let s = n.cross(&a).norm();
    let turns = (w.dot(&a) - a.dot(&n) * w.dot(&n)) / (s * s);
    let h = (a.dot(&n) * n - a) / s;
    let expected = 1e-4 * 0.08 * turns.signum() / s * h;
    assert!((pressed - expected).norm() < 1e-12 * expected.norm(), "{pressed} {expected}");
    let told = &scene.contents().table.losses;
    assert!((told[0].value - 1e-4).abs() < 1e-18 && told[0].couple == "eps*N*A*sign(q)*h/s");
}

/// Newton's law over each interval without an impact, from what the file of the example says alone.
#[test]
fn the_scene_of_the_example_obeys_newton() {
    let scene = example::thrown().unwrap();
    let told = Scene::read(&scene.json()).unwrap();
    let (of, known) = (told.contents(), &told.contents().expected);
    let (time, v, force) = (&known.time, &known.velocity, &known.normal_force);
    let impacts = known.impacts.as_ref().unwrap().iter().map(|hit| hit.time);
    let changes: Vec<f64> = impacts.chain(known.phases.iter().map(|phase| phase.time)).collect();
    assert_eq!((time.len(), changes.len() > 10), (401, true));
    let (mut flies, mut touches) = (0, 0);
    for i in 1..time.len() - 1 {
        let [from, to] = [time[i - 1], time[i + 1]];
        if changes.iter().any(|t| from <= *t && *t <= to) {
            continue;
        }
        let by = |x: [f64; 3]| (x[0] + 4.0 * x[1] + x[2]) / 6.0 * (to - from); // Simpson
        let gained = of.body.mass * (v[i + 1].z - v[i - 1].z - of.gravity.z * (to - from));
        let moved = known.position[i + 1].z - known.position[i - 1].z - by([i - 1, i, i + 1].map(|i| v[i].z));
        let pushed = by([i - 1, i, i + 1].map(|i| force[i]));
        if pushed == 0.0 {
            assert!(gained.abs() < 1e-13 && moved.abs() < 1e-14);
            flies += 1;
        } else {
            assert!(
                (gained - pushed).abs() < 0.02 * of.body.mass * 9.8 * (to - from),
                "{i}: {gained} {pushed}"
            );
            assert!(moved.abs() < 1e-6, "{i} {moved}");
            touches += 1;
        }
    }
    assert!(flies > 3 && touches > 50, "{flies} {touches}");
    assert!(of.error.position < 1e-8);
    let y = State::from_twist(&of.start.orientation, of.start.angular_velocity);
    assert!((y.theta.to_degrees() - 80.0).abs() < 1e-12);
    assert!((y.precession() - 20.0).abs() < 1e-11 && (y.spin() - 30.0).abs() < 1e-11, "{y}");
    let SceneFriction::Coulomb { mu, .. } = of.table.friction else { unreachable!() };
    assert_eq!((mu, of.table.restitution), (0.3, Some(0.5)));
    let Some(Natural::Body { start, ask, .. }) = of.natural else { unreachable!() };
    assert_eq!((start.time, ask.table), (0.0, Friction::coulomb(0.3).into()));
}
