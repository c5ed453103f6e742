//! The whirr of a thin disk under each law: its fastest precession, its end, and the decay of its nutation.

use crate::losses::{ROLLS, follow, stop_of};
use spincyl::contact::lossy;
use spincyl::loss::{Law, Losses};
use spincyl::motion::{Ending, Event};
use spincyl::{Body, Contact, steady};

/// The fastest precession of a thin disk from a steady state, in the last `share` of its motion, and the end
/// of the motion.
fn fastest(law: Law, coefficient: f64, theta: f64, share: f64) -> (f64, Event) {
    let coin = Body::solid(0.0).unwrap();
    let start = steady::state(&coin, theta).unwrap();
    let losses = Losses::of(law, coefficient);
    let end = follow(&coin, &start, losses, &[0.0, 1e5], ROLLS).event.unwrap();
    let times: Vec<f64> =
        (1..=40_000).rev().map(|i| end.time * (1.0 - share * f64::from(i) / 40_000.0)).collect();
    let path = follow(&coin, &start, losses, &times, ROLLS);
    // a disk that lies flat has no precession
    let aloft = path.states.iter().filter(|y| y.theta > 0.0);
    (aloft.fold(0f64, |most, y| most.max(y.precession().abs())), end)
}

#[test]
fn a_dry_whirr_ends_where_gravity_outruns_the_barrier() {
    // Omega_max = 1.81 eps^(-1/2) for the thin disk, N -> 1/5, and the contact point stops before theta = 0
    let coin = Body::solid(0.0).unwrap();
    for eps in [1e-2f64, 3e-3, 1e-3] {
        let (found, event) = fastest(Law::DryContour, eps, 0.3, 1.0);
        assert_eq!(event.ending, Ending::Face);
        assert!((found / (1.81 / eps.sqrt()) - 1.0).abs() < 0.03, "{eps}: {found}");
        let (_, y) = stop_of(&coin, &steady::state(&coin, 0.3).unwrap(), Losses::of(Law::DryContour, eps));
        assert!(y.spin().abs() < 1e-8 && y.theta > 0.05 * eps && y.theta < eps, "{y:?}");
        let normal = lossy::force(Contact::Rolling, &coin, &y, &Losses::NONE).normal;
        assert!((normal - 0.2).abs() < 0.01, "{normal}");
    }
}

#[test]
fn the_fastest_turn_goes_with_the_power_of_each_law() {
    for (law, factor, power, coefficient) in [
        (Law::ViscousContour, 1.10, -1.0 / 3.0, 1e-4f64),
        (Law::AirFilm, 1.29, -1.0 / 5.0, 1e-6),
        (Law::BoundaryLayer, 1.06, -2.0 / 7.0, 1e-4),
    ] {
        let ((found, event), expected) =
            (fastest(law, coefficient, 0.1, 1e-2), factor * coefficient.powf(power));
        assert_eq!(event.ending, Ending::Face, "{law:?}");
        assert!((found / expected - 1.0).abs() < 0.03, "{law:?}: {found} {expected}");
    }
}

#[test]
fn nutation_dies_away_as_each_law_says() {
    // A ~ theta^q for a thin disk near flat, with q to 6 per cent
    let coin = Body::solid(0.0).unwrap();
    let amplitude = |law: Law, coefficient: f64, low: f64| {
        let start = steady::state(&coin, 0.02).unwrap();
        let kicked = start.kicked(0.02 * 0.02 * start.precession());
        let losses = Losses::of(law, coefficient);
        let end = follow(&coin, &start, losses, &[0.0, 1e5], ROLLS).event.unwrap().time;
        let steady: Vec<f64> = (0..60_000).map(|i| end * f64::from(i) / 60_000.0).collect();
        let path = follow(&coin, &kicked, losses, &steady, ROLLS);
        let thetas: Vec<f64> = path.states.iter().map(|y| y.theta).collect();
        // amplitudes: half the difference of an extreme of theta and the mean of its neighbours
        let turns: Vec<(f64, f64)> =
            thetas.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0).map(|w| (w[1], 0.0)).collect();
        let waves: Vec<(f64, f64)> = turns
            .windows(3)
            .map(|w| (0.25 * (w[0].0 + 2.0 * w[1].0 + w[2].0), 0.25 * (2.0 * w[1].0 - w[0].0 - w[2].0).abs()))
            .collect();
        let near = |theta: f64| {
            let some: Vec<f64> =
                waves.iter().filter(|w| (w.0 / theta - 1.0).abs() < 0.05).map(|w| w.1).collect();
            assert!(some.len() > 2, "{law:?} {theta}: {}", some.len());
            some.iter().sum::<f64>() / some.len() as f64
        };
        (near(0.015) / near(low)).ln() / (0.015f64 / low).ln()
    };
    for (law, coefficient, q) in [
        (Law::DryContour, 2e-5, 1.45),
        (Law::ViscousContour, 1e-6, 1.25),
        (Law::RollingResistance, 1e-3, 1.10),
    ] {
        let found = amplitude(law, coefficient, 0.005);
        assert!((found / q - 1.0).abs() < 0.06, "{law:?}: {found} {q}");
    }
}
