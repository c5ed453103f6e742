//! Steady states of rounded rims, and their stability.

use crate::common::{BOTH, any_ball, any_body, any_rounded, newton_euler, numbers};
use crate::{Place, ULP, condition, place};
use nalgebra::Matrix4;
use proptest::prelude::*;
use spincyl::exact::Swing;
use spincyl::stability::{self, Region, at_rest, region};
use spincyl::{Body, Contact, State, rolling, steady};
use std::f64::consts::{FRAC_PI_2, PI};

/// Kappa of a circular steady state by the line of the tilting law, section 4 of docs/physics.md; and the sum of the
/// sizes of its terms.
fn kappa(contact: Contact, body: &Body, y: &State) -> [f64; 2] {
    let Place { s, c, radius, depth: [depth, deep], height: [height, _], lever, slope, .. } =
        place(body, y.theta);
    let (i1, i3, a, rho, ct) = (body.i1(), body.i3(), body.rim(), body.fillet(), c / s);
    let (w1, w3) = (y.w1, y.w3);
    let precession = w1 / s;
    let add = |terms: &[f64]| [terms.iter().sum::<f64>(), terms.iter().map(|x| x.abs()).sum::<f64>()];
    match contact {
        Contact::Smooth => {
            let [lean, spin] = [ct * i1 * w1, i3 * w3];
            let inertia = i1 + lever[0] * lever[0];
            let size = i1 * precession * precession
                + (2.0 * lean.abs() + spin.abs()) * (lean.abs() + spin.abs()) / i1
                + slope[1];
            let kappa = i1 * precession * precession + (2.0 * lean - spin) * (lean - spin) / i1 - slope[0];
            [kappa / inertia, size / inertia]
        }
        Contact::Rolling => {
            let d = i1 * i3 + i1 * radius * radius + i3 * depth * depth;
            let j = i1 + radius * radius + depth * depth;
            let wide = i3 / d * (i3 + radius * radius + rho * c * depth);
            let w1_t = add(&[-ct * w1, -i3 * a * depth / d * w1, wide * w3]);
            let w3_t = add(&[
                radius / d * i1 * a * w1,
                radius / d * i3 * depth * w3,
                -radius / d * i1 * rho * c * w3,
            ]);
            let v = add(&[radius * w3, -depth * w1]);
            let v_t = add(&[rho * c * w3, rho * s * w1, radius * w3_t[0], -depth * w1_t[0]]);
            let v_t = [v_t[0], v_t[1] + radius * w3_t[1] + deep * w1_t[1]];
            let g = [lever[0] / s + height * c / (s * s), lever[1] / s + height * c.abs() / (s * s)];
            let terms = |[w1_t, w3_t, v, v_t, g]: [f64; 5]| {
                [
                    -2.0 * i1 * ct * w1 * w1_t,
                    i3 * w1_t * w3,
                    i3 * w1 * w3_t,
                    -g * w1 * v,
                    height / s * w1_t * v,
                    height / s * w1 * v_t,
                ]
            };
            let value: f64 = terms([w1_t[0], w3_t[0], v[0], v_t[0], g[0]]).iter().sum();
            let size: f64 = terms([w1_t[1], w3_t[1], v[1], v_t[1], g[1]]).iter().map(|x| x.abs()).sum();
            let square = i1 * precession * precession;
            [(square + value - slope[0]) / j, (square + size + slope[1]) / j]
        }
    }
}

/// Jacobian of the independent model by central differences of fourth order.
fn jacobian(body: &Body, y: &State, contact: Contact, h: f64) -> Matrix4<f64> {
    let columns = [0, 1, 2, 3].map(|j| {
        let shifted = |by: f64| {
            let mut x = numbers(y);
            x[j] += by;
            newton_euler(body, &State::from(x), contact)
        };
        (8.0 * (shifted(h) - shifted(-h)) - (shifted(2.0 * h) - shifted(-2.0 * h))) / (12.0 * h)
    });
    Matrix4::from_columns(&columns)
}

/// An inclination within the range of a body.
fn inside(body: &Body, u: f64) -> f64 {
    u * body.theta_end()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1024) })]

    #[test]
    fn a_steady_state_of_a_rounded_rim_is_a_fixed_point(body in any_rounded(), u in 0.01..0.99f64) {
        let theta = inside(&body, u);
        let Ok(y) = steady::state(&body, theta) else { return Ok(()) };
        let Place { s, c, radius, depth: [depth, deep], lever, .. } = place(&body, theta);
        prop_assert!((y.precession() * body.i3().sqrt() / steady::rate(&body, theta) - 1.0).abs() <= 16.0 * ULP);
        // the centre rests
        prop_assert!((radius * y.w3 - depth * y.w1).abs() <= 16.0 * ULP * (radius * y.w3.abs() + deep * y.w1.abs()));
        // what is left is what the errors of the rate make of the terms that balance
        let turning = (body.i1() * c / s * y.w1 * y.w1).abs() + body.i3() * y.w1 * y.w3.abs();
        let allowed = (32.0 + 8.0 * (1.0 + condition(&body, theta))) * ULP * (turning + lever[1]);
        for contact in BOTH {
            let inertia = match contact {
                Contact::Rolling => body.i1() + radius * radius + depth * depth,
                Contact::Smooth => body.i1() + lever[0] * lever[0],
            };
            let tilting = contact.derivative(&body, &y).w2;
            let slide = (body.i1() + 1.0 + deep * deep) / body.i1().min(body.i3());
            prop_assert!(tilting.abs() <= allowed * slide / inertia, "{contact:?}: {tilting:e}");
        }
    }

    #[test]
    fn a_rounded_body_can_roll_on_a_circle_at_any_rate(
        body in any_rounded(), u in 0.01..1.0f64, precession in prop_oneof![0.05..5.0f64, -5.0..-0.05f64],
    ) {
        let theta = inside(&body, u).min(3.1);
        let y = steady::circular(&body, theta, precession).unwrap();
        prop_assert!((y.precession() / precession - 1.0).abs() < 16.0 * ULP && y.w2 == 0.0);
        let Place { s, c, radius, depth: [_, deep], height, lever, .. } = place(&body, theta);
        let j = body.i1() + radius * radius + deep * deep;
        let spin = y.w1.abs() + y.w3.abs() + lever[1] / precession.abs();
        let size = (lever[1] + j * (1.0 + (c / s).abs()) * y.w1.abs() * spin) * (1.0 + height[1]);
        prop_assert!(rolling::derivative(&body, &y).w2.abs() <= 64.0 * ULP * size / body.i1().min(1.0), "{y:?}");
        prop_assert!(!stability::rolling(&body, &y).is_nan());
        let faster = State { w3: y.w3 + 1.0 + y.w3.abs(), ..y };
        prop_assert!(stability::rolling(&body, &faster).is_nan());
    }

    #[test]
    fn kappa_of_a_state_is_that_of_the_tilting_law_along_its_line(
        body in prop_oneof![3 => any_rounded(), 1 => any_body()],
        u in 0.01..1.0f64, precession in prop_oneof![0.05..5.0f64, -5.0..-0.05f64],
    ) {
        let theta = inside(&body, u).min(if body.fillet() == 0.0 { FRAC_PI_2 } else { 3.1 });
        let y = steady::circular(&body, theta, precession).unwrap();
        let (found, [expected, size]) = (stability::rolling(&body, &y), kappa(Contact::Rolling, &body, &y));
        prop_assert!((found - expected).abs() <= 64.0 * ULP * size, "{found} {expected}, size {size}");
        let Ok(rest) = steady::state(&body, theta) else { return Ok(()) };
        for (contact, found) in
            [(Contact::Rolling, stability::rolling(&body, &rest)), (Contact::Smooth, stability::smooth(&body, &rest))]
        {
            let [expected, size] = kappa(contact, &body, &rest);
            prop_assert!((found - expected).abs() <= 64.0 * ULP * size, "{contact:?}: {found} {expected}, size {size}");
            // the closed form knows the rate, the state its two numbers
            let quick = at_rest(&body, theta, contact);
            let allowed = (64.0 + 32.0 * (1.0 + condition(&body, theta))) * ULP * size;
            prop_assert!((quick - expected).abs() <= allowed, "{contact:?}: {quick} {expected}, size {size}");
        }
    }

    #[test]
    fn kappa_of_a_rounded_body_is_minus_the_squared_eigenvalue_of_the_independent_model(
        body in any_rounded(), u in 0.1..0.95f64, precession in 0.3..3.0f64,
    ) {
        let theta = inside(&body, u).min(2.9);
        let circle = steady::circular(&body, theta, precession).unwrap();
        let rest = steady::state(&body, theta).ok();
        let mut all = vec![(Contact::Rolling, circle)];
        all.extend(rest.iter().flat_map(|y| BOTH.map(|x| (x, *y))));
        for (contact, y) in all {
            let speed = 1.0 + y.w1.abs() + y.w3.abs();
            if speed > 20.0 {
                continue;
            }
            let step = 1e-3 * theta.sin() / speed;
            let square = jacobian(&body, &y, contact, step).pow(2);
            let expected = -square.trace() / 2.0;
            let found = match contact {
                Contact::Rolling => stability::rolling(&body, &y),
                Contact::Smooth => stability::smooth(&body, &y),
            };
            // the steps err by step^4, rounding by the condition of the model over the step
            let spread = (body.i1() + 1.0 + (1.0 + body.ell().abs()).powi(2)) / body.i1().min(body.i3());
            let allowed = (1e-8 + 64.0 * ULP / step * spread) * (1.0 + square.amax()) * spread;
            prop_assert!((found - expected).abs() <= allowed, "{contact:?}: {found} {expected} {allowed:e}");
        }
    }

    #[test]
    fn a_region_is_named_by_its_signs(body in any_rounded(), u in 0.0001..1.0f64) {
        let theta = inside(&body, u);
        let (found, rate) = (region(&body, theta), steady::rate(&body, theta));
        prop_assert!(found != Region::Invalid);
        prop_assert_eq!(matches!(found, Region::Forbidden | Region::Undetermined), rate.is_nan());
        if !rate.is_nan() {
            let stable = |contact| u8::from(at_rest(&body, theta, contact) > 0.0);
            prop_assert_eq!(found as u8, 4 + stable(Contact::Rolling) + 2 * stable(Contact::Smooth));
        }
        for theta in [0.0, -1.0, body.theta_end().next_up(), 4.0, f64::NAN] {
            prop_assert_eq!(region(&body, theta), Region::Invalid);
            prop_assert!(steady::rate(&body, theta).is_nan() && steady::state(&body, theta).is_err());
        }
    }

    #[test]
    fn a_body_whose_motion_ends_earlier_has_the_same_steady_states_up_to_there(
        body in prop_oneof![any_rounded(), any_body()], share in 0.1..0.99f64, u in 0.001..1.0f64, speed in 0.1..4.0f64,
    ) {
        let end = share * if body.fillet() == 0.0 { FRAC_PI_2 } else { body.theta_end() };
        let (cut, theta) = (body.with_theta_end(end).unwrap(), u * end);
        let rate = steady::rate(&body, theta);
        // a sharp rim that ends before pi/2 goes the way of a rounded one
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
        let theta = inside(&body, u);
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
        // cos theta = ell (rate^2 - 1)/(d rate^2): the cosine is known to what is left of the difference
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
fn flat_on_its_face_a_rounded_body_has_the_nutation_of_its_height() {
    // theta -> 0: kappa/Omega^2 -> (3 I1 + H^2)/(I1 + a^2 + H^2), smooth 3 I1/(I1 + a^2)
    for (half, bore, fillet) in [(0.17, 0.0, 0.05), (1.0, 0.0, 0.3), (0.6, 0.5, 0.4), (2.0, 0.0, 0.9)] {
        let body = Body::rounded_tube(half, bore, fillet).unwrap();
        let (i1, square, high) = (body.i1(), body.rim().powi(2), half * half);
        for theta in [1e-6, 1e-9] {
            let omega2 = steady::rate(&body, theta).powi(2) / body.i3();
            let near = |contact, limit: f64| {
                (at_rest(&body, theta, contact) / omega2 / limit - 1.0).abs() < 30.0 * theta / body.rim()
            };
            assert!(near(Contact::Rolling, (3.0 * i1 + high) / (i1 + square + high)), "{half} {fillet}");
            assert!(near(Contact::Smooth, 3.0 * i1 / (i1 + square)), "{half} {fillet}");
            assert!((omega2 * i1 * theta / body.rim() - 1.0).abs() < 30.0 * theta / body.rim());
        }
    }
}

#[test]
fn on_its_side_a_rounded_body_turns_at_the_critical_rate() {
    for (ell, i1, i3, fillet) in
        [(0.3, 0.4, 0.5, 0.2), (2.0, 1.9, 0.5, 0.7), (1.0, 1.4, 0.4, 1.0), (0.5, 0.7, 0.7, 0.1)]
    {
        let body = Body::rounded(ell, i1, i3, fillet).unwrap();
        assert!((steady::rate(&body, FRAC_PI_2) - 1.0).abs() < 1e-14);
    }
    // without height there is no such rate: Omega~^2 = a/(a + d)
    let torus = Body::rounded(0.0, 0.5 * 0.36 + 0.625 * 0.16, 0.36 + 0.75 * 0.16, 0.4).unwrap();
    assert_eq!(torus.theta_end(), PI);
    let square = 0.6 / (0.6 + torus.excess());
    assert!((steady::rate(&torus, FRAC_PI_2).powi(2) / square - 1.0).abs() < 1e-14);
}

#[test]
fn a_ball_sleeps_on_its_pole_above_the_spin_that_routh_found() {
    let balls = Body::balls(1.0).unwrap();
    let near = |contact, known: f64| (stability::standing_spin(&balls, contact) - known).abs() < 5e-4;
    assert!(near(Contact::Rolling, 1.936) && near(Contact::Smooth, 5.916));
    assert!(stability::standing_spin(&Body::rounded(1.0, 0.5, 0.5, 0.5).unwrap(), Contact::Rolling).is_nan());
    assert_eq!(stability::standing_spin(&Body::ball(-0.2, 0.3, 0.4).unwrap(), Contact::Rolling), 0.0);
    for body in [balls, Body::balls(1.5).unwrap(), Body::ball(0.2, 0.35, 0.4).unwrap()] {
        for contact in BOTH {
            let critical = stability::standing_spin(&body, contact);
            let high = |spin: f64| {
                let (s, c) = 1e-4f64.sin_cos();
                let y = State { theta: 1e-4, w1: spin * s, w2: 0.0, w3: spin * c };
                Swing::new(&body, &y, contact, false).unwrap().turning_points()[1]
            };
            // from 1e-4 it rises to about 1e-4 over the root of what the spin has too much, or of order 1
            assert!(
                high(1.02 * critical) < 1e-2 && high(0.98 * critical) > 0.3,
                "{body:?} {contact:?}: {}",
                high(critical)
            );
        }
    }
}

#[test]
fn a_tube_with_rounded_edges_is_critical_where_its_moments_agree() {
    for (fillet, known) in [(0.0, 0.8660), (0.1, 0.8680), (0.2, 0.8734), (0.5, 0.9058)] {
        let half = Body::critical_aspect(0.0, fillet).unwrap();
        assert!((half - known).abs() < 5e-5, "{half}");
        let body = Body::rounded_tube(half, 0.0, fillet).unwrap();
        assert!(
            body.excess().abs() <= 8.0 * ULP
                && (body.theta_balance() - body.theta_limit()).abs() < 16.0 * ULP
        );
    }
    // a ball is critical: I1 = I3 = 2/5
    assert!((Body::critical_aspect(0.0, 1.0).unwrap() - 1.0).abs() < 4.0 * ULP);
    for fillet in [1e-12, 1e-6, 0.01, 0.3, 0.99] {
        let fillet: f64 = fillet;
        let (sharp, round) =
            (Body::critical_aspect(0.0, 0.0).unwrap(), Body::critical_aspect(0.0, fillet).unwrap());
        // the edge that is taken off is of second order
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
        "i3 = 0.5, i1 = 0.2: a real body satisfies i3 <= 2 i1"
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
