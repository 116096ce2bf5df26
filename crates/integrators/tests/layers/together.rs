//! Paths that are followed together are those that would be followed alone.

use crate::agreement::everything;
use etalon_integrators::path::Path;
use etalon_integrators::settings::PathSettings;
use etalon_sampling::{SampleId, Sampler, Sobol};
use etalon_transport::{Integrator, PixelSample, SampleJob, Sink, TileSink};
use glam::{UVec2, Vec2};

/// What was delivered: pixel, weight, bits of colour and alpha.
#[derive(Default)]
pub(crate) struct Record {
    of: (UVec2, f32),
    pub(crate) samples: Vec<(UVec2, f32, [u32; 4])>,
}

impl Sink for Record {
    fn radiance(&mut self, [r, g, b]: [f32; 3], alpha: f32) {
        let bits = [r, g, b, alpha].map(f32::to_bits);
        self.samples.push((self.of.0, self.of.1, bits));
    }
    fn splat(&mut self, _: Vec2, _: [f32; 3]) {
        unreachable!("no path tracer splats");
    }
    fn channel(&mut self, _: usize, _: f32) {
        unreachable!("no path tracer has channels");
    }
}

impl TileSink for Record {
    fn begin_sample(&mut self, pixel: UVec2, weight: f32) {
        self.of = (pixel, weight);
    }
}

pub(crate) fn drafts(count: u32) -> Vec<SampleJob<Sobol>> {
    let draft = |sample| {
        let mut sampler = Sobol::start(&SampleId {
            seed: 7,
            replicate: 0,
            pixel: (sample / 4, 0),
            sample: sample % 4,
            samples_per_replicate: 4,
            blocks: 1,
        });
        let site = PixelSample {
            pixel: UVec2::new(sample / 4, 0),
            raster: sampler.next_2d(),
            margin: 0.0,
            pixels: 1,
            spacing: 0.5,
            sample: 0,
        };
        SampleJob {
            site,
            weight: 1.0 + sample as f32,
            sampler,
        }
    };
    (0..count).map(draft).collect()
}

/// For no path, one, as many as fit, and more than are followed at once; for paths that end at
/// once, after a segment and late. Bit for bit, so no error rate; refused: a path that takes
/// another's random numbers or hit, a result delivered to another pixel, a light sample left over
/// from the round before.
#[test]
fn the_path_tracer_gives_the_same_bits_for_one_and_for_many() {
    let world = everything();
    for max_depth in [0, 1, 2, 30] {
        let path = Path {
            settings: PathSettings {
                max_depth,
                rr_depth: 4,
                hide_emitters: false,
            },
            ..Path::default()
        };
        for count in [0, 1, 5, 16, 17, 100] {
            let mut alone = Record::default();
            for draft in &mut drafts(count) {
                alone.begin_sample(draft.site.pixel, draft.weight);
                path.sample(&world, &(), &draft.site, &mut draft.sampler, &mut alone);
            }
            let mut together = Record::default();
            path.sample_batch(&world, &(), drafts(count).drain(..), &mut together);
            assert_eq!(alone.samples.len(), count as usize);
            assert_eq!(alone.samples, together.samples, "{count} to {max_depth}");
            let lit = |s: &&(UVec2, f32, [u32; 4])| s.2[0] != 0;
            assert!(max_depth < 30 || count < 16 || alone.samples.iter().any(|s| lit(&s)));
        }
    }
}
