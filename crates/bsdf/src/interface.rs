//! Interfaces between dielectrics and metals: refractive indices, Fresnel's equations, refraction.

pub mod fresnel;
pub mod metal;
pub mod refraction;
pub mod relative_index;
pub mod rough_fresnel;
