//! Participating media, the phase functions of their points, and diffusion profiles.
//!
//! A medium is described by spectra and volumes ([`MediumDescription`]) and resolved at the wavelengths of a path into
//! plain numbers ([`MediumAtWavelengths`]), which know how to fly ([`etalon_transport::Medium`]).

pub mod anisotropic_dipole;
pub mod beam_diffusion;
pub mod blend;
pub mod burley;
pub mod dipole;
pub mod draine;
pub mod henyey_greenstein;
pub mod heterogeneous;
pub mod homogeneous;
pub mod isotropic;
pub mod majorants;
pub mod materials;
pub mod media;
pub mod mie;
pub mod multipole;
pub mod phases;
pub mod profile_model;
pub mod profiles;
pub mod rayleigh;
mod rotational;
pub mod sggx;
pub mod sphere;
pub mod surface_albedo;
pub mod tabulated;
pub mod tracking;
mod volume;

pub use blend::Blend;
pub use draine::Draine;
pub use henyey_greenstein::HenyeyGreenstein;
pub use heterogeneous::{Heterogeneous, HeterogeneousAt};
pub use homogeneous::{Homogeneous, HomogeneousAt};
pub use isotropic::Isotropic;
pub use media::{MediumAtWavelengths, MediumDescription};
pub use mie::Mie;
pub use phases::{PhaseAt, PhaseFunction};
pub use profile_model::Boundary;
pub use profiles::{Profile, ProfileAt};
pub use rayleigh::Rayleigh;
pub use sggx::Sggx;
pub use tabulated::Tabulated;
pub use tracking::Tracking;
