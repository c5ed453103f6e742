//! Laws of restitution other than Stronge's: a superball that bounces to and fro, and properties that all laws share.

use crate::common::{drawn, wander};
use crate::flight::{account, any_drop, coulomb, dropped, impacts};
use spincyl::contact::slip::Friction;
use spincyl::contact::{ImpactLaw, Table};
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::{AfterImpact, Hit, Kind};
use spincyl::motion::{Ask, Ending, Motion, Start, roll_with};
use spincyl::{Body, Error, State};
use std::f64::consts::PI;

fn bounces(body: &Body, start: Start, ask: &Ask, times: &[f64]) -> Result<Motion, Error> {
    roll_with(body, start, times, ask, || true).map(Option::unwrap)
}

#[test]
fn a_perfect_superball_bounces_to_and_fro_and_has_its_first_motion_again_after_two_bounces() {
    for inertia in [0.4, 2.0 / 3.0] {
        let ball = Body::ball(0.0, inertia, inertia).unwrap();
        let state = State { theta: 1.1, w1: 0.4, w2: -0.2, w3: 0.7 };
        let law = ImpactLaw::Walton { tangential: 1.0 };
        let ask = Ask::on(coulomb(3.0)).with_restitution(1.0).with_impact_law(law);
        let m = bounces(&ball, dropped(state, [0.9, -0.5], 1.0, 0.0), &ask, &[30.0]).unwrap();
        let hits = impacts(&m);
        assert!(hits.len() == 11 && hits.iter().all(|hit| hit.hit == Hit::TurnsBack));
        for (k, hit) in hits.iter().enumerate() {
            let ([u, v, _], [u_after, v_after, _]) = (hit.velocities[0], hit.velocities[1]);
            let off = (u_after + u).hypot(v_after + v);
            assert!(off < 1e-14 && hit.lost.abs() < 1e-13, "{k} {hit:?}");
            // Garwin 1969: the impulse is 2 I/(1 + I) times the slip.
            let push = 2.0 * inertia / (1.0 + inertia) * u.hypot(v);
            assert!((hit.impulse[0].hypot(hit.impulse[1]) - push).abs() < 1e-14, "{k} {hit:?}");
            // Of the spin only w_z and the components along and across the lean can be compared as the axis turns.
            let [first, second] = hit.states;
            let spun = |y: State| y.w1.hypot(y.w2).hypot(y.w3);
            let before = spun(hits[k % 2].states[0]);
            assert!((spun(first) - before).abs() < 1e-13, "{k} {first:?} {second:?}");
        }
    }
}

#[test]
fn a_ball_without_tangential_restitution_bounces_as_under_the_default_law() {
    let mut r = wander(710);
    for k in 0..drawn(60) {
        let inertia = 0.3 + 0.3 * r();
        let ball = Body::ball(0.0, inertia, inertia).unwrap();
        let mut speed = || 4.0 * r() - 2.0;
        let state = State { theta: 1.0 + 0.3 * speed(), w1: speed(), w2: speed(), w3: speed() };
        let start = dropped(state, [speed(), speed()], 1.3 + 0.5 * speed(), speed());
        let mut ask = Ask::on(coulomb(0.05 + 0.9 * r())).with_restitution(0.9 * r());
        ask.pose = k % 2 == 0;
        let of = |law| bounces(&ball, start, &ask.with_impact_law(law), &[2.0, 20.0]).unwrap();
        let known = of(ImpactLaw::Stronge);
        for law in [ImpactLaw::Newton, ImpactLaw::Poisson, ImpactLaw::Walton { tangential: 0.0 }] {
            let m = of(law);
            for (a, b) in m.states.iter().zip(&known.states) {
                let off = [a.theta - b.theta, a.w1 - b.w1, a.w2 - b.w2, a.w3 - b.w3];
                let off = off.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                assert!(off <= 1e-12 + 2.0 * (m.error + known.error), "{k} {law:?}: {off:e}");
            }
        }
    }
}

#[test]
fn a_ball_whose_slips_turn_back_loses_what_its_impacts_take_and_rolls_in_the_end() {
    let (mut r, mut turns) = (wander(711), 0);
    for k in 0..drawn(200) {
        let inertia = 0.3 + 0.37 * r();
        let ball = Body::ball(0.0, inertia, inertia).unwrap();
        let mut speed = || if r() < 0.15 { 0.0 } else { 4.0 * r() - 2.0 };
        let state = State { theta: 0.2 + 0.7 * (2.0 + speed()), w1: speed(), w2: speed(), w3: speed() };
        let mut start = dropped(state, [speed(), speed()], 0.5 * (2.0 + speed()), speed());
        if k % 4 == 0 {
            // At rest or almost, on the table or just above it.
            let odd = |r: f64| [0.0, 1e-300, -1e-160, 1e-16, 1e-8, -0.1, 1.0][(7.0 * r) as usize];
            let state = State { theta: state.theta, w1: odd(r()), w2: odd(r()), w3: odd(r()) };
            start = dropped(state, [odd(r()), odd(r())], odd(r()).abs(), odd(r()));
        }
        let tangential = if r() < 0.2 { 1.0 } else { r() };
        let mut ask = Ask::on(coulomb(0.05 + 0.9 * r()))
            .with_restitution(0.85 * r())
            .with_impact_law(ImpactLaw::Walton { tangential });
        ask.pose = k % 3 == 0;
        if k % 5 == 0 {
            ask.losses = Losses::of(Law::AirLinear, 0.05);
        }
        let times: Vec<f64> = (0..60).map(f64::from).collect();
        let m = bounces(&ball, start, &ask, &times).unwrap();
        let path = m.path.as_ref().unwrap();
        let whole = |i: usize| account(&ball, &m, i);
        for i in 0..m.times.len() {
            let off = (whole(i) - whole(0)).abs();
            assert!(off < 1e-12 * (1.0 + whole(0)) + m.error, "{k} {start:?} {ask:?} {i}: {off:e}");
        }
        assert!(path.impacts.iter().all(|hit| hit.lost > -1e-14), "{k} {:?}", path.impacts);
        turns += path.impacts.iter().filter(|hit| hit.hit == Hit::TurnsBack).count();
        assert!(
            path.kinds.last() == Some(&Kind::Rolling) || m.event.is_some(),
            "{k} {:?}",
            path.kinds.last()
        );
        assert!(m.limit.is_none(), "{k} {:?}", m.limit);
    }
    assert!(turns > 300, "{turns}");
}

#[test]
fn under_newtons_law_every_impact_has_its_ratio_and_a_second_rim_ends_the_motion() {
    let (mut r, mut sides, mut gained) = (wander(712), 0, 0);
    for k in 0..drawn(200) {
        let (body, start, mu, e) = any_drop(&mut r);
        let ask = Ask::on(coulomb(mu)).with_restitution(e).with_impact_law(ImpactLaw::Newton);
        let m = bounces(&body, start, &ask, &[20.0]).unwrap();
        for hit in impacts(&m).iter().filter(|hit| hit.after != AfterImpact::Stays) {
            let [[.., down], [.., up]] = hit.velocities;
            assert!((up + e * down).abs() < 1e-12 * (1.0 - down), "{k} {hit:?}");
            assert!(hit.hit != Hit::BothRims, "{k} {hit:?}");
            gained += usize::from(hit.lost < -1e-9);
        }
        if let Some(event) = m.event {
            sides += usize::from(event.ending == Ending::Side);
        }
    }
    assert!(sides > 10 && gained > 2, "{sides} {gained}");
}

#[test]
fn slips_turn_back_only_of_a_ball_under_dry_friction_at_a_point() {
    let (ball, egg) = (Body::ball(0.0, 0.4, 0.4).unwrap(), Body::ball(0.1, 0.4, 0.4).unwrap());
    let start = dropped(State { theta: 0.3 * PI, w1: 0.0, w2: 0.0, w3: 0.0 }, [1.0, 0.0], 1.0, 0.0);
    let law = ImpactLaw::Walton { tangential: 0.5 };
    let ask = |table: Table| Ask::on(table).with_restitution(0.5).with_impact_law(law);
    let patch = Friction::Coulomb { mu: 0.3, fixed: 0.3, patch: 0.01 };
    for (body, ask) in [
        (egg, ask(coulomb(0.3))),
        (ball, ask(Table::Smooth)),
        (ball, ask(Table::Rolling { mu: 1.0 })),
        (ball, ask(Friction::Viscous { c: 0.3 }.into())),
        (ball, ask(patch.into())),
        (ball, ask(coulomb(0.3)).with_impact_law(ImpactLaw::Walton { tangential: 1.1 })),
        (ball, ask(coulomb(0.3)).with_impact_law(ImpactLaw::Walton { tangential: f64::NAN })),
    ] {
        let error = bounces(&body, start, &ask, &[1.0]).unwrap_err().to_string();
        assert!(error.starts_with("tangential"), "{error}");
    }
    assert!(bounces(&ball, start, &ask(coulomb(0.3)), &[1.0]).is_ok());
}
