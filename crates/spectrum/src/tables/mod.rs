//! Published numbers, as arrays; nothing here computes.

pub(crate) mod cie1931;
pub(crate) mod illuminants;
pub(crate) mod importance;
pub(crate) mod lamps;
