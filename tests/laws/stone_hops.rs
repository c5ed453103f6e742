//! Stones that fly, land and bounce: what is kept, a stone that is a ball, mirror images, and the way back.

use crate::common::{drawn, wander};
use crate::stone::turned;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use spincyl::contact::Table;
use spincyl::contact::slip::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::{Hit, Kind};
use spincyl::motion::{Ask, Ending, Motion, Start, roll_with};
use spincyl::stone::{self, Ellipsoid, StoneState};
use spincyl::{Body, Error, State};

type Stones = Motion<StoneState>;

fn hops(stone: &Ellipsoid, start: &Start<StoneState>, ask: &Ask, times: &[f64]) -> Stones {
    stone::roll(stone, *start, times, &ask.with_pose(true), || true).unwrap().unwrap()
}

/// A pebble, an egg, a rattleback or any other stone that is light or heavy at its ends.
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

/// A stone in the air, just above the table, on it, or coming down.
fn any_drop(r: &mut impl FnMut() -> f64) -> (Ellipsoid, Start<StoneState>) {
    let fast = [0.0, 0.3, 1.0, 3.0][(4.0 * r()) as usize];
    let w = core::array::from_fn(|_| if r() < 0.15 { 0.0 } else { fast * (2.0 * r() - 1.0) });
    let state = StoneState { vertical: any_vertical(r), w };
    let start = Start::from(state).with_slip(if r() < 0.3 { [0.0; 2] } else { [r() - 0.5, r() - 0.5] });
    let start = start.with_heading(if r() < 0.5 { 0.0 } else { 6.0 * r() - 3.0 });
    let start = match (4.0 * r()) as u8 {
        0 => start.with_aloft([1.5 * r(), 2.0 * r() - 1.0]),
        1 => start.with_aloft([0.0, -r()]),
        2 => start.with_aloft([4.0 * r(), 0.0]),
        _ => start,
    };
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

/// The rotation by which the components of a slip are turned to the laboratory of the pose.
fn of_slips(vertical: [f64; 3], orientation: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    let up = Vector3::from(vertical);
    let upright = UnitQuaternion::rotation_between(&up, &Vector3::z())
        .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), core::f64::consts::PI));
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
    for k in 0..drawn(360) {
        let ((stone, mut start), table) = (any_drop(&mut r), any_table(&mut r));
        if table == Table::Smooth && start.aloft.is_none() {
            start.slip = [0.0; 2];
        }
        let e = if r() < 0.3 { [0.0, 1.0][(2.0 * r()) as usize] } else { r() };
        // On a patch that drills no bounce grips, so that with e = 1 they never end.
        let e = if matches!(table, Table::Rubs(Friction::Coulomb { patch, .. }) if patch > 0.0) {
            0.9 * e
        } else {
            e
        };
        let mut ask = Ask::on(table).with_restitution(Some(e));
        if r() < 0.3 {
            let law = [Law::AirLinear, Law::AirQuadratic][(2.0 * r()) as usize];
            ask.losses = Losses::of(law, 10f64.powf(-3.0 + 2.5 * r()));
        }
        let times: Vec<f64> = (0..60).map(|k| 0.05 * f64::from(k)).collect();
        let m = match stone::roll(&stone, start, &times, &ask.with_pose(true), || true) {
            // More than one contact force, or none, at the start.
            Err(Error::Painleve { .. }) => continue,
            found => found.unwrap().unwrap(),
        };
        let path = m.path.as_ref().unwrap();
        let whole = |i: usize| {
            let ([u, v], [height, lift]) = (path.slip[i], path.aloft[i]);
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
            assert!(path.aloft[i][0] >= -1e-13, "{k}: {:?}", path.aloft[i]);
            assert!(path.kinds[i] == Kind::Flying || path.aloft[i] == [0.0; 2], "{k} {:?}", path.aloft[i]);
        }
        for hit in &path.impacts {
            let [p, q, n] = hit.impulse;
            if let Table::Rubs(Friction::Coulomb { mu, fixed, .. }) = table {
                let most = if hit.hit == Hit::Sticks { fixed } else { mu };
                assert!(p.hypot(q) <= most * n * (1.0 + 1e-9) + 1e-14, "{k} {hit:?}");
            }
            assert!(hit.lost >= -1e-14 * whole(0) && n > 0.0, "{k} {hit:?}");
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
        let ask = ask.with_pose(true);
        let there = Start::from(State { theta, w1, w2, w3 }).with_slip(slip).with_aloft(aloft);
        let here = Start::from(StoneState { vertical: [s, 0.0, c], w: [w1, w2, w3] });
        let here = here.with_slip(slip).with_aloft(aloft);
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
                p.aloft[i][0] - q.aloft[i][0],
                p.aloft[i][1] - q.aloft[i][1],
                p.slip[i][0].hypot(p.slip[i][1]) - q.slip[i][0].hypot(q.slip[i][1]),
                p.dissipated[i] - q.dissipated[i],
            ];
            let off = off.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
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
    let m = hops(&ball, &start.with_aloft([1.0, 0.0]), &Ask::on(table).with_restitution(0.7), &[30.0]);
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
    assert!(path.impacts.last().unwrap().stays && last.kind != Kind::Flying && m.error < 1e-10, "{last:?}");
}
