//! `path`: unidirectional path tracing with light sampling.
//!
//! The measurement of a pixel is an integral over paths x = x₀x₁…xₙ from the camera to a light,
//!
//! ```text
//! C = Σₙ ∫ Le(xₙ→xₙ₋₁) · Π_{0<i<n} fᵢ·|cos θᵢ| dω₁…dωₙ₋₁
//! ```
//!
//! with ωᵢ the direction from xᵢ to xᵢ₊₁; the camera draws the one from x₀ (Kajiya 1986; Veach 1997,
//! section 8.2). Directions are sampled from the scattering models;
//! the last one also from the lights ("next-event estimation"); the two techniques and the four
//! wavelengths are combined by one balance heuristic, see [`crate::path_throughput`].
//!
//! Surfaces that light passes straight (`mask`, `null`) count as segments, as in Mitsuba, but
//! neither stop shadow rays nor end light sampling's claim on a path: the density with which the
//! *last real vertex* would have sampled the light is carried across them.
//!
//! Several paths are followed in step: all of them look for their next surface, then all meet it,
//! then all trace their shadow rays. What one path waits for, another has meanwhile.

use crate::path_hooks::PathHooks;
use crate::path_state::{PathState, ScatteringPoint};
use crate::render::BATCH_SIZE;
use crate::settings::{LightCandidates, PathConfig, PathSettings};
use crate::steps;
use core::ops::{ControlFlow, Range};
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Bsdf, Integrator, Lights, Pass, PixelSample, Placing, Ray, SampleJob, Sink, Surfaces, TileSink,
    World,
};
use glam::Vec4;

/// The path tracer.
#[derive(Clone, Debug, Default)]
pub struct Path {
    /// Limits of the path.
    pub settings: PathSettings,
    /// How many light samples compete for a shadow ray where the path is not yet scattered at random.
    pub light_candidates: LightCandidates,
    /// Whether passing straight through a surface does not count for the length of a path, as in Mitsuba's `volpath`.
    pub skips_null: bool,
    /// Whether light is looked for along flights through media.
    pub equiangular: bool,
}

impl Path {
    /// Reads the integrator from its description.
    pub fn from_params(params: &Params<'_>) -> Self {
        // Mitsuba's integrators for media, which are this one.
        let volumetric = params.node.plugin.value.starts_with("vol");
        if volumetric {
            // Lanes are always combined.
            params.ignore(&["use_spectral_mis"]);
        }
        Self {
            settings: PathSettings::from_params(params),
            skips_null: volumetric,
            equiangular: params.boolean_or("equiangular", false),
            light_candidates: LightCandidates::from_params(params),
        }
    }
}

impl Path {
    fn config(&self) -> PathConfig {
        PathConfig {
            limits: self.settings,
            candidates: self.light_candidates,
            counts_null: !self.skips_null,
            equiangular: self.equiangular,
        }
    }
}

/// Follows paths to their ends, in step.
#[inline]
pub(crate) fn follow<W: World, S: Sampler, C: PathHooks>(
    world: &W,
    config: &PathConfig,
    paths: &mut [Option<PathState<S, C>>],
) {
    while paths.iter().flatten().any(|path| path.ray.is_some()) {
        for path in paths.iter_mut().flatten() {
            path.plan_flight(world, config);
        }
        let rays = paths.iter_mut().flatten();
        world
            .surfaces()
            .intersect_batch(rays.filter_map(PathState::segment));
        for path in paths.iter_mut().flatten() {
            if let Some(ray) = path.ray.take() {
                path.ray = extend(world, config, path, ray);
            }
        }
        let shadow_rays = paths.iter_mut().flatten();
        world.transmittance_batch(shadow_rays.filter_map(PathState::shadow_query));
        paths.iter_mut().flatten().for_each(PathState::add_light);
    }
}

/// Follows one path as long as it has scattered less than `wanted` ends at; of its contributions only those count whose number of
/// scattering events is in `wanted`.
pub(crate) fn follow_part<W: World, S: Sampler, C: PathHooks>(
    world: &W,
    config: &PathConfig,
    path: &mut PathState<S, C>,
    wanted: &Range<u32>,
) {
    while path.scatter_count < wanted.end {
        path.plan_flight(world, config);
        let Some(ray) = path.ray.take() else { break };
        path.hit = world.surfaces().intersect(&ray);
        let (radiance, scatter_count) = (path.radiance, path.scatter_count);
        path.ray = extend(world, config, path, ray);
        if scatter_count < wanted.start {
            path.radiance = radiance;
        }
        if wanted.contains(&(scatter_count + 1)) {
            path.trace_shadow(world);
        } else {
            path.shadow_ray = None;
        }
    }
}

/// What happens where `ray` leads, whose nearest surface is known: emission is added, a shadow ray prepared, and a direction
/// sampled. The ray that the path goes on with; `None` if it ends.
#[inline]
fn extend<W: World, S: Sampler, C: PathHooks>(
    world: &W,
    config: &PathConfig,
    path: &mut PathState<S, C>,
    mut ray: Ray,
) -> Option<Ray> {
    path.look_through_hidden(world, config, &mut ray);
    if ray.medium.is_some()
        && let ControlFlow::Break(next) = path.fly(world, config, &ray)
    {
        return next;
    }
    let Some(hit) = path.hit else {
        path.add_background(world, config, ray.direction);
        return None;
    };
    let emits = world.lights().is_emitter(&hit);
    let last = path.depth == config.limits.max_depth;
    if last && !emits && path.alpha > 0.0 && config.counts_null {
        return None;
    }
    let vertex = world.surfaces().vertex(&ray, &hit);
    if emits {
        path.add_emission(world, &vertex, ray.direction);
    }
    let wo = -ray.direction;
    let bsdf = world.surfaces().bsdf(&vertex, wo, &path.wavelengths);
    let bsdf = path.hooks.wrap_bsdf(&vertex, wo, bsdf);
    let passes = !config.counts_null && bsdf.null_probability() != Vec4::ZERO;
    if last && !passes {
        // No direction is sampled at the last vertex: its null probability alone estimates alpha.
        path.alpha = path.alpha.max(steps::opacity(&bsdf));
        return None;
    }
    let at = ScatteringPoint::new(&vertex, &bsdf, wo, path.draw_event());
    if !last {
        path.sample_light(world, config, &at);
    }
    let next = path.scatter(config, &at)?;
    if next.medium.is_some() {
        return path.enter(world, config, &vertex, ray.medium, next);
    }
    Some(next)
}

/// Draws samples by paths that are followed in step, each with a copy of `hooks`.
#[inline]
pub(crate) fn follow_jobs<W: World, S: Sampler, K: TileSink, C: PathHooks + Copy>(
    world: &W,
    config: &PathConfig,
    hooks: C,
    jobs: &mut [SampleJob<S>],
    sink: &mut K,
) {
    for jobs in jobs.chunks_mut(BATCH_SIZE) {
        let mut places = [None; BATCH_SIZE];
        let mut each = jobs.iter_mut().zip(&mut places);
        let mut paths: [Option<PathState<&mut S, C>>; BATCH_SIZE] = core::array::from_fn(|_| {
            let (job, place) = each.next()?;
            *place = Some((job.site.pixel, job.placement()));
            let sampler = &mut job.sampler;
            Some(PathState::start(world, config, &job.site, sampler, hooks))
        });
        follow(world, config, &mut paths);
        for (path, (pixel, placement)) in paths.iter().flatten().zip(places.iter().flatten()) {
            sink.begin_placed(*pixel, placement);
            path.deliver(world, sink);
        }
    }
}

impl Integrator for Path {
    const UNBIASED: bool = true;
    const MEDIA: bool = true;
    const DIFFUSION: bool = true;

    type State = ();

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Blocks
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
        let config = self.config();
        let mut paths = [Some(PathState::start(world, &config, site, sampler, ()))];
        follow(world, &config, &mut paths);
        for path in paths.iter().flatten() {
            path.deliver(world, sink);
        }
    }

    fn sample_batch<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        (): &(),
        jobs: &mut [SampleJob<S>],
        sink: &mut K,
    ) {
        follow_jobs(world, &self.config(), (), jobs, sink);
    }
}
