//! The state of one path of the path tracer, and its stages at a surface: arrive, light sample, scatter, roulette.

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
    Bsdf, Hit, LightSample, LightSampleContext, Media, MediumId, MediumOf, PixelSample, Ray,
    Sensor, Sink, SurfaceInteraction, Transmission, TransportMode, World,
};
use glam::{Vec3, Vec4};

/// A path from the camera, up to its last vertex.
pub(crate) struct PathState<'w, W: World + 'w, S, C = ()> {
    pub(crate) sampler: S,
    pub(crate) wavelengths: Wavelengths,
    /// Factor on its radiance: the importance of the camera ray.
    pub(crate) weight: f32,
    pub(crate) throughput: PathThroughput,
    pub(crate) light_mis: LightMis,
    /// The product of the indices of refraction passed.
    pub(crate) eta: f32,
    /// Number of segments, including the next.
    pub(crate) depth: u32,
    /// Scattering events so far, null interactions not counted.
    pub(crate) scatter_count: u32,
    /// The random number of the next free flight.
    pub(crate) flight: f32,
    /// The medium entered last: that of the next ray, if it is in one.
    pub(crate) medium: Option<MediumOf<'w, W>>,
    /// Events so far for which random numbers were drawn.
    events: u32,
    /// Whether a direction was sampled from a density. From then on one light sample is drawn for a shadow ray: later
    /// vertices add less noise than further samples would take time.
    pub(crate) scattered: bool,
    /// Sum of the contributions, per lane (see [`PathThroughput::contribution`]).
    pub(crate) radiance: Vec4,
    /// 1 after an interaction that is not null, including the background. If the path ends at a surface by its length, one
    /// minus the null probability there.
    pub(crate) alpha: f32,
    pub(crate) hooks: C,
}

/// A light sample before its shadow ray is traced.
pub(crate) struct ShadowRay {
    pub(crate) ray: Ray,
    /// The most null surfaces that it may cross.
    pub(crate) crossings: u32,
    pub(crate) unoccluded: UnoccludedPath,
}

/// What follows from a vertex.
pub(crate) struct Step {
    /// The light sample there, if it may contribute.
    pub(crate) shadow: Option<ShadowRay>,
    /// The next ray; `None` if the path ends.
    pub(crate) ray: Option<Ray>,
}

impl Step {
    /// The path ends, without a light sample.
    pub(crate) const END: Self = Self {
        shadow: None,
        ray: None,
    };

    /// The path continues along `ray` as if nothing were there.
    #[inline]
    pub(crate) fn straight(ray: Ray) -> Self {
        Self {
            shadow: None,
            ray: Some(ray),
        }
    }
}

/// A point of a surface where the path is scattered.
pub(crate) struct ScatteringPoint<'a, B> {
    vertex: &'a SurfaceInteraction,
    bsdf: &'a B,
    wo: Vec3,
    /// The same for light sampling.
    from: LightSampleContext,
    /// The random numbers of the event.
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

impl<'w, W: World, S: Sampler, C: PathHooks> PathState<'w, W, S, C> {
    /// The path of a sample, and the camera's ray that it begins with.
    #[inline]
    pub(crate) fn start(world: &'w W, site: &PixelSample, mut sampler: S, hooks: C) -> (Self, Ray) {
        let (wavelengths, ray, weight) = camera_ray(world, site, &mut sampler);
        let mut path = Self::new(world, wavelengths, sampler, hooks);
        path.weight = weight;
        (path, ray)
    }

    /// A path before its first segment, which counts with weight one.
    #[inline]
    pub(crate) fn new(world: &'w W, wavelengths: Wavelengths, sampler: S, hooks: C) -> Self {
        let medium = world.media().around_camera();
        let medium = (medium.is_some())
            .then(|| world.media().enter(medium, None, &wavelengths))
            .flatten();
        Self {
            sampler,
            wavelengths,
            weight: 1.0,
            throughput: PathThroughput::START,
            light_mis: LightMis::NONE,
            eta: 1.0,
            depth: 1,
            scatter_count: 0,
            flight: 0.0,
            medium,
            events: 0,
            scattered: false,
            radiance: Vec4::ZERO,
            alpha: 0.0,
            hooks,
        }
    }

    /// The hooks, when the path has ended.
    #[inline]
    pub(crate) fn into_hooks(self) -> C {
        self.hooks
    }

    /// Opacity of what the camera sees, 0 to 1.
    #[inline]
    pub(crate) fn alpha(&self) -> f32 {
        self.alpha
    }

    /// Writes colour and opacity to a sink.
    #[inline]
    pub(crate) fn deliver(&self, world: &impl World, sink: &mut impl Sink) {
        sink.radiance(self.colour(world).to_array(), self.alpha);
    }

    /// The colour, in the channels of the sensor.
    #[inline]
    pub(crate) fn colour(&self, world: &impl World) -> Vec3 {
        world
            .sensor()
            .weights(&self.wavelengths)
            .rgb(self.radiance * self.weight)
    }

    /// Whether no segment may follow the next vertex.
    #[inline]
    pub(crate) fn is_last(&self, config: &PathConfig) -> bool {
        self.depth == config.limits.max_depth
    }

    /// The weights of emission where the path arrives.
    #[inline]
    pub(crate) fn arriving(&self) -> Arriving<'_> {
        Arriving {
            wavelengths: &self.wavelengths,
            throughput: &self.throughput,
            light_mis: &self.light_mis,
        }
    }

    /// Arrives at the end of `ray`, whose nearest surface is `hit`, and adds the emission there or of the background. The vertex;
    /// `None` if there is no surface.
    #[inline]
    pub(crate) fn arrive(
        &mut self,
        world: &'w W,
        config: &PathConfig,
        ray: &Ray,
        hit: Option<&Hit>,
    ) -> Option<SurfaceInteraction> {
        let sees_background = config.limits.sees_background(self.alpha);
        match self.arriving().at(world, ray, hit, sees_background) {
            Arrival::Surface(vertex, emission) => {
                if config.alpha_of_surfaces {
                    self.alpha = 1.0;
                }
                self.add(emission);
                Some(vertex)
            }
            Arrival::Background(emission) => {
                self.see_background(config, emission);
                None
            }
            Arrival::Nothing => None,
        }
    }

    /// Adds the contribution of lights at infinity.
    #[inline]
    pub(crate) fn see_background(&mut self, config: &PathConfig, estimate: Vec4) {
        if !config.alpha_of_surfaces {
            self.alpha = 1.0;
        }
        self.add(estimate);
    }

    /// Adds the contribution of emission that the path hit.
    #[inline]
    pub(crate) fn add(&mut self, estimate: Vec4) {
        self.radiance += estimate;
        self.hooks.on_emission(estimate);
    }

    /// The number of light samples for the next shadow ray.
    #[inline]
    pub(crate) fn candidates(&self, config: &PathConfig) -> LightCandidates {
        if self.scattered {
            LightCandidates::ONE
        } else {
            config.candidates
        }
    }

    /// Next-event estimation: a light sample and its shadow ray; `None` if it cannot contribute.
    #[inline]
    pub(crate) fn sample_light(
        &mut self,
        world: &'w W,
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
        if counts && self.is_last(config) {
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

    /// Keeps the medium of the next ray, `after`, at a surface point that the path reached in `before`.
    #[inline]
    pub(crate) fn enter(
        &mut self,
        world: &'w W,
        at: &SurfaceInteraction,
        [before, after]: [MediumId; 2],
    ) {
        if after != before {
            self.medium = world.media().enter(after, Some(at), &self.wavelengths);
        }
    }

    /// Russian roulette. Counts the next segment if the path survives.
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

    /// Traces a shadow ray, and adds the contribution of its light sample.
    #[inline]
    pub(crate) fn trace_shadow(&mut self, world: &'w W, shadow: Option<ShadowRay>) {
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

    /// Adds the contribution of a light sample whose shadow ray has this transmittance.
    #[inline]
    pub(crate) fn add_light(&mut self, unoccluded: &UnoccludedPath, transmission: &Transmission) {
        let estimate = unoccluded.estimate(transmission);
        self.radiance += estimate;
        self.hooks.on_light_contribution(estimate);
    }
}
