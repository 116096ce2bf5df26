//! A vertex of a subpath, and how densities change from solid angle to area.

use crate::steps::path_throughput::PathThroughput;
use etalon_transport::{
    Bsdf, BsdfSample, LightSampleContext, SamplePdf, ScattererOf, SurfaceInteraction,
};
use glam::{Vec3, Vec4};

/// A surface that a subpath arrived at, or a point of a medium where it was scattered. What it scatters next is known to the vertex after it.
#[derive(Clone, Copy)]
pub(crate) struct PathVertex<B> {
    /// The surface, or the point.
    pub(super) point: SurfaceInteraction,
    /// The scattering model there, for `wo`.
    pub(super) bsdf: B,
    /// σt at a point of a medium (m⁻¹), per lane, over the area that its matter shows: the density of stopping there; 1 at a surface.
    pub(super) extinction: Vec4,
    /// Unit direction back along the subpath.
    pub(super) wo: Vec3,
    /// The subpath up to its arrival here, before it scatters.
    pub(super) throughput: PathThroughput,
    /// Density of the arrival given the vertex before, of the lane that chose: per unit area (m⁻²),
    /// times the probability of passing what lies in between.
    pub(super) arrival: f32,
    /// The same, for each lane, of a subpath from the other end that comes from the next vertex: its density
    /// of arriving *here*. Known once the subpath has left the next vertex.
    pub(super) pdf_rev: Vec4,
    /// Probability of passing what lies between the vertex before and this one, per lane.
    pub(super) passed: Vec4,
    /// Whether the subpath left in a discrete direction.
    pub(super) is_delta: bool,
    /// Segments from the subpath's beginning, those through passed surfaces included.
    pub(super) segments: u32,
    /// The vertex before this one on a subpath from the light; `None` if that is the light.
    pub(super) parent: Option<usize>,
    /// Density with which light sampling from a light subpath's first vertex would have chosen its
    /// start, in the measure of the emission's.
    pub(super) direct: f32,
}

/// What a squared distance (m²) counts: flights through a dense medium may be shorter than positions can tell. It
/// counts the same both ways, and so the weights of a path still add up to one.
#[inline]
pub(super) fn counted(distance_squared: f32) -> f32 {
    distance_squared.max(1e-20)
}

/// A vertex of a subpath in a world.
pub(crate) type SubpathVertex<'w, W> = PathVertex<ScattererOf<'w, W>>;

impl<B> PathVertex<B> {
    /// The densities of a sampled direction, per lane, and of its reverse: of having come along it and
    /// leaving along `wo`. Per solid angle if they are continuous, else see [`discrete`].
    #[inline]
    pub(super) fn both_densities(&self, sample: &BsdfSample) -> [Vec4; 2]
    where
        B: Bsdf,
    {
        match sample.chance {
            SamplePdf::Continuous(density) => {
                let back = self.bsdf.density(sample.wi, self.wo);
                [density.lanes(), back.lanes()]
            }
            SamplePdf::Discrete(atom) => {
                discrete(self.wo, sample.wi, sample.eta).map(|d| atom.0 * d)
            }
        }
    }

    /// The vertex as light arrives at it that some technique is to find; on a light subpath, where what
    /// scatters to one side only is lit from `wo`'s.
    #[inline]
    pub(super) fn receiver(&self) -> LightSampleContext
    where
        B: Bsdf,
    {
        LightSampleContext::new(&self.point, self.wo, &self.bsdf).combined()
    }

    /// The factor from a density per solid angle, at the squared distance `distance_squared` along `direction`, to the density
    /// of arriving here unoccluded, per lane: per area of a surface, per volume of a medium.
    #[inline]
    pub(super) fn per_area(&self, direction: Vec3, distance_squared: f32) -> Vec4
    where
        B: Bsdf,
    {
        let area = self.point.area_cos(direction) * self.bsdf.projected_area(direction);
        self.extinction * (area / counted(distance_squared))
    }

    /// Whether it can be merged with a photon: one on a surface.
    #[inline]
    pub(super) fn merges(&self) -> bool {
        self.point.normal != Vec3::ZERO
    }
}

/// Pseudo-densities of the discrete direction `wi` seen from `wo`, forward and back, as factors on its
/// probability; `eta` is the index entered over the index left. Each occurs once in every density of a
/// path, so only their quotient η² cos θᵢ / cos θₒ matters: that of the two Dirac functions per unit
/// solid angle, see [`crate::bdpt`].
///
/// The cosines are those about the normal that refracted the direction, ωₒ + η ωᵢ. The surface normal
/// differs from it where normals are interpolated or mapped; its cosines would give a technique of low
/// density a large MIS weight, and leave fireflies.
#[inline]
fn discrete(wo: Vec3, wi: Vec3, eta: f32) -> [f32; 2] {
    // Reflected or passed straight: solid angles are kept.
    if eta == 1.0 {
        return [1.0; 2];
    }
    // The cosines about the vector ωₒ + η ωᵢ, in d = 1 + ωₒ·ωᵢ, which is of order (η − 1)² where η is close
    // to 1. That vector itself cancels there, at worst to zero.
    let turned = 0.5 * (wo + wi).length_squared();
    let excess = eta - 1.0;
    let cos_i = (excess + turned).abs();
    let cos_o = (excess - eta * turned).abs();
    // Of the order of 1 for any η, so that no product along a path underflows.
    let scale = 1.0 / (cos_i + cos_o);
    [scale * cos_i * eta, scale * cos_o / eta]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A refraction about `normal` by Snell's law, with η the index entered over the index left.
    fn refracted(wo: Vec3, normal: Vec3, eta: f32) -> Vec3 {
        let cos = normal.dot(wo);
        let sine_squared = (1.0 - cos * cos) / (eta * eta);
        (normal * cos - wo) / eta - normal * (1.0 - sine_squared).sqrt()
    }

    /// Solid angle of the directions `wi` per solid angle of the directions `wo` that make them, by
    /// central differences.
    fn widening(wo: Vec3, turn: impl Fn(Vec3) -> Vec3) -> f32 {
        let (s, t) = wo.any_orthonormal_pair();
        let step = 4e-3;
        let along = |axis: Vec3| {
            let ends = [step, -step].map(|h| turn((wo + h * axis).normalize()));
            (ends[0] - ends[1]) / (2.0 * step)
        };
        along(s).cross(along(t)).length()
    }

    /// Rejects the surface's normal in place of the one that refracts, off by 8 and 34 % here, and η
    /// in place of η².
    #[test]
    fn the_quotient_of_a_discrete_directions_densities_is_that_of_the_solid_angles() {
        let wo = Vec3::new(0.3, -0.5, 0.9).normalize();
        for (normal, eta) in [
            (Vec3::Z, 1.5),
            (Vec3::Z, 1.0 / 1.5),
            (Vec3::new(0.3, 0.2, 0.8).normalize(), 1.5),
            (Vec3::new(-0.4, -0.6, 0.7).normalize(), 1.0 / 1.3),
        ] {
            let turn = |wo| refracted(wo, normal, eta);
            let [forward, back] = discrete(wo, turn(wo), eta);
            let quotient = forward / back * widening(wo, turn);
            assert!((quotient - 1.0).abs() < 2e-3, "off by {quotient}");
        }
    }

    /// Rejects the normal ωₒ + η ωᵢ taken as it stands: it can be zero in single precision.
    #[test]
    fn glass_that_hardly_refracts_keeps_solid_angles() {
        let wo = Vec3::new(0.3, -0.5, 0.4).normalize();
        for excess in [1e-2, -1e-2, 1e-4, 1e-5, -1e-5, f32::EPSILON, -f32::EPSILON] {
            let eta = 1.0 + excess;
            // Cancels in single precision, too: the quotient comes from Snell's law in double precision.
            let cos_o = f64::from(wo.z);
            let cos_i = (1.0 - (1.0 - cos_o * cos_o) / f64::from(eta).powi(2)).sqrt();
            let expected = f64::from(eta).powi(2) * cos_i / cos_o;
            let [forward, back] = discrete(wo, refracted(wo, Vec3::Z, eta), eta);
            let off = f64::from(forward / back) / expected - 1.0;
            assert!(off.abs() < 1e-4, "η = {eta}: off by {off}");
        }
        // As near as rounding comes to a sum of zero.
        for excess in [f32::EPSILON, -0.5 * f32::EPSILON] {
            let eta = 1.0 + excess;
            let [forward, back] = discrete(wo, -wo / eta, eta);
            assert!((forward / back - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn a_discrete_direction_taken_back_has_the_inverse_quotient() {
        let wo = Vec3::new(0.3, -0.5, 0.9).normalize();
        for eta in [2.4, 1.5, 1.0 / 1.5, 1.0001, 0.9999] {
            let wi = refracted(wo, Vec3::Z, eta);
            let [forward, back] = discrete(wo, wi, eta);
            let [again, home] = discrete(wi, wo, 1.0 / eta);
            let product = forward / back * again / home;
            assert!((product - 1.0).abs() < 1e-3, "η = {eta}: {product}");
        }
        let wi = Vec3::new(-0.3, 0.5, 0.9).normalize();
        let [forward, back] = discrete(wo, wi, 1.0);
        assert_eq!(forward, back, "reflected");
    }
}
