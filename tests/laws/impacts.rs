//! Impact and restitution: balls, hoops, sticks and coins with known bounces, slips that jam, and laws of every impact.

use crate::common::{drawn, larger, wander};
use crate::flight::{any_drop, centre, coulomb, dropped, energy, hops, impacts, rim};
use nalgebra::{Matrix3, Vector3};
use spincyl::contact::slip::Friction;
use spincyl::contact::{self, Contact, Table};
use spincyl::motion::path::{AfterImpact, Hit, Kind};
use spincyl::motion::{Ask, Start, roll_with};
use spincyl::{Body, Slip, State};
use std::f64::consts::FRAC_PI_2;

#[test]
fn a_ball_bounces_with_the_times_of_its_restitution_and_grips_as_a_superball_does() {
    let inertia = 0.4;
    let ball = Body::ball(0.0, inertia, inertia).unwrap();
    for (e, mu, slip) in [(0.5, 0.2, [1.0, -0.5]), (0.8, 0.05, [-0.3, 2.0]), (0.3, 1.0, [0.2, 0.1])] {
        let (height, state) = (1.3f64, State { theta: 1.1, w1: 0.4, w2: -0.2, w3: 0.7 });
        let m = hops(&ball, &dropped(state, slip, height, 0.0), coulomb(mu), e, &[30.0]);
        let fast = (2.0 * height).sqrt();
        let (mut time, mut u) = (fast, slip[0].hypot(slip[1]));
        for (k, hit) in impacts(&m).iter().take(5).enumerate() {
            let down = e.powi(k as i32) * fast;
            assert!((hit.time - time).abs() < 1e-14, "{k}: {} for {time}", hit.time);
            assert!((hit.velocities[0][2] + down).abs() < 1e-14);
            assert!((hit.velocities[1][2] - e * down).abs() < 1e-14);
            let [p_h, p_2, p_n] = hit.impulse;
            // The grip-slip rule of Garwin, Am. J. Phys. 37, 88 (1969).
            let most = (mu * (1.0 + e) * down).min(u / (1.0 + 1.0 / inertia));
            assert!((p_h.hypot(p_2) - most).abs() < 1e-14 && (p_n - (1.0 + e) * down).abs() < 1e-14);
            u -= (1.0 + 1.0 / inertia) * most;
            time += 2.0 * e * down;
        }
        // All bounces are over at fast (1 + 2 e/(1 - e)); the last ones are summed, and the error of their sum is claimed.
        let landed = m.path.as_ref().unwrap().phases.iter().find(|phase| phase.kind != Kind::Flying).unwrap();
        let over = fast * (1.0 + 2.0 * e / (1.0 - e));
        assert!((landed.time - over).abs() < 1e-6 && landed.time < over && m.error < 1e-11);
    }
}

#[test]
fn a_hoop_dropped_with_backspin_comes_back_as_one_thrown_with_it() {
    let hoop = Body::tube(0.0, 1.0).unwrap();
    for (e, mu) in [(0.5, 0.3), (0.0, 0.1), (0.7, 1.0)] {
        let state = State { theta: FRAC_PI_2, w1: 0.0, w2: 0.0, w3: -3.0 };
        let m = hops(&hoop, &dropped(state, [0.0, 3.0], 1.0, 0.0), coulomb(mu), e, &[60.0]);
        // Friction keeps v + I3 w3, whatever its law.
        let last = *m.states.last().unwrap();
        assert!((last.w3 - -3.0 * hoop.i3() / (1.0 + hoop.i3())).abs() < 1e-13, "{}", last.w3);
        assert!((impacts(&m)[0].time - 2f64.sqrt()).abs() < 1e-14);
    }
}

#[test]
fn a_stick_dropped_balanced_on_its_edge_rises_to_the_square_of_its_restitution() {
    for ell in [0.5, 3.0, 10.0] {
        let stick = Body::solid(ell).unwrap();
        let state = State { theta: stick.theta_balance(), w1: 0.0, w2: 0.0, w3: 0.0 };
        let e = 0.7;
        let m = hops(&stick, &dropped(state, [0.0; 2], 1.0, 0.0), coulomb(0.3), e, &[4.0]);
        for hit in impacts(&m).iter().take(3) {
            let [_, _, before] = hit.velocities[0];
            let [u, v, after] = hit.velocities[1];
            assert!((after + e * before).abs() < 1e-14 && u.abs() < 1e-13 && v == 0.0);
        }
    }
}

#[test]
fn a_coin_dropped_without_spin_takes_the_impulse_of_its_inertia_and_grips_where_friction_suffices() {
    let coin = Body::solid(0.1).unwrap();
    for theta in [0.3, 0.8, 1.2] {
        let [_, _, height, lever] = rim(&coin, theta);
        let (a_h, a_n) = (1.0 + height * height / coin.i1(), 1.0 + lever * lever / coin.i1());
        let (b, e) = (height * lever / coin.i1(), 0.6);
        let state = State { theta, w1: 0.0, w2: 0.0, w3: 0.0 };
        for mu in [0.0, 0.1, 0.3, 0.8, 3.0] {
            let m = hops(&coin, &dropped(state, [0.0; 2], 0.5, 0.0), coulomb(mu), e, &[1.01]);
            let hit = &impacts(&m)[0];
            let grips = mu > 0.0 && b.abs() <= mu * a_h;
            let k = if grips { a_n - b * b / a_h } else { a_n - mu * b.abs() };
            let push = (1.0 + e) / k;
            let along = if grips { -b / a_h * push } else { -mu * b.signum() * push };
            assert!((hit.impulse[2] - push).abs() < 1e-14 * push, "{theta} {mu}");
            assert!((hit.impulse[0] - along).abs() < 1e-14 * push && hit.impulse[1] == 0.0);
            let how = if grips {
                Hit::Sticks
            } else if mu > 0.0 {
                Hit::SlipsOn
            } else {
                Hit::Smooth
            };
            assert_eq!(hit.hit, how);
            let tilt = -(height * along + lever * push) / coin.i1();
            assert!((hit.states[1].w2 - tilt).abs() < 1e-14 * (1.0 + tilt.abs()));
        }
    }
}

#[test]
fn an_impact_is_that_of_newton_and_euler_and_never_gains_energy() {
    let mut r = wander(511);
    let mut hits = [0; 5];
    for _ in 0..drawn(1200) {
        let (body, start, mu, e) = any_drop(&mut r);
        let m = hops(&body, &start, coulomb(mu), e, &[6.0]);
        for hit in impacts(&m) {
            hits[hit.hit as usize] += 1;
            let ([before, after], [p_h, p_2, p_n]) = (hit.states, hit.impulse);
            let scale = before.w1.abs().max(before.w2.abs()).max(before.w3.abs()).max(1.0);
            // The impulse acts on the centre, and about it at the lowest point r = -g e_h - h z.
            let [_, _, height, lever] = rim(&body, before.theta);
            let (s, c) = before.theta.sin_cos();
            let (e1, e2, e3) = (Vector3::new(c, 0.0, s), Vector3::y(), Vector3::new(-s, 0.0, c));
            let axes = Matrix3::from_columns(&[e1, e2, e3]);
            let inertia = Matrix3::from_diagonal(&Vector3::new(body.i1(), body.i1(), body.i3()));
            let turns = |y: &State| axes * (inertia * Vector3::new(y.w1, y.w2, y.w3));
            let push = Vector3::new(p_h, p_2, p_n);
            let arm = Vector3::new(lever, 0.0, -height);
            let off = turns(&after) - turns(&before) - arm.cross(&push);
            // The impulse of two rims does not act at one point.
            assert!(
                hit.hit == Hit::BothRims || off.norm() < 2e-13 * scale * (1.0 + body.ell()),
                "{body:?} {off}"
            );
            let v = |k: usize| Vector3::from(centre(&body, &hit.states[k], hit.velocities[k]));
            assert!((v(1) - v(0) - push).norm() < 2e-13 * scale * (1.0 + body.ell()));
            // Friction within its cone; the energy lost is that of the velocities.
            assert!(p_h.hypot(p_2) <= mu * p_n * (1.0 + 1e-12) + 1e-15 && p_n > 0.0);
            let lost = energy(&body, &before, hit.velocities[0], 0.0)
                - energy(&body, &after, hit.velocities[1], 0.0);
            // The last impact of a sequence of bounces also has the friction of those that are summed.
            let summed = if hit.after == AfterImpact::Stays { 1e-5 } else { 0.0 };
            assert!(hit.lost >= 0.0 && hit.lost > lost - 1e-12 * (1.0 + lost), "{lost} {}", hit.lost);
            assert!(hit.lost < lost + summed + 1e-12 * (1.0 + lost), "{lost} {}", hit.lost);
            assert!(hit.velocities[1][2] >= 0.0 && hit.velocities[0][2] < 0.0);
            if hit.hit == Hit::Sticks {
                assert_eq!(hit.velocities[1][..2], [0.0; 2]);
            }
        }
    }
    assert!(hits[0] > 50 && hits[1] > 50, "{hits:?}");
}

#[test]
fn friction_without_limit_tends_to_a_rough_table_and_the_difference_as_one_over_mu() {
    let mut r = wander(517);
    let (mut met, mut worst) = (0, 0.0f64);
    for _ in 0..drawn(300) {
        let (body, start, _, e) = any_drop(&mut r);
        let rough = hops(&body, &start, Table::default(), e, &[8.0]);
        let Some(hit) = impacts(&rough).first().copied() else { continue };
        let of = |table: Table| hops(&body, &start, table, e, &[hit.time + 1e-9]);
        for big in [1e4, 1e6] {
            let near = impacts(&of(coulomb(big))).first().copied().unwrap();
            let film = impacts(&of(Friction::Viscous { c: big }.into())).first().copied().unwrap();
            let scale = hit.impulse.iter().fold(1.0, |most: f64, p| most.max(p.abs()));
            for other in [near, film] {
                let off = (0..3).map(|i| (hit.impulse[i] - other.impulse[i]).abs()).fold(0.0, larger);
                worst = worst.max(off * big / scale);
                assert!(off * big < 2e3 * scale, "{body:?} {start:?} {e}: {off:e} at {big:e}");
            }
        }
        met += 1;
    }
    assert!(met > 40 && worst > 1e-3, "{met} {worst}");
}

#[test]
fn without_friction_coupling_or_restitution_the_laws_of_newton_and_of_energy_are_one() {
    let mut r = wander(518);
    for _ in 0..drawn(200) {
        let (body, start, mu, e) = any_drop(&mut r);
        let ice = hops(&body, &start, coulomb(0.0), e, &[4.0]);
        for hit in impacts(&ice).iter().filter(|hit| hit.after != AfterImpact::Stays) {
            let [before, after] = [hit.velocities[0][2], hit.velocities[1][2]];
            assert!((after + e * before).abs() < 1e-13 * before.abs(), "{before} {after}");
            assert!(hit.impulse[..2] == [0.0; 2] && hit.hit == Hit::Smooth);
        }
        let soft = hops(&body, &start, coulomb(mu), 0.0, &[4.0]);
        assert!(impacts(&soft).iter().all(|hit| hit.velocities[1][2] == 0.0));
    }
}

#[test]
fn a_slip_follows_rouths_equations_along_an_impact_also_where_friction_hardly_slows_it() {
    let mut r = wander(520);
    let mut slow = 0;
    for k in 0..drawn(60) {
        let (body, start, mu, e) = any_drop(&mut r);
        let (state, Slip { u_h: u, u_2: v, .. }) = (start.state, start.slip);
        let [radius, depth, height, lever] = rim(&body, state.theta);
        let (i1, i3) = (body.i1(), body.i3());
        let (a_h, a_n, b) = (1.0 + height * height / i1, 1.0 + lever * lever / i1, height * lever / i1);
        let a_2 = 1.0 + depth * depth / i1 + radius * radius / i3;
        // Every other slip has this size beside the fall, and a friction that all but balances the lever.
        let size = if k % 2 == 0 { 1.0 } else { 1e-2 };
        let mu = if k % 2 == 0 { mu } else { b.abs() / a_h * (1.0 + 10f64.powf(-1.0 - 3.0 * r())) };
        let drop = dropped(state, [size * u, size * v], 0.0, -1.0);
        let hit = impacts(&hops(&body, &drop, coulomb(mu), e, &[1e-9]))[0];
        if hit.hit != Hit::Slips || hit.impulse[2] > 5.0 {
            continue;
        }
        slow += k % 2;
        // Runge and Kutta's method in steps of the normal impulse.
        let rate = |[u, v, _]: [f64; 3]| {
            let speed = u.hypot(v);
            [b - mu * a_h * u / speed, -mu * a_2 * v / speed, a_n - mu * b * u / speed]
        };
        let n = 20_000;
        let h = hit.impulse[2] / f64::from(n);
        let mut y = [size * u, size * v, -1.0];
        for _ in 0..n {
            let on = |k: [f64; 3], h: f64| core::array::from_fn(|i| y[i] + h * k[i]);
            let k1 = rate(y);
            let k2 = rate(on(k1, 0.5 * h));
            let k3 = rate(on(k2, 0.5 * h));
            let k4 = rate(on(k3, h));
            y = core::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        for (i, (y, velocity)) in y.into_iter().zip(hit.velocities[1]).enumerate() {
            let off = (y - velocity).abs();
            assert!(off < 1e-10, "{body:?} {drop:?} {mu} {e}: {off:e} in number {i}");
        }
    }
    assert!(slow > 2, "{slow}");
}

#[test]
fn a_slip_that_jams_is_stopped_by_an_impact_without_a_fall() {
    // Painleve, C. R. Acad. Sci. 121, 112 (1895); the impact is that of Genot and Brogliato (1999).
    let body = Body::new(0.8, 0.082, 0.1).unwrap();
    let (mu, mut met) = (0.95, 0);
    for k in 1..15 {
        let theta = 0.1 * f64::from(k);
        let [_, _, height, lever] = rim(&body, theta);
        let (a_h, a_n) = (1.0 + height * height / body.i1(), 1.0 + lever * lever / body.i1());
        let b = height * lever / body.i1();
        if mu * b.abs() < 1.05 * a_n {
            continue;
        }
        for (e, speed) in [(0.0, 1.0), (0.4, 0.3), (1.0, 2.0)] {
            let state = State { theta, w1: 0.0, w2: 0.0, w3: 0.0 };
            let start = Start::from(state).with_slip(Slip::new(speed * b.signum(), 0.0));
            let hit = impacts(&hops(&body, &start, coulomb(mu), e, &[1e-3]))[0];
            // The slip stops after the impulse p, while the rim presses harder; then it sticks, and comes up again.
            let (p, k) = (speed / (mu * a_h - b.abs()), a_n - b * b / a_h);
            let down = (mu * b.abs() - a_n) * p;
            let up = e * (down * (down + k * p)).sqrt();
            let push = p + (down + up) / k;
            assert!((hit.impulse[2] - push).abs() < 1e-13 * push, "{theta} {e}: {} {push}", hit.impulse[2]);
            let [u, v, lift] = hit.velocities[1];
            assert!((lift - up).abs() < 1e-13 * speed && [u, v] == [0.0; 2] && hit.hit == Hit::Sticks);
            met += 1;
        }
    }
    assert!(met > 5, "{met}");
}

#[test]
fn a_jam_is_the_limit_of_landings_ever_slower_and_where_the_rim_may_leave_as_well_there_is_none() {
    let mut r = wander(519);
    let (mut jams, mut doubtful) = ([0; 2], 0);
    for k in 0..drawn(3000) {
        let film = k % 2 == 1;
        let body = Body::new(0.3 + r(), 0.05 + 0.1 * r(), 0.1).unwrap();
        let mut speed = || 2.0 * r() - 1.0;
        let (w1, w2, w3, u, v) = (speed(), speed(), speed(), speed(), speed());
        let state = State { theta: 0.2 + 1.2 * r(), w1, w2, w3 };
        let (table, e) = (if film { Friction::Viscous { c: 3.0 }.into() } else { coulomb(0.95) }, r());
        let start = Start::from(state).with_slip(Slip::new(u, v));
        // Without restitution a jam is refused, and so tells us where one is.
        if roll_with(&body, start, &[0.0], &Ask::on(table), || true).is_ok() {
            continue;
        }
        let free = contact::force(Contact::Smooth, &body, &state).normal;
        let ask = Ask::on(table).with_restitution(e).with_pose();
        let made = roll_with(&body, start, &[1e-9], &ask, || true);
        if free < 0.0 {
            assert!(made.unwrap_err().to_string().contains(": no unique contact force (Painleve)"));
            doubtful += 1;
            continue;
        }
        let hit = impacts(&made.unwrap().unwrap())[0];
        for fall in [1e-3, 1e-6] {
            let slow = dropped(state, [u, v], 0.0, -fall);
            let near = impacts(&hops(&body, &slow, table, e, &[1e-9]))[0];
            let off = (0..3).map(|i| (hit.impulse[i] - near.impulse[i]).abs()).fold(0.0, larger);
            assert!(off < 1e3 * fall, "{body:?} {start:?} {e}: {off:e} at {fall:e}");
        }
        let of = |k: usize| energy(&body, &hit.states[k], hit.velocities[k], 0.0);
        let lost = of(0) - of(1);
        assert!(lost >= 0.0 && (lost - hit.lost).abs() < 1e-12 * (1.0 + lost), "{lost} {}", hit.lost);
        assert!(hit.hit == Hit::Slips || hit.velocities[1][..2] == [0.0; 2]);
        jams[usize::from(film)] += 1;
    }
    assert!(jams.iter().all(|&n| n > 20) && doubtful > 3, "{jams:?} {doubtful}");
}
