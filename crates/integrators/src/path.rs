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
use crate::path_state::PathState;
use crate::render::BATCH_SIZE;
use crate::settings::{LightCandidates, PathSettings, PathVariant};
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Integrator, Pass, PixelSample, Placing, SampleJob, Sink, Surfaces, TileSink, World,
};

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
    fn variant(&self) -> PathVariant {
        PathVariant {
            candidates: self.light_candidates,
            counts_null: !self.skips_null,
            equiangular: self.equiangular,
        }
    }
}

/// Follows paths to their ends.
#[inline]
pub(crate) fn follow<W: World, S: Sampler, C: PathHooks>(
    world: &W,
    settings: &PathSettings,
    walks: &mut [Option<PathState<S, C>>],
) {
    while walks.iter().flatten().any(PathState::goes_on) {
        let going = || |walk: &&mut PathState<S, C>| walk.goes_on();
        let queries = walks.iter_mut().flatten().filter(going());
        world
            .surfaces()
            .intersect_batch(queries.map(|walk| walk.ray_query(world)));
        for walk in walks.iter_mut().flatten().filter(going()) {
            walk.look_through_hidden(world, settings);
        }
        for walk in walks.iter_mut().flatten().filter(|w| w.goes_on()) {
            walk.shade(world, settings);
        }
        let queries = walks.iter_mut().flatten();
        world.transmittance_batch(queries.filter_map(PathState::shadow_query));
        walks.iter_mut().flatten().for_each(PathState::add_light);
    }
}

/// Draws samples by paths that are followed in step, each with a copy of `hooks`.
#[inline]
pub(crate) fn follow_drafts<W: World, S: Sampler, K: TileSink, C: PathHooks + Copy>(
    world: &W,
    settings: &PathSettings,
    variant: PathVariant,
    hooks: C,
    drafts: &mut [SampleJob<S>],
    sink: &mut K,
) {
    for drafts in drafts.chunks_mut(BATCH_SIZE) {
        let mut places = [None; BATCH_SIZE];
        let mut each = drafts.iter_mut().zip(&mut places);
        let mut walks: [Option<PathState<&mut S, C>>; BATCH_SIZE] = core::array::from_fn(|_| {
            let (draft, place) = each.next()?;
            *place = Some((draft.site.pixel, draft.placement()));
            let sampler = &mut draft.sampler;
            let walk = PathState::start(world, settings, &draft.site, sampler, hooks);
            Some(walk.with_variant(variant))
        });
        follow(world, settings, &mut walks);
        for (walk, (pixel, placement)) in walks.iter().flatten().zip(places.iter().flatten()) {
            sink.begin_placed(*pixel, placement);
            walk.deliver(world, sink);
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
        let walk =
            PathState::start(world, &self.settings, site, sampler, ()).with_variant(self.variant());
        let mut walks = [Some(walk)];
        follow(world, &self.settings, &mut walks);
        walks
            .iter()
            .flatten()
            .for_each(|walk| walk.deliver(world, sink));
    }

    fn sample_batch<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        (): &(),
        drafts: &mut [SampleJob<S>],
        sink: &mut K,
    ) {
        follow_drafts(world, &self.settings, self.variant(), (), drafts, sink);
    }
}
