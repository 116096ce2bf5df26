//! Phase functions: how the points of a medium scatter light.
//!
//! All of them depend on the angle between the directions only and are sampled exactly, so their
//! value *is* their density. Media that use them are not part of the scene language yet.

pub mod henyey_greenstein;
pub mod isotropic;
pub mod rayleigh;
mod rotational;

pub use henyey_greenstein::HenyeyGreenstein;
pub use isotropic::Isotropic;
pub use rayleigh::Rayleigh;
