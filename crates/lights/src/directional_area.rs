//! `directionalarea`: a shape whose points each send light along their normal alone, as a laser does:
//!
//! ```text
//! Φ = ∫ E(x, λ) dA
//! ```
//!
//! with E the `radiance` of the scene file: all of it goes in one direction, so that it is the irradiance (W·m⁻²·nm⁻¹)
//! on a surface that a flat light faces.
//!
//! Only particles emitted there find its light: the probability that a ray hits it along a normal is zero, as is that of
//! a connection.

use crate::light::extent_of_shape;
use crate::light_model::LightModel;
use crate::{BoundingSphere, LightExtent};
use etalon_params::Params;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightId, LightKind, LightSample, LightSampleContext, Ray,
    SampledPoint, ShapeId, Shapes, SpectrumKind, TextureId, Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// A shape that shines along its normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalArea {
    shape: ShapeId,
    irradiance: TextureId,
}

impl DirectionalArea {
    /// Reads `radiance`.
    pub fn from_params(params: &Params<'_>, shape: ShapeId, build: &mut dyn Build) -> Self {
        Self {
            shape,
            irradiance: build.texture(params, "radiance", Some(1.0), SpectrumKind::Emission),
        }
    }
}

impl LightModel for DirectionalArea {
    const OF_SHAPE: bool = true;
    const BEAM: bool = true;

    fn sample(
        &self,
        _: &(impl Textures + Shapes),
        _: &LightSampleContext,
        _: &Wavelengths,
        _: Vec2,
    ) -> Option<LightSample> {
        None
    }

    #[inline]
    fn emit(
        &self,
        scene: &(impl Textures + Shapes),
        _: &BoundingSphere,
        wavelengths: &Wavelengths,
        u_position: Vec2,
        _: Vec2,
        time: f32,
    ) -> Option<Emission> {
        let SampledPoint { point, density } = scene.sample_area(self.shape, u_position, time);
        let direction = point.normal;
        let irradiance = scene.spectrum(self.irradiance, &point.texture, wavelengths.lambda);
        (density > 0.0).then(|| Emission {
            ray: Ray::new(point.origin_along(direction), direction, 0.0),
            weight: irradiance / density,
            density: EmissionPdf {
                origin: 1.0,
                ray: density,
            },
            point,
            origin: LightKind::Beam,
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
        _cos: f32,
        time: f32,
    ) -> EmissionPdf {
        EmissionPdf {
            origin: 1.0,
            ray: 1.0 / shapes.area(self.shape, time),
        }
    }

    fn extent(&self, shapes: &impl Shapes) -> Option<LightExtent> {
        Some(extent_of_shape(shapes, self.shape, 1.0))
    }

    fn power(&self, scene: &(impl Textures + Shapes), _: &BoundingSphere) -> f64 {
        f64::from(scene.area(self.shape, 0.0)) * f64::from(scene.mean(self.irradiance))
    }
}
