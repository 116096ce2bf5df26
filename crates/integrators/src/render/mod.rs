//! The render loop: replicates × passes × tiles × pixels × samples.
//!
//! A replicate is an estimate of the whole image, independent of the others or a block of one sequence
//! ([`etalon_sampling::ReplicateKind`]), rendered in one pass or as many as the integrator needs. Tiles of a pass run in
//! parallel. A long pass goes over all tiles in several rounds, so that an interrupted picture has samples everywhere. For
//! previews, the first round covers every eighth pixel of every eighth row, and the second is four times as dense. A
//! sample is a pure function of its address, and the film accumulates exactly: the number of threads, the order of tiles
//! and the rounds change no bit, and a render can resume at any sample.

pub(crate) mod positions;
mod progress;
mod render_plan;
mod replicate_range;
mod rounds;
pub mod signature;

pub use progress::Progress;
pub use render_plan::RenderPlan;
pub use replicate_range::ReplicateRange;

use crate::render::positions::{CancellablePlacing, around, position};
use crate::render::rounds::{Batches, RoundSize};
use etalon_sampling::{Independent, SampleId, Sampler, SamplerKind, Sobol, Stratified};
use etalon_transport::{
    Film, Integrator, Pass, PixelSample, Preparation, SampleJob, Surfaces, TileSink, World,
};
use glam::UVec2;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::vec::Drain;

/// Side of a tile (pixels) of pictures that have enough of them.
pub const TILE: u32 = 16;

/// A small picture has smaller tiles, so that each thread has this many to even out its load.
const TILES_PER_THREAD: u32 = 8;

/// Number of samples in a batch.
pub const BATCH_SIZE: usize = 256;

/// Columns and rows from one pixel of the first round to the next.
const COARSE: u32 = 8;

/// Statistics of a render.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenderStatistics {
    /// Replicates finished; fewer than planned if the render was cancelled.
    pub replicates: u32,
    /// Camera samples (and light paths, for integrators that splat).
    pub samples: u64,
    /// Rays traced.
    pub rays: u64,
    /// Remarks of the estimator on its first preparation, see [`Preparation::remarks`].
    pub remarks: Vec<String>,
}

/// The side of a tile (pixels) where so many threads share a picture of this size.
fn tile_side(size: UVec2, threads: usize) -> u32 {
    let enough = TILES_PER_THREAD.saturating_mul(u32::try_from(threads).unwrap_or(u32::MAX));
    let tiles = |side: u32| size.x.div_ceil(side).saturating_mul(size.y.div_ceil(side));
    let mut side = TILE;
    while side > 1 && threads > 1 && tiles(side) < enough {
        side /= 2;
    }
    side
}

/// Renders replicates into `film` on the current thread pool, and continues after the samples that the film already has of
/// the first of them. If it is cancelled, the film keeps the unfinished replicate.
///
/// A world's sensor has three channels. A film of more has several worlds, which differ in their sensors: every sample is
/// drawn in each, with the same numbers, and goes to its group of the film's bands ([`TileSink::select_group`]).
pub fn render<W: World, I: Integrator, F: Film>(
    worlds: &[W],
    integrator: &I,
    film: &mut F,
    plan: &RenderPlan,
    progress: &dyn Progress,
) -> RenderStatistics {
    let side = tile_side(film.size(), rayon::current_num_threads());
    let mut run = Run {
        worlds,
        integrator,
        progress,
        plan,
        side,
        rays: AtomicU64::new(0),
        samples: AtomicU64::new(0),
        round_size: RoundSize::default(),
        batches: Batches::new(BATCH_SIZE),
        remarks: None,
    };
    let ReplicateRange { first, count } = plan.share();
    let mut before = Vec::new();
    let finished = (first..first + count)
        .take_while(|replicate| run.replicate(film, *replicate, &mut before))
        .count();
    RenderStatistics {
        replicates: finished as u32,
        samples: run.samples.into_inner(),
        rays: run.rays.into_inner(),
        remarks: run.remarks.unwrap_or_default(),
    }
}

/// The constants of a render.
struct Run<'a, W, I> {
    worlds: &'a [W],
    integrator: &'a I,
    progress: &'a dyn Progress,
    plan: &'a RenderPlan,
    /// Side of a tile (pixels).
    side: u32,
    rays: AtomicU64,
    samples: AtomicU64,
    round_size: RoundSize,
    batches: Batches,
    /// Remarks of the integrator on its first preparation.
    remarks: Option<Vec<String>>,
}

impl<W: World, I: Integrator> Run<'_, W, I> {
    /// Renders a replicate; says whether it is finished. `before` is what the pass before it used.
    fn replicate<F: Film>(
        &mut self,
        film: &mut F,
        replicate: u32,
        before: &mut Vec<I::State>,
    ) -> bool {
        let plan = self.plan;
        let (origin, size) = (film.origin(), film.size());
        let lengths = self.integrator.samples_per_pass();
        let length = lengths.map_or(plan.samples_per_replicate, |length| length.max(1));
        let passes = plan.samples_per_replicate.div_ceil(length).max(1);
        let done = done(film, plan.samples_per_replicate);
        for number in done / length..passes {
            let begin = number * length;
            let pass = Pass {
                seed: plan.seed,
                replicate,
                number,
                count: passes,
                samples: length.min(plan.samples_per_replicate - begin),
                replicates: plan.replicates,
                image_samples: plan.samples_per_replicate.saturating_mul(plan.replicates),
                origin,
                size,
                margin: film.margin().ceil() as u32,
            };
            if self.progress.cancelled() {
                return false;
            }
            let placing = CancellablePlacing {
                film: &*film,
                progress: self.progress,
            };
            let mut before_it = std::mem::take(before).into_iter();
            let prepare =
                |world| (self.integrator).prepare(world, &placing, &pass, before_it.next());
            let states: Vec<I::State> = self.worlds.iter().map(prepare).collect();
            let first = states.iter().take(1);
            self.remarks
                .get_or_insert_with(|| first.flat_map(Preparation::remarks).collect());
            // An unfinished preparation is not used.
            let until = done.saturating_sub(begin);
            if self.progress.cancelled() || !self.pass(film, &pass, [begin, until], &states) {
                return false;
            }
            *before = states;
        }
        film.end_replicate(plan.samples_per_replicate);
        true
    }

    /// Goes over the film until a pass is finished; says whether it is. The pass begins with the
    /// replicate's sample `begin`, and `until` of its samples are there.
    fn pass<F: Film>(
        &mut self,
        film: &mut F,
        pass: &Pass,
        [begin, mut until]: [u32; 2],
        states: &[I::State],
    ) -> bool {
        let size = film.size();
        let pixels = u64::from(size.x) * u64::from(size.y);
        let tiles = UVec2::new(size.x.div_ceil(self.side), size.y.div_ceil(self.side));
        self.round_size.begin();
        let mut stride = match self.is_first(pass) && until == 0 {
            true => COARSE,
            false => 1,
        };
        while until < pass.samples {
            let target = match stride {
                1 => until + self.round_size.round(pixels).min(pass.samples - until),
                _ => 1,
            };
            let (drawn, cut) = (AtomicU64::new(0), AtomicBool::new(false));
            let tile = |index: u32| {
                let corner = UVec2::new(index % tiles.x, index / tiles.x) * self.side;
                let from = pass.origin + corner;
                let to = pass.origin + (corner + self.side).min(size);
                let round = Round {
                    run: self,
                    states,
                    film: &*film,
                    pass,
                    begin,
                    until: target,
                    stride,
                };
                let (here, whole) = match self.plan.sampler {
                    SamplerKind::Independent => round.tile(from, to, Independent::start),
                    SamplerKind::Sobol => round.tile(from, to, Sobol::start),
                    SamplerKind::Stratified { jitter } => {
                        round.tile(from, to, |sample| Stratified::with_jitter(sample, jitter))
                    }
                };
                let traced = self
                    .worlds
                    .first()
                    .map_or(0, |world| world.surfaces().take_ray_count());
                self.rays.fetch_add(traced, Ordering::Relaxed);
                self.progress.tile_done(here);
                drawn.fetch_add(here, Ordering::Relaxed);
                cut.fetch_or(!whole, Ordering::Relaxed);
            };
            (0..tiles.x * tiles.y)
                .into_par_iter()
                .with_max_len(1)
                .for_each(tile);
            let drawn = drawn.into_inner();
            self.samples.fetch_add(drawn, Ordering::Relaxed);
            self.round_size.end_round(drawn);
            if cut.into_inner() {
                return false;
            }
            match stride {
                1 => until = target,
                // The same samples, of more pixels.
                _ => stride = (stride / 4).max(1),
            }
            if until < pass.samples {
                film.end_round();
            }
        }
        true
    }

    /// Whether a pass is the first of the picture, and its replicate has no other: pixels may be unlike then.
    fn is_first(&self, pass: &Pass) -> bool {
        pass.count == 1 && pass.replicate == self.plan.share().first
    }
}

/// The least number of finished samples of a pixel in the replicate, of `samples`.
fn done<F: Film>(film: &F, samples: u32) -> u32 {
    let (origin, size) = (film.origin(), film.size());
    let pixels = (0..size.y).flat_map(|y| (0..size.x).map(move |x| origin + UVec2::new(x, y)));
    let done = pixels.map(|pixel| {
        let dealt = u64::from(film.dealt(pixel, samples).max(1));
        u64::from(film.done(pixel)) * u64::from(samples) / dealt
    });
    done.min()
        .map_or(samples, |done| (done as u32).min(samples))
}

/// One round over the film, of a pass that begins with sample `begin`: up to so many of its samples.
struct Round<'a, 'r, W: World, I: Integrator, F: Film> {
    run: &'a Run<'r, W, I>,
    states: &'a [I::State],
    film: &'a F,
    pass: &'a Pass,
    begin: u32,
    until: u32,
    /// The round covers every `stride`-th column and row.
    stride: u32,
}

impl<W: World, I: Integrator, F: Film> Round<'_, '_, W, I, F> {
    /// Renders the pixels in [`from`, `to`); gives the number of samples drawn, and whether these
    /// are all.
    fn tile<S: Sampler + Clone>(
        &self,
        from: UVec2,
        to: UVec2,
        start: impl Fn(&SampleId) -> S,
    ) -> (u64, bool) {
        let Run {
            integrator,
            progress,
            plan,
            batches,
            ..
        } = self.run;
        let samples = plan.samples_per_replicate;
        let spp = samples as f32 * plan.replicates as f32;
        let spacing = 1.0 / spp.sqrt();
        let margin = self.film.margin();
        let (rim, pixels) = (self.film.rim(), self.film.light_paths());
        let alone = !integrator.splats();
        let mut sink = self.film.tile(from, to, alone);
        let mut jobs = Vec::with_capacity(BATCH_SIZE);
        let mut near = Vec::new();
        let mut drawn = 0;
        let mut deliver = |jobs: &mut Vec<SampleJob<S>>| {
            batches.measure(|| {
                self.draw(jobs.drain(..), &mut sink);
            });
        };
        for y in from.y..to.y {
            for x in from.x..to.x {
                let pixel = UVec2::new(x, y);
                if self.stride > 1 && (pixel - self.pass.origin) % self.stride != UVec2::ZERO {
                    continue;
                }
                let dealt = self.film.dealt(pixel, samples);
                near.clear();
                match rim {
                    0 => near.push(pixel),
                    _ => near.extend(around(pixel, self.pass, rim)),
                }
                for sample in self.film.done(pixel).max(self.begin)..self.target(dealt) {
                    // Checked while no sample is pending, so that every sample begun is finished.
                    if jobs.is_empty() && progress.cancelled() {
                        return (drawn, false);
                    }
                    for &pixel in &near {
                        let address = plan.address(self.pass.replicate, pixel, sample, dealt);
                        let mut sampler = start(&address);
                        let numbers = sampler.next_2d();
                        let numbers = position(self.film, plan.sampler, &address, numbers);
                        let placement = self.film.place(pixel, numbers);
                        let site = PixelSample {
                            pixel,
                            raster: placement.raster,
                            margin,
                            pixels,
                            spacing,
                            sample: sample - self.begin,
                        };
                        let weight = placement.weight;
                        jobs.push(SampleJob {
                            site,
                            weight,
                            sampler,
                        });
                        if jobs.len() >= batches.size() {
                            deliver(&mut jobs);
                        }
                    }
                    drawn += 1;
                }
            }
        }
        deliver(&mut jobs);
        (drawn, true)
    }

    /// Draws samples and delivers them.
    #[inline]
    fn draw<S: Sampler + Clone>(&self, jobs: Drain<'_, SampleJob<S>>, sink: &mut F::Tile<'_>) {
        let Run {
            worlds, integrator, ..
        } = self.run;
        if let ([world], [state]) = (worlds, self.states) {
            return integrator.sample_batch(world, state, jobs, sink);
        }
        for job in jobs {
            sink.begin_placed(job.site.pixel, &job.placement());
            for (group, (world, state)) in worlds.iter().zip(self.states).enumerate() {
                sink.select_group(group);
                let mut sampler = job.sampler.clone();
                integrator.sample(world, state, &job.site, &mut sampler, sink);
            }
        }
    }

    /// Number of finished samples of a pixel after this round, of the `dealt` ones.
    fn target(&self, dealt: u32) -> u32 {
        // Only where a replicate is one pass may pixels differ; they come along alike.
        if self.pass.count > 1 {
            return self.begin + self.until;
        }
        let [dealt, until, of] = [dealt, self.until, self.pass.samples].map(u64::from);
        (dealt * until).div_ceil(of) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pictures_have_tiles_for_every_thread() {
        let side = |x, y, threads| tile_side(UVec2::new(x, y), threads);
        assert_eq!(side(512, 512, 2), TILE);
        assert_eq!(side(32, 32, 2), 8);
        assert_eq!(side(3, 3, 2), 1);
        assert_eq!(side(3, 3, 1), TILE);
        assert_eq!(side(1, 1, 64), 1);
    }
}
