//! Three smooth spectra of which every linear Rec. 709 colour is a sum: s(λ) = R r(λ) + G g(λ) + B b(λ).
//!
//! ```text
//! (r, g, b) = (exp q_r, 1, exp q_b) / (exp q_r + 1 + exp q_b)      q(t) = c₀ + c₁ t + c₂ t²,  t = (λ − 595)/235
//! ```
//!
//! lie in [0, 1] and sum to one for any q. The six coefficients are chosen such that each of the three, lit by D65, has the
//! colour of its primary, so that white stays white and the sum has the colour (R, G, B). The idea is that of Mallett and
//! Yuksel (2019), *Spectral Primary Decomposition for Rendering with sRGB Reflectance*, whose basis is tabulated. Unlike
//! [`super::RgbCoefficients`] it is linear, as interpolated tables and sums of lobes require.

use super::{CENTRE, HALF_RANGE};
use etalon_math::float;
use glam::Vec4;

/// c₀, c₁, c₂ of q_r, found by Newton's method (the tests hold the colours to it).
const RED: [f32; 3] = [0.547_408_4, 41.877_327, 70.930_56];
/// c₀, c₁, c₂ of q_b.
const BLUE: [f32; 3] = [-2.678_249_7, 16.685_75, 49.268_56];

/// r, g and b at four wavelengths in nm.
pub fn primaries(lambda: Vec4) -> [Vec4; 3] {
    let t = (lambda - CENTRE) / HALF_RANGE;
    let exponent = |[c0, c1, c2]: [f32; 3]| (t * c2 + c1) * t + c0;
    let (red, blue) = (exponent(RED), exponent(BLUE));
    // The greatest exponent becomes 0: nothing overflows.
    let top = red.max(blue).max(Vec4::ZERO);
    let [r, g, b] =
        [red - top, -top, blue - top].map(|x| Vec4::from_array(x.to_array().map(float::exp)));
    let sum = r + g + b;
    [r / sum, g / sum, b / sum]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour_space::{XYZ_TO_RGB, apply};
    use crate::illuminants::d65_relative;
    use crate::{LAMBDA_MAX, LAMBDA_MIN, cie};

    #[test]
    fn each_has_the_colour_of_its_primary_and_they_sum_to_one() {
        for k in 0..3 {
            let lit = |lambda: f64| {
                let spectrum = primaries(Vec4::splat(lambda as f32));
                f64::from(spectrum[k].x) * d65_relative(lambda - LAMBDA_MIN)
            };
            let white = cie::xyz(|lambda| d65_relative(lambda - LAMBDA_MIN));
            let xyz = cie::xyz(lit).map(|v| v / white[1]);
            let rgb = apply(&XYZ_TO_RGB, xyz);
            for (c, value) in rgb.iter().enumerate() {
                let expected = if c == k { 1.0 } else { 0.0 };
                assert!((value - expected).abs() < 5e-5, "{k}: {rgb:?}");
            }
        }
        let mut lambda = LAMBDA_MIN as f32;
        while lambda <= LAMBDA_MAX as f32 {
            let [r, g, b] = primaries(Vec4::splat(lambda));
            assert!((r + g + b - Vec4::ONE).abs().max_element() < 1e-6);
            assert!(r.min(g).min(b).min_element() >= 0.0);
            lambda += 1.0;
        }
    }
}
