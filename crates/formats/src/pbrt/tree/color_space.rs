//! Colours of other spaces in linear Rec. 709.
//!
//! An `rgb` of pbrt refers to the colour space at its place (`util/colorspace.cpp`); Mitsuba's is always linear Rec. 709. All but ACES have
//! its white, so the colours are the same XYZ in other coordinates. ACES has another white, with which a reflectance of (1, 1, 1) would
//! not be white here.

use super::super::parameter::ColorSpace;
use etalon_params::DVec3;
use etalon_spectrum::colour_space::{PRIMARIES, WHITE, xyz_to_rgb};
use glam::DMat3;

/// The chromaticities (x, y) of the primaries of a space that has the white D65.
fn primaries(space: ColorSpace) -> Option<[[f64; 2]; 3]> {
    match space {
        ColorSpace::Srgb => Some(PRIMARIES),
        // SMPTE EG 432-1.
        ColorSpace::DciP3 => Some([[0.680, 0.320], [0.265, 0.690], [0.150, 0.060]]),
        // ITU-R BT.2020-2.
        ColorSpace::Rec2020 => Some([[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]]),
        ColorSpace::Aces2065 => None,
    }
}

/// A colour in linear Rec. 709, which may lie outside [0, 1] then; `None` for a space of another white.
pub(crate) fn to_rec709(rgb: [f64; 3], space: ColorSpace) -> Option<DVec3> {
    if space == ColorSpace::Srgb {
        return Some(rgb.into());
    }
    let column = |[x, y]: [f64; 2]| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    let [r, g, b] = primaries(space)?.map(column);
    let columns = DMat3::from_cols(r, g, b);
    let strength = columns.inverse() * DVec3::from_array(WHITE);
    let xyz = columns * (strength * DVec3::from_array(rgb));
    Some(xyz_to_rgb(xyz.to_array()).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_stays_white_and_a_deep_red_leaves_the_range() {
        for space in [ColorSpace::DciP3, ColorSpace::Rec2020] {
            let white = to_rec709([0.7; 3], space).expect("a space of white D65");
            assert!(white.distance(DVec3::splat(0.7)) < 1e-12, "{white}");
            let red = to_rec709([1.0, 0.0, 0.0], space).expect("a space of white D65");
            assert!(red.x > 1.0 && red.y < 0.0, "{red}");
        }
        assert_eq!(to_rec709([1.0; 3], ColorSpace::Aces2065), None);
    }
}
