//! A training path of path guiding: remembers, for every vertex, what radiance came from the sampled direction.
//!
//! ```text
//! L(x, ω) ≈ Le(y) + L_lights(y) + ρ(y)·E(y)/π,        y the surface seen from x along ω
//! ```
//!
//! Le is what y emits toward x, weighted against light sampling as in the picture; L_lights the one light
//! sample taken at y; ρ its albedo; E the irradiance that scattering found there in the
//! round before: the mean record of y's region and face. Whatever the path finds behind y is a noisy
//! estimate of the last term, and replaced by it (expected SARSA: Dahm & Keller 2017, "Learning Light Transport
//! the Reinforced Way"). With indirect light only, few training paths reach a light; the irradiance cached at the
//! next diffuse surface gives every path a useful estimate.
//!
//! That term is true of diffuse surfaces. Where a surface scatters otherwise, the path itself tells what comes
//! from it, up to the next diffuse one.

use super::fraction::AlternativePdfs;
use super::guided_bsdf::GuidedBsdf;
use super::guided_hooks::{GuidedHooks, toward};
use super::sd_tree;
use crate::path::hooks::PathHooks;
use crate::steps::path_throughput::PathThroughput;
use etalon_math::lane::Lane;
use etalon_transport::{Bsdf, BsdfSample, SurfaceInteraction};
use glam::{Vec3, Vec4};
use std::f32::consts::FRAC_1_PI;
use std::ops::RangeInclusive;

/// A vertex of a path: the direction it took, and what it found that way.
struct PathVertex {
    position: Vec3,
    /// The shading normal on the side from which the path came.
    normal: Vec3,
    direction: Vec3,
    /// f·|cos θ|, or the share of a discrete direction.
    value: Vec4,
    /// The density of the direction, the mean over the lanes (sr⁻¹), or the probability of a discrete one.
    density: f32,
    discrete: bool,
    /// The densities of its alternatives, if the field has learned anything here.
    alternatives: Option<AlternativePdfs>,
    /// The path that leaves the vertex.
    throughput: PathThroughput,
    found: Vec4,
}

/// A light that came from a direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Record {
    pub(crate) position: Vec3,
    /// The normal of the surface that it fell on.
    pub(crate) normal: Vec3,
    pub(crate) direction: Vec3,
    /// Its irradiance on the surface: radiance times cosine, over the density of the direction. `None` for a
    /// discrete direction, which no lobe can find.
    pub(crate) weight: Option<f32>,
    /// What the surface scatters of it, over the density of the direction, and how else that might have been
    /// found.
    pub(crate) scattered: Option<(f32, AlternativePdfs)>,
}

/// Steers a path in training and remembers what it finds at every vertex.
pub(crate) struct TrainingPath<'f> {
    guide: GuidedHooks<'f>,
    vertices: Vec<PathVertex>,
    /// The path as it left the last surface.
    path: PathThroughput,
    /// The first vertex that still waits for what comes from its direction.
    open: usize,
    /// The vertices that waited when the light sample was chosen.
    before_light: (usize, usize),
}

/// Range of f over that of a diffuse surface of the same albedo, within which a surface counts as diffuse.
const DIFFUSE: RangeInclusive<f32> = 0.7..=1.4;

impl<'f> TrainingPath<'f> {
    pub(crate) fn new(guide: GuidedHooks<'f>) -> Self {
        Self {
            guide,
            vertices: Vec::new(),
            path: PathThroughput::START,
            open: 0,
            before_light: (0, 0),
        }
    }

    /// Begins another path.
    pub(crate) fn begin(&mut self) {
        self.vertices.clear();
        self.path = PathThroughput::START;
        self.open = 0;
        self.before_light = (0, 0);
        self.guide.reflected = 1.0;
    }

    /// The records of each vertex.
    pub(crate) fn records(&self) -> impl Iterator<Item = Record> {
        self.vertices.iter().map(|vertex| {
            let cos = vertex.normal.dot(vertex.direction).abs();
            let weight = vertex.incident(Vec4::ONE) * cos / vertex.density;
            let scattered =
                |alternatives| (vertex.incident(vertex.value) / vertex.density, alternatives);
            Record {
                position: vertex.position,
                normal: vertex.normal,
                direction: vertex.direction,
                weight: (!vertex.discrete).then_some(weight),
                scattered: vertex.alternatives.map(scattered),
            }
        })
    }

    /// Tells the vertices that wait for it what a diffuse surface reflects; they wait no longer.
    fn reflect(&mut self, position: Vec3, normal: Vec3, albedo: Vec4) {
        let irradiance = self.guide.field.irradiance(position, normal);
        let radiance = albedo * (irradiance * FRAC_1_PI);
        let estimate = self.path.contribution(radiance, Vec4::ZERO);
        for vertex in &mut self.vertices[self.open..] {
            vertex.found += estimate;
        }
        self.open = self.vertices.len();
    }
}

impl PathVertex {
    /// An estimate of the radiance that comes from the vertex's direction, times `factor`, the mean over the lanes,
    /// which are drawn as the eye is sensitive to them. Exact in expectation where later densities are the same in all lanes;
    /// only noise depends on it.
    fn incident(&self, factor: Vec4) -> f32 {
        let value = self.throughput.beta;
        let seen = value.cmpgt(Vec4::ZERO);
        let radiance = factor * self.found * self.throughput.r_u.element_sum() / value;
        0.25 * Vec4::select(seen, radiance, Vec4::ZERO).element_sum()
    }
}

impl<'f> PathHooks for TrainingPath<'f> {
    /// A training path keeps what it finds vertex by vertex.
    const LANES: bool = false;

    type Lanes<F: Lane> = ();

    type GuidedBsdf<B: Bsdf + Copy> = GuidedBsdf<'f, B>;

    fn in_lanes<'h, F: Lane>(_: impl Fn(usize) -> &'h Self)
    where
        Self: 'h,
    {
    }

    fn take_lane<F: Lane>(&mut self, (): &(), _: usize) {}

    fn wrap_bsdf<B: Bsdf + Copy>(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        bsdf: impl FnOnce() -> B,
    ) -> GuidedBsdf<'f, B> {
        self.guide.wrap_bsdf(vertex, wo, bsdf)
    }

    fn on_scatter(
        &mut self,
        vertex: &SurfaceInteraction,
        bsdf: &impl Bsdf,
        wo: Vec3,
        sample: &BsdfSample,
        throughput: &PathThroughput,
    ) {
        self.guide.on_scatter(vertex, bsdf, wo, sample, throughput);
        let normal = toward(vertex, wo);
        let discrete = sample.chance.is_delta();
        if !discrete {
            let albedo = bsdf.albedo(wo);
            let diffuse = albedo.element_sum() * normal.dot(sample.wi).abs() * FRAC_1_PI;
            if DIFFUSE.contains(&(sample.value.element_sum() / diffuse)) {
                self.reflect(vertex.position, normal, albedo);
            }
        }
        let density = 0.25 * sample.chance.lanes().element_sum();
        let lobe = match bsdf.has_continuous() && !sample.is_null {
            true => self.guide.field.lobe(vertex.position, normal),
            false => None,
        };
        let alternatives = lobe.map(|(lobe, share)| match discrete {
            true => AlternativePdfs {
                own: 1.0,
                learned: 0.0,
            },
            false => {
                let scattered = 1.0 - 0.25 * bsdf.null_probability().element_sum();
                let learned = scattered * sd_tree::density(lobe, sample.wi).hero();
                let own = (density - (1.0 - share) * learned) / share;
                AlternativePdfs {
                    own: own.max(0.0),
                    learned,
                }
            }
        });
        if !discrete || alternatives.is_some() {
            self.vertices.push(PathVertex {
                position: vertex.position,
                normal,
                direction: sample.wi,
                value: sample.value,
                density,
                discrete,
                alternatives,
                throughput: *throughput,
                found: Vec4::ZERO,
            });
        }
        self.path = *throughput;
    }

    fn on_medium(&mut self, throughput: &PathThroughput) {
        self.path = *throughput;
    }

    fn on_roulette(&mut self, survival: f32) {
        self.path.roulette(survival);
    }

    fn on_emission(&mut self, estimate: Vec4) {
        for vertex in &mut self.vertices[self.open..] {
            vertex.found += estimate;
        }
    }

    fn on_light_sample(&mut self) {
        self.before_light = (self.open, self.vertices.len());
    }

    fn on_light_contribution(&mut self, estimate: Vec4) {
        let (open, end) = self.before_light;
        for vertex in &mut self.vertices[open..end] {
            vertex.found += estimate;
        }
    }

    fn survival(&mut self, throughput: &PathThroughput, eta: f32) -> f32 {
        let survival = self.guide.survival(throughput, eta);
        self.path.roulette(survival);
        survival
    }
}

#[cfg(test)]
mod tests;
