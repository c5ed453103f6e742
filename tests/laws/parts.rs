//! Bodies put together from coaxial parts.

use crate::common::{cases, larger};
use proptest::prelude::*;
use spincyl::Body;
use spincyl::body::parts::{Amount, Assembled, BodyPart, Form, assembled};
use std::f64::consts::{FRAC_PI_2, PI};

const STEEL: Amount = Amount::Density(7800.0);

fn part(form: Form, amount: Amount) -> BodyPart {
    BodyPart::new(form, amount)
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
    assert!((bowl.body.theta_end() - FRAC_PI_2).abs() < 1e-15);
    assert_eq!(bowl.body.circles().len(), 2);
    assert!((bowl.body.ell() + 0.375).abs() < 1e-15, "its centre of mass is 3/8 R below the middle");
    // The other half on its flat side goes on to its round side: a ball that is tangential to the edge.
    let dome = Form::Shell { radius: 1.0, centre: 0.0, ends: [0.0, 1.0] };
    assert!((whole(&[part(dome, STEEL)]).body.theta_end() - FRAC_PI_2).abs() < 1e-15);
    // A flatter cap begins to touch with its round side where the tangent of its edge lies on the table.
    let low = Form::Ball { radius: 1.0, hollow: 0.0, centre: -0.6, ends: [0.0, 0.4] };
    assert!((whole(&[part(low, STEEL)]).body.theta_end() - (PI - 0.6f64.acos())).abs() < 1e-15);
    // A rounded coin with a milled rim keeps its fillet.
    let coin = Form::Solid { radii: [12.0; 2], bores: [0.0; 2], ends: [0.0, 2.0], fillet: 0.5 };
    let milled =
        whole(&[part(coin, STEEL), part(Form::Ring { radius: 11.9, height: 1.0 }, Amount::Mass(1e5))]);
    assert!((milled.body.fillet() - 0.5 / 12.0).abs() < 1e-15 && milled.body.theta_end() == FRAC_PI_2);
}

#[test]
fn another_rim_as_wide_but_not_at_the_same_distance_is_a_circle_of_its_own() {
    let half_full = [
        part(Form::Wall { radii: [33.0; 2], ends: [0.0, 115.0] }, Amount::Density(0.002)),
        part(cylinder(32.9, 0.0, [0.0, 57.0]), Amount::Density(1e-6)),
    ];
    let can = whole(&half_full);
    let [low, high] = can.body.circles()[..] else { panic!("{:?}", can.body) };
    assert!((low.radius, high.radius) == (1.0, 1.0) && low.depth + high.depth < -5e-3, "{low:?} {high:?}");
    assert_eq!(can.body.theta_end(), FRAC_PI_2);
    let empty = whole(&half_full[..1]);
    assert_eq!(empty.body.theta_end(), FRAC_PI_2);
    assert_ne!(empty.body, can.body);
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
}

/// A generator of random numbers from a fixed seed.
struct Drawn(u64);

impl Drawn {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64) / (1u64 << 53) as f64
    }
    fn of(&mut self, count: usize) -> usize {
        (self.number() * count as f64) as usize
    }
    /// A length that often occurs a second time, so that parts have common edges.
    fn length(&mut self) -> f64 {
        if self.of(2) == 0 { [0.3, 0.5, 0.7, 1.1][self.of(4)] } else { 0.05 + 1.5 * self.number() }
    }

    /// A random part with its lowest point at the height `low`, and the height of its upper end.
    fn part(&mut self, low: f64) -> (Form, f64) {
        let (r, q, long, bore) = (self.length(), self.length(), self.length(), 0.9 * self.number());
        let share = if self.of(4) == 0 { [0.0, 0.5, 1.0][self.of(3)] } else { self.number() };
        let (radii, ends) = ([r, q], [low, low + long]);
        match self.of(9) {
            0 => (cylinder(r, bore * r, ends), ends[1]),
            1 => {
                let fillet = 0.999 * share * r.min(0.5 * long);
                (Form::Solid { radii: [r; 2], bores: [0.0; 2], ends, fillet }, ends[1])
            }
            2 => (Form::Solid { radii, bores: [0.0; 2], ends, fillet: 0.0 }, ends[1]),
            3 => (Form::Wall { radii, ends }, ends[1]),
            4 => (Form::Wall { radii: [bore * r, r], ends: [low; 2] }, low),
            5 => (Form::Ring { radius: if self.of(4) == 0 { 0.0 } else { r }, height: low }, low),
            6 => (ball(r, low), low + 2.0 * r),
            kind => {
                // A cap at the lower or the upper end, or a zone.
                let high = 2.0 * r * (0.02 + 0.98 * self.number());
                let under = [0.0, 2.0 * r - high, self.number() * (2.0 * r - high)][self.of(3)];
                let (centre, ends) = (low + r - under, [low, low + high]);
                let form = match kind {
                    7 => Form::Shell { radius: r, centre, ends },
                    _ => Form::Ball { radius: r, hollow: bore * r, centre, ends },
                };
                (form, ends[1])
            }
        }
    }

    /// Random parts that stand on each other or overlap, with either end up.
    fn parts(&mut self) -> Vec<BodyPart> {
        let (mut z, mut forms) = (0.0, Vec::new());
        for _ in 0..=self.of(5) {
            let low = if self.of(4) == 0 { 2.0 * self.number() } else { z };
            let (form, top) = self.part(low);
            forms.push(form);
            z = top;
        }
        if self.of(2) == 0 {
            forms.iter_mut().for_each(|form| *form = turned_over(*form));
        }
        forms.into_iter().map(|form| part(form, Amount::Mass(1.0))).collect()
    }
}

fn turned_over(form: Form) -> Form {
    let over = |[a, b]: [f64; 2]| [-b, -a];
    match form {
        Form::Solid { radii: [a, b], bores: [c, d], ends, fillet } => {
            Form::Solid { radii: [b, a], bores: [d, c], ends: over(ends), fillet }
        }
        Form::Wall { radii: [a, b], ends } => Form::Wall { radii: [b, a], ends: over(ends) },
        Form::Ball { radius, hollow, centre, ends } => {
            Form::Ball { radius, hollow, centre: -centre, ends: over(ends) }
        }
        Form::Shell { radius, centre, ends } => Form::Shell { radius, centre: -centre, ends: over(ends) },
        Form::Ring { radius, height } => Form::Ring { radius, height: -height },
        _ => unreachable!(),
    }
}

/// Depth of the lowest point of a part below z = 0, where the axis leans by theta.
fn depth(form: &Form, theta: f64) -> f64 {
    let (s, c) = theta.sin_cos();
    let point = |r: f64, z: f64| r * s - z * c;
    let ends = |[a, b]: [f64; 2], [low, high]: [f64; 2]| point(a, low).max(point(b, high));
    match *form {
        Form::Solid { radii: [a, b], ends: [low, high], fillet, .. } => {
            ends([a - fillet, b - fillet], [low + fillet, high - fillet]) + fillet
        }
        Form::Wall { radii, ends: heights } => ends(radii, heights),
        Form::Ring { radius, height } if radius > 0.0 => point(radius, height),
        Form::Ball { radius, centre, ends: [low, high], .. }
        | Form::Shell { radius, centre, ends: [low, high] } => {
            // The lowest point of the whole ball has this height above its centre.
            let down = centre - radius * c;
            if down >= low && down <= high {
                return radius - centre * c;
            }
            let z = if down < low { low } else { high };
            point((radius * radius - (z - centre) * (z - centre)).max(0.0).sqrt(), z)
        }
        _ => f64::NEG_INFINITY,
    }
}

#[test]
fn a_body_of_parts_stands_on_its_lowest_points_at_every_inclination() {
    let (mut drawn, mut tried, mut kinds) = (Drawn(64), 0, [0; 5]);
    while tried < 6000 {
        let parts = drawn.parts();
        let found = match assembled(&parts) {
            Ok(found) => found,
            Err(error) => {
                // Nothing but points.
                assert!(error.to_string().starts_with("parts"), "{error}: {parts:?}");
                kinds[4] += 1;
                continue;
            }
        };
        tried += 1;
        let (body, end) = (&found.body, found.body.theta_end());
        let (circles, borders) = (body.circles(), body.borders());
        assert!(borders.len() + 1 == circles.len() && borders.first().map_or(PI, |first| first.theta) == end);
        let carries = |theta: f64| {
            let circle = &circles[borders.iter().filter(|border| theta > border.theta).count()];
            let low = circle.depth * theta.cos() + circle.radius * theta.sin() + circle.fillet;
            low * found.radius - found.centre * theta.cos()
        };
        let deepest =
            |theta: f64| parts.iter().map(|part| depth(&part.form, theta)).fold(f64::NEG_INFINITY, larger);
        for k in 0..400 {
            let share = f64::from(k) / 400.0;
            let all = [
                PI * share,
                end * share,
                end * 10f64.powf(-8.0 * share),
                end - 10f64.powf(-1.0 - 8.0 * share),
            ];
            for theta in all.into_iter().filter(|theta| *theta >= 0.0) {
                let gap = deepest(theta) - carries(theta);
                assert!(gap.abs() < 1e-11, "{gap} at {theta}, {borders:?}: {found:?} {parts:?}");
            }
        }
        kinds[circles.len().min(4) - 1] += 1;
    }
    assert!(kinds.iter().all(|count| *count > 30), "{kinds:?}");
}
