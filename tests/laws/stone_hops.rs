//! Stones that fly, land and bounce: conserved quantities, a stone that is a ball, mirror images, and motions
//! reversed in time.

use crate::common::{drawn, larger, wander};
use crate::flight::other_law;
use crate::stone::{apart, turned};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use spincyl::contact::slip::Friction;
use spincyl::contact::{ImpactLaw, Table};
use spincyl::custom::{Custom, roll_stone};
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::{AfterImpact, Hit, Kind};
use spincyl::motion::{AboveTable, Ask, Ending, Motion, Start, roll_with};
use spincyl::stone::{self, Ellipsoid, StoneState};
use spincyl::{Body, Error, Slip, State};

type Stones = Motion<StoneState>;

fn hops(stone: &Ellipsoid, start: &Start<StoneState>, ask: &Ask, times: &[f64]) -> Stones {
    stone::roll(stone, *start, times, &ask.with_pose(), || true).unwrap().unwrap()
}

/// A random pebble, egg, rattleback or other stone that is light or heavy at its ends.
fn any_pebble(r: &mut impl FnMut() -> f64) -> Ellipsoid {
    let axes = core::array::from_fn(|_| 0.25 + 0.75 * r());
    let stone = match (4.0 * r()) as u8 {
        0 => Ellipsoid::uniform(axes),
        1 => Ellipsoid::egg(0.5 + 0.4 * r(), 1.0, 0.2 * (r() - 0.5)),
        2 => Ellipsoid::rattleback(
            [1.0, 0.3, 0.2],
            Some([0.02, 0.2, 0.21]),
            0.1 * r(),
            Some([0.0, 0.0, -0.06]),
        ),
        _ => {
            let (a, b) = (0.1 + 0.3 * r(), 0.1 + 0.3 * r());
            let c = (a - b).abs() + (0.1 + 0.8 * r()) * (a + b - (a - b).abs());
            let angles = [3.0 * r(), 2.0 * r() - 1.0];
            let offset = [0, 1, 2].map(|i: usize| 0.4 * (r() - 0.5) * axes[i]);
            Ellipsoid::new(axes, turned([a, b, c], angles), offset)
        }
    };
    stone.unwrap()
}

fn any_vertical(r: &mut impl FnMut() -> f64) -> [f64; 3] {
    let (c, around) = (2.0 * r() - 1.0, 6.3 * r());
    let s = (1.0 - c * c).sqrt();
    [s * around.cos(), s * around.sin(), c]
}

/// A random stone in the air, just above the table, on it, or landing.
fn any_drop(r: &mut impl FnMut() -> f64) -> (Ellipsoid, Start<StoneState>) {
    let fast = [0.0, 0.3, 1.0, 3.0][(4.0 * r()) as usize];
    let w = core::array::from_fn(|_| if r() < 0.15 { 0.0 } else { fast * (2.0 * r() - 1.0) });
    let state = StoneState { vertical: any_vertical(r), w };
    let start = Start::from(state).with_slip(if r() < 0.3 {
        Slip::default()
    } else {
        Slip::new(r() - 0.5, r() - 0.5)
    });
    let start = start.with_heading(if r() < 0.5 { 0.0 } else { 6.0 * r() - 3.0 });
    let start = match (4.0 * r()) as u8 {
        0 => start.with_aloft(AboveTable::new(1.5 * r(), 2.0 * r() - 1.0)),
        1 => start.with_aloft(AboveTable::new(0.0, -r())),
        2 => start.with_aloft(AboveTable::new(4.0 * r(), 0.0)),
        _ => start,
    };
    (any_pebble(r), start)
}

/// A start with special values: upright or on its side, at rest up to rounding, just above the table or on it.
fn odd_drop(r: &mut impl FnMut() -> f64) -> (Ellipsoid, Start<StoneState>) {
    let mut odd = || [0.0f64, 0.0, 1e-300, 1e-160, -1e-16, 1e-8, 0.1, -0.3, 1.0][(9.0 * r()) as usize];
    let w = core::array::from_fn(|_| odd());
    let slip = [odd(), odd()];
    let aloft = [odd().abs(), odd()];
    let vertical = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.0, 0.8]];
    let start = Start::from(StoneState { vertical: vertical[(5.0 * r()) as usize], w });
    let start =
        start.with_slip(slip.into()).with_aloft(if r() < 0.7 { Some(AboveTable::from(aloft)) } else { None });
    (any_pebble(r), start)
}

fn any_table(r: &mut impl FnMut() -> f64) -> Table {
    match (7.0 * r()) as u8 {
        6 => {
            let (mu, patch) = (0.1 + 0.4 * r(), 10f64.powf(-1.0 - 3.0 * r()));
            Table::Rubs(Friction::Coulomb { mu, fixed: mu, patch })
        }
        0 => Table::Smooth,
        1 => Table::Rubs(Friction::Viscous { c: 2.0 * r() }),
        2 => Table::Rubs(Friction::Coulomb { mu: 0.1 + 0.3 * r(), fixed: 0.5 + 0.3 * r(), patch: 0.0 }),
        _ => Table::Rubs(Friction::coulomb(0.05 + 0.9 * r())),
    }
}

/// The rotation from the axes of a stone's slip to the laboratory axes of its pose.
fn of_slips(vertical: [f64; 3], orientation: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    // The smallest turn from upright; near upside down the library of quaternions would lose half of its digits.
    let [x, y, z] = vertical;
    let (across, about) = (x.hypot(y), Vector3::new(y, -x, 0.0));
    let about = if across > 0.0 { about / across } else { Vector3::x() };
    let upright = UnitQuaternion::from_scaled_axis(about * across.atan2(z));
    orientation * upright.inverse()
}

/// The energy of a stone whose lowest point has this velocity and height.
fn energy(stone: &Ellipsoid, y: &StoneState, [u, v, lift]: [f64; 3], height: f64) -> f64 {
    let (n, w, r) =
        (Vector3::from(y.vertical), Vector3::from(y.w), Vector3::from(stone.lowest_point(y.vertical)));
    let to = of_slips(y.vertical, UnitQuaternion::identity());
    let velocity = to * Vector3::new(u, v, lift) - w.cross(&r);
    let inertia = Matrix3::from_fn(|i, j| stone.inertia()[i][j]);
    0.5 * (w.dot(&(inertia * w)) + velocity.norm_squared()) + height - r.dot(&n)
}

#[test]
fn energy_heat_and_what_impacts_take_are_constant_and_no_stone_is_below_the_table() {
    let (mut r, mut flights, mut rests, mut hits) = (wander(70), 0, 0, [0; 6]);
    for k in 0..drawn(540) {
        let (stone, mut start) = if k % 3 == 0 { odd_drop(&mut r) } else { any_drop(&mut r) };
        let table = any_table(&mut r);
        if table == Table::Smooth && start.aloft.is_none() {
            start.slip = Slip::default();
        }
        let e = if r() < 0.3 { [0.0, 1.0][(2.0 * r()) as usize] } else { r() };
        // On a patch that drills no bounce grips, so that with e = 1 they never end.
        let e = if matches!(table, Table::Rubs(Friction::Coulomb { patch, .. }) if patch > 0.0) {
            0.9 * e
        } else {
            e
        };
        let mut ask = Ask::on(table).with_restitution(Some(e)).with_impact_law(other_law(k));
        if r() < 0.3 {
            let law = [Law::AirLinear, Law::AirQuadratic][(2.0 * r()) as usize];
            ask.losses = Losses::of(law, 10f64.powf(-3.0 + 2.5 * r()));
        }
        let times: Vec<f64> = (0..60).map(|k| 0.05 * f64::from(k)).collect();
        let m = match stone::roll(&stone, start, &times, &ask.with_pose(), || true) {
            // More than one contact force, or none, at the start.
            Err(Error::Painleve { .. }) => continue,
            found => found.unwrap().unwrap(),
        };
        let path = m.path.as_ref().unwrap();
        let whole = |i: usize| {
            let (Slip { u_h: u, u_2: v, .. }, AboveTable { height, lift, .. }) =
                (path.slip[i], path.aloft[i]);
            let before = path.impacts.iter().filter(|hit| hit.time < m.times[i]);
            energy(&stone, &m.states[i], [u, v, lift], height)
                + path.dissipated[i]
                + path.work_lost.get(i).unwrap_or(&0.0)
                + before.map(|hit| hit.lost).sum::<f64>()
        };
        for i in 0..m.times.len() {
            let off = (whole(i) - whole(0)).abs();
            assert!(
                off < 1e-12 * (1.0 + whole(0)) + m.error,
                "{k} {stone:?} {start:?} {ask:?}: {off:e} of {:e} at {}",
                m.error,
                m.times[i]
            );
            assert!(m.states[i].w.iter().all(|w| w.is_finite()), "{k} {:?}", m.states[i]);
            assert!(path.aloft[i].height >= -1e-13, "{k}: {:?}", path.aloft[i]);
            assert!(
                path.kinds[i] == Kind::Flying || path.aloft[i] == AboveTable::default(),
                "{k} {:?}",
                path.aloft[i]
            );
        }
        for hit in &path.impacts {
            let [p, q, n] = hit.impulse;
            if let Table::Rubs(Friction::Coulomb { mu, fixed, .. }) = table {
                let most = if hit.hit == Hit::Sticks { fixed } else { mu };
                assert!(p.hypot(q) <= most * n * (1.0 + 1e-9) + 1e-14, "{k} {hit:?}");
            }
            let gains = ask.impact_law != ImpactLaw::Stronge;
            assert!((gains || hit.lost >= -1e-14 * whole(0)) && n > 0.0, "{k} {hit:?}");
            hits[hit.hit as usize] += 1;
        }
        flights += path.kinds.iter().filter(|kind| **kind == Kind::Flying).count();
        let ends = m.event.map(|event| event.ending);
        assert!(
            !matches!(ends, Some(Ending::LiftOff | Ending::Bounded)),
            "{k} {ends:?} {:?} {stone:?} {start:?} {ask:?}",
            m.limit
        );
        rests += usize::from(path.kinds.last() != Some(&Kind::Flying));
    }
    assert!(
        flights > 500 && rests > 20 && [0, 1, 3].iter().all(|k| hits[*k] > 10),
        "{flights} {rests} {hits:?}"
    );
}

#[test]
fn a_ball_hops_as_a_stone_as_it_does_as_a_body() {
    let (mut r, mut bounces) = (wander(71), 0);
    for k in 0..drawn(150) {
        let offset = if r() < 0.3 { 0.0 } else { 0.6 * (r() - 0.5) };
        let (i3, i1) = (0.3 + 0.2 * r(), 0.3 + 0.2 * r());
        let body = Body::ball(offset, i1, i3).unwrap();
        let stone =
            Ellipsoid::new([1.0; 3], [[i1, 0.0, 0.0], [0.0, i1, 0.0], [0.0, 0.0, i3]], [0.0, 0.0, offset])
                .unwrap();
        let theta = 0.1 + 2.9 * r();
        let [w1, w2, w3] = core::array::from_fn(|_| 3.0 * (r() - 0.5));
        let (s, c) = f64::sin_cos(theta);
        let slip = if r() < 0.3 { [0.0; 2] } else { [r() - 0.5, r() - 0.5] };
        let aloft = [[1.5 * r(), 2.0 * r() - 1.0], [0.0, -r()]][(2.0 * r()) as usize];
        let e = if r() < 0.2 { 0.0 } else { 0.9 * r() };
        let mut ask = Ask::on(any_table(&mut r)).with_restitution(Some(e));
        if r() < 0.2 {
            ask.losses = Losses::of(Law::AirQuadratic, 0.1 * r());
        }
        if r() < 0.3 {
            ask = ask.with_slope(0.3 * r());
        }
        let times: Vec<f64> = (0..16).map(|k| 0.2 * f64::from(k)).collect();
        let ask = ask.with_pose();
        let there = Start::from(State { theta, w1, w2, w3 })
            .with_slip(slip.into())
            .with_aloft(AboveTable::from(aloft));
        let here = Start::from(StoneState { vertical: [s, 0.0, c], w: [w1, w2, w3] });
        let here = here.with_slip(slip.into()).with_aloft(AboveTable::from(aloft));
        let (a, b) = (hops(&stone, &here, &ask, &times), roll_with(&body, there, &times, &ask, || true));
        let b = b.unwrap().unwrap();
        let (p, q) = (a.path.as_ref().unwrap(), b.path.as_ref().unwrap());
        let claim = 1e-11 + 10.0 * (a.error + b.error);
        for i in 0..a.states.len().min(b.states.len()) {
            let (y, z) = (&a.states[i], &b.states[i]);
            let spin = z.w1 * z.theta.sin() + z.w3 * z.theta.cos();
            let off = [
                y.vertical[2] - z.theta.cos(),
                y.w[2] - z.w3,
                y.spin() - spin,
                p.aloft[i].height - q.aloft[i].height,
                p.aloft[i].lift - q.aloft[i].lift,
                p.slip[i].speed() - q.slip[i].speed(),
                p.dissipated[i] - q.dissipated[i],
            ];
            let off = off.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let [at, there] = [
                a.poses.as_ref().unwrap()[i].centre,
                b.samples().nth(i).unwrap().centre(&body).unwrap().into(),
            ];
            let moved = (0..3).fold(0.0, |most: f64, k| larger(most, (at[k] - there[k]).abs()));
            let places = 1e-11 + 10.0 * (a.pose_error + b.pose_error);
            assert!(moved < places, "{k} {ask:?}: centre off by {moved:e}, {places:e} at {}", a.times[i]);
            assert!(off < claim, "{k} {body:?} {there:?} {ask:?}: {off:e}, {claim:e} at {}", a.times[i]);
        }
        assert_eq!(a.event.map(|e| e.ending), b.event.map(|e| e.ending), "{k}");
        for (x, z) in p.impacts.iter().zip(&q.impacts).take(3) {
            let off = [x.time - z.time, x.lost - z.lost, x.impulse[2] - z.impulse[2]];
            let off = off.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            assert!(x.hit == z.hit && off < claim, "{k} {x:?} {z:?} {off:e}");
            bounces += 1;
        }
    }
    assert!(bounces > 50, "{bounces}");
}

#[test]
fn a_ball_that_drills_and_bounces_on_a_patch_loses_its_spin_as_if_it_rested_there_for_the_time_of_the_impulses()
 {
    let inertia = [[0.4, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.0, 0.4]];
    let ball = Ellipsoid::new([1.0; 3], inertia, [0.0; 3]).unwrap();
    let table = Table::Rubs(Friction::Coulomb { mu: 0.3, fixed: 0.3, patch: 0.05 });
    let start = Start::from(StoneState { vertical: [0.0, 0.0, 1.0], w: [0.0, 0.0, 2.0] });
    let m = hops(
        &ball,
        &start.with_aloft(AboveTable::new(1.0, 0.0)),
        &Ask::on(table).with_restitution(0.7),
        &[30.0],
    );
    let path = m.path.as_ref().unwrap();
    let speed = 2f64.sqrt();
    let slows = |k: i32| 3.0 * core::f64::consts::PI / 16.0 * 0.3 * 0.05 * 1.7 / 0.4 * speed * 0.7f64.powi(k);
    let mut spin = 2.0;
    for (k, hit) in path.impacts.iter().take(20).enumerate() {
        spin -= slows(k as i32);
        assert!((hit.states[1].w[2] - spin).abs() < 1e-13, "{k}: {}", hit.states[1].w[2] - spin);
        assert!((hit.couple - 0.4 * -slows(k as i32)).abs() < 1e-13 && hit.hit == Hit::Creeps, "{hit:?}");
        if k == 3 {
            // By an independent model.
            assert!((spin - 1.865481653141).abs() < 1e-12);
        }
    }
    // On the table it drills on until it has stopped, at 2 I/((3 pi/16) mu eps) in all.
    let last = path.phases.last().unwrap();
    assert!(
        path.impacts.last().unwrap().after == AfterImpact::Stays
            && last.kind != Kind::Flying
            && m.error < 1e-10,
        "{last:?}"
    );
}

#[test]
fn a_stone_that_falls_on_the_end_of_an_axis_bounces_straight_up_and_does_not_turn() {
    // The contact is below the centre, so that nothing couples; e^2 of the height is left each time.
    for (axis, mu, e) in [(0, 0.3, 0.5), (1, 0.8, 0.9), (2, 0.0, 0.7)] {
        let stone = Ellipsoid::rattleback([1.0, 0.6, 0.4], Some([0.1, 0.2, 0.25]), 0.3, None).unwrap();
        let mut vertical = [0.0; 3];
        vertical[axis] = 1.0;
        let start = Start::from(StoneState { vertical, w: [0.0; 3] }).with_aloft(AboveTable::new(0.5, 0.0));
        let m = hops(&stone, &start, &Ask::on(Friction::coulomb(mu)).with_restitution(e), &[0.9, 3.0]);
        let path = m.path.as_ref().unwrap();
        let (mut time, mut up) = (1.0, 1.0);
        for hit in path.impacts.iter().take(6) {
            let off = [hit.time - time, hit.velocities[0][2] + up, hit.velocities[1][2] - e * up];
            assert!(off.into_iter().all(|x| x.abs() < 1e-13), "{axis}: {off:?}");
            up *= e;
            time += 2.0 * up;
        }
        let still = StoneState { vertical, w: [0.0; 3] };
        assert!(m.states.iter().all(|y| apart(y, &still) < 1e-14), "{m:?}");
    }
}

#[test]
fn the_mirror_image_of_a_stone_hops_as_the_mirror_image_of_its_motion() {
    let mut r = wander(72);
    for k in 0..drawn(60) {
        let (axes, mu, e) = ([1.0, 0.3 + 0.5 * r(), 0.3 + 0.3 * r()], 0.1 + 0.6 * r(), 0.8 * r());
        let stone = |twist: f64| {
            Ellipsoid::rattleback(axes, Some([0.1, 0.2, 0.25]), twist, Some([0.02, 0.0, -0.05])).unwrap()
        };
        let twist = r() - 0.5;
        let vertical @ [a, b, c] = any_vertical(&mut r);
        let w @ [p, q, s] = core::array::from_fn(|_| 2.0 * r() - 1.0);
        let [u, v] = [r() - 0.5, r() - 0.5];
        let here = Start::from(StoneState { vertical, w })
            .with_slip(Slip::new(u, v))
            .with_aloft(AboveTable::new(r(), 0.0));
        let there =
            Start::from(StoneState { vertical: [a, -b, c], w: [-p, q, -s] }).with_slip(Slip::new(u, -v));
        let there = there.with_aloft(here.aloft);
        let ask = Ask::on(Friction::coulomb(mu)).with_restitution(e);
        let [x, y] = [(stone(twist), here), (stone(-twist), there)]
            .map(|(stone, start)| hops(&stone, &start, &ask, &[0.8, 1.6, 2.4]));
        for (x, y) in x.states.iter().zip(&y.states) {
            let ([a, b, c], [d, e, f]) = (y.vertical, y.w);
            let image = StoneState { vertical: [a, -b, c], w: [-d, e, -f] };
            assert!(apart(x, &image) < 1e-11, "{k}: {:e}", apart(x, &image));
        }
        let [x, y] = [x, y].map(|m| m.path.unwrap().impacts.len());
        assert!(x == y && x > 0, "{k} {x} {y}");
    }
}

#[test]
fn without_friction_and_with_full_restitution_the_reversed_motion_goes_back() {
    let (mut r, mut back) = (wander(73), 0);
    for k in 0..drawn(60) {
        let stone = any_pebble(&mut r);
        let w = core::array::from_fn(|_| 2.0 * r() - 1.0);
        let state = StoneState { vertical: any_vertical(&mut r), w };
        let start = Start::from(state)
            .with_slip(Slip::new(r() - 0.5, r() - 0.5))
            .with_aloft(AboveTable::new(0.3 + r(), 0.0));
        let ask = Ask::on(Table::Smooth).with_restitution(1.0);
        let m = hops(&stone, &start, &ask, &[3.0]);
        let (end, path) = (m.states[0], m.path.as_ref().unwrap());
        if path.kinds[0] != Kind::Flying || path.impacts.len() > 6 {
            continue;
        }
        // Nothing horizontal changes: the velocity of the centre and L_z stay.
        let turned = StoneState { vertical: end.vertical, w: end.w.map(|w| -w) };
        let AboveTable { height, lift, .. } = path.aloft[0];
        let there = Start::from(turned)
            .with_slip(Slip::new(-path.slip[0].u_h, -path.slip[0].u_2))
            .with_aloft(AboveTable::new(height, -lift));
        let n = hops(&stone, &there, &ask, &[3.0]);
        let home = StoneState { w: n.states[0].w.map(|w| -w), ..n.states[0] };
        let off = apart(&home, &state)
            .max((n.path.as_ref().unwrap().aloft[0].height - start.aloft.unwrap().height).abs());
        assert!(off < 1e-9, "{k}: {off:e}");
        back += 1;
    }
    assert!(back > 5, "{back}");
}

#[test]
fn friction_without_limit_tends_to_a_table_on_which_a_stone_rolls() {
    let (mut r, mut both) = (wander(74), 0);
    for k in 0..drawn(60) {
        let stone = any_pebble(&mut r);
        let w = core::array::from_fn(|_| 2.0 * r() - 1.0);
        let start = Start::from(StoneState { vertical: any_vertical(&mut r), w });
        let start =
            start.with_slip(Slip::new(r() - 0.5, r() - 0.5)).with_aloft(AboveTable::new(0.2 + r(), 0.0));
        let landed = |table: Table| {
            let m = hops(&stone, &start, &Ask::on(table).with_restitution(0.4), &[3.0]);
            m.path.unwrap().impacts.first().copied()
        };
        // Where the slip of a landing cannot be stopped before the normal impulse, there is no such table.
        let Some(rough) = landed(Table::Rolling { mu: f64::INFINITY }) else { continue };
        for mu in [1e4, 1e6] {
            let found = landed(Friction::coulomb(mu).into()).unwrap();
            let off = (0..3).map(|i| (found.states[1].w[i] - rough.states[1].w[i]).abs());
            let off = off.fold((found.velocities[1][2] - rough.velocities[1][2]).abs(), larger);
            assert!(off < 100.0 / mu && found.hit == Hit::Sticks, "{k} {mu}: {off:e}");
        }
        both += 1;
    }
    assert!(both > 10, "{both}");
}

#[test]
fn a_stone_that_spins_fast_leaves_the_table_from_its_slip_as_the_cube_of_the_time_and_comes_down() {
    let stone = Ellipsoid::egg(0.7, 1.0, 0.1).unwrap();
    // An egg that spins on its side with much energy rises so fast that it jumps (Shimomura et al. 2006).
    let start = Start::from(stone.spinning(7.0, 1.3, 0.0)).with_slip(Slip::new(0.4, 0.0));
    let ask = Ask::on(Friction::coulomb(0.4)).with_restitution(0.3);
    let m = hops(&stone, &start, &ask, &[20.0]);
    let phases = &m.path.as_ref().unwrap().phases;
    let Some(jump) = phases.iter().zip(phases.iter().skip(1)).find(|(before, at)| {
        before.kind == Kind::Slipping && at.kind == Kind::Flying && at.aloft == AboveTable::default()
    }) else {
        panic!("{phases:?}")
    };
    let after = [1e-3, 2e-3].map(|t| jump.1.time + t);
    let m = hops(&stone, &start, &ask, &after);
    let [low, high] = [0, 1].map(|i| m.path.as_ref().unwrap().aloft[i].height);
    assert!(low > 0.0 && (high / low - 8.0).abs() < 0.1, "{low:e} {high:e}");
}

#[test]
fn a_law_of_friction_of_the_user_that_is_constant_is_coulombs() {
    let (stone, start) = any_drop(&mut wander(75));
    let start = start.with_aloft(AboveTable::new(0.4, 0.0));
    let times = [0.5, 1.5, 2.5];
    let ask = Ask::on(Friction::coulomb(0.3)).with_restitution(0.5);
    let own = Custom::default().with_friction(&|_: f64| 0.3);
    let m = hops(&stone, &start, &ask, &times);
    let n = roll_stone(&stone, start, &times, &ask, own, || true).unwrap().unwrap();
    for (a, b) in m.states.iter().zip(&n.states) {
        assert!(apart(a, b) < 1e-8, "{:e}", apart(a, b));
    }
    assert_eq!(m.path.unwrap().impacts.len(), n.path.unwrap().impacts.len());
}
