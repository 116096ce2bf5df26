//! The lights of a scene, each by itself.

use super::Parts;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Hit, LightId, LightSample, LightSampleContext, Lights, SurfaceInteraction};
use glam::{Vec2, Vec3, Vec4};

impl Lights for Parts {
    fn count(&self) -> u32 {
        self.lights.len() as u32
    }

    #[inline]
    fn is_emitter(&self, hit: &Hit) -> bool {
        self.space.lookup.geometry.light(hit).is_some()
    }

    #[inline]
    fn emitted(&self, vertex: &SurfaceInteraction, wo: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        self.lights
            .emitted(&self.space.lookup, vertex, wo, wavelengths)
    }

    #[inline]
    fn has_background(&self) -> bool {
        self.lights.has_background()
    }

    #[inline]
    fn background(&self, direction: Vec3, time: f32, wavelengths: &Wavelengths) -> Vec4 {
        self.lights
            .background(&self.space.lookup, direction, time, wavelengths)
    }

    #[inline]
    fn sample_one(
        &self,
        light: LightId,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        self.lights
            .sample_one(&self.space.lookup, light, from, wavelengths, u)
    }
}
