//! Scattered points and surveys, against the maps that they do not make.

mod common;

use common::ordinary_tube;
use proptest::prelude::*;
use spincyl::{Body, sweep};

proptest! {
    #[test]
    fn scattered_points_have_the_bits_of_the_map(
        points in prop::collection::vec((-0.1..1.7f64, -0.2..4.0f64, -0.1..1.1f64), 1..60),
        threads in 1..4usize,
    ) {
        let column = |f: fn(&(f64, f64, f64)) -> f64| points.iter().map(f).collect::<Vec<_>>();
        let [theta, ell, bore] = [column(|p| p.0), column(|p| p.1), column(|p| p.2)];
        let [mut rate, mut rolling, mut smooth, mut energy] = core::array::from_fn(|_| vec![7f64; points.len()]);
        let mut region = vec![9; points.len()];
        let out = sweep::Portrait {
            rate: Some(&mut rate), kappa_rolling: Some(&mut rolling), kappa_smooth: Some(&mut smooth),
            energy: Some(&mut energy), region: Some(&mut region),
        };
        prop_assert!(sweep::points([&theta, &ell, &bore, &[0.0]], out, threads, |_| true).unwrap());
        let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
        for (i, &(theta, ell, bore)) in points.iter().enumerate() {
            let (mut a, mut b, mut c, mut d, mut e) = ([7.0], [7.0], [7.0], [7.0], [9]);
            let out = sweep::Portrait {
                rate: Some(&mut a), kappa_rolling: Some(&mut b), kappa_smooth: Some(&mut c), energy: Some(&mut d),
                region: Some(&mut e),
            };
            prop_assert!(sweep::portrait(&[theta], &[Body::tube(ell, bore).ok()], out, 1, |_| true).unwrap());
            prop_assert!(same(rate[i], a[0]) && same(rolling[i], b[0]) && same(smooth[i], c[0]));
            prop_assert!(same(energy[i], d[0]));
            prop_assert_eq!(region[i], e[0]);
        }
    }

    #[test]
    fn a_survey_counts_and_ranks_the_map_that_it_does_not_make(
        bodies in prop::collection::vec(prop::option::of(ordinary_tube()), 1..30),
        rows in 1..200usize, low in -0.1..1.0f64, high in 1.0..1.7f64, threads in 1..4usize,
    ) {
        let theta: Vec<f64> = (0..rows).map(|i| low + (high - low) * i as f64 / rows as f64).collect();
        let size = rows * bodies.len();
        let [mut rate, mut rolling, mut smooth, mut energy] = core::array::from_fn(|_| vec![7f64; size]);
        let mut region = vec![9u8; size];
        let out = sweep::Portrait {
            rate: Some(&mut rate), kappa_rolling: Some(&mut rolling), kappa_smooth: Some(&mut smooth),
            energy: Some(&mut energy), region: Some(&mut region),
        };
        prop_assert!(sweep::portrait(&theta, &bodies, out, 1, |_| true).unwrap());
        for (j, area) in sweep::areas(&theta, &vec![1.0; rows], &bodies, threads, |_| true).unwrap().unwrap().iter().enumerate() {
            let mut counted = [0.0; 8];
            (0..rows).for_each(|i| counted[region[i * bodies.len() + j] as usize] += 1.0);
            prop_assert_eq!(*area, counted);
        }
        let found = sweep::extrema(&theta, &bodies, [true; 4], threads, |_| true).unwrap().unwrap();
        for (map, ends) in [&rate, &rolling, &smooth, &energy].into_iter().zip(found) {
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
