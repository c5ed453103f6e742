mod common;
use common::motions;
use spincyl::exact::Swing;

#[test]
fn table() {
    for r in motions() {
        let name = format!("{:28} {:?}", r.scene, r.contact);
        let t0 = std::time::Instant::now();
        let swing = Swing::new(&r.body, &r.start, r.contact, false).unwrap();
        let took = t0.elapsed();
        let t0 = std::time::Instant::now();
        let swing_pose = Swing::new(&r.body, &r.start, r.contact, true).unwrap();
        let took_pose = t0.elapsed();
        if r.kind == "period" {
            let [lo, hi] = swing.turning_points();
            let a = swing_pose.angles_per_period().unwrap();
            println!("{name} T={:.6} dT/T={:.1e} min {:.1e} ({:.1e}) max {:.1e} dphi {:.1e} dpsi {:.1e}  {took:?} {took_pose:?}", r.t, swing.period()/r.t-1.0, lo-r.values[0], r.values[0], hi-r.values[1], a[0]-r.values[2], a[1]-r.values[3]);
        }
        if r.kind == "state" {
            let y: [f64;4] = swing.state(r.t).into();
            let err = (0..4).map(|i| (y[i]-r.values[i]).abs()).fold(0f64, f64::max);
            let p = swing_pose.pose(r.t).unwrap();
            let e = [p.phi.radians()-r.values[4], p.psi.radians()-r.values[5], p.contact.x-r.values[6], p.contact.y-r.values[7]];
            let f = spincyl::contact::force(r.contact, &r.body, &State(y));
            println!("{name} t={:e} err {err:.1e} claim {:.1e}  pose {:.0e} {:.0e} {:.0e} {:.0e} claim {:.0e} force {:.0e} {:.0e}", r.t, swing.error(r.t), e[0], e[1], e[2], e[3], swing_pose.pose_error(r.t), f.normal-r.values[8], f.friction()-r.values[9]);
        }
    }
}
#[allow(non_snake_case)]
fn State(y: [f64;4]) -> spincyl::State { y.into() }
