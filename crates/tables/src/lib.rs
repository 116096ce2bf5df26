//! Measured BRDFs as data: readers, writers, interpolation, importance sampling.
//!
//! [`BrdfTable`] holds a file of one of three kinds: the MERL database's ([`merl`]), the RGL material database's
//! ([`rgl`]), or the spectral format of this crate ([`spectral`]). The model that scenes name, `measured`, is in the
//! crate of scattering models.
//!
//! Directions are in the local frame whose z is the normal; both leave the point. `wo` is the known one, `wi` the
//! sampled one. Values include the cosine of `wi` unless they are called a BRDF.

pub mod half_vector;
pub mod merl;
pub mod rgl;
pub mod spectral;
pub mod table;
pub mod tensor_file;
pub mod warp;
pub mod write_rgl;

pub use table::{BrdfAtWavelengths, BrdfTable};

/// A mistake in a file: one sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct BrdfTableError {
    message: String,
}

impl BrdfTableError {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
        }
    }
}
