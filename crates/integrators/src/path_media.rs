//! A path in a participating medium: free flight, next-event estimation and scattering at a point of space.

use crate::candidates::{Aim, Candidates};
use crate::light_mis::LightMis;
use crate::path_hooks::PathHooks;
use crate::path_state::{PathState, ShadowRay};
use crate::settings::{LightCandidates, PathSettings};
use crate::steps;
use etalon_sampling::Sampler;
use etalon_transport::{Collision, LightSample, LightSampleContext, Phase, Ray, World};
use glam::{Vec3, Vec4};

impl<S: Sampler, C: PathHooks> PathState<S, C> {
    /// Flies through the medium to the hit, or to where light is scattered before it. Whether the path has left its
    /// ray: it goes on from a point of the medium, or has ended.
    #[cold]
    #[inline(never)]
    pub(crate) fn fly<W: World>(&mut self, world: &W, settings: &PathSettings) -> bool {
        let u = self.draw_event().lobe;
        let hit = self.hit.as_ref();
        let Some(flight) = steps::free_flight(world, &self.ray, hit, &self.wavelengths, u) else {
            return false;
        };
        let density = flight.density();
        self.light_mis.r_l /= density.x;
        let (ray, light_mis) = (&self.ray, &self.light_mis);
        let emitted = steps::emitted_on_the_way(world, &flight, ray, &self.throughput, light_mis);
        self.add_emission(emitted);
        self.throughput.scatter(flight.factor, density);
        self.hooks.on_medium(&self.throughput);
        let Some(Collision { t, phase, .. }) = flight.scattering else {
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
        self.hooks.on_light_sample();
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
        self.hooks.on_medium(&self.throughput);
        let survival = self.throughput.survival_in_medium(self.eta());
        self.lengthen_with(settings, &event, |path| {
            path.hooks.on_roulette(survival);
            survival
        });
    }
}
