//! `cargo xtask denoiser`: what `etalon denoise` takes away, what it leaves, and what it says of it.
//!
//! Pictures of 32 samples per pixel and eight seeds are denoised and held against a picture of many samples: by relMSE, the
//! mean over pixels and colours of (x − r)² / (r² + 0.01), over the picture and over each of its tiles of 16² pixels. The reference's
//! own noise is known and taken away. Open Image Denoise stands beside it where it is found (`ETALON_OIDN` names its folder).

use etalon_film::RenderedImage;
use etalon_render::denoise::{OpenImageDenoise, denoise};
use etalon_render::pipeline::{self, LoadOptions, Loaded, RenderControls, RenderOptions};
use etalon_statistics::metrics::EPSILON;
use etalon_validation::folders;
use std::path::PathBuf;
use std::time::Instant;

/// The scenes, below `scenes`, with their parameters for pictures of some 160 × 120 pixels.
const SCENES: [(&str, [u32; 2]); 6] = [
    ("cornell-box/scene.xml", [128, 128]),
    ("veach-mis/scene.xml", [160, 120]),
    ("bathroom/scene.xml", [160, 120]),
    ("foliage/scene.xml", [128, 128]),
    ("cloud/scene.xml", [160, 96]),
    ("materials/scene.xml", [160, 120]),
];

/// Samples per pixel of a picture that is denoised.
const SAMPLES: u32 = 32;

/// Side of the tiles (pixels).
const SIDE: usize = 16;

/// The options of the command.
#[derive(clap::Args)]
pub(crate) struct DenoiserArguments {
    /// Only scenes whose names contain this.
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Seeds of each scene.
    #[arg(long, value_name = "N", default_value_t = 8)]
    seeds: u64,
    /// Samples per pixel of the reference.
    #[arg(long, value_name = "N", default_value_t = 2048)]
    reference: u32,
}

/// Squared errors of one picture, relative, by tile.
struct Errors {
    tiles: Vec<f64>,
    whole: f64,
}

/// What a denoiser came to over all seeds of a scene.
#[derive(Default)]
struct Tally {
    before: f64,
    after: f64,
    stated: f64,
    /// Tiles that got worse, and all.
    above: usize,
    tiles: usize,
    worst: f64,
    seconds: f64,
}

impl Tally {
    /// Adds a picture, and the same denoised.
    fn add(
        &mut self,
        [noisy, quiet]: [&RenderedImage; 2],
        (reference, noise): (&RenderedImage, &Errors),
    ) -> Result<(), String> {
        let (input, output) = (errors(noisy, reference)?, errors(quiet, reference)?);
        self.before += input.whole - noise.whole;
        self.after += output.whole - noise.whole;
        self.stated += stated(quiet, reference)?;
        for ((before, after), noise) in input.tiles.iter().zip(&output.tiles).zip(&noise.tiles) {
            // Beyond what the reference's noise, twice as large as its mean, would explain.
            let ratio = (after - 2.0 * noise) / before.max(1e-12);
            self.worst = self.worst.max(ratio);
            self.above += usize::from(ratio > 1.05);
            self.tiles += 1;
        }
        Ok(())
    }

    /// A row of the table.
    fn row(&self, scene: &str, seeds: f64) -> String {
        format!(
            "| {scene} | {:.5} | {:.5} | {:.3} | {} of {} | {:.2} | {:.2} | {:.1} |",
            self.before / seeds,
            self.after / seeds,
            self.after / self.before,
            self.above,
            self.tiles,
            self.worst,
            (self.stated / self.after).sqrt(),
            self.seconds / seeds
        )
    }
}

/// Measures.
///
/// # Errors
/// If a scene cannot be rendered.
pub(crate) fn run(arguments: &DenoiserArguments) -> Result<(), String> {
    let place = std::env::var_os("ETALON_OIDN").map(PathBuf::from);
    let library = OpenImageDenoise::find(place.as_deref());
    if let Err(reason) = &library {
        eprintln!("note: {reason}");
    }
    println!(
        "| scene | relMSE at {SAMPLES} spp | denoised | ratio | tiles above 1.05 | worst tile | stated / true error | seconds |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (name, size) in SCENES {
        let wanted = |only: &String| name.contains(only);
        if arguments.only.as_ref().is_none_or(wanted) {
            measure(name, size, arguments, library.as_ref().ok())?;
        }
    }
    Ok(())
}

fn measure(
    name: &str,
    size: [u32; 2],
    arguments: &DenoiserArguments,
    library: Option<&OpenImageDenoise>,
) -> Result<(), String> {
    let path: PathBuf = folders::scenes().join(name);
    let defines = ["resx", "resy"].into_iter().zip(size);
    let options = LoadOptions {
        defines: defines
            .map(|(key, value)| (key.to_owned(), value.to_string()))
            .collect(),
        ..LoadOptions::default()
    };
    let loaded = pipeline::load(&path, &options).map_err(|refusal| {
        let first = refusal.diagnostics.first();
        first.map_or_else(String::new, |d| d.one_line(&refusal.sources))
    })?;
    let reference = render(&loaded, arguments.reference, u64::MAX, false)?;
    let noise = noise(&reference)?;
    let (mut own, mut network) = (Tally::default(), Tally::default());
    for seed in 0..arguments.seeds {
        let noisy = render(&loaded, SAMPLES, seed, true)?;
        let begin = Instant::now();
        let quiet = denoise(&noisy, None)?;
        own.seconds += begin.elapsed().as_secs_f64();
        own.add([&noisy, &quiet], (&reference, &noise))?;
        if library.is_some() {
            let begin = Instant::now();
            let quiet = denoise(&noisy, library)?;
            network.seconds += begin.elapsed().as_secs_f64();
            network.add([&noisy, &quiet], (&reference, &noise))?;
        }
    }
    let seeds = arguments.seeds as f64;
    let scene = name.trim_end_matches("/scene.xml");
    println!("{}", own.row(scene, seeds));
    if let Some(library) = library {
        let name = format!("… by Open Image Denoise {}", library.version());
        println!("{}", network.row(&name, seeds));
    }
    Ok(())
}

fn render(loaded: &Loaded, spp: u32, seed: u64, features: bool) -> Result<RenderedImage, String> {
    let options = RenderOptions {
        spp: Some(spp),
        seed: Some(seed),
        independent_replicates: true,
        ..RenderOptions::default()
    };
    let plan = pipeline::plan(loaded, &options);
    let controls = RenderControls {
        features,
        ..RenderControls::default()
    };
    let rendered = pipeline::render_as(loaded, &plan, controls, &());
    let rendered = rendered.map_err(|diagnostic| diagnostic.message)?;
    Ok(rendered.developed)
}

/// Squared errors against the reference.
fn errors(picture: &RenderedImage, reference: &RenderedImage) -> Result<Errors, String> {
    of(reference, |name, i| {
        let values = picture.image.channel(name)?;
        let known = reference.image.channel(name)?;
        Some(f64::from(values[i] - known[i]).powi(2))
    })
}

/// The reference's own.
fn noise(reference: &RenderedImage) -> Result<Errors, String> {
    of(reference, |name, i| {
        Some(f64::from(reference.standard_error(name)?[i]).powi(2))
    })
}

/// What a denoised picture says of its squared error.
fn stated(picture: &RenderedImage, reference: &RenderedImage) -> Result<f64, String> {
    let errors = of(reference, |name, i| {
        Some(f64::from(picture.standard_error(name)?[i]).powi(2))
    });
    Ok(errors?.whole)
}

/// Squares of pixels and colours, relative to the reference.
fn of(
    reference: &RenderedImage,
    square: impl Fn(&str, usize) -> Option<f64>,
) -> Result<Errors, String> {
    let image = &reference.image;
    let [width, height] = [image.width(), image.height()];
    let columns = width.div_ceil(SIDE);
    let mut sums = vec![(0.0, 0_u32); columns * height.div_ceil(SIDE)];
    for name in ["R", "G", "B"] {
        let missing = || format!("there is no channel `{name}`");
        let known = image.channel(name).ok_or_else(missing)?;
        for (i, known) in known.iter().enumerate() {
            let relative = f64::from(*known).powi(2) + EPSILON;
            let (sum, count) = &mut sums[i / width / SIDE * columns + i % width / SIDE];
            *sum += square(name, i).ok_or_else(missing)? / relative;
            *count += 1;
        }
    }
    let whole = sums.iter().map(|(sum, _)| sum).sum::<f64>() / (3 * width * height) as f64;
    let tiles = sums.iter().map(|(sum, count)| sum / f64::from(*count));
    Ok(Errors {
        tiles: tiles.collect(),
        whole,
    })
}
