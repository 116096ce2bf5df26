//! The render loop: replicates × passes × tiles × pixels × samples.
//!
//! A replicate is an independent estimate of the whole image, made in one pass or in as many as the
//! integrator asks for. Tiles of a pass run in parallel; since a sample is a pure function of its address and the film accumulates exactly,
//! neither the number of threads nor the order of tiles changes a bit.

use etalon_sampling::{Independent, PixelSample, Sampler, SamplerKind, Sobol, Stratified};
use etalon_transport::{Draft, Film, Integrator, Pass, PixelSite, World};
use glam::UVec2;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Side of a tile (pixels) of pictures that have enough of them.
pub const TILE: u32 = 16;

/// A small picture has smaller tiles, so that each thread has this many to even out its load.
const TILES_PER_THREAD: u32 = 8;

/// How many samples are handed to the integrator at once.
pub const TOGETHER: usize = 16;

/// How much to render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// The seed of the image.
    pub seed: u64,
    /// Independent replicates of the image.
    pub replicates: u32,
    /// The replicates that are rendered here; `None` for all of them.
    pub share: Option<Share>,
    /// Samples per pixel in each replicate.
    pub samples_per_replicate: u32,
    /// The kind of sampler.
    pub sampler: SamplerKind,
}

/// Some of an image's replicates, each what it would be in a render of all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// The first.
    pub first: u32,
    /// How many.
    pub count: u32,
}

impl Share {
    /// Share `index` of `count`, counted from 0, where `replicates` are dealt in order and as
    /// evenly as they can be; `None` if there is no such share or it would be empty.
    pub fn of(replicates: u32, index: u32, count: u32) -> Option<Self> {
        if index >= count || count > replicates {
            return None;
        }
        let begin = |index: u32| {
            let before = u64::from(replicates) * u64::from(index) / u64::from(count);
            u32::try_from(before).ok()
        };
        let first = begin(index)?;
        let count = begin(index + 1)? - first;
        Some(Self { first, count })
    }
}

impl Plan {
    /// The replicates that are rendered.
    pub fn share(&self) -> Share {
        self.share.unwrap_or(Share {
            first: 0,
            count: self.replicates,
        })
    }
}

/// What happened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Replicates finished; fewer than planned if the render was cancelled.
    pub replicates: u32,
    /// Camera samples (and light paths, for integrators that splat).
    pub samples: u64,
    /// Rays traced.
    pub rays: u64,
    /// What the estimator remarked when it first prepared, see [`Integrator::remarks`].
    pub remarks: Vec<String>,
}

/// Watches a render.
pub trait Progress: Sync {
    /// A tile is done, with so many samples.
    fn tile_done(&self, samples: u64);
    /// Whether to stop after the replicate that is being rendered.
    fn cancelled(&self) -> bool;
}

/// A watcher that does not care.
impl Progress for () {
    fn tile_done(&self, _: u64) {}
    fn cancelled(&self) -> bool {
        false
    }
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

/// Renders replicates into `film` on the current thread pool.
pub fn render<W: World, I: Integrator, F: Film, P: Progress>(
    world: &W,
    integrator: &I,
    film: &mut F,
    plan: &Plan,
    progress: &P,
) -> Outcome {
    let origin = film.origin();
    let size = film.size();
    let side = tile_side(size, rayon::current_num_threads());
    let tiles = UVec2::new(size.x.div_ceil(side), size.y.div_ceil(side));
    let (rays, samples) = (AtomicU64::new(0), AtomicU64::new(0));
    let mut outcome = Outcome {
        replicates: 0,
        samples: 0,
        rays: 0,
        remarks: Vec::new(),
    };
    let Share { first, count } = plan.share();
    let lengths = integrator.samples_per_pass();
    let length = lengths.map_or(plan.samples_per_replicate, |length| length.max(1));
    let passes = plan.samples_per_replicate.div_ceil(length).max(1);
    let mut before = None;
    for (replicate, number) in (first..first + count)
        .flat_map(|replicate| (0..passes).map(move |number| (replicate, number)))
    {
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
        let state = integrator.prepare(world, &*film, &pass, before.take());
        if (replicate, number) == (first, 0) {
            outcome.remarks = integrator.remarks(&state);
        }
        let tile = |index: u32| {
            let corner = UVec2::new(index % tiles.x, index / tiles.x) * side;
            let from = origin + corner;
            let to = origin + (corner + side).min(size);
            let run = TileRun {
                world,
                integrator,
                state: &state,
                film: &*film,
                plan,
                pass: &pass,
                begin,
            };
            let drawn = match plan.sampler {
                SamplerKind::Independent => run.render(from, to, Independent::start),
                SamplerKind::Sobol => run.render(from, to, Sobol::start),
                SamplerKind::Stratified { jitter } => {
                    run.render(from, to, |sample| Stratified::with_jitter(sample, jitter))
                }
            };
            rays.fetch_add(world.take_ray_count(), Ordering::Relaxed);
            progress.tile_done(drawn);
            samples.fetch_add(drawn, Ordering::Relaxed);
        };
        (0..tiles.x * tiles.y)
            .into_par_iter()
            .with_max_len(1)
            .for_each(tile);
        before = Some(state);
        if number + 1 < passes {
            continue;
        }
        film.end_replicate(plan.samples_per_replicate);
        outcome.replicates += 1;
        if progress.cancelled() {
            break;
        }
    }
    outcome.rays = rays.into_inner();
    outcome.samples = samples.into_inner();
    outcome
}

/// One tile of one replicate.
struct TileRun<'a, W: World, I: Integrator, F: Film> {
    world: &'a W,
    integrator: &'a I,
    state: &'a I::State,
    film: &'a F,
    plan: &'a Plan,
    pass: &'a Pass,
    /// The first sample of the pass.
    begin: u32,
}

impl<W: World, I: Integrator, F: Film> TileRun<'_, W, I, F> {
    /// Renders the pixels in [`from`, `to`); gives the number of samples drawn.
    fn render<S: Sampler>(&self, from: UVec2, to: UVec2, start: impl Fn(&PixelSample) -> S) -> u64 {
        let samples = self.plan.samples_per_replicate;
        let spp = samples as f32 * self.plan.replicates as f32;
        let spacing = 1.0 / spp.sqrt();
        let margin = self.film.margin();
        let alone = !self.integrator.splats();
        let mut sink = self.film.tile(from, to, alone, self.begin);
        let mut drafts = Vec::with_capacity(TOGETHER);
        let mut drawn = 0;
        for y in from.y..to.y {
            for x in from.x..to.x {
                let pixel = UVec2::new(x, y);
                let dealt = self.film.dealt(pixel, samples);
                // Only where a replicate is one pass may pixels differ.
                let here = if self.pass.count == 1 {
                    dealt
                } else {
                    self.pass.samples
                };
                drawn += u64::from(here);
                for sample in 0..here {
                    let mut sampler = start(&PixelSample {
                        seed: self.plan.seed,
                        replicate: self.pass.replicate,
                        pixel: (x, y),
                        sample: self.begin + sample,
                        samples_per_replicate: dealt,
                    });
                    let placement = self.film.place(pixel, sampler.next_2d());
                    let site = PixelSite {
                        pixel,
                        raster: placement.raster,
                        margin,
                        pixels: self.film.light_paths(),
                        spacing,
                        sample,
                    };
                    let weight = placement.weight;
                    drafts.push(Draft {
                        site,
                        weight,
                        sampler,
                    });
                    if drafts.len() == TOGETHER {
                        self.integrator
                            .sample_all(self.world, self.state, &mut drafts, &mut sink);
                        drafts.clear();
                    }
                }
            }
        }
        self.integrator
            .sample_all(self.world, self.state, &mut drafts, &mut sink);
        drawn
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
