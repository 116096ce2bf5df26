//! One path of the path tracer, from surface to surface.

use crate::camera_ray::camera_ray;
use crate::candidates::{Aim, Candidates};
use crate::dimensions::BounceSamples;
use crate::light_mis::LightMis;
use crate::path_hooks::PathHooks;
use crate::path_throughput::PathThroughput;
use crate::settings::{LightCandidates, PathSettings, PathVariant};
use crate::steps;
use core::ops::Range;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Coefficients, Hit, LightSample, LightSampleContext, Lights, Media, MediumId, PixelSample,
    Ray, Sensor, ShadowQuery, Sink, SurfaceInteraction, Surfaces, Transmission, TransportMode,
    World,
};
use glam::{Vec3, Vec4};

/// A path being followed.
pub(crate) struct PathState<S, C = ()> {
    pub(crate) sampler: S,
    pub(crate) wavelengths: Wavelengths,
    /// The factor by which what is found counts.
    weight: f32,
    pub(crate) ray: Ray,
    /// The closest hit of `ray`, after `intersect`.
    pub(crate) hit: Option<Hit>,
    pub(crate) throughput: PathThroughput,
    pub(crate) light_mis: LightMis,
    /// The product of the indices of refraction passed.
    pub(crate) eta: f32,
    /// Number of segments, that of `ray` included.
    pub(crate) depth: u32,
    /// Scattering events so far, null interactions not counted.
    pub(crate) scatter_count: u32,
    /// The number that decides how far the path flies through the medium that it is in.
    pub(crate) flight: f32,
    /// The medium that the path entered last, with the coefficients where it did, if they are all to know of it.
    pub(crate) entered: Option<(MediumId, Coefficients)>,
    /// Events so far for which random numbers were drawn.
    events: u32,
    /// Whether the path goes on with `ray`.
    pub(crate) goes_on: bool,
    pub(crate) shadow_ray: Option<ShadowRay>,
    /// What its integrator does in one way or another. One light sample is left for a shadow ray, once the path was scattered
    /// at random: what is farther down the path adds less noise than the samples take time.
    pub(crate) variant: PathVariant,
    /// The radiance found, per lane, over the sum of all densities' ratios (see
    /// [`PathThroughput::contribution`]).
    radiance: Vec4,
    /// 1 if the path had an interaction that is not null, the background included; where the last segment
    /// ends at a surface, the probability of that.
    pub(crate) alpha: f32,
    pub(crate) hooks: C,
}

/// A light sample before its shadow ray is traced.
pub(crate) struct ShadowRay {
    pub(crate) ray: Ray,
    pub(crate) crossings: u32,
    pub(crate) aim: Aim,
    /// What comes of it, once it has been traced.
    pub(crate) found: Option<Transmission>,
}

impl<S: Sampler, C: PathHooks> PathState<S, C> {
    /// The path of a sample, before its first surface is known.
    #[inline]
    pub(crate) fn start<W: World>(
        world: &W,
        settings: &PathSettings,
        site: &PixelSample,
        mut sampler: S,
        hooks: C,
    ) -> Self {
        let (wavelengths, ray, weight) = camera_ray(world, site, &mut sampler);
        Self {
            sampler,
            wavelengths,
            weight,
            ray,
            hit: None,
            throughput: PathThroughput::START,
            light_mis: LightMis::NONE,
            eta: 1.0,
            depth: 1,
            scatter_count: 0,
            flight: 0.0,
            entered: None,
            events: 0,
            goes_on: settings.max_depth > 0,
            shadow_ray: None,
            variant: PathVariant::PLAIN,
            radiance: Vec4::ZERO,
            alpha: 0.0,
            hooks,
        }
    }

    /// The same in a certain way.
    #[inline]
    pub(crate) fn with_variant(self, variant: PathVariant) -> Self {
        Self { variant, ..self }
    }

    /// How many surfaces a shadow ray from the vertex at hand may pass straight.
    #[inline]
    pub(crate) fn null_crossings(&self, settings: &PathSettings) -> u32 {
        if self.variant.counts_null {
            settings.max_depth - self.depth - 1
        } else {
            u32::MAX
        }
    }

    /// The hooks, when the path has ended.
    #[inline]
    pub(crate) fn into_hooks(self) -> C {
        self.hooks
    }

    /// Whether the path goes on.
    #[inline]
    pub(crate) fn goes_on(&self) -> bool {
        self.goes_on
    }

    /// The opacity of what the path has hit.
    #[inline]
    pub(crate) fn alpha(&self) -> f32 {
        self.alpha
    }

    /// Writes the result to a sink.
    #[inline]
    pub(crate) fn deliver(&self, world: &impl World, sink: &mut impl Sink) {
        sink.radiance(self.colour(world).to_array(), self.alpha);
    }

    /// The colour found.
    #[inline]
    pub(crate) fn colour(&self, world: &impl World) -> Vec3 {
        world
            .sensor()
            .weights(&self.wavelengths)
            .rgb(self.radiance * self.weight)
    }

    /// Traces the path to its end; of its contributions only those of paths whose number of scattering
    /// events is in `wanted` count.
    pub(crate) fn follow<W: World>(
        &mut self,
        world: &W,
        settings: &PathSettings,
        wanted: &Range<u32>,
    ) {
        while self.goes_on && self.scatter_count < wanted.end {
            self.intersect(world, settings);
            let (radiance, scatter_count) = (self.radiance, self.scatter_count);
            self.shade(world, settings);
            if scatter_count < wanted.start {
                self.radiance = radiance;
            }
            if wanted.contains(&(scatter_count + 1)) {
                self.trace_shadow(world);
            } else {
                self.shadow_ray = None;
            }
        }
    }

    /// Finds the next surface; the camera looks through hidden lights.
    #[inline]
    fn intersect<W: World>(&mut self, world: &W, settings: &PathSettings) {
        let (ray, hit) = self.ray_query(world);
        *hit = world.surfaces().intersect(ray);
        self.look_through_hidden(world, settings);
    }

    /// The ray whose nearest surface is wanted, and the place for it.
    #[inline]
    pub(crate) fn ray_query<W: World>(&mut self, world: &W) -> (&Ray, &mut Option<Hit>) {
        if self.ray.medium.is_some() {
            self.prepare_flight(world);
        }
        (&self.ray, &mut self.hit)
    }

    /// Goes on to what is behind lights that the camera does not see.
    #[inline]
    pub(crate) fn look_through_hidden<W: World>(&mut self, world: &W, settings: &PathSettings) {
        let hidden = settings.hide_emitters && self.depth == 1;
        if hidden && self.hit.is_some_and(|hit| world.lights().is_emitter(&hit)) {
            // Once more from where the ray starts, as what is in between may be flown through.
            self.hit = steps::next_hit(world, &mut self.ray, hidden);
        }
    }

    /// Shades the hit: adds emission, prepares next-event estimation, and samples the BSDF.
    #[inline]
    pub(crate) fn shade<W: World>(&mut self, world: &W, settings: &PathSettings) {
        self.goes_on = false;
        if self.ray.medium.is_some() && self.fly(world, settings) {
            return;
        }
        let direction = self.ray.direction;
        let Some(hit) = self.hit else {
            // A hidden sky stays hidden to rays that only went straight.
            let visible = !settings.hide_emitters || self.alpha > 0.0;
            if visible && world.lights().has_background() {
                self.alpha = 1.0;
                let (before, light_mis) = (&self.throughput, &self.light_mis);
                let estimate =
                    steps::background(world, direction, &self.wavelengths, before, light_mis);
                self.radiance += estimate;
                self.hooks.on_emission(estimate);
            }
            return;
        };
        let emits = world.lights().is_emitter(&hit);
        let last = self.depth == settings.max_depth;
        if last && !emits && self.alpha > 0.0 && self.variant.counts_null {
            return;
        }
        let vertex = world.surfaces().vertex(&self.ray, &hit);
        let wo = -direction;
        if emits {
            let (before, light_mis) = (&self.throughput, &self.light_mis);
            let waves = &self.wavelengths;
            let estimate = steps::emission(world, &vertex, direction, waves, before, light_mis);
            self.radiance += estimate;
            self.hooks.on_emission(estimate);
        }
        let bsdf = world.surfaces().bsdf(&vertex, wo, &self.wavelengths);
        let bsdf = self.hooks.wrap_bsdf(&vertex, wo, bsdf);
        let passes = !self.variant.counts_null && bsdf.null_probability() != Vec4::ZERO;
        if last && !passes {
            // No direction is sampled at the last vertex: its null probability alone estimates alpha.
            self.alpha = self.alpha.max(steps::opacity(&bsdf));
            return;
        }
        let before = self.ray.medium;
        self.scatter_at(world, settings, &vertex, &bsdf, wo, !last);
        if self.goes_on && self.ray.medium.is_some() {
            if self.ray.medium != before {
                let medium = self.ray.medium;
                let entry = world.media().entry(medium, &vertex, &self.wavelengths);
                self.entered = entry.map(|coefficients| (medium, coefficients));
            }
            self.diffuse(world, settings, &vertex);
        }
    }

    /// Prepares next-event estimation, if light may be sampled (`lit`), and samples the BSDF.
    #[inline]
    pub(crate) fn scatter_at<W: World>(
        &mut self,
        world: &W,
        settings: &PathSettings,
        vertex: &SurfaceInteraction,
        bsdf: &impl Bsdf,
        wo: Vec3,
        lit: bool,
    ) {
        let event = self.draw_event();
        let from = LightSampleContext::new(vertex, wo, bsdf).combined();
        if lit && bsdf.has_continuous() {
            let throughput = self.throughput;
            let candidates = Candidates::at(self.variant.candidates, world, &from);
            let aim = |light: &LightSample| Aim::new(light, &throughput, bsdf, wo, [1.0; 2]);
            let aim = candidates.draw(
                world,
                &from,
                &self.wavelengths,
                &event,
                &mut self.sampler,
                aim,
            );
            self.shadow_ray = aim.and_then(|aim| {
                Some(ShadowRay {
                    ray: vertex.shadow_ray(aim.direction, aim.target)?,
                    crossings: self.null_crossings(settings),
                    aim,
                    found: None,
                })
            });
            self.hooks.on_light_sample();
        }
        self.scatter(vertex, &from, bsdf, wo, settings, &event);
    }

    /// Samples the BSDF and plays Russian roulette: extends the path, or ends it.
    #[inline]
    fn scatter(
        &mut self,
        vertex: &SurfaceInteraction,
        from: &LightSampleContext,
        bsdf: &impl Bsdf,
        wo: Vec3,
        settings: &PathSettings,
        event: &BounceSamples,
    ) {
        let Some(sample) = bsdf.sample(wo, event.lobe, event.direction, TransportMode::Radiance)
        else {
            self.alpha = 1.0;
            return;
        };
        let counts = self.variant.counts_null || !sample.is_null;
        if counts && self.depth == settings.max_depth {
            self.alpha = 1.0;
            return;
        }
        if !sample.is_null {
            self.alpha = 1.0;
            self.scatter_count += 1;
        }
        if !sample.chance.is_delta() {
            self.variant.candidates = LightCandidates::ONE;
        }
        self.light_mis = self.light_mis.after(&self.throughput, from, &sample);
        self.throughput.scatter(sample.value, sample.chance.lanes());
        self.eta *= sample.eta;
        self.ray = vertex.spawn(sample.wi);
        (self.hooks).on_scatter(vertex, bsdf, wo, &sample, &self.throughput);
        if counts {
            self.lengthen(settings, event);
        } else {
            self.goes_on = self.throughput.beta != Vec4::ZERO;
        }
    }

    /// Plays Russian roulette, and goes on with one more segment if the path survives.
    #[inline]
    pub(crate) fn lengthen(&mut self, settings: &PathSettings, event: &BounceSamples) {
        self.lengthen_with(settings, event, |path| {
            path.hooks.survival(&path.throughput, path.eta)
        });
    }

    /// The same with another probability to survive.
    #[inline]
    pub(crate) fn lengthen_with(
        &mut self,
        settings: &PathSettings,
        event: &BounceSamples,
        survival: impl FnOnce(&mut Self) -> f32,
    ) {
        if self.depth >= settings.rr_depth {
            let survival = survival(self);
            if !self.throughput.survives(survival, event.roulette) {
                return;
            }
        }
        self.depth += 1;
        self.goes_on = self.throughput.beta != Vec4::ZERO;
    }

    /// Adds what the medium emits that the path flies through.
    pub(crate) fn add_emission(&mut self, radiance: Vec4) {
        self.radiance += radiance;
        self.hooks.on_emission(radiance);
    }

    /// The product of the indices of refraction passed.
    #[inline]
    pub(crate) fn eta(&self) -> f32 {
        self.eta
    }

    /// The random numbers of the next event.
    #[inline]
    pub(crate) fn draw_event(&mut self) -> BounceSamples {
        let event = BounceSamples::draw(&mut self.sampler, self.events);
        self.events += 1;
        event
    }

    /// Traces the shadow ray of the light sample that was prepared, if any.
    #[inline]
    pub(crate) fn trace_shadow<W: World>(&mut self, world: &W) {
        world.transmittance_batch(self.shadow_query().into_iter());
        self.add_light();
    }

    /// The shadow ray of the light sample that was prepared, if any, and the place for what comes of it.
    #[inline]
    pub(crate) fn shadow_query(&mut self) -> Option<ShadowQuery<'_>> {
        let light = self.shadow_ray.as_mut()?;
        Some(ShadowQuery {
            ray: &light.ray,
            wavelengths: &self.wavelengths,
            crossings: light.crossings,
            found: &mut light.found,
        })
    }

    /// Adds the light sample whose shadow ray has been traced, if any.
    #[inline]
    pub(crate) fn add_light(&mut self) {
        if let Some(ShadowRay {
            aim,
            found: Some(passage),
            ..
        }) = &self.shadow_ray
        {
            let estimate = aim.estimate(passage);
            self.radiance += estimate;
            self.hooks.on_light_contribution(estimate);
        }
        self.shadow_ray = None;
    }
}
