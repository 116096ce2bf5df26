//! White balance: the map of colours that takes the white of one light to that of the colour space.
//!
//! ```text
//! rgb′ = M B⁻¹ diag(B w′ / B w) B M⁻¹ rgb
//! ```
//!
//! with w the light's white, w′ that of D65, M from XYZ to linear Rec. 709, and B Bradford's cone responses (K. Lam 1985; ICC.1:2022, annex E).
//! The light is daylight of a correlated colour temperature, or below 4000 K a black body, as in pbrt-v4.

use crate::colour_space::{RGB_TO_XYZ, WHITE, XYZ_TO_RGB};
use crate::{blackbody, cie, named_illuminants};
use glam::{DMat3, DVec3, Vec4};

/// B.
const BRADFORD: [[f64; 3]; 3] = [
    [0.8951, 0.2664, -0.1614],
    [-0.7502, 1.7135, 0.0367],
    [0.0389, -0.0685, 1.0296],
];

fn matrix(rows: &[[f64; 3]; 3]) -> DMat3 {
    DMat3::from_cols_array_2d(rows).transpose()
}

/// The colour of a light of that temperature, of any luminance.
fn xyz_of(kelvin: f64) -> [f64; 3] {
    match named_illuminants::daylight(kelvin) {
        Some(daylight) => cie::xyz(|lambda| daylight.eval(Vec4::splat(lambda as f32)).x.into()),
        None => cie::xyz(|lambda| blackbody::radiance(lambda, kelvin)),
    }
}

/// The matrix in linear Rec. 709, row by row, that makes a light of `kelvin` white; `None` unless that is 1000 to 25000.
pub fn white_balance(kelvin: f64) -> Option<[[f64; 3]; 3]> {
    if !(1000.0..=25000.0).contains(&kelvin) {
        return None;
    }
    let xyz = xyz_of(kelvin);
    let white = DVec3::from_array(xyz) / xyz[1];
    let bradford = matrix(&BRADFORD);
    let gains = (bradford * DVec3::from_array(WHITE)) / (bradford * white);
    let adapted = bradford.inverse() * DMat3::from_diagonal(gains) * bradford;
    let whole = matrix(&XYZ_TO_RGB) * adapted * matrix(&RGB_TO_XYZ);
    Some(whole.transpose().to_cols_array_2d())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour_space::{apply, xyz_to_rgb};

    /// The light itself becomes white, of its own luminance; D65 stays what it is. Rejects gains the wrong way round.
    #[test]
    fn lights_become_white() {
        for kelvin in [2000.0, 3200.0, 5000.0, 6504.0, 10000.0] {
            let balance = white_balance(kelvin).expect("a temperature");
            let light = xyz_of(kelvin);
            let rgb = apply(&balance, xyz_to_rgb(light));
            for c in rgb {
                assert!((c / light[1] - 1.0).abs() < 1e-9, "{kelvin}: {rgb:?}");
            }
        }
        let nothing = white_balance(6504.0).expect("a temperature");
        for (i, row) in nothing.iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                let one = if i == j { 1.0 } else { 0.0 };
                assert!((x - one).abs() < 2e-3, "{nothing:?}");
            }
        }
        assert_eq!(white_balance(900.0), None);
    }
}
