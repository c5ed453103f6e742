//! Random bodies of two circles: from any start their motion is computed to its end, and the energy balance holds.

use crate::circles::frustum;
use crate::common::{drawn, larger, wander};
use crate::cups::balls;
use spincyl::body::Circle;
use spincyl::contact::slip::Friction;
use spincyl::motion::{Ask, Ending, Motion, Start, roll_with};
use spincyl::{Body, Error, State};
use std::collections::BTreeMap;
use std::panic::catch_unwind;

/// A random case: a cup or a cone, either way up, or two unequal balls, with a random start.
struct Scene {
    body: Body,
    start: Start,
    mu: f64,
    e: f64,
}

fn scene(seed: u64) -> Scene {
    let mut next = wander(seed);
    let (r, height) = (0.2 + 0.79 * next(), 0.2 + 2.5 * next());
    let body = match (6.0 * next()) as usize {
        0 => frustum([r, 1.0], height),
        1 => frustum([1.0, r], height),
        2 => frustum([0.0, 1.0], height),
        3 => frustum([1.0, 0.0], height),
        4 => balls([1.0, r]),
        _ => balls([r, 1.0]),
    };
    let (mu, e) = (0.05 + 0.95 * next(), [0.0, 0.3, 0.9][(3.0 * next()) as usize]);
    let size = [0.3, 1.0, 3.0][(3.0 * next()) as usize];
    let mut speed = || size * (2.0 * next() - 1.0);
    let (w1, w2, w3, slip) = (speed(), speed(), speed(), [speed(), speed()]);
    let kind = (6.0 * next()) as usize;
    let mut at = |theta: Option<f64>, w: [f64; 3]| {
        let theta = theta.unwrap_or_else(|| 0.1 + 2.9 * next());
        Start::from(State { theta, w1: w[0], w2: w[1], w3: w[2] })
    };
    let border = Some(body.theta_end());
    let start = match kind {
        0 => at(None, [w1, w2, w3]),
        1 => at(None, [w1, w2, w3]).with_slip(slip.into()),
        2 => at(border, [w1, 0.0, w3]).with_slip(slip.into()),
        3 => at(None, [0.0; 3]),
        4 => at(border, [w1, -w2.abs(), w3]).with_slip(slip.into()),
        _ => at(border, [w1, 0.0, w3]),
    };
    Scene { body, start, mu, e }
}

/// Depth, lever and height of a circle at an inclination, and its radius of contact.
fn touching(circle: &Circle, theta: f64) -> [f64; 4] {
    let ((s, c), Circle { radius, depth, fillet }) = (theta.sin_cos(), *circle);
    [depth + fillet * c, depth * s - radius * c, depth * c + radius * s + fillet, radius + fillet * s]
}

impl Scene {
    fn energy(&self, y: &State, [along, across]: [f64; 2], [height, lift]: [f64; 2], rim: u8) -> f64 {
        let [depth, lever, above, radius] = touching(&self.body.circles()[usize::from(rim)], y.theta);
        let v = [along + above * y.w2, across - depth * y.w1 + radius * y.w3, lift + lever * y.w2];
        let turning = self.body.i1() * (y.w1 * y.w1 + y.w2 * y.w2) + self.body.i3() * y.w3 * y.w3;
        0.5 * (v.into_iter().map(|v| v * v).sum::<f64>() + turning) + above + height
    }

    /// The largest change of the energy plus all energy that friction and impacts have taken, over the energy.
    fn energy_lost(&self, m: &Motion) -> f64 {
        let (path, Start { state, slip, .. }) = (m.path.as_ref().unwrap(), self.start);
        let whole = self.energy(&state, slip.into(), [0.0; 2], u8::from(state.theta > self.body.theta_end()));
        let at = |i: usize| {
            let struck = path.impacts.iter().filter(|hit| hit.time <= m.times[i]).map(|hit| hit.lost);
            let has = self.energy(&m.states[i], path.slip[i].into(), path.aloft[i].into(), path.rims[i]);
            (has + path.dissipated[i] + struck.sum::<f64>() - whole).abs() / whole.max(1.0)
        };
        (0..m.states.len()).map(at).fold(0.0, larger)
    }

    /// Whether friction is near that of the paradox of Painleve, where no contact force is unique, on one circle or
    /// on both.
    fn jams(&self, theta: f64) -> bool {
        self.body.circles().iter().any(|circle| {
            let [_, lever, height, _] = touching(circle, theta);
            self.mu > 0.9 * (self.body.i1() + lever * lever) / (lever * height).abs()
        })
    }

    /// A description of what is wrong with this motion up to the time 50; None if nothing is.
    fn fault(&self) -> Option<String> {
        let ask = Ask::on(Friction::coulomb(self.mu)).with_restitution(self.e);
        let times: Vec<f64> = (1..=50).map(f64::from).collect();
        let Ok(found) = catch_unwind(|| roll_with(&self.body, self.start, &times, &ask, || true)) else {
            return Some("panics".into());
        };
        let m = match found {
            Ok(m) => m.expect("nobody interrupts"),
            Err(Error::Painleve { theta, .. }) if self.jams(theta) => return None,
            Err(error) => return Some(format!("{error:?}")),
        };
        let jams = m.event.is_some_and(|end| end.ending == Ending::Painleve && self.jams(end.state.theta));
        if !jams && !matches!(m.ending(), Ending::Done | Ending::Face | Ending::Stops) {
            return Some(format!("{:?} {:?} at {:?}", m.ending(), m.limit, m.event.unwrap().time));
        }
        let off = self.energy_lost(&m);
        if off > 1e-12_f64.max(m.error) {
            return Some(format!("energy {off:e}, error {:e}", m.error));
        }
        (m.evaluations > MOST_EVALUATIONS).then(|| format!("{} evaluations", m.evaluations))
    }
}

/// A number of evaluations that is more than a motion up to the time 50 needs.
const MOST_EVALUATIONS: u64 = 1_000_000;

fn faults(seeds: impl Iterator<Item = u64>) -> BTreeMap<u64, String> {
    seeds.filter_map(|seed| scene(seed).fault().map(|fault| (seed, fault))).collect()
}

#[test]
fn a_random_body_of_two_circles_is_followed_to_the_end_and_keeps_its_energy() {
    let found = faults(10_000..10_000 + drawn(300) as u64);
    assert!(found.is_empty(), "{found:?}");
}

#[test]
fn bodies_of_two_circles_that_were_given_up_or_lost_energy_are_followed() {
    let known = [
        34, 106, 166, // a slip on one circle, after one on the other, had the series of the other
        103, 227, // a tip rolls
        178, 1095, 1211, 1280, 1874,
        2328, // a circle that hardly rises, or comes back with no velocity, lands again
        406, 478, 631, // slips that stop in the hops of a rocking
        54, 120, 189, 219, 473, 629, 1105, 1942, 2354, 2426, // hops as low as the roundings of theta
        1802, 2358, // a circle that does not rise
        2059, // both circles leave the table
    ];
    let found = faults(known.into_iter());
    assert!(found.is_empty(), "{found:?}");
}

#[test]
#[ignore = "a search of some minutes"]
fn random_bodies_of_two_circles_are_searched() {
    let first = std::env::var("SPINCYL_FIRST").map_or(20_000, |first| first.parse().unwrap());
    let found = faults(first..first + 10_000);
    found.iter().for_each(|(seed, fault)| println!("{seed}: {fault}"));
    assert!(found.is_empty(), "{} of 10,000", found.len());
}
