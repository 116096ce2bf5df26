//! The lights of a scene that are on surfaces, at points or at infinity. Media that emit light are chosen with them by
//! [`World::sample_light`](crate::World::sample_light).

use crate::{Hit, LightId, LightSample, LightSampleContext, SurfaceInteraction};
use etalon_spectrum::Wavelengths;
use glam::{Vec2, Vec3, Vec4};

/// Lights, each by itself.
pub trait Lights: Sync {
    /// Number of lights. Ids count from 0.
    fn count(&self) -> u32;

    /// Whether the surface that was hit emits light at all.
    fn is_emitter(&self, hit: &Hit) -> bool;

    /// Radiance emitted by the surface at `vertex` toward `wo`.
    fn emitted(&self, vertex: &SurfaceInteraction, wo: Vec3, wavelengths: &Wavelengths) -> Vec4;

    /// Whether the scene has any light at infinity that a ray can hit.
    fn has_background(&self) -> bool;

    /// Radiance of the lights at infinity seen along the unit vector `direction` at a moment within the shutter interval.
    fn background(&self, direction: Vec3, time: f32, wavelengths: &Wavelengths) -> Vec4;

    /// A direction toward one light, with a density that excludes the choice of the light. For estimators that sample
    /// every light.
    fn sample_one(
        &self,
        light: LightId,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample>;
}
