//! `guided` against exact radiances, with a field that it learned in the very world.

use crate::agreement::everything;
use crate::exact::Exact;
use crate::measure::{LIMIT, measure};
use crate::together::Record;
use crate::world::{Fault, Plane, Stack};
use etalon_integrators::guided::{Guided, Learned};
use etalon_integrators::settings::PathSettings;
use etalon_sampling::{Independent, ReplicateKind, SampleId, Sampler};
use etalon_statistics::Summary;
use etalon_transport::{
    Channel, FilmSample, Incompatibility, Integrator, Pass, PixelSample, Placing, SampleJob,
    SceneCapabilities, Sink, TileSink, World, one_by_one,
};
use glam::{UVec2, Vec2};

const N: u32 = 60_000;

/// `guided` after its lessons.
struct Prepared {
    integrator: Guided,
    learned: Learned,
}

impl Integrator for Prepared {
    const UNBIASED: bool = false;
    const MEDIA: bool = false;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = false;

    type State = ();

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        false
    }

    fn incompatibilities(&self, _: &SceneCapabilities) -> Vec<Incompatibility> {
        Vec::new()
    }

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Independent
    }

    fn samples_per_pass(&self) -> Option<u32> {
        None
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
        (self.integrator).sample(world, &self.learned, site, sampler, sink);
    }

    one_by_one!();
}

fn pass(replicate: u32) -> Pass {
    Pass {
        seed: 17,
        replicate,
        number: 0,
        count: 1,
        samples: 8,
        replicates: 8,
        image_samples: 64,
        origin: UVec2::new(3, 5),
        size: UVec2::new(16, 24),
        margin: 0,
    }
}

fn guided(max_depth: u32, rr_depth: u32) -> Guided {
    Guided {
        settings: PathSettings {
            max_depth,
            rr_depth,
            hide_emitters: false,
        },
        spatial_threshold: 500.0,
        ..Guided::default()
    }
}

fn prepared(stack: &Stack, max_depth: u32, rr_depth: u32) -> Prepared {
    let integrator = guided(max_depth, rr_depth);
    Prepared {
        learned: integrator.prepare(stack, &(), &pass(0), None),
        integrator,
    }
}

/// Mirrors that turn with wavelength and glossy lobes, below a filter and a sky that brightens upward.
fn rainbow() -> Stack {
    let planes = vec![
        Plane {
            smooth: 0.4,
            exponent: |nm| 1.0 + (nm - 360.0) * 0.03,
            ..Plane::WHITE
        },
        Plane {
            height: 1.0,
            passing: |nm| if nm < 500.0 { 0.7 } else { 0.4 },
            smooth: 0.3,
            reflectance: |_| 0.9,
            ..Plane::WHITE
        },
    ];
    Stack::new(planes, |_| 1.0, 0.5, false)
}

#[test]
fn guided_is_exact_whatever_it_learned() {
    for (name, stack) in [("everything", everything()), ("rainbow", rainbow())] {
        for (max_depth, rr_depth) in [(1, 9), (2, 9), (3, 9), (5, 1), (80, 2), (80, 5)] {
            let exact = Exact {
                stack: &stack,
                max_depth,
                hidden: false,
            };
            let guided = prepared(&stack, max_depth, rr_depth);
            let z = measure(&guided, &stack, N).z(exact.colour());
            assert!(z < LIMIT, "{name}, {max_depth}, rr {rr_depth}: z = {z:.2}");
        }
    }
}

#[test]
fn wrong_densities_are_noticed() {
    let cases = [
        (everything as fn() -> Stack, Fault::OtherLanes),
        (everything, Fault::FreePassage),
        (everything, Fault::LightChoice),
        (rainbow, Fault::AtomForAll),
        (rainbow, Fault::FreePassage),
    ];
    for (stack, fault) in cases {
        let stack = stack().with(fault);
        let exact = Exact {
            stack: &stack,
            max_depth: 7,
            hidden: false,
        };
        let z = measure(&prepared(&stack, 7, 99), &stack, N).z(exact.colour());
        assert!(z > LIMIT, "{fault:?} unnoticed: z = {z:.2}");
    }
}

/// The field is the same for every replicate and any number of threads, and is handed on.
#[test]
fn the_field_belongs_to_the_image() {
    let stack = rainbow();
    let integrator = guided(8, 5);
    let learn = |threads: usize, replicate: u32| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        // Handed on to the first replicate, whichever learned it.
        let learn = || {
            let learned = integrator.prepare(&stack, &(), &pass(replicate), None);
            integrator.prepare(&stack, &(), &pass(0), Some(learned))
        };
        format!("{:?}", pool.expect("threads").install(learn))
    };
    let first = learn(1, 0);
    assert!(first.len() > 10_000, "it learned something");
    assert_eq!(first, learn(2, 0));
    assert_eq!(first, learn(16, 3));
    let before = integrator.prepare(&stack, &(), &pass(1), None);
    let kept = integrator.prepare(&stack, &(), &pass(0), Some(before));
    assert_eq!(first, format!("{kept:?}"));
    let other = Pass {
        image_samples: 256,
        ..pass(0)
    };
    let other = integrator.prepare(&stack, &(), &other, None);
    assert_ne!(first, format!("{other:?}"));
}

/// A filter that a quarter of the samples count against, as one with negative lobes. Here, where every place looks
/// alike, all together make the picture [`LOBED`] times as bright.
struct Lobed {
    /// Whether pixels share samples, so that those of training join one by one.
    shares: bool,
}

const LOBED: f64 = 1.25;

impl Placing for Lobed {
    fn place(&self, pixel: UVec2, u: Vec2) -> FilmSample {
        FilmSample {
            raster: pixel.as_vec2() + u,
            weight: if u.x < 0.75 { 2.0 } else { -1.0 },
        }
    }

    fn dealt(&self, pixel: UVec2, even: u32) -> u32 {
        even * (1 + pixel.x % 2)
    }

    fn shares_samples(&self) -> bool {
        self.shares
    }
}

/// Adds up what samples bring, by what they count.
#[derive(Default)]
struct Scale {
    weight: f64,
    sum: [f64; 3],
}

impl Sink for Scale {
    fn radiance(&mut self, rgb: [f32; 3], _: f32) {
        for (sum, value) in self.sum.iter_mut().zip(rgb) {
            *sum += self.weight * f64::from(value);
        }
    }
    fn splat(&mut self, _: Vec2, _: [f32; 3]) {
        unreachable!("no estimator here splats");
    }
    fn channel(&mut self, _: usize, _: f32) {}
}

impl TileSink for Scale {
    fn begin_sample(&mut self, _: UVec2, weight: f32) {
        self.weight = f64::from(weight);
    }
}

/// A replicate's samples of a pixel.
fn drafts(placing: &impl Placing, pass: &Pass, pixel: UVec2) -> Vec<SampleJob<Independent>> {
    let dealt = placing.dealt(pixel, pass.samples);
    let draft = |sample| {
        let mut sampler = Independent::start(&SampleId {
            seed: pass.seed,
            replicate: pass.replicate,
            pixel: pixel.into(),
            sample,
            samples_per_replicate: dealt,
            blocks: 1,
        });
        let FilmSample { raster, weight } = placing.place(pixel, sampler.next_2d());
        let site = PixelSample {
            pixel,
            raster,
            margin: 0.0,
            pixels: 1,
            spacing: 1.0,
            sample,
        };
        SampleJob {
            site,
            weight,
            sampler,
        }
    };
    (0..dealt).map(draft).collect()
}

/// The mean colours of the replicates of a picture of two or four samples per pixel and replicate, with ten
/// more of training or so.
fn replicate_means(
    placing: &Lobed,
    stack: &Stack,
    size: UVec2,
    replicates: u32,
    seed: u64,
) -> Vec<[f64; 3]> {
    let integrator = Guided {
        training: 10.0,
        ..guided(5, 3)
    };
    let (origin, samples) = (UVec2::new(3, 5), 2);
    let mut before = None;
    let mut replicate = |replicate| {
        let pass = Pass {
            seed,
            samples,
            replicates,
            image_samples: samples * replicates,
            size,
            ..self::pass(replicate)
        };
        let learned = integrator.prepare(stack, placing, &pass, before.take());
        let mut mean = [0.0; 3];
        for pixel in 0..size.element_product() {
            let mut scale = Scale::default();
            let pixel = origin + UVec2::new(pixel % size.x, pixel / size.x);
            let dealt = placing.dealt(pixel, samples);
            let mut drafts = drafts(placing, &pass, pixel);
            integrator.sample_batch(stack, &learned, drafts.drain(..), &mut scale);
            for (mean, sum) in mean.iter_mut().zip(scale.sum) {
                *mean += sum / f64::from(dealt * size.element_product());
            }
        }
        before = Some(learned);
        mean
    };
    (0..replicates).map(&mut replicate).collect()
}

/// What training saw joins the picture without bias. Mutants rejected: a mean that forgets what a sample counts
/// on the film (half the light), training weighted by its sum, or by what its rounds thrown away had, too.
#[test]
fn training_joins_the_picture() {
    let stack = rainbow();
    let exact = Exact {
        stack: &stack,
        max_depth: 5,
        hidden: false,
    };
    let exact = exact.colour();
    for (shares, channel) in [false, true]
        .into_iter()
        .flat_map(|s| [(s, 0), (s, 1), (s, 2)])
    {
        let placing = Lobed { shares };
        let means = replicate_means(&placing, &stack, UVec2::new(16, 24), 32, 5);
        let channel_means: Vec<f64> = means.iter().map(|mean| mean[channel]).collect();
        let summary = Summary::of(&channel_means).expect("replicates");
        let t = (summary.mean() - LOBED * exact[channel]) / summary.standard_error();
        // |t| with 31 degrees of freedom: α = 10⁻³ over six means.
        assert!(t.abs() < 3.9, "{channel}: t = {t:.2}");
        let relative = summary.standard_error() / exact[channel];
        assert!(relative < 0.02, "too noisy to tell: {relative}");
    }
}

/// Replicates that have learned together are uncorrelated: their spread tells the error of their mean. Mutant
/// rejected: training dealt alike to all replicates, whose error none of them would see (ten times as
/// much, four times over).
#[test]
fn replicates_tell_the_error_of_what_they_learned_together() {
    let stack = rainbow();
    let runs: Vec<Summary> = (0..400)
        .map(|seed| {
            let means = replicate_means(
                &Lobed { shares: false },
                &stack,
                UVec2::new(4, 4),
                4,
                1000 + seed,
            );
            let green: Vec<f64> = means.iter().map(|mean| mean[1]).collect();
            Summary::of(&green).expect("replicates")
        })
        .collect();
    let means: Vec<f64> = runs.iter().map(Summary::mean).collect();
    let true_variance = Summary::of(&means).expect("runs").variance();
    let squared = |summary: &Summary| summary.standard_error() * summary.standard_error();
    let told = runs.iter().map(squared).sum::<f64>() / runs.len() as f64;
    // The ratio of χ² with 399 and 1200 degrees of freedom: a standard deviation of 8 %.
    let ratio = true_variance / told;
    assert!((0.72..1.33).contains(&ratio), "{ratio}");
}

/// A film that makes no numbers of what training finds for one pixel.
struct Spoiling;

const SPOILT: UVec2 = UVec2::new(5, 9);

impl Placing for Spoiling {
    fn place(&self, pixel: UVec2, u: Vec2) -> FilmSample {
        FilmSample {
            raster: pixel.as_vec2() + u,
            weight: if pixel == SPOILT { f32::NAN } else { 1.0 },
        }
    }
}

/// What is no number in training is told to the film, once, at its pixel; the pixel's other samples stand alone.
/// Mutants rejected: training that leaves it out in silence, or spoils all the pixel's samples.
#[test]
fn what_is_no_number_in_training_is_refused_once() {
    let stack = rainbow();
    let pass = pass(0);
    let integrator = Guided {
        training: 10.0,
        ..guided(5, 3)
    };
    let learned = integrator.prepare(&stack, &Spoiling, &pass, None);
    for pixel in [SPOILT, SPOILT + UVec2::X] {
        let mut record = Record::default();
        let mut drafts = drafts(&(), &pass, pixel);
        integrator.sample_batch(&stack, &learned, drafts.drain(..), &mut record);
        let no_number = |bits: [u32; 4]| {
            !bits
                .into_iter()
                .all(|bits| f32::from_bits(bits).is_finite())
        };
        let refused: Vec<bool> = (record.samples.iter())
            .map(|&(_, _, bits)| no_number(bits))
            .collect();
        let mut expected = vec![false; pass.samples as usize];
        expected[0] = pixel == SPOILT;
        assert_eq!(refused, expected, "{pixel}");
    }
}
