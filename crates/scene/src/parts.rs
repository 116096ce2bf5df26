//! What a scene is made of: the tables that all its clones share.

use crate::lookup::SceneTables;
use crate::media::SceneMedia;
use crate::medium_lights::MediumLights;
use crate::scene::Scene;
use etalon_bsdf::Material;
use etalon_cameras::AnyCamera;
use etalon_lights::LightSet;
use etalon_spectrum::Sensor;
use etalon_subsurface::MediumAtWavelengths;
use etalon_transport::{EmissionPdf, MediumId, SurfaceInteraction};
use glam::Vec4;
use std::sync::Arc;

/// What scenes share that differ in their sensors.
pub(crate) struct Parts {
    pub(crate) camera: AnyCamera,
    pub(crate) lookup: SceneTables,
    pub(crate) materials: Vec<Material>,
    pub(crate) lights: LightSet,
    /// Whether any material lets light pass straight, so that shadow rays must ask.
    pub(crate) has_null: bool,
    pub(crate) media: SceneMedia,
    /// Whether there are media, so that rays must know what they are in.
    pub(crate) has_media: bool,
    /// The medium beyond everything.
    pub(crate) outermost: MediumId,
    /// Media that are lights.
    pub(crate) shining: Option<MediumLights>,
    /// How often any other light is chosen, and by what its densities are multiplied therefore.
    pub(crate) of_others: f32,
}

impl Scene {
    /// The scene with each of these sensors.
    pub fn with_sensors(self, sensors: Vec<Sensor>) -> Vec<Self> {
        let with = |sensor| Self {
            sensor,
            parts: Arc::clone(&self.parts),
        };
        sensors.into_iter().map(with).collect()
    }

    /// The media.
    pub(crate) fn media(&self) -> &SceneMedia {
        &self.parts.media
    }

    /// A medium at four wavelengths (nm).
    #[inline]
    pub(crate) fn medium_at(
        &self,
        medium: MediumId,
        lambda: Vec4,
    ) -> Option<MediumAtWavelengths<'_, SceneTables>> {
        self.parts.media.at(medium, &self.parts.lookup, lambda)
    }

    /// The medium beyond everything.
    pub(crate) fn outermost(&self) -> MediumId {
        self.parts.outermost
    }

    /// The materials, by id.
    pub(crate) fn materials(&self) -> &[Material] {
        &self.parts.materials
    }

    /// Textures and shapes.
    pub(crate) fn lookup(&self) -> &SceneTables {
        &self.parts.lookup
    }

    /// The densities of a particle from a light that is no medium, the choice included.
    #[inline]
    pub(crate) fn of_others(&self, density: EmissionPdf) -> EmissionPdf {
        EmissionPdf {
            origin: density.origin * self.parts.of_others,
            ..density
        }
    }

    #[inline]
    pub(crate) fn material(&self, vertex: &SurfaceInteraction) -> &Material {
        &self.parts.materials[vertex.material.0 as usize]
    }
}
