//! Many motions at once, next to where the inclination turns back.
//!
//! There the rate of the inclination is the root of a difference of two almost equal numbers; computed from
//! the inclination it would have half of its digits.

use crate::common::many::Many;
use crate::common::{BOTH, any_body, any_state, distance, numbers};
use proptest::prelude::*;
use spincyl::ensemble::{Answer, Job};
use spincyl::exact::Swing;
use spincyl::motion::Ask;
use spincyl::{Body, Contact, State};

/// The difference of a motion in SIMD lanes and the single one, over the sum of their estimated errors; None if no
/// lane computed it.
fn share(body: &Body, y: &State, contact: Contact, t: f64) -> Option<f64> {
    let swing = Swing::new(body, y, contact).ok()?;
    let many = Many::of(&[(*body, *y)]).run(&Job::new(&[t]).with_ask(Ask::on(contact).with_beyond()), 1);
    let off = distance(&many.last(0), &numbers(&swing.state(t)));
    (many.method[0] == Answer::Lanes as u8).then(|| off / (many.error[0] + swing.error(t)))
}

#[test]
fn two_motions_that_fresh_seeds_found_keep_the_digits_of_their_rate() {
    let first = Body::new(0.8628787333163256, 1.61035159501368, 1.61035159501368).unwrap();
    let second = Body::new(0.5473235563083485, 1.4961636953336026, 2.831536836930401).unwrap();
    for (body, theta, w1, w3, t) in [
        (first, 2.1, -1.4, -1.3, 7.357787419127228),
        (second, 3.0581791316631493, 3.2068315778569967, -2.478623171573935, 3.5650986414040995),
    ] {
        let y = State { theta, w1, w2: 0.0, w3 };
        assert!(share(&body, &y, Contact::Smooth, t).is_some_and(|share| share < 1.0));
    }
}

#[test]
fn a_swing_of_many_panels_claims_the_roundings_of_all_of_them() {
    // found by a random test: from 6 to 173 degrees, and a claim that was five times too small after two
    // periods
    let body = Body::new(3.8418816469838872, 0.1, 0.03647048537898937).unwrap();
    let (theta, w1, w3) = (3.0139791555068944, -2.6123408118855647, -5.294493679643214);
    let y = State { theta, w1, w2: 0.0, w3 };
    let period = Swing::new(&body, &y, Contact::Rolling).unwrap().period();
    for halves in 1..5 {
        let t = 0.5 * f64::from(halves) * period + 1e-4;
        let share = share(&body, &y, Contact::Rolling, t);
        assert!(share.is_none_or(|share| share < 1.0), "{halves}: {share:?}");
    }
    assert!(share(&body, &y, Contact::Rolling, 0.5 * period + 1e-4).is_some(), "the lanes answer");
}

proptest! {
    #![proptest_config(crate::common::cases(640))]

    /// A wide swing takes up to ten panels, and each of them continues with the rounding errors of those
    /// before it.
    #[test]
    fn next_to_a_turning_point_many_are_as_exact_as_one(
        body in any_body(), y in any_state(), halves in 1..7u8, early in -9.0..-2.0f64, before in any::<bool>(),
        at_rest in any::<bool>(),
    ) {
        let y = State { w2: if at_rest { 0.0 } else { y.w2 }, ..y };
        for contact in BOTH {
            let Ok(swing) = Swing::new(&body, &y, contact) else { continue };
            let beside = 10f64.powf(early) * if before { -1.0 } else { 1.0 };
            let t = 0.5 * f64::from(halves) * swing.period() + beside;
            if t > 0.0 && t < 100.0 && swing.landing(1.0).is_none() {
                let share = share(&body, &y, contact, t);
                prop_assert!(share.is_none_or(|share| share < 2.0), "{contact:?}: {share:?}");
            }
        }
    }
}
