//! Motions that need too many evaluations, or that their caller interrupts: bodies and stones have the same ending,
//! the motion up to it, and the limit.

use crate::common::many::body_columns;
use crate::common::{path_of, state};
use spincyl::contact::{Friction, Table, TableKind};
use spincyl::ensemble::{Job, LossColumns, MotionOutput, MotionStarts, Summary, roll};
use spincyl::loss::{Law, Losses};
use spincyl::motion::{AboveTable, Ask, Ending, Limit, Method, Motion, Moving, Start, roll_with};
use spincyl::stone::{self, Ellipsoid};
use spincyl::{Body, Slip, State, steady};

/// A ball that slips and rolls under friction and air; like the stone of `stone` it has no end.
fn ball() -> (Body, Start, Ask) {
    let start = Start::from(state(1.0, 0.3, 0.1, 4.0)).with_slip(Slip::new(0.5, 1.0));
    let ask = Ask::on(Friction::coulomb(0.1)).with_losses(Losses::of(Law::AirLinear, 1e-4));
    (Body::ball(-0.1, 0.41, 0.4).unwrap(), start, ask)
}

fn rattleback() -> Ellipsoid {
    Ellipsoid::rattleback([1.0, 0.2, 0.17], None, 0.035, None).unwrap()
}

fn times(count: u32) -> Vec<f64> {
    (0..count).map(|i| 0.05 * f64::from(i)).collect()
}

/// Checks that the motion that stops after `most` evaluations has the outputs of the whole motion up to there, and
/// that its event is a state of the whole motion, which a motion to the time of the event shows.
fn is_the_beginning<S: Moving>(
    whole: &Motion<S>,
    part: &Motion<S>,
    to: &mut dyn FnMut(f64) -> Motion<S>,
    most: u64,
) {
    assert_eq!((part.ending(), part.limit), (Ending::Bounded, Some(Limit::Evaluations)));
    // The series of a slow slip counts as a hundred evaluations, and is never used in part.
    assert!(part.evaluations >= most && part.evaluations < most + 300, "{} of {most}", part.evaluations);
    let count = part.states.len();
    assert!(count > 2 && count < whole.states.len(), "{count}");
    for (a, b) in part.states.iter().zip(&whole.states) {
        assert_eq!(a, b);
    }
    let event = part.event.unwrap();
    assert!(whole.times[count - 1] <= event.time && event.time < whole.times[count]);
    let there = to(event.time);
    let off = event.state.distance(there.states.last().unwrap());
    assert!(
        off <= part.error + there.error && part.error < 1e-8,
        "{off:e} {:e} {:e}",
        part.error,
        there.error
    );
}

#[test]
fn a_body_and_a_stone_that_spend_their_evaluations_end_where_they_are() {
    let (body, start, ask) = ball();
    let rolled = |times: &[f64], ask: &Ask| roll_with(&body, start, times, ask, || true).unwrap().unwrap();
    let (all, most) = (times(400), 3_000);
    let (whole, part) = (rolled(&all, &ask), rolled(&all, &ask.with_max_evaluations(most)));
    assert_eq!((whole.ending(), whole.limit), (Ending::Done, None));
    is_the_beginning(&whole, &part, &mut |t| rolled(&[t], &ask), most);
    assert_eq!(path_of(&part).phases[..], path_of(&whole).phases[..path_of(&part).phases.len()]);
    let stone = rattleback();
    for ask in [Ask::default(), Ask::on(Friction::coulomb(0.3))] {
        let spins = stone.spinning(-0.5, 1e-2, 1e-2);
        let rolled =
            |times: &[f64], ask: &Ask| stone::roll(&stone, spins, times, ask, || true).unwrap().unwrap();
        let (whole, part) = (rolled(&all, &ask), rolled(&all, &ask.with_max_evaluations(most)));
        assert_eq!((whole.ending(), whole.limit), (Ending::Done, None));
        is_the_beginning(&whole, &part, &mut |t| rolled(&[t], &ask), most);
    }
}

#[test]
fn steps_of_fixed_length_and_steps_within_a_tolerance_obey_the_same_limit() {
    let body = Body::solid(1.0).unwrap();
    let start = steady::state(&body, 1.1).unwrap().kicked(0.05);
    for (method, most) in [(Method::Step(1e-3), 4_000), (Method::Tolerance(1e-10), 400)] {
        let ask = Ask::default().with_method(method);
        let whole = roll_with(&body, start, &times(400), &ask, || true).unwrap().unwrap();
        let part =
            roll_with(&body, start, &times(400), &ask.with_max_evaluations(most), || true).unwrap().unwrap();
        assert_eq!((part.ending(), part.limit), (Ending::Bounded, Some(Limit::Evaluations)), "{method:?}");
        assert!(part.evaluations <= most + 40, "{method:?} {}", part.evaluations);
        assert!(part.states.len() > 2 && part.states.len() < whole.states.len());
        assert!(
            part.states.iter().zip(&whole.states).all(|(a, b)| a.distance(b) <= part.error + whole.error)
        );
    }
    // The first integrals need no evaluations.
    let ask = Ask::default().with_max_evaluations(1);
    assert_eq!(roll_with(&body, start, &[1e3], &ask, || true).unwrap().unwrap().ending(), Ending::Done);
}

#[test]
fn beyond_its_events_a_motion_is_given_up_too() {
    let (ball, spun) = (Body::ball(-0.1, 0.41, 0.4).unwrap(), state(1.0, 0.0, 0.0, 2e3));
    let ask = Ask::on(Table::Smooth).with_losses(Losses::of(Law::AirLinear, 1e-12)).with_beyond();
    let m = roll_with(&ball, spun, &[150.0], &ask.with_max_evaluations(5_000), || true).unwrap().unwrap();
    assert_eq!((m.ending(), m.limit), (Ending::Bounded, Some(Limit::Evaluations)));
    let stone = Ellipsoid::uniform([1.0, 1.0, 1.0]).unwrap();
    let ask = Ask::default().with_beyond().with_max_evaluations(5_000);
    let m = stone::roll(&stone, stone.spinning(2e3, 0.0, 0.0), &[1e3], &ask, || true).unwrap().unwrap();
    assert_eq!(m.limit, Some(Limit::Evaluations));
}

#[test]
fn an_interrupted_motion_is_the_motion_up_to_there() {
    let (body, start, ask) = ball();
    let whole = roll_with(&body, start, &times(8000), &ask, || true).unwrap().unwrap();
    let mut looks = 0;
    let part = roll_with(&body, start, &times(8000), &ask, || {
        looks += 1;
        looks < 3
    });
    let part = part.unwrap().unwrap();
    assert_eq!(
        (part.ending(), part.limit, part.error),
        (Ending::Bounded, Some(Limit::Interrupted), f64::INFINITY)
    );
    assert!(!part.states.is_empty() && part.states.len() < whole.states.len());
    assert!(part.states.iter().zip(&whole.states).all(|(a, b)| a == b));
    assert!(part.event.unwrap().time >= *part.times.last().unwrap());
    // While its error is estimated the motion is already complete.
    let rolled_while = |most: u32| {
        let mut looks = 0;
        let go_on = || {
            looks += 1;
            looks <= most
        };
        let m = roll_with(&body, start, &times(8000), &ask, go_on).unwrap().unwrap();
        (m, looks)
    };
    let (_, looks) = rolled_while(u32::MAX);
    let (judged, _) = rolled_while(looks - 1);
    let ended = (judged.ending(), judged.limit, judged.error);
    assert_eq!(ended, (whole.ending(), Some(Limit::Interrupted), f64::INFINITY));
    assert_eq!(judged.states, whole.states);
    // Motions by their first integrals and by steps end at the last output that they have.
    let tube = Body::solid(2.5).unwrap();
    let nods = steady::state(&tube, 1.3).unwrap().kicked(0.05);
    for ask in [
        Ask::default().with_pose(),
        Ask::default().with_force(),
        Ask::default().with_method(Method::Tolerance(1e-9)),
    ] {
        let all: Vec<f64> = (0..100_000).map(|i| 0.01 * f64::from(i)).collect();
        let whole = roll_with(&tube, nods, &all, &ask, || true).unwrap().unwrap();
        let mut looks = 0;
        let part = roll_with(&tube, nods, &all, &ask, || {
            looks += 1;
            looks < 3
        });
        let part = part.unwrap().unwrap();
        let count = part.states.len();
        assert_eq!((part.ending(), part.limit), (Ending::Bounded, Some(Limit::Interrupted)));
        assert!(count > 100 && count < all.len() && part.times == all[..count], "{count}");
        assert!(part.states.iter().zip(&whole.states).all(|(a, b)| a.distance(b) <= whole.error + 1e-9));
        assert!(part.poses.as_ref().is_none_or(|poses| poses.len() == count));
        assert!(part.forces.as_ref().is_none_or(|forces| forces.len() == count));
    }
    let stone = rattleback();
    let mut looks = 0;
    let part = stone::roll(&stone, stone.spinning(-0.5, 1e-2, 1e-2), &times(8000), &Ask::default(), || {
        looks += 1;
        looks < 3
    });
    let part = part.unwrap().unwrap();
    assert!(part.is_interrupted() && !part.states.is_empty() && part.states.len() < 8000);
    // Before its first step a motion has nothing to return.
    let forces = Ask::default().with_force().with_method(Method::Tolerance(1e-9));
    assert!(
        roll_with(&tube, nods, &times(8000), &forces, || false).unwrap().is_none_or(|m| m.is_interrupted())
    );
}

#[test]
fn each_limit_has_its_reason_in_words() {
    let mut reasons: Vec<&str> = Limit::ALL.iter().map(|limit| limit.reason()).collect();
    reasons.sort_unstable();
    reasons.dedup();
    assert_eq!(reasons.len(), Limit::ALL.len());
    let ball = Body::ball(0.0, 0.4, 0.4).unwrap();
    let bounces =
        Start::from(State { theta: 1.0, w1: 0.0, w2: 0.0, w3: 0.0 }).with_aloft(AboveTable::new(1e-6, 0.0));
    let ask = Ask::on(Friction::coulomb(0.3)).with_restitution(1.0);
    let m = roll_with(&ball, bounces, &[1e3], &ask, || true).unwrap().unwrap();
    assert_eq!((m.ending(), m.limit), (Ending::Bounded, Some(Limit::Impacts)));
    let tube = Body::tube(6.0, 0.8).unwrap();
    let (w1, w3, mu) = (3.392822265625, 3.324289864719004, 0.20241508483886717);
    let slips = Start::from(State { theta: std::f64::consts::FRAC_PI_2, w1, w2: 0.0, w3 });
    let slips = slips.with_slip(Slip::new(0.0, (6.0 - tube.i1() / 6.0) * w1 - w3));
    let ask = Ask::on(Friction::coulomb(mu)).with_method(Method::Tolerance(1e-9));
    let m = roll_with(&tube, slips, &[2e5], &ask, || true).unwrap().unwrap();
    assert_eq!((m.ending(), m.limit), (Ending::Bounded, Some(Limit::Changes)));
}

#[test]
fn a_sweep_gives_up_where_a_single_motion_does() {
    let (body, start, ask) = ball();
    let State { theta, w1, w2, w3 } = start.state;
    let (count, most, lost) = (24, 3_000, [1e-4]);
    let w3: Vec<f64> = (0..count).map(|i| w3 + 0.1 * f64::from(i)).collect();
    let numbers = [body.ell(), body.i1(), body.i3(), body.fillet(), body.theta_end()].map(|x| [x]);
    let (theta, w1, w2) = ([theta], [w1], [w2]);
    for table in [Table::Smooth, Table::default()] {
        let states: [&[f64]; 4] = [&theta, &w1, &w2, &w3];
        let starts = MotionStarts::new(body_columns(numbers.each_ref().map(|x| &x[..])), states)
            .with_losses(LossColumns::NONE.with(Law::AirLinear, &lost));
        let (mut error, mut end) = (vec![0.0; w3.len()], vec![0.0; w3.len()]);
        let (mut method, mut status) = (vec![0; w3.len()], vec![0; w3.len()]);
        let kind = if table == Table::Smooth { TableKind::Smooth } else { TableKind::Rolling };
        let job = Job::new(&[60.0]).with_ask(Ask::on(kind).with_max_evaluations(most)).with_tol(1e-13);
        let out =
            MotionOutput::new(&mut error, &mut method, &mut status).with_summary(Summary::End, &mut end);
        assert!(roll(&starts, &job, out, 1, |_| true).unwrap());
        let ask = ask.with_table(table).with_method(Method::Tolerance(1e-13)).with_max_evaluations(most);
        for (i, w3) in w3.iter().enumerate() {
            let start = State { w3: *w3, ..start.state };
            let one = roll_with(&body, start, &[60.0], &ask, || true).unwrap().unwrap();
            assert_eq!((status[i], one.ending()), (Ending::Bounded as u8, Ending::Bounded));
            let by = one.event.unwrap().time;
            // The steps in lanes need not be the same.
            assert!(end[i] > 0.0 && (end[i] - by).abs() < 0.1 * by, "{} {by}", end[i]);
        }
    }
}
