//! Motions of bodies and stones from an initial state: by first integrals, by steps, or as a slow drift along steady
//! states.

pub(crate) mod ask;
pub mod body;
pub(crate) mod custom;
#[cfg(feature = "many")]
pub mod drift;
pub(crate) mod dry;
pub mod exact;
pub mod measured;
pub mod motion;
mod rk4;
pub(crate) mod slope;
pub(crate) mod stone;
pub mod turning;
pub(crate) mod walk;
pub mod world;

pub use ask::bounds::Bounds;
pub use ask::moving::Moving;
pub use ask::rests_on::RestsOn;
pub use ask::result::{
    AfterImpact, Ending, Event, Hit, Kind, Lands, Limit, Motion, OtherRim, Path, Phase, Strike,
};
pub use ask::sample::Sample;
pub use ask::{AboveTable, Ask, Method, Start};
