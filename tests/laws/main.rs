//! Laws that hold for every body and state, and known motions, ends and drifts: one subject per file.
//!
//! All files are one program, since the compiler would take as long for each of several.

mod big_integers;
mod carried;
mod circles;
mod circles_reference;
mod common;
mod cups;
mod custom;
mod custom_stones;
mod drift;
mod driven;
mod endings;
mod ensemble;
mod equations;
mod evaluations;
mod exact;
mod face_reference;
#[cfg(feature = "serde")]
mod files;
mod flight;
mod given_up;
mod hard_cases;
mod hopping;
mod impacts;
mod integrators;
mod leaving_the_model;
mod losing_slips;
mod losses;
mod lying;
mod many_ends;
mod many_near_turns;
mod measured;
mod near_folds;
mod outlines;
mod paper;
mod parts;
mod patch;
mod poses;
mod public;
mod random_cups;
mod references;
mod resting;
mod restitution;
mod rounded_motions;
#[cfg(feature = "scene")]
mod scenes;
mod several_held;
mod slip;
mod slope;
mod slope_face;
mod slope_lying;
mod slope_stones;
mod stability;
mod standing;
mod steady_states;
mod steep;
mod sticking;
mod stone;
mod stone_claims;
mod stone_hops;

mod sweep;
mod thin_disk;
mod throw;
mod topple;
mod turning_points;
mod turntable;
mod twists;
mod uniform;
mod units;
mod upright;
mod while_rolling;
mod whirrs;
mod worlds;

use common::rim::{Place, ULP, condition, place, sharp, steady_end};
