//! `path`: unidirectional path tracing with light sampling.
//!
//! The measurement of a pixel is an integral over paths x = x₀x₁…xₙ from the camera to a light,
//!
//! ```text
//! C = Σₙ ∫ Le(xₙ→xₙ₋₁) · Πᵢ fᵢ·|cos θᵢ| dω₁…dωₙ
//! ```
//!
//! (Kajiya 1986; Veach 1997, section 8.2). Directions are sampled from the scattering models;
//! the last one also from the lights ("next-event estimation"); the two techniques and the four
//! wavelengths are combined by one balance heuristic, see [`crate::prefix`].
//!
//! Surfaces that light passes straight (`mask`, `null`) count as segments, as in Mitsuba, but
//! neither stop shadow rays nor end light sampling's claim on a path: the density with which the
//! *last real vertex* would have sampled the light is carried across them.

use crate::dimensions::{self as dim, Event};
use crate::prefix::Prefix;
use crate::settings::{PathSettings, ignore_scheduling};
use etalon_params::Params;
use etalon_sampling::Sampler;
use etalon_spectrum::{Wavelengths, sensor_response};
use etalon_transport::{
    Bsdf, BsdfSample, Camera, Chance, Integrator, Mode, PixelSite, Ray, Sink, Vertex, World,
};
use glam::{Vec3, Vec4};

/// The path tracer.
#[derive(Clone, Debug, Default)]
pub struct Path {
    /// Limits of the path.
    pub settings: PathSettings,
}

impl Path {
    /// Reads the integrator from its description.
    pub fn from_params(params: &Params<'_>) -> Self {
        ignore_scheduling(params);
        Self {
            settings: PathSettings::from_params(params),
        }
    }
}

impl Integrator for Path {
    type State = ();

    fn prepare<W: World>(&self, _: &W, _: u64, _: u32) {}

    #[inline]
    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        (): &(),
        site: &PixelSite,
        sampler: &mut S,
        sink: &mut K,
    ) {
        let (wavelengths, ray, weight) = camera_ray(world, site, sampler);
        let found = self.incident(world, ray, &wavelengths, sampler);
        let rgb = sensor_response(&wavelengths).rgb(found.radiance * weight);
        sink.radiance(rgb.to_array(), found.alpha);
    }
}

/// Draws the wavelengths and the camera ray of a sample: everything before the first surface.
#[inline]
pub(crate) fn camera_ray<W: World, S: Sampler>(
    world: &W,
    site: &PixelSite,
    sampler: &mut S,
) -> (Wavelengths, Ray, f32) {
    sampler.skip_to(dim::LENS);
    let lens = sampler.next_2d();
    let wavelengths = world.wavelengths(sampler.next_1d());
    let time = sampler.next_1d();
    let start = world.camera().ray(site.raster, lens, time);
    (wavelengths, start.ray, start.weight)
}

/// What a camera ray found.
pub(crate) struct Found {
    /// Per lane, over the sum of all densities' ratios (see [`Prefix::estimate`]).
    pub(crate) radiance: Vec4,
    /// 1 if the path met anything that it did not pass straight, the background included; where
    /// its length ends at a surface, the probability of that.
    pub(crate) alpha: f32,
}

/// How the light sampling of the last real vertex competes with the direction just sampled.
#[derive(Clone, Copy)]
pub(crate) struct Rival {
    /// Where the last real vertex was.
    pub(crate) from: Vec3,
    /// The prefix's density ratio before that vertex scattered, over the densities chosen
    /// since: multiplied by the light's density it is pₜ,ₖ / p₀ of light sampling. Zero if light
    /// sampling could not have found the path.
    pub(crate) ratio: Vec4,
}

impl Rival {
    pub(crate) const NONE: Self = Self {
        from: Vec3::ZERO,
        ratio: Vec4::ZERO,
    };

    /// The rival after sampling `sample` at a vertex at `position` reached by `before`.
    #[inline]
    pub(crate) fn after(self, before: &Prefix, position: Vec3, sample: &BsdfSample) -> Self {
        let chance = sample.chance.lanes().x;
        if sample.passes {
            Self {
                from: self.from,
                ratio: self.ratio / chance,
            }
        } else if sample.chance.is_discrete() {
            Self::NONE
        } else {
            Self {
                from: position,
                ratio: before.ratio / chance,
            }
        }
    }

    #[inline]
    fn exists(&self) -> bool {
        self.ratio != Vec4::ZERO
    }

    /// pₜ,ₖ / p₀ of light sampling for an emitting surface.
    #[inline]
    pub(crate) fn at_surface<W: World>(&self, world: &W, at: &Vertex, direction: Vec3) -> Vec4 {
        if !self.exists() {
            return Vec4::ZERO;
        }
        self.ratio * world.light_density(self.from, at, direction).lanes()
    }

    /// pₜ,ₖ / p₀ of light sampling for the background.
    #[inline]
    pub(crate) fn at_background<W: World>(&self, world: &W, direction: Vec3) -> Vec4 {
        if !self.exists() {
            return Vec4::ZERO;
        }
        self.ratio * world.background_density(self.from, direction).lanes()
    }
}

impl Path {
    /// Radiance along a camera ray.
    #[inline]
    fn incident<W: World, S: Sampler>(
        &self,
        world: &W,
        mut ray: Ray,
        wavelengths: &Wavelengths,
        sampler: &mut S,
    ) -> Found {
        let PathSettings {
            max_depth,
            rr_depth,
            hide_emitters,
        } = self.settings;
        let mut found = Found {
            radiance: Vec4::ZERO,
            alpha: 0.0,
        };
        let mut prefix = Prefix::START;
        let mut rival = Rival::NONE;
        let mut eta = 1.0;
        let mut depth = 1;
        while depth <= max_depth {
            let Some(hit) = world.intersect(&ray) else {
                // A hidden sky stays hidden to rays that only went straight.
                let visible = !hide_emitters || found.alpha > 0.0;
                if visible && world.has_background() {
                    found.alpha = 1.0;
                    let radiance = world.background(ray.direction, wavelengths);
                    let other = rival.at_background(world, ray.direction);
                    found.radiance += prefix.estimate(radiance, other);
                }
                break;
            };
            let emits = world.is_emitter(&hit);
            if emits && hide_emitters && depth == 1 {
                // The camera looks through hidden lights.
                let vertex = world.vertex(&ray, &hit);
                ray = vertex.spawn(ray.direction);
                continue;
            }
            let last = depth == max_depth;
            if last && !emits && found.alpha > 0.0 {
                break;
            }
            let vertex = world.vertex(&ray, &hit);
            let wo = -ray.direction;
            if emits {
                let radiance = world.emitted(&vertex, wo, wavelengths);
                if radiance != Vec4::ZERO {
                    let other = rival.at_surface(world, &vertex, ray.direction);
                    found.radiance += prefix.estimate(radiance, other);
                }
            }

            let bsdf = world.bsdf(&vertex, wo, wavelengths);
            if last {
                // Where the path would go on we do not ask; how likely straight on, we know.
                let stopped = 1.0 - 0.25 * bsdf.passing_probability().element_sum();
                found.alpha = found.alpha.max(stopped);
                break;
            }
            let event = Event::draw(sampler, depth - 1);
            if bsdf.has_continuous() {
                let crossings = max_depth - depth - 1;
                found.radiance += sample_light(
                    world,
                    wavelengths,
                    &prefix,
                    &vertex,
                    &bsdf,
                    wo,
                    crossings,
                    &event,
                );
            }

            let Some(sample) = bsdf.sample(wo, event.lobe, event.direction, Mode::Radiance) else {
                found.alpha = 1.0;
                break;
            };
            if !sample.passes {
                found.alpha = 1.0;
            }
            rival = rival.after(&prefix, vertex.position, &sample);
            prefix.extend(sample.value, sample.chance.lanes());
            eta *= sample.eta;
            ray = vertex.spawn(sample.wi);
            if depth >= rr_depth {
                let survival = (prefix.throughput() * eta * eta).min(0.95);
                if !(event.roulette < survival) {
                    break;
                }
                prefix.survive(survival);
            }
            if prefix.value == Vec4::ZERO {
                break;
            }
            depth += 1;
        }
        found
    }
}

/// Next-event estimation at a vertex: the light found, weighted against scattering.
#[inline]
#[allow(clippy::too_many_arguments)]
pub(crate) fn sample_light<W: World>(
    world: &W,
    wavelengths: &Wavelengths,
    prefix: &Prefix,
    vertex: &Vertex,
    bsdf: &W::Bsdf<'_>,
    wo: Vec3,
    crossings: u32,
    event: &Event,
) -> Vec4 {
    let Some(light) = world.sample_light(vertex, wavelengths, event.light_choice, event.light)
    else {
        return Vec4::ZERO;
    };
    let (value, density) = bsdf.eval_and_density(wo, light.direction, Mode::Radiance);
    let contribution = value * light.radiance;
    if contribution == Vec4::ZERO {
        return Vec4::ZERO;
    }
    let Some(passage) = shadow(
        world,
        wavelengths,
        vertex,
        light.direction,
        light.target,
        crossings,
    ) else {
        return Vec4::ZERO;
    };
    let mut complete = *prefix;
    complete.extend(contribution * passage.transmittance, light.chance.lanes());
    let by_scattering = match light.chance {
        // Scattering never finds a discrete light.
        Chance::Discrete(_) => Vec4::ZERO,
        Chance::Continuous(chosen) => {
            prefix.ratio * density.lanes() * passage.probability / chosen.chooser()
        }
    };
    complete.estimate(Vec4::ONE, by_scattering)
}

/// The passage from a vertex to a light's point, or to infinity.
#[inline]
pub(crate) fn shadow<W: World>(
    world: &W,
    wavelengths: &Wavelengths,
    vertex: &Vertex,
    direction: Vec3,
    target: Option<Vec3>,
    crossings: u32,
) -> Option<etalon_transport::Passage> {
    let ray = match target {
        None => vertex.spawn(direction),
        Some(target) => Ray::between(vertex.origin_toward(target), target, vertex.time)?,
    };
    world.passage(&ray, wavelengths, crossings)
}
