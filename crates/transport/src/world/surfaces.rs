//! The surfaces of a scene, and what they do to light.

use crate::{Bsdf, Hit, LegacyPhong, Ray, SurfaceInteraction};
use etalon_spectrum::Wavelengths;
use glam::Vec3;

/// Surfaces and their materials.
pub trait Surfaces: Sync {
    /// A scattering model at a point.
    type Bsdf<'w>: Bsdf + Copy
    where
        Self: 'w;

    /// The nearest surface along a ray.
    fn intersect(&self, ray: &Ray) -> Option<Hit>;

    /// The nearest surfaces along many rays: as many `hits` as `rays`.
    fn intersect_batch(&self, rays: &[Ray], hits: &mut [Option<Hit>]);

    /// The differential geometry of a hit, with the media on both sides.
    fn vertex(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction;

    /// The scattering model at a vertex.
    fn bsdf(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Self::Bsdf<'_>;

    /// The classic Phong material at a vertex, if it has one in place of a scattering model (its [`Surfaces::bsdf`] is black).
    fn legacy_phong(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Option<LegacyPhong>;

    /// How many rays the calling thread has traced since it last asked.
    fn take_ray_count(&self) -> u64;
}
