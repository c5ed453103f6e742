//! Upright starts and passages: a body whose axis is vertical in the air or, on a round end, on the table.

use crate::common::{drawn, wander};
use nalgebra::Vector3;
use spincyl::contact::Table;
use spincyl::contact::slip::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::{AboveTable, Ask, Ending, Method, Motion, Start, roll_with};
use spincyl::{Body, Slip, State};
use std::f64::consts::PI;

fn moved(body: &Body, start: &Start, ask: &Ask, times: &[f64]) -> Motion {
    roll_with(body, *start, times, ask, || true)
        .unwrap_or_else(|error| panic!("{error}: {body:?} {start:?}"))
        .unwrap()
}

fn energy(body: &Body, y: &State, [u, v, lift]: [f64; 3], height: f64) -> f64 {
    let (s, c) = y.theta.sin_cos();
    let (ell, a, rho) = (body.ell(), body.rim(), body.fillet());
    let (radius, depth, high, lever) = (a + rho * s, ell + rho * c, ell * c + a * s + rho, ell * s - a * c);
    let centre = [u + high * y.w2, v - depth * y.w1 + radius * y.w3, lift + lever * y.w2];
    let turning = body.i1() * (y.w1 * y.w1 + y.w2 * y.w2) + body.i3() * y.w3 * y.w3;
    0.5 * (centre.iter().map(|v| v * v).sum::<f64>() + turning) + high + height
}

#[test]
fn a_body_that_is_dropped_flat_lands_on_its_face_at_the_time_of_a_free_fall() {
    let mut r = wander(64);
    for k in 0..300 {
        let body = match k % 4 {
            0 => Body::solid(3.0 * r()),
            1 => Body::tube(2.0 * r(), r()),
            2 => Body::solid(0.0),
            _ => Body::rounded_tube(0.5 + r(), 0.0, 0.4 * r()),
        }
        .unwrap();
        let (height, lift, over) = (0.01 + 3.0 * r(), 2.0 * r() - 1.0, r() < 0.5);
        let w3 = if r() < 0.3 { 0.0 } else { 6.0 * r() - 3.0 };
        let slip = if r() < 0.3 { [0.0; 2] } else { [r() - 0.5, r() - 0.5] };
        // Upside down, the rim from which the state is told is on top.
        let low = height + if over && body.ell() > 0.0 { 2.0 * body.ell() } else { 0.0 };
        let y = State { theta: if over { PI } else { 0.0 }, w1: 0.0, w2: 0.0, w3 };
        let start = Start::from(y).with_slip(slip.into()).with_aloft(AboveTable::new(low, lift));
        let table = [Friction::coulomb(0.3).into(), Table::Smooth][k % 2];
        let mut ask = Ask::on(table).with_restitution([0.0, 0.5, 1.0][k % 3]).with_pose();
        if k % 5 == 0 {
            ask = ask.with_losses(Losses::of(Law::AirLinear, 0.02));
        }
        let falls = lift + (lift * lift + 2.0 * height).sqrt();
        let times: Vec<f64> =
            (0..40).map(|k| falls * f64::from(k) / 39.0 + f64::from(k / 39) * 1e-9).collect();
        let m = moved(&body, &start, &ask, &times);
        let path = m.path.as_ref().unwrap();
        let time =
            path.impacts.first().unwrap_or_else(|| panic!("{start:?} {ask:?} {:?} {body:?}", m.event)).time;
        assert!((time - falls).abs() < 1e-14 * (1.0 + falls), "{time} {falls}");
        assert!(
            m.error < 1e-9 && m.pose_error < 1e-9,
            "{} {}: {body:?} {start:?} {ask:?}",
            m.error,
            m.pose_error
        );
        if k % 5 > 0 {
            for (t, (y, pose)) in m.times.iter().zip(m.states.iter().zip(m.poses.as_ref().unwrap())).take(39)
            {
                assert_eq!((y.w1, y.w2, y.w3), (0.0, 0.0, w3));
                let turned = pose.phi.radians() + if over { -1.0 } else { 1.0 } * pose.psi.radians();
                let whole = turned - if over { -w3 } else { w3 } * t;
                assert!((whole / (2.0 * PI) - (whole / (2.0 * PI)).round()).abs() < 1e-13, "{whole}");
            }
        }
    }
}

#[test]
fn a_body_that_tumbles_from_upright_flies_as_one_that_hardly_leans() {
    let mut r = wander(65);
    for k in 0..drawn(200) {
        let body = match k % 3 {
            0 => Body::solid(0.3 + 3.0 * r()),
            1 => Body::rounded_tube(1.5 + r(), 0.0, 1.0),
            _ => Body::ball(0.4 * r() - 0.2, 0.4, 0.3 + 0.2 * r()),
        }
        .unwrap();
        let over = k % 2 == 1 && body.theta_end() < 3.0;
        let w3 = if r() < 0.4 { 0.0 } else { 6.0 * r() - 3.0 };
        let w2 = (if r() < 0.5 { 1.0 } else { -1.0 }) * (0.1 + 3.0 * r());
        let y = State { theta: if over { PI } else { 0.0 }, w1: 0.0, w2, w3 };
        let start = Start::from(y)
            .with_slip(Slip::new(r() - 0.5, r() - 0.5))
            .with_aloft(AboveTable::new(9.0, 3.0 * r()));
        let mut ask = Ask::on(Friction::coulomb(0.3)).with_restitution(0.5).with_pose();
        let air = r() < 0.3;
        if air {
            ask = ask.with_losses(Losses::of(Law::AirLinear, 0.02));
        }
        let times: Vec<f64> = (0..30).map(|k| 0.05 * f64::from(k)).collect();
        let m = moved(&body, &start, &ask, &times);
        // Leaning by 1e-7, with the same velocity of the centre up to that.
        let lean = 1e-7;
        let near = Start::from(State { theta: if over { PI - lean } else { lean }, ..y });
        let near = near.with_slip(start.slip).with_aloft(start.aloft);
        let n = moved(&body, &near, &ask, &times);
        let lands = m.path.as_ref().unwrap().impacts.first().map_or(f64::INFINITY, |hit| hit.time);
        for i in (0..m.times.len()).filter(|i| times[*i] < lands - 1e-6) {
            let [a, b] = [&m, &n].map(|m| (m.states[i], m.poses.as_ref().unwrap()[i]));
            let turn = |(y, pose): &(State, spincyl::pose::Pose)| pose.orientation(y);
            let apart = turn(&a).angle_to(&turn(&b));
            assert!(apart < 1e-5, "{apart} at {}: {body:?} {start:?}", times[i]);
            let away = (a.1.centre(&body, &a.0) - b.1.centre(&body, &b.0)).norm();
            assert!(away < 1e-5, "{away} at {}: {body:?} {start:?}", times[i]);
            let momentum = |(y, pose): &(State, spincyl::pose::Pose)| {
                spincyl::pose::axes(pose.phi.rest, y.theta) * y.angular_momentum(&body)
            };
            let first = Vector3::new(0.0, body.i1() * w2, (if over { -1.0 } else { 1.0 }) * body.i3() * w3);
            let lost = (momentum(&a) - first).norm();
            assert!(air || lost < 1e-12 * (1.0 + first.norm()), "{lost} at {}: {body:?} {start:?}", times[i]);
        }
    }
}

#[test]
fn round_ends_pass_their_poles_however_near_without_an_end_and_without_a_loss_of_energy() {
    let mut r = wander(66);
    let (mut nearest, mut past) = (1f64, 0);
    for k in 0..150 {
        let body = match k % 3 {
            0 => Body::rounded_tube(1.2 + r(), 0.0, 1.0),
            1 => Body::balls(1.0 + r()),
            _ => Body::ball(0.6 * r() - 0.4, 0.3 + 0.2 * r(), 0.3 + 0.2 * r()),
        }
        .unwrap();
        let small = 10f64.powf(-4.0 - 8.0 * r());
        let theta = if r() < 0.4 { (1e-8f64).max(small) } else { 0.2 + 0.5 * r() };
        let planar = r() < 0.3;
        let w3 = if planar { 0.0 } else { small * (r() - 0.5) };
        let y = State { theta, w1: if planar { 0.0 } else { small * (r() - 0.5) }, w2: 2.0 * r() - 0.3, w3 };
        let slip = if r() < 0.5 { [0.0; 2] } else { [r() - 0.5, if planar { 0.0 } else { small * r() }] };
        let rubs = Friction::coulomb(0.05 + r());
        let (mut ask, mut start) = (Ask::on(rubs), Start::from(y).with_slip(slip.into()));
        if k % 2 == 0 {
            ask = ask.with_restitution([0.0, 0.5][k % 4 / 2]);
            start = start.with_aloft(AboveTable::new(0.3 * r(), 0.0));
        }
        let times: Vec<f64> = (0..60).map(|k| 0.1 * f64::from(k)).collect();
        let m = match roll_with(&body, start, &times, &ask.with_pose(), || true) {
            Ok(m) => m.unwrap(),
            Err(error) => panic!("{error}: {body:?} {start:?} {ask:?}"),
        };
        if let Some(event) = m.event {
            assert!(
                !matches!(event.ending, Ending::Face | Ending::Bounded),
                "{event:?}: {body:?} {start:?} {ask:?}"
            );
        }
        let path = m.path.as_ref().unwrap();
        let whole = |i: usize| {
            let up = path.aloft.get(i).copied().unwrap_or_default();
            let (Slip { u_h: u, u_2: v, .. }, AboveTable { height, lift, .. }) = (path.slip[i], up);
            let struck: f64 =
                path.impacts.iter().filter(|hit| hit.time < m.times[i]).map(|hit| hit.lost).sum();
            energy(&body, &m.states[i], [u, v, lift], height) + path.dissipated[i] + struck
        };
        for i in 0..m.states.len() {
            let lean = m.states[i].theta;
            nearest = nearest.min(lean.min(PI - lean));
            let off = (whole(i) - whole(0)).abs();
            assert!(off < 1e-9 + 10.0 * m.error, "{off} at {}: {body:?} {start:?} {ask:?}", m.times[i]);
        }
        past += usize::from(m.states.len() == times.len());
    }
    assert!(past > 60, "{past} {nearest}");
}

#[test]
fn dry_friction_along_the_contour_takes_energy_also_from_a_ball_that_passes_beside_its_pole() {
    // The nearer it passes, the shorter it takes: in the limit the pole makes no difference.
    let ball = Body::rounded(-0.5, 0.348, 0.578, 1.0).unwrap();
    let times: Vec<f64> = (0..9).map(|k| 0.25 * f64::from(k)).collect();
    for tol in [1e-14, 1e-12, 1e-10, 1e-8] {
        let ask = Ask::on(Friction::coulomb(0.4))
            .with_losses(Losses::of(Law::DryContour, 0.0014))
            .with_method(Method::Tolerance(tol));
        let run = |near: f64, ask: &Ask| {
            let start = Start::from(State { theta: near, w1: near, w2: 1.347, w3: 1.285 });
            moved(&ball, &start, ask, &times)
        };
        let far = run(1e-3, &ask);
        for near in [1e-4, 1e-5, 1e-6, 1e-7, 1e-8] {
            for ask in [ask, ask.with_pose()] {
                let m = run(near, &ask);
                let lost = &m.path.as_deref().unwrap().work_lost;
                assert!(lost.is_sorted(), "{near} {tol}: {lost:?}");
                let (last, there) = (m.states[8], far.states[8]);
                assert!((last.theta - there.theta).abs() < 2e-3, "{near} {tol}: {last:?} {there:?}");
                assert!((last.w3 - there.w3).abs() < 2e-3, "{near} {tol}: {last:?} {there:?}");
            }
        }
    }
}
