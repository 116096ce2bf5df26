//! Draine's phase function (B. T. Draine 2003, "Scattering by interstellar dust grains", equation 4): Henyey and
//! Greenstein's for α = 0, Rayleigh's for g = 0 and α = 1.
//!
//! ```text
//! p(μ) = (1 − g²) (1 + α μ²) / (4π (1 + α (1 + 2g²)/3) (1 + g² − 2gμ)^{3/2})
//! ```
//!
//! The integral is known in closed form: with q = 1 + g² and s = √(q − 2gμ),
//!
//! ```text
//! ∫ (1 + α μ²) s⁻³ dμ = (1/g) (1/s + α/(4g²) (q²/s + 2qs − s³/3))
//! ```
//!
//! and inverted by bisection. Numerics: |g| < 10⁻³ is taken for 0, where the integral is μ + α μ³/3.

use crate::rotational::Rotational;
use etalon_params::Params;
use std::f64::consts::PI;

/// Draine scattering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draine {
    g: f64,
    alpha: f64,
}

impl Draine {
    /// With `g` in (−1, 1) and `alpha` ≥ 0.
    pub fn new(g: f64, alpha: f64) -> Self {
        let g = if g.abs() < 1e-3 { 0.0 } else { g };
        Self { g, alpha }
    }

    /// Reads `g` and `alpha`.
    pub(crate) fn from_params(params: &Params<'_>) -> Self {
        let g = params.float_where("g", 0.8, "a number between -1 and 1", |g| g.abs() < 1.0);
        let what = "a finite number not below 0";
        let alpha = params.float_where("alpha", 1.0, what, |a| a >= 0.0 && a.is_finite());
        Self::new(g, alpha)
    }

    /// ∫ (1 + α μ²) s⁻³ dμ up to a constant.
    fn integral(&self, mu: f64) -> f64 {
        let Self { g, alpha } = *self;
        if g == 0.0 {
            return mu + alpha * mu.powi(3) / 3.0;
        }
        let q = 1.0 + g * g;
        let s = (q - 2.0 * g * mu).max(0.0).sqrt();
        (1.0 / s + alpha / (4.0 * g * g) * (q * q / s + 2.0 * q * s - s.powi(3) / 3.0)) / g
    }
}

impl Rotational for Draine {
    fn value(&self, mu: f32) -> f32 {
        let Self { g, alpha } = *self;
        let mu = f64::from(mu);
        let d = 1.0 + g * g - 2.0 * g * mu;
        let norm = 4.0 * PI * (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
        ((1.0 - g * g) * (1.0 + alpha * mu * mu) / (norm * d * d.sqrt())) as f32
    }

    fn inverse(&self, u: f32) -> f32 {
        let ends = [-1.0, 1.0].map(|mu| self.integral(mu));
        let wanted = ends[0] + f64::from(u) * (ends[1] - ends[0]);
        let (mut low, mut high) = (-1.0, 1.0);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if self.integral(middle) < wanted {
                low = middle;
            } else {
                high = middle;
            }
        }
        (0.5 * (low + high)) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HenyeyGreenstein, Rayleigh};

    #[test]
    fn is_a_phase_function() {
        for (g, alpha) in [
            (-0.6, 0.5),
            (0.0, 2.0),
            (0.02, 1.0),
            (0.5, 1.0),
            (0.85, 3.0),
        ] {
            crate::rotational::check(&Draine::new(g, alpha));
        }
    }

    #[test]
    fn has_two_others_as_limits() {
        let hg = HenyeyGreenstein::new(0.6).expect("in range");
        for mu in [-1.0, -0.3, 0.2, 0.9] {
            let near = |a: f32, b: f32| assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
            near(Draine::new(0.6, 0.0).value(mu), hg.value(mu));
            near(Draine::new(0.0, 1.0).value(mu), Rayleigh.value(mu));
        }
    }
}
