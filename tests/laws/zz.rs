use spincyl::body::Circle;
use spincyl::contact::slip::Friction;
use spincyl::motion::{Ask, Start, roll_with};
use spincyl::{Body, State};
#[test]
fn zz() {
    let c = |radius, depth| Circle { radius, depth, fillet: 0.0 };
    let bottle = Body::profile(&[c(1.0, 1.5), c(1.0, -0.5), c(0.4, -1.5)], 1.2, 0.45).unwrap();
    let cup = Body::profile(&[c(0.7, 1.1), c(1.0, -0.9)], 0.5, 0.4).unwrap();
    for (name, body) in [("bottle", bottle), ("cup", cup)] {
        println!("{name} {:?}", body.theta_end());
        for (theta, w, slip, e) in [
            (1.0, [0.0, 0.0, 0.0], [0.0, 0.0], 0.0),
            (1.0, [0.3, 0.2, 3.0], [0.0, 0.0], 0.0),
            (1.2, [0.3, 0.2, 3.0], [0.1, 0.5], 0.3),
            (2.0, [0.3, 0.2, 3.0], [0.1, 0.5], 0.3),
            (2.5, [0.0, 0.0, 0.0], [0.0, 0.0], 0.0),
            (1.9, [1.0, 0.0, 0.5], [0.0, 0.0], 0.0),
            (1.4, [1.0, -4.0, 0.5], [0.0, 0.0], 0.5),
        ] {
            let y = State { theta, w1: w[0], w2: w[1], w3: w[2] };
            let times: Vec<f64> = (0..6).map(|k| 10.0 * k as f64).collect();
            let ask = Ask::on(Friction::coulomb(0.3)).with_restitution(e).with_pose(true);
            let now = std::time::Instant::now();
            match roll_with(&body, Start::from(y).with_slip(slip), &times, &ask, || true) {
                Ok(Some(m)) => {
                    let p = m.path.as_ref().unwrap();
                    println!(
                        "{theta} {w:?} {e}: {:?} err {:.1e} at {:?} phases {} hits {} {:?} {:.1} ms, rims {:?}",
                        m.ending(),
                        m.error,
                        m.event.map(|e| (e.time, e.state.theta, e.rim)),
                        p.phases.len(),
                        p.impacts.len(),
                        m.limit,
                        now.elapsed().as_secs_f64() * 1e3,
                        p.rims
                    );
                    let y = m.states.last().unwrap();
                    println!(
                        "      {:.4?} {:?}",
                        [y.theta, y.w1, y.w2, y.w3],
                        p.phases.last().map(|p| (p.time, p.kind))
                    );
                }
                r => println!("{theta} {w:?} {e}: {r:?}"),
            }
        }
    }
}
