//! One path of the path tracer, from surface to surface.

use crate::path::hooks::PathHooks;
use crate::steps::arrival::{Arrival, Arriving};
use crate::steps::camera_ray::camera_ray;
use crate::steps::candidates::Candidates;
use crate::steps::dimensions::BounceSamples;
use crate::steps::light_connection::{LightConnection, UnoccludedPath};
use crate::steps::light_mis::LightMis;
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::{LightCandidates, PathConfig};
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Coefficients, Hit, LightSample, LightSampleContext, Media, MediumId, PixelSample, Ray,
    Sensor, Sink, SurfaceInteraction, Transmission, TransportMode, World,
};
use glam::{Vec3, Vec4};

/// A path being followed.
pub(crate) struct PathState<S, C = ()> {
    pub(crate) sampler: S,
    pub(crate) wavelengths: Wavelengths,
    /// The factor by which what is found counts.
    weight: f32,
    pub(crate) throughput: PathThroughput,
    pub(crate) light_mis: LightMis,
    /// The product of the indices of refraction passed.
    pub(crate) eta: f32,
    /// Number of segments, that included which the path goes on with.
    pub(crate) depth: u32,
    /// Scattering events so far, null interactions not counted.
    pub(crate) scatter_count: u32,
    /// The number that decides how far the path flies through the medium that it is in.
    pub(crate) flight: f32,
    /// The medium that the path entered last, with the coefficients where it did, if they are all to know of it.
    pub(crate) entered: Option<(MediumId, Coefficients)>,
    /// Events so far for which random numbers were drawn.
    events: u32,
    /// Whether a direction was sampled from a density. One light sample is left for a shadow ray from then on:
    /// what is farther down the path adds less noise than the samples take time.
    pub(crate) scattered: bool,
    /// The radiance found, per lane, over the sum of all densities' ratios (see
    /// [`PathThroughput::contribution`]).
    pub(crate) radiance: Vec4,
    /// 1 if the path had an interaction that is not null, the background included; where the last segment
    /// ends at a surface, the probability of that.
    pub(crate) alpha: f32,
    pub(crate) hooks: C,
}

/// A light sample before its shadow ray is traced.
pub(crate) struct ShadowRay {
    pub(crate) ray: Ray,
    /// How many surfaces may let it pass.
    pub(crate) crossings: u32,
    pub(crate) unoccluded: UnoccludedPath,
}

/// What a vertex makes of a path.
pub(crate) struct Step {
    /// The light sample there, if one may bring anything.
    pub(crate) shadow: Option<ShadowRay>,
    /// The ray that the path goes on with; `None` if it ends.
    pub(crate) ray: Option<Ray>,
}

impl Step {
    /// The path ends, with nothing left to do.
    pub(crate) const END: Self = Self {
        shadow: None,
        ray: None,
    };

    /// The path goes on as if nothing were there.
    #[inline]
    pub(crate) fn straight(ray: Ray) -> Self {
        Self {
            shadow: None,
            ray: Some(ray),
        }
    }
}

/// A point of a surface where a path is scattered.
pub(crate) struct ScatteringPoint<'a, B> {
    vertex: &'a SurfaceInteraction,
    bsdf: &'a B,
    wo: Vec3,
    /// As light sampling sees it.
    from: LightSampleContext,
    /// The random numbers of what happens there.
    event: BounceSamples,
}

impl<'a, B: Bsdf> ScatteringPoint<'a, B> {
    #[inline]
    pub(crate) fn new(
        vertex: &'a SurfaceInteraction,
        bsdf: &'a B,
        wo: Vec3,
        event: BounceSamples,
    ) -> Self {
        Self {
            from: LightSampleContext::new(vertex, wo, bsdf).combined(),
            vertex,
            bsdf,
            wo,
            event,
        }
    }
}

impl<S: Sampler, C: PathHooks> PathState<S, C> {
    /// A path at the camera; what it finds is multiplied by `weight`.
    #[inline(always)]
    pub(crate) fn new(sampler: S, wavelengths: Wavelengths, weight: f32, hooks: C) -> Self {
        Self {
            sampler,
            wavelengths,
            weight,
            throughput: PathThroughput::START,
            light_mis: LightMis::NONE,
            eta: 1.0,
            depth: 1,
            scatter_count: 0,
            flight: 0.0,
            entered: None,
            events: 0,
            scattered: false,
            radiance: Vec4::ZERO,
            alpha: 0.0,
            hooks,
        }
    }

    /// The path of a sample, and the camera's ray that it begins with.
    #[inline]
    pub(crate) fn start<W: World>(
        world: &W,
        site: &PixelSample,
        mut sampler: S,
        hooks: C,
    ) -> (Self, Ray) {
        let (wavelengths, ray, weight) = camera_ray(world, site, &mut sampler);
        (Self::new(sampler, wavelengths, weight, hooks), ray)
    }

    /// The hooks, when the path has ended.
    #[inline]
    pub(crate) fn into_hooks(self) -> C {
        self.hooks
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

    /// Whether the path looks through lights: the camera's ray, where they are hidden.
    #[inline]
    pub(crate) fn sees_through_lights(&self, config: &PathConfig) -> bool {
        config.limits.hide_emitters && self.depth == 1
    }

    /// The path as it arrives somewhere.
    #[inline]
    pub(crate) fn arriving(&self) -> Arriving<'_> {
        Arriving {
            wavelengths: &self.wavelengths,
            throughput: &self.throughput,
            light_mis: &self.light_mis,
        }
    }

    /// Where it arrives along `ray`, whose nearest surface is `hit`: the surface there, if there is one. Its emission, or that of
    /// the lights at infinity, is added.
    #[inline]
    pub(crate) fn arrive<W: World>(
        &mut self,
        world: &W,
        config: &PathConfig,
        ray: &Ray,
        hit: Option<&Hit>,
    ) -> Option<SurfaceInteraction> {
        // A hidden sky stays hidden to rays that only went straight.
        let sees_background = !config.limits.hide_emitters || self.alpha > 0.0;
        match self.arriving().at(world, ray, hit, sees_background) {
            Arrival::Surface(vertex, emission) => {
                self.add(emission);
                Some(vertex)
            }
            Arrival::Background(emission) => {
                self.alpha = 1.0;
                self.add(emission);
                None
            }
            Arrival::Nothing => None,
        }
    }

    /// Adds what emission contributes that the path has hit.
    #[inline]
    pub(crate) fn add(&mut self, estimate: Vec4) {
        self.radiance += estimate;
        self.hooks.on_emission(estimate);
    }

    /// How many light samples compete for the next shadow ray.
    #[inline]
    pub(crate) fn candidates(&self, config: &PathConfig) -> LightCandidates {
        if self.scattered {
            LightCandidates::ONE
        } else {
            config.candidates
        }
    }

    /// Next-event estimation: a light sample and its shadow ray, if light sampling can find anything.
    #[inline]
    pub(crate) fn sample_light<W: World>(
        &mut self,
        world: &W,
        config: &PathConfig,
        at: &ScatteringPoint<'_, impl Bsdf>,
    ) -> Option<ShadowRay> {
        let ScatteringPoint {
            vertex,
            bsdf,
            wo,
            from,
            event,
        } = at;
        if !bsdf.has_continuous() {
            return None;
        }
        let throughput = self.throughput;
        let candidates = Candidates::at(self.candidates(config), world, from);
        let connect =
            |light: &LightSample| LightConnection::new(light, &throughput, *bsdf, *wo, [1.0; 2]);
        let (waves, sampler) = (&self.wavelengths, &mut self.sampler);
        let connection = candidates.draw(world, from, waves, event, sampler, connect);
        self.hooks.on_light_sample();
        let connection = connection?;
        Some(ShadowRay {
            ray: vertex.shadow_ray(connection.direction, connection.target)?,
            crossings: config.null_crossings(self.depth),
            unoccluded: connection.path,
        })
    }

    /// Samples the BSDF and plays Russian roulette: the next ray, or `None` where the path ends.
    #[inline]
    pub(crate) fn scatter(
        &mut self,
        config: &PathConfig,
        at: &ScatteringPoint<'_, impl Bsdf>,
    ) -> Option<Ray> {
        let ScatteringPoint {
            vertex,
            bsdf,
            wo,
            from,
            event,
        } = at;
        let Some(sample) = bsdf.sample(*wo, event.lobe, event.direction, TransportMode::Radiance)
        else {
            self.alpha = 1.0;
            return None;
        };
        let counts = config.counts_null || !sample.is_null;
        if counts && self.depth == config.limits.max_depth {
            self.alpha = 1.0;
            return None;
        }
        if !sample.is_null {
            self.alpha = 1.0;
            self.scatter_count += 1;
        }
        self.scattered |= !sample.chance.is_delta();
        self.light_mis = self.light_mis.after(&self.throughput, from, &sample);
        self.throughput.scatter(sample.value, sample.chance.lanes());
        self.eta *= sample.eta;
        let next = vertex.spawn(sample.wi);
        (self.hooks).on_scatter(vertex, *bsdf, *wo, &sample, &self.throughput);
        let survives = !counts
            || self.survives(config, event, |path| {
                path.hooks.survival(&path.throughput, path.eta)
            });
        (survives && self.throughput.beta != Vec4::ZERO).then_some(next)
    }

    /// Where a path goes on that would go into a medium after `step`, at a surface that it reached in the medium `before`: matter
    /// with a diffusion profile it leaves elsewhere.
    #[inline]
    pub(crate) fn enter<W: World>(
        &mut self,
        world: &W,
        config: &PathConfig,
        vertex: &SurfaceInteraction,
        before: MediumId,
        step: Step,
    ) -> Step {
        let medium = step.ray.map_or(MediumId::NONE, |ray| ray.medium);
        if medium != before {
            let entry = world.media().entry(medium, vertex, &self.wavelengths);
            self.entered = entry.map(|coefficients| (medium, coefficients));
        }
        self.diffuse(world, config, vertex, medium, step)
    }

    /// Plays Russian roulette, and counts one more segment if the path survives.
    #[inline]
    pub(crate) fn survives(
        &mut self,
        config: &PathConfig,
        event: &BounceSamples,
        survival: impl FnOnce(&mut Self) -> f32,
    ) -> bool {
        if self.depth >= config.limits.rr_depth {
            let survival = survival(self);
            if !self.throughput.survives(survival, event.roulette) {
                return false;
            }
        }
        self.depth += 1;
        true
    }

    /// The random numbers of the next event.
    #[inline]
    pub(crate) fn draw_event(&mut self) -> BounceSamples {
        let event = BounceSamples::draw(&mut self.sampler, self.events);
        self.events += 1;
        event
    }

    /// Traces the shadow ray of a light sample, and adds what it brings.
    #[inline]
    pub(crate) fn trace_shadow<W: World>(&mut self, world: &W, shadow: Option<ShadowRay>) {
        if let Some(ShadowRay {
            ray,
            crossings,
            unoccluded,
        }) = shadow
            && let Some(transmission) = world.transmittance(&ray, &self.wavelengths, crossings)
        {
            self.add_light(&unoccluded, &transmission);
        }
    }

    /// Adds a light sample that arrives through what is in the way.
    #[inline]
    pub(crate) fn add_light(&mut self, unoccluded: &UnoccludedPath, transmission: &Transmission) {
        let estimate = unoccluded.estimate(transmission);
        self.radiance += estimate;
        self.hooks.on_light_contribution(estimate);
    }
}
