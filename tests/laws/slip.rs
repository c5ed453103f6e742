//! Friction: laws that hold in every state, exact motions, and many slips side by side.

use crate::common::many::with_summaries;
use crate::common::{larger, path_of};
use proptest::prelude::*;
use spincyl::contact::{self, Friction, TableKind, slip};
use spincyl::ensemble::{BodyColumns, Job, MotionOutput, MotionStarts, SUMMARIES, Summary, roll};
use spincyl::loss::Losses;
use spincyl::motion::path::Kind;
use spincyl::motion::{Ask, Ending, Method, Start, roll_with};
use spincyl::{Body, Contact, Error, Slip, State, smooth};
use std::f64::consts::FRAC_PI_2;

fn bodies() -> impl Strategy<Value = Body> {
    prop_oneof![
        (0.0..4.0f64, 0.0..1.0f64).prop_map(|(ell, bore)| Body::tube(ell, bore).unwrap()),
        (0.1..2.0f64, 0.02..0.1f64)
            .prop_map(|(half, fillet)| { Body::rounded_tube(half, 0.0, fillet.min(half)).unwrap() }),
        (-0.4..0.4f64, 0.3..0.5f64).prop_map(|(low, i1)| Body::ball(low, i1, 1.05 * i1).unwrap()),
    ]
}

fn states() -> impl Strategy<Value = (State, [f64; 2])> {
    let speed = || -3.0..3.0f64;
    (0.2..1.5f64, speed(), speed(), speed(), speed(), speed())
        .prop_map(|(theta, w1, w2, w3, along, across)| (State { theta, w1, w2, w3 }, [along, across]))
}

fn frictions() -> impl Strategy<Value = Friction> {
    prop_oneof![
        (0.0..0.6f64).prop_map(Friction::coulomb),
        (0.0..0.3f64).prop_map(|c| Friction::Viscous { c }),
    ]
}

/// Radius A, depth L, lever g, its slope g', and the height of the centre, written independently of the library.
fn shape(body: &Body, theta: f64) -> [f64; 5] {
    let (s, c) = theta.sin_cos();
    let (ell, rho) = (body.ell(), body.fillet());
    let a = 1.0 - rho;
    [a + rho * s, ell + rho * c, ell * s - a * c, ell * c + a * s, ell * c + a * s + rho]
}

proptest! {
    #![proptest_config(crate::common::cases(256))]

    #[test]
    fn the_centre_and_the_angular_momenta_obey_newton(
        body in bodies(), (y, u) in states(), friction in frictions(),
    ) {
        let (dy, du, f) = slip::derivative(&body, &y, u.into(), &friction, &Losses::NONE);
        let [radius, depth, g, slope, height] = shape(&body, y.theta);
        let ((s, c), rho) = (y.theta.sin_cos(), body.fillet());
        let scale = 1.0 + [dy.w1, dy.w2, dy.w3, du.u_h, du.u_2, f.normal]
            .iter().fold(0f64, |most, x| most.max(x.abs())) * (1.0 + depth.abs() + y.w1.abs());
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-13 * scale * scale;
        // v_h = u_h + h w2, v_2 = u_2 - L w1 + A w3, v_z = g w2, along axes that turn with phi'
        let turn = y.w1 / s;
        let (v_h, v_2) = (u[0] + height * y.w2, u[1] - depth * y.w1 + radius * y.w3);
        let v_h_rate = du.u_h + g * y.w2 * y.w2 + height * dy.w2;
        let v_2_rate = du.u_2 - depth * dy.w1 - rho * s * y.w2 * y.w1 + radius * dy.w3 - rho * c * y.w2 * y.w3;
        prop_assert!(near(v_h_rate - turn * v_2, f.across), "{} {}", v_h_rate - turn * v_2, f.across);
        prop_assert!(near(v_2_rate + turn * v_h, f.along), "{} {}", v_2_rate + turn * v_h, f.along);
        prop_assert!(near(1.0 + g * dy.w2 - slope * y.w2 * y.w2, f.normal));
        // the angular momenta about the vertical and about the axis of symmetry
        let vertical = body.i1() * (dy.w1 * s - y.w1 * c * y.w2) + body.i3() * (dy.w3 * c + y.w3 * s * y.w2);
        prop_assert!(near(vertical, g * f.along), "{vertical} {}", g * f.along);
        prop_assert!(near(body.i3() * dy.w3, -radius * f.along));
        // the law of friction
        let size = u[0].hypot(u[1]);
        let pull = match friction {
            Friction::Coulomb { mu, .. } => mu * f.normal / size,
            Friction::Viscous { c } => c * f.normal,
            _ => unreachable!(),
        };
        prop_assert!(near(f.across, -pull * u[0]) && near(f.along, -pull * u[1]));
    }

    #[test]
    fn friction_takes_from_the_energy_what_it_pulls(body in bodies(), (y, u) in states(), friction in frictions()) {
        let (dy, du, f) = slip::derivative(&body, &y, u.into(), &friction, &Losses::NONE);
        let at = |t: f64| {
            let moved = State {
                theta: y.theta + t * dy.theta, w1: y.w1 + t * dy.w1, w2: y.w2 + t * dy.w2, w3: y.w3 + t * dy.w3,
            };
            slip::energy(&body, &moved, Slip::new(u[0] + t * du.u_h, u[1] + t * du.u_2))
        };
        let fastest = [dy.w1, dy.w2, dy.w3, du.u_h, du.u_2].iter().fold(1f64, |most, x| most.max(x.abs()));
        let h = 1e-4 / fastest;
        let power = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
        let pulled = f.across * u[0] + f.along * u[1];
        prop_assert!((power - pulled).abs() <= 1e-7 * (1.0 + pulled.abs()) * fastest, "{power} {pulled}");
    }

    #[test]
    fn without_friction_the_table_is_smooth(body in bodies(), (y, u) in states()) {
        let (found, ..) = slip::derivative(&body, &y, u.into(), &Friction::coulomb(0.0), &Losses::NONE);
        let smooth = smooth::derivative(&body, &y);
        let (a, b): ([f64; 4], [f64; 4]) = (found.into(), smooth.into());
        let scale = b.iter().fold(1f64, |most, x| most.max(x.abs()));
        prop_assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-13 * scale), "{a:?} {b:?}");
    }

    #[test]
    fn a_hoop_slides_rolls_and_returns_as_the_closed_form_says(
        v in 0.1..4.0f64, back in 0.0..4.0f64, mu in 0.5..1.5f64, bore in 0.0..1.0f64,
    ) {
        // a hoop that turns slowly is unstable, so that these motions are short
        let hoop = Body::tube(0.0, bore).unwrap();
        let i3 = hoop.i3();
        let start = State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3: -back };
        let grip = (v + back) / (mu * (1.0 + 1.0 / i3));
        let ask = Ask::on(Friction::coulomb(mu)).with_pose();
        let path = roll_with(&hoop, Start::from(start).with_slip(Slip::new(0.0, v + back)), &[0.5 * grip, 2.0 * grip], &ask, || true)
            .unwrap().unwrap();
        prop_assert_eq!(path_of(&path).phases.len(), 2);
        let near = |a: f64, b: f64, size: f64| (a - b).abs() <= 1e-13 * (1.0 + size);
        let phase = path_of(&path).phases[1];
        prop_assert!(phase.kind == Kind::Rolling && near(phase.time, grip, grip), "{} {grip}", phase.time);
        prop_assert!(near(phase.state.w3, (v - i3 * back) / (1.0 + i3), v + back));
        let heat = i3 * (v + back).powi(2) / (2.0 * (1.0 + i3));
        prop_assert!(near(path_of(&path).heat, heat, heat), "{} {heat}", path_of(&path).heat);
        let half = 0.5 * grip;
        let way = v * half - 0.5 * mu * half * half;
        let y = path.poses.unwrap()[0].contact_point.y;
        prop_assert!(near(y, way, v * half), "{y} {way}");
    }
}

#[test]
fn a_ball_keeps_jelletts_constant_and_a_rough_table_rolls() {
    let top = Body::ball(-0.2, 0.39, 0.40).unwrap();
    let start = State { theta: 0.3, w1: 0.2, w2: 0.1, w3: 8.0 };
    let times: Vec<f64> = (0..40).map(|i| 0.25 * f64::from(i)).collect();
    let jellett = |y: &State| {
        let (s, c) = y.theta.sin_cos();
        top.i1() * y.w1 * s + top.i3() * y.w3 * (c - 0.2)
    };
    for friction in [Friction::coulomb(0.3), Friction::Viscous { c: 0.2 }] {
        let path = roll_with(
            &top,
            Start::from(start).with_slip(Slip::new(0.5, -1.0)),
            &times,
            &Ask::on(friction),
            || true,
        );
        let path = path.unwrap().unwrap();
        let off = path.states.iter().map(|y| (jellett(y) / jellett(&start) - 1.0).abs());
        assert!(off.fold(0f64, larger) < 1e-13, "{friction:?}");
        assert_eq!(path.event, None);
    }
    // static friction without limit is rolling
    let body = Body::solid(1.5).unwrap();
    let start = State { theta: 1.1, w1: 0.6, w2: 0.0, w3: 0.9 };
    let rough = Ask::on(Friction::Coulomb { mu: 0.5, fixed: f64::INFINITY, patch: 0.0 });
    let path = roll_with(&body, start, &times[..4], &rough, || true).unwrap().unwrap();
    let rolled = roll_with(&body, start, &times[..4], &Default::default(), || true).unwrap().unwrap();
    assert_eq!(path.states, rolled.states);
}

proptest! {
    #![proptest_config(crate::common::cases(512))]

    /// Also where the body would lift off without friction.
    #[test]
    fn static_friction_without_limit_holds_where_rolling_presses(
        body in bodies(), (y, _) in states(), mu in 0.0..0.3f64,
    ) {
        prop_assume!(contact::force(Contact::Rolling, &body, &y).normal > 1e-9);
        let ask = Ask::on(Friction::Coulomb { mu, fixed: f64::INFINITY, patch: 0.0 });
        let motion = match roll_with(&body, y, &[0.0, 1e-6], &ask, || true) {
            Err(Error::Painleve { .. }) => return Ok(()),
            motion => motion.unwrap().unwrap(),
        };
        prop_assert_eq!(path_of(&motion).phases[0].kind, Kind::Rolling);
    }
}

#[test]
fn static_friction_alone_holds_a_contact_at_rest() {
    // Without sliding friction a body that slips would move as on a smooth table.
    let body = Body::tube(6.0, 0.8).unwrap();
    let start = spincyl::steady::state(&body, 1.4).unwrap().kicked(0.05);
    let roll = |ask: &Ask| roll_with(&body, start, &[0.0, 5.0], ask, || true).unwrap().unwrap();
    let held = roll(&Ask::on(Friction::Coulomb { mu: 0.0, fixed: 1.0, patch: 0.0 }));
    let rolls = roll(&Ask::default());
    assert_eq!(path_of(&held).phases.iter().map(|phase| phase.kind).collect::<Vec<_>>(), [Kind::Rolling]);
    assert_eq!(held.states, rolls.states);
}

#[test]
fn what_makes_no_sense_is_refused_by_name() {
    let (body, y) = (Body::solid(1.0).unwrap(), State { theta: 1.0, w1: 0.1, w2: 0.0, w3: 0.2 });
    let name = |friction: Friction, slip: [f64; 2], times: &[f64]| match roll_with(
        &body,
        Start::from(y).with_slip(slip.into()),
        times,
        &Ask::on(friction),
        || true,
    ) {
        Err(Error::OutOfRange { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    let coulomb = |mu, fixed| Friction::Coulomb { mu, fixed, patch: 0.0 };
    assert_eq!(name(coulomb(-0.1, 0.3), [1.0, 0.0], &[1.0]), "mu");
    assert_eq!(name(coulomb(f64::NAN, 0.3), [1.0, 0.0], &[1.0]), "mu");
    assert_eq!(name(coulomb(f64::INFINITY, f64::INFINITY), [1.0, 0.0], &[1.0]), "mu");
    assert_eq!(name(coulomb(0.3, 0.2), [1.0, 0.0], &[1.0]), "static");
    assert_eq!(name(coulomb(0.3, f64::NAN), [1.0, 0.0], &[1.0]), "static");
    assert_eq!(name(Friction::Viscous { c: -1.0 }, [1.0, 0.0], &[1.0]), "c");
    assert_eq!(name(Friction::coulomb(0.3), [f64::NAN, 0.0], &[1.0]), "slip along the lean");
    assert_eq!(name(Friction::coulomb(0.3), [0.0, 1e300], &[1.0]), "slip across");
    assert_eq!(name(Friction::coulomb(0.3), [1.0, 0.0], &[-1.0]), "t");
    assert_eq!(name(Friction::coulomb(0.3), [1.0, 0.0], &[]), "t");
    // a light rod that leans forward and is pushed has no force, or more than one
    let light = Body::new(1.0, 0.02, 0.01).unwrap();
    let limit = slip::painleve(&light, 1.0);
    let pushed = roll_with(
        &light,
        Start::from(y).with_slip(Slip::new(2.0, 0.0)),
        &[1.0],
        &Ask::on(Friction::coulomb(1.1 * limit)),
        || true,
    );
    assert!(matches!(pushed, Err(Error::Painleve { limit: found, .. }) if found == limit), "{pushed:?}");
}

#[test]
fn a_tube_that_slips_in_every_nod_is_not_said_to_jam() {
    let tube = Body::tube(6.0, 0.8).unwrap();
    let (w1, w3, mu) = (3.392822265625, 3.324289864719004, 0.20241508483886717);
    let start = State { theta: FRAC_PI_2, w1, w2: 0.0, w3 };
    let slip = [0.0, (6.0 - tube.i1() / 6.0) * w1 - w3];
    // Each slip is shorter than the one before. Within 1e-8 they are lost among the errors of the steps after 7,000.
    let ask = Ask::on(Friction::coulomb(mu)).with_method(Method::Tolerance(1e-9));
    let to = |t: f64| roll_with(&tube, Start::from(start).with_slip(slip.into()), &[t], &ask, || true);
    assert!(path_of(&to(1e3).unwrap().unwrap()).phases.len() > 100);
    // A motion that is given up returns its phases up to there.
    let far = to(2e5).unwrap().unwrap();
    let event = far.event.unwrap();
    assert!(event.ending == Ending::Bounded && event.time > 1e4, "{event:?}");
    assert!(path_of(&far).phases.len() > 10_000 && far.states.is_empty());
}

#[test]
fn what_lies_on_its_side_says_so_and_what_is_turned_fast_enough_rises() {
    let tube = Body::tube(6.0, 0.8).unwrap();
    for (launch, ending) in [(0.9, Ending::Side), (1.3, Ending::Done)] {
        let w1 = 3.0;
        let w3 = launch * 6.0 / (tube.i3() * w1);
        let start = State { theta: FRAC_PI_2, w1, w2: 0.0, w3 };
        let slip = [0.0, -tube.i1() / 6.0 * w1 + 6.0 * w1 - w3];
        let ask = Ask::on(Friction::coulomb(0.3));
        let path = roll_with(&tube, Start::from(start).with_slip(slip.into()), &[50.0], &ask, || true)
            .unwrap()
            .unwrap();
        assert_eq!(path.ending(), ending, "{launch}");
    }
}

const SLIPPING: usize = 6 + Summary::SlipTime as usize;

/// Launches of the paper's tube, as columns: w1, w3, the slip across, mu.
fn launches(count: usize) -> [Vec<f64>; 4] {
    let tube = Body::tube(6.0, 0.8).unwrap();
    let share = |i: usize, step: usize| ((i * step) % 1009) as f64 / 1009.0;
    let w1: Vec<f64> = (0..count).map(|i| 0.5 + 5.5 * share(i, 31)).collect();
    let w3: Vec<f64> = (0..count).map(|i| (0.9 + 1.5 * share(i, 457)) * 6.0 / (tube.i3() * w1[i])).collect();
    let slip = (0..count).map(|i| (6.0 - tube.i1() / 6.0) * w1[i] - w3[i]).collect();
    [w1, w3, slip, (0..count).map(|i| 0.1 + 0.3 * share(i, 211)).collect()]
}

/// The ends, estimated errors and status of these launches, computed in one call.
fn together(of: &[Vec<f64>; 4], times: &[f64], threads: usize) -> (Vec<Vec<f64>>, Vec<f64>, Vec<u8>) {
    let tube = Body::tube(6.0, 0.8).unwrap();
    let [w1, w3, slip, mu] = of;
    let count = w1.len();
    let (i1, i3) = ([tube.i1()], [tube.i3()]);
    let states: [&[f64]; 4] = [&[FRAC_PI_2], w1, &[0.0], w3];
    let starts = MotionStarts::new(BodyColumns::new(&[6.0], &i1, &i3), states)
        .with_slips(&[0.0], slip)
        .with_friction(mu, mu, &[0.0]);
    let mut last = vec![vec![7.0; count]; 6];
    let mut sums = vec![vec![7.0; count]; SUMMARIES];
    let (mut error, mut method, mut status) = (vec![7.0; count], vec![7; count], vec![7; count]);
    let mut columns = last.iter_mut().map(Vec::as_mut_slice);
    let mut next = || columns.next().unwrap();
    let out = MotionOutput::new(&mut error, &mut method, &mut status)
        .with_last(core::array::from_fn(|_| next()))
        .with_last_slip(next(), next());
    let out = with_summaries(out, &mut sums);
    let job = Job::new(times).with_ask(Ask::on(TableKind::Coulomb)).with_tol(1e-12);
    assert!(roll(&starts, &job, out, threads, |_| true).unwrap());
    (last.into_iter().chain(sums).collect(), error, status)
}

#[test]
fn side_by_side_a_slip_has_the_same_bits_whatever_its_neighbours() {
    let all = launches(700);
    let (found, error, status) = together(&all, &[60.0], 1);
    let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    for threads in [2, 3] {
        let (again, claims, codes) = together(&all, &[60.0], threads);
        assert!(found.iter().zip(&again).all(|(a, b)| bits(a) == bits(b)) && codes == status);
        assert_eq!(bits(&claims), bits(&error));
    }
    // in another order, and fewer of them
    let order: Vec<usize> = (0..700).map(|i| (i * 387) % 700).step_by(7).collect();
    let some = all.clone().map(|x| order.iter().map(|i| x[*i]).collect::<Vec<_>>());
    let (again, ..) = together(&some, &[60.0], 1);
    for (a, b) in found.iter().zip(&again) {
        assert!(order.iter().zip(b).all(|(i, b)| a[*i].to_bits() == b.to_bits()));
    }
    let kinds: Vec<usize> = (0..4).map(|code| status.iter().filter(|s| **s == code).count()).collect();
    assert!(kinds[0] > 50 && kinds[2] > 50 && kinds[3] > 50, "settle, lie down, hop: {kinds:?}");
}

#[test]
fn side_by_side_a_slip_is_what_it_is_alone() {
    let all = launches(120);
    let (found, error, status) = together(&all, &[40.0], 2);
    let tube = Body::tube(6.0, 0.8).unwrap();
    for i in 0..120 {
        let [w1, w3, slip, mu] = [&all[0], &all[1], &all[2], &all[3]].map(|x| x[i]);
        let start = State { theta: FRAC_PI_2, w1, w2: 0.0, w3 };
        let ask = Ask::on(Friction::coulomb(mu));
        let path =
            roll_with(&tube, Start::from(start).with_slip(Slip::new(0.0, slip)), &[40.0], &ask, || true)
                .unwrap()
                .unwrap();
        assert_eq!(path.ending() as u8, status[i], "{i}");
        assert_eq!(found[6 + Summary::Phases as usize][i], path_of(&path).phases.len() as f64, "{i}");
        let y = path.event.map_or_else(|| path.states[0], |e| e.state);
        let claim = error[i] + path.error;
        for (k, x) in <[f64; 4]>::from(y).into_iter().enumerate() {
            assert!((found[k][i] - x).abs() <= claim, "{i}: {k}: {} {x} {claim}", found[k][i]);
        }
        // the error of an energy is that of a speed, times the speed
        let (heat, fastest) =
            ((found[6 + Summary::Dissipated as usize][i] - path_of(&path).heat).abs(), 6.0 * w1 + w3);
        assert!(heat <= claim * fastest, "{i}: {heat:e} {claim:e}");
    }
    // at several times
    let (several, ..) = together(&all, &[10.0, 40.0], 1);
    assert!(
        (0..120).all(|i| (several[SLIPPING][i] - found[SLIPPING][i]).abs() < 1e-6),
        "the time of slipping"
    );
}

#[test]
fn runs_of_a_state_that_rounding_pushes_over_agree_within_what_they_claim() {
    let body = Body::tube(0.375, 0.0).unwrap();
    let start = spincyl::steady::state(&body, 1.4).unwrap();
    let at = |t: f64, tol: f64| {
        let ask = Ask::on(Friction::Viscous { c: 0.3 }).with_method(Method::Tolerance(tol));
        roll_with(&body, start, &[t], &ask, || true).unwrap().unwrap()
    };
    for t in [20.0, 30.0, 34.0, 36.0, 38.0] {
        let all = [1e-14, 2e-14, 5e-14, 1e-13, 1e-12].map(|tol| at(t, tol));
        for (a, b) in all.iter().flat_map(|a| all.iter().map(move |b| (a, b))) {
            let (claim, [x, y]) = (a.error + b.error, [a, b].map(|m| <[f64; 4]>::from(m.states[0])));
            let apart = x.iter().zip(y).fold(0.0, |most: f64, (x, y)| larger(most, (x - y).abs()));
            assert!(apart <= claim, "{t}: {apart:e} where {claim:e} is claimed");
        }
    }
    assert!(at(20.0, 1e-14).error < 1e-7, "so early little has grown");
}
