//! Scales, kicks, and the two rates of a kappa.

use crate::common::any_state;
use crate::common::loss_power::{LossRates, loss_power};
use proptest::prelude::*;
use spincyl::loss::{Law, Losses};
use spincyl::{Body, Scale, rolling, stability};
use std::f64::consts::PI;

proptest! {
    #![proptest_config(crate::common::cases(256))]

    #[test]
    fn a_kick_changes_the_tilting_rate_and_nothing_else(y in any_state(), thetadot in -1.0..1.0f64) {
        let kicked = y.kicked(thetadot);
        let dy = rolling::derivative(&Body::solid(1.0).unwrap(), &kicked);
        prop_assert_eq!(dy.theta, -y.w2 + thetadot);
        prop_assert_eq!((kicked.theta, kicked.w1, kicked.w3), (y.theta, y.w1, y.w3));
        // nalgebra squares the speeds, which may be as small as 1e-300
        let w = y.angular_velocity();
        let w = if w.amax() > 0.0 { w / w.amax() } else { w };
        prop_assert!((y.gamma() - w.angle(&nalgebra::Vector3::z())).abs() < 1e-7);
    }
}

/// A conversion of a quantity to SI or back.
type Way = fn(&Scale, f64) -> f64;
const WAYS: [(Way, Way); 11] = [
    (Scale::metres, Scale::length),
    (Scale::seconds, Scale::time),
    (Scale::metres_per_second, Scale::speed),
    (Scale::radians_per_second, Scale::angular_velocity),
    (Scale::turns, Scale::turning),
    (Scale::newtons, Scale::force),
    (Scale::newton_seconds, Scale::impulse),
    (Scale::joules, Scale::energy),
    (Scale::newton_metres, Scale::couple),
    (Scale::watts, Scale::power),
    (Scale::kilogram_square_metres, Scale::moment),
];

/// The number of doubles from a to b.
fn ulps(a: f64, b: f64) -> u64 {
    a.to_bits().abs_diff(b.to_bits())
}

proptest! {
    #![proptest_config(crate::common::cases(512))]

    #[test]
    fn what_goes_to_si_and_back_keeps_its_digits(
        exponents in prop::array::uniform3(-100.0..100.0f64), small in any::<bool>(), x in -4.0..4.0f64,
    ) {
        let [r, m, g] = exponents.map(|e| 10f64.powf(if small { e / 50.0 } else { e }));
        let scale = Scale::new(r, m, g).unwrap();
        prop_assert_eq!([scale.radius(), scale.mass(), scale.gravity()], [r, m, g]);
        for (to, back) in WAYS {
            let (si, natural) = (to(&scale, x), back(&scale, x));
            prop_assert!(si.is_normal() && natural.is_normal());
            prop_assert!(ulps(back(&scale, si), x) <= 2 && ulps(to(&scale, natural), x) <= 2);
        }
        for &law in Law::ALL {
            let si = scale.coefficient_in_si(law, x);
            prop_assert!(si.is_normal() && ulps(scale.coefficient(law, si), x) <= 2, "{:?}", law);
        }
    }

    /// Units of mechanics: N = kg m/s^2 and so on, to a few roundings.
    #[test]
    fn units_are_products_of_metres_kilograms_and_seconds(r in 1e-3..10.0f64, kg in 1e-3..10.0f64, g in 1.0..20.0f64) {
        let scale = Scale::new(r, kg, g).unwrap();
        let (m, s) = (scale.metres(1.0), scale.seconds(1.0));
        prop_assert!((s * s * g / r - 1.0).abs() < 1e-15);
        let expected = [
            m, s, m / s, 1.0 / s, 1.0 / s / (2.0 * PI), kg * m / (s * s), kg * m / s, kg * m * m / (s * s),
            kg * m * m / (s * s), kg * m * m / (s * s * s), kg * m * m,
        ];
        for ((to, _), unit) in WAYS.into_iter().zip(expected) {
            prop_assert!((to(&scale, 1.0) / unit - 1.0).abs() < 4e-15, "{}", unit);
        }
    }

    /// The power of each law, written in SI: with the weight in newtons and rates in rad/s, and A as a share of R.
    #[test]
    fn a_coefficient_in_si_takes_its_watts(
        y in any_state(), r in 1e-3..1.0f64, kg in 1e-3..10.0f64, g in 1.0..20.0f64, x in 1e-6..1e-2f64,
    ) {
        let (body, scale) = (Body::solid(0.3).unwrap(), Scale::new(r, kg, g).unwrap());
        let rate = |w: f64| scale.radians_per_second(w);
        let (w, (s, c)) = (y.angular_velocity().map(rate), y.theta.sin_cos());
        let (spin, weight) = (rate(y.spin()), kg * g);
        let rolling = (c * w.x - s * w.z).hypot(w.y);
        let drilling = s * w.x + c * w.z;
        let at = LossRates { weight, spin, rolling, drilling, whole: w.norm(), sine: s, radius: r };
        for &law in Law::ALL {
            let watts = x * loss_power(law, &at);
            let losses = Losses::of(law, scale.coefficient(law, x));
            let found = scale.watts(losses.power(&body, &y, 1.0));
            prop_assert!((found - watts).abs() <= 1e-11 * watts, "{:?}: {} {}", law, found, watts);
        }
    }
}

#[test]
fn a_nutation_or_a_growth_never_both() {
    assert_eq!((stability::nutation(4.0), stability::growth_rate(4.0)), (2.0, 0.0));
    assert_eq!((stability::nutation(-9.0), stability::growth_rate(-9.0)), (0.0, 3.0));
    assert!(stability::nutation(f64::NAN).is_nan() && stability::growth_rate(f64::NAN).is_nan());
}

#[test]
fn a_scale_turns_natural_units_into_si() {
    let scale = Scale::new(0.02, 0.5, 8.0).unwrap();
    assert_eq!((scale.metres(3.0), scale.joules(2.0)), (0.06, 0.16));
    assert!((scale.seconds(4.0) - 0.2).abs() < 1e-16);
    assert!((scale.turns(2.0 * PI) - 20.0).abs() < 1e-13);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            Scale::new(bad, 1.0, 1.0).is_err()
                && Scale::new(1.0, bad, 1.0).is_err()
                && Scale::new(1.0, 1.0, bad).is_err()
        );
    }
}
