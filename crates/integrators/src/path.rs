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
//! wavelengths are combined by one balance heuristic, see [`crate::steps::path_throughput`].
//!
//! Surfaces that light passes straight (`mask`, `null`) count as segments, as in Mitsuba, but
//! neither stop shadow rays nor end light sampling's claim on a path: the density with which the
//! *last real vertex* would have sampled the light is carried across them.
//!
//! Several paths are followed in step, see `PathBatch`.

pub(crate) mod batch;
mod diffusion;
mod equiangular;
pub(crate) mod hooks;
mod lane_vertex;
mod lanes;
mod media;
pub(crate) mod state;

use crate::path::batch::PathBatch;
use crate::path::hooks::PathHooks;
use crate::path::state::{PathState, ScatteringPoint, Step};
use crate::render::BATCH_SIZE;
use crate::steps::arrival;
use crate::steps::settings::{LightCandidates, PathConfig, PathSettings};
use arrayvec::ArrayVec;
use core::ops::{ControlFlow, Range};
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Bsdf, Hit, Integrator, Lights, Pass, PixelSample, Placing, Ray, SampleJob, Sink,
    SurfaceInteraction, Surfaces, TileSink, World,
};
use glam::Vec4;
use std::vec::Drain;

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
            alpha_of_surfaces: false,
        }
    }
}

/// Follows paths to their ends, in step.
#[inline]
pub(crate) fn follow<'w, W: World, S: Sampler, C: PathHooks, const N: usize>(
    world: &'w W,
    config: &PathConfig,
    batch: &mut PathBatch<'w, W, S, C, N>,
) {
    while batch.goes_on() {
        batch.intersect(world, config);
        batch.advance(world, config);
        batch.trace_shadows(world);
    }
}

/// Brings a path along `ray`, whose nearest surface is `hit`, to its next vertex, and scatters it there.
#[inline]
fn advance<'w, W: World, S: Sampler, C: PathHooks>(
    world: &'w W,
    config: &PathConfig,
    path: &mut PathState<'w, W, S, C>,
    (ray, hit): (&Ray, Option<&Hit>),
) -> Step {
    match arrive(world, config, path, (ray, hit)) {
        ControlFlow::Break(step) => step,
        ControlFlow::Continue(vertex) => scatter(world, config, path, (ray, &vertex)),
    }
}

/// Brings a path along `ray`, whose nearest surface is `hit`, to its next vertex, and adds the emission there. Breaks if the path
/// ends, is scattered in a medium, or passes a hidden light.
#[inline]
fn arrive<'w, W: World, S: Sampler, C: PathHooks>(
    world: &'w W,
    config: &PathConfig,
    path: &mut PathState<'w, W, S, C>,
    (ray, hit): (&Ray, Option<&Hit>),
) -> ControlFlow<Step, SurfaceInteraction> {
    if ray.medium.is_some() {
        path.fly(world, config, ray, hit)?;
    }
    let emits = |hit: &Hit| world.lights().is_emitter(hit);
    let hides = config.limits.sees_through_lights(path.depth);
    if let Some(light) = hit.filter(|hit| hides && emits(hit)) {
        let light = world.surfaces().vertex(ray, light);
        let next = light.spawn(ray.direction);
        path.enter(world, &light, [ray.medium, next.medium]);
        return ControlFlow::Break(Step::straight(next));
    }
    let last = path.is_last(config);
    if last && config.counts_null && path.alpha > 0.0 && hit.is_some_and(|hit| !emits(hit)) {
        return ControlFlow::Break(Step::END);
    }
    match path.arrive(world, config, ray, hit) {
        Some(vertex) => ControlFlow::Continue(vertex),
        None => ControlFlow::Break(Step::END),
    }
}

/// Scatters a path at the surface point `vertex`, at the end of `ray`: samples a light and a direction.
#[inline]
fn scatter<'w, W: World, S: Sampler, C: PathHooks>(
    world: &'w W,
    config: &PathConfig,
    path: &mut PathState<'w, W, S, C>,
    (ray, vertex): (&Ray, &SurfaceInteraction),
) -> Step {
    let wo = -ray.direction;
    let bsdf = (path.hooks).wrap_bsdf(vertex, wo, || {
        world.surfaces().bsdf(vertex, wo, &path.wavelengths)
    });
    let last = path.is_last(config);
    let passes = !config.counts_null && bsdf.null_probability() != Vec4::ZERO;
    if last && !passes {
        // No direction is sampled at the last vertex: its null probability alone estimates alpha.
        path.alpha = path.alpha.max(arrival::opacity(&bsdf));
        return Step::END;
    }
    let at = ScatteringPoint::new(vertex, &bsdf, wo, path.draw_event());
    let step = Step {
        shadow: (!last)
            .then(|| path.sample_light(world, config, &at))
            .flatten(),
        ray: path.scatter(config, &at),
    };
    let Some(entered) = step.ray.map(|next| next.medium).filter(|id| id.is_some()) else {
        return step;
    };
    path.enter(world, vertex, [ray.medium, entered]);
    path.diffuse(world, config, vertex, entered, step)
}

/// Follows one path alone. Only contributions whose number of scattering events is in `wanted` count; the path ends where no more
/// can follow.
pub(crate) fn follow_part<'w, W: World, S: Sampler, C: PathHooks>(
    world: &'w W,
    config: &PathConfig,
    (path, camera_ray): (&mut PathState<'w, W, S, C>, Ray),
    wanted: &Range<u32>,
) {
    let mut next = config.first_segment(camera_ray);
    while path.scatter_count < wanted.end
        && let Some(mut ray) = next
    {
        path.plan_flight(config, &mut ray);
        let hit = world.surfaces().intersect(&ray);
        let (radiance, scatter_count) = (path.radiance, path.scatter_count);
        let step = advance(world, config, path, (&ray, hit.as_ref()));
        if scatter_count < wanted.start {
            path.radiance = radiance;
        }
        if wanted.contains(&(scatter_count + 1)) {
            path.trace_shadow(world, step.shadow);
        }
        next = step.ray;
    }
}

/// Draws samples by paths that are followed in batches, each with a copy of `hooks`.
#[inline]
pub(crate) fn follow_jobs<W: World, S: Sampler, K: TileSink, C: PathHooks + Copy>(
    world: &W,
    config: &PathConfig,
    hooks: C,
    mut jobs: Drain<'_, SampleJob<S>>,
    sink: &mut K,
) {
    while !jobs.as_slice().is_empty() {
        let mut batch = PathBatch::<_, _, _, BATCH_SIZE>::new();
        let mut places = ArrayVec::<_, BATCH_SIZE>::new();
        for job in jobs.by_ref().take(BATCH_SIZE) {
            places.push((job.site.pixel, job.placement()));
            batch.push(world, &job.site, job.sampler, hooks);
        }
        batch.start(world, config);
        follow(world, config, &mut batch);
        for (path, (pixel, placement)) in batch.paths.iter().zip(places) {
            sink.begin_placed(pixel, &placement);
            path.deliver(world, sink);
        }
    }
}

/// Draws one sample by a path that is followed alone.
#[inline]
pub(crate) fn follow_alone<W: World, S: Sampler, K: Sink, C: PathHooks>(
    world: &W,
    config: &PathConfig,
    hooks: C,
    (site, sampler): (&PixelSample, &mut S),
    sink: &mut K,
) {
    let (mut path, ray) = PathState::start(world, site, sampler, hooks);
    follow_part(world, config, (&mut path, ray), &(0..u32::MAX));
    path.deliver(world, sink);
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
        follow_alone(world, &self.config(), (), (site, sampler), sink);
    }

    fn sample_batch<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        (): &(),
        jobs: Drain<'_, SampleJob<S>>,
        sink: &mut K,
    ) {
        follow_jobs(world, &self.config(), (), jobs, sink);
    }
}
