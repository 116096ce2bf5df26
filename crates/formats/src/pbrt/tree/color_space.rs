//! Colours of other spaces in linear Rec. 709.
//!
//! An `rgb` of pbrt refers to the colour space at its place (`util/colorspace.cpp`); Mitsuba's is always linear Rec. 709. All but ACES have
//! its white, so the colours are the same XYZ in other coordinates. ACES has another white, near D60. Light of that space is the same XYZ, too;
//! what reflects all light is white in both, so a reflectance is adapted from one white to the other, in the sharpened cone responses of
//! Bradford (K. M. Lam 1985; ICC.1:2001, annex E).

use super::super::parameter::ColorSpace;
use super::spectrum::Role;
use etalon_params::DVec3;
use etalon_spectrum::colour_space::{PRIMARIES, WHITE, xyz_to_rgb};
use glam::DMat3;

/// The white of ACES (SMPTE ST 2065-1).
const ACES_WHITE: [f64; 2] = [0.32168, 0.33767];

/// From XYZ to Bradford's responses, row by row.
const BRADFORD: [[f64; 3]; 3] = [
    [0.8951, 0.2664, -0.1614],
    [-0.7502, 1.7135, 0.0367],
    [0.0389, -0.0685, 1.0296],
];

/// The chromaticities (x, y) of the primaries of a space, and the XYZ of its white.
fn primaries(space: ColorSpace) -> ([[f64; 2]; 3], DVec3) {
    let d65 = DVec3::from_array(WHITE);
    match space {
        ColorSpace::Srgb => (PRIMARIES, d65),
        // SMPTE EG 432-1.
        ColorSpace::DciP3 => ([[0.680, 0.320], [0.265, 0.690], [0.150, 0.060]], d65),
        // ITU-R BT.2020-2.
        ColorSpace::Rec2020 => ([[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]], d65),
        // SMPTE ST 2065-1, AP0.
        ColorSpace::Aces2065 => (
            [[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077]],
            column(ACES_WHITE),
        ),
    }
}

/// XYZ of a chromaticity, with Y = 1.
fn column([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// A colour in linear Rec. 709, which may lie outside [0, 1] then.
pub(crate) fn to_rec709(rgb: [f64; 3], space: ColorSpace, role: Role) -> DVec3 {
    if space == ColorSpace::Srgb {
        return rgb.into();
    }
    let (primaries, white) = primaries(space);
    let [r, g, b] = primaries.map(column);
    let columns = DMat3::from_cols(r, g, b);
    let strength = columns.inverse() * white;
    let xyz = columns * (strength * DVec3::from_array(rgb));
    let xyz = match (space, role) {
        (ColorSpace::Aces2065, Role::Reflectance | Role::Unbounded) => {
            let bradford = DMat3::from_cols_array_2d(&BRADFORD).transpose();
            let ratio = bradford * DVec3::from_array(WHITE) / (bradford * white);
            bradford.inverse() * (ratio * (bradford * xyz))
        }
        _ => xyz,
    };
    xyz_to_rgb(xyz.to_array()).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_stays_white_and_a_deep_red_leaves_the_range() {
        for space in [ColorSpace::DciP3, ColorSpace::Rec2020, ColorSpace::Aces2065] {
            let white = to_rec709([0.7; 3], space, Role::Reflectance);
            assert!(white.distance(DVec3::splat(0.7)) < 1e-12, "{white}");
            let red = to_rec709([1.0, 0.0, 0.0], space, Role::Reflectance);
            assert!(red.x > 1.0 && red.y < 0.0, "{red}");
        }
    }

    /// The matrix from ACES2065-1 to linear sRGB by Bradford's adaptation, as many publish it.
    #[test]
    fn aces_is_adapted_as_published() {
        let published = [
            [2.5217, -1.1341, -0.3876],
            [-0.2765, 1.3727, -0.0962],
            [-0.0154, -0.1530, 1.1683],
        ];
        for channel in 0..3 {
            let mut unit = [0.0; 3];
            unit[channel] = 1.0;
            let found = to_rec709(unit, ColorSpace::Aces2065, Role::Unbounded);
            for row in 0..3 {
                let off = found[row] - published[row][channel];
                assert!(off.abs() < 5e-4, "{row} {channel} {found}");
            }
        }
    }

    /// Light that is white there is redder than D65.
    #[test]
    fn light_of_aces_keeps_its_colour() {
        let [x, y] = ACES_WHITE;
        let found = to_rec709([1.0; 3], ColorSpace::Aces2065, Role::Emission(1.0));
        let expected = xyz_to_rgb([x / y, 1.0, (1.0 - x - y) / y]);
        assert!(
            found.distance(DVec3::from_array(expected)) < 1e-12,
            "{found}"
        );
        assert!(found.x > found.z, "{found}");
    }
}
