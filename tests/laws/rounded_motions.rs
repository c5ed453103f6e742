//! Motions of rounded bodies: exact and integrated, where they pass flat or through a pole, and how they end.

use crate::common::{
    BOTH, any_ball, any_state, by, distance, moved, numbers, rounded_disk, rounded_starts, state,
};
use crate::{ULP, place};
use proptest::prelude::*;
use spincyl::exact::{AnglesPerPeriod, Swing};
use spincyl::motion::{Ask, Ending, Method};
use spincyl::{Body, Contact, State, rk4, rolling, steady};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The integrals of Routh and of Jellett of a ball.
fn integrals(body: &Body, y: &State) -> [f64; 2] {
    let at = place(body, y.theta);
    let (i1, i3, depth) = (body.i1(), body.i3(), at.depth[0]);
    let d = i1 * i3 + i1 * at.radius * at.radius + i3 * depth * depth;
    [y.w3 * d.sqrt(), i1 * at.radius * y.w1 + i3 * depth * y.w3]
}

#[test]
fn routh_and_jellett_hold_along_exact_motions_and_along_rk4() {
    for (body, y) in rounded_starts().into_iter().filter(|(body, _)| body.fillet() == 1.0) {
        let swing = Swing::new(&body, &y, Contact::Rolling).unwrap();
        let start = integrals(&body, &y);
        for k in 1..60 {
            let now = integrals(&body, &swing.state(0.37 * f64::from(k)));
            assert!(
                (0..2).all(|i| (now[i] - start[i]).abs() < 8e-15 * (1.0 + start[i].abs())),
                "{now:?} {start:?}"
            );
        }
        let end = rk4::integrate(|y| rolling::derivative(&body, y), y, 2e-4, 100_000);
        let now = integrals(&body, &end);
        assert!((0..2).all(|i| (now[i] - start[i]).abs() < 1e-13), "{now:?} {start:?}");
    }
}

#[test]
fn halving_the_fillet_halves_what_it_changes_of_a_motion() {
    let start = state(0.6, 1.2, -0.3, 0.9);
    for contact in BOTH {
        let at = |fillet: f64| {
            let body = Body::rounded(0.8, 0.6, 0.5, fillet).unwrap();
            let swing = Swing::with_pose(&body, &start, contact).unwrap();
            let (y, pose, rest) =
                (swing.state(7.0), swing.pose(7.0).unwrap(), steady::state(&body, 0.6).unwrap());
            let kappa = spincyl::stability::at_rest(&body, 0.6, contact);
            let place = [pose.phi.radians(), pose.psi.radians(), pose.contact_point.x, pose.contact_point.y];
            [numbers(&y), place, [swing.period(), rest.w1, kappa, contact.energy(&body, &start)]].concat()
        };
        let sharp = at(0.0);
        for fillet in [1e-4, 1e-6] {
            let (whole, half) = (at(fillet), at(0.5 * fillet));
            for i in 0..sharp.len() {
                let (one, two) = (half[i] - sharp[i], whole[i] - sharp[i]);
                assert!(
                    (two - 2.0 * one).abs() <= 1e3 * fillet * fillet + 2e-12,
                    "{contact:?} {i} {fillet:e}: {one:e} {two:e}"
                );
                assert!(two.abs() < 100.0 * fillet);
            }
        }
        // and the fillet does change the motion
        let changed = at(1e-4).iter().zip(&sharp).filter(|(a, b)| (*a - *b).abs() > 1e-6).count();
        assert!(changed >= 8, "{changed}");
    }
}

#[test]
fn a_smooth_table_moves_a_rounded_body_as_it_moves_a_sharp_one_of_the_size_of_its_rim() {
    for (ell, i1, i3, y) in
        [(0.9, 0.5, 0.4, state(0.7, 1.3, -0.2, 2.0)), (0.1, 0.2, 0.3, state(0.5, 1.9, 0.4, 0.3))]
    {
        let round = Body::rounded(ell, i1, i3, 0.75).unwrap();
        let sharp = Body::new(4.0 * ell, 16.0 * i1, 16.0 * i3).unwrap();
        let scaled = State { w1: 0.5 * y.w1, w2: 0.5 * y.w2, w3: 0.5 * y.w3, ..y };
        let here = Swing::with_pose(&round, &y, Contact::Smooth).unwrap();
        let there = Swing::with_pose(&sharp, &scaled, Contact::Smooth).unwrap();
        assert!((2.0 * here.period() / there.period() - 1.0).abs() < 4e-15);
        for t in [0.3, 2.0, 30.0] {
            let (a, b) = (here.state(t), there.state(2.0 * t));
            let a = State { w1: 0.5 * a.w1, w2: 0.5 * a.w2, w3: 0.5 * a.w3, ..a };
            assert!(distance(&a, &numbers(&b)) <= here.error(t) + there.error(2.0 * t));
            let (p, q) = (here.pose(t).unwrap(), there.pose(2.0 * t).unwrap());
            let claims = here.pose_error(t) + there.pose_error(2.0 * t);
            assert!(
                (p.phi.radians() - q.phi.radians()).abs() <= claims
                    && (p.psi.radians() - q.psi.radians()).abs() <= claims
            );
            assert!((4.0 * p.contact_point.coords - q.contact_point.coords).norm() <= 4.0 * claims);
        }
    }
}

/// A body that rocks turns by pi sqrt(1 + a^2/(I1 + H^2)) as it passes flat. Srinivasan, Ruina, Phys. Rev. E
/// 78, 066609 (2008), for a sharp can.
#[test]
fn a_rocking_body_turns_by_a_fixed_angle_at_every_pass() {
    let turn = |body: &Body| {
        let high = body.ell() + body.fillet();
        PI * (1.0 + body.rim().powi(2) / (body.i1() + high * high)).sqrt()
    };
    assert!(
        (turn(&rounded_disk()).to_degrees() - 364.93).abs() < 5e-3,
        "{}",
        turn(&rounded_disk()).to_degrees()
    );
    // the same disk with a sharp rim
    let sharp = Body::solid(6.5 / 37.55).unwrap();
    assert!((turn(&sharp).to_degrees() - 379.66).abs() < 5e-3, "{}", turn(&sharp).to_degrees());
    let can = Body::rounded_tube(1.0, 0.0, 0.1).unwrap();
    let torus = Body::rounded(0.0, 0.5 * 0.36 + 0.625 * 0.16, 0.36 + 0.75 * 0.16, 0.4).unwrap();
    let ball = Body::ball(-0.2, 0.3, 0.4).unwrap();
    assert!((turn(&ball) - PI).abs() < 1e-15);
    for (body, theta) in [(rounded_disk(), 0.3), (sharp, 0.3), (can, 0.2), (torus, 0.5), (ball, 0.7)] {
        // from rest with a small precession, with which the turn in the rest of the swing vanishes
        for w1 in [1e-3, 1e-4, 1e-5] {
            let swing = Swing::with_pose(&body, &state(theta, w1, 0.0, 0.0), Contact::Rolling).unwrap();
            let phi = swing.angles_per_period().unwrap().precession;
            assert!((phi - turn(&body)).abs() < 40.0 * w1, "{body:?} {w1:e}: {} {}", phi, turn(&body));
            let miss = (phi - turn(&body)).abs();
            assert!(miss > 1e-4 * w1 || body.fillet() == 1.0, "{miss:e}");
        }
    }
}

#[test]
fn rounded_bodies_land_where_they_can() {
    let methods = [(Method::Exact, 1e-11), (Method::Tolerance(1e-13), 1e-9), (Method::Step(1e-4), 1e-9)];
    let can = Body::rounded_tube(1.0, 0.0, 0.1).unwrap();
    let torus = Body::rounded(0.0, 0.5 * 0.36 + 0.625 * 0.16, 0.36 + 0.75 * 0.16, 0.4).unwrap();
    let at = |body: &Body, y: State, t: f64, method| moved(body, &y, &[t], by(method).with_pose()).unwrap();
    for (method, allowed) in methods {
        // a can on its side
        let event = at(&can, state(1.2, 0.1, -0.2, 0.1), 10.0, method).event.unwrap();
        assert_eq!(event.ending, Ending::Side, "{method:?}");
        assert!((event.state.theta - FRAC_PI_2).abs() < allowed && event.state.w2 < 0.0);
        // a cap that lands at 1.4
        let capped = can.with_theta_end(1.4).unwrap();
        let event = at(&capped, state(1.2, 0.1, -0.2, 0.1), 10.0, method).event.unwrap();
        assert_eq!((event.ending, event.state.theta), (Ending::Side, 1.4), "{method:?}");
        // it falls on its face: J theta'^2/2 is the energy of the fall
        let event = at(&can, state(0.3, 0.0, 0.0, 0.0), 10.0, method).event.unwrap();
        let drop = rolling::energy(&can, &state(0.3, 0.0, 0.0, 0.0)) - 1.0;
        let j = can.i1() + can.rim().powi(2) + 1.0;
        assert_eq!((event.ending, event.state.theta), (Ending::Face, 0.0), "{method:?}");
        assert!((event.state.w2 - (2.0 * drop / j).sqrt()).abs() < 1e-9, "{method:?}");
        // a torus passes its side, and lands on its other face
        let through = at(&torus, state(1.5, 1.2, -0.3, 0.2), 0.5, method);
        assert!(through.event.is_none() && through.states[0].theta > FRAC_PI_2, "{method:?}");
        let event = at(&torus, state(1.6, 0.0, 0.0, 0.0), 20.0, method).event.unwrap();
        assert_eq!((event.ending, event.state.theta), (Ending::Face, PI), "{method:?}");
        let cut = torus.with_theta_end(2.0).unwrap();
        let event = at(&cut, state(1.6, 0.0, 0.0, 0.0), 20.0, method).event.unwrap();
        assert_eq!((event.ending, event.state.theta), (Ending::Side, 2.0), "{method:?}");
    }
}

#[test]
fn a_ball_goes_through_both_poles_without_an_end() {
    let ball = Body::ball(-0.2, 0.3, 0.4).unwrap();
    for contact in BOTH {
        // released at rest it swings through the lower pole; pushed over the top it goes through both
        for y in [state(1.2, 0.0, 0.0, 0.0), state(1.2, 0.0, -2.0, 0.0), state(2.9, 0.0, -1.5, 0.0)] {
            let times: Vec<f64> = (1..200).map(|k| 0.1 * f64::from(k)).collect();
            let motion = moved(&ball, &y, &times, Ask::default().with_table(contact).with_pose()).unwrap();
            assert!(motion.event.is_none() && motion.states.len() == times.len(), "{:?}", motion.event);
            let start = contact.energy(&ball, &y);
            for y in &motion.states {
                assert!((contact.energy(&ball, y) - start).abs() < 1e-13 * (1.0 + start.abs()), "{y:?}");
                assert!(y.theta >= 0.0 && y.theta <= PI && y.w1.abs() < 1e-12 && y.w3.abs() < 1e-12);
            }
            // a plane motion passes the pole like any other point
            let swing = Swing::new(&ball, &y, contact).unwrap();
            let [low, high] = swing.turning_points();
            assert!(low == 0.0 && (high < PI) == (y.w2 == 0.0), "{low} {high}");
        }
    }
    // the period of this pendulum by quadrature: sqrt(J/(2 (h(1.2) - h))) d theta, with theta = 1.2 sin u
    let swing = Swing::new(&ball, &state(1.2, 0.0, 0.0, 0.0), Contact::Rolling).unwrap();
    let n = 4000;
    let quarter: f64 = (0..n)
        .map(|i| {
            let u = FRAC_PI_2 * (f64::from(i) + 0.5) / f64::from(n);
            let x = 1.2 * u.sin();
            let drop = 2.0 * 0.2 * (0.5 * (1.2 + x)).sin() * (0.5 * (1.2 - x)).sin();
            let j = 0.3 + x.sin().powi(2) + (-0.2 + x.cos()).powi(2);
            (j / (2.0 * drop)).sqrt() * 1.2 * u.cos()
        })
        .sum::<f64>()
        * FRAC_PI_2
        / f64::from(n);
    assert!((swing.period() / (2.0 * quarter) - 1.0).abs() < 1e-12, "{} {}", swing.period(), 2.0 * quarter);
    // with a cap the motion ends before
    let capped = ball.with_theta_end(1.3).unwrap();
    let motion = moved(&capped, &state(1.2, 0.0, -2.0, 0.0), &[5.0], Ask::default()).unwrap();
    assert_eq!(motion.event.map(|e| (e.ending, e.state.theta)), Some((Ending::Side, 1.3)));
}

#[test]
fn two_balls_end_where_the_second_one_lands() {
    let balls = Body::balls(1.0).unwrap();
    for method in [Method::Exact, Method::Tolerance(1e-12), Method::Step(1e-4)] {
        let y = steady::state(&balls, 1.5).unwrap();
        let motion = moved(&balls, &y.kicked(0.5), &[50.0], by(method)).unwrap();
        let event = motion.event.unwrap();
        assert_eq!((event.ending, event.state.theta), (Ending::Side, FRAC_PI_2), "{method:?}");
        assert!(moved(&balls, &y, &[50.0], by(method)).unwrap().event.is_none());
    }
}

proptest! {
    #![proptest_config(crate::common::cases(512))]

    #[test]
    fn a_ball_keeps_its_integrals_along_any_motion(body in any_ball(), y in any_state(), t in 0.0..20.0f64) {
        let Ok(swing) = Swing::new(&body, &y, Contact::Rolling) else { return Ok(()) };
        let (start, now) = (integrals(&body, &y), integrals(&body, &swing.state(t)));
        let size = (1.0 + y.w1.abs() + y.w3.abs()) * (body.i1() + body.i3()) * (2.0 + body.ell().abs()).powi(2);
        for i in 0..2 {
            prop_assert!((now[i] - start[i]).abs() <= 64.0 * ULP * size + size * swing.error(t), "{now:?} {start:?}");
        }
    }

}

#[test]
fn the_angles_of_a_ball_jump_together_where_it_passes_its_pole() {
    // phi and psi jump by half a turn against each other, so that the body turns smoothly
    let ball = Body::ball(-0.2, 0.3, 0.4).unwrap();
    for contact in BOTH {
        let swing = Swing::with_pose(&ball, &state(1.2, 0.0, -2.0, 0.0), contact).unwrap();
        let AnglesPerPeriod { precession: phi, spin: psi, .. } = swing.angles_per_period().unwrap();
        assert!(
            (phi / PI - (phi / PI).round()).abs() < 1e-12
                && (phi.rem_euclid(TAU)).min(TAU - phi.rem_euclid(TAU)) < 1e-9
        );
        assert!((psi / PI - (psi / PI).round()).abs() < 1e-12);
    }
}
