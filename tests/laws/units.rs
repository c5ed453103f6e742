//! Scales, kicks, and the two rates of a kappa.

use crate::common::any_state;
use proptest::prelude::*;
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
