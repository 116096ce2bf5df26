//! Metamers: two reflectances ρ₁, ρ₂ whose colours M ∫ (x̄, ȳ, z̄) ρ S dλ / N are the same under one
//! illuminant S and different under another.
//!
//! ρ₂ = ρ₁ + β with a metameric black β, ∫ (x̄, ȳ, z̄) β S dλ = 0 for S = D65 (Wyszecki, "Evaluation of
//! metameric colors", *JOSA* 48, 1958; Cohen and Kappauf, "Metameric color stimuli, fundamental metamers,
//! and Wyszecki's metameric blacks", *American Journal of Psychology* 95, 1982). Here
//! ρ₁ = 0.45, and β = Σ c_k sin(k π (λ − 400)/300), k = 1 … 4, from 400 to 700 nm: three equations leave one
//! β up to its size. Both tables are linear between tens of nanometres.

use super::light::{known, rgb};
use super::spectra::{at, table};
use crate::claim::Claim;
use crate::folders;
use etalon_render::judge::ExactImage;

/// The colours of the pair under the claim's illuminant.
fn pair(claim: &Claim) -> Result<[[f64; 3]; 2], String> {
    let folder = folders::scenes().join("metamers");
    let light = table(&folder.join(claim.text("illuminant")?))?;
    let grey = table(&folder.join("grey.spd"))?;
    let wavy = table(&folder.join("wavy.spd"))?;
    Ok([grey, wavy].map(|reflectance| rgb(|l| at(&light, l) * at(&reflectance, l))))
}

/// The picture under the illuminant that makes them alike: one colour everywhere.
pub fn matching(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let [grey, _] = pair(claim)?;
    Ok(known(size, |_, _| grey))
}

/// The picture under any illuminant, one half each.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    if !size[0].is_multiple_of(2) {
        return Err("each half must be of whole pixels".to_owned());
    }
    let colours = pair(claim)?;
    Ok(known(size, |column, _| {
        colours[usize::from(2 * column >= size[0])]
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn under(illuminant: &str) -> [[f64; 3]; 2] {
        let claim = toml::from_str(&format!(
            "title = \"\"\nscene = \"\"\nestimators = []\n[defines]\nilluminant = \"{illuminant}\"\n\
             [oracle]\nkind = \"closed_form\"\nformula = \"\"\n"
        ))
        .expect("a claim");
        pair(&claim).expect("spectra")
    }

    #[test]
    fn they_match_under_d65_only() {
        let [grey, wavy] = under("../colour-checker/d65.spd");
        for (a, b) in grey.into_iter().zip(wavy) {
            assert!((a / b - 1.0).abs() < 1e-8, "{a} {b}");
        }
        // By NumPy with tables of its own: linear Rec. 709 of both under A and under F11.
        let elsewhere = [
            (
                "../colour-checker/a.spd",
                [0.839_195_18, 0.375_726_99, 0.106_148_97],
                [0.741_079_97, 0.408_412, 0.098_582_21],
            ),
            (
                "../illuminants/f11.spd",
                [0.871_222_5, 0.570_618_98, 0.327_928_8],
                [0.824_341_9, 0.605_782_12, 0.338_346_1],
            ),
        ];
        for (illuminant, first, second) in elsewhere {
            let [grey, wavy] = under(illuminant);
            for c in 0..3 {
                // The matrix there was the rounded one of IEC 61966-2-1.
                assert!((grey[c] - first[c]).abs() < 3e-4, "{illuminant}: {grey:?}");
                assert!((wavy[c] - second[c]).abs() < 3e-4, "{illuminant}: {wavy:?}");
            }
            assert!((grey[0] - wavy[0]).abs() > 0.04);
        }
    }
}
