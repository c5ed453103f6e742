//! Bodies of all profiles that hop, with and without air: their energy and lowest point, landings of an independent
//! model, and landings of both rims at once.

use crate::common::{drawn, larger, wander};
use crate::flight::{centre, coulomb, dropped, energy, impacts};
use nalgebra::Vector3;
use spincyl::contact::Table;
use spincyl::contact::slip::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::{Hit, Kind, Lands};
use spincyl::motion::{AboveTable, Ask, Ending, Limit, Method, Motion, Start, roll_with};
use spincyl::{Body, Slip, State};
use std::f64::consts::{FRAC_PI_2, PI};

fn moved(body: &Body, start: &Start, ask: &Ask, times: &[f64]) -> Motion {
    roll_with(body, *start, times, ask, || true).unwrap().unwrap()
}

fn two_rims(body: &Body) -> bool {
    body.ell() > 0.0 && body.theta_end() == FRAC_PI_2
}

/// A random body: with a sharp or rounded rim, two equal balls, or one ball whose centre of mass may lie outside it.
fn any_profile(r: &mut impl FnMut() -> f64) -> Body {
    let body = match (8.0 * r()) as u8 {
        0 => Body::solid(0.03 + 3.0 * r()),
        1 => Body::tube(0.03 + 4.0 * r(), r()),
        2 => Body::rounded_tube(0.4 + 2.0 * r(), 0.0, 0.05 + 0.3 * r()),
        3 => Body::ball(r() - 0.5, 0.3 + 0.3 * r(), 0.2 + 0.4 * r()),
        4 => Body::ball(1.0 + 1.5 * r(), 0.4 + 1.6 * r(), 0.2 + 0.6 * r()),
        5 => Body::solid(0.0),
        6 => Body::balls(1.0 + 0.5 * r()),
        _ => Body::solid(0.3 + 1.2 * r()),
    };
    body.unwrap()
}

/// A random start on the table or in the air; for a body with two rims also on its side, or close to it.
fn any_start(body: &Body, r: &mut impl FnMut() -> f64) -> Start {
    let theta = match (5.0 * r()) as u8 {
        0 if two_rims(body) => FRAC_PI_2,
        1 if two_rims(body) => FRAC_PI_2 - 10f64.powf(-16.0 * r()),
        _ if body.fillet() == 1.0 && !two_rims(body) => 0.1 + 2.9 * r(),
        _ => 0.1 + 1.4 * r(),
    };
    let fast = [0.3, 1.0, 3.0][(3.0 * r()) as usize];
    let [w1, w2, w3] = core::array::from_fn(|_| if r() < 0.15 { 0.0 } else { fast * (2.0 * r() - 1.0) });
    let state = State { theta, w1, w2, w3 };
    let start = Start::from(state).with_slip(Slip::new(2.0 * r() - 1.0, 2.0 * r() - 1.0));
    match (4.0 * r()) as u8 {
        0 => start.with_aloft(AboveTable::new(1.5 * r(), 2.0 * r() - 1.0)),
        1 => start.with_aloft(AboveTable::new(0.0, 2.0 * r() - 1.0)),
        _ => start,
    }
}

fn any_air(r: &mut impl FnMut() -> f64) -> Losses {
    let law = [Law::AirLinear, Law::AirQuadratic][(2.0 * r()) as usize];
    Losses::of(law, 10f64.powf(-4.0 + 3.5 * r()))
}

#[test]
fn whatever_hops_keeps_its_energy_within_its_estimated_error_and_nothing_sinks_into_the_table() {
    let (mut r, mut flights, mut lost) = (wander(641), 0, 0);
    let times: Vec<f64> = (0..61).map(|k| 0.1 * f64::from(k)).collect();
    for _ in 0..drawn(600) {
        let body = any_profile(&mut r);
        let (start, mu) = (any_start(&body, &mut r), 0.02 + 0.98 * r());
        let e = [0.0, 0.3, 0.9][(3.0 * r()) as usize];
        let air = if r() < 0.5 { any_air(&mut r) } else { Losses::NONE };
        let m = moved(&body, &start, &Ask::on(coulomb(mu)).with_restitution(e).with_losses(air), &times);
        let path = m.path.as_ref().unwrap();
        let whole = |i: usize| {
            let (Slip { u_h: u, u_2: v, .. }, AboveTable { height, lift, .. }) =
                (path.slip[i], path.aloft[i]);
            let before = path.impacts.iter().filter(|hit| hit.time < m.times[i]);
            energy(&body, &m.states[i], [u, v, lift], height)
                + path.dissipated[i]
                + before.map(|hit| hit.lost).sum::<f64>()
                + path.work_lost.get(i).unwrap_or(&0.0)
        };
        let case = format!("{body:?} {start:?} mu {mu} e {e} {air:?}: error {:e}", m.error);
        // Some bounces at a high restitution depend on errors of the size of rounding.
        lost += usize::from(m.error > 1e-3);
        for i in 0..m.times.len() {
            let off = (whole(i) - whole(0)).abs();
            assert!(off < m.error.max(1e-12) * (1.0 + whole(0).abs()), "{off:e} {case}");
            let AboveTable { height, .. } = path.aloft[i];
            let other = if two_rims(&body) { 2.0 * body.ell() * m.states[i].theta.cos() } else { 0.0 };
            let lowest = height + other.min(0.0);
            assert!(lowest >= -m.error.max(1e-13), "{lowest:e} at {} {case}", m.times[i]);
        }
        assert!(path.impacts.iter().all(|hit| hit.lost > -1e-13), "{case}");
        // With a restitution a motion ends only if a face lands or nothing moves.
        assert!(matches!(m.ending(), Ending::Done | Ending::Face | Ending::Stops), "{:?} {case}", m.ending());
        flights += path.phases.iter().filter(|phase| phase.kind == Kind::Flying).count();
    }
    assert!(flights > 1000 && lost <= drawn(600) / 50, "{flights} {lost}");
}

#[test]
fn a_body_on_both_rims_that_turns_lands_with_the_velocity_of_its_start() {
    let mut r = wander(642);
    for _ in 0..drawn(60) {
        let body = Body::solid(0.2 + 2.0 * r()).unwrap();
        let mut speed = || 4.0 * r() - 2.0;
        let state = State { theta: FRAC_PI_2, w1: speed(), w2: speed(), w3: speed() };
        let (slip, lift) = ([speed(), speed()], -2.0 * r());
        let there = lift + 2.0 * body.ell() * state.w2;
        for e in [0.0, 0.5] {
            let ask = Ask::on(coulomb(0.3)).with_restitution(e);
            let m = moved(&body, &dropped(state, slip, 0.0, lift), &ask, &[0.0, 0.01]);
            let hit = impacts(&m)[0];
            let lands = if hit.lands == Lands::Other { there } else { lift };
            assert_eq!(hit.time, 0.0);
            assert!((hit.velocities[0][2] - lands).abs() < 1e-15, "{state:?} {lift} {hit:?}");
            assert_eq!([hit.states[0].w1, hit.states[0].w2.abs()], [state.w1, state.w2.abs()]);
        }
    }
}

#[test]
fn a_ball_with_its_centre_of_mass_outside_lands_on_its_lowest_point_upside_down_too() {
    let (mut r, mut below) = (wander(643), 0);
    for _ in 0..drawn(150) {
        let ell = 1.0 + 2.0 * r();
        let ball = Body::ball(ell, 0.5 + r(), 0.5).unwrap();
        // Without w1 and w3 the inclination is theta - w2 t, and may pass a pole.
        let (theta, w2, lift) = (0.2 + 2.7 * r(), 4.0 * r() - 2.0, 3.0 * r());
        let start = dropped(State { theta, w1: 0.0, w2, w3: 0.0 }, [0.0; 2], 0.0, lift);
        let m = moved(&ball, &start, &Ask::on(coulomb(0.3)).with_restitution(0.5), &[20.0]);
        let rise = lift + ell * theta.sin() * w2;
        let height = |t: f64| ell * theta.cos() + t * (rise - 0.5 * t) - ell * (theta - w2 * t).cos();
        let step = 1e-4;
        let k = (1..200_000).find(|k| height(step * f64::from(*k)) <= 0.0).unwrap();
        let (mut low, mut high) = (step * f64::from(k - 1), step * f64::from(k));
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if height(middle) > 0.0 { low = middle } else { high = middle }
        }
        let lands = impacts(&m)[0].time;
        if low > 10.0 * step {
            assert!((lands - low).abs() < 1e-10 * (1.0 + low), "ell {ell} {start:?}: {lands} for {low}");
        }
        below += u32::from(ell * (theta - w2 * low).cos() + 1.0 < 0.0);
    }
    assert!(below > 5, "{below}");
}

/// The first zero of the height of a rim that touches the table, after a lift-off at rest or from a slip, by Newton's
/// and Euler's equations in the laboratory; None up to `until`.
fn landing(body: &Body, y: &State, [u, v]: [f64; 2], air: &Losses, until: f64) -> Option<f64> {
    let (s, c) = y.theta.sin_cos();
    let (e1, e2, e3) = (Vector3::new(c, 0.0, s), Vector3::y(), Vector3::new(-s, 0.0, c));
    let w = e1 * y.w1 + e2 * y.w2 + e3 * y.w3;
    let (i1, i3) = (body.i1(), body.i3());
    let [.., rise] = centre(body, y, [u, v, 0.0]);
    let [b, b2] = [Law::AirLinear, Law::AirQuadratic].map(|law| air.coefficient(law));
    let turns = |axis: &Vector3<f64>, l: &Vector3<f64>| l / i1 + axis * ((1.0 / i3 - 1.0 / i1) * l.dot(axis));
    let rates = |[axis, l]: [Vector3<f64>; 2]| {
        let w = turns(&axis, &l);
        [w.cross(&axis), -w * (b + b2 * w.norm())]
    };
    let height = |t: f64, axis: &Vector3<f64>| {
        let level = |axis: &Vector3<f64>| body.ell() * axis.z + body.rim() * axis.xy().norm();
        t * (rise - 0.5 * t) - (level(axis) - level(&e3))
    };
    let mut at = [e3, w * i1 + e3 * ((i3 - i1) * y.w3)];
    let (count, mut high) = (40_000, 0f64);
    let step = until / f64::from(count);
    let mut last = 0.0;
    for k in 1..=count {
        let ahead = |by: f64, rate: [Vector3<f64>; 2]| [at[0] + rate[0] * by, at[1] + rate[1] * by];
        let k1 = rates(at);
        let k2 = rates(ahead(0.5 * step, k1));
        let k3 = rates(ahead(0.5 * step, k2));
        let k4 = rates(ahead(step, k3));
        at = [0, 1].map(|i| at[i] + (k1[i] + (k2[i] + k3[i]) * 2.0 + k4[i]) * (step / 6.0));
        let h = height(step * f64::from(k), &at[0]);
        high = high.max(h);
        if h <= 0.0 && last > 0.0 && high > 1e-12 {
            return Some(step * (f64::from(k) - h / (h - last)));
        }
        last = h;
    }
    None
}

#[test]
fn a_body_that_leaves_the_table_against_the_air_lands_when_newtons_equations_say() {
    let (mut r, mut met) = (wander(644), 0);
    // Two short flights, whose lengths the couple of the air changes by a tenth.
    let short = [
        (
            0.2746267602138183,
            [0.3433532910091432, 1.7079919439438926, 2.5187902318901223, 1.8393702452276344],
        ),
        (
            0.04640838396435143,
            [1.1256333048276321, 2.4410490736443204, 2.4813943516203754, -1.736683741328736],
        ),
    ];
    for k in 0..drawn(900) {
        let body = Body::tube(0.05 + 1.5 * r(), r()).unwrap();
        let [w1, w2, w3] = core::array::from_fn(|_| 5.0 * r() - 2.5);
        let state = State { theta: 0.3 + 1.2 * r(), w1, w2, w3 };
        let (air, mu) = (any_air(&mut r), 0.1 + 0.9 * r());
        let (body, state, air, mu) = match short.get(k) {
            Some((ell, y)) => {
                let mu = [0.1333, 0.5379][k];
                (Body::solid(*ell).unwrap(), State::from(*y), Losses::of(Law::AirQuadratic, 0.012), mu)
            }
            None => (body, state, air, mu),
        };
        let ask = Ask::on(coulomb(mu)).with_restitution(0.3).with_losses(air);
        let m = moved(&body, &Start::from(state), &ask, &[3.0]);
        let path = m.path.as_ref().unwrap();
        for pair in path.phases.windows(2) {
            let lasts = pair[1].time - pair[0].time;
            let bounced = path.impacts.iter().any(|hit| (hit.time - pair[0].time).abs() < 1e-12);
            if pair[0].kind != Kind::Flying || bounced || !(1e-4..1.0).contains(&lasts) {
                continue;
            }
            let Some(hit) = path.impacts.iter().find(|hit| hit.time == pair[1].time) else { continue };
            // The model follows one rim.
            let other =
                path.impacts.iter().any(|before| before.lands == Lands::Other && before.time <= hit.time);
            if other || hit.states[0].theta > FRAC_PI_2 - 0.01 {
                continue;
            }
            let lands = landing(&body, &pair[0].state, pair[0].slip.into(), &air, 2.0 * lasts);
            let off = lands.map_or(f64::INFINITY, |t| (t / lasts - 1.0).abs());
            assert!(off < 1e-5, "{body:?} {:?} {air:?}: {lasts} for {lands:?}", pair[0]);
            met += 1;
        }
    }
    assert!(met > drawn(60), "{met}");
}

#[test]
fn against_an_air_that_hardly_acts_a_body_lands_when_and_as_it_does_without_air() {
    let (mut r, mut met, mut upper) = (wander(646), 0, 0);
    for _ in 0..drawn(1500) {
        let body = any_profile(&mut r);
        let mut start =
            any_start(&body, &mut r).with_aloft(AboveTable::new(2.0 * r() * r(), 2.0 * r() - 1.0));
        let fast = 1.0 + 9.0 * r() * r();
        let State { theta, w1, w2, w3 } = start.state;
        start.state = State { theta, w1: fast * w1, w2: fast * w2, w3: fast * w3 };
        let ask = Ask::on(coulomb(0.3)).with_restitution(0.5).with_method(Method::Tolerance(1e-10));
        let air = Losses::of(Law::AirLinear, 1e-14);
        let until = [6.0];
        let Ok(Some(free)) = roll_with(&body, start, &until, &ask, || true) else { continue };
        let slowed = moved(&body, &start, &ask.with_losses(air), &until);
        let Some(known) = impacts(&free).first() else { continue };
        let found = impacts(&slowed)[0];
        let steep = known.velocities[0][2].abs();
        let off = (found.time - known.time).abs() * steep.min(1.0);
        // Of two rims that land together rounding says which one is first.
        let together = two_rims(&body) && (known.states[0].theta - FRAC_PI_2).abs() < 1e-8;
        let same = together || found.lands == known.lands;
        assert!(off < 1e-8 && same, "{body:?} {start:?}: {off:e}");
        met += 1;
        upper += usize::from(found.lands == Lands::Other);
    }
    assert!(met > drawn(900) && upper > drawn(60), "{met} {upper}");
}

#[test]
fn a_long_flight_against_the_air_can_be_interrupted_and_has_the_limit_of_a_motion() {
    let (body, air) = (Body::solid(0.5).unwrap(), Losses::of(Law::AirLinear, 1e-3));
    let state = State { theta: 1.0, w1: 40.0, w2: -30.0, w3: 60.0 };
    let start = Start::from(state).with_aloft(AboveTable::new(500.0, 0.0));
    let ask = Ask::on(coulomb(0.3)).with_restitution(0.5).with_losses(air);
    let mut asked = 0;
    let go_on = || {
        asked += 1;
        false
    };
    let stopped = roll_with(&body, start, &[20.0], &ask, go_on).unwrap();
    assert!(asked == 1 && stopped.is_none_or(|m| m.limit == Some(Limit::Interrupted)));
    let most = 3_000;
    let tired = moved(&body, &start, &ask.with_max_evaluations(most), &[20.0]);
    assert_eq!((tired.ending(), tired.limit), (Ending::Bounded, Some(Limit::Evaluations)));
    assert!(tired.evaluations > most / 2 && tired.evaluations < 3 * most, "{}", tired.evaluations);
    let whole = moved(&body, &start, &ask, &[20.0]);
    assert!(whole.limit.is_none() && whole.evaluations > 2 * most, "{}", whole.evaluations);
}

#[test]
fn a_can_that_is_dropped_flat_rises_level_over_its_spot_to_the_square_of_its_restitution() {
    for ell in [0.3, 1.0, 4.0] {
        let can = Body::solid(ell).unwrap();
        let state = State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3: 0.0 };
        for e in [0.3, 0.5, 1.0] {
            let height = 0.7;
            let fall = f64::sqrt(2.0 * height);
            let times = [fall, fall * (1.0 + e), fall * (1.0 + 2.0 * e) * 0.999];
            let ask = Ask::on(coulomb(0.5)).with_restitution(e).with_pose();
            let m = moved(&can, &dropped(state, [0.0; 2], height, 0.0), &ask, &times);
            let path = m.path.as_ref().unwrap();
            assert!((path.aloft[1].height - e * e * height).abs() < 1e-14, "{ell} {e}: {:?}", path.aloft);
            assert!(m.states.iter().all(|y| y.theta == FRAC_PI_2 && y.w2 == 0.0), "{:?}", m.states);
            let point = m.poses.as_ref().unwrap()[1].contact_point;
            assert!(point.x.abs() < 1e-15 && point.y == 0.0, "{point}");
            let hit = impacts(&m)[0];
            assert!(hit.hit == Hit::BothRims && (hit.impulse[2] - (1.0 + e) * fall).abs() < 1e-14);
        }
    }
}

#[test]
fn a_can_that_falls_flat_while_it_slides_across_grips_as_a_hoop_does() {
    for (ell, mu, e, u) in [(1.0, 0.1, 0.5, 2.0), (0.4, 0.8, 0.3, -1.0), (2.0, 0.02, 0.9, 0.7)] {
        let can = Body::solid(ell).unwrap();
        let state = State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3: 0.3 };
        let ask = Ask::on(coulomb(mu)).with_restitution(e);
        let m = moved(&can, &dropped(state, [0.0, u], 0.5, 0.0), &ask, &[1.1]);
        let hit = impacts(&m)[0];
        // Friction takes mu (1 + e) of the fall, or what stops the slip.
        let takes = (mu * (1.0 + e)).min(u.abs() / (1.0 + 1.0 / can.i3()));
        assert!((hit.impulse[1] + u.signum() * takes).abs() < 1e-13, "{hit:?}");
        assert!(hit.impulse[0] == 0.0 && hit.states[1].w1 == 0.0 && hit.states[1].w2 == 0.0);
        assert!((hit.states[1].w3 - (0.3 + u.signum() * takes / can.i3())).abs() < 1e-12);
    }
}

/// A random body and start in which both rims land at once.
fn both_come_down(r: &mut impl FnMut() -> f64) -> (Body, Start) {
    let body = Body::solid(0.1 + 2.0 * r()).unwrap();
    let (here, there) = (-2.0 * r() - 1e-3, -2.0 * r() - 1e-3);
    let mut speed = || 4.0 * r() - 2.0;
    let state = State { theta: FRAC_PI_2, w1: speed(), w2: (there - here) / (2.0 * body.ell()), w3: speed() };
    (body, dropped(state, [speed(), speed()], 0.0, here))
}

#[test]
fn two_rims_that_land_at_once_take_the_impulse_of_newton_and_euler_and_never_gain_energy() {
    let mut r = wander(645);
    for _ in 0..drawn(900) {
        let (body, start) = both_come_down(&mut r);
        let (mu, e) = (1.2 * r(), [0.0, 0.5, 1.0, r()][(4.0 * r()) as usize]);
        let m = moved(&body, &start, &Ask::on(coulomb(mu)).with_restitution(e), &[0.0, 1e-9]);
        if m.ending() == Ending::Landing {
            continue;
        }
        let hit = impacts(&m)[0];
        assert_eq!(hit.hit, Hit::BothRims);
        let [before, after] = [0, 1].map(|k| energy(&body, &hit.states[k], hit.velocities[k], 0.0));
        assert!((before - after - hit.lost).abs() < 1e-13 * before && hit.lost > -1e-13, "{hit:?}");
        let v = |k: usize| Vector3::from(centre(&body, &hit.states[k], hit.velocities[k]));
        assert!((v(1) - v(0) - Vector3::from(hit.impulse)).norm() < 1e-12);
        let [p_h, p_2, p_n] = hit.impulse;
        assert!(p_h.hypot(p_2) <= mu * p_n * (1.0 + 1e-12) + 1e-14);
        // The impulses of the rims about the centre, from the changes of w: P apart, and Q across apart.
        let [a, b] = hit.states;
        let lean = (body.i1() * (b.w2 - a.w2) + p_h) / body.ell();
        assert!(lean.abs() <= p_n * (1.0 + 1e-12), "a rim pulls: {hit:?}");
        let spun = body.i3() * (b.w3 - a.w3) + p_2;
        assert!(spun.abs() < 1e-12, "{spun:e}");
    }
}

#[test]
fn without_friction_each_of_two_rims_that_both_take_an_impulse_gives_back_its_share() {
    let (mut r, mut both) = (wander(646), 0);
    for _ in 0..drawn(300) {
        let (body, start) = both_come_down(&mut r);
        let e = r();
        let m = moved(&body, &start, &Ask::on(coulomb(0.0)).with_restitution(e), &[0.0, 1e-9]);
        let hit = impacts(&m)[0];
        let other = |k: usize| hit.velocities[k][2] + 2.0 * body.ell() * hit.states[k].w2;
        let [a, b] = hit.states;
        let apart = body.i1() * (b.w2 - a.w2) / body.ell();
        if apart.abs() < hit.impulse[2] * (1.0 - 1e-9) {
            assert!((hit.velocities[1][2] + e * hit.velocities[0][2]).abs() < 1e-13, "{hit:?}");
            assert!((other(1) + e * other(0)).abs() < 1e-13, "{hit:?}");
            both += 1;
        }
    }
    assert!(both > drawn(90), "{both}");
}

#[test]
fn the_mirror_image_of_a_landing_of_both_rims_is_its_landing_along_the_axis_and_across() {
    let (mut r, mut met) = (wander(647), 0);
    for _ in 0..drawn(600) {
        let (body, start) = both_come_down(&mut r);
        let (mu, e) = (1.2 * r(), r());
        let (y, Slip { u_h: u, u_2: v, .. }, AboveTable { lift, .. }) =
            (start.state, start.slip, start.aloft.unwrap());
        let ask = Ask::on(Table::from(Friction::coulomb(mu))).with_restitution(e);
        let first = |start: &Start| {
            let m = moved(&body, start, &ask, &[0.0, 1e-9]);
            impacts(&m).first().filter(|hit| hit.hit == Hit::BothRims).copied()
        };
        let Some(hit) = first(&start) else { continue };
        let after = |hit: &spincyl::motion::path::Strike, other: bool| {
            // As seen from the rim of the start, or from the other one.
            let (y, [u, v, lift]) = (hit.states[1], hit.velocities[1]);
            if (hit.lands == Lands::Other) == other {
                return [y.w1, y.w2, y.w3, u, v, lift];
            }
            let apart = 2.0 * body.ell();
            [y.w1, -y.w2, -y.w3, -u, apart * y.w1 - v, lift + apart * y.w2]
        };
        let one = after(&hit, false);
        let near = |a: [f64; 6], b: [f64; 6]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        // Across: w1, w3 and the slip across change their signs.
        let image = dropped(State { w1: -y.w1, w3: -y.w3, ..y }, [u, -v], 0.0, lift);
        let [w1, w2, w3, u_h, u_2, rise] = after(&first(&image).unwrap(), false);
        assert!(near(one, [-w1, w2, -w3, u_h, -u_2, rise]), "{start:?} {mu} {e}");
        // Along: the image of the lower rim is the other rim; w1 and w3 change their signs in the view from there.
        let apart = 2.0 * body.ell();
        let there = [y.w1, -y.w2, -y.w3, -u, apart * y.w1 - v, lift + apart * y.w2];
        let seen = State { theta: PI - FRAC_PI_2, w1: there[0], w2: there[1], w3: there[2] };
        let turned = first(&dropped(seen, [there[3], there[4]], 0.0, there[5])).unwrap();
        assert!(near(one, after(&turned, true)), "{start:?} {mu} {e}");
        met += 1;
    }
    assert!(met > drawn(500), "{met}");
}

/// The largest difference between two motions from one start, at the times that both reach and at their end, counted
/// from the same rim.
fn apart(a: &Motion, b: &Motion) -> f64 {
    let far = |x: [f64; 4], y: [f64; 4]| x.iter().zip(y).map(|(x, y)| (x - y).abs()).fold(0.0, larger);
    let of = |x: &State, y: &State| {
        let there = State { theta: PI - y.theta, w2: -y.w2, w3: -y.w3, ..*y };
        far((*x).into(), (*y).into()).min(far((*x).into(), there.into()))
    };
    let ends = a.event.zip(b.event).map(|(a, b)| of(&a.state, &b.state).max((a.time - b.time).abs()));
    a.states.iter().zip(&b.states).map(|(x, y)| of(x, y)).fold(ends.unwrap_or(0.0), larger)
}

/// Computes the motion from theta, w1, w2, w3 and a slip with two tolerances. Returns both motions, and their
/// difference.
fn within_both(body: &Body, y: [f64; 6], ask: &Ask, times: &[f64]) -> ([Motion; 2], f64) {
    let start = Start::from(State::from([y[0], y[1], y[2], y[3]])).with_slip(Slip::new(y[4], y[5]));
    let both = [1e-14, 1e-10].map(|tol| moved(body, &start, &ask.with_method(Method::Tolerance(tol)), times));
    let off = apart(&both[0], &both[1]);
    (both, off)
}

fn every(step: f64, from: f64, until: f64) -> Vec<f64> {
    (0..=((until - from) / step).round() as u32).map(|k| from + step * f64::from(k)).collect()
}

#[test]
fn a_flight_against_the_air_past_a_pole_keeps_its_tolerance() {
    let air = |viscosity: f64| Losses::of(Law::AirLinear, viscosity);
    // The axis of the hoop passes the vertical by 14 degrees, that of the other body by less than one degree.
    let hoop = Body::tube(0.0, 1.0).unwrap();
    let slender = Body::new(1.1085317262693506, 1.086334812278953, 0.35551432011294104).unwrap();
    let (y, z) = (
        [1.6168459359258593, -1.2319514815349855, 1.3056241339332186, -0.8154904289871444, -0.0211, -1.0295],
        [
            0.13835854671246567,
            -0.14426021667191916,
            1.651360636109556,
            -1.1767679402324835,
            1.62074629391011,
            -1.3683772202431663,
        ],
    );
    for (body, y, mu, e, b, until) in [
        (hoop, y, 0.1964, 0.3, 1.14e-4, 4.0),
        (slender, z, 0.5898619905786536, 1.0, 2.0648058334721639e-4, 3.0),
    ] {
        let ask = Ask::on(coulomb(mu)).with_restitution(e).with_losses(air(b));
        let (_, off) = within_both(&body, y, &ask, &every(0.05, 0.0, until));
        assert!(off < 3e-8, "{body:?}: {off:e}");
    }
}

#[test]
fn slips_of_both_rims_keep_their_tolerance_while_they_turn_to_one_direction() {
    // The rims of a rod with small moments of inertia turn to one direction much faster than they slow down.
    let rod = Body::new(1.9151667590741197, 0.12025126783619942, 0.10513151690477836).unwrap();
    let y = [
        0.7490459816857816,
        0.48113273452202054,
        -1.8707847981668144,
        -1.1243398734474375,
        1.1667356759103618,
        -1.5074638087615992,
    ];
    let ask = Ask::on(coulomb(0.2663430377513305)).with_restitution(0.0);
    let (_, off) = within_both(&rod, y, &ask, &every(0.0025, 0.9, 5.4));
    assert!(off < 3e-9, "{off:e}");
}

#[test]
fn a_chain_of_impacts_claims_what_it_makes_of_the_errors_of_a_few_steps() {
    // Eleven impacts multiply the error of the slip before them, of four steps in either run, by ten thousand.
    let body = Body::new(0.117015446393001, 1.796775761321279, 2.3077348288837123).unwrap();
    let y = [
        1.4958546314227419,
        2.453800278274771,
        -0.22177262061793793,
        -0.6498299097912659,
        -0.7959749278334902,
        -2.1805766016214316,
    ];
    let ask = Ask::on(coulomb(0.2858845242175299)).with_restitution(1.0);
    let ([fine, rough], off) = within_both(&body, y, &ask, &every(0.2, 0.0, 20.0));
    assert!(off <= 2.0 * (fine.error + rough.error), "{off:e} of {:e} and {:e}", fine.error, rough.error);
    assert!(rough.error < 1e-4 && fine.error < 1e-8, "{:e} {:e}", rough.error, fine.error);
}

#[test]
fn a_face_whose_landing_rounding_decides_claims_a_few_rockings() {
    // Rolling resistance damps the turning of the hoop until its face passes flat over the table.
    let hoop = Body::tube(0.0, 1.0).unwrap();
    let y = [
        0.29033129161259186,
        0.657440868798747,
        0.7313744973042814,
        0.9101601334248838,
        1.9301139553980633,
        1.548807112627859,
    ];
    let losses = Losses::of(Law::RollingResistance, 0.0695802930554293);
    let ask = Ask::on(coulomb(0.0572081968713129)).with_losses(losses);
    let ([fine, rough], off) = within_both(&hoop, y, &ask, &[0.0, 17.0, 20.0]);
    assert!([&fine, &rough].iter().all(|m| m.event.unwrap().ending == Ending::Face));
    assert!(off <= 2.0 * (fine.error + rough.error), "{off:e} of {:e} and {:e}", fine.error, rough.error);
    assert!(fine.error < 0.2 && (fine.event.unwrap().time - 17.336).abs() < 0.02, "{:?}", fine.event);
}

#[test]
fn bounces_that_are_summed_above_a_film_of_air_claim_what_the_film_does_at_a_contact() {
    let body = Body::new(0.743007364188049, 1.4450253562392847, 2.5937682163280527).unwrap();
    let state =
        State::from([0.6696691498500239, -0.23756640506288826, 1.232347931628101, -0.3763522090355309]);
    let start = Start::from(state)
        .with_slip(Slip::new(-0.257834306992858, 0.8479262272929056))
        .with_aloft(AboveTable::new(0.4789478567397365, -1.151243805702898));
    let losses = Losses::of(Law::AirFilm, 0.0063086151208995855);
    let ask = Ask::on(coulomb(0.058676901727985425)).with_restitution(0.0400865823815999).with_losses(losses);
    let of = |tol: f64| {
        let ask = ask.with_method(Method::Tolerance(tol));
        moved(&body, &start, &ask, &[0.0, 0.52745, 0.5275, 1.0])
    };
    let [fine, rough] = [1e-14, 1e-10].map(of);
    let off = apart(&fine, &rough);
    assert!(off > 1e-9 && off <= 2.0 * (fine.error + rough.error), "{off:e} of {:e}", rough.error);
}
