use spincyl::contact::Friction;
use spincyl::motion::{Ask, Start, roll_with};
use spincyl::{Body, State};
use std::f64::consts::FRAC_PI_2;
fn show(m: &spincyl::motion::Motion) {
    let k = m.states.len();
    if k > 0 {
        let y = m.states[k - 1];
        println!("theta {:.10} w1 {:.10} w2 {:.10} w3 {:.10}", y.theta, y.w1, y.w2, y.w3);
        if let Some(p) = &m.poses {
            let p = p[k - 1];
            println!("phi {:.10} psi {:.10} {:?}", p.phi.radians(), p.psi.radians(), p.contact_point);
        }
    }
    println!(
        "error {:e} pose {:e} end {:?} {:?} nfev {}",
        m.error,
        m.pose_error,
        m.ending(),
        m.event.map(|e| e.time),
        m.evaluations
    );
    if let Some(p) = &m.path {
        for q in &p.phases {
            println!("   {:.10} {:?} {:?} {:?}", q.time, q.kind, q.state, q.slip);
        }
    }
}
#[test]
fn disk() {
    let b = Body::tube(0.1, 0.0).unwrap();
    let y = State { theta: 1.2, w1: 0.5, w2: 0.0, w3: 1.5 };
    let ask = Ask::default().with_slope(0.2).with_pose(true);
    let m = roll_with(&b, Start::from(y).with_heading(0.4), &[0.0, 5.0], &ask, || true).unwrap().unwrap();
    println!(
        "expect theta 1.2054716031, w1 0.5931890343, w2 -0.2909816491, w3 1.7795284100, phi -1.5133265363"
    );
    show(&m);
}
#[test]
fn ball() {
    let b = Body::ball(0.0, 0.4, 0.4).unwrap();
    let y = State { theta: 1.0, w1: 0.0, w2: 0.0, w3: 0.0 };
    // thrown across (y) at 1: heading 0 -> e2 = y
    let ask = Ask::on(Friction::coulomb(0.25)).with_slope(0.3).with_pose(true);
    let m = roll_with(&b, Start::from(y).with_slip([0.0, 1.0]), &[0.0, 1.3671567666, 1.5], &ask, || true)
        .unwrap()
        .unwrap();
    println!("expect rolls from 1.3671567666 v 0.2885874600, 5/7");
    show(&m);
}
#[test]
fn tube() {
    let b = Body::tube(6.0, 0.8).unwrap();
    let y = State { theta: 1.569, w1: 2.5, w2: 0.0, w3: 9.0 };
    let ask = Ask::on(Friction::coulomb(0.3)).with_slope(0.15).with_pose(true).with_restitution(0.0);
    let m = roll_with(
        &b,
        Start::from(y).with_heading(-1.0).with_slip([0.0, 6.0 - 12.41 * 2.5 / 6.0]),
        &[0.0, 4.0],
        &ask,
        || true,
    )
    .unwrap()
    .unwrap();
    println!("expect lifts off 2.1023832726, lands 4.3449936699");
    show(&m);
    let m = roll_with(
        &b,
        Start::from(y).with_heading(-1.0).with_slip([0.0, 6.0 - 12.41 * 2.5 / 6.0]),
        &[0.0, 4.3449936],
        &ask,
        || true,
    )
    .unwrap()
    .unwrap();
    show(&m);
}
#[test]
fn rest() {
    let b = Body::tube(0.1, 0.0).unwrap();
    let y = State { theta: 1.2, w1: 0.0, w2: 0.0, w3: 0.0 };
    for mu in [0.1, 0.3, 2.0] {
        let ask = Ask::on(Friction::coulomb(mu)).with_slope(0.5).with_pose(true);
        match roll_with(&b, Start::from(y).with_heading(0.7), &[0.0, 0.5], &ask, || true) {
            Ok(m) => show(&m.unwrap()),
            Err(e) => println!("{e}"),
        }
    }
    let _ = FRAC_PI_2;
}
