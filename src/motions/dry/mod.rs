//! What dry friction and the losses hold, for bodies and for stones.

pub(crate) mod creep;
pub(crate) mod friction;
pub(crate) mod held;
pub(crate) mod settled;
