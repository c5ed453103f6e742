//! Maps, scattered points and surveys, of sharp and of rounded bodies: compared with single calls, and
//! surveys with maps.

use crate::common::rim::{condition, sharp, steady_end};
use crate::common::{any_rounded, larger, ordinary_tube, tube_or_rounded};
use proptest::prelude::*;
use spincyl::stability::{at_rest, region};
use spincyl::sweep::{Extrema, MapPoint, MapQuantity, TubePoints};
use spincyl::{Body, Contact, rolling, steady, sweep};
use std::f64::consts::FRAC_PI_2;

fn tube_points([theta, half_length, bore, fillet]: [&[f64]; 4]) -> TubePoints<'_> {
    TubePoints::new(theta, half_length).with_bore(bore).with_fillet(fillet)
}

/// The quantities in the order of [`Map::numbers`].
const QUANTITIES: [MapQuantity; 4] =
    [MapQuantity::SquaredRate, MapQuantity::KappaRolling, MapQuantity::KappaSmooth, MapQuantity::Energy];

/// Rate, kappa when rolling, kappa on a smooth table, energy; and the codes of the regions.
struct Map {
    numbers: [Vec<f64>; 4],
    region: Vec<u8>,
}

impl Map {
    /// A map that is filled by `fill`. Only this function calls `fill`, since the SIMD code is compiled for every
    /// caller.
    fn filled(size: usize, fill: impl FnOnce(sweep::Portrait<'_>) -> bool) -> Self {
        let mut map = Self { numbers: core::array::from_fn(|_| vec![7.0; size]), region: vec![9; size] };
        let [rate, rolling, smooth, energy] = &mut map.numbers;
        let out = sweep::Portrait::default()
            .with_rate(rate)
            .with_kappa_rolling(rolling)
            .with_kappa_smooth(smooth)
            .with_energy(energy)
            .with_region(&mut map.region);
        assert!(fill(out));
        map
    }

    fn of(theta: &[f64], bodies: &[Option<Body>], threads: usize) -> Self {
        let size = theta.len() * bodies.len();
        Self::filled(size, |out| sweep::portrait(theta, bodies, out, threads, |_| true).unwrap())
    }

    /// The map of scattered points: inclinations, half lengths, bores and fillets.
    fn scattered(columns: [&[f64]; 4], count: usize, threads: usize) -> Self {
        Self::filled(count, |out| sweep::points(tube_points(columns), out, threads, |_| true).unwrap())
    }

    fn bits(&self, i: usize) -> [u64; 5] {
        // every NaN counts as the same
        let bits = |x: f64| if x.is_nan() { u64::MAX } else { x.to_bits() };
        let [a, b, c, d] = self.numbers.each_ref().map(|x| bits(x[i]));
        [a, b, c, d, self.region[i].into()]
    }
}

/// A map in single precision.
struct Single {
    numbers: [Vec<f32>; 4],
    region: Vec<u8>,
}

impl Single {
    fn of(theta: &[f64], bodies: &[Option<Body>], threads: usize) -> Self {
        let size = theta.len() * bodies.len();
        let mut map = Self { numbers: core::array::from_fn(|_| vec![7.0; size]), region: vec![9; size] };
        let [rate, rolling, smooth, energy] = map.numbers.each_mut().map(|x| &mut x[..]);
        let out = sweep::Portrait::default()
            .with_rate(rate)
            .with_kappa_rolling(rolling)
            .with_kappa_smooth(smooth)
            .with_energy(energy)
            .with_region(&mut map.region);
        assert!(sweep::portrait(theta, bodies, out, threads, |_| true).unwrap());
        map
    }
}

/// The rates of a single-precision map that has only rates.
fn single_rates(theta: &[f64], bodies: &[Option<Body>], threads: usize) -> Vec<f32> {
    let mut rate = vec![7f32; theta.len() * bodies.len()];
    let out = sweep::Portrait::default().with_rate(&mut rate[..]);
    assert!(sweep::portrait(theta, bodies, out, threads, |_| true).unwrap());
    rate
}

/// The bits of a number, with the same ones for every NaN.
fn bits(x: f32) -> u32 {
    if x.is_nan() { u32::MAX } else { x.to_bits() }
}

/// The error of a single-precision number against a double, in ulp of 2^-24; outside the range of normal
/// numbers 0 if it is the double rounded, else infinite.
fn off(single: f32, double: f64) -> f64 {
    let rounded = double as f32;
    if rounded.is_normal() && single.is_normal() {
        return (f64::from(single) / double - 1.0).abs() * 2f64.powi(24);
    }
    if bits(single) == bits(rounded) { 0.0 } else { f64::INFINITY }
}

/// Bodies of any length, also thin, critical and missing ones; and inclinations near those where the rate of
/// one of them begins, ends or turns, or that are tiny, upright, flat or NaN.
fn hard_places() -> (Vec<f64>, Vec<Option<Body>>) {
    let powers = [-300, -30, -15, -8, -3, -1, 0, 1, 3, 8, 15, 28, 30, 75, 150].map(|k| 10f64.powi(k));
    let ordinary = (0..120).map(|i| 0.025 * f64::from(i));
    let lengths = ordinary.chain(powers).chain([0.75f64.sqrt(), 0.866, 0.25]);
    let mut bodies: Vec<_> =
        lengths.map(|ell| Body::tube(ell, [0.0, 0.5, 1.0][(ell * 1e3) as usize % 3]).ok()).collect();
    bodies.push(Some(Body::new(0.5, 1e-3, 1.9e-3).unwrap()));
    bodies.push(None);
    let mut theta = vec![f64::NAN, -1.0, -0.0, 0.0, FRAC_PI_2, FRAC_PI_2.next_up(), 2.0, f64::INFINITY];
    theta.extend((0..900).map(|i| FRAC_PI_2 * f64::from(i) / 900.0));
    theta.extend((1..108).map(|k| 10f64.powi(-3 * k)).chain([5e-324, 1e-323, FRAC_PI_2.next_down()]));
    for body in bodies.iter().flatten() {
        let places = [body.theta_balance(), body.theta_limit()].into_iter().chain(steady::folds(body));
        for place in places.filter(|x| !x.is_nan()) {
            let near = (1..17).flat_map(|k| [10f64.powi(-k), -(10f64.powi(-k))]);
            theta.extend(near.chain([0.0]).map(|part| place * (1.0 + part)));
        }
    }
    (theta, bodies)
}

#[test]
fn near_folds_and_edges_and_at_any_scale_the_single_rate_is_that_of_doubles_whatever_its_neighbours() {
    let (theta, bodies) = hard_places();
    let size = theta.len() * bodies.len();
    let (mut double, single) = (vec![7f64; size], single_rates(&theta, &bodies, 1));
    let out = sweep::Portrait::default().with_rate(&mut double[..]);
    assert!(sweep::portrait(&theta, &bodies, out, 1, |_| true).unwrap());
    let found = single.iter().zip(&double).map(|(x, y)| off(*x, *y));
    let worst = found.fold(0.0, larger);
    let known = double.iter().filter(|x| !x.is_nan()).count();
    assert!(
        worst <= 1.51 && worst > 1.2 && size > 1_000_000 && known > size / 4,
        "{worst} ulp, {known} of {size}"
    );
    for shift in [1, 5, 8, 11] {
        let mut moved = bodies.clone();
        moved.rotate_left(shift);
        moved.truncate(bodies.len() - shift);
        let again = single_rates(&theta, &moved, 3);
        for (row, old) in again.chunks(moved.len()).zip(single.chunks(bodies.len())) {
            assert!(row.iter().zip(&old[shift..]).all(|(x, y)| bits(*x) == bits(*y)), "moved by {shift}");
        }
    }
}

/// The bits of one point of a map by single calls; its energy, for which there is no call, is given.
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
    #![proptest_config(crate::common::cases(768))]

    #[test]
    fn a_map_of_rounded_and_sharp_bodies_has_the_bits_of_its_points(
        bodies in some_bodies(), theta in prop::collection::vec(prop_oneof![-0.1..1.7f64, -0.1..3.3f64], 0..40), threads in 1..5usize,
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
    fn a_map_in_single_precision_is_that_of_doubles_rounded_but_the_rate_of_a_sharp_rim(
        bodies in some_bodies(), theta in prop::collection::vec(-0.1..1.7f64, 1..40), threads in 1..3usize,
    ) {
        let (map, single) = (Map::of(&theta, &bodies, 1), Single::of(&theta, &bodies, threads));
        let alone = single_rates(&theta, &bodies, threads);
        for k in 0..alone.len() {
            let found = single.numbers.each_ref().map(|x| x[k]);
            let doubles = map.numbers.each_ref().map(|x| x[k]);
            // the rate does not depend on the other quantities that are computed
            prop_assert_eq!(bits(alone[k]), bits(found[0]));
            let sharp = bodies[k % bodies.len()].is_some_and(|body| body.fillet() == 0.0);
            for (found, double) in found.into_iter().zip(doubles).skip(usize::from(sharp)) {
                prop_assert_eq!(bits(found), bits(double as f32));
            }
            prop_assert!(off(found[0], doubles[0]) <= 1.51, "{} {}", found[0], doubles[0]);
        }
        prop_assert_eq!(single.region, map.region);
        let mut points = vec![7f32; theta.len()];
        let out = sweep::Portrait::default().with_rate(&mut points[..]);
        prop_assert!(sweep::points(TubePoints::new(&theta, &[2.5]).with_bore(&[0.5]), out, threads, |_| true).unwrap());
        let row = single_rates(&theta, &[Some(Body::tube(2.5, 0.5).unwrap())], 1);
        prop_assert!(points.iter().zip(&row).all(|(x, y)| bits(*x) == bits(*y)));
    }

    #[test]
    fn the_energy_of_a_map_is_that_of_its_steady_states(body in tube_or_rounded(), u in 0.01..1.0f64) {
        let theta = u * steady_end(&body);
        let Ok(y) = steady::state(&body, theta) else { return Ok(()) };
        let map = Map::of(&[theta], &[Some(body)], 1);
        let (rate, energy) = (map.numbers[0][0], map.numbers[3][0]);
        let (condition, expected) = (1.0 + condition(&body, theta), rolling::energy(&body, &y));
        let allowed = if sharp(&body) {
            16.0 * f64::EPSILON * condition * expected
        } else {
            32.0 * f64::EPSILON * condition * (expected.abs() + 2.0 + body.ell())
        };
        let free = if sharp(&body) { rate >= 1e6 } else { !condition.is_finite() };
        prop_assert!((energy - expected).abs() <= allowed || free, "{energy} {expected}");
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
        let mut codes = vec![9; map.region.len()];
        spincyl::stability::codes(&theta, &bodies, &mut codes);
        prop_assert_eq!(&codes, &map.region);
        let areas = sweep::areas(&theta, [&vec![1.0; rows]], &bodies, threads, |_| true).unwrap().unwrap();
        for (j, [area]) in areas.iter().enumerate() {
            let mut counted = [0.0; 8];
            (0..rows).for_each(|i| counted[map.region[i * bodies.len() + j] as usize] += 1.0);
            prop_assert_eq!(*area, counted, "{:?}", bodies[j]);
        }
        let found = sweep::extrema(&theta, &bodies, &QUANTITIES, threads, |_| true).unwrap().unwrap();
        // the extrema of the rate alone are computed by another method
        let alone = sweep::extrema(&theta, &bodies, &QUANTITIES[..1], threads, |_| true).unwrap().unwrap();
        prop_assert_eq!(alone.of(QUANTITIES[0]), found.of(QUANTITIES[0]));
        prop_assert_eq!(alone.of(QUANTITIES[1]), None);
        for (map, quantity) in map.numbers.iter().zip(QUANTITIES) {
            let numbers = || map.iter().filter(|x| !x.is_nan());
            let Some(Extrema { least, greatest, .. }) = found.of(quantity) else {
                prop_assert_eq!(numbers().count(), 0);
                continue;
            };
            let at = |end: MapPoint| map[end.theta * bodies.len() + end.body];
            prop_assert_eq!(at(least), numbers().fold(f64::INFINITY, |a, b| a.min(*b)));
            prop_assert_eq!(at(greatest), numbers().fold(f64::NEG_INFINITY, |a, b| a.max(*b)));
        }
    }

    #[test]
    fn a_survey_counts_the_map_of_bodies_close_to_the_edge_of_what_they_do(
        bore in 0.0..1.0f64, near in prop::collection::vec((-16.0..-1.0f64, any::<bool>()), 1..12),
        spread in -15.0..0.0f64, place in 0..4usize,
    ) {
        // nearly critical tubes, thin disks, tall tubes; inclinations around something that changes, at any distance
        let critical = Body::critical_aspect(bore, 0.0).unwrap();
        let bodies: Vec<_> = near.iter().flat_map(|&(part, up)| {
            let small = 10f64.powf(part);
            let ells = [critical * (1.0 + if up { small } else { -small }), small, 1.0 / small, 0.0];
            ells.map(|ell| Body::tube(ell, bore).ok())
        }).collect();
        let body = bodies[place].as_ref().unwrap();
        let kappa = spincyl::stability::boundaries(body, Contact::Rolling)[0];
        let centre = [body.theta_balance(), body.theta_limit(), kappa, FRAC_PI_2][near.len() % 4];
        let centre = if centre.is_nan() { 1.0 } else { centre };
        let mut theta: Vec<f64> = (-60..60)
            .map(|i| centre * (1.0 + f64::from(i) / 60.0 * 10f64.powf(spread)))
            .chain((1..30).map(|i| 10f64.powi(-10 * i)))
            .collect();
        theta.sort_by(f64::total_cmp);
        let map = Map::of(&theta, &bodies, 1);
        let ones = vec![1.0; theta.len()];
        let mut codes = vec![9; map.region.len()];
        spincyl::stability::codes(&theta, &bodies, &mut codes);
        prop_assert_eq!(&codes, &map.region);
        let areas = sweep::areas(&theta, [&ones], &bodies, 2, |_| true).unwrap().unwrap();
        for (j, [area]) in areas.iter().enumerate() {
            let mut counted = [0.0; 8];
            (0..theta.len()).for_each(|i| counted[map.region[i * bodies.len() + j] as usize] += 1.0);
            prop_assert_eq!(*area, counted, "{:?} around {}", bodies[j], centre);
        }
        let found = sweep::extrema(&theta, &bodies, &QUANTITIES[..1], 1, |_| true).unwrap().unwrap();
        let rates = || map.numbers[0].iter().copied().filter(|x| !x.is_nan());
        if let Some(Extrema { least, greatest, .. }) = found.of(QUANTITIES[0]) {
            let at = |end: MapPoint| map.numbers[0][end.theta * bodies.len() + end.body];
            prop_assert_eq!(at(least), rates().fold(f64::INFINITY, f64::min));
            prop_assert_eq!(at(greatest), rates().fold(f64::NEG_INFINITY, f64::max));
        } else {
            prop_assert_eq!(rates().count(), 0);
        }
    }
}

#[test]
fn a_map_can_be_stopped_and_refuses_arrays_of_another_size() {
    let bodies = vec![Body::solid(1.0).ok(); 1000];
    let theta = vec![0.5; 1 << 16];
    let mut rate = vec![0.0; bodies.len() * theta.len()];
    let asked = std::cell::Cell::new(0);
    let go_on = |_| {
        asked.set(asked.get() + 1);
        false
    };
    let out = sweep::Portrait::default().with_rate(&mut rate);
    assert!(!sweep::portrait(&theta, &bodies, out, 1, go_on).unwrap());
    assert_eq!(asked.get(), 1, "asked once, and obeyed");
    let short = || {
        let mut region = vec![0; 7];
        sweep::portrait(
            &[0.1, 0.2],
            &[None; 4],
            sweep::Portrait::<f64>::default().with_region(&mut region),
            1,
            |_| true,
        )
    };
    assert!(std::panic::catch_unwind(short).is_err());
}
