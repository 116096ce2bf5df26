//! Who goes along with a path: steers it where it scatters, and learns what it finds.

use crate::prefix::Prefix;
use etalon_transport::{Bsdf, BsdfSample, Vertex};
use glam::{Vec3, Vec4};

/// Goes along with a path. `()` changes nothing: the plain path tracer.
pub(crate) trait Companion {
    /// A scattering model that samples other directions than `B`, but scatters the same light.
    type Steered<B: Bsdf + Copy>: Bsdf;

    /// Changes the choice of directions at a vertex.
    fn steer<B: Bsdf + Copy>(&self, vertex: &Vertex, wo: Vec3, bsdf: B) -> Self::Steered<B>;

    /// The path was scattered; `prefix` is the path that now leaves the vertex.
    #[inline]
    fn scattered(
        &mut self,
        _vertex: &Vertex,
        _bsdf: &impl Bsdf,
        _wo: Vec3,
        _sample: &BsdfSample,
        _prefix: &Prefix,
    ) {
    }

    /// The path ran into light, which brings `estimate` (see [`Prefix::estimate`]).
    #[inline]
    fn found(&mut self, _estimate: Vec4) {}

    /// A light sample was chosen at the vertex that the path has reached, before it is scattered there.
    #[inline]
    fn aimed(&mut self) {}

    /// What that light sample brings, when the path may already have left the vertex.
    #[inline]
    fn lit(&mut self, _estimate: Vec4) {}

    /// The probability with which the path survives Russian roulette; any positive number is right.
    #[inline]
    fn survival(&mut self, prefix: &Prefix, eta: f32) -> f32 {
        (prefix.throughput() * eta * eta).min(0.95)
    }
}

impl Companion for () {
    type Steered<B: Bsdf + Copy> = B;

    #[inline]
    fn steer<B: Bsdf + Copy>(&self, _: &Vertex, _: Vec3, bsdf: B) -> B {
        bsdf
    }
}
