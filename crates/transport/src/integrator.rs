//! The contract of an estimator of light transport.

use crate::{Channel, Sink, TileSink, World};
use etalon_sampling::Sampler;
use glam::{UVec2, Vec2};

/// The place for which a sample is drawn.
#[derive(Clone, Copy, Debug)]
pub struct PixelSite {
    /// The pixel of the whole film.
    pub pixel: UVec2,
    /// The film position drawn from the reconstruction filter (pixels).
    pub raster: Vec2,
    /// How far beyond the film a splat can still matter (pixels), see [`crate::Film::margin`].
    pub margin: f32,
    /// Number of pixels of the cropped film. One light path is drawn per pixel and sample, and
    /// the film divides by the samples per pixel only, so a light path's splats are divided by
    /// this number.
    pub pixels: u32,
    /// Mean distance between the samples of a pixel (pixels): 1/√spp.
    pub spacing: f32,
}

/// A sample about to be drawn.
#[derive(Clone, Debug)]
pub struct Draft<S> {
    /// For which place.
    pub site: PixelSite,
    /// What it counts there, see [`crate::Placement::weight`].
    pub weight: f32,
    /// Its random numbers; those of the film position are used up.
    pub sampler: S,
}

/// An estimator: prepares once per replicate, then turns random numbers into contributions.
///
/// A sample is a pure function of the sampler's numbers; the estimator of an image is the mean
/// over independent replicates (ARCHITECTURE.md, "Replicates").
pub trait Integrator: Sync {
    /// What is learned before sampling starts (photon maps, guiding trees); `()` for a path
    /// tracer.
    type State: Send + Sync;

    /// The channels it writes beside the colour, in the order of [`Sink::channel`]'s index.
    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    /// Whether it splats to pixels other than the current one.
    fn splats(&self) -> bool {
        false
    }

    /// Prepares one replicate.
    fn prepare<W: World>(&self, world: &W, seed: u64, replicate: u32) -> Self::State;

    /// Draws one sample.
    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        state: &Self::State,
        site: &PixelSite,
        sampler: &mut S,
        sink: &mut K,
    );

    /// Draws several samples, in any order or all at once, and delivers them in the order given.
    /// To follow several paths together keeps a processor busy that would wait for one.
    #[inline]
    fn sample_all<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        state: &Self::State,
        drafts: &mut [Draft<S>],
        sink: &mut K,
    ) {
        for draft in drafts {
            sink.begin_sample(draft.site.pixel, draft.weight);
            self.sample(world, state, &draft.site, &mut draft.sampler, sink);
        }
    }
}
