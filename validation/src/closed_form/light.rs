//! From spectral radiance, or the colour of each pixel, to a known picture.
//!
//! A colour is C = M ∫ (x̄, ȳ, z̄) L(λ) dλ / N, with the CIE 1931 observer, the normalisation N that
//! Mitsuba uses, and the matrix M from XYZ to linear Rec. 709.

use etalon_math::float64::pow;
use etalon_render::judge::ExactImage;
use etalon_spectrum::{cie, colour_space};

/// Linear Rec. 709 of the spectral radiance `radiance`.
pub fn rgb(radiance: impl Fn(f64) -> f64) -> [f64; 3] {
    colour_space::xyz_to_rgb(cie::xyz(radiance))
}

/// A byte of a picture in sRGB, decoded: with c = b/255, c/12.92 up to 0.04045, ((c + 0.055)/1.055)^2.4
/// beyond (IEC 61966-2-1).
pub fn decoded(byte: u8) -> f64 {
    let c = f64::from(byte) / 255.0;
    if c <= 0.040_45 {
        c / 12.92
    } else {
        pow((c + 0.055) / 1.055, 2.4)
    }
}

/// A picture from the colour of each pixel (column, row).
pub fn known(size: [u32; 2], pixel: impl Fn(u32, u32) -> [f64; 3]) -> ExactImage {
    let colours: Vec<[f64; 3]> = (0..size[1])
        .flat_map(|y| (0..size[0]).map(move |x| (x, y)))
        .map(|(x, y)| pixel(x, y))
        .collect();
    let channels = ["R", "G", "B"].into_iter().enumerate();
    ExactImage {
        size,
        channels: channels
            .map(|(c, name)| (name.to_owned(), colours.iter().map(|rgb| rgb[c]).collect()))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::decoded;

    #[test]
    fn bytes_are_decoded_as_the_standard_says() {
        assert_eq!([decoded(0), decoded(255)], [0.0, 1.0]);
        assert!((decoded(128) - 0.215_860_5).abs() < 1e-7);
        // The two branches meet between bytes 10 and 11.
        assert!((decoded(10) - 10.0 / 255.0 / 12.92).abs() < 1e-15);
        assert!((decoded(11) - 0.003_346_5).abs() < 1e-7);
    }
}
