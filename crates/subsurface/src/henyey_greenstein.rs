//! The Henyey–Greenstein phase function (Henyey & Greenstein 1941, eq. 2).
//!
//! ```text
//! p(μ) = (1 − g²) / (4π · (1 + g² − 2gμ)^{3/2})
//! ```
//!
//! with μ the cosine between the direction of travel and the scattered one, and g ∈ (−1, 1) its
//! mean. Numerics: near g = 0 the inverse distribution function loses digits and the isotropic
//! one is used (|g| < 10⁻³, an error of the order of g).

use crate::rotational::Rotational;
use etalon_params::Params;
use std::f32::consts::PI;

/// Henyey–Greenstein scattering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HenyeyGreenstein {
    g: f32,
}

impl HenyeyGreenstein {
    /// With mean cosine `g`; `None` unless −1 < g < 1.
    pub fn new(g: f32) -> Option<Self> {
        (g.abs() < 1.0).then_some(Self {
            g: if g.abs() < 1e-3 { 0.0 } else { g },
        })
    }
}

impl HenyeyGreenstein {
    /// g.
    pub fn mean_cosine(&self) -> f32 {
        self.g
    }

    /// Reads `g`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Self> {
        let g = params.float_where("g", 0.8, "a number between -1 and 1", |g| g.abs() < 1.0);
        Self::new(g as f32)
    }
}

impl Rotational for HenyeyGreenstein {
    fn value(&self, mu: f32) -> f32 {
        let g = self.g;
        let d = 1.0 + g * g - 2.0 * g * mu;
        (1.0 - g * g) / (4.0 * PI * d * d.sqrt())
    }

    fn inverse(&self, u: f32) -> f32 {
        let g = self.g;
        if g == 0.0 {
            return 2.0 * u - 1.0;
        }
        let q = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
        (1.0 + g * g - q * q) / (2.0 * g)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_a_phase_function() {
        for g in [-0.7, -0.2, 0.0, 0.3, 0.85] {
            crate::rotational::check(&HenyeyGreenstein::new(g).expect("in range"));
        }
    }

    #[test]
    fn mean_cosine_is_g() {
        for g in [-0.7, 0.3, 0.85] {
            let phase = HenyeyGreenstein::new(g).expect("in range");
            let n = 20_000;
            let mean: f32 = (0..n)
                .map(|i| phase.inverse((i as f32 + 0.5) / n as f32))
                .sum::<f32>()
                / n as f32;
            assert!((mean - g).abs() < 1e-3);
        }
    }

    #[test]
    fn refuses_singular_parameters() {
        for g in [1.0, -1.0, 2.0, f32::NAN] {
            assert_eq!(HenyeyGreenstein::new(g), None);
        }
    }
}
