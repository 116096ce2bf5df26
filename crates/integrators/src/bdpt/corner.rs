//! A corner of a subpath, and how densities change from solid angle to area.

use crate::prefix::Prefix;
use etalon_transport::{BsdfSample, Chance, Vertex};
use glam::{Vec3, Vec4};

/// A surface that a subpath met. What it scatters next is known to the corner after it.
#[derive(Clone, Copy)]
pub(crate) struct Corner<B> {
    /// The surface.
    pub(super) vertex: Vertex,
    /// The scattering model there, for `wo`.
    pub(super) bsdf: B,
    /// Unit direction back along the subpath.
    pub(super) wo: Vec3,
    /// The subpath up to its arrival here, before it scatters.
    pub(super) prefix: Prefix,
    /// Density of the arrival given the corner before, of the lane that chose: per unit area (m⁻²),
    /// times the probability of passing what lies in between.
    pub(super) arrival: f32,
    /// The same, for each lane, of a walk from the other end that comes from the next corner: its density
    /// of arriving *here*. Known once the subpath has left the next corner.
    pub(super) opposite: Vec4,
    /// Probability of passing what lies between the corner before and this one, per lane.
    pub(super) passed: Vec4,
    /// Whether the subpath left in a discrete direction.
    pub(super) leaves_discretely: bool,
    /// Segments from the subpath's beginning, those through passed surfaces included.
    pub(super) segments: u32,
    /// The corner before this one on a walk from the light; `None` if that is the light.
    pub(super) parent: Option<usize>,
    /// Density with which light sampling from a light walk's first corner would have chosen its
    /// start, in the measure of the emission's.
    pub(super) direct: f32,
}

impl<B> Corner<B> {
    /// The density of a sampled direction, per lane: per solid angle if it is continuous, else its probability
    /// per projected solid angle, see [`crate::bdpt`]. `eta` belongs to the way along `direction`.
    #[inline]
    pub(super) fn density(&self, chance: Chance, direction: Vec3, eta: f32) -> Vec4 {
        match chance {
            Chance::Continuous(density) => density.lanes(),
            Chance::Discrete(atom) => atom.0 * (self.vertex.normal.dot(direction).abs() * eta),
        }
    }

    /// The densities of a sampled direction, and of its reverse: of having come along it and
    /// leaving along `wo`.
    #[inline]
    pub(super) fn both_densities(&self, sample: &BsdfSample) -> [Vec4; 2]
    where
        B: etalon_transport::Bsdf,
    {
        let reverse = match sample.chance {
            Chance::Continuous(_) => Chance::Continuous(self.bsdf.density(sample.wi, self.wo)),
            // Reflected and refracted with the same probability either way.
            discrete => discrete,
        };
        [
            self.density(sample.chance, sample.wi, sample.eta),
            self.density(reverse, self.wo, 1.0 / sample.eta),
        ]
    }

    /// Solid angle per area here, seen from `distance_squared` away along `direction`.
    #[inline]
    pub(super) fn per_area(&self, direction: Vec3, distance_squared: f32) -> f32 {
        self.vertex.normal.dot(direction).abs() / distance_squared
    }
}
