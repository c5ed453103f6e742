//! Time of motions: a step of RK4 with nothing else, with a pose and with contact forces; the exact solution.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use spincyl::exact::Swing;
use spincyl::motion::{Ask, Method, roll_with};
use spincyl::{Body, Contact, State, rk4, rolling, steady};
use std::hint::black_box;

const STEPS: u64 = 20_000;

fn start() -> (Body, State) {
    let body = Body::solid(1.0).unwrap();
    let y = steady::state(&body, 0.5).unwrap().kicked(0.1);
    (body, y)
}

fn rk4_steps(c: &mut Criterion) {
    let (body, y) = start();
    let mut group = c.benchmark_group("rk4");
    group.throughput(Throughput::Elements(STEPS)).sample_size(20);
    group.bench_function("step alone", |b| {
        b.iter(|| rk4::integrate(|y| rolling::derivative(&body, y), black_box(y), 1e-3, STEPS))
    });
    let wanted = [("want nothing", false, false), ("want pose", true, false), ("want contact", false, true)];
    for (name, pose, force) in wanted {
        // Every step is an output, which costs most.
        let times: Vec<f64> = (0..=STEPS).map(|i| i as f64 * 1e-3).collect();
        let mut scene = Ask::default().with_method(Method::Step(1e-3));
        (scene.pose, scene.force) = (pose, force);
        group.bench_function(format!("{name}, every state"), |b| {
            b.iter(|| roll_with(&body, black_box(&y), &times, &scene, || true).unwrap())
        });
        group.bench_function(format!("{name}, last state"), |b| {
            b.iter(|| roll_with(&body, black_box(&y), &[20.0], &scene, || true).unwrap())
        });
    }
    group.finish();
}

fn exact(c: &mut Criterion) {
    let (body, y) = start();
    let mut group = c.benchmark_group("exact");
    for (name, pose) in [("swing", false), ("swing and pose", true)] {
        let swing_of = |y: &State| {
            let found = if pose {
                Swing::with_pose(&body, y, Contact::Rolling)
            } else {
                Swing::new(&body, y, Contact::Rolling)
            };
            found.unwrap()
        };
        group.bench_function(name, |b| b.iter_batched(|| y, |y| swing_of(&y), BatchSize::SmallInput));
        let swing = swing_of(&y);
        for t in [20.0, 1e9] {
            if pose {
                group.bench_function(format!("pose at {t:e}"), |b| b.iter(|| swing.pose(black_box(t))));
            } else {
                group.bench_function(format!("state at {t:e}"), |b| b.iter(|| swing.state(black_box(t))));
            }
        }
    }
    group.bench_function("roll to one time", |b| {
        b.iter(|| roll_with(&body, black_box(&y), &[20.0], &Ask::default(), || true).unwrap())
    });
    group.finish();
}

criterion_group!(benches, rk4_steps, exact);
criterion_main!(benches);
