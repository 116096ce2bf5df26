//! The phase function of Henyey & Greenstein: [`etalon_sampling::henyey_greenstein`].
//!
//! Near g = 0 the isotropic one is used (|g| < 10⁻³, an error of the order of g).

use crate::rotational::Rotational;
use etalon_params::Params;
use etalon_sampling::henyey_greenstein::{
    henyey_greenstein_density, interval_to_henyey_greenstein,
};

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
        henyey_greenstein_density(self.g, mu)
    }

    fn inverse(&self, u: f32) -> f32 {
        interval_to_henyey_greenstein(self.g, u)
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
