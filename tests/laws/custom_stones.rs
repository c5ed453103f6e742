//! Stones under a user-defined law of friction: the same motions as under the library's laws and as those of a body
//! of revolution, the balance of energy, and errors.

use crate::common::{drawn, wander};
use crate::stone::apart;
use nalgebra::{Rotation3, Vector3};
use spincyl::contact::Friction;
use spincyl::custom::{self, Custom, FrictionLaw};
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{Ask, Method, Motion, Start};
use spincyl::stone::{self, Ellipsoid, StoneState};
use spincyl::{Body, Error, Slip, State};
use std::cell::Cell;

/// A random stone and start; half of the starts have no slip.
fn any(r: &mut impl FnMut() -> f64) -> (Ellipsoid, Start<StoneState>) {
    let axes = [1.0, 0.4 + 0.6 * r(), 0.4 + 0.6 * r()];
    let squares = axes.map(|a| a * a);
    let sum: f64 = squares.iter().sum();
    let mut inertia = [[0.0; 3]; 3];
    (0..3).for_each(|i| inertia[i][i] = 0.2 * (sum - squares[i]));
    let offset = [0, 1, 2].map(|i| 0.2 * axes[i] * (r() - 0.5));
    let mut speed = || 3.0 * r() - 1.5;
    let vertical = Vector3::new(speed(), speed(), speed() + 0.5).normalize().into();
    let (w, slip) = ([speed(), speed(), 2.0 * speed()], [speed(), speed()]);
    let start = Start::from(StoneState { vertical, w });
    let start = if r() < 0.5 { start } else { start.with_slip(slip.into()) };
    (Ellipsoid::new(axes, inertia, offset).unwrap(), start)
}

fn own(
    stone: &Ellipsoid,
    start: Start<StoneState>,
    times: &[f64],
    ask: &Ask,
    law: &dyn FrictionLaw,
) -> Result<Motion<StoneState>, Error> {
    let laws = Custom::default().with_friction(law);
    custom::roll_stone(stone, start, times, ask, laws, || true).map(|found| found.expect("not interrupted"))
}

fn ours(stone: &Ellipsoid, start: Start<StoneState>, times: &[f64], ask: &Ask) -> Motion<StoneState> {
    stone::roll(stone, start, times, ask, || true).unwrap().unwrap()
}

/// The kinetic and potential energy of a stone that slips, by its definition.
fn energy(stone: &Ellipsoid, y: &StoneState, slip: [f64; 2]) -> f64 {
    let [n, w, r] = [y.vertical, y.w, stone.lowest_point(y.vertical)].map(Vector3::from);
    let lab = Rotation3::rotation_between(&Vector3::z(), &n).unwrap();
    let v = lab * Vector3::new(slip[0], slip[1], 0.0) - w.cross(&r);
    let tensor = nalgebra::Matrix3::from_fn(|i, j| stone.inertia()[i][j]);
    0.5 * (w.dot(&(tensor * w)) + v.dot(&v)) - r.dot(&n)
}

#[test]
fn under_a_constant_coefficient_and_one_that_grows_with_the_speed_a_stone_moves_as_under_the_librarys_laws() {
    let (mut r, mut begun, mut compared) = (wander(6601), 0, 0);
    let times = [0.0, 0.4, 0.8, 1.2, 2.0];
    for k in 0..drawn(120) {
        let (stone, start) = any(&mut r);
        let (mu, more) = (0.05 + 0.3 * r(), if r() < 0.5 { 0.0 } else { 0.1 });
        let (constant, film) = (move |_: f64| mu, move |speed: f64| mu * speed);
        let (law, own_table, table): (&dyn FrictionLaw, _, _) = if k % 3 == 0 {
            (&film, Friction::coulomb(0.0), Friction::Viscous { c: mu })
        } else {
            // The coefficient of the table itself does not count.
            let of = |mu| Friction::Coulomb { mu, fixed: mu + more, patch: 0.0 };
            let other = Friction::Coulomb { mu: 0.5 * mu, fixed: mu + more, patch: 0.0 };
            (&constant, other, of(mu))
        };
        let losses = Losses::of(Law::AirLinear, 0.01) + Losses::of(Law::RollingResistance, 1e-3);
        let losses = if k % 2 == 0 { losses } else { Losses::NONE };
        let [a, b] = [own_table, table].map(|table| Ask::on(table).with_losses(losses));
        let theirs = own(&stone, start, &times, &a, law).unwrap();
        let ours = ours(&stone, start, &times, &b);
        assert_eq!(theirs.ending(), ours.ending(), "{stone:?} {start:?} {table:?}");
        let claimed = (theirs.error + ours.error).max(1e-9);
        if claimed > 1e-4 {
            continue;
        }
        let paths = [&theirs, &ours].map(|m| m.path.as_ref().unwrap());
        for (i, (a, b)) in theirs.states.iter().zip(&ours.states).enumerate() {
            let off = apart(a, b).max((paths[0].dissipated[i] - paths[1].dissipated[i]).abs());
            assert!(off <= 10.0 * claimed, "{stone:?} {start:?} {table:?}: {off:e} of {claimed:e}");
        }
        compared += 1;
        let slips = |kind: &Kind| *kind == Kind::Slipping;
        begun += usize::from(paths[0].phases.iter().skip(1).any(|phase| slips(&phase.kind)));
    }
    assert!(compared > drawn(80) && begun > drawn(5), "{compared} of them, {begun} slips from rest");
}

#[test]
fn energy_and_heat_of_a_stone_under_stribecks_friction_keep_their_sum() {
    let (mut r, mut slipped) = (wander(6602), 0);
    let stribeck = |speed: f64| 0.1 + 0.2 * (-(speed / 0.3f64).powi(2)).exp();
    for k in 0..drawn(90) {
        let (stone, start) = any(&mut r);
        let losses = if k % 2 == 0 { Losses::of(Law::AirLinear, 0.02) } else { Losses::NONE };
        let fixed = if k % 3 == 0 { 0.3 } else { 0.35 };
        let ask = Ask::on(Friction::Coulomb { mu: 0.3, fixed, patch: 0.0 }).with_losses(losses);
        let ask = ask.with_method(Method::Tolerance(1e-11));
        let m = own(&stone, start, &[0.0, 0.5, 1.0, 2.0], &ask, &stribeck).unwrap();
        let path = m.path.as_ref().unwrap();
        let sum = |i: usize| {
            let lost = path.work_lost.get(i).copied().unwrap_or(0.0);
            energy(&stone, &m.states[i], path.slip[i].into()) + path.dissipated[i] + lost
        };
        for i in 1..m.states.len() {
            let off = (sum(i) - sum(0)).abs();
            assert!(off < 1e-9 * (1.0 + sum(0)), "{stone:?} {start:?}: {off:e}");
            assert!(path.dissipated[i] >= path.dissipated[i - 1]);
        }
        slipped += usize::from(path.dissipated.last().is_some_and(|heat| *heat > 1e-3));
    }
    assert!(slipped > drawn(30), "{slipped} motions have slipped");
}

#[test]
fn a_ball_is_the_same_under_stribecks_friction_as_a_body_and_as_a_stone() {
    let stribeck = |speed: f64| 0.15 + 0.15 * (-(speed / 0.5f64).powi(2)).exp();
    let (ball, stone) = (Body::ball(0.0, 0.4, 0.4).unwrap(), Ellipsoid::uniform([1.0; 3]).unwrap());
    let ask = Ask::on(Friction::coulomb(0.3)).with_method(Method::Tolerance(1e-12));
    let (laws, times) = (Custom::default().with_friction(&stribeck), [0.0, 0.5, 1.0, 3.0, 6.0]);
    // Both lean about their axis y, so that the lean is along x.
    let (s, c) = 0.7f64.sin_cos();
    let (w, slip) = ([0.8, -0.4, 2.0], [1.5, -0.6]);
    let body = State { theta: 0.7, w1: w[0], w2: w[1], w3: w[2] };
    let a = custom::roll_with(&ball, Start::from(body).with_slip(slip.into()), &times, &ask, laws, || true);
    let turned = StoneState { vertical: [s, 0.0, c], w };
    let b = own(&stone, Start::from(turned).with_slip(slip.into()), &times, &ask, &stribeck).unwrap();
    let a = a.unwrap().unwrap();
    let (ours, theirs) = (a.path.as_ref().unwrap(), b.path.as_ref().unwrap());
    for (i, (y, stone)) in a.states.iter().zip(&b.states).enumerate() {
        let spin = y.w1 * y.theta.sin() + y.w3 * y.theta.cos();
        assert!((spin - stone.spin()).abs() < 1e-10, "{spin} {}", stone.spin());
        assert!((ours.dissipated[i] - theirs.dissipated[i]).abs() < 1e-10);
    }
    let ends = [ours.phases[1].time, theirs.phases[1].time];
    assert!((ends[0] - ends[1]).abs() < 1e-9 && ends[0] > 1.0, "{ends:?}");
}

#[test]
fn a_law_of_a_stone_that_is_wrong_is_refused_by_name_and_one_that_fails_ends_the_motion() {
    let (stone, ask) = (Ellipsoid::uniform([1.0, 0.8, 0.6]).unwrap(), Ask::on(Friction::coulomb(0.3)));
    let start = Start::from(stone.spinning(2.0, 0.3, 0.1)).with_slip(Slip::new(1.0, 0.5));
    let name = |found: Result<Motion<StoneState>, Error>| match found {
        Err(Error::OutOfRange { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    let of = |law: &dyn FrictionLaw, ask: &Ask| own(&stone, start, &[0.0, 1.0], ask, law);
    assert_eq!(name(of(&|speed: f64| 0.3 - speed, &ask)), "mu");
    assert_eq!(name(of(&|_: f64| 0.4, &ask)), "static");
    assert_eq!(name(of(&|_: f64| 0.2, &Ask::default())), "contact");
    assert_eq!(name(of(&|_: f64| 0.2, &ask.with_beyond())), "beyond");
    let patch = Ask::on(Friction::Coulomb { mu: 0.3, fixed: 0.3, patch: 0.05 });
    assert_eq!(name(of(&|_: f64| 0.3, &patch)), "patch");
    let still = |_: &Body, _: &State, _: f64| [0.0; 3];
    let couple = Custom::default().with_couple(&still);
    assert_eq!(
        name(custom::roll_stone(&stone, start, &[1.0], &ask, couple, || true).map(Option::unwrap)),
        "couple"
    );
    // A law that becomes negative on the way, after its check.
    let calls = Cell::new(0);
    let late = |_: f64| {
        calls.set(calls.get() + 1);
        if calls.get() > 1100 { -0.1 } else { 0.3 }
    };
    let found = of(&late, &ask);
    assert!(matches!(found, Err(Error::Coefficient { .. })), "{found:?}");
}
