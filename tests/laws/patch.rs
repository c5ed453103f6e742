//! Friction of a round patch: balls that drill, slip and creep, the limits of small patches, and laws of every motion.

use crate::common::{drawn, larger, wander};
use spincyl::contact::slip::{Friction, derivative};
use spincyl::contact::{Table, patch};
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{AboveTable, Ask, Ending, Method, Motion, Start, roll_with};
use spincyl::stone::{self, Ellipsoid, StoneState};
use spincyl::turning::{jellett_rising_spin, jellett_spin, rising_spin, turning_spin};
use spincyl::{Body, Slip, State, steady};
use std::f64::consts::PI;

fn on(mu: f64, patch: f64) -> Friction {
    Friction::Coulomb { mu, fixed: mu, patch }
}

fn rolled(body: &Body, start: Start, friction: Friction, times: &[f64]) -> Motion {
    roll_with(body, start, times, &Ask::on(friction).with_force(), || true).unwrap().unwrap()
}

fn drilling(y: &State) -> f64 {
    y.theta.sin() * y.w1 + y.theta.cos() * y.w3
}

/// The sum of energy and heat at each output of a motion.
fn sums(body: &Body, m: &Motion) -> Vec<f64> {
    let path = m.path.as_ref().unwrap();
    let each = m.states.iter().zip(&path.slip).zip(&path.dissipated);
    each.map(|((y, slip), heat)| spincyl::contact::slip::energy(body, y, *slip) + heat).collect()
}

/// A random body, a start that slips, a coefficient of friction and the radius of a patch.
fn any(r: &mut impl FnMut() -> f64) -> (Body, Start, f64, f64) {
    let body = match (3.0 * r()) as u8 {
        0 => Body::ball(0.4 * r() - 0.2, 0.4, 0.42),
        1 => Body::solid(0.02 + 0.5 * r()),
        _ => Body::rounded_tube(0.4 + r(), 0.0, 0.05 + 0.3 * r()),
    };
    let mut speed = || 3.0 * r() - 1.5;
    let state = State { theta: 0.0, w1: speed(), w2: 0.3 * speed(), w3: speed() };
    let slip = [0.3 * speed(), 0.3 * speed()];
    let state = State { theta: 0.4 + 0.8 * r(), ..state };
    (body.unwrap(), Start::from(state).with_slip(slip.into()), 0.1 + 0.5 * r(), 10f64.powf(-1.0 - 1.5 * r()))
}

#[test]
fn a_ball_that_only_drills_slows_down_by_three_sixteenths_of_pi() {
    let ball = Body::ball(0.0, 0.4, 0.4).unwrap();
    let (mu, eps, fast) = (0.2, 0.05, 2.0);
    let theta = 1.0f64;
    let state = State { theta, w1: fast * theta.sin(), w2: 0.0, w3: fast * theta.cos() };
    let stops = 16.0 * 0.4 * fast / (3.0 * PI * mu * eps);
    let times = [0.3 * stops, 0.9 * stops, 1.5 * stops];
    let m = rolled(&ball, state.into(), on(mu, eps), &times);
    for (t, y) in times.iter().zip(&m.states) {
        let left = (fast - 3.0 * PI / 16.0 * mu * eps * t / 0.4).max(0.0);
        assert!((drilling(y) - left).abs() < 1e-12, "{} for {left} at {t}", drilling(y));
        assert!((y.theta - theta).abs() < 1e-12);
    }
    // Where the drilling ends it rolls, and rests.
    let end = m.path.as_ref().unwrap().phases.last().unwrap();
    assert!(end.kind == Kind::Rolling && (end.time - stops).abs() < 1e-6 * stops, "{}", end.time);
}

#[test]
fn a_ball_that_rolls_heavily_creeps_with_a_constant_k_and_slows_down_evenly() {
    let (inertia, mu, eps, arm) = (0.4, 0.2, 0.05, 0.02);
    let ball = Body::ball(0.0, inertia, inertia).unwrap();
    let state = State { theta: 1.0, w1: 2.0, w2: 1.0, w3: 3.0 };
    let ask = Ask::on(on(mu, eps)).with_losses(Losses::of(Law::RollingResistance, arm));
    let times = [20.0, 50.0, 80.0, 110.0, 1000.0];
    let m = roll_with(&ball, Start::from(state), &times, &ask, || true).unwrap().unwrap();
    let slips = &m.path.as_ref().unwrap().slip;
    let seen = |i: usize| {
        let (y, Slip { u_h: u, u_2: v, .. }) = (m.states[i], slips[i]);
        let rolling = y.theta.cos() * y.w1 - y.theta.sin() * y.w3;
        // The slip is along the velocity of the centre.
        assert!((u * rolling + v * y.w2).abs() < 1e-12);
        [u.hypot(v) / (eps * drilling(&y).abs()), rolling.hypot(y.w2), drilling(&y).abs()]
    };
    let [k, rolls, drills] = seen(0);
    let shares = patch::of(k);
    let [force, couple] = [shares.force, shares.couple].map(|share| mu * share);
    assert!((force * (1.0 + inertia) - arm - eps * eps * k * couple).abs() < 1e-12);
    for (i, t) in times.iter().enumerate().take(4).skip(1) {
        let (since, [same, rolling, drilling]) = (t - times[0], seen(i));
        assert!((same - k).abs() < 1e-10, "{same} for {k}");
        assert!((rolls - rolling - (arm - force) / inertia * since).abs() < 1e-11, "{rolling}");
        assert!((drills - drilling - eps * couple / inertia * since).abs() < 1e-11, "{drilling}");
    }
    assert_eq!(m.ending(), Ending::Stops);
}

#[test]
fn a_drilling_that_friction_holds_does_not_begin_again_by_the_errors_of_the_steps() {
    // The steps follow the pose. Its drilling ends long before its rolling.
    let ball = Body::ball(0.0, 0.4, 0.4).unwrap();
    let state = State { theta: 1.0, w1: 1.6, w2: 0.7, w3: 2.2 };
    let ask = Ask::on(on(0.2, 0.07)).with_losses(Losses::of(Law::RollingResistance, 0.01)).with_pose();
    for tol in [1e-5, 1e-6, 1e-7] {
        let ask = ask.with_method(Method::Tolerance(tol));
        let m = roll_with(&ball, Start::from(state), &[1000.0], &ask, || true).unwrap().unwrap();
        assert_eq!(m.ending(), Ending::Stops, "{tol:e}");
        assert!(m.error < 1.0, "{tol:e}: {:e}", m.error);
        let kinds: Vec<Kind> = m.path.as_ref().unwrap().phases.iter().map(|phase| phase.kind).collect();
        assert_eq!(kinds, [Kind::Slipping, Kind::Rolling], "{tol:e}");
    }
}

#[test]
fn a_homogeneous_ball_slips_straight_on_whatever_its_side_spin() {
    let mut r = wander(521);
    let ball = Body::ball(0.0, 0.4, 0.4).unwrap();
    for _ in 0..drawn(20) {
        let (mu, eps) = (0.1 + 0.3 * r(), 0.01 + 0.1 * r());
        let (u, spin, lean) = (0.5 + r(), 4.0 * r() - 2.0, 0.5 + r());
        // Seen from an axis that leans and is not turned, e_h stays e_h.
        let state = State { theta: lean, w1: spin * lean.sin(), w2: 0.0, w3: spin * lean.cos() };
        let mut ask = Ask::on(on(mu, eps)).with_pose();
        ask.force = true;
        let start = Start::from(state).with_slip(Slip::new(u, 0.0));
        let times: Vec<f64> = (1..20).map(|k| 0.05 * f64::from(k) * u / mu).collect();
        let m = roll_with(&ball, start, &times, &ask, || true).unwrap().unwrap();
        for (pose, slip) in m.poses.as_ref().unwrap().iter().zip(&m.path.as_ref().unwrap().slip) {
            let (sin, cos) = pose.phi.radians().sin_cos();
            let across = slip.u_h * sin + slip.u_2 * cos;
            assert!(across.abs() < 1e-11, "{across:e}");
        }
    }
}

#[test]
fn energy_and_heat_have_a_constant_sum_and_friction_acts_against_the_slip() {
    let mut r = wander(522);
    let mut slipping = 0;
    for _ in 0..drawn(60) {
        let (body, start, mu, eps) = any(&mut r);
        let times: Vec<f64> = (1..30).map(|k| 0.2 * f64::from(k)).collect();
        let m = rolled(&body, start, on(mu, eps), &times);
        let sums = sums(&body, &m);
        let spread = sums.iter().fold(0.0, |most: f64, e| larger(most, (e - sums[0]).abs()));
        assert!(spread < 1e-11 + m.error, "{body:?} {start:?} {mu} {eps}: {spread:e}, claims {:e}", m.error);
        let path = m.path.as_ref().unwrap();
        for (i, (y, Slip { u_h: u, u_2: v, .. })) in m.states.iter().zip(&path.slip).enumerate() {
            let speed = u.hypot(*v);
            if speed < 1e-6 || path.kinds[i] != Kind::Slipping {
                continue;
            }
            slipping += 1;
            let f = m.forces.as_ref().unwrap()[i];
            assert!((f.along * u - f.across * v).abs() < 1e-10 * speed && f.along * v + f.across * u < 0.0);
            let share = patch::of(speed / (eps * drilling(y).abs())).force;
            assert!((f.friction() - mu * f.normal * share).abs() < 1e-9 * f.normal.abs());
        }
    }
    assert!(slipping > 100, "{slipping}");
}

#[test]
fn jelletts_number_of_a_ball_falls_by_the_couple_alone() {
    let mut r = wander(523);
    for _ in 0..drawn(200) {
        let (ell, i1, i3) = (0.4 * r() - 0.2, 0.4, 0.42);
        let body = Body::ball(ell, i1, i3).unwrap();
        let mut speed = || 4.0 * r() - 2.0;
        let y = State { theta: 0.0, w1: speed(), w2: speed(), w3: speed() };
        let (slip, y) = ([speed(), speed()], State { theta: 0.2 + 2.5 * r(), ..y });
        let (mu, eps) = (0.3, 0.05);
        let (d, _, f) = derivative(&body, &y, slip.into(), &on(mu, eps), &Losses::NONE);
        let (s, c) = y.theta.sin_cos();
        let turned = i1 * (d.w1 * s + y.w1 * c * d.theta) + i3 * (d.w3 * (ell + c) - y.w3 * s * d.theta);
        let spin = drilling(&y);
        let couple = patch::of(slip[0].hypot(slip[1]) / (eps * spin.abs())).couple;
        let expected = -mu * f.normal * eps * couple * spin.signum() * (1.0 + ell * c);
        assert!((turned - expected).abs() < 1e-13 * (1.0 + f.normal.abs()), "{turned} {expected}");
    }
}

#[test]
fn the_mirror_image_of_a_motion_is_its_motion() {
    let mut r = wander(524);
    for _ in 0..drawn(20) {
        let (body, start, mu, eps) = any(&mut r);
        let State { theta, w1, w2, w3 } = start.state;
        let image = Start::from(State { theta, w1: -w1, w2, w3: -w3 })
            .with_slip(Slip::new(start.slip.u_h, -start.slip.u_2));
        let [a, b] = [start, image].map(|start| rolled(&body, start, on(mu, eps), &[1.0, 3.0]));
        for (y, z) in a.states.iter().zip(&b.states) {
            assert_eq!([y.theta, y.w1, y.w2, y.w3], [z.theta, -z.w1, z.w2, -z.w3]);
        }
    }
}

#[test]
fn a_patch_that_shrinks_tends_to_a_point_with_the_square_where_it_slips_and_to_rolling_in_proportion() {
    let body = Body::ball(-0.2, 0.4, 0.42).unwrap();
    let state = State { theta: 0.3, w1: 0.5, w2: 0.1, w3: 4.0 };
    let start = Start::from(state).with_slip(Slip::new(1.2, -0.4));
    let at = |eps: f64, t: f64| *rolled(&body, start, on(0.3, eps), &[t]).states.last().unwrap();
    let apart = |a: State, b: State| {
        (a.theta - b.theta).abs().max((a.w1 - b.w1).abs()).max((a.w2 - b.w2).abs()).max((a.w3 - b.w3).abs())
    };
    // While it slips fast.
    let [big, small] = [0.02, 0.002].map(|eps| apart(at(eps, 0.8), at(0.0, 0.8)));
    assert!((90.0..110.0).contains(&(big / small)), "{big:e} {small:e}");
    // Where a point rolls.
    let long = 8.0;
    let point = rolled(&body, start, on(0.3, 0.0), &[long]);
    assert!(point.path.as_ref().unwrap().kinds[0] == Kind::Rolling);
    let [big, small] = [0.004, 0.0004].map(|eps| apart(at(eps, long), at(0.0, long)));
    assert!((8.0..13.0).contains(&(big / small)), "{big:e} {small:e}");
}

#[test]
fn a_tippe_top_turns_over_on_a_dry_table_with_a_patch_and_on_a_point_it_never_does() {
    let top = Body::ball(-0.2, 0.4, 0.42).unwrap();
    let state = State { theta: 0.1, w1: 0.0, w2: 0.0, w3: 7.0 };
    // Its centre is at rest.
    let start = Start::from(state).with_slip(Slip::new(0.0, -7.0 * 0.1f64.sin()));
    let times: Vec<f64> = (1..1200).map(|k| 0.05 * f64::from(k)).collect();
    // Seconds to 3 rad for patches of 0.1, 0.3 and 1 mm of a ball of 15 mm, by an independent model.
    let second = 1.0 / 0.0391;
    for (millimetres, seconds) in [(0.1, 1.96), (0.3, 1.51), (1.0, 1.65)] {
        let m = rolled(&top, start, on(0.3, millimetres / 15.0), &times);
        let i = m.states.iter().position(|y| y.theta > 3.0).unwrap();
        assert!((times[i] / second - seconds).abs() < 0.01, "{} for {seconds}", times[i] / second);
    }
    let point = rolled(&top, start, on(0.3, 0.0), &times);
    assert!(point.states.iter().all(|y| y.theta < 0.1 + 1e-9));
}

#[test]
fn a_coin_whirrs_to_its_face_in_one_phase_with_few_steps() {
    // A 2-euro coin with a patch of 0.2 mm. The first time is that of explicit steps of eighth order, which take thirty
    // times as many and know it to 2e-7; they give up the second coin.
    for (resistance, lands, most) in [(3e-3, 301.431_911_184, 1_500_000), (1e-3, 701.930_064_328, 3_000_000)]
    {
        let coin = Body::solid(2.2 / 25.75).unwrap();
        let losses = Losses::of(Law::RollingResistance, resistance);
        let ask = Ask::on(on(0.3, 0.4 / 25.75)).with_losses(losses);
        let m =
            roll_with(&coin, steady::state(&coin, 0.5).unwrap(), &[2000.0], &ask, || true).unwrap().unwrap();
        let event = m.event.unwrap();
        assert_eq!((event.ending, m.path.as_ref().unwrap().phases.len()), (Ending::Face, 1));
        assert!((event.time - lands).abs() < 2e-8 && m.error < 1e-6, "{} with {}", event.time, m.error);
        assert!(m.evaluations < most, "{}", m.evaluations);
    }
}

#[test]
fn the_landing_of_a_coin_is_known_within_its_claim_at_any_tolerance() {
    // The coin nods, also where its creep would allow steps of many nods. The time is that of explicit steps.
    for (tol, most) in [(1e-6, 110_000), (1e-8, 190_000), (1e-10, 450_000)] {
        let coin = Body::solid(2.2 / 25.75).unwrap();
        let losses = Losses::of(Law::RollingResistance, 3e-3);
        let ask = Ask::on(on(0.3, 0.4 / 25.75)).with_losses(losses).with_method(Method::Tolerance(tol));
        let m =
            roll_with(&coin, steady::state(&coin, 0.5).unwrap(), &[2000.0], &ask, || true).unwrap().unwrap();
        let off = (m.event.unwrap().time - 301.431_911_184).abs();
        assert!(off <= m.error + 2e-7, "{tol:e}: {off:e} of {:e}", m.error);
        assert!(m.evaluations < most, "{tol:e}: {}", m.evaluations);
    }
}

#[test]
fn a_drilling_that_turns_round_passes_zero_and_one_that_friction_holds_stays() {
    // The couple turns its sign with the drilling; the motion is the same to the error of what is left out.
    let disk = Body::new(0.05, 0.25 + 0.05 * 0.05 / 3.0, 0.5).unwrap();
    let state = State { theta: 1.14, w1: 0.74, w2: -0.164, w3: -0.891 };
    let m = rolled(&disk, state.into(), on(0.6, 0.02), &[0.9, 1.1]);
    let [before, after] = [m.states[0], m.states[1]].map(|y| drilling(&y));
    assert!(before * after < 0.0 && m.ending() == Ending::Done);
    let sums = sums(&disk, &m);
    assert!((sums[1] - sums[0]).abs() < 1e-11, "{:e}", sums[1] - sums[0]);
}

#[test]
fn a_patch_does_not_go_with_drilling_friction() {
    let ball = Body::ball(0.0, 0.4, 0.4).unwrap();
    let state = State { theta: 1.0, w1: 0.0, w2: 0.0, w3: 1.0 };
    let of = |ask: Ask| roll_with(&ball, Start::from(state), &[1.0], &ask, || true).unwrap_err().to_string();
    let ask = Ask::on(Table::from(on(0.3, 0.02)));
    let drills = Losses::of(spincyl::loss::Law::Drilling, 1e-3);
    assert!(of(ask.with_losses(drills)).contains("the same couple"));
    for wrong in [-0.1, 1.0, f64::NAN] {
        assert!(of(Ask::on(on(0.3, wrong))).starts_with("patch = "));
    }
}

#[test]
fn a_top_needs_more_spin_than_jelletts_number_says_on_any_patch() {
    let top = Body::ball(-0.2, 0.4, 0.42).unwrap();
    let estimate = jellett_spin(&top).unwrap();
    assert!((estimate - 2.496).abs() < 1e-3, "{estimate}");
    // By an independent model: 4.14, 4.18 and 4.50 for 0.1, 0.3 and 1 mm with mu = 0.3; 3.15 and 5.25 with 0.1 and 0.6.
    for (mu, millimetres, spin) in
        [(0.3, 0.1, 4.14), (0.3, 0.3, 4.18), (0.3, 1.0, 4.50), (0.1, 0.1, 3.15), (0.6, 0.1, 5.25)]
    {
        let found = turning_spin(&top, on(mu, millimetres / 15.0), 0.1, None, || true).unwrap().unwrap();
        assert!((found - spin).abs() < 0.01 * spin, "{found} for {spin}");
    }
    // At a point it rolls and stays down with any spin; on a film Jellett's number nearly suffices.
    assert_eq!(turning_spin(&top, on(0.3, 0.0), 0.1, None, || true).unwrap(), Some(f64::INFINITY));
    let film = turning_spin(&top, Friction::Viscous { c: 1.0 }, 0.1, None, || true).unwrap().unwrap();
    assert!(film > estimate && film < 1.1 * estimate, "{film}");
    // A body that is no top is refused.
    assert!(turning_spin(&Body::solid(1.0).unwrap(), on(0.3, 0.01), 0.1, None, || true).is_err());
    assert!(jellett_spin(&Body::ball(0.2, 0.4, 0.42).unwrap()).is_err());
}

#[test]
fn a_top_turns_over_only_between_both_limits_of_its_moments() {
    // 1 - l < I1/I3 < 1 + l (Ebenfeld and Scheck 1995).
    for (low, i1, i3) in [(0.09, 0.37, 0.41), (0.05, 0.30, 0.40), (0.2, 0.25, 0.40), (0.2, 0.5, 0.40)] {
        let top = Body::ball(-low, i1, i3).unwrap();
        assert_eq!(jellett_spin(&top).unwrap(), f64::INFINITY);
        let found = turning_spin(&top, Friction::Viscous { c: 0.6 }, 1e-3, None, || true).unwrap();
        assert_eq!(found, Some(f64::INFINITY), "{low} {i1} {i3}");
    }
    // Between them, near the lower limit, an upright top with less spin stays upright, although it could stand upside down.
    let top = Body::ball(-0.2, 0.332, 0.40).unwrap();
    let (low, estimate) = (0.2, jellett_spin(&top).unwrap());
    let over = (1.0 + low) * (1.0 + low) / (1.0 - low) * (low / (0.4 * (1.0 + low) - 0.332f64)).sqrt();
    assert!(estimate > 1.3 * over, "{estimate} {over}");
    let found = turning_spin(&top, Friction::Viscous { c: 0.6 }, 1e-4, 2000.0, || true).unwrap().unwrap();
    assert!(found > estimate && found < 1.1 * estimate, "{found} {estimate}");
}

#[test]
fn with_more_time_a_top_turns_over_that_slips_little() {
    let top = Body::ball(-0.2, 0.40, 0.42).unwrap();
    let film = Friction::Viscous { c: 0.05 };
    assert_eq!(turning_spin(&top, film, 0.1, None, || true).unwrap(), Some(f64::INFINITY));
    let found = turning_spin(&top, film, 0.1, 2000.0, || true).unwrap().unwrap();
    // Its axis comes within 0.14 of the vertical in that time, and not with 0.3 % less spin.
    let over = |spin: f64, until: f64| {
        let state = State { theta: 0.1, w1: 0.0, w2: 0.0, w3: spin };
        let slip = spincyl::contact::slip::centre_velocity(&top, &state, Slip::default()).map(|v| -v);
        let times: Vec<f64> = (1..=4000).map(|k| until / 4000.0 * f64::from(k)).collect();
        let m = roll_with(&top, Start::from(state).with_slip(slip.into()), &times, &Ask::on(film), || true);
        m.unwrap().unwrap().states.iter().any(|y| y.theta > PI - 0.14)
    };
    assert!(over(found, 2000.0) && !over(0.997 * found, 2000.0) && !over(found, 0.7 * 2000.0), "{found}");
    for time in [0.0, -1.0, f64::NAN, 1e7] {
        assert!(turning_spin(&top, film, 0.1, time, || true).unwrap_err().to_string().starts_with("t = "));
    }
}

#[test]
fn an_egg_whose_way_to_an_end_is_barred_does_not_rise_to_it() {
    // The centre of mass of this egg is near one end: it could spin on that end with less than on the other one, but
    // from its side it rises to the other one, as the motion shows.
    let inertia = [[0.2, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.17]];
    let egg = Ellipsoid::new([0.7, 0.7, 1.0], inertia, [0.0, 0.0, 0.1]).unwrap();
    let estimate = jellett_rising_spin(&egg).unwrap();
    let found = rising_spin(&egg, Friction::Viscous { c: 0.5 }, 0.02, 1000.0, || true).unwrap().unwrap();
    assert!((found - estimate).abs() < 0.1 * estimate, "{found} {estimate}");
}

#[test]
fn an_egg_that_lies_rises_with_a_little_more_spin_than_jelletts_number_says() {
    let egg = Ellipsoid::egg(22.0, 30.8, 0.0).unwrap();
    let estimate = jellett_rising_spin(&egg).unwrap();
    assert!((estimate - 4.146).abs() < 1e-3, "{estimate}");
    // By an independent model: on patches of 0.2 and 1 mm with mu = 0.3 it comes to 0.28 of the vertical with 84 rad/s, and
    // stands with 106, in units of 17.84 rad/s.
    for millimetres in [0.2, 1.0] {
        let found =
            rising_spin(&egg, on(0.3, millimetres / 30.8), 0.1, None, || true).unwrap().unwrap() * 17.84;
        assert!(found > 84.0 && found < 106.0, "{found}");
    }
    let (sphere, table) = (Ellipsoid::egg(1.0, 1.0, 0.0).unwrap(), on(0.3, 0.01));
    assert!(
        rising_spin(&sphere, table, 0.1, None, || true).is_err() && jellett_rising_spin(&sphere).is_err()
    );
    assert_eq!(rising_spin(&egg, table, 0.1, None, || false).unwrap(), None);
}

#[test]
fn static_friction_holds_the_drilling_of_a_ball_as_a_body_and_as_a_stone_alike() {
    let (mut r, mut held, mut drilled) = (wander(6603), 0, 0);
    let times = [0.0, 0.3, 0.6, 1.0, 1.5];
    for k in 0..drawn(120) {
        let (low, i1) = (0.4 * r() - 0.2, 0.3 + 0.2 * r());
        let (i3, mu) = (i1 * (0.7 + 0.6 * r()), 0.1 + 0.3 * r());
        let (ball, inertia) = (Body::ball(low, i1, i3), [[i1, 0.0, 0.0], [0.0, i1, 0.0], [0.0, 0.0, i3]]);
        let (ball, stone) = (ball.unwrap(), Ellipsoid::new([1.0; 3], inertia, [0.0, 0.0, low]).unwrap());
        let fixed = mu * [1.0, 1.5, 4.0, f64::INFINITY][k % 4];
        let table = Friction::Coulomb { mu, fixed, patch: 0.02 + 0.3 * r() };
        // Neither slips nor drills.
        let (theta, rolls, rocks) = (0.4 + 2.2 * r(), 2.0 * r() - 1.0, 2.0 * r() - 1.0);
        let (s, c) = theta.sin_cos();
        let y = State { theta, w1: c * rolls, w2: rocks, w3: -(s * rolls) };
        let turned = StoneState { vertical: [s, 0.0, c], w: [y.w1, y.w2, y.w3] };
        let ask = Ask::on(table);
        let a = roll_with(&ball, y, &times, &ask, || true).unwrap().unwrap();
        let b = stone::roll(&stone, turned, &times, &ask, || true).unwrap().unwrap();
        let told = format!("{ball:?} {y:?} {table:?}");
        assert_eq!(a.ending(), b.ending(), "{told}");
        let kinds: [Vec<Kind>; 2] = [
            a.path.as_ref().unwrap().phases.iter().map(|phase| phase.kind).collect(),
            b.path.as_ref().unwrap().phases.iter().map(|phase| phase.kind).collect(),
        ];
        assert_eq!(kinds[0], kinds[1], "{told}");
        let claimed = a.error + b.error + 1e-9;
        for (y, z) in a.states.iter().zip(&b.states) {
            let (s, c) = y.theta.sin_cos();
            let pairs = [(c, z.vertical[2]), (y.w3, z.w[2]), (s * y.w1 + c * y.w3, z.spin())];
            let off = pairs.iter().fold(0.0, |most: f64, (a, b)| larger(most, (a - b).abs()));
            assert!(off <= 10.0 * claimed, "{told}: {off:e} of {claimed:e}");
        }
        held += usize::from(kinds[0][0] == Kind::Rolling);
        drilled += usize::from(kinds[0].contains(&Kind::Slipping));
    }
    assert!(held > drawn(90) && drilled > drawn(15), "{held} are held, and {drilled} begin to drill");
}

#[test]
fn a_body_that_does_not_drill_slips_and_rolls_on_a_patch_as_on_a_point() {
    // It rocks in a plane, and friction alternates between rest and slip.
    let low = Body::ball(-0.4, 0.4, 0.42).unwrap();
    for (mu, w2) in [(0.1, 0.5), (0.1, 1.5), (0.2, 1.5), (0.25, 1.5)] {
        let y = State { theta: 2.0, w1: 0.0, w2, w3: 0.0 };
        let [point, wide] = [0.0, 0.05].map(|patch| {
            let ask = Ask::on(Friction::Coulomb { mu, fixed: mu, patch });
            roll_with(&low, y, &[10.0], &ask, || true).unwrap().unwrap()
        });
        let (a, b) = (point.states[0], wide.states[0]);
        let claim = 1e-12 + point.error + wide.error;
        assert!((a.theta - b.theta).abs().max((a.w2 - b.w2).abs()) < claim, "{a:?} {b:?}");
        let phases = |m: &Motion| m.path.as_ref().unwrap().phases.len();
        assert!(phases(&point) == phases(&wide) && phases(&wide) > 3);
    }
}

#[test]
fn a_top_that_spins_so_fast_that_it_leaves_the_table_comes_down_and_turns_over() {
    let top = Body::ball(-0.2, 0.4, 0.42).unwrap();
    let mut flights = 0;
    for (spin, e) in [(7.0, 0.0), (9.0, 0.0), (9.0, 0.4), (12.0, 0.3)] {
        let state = State { theta: 0.1, w1: 0.0, w2: 0.0, w3: spin };
        let slip = spincyl::contact::slip::centre_velocity(&top, &state, Slip::default()).map(|v| -v);
        let times: Vec<f64> = (0..=200).map(f64::from).collect();
        let ask = Ask::on(on(0.3, 0.02)).with_restitution(e);
        let m = roll_with(&top, Start::from(state).with_slip(slip.into()), &times, &ask, || true)
            .unwrap()
            .unwrap();
        let path = m.path.as_ref().unwrap();
        let most = m.states.iter().fold(0.0, |most: f64, y| most.max(y.theta));
        assert!(m.event.is_none() && most > 3.0, "{spin} {e}: {:?}, {most}", m.event);
        // No impact supplies energy, and each has the couple of its patch.
        assert!(path.impacts.iter().all(|hit| hit.lost >= 0.0 && hit.couple < 0.0), "{:?}", path.impacts);
        flights += path.impacts.len();
    }
    assert!(flights > 3, "{flights}");
}

#[test]
fn energy_heat_and_what_impacts_take_are_constant_on_patches_too_and_a_face_ends_the_motion() {
    let (mut r, mut hits, mut ends) = (wander(76), [0; 6], 0);
    for k in 0..drawn(240) {
        let body = match (4.0 * r()) as u8 {
            0 => Body::ball(0.6 * (r() - 0.5), 0.3 + 0.2 * r(), 0.3 + 0.2 * r()),
            1 => Body::solid(0.1 + 2.0 * r()),
            2 => Body::rounded_tube(0.4 + 2.0 * r(), 0.0, 0.05 + 0.3 * r()),
            _ => Body::tube(0.5 + 2.0 * r(), r()),
        };
        let body = body.unwrap();
        let odd = k % 3 == 0;
        let mut speed =
            || if odd { [0.0, 1e-300, 1e-16, 0.1, -1.0][(5.0 * r()) as usize] } else { 4.0 * (r() - 0.5) };
        let [w1, w2, w3, u, v, lift] = core::array::from_fn(|_| speed());
        let state = State { theta: 0.2 + 1.2 * r(), w1, w2, w3 };
        let start = Start::from(state)
            .with_slip(Slip::new(u, v))
            .with_aloft(AboveTable::new(if r() < 0.3 { 0.0 } else { r() }, lift));
        let mu = 0.05 + 0.9 * r();
        let ask = Ask::on(on(mu, 10f64.powf(-1.0 - 4.0 * r()))).with_restitution(0.9 * r());
        let times: Vec<f64> = (0..40).map(|k| 0.1 * f64::from(k)).collect();
        let m = roll_with(&body, start, &times, &ask, || true).unwrap().unwrap();
        let path = m.path.as_ref().unwrap();
        let whole = |i: usize| {
            let (Slip { u_h: u, u_2: v, .. }, AboveTable { height, lift, .. }) =
                (path.slip[i], path.aloft[i]);
            let before = path.impacts.iter().filter(|hit| hit.time < m.times[i]);
            crate::flight::energy(&body, &m.states[i], [u, v, lift], height)
                + path.dissipated[i]
                + before.map(|hit| hit.lost).sum::<f64>()
        };
        for i in 0..m.states.len() {
            let off = (whole(i) - whole(0)).abs();
            assert!(
                off < 1e-12 * (1.0 + whole(0)) + 10.0 * m.error,
                "{k} {body:?} {start:?} {ask:?}: {off:e} {:e}",
                m.error
            );
        }
        for hit in &path.impacts {
            let [p, q, n] = hit.impulse;
            assert!(p.hypot(q) <= mu * n * (1.0 + 1e-9) + 1e-14 && hit.lost > -1e-14, "{k} {hit:?}");
            hits[hit.hit as usize] += 1;
        }
        let ending = m.event.map(|event| event.ending);
        ends += usize::from(matches!(ending, Some(Ending::Face | Ending::Side)));
        assert!(
            !matches!(ending, Some(Ending::LiftOff | Ending::Bounded | Ending::Slip)),
            "{k} {ending:?} {:?}",
            m.limit
        );
    }
    assert!(hits[0] > 30 && hits[5] > 5 && ends > 5, "{hits:?} {ends}");
}
