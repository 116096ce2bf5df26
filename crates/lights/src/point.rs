//! `point`: the radiant intensity I(λ) in all directions from one point.
//!
//! ```text
//! E⊥ = I / r²        Φ = 4π I
//! ```

use crate::light::{anywhere, extent_of_point};
use crate::light_model::LightModel;
use crate::pose::extent_of_way;
use crate::{BoundingSphere, LightExtent};
use etalon_math::{Animated, DeltaProbability, DirectionCone, FromAffine};
use etalon_params::Params;
use etalon_sampling::warps::{UNIFORM_SPHERE_DENSITY, square_to_uniform_sphere};
use etalon_spectrum::Wavelengths;
use etalon_transport::refuse_varying;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightId, LightKind, LightSample, LightSampleContext, Ray,
    SamplePdf, Shapes, SpectrumKind, TextureId, Textures,
};
use glam::{DAffine3, Vec2, Vec3, Vec4};

/// Position (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position(pub Vec3);

impl FromAffine for Position {
    fn from_affine(map: &DAffine3) -> Self {
        Self(map.translation.as_vec3())
    }
}

/// A light without extent.
#[derive(Clone, Debug, PartialEq)]
pub struct PointLight {
    /// Position (m).
    pub position: Animated<Position>,
    /// Its intensity (W·sr⁻¹·nm⁻¹).
    pub intensity: TextureId,
}

impl PointLight {
    /// Reads `position` or `to_world`, and `intensity`.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        refuse_varying(params, "intensity", build);
        let intensity = build.texture(params, "intensity", Some(1.0), SpectrumKind::Emission);
        let keys = params.keyframes("to_world");
        let position = params.vector("position");
        if position.is_some() && params.has("to_world") {
            params.error_at("position", "give either `position` or `to_world`, not both");
        }
        let position = match keys.as_slice() {
            [matrix] => {
                let position = position.unwrap_or(matrix.w_axis.truncate()).as_vec3();
                if !position.is_finite() {
                    params.error("the position of a `point` light must be finite");
                    return None;
                }
                Position(position).into()
            }
            _ => Animated::new(build.shutter().motion(params, "to_world")?),
        };
        Some(Self {
            position,
            intensity,
        })
    }
}

impl LightModel for PointLight {
    #[inline]
    fn is_even(&self, _: &LightSampleContext) -> bool {
        true
    }

    #[inline]
    fn emission_density(
        &self,
        _: &impl Shapes,
        _: &BoundingSphere,
        _: Vec3,
        _cos: f32,
        _time: f32,
    ) -> EmissionPdf {
        EmissionPdf {
            origin: 1.0,
            ray: UNIFORM_SPHERE_DENSITY,
        }
    }

    fn extent(&self, _: &impl Shapes) -> Option<LightExtent> {
        let still = extent_of_point(self.position.start().0, DirectionCone::ALL, 0.0);
        Some(extent_of_way(&self.position, still))
    }

    #[inline]
    fn sample(
        &self,
        textures: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        _: Vec2,
    ) -> Option<LightSample> {
        let position = self.position.at(from.time, |at| at.0);
        let to_light = position - from.position;
        let distance_squared = to_light.length_squared();
        let intensity = textures.spectrum(self.intensity, &anywhere(), wavelengths.lambda);
        Some(LightSample {
            direction: to_light.try_normalize()?,
            target: Some(position),
            radiance: intensity / distance_squared,
            chance: SamplePdf::Discrete(DeltaProbability::uniform(1.0)),
            cos: 1.0,
            origin: LightKind::Point,
            extinction: Vec4::ONE,
            light: LightId::NONE,
        })
    }

    #[inline]
    fn emit(
        &self,
        textures: &(impl Textures + Shapes),
        _: &BoundingSphere,
        wavelengths: &Wavelengths,
        _: Vec2,
        u: Vec2,
        time: f32,
    ) -> Option<Emission> {
        let direction = square_to_uniform_sphere(u);
        let intensity = textures.spectrum(self.intensity, &anywhere(), wavelengths.lambda);
        let position = self.position.at(time, |at| at.0);
        let ray = Ray::new(position, direction, time);
        Some(Emission {
            point: Emission::point_of(&ray),
            ray,
            weight: intensity / UNIFORM_SPHERE_DENSITY,
            density: EmissionPdf {
                origin: 1.0,
                ray: UNIFORM_SPHERE_DENSITY,
            },
            origin: LightKind::Point,
            extinction: Vec4::ONE,
            light: LightId::NONE,
        })
    }

    fn power(&self, textures: &(impl Textures + Shapes), _: &BoundingSphere) -> f64 {
        4.0 * core::f64::consts::PI * f64::from(textures.mean(self.intensity))
    }
}
