//! `direct`: direct illumination with any number of light and scattering samples.
//!
//! ```text
//! C = Le(x₁→x₀) + ∫ f(x₁, ω)·|cos θ|·Le(ω) dω
//! ```
//!
//! The integral is estimated with nₗ directions sampled from the lights and nₛ from the
//! scattering model, combined by the multi-sample balance heuristic over techniques and lanes
//! (Veach & Guibas 1995, eq. 10): the density of a technique counts as often as it is used.
//!
//! As in Mitsuba, light that passes surfaces straight (`mask`, `null`) is a scattering sample
//! like any other, shadow rays are stopped by such surfaces, and alpha is 1 wherever there is a
//! surface, 0 before the background.
//!
//! With one sample of either kind this is a path of two segments, and is followed as one.

use crate::path::{follow_alone, follow_jobs};
use crate::steps::arrival::{Arrival, Arriving, next_hit};
use crate::steps::camera_ray::camera_ray;
use crate::steps::candidates::Candidates;
use crate::steps::dimensions::BounceSamples;
use crate::steps::light_connection::LightConnection;
use crate::steps::light_mis::LightMis;
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::{LightCandidates, PathConfig, PathSettings, read_max_depth};
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, BsdfOf, Channel, Incompatibility, Integrator, LightSample, LightSampleContext,
    LightSearch, Pass, PixelSample, Placing, Ray, SampleJob, SceneCapabilities, Sensor, Sink,
    SurfaceInteraction, Surfaces, TileSink, TransportMode, World,
};
use glam::{Vec3, Vec4};
use std::vec::Drain;

/// The direct illumination integrator.
#[derive(Clone, Debug)]
pub struct Direct {
    /// Directions sampled from the lights.
    pub emitter_samples: u32,
    /// Number of light samples that are resampled for each shadow ray.
    pub light_candidates: LightCandidates,
    /// Directions sampled from the scattering model.
    pub bsdf_samples: u32,
    /// Longest path in segments: 1 shows lights only, 2 or more direct light too.
    pub max_depth: u32,
    /// Whether lights are invisible to the camera.
    pub hide_emitters: bool,
}

const START: PathThroughput = PathThroughput::START;
const NONE: LightMis = LightMis::NONE;

impl Direct {
    /// Reads the integrator from its description: `shading_samples` for both kinds, or
    /// `emitter_samples` and `bsdf_samples`; `max_depth` and `hide_emitters` as for paths.
    pub fn from_params(params: &Params<'_>) -> Self {
        let count = |name: &str, default: u32| {
            let value = params.integer_or(name, i64::from(default));
            u32::try_from(value)
                .ok()
                .filter(|n| *n <= 1 << 16)
                .unwrap_or_else(|| {
                    params.refuse(name, value, "0, 1, … 65536");
                    default
                })
        };
        let both = count("shading_samples", 1);
        if params.has("shading_samples")
            && (params.has("emitter_samples") || params.has("bsdf_samples"))
        {
            params.error_at(
                "shading_samples",
                "give either `shading_samples` or `emitter_samples` and `bsdf_samples`",
            );
        }
        let direct = Self {
            emitter_samples: count("emitter_samples", both),
            light_candidates: LightCandidates::from_params(params),
            bsdf_samples: count("bsdf_samples", both),
            max_depth: read_max_depth(params),
            hide_emitters: params.boolean_or("hide_emitters", false),
        };
        if direct.emitter_samples + direct.bsdf_samples == 0 {
            params.error("`direct` needs at least one light or scattering sample");
        }
        direct
    }

    /// The paths of two segments that this is, if it is.
    fn as_path(&self) -> Option<PathConfig> {
        let one_of_each = [self.emitter_samples, self.bsdf_samples] == [1, 1];
        (one_of_each && self.max_depth > 0).then(|| PathConfig {
            candidates: self.light_candidates,
            alpha_of_surfaces: true,
            ..PathConfig::plain(PathSettings {
                max_depth: self.max_depth.min(2),
                rr_depth: u32::MAX,
                hide_emitters: self.hide_emitters,
            })
        })
    }

    fn incident<W: World, S: Sampler>(
        &self,
        world: &W,
        mut ray: Ray,
        wavelengths: &Wavelengths,
        sampler: &mut S,
    ) -> (Vec4, f32) {
        let visible = !self.hide_emitters;
        let hit = next_hit(world, &mut ray, !visible);
        let sees_background = visible && self.max_depth >= 1;
        let arriving = Arriving {
            wavelengths,
            throughput: &START,
            light_mis: &NONE,
        };
        let (vertex, emission) = match arriving.at(world, &ray, hit.as_ref(), sees_background) {
            Arrival::Surface(vertex, emission) => (vertex, emission),
            Arrival::Background(emission) => return (emission, 0.0),
            Arrival::Nothing => return (Vec4::ZERO, 0.0),
        };
        let wo = -ray.direction;
        let mut result = match self.max_depth {
            0 => Vec4::ZERO,
            _ => emission,
        };
        if self.max_depth < 2 {
            return (result, 1.0);
        }
        let bsdf = world.surfaces().bsdf(&vertex, wo, wavelengths);
        let mut from = LightSampleContext::new(&vertex, wo, &bsdf);
        from.combined = self.bsdf_samples > 0;
        let mut event = 0;
        if bsdf.has_continuous() {
            for _ in 0..self.emitter_samples {
                result += self.light_sample(
                    world,
                    wavelengths,
                    &vertex,
                    &from,
                    &bsdf,
                    wo,
                    sampler,
                    event,
                );
                event += 1;
            }
        }
        event = 0;
        for _ in 0..self.bsdf_samples {
            result += self.scattering_sample(
                world,
                wavelengths,
                &vertex,
                &from,
                &bsdf,
                wo,
                sampler,
                event,
            );
            event += 1;
        }
        (result, 1.0)
    }

    #[allow(clippy::too_many_arguments)]
    fn light_sample<W: World, S: Sampler>(
        &self,
        world: &W,
        wavelengths: &Wavelengths,
        vertex: &SurfaceInteraction,
        from: &LightSampleContext,
        bsdf: &BsdfOf<'_, W>,
        wo: Vec3,
        sampler: &mut S,
        event: u32,
    ) -> Vec4 {
        let event = BounceSamples::draw(sampler, event);
        let candidates = Candidates::at(self.light_candidates, world, from);
        let balance = [self.emitter_samples as f32, self.bsdf_samples as f32];
        let connect = |light: &LightSample| LightConnection::new(light, &START, bsdf, wo, balance);
        let connection = candidates.draw(world, from, wavelengths, &event, sampler, connect);
        connection.map_or(Vec4::ZERO, |connection| {
            connection.traced(world, vertex, wavelengths, 0)
        })
    }

    #[allow(clippy::too_many_arguments)]
    fn scattering_sample<W: World, S: Sampler>(
        &self,
        world: &W,
        wavelengths: &Wavelengths,
        vertex: &SurfaceInteraction,
        from: &LightSampleContext,
        bsdf: &BsdfOf<'_, W>,
        wo: Vec3,
        sampler: &mut S,
        event: u32,
    ) -> Vec4 {
        let event = BounceSamples::draw(sampler, event);
        let Some(sample) = bsdf.sample(wo, event.lobe, event.direction, TransportMode::Radiance)
        else {
            return Vec4::ZERO;
        };
        let mut path = START;
        let mut light_mis = NONE.after(&path, from, &sample);
        path.scatter(sample.value, sample.chance.lanes());
        path.r_u *= self.bsdf_samples as f32;
        light_mis.r_l *= self.emitter_samples as f32;
        let ray = vertex.spawn(sample.wi);
        let hit = world.surfaces().intersect(&ray);
        let arriving = Arriving {
            wavelengths,
            throughput: &path,
            light_mis: &light_mis,
        };
        match arriving.at(world, &ray, hit.as_ref(), true) {
            Arrival::Surface(_, emission) | Arrival::Background(emission) => emission,
            Arrival::Nothing => Vec4::ZERO,
        }
    }
}

impl Integrator for Direct {
    const UNBIASED: bool = false;
    const MEDIA: bool = false;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = false;

    type State = ();

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        false
    }

    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        capabilities.incompatibilities(match (self.emitter_samples, self.bsdf_samples) {
            (0, _) => LightSearch::Hitting,
            (_, 0) => LightSearch::Connecting,
            _ => LightSearch::FromCamera,
        })
    }

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Blocks
    }

    fn samples_per_pass(&self) -> Option<u32> {
        None
    }

    fn prepare<W: World>(&self, _: &W, _: &impl Placing, _: &Pass, _: Option<()>) {}

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        (): &(),
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        if let Some(config) = self.as_path() {
            return follow_alone(world, &config, (), (site, sampler), sink);
        }
        let (wavelengths, ray, weight) = camera_ray(world, site, sampler);
        let (radiance, alpha) = self.incident(world, ray, &wavelengths, sampler);
        let rgb = world.sensor().weights(&wavelengths).rgb(radiance * weight);
        sink.radiance(rgb.to_array(), alpha);
    }

    fn sample_batch<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        state: &(),
        jobs: Drain<'_, SampleJob<S>>,
        sink: &mut K,
    ) {
        if let Some(config) = self.as_path() {
            return follow_jobs(world, &config, (), jobs, sink);
        }
        for mut job in jobs {
            sink.begin_placed(job.site.pixel, &job.placement());
            self.sample(world, state, &job.site, &mut job.sampler, sink);
        }
    }
}
