//! The hard cases N1 to N13 of docs/hard-cases.md that a Rust test can decide; the references of steady.csv come
//! from tests/reference/generate.py (mpmath, 60 digits, independent formulas).

use crate::common::hex;
use crate::common::rim::ULP;
use spincyl::stability::{Region, at_rest, region};
use spincyl::{Body, Contact, Error, steady};
use std::f64::consts::FRAC_PI_2;

struct Reference {
    row: String,
    theta: f64,
    body: Body,
    /// The reference rate with 106 bits, as a sum of two doubles.
    rate: [f64; 2],
    kappa_c: f64,
    kappa: [(Contact, f64); 2],
}

fn references() -> Vec<Reference> {
    let lines = include_str!("../reference/steady.csv").lines().skip(1);
    lines
        .map(|line| {
            let (row, numbers) = line.split_once(',').unwrap();
            let x: Vec<f64> = numbers.split(',').map(hex).collect();
            Reference {
                row: row.to_string(),
                theta: x[0],
                body: Body::tube(x[1], x[2]).unwrap(),
                rate: [x[3], x[4]],
                kappa_c: x[5],
                kappa: [(Contact::Rolling, x[6]), (Contact::Smooth, x[7])],
            }
        })
        .collect()
}

#[test]
fn n1_n2_n4_n7_the_rate_is_right_to_two_ulp_and_its_conditioning() {
    let (mut sum, mut count, mut worst) = (0.0, 0.0, 0f64);
    for r in references() {
        let got = steady::rate(&r.body, r.theta);
        let error = (((got - r.rate[0]) - r.rate[1]) / r.rate[0]).abs() / ULP;
        assert!(
            error <= 2.0 * (1.0 + r.kappa_c),
            "{}: theta {:?}, ell {:?}: {error}",
            r.row,
            r.theta,
            r.body.ell()
        );
        assert!(!matches!(&*r.row, "N1" | "N4" | "N7") || error <= 4.0, "{}: {error} ulp", r.row);
        if r.kappa_c < 3.0 {
            (sum, count, worst) = (sum + error, count + 1.0, worst.max(error));
        }
    }
    // in well-conditioned states only the roundings of m, of the square and of its root remain
    assert!(worst < 1.8 && sum / count < 0.45, "worst {worst}, mean {}", sum / count);
}

#[test]
fn kappa_is_right_to_16_ulp_of_its_terms_and_their_conditioning() {
    for r in references() {
        let (s, c) = r.theta.sin_cos();
        let (ell, a) = (r.body.ell(), r.body.i1() / r.body.i3());
        let (n, m) = (c - ell * s, a * c - ell * s);
        let condition = 1.0 + c / n.abs() + (a * c + ell * s) / m.abs();
        for (contact, kappa) in r.kappa {
            let inertia = match contact {
                Contact::Rolling => r.body.i1() + 1.0 + ell * ell,
                _ => r.body.i1() + n * n,
            };
            let largest = kappa.abs().max((ell * c + s) / inertia);
            let error = (at_rest(&r.body, r.theta, contact) - kappa).abs() / (largest * ULP * condition);
            assert!(kappa.is_nan() || error <= 16.0, "{} {contact:?} at {:?}: {error}", r.row, r.theta);
        }
    }
}

#[test]
fn n3_at_the_critical_point_the_rate_is_one_over_the_root_of_the_sine_or_undetermined() {
    let body = Body::new(0.75f64.sqrt(), 0.5, 0.5).unwrap();
    let theta0 = body.theta_balance();
    assert_eq!(body.theta_limit(), theta0);
    for theta in [theta0.next_down(), theta0, theta0.next_up()] {
        let rate = steady::rate(&body, theta);
        let flagged = region(&body, theta) == Region::Undetermined;
        assert!(if flagged { rate.is_nan() } else { (rate * theta.sin().sqrt() - 1.0).abs() < 4.0 * ULP });
    }
    // so close to n = 0 that a sine and a cosine of 54 bits would not decide
    let near = Body::new(1.0, 1.0, 1.0).unwrap();
    let sides = [std::f64::consts::FRAC_PI_4.next_down(), std::f64::consts::FRAC_PI_4];
    assert!(sides.iter().all(|x| region(&near, *x) != Region::Forbidden));
}

#[test]
fn n5_an_aspect_ratio_whose_square_overflows_is_refused_with_its_range() {
    for ell in [1e160, 1e300, f64::INFINITY] {
        let e = Body::solid(ell).unwrap_err();
        assert!(matches!(e, Error::OutOfRange { name: "ell", .. }) && e.to_string().contains("1e150"), "{e}");
    }
    let needle = Body::solid(1e150).unwrap();
    assert!(steady::rate(&needle, 1e-160).is_finite() && steady::rate(&needle, 1.0).is_nan());
}

#[test]
fn n6_four_ulp_inside_the_forbidden_band_there_is_no_number() {
    for k in -80..=80 {
        let body = Body::solid(10f64.powf(f64::from(k) / 10.0)).unwrap();
        let (low, high) =
            (body.theta_balance().min(body.theta_limit()), body.theta_balance().max(body.theta_limit()));
        // the edges are rounded, too; six doubles further inside the band is certain
        let (mut inside_low, mut inside_high) = (low, high);
        for _ in 0..6 {
            (inside_low, inside_high) = (inside_low.next_up(), inside_high.next_down());
        }
        if inside_low > inside_high {
            continue;
        }
        for theta in [inside_low, inside_high, 0.5 * (low + high)] {
            assert!(steady::rate(&body, theta).is_nan());
            assert_eq!(region(&body, theta), Region::Forbidden, "ell = {}, theta = {theta:?}", body.ell());
            assert!(matches!(steady::state(&body, theta), Err(Error::Forbidden { .. })));
            assert!(
                at_rest(&body, theta, Contact::Smooth).is_nan()
                    && at_rest(&body, theta, Contact::Rolling).is_nan()
            );
        }
    }
}

#[test]
fn n7_a_right_angle_is_a_steady_state_and_the_next_double_is_no_question() {
    let body = Body::solid(2.5).unwrap();
    assert_eq!(region(&body, FRAC_PI_2), Region::Stable);
    for theta in [FRAC_PI_2.next_up(), 0.0, -0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(steady::rate(&body, theta).is_nan() && at_rest(&body, theta, Contact::Rolling).is_nan());
        assert_eq!(region(&body, theta), Region::Invalid);
        assert!(matches!(steady::state(&body, theta), Err(Error::OutOfRange { name: "theta", .. })));
        assert!(matches!(steady::circular(&body, theta, 1.0), Err(Error::OutOfRange { name: "theta", .. })));
    }
    for precession in [0.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            steady::circular(&body, 1.0, precession),
            Err(Error::OutOfRange { name: "precession", .. })
        ));
    }
}

#[test]
fn n9_two_states_meet_at_a_fold_and_vanish() {
    let body = Body::solid(0.25).unwrap();
    let fold = 1.9068080414492224;
    let folds = steady::folds(&body);
    assert!((folds[0] - 0.778057100154286).abs() < 1e-14 && folds[1].is_nan(), "{folds:?}");
    let two = steady::inclinations(&body, fold * (1.0 + 1e-12));
    assert!((two[1] - two[0] - 1.58e-6).abs() < 1e-8 && two[2].is_nan(), "{two:?}");
    assert_eq!(steady::count(&body, fold * (1.0 - 1e-12)), Some(0));
}

#[test]
fn n10_three_states_of_one_rate() {
    let body = Body::solid(0.8).unwrap();
    let three = steady::inclinations(&body, 0.9995);
    for (found, expected) in three.iter().zip([1.12132566, 1.29800591, 1.55932823]) {
        assert!((found - expected).abs() < 5e-9, "{three:?}");
    }
    // at rate 1 the third state lies on its side, which is not counted
    assert_eq!(steady::count(&body, 1.0), Some(2));
    assert_eq!(steady::count(&body, 1f64.next_down()), Some(3));
    assert_eq!(steady::count(&body, 1f64.next_up()), Some(2));
}

#[test]
fn an_inverse_that_makes_no_sense_has_no_count() {
    let body = Body::solid(0.8).unwrap();
    for rate in [-1.0, f64::NAN, f64::INFINITY, 1e160] {
        assert_eq!(steady::count(&body, rate), None);
        assert!(steady::inclinations(&body, rate).iter().all(|x| x.is_nan()));
    }
    assert!(
        (steady::inclinations(&body, 0.0)[0] - body.theta_balance()).abs() <= 4.0 * ULP,
        "at rest: balanced"
    );
    assert_eq!(steady::count(&Body::solid(0.0).unwrap(), 0.0), Some(0), "a thin disk at rest lies or stands");
    // extreme bodies and rates
    for (ell, rate) in [(1e150, 0.5), (1e-8, 1e100), (1e8, 1e-8), (3.0, 1e140), (1e-300, 2.0)] {
        let body = Body::solid(ell).unwrap();
        let count = steady::count(&body, rate).unwrap();
        assert!(count >= 1 || ell < 1e-100, "ell = {ell}, rate = {rate}");
        for theta in &steady::inclinations(&body, rate)[..count] {
            assert!(*theta > 0.0 && *theta <= FRAC_PI_2, "{theta}");
            let back = steady::rate(&body, *theta);
            let at_limit = (*theta - body.theta_limit()).abs() <= 2.0 * ULP;
            assert!(
                (back / rate - 1.0).abs() < 1e-6 || *theta > 1.5 || at_limit,
                "ell = {ell}: {back} for {rate}"
            );
        }
    }
    let needle = Body::solid(1e40).unwrap();
    assert!(steady::folds(&needle)[0].is_nan() && steady::ridge(&needle)[0].is_nan());
}

#[test]
fn a_fold_at_45_degrees_is_found_once() {
    // d = -(1 - ell)^2/(1 + ell) puts the fold there; rounding moves it by a few last bits
    let mut checked = 0;
    for k in 1..400 {
        let ell = 0.1 + 0.002 * f64::from(k);
        let i1 = 1.0 - (1.0 - ell).powi(2) / (1.0 + ell);
        if i1 < 0.501 || (ell - 1.0).abs() < 1e-2 {
            continue;
        }
        for shift in -3..=3 {
            let body = Body::new(ell, f64::from_bits(i1.to_bits().wrapping_add_signed(shift)), 1.0).unwrap();
            let near = steady::folds(&body)
                .iter()
                .filter(|x| (**x - std::f64::consts::FRAC_PI_4).abs() < 1e-9)
                .count();
            assert_eq!(near, 1, "ell = {ell}: {:?}", steady::folds(&body));
            checked += 1;
        }
    }
    assert!(checked > 2000);
}

#[test]
fn a_body_of_equal_moments_has_no_fold_one_ridge_and_one_change_of_stability() {
    for ell in [0.3f64, 0.75f64.sqrt(), 1.0, 1.7] {
        let body = Body::new(ell, 0.7, 0.7).unwrap();
        assert!(steady::folds(&body).iter().all(|x| x.is_nan()));
        let ridge = steady::ridge(&body);
        assert!((ridge[0] - (3.0 + ell * ell).atan2(2.0 * ell)).abs() < 4.0 * ULP && ridge[1].is_nan());
        let smooth = spincyl::stability::boundaries(&body, Contact::Smooth);
        assert!((smooth[0] - body.theta_balance()).abs() < 4.0 * ULP, "{smooth:?}");
        assert!((smooth[1] - 3f64.atan2(ell)).abs() < 4.0 * ULP && smooth[2].is_nan());
    }
}

/// Roots of the cubics by mpmath's polyroots, 50 digits, on the exact doubles.
#[test]
fn near_the_critical_shape_folds_and_ridges_keep_their_digits() {
    let near = |found: [f64; steady::MOST], exact: &[f64]| {
        let all = found.iter().filter(|x| !x.is_nan());
        assert_eq!(all.clone().count(), exact.len(), "{found:?}");
        assert!(all.zip(exact).all(|(x, e)| (x - e).abs() <= 4.0 * ULP * e), "{found:?} is not {exact:?}");
    };
    let body = Body::tube(1.1215599064108825, 0.8229188892135899).unwrap();
    near(steady::folds(&body), &[0.728163284219741_2, 0.728163363312902_2, 1.570796326794893_5]);
    let body = Body::tube(0.8948662539821997, 0.26021942667969467).unwrap();
    near(steady::ridge(&body), &[0.840824768082457_9, 0.840824831716562_1, 1.130710902984333_4]);
}

#[test]
fn an_overflow_is_no_answer() {
    let body = Body::new(1e100, 1.0, 1.5).unwrap();
    assert_eq!(steady::count(&body, 1e110), None);
    for ell in [1e100, 1e150] {
        let body = Body::solid(ell).unwrap();
        for contact in [Contact::Smooth, Contact::Rolling] {
            let kappa = at_rest(&body, 1e-310, contact);
            assert!(kappa.is_finite() && kappa > 0.0, "{contact:?}: {kappa}");
        }
    }
    // w1^2 and 1/sin^2 each leave the range of doubles long before kappa does
    let body = Body::solid(1e20).unwrap();
    let y = steady::state(&body, 1e-160).unwrap();
    let (state, rest) = (spincyl::stability::rolling(&body, &y), at_rest(&body, 1e-160, Contact::Rolling));
    assert!(state.is_nan() || (state / rest - 1.0).abs() < 1e-12, "{state} {rest}");
    assert!(matches!(
        steady::circular(&Body::solid(1e150).unwrap(), 1.0, 1e100),
        Err(Error::OutOfRange { name: "w3", .. })
    ));
}

#[test]
fn n13_a_wall_of_a_millionth_of_a_millionth_is_a_thin_tube() {
    for ell in [0.3, 2.5, 6.0] {
        let (thin, limit) = (Body::tube(ell, 1.0 - 1e-12).unwrap(), Body::tube(ell, 1.0).unwrap());
        let near = |a: f64, b: f64| (a - b).abs() <= 4e-12 * b.abs();
        assert!(near(thin.i1(), limit.i1()) && near(thin.i3(), limit.i3()));
        assert!(near(thin.theta_limit(), limit.theta_limit()));
        assert!(near(steady::rate(&thin, 1.4), steady::rate(&limit, 1.4)));
    }
    assert!(matches!(Body::new(1.0, 0.2, 0.41), Err(Error::Moments { .. })));
}
