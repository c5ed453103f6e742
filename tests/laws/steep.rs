//! The steepest slope on which a body stays: closed forms for bodies that stand, lie and roll, and motions on both
//! sides of the limit.

use crate::common::{any_body, general_rounded, wander};
use proptest::prelude::*;
use spincyl::body::Circle;
use spincyl::contact::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{Ask, Ending, Start, roll_with};
use spincyl::sideways::{SlopeDrift, slope_drift};
use spincyl::steep::{Incline, Posture, SlopeShares, shares, slip_slope, tip_slope};
use spincyl::{Body, State, stability, steady};
use std::f64::consts::{FRAC_PI_2, PI};

const SIDE: f64 = FRAC_PI_2;
const ACROSS: f64 = -FRAC_PI_2;

fn slips(body: &Body, mu: f64, posture: Posture, phi: f64) -> f64 {
    slip_slope(body, SIDE, mu, posture, phi).unwrap().tan()
}

#[test]
fn what_rolls_straight_down_slips_where_its_friction_cannot_turn_it() {
    let mu = 0.3;
    let ball = |i: f64| Body::ball(0.0, i, i).unwrap();
    for (body, share) in [
        (Body::solid(0.0).unwrap(), 1.0 / 3.0),
        (Body::solid(2.0).unwrap(), 1.0 / 3.0),
        (Body::tube(0.0, 1.0).unwrap(), 0.5),
        (Body::tube(3.0, 1.0).unwrap(), 0.5),
        (ball(0.4), 2.0 / 7.0),
        (ball(2.0 / 3.0), 0.4),
    ] {
        let t = slips(&body, mu, Posture::Rolling, ACROSS);
        assert!((t * share / mu - 1.0).abs() < 1e-14, "{body:?}: {t}");
        assert!((slips(&body, mu, Posture::Lying, ACROSS) / mu - 1.0).abs() < 1e-14);
    }
    // Wheels of the radius A, between which the body is narrower than its unit of length: k + A^2 over k.
    for radius in [0.4, 1.0, 1.7] {
        let wheel = |depth| Circle { radius, depth, fillet: 0.0 };
        let axle = Body::profile(&[wheel(1.0), wheel(-0.6)], 0.3, 0.2).unwrap();
        let t = slips(&axle, mu, Posture::Rolling, ACROSS);
        assert!((t / (mu * (0.2 + radius * radius) / 0.2) - 1.0).abs() < 1e-14, "{radius}: {t}");
    }
}

#[test]
fn a_body_on_its_side_slips_where_the_closed_form_of_two_equal_circles_says() {
    let mut next = wander(5);
    let (mut lighter, mut both) = (0, 0);
    for _ in 0..400 {
        let (l, mu, phi) = (0.1 + 3.0 * next(), 0.05 + 1.2 * next(), PI * (2.0 * next() - 1.0));
        let body = Body::tube(l, next()).unwrap();
        for (posture, share) in [(Posture::Lying, 1.0), (Posture::Rolling, body.i3() / (1.0 + body.i3()))] {
            let (q, c) = (share * phi.sin().abs(), phi.cos().abs());
            let early = mu * q * l > (l * l - mu * mu) * c;
            let expected = if early {
                mu * l / (q * l + mu * c)
            } else {
                mu * ((l * l - mu * mu) / (l * l * (c * c + q * q) - mu * mu * c * c)).sqrt()
            };
            (lighter, both) = (lighter + i32::from(early), both + i32::from(!early));
            let t = slips(&body, mu, posture, phi);
            assert!((t / expected - 1.0).abs() < 1e-12, "{t} {expected}: {l} {mu} {phi}");
            let tips = tip_slope(&body, SIDE, posture, phi).unwrap().tan();
            assert!((tips * c / l - 1.0).abs() < 1e-13 && t <= tips * (1.0 + 1e-13));
        }
        // With its axis downhill it slips at mu.
        let t = slips(&body, mu, Posture::Lying, 0.0);
        assert!((t / mu.min(l) - 1.0).abs() < 1e-14, "{t} {mu} {l}");
    }
    assert!(lighter > 100 && both > 100, "{lighter} {both}");
}

proptest! {
    #![proptest_config(crate::common::cases(64))]

    #[test]
    fn a_body_tips_over_the_edge_of_its_face_where_its_weight_meets_the_table_beyond_it(
        body in prop_oneof![any_body(), general_rounded()], mu in 0.01..2.0f64,
    ) {
        prop_assume!(body.fillet() < 1.0);
        let (a, z) = (1.0 - body.fillet(), body.ell() + body.fillet());
        let tips = tip_slope(&body, 0.0, Posture::Standing, 0.0).unwrap();
        prop_assert!((tips - a.atan2(z)).abs() < 1e-15);
        prop_assert_eq!(slip_slope(&body, 0.0, mu, Posture::Standing, 0.0).unwrap(), mu.atan());
        if z > 1e-2 {
            let slope = 0.9 * tips;
            let SlopeShares { slipping: slips, tipping: tips, .. } =
                shares(&body, 0.0, mu, &Losses::NONE, Posture::Standing, Incline::new(slope, 0.3)).unwrap();
            let near = |x: f64, y: f64| (x / y - 1.0).abs() < 1e-12;
            prop_assert!(near(tips, slope.tan() * z / a) && near(slips, slope.tan() / mu), "{slips} {tips}");
        }
    }
}

/// Whether a body that is let go rests or rolls straight on both circles, and does not slip or tip at first.
fn stays(body: &Body, theta: f64, mu: f64, losses: Losses, slope: f64, phi: f64) -> bool {
    let start = Start::from(State { theta, w1: 0.0, w2: 0.0, w3: 0.0 }).with_heading(phi);
    let ask = Ask::on(Friction::coulomb(mu)).with_slope(slope).with_losses(losses).with_restitution(0.0);
    let m = roll_with(body, start, &[0.0, 1e-3], &ask, || true).unwrap().unwrap();
    let kinds = m.path.as_ref().unwrap().phases.iter().map(|phase| phase.kind);
    m.ending() == Ending::Stops
        || m.event.is_none() && kinds.clone().all(|kind| kind == Kind::RollingOnItsSide)
}

#[test]
fn the_motion_of_a_body_let_go_on_its_side_is_on_both_sides_of_the_limit_what_it_says() {
    let mut next = wander(9);
    for k in 0..6 {
        let (l, m, mu) = (0.3 + 2.0 * next(), 0.3 + 2.0 * next(), 0.1 + 0.7 * next());
        let (posture, losses) = match k % 2 {
            0 => (Posture::Rolling, Losses::NONE),
            _ => (Posture::Lying, Losses::of(Law::RollingResistance, 0.9)),
        };
        let circle = |depth| Circle { radius: 1.0, depth, fillet: 0.0 };
        let body = Body::profile(&[circle(l), circle(-m)], 0.9, 0.5).unwrap();
        let phi = PI * (2.0 * next() - 1.0);
        let slope = slip_slope(&body, SIDE, mu, posture, phi).unwrap();
        if posture == Posture::Lying && slope.tan() * phi.sin().abs() > 0.85 {
            continue;
        }
        for (share, holds) in [(1.0 - 1e-9, true), (1.0 + 1e-9, false)] {
            let case = format!("{share} {l} {m} {mu} {phi} {posture:?}");
            assert_eq!(stays(&body, SIDE, mu, losses, share * slope, phi), holds, "{case}");
        }
    }
}

#[test]
fn the_shares_of_a_body_at_rest_are_those_of_the_slopes_at_which_it_lets_go() {
    let (can, phi, slope) = (Body::solid(1.5).unwrap(), 0.4f64, 0.1f64);
    let losses = Losses::of(Law::RollingResistance, 0.06);
    let t = slope.tan();
    let of = |posture, body: &Body, theta| {
        shares(body, theta, 0.3, &losses, posture, Incline::new(slope, phi)).unwrap()
    };
    let SlopeShares { slipping: slip, rolling: roll, tipping: tip, .. } = of(Posture::Lying, &can, SIDE);
    assert!((slip - t / slips(&can, 0.3, Posture::Lying, phi)).abs() < 1e-14);
    assert!((roll - t * phi.sin() / 0.06).abs() < 1e-14, "{roll}");
    assert!((tip - t * phi.cos() / 1.5).abs() < 1e-14, "{tip}");
    // A ball of any kind: the couple of its weight about the contact point, over the arm of the resistance.
    let ball = Body::ball(-0.2, 0.4, 0.42).unwrap();
    let SlopeShares { slipping: slip, rolling: roll, tipping: tip, .. } = of(Posture::Edge, &ball, 0.3);
    let (high, lever) = (1.0 - 0.2 * 0.3f64.cos(), -0.2 * 0.3f64.sin());
    let couple = (high * t * phi.sin()).hypot(lever - high * t * phi.cos());
    assert!((slip - t / 0.3).abs() < 1e-14 && (roll - couple / 0.06).abs() < 1e-13 && tip < 1e-16, "{roll}");
    // Dry losses hold no more where the share exceeds 1. With another phi the ball would begin to drill.
    let couple = lever - high * t;
    for (share, holds) in [(1.0 - 1e-9, true), (1.0 + 1e-9, false)] {
        let arm = Losses::of(Law::RollingResistance, couple.abs() / share);
        let start = Start::from(State { theta: 0.3, w1: 0.0, w2: 0.0, w3: 0.0 }).with_heading(0.0);
        let ask = Ask::on(Friction::coulomb(0.3)).with_slope(slope).with_losses(arm);
        let m = roll_with(&ball, start, &[1e-3], &ask, || true).unwrap().unwrap();
        assert_eq!(m.ending() == Ending::Stops, holds, "{share}");
    }
}

#[test]
fn a_spinning_body_drifts_across_a_slope_as_fast_as_was_measured() {
    let balls = Body::balls(1.0).unwrap();
    for (body, theta, precession, kappa, across) in [
        (Body::tube(6.0, 0.8).unwrap(), 1.45, 1.317_104_745_4, 0.484_809_643_2, 0.397_597_235_3),
        (Body::solid(2.5).unwrap(), 1.2, 2.570_390_605_4, 3.605_417_494_4, 0.692_058_857_2),
        (Body::solid(0.05).unwrap(), 0.3, 3.701_938_290_1, 8.584_492_501_6, 0.209_231_311_8),
        (balls, 1.3, 2.747_199_135_6, 5.648_315_767_1, 1.297_778_952_5),
    ] {
        let y = steady::state(&body, theta).unwrap();
        let SlopeDrift { across: found, resonance, .. } = slope_drift(&body, &y);
        assert!((y.precession() - precession).abs() < 1e-9);
        assert!((found - across).abs() < 2e-10, "{found} {across}");
        assert!((resonance - kappa / (precession * precession)).abs() < 1e-9);
        // In the mirror it drifts to the other side.
        let mirrored = State { w1: -y.w1, w3: -y.w3, ..y };
        let there = slope_drift(&body, &mirrored);
        assert_eq!((there.across, there.resonance), (-found, resonance));
    }
    let disk = Body::solid(0.0).unwrap();
    let near_flat = slope_drift(&disk, &steady::state(&disk, 0.001).unwrap()).across;
    let omega = steady::state(&disk, 0.001).unwrap().precession();
    assert!((near_flat * omega * 2.0 * (1.0 + disk.i3()) - 1.0).abs() < 1e-4);
    assert!(slope_drift(&disk, &State { theta: 1.0, w1: 0.3, w2: 0.0, w3: 0.2 }).across.is_nan());
}

#[test]
fn the_circle_of_a_body_that_rolls_steadily_drifts_on_a_small_slope_as_the_first_order_says() {
    let rounded = Body::rounded_tube(2.0, 0.3, 0.1).unwrap();
    for (body, theta, faster) in [(Body::solid(2.5).unwrap(), 1.2, 1.1), (rounded, 1.2, 0.9)] {
        // The centre moves on a circle.
        let omega = faster * steady::state(&body, theta).unwrap().precession();
        let y = steady::circular(&body, theta, omega).unwrap();
        let SlopeDrift { across, resonance, .. } = slope_drift(&body, &y);
        assert!(stability::rolling(&body, &y) > 0.0 && (resonance - 1.0).abs() > 0.3);
        // The mean velocity over a turn, averaged with a weight that vanishes at both ends: nothing of the nutation is left.
        let (turns, per) = (40, 32);
        let times: Vec<f64> =
            (0..=turns * per).map(|i| f64::from(i) * 2.0 * PI / omega / f64::from(per)).collect();
        let mut errors = Vec::new();
        for beta in [4e-4, 2e-4] {
            let ask = Ask::default().with_slope(beta).with_pose();
            let m = roll_with(&body, y, &times, &ask, || true).unwrap().unwrap();
            let centre: Vec<_> = m.samples().map(|now| now.centre(&body).unwrap()).collect();
            let (mut weights, mut sums) = (0.0, [0.0; 2]);
            for i in 0..=(turns - 1) * per {
                let x = f64::from(i) / f64::from((turns - 1) * per);
                let weight = (PI * x).sin().powi(4);
                let (a, b) = (centre[i as usize], centre[(i + per) as usize]);
                weights += weight;
                sums = [sums[0] + weight * (b.x - a.x), sums[1] + weight * (b.y - a.y)];
            }
            let [down, aside] = sums.map(|x| x / weights * omega / (2.0 * PI) / beta.sin());
            errors.push((aside - across).abs() + down.abs());
        }
        assert!(errors[1] < 2e-3 * across.abs(), "{errors:?} {across} {resonance}");
    }
}

#[test]
fn what_has_no_such_posture_is_refused_by_name() {
    let (ball, disk) = (Body::ball(0.0, 0.4, 0.4).unwrap(), Body::solid(0.0).unwrap());
    let heavy = Body::ball(-0.2, 0.4, 0.4).unwrap();
    let told = |found: Result<f64, spincyl::Error>| found.unwrap_err().to_string();
    assert!(told(tip_slope(&ball, 0.0, Posture::Standing, 0.0)).starts_with("a = "));
    assert!(told(slip_slope(&ball, 0.0, -0.1, Posture::Rolling, 0.0)).starts_with("mu = "));
    assert!(told(slip_slope(&disk, SIDE, 0.3, Posture::Rolling, 0.0)).starts_with("phi = "));
    assert!(told(slip_slope(&heavy, SIDE, 0.3, Posture::Rolling, ACROSS)).starts_with("ell = "));
    assert_eq!(tip_slope(&disk, SIDE, Posture::Rolling, ACROSS).unwrap(), FRAC_PI_2);
    assert_eq!(slip_slope(&Body::solid(1.0).unwrap(), SIDE, 0.0, Posture::Lying, 0.3).unwrap(), 0.0);
}

#[test]
fn a_body_on_its_face_tips_over_where_its_share_says_with_rolling_resistance_as_well() {
    let body = Body::solid(2.0).unwrap();
    for arm in [0.0, 0.1] {
        let losses = Losses::of(Law::RollingResistance, arm);
        let limit = 0.5 * (1.0 + arm);
        for (share, holds) in [(1.0 - 1e-9, true), (1.0 + 1e-9, false)] {
            let slope = (share * limit).atan();
            let SlopeShares { tipping: tips, .. } =
                shares(&body, 0.0, 0.9, &losses, Posture::Standing, Incline::new(slope, 0.0)).unwrap();
            assert!((tips / share - 1.0).abs() < 1e-14, "{arm} {tips}");
            assert_eq!(stays(&body, 0.0, 0.9, losses, slope, 0.0), holds, "{arm} {share}");
        }
    }
}
