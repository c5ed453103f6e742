//! Poses and contact forces: row D18 of docs/hard-cases.md, and laws of the contact.

use crate::common::rim::sharp;
use crate::common::{
    BOTH, all_motions, any_body, any_rim, any_state, by, distance, motions, moved, numbers, rounded_starts,
    starts, state, wander,
};
use nalgebra::Vector3;
use proptest::prelude::*;
use spincyl::exact::{ContactDrift, Swing};
use spincyl::motion::{Ask, Method};
use spincyl::pose::Pose;
use spincyl::{Body, Contact, State, contact, rk4, steady};
use std::f64::consts::{FRAC_PI_2, PI};

#[test]
fn d18_a_wheel_rolls_where_modelicas_does() {
    // R = 0.3 m, m = 2 kg, I3 = 0.06, I1 = 0.12 kg m^2, upright, spin 5 rad/s, tilt rate 1 rad/s, 4 s
    let wheel = Body::new(0.0, 0.12 / 0.18, 0.06 / 0.18).unwrap();
    let second = (9.80665f64 / 0.3).sqrt();
    let y = state(FRAC_PI_2, 0.0, -1.0 / second, 5.0 / second);
    for method in [Method::Exact, Method::Tolerance(1e-11), Method::Step(1e-3)] {
        let motion = moved(&wheel, &y, &[0.0, 4.0 * second], by(method).with_pose()).unwrap();
        let poses = motion.poses.unwrap();
        let moved = poses[1].centre(&wheel, &motion.states[1]) - poses[0].centre(&wheel, &motion.states[0]);
        let (along, across) = (0.3 * moved.x.abs(), 0.3 * moved.y.abs());
        assert!((along - 2.437614).abs() < 1e-6 && (across - 0.036997).abs() < 1e-6, "{moved}");
    }
}

#[test]
fn integrated_and_exact_poses_agree() {
    for r in motions().iter().filter(|r| r.kind == "state" && r.t == 20.0) {
        for (method, allowed) in [(Method::Tolerance(1e-12), 1e-8), (Method::Step(2e-4), 1e-7)] {
            let scene = by(method).with_table(r.contact).with_pose().with_beyond();
            let motion = moved(&r.body, &r.start, &[20.0], scene).unwrap();
            let pose = motion.poses.unwrap()[0];
            let found = [pose.phi.radians(), pose.psi.radians(), pose.contact_point.x, pose.contact_point.y];
            for (a, b) in found.iter().zip(&r.values[4..8]) {
                assert!((a - b).abs() < allowed, "{} {:?} {method:?}: {a} {b}", r.scene, r.contact);
                assert!((a - b).abs() <= 2.0 * motion.pose_error, "{}: {:e}", r.scene, motion.pose_error);
            }
        }
    }
}

#[test]
fn integrated_and_exact_states_and_poses_of_rounded_bodies_agree() {
    for (body, y) in rounded_starts() {
        for contact in BOTH {
            let times = [0.7, 5.0, 20.0];
            let scene = |method| by(method).with_table(contact).with_pose().with_beyond();
            let exact = moved(&body, &y, &times, scene(Method::Exact)).unwrap();
            assert_eq!(exact.method, Method::Exact);
            for (method, allowed) in [(Method::Tolerance(1e-13), 1e-8), (Method::Step(5e-4), 1e-8)] {
                let steps = moved(&body, &y, &times, scene(method)).unwrap();
                for (a, b) in steps.states.iter().zip(&exact.states) {
                    let off = distance(a, &numbers(b));
                    assert!(
                        off < allowed && off <= 2.0 * (steps.error + exact.error),
                        "{body:?} {contact:?} {method:?}: {off:e}"
                    );
                }
                let claims = steps.pose_error + exact.pose_error;
                for (a, b) in steps.poses.unwrap().iter().zip(exact.poses.as_ref().unwrap()) {
                    let off = [
                        a.phi.radians() - b.phi.radians(),
                        a.psi.radians() - b.psi.radians(),
                        (a.contact_point - b.contact_point).norm(),
                    ];
                    let off = off.iter().fold(0f64, |most, x| most.max(x.abs()));
                    assert!(
                        off < allowed && off <= 2.0 * claims,
                        "{body:?} {contact:?} {method:?}: {off:e}, {claims:e}"
                    );
                }
            }
        }
    }
}

/// The largest difference of a pose from phi, psi and the contact point of a reference, where it has these
/// numbers.
fn off(pose: &Pose, values: &[f64]) -> f64 {
    let found = [pose.phi.radians(), pose.psi.radians(), pose.contact_point.x, pose.contact_point.y];
    found.iter().zip(values).map(|(a, b)| (a - b).abs()).filter(|x| !x.is_nan()).fold(0.0, f64::max)
}

#[test]
fn a_quick_pose_is_that_of_the_references_within_its_claim() {
    let scene = Ask::default().with_pose().with_beyond();
    let mut quick = 0;
    for r in all_motions().filter(|r| r.kind == "state" && r.t.abs() <= 100.0) {
        let motion = moved(&r.body, &r.start, &[r.t], scene.with_table(r.contact)).unwrap();
        let slow = Swing::with_pose(&r.body, &r.start, r.contact).unwrap().pose(r.t).unwrap();
        let Some(pose) = motion.poses.unwrap().pop().filter(|pose| *pose != slow) else { continue };
        let (off, claimed) = (off(&pose, &r.values[4..8]), motion.pose_error);
        assert!(off <= claimed, "{} {:?} t = {}: {off:e}, claimed {claimed:e}", r.scene, r.contact, r.t);
        quick += 1;
    }
    assert!(quick > 6, "{quick}");
}

#[test]
fn a_quick_pose_is_that_of_the_integrals_within_both_claims() {
    let mut random = wander(5);
    let (mut quick, mut times) = (0, [0.0; 9]);
    for i in 0..1200 {
        let body = match i % 3 {
            0 => Body::rounded_tube(0.5 + 2.5 * random(), 0.0, 0.3 * random()),
            _ => Body::tube(3.0 * random(), random()),
        };
        let body = body.unwrap();
        let low = body.theta_balance().max(body.theta_limit());
        let theta = low + (FRAC_PI_2 - low) * (0.05 + 0.9 * random());
        let Ok(y) = steady::state(&body, theta) else { continue };
        let kick = [1e-9, 1e-4, 0.03, 0.1][i % 4] * (2.0 * random() - 1.0);
        let y = State { w1: y.w1 * (1.0 + 0.3 * kick), ..y.kicked(kick) };
        let contact = BOTH[i % 7 / 6];
        let way = if i % 5 == 0 { -1.0 } else { 1.0 };
        times.iter_mut().enumerate().for_each(|(k, t)| *t = way * [20.0, 300.0][i % 2] * k as f64 / 8.0);
        let scene = Ask::default().with_table(contact).with_pose().with_beyond();
        let motion = moved(&body, &y, &times, scene).unwrap();
        let Ok(swing) = Swing::with_pose(&body, &y, contact) else { continue };
        let poses = motion.poses.unwrap();
        if poses.len() < times.len() || poses[8] == swing.pose(times[8]).unwrap() {
            continue;
        }
        quick += 1;
        for (t, pose) in times.iter().zip(&poses) {
            let slow = swing.pose(*t).unwrap();
            let place = slow.contact_point;
            let off = off(pose, &[slow.phi.radians(), slow.psi.radians(), place.x, place.y]);
            let claimed = motion.pose_error + swing.pose_error(*t);
            assert!(off <= claimed, "{body:?} {y:?} {contact:?} t = {t}: {off:e}, claimed {claimed:e}");
        }
    }
    assert!(quick > 400, "{quick}");
}

#[test]
fn the_body_touches_the_table_and_the_contact_point_does_not_slide() {
    for (body, y) in starts() {
        let swing = Swing::with_pose(&body, &y, Contact::Rolling).unwrap();
        let centre = |t: f64| swing.pose(t).unwrap().centre(&body, &swing.state(t));
        let [height, speed] = if sharp(&body) { [1e-14, 1e-8] } else { [4e-15, 1e-7] };
        for k in 1..50 {
            let (t, h) = (0.41 * f64::from(k), 1e-5);
            let (y, pose) = (swing.state(t), swing.pose(t).unwrap());
            let turn = pose.orientation(&y);
            // the lowest point of the circle of the rim, the contact point below it, and the velocity of the
            // body there
            let up = turn.inverse() * Vector3::z();
            let across = Vector3::new(-up.x, -up.y, 0.0).normalize();
            let arm = turn * (across * body.rim() - Vector3::z() * body.ell()) - Vector3::z() * body.fillet();
            assert!((centre(t) + arm).z.abs() < height, "{}", (centre(t) + arm).z);
            assert!(((centre(t) + arm).xy() - pose.contact_point).norm() < 1e-12);
            let after = swing.pose(t + h).unwrap().orientation(&swing.state(t + h));
            let before = swing.pose(t - h).unwrap().orientation(&swing.state(t - h));
            let fixed = turn.inverse() * arm;
            let velocity = ((centre(t + h) + after * fixed) - (centre(t - h) + before * fixed)) / (2.0 * h);
            assert!(velocity.norm() < speed, "{body:?}: {velocity}");
        }
    }
}

#[test]
fn the_contact_force_and_gravity_move_the_centre() {
    for ((body, y), contact) in starts().flat_map(|start| BOTH.map(|contact| (start, contact))) {
        let swing = Swing::with_pose(&body, &y, contact).unwrap();
        let centre = |t: f64| swing.pose(t).unwrap().centre(&body, &swing.state(t));
        let allowed = if sharp(&body) { 1e-6 } else { 1e-5 };
        for k in 1..30 {
            let (t, h) = (0.41 * f64::from(k), 1e-4);
            let acceleration = ((centre(t + h) - centre(t)) - (centre(t) - centre(t - h))) / (h * h);
            let (sin, cos) = swing.pose(t).unwrap().phi.rest.sin_cos();
            let f = contact::force(contact, &body, &swing.state(t));
            let along = -sin * acceleration.x + cos * acceleration.y;
            let across = cos * acceleration.x + sin * acceleration.y;
            let miss = [f.normal - 1.0 - acceleration.z, f.along - along, f.across - across];
            assert!(miss.iter().all(|x| x.abs() < allowed), "{body:?} {contact:?}: {miss:?}");
            let needed = if f.normal > 0.0 { f.along.hypot(f.across) / f.normal } else { f64::INFINITY };
            assert!(f.friction_coefficient() == needed || (f.friction_coefficient() - needed).abs() < 1e-15);
        }
    }
    assert_eq!(contact::Force::new(-1.0, 1.0, 0.0).friction_coefficient(), f64::INFINITY);
}

#[test]
fn a_centre_at_rest_stays_and_a_nutating_path_drifts_on_a_circle() {
    let body = Body::tube(6.0, 0.8).unwrap();
    let rest = steady::state(&body, 1.4).unwrap();
    for contact in BOTH {
        let swing = Swing::with_pose(&body, &rest, contact).unwrap();
        let centre = |t: f64| swing.pose(t).unwrap().centre(&body, &rest);
        assert!((centre(7.3) - centre(0.0)).norm() < 1e-12);
    }
    let swing = Swing::with_pose(&body, &rest.kicked(0.05), Contact::Rolling).unwrap();
    let ContactDrift { step, radius, .. } = swing.drift().unwrap();
    let place = |m: f64| swing.pose(m * swing.period()).unwrap().contact_point;
    assert!(((place(1.0) - place(0.0)).norm() - step).abs() < 1e-12);
    assert!(((place(1001.0) - place(1000.0)).norm() - step).abs() < 1e-8);
    // three of these points lie on a circle of that radius
    let (a, b, c) = (
        (place(1.0) - place(0.0)).norm(),
        (place(2.0) - place(1.0)).norm(),
        (place(2.0) - place(0.0)).norm(),
    );
    let half = 0.5 * (a + b + c);
    let circle = a * b * c / (4.0 * (half * (half - a) * (half - b) * (half - c)).sqrt());
    assert!((circle / radius - 1.0).abs() < 1e-6, "{circle} {radius}");
}

#[test]
fn a_body_at_rest_has_the_energy_of_its_height() {
    let body = Body::solid(0.7).unwrap();
    let height = 0.7 * 0.4f64.cos() + 0.4f64.sin();
    for contact in BOTH {
        assert!((contact.energy(&body, &state(0.4, 0.0, 0.0, 0.0)) - height).abs() < 1e-15);
        // turning about the vertical at one radian a time unit adds half of its inertia about that axis
        let spinning = state(0.4, 0.4f64.sin(), 0.0, 0.4f64.cos());
        let mut inertia = body.i1() * 0.4f64.sin().powi(2) + body.i3() * 0.4f64.cos().powi(2);
        if contact == Contact::Rolling {
            inertia += (0.4f64.cos() - 0.7 * 0.4f64.sin()).powi(2);
        }
        assert!((contact.energy(&body, &spinning) - height - 0.5 * inertia).abs() < 1e-15);
    }
}

#[test]
fn what_is_not_wanted_is_not_there() {
    let body = Body::solid(1.0).unwrap();
    let y = steady::state(&body, 0.5).unwrap().kicked(0.1);
    let bare = moved(&body, &y, &[1.0, 2.0], Ask::default()).unwrap();
    assert!(bare.poses.is_none() && bare.forces.is_none() && bare.pose_error.is_nan());
    let all = moved(&body, &y, &[1.0, 2.0], Ask::default().with_pose().with_force()).unwrap();
    // without a pose the states are computed by another method, and agree
    for (a, b) in all.states.iter().zip(&bare.states) {
        assert!(distance(a, &numbers(b)) <= all.error + bare.error && bare.error < 1e-12);
    }
    assert_eq!((all.poses.unwrap().len(), all.forces.unwrap().len()), (2, 2));
}

proptest! {
    #![proptest_config(crate::common::cases(800))]

    #[test]
    fn rk4_and_the_exact_motion_agree_at_any_state(body in any_rim(), y in any_state(), smooth in any::<bool>()) {
        let contact = if smooth { Contact::Smooth } else { Contact::Rolling };
        let sharp = sharp(&body);
        let body = if sharp { body } else { body.with_theta_end(PI).unwrap() };
        let Ok(swing) = Swing::with_pose(&body, &y, contact) else { return Ok(()) };
        let method = Method::Tolerance(if sharp { 1e-11 } else { 1e-12 });
        let scene = by(method).with_table(contact).with_beyond().with_pose();
        let Ok(motion) = moved(&body, &y, &[0.3, 1.7], scene) else { return Ok(()) };
        for ((t, found), pose) in motion.times.iter().zip(&motion.states).zip(motion.poses.as_ref().unwrap()) {
            let exact = swing.state(*t);
            let size = 1.0 + numbers(&exact).iter().fold(0f64, |a, x| a.max(x.abs()));
            // near a saddle, or near flat, a motion magnifies the error of the integrator
            let low = y.theta.sin().min(exact.theta.sin());
            let lowest = low.min(swing.turning_points()[0].sin().max(1e-3));
            let allowed = 1e-7 * size.powi(2) / if sharp { low } else { lowest } + 1e5 * swing.error(*t);
            prop_assert!(distance(found, &numbers(&exact)) <= allowed, "{found:?} {exact:?}");
            let there = swing.pose(*t).unwrap();
            let off = (pose.contact_point - there.contact_point).norm();
            prop_assert!(off <= 10.0 * allowed / lowest + 1e5 * swing.pose_error(*t), "{pose:?} {there:?}");
        }
    }

    #[test]
    fn the_normal_force_is_the_weight_and_what_lifts_the_centre(body in any_body(), y in any_state(), smooth in any::<bool>()) {
        let contact = if smooth { Contact::Smooth } else { Contact::Rolling };
        let h = 1e-4 / (1.0 + numbers(&y).iter().map(|x| x.abs()).sum::<f64>()) * y.theta.sin();
        let height = |y: &State| body.ell() * y.theta.cos() + y.theta.sin();
        let at = |n: i32| rk4::integrate(|y| contact.derivative(&body, y), y, f64::from(n.signum()) * h, n.unsigned_abs().into());
        let lift = (height(&at(1)) - 2.0 * height(&y) + height(&at(-1))) / (h * h);
        let normal = contact::force(contact, &body, &y).normal;
        prop_assert!((normal - 1.0 - lift).abs() < 1e-3 * (1.0 + normal.abs()) + 1e-15 * (1.0 + body.ell()) / (h * h), "{normal} {lift}");
    }
}

#[test]
fn a_path_that_is_turned_by_almost_nothing_a_period_keeps_its_digits() {
    // a precession of one turn and 1e-6 per period: only the excess over the turn sums over the periods
    let body = Body::new(0.0, 203428.96412048728, 0.4237592903145259).unwrap();
    let y = state(2.7, -2.654091292825407, -0.1, 1.8673114905120078);
    let times = [0.22924120743507784, 2.5];
    let scene = Ask::default().with_pose().with_beyond();
    let exact = moved(&body, &y, &times, scene).unwrap();
    let steps = moved(&body, &y, &times, scene.with_method(Method::Tolerance(1e-13))).unwrap();
    for (a, b) in exact.poses.unwrap().iter().zip(&steps.poses.unwrap()) {
        let off = (a.contact_point - b.contact_point).norm();
        assert!(off < 1e-11, "{off:e}");
    }
}
