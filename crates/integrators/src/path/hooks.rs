//! Hooks into the path loop, used by path guiding: wrap the BSDF at each vertex, and observe contributions.

use crate::steps::path_throughput::PathThroughput;
use etalon_transport::{Bsdf, BsdfSample, SurfaceInteraction};
use glam::{Vec3, Vec4};

/// What is called along a path. `()` is the plain path tracer.
pub(crate) trait PathHooks {
    /// Whether nothing is called, so that several paths may be scattered together.
    const PLAIN: bool;

    /// A scattering model that samples other directions than `B`, but scatters the same light.
    type GuidedBsdf<B: Bsdf + Copy>: Bsdf;

    /// The BSDF at a vertex, possibly with another sampling density. `bsdf` makes the model, which is too large to be moved
    /// needlessly.
    fn wrap_bsdf<B: Bsdf + Copy>(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        bsdf: impl FnOnce() -> B,
    ) -> Self::GuidedBsdf<B>;

    /// After the BSDF was sampled; `throughput` leaves the vertex.
    #[inline]
    fn on_scatter(
        &mut self,
        _vertex: &SurfaceInteraction,
        _bsdf: &impl Bsdf,
        _wo: Vec3,
        _sample: &BsdfSample,
        _throughput: &PathThroughput,
    ) {
    }

    /// The path hit an emitter, which contributes `estimate` (see [`PathThroughput::contribution`]).
    #[inline]
    fn on_emission(&mut self, _estimate: Vec4) {}

    /// The path flew through a medium, or was scattered in one: `throughput` is its throughput from then on.
    #[inline]
    fn on_medium(&mut self, _throughput: &PathThroughput) {}

    /// Russian roulette is played in a medium, with this probability to survive.
    #[inline]
    fn on_roulette(&mut self, _survival: f32) {}

    /// A light sample was drawn at the current vertex, before its BSDF is sampled.
    #[inline]
    fn on_light_sample(&mut self) {}

    /// The contribution of that light sample; the path may already have left the vertex.
    #[inline]
    fn on_light_contribution(&mut self, _estimate: Vec4) {}

    /// The probability with which the path survives Russian roulette; any positive number is right.
    #[inline]
    fn survival(&mut self, throughput: &PathThroughput, eta: f32) -> f32 {
        throughput.survival(eta)
    }
}

impl PathHooks for () {
    const PLAIN: bool = true;

    type GuidedBsdf<B: Bsdf + Copy> = B;

    #[inline]
    fn wrap_bsdf<B: Bsdf + Copy>(
        &self,
        _: &SurfaceInteraction,
        _: Vec3,
        bsdf: impl FnOnce() -> B,
    ) -> B {
        bsdf()
    }
}
