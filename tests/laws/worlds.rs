//! Measured bodies that start from any pose in the world, and their results there.

use crate::common::cases;
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;
use spincyl::contact::Friction;
use spincyl::measured::{Measured, Reading, Tube};
use spincyl::motion::{AboveTable, Ask};
use spincyl::world::WorldStart;

fn can() -> Measured {
    Measured::tube(&Tube::solid(0.05, 0.02, 0.1)).unwrap()
}

fn vector(most: f64) -> impl Strategy<Value = Vector3<f64>> {
    (-most..most, -most..most, -most..most).prop_map(|(x, y, z)| Vector3::new(x, y, z))
}

/// An orientation that leans by less than a right angle, so that the first rim is the lower one.
fn leaning() -> impl Strategy<Value = UnitQuaternion<f64>> {
    (-3.1..3.1f64, 0.1..1.5f64, -3.1..3.1f64).prop_map(|(phi, theta, psi)| {
        let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
        about(Vector3::z_axis(), phi) * about(Vector3::y_axis(), -theta) * about(Vector3::z_axis(), psi)
    })
}

fn moved(can: &Measured, start: &WorldStart, ask: &Ask) -> Vec<Reading> {
    let times: Vec<f64> = (0..=40).map(|i| 0.01 * f64::from(i)).collect();
    can.roll_in_world(start, &times, ask, || true).unwrap().unwrap().readings().collect()
}

proptest! {
    #![proptest_config(cases(64))]

    /// In the air the centre follows a parabola, and the angular momentum of the body is conserved in the world.
    #[test]
    fn a_body_in_the_air_starts_where_it_is_put_and_flies_as_newton_says(
        q in leaning(), x in vector(2.0), v in vector(1.0), w in vector(20.0),
    ) {
        let can = can();
        let at = Vector3::new(x.x, x.y, 1.5);
        let start = WorldStart::new(Isometry3::from_parts(Translation3::from(at), q), v, w);
        let all = moved(&can, &start, &Ask::on(Friction::coulomb(0.3)).with_restitution(0.5));
        let scale = can.scale();
        let inertia = |now: &Reading| {
            let [i1, i3] = [can.body().i1(), can.body().i3()].map(|i| scale.kilogram_square_metres(i));
            let own = now.orientation.inverse() * now.angular_velocity;
            now.orientation * Vector3::new(i1 * own.x, i1 * own.y, i3 * own.z)
        };
        let first = &all[0];
        prop_assert!((first.position.coords - at).norm() < 1e-14 && (first.velocity - v).norm() < 1e-14);
        prop_assert!((first.angular_velocity - w).norm() < 1e-12 * (1.0 + w.norm()));
        prop_assert!(first.orientation.rotation_to(&q).angle() < 1e-7);
        for now in &all[..30] {
            let t = now.time;
            let fallen = at + v * t - Vector3::z() * (0.5 * 9.80665 * t * t);
            prop_assert!((now.position.coords - fallen).norm() < 1e-12, "{:?} {}", now.position, fallen);
            prop_assert!((inertia(now) - inertia(first)).norm() < 1e-11 * inertia(first).norm());
        }
        // The orientation turns as the angular velocity says, about the axes of the world.
        for both in all[..30].windows(2) {
            let dt = both[1].time - both[0].time;
            let turned = both[0].orientation.rotation_to(&both[1].orientation).scaled_axis() / dt;
            let mean = 0.5 * (both[0].angular_velocity + both[1].angular_velocity);
            prop_assert!((turned - mean).norm() < 0.02 * w.norm_squared() * dt + 1e-9);
        }
    }

    /// A world that is turned about the vertical and moved has the same motion in it, turned and moved.
    #[test]
    fn the_motion_of_a_turned_and_moved_start_is_turned_and_moved(
        q in leaning(), w in vector(10.0), yaw in -3.0..3.0f64, by in vector(5.0), turn in -3.0..3.0f64,
    ) {
        let can = can();
        let ask = Ask::on(Friction::coulomb(0.3)).with_restitution(0.4);
        let about = |angle| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
        let at = Vector3::new(0.0, 0.0, 0.08);
        let here = WorldStart::new(Isometry3::from_parts(Translation3::from(at), q), Vector3::zeros(), w);
        let by = Vector3::new(by.x, by.y, 0.0);
        let there = Isometry3::from_parts(Translation3::from(at + by), about(yaw) * q * about(turn));
        let there = WorldStart::new(there, Vector3::zeros(), about(yaw) * w);
        // Up to the first impacts, after which a hop may amplify a rounding.
        for (a, b) in moved(&can, &here, &ask).iter().zip(&moved(&can, &there, &ask)).take(14) {
            let place = about(yaw) * a.position.coords + by;
            prop_assert!((place - b.position.coords).norm() < 1e-9, "{} {:?}", place, b.position);
            let same = about(yaw) * a.orientation * about(turn);
            prop_assert!(same.rotation_to(&b.orientation).angle() < 1e-6);
        }
    }
}

/// The axis of the ball points anywhere, and the ball rolls straight down all the same.
#[test]
fn a_ball_on_a_slope_rolls_down_from_where_it_is_put() {
    let ball = spincyl::Body::ball(0.0, 0.4, 0.4).unwrap();
    let ball = Measured::new(ball, spincyl::Scale::new(0.1, 1.0, 9.81).unwrap());
    let q = UnitQuaternion::from_euler_angles(0.4, -0.3, 2.0);
    let pose = Isometry3::from_parts(Translation3::new(1.0, 2.0, 0.1), q);
    let start = WorldStart::new(pose, Vector3::zeros(), Vector3::zeros());
    let all = moved(&ball, &start, &Ask::default().with_slope(0.3));
    for now in &all {
        let run = 0.5 * 5.0 / 7.0 * 9.81 * 0.3f64.sin() * now.time * now.time;
        assert!((now.position - Point3::new(1.0 + run, 2.0, 0.1)).norm() < 1e-12, "{now:?}");
    }
    let last = all.last().unwrap();
    assert!((last.angular_velocity.y - last.velocity.x / 0.1).abs() < 1e-12);
    let turned = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), (last.position.x - 1.0) / 0.1) * q;
    assert!(turned.rotation_to(&last.orientation).angle() < 1e-7);
}

#[test]
fn a_body_touches_the_table_or_is_above_it() {
    let can = can();
    let leans = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -1.0);
    let height = 0.025 * 1f64.sin() + 0.01 * 1f64.cos();
    let at = |z: f64, v: f64| {
        let pose = Isometry3::from_parts(Translation3::new(0.0, 0.0, z), leans);
        can.start_in_world(&WorldStart::new(pose, Vector3::z() * v, Vector3::zeros()))
    };
    assert_eq!(at(height, 0.0).unwrap().aloft, None);
    let AboveTable { height: up, lift, .. } = at(height + 0.05, 0.2).unwrap().aloft.unwrap();
    assert!(
        (can.scale().metres(up) - 0.05).abs() < 1e-15
            && (can.scale().metres_per_second(lift) - 0.2).abs() < 1e-15
    );
    assert!(at(height, 0.2).unwrap().aloft.unwrap().lift > 0.0); // it leaves the table
    assert!(at(height - 1e-3, 0.0).unwrap_err().to_string().starts_with("position"));
    assert!(at(height, -0.2).unwrap_err().to_string().starts_with("velocity"));
    assert!(at(f64::NAN, 0.0).unwrap_err().to_string().starts_with("start"));
}
