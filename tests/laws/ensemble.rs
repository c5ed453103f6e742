//! Many motions at once, compared with motions one at a time and with independent references.

use crate::common::many::Many;
use crate::common::rim::sharp;
use crate::common::{
    BOTH, almost_at_rest, any_body, any_rounded, any_state, by, distance, drawn, motions, moved, numbers,
    ordinary_tube, wander, wild,
};
use proptest::prelude::*;
use spincyl::contact::{Table, TableKind};
use spincyl::ensemble::{Answer, BodyColumns, Job, MotionOutput, MotionStarts, Summary, roll};
use spincyl::exact::Swing;
use spincyl::motion::{Ask, Ending, Method};
use spincyl::{Body, Contact, State, contact, rk4, rolling, stability, steady};

/// Starts by a kick out of steady states: narrow, wide and very wide swings.
fn kicked(count: usize) -> Vec<(Body, State)> {
    let mut random = wander(7);
    (0..count)
        .map(|i| {
            let body = Body::tube(0.5 + 2.5 * random(), random()).unwrap();
            let low = body.theta_balance().max(body.theta_limit());
            let theta = low + (core::f64::consts::FRAC_PI_2 - low) * (0.05 + 0.9 * random());
            let kick = [0.0, 1e-6, 0.05, 0.1, 0.4, 0.8][i % 6] * (0.5 + random());
            (body, steady::state(&body, theta).unwrap().kicked(kick))
        })
        .collect()
}

/// Starts by a kick out of steady states of rounded bodies: coins, cans, tubes, fat disks, balls.
fn kicked_rounded(count: usize) -> Vec<(Body, State)> {
    let mut r = wander(29);
    let mut all = Vec::new();
    while all.len() < count {
        let fillet = [0.01, 0.1, 0.5, 1.0, 1e-9][all.len() % 5] * (0.5 + 0.5 * r());
        let body = match all.len() % 4 {
            0 => Body::balls(1.0 + r()).unwrap(),
            1 => Body::ball(0.8 * (2.0 * r() - 1.0), 0.3 + 0.2 * r(), 0.4).unwrap(),
            2 => Body::rounded_tube(fillet + 2.0 * r(), 0.0, fillet).unwrap(),
            _ => Body::rounded_tube(fillet + 2.0 * r(), (1.0 - fillet) * r(), fillet).unwrap(),
        };
        let kick = [0.0, 1e-6, 0.05, 0.1, 0.4, 0.8][all.len() % 6] * (0.5 + r());
        let theta = (0.05 + 0.9 * r()) * body.theta_end();
        if let Ok(y) = steady::state(&body, theta)
            && numbers(&y).iter().all(|x| x.abs() < 30.0)
        {
            all.push((body, y.kicked(kick)));
        }
    }
    all
}

/// Starts by lighter kicks, of tubes that need not be stable.
fn kicked_softly(count: usize) -> Vec<(Body, State)> {
    let mut r = wander(31);
    let mut all = Vec::new();
    while all.len() < count {
        let body = Body::tube(0.3 + 2.0 * r(), r()).unwrap();
        if let Ok(y) = steady::state(&body, 0.1 + 1.4 * r())
            && y.w1 < 10.0
        {
            all.push((body, y.kicked(0.1 * r())));
        }
    }
    all
}

#[test]
fn every_motion_in_lanes_has_the_state_that_is_claimed() {
    // the references have forty digits; single motions have tests of their own
    let mut lanes = 0;
    for r in motions().into_iter().filter(|r| r.kind == "state") {
        for tol in [1e-6, 1e-10, 1e-13] {
            let times = [r.t];
            let job = Job::new(&times).with_ask(Ask::on(r.contact).with_beyond()).with_tol(tol);
            let many = Many::of(&[(r.body, r.start)]).run(&job, 1);
            let off = distance(&many.last(0), &r.values);
            assert!(off <= many.error[0], "{}: {off} > {}", r.scene, many.error[0]);
            if many.method[0] == Answer::Lanes as u8 {
                assert!(many.error[0] < tol.max(1e-11 * (1.0 + r.t)));
                lanes += 1;
            }
        }
    }
    assert!(lanes >= 20, "{lanes}");
}

#[test]
fn lanes_and_single_motions_agree_within_what_both_claim() {
    let times = [0.3, 5.0, 40.0];
    for (all, least) in [(kicked(drawn(1000)), drawn(700)), (kicked_rounded(drawn(600)), drawn(300))] {
        for (contact, tol) in BOTH.into_iter().flat_map(|of| [1e-6, 1e-11, 1e-13].map(|tol| (of, tol))) {
            let many = Many::of(&all)
                .run(&Job::new(&times).with_ask(Ask::on(contact).with_beyond()).with_tol(tol), 2);
            let mut lanes = 0;
            for (i, (body, start)) in all.iter().enumerate() {
                let in_lanes = many.method[i] == Answer::Lanes as u8;
                lanes += usize::from(in_lanes);
                let Ok(swing) = Swing::with_pose(body, start, contact) else { continue };
                for (j, t) in times.iter().enumerate() {
                    let y = many.at(i, j);
                    if y.theta.is_nan() && !sharp(body) {
                        assert!(swing.landing(1.0).is_some() && !in_lanes);
                        continue;
                    }
                    let off = distance(&y, &numbers(&swing.state(*t)));
                    let claimed = many.error[i] + swing.error(*t);
                    assert!(
                        off <= claimed,
                        "{body:?} {start:?} {contact:?} at {t}: {off:e} > {claimed:e}, {in_lanes}"
                    );
                }
                if in_lanes && swing.error(40.0) < 1e-9 {
                    let near = |a: f64, b: f64| (a - b).abs() <= 1e3 * tol * (1.0 + b.abs());
                    assert!(near(many.sum(Summary::Period, i), swing.period()), "{body:?} {start:?}: period");
                    let phi = swing.angles_per_period().unwrap().precession;
                    let turn = many.sum(Summary::PrecessionPerPeriod, i);
                    assert!(near(turn, phi), "{body:?} {start:?}: precession");
                }
            }
            assert!(lanes > least, "{contact:?} {tol:e}: {lanes} of {}", all.len());
        }
    }
}

#[test]
fn ends_are_those_of_single_motions() {
    let mut random = wander(11);
    let mut all: Vec<_> = (0..600).map(|_| wild(&mut random)).map(|(body, y, _)| (body, y)).collect();
    all.extend([kicked(600), kicked_rounded(800), kicked_softly(200)].concat());
    let times = [2.0, 8.0];
    for mu in [f64::INFINITY, 0.3] {
        let many = Many::of(&all).run(&Job::new(&times).with_ask(Ask::on(Table::Rolling { mu })), 2);
        let mut ended = [0, 0];
        for (i, (body, y)) in all.iter().enumerate() {
            let Ok(alone) = moved(body, y, &times, Ask::default().with_table(Table::Rolling { mu })) else {
                assert_eq!((many.status[i], many.method[i]), (Ending::Invalid as u8, 0));
                continue;
            };
            assert_eq!(many.status[i], alone.ending() as u8, "{body:?} {y:?}: {}", many.method[i]);
            ended[usize::from(i < 1200)] += usize::from(alone.ending() != Ending::Done);
            let end = alone.event.map_or(8.0, |e| e.time);
            assert!((many.sum(Summary::End, i) - end).abs() <= alone.error + 1e-9);
            if end < 8.0 {
                assert!(many.at(i, 1).theta.is_nan(), "nothing after an end");
            }
        }
        assert!(ended[1] > 200 && ended[0] > 50, "{ended:?}");
    }
}

#[test]
fn the_extremes_are_those_of_a_dense_look() {
    let all = kicked(120);
    for span in [0.4, 9.0, -3.0] {
        let times = [span];
        let many = Many::of(&all).run(&Job::new(&times).with_ask(Ask::default().with_beyond()), 2);
        for (i, (body, y)) in all.iter().enumerate() {
            let Ok(swing) = Swing::new(body, y, Contact::Rolling) else { continue };
            let mut found = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, 0.0];
            for k in 0..=2000 {
                let y = swing.state(span * f64::from(k) / 2000.0);
                let f = contact::force(Contact::Rolling, body, &y);
                found = [
                    found[0].min(y.theta),
                    found[1].max(y.theta),
                    found[2].min(f.normal),
                    found[3].max(f.friction_coefficient()),
                ];
            }
            // samples every 2e-3 of the span miss an extreme by the square of that
            let kinds =
                [Summary::ThetaMin, Summary::ThetaMax, Summary::NormalMin, Summary::FrictionCoefficientMax];
            for (k, kind) in kinds.into_iter().enumerate() {
                let (a, b) = (many.sum(kind, i), found[k]);
                if b.is_infinite() || b.abs() > 1e3 {
                    continue;
                }
                let beyond = if k % 2 == 0 { b - a } else { a - b };
                assert!(beyond > -1e-9 * (1.0 + b.abs()), "{kind:?} {body:?} {y:?}: {a} {b}");
                assert!(beyond < 1e-3 * (1.0 + b.abs()), "{kind:?} {body:?} {y:?} in {span}: {a} {b}");
            }
        }
    }
}

#[test]
fn c4_c5_no_bit_depends_on_threads_neighbours_or_place() {
    let times = [3.0, 20.0];
    for (step, count, more) in [(None, drawn(600), drawn(1200)), (Some(0.02), 100, 100)] {
        // sharp bodies between rounded ones in the same eight lanes, and many sharp ones
        let mixed = kicked_rounded(count).into_iter().zip(kicked_softly(count));
        let mut all: Vec<_> = mixed.flat_map(|(a, b)| [a, b]).collect();
        all.extend(kicked(more));
        let job =
            Job::new(&times).with_ask(Ask::default().with_method(step.map_or(Method::Exact, Method::Step)));
        let whole = Many::of(&all).run(&job, 1);
        for threads in [2, 3, 4, 5, 7, 16] {
            let other = Many::of(&all).run(&job, threads);
            assert!((0..all.len()).all(|i| whole.bits(i) == other.bits(i)), "{threads} threads");
        }
        for i in (0..all.len()).step_by(41) {
            assert_eq!(Many::of(&all[i..i + 1]).run(&job, 1).bits(0), whole.bits(i), "alone: {:?}", all[i]);
        }
        for kind in [true, false] {
            let (places, some): (Vec<_>, Vec<_>) =
                all.iter().copied().enumerate().filter(|(_, (body, _))| sharp(body) == kind).unzip();
            let apart = Many::of(&some).run(&job, 1);
            assert!(
                places.iter().enumerate().all(|(k, i)| apart.bits(k) == whole.bits(*i)),
                "of its own kind"
            );
        }
        let tail = Many::of(&all[3..all.len() - 2]).run(&job, 2);
        assert!((3..all.len() - 2).all(|i| tail.bits(i - 3) == whole.bits(i)), "elsewhere");
    }
}

#[test]
fn a_single_body_serves_many_states() {
    let all: Vec<_> = kicked(100).into_iter().map(|(_, y)| (Body::solid(1.5).unwrap(), y)).collect();
    let (times, mut few) = ([20.0], Many::of(&all));
    let many = Many::of(&all).run(&Job::new(&times), 1);
    few.body = few.body.map(|x| vec![x[0]]);
    let few = few.run(&Job::new(&times), 1);
    assert!((0..all.len()).all(|i| few.bits(i) == many.bits(i)));
}

#[test]
fn a_fillet_of_nothing_and_an_end_of_its_own_are_what_a_body_has_by_itself() {
    let all = kicked_softly(100);
    let times = [6.0];
    let (mut plain, mut capped) = (Many::of(&all), Many::of(&all));
    (plain.body[3], plain.body[4]) = (vec![0.0], vec![f64::NAN]);
    // a cap that lands at 1.2 ends every motion that gets there
    (capped.body[3], capped.body[4]) = (vec![0.0], vec![1.2]);
    let job = Job::new(&times);
    let [plain, capped] = [plain, capped].map(|many| many.run(&job, 1));
    let same = Many::of(&all).run(&job, 2);
    assert!((0..all.len()).all(|i| plain.bits(i) == same.bits(i)));
    let mut ended = 0;
    for (i, (body, y)) in all.iter().enumerate() {
        let alone = moved(&body.with_theta_end(1.2).unwrap(), y, &times, Ask::default()).unwrap();
        assert_eq!(capped.status[i], alone.ending() as u8, "{body:?} {y:?}");
        ended += usize::from(alone.ending() == Ending::Side);
    }
    assert!(ended > 20, "{ended}");
}

#[test]
fn rk4_in_lanes_is_rk4() {
    let all = kicked(128);
    let times = [1.0, 2.505];
    let many = Many::of(&all)
        .run(&Job::new(&times).with_ask(Ask::default().with_method(Method::Step(0.01)).with_beyond()), 1);
    let mut lanes = 0;
    for (i, (body, y)) in all.iter().enumerate() {
        if many.method[i] != Answer::Step as u8 {
            continue;
        }
        lanes += 1;
        let f = |y: &State| rolling::derivative(body, y);
        let one = rk4::integrate(f, *y, 0.01, 100);
        let two = rk4::integrate(f, rk4::integrate(f, *y, 0.01, 250), 0.005, 1);
        for (j, alone) in [one, two].into_iter().enumerate() {
            let y = many.at(i, j);
            // lanes integrate sine and cosine: another RK4, with an error of the same size
            let off = distance(&y, &numbers(&alone));
            assert!(off <= 4.0 * many.error[i] + 1e-13, "{body:?}: {off} {}", many.error[i]);
        }
    }
    assert!(lanes > 100, "{lanes}");
    // half the step has a sixteenth of the error, where that is well above the error of exact motions
    let exact = Many::of(&all).run(&Job::new(&times).with_ask(Ask::default().with_beyond()), 1);
    let fine = Many::of(&all)
        .run(&Job::new(&times).with_ask(Ask::default().with_method(Method::Step(0.005)).with_beyond()), 1);
    let clear = (0..all.len()).filter(|i| fine.error[*i] > 50.0 * exact.error[*i]);
    let ratios: Vec<f64> = clear.map(|i| many.error[i] / fine.error[i]).collect();
    assert!(ratios.len() > 5 && ratios.iter().all(|r| (12.0..18.0).contains(r)), "{ratios:?}");
}

#[test]
fn what_makes_no_sense_is_refused_or_marked() {
    let (solid, balls) = (Body::solid(1.0).unwrap(), Body::balls(1.0).unwrap());
    let times = [1.0];
    // columns: ell, i1, i3, fillet, theta_end, theta, w1, w2, w3
    let of_solid: [&[(usize, f64)]; 11] = [
        &[(5, f64::NAN)],
        &[(5, f64::INFINITY)],
        &[(5, -1.0)],
        &[(5, 0.0)],
        &[(5, 4.0)],
        &[(0, -1.0)],
        &[(1, f64::NAN)],
        &[(2, 100.0)],
        &[(6, 1e7)],
        &[(7, f64::NAN)],
        &[(8, f64::INFINITY)],
    ];
    // refused: a centre of mass below the circle of the rim, or outside a ball
    let of_balls: [&[(usize, f64)]; 7] = [
        &[(3, -0.1)],
        &[(3, 1.5)],
        &[(3, f64::NAN)],
        &[(0, -0.5), (3, 0.5)],
        &[(0, -1.0)],
        &[(4, -1.0)],
        &[(4, 4.0)],
    ];
    for (body, theta, kick, bad) in [(solid, 1.3, 0.0, &of_solid[..]), (balls, 1.4, 0.01, &of_balls)] {
        let mut many = Many::of(&[(body, steady::state(&body, theta).unwrap().kicked(kick)); 20]);
        many.body[4].fill(if sharp(&body) { body.theta_end() } else { f64::NAN });
        for (i, (column, x)) in bad.iter().enumerate().flat_map(|(i, all)| all.iter().map(move |x| (i, *x))) {
            if column < 5 { many.body[column][i] = x } else { many.state[column - 5][i] = x }
        }
        let many = many.run(&Job::new(&times), 1);
        for i in 0..20 {
            assert_eq!(many.status[i] == Ending::Invalid as u8, i < bad.len(), "{body:?} {i}");
            assert_eq!(many.last(i).theta.is_nan() && many.error[i].is_nan(), i < bad.len());
        }
    }
    let refused = |job: &Job<'_>| {
        let states: [&[f64]; 4] = [&[1.3], &[1.0], &[0.0], &[1.0]];
        let starts = MotionStarts::new(BodyColumns::new(&[1.0], &[0.6], &[0.5]), states);
        let (mut error, mut method, mut status) = ([0.0], [0], [0]);
        let out = MotionOutput::new(&mut error, &mut method, &mut status);
        roll(&starts, job, out, 1, |_| true).unwrap_err().to_string()
    };
    assert!(refused(&Job::new(&[])).contains("one or more times"));
    assert!(refused(&Job::new(&[1.0, 0.5])).contains("ascending"));
    assert!(refused(&Job::new(&times).with_tol(0.0)).starts_with("tol = 0.0"));
    for (ask, name) in [
        (Ask::default().with_slope(0.2), "slope = 0.2"),
        (Ask::on(Table::Rolling { mu: 0.3 }).with_slope(1e-300), "slope = "),
        (Ask::default().with_turning(0.5), "turning = 0.5"),
        (Ask::default().with_restitution(0.5).with_turning(f64::NAN), "turning = NaN"),
    ] {
        assert!(refused(&Job::new(&times).with_ask(ask)).starts_with(name), "{name}");
    }
    assert!(refused(&Job::new(&times).with_ask(Ask::on(TableKind::Coulomb))).starts_with("mu = inf"));
    assert!(
        refused(&Job::new(&times).with_ask(Ask::on(Table::Rolling { mu: f64::NAN }))).starts_with("mu = NaN")
    );
    assert!(
        refused(&Job::new(&times).with_ask(Ask::default().with_method(Method::Step(0.0))))
            .starts_with("step = 0.0")
    );
}

#[test]
fn a_body_released_at_rest_falls() {
    // once it stayed at rest for ever, in lanes and by the quick solution of a single motion
    let body = Body::solid(0.31).unwrap();
    for w2 in [0.0, 1e-300, -1e-300, 1e-30, -1e-12] {
        let y = State { theta: 1.1, w1: 1.2, w2, w3: -0.6 };
        let lanes = Many::of(&[(body, y)]).run(&Job::new(&[10.0]), 1);
        let alone = moved(&body, &y, &[10.0], Ask::default()).unwrap();
        let event = alone.event.unwrap();
        assert_eq!((event.ending, lanes.status[0]), (Ending::Side, Ending::Side as u8));
        assert!((event.time - 0.951_470_255_67).abs() < 1e-10);
        assert!((lanes.sum(Summary::End, 0) - event.time).abs() < 1e-13);
    }
    // a wide swing that starts next to its turning point: half the digits of its phase were lost
    let body = Body::solid(2.8057204670343325).unwrap();
    let y = State { theta: 0.2718205029824101, w1: 0.10806715919341818, w2: 0.0, w3: 0.3032062403632308 };
    let lanes = Many::of(&[(body, y)]).run(&Job::new(&[7.0]).with_ask(Ask::default().with_beyond()), 1);
    let swing = Swing::new(&body, &y, Contact::Rolling).unwrap();
    let off = distance(&lanes.last(0), &numbers(&swing.state(7.0)));
    assert!(off <= lanes.error[0] + swing.error(7.0) && off < 1e-12, "{off:e}, claimed {:e}", lanes.error[0]);
}

#[test]
fn starts_at_rest_or_almost_go_the_way_of_an_integrator_by_every_route() {
    let mut r = wander(17);
    let mut by_lanes = [0; 2];
    for _ in 0..1600 {
        let (body, y, contact) = wild(&mut r);
        let y = State { w2: almost_at_rest(&mut r), ..y };
        let times = [0.3 + 3.0 * r()];
        let scene = by(Method::Tolerance(1e-13)).with_table(contact).with_beyond();
        let Ok(truth) = moved(&body, &y, &times, scene) else { continue };
        let exact = moved(&body, &y, &times, scene.with_method(Method::Exact)).unwrap();
        let posed = moved(&body, &y, &times, scene.with_method(Method::Exact).with_pose()).unwrap();
        let lanes = Many::of(&[(body, y)]).run(&Job::new(&times).with_ask(Ask::on(contact).with_beyond()), 1);
        let there = truth.states.len();
        assert!(exact.states.len() == there && posed.states.len() == there, "{y:?}");
        let Some(there) = truth.states.first() else { continue };
        // the error of the integrator is an estimate: several times that, and its growth at a saddle
        let allowed = |claimed: f64| 10.0 * claimed + 4.0 * truth.error + 1e-12;
        for (y1, claimed) in
            [(exact.states[0], exact.error), (posed.states[0], posed.error), (lanes.last(0), lanes.error[0])]
        {
            let off = distance(&y1, &numbers(there));
            let told = format!("{body:?} {y:?} {contact:?} to {times:?}");
            assert!(off <= allowed(claimed), "{told}: {off:e}, claimed {claimed:e}");
        }
        let here = usize::from(contact == Contact::Smooth);
        by_lanes[here] += usize::from(lanes.method[0] == Answer::Lanes as u8);
    }
    assert!(by_lanes.iter().all(|n| *n > 120), "{by_lanes:?} by lanes");
}

/// Whether a steady state is unchanged at a time, within the estimated error.
fn stays(body: &Body, y: &State, t: f64) -> bool {
    let many = Many::of(&[(*body, *y)]).run(&Job::new(&[t]).with_ask(Ask::default().with_beyond()), 1);
    distance(&many.last(0), &numbers(y)) <= many.error[0]
}

/// For a long pipe the balance is a difference hundreds of times smaller than the height of its centre.
#[test]
fn a_long_pipe_that_leans_almost_balanced_stays() {
    for (ell, theta) in
        [(25.509587271027733, 0.033031004434917736), (16.098629078287757, 0.050520044700795), (21.8, 0.0364)]
    {
        let body = Body::tube(ell, 1.0).unwrap();
        let y = steady::state(&body, theta).unwrap();
        assert!(stability::rolling(&body, &y) > 1e-3);
        assert!((0..1000).all(|i| stays(&body, &y, 0.1 * f64::from(i))), "{ell}");
    }
}

proptest! {
    #![proptest_config(crate::common::cases(640))]

    #[test]
    fn no_state_gives_a_wrong_number_unmarked(body in prop_oneof![2 => any_body(), 1 => any_rounded()], y in any_state(), t in 0.0..30.0f64) {
        let times = [t];
        for contact in BOTH {
            let many = Many::of(&[(body, y)]).run(&Job::new(&times).with_ask(Ask::on(contact).with_beyond()), 1);
            if many.method[0] != Answer::Lanes as u8 {
                continue;
            }
            // the error of the integrator is an estimate; a face that lands is compared at its landing
            let (there, claimed) = if sharp(&body) && many.status[0] == Ending::Face as u8 {
                let swing = Swing::new(&body, &y, contact).unwrap();
                let (time, landed) = swing.landing(1.0).unwrap();
                (landed, swing.error(time))
            } else {
                let ask = by(Method::Tolerance(1e-12)).with_table(contact).with_beyond();
                let alone = moved(&body, &y, &times, ask).unwrap();
                // if a face lands at the requested time, only one of the two may have landed
                let Some(there) = alone.states.first() else {
                    prop_assert!(!sharp(&body));
                    continue;
                };
                (*there, if sharp(&body) { 4.0 } else { 2.0 } * alone.error)
            };
            let off = distance(&many.last(0), &numbers(&there));
            prop_assert!(off <= many.error[0] + claimed, "{} > {} + {}", off, many.error[0], claimed);
        }
    }

    #[test]
    fn a_stable_steady_state_stays(body in ordinary_tube(), u in 0.01..0.99f64, t in 0.0..100.0f64) {
        if let Ok(y) = steady::state(&body, u * core::f64::consts::FRAC_PI_2)
            && numbers(&y).iter().all(|x| x.abs() < 100.0)
            && stability::rolling(&body, &y) > 1e-3
        {
            prop_assert!(stays(&body, &y, t));
        }
    }
}
