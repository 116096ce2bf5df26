//! `incandescence`: what a body of a temperature that varies emits, as a share of the most that it emits at any wavelength.
//!
//! ```text
//! s(λ) = scale · L(λ, T) / L(λₘ, T)        λₘ = b / T,  b = 2.897771955 · 10⁶ nm K
//! ```
//!
//! L is Planck's law ([`etalon_spectrum::blackbody`]), λₘ its maximum (W. Wien 1893). Up to 100 K nothing is emitted.

use crate::reader::Use;
use crate::recovered;
use crate::texture::TextureModel;
use crate::{Texture, TextureReader, TextureTable};
use etalon_params::Params;
use etalon_spectrum::blackbody::radiance;
use etalon_transport::{Shapes, SpectrumKind, TextureId, TexturePoint};
use glam::{Vec3, Vec4};

/// Wien's constant (nm K).
const WIEN: f64 = 2.897_771_955e6;

/// What is colder does not glow (K).
const COLD: f32 = 100.0;

/// Light by temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incandescence {
    temperature: TextureId,
    scale: f32,
}

impl Incandescence {
    /// s at four wavelengths (nm), for a temperature (K).
    fn emitted(&self, temperature: f32, lambda: Vec4) -> Vec4 {
        if !(temperature > COLD && temperature.is_finite()) {
            return Vec4::ZERO;
        }
        let temperature = f64::from(temperature);
        let most = radiance(WIEN / temperature, temperature);
        let share = |nm: f32| (radiance(f64::from(nm), temperature) / most) as f32;
        Vec4::from_array(lambda.to_array().map(share)) * self.scale
    }
}

impl TextureModel for Incandescence {
    const VARIES: bool = false;

    fn spectrum(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        self.emitted(set.number(self.temperature, shapes, at), lambda)
    }

    fn number(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        recovered::luminance(self.colour(set, shapes, at))
    }

    fn colour(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        let temperature = set.number(self.temperature, shapes, at);
        recovered::colour(|lambda| self.emitted(temperature, lambda))
    }

    fn mean(&self, set: &TextureTable) -> f32 {
        let visible = Vec4::new(420.0, 500.0, 580.0, 660.0);
        let emitted = self.emitted(set.mean(self.temperature), visible);
        0.25 * emitted.element_sum()
    }

    fn is_constant(&self, set: &TextureTable) -> bool {
        set.is_constant(self.temperature)
    }

    fn nested(&self) -> &[TextureId] {
        std::slice::from_ref(&self.temperature)
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        None
    }

    fn most_within(&self, set: &TextureTable, low: Vec3, high: Vec3) -> f32 {
        let hottest = set.get(self.temperature).most_within(set, low, high);
        if hottest > COLD { self.scale } else { 0.0 }
    }

    fn extent(&self, set: &TextureTable) -> Option<[Vec3; 2]> {
        set.get(self.temperature).extent(set)
    }
}

/// Reads `temperature` (K) and `scale` (1; the radiance at the maximum, W m⁻² sr⁻¹ nm⁻¹).
pub(crate) fn read(reader: &mut TextureReader<'_>, params: &Params<'_>, _: Use) -> Option<Texture> {
    let number = Use {
        role: SpectrumKind::Unbounded,
        nested: true,
    };
    let temperature = reader.parameter_in(params, "temperature", None, number);
    let scale = params.float_where("scale", 1.0, "a finite number not below 0", |x| {
        x >= 0.0 && x.is_finite()
    });
    Some(Texture::from(Incandescence {
        temperature,
        scale: scale as f32,
    }))
}
