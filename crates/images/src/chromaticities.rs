//! The primaries and the white of RGB channels, and the way from them to linear Rec. 709.
//!
//! With (x, y) the chromaticities of the primaries and (xw, yw) that of the white, the columns of
//! the matrix to XYZ are s·(x, y, 1 − x − y) with those factors s that take (1, 1, 1) to the white
//! of luminance 1 (SMPTE RP 177:1993). From there to Rec. 709 nothing adapts the white, as in
//! OpenEXR's `RGBtoXYZ` and `XYZtoRGB`, and in Mitsuba 3.

use glam::{DMat3, DVec3};

/// Chromaticities (x, y), as the EXR attribute `chromaticities` has them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chromaticities {
    /// Of red.
    pub red: [f32; 2],
    /// Of green.
    pub green: [f32; 2],
    /// Of blue.
    pub blue: [f32; 2],
    /// Of the white, the colour of R = G = B.
    pub white: [f32; 2],
}

impl Default for Chromaticities {
    fn default() -> Self {
        Self::REC_709
    }
}

impl Chromaticities {
    /// ITU-R BT.709-6, with D65: what an image has that says nothing.
    pub const REC_709: Self = Self {
        red: [0.64, 0.33],
        green: [0.30, 0.60],
        blue: [0.15, 0.06],
        white: [0.3127, 0.3290],
    };

    /// Whether these are the chromaticities of Rec. 709, as far as four digits tell.
    #[must_use]
    pub fn is_rec_709(&self) -> bool {
        let all = |c: &Self| [c.red, c.green, c.blue, c.white];
        let near = |(a, b): (&f32, &f32)| (a - b).abs() <= 1e-4;
        let (ours, theirs) = (all(self), all(&Self::REC_709));
        ours.as_flattened()
            .iter()
            .zip(theirs.as_flattened())
            .all(near)
    }

    /// The matrix from these to XYZ; `None` if they span no space of colours: primaries on a line,
    /// a white without luminance, or numbers that are not finite.
    #[must_use]
    pub fn to_xyz(&self) -> Option<DMat3> {
        let [x, y] = self.white.map(f64::from);
        let primaries = [self.red, self.green, self.blue].map(|c| c.map(f64::from));
        matrix(primaries, DVec3::new(x / y, 1.0, (1.0 - x - y) / y))
    }

    /// The matrix from these to linear Rec. 709; `None` as for [`Chromaticities::to_xyz`].
    #[must_use]
    pub fn to_rec_709(&self) -> Option<DMat3> {
        Some(Self::REC_709.to_xyz()?.inverse() * self.to_xyz()?)
    }

    /// The luminance of each primary; they add up to 1. Those of Rec. 709 where these span no
    /// space of colours.
    #[must_use]
    pub fn luminance_weights(&self) -> [f64; 3] {
        let matrix = self.to_xyz().or_else(|| Self::REC_709.to_xyz());
        matrix
            .map(|m| m.row(1).to_array())
            .unwrap_or([0.2126, 0.7152, 0.0722])
    }
}

impl std::fmt::Display for Chromaticities {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names = ["red", "green", "blue", "white"];
        let points = [self.red, self.green, self.blue, self.white];
        for (i, (name, [x, y])) in names.into_iter().zip(points).enumerate() {
            let comma = if i == 0 { "" } else { ", " };
            write!(f, "{comma}{name} ({x}, {y})")?;
        }
        Ok(())
    }
}

/// (X, Y, Z) of the white of Rec. 709 as the renderer has it: of the white that the table of D65
/// integrates to, which differs from (0.3127, 0.3290) in the fifth digit. With it a film in XYZ
/// gives back the colours that went into it.
const WHITE: DVec3 = DVec3::new(0.950_470_650_796_130_5, 1.0, 1.088_815_218_135_146_3);

/// The matrix from XYZ to linear Rec. 709.
#[must_use]
pub fn xyz_to_rec_709() -> DMat3 {
    matrix([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]], WHITE)
        .expect("the primaries of Rec. 709 span a space")
        .inverse()
}

/// The matrix to XYZ that takes (1, 1, 1) to `white`; `None` if there is none, or no way back.
fn matrix(primaries: [[f64; 2]; 3], white: DVec3) -> Option<DMat3> {
    let [red, green, blue] = primaries.map(|[x, y]| DVec3::new(x, y, 1.0 - x - y));
    let primaries = DMat3::from_cols(red, green, blue);
    if !(primaries.determinant().abs() > 1e-9) || !white.is_finite() {
        return None;
    }
    let scale = primaries.inverse() * white;
    let usable = scale.is_finite() && scale.abs().min_element() > 1e-9;
    usable.then(|| primaries * DMat3::from_diagonal(scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of OpenEXR 3.5 by way of Mitsuba 3. A matrix that adapts the white (Bradford) gives
    /// 0.635, 0.212, 0.820.
    #[test]
    fn acescg_becomes_rec_709() {
        let ap1 = Chromaticities {
            red: [0.713, 0.293],
            green: [0.165, 0.830],
            blue: [0.128, 0.044],
            white: [0.32168, 0.33767],
        };
        assert!(!ap1.is_rec_709() && Chromaticities::REC_709.is_rec_709());
        let rgb = ap1.to_rec_709().expect("regular") * DVec3::new(0.5, 0.25, 0.75);
        let right = DVec3::new(0.654_535_4, 0.211_391_2, 0.755_506_1);
        assert!((rgb - right).abs().max_element() < 1e-6, "{rgb}");
        let weights = ap1.luminance_weights();
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert!((weights[0] - 0.272_229).abs() < 1e-5);
    }

    #[test]
    fn what_spans_no_space_has_no_matrix() {
        let bad = |change: fn(&mut Chromaticities)| {
            let mut c = Chromaticities::REC_709;
            change(&mut c);
            c.to_rec_709()
        };
        assert_eq!(bad(|c| c.white = [0.3, 0.0]), None);
        assert_eq!(bad(|c| c.red = c.green), None);
        assert_eq!(bad(|c| c.blue[0] = f32::NAN), None);
        assert_eq!(bad(|c| c.white = [0.0, 0.0]), None);
        // The primaries X, Y and Z: the first and the last have no luminance, which is no mistake.
        let xyz = Chromaticities {
            red: [1.0, 0.0],
            green: [0.0, 1.0],
            blue: [0.0, 0.0],
            white: [1.0 / 3.0, 1.0 / 3.0],
        };
        let matrix = xyz.to_xyz().expect("regular");
        assert!((matrix - DMat3::IDENTITY).abs_diff_eq(DMat3::ZERO, 1e-6));
    }
}
