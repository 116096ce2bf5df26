//! Is the estimate right on average, however short the chains?
//!
//! A primary sample of three numbers lands in one of two pixels. One sample in fifty finds a
//! narrow peak that brings half of all light, so that a bootstrap of a few samples often misses
//! it.

use super::super::bootstrap::BootstrapState;
use super::super::{ChainSettings, Contributions, FilmRegion, Integrand, PathLengthPdf};
use etalon_sampling::Sampler;
use etalon_transport::{Pass, Sink};
use glam::{UVec2, Vec2, Vec3};

/// The problem.
struct Peak;

impl Integrand for Peak {
    type Lists = ();

    fn kinds(&self) -> usize {
        2
    }

    fn find<S: Sampler>(
        &self,
        field: &FilmRegion,
        kinds: &PathLengthPdf,
        sampler: &mut S,
        (): &mut (),
        found: &mut Contributions,
    ) {
        sampler.skip_to(0);
        let site = field.site(sampler.next_2d());
        let (kind, probability) = kinds.choose(sampler.next_1d());
        found.kind = kind;
        let x = sampler.next_1d();
        // The peak is a path of the second kind, and lies in the left pixel.
        let value = if kind == 0 {
            site.raster.x
        } else if x < 0.02 && site.raster.x < 1.0 {
            50.0
        } else {
            return;
        };
        found.add(site.raster, Vec3::splat(value * field.area() / probability));
    }
}

/// ∫ over each of the pixels: of x, and of the peak.
const EXACT: [f64; 2] = [0.5 + 1.0, 1.5];

/// The pixels' sums over a replicate.
#[derive(Default)]
struct Pixels([f64; 2]);

impl Sink for Pixels {
    fn radiance(&mut self, _: [f32; 3], _: f32) {}
    fn splat(&mut self, raster: Vec2, rgb: [f32; 3]) {
        if raster.cmpge(Vec2::ZERO).all() && raster.x < 2.0 && raster.y < 1.0 {
            self.0[raster.x as usize] += f64::from(rgb[0]);
        }
    }
    fn channel(&mut self, _: usize, _: f32) {}
}

const SAMPLES: u32 = 32;

fn settings() -> ChainSettings {
    ChainSettings {
        length: 16,
        seeds: Some(8),
        ..ChainSettings::default()
    }
}

/// What is done to a replicate.
#[derive(Clone, Copy, PartialEq)]
enum Change {
    None,
    /// The pilot's brightness is wrong by a factor of ten.
    PoorPilot,
    /// Mutant: chains count as if their starts were drawn from all primary samples.
    NoBootstrapWeight,
    /// Mutant: the balance heuristic assumes the brightness that the replicate itself has found.
    OwnBrightness,
}

/// One replicate's pixels, and its state before it was changed.
fn replicate(
    number: u32,
    before: Option<BootstrapState>,
    change: Change,
) -> ([f64; 2], BootstrapState) {
    let pass = Pass {
        seed: 3,
        replicate: number,
        number: 0,
        count: 1,
        samples: SAMPLES,
        replicates: 1,
        image_samples: SAMPLES,
        origin: UVec2::ZERO,
        size: UVec2::new(2, 1),
        margin: 1,
    };
    let prepare = |before| BootstrapState::prepare(&Peak, &settings(), &(), &pass, before);
    let pristine = prepare(before);
    let mut state = pristine.clone();
    match change {
        Change::None => {}
        Change::PoorPilot => {
            state.pilot.brightness *= 10.0;
            state = prepare(Some(state));
        }
        Change::OwnBrightness => {
            state.pilot.brightness = state.brightness;
            state = prepare(Some(state));
        }
        // On the field of 4 × 3 pixels: |x| from −1 to 3, and the peak in two of its columns.
        Change::NoBootstrapWeight => state.brightness = 3.0 * (5.0 + 2.0),
    }
    let mut sink = Pixels::default();
    for x in 0..2 {
        let mut site = FilmRegion::of(&pass).site(Vec2::ZERO);
        site.pixel = UVec2::new(x, 0);
        site.pixels = 2;
        for sample in 0..SAMPLES {
            site.sample = sample;
            state.host(&Peak, &settings(), &site, &mut sink);
        }
    }
    (sink.0.map(|sum| sum / f64::from(SAMPLES)), pristine)
}

/// z of both pixels over 60 000 replicates.
fn z_scores(change: Change) -> [f64; 2] {
    let count = 60_000;
    let (mut sums, mut squares) = ([0.0; 2], [0.0; 2]);
    let mut before = None;
    for number in 0..count {
        let (pixels, state) = replicate(number, before.take(), change);
        before = Some(state);
        for i in 0..2 {
            sums[i] += pixels[i];
            squares[i] += pixels[i] * pixels[i];
        }
    }
    let n = f64::from(count);
    [0, 1].map(|i| {
        let mean = sums[i] / n;
        let variance = (squares[i] / n - mean * mean) / n;
        (mean - EXACT[i]) / variance.sqrt()
    })
}

/// α = 10⁻³ over four comparisons (two-sided normal quantile of 10⁻³/4 ≈ 3.66).
const LIMIT: f64 = 3.66;

#[test]
fn short_chains_from_few_seeds_are_right_on_average() {
    for change in [Change::None, Change::PoorPilot] {
        let z = z_scores(change);
        assert!(z.iter().all(|z| z.abs() < LIMIT), "z = {z:?}");
    }
}

#[test]
fn mutants_are_biased() {
    for change in [Change::NoBootstrapWeight, Change::OwnBrightness] {
        let z = z_scores(change);
        assert!(z.iter().any(|z| z.abs() > LIMIT), "z = {z:?}");
    }
}

#[test]
fn a_replicate_is_the_same_with_and_without_those_before() {
    let (_, state) = replicate(6, None, Change::None);
    let (alone, _) = replicate(7, None, Change::None);
    let (after, _) = replicate(7, Some(state), Change::None);
    assert_eq!(alone, after);
    let (other, _) = replicate(8, None, Change::None);
    assert_ne!(alone, other);
}

#[test]
fn replicates_are_independent() {
    // The correlation of neighbours is within what n independent pairs would show (α = 10⁻³).
    let values: Vec<f64> = {
        let mut before = None;
        let run = |number| {
            let (pixels, state) = replicate(number, before.take(), Change::None);
            before = Some(state);
            pixels[1]
        };
        (0..4000).map(run).collect()
    };
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let product = |lag: usize| -> f64 {
        let pairs = values.iter().zip(&values[lag..]);
        pairs.map(|(a, b)| (a - mean) * (b - mean)).sum()
    };
    let correlation = product(1) / product(0);
    assert!(correlation.abs() < 3.29 / n.sqrt(), "{correlation}");
}
