//! The surfaces of a scene and their scattering models.

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

    /// The classic Phong material at a vertex, if it has one instead of a BSDF ([`Surfaces::bsdf`] is black then).
    fn legacy_phong(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Option<LegacyPhong>;

    /// Rays traced by the calling thread since its last call.
    fn take_ray_count(&self) -> u64;
}
