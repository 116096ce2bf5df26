//! `constant`: the same radiance L(λ) from everywhere at infinity. Its power is that which enters
//! the scene's bounding sphere, Φ = 4π · π r² L.
//!
//! A receiver with the normal n chooses the direction ω with the density
//!
//! ```text
//! one side:     max(0, n·ω)/π
//! both sides:   ½ |n·ω|/2π + ½ 1/4π
//! in space:     1/4π
//! ```
//!
//! The first is proportional to the irradiance. The second has a uniform part: a receiver with two sides may
//! have lobes with other normals, whose cosines do not vanish with n·ω.

use crate::light::anywhere;
use crate::light_model::LightModel;
use crate::{BoundingSphere, sky};
use etalon_math::{Density, Frame, SolidAngle};
use etalon_params::Params;
use etalon_sampling::warps::{
    UNIFORM_SPHERE_DENSITY, cosine_hemisphere_density, square_to_cosine_hemisphere,
    square_to_uniform_sphere,
};
use etalon_spectrum::Wavelengths;
use etalon_transport::refuse_varying;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightSample, LightSampleContext, Shapes, SpectrumKind, TextureId,
    Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// A uniform sky all around.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantLight {
    /// Its radiance (W·m⁻²·sr⁻¹·nm⁻¹).
    pub radiance: TextureId,
}

impl ConstantLight {
    /// Reads `radiance`. `to_world` turns a uniform sky into itself.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Self {
        refuse_varying(params, "radiance", build);
        Self {
            radiance: build.texture(params, "radiance", Some(1.0), SpectrumKind::Emission),
        }
    }
}

impl LightModel for ConstantLight {
    fn is_infinite(&self) -> bool {
        true
    }

    fn is_background(&self) -> bool {
        true
    }

    #[inline]
    fn is_even(&self, from: &LightSampleContext) -> bool {
        // On both sides the density is only partly proportional to the cosine; no better one is known.
        from.normal != Vec3::ZERO
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
            origin: UNIFORM_SPHERE_DENSITY,
            ray: bounds.ray_density(),
        }
    }

    #[inline]
    fn background(&self, textures: &impl Textures, _: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        textures.spectrum(self.radiance, &anywhere(), wavelengths.lambda)
    }

    #[inline]
    fn background_density(
        &self,
        from: &LightSampleContext,
        direction: Vec3,
    ) -> Density<SolidAngle> {
        let cos = from.normal.dot(direction);
        Density::uniform(if from.normal == Vec3::ZERO {
            UNIFORM_SPHERE_DENSITY
        } else if from.one_sided {
            cosine_hemisphere_density(cos)
        } else {
            0.5 * (UNIFORM_SPHERE_DENSITY + 0.5 * cosine_hemisphere_density(cos.abs()))
        })
    }

    #[inline]
    fn sample(
        &self,
        textures: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        let about =
            |u: Vec2| Frame::from_normal(from.normal).to_world(square_to_cosine_hemisphere(u));
        let direction = if from.normal == Vec3::ZERO {
            square_to_uniform_sphere(u)
        } else if from.one_sided {
            about(u)
        } else {
            // The first number chooses among four quarters, and is used again within its own.
            let quarter = 4.0 * u.x;
            match quarter {
                ..1.0 => about(Vec2::new(quarter, u.y)),
                1.0..2.0 => -about(Vec2::new(quarter - 1.0, u.y)),
                _ => square_to_uniform_sphere(Vec2::new(0.5 * quarter - 1.0, u.y)),
            }
        };
        let density = self.background_density(from, direction);
        (density.hero() > 0.0).then(|| {
            let radiance = self.background(textures, direction, wavelengths);
            sky::sample(direction, radiance, density)
        })
    }

    #[inline]
    fn emit(
        &self,
        textures: &(impl Textures + Shapes),
        bounds: &BoundingSphere,
        wavelengths: &Wavelengths,
        u_position: Vec2,
        u_direction: Vec2,
        _time: f32,
    ) -> Option<Emission> {
        let direction = square_to_uniform_sphere(u_direction);
        let radiance = self.background(textures, direction, wavelengths);
        let density = UNIFORM_SPHERE_DENSITY;
        Some(sky::emit(bounds, -direction, u_position, radiance, density))
    }

    fn power(&self, textures: &(impl Textures + Shapes), bounds: &BoundingSphere) -> f64 {
        4.0 * core::f64::consts::PI
            * bounds.cross_section()
            * f64::from(textures.mean(self.radiance))
    }
}
