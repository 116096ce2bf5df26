//! The colour of black bodies.
//!
//! L(λ) = 2 h c² λ⁻⁵/(e^(h c/(λ k T)) − 1) (Planck, "Über das Gesetz der Energieverteilung im
//! Normalspectrum", 1901), in linear Rec. 709: C = M ∫ (x̄, ȳ, z̄) L dλ / N.
//!
//! The colours stand here as numbers, so that a fault in the renderer's tables of the observer, in
//! their normalisation, in Planck's law or in the matrix cannot hide in the closed form.

use super::light::known;
use crate::claim::Claim;
use etalon_render::judge::ExactImage;

/// Temperature (K) and linear Rec. 709 in W·m⁻²·sr⁻¹·nm⁻¹.
///
/// Computed by NumPy with Planck's law in the SI's constants of 2019, the CIE's observer of 1931 at
/// 1 nm from 360 to 830 nm (CIE 018:2019, linear in between), Gauss and Legendre's rule with five
/// points on each nanometre, N = 106.75026 nm (Mitsuba's), and the matrix of the primaries of Rec. 709
/// with the white of CIE 015:2018's table of D65, (0.95047065, 1, 1.08881522).
const COLOURS: [(f64, [f64; 3]); 4] = [
    (2000.0, [16.028_131_5, 4.114_685_8, 0.129_969_355]),
    (2856.0, [499.717_657, 223.778_312, 63.236_907_3]),
    (6500.0, [43_961.800_1, 41_449.662_3, 43_625.721_2]),
    (15_000.0, [384_387.036, 485_945.997, 835_222.087]),
];

/// The picture of a sky of the temperature `temperature`, one of those tabulated.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let temperature = claim.number("temperature")?;
    let (_, colour) = COLOURS
        .into_iter()
        .find(|(t, _)| *t == temperature)
        .ok_or_else(|| format!("the colour of {temperature} K is not tabulated"))?;
    Ok(known(size, |_, _| colour))
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_spectrum::{blackbody, cie, colour_space};

    #[test]
    fn chromaticities_are_the_published_ones() {
        // Wyszecki and Stiles, *Color Science*, 1982, table 1(3.11) to four digits, and illuminant A
        // (CIE 015:2018), which is 2856 K.
        let published = [
            (2000.0, [0.5267, 0.4133]),
            (2856.0, [0.4476, 0.4074]),
            (6500.0, [0.3135, 0.3237]),
            (15_000.0, [0.2637, 0.2673]),
        ];
        for ((temperature, colour), (other, [x, y])) in COLOURS.into_iter().zip(published) {
            assert_eq!(temperature, other);
            let xyy = colour_space::xyz_to_xyy(colour_space::rgb_to_xyz(colour));
            assert!(
                (xyy[0] - x).abs() < 1.1e-4 && (xyy[1] - y).abs() < 1.1e-4,
                "{temperature} K: {xyy:?}"
            );
        }
    }

    #[test]
    fn the_renderers_tables_give_the_same() {
        for (temperature, colour) in COLOURS {
            let xyz = cie::xyz(|lambda| blackbody::radiance(lambda, temperature));
            for (found, expected) in colour_space::xyz_to_rgb(xyz).into_iter().zip(colour) {
                assert!((found / expected - 1.0).abs() < 1e-7, "{found} {expected}");
            }
        }
    }
}
