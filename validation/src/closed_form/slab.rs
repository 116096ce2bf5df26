//! Parallel light on a layer of matter that scatters evenly in all directions, seen from above.
//!
//! With the irradiance E of a plane across the light, μ₀ and μ the cosines of the ways in and out with the normal, and ϖ the
//! albedo, a layer without end has the radiance
//!
//! ```text
//! L = ϖ E/(4π) · μ₀/(μ + μ₀) · H(μ) H(μ₀),   H(μ) = 1 + ϖ/2 μ H(μ) ∫₀¹ H(μ')/(μ + μ') dμ'
//! ```
//!
//! (S. Chandrasekhar, Radiative Transfer, 1950, chapter V), and one of the optical thickness τ by single scattering alone
//!
//! ```text
//! L = ϖ E/(4π) · μ₀/(μ + μ₀) · (1 − exp(−τ (1/μ + 1/μ₀)))
//! ```

use super::light::{known, rgb};
use super::pixels;
use crate::claim::Claim;
use etalon::judge::ExactImage;
use etalon_math::float64::exp;
use std::f64::consts::PI;

/// The irradiance of a plane across the light.
const IRRADIANCE: f64 = 10.0;

/// Chandrasekhar's H for even scattering of albedo ϖ.
struct Escape {
    albedo: f64,
    /// Midpoints of [0, 1], and H there.
    nodes: Vec<[f64; 2]>,
}

impl Escape {
    fn new(albedo: f64) -> Self {
        const NODES: usize = 400;
        let middle = |i| (i as f64 + 0.5) / NODES as f64;
        let mut escape = Self {
            albedo,
            nodes: (0..NODES).map(|i| [middle(i), 1.0]).collect(),
        };
        // In the form 1/H = √(1 − ϖ) + ϖ/2 ∫ μ' H(μ')/(μ + μ') dμ', which converges for any ϖ up to 1.
        for _ in 0..200 {
            let values: Vec<f64> = escape.nodes.iter().map(|[mu, _]| escape.at(*mu)).collect();
            for (node, value) in escape.nodes.iter_mut().zip(values) {
                node[1] = 0.5 * (node[1] + value);
            }
        }
        escape
    }

    fn at(&self, mu: f64) -> f64 {
        let part = |[other, value]: &[f64; 2]| other * value / (mu + other);
        let mean = self.nodes.iter().map(part).sum::<f64>() / self.nodes.len() as f64;
        1.0 / ((1.0 - self.albedo).sqrt() + 0.5 * self.albedo * mean)
    }
}

/// The picture from above, at 90°, of what shines in proportion to `factor` of μ.
fn seen(claim: &Claim, size: [u32; 2], factor: impl Fn(f64) -> f64) -> Result<ExactImage, String> {
    let scale = claim.number("albedo")? * IRRADIANCE / (4.0 * PI);
    let into = -claim.number("down")?;
    let light = rgb(|_| scale);
    Ok(known(size, |column, row| {
        let value = pixels::mean(size, [column, row], |x, y| {
            let mu = 1.0 / (1.0 + x * x + y * y).sqrt();
            into / (mu + into) * factor(mu)
        });
        light.map(|light| light * value)
    }))
}

/// Of a layer without end.
pub fn half_space(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let escape = Escape::new(claim.number("albedo")?);
    let into = escape.at(-claim.number("down")?);
    seen(claim, size, |mu| escape.at(mu) * into)
}

/// Of a layer, by light that was scattered once.
pub fn once(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let thickness = 2.0 * claim.number("half")?;
    let into = -claim.number("down")?;
    seen(claim, size, |mu| {
        1.0 - exp(-thickness * (1.0 / mu + 1.0 / into))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chandrasekhar's table XI for ϖ = 1; and the mean of H, 2 (1 − √(1 − ϖ))/ϖ.
    #[test]
    fn h_is_that_of_the_tables() {
        for (albedo, mu, expected) in [(1.0, 1.0, 2.9078), (1.0, 0.5, 2.0128)] {
            let found = Escape::new(albedo).at(mu);
            assert!(
                (found - expected).abs() < 1e-3 * expected,
                "{albedo}, {mu}: {found}"
            );
        }
        let escape = Escape::new(0.8);
        let mean = escape.nodes.iter().map(|[_, h]| h).sum::<f64>() / escape.nodes.len() as f64;
        let expected = 2.0 / 0.8 * (1.0 - 0.2_f64.sqrt());
        assert!((mean - expected).abs() < 1e-4, "{mean} {expected}");
    }
}
