//! What goes along with every path of `guided`: it steers, and decides how long paths live.

use super::field::Field;
use super::steering::Steered;
use crate::companion::Companion;
use crate::prefix::Prefix;
use etalon_transport::{Bsdf, BsdfSample, Vertex};
use glam::{Vec3, Vec4};

/// Steers a path.
///
/// Where a path follows what was learned its throughput f/p is small just where it matters: p is large
/// toward the light. Russian roulette by throughput would end such paths. So a path lives as long as what
/// surfaces reflect, whatever the direction, would let it: the product of their albedos. One of
/// larger throughput, which went where little was expected, is not made heavier still.
#[derive(Clone, Copy)]
pub(crate) struct Guide<'f> {
    pub(crate) field: &'f Field,
    /// The probability of following the scattering model's own choice.
    pub(crate) own: f32,
    /// The product of the albedos along the path, over the probabilities with which it survived.
    pub(crate) reflected: f32,
}

/// The shading normal on the side of `wo`.
#[inline]
fn toward(vertex: &Vertex, wo: Vec3) -> Vec3 {
    let normal = vertex.shading.n;
    if normal.dot(wo) < 0.0 {
        -normal
    } else {
        normal
    }
}

/// The least probability of surviving roulette.
const LEAST_SURVIVAL: f32 = 0.05;

impl<'f> Companion for Guide<'f> {
    type Steered<B: Bsdf + Copy> = Steered<'f, B>;

    #[inline]
    fn steer<B: Bsdf + Copy>(&self, vertex: &Vertex, wo: Vec3, bsdf: B) -> Steered<'f, B> {
        let lobe = if bsdf.has_continuous() {
            self.field.lobe(vertex.position, toward(vertex, wo))
        } else {
            None
        };
        Steered {
            bsdf,
            lobe,
            own: self.own,
        }
    }

    #[inline]
    fn scattered(
        &mut self,
        _: &Vertex,
        bsdf: &impl Bsdf,
        wo: Vec3,
        sample: &BsdfSample,
        _: &Prefix,
    ) {
        self.reflected *= if sample.chance.is_discrete() {
            let chance = sample.chance.lanes();
            4.0 * sample.value.max_element() / chance.element_sum()
        } else {
            bsdf.albedo(wo).max_element()
        };
    }

    #[inline]
    fn survival(&mut self, prefix: &Prefix, eta: f32) -> f32 {
        let most = self.reflected.max(prefix.throughput());
        let survival = (most * eta * eta).clamp(LEAST_SURVIVAL, 0.95);
        self.reflected /= survival;
        survival
    }
}

/// A corner of a path in training: the direction it took, and what it found that way.
struct Corner {
    position: Vec3,
    /// The shading normal on the side from which the path came.
    normal: Vec3,
    direction: Vec3,
    /// The density of the direction, the mean over the lanes (sr⁻¹).
    density: f32,
    /// The path that leaves the corner.
    prefix: Prefix,
    found: Vec4,
}

/// A light that came from a direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Record {
    pub(crate) position: Vec3,
    /// The normal of the surface that it fell on.
    pub(crate) normal: Vec3,
    pub(crate) direction: Vec3,
    /// Its irradiance on the surface: radiance times cosine, over the density of the direction.
    pub(crate) weight: f32,
}

/// Steers a path in training and remembers what it finds at every corner.
pub(crate) struct Pupil<'f> {
    guide: Guide<'f>,
    corners: Vec<Corner>,
    /// How many corners lie before the vertex of the light sample.
    before_light: usize,
}

impl<'f> Pupil<'f> {
    pub(crate) fn new(guide: Guide<'f>) -> Self {
        Self {
            guide,
            corners: Vec::new(),
            before_light: 0,
        }
    }

    /// Begins another path.
    pub(crate) fn begin(&mut self) {
        self.corners.clear();
        self.guide.reflected = 1.0;
    }

    /// What was found, corner by corner.
    pub(crate) fn records(&self) -> impl Iterator<Item = Record> {
        self.corners.iter().map(|corner| Record {
            position: corner.position,
            normal: corner.normal,
            direction: corner.direction,
            weight: corner.incident() * corner.normal.dot(corner.direction).abs() / corner.density,
        })
    }
}

impl Corner {
    /// An estimate of the radiance that comes from the corner's direction, the mean over the lanes, which
    /// are drawn as the eye sees. Exact in expectation where later densities are the same in all lanes; but
    /// for noise, nothing depends on it.
    fn incident(&self) -> f32 {
        let value = self.prefix.value;
        let seen = value.cmpgt(Vec4::ZERO);
        let radiance = self.found * self.prefix.ratio.element_sum() / value;
        0.25 * Vec4::select(seen, radiance, Vec4::ZERO).element_sum()
    }
}

impl<'f> Companion for Pupil<'f> {
    type Steered<B: Bsdf + Copy> = Steered<'f, B>;

    fn steer<B: Bsdf + Copy>(&self, vertex: &Vertex, wo: Vec3, bsdf: B) -> Steered<'f, B> {
        self.guide.steer(vertex, wo, bsdf)
    }

    fn scattered(
        &mut self,
        vertex: &Vertex,
        bsdf: &impl Bsdf,
        wo: Vec3,
        sample: &BsdfSample,
        prefix: &Prefix,
    ) {
        self.guide.scattered(vertex, bsdf, wo, sample, prefix);
        if !sample.chance.is_discrete() {
            self.corners.push(Corner {
                position: vertex.position,
                normal: toward(vertex, wo),
                direction: sample.wi,
                density: 0.25 * sample.chance.lanes().element_sum(),
                prefix: *prefix,
                found: Vec4::ZERO,
            });
        }
    }

    fn found(&mut self, estimate: Vec4) {
        for corner in &mut self.corners {
            corner.found += estimate;
        }
    }

    fn aimed(&mut self) {
        self.before_light = self.corners.len();
    }

    fn lit(&mut self, estimate: Vec4) {
        for corner in &mut self.corners[..self.before_light] {
            corner.found += estimate;
        }
    }

    fn survival(&mut self, prefix: &Prefix, eta: f32) -> f32 {
        self.guide.survival(prefix, eta)
    }
}
