//! Samples and particles of skies; models of the clear sky.

pub(crate) mod calendar;
pub(crate) mod course;
pub(crate) mod guide;
pub(crate) mod hosek_wilkie;
pub(crate) mod hour;
pub(crate) mod sun_disk;
pub(crate) mod sun_position;

use crate::BoundingSphere;
use etalon_math::{Density, SolidAngle};
use etalon_transport::{Emission, EmissionPdf, LightId, LightKind, LightSample, SamplePdf};
use glam::{Vec2, Vec3, Vec4};

/// The sample of a sky's `radiance` from `direction`, found with `density`.
#[inline]
pub(crate) fn sample(direction: Vec3, radiance: Vec4, density: Density<SolidAngle>) -> LightSample {
    LightSample {
        direction,
        target: None,
        radiance,
        chance: SamplePdf::Continuous(density),
        cos: 1.0,
        origin: LightKind::Sky,
        extinction: Vec4::ONE,
        light: LightId::NONE,
    }
}

/// The particle that comes from the direction `toward` a sky, chosen with `density` (sr⁻¹), into the scene.
#[inline]
pub(crate) fn emit(
    bounds: &BoundingSphere,
    toward: Vec3,
    u_position: Vec2,
    radiance: Vec4,
    density: f32,
) -> Emission {
    let ray = bounds.ray_into(-toward, u_position);
    Emission {
        point: Emission::point_of(&ray),
        ray,
        weight: radiance * (bounds.cross_section() as f32 / density),
        density: EmissionPdf {
            origin: density,
            ray: bounds.ray_density(),
        },
        origin: LightKind::Sky,
        extinction: Vec4::ONE,
        light: LightId::NONE,
    }
}
