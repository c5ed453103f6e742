//! Next to a fold the rate is stationary, and m = n + d A cos may be a small difference: the rate keeps its
//! digits there.

use crate::ULP;
use crate::common::number;
use spincyl::{Body, steady, sweep};
use std::f64::consts::PI;

/// A row of tests/reference/folds.py: body, inclination, rate as a sum of two doubles, kappa_c, and n over m.
struct Row {
    body: Body,
    theta: f64,
    rate: [f64; 2],
    condition: f64,
    lost: f64,
}

fn rows() -> Vec<Row> {
    let row = |line: &str| {
        let all: Vec<f64> = line.split(',').map(number).collect();
        let [ell, i1, i3, fillet, theta, rate, rest, condition, lost] = all[..] else {
            panic!("nine numbers")
        };
        let body = Body::rounded(ell, i1, i3, fillet).unwrap();
        let body = if fillet > 0.0 { body.with_theta_end(PI).unwrap() } else { body };
        Row { body, theta, rate: [rate, rest], condition, lost }
    };
    include_str!("../reference/folds.csv").lines().skip(1).map(row).collect()
}

#[test]
fn the_rate_keeps_its_digits_beside_folds_of_rounded_and_of_sharp_rims() {
    let rows = rows();
    for Row { body, theta, rate: [rate, rest], condition, lost } in &rows {
        let found = steady::rate(body, *theta);
        let off = ((found - rate) - rest).abs() / rate;
        let allowed = 2.0 * (1.0 + condition) * ULP + lost * 2f64.powi(-100);
        assert!(off <= allowed, "{body:?} {theta}: {off:e}, {condition:e}, n/m {lost}");
    }
    let hard = rows.iter().filter(|row| row.lost > 40.0 && row.condition < 1e-3).count();
    let sharp = rows.iter().filter(|row| row.body.fillet() == 0.0).count();
    assert!(rows.len() == 150 && hard > 50 && sharp == 36, "{} {hard} {sharp}", rows.len());
}

#[test]
fn maps_beside_folds_have_the_rates_of_single_states_in_both_precisions() {
    let rows = rows();
    let bodies: Vec<Option<Body>> = rows.iter().step_by(3).map(|row| Some(row.body)).collect();
    let theta: Vec<f64> = rows.iter().map(|row| row.theta).collect();
    let (mut double, mut single) = (vec![7f64; 150 * 50], vec![7f32; 150 * 50]);
    let out = sweep::Portrait::default().with_rate(&mut double[..]);
    assert!(sweep::portrait(&theta, &bodies, out, 1, |_| true).unwrap());
    let out = sweep::Portrait::default().with_rate(&mut single[..]);
    assert!(sweep::portrait(&theta, &bodies, out, 2, |_| true).unwrap());
    let mut known = 0;
    for (i, (double, single)) in double.iter().zip(single).enumerate() {
        let body = bodies[i % 50].unwrap();
        let rate = steady::rate(&body, theta[i / 50]);
        assert!(
            rate.to_bits() == double.to_bits() || rate.is_nan() && double.is_nan(),
            "{body:?}: {rate} {double}"
        );
        if body.fillet() > 0.0 {
            let rounded = rate as f32;
            assert!(rounded == single || rounded.is_nan() && single.is_nan(), "{body:?}: {rate} {single}");
        }
        known += usize::from(!rate.is_nan());
    }
    assert!(known > 3000, "{known}");
}

#[test]
fn at_a_fold_of_a_sharp_rim_n_is_less_than_four_times_m() {
    // at a fold d ell s = -c n m, and n = c - ell s. With y = n/c, y^2 >= -d below the forbidden band; above
    // it n, m and d c have the same sign. So n/m <= 1/(1 - sqrt(-d)), where -d <= 1/2
    let mut most: f64 = 0.0;
    for k in 0..20_000 {
        let part = |x: f64| (f64::from(k) * x).fract();
        let (ell, share) = (2.0 * part(0.618_033_988_749_894_9), 1.0 + part(0.754_877_666_246_692_7));
        let body = Body::new(ell, 0.6, 0.6 * share).unwrap();
        let d = body.excess();
        for theta in steady::folds(&body).into_iter().filter(|x| !x.is_nan()) {
            let (s, c) = theta.sin_cos();
            let n = c - ell * s;
            let lost = n / (n + d * c);
            assert!(lost > 0.0 && lost <= (1.0 + 1e-9) / (1.0 - (-d).sqrt()), "{body:?} {theta}: {lost}");
            most = most.max(lost);
        }
    }
    assert!(most > 3.0 && most < 3.4143, "{most}");
}
