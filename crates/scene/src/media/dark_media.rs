//! Media that no light enters through null surfaces, where light sampling is futile.
//!
//! Typically random walks below a surface: the boundary scatters or refracts all light, so every shadow ray from inside ends
//! there. A medium counts as dark only if that is certain.

use crate::media::SceneMedia;
use crate::scene_tables::SceneTables;
use etalon_bsdf::Material;
use etalon_lights::LightDescription;
use etalon_subsurface::Homogeneous;
use etalon_transport::{MediumId, MediumInterface, ShapeId};
use glam::Vec3;

impl SceneMedia {
    /// Finds the media inside closed shapes without a null interaction and without lights in their boxes. `bounded` are the
    /// shapes with their media.
    pub(crate) fn find_dark(
        &mut self,
        bounded: &[(ShapeId, MediumInterface)],
        materials: &[Material],
        lights: &[LightDescription],
        lookup: &SceneTables,
    ) {
        // Bodies end where others begin, and a medium that emits is a lamp.
        let certain = self.bodies().is_none() && self.emitting() == 0;
        let light_boxes: Vec<[Vec3; 2]> = (lights.iter())
            .filter_map(|light| light.light.extent(lookup))
            .map(|extent| [extent.low.as_vec3(), extent.high.as_vec3()])
            .collect();
        let shuts = |shape: ShapeId| {
            let geometry = &lookup.geometry;
            let material = geometry.material_of(shape);
            !geometry.shape(shape).is_open()
                && material.is_some_and(|id| !materials[id.0 as usize].has_null())
        };
        let is_dark = |(index, bounds): (usize, &Option<[Vec3; 2]>)| {
            let within = MediumId(index as u32);
            // A shadow ray does not know where its walk began.
            if self.homogeneous(within).is_some_and(Homogeneous::varies) {
                return true;
            }
            let Some([low, high]) = bounds.filter(|_| certain) else {
                return false;
            };
            let beside = |[from, to]: &[Vec3; 2]| from.cmpgt(high).any() || to.cmplt(low).any();
            let mut holding = bounded
                .iter()
                .filter(|(_, interface)| interface.inside == within);
            holding.all(|(shape, _)| shuts(*shape)) && light_boxes.iter().all(beside)
        };
        let dark: Vec<bool> = self.boxes.iter().enumerate().map(is_dark).collect();
        for (medium, _) in self.media.iter_mut().zip(dark).filter(|(_, dark)| *dark) {
            medium.darken();
        }
    }
}
