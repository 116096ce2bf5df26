//! The hooks of `guided` into paths: guiding and Russian roulette.

use super::guided_bsdf::GuidedBsdf;
use super::lane_guided_bsdf::LaneGuidedBsdf;
use super::sd_tree::SdTree;
use crate::path::hooks::{LaneHooks, PathHooks};
use crate::steps::path_throughput::{MOST, PathThroughput};
use etalon_math::lane::{Lane, Mask, Select, Spectral, Vector};
use etalon_transport::{
    Bsdf, BsdfSample, LaneBsdf, LaneBsdfSample, LaneSurface, SurfaceInteraction,
};
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
    const LANES: bool = true;

    type Lanes<F: Lane> = LaneGuidedHooks<'f, F>;

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

    #[inline(always)]
    fn in_lanes<'h, F: Lane>(hooks: impl Fn(usize) -> &'h Self) -> LaneGuidedHooks<'f, F>
    where
        Self: 'h,
    {
        LaneGuidedHooks {
            field: hooks(0).field,
            reflected: F::from_fn(|i| hooks(i).reflected),
        }
    }

    #[inline(always)]
    fn take_lane<F: Lane>(&mut self, lanes: &LaneGuidedHooks<'f, F>, lane: usize) {
        self.reflected = lanes.reflected.lane(lane);
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
        let mut lanes = LaneGuidedHooks::<f32> {
            field: self.field,
            reflected: self.reflected,
        };
        let survival = lanes.survival(true, throughput, eta);
        self.reflected = lanes.reflected;
        survival
    }
}

/// [`GuidedHooks`] of several paths in one field.
#[derive(Clone, Copy)]
pub(crate) struct LaneGuidedHooks<'f, F> {
    field: &'f SdTree,
    reflected: F,
}

impl<'f, F: Lane> LaneHooks<F> for LaneGuidedHooks<'f, F> {
    type GuidedBsdf<B: LaneBsdf<F>> = LaneGuidedBsdf<'f, F, B>;

    #[inline(always)]
    fn wrap_bsdf<B: LaneBsdf<F>>(
        &self,
        surface: &LaneSurface<F>,
        wo: F::Vector,
        bsdf: impl FnOnce() -> B,
    ) -> LaneGuidedBsdf<'f, F, B> {
        let bsdf = bsdf();
        if !bsdf.has_continuous() {
            return LaneGuidedBsdf::new(bsdf, |_| None);
        }
        let (position, n) = (surface.leaving.position, surface.shading.n);
        let normal = F::Vector::choose(n.dot_product(wo).lt(F::ZERO), -n, n);
        LaneGuidedBsdf::new(bsdf, |i| {
            self.field.lobe(position.at_lane(i), normal.at_lane(i))
        })
    }

    #[inline(always)]
    fn on_scatter(&mut self, bsdf: &impl LaneBsdf<F>, wo: F::Vector, sample: &LaneBsdfSample<F>) {
        let discrete = sample.value.greatest() * 4.0 / sample.chance.sum();
        let albedo = match sample.is_delta.all() {
            true => discrete,
            false => bsdf.albedo(wo).greatest(),
        };
        self.reflected = self.reflected * sample.is_delta.select(discrete, albedo);
    }

    #[inline(always)]
    fn survival(&mut self, played: F::Mask, throughput: &PathThroughput<F>, eta: F) -> F {
        let most = self.reflected.max(throughput.magnitude()) * eta * eta;
        let survival = most.max(F::splat(LEAST_SURVIVAL)).min(F::splat(MOST));
        self.reflected = played.select(self.reflected / survival, self.reflected);
        survival
    }
}
