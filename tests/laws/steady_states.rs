//! Steady states.

use crate::common::{BOTH, any_ball, any_rim, newton_euler, ordinary_tube, tube_or_rounded};
use crate::{Place, ULP, condition, place, sharp, steady_end};
use proptest::prelude::*;
use spincyl::stability::{self, Region, at_rest, region};
use spincyl::{Body, Contact, State, rolling, steady};
use std::f64::consts::{FRAC_PI_2, PI};

proptest! {
    #![proptest_config(crate::common::cases(1600))]

    #[test]
    fn a_steady_state_is_a_fixed_point(body in tube_or_rounded(), u in 0.01..0.99f64) {
        let theta = u * steady_end(&body);
        let Ok(y) = steady::state(&body, theta) else { return Ok(()) };
        let Place { s, c, radius, depth: [depth, deep], lever, .. } = place(&body, theta);
        prop_assert!((y.precession() * body.i3().sqrt() / steady::rate(&body, theta) - 1.0).abs() <= 16.0 * ULP);
        // the centre rests
        prop_assert!((radius * y.w3 - depth * y.w1).abs() <= 16.0 * ULP * (radius * y.w3.abs() + deep * y.w1.abs()));
        prop_assert!(y.w2 == 0.0 && (!sharp(&body) || y.w3 == body.ell() * y.w1));
        // the rate has an error, and so have the terms that balance
        let turning = (body.i1() * c / s * y.w1 * y.w1).abs() + body.i3() * y.w1 * y.w3.abs();
        let allowed = (32.0 + 8.0 * (1.0 + condition(&body, theta))) * ULP * (turning + lever[1]);
        for contact in BOTH {
            let inertia = match contact {
                Contact::Rolling => body.i1() + radius * radius + depth * depth,
                _ => body.i1() + lever[0] * lever[0],
            };
            let tilting = contact.derivative(&body, &y).w2.abs();
            if sharp(&body) {
                let size = 1.0 + y.w1 * y.w1 / s * (1.0 + body.ell()).powi(2);
                prop_assert!(tilting <= 1e-14 * size || contact == Contact::Smooth, "{tilting:e}");
                prop_assert!(newton_euler(&body, &y, contact).amax() <= 1e-13 * size);
                continue;
            }
            let slide = (body.i1() + 1.0 + deep * deep) / body.i1().min(body.i3());
            prop_assert!(tilting <= allowed * slide / inertia, "{contact:?}: {tilting:e}");
        }
    }

    #[test]
    fn a_body_can_roll_on_a_circle_at_any_rate_also_at_that_of_its_centre_at_rest(
        body in any_rim(), u in 0.01..1.0f64, precession in prop_oneof![0.05..5.0f64, -5.0..-0.05f64],
    ) {
        let theta = (u * steady_end(&body)).min(3.1);
        let y = steady::circular(&body, theta, precession).unwrap();
        let allowed = if sharp(&body) { 1e-14 } else { 16.0 * ULP };
        prop_assert!((y.precession() / precession - 1.0).abs() < allowed && y.w2 == 0.0);
        let Place { s, c, radius, depth: [_, deep], height, lever, .. } = place(&body, theta);
        let allowed = if sharp(&body) {
            let turning = (y.w1 * y.w1 + (y.w1 * y.w3).abs()) * (1.0 + 1.0 / theta.tan());
            1e-14 * (1.0 + body.ell() + turning)
        } else {
            let j = body.i1() + radius * radius + deep * deep;
            let spin = y.w1.abs() + y.w3.abs() + lever[1] / precession.abs();
            let size = (lever[1] + j * (1.0 + (c / s).abs()) * y.w1.abs() * spin) * (1.0 + height[1]);
            64.0 * ULP * size / body.i1().min(1.0)
        };
        prop_assert!(rolling::derivative(&body, &y).w2.abs() <= allowed, "{y:?}");
        prop_assert!(!stability::rolling(&body, &y).is_nan());
        let faster = State { w3: y.w3 + 1.0 + y.w3.abs(), ..y };
        prop_assert!(stability::rolling(&body, &faster).is_nan());
        if sharp(&body) && let Ok(rest) = steady::state(&body, theta) {
            let same = steady::circular(&body, theta, rest.precession()).unwrap();
            let tolerance = 1e-13 * (1.0 + condition(&body, theta)) * (1.0 + rest.w3.abs() + same.w1.abs());
            let lost = (1.0 + body.ell().powi(2)) * theta.cos().max(theta.sin()) / (body.i3() + 1.0);
            prop_assert!((same.w3 - rest.w3).abs() <= tolerance * (1.0 + lost), "{same:?} {rest:?}");
            prop_assert!(rest.centre_radius(&body) < 1e-13 && rest.centre_velocity(&body).norm() < 1e-13 * (1.0 + rest.w3));
        }
    }

    #[test]
    fn the_circle_of_a_radius_or_of_a_spin_is_the_one_that_has_it(
        body in any_rim(), u in 0.01..0.99f64, precession in prop_oneof![0.05..5.0f64, -5.0..-0.05f64],
    ) {
        // The centre of a homogeneous ball may run along any circle with any precession.
        prop_assume!(body.fillet() < 1.0 || body.ell().abs() > 1e-3);
        let theta = (u * steady_end(&body)).min(3.1);
        let y = steady::circular(&body, theta, precession).unwrap();
        let radius = -y.centre_velocity(&body).y / y.precession();
        let angle = theta.sin_cos();
        let near = |found: f64, asked: f64| (found / asked - 1.0).abs();
        // The other way round it is as wide.
        let found = steady::precession_of_radius(&body, theta, radius).unwrap();
        let large = 1.0 + radius.abs() + body.ell();
        let lost = large * large * (1.0 + 1.0 / (precession * precession)) / angle.0;
        prop_assert!(near(found, precession.abs()) < 1e-13 * (1.0 + lost * lost), "{found} for {precession}: {radius}");
        let both = steady::precessions_of_spin(&body, theta, y.w3).unwrap();
        prop_assert!(both.iter().any(|x| near(*x, precession) < 1e-12 * (1.0 + lost * lost)), "{both:?} {precession}");
        prop_assert!(both[0].abs() <= both[1].abs() || both[1].is_nan());
        for x in both.into_iter().filter(|x| (1e-3..1e3).contains(&x.abs())) {
            let there = steady::circular(&body, theta, x).unwrap();
            prop_assert!((there.w3 - y.w3).abs() < 1e-12 * (1.0 + lost) * (1.0 + y.w3.abs() + x.abs() + 1.0 / x.abs()));
        }
    }

    #[test]
    fn where_the_centre_rests_o_is_still_and_x_is_fast(body in ordinary_tube(), u in 0.01..0.99f64) {
        let Ok(y) = steady::state(&body, u * FRAC_PI_2) else { return Ok(()) };
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-13 * (1.0 + b.abs());
        prop_assert!(y.speed_o(&body) <= 1e-13 * (1.0 + y.w3));
        prop_assert!(close(y.speed_x(&body), 2.0 * body.ell() * y.w1));
        // the angular velocity leads from the axis to O, the angular momentum to thetaInf
        prop_assert!(close(y.gamma(), body.theta_balance()) && close(y.beta(&body), body.theta_limit()));
        let (s, c) = y.theta.sin_cos();
        let lever = body.ell() * s - c;
        prop_assert!(close(y.spin(), lever * y.precession()) && close(y.contact_radius(), lever.abs()));
        let half = 0.5 * (body.i1() + body.i3() * body.ell().powi(2)) * y.w1 * y.w1;
        prop_assert!(close(rolling::energy(&body, &y), half + body.ell() * c + s));
        prop_assert!(close(y.angular_momentum(&body).norm(), (body.i1() * y.w1).hypot(body.i3() * y.w3)));
    }

    #[test]
    fn a_body_whose_motion_ends_earlier_has_the_same_steady_states_up_to_there(
        body in any_rim(), share in 0.1..0.99f64, u in 0.001..1.0f64, speed in 0.1..4.0f64,
    ) {
        let end = share * steady_end(&body);
        let (cut, theta) = (body.with_theta_end(end).unwrap(), u * end);
        let rate = steady::rate(&body, theta);
        // a sharp rim that ends before pi/2 is computed as a rounded one
        let allowed = 6.0 * (1.0 + condition(&body, theta)) * ULP * rate;
        prop_assert!((steady::rate(&cut, theta) - rate).abs() <= allowed || rate.is_nan(), "{rate}");
        prop_assert!(steady::rate(&cut, end.next_up()).is_nan() && steady::state(&cut, end.next_up()).is_err());
        prop_assert_eq!(region(&cut, end.next_up()), Region::Invalid);
        let kept: Vec<f64> = steady::inclinations(&body, speed).into_iter().filter(|x| *x < end).collect();
        let found: Vec<f64> = steady::inclinations(&cut, speed).into_iter().filter(|x| !x.is_nan()).collect();
        prop_assert!(kept.len() == found.len() && kept.iter().zip(&found).all(|(a, b)| (a - b).abs() <= 8.0 * ULP * a),
            "{kept:?} {found:?}");
    }

    /// Omega^2 = ell rho/(I3 ell + (I3 - I1) rho cos theta), rho = 1.
    #[test]
    fn a_ball_has_one_steady_inclination_a_rate(body in any_ball(), u in 0.001..1.0f64) {
        let theta = u * body.theta_end();
        let (ell, d, c) = (body.ell(), body.excess(), theta.cos());
        let square = ell / (ell - d * c);
        let rate = steady::rate(&body, theta);
        prop_assert_eq!(rate.is_nan(), square.is_nan() || square < 0.0);
        if rate.is_nan() || !square.is_finite() {
            return Ok(());
        }
        let conditioning = (ell.abs() + (d * c).abs()) / (ell - d * c).abs();
        prop_assert!((rate * rate / square - 1.0).abs() <= 16.0 * conditioning * ULP, "{rate} {square}");
        prop_assert!(steady::folds(&body).iter().all(|x| x.is_nan()));
        let all = steady::inclinations(&body, rate);
        prop_assert!(all[1].is_nan() && steady::count(&body, rate).is_none_or(|n| n == usize::from(!all[0].is_nan())));
        // cos theta = ell (rate^2 - 1)/(d rate^2): the cosine has the digits of the difference
        let lost = 32.0 * ULP * (ell / d).abs() * (1.0 + square.recip()) * (1.0 + condition(&body, theta));
        let near_end = (theta - body.theta_end()).abs() < lost / theta.sin() + 1e-7;
        prop_assert!((all[0].cos() - c).abs() <= lost + 4.0 * ULP || near_end, "{all:?} for {theta}");
    }

    #[test]
    fn rounded_bodies_of_equal_moments_turn_at_any_rate_in_balance_and_at_one_more_inclination(
        ell in 0.05..3.0f64, moment in 0.2..2.0f64, fillet in 0.01..0.9f64, rate in 0.2..5.0f64,
    ) {
        let body = Body::rounded(ell, moment, moment, fillet).unwrap();
        prop_assert!(steady::folds(&body).iter().all(|x| x.is_nan()));
        prop_assert!((body.theta_balance() - body.theta_limit()).abs() <= 4.0 * ULP);
        // rate^2 = A/s, so that sin theta = a/(rate^2 - rho)
        let sine = (1.0 - fillet) / (rate * rate - fillet);
        let all: Vec<f64> = steady::inclinations(&body, rate).into_iter().filter(|x| !x.is_nan()).collect();
        let mut expected = vec![body.theta_balance()];
        if (0.0..1.0).contains(&sine) {
            expected.push(sine.asin());
        }
        expected.sort_by(f64::total_cmp);
        let apart = expected.windows(2).all(|x| x[1] - x[0] > 1e-6) && (sine - 1.0).abs() > 1e-6;
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-13 / (1.0 - sine * sine).abs().sqrt().min(1.0);
        let same = all.len() == expected.len() && all.iter().zip(&expected).all(|(a, b)| near(*a, *b));
        prop_assert!(!apart || same, "{all:?} {expected:?}");
    }
}

#[test]
fn two_balls_turn_as_physics_today_shows_and_lift_where_oberlin_says() {
    // psi' = phi' exactly, Omega^2 = 5/(2 - 5 cos theta) from pi/2 to cos = 2/5
    let balls = Body::balls(1.0).unwrap();
    assert_eq!((balls.i1(), balls.i3(), balls.theta_end()), (1.4, 0.4, FRAC_PI_2));
    for theta in [FRAC_PI_2, 1.5, 1.3, 1.17] {
        let y = steady::state(&balls, theta).unwrap();
        let square = 5.0 / (2.0 - 5.0 * theta.cos());
        assert!((y.precession().powi(2) / square - 1.0).abs() < 1e-13 * square, "{theta}");
        assert!((y.spin() / y.precession() - 1.0).abs() < 1e-14);
        assert!(BOTH.iter().all(|contact| at_rest(&balls, theta, *contact) > 0.0), "{theta}");
    }
    assert!((balls.theta_limit() - 0.4f64.acos()).abs() < 4.0 * ULP);
    assert_eq!(region(&balls, 1.15), Region::Forbidden);
    // sqrt(5 g/(2 R)) of balls of 16 mm: 8.81 turns a second
    let lift = steady::rate(&balls, FRAC_PI_2) / balls.i3().sqrt();
    assert!((lift - 2.5f64.sqrt()).abs() < 1e-14);
    let scale = spincyl::Scale::new(8e-3, 1.0, 9.80665).unwrap();
    assert!((scale.turns(lift) - 8.81).abs() < 5e-3, "{}", scale.turns(lift));
    // on a rod, 5/(2 - 5 ell cos theta)
    for ell in [1.0, 1.5, 4.0] {
        let rod = Body::balls(ell).unwrap();
        let y = steady::state(&rod, 1.5).unwrap();
        assert!((y.precession().powi(2) * (2.0 - 5.0 * ell * 1.5f64.cos()) / 5.0 - 1.0).abs() < 1e-13);
    }
}

#[test]
fn a_ball_of_equal_moments_turns_at_one_rate_at_every_inclination() {
    for ell in [0.5, -0.3] {
        let body = Body::ball(ell, 0.4, 0.4).unwrap();
        for theta in [1e-9, 0.3, FRAC_PI_2, 3.0, PI] {
            assert!((steady::rate(&body, theta) - 1.0).abs() <= 2.0 * ULP, "{ell} {theta}");
        }
        assert_eq!(steady::count(&body, 1.0), None);
        assert_eq!(steady::count(&body, 1.0f64.next_up()), Some(0));
        assert!(steady::inclinations(&body, 1.0).iter().all(|x| x.is_nan()));
    }
}

#[test]
fn on_its_side_every_body_turns_at_the_critical_rate() {
    let tubes =
        [1e-3, 0.25, 0.9, 2.5, 100.0].map(|ell: f64| (Body::tube(ell, 0.4).unwrap(), 1e-12 / ell.min(1.0)));
    let rounded = [(0.3, 0.4, 0.5, 0.2), (2.0, 1.9, 0.5, 0.7), (1.0, 1.4, 0.4, 1.0), (0.5, 0.7, 0.7, 0.1)]
        .map(|(ell, i1, i3, fillet)| (Body::rounded(ell, i1, i3, fillet).unwrap(), 1e-14));
    for (body, allowed) in tubes.into_iter().chain(rounded) {
        assert!((steady::rate(&body, FRAC_PI_2) - 1.0).abs() < allowed, "{body:?}");
    }
    // for ell = 0 the rate at pi/2 is another one: Omega~^2 = a/(a + d)
    let torus = Body::rounded(0.0, 0.5 * 0.36 + 0.625 * 0.16, 0.36 + 0.75 * 0.16, 0.4).unwrap();
    assert_eq!(torus.theta_end(), PI);
    let square = 0.6 / (0.6 + torus.excess());
    assert!((steady::rate(&torus, FRAC_PI_2).powi(2) / square - 1.0).abs() < 1e-14);
}

#[test]
fn a_tube_is_critical_where_its_moments_agree() {
    for (fillet, known) in [(0.0, 0.75f64.sqrt()), (0.1, 0.8680), (0.2, 0.8734), (0.5, 0.9058)] {
        let half = Body::critical_aspect(0.0, fillet).unwrap();
        assert!((half - known).abs() < if fillet == 0.0 { ULP } else { 5e-5 }, "{half}");
    }
    let bores = [0.0, 0.25, 0.8, 1.0 - 1e-12, 1.0].map(|bore| (bore, 0.0));
    for (bore, fillet) in bores.into_iter().chain([0.1, 0.2, 0.5].map(|fillet| (0.0, fillet))) {
        let body = Body::rounded_tube(Body::critical_aspect(bore, fillet).unwrap(), bore, fillet).unwrap();
        let allowed = if sharp(&body) { 4.0 } else { 16.0 } * ULP;
        assert!(
            (body.theta_balance() - body.theta_limit()).abs() < allowed && body.excess().abs() <= 8.0 * ULP
        );
        assert!((body.i1() / body.i3() - 1.0).abs() < allowed);
    }
    // a ball is critical: I1 = I3 = 2/5
    assert!((Body::critical_aspect(0.0, 1.0).unwrap() - 1.0).abs() < 4.0 * ULP);
    for fillet in [1e-12, 1e-6, 0.01, 0.3, 0.99] {
        let fillet: f64 = fillet;
        let (sharp, round) =
            (Body::critical_aspect(0.0, 0.0).unwrap(), Body::critical_aspect(0.0, fillet).unwrap());
        // the effect of a rounded edge is of second order in the fillet
        assert!((round - sharp).abs() <= fillet * fillet + 4.0 * ULP, "{fillet}: {round} {sharp}");
    }
}

#[test]
fn what_cannot_be_a_rounded_body_is_refused_by_name() {
    let text = |r: Result<Body, spincyl::Error>| r.unwrap_err().to_string();
    assert_eq!(text(Body::rounded(1.0, 0.5, 0.5, -0.1)), "fillet = -0.1: expected 0 <= fillet <= 1");
    assert_eq!(text(Body::rounded(1.0, 0.5, 0.5, 1.1)), "fillet = 1.1: expected 0 <= fillet <= 1");
    assert_eq!(text(Body::rounded(1.0, 0.5, 0.5, f64::NAN)), "fillet = NaN: expected 0 <= fillet <= 1");
    assert_eq!(text(Body::rounded(-0.1, 0.5, 0.5, 0.5)), "ell = -0.1: expected 0 <= ell <= 1e150");
    assert_eq!(
        text(Body::rounded(1.0, 0.2, 0.5, 0.5)),
        "i3 = 0.5, i1 = 0.2: expected i3 <= 2 i1, as for every real body"
    );
    assert_eq!(
        text(Body::rounded(-1.0, 0.5, 0.5, 1.0)),
        "ell = -1.0: expected -1 < ell <= 1e150 (fillet = 1: a ball)"
    );
    assert!(Body::rounded(-0.999, 0.5, 0.5, 1.0).is_ok());
    let wall = "expected 0 <= fillet <= 1, at most the wall 1 - bore";
    assert_eq!(text(Body::rounded_tube(1.0, 0.75, 0.5)), format!("fillet = 0.5: {wall}"));
    let half = "expected 0 <= fillet <= 1, at most half the length";
    assert_eq!(text(Body::rounded_tube(0.2, 0.0, 0.25)), format!("fillet = 0.25: {half}"));
    assert_eq!(text(Body::rounded_tube(2.0, 0.0, 1.5)), format!("fillet = 1.5: {half}"));
    assert!(Body::rounded_tube(0.25, 0.75, 0.25).is_ok() && Body::rounded_tube(-1.0, 0.0, 0.0).is_err());
    assert!(text(Body::from_metres(0.1, 0.0, 0.1, 0.06)).starts_with("fillet = 0.06: "));
    assert_eq!(text(Body::ball(-1.0, 0.4, 0.4)), "offset = -1.0: expected -1 < offset <= 1e150");
    assert_eq!(text(Body::balls(0.9)), "separation = 0.9: expected 1 <= separation <= 1e75");
    let disk = Body::rounded_tube(0.2, 0.0, 0.1).unwrap();
    for bad in [0.0, -1.0, PI.next_up(), f64::NAN] {
        assert!(text(disk.with_theta_end(bad)).starts_with("theta_end = "));
    }
    assert!(steady::state(&disk, FRAC_PI_2.next_up()).unwrap_err().to_string().starts_with("theta = "));
    let capped = Body::ball(-0.2, 0.3, 0.4).unwrap().with_theta_end(2.0).unwrap();
    assert_eq!(
        steady::state(&capped, 2.5).unwrap_err().to_string(),
        "theta = 2.5: expected 0 < theta <= theta_end of the body (radians)"
    );
    assert!(steady::circular(&capped, 2.5, 1.0).is_err() && steady::circular(&capped, 1.9, 1.0).is_ok());
}

#[test]
fn a_thin_disk_whirrs_as_the_coin_does() {
    // ell = 0: rate^2 = I3/(I1 sin theta), so Omega^2 sin theta = 4 (Moffatt, Nature 404, 833 (2000))
    let coin = Body::solid(0.0).unwrap();
    for theta in [1e-9, 1e-3, 0.1, 1.0, 1.57] {
        let y = steady::state(&coin, theta).unwrap();
        assert!((y.precession().powi(2) * theta.sin() / 4.0 - 1.0).abs() < 1e-14);
        assert!((y.spin() + y.precession() * theta.cos()).abs() < 1e-14 * y.precession());
    }
    assert_eq!(steady::count(&coin, 1.4), Some(0));
    assert_eq!(steady::count(&coin, 1.5), Some(1));
}
