//! The compiled scene: everything an integrator may ask, answered.

use crate::measured_shape::MeasuredShape;
use crate::media::SceneMedia;
use crate::media::medium_lights::{LightChoice, MediumLights};
use crate::parts::Parts;
use crate::rays;
use crate::scene_tables::SceneTables;
use crate::space::Space;
use etalon_bsdf::Material;
use etalon_cameras::AnyCamera;
use etalon_lights::LightSet;
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::{Sensor, Wavelengths};
use etalon_subsurface::Homogeneous;
use etalon_transport::{
    Emission, EmissionPdf, LightId, LightKind, LightSample, LightSampleContext, LightVariety,
    MediumId, Ray, RollingShutter, ShadowQuery, SurfaceInteraction, Transmission, World,
};
use glam::{Vec2, Vec3};
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
        camera: AnyCamera<MeasuredShape>,
        lookup: SceneTables,
        materials: Vec<Material>,
        lights: LightSet,
        media: SceneMedia,
        rolling: Option<RollingShutter>,
    ) -> Self {
        let camera_named = media.camera;
        let space = Space::new(lookup, media);
        let mut camera_medium = camera_named;
        let mut outermost = camera_named;
        let mut shining = None;
        // Without media there is nothing to look for.
        if space.has_media {
            camera_medium = space.camera_medium(&camera);
            outermost = space.outermost(&camera, camera_medium);
            shining = MediumLights::find(&space, outermost, lights.total_power());
            rays::take();
        }
        let diffuses = (space.media).any_homogeneous(Homogeneous::diffuses);
        let in_lanes = shining.is_none() && !diffuses;
        let are_null: Vec<bool> = materials.iter().map(Material::has_null).collect();
        let parts = Parts {
            camera,
            rolling,
            in_lanes,
            has_null: are_null.contains(&true),
            are_null,
            lane_kinds: space.lane_kinds(&materials),
            materials,
            lights,
            space,
            camera_medium,
            outermost,
            of_others: 1.0 - shining.as_ref().map_or(0.0, |lights| lights.share),
            shining,
        };
        Self {
            parts: Arc::new(parts),
            sensor: Sensor::default(),
        }
    }
}

impl World for Scene {
    type Surfaces = Parts;
    type Lights = Parts;
    type Media = Parts;
    type Camera = AnyCamera<MeasuredShape>;
    type Sensor = Sensor;
    type Lanes = Parts;

    #[inline]
    fn lanes(&self) -> Option<&Parts> {
        self.parts.in_lanes.then_some(&self.parts)
    }

    #[inline]
    fn surfaces(&self) -> &Parts {
        &self.parts
    }

    #[inline]
    fn lights(&self) -> &Parts {
        &self.parts
    }

    #[inline]
    fn media(&self) -> &Parts {
        &self.parts
    }

    #[inline]
    fn camera(&self) -> &AnyCamera<MeasuredShape> {
        &self.parts.camera
    }

    #[inline]
    fn sensor(&self) -> &Sensor {
        &self.sensor
    }

    #[inline]
    fn moment(&self, raster: Vec2, u: f32) -> f32 {
        match &self.parts.rolling {
            Some(rolling) => rolling.moment(raster.y, u),
            None => u,
        }
    }

    #[inline]
    fn exposure(&self, raster: Vec2, time: f32) -> f32 {
        let rolling = self.parts.rolling.as_ref();
        rolling.map_or(1.0, |rolling| rolling.exposure(raster.y, time))
    }

    #[inline]
    fn transmittance(
        &self,
        ray: &Ray,
        wavelengths: &Wavelengths,
        crossings: u32,
    ) -> Option<Transmission> {
        if self.any_surface_is_opaque() {
            return self.unoccluded_transmission(ray, wavelengths);
        }
        self.transmission_past_null_surfaces(ray, wavelengths, crossings)
    }

    #[inline]
    fn transmittance_batch(
        &self,
        queries: &[ShadowQuery],
        transmissions: &mut [Option<Transmission>],
    ) {
        if self.any_surface_is_opaque() {
            return self.unoccluded_transmissions(queries, transmissions);
        }
        for (query, transmission) in queries.iter().zip(transmissions) {
            *transmission = self.transmittance(&query.ray, &query.wavelengths, query.crossings);
        }
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
        let mut sampled =
            (self.parts.lights).sample(&self.parts.space.lookup, from, wavelengths, u_light, u);
        // In place: it is not copied.
        if let Some(sample) = &mut sampled {
            sample.chance = sample.chance.scaled(self.parts.of_others);
        }
        sampled
    }

    #[inline]
    fn light_variety(&self, from: &LightSampleContext) -> LightVariety {
        if self.parts.shining.is_some() {
            return LightVariety::Several;
        }
        self.parts.lights.light_variety(from)
    }

    #[inline]
    fn light_density(
        &self,
        from: &LightSampleContext,
        at: &SurfaceInteraction,
        _: Vec3,
    ) -> Density<SolidAngle> {
        self.parts
            .lights
            .density(&self.parts.space.lookup, from, at)
            * self.parts.of_others
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
            &self.parts.space.lookup,
            wavelengths,
            u_light,
            u_position,
            u_direction,
            time,
        )?;
        emission.weight /= self.parts.of_others;
        emission.density = self.of_others(emission.density);
        if self.parts.space.has_media {
            emission.ray.medium = self
                .parts
                .space
                .medium_of_emission(&emission, self.outermost())?;
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
        self.of_others(lights.emission_density(
            &self.parts.space.lookup,
            light,
            direction,
            cos,
            time,
        ))
    }

    #[inline]
    fn background_emission_density(&self, direction: Vec3, time: f32) -> EmissionPdf {
        let lights = &self.parts.lights;
        self.of_others(lights.background_emission_density(
            &self.parts.space.lookup,
            direction,
            time,
        ))
    }

    #[inline]
    fn light_sample_density(&self, from: &LightSampleContext, start: &Emission) -> f32 {
        if start.origin == LightKind::Medium {
            return start.density.origin;
        }
        let lights = &self.parts.lights;
        lights.light_sample_density(&self.parts.space.lookup, from, start) * self.parts.of_others
    }

    #[inline]
    fn medium_light_density(&self, medium: MediumId, at: Vec3) -> f32 {
        let shining = self.parts.shining.as_ref();
        shining.map_or(0.0, |lights| {
            lights.density(self.parts.space.media.filling(medium), at)
        })
    }
}
