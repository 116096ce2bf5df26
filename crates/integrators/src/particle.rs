//! One particle from a light, from surface to surface.
//!
//! What `ptracer` connects with the camera, `forward` waits for, and photon maps keep: they differ
//! in what they do with a particle, not in how it goes.

use crate::dimensions::{self as dim, BounceSamples};
use crate::path_throughput::{MOST, PathThroughput};
use crate::steps::next_surface;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, BsdfSample, Emission, Hit, Ray, SurfaceInteraction, TransportMode, World,
};
use glam::{Vec3, Vec4};

/// The light's choices come first; scattering events follow at the usual places.
const EMISSION_POSITION: u32 = dim::SCATTERING;
const EMISSION_DIRECTION: u32 = dim::SCATTERING + 2;
const EMISSION_LIGHT: u32 = dim::SCATTERING + 4;

/// A particle on its way.
pub(crate) struct LightPath<'a> {
    wavelengths: &'a Wavelengths,
    /// Its flux over its density, per lane, and how likely each lane's choices were.
    pub(crate) prefix: PathThroughput,
    /// Where it goes.
    pub(crate) ray: Ray,
    /// Number of segments, that of `ray` included.
    pub(crate) depth: u32,
}

/// A surface that a particle met.
pub(crate) struct LightVertex<B> {
    pub(crate) hit: Hit,
    pub(crate) vertex: SurfaceInteraction,
    /// Unit direction to where it came from.
    pub(crate) wo: Vec3,
    pub(crate) bsdf: B,
    /// The numbers that decide what becomes of it here.
    pub(crate) event: BounceSamples,
}

impl<'a> LightPath<'a> {
    /// A particle that leaves a light at the moment `time`; `None` if nothing is emitted.
    #[inline]
    pub(crate) fn emit<W: World>(
        world: &W,
        wavelengths: &'a Wavelengths,
        sampler: &mut impl Sampler,
        time: f32,
    ) -> Option<(Emission, Self)> {
        sampler.skip_to(EMISSION_POSITION);
        let u_position = sampler.next_2d();
        sampler.skip_to(EMISSION_DIRECTION);
        let u_direction = sampler.next_2d();
        sampler.skip_to(EMISSION_LIGHT);
        let u_light = sampler.next_1d();
        let start = world.emit(wavelengths, u_light, u_position, u_direction, time)?;
        let particle = Self {
            wavelengths,
            prefix: PathThroughput {
                beta: start.weight,
                ..PathThroughput::START
            },
            ray: start.ray,
            depth: 1,
        };
        Some((start, particle))
    }

    /// The next surface on its way; `None` if it leaves the scene.
    #[inline]
    pub(crate) fn next<'w, W: World>(
        &mut self,
        world: &'w W,
        sampler: &mut impl Sampler,
    ) -> Option<LightVertex<W::Bsdf<'w>>> {
        let (hit, vertex) = next_surface(world, &mut self.ray, false)?;
        let wo = -self.ray.direction;
        Some(LightVertex {
            hit,
            vertex,
            wo,
            bsdf: world.bsdf(&vertex, wo, self.wavelengths),
            event: BounceSamples::draw(sampler, self.depth),
        })
    }

    /// Takes it around the corner; `None` if it ends there. From `rr_depth` segments on it survives
    /// with a probability relative to its flux before: emitted flux has no natural scale.
    #[inline]
    pub(crate) fn scatter<B: Bsdf>(
        &mut self,
        met: &LightVertex<B>,
        rr_depth: u32,
    ) -> Option<BsdfSample> {
        let BounceSamples {
            lobe,
            direction,
            roulette,
            ..
        } = met.event;
        let sample = (met.bsdf).sample(met.wo, lobe, direction, TransportMode::Importance)?;
        let before = self.prefix.throughput();
        self.prefix.scatter(sample.value, sample.chance.lanes());
        if self.depth >= rr_depth {
            let survival = (self.prefix.throughput() / before).min(MOST);
            if !self.prefix.survives(survival, roulette) {
                return None;
            }
        }
        if self.prefix.beta == Vec4::ZERO {
            return None;
        }
        self.ray = met.vertex.spawn(sample.wi);
        self.depth += 1;
        Some(sample)
    }
}
