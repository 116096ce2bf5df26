//! Vertices of a scene that are shaded in vector lanes.

use super::Parts;
use etalon_bsdf::LaneBsdfAtPoint;
use etalon_math::lane::Lane;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    LaneKind, LaneLightSample, LaneReceiver, LaneShading, LaneVertices, SurfaceInteraction,
};

impl LaneShading for Parts {
    type Bsdf<'a, F: Lane> = LaneBsdfAtPoint<'a, F>;

    #[inline]
    fn kind(&self, vertex: &SurfaceInteraction) -> Option<LaneKind> {
        self.lane_kinds[vertex.material.0 as usize]
    }

    #[inline]
    fn bsdf<F: Lane>(
        &self,
        kind: LaneKind,
        vertices: LaneVertices<'_>,
        wo: F::Vector,
    ) -> LaneBsdfAtPoint<'_, F> {
        let material = |i: usize| &self.materials[vertices.vertices[i].material.0 as usize];
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
