//! Drifts with the centre at rest: the thin disk's table of powers, energies, ends, and errors.

use super::{apart, disk, drift, laws_of};
use crate::common::loss_power::{LossRates, loss_power};
use spincyl::drift::{Drift, End};
use spincyl::loss::{Law, Losses};
use spincyl::{Body, rolling, steady};

/// The moment of inertia of the thin disk about a diameter, in M R^2.
const I1: f64 = 0.25;

/// Integral of `f` from 0 to x by Simpson's rule in v = theta^(1/4), in which all these integrands are
/// analytic.
fn simpson(f: impl Fn(f64) -> f64, x: f64) -> f64 {
    let (n, top) = (4000, x.powf(0.25));
    let g = |i: u32| {
        let v = top * f64::from(i) / f64::from(n);
        if i == 0 { 0.0 } else { 4.0 * v.powi(3) * f(v.powi(4)) }
    };
    let sum: f64 = (1..n).map(|i| g(i) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
    (g(0) + sum + g(n)) * top / f64::from(n) / 3.0
}

/// The power that a law with coefficient 1 takes from a thin disk with Omega^2 = 1/(I1 sin theta), by the
/// table of the laws.
fn power(law: Law, theta: f64) -> f64 {
    let (s, c) = theta.sin_cos();
    let rate = 1.0 / (I1 * s).sqrt();
    let (spin, turn) = (c * rate, rate * s);
    let (rolling, drilling) = (s * spin, s * turn);
    let at = LossRates { weight: 1.0, spin, rolling, drilling, whole: turn, sine: s, radius: 1.0 };
    loss_power(law, &at)
}

#[test]
fn a_thin_disk_stops_when_the_table_says_for_every_law() {
    for &law in Law::ALL {
        for theta in [1e-3, 0.1, 0.3, 0.7] {
            let k = 3e-3;
            let taken = Losses::of(law, k).power(&disk(), &steady::state(&disk(), theta).unwrap(), 1.0);
            assert!(apart(taken, k * power(law, theta)) < 1e-13, "{law:?} {theta}: {taken}");
            let found = drift(&disk(), theta, Losses::of(law, k));
            assert_eq!(found.ended(), End::Face);
            assert_eq!(found.ends_at_theta(), 0.0);
            if law.exponent().is_none() {
                assert_eq!(found.stops_at(), f64::INFINITY, "{law:?}");
                continue;
            }
            let exact = simpson(|x| 1.5 * x.cos() / (k * power(law, x)), theta);
            assert!(apart(found.stops_at(), exact) < 2e-12, "{law:?} {theta}: {} {exact}", found.stops_at());
        }
    }
}

#[test]
fn a_thin_disk_has_its_closed_forms_at_any_time() {
    let (k, start) = (2e-3, 0.6f64);
    let whole = drift(&disk(), start, Losses::of(Law::ViscousContour, k));
    for share in [0.0, 1e-9, 0.1, 0.5, 0.9, 0.999] {
        let t = whole.stops_at() * share;
        // cos theta = exp(-2 c tau/(3 I1))
        let tau = whole.stops_at() - t;
        let theta = (-2.0 * k * tau / (3.0 * I1)).exp().acos();
        assert!(apart(whole.theta(t), theta) < 1e-11, "{share}");
        assert!(apart(whole.precession(t), 1.0 / (I1 * whole.theta(t).sin()).sqrt()) < 1e-14);
    }
    // sin^(-1/2) theta grows by mu t/(3 sqrt I1)
    let drilling = drift(&disk(), start, Losses::of(Law::Drilling, k));
    // sin theta = sin theta0 exp(-2 b t/(3 I1))
    let air = drift(&disk(), start, Losses::of(Law::AirLinear, k));
    for t in [0.0, 1e-6, 1.0, 300.0, 1e5, 1e30] {
        let root = start.sin().powf(-0.5) + k * t / (3.0 * I1.sqrt());
        assert!(apart(drilling.theta(t).sin(), root.powi(-2)) < 1e-12, "{t}: {}", drilling.theta(t));
        let fallen = start.sin() * (-2.0 * k * t / (3.0 * I1)).exp();
        if fallen > 1e-300 {
            assert!(apart(air.theta(t).sin(), fallen) < 1e-11, "{t}: {} {fallen}", air.theta(t));
        }
    }
}

#[test]
fn halving_a_coefficient_doubles_every_time() {
    for (body, theta) in [(disk(), 0.4), (Body::solid(0.3).unwrap(), 0.2), (Body::solid(2.5).unwrap(), 1.2)] {
        for &law in Law::ALL {
            let [whole, half] = [1e-3, 5e-4].map(|k| drift(&body, theta, Losses::of(law, k)));
            assert_eq!(whole.stops_at() * 2.0, half.stops_at(), "{law:?}");
            let between = 0.5 * (theta + whole.ends_at_theta());
            assert_eq!(whole.time(between) * 2.0, half.time(between));
        }
    }
}

#[test]
fn laws_together_add_their_rates_at_equal_inclination() {
    let body = Body::solid(0.4).unwrap();
    for (a, b) in [(0, 6), (1, 3), (2, 4), (5, 7), (0, 2)] {
        let (one, other) = (Losses::of(Law::ALL[a], 3e-3), Losses::of(Law::ALL[b], 7e-3));
        let drifts = [one, other, one + other].map(|x| drift(&body, 0.3, x));
        // the mean rate over a short interval
        let speed = |d: &Drift| 1.0 / (d.time(0.2) - d.time(0.2001));
        let [x, y, both] = [speed(&drifts[0]), speed(&drifts[1]), speed(&drifts[2])];
        assert!(apart(x + y, both) < 1e-6, "{a} {b}");
    }
}

#[test]
fn laws_together_add_their_rates_as_far_as_a_balance_that_is_never_reached() {
    let slow =
        [Law::DryContour, Law::ViscousContour, Law::RollingResistance, Law::AirQuadratic, Law::AirFilm];
    for fillet in [0.0, 0.0355] {
        let body = Body::rounded_tube(3.8448, 0.5, fillet).unwrap();
        let start = 0.95 * body.theta_balance();
        let goal = drift(&body, start, Losses::of(Law::AirFilm, 1e-5)).ends_at_theta();
        for (a, b) in [(0, 1), (0, 4), (1, 2), (1, 4), (2, 4), (3, 4)] {
            let (one, other) = (Losses::of(slow[a], 1.6e-4), Losses::of(slow[b], 1.3e-5));
            let drifts = [one, other, one + other].map(|x| drift(&body, start, x));
            for left in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7] {
                let near = [goal - left, goal - 0.99 * left];
                let speed = |d: &Drift| 1.0 / (d.time(near[1]) - d.time(near[0]));
                let [x, y, both] = [speed(&drifts[0]), speed(&drifts[1]), speed(&drifts[2])];
                assert!(apart(x + y, both) < 1e-4, "{a} {b} {left}: {}", apart(x + y, both));
                for d in &drifts {
                    let theta = d.theta(d.time(near[0]));
                    assert!((theta - near[0]).abs() < 1e-9 * left + 1e-16, "{a} {b} {left}: {theta}");
                }
            }
        }
    }
}

#[test]
fn a_coefficient_that_is_next_to_nothing_slows_the_clock_and_nothing_else() {
    let tall = Body::tube(3.8448, 0.5).unwrap();
    for (body, theta) in [(tall, 0.24), (Body::solid(2.5).unwrap(), 1.2), (Body::solid(0.3).unwrap(), 0.2)] {
        for &law in Law::ALL {
            let usual = drift(&body, theta, Losses::of(law, 1e-4));
            for k in [1e-250, 1e-290, 1e-300] {
                let slow = drift(&body, theta, Losses::of(law, k));
                for share in [0.9, 0.5, 0.3, 0.1, 0.01] {
                    let at = usual.ends_at_theta() + share * (theta - usual.ends_at_theta());
                    let (t, long) = (usual.time(at), slow.time(at));
                    let expected = t * (1e-4 / 1e-150) * (1e-150 / k);
                    let beyond = long == f64::INFINITY && expected > 1e304;
                    assert!(beyond || apart(long, expected) < 1e-13, "{law:?} {k:e} {share}: {long:e}");
                    assert!(!long.is_finite() || apart(slow.theta(long), at) < 1e-9, "{law:?} {k:e} {share}");
                }
            }
        }
    }
}

#[test]
fn a_tall_body_near_flat_takes_two_thirds_of_its_slope_longer() {
    for ell in [0.1, 0.5, 2.0] {
        let body = Body::solid(ell).unwrap();
        let slope = 1.5 + body.i3() * ell * ell / (2.0 * body.i1());
        let i1 = body.i1();
        for (law, time) in [
            (Law::DryContour, i1.sqrt() * 1e-6f64.powf(1.5)),
            (Law::ViscousContour, 0.75 * i1 * 1e-12),
            (Law::RollingResistance, 3.0 * (i1 * 1e-6).sqrt()),
            (Law::AirFilm, 2.0 * i1 * 1e-18 / core::f64::consts::PI),
            (Law::BoundaryLayer, 2.0 * i1.powf(1.25) * 1e-6f64.powf(2.25) / 3.0),
        ] {
            let found = drift(&body, 1e-6, Losses::of(law, 1e-2)).stops_at();
            let expected = 1e2 * time * slope / 1.5;
            assert!(apart(found, expected) < 1e-4, "{law:?} {ell}: {found} {expected}");
        }
        let drilling = drift(&body, 1e-6, Losses::of(Law::Drilling, 1e-2)).stops_at();
        assert!(apart(drilling, 2.0 * slope * (i1 * 1e-6).sqrt() / (1e-2 * ell)) < 1e-4);
    }
}

#[test]
fn energy_falls_by_the_power_at_every_inclination() {
    // sharp and rounded bodies on all branches: E(theta(t)) by central differences of an independent energy
    let bodies = [
        (Body::solid(0.3).unwrap(), 0.2),
        (Body::solid(2.5).unwrap(), 0.2),
        (Body::solid(2.5).unwrap(), 0.3),
        (Body::solid(2.5).unwrap(), 1.2),
        (Body::rounded_tube(0.2, 0.0, 0.1).unwrap(), 0.25),
        (Body::rounded_tube(2.0, 0.3, 0.4).unwrap(), 1.3),
        (Body::rounded(0.0, 0.7, 1.2, 0.4).unwrap(), 0.3),
        (Body::rounded(0.0, 0.7, 1.2, 0.4).unwrap(), 2.9),
        (Body::balls(1.0).unwrap(), 1.3),
        (Body::ball(-0.3, 0.4, 0.38).unwrap(), 1.0),
    ];
    for (body, theta) in bodies {
        for law in laws_of(&body) {
            let losses = Losses::of(law, 1e-3);
            let d = drift(&body, theta, losses);
            let span = if d.stops_at().is_finite() { d.stops_at() } else { 100.0 };
            for share in [0.1, 0.4] {
                let t = span * share;
                let y = d.state(t).unwrap();
                let lost = losses.power(&body, &y, 1.0);
                let energy = |t: f64| rolling::energy(&body, &d.state(t).unwrap());
                let h = 1e-4 * span;
                let fall = (energy(t - h) - energy(t + h)) / (2.0 * h);
                assert!((fall - lost).abs() < 1e-5 * lost, "{body:?} {theta} {law:?}: {fall} {lost}");
                assert!(apart(d.time(y.theta), t) < 1e-9, "{body:?} {law:?}: {} {t}", d.time(y.theta));
                let there = steady::state(&body, y.theta).unwrap();
                assert!(apart(there.w1, y.w1) < 1e-9 && (there.w3 - y.w3).abs() < 1e-9 * y.w1.abs());
            }
        }
    }
}

#[test]
fn every_end_has_its_name_and_its_place() {
    let dry = Losses::of(Law::DryContour, 1e-3);
    let drilling = Losses::of(Law::Drilling, 1e-3);
    let tall = Body::solid(2.5).unwrap();
    let ridge = steady::ridge(&tall)[0];
    let below = drift(&tall, ridge - 1e-6, dry);
    let above = drift(&tall, ridge + 1e-6, dry);
    assert_eq!((below.ended(), above.ended()), (End::Face, End::Balanced));
    assert_eq!(above.ends_at_theta(), tall.theta_balance());
    assert_eq!(above.stops_at(), f64::INFINITY);
    assert!(drift(&tall, 0.3, drilling).stops_at().is_finite());
    assert_eq!(drift(&tall, 1.2, dry).ended(), End::Side);
    assert_eq!(drift(&tall, 1.2, dry).ends_at_theta(), core::f64::consts::FRAC_PI_2);
    let short = tall.with_theta_end(1.4).unwrap();
    assert_eq!(drift(&short, 1.2, dry).ends_at_theta(), 1.4);
    // a minimum of the energy along the branch
    let odd = Body::solid(0.875).unwrap();
    let lowest = steady::ridge(&odd).into_iter().filter(|x| x.is_finite()).collect::<Vec<_>>();
    let found = lowest.iter().map(|x| drift(&odd, x + 1e-3, dry)).find(|d| d.ended() == End::Lowest);
    let found = found.expect("a body between 0.866 and 0.8825 has a lowest state");
    assert!(found.stops_at().is_finite() && lowest.contains(&found.ends_at_theta()));
    assert!((found.theta(found.stops_at()) - found.ends_at_theta()).abs() < 1e-15);
    assert_eq!(drift(&Body::ball(-0.3, 0.4, 0.38).unwrap(), 1.0, dry).ended(), End::Upright);
}

#[test]
fn who_begins_at_the_limit_has_been_on_the_way_for_ever_if_little_is_lost() {
    for body in [Body::solid(0.3).unwrap(), Body::solid(2.5).unwrap()] {
        let limit = body.theta_limit();
        let side = if body.excess() > 0.0 { 1.0 } else { -1.0 };
        for (law, power) in [(Law::DryContour, -0.5), (Law::AirLinear, 0.0), (Law::AirQuadratic, 0.5)] {
            // the time from a distance x of the limit to 0.05 goes as x^(j/2 - 1), where the power goes as
            // Omega^j
            let at = |x: f64| drift(&body, limit + side * x, Losses::of(law, 1e-3)).time(limit + side * 0.05);
            let [a, b, c] = [at(1e-6), at(1e-8), at(1e-10)];
            let ratio = (c - b) / (b - a);
            assert!(apart(ratio, 100f64.powf(-power)) < 2e-3, "{law:?}: {ratio}");
        }
    }
}

#[test]
fn what_makes_no_drift_is_refused_by_name() {
    let body = Body::solid(2.5).unwrap();
    let refused = |theta: f64, losses: Losses| Drift::at_rest(&body, theta, &losses).unwrap_err().to_string();
    assert!(refused(0.2, Losses::NONE).contains("at least one law"));
    assert!(refused(0.2, Losses::of(Law::DryContour, -1.0)).starts_with("eps = -1.0"));
    assert!(refused(0.2, Losses::of(Law::AirFilm, f64::NAN)).starts_with("viscosity = NaN"));
    assert!(refused(0.5, Losses::of(Law::DryContour, 1e-3)).contains("forbidden"));
    assert!(refused(2.0, Losses::of(Law::DryContour, 1e-3)).starts_with("theta = 2.0"));
}

#[test]
fn a_drift_answers_nothing_where_it_does_not_pass() {
    let d = drift(&disk(), 0.3, Losses::of(Law::DryContour, 1e-3));
    for theta in [0.31, -0.1, f64::NAN, f64::INFINITY] {
        assert!(d.time(theta).is_nan());
    }
    for t in [-1.0, f64::NAN, f64::INFINITY, d.stops_at() * 1.001] {
        assert!(d.theta(t).is_nan() && d.precession(t).is_nan() && d.state(t).is_none());
    }
    assert_eq!((d.time(0.3), d.time(0.0)), (0.0, d.stops_at()));
    assert_eq!((d.theta(0.0), d.theta(d.stops_at())), (0.3, 0.0));
}
