//! From spectral radiance, or the colour of each pixel, to a known picture.
//!
//! A colour is C = M ∫ (x̄, ȳ, z̄) L(λ) dλ / N, with the CIE 1931 observer, the normalisation N that
//! Mitsuba uses, and the matrix M from XYZ to linear Rec. 709.

use etalon::judge::Known;
use etalon_spectrum::{cie, colour_space};

/// Linear Rec. 709 of the spectral radiance `radiance`.
pub fn rgb(radiance: impl Fn(f64) -> f64) -> [f64; 3] {
    colour_space::xyz_to_rgb(cie::xyz(radiance))
}

/// A picture from the colour of each pixel (column, row).
pub fn known(size: [u32; 2], pixel: impl Fn(u32, u32) -> [f64; 3]) -> Known {
    let colours: Vec<[f64; 3]> = (0..size[1])
        .flat_map(|y| (0..size[0]).map(move |x| (x, y)))
        .map(|(x, y)| pixel(x, y))
        .collect();
    let channels = ["R", "G", "B"].into_iter().enumerate();
    Known {
        size,
        channels: channels
            .map(|(c, name)| (name.to_owned(), colours.iter().map(|rgb| rgb[c]).collect()))
            .collect(),
    }
}
