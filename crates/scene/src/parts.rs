//! The parts of a scene, which all its clones share, as surfaces, lights and media.

mod lanes;
mod lights;
mod media;
mod surfaces;

use crate::measured_shape::MeasuredShape;
use crate::media::medium_lights::MediumLights;
use crate::scene::Scene;
use crate::space::Space;
use etalon_bsdf::Material;
use etalon_cameras::AnyCamera;
use etalon_lights::LightSet;
use etalon_spectrum::Sensor;
use etalon_transport::{EmissionPdf, LaneKind, MediumId, RollingShutter};
use std::sync::Arc;

/// The parts that scenes with different sensors share.
pub struct Parts {
    pub(crate) camera: AnyCamera<MeasuredShape>,
    /// How rows of the picture are exposed, if not all at once.
    pub(crate) rolling: Option<RollingShutter>,
    /// Whether vertices are shaded in vector lanes: where no medium shines or has a diffusion profile.
    pub(crate) in_lanes: bool,
    pub(crate) space: Space,
    pub(crate) materials: Vec<Material>,
    /// The kinds of the points of each shape.
    pub(crate) lane_kinds: Vec<Option<LaneKind>>,
    pub(crate) lights: LightSet,
    /// Whether any material has a null interaction, so that shadow rays must evaluate materials.
    pub(crate) has_null: bool,
    /// Which of the materials do.
    pub(crate) are_null: Vec<bool>,
    /// The medium that the camera is in, with the bodies that it is in.
    pub(crate) camera_medium: MediumId,
    /// The outermost medium.
    pub(crate) outermost: MediumId,
    /// Media that are lights.
    pub(crate) shining: Option<MediumLights>,
    /// Probability of choosing a light that is not a medium: the factor on the densities of those.
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

    /// The outermost medium.
    pub(crate) fn outermost(&self) -> MediumId {
        self.parts.outermost
    }

    /// The densities of a particle from a light that is no medium, the choice included.
    #[inline]
    pub(crate) fn of_others(&self, density: EmissionPdf) -> EmissionPdf {
        EmissionPdf {
            origin: density.origin * self.parts.of_others,
            ..density
        }
    }
}
