//! The contract of a scene: all that an integrator may ask.
//!
//! A scene has parts, each with a contract of its own: [`Surfaces`], [`Lights`], [`Media`], the [`Camera`] and the [`Sensor`].
//! What needs several of them is asked of the [`World`]: light on its way between surfaces and through media, and the choice among
//! lights, to which media that emit light belong.
//!
//! No question has a default answer: an implementation that wraps another and forgets one does not compile.

mod lights;
mod media;
mod sensor;
mod surfaces;

pub use lights::Lights;
pub use media::{Media, NoMedia};
pub use sensor::Sensor;
pub use surfaces::Surfaces;

use crate::{
    Camera, Emission, EmissionPdf, LightId, LightSample, LightSampleContext, LightVariety,
    MediumId, Ray, SurfaceInteraction,
};
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::Wavelengths;
use glam::{Vec2, Vec3, Vec4};

/// Straight travel along a segment.
#[derive(Clone, Copy, Debug)]
pub struct Transmission {
    /// The fraction of light that arrives, per lane.
    pub transmittance: Vec4,
    /// The probability with which scattering would have chosen to pass every surface on the
    /// way, per lane: what a path found by scattering pays for the same journey.
    pub probability: Vec4,
}

impl Transmission {
    /// Nothing in the way.
    pub const FREE: Self = Self {
        transmittance: Vec4::ONE,
        probability: Vec4::ONE,
    };

    /// Goes on through what lets light pass in these shares, and would be passed with these probabilities.
    #[inline]
    pub fn then(&mut self, next: &Self) {
        self.transmittance *= next.transmittance;
        self.probability *= next.probability;
    }
}

/// A segment of which [`World::transmittance_batch`] is asked, and the place of the answer.
#[derive(Debug)]
pub struct ShadowQuery<'r> {
    /// The segment.
    pub ray: &'r Ray,
    /// The wavelengths of its path.
    pub wavelengths: &'r Wavelengths,
    /// How many surfaces may let it pass.
    pub crossings: u32,
    /// The answer of [`World::transmittance`].
    pub found: &'r mut Option<Transmission>,
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

    /// How light travels straight along a segment, through at most `crossings` surfaces that
    /// let it pass (`mask`, `null`) and what fills the space between; `None` if it does not arrive at all.
    fn transmittance(
        &self,
        ray: &Ray,
        wavelengths: &Wavelengths,
        crossings: u32,
    ) -> Option<Transmission>;

    /// The same along many segments.
    fn transmittance_batch<'r>(&self, queries: impl Iterator<Item = ShadowQuery<'r>>);

    /// Chooses a light with `u_light` and a direction toward it from `from` with `u`. `None` if
    /// nothing can arrive.
    fn sample_light(
        &self,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u_light: f32,
        u: Vec2,
    ) -> Option<LightSample>;

    /// In what samples of [`World::sample_light`] from `from` may differ: whether anything can be gained by
    /// choosing among several of them. Any answer is right, as long as it is always the same.
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
    fn background_emission_density(&self, direction: Vec3) -> EmissionPdf;

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
