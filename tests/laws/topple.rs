//! Toppling: a body that slides on its face, and one that a kerb has stopped, with moments in three dimensions.

use crate::common::{any_body, general_rounded};
use nalgebra::Vector3;
use proptest::prelude::*;
use spincyl::Body;
use spincyl::topple::{topples, tripped};

/// The leading edge of a body that moves along -x, from the centre of mass.
fn leading_edge(body: &Body) -> Vector3<f64> {
    Vector3::new(body.fillet() - 1.0, 0.0, -body.ell() - body.fillet())
}

proptest! {
    #![proptest_config(crate::common::cases(256))]

    #[test]
    fn a_kerb_takes_no_angular_momentum_about_the_edge_that_it_stops(
        body in prop_oneof![any_body(), general_rounded()], v in 0.0..10.0f64,
    ) {
        prop_assume!(body.fillet() < 1.0);
        let (edge, y) = (leading_edge(&body), tripped(&body, v).unwrap());
        prop_assert_eq!((y.theta, y.w1, y.w3), (0.0, 0.0, 0.0));
        let w = Vector3::new(y.w1, y.w2, y.w3);
        // the edge is at rest, so that the centre moves about it
        let [before, after] = [Vector3::new(-v, 0.0, 0.0), -w.cross(&edge)];
        let spin = w.component_mul(&Vector3::new(body.i1(), body.i1(), body.i3()));
        let gained = spin - edge.cross(&(after - before));
        prop_assert!(gained.y.abs() <= 1e-14 * (1.0 + v * edge.z.abs()), "{gained}");
        prop_assert!(after.z >= 0.0 && after.x <= 0.0, "the body rises over its leading edge: {after}");
    }

    #[test]
    fn a_body_topples_where_weight_and_inertia_meet_the_table_beyond_its_leading_edge(
        body in prop_oneof![any_body(), general_rounded()], share in prop_oneof![0.01..0.99f64, 1.01..3.0f64],
    ) {
        prop_assume!(body.fillet() < 1.0);
        let edge = leading_edge(&body);
        prop_assume!(edge.z != 0.0);
        // weight -z, and inertia mu N along the motion, which is along -x
        let mu = share * edge.x / edge.z;
        let drawn = Vector3::new(-mu, 0.0, -1.0);
        let meets = drawn * edge.z / drawn.z;
        prop_assert_eq!(topples(&body, mu).unwrap(), meets.x < edge.x);
    }
}

#[test]
fn a_ball_has_no_face_to_topple_over() {
    let ball = Body::ball(0.0, 0.4, 0.4).unwrap();
    let told = [topples(&ball, 0.3).unwrap_err(), tripped(&ball, 1.0).unwrap_err()].map(|e| e.to_string());
    assert!(
        told.iter().all(|text| text.starts_with("a = 0.0: expected a > 0, the radius of the face")),
        "{told:?}"
    );
    let can = Body::solid(2.0).unwrap();
    assert!(topples(&can, -0.1).unwrap_err().to_string().starts_with("mu = -0.1"));
    assert!(tripped(&can, f64::NAN).unwrap_err().to_string().starts_with("velocity = NaN"));
}
