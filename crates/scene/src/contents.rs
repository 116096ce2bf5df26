//! What a scene has, for people and for estimators.

use crate::camera_probe;
use crate::rays;
use crate::scene::Scene;
use etalon_bsdf::Material;
use etalon_geometry::GeometryStatistics;
use etalon_subsurface::{Homogeneous, MediumAtWavelengths};
use etalon_transport::{
    Camera, Lights, Media, Medium, RowExposure, SceneCapabilities, Sensor, World,
};
use glam::{UVec2, Vec3};

/// How much there is in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contents {
    /// Shapes, triangles, instances, nodes of accelerators, and their memory.
    pub geometry: GeometryStatistics,
    /// Materials.
    pub materials: usize,
    /// Lights that are no media.
    pub lights: usize,
    /// Textures and spectra.
    pub textures: usize,
    /// Pictures that textures look up.
    pub pictures: usize,
    /// Memory of their pixels (bytes).
    pub picture_bytes: usize,
}

impl Scene {
    /// How much there is.
    pub fn contents(&self) -> Contents {
        let (pictures, picture_bytes) = self.parts.space.lookup.textures.pictures();
        Contents {
            geometry: self.parts.space.lookup.geometry.statistics(),
            materials: self.parts.materials.len(),
            lights: self.parts.lights.len(),
            textures: self.parts.space.lookup.textures.len(),
            pictures,
            picture_bytes,
        }
    }

    /// Whether what is beyond everything is a medium without end that light does not come through.
    fn is_swallowed(&self) -> bool {
        let (media, outermost) = (&self.parts.space.media, self.outermost());
        let is_there = |medium: MediumAtWavelengths<'_, _>| {
            let coefficients = medium.coefficients(Vec3::ZERO, Vec3::Z);
            coefficients.extinction().min_element() > 0.0
        };
        let medium = self
            .media()
            .enter(outermost, None, &self.sensor().wavelengths(0.5));
        media.is_endless(outermost) && medium.is_some_and(is_there)
    }

    /// What an estimator can see of it, through the film's window of `size` pixels from `origin`.
    pub fn capabilities(&self, origin: UVec2, size: UVec2) -> SceneCapabilities {
        let view = camera_probe::look(self, origin, size);
        // The rays of the probe do not count.
        rays::take();
        // Paths run into matter that shines.
        let mut lights = self.parts.lights.count();
        let shining = self.parts.space.media.emitting();
        for count in [&mut lights.all, &mut lights.hittable, &mut lights.either] {
            *count += shining;
        }
        lights.chosen += self.parts.space.media.emitting_bounds().count() as u32;
        SceneCapabilities {
            view,
            lights,
            unconnected_camera: !self.parts.camera.can_connect(),
            aperture: self.parts.camera.can_receive(),
            sky: self.lights().has_background(),
            swallowed: self.parts.lights.has_infinite() && self.is_swallowed(),
            media: self.parts.space.media.any(),
            diffusion: self
                .parts
                .space
                .media
                .any_homogeneous(Homogeneous::diffuses),
            textured_random_walk: self.parts.space.media.any_homogeneous(Homogeneous::varies),
            endless: self.parts.space.lookup.geometry.is_endless()
                && self.parts.lights.has_infinite(),
            narrow_filter: false,
            rows: (self.parts.rolling).map_or(RowExposure::Together, |rolling| rolling.rows()),
            one_way: self.parts.materials.iter().any(Material::is_one_way),
            classic: self.parts.materials.iter().any(Material::is_classic),
        }
    }
}
