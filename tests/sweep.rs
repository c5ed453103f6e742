//! Maps, scattered points and surveys, of sharp and of rounded bodies: against single calls, and against the maps that
//! surveys do not make.

mod common;

use common::{any_rounded, ordinary_tube};
use proptest::prelude::*;
use spincyl::stability::{at_rest, region};
use spincyl::{Body, Contact, rolling, steady, sweep};

/// Rate, kappa when rolling, kappa on a smooth table, energy; and the codes of the regions.
struct Map {
    numbers: [Vec<f64>; 4],
    region: Vec<u8>,
}

impl Map {
    /// Filled by a function of a whole portrait. One place calls it: the lanes are compiled for every caller.
    fn filled(size: usize, fill: impl FnOnce(sweep::Portrait<'_>) -> bool) -> Self {
        let mut map = Self { numbers: core::array::from_fn(|_| vec![7.0; size]), region: vec![9; size] };
        let [rate, rolling, smooth, energy] = &mut map.numbers;
        let out = sweep::Portrait {
            rate: Some(rate),
            kappa_rolling: Some(rolling),
            kappa_smooth: Some(smooth),
            energy: Some(energy),
            region: Some(&mut map.region),
        };
        assert!(fill(out));
        map
    }

    fn of(theta: &[f64], bodies: &[Option<Body>], threads: usize) -> Self {
        let size = theta.len() * bodies.len();
        Self::filled(size, |out| sweep::portrait(theta, bodies, out, threads, |_| true).unwrap())
    }

    /// Of inclinations, half lengths, bores and fillets.
    fn scattered(columns: [&[f64]; 4], count: usize, threads: usize) -> Self {
        Self::filled(count, |out| sweep::points(columns, out, threads, |_| true).unwrap())
    }

    fn bits(&self, i: usize) -> [u64; 5] {
        // one NaN is as good as another
        let bits = |x: f64| if x.is_nan() { u64::MAX } else { x.to_bits() };
        let [a, b, c, d] = self.numbers.each_ref().map(|x| bits(x[i]));
        [a, b, c, d, self.region[i].into()]
    }
}

/// The same of one point by single calls; its energy, which has none, as given.
fn alone(body: Option<Body>, theta: f64, energy: f64) -> [u64; 5] {
    let bits = |x: f64| if x.is_nan() { u64::MAX } else { x.to_bits() };
    let Some(body) = body else { return [u64::MAX, u64::MAX, u64::MAX, u64::MAX, 0] };
    [
        bits(steady::rate(&body, theta)),
        bits(at_rest(&body, theta, Contact::Rolling)),
        bits(at_rest(&body, theta, Contact::Smooth)),
        bits(energy),
        region(&body, theta) as u64,
    ]
}

fn some_bodies() -> impl Strategy<Value = Vec<Option<Body>>> {
    let mixed = prop_oneof![any_rounded(), ordinary_tube()];
    prop_oneof![
        prop::collection::vec(prop::option::of(ordinary_tube()), 1..30),
        prop::collection::vec(prop::option::of(any_rounded()), 1..30),
        prop::collection::vec(prop::option::of(mixed), 1..30),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(256) })]

    #[test]
    fn a_map_of_rounded_and_sharp_bodies_has_the_bits_of_its_points(
        bodies in some_bodies(), theta in prop::collection::vec(-0.1..3.3f64, 0..40), threads in 1..4usize,
    ) {
        let map = Map::of(&theta, &bodies, threads);
        for (i, &theta) in theta.iter().enumerate() {
            for (j, body) in bodies.iter().enumerate() {
                let k = i * bodies.len() + j;
                prop_assert_eq!(map.bits(k), alone(*body, theta, map.numbers[3][k]), "{:?} at {}", body, theta);
                prop_assert_eq!(map.numbers[3][k].is_nan(), map.numbers[0][k].is_nan());
            }
        }
    }

    #[test]
    fn the_energy_of_a_map_is_that_of_its_steady_states(body in any_rounded(), u in 0.01..1.0f64) {
        let theta = u * body.theta_max();
        let Ok(y) = steady::state(&body, theta) else { return Ok(()) };
        let energy = Map::of(&[theta], &[Some(body)], 1).numbers[3][0];
        let rate = |x: f64| steady::rate(&body, x).ln();
        // kappa_c by differences, and what it makes of the rounding of theta
        let h = 1e-6 * theta.min(body.theta_max() - theta);
        let condition = 1.0 + (theta * (rate(theta + h) - rate(theta - h)) / (2.0 * h)).abs();
        let expected = rolling::energy(&body, &y);
        let allowed = 32.0 * f64::EPSILON * condition * (expected.abs() + 2.0 + body.ell());
        prop_assert!((energy - expected).abs() <= allowed || !condition.is_finite(), "{energy} {expected}");
    }

    #[test]
    fn scattered_points_have_the_bits_of_the_map(
        points in prop::collection::vec(
            (
                -0.1..3.3f64, -0.2..4.0f64,
                prop_oneof![Just(0.0), -0.1..1.1f64], prop_oneof![Just(0.0), -0.1..1.1f64],
            ),
            1..60,
        ),
        sharp in any::<bool>(), threads in 1..4usize,
    ) {
        type Point = (f64, f64, f64, f64);
        let column = |f: fn(&Point) -> f64| points.iter().map(f).collect::<Vec<_>>();
        let [theta, half, bore, fillet] = [column(|p| p.0), column(|p| p.1), column(|p| p.2), column(|p| p.3)];
        let fillet = if sharp { vec![0.0] } else { fillet };
        let map = Map::scattered([&theta, &half, &bore, &fillet], points.len(), threads);
        for (i, &(theta, half, bore, _)) in points.iter().enumerate() {
            let body = Body::rounded_tube(half, bore, if sharp { 0.0 } else { fillet[i] }).ok();
            prop_assert_eq!(map.bits(i), alone(body, theta, map.numbers[3][i]), "{:?}", points[i]);
            prop_assert_eq!(map.numbers[3][i].is_nan(), map.numbers[0][i].is_nan());
        }
    }

    #[test]
    fn a_survey_counts_and_ranks_the_map_that_it_does_not_make(
        bodies in some_bodies(),
        rows in 1..200usize, low in -0.1..1.0f64, high in 1.0..3.3f64, threads in 1..4usize,
    ) {
        let theta: Vec<f64> = (0..rows).map(|i| low + (high - low) * i as f64 / rows as f64).collect();
        let map = Map::of(&theta, &bodies, 1);
        let areas = sweep::areas(&theta, &vec![1.0; rows], &bodies, threads, |_| true).unwrap().unwrap();
        for (j, area) in areas.iter().enumerate() {
            let mut counted = [0.0; 8];
            (0..rows).for_each(|i| counted[map.region[i * bodies.len() + j] as usize] += 1.0);
            prop_assert_eq!(*area, counted, "{:?}", bodies[j]);
        }
        let found = sweep::extrema(&theta, &bodies, [true; 4], threads, |_| true).unwrap().unwrap();
        for (map, ends) in map.numbers.iter().zip(found) {
            let numbers = || map.iter().filter(|x| !x.is_nan());
            let Some([least, greatest]) = ends else {
                prop_assert_eq!(numbers().count(), 0);
                continue;
            };
            let at = |end: (f64, usize, usize)| map[end.1 * bodies.len() + end.2];
            prop_assert_eq!(at(least), numbers().fold(f64::INFINITY, |a, b| a.min(*b)));
            prop_assert_eq!(at(greatest), numbers().fold(f64::NEG_INFINITY, |a, b| a.max(*b)));
        }
    }
}
