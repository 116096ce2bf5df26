//! Evaluates a camera path at other wavelengths.
//!
//! Continuous lobes are evaluated. Delta lobes have values for samples only: the BSDF at the other wavelengths is
//! sampled with the same random numbers, and with further ones if it chooses another lobe.

use super::sets::{WavelengthChoice, WavelengthSets};
use crate::steps::path_throughput::PathThroughput;
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, BsdfSample, SurfaceInteraction, Surfaces, TransportMode, World};
use glam::{Vec2, Vec3, Vec4};

/// A vertex of a camera path, with the direction sampled there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CameraVertex {
    vertex: SurfaceInteraction,
    wo: Vec3,
    wi: Vec3,
    manner: ScatterKind,
    /// Density or probability of the lane that chose, times that of surviving.
    chance: f32,
}

/// The kind of interaction.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ScatterKind {
    Passing,
    Continuous,
    /// In a discrete direction, found with these numbers.
    Discrete {
        lobe: f32,
        u: Vec2,
    },
}

/// The squared distance at which unit vectors are the same direction.
const SAME: f32 = 1e-8;

impl CameraVertex {
    /// The surface that was left as `sample` says, found with the numbers `lobe` and `u`.
    pub(crate) fn new(
        vertex: SurfaceInteraction,
        wo: Vec3,
        sample: &BsdfSample,
        lobe: f32,
        u: Vec2,
    ) -> Self {
        let manner = if sample.is_null {
            ScatterKind::Passing
        } else if sample.chance.is_delta() {
            ScatterKind::Discrete { lobe, u }
        } else {
            ScatterKind::Continuous
        };
        Self {
            vertex,
            wo,
            wi: sample.wi,
            manner,
            chance: sample.chance.lanes().x,
        }
    }

    /// It survived roulette here with probability `q`.
    pub(crate) fn roulette(&mut self, q: f32) {
        self.chance *= q;
    }

    /// f/p₀ of leaving this way, f at other wavelengths.
    fn value<W: World>(&self, world: &W, wavelengths: &Wavelengths) -> Vec4 {
        let bsdf = world.surfaces().bsdf(&self.vertex, self.wo, wavelengths);
        let value = match self.manner {
            ScatterKind::Passing => bsdf.null_transmittance(),
            ScatterKind::Continuous => bsdf.eval(self.wo, self.wi, TransportMode::Radiance),
            ScatterKind::Discrete { lobe, u } => discrete(&bsdf, self.wo, self.wi, lobe, u),
        };
        value / self.chance
    }
}

/// A camera path up to a surface where it gathers photons.
#[derive(Clone, Copy)]
pub(crate) struct CameraPath<'a> {
    pub(crate) sets: &'a WavelengthSets,
    /// Its own wavelengths, and its value and densities at them.
    pub(crate) lanes: WavelengthChoice,
    pub(crate) throughput: &'a PathThroughput,
    /// Whether smooth dispersion has left one wavelength.
    pub(crate) alone: bool,
    /// The surfaces that it left.
    pub(crate) path: &'a [CameraVertex],
}

impl CameraPath<'_> {
    /// f/p₀ at the wavelengths of a set.
    pub(crate) fn value<W: World>(&self, world: &W, set: usize) -> Vec4 {
        if set == self.lanes.set {
            self.lanes.to_set(self.throughput.beta)
        } else {
            value(world, self.path, self.sets.get(set))
        }
    }

    /// 1 / Σₖ pₖ/p₀, from f/p₀ to f over the sum of the lanes' densities; times the number of sets if
    /// dispersion has left one lane, since then only photons of the path's own set contribute.
    pub(crate) fn scale(&self) -> f32 {
        let ways = if self.alone {
            self.sets.len() as f32
        } else {
            1.0
        };
        ways / self.throughput.r_u.element_sum()
    }

    /// `rgb` plus the photons' contributions, a sum for each set, carried to the camera.
    pub(crate) fn carried<W: World>(
        &self,
        world: &W,
        sums: impl Iterator<Item = Vec4>,
        mut rgb: Vec3,
    ) -> Vec3 {
        let scale = self.scale();
        for (set, sum) in sums.enumerate() {
            if sum == Vec4::ZERO {
                continue;
            }
            let path = self.value(world, set);
            rgb += self.sets.sensor(set).rgb(sum * path * scale);
        }
        rgb
    }
}

/// f/p₀ of a path, f at other wavelengths.
fn value<W: World>(world: &W, path: &[CameraVertex], wavelengths: &Wavelengths) -> Vec4 {
    let mut value = PathThroughput::START.beta;
    for left in path {
        value *= left.value(world, wavelengths);
        if value == Vec4::ZERO {
            break;
        }
    }
    value
}

/// The energy that goes in the discrete direction `wi`; zero if none does.
fn discrete(bsdf: &impl Bsdf, wo: Vec3, wi: Vec3, lobe: f32, u: Vec2) -> Vec4 {
    const TRIES: u8 = 64;
    // The ends first: one of them finds either lobe of a pair, however unlikely it is.
    let others = (0..TRIES).map(|i| (f32::from(i) + 0.5) / f32::from(TRIES));
    [lobe, 0.0, ONE_MINUS_EPSILON]
        .into_iter()
        .chain(others)
        .filter_map(|lobe| bsdf.sample(wo, lobe, u, TransportMode::Radiance))
        .find(|sample| {
            sample.chance.is_delta() && !sample.is_null && sample.wi.distance_squared(wi) < SAME
        })
        .map_or(Vec4::ZERO, |sample| sample.value)
}
