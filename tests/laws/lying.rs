//! A body on both rims that slides, spins down, pivots, rises, rocks or rolls straight, with known answers.

use crate::common::{drawn, larger, wander};
use spincyl::contact::slip::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::{Hit, Kind, OtherRim};
use spincyl::motion::{AboveTable, Ask, Ending, Motion, Start, roll_with};
use spincyl::{Body, Error, Slip, State};
use std::f64::consts::FRAC_PI_2;

/// A start on the side, with this velocity of the centre along the axis and across it.
fn lying(body: &Body, w1: f64, w3: f64, [along, across]: [f64; 2]) -> Start {
    let state = State { theta: FRAC_PI_2, w1, w2: 0.0, w3 };
    Start::from(state).with_slip(Slip::new(along, across + body.ell() * w1 - w3))
}

fn ask(friction: Friction, losses: Losses) -> Ask {
    Ask::on(friction).with_restitution(0.0).with_losses(losses).with_pose().with_force()
}

fn moved(body: &Body, start: Start, mu: f64, times: &[f64]) -> Motion {
    losing(body, start, Friction::coulomb(mu), Losses::NONE, times)
}

fn losing(body: &Body, start: Start, friction: Friction, losses: Losses, times: &[f64]) -> Motion {
    roll_with(body, start, times, &ask(friction, losses), || true).unwrap().unwrap()
}

fn kinds(m: &Motion) -> Vec<Kind> {
    m.path.as_ref().unwrap().phases.iter().map(|phase| phase.kind).collect()
}

/// The time at which the last phase of a motion begins.
fn settles(m: &Motion) -> f64 {
    m.path.as_ref().unwrap().phases.last().unwrap().time
}

#[test]
fn a_cylinder_thrown_sideways_rolls_after_the_time_of_a_bowling_ball_and_keeps_two_thirds() {
    for (ell, mu, v) in [(1.0, 0.3, 2.0), (0.5, 0.1, -1.0), (3.0, 1.0, 4.0)] {
        let body = Body::solid(ell).unwrap();
        let start = lying(&body, 0.0, 0.0, [0.0, v]);
        let until = v.abs() / (mu * (1.0 + 1.0 / body.i3()));
        let m = moved(&body, start, mu, &[0.5 * until, 2.0 * until]);
        assert_eq!(kinds(&m), [Kind::Lying, Kind::RollingOnItsSide]);
        assert!((settles(&m) - until).abs() < 1e-12);
        assert!((m.states[1].w3 - v / (1.0 + body.i3())).abs() < 1e-13);
        let heat = m.path.as_ref().unwrap().heat;
        assert!((heat - body.i3() * v * v / (2.0 * (1.0 + body.i3()))).abs() < 1e-12 * v * v);
        // Each rim bears half the weight, and rolling straight needs no friction.
        let force = m.forces.as_ref().unwrap();
        assert!((force[0].normal - 0.5).abs() < 1e-15 && (force[0].along.abs() - 0.5 * mu).abs() < 1e-14);
        assert!(force[1].normal == 0.5 && force[1].friction() == 0.0);
        let [first, second] = [0, 1].map(|i| m.poses.as_ref().unwrap()[i].contact_point);
        let way = |t: f64| if t <= until { v * t - v.signum() * mu * t * t / 2.0 } else { f64::NAN };
        assert!((first.y - way(0.5 * until)).abs() < 1e-12);
        let rest = way(until) + until * v / (1.0 + body.i3());
        assert!((second.y - rest).abs() < 1e-12);
    }
}

#[test]
fn a_cylinder_thrown_along_its_axis_stops_as_a_block_does_unless_it_tips_over_its_leading_rim() {
    let body = Body::solid(0.8).unwrap();
    for v in [1.5, -2.0] {
        let m = moved(&body, lying(&body, 0.0, 0.0, [v, 0.0]), 0.4, &[1.0, 20.0]);
        assert!((settles(&m) - v.abs() / 0.4).abs() < 1e-12);
        let force = m.forces.as_ref().unwrap()[0];
        // The leading rim bears more: N = (1 + mu/ell)/2 there.
        assert!((force.normal - 0.5 * (1.0 + v.signum() * 0.4 / 0.8)).abs() < 1e-14, "{}", force.normal);
    }
    let tips = moved(&body, lying(&body, 0.0, 0.0, [1.5, 0.0]), 0.9, &[0.1]);
    assert_eq!(kinds(&tips), [Kind::Slipping]);
    assert!(tips.states[0].theta < FRAC_PI_2);
}

#[test]
fn a_cylinder_that_spins_on_its_side_stops_after_i1_w1_over_mu_ell() {
    let body = Body::solid(1.5).unwrap();
    let drill = Losses::of(Law::Drilling, 0.05);
    for (w1, losses, couple) in [(2.0, Losses::NONE, 0.0), (-1.0, Losses::NONE, 0.0), (2.0, drill, 0.05)] {
        let mu = 0.2;
        let until = body.i1() * f64::abs(w1) / (mu * body.ell() + couple);
        let friction = Friction::coulomb(mu);
        let m = losing(&body, lying(&body, w1, 0.0, [0.0; 2]), friction, losses, &[0.5 * until, 1.5 * until]);
        let end = m.event.map_or(settles(&m), |event| event.time);
        assert!((end - until).abs() < 1e-11, "{end} {until}");
        assert!((m.states[0].w1 - 0.5 * w1).abs() < 1e-13);
        let turned = m.poses.as_ref().unwrap()[0].phi.radians();
        assert!((turned - 0.375 * w1 * until).abs() < 1e-12, "{turned}");
    }
}

#[test]
fn rolling_resistance_stops_the_rolling_of_what_spins_on_its_side_and_holds_it_while_the_rims_slip() {
    for (ell, mu, delta) in [(0.1, 0.3, 0.004), (0.5, 0.2, 0.02), (0.09, 0.3, 0.0039)] {
        let body = Body::solid(ell).unwrap();
        let losses = Losses::of(Law::RollingResistance, delta);
        for w3 in [3e-4, -2e-4] {
            let start = lying(&body, 2.0, w3, [0.0; 2]);
            let until = body.i1() * 2.0 / (mu * ell);
            let m = losing(&body, start, Friction::coulomb(mu), losses, &[0.9 * until, 1.5 * until]);
            assert_eq!(m.states[0].w3, 0.0, "{ell}");
            let end = m.event.as_ref().unwrap();
            assert_eq!(end.ending, Ending::Stops);
            assert!((end.time - until).abs() < w3.abs() * until, "{ell} {}: {until}", end.time);
        }
    }
}

#[test]
fn dry_losses_resist_what_rolls_from_rest_where_a_rim_slips_off_as_what_rolls_slowly() {
    let mut rolls_off = 0;
    // The last one slips off only if it also rolls.
    let starts = [
        (0.3, 0.4, 0.15),
        (0.5, 1.0, 0.15),
        (1.0, -0.8, 0.2),
        (0.4, 0.7, 0.05),
        (0.144425921, -0.234794707, 0.816539128),
    ];
    for (ell, w1, mu) in starts {
        let body = Body::solid(ell).unwrap();
        for law in [Law::RollingResistance, Law::DryContour] {
            for size in [0.002, 0.02, 0.5] {
                let rolling = |w3: f64| {
                    let start = Start::from(State { theta: FRAC_PI_2, w1, w2: 0.0, w3 });
                    let m = losing(&body, start, Friction::coulomb(mu), Losses::of(law, size), &[0.02, 0.1]);
                    assert!(kinds(&m)[0] == Kind::Lying || size == 0.5);
                    [m.states[0].w3, m.states[1].w3]
                };
                let (rest, slow) = (rolling(0.0), rolling(1e-9));
                let off = (0..2).map(|i| (rest[i] - slow[i]).abs()).fold(0.0, larger);
                assert!(off < 1e-8, "{ell} {law:?} {size}: {rest:?} {slow:?}");
                // Friction on both rims turns the body unless the loss is strong.
                assert_eq!(rest == [0.0; 2], size == 0.5, "{rest:?}");
                rolls_off += u32::from(rest[0] != 0.0);
            }
        }
    }
    assert_eq!(rolls_off, 20);
}

#[test]
fn what_lies_on_ice_keeps_its_velocities_and_both_rims_share_the_weight_with_the_launch_number() {
    let body = Body::solid(1.2).unwrap();
    let (w1, w3) = (0.8, 0.9);
    let m = moved(&body, lying(&body, w1, w3, [0.3, -0.2]), 0.0, &[1.0, 7.0]);
    assert_eq!(kinds(&m), [Kind::Lying]);
    for (y, force) in m.states.iter().zip(m.forces.as_ref().unwrap()) {
        assert!((y.w1 - w1).abs() < 1e-14 && (y.w3 - w3).abs() < 1e-14);
        let share = body.i3() * w1 * w3 / body.ell();
        assert!((force.normal - 0.5 * (1.0 + share)).abs() < 1e-14);
    }
    // Above a launch number of 1 an end rises.
    let rises = moved(&body, lying(&body, 2.0, 1.3 * body.ell() / (body.i3() * 2.0), [0.0; 2]), 0.0, &[0.1]);
    assert_eq!(kinds(&rises), [Kind::Slipping]);
}

/// A random body on its side, with random velocities and a coefficient of friction.
fn any_lying(r: &mut impl FnMut() -> f64) -> (Body, Start, f64) {
    let body = Body::tube(0.4 + 3.0 * r(), r()).unwrap();
    let mut speed = || 3.0 * r() - 1.5;
    let (w1, w3, u, v) = (speed(), speed(), speed(), speed());
    let state = State { theta: FRAC_PI_2, w1, w2: 0.0, w3 };
    (body, Start::from(state).with_slip(Slip::new(u, v)), 0.05 + 0.5 * r())
}

/// Kinetic and potential energy, from the velocity of the centre.
fn energy(body: &Body, y: &State, [u, v]: [f64; 2]) -> f64 {
    let (s, c) = y.theta.sin_cos();
    let (ell, a, rho) = (body.ell(), body.rim(), body.fillet());
    let (height, lever) = (ell * c + a * s + rho, ell * s - a * c);
    let forth = u + height * y.w2;
    let aside = v - (ell + rho * c) * y.w1 + (a + rho * s) * y.w3;
    let moving = forth * forth + aside * aside + lever * lever * y.w2 * y.w2;
    0.5 * (moving + body.i1() * (y.w1 * y.w1 + y.w2 * y.w2) + body.i3() * y.w3 * y.w3) + height
}

#[test]
fn energy_heat_and_losses_are_constant_while_both_rims_press_and_their_friction_is_within_its_cone() {
    let mut r = wander(521);
    let mut met = [0; 6];
    for k in 0..drawn(240) {
        let (body, start, mu) = any_lying(&mut r);
        let losses = match k % 4 {
            0 => Losses::NONE,
            1 => Losses::of(Law::RollingResistance, 0.02) + Losses::of(Law::Drilling, 0.03),
            2 => Losses::of(Law::AirLinear, 0.05) + Losses::of(Law::DryContour, 0.01),
            _ => Losses::of(Law::ViscousContour, 0.1) + Losses::of(Law::BoundaryLayer, 0.05),
        };
        let times: Vec<f64> = (1..80).map(|k| 0.2 * f64::from(k)).collect();
        let m = losing(&body, start, Friction::coulomb(mu), losses, &times);
        let path = m.path.as_ref().unwrap();
        let whole = |i: usize| {
            let lost = path.work_lost.get(i).copied().unwrap_or(0.0);
            let struck: f64 =
                path.impacts.iter().filter(|hit| hit.time < m.times[i]).map(|hit| hit.lost).sum();
            let AboveTable { height, lift, .. } = path.aloft[i];
            let rise = height + lift * (lift / 2.0 + lever(&body, &m.states[i]) * m.states[i].w2);
            energy(&body, &m.states[i], path.slip[i].into()) + rise + path.dissipated[i] + lost + struck
        };
        let first = energy(&body, &start.state, start.slip.into());
        for (i, kind) in path.kinds.iter().enumerate() {
            met[*kind as usize] += 1;
            assert!(
                (whole(i) - first).abs() < 3e-12 * (1.0 + first),
                "{body:?} {start:?} {mu} {losses:?}: {:e}",
                whole(i) - first
            );
            if !matches!(kind, Kind::Lying | Kind::Pivoting | Kind::RollingOnItsSide) {
                assert!(path.other_rim[i].slip.u_h.is_nan() && path.other_rim[i].force.normal.is_nan());
                continue;
            }
            let here = m.forces.as_ref().unwrap()[i];
            let there = path.other_rim[i].force;
            assert!((here.normal + there.normal - 1.0).abs() < 1e-13);
            for force in [here, there] {
                assert!(force.normal >= -1e-12 && force.friction() <= mu * force.normal + 1e-10);
            }
            assert!(m.states[i].theta == FRAC_PI_2 && m.states[i].w2 == 0.0);
        }
    }
    assert!(met.iter().all(|count| *count > 0), "{met:?}");
}

fn lever(body: &Body, y: &State) -> f64 {
    body.ell() * y.theta.sin() - body.rim() * y.theta.cos()
}

#[test]
fn friction_without_a_couple_keeps_the_sum_of_spin_and_velocity_and_the_fillet_does_not_matter_while_it_lies()
{
    let mut r = wander(522);
    for _ in 0..drawn(90) {
        let (body, start, mu) = any_lying(&mut r);
        let round = Body::rounded(body.ell(), body.i1(), body.i3(), 0.3).unwrap();
        let times: Vec<f64> = (1..40).map(|k| 0.1 * f64::from(k)).collect();
        let (sharp, other) = (moved(&body, start, mu, &times), moved(&round, start, mu, &times));
        let (a, b) = (sharp.path.as_ref().unwrap(), other.path.as_ref().unwrap());
        let lies = |kind: &Kind| *kind != Kind::Slipping && *kind != Kind::Rolling && *kind != Kind::Flying;
        let count = a.kinds.iter().zip(&b.kinds).take_while(|(a, b)| lies(a) && lies(b)).count();
        for i in 0..count {
            let (x, y) = (sharp.states[i], other.states[i]);
            assert!((x.w1 - y.w1).abs() < 1e-12 && (x.w3 - y.w3).abs() < 1e-12, "{body:?} {start:?}");
        }
    }
}

#[test]
fn the_mirror_image_of_a_lying_body_moves_as_its_mirror_image() {
    let mut r = wander(523);
    for _ in 0..drawn(90) {
        let (body, start, mu) = any_lying(&mut r);
        let y = start.state;
        let mirror = State { w1: -y.w1, w3: -y.w3, ..y };
        let image = Start::from(mirror).with_slip(Slip::new(start.slip.u_h, -start.slip.u_2));
        let (one, two) = (moved(&body, start, mu, &[1.0, 4.0]), moved(&body, image, mu, &[1.0, 4.0]));
        for (a, b) in one.states.iter().zip(&two.states) {
            let far = one.error + two.error + 1e-13;
            assert!(
                (a.w1 + b.w1).abs() < far && (a.w3 + b.w3).abs() < far && (a.theta - b.theta).abs() < far
            );
        }
        // Told from the other rim it is the same motion.
        let (there, slip) = spincyl::contact::landing::mirrored(&body, &y, start.slip);
        let seen = moved(&body, Start::from(there).with_slip(slip), mu, &[1.0, 4.0]);
        for (a, b) in one.states.iter().zip(&seen.states) {
            let far = 10.0 * (one.error + seen.error) + 1e-12;
            assert!(
                (a.w1 - b.w1).abs() < far && (a.w3.abs() - b.w3.abs()).abs() < far,
                "{body:?} {start:?} {mu}"
            );
        }
    }
}

#[test]
fn weak_flicks_of_the_papers_tube_slide_pivot_rise_and_roll_straight_at_known_times() {
    let tube = Body::tube(6.0, 0.8).unwrap();
    let flicked = |x: f64, w1: f64| {
        let w3 = x * 6.0 / (tube.i3() * w1);
        lying(&tube, w1, w3, [0.0, -tube.i1() / 6.0 * w1])
    };
    let of = |x: f64, w1: f64, until: f64| moved(&tube, flicked(x, w1), 0.3, &[until]);
    let times =
        |m: &Motion| -> Vec<f64> { m.path.as_ref().unwrap().phases.iter().map(|phase| phase.time).collect() };
    let near = |a: f64, b: f64| (a - b).abs() < 6e-4 * (1.0 + b / 10.0);
    let slides = of(0.5, 1.5, 30.0);
    assert_eq!(kinds(&slides), [Kind::Lying, Kind::RollingOnItsSide]);
    assert!(near(settles(&slides), 16.70) && (slides.states[0].w3.abs() - 2.092).abs() < 5e-4);
    let pivots = of(0.9, 1.5, 50.0);
    let told = times(&pivots);
    let about = [0.0, 13.193, 15.992, 19.828, 33.104];
    assert_eq!(
        kinds(&pivots)[..5],
        [Kind::Lying, Kind::Lying, Kind::Pivoting, Kind::Lying, Kind::RollingOnItsSide]
    );
    assert!(told.iter().zip(about).all(|(a, b)| near(*a, b)), "{told:?}");
    let rises = of(0.9, 3.0, 40.0);
    assert_eq!(kinds(&rises)[..2], [Kind::Lying, Kind::Slipping]);
    assert!(near(times(&rises)[1], 1.139) && kinds(&rises).contains(&Kind::Rolling));
    assert!(near(settles(&of(0.5, 3.0, 60.0)), 42.0));
    let again = of(1.2, 1.5, 30.0);
    let lies = again.path.as_ref().unwrap().phases.iter().find(|phase| phase.kind == Kind::Lying).unwrap();
    assert!(near(lies.time, 14.848), "{}", lies.time);
    // A larger static friction lets the pivot go later, an infinite one never.
    let held = |fixed: f64| {
        let law = Friction::Coulomb { mu: 0.3, fixed, patch: 0.0 };
        losing(&tube, flicked(0.9, 1.5), law, Losses::NONE, &[60.0])
    };
    assert!(near(times(&held(0.35))[3], 20.4615));
    assert_eq!(kinds(&held(f64::INFINITY)), [Kind::Lying, Kind::Pivoting, Kind::RollingOnItsSide]);
}

#[test]
fn a_short_cylinder_rocks_from_rim_to_rim_for_the_time_of_housners_block() {
    let body = Body::solid(0.3).unwrap();
    let start = State { theta: 1.4, w1: 0.0, w2: 0.0, w3: 0.0 };
    let m = moved(&body, start.into(), 3.0, &[1.0, 30.0]);
    let path = m.path.as_ref().unwrap();
    assert!((path.phases[1].time - 1.755_135_128_0).abs() < 1e-10);
    let rest = path.phases.last().unwrap();
    assert_eq!(rest.kind, Kind::RollingOnItsSide);
    assert!((rest.time - 17.224_877_760_867_154).abs() < 1e-11, "{:e}", rest.time - 17.224_877_760_867_154);
    assert!(m.error < 1e-10);
    // Energy of the fall, less that of lying, is lost in the landings.
    let lost = energy(&body, &start, [0.0; 2]) - 1.0;
    let impacts: f64 = path.impacts.iter().map(|impact| impact.lost).sum();
    assert!((path.heat + impacts - lost).abs() < 1e-12);
    assert!(path.impacts.iter().all(|impact| impact.hit == Hit::BothRims && impact.impulse[2] > 0.0));
    // On ice the body lies down if ell^2 >= I1, and rocks if it is shorter.
    for (ell, lies) in [(0.55, false), (0.62, true)] {
        let ice = Body::solid(ell).unwrap();
        let falls = State { theta: 1.2, w1: 0.0, w2: -0.1, w3: 0.0 };
        let m = moved(&ice, Start::from(falls).with_slip(Slip::new(0.3, 0.0)), 0.0, &[9.0]);
        let path = m.path.as_ref().unwrap();
        assert_eq!(path.phases.len() == 2, lies, "{ell} {:?}", path.phases);
    }
}

#[test]
fn a_short_tube_rocks_from_rim_to_rim_until_the_rim_that_all_but_rests_holds_it() {
    // mu > 2 ell: one rim rises before the slip of the other one ends, and they rock, lower and lower, for 3.7e-6.
    let body =
        Body::rounded_tube(0.374_840_700_051_780_9, 0.393_342_700_893_249_74, 0.364_701_296_500_763_44);
    let body = body.unwrap();
    let start = State { theta: FRAC_PI_2, w1: 0.3, w2: 0.0, w3: 0.0 };
    let m = moved(&body, start.into(), 0.1, &[0.3, 1.0, 100.0]);
    let path = m.path.as_ref().unwrap();
    assert_eq!((m.ending(), *kinds(&m).last().unwrap()), (Ending::Done, Kind::RollingOnItsSide));
    let pivot = path.phases.iter().find(|phase| phase.kind == Kind::Pivoting).unwrap();
    assert!((pivot.time - 0.231_777_343).abs() < m.error && m.error < 1e-8, "{} {:e}", pivot.time, m.error);
    // A model of slips beside a fast one has this pivot after 19,000 hops.
    let (i1, i3, ell, mu) = (body.i1(), body.i3(), body.ell(), 0.1);
    let (a, b) = (1.0 + 1.0 / i3 + ell * ell / i1, 1.0 + 1.0 / i3 - ell * ell / i1);
    let rates = |w1: f64, w3: f64| {
        let over = 0.5 * mu * (ell - w1 * ((1.0 + i3) * w3 - ell * w1)) / ell;
        let here = -b / a * over;
        (ell * (here - over) / i1, -(here + over) / i3)
    };
    let (mut w1, mut w3) = (0.299_214_995_743_797_7, 0.003_991_789_540_541_453);
    let step = (0.3 - 0.231_777_343_333) / 1000.0;
    for _ in 0..1000 {
        let (x, y) = rates(w1, w3);
        let (x, y) = rates(w1 + 0.5 * step * x, w3 + 0.5 * step * y);
        (w1, w3) = (w1 + step * x, w3 + step * y);
    }
    let found = &m.states[0];
    let off = (found.w1 - w1).abs().max((found.w3 + w3).abs());
    assert!(off < 1e-11 && off < m.error, "{off:e} {:e}", m.error);
    let has = |y: &State, slip| energy(&body, y, slip);
    let (last, lost): (_, f64) =
        (m.states.last().unwrap(), path.impacts.iter().map(|impact| impact.lost).sum());
    let left = has(&start, [0.0; 2]) - has(last, [0.0; 2]) - path.heat - lost;
    assert!(left.abs() < 1e-11, "{left:e}");
}

#[test]
fn rolling_straight_with_losses_stops_after_the_time_of_its_dry_couple_or_fades_in_air() {
    let body = Body::solid(1.0).unwrap();
    let grip = Friction::coulomb(0.5);
    let start = lying(&body, 0.0, 1.5, [0.0, 1.5]);
    let dry = Losses::of(Law::RollingResistance, 0.02) + Losses::of(Law::DryContour, 0.03);
    let until = (1.0 + body.i3()) * 1.5 / 0.05;
    let m = losing(&body, start, grip, dry, &[0.5 * until, 2.0 * until]);
    let event = m.event.unwrap();
    assert_eq!(event.ending, Ending::Stops);
    assert!((event.time - until).abs() < 1e-10 && (m.states[0].w3 - 0.75).abs() < 1e-12);
    let air = losing(&body, start, grip, Losses::of(Law::AirLinear, 0.1), &[10.0]);
    assert!((air.states[0].w3 - 1.5 * (-0.1 * 10.0 / (1.0 + body.i3())).exp()).abs() < 1e-12);
    let square = losing(&body, start, grip, Losses::of(Law::AirQuadratic, 0.1), &[10.0]);
    let inverse = 1.0 / 1.5 + 0.1 * 10.0 / (1.0 + body.i3());
    assert!((square.states[0].w3 - 1.0 / inverse).abs() < 1e-12);
    // Friction that cannot give the couple's force lets the rims slip: more than mu (1 + I3).
    let steep = Losses::of(Law::RollingResistance, 0.9);
    let slips = roll_with(&body, start, &[1.0], &ask(grip, steep), || true).unwrap().unwrap();
    assert_eq!(slips.path.unwrap().phases[0].kind, Kind::Lying);
    // v' = -mu and I3 w3' = mu - delta then, and u_2 grows.
    let (y, mu) = (slips.states[0], 0.5);
    assert!((y.w3 - (1.5 + (mu - 0.9) / body.i3())).abs() < 1e-11, "{}", y.w3);
}

#[test]
fn what_two_rims_do_not_determine_is_refused_by_its_name() {
    // Below ell = mu/2 three distributions of the normal forces may be consistent, where the rims slip in different
    // directions and I3 w1 w3 lies within a band.
    let body = Body::solid(0.2).unwrap();
    let of = |w3: f64| {
        let state = State { theta: FRAC_PI_2, w1: 5.0, w2: 0.0, w3 };
        let start = Start::from(state).with_slip(Slip::new(0.5, 0.0));
        roll_with(&body, start, &[0.01], &ask(Friction::coulomb(1.0), Losses::NONE), || true)
    };
    for (w3, refused) in [(-0.25, true), (-0.2, true), (-0.5, false), (0.3, false)] {
        let ending = of(w3).map(|m| m.unwrap().ending());
        let found = matches!(ending, Ok(Ending::Painleve) | Err(Error::Painleve { .. }));
        assert_eq!(found, refused, "{w3}: {ending:?}");
    }
}

#[test]
fn on_both_rims_the_lean_turns_no_faster_than_the_body_whichever_rim_sticks() {
    // Slips of one rim pass through zero in the first three; the last one rocks to its other rim before.
    let scenes = [
        ([0.45, 0.38, 0.625], [FRAC_PI_2, 0.154, 0.0, -0.401], [-1.142, -0.872], [0.5, 0.75], Law::Drilling),
        (
            [2.5, 7.0 / 3.0, 0.5],
            [FRAC_PI_2, -0.373, 0.0, 0.699],
            [-0.113, -2.183],
            [0.2; 2],
            Law::RollingResistance,
        ),
        ([0.6, 0.4325, 0.625], [FRAC_PI_2, 0.289, 0.0, 0.194], [-1.095, 0.8], [0.5; 2], Law::Drilling),
        ([0.6, 0.37, 0.5], [1.281, -0.523, -0.269, 0.226], [0.0; 2], [0.2, 0.3], Law::Drilling),
    ];
    let times: Vec<f64> = (1..=400).map(|i| 0.01 * f64::from(i)).collect();
    for ([ell, i1, i3], [theta, w1, w2, w3], slip, [mu, fixed], law) in scenes {
        let body = Body::new(ell, i1, i3).unwrap();
        let start = Start::from(State { theta, w1, w2, w3 }).with_slip(slip.into());
        let ask =
            ask(Friction::Coulomb { mu, fixed, patch: 0.0 }, Losses::of(law, 0.03)).with_pose().with_force();
        let m = roll_with(&body, start, &times, &ask, || true).unwrap().unwrap();
        let (poses, path) = (m.poses.as_ref().unwrap(), m.path.as_ref().unwrap());
        let lies = |i: usize| path.kinds[i] as u8 >= Kind::Lying as u8;
        let mut seen = 0;
        for i in 1..m.times.len() {
            if lies(i - 1) && lies(i) {
                seen += 1;
                // Friction at neither rim gives energy, whichever of them the motion is followed from.
                let (push, Slip { u_h: u, u_2: v, .. }) = (m.forces.as_ref().unwrap()[i], path.slip[i]);
                let OtherRim { slip: Slip { u_h: u_up, u_2: v_up, .. }, force: pull, .. } = path.other_rim[i];
                // A force has its name from the direction of rolling, which is across the lean.
                assert!(push.across * u + push.along * v < 1e-12, "{body:?} {}", m.times[i]);
                assert!(pull.across * u_up + pull.along * v_up < 1e-12, "{body:?} {}", m.times[i]);
                let fast = m.states[i - 1].w1.abs().max(m.states[i].w1.abs());
                let turned = poses[i].phi.radians() - poses[i - 1].phi.radians();
                assert!(turned.abs() < 1.2 * fast * 0.01 + 1e-9, "{body:?} {} {turned}", m.times[i]);
                assert!((m.states[i].w3 - m.states[i - 1].w3).abs() < 0.1);
            }
        }
        assert!(seen > 100, "{body:?} {seen}");
    }
}

#[test]
fn a_coin_that_spins_down_on_its_edge_rolls_to_and_fro_until_rolling_resistance_holds_it() {
    let coin = Body::solid(2.2 / 25.75).unwrap();
    let losses = Losses::of(Law::RollingResistance, 0.05 / 12.875);
    for k in 0..10 {
        let state = State { theta: FRAC_PI_2, w1: 1.5 + 0.01 * f64::from(k), w2: 0.0, w3: -0.0828 };
        let start = Start::from(state).with_slip(Slip::new(0.0026, 0.2545));
        let m = losing(&coin, start, Friction::coulomb(0.3), losses, &[100.0]);
        assert_eq!(m.event.map(|end| end.ending), Some(Ending::Stops));
        assert!(m.evaluations < 50_000, "{}", m.evaluations);
    }
}
