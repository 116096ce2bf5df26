//! Paths in vector lanes are those that would be followed alone, bit for bit, in scenes of the repository.

use etalon_film::FilmSize;
use etalon_integrators::guided::Guided;
use etalon_integrators::path::Path;
use etalon_integrators::settings::PathSettings;
use etalon_render::pipeline::{LoadOptions, load};
use etalon_sampling::{SampleId, Sampler, Sobol};
use etalon_scene::Scene;
use etalon_transport::{
    FilmSample, Integrator, Pass, PixelSample, Placing, SampleJob, Sink, TileSink,
};
use glam::{UVec2, Vec2};

const SIZE: UVec2 = UVec2::new(32, 24);
const SAMPLES: u32 = 4;

/// Rectangles; rough metals under several lamps; spheres under lamps, a sky and a sun; rough plastic, frosted glass and coloured
/// plastic; leaves that let light pass, which have no lanes.
const SCENES: [(&str, &str); 7] = [
    ("cornell-box", ""),
    ("veach-mis", ""),
    ("lamps-under-sky", ""),
    ("materials", "roughplastic"),
    ("materials", "roughdielectric"),
    ("materials", "plastic"),
    ("foliage", ""),
];

/// The bits of colour and alpha, in the order of samples.
#[derive(Debug, Default, PartialEq)]
struct Record(Vec<[u32; 4]>);

impl Sink for Record {
    fn radiance(&mut self, [r, g, b]: [f32; 3], alpha: f32) {
        self.0.push([r, g, b, alpha].map(f32::to_bits));
    }
    fn splat(&mut self, _: Vec2, _: [f32; 3]) {
        unreachable!("no path tracer splats");
    }
    fn channel(&mut self, _: usize, _: f32) {
        unreachable!("no path tracer has channels");
    }
}

impl TileSink for Record {
    fn begin_sample(&mut self, _: UVec2, _: f32) {}
}

/// A box filter.
struct Even;

impl Placing for Even {
    fn place(&self, pixel: UVec2, u: Vec2) -> FilmSample {
        FilmSample {
            raster: pixel.as_vec2() + u,
            weight: 1.0,
        }
    }
}

fn jobs() -> Vec<SampleJob<Sobol>> {
    let job = |(x, y, sample)| {
        let mut sampler = Sobol::start(&SampleId {
            seed: 3,
            replicate: 0,
            pixel: (x, y),
            sample,
            samples_per_replicate: SAMPLES,
            blocks: 1,
        });
        let pixel = UVec2::new(x, y);
        let site = PixelSample {
            pixel,
            raster: pixel.as_vec2() + sampler.next_2d(),
            margin: 0.0,
            pixels: SIZE.element_product(),
            spacing: 1.0,
            sample,
        };
        SampleJob {
            site,
            weight: 1.0,
            sampler,
        }
    };
    let pixels = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)));
    pixels
        .flat_map(|(x, y)| (0..SAMPLES).map(move |sample| (x, y, sample)))
        .map(job)
        .collect()
}

/// The samples one by one, and all together.
fn both<I: Integrator>(integrator: &I, scene: &Scene, state: &I::State) -> [Record; 2] {
    let mut alone = Record::default();
    for job in &mut jobs() {
        integrator.sample(scene, state, &job.site, &mut job.sampler, &mut alone);
    }
    let mut together = Record::default();
    integrator.sample_batch(scene, state, jobs().drain(..), &mut together);
    [alone, together]
}

/// Roulette begins early, so that paths that meet in lanes are at different depths.
const SETTINGS: PathSettings = PathSettings {
    max_depth: 8,
    rr_depth: 2,
    hide_emitters: false,
};

fn scene(name: &str, material: &str) -> std::sync::Arc<etalon_scene::Compiled> {
    let path = format!(
        "{}/../../scenes/{name}/scene.xml",
        env!("CARGO_MANIFEST_DIR")
    );
    let mut options = LoadOptions::default();
    options.framing.size = Some(FilmSize::Pixels(SIZE));
    if !material.is_empty() {
        let define = ("bsdf".to_owned(), material.to_owned());
        options.defines.push(define);
    }
    let loaded = load(path.as_ref(), &options).expect("a scene of the repository");
    loaded.compiled
}

/// Mutants rejected, planted by hand: lanes that keep the density of the model alone, or of the learned lobe alone, or do not
/// stretch the number that chose between them; lanes that forget the albedo, or what roulette weighs; those of another lane.
#[test]
fn paths_in_lanes_have_the_bits_of_paths_alone() {
    let pass = Pass {
        seed: 3,
        replicate: 0,
        number: 0,
        count: 1,
        samples: SAMPLES,
        // More than there are rounds of training for, so that these leave no pictures.
        replicates: 64,
        image_samples: 64 * SAMPLES,
        origin: UVec2::ZERO,
        size: SIZE,
        margin: 0,
    };
    for (name, material) in SCENES {
        let compiled = scene(name, material);
        let scene = &compiled.scene;
        let path = Path {
            settings: SETTINGS,
            ..Path::default()
        };
        let [alone, together] = both(&path, scene, &());
        assert!(alone.0.iter().any(|bits| bits[0] != 0), "{name} is lit");
        assert!(alone == together, "path in {name} {material}");
        let guided = Guided {
            settings: SETTINGS,
            training: 0.06,
            spatial_threshold: 200.0,
            ..Guided::default()
        };
        let learned = guided.prepare(scene, &Even, &pass, None);
        let [by_field, together] = both(&guided, scene, &learned);
        assert!(by_field != alone, "{name} {material} is learned");
        assert!(by_field == together, "guided in {name} {material}");
    }
}
