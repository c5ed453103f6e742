//! Laws that hold for every body and state, and known motions, ends and drifts: one subject per file.
//!
//! All files are one program, since the compiler would take as long for each of several.

mod at_once;
mod beside_folds;
mod beside_turns;
mod big;
mod common;
mod custom;
mod drift;
mod endings;
mod ends;
mod ensemble;
mod equations;
mod evaluations;
mod exact;
#[cfg(feature = "serde")]
mod files;
mod flight;
mod given_up;
mod hard_cases;
mod hopping;
mod impacts;
mod integrators;
mod leaving;
mod losing_slips;
mod losses;
mod lying;
mod measured;
mod moving;
mod paper;
mod parts;
mod patch;
mod poses;
mod public;
mod references;
mod resting;
mod slip;
mod stability;
mod steady_states;
mod sticking;
mod stone;
mod stone_claims;
mod sweep;
mod thin_disk;
mod throw;
mod turning_points;
mod twists;
mod uniform;
mod units;
mod upright;
mod whirrs;

use common::rim::{Place, ULP, condition, place, sharp, steady_end};
