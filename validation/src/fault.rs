//! Faults planted from outside: worlds that lie in one respect, to show that lies are found.
//!
//! A [`Faulty`] world passes every question on to a sound one and falsifies a kind of answer; without a fault its
//! pictures are the same bits.
//! The renderer itself has no hooks for this. It may also rotate the lanes of wavelengths, which
//! is no fault: another wavelength chooses then, and the picture must be the same.

mod bsdf;
mod medium;

use bsdf::FaultyBsdf;
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::{SensorWeights, Wavelengths};
use etalon_transport::{
    BsdfOf, Emission, EmissionPdf, Hit, LegacyPhong, LightId, LightSample, LightSampleContext,
    LightVariety, Lights, Media, MediumId, MediumOf, NoLanes, Ray, SamplePdf, Sensor, ShadowQuery,
    SurfaceInteraction, Surfaces, Transmission, World,
};
use glam::{Vec2, Vec3, Vec4};
use medium::FaultyMedium;
use serde::Deserialize;

/// A physical fault.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum PlantedFault {
    /// Scattering without |cos θi|.
    #[serde(rename = "dropped cosine")]
    DroppedCosine,
    /// Light sampling believes itself half as dense as it is where it samples, not where it is
    /// asked: the multiple importance weights do not sum to one.
    #[serde(rename = "wrong light density")]
    WrongLightDensity,
    /// All lights give 2 % too much, media that emit among them.
    #[serde(rename = "energy x 1.02")]
    Energy,
    /// All lights give 20 % too much: for claims whose noise hides less.
    #[serde(rename = "energy x 1.2")]
    GreatEnergy,
    /// Independent samples where others are claimed: for convergence claims.
    #[serde(rename = "independent samples")]
    IndependentSamples,
    /// Standard errors are too small by √2: for noise claims.
    #[serde(rename = "standard error / sqrt 2")]
    StandardError,
    /// What must be the same bits is of another seed: for invariance claims.
    #[serde(rename = "another seed")]
    AnotherSeed,
    /// The picture is one pixel too far to the right: for pixelwise claims.
    #[serde(rename = "shifted by a pixel")]
    ShiftedPixel,
    /// Left and right are exchanged: for pixelwise claims.
    #[serde(rename = "mirrored")]
    Mirrored,
    /// The picture is 1 % too bright: for pixelwise claims.
    #[serde(rename = "energy x 1.01")]
    SlightEnergy,
}

impl PlantedFault {
    /// Whether it is a fault of the world, and not of how it is sampled or what is reported.
    pub fn is_physical(self) -> bool {
        match self {
            Self::DroppedCosine | Self::WrongLightDensity | Self::Energy | Self::GreatEnergy => {
                true
            }
            Self::IndependentSamples
            | Self::StandardError
            | Self::AnotherSeed
            | Self::ShiftedPixel
            | Self::Mirrored
            | Self::SlightEnergy => false,
        }
    }
}

impl std::fmt::Display for PlantedFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::DroppedCosine => "dropped cosine",
            Self::WrongLightDensity => "wrong light density",
            Self::Energy => "energy x 1.02",
            Self::GreatEnergy => "energy x 1.2",
            Self::IndependentSamples => "independent samples",
            Self::StandardError => "standard error / sqrt 2",
            Self::AnotherSeed => "another seed",
            Self::ShiftedPixel => "shifted by a pixel",
            Self::Mirrored => "mirrored",
            Self::SlightEnergy => "energy x 1.01",
        })
    }
}

/// A world with a fault, or with other lanes.
pub struct Faulty<'a, W> {
    world: &'a W,
    fault: Option<PlantedFault>,
    rotation: usize,
}

impl<'a, W: World> Faulty<'a, W> {
    /// `world`, but for `fault`, and with wavelengths' lanes rotated by `rotation`.
    pub fn new(world: &'a W, fault: Option<PlantedFault>, rotation: usize) -> Self {
        Self {
            world,
            fault,
            rotation,
        }
    }

    fn energy(&self) -> f32 {
        match self.fault {
            Some(PlantedFault::Energy) => 1.02,
            Some(PlantedFault::GreatEnergy) => 1.2,
            _ => 1.0,
        }
    }

    fn faulty(&self, mut sample: LightSample) -> LightSample {
        sample.radiance *= self.energy();
        if let (Some(PlantedFault::WrongLightDensity), SamplePdf::Continuous(density)) =
            (self.fault, sample.chance)
        {
            sample.chance = SamplePdf::Continuous(Density::per_lane(0.5 * density.lanes()));
        }
        sample
    }
}

impl<W: World> Surfaces for Faulty<'_, W> {
    type Bsdf<'w>
        = FaultyBsdf<BsdfOf<'w, W>>
    where
        Self: 'w;

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.world.surfaces().intersect(ray)
    }

    fn intersect_batch(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        self.world.surfaces().intersect_batch(rays, hits);
    }

    fn vertex(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        self.world.surfaces().vertex(ray, hit)
    }

    fn bsdf(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Self::Bsdf<'_> {
        FaultyBsdf {
            model: self.world.surfaces().bsdf(vertex, wo, wavelengths),
            missing: (self.fault == Some(PlantedFault::DroppedCosine)).then_some(vertex.shading.n),
        }
    }

    fn legacy_phong(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Option<LegacyPhong> {
        self.world.surfaces().legacy_phong(vertex, wo, wavelengths)
    }

    fn take_ray_count(&self) -> u64 {
        self.world.surfaces().take_ray_count()
    }
}

impl<W: World> Lights for Faulty<'_, W> {
    fn count(&self) -> u32 {
        self.world.lights().count()
    }

    fn is_emitter(&self, hit: &Hit) -> bool {
        self.world.lights().is_emitter(hit)
    }

    fn emitted(&self, vertex: &SurfaceInteraction, wo: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        self.energy() * self.world.lights().emitted(vertex, wo, wavelengths)
    }

    fn has_background(&self) -> bool {
        self.world.lights().has_background()
    }

    fn background(&self, direction: Vec3, time: f32, wavelengths: &Wavelengths) -> Vec4 {
        self.energy() * (self.world.lights()).background(direction, time, wavelengths)
    }

    fn sample_one(
        &self,
        light: LightId,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        let sample = (self.world)
            .lights()
            .sample_one(light, from, wavelengths, u)?;
        Some(self.faulty(sample))
    }
}

impl<W: World> Media for Faulty<'_, W> {
    type Medium<'w>
        = FaultyMedium<MediumOf<'w, W>>
    where
        Self: 'w;

    fn around_camera(&self) -> MediumId {
        self.world.media().around_camera()
    }

    fn enter(
        &self,
        medium: MediumId,
        at: Option<&SurfaceInteraction>,
        wavelengths: &Wavelengths,
    ) -> Option<Self::Medium<'_>> {
        let medium = self.world.media().enter(medium, at, wavelengths)?;
        Some(FaultyMedium {
            medium,
            energy: self.energy(),
        })
    }
}

impl<W: World> Sensor for Faulty<'_, W> {
    fn wavelengths(&self, u: f32) -> Wavelengths {
        self.world.sensor().wavelengths(u).rotated(self.rotation)
    }

    fn weights(&self, wavelengths: &Wavelengths) -> SensorWeights {
        self.world.sensor().weights(wavelengths)
    }
}

impl<W: World> World for Faulty<'_, W> {
    type Surfaces = Self;
    type Lights = Self;
    type Media = Self;
    type Camera = W::Camera;
    type Sensor = Self;

    type Lanes = NoLanes;

    fn lanes(&self) -> Option<&NoLanes> {
        None
    }

    fn surfaces(&self) -> &Self {
        self
    }

    fn lights(&self) -> &Self {
        self
    }

    fn media(&self) -> &Self {
        self
    }

    fn camera(&self) -> &Self::Camera {
        self.world.camera()
    }

    fn sensor(&self) -> &Self {
        self
    }

    fn moment(&self, raster: Vec2, u: f32) -> f32 {
        self.world.moment(raster, u)
    }

    fn exposure(&self, raster: Vec2, time: f32) -> f32 {
        self.world.exposure(raster, time)
    }

    fn transmittance(
        &self,
        ray: &Ray,
        wavelengths: &Wavelengths,
        crossings: u32,
    ) -> Option<Transmission> {
        self.world.transmittance(ray, wavelengths, crossings)
    }

    fn transmittance_batch(
        &self,
        queries: &[ShadowQuery],
        transmissions: &mut [Option<Transmission>],
    ) {
        self.world.transmittance_batch(queries, transmissions);
    }

    fn sample_light(
        &self,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u_light: f32,
        u: Vec2,
    ) -> Option<LightSample> {
        let sample = self.world.sample_light(from, wavelengths, u_light, u)?;
        Some(self.faulty(sample))
    }

    fn light_variety(&self, from: &LightSampleContext) -> LightVariety {
        self.world.light_variety(from)
    }

    fn light_density(
        &self,
        from: &LightSampleContext,
        at: &SurfaceInteraction,
        direction: Vec3,
    ) -> Density<SolidAngle> {
        self.world.light_density(from, at, direction)
    }

    fn background_density(
        &self,
        from: &LightSampleContext,
        direction: Vec3,
    ) -> Density<SolidAngle> {
        self.world.background_density(from, direction)
    }

    fn emit(
        &self,
        wavelengths: &Wavelengths,
        u_light: f32,
        u_position: Vec2,
        u_direction: Vec2,
        time: f32,
    ) -> Option<Emission> {
        let emission = self
            .world
            .emit(wavelengths, u_light, u_position, u_direction, time)?;
        Some(Emission {
            weight: self.energy() * emission.weight,
            ..emission
        })
    }

    fn emission_density(
        &self,
        light: LightId,
        direction: Vec3,
        cos: f32,
        time: f32,
    ) -> EmissionPdf {
        self.world.emission_density(light, direction, cos, time)
    }

    fn background_emission_density(&self, direction: Vec3, time: f32) -> EmissionPdf {
        (self.world).background_emission_density(direction, time)
    }

    fn light_sample_density(&self, from: &LightSampleContext, start: &Emission) -> f32 {
        self.world.light_sample_density(from, start)
    }

    fn medium_light_density(&self, medium: MediumId, at: Vec3) -> f32 {
        self.world.medium_light_density(medium, at)
    }
}
