//! A world that answers as another does, and writes down what it said.

use super::Event;
use super::event_log::SharedEventLog;
use super::model::RecordingBsdf;
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::{SensorWeights, Wavelengths};
use etalon_transport::{
    ApertureHit, Camera, CameraRay, CameraSample, Emission, EmissionPdf, Hit, LegacyPhong, LightId,
    LightSample, LightSampleContext, LightVariety, Lights, MediumId, Ray, Sensor, ShadowQuery,
    SurfaceInteraction, Surfaces, TraceEvent, Transmission, World,
};
use glam::{Vec2, Vec3, Vec4};

/// A part of a world that writes down what it says.
pub(super) struct Recording<'a, T> {
    part: &'a T,
    notebook: &'a SharedEventLog,
}

/// A world that writes down what it says; its media do not.
pub(super) struct Recorder<'a, W: World> {
    world: &'a W,
    surfaces: Recording<'a, W::Surfaces>,
    lights: Recording<'a, W::Lights>,
    camera: Recording<'a, W::Camera>,
    sensor: Recording<'a, W::Sensor>,
    notebook: &'a SharedEventLog,
}

impl<'a, W: World> Recorder<'a, W> {
    /// A world that writes into a notebook.
    pub(super) fn new(world: &'a W, notebook: &'a SharedEventLog) -> Self {
        Self {
            world,
            surfaces: Recording {
                part: world.surfaces(),
                notebook,
            },
            lights: Recording {
                part: world.lights(),
                notebook,
            },
            camera: Recording {
                part: world.camera(),
                notebook,
            },
            sensor: Recording {
                part: world.sensor(),
                notebook,
            },
            notebook,
        }
    }
}

impl<C: Camera> Camera for Recording<'_, C> {
    fn ray(&self, raster: Vec2, lens: Vec2, time: f32) -> CameraRay {
        let start = self.part.ray(raster, lens, time);
        self.notebook.write(|notes| {
            let walk = notes.begin_at_camera(start.weight, start.ray.direction);
            let ray = start.ray;
            notes.note(Event::CameraRay { walk, raster, ray });
        });
        start
    }

    fn connect(&self, point: Vec3, lens: Vec2, time: f32, margin: f32) -> Option<CameraSample> {
        let connection = self.part.connect(point, lens, time, margin);
        self.notebook.note(Event::CameraSample(connection));
        connection
    }

    fn intersect_aperture(&self, ray: &Ray, margin: f32) -> Option<ApertureHit> {
        let reception = self.part.intersect_aperture(ray, margin)?;
        self.notebook.note(Event::ApertureHit(reception));
        Some(reception)
    }

    fn can_receive(&self) -> bool {
        self.part.can_receive()
    }

    fn has_lens(&self) -> bool {
        self.part.has_lens()
    }
}

impl<S: Sensor> Sensor for Recording<'_, S> {
    fn wavelengths(&self, u: f32) -> Wavelengths {
        let wavelengths = self.part.wavelengths(u);
        self.notebook.note(Event::Wavelengths(wavelengths));
        wavelengths
    }

    fn weights(&self, wavelengths: &Wavelengths) -> SensorWeights {
        self.part.weights(wavelengths)
    }
}

impl<S: Surfaces> Surfaces for Recording<'_, S> {
    type Bsdf<'w>
        = RecordingBsdf<'w, S::Bsdf<'w>>
    where
        Self: 'w;

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let hit = self.part.intersect(ray);
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

    fn intersect_batch(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.intersect(ray);
        }
    }

    fn vertex(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        let vertex = self.part.vertex(ray, hit);
        self.notebook
            .write(|notes| notes.shade(&vertex, ray.direction));
        vertex
    }

    fn bsdf(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Self::Bsdf<'_> {
        let place = self.notebook.write(|notes| notes.place(vertex));
        RecordingBsdf {
            model: self.part.bsdf(vertex, wo, wavelengths),
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
        self.part.legacy_phong(vertex, wo, wavelengths)
    }

    fn take_ray_count(&self) -> u64 {
        self.part.take_ray_count()
    }
}

impl<L: Lights> Lights for Recording<'_, L> {
    fn count(&self) -> u32 {
        self.part.count()
    }

    fn is_emitter(&self, hit: &Hit) -> bool {
        self.part.is_emitter(hit)
    }

    fn emitted(&self, vertex: &SurfaceInteraction, wo: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        let radiance = self.part.emitted(vertex, wo, wavelengths);
        self.notebook.note(Event::Emission(radiance));
        radiance
    }

    fn has_background(&self) -> bool {
        self.part.has_background()
    }

    fn background(&self, direction: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        let radiance = self.part.background(direction, wavelengths);
        self.notebook.note(Event::Background(direction, radiance));
        radiance
    }

    fn sample_one(
        &self,
        light: LightId,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        let sample = self.part.sample_one(light, from, wavelengths, u);
        self.notebook.note(Event::Light(sample));
        sample
    }
}

impl<'a, W: World> World for Recorder<'a, W> {
    type Surfaces = Recording<'a, W::Surfaces>;
    type Lights = Recording<'a, W::Lights>;
    type Media = W::Media;
    type Camera = Recording<'a, W::Camera>;
    type Sensor = Recording<'a, W::Sensor>;

    fn surfaces(&self) -> &Self::Surfaces {
        &self.surfaces
    }

    fn lights(&self) -> &Self::Lights {
        &self.lights
    }

    fn media(&self) -> &Self::Media {
        self.world.media()
    }

    fn camera(&self) -> &Self::Camera {
        &self.camera
    }

    fn sensor(&self) -> &Self::Sensor {
        &self.sensor
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

    fn transmittance_batch(
        &self,
        queries: &[ShadowQuery],
        transmissions: &mut [Option<Transmission>],
    ) {
        for (query, transmission) in queries.iter().zip(transmissions) {
            *transmission = self.transmittance(&query.ray, &query.wavelengths, query.crossings);
        }
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

    fn background_emission_density(&self, direction: Vec3) -> EmissionPdf {
        self.world.background_emission_density(direction)
    }

    fn light_sample_density(&self, from: &LightSampleContext, start: &Emission) -> f32 {
        self.world.light_sample_density(from, start)
    }

    fn medium_light_density(&self, medium: MediumId, at: Vec3) -> f32 {
        self.world.medium_light_density(medium, at)
    }

    fn record(&self, remark: impl FnOnce() -> TraceEvent) -> bool {
        // It may itself ask the world.
        let remark = remark();
        self.notebook.write(|notes| {
            notes.record(remark, |wavelengths| {
                self.world.sensor().weights(wavelengths)
            })
        });
        true
    }
}
