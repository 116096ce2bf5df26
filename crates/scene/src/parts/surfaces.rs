//! The surfaces of a scene.

use super::Parts;
use crate::rays;
use etalon_bsdf::{BsdfAtPoint, Material};
use etalon_spectrum::Wavelengths;
use etalon_transport::{Hit, LegacyPhong, Ray, SurfaceInteraction, Surfaces};
use glam::Vec3;

impl Parts {
    #[inline]
    fn material(&self, vertex: &SurfaceInteraction) -> &Material {
        &self.materials[vertex.material.0 as usize]
    }
}

impl Surfaces for Parts {
    type Bsdf<'w> = BsdfAtPoint<'w>;

    #[inline]
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.space.intersect(ray)
    }

    #[inline]
    fn intersect_batch(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        self.space.intersect_batch(rays, hits);
    }

    #[inline]
    fn vertex(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        self.space.vertex(ray, hit)
    }

    #[inline]
    fn bsdf(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> BsdfAtPoint<'_> {
        // Returned as it is made: a model is too large to be copied at every vertex.
        let Some(bodies) = self.space.media.bodies() else {
            return (self.material(vertex)).resolve(&self.space.lookup, vertex, wo, wavelengths);
        };
        let own = (self.material(vertex)).resolve(&self.space.lookup, vertex, wo, wavelengths);
        self.between_bodies(bodies, own, vertex, wo, wavelengths)
    }

    fn legacy_phong(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Option<LegacyPhong> {
        self.material(vertex)
            .legacy_phong(&self.space.lookup, vertex, wo, wavelengths)
    }

    fn take_ray_count(&self) -> u64 {
        rays::take()
    }
}
