//! Bodies made from their outline: the moments of uniform solids of revolution, and the circles on which they stand.

use crate::common::wander;
use spincyl::body::{Circle, CircleBorder};
use spincyl::contact::{Contact, Friction};
use spincyl::ensemble::{Job, MotionColumns, MotionOutput, roll as roll_many};
use spincyl::motion::{Ask, Method, Start, roll_with};
use spincyl::{Body, State, stability, steady};
use std::f64::consts::{FRAC_PI_2, PI};

/// Bodies, each with the inclination theta_k at which two circles touch, the distance D of the apex, the height Z,
/// the levers g of both contacts, and the moment J about the line through the apex: from another program, to ten
/// digits.
fn known() -> Vec<(Body, [f64; 6])> {
    vec![
        (
            Body::frustum(0.7, 1.0, 2.0, None).unwrap(),
            [1.4219063792, 2.0223748416, 0.8578684184, 1.0002481591, -1.0221266825, 1.1187322738],
        ),
        (
            Body::cone(2.0).unwrap(),
            [1.1071487178, 2.2360679775, 0.6708203932, 1.3416407865, -0.8944271910, 0.75],
        ),
        (
            Body::cone(0.5).unwrap(),
            [0.4636476090, 1.1180339887, 0.3354101966, 0.1677050983, -0.9503288904, 0.3],
        ),
        (
            Body::frustum(0.9, 1.0, 0.5, None).unwrap(),
            [1.3734007669, 0.5099019514, 0.9332703719, 0.0772342971, -0.4326676542, 1.3164066846],
        ),
        (
            Body::unequal_balls([1.0, 0.8], 1.0).unwrap(),
            [1.6821373411, 1.7888543820, 0.9322751323, 0.6057496320, -1.1831047500, 1.2293333333],
        ),
    ]
}

#[test]
fn uniform_bodies_of_two_circles_have_the_numbers_that_are_known_of_them() {
    for (body, told) in known() {
        let ([CircleBorder { theta, span, .. }], [low, high]) =
            (body.borders()[..].try_into().unwrap(), body.circles()[..].try_into().unwrap());
        let (s, c) = theta.sin_cos();
        let lever = |circle: Circle| circle.depth * s - circle.radius * c;
        let height = |circle: Circle| circle.depth * c + circle.radius * s + circle.fillet;
        let whole = body.i1() * c * c + body.i3() * s * s + height(low) * height(low);
        let found = [theta, span, height(low), lever(low), lever(high), whole];
        for (found, told) in found.into_iter().zip(told) {
            assert!((found - told).abs() < 6e-11, "{found}, {told}, {body:?}");
        }
        assert!((height(low) - height(high)).abs() < 1e-15);
        assert!((body.theta_end() - theta).abs() < 1e-15);
    }
    let close = |body: Body, [i1, i3]: [f64; 2]| {
        assert!((body.i1() - i1).abs() < 6e-11 && (body.i3() - i3).abs() < 6e-11, "{body:?}");
    };
    let all = known();
    close(all[0].0, [0.5124535247, 0.3798767123]);
    close(all[3].0, [0.2474379553, 0.4533321033]);
    close(all[4].0, [1.0768616780, 0.3512380952]);
}

#[test]
fn the_narrow_end_rises_where_the_table_no_longer_presses_it() {
    // Circle of the centre about the apex, rate, and friction, from another program; and what both contacts carry then.
    let told = [
        [5.719123, 0.3701987166, 0.7838],
        [1.341641, 0.7721947902, 0.8],
        [0.167705, 2.5170470668, 1.0625],
        [4.666352, 0.2563876920, 0.3067],
        [8.338522, 0.2347141401, 0.4594],
    ];
    for ((body, _), [radius, rate, friction]) in known().into_iter().zip(told) {
        let apex = body.apex(0).unwrap();
        assert!((apex.radius - radius).abs() < 6e-7 && (apex.rate - rate).abs() < 6e-11, "{apex:?}");
        assert!((apex.friction - friction).abs() < 6e-5 && body.rests() == [0], "{apex:?}");
        let [CircleBorder { theta, span, .. }] = body.borders()[..] else { panic!("{body:?}") };
        let (s, c) = theta.sin_cos();
        let far = apex.contacts[1] - apex.contacts[0];
        assert!((far.abs() - span).abs() < 1e-12 * span, "the contacts are on one line with the apex");
        // Moments about the contact of the wide end: weight, centrifugal force, and the change of the spin.
        let wide = if c > 0.0 { 1 } else { 0 };
        let height = body.circles()[wide].height(theta);
        let (w, turns) = (apex.rate * s / c, apex.rate);
        let spin = turns * w * (body.i1() * c * c + body.i3() * s * s);
        let arm = apex.contacts[wide] - apex.radius;
        let push = height * apex.radius * turns * turns;
        assert!((arm - push - spin.abs()).abs() < 1e-9, "{arm}, {push}, {spin}");
        assert_eq!(body.apex(1), None);
    }
    let straight = Body::solid(2.5).unwrap().apex(0).unwrap();
    assert!(straight.radius == f64::INFINITY && straight.rate == f64::INFINITY && straight.friction.is_nan());
    // A smooth joint, and a shoulder that never rests on the table.
    let bowl = Body::profile(
        &[
            Circle { radius: 0.0, depth: -0.375, fillet: 1.0 },
            Circle { radius: 1.0, depth: -0.375, fillet: 0.0 },
        ],
        0.26,
        0.4,
    );
    assert_eq!((bowl.as_ref().unwrap().apex(0), bowl.unwrap().rests()), (None, vec![]));
}

#[test]
fn a_wall_of_no_thickness_is_the_limit_of_a_thick_one_and_equal_ends_make_a_tube() {
    let mut next = wander(3);
    for _ in 0..50 {
        let (bottom, top, height) = (0.2 + next(), 0.2 + next(), 0.1 + 3.0 * next());
        let of = |wall| Body::frustum(bottom, top, height, wall).unwrap();
        let (thin, thick) = (of(Some(0.0)), of(Some(1e-7)));
        assert!((thin.i1() / thick.i1() - 1.0).abs() < 1e-5 && (thin.i3() / thick.i3() - 1.0).abs() < 1e-5);
        // A wall as thick as the narrow end is wide leaves a hole that begins at a point.
        let most = bottom.min(top);
        let through =
            Body::lathe(&[[bottom, 0.0], [top, height], [top - most, height], [bottom - most, 0.0]]);
        let (cut, through) = (of(Some(most)), through.unwrap());
        assert!((cut.i1() - through.i1()).abs() < 1e-12 && (cut.i3() - through.i3()).abs() < 1e-12);
        let bore = 0.9 * next();
        let (tube, same) =
            (Body::tube(height, bore).unwrap(), Body::frustum(1.0, 1.0, 2.0 * height, Some(1.0 - bore)));
        let same = same.unwrap();
        assert!((tube.i1() - same.i1()).abs() < 1e-13 * tube.i1() && (tube.i3() - same.i3()).abs() < 1e-13);
        assert_eq!((same.theta_end(), same.borders().len()), (tube.theta_end(), 1));
    }
}

#[test]
fn an_outline_has_the_moments_of_its_thin_slices_and_the_circles_of_its_hull() {
    let mut next = wander(8);
    for _ in 0..20 {
        // A cup with a floor: out and up, over its rim, and down inside.
        let (foot, rim, height) = (0.5 + next(), 0.5 + next(), 1.0 + next());
        let (thick, floor) = (0.1 + 0.2 * next(), 0.1 + 0.3 * next());
        let inside = |z: f64| foot + (rim - foot) * z / height - thick;
        let line = [
            [0.0, 0.0],
            [foot, 0.0],
            [rim, height],
            [rim - thick, height],
            [inside(floor), floor],
            [0.0, floor],
        ];
        let cup = Body::lathe(&line).unwrap();
        let unit = foot.max(rim);
        let slices = 20_000;
        let step = height / f64::from(slices);
        let mut sums = [0.0; 4];
        for k in 0..slices {
            let z = step * (f64::from(k) + 0.5);
            let (r, b) = (inside(z) + thick, if z > floor { inside(z) } else { 0.0 });
            let m = step * (r * r - b * b);
            let axial = 0.5 * m * (r * r + b * b);
            [m, m * z, axial, 0.5 * axial + m * z * z].iter().zip(&mut sums).for_each(|(x, sum)| *sum += x);
        }
        let [m, mz, axial, across] = sums;
        let centre = mz / m;
        let per = 1.0 / (m * unit * unit);
        assert!((cup.i3() / (axial * per) - 1.0).abs() < 1e-4);
        assert!((cup.i1() / ((across - m * centre * centre) * per) - 1.0).abs() < 1e-4);
        let [low, high] = cup.circles()[..] else { panic!("{cup:?}") };
        let off =
            [low.radius - foot / unit, high.radius - rim / unit, low.depth - high.depth - height / unit];
        assert!(off.into_iter().all(|x| x.abs() < 1e-14), "{cup:?}");
        // Points along straight pieces change nothing.
        let halves: Vec<[f64; 2]> = line
            .windows(2)
            .flat_map(|p| [p[0], [0, 1].map(|i| 0.5 * (p[0][i] + p[1][i]))])
            .chain([line[5]])
            .collect();
        let same = Body::lathe(&halves).unwrap();
        assert!((same.i1() - cup.i1()).abs() < 1e-13 && (same.i3() - cup.i3()).abs() < 1e-13);
        assert_eq!(same.circles().len(), 2);
    }
}

#[test]
fn a_bottle_and_a_double_cone_stand_on_every_circle_of_their_hull() {
    let bottle =
        Body::lathe(&[[1.0, 0.0], [1.0, 3.0], [0.4, 4.0], [0.3, 4.0], [0.3, 5.0], [0.35, 5.0], [0.35, 5.2]]);
    let bottle = bottle.unwrap();
    assert_eq!(bottle.circles().iter().map(|circle| circle.radius).collect::<Vec<_>>(), [1.0, 1.0, 0.35]);
    let ends: Vec<f64> = bottle.borders().iter().map(|border| border.theta).collect();
    assert_eq!(ends[0], FRAC_PI_2);
    assert!((ends[1] - (FRAC_PI_2 + 0.65f64.atan2(2.2))).abs() < 1e-14);
    let double = Body::lathe(&[[0.0, -1.0], [1.0, 0.0], [0.0, 1.0]]).unwrap();
    let [tip, rim, top] = double.circles()[..] else { panic!("{double:?}") };
    assert_eq!([tip.radius, rim.radius, top.radius], [0.0, 1.0, 0.0]);
    assert!(rim.depth.abs() < 1e-15 && (tip.depth - 1.0).abs() < 1e-15);
    let quarter = std::f64::consts::FRAC_PI_4;
    for (CircleBorder { theta, span, .. }, told) in double.borders().into_iter().zip([quarter, 3.0 * quarter])
    {
        assert!((theta - told).abs() < 1e-15 && (span - 2f64.sqrt()).abs() < 1e-15);
    }
    // The integrals of r^2, r^4 and r^2 z^2 with r = 1 - |z| are 2/3, 2/5 and 1/15.
    assert!((double.i3() - 0.3).abs() < 1e-15 && (double.i1() - 0.25).abs() < 1e-15);
}

#[cfg(feature = "serde")]
#[test]
fn a_body_of_several_circles_comes_back_from_a_file_to_the_last_bit() {
    use serde_json::{from_str, json, to_string};
    for (body, _) in known() {
        assert_eq!(from_str::<Body>(&to_string(&body).unwrap()).unwrap(), body);
    }
    let plain = to_string(&Body::solid(2.5).unwrap()).unwrap();
    assert!(!plain.contains("circles"), "{plain}");
    let cup = |depth: f64| {
        json!({"ell": 1.1, "i1": 0.5, "i3": 0.4, "circles": [
            {"radius": 0.7, "depth": depth, "fillet": 0.0}, {"radius": 1.0, "depth": -0.9, "fillet": 0.0}]})
    };
    assert_eq!(from_str::<Body>(&cup(1.1).to_string()).unwrap().circles().len(), 2);
    for (file, why) in [
        (cup(1.2), "ell = 1.1: expected the number of the first circle in `circles`"),
        (cup(-1.2), "circles = "),
        (
            json!({"ell": 0.0, "i1": 0.5, "i3": 0.4, "circles": []}),
            "circles = 0.0: expected at least one circle",
        ),
    ] {
        let said = from_str::<Body>(&file.to_string()).unwrap_err().to_string();
        assert!(said.contains(why), "{said}");
    }
}

#[test]
fn outlines_that_no_body_has_are_refused_by_name() {
    let said = |body: Result<Body, spincyl::Error>| body.unwrap_err().to_string();
    let nan = f64::NAN;
    for (body, name) in [
        (Body::frustum(-1.0, 1.0, 1.0, None), "bottom = -1.0"),
        (Body::frustum(1.0, nan, 1.0, None), "top = NaN"),
        (Body::frustum(0.0, 0.0, 1.0, None), "top = 0.0"),
        (Body::frustum(1.0, 1.0, 0.0, None), "height = 0.0"),
        (Body::frustum(0.5, 1.0, 1.0, Some(0.6)), "wall = 0.6"),
        (Body::frustum(0.5, 1.0, 1.0, Some(-0.1)), "wall = -0.1"),
        (Body::cone(-2.0), "height = -2.0"),
        (Body::cone(nan), "height = NaN"),
        (Body::lathe(&[]), "points"),
        (Body::lathe(&[[1.0, 0.0], [1.0, 0.0]]), "points"),
        (Body::lathe(&[[1.0, 1.0], [1.0, 0.0]]), "points"),
        (Body::lathe(&[[-1.0, 0.0], [1.0, 1.0]]), "points = -1.0"),
        (Body::lathe(&[[1.0, nan], [1.0, 1.0]]), "points = NaN"),
        (Body::unequal_balls([1.0, 0.0], 1.0), "radii = 0.0"),
        (Body::unequal_balls([1.0, nan], 1.0), "radii = NaN"),
        (Body::unequal_balls([1.0, 0.5], 0.9), "separation = 0.9"),
    ] {
        assert!(said(body).starts_with(name), "{name}");
    }
    let circle = |radius, depth, fillet| Circle { radius, depth, fillet };
    let profile = |circles: &[Circle], i1, i3| said(Body::profile(circles, i1, i3));
    let (low, high) = (circle(0.7, 1.0, 0.0), circle(1.0, -1.0, 0.0));
    for (said, name) in [
        (profile(&[], 0.5, 0.4), "circles = 0.0"),
        (profile(&[low, circle(-1.0, -1.0, 0.0)], 0.5, 0.4), "circles = -1.0"),
        (profile(&[low, circle(1.0, -1.0, -0.1)], 0.5, 0.4), "circles = -0.1"),
        (profile(&[low, circle(1.0, nan, 0.0)], 0.5, 0.4), "circles = NaN"),
        (profile(&[circle(0.0, 0.0, 1.0), circle(0.0, -0.1, 0.5)], 0.5, 0.4), "circles = 1.0"),
        (profile(&[high, low], 0.5, 0.4), "circles = "),
        (profile(&[low, high], 0.5, 1.1), "i3 = 1.1, i1 = 0.5"),
        (profile(&[low, high], 1e-7, 1e-7), "i1 = 1e-7"),
    ] {
        assert!(said.starts_with(name), "{name}: {said}");
    }
}

#[test]
fn steady_states_of_a_rate_their_folds_and_their_stability_do_not_depend_on_the_unit_of_length() {
    const UNIT: f64 = 4.0;
    let (mut next, mut seen) = (wander(9), [0; 5]);
    for k in 0..400 {
        let fillet = [0.0, 0.3, 0.8, 1.0][k % 4];
        let depth = (next() - 0.4) * 2.0;
        let i3 = 0.2 + next();
        // Now and then equal moments, for which the equations have a factor.
        let i1 = if k % 7 == 0 { i3 } else { i3 * (0.51 + next()) };
        let of = |unit: f64| {
            let circle = Circle { radius: unit * (1.0 - fillet), depth: unit * depth, fillet: unit * fillet };
            Body::profile(&[circle], unit * unit * i1, unit * unit * i3).unwrap()
        };
        let (body, large) = (of(1.0), of(UNIT));
        let rate = [0.3 + 2.0 * next(), 1.0][usize::from(k % 5 == 0 && k % 7 != 0)];
        // The range of a sharp rim of radius 1 ends at a right angle.
        let most = if fillet == 0.0 { FRAC_PI_2 - 1e-9 } else { PI };
        let same = |here: &[f64], there: &[f64]| {
            let [here, there] =
                [here, there].map(|all| all.iter().filter(|x| **x < most).collect::<Vec<_>>());
            here.len() == there.len() && here.iter().zip(there).all(|(a, b)| (*a - b).abs() < 1e-9)
        };
        let pairs = [
            (steady::inclinations(&body, rate), steady::inclinations(&large, 2.0 * rate)),
            (steady::folds(&body), steady::folds(&large)),
            (steady::ridge(&body), steady::ridge(&large)),
            (stability::boundaries(&body, Contact::Rolling), stability::boundaries(&large, Contact::Rolling)),
            (stability::boundaries(&body, Contact::Smooth), stability::boundaries(&large, Contact::Smooth)),
        ];
        // With equal moments the others have a double zero at the balance, which rounding may hide or show.
        let certain = if body.excess() == 0.0 { 2 } else { pairs.len() };
        for (kind, (here, there)) in pairs.iter().enumerate().take(certain) {
            assert!(same(here, there), "{kind}: {here:?} {there:?} {body:?} {rate}");
            seen[kind] += usize::from(!here[0].is_nan());
        }
        let known = |body: &Body, rate: f64| steady::count(body, rate).is_some();
        assert_eq!(known(&body, rate), known(&large, 2.0 * rate));
        for theta in steady::inclinations(&body, rate).into_iter().filter(|theta| !theta.is_nan()) {
            let found = steady::rate(&body, theta);
            assert!(
                (found - rate).abs() < 1e-9 * rate || body.excess() == 0.0,
                "{found} {rate} {theta} {body:?}"
            );
        }
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

#[test]
fn cups_among_tubes_move_in_a_sweep_as_they_do_alone() {
    let mut next = wander(11);
    let mut pairs = Vec::new();
    for k in 0..60 {
        let body = match k % 3 {
            0 => Body::frustum(0.7, 1.0, 0.5 + 2.0 * next(), None),
            1 => Body::tube(0.5 + next(), 0.3),
            _ => Body::unequal_balls([0.8, 1.0], 1.0),
        };
        let [w1, w2, w3] = [(); 3].map(|()| 2.0 * next() - 1.0);
        pairs.push((body.unwrap(), State { theta: 0.3 + 1.2 * next(), w1, w2, w3 }));
    }
    let columns: MotionColumns = pairs.iter().copied().collect();
    let (times, mut ended) = ([0.5, 2.0], 0);
    let hits = Ask::on(Friction::coulomb(0.3)).with_restitution(0.2);
    for ask in [Ask::default(), Ask::on(Friction::coulomb(0.3)), hits] {
        let (mut error, mut method, mut status) = (vec![0.0; 60], vec![0; 60], vec![0; 60]);
        let mut last = [(); 4].map(|()| vec![f64::NAN; 60]);
        let out = MotionOutput::new(&mut error, &mut method, &mut status)
            .with_last(last.each_mut().map(Vec::as_mut_slice));
        let job = Job::new(&times).with_ask(ask).with_tol(1e-12);
        assert!(roll_many(&columns.starts(), &job, out, 2, |_| true).unwrap());
        for (i, (body, y)) in pairs.iter().enumerate() {
            let rubs = ask != Ask::default();
            let alone = if rubs { ask.with_method(Method::Tolerance(1e-12)) } else { ask };
            let m = roll_with(body, Start::from(*y), &times, &alone, || true).unwrap().unwrap();
            assert_eq!(status[i], m.ending() as u8, "{i} {body:?}");
            let there = m.event.map_or_else(|| m.states[1], |event| event.state);
            for (x, column) in <[f64; 4]>::from(there).iter().zip(&last) {
                assert!((x - column[i]).abs() < 1e-7, "{i}: {x} {} {body:?}", column[i]);
            }
            ended += usize::from(m.event.is_some());
        }
    }
    assert!((10..170).contains(&ended), "{ended}");
}
