//! A path in a participating medium: free flight, next-event estimation and scattering at a point of space.

use crate::candidates::{Aim, Candidates};
use crate::dimensions::BounceSamples;
use crate::equiangular::Equiangular;
use crate::light_mis::LightMis;
use crate::path_hooks::PathHooks;
use crate::path_state::{PathState, ShadowRay};
use crate::path_throughput::PathThroughput;
use crate::settings::{LightCandidates, PathSettings};
use crate::steps;
use etalon_sampling::Sampler;
use etalon_transport::{
    Collision, LightSample, LightSampleContext, Media, Medium, MediumOf, Phase, Ray, Transmission,
    World,
};
use glam::{Vec3, Vec4};

/// Where a path is scattered in a medium.
struct Arrival {
    at: Vec3,
    /// f / p₀ there, and pₖ / p₀ of all ways to sample a light there.
    lit: PathThroughput,
    /// pₖ / p₀ of free flight alone, after which the path goes on.
    flown: Vec4,
}

impl<S: Sampler, C: PathHooks> PathState<S, C> {
    /// The medium that the path is in.
    #[inline]
    fn medium<'w, W: World>(&self, world: &'w W) -> Option<MediumOf<'w, W>> {
        let (medium, waves) = (self.ray.medium, &self.wavelengths);
        match self.entered {
            Some((entered, coefficients)) if entered == medium => {
                world.media().entered(medium, coefficients, waves)
            }
            _ => world.media().medium(medium, waves),
        }
    }

    /// Decides how far the path flies through the medium that it is in, so that no surface beyond is looked for.
    #[cold]
    #[inline(never)]
    pub(crate) fn prepare_flight<W: World>(&mut self, world: &W) {
        self.flight = self.draw_event().lobe;
        if self.variant.equiangular {
            return;
        }
        let medium = self.medium(world);
        let reach = medium.and_then(|medium| medium.reach(&self.ray, self.flight));
        // A little farther than where light is scattered, be it at once, so that it is a surface that ends the ray or nothing. NaN
        // changes nothing.
        let farther = |t| t * 1.01 + f32::MIN_POSITIVE;
        self.ray.t_max = self.ray.t_max.min(reach.map_or(f32::INFINITY, farther));
    }

    /// Flies through the medium to the hit, or to where light is scattered before it. Whether the path has left its
    /// ray: it goes on from a point of the medium, or has ended.
    #[cold]
    #[inline(never)]
    pub(crate) fn fly<W: World>(&mut self, world: &W, settings: &PathSettings) -> bool {
        let u = self.flight;
        let scatters = self.depth < settings.max_depth;
        let along =
            (self.variant.equiangular && scatters && !world.media().is_dark(self.ray.medium))
                .then(|| self.look_along(world, settings))
                .flatten();
        let hit = self.hit.as_ref();
        let Some(medium) = self.medium(world) else {
            return false;
        };
        let flight = steps::flight_in(&medium, &self.ray, hit, u);
        let density = flight.density();
        self.light_mis.r_l /= density.x;
        let (ray, light_mis) = (&self.ray, &self.light_mis);
        let emitted = steps::emitted_on_the_way(world, &flight, ray, &self.throughput, light_mis);
        self.add_emission(emitted);
        let before = self.throughput.r_u;
        self.throughput.scatter(flight.factor, density);
        self.hooks.on_medium(&self.throughput);
        let Some(Collision { t, phase, .. }) = flight.scattering else {
            return false;
        };
        self.alpha = 1.0;
        if self.throughput.beta != Vec4::ZERO && scatters {
            let looked_for = along.map_or(0.0, |along| along.density(t) / density.x);
            let PathThroughput { beta, r_u } = self.throughput;
            let arrival = Arrival {
                at: self.ray.at(t),
                lit: PathThroughput {
                    beta,
                    r_u: r_u + before * looked_for,
                },
                flown: r_u,
            };
            self.scatter_in_medium(world, settings, &arrival, &phase);
        }
        true
    }

    /// Looks for light along the ray: chooses a point of a light, a point of the ray by the angle seen from there, and
    /// a light sample at that; all but the first are combined with free flight by multiple importance sampling. Nothing, in a
    /// vacuum, or if the light chosen is at infinity.
    fn look_along<W: World>(&mut self, world: &W, settings: &PathSettings) -> Option<Equiangular> {
        let medium = self.medium(world)?;
        let event = self.draw_event();
        let t_max = self.hit.map_or(self.ray.t_max, |hit| hit.t);
        let middle = if t_max.is_finite() { 0.5 * t_max } else { 0.0 };
        let from = LightSampleContext::in_space(self.ray.at(middle)).at(self.ray.time);
        let light =
            world.sample_light(&from, &self.wavelengths, event.light_choice, event.light)?;
        let along = Equiangular::new(&self.ray, t_max, light.target?)?;
        let t = along.sample(event.lobe);
        let at = self.ray.at(t);
        let coefficients = medium.coefficients(at, self.ray.direction);
        if !(t < t_max) || coefficients.scattering == Vec4::ZERO {
            return Some(along);
        }
        let Transmission {
            transmittance,
            probability,
        } = medium.transmittance(&self.ray, t, &mut self.ray.stream(event.roulette));
        let density = along.density(t);
        let flown = probability * coefficients.extinction() / density;
        let PathThroughput { beta, r_u } = self.throughput;
        let lit = PathThroughput {
            beta: beta * transmittance * coefficients.scattering / density,
            r_u: r_u * (Vec4::ONE + flown),
        };
        if lit.beta != Vec4::ZERO {
            let event = self.draw_event();
            let arrival = Arrival {
                at,
                lit,
                flown: r_u * flown,
            };
            self.light_in_medium(world, settings, &arrival, &medium.phase(at), &event);
            self.trace_shadow(world);
        }
        Some(along)
    }

    /// Light samples and the next direction at a point of a medium.
    fn scatter_in_medium<W: World>(
        &mut self,
        world: &W,
        settings: &PathSettings,
        arrival: &Arrival,
        phase: &impl Phase,
    ) {
        let (wo, time, medium) = (-self.ray.direction, self.ray.time, self.ray.medium);
        let event = self.draw_event();
        let mut sampled = None;
        if !world.media().is_dark(medium) {
            sampled = Some(self.light_in_medium(world, settings, arrival, phase, &event));
            self.hooks.on_light_sample();
        }
        let sample = phase.sample(wo, event.direction);
        self.scatter_count += 1;
        self.variant.candidates = LightCandidates::ONE;
        let density = sample.density.lanes();
        self.light_mis = sampled.map_or(LightMis::NONE, |from| LightMis {
            from,
            r_l: arrival.lit.r_u / density.x,
        });
        self.throughput.scatter(sample.value, density);
        self.ray = Ray {
            medium,
            ..Ray::new(arrival.at, sample.wi, time)
        };
        self.hooks.on_medium(&self.throughput);
        let survival = self.throughput.survival_in_medium(self.eta());
        self.lengthen_with(settings, &event, |path| {
            path.hooks.on_roulette(survival);
            survival
        });
    }

    /// Prepares the shadow ray of a light sample at a point of the medium.
    fn light_in_medium<W: World>(
        &mut self,
        world: &W,
        settings: &PathSettings,
        arrival: &Arrival,
        phase: &impl Phase,
        event: &BounceSamples,
    ) -> LightSampleContext {
        let Arrival { at, lit, flown } = *arrival;
        let (wo, time, medium) = (-self.ray.direction, self.ray.time, self.ray.medium);
        let from = LightSampleContext::in_space(at).at(time).combined();
        let candidates = Candidates::at(self.variant.candidates, world, &from);
        let aim = |light: &LightSample| {
            let contribution = phase.eval(wo, light.direction) * light.radiance;
            let density = phase.density(wo, light.direction);
            (contribution != Vec4::ZERO)
                .then(|| Aim::of(light, &lit, flown, contribution, density, [1.0; 2]))
        };
        let (waves, sampler) = (&self.wavelengths, &mut self.sampler);
        let aim = candidates.draw(world, &from, waves, event, sampler, aim);
        self.shadow_ray = aim.and_then(|aim| {
            let ray = match aim.target {
                Some(target) => Ray::between(at, target, time)?,
                None => Ray::new(at, aim.direction, time),
            };
            Some(ShadowRay {
                ray: Ray { medium, ..ray },
                crossings: self.null_crossings(settings),
                aim,
                found: None,
            })
        });
        from
    }
}
