//! What holds at every body and every state.

mod common;

use common::{any_body, any_state, newton_euler, ordinary_tube};
use nalgebra::{Matrix4, Vector3};
use proptest::prelude::*;
use spincyl::stability::{self, Region, at_rest};
use spincyl::{Body, Contact, Scale, State, rolling, steady, sweep};
use std::f64::consts::{FRAC_PI_2, PI};

const ULP: f64 = f64::EPSILON / 2.0;

/// |dlog rate/dlog theta| = (theta/2) |d ell/(n m) + cot theta|.
fn condition(body: &Body, theta: f64) -> f64 {
    let (s, c) = theta.sin_cos();
    let n = c - body.ell() * s;
    let m = n + body.excess() * c;
    0.5 * theta * (body.excess() * body.ell() / (n * m) + c / s).abs()
}

fn numbers(y: &State) -> [f64; 4] {
    [y.theta, y.w1, y.w2, y.w3]
}

/// Jacobian of the independent model by central differences.
fn jacobian(body: &Body, y: &State, contact: Contact) -> Matrix4<f64> {
    let at = numbers(y);
    let h = 1e-5;
    let columns = [0, 1, 2, 3].map(|j| {
        let shifted = |by: f64| {
            let mut x = at;
            x[j] += by;
            newton_euler(body, &State { theta: x[0], w1: x[1], w2: x[2], w3: x[3] }, contact)
        };
        (shifted(h) - shifted(-h)) / (2.0 * h)
    });
    Matrix4::from_columns(&columns)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(256) })]

    #[test]
    fn no_force_does_work_in_rolling(body in any_body(), y in any_state()) {
        let dy = rolling::derivative(&body, &y);
        let (s, c) = y.theta.sin_cos();
        let slide = (y.w3 - body.ell() * y.w1) * (dy.w3 - body.ell() * dy.w1);
        let j = body.i1() + 1.0 + body.ell() * body.ell();
        let powers = [
            j * y.w2 * dy.w2, body.i1() * y.w1 * dy.w1, body.i3() * y.w3 * dy.w3, slide,
            c * dy.theta, -body.ell() * s * dy.theta,
        ];
        let largest = powers.iter().fold(0f64, |a, p| a.max(p.abs()));
        // each power is itself a sum whose terms may cancel: allow for cot theta
        let size = largest * (1.0 + (c / s).abs()) * (1.0 + body.ell());
        prop_assert!(powers.iter().sum::<f64>().abs() <= 64.0 * ULP * size, "{powers:?}");
    }

    #[test]
    fn energy_changes_as_the_equations_of_motion_say(body in any_body(), y in any_state()) {
        let dy = numbers(&rolling::derivative(&body, &y));
        let h = 1e-4 / (1.0 + dy.iter().fold(0f64, |a, x| a.max(x.abs())));
        let ahead = |h: f64| {
            let [theta, w1, w2, w3]: [f64; 4] = std::array::from_fn(|i| numbers(&y)[i] + h * dy[i]);
            rolling::energy(&body, &State { theta, w1, w2, w3 })
        };
        let slope = (ahead(h) - ahead(-h)) / (2.0 * h);
        prop_assert!(slope.abs() <= 1e-6 * (1.0 + ahead(0.0).abs()) / h.sqrt() * 1e-2, "dE/dt = {slope}");
    }

    #[test]
    fn the_equations_of_motion_are_newtons_and_eulers(body in any_body(), y in any_state()) {
        let dy = numbers(&rolling::derivative(&body, &y));
        let model = newton_euler(&body, &y, Contact::Rolling);
        let size = 1.0 + model.amax() + y.w1.powi(2) / y.theta.sin();
        for i in 0..4 {
            prop_assert!((dy[i] - model[i]).abs() <= 1e-12 * size * (1.0 + body.ell().powi(2)), "{i}: {dy:?} {model:?}");
        }
    }

    #[test]
    fn a_steady_state_is_a_fixed_point_of_both_models(body in ordinary_tube(), u in 0.01..0.99f64) {
        let theta = u * FRAC_PI_2;
        let Ok(y) = steady::state(&body, theta) else { return Ok(()) };
        let size = 1.0 + y.w1 * y.w1 / theta.sin() * (1.0 + body.ell()).powi(2);
        prop_assert_eq!((y.w2, y.w3), (0.0, body.ell() * y.w1));
        prop_assert!(rolling::derivative(&body, &y).w2.abs() <= 1e-14 * size);
        for contact in [Contact::Rolling, Contact::Smooth] {
            prop_assert!(newton_euler(&body, &y, contact).amax() <= 1e-13 * size);
        }
        prop_assert!((y.precession() * body.i3().sqrt() / steady::rate(&body, theta) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_circular_state_is_a_fixed_point_and_contains_the_centre_at_rest(
        body in any_body(), u in 0.01..1.0f64, precession in prop_oneof![0.05..5.0f64, -5.0..-0.05f64],
    ) {
        let theta = u * FRAC_PI_2;
        let y = steady::circular(&body, theta, precession).unwrap();
        prop_assert!((y.precession() / precession - 1.0).abs() < 1e-14 && y.w2 == 0.0);
        let dy = rolling::derivative(&body, &y);
        let size = 1.0 + body.ell() + (y.w1 * y.w1 + (y.w1 * y.w3).abs()) * (1.0 + 1.0 / theta.tan());
        prop_assert!(dy.w2.abs() <= 1e-14 * size, "{dy:?}");
        if let Ok(rest) = steady::state(&body, theta) {
            let same = steady::circular(&body, theta, rest.precession()).unwrap();
            let tolerance = 1e-13 * (1.0 + condition(&body, theta)) * (1.0 + rest.w3.abs() + same.w1.abs());
            let lost = (1.0 + body.ell().powi(2)) * theta.cos().max(theta.sin()) / (body.i3() + 1.0);
            prop_assert!((same.w3 - rest.w3).abs() <= tolerance * (1.0 + lost), "{same:?} {rest:?}");
            prop_assert!(rest.centre_radius(&body) < 1e-13 && rest.centre_velocity(&body).norm() < 1e-13 * (1.0 + rest.w3));
        }
    }

    #[test]
    fn where_the_centre_rests_o_is_still_and_x_is_fast(body in ordinary_tube(), u in 0.01..0.99f64) {
        let Ok(y) = steady::state(&body, u * FRAC_PI_2) else { return Ok(()) };
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-13 * (1.0 + b.abs());
        prop_assert!(y.speed_o(&body) <= 1e-13 * (1.0 + y.w3));
        prop_assert!(close(y.speed_x(&body), 2.0 * body.ell() * y.w1));
        // the angular velocity points at O, the angular momentum at thetaInf
        prop_assert!(close(y.gamma(), body.theta_balance()) && close(y.beta(&body), body.theta_limit()));
        let (s, c) = y.theta.sin_cos();
        let lever = body.ell() * s - c;
        prop_assert!(close(y.spin(), lever * y.precession()) && close(y.contact_radius(), lever.abs()));
        let half = 0.5 * (body.i1() + body.i3() * body.ell().powi(2)) * y.w1 * y.w1;
        prop_assert!(close(rolling::energy(&body, &y), half + body.ell() * c + s));
        prop_assert!(close(y.angular_momentum(&body).norm(), (body.i1() * y.w1).hypot(body.i3() * y.w3)));
    }

    #[test]
    fn the_inverse_inverts(body in ordinary_tube(), u in 0.001..0.999f64) {
        let theta = u * FRAC_PI_2;
        let rate = steady::rate(&body, theta);
        if rate.is_nan() {
            return Ok(());
        }
        let all = steady::inclinations(&body, rate);
        let count = steady::count(&body, rate).unwrap();
        prop_assert!(all[..count].is_sorted() && all[count..].iter().all(|x| x.is_nan()));
        for &x in &all[..count] {
            let back = steady::rate(&body, x);
            prop_assert!((back / rate - 1.0).abs() <= 8.0 * (1.0 + condition(&body, x)) * ULP, "{x}: {back} for {rate}");
        }
        // of the answers one is where we came from: exactly so but for folds, where rate is flat
        let k = condition(&body, theta);
        let gap = all[..count].iter().fold(f64::INFINITY, |a, x| a.min((x - theta).abs()));
        prop_assert!(gap <= 8.0 * theta * ULP * (1.0 + 1.0 / k) || k < 1e-6, "{gap} from {theta}");
    }

    #[test]
    fn the_states_of_a_rate_turn_at_that_rate_and_are_steady(body in any_body(), rate in 0.0..6.0f64) {
        let (states, inclinations) = (steady::states(&body, rate), steady::inclinations(&body, rate));
        for (y, theta) in states.iter().zip(inclinations) {
            if theta.is_nan() {
                prop_assert!(y.theta.is_nan() && y.w1.is_nan() && y.w2.is_nan() && y.w3.is_nan());
                continue;
            }
            prop_assert_eq!((y.theta, y.w2, y.w3), (theta, 0.0, body.ell() * y.w1));
            prop_assert!((y.precession() * body.i3().sqrt() - rate).abs() <= 8.0 * ULP * rate);
            let size = 1.0 + body.ell() + y.w1 * y.w1 * (1.0 + body.ell()).powi(2) / theta.sin();
            prop_assert!(rolling::derivative(&body, y).w2.abs() <= 1e-13 * size, "{y:?}");
        }
    }

    #[test]
    fn a_cylinder_has_one_steady_state_below_the_critical_rate_and_two_above(
        ell in 0.9..50.0f64, rate in 0.0..5.0f64,
    ) {
        let body = Body::solid(ell).unwrap();
        let inclinations = steady::inclinations(&body, rate);
        prop_assert_eq!(steady::count(&body, rate), Some(if rate > 1.0 { 2 } else { 1 }));
        prop_assert!(inclinations[0] <= body.theta_balance());
        prop_assert!(rate <= 1.0 || inclinations[1] >= body.theta_limit());
    }

    #[test]
    fn a_disk_has_none_or_two_below_the_band_and_none_to_three_above(
        ell in 0.01..0.86f64, rate in 0.0..5.0f64,
    ) {
        let body = Body::solid(ell).unwrap();
        let all = steady::inclinations(&body, rate);
        let below = all.iter().filter(|x| **x <= body.theta_limit()).count();
        let above = all.iter().filter(|x| **x >= body.theta_balance()).count();
        prop_assert!(below == 0 || below == 2, "{below} below");
        prop_assert_eq!(Some(below + above), steady::count(&body, rate));
    }

    #[test]
    fn at_folds_the_rate_turns_and_at_the_ridge_the_energy(body in ordinary_tube()) {
        let energy = |x: f64| steady::state(&body, x).map_or(f64::NAN, |y| rolling::energy(&body, &y));
        let rate = |x: f64| steady::rate(&body, x);
        type Law<'a> = (&'a dyn Fn(f64) -> f64, [f64; steady::MOST]);
        let laws: [Law; 2] = [(&rate, steady::folds(&body)), (&energy, steady::ridge(&body))];
        for (law, points) in laws {
            let mut expected = 0;
            // every turn of a fine scan, away from the edges of the branch, is found
            let step = FRAC_PI_2 / 4000.0;
            for i in 2..3998 {
                let [a, b, c] = [-1.0, 0.0, 1.0].map(|k| law((f64::from(i) + k) * step));
                let edge = |x: f64| (x / step - f64::from(i)).abs() <= 1.0;
                let turns = (b - a) * (c - b) < 0.0 && !edge(body.theta_balance()) && !edge(body.theta_limit());
                let near = points.iter().any(|p| (p / step - f64::from(i)).abs() <= 1.5);
                prop_assert!(!turns || near, "a turn near {} is missing from {points:?}", f64::from(i) * step);
                expected += usize::from(turns);
            }
            let found = points.iter().filter(|p| **p > 3.0 * step && **p < 3996.0 * step).count();
            prop_assert!(found <= expected + 2 && points.iter().filter(|p| !p.is_nan()).is_sorted());
            for p in points.iter().filter(|p| !p.is_nan()) {
                let h = 1e-4 * p.min(FRAC_PI_2 - p).min((p - body.theta_balance()).abs()).min((p - body.theta_limit()).abs());
                let (low, high) = (law(p - h), law(p + h));
                prop_assert!((high - low).abs() <= 1e-5 * law(*p).abs(), "{p}: {low} {high}");
            }
        }
    }

    #[test]
    fn kappa_is_minus_the_squared_eigenvalue_of_the_independent_model(body in ordinary_tube(), u in 0.05..0.95f64) {
        let Ok(y) = steady::state(&body, u * FRAC_PI_2) else { return Ok(()) };
        if !(1e-2..20.0).contains(&y.w1) {
            return Ok(());
        }
        for (contact, general) in [
            (Contact::Rolling, stability::rolling(&body, &y)), (Contact::Smooth, stability::smooth(&body, &y)),
        ] {
            let square = jacobian(&body, &y, contact).pow(2);
            let size = 1.0 + square.amax();
            let kappa = -square.trace() / 2.0;
            prop_assert!((general - kappa).abs() < 1e-7 * size, "{contact:?}: {general} {kappa}");
            let quick = at_rest(&body, y.theta, contact);
            prop_assert!((quick - general).abs() < 1e-10 * size * (1.0 + condition(&body, y.theta)), "{quick} {general}");
        }
    }

    #[test]
    fn kappa_of_circular_motion_is_that_of_the_independent_model(
        body in ordinary_tube(), u in 0.1..1.0f64, precession in 0.3..3.0f64,
    ) {
        let y = steady::circular(&body, u * FRAC_PI_2, precession).unwrap();
        if y.w3.abs() > 20.0 {
            return Ok(());
        }
        let square = jacobian(&body, &y, Contact::Rolling).pow(2);
        let kappa = -square.trace() / 2.0;
        let ours = stability::rolling(&body, &y);
        prop_assert!((ours - kappa).abs() < 1e-7 * (1.0 + square.amax()), "{ours} {kappa}");
    }

    #[test]
    fn stability_changes_at_the_boundaries_and_nowhere_else(body in any_body(), u in 0.001..0.999f64, v in 0.001..0.999f64) {
        let (low, high) = (u.min(v) * FRAC_PI_2, u.max(v) * FRAC_PI_2);
        let (balance, limit) = (body.theta_balance(), body.theta_limit());
        let one_branch = high < balance.min(limit) || low > balance.max(limit);
        if !one_branch {
            return Ok(());
        }
        for contact in [Contact::Smooth, Contact::Rolling] {
            let crossed = stability::boundaries(&body, contact).iter().filter(|b| low < **b && **b < high).count();
            let (a, b) = (at_rest(&body, low, contact), at_rest(&body, high, contact));
            prop_assert_eq!(a * b < 0.0, crossed % 2 == 1, "{:?}: {} {}, {} crossings", contact, a, b, crossed);
        }
    }

    #[test]
    fn on_either_side_of_a_boundary_kappa_has_the_other_sign(body in any_body()) {
        for contact in [Contact::Smooth, Contact::Rolling] {
            let boundaries = stability::boundaries(&body, contact);
            prop_assert!(boundaries.iter().filter(|b| !b.is_nan()).is_sorted());
            for (k, b) in boundaries.iter().enumerate().filter(|(_, b)| !b.is_nan()) {
                let others = boundaries.iter().enumerate().filter(|(i, x)| *i != k && !x.is_nan()).map(|(_, x)| *x);
                let ends = [body.theta_balance(), body.theta_limit(), FRAC_PI_2];
                let gap = others.chain(ends).fold(*b, |gap, x| gap.min((x - b).abs()));
                let (low, high) = (at_rest(&body, b - 1e-5 * gap, contact), at_rest(&body, b + 1e-5 * gap, contact));
                prop_assert!(gap < 1e-8 || low * high < 0.0, "{contact:?} at {b}: {low}, {high}");
            }
        }
    }

    #[test]
    fn points_of_the_body_move_as_the_contact_holds_it(body in any_body(), y in any_state()) {
        // v + w x p, with v = (ell w2, w3 - ell w1, -w2)
        let ell = body.ell();
        let centre = Vector3::new(ell * y.w2, y.w3 - ell * y.w1, -y.w2);
        let w = Vector3::new(y.w1, y.w2, y.w3);
        let speed = |p: Vector3<f64>| (centre + w.cross(&p)).norm();
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-13 * (1.0 + ell) * (1.0 + w.norm());
        prop_assert!((y.centre_velocity(&body) - centre).norm() <= 1e-13 * (1.0 + ell) * w.norm());
        prop_assert!(close(y.speed_o(&body), speed(Vector3::new(1.0, 0.0, ell))));
        prop_assert!(close(y.speed_x(&body), speed(Vector3::new(1.0, 0.0, -ell))));
        // a body that does not precess goes straight on
        let radius = y.centre_radius(&body);
        prop_assert!(radius >= 0.0 && (y.w1 == 0.0 || close(radius * y.precession().abs(), centre.y.abs())));
    }

    #[test]
    fn only_a_steady_state_has_a_kappa(body in any_body(), u in 0.05..1.0f64, precession in 0.3..3.0f64) {
        let theta = u * FRAC_PI_2;
        let circle = steady::circular(&body, theta, precession).unwrap();
        prop_assert!(!stability::rolling(&body, &circle).is_nan());
        // steady to six digits is steady, to five it is not
        for (shift, steady) in [(1e-7, true), (-1e-7, true), (1e-4, false), (-1e-4, false)] {
            prop_assert_eq!(!stability::rolling(&body, &circle.kicked(shift)).is_nan(), steady);
        }
        let faster = State { w3: circle.w3 + 1.0, ..circle };
        prop_assert!(stability::rolling(&body, &faster).is_nan());
        // a centre that circles needs friction: U' is not zero
        let slip = (circle.w3 - body.ell() * circle.w1).abs();
        prop_assert!(slip < 1e-2 || stability::smooth(&body, &circle).is_nan(), "slip {slip}");
        if let Ok(rest) = steady::state(&body, theta) {
            prop_assert!(!stability::smooth(&body, &rest).is_nan() && !stability::rolling(&body, &rest).is_nan());
        }
        for theta in [0.0, -1.0, 2.0, f64::NAN] {
            let y = State { theta, ..circle };
            prop_assert!(stability::rolling(&body, &y).is_nan() && stability::smooth(&body, &y).is_nan());
        }
    }

    #[test]
    fn rolling_is_stable_wherever_a_smooth_table_is(body in ordinary_tube(), u in 0.0001..1.0f64) {
        let region = stability::region(&body, u * FRAC_PI_2);
        prop_assert!(region != Region::StableSmooth && region != Region::Invalid);
        let rate = steady::rate(&body, u * FRAC_PI_2);
        prop_assert_eq!(region == Region::Forbidden || region == Region::Undetermined, rate.is_nan());
        if !rate.is_nan() {
            let code = 4
                + u8::from(at_rest(&body, u * FRAC_PI_2, Contact::Rolling) > 0.0)
                + 2 * u8::from(at_rest(&body, u * FRAC_PI_2, Contact::Smooth) > 0.0);
            prop_assert_eq!(region as u8, code);
        }
    }

    #[test]
    fn a_map_has_the_bits_of_its_points(
        bodies in prop::collection::vec(prop::option::of(ordinary_tube()), 0..20),
        theta in prop::collection::vec(-0.1..1.7f64, 0..40),
        threads in 1..5usize,
    ) {
        let size = theta.len() * bodies.len();
        let mut rate = vec![0f64; size];
        let (mut kappa_rolling, mut kappa_smooth, mut region) = (rate.clone(), rate.clone(), vec![9; size]);
        let mut energy = rate.clone();
        let out = sweep::Portrait {
            rate: Some(&mut rate), kappa_rolling: Some(&mut kappa_rolling),
            kappa_smooth: Some(&mut kappa_smooth), energy: Some(&mut energy), region: Some(&mut region),
        };
        prop_assert!(sweep::portrait(&theta, &bodies, out, threads, |_| true).unwrap());
        let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
        for (i, &theta) in theta.iter().enumerate() {
            for (j, body) in bodies.iter().enumerate() {
                let k = i * bodies.len() + j;
                let Some(body) = body else {
                    prop_assert!(rate[k].is_nan() && kappa_rolling[k].is_nan() && region[k] == 0);
                    continue;
                };
                prop_assert_eq!(energy[k].is_nan(), rate[k].is_nan());
                if let Ok(y) = steady::state(body, theta) && rate[k] < 1e6 {
                    let sure = 16.0 * f64::EPSILON * (1.0 + condition(body, theta));
                    let expected = rolling::energy(body, &y);
                    prop_assert!((energy[k] - expected).abs() <= sure * expected, "{} {}", energy[k], expected);
                }
                prop_assert!(same(rate[k], steady::rate(body, theta)));
                prop_assert!(same(kappa_rolling[k], at_rest(body, theta, Contact::Rolling)));
                prop_assert!(same(kappa_smooth[k], at_rest(body, theta, Contact::Smooth)));
                prop_assert_eq!(region[k], stability::region(body, theta) as u8);
            }
        }
    }

    #[test]
    fn a_kick_changes_the_tilting_rate_and_nothing_else(y in any_state(), thetadot in -1.0..1.0f64) {
        let kicked = y.kicked(thetadot);
        let dy = rolling::derivative(&Body::solid(1.0).unwrap(), &kicked);
        prop_assert_eq!(dy.theta, -y.w2 + thetadot);
        prop_assert_eq!((kicked.theta, kicked.w1, kicked.w3), (y.theta, y.w1, y.w3));
        prop_assert!((y.gamma() - y.angular_velocity().angle(&nalgebra::Vector3::z())).abs() < 1e-7);
    }
}

#[test]
fn a_tube_is_critical_where_its_moments_agree() {
    for bore in [0.0, 0.25, 0.8, 1.0 - 1e-12, 1.0] {
        let body = Body::tube(Body::critical_aspect(bore, 0.0).unwrap(), bore).unwrap();
        assert!((body.theta_balance() - body.theta_limit()).abs() < 4.0 * ULP);
        assert!((body.i1() / body.i3() - 1.0).abs() < 4.0 * ULP);
    }
    assert!((Body::critical_aspect(0.0, 0.0).unwrap() - 0.75f64.sqrt()).abs() < ULP);
}

#[test]
fn at_a_right_angle_every_body_turns_at_the_critical_rate() {
    for ell in [1e-3, 0.25, 0.9, 2.5, 100.0] {
        let rate = steady::rate(&Body::tube(ell, 0.4).unwrap(), FRAC_PI_2);
        assert!((rate - 1.0).abs() < 1e-12 / ell.min(1.0), "ell = {ell}: {rate}");
    }
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

#[test]
fn a_map_can_be_stopped_and_refuses_arrays_of_another_size() {
    let bodies = vec![Body::solid(1.0).ok(); 1000];
    let theta = vec![0.5; 1 << 16];
    let mut rate = vec![0.0; bodies.len() * theta.len()];
    let asked = std::cell::Cell::new(0);
    let go_on = |_| {
        asked.set(asked.get() + 1);
        false
    };
    let out = sweep::Portrait { rate: Some(&mut rate), ..Default::default() };
    assert!(!sweep::portrait(&theta, &bodies, out, 1, go_on).unwrap());
    assert_eq!(asked.get(), 1, "asked once, and obeyed");
    let short = || {
        let mut region = vec![0; 7];
        sweep::portrait(
            &[0.1, 0.2],
            &[None; 4],
            sweep::Portrait::<f64> { region: Some(&mut region), ..Default::default() },
            1,
            |_| true,
        )
    };
    assert!(std::panic::catch_unwind(short).is_err());
}
