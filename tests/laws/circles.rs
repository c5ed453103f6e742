//! Bodies with several circles of contact: change of the unit of length, states counted from either end, and bodies
//! that lie on two circles.

use crate::common::{larger, wander};
use spincyl::body::Circle;
use spincyl::contact::Contact;
use spincyl::contact::slip::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::{Ask, Ending, Start, roll, roll_with};
use spincyl::{Body, Slip, State, stability, steady};

/// A power of two, by which all lengths change without a rounding.
const UNIT: f64 = 4.0;

/// A body with one circle, and the same body in a unit of length that is four times smaller.
fn in_both_units(next: &mut impl FnMut() -> f64) -> [Body; 2] {
    let (fillet, depth) = ([0.0, 0.3, 1.0][(3.0 * next()) as usize], next() - 0.3);
    let depth = if fillet < 1.0 { depth.abs() } else { depth };
    let i3 = 0.2 + next();
    let i1 = i3 * (0.51 + next());
    let of = |unit: f64| {
        let circle = Circle { radius: unit * (1.0 - fillet), depth: unit * depth, fillet: unit * fillet };
        Body::profile(&[circle], unit * unit * i1, unit * unit * i3).unwrap()
    };
    [of(1.0), of(UNIT)]
}

#[test]
fn a_body_in_another_unit_of_length_has_the_same_states_and_moves_the_same_way() {
    let mut next = wander(5);
    for _ in 0..200 {
        let [body, large] = in_both_units(&mut next);
        let theta = 0.1 + 1.4 * next();
        let ends = |body: &Body| [body.theta_balance(), body.theta_limit()];
        let same = |a: f64, b: f64| (a - b).abs() < 1e-15 || a.is_nan() && b.is_nan();
        assert!(ends(&body).into_iter().zip(ends(&large)).all(|(a, b)| same(a, b)));
        let [rate, slow] = [&body, &large].map(|body| steady::rate(body, theta));
        assert!(
            (slow - 2.0 * rate).abs() <= 1e-13 * slow.abs() || rate.is_nan() && slow.is_nan(),
            "{rate}, {slow}, {body:?}"
        );
        for contact in [Contact::Rolling, Contact::Smooth] {
            let [kappa, less] = [&body, &large].map(|body| stability::at_rest(body, theta, contact));
            assert!(
                (kappa - UNIT * less).abs() <= 1e-11 * kappa.abs().max(1.0)
                    || kappa.is_nan() && less.is_nan(),
                "{kappa}, {less}"
            );
        }
        let mut number = || 2.0 * next() - 1.0;
        let w = [number(), number(), number()];
        let times = [0.0, 0.7, 1.5, 3.0];
        let [[y, there], [slip, _]] = [[w, w.map(|x| 0.5 * x)], [[number(), number(), 0.0]; 2]];
        let state = |[w1, w2, w3]: [f64; 3]| State { theta, w1, w2, w3 };
        let later = times.map(|t| 2.0 * t);
        let close = |a: &State, b: &State| {
            let off = [a.theta - b.theta, a.w1 - 2.0 * b.w1, a.w2 - 2.0 * b.w2, a.w3 - 2.0 * b.w3];
            off.into_iter().all(|x| x.abs() < 1e-9)
        };
        let [m, n] = [roll(&body, &state(y), &times).unwrap(), roll(&large, &state(there), &later).unwrap()];
        assert_eq!((m.states.len(), m.ending()), (n.states.len(), n.ending()), "{body:?}, {theta}, {w:?}");
        assert!(m.states.iter().zip(&n.states).all(|(a, b)| close(a, b)), "{body:?}, {theta}, {w:?}");
        let ask = |losses: Losses| Ask::on(Friction::coulomb(0.3)).with_losses(losses).with_restitution(0.3);
        let losses = Losses::NONE.with(Law::DryContour, 0.03).with(Law::Drilling, 0.01);
        let scaled = Losses::NONE.with(Law::DryContour, 0.03).with(Law::Drilling, UNIT * 0.01);
        for [losses, scaled] in [[Losses::NONE; 2], [losses, scaled]] {
            let start = |y, factor: f64| {
                Start::from(state(y)).with_slip(Slip::new(factor * slip[0], factor * slip[1]))
            };
            let m = roll_with(&body, start(y, 1.0), &times, &ask(losses), || true).unwrap().unwrap();
            let n = roll_with(&large, start(there, 2.0), &later, &ask(scaled), || true).unwrap().unwrap();
            assert_eq!(
                (m.states.len(), m.ending()),
                (n.states.len(), n.ending()),
                "{body:?}, {theta}, {w:?}"
            );
            assert!(m.states.iter().zip(&n.states).all(|(a, b)| close(a, b)), "{body:?}, {theta}, {w:?}");
        }
    }
}

/// A uniform frustum of these radii at its lower and upper end, and of this height.
pub fn frustum([r, q]: [f64; 2], height: f64) -> Body {
    let mut sums = [0.0; 4];
    let (nodes, weights) = (
        [-0.932_469_514_203_152, -0.661_209_386_466_264_5, -0.238_619_186_083_196_9],
        [0.171_324_492_379_170_3, 0.360_761_573_048_138_6, 0.467_913_934_572_691],
    );
    for k in 0..6 {
        let (x, weight) = if k < 3 { (nodes[k], weights[k]) } else { (-nodes[5 - k], weights[5 - k]) };
        let at = 0.5 * (1.0 + x);
        let (radius, z, weight) = (r + (q - r) * at, height * at, 0.5 * height * weight);
        let square = radius * radius;
        let parts = [square, square * z, 0.5 * square * square, 0.25 * square * square + square * z * z];
        sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += weight * part);
    }
    let [mass, moment, axial, across] = sums;
    let centre = moment / mass;
    let circle = |radius, z: f64| Circle { radius, depth: centre - z, fillet: 0.0 };
    let i1 = across / mass - centre * centre;
    Body::profile(&[circle(r, 0.0), circle(q, height)], i1, axial / mass).unwrap()
}

#[test]
fn a_short_frustum_rocks_to_rest_after_infinitely_many_landings() {
    let body = frustum([0.9, 1.0], 0.5);
    assert!((body.i1() - 0.247_437_955_3).abs() < 1e-9 && (body.i3() - 0.453_332_103_3).abs() < 1e-9);
    let start = Start::from(State { theta: 1.36, w1: 0.0, w2: 0.0, w3: 0.0 });
    let ask = Ask::on(Friction::coulomb(0.9)).with_restitution(0.0);
    let m = roll_with(&body, start, &[8.0], &ask, || true).unwrap().unwrap();
    let path = m.path.as_ref().unwrap();
    // Each landing turns w2 into 0.831 or 0.965 of it: (H + g g')/(H + g^2) with H = I1 + Z^2.
    let rests = path.phases.last().unwrap().time;
    assert!((rests - 6.701_437_58).abs() < 2e-8, "{rests}");
    let height = |theta: f64| body.ell() * theta.cos() + body.rim() * theta.sin();
    let lost: f64 = path.impacts.iter().map(|hit| hit.lost).sum();
    assert!((lost - (height(1.36) - height(body.theta_end()))).abs() < 1e-12, "{lost}");
    assert!(path.phases.len() > 100 && m.ending() == Ending::Done);
}

#[test]
fn a_cup_that_is_rolled_moves_round_the_apex_of_its_cone_and_keeps_its_energy() {
    let body = frustum([0.7, 1.0], 2.0);
    let (s, c) = body.theta_end().sin_cos();
    // 0.36 is below the rate at which the narrow end rises.
    let rate: f64 = 0.36;
    let w_h = rate * s / c;
    let state = State { theta: body.theta_end(), w1: c * w_h, w2: 0.0, w3: -s * w_h };
    let round = std::f64::consts::TAU / rate;
    let ask = Ask::on(Friction::coulomb(0.9)).with_restitution(0.0).with_pose();
    let m = roll_with(&body, Start::from(state), &[0.0, 0.5 * round, round], &ask, || true).unwrap().unwrap();
    let at = |i: usize| m.poses.as_ref().unwrap()[i].contact_point;
    let [first, far, back] = [0, 1, 2].map(at);
    // The circle of the narrow end has the radius r D/(R - r).
    let (wide, span) = (far - first, 0.3f64.hypot(2.0));
    assert!((wide.norm() - 2.0 * 0.7 * span / 0.3).abs() < 1e-11, "{wide:?}");
    assert!((back - first).norm() < 1e-11);
    assert_eq!(m.path.as_ref().unwrap().phases.len(), 1);
}

#[test]
fn a_cap_that_swings_over_its_pole_comes_to_its_edge_on_the_other_side() {
    // A cap of a unit ball, cut at the height 0.35 below its centre, that rocks without friction in a vertical plane.
    let (depth, edge) = (-0.6, 0.35f64);
    let circle = |radius, depth, fillet| Circle { radius, depth, fillet };
    let circles = [circle(0.0, depth, 1.0), circle((1.0 - edge * edge).sqrt(), depth + edge, 0.0)];
    let body = Body::profile(&circles, 0.25, 0.4).unwrap();
    let joint = edge.acos();
    assert!((body.theta_end() - joint).abs() < 1e-15);
    let start = Start::from(State { theta: joint + 0.2, w1: 0.0, w2: 0.0, w3: 0.0 });
    let times: Vec<f64> = (0..200).map(|k| 0.05 * f64::from(k)).collect();
    for mu in [0.0, 0.05] {
        let ask = Ask::on(Friction::coulomb(mu)).with_restitution(0.0);
        let m = roll_with(&body, start, &times, &ask, || true).unwrap().unwrap();
        let rims = &m.path.as_ref().unwrap().rims;
        let over = m.states.iter().filter(|y| y.theta > joint).count();
        assert_eq!(m.ending(), Ending::Done);
        assert!(over > 10 && m.states.iter().zip(rims).all(|(y, rim)| (y.theta > joint) == (*rim == 1)));
        let turns = m.states.iter().map(|y| y.theta).fold(0.0, larger);
        assert!(turns <= joint + 0.2 + 1e-12);
    }
}
