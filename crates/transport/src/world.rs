//! The contract of a scene: all that an integrator may ask.

use crate::{
    Bsdf, Camera, Coefficients, DiffusionProfile, Emission, EmissionPdf, Hit, LegacyPhong, LightId,
    LightSample, LightSampleContext, LightVariety, Medium, MediumId, NoProfile, Ray,
    SurfaceInteraction, TraceEvent,
};
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::{SensorWeights, Wavelengths, sensor_response};
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
    /// A scattering model at a point.
    type Bsdf<'w>: Bsdf + Copy
    where
        Self: 'w;
    /// A medium at a path's wavelengths.
    type Medium<'w>: Medium
    where
        Self: 'w;
    /// The camera.
    type Camera: Camera;

    /// The camera.
    fn camera(&self) -> &Self::Camera;

    /// The medium that the camera is in.
    #[inline]
    fn camera_medium(&self) -> MediumId {
        MediumId::NONE
    }

    /// A medium; `None` in empty space. A world without media keeps this.
    #[inline]
    fn medium(&self, _medium: MediumId, _wavelengths: &Wavelengths) -> Option<Self::Medium<'_>> {
        None
    }

    /// Whether no light enters a medium straight, so that sampling lights there finds nothing. A world that does not know keeps
    /// this.
    #[inline]
    fn is_dark(&self, _medium: MediumId) -> bool {
        false
    }

    /// The coefficients of a medium for paths that enter it at the surface point `at`, if that is all to know of it: they need not be
    /// asked for again, and may vary over its surface. A world that knows none keeps this.
    #[inline]
    fn entry(
        &self,
        _medium: MediumId,
        _at: &SurfaceInteraction,
        _wavelengths: &Wavelengths,
    ) -> Option<Coefficients> {
        None
    }

    /// A medium for a path that entered it where it has these coefficients ([`World::entry`]).
    #[inline]
    fn entered(
        &self,
        medium: MediumId,
        _coefficients: Coefficients,
        wavelengths: &Wavelengths,
    ) -> Option<Self::Medium<'_>> {
        self.medium(medium, wavelengths)
    }

    /// The diffusion profile that stands for walks in a medium below the surface point `at`, if it has one. A world without
    /// such media keeps this.
    #[inline]
    fn diffusion(
        &self,
        _medium: MediumId,
        _at: &SurfaceInteraction,
        _wavelengths: &Wavelengths,
    ) -> Option<impl DiffusionProfile> {
        None::<NoProfile>
    }

    /// Draws the wavelengths of a path.
    fn wavelengths(&self, u: f32) -> Wavelengths;

    /// What the sensor makes of the light at these wavelengths. A world with the standard sensor keeps this.
    #[inline]
    fn sensor(&self, wavelengths: &Wavelengths) -> SensorWeights {
        sensor_response(wavelengths)
    }

    /// The nearest surface along a ray.
    fn intersect(&self, ray: &Ray) -> Option<Hit>;

    /// The nearest surfaces along many rays, each with the place of its answer. A world that finds them no faster
    /// together keeps this.
    #[inline]
    fn intersect_batch<'r>(&self, queries: impl Iterator<Item = (&'r Ray, &'r mut Option<Hit>)>) {
        for (ray, hit) in queries {
            *hit = self.intersect(ray);
        }
    }

    /// The differential geometry of a hit.
    fn vertex(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction;

    /// How light travels straight along a segment, through at most `crossings` surfaces that
    /// let it pass (`mask`, `null`) and what fills the space between; `None` if it does not arrive at all.
    fn transmittance(
        &self,
        ray: &Ray,
        wavelengths: &Wavelengths,
        crossings: u32,
    ) -> Option<Transmission>;

    /// The same along many segments.
    #[inline]
    fn transmittance_batch<'r>(&self, queries: impl Iterator<Item = ShadowQuery<'r>>) {
        for query in queries {
            let ShadowQuery {
                ray,
                wavelengths,
                crossings,
                found,
            } = query;
            *found = self.transmittance(ray, wavelengths, crossings);
        }
    }

    /// The scattering model at a vertex.
    fn bsdf(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Self::Bsdf<'_>;

    /// The classic Phong material at a vertex, if it has one in place of a scattering model (its
    /// [`World::bsdf`] is black). A world without such materials keeps this.
    fn legacy_phong(
        &self,
        _vertex: &SurfaceInteraction,
        _wo: Vec3,
        _wavelengths: &Wavelengths,
    ) -> Option<LegacyPhong> {
        None
    }

    /// Radiance emitted by the surface at `vertex` toward `wo`.
    fn emitted(&self, vertex: &SurfaceInteraction, wo: Vec3, wavelengths: &Wavelengths) -> Vec4;

    /// Whether the surface that was hit emits light at all.
    fn is_emitter(&self, hit: &Hit) -> bool;

    /// Radiance of the lights at infinity seen along the unit vector `direction`.
    fn background(&self, direction: Vec3, wavelengths: &Wavelengths) -> Vec4;

    /// Whether the scene has any light at infinity that a ray can hit.
    fn has_background(&self) -> bool;

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
    #[inline]
    fn light_variety(&self, _from: &LightSampleContext) -> LightVariety {
        LightVariety::Several
    }

    /// How many lights there are. Their ids count from 0.
    fn light_count(&self) -> u32;

    /// A direction toward one light, as if it were the only one: without the probability of
    /// choosing it. For estimators that ask every light.
    fn sample_one_light(
        &self,
        light: LightId,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample>;

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

    /// The density per volume (m⁻³) with which [`World::sample_light`], from wherever, and [`World::emit`] choose the point
    /// `at` of a medium that emits light; zero if they never do. Particles leave it evenly in all directions.
    #[inline]
    fn medium_light_density(&self, _medium: MediumId, _at: Vec3) -> f32 {
        0.0
    }

    /// How many rays the calling thread has traced since it last asked.
    fn take_ray_count(&self) -> u64;

    /// Tells whoever draws a sample again what cannot be seen from what was asked, and says whether
    /// anybody listens: if so, more may be asked only to be told. A world that renders keeps this, and
    /// the remark is never made.
    #[inline]
    fn record(&self, _remark: impl FnOnce() -> TraceEvent) -> bool {
        false
    }
}
