//! Drifts of a rolling body: its energy, the path that contour laws share, its end.

use super::{disk, drift, laws_of};
use spincyl::drift::{Drift, End};
use spincyl::loss::{Law, Losses};
use spincyl::{Body, State, rolling, stability, steady};

fn roll(body: &Body, y: &State, losses: Losses) -> Drift {
    Drift::rolling(body, y, &losses).unwrap_or_else(|e| panic!("{body:?} {y:?} {losses:?}: {e}"))
}

/// Starts of all kinds that are stable when rolling: disks, tubes, rounded bodies and balls, with the centre
/// at rest or on a circle.
fn starts() -> Vec<(Body, State)> {
    let mut all = Vec::new();
    for (body, theta) in [
        (disk(), 0.4),
        (Body::solid(0.2).unwrap(), 0.1),
        (Body::solid(0.9).unwrap(), 0.2),
        (Body::solid(2.5).unwrap(), 1.2),
        (Body::solid(6.0).unwrap(), 1.4),
        (Body::tube(2.0, 0.9).unwrap(), 0.05),
        (Body::rounded_tube(0.2, 0.0, 0.1).unwrap(), 0.25),
        (Body::rounded_tube(2.0, 0.3, 0.4).unwrap(), 1.3),
        (Body::balls(1.0).unwrap(), 1.3),
        (Body::ball(-0.3, 0.4, 0.38).unwrap(), 1.0),
    ] {
        let y = steady::state(&body, theta).unwrap();
        all.push((body, y));
        for factor in [0.9, 1.2] {
            let Ok(y) = steady::circular(&body, theta, factor * y.precession()) else { continue };
            all.push((body, y));
        }
    }
    all.retain(|(body, y)| stability::rolling(body, y) > 0.0);
    assert!(all.len() > 20);
    all
}

#[test]
fn energy_falls_by_the_power_and_nothing_tilts_while_it_rolls() {
    for (body, y) in starts() {
        for law in laws_of(&body) {
            let losses = Losses::of(law, 1e-3);
            let d = roll(&body, &y, losses);
            let span = if d.stops_at().is_finite() { d.stops_at() } else { 100.0 };
            for share in [0.05, 0.3, 0.8] {
                let t = share * span;
                let here = d.state(t).unwrap();
                assert!(stability::rolling(&body, &here) > 0.0, "{body:?} {law:?} {share}: {here:?}");
                let lost = losses.power(&body, &here, 1.0);
                let energy = |t: f64| rolling::energy(&body, &d.state(t).unwrap());
                let h = 1e-4 * span;
                let fall = (energy(t - h) - energy(t + h)) / (2.0 * h);
                assert!((fall - lost).abs() < 1e-4 * lost, "{body:?} {law:?} {share}: {fall} {lost}");
                let friction = here.centre_velocity(&body).y.abs() * here.precession();
                assert!((d.friction_coefficient(t) - friction).abs() < 1e-9 * (1.0 + friction));
            }
        }
    }
}

#[test]
fn what_the_losses_do_to_the_lines_of_the_motion_is_what_moves_it() {
    // (w1', w3') without theta' times the slopes of the lines is the part of the couple, which the mass
    // matrix of the three-dimensional model gives
    for (body, y) in starts() {
        for law in laws_of(&body) {
            let losses = Losses::of(law, 1e-3);
            let d = roll(&body, &y, losses);
            let span = d.stops_at().min(100.0);
            let (t, h) = (0.3 * span, 1e-4 * span);
            let [before, here, after] = [t - h, t, t + h].map(|t| d.state(t).unwrap());
            let rate = |f: fn(&State) -> f64| (f(&after) - f(&before)) / (2.0 * h);
            let tilt = rate(|y| y.theta);
            // the slopes of the lines of (w1, w3) without losses
            let moved = rolling::derivative(&body, &here.kicked(1.0));
            let still = rolling::derivative(&body, &here);
            let (f1, f3) = (moved.w1 - still.w1, moved.w3 - still.w3);
            let (a1, a3) = (rate(|y| y.w1) - f1 * tilt, rate(|y| y.w3) - f3 * tilt);
            let (s, c) = here.theta.sin_cos();
            let (radius, depth) = (body.rim() + body.fillet() * s, body.ell() + body.fillet() * c);
            let m = losses.couple(&body, &here, 1.0);
            let push = [
                (body.i1() + depth * depth) * a1 - radius * depth * a3 - m[0],
                (body.i3() + radius * radius) * a3 - radius * depth * a1 - m[2],
            ];
            let size = m[0].abs() + m[2].abs();
            let miss = push[0].abs().max(push[1].abs());
            assert!(miss < 1e-4 * size, "{body:?} {law:?}: {push:?} {m:?}");
        }
    }
}

#[test]
fn all_contour_laws_share_one_path_of_rolling() {
    let along =
        [Law::DryContour, Law::ViscousContour, Law::RollingResistance, Law::AirFilm, Law::BoundaryLayer];
    for (body, y) in starts() {
        if body.fillet() == 1.0 {
            continue;
        }
        let first = roll(&body, &y, Losses::of(along[0], 1e-3));
        let (end, theta) = (first.ended(), first.ends_at_theta());
        for law in &along[1..] {
            let other = roll(&body, &y, Losses::of(*law, 2e-3));
            assert_eq!(other.ended(), end);
            assert!((other.ends_at_theta() - theta).abs() < 1e-7, "{body:?} {law:?}: {theta}");
            for share in [0.2, 0.7] {
                let there = y.theta + share * (theta - y.theta);
                let [a, b] = [&first, &other].map(|d| d.state(d.time(there)).unwrap());
                assert!((a.w1 - b.w1).abs() < 1e-10 * a.w1.abs().max(1.0), "{body:?} {law:?}: {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn rolling_ends_where_it_is_no_longer_stable_and_passes_a_ridge_unnoticed() {
    let body = Body::solid(2.5).unwrap();
    let dry = Losses::of(Law::DryContour, 2e-3);
    let ridge = steady::ridge(&body)[0];
    let high = roll(&body, &steady::state(&body, 0.3).unwrap(), dry);
    assert_eq!(high.ended(), End::Face);
    assert!(high.time(ridge).is_finite() && high.time(0.239) > 38.0 && high.time(0.239) < 42.0);
    // dry contour drifts 1.9 times as fast as with the centre at rest, drilling 0.2 times
    for (law, ratio) in [(Law::DryContour, 1.9), (Law::Drilling, 0.2)] {
        let losses = Losses::of(law, 1e-3);
        let y = steady::state(&body, 1.2).unwrap();
        let [a, b] = [drift(&body, 1.2, losses), roll(&body, &y, losses)].map(|d| d.theta(0.01) - 1.2);
        assert!((b / a - ratio).abs() < 0.05, "{law:?}: {}", b / a);
    }
    let mut lost = 0;
    for (ell, theta) in [(0.0, 1.3), (0.3, 1.0), (0.3, 1.3), (0.6, 1.2), (0.9, 1.0)] {
        let body = Body::solid(ell).unwrap();
        let y = steady::state(&body, theta).unwrap();
        if stability::rolling(&body, &y) > 0.0 {
            for d in Law::ALL.iter().map(|law| roll(&body, &y, Losses::of(*law, 1e-3))) {
                if d.ended() == End::StabilityLost {
                    let last = d.state(d.stops_at()).unwrap();
                    assert!(stability::rolling(&body, &last).abs() < 1e-9, "{ell} {theta}");
                    assert_eq!(d.stable_until(), d.stops_at());
                    lost += 1;
                }
            }
        }
    }
    assert!(lost > 0, "{lost}");
}

#[test]
fn a_rolling_disk_takes_longer_than_one_whose_centre_rests() {
    // Euler's disk, 0.2 to 0.004 rad: rolling takes 4, 10, 11 and 12 % longer, with rolling resistance 2 %
    // less
    let body = Body::solid(6.35 / 37.5).unwrap();
    let laws = [
        (Law::DryContour, 1.04),
        (Law::ViscousContour, 1.10),
        (Law::AirFilm, 1.11),
        (Law::BoundaryLayer, 1.12),
        (Law::RollingResistance, 0.98),
    ];
    for (law, ratio) in laws {
        let losses = Losses::of(law, 1e-3);
        let (rest, rolls) =
            (drift(&body, 0.2, losses), roll(&body, &steady::state(&body, 0.2).unwrap(), losses));
        let found = rolls.time(0.004) / rest.time(0.004);
        assert!((found - ratio).abs() < 0.02, "{law:?}: {found}");
    }
}

#[test]
fn what_turns_the_other_way_round_is_the_mirror_image() {
    for (body, y) in starts() {
        let losses = Losses::of(Law::ViscousContour, 1e-3) + Losses::of(Law::Drilling, 1e-4);
        let back = State { w1: -y.w1, w3: -y.w3, ..y };
        let [a, b] = [roll(&body, &y, losses), roll(&body, &back, losses)];
        assert_eq!(a.stops_at(), b.stops_at());
        let t = 0.4 * a.stops_at().min(100.0);
        let (p, q) = (a.state(t).unwrap(), b.state(t).unwrap());
        assert_eq!((p.theta, p.w1, p.w3, a.precession(t)), (q.theta, -q.w1, -q.w3, -b.precession(t)));
    }
}

#[test]
fn rolling_from_an_unstable_or_unsteady_state_is_refused_by_name() {
    let body = Body::solid(2.5).unwrap();
    let dry = Losses::of(Law::DryContour, 1e-3);
    let refused = |y: State| Drift::rolling(&body, &y, &dry).unwrap_err().to_string();
    assert!(refused(steady::state(&body, 0.36).unwrap()).starts_with("kappa = -"));
    assert!(refused(State { theta: 1.0, w1: 0.3, w2: 0.0, w3: 0.1 }).starts_with("theta'' = "));
    let y = steady::state(&body, 0.2).unwrap();
    assert!(refused(y.kicked(0.1)).starts_with("w2 = -0.1"));
    assert!(Drift::rolling(&body, &y, &Losses::NONE).is_err());
}

#[test]
fn a_drift_ends_where_rolling_becomes_unstable_even_if_it_is_stable_again_soon_after() {
    // within a long step kappa falls below zero and rises again
    for (ell, i1, theta, rate, coefficient) in [
        (
            2.147212621726398,
            2.017703639735785,
            1.0854728435052123,
            -1.3528156025087572,
            4.940615716586833e-05,
        ),
        (0.7568881556941599, 0.652211787036189, 1.0587033504488734, 3.3627504855573194, 0.02117512156316379),
    ] {
        let body = Body::new(ell, i1, 0.5).unwrap();
        let y = steady::circular(&body, theta, rate).unwrap();
        let d = roll(&body, &y, Losses::of(Law::Drilling, coefficient));
        assert_eq!(d.ended(), End::StabilityLost);
        let kappa = |share: f64| stability::rolling(&body, &d.state(share * d.stops_at()).unwrap());
        assert!(kappa(0.99) > 0.0 && kappa(1.0).abs() < 1e-6 * kappa(0.0), "{}", kappa(1.0));
    }
}

#[test]
fn every_coin_that_drills_comes_upright_and_rolls_straight_on_or_leaves_its_steady_states() {
    let mut r = crate::common::wander(17);
    let (mut upright, mut many) = (0, 0);
    for _ in 0..400 {
        let body = Body::new(0.0, 0.25 + 0.25 * r(), 0.5).unwrap();
        let (theta, rate) = (0.02 + 1.5 * r(), (4.0 * r() - 1.5).exp());
        let Ok(y) = steady::circular(&body, theta, rate) else { continue };
        if stability::rolling(&body, &y) <= 0.0 {
            continue;
        }
        let d = roll(&body, &y, Losses::of(Law::Drilling, 10f64.powf(-5.0 + 4.0 * r())));
        let far = (d.ends_at_theta() - core::f64::consts::FRAC_PI_2).abs();
        if d.ended() == End::DrillingStops && far < 1e-7 {
            upright += 1;
            // at the end the precession is proportional to the time that is left
            let [early, late] = [0.9998, 0.9999].map(|share| d.precession(share * d.stops_at()));
            assert!((early / late - 2.0).abs() < 0.01, "{early} {late}");
        }
        many += 1;
    }
    assert!(many > 200 && upright > 20, "{many} {upright}");
}
