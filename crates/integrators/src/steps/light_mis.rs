//! Multiple importance sampling of emission that a path hits: how likely light sampling would have been to
//! find it. pbrt-v4 calls the ratio `r_l`.

use crate::steps::path_throughput::PathThroughput;
use etalon_math::lane::{Lane, Mask, Spectral};
use etalon_transport::{
    BsdfSample, LaneReceiver, LightSampleContext, MediumId, SurfaceInteraction, World,
};
use glam::{Vec3, Vec4};

/// The density of light sampling at the last vertex that is not a null interaction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightMis {
    /// That vertex, as light sampling saw it.
    pub(crate) from: LightSampleContext,
    /// Per lane, the path's pdf before that vertex scattered over the pdf actually used up to here. Times the pdf
    /// of the light it is pₜ,ₖ / p₀ of next-event estimation; zero after a delta interaction.
    pub(crate) r_l: Vec4,
}

impl LightMis {
    pub(crate) const NONE: Self = Self {
        from: LightSampleContext::in_space(Vec3::ZERO),
        r_l: Vec4::ZERO,
    };

    /// The ratio after sampling `sample` where light was sampled for `from`, reached by `before`.
    #[inline]
    pub(crate) fn after(
        self,
        before: &PathThroughput,
        from: &LightSampleContext,
        sample: &BsdfSample,
    ) -> Self {
        let chance = sample.chance.lanes().x;
        if sample.is_null {
            Self {
                from: self.from,
                r_l: self.r_l / chance,
            }
        } else if sample.chance.is_delta() {
            Self::NONE
        } else {
            Self {
                from: *from,
                r_l: before.r_u / chance,
            }
        }
    }

    /// The ratio in any lane where light was sampled for `from`, reached by `before`, and the direction that was sampled there
    /// has this density, or a probability where it `is_delta`.
    #[inline(always)]
    pub(crate) fn lanes<F: Lane>(
        before: PathThroughput<F>,
        from: LaneReceiver<F>,
        chance: F,
        is_delta: F::Mask,
    ) -> impl Fn(usize) -> Self {
        let r_l = F::Spectrum::pairs([before.r_u / chance; 2]);
        let from = from.lanes();
        move |i| match is_delta.lane(i) {
            true => Self::NONE,
            false => {
                let ([r_l, _], from) = (r_l(i), from(i));
                Self { from, r_l }
            }
        }
    }

    #[inline]
    fn exists(&self) -> bool {
        self.r_l != Vec4::ZERO
    }

    /// pₜ,ₖ / p₀ of light sampling for an emitting surface.
    #[inline]
    pub(crate) fn pdf_at_surface<W: World>(
        &self,
        world: &W,
        at: &SurfaceInteraction,
        direction: Vec3,
    ) -> Vec4 {
        if !self.exists() {
            return Vec4::ZERO;
        }
        self.r_l * world.light_density(&self.from, at, direction).lanes()
    }

    /// pₜ,ₖ / p₀ of light sampling for a point of a medium that emits.
    #[inline]
    pub(crate) fn pdf_in_medium<W: World>(&self, world: &W, medium: MediumId, at: Vec3) -> Vec4 {
        if !self.exists() {
            return Vec4::ZERO;
        }
        let distance_squared = self.from.position.distance_squared(at);
        self.r_l * (world.medium_light_density(medium, at) * distance_squared)
    }

    /// pₜ,ₖ / p₀ of light sampling for the background.
    #[inline]
    pub(crate) fn pdf_at_background<W: World>(&self, world: &W, direction: Vec3) -> Vec4 {
        if !self.exists() {
            return Vec4::ZERO;
        }
        self.r_l * world.background_density(&self.from, direction).lanes()
    }
}
