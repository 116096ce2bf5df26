//! Participating media and the phase functions of their points.
//!
//! A medium is described by spectra and volumes ([`MediumDescription`]) and resolved at the wavelengths of a path into
//! plain numbers ([`MediumAtWavelengths`]), which know how to fly ([`etalon_transport::Medium`]).

pub mod henyey_greenstein;
pub mod homogeneous;
pub mod isotropic;
pub mod media;
pub mod phases;
pub mod rayleigh;
mod rotational;
mod volume;

pub use henyey_greenstein::HenyeyGreenstein;
pub use homogeneous::{Homogeneous, HomogeneousAt};
pub use isotropic::Isotropic;
pub use media::{MediumAtWavelengths, MediumDescription};
pub use phases::AnyPhase;
pub use rayleigh::Rayleigh;
