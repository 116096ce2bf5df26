//! A world in which everything goes as a path says: whatever is drawn, it is the path's next step.
//!
//! All values and densities are those of the world that it is a script for, and so is every answer that the script has
//! nothing to say of. Its camera receives no particles that run into it: no course ends so.

use crate::course::Course;
use crate::scripted_bsdf::Scripted;
use etalon_math::DeltaProbability;
use etalon_math::lane::Lane;
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::{SensorWeights, Wavelengths};
use etalon_transport::{
    ApertureHit, BsdfOf, Camera, CameraRay, CameraRays, CameraSample, Emission, EmissionPdf, Hit,
    InstanceId, LegacyPhong, LightId, LightKind, LightSample, LightSampleContext, LightVariety,
    Lights, MediumId, NoLanes, Ray, SamplePdf, Sensor, ShadowQuery, ShapeId, SurfaceInteraction,
    Surfaces, Transmission, World,
};
use glam::{Vec2, Vec3, Vec4};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A world by a script.
pub(crate) struct Script<'s, W: World> {
    world: &'s W,
    pub(crate) course: &'s Course,
    camera: Aperture<'s, W>,
    /// Which lane stands first, unless the integrator rotates them.
    turn: usize,
    /// The lane in which the light shines.
    lane: usize,
    /// Which lane stood first when a particle was last emitted.
    first: AtomicUsize,
}

/// A camera by a script.
pub(crate) struct Aperture<'s, W: World> {
    camera: &'s W::Camera,
    course: &'s Course,
}

impl<W: World> Camera for Aperture<'_, W> {
    fn ray(&self, _: Vec2, _: Vec2, _: f32) -> CameraRay {
        CameraRay {
            ray: self.course.ray,
            weight: 1.0,
        }
    }
    fn rays<F: Lane>(&self, raster: [F; 2], lens: [F; 2], time: F) -> CameraRays<F> {
        CameraRays::one_by_one(self, raster, lens, time)
    }

    fn connect(&self, point: Vec3, _: Vec2, time: f32, margin: f32) -> Option<CameraSample> {
        self.camera.connect(point, self.course.lens, time, margin)
    }
    fn can_connect(&self) -> bool {
        self.camera.can_connect()
    }
    fn has_lens(&self) -> bool {
        self.camera.has_lens()
    }
    fn intersect_aperture(&self, _: &Ray, _: f32) -> Option<ApertureHit> {
        None
    }
    fn can_receive(&self) -> bool {
        false
    }
}

impl<'s, W: World> Script<'s, W> {
    /// A script in which lane `turn` stands first and the light shines in `lane` only.
    pub(crate) fn new(world: &'s W, course: &'s Course, turn: usize, lane: usize) -> Self {
        Self {
            world,
            course,
            camera: Aperture {
                camera: world.camera(),
                course,
            },
            turn,
            lane,
            first: AtomicUsize::new(turn),
        }
    }

    /// Which lane stood first when a particle was last emitted.
    pub(crate) fn first(&self) -> usize {
        self.first.load(Ordering::Relaxed)
    }

    /// Which lane of the path each of these wavelengths is.
    fn lanes(&self, wavelengths: &Wavelengths) -> [usize; 4] {
        let own = self.course.wavelengths.lambda.to_array();
        wavelengths.lambda.to_array().map(|lambda| {
            let at = own.iter().position(|other| *other == lambda);
            at.expect("all wavelengths are the path's own")
        })
    }

    /// Values of the path's lanes in the order of these wavelengths.
    fn in_order(&self, values: Vec4, wavelengths: &Wavelengths) -> Vec4 {
        Vec4::from_array(self.lanes(wavelengths).map(|lane| values[lane]))
    }

    /// What of the light shines.
    fn shining(&self, light: Vec4, wavelengths: &Wavelengths) -> Vec4 {
        light * self.in_order(Vec4::AXES[self.lane], wavelengths)
    }

    /// The two nodes between which a ray leads.
    fn between(&self, ray: &Ray) -> Option<[usize; 2]> {
        let course = self.course;
        let last = course.surfaces.len() + 1;
        if course.start.origin.is_infinite() && ray.origin == course.start.ray.origin {
            return Some([0, 1]);
        }
        if ray.origin == course.ray.origin {
            return Some([last, last - 1]);
        }
        let near = |at: Vec3| at.distance_squared(ray.origin) < 1e-4;
        let from = (0..last).find(|node| course.position(*node).is_some_and(near))?;
        let along = |to: &usize| ray.direction.dot(course.direction(from, *to)) > 0.9999;
        let before = from.checked_sub(1);
        let to = before.into_iter().chain([from + 1]).find(along)?;
        Some([from, to])
    }

    /// Which surface of the path a vertex is, counted as nodes are.
    fn node(&self, vertex: &SurfaceInteraction) -> Option<usize> {
        let same = |v: &SurfaceInteraction| v.position == vertex.position;
        self.course.surfaces.iter().position(same).map(|at| at + 1)
    }
}

impl<W: World> Surfaces for Script<'_, W> {
    type Bsdf<'w>
        = Scripted<BsdfOf<'w, W>>
    where
        Self: 'w;

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let [_, to] = self.between(ray)?;
        let surface = match to {
            0 => self.course.lamp.is_some(),
            to => to <= self.course.surfaces.len(),
        };
        surface.then_some(Hit {
            t: 1.0,
            parameters: Vec2::ZERO,
            shape: ShapeId(0),
            primitive: 0,
            instance: InstanceId::NONE,
            slot: to as u32,
        })
    }
    fn intersect_batch(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.intersect(ray);
        }
    }
    fn vertex(&self, _: &Ray, hit: &Hit) -> SurfaceInteraction {
        match (hit.slot, self.course.lamp) {
            (0, Some(lamp)) => lamp,
            (node, _) => self.course.surfaces[node as usize - 1],
        }
    }
    fn bsdf(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Self::Bsdf<'_> {
        let course = self.course;
        let node = self.node(vertex);
        let wi = node.map(|node| {
            let [a, b] = [node - 1, node + 1].map(|to| course.direction(node, to));
            if wo.dot(a) > wo.dot(b) { b } else { a }
        });
        Scripted {
            model: self.world.surfaces().bsdf(vertex, wo, wavelengths),
            wi,
            sharp: node.is_some_and(|node| course.sharp[node - 1]),
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
        0
    }
}

impl<W: World> Lights for Script<'_, W> {
    fn count(&self) -> u32 {
        self.world.lights().count()
    }
    fn is_emitter(&self, hit: &Hit) -> bool {
        hit.slot == 0
    }
    fn emitted(&self, vertex: &SurfaceInteraction, wo: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        match self.node(vertex) {
            Some(_) => Vec4::ZERO,
            None => self.shining(
                self.world.lights().emitted(vertex, wo, wavelengths),
                wavelengths,
            ),
        }
    }
    fn has_background(&self) -> bool {
        true
    }
    fn background(&self, direction: Vec3, time: f32, wavelengths: &Wavelengths) -> Vec4 {
        let sky = self.course.start.origin == LightKind::Sky
            && direction.dot(-self.course.start.ray.direction) > 0.9999;
        if !sky {
            return Vec4::ZERO;
        }
        self.shining(
            (self.world.lights()).background(direction, time, wavelengths),
            wavelengths,
        )
    }
    fn sample_one(
        &self,
        _: LightId,
        _: &LightSampleContext,
        _: &Wavelengths,
        _: Vec2,
    ) -> Option<LightSample> {
        None
    }
}

impl<W: World> Sensor for Script<'_, W> {
    fn wavelengths(&self, _: f32) -> Wavelengths {
        self.course.wavelengths.rotated(self.turn)
    }
    fn weights(&self, wavelengths: &Wavelengths) -> SensorWeights {
        self.world.sensor().weights(wavelengths)
    }
}

impl<'s, W: World> World for Script<'s, W> {
    type Surfaces = Self;
    type Lights = Self;
    type Media = W::Media;
    type Camera = Aperture<'s, W>;
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
    fn media(&self) -> &W::Media {
        self.world.media()
    }
    fn camera(&self) -> &Aperture<'s, W> {
        &self.camera
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
    fn transmittance(&self, ray: &Ray, _: &Wavelengths, _: u32) -> Option<Transmission> {
        let [_, to] = self.between(ray)?;
        let arrives = match self.course.position(to) {
            None => ray.t_max.is_infinite(),
            // Where the camera begins is its own affair.
            Some(_) if to > self.course.surfaces.len() => true,
            Some(at) => ray.at(ray.t_max).distance_squared(at) < 1e-4,
        };
        arrives.then_some(Transmission::FREE)
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
        _: f32,
        _: Vec2,
    ) -> Option<LightSample> {
        let (world, course) = (self.world, self.course);
        if from.position != course.surfaces[0].position {
            return None;
        }
        let start = &course.start;
        let direction = course.direction(1, 0);
        let atom = || {
            SamplePdf::Discrete(DeltaProbability(Vec4::splat(
                world.light_sample_density(from, start),
            )))
        };
        // A light without extent: its intensity, or irradiance.
        let density = start.density;
        let power = self.in_order(start.weight, wavelengths) * density.origin * density.ray;
        let (target, radiance, chance, cos) = match (start.origin, &course.lamp) {
            (LightKind::Surface, Some(lamp)) => (
                Some(lamp.origin_toward(from.position)),
                world.lights().emitted(lamp, -direction, wavelengths),
                SamplePdf::Continuous(world.light_density(from, lamp, direction)),
                lamp.normal.dot(direction).abs(),
            ),
            (LightKind::Sky, _) => (
                None,
                (world.lights()).background(direction, from.time, wavelengths),
                SamplePdf::Continuous(world.background_density(from, direction)),
                1.0,
            ),
            (LightKind::Parallel, _) => (None, power, atom(), 1.0),
            _ => {
                let at = start.point.position;
                let radiance = power / at.distance_squared(from.position);
                (Some(at), radiance, atom(), 1.0)
            }
        };
        // What light sampling never finds is left to the others.
        (chance.lanes().x > 0.0).then(|| LightSample {
            direction,
            target,
            radiance: self.shining(radiance, wavelengths),
            chance,
            cos,
            origin: start.origin,
            extinction: start.extinction,
            light: start.light,
        })
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
        _: f32,
        _: Vec2,
        _: Vec2,
        _: f32,
    ) -> Option<Emission> {
        self.first
            .store(self.lanes(wavelengths)[0], Ordering::Relaxed);
        let weight = self.in_order(self.course.start.weight, wavelengths);
        Some(Emission {
            weight: self.shining(weight, wavelengths),
            ..self.course.start
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
        self.world.background_emission_density(direction, time)
    }
    fn light_sample_density(&self, from: &LightSampleContext, start: &Emission) -> f32 {
        self.world.light_sample_density(from, start)
    }
    fn medium_light_density(&self, medium: MediumId, at: Vec3) -> f32 {
        self.world.medium_light_density(medium, at)
    }
}
