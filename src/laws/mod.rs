//! The laws of physics: bodies, their states, the contact forces, and the losses of energy.

pub mod body;
pub mod contact;
pub(crate) mod custom;
pub(crate) mod custom_si;
pub mod loss;
pub mod newton;
pub mod pose;
pub mod scale;
pub mod state;
pub mod steep;
pub mod stone;
pub mod throw;
pub mod topple;
