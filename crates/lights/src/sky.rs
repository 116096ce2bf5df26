//! Models of the sky and of the sun in it.

pub(crate) mod hosek_wilkie;
pub(crate) mod sun_position;
