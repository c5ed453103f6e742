//! Drifts: closed forms, and laws that hold for all of them.

mod many;
mod rest;
mod rolls;

use spincyl::Body;
use spincyl::drift::Drift;
use spincyl::loss::{Law, Losses};

fn disk() -> Body {
    Body::solid(0.0).unwrap()
}

fn drift(body: &Body, theta: f64, losses: Losses) -> Drift {
    Drift::at_rest(body, theta, &losses).unwrap()
}

/// The relative difference |a/b - 1|.
fn apart(a: f64, b: f64) -> f64 {
    (a / b - 1.0).abs()
}

/// The loss laws that a body can have: without a face there is no film of air below it.
fn laws_of(body: &Body) -> impl Iterator<Item = Law> + use<> {
    let body = *body;
    Law::ALL.iter().copied().filter(move |law| Losses::of(*law, 1.0).check_for(&body).is_ok())
}
