//! Bodies put together from coaxial parts.

use crate::common::cases;
use proptest::prelude::*;
use spincyl::Body;
use spincyl::body::parts::{Amount, Assembled, BodyPart, Form, assembled};
use std::f64::consts::{FRAC_PI_2, PI};

const STEEL: Amount = Amount::Density(7800.0);

fn part(form: Form, amount: Amount) -> BodyPart {
    BodyPart { form, amount }
}

fn cylinder(radius: f64, bore: f64, ends: [f64; 2]) -> Form {
    Form::Solid { radii: [radius; 2], bores: [bore; 2], ends, fillet: 0.0 }
}

fn ball(radius: f64, bottom: f64) -> Form {
    Form::Ball { radius, hollow: 0.0, centre: bottom + radius, ends: [bottom, bottom + 2.0 * radius] }
}

fn whole(parts: &[BodyPart]) -> Assembled {
    assembled(parts).unwrap()
}

#[track_caller]
fn same(found: &Assembled, body: &Body, within: f64) {
    let numbers = |b: &Body| [b.ell(), b.i1(), b.i3(), b.fillet(), b.theta_end()];
    for (a, b) in numbers(&found.body).into_iter().zip(numbers(body)) {
        assert!((a - b).abs() <= within * b.abs().max(1.0), "{found:?} {body:?}");
    }
}

#[test]
fn a_tube_of_one_part_or_of_many_slices_is_the_tube() {
    for (ell, bore) in [(2.5, 0.0), (6.0, 0.8), (0.1, 0.5)] {
        let long = 2.0 * 0.01 * ell;
        let tube = Body::tube(ell, bore).unwrap();
        let one = whole(&[part(cylinder(0.01, 0.01 * bore, [0.3, 0.3 + long]), STEEL)]);
        same(&one, &tube, 3e-14);
        assert!((one.mass - 7800.0 * PI * 1e-4 * (1.0 - bore * bore) * long).abs() < 1e-14);
        let slices: Vec<BodyPart> = (0..7)
            .map(|k| [k, k + 1].map(|k| long * f64::from(k) / 7.0))
            .map(|ends| part(cylinder(0.01, 0.01 * bore, ends), STEEL))
            .collect();
        same(&whole(&slices), &tube, 3e-14);
        let filled = [part(cylinder(0.01, 0.0, [0.0, long]), STEEL)];
        assert!(bore == 0.0 || whole(&filled).mass > one.mass);
    }
}

#[test]
fn a_thin_wall_is_the_limit_of_a_thick_one() {
    let thin = 1e-7;
    let pairs = [
        (Form::Wall { radii: [1.0, 2.0], ends: [0.0, 3.0] }, {
            let inside = |r: f64| r - thin * 10f64.sqrt() / 3.0;
            Form::Solid {
                radii: [1.0, 2.0],
                bores: [inside(1.0), inside(2.0)],
                ends: [0.0, 3.0],
                fillet: 0.0,
            }
        }),
        (Form::Wall { radii: [0.2, 2.0], ends: [0.0, 0.0] }, cylinder(2.0, 0.2, [0.0, thin])),
        (
            Form::Shell { radius: 1.0, centre: 1.0, ends: [0.0, 1.5] },
            Form::Ball { radius: 1.0, hollow: 1.0 - thin, centre: 1.0, ends: [0.0, 1.5] },
        ),
    ];
    for (wall, thick) in pairs {
        let [a, b] = [wall, thick].map(|form| whole(&[part(form, Amount::Mass(2.0))]));
        assert!((a.centre - b.centre).abs() < 1e-6 && a.mass == b.mass);
        for (a, b) in [(a.body.i1(), b.body.i1()), (a.body.i3(), b.body.i3())] {
            assert!((a - b).abs() < 1e-6, "{a} {b}");
        }
    }
}

#[test]
fn two_balls_are_hurricane_balls_and_the_second_one_of_another_size_lands_elsewhere() {
    let balls = whole(&[part(ball(0.01, 0.0), STEEL), part(ball(0.01, 0.02), STEEL)]);
    same(&balls, &Body::balls(1.0).unwrap(), 1e-15);
    assert_eq!(balls.body.theta_end(), FRAC_PI_2);
    // Of 18 and 14 mm: both touch where (R1 + R2) cos theta = R2 - R1.
    let (large, small) = (0.009, 0.007);
    let mixed = whole(&[part(ball(large, 0.0), STEEL), part(ball(small, 2.0 * large), STEEL)]);
    let lands = ((small - large) / (small + large)).acos();
    assert!((mixed.body.theta_end() - lands).abs() < 1e-15 && mixed.radius == large);
    let [m, n] = [large, small].map(|r: f64| r.powi(3));
    let centre = (m * large + n * (2.0 * large + small)) / (m + n);
    assert!((mixed.centre - centre).abs() < 1e-17);
    let axial = 0.4 * (m * large * large + n * small * small) / (m + n) / (large * large);
    assert!((mixed.body.i3() - axial).abs() < 1e-15);
    let apart = m * n / (m + n) * (large + small).powi(2) / (m + n) / (large * large);
    assert!((mixed.body.i1() - axial - apart).abs() < 1e-15);
}

#[test]
fn it_stands_on_its_lowest_edge_and_ends_where_the_next_one_touches() {
    // A top: a stem of 1 mm, a disk of 20 mm that begins 12 mm higher.
    let stem = part(cylinder(1.0, 0.0, [0.0, 30.0]), STEEL);
    let disk = part(cylinder(20.0, 1.0, [12.0, 16.0]), STEEL);
    let top = whole(&[stem, disk]);
    assert_eq!((top.radius, top.body.fillet()), (1.0, 0.0));
    assert!((top.body.theta_end() - (12.0f64 / 19.0).atan()).abs() < 1e-15);
    // A ball at the tip: 12 sin of the lean less ...: the disk touches where 20 s - 12 c = -1 c + 1.
    let tipped = whole(&[part(ball(1.0, 0.0), STEEL), disk]);
    assert_eq!((tipped.radius, tipped.body.fillet()), (1.0, 1.0));
    let theta = tipped.body.theta_end();
    assert!((20.0 * theta.sin() - 11.0 * theta.cos() - 1.0).abs() < 1e-13);
    // A cup on its narrow end lands on the wide one; upside down it stands on the wide one and lands on the other.
    let cup = |low: f64, high: f64| Form::Wall { radii: [low, high], ends: [0.0, 90.0] };
    let lands = |low, high| whole(&[part(cup(low, high), STEEL)]).body.theta_end();
    assert!((lands(25.0, 35.0) - (90.0f64 / 10.0).atan()).abs() < 1e-14);
    assert!((lands(35.0, 25.0) - (PI - (90.0f64 / 10.0).atan())).abs() < 1e-14);
    // Half a ball on its round side goes on to its edge, and then on this edge, which is another body.
    let half = Form::Ball { radius: 1.0, hollow: 0.0, centre: 1.0, ends: [0.0, 1.0] };
    let bowl = whole(&[part(half, STEEL)]);
    assert!((bowl.body.theta_end() - FRAC_PI_2).abs() < 1e-15 && bowl.body.theta_end() < FRAC_PI_2);
    assert!((bowl.body.ell() + 0.375).abs() < 1e-15, "its centre of mass is 3/8 R below the middle");
    // The other half on its flat side goes on to its round side: a ball that is tangential to the edge.
    let dome = Form::Shell { radius: 1.0, centre: 0.0, ends: [0.0, 1.0] };
    assert!((whole(&[part(dome, STEEL)]).body.theta_end() - FRAC_PI_2).abs() < 1e-7);
    // A flatter cap begins to touch with its round side where the tangent of its edge lies on the table.
    let low = Form::Ball { radius: 1.0, hollow: 0.0, centre: -0.6, ends: [0.0, 0.4] };
    assert!((whole(&[part(low, STEEL)]).body.theta_end() - (PI - 0.6f64.acos())).abs() < 1e-7);
    // A rounded coin with a milled rim keeps its fillet.
    let coin = Form::Solid { radii: [12.0; 2], bores: [0.0; 2], ends: [0.0, 2.0], fillet: 0.5 };
    let milled =
        whole(&[part(coin, STEEL), part(Form::Ring { radius: 11.9, height: 1.0 }, Amount::Mass(1e5))]);
    assert!((milled.body.fillet() - 0.5 / 12.0).abs() < 1e-15 && milled.body.theta_end() == FRAC_PI_2);
}

#[test]
fn another_rim_at_the_same_height_but_not_at_the_same_distance_is_no_second_rim() {
    let half_full = [
        part(Form::Wall { radii: [33.0; 2], ends: [0.0, 115.0] }, Amount::Density(0.002)),
        part(cylinder(32.9, 0.0, [0.0, 57.0]), Amount::Density(1e-6)),
    ];
    let can = whole(&half_full);
    assert_eq!(can.body.theta_end(), FRAC_PI_2.next_down());
    let empty = whole(&half_full[..1]);
    assert_eq!(empty.body.theta_end(), FRAC_PI_2);
}

#[test]
fn what_is_no_body_is_refused_by_name() {
    let named = |form, amount| assembled(&[part(form, amount)]).unwrap_err().to_string();
    for (said, form, amount) in [
        ("ends", cylinder(1.0, 0.0, [1.0, 1.0]), STEEL),
        ("bores", cylinder(1.0, 1.1, [0.0, 1.0]), STEEL),
        ("radii", cylinder(-1.0, 0.0, [0.0, 1.0]), STEEL),
        ("radii", cylinder(f64::NAN, 0.0, [0.0, 1.0]), STEEL),
        ("density", cylinder(1.0, 0.0, [0.0, 1.0]), Amount::Density(-1.0)),
        ("mass", cylinder(1.0, 0.0, [0.0, 1.0]), Amount::Mass(f64::NAN)),
        ("hollow", Form::Ball { radius: 1.0, hollow: 2.0, centre: 0.0, ends: [-1.0, 1.0] }, STEEL),
        ("ends", Form::Ball { radius: 1.0, hollow: 0.0, centre: 0.0, ends: [-1.1, 1.0] }, STEEL),
        ("fillet", Form::Solid { radii: [1.0; 2], bores: [0.0; 2], ends: [0.0, 1.0], fillet: 0.6 }, STEEL),
        ("parts", Form::Ring { radius: 0.0, height: 1.0 }, Amount::Mass(1.0)),
        ("parts", cylinder(1.0, 0.0, [0.0, 1.0]), Amount::Mass(0.0)),
        ("height", cylinder(1.0, 0.0, [1e9, 1e9 + 1.0]), Amount::Mass(1.0)),
        ("parts", Form::Wall { radii: [0.0, 1.0], ends: [0.0, 1.0] }, Amount::Mass(1.0)),
        ("parts", cylinder(1.0, 1.0, [0.0, 1.0]), Amount::Mass(1.0)),
    ] {
        assert!(named(form, amount).starts_with(said), "{said}: {}", named(form, amount));
    }
    assert!(assembled(&[]).unwrap_err().to_string().starts_with("parts"));
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn parts_of_any_forms_have_the_moments_of_their_slices(
        radii in [0.2..2.0f64, 0.2..2.0], share in 0.0..0.95f64, from in -3.0..3.0f64, long in 0.1..4.0f64,
        cut in [0.0..0.5f64, 0.5..1.0], high in 3.0..9.0f64,
    ) {
        let radius = radii[1];
        let solid = Form::Solid {
            radii, bores: radii.map(|r| share * r), ends: [from, from + long], fillet: 0.0,
        };
        let ends = cut.map(|x| high - radius + 2.0 * radius * x);
        let slice = Form::Ball { radius, hollow: share * radius, centre: high, ends };
        let found = whole(&[part(solid, Amount::Density(2.0)), part(slice, Amount::Density(0.7))]);
        // By many thin disks.
        let disks = 40_000;
        let mut sums = [0.0; 4];
        for (density, [low, up], square) in [
            (2.0, [from, from + long], &(|z: f64| {
                let r = radii[0] + (radii[1] - radii[0]) * (z - from) / long;
                [r * r, share * share * r * r]
            }) as &dyn Fn(f64) -> [f64; 2]),
            (0.7, ends, &|z: f64| {
                let far = (z - high) * (z - high);
                [radius * radius - far, (share * share * radius * radius - far).max(0.0)]
            }),
        ] {
            let step = (up - low) / f64::from(disks);
            for k in 0..disks {
                let z = low + step * (f64::from(k) + 0.5);
                let [outer, inner] = square(z);
                let m = density * PI * (outer - inner) * step;
                let axial = m * 0.5 * (outer + inner);
                [m, m * z, axial, 0.5 * axial + m * z * z].iter().zip(&mut sums).for_each(|(x, sum)| *sum += x);
            }
        }
        let [m, mz, axial, across] = sums;
        let per = 1.0 / (m * found.radius * found.radius);
        prop_assert!((found.mass / m - 1.0).abs() < 1e-7);
        prop_assert!((found.centre - mz / m).abs() < 1e-7);
        prop_assert!((found.body.i3() / (axial * per) - 1.0).abs() < 1e-6);
        prop_assert!((found.body.i1() / ((across - mz * mz / m) * per) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn no_other_part_is_below_the_rim_before_theta_end_and_one_is_beyond(
        radii in [0.2..2.0f64, 0.2..2.0, 0.2..2.0], longs in [0.1..2.0f64, 0.1..2.0, 0.1..2.0], round in any::<bool>(),
    ) {
        let (mut z, mut parts, mut points) = (0.0, Vec::new(), Vec::new());
        for k in 0..3 {
            if round && k == 1 {
                parts.push(part(ball(radii[1], z), STEEL));
                points.extend((0..=2000).map(|i| {
                    let (s, c) = (PI * f64::from(i) / 2000.0).sin_cos();
                    [radii[1] * s, z + radii[1] * (1.0 - c)]
                }));
                z += 2.0 * radii[1];
            } else {
                parts.push(part(cylinder(radii[k], 0.0, [z, z + longs[k]]), STEEL));
                points.extend([[radii[k], z], [radii[k], z + longs[k]]]);
                z += longs[k];
            }
        }
        let found = whole(&parts);
        let rim = [found.radius, 0.0];
        let depth = |[r, z]: [f64; 2], theta: f64| r * theta.sin() - z * theta.cos();
        let deepest = |theta: f64| points.iter().map(|p| depth(*p, theta)).fold(f64::NEG_INFINITY, f64::max);
        let end = found.body.theta_end();
        for k in 1..100 {
            let theta = end * f64::from(k) / 100.0;
            prop_assert!(deepest(theta) <= depth(rim, theta) + 1e-12, "{theta} of {end}: {parts:?}");
        }
        if end < PI - 0.02 {
            prop_assert!(deepest(end + 0.01) > depth(rim, end + 0.01), "{end}: {parts:?}");
        }
    }
}
