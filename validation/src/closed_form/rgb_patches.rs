//! Colours given as linear Rec. 709: for any spectrum ρ of a colour c, M ∫ (x̄, ȳ, z̄) ρ S dλ / N = c
//! under S = D65 with Y = 1 (Jakob and Hanika, "A low-dimensional function space for efficient spectral
//! upsampling", *Computer Graphics Forum* 38, 2019, whose spectra meet this to within a fitting error).
//!
//! The picture is the six colours that the scene was given: no table of the renderer is used.

use super::light::known;
use crate::claim::Claim;
use etalon_render::judge::ExactImage;

/// Patches in a row.
const COLUMNS: u32 = 3;
/// Rows of patches.
const ROWS: u32 = 2;

/// The picture of the patches. They must be of whole pixels.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    if !size[0].is_multiple_of(COLUMNS) || !size[1].is_multiple_of(ROWS) {
        return Err("the patches must be of whole pixels".to_owned());
    }
    let colours = (1..=COLUMNS * ROWS)
        .map(|i| parse(claim.text(&format!("colour_{i}"))?))
        .collect::<Result<Vec<_>, String>>()?;
    Ok(known(size, |column, row| {
        let patch = row * ROWS / size[1] * COLUMNS + column * COLUMNS / size[0];
        colours[patch as usize]
    }))
}

/// Three numbers with commas between them.
fn parse(text: &str) -> Result<[f64; 3], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[r, g, b]) => Ok([r, g, b]),
        _ => Err(format!("`{text}` is not three numbers")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_three_numbers() {
        assert_eq!(parse("0.8, 0.2,0.1"), Ok([0.8, 0.2, 0.1]));
        assert!(parse("0.8, 0.2").is_err() && parse("0.8, a, 1").is_err());
    }
}
