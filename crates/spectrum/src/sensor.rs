//! The sensor's response: from four spectral lanes to linear Rec. 709.
//!
//! A path's result is one value per lane, already divided by the sum over the lanes of its
//! rescaled path densities:
//!
//! Lⱼ = fⱼ(x) / Σₜ Σₖ pₜ,ₖ(x),  C = Σⱼ Lⱼ s(λⱼ) / p(λⱼ)
//!
//! with s the response and p the density of the wavelength (Wilkie et al. 2014, equation 5, in the
//! notation of ARCHITECTURE.md, "Wavelengths"). For a path whose densities are equal in all lanes Lⱼ = fⱼ/(4 p(x)): the
//! sum over k already holds the division by four, so none follows here.

use crate::Wavelengths;
use crate::cie::{self, COUNT, FIRST};
use crate::colour_space::{XYZ_TO_RGB, apply};
use glam::{Mat4, Vec3, Vec4};

/// s(λⱼ)/p(λⱼ) for each channel of linear Rec. 709 and each lane, nm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorWeights {
    /// Weights of the red channel.
    pub r: Vec4,
    /// Weights of the green channel.
    pub g: Vec4,
    /// Weights of the blue channel.
    pub b: Vec4,
}

impl SensorWeights {
    /// Linear Rec. 709 of the path result `l` (see the head of this file for its convention).
    #[inline]
    pub fn rgb(&self, l: Vec4) -> Vec3 {
        Vec3::new(l.dot(self.r), l.dot(self.g), l.dot(self.b))
    }
}

/// The weights of a path's wavelengths: response over density.
#[inline]
pub fn sensor_response(wavelengths: &Wavelengths) -> SensorWeights {
    let [r, g, b, _] = response(wavelengths.lambda);
    let inverse = wavelengths.density.recip();
    SensorWeights {
        r: r * inverse,
        g: g * inverse,
        b: b * inverse,
    }
}

/// The responses (r̄, ḡ, b̄, ȳ)/N at four wavelengths in nm: linear Rec. 709 and luminance of a
/// unit of radiance per nanometre. Zero outside 360–830 nm.
#[inline]
pub fn response(lambda: Vec4) -> [Vec4; 4] {
    let t = lambda - FIRST as f32;
    let inside = t.cmpge(Vec4::ZERO) & t.cmple(Vec4::splat((COUNT - 1) as f32));
    // A wavelength outside saturates to some row; `inside` discards what it finds.
    let lanes = Mat4::from_cols(row(t.x), row(t.y), row(t.z), row(t.w)).transpose();
    [lanes.x_axis, lanes.y_axis, lanes.z_axis, lanes.w_axis]
        .map(|channel| Vec4::select(inside, channel, Vec4::ZERO))
}

/// (r̄, ḡ, b̄, ȳ)/N at 360 + `t` nm.
#[inline]
fn row(t: f32) -> Vec4 {
    let i = (t as usize).min(COUNT - 1);
    let low = Vec4::from_array(RESPONSE[i]);
    let high = Vec4::from_array(RESPONSE[i + 1]);
    low + (high - low) * (t - i as f32)
}

/// The responses at 360 + i nm. The last row is repeated so that row i + 1 exists.
static RESPONSE: [[f32; 4]; COUNT + 1] = {
    let mut table = [[0.0; 4]; COUNT + 1];
    let mut i = 0;
    while i <= COUNT {
        let xyz = cie::row(if i < COUNT { i } else { COUNT - 1 });
        let [r, g, b] = apply(&XYZ_TO_RGB, xyz);
        let n = cie::NORMALISATION;
        table[i] = [
            (r / n) as f32,
            (g / n) as f32,
            (b / n) as f32,
            (xyz[1] / n) as f32,
        ];
        i += 1;
    }
    table
};
