//! The hooks of `guided` into paths: guiding and Russian roulette.

use super::guided_bsdf::GuidedBsdf;
use super::sd_tree::SdTree;
use crate::path::hooks::PathHooks;
use crate::steps::path_throughput::PathThroughput;
use etalon_transport::{Bsdf, BsdfSample, SurfaceInteraction};
use glam::Vec3;

/// Steers a path.
///
/// A guided path has a small throughput f/p where it matters, as p is large toward the light. Russian roulette by
/// throughput would end such paths. So the survival probability is the product of the surfaces' albedos. Paths of
/// larger throughput, in directions where little was expected, do not gain more weight.
#[derive(Clone, Copy)]
pub(crate) struct GuidedHooks<'f> {
    pub(crate) field: &'f SdTree,
    /// The product of the albedos along the path, over the probabilities with which it survived.
    pub(crate) reflected: f32,
}

/// The shading normal on the side of `wo`.
#[inline]
pub(super) fn toward(vertex: &SurfaceInteraction, wo: Vec3) -> Vec3 {
    let normal = vertex.shading.n;
    if normal.dot(wo) < 0.0 {
        -normal
    } else {
        normal
    }
}

/// The least probability of surviving roulette.
const LEAST_SURVIVAL: f32 = 0.05;

impl<'f> PathHooks for GuidedHooks<'f> {
    const PLAIN: bool = false;

    type GuidedBsdf<B: Bsdf + Copy> = GuidedBsdf<'f, B>;

    #[inline]
    fn wrap_bsdf<B: Bsdf + Copy>(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        bsdf: impl FnOnce() -> B,
    ) -> GuidedBsdf<'f, B> {
        let bsdf = bsdf();
        let lobe = if bsdf.has_continuous() {
            self.field.lobe(vertex.position, toward(vertex, wo))
        } else {
            None
        };
        GuidedBsdf { bsdf, lobe }
    }

    #[inline]
    fn on_scatter(
        &mut self,
        _: &SurfaceInteraction,
        bsdf: &impl Bsdf,
        wo: Vec3,
        sample: &BsdfSample,
        _: &PathThroughput,
    ) {
        self.reflected *= if sample.chance.is_delta() {
            let chance = sample.chance.lanes();
            4.0 * sample.value.max_element() / chance.element_sum()
        } else {
            bsdf.albedo(wo).max_element()
        };
    }

    #[inline]
    fn survival(&mut self, throughput: &PathThroughput, eta: f32) -> f32 {
        let most = self.reflected.max(throughput.magnitude());
        let survival = (most * eta * eta).clamp(LEAST_SURVIVAL, 0.95);
        self.reflected /= survival;
        survival
    }
}
