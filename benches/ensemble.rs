//! Time of many motions at once: near-steady and wide swings, and RK4 over lanes. Elements are motions (or
//! steps).

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use spincyl::ensemble::{BodyColumns, Job, MotionOutput, MotionStarts, roll};
use spincyl::motion::{Ask, Method};
use spincyl::{Body, steady};

const COUNT: usize = 16_384;

/// Solid cylinders of ell 0.5 to 3, kicked out of a steady state.
struct Many {
    body: [Vec<f64>; 5],
    state: [Vec<f64>; 4],
}

/// The same with one body, given as columns of one number.
fn one(kick: f64) -> Many {
    let mut all = Many { body: Default::default(), state: Default::default() };
    let body = Body::solid(1.5).unwrap();
    let low = body.theta_balance().max(body.theta_limit());
    for i in 0..COUNT {
        let share = 0.1 + 0.8 * ((i * 40_503 % 65_536) as f64 + 0.5) / 65_536.0;
        let y =
            steady::state(&body, low + (core::f64::consts::FRAC_PI_2 - low) * share).unwrap().kicked(kick);
        for (column, x) in all.state.iter_mut().zip(<[f64; 4]>::from(y)) {
            column.push(x);
        }
    }
    all.body = [body.ell(), body.i1(), body.i3(), body.fillet(), body.theta_end()].map(|x| vec![x]);
    all
}

fn many(kick: f64) -> Many {
    let mut all = Many { body: Default::default(), state: Default::default() };
    for i in 0..COUNT {
        let ell = 0.5 + 2.5 * (i as f64 + 0.5) / COUNT as f64;
        let share = 0.1 + 0.8 * ((i * 40_503 % 65_536) as f64 + 0.5) / 65_536.0;
        let body = Body::solid(ell).unwrap();
        let low = body.theta_balance().max(body.theta_limit());
        let theta = low + (core::f64::consts::FRAC_PI_2 - low) * share;
        let y = steady::state(&body, theta).unwrap().kicked(kick);
        for (column, x) in
            all.body.iter_mut().zip([body.ell(), body.i1(), body.i3(), body.fillet(), body.theta_end()])
        {
            column.push(x);
        }
        for (column, x) in all.state.iter_mut().zip(<[f64; 4]>::from(y)) {
            column.push(x);
        }
    }
    all
}

fn ensembles(c: &mut Criterion) {
    let mut group = c.benchmark_group("ensemble");
    group.sample_size(10);
    let times = [20.0];
    let mut states: [Vec<f64>; 4] = core::array::from_fn(|_| vec![0.0; COUNT]);
    let (mut error, mut method, mut status) = (vec![0.0; COUNT], vec![0; COUNT], vec![0; COUNT]);
    let mut bench = |name: &str, many: Many, job: Job<'_>, elements: usize| {
        group.throughput(Throughput::Elements(elements as u64));
        group.bench_function(name, |b| {
            b.iter(|| {
                let [ell, i1, i3, fillet, theta_end] = many.body.each_ref().map(Vec::as_slice);
                let bodies = BodyColumns::new(ell, i1, i3).with_fillet(fillet).with_theta_end(theta_end);
                let starts = MotionStarts::new(bodies, many.state.each_ref().map(Vec::as_slice));
                let out = MotionOutput::new(&mut error, &mut method, &mut status)
                    .with_last(states.each_mut().map(Vec::as_mut_slice));
                roll(&starts, &job, out, 1, |_| true).unwrap()
            })
        });
    };
    let job = Job::new(&times).with_ask(Ask::default().with_beyond());
    for kick in [0.05, 0.4, 0.8] {
        bench(&format!("final state, kick {kick}"), many(kick), job, COUNT);
    }
    bench("final state, kick 0.05, one body", one(0.05), job, COUNT);
    bench("final state, kick 0.05, within 1e-6", many(0.05), job.with_tol(1e-6), COUNT);
    let mut watched = job.ask;
    watched.beyond = false;
    bench("final state, kick 0.05, its end watched", many(0.05), job.with_ask(watched), COUNT);
    bench(
        "rk4, a step of 0.01",
        many(0.05),
        job.with_ask(job.ask.with_method(Method::Step(0.01))),
        COUNT * 2000,
    );
    group.finish();
}

criterion_group!(benches, ensembles);
criterion_main!(benches);
