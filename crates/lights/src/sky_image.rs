//! The image of an environment map: smooth spectra at nodes, interpolated bilinearly.

use etalon_math::lane::{Int, Lane, Select, Spectral};
use etalon_spectrum::{RgbCoefficients, illuminants};
use glam::{UVec2, Vec4};

/// Texels: three coefficients of a spectrum and its factor.
#[derive(Debug)]
pub(crate) struct SkyImage {
    size: UVec2,
    texels: Vec<Vec4>,
}

/// Places, each between four texels.
struct Cell<F: Lane> {
    texels: [F::Int; 4],
    weights: [F; 4],
}

impl SkyImage {
    /// At least two columns and rows of nodes, of colours with components not below zero, row by row.
    pub(crate) fn new(size: UVec2, rgb: &[[f32; 3]]) -> Self {
        let texels = rgb.iter().map(|&rgb| texel(rgb)).collect();
        Self { size, texels }
    }

    /// The cells at places of the unit square, whose borders the outer nodes lie on.
    #[inline(always)]
    fn cell<F: Lane>(&self, [u, v]: [F; 2]) -> Cell<F> {
        let UVec2 { x: w, y: h } = self.size;
        let (x, y) = (u * (w - 1) as f32, v * (h - 1) as f32);
        let within =
            |i: F::Int, end: u32| i.lt(F::Int::splat(end)).select(i, F::Int::splat(end - 1));
        let (i, j) = (within(x.to_int(), w - 1), within(y.to_int(), h - 1));
        let (a, b) = (x - F::from_int(i), y - F::from_int(j));
        let next = i.wrapping_add(F::Int::splat(1));
        let row = j.wrapping_mul(F::Int::splat(w));
        let below = row.wrapping_add(F::Int::splat(w));
        let (left, top) = (F::ONE - a, F::ONE - b);
        Cell {
            texels: [
                row.wrapping_add(i),
                row.wrapping_add(next),
                below.wrapping_add(i),
                below.wrapping_add(next),
            ],
            weights: [left * top, a * top, left * b, a * b],
        }
    }

    /// Σ wᵢ mᵢ sᵢ(λ) · D65(λ) at places of the unit square, at the wavelengths `lambda(i)` in lane i.
    #[inline(always)]
    pub(crate) fn radiance<F: Lane>(
        &self,
        place: [F; 2],
        lambda: impl Fn(usize) -> Vec4,
    ) -> F::Spectrum {
        let lambda = F::Spectrum::of_lanes(lambda);
        let white = illuminants::white().eval_lanes::<F>(lambda);
        let Cell { texels, weights } = self.cell(place);
        let mut spectrum = F::Spectrum::uniform(F::ZERO);
        for (texel, weight) in texels.into_iter().zip(weights) {
            let texel = |i: usize| self.texels[texel.lane(i) as usize];
            let [a, b, c, m] = F::Spectrum::of_lanes(texel).waves();
            let smooth = RgbCoefficients::eval_lanes::<F>([a, b, c], lambda);
            spectrum = spectrum + smooth * (m * weight);
        }
        white * spectrum
    }
}

/// A texel for a colour with components not below zero.
fn texel(rgb: [f32; 3]) -> Vec4 {
    let factor = 2.0 * rgb[0].max(rgb[1]).max(rgb[2]);
    let part = if factor > 0.0 {
        rgb.map(|c| c / factor)
    } else {
        [0.0; 3]
    };
    let RgbCoefficients([a, b, c]) = RgbCoefficients::from_rgb(part);
    Vec4::new(a, b, c, factor)
}
