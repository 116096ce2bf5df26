//! Schemas of the scene format, from the reader's tags and from what plugins ask for.

pub(crate) mod relax_ng;
mod xml;
pub(crate) mod xsd;
