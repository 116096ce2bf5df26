//! A particle from a light, from one scattering vertex to the next.
//!
//! `ptracer`, `forward` and photon maps use the same particles: the first connects them with the
//! camera, the second waits until they hit the aperture, the third stores them.

use crate::steps::arrival::{free_flight, next_hit};
use crate::steps::dimensions::{self as dim, BounceSamples, draw_flight};
use crate::steps::path_throughput::PathThroughput;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, BsdfSample, Emission, Hit, Phase, Ray, Scatterer, ScattererOf, SurfaceInteraction,
    Surfaces, TransportMode, World,
};
use glam::{Vec3, Vec4};

/// The light's choices come first; scattering events follow at the usual places.
const EMISSION_POSITION: u32 = dim::SCATTERING;
const EMISSION_DIRECTION: u32 = dim::SCATTERING + 2;
const EMISSION_LIGHT: u32 = dim::SCATTERING + 4;

/// A particle from a light, at one of its segments.
pub(crate) struct LightPath<'a> {
    wavelengths: &'a Wavelengths,
    /// Its flux over its density, per lane, and how likely each lane's choices were.
    pub(crate) throughput: PathThroughput,
    /// Its ray.
    pub(crate) ray: Ray,
    /// Number of segments, that of `ray` included.
    pub(crate) depth: u32,
    /// Its throughput where `ray` begins.
    departed: f32,
}

/// A surface at which a particle arrives, or a point of a medium that scatters it.
pub(crate) struct LightVertex<B> {
    pub(crate) point: SurfaceInteraction,
    /// Unit direction to where it came from.
    pub(crate) wo: Vec3,
    pub(crate) bsdf: B,
    /// The random numbers of its scattering there.
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
        let throughput = PathThroughput {
            beta: start.weight,
            ..PathThroughput::START
        };
        let particle = Self {
            wavelengths,
            throughput,
            ray: start.ray,
            depth: 1,
            departed: throughput.magnitude(),
        };
        Some((start, particle))
    }

    /// The next scattering vertex; `None` if it leaves the scene.
    #[inline]
    pub(crate) fn next<'w, W: World>(
        &mut self,
        world: &'w W,
        sampler: &mut impl Sampler,
    ) -> Option<LightVertex<ScattererOf<'w, W>>> {
        let hit = next_hit(world, &mut self.ray, false);
        let wo = -self.ray.direction;
        if self.ray.medium.is_some()
            && let Some(vertex) = self.fly(world, hit.as_ref(), sampler)
        {
            return Some(vertex);
        }
        let point = world.surfaces().vertex(&self.ray, &hit?);
        Some(LightVertex {
            point,
            wo,
            bsdf: Scatterer::Surface(world.surfaces().bsdf(&point, wo, self.wavelengths)),
            event: BounceSamples::draw(sampler, self.depth),
        })
    }

    /// Flies through a medium; `None` if it is not scattered before its hit.
    #[cold]
    #[inline(never)]
    fn fly<'w, W: World>(
        &mut self,
        world: &'w W,
        hit: Option<&Hit>,
        sampler: &mut impl Sampler,
    ) -> Option<LightVertex<ScattererOf<'w, W>>> {
        let u = draw_flight(sampler, self.depth);
        let flight = free_flight(world, &self.ray, hit, self.wavelengths, u)?;
        self.throughput.scatter(flight.factor, flight.density());
        let collision = flight.scattering?;
        Some(LightVertex {
            point: SurfaceInteraction::in_space(&self.ray, collision.t),
            wo: -self.ray.direction,
            bsdf: Scatterer::Space(collision.phase),
            event: BounceSamples::draw(sampler, self.depth),
        })
    }

    /// Scatters it at the vertex; `None` if it ends there. From `rr_depth` segments on it survives
    /// with a probability relative to its flux before: emitted flux has no natural scale.
    #[inline]
    pub(crate) fn scatter<B: Bsdf, P: Phase>(
        &mut self,
        vertex: &LightVertex<Scatterer<B, P>>,
        rr_depth: u32,
    ) -> Option<BsdfSample> {
        let BounceSamples {
            lobe,
            direction,
            roulette,
            ..
        } = vertex.event;
        let sample = (vertex.bsdf).sample(vertex.wo, lobe, direction, TransportMode::Importance)?;
        self.throughput.scatter(sample.value, sample.chance.lanes());
        if self.depth >= rr_depth {
            let survival = self
                .throughput
                .survival_of_flux(self.departed, vertex.bsdf.is_in_space());
            if !self.throughput.survives(survival, roulette) {
                return None;
            }
        }
        if self.throughput.beta == Vec4::ZERO {
            return None;
        }
        self.departed = self.throughput.magnitude();
        self.ray = vertex.point.spawn(sample.wi);
        self.depth += 1;
        Some(sample)
    }
}
