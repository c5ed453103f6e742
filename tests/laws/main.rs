//! What holds at every body and every state, and the motions, ends and drifts that are known: one room of physics to a file.
//!
//! All of them are one program, since the compiler would take as long again for each of several.

mod beside_folds;
mod beside_turns;
mod big;
mod common;
mod drift;
mod endings;
mod ends;
mod ensemble;
mod equations;
mod evaluations;
mod exact;
mod hard_cases;
mod integrators;
mod leaving;
mod losing_slips;
mod losses;
mod moving;
mod paper;
mod poses;
mod references;
mod resting;
mod slip;
mod stability;
mod steady_states;
mod stone;
mod stone_claims;
mod sweep;
mod thin_disk;
mod throw;
mod turning_points;
mod units;
mod whirrs;

use common::rim::{Place, ULP, condition, place, sharp, steady_end};
