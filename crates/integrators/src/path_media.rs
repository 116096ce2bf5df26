//! A path in a participating medium: free flight, next-event estimation and scattering at a point of space.

use crate::candidates::{Aim, Candidates};
use crate::light_mis::LightMis;
use crate::path_hooks::PathHooks;
use crate::path_state::{PathState, ShadowRay};
use crate::settings::{LightCandidates, PathSettings};
use etalon_sampling::hash::mix64;
use etalon_sampling::{Independent, Sampler};
use etalon_transport::{LightSample, LightSampleContext, Medium, Phase, Ray, World};
use glam::{Vec3, Vec4};

impl<S: Sampler, C: PathHooks> PathState<S, C> {
    /// Flies through the medium to the hit, or to where light is scattered before it. Whether the path has left its
    /// ray: it goes on from a point of the medium, or has ended.
    #[cold]
    #[inline(never)]
    pub(crate) fn fly<W: World>(&mut self, world: &W, settings: &PathSettings) -> bool {
        let Some(medium) = world.medium(self.ray.medium, &self.wavelengths) else {
            return false;
        };
        let t_max = self.hit.map_or(self.ray.t_max, |hit| hit.t);
        let numbers = self.draw_event();
        // The number of tentative collisions has no bound, so they have a stream of their own.
        let [high, low] =
            [numbers.direction.x, numbers.direction.y].map(|u| u64::from(u.to_bits()));
        let mut stream = Independent::from_key(mix64(high << 32 | low));
        let flight = medium.free_flight(&self.ray, t_max, numbers.lobe, &mut stream);
        if flight.emitted != Vec4::ZERO {
            let mut emitted = self.throughput;
            emitted.scatter(flight.emitted, flight.density);
            self.add_emission(emitted.contribution(Vec4::ONE, Vec4::ZERO));
        }
        self.throughput.scatter(flight.factor, flight.density);
        self.light_mis.r_l *= flight.by_transmittance / flight.density.x;
        let Some((t, phase)) = flight.scattering else {
            return false;
        };
        self.alpha = 1.0;
        if self.throughput.beta != Vec4::ZERO && self.depth < settings.max_depth {
            self.scatter_in_medium(world, settings, self.ray.at(t), &phase);
        }
        true
    }

    /// Light samples and the next direction at a point of a medium.
    fn scatter_in_medium<W: World>(
        &mut self,
        world: &W,
        settings: &PathSettings,
        at: Vec3,
        phase: &impl Phase,
    ) {
        let (wo, time, medium) = (-self.ray.direction, self.ray.time, self.ray.medium);
        let event = self.draw_event();
        let from = LightSampleContext::in_space(at).at(time).combined();
        let throughput = self.throughput;
        let candidates = Candidates::at(self.variant.candidates, world, &from);
        let aim = |light: &LightSample| {
            let contribution = phase.eval(wo, light.direction) * light.radiance;
            let density = phase.density(wo, light.direction);
            (contribution != Vec4::ZERO)
                .then(|| Aim::of(light, &throughput, contribution, density, [1.0; 2]))
        };
        let aim = candidates.draw(
            world,
            &from,
            &self.wavelengths,
            &event,
            &mut self.sampler,
            aim,
        );
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
        let sample = phase.sample(wo, event.direction);
        self.scatter_count += 1;
        self.variant.candidates = LightCandidates::ONE;
        let density = sample.density.lanes();
        self.light_mis = LightMis {
            from,
            r_l: self.throughput.r_u / density.x,
        };
        self.throughput.scatter(sample.value, density);
        self.ray = Ray {
            medium,
            ..Ray::new(at, sample.wi, time)
        };
        let survival = self.throughput.survival_in_medium(self.eta());
        self.lengthen_with(settings, &event, |_| survival);
    }
}
