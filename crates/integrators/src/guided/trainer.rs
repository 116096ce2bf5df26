//! Training: rounds of paths, each guided by the field of the round before.
//!
//! ```text
//! mass of a leaf = Σ L·|cos θ|/p     over the directions taken into it,     E[mass] = n ∫ L·|cos θ| dω
//! ```
//!
//! L is the radiance from the direction that a path took ([`super::training_path`]), p the density of that direction, θ
//! its angle with the surface's normal: the field learns irradiance, the optimum for a diffuse surface. L has the MIS
//! weights of BSDF sampling: light that light sampling finds well is left to it.
//!
//! Rounds take 1, 2, 4, … samples per pixel, the last one the remainder, and each resets the sums (Müller, Gross &
//! Novák 2017, §4): half of all training or more goes into the final field. Positions of records are jittered within a
//! box as large as their region, and directions are spread over a square as large as their leaf (Müller 2019,
//! §10.5.1).
//!
//! Sums are integers, so they do not depend on the order in which threads add. A record counts in units of 2⁻²⁰ of the
//! mean of the round before, and at most 2²⁰ times that mean, so that one firefly cannot dominate a leaf, and 2²⁴
//! such records fit.

use super::fraction::FractionOptimizer;
use super::guided_hooks::GuidedHooks;
use super::sd_tree::{FACES, RegionUpdate, SdTree, SpatialLeaf, face, place_of, refinement};
use super::training_images::TrainingImages;
use super::training_path::{Record, TrainingPath};
use crate::path::follow_part;
use crate::path::state::PathState;
use crate::steps::settings::{PathConfig, PathSettings};
use etalon_sampling::hash::{derived_key, mix64};
use etalon_sampling::{Independent, SampleId, Sampler, Sobol};
use etalon_transport::{Pass, PixelSample, Placing, World};
use glam::{UVec2, Vec3, Vec4};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// The settings of training.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trainer {
    pub(crate) settings: PathSettings,
    /// The least probability of following the scattering model's own choice.
    pub(crate) own: f32,
    /// Samples per pixel for all rounds together.
    pub(crate) samples: u32,
    /// Records after which a region is halved in the round of one sample per pixel; in a round of n samples
    /// √n times as many.
    pub(crate) records: f64,
    /// The share of a region's light above which a square of directions is divided.
    pub(crate) share: f64,
}

/// Sets the seeds of training apart from those of images.
const TRAINING: u64 = 0x6775_6964_6564_0001;

/// Units in the mean record.
const UNITS: f64 = (1 << 20) as f64;

/// The largest record (units).
const LARGEST: f64 = (1_u64 << 40) as f64;

/// The context of training.
struct TrainingContext<'a, W, P> {
    world: &'a W,
    placing: &'a P,
    pass: &'a Pass,
}

/// A round of training: its paths per pixel.
#[derive(Clone, Copy)]
struct Iteration {
    number: u32,
    /// Independent streams of them: one for each replicate, or one alone.
    streams: u32,
    /// Paths of each stream.
    each: u32,
}

impl Iteration {
    /// A round whose paths belong to no replicate.
    fn alone(number: u32, samples: u32) -> Self {
        Self {
            number,
            streams: 1,
            each: samples,
        }
    }

    /// The last one, of at most so many samples: as many for each replicate if `by_replicate`.
    fn last(number: u32, samples: u32, replicates: u32, by_replicate: bool) -> Self {
        match by_replicate {
            true => Self {
                number,
                streams: replicates,
                each: samples / replicates,
            },
            false => Self::alone(number, samples),
        }
    }

    /// Samples per pixel.
    fn samples(self) -> u32 {
        self.streams * self.each
    }

    /// The address of a sample's random numbers.
    fn address(self, seed: u64, pixel: UVec2, sample: u32) -> SampleId {
        SampleId {
            seed: mix64(mix64(seed ^ TRAINING).wrapping_add(self.number.into())),
            replicate: sample / self.each,
            pixel: (pixel.x, pixel.y),
            sample: sample % self.each,
            samples_per_replicate: self.each,
            blocks: 1,
        }
    }
}

/// Statistics of the records of a round, or of some of them.
#[derive(Clone, Copy)]
struct TrainingStatistics {
    from: Vec3,
    to: Vec3,
    weight: f64,
    records: u64,
}

impl TrainingStatistics {
    const NOTHING: Self = Self {
        from: Vec3::INFINITY,
        to: Vec3::NEG_INFINITY,
        weight: 0.0,
        records: 0,
    };

    fn add(&mut self, record: &Record) {
        let Some(weight) = record.weight else {
            return;
        };
        self.from = self.from.min(record.position);
        self.to = self.to.max(record.position);
        self.weight += f64::from(weight);
        self.records += 1;
    }

    fn join(self, other: Self) -> Self {
        Self {
            from: self.from.min(other.from),
            to: self.to.max(other.to),
            weight: self.weight + other.weight,
            records: self.records + other.records,
        }
    }
}

/// Sums of one round: a mass for every slot of every quadtree.
struct Sums<'f> {
    field: &'f SdTree,
    /// Index of the first slot of each region's faces.
    first: Vec<[usize; FACES]>,
    masses: Vec<AtomicU64>,
    /// The records of each region's faces.
    records: Vec<[AtomicU64; FACES]>,
    /// The optimisers of α.
    scores: Vec<[FractionOptimizer; FACES]>,
    /// The least probability of following it.
    own: f32,
    /// Units per weight.
    scale: f64,
}

impl<'f> Sums<'f> {
    fn new(field: &'f SdTree, own: f32, scale: f64) -> Self {
        let mut slots = 0;
        let mut begin = |region: &SpatialLeaf| {
            core::array::from_fn(|face| {
                let first = slots;
                slots += region.tree(face).slots();
                first
            })
        };
        let first = field.regions().iter().map(&mut begin).collect();
        Self {
            field,
            first,
            masses: (0..slots).map(|_| AtomicU64::new(0)).collect(),
            records: (field.regions().iter())
                .map(|_| <[AtomicU64; FACES]>::default())
                .collect(),
            scores: (field.regions().iter())
                .map(|_| <[FractionOptimizer; FACES]>::default())
                .collect(),
            own,
            scale,
        }
    }

    /// Adds a record, moved within its region's size by `shift` ∈ [−½, ½)³.
    fn add(&self, record: &Record, shift: Vec3) {
        let size = self.field.regions()[self.field.find(record.position)].size;
        let index = self.field.find(record.position + shift * size);
        let face = face(record.normal);
        if let Some((light, alternatives)) = record.scattered {
            self.scores[index][face].add(self.own, f64::from(light) * self.scale, alternatives);
        }
        let Some(weight) = record.weight else {
            return;
        };
        self.records[index][face].fetch_add(1, Ordering::Relaxed);
        let units = (f64::from(weight) * self.scale).min(LARGEST);
        if !(units > 0.0) {
            return;
        }
        let first = self.first[index][face];
        let tree = self.field.regions()[index].tree(face);
        tree.spread(place_of(record.direction), |slot, part| {
            let units = (units * f64::from(part)) as u64;
            self.masses[first + slot].fetch_add(units, Ordering::Relaxed);
        });
    }

    /// The update of each region. A region that found no light keeps its density.
    fn updates(&self, share: f64) -> Vec<RegionUpdate> {
        let load = |sum: &AtomicU64| sum.load(Ordering::Relaxed);
        let regions = self.field.regions().par_iter().enumerate();
        let update = |(index, region): (usize, &SpatialLeaf)| {
            let records = self.records[index].each_ref().map(load);
            let mut irradiance = region.irradiance;
            let own = core::array::from_fn(|face| {
                let best = self.scores[index][face].best(self.own, records[face]);
                best.unwrap_or(region.own[face])
            });
            let lobes = core::array::from_fn(|face| {
                let tree = region.tree(face);
                let masses = &self.masses[self.first[index][face]..][..tree.slots()];
                let sum: u64 = masses.iter().map(load).sum();
                if sum > 0 {
                    let mean = sum as f64 / records[face] as f64;
                    irradiance[face] = (mean / self.scale) as f32;
                }
                let learned = tree.learned(|slot| load(&masses[slot]) as f64, refinement(share));
                learned.or_else(|| region.lobes[face].clone())
            });
            RegionUpdate {
                lobes,
                irradiance,
                own,
                records: records.iter().sum(),
            }
        };
        regions.map(update).collect()
    }
}

impl Trainer {
    /// Learns the field of an image, and returns the pictures of its training. A pure function of the world, the
    /// image's seed, its film and its number of samples.
    pub(crate) fn learn<W: World>(
        &self,
        world: &W,
        placing: &impl Placing,
        pass: &Pass,
    ) -> (SdTree, Option<TrainingImages>) {
        let context = TrainingContext {
            world,
            placing,
            pass,
        };
        // Extent and brightness of the scene, from the first paths.
        let nothing = SdTree::new(Vec3::ZERO, Vec3::ONE, self.own);
        let first = self.round(&context, &nothing, Iteration::alone(0, 1), None, None);
        if first.records == 0 {
            return (nothing, None);
        }
        let mut field = SdTree::new(first.from, first.to, self.own);
        let mut statistics = first;
        let (mut number, mut samples, mut left) = (1, 1, self.samples.max(1));
        loop {
            // The last round takes the remaining samples.
            let last = left / 3 < samples;
            let (round, mut pictures) = if last {
                let pictures = TrainingImages::black(placing, pass, left / pass.replicates.max(1));
                (
                    Iteration::last(number, left, pass.replicates, pictures.is_some()),
                    pictures,
                )
            } else {
                (Iteration::alone(number, samples), None)
            };
            let mean = statistics.weight / statistics.records as f64;
            let scale = if mean > 0.0 { UNITS / mean } else { UNITS };
            let sums = Sums::new(&field, self.own, scale);
            let found = self.round(&context, &field, round, Some(&sums), pictures.as_mut());
            let updates = sums.updates(self.share);
            let most = self.records * f64::from(round.samples()).sqrt();
            field = field.learned(updates, most as u64);
            if placing.stopped() {
                return (field, None);
            }
            if last {
                return (field, pictures);
            }
            if found.weight > 0.0 {
                statistics = found;
            }
            left -= samples;
            (number, samples) = (number + 1, samples.saturating_mul(2));
        }
    }

    /// Follows the paths of a round for every pixel, which `pictures` shows if there are any.
    fn round<W: World, P: Placing>(
        &self,
        context: &TrainingContext<'_, W, P>,
        field: &SdTree,
        round: Iteration,
        sums: Option<&Sums<'_>>,
        pictures: Option<&mut TrainingImages>,
    ) -> TrainingStatistics {
        let pass = context.pass;
        let guide = GuidedHooks {
            field,
            reflected: 1.0,
        };
        let row = |(row, mut seen): (u32, Option<&mut [Vec4]>)| {
            let mut statistics = TrainingStatistics::NOTHING;
            let mut training_path = TrainingPath::new(guide);
            for column in 0..pass.size.x {
                let pixel = pass.origin + UVec2::new(column, row);
                for sample in 0..round.samples() {
                    if context.placing.stopped() {
                        return statistics;
                    }
                    let address = round.address(pass.seed, pixel, sample);
                    training_path.begin();
                    let found;
                    (training_path, found) = self.path(context, &address, training_path);
                    if let Some(seen) = &mut seen {
                        let picture = address.replicate + round.streams * column;
                        seen[picture as usize] += found;
                    }
                    let mut shifts =
                        Independent::from_key(derived_key(address.pixel_key() ^ TRAINING, sample));
                    for record in training_path.records() {
                        statistics.add(&record);
                        if let Some(sums) = sums {
                            let shift = [(); 3].map(|()| shifts.next_1d() - 0.5);
                            sums.add(&record, Vec3::from_array(shift));
                        }
                    }
                }
            }
            statistics
        };
        // Rows are joined in order, so that the sums of floats are the same for any number of threads.
        let seen: Vec<Option<&mut [Vec4]>> = match pictures {
            Some(pictures) => pictures.rows().map(Some).collect(),
            None => (0..pass.size.y).map(|_| None).collect(),
        };
        let rows: Vec<_> = (0..pass.size.y).zip(seen).collect();
        let statistics: Vec<TrainingStatistics> = rows.into_par_iter().map(row).collect();
        statistics
            .into_iter()
            .fold(TrainingStatistics::NOTHING, TrainingStatistics::join)
    }

    /// Follows one path and records it in `training_path`; its contribution to the pixel, colour and alpha, times its weight
    /// on the film.
    fn path<'f, W: World, P: Placing>(
        &self,
        context: &TrainingContext<'_, W, P>,
        address: &SampleId,
        training_path: TrainingPath<'f>,
    ) -> (TrainingPath<'f>, Vec4) {
        let TrainingContext { world, pass, .. } = *context;
        let mut sampler = Sobol::start(address);
        let pixel = UVec2::from(address.pixel);
        let placement = context.placing.place_alone(pixel, sampler.next_2d());
        let site = PixelSample {
            pixel,
            raster: placement.raster,
            margin: 0.0,
            pixels: pass.size.element_product(),
            // As for the image's own samples, whose textures these must find.
            spacing: 1.0 / (pass.image_samples as f32).sqrt(),
            sample: address.sample,
        };
        let config = PathConfig::plain(self.settings);
        let (mut path, ray) = PathState::start(world, &site, &mut sampler, training_path);
        follow_part(world, &config, (&mut path, ray), &(0..u32::MAX));
        let found = path.colour(world).extend(path.alpha()) * placement.weight;
        (path.into_hooks(), found)
    }
}
