//! Time of one steady state, one kappa, one inverse, and of maps of points (throughput in points). The errors
//! are in the same table of docs/benchmarks.md.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use spincyl::stability::at_rest;
use spincyl::{Body, Contact, steady, sweep};
use std::hint::black_box;

fn single(c: &mut Criterion) {
    let body = Body::solid(2.5).unwrap();
    let mut group = c.benchmark_group("steady");
    group.bench_function("rate", |b| b.iter(|| steady::rate(black_box(&body), black_box(1.3))));
    group.bench_function("inclinations, two roots", |b| {
        b.iter(|| steady::inclinations(black_box(&body), black_box(1.5)));
    });
    let disk = Body::solid(0.8).unwrap();
    group.bench_function("inclinations, three roots", |b| {
        b.iter(|| steady::inclinations(black_box(&disk), black_box(0.9995)));
    });
    group.finish();
    let mut group = c.benchmark_group("stability");
    group.bench_function("rolling, at rest", |b| {
        b.iter(|| at_rest(black_box(&body), black_box(1.3), Contact::Rolling));
    });
    group.finish();
}

fn map(c: &mut Criterion) {
    let side = 1000;
    let theta: Vec<f64> = (1..=side).map(|i| 1.57 * f64::from(i) / f64::from(side)).collect();
    let bodies: Vec<_> = (0..side).map(|i| Body::solid(3.0 * f64::from(i) / f64::from(side)).ok()).collect();
    let points = theta.len() * bodies.len();
    let (mut rate, mut rolling, mut smooth, mut region) =
        (vec![0.0; points], vec![0.0; points], vec![0.0; points], vec![0; points]);
    let mut group = c.benchmark_group("sweep");
    group.throughput(Throughput::Elements(points as u64));
    for threads in [1, 2] {
        group.bench_function(format!("rate, {threads} threads"), |b| {
            b.iter(|| {
                let out = sweep::Portrait::default().with_rate(&mut rate);
                sweep::portrait(&theta, &bodies, out, threads, |_| true)
            });
        });
        group.bench_function(format!("all four quantities, {threads} threads"), |b| {
            b.iter(|| {
                let out = sweep::Portrait::default()
                    .with_rate(&mut rate)
                    .with_kappa_rolling(&mut rolling)
                    .with_kappa_smooth(&mut smooth)
                    .with_region(&mut region);
                sweep::portrait(&theta, &bodies, out, threads, |_| true)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, single, map);
criterion_main!(benches);
