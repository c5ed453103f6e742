//! What holds at every body and every state, of sharp and of rounded rims: one room of physics to a file.

#[path = "../common/mod.rs"]
mod common;

mod beside_folds;
mod big;
mod equations;
mod moving;
mod references;
mod stability;
mod steady_states;
mod turning_points;
mod units;

use common::rim::{Place, ULP, condition, place, sharp, steady_end};
