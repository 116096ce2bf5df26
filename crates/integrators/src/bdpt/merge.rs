//! Merging: a corner of the camera's walk and a photon near it, taken for the same point.
//!
//! A photon at xᵢ, made with the densities a₀ … aᵢ, and a camera's corner there, made with bᵢ … ,
//! are merged where they are less than r apart, with n photons to choose from: technique i's
//! density times aᵢ n π r² (Georgiev, Křivánek, Davidovič, Slusallek 2012). Against it stand all
//! others that would have made the path: those with more vertices from the light are weighed when
//! the photon is found ([`super::pdf_ratios::more`]); those with fewer depend on the camera's walk by
//! its density at the photon's parent alone, in which they are linear. So a photon carries one
//! factor per lane for them.

use super::from_light::FromLight;
use super::path_vertex::PathVertex;
use super::pdf_ratios::{EndPdfs, LightEnd, fewer};
use crate::photons::kdtree::KdTree;
use crate::steps::settings::PathSettings;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, World};
use glam::{Vec3, Vec4};

/// The least cosine of the angle between the normals of surfaces that are merged.
pub(super) const FACING: f32 = 0.7;

/// A corner of a walk from the light, without its scattering model.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Photon {
    /// Position (m).
    pub(super) position: Vec3,
    /// Unit geometric normal there.
    pub(super) normal: Vec3,
    /// Unit direction to where it came from.
    pub(super) from: Vec3,
    /// f/p₀ of its walk, over the cosine of its arrival.
    pub(super) value: Vec4,
    /// pₖ/p₀ of its walk.
    pub(super) r_u: Vec4,
    /// aᵢ of the lane that chose (m⁻²).
    pub(super) arrival: f32,
    /// Density ratio of the technique that connects its parent with its place; for a photon
    /// straight from a light, of light sampling.
    pub(super) connected: Vec4,
    /// What the techniques with fewer vertices from the light sum up to, over the density per solid
    /// angle with which the camera's walk leaves toward the parent.
    pub(super) fewer: Vec4,
    /// Segments behind it.
    pub(super) segments: u32,
}

/// The parameters of merging.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terms {
    /// r, within which photons are merged (m).
    pub(crate) radius: f32,
    /// n, the number of light subpaths.
    pub(crate) count: u32,
    /// Whether there are connections as well, and light hits where merging could find the same paths.
    pub(crate) connections: bool,
    /// The time of all subpaths.
    pub(crate) time: f32,
}

impl Terms {
    /// n π r² (m²).
    pub(super) fn area(&self) -> f32 {
        self.count as f32 * core::f32::consts::PI * self.radius * self.radius
    }

    /// The techniques that connect, as a factor.
    pub(super) fn connections(&self) -> f32 {
        if self.connections { 1.0 } else { 0.0 }
    }
}

/// The photons of a pass.
#[derive(Debug)]
pub(crate) struct Merging {
    pub(super) tree: KdTree,
    pub(super) photons: Vec<Photon>,
    pub(super) terms: Terms,
}

impl Merging {
    /// Photons to be merged on these terms.
    pub(crate) fn new(photons: Vec<Photon>, terms: Terms) -> Self {
        let (tree, order) = KdTree::new(photons.iter().map(|photon| photon.position));
        Self {
            tree,
            photons: order.iter().map(|i| photons[*i as usize]).collect(),
            terms,
        }
    }

    /// The moment of all walks of the pass.
    pub(crate) fn time(&self) -> f32 {
        self.terms.time
    }

    /// Whether there are techniques that connect.
    pub(crate) fn connects(&self) -> bool {
        self.terms.connections
    }
}

/// Follows a walk from a light, and adds its photons.
pub(crate) fn shoot<W: World>(
    world: &W,
    wavelengths: &Wavelengths,
    settings: &PathSettings,
    terms: &Terms,
    sampler: &mut impl Sampler,
    photons: &mut Vec<Photon>,
) {
    let Some(mut start) = FromLight::start(world, wavelengths, settings, sampler, terms.time)
    else {
        return;
    };
    let mut corners = Vec::new();
    start.walk(
        world,
        wavelengths,
        settings,
        sampler,
        &mut corners,
        usize::MAX,
    );
    let scatter = (corners.iter()).filter(|c| c.bsdf.has_continuous() && c.merges());
    photons.extend(scatter.filter_map(|corner| photon(&start, &corners, corner, terms)));
}

/// The photon that a corner is.
fn photon<B: Bsdf>(
    start: &FromLight,
    corners: &[PathVertex<B>],
    corner: &PathVertex<B>,
    terms: &Terms,
) -> Option<Photon> {
    let vertex = &corner.vertex;
    let cos = vertex.normal.dot(corner.wo).abs();
    let origin = start.emission.density.origin;
    let (connected, fewer) = match corner.parent {
        None => {
            let found = if start.emission.origin.can_be_hit() {
                start.per_area(start.distance_squared(vertex.position)) / origin
            } else {
                Vec4::ZERO
            };
            let connected = Vec4::splat(corner.direct / origin);
            (connected, terms.connections() * found)
        }
        Some(index) => {
            let parent = &corners[index];
            let connects = !parent.is_delta;
            let before = parent.parent;
            let ends = EndPdfs {
                here: Vec4::ONE,
                before: before.map_or(start.pdf_rev, |before| corners[before].pdf_rev),
            };
            let first = core::iter::successors(Some(index), |i| corners[*i].parent).last()?;
            let light = LightEnd {
                can_be_hit: start.emission.origin.can_be_hit(),
                emitted: origin,
                sampled: corners[first].direct,
                merging: terms.area(),
                connections: terms.connections(),
            };
            let lane = |rest| fewer(corners, index, rest, ends, light, start.pdf_rev, connects);
            let lanes = [Vec4::X, Vec4::Y, Vec4::Z, Vec4::W].map(lane);
            let distance_squared = parent.vertex.position.distance_squared(vertex.position);
            let per_area = parent.per_area(corner.wo, distance_squared);
            let connected = if connects {
                parent.prefix.r_u
            } else {
                Vec4::ZERO
            };
            (connected, Vec4::from_array(lanes) * per_area)
        }
    };
    (cos > 0.0).then(|| Photon {
        position: vertex.position,
        normal: vertex.normal,
        from: corner.wo,
        value: corner.prefix.beta / cos,
        r_u: corner.prefix.r_u,
        arrival: corner.arrival,
        connected: terms.connections() * connected,
        fewer: fewer * corner.passed,
        segments: corner.segments,
    })
}
