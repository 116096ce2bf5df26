//! Rayleigh scattering, for particles much smaller than the wavelength (Rayleigh 1871).
//!
//! ```text
//! p(μ) = 3/(16π) · (1 + μ²)
//! ```
//!
//! The distribution function is a cubic, μ³ + 3μ = 8u − 4, with one real root (Cardano):
//! with z = 4u − 2, μ = ∛(z + √(z² + 1)) + ∛(z − √(z² + 1)).

use crate::rotational::Rotational;
use etalon_math::float;
use std::f32::consts::PI;

/// Rayleigh scattering.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rayleigh;

impl Rotational for Rayleigh {
    fn value(&self, mu: f32) -> f32 {
        3.0 / (16.0 * PI) * (1.0 + mu * mu)
    }

    fn inverse(&self, u: f32) -> f32 {
        let z = 4.0 * u - 2.0;
        let root = (z * z + 1.0).sqrt();
        float::cbrt(z + root) + float::cbrt(z - root)
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn is_a_phase_function() {
        crate::rotational::check(&super::Rayleigh);
    }
}
