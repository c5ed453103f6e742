//! A body on its face on a slope: what holds it, how it slides, how friction turns it, and when it tips over.

use crate::common::wander;
use spincyl::contact::{Face, Friction, end_ratio};
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{AboveTable, Ask, Ending, Motion, Start, roll_with};
use spincyl::{Body, Contact, Slip, State};
use std::f64::consts::PI;

const LEVEL: State = State { theta: 0.0, w1: 0.0, w2: 0.0, w3: 0.0 };

/// A start on the face that heads downhill, from the velocity of the centre and the spin.
fn slides(body: &Body, [x, y]: [f64; 2], w: f64) -> Start {
    Start::from(State { w3: w, ..LEVEL }).with_slip(Slip::new(x, y - body.rim() * w))
}

fn moved(body: &Body, start: Start, times: &[f64], ask: &Ask) -> Motion {
    roll_with(body, start, times, &ask.with_pose(), || true).unwrap().unwrap()
}

fn rough(mu: f64, slope: f64) -> Ask {
    Ask::on(Friction::coulomb(mu)).with_restitution(0.0).with_slope(slope)
}

fn end(m: &Motion) -> (Ending, f64) {
    m.event.map_or((Ending::Done, f64::NAN), |event| (event.ending, event.time))
}

/// The displacement of the centre since the start, and its velocity, along x and y, while the body is on its face
/// with phi = 0.
fn centre(body: &Body, m: &Motion, i: usize) -> [f64; 4] {
    let (y, at) = (m.states[i], m.poses.as_ref().unwrap()[i].contact_point);
    let Slip { u_h: u, u_2: v, .. } = m.path.as_ref().unwrap().slip[i];
    [at.x, at.y, u, v + body.rim() * y.w3]
}

#[test]
fn a_body_on_its_face_stays_if_friction_holds_it_and_its_weight_acts_within_its_face() {
    for (mu, height, beta) in [(0.4, 0.5, 0.3f64), (0.2, 0.5, 0.3), (2.0, 4.0, 0.3), (0.2, 4.0, 0.3)] {
        let body = Body::solid(height).unwrap();
        let m = moved(&body, LEVEL.into(), &[0.0, 0.5], &rough(mu, beta));
        let (slides, tips) = (beta.tan() > mu, height * beta.tan().min(mu) > 1.0);
        match (slides, tips) {
            (false, false) => assert_eq!(end(&m), (Ending::Stops, 0.0)),
            (true, false) => {
                let goes = beta.sin() - mu * beta.cos();
                let [x, y, v, _] = centre(&body, &m, 1);
                assert!((x - 0.125 * goes).abs() < 1e-13 && (v - 0.5 * goes).abs() < 1e-13 && y == 0.0);
            }
            _ => {
                // Over the lowest point of its ring, about which it turns where it sticks.
                assert!(m.states[1].theta > 0.0 && m.states[1].w2 < 0.0, "{:?}", m.states[1]);
                let heading = m.poses.as_ref().unwrap()[1].phi.radians();
                assert!((heading.abs() - PI).abs() < 1e-12, "{heading}");
            }
        }
    }
}

#[test]
fn a_tall_body_that_sticks_tips_over_the_lowest_point_of_its_ring_with_the_energy_of_its_fall() {
    let (beta, height) = (0.4f64, 3.0);
    let body = Body::solid(height).unwrap();
    let m = moved(&body, LEVEL.into(), &[0.5, 1.0], &rough(5.0, beta));
    let inertia = body.i1() + height * height + 1.0;
    for y in &m.states {
        let (sin, cos) = y.theta.sin_cos();
        let falls = beta.cos() * (height * (1.0 - cos) - sin) + beta.sin() * (height * sin + 1.0 - cos);
        assert!((0.5 * inertia * y.w2 * y.w2 - falls).abs() < 1e-11, "{y:?} {falls}");
    }
    let begins = (height * beta.sin() - beta.cos()) / inertia;
    let early = moved(&body, LEVEL.into(), &[1e-3], &rough(5.0, beta)).states[0];
    assert!((early.theta / (0.5e-6 * begins) - 1.0).abs() < 1e-5, "{early:?}");
}

#[test]
fn a_face_without_spin_slides_like_a_block() {
    // |v| sin(chi) tan(chi/2)^(-mu/tan beta) stays, with the angle chi of v from downhill, until the block rests.
    let (beta, body) = (0.3f64, Body::tube(0.5, 0.8).unwrap());
    for mu in [0.2, 0.5] {
        let times = [0.0, 0.4, 0.8, 1.2];
        let m = moved(&body, slides(&body, [-0.6, 1.1], 0.0), &times, &rough(mu, beta));
        let block = |i: usize| {
            let [_, _, v_x, v_y] = centre(&body, &m, i);
            let chi = v_y.atan2(v_x);
            v_x.hypot(v_y) * chi.sin() * (0.5 * chi).tan().powf(-mu / beta.tan())
        };
        for i in 1..m.states.len() {
            assert!((block(i) / block(0) - 1.0).abs() < 1e-11, "{mu} {i}: {}", block(i) / block(0));
            assert_eq!(m.states[i].w3, 0.0);
        }
        let (ending, after) = end(&moved(&body, slides(&body, [-0.6, 1.1], 0.0), &[99.0], &rough(mu, beta)));
        if mu < beta.tan() {
            assert_eq!(ending, Ending::Done);
        } else {
            // The sum of v and its downhill part, over gravity, falls at a constant rate.
            let (v, along) = (0.6f64.hypot(1.1), -0.6);
            let expected = (mu * v + along * beta.tan()) / (beta.cos() * (mu * mu - beta.tan().powi(2)));
            assert!(ending == Ending::Stops && (after - expected).abs() < 1e-12, "{after} {expected}");
        }
    }
}

#[test]
fn a_spinning_face_drifts_down_and_to_its_right_as_friction_of_a_slow_slide_says() {
    // To first order in the slope v = A (s0 (s/s0)^p - s), p = (i3/2)/(1 - i lam), with s = a w, and the i of x + i y.
    let (mu, beta, body) = (0.3f64, 1e-7f64, Body::tube(0.8, 0.6).unwrap());
    let (lam, i3, w, t) = (mu * 0.8, body.i3(), 1.4, 2.0);
    let m = moved(&body, slides(&body, [0.0; 2], w), &[t], &rough(mu, beta));
    let s = w - mu * t / i3;
    assert!((m.states[0].w3 - s).abs() < 1e-9);
    let size = 1.0 + lam * lam;
    let p = [0.5 * i3 / size, 0.5 * i3 * lam / size];
    let (grows, turns) = (w * (s / w).powf(p[0]), p[1] * (s / w).ln());
    let [x, y] = [grows * turns.cos() - s, grows * turns.sin()];
    let (d, all) = ((1.0 - p[0]).powi(2) + p[1] * p[1], beta * i3 / mu);
    let expected = [((1.0 - p[0]) * x - p[1] * y) / d * all, ((1.0 - p[0]) * y + p[1] * x) / d * all];
    let [_, _, v_x, v_y] = centre(&body, &m, 0);
    assert!(
        (v_x - expected[0]).abs() < 1e-7 * v_x && (v_y - expected[1]).abs() < 1e-7 * v_x,
        "{v_x} {v_y} {expected:?}"
    );
    // The other way round to the other side.
    let other = moved(&body, slides(&body, [0.0; 2], -w), &[t], &rough(mu, beta));
    let [_, _, v_x2, v_y2] = centre(&body, &other, 0);
    assert!((v_x2 - v_x).abs() < 1e-18 && (v_y2 + v_y).abs() < 1e-18 && v_y < 0.0, "{v_y}");
}

#[test]
fn smooth_and_viscous_faces_fall_downhill_as_their_laws_say() {
    let (beta, c, body) = (0.3f64, 0.25, Body::tube(0.0, 0.8).unwrap());
    let start = slides(&body, [-0.3, 0.8], 1.1);
    let (sin, cos) = beta.sin_cos();
    let m =
        moved(&body, start, &[0.0, 2.0], &Ask::on(Contact::Smooth).with_restitution(0.0).with_slope(beta));
    let [x, y, v_x, v_y] = centre(&body, &m, 1);
    assert!((v_x - (2.0 * sin - 0.3)).abs() < 1e-13 && (v_y - 0.8).abs() < 1e-13, "{v_x} {v_y}");
    assert!((x - (2.0 * sin - 0.6)).abs() < 1e-13 && (y - 1.6).abs() < 1e-13, "{x} {y}");
    // Without a height the slide and the spin of a viscous face do not know of each other.
    let ask = Ask::on(Friction::Viscous { c }).with_restitution(0.0).with_slope(beta);
    let m = moved(&body, start, &[0.0, 2.0], &ask);
    let [_, _, v_x, v_y] = centre(&body, &m, 1);
    let (left, last) = ((-2.0 * c * cos).exp(), sin / (c * cos));
    assert!((v_x - last - (-0.3 - last) * left).abs() < 1e-12, "{v_x}");
    assert!((v_y - 0.8 * left).abs() < 1e-12);
    assert!((m.states[1].w3 - 1.1 * (-2.0 * c * cos / body.i3()).exp()).abs() < 1e-12);
}

#[test]
fn a_body_that_slides_down_too_fast_for_its_height_topples_and_one_that_spins_does_not() {
    let (mu, beta) = (0.55, 0.7f64);
    let body = Body::solid(2.0).unwrap();
    let m = moved(&body, LEVEL.into(), &[0.3], &rough(mu, beta));
    assert!(
        m.states[0].theta > 1e-3 && m.path.as_ref().unwrap().phases.last().unwrap().kind == Kind::Slipping
    );
    let m = moved(&body, slides(&body, [0.0; 2], 3.0), &[0.3], &rough(mu, beta));
    assert_eq!((m.states[0].theta, m.path.as_ref().unwrap().phases.len()), (0.0, 1));
}

/// The sum of energy and heat at the output `i`.
fn balance(body: &Body, slope: f64, m: &Motion, i: usize) -> f64 {
    let [x, y, v_x, v_y] = centre(body, m, i);
    let w = m.states[i].w3;
    let _ = y;
    0.5 * (v_x * v_x + v_y * v_y + body.i3() * w * w) - slope.sin() * x
        + m.path.as_ref().unwrap().dissipated[i]
}

#[test]
fn energy_and_heat_stay_together_and_uphill_is_downhill_turned_round_and_the_mirror_image_mirrored() {
    let mut next = wander(691);
    for case in 0..60 {
        let mut within = |low: f64, high: f64| low + (high - low) * next();
        let body = Body::tube(within(0.0, 2.0), within(0.0, 1.0)).unwrap();
        let (mu, beta) = (within(0.05, 0.45), within(-0.8, 0.8));
        let face = if case % 5 == 0 { Face::Disc } else { Face::Ring };
        let (v, w) = ([within(-1.0, 1.0), within(-1.0, 1.0)], within(-2.0, 2.0));
        let times: Vec<f64> = (0..=8).map(f64::from).collect();
        // Air takes from the spin as well.
        let losses = if case % 3 == 0 { Losses::of(Law::AirLinear, 0.07) } else { Losses::NONE };
        let ask = rough(mu, beta).with_face(face).with_losses(losses);
        let m = moved(&body, slides(&body, v, w), &times, &ask);
        let work = |i: usize| m.path.as_ref().unwrap().work_lost.get(i).copied().unwrap_or(0.0);
        assert!(work(m.states.len() - 1) >= 0.0);
        for i in 0..m.states.len() {
            let off = balance(&body, beta, &m, i) + work(i) - balance(&body, beta, &m, 0);
            let most = 1e-12 * (1.0 + m.path.as_ref().unwrap().dissipated[i]) + 10.0 * m.error;
            assert!(m.states[i].theta > 0.0 || off.abs() < most, "{case} {i}: {off} {:?}", m.error);
        }
        let turned = ask.with_slope(-beta);
        let back = moved(&body, slides(&body, v.map(|x| -x), w), &times, &turned);
        let over = moved(&body, slides(&body, [v[0], -v[1]], -w), &times, &ask);
        for i in 0..m.states.len() {
            if m.states[i].theta > 0.0 {
                break;
            }
            let [a, b, c] = [&m, &back, &over].map(|m| centre(&body, m, i));
            let most = 1e-11 * (1.0 + a[0].abs() + a[2].abs()) + 10.0 * m.error;
            for (j, x) in a.iter().enumerate() {
                let mirrored = if j % 2 == 1 { -c[j] } else { c[j] };
                assert!((x + b[j]).abs() < most && (x - mirrored).abs() < most, "{case} {i} {j}");
            }
        }
    }
}

#[test]
fn slide_and_spin_end_together_on_a_slope_that_holds_and_last_longer_the_steeper_it_is() {
    let body = Body::tube(0.4, 0.7).unwrap();
    let mut before = 0.0;
    for beta in [0.0, 0.1, 0.2, 0.28] {
        let (ending, after) = end(&moved(&body, slides(&body, [0.5, 0.3], 1.0), &[99.0], &rough(0.3, beta)));
        assert!(ending == Ending::Stops && after > before, "{beta} {after}");
        before = after;
    }
    assert!(end_ratio(Face::Ring, 0.12, body.i3()).unwrap() > 0.0);
    let m = moved(&body, slides(&body, [0.5, 0.3], 1.0), &[20.0], &rough(0.3, 0.31));
    assert_eq!(end(&m).0, Ending::Done);
    // A slide that does not end has no force left for the spin, but never all of it.
    assert!(m.states[0].w3 > 0.0 && m.states[0].w3 < 0.05, "{:?}", m.states[0]);
}

#[test]
fn a_coin_dropped_flat_on_a_slope_bounces_and_then_slides_or_stays() {
    let body = Body::solid(0.1).unwrap();
    for (mu, beta) in [(0.2, 0.4), (0.6, 0.4)] {
        let start = Start::from(State { w3: 1.5, ..LEVEL }).with_aloft(AboveTable::new(0.2, 0.0));
        let m = moved(&body, start, &[30.0], &rough(mu, beta).with_restitution(0.5));
        let path = m.path.as_ref().unwrap();
        assert!(path.impacts.len() > 5 && path.phases.iter().any(|phase| phase.kind == Kind::OnItsFace));
        assert_eq!(end(&m).0, if mu < 0.4f64.tan() { Ending::Done } else { Ending::Stops });
    }
}

#[test]
fn a_pillar_rocks_to_rest_on_a_slope_and_tips_over_on_one_that_is_too_steep() {
    let body = Body::solid(2.0).unwrap();
    for (beta, falls) in [(0.1, false), (0.3, false), (0.47, true)] {
        // Let go with its lower edge on the table, and with its upper one.
        for heading in [0.0, PI] {
            let start = Start::from(State { theta: 0.02, ..LEVEL }).with_heading(heading);
            let m = moved(&body, start, &[60.0], &rough(2.0, beta));
            let last = m.event.map(|event| event.state);
            let stays = end(&m).0 == Ending::Stops && last.is_some_and(|y| y.theta == 0.0);
            let p = m.path.as_ref().unwrap();
            println!(
                "{beta} {heading} {:?} {:?} {:?} {:?}",
                m.states,
                m.event,
                p.phases.len(),
                p.phases.iter().map(|p| (p.time, p.kind)).collect::<Vec<_>>()
            );
            assert_eq!(stays, !falls, "{beta} {heading} {:?}", m.event);
        }
    }
}

/// The angular acceleration with which a body that is let go on a slope leaves its face, and whether it slips; NaN if
/// the motion raises an error.
fn leaves(body: &Body, friction: Friction, arm: f64, tan: f64) -> (f64, bool) {
    let losses = Losses::of(Law::RollingResistance, arm);
    let ask = Ask::on(friction).with_restitution(0.0).with_slope(tan.atan()).with_losses(losses).with_pose();
    match roll_with(body, LEVEL, &[0.0, 1e-3], &ask, || true) {
        Ok(m) => {
            let m = m.unwrap();
            let slips =
                m.path.as_ref().unwrap().phases.last().is_some_and(|phase| phase.kind == Kind::Slipping);
            (2e6 * m.states[m.states.len() - 1].theta / tan.atan().cos(), slips)
        }
        Err(e) => {
            assert!(e.to_string().contains("no unique contact force"), "{e}");
            (f64::NAN, false)
        }
    }
}

#[test]
fn what_lets_a_body_at_rest_on_its_face_tip_over_is_a_couple_that_outweighs_all_that_holds_it() {
    let body = Body::solid(2.0).unwrap();
    let (z, i1) = (2.0, body.i1());
    let on = |mu, fixed| Friction::Coulomb { mu, fixed, patch: 0.0 };
    let sticks = |tan: f64, arm: f64| (tan * z - 1.0 - arm) / (i1 + z * z + 1.0 + arm);
    let slips = |mu: f64, arm: f64| (mu * z - 1.0 - arm) / (i1 - (mu * z - 1.0 - arm));
    for (friction, arm, tan, expected) in [
        // Held, until the weight acts beyond the arm of rolling resistance.
        (on(0.9, 0.9), 0.1, 0.549, (0.0, false)),
        (on(0.9, 0.9), 0.1, 0.56, (sticks(0.56, 0.1), false)),
        // It would slide, but tips over: the lowest point needs less friction than the face.
        (on(0.7, 0.9), 0.0, 0.95, (sticks(0.95, 0.0), false)),
        (on(0.7, 0.9), 0.1, 0.95, (sticks(0.95, 0.1), false)),
        // It slips as it tips over, by the friction of a slip.
        (on(0.52, 0.6), 0.0, 1.2, (slips(0.52, 0.0), true)),
        (on(0.52, 0.52), 0.03, 0.8, (slips(0.52, 0.03), true)),
        // Friction tilts it out of its face, and rolling resistance does not let it rise.
        (on(0.52, 0.52), 0.06, 0.8, (f64::NAN, false)),
        (on(0.52, 0.55), 0.06, 0.8, (f64::NAN, false)),
    ] {
        let (found, slipping) = leaves(&body, friction, arm, tan);
        let off = (found - expected.0).abs();
        assert!(
            off < 1e-3 * expected.0 || found == expected.0 || found.is_nan() && expected.0.is_nan(),
            "{friction:?} {arm} {tan}: {found} {expected:?}"
        );
        assert!(slipping == expected.1, "{friction:?} {arm} {tan}");
    }
}

#[test]
fn a_slow_slip_of_a_body_that_topples_ends_before_the_body_has_risen_and_it_rests() {
    let body = Body::rounded_tube(1.0, 0.0, 0.1).unwrap();
    let friction = Friction::Coulomb { mu: 1.0, fixed: 1.2, patch: 0.0 };
    for speed in [1e-12, 1e-10, 1e-7] {
        for slope in [1e-16, 0.1] {
            let start = Start::from(State { w3: -speed, ..LEVEL }).with_slip(Slip::new(1e-160, -0.1 * speed));
            let ask = Ask::on(friction).with_restitution(0.5).with_slope(slope);
            let ask = ask.with_losses(Losses::of(Law::AirLinear, 0.02));
            let m = moved(&body, start, &[0.0, 0.5, 10.0], &ask);
            assert_eq!(m.ending(), Ending::Stops, "{speed} {slope} {:?}", m.event);
            let time = m.event.unwrap().time;
            assert!(
                time < 10.0 * speed && m.error < 20.0 * speed.max(1e-12),
                "{speed} {slope} {time} {}",
                m.error
            );
        }
    }
}

#[test]
fn on_a_slope_that_friction_just_holds_a_block_keeps_half_of_the_speed_at_which_it_is_thrown_across() {
    let body = Body::tube(0.5, 0.8).unwrap();
    let slope = 0.3f64.atan();
    // A spin dies out beside the slide, too.
    for (v, w) in [(1e-4, 0.0), (1e-4, 1e-12)] {
        let m = moved(&body, slides(&body, [0.0, v], w), &[1e2, 1e4], &rough(0.3, slope));
        assert_eq!(m.ending(), Ending::Done);
        let [a, b] = [0, 1].map(|i| centre(&body, &m, i));
        assert!((a[2] / (0.5 * v) - 1.0).abs() < 1e-6 && (b[2] / (0.5 * v) - 1.0).abs() < 1e-6, "{a:?}");
        assert!(b[3].abs() < 1e-13 * v && m.states[1].w3 == 0.0, "{b:?} {:?}", m.states[1]);
        assert!(((b[0] - a[0]) / (9.9e3 * 0.5 * v) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn a_slow_spin_on_a_face_that_friction_and_the_ring_both_just_hold_comes_to_rest() {
    let body = Body::solid(2.0).unwrap();
    for face in [Face::Ring, Face::Disc] {
        let m =
            moved(&body, slides(&body, [0.0; 2], 1e-10), &[10.0], &rough(0.5, 0.5f64.atan()).with_face(face));
        assert_eq!(m.ending(), Ending::Stops, "{:?}", m.event);
    }
}

#[test]
fn a_tall_disc_whose_slide_becomes_as_fast_as_its_spin_ends_in_a_time_in_proportion_to_the_spin() {
    // Dry friction knows no unit of speed.
    let body = Body::frustum(0.7, 1.0, 2.0, None).unwrap();
    let spun = |w: f64| Start::from(State { w3: w, ..LEVEL }).with_slip(Slip::new(0.0, -0.7 * w));
    let ends = |w: f64| {
        let m = moved(&body, spun(w), &[2.0 * w], &rough(1.0, 0.3).with_face(Face::Disc));
        let event = m.event.unwrap();
        assert!(event.ending == Ending::Painleve && m.error < 1e-9, "{event:?} {}", m.error);
        (event.time / w, event.state.w3 / w)
    };
    let (time, spin) = ends(1.0);
    for w in [1e-3, 1e-8] {
        let found = ends(w);
        assert!((found.0 / time - 1.0).abs() < 1e-8 && (found.1 / spin - 1.0).abs() < 1e-8, "{found:?}");
    }
    // The ratio of slide and spin tends to 1 at that time.
    let times = [2e-4, 1e-4].map(|left| time * (1.0 - left));
    let m = moved(&body, spun(1.0), &times, &rough(1.0, 0.3).with_face(Face::Disc));
    let [far, near] = [0, 1].map(|i| {
        let (Slip { u_h, u_2, .. }, w) = (m.path.as_ref().unwrap().slip[i], m.states[i].w3);
        1.0 - u_h.hypot(u_2 + 0.7 * w) / (0.7 * w)
    });
    assert!(near > 0.0 && near < 1e-3 && (far / near - 2.0).abs() < 0.02, "{far} {near}");
}

/// The energy of a sharp body on one rim of its face, on a slope, with the heat.
fn energy_on_rim(body: &Body, slope: f64, m: &Motion, i: usize) -> f64 {
    let (y, path, pose) = (m.states[i], m.path.as_ref().unwrap(), m.poses.as_ref().unwrap()[i]);
    let (Slip { u_h, u_2, .. }, (s, c)) = (path.slip[i], y.theta.sin_cos());
    let (z, a) = (body.ell(), 1.0);
    let (out, up) = (a * c - z * s, a * s + z * c);
    let v = [u_h + up * y.w2, u_2 - z * y.w1 + a * y.w3, out * y.w2];
    let turns = body.i1() * (y.w1 * y.w1 + y.w2 * y.w2) + body.i3() * y.w3 * y.w3;
    let x = pose.contact_point.x + pose.phi.radians().cos() * out;
    0.5 * (v.iter().map(|v| v * v).sum::<f64>() + turns) + slope.cos() * up - slope.sin() * x
        + path.dissipated[i]
}

#[test]
fn a_body_that_topples_as_it_slides_and_spins_on_a_slope_keeps_its_energy_and_heat() {
    let mut next = wander(77);
    let mut toppled = 0;
    for case in 0..24 {
        let mut within = |low: f64, high: f64| low + (high - low) * next();
        let (body, mu, beta) = (Body::solid(within(1.5, 3.0)).unwrap(), within(0.7, 0.8), within(-0.6, 0.6));
        let (v, w) = ([within(-3.0, 3.0), within(-3.0, 3.0)], within(-1.0, 1.0));
        // Air takes from the spin as well.
        let losses = if case % 3 == 0 { Losses::of(Law::AirLinear, 0.05) } else { Losses::NONE };
        let ask = rough(mu, beta).with_losses(losses);
        let start = slides(&body, v, w);
        let Ok(m) = roll_with(&body, start, &[0.0, 1e-3, 0.02], &ask.with_pose(), || true) else {
            continue;
        };
        let m = m.unwrap();
        if m.states.len() < 3 || m.states[1].theta == 0.0 {
            continue;
        }
        toppled += 1;
        let path = m.path.as_ref().unwrap();
        let work = |i: usize| path.work_lost.get(i).copied().unwrap_or(0.0);
        let begin = energy_on_rim(&body, beta, &m, 0);
        for i in 1..3 {
            let off = energy_on_rim(&body, beta, &m, i) + work(i) - begin;
            assert!(off.abs() < 1e-11 + 4.0 * m.error, "{case} {i}: {off} {} {v:?} {w} {beta}", m.error);
        }
        assert!(m.error < 1e-9, "{}", m.error);
    }
    assert!(toppled > 10, "{toppled}");
}

#[test]
fn the_side_from_which_a_body_on_its_face_is_told_changes_nothing_that_it_does() {
    let (body, v, w) = (Body::tube(1.2, 0.6).unwrap(), [0.7, -0.4], 1.3);
    for (mu, beta) in [(0.3, 0.2), (0.2, 0.4), (0.6, 0.3)] {
        let ask = rough(mu, beta);
        let times = [0.2, 0.5, 1.0];
        let known = moved(&body, slides(&body, v, w), &times, &ask);
        for heading in [0.9f64, 2.0, -1.4] {
            let (sin, cos) = heading.sin_cos();
            let slip = [v[0] * cos + v[1] * sin, v[1] * cos - v[0] * sin - w];
            let start = Start::from(State { w3: w, ..LEVEL }).with_slip(slip.into()).with_heading(heading);
            let m = moved(&body, start, &times, &ask);
            for i in 0..times.len() {
                let [_, _, u, v] = centre(&body, &known, i);
                let [_, _, v_h, v_2] = centre(&body, &m, i);
                let turned = [v_h * cos - v_2 * sin, v_2 * cos + v_h * sin];
                let most = 1e-12 + 4.0 * (known.error + m.error);
                assert!((known.states[i].w3 - m.states[i].w3).abs() < most);
                let face = known.states[i].theta == 0.0;
                assert!(!face || (turned[0] - u).abs() + (turned[1] - v).abs() < most, "{mu} {heading}");
                // Told from the same point, once it has toppled.
                let off = (known.states[i].theta - m.states[i].theta).abs()
                    + (known.states[i].w1 - m.states[i].w1).abs();
                assert!(off < 10.0 * most, "{mu} {heading} {off}");
            }
        }
    }
}

#[test]
fn a_tall_body_ends_where_its_slide_becomes_as_fast_as_its_spin_whatever_else_acts() {
    // There the lowest point of its ring has no slip, so that no law says how the motion goes on.
    let (mut next, mut met) = (wander(29), 0);
    for k in 0..24 {
        let mut within = |low: f64, high: f64| low + (high - low) * next();
        let body = Body::tube(within(2.8, 5.0), within(0.0, 1.0)).unwrap();
        let mu = within(2.0, 2.5) * body.rim() / body.ell();
        let (slope, w) = (within(0.4, 0.7), within(-2.0, 2.0));
        let mut ask = Ask::on(Friction::coulomb(mu)).with_slope(slope);
        if k % 2 == 0 {
            ask =
                ask.with_losses(Losses::of(Law::RollingResistance, 0.03) + Losses::of(Law::AirLinear, 0.02));
        }
        let start = slides(&body, [within(-0.3, 0.3), within(-0.3, 0.3)], w).with_heading(within(-PI, PI));
        let found = roll_with(&body, start, &[20.0], &ask.with_pose(), || true).unwrap().unwrap();
        let (ending, time) = end(&found);
        if ending != Ending::Painleve || time == 0.0 {
            continue;
        }
        met += 1;
        let Slip { u_h: u, u_2: v, .. } = found.path.as_ref().unwrap().last_slip;
        let y = found.event.unwrap().state;
        let (slide, spin) = (u.hypot(v + body.rim() * y.w3), body.rim() * y.w3.abs());
        let off = (slide - spin).abs();
        assert!(
            off < 1e-11 + found.error && found.error < 1e-5,
            "{off:e} {:e}: {body:?} {start:?} {ask:?}",
            found.error
        );
        let times: Vec<f64> = (0..=40).map(|i| time * f64::from(i) / 40.0).collect();
        let m = moved(&body, start, &times, &ask);
        let path = m.path.as_ref().unwrap();
        for i in 0..m.states.len() {
            let taken = path.work_lost.get(i).copied().unwrap_or(0.0);
            let off = balance(&body, slope, &m, i) + taken - balance(&body, slope, &m, 0);
            assert!(off.abs() < 1e-11 + 10.0 * m.error, "{off:e} {:e} at {}", m.error, m.times[i]);
        }
    }
    assert!(met > 5, "{met}");
}
