//! The bootstrap of a replicate: brightness, seeds, and probabilities of path kinds.

use super::contributions::{Contribution, Contributions};
use super::film_region::FilmRegion;
use super::importance_map::ImportanceMap;
use super::primary::PrimarySample;
use super::{ChainSettings, Integrand};
use etalon_sampling::hash::{derived_key, mix64, random_float, stream_key};
use etalon_transport::{Pass, Placing, Preparation};
use glam::Vec2;
use rayon::prelude::*;

/// Fewest and most uniform samples of the pilot; a quarter of a replicate's lies between.
const PILOT: [u64; 2] = [1 << 11, 1 << 15];

/// Samples per task of the pilot or a bootstrap; it decides no bits.
const TASK: u32 = 512;

/// Streams of random numbers of a replicate.
#[derive(Clone, Copy)]
pub(super) enum Stream {
    Seeds,
    Choice,
    Chains,
}

impl Stream {
    pub(super) fn key(self, seed: u64, replicate: u32) -> u64 {
        derived_key(!stream_key(seed, replicate), self as u32)
    }
}

/// Probability of each kind of path: three quarters in proportion to its light, one quarter uniform.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PathLengthPdf {
    /// The sums of the probabilities up to and with each.
    sums: Vec<f32>,
}

impl PathLengthPdf {
    /// Probabilities for kinds that bring so much light.
    fn new(brightness: &[f64]) -> Self {
        let count = brightness.len() as f64;
        let total: f64 = brightness.iter().sum();
        let mut sum = 0.0;
        let mut sums: Vec<f32> = brightness
            .iter()
            .map(|own| {
                let share = if total > 0.0 {
                    own / total
                } else {
                    1.0 / count
                };
                sum += 0.75 * share + 0.25 / count;
                sum as f32
            })
            .collect();
        if let Some(last) = sums.last_mut() {
            *last = 1.0;
        }
        Self { sums }
    }

    fn alike(count: usize) -> Self {
        Self::new(&vec![0.0; count])
    }

    /// The kind that `u` chooses, and its probability.
    pub(crate) fn choose(&self, u: f32) -> (usize, f32) {
        let chosen = self.sums.partition_point(|sum| *sum <= u);
        let before = chosen.checked_sub(1).map_or(0.0, |last| self.sums[last]);
        (chosen, self.sums[chosen] - before)
    }
}

/// The result of the pilot, once per image.
#[derive(Clone, Debug)]
pub(super) struct Pilot {
    seed: u64,
    pub(super) kinds: PathLengthPdf,
    pub(super) emphasis: ImportanceMap,
    /// c: the brightness that the balance heuristic assumes.
    pub(super) brightness: f64,
}

/// The bootstrap of a replicate.
#[derive(Clone, Debug)]
pub struct BootstrapState {
    pub(super) pilot: Pilot,
    pub(super) seed: u64,
    pub(super) replicate: u32,
    pub(super) field: FilmRegion,
    /// b̂
    pub(super) brightness: f64,
    /// c·ρ
    pub(super) uniform: f64,
    /// The bootstrap samples at which chains start.
    pub(super) starts: Vec<u32>,
    /// Steps per chain.
    pub(super) length: u32,
    /// Samples per pixel of the replicate.
    pub(super) samples: u32,
    /// What a contribution of one step is multiplied by, for a film that divides by the samples of
    /// a pixel.
    pub(super) scale: f64,
    /// The contributions of the bootstrap samples.
    pub(super) contributions: Vec<Contribution>,
}

impl Preparation for BootstrapState {
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }
}

impl BootstrapState {
    /// The weight of a visit of a chain.
    pub(super) fn chain_weight(&self, brightness: f64) -> f64 {
        if self.brightness > 0.0 {
            self.brightness * self.scale / (brightness + self.uniform)
        } else {
            0.0
        }
    }

    /// The weight of a uniform sample.
    pub(super) fn uniform_weight(&self, brightness: f64) -> f64 {
        let assumed = self.pilot.brightness;
        if assumed > 0.0 {
            assumed * self.scale / (brightness + self.uniform)
        } else {
            0.0
        }
    }

    /// Prepares a replicate.
    pub(crate) fn prepare<T: Integrand>(
        integrand: &T,
        settings: &ChainSettings,
        placing: &impl Placing,
        pass: &Pass,
        before: Option<Self>,
    ) -> Self {
        let field = FilmRegion::of(pass);
        let samples = u64::from(pass.size.x) * u64::from(pass.size.y) * u64::from(pass.samples);
        let kept = before.map(|state| state.pilot);
        let pilot = kept
            .filter(|pilot| pilot.seed == pass.seed)
            .unwrap_or_else(|| Pilot::run(integrand, settings, placing, field, pass.seed, samples));
        let chains = (samples / u64::from(settings.length)).clamp(1, u32::MAX.into());
        let length = (samples / chains).min(u64::from(u32::MAX)) as u32;
        let steps = chains as f64 * f64::from(length);
        let seeds = settings.seeds.unwrap_or_else(|| {
            let range = ChainSettings::SEEDS;
            samples.clamp(range.start.into(), range.end.into()) as u32
        });
        let density = f64::from(seeds) / steps + f64::from(settings.large_step);
        let mut state = Self {
            uniform: pilot.brightness * density,
            pilot,
            seed: pass.seed,
            replicate: pass.replicate,
            field,
            brightness: 0.0,
            starts: Vec::new(),
            length,
            samples: pass.samples,
            scale: f64::from(pass.samples) / steps,
            contributions: Vec::new(),
        };
        if integrand.kinds() > 0 {
            state.begin(integrand, settings, placing, seeds, chains as u32);
        }
        state
    }

    /// Draws the bootstrap samples, and chooses among them the chains' starts.
    fn begin<T: Integrand>(
        &mut self,
        integrand: &T,
        settings: &ChainSettings,
        placing: &impl Placing,
        seeds: u32,
        chains: u32,
    ) {
        let key = Stream::Seeds.key(self.seed, self.replicate);
        let Pilot {
            kinds, emphasis, ..
        } = &self.pilot;
        let drawn = draw(
            (integrand, placing),
            settings,
            self.field,
            (kinds, emphasis),
            key,
            seeds,
            |found, task: &mut (Vec<f64>, Vec<Contribution>)| {
                let brightness = found.brightness();
                task.0.push(brightness);
                task.1
                    .extend(found.weighted(self.uniform_weight(brightness)));
            },
        );
        let mut brightness = Vec::with_capacity(seeds as usize);
        for (part, contributions) in drawn {
            brightness.extend(part);
            self.contributions.extend(contributions);
        }
        let total: f64 = brightness.iter().sum();
        self.brightness = total / f64::from(seeds);
        if !(total > 0.0) {
            // Chains of no weight: their large steps are uniform samples like any other.
            self.starts = vec![0; chains as usize];
            return;
        }
        // Systematic sampling: each start is picked in proportion, up to rounding.
        let offset = mix64(Stream::Choice.key(self.seed, self.replicate));
        let offset = f64::from(random_float((offset >> 32) as u32));
        let mut sum = 0.0;
        for (index, own) in brightness.iter().enumerate() {
            sum += own;
            let up_to = sum / total * f64::from(chains);
            while (self.starts.len() as f64 + offset) < up_to && self.starts.len() < chains as usize
            {
                self.starts.push(index as u32);
            }
        }
    }
}

impl Pilot {
    fn run<T: Integrand>(
        integrand: &T,
        settings: &ChainSettings,
        placing: &impl Placing,
        field: FilmRegion,
        seed: u64,
        samples: u64,
    ) -> Self {
        let count = integrand.kinds();
        if count == 0 {
            return Self {
                seed,
                kinds: PathLengthPdf::alike(0),
                emphasis: ImportanceMap::none(),
                brightness: 0.0,
            };
        }
        let [least, most] = PILOT;
        let pilot = (samples / 4).clamp(least, most) as u32;
        let learned = (&PathLengthPdf::alike(count), &ImportanceMap::none());
        let key = mix64(!mix64(seed));
        let note = |found: &Contributions, task: &mut Vec<(usize, Vec2, f64)>| {
            if found.is_sound() {
                let each = found.contributions().iter();
                let each = each.map(|one| (found.kind, one.raster, f64::from(one.brightness())));
                task.extend(each);
            }
        };
        let asked = (integrand, placing);
        let drawn: Vec<_> = draw(asked, settings, field, learned, key, pilot, note)
            .into_iter()
            .flatten()
            .collect();
        let emphasis = if settings.relative {
            ImportanceMap::of(&field, drawn.iter().map(|(_, raster, own)| (*raster, *own)))
        } else {
            ImportanceMap::none()
        };
        let mut sums = vec![0.0; count];
        for (kind, raster, own) in drawn {
            sums[kind] += own * f64::from(emphasis.at(&field, raster));
        }
        Self {
            seed,
            brightness: sums.iter().sum::<f64>() / f64::from(pilot),
            kinds: PathLengthPdf::new(&sums),
            emphasis,
        }
    }
}

/// The primary sample of a bootstrap with this index.
pub(super) fn start_key(key: u64, index: u32) -> u64 {
    derived_key(key, index)
}

/// Draws `count` uniform samples, fewer if the render is stopped, several per task, and returns their
/// results in order.
fn draw<T: Integrand, N: Default + Send>(
    (integrand, placing): (&T, &impl Placing),
    settings: &ChainSettings,
    field: FilmRegion,
    (kinds, emphasis): (&PathLengthPdf, &ImportanceMap),
    key: u64,
    count: u32,
    note: impl Fn(&Contributions, &mut N) + Sync,
) -> Vec<N> {
    (0..count.div_ceil(TASK))
        .into_par_iter()
        .map(|task| {
            let mut noted = N::default();
            let mut lists = T::Lists::default();
            let mut found = Contributions::default();
            let mut sample = PrimarySample::new(settings.step(), settings.large_step, 0, 0);
            for index in task * TASK..count.min((task + 1) * TASK) {
                if placing.stopped() {
                    break;
                }
                sample.restart(start_key(key, index));
                found.clear();
                integrand.find(&field, kinds, &mut sample, &mut lists, &mut found);
                found.measure(&field, emphasis);
                note(&found, &mut noted);
            }
            noted
        })
        .collect()
}
