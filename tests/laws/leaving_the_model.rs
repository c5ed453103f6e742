//! Random motions that leave the range of the model end with an event, and others do not.

use crate::common::{by, drawn, moved, wander, wild};
use spincyl::contact::Table;
use spincyl::contact::slip::Friction;
use spincyl::exact::Swing;
use spincyl::motion::{Ending, Method, Start, roll_with};
use spincyl::{Body, Contact, Error, Slip, State, contact};
use std::f64::consts::{FRAC_PI_2, PI};

/// The first of 400 sampled times up to `t` at which the exact motion has left the model by more than
/// `margin`.
fn leaves(swing: &Swing, body: &Body, contact: Contact, t: f64, margin: f64) -> Option<f64> {
    (0..=400).map(|i| t * f64::from(i) / 400.0).find(|t| {
        let y = swing.state(*t);
        swing.landing(*t).is_some_and(|(limit, _)| t.abs() > limit)
            || (body.ell() > 0.0 && y.theta > FRAC_PI_2 + margin)
            || contact::force(contact, body, &y).normal < -margin
    })
}

fn random_runs(count: u64) -> [u64; 4] {
    let (mut left, mut silent, mut refused, mut false_alarm) = (0, 0, 0, 0);
    let mut r = wander(count);
    for _ in 0..count {
        let (body, y, contact) = wild(&mut r);
        let t = 3.0 * r();
        let method = match (4.0 * r()) as u8 {
            0 => Method::Exact,
            1 => Method::Tolerance(10f64.powf(-5.0 - 5.0 * r())),
            _ => Method::Step(10f64.powf(-3.0 * r() - 0.5)),
        };
        let Ok(swing) = Swing::new(&body, &y, contact) else { continue };
        let leaves_at = leaves(&swing, &body, contact, t, 1e-3);
        match moved(&body, &y, &[t], by(method).with_table(contact)) {
            Err(Error::Step { .. }) => refused += 1,
            Err(e) => panic!("{body:?} {y:?}: {e}"),
            Ok(motion) => {
                let flagged = motion.event.is_some();
                if leaves_at.is_some() {
                    left += 1;
                    if !flagged {
                        silent += 1;
                        println!(
                            "silent: {body:?} {y:?} {contact:?} {method:?} t = {t}, error {:e}",
                            motion.error
                        );
                    }
                } else if let Some(e) = motion.event
                    && motion.error < 1e-6
                    && e.time > 0.0
                {
                    // an event must not be a false alarm: the exact motion is at that limit then
                    let near = swing.state(e.time);
                    let normal = contact::force(contact, &body, &near).normal;
                    let true_alarm = match e.ending {
                        Ending::LiftOff => normal.abs() < 1e-2,
                        Ending::Side => (near.theta - FRAC_PI_2).abs() < 1e-3,
                        _ => near.theta.min(PI - near.theta) < 1e-3,
                    };
                    if !true_alarm {
                        println!("false alarm: {body:?} {y:?} {contact:?} {method:?} {e:?}, N = {normal}");
                        false_alarm += 1;
                    }
                }
            }
        }
    }
    [left, silent, refused, false_alarm]
}

#[test]
fn a_run_that_leaves_the_model_says_so() {
    let [left, silent, _, false_alarms] = random_runs(drawn(4_000) as u64);
    assert!(
        left > drawn(1000) as u64 && silent == 0 && false_alarms == 0,
        "{left} left, {silent} silent, {false_alarms} false"
    );
}

/// A grazing slip ends while its series holds, where its speed, and a margin with it, is zero up to rounding.
#[test]
fn a_slip_that_hardly_begins_takes_no_tiny_steps_to_its_end() {
    let (ell, i1, i3) = (6.0, 12.41, 0.82);
    let body = Body::new(ell, i1, i3).unwrap();
    let friction = Table::Rubs(Friction::coulomb(0.2));
    let ask = by(Method::Tolerance(1e-10)).with_table(friction);
    let mut grazing = 0;
    for k in 0..100 {
        let w1 = 3.180_904_52 * (1.0 + 1e-11 * f64::from(k));
        let state =
            State { theta: FRAC_PI_2, w1, w2: 0.0, w3: (1.05 + 0.55 * 129.0 / 199.0) * ell / (i3 * w1) };
        let start = Start::from(state).with_slip(Slip::new(0.0, (ell - i1 / ell) * w1 - state.w3));
        let motion = roll_with(&body, start, &[0.0, 46.0], &ask, || true).unwrap().unwrap();
        let phases = &motion.path.as_ref().unwrap().phases;
        grazing += usize::from(phases.len() == 3 && phases[2].time - phases[1].time < 0.01);
        assert!(motion.evaluations < 20_000, "{} evaluations, {phases:?}", motion.evaluations);
    }
    assert_eq!(grazing, 100);
}

#[test]
#[ignore = "long: a million runs, minutes"]
fn long_a_million_random_runs_that_leave_the_model_say_so() {
    let [left, silent, refused, false_alarms] = random_runs(1_000_000);
    println!(
        "{left} of 1000000 left the model, {silent} of them silently; {refused} steps refused, {false_alarms} false alarms"
    );
    assert_eq!((silent, false_alarms), (0, 0));
}
