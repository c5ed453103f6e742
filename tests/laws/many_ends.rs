//! The ends of many motions at once, which SIMD lanes compute, compared with those of single motions.

use crate::common::many::Many;
use crate::common::{distance, moved, numbers, wander, wild};
use spincyl::contact::Table;
use spincyl::ensemble::{Answer, Job, Summary};
use spincyl::motion::{Ask, Ending};
use spincyl::{Body, Contact, State};

/// Random starts of solid cylinders with N > 0; five in six of these motions end.
fn pressing(count: usize, slower: f64) -> Vec<(Body, State)> {
    let mut r = wander(5);
    let mut normal = move || {
        let (a, b) = (r(), r());
        ((-2.0 * (1.0 - a).ln()).sqrt() * (core::f64::consts::TAU * b).cos(), b, a)
    };
    let mut all = Vec::new();
    while all.len() < count {
        let [(w1, a, b), (w2, ..), (w3, ..)] = [normal(), normal(), normal()];
        let body = Body::solid(0.1 + 2.9 * a).unwrap();
        let y = State { theta: 0.1 + 1.4 * b, w1: slower * w1, w2: slower * w2, w3: slower * w3 };
        if spincyl::contact::force(Contact::Rolling, &body, &y).normal > 0.0 {
            all.push((body, y));
        }
    }
    all
}

/// Compares every motion with the single motion from its start; returns the share that SIMD lanes have computed.
fn as_alone(all: &[(Body, State)], job: &Job<'_>) -> f64 {
    let many = Many::of(all).run(job, 2);
    let ask = job.ask;
    let mut lanes = 0;
    for (i, (body, start)) in all.iter().enumerate() {
        lanes += usize::from(many.method[i] == Answer::Lanes as u8);
        let alone = moved(body, start, job.times, ask);
        let Ok(alone) = alone else { continue };
        let ending = alone.event.filter(|e| !job.ask.beyond || e.ending == Ending::Face);
        let status = ending.map_or(Ending::Done, |e| e.ending);
        assert_eq!(many.status[i], status as u8, "{body:?} {start:?} {:?}", alone.event);
        let claimed = 2.0 * (many.error[i] + alone.error) + 1e-15;
        let (last, end) = ending.map_or_else(
            || (*alone.states.last().unwrap(), job.times[job.times.len() - 1]),
            |e| (e.state, e.time),
        );
        let off = distance(&many.last(i), &numbers(&last));
        assert!(off <= claimed, "{body:?} {start:?} {status:?}: state {off} > {claimed}");
        let off = (many.sum(Summary::End, i) - end).abs();
        assert!(off <= claimed, "{body:?} {start:?} {status:?}: time {off} > {claimed}");
        for (j, t) in job.times.iter().enumerate() {
            let y = many.at(i, j);
            match alone.states.get(j).filter(|_| t.abs() <= end.abs()) {
                Some(other) => {
                    let off = distance(&y, &numbers(other));
                    assert!(off <= claimed, "{body:?} {start:?} at {t}: {off} > {claimed}");
                }
                None => assert!(y.theta.is_nan(), "{body:?} {start:?} at {t}"),
            }
        }
    }
    lanes as f64 / all.len() as f64
}

#[test]
fn motions_that_end_end_in_lanes_as_they_do_alone() {
    let times = [20.0];
    let share = as_alone(&pressing(4000, 1.0), &Job::new(&times));
    assert!(share > 0.99, "{share}");
}

#[test]
fn slow_motions_and_motions_that_slip_end_in_lanes_as_they_do_alone() {
    let times = [1.0, 8.0, 20.0];
    for (slower, mu) in [(0.2, f64::INFINITY), (1.0, 0.3), (0.5, 1.0), (3.0, 0.1)] {
        let share =
            as_alone(&pressing(800, slower), &Job::new(&times).with_ask(Ask::on(Table::Rolling { mu })));
        assert!(share > 0.97, "{slower} {mu}: {share}");
    }
}

#[test]
fn backwards_they_end_as_well() {
    let times = [-3.0, -20.0];
    let share = as_alone(&pressing(800, 1.0), &Job::new(&times));
    assert!(share > 0.99, "{share}");
}

#[test]
fn starts_that_nobody_would_choose_end_as_they_do_alone() {
    // `wild` starts: at rest, almost at rest, with one decimal, beyond a right angle; rolling and smooth
    let mut r = wander(11);
    let all: Vec<_> = (0..4000).map(|_| wild(&mut r)).collect();
    let times = [10.0];
    for contact in [Contact::Rolling, Contact::Smooth] {
        let some: Vec<_> = all.iter().filter(|x| x.2 == contact).map(|x| (x.0, x.1)).collect();
        let share = as_alone(&some, &Job::new(&times).with_ask(Ask::on(contact)));
        assert!(share > 0.9, "{contact:?}: {share}");
    }
}

#[test]
fn bodies_that_do_not_spin_fall_flat_or_on_their_side() {
    let times = [20.0];
    let mut r = wander(3);
    let all: Vec<_> = (0..400)
        .map(|_| {
            (
                Body::tube(3.0 * r(), r()).unwrap(),
                State { theta: 0.02 + 1.5 * r(), w1: 0.0, w2: 0.0, w3: 0.0 },
            )
        })
        .collect();
    let share = as_alone(&all, &Job::new(&times));
    assert!(share > 0.99, "{share}");
    let many = Many::of(&all).run(&Job::new(&times), 1);
    let ended = |ending: Ending| many.status.iter().filter(|x| **x == ending as u8).count();
    assert!(ended(Ending::Face) > 50 && ended(Ending::Side) > 50);
}

#[test]
fn motions_that_touch_the_end_of_contact_are_right_on_either_side_of_it() {
    // bisection for the factor of w at which a motion just lifts off; then starts a little below and above
    // that
    let times = [20.0];
    let lifts =
        |body: &Body, y: &State| moved(body, y, &times, Ask::default()).unwrap().ending() == Ending::LiftOff;
    let scaled = |y: &State, by: f64| State { w1: by * y.w1, w2: by * y.w2, w3: by * y.w3, ..*y };
    let mut near = Vec::new();
    for (body, y) in pressing(300, 1.0) {
        let (mut low, mut high) = (1.0, 1.3);
        if lifts(&body, &y) || !lifts(&body, &scaled(&y, high)) {
            continue;
        }
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if lifts(&body, &scaled(&y, middle)) { high = middle } else { low = middle }
        }
        for off in [1e-2, 1e-4, 1e-6, 1e-8] {
            near.extend([-off, off].map(|off| (body, scaled(&y, high * (1.0 + off)))));
        }
    }
    assert!(near.len() > 80, "{}", near.len());
    as_alone(&near, &Job::new(&times));
}

#[test]
fn what_sums_up_a_motion_is_the_same_in_lanes_and_alone() {
    use spincyl::exact::Swing;
    use spincyl::rolling;
    let all = pressing(150, 1.0);
    let times = [20.0];
    let many = Many::of(&all).run(&Job::new(&times), 1);
    let (mut lanes, mut pressed) = (0, 0);
    for (i, (body, start)) in all.iter().enumerate() {
        if many.method[i] != Answer::Lanes as u8 {
            continue;
        }
        lanes += 1;
        let swing = Swing::with_pose(body, start, Contact::Rolling).unwrap();
        let end = many.sum(Summary::End, i);
        // five thousand samples of the motion
        let (mut low, mut high, mut least, mut most) = (start.theta, start.theta, f64::INFINITY, 0f64);
        for k in 0..=5_000 {
            let y = swing.state(end * f64::from(k) / 5_000.0);
            (low, high) = (low.min(y.theta), high.max(y.theta));
            let force = spincyl::contact::force(Contact::Rolling, body, &y);
            least = least.min(force.normal);
            most = most.max(if force.normal > 0.0 { force.friction() / force.normal } else { f64::INFINITY });
        }
        let close = |kind: Summary, x: f64, within: f64| {
            let off = (many.sum(kind, i) - x).abs();
            assert!(
                off <= within * (1.0 + x.abs()),
                "{kind:?} {body:?} {start:?}: {} {x}",
                many.sum(kind, i)
            );
        };
        // between two samples the extremes may be a little larger
        let energy = 1.0 + rolling::energy(body, start);
        close(Summary::ThetaMin, low, 1e-5 * energy);
        close(Summary::ThetaMax, high, 1e-5 * energy);
        close(Summary::NormalMin, least, 1e-3 * energy);
        assert!(many.sum(Summary::NormalMin, i) <= least + 1e-9);
        // where N is small the friction coefficient has a peak that is narrower than the sampling
        let needed = many.sum(Summary::FrictionCoefficientMax, i);
        assert!(needed >= most * (1.0 - 1e-9) || many.status[i] == Ending::LiftOff as u8);
        if least > 0.1 {
            close(Summary::FrictionCoefficientMax, most, 1e-3 * energy);
            pressed += 1;
        }
        assert!((needed == f64::INFINITY) == (many.status[i] == Ending::LiftOff as u8), "{needed}");
        close(Summary::Period, swing.period(), 1e-10);
        close(Summary::PrecessionPerPeriod, swing.angles_per_period().unwrap().precession, 1e-10);
    }
    assert!(lanes > 145 && pressed > 25, "{lanes} {pressed}");
}
