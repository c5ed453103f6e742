//! Published numbers, each with its source.
//!
//! Jackson, Huddy, Baldoni, Boyes, "The mysterious spinning cylinder", Am. J. Phys. 87, 85 (2019) [J]; the
//! rolling thresholds are the library's own and checked against the independent model.

use spincyl::stability::{self, at_rest, boundaries};
use spincyl::{Body, Contact, State, steady};
use std::f64::consts::FRAC_PI_2;

fn solid(ell: f64) -> Body {
    Body::solid(ell).unwrap()
}

/// theta(rate) of solid cylinders from [J, Eq. 15], to the last of the given digits.
#[test]
fn a_fast_cylinder_leans_towards_its_limit() {
    let table = [
        (2.5, 1.1, 83.72905),
        (2.5, 1.5, 72.37822),
        (2.5, 2.0, 67.47241),
        (2.5, 3.0, 64.24833),
        (1.5, 1.5, 63.35162),
        (1.5, 3.0, 55.17903),
        (1.0, 1.5, 53.88356),
        (1.0, 3.0, 50.07451),
    ];
    for (ell, rate, degrees) in table {
        let found = steady::inclinations(&solid(ell), rate)[1].to_degrees();
        assert!((found - degrees).abs() <= 0.5e-5, "ell = {ell}, rate = {rate}: {found}");
    }
}

/// [J, Appendix]: on a smooth table a disk on edge is stable above sqrt(3 (sqrt(13) - 3)/8) only.
#[test]
fn a_disk_on_edge_needs_half_a_radius_of_thickness_on_a_smooth_table() {
    let threshold = (3.0 * (13f64.sqrt() - 3.0) / 8.0).sqrt();
    assert!((threshold - 0.4765).abs() < 5e-5);
    let near = |ell: f64| at_rest(&solid(ell), FRAC_PI_2 - 1e-7, Contact::Smooth);
    assert!(near(threshold + 1e-6) > 0.0 && near(threshold - 1e-6) < 0.0);
    // rolling needs no thickness: a coin on edge is stable
    for ell in [1e-6, 0.1, 0.3] {
        assert!(at_rest(&solid(ell), FRAC_PI_2, Contact::Rolling) > 0.0);
    }
}

/// [J, Appendix]: two stable regions for sqrt(3)/2 < ell < 0.946499020, where they part at theta = 1.130160.
#[test]
fn two_stable_regions_merge_at_their_tip() {
    let tip = 0.946499020;
    let below = boundaries(&solid(tip - 1e-8), Contact::Smooth);
    let above = boundaries(&solid(tip + 2e-8), Contact::Smooth);
    assert!(below[..3].iter().all(|x| !x.is_nan()) && below[3].is_nan(), "{below:?}");
    assert!(above[1].is_nan(), "{above:?}");
    assert!((0.5 * (below[1] + below[2]) - 1.130160).abs() < 1e-6);
}

/// [J]: at ell = sqrt(3)/2 every rate is steady at theta0; stable on a smooth table above (7/4)^(1/4). Rolling,
/// the threshold is (7/81)^(1/4).
#[test]
fn the_critical_cylinder_is_steady_at_any_rate_and_stable_above_a_threshold() {
    let body = solid(0.75f64.sqrt());
    let theta = body.theta_balance();
    let spinning = |rate: f64| {
        let w1 = rate / body.i3().sqrt() * theta.sin();
        State { theta, w1, w2: 0.0, w3: body.ell() * w1 }
    };
    for rate in [0.1, 1.0, 10.0] {
        assert!(spincyl::rolling::derivative(&body, &spinning(rate)).w2.abs() < 1e-14 * (1.0 + rate * rate));
    }
    let (smooth, rolling) = ((7f64 / 4.0).powf(0.25), (7f64 / 81.0).powf(0.25));
    for sign in [-1.0, 1.0] {
        let kappa = stability::smooth(&body, &spinning(smooth * (1.0 + sign * 1e-9)));
        assert!(kappa * sign > 0.0 && kappa.abs() < 1e-7);
        let kappa = stability::rolling(&body, &spinning(rolling * (1.0 + sign * 1e-9)));
        assert!(kappa * sign > 0.0 && kappa.abs() < 1e-7);
    }
}

/// [J, Appendix]: the energy ridge of the cylinder with ell = 2.5 lies at theta = 0.2512.
#[test]
fn a_tall_cylinder_has_its_energy_ridge_at_a_quarter_radian() {
    let ridge = steady::ridge(&solid(2.5));
    assert!((ridge[0] - 0.251184).abs() < 5e-7 && ridge[1].is_nan(), "{ridge:?}");
}

/// [J, Fig. 1]: the PVC tube shows six still symbols a turn when it lies nearly flat.
#[test]
fn the_pvc_tube_shows_six_letters() {
    let tube = Body::from_metres(15.875e-3, 0.8 * 15.875e-3, 95.25e-3, 0.0).unwrap();
    let y = steady::state(&tube, FRAC_PI_2).unwrap();
    assert!((y.contact_radius() - 6.0).abs() < 1e-12);
}

/// About an eighth of the steady states of solid cylinders up to ell = 3 are unstable on a smooth table and stable
/// when rolling; none the other way.
#[test]
fn the_two_criteria_disagree_on_an_eighth_of_the_map() {
    let (mut steady, mut disagree) = (0, 0);
    for i in 1..400 {
        for j in 1..200 {
            match stability::region(&solid(f64::from(i) * 0.0075), f64::from(j) / 200.0 * FRAC_PI_2) as u8 {
                5 => (steady, disagree) = (steady + 1, disagree + 1),
                6 => panic!("smooth but not rolling"),
                4 | 7 => steady += 1,
                _ => {}
            }
        }
    }
    let share = f64::from(disagree) / f64::from(steady);
    assert!((share - 0.125).abs() < 0.01, "{share}");
}

#[test]
fn an_upright_coin_rolls_stably_above_a_third_and_slides_stably_above_one() {
    // the textbook result for a thin disk, v^2 > g R/3: w3^2 > I1/(I3 (I3 + 1)); as a top, without friction,
    // I1/I3^2
    let coin = solid(0.0);
    let upright = |w3| State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3 };
    for (law, threshold) in [
        (stability::rolling as fn(&Body, &State) -> f64, 1.0 / 3.0),
        (stability::smooth as fn(&Body, &State) -> f64, 1.0),
    ] {
        for w3_squared in [0.5 * threshold, threshold - 1e-9, threshold + 1e-9, 2.0 * threshold] {
            let kappa = law(&coin, &upright(f64::sqrt(w3_squared)));
            assert_eq!(kappa > 0.0, w3_squared > threshold, "{w3_squared} {kappa}");
        }
    }
}
