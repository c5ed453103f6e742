//! Guards of speed: the cost of a motion in evaluations of its equations, which is the same on every machine.

use crate::common::larger;
use spincyl::contact::{Friction, Table};
use spincyl::loss::{Law, Losses};
use spincyl::motion::{AboveTable, Ask, Ending, Method, Motion, Start, roll_with};
use spincyl::{Body, Slip, State, steady};

const TOLERANCES: [f64; 3] = [1e-6, 1e-8, 1e-10];

fn followed(body: &Body, start: Start, until: f64, ask: Ask, tol: f64) -> Motion {
    let ask = ask.with_method(Method::Tolerance(tol));
    roll_with(body, start, &[until], &ask, || true).unwrap().unwrap()
}

/// Checks that the motion of Euler's disk from 0.3 rad, with a nutation, to its end or to t = 60, needs at most
/// `most` evaluations at each of three tolerances.
fn whirrs(losses: Losses, ending: Ending, most: [u64; 3]) {
    let body = Body::solid(0.0128 / 0.0751).unwrap();
    let start = steady::state(&body, 0.3).unwrap().kicked(0.05);
    for (tol, most) in TOLERANCES.into_iter().zip(most) {
        let m = followed(&body, start.into(), 60.0, Ask::default().with_losses(losses), tol);
        assert_eq!(m.ending(), ending, "{losses:?} {tol:e}");
        assert!(m.evaluations <= most, "{losses:?} {tol:e}: {} evaluations, {most} allowed", m.evaluations);
    }
}

#[test]
fn a_whirr_costs_what_its_turns_cost_under_every_law() {
    // The precession is 110 to 130 rad, 250 under rolling resistance, and 570 in air, where the whirr does
    // not end.
    let of = Losses::of;
    whirrs(of(Law::DryContour, 3.4e-3), Ending::Face, [1_500, 2_400, 3_500]);
    whirrs(of(Law::ViscousContour, 7.5e-4), Ending::Face, [1_600, 2_800, 4_500]);
    whirrs(of(Law::RollingResistance, 2.4e-2), Ending::Face, [6_200, 10_500, 17_500]);
    whirrs(of(Law::Drilling, 7.9e-2), Ending::Done, [2_900, 4_500, 7_300]);
    whirrs(of(Law::AirLinear, 3.5e-2), Ending::Done, [17_500, 25_000, 39_000]);
    whirrs(of(Law::AirQuadratic, 6e-2), Ending::Done, [8_800, 13_500, 20_500]);
    whirrs(of(Law::AirFilm, 1.9e-4), Ending::Face, [1_500, 2_500, 4_500]);
    whirrs(of(Law::BoundaryLayer, 3.6e-4), Ending::Face, [3_700, 3_800, 5_400]);
}

#[test]
fn laws_together_cost_little_more_than_each_of_them() {
    let of = Losses::of;
    let film = of(Law::DryContour, 1.7e-3) + of(Law::AirFilm, 9.6e-5);
    whirrs(film, Ending::Face, [1_700, 2_600, 4_200]);
    let air = of(Law::RollingResistance, 1.2e-2) + of(Law::AirQuadratic, 3e-2);
    whirrs(air, Ending::Face, [12_500, 20_500, 33_000]);
    let three = of(Law::ViscousContour, 3e-4) + of(Law::Drilling, 2.4e-2) + of(Law::BoundaryLayer, 1.1e-4);
    whirrs(three, Ending::Face, [4_400, 5_200, 7_900]);
}

#[test]
fn a_launch_costs_some_thousand_evaluations_until_it_rolls() {
    let body = Body::tube(6.0, 0.8).unwrap();
    for (w1, launch, mu) in [(3.1, 1.1, 0.15), (3.5, 1.3, 0.2), (3.9, 1.55, 0.3)] {
        let w3 = launch * body.ell() / (body.i3() * w1);
        let state = State { theta: core::f64::consts::FRAC_PI_2, w1, w2: 0.0, w3 };
        let slip = [0.0, (body.ell() - body.i1() / body.ell()) * w1 - w3];
        for (tol, most) in TOLERANCES.into_iter().zip([3_000, 4_700, 7_200]) {
            let ask = Ask::on(Table::Rubs(Friction::coulomb(mu))).with_stop_at_rolling();
            let m = followed(&body, Start::from(state).with_slip(slip.into()), 200.0, ask, tol);
            assert!(m.evaluations <= most, "{w1} {tol:e}: {} evaluations, {most} allowed", m.evaluations);
        }
    }
}

#[test]
fn a_slow_slip_ends_at_the_cost_of_its_series() {
    // One hump of slip of 2.4e-3, 0.88 long; its direction settles a thousand times faster towards its end.
    let body = Body::solid(2.8826913698643453).unwrap();
    let state = State {
        theta: 1.1387317733850224,
        w1: 7.017679607202668,
        w2: 0.00011351795087978822,
        w3: 20.219714727325478,
    };
    let ask = Ask::on(Table::Rubs(Friction::coulomb(0.07922078990612345)))
        .with_losses(Losses::of(Law::AirFilm, 0.0012744823480859051))
        .with_restitution(0.0);
    for (tol, most) in [(1e-6, 2_000), (1e-8, 2_000), (1e-10, 2_000), (1e-12, 2_000), (1e-14, 2_800)] {
        let m = followed(&body, state.into(), 0.889, ask, tol);
        assert!(m.evaluations <= most, "{tol:e}: {} evaluations, {most} allowed", m.evaluations);
    }
}

/// The motion of a dropped coin, up to the time `until`.
fn dropped_coin(ell: f64, numbers: [f64; 8], (mu, losses): (f64, Losses), until: f64, tol: f64) -> Motion {
    let [theta, w1, w2, w3, u_h, u_2, height, lift] = numbers;
    let start = Start::from(State { theta, w1, w2, w3 })
        .with_slip(Slip::new(u_h, u_2))
        .with_aloft(AboveTable::new(height, lift));
    let ask = Ask::on(Table::Rubs(Friction::coulomb(mu))).with_losses(losses).with_restitution(0.0);
    followed(&Body::solid(ell).unwrap(), start, until, ask, tol)
}

#[test]
fn a_coin_that_slips_in_each_nod_pays_for_its_slips_and_not_for_their_ends() {
    // 34 slips from rest, and as many ends, at which the direction of the slip returns to its place all the faster.
    let numbers = [
        1.992543184724132,
        3.521713218355622,
        -2.4451491867464137,
        0.8591135756172896,
        1.9806601656277416,
        0.021314728971615904,
        0.40467743338045625,
        1.5586571184300129,
    ];
    let air = Losses::of(Law::AirLinear, 0.06196369196175483);
    for (tol, most) in TOLERANCES.into_iter().zip([26_000, 33_000, 38_000]) {
        let m = dropped_coin(0.25, numbers, (0.2076507987360205, air), 30.0, tol);
        assert!(m.ending() == Ending::Done && m.path.as_ref().unwrap().phases.len() > 60);
        assert!(m.evaluations <= most, "{tol:e}: {} evaluations, {most} allowed", m.evaluations);
    }
}

#[test]
fn the_last_turns_of_a_coin_that_slips_in_each_nod_cost_nothing() {
    // Each nod is a smaller copy of the one before. Followed down to 1e-13 rad it took 261,000 evaluations.
    let numbers = [
        1.0709118431069615,
        0.33929039725704896,
        1.3763596088124486,
        4.714315280108572,
        -1.2642857024796004,
        -4.68533988018282,
        0.9011232631555055,
        0.5565638758986768,
    ];
    let resisted = Losses::of(Law::RollingResistance, 0.021441168831361955);
    let [rough, fine] = [(1e-8, 190_000), (1e-10, 250_000)].map(|(tol, most)| {
        let m = dropped_coin(0.0854, numbers, (0.1955432485861743, resisted), 60.0, tol);
        assert!(m.evaluations <= most, "{tol:e}: {} evaluations, {most} allowed", m.evaluations);
        m
    });
    lands_within_claims(&rough, &fine, 1e-3);
}

#[test]
fn a_coin_in_air_that_slips_in_each_nod_comes_down_to_its_face() {
    // Its slips, a thousand for each factor of ten in the time that is left, take what the air does not: it was given up
    // after 5,000 phases.
    let numbers = [
        0.7567418184763905,
        -1.4593905363664987,
        1.1284788663360616,
        1.972999772221359,
        -0.993870156083793,
        -2.3627193241628692,
        1.0477455556517266,
        0.6135957148583386,
    ];
    // At 1e-8 roundings decide whether the last nods tell how it ends.
    let air = Losses::of(Law::AirLinear, 0.01);
    let [rough, fine] = [1e-9, 1e-10]
        .map(|tol| dropped_coin(0.26704267447958785, numbers, (0.34384162495140747, air), 200.0, tol));
    lands_within_claims(&rough, &fine, 0.06);
}

/// Checks that a motion and one with a smaller tolerance end at rest with the face on the table, at times that differ
/// by at most the estimated errors.
fn lands_within_claims(rough: &Motion, fine: &Motion, most: f64) {
    let [a, b] = [rough, fine].map(|m| m.event.unwrap());
    assert!(a.ending == Ending::Stops && b.ending == Ending::Stops, "{:?} {:?}", a.ending, b.ending);
    let apart = (a.time - b.time).abs();
    assert!(apart < rough.error + fine.error && rough.error < most, "{apart:e} {:e}", rough.error);
    assert!(a.state == State { theta: a.state.theta.round(), w1: 0.0, w2: 0.0, w3: 0.0 }, "{:?}", a.state);
}

#[test]
fn a_coin_leaves_the_table_where_its_normal_force_has_just_vanished() {
    // Its force is negative by 1e-11 where the steps have found its zero, and the height of its rim grows as t^3.
    let numbers = [
        1.9312668005842295,
        0.5319440984379437,
        -0.7712341902620314,
        -4.757135654599359,
        0.6984367512376586,
        4.802563680605959,
        3.0928595794176887,
        0.33365591286429136,
    ];
    let at = |tol: f64| dropped_coin(0.0854, numbers, (0.4051780332484533, Losses::NONE), 4.7, tol);
    let (coarse, fine) = (at(1e-8), at(1e-11));
    assert_eq!([coarse.ending(), fine.ending()], [Ending::Done; 2]);
    let [a, b] = [&coarse, &fine].map(|m| <[f64; 4]>::from(m.states[0]));
    let off = a.iter().zip(b).fold(0.0, |most: f64, (a, b)| larger(most, (a - b).abs()));
    assert!(off <= coarse.error + fine.error, "{off:e} {:e}", coarse.error);
}

#[test]
fn a_uniform_ball_is_never_integrated() {
    let ball = Body::ball(0.0, 0.4, 0.4).unwrap();
    let state = State { theta: 1.1, w1: 2.0, w2: -1.0, w3: 3.0 };
    let slips = Start::from(state).with_slip(Slip::new(1.3, -0.4));
    let ask = Ask::on(Table::Rubs(Friction::coulomb(0.2)));
    for tol in TOLERANCES {
        for start in [slips, Start::from(state)] {
            assert_eq!(followed(&ball, start, 60.0, ask, tol).evaluations, 0);
        }
        for e in [0.0, 0.5, 0.9] {
            let m = followed(
                &ball,
                slips.with_aloft(AboveTable::new(1.0, 0.3)),
                60.0,
                ask.with_restitution(e),
                tol,
            );
            assert_eq!((m.evaluations, m.ending()), (0, Ending::Done));
        }
    }
}

/// The motion of a uniform ball on a patch of contact that slips, spins, and drills for a long time.
fn ball_on_a_patch(resistance: f64, until: f64, tol: f64) -> Motion {
    let ball = Body::ball(0.0, 0.4, 0.4).unwrap();
    let state = State { theta: 1.0, w1: -2.0, w2: 1.0, w3: 3.0 };
    let friction = Friction::Coulomb { mu: 0.2, fixed: 0.2, patch: 1e-3 };
    let ask = Ask::on(friction).with_losses(Losses::of(Law::RollingResistance, resistance));
    followed(&ball, Start::from(state).with_slip(Slip::new(2.0, 2.0)), until, ask, tol)
}

#[test]
fn a_uniform_ball_whose_slip_has_died_on_a_patch_costs_nothing_and_its_drilling_falls_evenly() {
    let drilling = |m: &Motion| {
        let y = m.states.last().unwrap();
        y.theta.sin() * y.w1 + y.theta.cos() * y.w3
    };
    for tol in TOLERANCES {
        // It drills until t = 210 or so, and rolls on.
        let [early, late, last] = [20.0, 150.0, 400.0].map(|until| ball_on_a_patch(0.0, until, tol));
        assert_eq!([late.evaluations, last.evaluations], [early.evaluations; 2]);
        assert_eq!(late.path.as_ref().unwrap().slip[0], Slip::default());
        assert!(drilling(&last).abs() < 1e-15);
        // Its energy, that of a ball without a slip, becomes heat.
        let whole = |m: &Motion| {
            let y = m.states.last().unwrap();
            let rolling = y.theta.cos() * y.w1 - y.theta.sin() * y.w3;
            let turning = 0.4 * (y.w1 * y.w1 + y.w2 * y.w2 + y.w3 * y.w3);
            0.5 * (turning + rolling * rolling + y.w2 * y.w2) + m.path.as_ref().unwrap().heat
        };
        for m in [&late, &last] {
            let gained = whole(m) - whole(&early);
            assert!(gained.abs() < 1e-13, "{tol:e}: {gained:e}");
        }
        let falls = (drilling(&early) - drilling(&late)) / 130.0;
        let couple = 3.0 * core::f64::consts::PI / 16.0 * 0.2 * 1e-3;
        assert!((falls.abs() - couple / 0.4).abs() < 1e-14, "{tol:e}: {falls}");
    }
}

#[test]
fn a_uniform_ball_that_rolls_under_dry_friction_costs_nothing_and_stops_when_its_couples_say() {
    let inertia = 0.4;
    let ball = Body::ball(0.0, inertia, inertia).unwrap();
    let start = State { theta: 1.0, w1: -2.0, w2: 1.0, w3: 3.0 };
    let (sin, cos) = start.theta.sin_cos();
    let rolling = (cos * start.w1 - sin * start.w3).hypot(start.w2);
    let drilling = sin * start.w1 + cos * start.w3;
    let energy = 0.5 * ((1.0 + inertia) * rolling * rolling + inertia * drilling * drilling);
    let (arm, length) = (2e-2, 5e-4);
    let ends = [(1.0 + inertia) * rolling / arm, inertia * drilling.abs() / length];
    let losses = Losses::of(Law::RollingResistance, arm) + Losses::of(Law::Drilling, length);
    for table in [Table::Rolling { mu: f64::INFINITY }, Friction::coulomb(0.3).into()] {
        let ask = Ask::on(table).with_losses(losses);
        let m = followed(&ball, start.into(), 1e4, ask, 1e-10);
        let event = m.event.unwrap();
        assert_eq!((m.evaluations, event.ending), (0, Ending::Stops), "{table:?}");
        let late = (event.time - ends[0].max(ends[1])).abs();
        assert!(late <= m.error && m.error < 1e-8, "{late:e} {:e}", m.error);
        let lost = m.path.as_ref().unwrap().lost;
        assert!((lost - energy).abs() < 1e-13 * energy, "{lost} {energy}");
        // With poses the same ball is integrated.
        let times = [0.7, 30.0, 0.5 * (ends[0] + ends[1]), ends[0] - 1.0];
        let [known, stepped] = [false, true].map(|pose| {
            let mut ask = ask.with_method(Method::Tolerance(1e-12));
            ask.pose = pose;
            roll_with(&ball, start, &times, &ask, || true).unwrap().unwrap()
        });
        assert!(stepped.evaluations > 1000);
        for (a, b) in known.states.iter().zip(&stepped.states) {
            let off = [a.theta - b.theta, a.w1 - b.w1, a.w2 - b.w2, a.w3 - b.w3];
            let off = off.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            assert!(off <= known.error + stepped.error && off < 1e-8, "{off:e} {:e}", stepped.error);
        }
    }
}

#[test]
fn the_pose_of_a_ball_whose_slip_has_died_on_a_patch_costs_what_its_turns_cost() {
    // It turns by 4.8 rad in a unit of time. Its slip follows the turning 500 times faster.
    let ball = Body::ball(0.0, 0.4, 0.4).unwrap();
    let state = State { theta: 1.0, w1: -2.0, w2: 1.0, w3: 3.0 };
    let friction = Friction::Coulomb { mu: 0.2, fixed: 0.2, patch: 1e-3 };
    let start = Start::from(state).with_slip(Slip::new(2.0, 2.0));
    let ask = Ask::on(friction).with_pose();
    let [early, late] = [20.0, 40.0].map(|until| followed(&ball, start, until, ask, 1e-6));
    let each = (late.evaluations - early.evaluations) / 20;
    assert!(each <= 330, "{each} evaluations in a unit of time");
}

#[test]
fn a_disk_on_a_small_patch_that_presses_hard_takes_steps_of_its_motion_also_between_outputs() {
    let body = Body::solid(0.0).unwrap();
    let state = State { theta: 1.8250976949901818, w1: 1.0154282256931457, w2: -0.6150799567948172, w3: 0.0 };
    let start = Start::from(state).with_slip(Slip::new(0.3437367584381417, 0.7428832432326301));
    let friction = Friction::Coulomb { mu: 0.7, fixed: 0.7, patch: 1.2643284759524459e-4 };
    let times: Vec<f64> = (0..=100).map(|i| 0.1 * f64::from(i)).collect();
    let rolled = |tol: f64| {
        let ask = Ask::on(friction).with_method(Method::Tolerance(tol));
        roll_with(&body, start, &times, &ask, || true).unwrap().unwrap()
    };
    let fine = rolled(1e-13);
    for (tol, most) in TOLERANCES.into_iter().zip([8_500, 11_500, 17_000]) {
        let m = rolled(tol);
        assert!(m.evaluations <= most, "{tol:e}: {} evaluations, {most} allowed", m.evaluations);
        assert!(m.error < 1e3 * tol, "{tol:e}: {:e}", m.error);
        for (one, other) in m.states.iter().zip(&fine.states) {
            let off = [one.theta - other.theta, one.w1 - other.w1, one.w2 - other.w2, one.w3 - other.w3];
            assert!(off.iter().all(|x| x.abs() <= m.error + fine.error), "{tol:e}: {off:?}, {:e}", m.error);
        }
    }
}

#[test]
fn a_billiard_ball_costs_nothing_once_it_creeps_and_little_until_it_stands() {
    for (tol, most) in TOLERANCES.into_iter().zip([5_000, 8_000, 12_000]) {
        let [early, late] = [60.0, 200.0].map(|until| ball_on_a_patch(3e-4, until, tol));
        assert_eq!(early.evaluations, late.evaluations, "{tol:e}");
        let [stands, known] = [tol, 1e-12].map(|tol| ball_on_a_patch(1e-2, 1000.0, tol));
        for m in [&late, &stands] {
            assert!(m.evaluations <= most, "{tol:e}: {} evaluations, {most} allowed", m.evaluations);
        }
        let [at, truly] = [&stands, &known].map(|m| m.event.unwrap());
        assert_eq!([at.ending, truly.ending], [Ending::Stops; 2]);
        let late = (at.time - truly.time).abs();
        assert!(
            late <= stands.error + known.error && late < 1e3 * tol,
            "{tol:e}: {late:e} {:e}",
            stands.error
        );
    }
}

#[test]
fn an_output_more_changes_nothing_in_the_others_and_no_count_of_outputs_is_too_long_to_be_interrupted() {
    let body = Body::solid(2.5).unwrap();
    let start = steady::state(&body, 1.3).unwrap().kicked(0.05);
    let all: Vec<f64> = (0..=1 << 16).map(|i| 3e-4 * f64::from(i)).collect();
    let ask = Ask::default().with_pose();
    let rolled = |times: &[f64]| {
        let mut looks = 0;
        let go_on = || {
            looks += 1;
            true
        };
        let m = roll_with(&body, start, times, &ask, go_on).unwrap().unwrap();
        (m, looks)
    };
    let (whole, looks) = rolled(&all);
    assert!((3..30).contains(&looks), "{looks}");
    // The method does not change with the number of outputs, and so neither do the last digits.
    for count in [1 << 16, 20_000, 100] {
        let (part, _) = rolled(&all[..count]);
        assert_eq!(part.states, whole.states[..count]);
        assert_eq!(part.poses.unwrap(), whole.poses.as_ref().unwrap()[..count]);
        assert!(part.error <= whole.error && whole.error < 1e-12);
    }
}
