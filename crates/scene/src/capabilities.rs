//! What a scene has, for people and for estimators.

use crate::scene::Scene;
use crate::{rays, view};
use etalon_bsdf::Material;
use etalon_subsurface::{Homogeneous, MediumAtWavelengths};
use etalon_transport::{Camera, Medium, SceneCapabilities, World};
use glam::{UVec2, Vec3};

impl Scene {
    /// How much there is, for people.
    pub fn summary(&self) -> String {
        let s = self.parts.lookup.geometry.statistics();
        format!(
            "shapes       {} ({} triangles)\ninstances    {} ({} triangles)\n\
             accelerator  {} nodes; geometry takes {:.1} MiB\nmaterials    {}\nlights       {}\n",
            s.shapes,
            s.triangles,
            s.instances,
            s.instanced_triangles,
            s.nodes,
            s.bytes as f64 / f64::from(1 << 20),
            self.parts.materials.len(),
            self.parts.lights.len(),
        )
    }

    /// Whether what is beyond everything is a medium without end that light does not come through.
    fn is_swallowed(&self) -> bool {
        let (media, outermost) = (self.media(), self.outermost());
        let is_there = |medium: MediumAtWavelengths<'_, _>| {
            let coefficients = medium.coefficients(Vec3::ZERO, Vec3::Z);
            coefficients.extinction().min_element() > 0.0
        };
        let medium = self.medium(outermost, &self.wavelengths(0.5));
        media.is_endless(outermost) && medium.is_some_and(is_there)
    }

    /// What an estimator can see of it, through the film's window of `size` pixels from `origin`.
    pub fn sight(&self, origin: UVec2, size: UVec2) -> SceneCapabilities {
        let view = view::look(self, origin, size);
        // Nobody asked for these rays.
        rays::take();
        // Paths run into matter that shines.
        let mut lights = self.parts.lights.count();
        let shining = self.parts.media.emitting();
        for count in [&mut lights.all, &mut lights.hittable, &mut lights.either] {
            *count += shining;
        }
        lights.chosen += self.parts.media.emitting_bounds().count() as u32;
        SceneCapabilities {
            view,
            lights,
            aperture: self.parts.camera.can_receive(),
            sky: self.has_background(),
            swallowed: self.parts.lights.has_infinite() && self.is_swallowed(),
            media: self.parts.media.any(),
            diffusion: self.parts.media.any_homogeneous(Homogeneous::diffuses),
            textured_walk: self.parts.media.any_homogeneous(Homogeneous::varies),
            endless: self.parts.lookup.geometry.is_endless() && self.parts.lights.has_infinite(),
            narrow_filter: false,
            one_way: self.parts.materials.iter().any(Material::is_one_way),
            classic: self.parts.materials.iter().any(Material::is_classic),
        }
    }
}
