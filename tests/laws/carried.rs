//! Results of motions of a body of several circles: its axis, centre, velocity and energy, whichever circle carries
//! it, and on which part it rests.

use crate::common::{larger, wander};
use spincyl::body::Circle;
use spincyl::contact::slip::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::{AboveTable, Ask, Ending, Motion, RestsOn, Start, roll_with};
use spincyl::{Body, Slip, State};

/// A cup, a cone and a bottle, each also upside down, unequal balls, and a hemisphere, whose joint is smooth.
fn bodies() -> Vec<Body> {
    let bottle = [[1.0, 0.0], [1.0, 3.0], [0.35, 4.2], [0.35, 5.0]];
    let over: Vec<_> = bottle.iter().rev().map(|[radius, height]| [*radius, 5.0 - height]).collect();
    let circle = |radius, depth, fillet| Circle { radius, depth, fillet };
    vec![
        Body::frustum(0.7, 1.0, 2.0, None).unwrap(),
        Body::cone(2.0).unwrap(),
        Body::lathe(&bottle).unwrap(),
        Body::lathe(&over).unwrap(),
        Body::unequal_balls([1.0, 0.8], 1.0).unwrap(),
        Body::profile(&[circle(0.0, -0.375, 1.0), circle(1.0, -0.375, 0.0)], 0.259375, 0.4).unwrap(),
    ]
}

fn drawn(next: &mut impl FnMut() -> f64) -> Start {
    let mut number = || 2.0 * next() - 1.0;
    let [w1, w2, w3, along, across] = [(); 5].map(|()| number());
    Start::from(State { theta: 0.2 + 2.7 * next(), w1, w2, w3 }).with_slip(Slip::new(along, across))
}

/// Motions on all kinds of tables, at groups of three times close together, for numerical derivatives.
fn motions(body: &Body, next: &mut impl FnMut() -> f64) -> Vec<Motion> {
    let times: Vec<_> = (0..20).flat_map(|k| [0.0, 1e-5, 2e-5].map(|by| 0.2 * f64::from(k) + by)).collect();
    let loss = Losses::NONE.with(Law::DryContour, 0.02);
    let rough = Ask::on(Friction::coulomb(0.2));
    let asks = [
        rough,
        rough.with_restitution(0.4),
        rough.with_restitution(0.0).with_losses(loss),
        Ask::default().with_restitution(0.0),
        Ask::default(),
    ];
    let all = asks.into_iter().filter_map(|ask| {
        let start = if ask == asks[3] || ask == asks[4] {
            drawn(next).with_slip(Slip::default())
        } else {
            drawn(next)
        };
        roll_with(body, start, &times, &ask.with_pose().with_force(), || true).ok().flatten()
    });
    all.collect()
}

#[test]
fn centre_axis_and_velocity_are_those_of_the_body_whichever_circle_carries_it() {
    let (mut next, mut carried) = (wander(8), [0; 3]);
    for body in bodies() {
        let circles = body.circles();
        for m in (0..12).flat_map(|_| motions(&body, &mut next)) {
            let struck: Vec<_> =
                m.path.iter().flat_map(|path| path.impacts.iter().map(|hit| hit.time)).collect();
            let began =
                m.path.iter().flat_map(|path| path.phases.iter().map(|phase| phase.time)).chain(struck);
            let kinks: Vec<_> = began.collect();
            let all: Vec<_> = m.samples().collect();
            let first = all.first().and_then(|now| now.pose);
            let begins = first.filter(|_| m.times[0] == 0.0);
            assert!(begins.is_none_or(|pose| pose.phi.rest.abs() < 1e-15), "{body:?}, {begins:?}");
            for now in &all {
                carried[usize::from(now.rim)] += 1;
                let axis = now.orientation().unwrap() * spincyl::nalgebra::Vector3::z();
                assert!((now.axis_up() - axis.z).abs() < 1e-14, "{body:?}");
                assert!((now.state.theta.cos() - axis.z).abs() < 1e-14, "{body:?}");
                // The lowest point of the circle that carries is as high as is told, and below it lies the contact point.
                let [centre, down] =
                    [now.centre(&body).unwrap().coords, spincyl::nalgebra::Vector3::new(0.0, 0.0, -1.0)];
                let Circle { radius, depth, fillet } = circles[usize::from(now.rim)];
                let out = (down - axis * axis.dot(&down)).normalize();
                let lowest = centre - axis * depth + out * radius + down * fillet;
                let pose = now.pose.unwrap();
                let [off, aside] =
                    [lowest.z - now.aloft.height, (lowest.xy() - pose.contact_point.coords).norm()];
                // Near a pole the direction to the lowest point is known less well.
                let close = 1e-13 * (1.0 + 0.1 / now.state.theta.sin());
                assert!(off.abs() < close && aside < close, "{off}, {aside}, {body:?}, {now:?}");
            }
            for three in all.chunks_exact(3) {
                let (first, last) = (three[0].time, three[2].time);
                if kinks.iter().any(|t| first <= *t && *t <= last) {
                    continue;
                }
                let [from, to] = [0, 2].map(|k| three[k].centre(&body).unwrap());
                let [v, moved] = [three[1].velocity(&body).unwrap(), (to - from) / (last - first)];
                assert!((v - moved).norm() < 1e-6 * (1.0 + v.norm()), "{body:?}, {v}, {moved}");
            }
            let spent = |i: usize| {
                let Some(path) = &m.path else { return 0.0 };
                let hits = path.impacts.iter().filter(|hit| hit.time <= m.times[i]).map(|hit| hit.lost);
                path.dissipated[i] + path.work_lost.get(i).copied().unwrap_or_default() + hits.sum::<f64>()
            };
            let whole = |i: usize| all[i].energy(&body).unwrap() + spent(i);
            let most = (0..all.len()).map(|i| (whole(i) - whole(0)).abs()).fold(0.0, larger);
            assert!(most <= 1e-11 + 20.0 * m.error, "{most}, {}, {body:?}", m.error);
        }
    }
    assert!(carried.iter().all(|count| *count > 300), "{carried:?}");
}

#[test]
fn a_cup_rests_on_its_face_on_its_other_face_or_on_two_circles() {
    let losses = Losses::NONE.with(Law::RollingResistance, 0.02).with(Law::Drilling, 0.02);
    let ask = Ask::on(Friction::coulomb(0.4)).with_restitution(0.0).with_losses(losses);
    let falls = |body: &Body, theta: f64| {
        let start =
            Start::from(State { theta, w1: 0.0, w2: 0.0, w3: 0.0 }).with_aloft(AboveTable::new(0.1, 0.0));
        let m = roll_with(body, start, &[0.0, 400.0], &ask, || true).unwrap().unwrap();
        (m.rests_on(body), m.ending())
    };
    let [cup, cone, bottle, over, ..] = &bodies()[..] else { unreachable!() };
    assert_eq!(falls(cup, 0.2), (RestsOn::Face, Ending::Stops));
    assert_eq!(falls(cup, 2.9), (RestsOn::OtherFace, Ending::Stops));
    assert_eq!(falls(cone, 2.9), (RestsOn::OtherFace, Ending::Stops));
    // A bottle lies on the border of its first two circles, and upside down on that of the last two.
    for body in [cup, cone, bottle, over] {
        assert_eq!(falls(body, 1.5).0, RestsOn::Side, "{body:?}");
    }
    assert!(over.theta_end() < 1.5 && bottle.theta_end() > 1.5);
    // At a border with one circle up nothing rests: the bottle falls on from the shoulder to its side.
    let still = |body: &Body, theta: f64, ask: Ask| {
        let start = State { theta, w1: 0.0, w2: 0.0, w3: 0.0 };
        roll_with(body, start, &[0.0], &ask, || true).unwrap().unwrap().rests_on(body)
    };
    assert_eq!(still(cup, cup.theta_end(), Ask::default()), RestsOn::Side);
    assert_eq!(still(cup, 1.2, Ask::default()), RestsOn::None);
}
