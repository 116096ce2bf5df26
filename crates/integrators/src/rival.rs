//! The competition of light sampling with scattering, for emission that a path runs into.

use crate::prefix::Prefix;
use etalon_transport::{BsdfSample, Receiver, Vertex, World};
use glam::{Vec3, Vec4};

/// How the light sampling of the last real vertex competes with the direction just sampled.
#[derive(Clone, Copy)]
pub(crate) struct Rival {
    /// The last real vertex, as light sampling saw it.
    pub(crate) from: Receiver,
    /// The prefix's density ratio before that vertex scattered, over the densities chosen
    /// since: multiplied by the light's density it is pₜ,ₖ / p₀ of light sampling. Zero if light
    /// sampling could not have found the path.
    pub(crate) ratio: Vec4,
}

impl Rival {
    pub(crate) const NONE: Self = Self {
        from: Receiver::in_space(Vec3::ZERO),
        ratio: Vec4::ZERO,
    };

    /// The rival after sampling `sample` where light was sampled for `from`, reached by `before`.
    #[inline]
    pub(crate) fn after(self, before: &Prefix, from: &Receiver, sample: &BsdfSample) -> Self {
        let chance = sample.chance.lanes().x;
        if sample.passes {
            Self {
                from: self.from,
                ratio: self.ratio / chance,
            }
        } else if sample.chance.is_discrete() {
            Self::NONE
        } else {
            Self {
                from: *from,
                ratio: before.ratio / chance,
            }
        }
    }

    #[inline]
    fn exists(&self) -> bool {
        self.ratio != Vec4::ZERO
    }

    /// pₜ,ₖ / p₀ of light sampling for an emitting surface.
    #[inline]
    pub(crate) fn at_surface<W: World>(&self, world: &W, at: &Vertex, direction: Vec3) -> Vec4 {
        if !self.exists() {
            return Vec4::ZERO;
        }
        self.ratio * world.light_density(&self.from, at, direction).lanes()
    }

    /// pₜ,ₖ / p₀ of light sampling for the background.
    #[inline]
    pub(crate) fn at_background<W: World>(&self, world: &W, direction: Vec3) -> Vec4 {
        if !self.exists() {
            return Vec4::ZERO;
        }
        self.ratio * world.background_density(&self.from, direction).lanes()
    }
}
