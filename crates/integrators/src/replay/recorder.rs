//! A world that answers as another does, and writes down what it said.

use super::Event;
use super::event_log::SharedEventLog;
use super::model::RecordingBsdf;
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::{SensorWeights, Wavelengths};
use etalon_transport::{
    ApertureHit, Camera, CameraRay, CameraSample, Coefficients, DiffusionProfile, Emission,
    EmissionPdf, Hit, LegacyPhong, LightId, LightSample, LightSampleContext, LightVariety,
    MediumId, Ray, SurfaceInteraction, TraceEvent, Transmission, World,
};
use glam::{Vec2, Vec3, Vec4};

/// A world that writes down what it says.
pub(super) struct Recorder<'a, W: World> {
    world: &'a W,
    camera: RecordingCamera<'a, W::Camera>,
    notebook: &'a SharedEventLog,
}

impl<'a, W: World> Recorder<'a, W> {
    /// A world that writes into a notebook.
    pub(super) fn new(world: &'a W, notebook: &'a SharedEventLog) -> Self {
        let camera = RecordingCamera {
            camera: world.camera(),
            notebook,
        };
        Self {
            world,
            camera,
            notebook,
        }
    }
}

/// A camera that writes down what it says.
pub(super) struct RecordingCamera<'a, C> {
    camera: &'a C,
    notebook: &'a SharedEventLog,
}

impl<C: Camera> Camera for RecordingCamera<'_, C> {
    fn ray(&self, raster: Vec2, lens: Vec2, time: f32) -> CameraRay {
        let start = self.camera.ray(raster, lens, time);
        self.notebook.write(|notes| {
            let walk = notes.begin_at_camera(start.weight, start.ray.direction);
            let ray = start.ray;
            notes.note(Event::CameraRay { walk, raster, ray });
        });
        start
    }

    fn connect(&self, point: Vec3, lens: Vec2, time: f32, margin: f32) -> Option<CameraSample> {
        let connection = self.camera.connect(point, lens, time, margin);
        self.notebook.note(Event::CameraSample(connection));
        connection
    }

    fn intersect_aperture(&self, ray: &Ray, margin: f32) -> Option<ApertureHit> {
        let reception = self.camera.intersect_aperture(ray, margin)?;
        self.notebook.note(Event::ApertureHit(reception));
        Some(reception)
    }

    fn can_receive(&self) -> bool {
        self.camera.can_receive()
    }

    fn has_lens(&self) -> bool {
        self.camera.has_lens()
    }
}

impl<'a, W: World> World for Recorder<'a, W> {
    type Bsdf<'w>
        = RecordingBsdf<'w, W::Bsdf<'w>>
    where
        Self: 'w;
    type Medium<'w>
        = W::Medium<'w>
    where
        Self: 'w;
    type Camera = RecordingCamera<'a, W::Camera>;

    fn camera(&self) -> &Self::Camera {
        &self.camera
    }

    fn camera_medium(&self) -> MediumId {
        self.world.camera_medium()
    }

    fn medium(&self, medium: MediumId, wavelengths: &Wavelengths) -> Option<Self::Medium<'_>> {
        self.world.medium(medium, wavelengths)
    }

    fn is_dark(&self, medium: MediumId) -> bool {
        self.world.is_dark(medium)
    }

    fn entry(
        &self,
        medium: MediumId,
        at: &SurfaceInteraction,
        wavelengths: &Wavelengths,
    ) -> Option<Coefficients> {
        self.world.entry(medium, at, wavelengths)
    }

    fn entered(
        &self,
        medium: MediumId,
        coefficients: Coefficients,
        wavelengths: &Wavelengths,
    ) -> Option<Self::Medium<'_>> {
        self.world.entered(medium, coefficients, wavelengths)
    }

    fn diffusion(
        &self,
        medium: MediumId,
        at: &SurfaceInteraction,
        wavelengths: &Wavelengths,
    ) -> Option<impl DiffusionProfile> {
        self.world.diffusion(medium, at, wavelengths)
    }

    fn wavelengths(&self, u: f32) -> Wavelengths {
        let wavelengths = self.world.wavelengths(u);
        self.notebook.note(Event::Wavelengths(wavelengths));
        wavelengths
    }

    fn sensor(&self, wavelengths: &Wavelengths) -> SensorWeights {
        self.world.sensor(wavelengths)
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let hit = self.world.intersect(ray);
        self.notebook.write(|notes| {
            let walk = notes.along(ray.direction).map(|place| place.walk);
            let hit = hit.as_ref().map(|hit| hit.t);
            notes.note(Event::Ray {
                walk,
                ray: *ray,
                hit,
            });
        });
        hit
    }

    fn vertex(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        let vertex = self.world.vertex(ray, hit);
        self.notebook
            .write(|notes| notes.shade(&vertex, ray.direction));
        vertex
    }

    fn transmittance(
        &self,
        ray: &Ray,
        wavelengths: &Wavelengths,
        crossings: u32,
    ) -> Option<Transmission> {
        let passage = self.world.transmittance(ray, wavelengths, crossings);
        self.notebook.note(Event::Transmission(*ray, passage));
        passage
    }

    fn bsdf(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Self::Bsdf<'_> {
        let place = self.notebook.write(|notes| notes.place(vertex));
        RecordingBsdf {
            model: self.world.bsdf(vertex, wo, wavelengths),
            place,
            notebook: self.notebook,
        }
    }

    fn legacy_phong(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Option<LegacyPhong> {
        self.world.legacy_phong(vertex, wo, wavelengths)
    }

    fn emitted(&self, vertex: &SurfaceInteraction, wo: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        let radiance = self.world.emitted(vertex, wo, wavelengths);
        self.notebook.note(Event::Emission(radiance));
        radiance
    }

    fn is_emitter(&self, hit: &Hit) -> bool {
        self.world.is_emitter(hit)
    }

    fn background(&self, direction: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        let radiance = self.world.background(direction, wavelengths);
        self.notebook.note(Event::Background(direction, radiance));
        radiance
    }

    fn has_background(&self) -> bool {
        self.world.has_background()
    }

    fn sample_light(
        &self,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u_light: f32,
        u: Vec2,
    ) -> Option<LightSample> {
        let sample = self.world.sample_light(from, wavelengths, u_light, u);
        self.notebook.note(Event::Light(sample));
        sample
    }

    fn light_variety(&self, from: &LightSampleContext) -> LightVariety {
        self.world.light_variety(from)
    }

    fn light_count(&self) -> u32 {
        self.world.light_count()
    }

    fn sample_one_light(
        &self,
        light: LightId,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        let sample = self.world.sample_one_light(light, from, wavelengths, u);
        self.notebook.note(Event::Light(sample));
        sample
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
            .emit(wavelengths, u_light, u_position, u_direction, time);
        self.notebook.write(|notes| {
            let (value, direction) = emission
                .as_ref()
                .map_or((Vec4::ZERO, Vec3::ZERO), |e| (e.weight, e.ray.direction));
            let walk = notes.begin(value, direction);
            notes.note(Event::Emitted { walk, emission });
        });
        emission
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

    fn medium_light_density(&self, medium: MediumId, at: Vec3) -> f32 {
        self.world.medium_light_density(medium, at)
    }

    fn background_emission_density(&self, direction: Vec3) -> EmissionPdf {
        self.world.background_emission_density(direction)
    }

    fn light_sample_density(&self, from: &LightSampleContext, start: &Emission) -> f32 {
        self.world.light_sample_density(from, start)
    }

    fn take_ray_count(&self) -> u64 {
        self.world.take_ray_count()
    }

    fn record(&self, remark: impl FnOnce() -> TraceEvent) -> bool {
        // It may itself ask the world.
        let remark = remark();
        self.notebook
            .write(|notes| notes.record(remark, |wavelengths| self.world.sensor(wavelengths)));
        true
    }
}
