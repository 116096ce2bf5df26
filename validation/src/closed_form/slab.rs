//! Parallel light on a layer of matter that scatters evenly in all directions, seen from above:
//! [`etalon_conform::truth::slab`].

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_conform::truth::pixels;
use etalon_conform::truth::slab::{Escape, Layer, once as single};
use etalon_render::judge::ExactImage;
use std::f64::consts::PI;

/// The irradiance of a plane across the light.
const IRRADIANCE: f64 = 10.0;

/// The picture from above, at 90°, of radiance in proportion to `factor` of μ.
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

/// Of a layer.
pub fn layer(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let layer = Layer::new(claim.number("albedo")?, 2.0 * claim.number("half")?);
    let into = layer.at(-claim.number("down")?);
    seen(claim, size, |mu| {
        let out = layer.at(mu);
        out[0] * into[0] - out[1] * into[1]
    })
}

/// Of a layer, by light that was scattered once.
pub fn once(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let thickness = 2.0 * claim.number("half")?;
    let into = -claim.number("down")?;
    seen(claim, size, |mu| single(thickness, mu, into))
}
