//! Isotropic scattering.
//!
//! ```text
//! p(μ) = 1 / 4π
//! ```

use crate::rotational::Rotational;
use std::f32::consts::PI;

/// Scatters equally in all directions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Isotropic;

impl Rotational for Isotropic {
    fn value(&self, _: f32) -> f32 {
        0.25 / PI
    }

    fn inverse(&self, u: f32) -> f32 {
        2.0 * u - 1.0
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn is_a_phase_function() {
        crate::rotational::check(&super::Isotropic);
    }
}
