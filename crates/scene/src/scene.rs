//! The compiled scene: everything an integrator may ask, answered.

use crate::lookup::SceneTables;
use crate::media::SceneMedia;
use crate::medium_lights::{LightChoice, MediumLights};
use crate::parts::Parts;
use crate::rays;
use etalon_bsdf::{BsdfAtPoint, Material};
use etalon_cameras::AnyCamera;
use etalon_lights::LightSet;
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::{Sensor, SensorWeights, Wavelengths};
use etalon_subsurface::MediumAtWavelengths;
use etalon_transport::{
    Coefficients, DiffusionProfile, Emission, EmissionPdf, Hit, LegacyPhong, LightId, LightKind,
    LightSample, LightSampleContext, LightVariety, MediumId, Ray, SurfaceInteraction, Transmission,
    World,
};
use glam::{Vec2, Vec3, Vec4};
use std::sync::Arc;

/// A scene: immutable, shared by all threads. Cloning is cheap: clones share all but their sensor.
#[derive(Clone)]
pub struct Scene {
    pub(crate) parts: Arc<Parts>,
    pub(crate) sensor: Sensor,
}

impl Scene {
    /// Puts a scene together, with the standard sensor.
    pub fn new(
        camera: AnyCamera,
        lookup: SceneTables,
        materials: Vec<Material>,
        lights: LightSet,
        media: SceneMedia,
    ) -> Self {
        let has_null = materials.iter().any(Material::has_null);
        let parts = Parts {
            camera,
            lookup,
            materials,
            lights,
            has_null,
            has_media: media.exist(),
            outermost: media.camera,
            media,
            shining: None,
            of_others: 1.0,
        };
        let mut scene = Self {
            parts: Arc::new(parts),
            sensor: Sensor::default(),
        };
        // Without media there is nothing to look for.
        if !scene.parts.has_media {
            return scene;
        }
        let camera = scene.find_camera_medium();
        if let Some(parts) = Arc::get_mut(&mut scene.parts) {
            parts.media.camera = camera;
        }
        let outermost = scene.find_outermost();
        if let Some(parts) = Arc::get_mut(&mut scene.parts) {
            parts.outermost = outermost;
        }
        let shining = MediumLights::find(&scene, scene.parts.lights.total_power());
        rays::take();
        if let Some(parts) = Arc::get_mut(&mut scene.parts) {
            parts.of_others = 1.0 - shining.as_ref().map_or(0.0, |lights| lights.share);
            parts.shining = shining;
        }
        scene
    }
}

impl World for Scene {
    type Bsdf<'w> = BsdfAtPoint<'w>;
    type Medium<'w> = MediumAtWavelengths<'w, SceneTables>;
    type Camera = AnyCamera;

    fn camera(&self) -> &AnyCamera {
        &self.parts.camera
    }

    #[inline]
    fn wavelengths(&self, u: f32) -> Wavelengths {
        self.sensor.sample(u)
    }

    #[inline]
    fn sensor(&self, wavelengths: &Wavelengths) -> SensorWeights {
        self.sensor.weights(wavelengths)
    }

    #[inline]
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        rays::count();
        self.parts.lookup.geometry.intersect(ray)
    }

    #[inline]
    fn vertex(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        let mut vertex = self.parts.lookup.geometry.vertex(ray, hit);
        if self.parts.has_media {
            let outside = ray.direction.dot(vertex.normal) < 0.0;
            vertex.media = (self.parts.media).around(hit.shape, ray.medium, outside);
        }
        vertex
    }

    #[inline]
    fn camera_medium(&self) -> MediumId {
        self.parts.media.camera
    }

    #[inline]
    fn medium(&self, medium: MediumId, wavelengths: &Wavelengths) -> Option<Self::Medium<'_>> {
        self.medium_at(medium, wavelengths.lambda)
    }

    #[inline]
    fn is_dark(&self, medium: MediumId) -> bool {
        self.parts.media.is_dark(medium)
    }

    #[inline]
    fn entry(
        &self,
        medium: MediumId,
        at: &SurfaceInteraction,
        wavelengths: &Wavelengths,
    ) -> Option<Coefficients> {
        (self.parts.media).entry(medium, &self.parts.lookup, at, wavelengths.lambda)
    }

    #[inline]
    fn entered(
        &self,
        medium: MediumId,
        coefficients: Coefficients,
        wavelengths: &Wavelengths,
    ) -> Option<Self::Medium<'_>> {
        let Parts { media, lookup, .. } = &*self.parts;
        media.entered(medium, coefficients, lookup, wavelengths.lambda)
    }

    #[inline]
    fn diffusion(
        &self,
        medium: MediumId,
        at: &SurfaceInteraction,
        wavelengths: &Wavelengths,
    ) -> Option<impl DiffusionProfile> {
        (self.parts.media).profile(medium, &self.parts.lookup, at, wavelengths.lambda)
    }

    #[inline]
    fn transmittance(
        &self,
        ray: &Ray,
        wavelengths: &Wavelengths,
        crossings: u32,
    ) -> Option<Transmission> {
        if !self.parts.has_null && self.parts.media.bodies().is_none() {
            return self.clear_passage(ray, wavelengths);
        }
        self.passage_through(*ray, wavelengths, crossings)
    }

    #[inline]
    fn bsdf(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> BsdfAtPoint<'_> {
        let own = self
            .material(vertex)
            .resolve(&self.parts.lookup, vertex, wo, wavelengths);
        match self.parts.media.bodies() {
            None => own,
            Some(bodies) => self.between_bodies(bodies, own, vertex, wo, wavelengths),
        }
    }

    fn legacy_phong(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Option<LegacyPhong> {
        self.material(vertex)
            .legacy_phong(&self.parts.lookup, vertex, wo, wavelengths)
    }

    #[inline]
    fn emitted(&self, vertex: &SurfaceInteraction, wo: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        self.parts
            .lights
            .emitted(&self.parts.lookup, vertex, wo, wavelengths)
    }

    #[inline]
    fn is_emitter(&self, hit: &Hit) -> bool {
        self.parts.lookup.geometry.light(hit).is_some()
    }

    #[inline]
    fn background(&self, direction: Vec3, wavelengths: &Wavelengths) -> Vec4 {
        self.parts
            .lights
            .background(&self.parts.lookup, direction, wavelengths)
    }

    #[inline]
    fn has_background(&self) -> bool {
        self.parts.lights.has_background()
    }

    #[inline]
    fn sample_light(
        &self,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u_light: f32,
        u: Vec2,
    ) -> Option<LightSample> {
        let u_light = match LightChoice::new(self.parts.shining.as_ref(), u_light) {
            LightChoice::Medium(lights, u_light) => {
                return self.sample_medium(lights, from, wavelengths, u_light, u);
            }
            LightChoice::Other(u_light) => u_light,
        };
        let mut sample =
            (self.parts.lights).sample(&self.parts.lookup, from, wavelengths, u_light, u)?;
        sample.chance = sample.chance.scaled(self.parts.of_others);
        Some(sample)
    }

    #[inline]
    fn light_variety(&self, from: &LightSampleContext) -> LightVariety {
        if self.parts.shining.is_some() {
            return LightVariety::Several;
        }
        self.parts.lights.light_variety(from)
    }

    fn light_count(&self) -> u32 {
        self.parts.lights.len() as u32
    }

    #[inline]
    fn sample_one_light(
        &self,
        light: LightId,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        self.parts
            .lights
            .sample_one(&self.parts.lookup, light, from, wavelengths, u)
    }

    #[inline]
    fn light_density(
        &self,
        from: &LightSampleContext,
        at: &SurfaceInteraction,
        _: Vec3,
    ) -> Density<SolidAngle> {
        self.parts.lights.density(&self.parts.lookup, from, at) * self.parts.of_others
    }

    #[inline]
    fn background_density(
        &self,
        from: &LightSampleContext,
        direction: Vec3,
    ) -> Density<SolidAngle> {
        self.parts.lights.background_density(from, direction) * self.parts.of_others
    }

    #[inline]
    fn emit(
        &self,
        wavelengths: &Wavelengths,
        u_light: f32,
        u_position: Vec2,
        u_direction: Vec2,
        time: f32,
    ) -> Option<Emission> {
        let u_light = match LightChoice::new(self.parts.shining.as_ref(), u_light) {
            LightChoice::Medium(lights, u_light) => {
                let u = [u_position, u_direction];
                return self.emit_from_medium(lights, wavelengths, u_light, u, time);
            }
            LightChoice::Other(u_light) => u_light,
        };
        let mut emission = self.parts.lights.emit(
            &self.parts.lookup,
            wavelengths,
            u_light,
            u_position,
            u_direction,
            time,
        )?;
        emission.weight /= self.parts.of_others;
        emission.density = self.of_others(emission.density);
        if self.parts.has_media {
            emission.ray.medium = self.medium_of_emission(&emission)?;
        }
        Some(emission)
    }

    #[inline]
    fn emission_density(
        &self,
        light: LightId,
        direction: Vec3,
        cos: f32,
        time: f32,
    ) -> EmissionPdf {
        let lights = &self.parts.lights;
        self.of_others(lights.emission_density(&self.parts.lookup, light, direction, cos, time))
    }

    #[inline]
    fn background_emission_density(&self, direction: Vec3) -> EmissionPdf {
        let lights = &self.parts.lights;
        self.of_others(lights.background_emission_density(&self.parts.lookup, direction))
    }

    #[inline]
    fn light_sample_density(&self, from: &LightSampleContext, start: &Emission) -> f32 {
        if start.origin == LightKind::Medium {
            return start.density.origin;
        }
        let lights = &self.parts.lights;
        lights.light_sample_density(&self.parts.lookup, from, start) * self.parts.of_others
    }

    #[inline]
    fn medium_light_density(&self, medium: MediumId, at: Vec3) -> f32 {
        let shining = self.parts.shining.as_ref();
        shining.map_or(0.0, |lights| {
            lights.density(self.parts.media.filling(medium), at)
        })
    }

    fn take_ray_count(&self) -> u64 {
        rays::take()
    }
}
