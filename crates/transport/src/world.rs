//! The contract of a scene, as integrators see it.
//!
//! A scene has five parts, each with a contract of its own: [`Surfaces`], [`Lights`], [`Media`], [`Camera`] and [`Sensor`].
//! Methods that need several parts belong to the [`World`]: transmittance, and light sampling over surfaces and emitting
//! media.
//!
//! No method has a default body: an implementation that wraps another and forgets one does not compile.

mod lights;
mod media;
mod sensor;
mod surfaces;

pub use lights::Lights;
pub use media::{Media, NoMedia};
pub use sensor::Sensor;
pub use surfaces::Surfaces;

use crate::{
    Camera, Emission, EmissionPdf, LaneShading, LightId, LightSample, LightSampleContext,
    LightVariety, MediumId, Ray, SurfaceInteraction,
};
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::Wavelengths;
use glam::{Vec2, Vec3, Vec4};

/// Transmission along a straight segment.
#[derive(Clone, Copy, Debug)]
pub struct Transmission {
    /// The fraction of light that arrives, per lane.
    pub transmittance: Vec4,
    /// The probability with which BSDF sampling would have passed all null surfaces and media on the
    /// way, per lane, for MIS.
    pub probability: Vec4,
}

impl Transmission {
    /// Nothing in the way.
    pub const FREE: Self = Self {
        transmittance: Vec4::ONE,
        probability: Vec4::ONE,
    };

    /// Appends another segment.
    #[inline]
    pub fn then(&mut self, next: &Self) {
        self.transmittance *= next.transmittance;
        self.probability *= next.probability;
    }
}

/// A segment for [`World::transmittance_batch`].
#[derive(Clone, Copy, Debug)]
pub struct ShadowQuery {
    /// The segment.
    pub ray: Ray,
    /// The wavelengths of its path.
    pub wavelengths: Wavelengths,
    /// The most null surfaces that it may cross.
    pub crossings: u32,
}

/// A compiled, immutable scene.
pub trait World: Sync {
    /// Its surfaces.
    type Surfaces: Surfaces;
    /// Its lights.
    type Lights: Lights;
    /// Its media.
    type Media: Media;
    /// Its camera.
    type Camera: Camera;
    /// Its sensor.
    type Sensor: Sensor;

    /// What it does in vector lanes.
    type Lanes: LaneShading;

    /// Several vertices at once; `None` if it shades one at a time.
    fn lanes(&self) -> Option<&Self::Lanes>;

    /// The surfaces.
    fn surfaces(&self) -> &Self::Surfaces;

    /// The lights.
    fn lights(&self) -> &Self::Lights;

    /// The media.
    fn media(&self) -> &Self::Media;

    /// The camera.
    fn camera(&self) -> &Self::Camera;

    /// The sensor.
    fn sensor(&self) -> &Self::Sensor;

    /// The moment, in [0, 1], of a sample at `raster` (pixels of the whole film), chosen by the number `u`: `u` itself, or
    /// what a [`crate::RollingShutter`] makes of it.
    fn moment(&self, raster: Vec2, u: f32) -> f32;

    /// The density of [`World::moment`] at `raster` for the moment `time`, for particles that may land there at any: 1, or 0 and
    /// more under a [`crate::RollingShutter`].
    fn exposure(&self, raster: Vec2, time: f32) -> f32;

    /// The transmission along a segment, through at most `crossings` null surfaces (`mask`, `null`)
    /// and the media between; `None` if it is occluded.
    fn transmittance(
        &self,
        ray: &Ray,
        wavelengths: &Wavelengths,
        crossings: u32,
    ) -> Option<Transmission>;

    /// The same along many segments: as many `transmissions` as `queries`.
    fn transmittance_batch(
        &self,
        queries: &[ShadowQuery],
        transmissions: &mut [Option<Transmission>],
    );

    /// Chooses a light with `u_light` and a direction toward it from `from` with `u`. `None` if
    /// nothing can arrive.
    fn sample_light(
        &self,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u_light: f32,
        u: Vec2,
    ) -> Option<LightSample>;

    /// How samples of [`World::sample_light`] from `from` vary: whether resampling several of them can reduce
    /// noise. Any deterministic answer is correct.
    fn light_variety(&self, from: &LightSampleContext) -> LightVariety;

    /// The density with which [`World::sample_light`] from `from` would have chosen the emitting
    /// surface point `at`, seen along the unit vector `direction`.
    fn light_density(
        &self,
        from: &LightSampleContext,
        at: &SurfaceInteraction,
        direction: Vec3,
    ) -> Density<SolidAngle>;

    /// The same for the lights at infinity.
    fn background_density(&self, from: &LightSampleContext, direction: Vec3)
    -> Density<SolidAngle>;

    /// Emits a particle at the moment `time` from a light chosen with `u_light`.
    fn emit(
        &self,
        wavelengths: &Wavelengths,
        u_light: f32,
        u_position: Vec2,
        u_direction: Vec2,
        time: f32,
    ) -> Option<Emission>;

    /// The densities with which [`World::emit`] would have made a particle of `light` travel at `time` along
    /// the unit vector `direction`, which makes an angle with the cosine `cos` with the light's
    /// surface (1 where it has none). Lights at infinity that rays can hit count as one.
    fn emission_density(&self, light: LightId, direction: Vec3, cos: f32, time: f32)
    -> EmissionPdf;

    /// The same for a particle from the lights at infinity seen along the unit vector `direction`.
    fn background_emission_density(&self, direction: Vec3, time: f32) -> EmissionPdf;

    /// The density with which [`World::sample_light`] from `from` would have chosen the point
    /// where a particle began; the probability of its light if that is a point or a direction.
    fn light_sample_density(&self, from: &LightSampleContext, start: &Emission) -> f32;

    /// The density per volume (m⁻³) with which [`World::sample_light`], from any point, and [`World::emit`] choose the point
    /// `at` of a medium that emits light; zero if they never do. Particles leave it evenly in all directions.
    fn medium_light_density(&self, medium: MediumId, at: Vec3) -> f32;
}

/// The scattering models of a world.
pub type BsdfOf<'w, W> = <<W as World>::Surfaces as Surfaces>::Bsdf<'w>;

/// The media of a world.
pub type MediumOf<'w, W> = <<W as World>::Media as Media>::Medium<'w>;
