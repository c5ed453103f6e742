//! A body that lies on two rims of a slope: references, laws with exact answers, its energy, and its mirror image.

use crate::common::{drawn, larger, wander};
use spincyl::body::Circle;
use spincyl::contact::Force;
use spincyl::contact::slip::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::{Kind, OtherRim};
use spincyl::motion::{Ask, Ending, Motion, Sample, Start, roll_with};
use spincyl::{Body, Slip, State};
use std::f64::consts::{FRAC_PI_2, PI};

/// A body on its side, whose axis leans to `heading` from downhill, and whose centre has the velocity v along it and across.
fn lying(body: &Body, heading: f64, [w1, w3]: [f64; 2], [along, across]: [f64; 2]) -> Start {
    let state = State { theta: FRAC_PI_2, w1, w2: 0.0, w3 };
    Start::from(state).with_slip(Slip::new(along, across + body.ell() * w1 - w3)).with_heading(heading)
}

fn ask(friction: Friction, slope: f64) -> Ask {
    Ask::on(friction).with_restitution(0.0).with_slope(slope).with_pose().with_force()
}

fn asked(body: &Body, start: Start, ask: &Ask, times: &[f64]) -> Motion {
    roll_with(body, start, times, ask, || true).unwrap().unwrap()
}

fn moved(body: &Body, start: Start, mu: f64, slope: f64, times: &[f64]) -> Motion {
    asked(body, start, &ask(Friction::coulomb(mu), slope), times)
}

fn kinds(m: &Motion) -> Vec<Kind> {
    m.path.as_ref().unwrap().phases.iter().map(|phase| phase.kind).collect()
}

fn phi(m: &Motion, i: usize) -> f64 {
    m.poses.as_ref().unwrap()[i].phi.radians()
}

/// The sum, at each time, of the energy on the slope, the heat, and the energy that impacts and losses have taken.
fn whole(body: &Body, slope: f64, m: &Motion) -> Vec<f64> {
    let path = m.path.as_ref().unwrap();
    let at = |(i, now): (usize, Sample)| {
        let (centre, v, y) = (now.centre(body).unwrap(), now.velocity(body).unwrap(), now.state);
        let turning = body.i1() * (y.w1 * y.w1 + y.w2 * y.w2) + body.i3() * y.w3 * y.w3;
        let struck = path.impacts.iter().filter(|hit| hit.time < m.times[i]).map(|hit| hit.lost);
        0.5 * (v.norm_squared() + turning) + slope.cos() * centre.z - slope.sin() * centre.x
            + path.dissipated[i]
            + path.work_lost.get(i).unwrap_or(&0.0)
            + struck.sum::<f64>()
    };
    m.samples().enumerate().map(at).collect()
}

/// The largest change of that sum of energies, in units of the largest speed.
fn off(body: &Body, slope: f64, m: &Motion) -> f64 {
    let (all, speeds) = (whole(body, slope, m), m.states.iter().flat_map(|y| [y.w1, y.w2, y.w3]));
    let fastest = speeds.fold(1.0, |most: f64, w| most.max(w.abs()));
    all.iter().map(|e| (e - all[0]).abs()).fold(0.0, larger) / fastest
}

#[test]
fn a_can_whose_rims_both_stop_then_rolls_straight_as_the_reference_says() {
    let body = Body::solid(2.0).unwrap();
    let start = lying(&body, -0.8, [0.2, 0.4], [0.5, 1.5]);
    let m = moved(&body, start, 0.3, 0.2, &[7.0, 7.8, 9.0, 20.0]);
    assert_eq!(kinds(&m), [Kind::Lying, Kind::RollingOnItsSide]);
    let last = m.path.as_ref().unwrap().phases[1];
    assert!((last.time - 7.779_943_750_2).abs() < 1e-9, "{}", last.time);
    assert!((last.state.w3 - 1.587_526_207_2).abs() < 1e-9, "{}", last.state.w3);
    assert!((phi(&m, 3) + 0.554_518_092_0).abs() < 1e-9, "{}", phi(&m, 3));
    // From there on it is uniformly accelerated, however long.
    let rate = 0.2f64.sin() * (-phi(&m, 3)).sin() / 1.5;
    assert!((m.states[3].w3 - last.state.w3 - rate * (20.0 - last.time)).abs() < 1e-9);
}

#[test]
fn a_can_on_a_slope_steeper_than_its_friction_turns_its_axis_across_and_rolls_straight_all_the_same() {
    let body = Body::solid(1.2).unwrap();
    let start = lying(&body, 0.7, [0.3, 0.2], [0.2, -0.4]);
    let m = moved(&body, start, 0.35, 0.45, &[2.0, 2.6, 3.0]);
    assert_eq!(kinds(&m), [Kind::Lying, Kind::Pivoting, Kind::RollingOnItsSide]);
    let phases = &m.path.as_ref().unwrap().phases;
    assert!((phases[1].time - 2.542_318_988_2).abs() < 1e-9, "{}", phases[1].time);
    assert!((phases[1].state.w1 - 0.057_228_837_6).abs() < 1e-9);
    assert!((phases[2].time - 2.937_162_559_8).abs() < 1e-9, "{}", phases[2].time);
    assert!((phases[2].state.w3 + 0.975_621_773_9).abs() < 1e-9);
    assert!((phi(&m, 2) - 1.219_359_745_9).abs() < 1e-9, "{}", phi(&m, 2));
}

#[test]
fn a_block_that_rocks_on_a_slope_comes_to_rest_when_a_chain_of_planar_hops_does() {
    let body = Body::solid(0.3).unwrap();
    let start = Start::from(State { theta: 1.4, w1: 0.0, w2: 0.0, w3: 0.0 });
    let m = moved(&body, start, 0.5, 0.1, &[3.0, 15.0, 15.4, 30.0]);
    let path = m.path.as_ref().unwrap();
    assert!((path.impacts[0].time - 3.342_062_925_3).abs() < 1e-9, "{}", path.impacts[0].time);
    let rests = path.phases.last().unwrap();
    // Hops about a fixed rim, with the factor 1 - 2 ell^2/(I1 + 1 + ell^2) at each landing, to 12 digits.
    assert_eq!(rests.kind, Kind::RollingOnItsSide);
    assert!((rests.time - 15.315_972_879_66).abs() < 1e-9 + m.error, "{} {}", rests.time, m.error);
    assert_eq!(m.states[3].w3, 0.0);
    // At rest, the lower rim bears (1 + tan/ell)/2 of the weight, and friction holds the body along its axis.
    let force = m.forces.as_ref().unwrap()[3];
    let share = 0.5 * (0.1f64.cos() + 0.1f64.sin() / 0.3);
    assert!((force.normal - share).abs() < 1e-12, "{force:?}");
}

#[test]
fn a_body_let_go_with_its_axis_across_rolls_as_on_an_inclined_plane_or_slips_below_a_third_of_the_slope() {
    for (body, slope) in [(Body::solid(2.0), 0.3), (Body::tube(0.7, 1.0), 0.2), (Body::solid(0.5), 0.9)] {
        let body = body.unwrap();
        let (sin, cos, k) = (f64::sin(slope), f64::cos(slope), body.i3());
        let limit = slope.tan() * k / (1.0 + k);
        for mu in [1.01 * limit, 3.0, 0.99 * limit, 0.3 * limit] {
            let m = moved(&body, lying(&body, -FRAC_PI_2, [0.0; 2], [0.0; 2]), mu, slope, &[1.0, 4.0]);
            let rate = if mu > limit { sin / (1.0 + k) } else { mu * cos / k };
            for (t, y) in m.times.iter().zip(&m.states) {
                assert!((y.w3 - rate * t).abs() < 1e-10, "{body:?} {mu}: {} {}", y.w3, rate * t);
                assert!(y.w1.abs() < 1e-10);
            }
            let expected = if mu > limit { Kind::RollingOnItsSide } else { Kind::Lying };
            assert_eq!(kinds(&m), [expected]);
        }
    }
}

#[test]
fn a_body_whose_axis_is_not_across_is_held_along_it_where_both_rims_can() {
    let (body, slope) = (Body::solid(2.0).unwrap(), 0.3f64);
    let m = moved(&body, lying(&body, 0.5 - FRAC_PI_2, [0.0; 2], [0.0; 2]), 0.4, slope, &[1.0, 4.0]);
    assert_eq!(kinds(&m), [Kind::RollingOnItsSide]);
    let rate = slope.sin() * f64::cos(0.5) / 1.5;
    let pull = slope.sin() * f64::sin(0.5);
    for (i, y) in m.states.iter().enumerate() {
        assert!((y.w3 - rate * m.times[i]).abs() < 1e-13 && y.w1 == 0.0);
        let there = m.path.as_ref().unwrap().other_rim[i].force;
        let here = m.forces.as_ref().unwrap()[i];
        assert!((here.across + there.across + pull).abs() < 1e-14, "{here:?} {there:?}");
        assert!((here.normal + there.normal - slope.cos()).abs() < 1e-14);
        assert!((here.along + there.along + 0.5 / 1.5 * slope.sin() * f64::cos(0.5)).abs() < 1e-14);
        // Both are within their cones by the same share of what is left across.
        let left = |n: f64, f: f64| ((0.4 * n).powi(2) - f * f).sqrt();
        let shares =
            [here.across / left(here.normal, here.along), there.across / left(there.normal, there.along)];
        assert!((shares[0] - shares[1]).abs() < 1e-12 && shares[0].abs() < 1.0, "{shares:?}");
    }
}

#[test]
fn a_body_with_its_axis_downhill_lies_still_slides_or_tips_over_its_lower_rim() {
    let slope = 0.3f64;
    let (sin, cos) = slope.sin_cos();
    for heading in [0.0, PI] {
        let let_go = |ell: f64, mu: f64| {
            let body = Body::solid(ell).unwrap();
            moved(&body, lying(&body, heading, [0.0; 2], [0.0; 2]), mu, slope, &[0.3, 1.0])
        };
        let rests = let_go(0.4, 0.32);
        assert_eq!(kinds(&rests), [Kind::RollingOnItsSide]);
        assert!(rests.states.iter().all(|y| y.w1 == 0.0 && y.w2 == 0.0 && y.w3.abs() < 1e-15));
        let slides = let_go(0.4, 0.25);
        assert_eq!(kinds(&slides), [Kind::Lying]);
        for (t, Slip { u_h: along, u_2: across, .. }) in
            slides.times.iter().zip(&slides.path.as_ref().unwrap().slip)
        {
            let speed = (sin - 0.25 * cos) * t * heading.cos();
            assert!((along - speed).abs() < 1e-11 && across.abs() < 1e-11, "{along} {speed}");
        }
        // The rim at the lower end carries it.
        let tips = let_go(0.25, 0.6);
        let path = tips.path.as_ref().unwrap();
        assert!(path.kinds.iter().all(|kind| *kind == Kind::Rolling), "{:?}", kinds(&tips));
        assert_eq!(path.rims[0] == 1, heading == PI);
        assert!(tips.states[0].theta < FRAC_PI_2 && tips.states[1].theta < tips.states[0].theta);
    }
}

/// A slip below this counts as a rounding error.
const STILL: f64 = 1e-12;

/// A random body, start on both rims, coefficient of friction and slope.
fn any_lying(r: &mut impl FnMut() -> f64) -> (Body, Start, f64, f64) {
    let body = Body::solid(0.3 * 20f64.powf(r())).unwrap();
    let slope = 0.05 + 0.65 * r();
    let mu = 0.1 + 0.8 * r();
    let rests = r() < 0.2;
    let mut draw = |size: f64| if rests { 0.0 } else { size * (2.0 * r() - 1.0) };
    let (w, v) = ([draw(1.0), draw(1.5)], [draw(1.0), draw(1.0)]);
    let heading = PI * (2.0 * r() - 1.0);
    (body, lying(&body, heading, w, v), mu, slope)
}

#[test]
fn whatever_lies_on_a_slope_keeps_its_energy_within_its_estimated_error_and_none_is_refused() {
    let (mut r, mut found) = (wander(69), [0; 5]);
    let times: Vec<f64> = (0..25).map(|k| 0.5 * f64::from(k)).collect();
    for _ in 0..drawn(600) {
        let (body, start, mu, slope) = any_lying(&mut r);
        let m = moved(&body, start, mu, slope, &times);
        let case = format!("{body:?} {start:?} mu {mu} slope {slope}: error {:e} {:?}", m.error, m.ending());
        assert!(matches!(m.ending(), Ending::Done | Ending::Face), "{case}");
        assert!(m.error < 1e-4, "{case}");
        let off = off(&body, slope, &m);
        assert!(off < 4.0 * m.error.max(1e-12), "{off:e} {case}");
        for kind in kinds(&m) {
            let all = [Kind::Lying, Kind::Pivoting, Kind::RollingOnItsSide, Kind::Slipping, Kind::Rolling];
            all.iter().position(|known| *known == kind).into_iter().for_each(|k| found[k] += 1);
        }
    }
    assert!(found.iter().all(|count| *count > drawn(600) / 30), "{found:?}");
}

#[test]
fn what_is_let_go_at_rest_sticks_slips_pivots_or_rises_as_coulomb_says_at_both_rims() {
    let (mut r, mut found) = (wander(72), [0; 4]);
    let t = 1e-3;
    for _ in 0..drawn(900) {
        let (body, start, mu, slope) = any_lying(&mut r);
        let start = lying(&body, start.heading, [0.0; 2], [0.0; 2]);
        let m = moved(&body, start, mu, slope, &[t]);
        let (path, force) = (m.path.as_ref().unwrap(), m.forces.as_ref().unwrap()[0]);
        let case = format!("{body:?} {start:?} mu {mu} slope {slope} {:?}", kinds(&m));
        let OtherRim { slip, force: Force { normal, along, across, .. }, .. } = path.other_rim[0];
        let (here, there) = (path.slip[0], slip);
        let rims = [(here, [force.normal, force.across, force.along]), (there, [normal, across, along])];
        let kind = path.kinds[0];
        found[[Kind::RollingOnItsSide, Kind::Pivoting, Kind::Lying]
            .iter()
            .position(|k| *k == kind)
            .unwrap_or(3)] += 1;
        if kind == Kind::Slipping || kind == Kind::Rolling {
            // The uphill rim rises, since the pull tips the body over the lower one.
            let lower = if start.heading.cos() < 0.0 { 1 } else { 0 };
            assert!(path.rims[0] == lower && m.states[0].theta < FRAC_PI_2 && m.states[0].w2 > 0.0, "{case}");
            continue;
        }
        let moves = rims.iter().filter(|(Slip { u_h: u, u_2: v, .. }, _)| u.hypot(*v) > STILL).count();
        assert_eq!(moves, moving(kind), "{case}");
        for (Slip { u_h: u, u_2: v, .. }, [n, f_h, f_2]) in rims {
            assert!(n >= 0.0, "{case}");
            let speed = u.hypot(v);
            if speed < STILL {
                assert!(f_h.hypot(f_2) <= mu * n * (1.0 + 1e-9), "{case}");
            } else {
                assert!((f_h * speed + mu * n * u).hypot(f_2 * speed + mu * n * v) < 1e-9 * speed, "{case}");
            }
        }
    }
    assert!(found.iter().all(|count| *count > 1), "{found:?}");
}

/// The number of rims that slip in a phase of this kind.
fn moving(kind: Kind) -> usize {
    match kind {
        Kind::Lying => 2,
        Kind::Pivoting => 1,
        _ => 0,
    }
}

#[test]
fn what_lies_on_two_unequal_circles_of_a_slope_keeps_its_energy_too() {
    let (mut r, mut rolled, mut refused) = (wander(71), 0, 0);
    let times: Vec<f64> = (0..17).map(|k| 0.5 * f64::from(k)).collect();
    for _ in 0..drawn(150) {
        let far = 0.6 + 2.0 * r();
        let circle = |radius, depth| Circle { radius, depth, fillet: 0.02 };
        let (small, shift) = (0.3 + 0.7 * r(), 0.4 + 0.2 * r());
        let circles = [circle(small, shift * far), circle(1.0, (shift - 1.0) * far)];
        let i3 = 0.3 + 0.3 * r();
        let body = Body::profile(&circles, i3 * (0.55 + r()), i3).unwrap();
        let (slope, mu) = (0.02 + 0.3 * r(), 0.2 + 0.7 * r());
        let mut draw = |size: f64| size * (2.0 * r() - 1.0);
        let state = State { theta: body.theta_end(), w1: draw(0.5), w2: 0.0, w3: draw(0.5) };
        let start = Start::from(state).with_slip(Slip::new(draw(0.5), draw(0.5))).with_heading(draw(PI));
        let m = moved(&body, start, mu, slope, &times);
        let case = format!("{body:?} {start:?} mu {mu} slope {slope}: error {:e} {:?}", m.error, m.ending());
        // Where a body that rolls round its apex has just been let go, the search may find no answer.
        refused += usize::from(m.ending() == Ending::Landing);
        assert!(
            matches!(m.ending(), Ending::Done | Ending::Face | Ending::Stops | Ending::Landing),
            "{:?} {case}",
            kinds(&m)
        );
        let off = off(&body, slope, &m);
        assert!(off < 20.0 * m.error.max(1e-12), "{off:e} {:?} {case}", kinds(&m));
        rolled += usize::from(kinds(&m).contains(&Kind::RollingRoundItsApex));
    }
    assert!(rolled > drawn(150) / 10 && refused <= drawn(150) / 40, "{rolled} {refused}");
}

#[test]
fn the_mirror_image_of_a_start_on_a_slope_is_followed_by_the_mirror_image_of_its_motion() {
    let mut r = wander(70);
    let times = [0.5, 1.0, 2.0, 4.0];
    for _ in 0..drawn(120) {
        let (body, start, mu, slope) = any_lying(&mut r);
        let mirrored = |y: &State| State { w1: -y.w1, w3: -y.w3, ..*y };
        let Slip { u_h: along, u_2: across, .. } = start.slip;
        let image = Start::from(mirrored(&start.state))
            .with_slip(Slip::new(along, -across))
            .with_heading(-start.heading);
        let [m, n] = [start, image].map(|start| moved(&body, start, mu, slope, &times));
        let allowed = 10.0 * (m.error + n.error).max(1e-12);
        assert_eq!(kinds(&m), kinds(&n), "{body:?} {start:?} {mu} {slope}");
        for i in 0..m.states.len() {
            let (y, z) = (m.states[i], mirrored(&n.states[i]));
            let off = (y.theta - z.theta).abs().max((y.w1 - z.w1).abs()).max((y.w3 - z.w3).abs());
            let turned = (phi(&m, i) + phi(&n, i)).abs();
            let turned = (turned - (turned / (2.0 * PI)).round() * 2.0 * PI).abs();
            assert!(
                off.max(turned) < allowed,
                "{off:e} {turned:e} {allowed:e} {body:?} {start:?} {mu} {slope}"
            );
        }
    }
}

#[test]
fn rolling_resistance_holds_a_can_on_a_slope_or_lets_it_turn_round_and_roll_down() {
    let body = Body::solid(1.0).unwrap();
    let (slope, delta) = (0.2f64, 0.05);
    let losing = |heading: f64, w3: f64, times: &[f64]| {
        let ask = ask(Friction::coulomb(0.5), slope).with_losses(Losses::of(Law::RollingResistance, delta));
        asked(&body, lying(&body, heading, [0.0, w3], [0.0, w3]), &ask, times)
    };
    // Uphill it slows by the pull and the loss, then rolls down by their difference.
    let m = losing(-FRAC_PI_2, -1.0, &[1.0, 20.0]);
    let [up, down] = [1.0, -1.0].map(|way| (slope.sin() + way * delta * slope.cos()) / 1.5);
    let stop = 1.0 / up;
    assert!((m.states[0].w3 + 1.0 - up).abs() < 1e-12);
    assert!((m.states[1].w3 - down * (20.0 - stop)).abs() < 1e-10, "{} {:?}", m.states[1].w3, kinds(&m));
    assert!(off(&body, slope, &m) < 1e-11);
    // With its axis almost downhill it stops for good, and a can at rest stays.
    let held = losing(-0.2, -1.0, &[0.1, 20.0]);
    let slows = (slope.sin() * f64::sin(0.2) + delta * slope.cos()) / 1.5;
    let end = held.event.as_ref().unwrap();
    assert_eq!(end.ending, Ending::Stops);
    assert!((end.time - 1.0 / slows).abs() < 1e-10);
    assert_eq!(losing(-0.2, 0.0, &[0.0, 3.0]).ending(), Ending::Stops);
    let rolls = losing(-0.5, 0.0, &[3.0]);
    let rate = (slope.sin() * f64::sin(0.5) - delta * slope.cos()) / 1.5;
    assert!((rolls.states[0].w3 - 3.0 * rate).abs() < 1e-12, "{} {}", rolls.states[0].w3, 3.0 * rate);
}

#[test]
fn what_the_air_slows_as_it_rolls_down_is_held_along_its_axis_until_both_rims_let_go_and_slip_on() {
    let all = [
        (Body::solid(1.85).unwrap(), 0.44, 0.7677f64, -1.394_290_35, 4.268, [0.0042, 0.0101]),
        (Body::rounded_tube(1.1787, 0.0, 0.2015).unwrap(), 0.7015, 0.8179, 4.9653, 7.69, [0.01454, 0.013]),
        (
            Body::rounded_tube(0.801, 0.0, 0.1801).unwrap(),
            0.40744,
            0.6895,
            1.64186,
            -3.1525,
            [0.0376, 0.0132],
        ),
        (Body::solid(1.6264).unwrap(), 0.8627, 0.9858, -1.6396, 5.948, [0.03485, 0.0139]),
        (Body::solid(0.5241).unwrap(), 0.85317, 0.56747, 2.16602, -2.4808, [0.0421, 0.0146]),
    ];
    let mut let_go = 0;
    for (body, mu, beta, heading, w3, [delta, air]) in all {
        let losses = Losses::of(Law::RollingResistance, delta) + Losses::of(Law::AirLinear, air);
        let start = Start::from(State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3 }).with_heading(heading);
        let ask = Ask::on(Friction::coulomb(mu)).with_restitution(0.0).with_losses(losses).with_slope(beta);
        let times: Vec<f64> = (0..=60).map(|k| 0.5 * f64::from(k)).collect();
        let m = roll_with(&body, start, &times, &ask.with_pose(), || true).unwrap().unwrap();
        let path = m.path.as_ref().unwrap();
        assert_eq!(path.phases[0].kind, Kind::RollingOnItsSide);
        assert_eq!(m.ending(), Ending::Done, "{:?} {:?}", m.event, path.phases);
        let_go += usize::from(path.phases.len() > 1);
        for (y, before) in m.states[1..].iter().zip(&m.states) {
            assert!((y.w3 - before.w3).abs() < 0.5 * beta.sin(), "{y:?} {before:?}");
        }
    }
    assert_eq!(let_go, 5);
}
