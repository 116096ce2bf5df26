//! Back from spectrum to colour: linear Rec.709 of a reflectance s(λ) lit by D65.
//!
//! Images of colours are stored as spectra only. If such an image is evaluated as a number or a raw
//! colour (a roughness map without `raw`, say), the colour is recovered by quadrature over the
//! wavelengths,
//!
//! ```text
//! (R, G, B) = ∫ s(λ) D65(λ) (r̄, ḡ, b̄)(λ) dλ / N
//! ```
//!
//! with N such that s = 1 is (1, 1, 1).

use etalon_spectrum::{
    LAMBDA_MAX, LAMBDA_MIN, RgbCoefficients, RgbSpectrum, cie, colour_space, illuminants,
};
use etalon_transport::SpectrumKind;
use glam::{Vec3, Vec4};
use std::sync::LazyLock;

/// Four nodes of the midpoint rule: wavelengths and the weights of R, G and B there.
struct Nodes {
    lambda: Vec4,
    weights: [Vec4; 3],
}

/// Groups of four nodes; 96 nodes are 4.9 nm apart.
const GROUPS: usize = 24;

static RULE: LazyLock<Vec<Nodes>> = LazyLock::new(|| {
    let step = (LAMBDA_MAX - LAMBDA_MIN) / (4 * GROUPS) as f64;
    let lambda = |i: usize| LAMBDA_MIN + (i as f64 + 0.5) * step;
    let response = |i: usize| {
        let power = illuminants::d65(lambda(i));
        colour_space::xyz_to_rgb(cie::colour_matching(lambda(i)).map(|x| x * power))
    };
    let white = (0..4 * GROUPS).map(response).fold([0.0; 3], |sum, rgb| {
        std::array::from_fn(|c| sum[c] + rgb[c])
    });
    (0..GROUPS)
        .map(|group| {
            let node = |lane: usize| 4 * group + lane;
            let lanes = |f: &dyn Fn(usize) -> f64| {
                Vec4::from_array(std::array::from_fn(|lane| f(node(lane)) as f32))
            };
            Nodes {
                lambda: lanes(&lambda),
                weights: std::array::from_fn(|c| lanes(&|i| response(i)[c] / white[c])),
            }
        })
        .collect()
});

/// The colour of a reflectance given by its values at four wavelengths (nm).
pub fn colour(reflectance: impl Fn(Vec4) -> Vec4) -> Vec3 {
    RULE.iter().fold(Vec3::ZERO, |sum, nodes| {
        let s = reflectance(nodes.lambda);
        sum + Vec3::from_array(nodes.weights.map(|w| w.dot(s)))
    })
}

/// The spectrum at four wavelengths (nm) of the colour `scale` times `value`, both ≥ 0, computed at look-up and clamped to the
/// range of the role.
#[inline]
pub(crate) fn spectrum_of(value: Vec3, scale: f32, role: SpectrumKind, lambda: Vec4) -> Vec4 {
    if value.x == value.y && value.y == value.z {
        return Vec4::splat(value.x * scale);
    }
    let bright = value.max_element() > 1.0;
    if role == SpectrumKind::Reflectance && (bright || scale > 1.0) {
        // Scaled first: a spectrum that is multiplied may exceed 1 where its colour does not.
        return RgbCoefficients::from_rgb((value * scale).to_array()).eval(lambda);
    }
    if !bright {
        return RgbCoefficients::from_rgb(value.to_array()).eval(lambda) * scale;
    }
    // Refused only if not finite or negative, and neither is left.
    match RgbSpectrum::unbounded(value.as_dvec3().to_array()) {
        Ok(spectrum) => spectrum.coefficients().eval(lambda) * (spectrum.scale() * scale),
        Err(_) => Vec4::ZERO,
    }
}

/// The luminance of a linear Rec.709 colour.
#[inline]
pub fn luminance(rgb: Vec3) -> f32 {
    colour_space::luminance(rgb.to_array().map(f64::from)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_spectrum::Spectrum;

    /// The fine rule of the spectrum crate and this one agree for a smooth reflectance to 10⁻³.
    #[test]
    fn agrees_with_the_fine_quadrature() {
        let slope = Spectrum::regular(360.0, 830.0, &[0.1, 0.7, 0.4, 0.9]).expect("a table");
        let fine = slope.rgb_under_d65();
        let coarse = colour(|lambda| slope.eval(lambda));
        for c in 0..3 {
            assert!(
                (f64::from(coarse[c]) - fine[c]).abs() < 1e-3,
                "{coarse} {fine:?}"
            );
        }
        assert!((colour(|_| Vec4::splat(0.5)) - 0.5).abs().max_element() < 1e-5);
        assert!((luminance(Vec3::splat(0.3)) - 0.3).abs() < 1e-6);
    }
}
