//! `spot`: a point light whose intensity falls off with the angle θ from its axis,
//!
//! ```text
//! I(θ) = I₀ · t(u, v) · f(θ)
//! ```
//!
//! with f as in `spot_profile.rs`. The optional texture is projected along the
//! axis: a direction (x, y, z) of the light's space sees u = ½ + x/(2 z tan c),
//! v = ½ + y/(2 z tan c), c the cutoff angle. Without texture the power is I₀ ∫ f dω.

use crate::light::{anywhere, extent_of_cone};
use crate::light_model::LightModel;
use crate::pose::{Pose, emit_from_point, extent_of_way, sample_point};
use crate::spot_profile::SpotProfile;
use crate::{BoundingSphere, LightExtent};
use etalon_math::{Animated, float64};
use etalon_params::{Class, Params, Value};
use etalon_sampling::warps::{square_to_uniform_cone, uniform_cone_density};
use etalon_spectrum::Wavelengths;
use etalon_transport::refuse_varying;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightSample, LightSampleContext, Shapes, SpectrumKind, TextureId,
    TexturePoint, Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// A spot light.
#[derive(Clone, Debug, PartialEq)]
pub struct SpotLight {
    pose: Animated<Pose>,
    intensity: TextureId,
    texture: Option<TextureId>,
    profile: SpotProfile,
    /// 1/(2 tan c).
    projection: f32,
}

impl SpotLight {
    /// Reads `intensity`, `cutoff_angle`, `beam_width`, `falloff`, `texture` and `to_world`.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        refuse_varying(params, "intensity", build);
        let intensity = build.texture(params, "intensity", Some(1.0), SpectrumKind::Emission);
        // Mitsuba 0.6 takes one without a name as well.
        let nameless = params.node.properties.iter().find_map(|p| match &p.value {
            Value::Object(node) if p.name.is_empty() && node.class == Class::Texture => {
                Some((p, node))
            }
            _ => None,
        });
        let texture = match nameless {
            _ if params.has("texture") => {
                Some(build.texture(params, "texture", None, SpectrumKind::Reflectance))
            }
            Some((property, node)) => {
                property.mark_used();
                Some(build.nested_texture(node, SpectrumKind::Reflectance))
            }
            None => None,
        };
        let what = if texture.is_some() {
            "degrees above 0 and below 90 (with `texture`)"
        } else {
            "degrees above 0, at most 180"
        };
        let cutoff = params.float_where("cutoff_angle", 20.0, what, |angle| {
            angle > 0.0 && angle <= 180.0 && (texture.is_none() || angle < 90.0)
        });
        let beam = params.float_where(
            "beam_width",
            0.75 * cutoff,
            "a finite number of degrees not below 0",
            |b| b >= 0.0 && b.is_finite(),
        );
        Some(Self {
            profile: SpotProfile::from_params(params, beam, cutoff),
            pose: Pose::animated(params, build)?,
            intensity,
            texture,
            projection: (0.5 / float64::tan(cutoff.to_radians())) as f32,
        })
    }

    /// Intensity (W·sr⁻¹·nm⁻¹) along a unit direction of the light's space.
    #[inline]
    fn intensity(&self, textures: &impl Textures, local: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        let falloff = self.profile.at(local);
        if falloff == 0.0 {
            return Vec4::ZERO;
        }
        let mut intensity =
            textures.spectrum(self.intensity, &anywhere(), wavelengths.lambda) * falloff;
        if let Some(texture) = self.texture {
            let uv = local.truncate() * (self.projection / local.z) + 0.5;
            intensity *= textures.spectrum(texture, &TexturePoint::at_uv(uv), wavelengths.lambda);
        }
        intensity
    }

    /// The density of `direction` among those of particles (sr⁻¹).
    #[inline]
    pub fn direction_density(&self, direction: Vec3, time: f32) -> f32 {
        if self.pose.at(time, |pose| pose.to_local(direction)).z > self.profile.cos_cutoff {
            uniform_cone_density(self.profile.one_minus_cos_cutoff)
        } else {
            0.0
        }
    }
}

impl LightModel for SpotLight {
    #[inline]
    fn is_even(&self, _: &LightSampleContext) -> bool {
        true
    }

    #[inline]
    fn emission_density(
        &self,
        _: &impl Shapes,
        _: &BoundingSphere,
        direction: Vec3,
        _cos: f32,
        time: f32,
    ) -> EmissionPdf {
        EmissionPdf {
            origin: 1.0,
            ray: self.direction_density(direction, time),
        }
    }

    #[inline]
    fn sample(
        &self,
        textures: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        _: Vec2,
    ) -> Option<LightSample> {
        sample_point(&self.pose, from, |local| {
            self.intensity(textures, local, wavelengths)
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
        let local = square_to_uniform_cone(u, self.profile.one_minus_cos_cutoff);
        let intensity = self.intensity(textures, local, wavelengths);
        let density = uniform_cone_density(self.profile.one_minus_cos_cutoff);
        Some(emit_from_point(&self.pose, local, intensity, density, time))
    }

    fn power(&self, textures: &(impl Textures + Shapes), _: &BoundingSphere) -> f64 {
        let texture = self.texture.map_or(1.0, |t| textures.mean(t));
        self.profile.solid_angle * f64::from(textures.mean(self.intensity) * texture)
    }

    fn extent(&self, _: &impl Shapes) -> Option<LightExtent> {
        let still = extent_of_cone(self.pose.start(), self.profile.cos_cutoff);
        Some(extent_of_way(&self.pose, still))
    }
}
