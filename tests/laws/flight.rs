//! Flight: the free motion in the air, its landings, and laws of every motion that hops.

use crate::common::{drawn, wander};
use nalgebra::{Matrix3, Vector3};
use spincyl::contact::slip::{self, Friction};
use spincyl::contact::{ImpactLaw, Table};
use spincyl::motion::path::{Kind, Strike};
use spincyl::motion::{AboveTable, Ask, Ending, Motion, Start, roll_with};
use spincyl::{Body, Slip, State};
use std::f64::consts::{FRAC_PI_2, PI};

/// The motion, with poses and the restitution `e`, of a body that starts in the air, or on the table if `start.aloft`
/// is None.
pub(crate) fn hops(body: &Body, start: &Start, table: Table, e: f64, times: &[f64]) -> Motion {
    let ask = Ask::on(table).with_restitution(e).with_pose();
    roll_with(body, *start, times, &ask, || true).unwrap().unwrap()
}

pub(crate) fn dropped(state: State, slip: [f64; 2], height: f64, lift: f64) -> Start {
    Start::from(state).with_slip(slip.into()).with_aloft(AboveTable::new(height, lift))
}

pub(crate) fn impacts(m: &Motion) -> &[Strike] {
    &m.path.as_ref().unwrap().impacts
}

pub(crate) fn coulomb(mu: f64) -> Table {
    Friction::coulomb(mu).into()
}

/// The radius A, the depth L, the height h and the lever g of a rim at an inclination, by their definition.
pub(crate) fn rim(body: &Body, theta: f64) -> [f64; 4] {
    let (s, c) = theta.sin_cos();
    let (ell, a, rho) = (body.ell(), body.rim(), body.fillet());
    [a + rho * s, ell + rho * c, ell * c + a * s + rho, ell * s - a * c]
}

/// The law of restitution of case `k`: Stronge's in every second case, else Newton's or Poisson's.
pub(crate) fn other_law(k: usize) -> ImpactLaw {
    [ImpactLaw::Stronge, ImpactLaw::Newton, ImpactLaw::Stronge, ImpactLaw::Poisson][k % 4]
}

/// The velocity of the centre of mass along e_h, e2 and upwards, from that of the lowest point.
pub(crate) fn centre(body: &Body, y: &State, [u, v, lift]: [f64; 3]) -> [f64; 3] {
    let [radius, depth, height, lever] = rim(body, y.theta);
    [u + height * y.w2, v - depth * y.w1 + radius * y.w3, lift + lever * y.w2]
}

/// Kinetic and potential energy of a body in the air.
pub(crate) fn energy(body: &Body, y: &State, u: [f64; 3], height: f64) -> f64 {
    let v = centre(body, y, u);
    let turning = body.i1() * (y.w1 * y.w1 + y.w2 * y.w2) + body.i3() * y.w3 * y.w3;
    0.5 * (v.iter().map(|v| v * v).sum::<f64>() + turning) + rim(body, y.theta)[2] + height
}

/// The sum, at the time with the index `i`, of energy, heat, and the energy that losses and impacts have taken.
pub(crate) fn account(body: &Body, m: &Motion, i: usize) -> f64 {
    let path = m.path.as_ref().unwrap();
    let (Slip { u_h: u, u_2: v, .. }, AboveTable { height, lift, .. }) = (path.slip[i], path.aloft[i]);
    let before = path.impacts.iter().filter(|hit| hit.time < m.times[i]);
    energy(body, &m.states[i], [u, v, lift], height)
        + path.dissipated[i]
        + path.work_lost.get(i).unwrap_or(&0.0)
        + before.map(|hit| hit.lost).sum::<f64>()
}

/// A random body, start in the air, coefficient of friction and restitution.
pub(crate) fn any_drop(r: &mut impl FnMut() -> f64) -> (Body, Start, f64, f64) {
    let body = match (5.0 * r()) as u8 {
        0 => Body::solid(0.05 + 3.0 * r()),
        1 => Body::tube(6.0 * r(), r()),
        2 => Body::rounded_tube(0.4 + 2.0 * r(), 0.0, 0.05 + 0.3 * r()),
        3 => Body::solid(0.0),
        _ => Body::ball(0.6 * r() - 0.3, 0.3 + 0.2 * r(), 0.3 + 0.2 * r()),
    };
    let body = body.unwrap();
    let mut speed = || 4.0 * r() - 2.0;
    let (w1, w2, w3, u, v) = (speed(), speed(), speed(), speed(), speed());
    let theta = 0.1 + 1.4 * r();
    let start = dropped(State { theta, w1, w2, w3 }, [u, v], 1.5 * r(), 1.5 * r());
    (body, start, 0.05 + 0.95 * r(), r())
}

#[test]
fn energy_heat_and_what_impacts_take_are_constant_and_no_rim_is_ever_below_the_table() {
    let mut r = wander(512);
    for k in 0..drawn(300) {
        let (body, start, mu, e) = any_drop(&mut r);
        let times: Vec<f64> = (0..120).map(|k| 0.05 * f64::from(k)).collect();
        let ask = Ask::on(coulomb(mu)).with_restitution(e).with_impact_law(other_law(k)).with_pose();
        let m = roll_with(&body, start, &times, &ask, || true).unwrap().unwrap();
        let path = m.path.as_ref().unwrap();
        let whole = |i: usize| account(&body, &m, i);
        for i in 0..m.times.len() {
            let off = (whole(i) - whole(0)).abs();
            assert!(off < 1e-12 * (1.0 + whole(0)), "{body:?} {start:?} {mu} {e}: {off:e}");
            let AboveTable { height, .. } = path.aloft[i];
            let other = height + 2.0 * body.ell() * m.states[i].theta.cos();
            let two = body.ell() > 0.0 && body.theta_end() == FRAC_PI_2;
            assert!(height >= 0.0 && (!two || other >= -1e-12), "{body:?} {height} {other}");
        }
    }
}

#[test]
fn a_smooth_table_that_gives_all_back_can_be_run_backward() {
    let mut r = wander(513);
    for _ in 0..drawn(200) {
        let (body, start, ..) = any_drop(&mut r);
        let ice = coulomb(0.0);
        let m = hops(&body, &start, ice, 1.0, &[3.0]);
        let path = m.path.as_ref().unwrap();
        if path.kinds.last() != Some(&Kind::Flying) || path.impacts.len() > 8 {
            continue;
        }
        let (y, Slip { u_h: u, u_2: v, .. }, AboveTable { height, lift, .. }) =
            (m.states[0], path.slip[0], path.aloft[0]);
        let back = State { w1: -y.w1, w2: -y.w2, w3: -y.w3, ..y };
        let there = hops(&body, &dropped(back, [-u, -v], height, -lift), ice, 1.0, &[3.0]);
        let (end, last) = (there.states[0], there.path.as_ref().unwrap());
        // Seen from another rim the state is the same motion.
        let turned = last.impacts.len() % 2 == 0 || (end.theta - start.state.theta).abs() < 0.5;
        let own = if turned { start.state.theta } else { PI - start.state.theta };
        let near = (end.theta - start.state.theta)
            .abs()
            .min((end.theta - own).abs())
            .min((PI - end.theta - start.state.theta).abs());
        assert!(near < 1e-9 && (end.w1 + start.state.w1).abs() < 1e-8, "{body:?} {start:?}: {end:?}");
        assert!(path.impacts.iter().all(|hit| hit.lost < 1e-14));
    }
}

#[test]
fn the_mirror_image_of_a_motion_is_its_motion_to_the_last_bit() {
    let mut r = wander(514);
    for _ in 0..drawn(120) {
        let (body, start, mu, e) = any_drop(&mut r);
        let y = start.state;
        let mirror = State { w1: -y.w1, w3: -y.w3, ..y };
        let image =
            Start::from(mirror).with_aloft(start.aloft).with_slip(Slip::new(start.slip.u_h, -start.slip.u_2));
        let of = |start: &Start| hops(&body, start, coulomb(mu), e, &[0.7, 1.9, 4.0]);
        let (one, two) = (of(&start), of(&image));
        // In contact the direction of a slip from rest has other roundings.
        let rolls = one.path.as_ref().unwrap().phases.iter().find(|phase| phase.kind != Kind::Flying);
        let until = rolls.map_or(f64::INFINITY, |phase| phase.time);
        for ((a, b), _) in one.states.iter().zip(&two.states).zip(&one.times).filter(|(_, t)| **t < until) {
            assert_eq!([a.theta, a.w1, a.w2, a.w3], [b.theta, -b.w1, b.w2, -b.w3], "{body:?} {start:?}");
        }
        for (a, b) in one.poses.iter().flatten().zip(two.poses.iter().flatten()) {
            // Passing to another rim adds half a turn to either phi.
            let off = (a.phi.radians() + b.phi.radians()) / PI;
            assert!((off - off.round()).abs() < 1e-14 * (1.0 + a.phi.radians().abs()), "{off}");
            let spun = a.psi.radians() + b.psi.radians();
            assert!(spun.abs() < 1e-12, "{spun:e}");
            let [x, y] = [a.contact_point.x - b.contact_point.x, a.contact_point.y + b.contact_point.y];
            assert!(x.abs() < 1e-12 && y.abs() < 1e-12, "{x:e} {y:e}");
        }
    }
}

#[test]
fn a_body_that_is_seen_from_its_other_rim_flies_and_lands_alike() {
    let mut r = wander(515);
    for _ in 0..drawn(200) {
        let (body, start, mu, e) = any_drop(&mut r);
        if body.ell() == 0.0 || body.theta_end() != FRAC_PI_2 {
            continue;
        }
        let (y, AboveTable { height, lift, .. }) = (start.state, start.aloft.unwrap());
        let (s, c) = y.theta.sin_cos();
        let apart = 2.0 * body.ell();
        let there = State { theta: PI - y.theta, w2: -y.w2, w3: -y.w3, ..y };
        let slip = [-apart * c * y.w2 - start.slip.u_h, apart * y.w1 - start.slip.u_2];
        let other = dropped(there, slip, height + apart * c, lift + apart * s * y.w2);
        let of = |start: &Start| hops(&body, start, coulomb(mu), e, &[2.5]);
        let (one, two) = (of(&start), of(&other));
        // Compared up to the first impact, which later bounces only amplify.
        let (Some(a), Some(b)) = (impacts(&one).first(), impacts(&two).first()) else { continue };
        assert!((a.time - b.time).abs() < 1e-12 && a.lands != b.lands, "{body:?} {start:?}");
        let far = a.states[1].w1.abs().max(a.states[1].w2.abs()).max(a.states[1].w3.abs()).max(1.0);
        let [off, turn] = [a.states[1].theta - b.states[1].theta, a.states[1].w2 - b.states[1].w2];
        assert!(off.abs() < 1e-12 && turn.abs() < 1e-11 * far, "{body:?} {off:e} {turn:e}");
    }
}

#[test]
fn in_the_air_angular_momentum_and_spin_stay_and_the_axis_turns_as_eulers_equations_say() {
    let mut r = wander(516);
    for _ in 0..drawn(24) {
        let (body, start, ..) = any_drop(&mut r);
        let high = start.with_aloft(AboveTable::new(900.0, 0.0));
        let times: Vec<f64> = (1..=40).map(|k| 0.2 * f64::from(k)).collect();
        let m = hops(&body, &high, coulomb(0.3), 0.5, &times);
        // The axes of the body, turned by steps of the exponential map of the angular velocity.
        let y = start.state;
        let (s, c) = y.theta.sin_cos();
        let mut axes =
            Matrix3::from_columns(&[Vector3::new(c, 0.0, s), Vector3::y(), Vector3::new(-s, 0.0, c)]);
        let moments = Vector3::new(body.i1(), body.i1(), body.i3());
        let momentum = axes * moments.component_mul(&Vector3::new(y.w1, y.w2, y.w3));
        let (steps, h) = (200, 0.2 / 200.0);
        for (i, state) in m.states.iter().enumerate() {
            for _ in 0..steps {
                let w = |axes: &Matrix3<f64>| axes * (axes.transpose() * momentum).component_div(&moments);
                // A step of the midpoint rule, of second order.
                let half = nalgebra::Rotation3::new(w(&axes) * (0.5 * h)) * axes;
                axes = nalgebra::Rotation3::new(w(&half) * h) * axes;
            }
            let e3 = axes.column(2);
            let theta = e3.xy().norm().atan2(e3.z);
            assert!((theta - state.theta).abs() < 4e-4, "{body:?} {y:?} {theta} {}", state.theta);
            assert_eq!(state.w3, y.w3);
            let pose = m.poses.as_ref().unwrap()[i];
            let turned = pose.orientation(state).to_rotation_matrix();
            assert!((turned.matrix().column(2) - e3).norm() < 4e-4);
            let there =
                turned.matrix() * moments.component_mul(&(turned.matrix().transpose() * lab(state, &pose)));
            assert!((there - momentum).norm() < 1e-11 * (1.0 + momentum.norm()), "{there} {momentum}");
            assert!((turned.matrix() - axes).norm() < 2e-3, "{body:?} {y:?}");
        }
    }
}

/// The angular velocity along the axes of the laboratory.
fn lab(y: &State, pose: &spincyl::pose::Pose) -> Vector3<f64> {
    let ((s, c), (sin, cos)) = (y.theta.sin_cos(), pose.phi.rest.sin_cos());
    let h = Vector3::new(cos, sin, 0.0);
    let (e2, z) = (Vector3::new(-sin, cos, 0.0), Vector3::z());
    (h * c + z * s) * y.w1 + e2 * y.w2 + (z * c - h * s) * y.w3
}

#[test]
fn a_body_whose_normal_force_fails_for_a_moment_lands_twice_as_long_after() {
    // A tube that is flicked just hard enough to hop: N0 dips below zero for a short time.
    let tube = Body::tube(6.0, 0.8).unwrap();
    let hop = |launch: f64| {
        let (w1, w3) = (3.0, launch * 6.0 / (tube.i3() * 3.0));
        let v = -tube.i1() / 6.0 * w1;
        let state = State { theta: FRAC_PI_2, w1, w2: 0.0, w3 };
        let start = Start::from(state).with_slip(Slip::new(0.0, v + 6.0 * w1 - w3));
        let m = hops(&tube, &start, coulomb(0.3), 0.0, &[30.0]);
        let path = m.path.unwrap();
        let flies = path.phases.iter().position(|phase| phase.kind == Kind::Flying)?;
        Some((path.phases[flies], path.impacts.first().copied()?, start))
    };
    let (mut low, mut high) = (1.3, 3.0);
    assert!(hop(low).is_none() && hop(high).is_some());
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if hop(middle).is_some() { high = middle } else { low = middle }
    }
    let (leaves, lands, _) = hop(high).unwrap();
    let lasts = lands.time - leaves.time;
    assert!(lasts > 0.0 && lasts < 1e-2, "{lasts}");
    // N0 = -n t + m t^2/2 from the derivatives of N0 along the flight without contact is zero again after half of it.
    let law = |y: &State, u: [f64; 2]| {
        slip::derivative(&tube, y, u.into(), &Friction::coulomb(0.0), &Default::default()).2.normal
    };
    let normal = |t: f64| {
        let start = dropped(leaves.state, leaves.slip.into(), 0.0, 0.0);
        let m = hops(&tube, &start.with_aloft(AboveTable::new(1.0, 0.0)), coulomb(0.3), 0.0, &[t]);
        law(&m.states[0], [1.0, 0.0])
    };
    let zero =
        (1..4000).map(|k| lasts * f64::from(k) / 4000.0).find(|t| *t > 0.05 * lasts && normal(*t) > 0.0);
    let share = zero.unwrap() / lasts;
    assert!((share - 0.5).abs() < 0.2, "N0 is negative for {share} of the flight");
}

#[test]
fn bounces_that_give_all_back_never_end_and_are_bounded() {
    let ball = Body::ball(0.0, 0.4, 0.4).unwrap();
    let state = State { theta: 1.0, w1: 0.0, w2: 0.0, w3: 0.0 };
    let m = hops(&ball, &dropped(state, [0.0; 2], 1e-6, 0.0), coulomb(0.3), 1.0, &[1e3]);
    assert_eq!(m.ending(), Ending::Bounded);
    let few = hops(&ball, &dropped(state, [0.0; 2], 1.0, 0.0), coulomb(0.3), 1.0, &[1e3]);
    assert_eq!(few.ending(), Ending::Done);
    let n = impacts(&few).len();
    assert_eq!(n, ((1e3 / 2f64.sqrt() + 1.0) / 2.0) as usize);
}

#[test]
fn a_start_in_the_air_needs_a_restitution_and_a_place_above_the_table() {
    let body = Body::solid(1.0).unwrap();
    let state = State { theta: 2.0, w1: 0.0, w2: 0.0, w3: 0.0 };
    let ask = Ask::on(Friction::coulomb(0.3));
    let of = |height: f64, ask: &Ask| {
        roll_with(&body, dropped(state, [0.0; 2], height, 0.0), &[1.0], ask, || true)
    };
    assert!(of(1.0, &ask).unwrap_err().to_string().starts_with("height = 1.0: expected None"));
    let on = ask.with_restitution(0.5);
    // At theta = 2 the other rim is 2 ell cos theta lower.
    assert!(of(0.8, &on).unwrap_err().to_string().starts_with("height = -0.8: expected all rims above"));
    assert!(of(0.84, &on).is_ok());
    let far = ask.with_restitution(1.01);
    assert!(
        of(1.0, &far)
            .unwrap_err()
            .to_string()
            .starts_with("restitution = 1.01: expected None, or 0 <= restitution <= 1")
    );
}
