//! Bodies that come to rest, or leave an unstable rest: how the motion ends, and its estimated errors.

use crate::losses::ROLLS;
use core::f64::consts::FRAC_PI_2;
use spincyl::contact::{Friction, Table};
use spincyl::loss::{Law, Losses};
use spincyl::motion::{Ask, Ending, Method, Start, roll_with};
use spincyl::{Body, Slip, State, steady};

#[test]
fn a_ball_that_drills_on_while_resistance_holds_its_rolling_stops_whatever_the_tolerance() {
    // found by a random test: unequal moments drive the rolling that resistance stops, which no step resolved
    let body = Body::rounded(0.0, 0.1, 0.005, 1.0).unwrap();
    let start = State { theta: 1.0009553921895131, w1: 0.38977109408965055, w2: 0.0, w3: 0.0 };
    let found = [1e-6, 1e-8, 1e-10, 1e-12, 1e-14].map(|tol| {
        let method = Method::Tolerance(tol);
        let ask =
            Ask::on(Table::Smooth).with_method(method).with_losses(Losses::of(Law::RollingResistance, 0.1));
        roll_with(&body, start, &[0.0, 10.0], &ask, || true).unwrap().unwrap()
    });
    let last = found[4].states[1];
    for motion in &found {
        let (y, within) = (motion.states[1], motion.error + 1e-12);
        assert!(motion.error < 1e-4 && motion.event.is_none(), "{:?}", motion.event);
        let apart = [y.theta - last.theta, y.w1 - last.w1];
        assert!(apart.into_iter().all(|x| x.abs() < within), "{y:?}");
        // Rolling resistance does not stop the spin about the vertical.
        let (s, c) = y.theta.sin_cos();
        assert!((s * y.w1 + c * y.w3 - 0.4537).abs() < 1e-2, "{y:?}");
        assert_eq!(y.w2, 0.0);
        assert!((c * y.w1 - s * y.w3).abs() < 1e-13);
    }
}

/// A uniform ball with any axis as e3 rolls for the time v/((5/7) k g), and then spins about the vertical.
#[test]
fn a_uniform_ball_rolls_out_and_spins_on_whatever_axis_is_called_its_own() {
    let ball = Body::rounded(0.0, 0.4, 0.4, 1.0).unwrap();
    let ask = Ask::on(ROLLS).with_losses(Losses::of(Law::RollingResistance, 0.01));
    for theta in [0.001, 0.5, FRAC_PI_2, 2.9] {
        for (speed, spin) in [(0.0, 2.7), (0.19, 5.4), (0.02, 1e-3)] {
            let (s, c) = theta.sin_cos();
            let start = State { theta, w1: spin * s - speed * c, w2: 0.0, w3: spin * c + speed * s };
            let rolls = 1.4 * speed / 0.01;
            let times = [0.0, (rolls - 1e-3).max(0.0), rolls + 1e-8, 100.0];
            let motion = roll_with(&ball, start, &times, &ask, || true).unwrap().unwrap();
            assert!(motion.event.is_none(), "{theta}: {:?}", motion.event);
            for (y, left) in motion.states.iter().zip([rolls, rolls.min(1e-3), 0.0, 0.0]) {
                let (s, c) = y.theta.sin_cos();
                let rolling = (c * y.w1 - s * y.w3).hypot(y.w2);
                assert!((rolling - left * 0.01 / 1.4).abs() < 1e-10, "{theta}: {rolling} {left}");
                assert!((s * y.w1 + c * y.w3 - spin).abs() < 1e-9, "{theta}: {y:?}");
            }
        }
    }
}

#[test]
fn a_weighted_ball_that_rolling_resistance_holds_stays_at_rest_on_a_table_with_friction() {
    let ball = Body::rounded(0.1, 0.3818, 0.3818, 1.0).unwrap();
    let start = State { theta: 0.42471, w1: 0.0, w2: 0.0, w3: 0.0 };
    // The weight pulls with the couple 0.1 sin(theta); the coefficients are above and below that.
    for (k, stays) in [(0.454, true), (0.0413, true), (0.0411, false), (0.0, false)] {
        let losses = Losses::of(Law::RollingResistance, k);
        let ask = Ask::on(Friction::coulomb(0.247)).with_losses(losses);
        let motion = roll_with(&ball, start, &[0.0, 1.0], &ask, || true).unwrap().unwrap();
        let event = motion.event.map(|event| (event.ending, event.time, event.state));
        let rest = Some((Ending::Stops, 0.0, start));
        assert!((event == rest) == stays && motion.event.is_none() != stays, "{k}: {event:?}");
    }
}

#[test]
fn a_weighted_ball_that_is_let_go_rocks_to_rest_and_stays_there() {
    // the time and place of the stop by a separate planar model, integrated by SciPy at 1e-12
    let ball = Body::rounded(-0.3, 0.5, 0.3, 1.0).unwrap();
    let start = State { theta: 1.0, w1: 0.0, w2: 0.0, w3: 0.0 };
    let friction = Table::Rubs(Friction::coulomb(0.3));
    for table in [ROLLS, friction] {
        let ask = Ask::on(table).with_losses(Losses::of(Law::RollingResistance, 0.027));
        let motion = roll_with(&ball, start, &[0.0, 40.0], &ask, || true).unwrap().unwrap();
        let event = motion.event.unwrap();
        assert_eq!(event.ending, Ending::Stops);
        assert!(
            (event.time - 29.9279414).abs() < 1e-7 && (event.state.theta - 0.0374676).abs() < 1e-7,
            "{event:?}"
        );
    }
}

#[test]
fn a_disk_on_its_edge_that_spins_about_the_vertical_does_not_roll() {
    let (disk, ask) =
        (Body::solid(0.0).unwrap(), Ask::on(ROLLS).with_losses(Losses::of(Law::RollingResistance, 0.005)));
    for (w1, w2) in [(1.0, 0.0), (2.0, 0.0), (2.0, 1e-6)] {
        for time in [1.0, 10.0] {
            let start = State { theta: FRAC_PI_2, w1, w2, w3: 0.0 };
            // Rolling resistance takes delta/J from the rocking in a unit of time, J = 5/4.
            let times = [0.0, w2 * 125.0, w2 * 250.0 + 1e-9, time];
            let motion = roll_with(&disk, start, &times, &ask, || true).unwrap().unwrap();
            assert!(motion.event.is_none(), "{:?}", motion.event);
            let rocks: Vec<f64> = motion.states.iter().map(|y| y.w2).collect();
            assert!((rocks[1] - 0.5 * w2).abs() < 1e-11 && rocks[2..] == [0.0; 2], "{rocks:?}");
            assert!((motion.states[3].w1 - w1).abs() < 1e-9);
        }
    }
}

#[test]
fn a_disk_all_but_on_its_edge_falls_as_it_claims_whatever_the_tolerance() {
    // theta at t = 17 by a separate model in 80 bits; the start is unstable, and its errors grow a
    // billionfold
    let disk = Body::solid(0.0).unwrap();
    let scenes = [
        (0.15531088651889635, -1.5606182395595831, 8.199832e-10, 1.5631342956508019),
        (0.15, -1.5, 1e-9, 1.5342926672196895),
    ];
    for (c, w1, lean, theta) in scenes {
        let state = State { theta: FRAC_PI_2 - lean, w1, w2: 0.0, w3: 0.0 };
        let start = Start::from(state);
        for tol in [1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14] {
            let table = Table::Rubs(Friction::Viscous { c });
            let ask = Ask::on(table).with_method(Method::Tolerance(tol));
            let motion = roll_with(&disk, start, &[17.0], &ask, || true).unwrap().unwrap();
            let off = (motion.states[0].theta - theta).abs();
            assert!(off < 5.0 * motion.error, "tol {tol:e}: off by {off:e}, claims {:e}", motion.error);
            assert!(motion.error < 100.0 * tol + 1e-5, "tol {tol:e}: claims {:e}", motion.error);
        }
    }
}

#[test]
fn a_slipping_ball_whose_rolling_resistance_stops_slides_on_as_one_block_whatever_the_tolerance() {
    let ball = Body::rounded(1.0, 1.4, 0.4, 1.0).unwrap().with_theta_end(FRAC_PI_2).unwrap();
    let state = State {
        theta: 1.1962863847128117e-06,
        w1: 0.0009027897288945871,
        w2: -4.571949401105849e-06,
        w3: -0.021841463555552536,
    };
    let start = Start::from(state).with_slip(Slip::new(-0.8788704590281213, 0.0));
    let losses = Losses::of(Law::RollingResistance, 0.08469917537452804)
        + Losses::of(Law::Drilling, 0.031018461102858726);
    let table = Table::Rubs(Friction::coulomb(0.0010786595683881079));
    let found = [1e-8, 1e-10, 1e-11, 1e-12, 1e-13, 3e-14, 1e-14].map(|tol| {
        let ask = Ask::on(table).with_method(Method::Tolerance(tol)).with_losses(losses);
        let motion = roll_with(&ball, start, &[0.0, 1.0], &ask, || true).unwrap().unwrap();
        assert!(motion.event.is_none(), "{:?}", motion.event);
        motion
    });
    for (i, a) in found.iter().enumerate() {
        for b in &found[..i] {
            let (one, other, both) = (a.states[1], b.states[1], a.error + b.error);
            assert!(
                one.w2 == 0.0 && (one.theta - other.theta).abs() < 2.0 * both,
                "{one:?}, {other:?}: {both:e}"
            );
            assert!((one.w3 - other.w3).abs() < 2.0 * both, "{one:?}, {other:?}: {both:e}");
        }
    }
    assert!(found[6].error < 1e-10);
}

#[test]
fn a_face_that_only_comes_nearer_takes_as_long_to_each_inclination_as_its_exponential_says() {
    // rolling resistance and air leave w2 ~ s at the end: theta falls by e in the constant time theta/w2
    let disk = Body::solid(0.0128 / 0.0751).unwrap();
    let start = steady::state(&disk, 0.3).unwrap().kicked(0.05);
    let losses = Losses::of(Law::RollingResistance, 0.0119) + Losses::of(Law::AirQuadratic, 0.0298);
    let at = |times: &[f64]| {
        let ask = Ask::default().with_method(Method::Tolerance(1e-10)).with_losses(losses);
        roll_with(&disk, start, times, &ask, || true).unwrap().unwrap()
    };
    let end = at(&[0.0, 100.0]).event.unwrap();
    assert_eq!(end.ending, Ending::Face);
    // The integration ends at 1e-10 rad, and the face counts as landed ten of these times after 1e-12 rad.
    let time = 1e-10 / end.state.w2;
    for theta in [2e-10f64, 3e-10] {
        let left = time * ((theta / 1e-12).ln() + 10.0);
        let there = at(&[0.0, end.time - left]).states[1].theta;
        assert!((there / theta - 1.0).abs() < 0.1, "{there:e} for {theta:e}");
    }
}
