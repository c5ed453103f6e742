#[path = "../laws/common/mod.rs"]
#[allow(dead_code)]
mod common;
use common::wander;
use spincyl::body::Circle;
use spincyl::contact::slip::Friction;
use spincyl::motion::{Ask, Ending, Start, roll_with};
use spincyl::{Body, State};

/// A uniform solid whose generator goes through these points (radius, height), with these fillets at their circles.
fn lathe(points: &[[f64; 2]], circles: &[(f64, f64, f64)]) -> Option<Body> {
    let mut sums = [0.0; 4];
    let nodes = [[-(0.6f64.sqrt()), 5.0 / 18.0], [0.0, 8.0 / 18.0], [0.6f64.sqrt(), 5.0 / 18.0]];
    for pair in points.windows(2) {
        let ([r, z0], [q, z1]) = (pair[0], pair[1]);
        for part in 0..8 {
            for [x, weight] in nodes {
                let at = (part as f64 + 0.5 * (1.0 + x)) / 8.0;
                let (radius, z) = (r + (q - r) * at, z0 + (z1 - z0) * at);
                let weight = weight * (z1 - z0) / 8.0;
                let square = radius * radius;
                let parts =
                    [square, square * z, 0.5 * square * square, 0.25 * square * square + square * z * z];
                sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += weight * part);
            }
        }
    }
    let [mass, moment, axial, across] = sums;
    let centre = moment / mass;
    let circles: Vec<Circle> =
        circles.iter().map(|&(radius, z, fillet)| Circle { radius, depth: centre - z, fillet }).collect();
    Body::profile(&circles, across / mass - centre * centre, axial / mass).ok()
}

fn body(next: &mut impl FnMut() -> f64) -> Option<(&'static str, Body)> {
    let kind = (7.0 * next()) as usize;
    let mut u = |low: f64, high: f64| low + (high - low) * next();
    Some(match kind {
        0 => {
            let (r, h) = (u(0.3, 0.98), u(0.3, 2.5));
            ("cup", lathe(&[[r, 0.0], [1.0, h]], &[(r, 0.0, 0.0), (1.0, h, 0.0)])?)
        }
        1 => {
            let h = u(0.4, 2.5);
            ("cone", lathe(&[[1.0, 0.0], [0.0, h]], &[(1.0, 0.0, 0.0), (0.0, h, 0.0)])?)
        }
        2 => {
            let (h, k, r) = (u(0.8, 2.5), u(0.3, 1.5), u(0.15, 0.8));
            (
                "bottle",
                lathe(
                    &[[1.0, 0.0], [1.0, h], [r, h + k]],
                    &[(1.0, 0.0, 0.0), (1.0, h, 0.0), (r, h + k, 0.0)],
                )?,
            )
        }
        3 => {
            let (r, far) = (u(0.4, 1.0), u(0.0, 0.6));
            let (a, b) = (r * r * r, 1.0);
            let apart = 1.0 + r + far;
            let (za, zb) = (-apart * b / (a + b), apart * a / (a + b));
            let axial = 0.4 * (a * r * r + b) / (a + b);
            let across = axial + (a * za * za + b * zb * zb) / (a + b);
            let circle = |depth, fillet| Circle { radius: 0.0, depth, fillet };
            ("balls", Body::profile(&[circle(-za, r), circle(-zb, 1.0)], across, axial).ok()?)
        }
        4 => {
            // A cap of a ball of radius q, cut at the height of its edge, of radius 1.
            let q = u(1.0, 1.6);
            let h = (q * q - 1.0f64).sqrt();
            let points: Vec<[f64; 2]> = (0..=40)
                .map(|k| {
                    let z = -q + (q - h) * k as f64 / 40.0;
                    [(q * q - z * z).max(0.0).sqrt(), z]
                })
                .collect();
            ("cap", lathe(&points, &[(0.0, 0.0, q), (1.0, -h, 0.0)])?)
        }
        5 => {
            let (r, h) = (u(0.1, 0.6), u(0.3, 1.2));
            let (q, k) = (u(0.1, 0.6), u(0.3, 1.2));
            let points =
                [[r, 0.0], [r, h], [1.0, h + 1e-9], [1.0, h + 0.2], [q, h + 0.2 + 1e-9], [q, h + 0.2 + k]];
            (
                "wheel",
                lathe(&points, &[(r, 0.0, 0.0), (1.0, h, 0.0), (1.0, h + 0.2, 0.0), (q, h + 0.2 + k, 0.0)])?,
            )
        }
        _ => {
            let (r, h, f) = (u(0.4, 0.95), u(0.5, 2.0), u(0.02, 0.2));
            ("rounded", lathe(&[[r, 0.0], [1.0, h]], &[(r - f, f, f), (1.0 - f, h - f, f)])?)
        }
    })
}

#[test]
fn zz() {
    let count: usize = std::env::var("COUNT").map_or(200, |x| x.parse().unwrap());
    let seed: u32 = std::env::var("SEED").map_or(7, |x| x.parse().unwrap());
    let only: Option<usize> = std::env::var("ONLY").ok().map(|x| x.parse().unwrap());
    let mut next = wander(seed.into());
    let mut found = std::collections::BTreeMap::<String, usize>::new();
    let mut slowest = vec![];
    for i in 0..count {
        let Some((name, body)) = body(&mut next) else {
            *found.entry("no body".into()).or_default() += 1;
            continue;
        };
        let mut u = |low: f64, high: f64| low + (high - low) * next();
        let mu = 0.05 + 0.95 * u(0.0, 1.0);
        let e = [0.0, 0.3, 0.9][u(0.0, 3.0) as usize];
        let theta = u(0.1, 3.0);
        let kind = u(0.0, 5.0) as usize;
        let w = if kind == 0 { [0.0; 3] } else { [u(-1.5, 1.5), u(-1.5, 1.5), u(-3.0, 3.0)] };
        let slip = if kind < 3 { [0.0; 2] } else { [u(-1.0, 1.0), u(-1.0, 1.0)] };
        if only.is_some_and(|k| k != i) {
            continue;
        }
        let y = State { theta, w1: w[0], w2: w[1], w3: w[2] };
        let ask = Ask::on(Friction::coulomb(mu)).with_restitution(e);
        let now = std::time::Instant::now();
        let found_one = roll_with(&body, Start::from(y).with_slip(slip), &[0.0, 25.0, 50.0], &ask, || true);
        let took = now.elapsed().as_secs_f64();
        let what = match &found_one {
            Ok(Some(m)) => {
                if only.is_some() {
                    println!("{:?}", m.event);
                    for p in &m.path.as_ref().unwrap().phases {
                        println!("{p:?}");
                    }
                    println!("err {}", m.error);
                }
                slowest.push((
                    took,
                    i,
                    name,
                    m.path.as_ref().unwrap().phases.len(),
                    m.path.as_ref().unwrap().impacts.len(),
                    m.evaluations,
                ));
                {
                    let path = m.path.as_ref().unwrap();
                    let circles = body.circles();
                    let energy = |i: usize| {
                        let (y, k) = (&m.states[i], path.rims[i] as usize);
                        let c = circles.get(k).copied().unwrap_or(circles[0]);
                        let (s, co) = y.theta.sin_cos();
                        let (a, l) = (c.radius + c.fillet * s, c.depth + c.fillet * co);
                        let (z, g) = (c.depth * co + c.radius * s + c.fillet, c.depth * s - c.radius * co);
                        let [u, v] = path.slip[i];
                        let [h, lift] = path.aloft[i];
                        let (vh, v2, vz) = (u + z * y.w2, v - l * y.w1 + a * y.w3, lift + g * y.w2);
                        0.5 * (vh * vh
                            + v2 * v2
                            + vz * vz
                            + body.i1() * (y.w1 * y.w1 + y.w2 * y.w2)
                            + body.i3() * y.w3 * y.w3)
                            + z
                            + h
                    };
                    for i in 1..m.states.len() {
                        let struck: f64 = path
                            .impacts
                            .iter()
                            .filter(|hit| hit.time <= m.times[i])
                            .map(|hit| hit.lost)
                            .sum();
                        let off = energy(i) + path.dissipated[i] + struck - energy(0);
                        let fast = [m.states[i].w1, m.states[i].w2, m.states[i].w3, 1.0]
                            .iter()
                            .fold(0f64, |a, b| a.max(b.abs()));
                        if off.abs() > 1e-12 + 4.0 * fast * m.error {
                            println!(
                                "ENERGY {i} {off:.3e} claim {:.3e} kind {:?} rim {} of {:?}",
                                m.error, path.kinds[i], path.rims[i], y
                            );
                            *found.entry(format!("energy {name}")).or_default() += 1;
                        }
                        if energy(i) > 1e6 {
                            println!("huge");
                        }
                    }
                }
                let ok = matches!(m.ending(), Ending::Done | Ending::Face | Ending::Stops);
                let loose = if m.error > 1e-3 || m.error.is_nan() { " LOOSE" } else { "" };
                if ok {
                    format!("ok {:?}{loose}", m.ending())
                } else {
                    format!(
                        "{name} e={e} {:?} {:?} at {:?}",
                        m.ending(),
                        m.limit,
                        m.event.map(|e| e.time == 0.0)
                    )
                }
            }
            Ok(None) => "none".into(),
            Err(err) => format!("{name} {}", &format!("{err}")[..60.min(format!("{err}").len())]),
        };
        if !what.starts_with("ok") {
            println!(
                "{i} {name} mu {mu:.3} e {e} theta {theta:.4} w {w:.4?} slip {slip:.4?} {what} {took:.3}"
            );
        }
        *found.entry(what).or_default() += 1;
    }
    slowest.sort_by(|a, b| b.0.total_cmp(&a.0));
    println!("{found:#?}");
    for s in slowest.iter().take(8) {
        println!("{s:?}");
    }
}
