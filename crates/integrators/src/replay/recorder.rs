//! A world that answers as another does, and writes down what it said.

use super::log::{SharedLog, chance, lanes, vector, walk};
use super::recording_bsdf::RecordingBsdf;
use etalon_math::lane::Lane;
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::{SensorWeights, Wavelengths};
use etalon_transport::{
    ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Emission, EmissionPdf, Hit,
    LegacyPhong, LightId, LightSample, LightSampleContext, LightVariety, Lights, MediumId, NoLanes,
    Ray, Sensor, ShadowQuery, SurfaceInteraction, Surfaces, Transmission, World,
};
use glam::{Vec2, Vec3, Vec4};

/// A part of a world that writes down what it says.
pub(super) struct Recording<'a, T> {
    part: &'a T,
    log: &'a SharedLog<'a>,
}

/// A world that writes down what it says; its media do not.
pub(super) struct Recorder<'a, W: World> {
    world: &'a W,
    surfaces: Recording<'a, W::Surfaces>,
    lights: Recording<'a, W::Lights>,
    camera: Recording<'a, W::Camera>,
    sensor: Recording<'a, W::Sensor>,
    log: &'a SharedLog<'a>,
}

impl<'a, W: World> Recorder<'a, W> {
    /// A world that writes into a log.
    pub(super) fn new(world: &'a W, log: &'a SharedLog<'a>) -> Self {
        Self {
            world,
            surfaces: Recording {
                part: world.surfaces(),
                log,
            },
            lights: Recording {
                part: world.lights(),
                log,
            },
            camera: Recording {
                part: world.camera(),
                log,
            },
            sensor: Recording {
                part: world.sensor(),
                log,
            },
            log,
        }
    }
}

impl<C: Camera> Camera for Recording<'_, C> {
    fn ray(&self, raster: Vec2, lens: Vec2, time: f32) -> CameraRay {
        let start = self.part.ray(raster, lens, time);
        let ray = &start.ray;
        let mut log = self.log.write();
        log.begin_path();
        log.begin(Vec4::splat(start.weight), ray.direction);
        log.line(format!(
            "camera ray at raster ({}, {}), from {} along {}",
            raster.x,
            raster.y,
            vector(ray.origin),
            vector(ray.direction)
        ));
        start
    }

    fn rays<F: Lane>(&self, raster: [F; 2], lens: [F; 2], time: F) -> CameraRays<F> {
        CameraRays::one_by_one(self, raster, lens, time)
    }

    fn connect(&self, point: Vec3, lens: Vec2, time: f32, margin: f32) -> Option<CameraSample> {
        let connection = self.part.connect(point, lens, time, margin);
        self.log.line(match &connection {
            None => "    the camera does not see it".to_owned(),
            Some(c) => format!(
                "    the camera sees it at raster ({}, {}), weight {}",
                c.raster.x, c.raster.y, c.weight
            ),
        });
        connection
    }

    fn intersect_aperture(&self, ray: &Ray, margin: f32) -> Option<ApertureHit> {
        let reception = self.part.intersect_aperture(ray, margin)?;
        let ApertureHit {
            t, raster, weight, ..
        } = &reception;
        self.log.line(format!(
            "    hits the aperture after {t}, seen at raster ({}, {}), weight {weight}",
            raster.x, raster.y
        ));
        Some(reception)
    }

    fn can_connect(&self) -> bool {
        self.part.can_connect()
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
        self.log.write().wavelengths(&wavelengths);
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
        let mut log = self.log.write();
        let walk = walk(log.along(ray.direction));
        log.line(match &hit {
            Some(hit) => format!("{walk}ray of length {}", hit.t),
            None => format!("{walk}ray along {} meets nothing", vector(ray.direction)),
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
        let what = (self.log.describe)(&vertex);
        self.log.write().meet(&vertex, &what, ray.direction);
        vertex
    }

    fn bsdf(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Self::Bsdf<'_> {
        RecordingBsdf {
            model: self.part.bsdf(vertex, wo, wavelengths),
            wavelengths: *wavelengths,
            place: self.log.write().place(vertex),
            log: self.log,
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
        self.log
            .line_at(wavelengths, format!("    emits {}", lanes(radiance)));
        radiance
    }

    fn has_background(&self) -> bool {
        self.part.has_background()
    }

    fn background(&self, direction: Vec3, time: f32, wavelengths: &Wavelengths) -> Vec4 {
        let radiance = self.part.background(direction, time, wavelengths);
        let (along, light) = (vector(direction), lanes(radiance));
        self.log
            .line_at(wavelengths, format!("    sky along {along}: {light}"));
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
        self.log.line_at(wavelengths, sampled(sample.as_ref()));
        sample
    }
}

impl<'a, W: World> World for Recorder<'a, W> {
    type Surfaces = Recording<'a, W::Surfaces>;
    type Lights = Recording<'a, W::Lights>;
    type Media = W::Media;
    type Camera = Recording<'a, W::Camera>;
    type Sensor = Recording<'a, W::Sensor>;

    type Lanes = NoLanes;

    fn lanes(&self) -> Option<&NoLanes> {
        None
    }

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
        let transmission = self.world.transmittance(ray, wavelengths, crossings);
        let along = vector(ray.direction);
        let line = match &transmission {
            None => format!("    blocked along {along}"),
            Some(p) => format!(
                "    arrives along {along}: transmittance {}, probability {}",
                lanes(p.transmittance),
                lanes(p.probability)
            ),
        };
        self.log.line_at(wavelengths, line);
        transmission
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
        self.log.line_at(wavelengths, sampled(sample.as_ref()));
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
        let mut log = self.log.write();
        let begin = emission.as_ref().map(|e| (e.weight, e.ray.direction));
        let (weight, direction) = begin.unwrap_or_default();
        log.wavelengths(wavelengths);
        let walk = walk(Some(log.begin(weight, direction)));
        log.line(match &emission {
            None => format!("{walk}nothing is emitted"),
            Some(e) => format!(
                "{walk}light {} emits {:?} from {} along {}, flux/p {}, densities {} and {}",
                e.light.0,
                e.origin,
                vector(e.ray.origin),
                vector(e.ray.direction),
                lanes(e.weight),
                e.density.origin,
                e.density.ray
            ),
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

    fn background_emission_density(&self, direction: Vec3, time: f32) -> EmissionPdf {
        self.world.background_emission_density(direction, time)
    }

    fn light_sample_density(&self, from: &LightSampleContext, start: &Emission) -> f32 {
        self.world.light_sample_density(from, start)
    }

    fn medium_light_density(&self, medium: MediumId, at: Vec3) -> f32 {
        self.world.medium_light_density(medium, at)
    }
}

/// A sampled light in words.
fn sampled(sample: Option<&LightSample>) -> String {
    match sample {
        None => "    light sampling finds nothing".to_owned(),
        Some(s) => format!(
            "    light {} sampled along {}: {}, {}",
            s.light.0,
            vector(s.direction),
            lanes(s.radiance),
            chance(s.chance)
        ),
    }
}
