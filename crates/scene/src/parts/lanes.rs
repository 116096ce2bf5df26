//! Vertices of a scene that are shaded in vector lanes.

use super::Parts;
use etalon_bsdf::LaneBsdfAtPoint;
use etalon_math::lane::Lane;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Hit, LaneKind, LaneLightSample, LaneReceiver, LaneShading, LaneSurface, LaneVertices, Ray,
    ShapeId, TexturePoint,
};

impl LaneShading for Parts {
    type Bsdf<'a, F: Lane> = LaneBsdfAtPoint<'a, F>;

    #[inline]
    fn kind(&self, hit: &Hit) -> Option<LaneKind> {
        self.lane_kinds[hit.shape.0 as usize]
    }

    #[inline(always)] // Vectors would go through memory.
    fn surfaces<'h, F: Lane>(
        &self,
        ray: impl Fn(usize) -> &'h Ray,
        hit: impl Fn(usize) -> &'h Hit,
    ) -> LaneSurface<F> {
        self.space.lookup.geometry.surfaces(ray, hit)
    }

    #[inline]
    fn texture_point(&self, ray: &Ray, hit: &Hit) -> TexturePoint {
        self.space.lookup.geometry.texture_point(ray, hit)
    }

    #[inline]
    fn bsdf<F: Lane>(
        &self,
        kind: LaneKind,
        shape: impl Fn(usize) -> ShapeId,
        vertices: LaneVertices<'_, F>,
        wo: F::Vector,
    ) -> LaneBsdfAtPoint<'_, F> {
        let geometry = &self.space.lookup.geometry;
        let material = |i: usize| {
            let material = geometry.material_of(shape(i));
            &self.materials[material.expect("shapes of a kind have one").0 as usize]
        };
        LaneBsdfAtPoint::new(kind, material, &self.space.lookup, vertices, wo)
    }

    #[inline]
    fn sample_light<F: Lane>(
        &self,
        from: &LaneReceiver<F>,
        wavelengths: &[Wavelengths],
        wanted: F::Mask,
        u_light: F,
        u: [F; 2],
    ) -> LaneLightSample<F> {
        let scene = &self.space.lookup;
        (self.lights).sample_lanes(scene, (from, wavelengths), wanted, u_light, u)
    }

    #[inline]
    fn background<F: Lane>(
        &self,
        from: &LaneReceiver<F>,
        direction: F::Vector,
        wavelengths: &[Wavelengths],
    ) -> (F::Spectrum, F) {
        (self.lights).background_lanes(&self.space.lookup, from, direction, wavelengths)
    }
}
