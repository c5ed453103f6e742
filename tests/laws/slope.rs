//! Motions on a slope: closed forms for balls, the conservation of energy, symmetries, and bodies that stay at rest.

use crate::common::rim::place;
use crate::common::wander;
use spincyl::contact::{Friction, Table, slip};
use spincyl::custom::{self, Custom};
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{Ask, Ending, Motion, Start, roll_with};
use spincyl::{Body, Contact, Ellipsoid, Slip, State, stone};
use std::f64::consts::{FRAC_PI_2, PI};

fn rolled(body: &Body, start: Start, times: &[f64], ask: &Ask) -> Motion {
    roll_with(body, start, times, &ask.with_pose(), || true).unwrap().unwrap()
}

/// The place of the centre of mass at output `i`: along x and y, and its height above the table.
fn centre(body: &Body, m: &Motion, i: usize) -> [f64; 3] {
    let (y, pose) = (m.states[i], m.poses.as_ref().unwrap()[i]);
    let (at, (sin, cos)) = (place(body, y.theta), pose.phi.radians().sin_cos());
    let lever = at.lever[0];
    let high = m.path.as_ref().and_then(|path| path.aloft.get(i)).map_or(0.0, |aloft| aloft.height);
    [pose.contact_point.x - lever * cos, pose.contact_point.y - lever * sin, at.height[0] + high]
}

fn ball() -> Body {
    Body::ball(0.0, 0.4, 0.4).unwrap()
}

const STATE: State = State { theta: 1.0, w1: 0.6, w2: 0.2, w3: -0.5 };

#[test]
fn a_homogeneous_ball_rolls_down_with_five_sevenths_of_the_pull_whatever_it_spins() {
    let (t, beta) = (3.0, 0.3f64);
    let start = Start::from(STATE).with_heading(0.7).with_place([1.0, -2.0]);
    let m = rolled(&ball(), start, &[0.0, t], &Ask::default().with_slope(beta));
    let level = rolled(&ball(), start, &[0.0, t], &Ask::default());
    let [a, b] = [&m, &level].map(|m| centre(&ball(), m, 1));
    assert!((a[0] - b[0] - 0.5 * t * t * beta.sin() / 1.4).abs() < 1e-12, "{a:?} {b:?}");
    assert!((a[1] - b[1]).abs() < 1e-12);
    // The drilling stays.
    let drilling = |y: &State| y.theta.sin() * y.w1 + y.theta.cos() * y.w3;
    assert!((drilling(&m.states[1]) - drilling(&STATE)).abs() < 1e-12);
}

#[test]
fn the_slip_of_a_ball_is_that_of_a_block_on_a_slope() {
    // |u| sin(chi) tan(chi/2)^(-mu'/tan beta) stays, with mu' = (7/2) mu and the angle chi of u from downhill.
    let (mu, beta) = (0.2, 0.3f64);
    let start = Start::from(STATE).with_slip(Slip::new(0.8, 1.1)).with_heading(0.7);
    let m = rolled(&ball(), start, &[0.0, 0.5, 1.0, 1.5], &Ask::on(Friction::coulomb(mu)).with_slope(beta));
    let block = |i: usize| {
        let Slip { u_h: u, u_2: v, .. } = m.path.as_ref().unwrap().slip[i];
        let chi = m.poses.as_ref().unwrap()[i].phi.radians() + v.atan2(u);
        u.hypot(v) * chi.sin() * (0.5 * chi).tan().abs().powf(-3.5 * mu / beta.tan())
    };
    for i in 1..4 {
        assert!((block(i) / block(0) - 1.0).abs() < 1e-12, "{i}: {}", block(i) / block(0));
    }
}

#[test]
fn a_ball_thrown_across_rolls_where_the_model_of_three_dimensions_says() {
    let y = State { w1: 0.0, w2: 0.0, w3: 0.0, ..STATE };
    let ask = Ask::on(Friction::coulomb(0.25)).with_slope(0.3);
    let m = rolled(&ball(), Start::from(y).with_slip(Slip::new(0.0, 1.0)), &[0.0, 3.0], &ask);
    let path = m.path.as_ref().unwrap();
    assert_eq!(path.phases[1].kind, Kind::Rolling);
    assert!((path.phases[1].time - 1.367_156_766_6).abs() < 1e-10);
}

#[test]
fn a_disk_and_a_tube_move_as_the_model_of_three_dimensions_says() {
    let (disk, y) = (Body::solid(0.1).unwrap(), State { theta: 1.2, w1: 0.5, w2: 0.0, w3: 1.5 });
    let m = rolled(&disk, Start::from(y).with_heading(0.4), &[5.0], &Ask::default().with_slope(0.2));
    let expected = [1.205_471_603_1, 0.593_189_034_3, -0.290_981_649_1, 1.779_528_410_0];
    for (a, b) in <[f64; 4]>::from(m.states[0]).into_iter().zip(expected) {
        assert!((a - b).abs() < 1e-10, "{a} {b}");
    }
    assert!((m.poses.unwrap()[0].phi.radians() - -1.513_326_536_3).abs() < 1e-10);
    let (tube, y) = (Body::tube(6.0, 0.8).unwrap(), State { theta: 1.569, w1: 2.5, w2: 0.0, w3: 9.0 });
    let start = Start::from(y).with_slip(Slip::new(0.0, 6.0 - 12.41 * 2.5 / 6.0)).with_heading(-1.0);
    let ask = Ask::on(Friction::coulomb(0.3)).with_slope(0.15).with_restitution(0.0);
    let m = rolled(&tube, start, &[4.5], &ask);
    let path = m.path.as_ref().unwrap();
    assert!((path.phases[1].time - 2.102_383_272_6).abs() < 1e-10, "{:?}", path.phases);
    assert!((path.impacts[0].time - 4.344_993_669_9).abs() < 1e-10, "{:?}", path.impacts);
}

#[test]
fn on_a_smooth_slope_the_body_turns_as_on_the_level_and_its_centre_falls() {
    let (beta, t) = (0.7f64, 4.0);
    let (body, y) = (Body::solid(0.6).unwrap(), State { theta: 1.1, w1: 0.5, w2: 0.1, w3: 1.5 });
    let start = Start::from(y).with_heading(0.3).with_place([2.0, 1.0]);
    let pace = beta.cos().sqrt();
    let slow = |w: f64| w / pace;
    let before = State { theta: y.theta, w1: slow(y.w1), w2: slow(y.w2), w3: slow(y.w3) };
    let level = rolled(
        &body,
        Start::from(before).with_heading(0.3).with_place([2.0, 1.0]),
        &[t * pace],
        &Ask::on(Contact::Smooth),
    );
    let m = rolled(&body, start, &[t], &Ask::on(Contact::Smooth).with_slope(beta));
    let (a, b) = (m.states[0], level.states[0]);
    let off = [a.theta - b.theta, a.w1 - pace * b.w1, a.w2 - pace * b.w2, a.w3 - pace * b.w3];
    assert!(off.iter().all(|x| x.abs() < 1e-12), "{off:?}");
    let (a, b) = (centre(&body, &m, 0), centre(&body, &level, 0));
    assert!((a[0] - b[0] - 0.5 * beta.sin() * t * t).abs() < 1e-12 && (a[1] - b[1]).abs() < 1e-12);
    // Without friction, but with impacts, it is a slip.
    let ask = Ask::on(Contact::Smooth).with_slope(beta).with_restitution(0.5);
    let slid = rolled(&body, start, &[t], &ask);
    if slid.path.as_ref().unwrap().impacts.is_empty() {
        let c = centre(&body, &slid, 0);
        assert!((a[0] - c[0]).abs() < 1e-11 && (a[1] - c[1]).abs() < 1e-11, "{a:?} {c:?}");
    }
}

#[test]
fn jelletts_number_of_a_ball_stays_on_a_slope_under_any_force_at_its_contact() {
    let body = Body::ball(-0.2, 0.4, 0.42).unwrap();
    let y = State { theta: 0.5, w1: 1.0, w2: 0.3, w3: 4.0 };
    let number =
        |y: &State| body.i1() * y.w1 * y.theta.sin() + body.i3() * y.w3 * (body.ell() + y.theta.cos());
    for (ask, slip) in [
        (Ask::on(Friction::coulomb(0.3)), [0.1, 0.2]),
        (Ask::on(Friction::Viscous { c: 1.0 }), [0.1, 0.2]),
        (Ask::default(), [0.0; 2]),
    ] {
        let m = rolled(
            &body,
            Start::from(y).with_slip(slip.into()).with_heading(0.3),
            &[1.0, 3.0],
            &ask.with_slope(0.4),
        );
        assert_eq!(m.states.len(), 2);
        for state in &m.states {
            assert!((number(state) / number(&y) - 1.0).abs() < 1e-11, "{ask:?}: {}", number(state));
        }
    }
}

fn within(next: &mut impl FnMut() -> f64, low: f64, high: f64) -> f64 {
    low + (high - low) * next()
}

/// A random body, start and law on a slope of up to 60 degrees.
fn drawn(next: &mut impl FnMut() -> f64) -> (Body, Start, Ask) {
    let body = match (next() * 4.0) as usize {
        0 => Body::solid(within(next, 0.05, 3.0)),
        1 => Body::tube(within(next, 0.0, 3.0), next()),
        2 => Body::rounded_tube(within(next, 0.3, 3.0), 0.5, within(next, 0.05, 0.3)),
        _ => {
            let i3 = within(next, 0.3, 0.5);
            Body::ball(within(next, -0.4, 0.4), i3 * within(next, 0.8, 1.2), i3)
        }
    }
    .unwrap();
    let theta = within(next, 0.3, 1.3);
    let [w1, w2, w3] = [(); 3].map(|()| within(next, -2.0, 2.0));
    let mut start = Start::from(State { theta, w1, w2, w3 }).with_heading(within(next, -PI, PI));
    let mut ask = match (next() * 3.0) as usize {
        0 => Ask::default(),
        1 => Ask::on(Friction::Viscous { c: within(next, 0.1, 2.0) }),
        _ => {
            let mu = within(next, 0.05, 0.6);
            let patch = if next() < 0.3 { within(next, 0.001, 0.1) } else { 0.0 };
            Ask::on(Friction::Coulomb { mu, fixed: mu * within(next, 1.0, 1.5), patch })
        }
    };
    if ask.table.rubs() && next() < 0.7 {
        start = start.with_slip(Slip::new(within(next, -1.0, 1.0), within(next, -1.0, 1.0)));
    }
    if next() < 0.3 {
        let losses = Losses::of(Law::RollingResistance, within(next, 0.001, 0.05));
        ask = ask.with_losses(losses + Losses::of(Law::AirLinear, 0.01));
    } else if next() < 0.4 {
        let law = if next() < 0.5 { Law::DryContour } else { Law::Drilling };
        ask = ask.with_losses(Losses::of(law, within(next, 0.01, 0.2)));
    }
    (body, start, ask.with_slope(within(next, -1.05, 1.05)))
}

/// Kinetic energy, and potential energy in the tilted field of gravity.
fn energy(body: &Body, ask: &Ask, m: &Motion, i: usize) -> f64 {
    let ([x, _, z], y) = (centre(body, m, i), m.states[i]);
    let u = m.path.as_ref().map_or([0.0; 2], |path| path.slip[i].into());
    let lift = m.path.as_ref().and_then(|path| path.aloft.get(i)).map_or(0.0, |aloft| aloft.lift);
    let at = place(body, y.theta);
    let rise = at.lever[0] * y.w2;
    let moves = 0.5 * ((rise + lift).powi(2) - rise * rise);
    slip::energy(body, &y, u.into()) - at.height[0] + moves + ask.slope.cos() * z - ask.slope.sin() * x
}

#[test]
fn energy_heat_and_what_is_lost_stay_together_on_any_slope() {
    let mut next = wander(2);
    let (mut followed, mut hops, mut ends) = (0, 0, 0);
    for _ in 0..400 {
        let (body, start, mut ask) = drawn(&mut next);
        let point = !matches!(ask.table, Table::Rubs(Friction::Coulomb { patch, .. }) if patch > 0.0);
        if ask.table.rubs() && point && next() < 0.5 {
            ask = ask.with_restitution(0.9 * next());
        }
        let times: Vec<f64> = (0..=20).map(|k| 0.25 * f64::from(k)).collect();
        let Ok(m) = roll_with(&body, start, &times, &ask.with_pose(), || true) else { continue };
        let m = m.unwrap();
        followed += 1;
        let path = m.path.as_ref().unwrap();
        (hops, ends) = (hops + usize::from(!path.impacts.is_empty()), ends + usize::from(m.event.is_some()));
        let whole = |i: usize| {
            let struck: f64 =
                path.impacts.iter().filter(|hit| hit.time < m.times[i]).map(|hit| hit.lost).sum();
            let lost = path.work_lost.get(i).copied().unwrap_or(0.0);
            energy(&body, &ask, &m, i) + path.dissipated[i] + lost + struck
        };
        for i in 1..m.states.len() {
            let fastest = <[f64; 4]>::from(m.states[i]).into_iter().fold(1.0, |a: f64, b| a.max(b.abs()));
            let off = (whole(i) - whole(0)).abs();
            let claim = 1e-12 * fastest * fastest + 20.0 * fastest * (m.error + m.pose_error);
            assert!(off < claim, "{off:e} {claim:e} at {}: {body:?} {start:?} {ask:?}", m.times[i]);
        }
    }
    assert!(followed > 370 && hops > 20 && ends > 40, "{followed} {hops} {ends}");
}

#[test]
fn the_mirror_image_moves_as_the_mirror_image_and_uphill_is_downhill_turned_round() {
    let mut next = wander(6);
    for _ in 0..60 {
        let (body, start, ask) = drawn(&mut next);
        let Ok(Some(m)) = roll_with(&body, start, &[2.0], &ask.with_pose(), || true) else { continue };
        let State { theta, w1, w2, w3 } = start.state;
        let mirrored = Start::from(State { theta, w1: -w1, w2, w3: -w3 })
            .with_slip(Slip::new(start.slip.u_h, -start.slip.u_2))
            .with_heading(-start.heading);
        let turned = start.with_heading(start.heading + PI);
        let other = rolled(&body, mirrored, &[2.0], &ask);
        let round = rolled(&body, turned, &[2.0], &ask.with_slope(-ask.slope));
        let within = 1e-12 + 2.0 * (m.error + other.error + round.error);
        assert_eq!(m.states.len(), other.states.len());
        for ((a, b), c) in m.states.iter().zip(&other.states).zip(&round.states) {
            let off = [a.theta - b.theta, a.w1 + b.w1, a.w2 - b.w2, a.w3 + b.w3];
            let over = [a.theta - c.theta, a.w1 - c.w1, a.w2 - c.w2, a.w3 - c.w3];
            assert!(
                off.iter().chain(&over).all(|x| x.abs() < within),
                "{off:?} {over:?} {within:e} {body:?}"
            );
        }
    }
}

#[test]
fn on_a_level_table_the_path_begins_at_the_place_and_in_the_direction() {
    let (body, y) = (Body::solid(2.5).unwrap(), State { theta: 1.3, w1: 0.7, w2: 0.05, w3: 0.8 });
    for ask in [Ask::default(), Ask::on(Friction::coulomb(0.3)), Ask::on(Contact::Smooth)] {
        let times = [0.0, 1.0, 2.0];
        let (plain, (sin, cos)) = (rolled(&body, y.into(), &times, &ask), 0.4f64.sin_cos());
        let start = Start::from(y).with_heading(0.4).with_place([3.0, -1.0]);
        let there = rolled(&body, start, &times, &ask.with_slope(0.0));
        for (a, b) in plain.states.iter().zip(&there.states) {
            let off = [a.theta - b.theta, a.w1 - b.w1, a.w2 - b.w2, a.w3 - b.w3];
            assert!(off.iter().all(|x| x.abs() < 1e-13), "{off:?}");
        }
        for (a, b) in plain.poses.unwrap().iter().zip(&there.poses.unwrap()) {
            assert!((b.phi.radians() - a.phi.radians() - 0.4).abs() < 1e-14);
            let (x, y) = (a.contact_point.x, a.contact_point.y);
            let off = [
                b.contact_point.x - (3.0 + x * cos - y * sin),
                b.contact_point.y - (-1.0 + x * sin + y * cos),
            ];
            assert!(off.iter().all(|x| x.abs() < 1e-13), "{ask:?}: {off:?}");
        }
    }
}

#[test]
fn a_ball_rests_on_a_slope_that_rolling_resistance_holds_and_rolls_down_a_steeper_one() {
    let still = State { w1: 0.0, w2: 0.0, w3: 0.0, ..STATE };
    for (delta, beta) in [(0.05, 0.049f64), (0.05, 0.051), (0.3, 0.2), (0.3, 0.35)] {
        let losses = Losses::of(Law::RollingResistance, delta);
        let ask = Ask::on(Friction::coulomb(0.8)).with_losses(losses).with_slope(beta);
        let m = rolled(&ball(), Start::from(still).with_heading(0.3), &[0.0, 2.0], &ask);
        if beta.tan() < delta {
            assert_eq!(m.event.map(|event| (event.ending, event.time)), Some((Ending::Stops, 0.0)));
        } else {
            let gained = centre(&ball(), &m, 1)[0] - centre(&ball(), &m, 0)[0];
            let expected = 0.5 * 4.0 * (beta.sin() - delta * beta.cos()) / 1.4;
            assert!((gained - expected).abs() < 1e-11, "{gained} {expected}");
        }
    }
    // A ball that does not drill comes to rest on its way up, and stays there.
    let rolls = State { w3: -(1f64.tan() * STATE.w1), ..STATE };
    let losses = Losses::of(Law::RollingResistance, 0.3);
    let ask = Ask::on(Friction::coulomb(0.8)).with_losses(losses).with_slope(0.2);
    let m = rolled(&ball(), Start::from(rolls).with_heading(0.3), &[0.0, 50.0], &ask);
    assert_eq!(m.ending(), Ending::Stops);
}

#[test]
fn a_disk_let_go_slips_at_once_where_rolling_would_need_too_much_friction() {
    let (disk, y) = (Body::solid(0.1).unwrap(), State { theta: 1.2, w1: 0.0, w2: 0.0, w3: 0.0 });
    let start = Start::from(y).with_heading(0.7);
    let rolls = rolled(&disk, start, &[0.0], &Ask::default().with_slope(0.5).with_force());
    let force = rolls.forces.unwrap()[0];
    let needed = force.friction() / force.normal;
    for (share, kind) in [(0.999, Kind::Slipping), (1.001, Kind::Rolling)] {
        let m = rolled(&disk, start, &[0.1], &Ask::on(Friction::coulomb(share * needed)).with_slope(0.5));
        assert_eq!(m.path.unwrap().phases[0].kind, kind, "{share}");
    }
}

/// The spin about the normal of the table.
fn drilling(y: &State) -> f64 {
    y.theta.sin() * y.w1 + y.theta.cos() * y.w3
}

#[test]
fn a_ball_on_a_patch_takes_the_spin_of_a_turntable_as_a_table_at_rest_takes_that_of_a_ball() {
    let (om, times) = (0.8, [0.0, 1.0, 2.5, 4.0, 40.0]);
    let ask = Ask::on(Friction::Coulomb { mu: 0.3, fixed: 0.4, patch: 0.2 });
    let still = State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3: 0.0 };
    let taken = rolled(&ball(), still.into(), &times, &ask.with_turning(om));
    let slows = rolled(&ball(), State { w1: -om, ..still }.into(), &times, &ask);
    for (i, t) in times.iter().enumerate() {
        let [a, b] = [&taken, &slows].map(|m| m.states.get(i).map(drilling));
        // The ball on the table at rest has come to rest in the end, and that on the turntable turns on with it.
        let off = a.unwrap() - om - b.unwrap_or(0.0);
        assert!(off.abs() < 1e-11, "{off:e} at {}", t);
        let heat = |m: &Motion| m.path.as_ref().unwrap().dissipated.get(i).copied();
        let off = heat(&taken).unwrap() - heat(&slows).unwrap_or(0.2 * om * om);
        assert!(off.abs() < 1e-11, "{off:e} at {}", t);
        let at = centre(&ball(), &taken, i);
        assert!(at[0].hypot(at[1]) < 1e-11, "{at:?}");
    }
    assert!(drilling(&taken.states[1]) < 0.5 * om && (drilling(&taken.states[4]) - om).abs() < 1e-13);
}

#[test]
fn a_ball_that_turns_with_the_turntable_rolls_round_on_a_patch_as_on_a_point() {
    let (om, beta, times) = (0.8, 0.05, [0.0, 2.0, 7.0, 30.0]);
    let start = Start::from(State { theta: FRAC_PI_2, w1: om, w2: 0.3, w3: 0.4 }).with_place([1.0, -0.5]);
    let point = Friction::coulomb(0.9);
    let patch = Friction::Coulomb { mu: 0.9, fixed: 0.9, patch: 0.02 };
    let [a, b] = [point, patch]
        .map(|law| rolled(&ball(), start, &times, &Ask::on(law).with_slope(beta).with_turning(om)));
    for i in 0..times.len() {
        let [p, q] = [&a, &b].map(|m| centre(&ball(), m, i));
        assert!((0..3).all(|k| (p[k] - q[k]).abs() < 1e-10), "{p:?} {q:?}");
        assert!((drilling(&b.states[i]) - om).abs() < 1e-12);
    }
}

#[test]
fn what_is_not_computed_on_a_slope_is_refused_by_name() {
    let (disk, y) = (Body::solid(0.1).unwrap(), State { theta: 1.2, w1: 0.5, w2: 0.0, w3: 1.5 });
    for ask in [
        Ask::default().with_slope(FRAC_PI_2),
        Ask::default().with_slope(f64::NAN),
        Ask::default()
            .with_losses(Losses::of(Law::DryContour, 0.01) + Losses::of(Law::Drilling, 0.01))
            .with_slope(0.1),
    ] {
        let found = roll_with(&disk, Start::from(y), &[1.0], &ask, || true);
        assert!(found.is_err_and(|e| e.to_string().starts_with("slope")), "{ask:?}");
    }
}

#[test]
fn laws_of_the_user_that_are_those_of_the_library_move_a_body_and_a_stone_as_they_do_on_a_slope() {
    let (constant, drag) =
        (|_: f64| 0.25, |_: &Body, y: &State, _: f64| [y.w1, y.w2, y.w3].map(|w| -0.05 * w));
    let resists = |_: &Body, y: &State, normal: f64| [y.w1, y.w2, y.w3].map(|w| -0.02 * normal * w);
    let body = Body::solid(0.3).unwrap();
    let start = Start::from(State { theta: 1.0, w1: 0.4, w2: 0.1, w3: 1.5 })
        .with_slip(Slip::new(0.6, -0.4))
        .with_heading(0.5);
    let (times, ask) = ([0.5, 1.0, 2.0], Ask::on(Friction::coulomb(0.25)).with_slope(0.3).with_pose());
    let laws = Custom::default().with_friction(&constant).with_couple(&drag);
    let own = custom::roll_with(&body, start, &times, &ask, laws, || true).unwrap().unwrap();
    let known = roll_with(&body, start, &times, &ask.with_losses(Losses::of(Law::AirLinear, 0.05)), || true);
    let known = known.unwrap().unwrap();
    for (a, b) in own.states.iter().zip(&known.states) {
        let off = [a.theta - b.theta, a.w1 - b.w1, a.w2 - b.w2, a.w3 - b.w3];
        assert!(off.iter().all(|x| x.abs() < 1e-8), "{off:?}");
    }
    // A couple in proportion to the normal force is seen with that of the slope.
    let laws = Custom::default().with_couple(&resists);
    let m = custom::roll_with(
        &body,
        start.with_slip(Slip::default()),
        &times,
        &Ask::default().with_slope(0.3).with_pose(),
        laws,
        || true,
    );
    let m = m.unwrap().unwrap();
    let whole = |i: usize| energy(&body, &ask, &m, i) + m.path.as_ref().unwrap().work_lost[i];
    assert!((whole(2) - whole(0)).abs() < 1e-8 && m.path.as_ref().unwrap().work_lost[2] > 0.01);
    let egg = Ellipsoid::egg(1.0, 1.4, 0.0).unwrap();
    let (start, ask) = (egg.spinning(2.0, 0.3, 0.0), Ask::on(Friction::coulomb(0.25)).with_slope(0.3));
    let laws = Custom::default().with_friction(&constant);
    let own = custom::roll_stone(&egg, start, &times, &ask, laws, || true).unwrap().unwrap();
    let known = stone::roll(&egg, start, &times, &ask, || true).unwrap().unwrap();
    for (a, b) in own.states.iter().zip(&known.states) {
        assert!((0..3).all(|i| (a.w[i] - b.w[i]).abs() < 1e-8), "{:?} {:?}", a.w, b.w);
    }
}

#[test]
fn a_ball_that_drills_on_a_patch_creeps_down_as_far_from_rolling_as_the_slope_asks() {
    // While it drills, the slip over the speed of the rim of the patch has friction for what rolling needs: I/(1 + I) of the
    // pull.
    let (mu, beta, radius) = (0.3, 0.2f64, 0.05);
    let friction = Friction::Coulomb { mu, fixed: mu, patch: radius };
    let start = Start::from(State { theta: FRAC_PI_2, w1: 3.0, w2: 0.0, w3: 0.0 });
    let m = rolled(&ball(), start, &[3.0, 5.0, 8.0], &Ask::on(friction).with_slope(beta));
    for i in 0..3 {
        let u = m.path.as_ref().unwrap().slip[i];
        let drills = drilling(&m.states[i]);
        let share = patch_share(u.speed() / (radius * drills.abs()));
        let needed = 0.4 / 1.4 * beta.tan() / mu;
        assert!((share / needed - 1.0).abs() < 0.01, "{share} {needed}");
    }
}

/// The friction of a patch over mu N, for a slip of k times the speed of its rim, by a sum over the pressure of
/// Hertz.
fn patch_share(k: f64) -> f64 {
    let (rings, spokes) = (400, 720);
    let mut sum = 0.0;
    for i in 0..rings {
        let r = (f64::from(i) + 0.5) / f64::from(rings);
        for j in 0..spokes {
            let (sin, cos) = (2.0 * PI * (f64::from(j) + 0.5) / f64::from(spokes)).sin_cos();
            let [x, y] = [k - r * sin, r * cos];
            sum += 1.5 * (1.0 - r * r).sqrt() * r * x / x.hypot(y);
        }
    }
    2.0 * sum / f64::from(rings * spokes)
}
