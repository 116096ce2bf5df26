//! The contract of an estimator of light transport.

use crate::{
    Channel, FilmSample, Incompatibility, LightSearch, Placing, SceneCapabilities, Sink, TileSink,
    World,
};
use etalon_sampling::{ReplicateKind, Sampler};
use glam::{UVec2, Vec2};
use std::vec::Drain;

/// The place for which a sample is drawn.
#[derive(Clone, Copy, Debug)]
pub struct PixelSample {
    /// The pixel of the whole film, or around it (see [`crate::Film::rim`]); coordinates are modulo 2³².
    pub pixel: UVec2,
    /// The film position drawn from the reconstruction filter (pixels).
    pub raster: Vec2,
    /// Distance beyond the film up to which splats contribute (pixels), see [`crate::Film::margin`].
    pub margin: f32,
    /// Number of light paths traced per sample index over the whole film: one for each pixel (see
    /// [`crate::Film::light_paths`]). Each splat is divided by it. 0 disables splatting.
    pub pixels: u32,
    /// Mean distance between the samples of a pixel (pixels): 1/√spp.
    pub spacing: f32,
    /// Index of the sample among those of the pixel in its pass, from 0.
    pub sample: u32,
}

/// A pass over the film: some samples of every pixel, drawn after one preparation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pass {
    /// The seed of the image.
    pub seed: u64,
    /// The replicate that the pass belongs to.
    pub replicate: u32,
    /// Index of the pass in its replicate, from 0.
    pub number: u32,
    /// Passes per replicate.
    pub count: u32,
    /// Samples per pixel in this pass.
    pub samples: u32,
    /// Replicates of the whole image, including those rendered elsewhere.
    pub replicates: u32,
    /// Samples per pixel in the whole image: all passes of all replicates, including those rendered elsewhere.
    pub image_samples: u32,
    /// The first pixel of the cropped film.
    pub origin: UVec2,
    /// Size of the cropped film (pixels).
    pub size: UVec2,
    /// How many pixels beyond the film a splat can still matter, rounded up (see
    /// [`crate::Film::margin`]).
    pub margin: u32,
}

/// A sample about to be drawn.
#[derive(Clone, Debug)]
pub struct SampleJob<S> {
    /// For which place.
    pub site: PixelSample,
    /// Its weight there, see [`crate::FilmSample::weight`].
    pub weight: f32,
    /// Its random numbers; those of the film position are used up.
    pub sampler: S,
}

impl<S> SampleJob<S> {
    /// Its position on the film, with its weight.
    #[inline]
    pub fn placement(&self) -> FilmSample {
        FilmSample {
            raster: self.site.raster,
            weight: self.weight,
        }
    }
}

/// What an estimator prepares before a pass (photon maps, guiding trees); `()` where that is nothing.
pub trait Preparation: Send + Sync + 'static {
    /// Remarks for the user, one sentence each.
    fn remarks(&self) -> Vec<String>;
}

impl Preparation for () {
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }
}

/// An estimator: prepares before every pass, then turns random numbers into contributions.
///
/// A replicate is one pass unless the estimator asks for more. A progressive estimator, whose bias
/// falls from pass to pass (photon mapping), takes many: a replicate is then a whole progression.
///
/// A sample is a pure function of the sampler's numbers; the estimator of an image is the mean
/// over its replicates (ARCHITECTURE.md, "Replicates").
pub trait Integrator: Sync {
    /// The result of preparation.
    type State: Preparation;

    /// Whether its estimate of radiance is unbiased in every scene that it accepts
    /// ([`Integrator::incompatibilities`]), so that it must agree with every other such integrator.
    const UNBIASED: bool;

    /// Whether it supports participating media; if not, it refuses scenes that have them.
    const MEDIA: bool;

    /// Whether it supports diffusion profiles; if not, it refuses scenes that have any.
    const DIFFUSION: bool;

    /// Whether it traces particles from the lights; if so, it refuses scenes where these cannot reach every surface.
    const FOLLOWS_LIGHT: bool = false;

    /// The channels it writes beside the colour, in the order of [`Sink::channel`]'s index.
    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    /// Whether it splats to pixels other than the current one.
    fn splats(&self) -> bool {
        false
    }

    /// The reasons why it cannot render a scene, or not all of its light. By default those of an
    /// estimator whose camera paths both hit lights and sample them.
    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        capabilities.incompatibilities(LightSearch::FromCamera)
    }

    /// How its replicates are related: [`ReplicateKind::Blocks`] if every sample is an unbiased estimate that
    /// depends on the sampler's numbers only, so that any block of samples is a replicate. Independent where a
    /// replicate has its own preparation, progression or Markov chains.
    fn replicate_kind(&self) -> ReplicateKind;

    /// Samples per pixel after which it must prepare again; `None` if a replicate is one pass.
    fn samples_per_pass(&self) -> Option<u32> {
        None
    }

    /// Prepares a pass. `placing` places samples on the film, for preparations that draw some. `before` is the state of
    /// the previous pass, if this process rendered it, for reuse of its allocations. The result is a function of the
    /// world, the film, the pass and the estimator; it must not depend on `before`, the number of threads, or time.
    fn prepare<W: World>(
        &self,
        world: &W,
        placing: &impl Placing,
        pass: &Pass,
        before: Option<Self::State>,
    ) -> Self::State;

    /// Draws one sample.
    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        state: &Self::State,
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    );

    /// Draws several samples, in any order or together, and delivers them in the order given.
    /// Following several paths together hides the latency of memory; [`one_by_one!`](crate::one_by_one) does not.
    fn sample_batch<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        state: &Self::State,
        jobs: Drain<'_, SampleJob<S>>,
        sink: &mut K,
    );
}

/// [`Integrator::sample_batch`] of an estimator that draws one sample after another.
#[macro_export]
macro_rules! one_by_one {
    () => {
        #[inline]
        fn sample_batch<W, S, K>(
            &self,
            world: &W,
            state: &Self::State,
            jobs: ::std::vec::Drain<'_, $crate::SampleJob<S>>,
            sink: &mut K,
        ) where
            W: $crate::World,
            S: ::etalon_sampling::Sampler,
            K: $crate::TileSink,
        {
            for mut job in jobs {
                sink.begin_placed(job.site.pixel, &job.placement());
                self.sample(world, state, &job.site, &mut job.sampler, sink);
            }
        }
    };
}
