//! Motions on a turntable: closed forms, the balance of energy, symmetries, and bodies that the table carries.

use crate::common::rim::place;
use crate::common::wander;
use spincyl::contact::{Friction, Table, slip};
use spincyl::loss::{Law, Losses};
use spincyl::motion::{AboveTable, Ask, Ending, Motion, Start, roll_with};
use spincyl::{Body, Contact, Slip, State};
use std::f64::consts::{FRAC_PI_2, PI};

fn rolled(body: &Body, start: Start, times: &[f64], ask: &Ask) -> Motion {
    roll_with(body, start, times, &ask.with_pose(), || true).unwrap().unwrap()
}

fn ball() -> Body {
    Body::ball(0.0, 0.4, 0.4).unwrap()
}

const STATE: State = State { theta: 1.0, w1: 0.6, w2: 0.2, w3: -0.5 };

fn drilling(y: &State) -> f64 {
    y.theta.sin() * y.w1 + y.theta.cos() * y.w3
}

/// A ball that only turns about the vertical.
fn spun(w: f64) -> State {
    State { theta: 1.0, w1: 1f64.sin() * w, w2: 0.0, w3: 1f64.cos() * w }
}

/// The place of the centre of mass along x, y and z, its velocity, the angular momentum about the vertical, and the
/// kinetic energy, all relative to the laboratory.
struct Seen {
    centre: [f64; 3],
    velocity: [f64; 2],
    spins: f64,
    moving: f64,
}

fn seen(body: &Body, om: f64, m: &Motion, i: usize) -> Seen {
    let (y, pose, path) = (m.states[i], m.poses.as_ref().unwrap()[i], m.path.as_ref());
    let ((sin, cos), at) = (pose.phi.radians().sin_cos(), place(body, y.theta));
    let AboveTable { height: high, lift, .. } =
        path.and_then(|path| path.aloft.get(i).copied()).unwrap_or_default();
    let [v_h, v_2] = slip::centre_velocity(body, &y, path.map_or(Slip::default(), |path| path.slip[i]));
    let point = [pose.contact_point.x, pose.contact_point.y];
    let velocity = [v_h * cos - v_2 * sin - om * point[1], v_h * sin + v_2 * cos + om * point[0]];
    let centre = [point[0] - at.lever[0] * cos, point[1] - at.lever[0] * sin, at.height[0] + high];
    let turns = body.i1() * (y.w1 * y.w1 + y.w2 * y.w2) + body.i3() * y.w3 * y.w3;
    let rise = lift + at.lever[0] * y.w2;
    let across = centre[0] * velocity[1] - centre[1] * velocity[0];
    Seen {
        centre,
        velocity,
        spins: body.i1() * y.w1 * at.s + body.i3() * y.w3 * at.c + across,
        moving: 0.5 * (turns + velocity[0] * velocity[0] + velocity[1] * velocity[1] + rise * rise),
    }
}

/// The energy that has become heat, or was taken by losses and impacts.
fn spent(m: &Motion, i: usize) -> f64 {
    let path = m.path.as_ref().unwrap();
    let struck: f64 = path.impacts.iter().filter(|hit| hit.time < m.times[i]).map(|hit| hit.lost).sum();
    path.dissipated[i] + path.work_lost.get(i).copied().unwrap_or(0.0) + struck
}

/// The quantity E - om L_z, whose sum with the spent energy is conserved on a level turntable.
fn balance(body: &Body, ask: &Ask, m: &Motion, i: usize) -> f64 {
    let Seen { centre, spins, moving, .. } = seen(body, ask.turning, m, i);
    let ([x, _, z], (sin, cos)) = (centre, ask.slope.sin_cos());
    moving + z * cos - x * sin - ask.turning * spins + spent(m, i)
}

fn within(next: &mut impl FnMut() -> f64, low: f64, high: f64) -> f64 {
    low + (high - low) * next()
}

fn patched(ask: &Ask) -> bool {
    matches!(ask.table, Table::Rubs(Friction::Coulomb { patch, .. }) if patch > 0.0)
}

/// A random body, start and law on a table that turns.
fn drawn(next: &mut impl FnMut() -> f64) -> (Body, Start, Ask) {
    let body = match (next() * 4.0) as usize {
        0 => Body::solid(within(next, 0.05, 3.0)),
        1 => Body::tube(within(next, 0.0, 3.0), next()),
        2 => Body::rounded_tube(within(next, 0.3, 3.0), 0.5, within(next, 0.05, 0.3)),
        _ => {
            let i3 = within(next, 0.3, 0.5);
            let ell = if next() < 0.5 { 0.0 } else { within(next, -0.4, 0.4) };
            Body::ball(ell, i3 * within(next, 0.8, 1.2), i3)
        }
    }
    .unwrap();
    let theta = within(next, 0.3, 1.3);
    let [w1, w2, w3] = [(); 3].map(|()| within(next, -2.0, 2.0));
    let mut start = Start::from(State { theta, w1, w2, w3 }).with_heading(within(next, -PI, PI));
    start = start.with_place([within(next, -1.5, 1.5), within(next, -1.5, 1.5)]);
    let mut ask = match (next() * 4.0) as usize {
        0 => Ask::default(),
        1 => Ask::on(Friction::Viscous { c: within(next, 0.1, 2.0) }),
        kind => {
            let mu = within(next, 0.05, 0.6);
            let patch = if kind == 2 { within(next, 0.001, 0.1) } else { 0.0 };
            Ask::on(Friction::Coulomb { mu, fixed: mu * within(next, 1.0, 1.5), patch })
        }
    };
    if ask.table.rubs() && next() < 0.7 {
        start = start.with_slip(Slip::new(within(next, -1.0, 1.0), within(next, -1.0, 1.0)));
    }
    let on_patch = patched(&ask);
    ask = ask.with_losses(match (next() * 5.0) as usize {
        0 => Losses::of(Law::RollingResistance, within(next, 0.001, 0.05)) + Losses::of(Law::AirLinear, 0.01),
        1 if !on_patch => Losses::of(Law::Drilling, within(next, 0.01, 0.2)),
        2 if !on_patch => Losses::of(Law::DryContour, within(next, 0.01, 0.2)),
        3 if !on_patch => Losses::of(Law::ViscousContour, 0.02) + Losses::of(Law::AirQuadratic, 0.01),
        3 => Losses::of(Law::AirQuadratic, 0.02),
        _ => Losses::NONE,
    });
    if ask.table.rubs() && !on_patch && next() < 0.5 {
        ask = ask.with_restitution(0.9 * next());
        if next() < 0.6 {
            start = start.with_aloft(AboveTable::new(within(next, 0.05, 0.5), within(next, -0.5, 0.5)));
        }
    }
    (body, start, ask.with_turning(within(next, -1.0, 1.0)))
}

#[test]
fn a_ball_on_a_turntable_goes_round_at_two_sevenths_of_its_rate_and_on_a_slope_also_across_it() {
    let (om, once) = (0.8, 2.0 * PI / (2.0 / 7.0 * 0.8));
    for beta in [0.0, 0.1f64] {
        let ask = Ask::default().with_turning(om).with_slope(beta);
        let start = Start::from(STATE).with_heading(0.7).with_place([1.0, 0.5]);
        let m = rolled(&ball(), start, &[0.0, once], &ask);
        let [a, b] = [0, 1].map(|i| seen(&ball(), om, &m, i).centre);
        let drift = 2.5 * beta.sin() / om * once;
        assert!((a[0] - b[0]).hypot(a[1] + drift - b[1]) < 1e-10, "{a:?} {b:?} {drift}");
    }
}

#[test]
fn a_disk_on_a_turntable_moves_as_the_model_of_three_dimensions_says() {
    let (disk, y) = (Body::solid(0.1).unwrap(), State { theta: 1.3, w1: 0.4, w2: 0.1, w3: -1.2 });
    let start = Start::from(y).with_place([1.5, 0.0]);
    // Far beyond the side of its rim, which a wide body passes.
    let m = rolled(&disk, start, &[5.0], &Ask::default().with_turning(0.5).with_beyond());
    let (state, pose) = (m.states[0], m.poses.as_ref().unwrap()[0]);
    let off = [
        state.theta - 1.696_025_077_2,
        pose.phi.radians() + 0.518_645_409_2,
        pose.contact_point.x - 2.827_889_354_3,
        pose.contact_point.y + 1.878_502_448_6,
    ];
    assert!(off.iter().all(|x| x.abs() < 2e-10), "{off:?}");
}

#[test]
fn on_a_turntable_energy_less_its_rate_times_the_angular_momentum_stays_with_what_is_spent() {
    let (mut next, mut followed, mut hops, mut creeps, mut ends) = (wander(11), 0, 0, 0, 0);
    for _ in 0..400 {
        let (body, start, ask) = drawn(&mut next);
        let still = ask.losses.with(Law::AirLinear, 0.0).with(Law::AirQuadratic, 0.0);
        let (ask, times) = (ask.with_losses(still), [0.0, 0.5, 1.0, 2.0, 4.0]);
        let m = match roll_with(&body, start, &times, &ask.with_pose(), || true) {
            Ok(m) => m.unwrap(),
            Err(e) => {
                assert!(!e.to_string().starts_with("turning"), "{e} {body:?} {start:?} {ask:?}");
                continue;
            }
        };
        let path = m.path.as_ref().unwrap();
        (followed, hops) = (followed + 1, hops + usize::from(!path.impacts.is_empty()));
        creeps += usize::from(patched(&ask) && path.heat > 0.0);
        ends += usize::from(m.event.is_some());
        for i in 1..m.states.len() {
            let off = (balance(&body, &ask, &m, i) - balance(&body, &ask, &m, 0)).abs();
            let size = m.states[i].w1.abs().max(m.states[i].w3.abs()).max(3.0).powi(2);
            let claim = 1e-12 * size + 20.0 * size * (m.error + m.pose_error);
            assert!(off < claim, "{off:e} {claim:e} at {}: {body:?} {start:?} {ask:?}", m.times[i]);
        }
    }
    assert!(followed > 350 && hops > 30 && creeps > 30 && ends > 40, "{followed} {hops} {creeps} {ends}");
}

#[test]
fn on_a_tilted_turntable_the_same_sum_grows_by_the_couples_of_gravity_and_of_the_air() {
    // Its rate is om (sin(beta) y - m_z), by Gauss's quadrature with two points per interval.
    let (mut next, mut followed, mut hops) = (wander(12), 0, 0);
    for _ in 0..120 {
        let (body, start, ask) = drawn(&mut next);
        let ask = ask.with_slope(within(&mut next, -0.5, 0.5));
        let (end, count) = (2.0, 1000);
        let h = end / f64::from(count);
        let place = |k: i32, x: f64| h * (f64::from(k) + 0.5 + x / 12f64.sqrt());
        let mut times: Vec<f64> = (0..count).flat_map(|k| [place(k, -1.0), place(k, 1.0)]).collect();
        times.insert(0, 0.0);
        times.push(end);
        let Ok(Some(m)) = roll_with(&body, start, &times, &ask.with_pose(), || true) else { continue };
        if m.states.len() < times.len() || m.error > 1e-9 {
            continue;
        }
        let path = m.path.as_ref().unwrap();
        (followed, hops) = (followed + 1, hops + usize::from(!path.impacts.is_empty()));
        let losses = |law: Law| ask.losses.coefficient(law);
        let rate = |i: usize| {
            let y = &m.states[i];
            let whole = (y.w1 * y.w1 + y.w2 * y.w2 + y.w3 * y.w3).sqrt();
            let air = (losses(Law::AirLinear) + losses(Law::AirQuadratic) * whole) * drilling(y);
            ask.slope.sin() * seen(&body, ask.turning, &m, i).centre[1] + air
        };
        let work = ask.turning * 0.5 * h * (1..=2 * count as usize).map(rate).sum::<f64>();
        let gained = balance(&body, &ask, &m, times.len() - 1) - balance(&body, &ask, &m, 0);
        assert!((gained - work).abs() < 1e-5, "{gained} {work} {body:?} {start:?} {ask:?}");
    }
    assert!(followed > 40 && hops > 5, "{followed} {hops}");
}

#[test]
fn on_a_table_that_turns_the_other_way_the_mirror_image_moves() {
    let (mut next, mut followed) = (wander(13), 0);
    for _ in 0..100 {
        let (body, start, ask) = drawn(&mut next);
        let ask = ask.with_slope(within(&mut next, -0.3, 0.3));
        let Ok(Some(m)) = roll_with(&body, start, &[1.5], &ask.with_pose(), || true) else { continue };
        let State { theta, w1, w2, w3 } = start.state;
        let mirrored = Start::from(State { theta, w1: -w1, w2, w3: -w3 })
            .with_slip(Slip::new(start.slip.u_h, -start.slip.u_2))
            .with_heading(-start.heading)
            .with_place([start.place[0], -start.place[1]])
            .with_aloft(start.aloft);
        let other = rolled(&body, mirrored, &[1.5], &ask.with_turning(-ask.turning));
        assert_eq!(m.states.len(), other.states.len());
        followed += m.states.len();
        for (a, b) in m.states.iter().zip(&other.states) {
            let off = [a.theta - b.theta, a.w1 + b.w1, a.w2 - b.w2, a.w3 + b.w3];
            let claim = 1e-12 + 4.0 * (m.error + other.error);
            assert!(off.iter().all(|x| x.abs() < claim), "{off:?} {claim:e} {body:?} {start:?} {ask:?}");
        }
    }
    assert!(followed > 30, "{followed}");
}

#[test]
fn a_table_that_hardly_turns_moves_a_body_as_a_table_at_rest() {
    let (mut next, mut followed) = (wander(14), 0);
    for _ in 0..100 {
        let (body, start, ask) = drawn(&mut next);
        let run = |om: f64| roll_with(&body, start, &[1.5], &ask.with_turning(om).with_pose(), || true);
        let (Ok(Some(m)), Ok(Some(rests))) = (run(1e-300), run(0.0)) else { continue };
        // On a table at rest a body may go on where two rims or a face end the motion on this one.
        let end = m.event.map_or(f64::INFINITY, |event| event.time);
        if m.states.len() < rests.states.len()
            && matches!(m.ending(), Ending::Side | Ending::Face)
            && end < 1.5
        {
            continue;
        }
        assert_eq!(m.states.len(), rests.states.len(), "{body:?} {start:?} {ask:?}");
        followed += m.states.len();
        for (a, b) in m.states.iter().zip(&rests.states) {
            let off = [a.theta - b.theta, a.w1 - b.w1, a.w2 - b.w2, a.w3 - b.w3];
            let claim = 1e-11 + 4.0 * (m.error + rests.error);
            assert!(off.iter().all(|x| x.abs() < claim), "{off:?} {claim:e} {body:?} {start:?} {ask:?}");
        }
    }
    assert!(followed > 30, "{followed}");
}

#[test]
fn a_ball_that_only_drills_follows_the_table_as_it_stops_on_one_at_rest() {
    let (om, mu, length) = (1.5, 0.3, 0.02);
    let patch = Ask::on(Friction::Coulomb { mu, fixed: mu, patch: 0.05 });
    let drags = Ask::on(Friction::coulomb(mu)).with_losses(Losses::of(Law::Drilling, length));
    for ask in [patch, drags, patch.with_slope(0.0), drags.with_table(Contact::Rolling)] {
        let times: Vec<f64> = (0..60).map(f64::from).collect();
        for w in [-0.7, 0.4, 2.5] {
            let m = rolled(&ball(), spun(w).into(), &times, &ask.with_turning(om));
            let rests = rolled(&ball(), spun(w - om).into(), &times, &ask);
            let turns = |i: usize| drilling(&m.states[i]) - om;
            for (i, y) in rests.states.iter().enumerate().take(m.states.len()) {
                assert!(
                    (turns(i) - drilling(y)).abs() < 1e-10,
                    "{ask:?} {w} {i}: {} {}",
                    turns(i),
                    drilling(y)
                );
            }
            assert!(m.states.len() >= rests.states.len(), "{ask:?} {w}");
            // Where the other one stops, this one turns with the table for ever.
            assert!(rests.event.is_none_or(|stop| drilling(&stop.state).abs() < 1e-12));
            let heat = |m: &Motion, i: usize| spent(m, i);
            let last = rests.states.len() - 1;
            assert!((heat(&m, last) - heat(&rests, last)).abs() < 1e-10);
        }
    }
}

#[test]
fn a_ball_that_rolling_resistance_holds_is_carried_by_the_table_and_else_rolls_off() {
    // Held while om^2 r <= delta and om^2 r <= mu.
    let (om, mu, delta) = (0.5, 0.3, 0.1);
    let losses = Losses::of(Law::RollingResistance, delta);
    let patch = Ask::on(Friction::Coulomb { mu, fixed: mu, patch: 0.05 });
    for ask in [patch, Ask::on(Friction::coulomb(mu))] {
        for (r, held) in [(0.99 * delta / (om * om), true), (1.01 * delta / (om * om), false)] {
            let ask = ask.with_losses(losses).with_turning(om);
            let m = rolled(&ball(), Start::from(spun(om)).with_place([0.0, r]), &[0.0, 1.0], &ask);
            let stops = m.event.is_some_and(|event| event.ending == Ending::Stops && event.time == 0.0);
            assert_eq!(stops, held, "{ask:?} {r}");
        }
    }
    // It is put down at rest, rolls a little, and is carried in the end.
    let ask = patch.with_losses(losses).with_turning(om);
    let m = rolled(
        &ball(),
        Start::from(spun(0.0)).with_place([0.1, 0.0]).with_slip(Slip::new(0.0, -0.05)),
        &[300.0],
        &ask,
    );
    assert_eq!(m.ending(), Ending::Stops);
    let y = m.event.unwrap().state;
    assert!((drilling(&y) - om).abs() < 1e-9 && y.w2.abs() < 1e-9, "{y:?}");
    // Without drilling friction nothing makes it turn with the table.
    let ask = Ask::on(Friction::coulomb(mu)).with_losses(losses).with_turning(om);
    let m = rolled(&ball(), Start::from(spun(0.2)).with_place([0.1, 0.0]), &[0.0, 50.0], &ask);
    let (a, b) = (seen(&ball(), om, &m, 0), seen(&ball(), om, &m, 1));
    let (sin, cos) = (50.0 * om).sin_cos();
    assert!(m.event.is_none() && (drilling(&m.states[1]) - 0.2).abs() < 1e-12);
    let off = [b.centre[0] - 0.1 * cos, b.centre[1] - 0.1 * sin];
    assert!(off.iter().all(|x| x.abs() < 1e-10) && a.moving < b.moving + 1e-12, "{off:?}");
}

#[test]
fn a_ball_that_falls_on_a_turntable_is_thrown_along_it_by_friction() {
    // The impulse mu (1 + e) v, or what stops the slip: 2/7 of the velocity of the table.
    let (om, e, v, r) = (0.8, 0.6, 1.0, 2.0);
    let start = Start::from(spun(0.0)).with_place([r, 0.0]).with_heading(0.4);
    for mu in [0.1, 0.2, 0.5] {
        let slip = [-om * r * 0.4f64.sin(), -om * r * 0.4f64.cos()];
        let ask = Ask::on(Friction::coulomb(mu)).with_restitution(e).with_turning(om);
        let m =
            rolled(&ball(), start.with_slip(slip.into()).with_aloft(AboveTable::new(0.0, -v)), &[0.5], &ask);
        let thrown = seen(&ball(), om, &m, 0).velocity;
        let expected = (mu * (1.0 + e) * v).min(om * r * 2.0 / 7.0);
        assert!((thrown[1] - expected).abs() < 1e-13 && thrown[0].abs() < 1e-13, "{thrown:?} {expected}");
        let centre = seen(&ball(), om, &m, 0).centre;
        assert!((centre[0] - r).abs() < 1e-13 && (centre[1] - 0.5 * expected).abs() < 1e-13, "{centre:?}");
    }
}

#[test]
fn a_flight_above_a_turntable_is_that_above_a_table_at_rest() {
    let (mut next, om) = (wander(15), 0.7);
    for _ in 0..30 {
        let (body, start, ask) = drawn(&mut next);
        let ask = Ask::on(Friction::coulomb(0.3)).with_restitution(0.5).with_losses(ask.losses);
        let start = start.with_aloft(AboveTable::new(3.0, 0.5));
        let (sin, cos) = start.heading.sin_cos();
        let [x, y] = start.place;
        let table = [om * (x * sin - y * cos), om * (x * cos + y * sin)];
        let over = start.with_slip(Slip::new(start.slip.u_h - table[0], start.slip.u_2 - table[1]));
        let Ok(Some(m)) = roll_with(&body, over, &[0.5], &ask.with_turning(om).with_pose(), || true) else {
            continue;
        };
        let rests = rolled(&body, start, &[0.5], &ask);
        let [a, b] = [seen(&body, om, &m, 0), seen(&body, 0.0, &rests, 0)];
        let pairs = a.centre.into_iter().chain(a.velocity).zip(b.centre.into_iter().chain(b.velocity));
        for (a, b) in pairs {
            assert!((a - b).abs() < 1e-12, "{a} {b} {body:?} {start:?}");
        }
    }
}

#[test]
fn a_face_and_two_rims_end_a_motion_on_a_turntable() {
    let ask = Ask::on(Friction::coulomb(0.3)).with_restitution(0.5).with_turning(0.5);
    let y = State { theta: 0.3, w1: 0.0, w2: 0.1, w3: 0.0 };
    let can = Body::solid(0.5).unwrap();
    let flat = State { theta: 0.0, w1: 0.0, w2: 0.0, w3: 0.3 };
    let m = rolled(&can, Start::from(flat).with_aloft(AboveTable::new(0.3, 0.0)), &[5.0], &ask);
    assert_eq!(m.ending(), Ending::Face);
    let lies = State { theta: FRAC_PI_2, ..y };
    let m = rolled(
        &can,
        Start::from(State { w2: 0.0, ..lies }).with_aloft(AboveTable::new(0.3, 0.0)),
        &[5.0],
        &ask,
    );
    assert_eq!(m.ending(), Ending::Side);
    let m = rolled(&can, Start::from(State { theta: 1.5, ..y }), &[60.0], &ask);
    assert!(matches!(m.ending(), Ending::Face | Ending::Side), "{:?}", m.event);
}

#[test]
fn what_is_not_computed_on_a_turntable_is_refused_by_name() {
    let (disk, y) = (Body::solid(0.1).unwrap(), State { theta: 1.2, w1: 0.5, w2: 0.0, w3: 1.5 });
    let patch = Friction::Coulomb { mu: 0.3, fixed: 0.3, patch: 0.01 };
    let drags = Losses::of(Law::Drilling, 0.01);
    for ask in [
        Ask::default().with_turning(f64::NAN),
        Ask::on(Contact::Smooth).with_turning(0.5),
        Ask::default().with_losses(drags + Losses::of(Law::DryContour, 0.01)).with_turning(0.5),
        Ask::on(patch).with_losses(Losses::of(Law::ViscousContour, 0.01)).with_turning(0.5),
        Ask::default()
            .with_losses(drags + Losses::of(Law::RollingResistance, 0.01))
            .with_turning(0.5)
            .with_slope(0.1),
    ] {
        let found = roll_with(&disk, Start::from(y), &[1.0], &ask, || true);
        assert!(found.is_err_and(|e| e.to_string().starts_with("turning")), "{ask:?}");
    }
}
