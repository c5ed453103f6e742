//! Bodies with several circles of contact: the unit of length, the view from either end, and what lies on two circles.

use crate::common::wander;
use spincyl::body::Circle;
use spincyl::contact::Contact;
use spincyl::contact::slip::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::{Ask, Start, roll, roll_with};
use spincyl::{Body, State, stability, steady};

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
        assert_eq!(
            [body.theta_balance(), body.theta_limit()].map(f64::to_bits),
            [large.theta_balance(), large.theta_limit()].map(f64::to_bits)
        );
        let [rate, slow] = [&body, &large].map(|body| steady::rate(body, theta));
        assert!(
            (rate - 2.0 * slow).abs() <= 1e-13 * rate.abs() || rate.is_nan() && slow.is_nan(),
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
            let start =
                |y, factor: f64| Start::from(state(y)).with_slip([factor * slip[0], factor * slip[1]]);
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
