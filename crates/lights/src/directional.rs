//! `directional`: parallel light from infinity with the irradiance E⊥(λ) on a surface that faces
//! it. Its power is that on the scene's cross-section, Φ = E⊥ π r².

use crate::BoundingSphere;
use crate::light::anywhere;
use crate::light_model::LightModel;
use crate::pose::Pose;
use etalon_math::DeltaProbability;
use etalon_params::Params;
use etalon_spectrum::Wavelengths;
use etalon_transport::refuse_varying;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightId, LightKind, LightSample, LightSampleContext, SamplePdf,
    Shapes, SpectrumKind, TextureId, Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// Parallel light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    /// The direction of the light (unit).
    pub direction: Vec3,
    /// Irradiance on a surface perpendicular to it (W·m⁻²·nm⁻¹).
    pub irradiance: TextureId,
}

impl DirectionalLight {
    /// Reads `irradiance`, and `direction` or `to_world` (whose +z is where the light goes).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        refuse_varying(params, "irradiance", build);
        let irradiance = build.texture(params, "irradiance", Some(1.0), SpectrumKind::Emission);
        let direction = match params.vector("direction") {
            Some(direction) => {
                if params.property("to_world").is_some() {
                    let message = "give either `direction` or `to_world`, not both";
                    params.error_at("direction", message);
                }
                let unit = direction.try_normalize();
                if unit.is_none() {
                    params.error_at("direction", "`direction` must not vanish");
                }
                unit?.as_vec3().normalize()
            }
            None => Pose::from_params(params)?.to_world(Vec3::Z),
        };
        Some(Self {
            direction,
            irradiance,
        })
    }

    #[inline]
    fn spectrum(&self, textures: &impl Textures, wavelengths: &Wavelengths) -> Vec4 {
        textures.spectrum(self.irradiance, &anywhere(), wavelengths.lambda)
    }
}

impl LightModel for DirectionalLight {
    fn is_infinite(&self) -> bool {
        true
    }

    #[inline]
    fn is_even(&self, _: &LightSampleContext) -> bool {
        true
    }

    #[inline]
    fn emission_density(
        &self,
        _: &impl Shapes,
        bounds: &BoundingSphere,
        _: Vec3,
        _cos: f32,
        _time: f32,
    ) -> EmissionPdf {
        EmissionPdf {
            origin: 1.0,
            ray: bounds.ray_density(),
        }
    }

    fn toward(&self) -> Option<Vec3> {
        Some(-self.direction)
    }

    #[inline]
    fn sample(
        &self,
        textures: &(impl Textures + Shapes),
        _: &LightSampleContext,
        wavelengths: &Wavelengths,
        _: Vec2,
    ) -> Option<LightSample> {
        Some(LightSample {
            direction: -self.direction,
            target: None,
            radiance: self.spectrum(textures, wavelengths),
            chance: SamplePdf::Discrete(DeltaProbability::uniform(1.0)),
            cos: 1.0,
            origin: LightKind::Parallel,
            extinction: Vec4::ONE,
            light: LightId::NONE,
        })
    }

    #[inline]
    fn emit(
        &self,
        textures: &(impl Textures + Shapes),
        bounds: &BoundingSphere,
        wavelengths: &Wavelengths,
        u: Vec2,
        _: Vec2,
        _time: f32,
    ) -> Option<Emission> {
        let ray = bounds.ray_into(self.direction, u);
        Some(Emission {
            point: Emission::point_of(&ray),
            ray,
            weight: self.spectrum(textures, wavelengths) * bounds.cross_section() as f32,
            density: EmissionPdf {
                origin: 1.0,
                ray: bounds.ray_density(),
            },
            origin: LightKind::Parallel,
            extinction: Vec4::ONE,
            light: LightId::NONE,
        })
    }

    fn power(&self, textures: &(impl Textures + Shapes), bounds: &BoundingSphere) -> f64 {
        bounds.cross_section() * f64::from(textures.mean(self.irradiance))
    }
}
