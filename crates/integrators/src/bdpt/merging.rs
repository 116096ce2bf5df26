//! Merging: a vertex of the camera subpath and a photon near it, taken for the same point.
//!
//! A photon at xᵢ, made with the densities a₀ … aᵢ, and a vertex of the camera subpath there, made with bᵢ … ,
//! are merged where they are less than r apart, with n photons to choose from: technique i's
//! density times aᵢ n π r² (Georgiev, Křivánek, Davidovič, Slusallek 2012). Against it stand all
//! others that would have made the path: those with more vertices from the light are weighed when
//! the photon is found ([`super::pdf_ratios::pdf_ratios_more`]); those with fewer depend on the camera subpath by
//! its density at the photon's parent alone, in which they are linear. So a photon carries one
//! factor per lane for them.

use super::from_light::FromLight;
use super::path_vertex::PathVertex;
use super::pdf_ratios::{EndPdfs, LightEnd, pdf_ratios_fewer};
use crate::photons::kdtree::KdTree;
use crate::steps::settings::PathSettings;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, World};
use glam::{Vec3, Vec4};

/// The least cosine of the angle between the normals of surfaces that are merged.
pub(super) const FACING: f32 = 0.7;

/// A vertex of a subpath from the light, without its scattering model.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Photon {
    /// Position (m).
    pub(super) position: Vec3,
    /// Unit geometric normal there.
    pub(super) normal: Vec3,
    /// Unit direction to where it came from.
    pub(super) from: Vec3,
    /// f/p₀ of its subpath, over the cosine of its arrival.
    pub(super) value: Vec4,
    /// pₖ/p₀ of its subpath.
    pub(super) r_u: Vec4,
    /// aᵢ of the lane that chose (m⁻²).
    pub(super) arrival: f32,
    /// Density ratio of the technique that connects its parent with its place; for a photon
    /// straight from a light, of light sampling.
    pub(super) connected: Vec4,
    /// What the techniques with fewer vertices from the light sum up to, over the density per solid
    /// angle with which the camera subpath leaves toward the parent.
    pub(super) pdf_ratios_fewer: Vec4,
    /// Segments behind it.
    pub(super) segments: u32,
}

/// The parameters of merging.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MergingParameters {
    /// r, within which photons are merged (m).
    pub(crate) radius: f32,
    /// n, the number of light subpaths.
    pub(crate) count: u32,
    /// Whether there are connections as well, and light hits where merging could find the same paths.
    pub(crate) connections: bool,
    /// The time of all subpaths.
    pub(crate) time: f32,
}

impl MergingParameters {
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
    pub(super) parameters: MergingParameters,
}

impl Merging {
    /// Photons to be merged with these parameters.
    pub(crate) fn new(photons: Vec<Photon>, parameters: MergingParameters) -> Self {
        let (tree, order) = KdTree::new(photons.iter().map(|photon| photon.position));
        Self {
            tree,
            photons: order.iter().map(|i| photons[*i as usize]).collect(),
            parameters,
        }
    }

    /// The moment of all subpaths of the pass.
    pub(crate) fn time(&self) -> f32 {
        self.parameters.time
    }

    /// Whether there are techniques that connect.
    pub(crate) fn connects(&self) -> bool {
        self.parameters.connections
    }
}

/// Follows a subpath from a light, and adds its photons.
pub(crate) fn shoot<W: World>(
    world: &W,
    wavelengths: &Wavelengths,
    settings: &PathSettings,
    parameters: &MergingParameters,
    sampler: &mut impl Sampler,
    photons: &mut Vec<Photon>,
) {
    let Some(mut start) = FromLight::start(world, wavelengths, settings, sampler, parameters.time)
    else {
        return;
    };
    let mut vertices = Vec::new();
    start.trace(
        world,
        wavelengths,
        settings,
        sampler,
        &mut vertices,
        usize::MAX,
    );
    let scatter = (vertices.iter()).filter(|c| c.bsdf.has_continuous() && c.merges());
    photons.extend(scatter.filter_map(|vertex| photon(&start, &vertices, vertex, parameters)));
}

/// The photon that a vertex is.
fn photon<B: Bsdf>(
    start: &FromLight,
    vertices: &[PathVertex<B>],
    vertex: &PathVertex<B>,
    parameters: &MergingParameters,
) -> Option<Photon> {
    let point = &vertex.point;
    let cos = point.normal.dot(vertex.wo).abs();
    let origin = start.emission.density.origin;
    let (connected, pdf_ratios_fewer) = match vertex.parent {
        None => {
            let found = if start.emission.origin.can_be_hit() {
                start.per_area(start.distance_squared(point.position)) / origin
            } else {
                Vec4::ZERO
            };
            let connected = Vec4::splat(vertex.direct / origin);
            (connected, parameters.connections() * found)
        }
        Some(index) => {
            let parent = &vertices[index];
            let connects = !parent.is_delta;
            let before = parent.parent;
            let ends = EndPdfs {
                here: Vec4::ONE,
                before: before.map_or(start.pdf_rev, |before| vertices[before].pdf_rev),
            };
            let first = core::iter::successors(Some(index), |i| vertices[*i].parent).last()?;
            let light = LightEnd {
                can_be_hit: start.emission.origin.can_be_hit(),
                emitted: origin,
                sampled: vertices[first].direct,
                merging: parameters.area(),
                connections: parameters.connections(),
            };
            let lane = |rest| {
                pdf_ratios_fewer(vertices, index, rest, ends, light, start.pdf_rev, connects)
            };
            let lanes = [Vec4::X, Vec4::Y, Vec4::Z, Vec4::W].map(lane);
            let distance_squared = parent.point.position.distance_squared(point.position);
            let per_area = parent.per_area(vertex.wo, distance_squared);
            let connected = if connects {
                parent.throughput.r_u
            } else {
                Vec4::ZERO
            };
            (connected, Vec4::from_array(lanes) * per_area)
        }
    };
    (cos > 0.0).then(|| Photon {
        position: point.position,
        normal: point.normal,
        from: vertex.wo,
        value: vertex.throughput.beta / cos,
        r_u: vertex.throughput.r_u,
        arrival: vertex.arrival,
        connected: parameters.connections() * connected,
        pdf_ratios_fewer: pdf_ratios_fewer * vertex.passed,
        segments: vertex.segments,
    })
}
