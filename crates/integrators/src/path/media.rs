//! A path in a participating medium: free flight, next-event estimation and scattering at a point of space.

use crate::path::equiangular::Equiangular;
use crate::path::hooks::PathHooks;
use crate::path::state::{PathState, ShadowRay, Step};
use crate::steps::arrival;
use crate::steps::candidates::Candidates;
use crate::steps::dimensions::BounceSamples;
use crate::steps::light_connection::LightConnection;
use crate::steps::light_mis::LightMis;
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathConfig;
use core::ops::ControlFlow;
use etalon_sampling::Sampler;
use etalon_transport::{
    Collision, Hit, LightSample, LightSampleContext, Medium, MediumOf, Phase, Ray, Transmission,
    World,
};
use glam::{Vec3, Vec4};

/// A point of a medium where a path is scattered.
struct MediumVertex<'p, P> {
    position: Vec3,
    /// Whether light sampling is futile there.
    is_dark: bool,
    phase: &'p P,
    /// f / p₀ there, and pₖ / p₀ of all ways to sample a light there.
    throughput: PathThroughput,
    /// pₖ / p₀ of free flight alone, after which the path goes on.
    r_u_of_flight: Vec4,
}

impl<'w, W: World, S: Sampler, C: PathHooks> PathState<'w, W, S, C> {
    /// Draws the random number of the free flight through the medium of `ray`, if there is one.
    #[inline]
    pub(crate) fn plan_flight(&mut self, config: &PathConfig, ray: &mut Ray) {
        if ray.medium.is_some() {
            self.shorten(config, ray);
        }
    }

    /// Ends the ray at the point where the path is scattered, if that is known, so that surfaces beyond are not searched.
    #[cold]
    #[inline(never)]
    fn shorten(&mut self, config: &PathConfig, ray: &mut Ray) {
        self.flight = self.draw_event().lobe;
        if config.equiangular {
            return;
        }
        let reach = (self.medium.as_ref()).and_then(|medium| medium.reach(ray, self.flight));
        // A little farther than where light is scattered, be it at once, so that it is a surface that ends the ray or nothing. NaN
        // changes nothing.
        let farther = |t| t * 1.01 + f32::MIN_POSITIVE;
        ray.t_max = ray.t_max.min(reach.map_or(f32::INFINITY, farther));
    }

    /// Free flight through the medium to the hit. Breaks if the path is scattered before, with the step from there.
    #[cold]
    #[inline(never)]
    pub(crate) fn fly(
        &mut self,
        world: &'w W,
        config: &PathConfig,
        ray: &Ray,
        hit: Option<&Hit>,
    ) -> ControlFlow<Step> {
        let u = self.flight;
        let Some(medium) = self.medium else {
            return ControlFlow::Continue(());
        };
        let scatters = self.depth < config.limits.max_depth;
        let along = (config.equiangular && scatters && !medium.is_dark())
            .then(|| self.sample_equiangular(world, config, &medium, (ray, hit)))
            .flatten();
        let flight = arrival::flight_in(&medium, ray, hit, u);
        let density = flight.density();
        self.light_mis.r_l /= density.x;
        let emission = self.arriving().emitted_by_medium(world, &flight, ray);
        self.add(emission);
        let before = self.throughput.r_u;
        self.throughput.scatter(flight.factor, density);
        self.hooks.on_medium(&self.throughput);
        let Some(Collision { t, phase, .. }) = flight.scattering else {
            return ControlFlow::Continue(());
        };
        self.alpha = 1.0;
        if self.throughput.beta == Vec4::ZERO || !scatters {
            return ControlFlow::Break(Step::END);
        }
        let equiangular_pdf = along.map_or(0.0, |along| along.density(t) / density.x);
        let PathThroughput { beta, r_u } = self.throughput;
        let vertex = MediumVertex {
            position: ray.at(t),
            is_dark: medium.is_dark(),
            phase: &phase,
            throughput: PathThroughput {
                beta,
                r_u: r_u + before * equiangular_pdf,
            },
            r_u_of_flight: r_u,
        };
        ControlFlow::Break(self.scatter_in_medium(world, config, ray, &vertex))
    }

    /// Looks for light along the ray: chooses a point of a light, a point of the ray by the angle seen from there, and
    /// a light sample at that; all but the first are combined with free flight by multiple importance sampling. Nothing, in a
    /// vacuum, or if the light chosen is at infinity.
    fn sample_equiangular(
        &mut self,
        world: &'w W,
        config: &PathConfig,
        medium: &MediumOf<'w, W>,
        (ray, hit): (&Ray, Option<&Hit>),
    ) -> Option<Equiangular> {
        let event = self.draw_event();
        let t_max = hit.map_or(ray.t_max, |hit| hit.t);
        let middle = if t_max.is_finite() { 0.5 * t_max } else { 0.0 };
        let from = LightSampleContext::in_space(ray.at(middle)).at(ray.time);
        let light =
            world.sample_light(&from, &self.wavelengths, event.light_choice, event.light)?;
        let along = Equiangular::new(ray, t_max, light.target?)?;
        let t = along.sample(event.lobe);
        let at = ray.at(t);
        let coefficients = medium.coefficients(at, ray.direction);
        if !(t < t_max) || coefficients.scattering == Vec4::ZERO {
            return Some(along);
        }
        let Transmission {
            transmittance,
            probability,
        } = medium.transmittance(ray, t, &mut ray.stream(event.roulette));
        let density = along.density(t);
        let r_u_of_flight = probability * coefficients.extinction() / density;
        let PathThroughput { beta, r_u } = self.throughput;
        let throughput = PathThroughput {
            beta: beta * transmittance * coefficients.scattering / density,
            r_u: r_u * (Vec4::ONE + r_u_of_flight),
        };
        if throughput.beta != Vec4::ZERO {
            let event = self.draw_event();
            let vertex = MediumVertex {
                position: at,
                is_dark: false,
                phase: &medium.phase(at),
                throughput,
                r_u_of_flight: r_u * r_u_of_flight,
            };
            let (_, shadow) = self.light_in_medium(world, config, ray, &vertex, &event);
            self.trace_shadow(world, shadow);
        }
        Some(along)
    }

    /// A light sample and the next direction at a point of a medium.
    fn scatter_in_medium<P: Phase>(
        &mut self,
        world: &'w W,
        config: &PathConfig,
        ray: &Ray,
        vertex: &MediumVertex<'_, P>,
    ) -> Step {
        let event = self.draw_event();
        let (mut from, mut shadow) = (None, None);
        if !vertex.is_dark {
            let (context, light) = self.light_in_medium(world, config, ray, vertex, &event);
            (from, shadow) = (Some(context), light);
            self.hooks.on_light_sample();
        }
        let sample = vertex.phase.sample(-ray.direction, event.direction);
        self.scatter_count += 1;
        self.scattered = true;
        let density = sample.density.lanes();
        self.light_mis = from.map_or(LightMis::NONE, |from| LightMis {
            from,
            r_l: vertex.throughput.r_u / density.x,
        });
        self.throughput.scatter(sample.value, density);
        self.hooks.on_medium(&self.throughput);
        let survival = self.throughput.survival_in_medium(self.eta);
        let survives = self.survives(config, &event, |path| {
            path.hooks.on_roulette(survival);
            survival
        });
        let goes_on = survives && self.throughput.beta != Vec4::ZERO;
        let next = goes_on.then(|| Ray {
            medium: ray.medium,
            ..Ray::new(vertex.position, sample.wi, ray.time)
        });
        Step { shadow, ray: next }
    }

    /// Next-event estimation at a point of a medium.
    fn light_in_medium<P: Phase>(
        &mut self,
        world: &'w W,
        config: &PathConfig,
        ray: &Ray,
        vertex: &MediumVertex<'_, P>,
        event: &BounceSamples,
    ) -> (LightSampleContext, Option<ShadowRay>) {
        let MediumVertex {
            position: at,
            phase,
            throughput,
            r_u_of_flight,
            ..
        } = *vertex;
        let (wo, time, medium) = (-ray.direction, ray.time, ray.medium);
        let from = LightSampleContext::in_space(at).at(time).combined();
        let candidates = Candidates::at(self.candidates(config), world, &from);
        let connect = |light: &LightSample| {
            let contribution = phase.eval(wo, light.direction) * light.radiance;
            let density = phase.density(wo, light.direction);
            (contribution != Vec4::ZERO).then(|| {
                LightConnection::of(
                    light,
                    &throughput,
                    r_u_of_flight,
                    contribution,
                    density,
                    [1.0; 2],
                )
            })
        };
        let (waves, sampler) = (&self.wavelengths, &mut self.sampler);
        let connection = candidates.draw(world, &from, waves, event, sampler, connect);
        let shadow = connection.and_then(|connection| {
            let ray = match connection.target {
                Some(target) => Ray::between(at, target, time)?,
                None => Ray::new(at, connection.direction, time),
            };
            Some(ShadowRay {
                ray: Ray { medium, ..ray },
                crossings: config.null_crossings(self.depth),
                unoccluded: connection.path,
            })
        });
        (from, shadow)
    }
}
