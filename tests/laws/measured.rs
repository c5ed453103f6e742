//! Measured bodies, and their motions in metres, kilograms and seconds.

use spincyl::contact::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::measured::{Measured, MeasuredMoments, Tube};
use spincyl::motion::{AboveTable, Ask, Ending, Method, Start, roll_with};
use spincyl::{Body, Error, Scale, State, steady};
use std::f64::consts::FRAC_PI_2;

fn coin() -> Tube {
    Tube::solid(24e-3, 2e-3, 8e-3)
}

fn name(found: Result<Measured, Error>) -> String {
    found.unwrap_err().to_string()
}

#[test]
fn a_dropped_coin_falls_by_half_g_t_squared() {
    let coin = Measured::tube(&coin()).unwrap();
    let (height, g) = (0.05, 9.80665);
    let start = Start::from(State::from_rates(1.2, 0.0, 2.0, 1.0))
        .with_aloft(AboveTable::new(coin.scale().length(height), 0.0));
    let ask = Ask::on(Friction::coulomb(0.3)).with_restitution(0.5);
    let seconds = [0.0, 0.03, 0.07];
    let motion = coin.roll(start, &seconds, &ask, || true).unwrap().unwrap();
    let all: Vec<_> = motion.readings().collect();
    assert_eq!(all.iter().map(|now| now.time).collect::<Vec<_>>(), seconds);
    for now in &all {
        let fallen = all[0].position.z - now.position.z;
        assert!((fallen - 0.5 * g * now.time * now.time).abs() < 1e-14, "{fallen}");
        assert!((now.velocity.z + g * now.time).abs() < 1e-13);
        assert!((now.energy - all[0].energy).abs() < 1e-15);
    }
    let low = all[0].contact_point.z;
    assert!((low - height).abs() < 1e-16);
}

#[test]
fn a_hoop_that_rolls_has_the_speed_of_its_rim_and_carries_its_weight() {
    let hoop = Tube::solid(0.8, 0.0, 1.5).with_inner_diameter(0.8);
    let hoop = Measured::tube(&hoop).unwrap();
    let spin = hoop.scale().angular_velocity(5.0); // rad/s
    let motion =
        hoop.roll(State::from_rates(FRAC_PI_2, 0.0, 0.0, -spin), &[0.0, 2.0], &Ask::default(), || true);
    let motion = motion.unwrap().unwrap();
    let last = motion.readings().last().unwrap();
    assert!(
        (last.velocity.norm() - 0.4 * 5.0).abs() < 1e-13
            && (last.position - motion.readings().next().unwrap().position).norm() - 4.0 < 1e-12
    );
    assert!((last.angular_velocity.norm() - 5.0).abs() < 1e-13);
    assert!((last.force.z - 1.5 * 9.80665).abs() < 1e-12);
    // m g R + m v^2 of a hoop
    assert!((last.energy - 1.5 * (9.80665 * 0.4 + 4.0)).abs() < 1e-12);
    let of = motion.bounds();
    assert!(of.state < 1e-11 && of.position < 1e-11 && of.force < 1e-10);
    assert_eq!(motion.end(), (Ending::Done, None));
}

/// Modelica's wheel: R = 0.3 m, m = 2 kg, I3 = 0.06, I1 = 0.12 kg m^2, upright, 5 rad/s, tilting by 1 rad/s, after 4 s.
#[test]
fn a_wheel_given_in_kg_m2_rolls_where_modelicas_does() {
    let scale = Scale::new(0.3, 2.0, 9.80665).unwrap();
    let wheel = Measured::with_moments(scale, &MeasuredMoments::new(0.0, 0.12, 0.06)).unwrap();
    let w = |x: f64| scale.angular_velocity(x);
    let start = State::from_rates(FRAC_PI_2, w(1.0), 0.0, w(5.0));
    let motion = wheel.roll(start, &[0.0, 4.0], &Ask::default(), || true).unwrap().unwrap();
    let all: Vec<_> = motion.readings().collect();
    let moved = all[1].position - all[0].position;
    assert!((moved.x.abs() - 2.437614).abs() < 1e-6 && (moved.y.abs() - 0.036997).abs() < 1e-6, "{moved}");
}

#[test]
fn readings_are_the_samples_in_other_units() {
    let coin = Measured::tube(&coin()).unwrap();
    let losses = Losses::of(Law::RollingResistance, coin.scale().coefficient(Law::RollingResistance, 2e-5));
    let start = steady::state(coin.body(), 1.2).unwrap();
    let ask = Ask::default().with_losses(losses);
    let motion = coin.roll(start, &[0.0, 1.0, 1e3], &ask, || true).unwrap().unwrap();
    let (ending, second) = motion.end();
    assert_eq!((ending, motion.readings().count()), (Ending::Face, 2));
    let times = [0.0, coin.scale().time(1.0), coin.scale().time(1e3)];
    let ask = ask.with_pose().with_force();
    let plain = roll_with(coin.body(), start, &times, &ask, || true).unwrap().unwrap();
    assert_eq!(second, Some(coin.scale().seconds(plain.event.unwrap().time)));
    assert_eq!(motion.natural.states, plain.states);
}

#[test]
fn moments_in_the_wrong_unit_are_refused_by_name() {
    let scale = Scale::new(12e-3, 8e-3, 9.81).unwrap();
    let right = Measured::with_moments(scale, &MeasuredMoments::new(1e-3, 2.9e-7, 5.76e-7)).unwrap();
    assert!((right.body().i1() - 2.9e-7 / (8e-3 * 144e-6)).abs() < 1e-15);
    assert!(
        name(Measured::with_moments(scale, &MeasuredMoments::new(1e-3, 0.25, 0.5)))
            .starts_with("i1 = 0.25: expected")
    );
    assert!(
        name(Measured::with_moments(scale, &MeasuredMoments::new(1e-3, 2.9e-10, 5.76e-10)))
            .starts_with("i1 = 2.9e-10")
    );
    assert!(
        name(Measured::with_moments(scale, &MeasuredMoments::new(1e-3, 2.9e-7, 0.5))).starts_with("i3 = 0.5")
    );
    assert!(
        name(Measured::with_moments(scale, &MeasuredMoments::new(1e-3, f64::NAN, 5e-7)))
            .starts_with("i1 = NaN")
    );
    assert!(
        name(Measured::with_moments(scale, &MeasuredMoments::new(1.0, 2.9e-7, 5.9e-7))).starts_with("i3 = ")
    );
    for (i1, i3) in [(2.9e-7, 5.76e-7), (1.5e-4, 3.1e-4), (0.0, 0.0), (9.9e-4, 1e-3)] {
        let refused = Body::new(0.1, i1, i3).unwrap_err().to_string();
        assert!(refused.starts_with("i1 = ") && refused.contains("kg m^2"), "{refused}");
    }
    assert!(Body::new(0.1, 1e-3, 1e-9).is_ok());
}

#[test]
fn a_tube_without_measures_is_refused_by_name() {
    for (tube, named) in [
        (Tube::default(), "outer_diameter = 0.0"),
        (coin().with_mass(0.0), "mass = 0.0"),
        (coin().with_gravity(-9.8), "gravity = -9.8"),
        (coin().with_outer_diameter(24.0).with_length(2.0), "mass = 0.008: expected a mass in kg with which"),
        (coin().with_outer_diameter(24.0).with_length(2.0).with_mass(1.0), "mass = 1.0"),
        (coin().with_mass(f64::NAN), "mass = NaN"),
        (coin().with_inner_diameter(25e-3), "inner_diameter = 0.025"),
        (coin().with_length(f64::NAN), "length = NaN"),
        (coin().with_outer_diameter(1e-300), "ell = 2e297"),
    ] {
        let refused = name(Measured::tube(&tube));
        assert!(refused.starts_with(named), "{refused}");
    }
}

/// A rod that falls by rough steps, against the exact motion: no bound is below the true error, as a bound of the place
/// without the lever of the rod would be.
#[test]
fn bounds_of_a_long_rod_hold_for_its_place_velocity_force_and_energy() {
    for length in [0.1, 0.2, 1.0] {
        let rod = Measured::tube(&Tube::solid(0.02, length, 0.05)).unwrap();
        let start = State { theta: 0.3, w1: 0.02, w2: -0.02, w3: 0.1 };
        let end = rod.roll(start, &[0.0, 50.0], &Ask::default(), || true).unwrap().unwrap().end().1.unwrap();
        let t: Vec<f64> = (0..=100).map(|i| 0.009 * end * f64::from(i)).collect();
        let run =
            |method| rod.roll(start, &t, &Ask::default().with_method(method), || true).unwrap().unwrap();
        let exact = run(Method::Exact);
        for method in [Method::Step(0.3), Method::Step(0.1), Method::Tolerance(1e-4), Method::Tolerance(1e-6)]
        {
            let (motion, mut off) = (run(method), [0f64; 6]);
            for (a, b) in motion.readings().zip(exact.readings()) {
                let apart = [
                    (a.position - b.position).norm(),
                    2.0 * (a.orientation.inverse() * b.orientation).imag().norm(),
                    (a.velocity - b.velocity).norm(),
                    (a.angular_velocity - b.angular_velocity).norm(),
                    (a.force - b.force).norm(),
                    (a.energy - b.energy).abs(),
                ];
                off.iter_mut().zip(apart).for_each(|(most, x)| *most = most.max(x));
            }
            let of = motion.bounds();
            let bounds = [of.position, of.orientation, of.velocity, of.angular_velocity, of.force, of.energy];
            for (k, (off, bound)) in off.into_iter().zip(bounds).enumerate() {
                assert!(off <= bound, "length {length}, {method:?}, number {k}: {off:e} beyond {bound:e}");
            }
            assert!(bounds[0] < 100.0 * off[0], "{:e} of {:e}", bounds[0], off[0]);
        }
    }
}
