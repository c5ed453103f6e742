//! Which rotations and contacts dry friction and dry losses hold at rest, for bodies and for stones.

pub(crate) mod creep;
pub(crate) mod friction;
pub(crate) mod held;
pub(crate) mod settled;
