//! A body on its face: slide, spin, falls, kicks and flat landings.

use crate::common::{drawn, wander};
use spincyl::contact::{Face, Friction, Table};
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{AboveTable, Ask, Ending, Motion, RestsOn, Start, roll_with};
use spincyl::{Body, Slip, State};
use std::f64::consts::PI;

/// A start on the face, from the velocity of the centre and the spin.
fn slides(body: &Body, [x, y]: [f64; 2], w: f64) -> Start {
    let state = State { theta: 0.0, w1: 0.0, w2: 0.0, w3: w };
    Start::from(state).with_slip(Slip::new(x, y - body.rim() * w))
}

fn kicked(w2: f64) -> Start {
    State { theta: 0.0, w1: 0.0, w2, w3: 0.0 }.into()
}

fn moved(body: &Body, start: Start, ask: &Ask, last: f64) -> Motion {
    let times: Vec<f64> = (0..=20).map(|k| last * f64::from(k) / 20.0).collect();
    roll_with(body, start, &times, &ask.with_pose(), || true).unwrap().unwrap()
}

fn rough(mu: f64) -> Ask {
    Ask::on(Friction::coulomb(mu)).with_restitution(0.0)
}

fn end(m: &Motion) -> (Ending, f64) {
    m.event.map_or((Ending::Done, f64::NAN), |event| (event.ending, event.time))
}

/// The place of the centre and the angle by which the body has turned, at the last output.
fn place(body: &Body, m: &Motion) -> [f64; 3] {
    let (pose, y) = (m.poses.as_ref().unwrap().last().unwrap(), m.states.last().unwrap());
    let centre = pose.centre(body, y);
    [centre.x - body.rim(), centre.y, pose.phi.radians() + pose.psi.radians()]
}

/// A random body of any moments, with a height up to `tall`.
fn any(r: &mut impl FnMut() -> f64, tall: f64) -> Body {
    let z = tall * r();
    Body::new(z, 0.5 + z * z / 3.0 + 0.3 * r(), 0.4 + 0.6 * r()).unwrap()
}

#[test]
fn a_pure_slide_lasts_for_v_over_mu_and_a_pure_spin_for_its_angular_momentum_over_the_couple() {
    let coin = Body::solid(0.4).unwrap();
    for face in [Face::Ring, Face::Disc] {
        let ask = rough(0.3).with_face(face);
        let m = moved(&coin, slides(&coin, [1.2, 0.0], 0.0), &ask, 4.0 - 1e-9);
        let (_, after) = end(&moved(&coin, slides(&coin, [1.2, 0.0], 0.0), &ask, 9.0));
        assert!((after - 4.0).abs() < 1e-13 && (place(&coin, &m)[0] - 2.4).abs() < 1e-12, "{after}");
        let couple = if face == Face::Ring { 0.3 } else { 0.2 } + 0.05;
        let m = moved(
            &coin,
            slides(&coin, [0.0; 2], -1.2),
            &ask.with_losses(Losses::of(Law::Drilling, 0.05)),
            9.0,
        );
        assert_eq!(end(&m).0, Ending::Stops);
        assert!((end(&m).1 - 0.5 * 1.2 / couple).abs() < 1e-12, "{:?}", end(&m));
    }
}

#[test]
fn slide_and_spin_end_in_one_moment_and_turn_into_heat_alike_from_every_side() {
    let mut r = wander(681);
    for k in 0..drawn(60) {
        let body = any(&mut r, 1.2);
        let mu = 0.05 + 0.6 * r();
        let (v, w) = ((2.0 * r() - 1.0).exp(), (2.0 * r() - 1.0).exp());
        let face = if k % 4 == 0 { Face::Disc } else { Face::Ring };
        let ask = rough(mu).with_face(face);
        if mu * body.ell() > 0.95 {
            continue;
        }
        let m = moved(&body, slides(&body, [v, 0.0], w), &ask, 1e3);
        let (ending, time) = end(&m);
        assert_eq!((ending, m.rests_on(&body)), (Ending::Stops, RestsOn::Face));
        let heat = m.path.as_ref().unwrap().heat;
        let had = 0.5 * (v * v + body.i3() * w * w);
        assert!((heat - had).abs() < 1e-12 + m.error * (v + w), "{heat} {had}");
        let at = |start: Start| moved(&body, start, &ask, 0.7 * time);
        let here = at(slides(&body, [v, 0.0], w));
        let [x, y, angle] = place(&body, &here);
        let most = 1e-11 + here.error + here.pose_error;
        // Mirror image.
        let other = at(slides(&body, [v, 0.0], -w));
        let [p, q, turned] = place(&body, &other);
        assert!((x - p).abs() < most && (y + q).abs() < most && (angle + turned).abs() < most);
        // Turned.
        let (sin, cos) = (6.0 * r()).sin_cos();
        let [p, q, turned] = place(&body, &at(slides(&body, [v * cos, v * sin], w)));
        let back = [p * cos + q * sin, q * cos - p * sin];
        assert!((x - back[0]).abs() < most && (y - back[1]).abs() < most && (angle - turned).abs() < most);
        // Friction turns a body that spins counterclockwise to its right.
        assert!(body.ell() * mu < 1e-6 || y < 0.0, "{y}");
    }
}

#[test]
fn a_hoop_slides_and_spins_at_one_speed_in_the_end_and_a_disk_on_its_face_at_0_653() {
    let (hoop, disk) = (Body::tube(0.0, 1.0).unwrap(), Body::solid(0.0).unwrap());
    for (body, face, known) in [(hoop, Face::Ring, 1.0), (disk, Face::Disc, 0.653002)] {
        for (v, w) in [(1.0, 0.3), (0.3, 1.0)] {
            let ask = rough(0.3).with_face(face);
            let (_, time) = end(&moved(&body, slides(&body, [v, 0.0], w), &ask, 1e3));
            let m = moved(&body, slides(&body, [v, 0.0], w), &ask, time - 1e-9);
            let (Slip { u_h: u, u_2: t, .. }, w) = (m.path.unwrap().slip[20], m.states[20].w3);
            let ratio = u.hypot(t + w) / w;
            assert!((ratio - known).abs() < 1e-5, "{ratio} {known}");
        }
    }
}

#[test]
fn a_body_that_slides_straight_topples_if_mu_z_exceeds_a_and_never_if_it_spins_faster_than_it_slides() {
    let mut r = wander(682);
    for _ in 0..drawn(60) {
        let body = any(&mut r, 4.0);
        let mu = 0.1 + 0.5 * r();
        let limit = (body.i1() + 1.0) / body.ell();
        if mu > 0.9 * limit || (mu * body.ell() - 1.0).abs() < 1e-3 {
            continue;
        }
        let m = moved(&body, slides(&body, [1.0, 0.0], 0.0), &rough(mu), 0.01);
        assert_eq!(m.states[20].theta > 0.0, mu * body.ell() > 1.0, "{mu} {body:?}");
        let m = moved(&body, slides(&body, [0.6, 0.0], 1.0), &rough(mu), 0.01);
        assert_eq!(m.states[20].theta, 0.0, "{mu} {body:?}");
    }
    let tall = Body::solid(9.0).unwrap();
    let found = roll_with(&tall, slides(&tall, [1.0, 0.0], 0.0), &[1.0], &rough(4.0), || true);
    assert!(matches!(found, Err(spincyl::Error::Painleve { .. })), "{found:?}");
}

#[test]
fn a_kicked_pillar_goes_over_if_its_energy_lifts_the_centre_over_the_rim() {
    let pillar = Body::solid(2.0).unwrap();
    let inertia = pillar.i1() + 5.0;
    let least = (2.0 * (5f64.sqrt() - 2.0) / inertia).sqrt();
    for (w2, over) in [(-0.999 * least, false), (-1.001 * least, true)] {
        let m = moved(&pillar, kicked(w2), &rough(1.0), 12.0);
        let most = m.states.iter().fold(0.0, |most: f64, y| most.max(y.theta));
        assert_eq!(most > pillar.theta_balance(), over, "{w2} {most}");
    }
}

#[test]
fn each_landing_of_a_pillar_that_grips_leaves_housners_share_of_its_rate() {
    let mut r = wander(683);
    for _ in 0..drawn(20) {
        let z = 1.3 + 2.0 * r();
        let pillar = Body::solid(z).unwrap();
        let inertia = pillar.i1() + 1.0 + z * z;
        let (share, w) = ((inertia - 2.0) / inertia, 0.02 + 0.05 * r());
        let m = moved(&pillar, kicked(-w), &rough(2.0 * z / (pillar.i1() + z * z)), 1e3);
        let path = m.path.as_ref().unwrap();
        for hit in &path.impacts {
            let [before, after] = hit.states.map(|y| y.w2);
            assert!((after / before - share).abs() < 1e-9, "{} {share}", after / before);
        }
        let lost: f64 = path.impacts.iter().map(|hit| hit.lost).sum();
        let had = 0.5 * inertia * w * w;
        assert!((lost + path.heat - had).abs() < 1e-12, "{lost} {had}");
        // Leading order of the time of a rocking.
        let (ending, time) = end(&m);
        assert_eq!(ending, Ending::Stops);
        assert!((time / (inertia * inertia * w) - 1.0).abs() < 6.0 * w * inertia, "{time} {w} {z}");
    }
}

#[test]
fn a_body_that_slips_in_one_direction_all_the_time_stops_after_v_over_mu_whatever_lies_between() {
    // All of the vertical impulse is the time.
    let mut r = wander(684);
    let mut seen = 0;
    for _ in 0..drawn(60) {
        let body = any(&mut r, 0.8);
        let (mu, theta) = (0.05 + 0.2 * r(), 0.02 + 0.1 * r());
        let state = State { theta, w1: 0.0, w2: 0.0, w3: 0.0 };
        // The lowest point slips along e_h throughout, so that the centre loses mu in each unit of time.
        let v = 3.0 + r();
        let m = moved(&body, Start::from(state).with_slip(Slip::new(v, 0.0)), &rough(mu), 200.0);
        let (ending, time) = end(&m);
        let path = m.path.as_ref().unwrap();
        if ending != Ending::Stops || path.phases.iter().any(|phase| phase.kind == Kind::Rolling) {
            continue;
        }
        seen += 1;
        assert!((time - v / mu).abs() < 1e-9 + m.error, "{time} {} {}", v / mu, m.error);
    }
    assert!(seen > 10, "{seen}");
}

#[test]
fn a_flat_drop_brakes_slide_and_spin_by_its_impulse_and_ends_after_all_of_its_bounces() {
    let (tube, mu, a) = (Body::tube(0.75, 0.8).unwrap(), 0.25, 1.0);
    let falls = (2.0f64 * 0.08).sqrt();
    for e in [0.0, 0.3, 0.8] {
        let all = falls * (1.0 + e) / (1.0 - e);
        let time = falls + 2.0 * e * falls / (1.0 - e);
        let ask = rough(mu).with_restitution(e);
        for (v, w) in [(0.0, 2.0), (3.0, 0.0)] {
            let m = moved(
                &tube,
                slides(&tube, [v, 0.0], w).with_aloft(AboveTable::new(0.08, 0.0)),
                &ask,
                time + 1e-9,
            );
            assert_eq!(m.states.len(), 21, "{:?} {e} {v} {w} {:?}", m.event, m.path.as_ref().unwrap().phases);
            let (path, y) = (m.path.as_ref().unwrap(), m.states[20]);
            let last = path.phases.last().unwrap();
            assert!(last.kind == Kind::OnItsFace && (last.time - time).abs() < 1e-6, "{last:?} {time}");
            let spin = if w > 0.0 { w - mu * a * all / tube.i3() } else { 0.0 };
            assert!((y.w3 - spin).abs() < 1e-8, "{} {spin}", y.w3);
            let slide = if v > 0.0 { v - mu * all } else { 0.0 };
            assert!((path.slip[20].u_h - slide).abs() < 1e-8, "{:?} {slide}", path.slip[20]);
        }
        // Whatever the bounces, it stops as if it had slid all the time.
        let slid = end(&moved(&tube, slides(&tube, [1.5, 0.0], 1.0), &rough(mu), 50.0)).1;
        let hopped = end(&moved(
            &tube,
            slides(&tube, [1.5, 0.0], 1.0).with_aloft(AboveTable::new(0.08, 0.0)),
            &ask,
            50.0,
        ))
        .1;
        assert!((slid - hopped).abs() < 1e-9, "{slid} {hopped}");
    }
    let for_ever = moved(
        &tube,
        slides(&tube, [0.0; 2], 0.0).with_aloft(AboveTable::new(0.08, 0.0)),
        &rough(mu).with_restitution(1.0),
        50.0,
    );
    assert_eq!(end(&for_ever).0, Ending::Done);
    assert!(for_ever.path.unwrap().impacts.len() > 50);
}

#[test]
fn a_film_below_a_flat_body_brakes_it_exponentially_and_a_smooth_table_not_at_all() {
    let disk = Body::solid(0.0).unwrap();
    let (c, t) = (0.3, 4.0);
    let m = moved(
        &disk,
        slides(&disk, [1.0, 0.0], 2.0),
        &Ask::on(Friction::Viscous { c }).with_restitution(0.0),
        t,
    );
    let y = m.states[20];
    assert!((y.w3 - 2.0 * (-c * t / 0.5f64).exp()).abs() < 1e-12);
    let slide = m.path.unwrap().slip[20].u_h;
    assert!((slide - (-c * t).exp()).abs() < 1e-12, "{slide}");
    let m = moved(&disk, slides(&disk, [0.0; 2], 2.0), &Ask::on(Table::Smooth), 1e5);
    assert_eq!((end(&m).0, m.states[20].w3), (Ending::Done, 2.0));
}

#[test]
fn without_a_restitution_a_fall_still_ends_on_the_face_but_a_start_there_goes_on() {
    let pillar = Body::solid(2.0).unwrap();
    let ask = Ask::on(Friction::coulomb(0.5));
    let falls: Start = State { theta: 0.1, w1: 0.0, w2: 0.0, w3: 0.0 }.into();
    assert_eq!(end(&moved(&pillar, falls, &ask, 50.0)).0, Ending::Face);
    let m = moved(&pillar, slides(&pillar, [0.5, 0.0], 1.0), &ask, 50.0);
    assert_eq!(end(&m).0, Ending::Stops);
    assert_eq!(end(&moved(&pillar, slides(&pillar, [0.0; 2], 0.0), &ask, 50.0)), (Ending::Stops, 0.0));
    for (w1, w2) in [(0.1, 0.0), (0.0, 0.1)] {
        let state = State { theta: 0.0, w1, w2, w3: 0.0 };
        assert!(roll_with(&pillar, state, &[1.0], &ask, || true).is_err());
    }
    // A face cannot roll.
    assert!(roll_with(&pillar, slides(&pillar, [0.0; 2], 1.0), &[1.0], &Ask::default(), || true).is_err());
}

#[test]
fn a_disk_stands_on_either_face() {
    let disk = Body::solid(0.0).unwrap();
    let state = State { theta: PI, w1: 0.0, w2: 0.0, w3: 1.0 };
    // Seen from above it turns the other way.
    let start = Start::from(state).with_slip(Slip::new(1.0, -1.0));
    let (m, other) = (
        moved(&disk, start, &rough(0.3), 50.0),
        moved(&disk, slides(&disk, [1.0, 0.0], -1.0), &rough(0.3), 50.0),
    );
    assert_eq!((m.rests_on(&disk), other.rests_on(&disk)), (RestsOn::OtherFace, RestsOn::Face));
    assert!((end(&m).1 - end(&other).1).abs() < 1e-12);
}

#[test]
fn no_random_motion_over_faces_gains_energy() {
    let mut r = wander(685);
    let (mut rest, mut all) = (0, 0);
    for k in 0..drawn(150) {
        let body = if k % 3 == 0 { Body::solid(0.05 + 2.0 * r()).unwrap() } else { any(&mut r, 2.5) };
        let e = [0.0, 0.3, 0.9][k % 3];
        let ask = rough(0.05 + 0.9 * r()).with_restitution(e);
        let start = match k % 5 {
            0 => slides(&body, [2.0 * r() - 1.0, r()], 4.0 * r() - 2.0).with_aloft(AboveTable::new(r(), 0.0)),
            1 => State { theta: 1.4 * r(), w1: 0.0, w2: r() - 0.5, w3: 0.0 }.into(),
            2 => kicked(-r()),
            3 => slides(&body, [2.0 * r() - 1.0, r()], 4.0 * r() - 2.0),
            _ => State { theta: 0.0, w1: 0.0, w2: -r(), w3: r() }.into(),
        };
        let m = moved(&body, start, &ask, 60.0);
        all += 1;
        assert!(!matches!(m.ending(), Ending::Face | Ending::Side), "{k}: {:?}", m.event);
        rest += usize::from(matches!(m.ending(), Ending::Stops | Ending::Done));
        let path = m.path.as_ref().unwrap();
        for hit in &path.impacts {
            assert!(hit.lost > -1e-12 - m.error, "{k}: {hit:?}");
        }
        let mut before = f64::NEG_INFINITY;
        for heat in &path.dissipated {
            assert!(
                *heat >= before - 1e-12 - m.error,
                "{k}: {heat} {before} {start:?} {body:?} {:?}",
                path.phases
            );
            before = *heat;
        }
    }
    assert!(rest + 1 >= all, "{rest} of {all}");
}
