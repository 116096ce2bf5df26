//! XYZ, xyY and linear Rec. 709 (ITU-R BT.709-6), and the curve of sRGB (IEC 61966-2-1).
//!
//! The matrices follow from the chromaticities of the primaries and from the white that
//! [`illuminants`](crate::illuminants)' table of D65 integrates to, so the spectrum D65 is exactly
//! (1, 1, 1). They differ from the rounded ones of the standards by less than 3·10⁻⁴.

use crate::illuminants::D65_RELATIVE_XYZ;
use etalon_math::float64;

/// Chromaticities (x, y) of the red, green and blue primaries of Rec. 709.
pub const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];

/// (X, Y, Z) of the white, D65, with Y = 1.
pub const WHITE: [f64; 3] = [
    D65_RELATIVE_XYZ[0] / D65_RELATIVE_XYZ[1],
    1.0,
    D65_RELATIVE_XYZ[2] / D65_RELATIVE_XYZ[1],
];

/// Rows of the matrix from linear Rec. 709 to XYZ.
pub const RGB_TO_XYZ: [[f64; 3]; 3] = {
    let p = PRIMARIES;
    let mut columns = [[0.0; 3]; 3];
    let mut c = 0;
    while c < 3 {
        let [x, y] = p[c];
        columns[0][c] = x / y;
        columns[1][c] = 1.0;
        columns[2][c] = (1.0 - x - y) / y;
        c += 1;
    }
    let scale = apply(&inverse(&columns), WHITE);
    let mut r = 0;
    while r < 3 {
        let mut c = 0;
        while c < 3 {
            columns[r][c] *= scale[c];
            c += 1;
        }
        r += 1;
    }
    columns
};

/// Rows of the matrix from XYZ to linear Rec. 709.
pub const XYZ_TO_RGB: [[f64; 3]; 3] = inverse(&RGB_TO_XYZ);

/// The luminance of each primary: Y = Σ weightᵢ rgbᵢ.
pub const LUMINANCE_WEIGHTS: [f64; 3] = RGB_TO_XYZ[1];

/// The matrix `m` times the vector `v`.
pub(crate) const fn apply(m: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    let mut out = [0.0; 3];
    let mut r = 0;
    while r < 3 {
        out[r] = m[r][0] * v[0] + m[r][1] * v[1] + m[r][2] * v[2];
        r += 1;
    }
    out
}

/// The inverse of a regular matrix, by cofactors.
const fn inverse(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut cofactor = [[0.0; 3]; 3];
    let mut r = 0;
    while r < 3 {
        let mut c = 0;
        while c < 3 {
            let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
            cofactor[r][c] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
            c += 1;
        }
        r += 1;
    }
    let determinant =
        m[0][0] * cofactor[0][0] + m[0][1] * cofactor[0][1] + m[0][2] * cofactor[0][2];
    let mut out = [[0.0; 3]; 3];
    let mut r = 0;
    while r < 3 {
        let mut c = 0;
        while c < 3 {
            out[r][c] = cofactor[c][r] / determinant;
            c += 1;
        }
        r += 1;
    }
    out
}

/// Linear Rec. 709 of a tristimulus value.
pub fn xyz_to_rgb(xyz: [f64; 3]) -> [f64; 3] {
    apply(&XYZ_TO_RGB, xyz)
}

/// Tristimulus value of a linear Rec. 709 colour.
pub fn rgb_to_xyz(rgb: [f64; 3]) -> [f64; 3] {
    apply(&RGB_TO_XYZ, rgb)
}

/// Luminance Y of a linear Rec. 709 colour.
pub fn luminance(rgb: [f64; 3]) -> f64 {
    rgb_to_xyz(rgb)[1]
}

/// (x, y, Y) of a tristimulus value; black has the chromaticity of the white.
pub fn xyz_to_xyy(xyz: [f64; 3]) -> [f64; 3] {
    let sum = xyz[0] + xyz[1] + xyz[2];
    if sum == 0.0 {
        let white = WHITE[0] + WHITE[1] + WHITE[2];
        return [WHITE[0] / white, WHITE[1] / white, 0.0];
    }
    [xyz[0] / sum, xyz[1] / sum, xyz[1]]
}

/// The linear value of an sRGB-encoded one, both nominally in [0, 1]; odd about zero.
pub fn srgb_to_linear(encoded: f64) -> f64 {
    let magnitude = encoded.abs();
    let linear = if magnitude <= 0.040_45 {
        magnitude / 12.92
    } else {
        float64::pow((magnitude + 0.055) / 1.055, 2.4)
    };
    linear.copysign(encoded)
}

/// The sRGB encoding of a linear value, both nominally in [0, 1]; odd about zero.
pub fn linear_to_srgb(linear: f64) -> f64 {
    let magnitude = linear.abs();
    let encoded = if magnitude <= 0.003_130_8 {
        magnitude * 12.92
    } else {
        1.055 * float64::pow(magnitude, 1.0 / 2.4) - 0.055
    };
    encoded.copysign(linear)
}
