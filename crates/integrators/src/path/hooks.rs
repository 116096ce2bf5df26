//! Hooks into the path loop, used by path guiding: wrap the BSDF at each vertex, and observe contributions.

use crate::steps::path_throughput::PathThroughput;
use etalon_math::lane::Lane;
use etalon_transport::{
    Bsdf, BsdfSample, LaneBsdf, LaneBsdfSample, LaneSurface, SurfaceInteraction,
};
use glam::{Vec3, Vec4};

/// What is called along a path. `()` is the plain path tracer.
pub(crate) trait PathHooks {
    /// Whether paths with these hooks may be scattered together, in lanes.
    const LANES: bool;

    /// The hooks of several paths. Where there are no lanes, nothing asks for them.
    type Lanes<F: Lane>: LaneHooks<F>;

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

    /// Those of `hooks(i)` in lane i.
    fn in_lanes<'h, F: Lane>(hooks: impl Fn(usize) -> &'h Self) -> Self::Lanes<F>
    where
        Self: 'h;

    /// Becomes what the hooks in this lane have become.
    fn take_lane<F: Lane>(&mut self, lanes: &Self::Lanes<F>, lane: usize);

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

/// [`PathHooks`] of several paths at surfaces of one kind.
pub(crate) trait LaneHooks<F: Lane>: Copy {
    /// As [`PathHooks::GuidedBsdf`].
    type GuidedBsdf<B: LaneBsdf<F>>: LaneBsdf<F>;

    /// As [`PathHooks::wrap_bsdf`].
    fn wrap_bsdf<B: LaneBsdf<F>>(
        &self,
        surface: &LaneSurface<F>,
        wo: F::Vector,
        bsdf: impl FnOnce() -> B,
    ) -> Self::GuidedBsdf<B>;

    /// As [`PathHooks::on_scatter`].
    fn on_scatter(&mut self, bsdf: &impl LaneBsdf<F>, wo: F::Vector, sample: &LaneBsdfSample<F>);

    /// As [`PathHooks::survival`]; roulette is played where `played` says so.
    fn survival(&mut self, played: F::Mask, throughput: &PathThroughput<F>, eta: F) -> F;
}

impl<F: Lane> LaneHooks<F> for () {
    type GuidedBsdf<B: LaneBsdf<F>> = B;

    #[inline(always)]
    fn wrap_bsdf<B: LaneBsdf<F>>(
        &self,
        _: &LaneSurface<F>,
        _: F::Vector,
        bsdf: impl FnOnce() -> B,
    ) -> B {
        bsdf()
    }

    #[inline(always)]
    fn on_scatter(&mut self, _: &impl LaneBsdf<F>, _: F::Vector, _: &LaneBsdfSample<F>) {}

    #[inline(always)]
    fn survival(&mut self, _: F::Mask, throughput: &PathThroughput<F>, eta: F) -> F {
        throughput.survival(eta)
    }
}

impl PathHooks for () {
    const LANES: bool = true;

    type Lanes<F: Lane> = ();

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
    #[inline(always)]
    fn in_lanes<'h, F: Lane>(_: impl Fn(usize) -> &'h Self) {}

    #[inline(always)]
    fn take_lane<F: Lane>(&mut self, (): &(), _: usize) {}
}
