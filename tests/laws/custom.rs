//! User-defined laws: the same motions as under the library's laws, the balance of energy, and errors.

use crate::common::{drawn, wander};
use spincyl::contact::{Contact, Table, lossy, slip::Friction};
use spincyl::custom::{self, Custom};
use spincyl::loss::{Law, Losses};
use spincyl::motion::{Ask, Ending, Limit, Method, Motion, Start, roll_with};
use spincyl::{Body, Error, Slip, State, newton, steady};
use std::cell::Cell;
use std::f64::consts::FRAC_PI_2;

/// A random body, start (which may slip) and table.
fn any(r: &mut impl FnMut() -> f64) -> (Body, Start, Table) {
    let body = match (5.0 * r()) as u8 {
        4 => Body::ball(0.1, 0.4, 0.42).and_then(|ball| ball.with_theta_end(1.2 + r())),
        0 => Body::ball(0.4 * r() - 0.2, 0.4, 0.42),
        1 => Body::solid(0.02 + 0.5 * r()),
        2 => Body::tube(0.5 + 2.0 * r(), 0.8 * r()),
        _ => Body::rounded_tube(0.4 + r(), 0.0, 0.05 + 0.3 * r()),
    };
    let mut speed = || 3.0 * r() - 1.5;
    let (w1, w2, w3, slip) = (speed(), 0.3 * speed(), 2.0 * speed(), [speed(), speed()]);
    let state = State { theta: 0.4 + r(), w1, w2, w3 };
    let (table, slips) = match (5.0 * r()) as u8 {
        0 => (Friction::coulomb(0.1 + 0.4 * r()).into(), true),
        1 => (Friction::coulomb(0.1 + 0.4 * r()).into(), false),
        2 => (Friction::Viscous { c: 0.1 + r() }.into(), true),
        3 => (Table::Rolling { mu: 0.2 + r() }, false),
        _ => (Table::of(Contact::Smooth, 0.0), false),
    };
    (body.unwrap(), Start::from(state).with_slip(if slips { slip.into() } else { Slip::default() }), table)
}

/// The largest difference of states, slips and ends of two motions, and the sum of their estimated errors.
fn apart(a: &Motion, b: &Motion) -> [f64; 2] {
    assert_eq!(a.ending(), b.ending());
    let mut off = a.event.zip(b.event).map_or(0.0, |(a, b)| (a.time - b.time).abs());
    for (a, b) in a.states.iter().zip(&b.states) {
        let by = [a.theta - b.theta, a.w1 - b.w1, a.w2 - b.w2, a.w3 - b.w3];
        off = by.iter().fold(off, |most: f64, x| most.max(x.abs()));
    }
    [off, a.error + b.error]
}

fn own(body: &Body, start: Start, times: &[f64], ask: &Ask, laws: Custom<'_>) -> Result<Motion, Error> {
    custom::roll_with(body, start, times, ask, laws, || true).map(|found| found.expect("not interrupted"))
}

#[test]
fn a_couple_of_the_air_that_a_user_writes_moves_a_body_as_that_of_the_library_does() {
    let mut r = wander(5304);
    let times: Vec<f64> = (0..=20).map(|i| 0.2 * f64::from(i)).collect();
    let mut ended = 0;
    // The forces of slow slips, whose directions have larger errors, are rare.
    for _ in 0..450 {
        let (body, start, table) = any(&mut r);
        let (b, b2) = (0.1 * r(), 0.05 * r());
        let air = |_: &Body, y: &State, _: f64| {
            let w = [y.w1, y.w2, y.w3];
            let fast = w.iter().map(|x| x * x).sum::<f64>().sqrt();
            w.map(|x| -(b + b2 * fast) * x)
        };
        let losses = Losses::of(Law::AirLinear, b) + Losses::of(Law::AirQuadratic, b2);
        let ask = Ask::on(table).with_pose().with_force();
        let theirs = own(&body, start, &times, &ask, Custom::default().with_couple(&air)).unwrap();
        let ours = roll_with(&body, start, &times, &ask.with_losses(losses), || true).unwrap().unwrap();
        let [off, claimed] = apart(&theirs, &ours);
        assert!(off <= claimed.max(1e-11), "{body:?} {start:?} {table:?}: {off:e} of {claimed:e}");
        assert!(claimed < 1e-5, "{body:?} {start:?} {table:?}: {claimed:e}");
        let path = [&theirs, &ours].map(|m| m.path.as_ref().unwrap());
        assert!((path[0].heat - path[1].heat).abs() < 1e-8 + 10.0 * claimed);
        assert!((path[0].lost - path[1].lost).abs() < 1e-8 + 10.0 * claimed);
        let poses = [&theirs, &ours].map(|m| m.poses.as_ref().unwrap());
        for (a, b) in poses[0].iter().zip(poses[1]) {
            let off = (a.contact_point - b.contact_point).norm();
            assert!(off < 1e-8 + 100.0 * claimed, "{body:?} {start:?} {table:?}: {off:e} of {claimed:e}");
        }
        let forces = [&theirs, &ours].map(|m| m.forces.as_ref().unwrap());
        // Where the body leaves the table at its start no force presses it down.
        for (a, b) in forces[0].iter().zip(forces[1]).filter(|(a, _)| a.normal > 0.0) {
            let off =
                (a.normal - b.normal).abs().max((a.along - b.along).abs()).max((a.across - b.across).abs());
            assert!(off <= theirs.force_error + ours.force_error, "{body:?} {start:?} {table:?}: {off:e}");
        }
        ended += usize::from(theirs.ending() != Ending::Done);
    }
    assert!(ended > 20, "{ended} motions have an end before the last time");
}

#[test]
fn a_constant_coefficient_that_a_user_writes_is_coulombs_friction() {
    let mut r = wander(5302);
    let times: Vec<f64> = (0..=20).map(|i| 0.3 * f64::from(i)).collect();
    let mut phases = 0;
    for _ in 0..drawn(300) {
        let (body, start, _) = any(&mut r);
        let (mu, more) = (0.05 + 0.3 * r(), if r() < 0.5 { 0.0 } else { 0.1 });
        let constant = move |_: f64| mu;
        let table = Table::from(Friction::Coulomb { mu, fixed: mu + more, patch: 0.0 });
        // The coefficient of the table itself does not count.
        let other = Table::from(Friction::Coulomb { mu: 0.5 * mu, fixed: mu + more, patch: 0.0 });
        let theirs =
            own(&body, start, &times, &Ask::on(other), Custom::default().with_friction(&constant)).unwrap();
        let ours = roll_with(&body, start, &times, &Ask::on(table), || true).unwrap().unwrap();
        let [off, claimed] = apart(&theirs, &ours);
        assert!(off <= claimed.max(1e-11), "{body:?} {start:?} {table:?}: {off:e} of {claimed:e}");
        let both = [&theirs, &ours].map(|m| m.path.as_ref().unwrap().phases.len());
        assert_eq!(both[0], both[1], "{body:?} {start:?} {table:?}");
        phases += both[0];
    }
    assert!(phases > 110, "{phases} phases");
}

#[test]
fn rolling_resistance_rounded_by_a_user_tends_to_that_of_the_library() {
    // Its couple is proportional to the normal force, which it changes.
    let body = Body::solid(1.2).unwrap();
    let start = Start::from(State { theta: 1.1, w1: 0.8, w2: 0.4, w3: 1.5 });
    let (times, delta) = ([0.0, 0.5, 1.0, 1.5], 0.02);
    let losses = Losses::of(Law::RollingResistance, delta);
    let ours =
        roll_with(&body, start, &times, &Ask::default().with_losses(losses), || true).unwrap().unwrap();
    let off = |e: f64| {
        let rounded = move |_: &Body, y: &State, normal: f64| {
            let (s, c) = y.theta.sin_cos();
            let (rolling, rocking) = (c * y.w1 - s * y.w3, y.w2);
            let per = -(delta * normal) / (rolling * rolling + rocking * rocking + e * e).sqrt();
            [per * rolling * c, per * rocking, -(per * rolling * s)]
        };
        let theirs =
            own(&body, start, &times, &Ask::default(), Custom::default().with_couple(&rounded)).unwrap();
        apart(&theirs, &ours)[0]
    };
    let [far, near] = [off(1e-1), off(1e-2)];
    assert!(far < 1e-2 && near < 0.02 * far && near > 0.005 * far, "{far:e} {near:e}: of order e^2");
}

#[test]
fn energy_heat_and_work_of_a_law_that_is_proportional_to_the_force_keep_their_sum() {
    let mut r = wander(5303);
    for _ in 0..drawn(180) {
        let (body, start, table) = any(&mut r);
        let c = 0.1 * r();
        let cubic = move |_: &Body, y: &State, normal: f64| {
            let square = y.w1 * y.w1 + y.w2 * y.w2 + y.w3 * y.w3;
            [y.w1, y.w2, y.w3].map(|x| -c * (normal + normal * normal) * square * x)
        };
        let falling = |speed: f64| 0.1 + 0.3 / (1.0 + speed * speed);
        let slips = matches!(table, Table::Rubs(Friction::Coulomb { .. }));
        let laws = Custom::default().with_couple(&cubic);
        let (laws, table) =
            if slips { (laws.with_friction(&falling), Friction::coulomb(0.4).into()) } else { (laws, table) };
        let ask = Ask::on(table).with_method(Method::Tolerance(1e-11));
        let m = own(&body, start, &[0.0, 0.5, 1.0, 2.0], &ask, laws).unwrap();
        let path = m.path.as_ref().unwrap();
        let sum = |i: usize| {
            let energy = match table {
                Table::Smooth => Contact::Smooth.energy(&body, &m.states[i]),
                _ => spincyl::contact::slip::energy(&body, &m.states[i], path.slip[i]),
            };
            energy + path.dissipated[i] + path.work_lost[i]
        };
        for i in 1..m.states.len() {
            assert!(
                (sum(i) - sum(0)).abs() < 1e-9 * (1.0 + sum(0)),
                "{body:?} {start:?} {table:?}: {:e}",
                sum(i) - sum(0)
            );
            assert!(path.work_lost[i] >= path.work_lost[i - 1]);
        }
    }
}

#[test]
fn a_hoop_under_stribecks_friction_slips_for_the_integral_of_the_inverse_coefficient() {
    // u' = -2 mu(u) for a thin hoop, so that the slip lasts for the integral of du/(2 mu) from 0 to u.
    let stribeck = |speed: f64| 0.2 + 0.2 * (-(speed / 0.7f64).powi(2)).exp();
    let hoop = Body::tube(0.0, 1.0).unwrap();
    let state = State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3: -3.0 };
    let start = Start::from(state).with_slip(Slip::new(0.0, 5.0));
    let ask = Ask::on(Friction::coulomb(0.4)).with_method(Method::Tolerance(1e-12));
    let m = own(&hoop, start, &[0.0, 20.0], &ask, Custom::default().with_friction(&stribeck)).unwrap();
    let (mut lasts, n) = (0.0, 4000);
    for i in 0..n {
        let at = |x: f64| 0.5 / stribeck(5.0 * (f64::from(i) + x) / f64::from(n));
        lasts += (at(0.0) + 4.0 * at(0.5) + at(1.0)) / 6.0 * 5.0 / f64::from(n);
    }
    let phases = &m.path.as_ref().unwrap().phases;
    assert!((phases[1].time - lasts).abs() < 1e-10, "{} {lasts}", phases[1].time);
}

#[test]
fn a_law_that_gives_energy_or_has_a_step_is_refused_by_name() {
    let body = Body::solid(1.2).unwrap();
    let start = Start::from(State { theta: 1.1, w1: 0.8, w2: 0.4, w3: 1.5 });
    let refused = |laws: Custom<'_>, ask: Ask| match own(&body, start, &[0.0, 1.0], &ask, laws) {
        Err(Error::OutOfRange { name, expected, .. }) => (name, expected),
        other => panic!("{other:?}"),
    };
    let with = |law: &dyn custom::CoupleLaw| refused(Custom::default().with_couple(law), Ask::default());
    let gives = |_: &Body, y: &State, _: f64| [0.1 * y.w1, -y.w2, -y.w3];
    assert_eq!(with(&gives).1, "a couple that takes energy, m.w <= 0");
    let dry = |_: &Body, y: &State, normal: f64| [0.0, 0.0, -0.1 * normal * y.w3.signum()];
    assert!(with(&dry).1.contains("tanh"));
    let nan = |_: &Body, y: &State, _: f64| [-y.w1, -y.w2, -y.w3 * (y.w3 + 5.0).sqrt()];
    assert_eq!(with(&nan).1, "a couple that is finite in every state");
    let rubs = |law: &dyn custom::FrictionLaw| {
        refused(Custom::default().with_friction(law), Ask::on(Friction::coulomb(0.3)))
    };
    assert_eq!(rubs(&|speed: f64| 0.3 - speed).0, "mu");
    assert_eq!(rubs(&|speed: f64| if speed < 1.0 { 0.3 } else { 0.1 }).0, "mu");
    assert_eq!(rubs(&|_: f64| 0.4).0, "static");
    let kind = |speed: f64| 0.2 + 0.0 * speed;
    assert_eq!(refused(Custom::default().with_friction(&kind), Ask::default()).0, "contact");
    let patch = Friction::Coulomb { mu: 0.2, fixed: 0.2, patch: 0.05 };
    assert_eq!(refused(Custom::default().with_friction(&kind), Ask::on(patch)).0, "patch");
    assert_eq!(refused(Custom::default(), Ask::default().with_beyond()).0, "beyond");
}

/// A user-defined couple that counts its calls after the library's check, which ends at the first call with the
/// initial state.
fn counted<'a>(
    calls: &'a Cell<u64>,
    start: State,
    law: impl Fn(&State) -> [f64; 3] + 'a,
) -> impl Fn(&Body, &State, f64) -> [f64; 3] + 'a {
    move |_: &Body, y: &State, _: f64| {
        calls.set(if *y == start && calls.get() == 0 || calls.get() > 0 { calls.get() + 1 } else { 0 });
        law(y)
    }
}

#[test]
fn a_law_that_is_nan_or_gives_energy_on_the_way_is_named_with_the_state() {
    let body = Body::solid(0.1).unwrap();
    let start = steady::state(&body, 0.5).unwrap();
    let hole = |_: &Body, y: &State, _: f64| {
        let nan = if (0.4799..0.4801).contains(&y.theta) { f64::NAN } else { 1.0 };
        [y.w1, y.w2, y.w3].map(|w| -0.01 * nan * w)
    };
    let on = |law: &dyn custom::CoupleLaw, y: State| {
        own(&body, y.into(), &[5.0], &Ask::default(), Custom::default().with_couple(law))
    };
    match on(&hole, start) {
        Err(Error::Couple { power, expected, theta, w, normal }) => {
            assert!(power.is_nan() && expected.contains("finite"));
            assert!((0.4799..0.4801).contains(&theta), "{theta}");
            assert!(w[1] > 0.0 && normal > 0.5, "{w:?} {normal}");
        }
        other => panic!("{other:?}"),
    }
    // The couple gives energy where w is larger than 12, beyond what the check before the motion tries.
    let gives = |_: &Body, y: &State, _: f64| {
        let fast = y.w1 * y.w1 + y.w2 * y.w2 + y.w3 * y.w3;
        [y.w1, y.w2, y.w3].map(|w| -0.01 * (1.0 - fast / 144.0) * w)
    };
    let fast = State { theta: 1.3, w1: 0.1, w2: 0.0, w3: 25.0 };
    match on(&gives, fast) {
        Err(Error::Couple { power, theta, w, .. }) => {
            assert!(power < 0.0 && theta == 1.3 && w == [0.1, 0.0, 25.0], "{power} {theta} {w:?}");
        }
        other => panic!("{other:?}"),
    }
    // In a narrow band of speeds that the check does not try, the body slows down into it.
    let band = |_: &Body, y: &State, _: f64| {
        let sign = if (11.0..11.5).contains(&y.w3) { -1.0 } else { 1.0 };
        [y.w1, y.w2, y.w3].map(|w| -0.05 * (sign + 1e-9) * w)
    };
    let slowing = on(&band, State { theta: 1.3, w1: 0.1, w2: 0.0, w3: 12.0 });
    assert!(
        matches!(slowing, Err(Error::Couple { power, w, .. }) if power < 0.0 && w[2] < 11.6),
        "{slowing:?}"
    );
    // With a coefficient of friction beyond the speeds of the check.
    let negative = |speed: f64| if speed < 2000.0 { 0.3 } else { 0.3 - 1e-3 * (speed - 2000.0) };
    let hoop = Body::tube(0.0, 1.0).unwrap();
    let thrown =
        Start::from(State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3: -3.0 }).with_slip(Slip::new(0.0, 3000.0));
    let laws = Custom::default().with_friction(&negative);
    let found = own(&hoop, thrown, &[5.0], &Ask::on(Friction::coulomb(0.4)), laws);
    assert!(
        matches!(found, Err(Error::Coefficient { mu, speed, .. }) if mu < 0.0 && speed == 3000.0),
        "{found:?}"
    );
}

#[test]
fn a_stiff_law_is_named_as_the_limit_of_its_motion_and_a_soft_one_is_not() {
    let body = Body::solid(0.1).unwrap();
    let start = steady::state(&body, 0.5).unwrap();
    // Drilling under this couple follows the slow change of rolling 1e7 times faster than the body moves.
    let stiff = |_: &Body, y: &State, _: f64| {
        let (s, c) = y.theta.sin_cos();
        let drilling = 1e7 * (s * y.w1 + c * y.w3);
        [-drilling * s, 0.0, -drilling * c]
    };
    let ask = Ask::default().with_max_evaluations(20_000);
    let m = own(&body, start.into(), &[5.0], &ask, Custom::default().with_couple(&stiff)).unwrap();
    assert_eq!((m.ending(), m.limit), (Ending::Bounded, Some(Limit::Stiff)));
    let soft = |_: &Body, y: &State, _: f64| [y.w1, y.w2, y.w3].map(|w| -0.01 * w);
    let ask = Ask::default().with_max_evaluations(2_000);
    let m = own(&body, start.into(), &[500.0], &ask, Custom::default().with_couple(&soft)).unwrap();
    assert_eq!((m.ending(), m.limit), (Ending::Bounded, Some(Limit::Evaluations)));
}

/// A user-defined law that fails at one of its calls, and counts the calls after that.
struct Failing {
    calls: Cell<u64>,
    fails_at: u64,
}

impl custom::CoupleLaw for Failing {
    fn couple(&self, _: &Body, y: &State, _: f64) -> [f64; 3] {
        self.calls.set(self.calls.get() + 1);
        let nan = if self.has_failed() { f64::NAN } else { 1.0 };
        [y.w1, y.w2, y.w3].map(|w| -0.01 * nan * w)
    }
    fn has_failed(&self) -> bool {
        self.calls.get() >= self.fails_at
    }
}

#[test]
fn a_law_that_fails_ends_its_motion_within_a_step_and_so_does_the_caller() {
    let body = Body::solid(0.1).unwrap();
    let start = steady::state(&body, 0.5).unwrap();
    let times: Vec<f64> = (0..=500).map(f64::from).collect();
    let fails_at = 9_000;
    let law = Failing { calls: Cell::new(0), fails_at };
    let m = own(&body, start.into(), &times, &Ask::default(), Custom::default().with_couple(&law)).unwrap();
    assert_eq!((m.ending(), m.limit, m.error), (Ending::Bounded, Some(Limit::Interrupted), f64::INFINITY));
    assert!(m.states.len() > 1 && m.states.len() < times.len(), "{}", m.states.len());
    assert_eq!(law.calls.get(), fails_at, "no call after the failure");
    // A caller is asked at each step.
    let (calls, asked) = (Cell::new(0), Cell::new(0));
    let law = counted(&calls, start, |y| [y.w1, y.w2, y.w3].map(|w| -0.01 * w));
    let mut go_on = || {
        asked.set(asked.get() + 1);
        calls.get() < 1_000
    };
    let laws = Custom::default().with_couple(&law);
    let m = custom::roll_with(&body, start, &times, &Ask::default(), laws, &mut go_on).unwrap().unwrap();
    assert!(m.is_interrupted() && m.event.unwrap().time > 0.0);
    assert!(calls.get() < 1_400 && asked.get() > 10, "{} {}", calls.get(), asked.get());
}

#[test]
fn under_any_couple_a_body_rolls_by_newtons_equations_and_its_contact_point_stays_at_rest() {
    let mut r = wander(5304);
    for _ in 0..drawn(900) {
        let (body, Start { state: y, .. }, _) = any(&mut r);
        let couple = [r() - 0.5, r() - 0.5, r() - 0.5];
        for contact in [Contact::Rolling, Contact::Smooth] {
            let (rate, force) = lossy::under_couple(contact, &body, &y, couple);
            let same = newton::derivative(&body, &y, &force, couple);
            let off = [rate.w1 - same.w1, rate.w2 - same.w2, rate.w3 - same.w3].map(f64::abs);
            assert!(off.into_iter().all(|x| x < 1e-11), "{body:?} {y:?} {couple:?}: {off:?}");
            // The energy changes by the power of the couple, since the force of the table does no work.
            let energy = |by: f64| {
                let State { theta, w1, w2, w3 } = y;
                let moved =
                    [theta + by * rate.theta, w1 + by * rate.w1, w2 + by * rate.w2, w3 + by * rate.w3];
                contact.energy(&body, &State::from(moved))
            };
            let power = couple[0] * y.w1 + couple[1] * y.w2 + couple[2] * y.w3;
            let grows = (energy(1e-5) - energy(-1e-5)) / 2e-5;
            assert!((grows - power).abs() < 1e-7, "{body:?} {y:?} {couple:?}: {grows} {power}");
        }
    }
}

#[test]
fn a_couple_that_depends_on_the_normal_force_has_the_one_of_newtons_equations_in_slips_and_rolling() {
    let mut r = wander(5320);
    let mut compared = 0;
    for _ in 0..60 {
        let (body, start, table) = any(&mut r);
        let law = |_: &Body, y: &State, normal: f64| {
            [y.w1, y.w2, y.w3].map(|w| -(0.02 + 0.1 * normal + 0.05 * normal * normal) * w)
        };
        let (t, h) = (0.05, 1e-4);
        let ask = Ask::on(table).with_force();
        let found = own(&body, start, &[t - h, t, t + h], &ask, Custom::default().with_couple(&law));
        let Ok(m) = found else { continue };
        let kinds = m.path.as_ref().map(|path| path.kinds.clone()).unwrap_or_default();
        if m.states.len() < 3 || kinds.iter().any(|kind| *kind != kinds[0]) {
            continue;
        }
        let (y, force) = (m.states[1], m.forces.as_ref().unwrap()[1]);
        let rate = spincyl::newton::derivative(&body, &y, &force, law(&body, &y, force.normal));
        let [before, _, after] = [m.states[0], y, m.states[2]];
        for (told, a, b) in
            [(rate.w1, before.w1, after.w1), (rate.w2, before.w2, after.w2), (rate.w3, before.w3, after.w3)]
        {
            let seen = (b - a) / (2.0 * h);
            assert!(
                (seen - told).abs() < 1e-4 * (1.0 + told.abs()),
                "{body:?} {start:?} {table:?}: {seen} {told}"
            );
        }
        compared += 1;
    }
    assert!(compared > 30, "{compared}");
}
