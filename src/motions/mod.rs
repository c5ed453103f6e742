//! Motions of bodies and stones from an initial state: by first integrals, by steps, or as a slow drift along steady
//! states.

pub(crate) mod ask;
pub(crate) mod bounds;
mod conserved;
mod course;
pub(crate) mod creep;
pub(crate) mod custom;
#[cfg(feature = "many")]
pub mod drift;
pub mod exact;
pub(crate) mod exactly;
pub(crate) mod extent;
pub(crate) mod followed;
pub(crate) mod halt;
pub(crate) mod judge;
pub(crate) mod limits;
pub mod measured;
pub mod motion;
mod moving;
pub mod path;
pub(crate) mod rests;
mod result;
mod rk4;
pub(crate) mod row;
mod sample;
pub(crate) mod stone;
pub mod turning;
pub(crate) mod walk;
mod within;

pub use ask::{Ask, Method, Start};
pub use bounds::Bounds;
pub use moving::Moving;
pub use rests::RestsOn;
pub use result::{Ending, Event, Hit, Kind, Limit, Motion, Path, Phase, Strike};
pub use sample::Sample;
