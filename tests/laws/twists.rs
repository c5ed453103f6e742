//! States from rates, from a pose and a twist, and back: samples of a motion against rigid bodies in three dimensions.

use crate::common::{any_rim, any_state, larger, rounded_starts, starts, state, wander};
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;
use spincyl::contact::{Friction, Table};
use spincyl::loss::{Law, Losses};
use spincyl::measured::{Measured, Tube};
use spincyl::motion::path::Kind;
use spincyl::motion::{AboveTable, Ask, Motion, Start, roll_with};
use spincyl::pose::{EulerAngles, axes, euler_angles};
use spincyl::{Body, Slip, State};
use std::f64::consts::{FRAC_PI_2, PI};

/// A random orientation; in a fifth of the cases almost or exactly upright or upside down.
fn any_turn() -> impl Strategy<Value = UnitQuaternion<f64>> {
    let angle = || -PI..PI;
    let tilt = prop_oneof![4 => 0.0..PI, 1 => (-17.0..-1.0f64).prop_map(|x| 10f64.powf(x)), 1 => Just(0.0), 1 => Just(PI)];
    (angle(), tilt, angle(), any::<bool>()).prop_map(|(phi, theta, psi, flipped)| {
        let q = axes(phi, theta) * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), psi);
        UnitQuaternion::new_unchecked(if flipped { -q.into_inner() } else { q.into_inner() })
    })
}

fn any_vector() -> impl Strategy<Value = Vector3<f64>> {
    (-5.0..5.0f64, -5.0..5.0f64, -5.0..5.0f64).prop_map(|(x, y, z)| Vector3::new(x, y, z))
}

proptest! {
    #![proptest_config(crate::common::cases(256))]

    #[test]
    fn rates_of_a_state_are_those_that_it_was_made_of(
        theta in 0.01..3.13f64, thetadot in -5.0..5.0f64, precession in -5.0..5.0f64, spin in -5.0..5.0f64,
    ) {
        let y = State::from_rates(theta, thetadot, precession, spin);
        let few = 8.0 * f64::EPSILON * (precession.abs() + spin.abs());
        prop_assert_eq!((y.theta, y.w2), (theta, -thetadot));
        prop_assert!((y.precession() - precession).abs() <= few && (y.spin() - spin).abs() <= few);
    }

    #[test]
    fn euler_angles_give_back_their_orientation(q in any_turn()) {
        let EulerAngles { phi, theta, psi, .. } = euler_angles(&q);
        prop_assert!((0.0..=PI).contains(&theta) && phi.abs() <= PI && psi.abs() <= PI);
        let again = axes(phi, theta) * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), psi);
        let off = (again.to_rotation_matrix().matrix() - q.to_rotation_matrix().matrix()).amax();
        prop_assert!(off < 2e-15, "{}: {:e}", q, off);
    }

    /// The axis n of the body moves as n' = w x n, and the body turns about it by w.n.
    #[test]
    fn a_twist_has_the_rates_of_the_axis_that_it_turns(q in any_turn(), w in any_vector()) {
        let (y, n) = (State::from_twist(&q, w), q * Vector3::z());
        let turn = w.cross(&n);
        let s = n.x.hypot(n.y);
        prop_assume!(s > 1e-6);
        let precession = (n.x * turn.y - n.y * turn.x) / (s * s);
        let same = State::from_rates(s.atan2(n.z), -turn.z / s, precession, w.dot(&n) - precession * n.z);
        for (a, b) in <[f64; 4]>::from(y).into_iter().zip(<[f64; 4]>::from(same)) {
            prop_assert!((a - b).abs() < 1e-14 / s, "{y} {same}");
        }
        prop_assert!((y.angular_velocity().norm() - w.norm()).abs() < 1e-14);
    }

    /// The lowest point of a torus lies below the lowest point of its circle.
    #[test]
    fn the_slip_of_a_twist_is_the_velocity_of_the_lowest_point(
        body in any_rim(), q in any_turn(), w in any_vector(), v in any_vector(),
    ) {
        let (n, z) = (q * Vector3::z(), Vector3::z());
        let across = z - n * n.z;
        prop_assume!(across.norm() > 1e-3);
        let r = -n * body.ell() - across.normalize() * body.rim() - z * body.fillet();
        let u = v + w.cross(&r);
        let lean = Vector3::new(-n.x, -n.y, 0.0).normalize();
        let few = 1e-13 * (1.0 + body.ell()) / across.norm();
        let height = -r.z + 0.5;
        let start = Start::from_twist(&body, &q, w, v, Some(height)).unwrap();
        let AboveTable { height: up, lift, .. } = start.aloft.unwrap();
        prop_assert!((up - 0.5).abs() < few && (lift - u.z).abs() < few);
        prop_assert!((start.slip.u_h - u.dot(&lean)).abs() < few, "{:?} {}", start.slip, u);
        prop_assert!((start.slip.u_2 - u.dot(&z.cross(&lean))).abs() < few);
        // The same on the table, where the lowest point neither rises nor falls.
        let level = Start::from_twist(&body, &q, w, v - z * u.z, None).unwrap();
        prop_assert!((level.slip.u_h - start.slip.u_h).abs() < few && level.aloft.is_none());
        let rises = Start::from_twist(&body, &q, w, v - z * (u.z - 1e-3), None).unwrap_err();
        prop_assert!(rises.to_string().starts_with("velocity = 0.00"), "{}", rises);
        // A body that rolls does not slip at all.
        let rolls = Start::from_twist(&body, &q, w, -w.cross(&r), None).unwrap();
        prop_assert!(rolls.slip.speed() < few);
    }

    #[test]
    fn a_start_from_the_sample_of_its_start_is_that_start(body in any_rim(), y in any_state(), slip in prop::array::uniform2(-2.0..2.0f64)) {
        let ask = Ask::on(Friction::coulomb(0.2)).with_pose();
        let start = Start::from(y).with_slip(slip.into());
        let Ok(Some(motion)) = roll_with(&body, start, &[0.0], &ask, || true) else { return Ok(()) };
        let Some(now) = motion.samples().next() else { return Ok(()) };
        let twist = (now.orientation().unwrap(), now.angular_velocity().unwrap(), now.velocity(&body).unwrap());
        let again = Start::from_twist(&body, &twist.0, twist.1, twist.2, None).unwrap();
        let [u, v] = again.slip.into();
        let off = larger((u - slip[0]).abs(), (v - slip[1]).abs());
        prop_assert!(off < 1e-12 * (1.0 + body.ell()), "{:?}", again);
    }
}

/// The first reading of a thrown body is the orientation, the place and the velocities that were given, and later its
/// centre falls from there.
#[test]
fn a_motion_is_read_where_it_began() {
    let mut draws = 0.1f64;
    let mut draw = || {
        draws = (997.0 * draws + 0.123).fract();
        2.0 * draws - 1.0
    };
    for length in [0.004, 0.02, 0.3] {
        let can = Tube::solid(0.05, length, 0.1);
        let can = Measured::tube(&can).unwrap();
        for _ in 0..50 {
            let q = UnitQuaternion::from_euler_angles(3.0 * draw(), 1.5 * draw(), 3.0 * draw());
            let [w, v, at] = [10.0, 1.0, 0.5].map(|size| Vector3::from_fn(|_, _| size * draw()));
            let s = can.scale();
            let (turns, moves) = (w.map(|x| s.angular_velocity(x)), v.map(|x| s.speed(x)));
            let start = Start::from_twist(can.body(), &q, turns, moves, Some(s.length(0.6))).unwrap();
            let ask = Ask::on(Friction::coulomb(0.3)).with_restitution(0.5);
            let motion = can.roll(start, &[0.0, 0.02], &ask, || true).unwrap().unwrap();
            let all: Vec<_> = motion.readings_from(&q, [at.x, at.y]).collect();
            assert!((all[0].orientation.inverse() * q).imag().norm() < 1e-14);
            assert!((all[0].velocity - v).norm() < 1e-14 && (all[0].angular_velocity - w).norm() < 1e-13);
            let place = Vector3::new(at.x, at.y, 0.6);
            assert!((all[0].position.coords - place).norm() < 1e-14);
            let falls = Vector3::z() * (0.5 * 9.80665 * 0.02 * 0.02);
            assert!((all[1].position.coords - place - v * 0.02 + falls).norm() < 1e-14);
        }
    }
}

#[test]
fn a_twist_that_is_no_number_is_refused_by_name() {
    let (body, upright) = (Body::solid(1.0).unwrap(), UnitQuaternion::identity());
    let of = |v: f64, height| {
        Start::from_twist(&body, &upright, Vector3::zeros(), Vector3::new(0.0, 0.0, v), height)
    };
    for (v, height) in
        [(f64::NAN, None), (f64::INFINITY, None), (f64::NAN, Some(2.0)), (f64::INFINITY, Some(2.0))]
    {
        assert!(of(v, height).unwrap_err().to_string().starts_with("velocity = "));
    }
    assert_eq!(of(0.0, None).unwrap().state, state(0.0, 0.0, 0.0, 0.0));
}

/// Motions of every kind, at groups of three times close together, for numerical derivatives.
fn sampled() -> Vec<(Body, Motion)> {
    const H: f64 = 1e-4;
    let times: Vec<f64> = [0.4, 1.1, 2.3, 5.0, 8.0].into_iter().flat_map(|t| [t - H, t, t + H]).collect();
    let losses = Losses::of(Law::ViscousContour, 0.02);
    let dry = Friction::coulomb(0.25);
    let mut all = Vec::new();
    let mut add = |body: &Body, start: Start, ask: Ask| {
        let ask = ask.with_pose().with_force();
        if let Ok(Some(motion)) = roll_with(body, start, &times, &ask, || true) {
            all.push((*body, motion));
        }
    };
    for (body, y) in starts() {
        for table in [Table::default(), Table::Smooth, dry.into(), Friction::Viscous { c: 0.4 }.into()] {
            add(&body, y.into(), Ask::on(table));
            add(&body, y.into(), Ask::on(table).with_losses(losses));
        }
        add(&body, Start::from(y).with_slip(Slip::new(0.7, -0.4)), Ask::on(dry));
    }
    let tube = Body::tube(1.5, 0.6).unwrap();
    let mut r = wander(71);
    for _ in 0..30 {
        let y = state(0.4 + r(), 2.0 * r() - 1.0, r() - 0.5, 3.0 * r() - 1.5);
        let start = Start::from(y).with_slip(Slip::new(r(), r())).with_aloft(AboveTable::new(0.5 * r(), r()));
        add(&tube, start, Ask::on(dry).with_restitution(0.6));
        add(&tube, start.with_slip(Slip::default()), Ask::on(Table::Smooth).with_restitution(0.6));
    }
    add(&tube, Start::from(state(FRAC_PI_2 - 0.2, 0.3, 0.0, 3.0)), Ask::on(dry).with_restitution(0.0));
    all
}

#[test]
fn the_velocities_of_a_sample_are_the_rates_of_its_pose() {
    let (mut seen, mut turned, mut flying) = (0, 0, 0);
    for (body, motion) in sampled() {
        let all: Vec<_> = motion.samples().collect();
        assert_eq!(all.len(), motion.states.len());
        for three in all.as_chunks::<3>().0 {
            let [a, b, c] = three;
            // Not across an impact or a change of the phase.
            let end = motion.path.iter().flat_map(|p| {
                p.phases.iter().map(|phase| phase.time).chain(p.impacts.iter().map(|hit| hit.time))
            });
            if end.into_iter().any(|t| a.time <= t && t <= c.time) || a.rim != c.rim {
                continue;
            }
            let step = c.time - a.time;
            let moved = (c.centre(&body).unwrap() - a.centre(&body).unwrap()) / step;
            let v = b.velocity(&body).unwrap();
            assert!((moved - v).amax() < 2e-6 * (1.0 + v.amax()), "{:?} {}: {moved} {v}", b.kind, b.time);
            let turn = (c.orientation().unwrap() * a.orientation().unwrap().inverse()).scaled_axis() / step;
            let w = b.angular_velocity().unwrap();
            assert!(
                (turn - w).amax() < 2e-6 * (1.0 + w.amax().powi(3)),
                "{:?} {}: {turn} {w}",
                b.kind,
                b.time
            );
            seen += 1;
            turned += usize::from(b.rim);
            flying += usize::from(b.kind == Some(Kind::Flying));
        }
    }
    assert!(seen > 100 && turned > 3 && flying > 30, "{seen} {turned} {flying}");
}

#[test]
fn the_energy_of_the_samples_is_kept_or_becomes_heat() {
    for (body, motion) in sampled() {
        let energy: Vec<_> = motion.samples().map(|now| now.energy(&body).unwrap()).collect();
        let path = motion.path.as_deref();
        // A restitution below 1 takes energy in impacts, too.
        if path.is_some_and(|path| !path.impacts.is_empty()) {
            continue;
        }
        let taken = |i: usize| {
            path.map_or(0.0, |p| p.dissipated[i] + p.work_lost.get(i).copied().unwrap_or_default())
        };
        for i in 1..energy.len() {
            let left = (energy[i] - energy[0]) + (taken(i) - taken(0));
            assert!(left.abs() < 1e-9 * (1.0 + energy[0].abs()), "{i}: {left:e} of {}", energy[0]);
        }
    }
}

#[test]
fn samples_have_what_was_asked_for() {
    let (body, y) = rounded_starts()[0];
    let of = |ask: Ask| roll_with(&body, y, &[0.0, 0.1], &ask, || true).unwrap().unwrap();
    let bare = of(Ask::default());
    let now = bare.samples().last().unwrap();
    assert_eq!((now.time, now.state), (0.1, bare.states[1]));
    assert!(now.pose.is_none() && now.force.is_none() && now.slip.is_none() && now.kind.is_none());
    assert!(
        now.orientation().is_none() && now.velocity(&body).is_none() && bare.orientations().next().is_none()
    );
    let full = of(Ask::on(Friction::coulomb(0.3)).with_pose().with_force());
    assert_eq!(full.samples().len(), 2);
    for (i, now) in full.samples().enumerate() {
        let path = full.path.as_ref().unwrap();
        assert_eq!(now.pose, Some(full.poses.as_ref().unwrap()[i]));
        assert_eq!(now.force, Some(full.forces.as_ref().unwrap()[i]));
        assert_eq!((now.slip, now.kind), (Some(path.slip[i]), Some(path.kinds[i])));
    }
}
