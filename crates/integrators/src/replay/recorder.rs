//! A world that answers as another does, and writes down what it said.

use super::Event;
use crate::prefix::Prefix;
use etalon_math::{Density, Frame, SolidAngle};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, BsdfSample, Camera, CameraRay, ClassicPhong, Connection, Emission, EmissionDensity, Hit,
    LightId, LightSample, Mode, Passage, Ray, Receiver, Reception, ShapeId, Vertex, World,
};
use glam::{Vec2, Vec3, Vec4};
use std::sync::{Arc, Mutex, PoisonError};

/// What has been said so far.
#[derive(Default)]
struct Notes {
    events: Vec<Event>,
    walks: Vec<Walk>,
    met: Vec<Met>,
    /// The direction that a scattering model was asked for last, and where.
    asked: Option<(Vec3, Place)>,
}

/// A walk from surface to surface.
struct Walk {
    /// Value and densities; `None` where the estimator drew a direction by itself.
    prefix: Option<Prefix>,
    /// Where it goes next.
    direction: Vec3,
}

/// A walk's arrival at a surface.
#[derive(Clone, Copy)]
struct Place {
    walk: usize,
    prefix: Option<Prefix>,
}

/// A surface that was met.
struct Met {
    position: Vec3,
    shape: ShapeId,
    place: Option<Place>,
}

impl Notes {
    /// Begins a walk.
    fn begin(&mut self, value: Vec4, direction: Vec3) -> usize {
        let mut prefix = Prefix::START;
        prefix.value = value;
        let prefix = Some(prefix);
        self.walks.push(Walk { prefix, direction });
        self.walks.len() - 1
    }

    /// The walk that goes along a direction: sampled, or else only asked for.
    fn along(&mut self, direction: Vec3) -> Option<Place> {
        let sampled = self.walks.iter().rposition(|w| w.direction == direction);
        let walk = sampled.or_else(|| {
            let (_, place) = self.asked.filter(|(wi, _)| *wi == direction)?;
            self.walks[place.walk] = Walk {
                prefix: None,
                direction,
            };
            Some(place.walk)
        })?;
        let prefix = self.walks[walk].prefix;
        Some(Place { walk, prefix })
    }
}

/// A notebook that many may write to.
#[derive(Clone, Default)]
struct Notebook(Arc<Mutex<Notes>>);

impl Notebook {
    fn write<T>(&self, change: impl FnOnce(&mut Notes) -> T) -> T {
        change(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn note(&self, event: Event) {
        self.write(|notes| notes.events.push(event));
    }
}

/// A world that writes down what it says.
pub(super) struct Recorder<'a, W: World> {
    world: &'a W,
    camera: RecordingCamera<'a, W::Camera>,
    notebook: Notebook,
}

impl<'a, W: World> Recorder<'a, W> {
    /// With nothing written yet.
    pub(super) fn new(world: &'a W) -> Self {
        let notebook = Notebook::default();
        let camera = RecordingCamera {
            camera: world.camera(),
            notebook: notebook.clone(),
        };
        Self {
            world,
            camera,
            notebook,
        }
    }

    /// Everything that was said.
    pub(super) fn into_events(self) -> Vec<Event> {
        self.notebook
            .write(|notes| std::mem::take(&mut notes.events))
    }
}

/// A camera that writes down what it says.
pub(super) struct RecordingCamera<'a, C> {
    camera: &'a C,
    notebook: Notebook,
}

impl<C: Camera> Camera for RecordingCamera<'_, C> {
    fn ray(&self, raster: Vec2, lens: Vec2, time: f32) -> CameraRay {
        let start = self.camera.ray(raster, lens, time);
        self.notebook.write(|notes| {
            let walk = notes.begin(Vec4::splat(start.weight), start.ray.direction);
            let ray = start.ray;
            notes.events.push(Event::CameraRay { walk, raster, ray });
        });
        start
    }

    fn connect(&self, point: Vec3, lens: Vec2, margin: f32) -> Option<Connection> {
        let connection = self.camera.connect(point, lens, margin);
        self.notebook.note(Event::Connection(connection));
        connection
    }

    fn receive(&self, ray: &Ray, margin: f32) -> Option<Reception> {
        let reception = self.camera.receive(ray, margin)?;
        self.notebook.note(Event::Reception(reception));
        Some(reception)
    }

    fn can_receive(&self) -> bool {
        self.camera.can_receive()
    }

    fn has_lens(&self) -> bool {
        self.camera.has_lens()
    }
}

/// A scattering model that writes down what it says.
#[derive(Clone, Copy)]
pub(super) struct RecordingBsdf<'a, B> {
    model: B,
    place: Option<Place>,
    notebook: &'a Notebook,
}

impl<B> RecordingBsdf<'_, B> {
    fn evaluated(&self, wi: Vec3, value: Vec4, density: Option<Density<SolidAngle>>) {
        self.notebook.write(|notes| {
            notes.asked = self.place.map(|place| (wi, place));
            notes.events.push(Event::Evaluated { wi, value, density });
        });
    }

    /// A direction was found that leads on from `place`.
    fn scattered(&self, place: Option<Place>, sample: Option<BsdfSample>) {
        self.notebook.write(|notes| {
            if let (Some(Place { walk, prefix }), Some(sample)) = (place, &sample) {
                let direction = sample.wi;
                notes.walks[walk] = Walk { prefix, direction };
            }
            notes.events.push(Event::Scattered {
                walk: place.map(|place| place.walk),
                sample,
                prefix: place.and_then(|place| place.prefix),
            });
        });
    }
}

impl<B: Bsdf> Bsdf for RecordingBsdf<'_, B> {
    fn eval(&self, wo: Vec3, wi: Vec3, mode: Mode) -> Vec4 {
        let value = self.model.eval(wo, wi, mode);
        self.evaluated(wi, value, None);
        value
    }

    fn density(&self, wo: Vec3, wi: Vec3) -> Density<SolidAngle> {
        self.model.density(wo, wi)
    }

    fn eval_and_density(&self, wo: Vec3, wi: Vec3, mode: Mode) -> (Vec4, Density<SolidAngle>) {
        let (value, density) = self.model.eval_and_density(wo, wi, mode);
        self.evaluated(wi, value, Some(density));
        (value, density)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        let sample = self.model.sample(wo, u_lobe, u, mode);
        let place = self.place.map(|mut place| {
            if let (Some(prefix), Some(sample)) = (&mut place.prefix, &sample) {
                prefix.extend(sample.value, sample.chance.lanes());
            }
            place
        });
        self.scattered(place, sample);
        sample
    }

    fn discrete(&self, wo: Vec3, index: u32, mode: Mode) -> Option<BsdfSample> {
        let sample = self.model.discrete(wo, index, mode);
        if sample.is_some() {
            // All are followed: none has a probability by which to divide.
            let place = self.place.map(|place| Place {
                prefix: None,
                ..place
            });
            self.scattered(place, sample);
        }
        sample
    }

    fn has_continuous(&self) -> bool {
        self.model.has_continuous()
    }

    fn has_discrete(&self) -> bool {
        self.model.has_discrete()
    }

    fn hemisphere(&self) -> Option<Frame> {
        self.model.hemisphere()
    }

    fn passing(&self) -> Vec4 {
        self.model.passing()
    }

    fn passing_probability(&self) -> Vec4 {
        self.model.passing_probability()
    }

    fn albedo(&self, wo: Vec3) -> Vec4 {
        self.model.albedo(wo)
    }
}

impl<'a, W: World> World for Recorder<'a, W> {
    type Bsdf<'w>
        = RecordingBsdf<'w, W::Bsdf<'w>>
    where
        Self: 'w;
    type Camera = RecordingCamera<'a, W::Camera>;

    fn camera(&self) -> &Self::Camera {
        &self.camera
    }

    fn wavelengths(&self, u: f32) -> Wavelengths {
        let wavelengths = self.world.wavelengths(u);
        self.notebook.note(Event::Wavelengths(wavelengths));
        wavelengths
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let hit = self.world.intersect(ray);
        self.notebook.write(|notes| {
            let walk = notes.along(ray.direction).map(|place| place.walk);
            let hit = hit.as_ref().map(|hit| hit.t);
            notes.events.push(Event::Ray {
                walk,
                ray: *ray,
                hit,
            });
        });
        hit
    }

    fn vertex(&self, ray: &Ray, hit: &Hit) -> Vertex {
        let vertex = self.world.vertex(ray, hit);
        self.notebook.write(|notes| {
            let place = notes.along(ray.direction);
            notes.met.push(Met {
                position: vertex.position,
                shape: vertex.shape,
                place,
            });
            notes.events.push(Event::Vertex {
                walk: place.map(|place| place.walk),
                vertex: Box::new(vertex),
                prefix: place.and_then(|place| place.prefix),
            });
        });
        vertex
    }

    fn passage(&self, ray: &Ray, wavelengths: &Wavelengths, crossings: u32) -> Option<Passage> {
        let passage = self.world.passage(ray, wavelengths, crossings);
        self.notebook.note(Event::Passage(*ray, passage));
        passage
    }

    fn bsdf(&self, vertex: &Vertex, wo: Vec3, wavelengths: &Wavelengths) -> Self::Bsdf<'_> {
        let place = self.notebook.write(|notes| {
            let mut met = notes.met.iter().rev();
            met.find(|met| met.position == vertex.position && met.shape == vertex.shape)
                .and_then(|met| met.place)
        });
        RecordingBsdf {
            model: self.world.bsdf(vertex, wo, wavelengths),
            place,
            notebook: &self.notebook,
        }
    }

    fn classic(&self, vertex: &Vertex, wavelengths: &Wavelengths) -> Option<ClassicPhong> {
        self.world.classic(vertex, wavelengths)
    }

    fn emitted(&self, vertex: &Vertex, wo: Vec3, wavelengths: &Wavelengths) -> Vec4 {
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
        from: &Receiver,
        wavelengths: &Wavelengths,
        u_light: f32,
        u: Vec2,
    ) -> Option<LightSample> {
        let sample = self.world.sample_light(from, wavelengths, u_light, u);
        self.notebook.note(Event::Light(sample));
        sample
    }

    fn light_count(&self) -> u32 {
        self.world.light_count()
    }

    fn sample_one_light(
        &self,
        light: LightId,
        from: &Receiver,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        let sample = self.world.sample_one_light(light, from, wavelengths, u);
        self.notebook.note(Event::Light(sample));
        sample
    }

    fn light_density(&self, from: &Receiver, at: &Vertex, direction: Vec3) -> Density<SolidAngle> {
        self.world.light_density(from, at, direction)
    }

    fn background_density(&self, from: &Receiver, direction: Vec3) -> Density<SolidAngle> {
        self.world.background_density(from, direction)
    }

    fn emit(
        &self,
        wavelengths: &Wavelengths,
        u_light: f32,
        u_position: Vec2,
        u_direction: Vec2,
    ) -> Option<Emission> {
        let emission = self
            .world
            .emit(wavelengths, u_light, u_position, u_direction);
        self.notebook.write(|notes| {
            let (value, direction) = emission
                .as_ref()
                .map_or((Vec4::ZERO, Vec3::ZERO), |e| (e.weight, e.ray.direction));
            let walk = notes.begin(value, direction);
            notes.events.push(Event::Emitted { walk, emission });
        });
        emission
    }

    fn emission_density(&self, light: LightId, direction: Vec3, cos: f32) -> EmissionDensity {
        self.world.emission_density(light, direction, cos)
    }

    fn background_emission_density(&self, direction: Vec3) -> EmissionDensity {
        self.world.background_emission_density(direction)
    }

    fn sampled_density(&self, from: &Receiver, start: &Emission) -> f32 {
        self.world.sampled_density(from, start)
    }

    fn take_ray_count(&self) -> u64 {
        self.world.take_ray_count()
    }
}
