//! `area`: a shape that emits the radiance L(x, λ) from its outer side, the same in all
//! directions:
//!
//! ```text
//! Φ = π ∫ L dA
//! ```
//!
//! A moving light has the same radiance at all times. Its power, which is used for light selection only, is that at
//! the start of the shutter interval.
//!
//! Points toward an observer are chosen by the shape; emitted particles start uniformly over the
//! area, with directions in proportion to cos θ.

use crate::light::extent_of_shape;
use crate::light_model::LightModel;
use crate::{BoundingSphere, LightExtent};
use core::f32::consts::FRAC_1_PI;
use etalon_math::{Density, SolidAngle};
use etalon_params::Params;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightId, LightKind, LightSample, LightSampleContext, Ray,
    SamplePdf, SampledPoint, ShapeId, Shapes, SpectrumKind, SurfacePoint, TextureId, Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// An emitting shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLight {
    /// The shape.
    pub shape: ShapeId,
    /// Its radiance (W·m⁻²·sr⁻¹·nm⁻¹).
    pub radiance: TextureId,
}

impl AreaLight {
    /// Reads `radiance`.
    pub fn from_params(params: &Params<'_>, shape: ShapeId, build: &mut dyn Build) -> Self {
        Self {
            shape,
            radiance: build.texture(params, "radiance", Some(1.0), SpectrumKind::Emission),
        }
    }
}

impl LightModel for AreaLight {
    const OF_SHAPE: bool = true;

    #[inline]
    fn density(
        &self,
        shapes: &impl Shapes,
        from: &LightSampleContext,
        at: &SurfacePoint,
    ) -> Density<SolidAngle> {
        Density::uniform(shapes.density_toward(self.shape, from, at))
    }

    #[inline]
    fn emitted(
        &self,
        textures: &impl Textures,
        at: &SurfacePoint,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Vec4 {
        if at.normal.dot(wo) > 0.0 {
            textures.spectrum(self.radiance, &at.texture, wavelengths.lambda)
        } else {
            Vec4::ZERO
        }
    }

    #[inline]
    fn sample(
        &self,
        scene: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        let sampled = scene.sample_toward(self.shape, from, u);
        let SampledPoint { point, density } = sampled.as_ref()?;
        let density = *density;
        let to = point.position - from.position;
        // Also false where the two coincide, or are farther apart than numbers go.
        if !(density > 0.0 && point.normal.dot(to) < 0.0) {
            return None;
        }
        let direction = to / to.length();
        Some(LightSample {
            direction,
            target: Some(point.origin_toward(from.position)),
            radiance: self.emitted(scene, point, -direction, wavelengths),
            chance: SamplePdf::Continuous(Density::uniform(density)),
            cos: -point.normal.dot(direction),
            origin: LightKind::Surface,
            extinction: Vec4::ONE,
            light: LightId::NONE,
        })
    }

    #[inline]
    fn emit(
        &self,
        scene: &(impl Textures + Shapes),
        _: &BoundingSphere,
        wavelengths: &Wavelengths,
        u_position: Vec2,
        u_direction: Vec2,
        time: f32,
    ) -> Option<Emission> {
        let SampledPoint { point, density } = scene.sample_area(self.shape, u_position, time);
        let frame = etalon_math::Frame::from_normal(point.normal);
        let direction = frame.to_world(square_to_cosine_hemisphere(u_direction));
        let radiance = self.emitted(scene, &point, direction, wavelengths);
        // cos θ cancels against the density cos θ/π.
        (density > 0.0).then(|| Emission {
            ray: Ray::new(point.origin_along(direction), direction, 0.0),
            weight: radiance * (core::f32::consts::PI / density),
            density: EmissionPdf {
                origin: density,
                ray: point.normal.dot(direction).max(0.0) * FRAC_1_PI,
            },
            point,
            origin: LightKind::Surface,
            extinction: Vec4::ONE,
            light: LightId::NONE,
        })
    }

    #[inline]
    fn emission_density(
        &self,
        shapes: &impl Shapes,
        _: &BoundingSphere,
        _: Vec3,
        cos: f32,
        time: f32,
    ) -> EmissionPdf {
        EmissionPdf {
            origin: 1.0 / shapes.area(self.shape, time),
            ray: cos.max(0.0) * FRAC_1_PI,
        }
    }

    fn extent(&self, shapes: &impl Shapes) -> Option<LightExtent> {
        Some(extent_of_shape(shapes, self.shape, 0.0))
    }

    fn power(&self, scene: &(impl Textures + Shapes), _: &BoundingSphere) -> f64 {
        let area = f64::from(scene.area(self.shape, 0.0));
        core::f64::consts::PI * area * f64::from(scene.mean(self.radiance))
    }
}
