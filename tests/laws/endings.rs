//! How motions end, and starts that raise an error: rows D8, D9, D10, D12 of docs/hard-cases.md.

use crate::common::{by, distance, larger, motions, moved, numbers, state, wander, wild};
use spincyl::contact::Table;
use spincyl::exact::Swing;
use spincyl::motion::{Ask, Ending, Method, Start, roll, roll_with};
use spincyl::{Body, Contact, Error, State, contact, rolling, steady};
use std::f64::consts::{FRAC_PI_2, PI};

#[test]
fn d9_d10_events_come_at_their_time() {
    let mut checked = 0;
    for r in motions().iter().filter(|r| r.kind == "event") {
        let (ending, mu) = match &*r.scene {
            "side" => (Ending::Side, f64::INFINITY),
            "lift-off" => (Ending::LiftOff, f64::INFINITY),
            _ => (Ending::Slip, 0.3),
        };
        for (method, allowed) in
            [(Method::Exact, 1e-12), (Method::Tolerance(1e-13), 1e-11), (Method::Step(1e-4), 1e-11)]
        {
            let scene = by(method).with_table(Table::of(r.contact, mu)).with_pose().with_force();
            let times = [0.0, 0.5 * r.t, r.t + 1e-9, r.t + 1.0];
            let motion = moved(&r.body, &r.start, &times, scene).unwrap();
            let event = motion.event.unwrap();
            assert_eq!((event.ending, motion.ending()), (ending, ending), "{method:?}");
            assert!((event.time - r.t).abs() <= allowed, "{} {method:?}: {:e}", r.scene, event.time - r.t);
            assert!(distance(&event.state, &r.values) <= 10.0 * allowed, "{:?} {:?}", event.state, r.values);
            // no state after the event is returned, unless `beyond` is set
            assert_eq!((motion.times.len(), motion.states.len()), (2, 2));
            assert_eq!((motion.poses.unwrap().len(), motion.forces.unwrap().len()), (2, 2));
            let beyond = moved(&r.body, &r.start, &times, scene.with_beyond()).unwrap();
            assert_eq!((beyond.states.len(), beyond.event.map(|e| e.ending)), (4, Some(ending)));
        }
        checked += 1;
    }
    assert!(checked >= 8, "{checked}");
}

#[test]
fn d8_a_head_on_fall_lands_on_the_face() {
    for ell in [0.0, 0.3, 1.0] {
        let body = Body::solid(ell).unwrap();
        let y = state(0.3, 0.0, 0.0, 0.0);
        // J theta'^2/2 = V(0.3) - V(theta): one quadrature, by the midpoint rule in sqrt(0.3 - theta)
        let height = |x: f64| ell * x.cos() + x.sin();
        let n = 2_000_000;
        let top = 0.3f64.sqrt();
        let time: f64 = (0..n)
            .map(|i| {
                let v = top * (f64::from(i) + 0.5) / f64::from(n);
                let x = 0.3 - v * v;
                // height(0.3) - height(x), without cancellation
                let (mid, half) = (0.5 * (0.3 + x), 0.5 * v * v);
                let drop = 2.0 * half.sin() * (mid.cos() - ell * mid.sin());
                2.0 * v / (2.0 * drop / (body.i1() + 1.0 + ell * ell)).sqrt()
            })
            .sum::<f64>()
            * top
            / f64::from(n);
        let speed = (2.0 * (height(0.3) - height(0.0)) / (body.i1() + 1.0 + ell * ell)).sqrt();
        for (method, allowed) in
            [(Method::Exact, 1e-12), (Method::Step(1e-3), 1e-12), (Method::Tolerance(1e-13), 1e-12)]
        {
            let times: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i)).collect();
            let motion = moved(&body, &y, &times, by(method).with_pose()).unwrap();
            let event = motion.event.unwrap();
            assert_eq!(event.ending, Ending::Face);
            assert!((event.time - time).abs() < allowed, "{method:?}, ell = {ell}: {:e}", event.time - time);
            assert!((event.state.w2 - speed).abs() < 1e-11 && event.state.theta == 0.0);
            assert!(motion.states.iter().all(|y| numbers(y).iter().all(|x| x.is_finite()) && y.theta > 0.0));
            assert!(method != Method::Exact || motion.method == method, "{}", motion.error);
            // after a face has landed there are no states, even if `beyond` is set
            let beyond = moved(&body, &y, &times, by(method).with_beyond()).unwrap();
            assert_eq!(beyond.states.len(), motion.states.len());
        }
    }
}

#[test]
fn a_body_thrown_up_lands_later_and_has_come_from_the_table_earlier() {
    // the times to the landings after and before the start add up to two falls from the turning point
    for (ell, theta, speed) in [(0.3, 0.3, 0.2), (1.0, 0.2, 0.1)] {
        let body = Body::solid(ell).unwrap();
        let swing = Swing::new(&body, &state(theta, 0.0, -speed, 0.0), Contact::Rolling).unwrap();
        let ([low, top], after, before) = (swing.turning_points(), swing.landing(1.0), swing.landing(-1.0));
        let ((after, down), (before, up)) = (after.unwrap(), before.unwrap());
        let fall = Swing::new(&body, &state(top, 0.0, 0.0, 0.0), Contact::Rolling).unwrap();
        let (fallen, landed) = fall.landing(1.0).unwrap();
        assert!(low == 0.0 && top > theta && after > fallen && before < fallen);
        assert!((after + before - 2.0 * fallen).abs() < 1e-13, "{after} {before} {fallen}");
        assert!((down.w2 - landed.w2).abs() < 1e-13 && (up.w2 + landed.w2).abs() < 1e-13 && down.w2 > 0.0);
        assert!((swing.state(after - fallen).theta - top).abs() < 1e-14);
    }
    // a coin that leans to the other side lands on its other face
    let coin = Body::solid(0.0).unwrap();
    let (time, landed) =
        Swing::new(&coin, &state(PI - 0.3, 0.0, 0.0, 0.0), Contact::Rolling).unwrap().landing(1.0).unwrap();
    let (mirrored, face) =
        Swing::new(&coin, &state(0.3, 0.0, 0.0, 0.0), Contact::Rolling).unwrap().landing(1.0).unwrap();
    assert!((time - mirrored).abs() < 1e-13 && landed.theta == PI && (landed.w2 + face.w2).abs() < 1e-13);
}

#[test]
fn beyond_an_event_a_motion_still_ends_where_the_face_lands() {
    for (ell, y, mu) in [
        (0.5, state(0.5, 0.0, 0.0, 0.0), 0.1),
        (0.5, state(1.5, 0.0, -1.0, 0.0), f64::INFINITY),
        (0.5, state(2.5, 0.0, 0.0, 0.0), f64::INFINITY),
    ] {
        let body = Body::solid(ell).unwrap();
        let times: Vec<f64> = (0..51).map(|i| 0.1 * f64::from(i)).collect();
        let all = [Method::Exact, Method::Step(1e-3), Method::Tolerance(1e-9)].map(|method| {
            moved(&body, &y, &times, by(method).with_table(Table::Rolling { mu }).with_beyond()).unwrap()
        });
        for m in &all {
            assert_eq!(m.event.map(|e| (e.ending, e.time)), all[0].event.map(|e| (e.ending, e.time)));
            assert!(m.times == all[0].times && m.times.len() < 51, "{:?}", m.times.len());
        }
    }
}

#[test]
fn a_margin_that_dips_right_after_the_start_is_seen() {
    for (ell, y, mu, t) in [
        (
            0.8,
            state(0.7340891933268048, -0.06437578881324452, -0.8463497565526826, -2.9958192806427366),
            17.115893,
            0.2,
        ),
        (0.0, state(0.66884269, 0.04849812, 0.24796703, -0.42653121), 0.732658296, 0.2),
    ] {
        let body = Body::solid(ell).unwrap();
        for method in [Method::Exact, Method::Step(1e-3), Method::Tolerance(1e-9)] {
            let event = moved(&body, &y, &[t], by(method).with_table(Table::Rolling { mu })).unwrap().event;
            assert_eq!(event.map(|e| e.ending), Some(Ending::Slip), "{method:?}");
        }
    }
    // starts just before a peak of the friction demand, with mu just below the peak
    let mut r = wander(5);
    let mut checked = 0;
    for _ in 0..2000 {
        let (body, y, _) = wild(&mut r);
        let Ok(swing) = Swing::new(&body, &y, Contact::Rolling) else { continue };
        let demand = |t: f64| contact::force(Contact::Rolling, &body, &swing.state(t)).friction_coefficient();
        let times: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i)).collect();
        let peak = times.windows(3).find(|w| demand(w[1]) > demand(w[0]) && demand(w[1]) > demand(w[2]));
        let Some(peak) = peak.map(|w| w[1]).filter(|t| demand(*t).is_finite()) else { continue };
        let start = swing.state(peak - 0.012);
        let mu = 0.3 * demand(peak - 0.012) + 0.7 * demand(peak);
        if demand(peak - 0.012) < mu * (1.0 - 1e-9) && mu > 1e-6 {
            let m =
                moved(&body, &start, &[0.1], by(Method::Exact).with_table(Table::Rolling { mu })).unwrap();
            assert!(m.event.is_some_and(|e| e.time < 0.0121), "{body:?} {start:?} {mu}");
            checked += 1;
        }
    }
    assert!(checked > 300, "{checked}");
}

#[test]
fn an_integrator_that_stays_on_an_unstable_state_does_not_claim_to_be_right() {
    let body = Body::solid(2.5).unwrap();
    let balanced = state(1f64.atan2(2.5), 0.0, 0.0, 0.0);
    for (contact, t, off) in [(Contact::Smooth, 24.0, 1.3e-6), (Contact::Rolling, 60.0, 5.1e-4)] {
        let scene = Ask::default().with_table(contact).with_pose();
        // these doubles are not quite balanced, so that the body falls; `off` is from a model with 36 digits
        let exact = moved(&body, &balanced, &[t], scene).unwrap();
        let fallen = (exact.states[0].theta - balanced.theta).abs();
        assert!(
            exact.method == Method::Exact && fallen > 0.5 * off && fallen < 1.1 * off,
            "{contact:?} {fallen:e}"
        );
        let m = moved(&body, &balanced, &[t], scene.with_method(Method::Tolerance(1e-12))).unwrap();
        assert!(m.error > 0.5 * off, "{contact:?}: {:e}", m.error);
    }
}

#[test]
fn d9_grazing_the_side() {
    let body = Body::solid(2.5).unwrap();
    // the upper turning point is pi/2 + graze, and the start lies a quarter period before it
    for (graze, hits) in [(1e-9, true), (-1e-9, false)] {
        let top = state(FRAC_PI_2 + graze, 1.6, 0.0, 4.0);
        let swing = Swing::new(&body, &top, Contact::Rolling).unwrap();
        let below = swing.state(-0.25 * swing.period());
        assert!(below.theta < FRAC_PI_2 && swing.turning_points()[1] < FRAC_PI_2 + 2e-9, "{top:?}");
        for method in [Method::Exact, Method::Step(1e-3), Method::Tolerance(1e-13)] {
            let motion = moved(&body, &below, &[swing.period()], by(method)).unwrap();
            let event = motion.event.filter(|e| e.ending == Ending::Side);
            assert_eq!(event.is_some(), hits, "{method:?}, {graze}: {motion:?}");
            if let Some(e) = event {
                // the body is at pi/2 before that turning point, by the time sqrt(2 graze/w2')
                let rate = rolling::derivative(&body, &top).w2;
                let expected = 0.25 * swing.period() - (2.0 * graze / rate).sqrt();
                assert!((e.time - expected).abs() < 1e-8, "{method:?}: {} {expected}", e.time);
            }
        }
    }
    // a coin has no other rim
    let coin = Body::solid(0.0).unwrap();
    for method in [Method::Exact, Method::Step(1e-3), Method::Tolerance(1e-9)] {
        let motion = moved(&coin, &state(1.5, 1.2, -0.3, 0.2), &[0.5], by(method)).unwrap();
        assert!(motion.event.is_none() && motion.states[0].theta > FRAC_PI_2, "{motion:?}");
    }
}

#[test]
fn d9_starts_at_and_beyond_the_end_of_the_lean_have_ended_or_turn_back() {
    let lying = [(0.1, 0.0, true), (1.6, 0.0, false), (1.6, -0.1, true), (1.6, 0.1, false)];
    let cylinder = Body::solid(2.5).unwrap();
    let mut all = lying.map(|(w1, w2, ends)| (cylinder, state(FRAC_PI_2, w1, w2, 2.5 * w1), ends)).to_vec();
    let can = Body::rounded_tube(1.0, 0.0, 0.1).unwrap();
    let ball = Body::ball(-0.2, 0.3, 0.4).unwrap();
    for body in [can, can.with_theta_end(1.3).unwrap(), ball.with_theta_end(2.0).unwrap()] {
        for (beyond, w2, ends) in
            [(0.0, -0.1, true), (0.0, 0.1, false), (0.01, 0.1, true), (-1e-3, 0.1, false)]
        {
            all.push((body, state(body.theta_end() + beyond, 0.0, w2, 0.0), ends));
        }
    }
    for (body, y, ends) in all {
        for method in [Method::Exact, Method::Step(1e-3), Method::Tolerance(1e-9)] {
            let motion = moved(&body, &y, &[0.01], by(method)).unwrap();
            let expected = ends.then_some((Ending::Side, 0.0));
            assert_eq!(motion.event.map(|e| (e.ending, e.time)), expected, "{body:?} {y:?} {method:?}");
        }
    }
}

#[test]
fn d10_without_friction_coefficient_rolling_never_slips_and_with_none_at_once() {
    let body = Body::solid(2.5).unwrap();
    let rest = steady::state(&body, 1.3).unwrap();
    for method in [Method::Exact, Method::Step(1e-3), Method::Tolerance(1e-9)] {
        let at = |y: &State, mu: f64| {
            moved(&body, y, &[5.0], by(method).with_table(Table::Rolling { mu })).unwrap().event
        };
        assert!(at(&rest, f64::INFINITY).is_none());
        assert!(at(&rest, 0.0).is_none(), "a centre at rest needs no friction");
        let kicked = at(&rest.kicked(0.05), 0.0).unwrap();
        assert_eq!((kicked.ending, kicked.time), (Ending::Slip, 0.0));
        assert!(at(&rest.kicked(0.05), f64::INFINITY).is_none());
    }
    // an ordinary start that leaves the model: rolling needs a coefficient of 4, and N almost vanishes
    let swing = Swing::new(&body, &rest.kicked(0.3), Contact::Rolling).unwrap();
    let most = (0..400)
        .map(|i| {
            contact::force(Contact::Rolling, &body, &swing.state(0.02 * f64::from(i))).friction_coefficient()
        })
        .fold(0.0, larger);
    assert!(most > 3.5 && most < 4.5, "{most}");
}

#[test]
fn d12_what_makes_no_sense_is_refused_by_name_before_any_work() {
    let good = state(0.5, 0.3, 0.0, 0.1);
    for body in [Body::solid(1.0).unwrap(), Body::rounded_tube(1.0, 0.0, 0.1).unwrap()] {
        let name = |y: State, times: &[f64], scene: Ask| match moved(&body, &y, times, scene) {
            Err(Error::OutOfRange { name, .. }) => name,
            other => panic!("{other:?}"),
        };
        for theta in [-0.1, PI, 4.0, f64::NAN, f64::INFINITY, 1e-9] {
            assert_eq!(name(State { theta, ..good }, &[1.0], Ask::default()), "theta");
        }
        assert_eq!(name(State { theta: 0.0, ..good }, &[1.0], Ask::default()), "w1");
        for x in [1e308, f64::NAN, f64::INFINITY, -1e7] {
            assert_eq!(name(State { w1: x, ..good }, &[1.0], Ask::default()), "w1");
            assert_eq!(name(State { w2: x, ..good }, &[1.0], Ask::default()), "w2");
            assert_eq!(name(State { w3: x, ..good }, &[1.0], Ask::default()), "w3");
        }
        for step in [0.0, f64::NAN, f64::INFINITY, 5e-324, 1e-16, -1e-3] {
            assert_eq!(name(good, &[1.0], by(Method::Step(step))), "step", "{step}");
        }
        assert_eq!(name(good, &[1e15], by(Method::Step(1e-12))), "step", "2^63 steps and more");
        for tol in [0.0, -1.0, f64::NAN, 1e-17, 1.0] {
            assert_eq!(name(good, &[1.0], by(Method::Tolerance(tol))), "tol");
        }
        for mu in [-0.1, f64::NAN] {
            assert_eq!(name(good, &[1.0], Ask::default().with_table(Table::Rolling { mu })), "mu");
        }
        for times in [&[][..], &[f64::NAN], &[1.0, 0.5], &[-1.0, 1.0], &[f64::INFINITY]] {
            assert_eq!(name(good, times, Ask::default()), "t", "{times:?}");
        }
    }
    for (body, name) in [
        (Body::new(1.0, 1e20, 1.0), "i1"),
        (Body::rounded(1.0, 1e20, 1.0, 0.5), "i1"),
        (Body::rounded(1e8, 1.0, 1.0, 0.5), "ell"),
    ] {
        match moved(&body.unwrap(), &good, &[1.0], Ask::default()) {
            Err(Error::OutOfRange { name: found, .. }) => assert_eq!(found, name),
            other => panic!("{other:?}"),
        }
    }
    let body = Body::solid(1.0).unwrap();
    // at time 0 a motion is at its start
    for method in [Method::Exact, Method::Step(1e-3), Method::Tolerance(1e-9)] {
        let motion = moved(&body, &good, &[0.0, 0.0], by(method)).unwrap();
        assert_eq!(motion.states, [good, good]);
        assert_eq!((motion.event, motion.error), (None, 0.0));
    }
    // an interrupted motion is the motion up to there
    let stopped = roll_with(&body, good, &[0.0, 1e5], &by(Method::Step(1e-6)), || false).unwrap().unwrap();
    let event = stopped.event.unwrap();
    assert!(stopped.is_interrupted() && stopped.states == [good] && event.time > 0.0 && event.time < 1.0);
}

#[test]
fn without_choices_a_motion_rolls_from_the_first_of_its_times() {
    let body = Body::solid(1.0).unwrap();
    let start = state(0.3, 0.0, 0.0, 0.0);
    for t0 in [0.0, -3.0, 1e6] {
        let times: Vec<f64> = (0..=50).map(|i| t0 + 0.1 * f64::from(i)).collect();
        let motion = roll(&body, &start, &times).unwrap();
        let same = roll_with(&body, Start::from(start).with_time(t0), &times, &Ask::default(), || true)
            .unwrap()
            .unwrap();
        assert_eq!((&motion.states, motion.event), (&same.states, same.event));
        assert_eq!((motion.states[0], motion.ending()), (start, Ending::Face));
    }
    for times in [&[][..], &[f64::NAN], &[f64::INFINITY], &[1.0, 0.5, 2.0]] {
        assert!(matches!(roll(&body, &start, times), Err(Error::OutOfRange { name: "t", .. })), "{times:?}");
    }
}

#[test]
fn a_nearly_flat_start_at_rest_lifts_off_when_it_does() {
    // once this returned no times, no event and no error
    let body = Body::new(10.546343820392982, 286.35101802047467, 0.1818848111866759).unwrap();
    let y = state(3.865140946119193e-06, 5.882624766680439e-07, 0.0, 17.96860430677607);
    for beyond in [false, true] {
        for method in [Method::Exact, Method::Tolerance(1e-10)] {
            let mut ask = by(method);
            ask.beyond = beyond;
            let m = moved(&body, &y, &[1.0, 2.0, 3.3], ask).unwrap();
            let event = m.event.unwrap();
            assert_eq!(event.ending, Ending::LiftOff, "{method:?}");
            assert!((event.time - 0.00753015615484).abs() < m.error.max(1e-11), "{:e}", event.time);
        }
    }
}

#[test]
fn an_event_claims_what_rounding_makes_of_it() {
    // the friction is a difference of numbers a million times as large: the event was once 1.5e-11 late
    let body = Body::new(677.4606718539745, 0.0012135351426975996, 5.704211882778903e-06).unwrap();
    let y = state(0.00011610786680656975, 0.2969581567039679, -0.003377231906356726, 201.17747235318797);
    let m = moved(&body, &y, &[1.0], Ask::default().with_table(Table::Rolling { mu: 0.011121443405316313 }))
        .unwrap();
    let event = m.event.unwrap();
    let off = (event.time - 4.3676495076120934e-05).abs();
    assert!(
        event.ending == Ending::Slip && off <= m.error && m.error < 1e-11,
        "{off:e}, claimed {:e}",
        m.error
    );
    // from just below pi/2, half an ulp of the inclination shifts the time of the landing
    for below in [1e-3, 1e-6, 1e-9] {
        let y = state(FRAC_PI_2 - below, 0.0, -1e-3, 0.0);
        let m = moved(&Body::solid(1.0).unwrap(), &y, &[1.0], Ask::default()).unwrap();
        let event = m.event.unwrap();
        assert_eq!(event.ending, Ending::Side);
        assert!(m.error >= 0.5 * f64::EPSILON / event.state.w2.abs() && m.error < 1e-11, "{:e}", m.error);
    }
}

#[test]
fn a_tolerance_invents_no_end() {
    // a nearly flat passage: steps with an error of 1e-3 once gave a lift-off that does not happen
    let body = Body::tube(0.2947734093393377, 0.15168578916528275).unwrap();
    let y = state(0.703578010474226, 0.00010315400909723418, 0.23710004093643627, 0.0);
    let mut r = wander(23);
    let mut all = vec![(body, y)];
    all.extend((0..300).map(|_| {
        let body = Body::tube(r(), r()).unwrap();
        let slow = if r() < 0.5 { 0.0 } else { 0.3 * (2.0 * r() - 1.0) };
        (body, state(0.05 + 0.75 * r(), 10f64.powf(-3.0 - 1.5 * r()), slow, 0.0))
    }));
    let mut followed = 0;
    for (body, y) in all {
        let exact = moved(&body, &y, &[8.0], Ask::default()).unwrap();
        assert_eq!(exact.method, Method::Exact);
        for tol in [1e-6, 1e-5, 1e-4, 1e-3] {
            let m = moved(&body, &y, &[8.0], by(Method::Tolerance(tol))).unwrap();
            assert_eq!(m.ending(), exact.ending(), "{body:?} {y:?} within {tol:e}");
            followed += 1;
        }
    }
    assert!(followed > 1000, "{followed}");
}
