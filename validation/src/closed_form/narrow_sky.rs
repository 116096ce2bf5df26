//! A sky whose radiance is a triangle over the wavelength: 1 at λ₁, falling linearly to 0 at λ₀ and λ₂.
//!
//! The picture is its colour M ∫ (x̄, ȳ, z̄) L dλ / N. Both factors are linear between whole nanometres
//! if λ₀, λ₁ and λ₂ are whole, so that Simpson's rule on every nanometre is exact.

use super::light::{known, rgb};
use super::spectra;
use crate::claim::Claim;
use etalon_render::judge::ExactImage;

/// The picture of the sky.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let number = |key: &str| {
        let lambda = claim.number(key)?;
        let whole = lambda == lambda.round() && (361.0..830.0).contains(&lambda);
        whole
            .then_some(lambda)
            .ok_or_else(|| format!("`{key}` must be whole nanometres of what is seen"))
    };
    let (first, middle, last) = (number("first")?, number("middle")?, number("last")?);
    let table = [
        [360.0, 0.0],
        [first, 0.0],
        [middle, 1.0],
        [last, 0.0],
        [830.0, 0.0],
    ];
    let colour = rgb(|lambda| spectra::at(&table, lambda));
    Ok(known(size, |_, _| colour))
}
