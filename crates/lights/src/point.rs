//! `point`: the radiant intensity I(λ) in all directions from one point.
//!
//! ```text
//! E⊥ = I / r²        Φ = 4π I
//! ```

use crate::light::anywhere;
use crate::uniformity::refuse_varying;
use etalon_math::DeltaProbability;
use etalon_params::Params;
use etalon_sampling::warps::{UNIFORM_SPHERE_DENSITY, square_to_uniform_sphere};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightId, LightKind, LightSample, Ray, SamplePdf, SpectrumKind,
    TextureId, Textures,
};
use glam::{Vec2, Vec3};

/// A light without extent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Where it is (m).
    pub position: Vec3,
    /// Its intensity (W·sr⁻¹·nm⁻¹).
    pub intensity: TextureId,
}

impl PointLight {
    /// Reads `position` or `to_world`, and `intensity`.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        refuse_varying(params, "intensity");
        let intensity = build.texture(params, "intensity", Some(1.0), SpectrumKind::Emission);
        let translation = params.transform("to_world").w_axis.truncate();
        let position = params.vector("position");
        if position.is_some() && params.has("to_world") {
            params.error_at("position", "give either `position` or `to_world`, not both");
        }
        let position = position.unwrap_or(translation).as_vec3();
        if !position.is_finite() {
            params.error("the position of a `point` light must be finite");
            return None;
        }
        Some(Self {
            position,
            intensity,
        })
    }

    /// The direction from `from` to the light.
    #[inline]
    pub fn sample(
        &self,
        textures: &impl Textures,
        from: Vec3,
        wavelengths: &Wavelengths,
    ) -> Option<LightSample> {
        let to_light = self.position - from;
        let distance_squared = to_light.length_squared();
        let intensity = textures.spectrum(self.intensity, &anywhere(), wavelengths.lambda);
        Some(LightSample {
            direction: to_light.try_normalize()?,
            target: Some(self.position),
            radiance: intensity / distance_squared,
            chance: SamplePdf::Discrete(DeltaProbability::uniform(1.0)),
            cos: 1.0,
            origin: LightKind::Point,
            light: LightId::NONE,
        })
    }

    /// A particle.
    #[inline]
    pub fn emit(&self, textures: &impl Textures, wavelengths: &Wavelengths, u: Vec2) -> Emission {
        let direction = square_to_uniform_sphere(u);
        let intensity = textures.spectrum(self.intensity, &anywhere(), wavelengths.lambda);
        let ray = Ray::new(self.position, direction, 0.0);
        Emission {
            point: Emission::point_of(&ray),
            ray,
            weight: intensity / UNIFORM_SPHERE_DENSITY,
            density: EmissionPdf {
                origin: 1.0,
                ray: self.direction_density(),
            },
            origin: LightKind::Point,
            light: LightId::NONE,
        }
    }

    /// The density of the directions of [`PointLight::emit`] (sr⁻¹).
    #[inline]
    pub fn direction_density(&self) -> f32 {
        UNIFORM_SPHERE_DENSITY
    }

    /// Emitted power, averaged over the wavelengths (W·nm⁻¹).
    pub fn power(&self, textures: &impl Textures) -> f64 {
        4.0 * core::f64::consts::PI * f64::from(textures.mean(self.intensity))
    }
}
