//! Learning where light comes from: rounds of paths, each guided by what the round before has found.
//!
//! ```text
//! mass of a leaf = Σ L·|cos θ|/p     over the directions taken into it,     E[mass] = n ∫ L·|cos θ| dω
//! ```
//!
//! L is what came from the direction that a path took ([`super::pupil`]), p the density of that direction, θ
//! its angle with the surface's normal: what is learned is what a diffuse surface would like to know. Light
//! samples weigh in as everywhere: what they find well, L leaves to them, and the field learns the rest.
//!
//! Rounds take 1, 2, 4, … samples per pixel, the last what is left, and each starts its sums anew (Müller,
//! Gross & Novák 2017, §4): half of all training or more goes into the field that is used. Records move at
//! random within a box as large as their region, and their directions are spread over a square as large as
//! their leaf (Müller 2019, §10.5.1).
//!
//! Sums are integers: they do not depend on the order in which threads add. A record counts in units of 2⁻²⁰
//! of the mean of the round before, and no more than 2²⁰ of that mean, so that one mad path cannot
//! take a leaf for itself, and 2²⁴ such records fit.

use super::field::{FACES, Field, Lesson, Region, face, place_of, refinement};
use super::guide::Guide;
use super::pupil::{Pupil, Record};
use crate::path::follow;
use crate::settings::PathSettings;
use crate::walk::Walk;
use etalon_sampling::hash::{derived_key, mix64};
use etalon_sampling::{Independent, PixelSample, Sampler, Sobol};
use etalon_transport::{Pass, PixelSite, World};
use glam::{UVec2, Vec3};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// How a field is learned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lessons {
    pub(crate) settings: PathSettings,
    /// The probability of following the scattering model's own choice.
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

/// What is known of all records of a round, or of some.
#[derive(Clone, Copy)]
struct Tally {
    from: Vec3,
    to: Vec3,
    weight: f64,
    records: u64,
}

impl Tally {
    const NOTHING: Self = Self {
        from: Vec3::INFINITY,
        to: Vec3::NEG_INFINITY,
        weight: 0.0,
        records: 0,
    };

    fn add(&mut self, record: &Record) {
        self.from = self.from.min(record.position);
        self.to = self.to.max(record.position);
        self.weight += f64::from(record.weight);
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
    field: &'f Field,
    /// Where the slots of each region's faces begin.
    first: Vec<[usize; FACES]>,
    masses: Vec<AtomicU64>,
    /// The records of each region's faces.
    records: Vec<[AtomicU64; FACES]>,
    /// Units per weight.
    scale: f64,
}

impl<'f> Sums<'f> {
    fn new(field: &'f Field, scale: f64) -> Self {
        let mut slots = 0;
        let mut begin = |region: &Region| {
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
            scale,
        }
    }

    /// Adds a record, moved within its region's size by `shift` ∈ [−½, ½)³.
    fn add(&self, record: &Record, shift: Vec3) {
        let size = self.field.regions()[self.field.find(record.position)].size;
        let index = self.field.find(record.position + shift * size);
        let face = face(record.normal);
        self.records[index][face].fetch_add(1, Ordering::Relaxed);
        let units = (f64::from(record.weight) * self.scale).min(LARGEST);
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

    /// What each region has learned. A region that found no light keeps what it knew.
    fn lessons(&self, share: f64) -> Vec<Lesson> {
        let load = |sum: &AtomicU64| sum.load(Ordering::Relaxed);
        let regions = self.field.regions().par_iter().enumerate();
        let lesson = |(index, region): (usize, &Region)| {
            let records = self.records[index].each_ref().map(load);
            let mut irradiance = region.irradiance;
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
            Lesson {
                lobes,
                irradiance,
                records: records.iter().sum(),
            }
        };
        regions.map(lesson).collect()
    }
}

impl Lessons {
    /// Learns the field of an image. A pure function of the world, the image's seed, its film and its number
    /// of samples.
    pub(crate) fn learn<W: World>(&self, world: &W, pass: &Pass) -> Field {
        // Where paths go, and how bright it is there, so far.
        let nothing = Field::new(Vec3::ZERO, Vec3::ONE);
        let first = self.round(world, pass, &nothing, 0, 1, None);
        if first.records == 0 {
            return nothing;
        }
        let mut field = Field::new(first.from, first.to);
        let mut tally = first;
        let (mut round, mut samples, mut left) = (1, 1, self.samples.max(1));
        while left > 0 {
            // The last round takes what is left.
            if left / 3 < samples {
                samples = left;
            }
            let mean = tally.weight / tally.records as f64;
            let scale = if mean > 0.0 { UNITS / mean } else { UNITS };
            let sums = Sums::new(&field, scale);
            let found = self.round(world, pass, &field, round, samples, Some(&sums));
            let lessons = sums.lessons(self.share);
            let most = self.records * f64::from(samples).sqrt();
            field = field.learned(lessons, most as u64);
            if found.weight > 0.0 {
                tally = found;
            }
            left -= samples;
            (round, samples) = (round + 1, samples.saturating_mul(2));
        }
        field
    }

    /// Follows `samples` paths for every pixel.
    fn round<W: World>(
        &self,
        world: &W,
        pass: &Pass,
        field: &Field,
        round: u32,
        samples: u32,
        sums: Option<&Sums<'_>>,
    ) -> Tally {
        let seed = mix64(pass.seed ^ TRAINING);
        let guide = Guide {
            field,
            own: self.own,
            reflected: 1.0,
        };
        let row = |row: u32| {
            let mut tally = Tally::NOTHING;
            let mut pupil = Pupil::new(guide);
            for column in 0..pass.size.x {
                let pixel = pass.origin + UVec2::new(column, row);
                for sample in 0..samples {
                    let address = PixelSample {
                        seed,
                        replicate: round,
                        pixel: (pixel.x, pixel.y),
                        sample,
                        samples_per_replicate: samples,
                    };
                    pupil.begin();
                    pupil = self.path(world, pass, &address, pupil);
                    let mut shifts =
                        Independent::from_key(derived_key(address.pixel_key() ^ TRAINING, sample));
                    for record in pupil.records() {
                        tally.add(&record);
                        if let Some(sums) = sums {
                            let shift = [(); 3].map(|()| shifts.next_1d() - 0.5);
                            sums.add(&record, Vec3::from_array(shift));
                        }
                    }
                }
            }
            tally
        };
        // Rows are joined in order, so that the sums of floats are the same for any number of threads.
        let rows: Vec<Tally> = (0..pass.size.y).into_par_iter().map(row).collect();
        rows.into_iter().fold(Tally::NOTHING, Tally::join)
    }

    /// Follows one path with a pupil.
    fn path<'f, W: World>(
        &self,
        world: &W,
        pass: &Pass,
        address: &PixelSample,
        pupil: Pupil<'f>,
    ) -> Pupil<'f> {
        let mut sampler = Sobol::start(address);
        let pixel = UVec2::from(address.pixel);
        let site = PixelSite {
            pixel,
            raster: pixel.as_vec2() + sampler.next_2d(),
            margin: 0.0,
            pixels: pass.size.element_product(),
            spacing: 1.0,
            sample: address.sample,
        };
        let walk = Walk::start(world, &self.settings, &site, &mut sampler, pupil);
        let mut walks = [Some(walk)];
        follow(world, &self.settings, &mut walks);
        let [walk] = walks;
        walk.map(Walk::into_companion)
            .expect("a path that was followed is still there")
    }
}
