//! Bodies with a user-defined force and couple: closed forms, a slope as a constant force, air as a couple, and
//! balances of energy.

use crate::common::wander;
use nalgebra::{Vector2, Vector3};
use spincyl::body::Circle;
use spincyl::contact::slip::Friction;
use spincyl::contact::{Contact, Table};
use spincyl::custom::{self, Custom, InSi, Moment, MomentInSi, Push};
use spincyl::loss::{Law, Losses};
use spincyl::measured::{Measured, Tube};
use spincyl::motion::{AboveTable, Ask, Ending, Motion, Start, path::Kind, roll_with};
use spincyl::{Body, Error, Slip, State, steady};
use std::f64::consts::{FRAC_PI_2, PI};

const NO_COUPLE: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);

fn driven(
    body: &Body,
    start: Start,
    times: &[f64],
    ask: &Ask,
    drive: &dyn custom::DriveLaw,
) -> Result<Motion, Error> {
    let laws = Custom::default().with_drive(drive);
    custom::roll_with(body, start, times, ask, laws, || true).map(|found| found.expect("not interrupted"))
}

/// A random body, start (which may slip) and table with friction.
fn any(r: &mut impl FnMut() -> f64) -> (Body, Start, Table) {
    let body = match (5.0 * r()) as u8 {
        0 => Body::ball(0.4 * r() - 0.2, 0.4, 0.42),
        1 => Body::solid(0.02 + 0.5 * r()),
        2 => Body::tube(0.5 + 2.0 * r(), 0.8 * r()),
        3 => Body::ball(0.1, 0.4, 0.42).and_then(|ball| ball.with_theta_end(1.2 + r())),
        _ => Body::rounded_tube(0.4 + r(), 0.0, 0.05 + 0.3 * r()),
    };
    let mut speed = || 3.0 * r() - 1.5;
    let (w1, w2, w3, slip) = (speed(), 0.3 * speed(), 2.0 * speed(), [speed(), speed()]);
    let state = State { theta: 0.4 + r(), w1, w2, w3 };
    let (table, slips) = match (4.0 * r()) as u8 {
        0 => (Friction::coulomb(0.1 + 0.4 * r()).into(), true),
        1 => (Friction::coulomb(0.1 + 0.4 * r()).into(), false),
        2 => (Friction::Viscous { c: 0.1 + r() }.into(), true),
        _ => (Table::Rolling { mu: 0.2 + r() }, false),
    };
    let start = Start::from(state).with_slip(if slips { slip.into() } else { Slip::default() });
    (body.unwrap(), start.with_heading(6.0 * r() - 3.0).with_place([r(), r()]), table)
}

/// The same start in the air, with a restitution.
fn tossed(r: &mut impl FnMut() -> f64, start: Start, ask: Ask) -> (Start, Ask) {
    let aloft = AboveTable::new(0.05 + 0.5 * r(), 1.5 * r() - 0.5);
    (start.with_aloft(Some(aloft)), ask.with_restitution(0.7 * r()))
}

/// Whether a driven motion ends where a motion without a drive would continue: at the landing of a second circle or a
/// face.
fn lands_on_more(m: &Motion) -> bool {
    matches!(m.ending(), Ending::Face | Ending::Side)
}

fn states_apart(a: &State, b: &State) -> f64 {
    let by = [a.theta - b.theta, a.w1 - b.w1, a.w2 - b.w2, a.w3 - b.w3];
    by.iter().fold(0.0, |most: f64, x| if x.abs() <= most { most } else { x.abs() })
}

/// The largest difference of states, slips and ends of two motions, and the sum of their estimated errors.
fn apart(a: &Motion, b: &Motion) -> [f64; 2] {
    assert!(a.ending() == b.ending() || lands_on_more(a));
    let both = a.event.zip(b.event).filter(|_| !lands_on_more(a));
    let ends = both.map_or(0.0, |(a, b)| (a.time - b.time).abs());
    let off = a.states.iter().zip(&b.states).map(|(a, b)| states_apart(a, b)).fold(ends, f64::max);
    [off, a.error + b.error]
}

#[test]
fn a_ball_that_a_force_shakes_rolls_with_five_sevenths_of_its_acceleration() {
    let (ball, f, om) = (Body::ball(0.0, 0.4, 0.4).unwrap(), 0.2, 1.3);
    let shake = |_: &Body, now: &Moment| {
        Push::new(Vector2::new(f * (om * now.time).sin(), 0.5 * f * (om * now.time).cos()), NO_COUPLE)
    };
    let start = Start::from(State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3: 0.0 });
    for since in [0.0, 2.5] {
        let times: Vec<f64> = (0..=40).map(|i| since + 0.5 * f64::from(i)).collect();
        let ask = Ask::on(Friction::coulomb(0.5)).with_pose();
        let m = driven(&ball, start.with_time(since), &times, &ask, &shake).unwrap();
        assert_eq!((m.ending(), m.states.len()), (Ending::Done, 41));
        for (t, pose) in times.iter().zip(m.poses.unwrap()) {
            let along =
                |value: &dyn Fn(f64) -> f64, slope: f64| value(*t) - value(since) - slope * (t - since);
            let a = f * 5.0 / 7.0;
            let x = along(&|t| -a * (om * t).sin() / (om * om), -a * (om * since).cos() / om);
            let y = along(&|t| -0.5 * a * (om * t).cos() / (om * om), 0.5 * a * (om * since).sin() / om);
            let off = (pose.contact_point.x - x).hypot(pose.contact_point.y - y);
            assert!(off < 3e-9, "{t} {off:e} {:?} {x} {y}", pose.contact_point);
        }
    }
}

#[test]
fn a_ball_in_the_air_follows_the_force_and_the_couple_that_act_on_it() {
    let (ball, f, om, k) = (Body::ball(0.0, 0.4, 0.4).unwrap(), 0.3, 1.7, 0.2);
    let wind = |_: &Body, now: &Moment| {
        let force = Vector2::new(f * (om * now.time).sin(), 0.1 * now.height);
        Push::new(force, now.axes().transpose() * Vector3::new(0.0, 0.0, k))
    };
    let (height, lift) = (0.4, 1.0);
    let start = Start::from(State { theta: 1.1, w1: 0.3, w2: -0.2, w3: 0.4 }).with_slip(Slip::new(0.5, 0.2));
    let start = start.with_aloft(Some(AboveTable::new(height, lift))).with_heading(0.4);
    for since in [0.0, 2.5] {
        let times: Vec<f64> = (0..=20).map(|i| since + 0.1 * f64::from(i)).collect();
        let ask = Ask::on(Friction::coulomb(0.5)).with_pose().with_restitution(0.0);
        let m = driven(&ball, start.with_time(since), &times, &ask, &wind).unwrap();
        let all: Vec<_> = m.samples().collect();
        let (v, at) = (all[0].velocity(&ball).unwrap(), all[0].centre(&ball).unwrap());
        let turns = |y: &State| y.w1 * y.theta.sin() + y.w3 * y.theta.cos();
        for (i, t) in times.iter().enumerate() {
            let (now, t) = (all[i].centre(&ball).unwrap(), t - since);
            let whole = |t: f64| -f * (om * t).sin() / (om * om);
            let x = at.x + v.x * t + whole(since + t) - whole(since) + f * (om * since).cos() / om * t;
            // The height is that of a throw: h + v t - t^2/2.
            let y = at.y + v.y * t + 0.1 * t * t * (height / 2.0 + lift * t / 6.0 - t * t / 24.0);
            let off = [now.x - x, now.y - y, now.z - at.z - lift * t + 0.5 * t * t];
            assert!(off.iter().all(|off| off.abs() < 1e-9), "{t} {off:?}");
            let spin = turns(&m.states[i]) - turns(&m.states[0]) - k * t / 0.4;
            assert!(spin.abs() < 1e-9, "{t} {spin:e}");
        }
    }
}

#[test]
fn a_motor_turns_a_hoop_faster_until_friction_no_longer_holds_its_rim() {
    // (1 + 1) w' = m = k t, and the rim holds m/2 <= mu.
    let (hoop, k, mu) = (Body::tube(0.0, 1.0).unwrap(), 0.05, 0.3);
    let motor = |_: &Body, now: &Moment| Push::new(Vector2::zeros(), Vector3::new(0.0, 0.0, k * now.time));
    let start = Start::from(State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3: 1.0 });
    let times = [0.0, 5.0, 10.0, 20.0];
    let ask = Ask::on(Friction::coulomb(mu)).with_force();
    let m = driven(&hoop, start, &times, &ask, &motor).unwrap();
    for (t, y) in times.iter().zip(&m.states).take(3) {
        assert!((y.w3 - (1.0 + 0.25 * k * t * t)).abs() < 1e-9);
    }
    let path = m.path.as_ref().unwrap();
    let lets_go = 2.0 * mu / k;
    assert_eq!(path.phases[1].kind, Kind::Slipping);
    assert!((path.phases[1].time - lets_go).abs() < 1e-8, "{:?}", path.phases);
    // From then on the hoop runs with mu, and the motor turns it with k t - mu.
    let w = 1.0 + 0.25 * k * lets_go.powi(2) + 0.5 * k * (400.0 - lets_go.powi(2)) - mu * (20.0 - lets_go);
    assert!((m.states[3].w3 - w).abs() < 1e-7, "{} {w}", m.states[3].w3);
    assert!((m.forces.unwrap()[2].along.abs() - 0.25).abs() < 1e-9);
}

#[test]
fn a_constant_force_moves_a_body_as_a_slope_does_on_a_level_table_and_on_another_slope() {
    let mut r = wander(9_271);
    let (mut ended, mut slipped, mut struck) = (0, 0, 0);
    for i in 0..360 {
        let (body, start, table) = any(&mut r);
        let slope = 0.6 * r() - 0.3;
        let own = if i % 2 == 0 { 0.0 } else { 0.8 * r() - 0.4 };
        // In units with g cos(slope) as gravity a slope is level, and pulls with its tangent.
        let pace = (slope.cos() / own.cos()).sqrt();
        let times: Vec<f64> = (0..=20).map(|i| 0.25 * f64::from(i)).collect();
        let beside = own.cos() * slope.tan() - own.sin();
        let pull = |_: &Body, _: &Moment| Push::new(Vector2::new(beside, 0.0), NO_COUPLE);
        let ask = Ask::on(table).with_pose().with_slope(own);
        let (start, ask) = if i % 3 == 0 { tossed(&mut r, start, ask) } else { (start, ask) };
        let (e, m) = (ask.restitution, driven(&body, start, &times, &ask, &pull));
        let State { theta, w1, w2, w3 } = start.state;
        let fast = State { theta, w1: pace * w1, w2: pace * w2, w3: pace * w3 };
        let table = match table {
            Table::Rubs(Friction::Viscous { c }) => Friction::Viscous { c: c / pace }.into(),
            table => table,
        };
        let on_slope = Start::from(fast)
            .with_slip(Slip::new(pace * start.slip.u_h, pace * start.slip.u_2))
            .with_aloft(start.aloft.map(|aloft| AboveTable::new(aloft.height, pace * aloft.lift)))
            .with_heading(start.heading)
            .with_place(start.place);
        let later: Vec<f64> = times.iter().map(|t| t / pace).collect();
        let mut ask = Ask::on(table).with_pose().with_slope(slope);
        ask.restitution = e;
        let of = roll_with(&body, on_slope, &later, &ask, || true);
        let (m, of) = match (m, of) {
            (Ok(m), Ok(Some(of))) => (m, of),
            (Err(a), Err(b)) => {
                assert_eq!(std::mem::discriminant(&a), std::mem::discriminant(&b));
                continue;
            }
            (m, of) => panic!("{i} {body:?} {start:?} {table:?} {slope}: {m:?} {of:?}"),
        };
        let same = m.ending() == of.ending() || e.is_some() && lands_on_more(&m);
        assert!(same, "{i} {:?} {:?} {body:?} {start:?} {table:?} {slope}", m.ending(), of.ending());
        let claim = m.error + of.error + 1e-12;
        if m.ending() == Ending::Done && own != 0.0 {
            let path = m.path.as_ref().unwrap();
            let work = |i: usize| beside * m.samples().nth(i).unwrap().centre(&body).unwrap().x;
            assert!((path.lost + work(m.states.len() - 1) - work(0)).abs() < 1e-7, "{i} {}", path.lost);
        }
        for (a, b) in m.states.iter().zip(&of.states) {
            let b = State { theta: b.theta, w1: b.w1 / pace, w2: b.w2 / pace, w3: b.w3 / pace };
            let size = 1.0 + a.w1.abs().max(a.w2.abs()).max(a.w3.abs());
            let off = states_apart(a, &b);
            assert!(off < 3.0 * claim * size, "{i} {off:e} {claim:e} {body:?} {start:?} {table:?} {slope}");
        }
        let poses = m.poses.iter().flatten().zip(of.poses.iter().flatten());
        for (a, b) in poses {
            let off = (a.contact_point - b.contact_point).norm();
            assert!(off < 1e-6 + 10.0 * (m.pose_error + of.pose_error), "{i} {off:e}");
        }
        ended += usize::from(m.ending() != Ending::Done);
        struck += m.path.as_ref().map_or(0, |path| path.impacts.len());
        slipped += usize::from(m.path.is_some_and(|path| path.phases.len() > 1));
    }
    assert!(ended > 20 && slipped > 20 && struck > 100, "{ended} {slipped} {struck}");
}

#[test]
fn a_drive_that_resists_as_the_air_does_moves_a_body_as_the_air_does() {
    let (mut r, mut struck) = (wander(77_102), 0);
    for i in 0..180 {
        let (body, start, table) = any(&mut r);
        let b = 0.1 * r();
        let times: Vec<f64> = (0..=20).map(|i| 0.2 * f64::from(i)).collect();
        let drag = |_: &Body, now: &Moment| Push::new(Vector2::zeros(), -b * now.state.angular_velocity());
        let ask = Ask::on(table);
        let (start, ask) = if i % 3 == 0 { tossed(&mut r, start, ask) } else { (start, ask) };
        let beside = ask.with_losses(Losses::of(Law::AirLinear, b));
        let (Ok(m), Ok(Some(of))) =
            (driven(&body, start, &times, &ask, &drag), roll_with(&body, start, &times, &beside, || true))
        else {
            continue;
        };
        let [off, claim] = apart(&m, &of);
        assert!(off < 5.0 * claim + 1e-11, "{off:e} {claim:e} {body:?} {start:?} {table:?}");
        struck += m.path.as_ref().map_or(0, |path| path.impacts.len());
        let lost = |m: &Motion| m.path.as_ref().map_or(f64::NAN, |path| path.lost);
        let same = (lost(&m) - lost(&of)).abs() < 1e-7 || m.ending() != of.ending();
        assert!(same, "{} {}", lost(&m), lost(&of));
    }
    assert!(struck > 50, "{struck}");
}

/// A user-defined drive: a force that turns and grows, and a couple whose axis turns with time along the table.
fn stirs(_: &Body, now: &Moment) -> Push {
    let (sin, cos) = (0.7 * now.time).sin_cos();
    let force = Vector2::new(0.2 * cos, 0.1 * sin) - 0.05 * now.velocity
        + 0.02 * Vector2::new(now.slip.u_h, now.slip.u_2 * now.phi.cos())
        - 0.01 * now.contact_point.coords;
    let couple = Vector3::new(0.1 * sin, 0.05, 0.06 * cos) + 0.01 * Vector3::new(now.psi.sin(), 0.0, 0.0);
    Push::new(force, now.axes().transpose() * couple)
}

#[test]
fn energy_with_heat_and_what_is_lost_is_conserved_where_a_drive_gives_and_takes() {
    let mut r = wander(4_402);
    let (mut worked, mut kept) = (0.0f64, 0);
    for i in 0..180 {
        let (body, start, table) = any(&mut r);
        let times: Vec<f64> = (0..=20).map(|i| 0.25 * f64::from(i)).collect();
        let slope = if i % 2 == 0 { 0.0 } else { 0.5 * r() - 0.25 };
        let ask = Ask::on(table).with_losses(Losses::of(Law::AirQuadratic, 0.01)).with_pose();
        let ask = ask.with_slope(slope);
        let (start, ask) = if i % 3 == 0 { tossed(&mut r, start, ask) } else { (start, ask) };
        let Ok(m) = driven(&body, start, &times, &ask, &stirs) else { continue };
        let Some(path) = m.path.as_ref().filter(|_| m.ending() == Ending::Done) else { continue };
        let of = |i: usize| {
            let (now, y) = (m.samples().nth(i).unwrap(), m.states[i]);
            let (centre, v) = (now.centre(&body).unwrap(), now.velocity(&body).unwrap());
            let turns = body.i1() * (y.w1 * y.w1 + y.w2 * y.w2) + body.i3() * y.w3 * y.w3;
            0.5 * (v.norm_squared() + turns) + slope.cos() * centre.z - slope.sin() * centre.x
        };
        let knocked: f64 = path.impacts.iter().map(|hit| hit.lost).sum();
        let (first, last) = (of(0), of(20) + path.heat + path.lost + knocked);
        let off = (last - first).abs();
        assert!(off < 1e-8 * (1.0 + first.abs()), "{off:e} {body:?} {start:?} {table:?}");
        worked = worked.min(path.lost);
        kept += 1;
    }
    assert!(worked < -0.03 && kept > 20, "{worked} {kept}");
}

#[test]
fn a_table_that_is_told_from_another_direction_has_the_same_motion() {
    let mut r = wander(660_018);
    for _ in 0..60 {
        let (body, start, table) = any(&mut r);
        let by = 5.0 * r();
        let times: Vec<f64> = (0..=16).map(|i| 0.25 * f64::from(i)).collect();
        let ask = Ask::on(table).with_pose();
        let start = start.with_place([0.0; 2]);
        let turned = |body: &Body, now: &Moment| {
            let back = nalgebra::Rotation2::new(-by);
            let mut then = *now;
            then.phi -= by;
            then.velocity = back * now.velocity;
            then.contact_point = back * now.contact_point;
            let push = stirs(body, &then);
            Push::new(back.inverse() * push.force, push.couple)
        };
        let there = start.with_heading(start.heading + by);
        let both = (driven(&body, start, &times, &ask, &stirs), driven(&body, there, &times, &ask, &turned));
        let (Ok(m), Ok(of)) = both else { continue };
        let [off, claim] = apart(&m, &of);
        assert!(off < 3.0 * claim + 1e-11, "{off:e} {claim:e}");
    }
}

#[test]
fn a_driven_motion_goes_on_from_any_of_its_moments_also_in_the_air() {
    let mut r = wander(31_117);
    let mut flying = 0;
    let wind = |_: &Body, now: &Moment| {
        let (sin, cos) = (0.7 * now.time).sin_cos();
        let force = Vector2::new(0.2 * cos, 0.1 + 0.1 * now.height) - 0.1 * now.velocity;
        Push::new(force, now.axes().transpose() * Vector3::new(0.1 * sin, 0.05, 0.06 * cos))
    };
    for _ in 0..200 {
        let (body, start, table) = any(&mut r);
        let ask = Ask::on(table).with_pose().with_slope(0.2 * r());
        let (start, ask) = tossed(&mut r, start, ask);
        let times: Vec<f64> = (0..=12).map(|i| 0.25 * f64::from(i)).collect();
        let Ok(m) = driven(&body, start, &times, &ask, &wind) else { continue };
        let (Some(path), Some(poses)) = (m.path.as_ref(), m.poses.as_ref()) else { continue };
        let struck = path.impacts.first().map_or(f64::INFINITY, |hit| hit.time);
        let later =
            |i: &usize| times[*i] > struck && path.aloft.get(*i).is_some_and(|aloft| aloft.height > 0.0);
        let Some(from) = (0..m.states.len()).find(later) else { continue };
        let (aloft, pose) = (path.aloft[from], poses[from]);
        let again = Start::from(m.states[from])
            .with_slip(path.slip[from])
            .with_aloft(Some(aloft))
            .with_time(times[from])
            .with_heading(pose.phi.rest)
            .with_place([pose.contact_point.x, pose.contact_point.y]);
        let of = driven(&body, again, &times[from..], &ask, &wind).unwrap();
        assert_eq!(m.ending(), of.ending());
        for (i, (a, b)) in m.states[from..].iter().zip(&of.states).enumerate() {
            let off = states_apart(a, b);
            assert!(off < 10.0 * (m.error + of.error) + 1e-9, "{i} {off:e} {body:?} {start:?} {table:?}");
        }
        flying += 1;
    }
    assert!(flying > 30, "{flying}");
}

#[test]
fn a_force_tips_a_can_that_lies_on_its_side_as_a_slope_does() {
    // It tips about the rim that carries it, which is half a radius from its centre and a radius below.
    let (can, rolls) = (Body::solid(0.5).unwrap(), Ask::on(Friction::coulomb(2.0)));
    let start = Start::from(State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3: 0.0 });
    let ending = |f: f64| {
        let pull = move |_: &Body, _: &Moment| Push::new(Vector2::new(f, 0.0), NO_COUPLE);
        driven(&can, start, &[0.0, 0.01], &rolls, &pull).unwrap()
    };
    assert_eq!(ending(0.49).ending(), Ending::Side);
    let m = ending(0.6);
    assert_eq!(m.ending(), Ending::Done);
    let turns = 0.1 / (can.i1() + 1.25) * 0.01;
    assert!((m.states[1].w2 / turns - 1.0).abs() < 1e-3, "{:?} {turns}", m.states[1]);
}

#[test]
fn a_body_on_its_upper_circle_is_driven_as_the_same_body_told_from_its_other_end() {
    let mut r = wander(12_004);
    let mut compared = 0;
    for _ in 0..60 {
        let (depth, height) = (0.1 + 0.3 * r(), 0.6 + 0.4 * r());
        let circle = |radius, depth| Circle { radius, depth, fillet: 0.0 };
        let (low, high) = (circle(1.0, depth), circle(0.8, depth - height));
        let told = |circle: Circle| Circle { depth: -circle.depth, ..circle };
        let body = Body::profile(&[low, high], 0.3, 0.4).unwrap();
        let other = Body::profile(&[told(high), told(low)], 0.3, 0.4).unwrap();
        let mut speed = || r() - 0.5;
        let (w1, w2, w3, slip) = (speed(), 0.2 * speed(), 3.0 * speed(), [speed(), speed()]);
        let theta = body.theta_end() + 0.3 + 0.5 * r();
        let start = Start::from(State { theta, w1, w2, w3 }).with_slip(slip.into()).with_heading(r());
        let turned = Start::from(State { theta: PI - theta, w1, w2: -w2, w3: -w3 })
            .with_slip(Slip::from(slip.map(|u| -u)))
            .with_heading(start.heading + PI);
        let pushes = |_: &Body, now: &Moment| {
            let (sin, cos) = (0.7 * now.time).sin_cos();
            let force = Vector2::new(0.2 * cos, 0.1) - 0.1 * now.velocity - 0.05 * now.contact_point.coords;
            Push::new(force, now.axes().transpose() * Vector3::new(0.1 * sin, 0.05, 0.06 * cos))
        };
        let times: Vec<f64> = (0..=16).map(|i| 0.25 * f64::from(i)).collect();
        let ask = Ask::on(Friction::coulomb(0.3));
        let both = [(&body, start), (&other, turned)];
        let [Ok(m), Ok(of)] = both.map(|(body, start)| driven(body, start, &times, &ask, &pushes)) else {
            continue;
        };
        assert_eq!((m.ending(), m.states.len()), (of.ending(), of.states.len()));
        for (a, b) in m.states.iter().zip(&of.states) {
            let b = State { theta: PI - b.theta, w1: b.w1, w2: -b.w2, w3: -b.w3 };
            let off = states_apart(a, &b);
            assert!(off < 3.0 * (m.error + of.error) + 1e-10, "{off:e} {a:?} {b:?}");
            compared += 1;
        }
    }
    assert!(compared > 300, "{compared}");
}

#[test]
fn what_a_drive_does_not_know_is_an_error_that_names_it() {
    let body = Body::solid(0.5).unwrap();
    let start = Start::from(State { theta: 1.0, w1: 0.1, w2: 0.0, w3: 0.2 });
    let still = |_: &Body, _: &Moment| Push::new(Vector2::zeros(), NO_COUPLE);
    let coulomb = Ask::on(Friction::coulomb(0.3));
    let named = |ask: &Ask, start: Start| match driven(&body, start, &[0.0, 1.0], ask, &still) {
        Err(Error::OutOfRange { name, .. }) => name,
        found => panic!("{found:?}"),
    };
    assert_eq!(named(&coulomb.with_turning(0.1), start), "turning");
    assert_eq!(named(&coulomb.with_losses(Losses::of(Law::RollingResistance, 0.1)), start), "losses");
    assert_eq!(named(&Ask::on(Table::of(Contact::Smooth, 0.0)), start), "contact");
    let lies = Start::from(State { theta: 0.0, w1: 0.0, w2: 0.0, w3: 1.0 });
    assert_eq!(named(&coulomb, lies), "theta");
    let fails = |_: &Body, now: &Moment| {
        Push::new(Vector2::new(if now.time > 0.5 { f64::NAN } else { 0.0 }, 0.0), NO_COUPLE)
    };
    let found = driven(&body, start, &[0.0, 1.0], &coulomb, &fails);
    assert!(matches!(found, Err(Error::OutOfRange { name: "t", .. })), "{found:?}");
}

#[test]
fn a_drive_in_newtons_and_seconds_is_the_same_in_natural_units() {
    let coin = Measured::tube(&Tube::solid(24e-3, 2e-3, 8e-3)).unwrap();
    let scale = coin.scale();
    let in_si = InSi::new(scale, |now: &MomentInSi| {
        Push::new(
            Vector2::new(0.01 * (20.0 * now.time).sin(), 0.0) - 0.01 * now.velocity,
            now.axes.transpose() * Vector3::new(0.0, 2e-5, 0.0) - 1e-8 * now.w,
        )
    });
    let natural = |_: &Body, now: &Moment| {
        let velocity = now.velocity.map(|u| scale.metres_per_second(u));
        let force = Vector2::new(0.01 * (20.0 * scale.seconds(now.time)).sin(), 0.0) - 0.01 * velocity;
        let w = now.state.angular_velocity().map(|w| scale.radians_per_second(w));
        let couple = now.axes().transpose() * Vector3::new(0.0, 2e-5, 0.0) - 1e-8 * w;
        Push::new(force.map(|f| scale.force(f)), couple.map(|m| scale.couple(m)))
    };
    let (start, ask) = (steady::state(coin.body(), 1.0).unwrap(), Ask::on(Friction::coulomb(0.4)));
    let seconds = [0.0, 0.02, 0.05];
    let laws = Custom::default().with_drive(&in_si);
    let m = coin.roll_under(start, &seconds, &ask, laws, || true).unwrap().unwrap();
    let times = seconds.map(|t| scale.time(t));
    let of = driven(coin.body(), start.into(), &times, &ask, &natural).unwrap();
    for (a, b) in m.readings().zip(&of.states) {
        let w = scale.radians_per_second(b.angular_velocity().norm());
        assert!(
            (a.theta - b.theta).abs() < 1e-11 && (a.angular_velocity.norm() - w).abs() < 1e-10 * w,
            "{a:?} {b:?}"
        );
    }
    assert_eq!(of.states.len(), 3);
}
